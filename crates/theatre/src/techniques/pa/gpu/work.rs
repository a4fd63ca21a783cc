//! What is drawn in one submission: tiles that need shading, and as many pieces of the lamp as their combined rows have room for.

use std::ops::Range;

use kelir_frame::RenderError;
use kelir_scene::Theatre;
use rayon::prelude::*;

use super::super::dome::DomeLight;
use super::super::plan::{Lookup, Plan};
use super::super::tiles::{Kind, State, TILE, Tiles};
use super::words::{self, Words, vectors};

/// Tiles side by side in a target; a tile takes 32 × 2 fragments of four pixels each.
pub(super) const ACROSS: usize = 64;
/// Blocks side by side in the target of combined rows, and entries of a block, as in the shaders.
pub(super) const SHELF: usize = 64;
pub(super) const BLOCK: usize = 32;
/// Tiles of a batch: a picture of 1920×1080 is one.
pub(super) const MOST_TILES: usize = 8192;
/// Rows of the combined rows' target: 32 MiB.
pub(super) const MOST_ROWS: usize = 1024;
/// Tiles times layers of tilted planes' opacities: 192 MiB.
const MOST_SLOPES: usize = 24 * MOST_TILES;
/// Rows and layers that any adapter has.
const MOST_DIMENSION: usize = 8192;
const MOST_LAYERS: usize = 256;

/// A tile that is shaded.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tile {
    /// Its first pixel.
    pub home: [usize; 2],
}

/// All tiles of an image.
pub(super) struct Stage {
    /// What each tile needs, row by row.
    pub kinds: Vec<Kind>,
    /// Those that are shaded, in order.
    pub shaded: Vec<Tile>,
    /// Whether shaded tile `t` looks up look-up `l`, at `t * lookups + l`.
    needed: Vec<bool>,
    lookups: usize,
}

impl Stage {
    /// Classifies all tiles; `all` are shaded where more than display codes is asked for. Look-ups that are not `active` are never needed.
    pub(super) fn new(tiles: &Tiles, all: bool, active: &[bool]) -> Self {
        let ([w, h], entries) = (tiles.view.size, tiles.tables.len());
        let across = w.div_ceil(TILE[0]);
        let (channels, lookups) = (tiles.plan.channels, tiles.plan.lookups.len());
        let row = |states: &mut Vec<State>, j: usize| {
            let rows = j * TILE[1]..((j + 1) * TILE[1]).min(h);
            tiles.see(&rows, states);
            let (mut kinds, mut needed) = (Vec::with_capacity(across), Vec::new());
            for t in 0..across {
                let states = &states[t * entries..(t + 1) * entries];
                let kind = if all { Kind::Shade } else { tiles.kind(states) };
                kinds.push(kind);
                if kind == Kind::Shade {
                    let any = |l: usize| states[l * channels..][..channels].iter().any(|s| *s != State::Lit);
                    needed.extend((0..lookups).map(|l| active[l] && any(l)));
                }
            }
            (kinds, needed)
        };
        let rows: Vec<_> =
            (0..h.div_ceil(TILE[1])).into_par_iter().map_init(Vec::new, |states, j| row(states, j)).collect();
        let mut stage = Self { kinds: Vec::new(), shaded: Vec::new(), needed: Vec::new(), lookups };
        for (j, (kinds, needed)) in rows.into_iter().enumerate() {
            let shaded = kinds.iter().enumerate().filter(|(_, kind)| **kind == Kind::Shade);
            stage.shaded.extend(shaded.map(|(t, _)| Tile { home: [t * TILE[0], j * TILE[1]] }));
            stage.kinds.extend(kinds);
            stage.needed.extend(needed);
        }
        stage
    }

    fn needs(&self, tile: usize, lookup: usize) -> bool {
        self.needed[tile * self.lookups + lookup]
    }

    /// Boxes that are looked up in one channel.
    pub(super) fn boxes(&self) -> u64 {
        self.needed.iter().filter(|n| **n).count() as u64
    }
}

/// Neighbouring tiles that share combined rows of one look-up: entries `from..=to`.
struct Strip {
    tiles: Range<usize>,
    from: usize,
    to: usize,
}

impl Strip {
    fn blocks(&self) -> usize {
        (self.to - self.from) / BLOCK + 1
    }
}

