//! The two loops that see every pixel of a penumbra: table rows combined once per image row, then looked up per column.

use kelir_frame::{Isa, multiversion};

use super::plan::Lookup;
use super::table::{Sum, Sums, Table};
use crate::project::window::Windows;

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;

/// Entries behind the last that a vector load may touch.
const SPARE: usize = 32;

/// A combined table row: entry `margin + t` is the fixed-point weighted sum over the row's box of all texels left of t.
#[derive(Debug, Default)]
pub(crate) struct Combined {
    sums: Vec<u64>,
    /// What each entry adds to the one before it, as [`look_up`] weighs it: converted once a texel, not once a window.
    steps: Vec<f64>,
    strips: Vec<(usize, u32)>,
}

impl Combined {
    /// Combines what windows `columns` of image row `j` need.
    pub(crate) fn combine(
        &mut self,
        table: &Table,
        lookup: &Lookup,
        j: usize,
        columns: std::ops::Range<usize>,
    ) {
        let margin = lookup.x.reach;
        // The vector loops read whole registers from any entry on.
        self.sums.resize(table.width + 2 * margin + 2 + SPARE, 0);
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
        self.steps.resize(self.sums.len(), 0.0);
        let first = (lookup.x.start[columns.start] + margin as i32) as usize;
        let last = (lookup.x.stop[columns.end - 1] + 2 * margin as i32) as usize;
        steps(&self.sums[first..=last + 1], &mut self.steps[first..=last]);
    }

