//! PA on a GPU: the native renderer's plan, tiles and lit screen, its tables and loops in WGSL.
//!
//! The host lists the tiles that see any penumbra, by the bounds that the native code uses; all others it writes itself while the
//! device works. The device builds the tables; one pass combines, for each row of those tiles, the rows of every box in 64-bit
//! fixed point; the next looks up each pixel's boxes from exact integer differences; the last mixes the emitters, adds the ambient
//! light and encodes. Ends and weights of all boxes come from the host in f64, so what is left is the rounding of f32.
//!
//! Every pass draws one triangle over a target whose fragments are the answers, packed without gaps: what a rasteriser spreads over
//! all cores, also a software one, and what a real GPU reads and writes in lines. Only the answers come back.

mod answers;
mod drawing;
mod passes;
mod scenes;
mod screen;
mod tables;
mod targets;
mod twins;
mod words;
mod work;

use std::time::Instant;

use kelir_frame::encode::Srgb;
use kelir_frame::gpu::Gpu;
use kelir_frame::{Frame, RenderError, Renderer, Stats, View, check_display};
use kelir_scene::{Ambient, Theatre};

use super::background::Background;
use super::dome::{self, DomeLight, DomeMap};
use super::kept::Tables;
use super::plan::Plan;
use super::tiles::Tiles;
use super::{Knobs, Skips, Weights, shadow_map};
use crate::emitters::{self, each_visibility};
use crate::project::sides_m;

use answers::{count, fill, scatter};
use passes::Passes;
use passes::Shaders;
use screen::DeviceScreen;
use tables::DeviceTables;
use targets::{CELLS, Host, Layers, List, Target};
pub(crate) use twins::twins;
use words::ROW;
use work::{ACROSS, Batch, MOST_ROWS, MOST_TILES, Stage, Work};

/// PA's GPU renderer: keeps pipelines, tables, the lit screen and targets between drawings.
pub(super) struct OnGpu {
    passes: Passes,
    knobs: Knobs,
    bins: wgpu::TextureView,
    /// Tables on the host tell which tiles are in penumbra.
    tables: Tables,
    device_tables: DeviceTables,
    background: Option<(Background, Option<DeviceScreen>)>,
    domes: Vec<DomeMap>,
    dome_maps: List,
    words: List,
    combined: Target,
    slopes: Target,
    visibility: Layers,
    own: Layers,
    answers: Target,
    host: Host,
    /// Tiles and combined rows of a batch.
    most: [usize; 2],
}

/// Where answers go.
enum Sink<'a> {
    Display {
        white: f64,
        out: &'a mut [u32],
    },
    /// Red, green, blue, then every emitter's visibility in every channel of the plan.
    Radiance(&'a mut Vec<Vec<f32>>),
}

/// What all batches of a frame share.
struct Job<'a> {
    work: &'a Work<'a>,
    weights: Weights,
    screen: &'a DeviceScreen,
    /// The emitter whose share is what the others leave.
    rest: usize,
    /// Channels of the shading, and of each plane's own shadow.
    shades: usize,
    own_channels: usize,
}

/// The renderer for `knobs` on `gpu`.
pub(super) fn renderer(gpu: Gpu, knobs: Knobs) -> Result<Box<dyn Renderer<Theatre>>, RenderError> {
    Ok(Box::new(OnGpu::new(gpu, knobs, &Shaders::default())?))
}

impl OnGpu {
    /// Compiles `shaders`, which are the default ones but for negative controls.
    pub(super) fn new(gpu: Gpu, knobs: Knobs, shaders: &Shaders) -> Result<Self, RenderError> {
        let entries = Srgb::get().entries();
        let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
        let bins = gpu.texture("bins", [entries.len(), 1, 1], wgpu::TextureFormat::R32Uint, usage);
        gpu.write(&bins, 0, bytemuck::cast_slice(entries), 4 * entries.len(), [entries.len(), 1]);
        let new = Self {
            passes: Passes::new(gpu, shaders)?,
            knobs,
            bins: bins.create_view(&Default::default()),
            tables: Tables::default(),
            device_tables: DeviceTables::default(),
            background: None,
            domes: Vec::new(),
            dome_maps: List::default(),
            words: List::default(),
            combined: Target::default(),
            slopes: Target::default(),
            visibility: Layers::default(),
            own: Layers::default(),
            answers: Target::default(),
            host: Host::default(),
            most: [MOST_TILES, MOST_ROWS],
        };
        let mut new = new;
        new.dome_maps.write(&new.passes.gpu, &[0u32; ROW]);
        new.passes.gpu.check()?;
        Ok(new)
    }

