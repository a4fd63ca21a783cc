//! PCSS: percentage-closer soft shadows (Fernando 2005) through a shadow map of each puppet.
//!
//! Three steps a pixel, emitter and plane: search the map for texels that block light, average their depth, and from that
//! estimate the penumbra's width by similar triangles,
//!
//! > w = w_light · (d_receiver − d_blocker) / d_blocker,
//!
//! over which the map is then filtered. Where the search finds no blocker, the pixel is lit: thin figures that it misses
//! are lost, and so is their shadow.
//!
//! What it comes to on a stage of translucent puppets: every plane has a map of its own (`map`) of depth and
//! transmittance; a texel that is not clear blocks; the filter averages transmittances, and those of several planes
//! multiply. An upright plane has one depth, so its penumbra estimate is exact and what is left are the map's resolution
//! and the samples; the depths of a tilted plane are averaged, as Fernando does, whatever that costs. `area` pixels spread
//! their samples over the pixel too. A dome is refused: no map shows it.
//!
//! Sample places are Owen-scrambled Sobol points, one of sixteen patterns a pixel, and all that chooses a texel is integer
//! arithmetic: both backends read the same texels, so their images are equal to the bit.

#[cfg_attr(not(feature = "gpu"), path = "no_gpu.rs")]
mod gpu;
mod map;
mod native;
#[cfg(feature = "gpu")]
mod twins;

use std::ops::Bound;
use std::sync::Arc;
use std::time::Instant;

use kelir_frame::{Backend, Frame, Isa, Meter, RenderError, Renderer, Stats, View, VisibilityModel};
use kelir_scene::{Ambient, EmitterShape, Theatre};
use serde::{Deserialize, Serialize};

use crate::emitters::{each_visibility, emitters};
use crate::project::sides_m;
use kelir_frame::knobs::{self, Knob, Range};

use crate::albedo;
use crate::irradiance::UnitImages;
use crate::trace::sobol::{Points, REPLICATES, fold};
use map::{Beam, Map};
use native::{Row, Shader};

#[cfg(feature = "gpu")]
pub(crate) use twins::twins;

/// Stands in the key of every job: raise it, and bless the golden images, with any change that can change a byte that this technique
/// draws, in its own files or in what it shares with others. What was made before is then made anew.
pub const REVISION: u32 = 1;

/// What can be turned.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Knobs {
    /// Samples of the blocker search, 1..=16384.
    pub blocker_samples: u32,
    /// Samples of the filter, 1..=16384.
    pub filter_samples: u32,
    /// Samples a side of each puppet's shadow map, 16..=8192.
    pub map_size: u32,
    /// Seed of the sample patterns.
    pub seed: u64,
    /// Depth bias in metres, ≥ 0: what is no further than this before the screen casts no shadow.
    pub bias_m: f64,
}

impl Default for Knobs {
    fn default() -> Self {
        Self { blocker_samples: 16, filter_samples: 64, map_size: 1024, seed: 1, bias_m: 0.0 }
    }
}

impl Knobs {
    /// Errors: a knob out of its range.
    pub fn check(&self) -> Result<(), RenderError> {
        knobs::check(KNOBS, self)
    }
}

/// What can be turned, for files, command line and tables.
pub const KNOBS: &[Knob] = &[
    Knob {
        name: "blocker_samples",
        unit: "",
        range: Range::Whole(1, 16384),
        about: "samples of the search for blockers",
    },
    Knob { name: "filter_samples", unit: "", range: Range::Whole(1, 16384), about: "samples of the filter" },
    knobs::MAP_SIZE,
    knobs::SEED,
    Knob {
        name: "bias_m",
        unit: "m",
        range: Range::Number(Bound::Included(0.0), Bound::Unbounded),
        about: "depth bias: a puppet no further than this before the screen casts no shadow",
    },
];