    /// Mean transmittances (1 − opacity) of windows `columns`, from what `combine` left for them, into `out` of the same length.
    pub(crate) fn look_up(&self, lookup: &Lookup, columns: std::ops::Range<usize>, out: &mut [f32]) {
        let x = &lookup.x;
        let count = x.start.len();
        assert!(columns.end <= count && columns.len() == out.len(), "columns of the plan");
        let ends = (&x.start[columns.clone()], &x.stop[columns.clone()]);
        let weights = (&x.start_before[columns.start..], &x.stop_before[columns.start..]);
        let sums = (&self.sums[..], &self.steps[..]);
        match x.reach {
            1 => look_up::<1>(sums, ends, weights, count, lookup.norm, x.spans, out),
            2 => look_up::<2>(sums, ends, weights, count, lookup.norm, x.spans, out),
            3 => look_up::<3>(sums, ends, weights, count, lookup.norm, x.spans, out),
            4 => look_up::<4>(sums, ends, weights, count, lookup.norm, x.spans, out),
            reach => look_up_any(sums.0, reach, ends, weights, count, lookup.norm, out),
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

/// Texels that are combined at a time, so that sums stay in registers from the first strip to the last.
const BLOCK: usize = 32;

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
    let whole = out.len() - out.len() % BLOCK;
    let (blocks, rest) = out.split_at_mut(whole);
    for (k, block) in blocks.chunks_exact_mut(BLOCK).enumerate() {
        let mut acc = [0u64; BLOCK];
        combine_block(sums, stride, from + k * BLOCK, interior, shift, strips, &mut acc);
        block.copy_from_slice(&acc);
    }
    combine_block(sums, stride, from + whole, interior, shift, strips, rest);
}

#[inline(always)]
fn combine_block<S: Sum>(
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
fn steps_generic(sums: &[u64], steps: &mut [f64]) {
    for (step, pair) in steps.iter_mut().zip(sums.windows(2)) {
        *step = pair[1].wrapping_sub(pair[0]) as f64;
    }
}
multiversion! { fn steps(sums: &[u64], steps: &mut [f64]) = steps_generic; }

#[inline(always)]
fn look_up_generic<const K: usize>(
    (sums, steps): (&[u64], &[f64]),
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
        debug_assert!(a + K < steps.len() && b + K < steps.len());
        // SAFETY: `Windows` clamps both ends to [−K, width]; sums and steps hold width + 2K + 2 entries from −K on.
        let (at, step) =
            (|i: usize| unsafe { *sums.get_unchecked(i) }, |i: usize| unsafe { *steps.get_unchecked(i) });
        let mut sum = at(b).wrapping_sub(at(a)) as f64;
        for k in 0..K {
            sum += stops[k][i] * step(b + k);
            sum -= starts[k][i] * step(a + k);
        }
        out[i] = (1.0 - (sum * norm) as f32).clamp(0.0, 1.0);
    }
}

/// What the vector loops rely on, which load without a check: for the first `whole` columns, `loaded` entries of a row of `entries` from each
/// end on, and the K weights of each.
///
/// # Panics
/// Where a load would leave its slice.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
fn loads_stay_within<const K: usize>(
    whole: usize,
    (start, stop): (&[i32], &[i32]),
    (entries, loaded): (usize, usize),
    (start_before, stop_before): (&[f64], &[f64]),
    count: usize,
) {
    if whole == 0 {
        return;
    }
    // Ends grow from column to column and start at −K.
    let last = start[whole - 1].max(stop[whole - 1]) + 2 * K as i32;
    assert!(start[0] >= -(K as i32) && stop[0] >= -(K as i32) && last as usize + loaded <= entries);
    let planes = (K - 1) * count + whole;
    assert!(planes <= start_before.len() && planes <= stop_before.len());
}

/// [`look_up_generic`] on the best instruction set. Where neighbouring ends lie near each other (`spans`: pixels of less than two texels
/// with AVX-512, of one with AVX2), a permutation stands for a gather; the arithmetic is the same to the bit.
fn look_up<const K: usize>(
    sums: (&[u64], &[f64]),
    ends: (&[i32], &[i32]),
    weights: (&[f64], &[f64]),
    count: usize,
    norm: f64,
    spans: [i32; 2],
    out: &mut [f32],
) {
    #[cfg(target_arch = "x86_64")]
    {
        match Isa::detect() {
            // SAFETY: detected on this machine.
            Isa::Avx512 if spans[1] < 16 => {
                return unsafe { avx512::near::<K>(sums, ends, weights, count, norm, out) };
            }
            // SAFETY: detected on this machine.
            Isa::Avx512 => return unsafe { avx512::far::<K>(sums, ends, weights, count, norm, out) },
            // SAFETY: detected on this machine.
            Isa::Avx2 if spans[0] < 4 => {
                return unsafe { avx2::near::<K>(sums, ends, weights, count, norm, out) };
            }
            // SAFETY: detected on this machine.
            Isa::Avx2 => return unsafe { look_up_avx2::<K>(sums, ends, weights, count, norm, out) },
            Isa::Baseline => {}
        }
    }
    look_up_generic::<K>(sums, ends, weights, count, norm, out);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn look_up_avx2<const K: usize>(
    sums: (&[u64], &[f64]),
    ends: (&[i32], &[i32]),
    weights: (&[f64], &[f64]),
    count: usize,
    norm: f64,
    out: &mut [f32],
) {
    look_up_generic::<K>(sums, ends, weights, count, norm, out);
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
        *out = (1.0 - (sum * norm) as f32).clamp(0.0, 1.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What looks up without checks reads what the checked loop reads, on every instruction set, for windows that hang over both ends.
    #[test]
    fn unchecked_look_ups_are_the_checked_ones() {
        for (reach, pixel, step) in [
            (1, 0.0, 0.7),
            (2, 0.95, 0.95),
            (3, 1.2, 0.8),
            (2, 0.8, 1.3),
            (3, 1.9, 2.1),
            (4, 2.7, 9.5),
            (2, 0.4, 40.0),
        ] {
            let (count, size) = (203, 97);
            let x = Windows::new(count, |i| (i as f64 - 60.0) * step + 3.3, 5.7, size, pixel);
            assert_eq!(x.reach, reach);
            let entry = |k: usize| (k as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 22;
            let sums: Vec<u64> = (0..size + 2 * reach + 2 + SPARE)
                .scan(0, |sum, k| {
                    *sum += entry(k);
                    Some(*sum)
                })
                .collect();
            let (ends, weights) = ((&x.start[..], &x.stop[..]), (&x.start_before[..], &x.stop_before[..]));
            let mut steps_of = vec![0.0; sums.len() - 1];
            steps(&sums, &mut steps_of);
            let norm = 1.0 / sums[sums.len() - 1] as f64;
            let mut checked = vec![0f32; count];
            look_up_any(&sums, reach, ends, weights, count, norm, &mut checked);
            assert!(checked.iter().any(|v| *v > 0.0 && *v < 1.0), "nothing is looked up");
            for isa in Isa::all() {
                let mut out = vec![0f32; count];
                isa.with(|| match reach {
                    1 => look_up::<1>((&sums, &steps_of), ends, weights, count, norm, x.spans, &mut out),
                    2 => look_up::<2>((&sums, &steps_of), ends, weights, count, norm, x.spans, &mut out),
                    3 => look_up::<3>((&sums, &steps_of), ends, weights, count, norm, x.spans, &mut out),
                    _ => look_up::<4>((&sums, &steps_of), ends, weights, count, norm, x.spans, &mut out),
                });
                assert_eq!(out, checked, "{} texels a pixel, {}", pixel, isa.name());
            }
            // The negative control: windows one texel further see other sums.
            let mut shifted = vec![0f32; count];
            look_up_any(&sums[1..], reach, ends, weights, count, norm, &mut shifted);
            assert_ne!(shifted, checked);
        }
    }
}
