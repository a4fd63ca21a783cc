//! An SVG's tree as opacities: every shape covers a texel by the share of its area that it has, to rounding errors.
//!
//! All that is asked for of a drawing (no filters, images or text) is worked out row by row, so layers, clips and masks cost rows. What several opaque
//! shapes of a layer cover of a texel is the area that they cover together; what is translucent, clipped or masked is taken to cover it independently of
//! all else, as compositing has it.

mod area;
mod blend;
mod ink;
mod outline;

use std::ops::Range;

use rayon::prelude::*;
use resvg::tiny_skia::{ColorU8, PathBuilder, PremultipliedColorU8};
use resvg::usvg::{BlendMode, ClipPath, FillRule, Group, Mask, MaskType, Node, PaintOrder, Path, Tree};

use self::area::{Crossing, Desk, Shape};
use self::blend::{Colour, blend, over};
use self::ink::Ink;
use self::outline::{Affine, edges, stroked};

/// A texel of a drawing: its colour, encoded as sRGB, and how opaque it is.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Texel {
    pub colour: [u8; 3],
    pub alpha: f32,
}

/// Draws a tree on [columns, rows] of texels: `scale` of them a pixel, the drawing's origin at `shift`. Rows of texels.
pub(super) fn draw(tree: &Tree, scale: f64, shift: [f64; 2], size: [usize; 2]) -> Vec<Vec<Texel>> {
    let canvas = Canvas { size };
    let items = items(tree.root(), &Affine([scale, 0.0, 0.0, scale, shift[0], shift[1]]), &canvas);
    canvas.draw(&items, |colour| Texel { colour: encoded(colour), alpha: colour[3] })
}

/// The grid that is drawn on.
struct Canvas {
    /// [columns, rows].
    size: [usize; 2],
}

/// Something to draw, with the columns and rows that it may touch.
struct Item {
    columns: Range<usize>,
    rows: Range<usize>,
    what: What,
}

enum What {
    Shape(Shape, Box<Ink>),
    Layer(Box<Layer>),
}

/// Items drawn by themselves, then laid on what is below.
struct Layer {
    items: Vec<Item>,
    clip: Option<Clip>,
    mask: Option<Stencil>,
    opacity: f32,
    mode: BlendMode,
}

/// What is kept of a layer: where these items are, and where the further clip is.
struct Clip {
    items: Vec<Item>,
    further: Option<Box<Clip>>,
}

/// What is kept of a layer: by how bright or opaque these items are, within a region, and by a further mask.
struct Stencil {
    items: Vec<Item>,
    region: Option<Shape>,
    kind: MaskType,
    further: Option<Box<Stencil>>,
}

/// A group's items; `map` leads from where the group lies to the grid.
fn items(group: &Group, map: &Affine, canvas: &Canvas) -> Vec<Item> {
    let map = map.after(group.transform());
    let mut inner: Vec<Item> = Vec::new();
    for node in group.children() {
        match node {
            Node::Group(group) => inner.extend(items(group, &map, canvas)),
            Node::Path(path) => shapes(path, &map, canvas, &mut inner),
            // Refused before.
            Node::Image(_) | Node::Text(_) => {}
        }
    }
    if !group.should_isolate() {
        return inner;
    }
    let layer = Layer {
        items: inner,
        clip: group.clip_path().map(|clip| Clip::of(clip, &map, canvas)),
        mask: group.mask().map(|mask| Stencil::of(mask, &map, canvas)),
        opacity: group.opacity().get(),
        mode: group.blend_mode(),
    };
    layer.item().into_iter().collect()
}

/// What a path fills and strokes, in the order of painting.
fn shapes(path: &Path, map: &Affine, canvas: &Canvas, items: &mut Vec<Item>) {
    if !path.is_visible() {
        return;
    }
    let from = items.len();
    if let Some(fill) = path.fill()
        && let Some(ink) = Ink::new(fill.paint(), fill.opacity(), map)
    {
        items.extend(canvas.item(path.data(), fill.rule(), map, ink));
    }
    let filled = items.len();
    if let Some(stroke) = path.stroke()
        && let Some(ink) = Ink::new(stroke.paint(), stroke.opacity(), map)
        && let Some((outline, map)) = stroked(path.data(), stroke, map)
    {
        items.extend(canvas.item(&outline, FillRule::NonZero, &map, ink));
    }
    if path.paint_order() == PaintOrder::StrokeAndFill {
        items[from..].rotate_left(filled - from);
    }
}

impl Canvas {
    fn shape(&self, path: &resvg::tiny_skia::Path, rule: FillRule, map: &Affine) -> Option<Shape> {
        Shape::new(edges(path, map, self.size[1] as f64), rule, self.size)
    }

