//! PA on all cores.

use std::time::Instant;

use kelir_frame::encode::pack;
use kelir_frame::{Frame, Isa, RenderError, Renderer, Stats, View, check_display};
use kelir_scene::{Ambient, EmitterShape, Theatre};
use rayon::prelude::*;

use super::background::Background;
use super::dome::{self, DomeLight, DomeMap};
use super::kept::Tables;
use super::plan::Plan;
use super::rows::Combined;
use super::tiles::{Kind, State, TILE, Tiles};
use super::{Knobs, Skips, Weights, shadow_map};
use crate::emitters::{each_visibility, emitters};
use crate::irradiance::UnitRows;
use crate::project::sides_m;
use crate::project::tilted::Piece;

mod loops;
mod shading;
mod visibility;

/// PA's native renderer: keeps tables and the lit screen between drawings.
#[derive(Debug)]
pub struct Native {
    knobs: Knobs,
    skips: Skips,
    tables: Tables,
    background: Option<Background>,
    domes: Vec<DomeMap>,
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
    /// Where pieces weigh by what they give a pixel: E⁰ of each.
    piece_units: Vec<UnitRows>,
    skips: Skips,
    plan: &'a Plan,
    tiles: Tiles<'a>,
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
    known: u64,
    shared: u64,
}

impl Counts {
    fn plus(self, other: Self) -> Self {
        Self {
            lit_copied: self.lit_copied + other.lit_copied,
            dark: self.dark + other.dark,
            penumbra: self.penumbra + other.penumbra,
            looked_up: self.looked_up + other.looked_up,
            known: self.known + other.known,
            shared: self.shared + other.shared,
        }
    }
}

/// Rows of floats that a band works in.
#[derive(Default)]
struct Scratch {
    combined: Combined,
    states: Vec<State>,
    counts: Counts,
    /// One look-up's transmittances, at sub-pixels.
    one: Vec<f32>,
    /// Product of the planes' transmittances for one piece, at sub-pixels, channel after channel.
    product: Vec<f32>,
    /// Its sum over each pixel's sub-pixels, channel after channel.
    mean: Vec<f32>,
    /// Visibility of emitter e in channel c at `(e * channels + c) * width`.
    visibility: Vec<f32>,
    /// For paper ambient with several planes: Σ share · opacity of plane i in shade channel c at `(i * shades + c) * width`.
    own: Vec<f32>,
    /// Shading factor of channel c at `c * width`.
    shade: Vec<f32>,
    /// Weights of the current piece at each pixel.
    piece: Vec<f32>,
    /// What they are made of.
    unit: Vec<f64>,
}

fn units_of(piece: &Piece, theatre: &Theatre, view: &View) -> UnitRows {
    let shape = EmitterShape::Rectangle { size_m: piece.size_m };
    UnitRows::new(&shape, piece.centre_m, &theatre.screen, view.size)
}

impl Native {
    /// Nothing is built before the first drawing.
    pub fn new(knobs: Knobs) -> Self {
        Self::with_skips(knobs, Skips::ALL)
    }

    /// Leaves out only what is in `skips`, for tests and for measuring what each saves.
    pub fn with_skips(knobs: Knobs, skips: Skips) -> Self {
        Self { knobs, skips, tables: Tables::default(), background: None, domes: Vec::new() }
    }

