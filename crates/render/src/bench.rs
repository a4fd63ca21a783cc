//! How many frames a second, beside how long it takes to fill such a frame with a constant.

use std::time::Instant;

use kelir_scene::{Scene, Theatre};
use rayon::prelude::*;
use serde::Serialize;

use crate::{Backend, RenderError, Technique, View, exposure, renderer};

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
    scene: &mut Scene,
    technique: &Technique,
    backend: Backend,
    view: &View,
    frames: usize,
    cases: &[Case],
) -> Result<FramesReport, RenderError> {
    let mut drawing = renderer(technique, backend)?;
    let white = exposure::of_scene(scene, view, false);
    let still = scene.still();
    let mut report = FramesReport {
        size: view.size,
        frames,
        threads: rayon::current_num_threads(),
        adapter: drawing.adapter(),
        cases: Vec::new(),
    };
    let mut out = vec![0u32; view.size[0] * view.size[1]];
    for case in cases {
        if *case == Case::Posed && scene.timeline().is_none() {
            continue;
        }
        let view = View { skip: *case != Case::NothingSkipped && view.skip, ..*view };
        let warm = 3;
        let (mut times, mut floors) = (Vec::with_capacity(frames), Vec::with_capacity(frames));
        let mut steps: Vec<(String, Vec<f64>)> = vec![("scene".into(), Vec::new())];
        let mut counts = Default::default();
        for k in 0..frames + warm {
            let clock = Instant::now();
            fill(&mut out, 0xff80_8080);
            let floor = clock.elapsed().as_secs_f64() * 1e3;
            let clock = Instant::now();
            let theatre = staged(scene, &still, *case, k, frames);
            let staging = clock.elapsed().as_secs_f64() * 1e3;
            let stats = drawing.display(&theatre, &view, white, &mut out)?;
            let time = clock.elapsed().as_secs_f64() * 1e3;
            if k < warm {
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
        let fps = 1e3 * times.len() as f64 / times.iter().sum::<f64>();
        times.sort_by(f64::total_cmp);
        let (median_ms, floor_ms) = (quantile(&times, 0.5), median(&mut floors));
        report.cases.push(CaseReport {
            case: *case,
            fps,
            least_ms: times[0],
            median_ms,
            p99_ms: quantile(&times, 0.99),
            floor_ms,
            ratio: median_ms / floor_ms,
            steps_ms: steps.into_iter().map(|(name, mut all)| (name, median(&mut all))).collect(),
            counts,
        });
    }
    Ok(report)
}

/// Least times, ms, over `runs`: building the u32 table of `side`² 8-bit texels, and a plain widening copy of them u8 → u32 on as many
/// threads.
pub fn table(side: usize, runs: usize) -> [f64; 2] {
    use kelir_scene::{Mask, Texels};
    let texels: Vec<u8> = (0..side * side).map(|k| (k.wrapping_mul(2_654_435_761) >> 13) as u8).collect();
    let mut copy = vec![0u32; side * side];
    let mask = Mask::new(side, side, 1, Texels::U8(texels.clone()));
    let mut spare = None;
    let mut least = [f64::INFINITY; 2];
    for _ in 0..runs.max(1) {
        let clock = Instant::now();
        spare = Some(crate::pa::table::Table::new(&mask, 0, false, spare.take()));
        least[0] = least[0].min(clock.elapsed().as_secs_f64() * 1e3);
        let clock = Instant::now();
        let part = copy.len().div_ceil(rayon::current_num_threads());
        copy.par_chunks_mut(part).zip(texels.par_chunks(part)).for_each(|(to, from)| {
            to.iter_mut().zip(from).for_each(|(to, from)| *to = u32::from(*from));
        });
        std::hint::black_box(&copy);
        least[1] = least[1].min(clock.elapsed().as_secs_f64() * 1e3);
    }
    least
}

/// Fills a frame with a constant on all threads: what the memory alone costs.
pub fn fill(out: &mut [u32], value: u32) {
    let part = out.len().div_ceil(rayon::current_num_threads()).max(1);
    out.par_chunks_mut(part).for_each(|part| part.fill(value));
}

fn staged(scene: &mut Scene, still: &Theatre, case: Case, k: usize, frames: usize) -> Theatre {
    let phase = k as f64 / frames.max(1) as f64 * std::f64::consts::TAU;
    match case {
        Case::Posed => {
            let seconds = scene.timeline().map_or(1.0, |t| t.seconds);
            // Times that the timeline's own frames don't hit, so that no mask is remembered.
            scene.theatre_at(seconds * ((k as f64 + 0.37) / (frames + 3) as f64))
        }
        Case::LampMoved => {
            let mut theatre = still.clone();
            theatre.lamp.position_m.x += 0.1 * phase.sin();
            theatre
        }
        Case::Slid | Case::NothingSkipped => {
            let mut theatre = still.clone();
            for plane in &mut theatre.planes {
                plane.centre_m.x += 0.05 * theatre.screen.width_m * phase.sin();
                plane.centre_m.y += 0.02 * theatre.screen.height_m * (2.0 * phase).sin();
            }
            theatre
        }
    }
}
