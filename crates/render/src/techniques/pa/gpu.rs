//! PA on a GPU: the native renderer's plan and lit screen, its tables and loops in WGSL.
//!
//! A table holds sums along columns; one pass combines, for each image row, the rows of every box and sums them along x in
//! wrapping u32 fixed point; the next looks up each pixel's boxes from integer differences; the last mixes the emitters,
//! adds the ambient light and encodes. Ends and weights of all boxes come from the CPU in f64. Fixed point costs at most
//! (columns of a box) / 2³² of visibility and f32 a few 1e-7.
//!
//! The image is drawn in bands of rows, so that every buffer stays within the adapter's limits.

use std::sync::Arc;
use std::time::Instant;

use bytemuck::{Pod, Zeroable};
use kelir_scene::{Ambient, Mask, Texels, Theatre};

use super::background::Background;
use super::plan::Plan;
use super::window::Windows;
use super::{Knobs, Weights, plan, shadow_map};
use crate::encode::Srgb;
use crate::gpu::{Gpu, Output};
use crate::{Frame, Layer, RenderError, Renderer, Stats, View};

/// The shaders' texts, in the order they run.
#[derive(Clone, Debug)]
pub struct Shaders {
    pub table: String,
    pub rows: String,
    pub visibility: String,
    pub shade: String,
}

