//! Look-ups with AVX2.

use std::arch::x86_64::*;

use super::{loads_stay_within, look_up_generic};

/// Four windows at a time, whose ends lie less than four entries apart.
#[target_feature(enable = "avx2")]
pub(super) fn near<const K: usize>(
    (sums, steps): (&[u64], &[f64]),
    (start, stop): (&[i32], &[i32]),
    (start_before, stop_before): (&[f64], &[f64]),
    count: usize,
    norm: f64,
    out: &mut [f32],
) {
    let n = out.len();
    let whole = n - n % 4;
    let entries = sums.len().min(steps.len());
    loads_stay_within::<K>(whole, (start, stop), (entries, 4), (start_before, stop_before), count);
    let (norm4, one, zero) = (_mm256_set1_pd(norm), _mm_set1_ps(1.0), _mm_setzero_ps());
    for at in (0..whole).step_by(4) {
        // SAFETY: `loads_stay_within`; four ends from the first are less than four entries away from it.
        unsafe {
            // Where the first of four ends lies, and which pairs of 32 bits each of them is, from there on.
            let ends = |ends: &[i32]| {
                let first = *ends.get_unchecked(at);
                let all = _mm_loadu_si128(ends.as_ptr().add(at).cast());
                let twice = _mm_slli_epi32::<1>(_mm_sub_epi32(all, _mm_set1_epi32(first)));
                let pairs = _mm256_cvtepu32_epi64(twice);
                let odd = _mm256_slli_epi64::<32>(_mm256_add_epi64(pairs, _mm256_set1_epi64x(1)));
                ((first + K as i32) as usize, _mm256_or_si256(pairs, odd))
            };
            let sum_at = |(first, to): (usize, __m256i)| {
                let four = _mm256_loadu_si256(sums.as_ptr().add(first).cast());
                _mm256_permutevar8x32_epi32(four, to)
            };
            let step_at = |(first, to): (usize, __m256i), k: usize| {
                let four = _mm256_loadu_si256(steps.as_ptr().add(first + k).cast());
                _mm256_castsi256_pd(_mm256_permutevar8x32_epi32(four, to))
            };
            let (a, b) = (ends(start), ends(stop));
            let mut sum = to_f64(_mm256_sub_epi64(sum_at(b), sum_at(a)));
            for k in 0..K {
                let weight = |before: &[f64]| _mm256_loadu_pd(before.as_ptr().add(k * count + at));
                sum = _mm256_add_pd(sum, _mm256_mul_pd(weight(stop_before), step_at(b, k)));
                sum = _mm256_sub_pd(sum, _mm256_mul_pd(weight(start_before), step_at(a, k)));
            }
            let opacity = _mm256_cvtpd_ps(_mm256_mul_pd(sum, norm4));
            let through = _mm_min_ps(_mm_max_ps(_mm_sub_ps(one, opacity), zero), one);
            _mm_storeu_ps(out.as_mut_ptr().add(at), through);
        }
    }
    let ends = (&start[whole..n], &stop[whole..n]);
    let weights = (&start_before[whole..], &stop_before[whole..]);
    look_up_generic::<K>((sums, steps), ends, weights, count, norm, &mut out[whole..]);
}

/// The nearest f64 of each u64: both halves on top of powers of two, whose sum is rounded once.
#[target_feature(enable = "avx2")]
fn to_f64(v: __m256i) -> __m256d {
    const LOW: u64 = 0x4330_0000_0000_0000; // 2⁵²
    const HIGH: u64 = 0x4530_0000_0000_0000; // 2⁸⁴
    let bias = _mm256_set1_pd(f64::from_bits(HIGH) + f64::from_bits(LOW));
    let low = _mm256_blend_epi16::<0xcc>(v, _mm256_set1_epi64x(LOW as i64));
    let high = _mm256_or_si256(_mm256_srli_epi64::<32>(v), _mm256_set1_epi64x(HIGH as i64));
    let high = _mm256_sub_pd(_mm256_castsi256_pd(high), bias);
    _mm256_add_pd(high, _mm256_castsi256_pd(low))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As the language converts, for values around every power of two and every rounding.
    #[test]
    fn whole_numbers_convert_as_the_language_does() {
        if !std::arch::is_x86_feature_detected!("avx2") {
            return;
        }
        let around = |p: u32| {
            (0..4096u64).map(move |d| (1u64 << p).wrapping_add(d.wrapping_mul(d)).wrapping_sub(2048))
        };
        let values: Vec<u64> = (0..64).flat_map(around).chain([0, 1, u64::MAX, u64::MAX - 1]).collect();
        for four in values.chunks_exact(4) {
            let mut out = [0f64; 4];
            // SAFETY: detected above; four values in, four out.
            unsafe { _mm256_storeu_pd(out.as_mut_ptr(), to_f64(_mm256_loadu_si256(four.as_ptr().cast()))) };
            assert_eq!(out.map(f64::to_bits), [0, 1, 2, 3].map(|k| (four[k] as f64).to_bits()), "{four:?}");
        }
    }
}
