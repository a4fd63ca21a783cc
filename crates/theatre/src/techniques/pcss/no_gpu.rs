//! The filter on a GPU where kelir was built without one.

use kelir_frame::RenderError;
use kelir_frame::gpu::Gpu;

use super::native::{Job, Shader};

pub(super) const WGSL: &str = "";

/// What cannot be, as there is no device.
pub(super) struct OnGpu {
    pub gpu: Gpu,
}

impl OnGpu {
    pub(super) fn new(gpu: Gpu, _: &str) -> Result<Self, RenderError> {
        match gpu {}
    }

    pub(super) fn prepare(&mut self, _: &Shader) -> Result<Gpu, RenderError> {
        match self.gpu {}
    }

    pub(super) fn run(&mut self, scene: &Gpu, _: &[Job]) -> Result<Vec<u32>, RenderError> {
        match *scene {}
    }
}
