//! What one drawing needs, worked out before any pixel: the pieces of the lamp, the boxes of every column and row, the
//! tables and their fixed-point scales.

use glam::{DVec2, DVec3};
use kelir_frame::{Pixel, RenderError, View};
use kelir_scene::{Ambient, EmitterShape, Theatre};

use super::{Knobs, Variant, Weights};
use crate::project::tilted::{Piece, PlaneFrame};
use crate::project::window::Windows;
use crate::project::{ShadowBox, is_tilted, pixel_m, sides_m};

/// One plane seen from one piece.
#[derive(Clone, Debug)]
pub(crate) struct Lookup {
    /// Index into the theatre's planes.
    pub plane: usize,
    /// Index into the plan's pieces.
    pub piece: usize,
    /// Boxes of every column (of sub-pixels).
    pub x: Windows,
    /// Boxes of every row (of sub-pixels).
    pub y: Windows,
    /// Row weights are multiplied by `2^shift / unit` and rounded to integers.
    pub shift: u32,
    /// min(1, height of the box in texels).
    pub unit: f64,
    /// From fixed-point sums to mean opacity.
    pub norm: f64,
    /// A later look-up of the same plane whose boxes contain this one's: what is lit or dark there is so here.
    pub within: Option<usize>,
    /// For a tilted plane, in place of windows.
    pub tilted: Option<PlaneFrame>,
}

/// Everything but the pixels.
#[derive(Clone, Debug)]
pub(crate) struct Plan {
    /// Sub-pixels a pixel and axis.
    pub sub: usize,
    /// Pieces, grouped by emitter.
    pub pieces: Vec<Piece>,
    /// Planes × pieces; planes off the beam are absent unless asked for.
    pub lookups: Vec<Lookup>,
    /// Planes on the beam.
    pub planes: Vec<usize>,
    /// Per plane of the theatre: whether its tables need u64 sums.
    pub wide: Vec<bool>,
    /// 3 where a puppet on the beam is coloured, else 1.
    pub channels: usize,
    /// Distances from the screen, per plane of the theatre.
    pub distance_m: Vec<f64>,
}

fn refuse(reason: String) -> RenderError {
    RenderError::Inapplicable { technique: "pa", reason }
}

impl Plan {
    /// Errors: what this code can't draw truthfully.
    pub(crate) fn new(theatre: &Theatre, view: &View, knobs: &Knobs) -> Result<Self, RenderError> {
        Self::of(theatre, view, knobs, false)
    }

    /// The same with look-ups also of the planes that no light passes: they change nothing.
    pub(crate) fn with_planes_off_beam(
        theatre: &Theatre,
        view: &View,
        knobs: &Knobs,
    ) -> Result<Self, RenderError> {
        Self::of(theatre, view, knobs, true)
    }

    fn of(theatre: &Theatre, view: &View, knobs: &Knobs, all: bool) -> Result<Self, RenderError> {
        view.check(sides_m(&theatre.screen))?;
        let lamp = theatre.lamp.position_m;
        if let Some(i) = theatre.planes.iter().position(is_tilted) {
            let tilt = theatre.planes[i].tilt_deg;
            let refused = match theatre.ambient {
                Ambient::Dome { .. } => Some("ambient.model = \"dome\" is drawn with upright puppets only"),
                _ if knobs.variant == Variant::ShadowMap => {
                    Some("a shadow map is drawn of upright puppets only")
                }
                _ => None,
            };
            if let Some(rule) = refused {
                return Err(refuse(format!("puppets[{i}].tilt_deg = {tilt:?}: {rule}")));
            }
        }
        // One upright plane splits exactly into pieces of equal area, so splitting would change nothing.
        let exact = theatre.planes.len() < 2 && !theatre.planes.iter().any(is_tilted);
        let split = if exact && knobs.weights == Weights::Area { 1 } else { knobs.split as usize };
        let pieces: Vec<Piece> = theatre
            .lamp
            .emitters
            .iter()
            .enumerate()
            .flat_map(|(k, emitter)| cut(k, &emitter.shape, lamp, split, knobs.strips as usize))
            .collect();
        let sub = subpixels(theatre, view);
        let size = [view.size[0] * sub, view.size[1] * sub];
        let mut plan = Self {
            sub,
            pieces,
            lookups: Vec::new(),
            planes: Vec::new(),
            wide: vec![false; theatre.planes.len()],
            channels: 1,
            distance_m: theatre.planes.iter().map(|p| -p.centre_m.z).collect(),
        };
        for p in 0..theatre.planes.len() {
            plan.add_plane(theatre, view, p, size, all);
        }
        Ok(plan)
    }

    fn add_tilted(&mut self, theatre: &Theatre, p: usize, all: bool) {
        let plane = &theatre.planes[p];
        let frame = PlaneFrame::new(plane);
        let corner = 0.5 * DVec2::new(theatre.screen.width_m, theatre.screen.height_m);
        let grid = DVec2::new(plane.mask.width as f64, plane.mask.height as f64);
        let off = self.pieces.iter().all(|piece| {
            let [low, high] = frame.range([-corner, corner], piece);
            low.cmpge(grid).any() || high.cmple(DVec2::ZERO).any()
        });
        if off && !all {
            return;
        }
        self.wide[p] = plane.mask.width as f64 * plane.mask.height as f64 * f64::from(plane.mask.max_code())
            >= 2f64.powi(32);
        for piece in 0..self.pieces.len() {
            self.lookups.push(Lookup {
                plane: p,
                piece,
                x: Windows::default(),
                y: Windows::default(),
                shift: 0,
                unit: 1.0,
                norm: 0.0,
                within: None,
                tilted: Some(frame.clone()),
            });
        }
        if !off {
            self.planes.push(p);
        }
        self.channels = self.channels.max(plane.mask.channels);
    }

