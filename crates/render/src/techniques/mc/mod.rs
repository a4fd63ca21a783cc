//! Monte Carlo: an unbiased estimate of each emitter's irradiance E_k, with a standard error per pixel.
//!
//! Owen-scrambled Sobol points spread over the emitter (and over the pixel for `area`); sixteen independent scrambles
//! give sixteen estimates whose spread is the standard error. What is estimated is the *deviation* from a visibility V₀:
//!
//! > E / L = E⁰ · V₀ + A · mean((V − V₀) · cosθ cosθ / r²)
//!
//! With E⁰ at the pixel's centre; in `area` pixels, whose mean estimates the pixel's mean E, A is scaled by E⁰ over its own
//! mean. So V is the pixel's mean E over its mean E⁰, as the oracle has it, and a lit pixel is exactly E⁰.
//!
//! Where the masks' bounds say that everything a pixel can see has one transmittance, V₀ is that transmittance and the
//! mean is exactly zero, sampled or not: no samples are spent there and the bytes are the same. Elsewhere V₀ = 0. No
//! pilot run decides anything, so the estimate stays unbiased.

pub(crate) mod bounds;
mod budget;
mod estimate;
#[cfg_attr(not(feature = "gpu"), path = "no_gpu.rs")]
mod gpu;
mod native;
mod plan;
pub(crate) mod points;
mod tilted;

use std::collections::HashMap;
use std::sync::Arc;
use std::time::Instant;

use kelir_scene::{Ambient, Theatre};
use std::ops::Bound;

use serde::{Deserialize, Serialize};

use crate::techniques::knobs::{self, Knob, Range};

use crate::encode::{Srgb, pack};
use crate::irradiance::UnitImages;
use crate::simd::Isa;
use crate::{Backend, Frame, Layer, Meter, Pixel, RenderError, Renderer, Stats, View, albedo};
use bounds::Padded;
use estimate::{Estimator, Row};
use points::{Points, REPLICATES};

/// Stands in the key of every job: raise it, and bless the golden images, with any change that can change a byte that this technique
/// draws, in its own files or in what it borrows from another. What was made before is then made anew.
pub const REVISION: u32 = 1;

/// What can be turned.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Knobs {
    /// Samples per pixel and emitter in penumbra, 1..=2²⁰, rounded up to a multiple of the 16 scrambles.
    pub spp: u32,
    /// Seed of the scrambles.
    pub seed: u64,
    /// In place of `spp`: enough samples for this root mean square error over penumbra pixels, in units of the brightest
    /// unshadowed pixel, in (0, 1). What a pilot decides is frozen and counted as `spp`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub target_error: Option<f64>,
    /// In place of `spp`: as many samples as this many seconds allow, > 0; frozen and counted likewise, so that `spp`
    /// replays the image to the byte. With `target_error` too, whichever is reached first.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_limit_s: Option<f64>,
}

impl Default for Knobs {
    fn default() -> Self {
        Self { spp: 64, seed: 1, target_error: None, time_limit_s: None }
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
        about: "samples a pixel and emitter in penumbra, rounded up to a multiple of 16 replicates",
    },
    knobs::SEED,
    Knob {
        name: "target_error",
        unit: "full scale",
        range: Range::Number(Bound::Excluded(0.0), Bound::Excluded(1.0)),
        about: "in place of spp: enough samples for this root mean square error over penumbra",
    },
    Knob {
        name: "time_limit_s",
        unit: "s",
        range: Range::Number(Bound::Excluded(0.0), Bound::Unbounded),
        about: "in place of spp: as many samples as this time allows; the count is recorded and replays the image",
    },
];

/// The renderer for `knobs` on `backend`.
pub fn renderer(knobs: &Knobs, backend: Backend) -> Result<Box<dyn Renderer>, RenderError> {
    knobs.check()?;
    let gpu = crate::gpu::choose(backend)?.map(|gpu| gpu::Sampler::new(gpu, gpu::WGSL)).transpose()?;
    Ok(Box::new(Mc::new(*knobs, gpu)))
}

/// Keeps masks, points and E⁰ between frames.
struct Mc {
    knobs: Knobs,
    masks: HashMap<u64, Arc<Padded>>,
    points: Option<Arc<Points>>,
    /// E⁰ of each emitter at unit radiance.
    lit: UnitImages,
    /// `None` draws on the CPU.
    gpu: Option<gpu::Sampler>,
    /// Lights that stand still, in place of random points.
    lattice: Option<Arc<Points>>,
    meter: Meter,
}

/// The renderer of `lights` × `lights` point lights an emitter, seen from `subpixels` × `subpixels` points of an `area`
/// pixel: the same maps, masks and bounds with points that stand still and weigh the same.
pub(crate) fn lattice(
    lights: usize,
    subpixels: usize,
    backend: Backend,
) -> Result<Box<dyn Renderer>, RenderError> {
    let gpu = crate::gpu::choose(backend)?.map(|gpu| gpu::Sampler::new(gpu, gpu::WGSL)).transpose()?;
    let lattice = Some(Arc::new(Points::lattice(lights, subpixels)));
    Ok(Box::new(Mc { lattice, ..Mc::new(Knobs::default(), gpu) }))
}

