//! What every emitter gives every pixel of a row: tables looked up, planes multiplied, pieces averaged.

use std::ops::Range;

use kelir_scene::Ambient;

use super::loops::multiply;
use super::{Counts, Job, Scratch};
use crate::pa::Skips;
use crate::pa::plan::Lookup;
use crate::pa::rows::Combined;
use crate::pa::table::Table;
use crate::pa::tiles::{State, TILE};
use crate::project::pixel_m;

impl Job<'_> {
    /// Visibilities of every emitter at the pixels of `span` of row `j`.
    pub(super) fn visibility(&self, j: usize, span: &Range<usize>, states: &[State], scratch: &mut Scratch) {
        let (plan, n) = (self.plan, span.len());
        let (emitters, channels) = (self.theatre.lamp.emitters.len(), plan.channels);
        let own = matches!(self.theatre.ambient, Ambient::Paper { .. }) && plan.planes.len() > 1;
        scratch.visibility.resize(emitters * channels * n, 0.0);
        if own {
            scratch.own.clear();
            scratch.own.resize(plan.planes.len() * self.shades * n, 0.0);
        }
        let mut rows = std::mem::take(&mut scratch.visibility);
        for e in 0..emitters {
            let dark = !self.layers && self.theatre.lamp.emitters[e].radiance == [0.0; 3];
            let rows = &mut rows[e * channels * n..(e + 1) * channels * n];
            if dark && self.skips.has(Skips::DARK_EMITTERS) {
                rows.fill(1.0);
            } else if plan.sub == 1 && !own && plan.pieces.len() == emitters {
                self.whole(e, j, span, states, scratch, rows);
            } else {
                self.pieced(e, j, span, states, scratch, rows);
            }
        }
        scratch.visibility = rows;
    }

    /// Channels of look-up `l` that are looked up: the first stands for all where its puppet is grey.
    fn distinct(&self, l: usize) -> usize {
        let grey = self.theatre.planes[self.plan.lookups[l].plane].mask.channels == 1;
        if grey && self.skips.has(Skips::GREY_CHANNELS) { 1 } else { self.plan.channels }
    }

    /// Visibilities of an emitter in one piece, channel after channel: the product of its planes' transmittances.
    fn whole(
        &self,
        e: usize,
        j: usize,
        span: &Range<usize>,
        states: &[State],
        scratch: &mut Scratch,
        rows: &mut [f32],
    ) {
        let (n, channels) = (span.len(), self.plan.channels);
        let Scratch { combined, counts, one, .. } = scratch;
        let mut first = true;
        for (l, _) in self.plan.lookups.iter().enumerate().filter(|(_, l)| l.piece == e) {
            let distinct = self.distinct(l);
            counts.shared += ((channels - distinct) * n) as u64;
            for c in 0..distinct {
                let of = if distinct == 1 { 0..channels } else { c..c + 1 };
                let entry = l * channels + c;
                if first {
                    let row = c * n..(c + 1) * n;
                    self.transmittance(entry, j, span, states, combined, counts, &mut rows[row.clone()]);
                    of.skip(1).for_each(|c| rows.copy_within(row.clone(), c * n));
                } else {
                    one.resize(n, 0.0);
                    self.transmittance(entry, j, span, states, combined, counts, one);
                    of.for_each(|c| multiply(&mut rows[c * n..(c + 1) * n], one));
                }
            }
            first = false;
        }
        if first {
            rows.fill(1.0);
        }
    }

    /// The same of an emitter in pieces, or of pixels in parts.
    fn pieced(
        &self,
        e: usize,
        j: usize,
        span: &Range<usize>,
        states: &[State],
        scratch: &mut Scratch,
        rows: &mut [f32],
    ) {
        let (plan, n, sub, channels) = (self.plan, span.len(), self.plan.sub, self.plan.channels);
        let own = !scratch.own.is_empty();
        let mut weights = vec![0f32; n];
        rows.fill(0.0);
        let pieces = || (0..plan.pieces.len()).filter(|p| plan.pieces[*p].emitter == e);
        let add = |weights: &mut [f32], piece: &[f32]| {
            weights.iter_mut().zip(piece).for_each(|(s, w)| *s += w);
        };
        // A puppet's own shadow asks for the sum of all weights before the first piece.
        for p in pieces().filter(|_| own) {
            self.piece_weights(p, j, span, &mut scratch.unit, &mut scratch.piece);
            add(&mut weights, &scratch.piece);
        }
        for p in pieces() {
            self.piece_weights(p, j, span, &mut scratch.unit, &mut scratch.piece);
            if !own {
                add(&mut weights, &scratch.piece);
            }
            let mut mean = std::mem::take(&mut scratch.mean);
            mean.clear();
            mean.resize(channels * n, 0.0);
            for row in j * sub..(j + 1) * sub {
                scratch.product.clear();
                scratch.product.resize(channels * n * sub, 1.0);
                for (l, lookup) in plan.lookups.iter().enumerate().filter(|(_, l)| l.piece == p) {
                    scratch.one.resize(n * sub, 0.0);
                    let distinct = self.distinct(l);
                    scratch.counts.shared += ((channels - distinct) * n * sub) as u64;
                    for c in 0..distinct {
                        let Scratch { combined, counts, one, .. } = scratch;
                        self.transmittance(l * channels + c, row, span, states, combined, counts, one);
                        for c in if distinct == 1 { 0..channels } else { c..c + 1 } {
                            multiply(&mut scratch.product[c * n * sub..(c + 1) * n * sub], &scratch.one);
                            if own {
                                self.add_own((lookup.plane, e, c), j, span, &weights, scratch);
                            }
                        }
                    }
                }
                if sub == 1 {
                    mean.copy_from_slice(&scratch.product);
                    continue;
                }
                for (m, v) in mean.iter_mut().zip(scratch.product.chunks_exact(sub)) {
                    *m += v.iter().sum::<f32>();
                }
            }
            // All sums are of whole numbers where everything is lit, so that all lit stays exactly 1.
            for (row, mean) in rows.chunks_exact_mut(n).zip(mean.chunks_exact(n)) {
                for ((v, m), w) in row.iter_mut().zip(mean).zip(&scratch.piece) {
                    *v += w * (m / (sub * sub) as f32);
                }
            }
            scratch.mean = mean;
        }
        for row in rows.chunks_exact_mut(n) {
            row.iter_mut().zip(&weights).for_each(|(v, w)| *v = (*v / w).min(1.0));
        }
    }

    /// Transmittances of one look-up in one channel (entry `e`) at the sub-pixels of `span` of sub-row `row`.
    #[allow(clippy::too_many_arguments, reason = "what an inner loop reads, each in a register")]
    fn transmittance(
        &self,
        e: usize,
        row: usize,
        span: &Range<usize>,
        states: &[State],
        combined: &mut Combined,
        counts: &mut Counts,
        out: &mut [f32],
    ) {
        let (sub, entries) = (self.plan.sub, self.tiles.tables.len());
        let (lookup, table): (&Lookup, &Table) =
            (&self.plan.lookups[e / self.plan.channels], self.tiles.tables[e]);
        let all = out.len() as u64;
        let mut boxes = 0;
        if let Some(frame) = &lookup.tilted {
            let piece = &self.plan.pieces[lookup.piece];
            let size = self.view.size.map(|side| side * sub);
            for (out, x) in out.iter_mut().zip(span.start * sub..) {
                match states[(x / sub / TILE[0]) * entries + e] {
                    State::Lit => *out = 1.0,
                    State::Dark => *out = 0.0,
                    State::Penumbra => {
                        let p = pixel_m(&self.theatre.screen, size, x as f64, row as f64);
                        *out = 1.0 - table.opacity(frame, piece, p) as f32;
                        boxes += 1;
                    }
                }
            }
            counts.looked_up += boxes;
            counts.known += all - boxes;
            return;
        }
        let mut x = span.start;
        while x < span.end {
            let from = x;
            let state = states[(x / TILE[0]) * entries + e];
            while x < span.end && states[(x / TILE[0]) * entries + e] == state {
                x = ((x / TILE[0] + 1) * TILE[0]).min(span.end);
            }
            let out = &mut out[(from - span.start) * sub..(x - span.start) * sub];
            match state {
                State::Lit => out.fill(1.0),
                State::Dark => out.fill(0.0),
                State::Penumbra => {
                    combined.combine(table, lookup, row, from * sub..x * sub);
                    combined.look_up(lookup, from * sub..x * sub, out);
                    boxes += out.len() as u64;
                }
            }
        }
        counts.looked_up += boxes;
        counts.known += all - boxes;
    }

    /// How much piece `p` counts at each pixel of `span`; pieces of one emitter are divided by their sum later.
    fn piece_weights(
        &self,
        p: usize,
        j: usize,
        span: &Range<usize>,
        unit: &mut Vec<f64>,
        out: &mut Vec<f32>,
    ) {
        let piece = &self.plan.pieces[p];
        out.clear();
        let Some(rows) = self.piece_units.get(p) else {
            return out.resize(span.len(), piece.weight as f32);
        };
        // Relative to its share of the area over the squared distance, so that f32 keeps any scale.
        let [w, h] = piece.size_m;
        let scale = piece.weight * piece.centre_m.z * piece.centre_m.z / (w * h);
        unit.resize(span.len(), 0.0);
        rows.span(j, span.start, unit);
        out.extend(unit.iter().map(|unit| (unit * scale) as f32));
    }

    /// Adds share · mean opacity of one look-up to its plane's own shadow.
    fn add_own(
        &self,
        (plane, emitter, c): (usize, usize, usize),
        j: usize,
        span: &Range<usize>,
        weights: &[f32],
        scratch: &mut Scratch,
    ) {
        let (n, sub, w) = (span.len(), self.plan.sub, self.view.size[0]);
        let Some(i) = self.plan.planes.iter().position(|p| *p == plane) else { return };
        let (emitters, rest) = (self.theatre.lamp.emitters.len(), self.background.rest);
        for shade in 0..self.shades {
            // One mask channel answers for all shades, or each for its own.
            if self.plan.channels > 1 && shade != c {
                continue;
            }
            let own = &mut scratch.own[(i * self.shades + shade) * n..][..n];
            for (k, own) in own.iter_mut().enumerate() {
                let at = j * w + span.start + k;
                let share = if emitter != rest {
                    self.background.share(emitter, shade)[at]
                } else {
                    let others = (0..emitters).filter(|e| *e != rest);
                    1.0 - others.map(|e| self.background.share(e, shade)[at]).sum::<f32>()
                };
                let mean: f32 = scratch.one[k * sub..(k + 1) * sub].iter().map(|v| 1.0 - v).sum();
                *own += share * mean * (scratch.piece[k] / weights[k]) / (sub * sub) as f32;
            }
        }
    }
}
