//! Whether a picture file can be shown: what it is by its content, and that all of it is there.

/// No study shows a picture with a longer side, in pixels.
const LONGEST_SIDE: u32 = 3840;

/// Media type and size [width, height] of a PNG or JPEG; `None` for anything else.
pub(crate) fn describe(bytes: &[u8]) -> Option<(&'static str, [u32; 2])> {
    png(bytes).map(|size| ("image/png", size)).or_else(|| jpeg(bytes).map(|size| ("image/jpeg", size)))
}

/// Every rule that a picture file breaks, each as a sentence's end: its type, its name's ending, its size, and that it can be decoded to its end.
pub(crate) fn broken(path: &str, bytes: &[u8], size: [u32; 2]) -> Vec<String> {
    let Some((media_type, [w, h])) = describe(bytes) else {
        return vec!["is neither PNG nor JPEG".to_owned()];
    };
    let mut rules = Vec::new();
    let ending = path.rsplit('.').next().unwrap_or_default().to_ascii_lowercase();
    let (name, named) = match media_type {
        "image/png" => ("PNG", ending == "png"),
        _ => ("JPEG", ending == "jpg" || ending == "jpeg"),
    };
    if !named {
        rules.push(format!("is a {name} by its content; its name ends in .{ending}"));
    }
    let wrong = match size {
        // The study's size was refused, which is told by itself.
        [0, 0] if w.max(h) > LONGEST_SIDE => Some(format!("no side may be longer than {LONGEST_SIDE}")),
        [0, 0] => None,
        // It may be turned by its Exif.
        _ if [w, h] != size && [h, w] != size => {
            Some(format!("the study's size is {} × {}", size[0], size[1]))
        }
        _ => None,
    };
    // What is of another size is not decoded: a small file may hold a picture that is larger than memory.
    if let Some(wrong) = wrong {
        rules.push(format!("has {w} × {h} pixels; {wrong}"));
        return rules;
    }
    // Decoders fill in what a JPEG lacks: its end is asked for apart.
    let cut =
        media_type == "image/jpeg" && !bytes.windows(2).rev().take(64 << 10).any(|pair| pair == [0xff, 0xd9]);
    match kelir_store::picture_size(bytes) {
        Err(rule) => rules.push(rule),
        Ok(_) if cut => rules.push("ends before its picture does".to_owned()),
        // A size that was refused is told of by itself.
        Ok([w, h]) if [w, h] != size && size != [0, 0] => {
            rules.push(format!("has {w} × {h} pixels; the study's size is {} × {}", size[0], size[1]));
        }
        Ok(_) => {}
    }
    rules
}

/// What a picture file asks of whoever shows it that no participant's page does, each as a sentence's end: they see its first picture, its numbers
/// taken for sRGB's.
pub(crate) fn unheeded(bytes: &[u8]) -> Vec<String> {
    let mut asked = Vec::new();
    let chunks = chunks(bytes);
    let of = |kind: &[u8; 4]| chunks.iter().find(|(name, _)| name == kind).map(|(_, data)| *data);
    if of(b"acTL").is_some() {
        asked.push("moves, and its first picture alone is shown: keep that one in a file".to_owned());
    }
    let profile =
        of(b"iCCP").and_then(|data| data.split(|byte| *byte == 0).next()).map(String::from_utf8_lossy);
    let gamma = of(b"gAMA").and_then(|data| Some(u32::from_be_bytes(data.get(..4)?.try_into().ok()?)));
    // In the order in which a reader of PNG heeds them.
    let colours = match (of(b"cICP"), profile, gamma) {
        (Some([1, 13, 0, 1]), ..) => None,
        (Some(_), ..) => Some("its cICP".to_owned()),
        (None, Some(name), _) => (!name.contains("sRGB")).then(|| format!("the profile {name:?}")),
        (None, None, Some(gamma)) if of(b"sRGB").is_none() && gamma.abs_diff(45_455) > 500 => {
            Some(format!("a gamma of {:.2}", 1e5 / f64::from(gamma.max(1))))
        }
        _ => foreign_profile(bytes).then(|| "a profile other than sRGB".to_owned()),
    };
    if let Some(colours) = colours {
        asked.push(format!("has colours by {colours}, and is shown as sRGB: convert it to sRGB"));
    }
    asked
}

/// The chunks of a PNG before its pixels, by name; none of anything else.
fn chunks(bytes: &[u8]) -> Vec<([u8; 4], &[u8])> {
    let mut rest = bytes.strip_prefix(b"\x89PNG\r\n\x1a\n").unwrap_or_default();
    let mut found = Vec::new();
    while let Some((head, behind)) = rest.split_first_chunk::<8>() {
        let [a, b, c, d, name @ ..] = *head;
        let length = u32::from_be_bytes([a, b, c, d]) as usize;
        let (Some(data), false) = (behind.get(..length), name == *b"IDAT") else { break };
        found.push((name, data));
        rest = behind.get(length + 4..).unwrap_or_default();
    }
    found
}

/// Whether a JPEG has a colour profile that does not call itself sRGB, in ASCII or as UTF-16 (ICC.1, the description).
fn foreign_profile(bytes: &[u8]) -> bool {
    const NAME: &[u8] = b"ICC_PROFILE\0";
    let mut at = if bytes.starts_with(&[0xff, 0xd8]) { 2 } else { return false };
    // The profile's parts stand before the picture, whose scan begins with 0xda.
    let mut profile = None;
    while let Some(&[0xff, marker, high, low]) = bytes.get(at..at + 4)
        && marker != 0xda
    {
        let end = at + 2 + usize::from(u16::from_be_bytes([high, low])).max(2);
        let part = bytes.get(at + 4..end).unwrap_or_default();
        if marker == 0xe2 && part.starts_with(NAME) {
            profile.get_or_insert_with(Vec::new).extend_from_slice(part);
        }
        at = end;
    }
    let says = |profile: &[u8], name: &[u8]| profile.windows(name.len()).any(|part| part == name);
    profile.is_some_and(|profile| !says(&profile, b"sRGB") && !says(&profile, b"s\0R\0G\0B"))
}

