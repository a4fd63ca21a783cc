//! Work off the async threads, which would keep everybody else waiting.

use crate::background::background;
use crate::error::StoreError;

/// Work on pictures, which takes long, behind everybody who answers.
pub(crate) async fn patiently<T: Send + 'static>(
    work: impl FnOnce() -> Result<T, StoreError> + Send + 'static,
) -> Result<T, StoreError> {
    let lost = || StoreError::corrupt("task", "did not end");
    background(work).await.unwrap_or_else(|| Err(lost()))
}

/// File work off the async threads.
pub(crate) async fn blocking<T: Send + 'static>(
    work: impl FnOnce() -> Result<T, StoreError> + Send + 'static,
) -> Result<T, StoreError> {
    match tokio::task::spawn_blocking(work).await {
        Ok(result) => result,
        Err(error) => Err(StoreError::corrupt("file task", error)),
    }
}
