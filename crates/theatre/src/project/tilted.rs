//! A plane that is not parallel to the screen, seen from one piece of an emitter.
//!
//! What a point P of the screen sees of a piece is a quadrilateral on the plane. It is taken as the axis-parallel box around what P sees
//! of the piece's centre, with the sides that the piece's own axes span there; the smaller the pieces, the closer.

use glam::{DVec2, DVec3};
use kelir_scene::Plane;

use super::turned;

/// A rectangle of an emitter.
#[derive(Clone, Debug)]
pub struct Piece {
    /// Which emitter it belongs to.
    pub emitter: usize,
    /// Its centre, metres.
    pub centre_m: DVec3,
    /// Its full sides, metres.
    pub size_m: [f64; 2],
    /// Its share of its emitter's area.
    pub weight: f64,
}

/// The plane's frame in world and texel coordinates.
#[derive(Clone, Debug)]
pub struct PlaneFrame {
    /// The plane's centre, metres.
    pub centre_m: DVec3,
    /// Its unit normal.
    pub normal: DVec3,
    /// Texels per metre along u, as a vector.
    pub u: DVec3,
    /// Texels per metre *down* along v, likewise.
    pub v: DVec3,
    /// The centre in texels.
    pub middle: DVec2,
}

impl PlaneFrame {
    /// Of `plane`: `R_y(tilt[1]) · R_x(tilt[0])`.
    pub fn new(plane: &Plane) -> Self {
        let turn = |v: DVec3| turned(plane, v);
        let grid = DVec2::new(plane.mask.width as f64, plane.mask.height as f64);
        Self {
            centre_m: plane.centre_m,
            normal: turn(DVec3::Z),
            u: turn(DVec3::X) * (grid.x / plane.size_m[0]),
            v: turn(DVec3::NEG_Y) * (grid.y / plane.size_m[1]),
            middle: 0.5 * grid,
        }
    }

    /// Texel coordinates of where the ray from screen point `p_m` to `q_m` on the lamp's plane crosses the puppet's plane; None where a
    /// steep plane is not crossed between the two.
    pub fn texel(&self, p_m: DVec2, q_m: DVec3) -> Option<DVec2> {
        let p = p_m.extend(0.0);
        let ray = q_m - p;
        let way = self.normal.dot(self.centre_m - p) / self.normal.dot(ray);
        let x = p + ray * way - self.centre_m;
        (way > 0.0 && way < 1.0).then(|| self.middle + DVec2::new(x.dot(self.u), x.dot(self.v)))
    }

    /// The box that stands for what `p_m` sees of `piece`: centre and full sides, texels. None where it sees past the plane.
    pub fn seen(&self, piece: &Piece, p_m: DVec2) -> Option<(DVec2, DVec2)> {
        let at = |x: f64, y: f64| {
            let offset = DVec3::new(0.5 * x * piece.size_m[0], 0.5 * y * piece.size_m[1], 0.0);
            self.texel(p_m, piece.centre_m + offset)
        };
        let centre = at(0.0, 0.0)?;
        // Where one half of a piece sees past the plane, the other half says how large it is there.
        let side = |x: f64, y: f64| match (at(x, y), at(-x, -y)) {
            (Some(a), Some(b)) => (a - b).abs(),
            (Some(a), None) | (None, Some(a)) => 2.0 * (a - centre).abs(),
            (None, None) => DVec2::ZERO,
        };
        let sides = DVec2::new(side(1.0, 0.0).x, side(0.0, 1.0).y);
        sides.cmpgt(DVec2::ZERO).all().then_some((centre, sides))
    }

    /// Texels [x0, x1] × [y0, y1] that any point of the rectangle `p_m` sees `piece` through. Both maps, of screen points and of
    /// emitter points, are projective, so the corners' hull holds everything between; everything, where a corner sees past the plane.
    pub fn range(&self, p_m: [DVec2; 2], piece: &Piece) -> [DVec2; 2] {
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for k in 0..16 {
            let sign = |bit: usize| if k >> bit & 1 == 0 { -0.5 } else { 0.5 };
            let q = piece.centre_m + DVec3::new(sign(0) * piece.size_m[0], sign(1) * piece.size_m[1], 0.0);
            let p = DVec2::new(p_m[k >> 2 & 1].x, p_m[k >> 3 & 1].y);
            let Some(t) = self.texel(p, q) else { return [DVec2::splat(-1e9), DVec2::splat(1e9)] };
            (low, high) = (low.min(t), high.max(t));
        }
        [low, high]
    }
}
