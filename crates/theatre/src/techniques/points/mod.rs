//! Point lights: the lamp as n lights whose hard shadows are averaged (Avdić & Rančić); converges to the area light.
//!
//! Each emitter becomes √n × √n lights of equal power in the middles of its cells (a disk's through its area-preserving
//! map). Its visibility is their mean, so it tends to the geometric one, and few lights show as steps. `area` pixels
//! average over a lattice of points, so that a hard shadow's edge is no staircase.

use std::time::Instant;

use kelir_frame::{Backend, Frame, Meter, RenderError, Renderer, Stats, View, VisibilityModel};
use kelir_scene::Theatre;
use serde::{Deserialize, Serialize};

use crate::trace::Tracer;
use crate::trace::sobol::{Points, REPLICATES};
use kelir_frame::knobs::{self, Knob, Range};

#[cfg(feature = "gpu")]
mod twins;

#[cfg(feature = "gpu")]
pub(crate) use twins::twins;

/// Stands in the key of every job: raise it, and bless the golden images, with any change that can change a byte that this technique
/// draws, in its own files or in what it shares with others. What was made before is then made anew.
pub const REVISION: u32 = 3;

/// What can be turned.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Knobs {
    /// Lights an emitter: a square number, 1..=65536.
    pub lights: u32,
    /// Points along each side of an `area` pixel, 1..=8.
    pub subpixels: u32,
}

impl Default for Knobs {
    fn default() -> Self {
        Self { lights: 16, subpixels: 4 }
    }
}

impl Knobs {
    /// Errors: a knob out of its range.
    pub fn check(&self) -> Result<(), RenderError> {
        knobs::check(KNOBS, self)
    }
}

/// What can be turned, for files, command line and tables.
pub const KNOBS: &[Knob] = &[
    Knob {
        name: "lights",
        unit: "",
        range: Range::Square(1, 65536),
        about: "point lights that stand for each emitter",
    },
    Knob {
        name: "subpixels",
        unit: "",
        range: Range::Whole(1, 8),
        about: "points along each side of an area pixel",
    },
];

/// The renderer for `knobs` on `backend`.
pub fn renderer(knobs: &Knobs, backend: Backend) -> Result<Box<dyn Renderer<Theatre>>, RenderError> {
    knobs.check()?;
    Ok(Box::new(PointLights::new(*knobs, Tracer::new(backend)?)))
}

/// Lights that stand still.
struct PointLights {
    lights: Points,
    tracer: Tracer,
}

impl PointLights {
    fn new(knobs: Knobs, tracer: Tracer) -> Self {
        Self { lights: lattice(knobs.lights.isqrt() as usize, knobs.subpixels as usize), tracer }
    }
}

impl Renderer<Theatre> for PointLights {
    fn frame(&mut self, theatre: &Theatre, view: &View, visibilities: bool) -> Result<Frame, RenderError> {
        let (mut stats, clock) = (Stats::default(), Instant::now());
        let mut trace = self.tracer.trace(theatre, view, VisibilityModel::Geometric, visibilities)?;
        stats.step("prepare", clock);
        let clock = Instant::now();
        let rows = trace.all(&self.lights)?;
        stats.step("sample", clock);
        trace.count(&rows, self.lights.samples, &mut stats);
        // What the lanes of a lattice differ by is no error.
        Ok(Frame { standard_error: None, ..trace.frame(&rows, stats) })
    }

    fn watch(&mut self, meter: &Meter) {
        self.tracer.meter = meter.clone();
    }

    fn class(&self) -> String {
        self.tracer.class()
    }

    fn adapter(&self) -> String {
        self.tracer.adapter()
    }
}

/// The middles of `lights` × `lights` cells of the emitter, each for the middles of `subpixels` × `subpixels` cells of
/// the pixel; repeated until every lane has as many.
fn lattice(lights: usize, subpixels: usize) -> Points {
    let total = (lights * subpixels).pow(2);
    // 16 is a power of two: the lanes share out a multiple of it.
    let lanes = REPLICATES >> total.trailing_zeros().min(REPLICATES.trailing_zeros());
    let samples = total * lanes / REPLICATES;
    let middle = |k: usize, n: usize| (((k as f64 + 0.5) / n as f64 - 0.5) * 2f64.powi(32)) as i64 as u32;
    let coordinate = |k: usize, d: usize| match d {
        0 => middle(k % lights, lights),
        1 => middle(k / lights % lights, lights),
        2 => middle(k / lights.pow(2) % subpixels, subpixels),
        _ => middle(k / lights.pow(2) / subpixels, subpixels),
    };
    let dims = [0, 1, 2, 3].map(|d| (0..samples * REPLICATES).map(|i| coordinate(i % total, d)).collect());
    Points { seed: 0, samples, scrambled: false, dims }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]
    use super::twins::scene;
    use super::*;
    use crate::pa;
    use kelir_frame::{Frame, Pixel, View};

    fn draw(knobs: Knobs, pixel: Pixel) -> Frame {
        let view = View { size: [96, 54], pixel, skip: true };
        renderer(&knobs, Backend::Cpu).unwrap().radiance(&scene(), &view).unwrap()
    }

    fn rms(a: &Frame, b: &Frame) -> f64 {
        assert_eq!(a.visibilities[0].name(), b.visibilities[0].name());
        let squares: f64 = a.visibilities[0]
            .values
            .iter()
            .zip(&b.visibilities[0].values)
            .map(|(a, b)| f64::from(a - b).powi(2))
            .sum();
        (squares / a.visibilities[0].values.len() as f64).sqrt()
    }

    /// One light is one look-up; more lights come nearer to the area light, which PA knows exactly.
    #[test]
    fn more_lights_come_nearer() {
        for pixel in [Pixel::Centre, Pixel::Area] {
            let view = View { size: [96, 54], pixel, skip: true };
            let exact = pa::renderer(&pa::Knobs::default(), Backend::Cpu).unwrap();
            let exact = { exact }.radiance(&scene(), &view).unwrap();
            let errors = [1, 4, 16, 64, 256].map(|lights| {
                let frame = draw(Knobs { lights, ..Knobs::default() }, pixel);
                assert_eq!(frame.visibilities.len(), 1);
                rms(&frame, &exact)
            });
            // A lattice against a lattice of texels: not every step helps as much.
            assert!(errors.windows(2).all(|e| e[1] < e[0]), "{errors:?}");
            assert!(errors[0] > 0.05 && errors[4] < 0.1 * errors[0], "{errors:?}");
        }
        let hard = draw(Knobs { lights: 1, subpixels: 1 }, Pixel::Centre);
        let codes = hard.visibilities[0].values.iter().map(|v| f64::from(*v) * 255.0);
        assert!({ codes }.all(|c| (c - 40.0).abs() < 1e-3 || (c - 255.0).abs() < 1e-3));
    }

    #[test]
    fn refuses_other_numbers() {
        for knobs in [Knobs { lights: 5, subpixels: 1 }, Knobs { lights: 0, subpixels: 1 }] {
            assert!(renderer(&knobs, Backend::Cpu).err().unwrap().to_string().contains("lights"));
        }
        assert!(renderer(&Knobs { lights: 4, subpixels: 9 }, Backend::Cpu).is_err());
    }
}
