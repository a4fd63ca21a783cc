//! Areas against points counted: clusters that are cut exactly, and those that need too many cuts.

#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

use super::*;

const SIDE: usize = 12;

/// Random numbers in [0, 1), the same each time (the constants of Knuth's MMIX).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// A closed polygon's edges.
fn edges(corners: &[[f64; 2]]) -> Vec<Edge> {
    let next = corners.iter().cycle().skip(1);
    let edge = |(from, to): (&[f64; 2], &[f64; 2])| {
        let winding = i32::from(from[1] < to[1]) - i32::from(from[1] > to[1]);
        let (top, bottom) = if from[1] <= to[1] { (*from, *to) } else { (*to, *from) };
        Edge { top, bottom, winding }
    };
    corners.iter().zip(next).map(edge).collect()
}

fn shape(corners: &[[f64; 2]], rule: FillRule) -> Shape {
    Shape::new(edges(corners), rule, [SIDE, SIDE]).unwrap()
}

/// The share of each texel that shapes cover together.
fn covered(shapes: &[&Shape]) -> Vec<f32> {
    let mut desk = Desk::default();
    let row = |row| {
        let crossings: Vec<Crossing> = shapes.iter().map(|shape| shape.crossing(row)).collect();
        desk.cover(&crossings.iter().collect::<Vec<_>>(), &(0..SIDE)).to_vec()
    };
    (0..SIDE).flat_map(row).collect()
}

/// Whether a point is in a polygon, by the winding of its corners about it: angles, where the rasteriser counts crossings.
fn holds(corners: &[[f64; 2]], rule: FillRule, [x, y]: [f64; 2]) -> bool {
    let mut turned = 0.0;
    for (k, [ax, ay]) in corners.iter().enumerate() {
        let [bx, by] = corners[(k + 1) % corners.len()];
        let (ax, ay, bx, by) = (ax - x, ay - y, bx - x, by - y);
        turned += f64::atan2(ax * by - ay * bx, ax * bx + ay * by);
    }
    let turns = (turned / std::f64::consts::TAU).round() as i64;
    if rule == FillRule::NonZero { turns != 0 } else { turns % 2 != 0 }
}

/// The share of each texel's points, `side` × `side` of them, that one of the polygons holds.
fn counted(polygons: &[&[[f64; 2]]], rule: FillRule, rows: Range<usize>, side: usize) -> Vec<f32> {
    let at = |texel: usize, k: usize| texel as f64 + (k as f64 + 0.5) / side as f64;
    let share = |(x, y): (usize, usize)| {
        let inside = |k: &usize| {
            let point = [at(x, k % side), at(y, k / side)];
            polygons.iter().any(|corners| holds(corners, rule, point))
        };
        (0..side * side).filter(inside).count() as f32 / (side * side) as f32
    };
    rows.flat_map(|y| (0..SIDE).map(move |x| (x, y))).map(share).collect()
}

fn worst(a: &[f32], b: &[f32]) -> f32 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

/// Polygons that cross themselves and each other, by both rules, alone and together.
#[test]
fn areas_are_what_points_say() {
    let mut random = Random(1);
    for (corners, rule) in [(3, FillRule::NonZero), (7, FillRule::NonZero), (7, FillRule::EvenOdd)] {
        for _ in 0..6 {
            let mut polygon = || -> Vec<[f64; 2]> {
                (0..corners).map(|_| [0, 1].map(|_| 14.0 * random.next() - 1.0)).collect()
            };
            let [a, b] = [polygon(), polygon()];
            let [first, second] = [shape(&a, rule), shape(&b, rule)];
            let alone = worst(&covered(&[&first]), &counted(&[&a], rule, 0..SIDE, 32));
            let together = worst(&covered(&[&first, &second]), &counted(&[&a, &b], rule, 0..SIDE, 32));
            assert!(alone < 0.03 && together < 0.03, "{alone} {together}: {a:?} {b:?}");
        }
    }
    // Control: another rule is noticed.
    let star: Vec<[f64; 2]> = (0..5)
        .map(|k| f64::from(k) * 0.8 * std::f64::consts::PI)
        .map(|t| [6.0 + 5.5 * t.cos(), 6.0 + 5.5 * t.sin()])
        .collect();
    let [filled, holed] = [FillRule::NonZero, FillRule::EvenOdd].map(|rule| covered(&[&shape(&star, rule)]));
    assert!(worst(&filled, &counted(&[&star], FillRule::NonZero, 0..SIDE, 32)) < 0.03);
    assert!(worst(&filled, &holed) == 1.0);
}

