//! Summed-area tables of opacity codes.

use kelir_frame::{Isa, multiversion};
use kelir_scene::{Mask, Texels};
use rayon::prelude::*;

/// Prefix sums of one channel's opacity codes (`max_code − code`): entry (x, y) is the sum over texels left of x and above y.
///
/// `u32` sums may wrap: every *difference* over a box whose own sum is under 2³² is still exact.
#[derive(Debug)]
pub(crate) struct Table {
    /// Texels a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// The code of full opacity: 255 or 65535.
    pub max_code: u32,
    /// `(width + 1) * (height + 1)` sums, row-major; the first row and column are zero.
    pub sums: Sums,
}

/// Storage, chosen by the largest box.
#[derive(Debug)]
pub(crate) enum Sums {
    /// Exact while a box holds less than 2³².
    U32(Vec<u32>),
    /// Exact for any mask.
    U64(Vec<u64>),
}

/// A table entry: wraps like the machine's integers.
pub(crate) trait Sum: Copy + Default + Send + Sync + 'static {
    /// `self + other`, wrapping.
    fn plus(self, other: Self) -> Self;
    /// `self − other`, wrapping.
    fn minus(self, other: Self) -> Self;
    /// From a texel code.
    fn of(code: u32) -> Self;
    /// Widened.
    fn wide(self) -> u64;
}

macro_rules! sum {
    ($t:ty) => {
        impl Sum for $t {
            #[inline(always)]
            fn plus(self, other: Self) -> Self {
                self.wrapping_add(other)
            }
            #[inline(always)]
            fn minus(self, other: Self) -> Self {
                self.wrapping_sub(other)
            }
            #[inline(always)]
            fn of(code: u32) -> Self {
                code as $t
            }
            #[inline(always)]
            fn wide(self) -> u64 {
                self as u64
            }
        }
    };
}
sum!(u32);
sum!(u64);

/// A texel code.
trait Code: Copy + Send + Sync {
    /// `max − code`.
    fn opacity(self) -> u32;
}
impl Code for u8 {
    #[inline(always)]
    fn opacity(self) -> u32 {
        u32::from(!self)
    }
}
impl Code for u16 {
    #[inline(always)]
    fn opacity(self) -> u32 {
        u32::from(!self)
    }
}

impl Table {
    /// The table of channel `c` of `mask`; `wide` asks for u64 sums. `spare` is an old table whose memory may be reused.
    pub(crate) fn new(mask: &Mask, c: usize, wide: bool, spare: Option<Table>) -> Self {
        let (w, h) = (mask.width, mask.height);
        let channel = (c % mask.channels) * w * h;
        let len = (w + 1) * (h + 1);
        let sums = if wide {
            let mut sums = match spare {
                Some(Table { sums: Sums::U64(old), .. }) => old,
                _ => Vec::new(),
            };
            sums.resize(len, 0);
            match &mask.texels {
                Texels::U8(t) => fill(&t[channel..channel + w * h], w, &mut sums),
                Texels::U16(t) => fill(&t[channel..channel + w * h], w, &mut sums),
            }
            Sums::U64(sums)
        } else {
            let mut sums = match spare {
                Some(Table { sums: Sums::U32(old), .. }) => old,
                _ => Vec::new(),
            };
            sums.resize(len, 0);
            match &mask.texels {
                Texels::U8(t) => fill(&t[channel..channel + w * h], w, &mut sums),
                Texels::U16(t) => fill(&t[channel..channel + w * h], w, &mut sums),
            }
            Sums::U32(sums)
        };
        Self { width: w, height: h, max_code: mask.max_code(), sums }
    }

    /// Sum of the codes over columns `x` and rows `y` (texel index ranges inside the grid), modulo 2³² for u32 tables.
    pub(crate) fn sum(&self, x: [usize; 2], y: [usize; 2]) -> u64 {
        let at = |x: usize, y: usize| y * (self.width + 1) + x;
        match &self.sums {
            Sums::U32(s) => u64::from(
                s[at(x[1], y[1])]
                    .wrapping_sub(s[at(x[0], y[1])])
                    .wrapping_sub(s[at(x[1], y[0])])
                    .wrapping_add(s[at(x[0], y[0])]),
            ),
            Sums::U64(s) => s[at(x[1], y[1])]
                .wrapping_sub(s[at(x[0], y[1])])
                .wrapping_sub(s[at(x[1], y[0])])
                .wrapping_add(s[at(x[0], y[0])]),
        }
    }
}

