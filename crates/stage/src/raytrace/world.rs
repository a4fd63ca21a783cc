//! A stage made ready for rays: what the camera sees, and what stands in the light's way.

use std::collections::HashMap;
use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3};
use kelir_mesh::Mesh;
use kelir_scene::stage::{Form, LightKind, Object, Stage, Surface};

use super::rays::{Hits, LANES, NOTHING, Rays};
use super::shapes;
use super::tree::Tree;

/// Of the stage's size: what is nearer to a surface than this is on it.
const SKIN: f64 = 1e-9;

/// A mesh with its tree.
pub(super) struct Solid {
    mesh: Arc<Mesh>,
    tree: Tree,
    /// Unit normals of the vertices, where shading is smooth.
    normals: Vec<[f32; 3]>,
}

/// Meshes that were made ready before, by where they lie in memory, which they keep as long as they are here.
#[derive(Default)]
pub(super) struct Solids(HashMap<(usize, bool), Arc<Solid>>);

impl Solids {
    fn get(&mut self, mesh: &Arc<Mesh>, smooth: bool) -> Arc<Solid> {
        let make = || {
            let normals = match (smooth, &mesh.normals) {
                (false, _) => Vec::new(),
                (true, Some(normals)) => normals.clone(),
                (true, None) => mesh.smooth_normals(),
            };
            Arc::new(Solid { mesh: mesh.clone(), tree: Tree::new(&mesh.positions, &mesh.triangles), normals })
        };
        self.0.entry((Arc::as_ptr(mesh) as usize, smooth)).or_insert_with(make).clone()
    }

    /// Forgets what `stage` doesn't show.
    fn keep(&mut self, stage: &Stage) {
        let shown = |mesh: usize| {
            stage.objects.iter().any(|object| match &object.form {
                Form::Mesh(form) => {
                    [&form.seen, &form.caster].iter().any(|shown| Arc::as_ptr(shown) as usize == mesh)
                }
                _ => false,
            })
        };
        self.0.retain(|(mesh, _), _| shown(*mesh));
    }
}

/// One object.
struct Thing<'a> {
    object: &'a Object,
    to_stage: DAffine3,
    from_stage: DAffine3,
    /// Turns its own normals into the stage's, up to their length.
    normals: DMat3,
    seen: Option<Arc<Solid>>,
    /// What casts its shadow on others, where that is another mesh.
    caster: Option<Arc<Solid>>,
}

/// A stage made ready.
pub(super) struct World<'a> {
    pub stage: &'a Stage,
    things: Vec<Thing<'a>>,
    /// Distance from a surface, metres, within which nothing stands in the light's way.
    pub skin_m: f64,
}

/// What sixteen rays see first.
pub(super) struct Seen {
    pub at: [f64; LANES],
    /// Which object, or behind all of them, which lamp; [`NOTHING`] where none.
    pub object: [u32; LANES],
    triangle: [u32; LANES],
}

/// A point of a surface.
#[derive(Clone, Copy)]
pub(super) struct Point {
    pub position: DVec3,
    /// Unit normal of the surface, towards who looks: it decides what is lit.
    pub normal: DVec3,
    /// Unit normal that light falls on: that of the smooth surface which triangles stand for.
    pub shading: DVec3,
    /// Which object it is of.
    pub object: u32,
    /// Albedo, or a mirror's reflectance.
    pub albedo: [f64; 3],
    pub mirror: bool,
}

