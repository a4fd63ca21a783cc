//! Mesh files read. A file is somebody's: nothing in it makes this panic, or take more memory than its size and [`LIMIT`] explain.

mod gltf;
mod obj;
mod ply;
mod polygon;

use crate::{Fault, Model};

/// Vertices, and triangles, that a file may have.
pub const LIMIT: usize = 1 << 24;

/// What a file's numbers are in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Unit {
    /// Metres, as glTF has it.
    #[default]
    Metre,
    /// Centimetres.
    Centimetre,
    /// Millimetres.
    Millimetre,
    /// Inches, of 25.4 mm.
    Inch,
}

impl Unit {
    /// Every unit.
    pub const ALL: [Unit; 4] = [Unit::Metre, Unit::Centimetre, Unit::Millimetre, Unit::Inch];

    /// `m`, `cm`, `mm` or `in`.
    pub fn name(self) -> &'static str {
        match self {
            Unit::Metre => "m",
            Unit::Centimetre => "cm",
            Unit::Millimetre => "mm",
            Unit::Inch => "in",
        }
    }

    /// Its length.
    pub fn metres(self) -> f64 {
        match self {
            Unit::Metre => 1.0,
            Unit::Centimetre => 0.01,
            Unit::Millimetre => 0.001,
            Unit::Inch => 0.0254,
        }
    }
}

/// A kind of mesh file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Wavefront OBJ: `v`, `vt`, `vn` and `f`; materials and lines are passed over.
    Obj,
    /// PLY, in text or binary of either order.
    Ply,
    /// glTF 2.0 in text, its buffers within it or beside it.
    Gltf,
    /// glTF 2.0 in one binary file.
    Glb,
}

impl Format {
    /// By the end of a file's name.
    pub fn of(name: &str) -> Option<Format> {
        match name.rsplit_once('.')?.1.to_ascii_lowercase().as_str() {
            "obj" => Some(Format::Obj),
            "ply" => Some(Format::Ply),
            "gltf" => Some(Format::Gltf),
            "glb" => Some(Format::Glb),
            _ => None,
        }
    }
}

/// Reads a file. `beside` answers a file beside it by its name there, which is relative and leaves no folder; only glTF asks for any.
///
/// Indices out of range and positions that are no numbers are read as they are: [`check()`](crate::check()) counts them. Errors: the first thing that
/// breaks the format, or that this reader leaves out (morph targets, sparse accessors, required extensions, …), by its name.
pub fn read(
    bytes: &[u8],
    format: Format,
    unit: Unit,
    beside: &mut dyn FnMut(&str) -> Result<Vec<u8>, String>,
) -> Result<Model, Fault> {
    let mut model = match format {
        Format::Obj => obj::read(bytes)?.into(),
        Format::Ply => ply::read(bytes)?.into(),
        Format::Gltf => gltf::read_text(bytes, beside)?,
        Format::Glb => gltf::read_binary(bytes, beside)?,
    };
    if unit != Unit::Metre {
        model.scale(unit.metres());
    }
    Ok(model)
}

/// Errors: more than [`LIMIT`] of what `place` counts.
fn within(count: usize, place: impl Into<String>) -> Result<usize, Fault> {
    if count > LIMIT {
        return Err(Fault::of(place, count, format!("at most {LIMIT} vertices, and as many triangles")));
    }
    Ok(count)
}
