//! Blocker search, penumbra estimate and filter, row by row on all cores.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use kelir_frame::{Meter, RenderError, View};
use kelir_scene::{Ambient, Theatre};
use rayon::prelude::*;

use super::map::{Beam, Map};
use super::{Pattern, Patterns};
use crate::albedo::PixelAlbedo;
use crate::ambient;
use crate::trace::sobol::{REPLICATES, stream};

/// Everything that a row needs.
pub(crate) struct Shader<'a> {
    pub theatre: &'a Theatre,
    pub view: &'a View,
    /// 1 where all maps are grey, else 3.
    pub channels: usize,
    /// Plane of the theatre, where its pixels fall, its map.
    pub beams: &'a [(usize, Beam, Arc<Map>)],
    /// One an emitter.
    pub patterns: &'a [Patterns],
    /// E⁰ at unit radiance, one image an emitter.
    pub lit: Vec<&'a [f64]>,
    pub albedo: &'a PixelAlbedo,
    /// A folded seed.
    pub seed: u32,
    /// Whether the emitters' visibilities are wanted.
    pub layers: bool,
    /// Told of each row that is done.
    pub meter: &'a Meter,
}

/// One pixel's look at one map from one emitter.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct Job {
    pub x: u32,
    pub y: u32,
    pub emitter: u32,
    pub beam: u32,
    /// Which of the sample patterns.
    pub pattern: u32,
}

/// One finished row.
#[derive(Default)]
pub(crate) struct Row {
    /// Planes of `width` values: radiance R, G, B; and with layers every emitter's visibility in every channel.
    pub values: Vec<f32>,
    /// Jobs done.
    pub searched: u64,
}

/// Sums of the filter's codes, channel by channel (grey maps: the first alone counts).
type Source<'a> = &'a mut dyn FnMut(&Job) -> [u32; 3];

/// The high half of a product of fractions of 2³²: `width * place`.
#[inline(always)]
fn scaled(width: i32, place: i32) -> i32 {
    ((i64::from(width) * i64::from(place)) >> 32) as i32
}

