#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

use super::*;
use image::codecs::jpeg::JpegEncoder;
use image::codecs::png::PngEncoder;

fn png(raw: &[u8], [width, height]: [u32; 2], colour: ExtendedColorType) -> Vec<u8> {
    let mut bytes = Vec::new();
    PngEncoder::new(&mut bytes).write_image(raw, width, height, colour).unwrap();
    bytes
}

/// Every byte value, in no order.
fn noise(length: usize, seed: usize) -> Vec<u8> {
    (0..length).map(|i| ((i * 7919 + seed * 104_729) % 65_537 % 256) as u8).collect()
}

fn none(_: &str) -> Option<Vec<u8>> {
    None
}

/// Packs a still and checks that it shows the same; gives the packing.
fn same(media_type: &str, stored: &[u8]) -> Vec<u8> {
    let packed = pack(media_type, stored, &none).unwrap();
    assert_eq!(unpacked(&packed).unwrap(), pixels::of(media_type, stored, &none).unwrap());
    packed
}

#[test]
fn stills_of_every_kind_keep_their_pixels() {
    let size = [61, 17];
    let n = 61 * 17;
    for (colour, bytes) in [
        (ExtendedColorType::L8, 1),
        (ExtendedColorType::La8, 2),
        (ExtendedColorType::Rgb8, 3),
        (ExtendedColorType::Rgba8, 4),
        (ExtendedColorType::Rgb16, 6),
    ] {
        same("image/png", &png(&noise(n * bytes, bytes), size, colour));
    }
    let (mut jpeg, rgb) = (Vec::new(), noise(n * 3, 9));
    JpegEncoder::new_with_quality(&mut jpeg, 90).encode(&rgb, 61, 17, ExtendedColorType::Rgb8).unwrap();
    same("image/jpeg", &jpeg);
    // A camera that was held upright says so (Exif, orientation 6): the picture is packed as it is seen.
    let exif = b"Exif\0\0II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0\x06\0\0\0\0\0\0\0";
    let mut turned = vec![0xff, 0xd8, 0xff, 0xe1, 0, exif.len() as u8 + 2];
    turned.extend(exif);
    turned.extend(&jpeg[2..]);
    let packed = same("image/jpeg", &turned);
    assert_eq!(unpacked(&packed).unwrap().size, [17, 61]);
}

#[test]
fn a_colour_profile_stays_with_the_picture() {
    let (mut bytes, profile) = (Vec::new(), b"a profile that nobody reads here".to_vec());
    let mut encoder = PngEncoder::new(&mut bytes);
    encoder.set_icc_profile(profile.clone()).unwrap();
    encoder.write_image(&noise(48, 1), 4, 4, ExtendedColorType::Rgb8).unwrap();
    let packed = same("image/png", &bytes);
    let end = packed.iter().position(|byte| *byte == b'\n').unwrap();
    assert_eq!(pixels::decode(&packed[end + 1..]).unwrap().1, Some(profile));
}

/// Frames of a dark bar that wanders over noise, by name; `d` is `b` again.
fn frame(name: &str) -> Option<Vec<u8>> {
    let at = match name {
        "a" => 3,
        "b" | "d" => 5,
        "c" => 40,
        _ => return None,
    };
    let mut rgb = noise(64 * 32 * 3, 1);
    for y in 0..32 {
        for x in at..at + 9 {
            let first = (y * 64 + x) * 3;
            rgb[first..first + 3].fill((x * y) as u8);
        }
    }
    Some(png(&rgb, [64, 32], ExtendedColorType::Rgb8))
}

fn manifest(frames: &str) -> Vec<u8> {
    format!(r#"{{"fps":12.5,"loop":true,"width":64,"height":32,"frames":[{frames}]}}"#).into_bytes()
}

#[test]
fn an_animation_keeps_every_frame_and_is_smaller() {
    let stored = manifest(r#""a","b","c","b","a","d""#);
    let packed = pack(ANIMATION, &stored, &frame).unwrap();
    assert_eq!(unpacked(&packed).unwrap(), pixels::of(ANIMATION, &stored, &frame).unwrap());
    let frames: usize = ["a", "b", "c", "d"].iter().map(|name| frame(name).unwrap().len()).sum();
    assert!(packed.len() * 2 < frames, "{} of {frames}", packed.len());
    // What fills a packing up to another's length shows nothing.
    let filled = [packed.clone(), vec![0; 1000]].concat();
    assert_eq!(unpacked(&filled).unwrap(), unpacked(&packed).unwrap());
    // Negative control: other frames are others.
    let other = pack(ANIMATION, &manifest(r#""a","b","c","b","b","d""#), &frame).unwrap();
    assert_ne!(unpacked(&other).unwrap(), unpacked(&packed).unwrap());
}

#[test]
fn what_cannot_be_packed_or_unpacked_is_said() {
    let cut = |bytes: &[u8], by: usize| unpacked(&bytes[..bytes.len() - by]).unwrap_err();
    let packed = pack(ANIMATION, &manifest(r#""a","b""#), &frame).unwrap();
    assert!(cut(&packed, 1).contains("cut short"));
    assert!(cut(&packed, packed.len()).contains("head"));
    assert!(unpacked(b"{\"format\":1}\n").unwrap_err().contains("head"));
    assert!(pack(ANIMATION, &manifest(r#""a","x""#), &frame).unwrap_err().contains("not stored: x"));
    assert!(pack("image/png", b"GIF89a", &none).unwrap_err().contains("no PNG or JPEG"));
}
