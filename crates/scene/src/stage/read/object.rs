//! Reads one `[[stage.objects]]`.

use kelir_reader::{Fields, Node};

use super::super::{Form, Object, Surface};
use super::{Made, called, mesh, pose};
use crate::fields::{length, point, uniform};
use crate::load::Loader;

#[derive(Clone, Copy, PartialEq)]
enum Shape {
    Mesh,
    Sphere,
    Disk,
    Rectangle,
    Triangle,
    Cone,
    Cylinder,
}

/// Keys that belong to some shapes alone, and to which.
const OWN: [(&str, &[Shape], &str); 13] = [
    ("file", &[Shape::Mesh], "a mesh"),
    ("model", &[Shape::Mesh], "a mesh"),
    ("unit", &[Shape::Mesh], "a mesh"),
    ("repair", &[Shape::Mesh], "a mesh"),
    ("level", &[Shape::Mesh], "a mesh"),
    ("caster_level", &[Shape::Mesh], "a mesh"),
    ("normals", &[Shape::Mesh, Shape::Cylinder], "a mesh or a cylinder"),
    ("scale", &[Shape::Mesh], "a mesh"),
    (
        "radius_m",
        &[Shape::Sphere, Shape::Disk, Shape::Cone, Shape::Cylinder],
        "a sphere, disk, cone or cylinder",
    ),
    ("height_m", &[Shape::Cone, Shape::Cylinder], "a cone or a cylinder"),
    ("segments", &[Shape::Cylinder], "a cylinder"),
    ("size_m", &[Shape::Rectangle], "a rectangle"),
    ("corners_m", &[Shape::Triangle], "a triangle"),
];

pub(super) fn object(node: &Node, name: &str, loader: &Loader, made: &mut Made) -> Option<Object> {
    let mut fields = node.table()?;
    let called = fields.need("name", "the object's name", called);
    let shape = fields.need(
        "shape",
        "\"mesh\", \"sphere\", \"disk\", \"rectangle\", \"triangle\", \"cone\" or \"cylinder\"",
        |n| {
            n.choice(&[
                ("mesh", Shape::Mesh),
                ("sphere", Shape::Sphere),
                ("disk", Shape::Disk),
                ("rectangle", Shape::Rectangle),
                ("triangle", Shape::Triangle),
                ("cone", Shape::Cone),
                ("cylinder", Shape::Cylinder),
            ])
        },
    );
    for (key, shapes, owners) in OWN {
        match shape {
            Some(shape) if !shapes.contains(&shape) => fields.reject(key, &format!("belongs to {owners}")),
            Some(_) => {}
            None => drop(fields.get(key)),
        }
    }
    let form = shape.and_then(|shape| form(shape, &mut fields, name, loader, made));
    let scale = match shape {
        Some(Shape::Mesh) => {
            fields.optional("scale", "by how much the mesh is enlarged; without it 1", 1.0, |n| {
                n.number_in(1e-6..=1e6, "a scale is from 1e-6 to 1e6")
            })
        }
        _ => Some(1.0),
    };
    let posed = pose::pose(&mut fields);
    let surface = surface(&mut fields, name, loader);
    let casts = fields.optional(
        "casts_shadow",
        "whether it stands in the light's way; without it true",
        true,
        Node::boolean,
    );
    fields.done();
    let mut pose = posed?;
    pose.scale = scale?;
    Some(Object { name: called?, form: form?, pose, surface: surface?, casts: casts? })
}

fn form(shape: Shape, fields: &mut Fields, name: &str, loader: &Loader, made: &mut Made) -> Option<Form> {
    match shape {
        Shape::Mesh => mesh::mesh(fields, name, loader, made),
        Shape::Cylinder => mesh::cylinder(fields),
        Shape::Sphere => {
            fields.need("radius_m", "its radius in metres", length).map(|radius_m| Form::Sphere { radius_m })
        }
        Shape::Disk => {
            fields.need("radius_m", "its radius in metres", length).map(|radius_m| Form::Disk { radius_m })
        }
        Shape::Rectangle => fields
            .need("size_m", "its [width, height] in metres: it lies in its own z = 0", |n| n.items(length))
            .map(|size_m| Form::Rectangle { size_m }),
        Shape::Triangle => fields
            .need("corners_m", "its three corners in metres, counter-clockwise seen from outside", |n| {
                n.items(point)
            })
            .map(|corners_m| Form::Triangle { corners_m }),
        Shape::Cone => {
            let radius_m = fields.need("radius_m", "the base's radius in metres", length);
            let height_m = fields.need("height_m", "how high its tip is, metres", length);
            Some(Form::Cone { radius_m: radius_m?, height_m: height_m? })
        }
    }
}

fn surface(fields: &mut Fields, name: &str, loader: &Loader) -> Option<Surface> {
    let mirror = fields.given(
        "mirror",
        "an ideal mirror: its share of the light sent back, a number or [r, g, b]; or an albedo",
    );
    let albedo =
        fields.given("albedo", "its share of the light sent back, a number or [r, g, b]; without it 0.8");
    let texture = fields
        .given("texture", "a picture over a mesh's texture coordinates, which the albedo is multiplied by");
    if let Some(mirror) = &mirror {
        if let Some(other) = albedo.as_ref().or(texture.as_ref()) {
            return other.refuse("a mirror has no albedo and no texture");
        }
        return uniform(mirror).map(|reflectance| Surface::Mirror { reflectance });
    }
    let albedo = albedo.as_ref().map_or(Some([0.8; 3]), uniform);
    let texture = match &texture {
        Some(node) => Some(std::sync::Arc::new(crate::fields::albedo_image(node, name, loader)?)),
        None => None,
    };
    Some(Surface::Matte { albedo: albedo?, texture })
}
