//! What is exact cell by cell: a rectangle seen through planes parallel to the screen, whose texel grids overlay each other.

use glam::{DVec2, DVec3};
use kelir_scene::{EmitterShape, Plane, Theatre};

use crate::irradiance;

/// One emitter seen from one point, per channel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Visibility {
    /// Vgeo: mean transmittance over the emitter's area.
    pub geometric: [f64; 3],
    /// Virr: E / E⁰; over an area the mean of E over the mean of E⁰.
    pub irradiance: [f64; 3],
}

/// A plane's texel grid as lines on the lamp's plane, seen from one point.
pub(super) struct Grid<'a> {
    pub plane: &'a Plane,
    /// Emitter coordinates (lamp-centred metres) of texel lines x = 0, 1, …: `origin + step · line`.
    pub origin: DVec2,
    pub step: DVec2,
}

impl<'a> Grid<'a> {
    /// X on the puppet's plane projects from P to P + (X − P) · z_l / d.
    pub(super) fn new(plane: &'a Plane, lamp_m: DVec3, p: DVec2) -> Self {
        let grow = lamp_m.z / plane.centre_m.z;
        let corner = plane.centre_m.truncate() + 0.5 * DVec2::new(-plane.size_m[0], plane.size_m[1]);
        let texel = DVec2::new(
            plane.size_m[0] / plane.mask.width as f64,
            -plane.size_m[1] / plane.mask.height as f64,
        );
        Self { plane, origin: p + (corner - p) * grow - lamp_m.truncate(), step: texel * grow }
    }

    /// Appends the lines strictly inside ± `half` along one axis.
    fn lines(&self, axis: usize, half: f64, out: &mut Vec<f64>) {
        let count = [self.plane.mask.width, self.plane.mask.height][axis];
        let (origin, step) = (self.origin[axis], self.step[axis]);
        let mut ends = [(-half - origin) / step, (half - origin) / step];
        ends.sort_by(f64::total_cmp);
        let from = ends[0].floor().max(0.0) as usize;
        let to = ends[1].ceil().clamp(0.0, count as f64) as usize;
        out.extend((from..=to.max(from)).map(|k| origin + step * k as f64).filter(|x| x.abs() < half));
    }

    /// Texel that holds emitter coordinate `at` along `axis`; None outside the grid.
    pub(super) fn texel(&self, axis: usize, at: f64) -> Option<usize> {
        let count = [self.plane.mask.width, self.plane.mask.height][axis];
        let t = (at - self.origin[axis]) / self.step[axis];
        (t >= 0.0 && t < count as f64).then_some(t as usize)
    }
}

fn segments(grids: &[Grid], axis: usize, half: f64) -> Vec<[f64; 2]> {
    let mut lines = vec![-half, half];
    grids.iter().for_each(|g| g.lines(axis, half, &mut lines));
    lines.sort_by(f64::total_cmp);
    lines.windows(2).map(|w| [w[0], w[1]]).filter(|[a, b]| b > a).collect()
}

/// Both visibilities of the rectangle `shape` around `lamp` through planes parallel to the screen: cells of the overlaid grids.
pub(super) fn upright_at(theatre: &Theatre, shape: &EmitterShape, lamp: DVec3, p: DVec2) -> Visibility {
    let grids: Vec<Grid> = theatre.planes.iter().map(|plane| Grid::new(plane, lamp, p)).collect();
    let [a, b] = shape.half_extent_m();
    let (xs, ys) = (segments(&grids, 0, a), segments(&grids, 1, b));
    let columns: Vec<Vec<Option<usize>>> =
        xs.iter().map(|[x0, x1]| grids.iter().map(|g| g.texel(0, 0.5 * (x0 + x1))).collect()).collect();
    let mut result = Visibility::default();
    let whole = irradiance::unit(shape, lamp, p);
    let area_m2 = shape.area_m2();
    for [y0, y1] in ys {
        let rows: Vec<_> = grids.iter().map(|g| g.texel(1, 0.5 * (y0 + y1))).collect();
        for ([x0, x1], columns) in xs.iter().zip(&columns) {
            let mut tau = [1.0; 3];
            for ((grid, x), y) in grids.iter().zip(columns).zip(&rows) {
                if let (Some(x), Some(y)) = (x, y) {
                    (0..3).for_each(|c| tau[c] *= grid.plane.mask.transmittance(c, *x, *y));
                }
            }
            if tau == [0.0; 3] {
                continue;
            }
            let area = (x1 - x0) * (y1 - y0) / area_m2;
            let cell = EmitterShape::Rectangle { size_m: [x1 - x0, y1 - y0] };
            let centre = lamp + DVec3::new(0.5 * (x0 + x1), 0.5 * (y0 + y1), 0.0);
            let light = irradiance::unit(&cell, centre, p) / whole;
            for (c, tau) in tau.iter().enumerate() {
                result.geometric[c] += tau * area;
                result.irradiance[c] += tau * light;
            }
        }
    }
    result
}
