//! How sure a picture is: its error against a reference, and its own standard error.

use std::f64::consts::PI;

use kelir_vision::errors::{Errors, errors};
use serde::{Serialize, Serializer, ser::SerializeStruct};

use super::Drawing;
use crate::albedo::PixelAlbedo;
use crate::subject::{Staged, Subject};
use crate::{Frame, RenderError, Technique};

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
    pub(crate) fn add(&mut self, frame: &Frame, albedo: &PixelAlbedo, counted: &dyn Fn(usize, f64) -> bool) {
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
pub(crate) fn irradiance(frame: &Frame, albedo: &PixelAlbedo) -> Vec<f64> {
    let channel = |c: usize| {
        frame.radiance[c]
            .iter()
            .enumerate()
            .map(move |(k, l)| f64::from(*l) * PI / f64::from(albedo.at(c, k)))
    };
    (0..3).flat_map(channel).collect()
}

/// Draws `frames` of `drawing` in linear light, and the same with `reference`. `progress` takes how many are done.
pub(super) fn measure<S: Staged>(
    drawing: &mut Drawing<'_, S>,
    reference: &Technique,
    frames: Vec<usize>,
    progress: &mut dyn FnMut(usize),
) -> Result<Measured, RenderError> {
    let view = drawing.job.view;
    let mut truth = S::renderer(reference, drawing.job.backend)?;
    let mut comparison = Comparison::default();
    for (k, frame) in frames.iter().enumerate() {
        progress(k);
        let subject = drawing.subject(*frame);
        let theirs = truth.radiance(&subject, &view);
        let theirs = theirs.map_err(|e| e.of(drawing.job.scene.label(), reference.name()))?;
        let ours = drawing.radiance(*frame)?;
        comparison.full_scale = comparison.full_scale.max(subject.brightest(&view));
        comparison.add(&ours, &theirs, &subject.albedo(&view), &subject.penumbra(&view));
    }
    comparison.finish(reference, frames)
}

/// Irradiances of both sides, frame after frame, where both can be read.
#[derive(Default)]
struct Comparison {
    ours: Vec<f64>,
    theirs: Vec<f64>,
    penumbra: Vec<bool>,
    /// Of the reference, over penumbra.
    variance: Spread,
    full_scale: f64,
}

impl Comparison {
    fn add(&mut self, ours: &Frame, theirs: &Frame, albedo: &PixelAlbedo, marked: &[bool]) {
        let seen = irradiance(ours, albedo).into_iter().zip(irradiance(theirs, albedo));
        for (i, (a, b)) in seen.enumerate().filter(|(_, (a, b))| a.is_finite() && b.is_finite()) {
            self.ours.push(a);
            self.theirs.push(b);
            self.penumbra.push(marked[i % marked.len()]);
        }
        self.variance.add(theirs, albedo, &|k, _| marked[k]);
    }

    fn finish(self, reference: &Technique, frames: Vec<usize>) -> Result<Measured, RenderError> {
        let Self { ours, theirs, penumbra, variance, full_scale } = self;
        let failed =
            |e: kelir_vision::errors::ErrorsError| RenderError::Encode(format!("measured error: {e}"));
        let full_scale = if full_scale > 0.0 { full_scale } else { 1.0 };
        Ok(Measured {
            reference: reference.clone(),
            frames,
            all: errors(&ours, &theirs, None, full_scale).map_err(failed)?,
            penumbra: errors(&ours, &theirs, Some(&penumbra), full_scale).map_err(failed)?,
            floor: variance.known.then(|| variance.root_mean_square() / full_scale),
        })
    }
}
