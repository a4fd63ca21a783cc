//! Headless Vulkan through wgpu: the adapter, the device, and errors that stay errors.
//!
//! Vulkan only: the GL adapters of the machines we run on are not WebGPU-compliant, and one driver stack is enough.

use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use serde::Serialize;
use wgpu::util::DeviceExt;

use crate::{Backend, RenderError};

/// What to do on a machine without any adapter.
const HOW_TO_INSTALL: &str = "no Vulkan adapter: install a driver (Debian/Ubuntu without a GPU: \
    `apt-get install mesa-vulkan-drivers` gives the software adapter lavapipe), or use `--backend cpu`";

/// An opened device; cheap to clone, all clones are the same device.
#[derive(Clone)]
pub struct Gpu {
    /// Makes what is not made here.
    pub device: wgpu::Device,
    /// Takes what is not submitted here.
    pub queue: wgpu::Queue,
    info: wgpu::AdapterInfo,
    /// The first error that no call returned: validation, memory, a lost device.
    failure: Arc<Mutex<Option<String>>>,
}

/// What a device can hold at most.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Limits {
    /// Pixels a side of a two-dimensional texture.
    pub texture_side: u32,
    /// Bytes of a buffer.
    pub buffer_bytes: u64,
    /// Bytes of a buffer that a shader reads.
    pub storage_binding_bytes: u64,
}

/// Every Vulkan adapter as "name (type, driver)", real GPUs first.
pub fn adapters() -> Vec<String> {
    list().iter().map(|a| describe(&a.get_info())).collect()
}

/// Asked once: drivers are slow to load, and some complain on stderr each time.
fn list() -> Vec<wgpu::Adapter> {
    static ADAPTERS: OnceLock<Vec<wgpu::Adapter>> = OnceLock::new();
    let ask = || {
        let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
        descriptor.backends = wgpu::Backends::VULKAN;
        let instance = wgpu::Instance::new(descriptor);
        let mut adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::VULKAN));
        adapters.sort_by_key(|a| match a.get_info().device_type {
            wgpu::DeviceType::DiscreteGpu => 0,
            wgpu::DeviceType::IntegratedGpu => 1,
            wgpu::DeviceType::VirtualGpu => 2,
            wgpu::DeviceType::Other => 3,
            wgpu::DeviceType::Cpu => 4,
        });
        adapters
    };
    ADAPTERS.get_or_init(ask).clone()
}

/// Whether there may be a real GPU at all; on Linux without any device node, loading Vulkan would be for nothing.
fn may_have_gpu() -> bool {
    !cfg!(target_os = "linux")
        || ["/dev/dri", "/dev/nvidiactl", "/dev/dxg"].iter().any(|node| std::path::Path::new(node).exists())
}

fn describe(info: &wgpu::AdapterInfo) -> String {
    format!("{} ({:?}, {})", info.name, info.device_type, driver(info))
}

fn driver(info: &wgpu::AdapterInfo) -> String {
    format!("{} {}", info.driver, info.driver_info).trim().to_owned()
}

/// The device that `backend` asks for; `None` is the native backend.
///
/// `Auto` takes a real GPU and else the native backend, which is faster than a GPU that a CPU imitates.
pub fn choose(backend: Backend) -> Result<Option<Gpu>, RenderError> {
    let adapters = match backend {
        Backend::Cpu => return Ok(None),
        Backend::Gpu => list(),
        Backend::Auto if !may_have_gpu() => return Ok(None),
        Backend::Auto => {
            let mut real = list();
            real.retain(|a| a.get_info().device_type != wgpu::DeviceType::Cpu);
            real
        }
    };
    match adapters.first() {
        Some(adapter) => match Gpu::open(adapter) {
            Ok(gpu) => Ok(Some(gpu)),
            Err(_) if backend == Backend::Auto => Ok(None),
            Err(e) => Err(e),
        },
        None if backend == Backend::Auto => Ok(None),
        None => Err(RenderError::Gpu(HOW_TO_INSTALL.into())),
    }
}

