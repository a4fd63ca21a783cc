//! Work that takes long and keeps a core busy, on threads of the lowest priority: nobody who answers waits for it.

use tokio::sync::oneshot;

/// Gives the calling thread the lowest priority, for good: it runs where nobody else wants the core. Where threads have no priority of their
/// own (anywhere but on Linux) nothing happens.
pub fn step_back() {
    #[cfg(target_os = "linux")]
    {
        // On Linux 0 is the calling thread alone. Lowering is always allowed.
        let _ = rustix::process::setpriority_process(None, 19);
    }
}

/// Runs work on a thread of its own that has stepped back, as will those that it starts. `None` if the work panicked or no thread could be had.
pub async fn background<T: Send + 'static>(work: impl FnOnce() -> T + Send + 'static) -> Option<T> {
    let (reply, result) = oneshot::channel();
    let runtime = tokio::runtime::Handle::current();
    let run = move || {
        step_back();
        let _runtime = runtime.enter();
        // Whoever asked may have gone meanwhile.
        let _ = reply.send(work());
    };
    std::thread::Builder::new().name("kelir-background".to_owned()).spawn(run).ok()?;
    result.await.ok()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]
    use super::*;

    /// The calling thread's nice value: the 19th field of its line, counted after the name, which may hold anything.
    #[cfg(target_os = "linux")]
    fn nice() -> i32 {
        let line = std::fs::read_to_string("/proc/thread-self/stat").unwrap();
        line.rsplit_once(") ").unwrap().1.split(' ').nth(16).unwrap().parse().unwrap()
    }

    #[cfg(target_os = "linux")]
    #[tokio::test]
    async fn background_work_steps_back_with_all_it_starts_and_nobody_else_does() {
        let before = nice();
        let (own, started) = background(|| (nice(), std::thread::spawn(nice).join().unwrap())).await.unwrap();
        assert_eq!((own, started), (19, 19));
        assert_eq!(nice(), before);
        assert_eq!(tokio::task::spawn_blocking(nice).await.unwrap(), before);
    }

    #[tokio::test]
    async fn work_that_panics_is_told_from_work_that_came_to_something() {
        assert_eq!(background(|| 7).await, Some(7));
        assert_eq!(background(|| -> u8 { panic!("on purpose") }).await, None);
        let runtime = background(|| tokio::runtime::Handle::current().block_on(async { 8 }));
        assert_eq!(runtime.await, Some(8));
    }
}
