//! The inner loops, each alone and ready to run again and again.

use std::hint::black_box;
use std::sync::Arc;

use glam::DVec3;
use kelir_frame::encode::Srgb;
use kelir_frame::{Pixel, View};
use kelir_scene::{
    Albedo, Ambient, Emitter, EmitterShape, Exposure, Lamp, Mask, Plane, Screen, Texels, Theatre,
};
use rayon::prelude::*;

use crate::pa::plan::Plan;
use crate::pa::rows::Combined;
use crate::pa::table::Table;
use crate::{pa, trace};

/// One loop and how many texels, pixels, values or samples it goes through.
pub struct Kernel {
    /// Items of one run.
    pub items: usize,
    once: Box<dyn FnMut()>,
}

impl Kernel {
    /// Goes through all items once.
    pub fn run(&mut self) {
        (self.once)();
    }
}

impl std::fmt::Debug for Kernel {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Kernel").field("items", &self.items).finish_non_exhaustive()
    }
}

fn code(k: usize) -> u16 {
    (k.wrapping_mul(2_654_435_761) >> 13) as u16
}

fn mask(side: usize, bits: u32) -> Mask {
    let texels = match bits {
        16 => Texels::U16((0..side * side).map(code).collect()),
        _ => Texels::U8((0..side * side).map(|k| code(k) as u8).collect()),
    };
    Mask::new(side, side, 1, texels)
}

/// A table of `side`² texels of 8 bits into u32 sums, or of 16 into u64, into memory that is already there; on all threads.
pub fn table(side: usize, bits: u32) -> Kernel {
    let mask = mask(side, bits);
    let mut spare = None;
    let once = move || spare = Some(black_box(Table::new(&mask, 0, bits == 16, spare.take())));
    Kernel { items: side * side, once: Box::new(once) }
}

/// A plain widening copy u8 → u32 of `side`² texels on all threads.
pub fn copy(side: usize) -> Kernel {
    let texels: Vec<u8> = (0..side * side).map(|k| code(k) as u8).collect();
    let mut out = vec![0u32; side * side];
    let once = move || {
        let part = out.len().div_ceil(rayon::current_num_threads());
        out.par_chunks_mut(part).zip(texels.par_chunks(part)).for_each(|(to, from)| {
            to.iter_mut().zip(from).for_each(|(to, from)| *to = u32::from(*from));
        });
        black_box(&out);
    };
    Kernel { items: side * side, once: Box::new(once) }
}

fn theatre(emitter_m: f64) -> Theatre {
    Theatre {
        screen: Screen { width_m: 1.6, height_m: 0.9, albedo: Albedo::Uniform([0.8; 3]) },
        lamp: Lamp {
            position_m: DVec3::new(0.0, 0.0, -1.5),
            emitters: vec![Emitter {
                name: "lamp".into(),
                shape: EmitterShape::Rectangle { size_m: [emitter_m; 2] },
                radiance: [1.0; 3],
            }],
        },
        ambient: Ambient::None,
        planes: vec![Plane {
            mask: Arc::new(mask(1024, 8)),
            centre_m: DVec3::new(0.0, 0.0, -0.26),
            size_m: [1.6; 2],
            tilt_deg: [0.0; 2],
        }],
        exposure: Exposure::Auto,
    }
}

/// One row of 1920 `area` pixels, all in the shadow of a mask of 1024² texels: its table rows combined, its boxes looked up.
pub fn row(emitter_m: f64) -> Kernel {
    let view = View { size: [1920, 1080], pixel: Pixel::Area, skip: true };
    let theatre = theatre(emitter_m);
    let plan =
        Plan::new(&theatre, &view, &pa::Knobs::default()).expect("a parallel plane before a rectangle");
    let table = Table::new(&theatre.planes[0].mask, 0, plan.wide[0], None);
    let mut combined = Combined::default();
    let mut out = vec![0f32; view.size[0]];
    let once = move || {
        combined.combine(&table, &plan.lookups[0], 540, 0..view.size[0]);
        combined.look_up(&plan.lookups[0], 0..view.size[0], &mut out);
        black_box(&out);
    };
    Kernel { items: view.size[0], once: Box::new(once) }
}

/// 4096 values over the whole range of sRGB.
pub fn srgb() -> Kernel {
    let values: Vec<f32> = (0..4096).map(|k| f32::from(code(k)) / 65535.0).collect();
    let mut codes = vec![0u32; values.len()];
    let items = values.len();
    let once = move || {
        let srgb = Srgb::get();
        codes.iter_mut().zip(&values).for_each(|(to, from)| *to = srgb.code(*from));
        black_box(&codes);
    };
    Kernel { items, once: Box::new(once) }
}

/// `spp` samples (a multiple of 16) of each of 64 pixels through a mask of 1024² texels.
pub fn samples(spp: u32) -> Kernel {
    let view = View { size: [1920, 1080], pixel: Pixel::Area, skip: true };
    let mut one = trace::sampler(theatre(0.1), &view, spp);
    Kernel { items: 64 * spp as usize, once: Box::new(move || (900..964).for_each(|i| one(i, 540))) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kernels_run() {
        for mut kernel in [table(40, 8), table(40, 16), copy(40), row(0.02), srgb(), samples(16)] {
            kernel.run();
            kernel.run();
            assert!(kernel.items >= 1024);
        }
    }
}
