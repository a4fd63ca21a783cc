//! What shapes are painted with.

use resvg::tiny_skia::{
    Color, FilterQuality, GradientStop, LinearGradient, Paint, Pattern, Pixmap, RadialGradient, Rect, Shader,
    SpreadMode, Transform,
};
use resvg::usvg::{self, BaseGradient, Opacity, SpreadMethod};

use super::blend::Colour;
use super::outline::Affine;
use super::{Canvas, Item, codes, items};

/// Texels along a side of a pattern's tile at most; a larger tile is drawn coarser.
const TILE_SIDE: f64 = 4096.0;

/// A paint, ready for every row.
pub(super) enum Ink {
    Solid(Colour),
    Gradient(Shader<'static>, Affine),
    Tile { pixels: Pixmap, map: Affine, opacity: f32 },
}

impl Ink {
    /// `None` for what paints nothing.
    pub(super) fn new(paint: &usvg::Paint, opacity: Opacity, map: &Affine) -> Option<Self> {
        Some(match paint {
            usvg::Paint::Color(colour) => {
                let alpha = opacity.get();
                let [r, g, b] = [colour.red, colour.green, colour.blue].map(|c| alpha * f32::from(c) / 255.0);
                Self::Solid([r, g, b, alpha])
            }
            usvg::Paint::LinearGradient(gradient) => {
                let (stops, spread) = stops(gradient, opacity);
                let ends = [(gradient.x1(), gradient.y1()), (gradient.x2(), gradient.y2())];
                let [from, to] = ends.map(Into::into);
                Self::Gradient(LinearGradient::new(from, to, stops, spread, gradient.transform())?, *map)
            }
            usvg::Paint::RadialGradient(gradient) => {
                let (stops, spread) = stops(gradient, opacity);
                let (focus, centre) = ((gradient.fx(), gradient.fy()), (gradient.cx(), gradient.cy()));
                let (inner, outer) = (gradient.fr().get(), gradient.r().get());
                let shader = RadialGradient::new(
                    focus.into(),
                    inner,
                    centre.into(),
                    outer,
                    stops,
                    spread,
                    gradient.transform(),
                )?;
                Self::Gradient(shader, *map)
            }
            usvg::Paint::Pattern(pattern) => tile(pattern, opacity, map)?,
        })
    }

    /// Whether nothing shines through it.
    pub(super) fn is_opaque(&self) -> bool {
        match self {
            Self::Solid([.., alpha]) => *alpha == 1.0,
            Self::Gradient(shader, _) => shader.is_opaque(),
            Self::Tile { .. } => false,
        }
    }

    /// Its colours on a row of texels from a column on.
    pub(super) fn colours(&self, row: usize, column: usize, count: usize) -> Colours {
        let (shader, map) = match self {
            Self::Solid(colour) => return Colours::One(*colour),
            Self::Gradient(shader, map) => (shader.clone(), map),
            Self::Tile { pixels, map, opacity } => {
                let (spread, quality) = (SpreadMode::Repeat, FilterQuality::Bicubic);
                (Pattern::new(pixels.as_ref(), spread, quality, *opacity, Transform::identity()), map)
            }
        };
        let mut shader = shader;
        shader.transform(map.from([column as f64, row as f64]));
        let paint = Paint { shader, anti_alias: false, force_hq_pipeline: true, ..Paint::default() };
        let mut line = Pixmap::new(count.max(1) as u32, 1).expect("a row has texels");
        let all = Rect::from_xywh(0.0, 0.0, count as f32, 1.0).expect("a row has texels");
        line.fill_rect(all, &paint, Transform::identity(), None);
        let colour = |p: &resvg::tiny_skia::PremultipliedColorU8| {
            [p.red(), p.green(), p.blue(), p.alpha()].map(|c| f32::from(c) / 255.0)
        };
        Colours::Each(line.pixels().iter().map(colour).collect())
    }
}

/// Colours along a row.
pub(super) enum Colours {
    One(Colour),
    Each(Vec<Colour>),
}

impl Colours {
    pub(super) fn at(&self, k: usize) -> Colour {
        match self {
            Self::One(colour) => *colour,
            Self::Each(colours) => colours[k],
        }
    }
}

fn stops(gradient: &BaseGradient, opacity: Opacity) -> (Vec<GradientStop>, SpreadMode) {
    let stop = |stop: &usvg::Stop| {
        let (c, alpha) = (stop.color(), stop.opacity() * opacity);
        let colour = Color::from_rgba8(c.red, c.green, c.blue, alpha.to_u8());
        GradientStop::new(stop.offset().get(), colour)
    };
    let spread = match gradient.spread_method() {
        SpreadMethod::Pad => SpreadMode::Pad,
        SpreadMethod::Reflect => SpreadMode::Reflect,
        SpreadMethod::Repeat => SpreadMode::Repeat,
    };
    (gradient.stops().iter().map(stop).collect(), spread)
}

/// One tile of a pattern, drawn at the size that it has on the grid.
fn tile(pattern: &usvg::Pattern, opacity: Opacity, map: &Affine) -> Option<Ink> {
    let map = map.after(pattern.transform());
    let rect = pattern.rect();
    let sizes = [rect.width(), rect.height()].map(f64::from);
    let [w, h] = [0, 1].map(|k| (sizes[k] * map.scales()[k]).round().min(TILE_SIDE));
    let [sx, sy] = [w / sizes[0], h / sizes[1]];
    let mut pixels = Pixmap::new(w as u32, h as u32)?;
    let canvas = Canvas { size: [w as usize, h as usize] };
    let drawn: Vec<Item> = items(pattern.root(), &Affine([sx, 0.0, 0.0, sy, 0.0, 0.0]), &canvas);
    let colours = canvas.draw(&drawn, codes);
    for (pixel, colour) in pixels.pixels_mut().iter_mut().zip(colours.into_iter().flatten()) {
        *pixel = colour;
    }
    let place = Transform::from_row((1.0 / sx) as f32, 0.0, 0.0, (1.0 / sy) as f32, rect.x(), rect.y());
    Some(Ink::Tile { pixels, map: map.after(place), opacity: opacity.get() })
}
