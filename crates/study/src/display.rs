//! `[display]`: the sizes at which each stimulus is made, and what a page does with room beyond them.

use crate::schema::worded;
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

worded! {
    /// What a page does where there is more room than a size fills at one device pixel a stimulus pixel.
    pub enum Fit {
        /// nothing: a stimulus is never enlarged
        Native = "native",
        /// whole multiples: each stimulus pixel as a square of 2 × 2 device pixels, of 3 × 3, and so on
        Integer = "integer",
        /// as large as fits, resampled by the browser
        Fill = "fill",
    }
}

/// How stimuli stand on displays that differ, as far as the file says so.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct DisplayRules {
    /// Sizes [width, height] at which each stimulus is made, by rising width, in pixels; none: the study's `size` alone.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sizes: Vec<[u32; 2]>,
    /// What happens with room beyond them; absent: what the edition says.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fit: Option<Fit>,
}
