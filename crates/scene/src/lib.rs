//! What is drawn: a scene file becomes a [`Scene`], and a scene at one instant a [`Theatre`].
pub mod theatre;
pub use theatre::*;
