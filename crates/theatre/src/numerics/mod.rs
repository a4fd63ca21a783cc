//! How exact the renderer's numbers are: stress cases, each held against the oracle's f64 sums.
//!
//! For every case PA draws the whole view as it always does; then, box by box, four tables that it might have used (u32, u64, f32, and
//! f32 with the mean subtracted) are asked for the same exactly cut boxes, and the exact table is asked with corners and blends in f32.
//! So a column's error is the error of that table, or of that arithmetic, alone.

mod cases;
mod curves;
mod emitters;
mod stacks;
mod variants;

use kelir_frame::{Frame, RenderError, Renderer, View, encode};
use kelir_scene::{EmitterShape, Theatre};
use rayon::prelude::*;

pub use cases::{Case, Pattern, cases};
pub use curves::{Curve, Step, curves};
pub use emitters::{EmitterErrors, emitters};
pub use stacks::{StackRow, stacks};

use crate::oracle::{self, Point};
use crate::pa::plan::Plan;
use crate::pa::table::Table;
use crate::project::{is_tilted, pixel_m};
use crate::{irradiance, pa, white};
use variants::{Blocks, Corners, Float, Footprint};

/// Largest error in visibility that PA may have where puppets hang parallel to the screen.
pub const BOUND: f64 = 1e-6;
/// How near a rounding boundary, in codes, a display byte must be to differ from the oracle's.
pub const NEAR_BOUNDARY: f64 = 0.01;
/// The tables and the arithmetic that are compared, in the order of [`Row::variants`].
pub const VARIANTS: [&str; 5] = ["u32", "u64", "f32", "biased f32", "f32 corners"];

/// Odd numbers, so that the middle pixel looks along the axis.
const SIZE: [usize; 2] = [97, 55];

/// One case's errors against the oracle.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Row {
    /// The case.
    pub case: String,
    /// Whether exactness is claimed: the puppet hangs parallel to the screen.
    pub parallel: bool,
    /// Pixels that were compared.
    pub pixels: usize,
    /// Largest error in visibility of PA as it draws.
    pub product: f64,
    /// Which of [`VARIANTS`] PA's tables are here.
    pub uses: &'static str,
    /// Largest error in visibility of each of [`VARIANTS`].
    pub variants: [f64; 5],
    /// Largest error in radiance, in units of the brightest unshadowed pixel.
    pub radiance: f64,
    /// Visibilities of the whole image that are NaN, negative or above 1.
    pub impossible: usize,
    /// Display bytes that differ from the oracle's.
    pub bytes_off: usize,
    /// Of those, bytes that differ by more than one code or lie further than [`NEAR_BOUNDARY`] from where the code changes.
    pub bytes_wrong: usize,
}

impl Row {
    /// Whether what is claimed of this case holds.
    pub fn holds(&self) -> bool {
        let exact = self.product <= BOUND && self.radiance <= BOUND && self.bytes_wrong == 0;
        self.impossible == 0 && (exact || !self.parallel)
    }
}

/// Measures one case. Errors: as drawing.
pub fn measure(case: &Case) -> Result<Row, RenderError> {
    let theatre = case.theatre();
    let view = View { size: SIZE, pixel: case.pixel, skip: true };
    let plan = Plan::new(&theatre, &view, &pa::Knobs::default())?;
    let mut native = pa::Native::new(pa::Knobs::default());
    let frame = native.radiance(&theatre, &view)?;
    let white = white([&theatre], &view);
    let mut codes = vec![0; SIZE[0] * SIZE[1]];
    native.display(&theatre, &view, white, &mut codes)?;
    drop(native);

    let pixels = pixels(&theatre, &plan);
    let truths: Vec<Vec<f64>> =
        pixels.par_iter().map(|[i, j]| truth(&theatre, Point::pixel(&theatre, &view, *i, *j))).collect();
    let mut row = Row {
        case: case.name.clone(),
        parallel: case.is_parallel(),
        pixels: pixels.len(),
        product: 0.0,
        uses: if plan.wide[0] { "u64" } else { "u32" },
        variants: compare(&theatre, &view, &plan, &pixels, &truths),
        radiance: 0.0,
        impossible: impossible(&frame),
        bytes_off: 0,
        bytes_wrong: 0,
    };
    for ([i, j], truth) in pixels.iter().zip(&truths) {
        let k = j * SIZE[0] + i;
        for (drawn, v) in frame.visibilities.iter().zip(truth) {
            row.product = worst(row.product, f64::from(drawn.values[k]) - v);
        }
        let p = pixel_m(&theatre.screen, SIZE, *i as f64, *j as f64);
        let emitters = theatre.lamp.emitters.iter().zip(truth);
        let lit = emitters
            .map(|(e, v)| e.radiance[0] * v * irradiance::unit(&e.shape, theatre.lamp.position_m, p))
            .sum::<f64>()
            / std::f64::consts::PI;
        row.radiance = worst(row.radiance, (f64::from(frame.radiance[0][k]) - lit) / white);
        let code = 255.0 * encode::oetf((lit / white).clamp(0.0, 1.0));
        let off = (f64::from(codes[k] & 0xff) - code.round()).abs();
        if off > 0.0 {
            row.bytes_off += 1;
            let boundary = (code - code.floor() - 0.5).abs();
            row.bytes_wrong += usize::from(off > 1.0 || boundary > NEAR_BOUNDARY);
        }
    }
    Ok(row)
}