    fn item(&self, path: &resvg::tiny_skia::Path, rule: FillRule, map: &Affine, ink: Ink) -> Option<Item> {
        let shape = self.shape(path, rule, map)?;
        Some(Item {
            columns: shape.columns.clone(),
            rows: shape.rows(),
            what: What::Shape(shape, Box::new(ink)),
        })
    }

    /// Draws items, row by row; each row's colours are made into what is kept of them.
    fn draw<T: Send>(&self, items: &[Item], keep: impl Fn(Colour) -> T + Sync) -> Vec<Vec<T>> {
        let [columns, rows] = self.size;
        let row = |desk: &mut Desk, row: usize| {
            let mut colours = vec![[0.0; 4]; columns];
            draw_row(items, row, 0, &mut colours, desk);
            colours.into_iter().map(&keep).collect()
        };
        (0..rows).into_par_iter().map_init(Desk::default, row).collect()
    }
}

/// Draws items on a row's colours, which begin at `column`.
fn draw_row(items: &[Item], row: usize, column: usize, colours: &mut [Colour], desk: &mut Desk) {
    let width = colours.len();
    let mut shared = Shared::new(width);
    for item in items.iter().filter(|item| item.rows.contains(&row)) {
        let start = item.columns.start;
        let within = |k: usize| (start + k).checked_sub(column).filter(|k| *k < width);
        match &item.what {
            What::Shape(shape, ink) => {
                let crossing = shape.crossing(row);
                let shares = desk.cover(&[&crossing], &item.columns);
                let Some(first) = shares.iter().position(|share| *share > 0.0) else { continue };
                let end = shares.iter().rposition(|share| *share > 0.0).map_or(0, |last| last + 1);
                let inks = ink.colours(row, start + first, end - first);
                let opaque = ink.is_opaque();
                for (k, share) in (first..end).zip(&shares[first..end]) {
                    let Some(at) = within(k) else { continue };
                    let source = inks.at(k - first).map(|c| c * share);
                    colours[at] = over(source, colours[at]);
                    if opaque {
                        shared.meetings[at] =
                            shared.meetings[at].saturating_add(Meetings::from(*share < 1.0));
                        shared.full[at] |= *share == 1.0;
                    } else {
                        shared.rest[at] *= 1.0 - source[3];
                    }
                }
                if opaque {
                    shared.shapes.push((crossing, start + first..start + end));
                }
            }
            What::Layer(layer) => {
                let mut own = vec![[0.0; 4]; item.columns.len()];
                layer.draw_row(row, start, &mut own, desk);
                for (k, source) in own.into_iter().enumerate().filter(|(_, source)| source[3] > 0.0) {
                    let Some(at) = within(k) else { continue };
                    colours[at] = blend(layer.mode, source, colours[at]);
                    shared.rest[at] *= 1.0 - source[3];
                }
            }
        }
    }
    shared.settle(column, colours, desk);
}

type Meetings = u8;

/// Texels of a row that several opaque shapes cover in part: what they cover together is not known from what each does.
struct Shared<'a> {
    /// Opaque shapes, with the columns that they touch.
    shapes: Vec<(Crossing<'a>, Range<usize>)>,
    /// How many of them cover a texel in part, and whether one covers it whole.
    meetings: Vec<Meetings>,
    full: Vec<bool>,
    /// What all that is not opaque lets through.
    rest: Vec<f32>,
}

impl Shared<'_> {
    fn new(columns: usize) -> Self {
        let (meetings, full, rest) = (vec![0; columns], vec![false; columns], vec![1.0; columns]);
        Self { shapes: Vec::new(), meetings, full, rest }
    }

    /// Gives these texels the opacity that they have.
    fn settle(&self, column: usize, colours: &mut [Colour], desk: &mut Desk) {
        let meets = |at: &usize| self.meetings[*at] > 1 && !self.full[*at];
        let mut next = 0;
        while let Some(start) = (next..colours.len()).find(meets) {
            let end = (start..colours.len()).find(|at| !meets(at)).unwrap_or(colours.len());
            let run = column + start..column + end;
            let touches = |touched: &Range<usize>| touched.start < run.end && run.start < touched.end;
            let shapes: Vec<&Crossing> =
                self.shapes.iter().filter(|(_, touched)| touches(touched)).map(|(shape, _)| shape).collect();
            let shares = desk.cover(&shapes, &run);
            for (at, share) in (start..end).zip(shares) {
                if colours[at][3] == 0.0 {
                    continue; // a paint without colours
                }
                let alpha = 1.0 - self.rest[at] * (1.0 - share);
                let scale = alpha / colours[at][3];
                colours[at] = colours[at].map(|c| c * scale);
                colours[at][3] = alpha;
            }
            next = end;
        }
    }
}

