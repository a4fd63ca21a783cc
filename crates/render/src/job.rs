//! The door to the renderer: a job with a scene, a technique and an output in, a stimulus out.
//!
//! What a participant sees is bytes with a hash. The same job gives the same bytes each time on the same backend, and has a [key](Job::key)
//! by which they are found again. The command line draws through the same [`Drawing`], so that it shows what a study shows.

mod drawing;
mod key;
mod measure;
mod rehearsal;

use std::collections::BTreeMap;

use kelir_scene::Scene;
use serde::Serialize;
use sha2::{Digest, Sha256};

use crate::camera::Camera;
use crate::exposure::Rule;
use crate::subject::check_view;
pub use crate::subject::{Staged, Subject};
use crate::{Backend, Pixel, RenderError, Technique, View};

pub use drawing::{Drawing, Drawn};
use measure::measure;
pub use measure::{Measured, StandardError};
pub(crate) use measure::{Spread, irradiance, named};
pub use rehearsal::rehearse;

/// Media type of an animation's manifest.
pub const ANIMATION: &str = "application/vnd.kelir.animation+json";

/// What is asked for. `scene` may be left unread (a [`Job<String>`] of its path, say): checks and keys need no more than its hash.
#[derive(Clone, Debug)]
pub struct Job<S = Scene> {
    /// What is drawn.
    pub scene: S,
    /// What draws it.
    pub technique: Technique,
    /// Size and pixel rule.
    pub view: View,
    /// Where it is drawn.
    pub backend: Backend,
    /// A camera between the image and its viewer.
    pub camera: Option<Camera>,
    /// The instant of the timeline that a still shows, seconds; absent: the scene as written.
    pub time_s: Option<f64>,
    /// What is shown as white; [`Output::exposure`] unless something else is wanted.
    pub exposure: Rule,
    /// One image or all frames.
    pub output: Output,
    /// What the image is measured against; its error goes into the provenance.
    pub reference: Option<Technique>,
}

impl<S> Job<S> {
    /// The same job of another scene, such as one that has been read by now.
    pub fn with_scene<T>(self, scene: T) -> Job<T> {
        let Self { scene: _, technique, view, backend, camera, time_s, exposure, output, reference } = self;
        Job { scene, technique, view, backend, camera, time_s, exposure, output, reference }
    }

    /// Errors: a knob, a camera's setting or an instant out of its range; an animation of one instant.
    pub fn check(&self) -> Result<(), RenderError> {
        self.technique.check()?;
        self.reference.as_ref().map_or(Ok(()), Technique::check)?;
        self.camera.map_or(Ok(()), |camera| camera.check())?;
        match self.time_s {
            Some(time_s) if !time_s.is_finite() => {
                Err(RenderError::View(format!("time = {time_s}: a number of seconds")))
            }
            Some(time_s) if self.output == Output::Animation => Err(RenderError::View(format!(
                "time = {time_s}: a still has an instant, an animation has all"
            ))),
            _ => Ok(()),
        }
    }
}

impl<S: Staged> Job<S> {
    /// How many frames are asked for, once nothing is known that keeps them from being drawn: neither time nor memory is spent on that.
    ///
    /// Errors: as [`Job::check`]; an animation or an instant of a scene without a timeline; an impossible view.
    fn possible(&self) -> Result<usize, RenderError> {
        self.check()?;
        check_view(&self.scene.still(), &self.view)?;
        self.frames()
    }

    /// How many frames are asked for. Errors: an animation or an instant of a scene without a timeline.
    fn frames(&self) -> Result<usize, RenderError> {
        match (self.output, self.scene.timeline()) {
            (Output::Still, None) if self.time_s.is_some() => Err(RenderError::View(format!(
                "time = {}: the scene has no [timeline] and stands still; leave the time out",
                self.time_s.unwrap_or_default()
            ))),
            (Output::Still, _) => Ok(1),
            (Output::Animation, Some(timeline)) => Ok(timeline.frame_count()),
            (Output::Animation, None) => Err(RenderError::View(
                "timeline is missing: only a scene with a [timeline] can be animated".into(),
            )),
        }
    }
}

/// Which images of the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Output {
    /// One image.
    Still,
    /// Every frame of its timeline.
    Animation,
}

impl Output {
    /// The exposure of each where nothing else is asked for: a still for itself, an animation for its whole timeline.
    pub fn exposure(self) -> Rule {
        match self {
            Self::Still => Rule::Still,
            Self::Animation => Rule::Timeline,
        }
    }
}

/// How far a job is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress<'a> {
    /// Steps done.
    pub done: usize,
    /// Steps in all.
    pub total: usize,
    /// What is done next.
    pub what: &'a str,
}

/// One file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Blob {
    /// Media type.
    pub media_type: String,
    /// Content.
    pub bytes: Vec<u8>,
    /// SHA-256 of the content, hexadecimal.
    pub sha256: String,
}

impl Blob {
    fn new(media_type: &str, bytes: Vec<u8>) -> Self {
        let sha256 = hex::encode(Sha256::digest(&bytes));
        Self { media_type: media_type.into(), bytes, sha256 }
    }
}

/// What a participant is shown, and where it came from.
#[derive(Clone, Debug)]
pub struct Stimulus {
    /// Media type of `bytes`.
    pub media_type: String,
    /// The image, or an animation's manifest.
    pub bytes: Vec<u8>,
    /// SHA-256 of `bytes`, hexadecimal.
    pub sha256: String,
    /// The frames that the manifest names, each once, in order of first use.
    pub attachments: Vec<Blob>,
    /// How it was made.
    pub provenance: Provenance,
}

