//! From visibilities to radiance and display codes.

use std::ops::Range;

use kelir_frame::encode::{Srgb, pack};
use kelir_scene::Ambient;

use super::loops::{encode_colour, encode_grey, grey_one, grey_two, mix};
use super::{Band, Job, Scratch};
use crate::ambient;
use crate::project::pixel_m;

impl Job<'_> {
    /// Shading and display codes of the plainest scenes in one pass: grey light, one or two emitters, one plane where ambient
    /// light asks for its distance. Same bits as [`shade`](Self::shade) and [`emit`](Self::emit); false where it does not apply.
    pub(super) fn emit_grey(
        &self,
        j: usize,
        at: usize,
        span: Range<usize>,
        scratch: &Scratch,
        band: &mut Band,
    ) -> bool {
        let Band::Display { white, out } = band else { return false };
        let (n, emitters, rest) = (span.len(), self.theatre.lamp.emitters.len(), self.background.rest);
        let pale = match (self.theatre.ambient, &self.plan.planes[..]) {
            (Ambient::None, _) => 0.0,
            (Ambient::Paper { k_d_m, s }, [p]) => {
                ambient::share(0.0, self.plan.distance_m[*p], k_d_m, s[0]) as f32
            }
            _ => return false,
        };
        if self.shades > 1 || self.background.lit.len() > 1 || emitters > 2 || self.dome.is_some() {
            return false;
        }
        let pixels = j * self.view.size[0] + span.start..j * self.view.size[0] + span.end;
        let row = |e: usize| &scratch.visibility[e * n..][..n];
        let lit = &self.background.lit(0)[pixels.clone()];
        let out = &mut out[at + span.start..at + span.end];
        let (srgb, scale) = (Srgb::get(), (1.0 / *white) as f32);
        if emitters == 1 {
            grey_one(srgb, lit, row(0), pale, scale, out);
        } else {
            grey_two(
                srgb,
                lit,
                row(rest),
                row(1 - rest),
                &self.background.share(1 - rest, 0)[pixels],
                pale,
                scale,
                out,
            );
        }
        true
    }

    /// Shading factors X of the pixels of `span`: L = lit · X.
    pub(super) fn shade(&self, j: usize, span: Range<usize>, scratch: &mut Scratch) {
        let (n, channels) = (span.len(), self.plan.channels);
        let emitters = self.theatre.lamp.emitters.len();
        let row = j * self.view.size[0] + span.start;
        scratch.shade.resize(self.shades * n, 0.0);
        for c in 0..self.shades {
            let of = |e: usize| (e * channels + c.min(channels - 1)) * n;
            let shade = &mut scratch.shade[c * n..][..n];
            let rest = &scratch.visibility[of(self.background.rest)..][..n];
            shade.copy_from_slice(rest);
            for e in (0..emitters).filter(|e| *e != self.background.rest) {
                // Mixed relative to one emitter, so that all lit is exactly 1 and all dark exactly 0.
                mix(shade, &scratch.visibility[of(e)..][..n], rest, &self.background.share(e, c)[row..][..n]);
            }
            let Ambient::Paper { k_d_m, s } = self.theatre.ambient else { continue };
            if let [plane] = self.plan.planes[..] {
                let pale = ambient::share(0.0, self.plan.distance_m[plane], k_d_m, s[c]) as f32;
                shade.iter_mut().for_each(|x| *x += (1.0 - *x) * pale);
            } else {
                for (k, x) in shade.iter_mut().enumerate() {
                    let own = |i: usize| f64::from(scratch.own[(i * self.shades + c) * n + k]);
                    let planes = self.plan.planes.iter().enumerate();
                    let distance_m =
                        ambient::distance_m(planes.map(|(i, p)| (self.plan.distance_m[*p], 1.0 - own(i))));
                    *x += ambient::share(f64::from(*x), distance_m, k_d_m, s[c]) as f32;
                }
            }
        }
    }

    /// Writes the pixels of `span` of row `j`, which starts at `at` in the band.
    pub(super) fn emit(&self, j: usize, at: usize, span: Range<usize>, scratch: &Scratch, band: &mut Band) {
        let n = span.len();
        let row = j * self.view.size[0];
        let pixels = row + span.start..row + span.end;
        let to = at + span.start..at + span.end;
        let shade = |c: usize| &scratch.shade[c.min(self.shades - 1) * n..][..n];
        let lit = |c: usize| &self.background.lit(c)[pixels.clone()];
        let mut added = [0, 1, 2].map(|_| Vec::new());
        if let Some(dome) = &self.dome {
            let albedo = |c: usize, k: usize| self.background.dome_albedo().map_or(0.0, |a| a.at(c, k));
            added = [0, 1, 2].map(|c| {
                let at = |i: usize| pixel_m(&self.theatre.screen, self.view.size, i as f64, j as f64);
                span.clone().map(|i| albedo(c, row + i) * dome.radiance(c, at(i))).collect()
            });
        }
        match band {
            Band::Display { white, out } => {
                let (srgb, scale) = (Srgb::get(), (1.0 / *white) as f32);
                if self.dome.is_some() {
                    let (lit, shade) = ([0, 1, 2].map(lit), [0, 1, 2].map(shade));
                    for (k, out) in out[to].iter_mut().enumerate() {
                        let code = |c: usize| srgb.code((lit[c][k] * shade[c][k] + added[c][k]) * scale);
                        *out = pack(code(0), code(1), code(2));
                    }
                } else if self.shades == 1 && self.background.lit.len() == 1 {
                    encode_grey(srgb, lit(0), shade(0), scale, &mut out[to]);
                } else {
                    let lit = [lit(0), lit(1), lit(2)];
                    encode_colour(srgb, lit, [shade(0), shade(1), shade(2)], scale, &mut out[to]);
                }
            }
            Band::Radiance { radiance, layers } => {
                for (c, plane) in radiance.iter_mut().enumerate() {
                    let to = &mut plane[to.clone()];
                    to.iter_mut().zip(lit(c)).zip(shade(c)).for_each(|((l, lit), x)| *l = lit * x);
                    to.iter_mut().zip(&added[c]).for_each(|(l, dome)| *l += dome);
                }
                // All puppets may be off the beam: then one channel answers for the three layers.
                let layers_per = layers.len() / self.theatre.lamp.emitters.len();
                for (k, layer) in layers.iter_mut().enumerate() {
                    let (e, c) = (k / layers_per, (k % layers_per).min(self.plan.channels - 1));
                    layer[to.clone()]
                        .copy_from_slice(&scratch.visibility[(e * self.plan.channels + c) * n..][..n]);
                }
            }
        }
    }
}
