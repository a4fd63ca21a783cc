//! Owen-scrambled Sobol points, in integers only: both backends read the same table and so use the very same points.
//!
//! One table of [`REPLICATES`] independently scrambled Sobol sequences serves every pixel: a pixel XORs it with random
//! words of its own (a digital shift). A shifted Owen-scrambled net is an Owen-scrambled net, so each pixel keeps the
//! fast convergence and every point stays uniform; estimates of different pixels and emitters are uncorrelated.

/// Independent scrambles: their means' spread is the standard error.
pub const REPLICATES: usize = 16;

/// Dimensions: emitter x, emitter y, pixel x, pixel y.
pub const DIMENSIONS: usize = 4;

/// `samples` points per replicate.
pub struct Points {
    /// What they were made from.
    pub seed: u64,
    /// Points per replicate.
    pub samples: usize,
    /// Whether each pixel shifts them at random; points that stand still are not.
    pub scrambled: bool,
    /// `dims[d][i * REPLICATES + r]` is coordinate `d` of point `i` of replicate `r`, as a fraction of 2³².
    pub dims: [Vec<u32>; DIMENSIONS],
}

impl Points {
    /// The table for `seed`; longer tables of one seed begin with the shorter ones.
    pub fn new(seed: u64, samples: usize) -> Self {
        let key = fold(seed);
        let dims = std::array::from_fn(|d| {
            let directions = directions(d);
            let keys: [u32; REPLICATES] =
                std::array::from_fn(|r| hash(key ^ hash((r * DIMENSIONS + d) as u32)));
            let mut table = Vec::with_capacity(samples * REPLICATES);
            for i in 0..samples {
                let x = sobol(&directions, i as u32);
                table.extend(keys.map(|key| owen(x, key)));
            }
            table
        });
        Self { seed, samples, scrambled: true, dims }
    }

    /// Coordinate `d` in [−½, ½) of a replicate's point, shifted by the words of stream `key`: 24 bits.
    pub fn at(&self, key: u32, d: usize, point: usize, replicate: usize) -> f64 {
        let shift = if self.scrambled { shift(key, d, replicate) } else { 0 };
        f64::from((self.dims[d][point * REPLICATES + replicate] ^ shift) as i32 >> 8) / 16_777_216.0
    }
}

/// A 64-bit seed as one word.
pub fn fold(seed: u64) -> u32 {
    hash(seed as u32 ^ hash((seed >> 32) as u32))
}

/// A 32-bit mixing permutation ("lowbias32", C. Wellons, 2018: bias 0.17 bits of avalanche).
#[inline(always)]
pub fn hash(mut x: u32) -> u32 {
    x ^= x >> 16;
    x = x.wrapping_mul(0x7feb_352d);
    x ^= x >> 15;
    x = x.wrapping_mul(0x846c_a68b);
    x ^ (x >> 16)
}

/// The digital shift of a pixel's stream: `key` is [`stream`] of the seed, the pixel and the emitter.
#[inline(always)]
pub fn shift(key: u32, dimension: usize, replicate: usize) -> u32 {
    hash(key.wrapping_add(((dimension * REPLICATES + replicate) as u32).wrapping_mul(0x9e37_79b9)))
}

/// The key of one pixel's and one emitter's random words; `seed` is already [`fold`]ed.
#[inline(always)]
pub fn stream(seed: u32, pixel: u32, emitter: u32) -> u32 {
    hash(hash(seed ^ hash(pixel)).wrapping_add(emitter))
}

