//! A job under way: the one path from a scene to codes and to files, for studies and for the command line.

use kelir_scene::Scene;

use super::{Blob, Job, Output};
use crate::subject::{Staged, Subject};
use crate::{Frame, Meter, RenderError, Renderer, Stats, encode};

/// What may be shown as white: images are f32, which keeps seven digits of a shadow 1e-7 times as bright.
const WHITE: std::ops::RangeInclusive<f64> = 1e-30..=1e30;

/// A job being drawn, frame by frame; it keeps what it built between frames.
pub struct Drawing<'j, S: Staged = Scene> {
    pub(super) job: &'j mut Job<S>,
    renderer: Box<dyn Renderer<S::Subject>>,
    white: f64,
    codes: Vec<u32>,
    /// What `codes` show.
    last: Option<S::Subject>,
    kept: S::Kept,
}

/// A frame that was drawn.
#[derive(Debug, Default)]
pub struct Drawn {
    /// It shows what the one drawn before it shows, whose codes stand; nothing else was done.
    pub repeated: bool,
    /// What was done and skipped.
    pub stats: Stats,
    /// The image in linear light that the codes were made from: for the ground truth and for what a camera takes.
    pub linear: Option<Frame>,
}

impl<'j, S: Staged> Drawing<'j, S> {
    /// Opens the renderer and sets the exposure. Errors: as [`Job::check`]; an animation of a scene without a timeline, an impossible
    /// view, no adapter.
    pub fn open(job: &'j mut Job<S>) -> Result<Self, RenderError> {
        job.possible()?;
        let renderer = S::renderer(&job.technique, job.backend)?;
        let white = job.scene.white(job.exposure, &job.view, job.time_s);
        if !WHITE.contains(&white) {
            return Err(RenderError::View(format!(
                "{}: what would be shown as white has a radiance of {white:e}; images can hold from {:e} to {:e}: give the lamp, or \
                 exposure.white, a radiance nearer to 1",
                job.scene.label(),
                WHITE.start(),
                WHITE.end()
            )));
        }
        let codes = vec![0; job.view.size[0] * job.view.size[1]];
        Ok(Self { job, renderer, white, codes, last: None, kept: S::Kept::default() })
    }

    /// The radiance shown as white.
    pub fn white(&self) -> f64 {
        self.white
    }

    /// What draws it, as [`Renderer::adapter`] has it.
    pub fn adapter(&self) -> String {
        self.renderer.adapter()
    }

    /// `cpu` or `gpu:ADAPTER/DRIVER`, as in the job's key.
    pub fn class(&self) -> String {
        self.renderer.class()
    }

    /// Counts the rows of what is drawn from now on.
    pub fn watch(&mut self, meter: &Meter) {
        self.renderer.watch(meter);
    }

    /// What frame `index` shows.
    pub(super) fn subject(&mut self, index: usize) -> S::Subject {
        let Job { scene, output, time_s, .. } = &*self.job;
        match (output, scene.timeline(), time_s) {
            (Output::Animation, Some(timeline), _) => scene.at(timeline.frame_time_s(index), &mut self.kept),
            (_, _, Some(time_s)) => scene.at(*time_s, &mut self.kept),
            _ => scene.still(),
        }
    }

    /// Draws frame `index`, 0 for a still. Errors: what the technique can't draw.
    pub fn frame(&mut self, index: usize) -> Result<Drawn, RenderError> {
        let subject = self.subject(index);
        if self.last.as_ref().is_some_and(|last| last.same_staging(&subject)) {
            return Ok(Drawn { repeated: true, ..Drawn::default() });
        }
        self.last = None;
        let (view, camera) = (self.job.view, self.job.camera);
        let (label, technique) = (self.job.scene.label(), self.job.technique.name());
        // Display codes alone would not say how sure the ground truth is of them.
        let drawn = if camera.is_some() || self.job.technique.is_truth() {
            let mut frame = self.renderer.radiance(&subject, &view).map_err(|e| e.of(label, technique))?;
            self.codes = match camera {
                Some(camera) => camera.expose(&frame, self.white)?,
                None => encode::display(&frame, self.white),
            };
            Drawn { stats: std::mem::take(&mut frame.stats), linear: Some(frame), repeated: false }
        } else {
            let stats = self.renderer.display(&subject, &view, self.white, &mut self.codes);
            let stats = stats.map_err(|e| e.of(label, technique))?;
            Drawn { stats, ..Drawn::default() }
        };
        self.last = Some(subject);
        Ok(drawn)
    }

    /// Display codes `0xFFBBGGRR` of the last frame drawn, row-major, first row on top; zeros before the first.
    pub fn codes(&self) -> &[u32] {
        &self.codes
    }

    /// What the last frame drawn shows.
    pub(super) fn shown(&self) -> Option<&S::Subject> {
        self.last.as_ref()
    }

    /// The last frame drawn as a file: a PNG, or what its camera writes.
    pub fn file(&self) -> Result<Blob, RenderError> {
        let size = self.job.view.size;
        match &self.job.camera {
            Some(camera) => camera.file(&self.codes, size).map(|p| Blob::new(p.media_type, p.bytes)),
            None => Ok(Blob::new("image/png", encode::png(&self.codes, size)?)),
        }
    }

    /// Frame `index` in linear light, with all layers; before any camera.
    pub fn radiance(&mut self, index: usize) -> Result<Frame, RenderError> {
        let subject = self.subject(index);
        let frame = self.renderer.radiance(&subject, &self.job.view);
        frame.map_err(|e| e.of(self.job.scene.label(), self.job.technique.name()))
    }
}
