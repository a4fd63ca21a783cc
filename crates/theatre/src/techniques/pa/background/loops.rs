//! The loops over pixels of a row of the lit screen, on the best instruction set; every width gives the same bits.

use std::f64::consts::PI;

use kelir_frame::encode::{Srgb, pack};
use kelir_frame::multiversion;

#[inline(always)]
fn add_generic(total: &mut [f64], radiance: f64, unit: &[f64]) {
    for (total, unit) in total.iter_mut().zip(unit) {
        *total += radiance * unit;
    }
}
multiversion! {
    /// Adds one emitter's irradiance.
    pub(super) fn add(total: &mut [f64], radiance: f64, unit: &[f64]) = add_generic;
}

#[inline(always)]
fn reflect_generic(out: &mut [f32], albedo: &[f32], total: &[f64]) {
    for ((out, albedo), e) in out.iter_mut().zip(albedo).zip(total) {
        *out = (f64::from(*albedo) * e / PI) as f32;
    }
}
multiversion! {
    /// Radiance of a diffuse screen: albedo · E / π.
    pub(super) fn reflect(out: &mut [f32], albedo: &[f32], total: &[f64]) = reflect_generic;
}

#[inline(always)]
fn share_generic(out: &mut [f32], radiance: f64, unit: &[f64], total: &[f64]) {
    for ((out, unit), all) in out.iter_mut().zip(unit).zip(total) {
        let share = (radiance * unit / all) as f32;
        *out = if *all > 0.0 { share } else { 0.0 };
    }
}
multiversion! {
    /// One emitter's share of the irradiance; 0 where there is none.
    pub(super) fn share(out: &mut [f32], radiance: f64, unit: &[f64], total: &[f64]) = share_generic;
}

#[inline(always)]
fn encode_generic(srgb: &Srgb, lit: &[f32], scale: f32, out: &mut [u8]) {
    for (out, lit) in out.iter_mut().zip(lit) {
        *out = srgb.code(lit * scale) as u8;
    }
}
multiversion! {
    /// Display codes of grey radiances.
    pub(super) fn encode(srgb: &Srgb, lit: &[f32], scale: f32, out: &mut [u8]) = encode_generic;
}

#[inline(always)]
fn encode_colour_generic(srgb: &Srgb, lit: [&[f32]; 3], scale: f32, out: &mut [u32]) {
    let n = out.len();
    let [r, g, b] = lit.map(|l| &l[..n]);
    for k in 0..n {
        out[k] = pack(srgb.code(r[k] * scale), srgb.code(g[k] * scale), srgb.code(b[k] * scale));
    }
}
multiversion! {
    /// Display codes of radiances.
    pub(super) fn encode_colour(srgb: &Srgb, lit: [&[f32]; 3], scale: f32, out: &mut [u32]) = encode_colour_generic;
}

#[inline(always)]
fn widen_generic(codes: &[u8], out: &mut [u32]) {
    for (out, code) in out.iter_mut().zip(codes) {
        *out = 0xff00_0000 | (u32::from(*code) * 0x01_0101);
    }
}
multiversion! {
    /// Grey codes as pixels.
    pub(super) fn widen(codes: &[u8], out: &mut [u32]) = widen_generic;
}