/// The sampler alone, for benchmarks: what it returns samples the first emitter at pixel (i, j) of a grey theatre.
pub(crate) fn sampler(theatre: Theatre, view: &View, spp: u32) -> impl FnMut(usize, usize) + 'static {
    let masks: Vec<_> = theatre.planes.iter().map(|p| Arc::new(Padded::new(&p.mask))).collect();
    let plan = plan::Plan::new(&theatre, view, &masks, false).expect("a view of the screen's aspect");
    let points = Points::new(1, (spp as usize / REPLICATES).max(1));
    move |i, j| {
        let sampler = native::Sampler { plan: &plan, masks: &masks, points: &points, planes: 0..masks.len() };
        std::hint::black_box(sampler.sums::<1>(0, i, j, [0.0]));
    }
}

impl Mc {
    fn new(knobs: Knobs, gpu: Option<gpu::Sampler>) -> Self {
        Self {
            knobs,
            masks: HashMap::new(),
            points: None,
            lit: UnitImages::default(),
            gpu,
            lattice: None,
            meter: Meter::default(),
        }
    }

    /// Draws all rows; `layers` asks for more than the radiance.
    fn rows(
        &mut self,
        theatre: &Theatre,
        view: &View,
        layers: bool,
    ) -> Result<(Vec<Row>, Stats), RenderError> {
        let mut stats = Stats::default();
        let started = Instant::now();
        if !view.skip {
            self.masks.clear();
            self.lit = UnitImages::default();
        }
        self.prepare(theatre, view);
        let masks: Vec<_> = theatre.planes.iter().map(|p| self.masks[&p.mask.id].clone()).collect();
        let plan = plan::Plan::new(theatre, view, &masks, self.lattice.is_some())?;
        let albedo = albedo::on_grid(&theatre.screen, view);
        let (lit, means) = (self.lit.centres(), self.lit.means());
        stats.steps_ms.push(("prepare".into(), started.elapsed().as_secs_f64() * 1e3));
        let (gpu, meter) = (&mut self.gpu, &self.meter);
        let mut draw = |points: &Points, rows: &[usize]| {
            let estimator = Estimator {
                theatre,
                plan: &plan,
                masks: &masks,
                lit: &lit,
                means: &means,
                radiance: sources(theatre).map(|(_, radiance)| radiance).collect(),
                albedo: &albedo,
                points,
                skip: view.skip,
                layers,
                meter,
            };
            let Some(gpu) = gpu else { return Ok(estimator.rows(rows)) };
            let ids: Vec<_> = theatre.planes.iter().map(|p| p.mask.id).collect();
            let scene = gpu.prepare(&plan, &ids, &masks, points)?;
            estimator.rows_by(rows, |jobs| gpu.run(&plan, &scene, jobs))
        };
        let clock = Instant::now();
        let samples = match &self.lattice {
            Some(lattice) => lattice.samples,
            None => budget::freeze(&self.knobs, view.size[1], started, |p, rows| draw(&p, rows))?,
        };
        stats.steps_ms.push(("pilot".into(), clock.elapsed().as_secs_f64() * 1e3));
        let clock = Instant::now();
        let points = match (&self.lattice, &self.points) {
            (Some(lattice), _) => lattice.clone(),
            (_, Some(points)) if points.samples == samples => points.clone(),
            _ => Arc::new(Points::new(self.knobs.seed, samples)),
        };
        self.meter.begin(view.size[1]);
        let rows = draw(&points, &(0..view.size[1]).collect::<Vec<_>>())?;
        self.points = Some(points);
        stats.steps_ms.push(("sample".into(), clock.elapsed().as_secs_f64() * 1e3));
        count(&rows, samples, plan.emitters.len(), view, &mut stats);
        let dark = sources(theatre).filter(|(_, radiance)| *radiance == [0.0; 3]).count();
        stats.counts.insert("emitters_dark".into(), if view.skip && !layers { dark as u64 } else { 0 });
        if self.lattice.is_some() {
            // What the lanes of a lattice differ by is no error.
            stats.values.clear();
            stats.counts.remove("replicates");
        }
        Ok((rows, stats))
    }

    /// Brings masks and E⁰ up to date with the theatre, and forgets what it no longer uses.
    fn prepare(&mut self, theatre: &Theatre, view: &View) {
        self.masks.retain(|id, _| theatre.planes.iter().any(|p| p.mask.id == *id));
        for plane in &theatre.planes {
            self.masks.entry(plane.mask.id).or_insert_with(|| Arc::new(Padded::new(&plane.mask)));
        }
        // Sampled over a pixel, E is its mean over the pixel's area.
        let means = view.pixel == Pixel::Area && self.lattice.is_none();
        self.lit.update(theatre, view.size, means);
    }
}

