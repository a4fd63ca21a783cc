//! The stage's truth: rays, followed on the CPU.
//!
//! Surfaces are Lambertian or ideal mirrors: L = albedo · (E / π + L_ambient). Which surface a ray meets, and whether anything stands between a
//! surface and a light, is decided in f64 by tests that leave no gap between triangles ([`tree`]). Shadows of points, projectors and lights
//! that are infinitely far are exact, as are pixels' middles; lamps with an area, environments, a sun's disk, pixels' areas and bounced light
//! are estimated by Owen-scrambled Sobol points, whose sixteen replicates give a standard error as the theatre's do.
//!
//! What is lit is decided by the triangles' own normals, and how much by those of the smooth surface that they stand for. A mesh whose caster is another
//! level shades others by its caster, and itself as it is seen: of two levels each would stick out of the other.

mod estimate;
mod lights;
pub mod rays;
mod shapes;
pub mod tree;
mod world;

use std::time::Instant;

use kelir_frame::knobs::{self, Knob, Range};
use kelir_frame::sobol::{Points, REPLICATES};
use kelir_frame::{Frame, Isa, Meter, RenderError, Renderer, Stats, View};
use kelir_scene::stage::Stage;
use serde::{Deserialize, Serialize};

use estimate::Estimator;
use world::{Solids, World};

/// Stands in the key of every job: raise it with any change that can change a byte that this technique draws.
pub const REVISION: u32 = 1;

/// What can be turned.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Knobs {
    /// Samples a pixel and light where anything is estimated, 1..=2²⁰, rounded up to a multiple of the 16 replicates.
    pub spp: u32,
    /// Of the scrambles.
    pub seed: u64,
    /// How often light goes on from surface to surface: 0 or 1.
    pub bounces: u32,
}

impl Default for Knobs {
    fn default() -> Self {
        Self { spp: 64, seed: 1, bounces: 0 }
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
        name: "spp",
        unit: "samples a pixel",
        range: Range::Whole(1, 1 << 20),
        about: "samples a pixel and light where anything is estimated, rounded up to a multiple of 16 replicates",
    },
    knobs::SEED,
    Knob {
        name: "bounces",
        unit: "",
        range: Range::Whole(0, 1),
        about: "how often light goes on from surface to surface",
    },
];

/// The renderer for `knobs`.
pub fn renderer(knobs: &Knobs) -> Box<dyn Renderer<Stage>> {
    Box::new(Raytrace { knobs: *knobs, solids: Solids::default(), meter: Meter::default() })
}

/// The radiance of surfaces alone, pixel by pixel: without what shines by itself. `samples` are rounded up to a multiple of 16.
pub(crate) fn surfaces(stage: &Stage, view: &View, samples: usize) -> Vec<[f64; 3]> {
    let mut solids = Solids::default();
    let world = World::new(stage, &mut solids);
    let points = Points::new(1, samples.div_ceil(REPLICATES));
    let mut estimator = Estimator::new(&world, view, &points, None);
    estimator.shining = false;
    estimator.all(&Meter::default()).into_iter().flat_map(|band| band.radiance).collect()
}

/// Keeps meshes' trees between frames.
struct Raytrace {
    knobs: Knobs,
    solids: Solids,
    meter: Meter,
}

impl Renderer<Stage> for Raytrace {
    fn frame(&mut self, stage: &Stage, view: &View, _visibilities: bool) -> Result<Frame, RenderError> {
        let (mut stats, started) = (Stats::default(), Instant::now());
        view.check([stage.camera.aspect, 1.0])?;
        if !view.skip {
            self.solids = Solids::default();
        }
        let world = World::new(stage, &mut self.solids);
        let samples = (self.knobs.spp as usize).div_ceil(REPLICATES).max(1);
        let points = Points::new(self.knobs.seed, samples);
        // Points of their own: what is bounced has nothing to do with what is not.
        let bounced = (self.knobs.bounces > 0).then(|| Points::new(!self.knobs.seed, samples));
        let estimator = Estimator::new(&world, view, &points, bounced.as_ref());
        stats.step("prepare", started);
        let clock = Instant::now();
        let [width, height] = view.size;
        self.meter.begin(height);
        let bands = estimator.all(&self.meter);
        stats.step("trace", clock);
        let plane = |colours: &dyn Fn(&estimate::Band) -> &[[f64; 3]], c: usize| {
            let mut plane = Vec::with_capacity(width * height);
            bands.iter().for_each(|band| plane.extend(colours(band).iter().map(|colour| colour[c] as f32)));
            plane
        };
        stats.counts.insert("rays".into(), bands.iter().map(|band| band.rays).sum());
        if estimator.sampled() {
            stats.counts.insert("spp".into(), (samples * REPLICATES) as u64);
        }
        Ok(Frame {
            size: view.size,
            radiance: [0, 1, 2].map(|c| plane(&|band| &band.radiance, c)),
            visibilities: Vec::new(),
            standard_error: estimator.sampled().then(|| [0, 1, 2].map(|c| plane(&|band| &band.error, c))),
            stats,
        })
    }

    fn watch(&mut self, meter: &Meter) {
        self.meter = meter.clone();
    }

    fn adapter(&self) -> String {
        Isa::native()
    }
}

#[cfg(test)]
pub(crate) mod tests;