impl<'a> World<'a> {
    pub(super) fn new(stage: &'a Stage, solids: &mut Solids) -> Self {
        solids.keep(stage);
        let thing = |object: &'a Object| {
            let to_stage = object.pose.to_stage();
            let (seen, caster) = match &object.form {
                Form::Mesh(form) => {
                    let other = object.casts && !Arc::ptr_eq(&form.seen, &form.caster);
                    (
                        Some(solids.get(&form.seen, form.smooth)),
                        other.then(|| solids.get(&form.caster, false)),
                    )
                }
                _ => (None, None),
            };
            let from_stage = to_stage.inverse();
            Thing { object, to_stage, from_stage, normals: from_stage.matrix3.transpose(), seen, caster }
        };
        let things: Vec<Thing> = stage.objects.iter().map(thing).collect();
        let farthest = things.iter().map(|thing| thing.reach_m()).fold(0.0, f64::max);
        Self { stage, things, skin_m: SKIN * farthest }
    }

    /// What rays see first: objects, and lamps that have an area.
    pub(super) fn first(&self, rays: &Rays) -> Seen {
        let mut seen = Seen { at: rays.far, object: [NOTHING; LANES], triangle: [NOTHING; LANES] };
        for (k, thing) in self.things.iter().enumerate() {
            thing.first(k as u32, rays, &mut seen);
        }
        for (k, light) in self.stage.lights.iter().enumerate() {
            let LightKind::Area { pose, shape, .. } = &light.kind else { continue };
            let inverse = pose.to_stage().inverse();
            for r in 0..LANES {
                let o = inverse.transform_point3(rays.origin(r));
                let d = inverse.transform_vector3(rays.direction(r));
                if let Some(at) = shapes::flat(shape, o, d, rays.near, seen.at[r])
                    && rays.follows(r)
                {
                    (seen.at[r], seen.object[r]) = (at, (self.things.len() + k) as u32);
                }
            }
        }
        seen
    }

    /// The lamp that is seen as [`Seen::object`], if it is one.
    pub(super) fn lamp(&self, object: u32) -> Option<usize> {
        (object != NOTHING).then(|| (object as usize).checked_sub(self.things.len())).flatten()
    }

    /// Which rays meet anything that casts shadows, as bits. Each comes from or goes to a surface of `of[r]`, which shades itself as it is seen.
    pub(super) fn blocked(&self, rays: &Rays, of: &[u32; LANES]) -> u16 {
        let mut rays = rays.clone();
        let mut blocked = 0;
        for (k, thing) in self.things.iter().enumerate() {
            if !thing.object.casts {
                continue;
            }
            let found = thing.blocked(k as u32, &rays, of);
            blocked |= found;
            (0..LANES).filter(|r| found >> r & 1 == 1).for_each(|r| rays.stop(r));
            if (0..LANES).all(|r| !rays.follows(r)) {
                break;
            }
        }
        blocked
    }

    /// The point that ray `r` sees, which must be one of an object.
    pub(super) fn point(&self, rays: &Rays, seen: &Seen, r: usize) -> Point {
        let thing = &self.things[seen.object[r] as usize];
        let direction = rays.direction(r);
        let position = rays.origin(r) + seen.at[r] * direction;
        let own = thing.from_stage.transform_point3(position);
        let (normal, shading, mut albedo) = match &thing.seen {
            Some(solid) => solid.surface(seen.triangle[r], own, &thing.object.surface),
            None => {
                let o = thing.from_stage.transform_point3(rays.origin(r));
                let d = thing.from_stage.transform_vector3(direction);
                // Asked anew just around the hit.
                let at = seen.at[r];
                let around = 1e-9 * at.abs().max(1e-9);
                let normal = shapes::meet(&thing.object.form, o, d, at - around, at + around)
                    .map_or(-d, |(_, normal)| normal);
                (normal, normal, [1.0; 3])
            }
        };
        let [mut normal, mut shading] = [normal, shading].map(|n| (thing.normals * n).normalize_or_zero());
        if normal.dot(direction) > 0.0 {
            (normal, shading) = (-normal, -shading);
        }
        let (share, mirror) = match &thing.object.surface {
            Surface::Matte { albedo, .. } => (albedo, false),
            Surface::Mirror { reflectance } => (reflectance, true),
        };
        for c in 0..3 {
            albedo[c] *= share[c];
        }
        Point { position, normal, shading, object: seen.object[r], albedo, mirror }
    }
}

