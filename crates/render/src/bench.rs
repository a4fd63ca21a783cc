//! How many frames a second, beside how long it takes to fill such a frame with a constant.

use std::time::Instant;

use kelir_scene::{Masks, Scene, Theatre};
use kelir_theatre::kernels;
use rayon::prelude::*;
use serde::Serialize;

use crate::exposure::Rule;
use crate::subject::Staged;
use crate::{Backend, RenderError, Renderer, Technique, View, renderer};

mod savings;
mod scaling;

pub use savings::{Saving, savings};
pub use scaling::{Scaled, scaling};

/// What changes from frame to frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Case {
    /// Every puppet moves sideways.
    Slid,
    /// The scene's timeline runs: puppets are posed, rasterised and summed anew.
    Posed,
    /// The lamp moves.
    LampMoved,
    /// As slid, but with nothing skipped.
    NothingSkipped,
}

impl Case {
    /// Each of them.
    pub const ALL: [Self; 4] = [Self::Slid, Self::Posed, Self::LampMoved, Self::NothingSkipped];
}

/// Times of one case.
#[derive(Clone, Debug, Serialize)]
pub struct CaseReport {
    /// What changed from frame to frame.
    pub case: Case,
    /// Frames a second over the whole run.
    pub fps: f64,
    /// Least time of a frame, ms: what is left of it on a busy machine.
    pub least_ms: f64,
    /// Median of a frame, ms.
    pub median_ms: f64,
    /// 99th percentile of a frame, ms.
    pub p99_ms: f64,
    /// Median of filling a frame with a constant in the same run, ms.
    pub floor_ms: f64,
    /// `median_ms / floor_ms`.
    pub ratio: f64,
    /// Median of each step, ms; `scene` is the theatre itself (raster and pose).
    pub steps_ms: Vec<(String, f64)>,
    /// The step that takes most of a frame, and its share.
    pub bound: String,
    /// Counts of the last frame.
    pub counts: std::collections::BTreeMap<String, u64>,
}

/// A run of [`frames`].
#[derive(Clone, Debug, Serialize)]
pub struct FramesReport {
    /// Pixels [width, height].
    pub size: [usize; 2],
    /// Frames a case.
    pub frames: usize,
    /// Threads that drew.
    pub threads: usize,
    /// What drew.
    pub adapter: String,
    /// One a case.
    pub cases: Vec<CaseReport>,
}

fn quantile(sorted: &[f64], q: f64) -> f64 {
    sorted[((sorted.len() - 1) as f64 * q).round() as usize]
}

fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    quantile(values, 0.5)
}

/// Draws `frames` display frames of each case without writing a file. [`Case::Posed`] needs a timeline and is left out of scenes without
/// one. The first frames of a case are not timed. Errors: as drawing.
pub fn frames(
    scene: &Scene,
    technique: &Technique,
    backend: Backend,
    view: &View,
    frames: usize,
    cases: &[Case],
) -> Result<FramesReport, RenderError> {
    let mut drawing = renderer(technique, backend)?;
    let white = scene.white(Rule::Still, view, None);
    let (still, mut masks) = (scene.still(), Masks::default());
    let mut report = FramesReport {
        size: view.size,
        frames,
        threads: rayon::current_num_threads(),
        adapter: drawing.adapter(),
        cases: Vec::new(),
    };
    for case in cases {
        if *case == Case::Posed && scene.timeline().is_none() {
            continue;
        }
        let view = View { skip: *case != Case::NothingSkipped && view.skip, ..*view };
        let timed = timed(drawing.as_mut(), &view, white, frames, |k| {
            staged(scene, &mut masks, &still, *case, k, frames)
        })?;
        report.cases.push(CaseReport {
            case: *case,
            fps: 1e3 * timed.times.len() as f64 / timed.times.iter().sum::<f64>(),
            least_ms: timed.times[0],
            median_ms: quantile(&timed.times, 0.5),
            p99_ms: quantile(&timed.times, 0.99),
            floor_ms: timed.floor_ms,
            ratio: quantile(&timed.times, 0.5) / timed.floor_ms,
            bound: bound(&timed.steps_ms),
            steps_ms: timed.steps_ms,
            counts: timed.counts,
        });
    }
    Ok(report)
}

/// Times of a run of frames.
struct Timed {
    /// Of whole frames, ms, sorted.
    times: Vec<f64>,
    floor_ms: f64,
    steps_ms: Vec<(String, f64)>,
    counts: std::collections::BTreeMap<String, u64>,
}

