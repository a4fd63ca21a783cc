//! Puppets behind puppets: what many of them let through is a product of many numbers, and stays one.

use std::sync::Arc;

use kelir_frame::{Backend, Frame, Pixel, RenderError, Renderer, View, VisibilityModel};
use kelir_scene::{Mask, Plane, Texels, Theatre};
use rayon::prelude::*;

use super::cases::{self, Case, Pattern};
use super::{BOUND, worst};
use crate::oracle::{self, Point};
use crate::{mc, pa, pcss, points};

/// How many puppets hang behind each other.
const PUPPETS: [usize; 7] = [1, 2, 15, 16, 17, 64, 256];
/// What each lets through, but for the one that has an edge: oiled hide, and hide that is half as dark as it looks.
const THROUGH: [f64; 2] = [0.98, 0.5];
const VIEW: View = View { size: [32, 18], pixel: Pixel::Centre, skip: true };

/// One technique on one backend, behind one stack of puppets.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct StackRow {
    /// How many there are.
    pub puppets: usize,
    /// 8 or 16 bits a texel.
    pub bits: u32,
    /// What each but the first lets through.
    pub through: f64,
    /// What draws.
    pub technique: &'static str,
    /// Where.
    pub backend: Backend,
    /// Largest error in visibility against the oracle; absent where it was refused.
    pub error: Option<f64>,
    /// How large it may be: rounding, and for what samples or searches a share of what the stack lets through.
    pub allowed: f64,
    /// Visibilities that are no numbers, or outside of 0 to 1 by more than the error that is allowed.
    pub impossible: usize,
    /// Why it was refused.
    pub refused: Option<String>,
}

impl StackRow {
    /// Whether what is claimed holds: drawn within its bound, or refused on a device that can't hold it.
    pub fn holds(&self) -> bool {
        let drawn = self.error.is_some_and(|error| error <= self.allowed) && self.impossible == 0;
        drawn || (self.refused.is_some() && self.backend == Backend::Gpu)
    }
}

/// A renderer, or why there is none.
type Opened = Result<Box<dyn Renderer<Theatre>>, RenderError>;

/// What draws, and the share of what a stack lets through by which it may err.
fn drawn_by(backend: Backend) -> Vec<(&'static str, f64, Opened)> {
    let mc = mc::Knobs { spp: 64, ..mc::Knobs::default() };
    // Sixteen lights stand in four columns: half of one may be seen wrongly.
    let lights = points::Knobs { lights: 16, subpixels: 1 };
    let mut all = vec![
        ("pa", 0.0, pa::renderer(&pa::Knobs::default(), backend)),
        ("mc", 0.1, mc::renderer(&mc, backend)),
        ("points", 0.13, points::renderer(&lights, backend)),
        ("pcss", 0.2, pcss::renderer(&pcss::Knobs::default(), backend)),
    ];
    if backend == Backend::Cpu {
        all.push(("oracle", 0.0, oracle::renderer(&oracle::Knobs::default())));
    }
    all
}

/// An edge, and behind it plain sheets that cover the beam: all techniques see the same, and its truth is a finite sum.
fn stack(puppets: usize, bits: u32, through: f64) -> Theatre {
    let edge = Case {
        pattern: Pattern::HalfPlane,
        side: 64,
        bits,
        height_m: 4.0,
        emitters: vec![([0.3, 0.3], 40.0)],
        aside_m: [0.0; 2],
        ..cases::plain()
    };
    let mut theatre = edge.theatre();
    let sheet = Arc::new(match bits {
        16 => Mask::new(1, 1, 1, Texels::U16(vec![(65535.0 * through).round() as u16])),
        _ => Mask::new(1, 1, 1, Texels::U8(vec![(255.0 * through).round() as u8])),
    });
    let first = theatre.planes[0].clone();
    theatre.planes.extend((1..puppets).map(|k| {
        let mut centre_m = first.centre_m;
        centre_m.z -= 0.9 * k as f64 / puppets as f64;
        Plane { mask: sheet.clone(), centre_m, ..first.clone() }
    }));
    theatre
}

/// Every stack of at most `most` puppets by every technique on `backend`, technique by technique. Errors: no adapter where there must be one.
pub fn stacks(
    most: usize,
    backend: Backend,
    mut each: impl FnMut(usize),
) -> Result<Vec<StackRow>, RenderError> {
    let mut drawing = Vec::new();
    for (technique, share, renderer) in drawn_by(backend) {
        drawing.push((technique, share, renderer?, Vec::new()));
    }
    for puppets in PUPPETS.into_iter().filter(|puppets| *puppets <= most) {
        each(puppets);
        for (bits, through) in [8, 16].into_iter().flat_map(|bits| THROUGH.map(|through| (bits, through))) {
            let theatre = stack(puppets, bits, through);
            let sheets: f64 = theatre.planes[1..].iter().map(|p| p.mask.transmittance(0, 0, 0)).product();
            let truth = truth(&theatre);
            for (technique, share, renderer, rows) in &mut drawing {
                let row = StackRow {
                    puppets,
                    bits,
                    through,
                    technique,
                    backend,
                    error: None,
                    allowed: BOUND + *share * sheets,
                    impossible: 0,
                    refused: None,
                };
                // What the door would refuse is counted here.
                rows.push(match renderer.frame(&theatre, &VIEW, true) {
                    Ok(frame) => compared(row, &frame, &truth),
                    Err(error) => StackRow { refused: Some(error.to_string()), ..row },
                });
            }
        }
    }
    Ok(drawing.into_iter().flat_map(|(_, _, _, rows)| rows).collect())
}

/// Visibility of every pixel.
fn truth(theatre: &Theatre) -> Vec<oracle::Visibility> {
    let [w, h] = VIEW.size;
    let at = |k: usize| oracle::visibility(theatre, 0, Point::pixel(theatre, &VIEW, k % w, k / w), 1e-6);
    (0..w * h).into_par_iter().map(at).collect()
}

fn compared(row: StackRow, frame: &Frame, truth: &[oracle::Visibility]) -> StackRow {
    let layer = &frame.visibilities[0];
    let likely = -row.allowed..=1.0 + row.allowed;
    let impossible = layer.values.iter().filter(|v| !likely.contains(&f64::from(**v))).count();
    let error = layer.values.iter().zip(truth).fold(0.0, |most, (seen, truth)| {
        let truth = match layer.model {
            VisibilityModel::Geometric => truth.geometric[0],
            VisibilityModel::Irradiance => truth.irradiance[0],
        };
        worst(most, f64::from(*seen) - truth)
    });
    StackRow { error: Some(error), impossible, ..row }
}
