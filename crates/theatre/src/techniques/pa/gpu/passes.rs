//! The shaders, compiled once for each set of constants, and how a pass is run.

use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};

use bytemuck::{Pod, Zeroable};
use kelir_frame::RenderError;
use kelir_frame::gpu::Gpu;

/// The shaders' texts, in the order they run.
#[derive(Clone, Debug)]
pub(crate) struct Shaders {
    pub table: String,
    pub rows: String,
    pub tilted: String,
    pub visibility: String,
    pub shade: String,
}

impl Default for Shaders {
    fn default() -> Self {
        Self {
            table: include_str!("../table.wgsl").into(),
            rows: include_str!("../rows.wgsl").into(),
            tilted: include_str!("../tilted.wgsl").into(),
            visibility: include_str!("../visibility.wgsl").into(),
            shade: include_str!("../shade.wgsl").into(),
        }
    }
}

/// Of `combine`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub(super) struct RowsParams {
    pub blocks: u32,
    pub width: u32,
    pub height: u32,
    pub shift: u32,
}

/// Of `slope`.
#[repr(C)]
#[derive(Clone, Copy, Default, Pod, Zeroable)]
pub(super) struct SlopeParams {
    pub tiles: u32,
    pub count: u32,
    pub maps: u32,
    pub width: u32,
    pub height: u32,
    pub sub_x: u32,
    pub sub_y: u32,
    pub norm: f32,
    pub along_x: f32,
    pub along_y: f32,
    pub unused_x: u32,
    pub unused_y: u32,
}

/// Of `add`.
#[repr(C)]
#[derive(Clone, Copy, Default, Pod, Zeroable)]
pub(super) struct VisibilityParams {
    pub tiles: u32,
    pub pieces: u32,
    pub lookups: u32,
    pub bounds: u32,
    pub stride: u32,
    pub count: u32,
    pub channel: u32,
    pub right: u32,
    pub plane: u32,
    pub shares: u32,
    pub shares_end: u32,
    pub shares_step: u32,
    pub rest: u32,
    pub unused_x: u32,
    pub unused_y: u32,
    pub unused_z: u32,
}

/// Of `codes` and `radiance`.
#[repr(C)]
#[derive(Clone, Copy, Default, Pod, Zeroable)]
pub(super) struct ShadeParams {
    pub tiles: u32,
    pub stride: u32,
    pub count: u32,
    pub right: u32,
    pub bottom: u32,
    pub channel: u32,
    pub distances: u32,
    pub domes: u32,
    pub scale: f32,
    pub k_d: f32,
    pub unused_x: u32,
    pub unused_y: u32,
    pub s: [f32; 4],
    pub dome: [f32; 4],
}

/// A pass that draws: one fragment an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Pass {
    Combine,
    Slope,
    Add,
    Codes,
    Radiance,
}

impl Pass {
    fn entry(self) -> &'static str {
        match self {
            Self::Combine => "combine",
            Self::Slope => "slope",
            Self::Add => "add",
            Self::Codes => "codes",
            Self::Radiance => "radiance",
        }
    }
}

/// What all targets hold: four answers a fragment.
pub(super) const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Uint;