/// The renderer for `knobs` on `backend`.
pub fn renderer(knobs: &Knobs, backend: Backend) -> Result<Box<dyn Renderer<Theatre>>, RenderError> {
    knobs.check()?;
    let gpu = kelir_frame::gpu::choose(backend)?.map(|gpu| gpu::OnGpu::new(gpu, gpu::WGSL)).transpose()?;
    Ok(Box::new(Pcss::new(*knobs, gpu)))
}

/// Sample places on an emitter or its penumbra, and within the pixel: signed fractions of 2³² of the whole side.
pub(crate) struct Pattern {
    /// Samples a pixel.
    pub samples: usize,
    /// x and y (downwards) on the emitter, then on the pixel; entry `pattern * samples + k`.
    pub places: Vec<[i32; 4]>,
}

impl Pattern {
    fn new(seed: u64, samples: u32, shape: &EmitterShape) -> Self {
        let points = Points::new(seed, samples as usize);
        let place = |at: usize| {
            let [x, y, u, v] = points.dims.each_ref().map(|d| d[at] as i32);
            match shape {
                EmitterShape::Rectangle { .. } => [x, y, u, v],
                EmitterShape::Disk { .. } => {
                    let [x, y] = on_disk([x, y]);
                    [x, y, u, v]
                }
            }
        };
        let of = |r: usize| (0..samples as usize).map(move |k| place(k * REPLICATES + r));
        Self { samples: samples as usize, places: (0..REPLICATES).flat_map(of).collect() }
    }
}

/// The square's point moved onto the disk in it, keeping areas' ratios (Shirley & Chiu 1997).
fn on_disk(place: [i32; 2]) -> [i32; 2] {
    let [x, y] = place.map(|v| f64::from(v) / 2f64.powi(32));
    let eighth = std::f64::consts::FRAC_PI_4;
    let (r, turn) = match () {
        () if x == 0.0 && y == 0.0 => (0.0, 0.0),
        () if x.abs() > y.abs() => (x, eighth * y / x),
        () => (y, 2.0 * eighth - eighth * x / y),
    };
    [r * turn.cos(), r * turn.sin()].map(|v| (v * 2f64.powi(32)) as i32)
}

/// Both patterns of one emitter.
pub(crate) struct Patterns {
    pub search: Arc<Pattern>,
    pub filter: Arc<Pattern>,
}

/// Keeps maps, patterns and E⁰ between drawings.
struct Pcss {
    knobs: Knobs,
    maps: Vec<(String, Arc<Map>)>,
    /// Of rectangles, then of disks.
    patterns: [Option<(Arc<Pattern>, Arc<Pattern>)>; 2],
    lit: UnitImages,
    /// `None` draws on the CPU.
    gpu: Option<gpu::OnGpu>,
    meter: Meter,
}

impl Pcss {
    fn new(knobs: Knobs, gpu: Option<gpu::OnGpu>) -> Self {
        Self {
            knobs,
            maps: Vec::new(),
            patterns: [None, None],
            lit: UnitImages::default(),
            gpu,
            meter: Meter::default(),
        }
    }

    /// The patterns for every emitter of the lamp.
    fn patterns(&mut self, theatre: &Theatre) -> Vec<Patterns> {
        let Knobs { seed, blocker_samples, filter_samples, .. } = self.knobs;
        let one = |emitter: &kelir_scene::Emitter| {
            let disk = usize::from(matches!(emitter.shape, EmitterShape::Disk { .. }));
            let (search, filter) = self.patterns[disk].get_or_insert_with(|| {
                let pattern = |seed, samples| Arc::new(Pattern::new(seed, samples, &emitter.shape));
                (pattern(!seed, blocker_samples), pattern(seed, filter_samples))
            });
            Patterns { search: search.clone(), filter: filter.clone() }
        };
        theatre.lamp.emitters.iter().map(one).collect()
    }

