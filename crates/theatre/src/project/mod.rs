//! Where a point of the screen sees an emitter on an occluder plane: a box where the plane is parallel to the screen, its ends spread over
//! a pixel ([`window`]), and a quadrilateral where it is not ([`tilted`]).

pub mod tilted;
pub mod window;

use glam::{DMat3, DVec2, DVec3};
use kelir_scene::{Plane, Screen};

/// The affine map from a screen point to the centre of its box in one plane's texel coordinates, and the box's size per
/// metre of emitter.
///
/// Texel coordinates: x rightwards from the grid's left edge, y *downwards* from its top edge, one unit a texel;
/// texel (i, j) covers [i, i+1] × [j, j+1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadowBox {
    /// Texels per metre of screen along x and y; y is negative because rows run downwards.
    pub scale: DVec2,
    /// Texel coordinates of what the screen's origin sees.
    pub offset: DVec2,
    /// Texels of the plane per metre of emitter along x and y, both positive: a half-side `a` gives a half-box `a · spread`.
    pub spread: DVec2,
}

impl ShadowBox {
    /// For `plane` (its tilt must be zero) lit from `lamp_m`; d is the plane's distance from the screen, z_l the lamp's:
    /// the box's centre is P(1 − d/z_l) + C·d/z_l, its half-sides are a·d/z_l.
    pub fn new(plane: &Plane, lamp_m: DVec3) -> Self {
        let ratio = plane.centre_m.z / lamp_m.z;
        let texels_per_m =
            DVec2::new(plane.mask.width as f64 / plane.size_m[0], plane.mask.height as f64 / plane.size_m[1]);
        let down = DVec2::new(1.0, -1.0);
        let corner = plane.centre_m.truncate() + 0.5 * DVec2::new(-plane.size_m[0], plane.size_m[1]);
        Self {
            scale: (1.0 - ratio) * texels_per_m * down,
            offset: (lamp_m.truncate() * ratio - corner) * texels_per_m * down,
            spread: ratio * texels_per_m,
        }
    }

    /// The box's centre in texel coordinates as the screen point `p_m` (metres) sees it.
    pub fn centre(&self, p_m: DVec2) -> DVec2 {
        self.scale * p_m + self.offset
    }
}

/// Whether a plane is not parallel to the screen.
pub fn is_tilted(plane: &Plane) -> bool {
    plane.tilt_deg != [0.0; 2]
}

/// A vector of the puppet's own frame in the theatre's: `R_y(tilt_deg[1]) · R_x(tilt_deg[0])`, right-handed.
pub fn turned(plane: &Plane, v: DVec3) -> DVec3 {
    let [about_x, about_y] = plane.tilt_deg.map(f64::to_radians);
    DMat3::from_rotation_y(about_y) * (DMat3::from_rotation_x(about_x) * v)
}

/// Width and height of the screen, metres.
pub fn sides_m(screen: &Screen) -> [f64; 2] {
    [screen.width_m, screen.height_m]
}

/// The centre of pixel (i, j) of `size` on the screen, metres; fractional pixels are points inside a pixel.
pub fn pixel_m(screen: &Screen, size: [usize; 2], i: f64, j: f64) -> DVec2 {
    DVec2::new(
        ((i + 0.5) / size[0] as f64 - 0.5) * screen.width_m,
        (0.5 - (j + 0.5) / size[1] as f64) * screen.height_m,
    )
}
