//! PCSS on a GPU beside the native code's.

use std::sync::Arc;

use glam::DVec3;
use kelir_frame::gpu::Gpu;
use kelir_frame::{Backend, Pixel, RenderError, View};
use kelir_scene::{
    Albedo, Ambient, Emitter, EmitterShape, Exposure, Lamp, Mask, Plane, Screen, Texels, Theatre,
};

use super::gpu::{OnGpu, WGSL};
use super::{Knobs, Pcss, renderer};
use crate::twins::{Bound, Drawn, Measure, Twin};

fn emitter(shape: EmitterShape) -> Emitter {
    Emitter { name: "lamp".into(), shape, radiance: [40.0, 30.0, 20.0] }
}

pub(super) fn square(side: f64) -> EmitterShape {
    EmitterShape::Rectangle { size_m: [side; 2] }
}

pub(super) fn plane(mask: Mask, z: f64, size_m: [f64; 2]) -> Plane {
    Plane { mask: Arc::new(mask), centre_m: DVec3::new(0.0, 0.0, z), size_m, tilt_deg: [0.0; 2] }
}

pub(super) fn theatre(shape: EmitterShape, planes: Vec<Plane>) -> Theatre {
    Theatre {
        screen: Screen { width_m: 1.6, height_m: 0.9, albedo: Albedo::Uniform([0.8, 0.7, 0.6]) },
        lamp: Lamp { position_m: DVec3::new(0.05, -0.02, -1.5), emitters: vec![emitter(shape)] },
        ambient: Ambient::None,
        planes,
        exposure: Exposure::Auto,
    }
}

/// Opaque for x < 0, higher than the screen.
pub(super) fn edge() -> Plane {
    plane(Mask::new(2, 1, 1, Texels::U8(vec![0, 255])), -0.4, [3.0, 3.0])
}

/// Blocks of several greys.
pub(super) fn blocks(channels: usize) -> Mask {
    let code =
        |k: usize| if (k % 80 / 7 + k / 80 / 5).is_multiple_of(2) { (k / 4800 * 60 + 40) as u8 } else { 255 };
    Mask::new(80, 60, channels, Texels::U8((0..4800 * channels).map(code).collect()))
}

/// Everything at once: two emitters of both shapes, coloured and tilted planes, the paper's ambient light.
pub(super) fn crooked() -> Theatre {
    let mut scene = theatre(
        square(0.1),
        vec![
            plane(blocks(3), -0.4, [0.8, 0.6]),
            Plane {
                tilt_deg: [20.0, -50.0],
                centre_m: DVec3::new(0.2, 0.1, -0.8),
                ..plane(blocks(1), 0.0, [0.3, 0.3])
            },
        ],
    );
    scene
        .lamp
        .emitters
        .push(Emitter { name: "disk".into(), ..emitter(EmitterShape::Disk { radius_m: 0.08 }) });
    scene.ambient = Ambient::Paper { k_d_m: 2.0, s: [0.3, 0.2, 0.1] };
    scene
}

pub(super) fn view(pixel: Pixel) -> View {
    View { size: [96, 54], pixel, skip: true }
}

/// Every texel is chosen in integers: the same image to the bit. A filter half as wide as the penumbra is told.
pub(crate) fn twins(gpu: &Gpu) -> Result<Vec<Twin>, RenderError> {
    let knobs = Knobs { blocker_samples: 9, filter_samples: 20, map_size: 128, ..Knobs::default() };
    let wrong = WGSL.replace("beam, centre, side, places", "beam, centre, side / 2, places");
    let on_gpu = |wgsl: &str| Ok::<_, RenderError>(Pcss::new(knobs, Some(OnGpu::new(gpu.clone(), wgsl)?)));
    let mut native = renderer(&knobs, Backend::Cpu)?;
    let (mut right, mut off) = (on_gpu(WGSL)?, on_gpu(&wrong)?);
    let mut drawn = Drawn { native: &mut *native, gpu: &mut right, off: &mut off };
    let upright = theatre(square(0.1), vec![edge(), plane(blocks(1), -0.7, [0.5, 0.4])]);
    let bounds =
        [Measure::Radiance, Measure::Layers, Measure::Codes].map(|measure| Bound::new(measure, 0.0, 0.0));
    let mut all = Vec::new();
    for (case, theatre) in [("a disk, a tilted plane, ambient light", crooked()), ("two planes", upright)] {
        all.extend(drawn.compare("pcss", case, (&theatre, &view(Pixel::Area)), &bounds)?);
    }
    Ok(all)
}
