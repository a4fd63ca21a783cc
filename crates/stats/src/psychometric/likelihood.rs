//! The likelihood of threshold, width, lapse rate and η with its exact derivatives.

use super::{Level, Task};
use crate::betabinomial;
use crate::optimise::Local;

/// The order of the parameters everywhere: threshold, width, lapse rate λ, overdispersion η.
pub(super) const PARAMETERS: usize = 4;

/// ln likelihood of the single answers (no binomial coefficients).
pub(super) fn log_likelihood(levels: &[Level], task: &Task, at: &[f64]) -> Local {
    const P: usize = PARAMETERS;
    let (threshold, width, lapse, eta) = (at[0], at[1], at[2], at[3]);
    // θ = η²/(1 − η²) and its derivatives in η.
    let rest = 1.0 - eta * eta;
    let theta = eta * eta / rest;
    let (theta_1, theta_2) = (2.0 * eta / (rest * rest), (2.0 + 6.0 * eta * eta) / rest.powi(3));
    let span = 1.0 - lapse - task.guess;

    let mut sum = Local { value: 0.0, gradient: vec![0.0; P], curvature: vec![0.0; P * P] };
    for level in levels {
        let (z, rise) = task.sigmoid.argument(level.x, threshold, width);
        let [f, f1, f2] = task.sigmoid.derivatives(z);
        // z = c + rise (x − threshold)/width.
        let u = (level.x - threshold) / width;
        let z_t = -rise / width;
        let z_w = -rise * u / width;
        let (z_tw, z_ww) = (rise / (width * width), 2.0 * rise * u / (width * width));
        let psi = (task.guess + span * f).clamp(1e-300, 1.0 - 1e-16);
        // ψ's derivatives in threshold, width, λ.
        let first = [span * f1 * z_t, span * f1 * z_w, -f];
        let second = [
            [span * f2 * z_t * z_t, span * (f2 * z_t * z_w + f1 * z_tw), -f1 * z_t],
            [span * (f2 * z_t * z_w + f1 * z_tw), span * (f2 * z_w * z_w + f1 * z_ww), -f1 * z_w],
            [-f1 * z_t, -f1 * z_w, 0.0],
        ];
        let d = betabinomial::log_likelihood(level.correct, level.trials, psi, theta);
        sum.value += d.value;
        for i in 0..3 {
            sum.gradient[i] += d.p * first[i];
            for j in 0..3 {
                sum.curvature[i * P + j] -= d.p_p * first[i] * first[j] + d.p * second[i][j];
            }
            let mixed = d.p_theta * first[i] * theta_1;
            sum.curvature[i * P + 3] -= mixed;
            sum.curvature[3 * P + i] -= mixed;
        }
        sum.gradient[3] += d.theta * theta_1;
        sum.curvature[3 * P + 3] -= d.theta_theta * theta_1 * theta_1 + d.theta * theta_2;
    }
    sum
}

/// Adds 9 ln(1 − x), the logarithm of Beta(1, 10), for parameter `i`.
pub(super) fn add_beta_prior(sum: &mut Local, i: usize, x: f64) {
    let rest = (1.0 - x).max(1e-300);
    sum.value += 9.0 * rest.ln();
    sum.gradient[i] -= 9.0 / rest;
    sum.curvature[i * PARAMETERS + i] += 9.0 / (rest * rest);
}
