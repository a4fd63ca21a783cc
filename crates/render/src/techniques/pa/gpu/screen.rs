//! The lit screen on the device, kept while lamp, screen and view are.

use super::super::background::Background;
use crate::RenderError;
use crate::gpu::Gpu;

/// Layers: the lit screen's channels, then the shares of every emitter but the rest, channel by channel.
pub struct DeviceScreen {
    pub view: wgpu::TextureView,
    pub lit_channels: usize,
    pub share_channels: usize,
}

impl DeviceScreen {
    /// Uploads `background`; errors where a texture can't be as large as the image.
    pub fn new(gpu: &Gpu, background: &Background, size: [usize; 2]) -> Result<Self, RenderError> {
        let limits = gpu.device.limits();
        let shares: Vec<&Vec<f32>> = background.share.iter().flatten().collect();
        let layers = background.lit.len() + shares.len();
        let most = limits.max_texture_dimension_2d as usize;
        if size[0].max(size[1]) > most || layers > limits.max_texture_array_layers as usize {
            return Err(RenderError::Gpu(format!(
                "{}x{} pixels in {layers} layers: {} holds {most}x{most} in {}; use --backend cpu",
                size[0],
                size[1],
                gpu.adapter(),
                limits.max_texture_array_layers
            )));
        }
        let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
        let texture = gpu.texture("lit", [size[0], size[1], layers], wgpu::TextureFormat::R32Uint, usage);
        for (layer, plane) in background.lit.iter().chain(shares).enumerate() {
            gpu.write(&texture, layer, bytemuck::cast_slice(plane), 4 * size[0], size);
        }
        Ok(Self {
            view: layered(&texture),
            lit_channels: background.lit.len(),
            share_channels: background.share_channels(),
        })
    }

    /// The layer of emitter `e`'s share in channel 0.
    pub fn share_layer(&self, e: usize, rest: usize) -> usize {
        self.lit_channels + (e - usize::from(e > rest)) * self.share_channels
    }
}

/// All layers of a texture.
pub fn layered(texture: &wgpu::Texture) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        ..Default::default()
    })
}
