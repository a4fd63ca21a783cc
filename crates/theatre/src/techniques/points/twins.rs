//! Point lights on a GPU beside the native code's.

use std::sync::Arc;

use glam::DVec3;
use kelir_frame::gpu::Gpu;
use kelir_frame::{Backend, Pixel, RenderError, View};
use kelir_scene::{
    Albedo, Ambient, Emitter, EmitterShape, Exposure, Lamp, Mask, Plane, Screen, Texels, Theatre,
};

use super::{Knobs, PointLights, renderer};
use crate::trace::{Tracer, gpu::WGSL};
use crate::twins::{Bound, Drawn, Measure, Twin};

/// A checkered puppet before one emitter.
pub(super) fn scene() -> Theatre {
    let texels = (0..80 * 60).map(|k| if (k % 80 / 7 + k / 80 / 5) % 2 == 0 { 40 } else { 255 }).collect();
    Theatre {
        screen: Screen { width_m: 1.6, height_m: 0.9, albedo: Albedo::Uniform([0.8; 3]) },
        lamp: Lamp {
            position_m: DVec3::new(0.05, -0.02, -1.5),
            emitters: vec![Emitter {
                name: "lamp".into(),
                shape: EmitterShape::Rectangle { size_m: [0.1, 0.1] },
                radiance: [40.0; 3],
            }],
        },
        ambient: Ambient::None,
        planes: vec![Plane {
            mask: Arc::new(Mask::new(80, 60, 1, Texels::U8(texels))),
            centre_m: DVec3::new(0.0, 0.0, -0.4),
            size_m: [0.8, 0.6],
            tilt_deg: [0.0; 2],
        }],
        exposure: Exposure::Auto,
    }
}

/// A sample may fall on the other side of a texel's edge; four lights in place of nine are told.
pub(crate) fn twins(gpu: &Gpu) -> Result<Vec<Twin>, RenderError> {
    let knobs = Knobs { lights: 9, subpixels: 2 };
    let on_gpu = |knobs| Ok::<_, RenderError>(PointLights::new(knobs, Tracer::with_shader(gpu, WGSL)?));
    let view = View { size: [96, 54], pixel: Pixel::Area, skip: true };
    let mut native = renderer(&knobs, Backend::Cpu)?;
    let (mut right, mut off) = (on_gpu(knobs)?, on_gpu(Knobs { lights: 4, ..knobs })?);
    let mut drawn = Drawn { native: &mut *native, gpu: &mut right, off: &mut off };
    let bounds = [Bound::new(Measure::LayersRms, 1e-3, 1e-2)];
    drawn.compare("points", "a checkered puppet", (&scene(), &view), &bounds)
}