impl Layer {
    /// `None` for one without anything in it.
    fn item(self) -> Option<Item> {
        let all = |range: fn(&Item) -> &Range<usize>| {
            let ranges = || self.items.iter().map(range);
            Some(ranges().map(|r| r.start).min()?..ranges().map(|r| r.end).max()?)
        };
        let (columns, rows) = (all(|item| &item.columns)?, all(|item| &item.rows)?);
        Some(Item { columns, rows, what: What::Layer(Box::new(self)) })
    }

    fn draw_row(&self, row: usize, column: usize, colours: &mut [Colour], desk: &mut Desk) {
        draw_row(&self.items, row, column, colours, desk);
        let mut kept = vec![self.opacity; colours.len()];
        if let Some(clip) = &self.clip {
            clip.keep(row, column, &mut kept, desk);
        }
        if let Some(mask) = &self.mask {
            mask.keep(row, column, &mut kept, desk);
        }
        for (colour, kept) in colours.iter_mut().zip(kept) {
            *colour = colour.map(|c| c * kept);
        }
    }
}

impl Clip {
    fn of(clip: &ClipPath, map: &Affine, canvas: &Canvas) -> Self {
        let items = clipping(clip.root(), &map.after(clip.transform()), canvas);
        Self { items, further: clip.clip_path().map(|clip| Box::new(Self::of(clip, map, canvas))) }
    }

    /// Lessens what is kept of a row.
    fn keep(&self, row: usize, column: usize, kept: &mut [f32], desk: &mut Desk) {
        let mut colours = vec![[0.0; 4]; kept.len()];
        draw_row(&self.items, row, column, &mut colours, desk);
        kept.iter_mut().zip(colours).for_each(|(kept, colour)| *kept *= colour[3]);
        if let Some(further) = &self.further {
            further.keep(row, column, kept, desk);
        }
    }
}

/// What a clip path is made of: its shapes, whatever they are painted with.
fn clipping(group: &Group, map: &Affine, canvas: &Canvas) -> Vec<Item> {
    let map = map.after(group.transform());
    let mut all: Vec<Item> = Vec::new();
    for node in group.children() {
        match node {
            Node::Path(path) if path.is_visible() => {
                let opaque = Ink::Solid([0.0, 0.0, 0.0, 1.0]);
                all.extend(path.fill().and_then(|fill| canvas.item(path.data(), fill.rule(), &map, opaque)));
            }
            Node::Group(group) => {
                let items = clipping(group, &map, canvas);
                match group.clip_path() {
                    None => all.extend(items),
                    Some(clip) => {
                        let clip = Some(Clip::of(clip, &map.after(group.transform()), canvas));
                        let layer = Layer { items, clip, mask: None, opacity: 1.0, mode: BlendMode::Normal };
                        all.extend(layer.item());
                    }
                }
            }
            _ => {}
        }
    }
    all
}

impl Stencil {
    fn of(mask: &Mask, map: &Affine, canvas: &Canvas) -> Self {
        let region = PathBuilder::from_rect(mask.rect().to_rect());
        Self {
            items: items(mask.root(), map, canvas),
            region: canvas.shape(&region, FillRule::NonZero, map),
            kind: mask.kind(),
            further: mask.mask().map(|mask| Box::new(Self::of(mask, map, canvas))),
        }
    }

    /// Lessens what is kept of a row.
    fn keep(&self, row: usize, column: usize, kept: &mut [f32], desk: &mut Desk) {
        let mut colours = vec![[0.0; 4]; kept.len()];
        draw_row(&self.items, row, column, &mut colours, desk);
        let columns = column..column + kept.len();
        let region = self.region.as_ref().map(|region| region.crossing(row));
        let within = desk.cover(&region.iter().collect::<Vec<_>>(), &columns);
        for ((kept, within), [r, g, b, alpha]) in kept.iter_mut().zip(within).zip(colours) {
            *kept *= within
                * match self.kind {
                    MaskType::Luminance => 0.2126 * r + 0.7152 * g + 0.0722 * b,
                    MaskType::Alpha => alpha,
                };
        }
        if let Some(further) = &self.further {
            further.keep(row, column, kept, desk);
        }
    }
}

/// A colour without its alpha, in 8 bits.
fn encoded([r, g, b, alpha]: Colour) -> [u8; 3] {
    if alpha > 0.0 { [r, g, b].map(|c| (c / alpha * 255.0).round() as u8) } else { [0; 3] }
}

/// A colour in 8 bits.
fn codes(colour: Colour) -> PremultipliedColorU8 {
    let [r, g, b] = encoded(colour);
    ColorU8::from_rgba(r, g, b, (colour[3] * 255.0).round() as u8).premultiply()
}
