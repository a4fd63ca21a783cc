//! From replicates' sums to radiance and its standard error, row by row.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use kelir_frame::{Meter, RenderError};
use kelir_scene::{Ambient, Theatre};
use rayon::prelude::*;

use super::bounds::Padded;
use super::native::Sampler;
use super::plan::Plan;
use super::sobol::{Points, REPLICATES};
use super::tables::Tables;
use crate::albedo::PixelAlbedo;
use crate::ambient;

/// Everything that a row needs.
pub(super) struct Estimator<'a> {
    pub theatre: &'a Theatre,
    pub plan: &'a Plan,
    pub masks: &'a [Arc<Padded>],
    /// E⁰ at unit radiance, one image an emitter.
    pub lit: &'a [&'a [f64]],
    /// Its means over pixels, where samples spread over them.
    pub means: &'a [&'a [f64]],
    /// Radiance of each source: the emitters, then the dome where there is one.
    pub radiance: Vec<[f64; 3]>,
    pub albedo: &'a PixelAlbedo,
    pub points: &'a Points,
    pub tables: &'a Tables,
    pub skip: bool,
    pub layers: bool,
    /// Told of each row that is done.
    pub meter: &'a Meter,
}

/// One estimate to sample: the light of one emitter through planes `first..end` at one pixel, and the product of codes, each in its
/// mask's unit, that it deviates from.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct Job {
    pub x: u32,
    pub y: u32,
    pub emitter: u32,
    pub first: u32,
    pub end: u32,
    pub v0_r: f32,
    pub v0_g: f32,
    pub v0_b: f32,
}

/// Where sums of (V − V₀) · weight come from, channel by channel (grey scenes: the first alone counts).
type Source<'a> = &'a mut dyn FnMut(&Job) -> [[f64; REPLICATES]; 3];

/// One finished row.
#[derive(Default)]
pub(crate) struct Row {
    /// Planes of `width` values: radiance R, G, B; and with layers SE R, G, B, then visibilities.
    pub values: Vec<f32>,
    /// (Pixel, emitter, planes) estimates that were sampled.
    pub jobs: u64,
    /// Pixels where anything varies.
    pub penumbra: u64,
    /// Largest unshadowed radiance.
    pub brightest: f64,
    /// Sum, sum of squares and maximum over penumbra pixels of the standard error's largest channel.
    pub error_sum: f64,
    pub error_square: f64,
    pub error_max: f64,
}

/// Deviations of the replicates, channel by channel.
type Deviations = [[f64; REPLICATES]; 3];

/// The estimate of one emitter's visibility through some planes: V₀ and the replicates' deviations from it, both in E / L.
#[derive(Clone, Copy)]
struct Estimate {
    base: [f64; 3],
    /// Mean over the replicates.
    mean: [f64; 3],
    /// Which of the pixel's deviations; `None` where the bounds say that all are zero.
    deviation: Option<usize>,
}

/// One pixel's estimates and their sums, whose memory serves all pixels of a row.
#[derive(Default)]
struct Pixel {
    estimates: Vec<Estimate>,
    deviations: Vec<Deviations>,
    /// Σ L · E in one channel, one a set of planes.
    means: Vec<f64>,
    /// The same of every replicate.
    replicates: Vec<[f64; REPLICATES]>,
}

