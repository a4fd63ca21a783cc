//! What a stimulus shows, whatever its file is like: a hash over decoded pixels, so that a file may be packed anew without a new version.

use image::{DynamicImage, ImageDecoder, ImageReader, RgbaImage};
use serde::Deserialize;
use sha2::{Digest, Sha256};
use std::io::Cursor;

/// Media type of an animation's manifest.
pub const ANIMATION: &str = "application/vnd.kelir.animation+json";

/// Size and pixels of a stimulus.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Pixels {
    /// [width, height].
    pub(crate) size: [u32; 2],
    /// SHA-256 (hex) over "kelir-pixels/1", line feed, "WIDTH HEIGHT FRAMES FPS LOOP", line feed, and each frame's RGBA8 rows; a still has one
    /// frame, 0 fps and loop false.
    pub(crate) sha256: String,
}

/// Size of a picture that can be stored: it is decoded wholly, as when it is stored.
///
/// # Errors
/// Why it cannot be decoded, as a sentence's end.
pub fn picture_size(bytes: &[u8]) -> Result<[u32; 2], String> {
    decode(bytes).map(|(image, _)| [image.width(), image.height()])
}

/// An animation's manifest, as far as it says what is shown.
#[derive(Deserialize)]
pub(crate) struct Manifest {
    pub(crate) fps: f64,
    #[serde(rename = "loop")]
    pub(crate) repeat: bool,
    /// Hashes of the frames' files.
    pub(crate) frames: Vec<String>,
}

impl Manifest {
    pub(crate) fn read(bytes: &[u8]) -> Result<Manifest, String> {
        serde_json::from_slice(bytes).map_err(|error| format!("is no manifest of an animation: {error}"))
    }

    /// The frame that is named so; `file` gives its bytes.
    pub(crate) fn picture(
        &self,
        name: &str,
        file: &dyn Fn(&str) -> Option<Vec<u8>>,
    ) -> Result<DynamicImage, String> {
        let bytes = file(name).ok_or_else(|| format!("names a frame that is not stored: {name}"))?;
        Ok(decode(&bytes)?.0)
    }
}

/// The pixels of stored bytes; `frame` gives the bytes that a manifest names by hash.
///
/// # Errors
/// Why they cannot be decoded, as a sentence's end: "is no PNG or JPEG: …".
pub(crate) fn of(
    media_type: &str,
    bytes: &[u8],
    frame: &dyn Fn(&str) -> Option<Vec<u8>>,
) -> Result<Pixels, String> {
    if media_type != ANIMATION {
        let image = decode(bytes)?.0.into_rgba8();
        let mut hash = PixelsHash::still(image.dimensions().into());
        hash.frame(&image)?;
        return Ok(hash.finish());
    }
    let manifest = Manifest::read(bytes)?;
    let first = manifest.picture(manifest.frames.first().ok_or("names no frames")?, frame)?;
    let size = [first.width(), first.height()];
    let mut hash = PixelsHash::animation(size, manifest.frames.len(), manifest.fps, manifest.repeat)?;
    for name in &manifest.frames {
        hash.frame(&manifest.picture(name, frame)?.into_rgba8())?;
    }
    Ok(hash.finish())
}

/// A picture as a browser shows it, turned as it says, and its colour profile.
pub(crate) fn decode(bytes: &[u8]) -> Result<(DynamicImage, Option<Vec<u8>>), String> {
    let wrong = |error: image::ImageError| format!("is no PNG or JPEG: {error}");
    let reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format();
    let mut decoder =
        reader.map_err(|error| format!("cannot be read: {error}"))?.into_decoder().map_err(wrong)?;
    let orientation = decoder.orientation().map_err(wrong)?;
    let profile = decoder.icc_profile().map_err(wrong)?;
    let mut image = DynamicImage::from_decoder(decoder).map_err(wrong)?;
    image.apply_orientation(orientation);
    Ok((image, profile))
}

/// The hash of what is shown, taken frame by frame.
pub(crate) struct PixelsHash {
    size: [u32; 2],
    hasher: Sha256,
}

impl PixelsHash {
    pub(crate) fn still(size: [u32; 2]) -> PixelsHash {
        PixelsHash::new(size, "1 0 false")
    }

    pub(crate) fn animation(
        size: [u32; 2],
        frames: usize,
        fps: f64,
        repeat: bool,
    ) -> Result<PixelsHash, String> {
        let fps = kelir_jcs::canonical(fps.into()).map_err(|error| error.to_string())?;
        Ok(PixelsHash::new(size, &format!("{frames} {fps} {repeat}")))
    }