    fn add_plane(&mut self, theatre: &Theatre, view: &View, p: usize, size: [usize; 2], all: bool) {
        let plane = &theatre.planes[p];
        let grid = [plane.mask.width, plane.mask.height];
        let first = self.lookups.len();
        let max_code = f64::from(plane.mask.max_code());
        let mut largest = 0f64;
        if is_tilted(plane) {
            return self.add_tilted(theatre, p, all);
        }
        for (i, piece) in self.pieces.iter().enumerate() {
            let map = ShadowBox::new(plane, piece.centre_m);
            let at = |i: usize, j: usize| map.centre(pixel_m(&theatre.screen, size, i as f64, j as f64));
            let sides = map.spread * DVec2::from(piece.size_m);
            let pixel = match view.pixel {
                Pixel::Area => (at(1, 1) - at(0, 0)).abs(),
                Pixel::Centre => DVec2::ZERO,
            };
            let (x, y) = rayon::join(
                || Windows::new(size[0], |i| at(i, 0).x, sides.x, grid[0], pixel.x),
                || Windows::new(size[1], |j| at(0, j).y, sides.y, grid[1], pixel.y),
            );
            largest = largest.max((sides.x + pixel.x + 2.0) * sides.y.max(1.0) * max_code);
            self.lookups.push(Lookup {
                plane: p,
                piece: i,
                x,
                y,
                shift: 32,
                unit: sides.y.min(1.0),
                norm: 0.0,
                within: None,
                tilted: None,
            });
        }
        let off = self.lookups[first..].iter().all(|l| {
            let ([x0, x1], [y0, y1]) = (l.x.touched(0..size[0], grid[0]), l.y.touched(0..size[1], grid[1]));
            x0 == x1 || y0 == y1
        });
        if off && !all {
            self.lookups.truncate(first);
            return;
        }
        // With u32 tables sums are known modulo 2³² only, so all 32 bits of fraction fit in 64 and the box must be under 2³².
        self.wide[p] = largest >= 2f64.powi(32);
        let bits = largest.log2().ceil() as u32 + 1;
        for lookup in &mut self.lookups[first..] {
            lookup.shift = if self.wide[p] { (64 - bits).min(32) } else { 32 };
            let scale = 2f64.powi(lookup.shift as i32) / lookup.unit;
            lookup.norm = 1.0 / (lookup.x.width * lookup.y.width * max_code * scale);
        }
        for l in first..self.lookups.len() {
            let contains = |m: &usize| {
                let (one, other) =
                    (&self.pieces[self.lookups[l].piece], &self.pieces[self.lookups[*m].piece]);
                one.centre_m == other.centre_m && (0..2).all(|axis| one.size_m[axis] <= other.size_m[axis])
            };
            self.lookups[l].within = (l + 1..self.lookups.len()).find(contains);
        }
        if !off {
            self.planes.push(p);
        }
        self.channels = self.channels.max(plane.mask.channels);
    }
}

/// An emitter's pieces: a rectangle's `split` × `split`, or a disk's `strips` of equal height, each as wide as its own area asks and cut
/// into `split` side by side.
fn cut(emitter: usize, shape: &EmitterShape, lamp_m: DVec3, split: usize, strips: usize) -> Vec<Piece> {
    let part = |i: usize, n: usize| (i as f64 + 0.5) / n as f64 - 0.5;
    let grid = |rows: usize| (0..rows).flat_map(move |j| (0..split).map(move |i| (i, j)));
    match *shape {
        EmitterShape::Rectangle { size_m: [w, h] } => {
            let n = split as f64;
            let piece = |(i, j)| Piece {
                emitter,
                centre_m: lamp_m + DVec3::new(part(i, split) * w, part(j, split) * h, 0.0),
                size_m: [w / n, h / n],
                weight: 1.0,
            };
            grid(split).map(piece).collect()
        }
        EmitterShape::Disk { radius_m } => {
            let height = 2.0 / strips as f64;
            // Area of the unit disk below y.
            let below = |y: f64| {
                let y = y.clamp(-1.0, 1.0);
                y * (1.0 - y * y).sqrt() + y.asin()
            };
            let piece = |(i, j): (usize, usize)| {
                let bottom = -1.0 + j as f64 * height;
                let area = below(bottom + height) - below(bottom);
                let width = area / height;
                Piece {
                    emitter,
                    centre_m: lamp_m
                        + radius_m * DVec3::new(part(i, split) * width, bottom + 0.5 * height, 0.0),
                    size_m: [radius_m * width / split as f64, radius_m * height],
                    weight: area,
                }
            };
            grid(strips).map(piece).collect()
        }
    }
}

/// Sub-pixels an axis: 1 unless several planes, or a tilted one, meet `area` pixels that are wider than a quarter of the
/// narrowest box.
fn subpixels(theatre: &Theatre, view: &View) -> usize {
    let alone = theatre.planes.len() < 2 && !theatre.planes.iter().any(is_tilted);
    if alone || view.pixel == Pixel::Centre {
        return 1;
    }
    let pixel_m = theatre.screen.width_m / view.size[0] as f64;
    let narrowest = theatre.planes.iter().flat_map(|plane| {
        let ratio = plane.centre_m.z / theatre.lamp.position_m.z;
        theatre.lamp.emitters.iter().map(move |emitter| {
            let [a, b] = emitter.shape.half_extent_m();
            2.0 * a.min(b) * ratio / ((1.0 - ratio) * pixel_m)
        })
    });
    let narrowest = narrowest.fold(f64::INFINITY, f64::min);
    ((4.0 / narrowest).ceil() as usize).clamp(1, 4)
}