/// Bands of rows are summed at once: column totals of each band first (they only read), so that each band can start
/// from the true sums above it and every entry is written once.
fn fill<C: Code + Columns, S: Sum + AddRow<C>>(texels: &[C], w: usize, sums: &mut [S]) {
    let h = texels.len() / w;
    let stride = w + 1;
    let bands = if w * h < 1 << 14 { 1 } else { rayon::current_num_threads().min(h).max(1) };
    let rows = h.div_ceil(bands);
    sums[..stride].fill(S::default());
    let totals: Vec<Vec<u32>> = texels
        .par_chunks(rows * w)
        .take(bands - 1)
        .map(|band| {
            let mut totals = vec![0u32; w];
            band.chunks_exact(w).for_each(|row| C::add_columns(row, &mut totals));
            totals
        })
        .collect();
    let mut starts = vec![vec![S::default(); stride]];
    for band in totals {
        let mut next = starts[starts.len() - 1].clone();
        let mut running = S::default();
        for (entry, total) in next[1..].iter_mut().zip(band) {
            running = running.plus(S::of(total));
            *entry = entry.plus(running);
        }
        starts.push(next);
    }
    sums[stride..].par_chunks_mut(rows * stride).zip(texels.par_chunks(rows * w)).zip(starts).for_each(
        |((out, band), start)| {
            let mut above: &[S] = &start;
            for (row, texels) in out.chunks_exact_mut(stride).zip(band.chunks_exact(w)) {
                S::add_row(texels, above, row);
                above = row;
            }
        },
    );
}

trait Columns: Code {
    fn add_columns(row: &[Self], totals: &mut [u32])
    where
        Self: Sized;
}

trait AddRow<C>: Sized {
    fn add_row(texels: &[C], above: &[Self], out: &mut [Self]);
}

#[inline(always)]
fn columns<C: Code>(row: &[C], totals: &mut [u32]) {
    for (total, code) in totals.iter_mut().zip(row) {
        *total += code.opacity();
    }
}

#[inline(always)]
fn row<C: Code, S: Sum>(texels: &[C], above: &[S], out: &mut [S]) {
    let n = texels.len();
    let (above, out) = (&above[..n + 1], &mut out[..n + 1]);
    out[0] = S::default();
    row_from(texels, &above[1..], 0, &mut out[1..]);
}

#[inline(always)]
fn row_from<C: Code, S: Sum>(texels: &[C], above: &[S], before: u32, out: &mut [S]) {
    let mut running = before;
    for ((out, above), texel) in out.iter_mut().zip(above).zip(texels) {
        running = running.wrapping_add(texel.opacity());
        *out = above.plus(S::of(running));
    }
}

/// The commonest row, sixteen texels at a time: prefix sums by four shifted additions, then the sum so far and the row above.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi")]
fn row_avx512(texels: &[u8], above: &[u32], out: &mut [u32]) {
    use std::arch::x86_64::*;
    let n = texels.len();
    assert!(above.len() > n && out.len() > n);
    out[0] = 0;
    let whole = n - n % 16;
    let (zero, last, ones) = (_mm512_setzero_si512(), _mm512_set1_epi32(15), _mm_set1_epi8(-1));
    let mut running = zero;
    for at in (0..whole).step_by(16) {
        // SAFETY: at + 16 ≤ n, and both rows hold n + 1 sums.
        unsafe {
            let codes = _mm_xor_si128(_mm_loadu_si128(texels.as_ptr().add(at).cast()), ones);
            let mut p = _mm512_cvtepu8_epi32(codes);
            p = _mm512_add_epi32(p, _mm512_alignr_epi32::<15>(p, zero));
            p = _mm512_add_epi32(p, _mm512_alignr_epi32::<14>(p, zero));
            p = _mm512_add_epi32(p, _mm512_alignr_epi32::<12>(p, zero));
            p = _mm512_add_epi32(p, _mm512_alignr_epi32::<8>(p, zero));
            let sum = _mm512_add_epi32(p, running);
            let over = _mm512_loadu_si512(above.as_ptr().add(at + 1).cast());
            _mm512_storeu_si512(out.as_mut_ptr().add(at + 1).cast(), _mm512_add_epi32(sum, over));
            running = _mm512_add_epi32(running, _mm512_permutexvar_epi32(last, p));
        }
    }
    let before = _mm512_cvtsi512_si32(running) as u32;
    row_from(&texels[whole..], &above[whole + 1..], before, &mut out[whole + 1..]);
}

