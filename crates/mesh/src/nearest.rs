//! The nearest point of a surface, by a tree of boxes.

use glam::DVec3;

use crate::Mesh;
use crate::topology::{is_drawable, is_flat};

/// Triangles of a leaf.
const LEAF: usize = 4;

/// A surface, ready to be asked for its nearest point. Triangles that can't be drawn or have no area are left out.
pub struct Surface {
    nodes: Vec<Node>,
    /// In the order of the leaves.
    triangles: Vec<[DVec3; 3]>,
    /// Which of the mesh's triangles they are.
    numbers: Vec<u32>,
}

struct Node {
    min: DVec3,
    max: DVec3,
    /// A leaf's first triangle, or the second child; the first child is the next node.
    at: u32,
    /// A leaf's triangles; 0 for an inner node.
    count: u32,
}

/// A point of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// Metres.
    pub point: DVec3,
    /// Its distance from where was asked, metres.
    pub distance: f64,
    /// Which of the mesh's triangles it lies in.
    pub triangle: u32,
    /// The corners' shares in it, which add up to 1.
    pub weights: [f64; 3],
}

impl Surface {
    /// Builds the tree: boxes halved at the median of the longest axis.
    pub fn new(mesh: &Mesh) -> Surface {
        let good = |t: &u32| {
            let triangle = mesh.triangles[*t as usize];
            is_drawable(mesh, triangle) && !is_flat(mesh, triangle)
        };
        let mut numbers: Vec<u32> = (0..mesh.triangles.len() as u32).filter(good).collect();
        let corners: Vec<[DVec3; 3]> =
            mesh.triangles.iter().map(|triangle| mesh.corners(*triangle).unwrap_or_default()).collect();
        let mut nodes = Vec::new();
        if !numbers.is_empty() {
            build(&mut nodes, &mut numbers, 0, &corners);
        }
        let triangles = numbers.iter().map(|number| corners[*number as usize]).collect();
        Surface { nodes, triangles, numbers }
    }

    /// The surface's point nearest to `from`, metres; `None` where it has none.
    pub fn nearest(&self, from: DVec3) -> Option<Nearest> {
        let mut best: Option<Nearest> = None;
        let mut least = f64::INFINITY;
        let mut open = Vec::with_capacity(64);
        open.extend(self.nodes.first().map(|root| (root.squared_distance(from), 0u32)));
        while let Some((distance, index)) = open.pop() {
            if distance >= least {
                continue;
            }
            let node = &self.nodes[index as usize];
            if node.count == 0 {
                let children = [index + 1, node.at]
                    .map(|child| (self.nodes[child as usize].squared_distance(from), child));
                // The nearer one is looked at first.
                let [near, far] =
                    if children[0].0 <= children[1].0 { children } else { [children[1], children[0]] };
                open.extend([far, near].into_iter().filter(|(distance, _)| *distance < least));
                continue;
            }
            for t in node.at as usize..(node.at + node.count) as usize {
                let (point, weights) = nearest_in(from, &self.triangles[t]);
                let squared = from.distance_squared(point);
                if squared < least {
                    least = squared;
                    best =
                        Some(Nearest { point, distance: squared.sqrt(), triangle: self.numbers[t], weights });
                }
            }
        }
        best
    }
}

impl Node {
    fn squared_distance(&self, from: DVec3) -> f64 {
        from.distance_squared(from.clamp(self.min, self.max))
    }
}

fn build(nodes: &mut Vec<Node>, numbers: &mut [u32], first: usize, corners: &[[DVec3; 3]]) {
    let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (mut low, mut high) = (min, max);
    let middle = |number: &u32| corners[*number as usize].iter().sum::<DVec3>();
    for number in numbers.iter() {
        for corner in corners[*number as usize] {
            (min, max) = (min.min(corner), max.max(corner));
        }
        (low, high) = (low.min(middle(number)), high.max(middle(number)));
    }
    let here = nodes.len();
    let (at, count) = (first as u32, numbers.len() as u32);
    nodes.push(Node { min, max, at, count });
    if numbers.len() <= LEAF {
        return;
    }
    let axis = (high - low).max_position();
    let half = numbers.len() / 2;
    numbers.select_nth_unstable_by(half, |a, b| middle(a)[axis].total_cmp(&middle(b)[axis]).then(a.cmp(b)));
    let (lower, upper) = numbers.split_at_mut(half);
    build(nodes, lower, first, corners);
    nodes[here].at = nodes.len() as u32;
    nodes[here].count = 0;
    build(nodes, upper, first + half, corners);
}

