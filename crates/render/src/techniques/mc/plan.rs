//! What a scene and a view come to before any sample is drawn: for each emitter and plane, the affine map from a
//! pixel's and a point's coordinates to texels, and the texels that a pixel can see.

use kelir_scene::{EmitterShape, Plane, Screen, Theatre};

use super::bounds::{Padded, Range};
use crate::{Pixel, RenderError, View, project};

/// One axis (x or y) of the map to one plane's texels, for one column or row of pixels.
///
/// Texel = anchor + floor(offset + emitter·u + pixel·v) with u, v in [−½, ½). The anchor is the grid line nearest the
/// box's centre, so that the offset is small wherever the result matters and f32 resolves even a box of 1e-6 texels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
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

/// The map to one plane's texels as one emitter lights it.
pub struct PlaneMap {
    /// One a column of pixels.
    pub columns: Vec<Axis>,
    /// One a row of pixels.
    pub rows: Vec<Axis>,
    /// Texels along x and y over the whole emitter.
    pub emitter: [f32; 2],
    /// Texels along x and y over the whole pixel; 0 for `centre`.
    pub pixel: [f32; 2],
}

/// One emitter's sampling.
pub struct EmitterPlan {
    /// One a plane, in the theatre's order.
    pub planes: Vec<PlaneMap>,
    /// Pixel centre minus lamp centre over the lamp's distance, one a column.
    pub columns: Vec<f32>,
    /// Lamp centre minus pixel centre over the lamp's distance (positive downwards), one a row.
    pub rows: Vec<f32>,
    /// Sides of the emitter over the lamp's distance.
    pub emitter: [f32; 2],
    /// Sides of the pixel over the lamp's distance; 0 for `centre`.
    pub pixel: [f32; 2],
    /// Area over squared distance: E / L is this times the mean of V / (1 + tan²)².
    pub scale: f64,
}

/// Everything but the points.
pub struct Plan {
    /// Pixels [width, height].
    pub size: [usize; 2],
    /// Whether points also spread over the pixel's area.
    pub area: bool,
    /// 1 where all masks are grey, else 3.
    pub channels: usize,
    /// One an emitter.
    pub emitters: Vec<EmitterPlan>,
}

impl Plan {
    /// Errors: a disk or a tilted plane.
    pub fn new(theatre: &Theatre, view: &View, masks: &[impl AsRef<Padded>]) -> Result<Self, RenderError> {
        let mut emitters = Vec::with_capacity(theatre.lamp.emitters.len());
        for (k, emitter) in theatre.lamp.emitters.iter().enumerate() {
            let EmitterShape::Rectangle { size_m } = emitter.shape else {
                return Err(inapplicable(format!("lamp.emitters[{k}].shape = \"disk\" is not drawn yet")));
            };
            let planes = theatre.planes.iter().enumerate();
            let planes = planes.map(|(i, plane)| plane_map(theatre, view, size_m, i, plane));
            emitters.push(emitter_plan(theatre, view, size_m, planes.collect::<Result<_, _>>()?));
        }
        Ok(Self {
            size: view.size,
            area: view.pixel == Pixel::Area,
            channels: masks.iter().map(|m| m.as_ref().channels).max().unwrap_or(1),
            emitters,
        })
    }
}

fn inapplicable(reason: String) -> RenderError {
    RenderError::Inapplicable { technique: "mc", reason }
}

/// Sides of a pixel in metres, 0 where only its centre counts.
fn pixel_sides(screen: &Screen, view: &View) -> [f64; 2] {
    match view.pixel {
        Pixel::Area => [screen.width_m / view.size[0] as f64, screen.height_m / view.size[1] as f64],
        Pixel::Centre => [0.0; 2],
    }
}