impl Default for Shaders {
    fn default() -> Self {
        Self {
            table: include_str!("table.wgsl").into(),
            rows: include_str!("rows.wgsl").into(),
            visibility: include_str!("visibility.wgsl").into(),
            shade: include_str!("shade.wgsl").into(),
        }
    }
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub(super) struct TableParams {
    pub width: u32,
    pub height: u32,
    pub max_code: u32,
    pub unused: u32,
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub(super) struct RowsParams {
    pub first: u32,
    pub rows: u32,
    pub from_x: u32,
    pub to_x: u32,
    pub height: u32,
    pub reach: u32,
    pub windows: u32,
    pub count: u32,
    pub sums: u32,
    pub interior: f32,
    pub scale: f32,
    pub unused: u32,
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub(super) struct VisibilityParams {
    pub width: u32,
    pub rows: u32,
    pub first: u32,
    pub sub: u32,
    pub start: u32,
    pub end: u32,
    pub channels: u32,
    pub emitter: u32,
    pub emitters: u32,
    pub rest: u32,
    pub share_channels: u32,
    pub own_channels: u32,
    pub by_irradiance: u32,
    pub is_first: u32,
    pub step_x: f32,
    pub step_y: f32,
    pub origin_x: f32,
    pub origin_y: f32,
    pub half_x: f32,
    pub half_y: f32,
}

/// One plane of one piece on the device; the shader's `Lookup`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub(super) struct GpuLookup {
    pub windows: u32,
    pub count: u32,
    pub reach: u32,
    pub sums: u32,
    pub channel: u32,
    pub from_x: u32,
    pub to_x: u32,
    pub plane: u32,
    pub interior: f32,
    pub norm: f32,
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub(super) struct ShadeParams {
    pub width: u32,
    pub rows: u32,
    pub channels: u32,
    pub emitters: u32,
    pub rest: u32,
    pub share_channels: u32,
    pub lit_channels: u32,
    pub planes: u32,
    pub own_channels: u32,
    pub paper: u32,
    pub display: u32,
    pub scale: f32,
    pub k_d: f32,
    pub s_r: f32,
    pub s_g: f32,
    pub s_b: f32,
}

/// Column sums of every channel of a mask.
struct Table {
    mask: Arc<Mask>,
    channels: Vec<wgpu::TextureView>,
}

/// The lit screen of one band of rows on the device.
struct Band {
    first: usize,
    rows: usize,
    lit: wgpu::Buffer,
    share: wgpu::Buffer,
}

/// Buffers that one band after the other uses, and how large they are.
struct Work {
    words: [u64; 5],
    sums: wgpu::Buffer,
    visibility: wgpu::Buffer,
    weights: wgpu::Buffer,
    own: wgpu::Buffer,
    output: Output,
}

/// PA's GPU renderer: keeps pipelines, tables, the lit screen and buffers between drawings.
pub struct OnGpu {
    gpu: Gpu,
    knobs: Knobs,
    table: wgpu::ComputePipeline,
    rows: wgpu::ComputePipeline,
    visibility: wgpu::ComputePipeline,
    shade: wgpu::ComputePipeline,
    tables: Vec<Table>,
    background: Option<Background>,
    bands: Vec<Band>,
    work: Option<Work>,
    /// Words that a buffer may have.
    most_words: usize,
}

/// A look-up as the row pass needs it.
struct RowPass {
    mask: u64,
    height: usize,
    windows: u32,
    count: usize,
    interior: f32,
    scale: f32,
}

/// Everything about one frame that is not one band's.
struct FramePlan {
    plan: Plan,
    lookups: Vec<GpuLookup>,
    passes: Vec<RowPass>,
    /// For each piece the range of its look-ups.
    pieces: Vec<std::ops::Range<usize>>,
    windows: Vec<u32>,
    /// Words of sums a sub-row, of the piece with most.
    sums: usize,
}

impl OnGpu {
    /// Compiles `shaders`, which are the default ones but for tests that need wrong ones.
    pub fn new(gpu: Gpu, knobs: Knobs, shaders: &Shaders) -> Result<Self, RenderError> {
        let limits = gpu.device.limits();
        let pipeline = |label: &str, wgsl: &str, entry: &str| gpu.pipeline(&gpu.module(label, wgsl), entry);
        let new = Self {
            table: pipeline("table.wgsl", &shaders.table, "build"),
            rows: pipeline("rows.wgsl", &shaders.rows, "combine"),
            visibility: pipeline("visibility.wgsl", &shaders.visibility, "add"),
            shade: pipeline("shade.wgsl", &shaders.shade, "shade"),
            knobs,
            tables: Vec::new(),
            background: None,
            bands: Vec::new(),
            work: None,
            most_words: (limits.max_storage_buffer_binding_size.min(limits.max_buffer_size) / 4) as usize,
            gpu,
        };
        new.gpu.check()?;
        Ok(new)
    }

    /// Draws all bands; `take` gets each band's first row, its number of rows and the words that `shade` wrote.
    fn draw(
        &mut self,
        theatre: &Theatre,
        view: &View,
        white: Option<f64>,
        mut take: impl FnMut(usize, usize, &[u32]),
    ) -> Result<Stats, RenderError> {
        let mut stats = Stats::default();
        let mut clock = Instant::now();
        let mut step = |stats: &mut Stats, name: &str| {
            stats.steps_ms.push((name.into(), clock.elapsed().as_secs_f64() * 1e3));
            clock = Instant::now();
        };
        let theatre = &*shadow_map::seen(theatre, &self.knobs);
        let frame = FramePlan::new(theatre, view, &self.knobs)?;
        step(&mut stats, "plan");
        let built = self.build_tables(theatre, &frame.plan)?;
        stats.counts.insert("tables_built".into(), built);
        step(&mut stats, "tables");
        let reused = self.background.as_ref().is_some_and(|b| b.serves(theatre, view));
        if !reused {
            self.background = Some(Background::new(theatre, view));
            self.bands.clear();
        }
        let background = self.background.take().expect("made above");
        stats.counts.insert("background_reused".into(), u64::from(reused));
        let drawn = self.bands(theatre, view, white, &frame, &background, &mut take);
        self.background = Some(background);
        stats.counts.insert("bands".into(), self.bands.len() as u64);
        drawn?;
        step(&mut stats, "pixels");
        Ok(stats)
    }

    /// Builds the tables of masks that are new and forgets those that are gone; tells how many were built.
    fn build_tables(&mut self, theatre: &Theatre, plan: &Plan) -> Result<u64, RenderError> {
        let needed = |id: u64| plan.planes.iter().any(|p| theatre.planes[*p].mask.id == id);
        self.tables.retain(|t| needed(t.mask.id));
        let mut built = 0;
        for p in &plan.planes {
            let mask = &theatre.planes[*p].mask;
            if !self.tables.iter().any(|t| t.mask.id == mask.id) {
                let table = self.build_table(mask)?;
                self.tables.push(table);
                built += 1;
            }
        }
        Ok(built)
    }

    fn build_table(&self, mask: &Arc<Mask>) -> Result<Table, RenderError> {
        let most = self.gpu.device.limits().max_texture_dimension_2d as usize;
        if mask.width > most || mask.height >= most {
            return Err(RenderError::Gpu(format!(
                "a mask of {}x{} texels: {} holds {most}x{}; use --backend cpu",
                mask.width,
                mask.height,
                self.gpu.adapter(),
                most - 1
            )));
        }
        let texture = |height: usize, format, usage| {
            self.gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: Some("mask"),
                size: wgpu::Extent3d {
                    width: mask.width as u32,
                    height: height as u32,
                    depth_or_array_layers: 1,
                },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage,
                view_formats: &[],
            })
        };
        let sampled = wgpu::TextureUsages::TEXTURE_BINDING;
        let (format, bytes): (_, &[u8]) = match &mask.texels {
            Texels::U8(t) => (wgpu::TextureFormat::R8Uint, t),
            Texels::U16(t) => (wgpu::TextureFormat::R16Uint, bytemuck::cast_slice(t)),
        };
        let texel = bytes.len() / (mask.width * mask.height * mask.channels);
        let params = self.gpu.uniform(
            "table",
            &TableParams {
                width: mask.width as u32,
                height: mask.height as u32,
                max_code: mask.max_code(),
                unused: 0,
            },
        );
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let mut channels = Vec::new();
        for plane in bytes.chunks_exact(mask.width * mask.height * texel) {
            let codes = texture(mask.height, format, sampled | wgpu::TextureUsages::COPY_DST);
            self.gpu.queue.write_texture(
                codes.as_image_copy(),
                plane,
                wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some((mask.width * texel) as u32),
                    rows_per_image: None,
                },
                codes.size(),
            );
            let table = texture(
                mask.height + 1,
                wgpu::TextureFormat::R32Uint,
                sampled | wgpu::TextureUsages::STORAGE_BINDING,
            );
            let (codes, table) =
                (codes.create_view(&Default::default()), table.create_view(&Default::default()));
            let bind = self.gpu.bind(
                &self.table,
                &[
                    params.as_entire_binding(),
                    wgpu::BindingResource::TextureView(&codes),
                    wgpu::BindingResource::TextureView(&table),
                ],
            );
            dispatch(&mut encoder, &self.table, &bind, [(mask.width as u32).div_ceil(64), 1]);
            channels.push(table);
        }
        self.gpu.queue.submit([encoder.finish()]);
        self.gpu.check()?;
        Ok(Table { mask: mask.clone(), channels })
    }

