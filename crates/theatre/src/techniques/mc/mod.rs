//! Monte Carlo: an unbiased estimate of each emitter's irradiance E_k, with a standard error per pixel.
//!
//! Owen-scrambled Sobol points spread over the emitter (and over the pixel for `area`); sixteen independent scrambles
//! give sixteen estimates whose spread is the standard error (`trace`). No pilot run decides what is estimated, so it stays
//! unbiased.

mod budget;
#[cfg(feature = "gpu")]
mod twins;

use std::ops::Bound;
use std::time::Instant;

use kelir_frame::{Backend, Frame, Meter, RenderError, Renderer, Stats, View, VisibilityModel};
use kelir_scene::Theatre;
use serde::{Deserialize, Serialize};

use crate::trace::sobol::{Points, REPLICATES};
use crate::trace::{Row, Tracer};
use kelir_frame::knobs::{self, Knob, Range};

#[cfg(feature = "gpu")]
pub(crate) use twins::twins;

/// Stands in the key of every job: raise it, and bless the golden images, with any change that can change a byte that this technique
/// draws, in its own files or in what it shares with others. What was made before is then made anew.
pub const REVISION: u32 = 3;

/// What can be turned.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Knobs {
    /// Samples per pixel and emitter in penumbra, 1..=2²⁰, rounded up to a multiple of the 16 scrambles.
    pub spp: u32,
    /// Seed of the scrambles.
    pub seed: u64,
    /// In place of `spp`: enough samples for this root mean square error over penumbra pixels, in units of the brightest
    /// unshadowed pixel, in (0, 1). What a pilot decides is frozen and counted as `spp`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub target_error: Option<f64>,
    /// In place of `spp`: as many samples as this many seconds allow, > 0; frozen and counted likewise, so that `spp`
    /// replays the image to the byte. With `target_error` too, whichever is reached first.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_limit_s: Option<f64>,
}

impl Default for Knobs {
    fn default() -> Self {
        Self { spp: 64, seed: 1, target_error: None, time_limit_s: None }
    }
}

impl Knobs {
    /// Errors: a knob out of its range.
    pub fn check(&self) -> Result<(), RenderError> {
        knobs::check(KNOBS, self)
    }
}

/// What can be turned, for files, command line and tables.
pub const KNOBS: &[Knob] = &[
    Knob {
        name: "spp",
        unit: "samples a pixel",
        range: Range::Whole(1, 1 << 20),
        about: "samples a pixel and emitter in penumbra, rounded up to a multiple of 16 replicates",
    },
    knobs::SEED,
    Knob {
        name: "target_error",
        unit: "full scale",
        range: Range::Number(Bound::Excluded(0.0), Bound::Excluded(1.0)),
        about: "in place of spp: enough samples for this root mean square error over penumbra",
    },
    Knob {
        name: "time_limit_s",
        unit: "s",
        range: Range::Number(Bound::Excluded(0.0), Bound::Unbounded),
        about: "in place of spp: as many samples as this time allows; the count is recorded and replays the image",
    },
];

/// The renderer for `knobs` on `backend`.
pub fn renderer(knobs: &Knobs, backend: Backend) -> Result<Box<dyn Renderer<Theatre>>, RenderError> {
    knobs.check()?;
    Ok(Box::new(Mc::new(*knobs, Tracer::new(backend)?)))
}

/// Keeps points between frames.
struct Mc {
    knobs: Knobs,
    points: Option<Points>,
    tracer: Tracer,
}

impl Mc {
    fn new(knobs: Knobs, tracer: Tracer) -> Self {
        Self { knobs, points: None, tracer }
    }
}

impl Renderer<Theatre> for Mc {
    fn frame(&mut self, theatre: &Theatre, view: &View, visibilities: bool) -> Result<Frame, RenderError> {
        let (mut stats, started) = (Stats::default(), Instant::now());
        let mut trace = self.tracer.trace(theatre, view, VisibilityModel::Irradiance, visibilities)?;
        stats.step("prepare", started);
        let clock = Instant::now();
        let samples = budget::freeze(&self.knobs, view.size[1], started, |p, rows| trace.rows(&p, rows))?;
        stats.step("pilot", clock);
        let clock = Instant::now();
        let points = match self.points.take() {
            Some(points) if points.samples == samples => points,
            _ => Points::new(self.knobs.seed, samples),
        };
        let rows = trace.all(&points)?;
        self.points = Some(points);
        stats.step("sample", clock);
        trace.count(&rows, samples, &mut stats);
        stats.counts.insert("replicates".into(), REPLICATES as u64);
        summarise(&rows, &mut stats);
        Ok(trace.frame(&rows, stats))
    }

    fn watch(&mut self, meter: &Meter) {
        self.tracer.meter = meter.clone();
    }

    fn class(&self) -> String {
        self.tracer.class()
    }

    fn adapter(&self) -> String {
        self.tracer.adapter()
    }
}

/// The standard error's summary, in units of the brightest unshadowed pixel.
fn summarise(rows: &[Row], stats: &mut Stats) {
    let full = rows.iter().map(|r| r.brightest).fold(0.0, f64::max);
    if full > 0.0 {
        let sum = rows.iter().map(|r| r.error_sum).sum::<f64>();
        let square = rows.iter().map(|r| r.error_square).sum::<f64>();
        let max = rows.iter().map(|r| r.error_max).fold(0.0, f64::max);
        let n = rows.iter().map(|r| r.penumbra).sum::<u64>().max(1) as f64;
        stats.values.insert("se_mean".into(), sum / n / full);
        stats.values.insert("se_rms".into(), (square / n).sqrt() / full);
        stats.values.insert("se_max".into(), max / full);
    }
}

#[cfg(test)]
mod tests;
