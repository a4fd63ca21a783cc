//! How much of each texel a shape covers: areas, not samples.
//!
//! Row by row. What crosses a row falls apart, from left to right, into clusters that share no abscissa; the winding between two is one number over the
//! whole height of the row, for an outline is closed and its
//! level edges count. Within a cluster the row is cut at every vertex and crossing, so that between two cuts edges are
//! straight and in one order, and what lies inside is trapezoids, whose share of each texel is known.

use std::ops::Range;

use resvg::usvg::FillRule;

use super::outline::Edge;

#[cfg(test)]
mod tests;

/// Pieces that a cluster of a row may be cut to for each of its edges; what needs more is sampled at as many heights.
const CUTS: usize = 64;
/// Crossings that a cluster of a row is cut at.
const MOST_CROSSINGS: u32 = 1024;
/// Opacities that are nothing, or all: rounding errors of sums, a tenth of a 16-bit code.
const NOTHING: f64 = 1e-6;

/// A shape by its edges.
pub(super) struct Shape {
    edges: Vec<Edge>,
    rule: FillRule,
    /// Of each row from `first`, where its edges' numbers end in `of_rows`.
    ends: Vec<usize>,
    of_rows: Vec<u32>,
    first: usize,
    /// Columns that it may touch.
    pub columns: Range<usize>,
}

impl Shape {
    /// For a grid of `size` [columns, rows].
    pub(super) fn new(edges: Vec<Edge>, rule: FillRule, size: [usize; 2]) -> Option<Self> {
        let rows = |edge: &Edge| {
            let end = (edge.bottom[1].ceil().max(0.0) as usize).min(size[1]);
            edge.top[1].floor().max(0.0) as usize..end
        };
        let xs = || edges.iter().flat_map(|edge| [edge.top[0], edge.bottom[0]]);
        if !xs().chain(edges.iter().flat_map(|e| [e.top[1], e.bottom[1]])).all(f64::is_finite) {
            return None;
        }
        let column = |x: f64| x.clamp(0.0, size[0] as f64) as usize;
        let columns = column(xs().fold(f64::INFINITY, f64::min).floor())
            ..column(xs().fold(f64::NEG_INFINITY, f64::max).ceil());
        let first = edges.iter().map(|edge| rows(edge).start).min()?;
        let end = edges.iter().map(|edge| rows(edge).end).max()?;
        if columns.is_empty() || first >= end {
            return None;
        }
        let mut starts = vec![0usize; end - first + 1];
        edges.iter().flat_map(&rows).for_each(|row| starts[row - first + 1] += 1);
        for k in 1..starts.len() {
            starts[k] += starts[k - 1];
        }
        let mut of_rows = vec![0u32; starts[end - first]];
        for (number, edge) in (0u32..).zip(&edges) {
            for row in rows(edge) {
                of_rows[starts[row - first]] = number;
                starts[row - first] += 1;
            }
        }
        // Each start has moved to its row's end.
        starts.pop();
        Some(Self { edges, rule, ends: starts, of_rows, first, columns })
    }

    /// Rows that it may touch.
    pub(super) fn rows(&self) -> Range<usize> {
        self.first..self.first + self.ends.len()
    }

    /// What of it lies in a row.
    pub(super) fn crossing(&self, row: usize) -> Crossing<'_> {
        let numbers = match row.checked_sub(self.first).filter(|k| *k < self.ends.len()) {
            Some(k) => &self.of_rows[k.checked_sub(1).map_or(0, |before| self.ends[before])..self.ends[k]],
            None => &[],
        };
        let edges = numbers.iter().map(|number| &self.edges[*number as usize]);
        let mut pieces: Vec<Piece> = edges.map(|edge| Piece::of(edge, row as f64)).collect();
        pieces.sort_unstable_by(|a, b| a.low.total_cmp(&b.low));
        let (mut clusters, mut winding, mut from) = (Vec::new(), 0, 0);
        while let Some(first) = pieces.get(from) {
            let (end, high) = cluster(&pieces[from..]);
            clusters.push(Cluster { pieces: from..from + end, low: first.low, high, winding });
            // The same at all heights, of which there is one.
            let turns = |piece: &Piece| f64::from(piece.edge.winding) * piece.height();
            winding += pieces[from..from + end].iter().map(turns).sum::<f64>().round() as i32;
            from += end;
        }
        Crossing { shape: self, pieces, clusters }
    }

    fn holds(&self, winding: i32) -> bool {
        match self.rule {
            FillRule::NonZero => winding != 0,
            FillRule::EvenOdd => winding % 2 != 0,
        }
    }
}

/// What of a shape lies in a row, from left to right.
pub(super) struct Crossing<'a> {
    shape: &'a Shape,
    pieces: Vec<Piece>,
    clusters: Vec<Cluster>,
}

/// Pieces that share abscissas with each other and with no others.
struct Cluster {
    pieces: Range<usize>,
    low: f64,
    high: f64,
    /// The winding to its left.
    winding: i32,
}

