//! What a scene and a view come to before any sample is drawn: for each source of light and plane, the map from a
//! pixel's and a point's coordinates to texels, and the texels that a pixel can see.
//!
//! A sample has coordinates u on the source and v on the pixel, both in [−½, ½)², x rightwards and y *downwards*.

use kelir_frame::{Pixel, RenderError, View};
use kelir_scene::{Ambient, EmitterShape, Plane, Screen, Theatre};

use super::bounds::{Padded, Range};
use super::tilted::Tilted;
use crate::project::{self, sides_m};

/// One axis (x or y) of the map to one plane's texels, for one column or row of pixels, or one pixel.
///
/// Texel = anchor + floor(offset + …) with a sum that is zero at the middle of source and pixel. The anchor is the grid
/// line nearest the box's centre, so that the offset is small wherever the result matters and f32 resolves even a box of
/// 1e-6 texels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Axis {
    /// The box's centre relative to the anchor, texels.
    pub offset: f32,
    /// Smallest value of the sum before the floor: the clear texel before the grid.
    pub low: f32,
    /// Largest value of the sum before the floor: the clear texel behind the grid.
    pub high: f32,
    /// The anchor in padded texels.
    pub anchor: i32,
    /// Every padded texel that a sample can fall on.
    pub range: Range,
}

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

/// Sides of a pixel in metres, 0 where only its centre counts.
pub(super) fn pixel_sides(screen: &Screen, view: &View) -> [f64; 2] {
    match view.pixel {
        Pixel::Area => [screen.width_m / view.size[0] as f64, screen.height_m / view.size[1] as f64],
        Pixel::Centre => [0.0; 2],
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
    Parallel {
        columns: (0..view.size[0]).map(|i| axis(point(i as f64, 0.0).x, 0, plane.mask.width)).collect(),
        rows: (0..view.size[1]).map(|j| axis(point(0.0, j as f64).y, 1, plane.mask.height)).collect(),
        emitter: emitter.map(|v| v as f32),
        pixel: pixel.map(|v| v as f32),
    }
}

impl Axis {
    /// The axis of a box `from..to` around `centre` (texels) on a grid of `texels`.
    pub(crate) fn new(centre: f64, from: f64, to: f64, texels: usize) -> Self {
        let anchor = centre.round().clamp(0.0, texels as f64);
        let offset = centre - anchor;
        // What f32 may add to the sum: a few roundings of its largest term.
        let slack = 1e-6 * (offset.abs() + (to - centre).abs().max((centre - from).abs()));
        // An infinite box is the whole grid; a NaN can only come from one.
        let padded = |t: f64, otherwise: f64| {
            let t = if t.is_nan() { otherwise } else { t };
            t.floor().clamp(-1.0, texels as f64) as i32 + 1
        };
        Self {
            offset: offset as f32,
            low: (-1.0 - anchor) as f32,
            high: (texels as f64 - anchor) as f32,
            anchor: anchor as i32 + 1,
            range: Range {
                first: padded(from - slack, f64::NEG_INFINITY) as u32,
                last: padded(to + slack, f64::INFINITY) as u32,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A box far smaller than a texel, on a grid line thousands of texels in: f32 still splits it where f64 does.
    #[test]
    fn tiny_boxes_split_where_they_should() {
        let (line, width) = (4096.0, 1e-6);
        let centre = line + 0.25 * width; // a quarter of the box is left of the line
        let a = Axis::new(centre, centre - 0.5 * width, centre + 0.5 * width, 8192);
        assert_eq!((a.range.first, a.range.last), (4096, 4097));
        let left =
            (0..1000).filter(|i| a.offset + width as f32 * ((*i as f32 + 0.5) / 1000.0 - 0.5) < 0.0).count();
        assert!((left as i32 - 250).abs() <= 1, "{left}");
    }

    #[test]
    fn far_boxes_fall_on_the_clear_border() {
        let range = |centre: f64, half: f64| {
            let r = Axis::new(centre, centre - half, centre + half, 16).range;
            (r.first, r.last)
        };
        assert_eq!(range(-1e12, 3.0), (0, 0));
        assert_eq!(range(1e12, 3.0), (17, 17));
        assert_eq!(range(8.0, 1e30), (0, 17));
        assert_eq!(range(8.0, f64::INFINITY), (0, 17));
    }
}
