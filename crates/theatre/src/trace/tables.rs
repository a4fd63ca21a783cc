//! Where samples fall on planes parallel to the screen, worked out once and read by every pixel.
//!
//! On such a plane a sample's place relative to the middle of box ⊛ pixel is the same whatever the pixel, and its x depends on the x
//! coordinates of emitter and pixel alone. So [`VARIANTS`] shifts of the points are kept for each axis, and a pixel picks one of each at
//! random: of the 64² pairs each is a shifted, scrambled net as a shift of its own would be. What a plane lets through takes one well
//! stratified coordinate, by [`Window`].
//!
//! Places are whole numbers of 2^−s texels, so that every backend and instruction set falls on the same texels.

use rayon::prelude::*;

use super::plan::{EmitterPlan, Parallel, Plan, PlaneMap, Shape};
use super::sobol::{self, Points, REPLICATES};

/// Shifts of the points that are kept for each axis, as many as there is room for: a power of two.
const VARIANTS: usize = 64;

/// Fewer make neighbours too alike: then every pixel has shifts of its own, and no tables.
const FEWEST: usize = 4;

/// All tables of a frame together: a reference of 2^18 samples a pixel still has some.
const BYTES: usize = 64 << 20;

/// One step of an axis in all replicates: places as `i32`, or tangents as the bits of `f32`.
pub(crate) type Lanes = [u32; REPLICATES];

/// The tables of all sources that have some.
pub(crate) struct Tables {
    /// A power of two; 1 for points that stand still.
    pub variants: usize,
    samples: usize,
    /// By source: through all planes, and then, where asked for, through each alone.
    sources: Vec<Option<Vec<Subset>>>,
}

/// One source through some planes: x then y, each variant after the other, in each its planes' places and then its tangents, step by step.
pub(crate) struct Subset {
    /// How many planes.
    planes: usize,
    /// All that it holds.
    pub lanes: Vec<Lanes>,
}

/// What one pixel reads along one axis.
pub(crate) struct Side<'a> {
    /// The places on each plane, one plane after the other.
    pub places: &'a [Lanes],
    /// Emitter · u − pixel · v over the lamp's distance.
    pub tangents: &'a [Lanes],
}

impl Tables {
    /// For a plan and its points; `alone` where planes are asked for one by one, too.
    pub(crate) fn new(plan: &Plan, points: &Points, alone: bool) -> Self {
        let planes: Vec<_> = plan.emitters.iter().map(parallel).collect();
        let words = |planes: usize| 2 * (planes + 1 + if alone { 2 * planes } else { 0 });
        let of_one: usize = planes.iter().flatten().map(|p| words(p.len())).sum();
        let bytes = of_one * points.samples * size_of::<Lanes>();
        let most = if points.scrambled { VARIANTS } else { 1 };
        let variants = (BYTES / bytes.max(1)).min(most).checked_ilog2().map_or(0, |log| 1 << log);
        let enough = variants >= FEWEST.min(most);
        let sources = plan.emitters.iter().zip(planes).enumerate().map(|(k, (emitter, planes))| {
            let planes = planes.filter(|_| enough)?;
            let singles = planes.chunks(1).filter(|_| alone);
            let subset = |planes: &[&Parallel]| Subset::new(points, variants, k, emitter, planes, plan.area);
            Some(std::iter::once(&planes[..]).chain(singles).map(subset).collect())
        });
        Self { variants, samples: points.samples, sources: sources.collect() }
    }

    /// The tables of source `k`, through all planes and then through each alone, where it has some.
    pub(crate) fn source(&self, k: usize) -> Option<&[Subset]> {
        self.sources[k].as_deref()
    }

    /// What a pixel and source of this [`sobol::stream`] read along x and y.
    #[inline(always)]
    pub(crate) fn sides(&self, k: usize, planes: &std::ops::Range<usize>, key: u32) -> Option<[Side<'_>; 2]> {
        let subsets = self.sources[k].as_ref()?;
        let whole = planes.len() == subsets[0].planes;
        let subset = &subsets[if whole { 0 } else { 1 + planes.start }];
        let size = (planes.len() + 1) * self.samples;
        let mask = self.variants - 1;
        let [x, y] = [key as usize & mask, self.variants + (key as usize >> 16 & mask)];
        Some([x, y].map(|variant| {
            let (places, tangents) =
                subset.lanes[variant * size..][..size].split_at(planes.len() * self.samples);
            Side { places, tangents }
        }))
    }
}

/// A rectangle's planes, where all are parallel to the screen: x and y then are apart.
fn parallel(emitter: &EmitterPlan) -> Option<Vec<&Parallel>> {
    let planes = emitter.planes.iter().map(|map| match map {
        PlaneMap::Parallel(map) => Some(map),
        PlaneMap::Tilted(_) => None,
    });
    planes.collect::<Option<Vec<_>>>().filter(|_| emitter.shape == Shape::Rectangle)
}

