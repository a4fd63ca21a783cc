//! Small squares through the penumbra, and what the oracle says of them.

use kelir_scene::Theatre;
use serde::Serialize;

use super::{OnCrops, compare};
use crate::albedo::PixelAlbedo;
use crate::oracle::{Knobs, Oracle, Visibility};
use crate::{Frame, RenderError, View, VisibilityModel};

/// A square of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Crop {
    /// First column.
    pub x: usize,
    /// First row.
    pub y: usize,
    /// Pixels a side.
    pub side: usize,
}

/// `[count, side]` crops: of the image's tiles of that side the ones that have the largest share of penumbra pixels (at least half, where there
/// are such), `count` of them evenly spaced in reading order.
pub(super) fn choose(penumbra: &[bool], [width, height]: [usize; 2], [count, side]: [usize; 2]) -> Vec<Crop> {
    if count == 0 || side == 0 {
        return Vec::new();
    }
    let tiles = (0..height / side).flat_map(|y| (0..width / side).map(move |x| [x * side, y * side]));
    let share = |[x, y]: [usize; 2]| {
        let row = |j: usize| penumbra[j * width + x..][..side].iter().filter(|p| **p).count();
        (y..y + side).map(row).sum::<usize>()
    };
    let all: Vec<_> = tiles.map(|at| (share(at), Crop { x: at[0], y: at[1], side })).collect();
    let most = all.iter().map(|(share, _)| *share).max().unwrap_or(0);
    let enough = (side * side).div_ceil(2).min(most).max(1);
    let through: Vec<Crop> = all.into_iter().filter(|(share, _)| *share >= enough).map(|(_, c)| c).collect();
    let count = count.min(through.len());
    // The middles of `count` equal stretches.
    (0..count).map(|k| through[(2 * k + 1) * through.len() / (2 * count)]).collect()
}

/// The oracle's crops, one after the other.
pub(super) struct Truth {
    pub crops: Vec<Crop>,
    width: usize,
    /// Pixels of all crops, as indices into the image.
    pixels: Vec<usize>,
    /// Emitters' names.
    names: Vec<String>,
    visibilities: Vec<Vec<Visibility>>,
    /// Irradiance of the geometric model: three planes.
    pub geometric: Vec<f64>,
    /// True irradiance: three planes.
    pub irradiance: Vec<f64>,
}

impl Truth {
    /// Errors: what the oracle refuses.
    pub(super) fn draw(
        theatre: &Theatre,
        view: &View,
        albedo: &PixelAlbedo,
        crops: Vec<Crop>,
        tolerance: f64,
    ) -> Result<Self, RenderError> {
        let oracle = Oracle::new(Knobs { tolerance, geometric: false });
        let (mut values, mut pixels) = (Vec::new(), Vec::new());
        for Crop { x, y, side } in &crops {
            values.extend(oracle.both_models(theatre, view, *x..x + side, *y..y + side)?);
            pixels.extend((*y..y + side).flat_map(|j| (*x..x + side).map(move |i| j * view.size[0] + i)));
        }
        let plane = |geometric: bool| -> Vec<f64> {
            let of = |c: usize| {
                values.iter().zip(&pixels).map(move |(v, k)| {
                    let radiance = if geometric { v.geometric } else { v.irradiance };
                    radiance[c] * std::f64::consts::PI / f64::from(albedo.at(c, *k))
                })
            };
            (0..3).flat_map(of).map(|e| if e.is_finite() { e } else { 0.0 }).collect()
        };
        Ok(Self {
            width: view.size[0] * view.size[1],
            geometric: plane(true),
            irradiance: plane(false),
            names: theatre.lamp.emitters.iter().map(|e| e.name.clone()).collect(),
            visibilities: values.into_iter().map(|v| v.visibilities).collect(),
            crops,
            pixels,
        })
    }

    /// A frame's errors over the crops; `irradiance` is the whole image's, three planes.
    pub(super) fn measure(
        &self,
        frame: &Frame,
        irradiance: &[f64],
        full_scale: f64,
    ) -> Result<OnCrops, RenderError> {
        let ours: Vec<f64> = (0..3)
            .flat_map(|c| self.pixels.iter().map(move |k| irradiance[c * self.width + k]))
            .map(|e| if e.is_finite() { e } else { 0.0 })
            .collect();
        // Who draws both is drawn by the true one.
        let (model, own) = match frame.visibilities.iter().any(|v| v.model == VisibilityModel::Irradiance) {
            true => (VisibilityModel::Irradiance, &self.irradiance),
            false => (VisibilityModel::Geometric, &self.geometric),
        };
        Ok(OnCrops {
            model,
            numerical: compare(&ours, own, None, full_scale)?,
            total: compare(&ours, &self.irradiance, None, full_scale)?,
            visibility_max: self.visibility_max(frame, model),
        })
    }

    fn visibility_max(&self, frame: &Frame, model: VisibilityModel) -> f64 {
        let mut most = 0f64;
        for drawn in frame.visibilities.iter().filter(|v| v.model == model) {
            // The dome is no emitter: the oracle has no visibility of it.
            let Some(e) = self.names.iter().position(|name| *name == drawn.emitter) else { continue };
            for (k, seen) in self.pixels.iter().zip(&self.visibilities) {
                let of = match model {
                    VisibilityModel::Geometric => seen[e].geometric,
                    VisibilityModel::Irradiance => seen[e].irradiance,
                };
                most = most.max((f64::from(drawn.values[*k]) - of[drawn.channel.unwrap_or(0)]).abs());
            }
        }
        most
    }
}
