//! Where a mask varies: what a pixel can see of it is constant, or it is not, known without sampling.

use kelir_scene::{Mask, Texels};

/// A mask with a border of one clear texel (whatever is outside the grid lets all light through), and a
/// summed-area table of its changes.
pub(crate) struct Padded {
    /// Texels a padded row.
    pub stride: usize,
    /// Padded rows.
    pub rows: usize,
    /// 1 or 3.
    pub channels: usize,
    /// The largest code.
    pub max_code: u32,
    /// What a code counts: the power of two above which there is none, so that products over many planes stay below 1 and are rounded as
    /// products of codes would be.
    pub unit: f32,
    /// `channels` planes of `stride * rows` codes.
    pub codes: Vec<u16>,
    /// `(stride + 1) * (rows + 1)` sums of [a texel differs from its left or upper neighbour], wrapping.
    changes: Vec<u32>,
}

/// Texels `first..=last` of one axis in padded coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Range {
    /// First texel.
    pub first: u32,
    /// Last texel.
    pub last: u32,
}

impl Padded {
    /// Pads `mask` and counts its changes.
    pub(crate) fn new(mask: &Mask) -> Self {
        let (w, h) = (mask.width, mask.height);
        let (stride, rows) = (w + 2, h + 2);
        let max_code = mask.max_code();
        let mut codes = vec![max_code as u16; stride * rows * mask.channels];
        for c in 0..mask.channels {
            for y in 0..h {
                let to = &mut codes[(c * rows + y + 1) * stride + 1..][..w];
                let from = (c * h + y) * w;
                match &mask.texels {
                    Texels::U8(t) => {
                        to.iter_mut().zip(&t[from..from + w]).for_each(|(a, &b)| *a = u16::from(b))
                    }
                    Texels::U16(t) => to.copy_from_slice(&t[from..from + w]),
                }
            }
        }
        let unit = 1.0 / (max_code + 1) as f32;
        let mut padded =
            Self { stride, rows, channels: mask.channels, max_code, unit, codes, changes: Vec::new() };
        padded.changes = padded.count_changes();
        padded
    }

    fn count_changes(&self) -> Vec<u32> {
        let mut table = vec![0u32; (self.stride + 1) * (self.rows + 1)];
        let planes: Vec<_> = self.codes.chunks_exact(self.stride * self.rows).collect();
        for y in 1..self.rows {
            let (above, row) = table[y * (self.stride + 1)..].split_at_mut(self.stride + 1);
            let mut sum = 0u32;
            for x in 1..self.stride {
                let at = y * self.stride + x;
                let differs = planes.iter().any(|p| p[at] != p[at - 1] || p[at] != p[at - self.stride]);
                sum += u32::from(differs);
                row[x + 1] = above[x + 1].wrapping_add(sum);
            }
            row[1] = above[1];
        }
        table
    }

    /// Whether all texels of the box are equal in every channel; may say no of a constant box whose left or upper
    /// neighbour differs, never yes of one that varies.
    #[inline]
    pub(crate) fn is_constant(&self, x: Range, y: Range) -> bool {
        let line = self.stride + 1;
        let (top, bottom) = (y.first as usize * line, (y.last as usize + 1) * line);
        let (left, right) = (x.first as usize, x.last as usize + 1);
        let t = &self.changes;
        t[bottom + right].wrapping_sub(t[bottom + left]) == t[top + right].wrapping_sub(t[top + left])
    }

    /// The code of channel `c` (grey masks answer for all) at a padded texel.
    #[inline]
    pub(crate) fn code(&self, c: usize, x: u32, y: u32) -> u16 {
        self.codes[((c % self.channels) * self.rows + y as usize) * self.stride + x as usize]
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]
        /// Against looking at every texel: a box called constant is, and one that varies is never called constant;
        /// a box that is constant together with its left and upper neighbours is always recognised.
        #[test]
        fn constant_means_constant(
            texels in proptest::collection::vec(0u8..2, 3 * 5 * 4),
            x0 in 0u32..7, x1 in 0u32..7, y0 in 0u32..6, y1 in 0u32..6,
        ) {
            let padded = Padded::new(&Mask::new(5, 4, 3, Texels::U8(texels)));
            let (x, y) = (Range { first: x0.min(x1), last: x0.max(x1) }, Range { first: y0.min(y1), last: y0.max(y1) });
            let equal = |x: Range, y: Range| (0..3).all(|c| (y.first..=y.last).all(|j| (x.first..=x.last)
                .all(|i| padded.code(c, i, j) == padded.code(c, x.first, y.first))));
            let said = padded.is_constant(x, y);
            prop_assert!(!said || equal(x, y));
            let wider = (Range { first: x.first.saturating_sub(1), ..x }, Range { first: y.first.saturating_sub(1), ..y });
            prop_assert!(said || !equal(wider.0, wider.1));
        }
    }

    #[test]
    fn outside_is_clear() {
        let padded = Padded::new(&Mask::new(1, 1, 1, Texels::U16(vec![9])));
        assert_eq!(padded.code(2, 0, 0), u16::MAX);
        assert_eq!(padded.code(2, 1, 1), 9);
        let (all, first) = (Range { first: 0, last: 2 }, Range { first: 0, last: 0 });
        assert!(!padded.is_constant(all, all));
        assert!(padded.is_constant(all, first));
    }
}
