//! Integrals of a decaying function and of a peak, by the trapezoid rule, which converges exponentially for both.

/// ∫₀^∞ exp(g(s)) ds for a decreasing g with g(0) = 0 and slope −`slope` there, that falls over a length of about
/// 1 / `rate` or more: the trapezoid rule in ln s, which converges like exp(−π²/2h) for anything between an
/// exponential and a Gaussian.
pub(crate) fn integrate_decay(g: impl Fn(f64) -> f64, slope: f64, rate: f64) -> f64 {
    const STEP: f64 = 0.125;
    /// Left of `START / rate` the integrand is 1 − slope · s to 1e-17 of the whole.
    const START: f64 = 2e-6;
    let first = START / rate;
    let ratio = (-STEP).exp();
    let mut sum = first / (1.0 - ratio) - slope * first * first / (1.0 - ratio * ratio);
    let mut last = 0.0;
    for k in 1..20_000 {
        let s = first * (f64::from(k) * STEP).exp();
        let term = s * g(s).exp();
        sum += term;
        if term < last && term < 1e-18 * sum || !s.is_finite() {
            break;
        }
        last = term;
    }
    sum * STEP
}

/// ∫ exp(g(v)) dv over the real line for a g with one maximum, from a point `start` of which a maximum can be climbed
/// to: the logarithm of the peak's height, and the integral in units of that height.
///
/// The step is halved until the sum moves by less than 1e-10 of itself; each halving squares the error, so that the
/// last one leaves rounding alone.
pub(crate) fn integrate_peak(g: impl Fn(f64) -> f64, start: f64, step: f64) -> (f64, f64) {
    let (peak, width) = find_peak(&g, start, step);
    let height = g(peak);
    if height == f64::NEG_INFINITY {
        return (height, 0.0);
    }
    let relative = |v: f64| (g(v) - height).exp();
    let mut step = width;
    let mut sum = 1.0 + one_sided(&relative, peak, step) + one_sided(&relative, peak, -step);
    for _ in 0..14 {
        let middle =
            one_sided(&relative, peak - step / 2.0, step) + one_sided(&relative, peak + step / 2.0, -step);
        let refined = sum + middle;
        step /= 2.0;
        let moved = (refined * step - sum * 2.0 * step).abs();
        sum = refined;
        if moved < 1e-10 * sum * step {
            break;
        }
    }
    (height, sum * step)
}

/// Σ f(from + k · step), k = 1, 2, … until nothing is added.
fn one_sided(f: &dyn Fn(f64) -> f64, from: f64, step: f64) -> f64 {
    let mut sum = 0.0;
    for k in 1..100_000 {
        let term = f(from + f64::from(k) * step);
        sum += term;
        if term <= 1e-19 || term <= 1e-18 * sum {
            break;
        }
    }
    sum
}

/// Where g is largest, roughly, and the distance over which it falls by a half there.
fn find_peak(g: &dyn Fn(f64) -> f64, start: f64, step: f64) -> (f64, f64) {
    let mut best = start;
    let mut height = g(best);
    let mut stride = step;
    // Climb with growing strides, then halve them around the best point.
    for _ in 0..200 {
        let (left, right) = (g(best - stride), g(best + stride));
        if right > height || left > height {
            let up = right >= left;
            best += if up { stride } else { -stride };
            height = left.max(right);
            stride *= 2.0;
        } else if (height - left).max(height - right) > 0.5 {
            stride /= 2.0;
        } else {
            break;
        }
    }
    (best, stride.max(1e-300))
}
