//! The radiance that the display shows as white.

use kelir_scene::{Exposure, Theatre};

use crate::{View, albedo, irradiance};

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
        let mut sums = [0, 1, 2].map(|_| vec![0f64; view.size[0] * view.size[1]]);
        for emitter in &theatre.lamp.emitters {
            let unit =
                irradiance::unit_image(&emitter.shape, theatre.lamp.position_m, &theatre.screen, view.size);
            for (sum, radiance) in sums.iter_mut().zip(emitter.radiance) {
                sum.iter_mut().zip(&unit).for_each(|(s, u)| *s += radiance * u);
            }
        }
        for (c, sum) in sums.iter().enumerate() {
            for (k, e) in sum.iter().enumerate() {
                brightest = brightest.max(e * f64::from(albedo.at(c, k)) / std::f64::consts::PI);
            }
        }
    }
    if brightest > 0.0 { brightest } else { 1.0 }
}
