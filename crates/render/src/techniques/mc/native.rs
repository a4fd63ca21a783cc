//! The sampler on the CPU: sixteen lanes are the sixteen replicates, so that their sums never meet.

use super::bounds::Padded;
use super::plan::{Axis, EmitterPlan, Plan};
use super::points::{self, Points, REPLICATES};
use crate::simd::Isa;

/// Sums of one pixel's and one emitter's replicates, per channel.
pub type Sums<const C: usize> = [[f64; REPLICATES]; C];

type Lanes = [f32; REPLICATES];

/// What a pixel's sums need.
pub struct Sampler<'a> {
    /// The scene.
    pub plan: &'a Plan,
    /// The planes' masks.
    pub masks: &'a [std::sync::Arc<Padded>],
    /// The points.
    pub points: &'a Points,
    /// Points per replicate.
    pub samples: usize,
    /// The folded seed.
    pub seed: u32,
    /// Which planes the light passes.
    pub planes: std::ops::Range<usize>,
}

impl Sampler<'_> {
    /// Per channel and replicate: Σ (V − v0) / (1 + tan²θ)² over the points, for pixel (i, j) and emitter `k`, where V
    /// and `v0` are products of codes.
    ///
    /// The arithmetic is the same on every machine (no fused operations, a fixed order), only its width differs.
    pub fn sums<const C: usize>(&self, k: usize, i: usize, j: usize, v0: [f32; C]) -> Sums<C> {
        #[cfg(target_arch = "x86_64")]
        match Isa::detect() {
            // SAFETY: detected on this machine.
            Isa::Avx512 => return unsafe { self.sums_avx512::<C>(k, i, j, v0) },
            // SAFETY: detected on this machine.
            Isa::Avx2 => return unsafe { self.sums_avx2::<C>(k, i, j, v0) },
            Isa::Plain => {}
        }
        self.sums_any::<C>(k, i, j, v0)
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl")]
    fn sums_avx512<const C: usize>(&self, k: usize, i: usize, j: usize, v0: [f32; C]) -> Sums<C> {
        self.sums_any::<C>(k, i, j, v0)
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn sums_avx2<const C: usize>(&self, k: usize, i: usize, j: usize, v0: [f32; C]) -> Sums<C> {
        self.sums_any::<C>(k, i, j, v0)
    }

    #[inline(always)]
    pub(super) fn sums_any<const C: usize>(&self, k: usize, i: usize, j: usize, v0: [f32; C]) -> Sums<C> {
        match self.plan.area {
            true => self.pixel::<C, true>(k, i, j, v0),
            false => self.pixel::<C, false>(k, i, j, v0),
        }
    }

    #[inline(always)]
    fn pixel<const C: usize, const AREA: bool>(&self, k: usize, i: usize, j: usize, v0: [f32; C]) -> Sums<C> {
        /// f32 sums of this many steps are added to f64 ones: rounding stays below 1e-6 however many points.
        const FLUSH: usize = 32;
        let emitter = &self.plan.emitters[k];
        let key = points::stream(self.seed, (j * self.plan.size[0] + i) as u32, k as u32);
        let shifts: [[u32; REPLICATES]; points::DIMENSIONS] =
            std::array::from_fn(|d| std::array::from_fn(|r| points::shift(key, d, r)));
        let dims = self.points.dims.each_ref().map(|d| &d.as_chunks::<REPLICATES>().0[..self.samples]);
        let mut sums = [[0f64; REPLICATES]; C];
        let mut n = 0;
        while n < self.samples {
            let end = self.samples.min(n + FLUSH);
            let mut part = [[0f32; REPLICATES]; C];
            let steps = dims.map(|d| &d[n..end]);
            for (((ux, uy), vx), vy) in steps[0].iter().zip(steps[1]).zip(steps[2]).zip(steps[3]) {
                let u = [unit(ux, &shifts[0]), unit(uy, &shifts[1])];
                let v = match AREA {
                    true => [unit(vx, &shifts[2]), unit(vy, &shifts[3])],
                    false => [[0.0; REPLICATES]; 2],
                };
                let seen = self.visibility::<C, AREA>(emitter, i, j, &u, &v);
                let weight = weight::<AREA>(emitter, i, j, &u, &v);
                for c in 0..C {
                    for r in 0..REPLICATES {
                        part[c][r] += (seen[c][r] - v0[c]) * weight[r];
                    }
                }
            }
            for c in 0..C {
                for r in 0..REPLICATES {
                    sums[c][r] += f64::from(part[c][r]);
                }
            }
            n = end;
        }
        sums
    }

    /// Products of the planes' codes at one step's sixteen points.
    #[inline(always)]
    fn visibility<const C: usize, const AREA: bool>(
        &self,
        emitter: &EmitterPlan,
        i: usize,
        j: usize,
        u: &[Lanes; 2],
        v: &[Lanes; 2],
    ) -> [Lanes; C] {
        let mut seen = [[1f32; REPLICATES]; C];
        for (map, mask) in emitter.planes[self.planes.clone()].iter().zip(&self.masks[self.planes.clone()]) {
            let x = texels::<AREA>(&map.columns[i], map.emitter[0], map.pixel[0], &u[0], &v[0]);
            let y = texels::<AREA>(&map.rows[j], map.emitter[1], map.pixel[1], &u[1], &v[1]);
            let mut at = [0u32; REPLICATES];
            for r in 0..REPLICATES {
                at[r] = y[r] * mask.stride as u32 + x[r];
            }
            for (c, seen) in seen.iter_mut().enumerate() {
                let plane = if c < mask.channels { c } else { 0 } * mask.stride * mask.rows;
                let codes = &mask.codes[plane..plane + mask.stride * mask.rows];
                let mut code = [0u16; REPLICATES];
                for r in 0..REPLICATES {
                    code[r] = codes[at[r] as usize];
                }
                for r in 0..REPLICATES {
                    seen[r] *= f32::from(code[r]);
                }
            }
        }
        seen
    }
}

/// Coordinates in [−½, ½): 24 bits, exact in f32 on every backend.
#[inline(always)]
fn unit(words: &[u32; REPLICATES], shift: &[u32; REPLICATES]) -> Lanes {
    std::array::from_fn(|r| ((words[r] ^ shift[r]) as i32 >> 8) as f32 * (1.0 / 16_777_216.0))
}

/// Padded texels along one axis.
#[inline(always)]
fn texels<const AREA: bool>(
    axis: &Axis,
    emitter: f32,
    pixel: f32,
    u: &Lanes,
    v: &Lanes,
) -> [u32; REPLICATES] {
    std::array::from_fn(|r| {
        let mut t = axis.offset + emitter * u[r];
        if AREA {
            t += pixel * v[r];
        }
        // Written so that a NaN falls on the border too.
        t = if t > axis.low { t } else { axis.low };
        t = if t < axis.high { t } else { axis.high };
        // SAFETY: low and high are small integers, and t is between them.
        let t: i32 = unsafe { t.floor().to_int_unchecked() };
        (t + axis.anchor) as u32
    })
}

/// 1 / (1 + tan²θ)²: both cosines over the squared distance, times the lamp's squared distance.
#[inline(always)]
fn weight<const AREA: bool>(e: &EmitterPlan, i: usize, j: usize, u: &[Lanes; 2], v: &[Lanes; 2]) -> Lanes {
    let (column, row) = (e.columns[i], e.rows[j]);
    std::array::from_fn(|r| {
        let mut x = column - e.emitter[0] * u[0][r];
        let mut y = row - e.emitter[1] * u[1][r];
        if AREA {
            x += e.pixel[0] * v[0][r];
            y += e.pixel[1] * v[1][r];
        }
        let w = 1.0 + (x * x + y * y);
        1.0 / (w * w)
    })
}
