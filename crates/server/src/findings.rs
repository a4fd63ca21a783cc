//! What was found when the server last looked at all that it stores.

use crate::loaded::Served;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use tokio::sync::Notify;

/// What the last look found.
#[derive(Debug, Default)]
pub(crate) struct Findings {
    faults: Mutex<Vec<String>>,
    paused: Mutex<BTreeMap<String, Arc<Served>>>,
    asked: Notify,
}

impl Findings {
    /// What is wrong, in sentences; nothing where all is well.
    pub(crate) fn faults(&self) -> Vec<String> {
        self.faults.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Notes what is wrong now; answers what was before.
    pub(crate) fn note(&self, faults: Vec<String>) -> Vec<String> {
        std::mem::replace(&mut *self.faults.lock().unwrap_or_else(PoisonError::into_inner), faults)
    }

    /// Studies that paused, with what they show.
    pub(crate) fn paused(&self) -> MutexGuard<'_, BTreeMap<String, Arc<Served>>> {
        self.paused.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Something was missed or damaged: look soon.
    pub(crate) fn ask(&self) {
        self.asked.notify_one();
    }

    /// Waits until somebody asks for a look.
    pub(crate) async fn asked(&self) {
        self.asked.notified().await;
    }
}
