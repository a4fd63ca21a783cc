//! The browser's half, built by `web/` and embedded: two page shells and what they load.

/// Names of the two shells.
pub(crate) const PARTICIPANT: &str = "participant.html";
/// The researcher's shell.
pub(crate) const CONSOLE: &str = "console.html";

/// A file of the bundle.
pub(crate) fn file(_path: &str) -> Option<std::borrow::Cow<'static, [u8]>> {
    None
}
