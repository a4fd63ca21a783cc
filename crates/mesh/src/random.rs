//! Numbers without a pattern, the same on every machine: integers mixed and nothing else.

/// A hash of two numbers (the finaliser of SplitMix64, Steele et al. 2014, over their combination).
pub(crate) fn mixed(seed: u64, number: u64) -> u64 {
    let mut z = seed.wrapping_add(number.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15));
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// A number from 0 to below 1.
pub(crate) fn fraction(seed: u64, number: u64) -> f64 {
    (mixed(seed, number) >> 11) as f64 / (1u64 << 53) as f64
}