/// Combined rows of one table: shelves of the target.
pub(super) struct Shelves {
    /// Index into the theatre's planes.
    pub plane: usize,
    pub channel: usize,
    pub range: Range<usize>,
}

/// A tilted plane of a piece: layers of opacities, channel after channel, and where its maps begin among the words.
pub(super) struct Slope {
    /// Index into the plan's look-ups.
    pub lookup: usize,
    pub layer: usize,
    pub channels: usize,
    pub maps: u32,
}

/// One submission's worth.
pub(super) struct Batch {
    /// Of the stage's shaded tiles.
    pub tiles: Range<usize>,
    /// Of the plan's pieces.
    pub pieces: Range<usize>,
    /// Look-ups, piece by piece, each with its strips.
    lookups: Vec<(usize, Vec<Strip>)>,
}

/// A batch's words and where what begins in them.
pub(super) struct Script {
    pub words: Words,
    pub tiles: u32,
    pub stride: u32,
    pub pieces: u32,
    pub lookups: u32,
    pub bounds: u32,
    pub blocks: u32,
    pub distances: u32,
    pub domes: u32,
    pub shelves: Vec<Shelves>,
    pub slopes: Vec<Slope>,
}

/// What batches are made of.
pub(super) struct Work<'a> {
    pub theatre: &'a Theatre,
    pub size: [usize; 2],
    pub plan: &'a Plan,
    pub stage: &'a Stage,
    /// Light from the dome, and where each plane's maps begin in their list.
    pub dome: Option<(DomeLight<'a>, Vec<Vec<u32>>)>,
    /// Look-ups of each piece that are active.
    pub of_piece: Vec<Vec<usize>>,
    /// Weights an end of any column's and row's box.
    pub reach: [usize; 2],
}

impl<'a> Work<'a> {
    pub(super) fn new(
        theatre: &'a Theatre,
        size: [usize; 2],
        plan: &'a Plan,
        stage: &'a Stage,
        active: &[bool],
    ) -> Self {
        let mut of_piece = vec![Vec::new(); plan.pieces.len()];
        for (l, lookup) in plan.lookups.iter().enumerate().filter(|(l, _)| active[*l]) {
            of_piece[lookup.piece].push(l);
        }
        let most =
            |reach: &dyn Fn(usize) -> usize| (0..plan.lookups.len()).map(reach).max().unwrap_or(1).max(1);
        let reach = [most(&|l| plan.lookups[l].x.reach), most(&|l| plan.lookups[l].y.reach)];
        Self { theatre, size, plan, stage, dome: None, of_piece, reach }
    }

    /// Rows of a block in the target of combined rows, four sub-pixel rows each.
    pub(super) fn rows(&self) -> usize {
        TILE[1] / 4 * self.plan.sub
    }

    fn channels(&self, plane: usize) -> usize {
        self.theatre.planes[plane].mask.channels
    }

    /// Layers that a look-up takes: one a channel and sub-pixel of a tilted plane.
    fn layers(&self, l: usize) -> usize {
        let lookup = &self.plan.lookups[l];
        let layers = self.channels(lookup.plane) * self.plan.sub * self.plan.sub;
        if lookup.tilted.is_some() { layers } else { 0 }
    }

    /// All pieces for each run of tiles, in batches whose combined rows take `most_rows` of their target at most.
    pub(super) fn batches(
        &self,
        most_tiles: usize,
        most_rows: usize,
    ) -> Result<Vec<Vec<Batch>>, RenderError> {
        let count = self.stage.shaded.len();
        let mut runs = Vec::new();
        for first in (0..count).step_by(most_tiles) {
            self.split(first..(first + most_tiles).min(count), most_rows / self.rows(), &mut runs)?;
        }
        Ok(runs)
    }

