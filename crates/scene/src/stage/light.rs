//! What shines on the stage.

use std::sync::Arc;

use glam::DVec3;

use super::{Pose, Slide};
use crate::theatre::LinearImage;

/// One light.
#[derive(Clone, Debug)]
pub struct Light {
    /// Unique within the stage.
    pub name: String,
    /// What kind, and how bright.
    pub kind: LightKind,
}

/// The kinds of light; numbers are one a linear channel.
#[derive(Clone, Debug)]
pub enum LightKind {
    /// A point that shines evenly.
    Point {
        /// Where it is.
        position_m: DVec3,
        /// Radiant intensity, W/sr, ≥ 0.
        intensity: [f64; 3],
    },
    /// Light from far away.
    Directional {
        /// Where it goes: a unit vector.
        direction: DVec3,
        /// Irradiance on a plane that faces it, W/m², ≥ 0.
        irradiance: [f64; 3],
        /// Angle between its middle and its edge, degrees, [0, 90): a cone of even radiance. 0 is a point infinitely far.
        angular_radius_deg: f64,
    },
    /// A flat lamp that shines from one side only: along its own +z.
    Area {
        /// Where it is: its middle.
        pose: Pose,
        /// Its outline in its own z = 0.
        shape: AreaShape,
        /// W·m⁻²·sr⁻¹, ≥ 0, the same over the lamp and in all directions.
        radiance: [f64; 3],
    },
    /// All directions at once.
    Environment(Environment),
    /// A slide projector.
    Projector(Box<Projector>),
}

impl LightKind {
    /// Whether its shadows have penumbrae: it is no point and no single direction.
    pub fn is_soft(&self) -> bool {
        match self {
            Self::Point { .. } | Self::Projector(_) => false,
            Self::Directional { angular_radius_deg, .. } => *angular_radius_deg > 0.0,
            Self::Area { .. } | Self::Environment(_) => true,
        }
    }

    /// Whether it is as it is in `other`, in all that a timeline can move.
    fn same_staging(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Point { position_m: a, .. }, Self::Point { position_m: b, .. }) => a == b,
            (Self::Area { pose: a, .. }, Self::Area { pose: b, .. }) => a == b,
            (Self::Projector(a), Self::Projector(b)) => a.pose == b.pose && a.slide.same_staging(&b.slide),
            _ => true,
        }
    }
}

impl Light {
    pub(super) fn same_staging(&self, other: &Self) -> bool {
        self.kind.same_staging(&other.kind)
    }
}

/// An outline in z = 0 around the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AreaShape {
    /// Width along x and height along y, metres, > 0.
    Rectangle {
        /// Width and height.
        size_m: [f64; 2],
    },
    /// A disk.
    Disk {
        /// Radius, metres, > 0.
        radius_m: f64,
    },
}

impl AreaShape {
    /// Its area, square metres.
    pub fn area_m2(&self) -> f64 {
        match *self {
            Self::Rectangle { size_m: [w, h] } => w * h,
            Self::Disk { radius_m } => std::f64::consts::PI * radius_m * radius_m,
        }
    }
}

/// Radiance from all around: an equirectangular picture; +y is its top, −z its middle, and u grows towards +x.
#[derive(Clone, Debug)]
pub struct Environment {
    /// Linear radiance; twice as wide as high.
    pub image: Arc<LinearImage>,
    /// What its values are multiplied by, one a channel, ≥ 0.
    pub scale: [f64; 3],
}

impl Environment {
    /// Where in the picture a direction (of any length) is seen, each in [0, 1].
    pub fn place(direction: DVec3) -> [f64; 2] {
        let u = 0.5 + direction.x.atan2(-direction.z) / std::f64::consts::TAU;
        [u, (direction.y / direction.length()).clamp(-1.0, 1.0).acos() / std::f64::consts::PI]
    }

    /// The direction of a place in the picture: a unit vector.
    pub fn direction([u, v]: [f64; 2]) -> DVec3 {
        let ((sin_u, cos_u), (sin_v, cos_v)) =
            ((std::f64::consts::TAU * (u - 0.5)).sin_cos(), (std::f64::consts::PI * v).sin_cos());
        DVec3::new(sin_v * sin_u, cos_v, -sin_v * cos_u)
    }