    fn bands(
        &mut self,
        theatre: &Theatre,
        view: &View,
        white: Option<f64>,
        frame: &FramePlan,
        background: &Background,
        take: &mut dyn FnMut(usize, usize, &[u32]),
    ) -> Result<(), RenderError> {
        let (plan, [w, h]) = (&frame.plan, view.size);
        let emitters = theatre.lamp.emitters.len();
        let paper = matches!(theatre.ambient, Ambient::Paper { .. });
        let coloured = matches!(theatre.ambient, Ambient::Paper { s: [r, g, b], .. } if r != g || g != b);
        let share_channels = background.share_channels();
        let shades = if coloured { 3 } else { plan.channels.max(share_channels) };
        let own_channels = if paper && plan.planes.len() > 1 { shades } else { 0 };
        let outputs = if white.is_some() { 1 } else { 3 + emitters * plan.channels };
        // Words a row of each buffer; the largest one decides how many rows a band has.
        let lit = background.lit.len() * w;
        let share = emitters * share_channels * w;
        let words = [
            frame.sums * plan.sub,
            emitters * plan.channels * w,
            emitters * w,
            plan.planes.len() * own_channels * w,
            outputs * w,
        ];
        let largest = words.iter().chain([&lit, &share]).max().copied().unwrap_or(1).max(1);
        let most = self.most_words;
        let rows = (most / largest).min(65535).min(h);
        if rows == 0 {
            return Err(RenderError::Gpu(format!("one row of {largest} words is over the limit of {most}")));
        }
        if self.bands.first().is_none_or(|b| b.rows > rows) {
            self.bands = (0..h)
                .step_by(rows)
                .map(|first| self.upload_band(background, emitters, w, first, rows.min(h - first)))
                .collect();
        }
        let words = words.map(|n| (n * self.bands[0].rows) as u64);
        self.reserve(words);
        let lookups = self.gpu.storage("lookups", &frame.lookups_for(self.bands[0].rows));
        let windows = self.gpu.storage("windows", &frame.windows);
        let mut tables: Vec<u32> = Srgb::get().entries().to_vec();
        tables.extend(plan.planes.iter().map(|p| (plan.distance_m[*p] as f32).to_bits()));
        tables.push(0);
        let tables = self.gpu.storage("tables", &tables);
        let Some(work) = &self.work else { unreachable!("reserved above") };
        for band in &self.bands {
            let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
            encoder.clear_buffer(&work.own, 0, None);
            let mut before = usize::MAX;
            for (p, piece) in plan.pieces.iter().enumerate() {
                let dark = theatre.lamp.emitters[piece.emitter].radiance == [0.0; 3];
                // The share of an emitter without radiance is zero: any visibility will do for the picture.
                let range = if dark && white.is_some() && view.skip { 0..0 } else { frame.pieces[p].clone() };
                for l in range.clone() {
                    self.combine(&mut encoder, frame, l, band, &windows, work);
                }
                let [z, side] = [piece.centre_m.z.abs(), 1.0 / piece.centre_m.z.abs()];
                let at = crate::project::pixel_m(&theatre.screen, view.size, 0.0, 0.0);
                let params = VisibilityParams {
                    width: w as u32,
                    rows: band.rows as u32,
                    first: band.first as u32,
                    sub: plan.sub as u32,
                    start: range.start as u32,
                    end: range.end as u32,
                    channels: plan.channels as u32,
                    emitter: piece.emitter as u32,
                    emitters: emitters as u32,
                    rest: background.rest as u32,
                    share_channels: share_channels as u32,
                    own_channels: own_channels as u32,
                    by_irradiance: u32::from(self.knobs.weights == Weights::Irradiance),
                    is_first: u32::from(before != piece.emitter),
                    step_x: (theatre.screen.width_m / w as f64 / z) as f32,
                    step_y: (-theatre.screen.height_m / h as f64 / z) as f32,
                    origin_x: ((at.x - piece.centre_m.x) / z) as f32,
                    origin_y: ((at.y - piece.centre_m.y) / z) as f32,
                    half_x: (0.5 * piece.size_m[0] * side) as f32,
                    half_y: (0.5 * piece.size_m[1] * side) as f32,
                };
                before = piece.emitter;
                let params = self.gpu.uniform("piece", &params);
                let bind = self.gpu.bind(
                    &self.visibility,
                    &[
                        params.as_entire_binding(),
                        lookups.as_entire_binding(),
                        windows.as_entire_binding(),
                        work.sums.as_entire_binding(),
                        work.visibility.as_entire_binding(),
                        work.weights.as_entire_binding(),
                        band.share.as_entire_binding(),
                        work.own.as_entire_binding(),
                    ],
                );
                dispatch(&mut encoder, &self.visibility, &bind, [(w as u32).div_ceil(64), band.rows as u32]);
            }
            let (k_d, s) = match theatre.ambient {
                Ambient::Paper { k_d_m, s } => (k_d_m as f32, s.map(|s| s as f32)),
                _ => (1.0, [0.0; 3]),
            };
            let params = ShadeParams {
                width: w as u32,
                rows: band.rows as u32,
                channels: plan.channels as u32,
                emitters: emitters as u32,
                rest: background.rest as u32,
                share_channels: share_channels as u32,
                lit_channels: background.lit.len() as u32,
                planes: plan.planes.len() as u32,
                own_channels: own_channels as u32,
                paper: u32::from(paper),
                display: u32::from(white.is_some()),
                scale: (1.0 / white.unwrap_or(1.0)) as f32,
                k_d,
                s_r: s[0],
                s_g: s[1],
                s_b: s[2],
            };
            let params = self.gpu.uniform("shade", &params);
            let bind = self.gpu.bind(
                &self.shade,
                &[
                    params.as_entire_binding(),
                    work.visibility.as_entire_binding(),
                    work.weights.as_entire_binding(),
                    band.lit.as_entire_binding(),
                    band.share.as_entire_binding(),
                    work.own.as_entire_binding(),
                    tables.as_entire_binding(),
                    work.output.device.as_entire_binding(),
                ],
            );
            dispatch(&mut encoder, &self.shade, &bind, [(w as u32).div_ceil(64), band.rows as u32]);
            let bytes = (outputs * w * band.rows * 4) as u64;
            self.gpu.finish(encoder, &work.output, bytes, |read| {
                take(band.first, band.rows, bytemuck::cast_slice(&read[..bytes as usize]));
            })?;
        }
        Ok(())
    }

