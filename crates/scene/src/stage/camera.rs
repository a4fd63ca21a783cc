//! Who looks at the stage.

use glam::{DVec2, DVec3};

use super::Pose;

/// A camera without a lens: pixels from the top left, the middle of pixel (i, j) at (i + ½, j + ½).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Where it is; it looks along its −z, with its y upwards in the picture.
    pub pose: Pose,
    /// How rays meet the picture.
    pub projection: Projection,
    /// Width over height of its picture.
    pub aspect: f64,
}

/// How rays meet the picture. Lengths are in units of the picture's width, so that they hold for every size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// All rays pass one point.
    Perspective {
        /// Focal lengths along x and y: fx / width and fy / width.
        focal: [f64; 2],
        /// Where the axis meets the picture, from the top left: cx / width and cy / width.
        centre: [f64; 2],
    },
    /// All rays are parallel.
    Orthographic {
        /// What the picture's width covers, metres.
        width_m: f64,
    },
}

impl Projection {
    /// Perspective with the axis in the middle, by the angle that the picture's height covers.
    pub fn with_field_of_view(vertical_deg: f64, aspect: f64) -> Self {
        let focal = 0.5 / aspect / (0.5 * vertical_deg.to_radians()).tan();
        Self::Perspective { focal: [focal; 2], centre: [0.5, 0.5 / aspect] }
    }
}

impl Camera {
    /// The ray through a point of the picture (from the top left, in units of its width): origin in metres, direction of any length.
    pub fn ray(&self, at: DVec2) -> (DVec3, DVec3) {
        let (origin, direction) = match self.projection {
            Projection::Perspective { focal, centre } => {
                (DVec3::ZERO, DVec3::new((at.x - centre[0]) / focal[0], -(at.y - centre[1]) / focal[1], -1.0))
            }
            Projection::Orthographic { width_m } => {
                (width_m * DVec3::new(at.x - 0.5, 0.5 / self.aspect - at.y, 0.0), DVec3::NEG_Z)
            }
        };
        (self.pose.position_m + self.pose.rotation * origin, self.pose.rotation * direction)
    }

    /// Where a point of the stage is seen in the picture, in units of its width; `None` where it is behind the camera.
    pub fn sees(&self, point_m: DVec3) -> Option<DVec2> {
        let p = self.pose.rotation.conjugate() * (point_m - self.pose.position_m);
        match self.projection {
            Projection::Perspective { focal, centre } if p.z < 0.0 => {
                Some(DVec2::new(centre[0] + focal[0] * p.x / -p.z, centre[1] - focal[1] * p.y / -p.z))
            }
            Projection::Perspective { .. } => None,
            Projection::Orthographic { width_m } => {
                Some(DVec2::new(0.5 + p.x / width_m, 0.5 / self.aspect - p.y / width_m))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]
    use super::*;

    /// Both ways of a camera agree, and up is up.
    #[test]
    fn what_a_ray_meets_is_seen_where_the_ray_began() {
        let pose = Pose::looking(DVec3::new(1.0, 2.0, 5.0), DVec3::new(0.0, 0.5, 0.0), DVec3::Y);
        for projection in [
            Projection::with_field_of_view(40.0, 1.5),
            Projection::Perspective { focal: [1.3, 1.2], centre: [0.4, 0.35] },
            Projection::Orthographic { width_m: 3.0 },
        ] {
            let camera = Camera { pose, projection, aspect: 1.5 };
            for at in [DVec2::new(0.1, 0.2), DVec2::new(0.9, 0.6), DVec2::new(0.5, 1.0 / 3.0)] {
                let (origin, direction) = camera.ray(at);
                let seen = camera.sees(origin + 2.5 * direction).unwrap();
                assert!(seen.distance(at) < 1e-12, "{seen} {at}");
            }
            let low = camera.sees(DVec3::new(0.0, 0.5, 0.0)).unwrap();
            let high = camera.sees(DVec3::new(0.0, 0.6, 0.0)).unwrap();
            assert!(high.y < low.y, "higher is nearer to the top");
            let right = camera.sees(DVec3::new(0.1, 0.5, 0.0)).unwrap();
            assert!(right.x > low.x, "from in front, +x is on the right");
        }
    }

    /// 2 · atan(h / 2d) of a rectangle that just fills the picture.
    #[test]
    fn a_field_of_view_is_the_angle_of_the_height() {
        let projection = Projection::with_field_of_view(90.0, 2.0);
        let camera = Camera { pose: Pose::default(), projection, aspect: 2.0 };
        assert!(camera.sees(DVec3::new(0.0, 1.0, -1.0)).unwrap().distance(DVec2::new(0.5, 0.0)) < 1e-15);
        assert!(camera.sees(DVec3::new(2.0, -1.0, -1.0)).unwrap().distance(DVec2::new(1.0, 0.5)) < 1e-15);
        assert_eq!(camera.sees(DVec3::Z), None);
    }
}
