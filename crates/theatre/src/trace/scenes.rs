//! What comparisons and tests draw.

use std::sync::Arc;

use glam::DVec3;
use kelir_frame::{Pixel, View};
use kelir_scene::{
    Albedo, Ambient, Emitter, EmitterShape, Exposure, Lamp, Mask, Plane, Screen, Texels, Theatre,
};

/// A half-plane: opaque for x < 0.
pub(crate) fn edge(channels: usize) -> Mask {
    let (w, h) = (64, 36);
    let code = |k: usize| if k % w < w / 2 { 0 } else { 255 };
    Mask::new(w, h, channels, Texels::U8((0..w * h * channels).map(code).collect()))
}

/// Two emitters before one plane.
pub(crate) fn theatre(mask: Mask, ambient: Ambient) -> Theatre {
    let emitter = |name: &str, side: f64, radiance: f64| Emitter {
        name: name.into(),
        shape: EmitterShape::Rectangle { size_m: [side, side] },
        radiance: [radiance, 0.8 * radiance, 0.5 * radiance],
    };
    Theatre {
        screen: Screen { width_m: 1.6, height_m: 0.9, albedo: Albedo::Uniform([0.8, 0.7, 0.6]) },
        lamp: Lamp {
            position_m: DVec3::new(0.05, -0.02, -1.5),
            emitters: vec![emitter("inner", 0.02, 2000.0), emitter("outer", 0.1, 40.0)],
        },
        ambient,
        planes: vec![Plane {
            mask: Arc::new(mask),
            centre_m: DVec3::new(0.0, 0.0, -0.4),
            size_m: [1.2, 0.675],
            tilt_deg: [0.0; 2],
        }],
        exposure: Exposure::Auto,
    }
}

/// A small view.
pub(crate) fn view(pixel: Pixel) -> View {
    View { size: [48, 27], pixel, skip: true }
}
