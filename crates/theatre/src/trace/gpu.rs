//! The sampler on a GPU: jobs in, replicates' sums out; everything before and after is shared with the native code.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use kelir_frame::RenderError;
use kelir_frame::gpu::{Gpu, Output};
use rayon::prelude::*;

use super::axis::Axis;
use super::bounds::Padded;
use super::estimate::Job;
use super::plan::{Plan, PlaneMap, Shape};
use super::sobol::{self, Points, REPLICATES};
use super::tables::Tables;

/// The shader's text.
pub(crate) const WGSL: &str = include_str!("trace.wgsl");

/// Invocations a workgroup, as in the shader.
pub(super) const WORKGROUP: u32 = 64;

/// A source without tables, as in the shader.
pub(super) const NONE: u32 = u32::MAX;

/// Jobs drawn in one submission: 64 MiB of coloured sums.
const JOBS: usize = 1 << 18;

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub(super) struct Params {
    pub width: u32,
    pub height: u32,
    pub samples: u32,
    pub jobs: u32,
    pub planes: u32,
    pub seed: u32,
    pub area: u32,
    pub channels: u32,
    pub scrambled: u32,
    pub variants: u32,
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub(super) struct GpuAxis {
    pub offset: f32,
    pub low: f32,
    pub high: f32,
    pub anchor: i32,
    pub middle: i32,
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub(super) struct Emitter {
    pub side_x: f32,
    pub side_y: f32,
    pub pixel_x: f32,
    pub pixel_y: f32,
    pub shape: u32,
    pub table: u32,
}

#[repr(C)]
#[derive(Clone, Copy, Default, Pod, Zeroable)]
pub(super) struct Map {
    pub emitter_x: f32,
    pub emitter_y: f32,
    pub pixel_x: f32,
    pub pixel_y: f32,
    pub layer: u32,
    pub channels: u32,
    pub tilted: u32,
    pub behind: f32,
    pub right_x: f32,
    pub right_y: f32,
    pub down_x: f32,
    pub down_y: f32,
    pub normal_x: f32,
    pub normal_y: f32,
    pub unit: f32,
    pub shift_x: u32,
    pub shift_y: u32,
}

/// What one job adds to a tilted plane.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub(super) struct GpuSeen {
    pub x: GpuAxis,
    pub y: GpuAxis,
    pub ratio: f32,
    pub rest: f32,
    pub depth: f32,
    pub along_x: f32,
    pub along_y: f32,
}

impl From<&Axis> for GpuAxis {
    fn from(a: &Axis) -> Self {
        Self { offset: a.offset, low: a.low, high: a.high, anchor: a.anchor, middle: 0 }
    }
}

/// Compiled once; keeps the masks' texture while the masks stay, and the buffers that sums are read through.
pub(crate) struct Sampler {
    pub gpu: Gpu,
    pipeline: wgpu::ComputePipeline,
    masks: Option<(Vec<u64>, wgpu::Texture)>,
    output: Option<(u64, Output)>,
}

/// What one frame's jobs share on the device.
pub(crate) struct Scene {
    plan: Params,
    channels: usize,
    points: wgpu::Buffer,
    emitters: wgpu::Buffer,
    maps: wgpu::Buffer,
    axes: wgpu::Buffer,
    tangents: wgpu::Buffer,
}

impl Sampler {
    /// Compiles `wgsl`, which is [`WGSL`] but for tests that need a wrong one.
    pub(crate) fn new(gpu: Gpu, wgsl: &str) -> Result<Self, RenderError> {
        let module = gpu.module("trace.wgsl", wgsl);
        let pipeline = gpu.pipeline(&module, "sample");
        gpu.check()?;
        Ok(Self { gpu, pipeline, masks: None, output: None })
    }

    /// Uploads what changed; `ids` are the masks' ids.
    pub(crate) fn prepare(
        &mut self,
        plan: &Plan,
        ids: &[u64],
        masks: &[Arc<Padded>],
        points: &Points,
        tables: &Tables,
    ) -> Result<Scene, RenderError> {
        if self.masks.as_ref().is_none_or(|(old, _)| old != ids) {
            self.masks = Some((ids.to_vec(), self.texture(masks)?));
        }
        let mut words = points.dims.concat();
        let layer = |p: usize| masks[..p].iter().map(|m| m.channels as u32).sum();
        let (mut emitters, mut maps, mut axes, mut tangents) = (vec![], vec![], vec![], vec![]);
        for (k, e) in plan.emitters.iter().enumerate() {
            let subsets = tables.source(k);
            let table = subsets.map_or(NONE, |_| words.len() as u32);
            for subset in subsets.unwrap_or_default() {
                words.extend(subset.lanes.as_flattened());
            }
            let ([side_x, side_y], [pixel_x, pixel_y]) = (e.emitter, e.pixel);
            let shape = match e.shape {
                Shape::Rectangle => 0,
                Shape::Disk => 1,
                Shape::Dome => 2,
            };
            emitters.push(Emitter { side_x, side_y, pixel_x, pixel_y, shape, table });
            tangents.extend(e.columns.iter().chain(&e.rows).copied());
            for (p, map) in e.planes.iter().enumerate() {
                let (layer, channels, unit) = (layer(p), masks[p].channels as u32, masks[p].unit);
                let ([emitter_x, emitter_y], [pixel_x, pixel_y]) = match map {
                    PlaneMap::Parallel(map) => (map.emitter, map.pixel),
                    PlaneMap::Tilted(map) => (map.emitter, map.pixel),
                };
                let map_of =
                    Map { emitter_x, emitter_y, pixel_x, pixel_y, layer, channels, unit, ..Map::default() };
                match map {
                    PlaneMap::Parallel(map) => {
                        let [shift_x, shift_y] = map.fixed.map(|fixed| fixed.shift);
                        maps.push(Map { shift_x, shift_y, ..map_of });
                        let middles = map.middles.iter().flatten();
                        let all = map.columns.iter().chain(&map.rows).zip(middles);
                        axes.extend(all.map(|(a, &middle)| GpuAxis { middle, ..a.into() }));
                    }
                    PlaneMap::Tilted(map) => {
                        maps.push(Map {
                            tilted: 1,
                            behind: if map.dome { 0.0 } else { 1.0 },
                            right_x: map.right[0],
                            right_y: map.right[1],
                            down_x: map.down[0],
                            down_y: map.down[1],
                            normal_x: map.normal[0],
                            normal_y: map.normal[1],
                            ..map_of
                        });
                        axes.resize(axes.len() + plan.size[0] + plan.size[1], GpuAxis::zeroed());
                    }
                }
            }
        }
        let params = Params {
            width: plan.size[0] as u32,
            height: plan.size[1] as u32,
            samples: points.samples as u32,
            jobs: 0,
            planes: masks.len() as u32,
            seed: sobol::fold(points.seed),
            area: u32::from(plan.area),
            channels: plan.channels as u32,
            scrambled: u32::from(points.scrambled),
            variants: tables.variants as u32,
        };
        let scene = Scene {
            plan: params,
            channels: plan.channels,
            points: self.gpu.storage("points", &words),
            emitters: self.gpu.storage("emitters", &emitters),
            maps: self.gpu.storage("maps", &maps),
            axes: self.gpu.storage("axes", &axes),
            tangents: self.gpu.storage("tangents", &tangents),
        };
        self.gpu.check()?;
        Ok(scene)
    }

    /// All channels of all masks as layers of one integer texture.
    fn texture(&self, masks: &[Arc<Padded>]) -> Result<wgpu::Texture, RenderError> {
        let layers = masks.iter().map(|m| m.channels).sum::<usize>().max(1);
        let width = masks.iter().map(|m| m.stride).max().unwrap_or(1);
        let height = masks.iter().map(|m| m.rows).max().unwrap_or(1);
        let limits = self.gpu.device.limits();
        let most = limits.max_texture_dimension_2d as usize;
        if width > most || height > most || layers > limits.max_texture_array_layers as usize {
            return Err(RenderError::Gpu(format!(
                "masks of {width}x{height} texels in {layers} layers: {} holds {most}x{most} in {}; use --backend cpu",
                self.gpu.adapter(),
                limits.max_texture_array_layers
            )));
        }
        let size = wgpu::Extent3d {
            width: width as u32,
            height: height as u32,
            depth_or_array_layers: layers as u32,
        };
        let texture = self.gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("masks"),
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::R16Uint,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        let mut layer = 0;
        for mask in masks {
            for codes in mask.codes.chunks_exact(mask.stride * mask.rows) {
                let mut to = texture.as_image_copy();
                to.origin.z = layer;
                layer += 1;
                self.gpu.queue.write_texture(
                    to,
                    bytemuck::cast_slice(codes),
                    wgpu::TexelCopyBufferLayout {
                        offset: 0,
                        bytes_per_row: Some(2 * mask.stride as u32),
                        rows_per_image: None,
                    },
                    wgpu::Extent3d {
                        width: mask.stride as u32,
                        height: mask.rows as u32,
                        depth_or_array_layers: 1,
                    },
                );
            }
        }
        Ok(texture)
    }

    /// The sums of every job: `channels * REPLICATES` a job, channel by channel.
    pub(crate) fn run(&mut self, plan: &Plan, scene: &Scene, jobs: &[Job]) -> Result<Vec<f32>, RenderError> {
        let per_job = scene.channels * REPLICATES;
        let mut sums = Vec::with_capacity(jobs.len() * per_job);
        for jobs in jobs.chunks(JOBS) {
            let bytes = (jobs.len() * per_job * 4) as u64;
            if self.output.as_ref().is_none_or(|(size, _)| *size < bytes) {
                self.output = Some((bytes, self.gpu.output("sums", bytes)));
            }
            let (Some((_, texture)), Some((_, output))) = (&self.masks, &self.output) else {
                unreachable!("a scene exists only after prepare")
            };
            let params = Params { jobs: jobs.len() as u32, ..scene.plan };
            let view = texture.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2Array),
                ..Default::default()
            });
            let seen = self.gpu.storage("seen", &seen(plan, jobs));
            let (params, list) = (self.gpu.uniform("params", &params), self.gpu.storage("jobs", jobs));
            let bind = self.gpu.bind(
                &self.pipeline,
                &[
                    params.as_entire_binding(),
                    list.as_entire_binding(),
                    scene.points.as_entire_binding(),
                    scene.emitters.as_entire_binding(),
                    scene.maps.as_entire_binding(),
                    scene.axes.as_entire_binding(),
                    scene.tangents.as_entire_binding(),
                    wgpu::BindingResource::TextureView(&view),
                    output.device.as_entire_binding(),
                    seen.as_entire_binding(),
                ],
            );
            let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
            {
                let mut pass = encoder.begin_compute_pass(&Default::default());
                pass.set_pipeline(&self.pipeline);
                pass.set_bind_group(0, &bind, &[]);
                let groups = ((jobs.len() * REPLICATES) as u32).div_ceil(WORKGROUP);
                let columns = groups.min(1 << 14);
                pass.dispatch_workgroups(columns, groups.div_ceil(columns), 1);
            }
            self.gpu.finish(encoder, output, bytes, |read| {
                sums.extend_from_slice(&bytemuck::pod_collect_to_vec::<u8, f32>(&read[..bytes as usize]));
            })?;
        }
        Ok(sums)
    }
}

/// The numbers of every job and plane, where any plane is tilted.
fn seen(plan: &Plan, jobs: &[Job]) -> Vec<GpuSeen> {
    let tilted = |k: usize| plan.emitters[k].planes.iter().any(|m| matches!(m, PlaneMap::Tilted(_)));
    if !(0..plan.emitters.len()).any(tilted) {
        return Vec::new();
    }
    let one = |map: &PlaneMap, job: &Job| match map {
        PlaneMap::Parallel(_) => GpuSeen::zeroed(),
        PlaneMap::Tilted(map) => {
            let s = map.seen(job.x as usize, job.y as usize);
            let [along_x, along_y] = s.along;
            let (x, y) = (GpuAxis::from(&s.x), GpuAxis::from(&s.y));
            GpuSeen { x, y, ratio: s.ratio, rest: s.rest, depth: s.depth, along_x, along_y }
        }
    };
    jobs.par_iter()
        .flat_map_iter(|job| plan.emitters[job.emitter as usize].planes.iter().map(move |map| one(map, job)))
        .collect()
}