    fn draw(&mut self, theatre: &Theatre, view: &View, sink: Sink) -> Result<Stats, RenderError> {
        let mut stats = Stats::default();
        let mut clock = Instant::now();
        let mut step = |stats: &mut Stats, name: &str| {
            stats.steps_ms.push((name.into(), clock.elapsed().as_secs_f64() * 1e3));
            clock = Instant::now();
        };
        let theatre = &*shadow_map::seen(theatre, &self.knobs);
        let skips = if view.skip { self.skips } else { Skips::NONE };
        let layers = matches!(&sink, Sink::Radiance { layers, .. } if !layers.is_empty());
        let off_beam = skips.has(Skips::OFF_BEAM);
        let plan = if off_beam {
            Plan::new(theatre, view, &self.knobs)?
        } else {
            Plan::with_planes_off_beam(theatre, view, &self.knobs)?
        };
        stats.counts.insert("planes".into(), plan.planes.len() as u64);
        let absent = if off_beam { theatre.planes.len() - plan.planes.len() } else { 0 };
        stats.counts.insert("planes_off_beam".into(), absent as u64);
        let dark = theatre.lamp.emitters.iter().filter(|e| e.radiance == [0.0; 3]).count();
        let dark = if skips.has(Skips::DARK_EMITTERS) && !layers { dark } else { 0 };
        stats.counts.insert("emitters_dark".into(), dark as u64);
        step(&mut stats, "plan");
        self.tables.prepare(theatre, &plan, skips.has(Skips::KEPT_TABLES), &mut stats);
        step(&mut stats, "tables");
        let keep = skips.has(Skips::KEPT_SCREEN);
        if !keep {
            self.domes.clear();
        }
        let reused = keep && self.background.as_ref().is_some_and(|b| b.serves(theatre, view));
        let mut background = match self.background.take() {
            Some(background) if reused => background,
            before => Background::new(theatre, view, before, keep),
        };
        stats.counts.insert("background_reused".into(), u64::from(reused));
        if let Sink::Display { white, .. } = sink
            && skips.has(Skips::LIT_TILES)
        {
            background.encode(white);
        }
        step(&mut stats, "background");
        if let Ambient::Dome { .. } = theatre.ambient {
            let built = dome::prepare(theatre, self.knobs.dome_steps, &mut self.domes);
            stats.counts.insert("domes_built".into(), built);
            step(&mut stats, "dome");
        }
        let coloured = matches!(theatre.ambient, Ambient::Paper { s: [r, g, b], .. } if r != g || g != b);
        let job = Job {
            theatre,
            view,
            piece_units: match self.knobs.weights {
                Weights::Area => Vec::new(),
                Weights::Irradiance => {
                    plan.pieces.iter().map(|piece| units_of(piece, theatre, view)).collect()
                }
            },
            skips,
            plan: &plan,
            tiles: Tiles { theatre, view, plan: &plan, skips, tables: self.tables.of(theatre, &plan) },
            background: &background,
            shades: if coloured { 3 } else { plan.channels.max(background.share_channels()) },
            layers,
            dome: match theatre.ambient {
                Ambient::Dome { radiance } => {
                    Some(DomeLight::new(theatre, radiance, self.knobs.dome_steps, &self.domes))
                }
                _ => None,
            },
        };
        let counts = job.run(sink);
        for (name, count) in [
            ("pixels_lit_copied", counts.lit_copied),
            ("pixels_dark", counts.dark),
            ("pixels_penumbra", counts.penumbra),
            ("boxes", counts.looked_up),
            ("boxes_known", counts.known),
            ("boxes_shared", counts.shared),
        ] {
            stats.counts.insert(name.into(), count);
        }
        step(&mut stats, "pixels");
        self.background = Some(background);
        Ok(stats)
    }
}

impl Renderer<Theatre> for Native {
    fn frame(&mut self, theatre: &Theatre, view: &View, visibilities: bool) -> Result<Frame, RenderError> {
        view.check(sides_m(&theatre.screen))?;
        let pixels = view.size[0] * view.size[1];
        let mut radiance = [0, 1, 2].map(|_| vec![0f32; pixels]);
        let names = emitters(theatre).filter(|_| visibilities);
        let mut visibilities =
            each_visibility(theatre, names, self.knobs.weights.model(), |_, _| vec![0.0; pixels]);
        let [r, g, b] = &mut radiance;
        let sink = Sink::Radiance {
            radiance: [r, g, b],
            layers: visibilities.iter_mut().map(|v| &mut v.values[..]).collect(),
        };
        let stats = self.draw(theatre, view, sink)?;
        Ok(Frame { size: view.size, radiance, visibilities, standard_error: None, stats })
    }

    fn display(
        &mut self,
        theatre: &Theatre,
        view: &View,
        white: f64,
        out: &mut [u32],
    ) -> Result<Stats, RenderError> {
        view.check(sides_m(&theatre.screen))?;
        check_display(view, white, out)?;
        self.draw(theatre, view, Sink::Display { white, out })
    }

    fn adapter(&self) -> String {
        Isa::native()
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

    fn band(&self, first: usize, mut band: Band, scratch: &mut Scratch) -> Counts {
        let [w, h] = self.view.size;
        let rows = first..(first + TILE[1]).min(h);
        let mut states = std::mem::take(&mut scratch.states);
        self.tiles.see(&rows, &mut states);
        let runs = self.tiles.runs(&states);
        if !self.skips.has(Skips::KNOWN_BOXES) {
            states.fill(State::Penumbra);
        }
        for j in rows {
            let at = (j - first) * w;
            for (kind, span) in &runs {
                match (&mut band, kind) {
                    (Band::Display { out, .. }, Kind::Lit) => {
                        let pixels = j * w + span.start..j * w + span.end;
                        self.background.copy_lit(pixels, &mut out[at + span.start..at + span.end]);
                        scratch.counts.lit_copied += span.len() as u64;
                    }
                    (Band::Display { out, .. }, Kind::Black) => {
                        out[at + span.start..at + span.end].fill(pack(0, 0, 0));
                        scratch.counts.dark += span.len() as u64;
                    }
                    _ => {
                        self.visibility(j, span, &states, scratch);
                        if !self.emit_grey(j, at, span.clone(), scratch, &mut band) {
                            self.shade(j, span.clone(), scratch);
                            self.emit(j, at, span.clone(), scratch, &mut band);
                        }
                        scratch.counts.penumbra += span.len() as u64;
                    }
                }
            }
        }
        scratch.states = states;
        std::mem::take(&mut scratch.counts)
    }
}
