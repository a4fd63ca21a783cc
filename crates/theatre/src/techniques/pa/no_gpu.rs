//! The passes on a GPU where kelir was built without one.

use kelir_frame::gpu::Gpu;
use kelir_frame::{RenderError, Renderer};
use kelir_scene::Theatre;

use super::Knobs;

pub(super) fn renderer(gpu: Gpu, _: Knobs) -> Result<Box<dyn Renderer<Theatre>>, RenderError> {
    match gpu {}
}
