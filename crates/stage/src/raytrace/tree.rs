//! Triangles in a hierarchy of boxes, and sixteen rays through it.
//!
//! Watertight (Woop, Benthin & Wald 2013): triangles' corners are projected along the ray, one by one, so that all triangles around a corner or an edge
//! see it at the same place; on which side of an edge the ray passes is the sign of a difference of two products there, which rounding
//! can make zero but never wrong; and a ray on an edge hits both of its triangles. Triple products of corners and direction have no such property:
//! of ten million rays, a quarter of them aimed at corners or edges, 42,116 passed them. All is f64; triangles are stored as they came, in f32.

use std::time::Duration;

use glam::{DVec3, Vec3, Vec3A};
use kelir_frame::multiversion;
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::builder::build_bvh2;

use super::rays::{Hits, LANES, Lanes, NOTHING, Origin, Rays, split};

/// Triangles as rays look them up.
pub struct Tree {
    nodes: Vec<Node>,
    /// Corners, in the order of the leaves.
    corners: Vec<[Vec3; 3]>,
    /// What each was called.
    names: Vec<u32>,
}

/// A box with two nodes or some triangles in it.
#[derive(Clone, Copy)]
struct Node {
    low: Vec3,
    high: Vec3,
    /// The first of its triangles, or of its two nodes.
    first: u32,
    /// How many triangles; 0 where it has nodes.
    count: u32,
}

/// Deeper than any tree of 2³² triangles that is halved fairly; a tree that isn't gets a stack of its own.
const DEPTH: usize = 128;

/// By how much a box is left later than rounding could let it seem: it is entered rather than missed.
const SLACK: f64 = 1.0 + 1e-14;

impl Tree {
    /// A hierarchy of `triangles`, which name their corners in `positions` (metres) counter-clockwise as seen from outside.
    ///
    /// # Panics
    /// Where a triangle names no position; meshes are checked when they are read.
    pub fn new(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> Self {
        let corners: Vec<[Vec3; 3]> =
            triangles.iter().map(|t| t.map(|corner| Vec3::from(positions[corner as usize]))).collect();
        if corners.is_empty() {
            return Self { nodes: Vec::new(), corners, names: Vec::new() };
        }
        let bounds: Vec<Aabb> = corners
            .iter()
            .map(|&[a, b, c]| Aabb::new(Vec3A::from(a.min(b).min(c)), Vec3A::from(a.max(b).max(c))))
            .collect();
        let built = build_bvh2(&bounds, BvhBuildParams::fast_build(), &mut Duration::default());
        let nodes = built.nodes.iter().map(|node| Node {
            low: node.aabb.min.into(),
            high: node.aabb.max.into(),
            first: node.first_index,
            count: node.prim_count,
        });
        Self {
            nodes: nodes.collect(),
            corners: built.primitive_indices.iter().map(|&t| corners[t as usize]).collect(),
            names: built.primitive_indices,
        }
    }

    /// How many triangles it has.
    pub fn len(&self) -> usize {
        self.names.len()
    }

    /// Whether it has none.
    pub fn is_empty(&self) -> bool {
        self.names.is_empty()
    }

    /// The smallest box around all triangles, if there are any.
    pub fn bounds(&self) -> Option<[Vec3; 2]> {
        self.nodes.first().map(|root| [root.low, root.high])
    }

    /// What each ray hits first: nearer hits than those that `hits` has replace them. Of two at one distance, that of the lower name.
    pub fn first(&self, rays: &Rays, hits: &mut Hits) {
        match rays.origin {
            Origin::One(_) => first_from_one(self, rays, hits),
            Origin::Each(_) => first_from_each(self, rays, hits),
        }
    }

    /// Which rays hit anything: `hits` gets some triangle of those that do, not the first. What a ray of `hits` has hit already isn't looked for.
    pub fn any(&self, rays: &Rays, hits: &mut Hits) {
        match rays.origin {
            Origin::One(_) => any_from_one(self, rays, hits),
            Origin::Each(_) => any_from_each(self, rays, hits),
        }
    }
}

multiversion! { fn first_from_one(tree: &Tree, rays: &Rays, hits: &mut Hits) = first::<true>; }
multiversion! { fn first_from_each(tree: &Tree, rays: &Rays, hits: &mut Hits) = first::<false>; }
multiversion! { fn any_from_one(tree: &Tree, rays: &Rays, hits: &mut Hits) = any::<true>; }
multiversion! { fn any_from_each(tree: &Tree, rays: &Rays, hits: &mut Hits) = any::<false>; }

#[inline(always)]
fn first<const ONE: bool>(tree: &Tree, rays: &Rays, hits: &mut Hits) {
    for axis in 0..3 {
        if let Some(walk) = Walk::<ONE, false>::new(tree, rays, axis) {
            walk.run(hits);
        }
    }
}

#[inline(always)]
fn any<const ONE: bool>(tree: &Tree, rays: &Rays, hits: &mut Hits) {
    for axis in 0..3 {
        if let Some(walk) = Walk::<ONE, true>::new(tree, rays, axis) {
            walk.run(hits);
        }
    }
}

/// Rays that run along one axis more than along others, on their way through a tree, from `ONE` point or each from its own.
struct Walk<'a, const ONE: bool, const ANY: bool> {
    tree: &'a Tree,
    /// What everything is counted from, so that numbers stay small: where the first ray begins.
    here: DVec3,
    /// By how much rounding can move what is counted from there, metres.
    pad: f64,
    /// Where each begins, from there; all zero of one point.
    origin: [Lanes; 3],
    /// One over each direction, never infinite.
    over: [Lanes; 3],
    /// The axis, and the two others.
    axes: [usize; 3],
    /// How far each goes along the others while it goes 1 along the axis.
    shear: [Lanes; 2],
    near: f64,
    far: Lanes,
}

