//! How many files and connections this process may have open.

use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};

/// Enough for every connection there may be; more would cost the system memory for nothing.
const WANTED: u64 = 65_536;

/// Raises the limit as far as the system lets anybody; answers what it is then.
pub(super) fn raise() -> usize {
    let Rlimit { current, maximum } = getrlimit(Resource::Nofile);
    let wanted = maximum.map_or(WANTED, |maximum| maximum.min(WANTED));
    let now = match current {
        Some(current) if current < wanted => {
            let raised = setrlimit(Resource::Nofile, Rlimit { current: Some(wanted), maximum });
            if let Err(error) = &raised {
                tracing::warn!("the limit of open files stays at {current}: {error}");
            }
            if raised.is_ok() { wanted } else { current }
        }
        current => current.unwrap_or(WANTED),
    };
    usize::try_from(now).unwrap_or(usize::MAX)
}
