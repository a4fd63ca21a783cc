//! Outlines of shapes, in texels: curves as chords, strokes as what they cover.

use resvg::tiny_skia::{Path, PathBuilder, PathSegment, Point, Transform};
use resvg::usvg::Stroke;

/// How far a chord may lie from its curve, in texels.
const SAGITTA: f64 = 1.0 / 4096.0;
/// Chords of one curve at most.
const MOST_CHORDS: f64 = 65_536.0;
/// The stroker's own error is a quarter of its unit: so many units a texel, and a stroke's width.
const UNITS: [f64; 2] = [32.0, 32.0];
/// Units a texel at most: beyond, f32 coordinates have none to give.
const MOST_UNITS: f64 = 4096.0;

/// The shortest handle of a cubic that the stroker sees, in units: it takes the direction of an end from it, and makes noise of one that is nothing.
const LEAST_HANDLE: f32 = 0.25;

/// A map of the plane: `(a·x + c·y + e, b·x + d·y + f)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Affine(pub [f64; 6]);

impl Affine {
    /// First `inner`, then `self`.
    pub(super) fn after(&self, inner: Transform) -> Affine {
        let Affine([a, b, c, d, ..]) = *self;
        let [ia, ib, ic, id] = [inner.sx, inner.ky, inner.kx, inner.sy].map(f64::from);
        let [e, f] = self.apply([f64::from(inner.tx), f64::from(inner.ty)]);
        Affine([a * ia + c * ib, b * ia + d * ib, a * ic + c * id, b * ic + d * id, e, f])
    }

    pub(super) fn apply(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let Affine([a, b, c, d, e, f]) = *self;
        [a * x + c * y + e, b * x + d * y + f]
    }

    /// Lengths of the two axes' images.
    pub(super) fn scales(&self) -> [f64; 2] {
        let Affine([a, b, c, d, ..]) = *self;
        [a.hypot(b), c.hypot(d)]
    }

    /// For what reckons in f32, seen from the point `[x, y]`.
    pub(super) fn from(&self, [x, y]: [f64; 2]) -> Transform {
        let Affine([a, b, c, d, e, f]) = *self;
        let [a, b, c, d, e, f] = [a, b, c, d, e - x, f - y].map(|v| v as f32);
        Transform::from_row(a, b, c, d, e, f)
    }
}

/// A straight piece of an outline, from its upper end down.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    pub top: [f64; 2],
    pub bottom: [f64; 2],
    /// 1 where the outline runs down, −1 where it runs up; what lies level belongs to it as well, and winds about nothing.
    pub winding: i32,
}

impl Edge {
    /// Where it is at a height that it reaches.
    pub(super) fn x(&self, y: f64) -> f64 {
        let ([x0, y0], [x1, y1]) = (self.top, self.bottom);
        if y <= y0 {
            x0
        } else if y >= y1 {
            x1
        } else {
            (x0 + (x1 - x0) * ((y - y0) / (y1 - y0))).clamp(x0.min(x1), x0.max(x1))
        }
    }
}

/// The edges of a path mapped by `map`, as far as they lie between the heights 0 and `rows`; open pieces are closed, as filling does.
pub(super) fn edges(path: &Path, map: &Affine, rows: f64) -> Vec<Edge> {
    let mut edges = Vec::new();
    let mut push = |from: [f64; 2], to: [f64; 2]| {
        let (top, bottom) = if from[1] <= to[1] { (from, to) } else { (to, from) };
        let winding = i32::from(from[1] < to[1]) - i32::from(from[1] > to[1]);
        if from != to && bottom[1] > 0.0 && top[1] < rows {
            edges.push(Edge { top, bottom, winding });
        }
    };
    let at = |p: Point| map.apply([f64::from(p.x), f64::from(p.y)]);
    let (mut start, mut last) = ([0.0; 2], [0.0; 2]);
    for segment in path.segments() {
        match segment {
            PathSegment::MoveTo(p) => {
                push(last, start);
                (start, last) = (at(p), at(p));
            }
            PathSegment::LineTo(p) => {
                push(last, at(p));
                last = at(p);
            }
            PathSegment::QuadTo(a, p) => {
                chords(&[last, at(a), at(p)], &mut push);
                last = at(p);
            }
            PathSegment::CubicTo(a, b, p) => {
                chords(&[last, at(a), at(b), at(p)], &mut push);
                last = at(p);
            }
            PathSegment::Close => {
                push(last, start);
                last = start;
            }
        }
    }
    push(last, start);
    edges
}

