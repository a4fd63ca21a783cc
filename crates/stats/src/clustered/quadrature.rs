//! Gauss–Hermite nodes.

/// Nodes x and scaled weights w·e^{x²} of the n-point rule ∫ f(x) dx ≈ Σ w e^{x²} f(x), exact for polynomials of degree 2n − 1 times e^{−x²}.
///
/// The roots of each Hermite polynomial lie between those of the one before it, so bisection always finds them.
pub(super) fn gauss_hermite(n: usize) -> Vec<(f64, f64)> {
    let mut roots: Vec<f64> = Vec::new();
    for degree in 1..=n {
        let edge = (2.0 * degree as f64 + 1.0).sqrt();
        let mut ends = vec![-edge];
        ends.extend(&roots);
        ends.push(edge);
        roots = ends.windows(2).map(|w| root(degree, w[0], w[1])).collect();
    }
    roots
        .into_iter()
        .map(|x| {
            let sum: f64 = hermite_functions(n, x).iter().take(n).map(|h| h * h).sum();
            (x, 1.0 / sum)
        })
        .collect()
}

/// The orthonormal Hermite functions h₀ … hₙ at x.
fn hermite_functions(n: usize, x: f64) -> Vec<f64> {
    let mut h = vec![std::f64::consts::PI.powf(-0.25) * (-0.5 * x * x).exp()];
    for k in 0..n {
        let before = if k > 0 { h[k - 1] } else { 0.0 };
        let k = k as f64;
        h.push((2.0 / (k + 1.0)).sqrt() * x * h[k as usize] - (k / (k + 1.0)).sqrt() * before);
    }
    h
}

fn root(degree: usize, mut low: f64, mut high: f64) -> f64 {
    let f = |x: f64| hermite_functions(degree, x)[degree];
    let sign = f(low) > 0.0;
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return middle;
        }
        if (f(middle) > 0.0) == sign {
            low = middle;
        } else {
            high = middle;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integrates_even_moments() {
        for n in [1, 2, 7, 40] {
            let rule = gauss_hermite(n);
            // ∫ x²ᵏ e^{−x²} dx = Γ(k + ½).
            let mut expected = std::f64::consts::PI.sqrt();
            for k in 0..n.min(15) {
                let sum: f64 = rule.iter().map(|(x, w)| w * x.powi(2 * k as i32) * (-x * x).exp()).sum();
                assert!((sum / expected - 1.0).abs() < 1e-13, "n = {n}, k = {k}: {sum} {expected}");
                expected *= k as f64 + 0.5;
            }
        }
        // One degree too many must show.
        let sum: f64 = gauss_hermite(2).iter().map(|(x, w)| w * x.powi(4) * (-x * x).exp()).sum();
        assert!((sum - 0.75 * std::f64::consts::PI.sqrt()).abs() > 0.1);
    }
}
