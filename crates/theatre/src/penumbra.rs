//! Which pixels are in penumbra: those whose box on some plane spans texels of different transmittance.

use glam::DVec2;
use kelir_frame::{Pixel, View};
use kelir_scene::{Mask, Plane, Theatre};

use crate::project::tilted::{Piece, PlaneFrame};
use crate::project::window::Windows;
use crate::project::{ShadowBox, is_tilted, pixel_m};

/// Counts of neighbouring texels that differ, as prefix sums; the mask is framed by one clear texel.
struct Edges {
    /// Columns and rows with the frame.
    size: [usize; 2],
    /// Over pairs side by side: entry (x, y) counts pairs (i − 1, i) with i < x in rows above y.
    across: Vec<u32>,
    /// Over pairs one above the other, likewise.
    down: Vec<u32>,
}

impl Edges {
    fn new(mask: &Mask) -> Self {
        let size = [mask.width + 2, mask.height + 2];
        let [w, h] = size;
        let code = |x: usize, y: usize| {
            let inside = x > 0 && y > 0 && x + 1 < w && y + 1 < h;
            [0, 1, 2]
                .map(|c| if inside && c < mask.channels { mask.transmittance(c, x - 1, y - 1) } else { 1.0 })
        };
        let stride = w + 1;
        let (mut across, mut down) = (vec![0; stride * (h + 1)], vec![0; stride * (h + 1)]);
        let mut above = vec![code(0, 0); w];
        for y in 0..h {
            let (mut a, mut d) = (0, 0);
            let mut left = code(0, y);
            for x in 0..w {
                let here = code(x, y);
                a += u32::from(x > 0 && here != left);
                d += u32::from(y > 0 && here != above[x]);
                left = here;
                above[x] = here;
                across[(y + 1) * stride + x + 1] = across[y * stride + x + 1] + a;
                down[(y + 1) * stride + x + 1] = down[y * stride + x + 1] + d;
            }
        }
        Self { size, across, down }
    }

    /// Whether texels `x` × `y` (framed coordinates) differ anywhere.
    fn differ(&self, x: [usize; 2], y: [usize; 2]) -> bool {
        let count = |sums: &[u32], x: [usize; 2], y: [usize; 2]| {
            let at = |x: usize, y: usize| sums[y * (self.size[0] + 1) + x];
            x[1] > x[0] && y[1] > y[0] && at(x[1], y[1]) + at(x[0], y[0]) != at(x[0], y[1]) + at(x[1], y[0])
        };
        count(&self.across, [x[0] + 1, x[1]], y) || count(&self.down, x, [y[0] + 1, y[1]])
    }
}

/// One flag a pixel, row-major. Disks count as their bounding squares, and what a pixel sees of a tilted plane as the box around it: there
/// some pixels more are in.
pub fn mask(theatre: &Theatre, view: &View) -> Vec<bool> {
    let [w, h] = view.size;
    let mut out = vec![false; w * h];
    let half = theatre.lamp.emitters.iter().map(|e| DVec2::from(e.shape.half_extent_m()));
    let sides = 2.0 * half.fold(DVec2::ZERO, DVec2::max);
    for plane in &theatre.planes {
        if is_tilted(plane) {
            add_tilted(theatre, view, plane, sides, &mut out);
        } else {
            add(theatre, view, plane, sides, &mut out);
        }
    }
    out
}

