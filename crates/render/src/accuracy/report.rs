//! What a measurement says, as it is written to JSON.

use kelir_vision::errors::Errors;
use serde::Serialize;

use super::{Case, Crop};
use crate::job::named;
use crate::{Backend, Pixel, Technique, VisibilityModel};

/// What [`super::measure`] found.
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
#[allow(clippy::large_enum_variant, reason = "a few dozen of them, all measured")]
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
    pub model: VisibilityModel,
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
    pub(super) fn of(mut seconds: Vec<f64>) -> Self {
        seconds.sort_by(f64::total_cmp);
        let quantile = |q: f64| {
            let at = q * (seconds.len() - 1) as f64;
            let (below, above) = (seconds[at.floor() as usize], seconds[at.ceil() as usize]);
            below + (above - below) * at.fract()
        };
        Self { lower: quantile(0.25), median: quantile(0.5), upper: quantile(0.75) }
    }
}
