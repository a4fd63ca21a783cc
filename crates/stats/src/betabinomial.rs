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

/// ln P(k of n) without the binomial coefficient: Σ_{j<k} ln(p + jθ) + Σ_{j<n−k} ln(1 − p + jθ) − Σ_{j<n} ln(1 + jθ), at a cost that does
/// not grow with n, and exact at θ = 0.
pub(crate) fn log_likelihood(k: u64, n: u64, p: f64, theta: f64) -> Derivatives {
    let (hits, misses, all) =
        (Sums::of(p, theta, k), Sums::of(1.0 - p, theta, n - k), Sums::of(1.0, theta, n));
    Derivatives {
        value: hits.ln + misses.ln - all.ln,
        p: hits.r - misses.r,
        theta: hits.jr + misses.jr - all.jr,
        p_p: -hits.rr - misses.rr,
        p_theta: misses.jrr - hits.jrr,
        theta_theta: all.jjrr - hits.jjrr - misses.jjrr,
    }
}

/// Sums over j = 0 … k − 1 of functions of r = 1/(c + jθ).
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    /// Σ ln(c + jθ).
    ln: f64,
    r: f64,
    jr: f64,
    rr: f64,
    jrr: f64,
    jjrr: f64,
}

/// Up to so many terms are added one by one.
const FEW: u64 = 64;
/// From here on the asymptotic series of the gamma function and its derivatives are exact to rounding.
const FAR: f64 = 20.0;

impl Sums {
    fn of(c: f64, theta: f64, k: u64) -> Sums {
        // Where kθ vanishes beside c, gamma functions would cancel; what is left of the power series is exact.
        if theta * k as f64 <= 1e-5 * c {
            Sums::nearly_equal(c, theta, k as f64)
        } else {
            Sums::rising(c, theta, k)
        }
    }

    /// The power series in θ.
    fn nearly_equal(c: f64, theta: f64, k: f64) -> Sums {
        if k == 0.0 {
            return Sums::default();
        }
        // Σj, Σj², Σj³, Σj⁴.
        let first = k * (k - 1.0) / 2.0;
        let second = first * (2.0 * k - 1.0) / 3.0;
        let third = first * first;
        let fourth = second * (3.0 * k * k - 3.0 * k - 1.0) / 5.0;
        let (r, t) = (1.0 / c, theta / c);
        Sums {
            ln: k * c.ln() + t * (first - t * (second / 2.0 - t * third / 3.0)),
            r: r * (k - t * (first - t * second)),
            jr: r * (first - t * (second - t * third)),
            rr: r * r * (k - t * (2.0 * first - t * 3.0 * second)),
            jrr: r * r * (first - t * (2.0 * second - t * 3.0 * third)),
            jjrr: r * r * (second - t * (2.0 * third - t * 3.0 * fourth)),
        }
    }

    /// The first terms one by one, the rest by differences of ln Γ, ψ and ψ′.
    fn rising(c: f64, theta: f64, k: u64) -> Sums {
        let a = c / theta;
        let first = if k <= FEW { k } else { (FAR - a).ceil().max(0.0) as u64 };
        let mut sums = Sums::default();
        for j in 0..first {
            let j = j as f64;
            let term = c + j * theta;
            let r = 1.0 / term;
            sums.ln += term.ln();
            sums.r += r;
            sums.jr += j * r;
            sums.rr += r * r;
            sums.jrr += j * r * r;
            sums.jjrr += j * j * r * r;
        }
        if first == k {
            return sums;
        }
        let count = (k - first) as f64;
        let (from, to) = (a + first as f64, a + k as f64);
        let odd = |of: fn(f64) -> f64| of(1.0 / from) - of(1.0 / to);
        let log = (count / from).ln_1p();
        // Σ ln x, Σ 1/x and Σ 1/x² over x = from … to − 1.
        let ln = (from - 0.5) * log - count + count * (to * theta).ln() - odd(stirling);
        let one = log + odd(digamma);
        let two = count / (from * to) + odd(trigamma);
        let r = 1.0 / theta;
        Sums {
            ln: sums.ln + ln,
            r: sums.r + r * one,
            jr: sums.jr + r * (count - a * one),
            rr: sums.rr + r * r * two,
            jrr: sums.jrr + r * r * (one - a * two),
            jjrr: sums.jjrr + r * r * (count - a * (2.0 * one - a * two)),
        }
    }
}

/// ln Γ(x) − (x − ½) ln x + x − ½ ln 2π, of 1/x.
fn stirling(r: f64) -> f64 {
    let r2 = r * r;
    r * (1.0 / 12.0 - r2 * (1.0 / 360.0 - r2 * (1.0 / 1260.0 - r2 * (1.0 / 1680.0 - r2 / 1188.0))))
}

/// ln x − ψ(x), of 1/x.
fn digamma(r: f64) -> f64 {
    let r2 = r * r;
    r / 2.0 + r2 * (1.0 / 12.0 - r2 * (1.0 / 120.0 - r2 * (1.0 / 252.0 - r2 * (1.0 / 240.0 - r2 / 132.0))))
}

/// ψ′(x) − 1/x, of 1/x.
fn trigamma(r: f64) -> f64 {
    let r2 = r * r;
    let rest = 1.0 / 6.0 - r2 * (1.0 / 30.0 - r2 * (1.0 / 42.0 - r2 * (1.0 / 30.0 - r2 * 5.0 / 66.0)));
    r2 * (0.5 + r * rest)
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

    /// The definition, term by term.
    fn plain(k: u64, n: u64, p: f64, theta: f64) -> [f64; 6] {
        let mut d = [0.0; 6];
        for (c, count, sign, slope) in [(p, k, 1.0, 1.0), (1.0 - p, n - k, 1.0, -1.0), (1.0, n, -1.0, 0.0)] {
            for j in 0..count {
                let j = j as f64;
                let r = 1.0 / (c + j * theta);
                let terms =
                    [-r.ln(), slope * r, j * r, -slope * slope * r * r, -slope * j * r * r, -j * j * r * r];
                d.iter_mut().zip(terms).for_each(|(sum, term)| *sum += sign * term);
            }
        }
        d
    }

    #[test]
    fn many_answers_give_what_the_sum_over_them_gives() {
        for (k, n, p) in
            [(3000, 5000, 0.61), (2, 4000, 0.01), (90_000, 100_000, 0.83), (0, 700, 0.2), (700, 700, 0.2)]
        {
            for theta in [0.0, 1e-300, 1e-12, 1e-9, 1e-7, 1e-5, 1e-3, 0.02, 0.4, 30.0] {
                let d = log_likelihood(k, n, p, theta);
                let fast = [d.value, d.p, d.theta, d.p_p, d.p_theta, d.theta_theta];
                for (which, (a, b)) in fast.iter().zip(plain(k, n, p, theta)).enumerate() {
                    // Derivatives in θ are differences of sums that are larger by far.
                    let size = plain(k, k, p, theta)[which].abs() + plain(0, n, p, theta)[which].abs();
                    assert!(
                        (a - b).abs() <= 1e-7 * b.abs() + 1e-9 * size,
                        "{which} at {k}/{n}, {p}, {theta}: {a} {b}"
                    );
                }
            }
        }
    }
}
