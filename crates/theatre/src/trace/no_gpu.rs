//! The sampler on a GPU where kelir was built without one.

use std::sync::Arc;

use kelir_frame::RenderError;
use kelir_frame::gpu::Gpu;

use super::bounds::Padded;
use super::estimate::Job;
use super::plan::Plan;
use super::sobol::Points;
use super::tables::Tables;

pub(super) const WGSL: &str = "";

/// What cannot be, as there is no device.
pub(super) struct Sampler {
    pub gpu: Gpu,
}

impl Sampler {
    pub(super) fn new(gpu: Gpu, _: &str) -> Result<Self, RenderError> {
        match gpu {}
    }

    pub(super) fn prepare(
        &mut self,
        _: &Plan,
        _: &[u64],
        _: &[Arc<Padded>],
        _: &Points,
        _: &Tables,
    ) -> Result<Gpu, RenderError> {
        match self.gpu {}
    }

    pub(super) fn run(&mut self, _: &Plan, scene: &Gpu, _: &[Job]) -> Result<Vec<f32>, RenderError> {
        match *scene {}
    }
}
