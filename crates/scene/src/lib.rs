//! What is drawn: a scene file becomes a [`Scene`], and a scene at one instant a [`Theatre`].
//!
//! Reading is strict and never stops at the first problem: [`SceneErrors`] holds all of them, each with file, field,
//! value and rule. Input may be hostile; [`limits`] says how large a scene may be.
//!
//! # Keys of a scene file
//! | key | default | meaning |
//! |---|---|---|
//! | `screen.width_m`, `.height_m` | | the cloth, in metres |
//! | `screen.albedo` | | a number, `[r, g, b]`, `{ image = "…" }` (opaque sRGB, stretched) or `{ weave = { base = 0.8, threads = 480, contrast = 0.08, vignette = 0.0, seed = 1 } }` |
//! | `lamp.position_m` | | the common centre of all emitters, z < 0 |
//! | `lamp.emitters[]` | | `name`; `shape` = `"rectangle"` with `size_m` or `"disk"` with `radius_m`; `radiance`, a number or `[r, g, b]` |
//! | `ambient.model` | `"none"` | `"none"`; `"paper"` with `k_d_m` and `s`; `"dome"` with `radiance` |
//! | `exposure.white` | `"auto"` | `"auto"` or a radiance |
//! | `puppets[].image` | | an SVG, a PNG, or a puppet manifest (`.toml`) |
//! | `puppets[].height_m`, `.position_m` | | the image's height and centre |
//! | `puppets[].translucent` | `false` | whether the image's colour is what a part lets through |
//! | `puppets[].rotate_deg`, `.tilt_deg` | 0, `[0, 0]` | in its plane, counter-clockwise; about x, then about y |
//! | `puppets[].pose` | `{}` | part = degrees about its pivot, counter-clockwise |
//! | `puppets[].texels` | 1024; a PNG's own | rows of the grid at rest, 64 to 8192 |
//! | `puppets[].bits` | 8 | 8 or 16 bits a texel |
//! | `timeline.fps`, `.seconds`, `.loop` | , , `false` | frames a second and length |
//! | `timeline.tracks[]` | | `target` (`lamp.position_m` or `puppets[i].position_m`, `.rotate_deg`, `.tilt_deg`, `.pose.<part>`), `easing` = `"linear"`, `"smooth"` or `"step"`, `keys` = `[{ t, value }, …]` |
//!
//! Paths are relative to the file that names them. A puppet manifest has `image`, optionally `title`, `source` and
//! `license`, and `[[parts]]` in drawing order: `id` (a group directly under `<svg>`), `parent`, `pivot` (SVG user
//! units), `limits_deg`.

mod assets;
mod colour;
mod fields;
pub mod limits;
mod load;
mod problem;
mod puppet;
mod read;
mod scene;
mod staging;
pub mod theatre;
mod timeline;
mod weave;

pub use assets::{Assets, DirAssets};
pub use colour::srgb_to_linear;
pub use problem::{Problem, SceneErrors};
pub use scene::Scene;
pub use theatre::*;
pub use timeline::Timeline;
