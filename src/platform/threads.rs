//! How many threads this process uses at once.

use std::{num::NonZero, sync::OnceLock, thread};

/// What the process was limited to.
static LIMIT: OnceLock<usize> = OnceLock::new();

/// Threads for work that can be shared out: as many as the machine runs at once, or fewer where that was asked for.
pub fn threads() -> usize {
    let runs = thread::available_parallelism().map_or(1, NonZero::get);
    LIMIT.get().map_or(runs, |limit| runs.min(*limit))
}

/// Uses at most so many threads from now on. The second call changes nothing.
pub fn limit_threads(most: usize) {
    LIMIT.get_or_init(|| most.max(1));
}
