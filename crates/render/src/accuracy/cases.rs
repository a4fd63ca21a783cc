//! Which techniques are measured, each over its knobs.

use kelir_scene::{EmitterShape, Theatre};
use serde::Serialize;

use crate::pa::{Variant, Weights};
use crate::{Technique, mc, pa, pcss, points};

/// One technique at one setting of the knob that buys its error down.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Case {
    /// Which line of the figure it belongs to.
    pub series: &'static str,
    /// The knob and its value.
    pub knob: String,
    /// Technique with all its knobs.
    #[serde(flatten)]
    pub technique: Technique,
}

/// Seed of everything under test; the reference must have another.
pub const SEED: u64 = 1;

/// Every technique over its knobs. What changes nothing on this stage is left out: the split of a lamp by area behind one upright
/// plane, strips where no emitter is a disk.
pub fn all(theatre: &Theatre) -> Vec<Case> {
    let mut cases = Vec::new();
    let mut add = |series, knob: String, technique| cases.push(Case { series, knob, technique });
    let exact = theatre.planes.len() < 2 && theatre.planes.iter().all(|p| p.tilt_deg == [0.0; 2]);
    let splits: &[u32] = if exact { &[1] } else { &[1, 2, 4, 8] };
    for &split in splits {
        add("PA", format!("split {split}"), Technique::Pa(pa::Knobs { split, ..pa::Knobs::default() }));
    }
    // One piece weighs the same either way.
    for split in [2, 4, 8] {
        let knobs = pa::Knobs { split, weights: Weights::Irradiance, ..pa::Knobs::default() };
        add("PA by irradiance", format!("split {split}"), Technique::Pa(knobs));
    }
    if theatre.lamp.emitters.iter().any(|e| matches!(e.shape, EmitterShape::Disk { .. })) {
        for strips in [4, 16, 256] {
            let knobs = pa::Knobs { strips, ..pa::Knobs::default() };
            add("PA, strips", format!("strips {strips}"), Technique::Pa(knobs));
        }
    }
    for map_size in [128, 256, 512, 1024, 2048] {
        let knobs = pa::Knobs { variant: Variant::ShadowMap, map_size, ..pa::Knobs::default() };
        add("PA shadow map", format!("map {map_size}"), Technique::Pa(knobs));
    }
    for spp in [16, 32, 64, 128, 256, 512, 1024, 2048] {
        add("MC", format!("spp {spp}"), Technique::Mc(mc::Knobs { spp, seed: SEED, ..mc::Knobs::default() }));
    }
    for lights in [1, 4, 16, 64, 256] {
        let knobs = points::Knobs { lights, ..points::Knobs::default() };
        add("points", format!("lights {lights}"), Technique::Points(knobs));
    }
    for filter_samples in [4, 16, 64, 256, 1024] {
        let knobs = pcss::Knobs {
            filter_samples,
            blocker_samples: filter_samples.min(64),
            map_size: 2048,
            seed: SEED,
            ..pcss::Knobs::default()
        };
        add("PCSS", format!("samples {filter_samples}"), Technique::Pcss(knobs));
    }
    cases
}
