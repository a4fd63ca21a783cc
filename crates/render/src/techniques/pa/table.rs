//! Summed-area tables of opacity codes.

use kelir_scene::{Mask, Texels};
use rayon::prelude::*;

use crate::simd::multiversion;

/// Prefix sums of one channel's opacity codes (`max_code − code`): entry (x, y) is the sum over texels left of x and above y.
///
/// `u32` sums may wrap: every *difference* over a box whose own sum is under 2³² is still exact.
#[derive(Debug)]
pub struct Table {
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
pub enum Sums {
    /// Exact while a box holds less than 2³².
    U32(Vec<u32>),
    /// Exact for any mask.
    U64(Vec<u64>),
}

/// A table entry: wraps like the machine's integers.
pub trait Sum: Copy + Default + Send + Sync + 'static {
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
    pub fn new(mask: &Mask, c: usize, wide: bool, spare: Option<Table>) -> Self {
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
    pub fn sum(&self, x: [usize; 2], y: [usize; 2]) -> u64 {
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

/// Texels are prefixed eight at a time so that the running sum is not one long chain of additions.
#[inline(always)]
fn row<C: Code, S: Sum>(texels: &[C], above: &[S], out: &mut [S]) {
    let n = texels.len();
    let (above, out_all) = (&above[..n + 1], &mut out[..n + 1]);
    out_all[0] = S::default();
    let (above, out) = (&above[1..], &mut out_all[1..]);
    let mut running = 0u32;
    let whole = n - n % 16;
    for ((texels, above), out) in
        texels[..whole].chunks_exact(16).zip(above.chunks_exact(16)).zip(out.chunks_exact_mut(16))
    {
        let mut p = [0u32; 16];
        for (p, t) in p.iter_mut().zip(texels) {
            *p = t.opacity();
        }
        for step in [1, 2, 4, 8] {
            let before = p;
            for i in step..16 {
                p[i] = before[i] + before[i - step];
            }
        }
        for i in 0..16 {
            out[i] = above[i].plus(S::of(p[i].wrapping_add(running)));
        }
        running += p[15];
    }
    for i in whole..n {
        running += texels[i].opacity();
        out[i] = above[i].plus(S::of(running));
    }
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
loops!(u8, columns_u8; u32, row_u8_u32; u64, row_u8_u64);
loops!(u16, columns_u16; u32, row_u16_u32; u64, row_u16_u64);