    /// The row pass of look-up `l`, channel by channel.
    fn combine(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        frame: &FramePlan,
        l: usize,
        band: &Band,
        windows: &wgpu::Buffer,
        work: &Work,
    ) {
        let (pass, lookup) = (&frame.passes[l], &frame.lookups[l]);
        let Some(table) = self.tables.iter().find(|t| t.mask.id == pass.mask) else { return };
        let rows = (band.rows * frame.plan.sub) as u32;
        for (c, view) in table.channels.iter().enumerate() {
            let params = RowsParams {
                first: (band.first * frame.plan.sub) as u32,
                rows,
                from_x: lookup.from_x,
                to_x: lookup.to_x,
                height: pass.height as u32,
                reach: frame.plan.lookups[l].y.reach as u32,
                windows: pass.windows,
                count: pass.count as u32,
                sums: (lookup.sums + c as u32 * lookup.channel)
                    * self.bands[0].rows as u32
                    * frame.plan.sub as u32,
                interior: pass.interior,
                scale: pass.scale,
                unused: 0,
            };
            let params = self.gpu.uniform("rows", &params);
            let bind = self.gpu.bind(
                &self.rows,
                &[
                    params.as_entire_binding(),
                    wgpu::BindingResource::TextureView(view),
                    windows.as_entire_binding(),
                    work.sums.as_entire_binding(),
                ],
            );
            dispatch(encoder, &self.rows, &bind, [rows.div_ceil(8), 1]);
        }
    }

