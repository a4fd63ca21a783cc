//! From tiles to pixels: what the host writes itself, and where the device's answers belong.

use kelir_frame::Stats;
use kelir_frame::encode::pack;
use rayon::prelude::*;

use super::targets::CELLS;
use super::work::{ACROSS, Stage, Tile, Work};
use crate::pa::background::Background;
use crate::pa::tiles::{Kind, TILE};

/// Pixels of each kind, and boxes.
pub(super) fn count(stage: &Stage, work: &Work, stats: &mut Stats) {
    let [w, h] = work.size;
    let across = w.div_ceil(TILE[0]);
    let mut pixels = [0u64; 3];
    for (k, kind) in stage.kinds.iter().enumerate() {
        let [x, y] = [k % across * TILE[0], k / across * TILE[1]];
        let at = match kind {
            Kind::Lit => 0,
            Kind::Black => 1,
            Kind::Shade => 2,
        };
        pixels[at] += (TILE[0].min(w - x) * TILE[1].min(h - y)) as u64;
    }
    let sub = work.plan.sub;
    let boxes = stage.boxes() * (work.plan.channels * TILE[0] * TILE[1] * sub * sub) as u64;
    for (name, count) in [
        ("pixels_lit_copied", pixels[0]),
        ("pixels_dark", pixels[1]),
        ("pixels_penumbra", pixels[2]),
        ("boxes", boxes),
    ] {
        stats.counts.insert(name.into(), count);
    }
}

/// Writes the tiles that are not shaded: the lit screen's codes, or black.
pub(super) fn fill(stage: &Stage, background: &Background, width: usize, out: &mut [u32]) {
    let across = width.div_ceil(TILE[0]);
    let rows = out.par_chunks_mut(TILE[1] * width).zip(stage.kinds.par_chunks(across)).enumerate();
    rows.for_each(|(j, (out, kinds))| {
        for (i, row) in out.chunks_exact_mut(width).enumerate() {
            let first = (j * TILE[1] + i) * width;
            for (pixels, kind) in
                row.chunks_mut(TILE[0]).zip(kinds).enumerate().map(|(t, (p, k))| ((t, p), k))
            {
                let (t, pixels) = pixels;
                let at = first + t * TILE[0];
                match kind {
                    Kind::Lit => background.copy_lit(at..at + pixels.len(), pixels),
                    Kind::Black => pixels.fill(pack(0, 0, 0)),
                    Kind::Shade => {}
                }
            }
        }
    });
}

/// Puts answers, four pixels of a column together, where they belong.
pub(super) fn scatter(words: &[u32], tiles: &[Tile], width: usize, out: &mut [u32]) {
    let rows = out.par_chunks_mut(TILE[1] * width).enumerate();
    rows.for_each(|(j, out)| {
        let first = tiles.partition_point(|t| t.home[1] < j * TILE[1]);
        let here = tiles[first..].iter().take_while(|t| t.home[1] == j * TILE[1]);
        for (k, tile) in (first..).zip(here) {
            let count = TILE[0].min(width - tile.home[0]);
            for (i, row) in out.chunks_exact_mut(width).enumerate() {
                let cell = (k / ACROSS * 2 + i / 4) * CELLS + k % ACROSS * TILE[0];
                let answers = words[4 * cell..].chunks_exact(4).map(|four| four[i % 4]);
                row[tile.home[0]..][..count].iter_mut().zip(answers).for_each(|(out, a)| *out = a);
            }
        }
    });
}
