//! Error against time: every technique over its knobs on one scene, in one run.
//!
//! Errors are of the irradiance, in units of the brightest unshadowed point ([`kelir_vision::errors`]). Whole images are held
//! against Monte Carlo with a seed of its own and many more samples than any image under test; its standard error is the
//! floor below which nothing can be told. Crops are held against the oracle, in two parts:
//!
//! - *model error*: what the technique's formula gives in exact arithmetic (the oracle's geometric visibility, for PA,
//!   points and PCSS) against the true irradiance; nothing that a knob can mend.
//! - *numerical error*: the technique against the oracle of its own model.

mod cases;
mod crops;
mod images;
mod report;

use std::time::Instant;

use kelir_scene::Scene;
use kelir_vision::errors::{Errors, errors};

pub use cases::{Case, SEED, all};
pub use crops::Crop;
pub use report::{CaseReport, Measured, OnCrops, Oracle, Outcome, Reference, Report, Times};

use crate::exposure::Rule;
use crate::job::{Spread, irradiance};
use crate::subject::{Staged, Subject};
use crate::{Backend, Frame, RenderError, Technique, View, albedo, encode, mc, penumbra, renderer};
use crops::Truth;
use images::Seen;

/// What is measured, and how carefully.
#[derive(Clone, Debug)]
pub struct Options {
    /// Size and pixel rule.
    pub view: View,
    /// Each case is drawn on each of them.
    pub backends: Vec<Backend>,
    /// Timed drawings a case, ≥ 1.
    pub runs: usize,
    /// Samples per pixel of the reference; more than any case has.
    pub reference_spp: u32,
    /// Its seed; not [`SEED`].
    pub reference_seed: u64,
    /// How many crops, and pixels a side of each.
    pub crops: [usize; 2],
    /// The oracle's tolerance, where nothing is a finite sum.
    pub tolerance: f64,
}

impl Options {
    /// For `view`: the native code, five runs, 16384 samples, eight crops of 8 × 8 pixels to 1e-4.
    pub fn new(view: View) -> Self {
        Self {
            view,
            backends: vec![Backend::Cpu],
            runs: 5,
            reference_spp: 16384,
            reference_seed: 2,
            crops: [8, 8],
            tolerance: 1e-4,
        }
    }

    fn check(&self, cases: &[Case]) -> Result<(), RenderError> {
        let refuse = |text| Err(RenderError::Knob(text));
        if self.runs == 0 {
            return refuse("runs = 0: at least one drawing is timed".into());
        }
        if self.reference_seed == SEED {
            return refuse(format!("reference_seed = {SEED}: the images under test have this one"));
        }
        let most = cases.iter().map(|case| case.technique.truth_samples()).max().unwrap_or(0);
        if self.reference_spp <= most {
            let spp = self.reference_spp;
            return refuse(format!("reference_spp = {spp}: more than the {most} of an image under test"));
        }
        Ok(())
    }
}

/// How far a measurement is.
#[derive(Clone, Debug)]
pub struct Progress<'a> {
    /// Steps done.
    pub done: usize,
    /// Steps in all.
    pub total: usize,
    /// What is done next.
    pub what: &'a str,
}

/// What all cases share.
struct Bench<'a> {
    options: &'a Options,
    theatre: &'a kelir_scene::Theatre,
    albedo: albedo::PixelAlbedo,
    penumbra: Vec<bool>,
    full_scale: f64,
    white: f64,
    reference: Seen,
    truth: Result<Truth, String>,
}