    /// The radiance that comes from a direction, one a channel: interpolated between the middles of pixels, around the picture's ends.
    pub fn radiance(&self, direction: DVec3) -> [f64; 3] {
        let [u, v] = Self::place(direction);
        let (w, h) = (self.image.width, self.image.height);
        let (x, y) = (u * w as f64 - 0.5, (v * h as f64 - 0.5).clamp(0.0, (h - 1) as f64));
        let (fx, fy) = (x - x.floor(), y - y.floor());
        let [x0, x1] = [0, 1].map(|k| (x.floor() as i64 + k).rem_euclid(w as i64) as usize);
        let [y0, y1] = [y as usize, (y as usize + 1).min(h - 1)];
        [0, 1, 2].map(|c| {
            let values = self.image.channel(c);
            let row =
                |y: usize| f64::from(values[y * w + x0]) * (1.0 - fx) + f64::from(values[y * w + x1]) * fx;
            self.scale[c] * (row(y0) * (1.0 - fy) + row(y1) * fy)
        })
    }
}

/// A slide projector: a point that throws a picture onto a square.
#[derive(Clone, Debug)]
pub struct Projector {
    /// Where it is, what it looks at, and what is up in its picture: it looks along its −z.
    pub pose: Pose,
    /// Angle between opposite sides of its square, degrees, in (0, 180).
    pub throw_deg: f64,
    /// Radiant intensity where the slide is 1, W/sr, ≥ 0.
    pub intensity: [f64; 3],
    /// Whether light falls off with the distance's square; if not, the intensity is an irradiance on a plane that faces the projector.
    pub falloff: bool,
    /// What it throws.
    pub slide: Slide,
}

impl Projector {
    /// What of the slide falls on a point of the stage, one a channel: none outside of its square and behind the projector.
    pub fn at(&self, point_m: DVec3) -> [f64; 3] {
        let p = self.pose.rotation.conjugate() * (point_m - self.pose.position_m);
        if p.z >= 0.0 {
            return [0.0; 3];
        }
        let half = (0.5 * self.throw_deg.to_radians()).tan() * -p.z;
        let [u, v] = [0.5 + 0.5 * p.x / half, 0.5 - 0.5 * p.y / half];
        self.slide.at(u, v)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stage::Pattern;

    /// The convention, direction by direction: −z in the middle, +x to its right, +y on top.
    #[test]
    fn an_environment_is_turned_as_it_says() {
        for (direction, [u, v]) in [
            (DVec3::NEG_Z, [0.5, 0.5]),
            (DVec3::X, [0.75, 0.5]),
            (DVec3::NEG_X, [0.25, 0.5]),
            (DVec3::new(0.0, 1.0, -1.0), [0.5, 0.25]),
            (DVec3::NEG_Y, [0.5, 1.0]),
        ] {
            let place = Environment::place(direction);
            assert!((place[1] - v).abs() < 1e-12, "{direction} {place:?}");
            assert!(v == 1.0 || (place[0] - u).abs() < 1e-12, "{direction} {place:?}");
            let back = Environment::direction([u, v]);
            assert!(back.distance(direction.normalize()) < 1e-12, "{back} {direction}");
        }
        // Four texels in a row: between the last and the first lies what is behind, +z.
        let rgb = [1.0, 2.0, 4.0, 8.0, 1.0, 2.0, 4.0, 8.0].map(|x| [x; 3]);
        let image = Arc::new(LinearImage::new(4, 2, &rgb));
        let environment = Environment { image, scale: [1.0, 2.0, 3.0] };
        let behind = environment.radiance(DVec3::Z);
        assert!((behind[0] - 4.5).abs() < 1e-9 && (behind[2] - 13.5).abs() < 1e-9, "{behind:?}");
    }

    /// The square that a projector lights is as wide as its throw, upright, and as right-handed as it sees it.
    #[test]
    fn a_slide_is_thrown_upright() {
        let rgb = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 1.0]];
        let slide = Slide::new(Pattern::Image(Arc::new(LinearImage::new(2, 2, &rgb))), 0.0, 0.1);
        let pose = Pose::looking(DVec3::new(0.0, 0.0, 2.0), DVec3::ZERO, DVec3::Y);
        let projector = Projector { pose, throw_deg: 90.0, intensity: [1.0; 3], falloff: true, slide };
        let at = |x, y, z| projector.at(DVec3::new(x, y, z));
        assert_eq!(at(-1.9, 1.9, 0.0), [1.0, 0.0, 0.0], "its top left is red");
        assert_eq!(at(1.9, 1.9, 0.0), [0.0, 1.0, 0.0], "its top right is green");
        assert_eq!(at(-1.9, -1.9, 0.0), [0.0, 0.0, 1.0], "its bottom left is blue");
        assert_eq!(at(2.1, 0.0, 0.0), [0.0; 3], "outside of the square");
        assert_eq!(at(0.0, 0.0, 3.0), [0.0; 3], "behind it");
    }
}
