//! One root finder for every quantile.

/// What a function and its slope are at a point.
pub(crate) struct Local {
    /// The function, whose root is sought; increasing.
    pub(crate) value: f64,
    /// Its derivative; only a hint, 0 or NaN makes the step a bisection.
    pub(crate) slope: f64,
}

/// The root of an increasing function between `low` and `high`, from `start`: Newton's steps, halving the bracket
/// wherever they leave it or do not shrink. Ends when a step is below 1e-17 + 2e-16 |x|, at the latest after 200.
pub(crate) fn increasing(f: &dyn Fn(f64) -> Local, mut low: f64, mut high: f64, start: f64) -> f64 {
    let mut x = if start > low && start < high { start } else { low + (high - low) / 2.0 };
    let mut last_step = high - low;
    for _ in 0..200 {
        let Local { value, slope } = f(x);
        if value == 0.0 {
            return x;
        }
        if value < 0.0 {
            low = x
        } else {
            high = x
        }
        let newton = x - value / slope;
        let next = if newton > low && newton < high && (newton - x).abs() < 0.75 * last_step {
            newton
        } else {
            low + (high - low) / 2.0
        };
        last_step = (next - x).abs();
        x = next;
        if last_step <= 1e-17 + 2e-16 * x.abs() {
            break;
        }
    }
    x
}
