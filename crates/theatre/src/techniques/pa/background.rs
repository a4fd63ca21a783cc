//! The screen without puppets: made once, kept while lamp, screen, size and pixel rule stay.

use std::f64::consts::PI;

use kelir_frame::encode::{Srgb, pack};
use kelir_frame::{View, multiversion};
use kelir_scene::{Albedo, Ambient, Emitter, Screen, Theatre};
use rayon::prelude::*;

use crate::albedo::{self, PixelAlbedo};
use crate::irradiance::UnitRows;

/// The lit screen and how much of its light each emitter gives.
#[derive(Debug)]
pub(super) struct Background {
    key: Key,
    /// The lit screen's radiance: three planes, or one where all three would be equal.
    pub lit: Vec<Vec<f32>>,
    /// The albedo, kept where the dome needs it.
    pub albedo: Option<PixelAlbedo>,
    /// The last emitter that shines: its share of the light is what the others leave.
    pub rest: usize,
    /// Each emitter's share of the lit screen's light: one plane a channel, or one where all emitters have the same
    /// colour. Empty for `rest`.
    pub share: Vec<Vec<Vec<f32>>>,
    /// Display codes of the lit screen and the white they were made with.
    encoded: Option<(f64, Codes)>,
}

/// Display codes; grey ones take a quarter of the memory, and copying them is bound by memory.
#[derive(Debug)]
enum Codes {
    Grey(Vec<u8>),
    Colour(Vec<u32>),
}

#[inline(always)]
fn widen_generic(codes: &[u8], out: &mut [u32]) {
    for (out, code) in out.iter_mut().zip(codes) {
        *out = 0xff00_0000 | (u32::from(*code) * 0x01_0101);
    }
}
multiversion! { fn widen(codes: &[u8], out: &mut [u32]) = widen_generic; }

#[derive(Debug)]
struct Key {
    screen: Screen,
    lamp_m: glam::DVec3,
    emitters: Vec<Emitter>,
    view: View,
}

impl Key {
    fn holds(&self, theatre: &Theatre, view: &View) -> bool {
        let albedo = match (&self.screen.albedo, &theatre.screen.albedo) {
            (Albedo::Uniform(a), Albedo::Uniform(b)) => a == b,
            (Albedo::Image(a), Albedo::Image(b)) => std::sync::Arc::ptr_eq(a, b),
            _ => false,
        };
        let same = |(a, b): (&Emitter, &Emitter)| a.shape == b.shape && a.radiance == b.radiance;
        albedo
            && self.screen.width_m == theatre.screen.width_m
            && self.screen.height_m == theatre.screen.height_m
            && self.lamp_m == theatre.lamp.position_m
            && self.emitters.len() == theatre.lamp.emitters.len()
            && self.emitters.iter().zip(&theatre.lamp.emitters).all(same)
            && self.view.size == view.size
            && self.view.pixel == view.pixel
    }
}

/// Whether all emitters' radiances are multiples of one colour.
fn one_colour(emitters: &[Emitter]) -> bool {
    let Some(first) = emitters.iter().map(|e| e.radiance).find(|l| *l != [0.0; 3]) else { return true };
    emitters.iter().all(|e| {
        let cross = |a: usize, b: usize| e.radiance[a] * first[b] == e.radiance[b] * first[a];
        cross(0, 1) && cross(1, 2) && cross(0, 2)
    })
}

/// One image row of every plane that is being drawn.
#[derive(Default)]
struct Row<'a> {
    lit: Vec<&'a mut [f32]>,
    /// Emitter, channel, values.
    share: Vec<(usize, usize, &'a mut [f32])>,
}

impl Background {
    /// Whether this one still serves.
    pub(super) fn serves(&self, theatre: &Theatre, view: &View) -> bool {
        let dome = matches!(theatre.ambient, Ambient::Dome { .. });
        self.key.holds(theatre, view) && (!dome || self.albedo.is_some())
    }

