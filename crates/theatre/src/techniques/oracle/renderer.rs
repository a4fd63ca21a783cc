//! The oracle as a technique.

use kelir_frame::{Frame, Meter, RenderError, Renderer, Stats, View, VisibilityModel};
use kelir_scene::{Ambient, Theatre};
use rayon::prelude::*;

use super::{Knobs, Point, Visibility, visibility};
use crate::emitters::{each_visibility, emitters};
use crate::project::{pixel_m, sides_m};
use crate::{albedo, ambient, irradiance};

/// Draws with [`visibility`](fn@visibility) at every pixel.
#[derive(Debug)]
pub struct Oracle {
    knobs: Knobs,
    meter: Meter,
}

/// One pixel: radiance, then per emitter both visibilities.
type PixelValue = ([f64; 3], Vec<Visibility>);

/// One pixel by both models.
#[derive(Clone, Debug)]
pub struct BothModels {
    /// Radiance that E⁰ · Vgeo gives.
    pub geometric: [f64; 3],
    /// True radiance.
    pub irradiance: [f64; 3],
    /// One an emitter.
    pub visibilities: Vec<Visibility>,
}

impl Oracle {
    /// For `knobs`.
    pub fn new(knobs: Knobs) -> Self {
        Self { knobs, meter: Meter::default() }
    }

    fn check(theatre: &Theatre, view: &View) -> Result<(), RenderError> {
        view.check(sides_m(&theatre.screen))?;
        let refuse = |reason| Err(RenderError::Inapplicable { technique: "oracle", reason });
        for (i, plane) in theatre.planes.iter().enumerate() {
            if plane.tilt_deg != [0.0; 2] && matches!(theatre.ambient, Ambient::Dome { .. }) {
                let rule = "ambient.model = \"dome\" is drawn with upright puppets only";
                return refuse(format!("puppets[{i}].tilt_deg = {:?}: {rule}", plane.tilt_deg));
            }
        }
        Ok(())
    }

    /// The pixels of the crop `columns` × `rows`, row-major: radiance in f64 and each emitter's visibilities.
    pub fn crop(
        &self,
        theatre: &Theatre,
        view: &View,
        columns: std::ops::Range<usize>,
        rows: std::ops::Range<usize>,
    ) -> Result<Vec<PixelValue>, RenderError> {
        let geometric = self.knobs.geometric;
        let one = |v: BothModels| (if geometric { v.geometric } else { v.irradiance }, v.visibilities);
        Ok(self.both_models(theatre, view, columns, rows)?.into_iter().map(one).collect())
    }

    /// The same by both models, whichever the knobs ask for.
    pub fn both_models(
        &self,
        theatre: &Theatre,
        view: &View,
        columns: std::ops::Range<usize>,
        rows: std::ops::Range<usize>,
    ) -> Result<Vec<BothModels>, RenderError> {
        Self::check(theatre, view)?;
        let albedo = albedo::on_grid(&theatre.screen, view);
        self.meter.begin(rows.len());
        let row = |j: usize| -> Vec<BothModels> {
            let row =
                columns.clone().into_par_iter().map(|i| self.pixel(theatre, view, &albedo, i, j)).collect();
            self.meter.add(1);
            row
        };
        // Rows and columns both: crops may be narrow either way.
        Ok(rows.into_par_iter().map(row).collect::<Vec<_>>().concat())
    }

    fn pixel(
        &self,
        theatre: &Theatre,
        view: &View,
        albedo: &albedo::PixelAlbedo,
        i: usize,
        j: usize,
    ) -> BothModels {
        let point = Point::pixel(theatre, view, i, j);
        let centre = pixel_m(&theatre.screen, view.size, i as f64, j as f64);
        let emitters = 0..theatre.lamp.emitters.len();
        let seen = |theatre: &Theatre| -> Vec<Visibility> {
            emitters.clone().map(|e| visibility(theatre, e, point, self.knobs.tolerance)).collect()
        };
        let visibilities = seen(theatre);
        // What each plane alone lets through: the paper's ambient light weighs distances by it.
        let alone: Vec<(f64, Vec<Visibility>)> = match theatre.ambient {
            Ambient::Paper { .. } => theatre
                .planes
                .iter()
                .map(|plane| {
                    (-plane.centre_m.z, seen(&Theatre { planes: vec![plane.clone()], ..theatre.clone() }))
                })
                .collect(),
            _ => Vec::new(),
        };
        let units: Vec<f64> = theatre
            .lamp
            .emitters
            .iter()
            .map(|e| irradiance::unit(&e.shape, theatre.lamp.position_m, centre))
            .collect();
        let dome = match theatre.ambient {
            Ambient::Dome { radiance } => {
                let through = super::dome(theatre, centre);
                [0, 1, 2].map(|c| radiance[c] * through[c])
            }
            _ => [0.0; 3],
        };
        let radiance = |geometric: bool, c: usize| {
            let weight = |e: usize| theatre.lamp.emitters[e].radiance[c] * units[e];
            let all: f64 = emitters.clone().map(weight).sum();
            let albedo = f64::from(albedo.at(c, i + j * view.size[0]));
            let ambient_light = albedo * dome[c];
            if all == 0.0 {
                return ambient_light;
            }
            let mean = |of: &[Visibility]| {
                let one = |e: usize| if geometric { of[e].geometric[c] } else { of[e].irradiance[c] };
                emitters.clone().map(|e| weight(e) * one(e)).sum::<f64>() / all
            };
            let lit = albedo * all / std::f64::consts::PI;
            let v = mean(&visibilities);
            let shade = match theatre.ambient {
                Ambient::Paper { k_d_m, s } => {
                    let distance_m = ambient::distance_m(alone.iter().map(|(d, of)| (*d, mean(of))));
                    v + ambient::share(v, distance_m, k_d_m, s[c])
                }
                _ => v,
            };
            lit * shade + ambient_light
        };
        let [geometric, irradiance] = [true, false].map(|g| [0, 1, 2].map(|c| radiance(g, c)));
        BothModels { geometric, irradiance, visibilities }
    }
}

impl Renderer<Theatre> for Oracle {
    fn frame(&mut self, theatre: &Theatre, view: &View, visibilities: bool) -> Result<Frame, RenderError> {
        let values = self.crop(theatre, view, 0..view.size[0], 0..view.size[1])?;
        let radiance = [0, 1, 2].map(|c| values.iter().map(|(l, _)| l[c] as f32).collect());
        let by = |model, of: fn(&Visibility) -> [f64; 3]| {
            let names = emitters(theatre).filter(|_| visibilities);
            each_visibility(theatre, names, model, |e, c| {
                values.iter().map(|(_, v)| of(&v[e])[c] as f32).collect()
            })
        };
        let mut seen = by(VisibilityModel::Geometric, |v| v.geometric);
        seen.extend(by(VisibilityModel::Irradiance, |v| v.irradiance));
        let stats = Stats { counts: [("pixels".into(), values.len() as u64)].into(), ..Stats::default() };
        Ok(Frame { size: view.size, radiance, visibilities: seen, standard_error: None, stats })
    }

    fn watch(&mut self, meter: &Meter) {
        self.meter = meter.clone();
    }

    fn adapter(&self) -> String {
        "oracle f64".into()
    }
}
