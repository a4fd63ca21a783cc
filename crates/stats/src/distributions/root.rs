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
        let next =
            if slope.is_finite() && newton > low && newton < high && (newton - x).abs() < 0.75 * last_step {
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

/// [`increasing`] for a function without a derivative: its slope is a difference over a millionth. (A secant of the last
/// two values can be so much steeper than the function at the new one that its step stands still.)
pub(crate) fn increasing_by_differences(f: impl Fn(f64) -> f64, low: f64, high: f64, start: f64) -> f64 {
    let with_slope = |x: f64| {
        let value = f(x);
        let near = x + 1e-6 * x.abs().max(1e-3);
        Local { value, slope: (f(near) - value) / (near - x) }
    };
    increasing(&with_slope, low, high, start)
}

/// The positive root up to `high` of an increasing function, sought in ln x so that the smallest is as exact as the
/// largest; 0 when it lies below 1e-323.
pub(crate) fn in_logarithm(f: impl Fn(f64) -> f64, high: f64, start: f64) -> f64 {
    let in_ln = |v: f64| f(v.exp().min(high));
    let (low, ln_high) = (-744.0, high.ln());
    if in_ln(low) >= 0.0 {
        return 0.0;
    }
    if in_ln(ln_high) <= 0.0 {
        return high;
    }
    let v = increasing_by_differences(in_ln, low, ln_high, start.ln());
    // The logarithm holds fewer digits than x: one step on x itself puts them back.
    let x = v.exp().min(high);
    let near = x * 0.9999;
    let slope = (f(x) - f(near)) / (x / near).ln();
    let correction = f(x) / slope;
    if correction.abs() < 1e-6 { (x * (1.0 - correction)).min(high) } else { x }
}

/// ln(p / target), without cancellation where they are close and also where p underflows.
pub(crate) fn ln_ratio(p: f64, ln_p: f64, target: f64) -> f64 {
    let relative = (p - target) / target;
    if p >= f64::MIN_POSITIVE && relative.abs() < 0.5 { relative.ln_1p() } else { ln_p - target.ln() }
}
