//! The two loops that see every pixel of a penumbra: table rows combined once per image row, then looked up per column.

use super::plan::Lookup;
use super::table::{Sum, Sums, Table};
use super::window::Windows;
use crate::simd::multiversion;

/// A combined table row: entry `margin + t` is the fixed-point weighted sum over the row's box of all texels left of t.
#[derive(Debug, Default)]
pub struct Combined {
    sums: Vec<u64>,
    strips: Vec<(usize, u32)>,
}

impl Combined {
    /// Combines what windows `columns` of image row `j` need.
    pub fn combine(&mut self, table: &Table, lookup: &Lookup, j: usize, columns: std::ops::Range<usize>) {
        let margin = lookup.x.reach;
        self.sums.resize(table.width + 2 * margin + 2, 0);
        let scale = 2f64.powi(lookup.shift as i32) / lookup.unit;
        let interior = row_weights(&lookup.y, j, table.height, scale, &mut self.strips);
        let [from, to] = lookup.x.touched(columns.clone(), table.width);
        // Entries from..=to; what lies beyond the grid repeats the last.
        let stride = table.width + 1;
        let out = &mut self.sums[margin + from..=margin + to];
        match &table.sums {
            Sums::U32(sums) => combine_u32(sums, stride, from, interior, lookup.shift, &self.strips, out),
            Sums::U64(sums) => combine_u64(sums, stride, from, interior, lookup.shift, &self.strips, out),
        }
        if from == 0 {
            self.sums[..margin].fill(0);
        }
        if to == table.width {
            let last = self.sums[margin + to];
            self.sums[margin + to + 1..].fill(last);
        }
    }

    /// Mean opacities of windows `columns`, from what `combine` left for them, into `out` of the same length.
    pub fn look_up(&self, lookup: &Lookup, columns: std::ops::Range<usize>, out: &mut [f32]) {
        let x = &lookup.x;
        let count = x.start.len();
        assert!(columns.end <= count && columns.len() == out.len(), "columns of the plan");
        let ends = (&x.start[columns.clone()], &x.stop[columns.clone()]);
        let weights = (&x.start_before[columns.start..], &x.stop_before[columns.start..]);
        let sums = &self.sums[..];
        match x.reach {
            1 => look_up::<1>(sums, ends, weights, count, lookup.norm, out),
            2 => look_up::<2>(sums, ends, weights, count, lookup.norm, out),
            3 => look_up::<3>(sums, ends, weights, count, lookup.norm, out),
            4 => look_up::<4>(sums, ends, weights, count, lookup.norm, out),
            reach => look_up_any(sums, reach, ends, weights, count, lookup.norm, out),
        }
    }
}

/// The rows of a box: a range whose weight is one, and single rows with fixed-point weights. Rounding is carried from row to row,
/// so that the weights' sum is right to half a unit.
fn row_weights(
    y: &Windows,
    j: usize,
    height: usize,
    scale: f64,
    strips: &mut Vec<(usize, u32)>,
) -> Option<[usize; 2]> {
    strips.clear();
    let [first, last] = y.touched(j..j + 1, height);
    let (top, bottom) = (i64::from(y.start[j]) + y.reach as i64, i64::from(y.stop[j]));
    let interior = (bottom > top).then(|| [top, bottom].map(|t| t.clamp(0, height as i64) as usize));
    let (mut exact, mut rounded) = (0f64, 0f64);
    let mut row = first;
    while row < last {
        if let Some([from, to]) = interior
            && row == from
            && to > from
        {
            row = to;
            continue;
        }
        exact += y.overlap(j, row as i64) * scale;
        let weight = (exact - rounded).round().clamp(0.0, f64::from(u32::MAX));
        rounded += weight;
        if weight > 0.0 {
            strips.push((row, weight as u32));
        }
        row += 1;
    }
    interior.filter(|[from, to]| to > from)
}

