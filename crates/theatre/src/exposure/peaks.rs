//! The largest albedo of every square of pixels.

use crate::albedo::PixelAlbedo;

/// Squares of 2^level pixels a side: level 0 is the albedo itself, the last level one square.
pub(super) struct Peaks {
    albedo: PixelAlbedo,
    size: [usize; 2],
    /// Levels 1, 2, …, three planes each; none where the albedo is the same everywhere.
    above: Vec<[Vec<f32>; 3]>,
    levels: u32,
}

impl Peaks {
    pub(super) fn new(albedo: PixelAlbedo, size: [usize; 2]) -> Self {
        let levels = size[0].max(size[1]).next_power_of_two().trailing_zeros();
        let mut peaks = Self { albedo, size, above: Vec::new(), levels };
        if let PixelAlbedo::Image(_) = peaks.albedo {
            for level in 1..=levels {
                let next = [0, 1, 2].map(|c| peaks.of_four(c, level));
                peaks.above.push(next);
            }
        }
        peaks
    }

    /// The level that is one square.
    pub(super) fn levels(&self) -> u32 {
        self.levels
    }

    /// The largest albedo in a square, by its place among those of its level.
    pub(super) fn at(&self, c: usize, level: u32, [x, y]: [usize; 2]) -> f32 {
        let k = y * self.squares(level)[0] + x;
        match (&self.albedo, level.checked_sub(1)) {
            (PixelAlbedo::Uniform(rgb), _) => rgb[c],
            (_, None) => self.albedo.at(c, k),
            (_, Some(above)) => self.above[above as usize][c][k],
        }
    }

    fn squares(&self, level: u32) -> [usize; 2] {
        self.size.map(|side| side.div_ceil(1 << level))
    }

    fn of_four(&self, c: usize, level: u32) -> Vec<f32> {
        let ([w, h], [below_w, below_h]) = (self.squares(level), self.squares(level - 1));
        let square = |k: usize| {
            let (x, y) = (2 * (k % w), 2 * (k / w));
            let parts = [[x, y], [x + 1, y], [x, y + 1], [x + 1, y + 1]];
            let inside = parts.into_iter().filter(|[x, y]| *x < below_w && *y < below_h);
            inside.map(|at| self.at(c, level - 1, at)).fold(0.0, f32::max)
        };
        (0..w * h).map(square).collect()
    }
}