    fn upload_band(
        &self,
        background: &Background,
        emitters: usize,
        w: usize,
        first: usize,
        rows: usize,
    ) -> Band {
        let part = |plane: &[f32]| plane[first * w..(first + rows) * w].to_vec();
        let lit: Vec<f32> = background.lit.iter().flat_map(|p| part(p)).collect();
        let channels = background.share_channels();
        let mut share = Vec::with_capacity(emitters * channels * rows * w);
        for e in 0..emitters {
            for c in 0..channels {
                match e == background.rest {
                    true => share.resize(share.len() + rows * w, 0.0),
                    false => share.extend(part(background.share(e, c))),
                }
            }
        }
        Band { first, rows, lit: self.gpu.storage("lit", &lit), share: self.gpu.storage("share", &share) }
    }

    /// Makes the working buffers at least this large.
    fn reserve(&mut self, words: [u64; 5]) {
        if self.work.as_ref().is_some_and(|w| w.words.iter().zip(&words).all(|(have, need)| have >= need)) {
            return;
        }
        let buffer = |label: &str, words: u64| {
            self.gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: 4 * words.max(4),
                usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        self.work = Some(Work {
            words,
            sums: buffer("sums", words[0]),
            visibility: buffer("visibility", words[1]),
            weights: buffer("weights", words[2]),
            own: buffer("own", words[3]),
            output: self.gpu.output("output", 4 * words[4]),
        });
    }
}

fn dispatch(
    encoder: &mut wgpu::CommandEncoder,
    pipeline: &wgpu::ComputePipeline,
    bind: &wgpu::BindGroup,
    [x, y]: [u32; 2],
) {
    let mut pass = encoder.begin_compute_pass(&Default::default());
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, bind, &[]);
    pass.dispatch_workgroups(x, y, 1);
}