impl Estimator<'_> {
    /// The given rows, on all cores; the result does not depend on how many there are.
    pub(super) fn rows(&self, rows: &[usize]) -> Vec<Row> {
        let row = |j: &usize| {
            let row = self.row(*j, &mut |job| self.native(job));
            self.meter.add(1);
            row
        };
        rows.par_iter().map(row).collect()
    }

    /// The given rows with sums from `draw`, which is handed the jobs of many rows at a time: `channels * REPLICATES`
    /// sums each.
    pub(super) fn rows_by(
        &self,
        rows: &[usize],
        mut draw: impl FnMut(&[Job]) -> Result<Vec<f32>, RenderError>,
    ) -> Result<Vec<Row>, RenderError> {
        /// Jobs are gathered until there may be this many.
        const ENOUGH: usize = 1 << 19;
        let band = (ENOUGH / (self.plan.size[0] * self.plan.emitters.len()).max(1)).max(1);
        let per_job = self.plan.channels * REPLICATES;
        let mut done = Vec::with_capacity(rows.len());
        for rows in rows.chunks(band) {
            let gather = |j: &usize| {
                let mut jobs = Vec::new();
                self.row(*j, &mut |job| {
                    jobs.push(*job);
                    [[0.0; REPLICATES]; 3]
                });
                jobs
            };
            let wanted: Vec<Vec<Job>> = rows.par_iter().map(gather).collect();
            let sums = draw(&wanted.concat())?;
            let starts = wanted.iter().scan(0, |end, jobs| {
                let start = *end;
                *end += jobs.len() * per_job;
                Some(start)
            });
            let starts: Vec<usize> = starts.collect();
            done.par_extend(rows.par_iter().zip(starts).map(|(j, start)| {
                let mut sums = sums[start..].chunks_exact(per_job);
                self.row(*j, &mut |_| {
                    let sums = sums.next().expect("as many sums as jobs");
                    std::array::from_fn(|c| {
                        let c = c.min(self.plan.channels - 1) * REPLICATES;
                        std::array::from_fn(|r| f64::from(sums[c + r]))
                    })
                })
            }));
            self.meter.add(rows.len());
        }
        Ok(done)
    }

    fn native(&self, job: &Job) -> [[f64; REPLICATES]; 3] {
        let sampler = Sampler {
            plan: self.plan,
            masks: self.masks,
            points: self.points,
            tables: self.tables,
            planes: job.first as usize..job.end as usize,
        };
        let (k, i, j) = (job.emitter as usize, job.x as usize, job.y as usize);
        match self.plan.channels {
            1 => [sampler.sums::<1>(k, i, j, [job.v0_r])[0]; 3],
            _ => sampler.sums::<3>(k, i, j, [job.v0_r, job.v0_g, job.v0_b]),
        }
    }

    fn row(&self, j: usize, source: Source) -> Row {
        let width = self.plan.size[0];
        let emitters = self.plan.emitters.len();
        let extra = if self.layers { 3 + emitters * self.plan.channels } else { 0 };
        let mut row = Row { values: vec![0.0; width * (3 + extra)], ..Row::default() };
        let subsets = 1 + if alone(self.theatre) { self.masks.len() } else { 0 };
        let like = self.like();
        let mut pixel = Pixel::default();
        for i in 0..width {
            pixel.estimates.clear();
            pixel.deviations.clear();
            let mut penumbra = false;
            for subset in 0..subsets {
                let planes = if subset == 0 { 0..self.masks.len() } else { subset - 1..subset };
                for k in 0..emitters {
                    penumbra |= self.estimate(k, [i, j], planes.clone(), source, &mut pixel);
                }
            }
            row.jobs += pixel.deviations.len() as u64;
            self.finish([i, j], like, &mut pixel, penumbra, &mut row);
        }
        row
    }

    /// Adds an estimate to `pixel`, and says whether the bounds leave room for a penumbra.
    fn estimate(
        &self,
        k: usize,
        [i, j]: [usize; 2],
        planes: std::ops::Range<usize>,
        source: Source,
        pixel: &mut Pixel,
    ) -> bool {
        // What doesn't shine makes no penumbra, and its visibility is of no use but as a layer.
        let dark = self.radiance[k] == [0.0; 3];
        if dark && self.skip && !self.layers {
            pixel.estimates.push(Estimate { base: [0.0; 3], mean: [0.0; 3], deviation: None });
            return false;
        }
        let known = self.known(k, i, j, planes.clone());
        let [v0_r, v0_g, v0_b] = known.unwrap_or([0.0; 3]);
        let full = self.full(planes.clone());
        let lit = self.lit(k, j * self.plan.size[0] + i);
        let base = [v0_r, v0_g, v0_b].map(|v| lit * (f64::from(v) / full));
        if known.is_some() && self.skip {
            pixel.estimates.push(Estimate { base, mean: base, deviation: None });
            return false;
        }
        let (x, y, first, end) = (i as u32, j as u32, planes.start as u32, planes.end as u32);
        let sums = source(&Job { x, y, emitter: k as u32, first, end, v0_r, v0_g, v0_b });
        let over_mean = self.means.get(k).map_or(1.0, |means| lit / means[j * self.plan.size[0] + i]);
        let unit = if self.plan.geometric { lit } else { self.plan.emitters[k].scale * over_mean };
        let scale = unit / (self.points.samples as f64 * full);
        let deviations = sums.map(|d| d.map(|s| s * scale));
        let mean_of = |c: usize| base[c] + deviations[c].iter().sum::<f64>() / REPLICATES as f64;
        let mean = if self.plan.channels == 1 { [mean_of(0); 3] } else { [0, 1, 2].map(mean_of) };
        pixel.estimates.push(Estimate { base, mean, deviation: Some(pixel.deviations.len()) });
        pixel.deviations.push(deviations);
        known.is_none() && !dark
    }

    /// The product of the largest codes, rounded as the samples' products are, so that what is clear is exactly 1.
    fn full(&self, planes: std::ops::Range<usize>) -> f64 {
        f64::from(self.masks[planes].iter().map(|m| m.max_code as f32 * m.unit).product::<f32>())
    }

    /// The first channel of the same light as each: what is grey is worked out once.
    fn like(&self) -> [usize; 3] {
        let ambient = |c: usize| match self.theatre.ambient {
            Ambient::Paper { s, .. } => s[c],
            _ => 0.0,
        };
        let same = |a: usize, b: usize| {
            self.plan.channels == 1
                && ambient(a) == ambient(b)
                && self.radiance.iter().all(|radiance| radiance[a] == radiance[b])
        };
        [0, 1, 2].map(|c| (0..c).find(|&b| same(b, c)).unwrap_or(c))
    }

    /// The product of codes, each in its mask's unit, where the bounds say that it is one value: all planes constant, or one of them opaque.
    fn known(&self, k: usize, i: usize, j: usize, planes: std::ops::Range<usize>) -> Option<[f32; 3]> {
        let mut product = Some([1f32; 3]);
        for (map, mask) in self.plan.emitters[k].planes[planes.clone()].iter().zip(&self.masks[planes]) {
            let (x, y) = map.range(i, j);
            if !mask.is_constant(x, y) {
                product = None;
                continue;
            }
            let codes = [0, 1, 2].map(|c| f32::from(mask.code(c, x.first, y.first)) * mask.unit);
            if codes == [0.0; 3] {
                return Some(codes);
            }
            product = product.map(|p| [0, 1, 2].map(|c| p[c] * codes[c]));
        }
        product
    }

    /// Radiance, standard error and layers of one pixel into `row`.
    fn finish(
        &self,
        [i, j]: [usize; 2],
        like: [usize; 3],
        Pixel { estimates, deviations, means, replicates }: &mut Pixel,
        penumbra: bool,
        row: &mut Row,
    ) {
        let width = self.plan.size[0];
        let pixel = j * width + i;
        let sources = &self.radiance;
        let sampled = !deviations.is_empty();
        let mut error = 0f64;
        // Irradiance without planes, with them, and its standard error, channel by channel.
        let mut light = [[0f64; 3]; 3];
        for c in 0..3 {
            if like[c] == c {
                let lit: f64 = sources.iter().enumerate().map(|(k, l)| l[c] * self.lit(k, pixel)).sum();
                let through = |estimates: &[Estimate]| {
                    estimates.iter().zip(sources).fold(0.0, |sum, (e, l)| sum + l[c] * e.mean[c])
                };
                means.clear();
                means.extend(estimates.chunks_exact(sources.len()).map(through));
                let seen = self.irradiance(c, lit, |subset| means[subset]);
                let mut se = 0.0;
                if sampled {
                    replicates.clear();
                    replicates.extend(estimates.chunks_exact(sources.len()).map(|estimates| {
                        let mut sum = [0.0; REPLICATES];
                        for (e, l) in estimates.iter().zip(sources) {
                            add(&mut sum, l[c], e.base[c], e.deviation.map(|d| &deviations[d][c]));
                        }
                        sum
                    }));
                    se = standard_error(&std::array::from_fn(|r| {
                        self.irradiance(c, lit, |subset| replicates[subset][r])
                    }));
                }
                light[c] = [lit, seen, se];
            }
            let [lit, seen, se] = light[like[c]];
            let reflect = f64::from(self.albedo.at(c, pixel)) / std::f64::consts::PI;
            row.values[c * width + i] = (reflect * seen) as f32;
            row.brightest = row.brightest.max(reflect * lit);
            error = error.max(reflect * se);
            if sampled && self.layers {
                row.values[(3 + c) * width + i] = (reflect * se) as f32;
            }
        }
        if penumbra {
            row.penumbra += 1;
            row.error_sum += error;
            row.error_square += error * error;
            row.error_max = row.error_max.max(error);
        }
        if self.layers {
            let channels = self.plan.channels;
            for (k, estimate) in estimates[..sources.len()].iter().enumerate() {
                for c in 0..channels {
                    let visibility = estimate.mean[c] / self.lit(k, pixel);
                    row.values[(6 + k * channels + c) * width + i] = visibility as f32;
                }
            }
        }
    }

    /// E⁰ of source `k` at unit radiance; a whole dome's is π.
    fn lit(&self, k: usize, pixel: usize) -> f64 {
        self.lit.get(k).map_or(std::f64::consts::PI, |image| image[pixel])
    }

    /// The screen's irradiance in channel `c` with the ambient light: `lamp(0)` is Σ L_k E_k through all planes,
    /// `lamp(1 + i)` through plane i alone, `lit` without planes.
    fn irradiance(&self, c: usize, lit: f64, lamp: impl Fn(usize) -> f64) -> f64 {
        let direct = lamp(0);
        match self.theatre.ambient {
            Ambient::Paper { k_d_m, s } if lit > 0.0 => {
                let planes = self.theatre.planes.iter().enumerate();
                let several = self.theatre.planes.len() > 1;
                let distance = ambient::distance_m(planes.map(|(i, plane)| {
                    let visibility = if several { lamp(1 + i) / lit } else { 0.0 };
                    (plane.centre_m.z.abs(), visibility)
                }));
                direct + lit * ambient::share(direct / lit, distance, k_d_m, s[c])
            }
            _ => direct,
        }
    }
}

/// Whether each plane's own visibility is asked for, too: with several planes the paper's ambient light needs it.
pub(super) fn alone(theatre: &Theatre) -> bool {
    matches!(theatre.ambient, Ambient::Paper { .. }) && theatre.planes.len() > 1
}

/// Adds `radiance` times base and deviation to every replicate.
fn add(sum: &mut [f64; REPLICATES], radiance: f64, base: f64, deviation: Option<&[f64; REPLICATES]>) {
    match deviation {
        None => sum.iter_mut().for_each(|sum| *sum += radiance * base),
        Some(deviation) => {
            sum.iter_mut().zip(deviation).for_each(|(sum, deviation)| *sum += radiance * (base + deviation));
        }
    }
}

/// Standard error of the mean of independent replicates; exactly 0 where all are equal.
fn standard_error(replicates: &[f64; REPLICATES]) -> f64 {
    let n = REPLICATES as f64;
    let shifted = replicates.map(|v| v - replicates[0]);
    let mean = shifted.iter().sum::<f64>() / n;
    let square: f64 = shifted.iter().map(|v| (v - mean) * (v - mean)).sum();
    (square / (n * (n - 1.0))).sqrt()
}
