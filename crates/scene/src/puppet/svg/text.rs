//! An SVG's bytes as a text that its reader understands.

use std::borrow::Cow;
use std::ops::Range;

use resvg::usvg::roxmltree::{Document, Error, ParsingOptions};

use super::drawn::SVG;
use crate::limits;

/// Bytes that entities may come to, written out: editors name namespaces by them, and nothing else.
const ENTITIES: usize = 64 << 20;

/// UTF-8, UTF-16 with its mark, or Latin-1 where it says so. Errors: none of them, or entities that explode.
pub(super) fn decode(bytes: &[u8]) -> Result<Cow<'_, str>, String> {
    let wide = |of: fn([u8; 2]) -> u16| {
        let units = bytes[2..].as_chunks().0.iter().map(|pair| of(*pair));
        char::decode_utf16(units).collect::<Result<String, _>>().ok().map(Cow::Owned)
    };
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(200)]).to_ascii_lowercase();
    let latin = ["iso-8859-1", "latin1", "windows-1252", "us-ascii"].iter().any(|name| head.contains(name));
    let text = match bytes {
        [0xff, 0xfe, ..] => wide(u16::from_le_bytes),
        [0xfe, 0xff, ..] => wide(u16::from_be_bytes),
        _ => match std::str::from_utf8(bytes) {
            Ok(text) => Some(Cow::Borrowed(text.strip_prefix('\u{feff}').unwrap_or(text))),
            Err(_) if latin => Some(Cow::Owned(bytes.iter().map(|byte| char::from(*byte)).collect())),
            Err(_) => None,
        },
    };
    let text = text.ok_or_else(|| "is not UTF-8 text; save it as plain SVG, which is".to_owned())?;
    let subset = text.find("<!DOCTYPE").and_then(|at| {
        let declared = &text[at..];
        let open = declared.find(['[', '>']).filter(|open| declared[*open..].starts_with('['))?;
        Some(declared[open..].split("]>").next().unwrap_or_default())
    });
    if let Some(subset) = subset {
        let written_out = subset.len().saturating_mul(text.matches('&').count());
        if subset.contains('&') || written_out > ENTITIES {
            return Err("has entities that are made of others, or too many; save it as plain SVG".to_owned());
        }
    }
    Ok(text)
}

/// Parses with document types but without anything from outside of the file.
pub(super) fn parse(text: &str) -> Result<Document<'_>, String> {
    unchecked(text).map_err(|error| format!("is not an SVG: {error}"))
}

/// As [`parse`], with the parser's own error.
pub(super) fn unchecked(text: &str) -> Result<Document<'_>, Error> {
    let nodes_limit = 4 * limits::SVG_ELEMENTS as u32;
    let options = ParsingOptions { nodes_limit, allow_dtd: true, ..ParsingOptions::default() };
    Document::parse_with_options(text, options)
}

/// The text as usvg understands it: the root's width and height in pixels where they are in units that it does not know, and the root in SVG's
/// namespace where it [has none](is_unnamed); `None` where all is well.
pub(super) fn understood(document: &Document, text: &str) -> Option<String> {
    let root = document.root_element();
    let mut edits: Vec<(Range<usize>, String)> = Vec::new();
    for attribute in ["width", "height"].iter().filter_map(|name| root.attribute_node(*name)) {
        let value = attribute.value().trim();
        let unit = value.trim_start_matches(|c: char| !c.is_ascii_alphabetic());
        let number: Option<f64> = value.strip_suffix(unit).and_then(|number| number.trim().parse().ok());
        let (Some(number), false) = (number, unit.is_empty() || unit.chars().all(|c| c.is_ascii_lowercase()))
        else {
            continue;
        };
        let known = unit.to_ascii_lowercase();
        let written =
            if known == "q" { format!("{}px", number * 96.0 / 101.6) } else { format!("{number}{known}") };
        edits.push((attribute.range_value(), written));
    }
    let name = root.range().start + "<svg".len();
    if is_unnamed(document) && text[..name].ends_with("<svg") {
        edits.push((name..name, format!(" xmlns=\"{SVG}\"")));
    }
    edits.sort_by_key(|(range, _)| std::cmp::Reverse(range.start));
    let changed = !edits.is_empty();
    let mut known = text.to_owned();
    edits.into_iter().for_each(|(range, written)| known.replace_range(range, &written));
    changed.then_some(known)
}

/// Whether the root is an `<svg>` that does not say so: old drawings left that to their DOCTYPE, which gives it the namespace.
pub(super) fn is_unnamed(document: &Document) -> bool {
    let name = document.root_element().tag_name();
    name.name() == "svg" && name.namespace().is_none()
}
