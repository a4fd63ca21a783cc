//! Tables that PA might have used, and arithmetic it might have used on them: kept for comparison alone.

use glam::DVec2;
use kelir_frame::{Pixel, View};
use kelir_scene::{Mask, Plane, Theatre};

use crate::pa::table::{Sums, Table};
use crate::pa::tilted::parts;
use crate::project::window::Windows;
use crate::project::{ShadowBox, pixel_m};

/// Sum of the opacity codes over columns `x` and rows `y` of texels, as well as a table knows it.
pub(super) trait Blocks {
    /// Columns [from, to) × rows [from, to) inside the grid.
    fn sum(&self, x: [usize; 2], y: [usize; 2]) -> f64;
}

impl Blocks for Table {
    fn sum(&self, x: [usize; 2], y: [usize; 2]) -> f64 {
        self.sum(x, y) as f64
    }
}

/// A summed-area table in f32, as graphics hardware sums it; with `bias` the mean is subtracted from every texel first (Hensley et al.,
/// "Fast summed-area table generation and its applications", 2005), so that sums stay near zero.
#[derive(Debug)]
pub(super) struct Float {
    width: usize,
    bias: f64,
    sums: Vec<f32>,
}

impl Float {
    /// The table of a grey mask.
    pub(super) fn new(mask: &Mask, biased: bool) -> Self {
        let (w, h) = (mask.width, mask.height);
        let max = f64::from(mask.max_code());
        let code = |x: usize, y: usize| max * (1.0 - mask.transmittance(0, x, y));
        let total = || (0..h).map(|y| (0..w).map(|x| code(x, y)).sum::<f64>()).sum::<f64>();
        let bias = if biased { total() / (w * h) as f64 } else { 0.0 };
        let mut sums = vec![0f32; (w + 1) * (h + 1)];
        for y in 0..h {
            let (above, row) = sums[y * (w + 1)..].split_at_mut(w + 1);
            let mut running = 0f32;
            for x in 0..w {
                running += (code(x, y) - bias) as f32;
                row[x + 1] = above[x + 1] + running;
            }
        }
        Self { width: w, bias, sums }
    }
}

impl Blocks for Float {
    /// The differences are taken in f64, so that what is wrong is wrong in the table.
    fn sum(&self, x: [usize; 2], y: [usize; 2]) -> f64 {
        let at = |x: usize, y: usize| f64::from(self.sums[y * (self.width + 1) + x]);
        let area = ((x[1] - x[0]) * (y[1] - y[0])) as f64;
        at(x[1], y[1]) - at(x[0], y[1]) - at(x[1], y[0]) + at(x[0], y[0]) + self.bias * area
    }
}

/// Texel ranges of one axis of a window, each with the share of a texel that it counts for.
type Ranges = Vec<([usize; 2], f64)>;

/// What window `i` holds of a grid of `size` texels: runs of whole texels, and single ones at its ends.
fn ranges(windows: &Windows, i: usize, size: usize) -> Ranges {
    let [first, last] = windows.touched(i..i + 1, size);
    let mut out: Ranges = Vec::new();
    for t in first..last {
        let share = windows.overlap(i, t as i64);
        match out.last_mut() {
            Some((range, before)) if *before == share && range[1] == t => range[1] = t + 1,
            _ if share > 0.0 => out.push(([t, t + 1], share)),
            _ => {}
        }
    }
    out
}

/// A box, cut exactly, ready to be summed from any table.
#[derive(Clone, Debug)]
pub(super) struct Footprint {
    x: Ranges,
    y: Ranges,
    /// Texels of the whole box, also where it hangs over the grid's edge.
    area: f64,
}

impl Footprint {
    /// Of the pixel at column `i` and row `j` of upright look-ups.
    pub(super) fn upright(x: &Windows, y: &Windows, [i, j]: [usize; 2], [w, h]: [usize; 2]) -> Self {
        Self { x: ranges(x, i, w), y: ranges(y, j, h), area: x.width * y.width }
    }

    /// Of a box given by its centre and full sides in texels.
    pub(super) fn around(centre: DVec2, sides: DVec2, [w, h]: [usize; 2]) -> Self {
        let cut = |centre: f64, width: f64, size: usize| {
            let (parts, count) = parts(centre, width, size);
            parts[..count].to_vec()
        };
        Self { x: cut(centre.x, sides.x, w), y: cut(centre.y, sides.y, h), area: sides.x * sides.y }
    }

