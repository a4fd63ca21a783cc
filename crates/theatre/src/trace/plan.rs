//! What a scene and a view come to before any sample is drawn: for each source of light and plane, the map from a
//! pixel's and a point's coordinates to texels, and the texels that a pixel can see.
//!
//! A sample has coordinates u on the source and v on the pixel, both in [−½, ½)², x rightwards and y *downwards*.

use kelir_frame::{Pixel, RenderError, View};
use kelir_scene::{Ambient, EmitterShape, Plane, Theatre};

use super::axis::{Axis, Fixed, pixel_sides};
use super::bounds::{Padded, Range};
use super::tilted::Tilted;
use crate::project::{self, sides_m};

/// The map to one plane's texels as one source lights it.
pub(crate) enum PlaneMap {
    /// Parallel to the screen: x depends on the column alone, y on the row alone.
    Parallel(Parallel),
    /// Tilted: a perspective map of its own for every pixel.
    Tilted(Box<Tilted>),
}

/// The affine map of a plane parallel to the screen.
pub(crate) struct Parallel {
    /// One a column of pixels.
    pub columns: Vec<Axis>,
    /// One a row of pixels.
    pub rows: Vec<Axis>,
    /// Texels along x and y over the whole source.
    pub emitter: [f32; 2],
    /// Texels along x and y over the whole pixel; 0 for `centre`.
    pub pixel: [f32; 2],
    /// Places along x and y as whole numbers.
    pub fixed: [Fixed; 2],
    /// The boxes' middles relative to their anchors in them: of every column and every row.
    pub middles: [Vec<i32>; 2],
}

/// What the square of u is mapped to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shape {
    /// Itself.
    Rectangle,
    /// The disk in it, keeping areas' ratios.
    Disk,
    /// Directions over the hemisphere, cosine-weighted, as their tangents.
    Dome,
}

/// One source's sampling.
pub(crate) struct EmitterPlan {
    /// Its outline.
    pub shape: Shape,
    /// One a plane, in the theatre's order.
    pub planes: Vec<PlaneMap>,
    /// Pixel centre minus lamp centre over the lamp's distance, one a column.
    pub columns: Vec<f32>,
    /// Lamp centre minus pixel centre over the lamp's distance (positive downwards), one a row.
    pub rows: Vec<f32>,
    /// Sides of the source over the lamp's distance.
    pub emitter: [f32; 2],
    /// Sides of the pixel over the lamp's distance; 0 for `centre`.
    pub pixel: [f32; 2],
    /// E / L is this times the mean of V · weight. An emitter's weight is 1 / (1 + tan²)² and this its area over squared
    /// distance; the dome's weight is 1 and this π.
    pub scale: f64,
}

/// Everything but the points.
pub(crate) struct Plan {
    /// Pixels [width, height].
    pub size: [usize; 2],
    /// Whether points also spread over the pixel's area.
    pub area: bool,
    /// 1 where all masks are grey, else 3.
    pub channels: usize,
    /// One an emitter, then the dome where there is one.
    pub emitters: Vec<EmitterPlan>,
    /// All points of an emitter weigh the same: E is E⁰ times their mean visibility.
    pub geometric: bool,
}

impl Plan {
    /// Errors: a size that does not fit the screen.
    pub(crate) fn new(
        theatre: &Theatre,
        view: &View,
        masks: &[impl AsRef<Padded>],
        geometric: bool,
    ) -> Result<Self, RenderError> {
        view.check(sides_m(&theatre.screen))?;
        let mut emitters: Vec<_> =
            theatre.lamp.emitters.iter().map(|emitter| lamp(theatre, view, &emitter.shape)).collect();
        if let Ambient::Dome { .. } = theatre.ambient {
            emitters.push(dome(theatre, view));
        }
        if geometric {
            for e in &mut emitters {
                // Tangents of zero make every weight 1.
                e.columns.fill(0.0);
                e.rows.fill(0.0);
                (e.emitter, e.pixel) = ([0.0; 2], [0.0; 2]);
            }
        }
        Ok(Self {
            geometric,
            size: view.size,
            area: view.pixel == Pixel::Area,
            channels: masks.iter().map(|m| m.as_ref().channels).max().unwrap_or(1),
            emitters,
        })
    }
}

impl PlaneMap {
    /// Every padded texel that samples of pixel (i, j) can fall on.
    #[inline]
    pub(crate) fn range(&self, i: usize, j: usize) -> (Range, Range) {
        match self {
            Self::Parallel(map) => (map.columns[i].range, map.rows[j].range),
            Self::Tilted(map) => map.range(i, j),
        }
    }
}

