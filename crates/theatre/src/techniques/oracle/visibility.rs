//! Exact visibilities at one point, and means over one pixel.

use glam::{DVec2, DVec3};
use kelir_frame::{Pixel, View};
use kelir_scene::{EmitterShape, Theatre};

use super::pieces;
use super::upright::{Grid, Visibility, upright_at};
use crate::{irradiance, project::pixel_m};

/// Most pieces that a pixel is cut into.
const MOST_PIECES: usize = 1 << 10;

/// Where on the screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Point {
    /// A point, metres.
    At(DVec2),
    /// The mean over a rectangle given by its centre and full sides, metres.
    Over(DVec2, DVec2),
}

impl Point {
    /// Pixel (i, j) of `view`, by its rule.
    pub fn pixel(theatre: &Theatre, view: &View, i: usize, j: usize) -> Self {
        let at = pixel_m(&theatre.screen, view.size, i as f64, j as f64);
        match view.pixel {
            Pixel::Centre => Self::At(at),
            Pixel::Area => Self::Over(
                at,
                DVec2::new(
                    theatre.screen.width_m / view.size[0] as f64,
                    theatre.screen.height_m / view.size[1] as f64,
                ),
            ),
        }
    }
}

/// Both visibilities of emitter `e` at a point.
fn at(theatre: &Theatre, e: usize, p: DVec2, tolerance: f64) -> Visibility {
    let (lamp, shape) = (theatre.lamp.position_m, theatre.lamp.emitters[e].shape);
    let upright = theatre.planes.iter().all(|plane| plane.tilt_deg == [0.0; 2]);
    match shape {
        EmitterShape::Rectangle { .. } if upright => upright_at(theatre, &shape, lamp, p),
        _ => pieces::at(theatre, &shape, p, tolerance, upright),
    }
}

/// ∫ over [from, to] of |[t − h, t + h] ∩ [−p/2, p/2]| / p: a texel's overlap with a box of half-side `h`, averaged over a pixel of
/// width `p` (0 for a point); everything relative to the box's mean centre. The integrand is a trapezoid; no term is the small difference
/// of large ones.
fn mean_overlap(from: f64, to: f64, h: f64, p: f64) -> f64 {
    if p == 0.0 {
        return (to.min(h) - from.max(-h)).max(0.0);
    }
    let (top, outer, inner) = ((2.0 * h).min(p), 0.5 * p + h, (0.5 * p - h).abs());
    let height = |t: f64| ((outer - t.abs()) / top).clamp(0.0, 1.0) * top / p;
    let mut ends = [from, to, -outer, -inner, inner, outer].map(|t| t.clamp(from, to));
    ends.sort_by(f64::total_cmp);
    ends.windows(2).map(|w| (w[1] - w[0]) * 0.5 * (height(w[0]) + height(w[1]))).sum()
}

/// Geometric visibility through one plane, averaged over a pixel of `sides` (0 for a point): overlaps of texels and box as ramps.
fn over_one_plane(theatre: &Theatre, e: usize, centre: DVec2, sides: DVec2) -> [f64; 3] {
    let (lamp, plane) = (theatre.lamp.position_m, &theatre.planes[0]);
    let ratio = plane.centre_m.z / lamp.z;
    let box_centre = centre * (1.0 - ratio) + lamp.truncate() * ratio - plane.centre_m.truncate();
    let pixel = sides * (1.0 - ratio);
    let half = DVec2::from(theatre.lamp.emitters[e].shape.half_extent_m()) * ratio;
    let weights = |axis: usize, count: usize, flip: f64| -> Vec<(usize, f64)> {
        let texel = plane.size_m[axis] / count as f64;
        (0..count)
            .filter_map(|k| {
                // Measured from the box's centre.
                let from = (k as f64 * texel - 0.5 * plane.size_m[axis]) - flip * box_centre[axis];
                let to = from + texel;
                let overlap = mean_overlap(from, to, half[axis], pixel[axis]);
                (overlap > 0.0).then_some((k, overlap / (2.0 * half[axis])))
            })
            .collect()
    };
    let (xs, ys) = (weights(0, plane.mask.width, 1.0), weights(1, plane.mask.height, -1.0));
    let mut shadow = [0.0; 3];
    for (c, shadow) in shadow.iter_mut().enumerate().take(plane.mask.channels) {
        let opacity = |x: usize, y: usize| 1.0 - plane.mask.transmittance(c, x, y);
        let row = |(y, wy): &(usize, f64)| xs.iter().map(|(x, wx)| wx * opacity(*x, *y)).sum::<f64>() * wy;
        *shadow = ys.iter().map(row).sum();
    }
    [0, 1, 2].map(|c| 1.0 - shadow[c % plane.mask.channels])
}

