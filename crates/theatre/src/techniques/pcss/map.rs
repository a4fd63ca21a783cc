//! A puppet's shadow map: depth and transmittance as the lamp's centre sees them, on a grid over the screen.

use glam::{DVec2, DVec3};
use kelir_frame::{Pixel, RenderError, View};
use kelir_scene::{Lamp, Mask, Plane, Texels, Theatre};
use rayon::prelude::*;

use super::{Knobs, refuse};
use crate::project::{pixel_m, turned};
use crate::trace::bounds::{Padded, Range};

/// Depth codes of a tilted plane, over the range of its own depths.
const DEPTHS: usize = 1 << 12;

/// One puppet's map.
pub(crate) struct Map {
    /// Transmittances with a clear border.
    pub mask: Padded,
    /// Unique among live maps, for what a GPU keeps.
    pub id: u64,
    /// Depth codes on the same padded grid; `None` for an upright plane, which has one depth.
    pub depths: Option<Vec<u16>>,
}

/// Where the pixels of one view fall on one puppet's map, in fixed point with `bits` bits of fraction of a texel.
pub(crate) struct Beam {
    /// The map's edges on the screen's plane, metres: where light from the lamp's centre through the puppet arrives.
    low: DVec2,
    high: DVec2,
    /// Texels a side.
    pub size: usize,
    /// Bits of fraction.
    pub bits: u32,
    /// Columns' centres.
    pub columns: Vec<i32>,
    /// Rows' centres, downwards.
    pub rows: Vec<i32>,
    /// A pixel's sides; 0 for `centre`.
    pub pixel: [i32; 2],
    /// One an emitter.
    pub emitters: Vec<Penumbra>,
    /// Least and largest distance from the screen, metres.
    depth_m: [f64; 2],
}

/// Sides of an emitter's penumbra on the map.
pub(crate) struct Penumbra {
    /// The blocker search's: of the plane's nearest point to the lamp, as if that were the near plane.
    pub search: [i32; 2],
    /// The filter's, one a depth code.
    pub widths: Vec<[i32; 2]>,
}

impl Beam {
    /// `None` where the puppet's shadow falls off the screen and skipping that is allowed. Errors: a puppet too small for fixed point.
    pub(super) fn new(
        theatre: &Theatre,
        view: &View,
        p: usize,
        knobs: &Knobs,
    ) -> Result<Option<Self>, RenderError> {
        let (plane, lamp) = (&theatre.planes[p], theatre.lamp.position_m);
        let corners = plane.corners_m();
        let depths = corners.map(|c| -c.z);
        let depth_m =
            [depths.into_iter().fold(f64::INFINITY, f64::min), depths.into_iter().fold(0.0, f64::max)];
        // Similar triangles: the penumbra's width on the screen per metre of emitter.
        let grow = |depth: f64| depth / (-lamp.z - depth);
        let sides = DVec2::new(theatre.screen.width_m, theatre.screen.height_m);
        let pixel = match view.pixel {
            Pixel::Area => sides / DVec2::new(view.size[0] as f64, view.size[1] as f64),
            Pixel::Centre => DVec2::ZERO,
        };
        let extents = theatre.lamp.emitters.iter().map(|e| 2.0 * DVec2::from(e.shape.half_extent_m()));
        let widest = extents.clone().fold(DVec2::ZERO, DVec2::max) * grow(depth_m[1]);
        let reach = 0.5 * (sides + widest + pixel);
        // Seen from the lamp's centre a plane's outline stays a polygon, so its corners bound it.
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for corner in corners {
            let ray = corner - lamp;
            let on_screen = lamp.truncate() + ray.truncate() * (lamp.z / -ray.z);
            (low, high) = (low.min(on_screen), high.max(on_screen));
        }
        let whole = (low, high);
        (low, high) = (low.max(-reach), high.min(reach));
        let off = low.cmpge(high).any();
        if off && view.skip {
            return Ok(None);
        }
        if off {
            // A map that no pixel looks at.
            (low, high) = whole;
        }
        let size = knobs.map_size as usize;
        let texels = DVec2::splat(size as f64) / (high - low);
        let extent = ((reach + low.abs().max(high.abs())) * texels).max_element().max(size as f64);
        let bits = (29.0 - extent.log2()).floor().min(16.0);
        if bits < 0.0 && off {
            return Ok(None);
        }
        if bits < 0.0 {
            let rule = format!("a map of {size} samples a side would need {extent:.0} over the screen");
            return Err(refuse(format!("puppets[{p}].size = {:?} m: {rule}", plane.size_m)));
        }
        let fixed = |t: f64| (t * bits.exp2()).round() as i32;
        let widths = |depth: f64, extent: DVec2| (extent * grow(depth) * texels).to_array().map(fixed);
        let penumbra = |extent: DVec2| {
            let codes = if depth_m[0] == depth_m[1] { 1 } else { DEPTHS };
            let depth = |code: usize| {
                depth_m[0] + (depth_m[1] - depth_m[0]) * code as f64 / (codes - 1).max(1) as f64
            };
            Penumbra {
                search: widths(depth_m[1], extent),
                widths: (0..codes).map(|code| widths(depth(code), extent)).collect(),
            }
        };
        let at = |i: usize, j: usize| pixel_m(&theatre.screen, view.size, i as f64, j as f64);
        Ok(Some(Self {
            size,
            bits: bits as u32,
            columns: (0..view.size[0]).map(|i| fixed((at(i, 0).x - low.x) * texels.x)).collect(),
            rows: (0..view.size[1]).map(|j| fixed((high.y - at(0, j).y) * texels.y)).collect(),
            pixel: (pixel * texels).to_array().map(fixed),
            emitters: extents.map(penumbra).collect(),
            low,
            high,
            depth_m,
        }))
    }