    fn new(size: [u32; 2], header: &str) -> PixelsHash {
        let [width, height] = size;
        let mut hasher = Sha256::new();
        hasher.update(format!("kelir-pixels/1\n{width} {height} {header}\n"));
        PixelsHash { size, hasher }
    }

    pub(crate) fn frame(&mut self, image: &RgbaImage) -> Result<(), String> {
        if <[u32; 2]>::from(image.dimensions()) != self.size {
            return Err(format!("has frames of different sizes: {} × {}", image.width(), image.height()));
        }
        self.hasher.update(image.as_raw());
        Ok(())
    }

    pub(crate) fn finish(self) -> Pixels {
        let sha256 = hex::encode(self.hasher.finalize());
        Pixels { size: self.size, sha256 }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

    use super::*;
    use image::codecs::png::{CompressionType, FilterType, PngEncoder};
    use image::{ExtendedColorType, ImageEncoder};

    fn png(grey: &[u8], width: u32, compression: CompressionType, filter: FilterType) -> Vec<u8> {
        let mut bytes = Vec::new();
        let height = grey.len() as u32 / width;
        let encoder = PngEncoder::new_with_quality(&mut bytes, compression, filter);
        encoder.write_image(grey, width, height, ExtendedColorType::L8).unwrap();
        bytes
    }

    fn still(bytes: &[u8]) -> Result<Pixels, String> {
        of("image/png", bytes, &|_| None)
    }

    #[test]
    fn a_file_packed_anew_shows_the_same_and_another_pixel_does_not() {
        let grey: Vec<u8> = (0..=255).cycle().take(64 * 9).collect();
        let (fast, best) = (CompressionType::Fast, CompressionType::Best);
        let one = png(&grey, 64, fast, FilterType::NoFilter);
        let two = png(&grey, 64, best, FilterType::Paeth);
        assert_ne!(one, two);
        assert_eq!(still(&one), still(&two));
        let mut other = grey.clone();
        other[100] ^= 1;
        assert_ne!(still(&png(&other, 64, fast, FilterType::NoFilter)), still(&one));
        assert_ne!(
            still(&png(&grey, 32, fast, FilterType::NoFilter)),
            still(&one),
            "the same bytes in other rows"
        );
    }

    #[test]
    fn the_hash_is_that_of_the_contract() {
        // printf 'kelir-pixels/1\n2 1 1 0 false\n\x07\x07\x07\xff\x09\x09\x09\xff' | sha256sum
        let found = still(&png(&[7, 9], 2, CompressionType::Fast, FilterType::NoFilter)).unwrap();
        assert_eq!(found.size, [2, 1]);
        assert_eq!(found.sha256, "405f086e0299c024cdd5112790c59cc3b13faac59f4de07e222c3f9b5eefc1ce");
        // … 2 1 3 12.5 true\n, then the frame of 7 and 9, that of 9 and 7, and the first again.
        let frames = [[7, 9], [9, 7]].map(|grey| png(&grey, 2, CompressionType::Fast, FilterType::NoFilter));
        let manifest = br#"{"fps":12.5,"loop":true,"width":2,"height":1,"frames":["a","b","a"]}"#;
        let frame = |name: &str| frames.get(usize::from(name != "a")).cloned();
        let found = of(ANIMATION, manifest, &frame).unwrap();
        assert_eq!(found.sha256, "124d7f1e090dd8ef9b232dad69c6b28ca7532ac218e0484d62dcf9748fe1056e");
        let slower = String::from_utf8_lossy(manifest).replace("12.5", "12");
        assert_ne!(of(ANIMATION, slower.as_bytes(), &frame).unwrap().sha256, found.sha256);
    }

    #[test]
    fn what_cannot_be_decoded_is_said() {
        assert!(still(b"GIF89a").unwrap_err().contains("no PNG or JPEG"));
        let whole = png(&[0; 4096], 64, CompressionType::Fast, FilterType::NoFilter);
        assert!(still(&whole[..whole.len() / 2]).is_err());
        assert!(of(ANIMATION, b"{}", &|_| None).unwrap_err().contains("manifest"));
        let named = br#"{"fps":1,"loop":true,"frames":["x"]}"#;
        assert!(of(ANIMATION, named, &|_| None).unwrap_err().contains("not stored: x"));
    }
}
