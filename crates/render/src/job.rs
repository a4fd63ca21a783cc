//! The door to the renderer: a job with a scene, a technique and an output in, a stimulus out.
//!
//! What a participant sees is bytes with a hash. The same job gives the same bytes each time on the same backend.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use kelir_scene::{Ambient, Scene, Theatre};
use kelir_vision::errors::{Errors, errors};
use serde::{Serialize, Serializer, ser::SerializeStruct};
use sha2::{Digest, Sha256};

use crate::camera::Camera;
use crate::irradiance::UnitRows;
use crate::{
    Backend, Frame, Pixel, RenderError, Renderer, Stats, Technique, View, albedo, encode, exposure, penumbra,
    renderer,
};

/// Media type of an animation's manifest.
pub const ANIMATION: &str = "application/vnd.kelir.animation+json";

/// What is asked for.
#[derive(Debug)]
pub struct Job {
    /// What is drawn.
    pub scene: Scene,
    /// What draws it.
    pub technique: Technique,
    /// Size and pixel rule.
    pub view: View,
    /// Where it is drawn.
    pub backend: Backend,
    /// A camera between the image and its viewer.
    pub camera: Option<Camera>,
    /// One image or all frames.
    pub output: Output,
    /// What the image is measured against; its error goes into the provenance.
    pub reference: Option<Technique>,
}

/// Which images of the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Output {
    /// The scene as written.
    Still,
    /// Every frame of its timeline.
    Animation,
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
        let sha256 = hex(&Sha256::digest(&bytes));
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
    /// kelir's version.
    pub version: &'static str,
    /// Where it was drawn.
    pub backend: Backend,
    /// What drew it.
    pub adapter: String,
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

/// Monte Carlo's own standard error of the irradiance, in units of the brightest unshadowed point.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct StandardError {
    /// Root mean square over the sampled pixels and channels of all frames; elsewhere it is exactly 0.
    pub rms_sampled: f64,
    /// The largest.
    pub max: f64,
}

