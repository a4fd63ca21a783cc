//! The sampler on the CPU: sixteen lanes are the sixteen replicates, so that their sums never meet.

use kelir_frame::Isa;

use super::axis::Axis;
use super::bounds::Padded;
use super::plan::{EmitterPlan, Parallel, Plan, PlaneMap, Shape};
use super::sobol::{self, Points, REPLICATES};
use super::tables::{self, Side, Tables};
use super::tilted::{Seen, Tilted};

/// f32 sums of this many steps are added to f64 ones: rounding stays below 1e-6 however many points.
pub(super) const FLUSH: usize = 32;

/// Sums of one pixel's and one emitter's replicates, per channel.
pub(super) type Sums<const C: usize> = [[f64; REPLICATES]; C];

type Lanes = [f32; REPLICATES];

/// What a pixel's sums need.
pub(super) struct Sampler<'a> {
    /// The scene.
    pub plan: &'a Plan,
    /// The planes' masks.
    pub masks: &'a [std::sync::Arc<Padded>],
    /// The points.
    pub points: &'a Points,
    /// Which planes the light passes.
    pub planes: std::ops::Range<usize>,
    /// Where the points fall, for the sources that have it ready.
    pub tables: &'a Tables,
}

impl Sampler<'_> {
    /// Per channel and replicate: Σ (V − v0) / (1 + tan²θ)² over the points, for pixel (i, j) and emitter `k`, where V
    /// and `v0` are products of codes in units of [`Padded::unit`].
    ///
    /// The arithmetic is the same on every machine (no fused operations, a fixed order), only its width differs.
    pub(super) fn sums<const C: usize>(&self, k: usize, i: usize, j: usize, v0: [f32; C]) -> Sums<C> {
        #[cfg(target_arch = "x86_64")]
        match Isa::detect() {
            // SAFETY: detected on this machine.
            Isa::Avx512 => return unsafe { self.sums_avx512::<C>(k, i, j, v0) },
            // SAFETY: detected on this machine.
            Isa::Avx2 => return unsafe { self.sums_avx2::<C>(k, i, j, v0) },
            Isa::Baseline => {}
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
        let key = sobol::stream(sobol::fold(self.points.seed), (j * self.plan.size[0] + i) as u32, k as u32);
        match (self.tables.sides(k, &self.planes, key), self.plan.area) {
            (Some(sides), _) => self.tabled::<C>(k, [i, j], sides, v0),
            (None, true) => self.pixel::<C, true>(k, i, j, key, v0),
            (None, false) => self.pixel::<C, false>(k, i, j, key, v0),
        }
    }

    /// [`Self::sums`] where the points' places are known already.
    #[inline(always)]
    fn tabled<const C: usize>(&self, k: usize, pixel: [usize; 2], sides: [Side; 2], v0: [f32; C]) -> Sums<C> {
        let emitter = &self.plan.emitters[k];
        let middle = [emitter.columns[pixel[0]], emitter.rows[pixel[1]]];
        let planes = emitter.planes[self.planes.clone()].iter().zip(&self.masks[self.planes.clone()]);
        let samples = self.points.samples;
        let mut sums = [[0f64; REPLICATES]; C];
        let mut n = 0;
        while n < samples {
            let steps = FLUSH.min(samples - n);
            let mut seen = [[[1f32; REPLICATES]; C]; FLUSH];
            for (plane, (map, mask)) in planes.clone().enumerate() {
                let PlaneMap::Parallel(map) = map else { unreachable!("tables are of parallel planes") };
                let places = sides.each_ref().map(|side| &side.places[plane * samples + n..][..steps]);
                map.look_up::<C>(mask, pixel, places, &mut seen[..steps]);
            }
            let mut part = [[0f32; REPLICATES]; C];
            let [x, y] = sides.each_ref().map(|side| &side.tangents[n..][..steps]);
            for ((seen, x), y) in seen.iter().zip(x).zip(y) {
                let mut weight = [0f32; REPLICATES];
                for r in 0..REPLICATES {
                    let (x, y) = (middle[0] - f32::from_bits(x[r]), middle[1] - f32::from_bits(y[r]));
                    let w = 1.0 + (x * x + y * y);
                    weight[r] = 1.0 / (w * w);
                }
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
            n += steps;
        }
        sums
    }

    #[inline(always)]
    fn pixel<const C: usize, const AREA: bool>(
        &self,
        k: usize,
        i: usize,
        j: usize,
        key: u32,
        v0: [f32; C],
    ) -> Sums<C> {
        let emitter = &self.plan.emitters[k];
        let mut shifts = [[0; REPLICATES]; sobol::DIMENSIONS];
        for (d, shifts) in shifts.iter_mut().enumerate() {
            for (r, shift) in shifts.iter_mut().enumerate() {
                *shift = if self.points.scrambled { sobol::shift(key, d, r) } else { 0 };
            }
        }
        let dims = self.points.dims.each_ref().map(|d| &d.as_chunks::<REPLICATES>().0[..self.points.samples]);
        let planes = &emitter.planes[self.planes.clone()];
        let tilted: Vec<Seen> = planes
            .iter()
            .filter_map(|map| match map {
                PlaneMap::Parallel(_) => None,
                PlaneMap::Tilted(map) => Some(map.seen(i, j)),
            })
            .collect();
        let mut sums = [[0f64; REPLICATES]; C];
        let mut n = 0;
        while n < self.points.samples {
            let end = self.points.samples.min(n + FLUSH);
            let mut part = [[0f32; REPLICATES]; C];
            let [ux, uy, vx, vy] = dims;
            let steps = ux[n..end].iter().zip(&uy[n..end]).zip(&vx[n..end]).zip(&vy[n..end]);
            for (((ux, uy), vx), vy) in steps {
                let mut u = [unit(ux, &shifts[0]), unit(uy, &shifts[1])];
                let v = match AREA {
                    true => [unit(vx, &shifts[2]), unit(vy, &shifts[3])],
                    false => [[0.0; REPLICATES]; 2],
                };
                match emitter.shape {
                    Shape::Rectangle => {}
                    Shape::Disk => u = disk(&u),
                    Shape::Dome => u = tangents(&disk(&u)),
                }
                let seen = self.visibility::<C, AREA>(emitter, &tilted, [i, j], &u, &v);
                let weight = match emitter.shape {
                    Shape::Dome => [1.0; REPLICATES],
                    _ => weight::<AREA>(emitter, i, j, &u, &v),
                };
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

    /// Products of the planes' codes, each in its unit, at one step's sixteen points.
    #[inline(always)]
    fn visibility<const C: usize, const AREA: bool>(
        &self,
        emitter: &EmitterPlan,
        tilted: &[Seen],
        [i, j]: [usize; 2],
        u: &[Lanes; 2],
        v: &[Lanes; 2],
    ) -> [Lanes; C] {
        let mut seen = [[1f32; REPLICATES]; C];
        let mut tilted = tilted;
        for (map, mask) in emitter.planes[self.planes.clone()].iter().zip(&self.masks[self.planes.clone()]) {
            let [x, y] = match map {
                PlaneMap::Parallel(map) => [
                    texels::<AREA>(&map.columns[i], map.emitter[0], map.pixel[0], &u[0], &v[0]),
                    texels::<AREA>(&map.rows[j], map.emitter[1], map.pixel[1], &u[1], &v[1]),
                ],
                PlaneMap::Tilted(map) => {
                    let (seen, others) = tilted.split_first().expect("one a tilted plane");
                    tilted = others;
                    tilted_texels(map, seen, u, v)
                }
            };
            let mut at = [0u32; REPLICATES];
            for r in 0..REPLICATES {
                at[r] = y[r].wrapping_mul(mask.stride as u32).wrapping_add(x[r]);
            }
            for (c, seen) in seen.iter_mut().enumerate() {
                let plane = if c < mask.channels { c } else { 0 } * mask.stride * mask.rows;
                let codes = &mask.codes[plane..plane + mask.stride * mask.rows];
                // SAFETY: both texels are clamped to the padded grid.
                let code = unsafe { gather(codes, &at) };
                for r in 0..REPLICATES {
                    seen[r] *= f32::from(code[r]) * mask.unit;
                }
            }
        }
        seen
    }
}

impl Parallel {
    /// Multiplies into `seen` what the plane lets through at the places of some steps, as seen from a pixel.
    #[inline(always)]
    fn look_up<const C: usize>(
        &self,
        mask: &Padded,
        [i, j]: [usize; 2],
        [x, y]: [&[tables::Lanes]; 2],
        seen: &mut [[Lanes; C]],
    ) {
        let (column, row) = (self.middles[0][i], self.middles[1][j]);
        let (anchor_x, anchor_y) = (self.columns[i].anchor, self.rows[j].anchor);
        let (shift_x, shift_y) = (self.fixed[0].shift, self.fixed[1].shift);
        let (last_x, last_y) = (mask.stride as i32 - 1, mask.rows as i32 - 1);
        let texels = mask.stride * mask.rows;
        for ((x, y), seen) in x.iter().zip(y).zip(seen) {
            let mut at = [0u32; REPLICATES];
            for r in 0..REPLICATES {
                let x = ((x[r] as i32).wrapping_add(column) >> shift_x).wrapping_add(anchor_x);
                let y = ((y[r] as i32).wrapping_add(row) >> shift_y).wrapping_add(anchor_y);
                let (x, y) = (x.max(0).min(last_x), y.max(0).min(last_y));
                at[r] = (y as u32).wrapping_mul(mask.stride as u32).wrapping_add(x as u32);
            }
            for (c, seen) in seen.iter_mut().enumerate() {
                let plane = if c < mask.channels { c } else { 0 } * texels;
                // SAFETY: both texels are clamped to the padded grid.
                let code = unsafe { gather(&mask.codes[plane..plane + texels], &at) };
                for r in 0..REPLICATES {
                    seen[r] *= f32::from(code[r]) * mask.unit;
                }
            }
        }
    }
}

// Plain loops over the lanes: a closure (array::from_fn) would be compiled without the caller's instruction set.

/// Coordinates in [−½, ½): 24 bits, exact in f32 on every backend.
#[inline(always)]
fn unit(words: &[u32; REPLICATES], shift: &[u32; REPLICATES]) -> Lanes {
    let mut out = [0f32; REPLICATES];
    for r in 0..REPLICATES {
        out[r] = ((words[r] ^ shift[r]) as i32 >> 8) as f32 * (1.0 / 16_777_216.0);
    }
    out
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
    let mut out = [0; REPLICATES];
    for r in 0..REPLICATES {
        let mut t = axis.offset + emitter * u[r];
        if AREA {
            t += pixel * v[r];
        }
        out[r] = texel(axis, t);
    }
    out
}

/// The codes at sixteen places. Safety: each place is one of `codes`.
#[inline(always)]
unsafe fn gather(codes: &[u16], at: &[u32; REPLICATES]) -> [u16; REPLICATES] {
    let mut code = [0u16; REPLICATES];
    for r in 0..REPLICATES {
        debug_assert!((at[r] as usize) < codes.len());
        // SAFETY: the caller's.
        code[r] = unsafe { *codes.get_unchecked(at[r] as usize) };
    }
    code
}

#[inline(always)]
fn texel(axis: &Axis, t: f32) -> u32 {
    // Written so that a NaN falls on the clear border too.
    let t = if t > axis.low { t } else { axis.low };
    let t = if t < axis.high { t } else { axis.high };
    // SAFETY: low and high are small integers, and t is between them.
    let whole: i32 = unsafe { t.to_int_unchecked() };
    // Towards −∞, without the library's floor.
    let floor = whole.wrapping_sub(i32::from(whole as f32 > t));
    floor.wrapping_add(axis.anchor) as u32
}

/// Padded texels of a tilted plane; see [`super::tilted`].
#[inline(always)]
fn tilted_texels(map: &Tilted, seen: &Seen, u: &[Lanes; 2], v: &[Lanes; 2]) -> [[u32; REPLICATES]; 2] {
    let mut texels = [[0; REPLICATES]; 2];
    let behind = if map.dome { 0.0 } else { 1.0 };
    for r in 0..REPLICATES {
        // y runs downwards on source and pixel, upwards in space.
        let q = [map.emitter[0] * u[0][r], -(map.emitter[1] * u[1][r])];
        let p = [map.pixel[0] * v[0][r], -(map.pixel[1] * v[1][r])];
        let m = [p[0] + seen.ratio * (q[0] - p[0]), p[1] + seen.ratio * (q[1] - p[1])];
        let w = [q[0] - behind * p[0], q[1] - behind * p[1]];
        let step = (seen.rest - dot(&map.normal, &m)) / (seen.depth + dot(&map.normal, &w));
        let x = seen.x.offset + (dot(&map.right, &m) + step * (seen.along[0] + dot(&map.right, &w)));
        let y = seen.y.offset + (dot(&map.down, &m) + step * (seen.along[1] + dot(&map.down, &w)));
        texels[0][r] = texel(&seen.x, x);
        texels[1][r] = texel(&seen.y, y);
    }
    texels
}

#[inline(always)]
fn dot(a: &[f32; 2], b: &[f32; 2]) -> f32 {
    a[0] * b[0] + a[1] * b[1]
}

/// The square [−½, ½]² onto the disk of radius ½, areas in proportion (Shirley & Chiu 1997); sine and cosine of at most
/// 45° by their series, the same on every backend.
#[inline(always)]
fn disk(u: &[Lanes; 2]) -> [Lanes; 2] {
    let mut out = [[0f32; REPLICATES]; 2];
    for r in 0..REPLICATES {
        let (a, b) = (u[0][r], u[1][r]);
        let steep = b.abs() > a.abs();
        let (long, short) = if steep { (b, a) } else { (a, b) };
        let t = if long == 0.0 { 0.0 } else { short / long };
        let z = t * t;
        let sin = t
            * (std::f32::consts::FRAC_PI_4
                + z * (-0.080_745_51 + z * (0.002_490_394_6 + z * (-3.657_620_4e-5 + z * 3.133_616_9e-7))));
        let cos = 1.0
            + z * (-0.308_425_14
                + z * (0.015_854_344 + z * (-3.259_919e-4 + z * (3.590_860_4e-6 - z * 2.461_137e-8))));
        let (along, across) = (long * cos, long * sin);
        out[0][r] = if steep { across } else { along };
        out[1][r] = if steep { along } else { across };
    }
    out
}

/// A point of the disk of radius ½ to the tangents of the direction above it: cosine-weighted over the hemisphere.
#[inline(always)]
fn tangents(u: &[Lanes; 2]) -> [Lanes; 2] {
    let mut out = [[0f32; REPLICATES]; 2];
    for r in 0..REPLICATES {
        let rest = 1.0 - 4.0 * (u[0][r] * u[0][r] + u[1][r] * u[1][r]);
        let scale = 2.0 / (if rest > 1e-12 { rest } else { 1e-12 }).sqrt();
        out[0][r] = u[0][r] * scale;
        out[1][r] = u[1][r] * scale;
    }
    out
}

/// 1 / (1 + tan²θ)²: both cosines over the squared distance, times the lamp's squared distance.
#[inline(always)]
fn weight<const AREA: bool>(e: &EmitterPlan, i: usize, j: usize, u: &[Lanes; 2], v: &[Lanes; 2]) -> Lanes {
    let (column, row) = (e.columns[i], e.rows[j]);
    let mut out = [0f32; REPLICATES];
    for r in 0..REPLICATES {
        let mut x = column - e.emitter[0] * u[0][r];
        let mut y = row - e.emitter[1] * u[1][r];
        if AREA {
            x += e.pixel[0] * v[0][r];
            y += e.pixel[1] * v[1][r];
        }
        let w = 1.0 + (x * x + y * y);
        out[r] = 1.0 / (w * w);
    }
    out
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// [`texel`] as anyone would write it.
    fn checked(axis: &Axis, t: f32) -> u32 {
        let t = if t.is_nan() { axis.low } else { t.clamp(axis.low, axis.high) };
        (t.floor() as i32).wrapping_add(axis.anchor) as u32
    }

    proptest! {
        /// The unchecked conversion falls on the checked one's texel, wherever a point falls, if anywhere.
        #[test]
        fn unchecked_texels_are_the_checked_ones(bits: u32, near in -300f32..300.0, low in -200i32..0, size in 1i32..200, anchor in 0i32..4096) {
            let (low, high) = (low as f32, (low + size) as f32);
            let axis = Axis { offset: 0.0, low, high, anchor, range: super::super::bounds::Range { first: 0, last: 0 } };
            for t in [f32::from_bits(bits), near, near.floor(), low, high, f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
                prop_assert_eq!(texel(&axis, t), checked(&axis, t), "{}", t);
            }
        }

        /// What is read without a check is what is read with one.
        #[test]
        fn unchecked_codes_are_the_checked_ones(codes in prop::collection::vec(any::<u16>(), 1..300), places: [u32; REPLICATES]) {
            let at = places.map(|place| place % codes.len() as u32);
            // SAFETY: the remainders are places in `codes`.
            let read = unsafe { gather(&codes, &at) };
            prop_assert_eq!(read, at.map(|place| codes[place as usize]));
        }
    }
}