impl Gpu {
    fn open(adapter: &wgpu::Adapter) -> Result<Self, RenderError> {
        let has = adapter.limits();
        let limits = wgpu::Limits {
            max_texture_dimension_2d: has.max_texture_dimension_2d,
            max_buffer_size: has.max_buffer_size,
            max_storage_buffer_binding_size: has.max_storage_buffer_binding_size,
            ..Default::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("kelir"),
            required_limits: limits,
            memory_hints: wgpu::MemoryHints::Performance,
            ..Default::default()
        }))
        .map_err(|e| RenderError::Gpu(format!("{}: {e}", describe(&adapter.get_info()))))?;
        let failure = Arc::new(Mutex::new(None));
        let store = |failure: &Arc<Mutex<Option<String>>>, text: String| {
            failure.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(text);
        };
        let kept = failure.clone();
        device.on_uncaptured_error(Arc::new(move |e| store(&kept, e.to_string())));
        let kept = failure.clone();
        device.set_device_lost_callback(move |reason, text| {
            if reason != wgpu::DeviceLostReason::Destroyed {
                store(&kept, format!("the device was lost: {text}"));
            }
        });
        Ok(Self { device, queue, info: adapter.get_info(), failure })
    }

    /// "name (type, driver)".
    pub fn adapter(&self) -> String {
        describe(&self.info)
    }

    /// `gpu:ADAPTER/DRIVER`, for a job's key.
    pub fn class(&self) -> String {
        format!("gpu:{}/{}", self.info.name, driver(&self.info))
    }

    /// Whether a CPU imitates the GPU (lavapipe).
    pub fn is_software(&self) -> bool {
        self.info.device_type == wgpu::DeviceType::Cpu
    }

    /// What it can hold.
    pub fn limits(&self) -> Limits {
        let limits = self.device.limits();
        Limits {
            texture_side: limits.max_texture_dimension_2d,
            buffer_bytes: limits.max_buffer_size,
            storage_binding_bytes: limits.max_storage_buffer_binding_size,
        }
    }

    /// The error, if any, that happened since the device was opened; a failed device stays failed.
    pub fn check(&self) -> Result<(), RenderError> {
        match &*self.failure.lock().unwrap_or_else(PoisonError::into_inner) {
            Some(text) => Err(RenderError::Gpu(format!("{}: {text}", self.adapter()))),
            None => Ok(()),
        }
    }

    /// The compute pipeline of one entry point; its layout is the shader's own.
    pub fn pipeline(&self, module: &wgpu::ShaderModule, entry: &str) -> wgpu::ComputePipeline {
        self.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(entry),
            layout: None,
            module,
            entry_point: Some(entry),
            compilation_options: Default::default(),
            cache: None,
        })
    }

    /// A shader module from WGSL text.
    pub fn module(&self, label: &str, wgsl: &str) -> wgpu::ShaderModule {
        self.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(label),
            source: wgpu::ShaderSource::Wgsl(wgsl.into()),
        })
    }

    /// A read-only storage buffer holding `data` (zeros where it is empty: a binding holds at least one element).
    pub fn storage<T: bytemuck::NoUninit>(&self, label: &str, data: &[T]) -> wgpu::Buffer {
        let bytes: &[u8] = bytemuck::cast_slice(data);
        self.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some(label),
            contents: if bytes.is_empty() { &[0; 256] } else { bytes },
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
        })
    }

    /// A uniform buffer holding `data`.
    pub fn uniform<T: bytemuck::NoUninit>(&self, label: &str, data: &T) -> wgpu::Buffer {
        self.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some(label),
            contents: bytemuck::bytes_of(data),
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        })
    }

    /// A texture of one level; [width, height, layers].
    pub fn texture(
        &self,
        label: &str,
        [width, height, layers]: [usize; 3],
        format: wgpu::TextureFormat,
        usage: wgpu::TextureUsages,
    ) -> wgpu::Texture {
        self.device.create_texture(&wgpu::TextureDescriptor {
            label: Some(label),
            size: wgpu::Extent3d {
                width: width as u32,
                height: height as u32,
                depth_or_array_layers: layers as u32,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage,
            view_formats: &[],
        })
    }

    /// Uploads texels, `bytes_per_row` each row, to the top left of a layer.
    pub fn write(
        &self,
        texture: &wgpu::Texture,
        layer: usize,
        bytes: &[u8],
        bytes_per_row: usize,
        [width, height]: [usize; 2],
    ) {
        let mut to = texture.as_image_copy();
        to.origin.z = layer as u32;
        self.queue.write_texture(
            to,
            bytes,
            wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(bytes_per_row as u32),
                rows_per_image: None,
            },
            wgpu::Extent3d { width: width as u32, height: height as u32, depth_or_array_layers: 1 },
        );
    }

    /// A buffer that is copied to and mapped.
    pub fn host(&self, label: &str, bytes: u64) -> wgpu::Buffer {
        self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size: bytes,
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        })
    }

    /// An output of `bytes` bytes on the device and the buffer it is read back through.
    pub fn output(&self, label: &str, bytes: u64) -> Output {
        let size = bytes.next_multiple_of(4).max(16);
        let device = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        Output { device, host: self.host(label, size), size }
    }

    /// The bind group of a pipeline's group 0, bindings numbered in order.
    pub fn bind(
        &self,
        pipeline: &wgpu::ComputePipeline,
        resources: &[wgpu::BindingResource<'_>],
    ) -> wgpu::BindGroup {
        let entries: Vec<_> = (0..)
            .zip(resources)
            .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource: resource.clone() })
            .collect();
        self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &entries,
        })
    }

    /// Submits `encoder` with the copy of the first `bytes` of `output`, waits once, and hands the bytes to `take`.
    pub fn finish<R>(
        &self,
        mut encoder: wgpu::CommandEncoder,
        output: &Output,
        bytes: u64,
        take: impl FnOnce(&[u8]) -> R,
    ) -> Result<R, RenderError> {
        let bytes = bytes.next_multiple_of(4).clamp(4, output.size);
        encoder.copy_buffer_to_buffer(&output.device, 0, &output.host, 0, bytes);
        self.submit(encoder, &output.host, bytes)?.wait(take)
    }

    /// Submits `encoder`, which fills the first `bytes` of the mappable `host`, and does not wait.
    pub fn submit<'a>(
        &'a self,
        encoder: wgpu::CommandEncoder,
        host: &'a wgpu::Buffer,
        bytes: u64,
    ) -> Result<Pending<'a>, RenderError> {
        let index = self.queue.submit([encoder.finish()]);
        self.check()?;
        let (sender, receiver) = std::sync::mpsc::channel();
        host.slice(..bytes).map_async(wgpu::MapMode::Read, move |result| {
            // The receiver is gone only when nobody waits any more.
            let _ = sender.send(result);
        });
        Ok(Pending { gpu: self, host, bytes, index, receiver })
    }
}

