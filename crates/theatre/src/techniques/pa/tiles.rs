//! Tiles: what each sees of each plane, before any of its pixels is looked up.

use std::ops::Range;

use glam::DVec2;
use kelir_frame::View;
use kelir_scene::{Ambient, Theatre};

use super::Skips;
use super::plan::Plan;
use super::table::{Sums, Table};
use crate::project::pixel_m;

/// Columns and rows of a tile: what is classified as lit, dark or penumbra at once.
pub(super) const TILE: [usize; 2] = [32, 8];

/// What a tile sees of one plane from one piece in one channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum State {
    /// All light comes through.
    Lit,
    /// None does.
    Dark,
    /// Neither is known.
    Penumbra,
}

/// What a tile's pixels need.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// The lit screen, as it is.
    Lit,
    /// Nothing: every emitter is hidden and there is no other light.
    Black,
    /// Look-ups, or at least shading.
    Shade,
}

/// What tiles are told apart by.
pub(super) struct Tiles<'a> {
    /// The scene.
    pub theatre: &'a Theatre,
    /// The image.
    pub view: &'a View,
    /// Its boxes.
    pub plan: &'a Plan,
    /// What is left out.
    pub skips: Skips,
    /// Tables of look-up `l` in channel `c` at `l * plan.channels + c`.
    pub tables: Vec<&'a Table>,
}

impl Tiles<'_> {
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

    /// What every tile of a band sees of every look-up in every channel, at `tile * entries + entry`.
    pub(super) fn see(&self, rows: &Range<usize>, states: &mut Vec<State>) {
        let (sub, channels, entries) = (self.plan.sub, self.plan.channels, self.tables.len());
        let tiles = self.view.size[0].div_ceil(TILE[0]);
        states.clear();
        states.resize(tiles * entries, State::Penumbra);
        if !self.skips.has(Skips::LIT_TILES)
            && !self.skips.has(Skips::DARK_TILES)
            && !self.skips.has(Skips::KNOWN_BOXES)
        {
            return;
        }
        let rows = rows.start * sub..rows.end * sub;
        for (t, states) in states.chunks_exact_mut(entries.max(1)).enumerate() {
            let columns = self.columns(t);
            for e in (0..self.plan.lookups.len()).rev().flat_map(|l| l * channels..(l + 1) * channels) {
                let within =
                    self.plan.lookups[e / channels].within.map(|l| states[l * channels + e % channels]);
                states[e] = if e % channels > 0 && std::ptr::eq(self.tables[e], self.tables[e - 1]) {
                    states[e - 1]
                } else if let Some(state) = within.filter(|state| *state != State::Penumbra) {
                    state
                } else {
                    let columns = columns.start * sub..columns.end * sub;
                    self.classify(e / channels, e % channels, columns, rows.clone())
                };
            }
        }
    }

    /// Columns of a tile, pixels.
    fn columns(&self, tile: usize) -> Range<usize> {
        tile * TILE[0]..((tile + 1) * TILE[0]).min(self.view.size[0])
    }

    /// What a tile needs that sees `states`.
    pub(super) fn kind(&self, states: &[State]) -> Kind {
        let all = |state: State, skip: Skips| self.skips.has(skip) && states.iter().all(|s| *s == state);
        match self.theatre.ambient {
            Ambient::Dome { .. } => Kind::Shade,
            _ if all(State::Lit, Skips::LIT_TILES) => Kind::Lit,
            Ambient::None if !states.is_empty() && all(State::Dark, Skips::DARK_TILES) => Kind::Black,
            _ => Kind::Shade,
        }
    }

    /// Runs of tiles of the same kind, the same for every row of a band: kind and columns.
    pub(super) fn runs(&self, states: &[State]) -> Vec<(Kind, Range<usize>)> {
        let entries = self.tables.len();
        let kind = |t: usize| self.kind(&states[t * entries..(t + 1) * entries]);
        let mut runs: Vec<(Kind, Range<usize>)> = Vec::new();
        for t in 0..self.view.size[0].div_ceil(TILE[0]) {
            match runs.last_mut() {
                Some((last, run)) if *last == kind(t) => run.end = self.columns(t).end,
                _ => runs.push((kind(t), self.columns(t))),
            }
        }
        runs
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
