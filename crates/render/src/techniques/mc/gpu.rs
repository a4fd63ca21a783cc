//! The sampler on a GPU: jobs in, replicates' sums out; everything before and after is shared with the native code.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};

use super::bounds::Padded;
use super::estimate::Job;
use super::plan::{Axis, Plan};
use super::points::{Points, REPLICATES};
use crate::RenderError;
use crate::gpu::{Gpu, Output};

/// The shader's text.
pub const WGSL: &str = include_str!("mc.wgsl");

/// Invocations a workgroup, as in the shader.
const WORKGROUP: u32 = 64;

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
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub(super) struct GpuAxis {
    pub offset: f32,
    pub low: f32,
    pub high: f32,
    pub anchor: i32,
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub(super) struct Emitter {
    pub side_x: f32,
    pub side_y: f32,
    pub pixel_x: f32,
    pub pixel_y: f32,
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub(super) struct Map {
    pub emitter_x: f32,
    pub emitter_y: f32,
    pub pixel_x: f32,
    pub pixel_y: f32,
    pub layer: u32,
    pub channels: u32,
}

/// Compiled once; keeps the masks' texture while the masks stay, and the buffers that sums are read through.
pub struct Sampler {
    pub gpu: Gpu,
    pipeline: wgpu::ComputePipeline,
    masks: Option<(Vec<u64>, wgpu::Texture)>,
    output: Option<(u64, Output)>,
    points: Option<(usize, wgpu::Buffer)>,
}

/// What one frame's jobs share on the device.
pub struct Scene {
    plan: Params,
    channels: usize,
    emitters: wgpu::Buffer,
    maps: wgpu::Buffer,
    axes: wgpu::Buffer,
    tangents: wgpu::Buffer,
}

impl Sampler {
    /// Compiles `wgsl`, which is [`WGSL`] but for tests that need a wrong one.
    pub fn new(gpu: Gpu, wgsl: &str) -> Result<Self, RenderError> {
        let module = gpu.module("mc.wgsl", wgsl);
        let pipeline = gpu.pipeline(&module, "sample");
        gpu.check()?;
        Ok(Self { gpu, pipeline, masks: None, output: None, points: None })
    }

    /// Uploads what changed; `ids` are the masks' ids.
    pub fn prepare(
        &mut self,
        plan: &Plan,
        ids: &[u64],
        masks: &[Arc<Padded>],
        points: &Points,
        samples: usize,
        seed: u32,
    ) -> Result<Scene, RenderError> {
        if self.masks.as_ref().is_none_or(|(old, _)| old != ids) {
            self.masks = Some((ids.to_vec(), self.texture(masks)?));
        }
        if self.points.as_ref().is_none_or(|(old, _)| *old != samples) {
            let words: Vec<u32> = points.dims.concat();
            self.points = Some((samples, self.gpu.storage("points", &words)));
        }
        let layer = |p: usize| masks[..p].iter().map(|m| m.channels as u32).sum();
        let (mut emitters, mut maps, mut axes, mut tangents) = (vec![], vec![], vec![], vec![]);
        for e in &plan.emitters {
            let ([side_x, side_y], [pixel_x, pixel_y]) = (e.emitter, e.pixel);
            emitters.push(Emitter { side_x, side_y, pixel_x, pixel_y });
            tangents.extend(e.columns.iter().chain(&e.rows).copied());
            for (p, map) in e.planes.iter().enumerate() {
                let ([emitter_x, emitter_y], [pixel_x, pixel_y]) = (map.emitter, map.pixel);
                let channels = masks[p].channels as u32;
                maps.push(Map { emitter_x, emitter_y, pixel_x, pixel_y, layer: layer(p), channels });
                let axis =
                    |a: &Axis| GpuAxis { offset: a.offset, low: a.low, high: a.high, anchor: a.anchor };
                axes.extend(map.columns.iter().chain(&map.rows).map(axis));
            }
        }
        let params = Params {
            width: plan.size[0] as u32,
            height: plan.size[1] as u32,
            samples: samples as u32,
            jobs: 0,
            planes: masks.len() as u32,
            seed,
            area: u32::from(plan.area),
            channels: plan.channels as u32,
        };
        let scene = Scene {
            plan: params,
            channels: plan.channels,
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
    pub fn run(&mut self, scene: &Scene, jobs: &[Job]) -> Result<Vec<f32>, RenderError> {
        let per_job = scene.channels * REPLICATES;
        let mut sums = Vec::with_capacity(jobs.len() * per_job);
        for jobs in jobs.chunks(JOBS) {
            let bytes = (jobs.len() * per_job * 4) as u64;
            if self.output.as_ref().is_none_or(|(size, _)| *size < bytes) {
                self.output = Some((bytes, self.gpu.output("sums", bytes)));
            }
            let (Some((_, texture)), Some((_, points)), Some((_, output))) =
                (&self.masks, &self.points, &self.output)
            else {
                unreachable!("a scene exists only after prepare")
            };
            let params = Params { jobs: jobs.len() as u32, ..scene.plan };
            let view = texture.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2Array),
                ..Default::default()
            });
            let (params, list) = (self.gpu.uniform("params", &params), self.gpu.storage("jobs", jobs));
            let bind = self.gpu.bind(
                &self.pipeline,
                &[
                    params.as_entire_binding(),
                    list.as_entire_binding(),
                    points.as_entire_binding(),
                    scene.emitters.as_entire_binding(),
                    scene.maps.as_entire_binding(),
                    scene.axes.as_entire_binding(),
                    scene.tangents.as_entire_binding(),
                    wgpu::BindingResource::TextureView(&view),
                    output.device.as_entire_binding(),
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
