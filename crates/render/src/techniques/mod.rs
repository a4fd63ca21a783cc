//! The techniques: adding one is a new folder in the crate of what it draws (kelir-theatre, kelir-stage), one variant of [`Technique`] and one line in each `match` on it.

pub mod knobs;

use kelir_frame::{Backend, RenderError, Renderer};
use kelir_scene::Theatre;
use kelir_scene::stage::Stage;
use kelir_stage::raytrace;
use kelir_theatre::{mc, oracle, pa, pcss, points};
use knobs::Knob;
use serde::{Deserialize, Serialize};

/// What draws: every technique with its knobs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "technique", rename_all = "kebab-case")]
pub enum Technique {
    /// Summed-area tables (Taylor & Cameron).
    Pa(pa::Knobs),
    /// Monte Carlo, the ground truth with a standard error.
    Mc(mc::Knobs),
    /// Point lights averaged.
    Points(points::Knobs),
    /// Percentage-closer soft shadows (Fernando).
    Pcss(pcss::Knobs),
    /// Slow f64 sums without random numbers, for crops and tests.
    Oracle(oracle::Knobs),
    /// Rays, the ground truth of a stage.
    Raytrace(raytrace::Knobs),
}

impl Technique {
    /// The name in files, tables and messages.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Pa(_) => "pa",
            Self::Mc(_) => "mc",
            Self::Points(_) => "points",
            Self::Pcss(_) => "pcss",
            Self::Oracle(_) => "oracle",
            Self::Raytrace(_) => "raytrace",
        }
    }

    /// The revision that stands in a job's key.
    pub fn revision(&self) -> u32 {
        match self {
            Self::Pa(knobs) => knobs.revision(),
            Self::Mc(_) => mc::REVISION,
            Self::Points(_) => points::REVISION,
            Self::Pcss(_) => pcss::REVISION,
            Self::Oracle(_) => oracle::REVISION,
            Self::Raytrace(_) => raytrace::REVISION,
        }
    }

    /// What can be turned on it.
    pub fn knobs(&self) -> &'static [Knob] {
        match self {
            Self::Pa(_) => pa::KNOBS,
            Self::Mc(_) => mc::KNOBS,
            Self::Points(_) => points::KNOBS,
            Self::Pcss(_) => pcss::KNOBS,
            Self::Oracle(_) => oracle::KNOBS,
            Self::Raytrace(_) => raytrace::KNOBS,
        }
    }

    /// What it is, in a few words.
    pub fn about(&self) -> &'static str {
        match self {
            Self::Pa(_) => "summed-area tables",
            Self::Mc(_) => "Monte Carlo, the ground truth",
            Self::Points(_) => "point lights averaged",
            Self::Pcss(_) => "percentage-closer soft shadows",
            Self::Oracle(_) => "slow f64 sums, for crops and tests",
            Self::Raytrace(_) => "rays, the ground truth of a stage",
        }
    }

    /// Whether it is the ground truth: unbiased, with a standard error for every pixel, so that others are measured against it.
    pub fn is_truth(&self) -> bool {
        match self {
            Self::Mc(_) | Self::Raytrace(_) => true,
            Self::Pa(_) | Self::Points(_) | Self::Pcss(_) | Self::Oracle(_) => false,
        }
    }

    /// How much the ground truth knows: samples a pixel and emitter, the more, the less it errs. 0 for what is no ground truth.
    pub fn truth_samples(&self) -> u32 {
        match self {
            Self::Mc(knobs) => knobs.spp,
            Self::Raytrace(knobs) => knobs.spp,
            Self::Pa(_) | Self::Points(_) | Self::Pcss(_) | Self::Oracle(_) => 0,
        }
    }

    /// A theatre's ground truth, where nobody asks for more of it.
    pub fn truth() -> Self {
        Self::Mc(mc::Knobs::default())
    }

    /// From now on the ground truth takes at most so many samples a pixel, and what else draws is as it was.
    pub(crate) fn sample_at_most(&mut self, samples: u32) {
        match self {
            Self::Mc(knobs) => {
                (knobs.spp, knobs.target_error, knobs.time_limit_s) = (knobs.spp.min(samples), None, None);
            }
            Self::Raytrace(knobs) => knobs.spp = knobs.spp.min(samples),
            Self::Pa(_) | Self::Points(_) | Self::Pcss(_) | Self::Oracle(_) => {}
        }
    }

    /// Errors: a knob out of its range.
    pub fn check(&self) -> Result<(), RenderError> {
        match self {
            Self::Pa(knobs) => knobs.check(),
            Self::Mc(knobs) => knobs.check(),
            Self::Points(knobs) => knobs.check(),
            Self::Pcss(knobs) => knobs.check(),
            Self::Oracle(knobs) => knobs.check(),
            Self::Raytrace(knobs) => knobs.check(),
        }
    }
}

/// What `technique` cannot draw.
fn inapplicable(technique: &Technique, subject: &str, others: &str) -> RenderError {
    let reason = format!("it shows a {subject}, which {others}");
    RenderError::Inapplicable { technique: technique.name(), reason }
}

/// A renderer of stages. Errors: a knob out of range; a technique of theatres; [`Backend::Gpu`], which no technique of stages has.
pub fn stage_renderer(
    technique: &Technique,
    backend: Backend,
) -> Result<Box<dyn Renderer<Stage>>, RenderError> {
    let Technique::Raytrace(knobs) = technique else {
        return Err(inapplicable(technique, "stage", "raytrace alone draws"));
    };
    if backend == Backend::Gpu {
        return Err(RenderError::Gpu("raytrace draws on the CPU alone".into()));
    }
    knobs.check()?;
    Ok(raytrace::renderer(knobs))
}

/// A renderer of theatres. Errors: a knob out of range, a technique of stages, or `Backend::Gpu` without any adapter.
pub fn renderer(technique: &Technique, backend: Backend) -> Result<Box<dyn Renderer<Theatre>>, RenderError> {
    match technique {
        Technique::Pa(knobs) => pa::renderer(knobs, backend),
        Technique::Mc(knobs) => mc::renderer(knobs, backend),
        Technique::Points(knobs) => points::renderer(knobs, backend),
        Technique::Pcss(knobs) => pcss::renderer(knobs, backend),
        Technique::Oracle(knobs) => oracle::renderer(knobs),
        Technique::Raytrace(_) => Err(inapplicable(technique, "theatre", "the other techniques draw")),
    }
}