/// Hands out the chords of a Bézier curve: so many that none is further than [`SAGITTA`] from it (Wang's bound).
fn chords<const N: usize>(control: &[[f64; 2]; N], push: &mut impl FnMut([f64; 2], [f64; 2])) {
    let bend = control.windows(3).map(|w| {
        let [x, y] = [0, 1].map(|k| w[0][k] - 2.0 * w[1][k] + w[2][k]);
        x.hypot(y)
    });
    let degree = (N - 1) as f64;
    let bound = degree * (degree - 1.0) / 8.0 * bend.fold(0.0, f64::max) / SAGITTA;
    let count = bound.sqrt().ceil().clamp(1.0, MOST_CHORDS);
    let mut from = control[0];
    for k in 1..=count as usize {
        let to = if k as f64 == count { control[N - 1] } else { point(*control, k as f64 / count) };
        push(from, to);
        from = to;
    }
}

/// A point of a Bézier curve, by de Casteljau.
fn point<const N: usize>(mut control: [[f64; 2]; N], t: f64) -> [f64; 2] {
    for left in (1..N).rev() {
        for k in 0..left {
            control[k] = [0, 1].map(|axis| control[k][axis] + t * (control[k + 1][axis] - control[k][axis]));
        }
    }
    control[0]
}

/// What a stroke covers, and the map from there to texels. It is made in a space so fine that neither its curves nor its round ends are off by more
/// than a hundredth of a texel and of its width.
pub(super) fn stroked(path: &Path, stroke: &Stroke, map: &Affine) -> Option<(Path, Affine)> {
    let [x, y] = map.scales();
    let width = f64::from(stroke.width().get()) * x.min(y);
    let units = UNITS[0].max(UNITS[1] / width).min(MOST_UNITS);
    let fine = (units * x.max(y)) as f32;
    let enlarge = Transform::from_scale(fine, fine);
    let mut pen = stroke.to_tiny_skia();
    pen.width *= fine;
    let dashed = match pen.dash.take() {
        Some(dash) => Some(path.dash(&dash, fine)?),
        None => None,
    };
    let enlarged = dashed.as_ref().unwrap_or(path).clone().transform(enlarge)?;
    let outline = with_handles(&enlarged)?.stroke(&pen, 1.0)?;
    Some((outline, map.after(Transform::from_scale(1.0 / fine, 1.0 / fine))))
}

