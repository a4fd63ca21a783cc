//! The passes of one batch, in the order they run.

use kelir_scene::Ambient;

use super::passes::{Constants, Pass, RowsParams, ShadeParams, SlopeParams, VisibilityParams};
use super::targets::CELLS;
use super::work::{ACROSS, Batch, SHELF, Script};
use super::{Job, OnGpu, Sink, words};
use crate::pa::Weights;

impl OnGpu {
    /// The rows of every box of a batch.
    pub(super) fn combine(&mut self, encoder: &mut wgpu::CommandEncoder, job: &Job, script: &Script) {
        let work = job.work;
        let rows = work.rows();
        let height = script.shelves.last().map_or(1, |s| s.range.end) * rows;
        self.combined.reserve(&self.passes.gpu, "combined", [SHELF * 32, height, 1]);
        let target = self.combined.layer(0);
        for shelves in &script.shelves {
            let mask = &work.theatre.planes[shelves.plane].mask;
            let wide = work.plan.wide[shelves.plane];
            let shift = work.plan.lookups.iter().find(|l| l.plane == shelves.plane).map_or(32, |l| l.shift);
            let sub = work.plan.sub as u32;
            let constants = vec![("REACH", work.reach[1] as u32), ("SUB", sub), ("WIDE", u32::from(wide))];
            let params = RowsParams {
                blocks: script.blocks,
                width: mask.width as u32,
                height: mask.height as u32,
                shift,
            };
            let table = self.device_tables.of(mask, wide, shelves.channel);
            let range = (shelves.range.start * rows) as u32..(shelves.range.end * rows) as u32;
            let textures = [self.words.view(), table];
            self.passes.run(encoder, (Pass::Combine, &constants), &params, &textures, &target, range);
        }
    }

    /// Opacities of a batch's tilted planes.
    pub(super) fn slope(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        job: &Job,
        batch: &Batch,
        script: &Script,
    ) {
        let (work, sub) = (job.work, job.work.plan.sub);
        let height = 2 * batch.tiles.len().div_ceil(ACROSS);
        let layers = script.slopes.last().map_or(1, |s| s.layer + s.channels * sub * sub);
        self.slopes.reserve(&self.passes.gpu, "slopes", [CELLS, height, layers]);
        for slope in &script.slopes {
            let lookup = &work.plan.lookups[slope.lookup];
            let Some(frame) = &lookup.tilted else { continue };
            let mask = &work.theatre.planes[lookup.plane].mask;
            let wide = work.plan.wide[lookup.plane];
            let constants = vec![("SUB", sub as u32), ("WIDE", u32::from(wide))];
            let [along_x, along_y] = words::along(work.plan, lookup, frame);
            for k in 0..slope.channels * sub * sub {
                let (c, s) = (k / (sub * sub), k % (sub * sub));
                let params = SlopeParams {
                    tiles: script.tiles,
                    count: batch.tiles.len() as u32,
                    maps: slope.maps,
                    width: mask.width as u32,
                    height: mask.height as u32,
                    sub_x: (s % sub) as u32,
                    sub_y: (s / sub) as u32,
                    norm: (1.0 / f64::from(mask.max_code())) as f32,
                    along_x,
                    along_y,
                    ..Default::default()
                };
                let textures = [self.words.view(), self.device_tables.of(mask, wide, c)];
                let target = self.slopes.layer(slope.layer + k);
                let pass = (Pass::Slope, &constants);
                self.passes.run(encoder, pass, &params, &textures, &target, 0..height as u32);
            }
        }
    }

