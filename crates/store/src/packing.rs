//! A stimulus packed for its way to a browser: one file, of one kind for whatever is shown, with the pixels of what is stored.
//!
//! It is a line of JSON ([`Head`]) and then its pictures, lossless WebP, one after another. A picture after the first holds what differs from
//! the one before it, over which it is drawn, and is transparent elsewhere: a page needs to read no pixels back, which browsers that guard
//! against fingerprints falsify.

use crate::pixels::{self, Manifest, Pixels, PixelsHash};
use crate::stimuli::ANIMATION;
use image::codecs::webp::WebPEncoder;
use image::{ExtendedColorType, ImageEncoder, RgbaImage};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;

/// Media type of a packed stimulus.
pub const PACKED: &str = "application/vnd.kelir.stimulus";

/// Counts the changes of what [`pack`] writes.
pub(crate) const PACKER: i64 = 1;

/// The first line of a packed stimulus. What follows its pictures is filling.
#[derive(Debug, Serialize, Deserialize)]
struct Head {
    /// Version of this format.
    format: u32,
    /// Media type of each picture.
    picture_type: String,
    width: u32,
    height: u32,
    /// Frames a second; 0 for a still.
    fps: f64,
    #[serde(rename = "loop")]
    repeat: bool,
    /// Which picture each frame shows.
    frames: Vec<usize>,
    /// Length of each picture.
    picture_bytes: Vec<usize>,
}

const FORMAT: u32 = 2;

/// Packs stored bytes; `frame` gives the bytes that a manifest names by hash.
///
/// # Errors
/// Why they cannot be packed, as a sentence's end.
pub(crate) fn pack(
    media_type: &str,
    bytes: &[u8],
    frame: &dyn Fn(&str) -> Option<Vec<u8>>,
) -> Result<Vec<u8>, String> {
    if media_type != ANIMATION {
        let (image, profile) = pixels::decode(bytes)?;
        let picture = webp(&image.into_rgba8(), profile)?;
        let size = pixels::of(media_type, bytes, frame)?.size;
        return joined(size, (0.0, false), vec![0], vec![picture]);
    }
    let manifest = Manifest::read(bytes)?;
    let mut known: HashMap<&str, usize> = HashMap::new();
    let (mut pictures, mut frames) = (Vec::new(), Vec::new());
    let mut last: Option<RgbaImage> = None;
    for name in &manifest.frames {
        let next = known.len();
        let index = *known.entry(name).or_insert(next);
        frames.push(index);
        if index < next {
            continue;
        }
        let image = manifest.picture(name, frame)?.into_rgba8();
        let step = match &last {
            None => webp(&image, None)?,
            Some(last) => webp(&changed(last, &image)?, None)?,
        };
        pictures.push(step);
        last = Some(image);
    }
    let size = last.ok_or("names no frames")?.dimensions().into();
    joined(size, (manifest.fps, manifest.repeat), frames, pictures)
}

/// `after` where it differs from `before`, transparent elsewhere.
fn changed(before: &RgbaImage, after: &RgbaImage) -> Result<RgbaImage, String> {
    if before.dimensions() != after.dimensions() {
        return Err(format!("has frames of different sizes: {} × {}", after.width(), after.height()));
    }
    let mut step = RgbaImage::new(after.width(), after.height());
    for (out, (a, b)) in step.pixels_mut().zip(before.pixels().zip(after.pixels())) {
        if b.0[3] != 255 {
            return Err("has frames that are not opaque".to_owned());
        }
        if a != b {
            *out = *b;
        }
    }
    Ok(step)
}

/// Lossless WebP, without an alpha channel where all is opaque.
fn webp(image: &RgbaImage, profile: Option<Vec<u8>>) -> Result<Vec<u8>, String> {
    let (width, height) = image.dimensions();
    let mut bytes = Vec::new();
    let mut encoder = WebPEncoder::new_lossless(&mut bytes);
    if let Some(profile) = profile {
        encoder.set_icc_profile(profile).map_err(|error| error.to_string())?;
    }
    let written = if image.pixels().all(|pixel| pixel.0[3] == 255) {
        let rgb: Vec<u8> = image.pixels().flat_map(|pixel| pixel.0[..3].to_vec()).collect();
        encoder.encode(&rgb, width, height, ExtendedColorType::Rgb8)
    } else {
        encoder.encode(image.as_raw(), width, height, ExtendedColorType::Rgba8)
    };
    written.map_err(|error| format!("cannot be packed: {error}"))?;
    Ok(bytes)
}

fn joined(
    [width, height]: [u32; 2],
    (fps, repeat): (f64, bool),
    frames: Vec<usize>,
    pictures: Vec<Vec<u8>>,
) -> Result<Vec<u8>, String> {
    let picture_bytes = pictures.iter().map(Vec::len).collect();
    let picture_type = "image/webp".to_owned();
    let head = Head { format: FORMAT, picture_type, width, height, fps, repeat, frames, picture_bytes };
    let mut bytes = serde_json::to_vec(&head).map_err(|error| error.to_string())?;
    bytes.push(b'\n');
    bytes.extend(pictures.into_iter().flatten());
    Ok(bytes)
}

/// What a packed stimulus shows, read as a page reads it.
///
/// # Errors
/// Why it cannot be read.
pub(crate) fn unpacked(bytes: &[u8]) -> Result<Pixels, String> {
    let end = bytes.iter().position(|byte| *byte == b'\n').ok_or("has no head")?;
    let head: Head = serde_json::from_slice(&bytes[..end]).map_err(|error| format!("has a head that {error}"))?;
    if head.format != FORMAT {
        return Err(format!("has format {}; known is {FORMAT}", head.format));
    }
    let mut rest = &bytes[end + 1..];
    let mut shown: Vec<RgbaImage> = Vec::new();
    for length in &head.picture_bytes {
        let (picture, after) = rest.split_at_checked(*length).ok_or("is cut short")?;
        rest = after;
        let mut image = pixels::decode(picture)?.0.into_rgba8();
        if let Some(before) = shown.last() {
            for (pixel, before) in image.pixels_mut().zip(before.pixels()) {
                if pixel.0[3] == 0 {
                    *pixel = *before;
                }
            }
        }
        shown.push(image);
    }
    let size = [head.width, head.height];
    let mut hash = match head.fps {
        0.0 => PixelsHash::still(size),
        fps => PixelsHash::animation(size, head.frames.len(), fps, head.repeat)?,
    };
    for index in head.frames {
        hash.frame(shown.get(index).ok_or("shows a picture that it has not")?)?;
    }
    Ok(hash.finish())
}