/// Direction numbers (Joe & Kuo 2008, `new-joe-kuo-6`), first four dimensions.
fn directions(dimension: usize) -> [u32; 32] {
    // (degree s, coefficients a, initial m) of dimensions 1, 2, 3; dimension 0 is van der Corput's sequence.
    let (s, a, m): (usize, u32, &[u32]) = match dimension {
        0 => return std::array::from_fn(|i| 1 << (31 - i)),
        1 => (1, 0, &[1]),
        2 => (2, 1, &[1, 3]),
        3 => (3, 1, &[1, 3, 1]),
        _ => unreachable!("{DIMENSIONS} dimensions"),
    };
    let mut v = [0u32; 32];
    for i in 0..32 {
        v[i] = if i < s {
            m[i] << (31 - i)
        } else {
            let mut x = v[i - s] ^ (v[i - s] >> s);
            for k in 1..s {
                if a >> (s - 1 - k) & 1 == 1 {
                    x ^= v[i - k];
                }
            }
            x
        };
    }
    v
}

fn sobol(directions: &[u32; 32], index: u32) -> u32 {
    (0..32).filter(|b| index >> b & 1 == 1).fold(0, |x, b| x ^ directions[b])
}

/// Nested uniform (Owen) scrambling: every bit is flipped or not by a random function of all bits above it.
fn owen(x: u32, key: u32) -> u32 {
    let mut y = 0;
    for bit in (0..32).rev() {
        // The leading one marks how long the prefix is.
        let prefix = (1u64 << (31 - bit)) as u32 | (u64::from(x) >> (bit + 1)) as u32;
        let flip = hash(hash(prefix) ^ key) >> 31;
        y |= ((x >> bit & 1) ^ flip) << bit;
    }
    y
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of 2^(2k) points each cell of every dyadic partition of the square into as many equal cells holds exactly one
    /// (a (0, 2k, 2)-net), after scrambling and shifting; plain random points don't (negative control).
    #[test]
    fn the_first_two_dimensions_are_a_net() {
        let k = 3;
        let n = 1usize << (2 * k);
        let points = Points::new(7, n);
        let is_net = |xs: &dyn Fn(usize) -> u32, ys: &dyn Fn(usize) -> u32| {
            (0..=2 * k).all(|bits| {
                let mut seen = vec![false; n];
                for i in 0..n {
                    let cell = |v: u32, b: usize| if b == 0 { 0 } else { (v >> (32 - b)) as usize };
                    seen[cell(xs(i), bits) << (2 * k - bits) | cell(ys(i), 2 * k - bits)] = true;
                }
                seen.iter().all(|&s| s)
            })
        };
        for r in 0..REPLICATES {
            let key = stream(fold(7), 1234, 1);
            let x = |i: usize| points.dims[0][i * REPLICATES + r] ^ shift(key, 0, r);
            let y = |i: usize| points.dims[1][i * REPLICATES + r] ^ shift(key, 1, r);
            assert!(is_net(&x, &y), "replicate {r}");
        }
        let random = |salt: u32| move |i: usize| hash(hash(i as u32) ^ salt);
        assert!(!is_net(&random(1), &random(2)));
    }

    /// Every dimension alone is stratified: n = 2^k points fall into n different equal intervals.
    #[test]
    fn every_dimension_is_stratified() {
        let n = 256;
        let points = Points::new(1, n);
        for (d, table) in points.dims.iter().enumerate() {
            for r in 0..REPLICATES {
                let mut cells: Vec<_> = (0..n).map(|i| table[i * REPLICATES + r] >> 24).collect();
                cells.sort_unstable();
                cells.dedup();
                assert_eq!(cells.len(), n, "dimension {d}, replicate {r}");
            }
        }
    }

    /// Replicates, pixels and emitters get different words, and a table's beginning does not depend on its length.
    #[test]
    fn streams_differ_and_tables_nest() {
        let (long, short) = (Points::new(5, 64), Points::new(5, 16));
        assert_eq!(long.dims[3][..16 * REPLICATES], short.dims[3][..]);
        assert_ne!(long.dims[0], Points::new(6, 64).dims[0]);
        assert_ne!(long.dims[0][0], long.dims[0][1]);
        assert_ne!(stream(1, 2, 0), stream(1, 2, 1));
        assert_ne!(stream(1, 2, 0), stream(1, 3, 0));
        assert_ne!(shift(9, 0, 1), shift(9, 1, 0));
    }
}
