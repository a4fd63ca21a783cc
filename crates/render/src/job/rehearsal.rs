//! A job tried in a small size: what would keep it from being drawn is found within moments.

use kelir_scene::Scene;

use super::{Drawing, Job, measure};
use crate::RenderError;

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
pub fn rehearse(mut job: Job) -> (Scene, Result<(), RenderError>) {
    let drawn = possible(&job).and_then(|frames| {
        shrink(&mut job);
        draw(&mut job, frames)
    });
    (job.scene, drawn)
}

/// How many frames the job has, if its settings and its view at full size are possible.
fn possible(job: &Job) -> Result<usize, RenderError> {
    job.check()?;
    job.view.check(&job.scene.still())?;
    job.frames()
}

fn shrink(job: &mut Job) {
    let screen = job.scene.still().screen;
    let width = WIDTH.min(job.view.size[0]);
    let height = (width as f64 * screen.height_m / screen.width_m).round().max(1.0);
    job.view.size = [width, height as usize];
    for technique in std::iter::once(&mut job.technique).chain(&mut job.reference) {
        technique.sample_at_most(SPP);
    }
}

fn draw(job: &mut Job, frames: usize) -> Result<(), RenderError> {
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