    fn draw(&mut self, theatre: &Theatre, view: &View, mut sink: Sink) -> Result<Stats, RenderError> {
        let mut stats = Stats::default();
        let mut clock = Instant::now();
        let mut step = |stats: &mut Stats, name: &str| {
            stats.steps_ms.push((name.into(), clock.elapsed().as_secs_f64() * 1e3));
            clock = Instant::now();
        };
        let theatre = &*shadow_map::seen(theatre, &self.knobs);
        let skips = if view.skip { Skips::ALL } else { Skips::NONE };
        let plan = Plan::new(theatre, view, &self.knobs)?;
        let dark = |e: usize| theatre.lamp.emitters[e].radiance == [0.0; 3];
        let emitters = theatre.lamp.emitters.len();
        for (name, count) in [
            ("planes", plan.planes.len()),
            ("planes_off_beam", theatre.planes.len() - plan.planes.len()),
            ("emitters_dark", (0..emitters).filter(|e| dark(*e)).count()),
        ] {
            stats.counts.insert(name.into(), count as u64);
        }
        step(&mut stats, "plan");
        let keep = skips.has(Skips::KEPT_TABLES);
        self.tables.prepare(theatre, &plan, keep, &mut stats);
        self.device_tables.prepare(&self.passes, theatre, &plan, keep)?;
        step(&mut stats, "tables");
        let keep = skips.has(Skips::KEPT_SCREEN);
        if !keep {
            self.domes.clear();
        }
        let reused = keep && self.background.as_ref().is_some_and(|(b, _)| b.serves(theatre, view));
        stats.counts.insert("background_reused".into(), u64::from(reused));
        let (mut background, screen) = match self.background.take() {
            Some(kept) if reused => kept,
            before => (Background::new(theatre, view, before.map(|(b, _)| b), keep), None),
        };
        let screen = match screen {
            Some(screen) => screen,
            None => DeviceScreen::new(&self.passes.gpu, &background, view.size)?,
        };
        if let Sink::Display { white, .. } = sink
            && skips.has(Skips::LIT_TILES)
        {
            background.encode(white);
        }
        step(&mut stats, "background");
        let places = self.prepare_dome(theatre, &mut stats);
        if places.is_some() {
            step(&mut stats, "dome");
        }
        let display = matches!(sink, Sink::Display { .. });
        // The share of an emitter without radiance is zero: any visibility will do for the picture.
        let idle = |e: usize| display && skips.has(Skips::DARK_EMITTERS) && dark(e);
        let active: Vec<bool> = plan.lookups.iter().map(|l| !idle(plan.pieces[l.piece].emitter)).collect();
        let tiles = Tiles { theatre, view, plan: &plan, skips, tables: self.tables.of(theatre, &plan) };
        let stage = Stage::new(&tiles, !display, &active);
        // Maps are moved out, so that they can be read while targets are drawn to.
        let domes = std::mem::take(&mut self.domes);
        let mut work = Work::new(theatre, view.size, &plan, &stage, &active);
        if let (Ambient::Dome { radiance }, Some(places)) = (theatre.ambient, places) {
            work.dome = Some((DomeLight::new(theatre, radiance, self.knobs.dome_steps, &domes), places));
        }
        let coloured = matches!(theatre.ambient, Ambient::Paper { s: [r, g, b], .. } if r != g || g != b);
        let shades = if coloured { 3 } else { plan.channels.max(screen.share_channels) };
        let paper = matches!(theatre.ambient, Ambient::Paper { .. });
        let job = Job {
            work: &work,
            weights: self.knobs.weights,
            screen: &screen,
            rest: background.rest,
            shades,
            own_channels: if paper && plan.planes.len() > 1 { shades } else { 0 },
        };
        let runs = work.batches(self.most[0], self.most[1])?;
        stats.counts.insert("batches".into(), runs.iter().map(|run| run.len() as u64).sum());
        count(&stage, &work, &mut stats);
        step(&mut stats, "tiles");
        let mut steps = [0.0; 3];
        for (k, run) in runs.iter().enumerate() {
            let first = (k == 0).then_some(&background);
            self.run(&job, run, first, &mut sink, &mut steps)?;
        }
        if let (Sink::Display { out, .. }, []) = (&mut sink, &runs[..]) {
            fill(&stage, &background, view.size[0], out);
        }
        for (name, ms) in ["record", "host", "device"].iter().zip(steps) {
            stats.steps_ms.push(((*name).into(), ms));
        }
        drop(work);
        self.domes = domes;
        self.background = Some((background, Some(screen)));
        Ok(stats)
    }

    /// Makes the dome's maps and uploads them where any is new; where each plane's begin, if there is a dome at all.
    fn prepare_dome(&mut self, theatre: &Theatre, stats: &mut Stats) -> Option<Vec<Vec<u32>>> {
        let Ambient::Dome { radiance } = theatre.ambient else { return None };
        let (steps, before) = (self.knobs.dome_steps, self.domes.len());
        let built = dome::prepare(theatre, steps, &mut self.domes);
        stats.counts.insert("domes_built".into(), built);
        let mut starts = vec![0u32];
        for map in &self.domes {
            starts.push(starts[starts.len() - 1] + map.lattice().0.len() as u32);
        }
        if built > 0 || self.domes.len() != before {
            let mut list: Vec<f32> = self.domes.iter().flat_map(|map| map.lattice().0).copied().collect();
            list.resize(list.len().max(1).next_multiple_of(ROW), 0.0);
            self.dome_maps.write(&self.passes.gpu, &list);
        }
        let light = DomeLight::new(theatre, radiance, steps, &self.domes);
        let place = |map: &DomeMap| {
            let k = self.domes.iter().position(|m| std::ptr::eq(m, map)).unwrap_or(0);
            starts[k]
        };
        Some(light.planes.iter().map(|(_, maps)| maps.iter().map(|m| place(m)).collect()).collect())
    }

