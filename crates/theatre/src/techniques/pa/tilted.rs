//! Boxes of any place and size in a table: what a tilted plane shows of a piece of an emitter ([`PlaneFrame`]).

use glam::DVec2;

use super::table::Table;
use crate::project::tilted::{Piece, PlaneFrame};

impl Table {
    /// Mean opacity of what `p_m` sees of `piece` on the plane of `frame`.
    pub(crate) fn opacity(&self, frame: &PlaneFrame, piece: &Piece, p_m: DVec2) -> f64 {
        frame.seen(piece, p_m).map_or(0.0, |(centre, sides)| self.mean(centre, sides))
    }

    /// Mean opacity of the box with the given centre and full sides, texels: whole columns and rows by integer differences, the
    /// fractional ones at its ends (at most 3 × 3 blocks) weighed afterwards.
    pub(crate) fn mean(&self, centre: DVec2, sides: DVec2) -> f64 {
        let (xs, x_count) = parts(centre.x, sides.x, self.width);
        let (ys, y_count) = parts(centre.y, sides.y, self.height);
        let mut sum = 0.0;
        for (y, wy) in &ys[..y_count] {
            for (x, wx) in &xs[..x_count] {
                sum += wx * wy * self.sum(*x, *y) as f64;
            }
        }
        (sum / (sides.x * sides.y * f64::from(self.max_code))).clamp(0.0, 1.0)
    }
}

/// Texel ranges of [centre ± width / 2] inside the grid, each with the share of a texel that it counts for.
pub(crate) fn parts(centre: f64, width: f64, size: usize) -> ([([usize; 2], f64); 3], usize) {
    let base = centre.floor();
    let middle = centre - base;
    let (from, to) = (middle - 0.5 * width, middle + 0.5 * width);
    let (first, last) = (from.floor(), to.floor());
    let mut out = [([0; 2], 0.0); 3];
    let mut count = 0;
    let mut add = |a: f64, b: f64, weight: f64| {
        let clamp = |t: f64| (base + t).clamp(0.0, size as f64) as usize;
        let range = [clamp(a), clamp(b)];
        if range[1] > range[0] && weight > 0.0 {
            out[count] = (range, weight);
            count += 1;
        }
    };
    if first == last {
        add(first, first + 1.0, width);
    } else {
        add(first, first + 1.0, first + 1.0 - from);
        add(first + 1.0, last, 1.0);
        add(last, last + 1.0, to - last);
    }
    (out, count)
}
