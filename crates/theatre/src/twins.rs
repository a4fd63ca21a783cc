//! Every technique on a GPU beside its native twin: scene by scene, how far the two pictures lie apart, and how far a picture does that is
//! known to be off, as the negative control.

use kelir_frame::gpu::{Gpu, Limits, choose};
use kelir_frame::{Backend, Frame, RenderError, Renderer, View};
use kelir_scene::Theatre;
use serde::Serialize;

use crate::{mc, pa, pcss, points, white};

/// What lies apart of two pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Measure {
    /// Largest difference in any visibility; infinite where one is not from 0 to 1.
    Visibility,
    /// Largest difference in any visibility or standard error.
    Layers,
    /// Root mean square of the differences in visibility.
    LayersRms,
    /// Largest difference in radiance, in units of the native picture's brightest value.
    Radiance,
    /// Largest difference of a display code, of 255.
    Codes,
}

/// How far apart twins may lie, and how far a picture that is off must.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bound {
    measure: Measure,
    most: f64,
    least: Option<f64>,
}

impl Bound {
    /// At most `most`, and more than `least` where the picture is off.
    pub(crate) const fn new(measure: Measure, most: f64, least: f64) -> Self {
        Self { measure, most, least: Some(least) }
    }

    /// At most `most`, where what is off does not show in this measure.
    pub(crate) const fn without_control(measure: Measure, most: f64) -> Self {
        Self { measure, most, least: None }
    }
}

/// One comparison.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Twin {
    /// What drew.
    pub technique: &'static str,
    /// What was drawn.
    pub case: String,
    /// What was compared.
    pub measure: Measure,
    /// The GPU's distance from the native code.
    pub error: f64,
    /// At most so much of it is claimed.
    pub most: f64,
    /// The distance of a picture that is off, and what it must exceed; none where what is off does not show in this measure.
    pub control: Option<[f64; 2]>,
}

impl Twin {
    /// Whether the twins agree.
    pub fn agrees(&self) -> bool {
        self.error <= self.most
    }

    /// Whether what is off was told, where it shows.
    pub fn control_fails(&self) -> bool {
        self.control.is_none_or(|[error, least]| error > least)
    }

    /// Whether what is claimed holds.
    pub fn holds(&self) -> bool {
        self.agrees() && self.control_fails()
    }
}

/// The device and all comparisons on it.
#[derive(Clone, Debug, Serialize)]
pub struct Twins {
    /// Its name, type and driver.
    pub adapter: String,
    /// Whether a CPU imitates it.
    pub software: bool,
    /// What it can hold.
    pub limits: Limits,
    /// One a technique, case and measure.
    pub twins: Vec<Twin>,
}

/// Compares all techniques on the GPU that `--backend gpu` draws on; `each` is told what is compared next. Errors: no adapter, or one that
/// fails.
pub fn twins(each: &mut dyn FnMut(&str)) -> Result<Twins, RenderError> {
    let Some(gpu) = choose(Backend::Gpu)? else {
        return Err(RenderError::Gpu("no device".into()));
    };
    let mut all = Vec::new();
    for (technique, compare) in TECHNIQUES {
        each(technique);
        all.extend(compare(&gpu)?);
    }
    Ok(Twins { adapter: gpu.adapter(), software: gpu.is_software(), limits: gpu.limits(), twins: all })
}

/// Comparisons of one technique on a device.
type Compare = fn(&Gpu) -> Result<Vec<Twin>, RenderError>;

/// Every technique that draws on a GPU.
const TECHNIQUES: [(&str, Compare); 4] =
    [("pa", pa::twins), ("mc", mc::twins), ("points", points::twins), ("pcss", pcss::twins)];

/// Who draws a scene: the native code, the GPU, and what is off.
pub(crate) struct Drawn<'a> {
    pub native: &'a mut dyn Renderer<Theatre>,
    pub gpu: &'a mut dyn Renderer<Theatre>,
    pub off: &'a mut dyn Renderer<Theatre>,
}

impl Drawn<'_> {
    /// Draws one scene by all three and compares.
    pub(crate) fn compare(
        &mut self,
        technique: &'static str,
        case: &str,
        (theatre, view): (&Theatre, &View),
        bounds: &[Bound],
    ) -> Result<Vec<Twin>, RenderError> {
        if !self.gpu.class().starts_with("gpu:") {
            return Err(RenderError::Gpu(format!(
                "{technique} would be compared with itself, on {}",
                self.gpu.class()
            )));
        }
        let native = Picture::draw(self.native, theatre, view)?;
        let gpu = Picture::draw(self.gpu, theatre, view)?;
        let off = Picture::draw(self.off, theatre, view)?;
        let twin = |bound: &Bound| Twin {
            technique,
            case: format!("{case}, {:?} pixels", view.pixel).to_lowercase(),
            measure: bound.measure,
            error: native.distance(&gpu, bound.measure),
            most: bound.most,
            control: bound.least.map(|least| [native.distance(&off, bound.measure), least]),
        };
        Ok(bounds.iter().map(twin).collect())
    }
}

