//! What a projector throws: patterns of one mean, and pictures.

use std::sync::Arc;

use crate::theatre::LinearImage;

/// A slide over the unit square: u rightwards and v downwards as the projector sees it.
#[derive(Clone, Debug, PartialEq)]
pub struct Slide {
    /// What is on it.
    pub pattern: Pattern,
    /// Turned by so many degrees about its middle, counter-clockwise as the projector sees it.
    pub orientation_deg: f64,
    /// Share of the half side over which the spot's edge fades; 0 is a sharp edge. Pictures have no spot around them.
    pub edge: f64,
    /// The mean that has to be taken off the pattern, so that all slides are equally bright.
    mean: f64,
}

/// What is on a slide. Frequencies are in cycles a side; amplitudes in [0, 1].
#[derive(Clone, Debug, PartialEq)]
pub enum Pattern {
    /// Nothing but the spot.
    Spot,
    /// A product of sines along u and v.
    Sine {
        /// How far it goes from its mean.
        amplitude: f64,
        /// Cycles a side along u and v.
        frequency: [f64; 2],
        /// Degrees along u and v.
        phase_deg: [f64; 2],
    },
    /// The sign of such a product: squares.
    Checker {
        /// How far it goes from its mean.
        amplitude: f64,
        /// Cycles (two squares each) a side along u and v.
        frequency: [f64; 2],
        /// Degrees along u and v.
        phase_deg: [f64; 2],
    },
    /// A sum of waves in all directions, of frequencies within a band.
    Noise {
        /// How far it goes from its mean at most.
        amplitude: f64,
        /// Least and largest frequency.
        band: [f64; 2],
        /// Of its directions and phases.
        seed: u64,
    },
    /// A picture, linear, over the whole square.
    Image(Arc<LinearImage>),
}

/// Waves that a [`Pattern::Noise`] is made of.
const WAVES: usize = 48;

/// Points a side that a mean is measured at.
const MEAN: usize = 512;

impl Slide {
    /// A slide; its mean is that of the spot alone: every pattern of one `edge` is as bright as any other.
    pub fn new(pattern: Pattern, orientation_deg: f64, edge: f64) -> Self {
        let mut slide = Self { pattern, orientation_deg, edge, mean: 0.0 };
        if !matches!(slide.pattern, Pattern::Spot | Pattern::Image(_)) {
            let (mut light, mut weighed) = (0.0, 0.0);
            for k in 0..MEAN * MEAN {
                let [u, v] = [k % MEAN, k / MEAN].map(|x| (x as f64 + 0.5) / MEAN as f64);
                let spot = slide.spot(u, v);
                light += spot;
                weighed += if spot > 0.0 { spot * slide.wave(u, v) } else { 0.0 };
            }
            slide.mean = if light > 0.0 { weighed / light } else { 0.0 };
        }
        slide
    }

    /// What it lets through at (u, v), linear, one a channel, in [0, 1]: nothing outside of the square.
    pub fn at(&self, u: f64, v: f64) -> [f64; 3] {
        if !((0.0..=1.0).contains(&u) && (0.0..=1.0).contains(&v)) {
            return [0.0; 3];
        }
        if let Pattern::Image(image) = &self.pattern {
            let [u, v] = self.turned(u, v);
            return [0, 1, 2].map(|c| image.at(c, u, v));
        }
        let spot = self.spot(u, v);
        if spot == 0.0 {
            return [0.0; 3];
        }
        let amplitude = self.amplitude();
        let wave =
            if amplitude == 0.0 { 0.0 } else { (self.wave(u, v) - self.mean) / (1.0 + self.mean.abs()) };
        [0.5 * spot * (1.0 + amplitude * wave); 3]
    }

    /// Whether it is as it is in `other`, in all that a timeline can move.
    pub(super) fn same_staging(&self, other: &Self) -> bool {
        let phase = |slide: &Self| match slide.pattern {
            Pattern::Sine { phase_deg, .. } | Pattern::Checker { phase_deg, .. } => phase_deg,
            _ => [0.0; 2],
        };
        self.orientation_deg == other.orientation_deg && phase(self) == phase(other)
    }

