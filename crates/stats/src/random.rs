//! The crate's own seeded generator: xoshiro256++ started by SplitMix64 (Blackman & Vigna 2021).
//!
//! Same seed, same numbers, on every platform: bootstraps and simulations are reproducible by their seed alone.

/// A seeded pseudo-random generator (xoshiro256++, period 2²⁵⁶ − 1). Not for secrets.
#[derive(Clone, Debug)]
pub struct Random {
    state: [u64; 4],
}

impl Random {
    /// The generator of `seed`; any seed is good, 0 included.
    pub fn new(seed: u64) -> Self {
        Self::stream(seed, 0)
    }

    /// The `index`-th of a family of generators of one seed, so that a replicate's numbers don't depend on how many came before it.
    pub fn stream(seed: u64, index: u64) -> Self {
        let mut key = mix(seed) ^ mix(index.wrapping_add(0xD1B5_4A32_D192_ED03)).rotate_left(32);
        let state = std::array::from_fn(|_| {
            key = key.wrapping_add(0x9E37_79B9_7F4A_7C15);
            mix(key)
        });
        Self { state }
    }

    /// The next 64 random bits.
    pub fn next_u64(&mut self) -> u64 {
        let s = &mut self.state;
        let out = s[0].wrapping_add(s[3]).rotate_left(23).wrapping_add(s[0]);
        let t = s[1] << 17;
        s[2] ^= s[0];
        s[3] ^= s[1];
        s[1] ^= s[2];
        s[0] ^= s[3];
        s[2] ^= t;
        s[3] = s[3].rotate_left(45);
        out
    }

    /// Uniform in the open interval (0, 1), 53 bits.
    pub fn uniform(&mut self) -> f64 {
        ((self.next_u64() >> 11) as f64 + 0.5) * 2f64.powi(-53)
    }

    /// A uniform index in `0..n` (Lemire's multiplication; its bias is below n·2⁻⁶⁴). 0 for n = 0.
    pub fn below(&mut self, n: usize) -> usize {
        ((u128::from(self.next_u64()) * n as u128) >> 64) as usize
    }

    /// True with probability `p` (never for p ≤ 0 or NaN, always for p ≥ 1).
    pub fn bernoulli(&mut self, p: f64) -> bool {
        self.uniform() < p
    }

    /// Successes in `trials` independent tries of probability `p`.
    pub fn binomial(&mut self, trials: u64, p: f64) -> u64 {
        (0..trials).filter(|_| self.bernoulli(p)).count() as u64
    }

    /// A standard normal deviate (Marsaglia's polar method, one of each pair).
    pub fn normal(&mut self) -> f64 {
        loop {
            let (u, v) = (2.0 * self.uniform() - 1.0, 2.0 * self.uniform() - 1.0);
            let s = u * u + v * v;
            if s > 0.0 && s < 1.0 {
                return u * (-2.0 * s.ln() / s).sqrt();
            }
        }
    }

    /// A gamma deviate of the given shape > 0 and unit scale (Marsaglia & Tsang 2000).
    fn gamma(&mut self, shape: f64) -> f64 {
        if shape < 1.0 {
            let boost = self.uniform().ln() / shape;
            return self.gamma(shape + 1.0) * boost.exp();
        }
        let d = shape - 1.0 / 3.0;
        let c = 1.0 / (9.0 * d).sqrt();
        loop {
            let x = self.normal();
            let v = (1.0 + c * x).powi(3);
            if v > 0.0 && self.uniform().ln() < 0.5 * x * x + d - d * v + d * v.ln() {
                return d * v;
            }
        }
    }

    /// A probability with mean `mean` whose draws have intraclass correlation `icc` (a beta deviate; `icc` = 0 gives the mean itself, 1 gives 0 or 1).
    ///
    /// `mean` is clamped to [0, 1] and `icc` to [0, 1].
    pub fn beta(&mut self, mean: f64, icc: f64) -> f64 {
        let (mean, icc) = (mean.clamp(0.0, 1.0), icc.clamp(0.0, 1.0));
        if icc < 1e-12 || mean == 0.0 || mean == 1.0 {
            return mean;
        }
        let size = (1.0 - icc) / icc;
        if size < 1e-6 {
            return f64::from(u8::from(self.bernoulli(mean)));
        }
        let (a, b) = (self.gamma(mean * size), self.gamma((1.0 - mean) * size));
        if a + b > 0.0 { a / (a + b) } else { f64::from(u8::from(self.bernoulli(mean))) }
    }

    /// Shuffles in place, every order equally likely (Fisher–Yates).
    pub fn shuffle<T>(&mut self, items: &mut [T]) {
        for i in (1..items.len()).rev() {
            items.swap(i, self.below(i + 1));
        }
    }
}

/// SplitMix64's finaliser.
fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn xoshiro_gives_the_reference_sequence() {
        // First outputs of the authors' C program for the state 1, 2, 3, 4.
        let mut random = Random { state: [1, 2, 3, 4] };
        let expected = [41943041, 58720359, 3588806011781223, 3591011842654386];
        assert_eq!(expected, std::array::from_fn(|_| random.next_u64()));
    }

    #[test]
    fn streams_differ_and_repeat() {
        let draw = |seed, index| Random::stream(seed, index).next_u64();
        assert_eq!(draw(7, 3), draw(7, 3));
        assert_ne!(draw(7, 3), draw(7, 4));
        assert_ne!(draw(7, 3), draw(8, 3));
        assert_ne!(draw(3, 7), draw(7, 3));
    }

    #[test]
    fn deviates_have_their_moments() {
        let mut random = Random::new(1);
        let n = 200_000;
        let (mut sum, mut square, mut prob, mut prob2) = (0.0, 0.0, 0.0, 0.0);
        for _ in 0..n {
            let z = random.normal();
            sum += z;
            square += z * z;
            let p = random.beta(0.3, 0.2);
            prob += p;
            prob2 += (p - 0.3) * (p - 0.3);
        }
        let n = f64::from(n);
        // Five standard errors each.
        assert!((sum / n).abs() < 5.0 / n.sqrt());
        assert!((square / n - 1.0).abs() < 5.0 * (2.0 / n).sqrt());
        assert!((prob / n - 0.3).abs() < 5.0 * (0.2f64 * 0.21 / n).sqrt());
        assert!((prob2 / n - 0.2 * 0.21).abs() < 1e-3, "variance of the beta deviate {}", prob2 / n);
        let hits = random.binomial(10_000, 0.25);
        assert!(hits.abs_diff(2500) < 220);
        assert_eq!(0, random.below(0));
    }
}