    /// Batches of `tiles`, or of their halves where one piece alone asks for too much.
    fn split(&self, tiles: Range<usize>, most: usize, runs: &mut Vec<Vec<Batch>>) -> Result<(), RenderError> {
        let fits = |blocks: &[usize], layers: usize| {
            let shelf = |(p, blocks): (usize, &usize)| blocks.div_ceil(SHELF) * self.channels(p);
            let shelves = blocks.iter().enumerate().map(shelf).sum::<usize>();
            // A tile alone may take more.
            let most = if tiles.len() == 1 { MOST_DIMENSION / self.rows() } else { most };
            shelves <= most && layers <= MOST_LAYERS && layers * tiles.len() <= MOST_SLOPES
        };
        let mut batches: Vec<Batch> = Vec::new();
        let mut used = (vec![0; self.theatre.planes.len()], 0);
        for p in 0..self.plan.pieces.len() {
            let lookups: Vec<_> = self.of_piece[p].iter().map(|l| (*l, self.strips(*l, &tiles))).collect();
            let mut blocks = vec![0; self.theatre.planes.len()];
            for (l, strips) in &lookups {
                blocks[self.plan.lookups[*l].plane] += strips.iter().map(Strip::blocks).sum::<usize>();
            }
            let layers = lookups.iter().map(|(l, _)| self.layers(*l)).sum::<usize>();
            if !fits(&blocks, layers) {
                if tiles.len() == 1 {
                    let planes = self.theatre.planes.len();
                    return Err(RenderError::Gpu(format!("{planes} puppets at once; use --backend cpu")));
                }
                let middle = tiles.start + tiles.len() / 2;
                self.split(tiles.start..middle, most, runs)?;
                return self.split(middle..tiles.end, most, runs);
            }
            let together: Vec<usize> = used.0.iter().zip(&blocks).map(|(a, b)| a + b).collect();
            match batches.last_mut() {
                Some(batch) if fits(&together, used.1 + layers) => {
                    batch.pieces.end = p + 1;
                    batch.lookups.extend(lookups);
                    used = (together, used.1 + layers);
                }
                _ => {
                    batches.push(Batch { tiles: tiles.clone(), pieces: p..p + 1, lookups });
                    used = (blocks, layers);
                }
            }
        }
        runs.push(batches);
        Ok(())
    }

    fn strips(&self, l: usize, tiles: &Range<usize>) -> Vec<Strip> {
        let lookup = &self.plan.lookups[l];
        let shaded = &self.stage.shaded;
        let mut strips = Vec::new();
        if lookup.tilted.is_some() {
            return strips;
        }
        let mut t = tiles.start;
        while t < tiles.end {
            let first = t;
            t += 1;
            if !self.stage.needs(first, l) {
                continue;
            }
            let next = |t: usize| {
                let [x, y] = shaded[t - 1].home;
                shaded[t].home == [x + TILE[0], y] && self.stage.needs(t, l)
            };
            while t < tiles.end && next(t) {
                t += 1;
            }
            let right = (shaded[t - 1].home[0] + TILE[0]).min(self.size[0]);
            let columns = shaded[first].home[0] * self.plan.sub..right * self.plan.sub;
            let [from, to] = lookup.x.touched(columns, self.theatre.planes[lookup.plane].mask.width);
            strips.push(Strip { tiles: first..t, from, to });
        }
        strips
    }

