//! The passes on a GPU where kelir was built without one.

use super::Knobs;
use crate::gpu::Gpu;
use crate::{RenderError, Renderer};

pub(super) fn renderer(gpu: Gpu, _: Knobs) -> Result<Box<dyn Renderer>, RenderError> {
    match gpu {}
}