macro_rules! loops {
    ($code:ty, $columns:ident; $($sum:ty, $row:ident);*) => {
        multiversion! { fn $columns(line: &[$code], totals: &mut [u32]) = columns::<$code>; }
        impl Columns for $code {
            fn add_columns(line: &[Self], totals: &mut [u32]) {
                $columns(line, totals);
            }
        }
        $(
            multiversion! { fn $row(texels: &[$code], above: &[$sum], out: &mut [$sum]) = row::<$code, $sum>; }
            impl AddRow<$code> for $sum {
                fn add_row(texels: &[$code], above: &[Self], out: &mut [Self]) {
                    $row(texels, above, out);
                }
            }
        )*
    };
}
loops!(u8, columns_u8; u64, row_u8_u64);
loops!(u16, columns_u16; u32, row_u16_u32; u64, row_u16_u64);

multiversion! { fn row_u8_u32(texels: &[u8], above: &[u32], out: &mut [u32]) = row::<u8, u32>; }
impl AddRow<u8> for u32 {
    fn add_row(texels: &[u8], above: &[Self], out: &mut [Self]) {
        #[cfg(target_arch = "x86_64")]
        if Isa::detect() == Isa::Avx512 {
            // SAFETY: detected on this machine.
            return unsafe { row_avx512(texels, above, out) };
        }
        row_u8_u32(texels, above, out);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every box of a small mask, and random boxes of a large one, against plain sums.
    #[test]
    fn boxes_hold_what_they_hold() {
        for (w, h, channels) in [(1, 1, 1), (7, 5, 1), (33, 18, 3), (400, 301, 1)] {
            let code = |k: usize| (k.wrapping_mul(2_654_435_761) >> 11) as u16;
            let len = w * h * channels;
            let eight = Mask::new(w, h, channels, Texels::U8((0..len).map(|k| code(k) as u8).collect()));
            let sixteen = Mask::new(w, h, channels, Texels::U16((0..len).map(code).collect()));
            for (mask, wide) in [(&eight, false), (&eight, true), (&sixteen, false), (&sixteen, true)] {
                for c in 0..channels {
                    let table = Table::new(mask, c, wide, None);
                    let opacity = |x, y| {
                        (f64::from(mask.max_code()) * (1.0 - mask.transmittance(c, x, y))).round() as u64
                    };
                    for k in 0..50 {
                        let (x0, y0) = (code(k) as usize % w, code(k + 99) as usize % h);
                        let x = [x0, x0 + 1 + code(k + 7) as usize % (w - x0)];
                        let y = [y0, y0 + 1 + code(k + 3) as usize % (h - y0)];
                        let plain: u64 = (y[0]..y[1])
                            .flat_map(|y| (x[0]..x[1]).map(move |x| (x, y)))
                            .map(|(x, y)| opacity(x, y))
                            .sum();
                        let expected = if wide { plain } else { plain & 0xffff_ffff };
                        assert_eq!(table.sum(x, y), expected, "{w}x{h} {x:?} {y:?} wide {wide}");
                    }
                }
            }
        }
    }

    /// A row by vectors is a row by single texels, whatever is left over of whole vectors.
    #[test]
    fn rows_are_the_same_on_every_instruction_set() {
        for n in [1, 15, 16, 17, 31, 32, 100] {
            let texels: Vec<u8> =
                (0..n).map(|k: usize| (k.wrapping_mul(2_654_435_761) >> 11) as u8).collect();
            let above: Vec<u32> = (0..=n as u32).map(|k| k.wrapping_mul(0x9e37_79b9)).collect();
            let mut plain = vec![0; n + 1];
            row(&texels, &above, &mut plain);
            for isa in Isa::all() {
                let mut out = vec![1; n + 1];
                isa.with(|| u32::add_row(&texels, &above, &mut out));
                assert_eq!(out, plain, "{n} texels on {}", isa.name());
            }
        }
    }

    /// A table whose entries wrap still knows every box under 2³².
    #[test]
    fn wrap_around_cancels() {
        let (w, h) = (4200, 4200);
        let mask = Mask::new(w, h, 1, Texels::U8(vec![0; w * h]));
        let table = Table::new(&mask, 0, false, None);
        let Sums::U32(sums) = &table.sums else { panic!("u32 asked for") };
        let last = sums[sums.len() - 1];
        assert!(u64::from(last) != (w * h * 255) as u64, "no wrap-around, nothing tested");
        assert_eq!(table.sum([4000, 4200], [3900, 4200]), 200 * 300 * 255);
        assert_eq!(table.sum([0, 4100], [0, 4100]), 4100 * 4100 * 255);
        // The negative control: beyond 2³² the box is wrong.
        assert_ne!(table.sum([0, w], [0, h]), (w * h * 255) as u64);
    }
}