    /// 1 − the mean opacity, from integer (or float) differences of the table first, weights afterwards.
    pub(super) fn visibility(&self, table: &dyn Blocks, max_code: u32) -> f64 {
        let row = |(y, wy): &([usize; 2], f64)| {
            self.x.iter().map(|(x, wx)| wx * wy * table.sum(*x, *y)).sum::<f64>()
        };
        1.0 - self.y.iter().map(row).sum::<f64>() / (self.area * f64::from(max_code))
    }
}

/// Box corners in f32, table entries blended in f32: what a shader does that interpolates the table at the box's four corners.
#[derive(Debug)]
pub(super) struct Corners {
    scale: [f32; 2],
    offset: [f32; 2],
    half: [f32; 2],
    pixel: [f32; 2],
    screen: [f32; 2],
    size: [usize; 2],
}

impl Corners {
    /// For one upright plane and an emitter of full sides `size_m`.
    pub(super) fn new(theatre: &Theatre, plane: &Plane, view: &View, size_m: [f64; 2]) -> Self {
        let map = ShadowBox::new(plane, theatre.lamp.position_m);
        let at = |i: f64, j: f64| map.centre(pixel_m(&theatre.screen, view.size, i, j));
        let pixel = match view.pixel {
            Pixel::Area => (at(1.0, 1.0) - at(0.0, 0.0)).abs(),
            Pixel::Centre => DVec2::ZERO,
        };
        let f = |v: DVec2| [v.x as f32, v.y as f32];
        Self {
            scale: f(map.scale),
            offset: f(map.offset),
            half: f(0.5 * map.spread * DVec2::from(size_m)),
            pixel: f(pixel),
            screen: f(DVec2::new(theatre.screen.width_m, theatre.screen.height_m)),
            size: view.size,
        }
    }

    /// 1 − the mean opacity at pixel (i, j).
    pub(super) fn visibility(&self, table: &Table, [i, j]: [usize; 2]) -> f64 {
        let p = [
            ((i as f32 + 0.5) / self.size[0] as f32 - 0.5) * self.screen[0],
            (0.5 - (j as f32 + 0.5) / self.size[1] as f32) * self.screen[1],
        ];
        let end = |axis: usize, side: f32| {
            let centre = self.scale[axis] * p[axis] + self.offset[axis];
            blend(centre + side * self.half[axis], self.pixel[axis])
        };
        let entry = |x: f32, y: f32| {
            let (x, y) =
                (x.clamp(0.0, table.width as f32) as usize, y.clamp(0.0, table.height as f32) as usize);
            let k = y * (table.width + 1) + x;
            match &table.sums {
                Sums::U32(s) => s[k] as f32,
                Sums::U64(s) => s[k] as f32,
            }
        };
        let corner = |sx: f32, sy: f32| {
            let (x, y) = (end(0, sx), end(1, sy));
            let row = |(ty, wy): &(f32, f32)| x.iter().map(|(tx, wx)| wx * wy * entry(*tx, *ty)).sum::<f32>();
            y.iter().map(row).sum::<f32>()
        };
        let sum = corner(1.0, 1.0) - corner(-1.0, 1.0) - corner(1.0, -1.0) + corner(-1.0, -1.0);
        f64::from(1.0 - sum / (4.0 * self.half[0] * self.half[1] * table.max_code as f32))
    }
}

/// Table entries and weights that stand for the table at `end`, or for its mean over `pixel` texels around it.
fn blend(end: f32, pixel: f32) -> Vec<(f32, f32)> {
    let ramp = |t: f32| {
        let inside = t.clamp(0.0, 1.0);
        0.5 * inside * inside + (t - 1.0).max(0.0)
    };
    let start = end - 0.5 * pixel;
    let first = start.floor();
    let before = |k: usize| {
        let t = start - first - k as f32;
        if pixel > 0.0 { (ramp(t + pixel) - ramp(t)) / pixel } else { t.clamp(0.0, 1.0) }
    };
    let count = pixel.ceil() as usize + 1;
    let share = |k: usize| {
        if k == 0 {
            1.0
        } else if k > count {
            0.0
        } else {
            before(k - 1)
        }
    };
    (0..=count).map(|k| (first + k as f32, share(k) - share(k + 1))).collect()
}