fn emitter_plan(theatre: &Theatre, view: &View, size_m: [f64; 2], planes: Vec<PlaneMap>) -> EmitterPlan {
    let lamp = theatre.lamp.position_m;
    let z = lamp.z.abs();
    let pixel = |i, j| project::pixel_m(&theatre.screen, view.size, i, j);
    EmitterPlan {
        planes,
        columns: (0..view.size[0]).map(|i| ((pixel(i as f64, 0.0).x - lamp.x) / z) as f32).collect(),
        rows: (0..view.size[1]).map(|j| ((lamp.y - pixel(0.0, j as f64).y) / z) as f32).collect(),
        emitter: size_m.map(|s| (s / z) as f32),
        pixel: pixel_sides(&theatre.screen, view).map(|s| (s / z) as f32),
        scale: size_m[0] * size_m[1] / (z * z),
    }
}

fn plane_map(
    theatre: &Theatre,
    view: &View,
    size_m: [f64; 2],
    index: usize,
    plane: &Plane,
) -> Result<PlaneMap, RenderError> {
    if plane.tilt_deg != [0.0, 0.0] {
        return Err(inapplicable(format!(
            "puppets[{index}].tilt_deg = {:?} is not drawn yet",
            plane.tilt_deg
        )));
    }
    let shadow = project::ShadowBox::new(plane, theatre.lamp.position_m);
    let sides = pixel_sides(&theatre.screen, view);
    let emitter = [shadow.spread.x * size_m[0], shadow.spread.y * size_m[1]];
    let pixel = [shadow.scale.x.abs() * sides[0], shadow.scale.y.abs() * sides[1]];
    let point = |i, j| shadow.centre(project::pixel_m(&theatre.screen, view.size, i, j));
    let axis = |centre: f64, d: usize, texels: usize| axis(centre, 0.5 * (emitter[d] + pixel[d]), texels);
    Ok(PlaneMap {
        columns: (0..view.size[0]).map(|i| axis(point(i as f64, 0.0).x, 0, plane.mask.width)).collect(),
        rows: (0..view.size[1]).map(|j| axis(point(0.0, j as f64).y, 1, plane.mask.height)).collect(),
        emitter: emitter.map(|v| v as f32),
        pixel: pixel.map(|v| v as f32),
    })
}

/// The axis of a box of half-side `half` around `centre` (texels) on a grid of `texels`.
fn axis(centre: f64, half: f64, texels: usize) -> Axis {
    let anchor = centre.round().clamp(0.0, texels as f64);
    let offset = centre - anchor;
    // What f32 may add to the sum: a few roundings of its largest term.
    let slack = 1e-6 * (offset.abs() + half);
    let padded = |t: f64| (anchor + t.floor()).clamp(-1.0, texels as f64) as i32 + 1;
    Axis {
        offset: offset as f32,
        low: (-1.0 - anchor) as f32,
        high: (texels as f64 - anchor) as f32,
        anchor: anchor as i32 + 1,
        range: Range {
            first: padded(offset - half - slack) as u32,
            last: padded(offset + half + slack) as u32,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A box far smaller than a texel, on a grid line a million texels in: f32 still splits it where f64 does.
    #[test]
    fn tiny_boxes_split_where_they_should() {
        let (line, width) = (4096.0, 1e-6);
        let centre = line + 0.25 * width; // a quarter of the box is left of the line
        let a = axis(centre, 0.5 * width, 8192);
        assert_eq!((a.range.first, a.range.last), (4096, 4097));
        let left =
            (0..1000).filter(|i| a.offset + width as f32 * ((*i as f32 + 0.5) / 1000.0 - 0.5) < 0.0).count();
        assert!((left as i32 - 250).abs() <= 1, "{left}");
    }

    #[test]
    fn far_boxes_fall_on_the_clear_border() {
        let before = axis(-1e12, 3.0, 16);
        let behind = axis(1e12, 3.0, 16);
        assert_eq!((before.range.first, before.range.last), (0, 0));
        assert_eq!((behind.range.first, behind.range.last), (17, 17));
        assert!(axis(8.0, 1e30, 16).range == Range { first: 0, last: 17 });
    }
}
