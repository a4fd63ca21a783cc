//! The lit screen on the device, kept while lamp, screen and view are.

use kelir_frame::RenderError;
use kelir_frame::gpu::Gpu;
use rayon::prelude::*;

use super::super::background::Background;
use crate::albedo::PixelAlbedo;

/// Layers: the lit screen's channels, then the shares of every emitter but the rest, channel by channel, then an albedo that is an
/// image and asked for by the dome. A texel holds four rows.
pub(super) struct DeviceScreen {
    pub view: wgpu::TextureView,
    /// The albedo where it is one colour.
    pub uniform: Option<[f32; 3]>,
    pub lit_channels: usize,
    pub share_channels: usize,
}

impl DeviceScreen {
    /// Uploads `background`; errors where a texture can't be as large as the image.
    pub(super) fn new(gpu: &Gpu, background: &Background, size: [usize; 2]) -> Result<Self, RenderError> {
        let limits = gpu.device.limits();
        let (image, uniform) = match background.dome_albedo() {
            Some(PixelAlbedo::Image(image)) => (&image.planes[..], None),
            Some(PixelAlbedo::Uniform(albedo)) => (&[][..], Some(*albedo)),
            None => (&[][..], None),
        };
        // The shader reads three channels of an image.
        let image = (0..3).filter(|_| !image.is_empty()).map(|c| &image[c.min(image.len() - 1)]);
        let planes: Vec<&Vec<f32>> =
            background.lit.iter().chain(background.share.iter().flatten()).chain(image).collect();
        let layers = planes.len();
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
        let [width, height] = size;
        let quads = height.div_ceil(4);
        let texture = gpu.texture("lit", [width, quads, layers], wgpu::TextureFormat::Rgba32Uint, usage);
        let mut packed = vec![[0f32; 4]; width * quads];
        for (layer, plane) in planes.into_iter().enumerate() {
            packed.par_chunks_exact_mut(width).enumerate().for_each(|(q, packed)| {
                for k in 0..4 {
                    let row = &plane[(4 * q + k).min(height - 1) * width..][..width];
                    packed.iter_mut().zip(row).for_each(|(four, v)| four[k] = *v);
                }
            });
            gpu.write(&texture, layer, bytemuck::cast_slice(&packed), 16 * width, [width, quads]);
        }
        Ok(Self {
            view: layered(&texture),
            uniform,
            lit_channels: background.lit.len(),
            share_channels: background.share_channels(),
        })
    }

    /// The layer of emitter `e`'s share in channel 0.
    pub(super) fn share_layer(&self, e: usize, rest: usize) -> usize {
        self.lit_channels + (e - usize::from(e > rest)) * self.share_channels
    }
}

/// All layers of a texture.
pub(super) fn layered(texture: &wgpu::Texture) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        ..Default::default()
    })
}
