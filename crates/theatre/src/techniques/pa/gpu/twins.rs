//! PA on a GPU beside the native code's, which draws whatever it draws to 2e-6 of visibility and one display code.

use kelir_frame::gpu::Gpu;
use kelir_frame::{Pixel, RenderError, View};
use kelir_scene::Theatre;

use super::super::{Knobs, Native, Weights};
use super::scenes::{extremes, features, scenes, slopes, view};
use super::{OnGpu, Shaders};
use crate::twins::{Bound, Drawn, Measure, Twin};

/// Visibilities and display codes; of what is off too.
const BOUNDS: [Bound; 2] =
    [Bound::new(Measure::Visibility, 2e-6, 5e-3), Bound::new(Measure::Codes, 1.0, 1.0)];
/// The dome is light, not visibility.
const DOME: [Bound; 2] =
    [Bound::without_control(Measure::Visibility, 2e-6), Bound::new(Measure::Codes, 1.0, 1.0)];

/// Shaders that see 3 % less: by upright planes, by tilted ones; and one that gives a tenth less light.
pub(super) fn wrong() -> [Shaders; 3] {
    let right = Shaders::default;
    let visibility =
        right().visibility.replace("    return select(mean,", "    mean *= 0.97;\n    return select(mean,");
    let tilted = right().tilted.replace("* params.norm;", "* params.norm * 0.97;");
    let shade = right().shade.replace("clamp(sum, 0.0, 1.0)", "clamp(sum * 0.9, 0.0, 1.0)");
    [Shaders { visibility, ..right() }, Shaders { tilted, ..right() }, Shaders { shade, ..right() }]
}

/// The right passes and those that are off: compiling takes longer than drawing, so pipelines are kept from scene to scene.
struct Passes {
    right: OnGpu,
    off: [OnGpu; 3],
}

impl Passes {
    fn compare(
        &mut self,
        case: &str,
        (theatre, view): (&Theatre, &View),
        knobs: Knobs,
        bounds: &[Bound],
    ) -> Result<Vec<Twin>, RenderError> {
        let tilted = theatre.planes.iter().any(|plane| plane.tilt_deg != [0.0; 2]);
        let dome = matches!(theatre.ambient, kelir_scene::Ambient::Dome { .. });
        let off = &mut self.off[if dome { 2 } else { usize::from(tilted) }];
        (self.right.knobs, off.knobs) = (knobs, knobs);
        let mut drawn = Drawn { native: &mut Native::new(knobs), gpu: &mut self.right, off };
        drawn.compare("pa", case, (theatre, view), bounds)
    }
}

/// Every scene, feature and extreme.
pub(crate) fn twins(gpu: &Gpu) -> Result<Vec<Twin>, RenderError> {
    let plain = Knobs::default();
    let [upright, tilted, shade] = wrong().map(|shaders| OnGpu::new(gpu.clone(), plain, &shaders));
    let right = OnGpu::new(gpu.clone(), plain, &Shaders::default())?;
    let mut passes = Passes { right, off: [upright?, tilted?, shade?] };
    let mut all = Vec::new();
    let split = Knobs { split: 2, weights: Weights::Irradiance, ..plain };
    for (knobs, pixel, turned) in [
        (plain, Pixel::Centre, ""),
        (plain, Pixel::Area, ""),
        (split, Pixel::Area, ", pieces weighed by irradiance"),
    ] {
        for (name, scene) in scenes() {
            let case = format!("{name}{turned}");
            all.extend(passes.compare(&case, (&scene, &view(pixel)), knobs, &BOUNDS)?);
        }
    }
    for (k, (name, scene, knobs)) in features().into_iter().enumerate() {
        let pixel = if k % 3 == 2 { Pixel::Centre } else { Pixel::Area };
        let bounds = if name.starts_with("dome") { &DOME } else { &BOUNDS };
        all.extend(passes.compare(name, (&scene, &small(pixel)), knobs, bounds)?);
    }
    let seen = |most| [Bound::new(Measure::Visibility, most, 1e-3)];
    for (case, scene) in extremes() {
        all.extend(passes.compare(&case, (&scene, &small(Pixel::Area)), plain, &seen(4e-6))?);
    }
    for (case, scene, most) in slopes() {
        all.extend(passes.compare(&case, (&scene, &small(Pixel::Area)), plain, &seen(most))?);
    }
    Ok(all)
}

fn small(pixel: Pixel) -> View {
    View { size: [96, 54], ..view(pixel) }
}