fn png(bytes: &[u8]) -> Option<[u32; 2]> {
    let rest = bytes.strip_prefix(b"\x89PNG\r\n\x1a\n")?;
    let number = |at: usize| Some(u32::from_be_bytes(rest.get(at..at + 4)?.try_into().ok()?));
    (rest.get(4..8)? == b"IHDR").then_some([number(8)?, number(12)?])
}

/// Walks the segments to the frame header (ITU T.81, B.2.2).
fn jpeg(bytes: &[u8]) -> Option<[u32; 2]> {
    let mut at = if bytes.starts_with(&[0xff, 0xd8]) { 2 } else { return None };
    loop {
        let [0xff, marker, high, low] = *bytes.get(at..at + 4)? else { return None };
        let length = usize::from(u16::from_be_bytes([high, low]));
        let frame_header = matches!(marker, 0xc0..=0xcf) && !matches!(marker, 0xc4 | 0xc8 | 0xcc);
        if frame_header {
            let number =
                |at: usize| Some(u32::from(u16::from_be_bytes(bytes.get(at..at + 2)?.try_into().ok()?)));
            return Some([number(at + 7)?, number(at + 5)?]);
        }
        at += 2 + length.max(2);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_has_another_size_is_not_decoded() {
        // The head of a picture of 10 GB.
        let head = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\xea\x60\0\0\xea\x60\x08\x02";
        let rule = "has 60000 × 60000 pixels; the study's size is 592 × 333";
        assert_eq!(broken("a.png", head, [592, 333]), [rule]);
        assert_eq!(
            broken("a.png", head, [0, 0]),
            ["has 60000 × 60000 pixels; no side may be longer than 3840"]
        );
        assert_eq!(
            broken("a.jpg", head, [592, 333]),
            ["is a PNG by its content; its name ends in .jpg", rule]
        );
    }

    #[test]
    fn what_a_file_asks_and_no_page_does_is_said() {
        let png = |chunks: &[(&[u8; 4], &[u8])]| {
            let mut bytes = b"\x89PNG\r\n\x1a\n".to_vec();
            for (name, data) in chunks {
                bytes.extend((data.len() as u32).to_be_bytes());
                bytes.extend([name.as_slice(), data, &[0; 4]].concat());
            }
            unheeded(&bytes)
        };
        let shown =
            |colours: &str| format!("has colours by {colours}, and is shown as sRGB: convert it to sRGB");
        assert_eq!(png(&[(b"cICP", &[9, 16, 0, 1])]), [shown("its cICP")]);
        assert_eq!(png(&[(b"iCCP", b"Display P3\0\0x")]), [shown("the profile \"Display P3\"")]);
        assert_eq!(png(&[(b"gAMA", &100_000u32.to_be_bytes())]), [shown("a gamma of 1.00")]);
        assert_eq!(png(&[(b"acTL", &[0; 8])]).len(), 1);
        let right: [&[(&[u8; 4], &[u8])]; 5] = [
            &[],
            &[(b"gAMA", &45_455u32.to_be_bytes())],
            &[(b"sRGB", &[0]), (b"gAMA", &100_000u32.to_be_bytes())],
            &[(b"iCCP", b"sRGB IEC61966-2.1\0\0x"), (b"gAMA", &100_000u32.to_be_bytes())],
            &[(b"cICP", &[1, 13, 0, 1]), (b"iCCP", b"Display P3\0\0x")],
        ];
        assert!(right.iter().all(|chunks| png(chunks).is_empty()));
        // What stands behind the pixels is text, and no reader heeds it.
        assert_eq!(png(&[(b"IDAT", b"x"), (b"acTL", &[0; 8])]), Vec::<String>::new());
        let jpeg = |profile: &[u8]| {
            let part = [b"ICC_PROFILE\0\x01\x01", profile].concat();
            let length = (part.len() as u16 + 2).to_be_bytes();
            unheeded(&[&[0xff, 0xd8, 0xff, 0xe2], &length[..], &part, &[0xff, 0xda, 0, 2]].concat())
        };
        assert_eq!(jpeg(b"desc Display P3"), [shown("a profile other than sRGB")]);
        assert_eq!(jpeg(b"desc sRGB IEC61966-2.1"), Vec::<String>::new());
        assert_eq!(jpeg(b"mluc\0s\0R\0G\0B"), Vec::<String>::new());
        for cut in 0..12 {
            assert_eq!(unheeded(&b"\x89PNG\r\n\x1a\n\xff\xff\xff\xffacTL"[..cut]), Vec::<String>::new());
        }
    }

    #[test]
    fn heads_are_read_and_rubbish_is_not() {
        let png = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\x02\x50\0\0\x01\x4d\x08\x02";
        assert_eq!(describe(png), Some(("image/png", [592, 333])));
        let jpeg = [0xff, 0xd8, 0xff, 0xe0, 0, 4, 1, 2, 0xff, 0xc2, 0, 11, 8, 0x01, 0x4d, 0x02, 0x50, 3];
        assert_eq!(describe(&jpeg), Some(("image/jpeg", [592, 333])));
        for cut in 0..png.len().min(24) {
            assert_eq!(describe(&png[..cut]), None);
        }
        for cut in 0..jpeg.len() - 2 {
            assert_eq!(describe(&jpeg[..cut]), None, "{cut}");
        }
        assert_eq!(describe(b"GIF89a..."), None);
    }
}