/// Whether the mean opacity in a box says it all: a rectangle behind one upright plane.
fn is_one_box(theatre: &Theatre, e: usize) -> bool {
    let rectangle = matches!(theatre.lamp.emitters[e].shape, EmitterShape::Rectangle { .. });
    rectangle && matches!(&theatre.planes[..], [plane] if plane.tilt_deg == [0.0; 2])
}

/// Geometric visibility of emitter `e` alone, per channel: a finite sum through one upright plane, else as [`visibility`] gives it.
pub fn geometric(theatre: &Theatre, e: usize, point: Point, tolerance: f64) -> [f64; 3] {
    match point {
        Point::At(p) if is_one_box(theatre, e) => over_one_plane(theatre, e, p, DVec2::ZERO),
        Point::Over(centre, sides) if is_one_box(theatre, e) => over_one_plane(theatre, e, centre, sides),
        _ => visibility(theatre, e, point, tolerance).geometric,
    }
}

/// Where, along one axis of a pixel (0..1), what a point sees changes its course: where a texel line crosses the emitter's edge
/// or a line of another plane. Between two such places both visibilities are smooth. The grids are of the pixel's low and high end.
fn kinks(low: &[Grid], high: &[Grid], axis: usize, half: f64) -> Vec<f64> {
    let mut places = vec![0.0, 1.0];
    let whole = |a: f64, b: f64, count: usize| {
        let end = |t: f64| t.clamp(-1.0, count as f64 + 1.0);
        end(a.min(b)).ceil() as i64..=end(a.max(b)).floor() as i64
    };
    let texels = |grid: &Grid| [grid.plane.mask.width, grid.plane.mask.height][axis];
    for (i, (from, to)) in low.iter().zip(high).enumerate() {
        let (step, start, run) = (from.step[axis], from.origin[axis], to.origin[axis] - from.origin[axis]);
        let line_at = |edge: f64, origin: f64| (edge - origin) / step;
        let mut ends = Vec::new();
        for edge in [-half, half] {
            let (first, last) = (line_at(edge, start), line_at(edge, start + run));
            places.extend(whole(first, last, texels(from)).map(|k| (edge - start - step * k as f64) / run));
            ends.extend([first, last]);
        }
        ends.sort_by(f64::total_cmp);
        for (other, moved) in low[i + 1..].iter().zip(&high[i + 1..]) {
            for k in whole(ends[0], ends[3], texels(from)) {
                let at = start + step * k as f64;
                let first = (at - other.origin[axis]) / other.step[axis];
                let last = (at + run - moved.origin[axis]) / moved.step[axis];
                places.extend(whole(first, last, texels(other)).map(|l| (l as f64 - first) / (last - first)));
            }
        }
    }
    places.retain(|t| (0.0..=1.0).contains(t));
    places.sort_by(f64::total_cmp);
    places.dedup_by(|a, b| *a - *b < 1e-12);
    places
}

/// Sums over points of a pixel: of their shares, and in these of the geometric visibility, of E and of E⁰.
#[derive(Default)]
struct Sums {
    share: f64,
    geometric: [f64; 3],
    light: [f64; 3],
    unit: f64,
}

impl Sums {
    fn add(&mut self, share: f64, v: &Visibility, unit: f64) {
        self.share += share;
        self.unit += share * unit;
        for c in 0..3 {
            self.geometric[c] += share * v.geometric[c];
            self.light[c] += share * unit * v.irradiance[c];
        }
    }

    fn mean(&self) -> Visibility {
        Visibility {
            geometric: self.geometric.map(|g| g / self.share),
            irradiance: self.light.map(|e| e / self.unit),
        }
    }
}

