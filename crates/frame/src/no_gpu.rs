//! What stands in for the GPU where kelir was built without it: there is none.

use serde::Serialize;

use crate::{Backend, RenderError};

/// What to do for one.
const HOW_TO_BUILD: &str = "this kelir was built without its GPU backend: `cargo xtask release` builds all of kelir, `cargo xtask serve --gpu` \
    a server with it; or use `--backend cpu`";

/// A device that cannot be.
#[derive(Clone)]
pub enum Gpu {}

/// What a device can hold at most.
#[derive(Clone, Copy, Debug, Serialize)]
pub enum Limits {}

/// None.
pub fn adapters() -> Vec<String> {
    Vec::new()
}

/// The native backend, for `None`. Errors: the GPU was asked for.
pub fn choose(backend: Backend) -> Result<Option<Gpu>, RenderError> {
    match backend {
        Backend::Cpu | Backend::Auto => Ok(None),
        Backend::Gpu => Err(RenderError::Gpu(HOW_TO_BUILD.into())),
    }
}

impl Gpu {
    /// "name (type, driver)".
    pub fn adapter(&self) -> String {
        match *self {}
    }

    /// What it can hold.
    pub fn limits(&self) -> Limits {
        match *self {}
    }

    /// Whether a CPU imitates it.
    pub fn is_software(&self) -> bool {
        match *self {}
    }

    /// The class of a job's key.
    pub fn class(&self) -> String {
        match *self {}
    }
}