fn add_tilted(theatre: &Theatre, view: &View, plane: &Plane, sides_m: DVec2, out: &mut [bool]) {
    let edges = Edges::new(&plane.mask);
    let frame = PlaneFrame::new(plane);
    let lamp = Piece { emitter: 0, centre_m: theatre.lamp.position_m, size_m: sides_m.into(), weight: 1.0 };
    let half = if view.pixel == Pixel::Area { 0.5 } else { 0.0 };
    let width = view.size[0];
    for (k, out) in out.iter_mut().enumerate() {
        let (i, j) = ((k % width) as f64, (k / width) as f64);
        let at = |d: f64| pixel_m(&theatre.screen, view.size, i + d, j + d);
        let [low, high] = frame.range([at(-half), at(half)], &lamp);
        // The frame of clear texels shifts the grid by one.
        let range = |low: f64, high: f64, n: usize| {
            [
                (low + 1.0).floor().clamp(0.0, n as f64) as usize,
                (high + 1.0).ceil().clamp(0.0, n as f64) as usize,
            ]
        };
        *out |= edges.differ(range(low.x, high.x, edges.size[0]), range(low.y, high.y, edges.size[1]));
    }
}

fn add(theatre: &Theatre, view: &View, plane: &Plane, sides_m: DVec2, out: &mut [bool]) {
    let edges = Edges::new(&plane.mask);
    let map = ShadowBox::new(plane, theatre.lamp.position_m);
    let at = |i: usize, j: usize| map.centre(pixel_m(&theatre.screen, view.size, i as f64, j as f64)) + 1.0;
    let sides = map.spread * sides_m;
    let pixel = if view.pixel == Pixel::Area { (at(1, 1) - at(0, 0)).abs() } else { DVec2::ZERO };
    let [w, h] = view.size;
    let x = Windows::new(w, |i| at(i, 0).x, sides.x, edges.size[0], pixel.x);
    let y = Windows::new(h, |j| at(0, j).y, sides.y, edges.size[1], pixel.y);
    let columns: Vec<_> = (0..w).map(|i| x.strictly_touched(i, edges.size[0])).collect();
    for j in 0..h {
        let rows = y.strictly_touched(j, edges.size[1]);
        for (i, columns) in columns.iter().enumerate() {
            out[j * w + i] |= edges.differ(*columns, rows);
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]
    use std::sync::Arc;

    use kelir_scene::{Albedo, Ambient, Emitter, EmitterShape, Exposure, Lamp, Screen, Texels};

    use super::*;
    use crate::pa;
    use kelir_frame::Renderer;

    /// Where visibility is strictly between dark and lit there is penumbra; for an opaque figure nowhere else.
    #[test]
    fn penumbra_is_where_visibility_is_between() {
        let texels = (0..40 * 40).map(|k: i32| {
            let (x, y) = (k % 40 - 20, k / 40 - 18);
            if x * x + y * y < 150 { 0 } else { 255 }
        });
        let mask = Mask::new(40, 40, 1, Texels::U8(texels.map(|t| t as u8).collect()));
        let theatre = Theatre {
            screen: Screen { width_m: 1.6, height_m: 0.9, albedo: Albedo::Uniform([0.8; 3]) },
            lamp: Lamp {
                position_m: glam::DVec3::new(0.0, 0.1, -1.5),
                emitters: vec![Emitter {
                    name: "lamp".into(),
                    shape: EmitterShape::Rectangle { size_m: [0.1, 0.1] },
                    radiance: [1.0; 3],
                }],
            },
            ambient: Ambient::None,
            planes: vec![Plane {
                mask: Arc::new(mask),
                centre_m: glam::DVec3::new(0.01, 0.02, -0.4),
                size_m: [0.5, 0.5],
                tilt_deg: [0.0; 2],
            }],
            exposure: Exposure::Auto,
        };
        let view = View { size: [160, 90], pixel: Pixel::Area, skip: true };
        let frame = pa::Native::new(pa::Knobs::default()).radiance(&theatre, &view).unwrap();
        let marked = super::mask(&theatre, &view);
        let mut seen = [0; 2];
        for (v, marked) in frame.visibilities[0].values.iter().zip(&marked) {
            assert_eq!(*v > 0.0 && *v < 1.0, *marked, "visibility {v}");
            seen[usize::from(*marked)] += 1;
        }
        assert!(seen[0] > 1000 && seen[1] > 500, "{seen:?}");
    }
}