    /// The words of a batch.
    pub(super) fn script(&self, batch: &Batch) -> Script {
        let mut words = Words::default();
        let plan = self.plan;
        // Shelves: plane by plane, channel by channel, every channel with the same blocks.
        let mut shelves: Vec<Shelves> = Vec::new();
        let mut base = vec![0; self.theatre.planes.len()];
        let mut stride = vec![0; self.theatre.planes.len()];
        for &p in &plan.planes {
            let blocks = batch.lookups.iter().filter(|(l, _)| plan.lookups[*l].plane == p);
            let blocks: usize = blocks.flat_map(|(_, strips)| strips).map(Strip::blocks).sum();
            let count = blocks.div_ceil(SHELF);
            let first = shelves.last().map_or(0, |s| s.range.end);
            (base[p], stride[p]) = (first * SHELF, if self.channels(p) > 1 { count * SHELF } else { 0 });
            for channel in (0..self.channels(p)).filter(|_| count > 0) {
                let first = first + channel * count;
                shelves.push(Shelves { plane: p, channel, range: first..first + count });
            }
        }
        let mut blocks = vec![[0; 4]; shelves.last().map_or(1, |s| s.range.end) * SHELF];
        let per_tile = 1 + batch.lookups.len();
        let mut tiles = vec![[0; 4]; batch.tiles.len() * per_tile];
        for (k, t) in batch.tiles.clone().enumerate() {
            let [x, y] = self.stage.shaded[t].home;
            tiles[k * per_tile] = [x as u32, y as u32, 0, 0];
        }
        let mut lookups = Vec::with_capacity(batch.lookups.len());
        let (mut slopes, mut layers) = (Vec::new(), 0);
        for (n, (l, strips)) in batch.lookups.iter().enumerate() {
            let lookup = &plan.lookups[*l];
            let (p, mask) = (lookup.plane, &self.theatre.planes[lookup.plane].mask);
            let place = plan.planes.iter().position(|q| *q == p).unwrap_or(0) as u32;
            if let Some(frame) = &lookup.tilted {
                let shaded = &self.stage.shaded[batch.tiles.clone()];
                let map = |tile: &Tile| words::slope(self.theatre, self.size, plan, lookup, frame, tile.home);
                let maps: Vec<_> = shaded.par_iter().with_min_len(64).map(map).collect();
                let maps = words.extend(maps.into_iter().flatten());
                let (channels, stride) = (self.channels(p), plan.sub * plan.sub);
                lookups.push([0, if channels > 1 { stride as u32 } else { 0 }, 1 << 16 | place, 0]);
                slopes.push(Slope { lookup: *l, layer: layers, channels, maps });
                (0..batch.tiles.len()).for_each(|t| tiles[t * per_tile + 1 + n][0] = layers as u32);
                layers += self.layers(*l);
                continue;
            }
            let cut = cut(lookup, mask.max_code());
            let scale = lookup.norm * lookup.x.width * 2f64.powi(cut as i32);
            let columns = words.extend(words::columns(&lookup.x, self.reach[0], scale));
            let rows = words.extend(words::rows(lookup, mask.height, self.reach[1]));
            lookups.push([columns, stride[p] as u32, place, ((scale / lookup.x.width) as f32).to_bits()]);
            for strip in strips {
                for t in strip.tiles.clone() {
                    tiles[(t - batch.tiles.start) * per_tile + 1 + n] =
                        [base[p] as u32, strip.from as u32, strip.to as u32, 0];
                }
                let y = self.stage.shaded[strip.tiles.start].home[1] * plan.sub;
                let first_row = rows + (y * vectors(self.reach[1])) as u32;
                let last_row = (TILE[1] * plan.sub).min(self.size[1] * plan.sub - y) - 1;
                for b in 0..strip.blocks() {
                    let block = [(strip.from + b * BLOCK) as u32, first_row, last_row as u32, cut];
                    for c in 0..self.channels(p) {
                        blocks[base[p] + c * stride[p] + b] = block;
                    }
                }
                base[p] += strip.blocks();
            }
        }
        let mut next = 0;
        let pieces: Vec<_> = (0..plan.pieces.len())
            .flat_map(|p| {
                let count = if batch.pieces.contains(&p) { self.of_piece[p].len() } else { 0 };
                next += count;
                words::piece(self.theatre, self.size, plan, p, next - count..next)
            })
            .collect();
        let bounds: Vec<_> = (0..self.theatre.lamp.emitters.len())
            .map(|e| {
                let all = self.pieces(e);
                let part = [all.start.max(batch.pieces.start), all.end.min(batch.pieces.end)];
                [part[0], part[1].max(part[0]), all.start, all.end].map(|p| p as u32)
            })
            .collect();
        let distances = plan.planes.iter().map(|p| [(plan.distance_m[*p] as f32).to_bits(), 0, 0, 0]);
        let domes = match &self.dome {
            Some((light, places)) => words::dome(self.theatre, self.size, light, places, &mut words),
            None => Vec::new(),
        };
        Script {
            tiles: words.extend(tiles),
            stride: per_tile as u32,
            pieces: words.extend(pieces),
            lookups: words.extend(lookups),
            bounds: words.extend(bounds),
            blocks: words.extend(blocks),
            distances: words.extend(distances.chain([[0; 4]])),
            domes: words.extend(domes),
            shelves,
            slopes,
            words,
        }
    }

    /// Pieces of emitter `e`.
    pub(super) fn pieces(&self, e: usize) -> Range<usize> {
        let at = |e: usize| self.plan.pieces.partition_point(|p| p.emitter < e);
        at(e)..at(e + 1)
    }
}

/// Bits that combined rows lose so that any box stays under 2³².
fn cut(lookup: &Lookup, max_code: u32) -> u32 {
    let columns = lookup.x.width + lookup.x.reach as f64 + 2.0;
    let largest = columns * lookup.y.width.max(1.0) * f64::from(max_code);
    (largest.log2().ceil() as u32 + lookup.shift).saturating_sub(32).clamp(1, 32)
}