// Plain loops over the lanes: a closure would be compiled without the caller's instruction set.
impl<'a, const ONE: bool, const ANY: bool> Walk<'a, ONE, ANY> {
    /// `None` where no ray runs along `axis`.
    #[inline(always)]
    fn new(tree: &'a Tree, rays: &Rays, axis: usize) -> Option<Self> {
        let axes = [axis, (axis + 1) % 3, (axis + 2) % 3];
        let [z, x, y] = axes;
        let mut far = rays.far;
        let mut some = false;
        let mut over = [[0f64; LANES]; 3];
        let mut shear = [[0f64; LANES]; 2];
        for r in 0..LANES {
            let d = [rays.direction[0][r], rays.direction[1][r], rays.direction[2][r]];
            let size = d.map(f64::abs);
            // Of two alike the first.
            let longest = if size[0] >= size[1] && size[0] >= size[2] {
                0
            } else if size[1] >= size[2] {
                1
            } else {
                2
            };
            if longest != axis || size[z] == 0.0 || size[z].is_nan() {
                far[r] = f64::NEG_INFINITY;
            }
            some |= far[r] > rays.near;
            for k in 0..3 {
                // What runs along a box's side is as good as parallel to it, and 0 · 1e300 is a number.
                over[k][r] = 1.0 / if size[k] < 1e-300 { 1e-300 } else { d[k] };
            }
            shear[0][r] = d[x] / d[z];
            shear[1][r] = d[y] / d[z];
        }
        if !some {
            return None;
        }
        let here = rays.origin(0);
        let mut origin = [[0f64; LANES]; 3];
        let mut reach = here.abs().max_element();
        if !ONE {
            let from: [DVec3; LANES] = std::array::from_fn(|r| rays.origin(r) - here);
            reach = from.iter().fold(reach, |reach, from| reach.max(from.abs().max_element()));
            origin = split(&from);
        }
        if let Some([low, high]) = tree.bounds() {
            reach = reach.max(f64::from(low.abs().max(high.abs()).max_element()));
        }
        let pad = 4.0 * f64::EPSILON * reach;
        Some(Self { tree, here, pad, origin, over, axes, shear, near: rays.near, far })
    }

    #[inline(always)]
    fn run(mut self, hits: &mut Hits) {
        for r in 0..LANES {
            let hit = hits.at[r];
            if ANY && hits.triangle[r] != NOTHING {
                self.far[r] = f64::NEG_INFINITY;
            } else if hit < self.far[r] {
                self.far[r] = hit;
            }
        }
        let nodes = &self.tree.nodes[..];
        let Some(root) = nodes.first() else { return };
        let mut stack = [(0f64, 0u32); DEPTH];
        let mut spill = Vec::new();
        let mut top = 0;
        let mut node = root;
        if self.enter(root) == f64::INFINITY {
            return;
        }
        loop {
            if node.count == 0 {
                let pair = node.first as usize;
                let (a, b) = (&nodes[pair], &nodes[pair + 1]);
                let (to_a, to_b) = (self.enter(a), self.enter(b));
                let (to, next, later, other) =
                    if to_b < to_a { (to_b, b, to_a, pair) } else { (to_a, a, to_b, pair + 1) };
                if to < f64::INFINITY {
                    if later < f64::INFINITY {
                        if top < DEPTH {
                            stack[top] = (later, other as u32);
                        } else {
                            spill.push((later, other as u32));
                        }
                        top += 1;
                    }
                    node = next;
                    continue;
                }
            } else {
                for k in node.first as usize..(node.first + node.count) as usize {
                    self.meet(k, hits);
                }
                if ANY && !self.going() {
                    return;
                }
            }
            loop {
                if top == 0 {
                    return;
                }
                top -= 1;
                let (to, next) = if top < DEPTH { stack[top] } else { spill.pop().unwrap_or_default() };
                node = &nodes[next as usize];
                // Nearer hits may have been found since.
                if self.farthest() * SLACK >= to {
                    break;
                }
            }
        }
    }