/// A comb whose `teeth` all lie in one row and lean over each other, so that its cuts are too many: each tooth ends at a height of its own.
fn comb(teeth: usize) -> Vec<[f64; 2]> {
    let mut random = Random(7);
    let mut corners = vec![[1.0, 5.0]];
    for k in 0..teeth {
        let x = 1.0 + 10.0 * k as f64 / teeth as f64;
        corners.push([x + 3.0 * random.next(), 5.02 + 0.96 * random.next()]);
        corners.push([x + 10.0 / teeth as f64, 5.0 + 0.01 * random.next()]);
    }
    corners
}

/// Cuts that the row's only cluster would need for each of its edges.
fn cuts(shape: &Shape, row: usize) -> f64 {
    let crossing = shape.crossing(row);
    assert_eq!(crossing.clusters.len(), 1);
    let mut heights: Vec<f64> =
        crossing.pieces.iter().flat_map(|p| [p.edge.top[1], p.edge.bottom[1]]).collect();
    heights.sort_unstable_by(f64::total_cmp);
    heights.dedup();
    let within = |piece: &Piece| {
        heights.iter().filter(|y| piece.edge.top[1] <= **y && **y < piece.edge.bottom[1]).count()
    };
    crossing.pieces.iter().map(within).sum::<usize>() as f64 / crossing.pieces.len() as f64
}

/// What needs more cuts than there are is sampled at 64 heights: as near as these are.
#[test]
fn too_many_cuts_are_heights() {
    for (teeth, exact) in [(20, true), (400, false)] {
        let corners = comb(teeth);
        for rule in [FillRule::NonZero, FillRule::EvenOdd] {
            let shape = shape(&corners, rule);
            assert_eq!(cuts(&shape, 5) <= CUTS as f64, exact, "{} cuts an edge", cuts(&shape, 5));
            let (found, expected) = (covered(&[&shape]), counted(&[&corners], rule, 5..6, 48));
            let found = &found[5 * SIDE..6 * SIDE];
            let difference = worst(found, &expected);
            assert!(difference < 0.03, "{difference} with {teeth} teeth: {found:?}, not {expected:?}");
        }
    }
}

/// Lines that cross each other all within one texel: the first 1,024 crossings are cut at, and what more there is ends neither the time nor the sum.
#[test]
fn crossings_without_end_end() {
    // A zigzag between the row's top and bottom, each line across all others' way: with n lines about n²/4 crossings.
    let zigzag = |lines: usize| -> Vec<[f64; 2]> {
        let mut random = Random(3);
        (0..lines).map(|k| [4.0 + 4.0 * random.next(), if k % 2 == 0 { 5.0 } else { 6.0 }]).collect()
    };
    for (lines, most) in [(20, 0.03), (300, 0.1)] {
        let corners = zigzag(lines);
        let crossed = (0..lines).flat_map(|a| (0..a).map(move |b| (a, b))).filter(|(a, b)| {
            let ends = |k: usize| {
                let (from, to) = (corners[k], corners[(k + 1) % lines]);
                if k.is_multiple_of(2) { [from[0], to[0]] } else { [to[0], from[0]] }
            };
            let ([a0, a1], [b0, b1]) = (ends(*a), ends(*b));
            (a0 - b0) * (a1 - b1) < 0.0
        });
        assert_eq!(crossed.count() > MOST_CROSSINGS as usize, lines == 300);
        let alike = |rule, most: f32| {
            let found = covered(&[&shape(&corners, rule)]);
            let difference = worst(&found[5 * SIDE..6 * SIDE], &counted(&[&corners], rule, 5..6, 32));
            assert!(difference < most, "{difference} with {lines} lines, {rule:?}");
            assert!(found.iter().all(|share| (0.0..=1.0).contains(share)));
        };
        alike(FillRule::NonZero, most);
        // Of so many layers, even and odd are no longer told apart: what comes out is a share, and no more.
        alike(FillRule::EvenOdd, if lines == 300 { 1.0 } else { most });
    }
}
