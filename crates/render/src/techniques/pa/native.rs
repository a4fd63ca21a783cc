//! PA on all cores.

use std::ops::Range;
use std::sync::Arc;
use std::time::Instant;

use glam::DVec2;
use kelir_scene::{Ambient, Mask, Theatre};
use rayon::prelude::*;

use super::background::Background;
use super::dome::{self, DomeLight, DomeMap};
use super::plan::{Lookup, Plan};
use super::rows::Combined;
use super::table::{Sums, Table};
use super::{Knobs, Weights, shadow_map};
use crate::encode::{Srgb, pack};
use crate::project::pixel_m;
use crate::simd::{Isa, multiversion};
use crate::{Frame, Layer, RenderError, Renderer, Stats, View, ambient};

/// Columns and rows of a tile: what is classified as lit, dark or penumbra at once.
const TILE: [usize; 2] = [32, 8];

/// PA's native renderer: keeps tables and the lit screen between drawings.
#[derive(Debug)]
pub struct Native {
    knobs: Knobs,
    tables: Vec<Kept>,
    background: Option<Background>,
    domes: Vec<DomeMap>,
}

/// A table and the mask it was made from.
#[derive(Debug)]
struct Kept {
    mask: Arc<Mask>,
    channel: usize,
    table: Table,
}

impl Kept {
    fn wide(&self) -> bool {
        matches!(self.table.sums, Sums::U64(_))
    }
}

/// What a tile sees of one plane from one piece in one channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    Lit,
    Dark,
    Penumbra,
}

/// What a tile's pixels need.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// The lit screen, as it is.
    Lit,
    /// Nothing: every emitter is hidden and there is no other light.
    Black,
    /// Look-ups, or at least shading.
    Shade,
}

