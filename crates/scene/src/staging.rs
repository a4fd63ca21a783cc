//! Where lamp and puppets are at one instant, and whether they may be there.

use glam::DVec3;

use crate::limits::{GRID_SIDE, SCENE_TEXELS};
use crate::puppet::figure::Posed;
use crate::puppet::figure::{Figure, Pose};
use crate::puppet::grid::Rect;
use crate::puppet::manifest::Part;
use crate::theatre::{Mask, Plane};
use crate::timeline::{Target, Timeline};
use std::sync::Arc;

/// Everything that a timeline can change, at one instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Staging {
    /// The lamp's centre, metres.
    pub lamp_m: DVec3,
    /// Where each puppet is, in the order of [`Scene::puppets`](crate::Scene::puppets).
    pub puppets: Vec<Setting>,
}

/// Where one puppet is and how it is posed.
#[derive(Clone, Debug, PartialEq)]
pub struct Setting {
    /// Its centre, metres.
    pub position_m: DVec3,
    /// Its plane's turn about x, then about y, degrees.
    pub tilt_deg: [f64; 2],
    /// Its parts and its turn in the plane.
    pub pose: Pose,
}

impl Staging {
    /// This staging with what the timeline drives as it is at `instant_s`.
    pub(crate) fn at(&self, timeline: &Timeline, instant_s: f64) -> Staging {
        let mut staging = self.clone();
        for track in &timeline.tracks {
            let value = track.value(instant_s);
            let vector = || DVec3::from_slice(&value);
            match track.target {
                Target::LampPosition => staging.lamp_m = vector(),
                Target::Position(p) => staging.puppets[p].position_m = vector(),
                Target::Tilt(p) => staging.puppets[p].tilt_deg = [value[0], value[1]],
                Target::Rotate(p) => staging.puppets[p].pose.rotate_deg = value[0],
                Target::Pose(p, part) => staging.puppets[p].pose.parts_deg[part] = value[0],
                Target::Stage(_) => {}
            }
        }
        staging
    }
}

/// A puppet of a scene: what it is made of, wherever it is.
#[derive(Debug)]
pub struct Puppet {
    pub(crate) image: String,
    pub(crate) parts: Vec<Part>,
    pub(crate) figure: Figure,
    /// A texel's side.
    pub(crate) texel_m: f64,
}

/// What keeps a puppet from being where a staging has it.
pub(crate) enum Misplaced {
    /// The centre is at this z.
    Centre(f64),
    /// A corner is at this z.
    Corner(f64),
    /// The grid has these sides.
    Grid([usize; 2]),
}

impl Puppet {
    /// The path of its SVG, PNG or manifest, as the scene has it.
    pub fn image(&self) -> &str {
        &self.image
    }

    /// Its parts in drawing order; none where it is one piece.
    pub fn parts(&self) -> &[Part] {
        &self.parts
    }

    /// The occluder plane of a setting whose mask covers the texels of `extent`.
    fn plane(&self, setting: &Setting, extent: Rect, mask: Arc<Mask>) -> Plane {
        let (centre, size) = self.figure.placement(extent);
        let mut plane = Plane {
            mask,
            centre_m: setting.position_m,
            size_m: size.map(|s| s * self.texel_m),
            tilt_deg: setting.tilt_deg,
        };
        plane.centre_m = plane.point_m(centre[0] * self.texel_m, centre[1] * self.texel_m);
        plane
    }

    /// The plane of a setting, with the mask of its pose.
    pub(crate) fn posed(&self, setting: &Setting, posed: Posed) -> Plane {
        self.plane(setting, posed.extent, posed.mask)
    }

    /// Whether a setting is between lamp and screen with every corner, and its grid bearable; the grid's texel values.
    pub(crate) fn check(
        &self,
        setting: &Setting,
        lamp_z_m: f64,
        nothing: &Arc<Mask>,
    ) -> Result<usize, Misplaced> {
        let backstage = |z: f64| z > lamp_z_m && z < 0.0;
        if !backstage(setting.position_m.z) {
            return Err(Misplaced::Centre(setting.position_m.z));
        }
        let extent = self.figure.extent(&setting.pose);
        if extent.width() > GRID_SIDE || extent.height() > GRID_SIDE || extent.area() > SCENE_TEXELS {
            return Err(Misplaced::Grid([extent.width(), extent.height()]));
        }
        let plane = self.plane(setting, extent, nothing.clone());
        match plane.corners_m().iter().find(|corner| !backstage(corner.z)) {
            Some(corner) => Err(Misplaced::Corner(corner.z)),
            None => Ok(extent.area() * self.figure.channels()),
        }
    }
}