/// Bytes on their way from the device.
pub struct Pending<'a> {
    gpu: &'a Gpu,
    host: &'a wgpu::Buffer,
    bytes: u64,
    index: wgpu::SubmissionIndex,
    receiver: std::sync::mpsc::Receiver<Result<(), wgpu::BufferAsyncError>>,
}

impl Pending<'_> {
    /// Waits and hands the bytes to `take`.
    pub fn wait<R>(self, take: impl FnOnce(&[u8]) -> R) -> Result<R, RenderError> {
        let failed = |what: String| RenderError::Gpu(format!("{}: {what}", self.gpu.adapter()));
        self.gpu
            .device
            .poll(wgpu::PollType::Wait { submission_index: Some(self.index.clone()), timeout: None })
            .map_err(|e| failed(e.to_string()))?;
        self.gpu.check()?;
        match self.receiver.try_recv() {
            Ok(Ok(())) => {}
            Ok(Err(e)) => return Err(failed(format!("read back: {e}"))),
            Err(_) => return Err(failed("read back did not finish".into())),
        }
        let slice = self.host.slice(..self.bytes);
        let view = slice.get_mapped_range().map_err(|e| failed(format!("read back: {e}")))?;
        let result = take(&view);
        drop(view);
        self.host.unmap();
        Ok(result)
    }
}

/// A buffer that a shader writes, and its host-visible copy.
pub struct Output {
    /// What the shader writes.
    pub device: wgpu::Buffer,
    host: wgpu::Buffer,
    size: u64,
}

#[cfg(test)]
mod tests;