fn lamp(theatre: &Theatre, view: &View, shape: &EmitterShape) -> EmitterPlan {
    let size_m = shape.half_extent_m().map(|half| 2.0 * half);
    let lamp = theatre.lamp.position_m;
    let z = lamp.z.abs();
    let pixel = |i, j| project::pixel_m(&theatre.screen, view.size, i, j);
    let map = |plane: &Plane| match plane.tilt_deg == [0.0, 0.0] {
        true => PlaneMap::Parallel(parallel(theatre, view, size_m, plane)),
        false => PlaneMap::Tilted(Tilted::new(theatre, view, Some(size_m), plane).into()),
    };
    EmitterPlan {
        shape: match shape {
            EmitterShape::Rectangle { .. } => Shape::Rectangle,
            EmitterShape::Disk { .. } => Shape::Disk,
        },
        planes: theatre.planes.iter().map(map).collect(),
        columns: (0..view.size[0]).map(|i| ((pixel(i as f64, 0.0).x - lamp.x) / z) as f32).collect(),
        rows: (0..view.size[1]).map(|j| ((lamp.y - pixel(0.0, j as f64).y) / z) as f32).collect(),
        emitter: size_m.map(|s| (s / z) as f32),
        pixel: pixel_sides(&theatre.screen, view).map(|s| (s / z) as f32),
        scale: shape.area_m2() / (z * z),
    }
}

/// A hemisphere of directions behind the screen; u is mapped to tangents, so a plane's texels per tangent are its distance.
fn dome(theatre: &Theatre, view: &View) -> EmitterPlan {
    let map = |plane: &Plane| match plane.tilt_deg == [0.0, 0.0] {
        true => {
            let sides = pixel_sides(&theatre.screen, view);
            let shadow = project::ShadowBox::new(plane, glam::DVec3::new(0.0, 0.0, f64::NEG_INFINITY));
            let distance = plane.centre_m.z.abs();
            let everything = f64::INFINITY;
            PlaneMap::Parallel(axes(
                theatre,
                view,
                &shadow,
                plane,
                [distance * shadow.scale.x.abs(), distance * shadow.scale.y.abs()],
                sides,
                everything,
            ))
        }
        false => PlaneMap::Tilted(Tilted::new(theatre, view, None, plane).into()),
    };
    EmitterPlan {
        shape: Shape::Dome,
        planes: theatre.planes.iter().map(map).collect(),
        columns: vec![0.0; view.size[0]],
        rows: vec![0.0; view.size[1]],
        emitter: [0.0; 2],
        pixel: [0.0; 2],
        scale: std::f64::consts::PI,
    }
}

fn parallel(theatre: &Theatre, view: &View, size_m: [f64; 2], plane: &Plane) -> Parallel {
    let shadow = project::ShadowBox::new(plane, theatre.lamp.position_m);
    let emitter = [shadow.spread.x * size_m[0], shadow.spread.y * size_m[1]];
    axes(theatre, view, &shadow, plane, emitter, pixel_sides(&theatre.screen, view), 0.0)
}

/// The axes of a plane; `beyond` widens what a pixel can see by so many texels.
fn axes(
    theatre: &Theatre,
    view: &View,
    shadow: &project::ShadowBox,
    plane: &Plane,
    emitter: [f64; 2],
    sides: [f64; 2],
    beyond: f64,
) -> Parallel {
    let pixel = [shadow.scale.x.abs() * sides[0], shadow.scale.y.abs() * sides[1]];
    let point = |i, j| shadow.centre(project::pixel_m(&theatre.screen, view.size, i, j));
    let axis = |centre: f64, d: usize, texels: usize| {
        let half = 0.5 * (emitter[d] + pixel[d]) + beyond;
        Axis::new(centre, centre - half, centre + half, texels)
    };
    let fixed = [0, 1].map(|d| Fixed::new(0.5 * (emitter[d] + pixel[d])));
    let lines = |d: usize| {
        let line = |k: usize| if d == 0 { point(k as f64, 0.0).x } else { point(0.0, k as f64).y };
        let texels = if d == 0 { plane.mask.width } else { plane.mask.height };
        let both = |k| (axis(line(k), d, texels), line(k));
        let both =
            (0..view.size[d]).map(both).map(|(axis, centre)| (axis, fixed[d].of(centre - axis.line())));
        both.unzip()
    };
    let ((columns, across), (rows, down)) = (lines(0), lines(1));
    Parallel {
        columns,
        rows,
        emitter: emitter.map(|v| v as f32),
        pixel: pixel.map(|v| v as f32),
        fixed,
        middles: [across, down],
    }
}