#[inline(always)]
fn combine_generic<S: Sum>(
    sums: &[S],
    stride: usize,
    from: usize,
    interior: Option<[usize; 2]>,
    shift: u32,
    strips: &[(usize, u32)],
    out: &mut [u64],
) {
    let n = out.len();
    let row = |r: usize| &sums[r * stride + from..][..n];
    match interior {
        Some([top, bottom]) => {
            for ((o, a), b) in out.iter_mut().zip(row(top)).zip(row(bottom)) {
                *o = b.minus(*a).wide() << shift;
            }
        }
        None => out.fill(0),
    }
    for (r, weight) in strips {
        let weight = u64::from(*weight);
        for ((o, a), b) in out.iter_mut().zip(row(*r)).zip(row(r + 1)) {
            // One row's prefix is under 2³² for any mask, so 32 × 32 bits are enough.
            *o = o.wrapping_add((b.minus(*a).wide() & 0xffff_ffff) * weight);
        }
    }
}

multiversion! {
    fn combine_u32(sums: &[u32], stride: usize, from: usize, interior: Option<[usize; 2]>, shift: u32, strips: &[(usize, u32)], out: &mut [u64]) = combine_generic;
}
multiversion! {
    fn combine_u64(sums: &[u64], stride: usize, from: usize, interior: Option<[usize; 2]>, shift: u32, strips: &[(usize, u32)], out: &mut [u64]) = combine_generic;
}

#[inline(always)]
fn look_up_generic<const K: usize>(
    sums: &[u64],
    (start, stop): (&[i32], &[i32]),
    (start_before, stop_before): (&[f64], &[f64]),
    count: usize,
    norm: f64,
    out: &mut [f32],
) {
    let n = out.len();
    let (start, stop) = (&start[..n], &stop[..n]);
    let starts: [&[f64]; K] = std::array::from_fn(|k| &start_before[k * count..][..n]);
    let stops: [&[f64]; K] = std::array::from_fn(|k| &stop_before[k * count..][..n]);
    for i in 0..n {
        let (a, b) = ((start[i] + K as i32) as usize, (stop[i] + K as i32) as usize);
        debug_assert!(a + K < sums.len() && b + K < sums.len());
        // SAFETY: `Windows` clamps both ends to [−K, width], and sums holds width + 2K + 2 entries from −K on.
        let at = |i: usize| unsafe { *sums.get_unchecked(i) };
        let mut sum = at(b).wrapping_sub(at(a)) as f64;
        for k in 0..K {
            sum += stops[k][i] * at(b + k + 1).wrapping_sub(at(b + k)) as f64;
            sum -= starts[k][i] * at(a + k + 1).wrapping_sub(at(a + k)) as f64;
        }
        out[i] = ((sum * norm) as f32).clamp(0.0, 1.0);
    }
}

multiversion! {
    fn look_up<const K: usize>(sums: &[u64], ends: (&[i32], &[i32]), weights: (&[f64], &[f64]), count: usize, norm: f64, out: &mut [f32]) = look_up_generic::<K>;
}

/// Pixels that cover many texels.
fn look_up_any(
    sums: &[u64],
    reach: usize,
    (start, stop): (&[i32], &[i32]),
    (start_before, stop_before): (&[f64], &[f64]),
    count: usize,
    norm: f64,
    out: &mut [f32],
) {
    for (i, out) in out.iter_mut().enumerate() {
        let (a, b) = ((start[i] + reach as i32) as usize, (stop[i] + reach as i32) as usize);
        let mut sum = sums[b].wrapping_sub(sums[a]) as f64;
        for k in 0..reach {
            sum += stop_before[k * count + i] * sums[b + k + 1].wrapping_sub(sums[b + k]) as f64;
            sum -= start_before[k * count + i] * sums[a + k + 1].wrapping_sub(sums[a + k]) as f64;
        }
        *out = ((sum * norm) as f32).clamp(0.0, 1.0);
    }
}
