//! The lattice of texels that a puppet is drawn on, rectangles of it, and rigid motions in it.
//!
//! Lattice coordinates are in texels, x right and **y down**, with the rest grid's top left corner at the origin;
//! texel (i, j) covers [i, i + 1) × [j, j + 1).

use rayon::prelude::*;

use super::compose::Code;

/// A rectangle of whole texels, empty when an end is not beyond its start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Rect {
    pub x0: i64,
    pub y0: i64,
    pub x1: i64,
    pub y1: i64,
}

impl Rect {
    pub(crate) const EMPTY: Rect = Rect { x0: 0, y0: 0, x1: 0, y1: 0 };

    /// From the origin.
    pub(crate) fn of_size(width: usize, height: usize) -> Self {
        Self { x0: 0, y0: 0, x1: width as i64, y1: height as i64 }
    }

    pub(crate) fn width(&self) -> usize {
        usize::try_from(self.x1 - self.x0).unwrap_or(0)
    }

    pub(crate) fn height(&self) -> usize {
        usize::try_from(self.y1 - self.y0).unwrap_or(0)
    }

    pub(crate) fn area(&self) -> usize {
        self.width() * self.height()
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.x1 <= self.x0 || self.y1 <= self.y0
    }

    /// The smallest rectangle that holds both.
    pub(crate) fn union(self, other: Rect) -> Rect {
        match (self.is_empty(), other.is_empty()) {
            (true, _) => other,
            (_, true) => self,
            _ => Rect {
                x0: self.x0.min(other.x0),
                y0: self.y0.min(other.y0),
                x1: self.x1.max(other.x1),
                y1: self.y1.max(other.y1),
            },
        }
    }
}

/// How a drawing's user units lie on the lattice.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lattice {
    /// Columns at rest.
    pub columns: usize,
    /// Rows at rest.
    pub rows: usize,
    /// Texels a user unit.
    pub scale: f64,
    /// Columns to the left of the drawing: half of what rounding the width up to whole texels adds.
    pub margin: f64,
}

impl Lattice {
    /// `rows` square texels over a drawing `size` user units large, whole columns around its centre.
    pub(crate) fn new(size: [f64; 2], rows: usize) -> Self {
        let scale = rows as f64 / size[1];
        let width = size[0] * scale;
        // A width that is whole but for rounding errors needs no further column.
        let columns =
            if (width - width.round()).abs() < 1e-6 { width.round() } else { width.ceil() }.max(1.0);
        Self { columns: columns as usize, rows, scale, margin: 0.5 * (columns - width) }
    }

    /// Lattice coordinates of a point of the drawing, given from the drawing's top left corner.
    pub(crate) fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [x * self.scale + self.margin, y * self.scale]
    }

    /// The texels of the drawing.
    pub(crate) fn rest(&self) -> Rect {
        Rect::of_size(self.columns, self.rows)
    }

    /// The centre of the drawing and of the rest grid.
    pub(crate) fn centre(&self) -> [f64; 2] {
        [0.5 * self.columns as f64, 0.5 * self.rows as f64]
    }
}

/// A rotation and a translation of the lattice: `(c·x + s·y, −s·x + c·y) + t`, counter-clockwise as y points down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rigid {
    pub cos: f64,
    pub sin: f64,
    pub shift: [f64; 2],
}

impl Rigid {
    pub(crate) const IDENTITY: Rigid = Rigid { cos: 1.0, sin: 0.0, shift: [0.0; 2] };

    /// A turn about `pivot`, exact for multiples of 90°; whole turns are the identity itself.
    pub(crate) fn turn(pivot: [f64; 2], degrees: f64) -> Self {
        let turned = degrees.rem_euclid(360.0);
        let (sin, cos) = match turned {
            0.0 | 360.0 => return Self::IDENTITY,
            90.0 => (1.0, 0.0),
            180.0 => (0.0, -1.0),
            270.0 => (-1.0, 0.0),
            _ => turned.to_radians().sin_cos(),
        };
        let [x, y] = pivot;
        Self { cos, sin, shift: [x - (cos * x + sin * y), y - (cos * y - sin * x)] }
    }

    pub(crate) fn apply(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [self.cos * x + self.sin * y + self.shift[0], self.cos * y - self.sin * x + self.shift[1]]
    }

    /// First `inner`, then `self`; the identity changes nothing, to the bit.
    pub(crate) fn after(&self, inner: &Rigid) -> Rigid {
        if *self == Self::IDENTITY {
            return *inner;
        }
        if *inner == Self::IDENTITY {
            return *self;
        }
        Rigid {
            cos: self.cos * inner.cos - self.sin * inner.sin,
            sin: self.sin * inner.cos + self.cos * inner.sin,
            shift: self.apply(inner.shift),
        }
    }

