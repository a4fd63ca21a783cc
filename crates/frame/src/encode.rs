//! From linear light to sRGB codes and image files.

use std::sync::OnceLock;

use crate::exposure::Rule;
use crate::{Frame, RenderError};

/// Every f32 belongs to one of these bins by its exponent and seven bits of mantissa; codes are at least 0.8 % apart, so
/// a bin holds at most one step.
pub const LOWEST: u32 = 114 << 23; // 2⁻¹³: below the first step
const BINS: usize = 13 << 7;

/// The encoder's table; get it once with [`Srgb::get`].
#[derive(Debug)]
pub struct Srgb {
    /// Code at the bin's start in the high half; in the low half 2¹⁶ minus the step's place, so that adding a value's own
    /// low mantissa bits carries into the code exactly where the step is.
    entries: Vec<u32>,
}

/// The sRGB transfer function (IEC 61966-2-1) in f64: linear [0, 1] to encoded [0, 1].
pub fn oetf(linear: f64) -> f64 {
    if linear <= 0.0031308 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// The code of `linear` from the definition: round(255 · oetf(clip(linear))); NaN is 0.
pub fn code_exact(linear: f32) -> u8 {
    let clipped = if linear > 0.0 { f64::from(linear).min(1.0) } else { 0.0 };
    (255.0 * oetf(clipped)).round() as u8
}

impl Srgb {
    /// The table, built on first use by bisecting the definition for every step.
    pub fn get() -> &'static Self {
        static TABLE: OnceLock<Srgb> = OnceLock::new();
        TABLE.get_or_init(|| {
            let entry = |bin: usize| {
                let start = LOWEST + ((bin as u32) << 16);
                let code = |low: u32| u32::from(code_exact(f32::from_bits(start + low)));
                let (base, last) = (code(0), code(0xffff));
                debug_assert!(last - base <= 1, "one step a bin");
                if last == base {
                    return base << 16;
                }
                let (mut below, mut above) = (0, 0xffff);
                while above - below > 1 {
                    let middle = (below + above) / 2;
                    if code(middle) == base { below = middle } else { above = middle }
                }
                (base << 16) + (0x10000 - above)
            };
            Srgb { entries: (0..BINS).map(entry).collect() }
        })
    }

    /// The table itself, for shaders.
    pub fn entries(&self) -> &[u32] {
        &self.entries
    }

    /// [`code_exact`] for every f32, from the table.
    #[inline(always)]
    pub fn code(&self, linear: f32) -> u32 {
        let bits = linear.max(f32::from_bits(LOWEST)).min(f32::from_bits(0x3f7f_ffff)).to_bits();
        // SAFETY: the clamp above keeps the bin under 13 · 128.
        let entry = unsafe { *self.entries.get_unchecked(((bits - LOWEST) >> 16) as usize) };
        (entry + (bits & 0xffff)) >> 16
    }
}

/// One display pixel, `0xFFBBGGRR`.
#[inline(always)]
pub fn pack(r: u32, g: u32, b: u32) -> u32 {
    0xff00_0000 | b << 16 | g << 8 | r
}

/// Display codes of a frame: sRGB of clip(L / white); `white` > 0.
pub fn display(frame: &Frame, white: f64) -> Vec<u32> {
    let mut codes = vec![0; frame.size[0] * frame.size[1]];
    display_into(frame, white, &mut codes);
    codes
}

/// The same into `out`, one code a pixel.
pub fn display_into(frame: &Frame, white: f64, out: &mut [u32]) {
    let (srgb, scale) = (Srgb::get(), (1.0 / white) as f32);
    let [r, g, b] = &frame.radiance;
    for (((out, r), g), b) in out.iter_mut().zip(r).zip(g).zip(b) {
        *out = pack(srgb.code(r * scale), srgb.code(g * scale), srgb.code(b * scale));
    }
}

/// An 8-bit RGB PNG, tagged sRGB (perceptual), of display codes `0x__BBGGRR`.
pub fn png(display: &[u32], size: [usize; 2]) -> Result<Vec<u8>, RenderError> {
    let rgb: Vec<u8> = display.iter().flat_map(|p| [*p as u8, (p >> 8) as u8, (p >> 16) as u8]).collect();
    let failed = |e: png::EncodingError| RenderError::Encode(format!("png: {e}"));
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, size[0] as u32, size[1] as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    let mut writer = encoder.write_header().map_err(failed)?;
    writer.write_image_data(&rgb).map_err(failed)?;
    writer.finish().map_err(failed)?;
    Ok(bytes)
}

