//! Points of an emitter traced to the screen through all planes: what techniques share that draw sample by sample.
//!
//! A table of points ([`sobol`]) spreads over every source of light, and over the pixel for `area`, in sixteen lanes. What is
//! estimated is the *deviation* from a visibility V₀:
//!
//! > E / L = E⁰ · V₀ + A · mean((V − V₀) · cosθ cosθ / r²)
//!
//! With E⁰ at the pixel's centre; in `area` pixels, whose mean estimates the pixel's mean E, A is scaled by E⁰ over its own
//! mean. So V is the pixel's mean E over its mean E⁰, as the oracle has it, and a lit pixel is exactly E⁰. Where geometric
//! visibility is asked for instead, all points weigh the same: E / L is E⁰ times their mean V.
//!
//! Where the masks' bounds say that everything a pixel can see has one transmittance, V₀ is that transmittance and the
//! mean is exactly zero, sampled or not: no samples are spent there and the bytes are the same. Elsewhere V₀ = 0.

mod axis;
pub(crate) mod bounds;
mod estimate;
#[cfg_attr(not(feature = "gpu"), path = "no_gpu.rs")]
pub(crate) mod gpu;
mod native;
mod plan;
pub(crate) mod scenes;
pub(crate) use kelir_frame::sobol;
mod tables;
mod tilted;

use std::collections::HashMap;
use std::sync::Arc;

use kelir_frame::{Backend, Frame, Isa, Meter, Pixel, RenderError, Stats, View, VisibilityModel};
use kelir_scene::{Ambient, Theatre};

use crate::albedo::{self, PixelAlbedo};
use crate::emitters::each_visibility;
use crate::irradiance::UnitImages;
use bounds::Padded;
use estimate::Estimator;
pub(crate) use estimate::Row;
use sobol::{Points, REPLICATES};
use tables::Tables;

/// Keeps masks and E⁰ between frames.
pub(crate) struct Tracer {
    masks: HashMap<u64, Arc<Padded>>,
    /// E⁰ of each emitter at unit radiance.
    lit: UnitImages,
    /// `None` traces on the CPU.
    gpu: Option<gpu::Sampler>,
    /// Told of each row that is done.
    pub meter: Meter,
}

impl Tracer {
    /// On `backend`. Errors: no adapter where there must be one.
    pub(crate) fn new(backend: Backend) -> Result<Self, RenderError> {
        let gpu = kelir_frame::gpu::choose(backend)?;
        Ok(Self::of(gpu.map(|gpu| gpu::Sampler::new(gpu, gpu::WGSL)).transpose()?))
    }

    /// On `gpu`, with the right shader or, for a negative control, with one that is off.
    #[cfg(feature = "gpu")]
    pub(crate) fn with_shader(gpu: &kelir_frame::gpu::Gpu, wgsl: &str) -> Result<Self, RenderError> {
        Ok(Self::of(Some(gpu::Sampler::new(gpu.clone(), wgsl)?)))
    }

    fn of(gpu: Option<gpu::Sampler>) -> Self {
        Self { masks: HashMap::new(), lit: UnitImages::default(), gpu, meter: Meter::default() }
    }

    /// Begins a frame, for which masks and E⁰ are brought up to date; `visibilities` asks for more than its radiance.
    pub(crate) fn trace<'a>(
        &'a mut self,
        theatre: &'a Theatre,
        view: &'a View,
        model: VisibilityModel,
        visibilities: bool,
    ) -> Result<Trace<'a>, RenderError> {
        if !view.skip {
            self.masks.clear();
            self.lit = UnitImages::default();
        }
        self.masks.retain(|id, _| theatre.planes.iter().any(|p| p.mask.id == *id));
        for plane in &theatre.planes {
            self.masks.entry(plane.mask.id).or_insert_with(|| Arc::new(Padded::new(&plane.mask)));
        }
        // Sampled over a pixel, E is its mean over the pixel's area.
        let means = view.pixel == Pixel::Area && model == VisibilityModel::Irradiance;
        self.lit.update(theatre, view.size, means);
        let masks: Vec<_> = theatre.planes.iter().map(|p| self.masks[&p.mask.id].clone()).collect();
        let plan = plan::Plan::new(theatre, view, &masks, model == VisibilityModel::Geometric)?;
        let albedo = albedo::on_grid(&theatre.screen, view);
        let (lit, gpu, meter) = (&self.lit, self.gpu.as_mut(), &self.meter);
        Ok(Trace { theatre, view, model, visibilities, plan, masks, lit, albedo, gpu, meter })
    }

    /// As [`kelir_frame::Renderer::class`].
    pub(crate) fn class(&self) -> String {
        self.gpu.as_ref().map_or("cpu".into(), |sampler| sampler.gpu.class())
    }

    /// As [`kelir_frame::Renderer::adapter`].
    pub(crate) fn adapter(&self) -> String {
        match &self.gpu {
            Some(sampler) => sampler.gpu.adapter(),
            None => Isa::native(),
        }
    }
}