/// Draws every case on every backend and measures it. `progress` is called before each step and once at the end.
///
/// Errors: options out of range, an impossible view, a reference that cannot be drawn, no adapter. A case that its technique
/// refuses is none: its reason is in the report.
pub fn measure(
    scene: &Scene,
    cases: &[Case],
    options: &Options,
    progress: &mut dyn FnMut(Progress),
) -> Result<Report, RenderError> {
    options.check(cases)?;
    let view = &options.view;
    let theatre = &scene.still();
    view.check(theatre.sides())?;
    let total = cases.len() * options.backends.len() + 2;
    let mut step = |done, what: &str| progress(Progress { done, total, what });

    step(0, "reference");
    let knobs =
        mc::Knobs { spp: options.reference_spp, seed: options.reference_seed, ..mc::Knobs::default() };
    let technique = Technique::Mc(knobs);
    let mut drawing = renderer(&technique, Backend::Auto)?;
    let clock = Instant::now();
    let frame = drawing.radiance(theatre, view)?;
    let seconds = clock.elapsed().as_secs_f64();
    let albedo = albedo::on_grid(&theatre.screen, view);
    let brightest = theatre.brightest(view);
    let full_scale = if brightest > 0.0 { brightest } else { 1.0 };
    let penumbra = penumbra::mask(theatre, view);
    let floor = |counted: &dyn Fn(usize) -> bool| {
        let mut spread = Spread::default();
        spread.add(&frame, &albedo, &|k, _| counted(k));
        spread.root_mean_square() / full_scale
    };
    let reference = Reference {
        technique,
        adapter: drawing.adapter(),
        seconds,
        floor: floor(&|k| penumbra[k]),
        floor_all: floor(&|_| true),
    };

    step(1, "oracle");
    let white = scene.white(Rule::Still, view, None);
    let chosen = crops::choose(&penumbra, view.size, options.crops);
    let truth = match Truth::draw(theatre, view, &albedo, chosen, options.tolerance) {
        Ok(truth) => Ok(truth),
        Err(RenderError::Inapplicable { reason, .. }) => Err(reason),
        Err(other) => return Err(other),
    };
    let oracle = Oracle {
        tolerance: options.tolerance,
        crops: truth.as_ref().map_or(Vec::new(), |t| t.crops.clone()),
        refused: truth.as_ref().err().cloned(),
        geometric: match &truth {
            Ok(truth) => compare(&truth.geometric, &truth.irradiance, None, full_scale)?,
            Err(_) => Errors::default(),
        },
    };
    let seen = Seen::new(irradiance(&frame, &albedo), &encode::display(&frame, white), view.size);
    let bench = Bench { options, theatre, albedo, full_scale, white, reference: seen, truth, penumbra };
    let mut results = Vec::new();
    for backend in &options.backends {
        for case in cases {
            step(2 + results.len(), &format!("{} {}", case.series, case.knob));
            results.push(bench.case(case, *backend)?);
        }
    }
    step(total, "done");
    Ok(Report {
        version: env!("CARGO_PKG_VERSION"),
        scene_sha256: scene.sha256().into(),
        size: view.size,
        pixel: view.pixel,
        threads: rayon::current_num_threads(),
        runs: options.runs,
        full_scale,
        white,
        penumbra_pixels: bench.penumbra.iter().filter(|p| **p).count(),
        reference,
        oracle,
        results,
    })
}

/// [`errors`] with a message that says where.
fn compare(
    image: &[f64],
    reference: &[f64],
    mask: Option<&[bool]>,
    full_scale: f64,
) -> Result<Errors, RenderError> {
    errors(image, reference, mask, full_scale)
        .map_err(|e| RenderError::Encode(format!("measured error: {e}")))
}

impl Bench<'_> {
    fn case(&self, case: &Case, backend: Backend) -> Result<CaseReport, RenderError> {
        let drawn = renderer(&case.technique, backend).and_then(|mut drawing| {
            let frame = drawing.radiance(self.theatre, &self.options.view)?;
            Ok((drawing.adapter(), frame))
        });
        let report = |adapter, outcome| CaseReport { case: case.clone(), backend, adapter, outcome };
        let (adapter, frame) = match drawn {
            Ok(drawn) => drawn,
            Err(RenderError::Inapplicable { reason, .. }) => {
                return Ok(report(None, Outcome::Refused(reason)));
            }
            Err(other) => return Err(other),
        };
        // That drawing was the warm-up.
        let [first, again] = self.times(&case.technique, backend)?;
        let measured = self.errors(&frame, first, again)?;
        Ok(report(Some(adapter), Outcome::Measured(measured)))
    }

    /// First images of new renderers, and the same images again.
    fn times(&self, technique: &Technique, backend: Backend) -> Result<[Times; 2], RenderError> {
        let [width, height] = self.options.view.size;
        let mut out = vec![0; width * height];
        let mut seconds = [Vec::new(), Vec::new()];
        for _ in 0..self.options.runs {
            let mut drawing = renderer(technique, backend)?;
            for seconds in &mut seconds {
                let clock = Instant::now();
                drawing.display(self.theatre, &self.options.view, self.white, &mut out)?;
                seconds.push(clock.elapsed().as_secs_f64());
            }
        }
        Ok(seconds.map(Times::of))
    }

    fn errors(&self, frame: &Frame, first: Times, again: Times) -> Result<Measured, RenderError> {
        let size = self.options.view.size;
        let seen = Seen::new(irradiance(frame, &self.albedo), &encode::display(frame, self.white), size);
        // Where the screen is black there is no irradiance to read: NaN in both.
        let both = |k: usize| seen.irradiance[k].is_finite() && self.reference.irradiance[k].is_finite();
        let readable: Vec<usize> = (0..seen.irradiance.len()).filter(|k| both(*k)).collect();
        let at = |image: &[f64]| -> Vec<f64> { readable.iter().map(|k| image[*k]).collect() };
        let (ours, theirs) = (at(&seen.irradiance), at(&self.reference.irradiance));
        let marked: Vec<bool> = readable.iter().map(|k| self.penumbra[k % self.penumbra.len()]).collect();
        let crops = match &self.truth {
            Ok(truth) if !truth.crops.is_empty() => {
                Some(truth.measure(frame, &seen.irradiance, self.full_scale)?)
            }
            _ => None,
        };
        Ok(Measured {
            first,
            again,
            all: compare(&ours, &theirs, None, self.full_scale)?,
            penumbra: compare(&ours, &theirs, Some(&marked), self.full_scale)?,
            crops,
            ssim: seen.ssim(&self.reference),
            flip: seen.flip(&self.reference),
        })
    }
}

#[cfg(test)]
mod tests;