impl FramePlan {
    fn new(theatre: &Theatre, view: &View, knobs: &Knobs) -> Result<Self, RenderError> {
        plan::refuse_on_gpu(theatre)?;
        let plan = Plan::new(theatre, view, knobs)?;
        let (mut lookups, mut passes, mut windows) = (Vec::new(), Vec::new(), Vec::new());
        let (mut pieces, mut most) = (Vec::new(), 0);
        // The plan groups look-ups by plane; a piece's must follow each other here.
        let mut order: Vec<usize> = (0..plan.lookups.len()).collect();
        order.sort_by_key(|l| plan.lookups[*l].piece);
        let sorted: Vec<_> = order.iter().map(|l| plan.lookups[*l].clone()).collect();
        let plan = Plan { lookups: sorted, ..plan };
        for p in 0..plan.pieces.len() {
            let start = lookups.len();
            let mut sums = 0;
            for lookup in plan.lookups.iter().filter(|l| l.piece == p) {
                let mask = &theatre.planes[lookup.plane].mask;
                let columns = lookup.x.start.len();
                let [from, to] = lookup.x.touched(0..columns, mask.width);
                let longest =
                    lookup.x.start.iter().zip(&lookup.x.stop).map(|(a, b)| b - a).max().unwrap_or(0);
                let longest = f64::from(longest) + lookup.x.reach as f64 + 2.0;
                let code = f64::from(mask.max_code());
                let scale = 2f64.powf((2f64.powi(32) / (code * longest)).log2().floor());
                let stride = to - from + 1;
                lookups.push(GpuLookup {
                    windows: windows.len() as u32,
                    count: columns as u32,
                    reach: lookup.x.reach as u32,
                    sums: sums as u32,
                    channel: if mask.channels == 3 { stride as u32 } else { 0 },
                    from_x: from as u32,
                    to_x: to as u32,
                    plane: plan.planes.iter().position(|q| *q == lookup.plane).unwrap_or(0) as u32,
                    interior: (1.0 / lookup.x.width) as f32,
                    norm: (1.0 / (scale * code)) as f32,
                });
                push_windows(&lookup.x, &mut windows);
                passes.push(RowPass {
                    mask: mask.id,
                    height: mask.height,
                    windows: windows.len() as u32,
                    count: lookup.y.start.len(),
                    interior: (1.0 / lookup.y.width) as f32,
                    scale: scale as f32,
                });
                push_windows(&lookup.y, &mut windows);
                sums += stride * mask.channels;
            }
            pieces.push(start..lookups.len());
            most = most.max(sums);
        }
        Ok(Self { plan, lookups, passes, pieces, windows, sums: most })
    }