/// The larger of `worst` and |`error`|; NaN is infinitely wrong.
fn worst(worst: f64, error: f64) -> f64 {
    if error.is_nan() { f64::INFINITY } else { worst.max(error.abs()) }
}

/// Every emitter's geometric visibility.
fn truth(theatre: &Theatre, point: Point) -> Vec<f64> {
    (0..theatre.lamp.emitters.len()).map(|e| oracle::geometric(theatre, e, point, 1e-4)[0]).collect()
}

fn impossible(frame: &Frame) -> usize {
    let values = frame.visibilities.iter().flat_map(|v| &v.values);
    values.filter(|v| !(0.0..=1.0).contains(*v)).count()
}

/// A lattice of pixels through the middle one: the fewer, the more texels a box holds.
fn pixels(theatre: &Theatre, plan: &Plan) -> Vec<[usize; 2]> {
    /// Texels that the oracle is to add up.
    const TEXELS: f64 = 1e8;
    let plane = &theatre.planes[0];
    let (w, h) = (plane.mask.width as f64, plane.mask.height as f64);
    let texels = |l: &pa::plan::Lookup| match l.tilted {
        // Its emitter is cut into ever more pieces.
        Some(_) => 100.0 * w * h,
        None => (l.x.width + 2.0 * l.x.reach as f64).min(w) * (l.y.width + 2.0 * l.y.reach as f64).min(h),
    };
    let all: f64 = plan.lookups.iter().map(texels).sum();
    let wanted = (TEXELS / all.max(1.0)).clamp(24.0, 400.0);
    let step = ((SIZE[0] * SIZE[1]) as f64 / wanted).sqrt().ceil() as usize;
    let along = |n: usize| ((n / 2) % step..n).step_by(step);
    along(SIZE[1]).flat_map(|j| along(SIZE[0]).map(move |i| [i, j])).collect()
}

/// Largest error of each variant.
fn compare(
    theatre: &Theatre,
    view: &View,
    plan: &Plan,
    pixels: &[[usize; 2]],
    truths: &[Vec<f64>],
) -> [f64; 5] {
    let plane = &theatre.planes[0];
    let mask = &*plane.mask;
    let grid = [mask.width, mask.height];
    let of = |[i, j]: &[usize; 2], e: usize| -> Option<Footprint> {
        let lookup = plan.lookups.iter().find(|l| plan.pieces[l.piece].emitter == e)?;
        match &lookup.tilted {
            None => Some(Footprint::upright(&lookup.x, &lookup.y, [*i, *j], grid)),
            Some(frame) => {
                let p = pixel_m(&theatre.screen, view.size, *i as f64, *j as f64);
                let (centre, sides) = frame.seen(&plan.pieces[lookup.piece], p)?;
                Some(Footprint::around(centre, sides, grid))
            }
        }
    };
    let emitters = 0..theatre.lamp.emitters.len();
    let footprints: Vec<Vec<Option<Footprint>>> =
        pixels.par_iter().map(|p| emitters.clone().map(|e| of(p, e)).collect()).collect();
    let error = |table: &(dyn Blocks + Sync)| {
        let pixel = |(footprints, truth): (&Vec<Option<Footprint>>, &Vec<f64>)| {
            footprints.iter().zip(truth).fold(0.0, |most, (footprint, truth)| {
                // A puppet off the beam hides nothing.
                let v = footprint.as_ref().map_or(1.0, |f| f.visibility(table, mask.max_code()));
                worst(most, v - truth)
            })
        };
        footprints.par_iter().zip(truths).map(pixel).reduce(|| 0.0, f64::max)
    };
    let narrow = error(&Table::new(mask, 0, false, None));
    let wide = Table::new(mask, 0, true, None);
    let exact = error(&wide);
    let corners = if is_tilted(plane) {
        f64::NAN
    } else {
        let of = |e: &kelir_scene::Emitter| match e.shape {
            EmitterShape::Rectangle { size_m } => size_m,
            EmitterShape::Disk { radius_m } => [2.0 * radius_m; 2],
        };
        let corners: Vec<_> =
            theatre.lamp.emitters.iter().map(|e| Corners::new(theatre, plane, view, of(e))).collect();
        let pixel = |(p, truth): (&[usize; 2], &Vec<f64>)| {
            corners
                .iter()
                .zip(truth)
                .fold(0.0, |most, (c, truth)| worst(most, c.visibility(&wide, *p) - truth))
        };
        pixels.par_iter().zip(truths).map(pixel).reduce(|| 0.0, f64::max)
    };
    drop(wide);
    let [float, biased] = [false, true].map(|biased| error(&Float::new(mask, biased)));
    [narrow, exact, float, biased, corners]
}

#[cfg(test)]
mod tests;
