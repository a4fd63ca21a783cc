//! Progress bars: on a terminal only, and only for what takes a while.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// A bar with count and time left; silent when standard error is no terminal (indicatif sees to that).
pub fn bar(total: u64, what: &str) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(total), ProgressDrawTarget::stderr());
    let style = ProgressStyle::with_template("{msg:<32} {bar:30} {pos}/{len} {eta} left");
    bar.set_style(style.expect("the template is well-formed"));
    bar.set_message(what.to_owned());
    bar
}
