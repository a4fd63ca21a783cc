//! Puppets: from SVG, PNG or manifest to quantised transmittance.

pub(crate) mod bitmap;
pub(crate) mod compose;
pub(crate) mod figure;
pub(crate) mod grid;
pub(crate) mod manifest;
pub(crate) mod masks;
pub(crate) mod read;
pub(crate) mod svg;
