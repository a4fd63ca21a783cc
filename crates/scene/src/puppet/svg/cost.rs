//! What drawing an SVG would cost, from its elements' bounds, before it is drawn.

use resvg::tiny_skia::{PathSegment, Point};
use resvg::usvg::{Group, Node, Path, Tree};

/// Texels filled, all elements and layers together: ten seconds or so.
const MOST_FILLED: f64 = (1u64 << 34) as f64;
/// Texels of layers held at once, four bytes each.
const MOST_LAYERED: f64 = (1u64 << 28) as f64;
/// Dashes of all strokes together.
const MOST_DASHES: f64 = 1e6;

/// An upper estimate of what a drawing needs.
#[derive(Clone, Copy, Default)]
pub(super) struct Cost {
    filled: f64,
    layered: f64,
    dashes: f64,
}

impl Cost {
    /// One after the other.
    pub(super) fn and(self, other: Cost) -> Cost {
        Cost {
            filled: self.filled + other.filled,
            layered: self.layered.max(other.layered),
            dashes: self.dashes + other.dashes,
        }
    }

    /// The rule that is broken, if one is.
    pub(super) fn check(&self) -> Result<(), String> {
        let Cost { filled, layered, dashes } = *self;
        // A NaN, from bounds that overflowed, is over every limit.
        let over = |cost: f64, most: f64| cost.partial_cmp(&most).is_none_or(std::cmp::Ordering::is_gt);
        if over(filled, MOST_FILLED) {
            return Err(format!("fills {filled:.1e} texels, overlaps counted; at most {MOST_FILLED:.1e}"));
        }
        if over(layered, MOST_LAYERED) {
            return Err(format!("needs layers of {layered:.1e} texels at once; at most {MOST_LAYERED:.1e}"));
        }
        if over(dashes, MOST_DASHES) {
            return Err(format!("strokes {dashes:.1e} dashes; at most {MOST_DASHES:.1e}"));
        }
        Ok(())
    }
}

/// The cost of a tree drawn on `rows` rows.
pub(super) fn of_tree(tree: &Tree, rows: usize) -> Cost {
    let size = tree.size();
    let scale = rows as f64 / f64::from(size.height());
    let canvas = [f64::from(size.width()) * scale, f64::from(size.height()) * scale];
    of_group(tree.root(), scale, canvas)
}

fn of_group(group: &Group, scale: f64, canvas: [f64; 2]) -> Cost {
    let mut cost = Cost::default();
    for node in group.children() {
        cost = cost.and(match node {
            Node::Group(group) => of_group(group, scale, canvas),
            Node::Path(path) => of_path(path, scale, canvas),
            Node::Image(_) | Node::Text(_) => Cost { filled: f64::INFINITY, ..Cost::default() }, // refused before
        });
    }
    if group.should_isolate() {
        // resvg keeps layers up to five canvases wide and high.
        let layer = group.abs_layer_bounding_box();
        let side = |extent: f32, canvas: f64| (f64::from(extent) * scale + 2.0).min(5.0 * canvas);
        let texels = side(layer.width(), canvas[0]) * side(layer.height(), canvas[1]);
        // Clips and masks are drawn on layers of their own.
        let clip = group.clip_path().map(|clip| of_group(clip.root(), scale, canvas));
        let mask = group.mask().map(|mask| of_group(mask.root(), scale, canvas));
        let extra = 1.0 + f64::from(u8::from(clip.is_some())) + f64::from(u8::from(mask.is_some()));
        cost = cost.and(clip.unwrap_or_default()).and(mask.unwrap_or_default());
        cost.filled += texels * extra;
        cost.layered += texels * extra;
    }
    cost
}

fn of_path(path: &Path, scale: f64, canvas: [f64; 2]) -> Cost {
    let bounds = path.abs_stroke_bounding_box();
    let side = |extent: f32, canvas: f64| (f64::from(extent) * scale + 2.0).min(canvas);
    let area = side(bounds.width(), canvas[0]) * side(bounds.height(), canvas[1]);
    let dashes = path.stroke().and_then(|stroke| stroke.dasharray()).map_or(0.0, |dashes| {
        let period: f32 = dashes.iter().sum();
        dashes.len() as f64 * (length(path) / f64::from(period) + 1.0)
    });
    let fills = f64::from(u8::from(path.fill().is_some())) + f64::from(u8::from(path.stroke().is_some()));
    Cost { filled: area * fills, layered: 0.0, dashes }
}

/// An upper bound of a path's length: curves are no longer than their control polygons.
fn length(path: &Path) -> f64 {
    let mut sum = 0.0;
    let (mut start, mut last) = (Point::zero(), Point::zero());
    for segment in path.data().segments() {
        let points: &[Point] = match &segment {
            PathSegment::MoveTo(p) => {
                (start, last) = (*p, *p);
                continue;
            }
            PathSegment::LineTo(p) => &[*p],
            PathSegment::QuadTo(a, b) => &[*a, *b],
            PathSegment::CubicTo(a, b, c) => &[*a, *b, *c],
            PathSegment::Close => &[start],
        };
        for point in points {
            sum += f64::from(point.distance(last));
            last = *point;
        }
    }
    sum
}