    /// Where the first ray enters a box: infinite where none does.
    #[inline(always)]
    fn enter(&self, node: &Node) -> f64 {
        let (mut t0, mut t1) = ([self.near; LANES], self.far);
        for axis in 0..3 {
            let low = f64::from(node.low[axis]) - self.here[axis] - self.pad;
            let high = f64::from(node.high[axis]) - self.here[axis] + self.pad;
            for r in 0..LANES {
                let from = if ONE { 0.0 } else { self.origin[axis][r] };
                let (a, b) = ((low - from) * self.over[axis][r], (high - from) * self.over[axis][r]);
                let (a, b) = if a < b { (a, b) } else { (b, a) };
                t0[r] = if a > t0[r] { a } else { t0[r] };
                t1[r] = if b < t1[r] { b } else { t1[r] };
            }
        }
        let mut first = [f64::INFINITY; LANES];
        for r in 0..LANES {
            first[r] = if t0[r] <= t1[r] * SLACK { t0[r] } else { f64::INFINITY };
        }
        let mut width = LANES / 2;
        while width > 0 {
            for r in 0..width {
                first[r] = if first[r + width] < first[r] { first[r + width] } else { first[r] };
            }
            width /= 2;
        }
        first[0]
    }

    /// The rays against triangle `k` of the leaves.
    #[inline(always)]
    fn meet(&mut self, k: usize, hits: &mut Hits) {
        let [z, x, y] = self.axes;
        let mut along = [[0f64; LANES]; 3];
        let mut right = [[0f64; LANES]; 3];
        let mut up = [[0f64; LANES]; 3];
        for (corner, at) in self.tree.corners[k].iter().enumerate() {
            let at = [x, y, z].map(|axis| f64::from(at[axis]) - self.here[axis]);
            for r in 0..LANES {
                let [px, py, pz] = if ONE {
                    at
                } else {
                    [at[0] - self.origin[x][r], at[1] - self.origin[y][r], at[2] - self.origin[z][r]]
                };
                along[corner][r] = pz;
                right[corner][r] = px - self.shear[0][r] * pz;
                up[corner][r] = py - self.shear[1][r] * pz;
            }
        }
        let mut sides = [[0f64; LANES]; 3];
        for (corner, side) in sides.iter_mut().enumerate() {
            let (p, q) = ((corner + 1) % 3, (corner + 2) % 3);
            for r in 0..LANES {
                side[r] = right[q][r] * up[p][r] - up[q][r] * right[p][r];
            }
        }
        let [a, b, c] = &sides;
        let mut inside = 0u32;
        for r in 0..LANES {
            let left = (a[r] >= 0.0) & (b[r] >= 0.0) & (c[r] >= 0.0);
            let right = (a[r] <= 0.0) & (b[r] <= 0.0) & (c[r] <= 0.0);
            inside |= u32::from(left | right) << r;
        }
        if inside == 0 {
            return;
        }
        let name = self.tree.names[k];
        for r in 0..LANES {
            if inside >> r & 1 == 0 {
                continue;
            }
            // The corners' distances, weighed by the sides: all of one sign, so that nothing cancels. A NaN is no hit: the triangle is seen edge on.
            let whole = a[r] + b[r] + c[r];
            let depth = (a[r] * along[0][r] + b[r] * along[1][r] + c[r] * along[2][r]) / whole;
            let at = depth * self.over[z][r];
            if ANY {
                if at > self.near && at < self.far[r] {
                    (hits.at[r], hits.triangle[r]) = (at, name);
                    self.far[r] = f64::NEG_INFINITY;
                }
            } else if at > self.near
                && (at < self.far[r] || at == self.far[r] && at == hits.at[r] && name < hits.triangle[r])
            {
                (hits.at[r], hits.triangle[r]) = (at, name);
                self.far[r] = at;
            }
        }
    }

    /// The farthest that a ray may still hit anything.
    #[inline(always)]
    fn farthest(&self) -> f64 {
        let mut far = f64::NEG_INFINITY;
        for r in 0..LANES {
            far = if self.far[r] > far { self.far[r] } else { far };
        }
        far
    }

    /// Whether any ray is still looking.
    #[inline(always)]
    fn going(&self) -> bool {
        self.farthest() > self.near
    }
}
