//! What drawing an SVG would cost, from its elements' bounds, before it is drawn.

use resvg::tiny_skia::{PathSegment, Point};
use resvg::usvg::{Group, Node, Paint, Path, Tree};

/// Texels filled, all elements and layers together: ten seconds or so.
const MOST_FILLED: f64 = (1u64 << 34) as f64;
/// Rows that straight pieces of outlines cross, all together: ten seconds or so.
const MOST_CROSSED: f64 = (1u64 << 26) as f64;
/// Dashes of all strokes together.
const MOST_DASHES: f64 = 1e6;

/// An upper estimate of what a drawing needs.
#[derive(Clone, Copy, Default)]
pub(super) struct Cost {
    filled: f64,
    crossed: f64,
    dashes: f64,
}

impl Cost {
    /// One after the other.
    pub(super) fn and(self, other: Cost) -> Cost {
        Cost {
            filled: self.filled + other.filled,
            crossed: self.crossed + other.crossed,
            dashes: self.dashes + other.dashes,
        }
    }

    /// The rule that is broken, if one is.
    pub(super) fn check(&self) -> Result<(), String> {
        let Cost { filled, crossed, dashes } = *self;
        // A NaN, from bounds that overflowed, is over every limit.
        let over = |cost: f64, most: f64| cost.partial_cmp(&most).is_none_or(std::cmp::Ordering::is_gt);
        if over(filled, MOST_FILLED) {
            return Err(format!("fills {filled:.1e} texels, overlaps counted; at most {MOST_FILLED:.1e}"));
        }
        if over(dashes, MOST_DASHES) {
            return Err(format!("strokes {dashes:.1e} dashes; at most {MOST_DASHES:.1e}"));
        }
        if over(crossed, MOST_CROSSED) {
            return Err(format!(
                "crosses rows of texels {crossed:.1e} times with its outlines; at most {MOST_CROSSED:.1e}"
            ));
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
        let layer = group.abs_layer_bounding_box();
        let side = |extent: f32, canvas: f64| (f64::from(extent) * scale + 2.0).min(canvas);
        let texels = side(layer.width(), canvas[0]) * side(layer.height(), canvas[1]);
        // Clips and masks are drawn on layers of their own.
        let others = [group.clip_path().map(|clip| clip.root()), group.mask().map(|mask| mask.root())];
        cost.filled += texels;
        for other in others.into_iter().flatten() {
            cost = cost.and(of_group(other, scale, canvas));
            cost.filled += texels;
        }
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
    let (fills, strokes) = (path.fill().is_some(), path.stroke().is_some());
    // A stroke has two sides, and every corner and dash its ends.
    let outlines = f64::from(u8::from(fills)) + 2.0 * f64::from(u8::from(strokes));
    let corners = path.data().len() as f64 + dashes;
    let crossed = outlines * (steps(path, scale, canvas[1]) + 8.0 * corners);
    let mut cost =
        Cost { filled: area * (f64::from(u8::from(fills)) + f64::from(u8::from(strokes))), crossed, dashes };
    let paints = [path.fill().map(|fill| fill.paint()), path.stroke().map(|stroke| stroke.paint())];
    for paint in paints.into_iter().flatten() {
        if let Paint::Pattern(pattern) = paint {
            cost = cost.and(of_group(pattern.root(), scale, canvas));
        }
    }
    cost
}

/// An upper bound of a path's length.
fn length(path: &Path) -> f64 {
    legs(path).map(|[from, to]| f64::from(to.distance(from))).sum()
}

/// Rows that a path's legs cross, none more than all `rows`.
fn steps(path: &Path, scale: f64, rows: f64) -> f64 {
    let transform = path.abs_transform();
    let row =
        |p: Point| f64::from(transform.ky).mul_add(f64::from(p.x), f64::from(transform.sy) * f64::from(p.y));
    legs(path).map(|[from, to]| ((row(to) - row(from)).abs() * scale).min(rows)).sum()
}

/// The legs of a path's control polygon: curves are no longer, and cross no more, than it.
fn legs(path: &Path) -> impl Iterator<Item = [Point; 2]> {
    let (mut start, mut last) = (Point::zero(), Point::zero());
    path.data().segments().flat_map(move |segment| {
        let points = match segment {
            PathSegment::MoveTo(p) => {
                (start, last) = (p, p);
                vec![]
            }
            PathSegment::LineTo(p) => vec![p],
            PathSegment::QuadTo(a, b) => vec![a, b],
            PathSegment::CubicTo(a, b, c) => vec![a, b, c],
            PathSegment::Close => vec![start],
        };
        let from = last;
        last = points.last().copied().unwrap_or(last);
        let legs: Vec<[Point; 2]> = std::iter::once(from)
            .chain(points.iter().copied())
            .zip(points.iter().copied())
            .map(|(a, b)| [a, b])
            .collect();
        legs
    })
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that fails here says where")]
mod tests {
    use super::*;
    use resvg::usvg::Options;

    /// The cost on 1,000 rows of a zigzag of `lines` between a drawing's top and bottom.
    fn zigzag(lines: usize, paint: &str) -> Cost {
        let corners: String = (0..=lines).map(|k| format!("L{} {}", k % 97, 100 * (k % 2))).collect();
        let svg = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'><path d='M0 0{corners}Z' {paint}/></svg>"
        );
        of_tree(&Tree::from_str(&svg, &Options::default()).unwrap(), 1000)
    }

    /// Each line crosses each row once, and has its corner; a stroke has two sides beside the fill. 67,000,000 or so are too many.
    #[test]
    fn rows_that_outlines_cross_are_counted_and_bounded() {
        for (paint, outlines) in [("", 1.0), ("stroke='#000'", 3.0), ("fill='none' stroke='#000'", 2.0)] {
            let crossed = zigzag(1000, paint).crossed / (1000.0 * 1000.0);
            assert!((crossed / outlines - 1.0).abs() < 0.02, "{crossed} of {outlines}");
        }
        assert!(zigzag(60_000, "").check().is_ok());
        let rule = zigzag(70_000, "").check().unwrap_err();
        assert!(
            rule.contains("crosses rows of texels 7.1e7 times") && rule.ends_with("at most 6.7e7"),
            "{rule}"
        );
        assert!(zigzag(30_000, "stroke='#000'").check().is_err());
    }
}
