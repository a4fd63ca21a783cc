//! What a picture's file says of its colours and its end.

use crate::colour::srgb_to_linear;

/// How encoded values stand for light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Transfer {
    /// IEC 61966-2-1, as a picture that says nothing is read.
    Srgb,
    /// Light is a power of the encoded value.
    Power(f64),
}

impl Transfer {
    pub(super) fn linear(self, encoded: f64) -> f64 {
        match self {
            Self::Srgb => srgb_to_linear(encoded),
            Self::Power(power) => encoded.powf(power),
        }
    }
}

/// The chunks of a PNG before its pixels: name and content.
fn chunks(bytes: &[u8]) -> impl Iterator<Item = (&[u8], &[u8])> {
    let mut rest = bytes.get(8..).unwrap_or_default();
    std::iter::from_fn(move || {
        let length = u32::from_be_bytes(*rest.first_chunk()?) as usize;
        let (name, content) = (rest.get(4..8)?, rest.get(8..8 + length)?);
        rest = rest.get(12 + length..)?;
        (name != b"IDAT").then_some((name, content))
    })
}

/// White point and primaries of sRGB, as cHRM has them.
const SRGB_POINTS: [u32; 8] = [31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000];

/// What a PNG's chunks say: cICP before iCCP (which the decoder hands out), that before sRGB, that before gAMA and cHRM. Errors: what can't be
/// applied.
pub(super) fn colours_of_png(bytes: &[u8]) -> Result<Transfer, String> {
    let find = |name: &[u8; 4]| chunks(bytes).find(|(chunk, _)| chunk == name).map(|(_, content)| content);
    if let Some(code) = find(b"cICP") {
        return match code {
            [1, 13, 0, 1] => Ok(Transfer::Srgb),
            [1, 8, 0, 1] => Ok(Transfer::Power(1.0)),
            [1, 4, 0, 1] => Ok(Transfer::Power(2.2)),
            _ => Err(format!(
                "says by cICP = {code:?} that its colours are none of sRGB's; convert it to sRGB"
            )),
        };
    }
    if find(b"sRGB").is_some() || find(b"iCCP").is_some() {
        return Ok(Transfer::Srgb);
    }
    let numbers =
        |content: &[u8]| content.as_chunks().0.iter().map(|n| u32::from_be_bytes(*n)).collect::<Vec<_>>();
    if let Some(points) = find(b"cHRM").map(numbers)
        && points.iter().zip(SRGB_POINTS).any(|(point, srgb)| point.abs_diff(srgb) > 500)
    {
        return Err(format!(
            "says by cHRM = {points:?} that its primaries are none of sRGB's; convert it to sRGB"
        ));
    }
    match find(b"gAMA").map(numbers).as_deref() {
        // 1/2.2 is what writers say who mean sRGB.
        None | Some([45445..=45465]) => Ok(Transfer::Srgb),
        Some([gamma]) if *gamma > 0 => Ok(Transfer::Power(100_000.0 / f64::from(*gamma))),
        Some(other) => {
            Err(format!("says by gAMA = {other:?} nothing that can be applied; convert it to sRGB"))
        }
    }
}

/// The name of an ICC profile: its description, in either form.
pub(super) fn profile_name(profile: &[u8]) -> Option<String> {
    let number = |at: usize| Some(u32::from_be_bytes(*profile.get(at..)?.first_chunk()?) as usize);
    let tags = (0..number(128)?.min(200)).map(|k| 132 + 12 * k);
    let at = tags.clone().find(|tag| profile.get(*tag..*tag + 4) == Some(b"desc".as_slice()))?;
    let start = number(at + 4)?;
    let text = match profile.get(start..start + 4)? {
        b"desc" => {
            let length = number(start + 8)?;
            String::from_utf8_lossy(profile.get(start + 12..start + 12 + length)?).into_owned()
        }
        b"mluc" => {
            let (length, offset) = (number(start + 20)?, number(start + 24)?);
            let text = profile.get(start + offset..start + offset + length)?;
            char::decode_utf16(text.as_chunks().0.iter().map(|unit| u16::from_be_bytes(*unit)))
                .filter_map(Result::ok)
                .collect()
        }
        _ => return None,
    };
    Some(text.trim_matches(char::from(0)).trim().to_owned())
}