/// The first cluster of sorted pieces: how many they are, and how far they reach.
fn cluster(pieces: &[Piece]) -> (usize, f64) {
    let mut reach = f64::NEG_INFINITY;
    let joins = |piece: &&Piece| {
        let joins = reach == f64::NEG_INFINITY || piece.low <= reach;
        reach = if joins { reach.max(piece.high) } else { reach };
        joins
    };
    (pieces.iter().take_while(joins).count(), reach)
}

/// What one row after the other is worked out on.
#[derive(Default)]
pub(super) struct Desk {
    pieces: Vec<Piece>,
    /// Of each shape, to the left of what is looked at.
    windings: Vec<i32>,
    /// Steps of coverage from texel to texel.
    sums: Vec<f64>,
    shares: Vec<f32>,
}

impl Desk {
    /// The share of each texel of a row's `columns` that shapes cover, all of them together.
    pub(super) fn cover(&mut self, shapes: &[&Crossing], columns: &Range<usize>) -> &[f32] {
        let Self { pieces, windings, sums, shares } = self;
        let [left, right] = [columns.start, columns.end].map(|column| column as f64);
        pieces.clear();
        windings.clear();
        for (number, Crossing { pieces: all, clusters, .. }) in shapes.iter().enumerate() {
            let first = clusters.partition_point(|cluster| cluster.high < left);
            windings.push(clusters.get(first).map_or(0, |cluster| cluster.winding));
            for cluster in clusters[first..].iter().take_while(|cluster| cluster.low < right) {
                pieces.extend(all[cluster.pieces.clone()].iter().map(|piece| piece.seen(number, left)));
            }
        }
        if shapes.len() > 1 {
            pieces.sort_unstable_by(|a, b| a.low.total_cmp(&b.low));
        }
        sums.clear();
        sums.resize(columns.len() + 1, 0.0);
        let mut strips = Strips { shapes, windings, sums, crossings: 0 };
        strips.begin();
        let mut rest = pieces.as_slice();
        while !rest.is_empty() {
            let (joined, others) = rest.split_at(cluster(rest).0);
            strips.cluster(joined);
            rest = others;
        }
        let mut sum = 0.0;
        shares.clear();
        shares.extend(sums[..columns.len()].iter().map(|step| {
            sum += step;
            if sum < NOTHING {
                0.0
            } else if sum > 1.0 - NOTHING {
                1.0
            } else {
                sum as f32
            }
        }));
        shares
    }
}

/// What of an edge lies in a row: heights from the row's top, abscissas from the first column that is looked at.
#[derive(Clone, Copy, Debug)]
struct Piece {
    edge: Edge,
    /// The number of the shape whose edge it is.
    shape: usize,
    low: f64,
    high: f64,
}

impl Piece {
    fn of(edge: &Edge, top: f64) -> Self {
        let seen = |[x, y]: [f64; 2]| [x, y - top];
        let whole = Edge { top: seen(edge.top), bottom: seen(edge.bottom), ..*edge };
        let [y0, y1] = [whole.top[1].max(0.0), whole.bottom[1].min(1.0)];
        let edge = match whole.winding {
            0 => whole,
            _ => Edge { top: [whole.x(y0), y0], bottom: [whole.x(y1), y1], ..whole },
        };
        let [a, b] = [edge.top[0], edge.bottom[0]];
        Self { edge, shape: 0, low: a.min(b), high: a.max(b) }
    }

    /// As a piece of another number, from another column.
    fn seen(&self, shape: usize, left: f64) -> Self {
        let seen = |[x, y]: [f64; 2]| [x - left, y];
        let edge = Edge { top: seen(self.edge.top), bottom: seen(self.edge.bottom), ..self.edge };
        Self { edge, shape, low: self.low - left, high: self.high - left }
    }

    fn height(&self) -> f64 {
        self.edge.bottom[1] - self.edge.top[1]
    }
}

/// An edge between two cuts: its abscissas at both.
#[derive(Clone, Copy)]
struct Side {
    x: [f64; 2],
    winding: i32,
    shape: usize,
}

/// What lies inside of at least one shape, added up strip by strip.
struct Strips<'a> {
    shapes: &'a [&'a Crossing<'a>],
    windings: &'a mut [i32],
    sums: &'a mut [f64],
    /// How many more crossings of the cluster are cut at.
    crossings: u32,
}

