//! How the time of a frame grows with what is drawn.

use std::sync::Arc;

use kelir_scene::{Mask, Plane, Scene, Texels, Theatre};
use serde::Serialize;

use super::{quantile, slid, timed};
use crate::exposure::Rule;
use crate::subject::Staged;
use crate::{Backend, RenderError, Technique, View, pa, renderer};

/// One line of the table: a sliding puppet with one thing changed.
#[derive(Clone, Debug, Serialize)]
pub struct Scaled {
    /// What is changed: pixels, mask, emitters, puppets, samples or threads.
    pub what: &'static str,
    /// To what.
    pub value: String,
    /// Median of a frame, ms.
    pub median_ms: f64,
    /// Frames a second at that.
    pub fps: f64,
}

/// Times `frames` frames of a sliding puppet for each value of everything that can be more or less. Errors: as drawing.
pub fn scaling(
    scene: &Scene,
    technique: &Technique,
    backend: Backend,
    view: &View,
    frames: usize,
) -> Result<Vec<Scaled>, RenderError> {
    let still = scene.still();
    let white = scene.white(Rule::Still, view, None);
    let one = |theatre: &Theatre, technique: &Technique, view: &View| {
        let mut drawing = renderer(technique, backend)?;
        let phase = |k: usize| k as f64 / frames.max(1) as f64;
        let timed = timed(drawing.as_mut(), view, white, frames, |k| slid(theatre, phase(k)))?;
        Ok::<f64, RenderError>(quantile(&timed.times, 0.5))
    };
    let mut rows = Vec::new();
    let mut add = |what, value: String, median_ms: f64| {
        rows.push(Scaled { what, value, median_ms, fps: 1e3 / median_ms });
    };
    for (up, down) in [(1, 4), (1, 2), (1, 1), (2, 1)] {
        let size = view.size.map(|side| (side * up / down).max(1));
        let ms = one(&still, technique, &View { size, ..*view })?;
        add("pixels", format!("{}x{}", size[0], size[1]), ms);
    }
    for side in [256, 512, 1024, 2048, 4096] {
        let planes = still.planes.iter().map(|p| resized(p, side)).collect();
        let ms = one(&Theatre { planes, ..still.clone() }, technique, view)?;
        add("texels a side", side.to_string(), ms);
    }
    for count in [1, 2, 4, 8] {
        add("emitters", count.to_string(), one(&with_emitters(&still, count), technique, view)?);
    }
    for count in [1, 2, 4] {
        add("puppets", count.to_string(), one(&with_puppets(&still, count), technique, view)?);
    }
    for (value, technique) in samples(technique) {
        add("samples", value, one(&still, &technique, view)?);
    }
    let most = std::thread::available_parallelism().map_or(1, usize::from);
    for threads in (0..8).map(|k| 1 << k).filter(|n| *n <= most) {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let pool = pool.map_err(|e| RenderError::View(format!("threads = {threads}: {e}")))?;
        add("threads", threads.to_string(), pool.install(|| one(&still, technique, view))?);
    }
    Ok(rows)
}

/// The technique with fewer and more samples of its own kind.
fn samples(technique: &Technique) -> Vec<(String, Technique)> {
    match technique {
        Technique::Pa(knobs) => [1, 2, 4]
            .map(|split| {
                let knobs = pa::Knobs { split, weights: pa::Weights::Irradiance, ..*knobs };
                (format!("{split} x {split} pieces"), Technique::Pa(knobs))
            })
            .into(),
        Technique::Mc(knobs) => [16, 64, 256]
            .map(|spp| {
                let knobs = crate::mc::Knobs { spp, target_error: None, time_limit_s: None, ..*knobs };
                (format!("{spp} a pixel"), Technique::Mc(knobs))
            })
            .into(),
        Technique::Points(knobs) => [1, 4, 16, 64]
            .map(|lights| {
                (format!("{lights} lights"), Technique::Points(crate::points::Knobs { lights, ..*knobs }))
            })
            .into(),
        _ => Vec::new(),
    }
}

/// The plane with its mask taken at `side` × `side` points.
fn resized(plane: &Plane, side: usize) -> Plane {
    let mask = &plane.mask;
    let from = |k: usize| {
        let (c, y, x) = (k / (side * side), k / side % side, k % side);
        (c * mask.height + y * mask.height / side) * mask.width + x * mask.width / side
    };
    let all = 0..mask.channels * side * side;
    let texels = match &mask.texels {
        Texels::U8(t) => Texels::U8(all.map(|k| t[from(k)]).collect()),
        Texels::U16(t) => Texels::U16(all.map(|k| t[from(k)]).collect()),
    };
    Plane { mask: Arc::new(Mask::new(side, side, mask.channels, texels)), ..plane.clone() }
}

/// The first `count` emitters; where there are fewer, copies of the last with less light.
fn with_emitters(theatre: &Theatre, count: usize) -> Theatre {
    let mut theatre = theatre.clone();
    let emitters = &mut theatre.lamp.emitters;
    emitters.truncate(count);
    while emitters.len() < count {
        let mut copy = emitters[emitters.len() - 1].clone();
        copy.name = format!("copy {}", emitters.len());
        copy.radiance.iter_mut().for_each(|l| *l *= 0.5);
        emitters.push(copy);
    }
    theatre
}

/// The first `count` puppets; where there are fewer, copies of the last a little aside and behind.
fn with_puppets(theatre: &Theatre, count: usize) -> Theatre {
    let mut theatre = theatre.clone();
    theatre.planes.truncate(count);
    while let (Some(last), true) = (theatre.planes.last(), theatre.planes.len() < count) {
        let mut copy = last.clone();
        copy.centre_m.x += 0.1 * theatre.screen.width_m;
        copy.centre_m.z *= 1.1;
        theatre.planes.push(copy);
    }
    theatre
}