    fn rows(
        &mut self,
        theatre: &Theatre,
        view: &View,
        layers: bool,
    ) -> Result<(Vec<Row>, Stats), RenderError> {
        view.check(sides_m(&theatre.screen))?;
        if matches!(theatre.ambient, Ambient::Dome { .. }) {
            return Err(refuse("ambient.model = \"dome\": no shadow map shows a whole dome".into()));
        }
        let mut stats = Stats::default();
        let clock = Instant::now();
        if !view.skip {
            self.maps.clear();
            self.lit = UnitImages::default();
        }
        let patterns = self.patterns(theatre);
        self.lit.update(theatre, view.size, false);
        let old = std::mem::take(&mut self.maps);
        let (mut beams, mut built) = (Vec::new(), 0);
        for (p, plane) in theatre.planes.iter().enumerate() {
            let Some(beam) = Beam::new(theatre, view, p, &self.knobs)? else { continue };
            let key = beam.key(plane, &theatre.lamp);
            let map = match old.iter().find(|(k, _)| *k == key) {
                Some((_, map)) => map.clone(),
                None => {
                    built += 1;
                    Arc::new(Map::new(theatre, plane, &beam, &self.knobs))
                }
            };
            self.maps.push((key, map.clone()));
            beams.push((p, beam, map));
        }
        stats.counts.insert("maps_built".into(), built);
        stats.counts.insert("planes_off_beam".into(), (theatre.planes.len() - beams.len()) as u64);
        stats.steps_ms.push(("maps".into(), clock.elapsed().as_secs_f64() * 1e3));
        let clock = Instant::now();
        let albedo = albedo::on_grid(&theatre.screen, view);
        let shader = Shader {
            theatre,
            view,
            channels: beams.iter().map(|(_, _, map)| map.mask.channels).max().unwrap_or(1),
            beams: &beams,
            patterns: &patterns,
            lit: self.lit.centres(),
            albedo: &albedo,
            seed: fold(self.knobs.seed),
            layers,
            meter: &self.meter,
        };
        self.meter.begin(view.size[1]);
        let rows = match &mut self.gpu {
            None => shader.rows(),
            Some(gpu) => {
                let scene = gpu.prepare(&shader)?;
                shader.rows_by(|jobs| gpu.run(&scene, jobs))?
            }
        };
        stats.steps_ms.push(("pixels".into(), clock.elapsed().as_secs_f64() * 1e3));
        let all = view.size[0] * view.size[1] * theatre.lamp.emitters.len() * beams.len();
        let searched: u64 = rows.iter().map(|r| r.searched).sum();
        stats.counts.insert("searches".into(), searched);
        stats.counts.insert("searches_skipped".into(), all as u64 - searched);
        Ok((rows, stats))
    }
}

fn refuse(reason: String) -> RenderError {
    RenderError::Inapplicable { technique: "pcss", reason }
}

impl Renderer<Theatre> for Pcss {
    fn frame(&mut self, theatre: &Theatre, view: &View, visibilities: bool) -> Result<Frame, RenderError> {
        let (rows, stats) = self.rows(theatre, view, visibilities)?;
        let plane = |k: usize| -> Vec<f32> {
            let of = |row: &Row| row.values[k * view.size[0]..(k + 1) * view.size[0]].to_vec();
            rows.iter().flat_map(of).collect()
        };
        // A puppet off the beam may be the only coloured one: the grey visibility then serves all channels.
        let drawn = (rows.first().map_or(0, |r| r.values.len() / view.size[0]) - 3)
            / theatre.lamp.emitters.len().max(1);
        let names = emitters(theatre).filter(|_| visibilities);
        let visibilities = each_visibility(theatre, names, VisibilityModel::Geometric, |e, c| {
            plane(3 + e * drawn + c.min(drawn - 1))
        });
        let radiance = [0, 1, 2].map(plane);
        Ok(Frame { size: view.size, radiance, visibilities, standard_error: None, stats })
    }

    fn watch(&mut self, meter: &Meter) {
        self.meter = meter.clone();
    }

    fn class(&self) -> String {
        self.gpu.as_ref().map_or("cpu".into(), |on| on.gpu.class())
    }

    fn adapter(&self) -> String {
        match &self.gpu {
            Some(gpu) => gpu.gpu.adapter(),
            None => Isa::native(),
        }
    }
}

#[cfg(test)]
mod tests;