/// What one of them drew: first the radiance, then, from what it kept, the codes.
struct Picture {
    frame: Frame,
    codes: Vec<u32>,
}

impl Picture {
    fn draw(
        renderer: &mut dyn Renderer<Theatre>,
        theatre: &Theatre,
        view: &View,
    ) -> Result<Self, RenderError> {
        let frame = renderer.radiance(theatre, view)?;
        let mut codes = vec![0; view.size[0] * view.size[1]];
        renderer.display(theatre, view, white([theatre], view), &mut codes)?;
        Ok(Self { frame, codes })
    }

    fn distance(&self, other: &Self, measure: Measure) -> f64 {
        let bytes = |codes: &[u32]| {
            codes.iter().flat_map(|code| code.to_le_bytes()).map(f32::from).collect::<Vec<_>>()
        };
        match measure {
            Measure::Visibility if other.impossible() => f64::INFINITY,
            Measure::Visibility | Measure::Layers => largest(&self.layers(), &other.layers()),
            Measure::LayersRms => root_mean_square(&self.layers(), &other.layers()),
            Measure::Radiance => {
                let [own, other] = [self, other].map(|picture| picture.frame.radiance.concat());
                largest(&own, &other) / f64::from(own.iter().fold(0f32, |most, v| most.max(*v)))
            }
            Measure::Codes => largest(&bytes(&self.codes), &bytes(&other.codes)),
        }
    }

    fn impossible(&self) -> bool {
        self.frame.visibilities.iter().flat_map(|seen| &seen.values).any(|v| !(0.0..=1.0).contains(v))
    }

    /// Visibilities and standard errors, one after the other.
    fn layers(&self) -> Vec<f32> {
        let layers = self.frame.channels().filter(|(name, _)| name.contains('.'));
        layers.flat_map(|(_, values)| values).copied().collect()
    }
}

/// Largest difference; of pictures that have not the same values, infinite.
fn largest(a: &[f32], b: &[f32]) -> f64 {
    if a.len() != b.len() {
        return f64::INFINITY;
    }
    let apart = a.iter().zip(b).map(|(a, b)| (f64::from(*a) - f64::from(*b)).abs());
    apart.fold(0.0, |most, d| if d.is_nan() { f64::INFINITY } else { most.max(d) })
}

fn root_mean_square(a: &[f32], b: &[f32]) -> f64 {
    if a.len() != b.len() {
        return f64::INFINITY;
    }
    let squares: f64 = a.iter().zip(b).map(|(a, b)| (f64::from(*a) - f64::from(*b)).powi(2)).sum();
    (squares / a.len() as f64).sqrt()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

    use super::*;

    /// Every technique draws on a GPU what it draws on the CPU, and what is off is told, in each case by one measure at least.
    #[test]
    fn twins_agree_and_what_is_off_does_not() {
        let found = twins(&mut |_| ()).unwrap();
        let wrong: Vec<_> = found.twins.iter().filter(|twin| !twin.holds()).collect();
        assert!(wrong.is_empty(), "{wrong:#?}");
        for of in found.twins.chunk_by(|a, b| (a.technique, &a.case) == (b.technique, &b.case)) {
            assert!(of.iter().any(|twin| twin.control.is_some()), "{of:?}: no control");
        }
        for (technique, least) in [("pa", 40), ("mc", 4), ("points", 1), ("pcss", 2)] {
            let count = found.twins.iter().filter(|twin| twin.technique == technique).count();
            assert!(count >= least, "{technique}: {count}");
        }
    }

    /// A comparison does not hold where twins differ, where what is off is not told, nor for what is no number.
    #[test]
    fn what_differs_does_not_hold() {
        let twin = |error, control| Twin {
            technique: "pa",
            case: "one".into(),
            measure: Measure::Layers,
            error,
            most: 0.1,
            control,
        };
        assert!(twin(0.1, None).holds() && twin(0.0, Some([0.6, 0.5])).holds());
        assert!(!twin(0.2, None).holds() && !twin(f64::NAN, None).holds());
        assert!(!twin(0.0, Some([0.5, 0.5])).holds() && !twin(0.0, Some([f64::NAN, 0.5])).holds());
        assert_eq!(largest(&[0.0, f32::NAN], &[0.0, 0.0]), f64::INFINITY);
        assert_eq!(largest(&[0.0], &[0.0, 0.0]), f64::INFINITY);
        assert_eq!(largest(&[0.25, 1.0], &[0.5, 1.0]), 0.25);
        assert_eq!(root_mean_square(&[3.0, 0.0], &[0.0, 4.0]), 12.5f64.sqrt());
    }
}
