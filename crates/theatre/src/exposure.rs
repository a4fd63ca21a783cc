//! The radiance that the display shows as white.

use kelir_frame::View;
use kelir_scene::{Ambient, Exposure, Theatre};
use rayon::prelude::*;

use crate::{albedo, irradiance::UnitRows};

/// White for these theatres (a still, or every frame of a timeline): the written radiance, or the brightest unshadowed
/// pixel over all theatres and channels from the analytic E⁰ · albedo / π. It does not depend on the technique.
/// 1 when nothing is lit at all.
pub fn white<'a>(theatres: impl IntoIterator<Item = &'a Theatre>, view: &View) -> f64 {
    let mut brightest = 0f64;
    for theatre in theatres {
        if let Exposure::White(radiance) = theatre.exposure {
            return radiance;
        }
        let albedo = albedo::on_grid(&theatre.screen, view);
        let [w, h] = view.size;
        let lamp = &theatre.lamp;
        let units: Vec<_> = lamp
            .emitters
            .iter()
            .map(|e| (e.radiance, UnitRows::new(&e.shape, lamp.position_m, &theatre.screen, view.size)))
            .collect();
        // The dome over an empty stage: π times its radiance everywhere.
        let dome = match theatre.ambient {
            Ambient::Dome { radiance } => radiance.map(|l| l * std::f64::consts::PI),
            _ => [0.0; 3],
        };
        let row = |j: usize| {
            let (mut unit, mut sums) = (vec![0f64; w], [0, 1, 2].map(|_| vec![0f64; w]));
            for (radiance, rows) in &units {
                rows.row(j, &mut unit);
                for (sum, radiance) in sums.iter_mut().zip(radiance) {
                    sum.iter_mut().zip(&unit).for_each(|(s, u)| *s += radiance * u);
                }
            }
            let lit = |c: usize, i: usize| {
                (sums[c][i] + dome[c]) * f64::from(albedo.at(c, j * w + i)) / std::f64::consts::PI
            };
            (0..3).flat_map(|c| (0..w).map(move |i| (c, i))).fold(0f64, |m, (c, i)| m.max(lit(c, i)))
        };
        brightest = brightest.max((0..h).into_par_iter().map(row).reduce(|| 0.0, f64::max));
    }
    if brightest > 0.0 { brightest } else { 1.0 }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]
    use glam::DVec3;
    use kelir_scene::{Albedo, Emitter, EmitterShape, Lamp, Screen};

    use super::*;
    use crate::pa;
    use kelir_frame::{Backend, Pixel};

    fn theatre(radiance: f64, ambient: Ambient) -> Theatre {
        Theatre {
            screen: Screen { width_m: 1.6, height_m: 0.9, albedo: Albedo::Uniform([0.8, 0.7, 0.6]) },
            lamp: Lamp {
                position_m: DVec3::new(0.0, 0.0, -1.5),
                emitters: vec![Emitter {
                    name: "lamp".into(),
                    shape: EmitterShape::Rectangle { size_m: [0.1, 0.1] },
                    radiance: [radiance; 3],
                }],
            },
            ambient,
            planes: Vec::new(),
            exposure: Exposure::Auto,
        }
    }

    /// A uniform dome alone: E = π L everywhere, so that the screen's radiance is albedo · L. It adds to the lamp's light, and the brightest
    /// pixel drawn is exactly white.
    #[test]
    fn white_counts_the_dome() {
        let view = View { size: [33, 19], pixel: Pixel::Area, skip: true };
        let dome = Ambient::Dome { radiance: [3.0, 2.0, 1.0] };
        let alone = white([&theatre(0.0, dome)], &view);
        assert!((alone / (0.8 * 3.0) - 1.0).abs() < 1e-6, "{alone}");
        let (both, lamp) = (theatre(100.0, dome), white([&theatre(100.0, Ambient::None)], &view));
        let white = white([&both], &view);
        assert!((white / (lamp + alone) - 1.0).abs() < 1e-6, "{white}, not {lamp} + {alone}");
        let mut renderer = pa::renderer(&pa::Knobs::default(), Backend::Cpu).unwrap();
        let frame = renderer.radiance(&both, &view).unwrap();
        let brightest = frame.radiance.iter().flatten().fold(0f32, |m, l| m.max(*l));
        assert!((f64::from(brightest) / white - 1.0).abs() < 1e-6, "{brightest}, not {white}");
    }
}