impl Renderer for Mc {
    fn radiance(&mut self, theatre: &Theatre, view: &View) -> Result<Frame, RenderError> {
        let (rows, stats) = self.rows(theatre, view, true)?;
        let n = view.size[0] * view.size[1];
        let coloured = theatre.planes.iter().any(|p| p.mask.channels == 3);
        let mut names: Vec<String> = ["SE.R", "SE.G", "SE.B"].map(String::from).to_vec();
        let kind = if self.lattice.is_some() { "Vgeo" } else { "Virr" };
        for (name, _) in sources(theatre) {
            match coloured {
                true => names.extend(["R", "G", "B"].map(|c| format!("{kind}.{name}.{c}"))),
                false => names.push(format!("{kind}.{name}")),
            }
        }
        let mut planes: Vec<Vec<f32>> = (0..3 + names.len()).map(|_| Vec::with_capacity(n)).collect();
        for row in &rows {
            for (plane, values) in planes.iter_mut().zip(row.values.chunks_exact(view.size[0])) {
                plane.extend_from_slice(values);
            }
        }
        let mut planes = planes.into_iter();
        let radiance = [(); 3].map(|()| planes.next().expect("three planes of radiance"));
        let layers = names.into_iter().zip(planes).map(|(name, values)| Layer { name, values });
        let layers = layers.filter(|l| self.lattice.is_none() || !l.name.starts_with("SE.")).collect();
        Ok(Frame { size: view.size, radiance, layers, stats })
    }

    fn display(
        &mut self,
        theatre: &Theatre,
        view: &View,
        white: f64,
        out: &mut [u32],
    ) -> Result<Stats, RenderError> {
        if out.len() != view.size[0] * view.size[1] {
            let [w, h] = view.size;
            return Err(RenderError::View(format!("{} pixels given for {w}x{h}", out.len())));
        }
        if !(white.is_finite() && white > 0.0) {
            return Err(RenderError::View(format!("white = {white}: a radiance above 0")));
        }
        let (rows, stats) = self.rows(theatre, view, false)?;
        let (width, srgb, scale) = (view.size[0], Srgb::get(), (1.0 / white) as f32);
        for (out, row) in out.chunks_exact_mut(width).zip(&rows) {
            for (i, pixel) in out.iter_mut().enumerate() {
                let [r, g, b] = [0, 1, 2].map(|c| srgb.code(row.values[c * width + i] * scale));
                *pixel = pack(r, g, b);
            }
        }
        Ok(stats)
    }

    fn watch(&mut self, meter: &Meter) {
        self.meter = meter.clone();
    }

    fn class(&self) -> String {
        self.gpu.as_ref().map_or("cpu".into(), |sampler| sampler.gpu.class())
    }

    fn adapter(&self) -> String {
        if let Some(sampler) = &self.gpu {
            return sampler.gpu.adapter();
        }
        format!("native {} threads {}", rayon::current_num_threads(), Isa::detect().name())
    }
}

/// Name and radiance of everything that shines: the emitters, then the dome.
fn sources(theatre: &Theatre) -> impl Iterator<Item = (&str, [f64; 3])> {
    let dome = match theatre.ambient {
        Ambient::Dome { radiance } => Some(("dome", radiance)),
        _ => None,
    };
    theatre.lamp.emitters.iter().map(|e| (e.name.as_str(), e.radiance)).chain(dome)
}

/// Counters and the standard error's summary.
fn count(rows: &[Row], samples: usize, emitters: usize, view: &View, stats: &mut Stats) {
    let spp = (samples * REPLICATES) as u64;
    let jobs = rows.iter().map(|r| r.jobs).sum::<u64>();
    let penumbra = rows.iter().map(|r| r.penumbra).sum::<u64>();
    let pixels = (view.size[0] * view.size[1]) as u64;
    for (name, count) in [
        ("spp", spp),
        ("replicates", REPLICATES as u64),
        ("pixels", pixels),
        ("pixels_in_penumbra", penumbra),
        ("samples", jobs * spp),
        ("samples_skipped", (pixels * emitters as u64).saturating_sub(jobs) * spp),
    ] {
        stats.counts.insert(name.into(), count);
    }
    let full = rows.iter().map(|r| r.brightest).fold(0.0, f64::max);
    if full > 0.0 {
        let sum = rows.iter().map(|r| r.error_sum).sum::<f64>();
        let square = rows.iter().map(|r| r.error_square).sum::<f64>();
        let max = rows.iter().map(|r| r.error_max).fold(0.0, f64::max);
        let n = penumbra.max(1) as f64;
        stats.values.insert("se_mean".into(), sum / n / full);
        stats.values.insert("se_rms".into(), (square / n).sqrt() / full);
        stats.values.insert("se_max".into(), max / full);
    }
}

#[cfg(test)]
mod tests;
