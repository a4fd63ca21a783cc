//! Summed-area tables on the device, kept while their masks are.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use kelir_frame::RenderError;
use kelir_scene::{Mask, Texels, Theatre};

use super::super::plan::Plan;
use super::passes::Passes;
use super::screen::layered;

/// Lanes of a workgroup, each with a row or a column.
pub(super) const WORKGROUP: u32 = 32;

/// The shader's `Params`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub(super) struct TableParams {
    pub width: u32,
    pub height: u32,
    pub max_code: u32,
    pub quads: u32,
}

/// Tables of every channel of a mask.
struct Table {
    mask: Arc<Mask>,
    wide: bool,
    channels: Vec<wgpu::TextureView>,
}

/// All tables.
#[derive(Default)]
pub(super) struct DeviceTables(Vec<Table>);

impl DeviceTables {
    /// Builds the tables of masks that are new, or of all unless `keep`, and forgets those that are gone.
    pub(super) fn prepare(
        &mut self,
        passes: &Passes,
        theatre: &Theatre,
        plan: &Plan,
        keep: bool,
    ) -> Result<(), RenderError> {
        let serves = |t: &Table, p: usize| t.mask.id == theatre.planes[p].mask.id && t.wide == plan.wide[p];
        self.0.retain(|t| keep && plan.planes.iter().any(|p| serves(t, *p)));
        for &p in &plan.planes {
            if !self.0.iter().any(|t| serves(t, p)) {
                self.0.push(build(passes, &theatre.planes[p].mask, plan.wide[p])?);
            }
        }
        Ok(())
    }

    /// The table of channel `c` of `mask`.
    pub(super) fn of(&self, mask: &Mask, wide: bool, c: usize) -> &wgpu::TextureView {
        let table = self.0.iter().find(|t| t.mask.id == mask.id && t.wide == wide);
        let channels = &table.expect("prepared for this plan").channels;
        &channels[c.min(channels.len() - 1)]
    }
}

fn build(passes: &Passes, mask: &Arc<Mask>, wide: bool) -> Result<Table, RenderError> {
    let gpu = &passes.gpu;
    let most = gpu.device.limits().max_texture_dimension_2d as usize;
    if mask.width >= most || mask.height >= most {
        return Err(RenderError::Gpu(format!(
            "a mask of {}x{} texels: {} holds {most}x{most} sums; use --backend cpu",
            mask.width,
            mask.height,
            gpu.adapter(),
        )));
    }
    // Four rows a texel, with 8 rows and more above and below.
    let quads = (mask.height + 8) / 4 + 2;
    let sampled = wgpu::TextureUsages::TEXTURE_BINDING;
    let (format, bytes): (_, &[u8]) = match &mask.texels {
        Texels::U8(t) => (wgpu::TextureFormat::R8Uint, t),
        Texels::U16(t) => (wgpu::TextureFormat::R16Uint, bytemuck::cast_slice(t)),
    };
    let texel = bytes.len() / (mask.width * mask.height * mask.channels);
    let params = gpu.uniform(
        "table",
        &TableParams {
            width: mask.width as u32,
            height: mask.height as u32,
            max_code: mask.max_code(),
            quads: quads as u32,
        },
    );
    let stored = sampled | wgpu::TextureUsages::STORAGE_BINDING;
    let [columns, rows] = [passes.table("columns", false), passes.table("rows", wide)];
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut channels = Vec::new();
    for codes in bytes.chunks_exact(mask.width * mask.height * texel) {
        let source = gpu.texture(
            "codes",
            [mask.width, mask.height, 1],
            format,
            sampled | wgpu::TextureUsages::COPY_DST,
        );
        gpu.write(&source, 0, codes, mask.width * texel, [mask.width, mask.height]);
        let sums = |label: &str, width: usize, layers: usize| {
            gpu.texture(label, [width, quads, layers], wgpu::TextureFormat::Rgba32Uint, stored)
        };
        let half = sums("columns", mask.width, 1);
        let whole = layered(&sums("table", mask.width + 1, 1 + usize::from(wide)));
        let (source, half_target) = (source.create_view(&Default::default()), layered(&half));
        let half = half.create_view(&Default::default());
        for (pipeline, from, to, lanes) in
            [(&columns, &source, &half_target, mask.width), (&rows, &half, &whole, quads)]
        {
            let bind = gpu.bind(
                pipeline,
                &[
                    params.as_entire_binding(),
                    wgpu::BindingResource::TextureView(from),
                    wgpu::BindingResource::TextureView(to),
                ],
            );
            let mut pass = encoder.begin_compute_pass(&Default::default());
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &bind, &[]);
            pass.dispatch_workgroups((lanes as u32).div_ceil(WORKGROUP), 1, 1);
        }
        channels.push(whole);
    }
    gpu.queue.submit([encoder.finish()]);
    gpu.check()?;
    Ok(Table { mask: mask.clone(), wide, channels })
}
