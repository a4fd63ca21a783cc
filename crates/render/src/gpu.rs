//! The wgpu device that techniques share.
