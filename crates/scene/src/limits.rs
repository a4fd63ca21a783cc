//! How large a scene may be. What is beyond is refused by name before memory or time is spent on it.

/// Bytes of a scene file.
pub const SCENE_BYTES: usize = 1 << 20;
/// Bytes of a puppet manifest.
pub const MANIFEST_BYTES: usize = 1 << 18;
/// Bytes of an SVG.
pub const SVG_BYTES: usize = 8 << 20;
/// Bytes of a PNG or JPEG.
pub const IMAGE_BYTES: usize = 128 << 20;
/// Pixels or texels along a side of an image, or of a puppet's grid at rest.
pub const IMAGE_SIDE: usize = 8192;
/// Texels along a side of a posed or rotated grid.
pub const GRID_SIDE: usize = 16384;
/// Texel values (texels × channels) of all puppets together.
pub const SCENE_TEXELS: usize = 1 << 28;
/// Texels of all parts of one puppet together.
pub const PART_TEXELS: usize = 1 << 27;
/// Emitters of the lamp.
pub const EMITTERS: usize = 64;
/// Objects of a stage.
pub const OBJECTS: usize = 256;
/// Lights of a stage.
pub const LIGHTS: usize = 64;
/// Bytes of a mesh's file.
pub const MESH_BYTES: usize = 256 << 20;
/// Puppets.
pub const PUPPETS: usize = 256;
/// Parts of a puppet.
pub const PARTS: usize = 256;
/// Tracks of a timeline.
pub const TRACKS: usize = 1024;
/// Keys of a track.
pub const KEYS: usize = 10_000;
/// Frames of a timeline.
pub const FRAMES: usize = 100_000;
/// Frames a second.
pub const FPS: f64 = 1000.0;
/// Elements of an SVG, counted as often as they are drawn (`use`, masks), long paths for more than one.
pub const SVG_ELEMENTS: u64 = 100_000;
/// Bytes of an SVG times its parts: each part is read by itself.
pub const SVG_SPLIT_BYTES: usize = 1 << 28;
/// Bytes of an SVG's style sheets times its elements.
pub const SVG_STYLING: usize = 1 << 28;
/// Elements within elements, followed through references.
pub const SVG_DEPTH: usize = 64;
/// Coordinates in metres.
pub const COORDINATE_M: f64 = 1e6;
/// The least length in metres: what is smaller has no area in f64 arithmetic that squares it.
pub const LENGTH_M: f64 = 1e-9;
/// Radiance.
pub const RADIANCE: f64 = 1e15;
/// Degrees.
pub const DEGREES: f64 = 1e6;