/// Whether a JPEG's last scan ends where the file says that it does, and not with the file.
pub(super) fn ends(bytes: &[u8]) -> bool {
    let mut at = 2;
    while let Some([0xff, marker]) = bytes.get(at..at + 2) {
        at += 2;
        match marker {
            0xd9 => return true,
            // Fill bytes, restarts and stuffed bytes have no length.
            0xff => at -= 1,
            0x00 | 0x01 | 0xd0..=0xd8 => {}
            _ => {
                let Some(length) = bytes.get(at..at + 2) else { return false };
                at += usize::from(u16::from_be_bytes([length[0], length[1]]));
            }
        }
        if matches!(marker, 0x00 | 0x01 | 0xd0..=0xd7 | 0xda) {
            // Codes, up to the next marker.
            let Some(next) = bytes.get(at..).and_then(|rest| rest.iter().position(|byte| *byte == 0xff))
            else {
                return false;
            };
            at += next;
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A PNG's header and these chunks.
    fn png(with: &[(&[u8; 4], &[u8])]) -> Vec<u8> {
        let mut bytes = b"\x89PNG\r\n\x1a\n".to_vec();
        for (name, content) in with {
            bytes.extend((content.len() as u32).to_be_bytes());
            bytes.extend([name.as_slice(), content, &[0; 4]].concat());
        }
        bytes
    }

    #[test]
    fn statements_are_applied_or_refused() {
        let gamma = |value: u32| colours_of_png(&png(&[(b"gAMA", &value.to_be_bytes())]));
        assert_eq!(gamma(100_000), Ok(Transfer::Power(1.0)));
        assert_eq!(gamma(45_455), Ok(Transfer::Srgb));
        assert_eq!(gamma(55_556), Ok(Transfer::Power(100_000.0 / 55_556.0)));
        assert!(gamma(0).is_err_and(|e| e.contains("gAMA")));
        // sRGB says more than gAMA, and cICP more than that.
        let linear = 100_000u32.to_be_bytes();
        assert_eq!(colours_of_png(&png(&[(b"gAMA", &linear), (b"sRGB", &[0])])), Ok(Transfer::Srgb));
        assert_eq!(
            colours_of_png(&png(&[(b"sRGB", &[0]), (b"cICP", &[1, 8, 0, 1])])),
            Ok(Transfer::Power(1.0))
        );
        assert!(
            colours_of_png(&png(&[(b"cICP", &[9, 16, 0, 1])]))
                .is_err_and(|e| e.contains("cICP = [9, 16, 0, 1]"))
        );
        let wide: Vec<u8> = [31270u32, 32900, 68000, 32000, 26500, 69000, 15000, 6000]
            .into_iter()
            .flat_map(u32::to_be_bytes)
            .collect();
        assert!(colours_of_png(&png(&[(b"cHRM", &wide)])).is_err_and(|e| e.contains("cHRM")));
        let same: Vec<u8> = SRGB_POINTS.into_iter().flat_map(u32::to_be_bytes).collect();
        assert_eq!(colours_of_png(&png(&[(b"cHRM", &same)])), Ok(Transfer::Srgb));
        assert_eq!(colours_of_png(b""), Ok(Transfer::Srgb));
        assert!((Transfer::Power(2.0).linear(0.5) - 0.25).abs() < 1e-12);
    }

    #[test]
    fn profiles_have_names() {
        let profile = |text: &[u8]| {
            [
                vec![0; 128],
                [1u32.to_be_bytes(), *b"desc"].concat(),
                [144u32, text.len() as u32].map(u32::to_be_bytes).concat(),
                text.to_vec(),
            ]
            .concat()
        };
        let old = profile(b"desc\0\0\0\0\0\0\0\x05Adob\0");
        assert_eq!(profile_name(&old).as_deref(), Some("Adob"));
        let new = profile(b"mluc\0\0\0\0\0\0\0\x01\0\0\0\x0cenUS\0\0\0\x04\0\0\0\x1c\0P\x003");
        assert_eq!(profile_name(&new).as_deref(), Some("P3"));
        for length in 0..old.len() {
            profile_name(&old[..length]);
        }
    }

    #[test]
    fn a_jpeg_ends_with_its_mark() {
        let whole = b"\xff\xd8\xff\xe0\0\x04ab\xff\xda\0\x02\x12\xff\0\x34\xff\xd0\x56\xff\xd9tail";
        assert!(ends(whole));
        for length in 0..whole.len() - 4 {
            assert!(!ends(&whole[..length]), "{length}");
        }
    }
}