/// Draws frame after frame of what `theatre` makes; the first three are not timed.
fn timed(
    drawing: &mut dyn Renderer<Theatre>,
    view: &View,
    white: f64,
    frames: usize,
    mut theatre: impl FnMut(usize) -> Theatre,
) -> Result<Timed, RenderError> {
    const WARM: usize = 3;
    let mut out = vec![0u32; view.size[0] * view.size[1]];
    let (mut times, mut floors) = (Vec::with_capacity(frames), Vec::with_capacity(frames));
    let mut steps: Vec<(String, Vec<f64>)> = vec![("scene".into(), Vec::new())];
    let mut counts = Default::default();
    for k in 0..frames.max(1) + WARM {
        let clock = Instant::now();
        fill(&mut out, 0xff80_8080);
        let floor = clock.elapsed().as_secs_f64() * 1e3;
        let clock = Instant::now();
        let theatre = theatre(k);
        let staging = clock.elapsed().as_secs_f64() * 1e3;
        let stats = drawing.display(&theatre, view, white, &mut out)?;
        let time = clock.elapsed().as_secs_f64() * 1e3;
        if k < WARM {
            continue;
        }
        times.push(time);
        floors.push(floor);
        steps[0].1.push(staging);
        for (name, ms) in stats.steps_ms {
            match steps.iter_mut().find(|(n, _)| *n == name) {
                Some((_, all)) => all.push(ms),
                None => steps.push((name, vec![ms])),
            }
        }
        counts = stats.counts;
    }
    times.sort_by(f64::total_cmp);
    let steps_ms = steps.into_iter().map(|(name, mut all)| (name, median(&mut all))).collect();
    Ok(Timed { times, floor_ms: median(&mut floors), steps_ms, counts })
}

/// In words, the step that takes most of a frame.
fn bound(steps_ms: &[(String, f64)]) -> String {
    let all: f64 = steps_ms.iter().map(|(_, ms)| ms).sum();
    let Some((name, ms)) = steps_ms.iter().max_by(|a, b| a.1.total_cmp(&b.1)) else { return String::new() };
    let what = match name.as_str() {
        "scene" => "posing and rasterising",
        "plan" => "where boxes lie",
        "tables" => "summing tables",
        "background" => "E⁰ and codes of the lit screen",
        "dome" => "the dome's convolution",
        "pixels" => "look-ups and codes of pixels",
        "prepare" => "masks and E⁰",
        "pilot" | "sample" => "samples",
        other => other,
    };
    format!("{what} ({:.0} %)", 100.0 * ms / all)
}

/// Least times, ms, over `runs`: building the u32 table of `side`² 8-bit texels, and a plain widening copy of them u8 → u32 on as many
/// threads.
pub fn table(side: usize, runs: usize) -> [f64; 2] {
    let mut kernels = [kernels::table(side, 8), kernels::copy(side)];
    let mut least = [f64::INFINITY; 2];
    for _ in 0..runs.max(1) {
        for (least, kernel) in least.iter_mut().zip(&mut kernels) {
            let clock = Instant::now();
            kernel.run();
            *least = least.min(clock.elapsed().as_secs_f64() * 1e3);
        }
    }
    least
}

/// Fills a frame with a constant on all threads: what the memory alone costs.
pub fn fill(out: &mut [u32], value: u32) {
    let part = out.len().div_ceil(rayon::current_num_threads()).max(1);
    out.par_chunks_mut(part).for_each(|part| part.fill(value));
}

fn staged(scene: &Scene, masks: &mut Masks, still: &Theatre, case: Case, k: usize, frames: usize) -> Theatre {
    let phase = k as f64 / frames.max(1) as f64;
    match case {
        Case::Posed => {
            let seconds = scene.timeline().map_or(1.0, |t| t.seconds);
            // Times that the timeline's own frames don't hit, so that no mask is remembered.
            scene.theatre_at(seconds * ((k as f64 + 0.37) / (frames + 3) as f64), masks)
        }
        Case::LampMoved => {
            let mut theatre = still.clone();
            theatre.lamp.position_m.x += 0.1 * (std::f64::consts::TAU * phase).sin();
            theatre
        }
        Case::Slid | Case::NothingSkipped => slid(still, phase),
    }
}

/// The theatre with its puppets moved sideways, once around for `phase` from 0 to 1.
fn slid(still: &Theatre, phase: f64) -> Theatre {
    let mut theatre = still.clone();
    let turn = std::f64::consts::TAU * phase;
    for plane in &mut theatre.planes {
        plane.centre_m.x += 0.05 * theatre.screen.width_m * turn.sin();
        plane.centre_m.y += 0.02 * theatre.screen.height_m * (2.0 * turn).sin();
    }
    theatre
}
