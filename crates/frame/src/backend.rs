//! Where a renderer draws.

use serde::{Deserialize, Serialize};

use crate::RenderError;

/// Where it draws.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Backend {
    /// A real GPU where there is one, else the native code.
    #[default]
    Auto,
    /// Native code on all cores.
    Cpu,
    /// wgpu compute, on whatever adapter there is, also a software one.
    Gpu,
}

impl std::str::FromStr for Backend {
    type Err = RenderError;

    fn from_str(s: &str) -> Result<Self, Self::Err> {
        match s {
            "auto" => Ok(Self::Auto),
            "cpu" => Ok(Self::Cpu),
            "gpu" => Ok(Self::Gpu),
            _ => Err(RenderError::Knob(format!("backend = {s:?}: one of auto, cpu, gpu"))),
        }
    }
}