/// The triangle's point nearest to `p`, with the corners' shares in it (Ericson, Real-Time Collision Detection, 5.1.5).
fn nearest_in(p: DVec3, [a, b, c]: &[DVec3; 3]) -> (DVec3, [f64; 3]) {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return (*a, [1.0, 0.0, 0.0]);
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return (*b, [0.0, 1.0, 0.0]);
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let v = d1 / (d1 - d3);
        return (a + v * ab, [1.0 - v, v, 0.0]);
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return (*c, [0.0, 0.0, 1.0]);
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let w = d2 / (d2 - d6);
        return (a + w * ac, [1.0 - w, 0.0, w]);
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        let w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return (b + w * (c - b), [0.0, 1.0 - w, w]);
    }
    let (v, w) = (vb / (va + vb + vc), vc / (va + vb + vc));
    (a + v * ab + w * ac, [1.0 - v - w, v, w])
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]
    use super::*;
    use crate::mesh::vector;
    use crate::random::fraction;
    use crate::shapes::{ball, torus};

    fn anywhere(k: u64) -> DVec3 {
        DVec3::new(fraction(1, k), fraction(2, k), fraction(3, k)) * 8.0 - 4.0
    }

    #[test]
    fn the_tree_finds_what_looking_at_all_finds() {
        let mesh = torus(24, 12);
        let surface = Surface::new(&mesh);
        for k in 0..500 {
            let from = anywhere(k);
            let found = surface.nearest(from).unwrap();
            let all = mesh
                .triangles
                .iter()
                .map(|triangle| nearest_in(from, &mesh.corners(*triangle).unwrap()).0.distance(from));
            assert_eq!(found.distance, all.fold(f64::INFINITY, f64::min));
            // Its triangle and shares lead to it.
            let corners = mesh.corners(mesh.triangles[found.triangle as usize]).unwrap();
            let point: DVec3 =
                corners.iter().zip(found.weights).map(|(corner, weight)| *corner * weight).sum();
            assert!(point.distance(found.point) < 1e-12);
            assert!(found.weights.iter().all(|weight| *weight >= -1e-12));
        }
    }

    /// Against an oracle that knows no regions: the least of many points of the triangle.
    #[test]
    fn the_point_of_a_triangle_is_the_nearest_of_all_its_points() {
        for k in 0..200 {
            let triangle = [anywhere(4 * k), anywhere(4 * k + 1), anywhere(4 * k + 2)];
            let from = anywhere(4 * k + 3);
            let (point, _) = nearest_in(from, &triangle);
            let n = 60;
            let grid =
                (0..=n).flat_map(|i| (0..=n - i).map(move |j| (f64::from(i) / 60.0, f64::from(j) / 60.0)));
            let [a, b, c] = triangle;
            let least = grid
                .map(|(u, v)| (a + u * (b - a) + v * (c - a)).distance(from))
                .fold(f64::INFINITY, f64::min);
            let step = ((b - a).length() + (c - a).length()) / 60.0;
            let distance = point.distance(from);
            assert!(distance <= least + 1e-12 && distance >= least - step, "{distance} {least}");
        }
    }

    #[test]
    fn a_ball_is_as_far_as_its_radius_says() {
        let surface = Surface::new(&ball(1.0, 64));
        for k in 0..200 {
            let from = anywhere(k);
            let distance = surface.nearest(from).unwrap().distance;
            assert!((distance - (from.length() - 1.0).abs()).abs() < 4e-4, "{distance} at {from}");
        }
        assert!(Surface::new(&Mesh::default()).nearest(DVec3::ZERO).is_none());
        let flat = Mesh::new(vec![[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]], vec![[0, 1, 2], [0, 0, 9]]);
        assert!(Surface::new(&flat).nearest(vector([1.0; 3])).is_none());
    }
}
