//! Monte Carlo on a GPU beside the native code's.

use std::sync::Arc;

use glam::DVec3;
use kelir_frame::gpu::Gpu;
use kelir_frame::{Backend, Pixel, RenderError, View};
use kelir_scene::{Ambient, EmitterShape, Theatre};

use super::{Knobs, Mc, renderer};
use crate::trace::Tracer;
use crate::trace::gpu::WGSL;
use crate::trace::scenes::{edge, theatre, view};
use crate::twins::{Bound, Drawn, Measure, Twin};

/// A theatre with everything that makes a box more than a rectangle: a disk, tilted planes, the dome.
pub(super) fn crooked() -> Theatre {
    let mut theatre = theatre(edge(1), Ambient::Dome { radiance: [0.3, 0.2, 0.1] });
    theatre.lamp.emitters[0].shape = EmitterShape::Disk { radius_m: 0.08 };
    theatre.planes[0].tilt_deg = [20.0, -35.0];
    let mut second = theatre.planes[0].clone();
    second.centre_m = DVec3::new(0.2, 0.25, -0.9);
    second.size_m = [0.5, 0.4];
    second.tilt_deg = [0.0, 0.0];
    theatre.planes.push(second);
    theatre
}

/// Two puppets, one of them coloured, in the paper's ambient light.
fn several() -> Theatre {
    let mut theatre = theatre(edge(3), Ambient::Paper { k_d_m: 1.0, s: [0.3, 0.2, 0.1] });
    let mut second = theatre.planes[0].clone();
    second.centre_m = DVec3::new(0.1, 0.1, -0.7);
    second.mask = Arc::new(edge(1));
    theatre.planes.push(second);
    theatre
}

/// The GPU draws the very same points, so it differs from the native code by f32 rounding alone: at worst one of 256 samples falls on the
/// other side of a texel's edge. Weights that are 2 % off are told, and where nothing hangs, so that they weigh nothing, a visibility that
/// samples deviate from which is.
pub(crate) fn twins(gpu: &Gpu) -> Result<Vec<Twin>, RenderError> {
    let knobs = Knobs { spp: 256, seed: 3, ..Knobs::default() };
    let wrong = WGSL.replace("(seen - v0) * (1.0 / (w * w))", "(seen - 0.98 * v0) * (0.98 / (w * w))");
    let mut native = renderer(&knobs, Backend::Cpu)?;
    let mut right = Mc::new(knobs, Tracer::with_shader(gpu, WGSL)?);
    let mut off = Mc::new(knobs, Tracer::with_shader(gpu, &wrong)?);
    let mut drawn = Drawn { native: &mut *native, gpu: &mut right, off: &mut off };
    let one = theatre(edge(1), Ambient::None);
    let bare = Theatre { planes: vec![], ..one.clone() };
    let bounds = [Bound::new(Measure::Radiance, 5e-4, 5e-3), Bound::without_control(Measure::Layers, 5e-3)];
    let lit = [Bound::new(Measure::Radiance, 1e-6, 5e-3)];
    let mut all = Vec::new();
    for (case, theatre, view, bounds) in [
        ("nothing hangs", &bare, View { skip: false, ..view(Pixel::Area) }, &lit[..]),
        ("an edge", &one, view(Pixel::Centre), &bounds),
        ("two puppets, coloured, ambient light", &several(), view(Pixel::Area), &bounds),
        ("a disk, tilted planes, the dome", &crooked(), view(Pixel::Area), &bounds),
    ] {
        all.extend(drawn.compare("mc", case, (theatre, &view), bounds)?);
    }
    Ok(all)
}