/// What an EXR file says about itself.
#[derive(Clone, Debug, PartialEq)]
pub struct Attributes {
    /// The radiance that a display should show as white.
    pub white: f64,
    /// What that is the brightest of.
    pub exposure: Rule,
    /// Technique name and knobs.
    pub technique: String,
    /// Hash of the scene.
    pub scene_sha256: String,
}

/// Bytes that a name in an EXR file has without a flag that says longer ones are there.
const SHORT_NAME: usize = 31;

/// An OpenEXR file of [`Frame::channels`] in f32: scan lines from the top, sixteen a block, ZIP
/// compressed. Attributes: `white` (f32), `exposure`, `technique`, `sceneSha256` and `kelirVersion`.
pub fn exr(frame: &Frame, attributes: &Attributes) -> Result<Vec<u8>, RenderError> {
    use exr::prelude::*;
    let channel =
        |(name, values): (String, &[f32])| AnyChannel::new(&*name, FlatSamples::F32(values.to_vec()));
    let channels: SmallVec<[AnyChannel<FlatSamples>; 4]> = frame.channels().map(channel).collect();
    let mut own = LayerAttributes::default();
    let text = |s: &str| AttributeValue::Text(Text::new_or_none(s).unwrap_or_else(|| Text::from("?")));
    own.other.insert(Text::from("white"), AttributeValue::F32(attributes.white as f32));
    own.other.insert(Text::from("exposure"), text(attributes.exposure.name()));
    own.other.insert(Text::from("technique"), text(&attributes.technique));
    own.other.insert(Text::from("sceneSha256"), text(&attributes.scene_sha256));
    own.other.insert(Text::from("kelirVersion"), text(env!("CARGO_PKG_VERSION")));
    let encoding = Encoding {
        compression: Compression::ZIP16,
        blocks: Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    };
    let layer = Layer::new((frame.size[0], frame.size[1]), own, encoding, AnyChannels::sort(channels));
    let mut bytes = std::io::Cursor::new(Vec::new());
    Image::from_layer(layer)
        .write()
        .to_buffered(&mut bytes)
        .map_err(|e| RenderError::Encode(format!("exr: {e}")))?;
    let mut bytes = bytes.into_inner();
    if frame.channels().any(|(name, _)| name.len() > SHORT_NAME) {
        // The library leaves it to attributes to ask for this flag, but the format wants it of channels too.
        bytes[5] |= 0x04;
    }
    sort_attributes(&mut bytes);
    Ok(bytes)
}

