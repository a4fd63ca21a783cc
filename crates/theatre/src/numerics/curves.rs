//! The error of what is not exact, over the knob that buys it down.

use kelir_frame::{Frame, Pixel, RenderError, Renderer, View};
use kelir_scene::{Albedo, Ambient, EmitterShape, Theatre};
use rayon::prelude::*;

use super::cases::{self, Case};
use crate::oracle::{self, Point};
use crate::pa::{Knobs, Native, Variant, Weights};

const VIEW: View = View { size: [96, 54], pixel: Pixel::Centre, skip: true };
/// Every how many columns and rows are compared: enough to meet every part of the shadow.
const STEP: usize = 5;
/// Where the oracle subdivides, until two levels differ by less.
const TOLERANCE: f64 = 1e-5;

/// The errors of one thing over one knob.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Curve {
    /// What is drawn.
    pub name: String,
    /// The knob.
    pub knob: &'static str,
    /// Its default.
    pub default: u32,
    /// What it is compared in.
    pub of: &'static str,
    /// From cheap to dear.
    pub steps: Vec<Step>,
}

/// One value of a knob.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Step {
    /// The knob's value.
    pub value: u32,
    /// Root mean square of the error over the compared pixels that are neither wholly lit nor wholly dark.
    pub rmse: f64,
    /// The largest.
    pub max: f64,
}

/// What the oracle says at the compared pixels.
struct Truth {
    /// Row-major indices of pixels.
    pixels: Vec<usize>,
    values: Vec<f64>,
}

impl Truth {
    fn new(of: impl Fn(Point) -> f64 + Sync, theatre: &Theatre) -> Self {
        let [w, h] = VIEW.size;
        let pixels: Vec<usize> =
            (0..w * h).filter(|k| (k % w).is_multiple_of(STEP) && (k / w).is_multiple_of(STEP)).collect();
        let values = pixels.par_iter().map(|k| of(Point::pixel(theatre, &VIEW, k % w, k / w))).collect();
        Self { pixels, values }
    }

    fn error(&self, value: u32, image: impl Fn(usize) -> f64) -> Step {
        let (mut sum, mut count, mut max) = (0.0, 0, 0f64);
        for (k, truth) in self.pixels.iter().zip(&self.values) {
            let error = image(*k) - truth;
            max = super::worst(max, error);
            if *truth > 1e-9 && *truth < 1.0 - 1e-9 {
                sum += error * error;
                count += 1;
            }
        }
        Step { value, rmse: (sum / f64::from(count.max(1))).sqrt(), max }
    }
}

fn draw(theatre: &Theatre, knobs: Knobs) -> Result<Frame, RenderError> {
    Native::new(knobs).radiance(theatre, &VIEW)
}

/// A curve of PA's visibility of the first emitter.
fn curve(
    name: &str,
    knob: &'static str,
    of: &'static str,
    theatre: &Theatre,
    knobs: &[(u32, Knobs)],
    default: u32,
) -> Result<Curve, RenderError> {
    let truth = Truth::new(
        |p| match of {
            "Virr" => oracle::visibility(theatre, 0, p, TOLERANCE).irradiance[0],
            _ => oracle::geometric(theatre, 0, p, TOLERANCE)[0],
        },
        theatre,
    );
    let steps = knobs
        .iter()
        .map(|(value, knobs)| {
            let frame = draw(theatre, *knobs)?;
            Ok(truth.error(*value, |k| f64::from(frame.visibilities[0].values[k])))
        })
        .collect::<Result<_, RenderError>>()?;
    Ok(Curve { name: name.into(), knob, default, of, steps })
}

/// The dome's share of light that the puppets let through.
fn dome(distance_m: f64) -> Result<Curve, RenderError> {
    let mut theatre = Case { distance_m, side: 96, ..figure() }.theatre();
    theatre.ambient = Ambient::Dome { radiance: [1.0; 3] };
    theatre.lamp.emitters[0].radiance = [0.0; 3];
    theatre.screen.albedo = Albedo::Uniform([1.0; 3]);
    let at = |p: Point| match p {
        Point::At(p) | Point::Over(p, _) => oracle::dome(&theatre, p)[0],
    };
    let truth = Truth::new(at, &theatre);
    let default = Knobs::default().dome_steps;
    let steps = [4, 8, 16, 32, 64]
        .into_iter()
        .map(|value| {
            let frame = draw(&theatre, Knobs { dome_steps: value, ..Knobs::default() })?;
            Ok(truth.error(value, |k| f64::from(frame.radiance[0][k])))
        })
        .collect::<Result<_, RenderError>>()?;
    let name = format!("dome, puppet {distance_m} m off the screen");
    Ok(Curve { name, knob: "dome_steps", default, of: "E_a / E_a⁰", steps })
}

fn figure() -> Case {
    let emitters = vec![([0.1, 0.1], 40.0)];
    Case { side: 64, emitters, distance_m: 0.5, height_m: 0.5, ..cases::plain() }
}

/// Every curve, each held against the oracle. Errors: as drawing.
pub fn curves() -> Result<Vec<Curve>, RenderError> {
    let split = |weights: Weights| {
        [1, 2, 4, 8, 16].map(|split| (split, Knobs { split, weights, ..Knobs::default() }))
    };
    let (area, meter) = (split(Weights::Area), split(Weights::Irradiance));
    let mut all = Vec::new();
    for degrees in [15.0, 45.0, 75.0] {
        let theatre = Case { tilt_deg: [0.0, degrees], ..figure() }.theatre();
        let name = format!("tilted by {degrees}°");
        all.push(curve(&name, "split", "Vgeo", &theatre, &area, 1)?);
        if degrees == 45.0 {
            all.push(curve(&format!("{name}, weighed by E⁰"), "split", "Virr", &theatre, &meter, 1)?);
        }
    }
    let mut two = figure().theatre();
    let mut further = two.planes[0].clone();
    further.centre_m.z *= 1.7;
    further.centre_m.x += 0.03;
    two.planes.push(further);
    all.push(curve("two planes", "split", "Vgeo", &two, &area, 1)?);
    all.push(curve("two planes, weighed by E⁰", "split", "Virr", &two, &meter, 1)?);
    // A large emitter near the screen: its parts light a point very differently.
    let near =
        Case { lamp_m: [0.05, -0.03, -0.6], distance_m: 0.3, emitters: vec![([0.3; 2], 1.0)], ..figure() };
    all.push(curve("one plane, weighed by E⁰", "split", "Virr", &near.theatre(), &meter, 1)?);
    let mut disk = figure().theatre();
    disk.lamp.emitters[0].shape = EmitterShape::Disk { radius_m: 0.05 };
    let strips = [4, 16, 64, 256].map(|strips| (strips, Knobs { strips, ..Knobs::default() }));
    all.push(curve("disk", "strips", "Vgeo", &disk, &strips, Knobs::default().strips)?);
    for distance_m in [0.5, 0.1, 0.02] {
        all.push(dome(distance_m)?);
    }
    let maps =
        [128, 512, 2048].map(|n| (n, Knobs { variant: Variant::ShadowMap, map_size: n, ..Knobs::default() }));
    let fine = Case { side: 512, ..figure() }.theatre();
    all.push(curve("the paper's shadow map", "map_size", "Vgeo", &fine, &maps, Knobs::default().map_size)?);
    Ok(all)
}
