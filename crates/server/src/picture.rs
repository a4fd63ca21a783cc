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