/// Puts the attributes of an EXR's one header in the order of their names: the library writes its own in an order that differs from run to run, and
/// one frame is to be one file.
fn sort_attributes(file: &mut [u8]) {
    /// After the magic number and the version.
    const HEADER: usize = 8;
    let zero = |from: usize| file[from..].iter().position(|b| *b == 0).map(|k| from + k);
    let mut attributes: Vec<&[u8]> = Vec::new();
    let mut at = HEADER;
    // Name, type and size of the value, then the value; an empty name ends them.
    while file[at] != 0 {
        let Some(size) = zero(at).and_then(|end| zero(end + 1)).map(|end| end + 1) else { return };
        let Some(bytes) = file.get(size..).and_then(|rest| rest.first_chunk()) else { return };
        let end = size + 4 + u32::from_le_bytes(*bytes) as usize;
        let Some(attribute) = file.get(at..end).filter(|_| end < file.len()) else { return };
        attributes.push(attribute);
        at = end;
    }
    attributes.sort_unstable();
    let sorted = attributes.concat();
    file[HEADER..HEADER + sorted.len()].copy_from_slice(&sorted);
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]
    use rayon::prelude::*;

    use super::*;
    use crate::{Visibility, VisibilityModel};

    /// Every f32 from 0 to 1 (and a little beyond) against the definition, by walking the 255 steps of the definition.
    #[test]
    fn every_f32_has_its_code() {
        let srgb = Srgb::get();
        let last = 1.25f32.to_bits();
        // The definition is monotone, so it is enough to know its steps; each is found by bisection over the bits.
        let steps: Vec<u32> = (1..=255u8)
            .map(|code| {
                let (mut below, mut above) = (0u32, 1f32.to_bits());
                while above - below > 1 {
                    let middle = below + (above - below) / 2;
                    if code_exact(f32::from_bits(middle)) < code { below = middle } else { above = middle }
                }
                above
            })
            .collect();
        (0..last).into_par_iter().step_by(if cfg!(debug_assertions) { 7 } else { 1 }).for_each(|bits| {
            let expected = steps.partition_point(|step| *step <= bits) as u32;
            assert_eq!(srgb.code(f32::from_bits(bits)), expected, "{}", f32::from_bits(bits));
        });
        for (code, step) in steps.iter().enumerate() {
            assert_eq!(srgb.code(f32::from_bits(*step)), code as u32 + 1);
            assert_eq!(srgb.code(f32::from_bits(*step - 1)), code as u32);
        }
    }

    #[test]
    fn what_is_no_colour_is_clipped() {
        let srgb = Srgb::get();
        for (value, code) in
            [(f32::NAN, 0), (-1.0, 0), (f32::NEG_INFINITY, 0), (f32::INFINITY, 255), (2.0, 255)]
        {
            assert_eq!(srgb.code(value), code, "{value}");
            assert_eq!(u32::from(code_exact(value)), code, "{value}");
        }
    }

    fn frame() -> Frame {
        let plane = |k: usize| (0..12).map(|i| (i * 3 + k) as f32 / 40.0).collect::<Vec<_>>();
        let seen =
            |model, channel, k| Visibility { emitter: "inner".into(), model, channel, values: plane(k) };
        Frame {
            size: [4, 3],
            radiance: [plane(0), plane(1), plane(2)],
            visibilities: vec![
                seen(VisibilityModel::Geometric, None, 1),
                seen(VisibilityModel::Irradiance, Some(2), 4),
            ],
            standard_error: Some([plane(5), plane(6), plane(7)]),
            stats: crate::Stats::default(),
        }
    }

    #[test]
    fn png_is_srgb_eight_bit_and_holds_the_codes() {
        let codes = display(&frame(), 0.5);
        let bytes = png(&codes, [4, 3]).unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap();
        assert_eq!(reader.info().srgb, Some(png::SrgbRenderingIntent::Perceptual));
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut pixels).unwrap();
        assert_eq!((info.width, info.height, info.color_type), (4, 3, png::ColorType::Rgb));
        assert_eq!(pixels[3 * 5..][..3], [5usize * 3, 16, 17].map(|v| code_exact(v as f32 / 40.0 * 2.0)));
        assert_eq!(codes[5] >> 24, 0xff);
    }

    #[test]
    fn exr_keeps_every_bit() {
        use exr::prelude::*;
        let attributes = Attributes {
            white: 0.25,
            exposure: Rule::Still,
            technique: "pa".into(),
            scene_sha256: "ab".into(),
        };
        let bytes = exr(&frame(), &attributes).unwrap();
        assert!((0..8).all(|_| exr(&frame(), &attributes).unwrap() == bytes), "one frame is one file");
        let image = read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .first_valid_layer()
            .all_attributes();
        let image = image.from_buffered(std::io::Cursor::new(bytes)).unwrap();
        let find = |name: &str| {
            let channel = image.layer_data.channel_data.list.iter().find(|c| c.name == *name).unwrap();
            channel.sample_data.values_as_f32().collect::<Vec<_>>()
        };
        assert_eq!(find("R"), frame().radiance[0]);
        assert_eq!(find("B"), frame().radiance[2]);
        assert_eq!(find("Vgeo.inner"), frame().visibilities[0].values);
        assert_eq!(find("Virr.inner.B"), frame().visibilities[1].values);
        assert_eq!(find("SE.G"), frame().standard_error.unwrap()[1]);
        let white = image.layer_data.attributes.other.get(&Text::from("white")).unwrap();
        assert_eq!(*white, AttributeValue::F32(0.25));
        assert_eq!(image.layer_data.encoding.blocks, Blocks::ScanLines);
        assert_eq!(image.layer_data.encoding.line_order, LineOrder::Increasing);
    }

    /// The version field's third flag, and nothing else, says that there are names of more than 31 bytes.
    #[test]
    fn exr_says_that_names_are_long() {
        let of = |length: usize| {
            let mut frame = frame();
            frame.visibilities[0].emitter = "e".repeat(length - "Vgeo.".len());
            let attributes = Attributes {
                white: 1.0,
                exposure: Rule::Still,
                technique: String::new(),
                scene_sha256: String::new(),
            };
            u32::from_le_bytes(exr(&frame, &attributes).unwrap()[4..8].try_into().unwrap())
        };
        assert_eq!([of(31), of(32), of(69)], [0x002, 0x402, 0x402]);
    }
}