    /// Draws the screen without puppets.
    pub(super) fn new(theatre: &Theatre, view: &View) -> Self {
        let emitters = &theatre.lamp.emitters;
        let albedo = albedo::on_grid(&theatre.screen, view);
        let lamp_m = theatre.lamp.position_m;
        let units: Vec<_> =
            emitters.iter().map(|e| UnitRows::new(&e.shape, lamp_m, &theatre.screen, view.size)).collect();
        let grey = emitters.iter().all(|e| e.radiance[0] == e.radiance[1] && e.radiance[1] == e.radiance[2])
            && match &albedo {
                PixelAlbedo::Uniform([r, g, b]) => r == g && g == b,
                PixelAlbedo::Image([r, g, b]) => r == g && g == b,
            };
        // One colour: any channel in which something shines carries all shares.
        let bright = (0..3).find(|c| emitters.iter().any(|e| e.radiance[*c] > 0.0)).unwrap_or(0);
        let share_channels: &[usize] = if one_colour(emitters) { &[bright] } else { &[0, 1, 2] };
        let rest = emitters.iter().rposition(|e| e.radiance != [0.0; 3]).unwrap_or(emitters.len() - 1);
        let [w, h] = view.size;
        let plane = || vec![0f32; w * h];
        let mut lit: Vec<_> = (0..if grey { 1 } else { 3 }).map(|_| plane()).collect();
        let mut share: Vec<Vec<_>> = (0..emitters.len())
            .map(|e| share_channels.iter().filter(|_| e != rest).map(|_| plane()).collect())
            .collect();
        let mut rows: Vec<Row> = (0..h).map(|_| Row::default()).collect();
        lit.iter_mut().for_each(|p| p.chunks_mut(w).zip(&mut rows).for_each(|(p, row)| row.lit.push(p)));
        for (e, planes) in share.iter_mut().enumerate() {
            for (p, c) in planes.iter_mut().zip(share_channels) {
                p.chunks_mut(w).zip(&mut rows).for_each(|(p, row)| row.share.push((e, *c, p)));
            }
        }
        let draw = |(unit, total): &mut (Vec<f64>, Vec<f64>), (j, mut row): (usize, Row)| {
            unit.resize(emitters.len() * w, 0.0);
            total.resize(3 * w, 0.0);
            total.fill(0.0);
            for ((unit, rows), emitter) in unit.chunks_mut(w).zip(&units).zip(emitters) {
                rows.row(j, unit);
                for (total, radiance) in total.chunks_mut(w).zip(emitter.radiance) {
                    total.iter_mut().zip(unit.iter()).for_each(|(t, u)| *t += radiance * u);
                }
            }
            for (c, lit) in row.lit.iter_mut().enumerate() {
                for (i, (lit, e)) in lit.iter_mut().zip(&total[c * w..]).enumerate() {
                    *lit = (f64::from(albedo.at(c, j * w + i)) * e / PI) as f32;
                }
            }
            for (e, c, share) in &mut row.share {
                let (radiance, unit) = (emitters[*e].radiance[*c], &unit[*e * w..]);
                for ((share, all), unit) in share.iter_mut().zip(&total[*c * w..]).zip(unit) {
                    *share = if *all > 0.0 { (radiance * unit / all) as f32 } else { 0.0 };
                }
            }
        };
        rows.into_par_iter().enumerate().for_each_init(Default::default, draw);
        let key = Key { screen: theatre.screen.clone(), lamp_m, emitters: emitters.clone(), view: *view };
        let albedo = matches!(theatre.ambient, Ambient::Dome { .. }).then_some(albedo);
        Self { key, lit, albedo, rest, share, encoded: None }
    }

    /// Radiance of channel `c`.
    pub(super) fn lit(&self, c: usize) -> &[f32] {
        &self.lit[c.min(self.lit.len() - 1)]
    }

    /// Share of emitter `e` (any but `rest`) in channel `c`.
    pub(super) fn share(&self, e: usize, c: usize) -> &[f32] {
        let planes = &self.share[e];
        &planes[c.min(planes.len() - 1)]
    }

    /// Channels of which shares differ: 1 or 3.
    pub(super) fn share_channels(&self) -> usize {
        self.share.iter().map(Vec::len).max().unwrap_or(1).max(1)
    }

    /// Makes sure that the lit screen's display codes for `white` are there; tells whether they were.
    pub(super) fn encode(&mut self, white: f64) -> bool {
        if self.encoded.as_ref().is_some_and(|(w, _)| *w == white) {
            return true;
        }
        let (srgb, scale) = (Srgb::get(), (1.0 / white) as f32);
        let code = |lit: &f32| srgb.code(lit * scale);
        let (r, g, b) = (self.lit(0).par_iter(), self.lit(1).par_iter(), self.lit(2).par_iter());
        let codes = if self.lit.len() == 1 {
            Codes::Grey(r.with_min_len(4096).map(|r| code(r) as u8).collect())
        } else {
            let packed = |((r, g), b): ((&f32, &f32), &f32)| pack(code(r), code(g), code(b));
            Codes::Colour(r.zip(g).zip(b).with_min_len(4096).map(packed).collect())
        };
        self.encoded = Some((white, codes));
        false
    }

    /// Writes the lit screen's display codes of `pixels`; [`encode`](Self::encode) must have made them.
    pub(super) fn copy_lit(&self, pixels: std::ops::Range<usize>, out: &mut [u32]) {
        match &self.encoded {
            Some((_, Codes::Grey(codes))) => widen(&codes[pixels], out),
            Some((_, Codes::Colour(codes))) => out.copy_from_slice(&codes[pixels]),
            None => {}
        }
    }
}
