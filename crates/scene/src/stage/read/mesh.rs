//! Reads the meshes of `[[stage.objects]]`.

use std::sync::Arc;

use kelir_mesh::{Attributes, Format, Mesh, Unit, check, levels, read, repair};
use kelir_reader::{Fields, Node};

use super::super::{Form, MeshForm};
use super::Made;
use crate::assets::resolve;
use crate::fields::length;
use crate::limits;
use crate::load::Loader;

/// `normals = "smooth"` or `"flat"`.
fn smooth(fields: &mut Fields) -> Option<bool> {
    fields.optional(
        "normals",
        "\"smooth\": shading is interpolated between vertices; \"flat\": each triangle is even; without it smooth",
        true,
        |n| n.choice(&[("smooth", true), ("flat", false)]),
    )
}

pub(super) fn mesh(fields: &mut Fields, name: &str, loader: &Loader, made: &mut Made) -> Option<Form> {
    let unit = fields.optional(
        "unit",
        "what the file's numbers are in: \"m\", \"cm\", \"mm\" or \"in\"; without it m",
        Unit::Metre,
        |n| n.choice(&Unit::ALL.map(|unit| (unit.name(), unit))),
    );
    let mended = fields.optional(
        "repair",
        "whether faults of the mesh are repaired where that needs no guess; without it they are refused",
        false,
        Node::boolean,
    );
    let smooth = smooth(fields);
    let file = fields.given("file", "the mesh: .obj, .ply, .gltf or .glb; or a model");
    let model = fields.given("model", "a model that ships, by its name (`kelir mesh list`); or a file");
    let level = fields.given("level", "so many triangles are seen: it is simplified to them; without it all");
    let caster = fields
        .given("caster_level", "so many triangles cast the shadow on other things; without it what is seen");
    let full = match (&file, &model) {
        (Some(file), None) => whole(file, name, loader, unit?, mended?)?,
        (None, Some(model)) => shipped(model, made)?,
        (Some(_), Some(model)) => return model.refuse("a mesh is of a file or a model, not of both"),
        (None, None) => return fields.node().refuse("a mesh has a file or a model"),
    };
    let simplified = |node: &Option<Node>, else_: &Arc<Mesh>, made: &mut Made| match node {
        Some(node) => simplify(node, &full, made),
        None => Some(else_.clone()),
    };
    let seen = simplified(&level, &full, made);
    let seen = seen?;
    let caster = match (&level, &caster) {
        // The same level is the same mesh.
        (Some(a), Some(b)) if a.as_integer() == b.as_integer() => Some(seen.clone()),
        _ => simplified(&caster, &seen, made),
    };
    Some(Form::Mesh(MeshForm { seen, caster: caster?, smooth: smooth? }))
}

/// A model that ships.
fn shipped(node: &Node, hashes: &mut Made) -> Option<Arc<Mesh>> {
    let model = node.choice(&kelir_mesh::Made::ALL.map(|made| (made.name(), made)))?.make();
    let mesh = model.merged(&model.rest());
    hashes.insert(node.path().to_owned(), mesh.hash());
    Some(Arc::new(mesh))
}

/// The file's mesh, sound.
fn whole(file: &Node, name: &str, loader: &Loader, unit: Unit, mended: bool) -> Option<Arc<Mesh>> {
    let Some(format) = Format::of(file.string()?) else {
        return file.refuse("a mesh is a file of .obj, .ply, .gltf or .glb");
    };
    let (path, bytes) = loader.read(name, file, limits::MESH_BYTES)?;
    let mut beside = |relative: &str| {
        let beside = resolve(&path, relative)?;
        loader.bytes(&beside, limits::MESH_BYTES).map(|bytes| bytes.to_vec())
    };
    let model = match read(&bytes, format, unit, &mut beside) {
        Ok(model) => model,
        Err(fault) => return file.refuse(format!("{}: {fault}", loader.label(&path))),
    };
    let mut mesh = model.merged(&model.rest());
    if mended {
        repair(&mut mesh);
    }
    let report = check(&mesh);
    if !report.is_drawable() || !report.is_manifold() {
        let cure = if mended {
            "these can't be repaired without a guess"
        } else {
            "repair = true mends what needs no guess"
        };
        let faults = report.faults().join(", ");
        let faults = if faults.is_empty() { "no triangles".to_owned() } else { faults };
        return file.refuse(format!("{} has {faults}; {cure}", loader.label(&path)));
    }
    if mesh.positions.as_flattened().iter().any(|x| f64::from(x.abs()) > limits::COORDINATE_M) {
        return file.refuse("a mesh's coordinates are from −1e6 to 1e6 metres");
    }
    Some(Arc::new(mesh))
}