impl Subset {
    fn new(
        points: &Points,
        variants: usize,
        k: usize,
        emitter: &EmitterPlan,
        planes: &[&Parallel],
        area: bool,
    ) -> Self {
        let size = (planes.len() + 1) * points.samples;
        let mut lanes = vec![[0; REPLICATES]; 2 * variants * size];
        lanes.par_chunks_exact_mut(size).enumerate().for_each(|(n, lanes)| {
            let (d, variant) = (n / variants, n % variants);
            let maps: Vec<_> = planes
                .iter()
                .map(|map| (f64::from(map.emitter[d]), f64::from(map.pixel[d]), &map.fixed[d]))
                .collect();
            let window =
                maps.first().filter(|_| area && points.scrambled).map(|(e, p, _)| Window::new(*e, *p));
            let key = sobol::stream(sobol::fold(points.seed), variant as u32, k as u32);
            for (step, r) in (0..points.samples).flat_map(|step| (0..REPLICATES).map(move |r| (step, r))) {
                let at = |d: usize| points.at(key, d, step, r);
                let (mut u, mut v) = (at(d), if area { at(d + 2) } else { 0.0 });
                if let Some(window) = &window {
                    (u, v) = window.split(u, v);
                }
                for (plane, (emitter, pixel, fixed)) in maps.iter().enumerate() {
                    lanes[plane * points.samples + step][r] = fixed.of(emitter * u + pixel * v) as u32;
                }
                let tangent = f64::from(emitter.emitter[d]) * u - f64::from(emitter.pixel[d]) * v;
                lanes[maps.len() * points.samples + step][r] = (tangent as f32).to_bits();
            }
        });
        Self { planes: planes.len(), lanes }
    }
}

/// One axis of box ⊛ pixel: the trapezoid over which t = emitter · u + pixel · v is spread.
///
/// What a plane lets through depends on t alone, so t takes one well stratified coordinate, by the inverse of the
/// trapezoid's distribution, and the other coordinate chooses among the (u, v) that have this t: together they are
/// uniform over emitter and pixel, as they were.
struct Window {
    emitter: f64,
    pixel: f64,
    /// Half of where the top ends, half of where the slopes end.
    flat: f64,
    half: f64,
}

impl Window {
    fn new(emitter: f64, pixel: f64) -> Self {
        Self { emitter, pixel, flat: 0.5 * (emitter - pixel).abs(), half: 0.5 * (emitter + pixel) }
    }

    /// The sample's `(u, v)` for independent coordinates in [−½, ½).
    fn split(&self, along: f64, side: f64) -> (f64, f64) {
        let share = along.abs();
        let top = share * self.emitter.max(self.pixel);
        let slope = self.half - (2.0 * self.emitter * self.pixel * (0.5 - share)).sqrt();
        let place = if top <= self.flat { top } else { slope }.copysign(along);
        // A source without width in texels leaves NaN or infinity, which the bounds take for themselves.
        let from = ((place - 0.5 * self.pixel) / self.emitter).max(-0.5);
        let to = ((place + 0.5 * self.pixel) / self.emitter).min(0.5);
        let u = 0.5 * (from + to) + side * (to - from);
        (u, ((place - self.emitter * u) / self.pixel).clamp(-0.5, 0.5))
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// Midpoints of the square come out uniform over emitter × pixel (all moments up to the second are those of the uniform
        /// distribution), at the place that the trapezoid's distribution has for the first coordinate.
        #[test]
        fn windows_keep_the_distribution(emitter in 0.0f64..30.0, pixel in 1e-3f64..3.0) {
            let window = Window::new(emitter, pixel);
            let n = 200;
            let middle = |k: usize| (k as f64 + 0.5) / f64::from(n) - 0.5;
            let mut moments = [0.0; 5];
            for (a, b) in (0..n as usize * n as usize).map(|k| (middle(k % n as usize), middle(k / n as usize))) {
                let (u, v) = window.split(a, b);
                prop_assert!(u.abs() <= 0.5 + 1e-9 && v.abs() <= 0.5, "{} {}", u, v);
                for (m, value) in moments.iter_mut().zip([u, v, u * u, v * v, u * v]) {
                    *m += value / f64::from(n * n);
                }
                // The share of box ⊛ pixel left of here, by its closed form.
                let t = emitter * u + pixel * v;
                let ramp = |x: f64| 0.5 * x.max(0.0).powi(2);
                let (h, f) = (0.5 * (emitter + pixel), 0.5 * (emitter - pixel).abs());
                let share = (ramp(t + h) - ramp(t + f) - ramp(t - f) + ramp(t - h)) / (emitter * pixel);
                prop_assert!(emitter < 1e-3 || (share - 0.5 - a).abs() < 1e-6, "{} {}", share, a);
            }
            for (m, expected) in moments.iter().zip([0.0, 0.0, 1.0 / 12.0, 1.0 / 12.0, 0.0]) {
                prop_assert!((m - expected).abs() < 2e-3, "{:?}", moments);
            }
        }
    }
}
