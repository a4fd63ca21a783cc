//! The browser's half: what `build.rs` made of `web/`, embedded: two page shells and what they load.

use rust_embed::Embed;
use std::borrow::Cow;

#[derive(Embed)]
#[folder = "$OUT_DIR/web"]
struct Bundle;

/// The participant's shell.
pub(crate) const PARTICIPANT: &str = "participant.html";
/// The researcher's shell.
pub(crate) const CONSOLE: &str = "console.html";

/// A file of the bundle; a shell's `assets/…` carry a hash of their content in their names.
pub(crate) fn file(path: &str) -> Option<Cow<'static, [u8]>> {
    Bundle::get(path).map(|file| file.data)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

    use super::*;

    fn text(path: &str) -> String {
        String::from_utf8(file(path).unwrap().into_owned()).unwrap()
    }

    #[test]
    fn shells_name_files_that_are_embedded() {
        for shell in [PARTICIPANT, CONSOLE] {
            let html = text(shell);
            let named: Vec<&str> =
                html.split("\"/assets/").skip(1).map(|rest| rest.split('"').next().unwrap()).collect();
            // The participants' has one more: what says on a browser before its time that it is one.
            let expected = if shell == PARTICIPANT { 4 } else { 3 };
            assert_eq!(named.len(), expected, "{shell} names an icon, a style and a script: {named:?}");
            for name in named {
                assert!(file(&format!("assets/{name}")).is_some_and(|bytes| !bytes.is_empty()), "{name}");
            }
        }
        assert!(file("assets/participant-00000000.js").is_none(), "a missing file would be noticed");
    }

    #[test]
    fn shells_keep_the_content_security_policy() {
        for shell in [PARTICIPANT, CONSOLE] {
            let html = text(shell);
            let count = |what: &str| html.matches(what).count();
            let loaded = count("<script type=\"module\" src=\"/assets/") + count("<script src=\"/assets/");
            assert_eq!(count("<script"), loaded, "{shell}");
            assert_eq!(count("<style") + count("style=\"") + count("javascript:"), 0, "{shell}");
        }
    }

    #[test]
    fn notices_of_the_bundled_packages_are_there() {
        let notices = text("assets/licenses.txt");
        assert!(notices.contains("jspsych 8.3.0 (MIT)"), "{notices}");
    }
}
