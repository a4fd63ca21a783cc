//! One axis of the map to a plane's texels, and how far a pixel reaches along it.

use kelir_frame::{Pixel, View};
use kelir_scene::Screen;

use super::bounds::Range;

/// One axis (x or y) of the map to one plane's texels, for one column or row of pixels, or one pixel.
///
/// Texel = anchor + floor(offset + …) with a sum that is zero at the middle of source and pixel. The anchor is the grid
/// line nearest the box's centre, so that the offset is small wherever the result matters and f32 resolves even a box of
/// 1e-6 texels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Axis {
    /// The box's centre relative to the anchor, texels.
    pub offset: f32,
    /// Smallest value of the sum before the floor: the clear texel before the grid.
    pub low: f32,
    /// Largest value of the sum before the floor: the clear texel behind the grid.
    pub high: f32,
    /// The anchor in padded texels.
    pub anchor: i32,
    /// Every padded texel that a sample can fall on.
    pub range: Range,
}

impl Axis {
    /// The axis of a box `from..to` around `centre` (texels) on a grid of `texels`.
    pub(crate) fn new(centre: f64, from: f64, to: f64, texels: usize) -> Self {
        let anchor = centre.round().clamp(0.0, texels as f64);
        let offset = centre - anchor;
        // What f32 may add to the sum: a few roundings of its largest term.
        let slack = 1e-6 * (offset.abs() + (to - centre).abs().max((centre - from).abs()));
        // An infinite box is the whole grid; a NaN can only come from one.
        let padded = |t: f64, otherwise: f64| {
            let t = if t.is_nan() { otherwise } else { t };
            t.floor().clamp(-1.0, texels as f64) as i32 + 1
        };
        Self {
            offset: offset as f32,
            low: (-1.0 - anchor) as f32,
            high: (texels as f64 - anchor) as f32,
            anchor: anchor as i32 + 1,
            range: Range {
                first: padded(from - slack, f64::NEG_INFINITY) as u32,
                last: padded(to + slack, f64::INFINITY) as u32,
            },
        }
    }

    /// The anchor's place in texels.
    pub(crate) fn line(&self) -> f64 {
        f64::from(self.anchor - 1)
    }
}

/// Places of one axis of one plane as whole numbers, relative to its anchor, whose sum's texel is a shift to the right.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fixed {
    /// Units a texel, a power of two.
    scale: f64,
    /// Beyond it a box's middle is as good as there.
    most: f64,
    /// The texel is the sum shifted by so many bits.
    pub shift: u32,
}

impl Fixed {
    /// For boxes of `half` texels to either side.
    pub(crate) fn new(half: f64) -> Self {
        let half = half.max(1e-12);
        // Outside the grid two texels are as far as any; a box smaller than a texel splits at its anchor or nowhere.
        let most = if half < 0.25 { 2.0 * half } else { half + 2.0 };
        let bits = (f64::from(1 << 30) / (most + half)).log2().floor();
        // What is smaller than a texel in all 31 bits leaves its sign.
        Self { scale: bits.exp2(), most, shift: (bits as u32).min(31) }
    }

    /// Texels as units.
    pub(crate) fn of(&self, texels: f64) -> i32 {
        (texels.clamp(-self.most, self.most) * self.scale).round() as i32
    }
}

/// Sides of a pixel in metres, 0 where only its centre counts.
pub(super) fn pixel_sides(screen: &Screen, view: &View) -> [f64; 2] {
    match view.pixel {
        Pixel::Area => [screen.width_m / view.size[0] as f64, screen.height_m / view.size[1] as f64],
        Pixel::Centre => [0.0; 2],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A box far smaller than a texel, on a grid line thousands of texels in: f32 still splits it where f64 does.
    #[test]
    fn tiny_boxes_split_where_they_should() {
        let (line, width) = (4096.0, 1e-6);
        let centre = line + 0.25 * width; // a quarter of the box is left of the line
        let a = Axis::new(centre, centre - 0.5 * width, centre + 0.5 * width, 8192);
        assert_eq!((a.range.first, a.range.last), (4096, 4097));
        let left =
            (0..1000).filter(|i| a.offset + width as f32 * ((*i as f32 + 0.5) / 1000.0 - 0.5) < 0.0).count();
        assert!((left as i32 - 250).abs() <= 1, "{left}");
    }

    /// The texel of a sum of whole numbers is that of the sum of places, from boxes of 1e-9 texels to whole masks.
    #[test]
    fn whole_numbers_split_where_they_should() {
        for half in [0.0, 5e-10, 5e-7, 0.1, 0.24, 0.26, 3.0, 40.0, 5e4] {
            let fixed = Fixed::new(half);
            for offset in [-0.5, -0.3, -0.5 * half, -1e-3 * half, 0.0, 0.25 * half, 0.4, 0.5] {
                // The anchor is the nearest line: half a texel at most.
                let offset = f64::clamp(offset, -0.5, 0.5);
                let differ = |k: &i32| {
                    let t = half * (f64::from(*k) / 500.0 - 1.0 + 1e-4);
                    let texel = fixed.of(offset).wrapping_add(fixed.of(t)) >> fixed.shift;
                    texel != (offset + t).floor() as i32
                        && (offset + t - (offset + t).round()).abs() > 2e-9 * half
                };
                assert_eq!((0..1000).filter(differ).count(), 0, "half {half}, offset {offset}, on no line");
            }
            // Off the grid, however far: on the clear border or beyond it.
            let far = |offset: f64, t: f64| fixed.of(offset).wrapping_add(fixed.of(t)) >> fixed.shift;
            for t in [-half, half] {
                assert!(
                    far(-1e12 - half, t) < 0 && far(1e12 + half, t) >= 0 && far(f64::NEG_INFINITY, t) < 0
                );
                assert_eq!(fixed.of(f64::NAN), 0);
            }
        }
    }

    #[test]
    fn far_boxes_fall_on_the_clear_border() {
        let range = |centre: f64, half: f64| {
            let r = Axis::new(centre, centre - half, centre + half, 16).range;
            (r.first, r.last)
        };
        assert_eq!(range(-1e12, 3.0), (0, 0));
        assert_eq!(range(1e12, 3.0), (17, 17));
        assert_eq!(range(8.0, 1e30), (0, 17));
        assert_eq!(range(8.0, f64::INFINITY), (0, 17));
    }
}