/// Where finished pixels go.
enum Sink<'a> {
    Display { white: f64, out: &'a mut [u32] },
    Radiance { radiance: [&'a mut [f32]; 3], layers: Vec<&'a mut [f32]> },
}

/// The same for one band of rows.
enum Band<'a> {
    Display { white: f64, out: &'a mut [u32] },
    Radiance { radiance: [&'a mut [f32]; 3], layers: Vec<&'a mut [f32]> },
}

/// Everything a band reads.
struct Job<'a> {
    theatre: &'a Theatre,
    view: &'a View,
    weights: Weights,
    plan: &'a Plan,
    /// Tables of look-up `l` in channel `c` at `l * plan.channels + c`.
    tables: Vec<&'a Table>,
    background: &'a Background,
    /// Shading factors differ between channels: 3, else 1.
    shades: usize,
    /// Whether the sink wants every emitter's visibility.
    layers: bool,
    /// Light from the dome, where there is one.
    dome: Option<DomeLight<'a>>,
}

/// Counts of one band.
#[derive(Clone, Copy, Debug, Default)]
struct Counts {
    lit_copied: u64,
    dark: u64,
    penumbra: u64,
    looked_up: u64,
}

impl Counts {
    fn plus(self, other: Self) -> Self {
        Self {
            lit_copied: self.lit_copied + other.lit_copied,
            dark: self.dark + other.dark,
            penumbra: self.penumbra + other.penumbra,
            looked_up: self.looked_up + other.looked_up,
        }
    }
}

/// Rows of floats that a band works in.
#[derive(Default)]
struct Scratch {
    combined: Combined,
    states: Vec<State>,
    /// One look-up's transmittances, at sub-pixels.
    one: Vec<f32>,
    /// Product of the planes' transmittances for one piece, at sub-pixels.
    product: Vec<f32>,
    /// Its sum over each pixel's sub-pixels.
    mean: Vec<f32>,
    /// Visibility of emitter e in channel c at `(e * channels + c) * width`.
    visibility: Vec<f32>,
    /// For paper ambient with several planes: Σ share · opacity of plane i in shade channel c at `(i * shades + c) * width`.
    own: Vec<f32>,
    /// Shading factor of channel c at `c * width`.
    shade: Vec<f32>,
    /// Weights of the current piece at each pixel.
    piece: Vec<f32>,
}

impl Native {
    /// Nothing is built before the first drawing.
    pub fn new(knobs: Knobs) -> Self {
        Self { knobs, tables: Vec::new(), background: None, domes: Vec::new() }
    }

    /// Makes `self.tables` hold what `plan` needs and no other; returns the index of each look-up's tables.
    fn build_tables(&mut self, theatre: &Theatre, plan: &Plan, stats: &mut Stats) -> Vec<usize> {
        let mut needed: Vec<(usize, usize)> = Vec::new();
        for &p in &plan.planes {
            needed.extend((0..theatre.planes[p].mask.channels).map(|c| (p, c)));
        }
        let serves = |kept: &Kept, &(p, c): &(usize, usize)| {
            kept.mask.id == theatre.planes[p].mask.id && kept.channel == c && kept.wide() == plan.wide[p]
        };
        let (keep, mut spare): (Vec<Kept>, Vec<Kept>) = std::mem::take(&mut self.tables)
            .into_iter()
            .partition(|kept| needed.iter().any(|n| serves(kept, n)));
        self.tables = keep;
        let mut built = 0;
        for need in &needed {
            if self.tables.iter().any(|kept| serves(kept, need)) {
                continue;
            }
            let mask = &theatre.planes[need.0].mask;
            let old = spare
                .iter()
                .position(|k| k.wide() == plan.wide[need.0] && k.table.width == mask.width)
                .map(|i| spare.swap_remove(i).table);
            let table = Table::new(mask, need.1, plan.wide[need.0], old);
            self.tables.push(Kept { mask: mask.clone(), channel: need.1, table });
            built += 1;
        }
        stats.counts.insert("tables_built".into(), built);
        stats.counts.insert("tables_reused".into(), needed.len() as u64 - built);
        let find = |p: usize, c: usize| {
            let need = (p, c % theatre.planes[p].mask.channels);
            self.tables.iter().position(|kept| serves(kept, &need)).unwrap_or(0)
        };
        plan.lookups
            .iter()
            .flat_map(|l| (0..plan.channels).map(move |c| (l.plane, c)))
            .map(|(p, c)| find(p, c))
            .collect()
    }

    fn draw(&mut self, theatre: &Theatre, view: &View, sink: Sink) -> Result<Stats, RenderError> {
        let mut stats = Stats::default();
        let mut clock = Instant::now();
        let mut step = |stats: &mut Stats, name: &str| {
            stats.steps_ms.push((name.into(), clock.elapsed().as_secs_f64() * 1e3));
            clock = Instant::now();
        };
        let theatre = &*shadow_map::seen(theatre, &self.knobs);
        let plan = Plan::new(theatre, view, &self.knobs)?;
        stats.counts.insert("planes".into(), plan.planes.len() as u64);
        stats.counts.insert("planes_off_beam".into(), (theatre.planes.len() - plan.planes.len()) as u64);
        let dark = theatre.lamp.emitters.iter().filter(|e| e.radiance == [0.0; 3]).count();
        stats.counts.insert("emitters_dark".into(), dark as u64);
        step(&mut stats, "plan");
        let tables = self.build_tables(theatre, &plan, &mut stats);
        step(&mut stats, "tables");
        let reused = self.background.as_ref().is_some_and(|b| b.serves(theatre, view));
        let mut background = match self.background.take() {
            Some(background) if reused => background,
            _ => Background::new(theatre, view),
        };
        stats.counts.insert("background_reused".into(), u64::from(reused));
        if let Sink::Display { white, .. } = sink
            && view.skip
        {
            background.encode(white);
        }
        step(&mut stats, "background");
        if let Ambient::Dome { .. } = theatre.ambient {
            let built = dome::prepare(theatre, &mut self.domes);
            stats.counts.insert("domes_built".into(), built);
            step(&mut stats, "dome");
        }
        let coloured = matches!(theatre.ambient, Ambient::Paper { s: [r, g, b], .. } if r != g || g != b);
        let job = Job {
            theatre,
            view,
            weights: self.knobs.weights,
            plan: &plan,
            tables: tables.iter().map(|t| &self.tables[*t].table).collect(),
            background: &background,
            shades: if coloured { 3 } else { plan.channels.max(background.share_channels()) },
            layers: matches!(sink, Sink::Radiance { .. }),
            dome: match theatre.ambient {
                Ambient::Dome { radiance } => Some(DomeLight::new(theatre, radiance, &self.domes)),
                _ => None,
            },
        };
        let counts = job.run(sink);
        for (name, count) in [
            ("pixels_lit_copied", counts.lit_copied),
            ("pixels_dark", counts.dark),
            ("pixels_penumbra", counts.penumbra),
            ("boxes", counts.looked_up),
        ] {
            stats.counts.insert(name.into(), count);
        }
        step(&mut stats, "pixels");
        self.background = Some(background);
        Ok(stats)
    }
}

impl Renderer for Native {
    fn radiance(&mut self, theatre: &Theatre, view: &View) -> Result<Frame, RenderError> {
        super::plan::check_view(theatre, view)?;
        let pixels = view.size[0] * view.size[1];
        let mut radiance = [0, 1, 2].map(|_| vec![0f32; pixels]);
        let coloured = theatre.planes.iter().any(|p| p.mask.channels == 3);
        let kind = if self.knobs.weights == Weights::Area { "Vgeo" } else { "Virr" };
        let names = theatre.lamp.emitters.iter().flat_map(|e| {
            let suffixes: &[&str] = if coloured { &[".R", ".G", ".B"] } else { &[""] };
            suffixes.iter().map(move |s| format!("{kind}.{}{s}", e.name))
        });
        let mut layers: Vec<Layer> = names.map(|name| Layer { name, values: vec![0.0; pixels] }).collect();
        let [r, g, b] = &mut radiance;
        let sink = Sink::Radiance {
            radiance: [r, g, b],
            layers: layers.iter_mut().map(|l| &mut l.values[..]).collect(),
        };
        let stats = self.draw(theatre, view, sink)?;
        Ok(Frame { size: view.size, radiance, layers, stats })
    }

    fn display(
        &mut self,
        theatre: &Theatre,
        view: &View,
        white: f64,
        out: &mut [u32],
    ) -> Result<Stats, RenderError> {
        super::plan::check_view(theatre, view)?;
        if out.len() != view.size[0] * view.size[1] {
            return Err(RenderError::View(format!(
                "{} pixels given for {}x{}",
                out.len(),
                view.size[0],
                view.size[1]
            )));
        }
        if !(white.is_finite() && white > 0.0) {
            return Err(RenderError::View(format!("white = {white}: a radiance above 0")));
        }
        self.draw(theatre, view, Sink::Display { white, out })
    }

    fn adapter(&self) -> String {
        format!("native {} threads {}", rayon::current_num_threads(), Isa::detect().name())
    }
}

impl Job<'_> {
    fn run(&self, sink: Sink) -> Counts {
        let w = self.view.size[0];
        let rows = TILE[1];
        let bands: Vec<Band> = match sink {
            Sink::Display { white, out } => {
                out.chunks_mut(rows * w).map(|out| Band::Display { white, out }).collect()
            }
            Sink::Radiance { radiance: [r, g, b], layers } => {
                let mut layers: Vec<_> = layers.into_iter().map(|l| l.chunks_mut(rows * w)).collect();
                let rgb = r.chunks_mut(rows * w).zip(g.chunks_mut(rows * w)).zip(b.chunks_mut(rows * w));
                rgb.map(|((r, g), b)| Band::Radiance {
                    radiance: [r, g, b],
                    layers: layers.iter_mut().filter_map(Iterator::next).collect(),
                })
                .collect()
            }
        };
        let counts = bands
            .into_par_iter()
            .enumerate()
            .map_init(Scratch::default, |scratch, (k, band)| self.band(k * rows, band, scratch));
        counts.reduce(Counts::default, Counts::plus)
    }

    /// State of look-up `l` in channel `c` over sub-pixel columns × rows, from the sum over every texel they touch.
    fn classify(&self, l: usize, c: usize, columns: Range<usize>, rows: Range<usize>) -> State {
        let (lookup, table) = (&self.plan.lookups[l], self.tables[l * self.plan.channels + c]);
        if let Some(frame) = &lookup.tilted {
            let size = self.view.size.map(|side| side * self.plan.sub);
            let edge =
                |i: usize, j: usize| pixel_m(&self.theatre.screen, size, i as f64 - 0.5, j as f64 - 0.5);
            let tile = [edge(columns.start, rows.start), edge(columns.end, rows.end)];
            return tilted_state(table, frame.range(tile, &self.plan.pieces[lookup.piece]));
        }
        let x = lookup.x.touched(columns.clone(), table.width);
        let y = lookup.y.touched(rows.clone(), table.height);
        let area = ((x[1] - x[0]) * (y[1] - y[0])) as u64;
        let full = area * u64::from(table.max_code);
        if area == 0 {
            return State::Lit;
        }
        // A u32 table knows the sum modulo 2³² only.
        if matches!(table.sums, Sums::U32(_)) && full >= 1 << 32 {
            return State::Penumbra;
        }
        match table.sum(x, y) {
            0 => State::Lit,
            s if s == full
                && lookup.x.inside(columns, table.width)
                && lookup.y.inside(rows, table.height) =>
            {
                State::Dark
            }
            _ => State::Penumbra,
        }
    }

    fn band(&self, first: usize, mut band: Band, scratch: &mut Scratch) -> Counts {
        let ([w, h], sub, skip) = (self.view.size, self.plan.sub, self.view.skip);
        let rows = first..(first + TILE[1]).min(h);
        let tiles = w.div_ceil(TILE[0]);
        let columns = |t: usize| t * TILE[0]..((t + 1) * TILE[0]).min(w);
        let entries = self.tables.len();
        let channels = self.plan.channels;
        scratch.states.clear();
        scratch.states.resize(tiles * entries, State::Penumbra);
        for t in 0..tiles {
            for e in (0..self.plan.lookups.len()).rev().flat_map(|l| l * channels..(l + 1) * channels) {
                let (c, r) = (columns(t), &rows);
                let known = |e: usize| scratch.states[t * entries + e];
                let within =
                    self.plan.lookups[e / channels].within.map(|l| known(l * channels + e % channels));
                let state = if !skip {
                    State::Penumbra
                } else if e % channels > 0 && std::ptr::eq(self.tables[e], self.tables[e - 1]) {
                    known(e - 1)
                } else if let Some(state) = within.filter(|state| *state != State::Penumbra) {
                    state
                } else {
                    self.classify(
                        e / channels,
                        e % channels,
                        c.start * sub..c.end * sub,
                        r.start * sub..r.end * sub,
                    )
                };
                scratch.states[t * entries + e] = state;
            }
        }
        let states = std::mem::take(&mut scratch.states);
        let mut counts = Counts::default();
        // Runs of tiles of the same kind, the same for every row: (kind, columns).
        let kind = |t: usize| {
            let of = &states[t * entries..(t + 1) * entries];
            match () {
                () if !skip || self.dome.is_some() => Kind::Shade,
                () if of.iter().all(|s| *s == State::Lit) => Kind::Lit,
                () if of.iter().all(|s| *s == State::Dark) && self.theatre.ambient == Ambient::None => {
                    Kind::Black
                }
                () => Kind::Shade,
            }
        };
        let mut runs: Vec<(Kind, Range<usize>)> = Vec::new();
        for t in 0..tiles {
            match runs.last_mut() {
                Some((last, run)) if *last == kind(t) => run.end = columns(t).end,
                _ => runs.push((kind(t), columns(t))),
            }
        }
        for j in rows.clone() {
            let at = (j - first) * w;
            for (kind, span) in &runs {
                match (&mut band, kind) {
                    (Band::Display { out, .. }, Kind::Lit) => {
                        let pixels = j * w + span.start..j * w + span.end;
                        self.background.copy_lit(pixels, &mut out[at + span.start..at + span.end]);
                        counts.lit_copied += span.len() as u64;
                    }
                    (Band::Display { out, .. }, Kind::Black) => {
                        out[at + span.start..at + span.end].fill(pack(0, 0, 0));
                        counts.dark += span.len() as u64;
                    }
                    _ => {
                        counts.looked_up += self.visibility(j, span.clone(), &states, scratch);
                        if !self.emit_grey(j, at, span.clone(), scratch, &mut band) {
                            self.shade(j, span.clone(), scratch);
                            self.emit(j, at, span.clone(), scratch, &mut band);
                        }
                        counts.penumbra += span.len() as u64;
                    }
                }
            }
        }
        scratch.states = states;
        counts
    }

    /// Transmittances of one look-up in one channel (entry `e`) at the sub-pixels of `span` of sub-row `row`.
    fn transmittance(
        &self,
        e: usize,
        row: usize,
        span: &Range<usize>,
        states: &[State],
        combined: &mut Combined,
        out: &mut [f32],
    ) -> u64 {
        let (sub, entries) = (self.plan.sub, self.tables.len());
        let (lookup, table): (&Lookup, &Table) = (&self.plan.lookups[e / self.plan.channels], self.tables[e]);
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
                        *out = 1.0 - frame.opacity(table, piece, p) as f32;
                        boxes += 1;
                    }
                }
            }
            return boxes;
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
        boxes
    }

    /// Visibilities of every emitter at the pixels of `span` of row `j`; returns how many boxes were looked up.
    fn visibility(&self, j: usize, span: Range<usize>, states: &[State], scratch: &mut Scratch) -> u64 {
        let (plan, n) = (self.plan, span.len());
        let (emitters, channels) = (self.theatre.lamp.emitters.len(), plan.channels);
        let own = matches!(self.theatre.ambient, Ambient::Paper { .. }) && plan.planes.len() > 1;
        scratch.visibility.resize(emitters * channels * n, 0.0);
        if own {
            scratch.own.clear();
            scratch.own.resize(plan.planes.len() * self.shades * n, 0.0);
        }
        let mut boxes = 0;
        for e in 0..emitters {
            let dark = !self.layers && self.theatre.lamp.emitters[e].radiance == [0.0; 3];
            for c in 0..channels {
                let mut rows = std::mem::take(&mut scratch.visibility);
                let row = &mut rows[(e * channels + c) * n..][..n];
                if dark && self.view.skip {
                    row.fill(1.0);
                } else if plan.sub == 1 && !own && plan.pieces.len() == emitters {
                    boxes += self.whole(e, c, j, &span, states, scratch, row);
                } else {
                    boxes += self.pieced(e, c, j, &span, states, scratch, row);
                }
                scratch.visibility = rows;
            }
        }
        boxes
    }

    /// Visibility of an emitter in one piece: the product of its planes' transmittances.
    #[allow(clippy::too_many_arguments)]
    fn whole(
        &self,
        e: usize,
        c: usize,
        j: usize,
        span: &Range<usize>,
        states: &[State],
        scratch: &mut Scratch,
        out: &mut [f32],
    ) -> u64 {
        let channels = self.plan.channels;
        let mut boxes = 0;
        let mut first = true;
        for (l, _) in self.plan.lookups.iter().enumerate().filter(|(_, l)| l.piece == e) {
            if first {
                boxes += self.transmittance(l * channels + c, j, span, states, &mut scratch.combined, out);
            } else {
                let one = &mut scratch.one;
                one.resize(span.len(), 0.0);
                boxes += self.transmittance(l * channels + c, j, span, states, &mut scratch.combined, one);
                multiply(out, one);
            }
            first = false;
        }
        if first {
            out.fill(1.0);
        }
        boxes
    }

    /// The same of an emitter in pieces, or of pixels in parts.
    #[allow(clippy::too_many_arguments)]
    fn pieced(
        &self,
        e: usize,
        c: usize,
        j: usize,
        span: &Range<usize>,
        states: &[State],
        scratch: &mut Scratch,
        out: &mut [f32],
    ) -> u64 {
        let (plan, n, sub) = (self.plan, span.len(), self.plan.sub);
        let own = !scratch.own.is_empty();
        let mut boxes = 0;
        let mut weights = vec![0f32; n];
        out.fill(0.0);
        let pieces = || (0..plan.pieces.len()).filter(|p| plan.pieces[*p].emitter == e);
        for p in pieces() {
            self.piece_weights(p, j, span, &mut scratch.piece);
            weights.iter_mut().zip(&scratch.piece).for_each(|(s, w)| *s += w);
        }
        for p in pieces() {
            self.piece_weights(p, j, span, &mut scratch.piece);
            let mut mean = std::mem::take(&mut scratch.mean);
            mean.clear();
            mean.resize(n, 0.0);
            for row in j * sub..(j + 1) * sub {
                scratch.product.clear();
                scratch.product.resize(n * sub, 1.0);
                for (l, lookup) in plan.lookups.iter().enumerate().filter(|(_, l)| l.piece == p) {
                    scratch.one.resize(n * sub, 0.0);
                    let entry = l * plan.channels + c;
                    boxes +=
                        self.transmittance(entry, row, span, states, &mut scratch.combined, &mut scratch.one);
                    multiply(&mut scratch.product, &scratch.one);
                    if own {
                        self.add_own((lookup.plane, e, c), j, span, &weights, scratch);
                    }
                }
                for (m, v) in mean.iter_mut().zip(scratch.product.chunks_exact(sub)) {
                    *m += v.iter().sum::<f32>();
                }
            }
            // All sums are of whole numbers where everything is lit, so that all lit stays exactly 1.
            for ((v, m), w) in out.iter_mut().zip(&mean).zip(&scratch.piece) {
                *v += w * (m / (sub * sub) as f32);
            }
            scratch.mean = mean;
        }
        out.iter_mut().zip(&weights).for_each(|(v, w)| *v = (*v / w).min(1.0));
        boxes
    }

    /// How much piece `p` counts at each pixel of `span`; pieces of one emitter are divided by their sum later.
    fn piece_weights(&self, p: usize, j: usize, span: &Range<usize>, out: &mut Vec<f32>) {
        let piece = &self.plan.pieces[p];
        out.clear();
        match self.weights {
            Weights::Area => out.resize(span.len(), piece.weight as f32),
            Weights::Irradiance => {
                let shape = kelir_scene::EmitterShape::Rectangle { size_m: piece.size_m };
                // Relative to its share of the area over the squared distance, so that f32 keeps any scale.
                let scale = piece.weight * piece.centre_m.z * piece.centre_m.z / shape.area_m2();
                out.extend(span.clone().map(|i| {
                    let at = pixel_m(&self.theatre.screen, self.view.size, i as f64, j as f64);
                    (crate::irradiance::unit(&shape, piece.centre_m, at) * scale) as f32
                }));
            }
        }
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

    /// Shading and display codes of the plainest scenes in one pass: grey light, one or two emitters, one plane where ambient
    /// light asks for its distance. Same bits as [`shade`](Self::shade) and [`emit`](Self::emit); false where it does not apply.
    fn emit_grey(&self, j: usize, at: usize, span: Range<usize>, scratch: &Scratch, band: &mut Band) -> bool {
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
    fn shade(&self, j: usize, span: Range<usize>, scratch: &mut Scratch) {
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
    fn emit(&self, j: usize, at: usize, span: Range<usize>, scratch: &Scratch, band: &mut Band) {
        let n = span.len();
        let row = j * self.view.size[0];
        let pixels = row + span.start..row + span.end;
        let to = at + span.start..at + span.end;
        let shade = |c: usize| &scratch.shade[c.min(self.shades - 1) * n..][..n];
        let lit = |c: usize| &self.background.lit(c)[pixels.clone()];
        let mut added = [0, 1, 2].map(|_| Vec::new());
        if let Some(dome) = &self.dome {
            let albedo = |c: usize, k: usize| self.background.albedo.as_ref().map_or(0.0, |a| a.at(c, k));
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

/// State of everything between texel coordinates `low` and `high`. The box that stands for a quadrilateral may stick out of its hull
/// by its own size at most.
fn tilted_state(table: &Table, [low, high]: [DVec2; 2]) -> State {
    let grid = DVec2::new(table.width as f64, table.height as f64);
    let slack = (high - low).abs();
    let (low, high) = ((low - slack).floor(), (high + slack).ceil());
    let inside = low.cmpge(DVec2::ZERO).all() && high.cmple(grid).all();
    let (low, high) = (low.clamp(DVec2::ZERO, grid), high.clamp(DVec2::ZERO, grid));
    if low.cmpge(high).any() {
        return State::Lit;
    }
    let (x, y) = ([low.x as usize, high.x as usize], [low.y as usize, high.y as usize]);
    let full = ((x[1] - x[0]) * (y[1] - y[0])) as u64 * u64::from(table.max_code);
    match table.sum(x, y) {
        0 => State::Lit,
        s if s == full && inside => State::Dark,
        _ => State::Penumbra,
    }
}

#[inline(always)]
fn multiply_generic(product: &mut [f32], by: &[f32]) {
    for (p, b) in product.iter_mut().zip(by) {
        *p *= b;
    }
}
multiversion! { fn multiply(product: &mut [f32], by: &[f32]) = multiply_generic; }

#[inline(always)]
fn grey_one_generic(srgb: &Srgb, lit: &[f32], rest: &[f32], pale: f32, scale: f32, out: &mut [u32]) {
    for ((out, lit), x) in out.iter_mut().zip(lit).zip(rest) {
        let x = x + (1.0 - x) * pale;
        *out = 0xff00_0000 | (srgb.code(lit * x * scale) * 0x01_0101);
    }
}
multiversion! {
    fn grey_one(srgb: &Srgb, lit: &[f32], rest: &[f32], pale: f32, scale: f32, out: &mut [u32]) = grey_one_generic;
}

#[inline(always)]
#[allow(clippy::too_many_arguments)]
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
    fn grey_two(srgb: &Srgb, lit: &[f32], rest: &[f32], other: &[f32], share: &[f32], pale: f32, scale: f32, out: &mut [u32]) = grey_two_generic;
}

#[inline(always)]
fn mix_generic(shade: &mut [f32], visibility: &[f32], rest: &[f32], share: &[f32]) {
    for (((x, v), rest), share) in shade.iter_mut().zip(visibility).zip(rest).zip(share) {
        *x += share * (v - rest);
    }
}
multiversion! { fn mix(shade: &mut [f32], visibility: &[f32], rest: &[f32], share: &[f32]) = mix_generic; }

#[inline(always)]
fn encode_grey_generic(srgb: &Srgb, lit: &[f32], shade: &[f32], scale: f32, out: &mut [u32]) {
    for ((out, lit), shade) in out.iter_mut().zip(lit).zip(shade) {
        *out = 0xff00_0000 | (srgb.code(lit * shade * scale) * 0x01_0101);
    }
}
multiversion! { fn encode_grey(srgb: &Srgb, lit: &[f32], shade: &[f32], scale: f32, out: &mut [u32]) = encode_grey_generic; }

#[inline(always)]
fn encode_colour_generic(srgb: &Srgb, lit: [&[f32]; 3], shade: [&[f32]; 3], scale: f32, out: &mut [u32]) {
    let n = out.len();
    let (lit, shade) = (lit.map(|l| &l[..n]), shade.map(|s| &s[..n]));
    for k in 0..n {
        let code = |c: usize| srgb.code(lit[c][k] * shade[c][k] * scale);
        out[k] = pack(code(0), code(1), code(2));
    }
}
multiversion! { fn encode_colour(srgb: &Srgb, lit: [&[f32]; 3], shade: [&[f32]; 3], scale: f32, out: &mut [u32]) = encode_colour_generic; }
