//! Search and filter on a GPU: jobs in, sums of codes out; everything before and after is shared with the native code.

use bytemuck::{Pod, Zeroable};
use kelir_frame::RenderError;
use kelir_frame::gpu::{Gpu, Output};

use super::native::{Job, Shader};

/// The shader's text.
pub(super) const WGSL: &str = include_str!("pcss.wgsl");

/// Invocations a workgroup, as in the shader.
pub(super) const WORKGROUP: u32 = 64;

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub(super) struct Params {
    pub jobs: u32,
    pub channels: u32,
    pub emitters: u32,
    pub search_samples: u32,
    pub filter_samples: u32,
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub(super) struct GpuBeam {
    pub codes: u32,
    pub depths: u32,
    pub stride: u32,
    pub plane: u32,
    pub channels: u32,
    pub max_code: u32,
    pub size: i32,
    pub bits: u32,
    pub pixel_x: i32,
    pub pixel_y: i32,
    pub columns: u32,
    pub rows: u32,
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub(super) struct GpuPenumbra {
    pub search_x: i32,
    pub search_y: i32,
    pub widths: u32,
    pub search: u32,
    pub filter_: u32,
}

/// Compiled once; keeps the maps while they stay.
pub(crate) struct OnGpu {
    pub gpu: Gpu,
    pipeline: wgpu::ComputePipeline,
    /// Ids of the maps in the buffer.
    maps: Option<(Vec<u64>, wgpu::Buffer)>,
    output: Option<(u64, Output)>,
}

/// What one frame's jobs share on the device.
pub(crate) struct Scene {
    params: Params,
    beams: wgpu::Buffer,
    penumbrae: wgpu::Buffer,
    widths: wgpu::Buffer,
    centres: wgpu::Buffer,
    places: wgpu::Buffer,
}

impl OnGpu {
    /// Compiles `wgsl`, which is [`WGSL`] but for tests that need a wrong one.
    pub(super) fn new(gpu: Gpu, wgsl: &str) -> Result<Self, RenderError> {
        let module = gpu.module("pcss.wgsl", wgsl);
        let pipeline = gpu.pipeline(&module, "filter_jobs");
        gpu.check()?;
        Ok(Self { gpu, pipeline, maps: None, output: None })
    }

    /// Uploads what changed.
    pub(super) fn prepare(&mut self, shader: &Shader) -> Result<Scene, RenderError> {
        let (mut beams, mut penumbrae) = (Vec::new(), Vec::new());
        let (mut widths, mut centres) = (Vec::new(), Vec::<i32>::new());
        let mut places = Vec::<[i32; 4]>::new();
        let of_patterns: Vec<[u32; 2]> = shader
            .patterns
            .iter()
            .map(|p| {
                [&p.search, &p.filter].map(|pattern| {
                    places.extend_from_slice(&pattern.places);
                    (places.len() - pattern.places.len()) as u32
                })
            })
            .collect();
        let mut codes = 0;
        for (_, beam, map) in shader.beams {
            let plane = map.mask.stride * map.mask.rows;
            let depths = codes + plane * map.mask.channels;
            beams.push(GpuBeam {
                codes: codes as u32,
                depths: if map.depths.is_some() { depths as u32 } else { u32::MAX },
                stride: map.mask.stride as u32,
                plane: plane as u32,
                channels: map.mask.channels as u32,
                max_code: map.mask.max_code,
                size: beam.size as i32,
                bits: beam.bits,
                pixel_x: beam.pixel[0],
                pixel_y: beam.pixel[1],
                columns: centres.len() as u32,
                rows: (centres.len() + beam.columns.len()) as u32,
            });
            codes = depths + map.depths.as_ref().map_or(0, Vec::len);
            centres.extend(beam.columns.iter().chain(&beam.rows));
            for (penumbra, [search, filter_]) in beam.emitters.iter().zip(&of_patterns) {
                penumbrae.push(GpuPenumbra {
                    search_x: penumbra.search[0],
                    search_y: penumbra.search[1],
                    widths: widths.len() as u32,
                    search: *search,
                    filter_: *filter_,
                });
                widths.extend_from_slice(&penumbra.widths);
            }
        }
        let bytes = 2 * codes.next_multiple_of(2) as u64;
        if bytes > self.gpu.device.limits().max_storage_buffer_binding_size {
            return Err(RenderError::Gpu(format!(
                "maps of {bytes} bytes: {} holds {} in a buffer; use a smaller map_size or --backend cpu",
                self.gpu.adapter(),
                self.gpu.device.limits().max_storage_buffer_binding_size
            )));
        }
        let ids: Vec<u64> = shader.beams.iter().map(|(_, _, map)| map.id).collect();
        if self.maps.as_ref().is_none_or(|(old, _)| *old != ids) {
            let mut all: Vec<u16> = Vec::with_capacity(codes + 1);
            for (_, _, map) in shader.beams {
                all.extend_from_slice(&map.mask.codes);
                all.extend(map.depths.iter().flatten());
            }
            all.resize(codes.next_multiple_of(2), 0);
            self.maps = Some((ids, self.gpu.storage("maps", &all)));
        }
        let samples = |of: fn(&super::Patterns) -> usize| shader.patterns.first().map_or(0, of) as u32;
        let scene = Scene {
            params: Params {
                jobs: 0,
                channels: shader.channels as u32,
                emitters: shader.patterns.len() as u32,
                search_samples: samples(|p| p.search.samples),
                filter_samples: samples(|p| p.filter.samples),
            },
            beams: self.gpu.storage("beams", &beams),
            penumbrae: self.gpu.storage("penumbrae", &penumbrae),
            widths: self.gpu.storage("widths", &widths),
            centres: self.gpu.storage("centres", &centres),
            places: self.gpu.storage("places", &places),
        };
        self.gpu.check()?;
        Ok(scene)
    }

    /// One sum of codes a job and channel.
    pub(super) fn run(&mut self, scene: &Scene, jobs: &[Job]) -> Result<Vec<u32>, RenderError> {
        /// Jobs in one submission: 48 MiB of coloured sums.
        const JOBS: usize = 1 << 22;
        let per_job = scene.params.channels as usize;
        let mut sums = Vec::with_capacity(jobs.len() * per_job);
        for jobs in jobs.chunks(JOBS) {
            let bytes = (jobs.len() * per_job * 4) as u64;
            if self.output.as_ref().is_none_or(|(size, _)| *size < bytes) {
                self.output = Some((bytes, self.gpu.output("sums", bytes)));
            }
            let (Some((_, maps)), Some((_, output))) = (&self.maps, &self.output) else {
                unreachable!("a scene exists only after prepare")
            };
            let params = Params { jobs: jobs.len() as u32, ..scene.params };
            let (params, list) = (self.gpu.uniform("params", &params), self.gpu.storage("jobs", jobs));
            let buffers = [
                &params,
                &list,
                &scene.beams,
                &scene.penumbrae,
                &scene.widths,
                &scene.centres,
                &scene.places,
                maps,
                &output.device,
            ];
            let bind = self.gpu.bind(&self.pipeline, &buffers.map(|b| b.as_entire_binding()));
            let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
            {
                let mut pass = encoder.begin_compute_pass(&Default::default());
                pass.set_pipeline(&self.pipeline);
                pass.set_bind_group(0, &bind, &[]);
                let groups = (jobs.len() as u32).div_ceil(WORKGROUP);
                let columns = groups.min(1 << 14);
                pass.dispatch_workgroups(columns, groups.div_ceil(columns), 1);
            }
            self.gpu.finish(encoder, output, bytes, |read| {
                sums.extend_from_slice(&bytemuck::pod_collect_to_vec::<u8, u32>(&read[..bytes as usize]));
            })?;
        }
        Ok(sums)
    }
}