    /// Look-ups with the places of their sums for bands of `rows` rows.
    fn lookups_for(&self, rows: usize) -> Vec<GpuLookup> {
        let per = (rows * self.plan.sub) as u32;
        self.lookups
            .iter()
            .map(|l| GpuLookup { sums: l.sums * per, channel: l.channel * per, ..*l })
            .collect()
    }
}

/// Appends starts, seconds and 2 · reach weights, each for all windows: texel `start + k` weighs `weight[k]`, texels from
/// `start + reach` to `second` weigh 1 / width, texel `second + k` weighs `weight[reach + k]`.
fn push_windows(windows: &Windows, out: &mut Vec<u32>) {
    let (count, reach) = (windows.start.len(), windows.reach as i32);
    let second = |i: usize| windows.stop[i].max(windows.start[i] + reach);
    out.extend(windows.start.iter().map(|s| s.cast_unsigned()));
    out.extend((0..count).map(|i| second(i).cast_unsigned()));
    let weight = |i: usize, t: i32| (windows.overlap(i, i64::from(t)) / windows.width) as f32;
    for k in 0..reach {
        out.extend((0..count).map(|i| weight(i, windows.start[i] + k).to_bits()));
    }
    for k in 0..reach {
        out.extend((0..count).map(|i| match second(i) + k {
            t if t < windows.stop[i] + reach => weight(i, t).to_bits(),
            _ => 0,
        }));
    }
}

impl Renderer for OnGpu {
    fn radiance(&mut self, theatre: &Theatre, view: &View) -> Result<Frame, RenderError> {
        let pixels = view.size[0] * view.size[1];
        let kind = if self.knobs.weights == Weights::Area { "Vgeo" } else { "Virr" };
        let coloured = theatre.planes.iter().any(|p| p.mask.channels == 3);
        let emitters = theatre.lamp.emitters.len();
        let mut planes: Vec<Vec<f32>> = Vec::new();
        let stats = self.draw(theatre, view, None, |first, rows, words| {
            let n = rows * view.size[0];
            planes.resize_with(words.len() / n, || vec![0.0; pixels]);
            for (plane, words) in planes.iter_mut().zip(words.chunks_exact(n)) {
                let to = &mut plane[first * view.size[0]..][..n];
                to.copy_from_slice(bytemuck::cast_slice(words));
            }
        })?;
        let channels = (planes.len() - 3) / emitters;
        let mut planes = planes.into_iter();
        let radiance = [(); 3].map(|()| planes.next().unwrap_or_default());
        let visibility: Vec<_> = planes.collect();
        let mut layers = Vec::new();
        for (e, emitter) in theatre.lamp.emitters.iter().enumerate() {
            let suffixes: &[&str] = if coloured { &[".R", ".G", ".B"] } else { &[""] };
            for (c, suffix) in suffixes.iter().enumerate() {
                let values = visibility[e * channels + c.min(channels - 1)].clone();
                layers.push(Layer { name: format!("{kind}.{}{suffix}", emitter.name), values });
            }
        }
        Ok(Frame { size: view.size, radiance, layers, stats })
    }

    fn display(
        &mut self,
        theatre: &Theatre,
        view: &View,
        white: f64,
        out: &mut [u32],
    ) -> Result<Stats, RenderError> {
        if out.len() != view.size[0] * view.size[1] {
            let [w, h] = view.size;
            return Err(RenderError::View(format!("{} pixels given for {w}x{h}", out.len())));
        }
        if !(white.is_finite() && white > 0.0) {
            return Err(RenderError::View(format!("white = {white}: a radiance above 0")));
        }
        self.draw(theatre, view, Some(white), |first, rows, words| {
            out[first * view.size[0]..][..rows * view.size[0]].copy_from_slice(words);
        })
    }

    fn adapter(&self) -> String {
        self.gpu.adapter()
    }
}

#[cfg(test)]
mod tests;