impl Strips<'_> {
    /// What is inside from the left on.
    fn begin(&mut self) {
        if self.windings.iter().enumerate().any(|(shape, winding)| self.holds(shape, *winding)) {
            self.sums[0] += 1.0;
        }
    }

    fn holds(&self, shape: usize, winding: i32) -> bool {
        self.shapes[shape].shape.holds(winding)
    }

    /// Adds what lies inside within a cluster, and goes on to its right.
    fn cluster(&mut self, cluster: &[Piece]) {
        if let [Piece { edge, shape, .. }] = cluster {
            // From the row's top to its bottom: most are.
            let side = Side { x: [edge.top[0], edge.bottom[0]], winding: edge.winding, shape: *shape };
            self.walk(cluster[0].height(), &[side]);
            return;
        }
        let mut heights: Vec<f64> =
            cluster.iter().flat_map(|piece| [piece.edge.top[1], piece.edge.bottom[1]]).collect();
        heights.sort_unstable_by(f64::total_cmp);
        heights.dedup();
        let rank = |y: f64| heights.partition_point(|height| *height < y);
        let cuts: usize = cluster.iter().map(|p| rank(p.edge.bottom[1]) - rank(p.edge.top[1])).sum();
        if cuts > CUTS * cluster.len() {
            let [first, last] = [heights[0], heights[heights.len() - 1]];
            heights = (0..=CUTS).map(|k| first + (last - first) * (k as f64 / CUTS as f64)).collect();
        }
        self.crossings = MOST_CROSSINGS;
        let mut waiting: Vec<&Piece> = cluster.iter().collect();
        waiting.sort_unstable_by(|a, b| b.edge.top[1].total_cmp(&a.edge.top[1]));
        let mut active: Vec<&Piece> = Vec::new();
        let mut sides: Vec<Side> = Vec::new();
        let before = self.windings.to_vec();
        for cut in heights.windows(2) {
            let middle = 0.5 * (cut[0] + cut[1]);
            active.retain(|piece| piece.edge.bottom[1] > middle);
            while let Some(piece) = waiting.pop_if(|piece| piece.edge.top[1] <= middle) {
                if piece.edge.bottom[1] > middle {
                    active.push(piece);
                }
            }
            sides.clear();
            sides.extend(active.iter().map(|Piece { edge, shape, .. }| Side {
                x: [edge.x(cut[0]), edge.x(cut[1])],
                winding: edge.winding,
                shape: *shape,
            }));
            self.windings.copy_from_slice(&before);
            self.strip([cut[0], cut[1]], &mut sides);
        }
    }

    /// Adds what lies inside between two heights, cut once more where sides cross.
    fn strip(&mut self, [top, bottom]: [f64; 2], sides: &mut [Side]) {
        sides.sort_unstable_by(|a, b| (a.x[0] + a.x[1]).total_cmp(&(b.x[0] + b.x[1])));
        if self.crossings > 0
            && let Some(share) = crossing(sides)
        {
            self.crossings -= 1;
            let middle = top + (bottom - top) * share;
            let at = |side: &Side| side.x[0] + (side.x[1] - side.x[0]) * share;
            let mut upper: Vec<Side> =
                sides.iter().map(|side| Side { x: [side.x[0], at(side)], ..*side }).collect();
            let before = self.windings.to_vec();
            self.strip([top, middle], &mut upper);
            self.windings.copy_from_slice(&before);
            sides.iter_mut().for_each(|side| side.x[0] = at(side));
            return self.strip([middle, bottom], sides);
        }
        self.walk(bottom - top, sides);
    }

    /// Adds what lies inside of a strip whose sides do not cross, from left to right.
    fn walk(&mut self, height: f64, sides: &[Side]) {
        let mut inside = (0..self.windings.len()).filter(|k| self.holds(*k, self.windings[*k])).count();
        for side in sides {
            let (before, winding) = (inside, self.windings[side.shape]);
            self.windings[side.shape] += side.winding;
            inside += usize::from(self.holds(side.shape, winding + side.winding));
            inside -= usize::from(self.holds(side.shape, winding));
            match (before, inside) {
                (0, 1..) => add(self.sums, side.x, height, 1.0),
                (1.., 0) => add(self.sums, side.x, height, -1.0),
                _ => {}
            }
        }
    }
}

/// Where two neighbours cross, as a share of the height; they are in the order of their middles.
fn crossing(sides: &[Side]) -> Option<f64> {
    const SAME: f64 = 1e-9;
    sides.windows(2).find_map(|pair| {
        let [above, below] = [0, 1].map(|end| pair[1].x[end] - pair[0].x[end]);
        let share = above / (above - below);
        ((above < -SAME || below < -SAME) && share > SAME && share < 1.0 - SAME).then_some(share)
    })
}

/// Adds to the steps what lies to the right of a line, which is `height` high and goes from one abscissa to the other.
fn add(sums: &mut [f64], [a, b]: [f64; 2], height: f64, sign: f64) {
    let end = (sums.len() - 1) as f64;
    let (mut low, mut high, mut height) = (a.min(b), a.max(b), height * sign);
    if height == 0.0 || low >= end {
        return;
    }
    if high <= 0.0 {
        sums[0] += height;
        return;
    }
    let slope = height / (high - low);
    if low < 0.0 {
        sums[0] -= low * slope;
        height += low * slope;
        low = 0.0;
    }
    if high > end {
        height -= (high - end) * slope;
        high = end;
    }
    let (first, last) = (low as usize, high as usize);
    let mut put = |column: usize, height: f64, middle: f64| {
        let right = middle - column as f64;
        sums[column] += height * (1.0 - right);
        sums[column + 1] += height * right;
    };
    if first == last || high - low < 1e-12 {
        put(first, height, 0.5 * (low + high));
        return;
    }
    for column in first..=last {
        let (from, to) = (low.max(column as f64), high.min(column as f64 + 1.0));
        if to > from {
            put(column, slope * (to - from), 0.5 * (from + to));
        }
    }
}