/// Visibilities of emitter `e`; what is no finite sum (disks and tilted planes; pixels in which hundreds of texel lines come and go) to
/// `tolerance`.
pub fn visibility(theatre: &Theatre, e: usize, point: Point, tolerance: f64) -> Visibility {
    let (centre, sides) = match point {
        Point::At(p) => return at(theatre, e, p, tolerance),
        Point::Over(centre, sides) => (centre, sides),
    };
    let (lamp, shape) = (theatre.lamp.position_m, theatre.lamp.emitters[e].shape);
    let seen = |sums: &mut Sums, p: DVec2, share: f64| {
        sums.add(share, &at(theatre, e, p, tolerance), irradiance::unit(&shape, lamp, p));
    };
    let upright = theatre.planes.iter().all(|plane| plane.tilt_deg == [0.0; 2]);
    if upright && matches!(shape, EmitterShape::Rectangle { .. }) {
        let grids =
            |p: DVec2| theatre.planes.iter().map(|plane| Grid::new(plane, lamp, p)).collect::<Vec<_>>();
        let low = centre - 0.5 * sides;
        let (from, to) = (grids(low), grids(low + sides));
        let [xs, ys] = [0, 1].map(|axis| kinks(&from, &to, axis, shape.half_extent_m()[axis]));
        if xs.len() * ys.len() <= MOST_PIECES {
            // Two Gauss points a side of each piece: exact for cubics, and the pieces are all but bilinear.
            let mut sums = Sums::default();
            for y in ys.windows(2) {
                for x in xs.windows(2) {
                    let (from, size) = (DVec2::new(x[0], y[0]), DVec2::new(x[1] - x[0], y[1] - y[0]));
                    for corner in [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)] {
                        let at = from + size * (0.5 + 0.5 / 3f64.sqrt() * DVec2::from(corner));
                        seen(&mut sums, low + at * sides, 0.25 * size.x * size.y);
                    }
                }
            }
            return sums.mean();
        }
    }
    let mean = |n: usize| {
        let mut sums = Sums::default();
        for k in 0..n * n {
            let part = (DVec2::new((k % n) as f64, (k / n) as f64) + 0.5) / n as f64 - 0.5;
            seen(&mut sums, centre + part * sides, 1.0);
        }
        sums.mean()
    };
    // A coarse lattice can miss every kink, and two such levels agree by chance.
    let mut n = 8;
    let mut result = mean(4);
    loop {
        let finer = mean(n);
        let change = (0..3).fold(0f64, |m, c| {
            m.max((finer.geometric[c] - result.geometric[c]).abs())
                .max((finer.irradiance[c] - result.irradiance[c]).abs())
        });
        result = finer;
        if change < tolerance || n >= 64 {
            break;
        }
        n *= 2;
    }
    if is_one_box(theatre, e) {
        result.geometric = over_one_plane(theatre, e, centre, sides);
    }
    result
}

/// Share of a uniform dome's irradiance, per channel, that planes parallel to the screen let through to `p`: their grids laid over
/// each other on a plane at unit distance, each cell weighed by Lambert's formula.
pub fn dome(theatre: &Theatre, p: DVec2) -> [f64; 3] {
    let lamp = DVec3::new(p.x, p.y, -1.0);
    let grids: Vec<Grid> = theatre.planes.iter().map(|plane| Grid::new(plane, lamp, p)).collect();
    let lines = |axis: usize| {
        let mut lines = Vec::new();
        for g in &grids {
            let count = [g.plane.mask.width, g.plane.mask.height][axis];
            lines.extend((0..=count).map(|k| g.origin[axis] + g.step[axis] * k as f64));
        }
        lines.sort_by(f64::total_cmp);
        lines
    };
    let mut through = [1.0; 3];
    let (xs, ys) = (lines(0), lines(1));
    for y in ys.windows(2).filter(|w| w[1] > w[0]) {
        let rows: Vec<_> = grids.iter().map(|g| g.texel(1, 0.5 * (y[0] + y[1]))).collect();
        for x in xs.windows(2).filter(|w| w[1] > w[0]) {
            let mut tau = [1.0; 3];
            for (g, row) in grids.iter().zip(&rows) {
                if let (Some(i), Some(j)) = (g.texel(0, 0.5 * (x[0] + x[1])), row) {
                    (0..3).for_each(|c| tau[c] *= g.plane.mask.transmittance(c, i, *j));
                }
            }
            if tau == [1.0; 3] {
                continue;
            }
            let middle = DVec2::new(0.5 * (x[0] + x[1]), 0.5 * (y[0] + y[1]));
            let cell = irradiance::lambert(middle, 0.5 * (x[1] - x[0]), 0.5 * (y[1] - y[0]), 1.0);
            for (through, tau) in through.iter_mut().zip(tau) {
                *through -= (1.0 - tau) * cell / std::f64::consts::PI;
            }
        }
    }
    through
}