/// The path with no handle shorter than [`LEAST_HANDLE`] beside one that is longer: it is drawn out towards the other.
fn with_handles(path: &Path) -> Option<Path> {
    let drawn_out = |end: Point, handle: Point, other: Point| {
        let towards = other - end;
        if handle.distance(end) >= LEAST_HANDLE || towards.length() <= LEAST_HANDLE {
            return handle;
        }
        let share = LEAST_HANDLE / towards.length();
        Point::from_xy(end.x + share * towards.x, end.y + share * towards.y)
    };
    let (mut builder, mut last) = (PathBuilder::new(), Point::zero());
    for segment in path.segments() {
        match segment {
            PathSegment::MoveTo(p) => builder.move_to(p.x, p.y),
            PathSegment::LineTo(p) => builder.line_to(p.x, p.y),
            PathSegment::QuadTo(a, p) => builder.quad_to(a.x, a.y, p.x, p.y),
            PathSegment::CubicTo(a, b, p) => {
                let [a, b] = [drawn_out(last, a, b), drawn_out(p, b, a)];
                builder.cubic_to(a.x, a.y, b.x, b.y, p.x, p.y);
            }
            PathSegment::Close => builder.close(),
        }
        last = builder.last_point().unwrap_or(last);
    }
    builder.finish()
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that fails here says where")]
mod tests {
    use super::*;
    use crate::puppet::svg::raster::area::{Desk, Shape};
    use resvg::usvg::{FillRule, Node, Options, Tree};

    const SIDE: usize = 48;

    /// From user units to the grid, with the middle of a curve in the grid's.
    fn map(control: &[[f64; 2]; 4], scale: f64) -> Affine {
        let [x, y] = point(*control, 0.5);
        let middle = 0.5 * SIDE as f64;
        Affine([scale, 0.0, 0.0, scale, middle - scale * x, middle - scale * y])
    }

    /// Shares of texels that the round stroke of a curve and of a line from its end covers, row by row.
    fn shares(control: &[[f64; 2]; 4], to: [f64; 2], width: f64, scale: f64) -> Vec<f32> {
        let [a, b, c, d, e] =
            [control[0], control[1], control[2], control[3], to].map(|[x, y]| format!("{x} {y}"));
        let svg = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 900 900'><path d='M{a}C{b} {c} {d}L{e}' fill='none' \
             stroke='#000' stroke-width='{width}' stroke-linecap='round' stroke-linejoin='round'/></svg>"
        );
        let tree = Tree::from_str(&svg, &Options::default()).unwrap();
        let [Node::Path(path)] = tree.root().children() else { panic!("one path") };
        let (outline, map) = stroked(path.data(), path.stroke().unwrap(), &map(control, scale)).unwrap();
        let shape = Shape::new(edges(&outline, &map, SIDE as f64), FillRule::NonZero, [SIDE, SIDE]).unwrap();
        let mut desk = Desk::default();
        (0..SIDE).flat_map(|row| desk.cover(&[&shape.crossing(row)], &(0..SIDE)).to_vec()).collect()
    }

    /// The same by its definition, a round stroke being all that is no further than half its width from its path: 8 × 8 points a texel
    /// that its edge may cross, and 400 of curve and line each.
    fn near(control: &[[f64; 2]; 4], to: [f64; 2], width: f64, scale: f64) -> Vec<f32> {
        let map = map(control, scale);
        let shares = || (0..=400).map(|k| f64::from(k) / 400.0);
        let line = shares().map(|t| point([control[3], to], t));
        let curve: Vec<[f64; 2]> =
            shares().map(|t| point(*control, t)).chain(line).map(|p| map.apply(p)).collect();
        let distance =
            |[x, y]: [f64; 2]| curve.iter().map(|[a, b]| (x - a).hypot(y - b)).fold(f64::INFINITY, f64::min);
        let half = 0.5 * width * scale;
        let share = |(x, y): (usize, usize)| {
            let inside = half - distance([x as f64 + 0.5, y as f64 + 0.5]);
            if inside.abs() > 0.8 {
                return f32::from(u8::from(inside > 0.0));
            }
            let at = |texel: usize, k: usize| texel as f64 + (k as f64 + 0.5) / 8.0;
            let points = (0..64).filter(|k| distance([at(x, k % 8), at(y, k / 8)]) <= half);
            points.count() as f32 / 64.0
        };
        (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (x, y))).map(share).collect()
    }

    /// A handle that is nothing leaves a stroke whole: drawings have them where a node is a corner on one side.
    #[test]
    fn curves_without_a_handle_are_stroked() {
        let [from, bend, to] = [[225.28125, 91.875], [229.06104, 111.38959], [206.375, 112.46875]];
        for k in 0..24 {
            // What the stroker made of it was chance, by the last bit of a coordinate: here at one scale in six.
            let scale = 256.0 / f64::from(1600.0f32 / 3.0) + 0.003 * f64::from(k);
            for (control, to) in [
                ([from, bend, to, to], [to[0] - 40.0, to[1]]),
                ([to, to, bend, from], [from[0], from[1] - 40.0]),
            ] {
                let found = shares(&control, to, 12.5, scale);
                let expected = near(&control, to, 12.5, scale);
                let worst = found.iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
                assert!(worst < 0.1, "{worst} at {scale}: {control:?}");
            }
        }
    }
}
