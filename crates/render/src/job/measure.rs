//! How sure a picture is: its error against a reference, and its own standard error.

use std::f64::consts::PI;

use kelir_scene::{Ambient, Theatre};
use kelir_vision::errors::{Errors, errors};
use serde::{Serialize, Serializer, ser::SerializeStruct};

use super::Drawing;
use crate::irradiance::UnitRows;
use crate::{Frame, RenderError, Technique, View, albedo, penumbra, renderer};

/// Error of the irradiance against a reference, in units of the brightest unshadowed point.
#[derive(Clone, Debug, Serialize)]
pub struct Measured {
    /// What it was measured against.
    pub reference: Technique,
    /// Frames that were compared.
    pub frames: Vec<usize>,
    /// Over all pixels and channels.
    #[serde(serialize_with = "named")]
    pub all: Errors,
    /// Over pixels in penumbra alone.
    #[serde(serialize_with = "named")]
    pub penumbra: Errors,
    /// The reference's own standard error, root mean square over the same penumbra pixels: what no measured error can go below.
    pub floor: Option<f64>,
}

/// The ground truth's own standard error of the irradiance, in units of the brightest unshadowed point.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct StandardError {
    /// Root mean square over the sampled pixels and channels of all frames; elsewhere it is exactly 0.
    pub rms_sampled: f64,
    /// The largest.
    pub max: f64,
}

/// Sums of the standard errors in frames.
#[derive(Default)]
pub(crate) struct Spread {
    squares: f64,
    count: usize,
    max: f64,
    /// Whether any frame had them.
    known: bool,
}

impl Spread {
    /// Adds the pixels that `counted` takes, as irradiance.
    pub(crate) fn add(
        &mut self,
        frame: &Frame,
        albedo: &albedo::PixelAlbedo,
        counted: impl Fn(usize, f64) -> bool,
    ) {
        for (c, errors) in frame.standard_error.iter().flatten().enumerate() {
            self.known = true;
            for (k, se) in errors.iter().enumerate() {
                let se = f64::from(*se) * PI / f64::from(albedo.at(c, k));
                if se.is_finite() && counted(k, se) {
                    self.squares += se * se;
                    self.count += 1;
                    self.max = self.max.max(se);
                }
            }
        }
    }

    pub(crate) fn root_mean_square(&self) -> f64 {
        (self.squares / self.count.max(1) as f64).sqrt()
    }

    pub(super) fn in_units_of(self, full_scale: f64) -> Option<StandardError> {
        let error =
            StandardError { rms_sampled: self.root_mean_square() / full_scale, max: self.max / full_scale };
        self.known.then_some(error)
    }
}

pub(crate) fn named<S: Serializer>(errors: &Errors, serializer: S) -> Result<S::Ok, S::Error> {
    let mut s = serializer.serialize_struct("Errors", 5)?;
    s.serialize_field("count", &errors.count)?;
    s.serialize_field("bias", &errors.bias)?;
    s.serialize_field("rmse", &errors.rmse)?;
    s.serialize_field("p999", &errors.p999)?;
    s.serialize_field("max", &errors.max)?;
    s.end()
}

/// Irradiance at the back of the screen and at its front the albedo: E = π L / albedo, NaN where the screen is black.
pub(crate) fn irradiance(frame: &Frame, albedo: &albedo::PixelAlbedo) -> Vec<f64> {
    let channel = |c: usize| {
        frame.radiance[c]
            .iter()
            .enumerate()
            .map(move |(k, l)| f64::from(*l) * PI / f64::from(albedo.at(c, k)))
    };
    (0..3).flat_map(channel).collect()
}

/// Draws `frames` of `drawing` in linear light, and the same with `reference`. `progress` takes how many are done.
pub(super) fn measure(
    drawing: &mut Drawing<'_>,
    reference: &Technique,
    frames: Vec<usize>,
    progress: &mut dyn FnMut(usize),
) -> Result<Measured, RenderError> {
    let view = drawing.job.view;
    let mut truth = renderer(reference, drawing.job.backend)?;
    let (mut ours, mut theirs, mut penumbra) = (Vec::new(), Vec::new(), Vec::new());
    let mut variance = Spread::default();
    let mut full_scale = 0f64;
    for (k, frame) in frames.iter().enumerate() {
        progress(k);
        let theatre = drawing.theatre(*frame);
        full_scale = full_scale.max(brightest(&theatre, &view));
        let albedo = albedo::on_grid(&theatre.screen, &view);
        let (a, b) = (drawing.radiance(*frame)?, truth.radiance(&theatre, &view)?);
        let marked = penumbra::mask(&theatre, &view);
        let seen: Vec<(f64, f64)> =
            irradiance(&a, &albedo).into_iter().zip(irradiance(&b, &albedo)).collect();
        for (i, (a, b)) in seen.iter().enumerate().filter(|(_, (a, b))| a.is_finite() && b.is_finite()) {
            ours.push(*a);
            theirs.push(*b);
            penumbra.push(marked[i % marked.len()]);
        }
        variance.add(&b, &albedo, |k, _| marked[k]);
    }
    let failed = |e: kelir_vision::errors::ErrorsError| RenderError::Encode(format!("measured error: {e}"));
    let full_scale = if full_scale > 0.0 { full_scale } else { 1.0 };
    Ok(Measured {
        reference: reference.clone(),
        frames,
        all: errors(&ours, &theirs, None, full_scale).map_err(failed)?,
        penumbra: errors(&ours, &theirs, Some(&penumbra), full_scale).map_err(failed)?,
        floor: variance.known.then(|| variance.root_mean_square() / full_scale),
    })
}

/// The brightest unshadowed irradiance over pixels and channels.
pub(crate) fn brightest(theatre: &Theatre, view: &View) -> f64 {
    let lamp = &theatre.lamp;
    let units: Vec<_> = lamp
        .emitters
        .iter()
        .map(|e| (e.radiance, UnitRows::new(&e.shape, lamp.position_m, &theatre.screen, view.size)))
        .collect();
    let dome = match theatre.ambient {
        Ambient::Dome { radiance } => radiance.map(|l| l * PI),
        _ => [0.0; 3],
    };
    let mut unit = vec![0.0; view.size[0]];
    let mut most = 0f64;
    for j in 0..view.size[1] {
        let mut sums = vec![dome; view.size[0]];
        for (radiance, rows) in &units {
            rows.row(j, &mut unit);
            for (sum, unit) in sums.iter_mut().zip(&unit) {
                (0..3).for_each(|c| sum[c] += radiance[c] * unit);
            }
        }
        most = sums.iter().flatten().copied().fold(most, f64::max);
    }
    most
}