    fn amplitude(&self) -> f64 {
        match self.pattern {
            Pattern::Sine { amplitude, .. }
            | Pattern::Checker { amplitude, .. }
            | Pattern::Noise { amplitude, .. } => amplitude,
            _ => 0.0,
        }
    }

    /// The spot: 1 inside, fading to 0 at the circle that the square holds.
    fn spot(&self, u: f64, v: f64) -> f64 {
        let rho = 2.0 * (u - 0.5).hypot(v - 0.5);
        if self.edge <= 0.0 {
            return if rho <= 1.0 { 1.0 } else { 0.0 };
        }
        let t = ((1.0 - rho) / self.edge).clamp(0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    }

    fn turned(&self, u: f64, v: f64) -> [f64; 2] {
        if self.orientation_deg == 0.0 {
            return [u, v];
        }
        let (sin, cos) = self.orientation_deg.to_radians().sin_cos();
        let (x, y) = (u - 0.5, v - 0.5);
        // v runs downwards: this turns the pattern counter-clockwise.
        [0.5 + cos * x - sin * y, 0.5 + sin * x + cos * y]
    }

    /// The pattern, in [−1, 1], without amplitude and spot.
    fn wave(&self, u: f64, v: f64) -> f64 {
        let [u, v] = self.turned(u, v);
        let product = |frequency: &[f64; 2], phase_deg: &[f64; 2]| {
            let wave = |k: usize, x: f64| {
                (std::f64::consts::TAU * frequency[k] * x + phase_deg[k].to_radians()).sin()
            };
            wave(0, u) * wave(1, v)
        };
        match &self.pattern {
            Pattern::Spot | Pattern::Image(_) => 0.0,
            Pattern::Sine { frequency, phase_deg, .. } => product(frequency, phase_deg),
            Pattern::Checker { frequency, phase_deg, .. } => {
                let x = product(frequency, phase_deg);
                if x == 0.0 { 0.0 } else { x.signum() }
            }
            Pattern::Noise { band, seed, .. } => {
                let mut state = *seed;
                let sum: f64 = (0..WAVES)
                    .map(|_| {
                        let [ring, angle, phase] = [(); 3].map(|()| unit(&mut state));
                        // Even over the band's area in the plane of frequencies.
                        let f = (band[0] * band[0] + ring * (band[1] * band[1] - band[0] * band[0])).sqrt();
                        let (sin, cos) = (std::f64::consts::TAU * angle).sin_cos();
                        (std::f64::consts::TAU * (f * (cos * u + sin * v) + phase)).sin()
                    })
                    .sum();
                // Four standard deviations of the sum; what little is beyond is cut.
                (sum / (4.0 * (WAVES as f64 / 2.0).sqrt())).clamp(-1.0, 1.0)
            }
        }
    }
}

/// The next of a row of numbers in [0, 1) (SplitMix64).
fn unit(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut x = *state;
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((x ^ (x >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mean(slide: &Slide) -> f64 {
        // Another grid than the one that means are taken off by.
        let n = 997;
        let at = |k: usize| (k as f64 + 0.5) / n as f64;
        (0..n * n).map(|k| slide.at(at(k % n), at(k / n))[0]).sum::<f64>() / (n * n) as f64
    }

    /// A study of slides is no study of dimness.
    #[test]
    fn all_patterns_have_one_mean_and_stay_within_their_bounds() {
        let sine = |amplitude, f: f64, phase| Pattern::Sine {
            amplitude,
            frequency: [f, f],
            phase_deg: [phase, phase],
        };
        let spot = mean(&Slide::new(Pattern::Spot, 0.0, 0.1));
        // A disk that fades over a tenth: closed form of the mean over the square, half as bright.
        let closed = {
            let n = 100_000;
            let ring = |k: usize| {
                let rho = (k as f64 + 0.5) / n as f64;
                let t = ((1.0 - rho) / 0.1f64).clamp(0.0, 1.0);
                t * t * (3.0 - 2.0 * t) * rho
            };
            0.5 * std::f64::consts::PI / 2.0 * (0..n).map(ring).sum::<f64>() / n as f64
        };
        assert!((spot - closed).abs() < 1e-5, "{spot} {closed}");
        for (pattern, turn) in [
            (sine(1.0, 1.0, 0.0), 0.0),
            (sine(1.0, 4.0, 0.0), 30.0),
            (sine(0.5, 15.0, 0.0), 0.0),
            (sine(1.0, 0.7, 90.0), 10.0),
            (sine(1.0, 0.0, 90.0), 0.0),
            (Pattern::Checker { amplitude: 1.0, frequency: [3.0, 2.0], phase_deg: [20.0, 0.0] }, 5.0),
            (Pattern::Noise { amplitude: 1.0, band: [3.0, 6.0], seed: 4 }, 0.0),
        ] {
            let slide = Slide::new(pattern, turn, 0.1);
            assert!((mean(&slide) / spot - 1.0).abs() < 2e-3, "{slide:?}: {}", mean(&slide));
            let values = (0..10_000).map(|k| slide.at((k % 100) as f64 / 99.0, (k / 100) as f64 / 99.0)[0]);
            assert!(values.into_iter().all(|s| (0.0..=1.0).contains(&s)));
        }
        // What the mean is taken off for: without, a slide of slow waves would be far from it.
        let raw = Slide { mean: 0.0, ..Slide::new(sine(1.0, 0.3, 90.0), 0.0, 0.1) };
        assert!((mean(&raw) / spot - 1.0).abs() > 0.1);
    }

    /// The paper's sine, where its closed form is easy to read: peaks, zeros and the square's end.
    #[test]
    fn a_sine_is_where_it_says() {
        let slide = Slide::new(
            Pattern::Sine { amplitude: 1.0, frequency: [1.0, 1.0], phase_deg: [0.0; 2] },
            0.0,
            0.0,
        );
        let at = |u, v| slide.at(u, v)[0];
        assert!((at(0.25, 0.25) - 1.0).abs() < 1e-9 && at(0.75, 0.25).abs() < 1e-9);
        assert!((at(0.5, 0.25) - 0.5).abs() < 1e-9);
        assert_eq!((at(0.01, 0.01), at(-0.1, 0.5), at(0.5, 1.1)), (0.0, 0.0, 0.0));
        // A quarter turn counter-clockwise: what was on the right is on top, where v is small.
        let turned = Slide { orientation_deg: 90.0, ..slide.clone() };
        assert!((turned.at(0.25, 0.25)[0] - at(0.75, 0.25)).abs() < 1e-9);
    }

    #[test]
    fn noise_stays_within_its_band() {
        let slide = Slide::new(Pattern::Noise { amplitude: 1.0, band: [4.0, 8.0], seed: 9 }, 0.0, 0.0);
        // Its share along each whole frequency by a plain Fourier sum over the square, spot and mean left out.
        let n = 64;
        let power = |fu: f64, fv: f64| {
            let (mut re, mut im) = (0.0, 0.0);
            for k in 0..n * n {
                let [u, v] = [k % n, k / n].map(|x| (x as f64 + 0.5) / n as f64);
                // A window keeps one frequency from leaking into all others.
                let w = (std::f64::consts::PI * u).sin().powi(2) * (std::f64::consts::PI * v).sin().powi(2);
                let (s, c) = (std::f64::consts::TAU * (fu * u + fv * v)).sin_cos();
                re += w * slide.wave(u, v) * c;
                im += w * slide.wave(u, v) * s;
            }
            (re * re + im * im) / (n as f64).powi(4)
        };
        let (mut inside, mut outside) = (0.0, 0.0);
        for fu in -16..=16 {
            for fv in 0..=16 {
                let f = f64::from(fu * fu + fv * fv).sqrt();
                let p = power(f64::from(fu), f64::from(fv));
                if (2.5..=9.5).contains(&f) { inside += p } else { outside += p }
            }
        }
        assert!(outside < 0.01 * inside, "{outside} {inside}");
    }
}
