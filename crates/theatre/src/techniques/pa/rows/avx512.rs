//! Look-ups with AVX-512.

use std::arch::x86_64::*;

use super::{loads_stay_within, look_up_generic};

#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi")]
pub(super) fn far<const K: usize>(
    sums: (&[u64], &[f64]),
    ends: (&[i32], &[i32]),
    weights: (&[f64], &[f64]),
    count: usize,
    norm: f64,
    out: &mut [f32],
) {
    look_up_generic::<K>(sums, ends, weights, count, norm, out);
}

#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi")]
pub(super) fn near<const K: usize>(
    (sums, steps): (&[u64], &[f64]),
    (start, stop): (&[i32], &[i32]),
    (start_before, stop_before): (&[f64], &[f64]),
    count: usize,
    norm: f64,
    out: &mut [f32],
) {
    let n = out.len();
    let whole = n - n % 8;
    loads_stay_within::<K>(whole, (start, stop), (sums.len(), 16), (start_before, stop_before), count);
    let (norm8, one, zero) = (_mm512_set1_pd(norm), _mm256_set1_ps(1.0), _mm256_setzero_ps());
    for at in (0..whole).step_by(8) {
        // SAFETY: `loads_stay_within`; eight ends from the first are less than sixteen entries away from it.
        unsafe {
            let load = |ends: &[i32]| {
                let first = *ends.get_unchecked(at);
                let all = _mm256_loadu_si256(ends.as_ptr().add(at).cast());
                let offsets = _mm512_cvtepi32_epi64(_mm256_sub_epi32(all, _mm256_set1_epi32(first)));
                (sums.as_ptr().offset((first + K as i32) as isize), offsets)
            };
            let entry = |p: *const u64, to: __m512i| {
                _mm512_permutex2var_epi64(
                    _mm512_loadu_si512(p.cast()),
                    to,
                    _mm512_loadu_si512(p.add(8).cast()),
                )
            };
            let ((a, a_to), (b, b_to)) = (load(start), load(stop));
            let (mut from, mut till) = (entry(a, a_to), entry(b, b_to));
            let mut sum = _mm512_cvtepu64_pd(_mm512_sub_epi64(till, from));
            for k in 0..K {
                let (next_from, next_till) = (entry(a.add(k + 1), a_to), entry(b.add(k + 1), b_to));
                let weight = |before: &[f64]| _mm512_loadu_pd(before.as_ptr().add(k * count + at));
                let part = _mm512_cvtepu64_pd(_mm512_sub_epi64(next_till, till));
                sum = _mm512_add_pd(sum, _mm512_mul_pd(weight(stop_before), part));
                let part = _mm512_cvtepu64_pd(_mm512_sub_epi64(next_from, from));
                sum = _mm512_sub_pd(sum, _mm512_mul_pd(weight(start_before), part));
                (from, till) = (next_from, next_till);
            }
            let opacity = _mm512_cvtpd_ps(_mm512_mul_pd(sum, norm8));
            let through = _mm256_min_ps(_mm256_max_ps(_mm256_sub_ps(one, opacity), zero), one);
            _mm256_storeu_ps(out.as_mut_ptr().add(at), through);
        }
    }
    let ends = (&start[whole..n], &stop[whole..n]);
    let weights = (&start_before[whole..], &stop_before[whole..]);
    look_up_generic::<K>((sums, steps), ends, weights, count, norm, &mut out[whole..]);
}