    /// Adds a batch's pieces to their emitters' visibilities, and to the planes' own shadows where they are asked for.
    pub(super) fn add(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        job: &Job,
        batch: &Batch,
        script: &Script,
    ) {
        let (work, plan) = (job.work, job.work.plan);
        let height = 2 * batch.tiles.len().div_ceil(ACROSS) as u32;
        let emitters = work.theatre.lamp.emitters.len();
        let constants = |own: bool, goes_on: bool, ends: bool| -> Constants {
            vec![
                ("REACH", work.reach[0] as u32),
                ("SUB", plan.sub as u32),
                ("IRRADIANCE", u32::from(job.weights == Weights::Irradiance)),
                ("OWN", u32::from(own)),
                ("TILTED", u32::from(!script.slopes.is_empty())),
                ("GOES_ON", u32::from(goes_on)),
                ("ENDS", u32::from(ends)),
            ]
        };
        let combined = self.combined.layer(0);
        for e in 0..emitters {
            let all = work.pieces(e);
            let (from, to) = (all.start.max(batch.pieces.start), all.end.min(batch.pieces.end));
            if from >= to {
                continue;
            }
            let ends = to == all.end;
            let params = VisibilityParams {
                tiles: script.tiles,
                pieces: script.pieces,
                lookups: script.lookups,
                bounds: script.bounds + e as u32,
                stride: script.stride,
                count: batch.tiles.len() as u32,
                right: work.size[0] as u32 - 1,
                shares_step: 1,
                ..Default::default()
            };
            for c in 0..plan.channels {
                let (before, target, goes_on) = self.visibility.turn(&self.passes.gpu, e * plan.channels + c);
                let params = VisibilityParams { channel: c as u32, ..params };
                let textures = [self.words.view(), &combined, &before, &job.screen.view, self.slopes.all()];
                let pass = (Pass::Add, &constants(false, goes_on, ends));
                self.passes.run(encoder, pass, &params, &textures, &target, 0..height);
            }
            for k in 0..plan.planes.len() * job.own_channels {
                let (plane, c) = (k / job.own_channels, k % job.own_channels);
                let (before, target, goes_on) = self.own.turn(&self.passes.gpu, k);
                let channel = c.min(job.screen.share_channels - 1);
                let (shares, end) = match e == job.rest {
                    true => (job.screen.lit_channels, (emitters - 1) * job.screen.share_channels),
                    false => (job.screen.share_layer(e, job.rest), 1),
                };
                let params = VisibilityParams {
                    // A grey scene's only channel answers for all.
                    channel: c.min(plan.channels - 1) as u32,
                    plane: plane as u32,
                    shares: (shares + channel) as u32,
                    shares_end: (shares + end) as u32 + if e == job.rest { 0 } else { channel as u32 },
                    shares_step: job.screen.share_channels as u32,
                    rest: u32::from(e == job.rest),
                    ..params
                };
                let textures = [self.words.view(), &combined, &before, &job.screen.view, self.slopes.all()];
                let pass = (Pass::Add, &constants(true, goes_on, ends));
                self.passes.run(encoder, pass, &params, &textures, &target, 0..height);
            }
        }
    }

    /// Shades a batch: codes, or channel `c` of the radiance.
    pub(super) fn shade(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        job: &Job,
        batch: &Batch,
        script: &Script,
        c: usize,
        sink: &Sink,
    ) {
        let (work, plan) = (job.work, job.work.plan);
        let (k_d, s) = match work.theatre.ambient {
            Ambient::Paper { k_d_m, s } => (k_d_m as f32, s.map(|s| s as f32)),
            _ => (1.0, [0.0; 3]),
        };
        let (pass, white) = match sink {
            Sink::Display { white, .. } => (Pass::Codes, *white),
            Sink::Radiance(_) => (Pass::Radiance, 1.0),
        };
        let constants = vec![
            ("EMITTERS", work.theatre.lamp.emitters.len() as u32),
            ("REST", job.rest as u32),
            ("CHANNELS", plan.channels as u32),
            ("LIT_CHANNELS", job.screen.lit_channels as u32),
            ("SHARE_CHANNELS", job.screen.share_channels as u32),
            ("OWN_CHANNELS", job.own_channels as u32),
            ("PLANES", plan.planes.len() as u32),
            ("GREY", u32::from(job.shades == 1 && job.screen.lit_channels == 1 && work.dome.is_none())),
            ("PAPER", u32::from(matches!(work.theatre.ambient, Ambient::Paper { .. }))),
            ("DOME", u32::from(work.dome.is_some())),
            ("DOME_PLANES", work.dome.as_ref().map_or(0, |(light, _)| light.planes.len() as u32)),
            ("ALBEDO", u32::from(work.dome.is_some() && job.screen.uniform.is_none())),
        ];
        let albedo = job.screen.uniform.unwrap_or([1.0; 3]);
        let dome = match work.theatre.ambient {
            Ambient::Dome { radiance } => [0, 1, 2].map(|c| radiance[c] as f32 * albedo[c]),
            _ => [0.0; 3],
        };
        let params = ShadeParams {
            tiles: script.tiles,
            stride: script.stride,
            count: batch.tiles.len() as u32,
            right: work.size[0] as u32 - 1,
            bottom: work.size[1] as u32 - 1,
            channel: c as u32,
            distances: script.distances,
            scale: (1.0 / white) as f32,
            k_d,
            domes: script.domes,
            s: [s[0], s[1], s[2], 0.0],
            dome: [dome[0], dome[1], dome[2], 0.0],
            ..Default::default()
        };
        let textures = [
            self.words.view(),
            self.visibility.all(),
            self.own.all(),
            &job.screen.view,
            &self.bins,
            self.dome_maps.view(),
        ];
        let height = 2 * batch.tiles.len().div_ceil(ACROSS) as u32;
        self.passes.run(encoder, (pass, &constants), &params, &textures, &self.answers.layer(0), 0..height);
    }
}