/// A frame under way.
pub(crate) struct Trace<'a> {
    theatre: &'a Theatre,
    view: &'a View,
    model: VisibilityModel,
    visibilities: bool,
    plan: plan::Plan,
    masks: Vec<Arc<Padded>>,
    lit: &'a UnitImages,
    albedo: PixelAlbedo,
    gpu: Option<&'a mut gpu::Sampler>,
    meter: &'a Meter,
}

impl Trace<'_> {
    /// The given rows with these points.
    pub(crate) fn rows(&mut self, points: &Points, rows: &[usize]) -> Result<Vec<Row>, RenderError> {
        let tables = Tables::new(&self.plan, points, estimate::alone(self.theatre));
        let estimator = Estimator {
            theatre: self.theatre,
            plan: &self.plan,
            masks: &self.masks,
            lit: &self.lit.centres(),
            means: &self.lit.means(),
            radiance: sources(self.theatre).map(|(_, radiance)| radiance).collect(),
            albedo: &self.albedo,
            points,
            tables: &tables,
            skip: self.view.skip,
            layers: self.visibilities,
            meter: self.meter,
        };
        let Some(gpu) = &mut self.gpu else { return Ok(estimator.rows(rows)) };
        let ids: Vec<_> = self.theatre.planes.iter().map(|p| p.mask.id).collect();
        let scene = gpu.prepare(&self.plan, &ids, &self.masks, points, &tables)?;
        estimator.rows_by(rows, |jobs| gpu.run(&self.plan, &scene, jobs))
    }

    /// All rows, counted on the meter.
    pub(crate) fn all(&mut self, points: &Points) -> Result<Vec<Row>, RenderError> {
        self.meter.begin(self.view.size[1]);
        self.rows(points, &(0..self.view.size[1]).collect::<Vec<_>>())
    }

    /// Counts what tracing `rows` with so many points a lane took.
    pub(crate) fn count(&self, rows: &[Row], samples: usize, stats: &mut Stats) {
        let spp = (samples * REPLICATES) as u64;
        let jobs = rows.iter().map(|r| r.jobs).sum::<u64>();
        let pixels = (self.view.size[0] * self.view.size[1]) as u64;
        let all = pixels * self.plan.emitters.len() as u64;
        let dark = sources(self.theatre).filter(|(_, radiance)| *radiance == [0.0; 3]).count();
        for (name, count) in [
            ("spp", spp),
            ("pixels", pixels),
            ("pixels_in_penumbra", rows.iter().map(|r| r.penumbra).sum()),
            ("samples", jobs * spp),
            ("samples_skipped", all.saturating_sub(jobs) * spp),
            ("emitters_dark", if self.view.skip && !self.visibilities { dark as u64 } else { 0 }),
        ] {
            stats.counts.insert(name.into(), count);
        }
    }

    /// The image; its standard errors are the spread of the lanes.
    pub(crate) fn frame(&self, rows: &[Row], stats: Stats) -> Frame {
        let [width, height] = self.view.size;
        let count = rows.first().map_or(0, |row| row.values.len() / width);
        let mut planes: Vec<Vec<f32>> = (0..count).map(|_| Vec::with_capacity(width * height)).collect();
        for row in rows {
            for (plane, values) in planes.iter_mut().zip(row.values.chunks_exact(width)) {
                plane.extend_from_slice(values);
            }
        }
        let mut planes = planes.into_iter();
        let mut three = || [(); 3].map(|()| planes.next().unwrap_or_default());
        let radiance = three();
        let standard_error = self.visibilities.then(three);
        let names = sources(self.theatre).map(|(name, _)| name).filter(|_| self.visibilities);
        let visibilities =
            each_visibility(self.theatre, names, self.model, |_, _| planes.next().unwrap_or_default());
        Frame { size: self.view.size, radiance, visibilities, standard_error, stats }
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

/// The sampler alone, for benchmarks: what it returns samples the first emitter at pixel (i, j) of a grey theatre.
pub(crate) fn sampler(theatre: Theatre, view: &View, spp: u32) -> impl FnMut(usize, usize) + 'static {
    let masks: Vec<_> = theatre.planes.iter().map(|p| Arc::new(Padded::new(&p.mask))).collect();
    let plan = plan::Plan::new(&theatre, view, &masks, false).expect("a view of the screen's aspect");
    let points = Points::new(1, (spp as usize / REPLICATES).max(1));
    let tables = Tables::new(&plan, &points, false);
    move |i, j| {
        let (planes, masks, plan) = (0..masks.len(), &masks, &plan);
        let sampler = native::Sampler { plan, masks, points: &points, planes, tables: &tables };
        std::hint::black_box(sampler.sums::<1>(0, i, j, [0.0]));
    }
}

#[cfg(test)]
mod tests;
