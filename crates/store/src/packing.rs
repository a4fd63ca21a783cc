//! A stimulus packed for its way to a browser: one file, of one kind for whatever is shown, with the pixels of what is stored.
//!
//! It is a line of JSON ([`Head`]) and then its pictures, lossless WebP, one after another. A picture after the first is a step from the one
//! before it and twice as high: above, what is brighter, which is added; below, what is darker, which is taken away. A canvas can do both by
//! itself ("lighter", "difference"), so that a page needs to read no pixels back: browsers that guard against fingerprints falsify those.

use crate::pixels::{self, ANIMATION, Manifest, Pixels, PixelsHash};
use image::codecs::webp::WebPEncoder;
use image::{ExtendedColorType, ImageEncoder, Rgba, RgbaImage};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use webp::{Encoder, PixelLayout, WebPConfig};

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
        let image = image.into_rgba8();
        let picture = webp(&image, profile)?;
        return joined(image.dimensions().into(), (0.0, false), vec![0], vec![picture]);
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
            Some(last) => webp(&step(last, &image)?, None)?,
        };
        pictures.push(step);
        last = Some(image);
    }
    let size = last.ok_or("names no frames")?.dimensions().into();
    joined(size, (manifest.fps, manifest.repeat), frames, pictures)
}

/// How many bytes a still takes when it is packed.
///
/// # Errors
/// Why it cannot be packed, as a sentence's end.
pub fn packed_bytes(picture: &[u8]) -> Result<u64, String> {
    Ok(pack("", picture, &|_| None)?.len() as u64)
}

/// How many bytes the step takes from one picture of an animation to the next.
///
/// # Errors
/// Why it cannot be packed, as a sentence's end.
pub fn step_bytes(before: &[u8], after: &[u8]) -> Result<u64, String> {
    let [before, after] = [pixels::decode(before)?.0.into_rgba8(), pixels::decode(after)?.0.into_rgba8()];
    Ok(webp(&step(&before, &after)?, None)?.len() as u64)
}

/// From `before` to `after`: what is brighter above what is darker.
fn step(before: &RgbaImage, after: &RgbaImage) -> Result<RgbaImage, String> {
    let (width, height) = after.dimensions();
    if before.dimensions() != (width, height) {
        return Err(format!("has frames of different sizes: {width} × {height}"));
    }
    let opaque = |image: &RgbaImage| image.pixels().all(|pixel| pixel.0[3] == 255);
    if !opaque(before) || !opaque(after) {
        return Err("has frames that are not opaque".to_owned());
    }
    let (mut brighter, mut darker) = (Vec::new(), Vec::new());
    for (a, b) in before.pixels().zip(after.pixels()) {
        let [added, taken] =
            [[b, a], [a, b]].map(|[more, less]| channels(|c| more.0[c].saturating_sub(less.0[c])));
        brighter.extend(added);
        darker.extend(taken);
    }
    brighter.extend(darker);
    RgbaImage::from_raw(width, 2 * height, brighter).ok_or_else(|| "is too large".to_owned())
}

/// An opaque pixel.
fn channels(of: impl Fn(usize) -> u8) -> [u8; 4] {
    [of(0), of(1), of(2), 255]
}

/// What follows `before` by a step.
fn stepped(before: &RgbaImage, step: &RgbaImage) -> Result<RgbaImage, String> {
    let (width, height) = before.dimensions();
    if step.dimensions() != (width, 2 * height) {
        return Err("has a step of another size".to_owned());
    }
    Ok(RgbaImage::from_fn(width, height, |x, y| {
        let [now, added, taken] =
            [before.get_pixel(x, y), step.get_pixel(x, y), step.get_pixel(x, y + height)];
        Rgba(channels(|c| now.0[c].saturating_add(added.0[c]).abs_diff(taken.0[c])))
    }))
}

/// Lossless WebP, without an alpha channel where all is opaque.
fn webp(image: &RgbaImage, profile: Option<Vec<u8>>) -> Result<Vec<u8>, String> {
    let (width, height) = image.dimensions();
    let opaque = image.pixels().all(|pixel| pixel.0[3] == 255);
    let (pixels, layout, colour) = if opaque {
        let rgb = image.pixels().flat_map(|pixel| pixel.0.into_iter().take(3)).collect();
        (rgb, PixelLayout::Rgb, ExtendedColorType::Rgb8)
    } else {
        (image.as_raw().clone(), PixelLayout::Rgba, ExtendedColorType::Rgba8)
    };
    if let Some(profile) = profile {
        let mut bytes = Vec::new();
        let mut encoder = WebPEncoder::new_lossless(&mut bytes);
        encoder.set_icc_profile(profile).map_err(|error| error.to_string())?;
        let written = encoder.encode(&pixels, width, height, colour);
        return written.map(|()| bytes).map_err(|error| format!("cannot be packed: {error}"));
    }
    let mut config = WebPConfig::new().map_err(|()| "cannot be packed".to_owned())?;
    // More effort takes ten times as long and saves nothing here.
    (config.lossless, config.exact, config.method, config.quality) = (1, 1, 2, 50.0);
    let packed = Encoder::new(&pixels, layout, width, height).encode_advanced(&config);
    packed.map(|bytes| bytes.to_vec()).map_err(|error| format!("cannot be packed: {error:?}"))
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
    let head: Head =
        serde_json::from_slice(&bytes[..end]).map_err(|error| format!("has a head that {error}"))?;
    if head.format != FORMAT {
        return Err(format!("has format {}; known is {FORMAT}", head.format));
    }
    let mut rest = &bytes[end + 1..];
    let mut shown: Vec<RgbaImage> = Vec::new();
    for length in &head.picture_bytes {
        let (picture, after) = rest.split_at_checked(*length).ok_or("is cut short")?;
        rest = after;
        let image = pixels::decode(picture)?.0.into_rgba8();
        shown.push(match shown.last() {
            Some(before) => stepped(before, &image)?,
            None => image,
        });
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

#[cfg(test)]
mod tests;
