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
        let on_low = |i: usize| bounds.get(i).is_some_and(|b| at[i] <= b.0);
        let on_high = |i: usize| bounds.get(i).is_some_and(|b| at[i] >= b.1);
        let pushes_out = |i: usize, d: f64| (on_low(i) && d <= 0.0) || (on_high(i) && d >= 0.0);
        let frozen = |i: usize| bounds.get(i).is_some_and(|b| b.0 >= b.1);
        let free: Vec<usize> = (0..p).filter(|&i| !frozen(i) && !pushes_out(i, here.gradient[i])).collect();
        let step = bounded_step(&here, &at, free.clone(), pushes_out);

        // Where the function is flat (or rounding is all that is left) there may be no step uphill, and none is needed.
        let slope = free.iter().map(|&i| here.gradient[i].abs() * (1.0 + at[i].abs())).fold(0.0, f64::max);
        let flat = slope <= 1e-9 * (1.0 + here.value.abs());
        let finished = |at, here: Local| Maximum { at, value: here.value, curvature: here.curvature };
        if !step.iter().all(|d| d.is_finite()) {
            return flat.then(|| finished(at, here));
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
            return (flat || relative_step(&at, &step) < 1e-7).then(|| finished(at, here));
        };
        let change: Vec<f64> = (0..p).map(|i| next[i] - at[i]).collect();
        // Along a ridge that is level to rounding, steps stay small without ever ending; nothing is left to gain by them.
        let gain: f64 = free.iter().map(|&i| here.gradient[i] * step[i]).sum();
        let level = flat && gain.abs() <= 1e-21 * (1.0 + here.value.abs());
        let done = level || relative_step(&next, &change) <= TOLERANCE;
        at = next;
        here = there;
        if done {
            return Some(finished(at, here));
        }
    }
    None
}

/// A Newton step that leaves no bound it stands on: a coordinate that it would push out waits until the others have settled, and then moves alone.
fn bounded_step(
    here: &Local,
    at: &[f64],
    mut free: Vec<usize>,
    pushes_out: impl Fn(usize, f64) -> bool,
) -> Vec<f64> {
    let p = at.len();
    let mut waiting: Vec<usize> = Vec::new();
    loop {
        let mut step: Vec<f64> = newton_step(here, &free, p);
        let (out, stay): (Vec<usize>, Vec<usize>) =
            free.iter().partition(|&&i| step[i] != 0.0 && pushes_out(i, step[i]));
        if out.is_empty() {
            if relative_step(at, &step) < 1e-10 {
                for &i in &waiting {
                    step[i] = here.gradient[i] / here.curvature[i * p + i].abs().max(f64::MIN_POSITIVE);
                }
            }
            return step;
        }
        waiting.extend(out);
        free = stay;
    }
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
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]
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
    fn leaves_a_bound_that_newton_would_cross() {
        // −(x − y)² − (x + y − 1)²/100 has its top at (½, ½). From (0, −1), on the bound x ≥ 0 and uphill inwards in x, it must get there.
        let ridge = |x: &[f64]| {
            let (a, b) = (x[0] - x[1], x[0] + x[1] - 1.0);
            Local {
                value: -a * a - 0.01 * b * b,
                gradient: vec![-2.0 * a - 0.02 * b, 2.0 * a - 0.02 * b],
                curvature: vec![2.02, -1.98, -1.98, 2.02],
            }
        };
        let bounds = [(0.0, 10.0), (-10.0, 10.0)];
        for start in [[0.0, -1.0], [0.0, 3.0], [5.0, 0.0]] {
            let top = maximise(&start, &bounds, ridge).unwrap();
            assert!((top.at[0] - 0.5).abs() < 1e-12 && (top.at[1] - 0.5).abs() < 1e-12, "{:?}", top.at);
        }
        let cut = maximise(&[0.0, 0.0], &[(0.6, 10.0), (-10.0, 10.0)], ridge).unwrap();
        assert!(
            (cut.at[0] - 0.6).abs() < 1e-15
                && (cut.at[1] - (2.0 * 0.6 - 0.02 * (0.6 - 1.0)) / 2.02).abs() < 1e-12
        );
    }

    #[test]
    fn refuses_a_function_without_a_top() {
        let climb = |x: &[f64]| Local { value: x[0], gradient: vec![1.0], curvature: vec![0.0] };
        assert!(maximise(&[0.0], &[], climb).is_none());
        let nothing = |_: &[f64]| Local { value: f64::NAN, gradient: vec![0.0], curvature: vec![1.0] };
        assert!(maximise(&[0.0], &[], nothing).is_none());
    }
}
