//! A job tried in a small size: what would keep it from being drawn is found within moments.

use super::{Drawing, Job, measure};
use crate::RenderError;
use crate::subject::{Staged, Subject};

/// Pixels of width that are drawn.
const WIDTH: usize = 64;
/// Samples a pixel.
const SPP: u32 = 16;
/// The most frames that are drawn of a film.
const FRAMES: usize = 48;

/// Draws a job by the path of [`super::run`], with camera, file and reference, but small and with few samples; of a film the first frame, the
/// last, and others evenly between. The scene comes back for the next job.
///
/// Errors: as [`super::run`].
pub fn rehearse<S: Staged>(mut job: Job<S>) -> (S, Result<(), RenderError>) {
    let drawn = job.possible().and_then(|frames| {
        shrink(&mut job);
        draw(&mut job, frames)
    });
    (job.scene, drawn)
}

fn shrink<S: Staged>(job: &mut Job<S>) {
    let [across, down] = job.scene.still().sides();
    let width = WIDTH.min(job.view.size[0]);
    let height = (width as f64 * down / across).round().max(1.0);
    job.view.size = [width, height as usize];
    for technique in std::iter::once(&mut job.technique).chain(&mut job.reference) {
        technique.sample_at_most(SPP);
    }
}

fn draw<S: Staged>(job: &mut Job<S>, frames: usize) -> Result<(), RenderError> {
    let reference = job.reference.clone();
    let mut drawing = Drawing::open(job)?;
    let drawn = frames.min(FRAMES);
    for k in 0..drawn {
        drawing.frame(if drawn < 2 { 0 } else { k * (frames - 1) / (drawn - 1) })?;
        drawing.file()?;
    }
    match reference {
        None => Ok(()),
        Some(reference) => measure(&mut drawing, &reference, vec![0], &mut |_| {}).map(drop),
    }
}
