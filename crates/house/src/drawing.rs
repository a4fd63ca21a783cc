//! Where stimuli are drawn: on threads of their own, of the lowest priority, so that nobody who answers waits for a picture.

use kelir_store::step_back;
use std::sync::LazyLock;

/// One thread a core. Drawing takes every core that is free, and gives it back as soon as anything else wants it.
static POOL: LazyLock<Option<rayon::ThreadPool>> = LazyLock::new(|| {
    let pool = rayon::ThreadPoolBuilder::new().thread_name(|_| "kelir-drawing".to_owned());
    pool.start_handler(|_| step_back()).build().ok()
});

/// Draws, with all that the drawing hands to other threads. The async thread that calls this is let go meanwhile.
pub(crate) fn draw<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    tokio::task::block_in_place(|| match POOL.as_ref() {
        Some(pool) => pool.install(work),
        // No threads to be had: it is drawn all the same.
        None => work(),
    })
}