    /// What a map depends on, as text.
    pub(super) fn key(&self, plane: &Plane, lamp: &Lamp) -> String {
        let place = (plane.mask.id, plane.centre_m, plane.size_m, plane.tilt_deg);
        format!("{place:?} {:?} {:?} {:?} {}", lamp.position_m, self.low, self.high, self.size)
    }

    /// Every padded texel that emitter `e`'s samples at pixel (i, j) can fall on.
    pub(super) fn range(&self, e: usize, i: usize, j: usize) -> (Range, Range) {
        let [x, y] = [(self.columns[i], 0), (self.rows[j], 1)].map(|(centre, d)| {
            // One more for the rounding of each product.
            let half = (self.emitters[e].search[d] >> 1) + (self.pixel[d] >> 1) + 2;
            let texel = |t: i32| self.padded(t);
            Range { first: texel(centre - half), last: texel(centre + half) }
        });
        (x, y)
    }

    /// The padded texel at a fixed-point place.
    #[inline(always)]
    pub(super) fn padded(&self, t: i32) -> u32 {
        ((t >> self.bits).clamp(-1, self.size as i32) + 1) as u32
    }
}

impl Map {
    /// Point samples at the map's texel centres.
    pub(super) fn new(theatre: &Theatre, plane: &Plane, beam: &Beam, knobs: &Knobs) -> Self {
        let (lamp, size) = (theatre.lamp.position_m, beam.size);
        let [right, up, normal] = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| turned(plane, axis));
        let grid = DVec2::new(plane.mask.width as f64, plane.mask.height as f64);
        let to_plane = normal.dot(plane.centre_m - lamp);
        let step = (beam.high - beam.low) / size as f64;
        // The texel that map sample k shows and its distance from the screen; None beside the grid.
        let seen = |k: usize| {
            let part = DVec2::new((k % size) as f64 + 0.5, (k / size) as f64 + 0.5) * step;
            let ray = DVec3::new(beam.low.x + part.x, beam.high.y - part.y, 0.0) - lamp;
            let at = lamp + ray * (to_plane / normal.dot(ray));
            let x = at - plane.centre_m;
            let t = (DVec2::new(x.dot(right), -x.dot(up)) / DVec2::from(plane.size_m) + 0.5) * grid;
            // Written so that a NaN (a ray along the plane) is beside the grid.
            let inside = t.cmpge(DVec2::ZERO).all() && t.cmplt(grid).all() && -at.z > knobs.bias_m;
            inside.then(|| (t.y as usize * plane.mask.width + t.x as usize, -at.z))
        };
        let area = plane.mask.width * plane.mask.height;
        let texels = match &plane.mask.texels {
            Texels::U8(t) => Texels::U8(sampled(t, u8::MAX, area, size, seen)),
            Texels::U16(t) => Texels::U16(sampled(t, u16::MAX, area, size, seen)),
        };
        let [near, far] = beam.depth_m;
        let depths = (near < far).then(|| {
            let stride = size + 2;
            let code = |k: usize| {
                let (x, y) = (k % stride, k / stride);
                if x == 0 || y == 0 || x > size || y > size {
                    return 0;
                }
                seen((y - 1) * size + x - 1).map_or(0, |(_, depth)| {
                    (((depth - near) / (far - near)).clamp(0.0, 1.0) * (DEPTHS - 1) as f64).round() as u16
                })
            };
            (0..stride * stride).into_par_iter().with_min_len(4096).map(code).collect()
        });
        let mask = Mask::new(size, size, plane.mask.channels, texels);
        Self { mask: Padded::new(&mask), id: mask.id, depths }
    }
}

fn sampled<T: Copy + Send + Sync>(
    texels: &[T],
    clear: T,
    area: usize,
    size: usize,
    seen: impl Fn(usize) -> Option<(usize, f64)> + Sync,
) -> Vec<T> {
    let one = |k: usize| {
        let (c, k) = (k / (size * size), k % (size * size));
        seen(k).map_or(clear, |(t, _)| texels[c * area + t])
    };
    let all = texels.len() / area * size * size;
    (0..all).into_par_iter().with_min_len(4096).map(one).collect()
}