impl Shader<'_> {
    /// All rows.
    pub(super) fn rows(&self) -> Vec<Row> {
        let row = |j: usize| {
            let row = self.row(j, &mut |job| self.filtered(job));
            self.meter.add(1);
            row
        };
        (0..self.view.size[1]).into_par_iter().map(row).collect()
    }

    /// All rows with sums from `draw`, which is handed the jobs of many rows at a time: one sum a channel.
    pub(super) fn rows_by(
        &self,
        mut draw: impl FnMut(&[Job]) -> Result<Vec<u32>, RenderError>,
    ) -> Result<Vec<Row>, RenderError> {
        /// Jobs are gathered until there may be this many.
        const ENOUGH: usize = 1 << 20;
        let a_row = self.view.size[0] * self.beams.len() * self.patterns.len();
        let rows: Vec<usize> = (0..self.view.size[1]).collect();
        let mut done = Vec::with_capacity(rows.len());
        for rows in rows.chunks((ENOUGH / a_row.max(1)).max(1)) {
            let gather = |j: &usize| {
                let mut jobs = Vec::new();
                self.row(*j, &mut |job| {
                    jobs.push(*job);
                    [0; 3]
                });
                jobs
            };
            let wanted: Vec<Vec<Job>> = rows.par_iter().map(gather).collect();
            let sums = draw(&wanted.concat())?;
            let starts = wanted.iter().scan(0, |end, jobs| {
                let start = *end;
                *end += jobs.len() * self.channels;
                Some(start)
            });
            let starts: Vec<usize> = starts.collect();
            done.par_extend(rows.par_iter().zip(starts).map(|(j, start)| {
                let mut sums = sums[start..].chunks_exact(self.channels);
                self.row(*j, &mut |_| {
                    let sums = sums.next().expect("as many sums as jobs");
                    [0, 1, 2].map(|c| sums[c.min(self.channels - 1)])
                })
            }));
            self.meter.add(rows.len());
        }
        Ok(done)
    }

    /// Sums of codes over the filter, or of clear ones where the search finds no blocker.
    fn filtered(&self, job: &Job) -> [u32; 3] {
        let (_, beam, map) = &self.beams[job.beam as usize];
        let Patterns { search, filter } = &self.patterns[job.emitter as usize];
        let centre = [beam.columns[job.x as usize], beam.rows[job.y as usize]];
        let penumbra = &beam.emitters[job.emitter as usize];
        let (mask, channels) = (&map.mask, map.mask.channels);
        let of = |pattern: &Pattern| job.pattern as usize * pattern.samples..;
        let texel = |side: [i32; 2], place: &[i32; 4]| {
            let [x, y] = [0, 1].map(|d| {
                centre[d]
                    .wrapping_add(scaled(side[d], place[d]))
                    .wrapping_add(scaled(beam.pixel[d], place[2 + d]))
            });
            beam.padded(y) as usize * mask.stride + beam.padded(x) as usize
        };
        let plane = mask.stride * mask.rows;
        let (mut blockers, mut depth) = (0u32, 0u32);
        for place in &search.places[of(search)][..search.samples] {
            let at = texel(penumbra.search, place);
            if (0..channels).any(|c| u32::from(mask.codes[c * plane + at]) < mask.max_code) {
                blockers += 1;
                match &map.depths {
                    Some(depths) => depth += u32::from(depths[at]),
                    None => break,
                }
            }
        }
        if blockers == 0 {
            return [mask.max_code * filter.samples as u32; 3];
        }
        let side = penumbra.widths[((2 * depth + blockers) / (2 * blockers)) as usize];
        let mut sums = [0u32; 3];
        for place in &filter.places[of(filter)][..filter.samples] {
            let at = texel(side, place);
            for (c, sum) in sums[..channels].iter_mut().enumerate() {
                *sum += u32::from(mask.codes[c * plane + at]);
            }
        }
        if channels == 1 { [sums[0]; 3] } else { sums }
    }

    fn row(&self, j: usize, source: Source) -> Row {
        let (width, emitters) = (self.view.size[0], self.theatre.lamp.emitters.len());
        let layers = if self.layers { emitters * self.channels } else { 0 };
        let mut row = Row { values: vec![0.0; width * (3 + layers)], searched: 0 };
        // Visibility of emitter e through beam b in channel c.
        let mut through = vec![[1f64; 3]; self.beams.len() * emitters];
        for i in 0..width {
            for (b, through) in through.chunks_exact_mut(emitters.max(1)).enumerate() {
                for (e, through) in through.iter_mut().enumerate() {
                    *through = self.through(b, e, [i, j], &mut row.searched, source);
                }
            }
            self.finish([i, j], &through, &mut row.values);
        }
        row
    }

    /// Visibility of emitter `e` through beam `b`.
    fn through(
        &self,
        b: usize,
        e: usize,
        [i, j]: [usize; 2],
        searched: &mut u64,
        source: Source,
    ) -> [f64; 3] {
        let (_, beam, map) = &self.beams[b];
        let max = f64::from(map.mask.max_code);
        if self.view.skip {
            if !self.layers && self.theatre.lamp.emitters[e].radiance == [0.0; 3] {
                return [1.0; 3];
            }
            let (x, y) = beam.range(e, i, j);
            if map.mask.is_constant(x, y) {
                return [0, 1, 2].map(|c| f64::from(map.mask.code(c, x.first, y.first)) / max);
            }
        }
        *searched += 1;
        let pattern = stream(self.seed, (j * self.view.size[0] + i) as u32, e as u32) % REPLICATES as u32;
        let job = Job { x: i as u32, y: j as u32, emitter: e as u32, beam: b as u32, pattern };
        let all = self.patterns[e].filter.samples as f64 * max;
        source(&job).map(|sum| f64::from(sum) / all)
    }

    /// Radiance and layers of one pixel.
    fn finish(&self, [i, j]: [usize; 2], through: &[[f64; 3]], values: &mut [f32]) {
        let (width, emitters) = (self.view.size[0], &self.theatre.lamp.emitters);
        let pixel = j * width + i;
        let visibility =
            |e: usize, c: usize| -> f64 { through.chunks_exact(emitters.len()).map(|of| of[e][c]).product() };
        for c in 0..3 {
            let weight = |e: usize| emitters[e].radiance[c] * self.lit[e][pixel];
            let lit: f64 = (0..emitters.len()).map(weight).sum();
            let mut light: f64 = (0..emitters.len()).map(|e| weight(e) * visibility(e, c)).sum();
            if let Ambient::Paper { k_d_m, s } = self.theatre.ambient
                && lit > 0.0
            {
                let alone = self.beams.iter().zip(through.chunks_exact(emitters.len()));
                let mut distances = vec![(0.0, 1.0); self.theatre.planes.len()];
                for (p, plane) in self.theatre.planes.iter().enumerate() {
                    distances[p].0 = -plane.centre_m.z;
                }
                for ((p, _, _), of) in alone {
                    distances[*p].1 = (0..emitters.len()).map(|e| weight(e) * of[e][c]).sum::<f64>() / lit;
                }
                light += lit * ambient::share(light / lit, ambient::distance_m(distances), k_d_m, s[c]);
            }
            let reflect = f64::from(self.albedo.at(c, pixel)) / std::f64::consts::PI;
            values[c * width + i] = (reflect * light) as f32;
        }
        if self.layers {
            for e in 0..emitters.len() {
                for c in 0..self.channels {
                    values[(3 + e * self.channels + c) * width + i] = visibility(e, c) as f32;
                }
            }
        }
    }
}