/// How a stimulus was made.
#[derive(Clone, Debug, Serialize)]
pub struct Provenance {
    /// Hash of the scene's values and files.
    pub scene_sha256: String,
    /// Technique and knobs, seed among them where it has one.
    #[serde(flatten)]
    pub technique: Technique,
    /// The technique's revision.
    pub revision: u32,
    /// The revision of what techniques share.
    pub shared_revision: u32,
    /// kelir's version.
    pub version: &'static str,
    /// Where it was drawn, as in the job's key: `cpu` or `gpu:ADAPTER/DRIVER`.
    pub backend: String,
    /// What drew it.
    pub adapter: String,
    /// The instant shown, seconds; absent: the scene as written, or all frames.
    pub time_s: Option<f64>,
    /// What white is the brightest of.
    pub exposure: Rule,
    /// The radiance shown as white.
    pub white: f64,
    /// Pixels [width, height].
    pub size: [usize; 2],
    /// Pixel rule.
    pub pixel: Pixel,
    /// Still or animation.
    pub output: Output,
    /// The camera, where there is one.
    pub camera: Option<Camera>,
    /// Error against the reference, where there is one, before the camera.
    pub error: Option<Measured>,
    /// The image's own standard error before the camera, where the technique has one.
    pub standard_error: Option<StandardError>,
    /// What was done and skipped, summed over frames.
    pub counts: BTreeMap<String, u64>,
}

/// An animation's manifest, as it is written.
#[derive(Serialize)]
struct Manifest<'a> {
    fps: f64,
    #[serde(rename = "loop")]
    repeat: bool,
    width: usize,
    height: usize,
    frames: &'a [String],
}

/// Draws the job. `progress` is called before each step and once at the end.
///
/// Errors: a scene that the technique can't draw, an impossible view, knobs out of range, no adapter; an animation of a scene
/// without a timeline.
pub fn run<S: Staged>(job: &mut Job<S>, progress: &mut dyn FnMut(Progress)) -> Result<Stimulus, RenderError> {
    let frames = job.possible()?;
    let compared = match (&job.reference, job.output) {
        (None, _) => Vec::new(),
        (_, Output::Still) => vec![0],
        // One frame costs the reference what the whole animation costs the technique; two say whether motion matters.
        (_, Output::Animation) if frames < 2 => vec![0],
        (_, Output::Animation) => vec![0, frames / 2],
    };
    let total = frames + compared.len() + 1;
    progress(Progress { done: 0, total, what: "exposure" });
    let (technique, reference, view) = (job.technique.clone(), job.reference.clone(), job.view);
    let mut drawing = Drawing::open(job)?;
    let mut blobs: Vec<Blob> = Vec::new();
    let mut shown: Vec<String> = Vec::with_capacity(frames);
    let mut counts = BTreeMap::new();
    let (mut spread, mut full_scale) = (Spread::default(), 0f64);
    for frame in 0..frames {
        progress(Progress { done: frame + 1, total, what: technique.name() });
        let Drawn { repeated, stats, linear } = drawing.frame(frame)?;
        if repeated {
            shown.extend(shown.last().cloned());
            *counts.entry("frames_repeated".into()).or_insert(0) += 1;
            continue;
        }
        if let (Some(linear), Some(subject)) = (&linear, drawing.shown()) {
            spread.add(linear, &subject.albedo(&view), &|_, se| se > 0.0);
            full_scale = full_scale.max(subject.brightest(&view));
        }
        for (name, count) in stats.counts {
            *counts.entry(name).or_insert(0) += count;
        }
        let blob = drawing.file()?;
        shown.push(blob.sha256.clone());
        if blobs.iter().all(|b| b.sha256 != blob.sha256) {
            blobs.push(blob);
        }
    }
    let error = match &reference {
        None => None,
        Some(reference) => Some(measure(&mut drawing, reference, compared, &mut |k| {
            progress(Progress { done: frames + 1 + k, total, what: reference.name() });
        })?),
    };
    let (backend, adapter, white) = (drawing.class(), drawing.adapter(), drawing.white());
    let provenance = Provenance {
        scene_sha256: job.scene.sha256().into(),
        revision: technique.revision(),
        shared_revision: crate::REVISION,
        technique,
        version: env!("CARGO_PKG_VERSION"),
        backend,
        adapter,
        time_s: job.time_s,
        exposure: job.exposure,
        white,
        size: view.size,
        pixel: view.pixel,
        output: job.output,
        camera: job.camera,
        error,
        standard_error: spread.in_units_of(if full_scale > 0.0 { full_scale } else { 1.0 }),
        counts,
    };
    progress(Progress { done: total, total, what: "done" });
    let stimulus = match (job.output, job.scene.timeline()) {
        (Output::Animation, Some(timeline)) => {
            let [width, height] = view.size;
            let manifest =
                Manifest { fps: timeline.fps, repeat: timeline.repeat, width, height, frames: &shown };
            let bytes =
                serde_json::to_vec(&manifest).map_err(|e| RenderError::Encode(format!("manifest: {e}")))?;
            (Blob::new(ANIMATION, bytes), blobs)
        }
        _ => (blobs.swap_remove(0), Vec::new()),
    };
    let (Blob { media_type, bytes, sha256 }, attachments) = stimulus;
    Ok(Stimulus { media_type, bytes, sha256, attachments, provenance })
}

#[cfg(test)]
mod tests;
