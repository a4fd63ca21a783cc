//! Disks and tilted planes: the emitter cut into ever more pieces, each seen exactly through each plane.

use glam::{DVec2, DVec3};
use kelir_scene::{EmitterShape, Plane, Theatre};

use super::upright::{Visibility, upright_at};
use crate::irradiance;
use crate::project::turned;

/// A rectangle on the lamp's plane: centre relative to the lamp, half-sides, area that it stands for.
struct Piece {
    centre: DVec2,
    half: DVec2,
    area: f64,
}

/// n × n pieces of a rectangle, or 4 n × n of a disk: strips of equal angle (so that they are thin where the edge is steep), each as wide
/// as its own area asks.
fn cut(shape: &EmitterShape, n: usize) -> Vec<Piece> {
    let part = |i: usize, n: usize| (i as f64 + 0.5) / n as f64 - 0.5;
    match *shape {
        EmitterShape::Rectangle { size_m: [w, h] } => (0..n * n)
            .map(|k| Piece {
                centre: DVec2::new(part(k % n, n) * w, part(k / n, n) * h),
                half: DVec2::new(w, h) / (2 * n) as f64,
                area: w * h / (n * n) as f64,
            })
            .collect(),
        EmitterShape::Disk { radius_m: r } => {
            let strips = 4 * n;
            let edge = |j: usize| -r * (std::f64::consts::PI * j as f64 / strips as f64).cos();
            let below = |y: f64| {
                let t = (y / r).clamp(-1.0, 1.0);
                r * r * (t * (1.0 - t * t).sqrt() + t.asin())
            };
            let strip = |j: usize| {
                let (bottom, top) = (edge(j), edge(j + 1));
                let area = below(top) - below(bottom);
                let width = area / (top - bottom);
                (0..n).map(move |i| Piece {
                    centre: DVec2::new(part(i, n) * width, 0.5 * (bottom + top)),
                    half: DVec2::new(width / n as f64, top - bottom) * 0.5,
                    area: area / n as f64,
                })
            };
            (0..strips).flat_map(strip).collect()
        }
    }
}

/// Both visibilities of an emitter of any shape; pieces are halved until two levels differ by less than `tolerance`.
pub(super) fn at(
    theatre: &Theatre,
    shape: &EmitterShape,
    p: DVec2,
    tolerance: f64,
    upright: bool,
) -> Visibility {
    // One upright plane is exact in each piece: only the disk's edge is left to refine.
    let mut n = 1;
    let mut last = level(theatre, shape, p, n, upright);
    while n < 64 {
        n *= 2;
        let next = level(theatre, shape, p, n, upright);
        let change = (0..3).fold(0f64, |m, c| {
            m.max((next.geometric[c] - last.geometric[c]).abs())
                .max((next.irradiance[c] - last.irradiance[c]).abs())
        });
        last = next;
        if change < tolerance && n >= 4 {
            break;
        }
    }
    last
}

fn level(theatre: &Theatre, shape: &EmitterShape, p: DVec2, n: usize, upright: bool) -> Visibility {
    let lamp = theatre.lamp.position_m;
    let mut sum = Visibility::default();
    let (mut areas, mut lights) = (0.0, 0.0);
    for piece in cut(shape, n) {
        let rectangle = EmitterShape::Rectangle { size_m: (2.0 * piece.half).into() };
        let centre = lamp + piece.centre.extend(0.0);
        let light = irradiance::unit(&rectangle, centre, p);
        let seen = if upright {
            upright_at(theatre, &rectangle, centre, p)
        } else {
            let mut tau = [1.0; 3];
            for plane in &theatre.planes {
                let one = through(plane, centre, piece.half, p);
                (0..3).for_each(|c| tau[c] *= one[c]);
            }
            Visibility { geometric: tau, irradiance: tau }
        };
        for c in 0..3 {
            sum.geometric[c] += piece.area * seen.geometric[c];
            sum.irradiance[c] += light * seen.irradiance[c];
        }
        areas += piece.area;
        lights += light;
    }
    sum.geometric.iter_mut().for_each(|v| *v /= areas);
    sum.irradiance.iter_mut().for_each(|v| *v /= lights);
    sum
}

/// Mean transmittance of one plane over one piece: each texel projected onto the lamp's plane through `p`, clipped to the piece,
/// weighed by its area there.
fn through(plane: &Plane, centre: DVec3, half: DVec2, p: DVec2) -> [f64; 3] {
    let [w, h] = [plane.mask.width, plane.mask.height];
    let (u, v, normal) = (turned(plane, DVec3::X), turned(plane, DVec3::Y), turned(plane, DVec3::Z));
    let eye = p.extend(0.0);
    let size = DVec2::from(plane.size_m);
    // Which texels the piece's corners reach; a projective map keeps the hull.
    let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    for (sx, sy) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
        let ray = centre + DVec3::new(sx * half.x, sy * half.y, 0.0) - eye;
        let way = normal.dot(plane.centre_m - eye) / normal.dot(ray);
        if way <= 0.0 || way >= 1.0 {
            // A steep plane that this ray passes by: any texel may be seen by others.
            (low, high) = (DVec2::ZERO, DVec2::new(w as f64, h as f64));
            break;
        }
        let x = eye + ray * way - plane.centre_m;
        let t = (DVec2::new(x.dot(u), -x.dot(v)) / size + 0.5) * DVec2::new(w as f64, h as f64);
        (low, high) = (low.min(t), high.max(t));
    }
    let range = |low: f64, high: f64, n: usize| {
        (low.floor() - 1.0).clamp(0.0, n as f64) as usize..(high.ceil() + 1.0).clamp(0.0, n as f64) as usize
    };
    let corner = |i: usize, j: usize| {
        let uv = (DVec2::new(i as f64 / w as f64, j as f64 / h as f64) - 0.5) * size * DVec2::new(1.0, -1.0);
        let x = plane.centre_m + u * uv.x + v * uv.y;
        p + (x.truncate() - p) * (centre.z / x.z) - centre.truncate()
    };
    let whole = 4.0 * half.x * half.y;
    let mut tau = [1.0; 3];
    for j in range(low.y, high.y, h) {
        for i in range(low.x, high.x, w) {
            let quad = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
            let share = clipped_area(quad, half) / whole;
            for (c, tau) in tau.iter_mut().enumerate() {
                *tau -= share * (1.0 - plane.mask.transmittance(c, i, j));
            }
        }
    }
    tau
}

/// Area of a convex quadrilateral inside ± `half` (Sutherland & Hodgman, then the shoelace).
fn clipped_area(quad: [DVec2; 4], half: DVec2) -> f64 {
    let mut polygon = quad.to_vec();
    for (normal, limit) in
        [(DVec2::X, half.x), (DVec2::NEG_X, half.x), (DVec2::Y, half.y), (DVec2::NEG_Y, half.y)]
    {
        let inside = |q: DVec2| limit - normal.dot(q);
        let mut next = Vec::with_capacity(polygon.len() + 1);
        for (k, a) in polygon.iter().enumerate() {
            let b = polygon[(k + 1) % polygon.len()];
            let (da, db) = (inside(*a), inside(b));
            if da >= 0.0 {
                next.push(*a);
            }
            if (da > 0.0 && db < 0.0) || (da < 0.0 && db > 0.0) {
                next.push(*a + (b - *a) * (da / (da - db)));
            }
        }
        polygon = next;
        if polygon.is_empty() {
            return 0.0;
        }
    }
    let twice: f64 = (0..polygon.len()).map(|k| polygon[k].perp_dot(polygon[(k + 1) % polygon.len()])).sum();
    0.5 * twice.abs()
}
