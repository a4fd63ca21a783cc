//! The screen without puppets: made once, kept while lamp, screen, size and pixel rule stay.

use kelir_frame::View;
use kelir_frame::encode::Srgb;
use kelir_scene::{Albedo, Ambient, Emitter, Screen, Theatre};
use rayon::prelude::*;

use crate::albedo::{self, PixelAlbedo};
use crate::irradiance::UnitRows;

mod loops;

/// The lit screen and how much of its light each emitter gives.
#[derive(Debug)]
pub(super) struct Background {
    key: Key,
    /// The lit screen's radiance: three planes, or one where all three would be equal.
    pub lit: Vec<Vec<f32>>,
    /// The screen's albedo.
    albedo: PixelAlbedo,
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

/// What a lit screen was made for.
#[derive(Debug)]
struct Key {
    screen: Screen,
    lamp_m: glam::DVec3,
    emitters: Vec<Emitter>,
    view: View,
    dome: bool,
}

impl Key {
    fn new(theatre: &Theatre, view: &View) -> Self {
        Self {
            screen: theatre.screen.clone(),
            lamp_m: theatre.lamp.position_m,
            emitters: theatre.lamp.emitters.clone(),
            view: *view,
            dome: matches!(theatre.ambient, Ambient::Dome { .. }),
        }
    }

    /// Whether pixels see the same cloth.
    fn same_cloth(&self, other: &Self) -> bool {
        let albedo = match (&self.screen.albedo, &other.screen.albedo) {
            (Albedo::Uniform(a), Albedo::Uniform(b)) => a == b,
            (Albedo::Image(a), Albedo::Image(b)) => std::sync::Arc::ptr_eq(a, b),
            _ => false,
        };
        albedo && self.view.size == other.view.size && self.view.pixel == other.view.pixel
    }

    /// Whether what was made for this one serves the other; a dome asks for its albedo.
    fn serves(&self, other: &Self) -> bool {
        let same = |(a, b): (&Emitter, &Emitter)| a.shape == b.shape && a.radiance == b.radiance;
        self.same_cloth(other)
            && self.screen.width_m == other.screen.width_m
            && self.screen.height_m == other.screen.height_m
            && self.lamp_m == other.lamp_m
            && self.emitters.len() == other.emitters.len()
            && self.emitters.iter().zip(&other.emitters).all(same)
            && (self.dome || !other.dome)
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
        self.key.serves(&Key::new(theatre, view))
    }

    /// Draws the screen without puppets. Of the one before it takes the memory and, with `keep`, what holds still.
    pub(super) fn new(theatre: &Theatre, view: &View, before: Option<Self>, keep: bool) -> Self {
        let emitters = &theatre.lamp.emitters;
        let key = Key::new(theatre, view);
        let (kept, mut spare) = before.map(|b| b.into_parts(&key)).unwrap_or_default();
        let albedo = kept.filter(|_| keep).unwrap_or_else(|| albedo::on_grid(&theatre.screen, view));
        let units: Vec<_> = emitters
            .iter()
            .map(|e| UnitRows::new(&e.shape, key.lamp_m, &theatre.screen, view.size))
            .collect();
        let grey = albedo.is_grey()
            && emitters.iter().all(|e| e.radiance[0] == e.radiance[1] && e.radiance[1] == e.radiance[2]);
        // One colour: any channel in which something shines carries all shares.
        let bright = (0..3).find(|c| emitters.iter().any(|e| e.radiance[*c] > 0.0)).unwrap_or(0);
        let share_channels: &[usize] = if one_colour(emitters) { &[bright] } else { &[0, 1, 2] };
        let rest = emitters.iter().rposition(|e| e.radiance != [0.0; 3]).unwrap_or(emitters.len() - 1);
        let [w, h] = view.size;
        let mut plane = || {
            let spare = spare.pop().filter(|plane: &Vec<f32>| plane.len() == w * h);
            spare.unwrap_or_else(|| vec![0f32; w * h])
        };
        let channels = if grey { 1 } else { 3 };
        let mut lit: Vec<_> = (0..channels).map(|_| plane()).collect();
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
            total.resize(channels * w, 0.0);
            total.fill(0.0);
            for ((unit, rows), emitter) in unit.chunks_mut(w).zip(&units).zip(emitters) {
                rows.row(j, unit);
                for (total, radiance) in total.chunks_mut(w).zip(emitter.radiance) {
                    loops::add(total, radiance, unit);
                }
            }
            let total = |c: usize| &total[c.min(channels - 1) * w..][..w];
            for (c, lit) in row.lit.iter_mut().enumerate() {
                match &albedo {
                    PixelAlbedo::Uniform(a) => loops::reflect(lit, &vec![a[c]; w], total(c)),
                    PixelAlbedo::Image(image) => {
                        loops::reflect(lit, &image.channel(c)[j * w..][..w], total(c));
                    }
                }
            }
            for (e, c, share) in &mut row.share {
                loops::share(share, emitters[*e].radiance[*c], &unit[*e * w..][..w], total(*c));
            }
        };
        rows.into_par_iter().enumerate().for_each_init(Default::default, draw);
        Self { key, lit, albedo, rest, share, encoded: None }
    }

    /// The albedo, where pixels see the cloth that they see in `key`, and planes whose memory may be used.
    fn into_parts(self, key: &Key) -> (Option<PixelAlbedo>, Vec<Vec<f32>>) {
        let planes = self.share.into_iter().flatten().chain(self.lit).collect();
        (self.key.same_cloth(key).then_some(self.albedo), planes)
    }

    /// The albedo where the dome, whose light is added, asks for it.
    pub(super) fn dome_albedo(&self) -> Option<&PixelAlbedo> {
        self.key.dome.then_some(&self.albedo)
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
        // Rows of a moderate size, for threads to share.
        const PART: usize = 1 << 14;
        let (n, part) = (self.lit(0).len(), |c: usize| self.lit(c).par_chunks(PART));
        let codes = if self.lit.len() == 1 {
            let mut codes = vec![0; n];
            let parts = codes.par_chunks_mut(PART).zip(part(0));
            parts.for_each(|(out, lit)| loops::encode(srgb, lit, scale, out));
            Codes::Grey(codes)
        } else {
            let mut codes = vec![0; n];
            let parts = codes.par_chunks_mut(PART).zip(part(0)).zip(part(1)).zip(part(2));
            parts.for_each(|(((out, r), g), b)| loops::encode_colour(srgb, [r, g, b], scale, out));
            Codes::Colour(codes)
        };
        self.encoded = Some((white, codes));
        false
    }

    /// Writes the lit screen's display codes of `pixels`; [`encode`](Self::encode) must have made them.
    pub(super) fn copy_lit(&self, pixels: std::ops::Range<usize>, out: &mut [u32]) {
        match &self.encoded {
            Some((_, Codes::Grey(codes))) => loops::widen(&codes[pixels], out),
            Some((_, Codes::Colour(codes))) => out.copy_from_slice(&codes[pixels]),
            None => {}
        }
    }
}
