//! What stands in for H.264 where kelir was built without it.

use std::convert::Infallible;

use super::Run;
use crate::RenderError;

/// There is none.
pub(super) struct Mp4(Infallible);

impl Mp4 {
    pub(super) fn new(_: Run) -> Result<Self, RenderError> {
        Err(RenderError::View(
            "an MP4 is written by a kelir that was built with its encoder (`cargo xtask release`); this one writes .apng, which is \
             lossless, and frames"
                .into(),
        ))
    }

    pub(super) fn frame(&mut self, _: &[u32]) -> Result<(), RenderError> {
        match self.0 {}
    }

    pub(super) fn finish(self) -> Result<Vec<u8>, RenderError> {
        match self.0 {}
    }
}
