//! The radiance that the display shows as white, and the brightest irradiance: found on bounds, without drawing.
//!
//! Emitters are parallel to the screen and share one centre, so that E⁰ falls with the distance from the foot of the lamp along both axes: over
//! a square of pixels it is at most that of the pixel nearest to the foot. With the largest albedo of the square this bounds what can be seen
//! there. Of all squares of all instants the one with the highest bound is cut in four, until it is a pixel.

mod peaks;

use std::collections::BinaryHeap;
use std::f64::consts::PI;

use kelir_frame::View;
use kelir_scene::{Ambient, Exposure, Theatre};

use crate::albedo::{self, PixelAlbedo};
use crate::irradiance::UnitRows;
use peaks::Peaks;

/// White for these instants of one scene (a still, or every frame of a timeline): the written radiance, or the brightest unshadowed
/// pixel over all instants and channels from the analytic E⁰ · albedo / π. It does not depend on the technique.
/// 1 when nothing is lit at all.
pub fn white<'a>(theatres: impl IntoIterator<Item = &'a Theatre>, view: &View) -> f64 {
    let theatres: Vec<&Theatre> = theatres.into_iter().collect();
    let written = theatres.iter().find_map(|theatre| match theatre.exposure {
        Exposure::White(radiance) => Some(radiance),
        Exposure::Auto => None,
    });
    let Some(first) = theatres.first() else { return 1.0 };
    let brightest = written.unwrap_or_else(|| {
        let peaks = Peaks::new(albedo::on_grid(&first.screen, view), view.size);
        let lights: Vec<Light> = theatres.iter().map(|theatre| Light::new(theatre, view)).collect();
        search(&lights, &peaks, |lit, albedo| lit * albedo / PI).0
    });
    if brightest > 0.0 { brightest } else { 1.0 }
}

/// The brightest unshadowed irradiance over pixels and channels.
pub fn brightest(theatre: &Theatre, view: &View) -> f64 {
    let peaks = Peaks::new(PixelAlbedo::Uniform([1.0; 3]), view.size);
    search(&[Light::new(theatre, view)], &peaks, |lit, _| lit).0
}

/// The light of one instant without puppets.
struct Light {
    emitters: Vec<([f64; 3], UnitRows)>,
    /// π times its radiance everywhere, as the stage is empty.
    dome: [f64; 3],
    /// Column and row of the foot of the lamp.
    foot: [f64; 2],
    size: [usize; 2],
}

impl Light {
    fn new(theatre: &Theatre, view: &View) -> Self {
        let (lamp, screen) = (&theatre.lamp, &theatre.screen);
        let rows = |shape| UnitRows::new(shape, lamp.position_m, screen, view.size);
        let [w, h] = view.size.map(|side| side as f64);
        let foot = [
            (lamp.position_m.x / screen.width_m + 0.5) * w - 0.5,
            (0.5 - lamp.position_m.y / screen.height_m) * h - 0.5,
        ];
        let dome = match theatre.ambient {
            Ambient::Dome { radiance } => radiance.map(|l| l * PI),
            _ => [0.0; 3],
        };
        let emitters = lamp.emitters.iter().map(|e| (e.radiance, rows(&e.shape))).collect();
        Self { emitters, dome, foot, size: view.size }
    }

    /// E⁰ in each channel at the pixel of a square that is nearest to the foot.
    fn lit(&self, level: u32, at: [usize; 2]) -> [f64; 3] {
        let nearest = |axis: usize| {
            let first = at[axis] << level;
            let last = ((at[axis] + 1) << level).min(self.size[axis]) - 1;
            self.foot[axis].round().clamp(first as f64, last as f64) as usize
        };
        let mut sums = [0.0; 3];
        let mut unit = [0.0];
        for (radiance, rows) in &self.emitters {
            rows.span(nearest(1), nearest(0), &mut unit);
            sums.iter_mut().zip(radiance).for_each(|(sum, radiance)| *sum += radiance * unit[0]);
        }
        [0, 1, 2].map(|c| sums[c] + self.dome[c])
    }
}

/// A square of 2^`level` pixels a side, so many squares from the left and the top, as it is lit at one instant.
struct Square {
    bound: f64,
    level: u32,
    at: [usize; 2],
    instant: usize,
}

impl Ord for Square {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        // Of equal bounds the smaller square comes first: it is nearer to being a pixel.
        self.bound.total_cmp(&other.bound).then(other.level.cmp(&self.level))
    }
}

