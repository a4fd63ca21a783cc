//! The stage at one instant, ready to draw: meshes and simple shapes, lights, a slide projector and a camera.
//!
//! Metres; right-handed, y up; a camera looks along its own −z. Counter-clockwise is outside.

mod camera;
mod light;
mod moving;
mod object;
pub(crate) mod read;
mod scene;
mod slide;

pub use camera::{Camera, Projection};
pub use light::{AreaShape, Environment, Light, LightKind, Projector};
pub(crate) use moving::Moved;
pub use object::{Form, MeshForm, Object, Surface};
pub use scene::StageScene;
pub use slide::{Pattern, Slide};

use crate::theatre::Exposure;

/// All that a camera can see at one instant.
#[derive(Clone, Debug)]
pub struct Stage {
    /// Who looks.
    pub camera: Camera,
    /// What is there, in the file's order.
    pub objects: Vec<Object>,
    /// What shines, in the file's order.
    pub lights: Vec<Light>,
    /// Light that is the same everywhere and casts no shadow: a surface sends out albedo × this radiance, one a channel.
    pub ambient: [f64; 3],
    /// What the display shows as white.
    pub exposure: Exposure,
}

impl Stage {
    /// Whether all that a timeline can move is where it is in `other`: two instants of one scene for which this is true look the same.
    pub fn same_staging(&self, other: &Self) -> bool {
        self.camera == other.camera
            && self.objects.len() == other.objects.len()
            && self.objects.iter().zip(&other.objects).all(|(a, b)| a.pose == b.pose)
            && self.lights.len() == other.lights.len()
            && self.lights.iter().zip(&other.lights).all(|(a, b)| a.same_staging(b))
    }

    /// Triangles of all meshes, those that cast shadows alone too.
    pub fn triangles(&self) -> usize {
        let of = |object: &Object| match &object.form {
            Form::Mesh(mesh) => mesh.seen.triangles.len() + mesh.caster.triangles.len(),
            _ => 0,
        };
        self.objects.iter().map(of).sum()
    }
}

/// Where something is and how it is turned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Where its origin is, metres.
    pub position_m: glam::DVec3,
    /// How it is turned: a unit quaternion.
    pub rotation: glam::DQuat,
    /// By how much it is enlarged, the same in all directions; > 0.
    pub scale: f64,
}

impl Default for Pose {
    fn default() -> Self {
        Self { position_m: glam::DVec3::ZERO, rotation: glam::DQuat::IDENTITY, scale: 1.0 }
    }
}

impl Pose {
    /// From its own coordinates to the stage's.
    pub fn to_stage(&self) -> glam::DAffine3 {
        glam::DAffine3::from_scale_rotation_translation(
            glam::DVec3::splat(self.scale),
            self.rotation,
            self.position_m,
        )
    }

    /// The pose of what stands at a point and looks (along its −z) at another, with `up` as far upwards as can be.
    pub fn looking(from_m: glam::DVec3, at_m: glam::DVec3, up: glam::DVec3) -> Self {
        let back = (from_m - at_m).normalize();
        let right = up.cross(back).try_normalize().unwrap_or_else(|| back.any_orthonormal_vector());
        let turned = glam::DMat3::from_cols(right, back.cross(right), back);
        Self { position_m: from_m, rotation: glam::DQuat::from_mat3(&turned), scale: 1.0 }
    }
}
