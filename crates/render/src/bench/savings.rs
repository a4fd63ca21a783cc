//! What each of PA's skips saves.

use std::time::Instant;

use kelir_scene::Scene;
use serde::Serialize;

use super::{median, slid};
use crate::exposure::Rule;
use crate::pa::{Knobs, Native, Skips};
use crate::subject::Staged;
use crate::{RenderError, Renderer, View};

/// A sliding puppet drawn with every skip, and with every skip but one.
#[derive(Clone, Debug, Serialize)]
pub struct Saving {
    /// What is left out.
    pub skip: &'static str,
    /// How often in a frame, at most: pixels, boxes, planes, tables, emitters or screens.
    pub count: u64,
    /// Median of a frame with every skip, ms.
    pub with_ms: f64,
    /// Median of a frame with every skip but this one, ms; equal to `with_ms` where the scene offers nothing to skip.
    pub without_ms: f64,
}

/// Every skip of PA's native code alone; both ways frame by frame in turn, so that a busy machine slows both. Errors: as drawing.
pub fn savings(scene: &Scene, knobs: &Knobs, view: &View, frames: usize) -> Result<Vec<Saving>, RenderError> {
    let (still, white) = (scene.still(), scene.white(Rule::Still, view, None));
    let mut out = vec![0; view.size[0] * view.size[1]];
    let mut savings = Vec::new();
    for (skip, name, counter) in Skips::EACH {
        let mut with = Native::new(*knobs);
        let mut without = Native::with_skips(*knobs, Skips::ALL.without(skip));
        let mut times = [Vec::new(), Vec::new()];
        let mut count = 0u64;
        for k in 0..frames.max(1) + 2 {
            let theatre = slid(&still, k as f64 / frames.max(1) as f64);
            let clock = Instant::now();
            let stats = with.display(&theatre, view, white, &mut out)?;
            times[0].push(clock.elapsed().as_secs_f64() * 1e3);
            count = count.max(stats.counts.get(counter).copied().unwrap_or(0));
            // The scene offers nothing of it.
            if k == 2 && count == 0 {
                break;
            }
            let clock = Instant::now();
            without.display(&theatre, view, white, &mut out)?;
            times[1].push(clock.elapsed().as_secs_f64() * 1e3);
        }
        // The first two frames fill what is kept.
        let [with_ms, without_ms] = times.map(|mut t| if t.len() > 2 { median(&mut t[2..]) } else { 0.0 });
        let without_ms = if count == 0 { with_ms } else { without_ms };
        savings.push(Saving { skip: name, count, with_ms, without_ms });
    }
    Ok(savings)
}
