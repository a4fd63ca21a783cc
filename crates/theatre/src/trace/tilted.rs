//! Planes that are not parallel to the screen: every pixel sees them through a perspective map of its own.
//!
//! Let P₀ and Q₀ be the middles of pixel and emitter, X₀ where P₀Q₀ meets the plane, a share r of the way along, p and q
//! a sample's displacements within pixel and emitter, m = (1 − r) p + r q, n the plane's normal. Then PQ meets the plane at
//!
//! > X₀ + m − (n·m) / (n·w) · w,  w = Q₀ − P₀ + q − p,
//!
//! in which everything is as small as m: f32 loses nothing, however far the grid's origin. Where the plane's horizon is in
//! sight X₀ may be anywhere, so P₀ takes its place: r = 0 and P₀ + m + (n·(X_c − P₀) − n·m) / (n·w) · w, with X_c the
//! plane's centre. The dome's directions (x, y, −1) are the same with w in place of Q₀ − P₀ + q − p.

use glam::{DMat3, DVec2, DVec3};
use kelir_frame::View;
use kelir_scene::{Plane, Theatre};

use super::axis::{Axis, pixel_sides};
use super::bounds::Range;
use crate::project;

/// One tilted plane as one source lights it.
pub(crate) struct Tilted {
    /// Texels per metre along the grid's x, as a vector in space (z is not needed).
    pub right: [f32; 2],
    /// Texels per metre along the grid's y, downwards.
    pub down: [f32; 2],
    /// The plane's normal.
    pub normal: [f32; 2],
    /// Sides of the emitter in metres; for the dome 1 a unit of tangent.
    pub emitter: [f32; 2],
    /// Sides of the pixel in metres; 0 for `centre`.
    pub pixel: [f32; 2],
    /// Whether the source is the dome.
    pub dome: bool,
    exact: Exact,
}

/// The same in f64, for each pixel's own numbers.
struct Exact {
    right: DVec3,
    down: DVec3,
    normal: DVec3,
    centre: DVec3,
    lamp: DVec3,
    emitter: [f64; 2],
    pixel: [f64; 2],
    texels: [usize; 2],
    screen: kelir_scene::Screen,
    size: [usize; 2],
}

/// What one pixel adds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seen {
    /// Along the grid's x.
    pub x: Axis,
    /// Along the grid's y.
    pub y: Axis,
    /// r.
    pub ratio: f32,
    /// n·(X_c − P₀) where r = 0, else 0.
    pub rest: f32,
    /// n·(Q₀ − P₀); for the dome −n_z.
    pub depth: f32,
    /// Q₀ − P₀ along `right` and `down`; for the dome their −z.
    pub along: [f32; 2],
}

impl Tilted {
    /// `size_m` are the emitter's full sides, `None` for the dome.
    pub(crate) fn new(theatre: &Theatre, view: &View, size_m: Option<[f64; 2]>, plane: &Plane) -> Self {
        let [about_x, about_y] = plane.tilt_deg.map(f64::to_radians);
        let turn = DMat3::from_rotation_y(about_y) * DMat3::from_rotation_x(about_x);
        let texels = [plane.mask.width, plane.mask.height];
        let exact = Exact {
            right: turn.x_axis * (texels[0] as f64 / plane.size_m[0]),
            down: -turn.y_axis * (texels[1] as f64 / plane.size_m[1]),
            normal: turn.z_axis,
            centre: plane.centre_m,
            lamp: theatre.lamp.position_m,
            emitter: size_m.unwrap_or([1.0; 2]),
            pixel: pixel_sides(&theatre.screen, view),
            texels,
            screen: theatre.screen.clone(),
            size: view.size,
        };
        let narrow = |v: DVec3| [v.x as f32, v.y as f32];
        Self {
            right: narrow(exact.right),
            down: narrow(exact.down),
            normal: narrow(exact.normal),
            emitter: exact.emitter.map(|v| v as f32),
            pixel: exact.pixel.map(|v| v as f32),
            dome: size_m.is_none(),
            exact,
        }
    }

    /// Every padded texel that samples of pixel (i, j) can fall on.
    pub(crate) fn range(&self, i: usize, j: usize) -> (Range, Range) {
        let seen = self.seen(i, j);
        (seen.x.range, seen.y.range)
    }

    /// The numbers of pixel (i, j).
    pub(crate) fn seen(&self, i: usize, j: usize) -> Seen {
        let e = &self.exact;
        let p = project::pixel_m(&e.screen, e.size, i as f64, j as f64).extend(0.0);
        let grid = |x: DVec3| {
            let [w, h] = e.texels.map(|n| 0.5 * n as f64);
            DVec2::new(e.right.dot(x - e.centre) + w, e.down.dot(x - e.centre) + h)
        };
        let everything = [DVec2::splat(f64::NEG_INFINITY), DVec2::splat(f64::INFINITY)];
        let axes = |centre: DVec2, [from, to]: [DVec2; 2]| {
            (Axis::new(centre.x, from.x, to.x, e.texels[0]), Axis::new(centre.y, from.y, to.y, e.texels[1]))
        };
        let from_screen = |way: DVec3| {
            let (x, y) = axes(grid(p), everything);
            Seen {
                x,
                y,
                ratio: 0.0,
                rest: e.normal.dot(e.centre - p) as f32,
                depth: e.normal.dot(way) as f32,
                along: [e.right.dot(way) as f32, e.down.dot(way) as f32],
            }
        };
        if self.dome {
            return from_screen(-DVec3::Z);
        }
        let way = e.lamp - p;
        let depth = e.normal.dot(way);
        let ratio = e.normal.dot(e.centre - p) / depth;
        let centre = grid(p + ratio * way);
        // Between corners both maps are projective, so corners bound the box, unless the plane's horizon is in sight.
        let (mut from, mut to, mut horizon) = (centre, centre, !centre.is_finite());
        for k in 0..16 {
            let half = |bit: u32, side: f64| if k >> bit & 1 == 0 { -0.5 * side } else { 0.5 * side };
            let q = e.lamp + DVec3::new(half(0, e.emitter[0]), half(1, e.emitter[1]), 0.0);
            let p = p + DVec3::new(half(2, e.pixel[0]), half(3, e.pixel[1]), 0.0);
            let d = e.normal.dot(q - p);
            horizon |= d * depth <= 0.0;
            let x = grid(p + e.normal.dot(e.centre - p) / d * (q - p));
            (from, to) = (from.min(x), to.max(x));
        }
        if horizon {
            return from_screen(way);
        }
        let (x, y) = axes(centre, [from, to]);
        let along = [e.right.dot(way) as f32, e.down.dot(way) as f32];
        Seen { x, y, ratio: ratio as f32, rest: 0.0, depth: depth as f32, along }
    }
}