/// Sums of the standard errors in a frame's SE layers.
#[derive(Default)]
pub(crate) struct Spread {
    squares: f64,
    count: usize,
    max: f64,
    /// Whether there were SE layers at all.
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
        for (c, name) in ["SE.R", "SE.G", "SE.B"].iter().enumerate() {
            let Some(layer) = frame.layers.iter().find(|l| l.name == *name) else { continue };
            self.known = true;
            for (k, se) in layer.values.iter().enumerate() {
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

    fn known(self, full_scale: f64) -> Option<StandardError> {
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

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|b| format!("{b:02x}")).collect()
}

/// Draws the job. `progress` is called before each step and once at the end.
///
/// Errors: a scene that the technique can't draw, an impossible view, knobs out of range, no adapter; an animation of a scene
/// without a timeline.
pub fn run(job: &mut Job, progress: &mut dyn FnMut(Progress)) -> Result<Stimulus, RenderError> {
    if let Some(camera) = &job.camera {
        camera.check()?;
    }
    let frames = match (job.output, job.scene.timeline()) {
        (Output::Still, _) => 1,
        (Output::Animation, Some(timeline)) => timeline.frame_count(),
        (Output::Animation, None) => {
            return Err(RenderError::View(
                "timeline is missing: only a scene with a [timeline] can be animated".into(),
            ));
        }
    };
    let compared = match (&job.reference, job.output) {
        (None, _) => Vec::new(),
        (_, Output::Still) => vec![0],
        // One frame costs the reference what the whole animation costs the technique; two say whether motion matters.
        (_, Output::Animation) if frames < 2 => vec![0],
        (_, Output::Animation) => vec![0, frames / 2],
    };
    let total = frames + compared.len() + 1;
    progress(Progress { done: 0, total, what: "exposure" });
    let white = exposure::of_scene(&job.scene, &job.view, job.output == Output::Animation);
    let mut drawing = renderer(&job.technique, job.backend)?;
    let mut blobs: Vec<Blob> = Vec::new();
    let mut shown: Vec<String> = Vec::with_capacity(frames);
    let mut counts = BTreeMap::new();
    let mut last: Option<Theatre> = None;
    let (mut spread, mut full_scale) = (Spread::default(), 0f64);
    for frame in 0..frames {
        progress(Progress { done: frame + 1, total, what: job.technique.name() });
        let theatre = theatre(job, frame);
        if last.as_ref().is_some_and(|last| last.same_staging(&theatre))
            && let Some(repeated) = shown.last().cloned()
        {
            shown.push(repeated);
            *counts.entry("frames_repeated".into()).or_insert(0) += 1;
            continue;
        }
        let (blob, stats) = draw(job, drawing.as_mut(), &theatre, white, &mut spread)?;
        if spread.known {
            full_scale = full_scale.max(brightest(&theatre, &job.view));
        }
        for (name, count) in stats.counts {
            *counts.entry(name).or_insert(0) += count;
        }
        shown.push(blob.sha256.clone());
        if blobs.iter().all(|b| b.sha256 != blob.sha256) {
            blobs.push(blob);
        }
        last = Some(theatre);
    }
    let error = match job.reference.clone() {
        None => None,
        Some(reference) => Some(measure(job, drawing.as_mut(), &reference, compared, &mut |k| {
            progress(Progress { done: frames + 1 + k, total, what: reference.name() });
        })?),
    };
    let provenance = Provenance {
        scene_sha256: job.scene.sha256().into(),
        technique: job.technique.clone(),
        version: env!("CARGO_PKG_VERSION"),
        backend: job.backend,
        adapter: drawing.adapter(),
        white,
        size: job.view.size,
        pixel: job.view.pixel,
        output: job.output,
        camera: job.camera,
        error,
        standard_error: spread.known(if full_scale > 0.0 { full_scale } else { 1.0 }),
        counts,
    };
    progress(Progress { done: total, total, what: "done" });
    let stimulus = match (job.output, job.scene.timeline()) {
        (Output::Animation, Some(timeline)) => {
            let [width, height] = job.view.size;
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

fn theatre(job: &mut Job, frame: usize) -> Theatre {
    match (job.output, job.scene.timeline()) {
        (Output::Animation, Some(timeline)) => {
            let time_s = timeline.frame_time_s(frame);
            job.scene.theatre_at(time_s)
        }
        _ => job.scene.still(),
    }
}

fn draw(
    job: &Job,
    drawing: &mut dyn Renderer,
    theatre: &Theatre,
    white: f64,
    spread: &mut Spread,
) -> Result<(Blob, Stats), RenderError> {
    let view = &job.view;
    crate::pa::check_view(theatre, view)?;
    // Display codes alone would not say how sure Monte Carlo is of them.
    if job.camera.is_some() || matches!(job.technique, Technique::Mc(_)) {
        let frame = drawing.radiance(theatre, view)?;
        spread.add(&frame, &albedo::on_grid(&theatre.screen, view), |_, se| se > 0.0);
        let blob = match &job.camera {
            Some(camera) => {
                let photograph = camera.photograph(&frame, white)?;
                Blob::new(photograph.media_type, photograph.bytes)
            }
            None => Blob::new("image/png", encode::png(&encode::display(&frame, white), view.size)?),
        };
        return Ok((blob, frame.stats));
    }
    let mut codes = vec![0; view.size[0] * view.size[1]];
    let stats = drawing.display(theatre, view, white, &mut codes)?;
    Ok((Blob::new("image/png", encode::png(&codes, view.size)?), stats))
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

fn measure(
    job: &mut Job,
    drawing: &mut dyn Renderer,
    reference: &Technique,
    frames: Vec<usize>,
    progress: &mut dyn FnMut(usize),
) -> Result<Measured, RenderError> {
    let mut truth = renderer(reference, job.backend)?;
    let (mut ours, mut theirs, mut penumbra) = (Vec::new(), Vec::new(), Vec::new());
    let mut variance = Spread::default();
    let mut full_scale = 0f64;
    for (k, frame) in frames.iter().enumerate() {
        progress(k);
        let theatre = theatre(job, *frame);
        full_scale = full_scale.max(brightest(&theatre, &job.view));
        let albedo = albedo::on_grid(&theatre.screen, &job.view);
        let (a, b) = (drawing.radiance(&theatre, &job.view)?, truth.radiance(&theatre, &job.view)?);
        let marked = penumbra::mask(&theatre, &job.view);
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

#[cfg(test)]
mod tests;