    /// Draws one run of tiles. The host writes all tiles that the device does not shade meanwhile, where it is given the `background`.
    fn run(
        &mut self,
        job: &Job,
        run: &[Batch],
        background: Option<&Background>,
        sink: &mut Sink,
        steps: &mut [f64; 3],
    ) -> Result<(), RenderError> {
        let clock = Instant::now();
        let (work, plan) = (job.work, job.work.plan);
        let Some(last) = run.last() else { return Ok(()) };
        let gpu = self.passes.gpu.clone();
        let emitters = work.theatre.lamp.emitters.len();
        let height = 2 * last.tiles.len().div_ceil(ACROSS);
        self.visibility.begin(&gpu, height, emitters * plan.channels);
        self.own.begin(&gpu, height, (plan.planes.len() * job.own_channels).max(1));
        let answers = match sink {
            Sink::Display { .. } => 1,
            Sink::Radiance(planes) => planes.len(),
        };
        let layer = (height * CELLS * 16) as u64;
        for (k, batch) in run.iter().enumerate() {
            let mut script = work.script(batch);
            self.words.write(&gpu, script.words.padded());
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            self.combine(&mut encoder, job, &script);
            self.slope(&mut encoder, job, batch, &script);
            self.add(&mut encoder, job, batch, &script);
            if k + 1 < run.len() {
                gpu.queue.submit([encoder.finish()]);
                gpu.check()?;
                continue;
            }
            self.visibility.settle(&mut encoder);
            self.own.settle(&mut encoder);
            self.answers.reserve(&gpu, "answers", [CELLS, height, 1]);
            let host = self.host.reserve(&gpu, layer * answers as u64);
            for a in 0..answers {
                let texture = match (a, &*sink) {
                    (0..3, _) => {
                        self.shade(&mut encoder, job, batch, &script, a, sink);
                        self.answers.texture().as_image_copy()
                    }
                    _ => self.visibility.copy_of(a - 3),
                };
                encoder.copy_texture_to_buffer(
                    texture,
                    wgpu::TexelCopyBufferInfo {
                        buffer: &host,
                        layout: wgpu::TexelCopyBufferLayout {
                            offset: layer * a as u64,
                            bytes_per_row: Some(16 * CELLS as u32),
                            rows_per_image: None,
                        },
                    },
                    wgpu::Extent3d { width: CELLS as u32, height: height as u32, depth_or_array_layers: 1 },
                );
            }
            let pending = gpu.submit(encoder, &host, layer * answers as u64)?;
            steps[0] += clock.elapsed().as_secs_f64() * 1e3;
            let clock = Instant::now();
            let width = work.size[0];
            if let (Sink::Display { out, .. }, Some(background)) = (&mut *sink, background) {
                fill(work.stage, background, width, out);
            }
            steps[1] += clock.elapsed().as_secs_f64() * 1e3;
            let clock = Instant::now();
            let tiles = &work.stage.shaded[batch.tiles.clone()];
            pending.wait(|bytes| {
                let words: &[u32] = bytemuck::cast_slice(bytes);
                match sink {
                    Sink::Display { out, .. } => scatter(words, tiles, width, out),
                    Sink::Radiance(planes) => {
                        for (plane, words) in planes.iter_mut().zip(words.chunks_exact(layer as usize / 4)) {
                            scatter(words, tiles, width, bytemuck::cast_slice_mut(plane));
                        }
                    }
                }
            })?;
            steps[2] += clock.elapsed().as_secs_f64() * 1e3;
        }
        Ok(())
    }
}

impl Renderer<Theatre> for OnGpu {
    fn frame(&mut self, theatre: &Theatre, view: &View, visibilities: bool) -> Result<Frame, RenderError> {
        view.check(sides_m(&theatre.screen))?;
        let pixels = view.size[0] * view.size[1];
        let emitters = theatre.lamp.emitters.len();
        // All puppets may be off the beam: then one channel answers for the three.
        let channels = Plan::new(&shadow_map::seen(theatre, &self.knobs), view, &self.knobs)?.channels;
        let mut planes = vec![vec![0f32; pixels]; 3 + emitters * channels];
        let stats = self.draw(theatre, view, Sink::Radiance(&mut planes))?;
        let mut planes = planes.into_iter();
        let radiance = [(); 3].map(|()| planes.next().unwrap_or_default());
        let drawn: Vec<_> = planes.collect();
        let names = emitters::emitters(theatre).filter(|_| visibilities);
        let visibilities = each_visibility(theatre, names, self.knobs.weights.model(), |e, c| {
            drawn[e * channels + c.min(channels - 1)].clone()
        });
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

    fn class(&self) -> String {
        self.passes.gpu.class()
    }

    fn adapter(&self) -> String {
        self.passes.gpu.adapter()
    }
}

#[cfg(test)]
mod tests;