/// A level of `full` with as many triangles as `node` says.
fn simplify(node: &Node, full: &Arc<Mesh>, made: &mut Made) -> Option<Arc<Mesh>> {
    let rule = format!("a level has from 4 to {} triangles, which is all", full.triangles.len());
    let target = node.integer_in(4..=full.triangles.len() as i64, &rule)? as usize;
    if target == full.triangles.len() {
        return Some(full.clone());
    }
    let level = match levels(full, &[target], Attributes::None) {
        Ok(mut levels) => levels.pop()?,
        Err(refused) => return node.refuse(refused.to_string()),
    };
    if let Some(missed) = level.missed {
        node.warn(format!("it has {} triangles: {}", level.mesh.triangles.len(), missed.reason()));
    }
    made.insert(node.path().to_owned(), level.mesh.hash());
    Some(Arc::new(level.mesh))
}

/// A closed cylinder of flat sides, upright, its base around the origin.
pub(super) fn cylinder(fields: &mut Fields) -> Option<Form> {
    let radius_m = fields.need("radius_m", "its radius in metres", length);
    let height_m = fields.need("height_m", "its height in metres", length);
    let segments = fields.optional("segments", "how many flat sides it has; without it 64", 64, |n| {
        n.integer_in(3..=4096, "a cylinder has from 3 to 4096 sides")
    });
    let smooth = smooth(fields);
    let (radius, height, sides) = (radius_m?, height_m?, segments? as u32);
    let ring = |y: f64| {
        (0..sides).map(move |k| {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / f64::from(sides)).sin_cos();
            [radius * cos, y, radius * sin].map(|x| x as f32)
        })
    };
    // Lids have vertices of their own: their edge is sharp.
    let mut positions: Vec<[f32; 3]> =
        ring(0.0).chain(ring(height)).chain(ring(0.0)).chain(ring(height)).collect();
    let outward = |k: u32| {
        let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / f64::from(sides)).sin_cos();
        [cos as f32, 0.0, sin as f32]
    };
    let mut normals: Vec<[f32; 3]> = (0..2 * sides).map(outward).collect();
    normals.extend((0..sides).map(|_| [0.0, -1.0, 0.0]));
    normals.extend((0..sides).map(|_| [0.0, 1.0, 0.0]));
    positions.extend([[0.0; 3], [0.0, height as f32, 0.0]]);
    normals.extend([[0.0, -1.0, 0.0], [0.0, 1.0, 0.0]]);
    let (bottom, top) = (4 * sides, 4 * sides + 1);
    let mut triangles = Vec::with_capacity(4 * sides as usize);
    for k in 0..sides {
        let next = (k + 1) % sides;
        triangles.push([k, sides + k, sides + next]);
        triangles.push([k, sides + next, next]);
        triangles.push([bottom, 2 * sides + k, 2 * sides + next]);
        triangles.push([top, 3 * sides + next, 3 * sides + k]);
    }
    let mesh = Arc::new(Mesh { normals: Some(normals), ..Mesh::new(positions, triangles) });
    Some(Form::Mesh(MeshForm { seen: mesh.clone(), caster: mesh, smooth: smooth? }))
}
