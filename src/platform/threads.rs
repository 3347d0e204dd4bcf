//! The number of threads that this process uses at once.

use std::{num::NonZero, sync::OnceLock, thread};

/// The limit set by [`limit_threads`], if any.
static LIMIT: OnceLock<usize> = OnceLock::new();

/// Returns the number of threads for parallel work: the hardware parallelism, or the limit if that is smaller.
pub fn thread_count() -> usize {
    let runs = thread::available_parallelism().map_or(1, NonZero::get);
    LIMIT.get().map_or(runs, |limit| runs.min(*limit))
}

/// Limits the process to at most `most` threads from now on. A second call has no effect.
pub fn limit_threads(most: usize) {
    LIMIT.get_or_init(|| most.max(1));
}
