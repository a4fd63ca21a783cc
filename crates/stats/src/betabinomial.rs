//! The beta-binomial log-likelihood and its derivatives, smooth down to the binomial.

/// Value and partial derivatives in the mean p and θ = ρ/(1 − ρ), where ρ is the correlation of two tries (θ = 0: binomial).
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Derivatives {
    pub value: f64,
    pub p: f64,
    pub theta: f64,
    pub p_p: f64,
    pub p_theta: f64,
    pub theta_theta: f64,
}

/// ln P(k of n) without the binomial coefficient, as the finite sum
/// Σ_{j<k} ln(p + jθ) + Σ_{j<n−k} ln(1 − p + jθ) − Σ_{j<n} ln(1 + jθ): no cancelling gamma functions, and exact at θ = 0.
pub(crate) fn log_likelihood(k: u64, n: u64, p: f64, theta: f64) -> Derivatives {
    let mut d = Derivatives::default();
    if theta == 0.0 {
        // The binomial limit: sums of equal terms, with Σj and Σj² in closed form.
        let (k, m) = (k as f64, (n - k) as f64);
        let q = 1.0 - p;
        let sum = |n: f64| n * (n - 1.0) / 2.0;
        let squares = |n: f64| (n - 1.0) * n * (2.0 * n - 1.0) / 6.0;
        let n = n as f64;
        d.value = if k > 0.0 { k * p.ln() } else { 0.0 } + if m > 0.0 { m * q.ln() } else { 0.0 };
        d.p = k / p - m / q;
        d.p_p = -k / (p * p) - m / (q * q);
        d.theta = sum(k) / p + sum(m) / q - sum(n);
        d.p_theta = -sum(k) / (p * p) + sum(m) / (q * q);
        d.theta_theta = -squares(k) / (p * p) - squares(m) / (q * q) + squares(n);
        return d;
    }
    for j in 0..k {
        let j = j as f64;
        let a = p + j * theta;
        let r = 1.0 / a;
        d.value += a.ln();
        d.p += r;
        d.theta += j * r;
        d.p_p -= r * r;
        d.p_theta -= j * r * r;
        d.theta_theta -= j * j * r * r;
    }
    for j in 0..n - k {
        let j = j as f64;
        let a = 1.0 - p + j * theta;
        let r = 1.0 / a;
        d.value += a.ln();
        d.p -= r;
        d.theta += j * r;
        d.p_p -= r * r;
        d.p_theta += j * r * r;
        d.theta_theta -= j * j * r * r;
    }
    for j in 0..n {
        let j = j as f64;
        let a = 1.0 + j * theta;
        let r = 1.0 / a;
        d.value -= a.ln();
        d.theta -= j * r;
        d.theta_theta += j * j * r * r;
    }
    d
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn probabilities_sum_to_one() {
        let n = 7u64;
        for theta in [0.0, 0.3, 5.0] {
            let sum: f64 = (0..=n)
                .map(|k| {
                    let choose: f64 = (0..k).map(|i| (n - i) as f64 / (k - i) as f64).product();
                    choose * log_likelihood(k, n, 0.3, theta).value.exp()
                })
                .sum();
            assert!((sum - 1.0).abs() < 1e-14, "θ = {theta}: {sum}");
        }
    }

    #[test]
    fn derivatives_match_differences() {
        let h = 1e-5;
        let f = |p: f64, t: f64| log_likelihood(5, 12, p, t);
        let d = f(0.4, 0.2);
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-6 * (1.0 + b.abs()), "{a} {b}");
        close(d.p, (f(0.4 + h, 0.2).value - f(0.4 - h, 0.2).value) / (2.0 * h));
        close(d.theta, (f(0.4, 0.2 + h).value - f(0.4, 0.2 - h).value) / (2.0 * h));
        close(d.p_p, (f(0.4 + h, 0.2).p - f(0.4 - h, 0.2).p) / (2.0 * h));
        close(d.p_theta, (f(0.4, 0.2 + h).p - f(0.4, 0.2 - h).p) / (2.0 * h));
        close(d.theta_theta, (f(0.4, 0.2 + h).theta - f(0.4, 0.2 - h).theta) / (2.0 * h));
    }

    #[test]
    fn the_closed_form_of_the_binomial_agrees_with_the_sum() {
        let (k, n, p) = (3000, 5000, 0.61);
        let (fast, slow) = (log_likelihood(k, n, p, 0.0), log_likelihood(k, n, p, 1e-300));
        for (a, b) in [
            (fast.value, slow.value),
            (fast.p, slow.p),
            (fast.theta, slow.theta),
            (fast.p_p, slow.p_p),
            (fast.p_theta, slow.p_theta),
            (fast.theta_theta, slow.theta_theta),
        ] {
            assert!((a - b).abs() <= 1e-9 * b.abs(), "{a} {b}");
        }
    }
}
