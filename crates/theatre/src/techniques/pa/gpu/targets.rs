//! Textures that grow when asked for more and are kept.

use kelir_frame::gpu::Gpu;

use super::passes::FORMAT;
use super::screen::layered;
use super::words::ROW;
use super::work::ACROSS;

/// Fragments a row of a target whose cells are tiles.
pub(super) const CELLS: usize = ACROSS * 32;

const DRAWN: wgpu::TextureUsages =
    wgpu::TextureUsages::RENDER_ATTACHMENT.union(wgpu::TextureUsages::TEXTURE_BINDING);

/// A texture that passes draw to, with as many layers as asked for.
#[derive(Default)]
pub(super) struct Target(Option<(wgpu::Texture, wgpu::TextureView)>);

impl Target {
    /// Makes it at least this large: width, height, layers.
    pub(super) fn reserve(&mut self, gpu: &Gpu, label: &str, size: [usize; 3]) {
        let serves = |t: &wgpu::Texture| {
            let have = [t.width(), t.height(), t.depth_or_array_layers()];
            have.iter().zip(size).all(|(have, want)| *have as usize >= want)
        };
        if !self.0.as_ref().is_some_and(|(t, _)| serves(t)) {
            let texture = gpu.texture(label, size, FORMAT, DRAWN | wgpu::TextureUsages::COPY_SRC);
            let view = layered(&texture);
            self.0 = Some((texture, view));
        }
    }

    /// All layers.
    pub(super) fn all(&self) -> &wgpu::TextureView {
        &self.0.as_ref().expect("reserved before it is used").1
    }

    /// Layer `k` alone.
    pub(super) fn layer(&self, k: usize) -> wgpu::TextureView {
        layer(self.texture(), k)
    }

    pub(super) fn texture(&self) -> &wgpu::Texture {
        &self.0.as_ref().expect("reserved before it is used").0
    }
}

fn layer(texture: &wgpu::Texture, k: usize) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2),
        base_array_layer: k as u32,
        array_layer_count: Some(1),
        ..Default::default()
    })
}

/// A list of words, or of word vectors, as a texture.
#[derive(Default)]
pub(super) struct List(Option<(wgpu::Texture, wgpu::TextureView)>);

impl List {
    /// Uploads whole rows, elements of 4 or 16 bytes.
    pub(super) fn write<T: bytemuck::NoUninit>(&mut self, gpu: &Gpu, words: &[T]) {
        let rows = words.len() / ROW;
        if self.0.as_ref().is_none_or(|(t, _)| (t.height() as usize) < rows) {
            let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
            let format = if size_of::<T>() == 4 { wgpu::TextureFormat::R32Uint } else { FORMAT };
            let texture = gpu.texture("words", [ROW, rows, 1], format, usage);
            let view = texture.create_view(&Default::default());
            self.0 = Some((texture, view));
        }
        if let Some((texture, _)) = &self.0 {
            gpu.write(texture, 0, bytemuck::cast_slice(words), size_of::<T>() * ROW, [ROW, rows]);
        }
    }

    pub(super) fn view(&self) -> &wgpu::TextureView {
        &self.0.as_ref().expect("written before it is read").1
    }
}

/// Sums that go on from pass to pass, so each layer has two textures that take turns; the second is made when it is first needed.
#[derive(Default)]
pub(super) struct Layers {
    size: [usize; 2],
    turns: [Option<(wgpu::Texture, wgpu::TextureView)>; 2],
    /// Which texture has a layer's sums, if any has.
    at: Vec<Option<usize>>,
    nothing: Option<wgpu::TextureView>,
}

impl Layers {
    /// Starts all layers anew, `height` rows of fragments each.
    pub(super) fn begin(&mut self, gpu: &Gpu, height: usize, layers: usize) {
        if self.size[0] < height || self.size[1] < layers {
            self.size = [height, layers];
            self.turns = [Some(self.make(gpu)), None];
        }
        self.at = vec![None; layers];
        if self.nothing.is_none() {
            let texture = gpu.texture("nothing", [1; 3], FORMAT, DRAWN);
            self.nothing = Some(texture.create_view(&Default::default()));
        }
    }

    fn make(&self, gpu: &Gpu) -> (wgpu::Texture, wgpu::TextureView) {
        let usage = DRAWN | wgpu::TextureUsages::COPY_SRC | wgpu::TextureUsages::COPY_DST;
        let size = [CELLS, self.size[0], self.size[1]];
        let texture = gpu.texture("sums", size, FORMAT, usage);
        let view = layered(&texture);
        (texture, view)
    }

    /// What layer `k` holds so far, what to draw it to next, and whether there is anything so far.
    pub(super) fn turn(&mut self, gpu: &Gpu, k: usize) -> (wgpu::TextureView, wgpu::TextureView, bool) {
        let before = self.at[k];
        let next = before.map_or(0, |at| 1 - at);
        if self.turns[next].is_none() {
            self.turns[next] = Some(self.make(gpu));
        }
        self.at[k] = Some(next);
        let view = |turn: usize| match &self.turns[turn] {
            Some((texture, _)) => layer(texture, k),
            None => unreachable!("made above"),
        };
        let nothing = || self.nothing.clone().expect("made by begin");
        (before.map_or_else(nothing, view), view(next), before.is_some())
    }

    /// Brings all layers together in the first texture.
    pub(super) fn settle(&mut self, encoder: &mut wgpu::CommandEncoder) {
        for (k, at) in self.at.iter_mut().enumerate().filter(|(_, at)| **at == Some(1)) {
            *at = Some(0);
            if let [Some((to, _)), Some((from, _))] = &self.turns {
                let layer = |texture| {
                    let mut copy = wgpu::Texture::as_image_copy(texture);
                    copy.origin.z = k as u32;
                    copy
                };
                let size = wgpu::Extent3d { depth_or_array_layers: 1, ..from.size() };
                encoder.copy_texture_to_texture(layer(from), layer(to), size);
            }
        }
    }

    /// All layers, after [`settle`](Self::settle).
    pub(super) fn all(&self) -> &wgpu::TextureView {
        &self.turns[0].as_ref().expect("made by begin").1
    }

    /// Layer `k`, after [`settle`](Self::settle).
    pub(super) fn copy_of(&self, k: usize) -> wgpu::TexelCopyTextureInfo<'_> {
        let mut copy = self.turns[0].as_ref().expect("made by begin").0.as_image_copy();
        copy.origin.z = k as u32;
        copy
    }
}

/// The mappable buffer that answers are read through.
#[derive(Default)]
pub(super) struct Host(Option<wgpu::Buffer>);

impl Host {
    /// At least `bytes` bytes.
    pub(super) fn reserve(&mut self, gpu: &Gpu, bytes: u64) -> wgpu::Buffer {
        match &self.0 {
            Some(buffer) if buffer.size() >= bytes => buffer.clone(),
            _ => self.0.insert(gpu.host("answers", bytes)).clone(),
        }
    }
}
