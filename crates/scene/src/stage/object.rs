//! What stands on the stage.

use std::sync::Arc;

use kelir_mesh::Mesh;

use super::Pose;
use crate::theatre::LinearImage;

/// One thing.
#[derive(Clone, Debug)]
pub struct Object {
    /// Unique within the stage.
    pub name: String,
    /// Its shape in coordinates of its own.
    pub form: Form,
    /// Where it is.
    pub pose: Pose,
    /// What it does with light.
    pub surface: Surface,
    /// Whether it casts shadows.
    pub casts: bool,
}

/// A shape in its own coordinates, metres; what has two sides is lit on both.
#[derive(Clone, Debug)]
pub enum Form {
    /// Triangles.
    Mesh(MeshForm),
    /// A sphere around the origin.
    Sphere {
        /// Its radius, > 0.
        radius_m: f64,
    },
    /// A circle's area in z = 0, facing +z.
    Disk {
        /// Its radius, > 0.
        radius_m: f64,
    },
    /// A rectangle in z = 0, facing +z, centred on the origin: walls and floors.
    Rectangle {
        /// Width along x and height along y, > 0.
        size_m: [f64; 2],
    },
    /// One triangle.
    Triangle {
        /// Its corners, counter-clockwise seen from outside.
        corners_m: [[f64; 3]; 3],
    },
    /// A closed cone: its base a disk in y = 0 around the origin, its tip at y = height.
    Cone {
        /// Radius of the base, > 0.
        radius_m: f64,
        /// How high the tip is, > 0.
        height_m: f64,
    },
}

/// A mesh, as it is seen and as it casts shadows: two levels of detail of one model, or the same.
#[derive(Clone, Debug)]
pub struct MeshForm {
    /// What the camera sees.
    pub seen: Arc<Mesh>,
    /// What stands in the light's way.
    pub caster: Arc<Mesh>,
    /// Whether its shading is interpolated between vertices' normals; otherwise each triangle is flat.
    pub smooth: bool,
}

/// What a surface does with light.
#[derive(Clone, Debug)]
pub enum Surface {
    /// Lambertian: the same radiance in all directions.
    Matte {
        /// Its share of the light sent back, each channel in [0, 1].
        albedo: [f64; 3],
        /// A picture that the albedo is multiplied by, over a mesh's texture coordinates.
        texture: Option<Arc<LinearImage>>,
    },
    /// An ideal mirror.
    Mirror {
        /// Its share of the light sent back, each channel in [0, 1].
        reflectance: [f64; 3],
    },
}
