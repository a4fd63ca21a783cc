//! Damped Newton maximisation within bounds: the one optimiser behind every fit.

use crate::linalg;

/// A function's value, gradient (p) and curvature (p × p, minus the Hessian or an approximation of it) at a point.
pub(crate) struct Local {
    pub value: f64,
    pub gradient: Vec<f64>,
    pub curvature: Vec<f64>,
}

/// Where the maximum was found.
#[derive(Clone, Debug)]
pub(crate) struct Maximum {
    pub at: Vec<f64>,
    pub value: f64,
    /// Minus the Hessian there (p × p), for standard errors.
    pub curvature: Vec<f64>,
}

const ITERATIONS: usize = 1000;
const TOLERANCE: f64 = 1e-12;

/// Maximises from `start` inside `bounds` (inclusive; empty means none); `None` when it does not converge or the start has no finite value.
///
/// A coordinate on a bound whose gradient points outside stays there; `low == high` freezes a coordinate.
pub(crate) fn maximise(
    start: &[f64],
    bounds: &[(f64, f64)],
    mut local: impl FnMut(&[f64]) -> Local,
) -> Option<Maximum> {
    let p = start.len();
    let clamp = |i: usize, x: f64| bounds.get(i).map_or(x, |&(low, high)| x.clamp(low, high));
    let mut at: Vec<f64> = (0..p).map(|i| clamp(i, start[i])).collect();
    let mut here = local(&at);
    if !here.value.is_finite() {
        return None;
    }
    for _ in 0..ITERATIONS {
        let free: Vec<usize> = (0..p)
            .filter(|&i| {
                bounds.get(i).is_none_or(|&(low, high)| {
                    low < high
                        && !(at[i] <= low && here.gradient[i] <= 0.0)
                        && !(at[i] >= high && here.gradient[i] >= 0.0)
                })
            })
            .collect();
        let step = newton_step(&here, &free, p);
        if !step.iter().all(|d| d.is_finite()) {
            return None;
        }
        let mut scale = 1.0;
        let moved = loop {
            let next: Vec<f64> = (0..p).map(|i| clamp(i, at[i] + scale * step[i])).collect();
            let there = local(&next);
            // Rounding noise in the value must not stop the last, accurate steps.
            if there.value >= here.value - 1e-13 * (1.0 + here.value.abs()) {
                break Some((next, there));
            }
            scale *= 0.5;
            if scale < 1e-12 {
                break None;
            }
        };
        let Some((next, there)) = moved else {
            // No uphill step is left: the maximum to rounding, if the step itself was negligible.
            let size = relative_step(&at, &step);
            return (size < 1e-7).then_some(Maximum { at, value: here.value, curvature: here.curvature });
        };
        let change: Vec<f64> = (0..p).map(|i| next[i] - at[i]).collect();
        let done = relative_step(&next, &change) <= TOLERANCE;
        at = next;
        here = there;
        if done {
            return Some(Maximum { at, value: here.value, curvature: here.curvature });
        }
    }
    None
}

fn relative_step(at: &[f64], step: &[f64]) -> f64 {
    at.iter().zip(step).map(|(x, d)| d.abs() / (1.0 + x.abs())).fold(0.0, f64::max)
}

/// Curvature⁻¹ gradient over the free coordinates, with a growing ridge where the curvature isn't positive definite; NaN where it is beyond repair.
fn newton_step(here: &Local, free: &[usize], p: usize) -> Vec<f64> {
    let q = free.len();
    let mut step = vec![0.0; p];
    if q == 0 {
        return step;
    }
    let size = free.iter().map(|&i| here.curvature[i * p + i].abs()).fold(f64::MIN_POSITIVE, f64::max);
    let mut ridge = 0.0;
    for _ in 0..40 {
        let mut a = vec![0.0; q * q];
        for (r, &i) in free.iter().enumerate() {
            for (c, &j) in free.iter().enumerate() {
                a[r * q + c] = here.curvature[i * p + j];
            }
            a[r * q + r] += ridge;
        }
        if let Some(l) = linalg::cholesky(&a, q) {
            let mut b: Vec<f64> = free.iter().map(|&i| here.gradient[i]).collect();
            linalg::solve(&l, q, &mut b);
            for (&i, d) in free.iter().zip(b) {
                step[i] = d;
            }
            return step;
        }
        ridge = if ridge == 0.0 { 1e-8 * size } else { ridge * 10.0 };
    }
    for &i in free {
        step[i] = f64::NAN;
    }
    step
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// −(x − 3)⁴ − (y + 1)², whose fourth-order top is hard on Newton, and a bound that cuts it.
    fn bowl(x: &[f64]) -> Local {
        let (a, b) = (x[0] - 3.0, x[1] + 1.0);
        Local {
            value: -a * a * (1.0 + a * a) - b * b,
            gradient: vec![-2.0 * a - 4.0 * a * a * a, -2.0 * b],
            curvature: vec![2.0 + 12.0 * a * a, 0.0, 0.0, 2.0],
        }
    }

    #[test]
    fn finds_the_top_and_respects_bounds() {
        let top = maximise(&[100.0, 50.0], &[], bowl).unwrap();
        assert!((top.at[0] - 3.0).abs() < 1e-12 && (top.at[1] + 1.0).abs() < 1e-12);
        let cut = maximise(&[0.0, 0.0], &[(-1.0, 2.0), (0.5, 0.5)], bowl).unwrap();
        assert_eq!(vec![2.0, 0.5], cut.at);
    }

    #[test]
    fn refuses_a_function_without_a_top() {
        let climb = |x: &[f64]| Local { value: x[0], gradient: vec![1.0], curvature: vec![0.0] };
        assert!(maximise(&[0.0], &[], climb).is_none());
        let nothing = |_: &[f64]| Local { value: f64::NAN, gradient: vec![0.0], curvature: vec![1.0] };
        assert!(maximise(&[0.0], &[], nothing).is_none());
    }
}