/// Values of a shader's `override` constants.
pub(super) type Constants = Vec<(&'static str, u32)>;

/// Shader modules, layouts and the pipelines made so far.
pub(super) struct Passes {
    pub gpu: Gpu,
    table: wgpu::ShaderModule,
    modules: [wgpu::ShaderModule; 4],
    layouts: [wgpu::BindGroupLayout; 4],
    made: Mutex<HashMap<(Pass, Constants), wgpu::RenderPipeline>>,
}

impl Passes {
    /// Reads the shaders; pipelines are made when they are first needed.
    pub(super) fn new(gpu: Gpu, shaders: &Shaders) -> Result<Self, RenderError> {
        // Dimensions of the textures behind the uniform buffer at binding 0.
        let (flat, layers) = (wgpu::TextureViewDimension::D2, wgpu::TextureViewDimension::D2Array);
        let new = Self {
            table: gpu.module("table.wgsl", &shaders.table),
            modules: [
                gpu.module("rows.wgsl", &shaders.rows),
                gpu.module("tilted.wgsl", &shaders.tilted),
                gpu.module("visibility.wgsl", &shaders.visibility),
                gpu.module("shade.wgsl", &shaders.shade),
            ],
            layouts: [
                layout(&gpu, &[flat, layers]),
                layout(&gpu, &[flat, layers]),
                layout(&gpu, &[flat, flat, flat, layers, layers]),
                layout(&gpu, &[flat, layers, layers, layers, flat, flat]),
            ],
            made: Mutex::default(),
            gpu,
        };
        new.gpu.check()?;
        Ok(new)
    }

    /// The compute pipeline of an entry point of table.wgsl.
    pub(super) fn table(&self, entry: &str, wide: bool) -> wgpu::ComputePipeline {
        self.gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(entry),
            layout: None,
            module: &self.table,
            entry_point: Some(entry),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: &[("WIDE", f64::from(u8::from(wide)))],
                ..Default::default()
            },
            cache: None,
        })
    }

    fn index(pass: Pass) -> usize {
        match pass {
            Pass::Combine => 0,
            Pass::Slope => 1,
            Pass::Add => 2,
            Pass::Codes | Pass::Radiance => 3,
        }
    }

    fn pipeline(&self, pass: Pass, constants: &Constants) -> wgpu::RenderPipeline {
        let mut made = self.made.lock().unwrap_or_else(PoisonError::into_inner);
        let make = || {
            let (module, layout) = (&self.modules[Self::index(pass)], &self.layouts[Self::index(pass)]);
            let layout = self.gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(pass.entry()),
                bind_group_layouts: &[Some(layout)],
                immediate_size: 0,
            });
            let values: Vec<(&str, f64)> = constants.iter().map(|(n, v)| (*n, f64::from(*v))).collect();
            let options = || wgpu::PipelineCompilationOptions { constants: &values, ..Default::default() };
            self.gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some(pass.entry()),
                layout: Some(&layout),
                vertex: wgpu::VertexState {
                    module,
                    entry_point: Some("cover"),
                    compilation_options: options(),
                    buffers: &[],
                },
                primitive: Default::default(),
                depth_stencil: None,
                multisample: Default::default(),
                fragment: Some(wgpu::FragmentState {
                    module,
                    entry_point: Some(pass.entry()),
                    compilation_options: options(),
                    targets: &[Some(FORMAT.into())],
                }),
                multiview_mask: None,
                cache: None,
            })
        };
        made.entry((pass, constants.clone())).or_insert_with(make).clone()
    }

    /// Runs `pass` for every fragment of rows `rows` of `target`: `params` at binding 0, then the textures.
    pub(super) fn run<P: bytemuck::NoUninit>(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        (pass, constants): (Pass, &Constants),
        params: &P,
        textures: &[&wgpu::TextureView],
        target: &wgpu::TextureView,
        rows: std::ops::Range<u32>,
    ) {
        let params = self.gpu.uniform(pass.entry(), params);
        let mut entries = vec![wgpu::BindGroupEntry { binding: 0, resource: params.as_entire_binding() }];
        entries.extend((1..).zip(textures).map(|(binding, view)| wgpu::BindGroupEntry {
            binding,
            resource: wgpu::BindingResource::TextureView(view),
        }));
        let bind = self.gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(pass.entry()),
            layout: &self.layouts[Self::index(pass)],
            entries: &entries,
        });
        let mut drawing = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(pass.entry()),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: target,
                depth_slice: None,
                resolve_target: None,
                // Every fragment that is read later is written; a clear would cost as much again.
                ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
            })],
            ..Default::default()
        });
        drawing.set_pipeline(&self.pipeline(pass, constants));
        drawing.set_bind_group(0, &bind, &[]);
        drawing.set_scissor_rect(0, rows.start, target.texture().width(), rows.end - rows.start);
        drawing.draw(0..3, 0..1);
    }
}

fn layout(gpu: &Gpu, textures: &[wgpu::TextureViewDimension]) -> wgpu::BindGroupLayout {
    let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty,
        count: None,
    };
    let uniform = wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Uniform,
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    let texture = |view_dimension| wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Uint,
        view_dimension,
        multisampled: false,
    };
    let entries: Vec<_> = std::iter::once(entry(0, uniform))
        .chain((1..).zip(textures).map(|(binding, dimension)| entry(binding, texture(*dimension))))
        .collect();
    let descriptor = wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries };
    gpu.device.create_bind_group_layout(&descriptor)
}
