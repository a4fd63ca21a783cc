//! What values of study and design files may be.

use kelir_reader::Node;

/// What the reference page says of a table whose keys stand below it.
pub(crate) const SECTION: &str = "a table, or as its keys below";

/// A finite number within `[low, high]`, integers included.
pub(crate) fn number(value: &Node, low: f64, high: f64) -> Option<f64> {
    value.as_number().filter(|x| (low..=high).contains(x))
}

/// An integer within `[low, high]`.
pub(crate) fn integer(value: &Node, low: i64, high: i64) -> Option<u64> {
    value.as_integer().filter(|i| (low..=high).contains(i)).and_then(|i| u64::try_from(i).ok())
}

/// A string that is not blank and has at most `most` characters, none of which controls a terminal.
pub(crate) fn text(value: &Node, most: usize) -> Option<String> {
    let controls = |c: char| c.is_control() && !matches!(c, '\n' | '\r' | '\t');
    let shows = |c: char| !c.is_whitespace() && !UNSEEN.contains(&c);
    let text = value.as_str()?.trim();
    let fits = text.chars().any(shows) && text.chars().count() <= most && !text.contains(controls);
    fits.then(|| text.to_owned())
}

/// Characters without a width: joiners, marks of direction, the mark of a byte order.
const UNSEEN: [char; 7] =
    ['\u{200b}', '\u{200c}', '\u{200d}', '\u{200e}', '\u{200f}', '\u{2060}', '\u{feff}'];

/// The rule of [`identifier`] in words.
pub(crate) const IDENTIFIER: &str = "a name of 1 to 64 of a-z, 0-9 and -, starting with a letter or digit";

/// An identifier as it may stand in an address, a file name and a CSV column.
pub(crate) fn identifier(s: &str) -> bool {
    (1..=64).contains(&s.len())
        && !s.starts_with('-')
        && s.bytes().all(|b| b.is_ascii_lowercase() || b.is_ascii_digit() || b == b'-')
}