impl PartialOrd for Square {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Square {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Square {}

/// The largest value of `seen` (of E⁰ and albedo) over all pixels, channels and instants, and how many squares were looked at.
fn search(lights: &[Light], peaks: &Peaks, seen: impl Fn(f64, f64) -> f64) -> (f64, usize) {
    let mut looked = 0;
    let mut square = |instant: usize, level: u32, at: [usize; 2]| {
        looked += 1;
        let light: &Light = &lights[instant];
        let lit = light.lit(level, at);
        let bound = (0..3).map(|c| seen(lit[c], f64::from(peaks.at(c, level, at)))).fold(0.0, f64::max);
        Square { bound, level, at, instant }
    };
    let mut open: BinaryHeap<Square> =
        (0..lights.len()).map(|instant| square(instant, peaks.levels(), [0, 0])).collect();
    while let Some(Square { bound, level, at, instant }) = open.pop() {
        if level == 0 {
            return (bound, looked);
        }
        let side = |axis: usize| lights[instant].size[axis].div_ceil(1 << (level - 1));
        for [x, y] in [[0, 0], [1, 0], [0, 1], [1, 1]] {
            let part = [2 * at[0] + x, 2 * at[1] + y];
            if part[0] < side(0) && part[1] < side(1) {
                open.push(square(instant, level - 1, part));
            }
        }
    }
    (0.0, looked)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]
    use std::sync::Arc;

    use glam::DVec3;
    use kelir_scene::{Albedo, Emitter, EmitterShape, Lamp, LinearImage, Screen};
    use proptest::prelude::*;

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

    /// White by its definition: every pixel looked at.
    fn drawn(theatres: &[Theatre], view: &View) -> f64 {
        let [w, h] = view.size;
        let mut most = 0f64;
        for theatre in theatres {
            let albedo = albedo::on_grid(&theatre.screen, view);
            let rows =
                |e: &Emitter| UnitRows::new(&e.shape, theatre.lamp.position_m, &theatre.screen, view.size);
            let rows: Vec<_> = theatre.lamp.emitters.iter().map(rows).collect();
            let mut units = vec![vec![0.0; w]; rows.len()];
            for j in 0..h {
                rows.iter().zip(&mut units).for_each(|(rows, unit)| rows.row(j, unit));
                for (i, c) in (0..w).flat_map(|i| (0..3).map(move |c| (i, c))) {
                    let lit: f64 = theatre
                        .lamp
                        .emitters
                        .iter()
                        .zip(&units)
                        .map(|(e, unit)| e.radiance[c] * unit[i])
                        .sum();
                    most = most.max(lit * f64::from(albedo.at(c, j * w + i)) / PI);
                }
            }
        }
        most
    }

    fn woven(grain: u32, screen: &mut Screen) {
        let rgb =
            (0..40 * 25u32).map(|k| [0, 1, 2].map(|c| 0.6 + (k.wrapping_mul(grain + c) % 97) as f32 / 400.0));
        screen.albedo = Albedo::Image(Arc::new(LinearImage::new(40, 25, &rgb.collect::<Vec<_>>())));
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]
        /// Lamps near, far and beside, of all shapes, on plain and woven cloths: the pixel that is found is the brightest of all.
        #[test]
        fn bounds_find_the_brightest_pixel(
            lamps in prop::collection::vec((-2.0..2.0f64, -2.0..2.0f64, 0.02..20.0f64), 1..4),
            sides in prop::collection::vec((0.001..1.0f64, 0.001..1.0f64, any::<bool>(), 0.0..9.0f64), 1..4),
            size in (1usize..70, 1usize..40), grain in prop::option::of(1u32..1000), area: bool,
        ) {
            let pixel = if area { Pixel::Area } else { Pixel::Centre };
            let view = View { size: [size.0, size.1], pixel, skip: true };
            let of = |(x, y, z): &(f64, f64, f64)| {
                let mut theatre = theatre(1.0, Ambient::None);
                theatre.lamp.position_m = DVec3::new(*x, *y, -*z);
                theatre.lamp.emitters = sides.iter().map(|(w, l, disk, radiance)| Emitter {
                    name: String::new(),
                    shape: if *disk { EmitterShape::Disk { radius_m: *w } } else { EmitterShape::Rectangle { size_m: [*w, *l] } },
                    radiance: [*radiance, 0.5 * radiance, 2.0],
                }).collect();
                if let Some(grain) = grain { woven(grain, &mut theatre.screen) }
                theatre
            };
            let theatres: Vec<Theatre> = lamps.iter().map(of).collect();
            let (found, drawn) = (white(&theatres, &view), drawn(&theatres, &view));
            prop_assert!((found / drawn - 1.0).abs() < 3e-8, "{found:e}, not {drawn:e}");
        }
    }

    /// Ten seconds of a lamp that swings, at the largest sizes: the squares that are looked at are few.
    #[test]
    fn little_is_looked_at() {
        for woven_cloth in [false, true] {
            let view = View { size: [3840, 2160], pixel: Pixel::Area, skip: true };
            let mut theatre = theatre(40.0, Ambient::None);
            if woven_cloth {
                woven(7, &mut theatre.screen);
            }
            let lights: Vec<Light> = (0..300)
                .map(|k| {
                    theatre.lamp.position_m.x = 0.3 * (f64::from(k) / 40.0).sin();
                    Light::new(&theatre, &view)
                })
                .collect();
            let peaks = Peaks::new(albedo::on_grid(&theatre.screen, &view), view.size);
            let looked = search(&lights, &peaks, |lit, albedo| lit * albedo).1;
            assert!(looked < 100_000, "{looked} of {} pixels", 300u64 * 3840 * 2160);
        }
    }
}
