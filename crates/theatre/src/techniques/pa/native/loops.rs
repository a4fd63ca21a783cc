//! The loops over pixels of a row, on the best instruction set; every width gives the same bits.

use kelir_frame::encode::{Srgb, pack};
use kelir_frame::multiversion;

#[inline(always)]
fn multiply_generic(product: &mut [f32], by: &[f32]) {
    for (p, b) in product.iter_mut().zip(by) {
        *p *= b;
    }
}
multiversion! { pub fn multiply(product: &mut [f32], by: &[f32]) = multiply_generic; }

#[inline(always)]
fn grey_one_generic(srgb: &Srgb, lit: &[f32], rest: &[f32], pale: f32, scale: f32, out: &mut [u32]) {
    for ((out, lit), x) in out.iter_mut().zip(lit).zip(rest) {
        let x = x + (1.0 - x) * pale;
        *out = 0xff00_0000 | (srgb.code(lit * x * scale) * 0x01_0101);
    }
}
multiversion! {
    pub fn grey_one(srgb: &Srgb, lit: &[f32], rest: &[f32], pale: f32, scale: f32, out: &mut [u32]) = grey_one_generic;
}

#[inline(always)]
#[allow(clippy::too_many_arguments, reason = "what an inner loop reads, each in a register")]
fn grey_two_generic(
    srgb: &Srgb,
    lit: &[f32],
    rest: &[f32],
    other: &[f32],
    share: &[f32],
    pale: f32,
    scale: f32,
    out: &mut [u32],
) {
    for ((((out, lit), rest), other), share) in out.iter_mut().zip(lit).zip(rest).zip(other).zip(share) {
        let x = rest + share * (other - rest);
        let x = x + (1.0 - x) * pale;
        *out = 0xff00_0000 | (srgb.code(lit * x * scale) * 0x01_0101);
    }
}
multiversion! {
    pub fn grey_two(srgb: &Srgb, lit: &[f32], rest: &[f32], other: &[f32], share: &[f32], pale: f32, scale: f32, out: &mut [u32]) = grey_two_generic;
}

#[inline(always)]
fn mix_generic(shade: &mut [f32], visibility: &[f32], rest: &[f32], share: &[f32]) {
    for (((x, v), rest), share) in shade.iter_mut().zip(visibility).zip(rest).zip(share) {
        *x += share * (v - rest);
    }
}
multiversion! { pub fn mix(shade: &mut [f32], visibility: &[f32], rest: &[f32], share: &[f32]) = mix_generic; }

#[inline(always)]
fn encode_grey_generic(srgb: &Srgb, lit: &[f32], shade: &[f32], scale: f32, out: &mut [u32]) {
    for ((out, lit), shade) in out.iter_mut().zip(lit).zip(shade) {
        *out = 0xff00_0000 | (srgb.code(lit * shade * scale) * 0x01_0101);
    }
}
multiversion! { pub fn encode_grey(srgb: &Srgb, lit: &[f32], shade: &[f32], scale: f32, out: &mut [u32]) = encode_grey_generic; }

#[inline(always)]
fn encode_colour_generic(srgb: &Srgb, lit: [&[f32]; 3], shade: [&[f32]; 3], scale: f32, out: &mut [u32]) {
    let n = out.len();
    let (lit, shade) = (lit.map(|l| &l[..n]), shade.map(|s| &s[..n]));
    for k in 0..n {
        let code = |c: usize| srgb.code(lit[c][k] * shade[c][k] * scale);
        out[k] = pack(code(0), code(1), code(2));
    }
}
multiversion! { pub fn encode_colour(srgb: &Srgb, lit: [&[f32]; 3], shade: [&[f32]; 3], scale: f32, out: &mut [u32]) = encode_colour_generic; }
