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

use std::time::Instant;

use kelir_scene::Scene;
use kelir_vision::errors::{Errors, errors};
use serde::Serialize;

pub use cases::{Case, SEED, all};
pub use crops::{Crop, Model};

use crate::job::{Spread, brightest, irradiance, named};
use crate::{
    Backend, Frame, Pixel, RenderError, Technique, View, albedo, encode, exposure, mc, penumbra, renderer,
};
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
        let spp = |case: &Case| if let Technique::Mc(knobs) = &case.technique { knobs.spp } else { 0 };
        let most = cases.iter().map(spp).max().unwrap_or(0);
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

/// What [`measure`] found.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// kelir's version.
    pub version: &'static str,
    /// Hash of the scene's values and files.
    pub scene_sha256: String,
    /// Pixels [width, height].
    pub size: [usize; 2],
    /// Pixel rule.
    pub pixel: Pixel,
    /// Threads that drew.
    pub threads: usize,
    /// Timed drawings a case.
    pub runs: usize,
    /// Irradiance that errors are in units of: the brightest unshadowed point's.
    pub full_scale: f64,
    /// The radiance shown as white on the display images.
    pub white: f64,
    /// Pixels in penumbra.
    pub penumbra_pixels: usize,
    /// What whole images are held against.
    pub reference: Reference,
    /// What crops are held against.
    pub oracle: Oracle,
    /// One a case and backend.
    pub results: Vec<CaseReport>,
}

/// The Monte-Carlo image that whole images are held against.
#[derive(Clone, Debug, Serialize)]
pub struct Reference {
    /// Its knobs.
    #[serde(flatten)]
    pub technique: Technique,
    /// What drew it.
    pub adapter: String,
    /// Seconds that it took.
    pub seconds: f64,
    /// Its own standard error, root mean square over penumbra pixels and channels, in units of full scale: the floor.
    pub floor: f64,
    /// The same over all pixels.
    pub floor_all: f64,
}

/// The oracle's crops.
#[derive(Clone, Debug, Serialize)]
pub struct Oracle {
    /// Its tolerance.
    pub tolerance: f64,
    /// Where it looked; empty where it cannot draw the scene or nothing is in penumbra.
    pub crops: Vec<Crop>,
    /// Why it could not.
    pub refused: Option<String>,
    /// E⁰ · Vgeo against the true irradiance over the crops: the model error of everything that draws geometric visibility.
    #[serde(serialize_with = "named")]
    pub geometric: Errors,
}

/// One case on one backend.
#[derive(Clone, Debug, Serialize)]
pub struct CaseReport {
    /// What was drawn.
    #[serde(flatten)]
    pub case: Case,
    /// Where it was asked to draw.
    pub backend: Backend,
    /// What drew it; none where nothing was drawn.
    pub adapter: Option<String>,
    /// What was measured, or why not.
    #[serde(flatten)]
    pub outcome: Outcome,
}

/// What came of a case.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "snake_case")]
#[allow(clippy::large_enum_variant)] // A few dozen of them, all measured.
pub enum Outcome {
    /// Its times and errors.
    Measured(Measured),
    /// The technique cannot draw this scene: its reason.
    Refused(String),
}

/// Times and errors of one case.
#[derive(Clone, Debug, Serialize)]
pub struct Measured {
    /// A new renderer's first image: tables, maps, E⁰ and all, but no file and no compiling of shaders.
    pub first: Times,
    /// The same image again: what moved nothing is kept.
    pub again: Times,
    /// Against the reference, all pixels and channels.
    #[serde(serialize_with = "named")]
    pub all: Errors,
    /// Against the reference, pixels in penumbra.
    #[serde(serialize_with = "named")]
    pub penumbra: Errors,
    /// Against the oracle, where it applies.
    pub crops: Option<OnCrops>,
    /// Structural similarity of the display images to the reference's; none under 11 pixels a side.
    pub ssim: Option<f64>,
    /// Mean FLIP of the display images against the reference's.
    pub flip: f64,
}

/// Errors over the oracle's crops.
#[derive(Clone, Debug, Serialize)]
pub struct OnCrops {
    /// Which visibility the technique's formula tends to.
    pub model: Model,
    /// Against the oracle of that model.
    #[serde(serialize_with = "named")]
    pub numerical: Errors,
    /// Against the true irradiance.
    #[serde(serialize_with = "named")]
    pub total: Errors,
    /// Largest numerical error of an emitter's visibility.
    pub visibility_max: f64,
}

/// Wall times of several drawings, seconds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Times {
    /// Lower quartile.
    pub lower: f64,
    /// Median.
    pub median: f64,
    /// Upper quartile.
    pub upper: f64,
}

impl Times {
    /// Quartiles between order statistics (R's type 7); `seconds` has at least one.
    fn of(mut seconds: Vec<f64>) -> Self {
        seconds.sort_by(f64::total_cmp);
        let quantile = |q: f64| {
            let at = q * (seconds.len() - 1) as f64;
            let (below, above) = (seconds[at.floor() as usize], seconds[at.ceil() as usize]);
            below + (above - below) * at.fract()
        };
        Self { lower: quantile(0.25), median: quantile(0.5), upper: quantile(0.75) }
    }
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
    crate::pa::check_view(theatre, view)?;
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
    let brightest = brightest(theatre, view);
    let full_scale = if brightest > 0.0 { brightest } else { 1.0 };
    let penumbra = penumbra::mask(theatre, view);
    let floor = |counted: &dyn Fn(usize) -> bool| {
        let mut spread = Spread::default();
        spread.add(&frame, &albedo, |k, _| counted(k));
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
    let white = exposure::of_scene(scene, view, false);
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