    pub(crate) fn inverse(&self) -> Rigid {
        let [x, y] = self.shift;
        Rigid {
            cos: self.cos,
            sin: -self.sin,
            shift: [-(self.cos * x - self.sin * y), -(self.cos * y + self.sin * x)],
        }
    }

    /// The texels that `rect` touches once moved and resampled bilinearly (whose support is half a texel wider).
    pub(crate) fn bounds(&self, rect: Rect) -> Rect {
        if *self == Self::IDENTITY || rect.is_empty() {
            return rect;
        }
        let (left, right) = (rect.x0 as f64 - 0.5, rect.x1 as f64 + 0.5);
        let (top, bottom) = (rect.y0 as f64 - 0.5, rect.y1 as f64 + 0.5);
        let corners = [[left, top], [right, top], [left, bottom], [right, bottom]].map(|p| self.apply(p));
        let low = |axis: usize| corners.iter().fold(f64::INFINITY, |m, c| m.min(c[axis]));
        let high = |axis: usize| corners.iter().fold(f64::NEG_INFINITY, |m, c| m.max(c[axis]));
        // Texels whose centre is inside; what a centre this near the edge would weigh is far below a 16-bit code.
        const SLACK: f64 = 1e-6;
        let first = |low: f64| (low - 0.5 + SLACK).ceil() as i64;
        let end = |high: f64| (high - 0.5 - SLACK).floor() as i64 + 1;
        Rect { x0: first(low(0)), y0: first(low(1)), x1: end(high(0)), y1: end(high(1)) }
    }
}

/// A part's opacity 1 − τ on the lattice, with a border of one clear texel all around.
#[derive(Clone, Debug)]
pub(crate) struct Texture {
    /// The texels that are not clear, without the border.
    pub rect: Rect,
    /// 1 for grey; 4 for R, G, B and a lane that is not used, so that a texel fills a vector register.
    pub lanes: usize,
    /// `lanes` values for each of (width + 2) × (height + 2) texels, row by row.
    pub opacity: Vec<f32>,
}

impl Texture {
    /// The tight texture of what `opacity` gives for the texels of `within`; grey when all three channels are equal.
    pub(crate) fn new(within: Rect, opacity: impl Fn(i64, i64) -> [f32; 3] + Sync) -> Self {
        // Of each row: the first and the end of what is not clear, and whether it is grey.
        type Row = (Option<(i64, i64)>, bool);
        let scan = |y: i64| -> Row {
            let mut span = None;
            let mut grey = true;
            for x in within.x0..within.x1 {
                let [r, g, b] = opacity(x, y);
                if r > 0.0 || g > 0.0 || b > 0.0 {
                    span = Some((span.map_or(x, |(first, _)| first), x + 1));
                    grey &= r == g && g == b;
                }
            }
            (span, grey)
        };
        let rows: Vec<Row> = (within.y0..within.y1).into_par_iter().map(scan).collect();
        let mut rect = Rect::EMPTY;
        for (y, (span, _)) in (within.y0..).zip(&rows) {
            if let Some((x0, x1)) = *span {
                rect = rect.union(Rect { x0, y0: y, x1, y1: y + 1 });
            }
        }
        let lanes = if rows.iter().all(|(_, grey)| *grey) { 1 } else { 4 };
        let stride = (rect.width() + 2) * lanes;
        let mut values = vec![0.0; stride * (rect.height() + 2)];
        values[stride..].par_chunks_exact_mut(stride).take(rect.height()).enumerate().for_each(|(j, row)| {
            for (i, texel) in row[lanes..stride - lanes].chunks_exact_mut(lanes).enumerate() {
                let rgb = opacity(rect.x0 + i as i64, rect.y0 + j as i64);
                texel.iter_mut().zip(rgb).for_each(|(value, opacity)| *value = opacity);
            }
        });
        Self { rect, lanes, opacity: values }
    }

    /// The share of its opacity that its codes have too much or too little, all texels together.
    pub(crate) fn missed<C: Code>(&self) -> f64 {
        let (mut all, mut coded) = (0.0, 0.0);
        for opacity in self.opacity.iter().filter(|opacity| **opacity > 0.0) {
            all += f64::from(*opacity);
            coded += f64::from(1.0 - C::nearest(1.0 - opacity).transmittance());
        }
        if all > 0.0 { (coded / all - 1.0).abs() } else { 0.0 }
    }

    /// A grey texture as a coloured one.
    pub(crate) fn widen(&mut self) {
        if self.lanes == 1 {
            self.opacity = self.opacity.iter().flat_map(|&o| [o, o, o, 0.0]).collect();
            self.lanes = 4;
        }
    }

    /// Texels a row, with the border.
    pub(crate) fn stride(&self) -> usize {
        self.rect.width() + 2
    }

    /// The texels, with the border; L must be the number of lanes.
    pub(crate) fn texels<const L: usize>(&self) -> &[[f32; L]] {
        debug_assert_eq!(L, self.lanes);
        self.opacity.as_chunks().0
    }
}
