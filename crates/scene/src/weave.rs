//! Procedural cotton cloth: a plain weave seen with the light behind it.

use kelir_reader::Node;
use rayon::prelude::*;

use crate::limits;
use crate::theatre::LinearImage;

/// The cloth's parameters.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Weave {
    /// Mean linear albedo before the vignette.
    pub base: [f64; 3],
    /// Threads across the width.
    pub threads: u32,
    /// How much threads and gaps differ, 0 to 1.
    pub contrast: f64,
    /// How much darker the corners are, 0 to 1.
    pub vignette: f64,
    /// Which cloth.
    pub seed: u64,
}

impl Weave {
    pub(crate) fn read(node: &Node) -> Option<Self> {
        let mut fields = node.table()?;
        let share = "is between 0 and 1";
        let base =
            fields.optional("base", "mean albedo, a number or [r, g, b]; without it 0.8", [0.8; 3], |n| {
                n.rgb(|x| x.number_in(0.0..=1.0, "an albedo is between 0 and 1"))
            });
        let threads = fields.optional("threads", "threads across the width; without it 480", 480, |n| {
            n.integer_in(1..=2000, "threads across the width are 1 to 2000")
        });
        let contrast =
            fields.optional("contrast", "how much threads and gaps differ; without it 0.08", 0.08, |n| {
                n.number_in(0.0..=1.0, share)
            });
        let vignette =
            fields.optional("vignette", "how much darker the corners are; without it 0", 0.0, |n| {
                n.number_in(0.0..=1.0, share)
            });
        let seed = fields.optional("seed", "which cloth; without it 1", 1, |n| {
            n.integer_in(0.., "a seed is a whole number from 0")
        });
        fields.done();
        Some(Self {
            base: base?,
            threads: threads? as u32,
            contrast: contrast?,
            vignette: vignette?,
            seed: seed? as u64,
        })
    }

    /// The cloth stretched over a screen, four pixels a thread; the same on every machine.
    pub(crate) fn rasterise(&self, width_m: f64, height_m: f64) -> LinearImage {
        let width = (4 * self.threads as usize).clamp(1, limits::IMAGE_SIDE);
        let height = ((width as f64 * height_m / width_m).round() as usize).clamp(1, limits::IMAGE_SIDE);
        let pitch = width as f64 / f64::from(self.threads);
        let mut rgb = vec![[0.0f32; 3]; width * height];
        rgb.par_chunks_exact_mut(width).enumerate().for_each(|(y, row)| {
            for (x, pixel) in row.iter_mut().enumerate() {
                let light = self.light(x as f64 + 0.5, y as f64 + 0.5, pitch, [width as f64, height as f64]);
                *pixel = self.base.map(|base| (base * light).clamp(0.0, 1.0) as f32);
            }
        });
        LinearImage::new(width, height, &rgb)
    }

    /// Share of the base albedo at a pixel.
    fn light(&self, x: f64, y: f64, pitch: f64, [width, height]: [f64; 2]) -> f64 {
        // Threads wander: slow waves along each thread, different for each.
        let warp = x / pitch + 0.18 * self.noise(1, (x / pitch).floor(), y / (pitch * 14.0));
        let weft = y / pitch + 0.18 * self.noise(2, (y / pitch).floor(), x / (pitch * 14.0));
        // (A parabola, not a sine: plain arithmetic is the same on every machine.)
        let over = |t: f64| 4.0 * t.rem_euclid(1.0) * (1.0 - t.rem_euclid(1.0));
        // Where a thread is thick less light comes through; gaps at the corners between threads let most through.
        let body = 1.0 - over(warp) * over(weft);
        // Plain weave: warp above weft on every second crossing, slightly lighter.
        let crossing = if (warp.floor() + weft.floor()).rem_euclid(2.0) < 1.0 { 0.12 } else { -0.12 };
        // Slubs: every thread has its own thickness, which changes slowly along it.
        let slub = 0.35 * self.noise(3, warp.floor(), y / (pitch * 40.0))
            + 0.35 * self.noise(4, weft.floor(), x / (pitch * 40.0));
        // Uneven cloth at the scale of a hand.
        let cloud = 0.3 * self.smooth(5, x / width * 6.0, y / width * 6.0);
        let cloth = (body - 5.0 / 9.0) * 1.2 + crossing + slub + cloud;
        let (u, v) = (2.0 * x / width - 1.0, 2.0 * y / height - 1.0);
        let corner = 0.5 * (u * u + v * v);
        (1.0 + self.contrast * cloth) * (1.0 - self.vignette * corner * corner)
    }

    /// In [−1, 1]: smooth along the second coordinate, independent from one integer `line` to the next.
    fn noise(&self, stream: u64, line: f64, along: f64) -> f64 {
        let cell = along.floor();
        let u = along - cell;
        let weight = u * u * (3.0 - 2.0 * u);
        let value = |c: f64| self.hash(stream, line as i64, c as i64);
        value(cell) + weight * (value(cell + 1.0) - value(cell))
    }

    /// In [−1, 1]: smooth in both coordinates.
    fn smooth(&self, stream: u64, x: f64, y: f64) -> f64 {
        let cell = x.floor();
        let u = x - cell;
        let weight = u * u * (3.0 - 2.0 * u);
        let (a, b) = (self.noise(stream, cell, y), self.noise(stream, cell + 1.0, y));
        a + weight * (b - a)
    }

    /// A fixed pseudo-random number in [−1, 1] (splitmix64's finaliser over the mixed coordinates).
    fn hash(&self, stream: u64, a: i64, b: i64) -> f64 {
        let mut h =
            self.seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ stream.wrapping_mul(0xd1b5_4a32_d192_ed03);
        for value in [a as u64, b as u64] {
            h = (h ^ value).wrapping_add(0x9e37_79b9_7f4a_7c15);
            h = (h ^ (h >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            h = (h ^ (h >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            h ^= h >> 31;
        }
        (h >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}
