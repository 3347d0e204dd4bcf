//! Work on several threads at once, with results in the order of the items whoever works on them.

use std::sync::OnceLock;

use rayon::{
    ThreadPool, ThreadPoolBuilder,
    iter::{FromParallelIterator, IndexedParallelIterator, IntoParallelRefIterator, ParallelIterator},
};

use super::threads;

/// Threads for work that may use all that this process has. They sleep where there is none.
static ALL: OnceLock<Option<ThreadPool>> = OnceLock::new();

/// `work` on every item, on up to `count` threads; on this one where others cannot be started.
pub fn map<T: Sync, R: Send>(count: usize, items: &[T], work: impl Fn(&T) -> R + Sync + Send) -> Vec<R> {
    collect(count, items, work)
}

/// [`map`] with work that can fail: after a failure no other item is begun.
///
/// # Errors
/// One of the failures.
pub fn try_map<T: Sync, R: Send, E: Send>(
    count: usize,
    items: &[T],
    work: impl Fn(&T) -> Result<R, E> + Sync + Send,
) -> Result<Vec<R>, E> {
    collect(count, items, work)
}

fn collect<T: Sync, R: Send, C: FromIterator<R> + FromParallelIterator<R> + Send>(
    count: usize,
    items: &[T],
    work: impl Fn(&T) -> R + Sync + Send,
) -> C {
    let own;
    let pool = match count.min(items.len()) {
        0 | 1 => &None,
        count if count == threads() => ALL.get_or_init(|| start(count)),
        fewer => {
            own = start(fewer);
            &own
        }
    };
    let Some(pool) = pool else { return items.iter().map(work).collect() };
    pool.install(|| items.par_iter().with_max_len(1).map(work).collect())
}

fn start(count: usize) -> Option<ThreadPool> {
    ThreadPoolBuilder::new().num_threads(count).thread_name(|index| format!("worker {index}")).build().ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicU64, Ordering};

    #[test]
    fn results_come_in_the_order_of_the_work() {
        let items: Vec<u64> = (0..1000).collect();
        // The first items take longest.
        let slow = |item: &u64| (0..(1000 - item) * 50).fold(*item, |sum, n| sum ^ n ^ (n + 1) ^ (n + 1) ^ n);
        for count in [0, 1, threads(), 4] {
            assert_eq!(map(count, &items, slow), items, "on {count} threads");
        }
    }

    #[test]
    fn after_a_failure_no_other_item_is_begun() {
        let items: Vec<u64> = (0..1000).collect();
        for count in [1, 2] {
            let begun = AtomicU64::new(0);
            let failed = try_map(count, &items, |item| {
                begun.fetch_add(1, Ordering::Relaxed);
                if *item == 3 { Err("three") } else { Ok(()) }
            });
            assert_eq!(failed, Err("three"));
            assert!(begun.into_inner() < 1000, "on {count} threads");
        }
        assert_eq!(try_map(2, &items, |item| Ok::<_, ()>(item + 1)).unwrap()[999], 1000);
    }
}