impl Thing<'_> {
    /// How far from the stage's origin it reaches at most, metres.
    fn reach_m(&self) -> f64 {
        let own = match (&self.object.form, &self.seen) {
            (_, Some(solid)) => solid.mesh.bounds().map_or(0.0, |bounds| {
                bounds.min.iter().chain(&bounds.max).map(|x| f64::from(x.abs())).fold(0.0, f64::max)
                    * 3f64.sqrt()
            }),
            (Form::Sphere { radius_m } | Form::Disk { radius_m }, _) => *radius_m,
            (Form::Rectangle { size_m: [w, h] }, _) => 0.5 * w.hypot(*h),
            (Form::Triangle { corners_m }, _) => {
                corners_m.iter().map(|c| DVec3::from(*c).length()).fold(0.0, f64::max)
            }
            (Form::Cone { radius_m, height_m }, _) => radius_m.hypot(*height_m),
            (Form::Mesh(_), None) => 0.0,
        };
        self.to_stage.translation.length() + self.object.pose.scale * own
    }

    fn first(&self, k: u32, rays: &Rays, seen: &mut Seen) {
        let own = rays.through(&self.from_stage);
        if let Some(solid) = &self.seen {
            let mut hits = Hits { at: seen.at, triangle: [NOTHING; LANES] };
            solid.tree.first(&own, &mut hits);
            for r in 0..LANES {
                if hits.triangle[r] != NOTHING {
                    (seen.at[r], seen.object[r], seen.triangle[r]) = (hits.at[r], k, hits.triangle[r]);
                }
            }
            return;
        }
        for r in (0..LANES).filter(|&r| rays.follows(r)) {
            let hit = shapes::meet(&self.object.form, own.origin(r), own.direction(r), rays.near, seen.at[r]);
            if let Some((at, _)) = hit {
                (seen.at[r], seen.object[r]) = (at, k);
            }
        }
    }

    fn blocked(&self, k: u32, rays: &Rays, of: &[u32; LANES]) -> u16 {
        let own = rays.through(&self.from_stage);
        let Some(seen) = &self.seen else {
            let hit = |r: &usize| {
                rays.follows(*r)
                    && shapes::meet(
                        &self.object.form,
                        own.origin(*r),
                        own.direction(*r),
                        rays.near,
                        rays.far[*r],
                    )
                    .is_some()
            };
            return (0..LANES).filter(hit).fold(0, |bits, r| bits | 1 << r);
        };
        let Some(caster) = &self.caster else { return seen.blocks(&own) };
        // Itself as it is seen, others as it casts.
        let (mut onto_itself, mut onto_others) = (own.clone(), own);
        for (r, of) in of.iter().enumerate() {
            if *of == k { onto_others.stop(r) } else { onto_itself.stop(r) }
        }
        let mut bits = caster.blocks(&onto_others);
        if of.contains(&k) {
            bits |= seen.blocks(&onto_itself);
        }
        bits
    }
}

impl Solid {
    fn blocks(&self, rays: &Rays) -> u16 {
        let mut hits = Hits::default();
        self.tree.any(rays, &mut hits);
        (0..LANES).filter(|&r| hits.triangle[r] != NOTHING).fold(0, |bits, r| bits | 1 << r)
    }

    /// Geometric and shading normal (of any length) and the texture's colour at a point of a triangle.
    fn surface(&self, triangle: u32, point: DVec3, surface: &Surface) -> (DVec3, DVec3, [f64; 3]) {
        let corners = self.mesh.triangles[triangle as usize];
        let [a, b, c] = corners.map(|k| DVec3::from(self.mesh.positions[k as usize].map(f64::from)));
        let normal = (b - a).cross(c - a);
        let (v, w) = (
            normal.dot((point - a).cross(c - a)) / normal.length_squared(),
            normal.dot((b - a).cross(point - a)) / normal.length_squared(),
        );
        let weights = [1.0 - v - w, v, w];
        let shading = if self.normals.is_empty() {
            normal
        } else {
            let corner = |k: usize| DVec3::from(self.normals[corners[k] as usize].map(f64::from));
            let mixed: DVec3 = (0..3).map(|k| weights[k] * corner(k)).sum();
            if mixed.length_squared() > 1e-12 { mixed } else { normal }
        };
        let mut colour = self.mesh.base_colour.map(f64::from);
        if let (Surface::Matte { texture: Some(image), .. }, Some(texture)) = (surface, &self.mesh.texture) {
            let [u, v] = [0, 1].map(|d| {
                (0..3).map(|k| weights[k] * f64::from(texture[corners[k] as usize][d])).sum::<f64>()
            });
            let [u, v] = [u, v].map(|x| x.rem_euclid(1.0));
            for (c, colour) in colour.iter_mut().enumerate() {
                *colour *= image.at(c, u, v);
            }
        }
        (normal, shading, colour)
    }
}

/// Rays from `position` that are told apart from its own surface: they begin a little later.
pub(super) fn leaving(position: &[DVec3; LANES], directions: &[DVec3; LANES], skin_m: f64) -> Rays {
    let same = position.iter().all(|p| p == &position[0]);
    let mut rays = if same {
        Rays::from_point(position[0], directions)
    } else {
        Rays::from_points(position, directions)
    };
    let longest = directions.iter().map(|d| d.length()).filter(|l| l.is_finite()).fold(0.0, f64::max);
    rays.near = if longest > 0.0 { skin_m / longest } else { 0.0 };
    rays
}
