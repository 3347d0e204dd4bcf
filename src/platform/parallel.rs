//! Parallel work on several threads. The results have the order of the items, whichever thread computes them.

use std::{
    convert::Infallible,
    sync::{
        Mutex, OnceLock, PoisonError,
        atomic::{AtomicUsize, Ordering},
    },
};

use rayon::{ThreadPool, ThreadPoolBuilder};

use super::thread_count;

/// Worker threads in addition to the calling thread, shared by all calls that may use every thread of this process. They sleep when idle.
static SHARED_WORKERS: OnceLock<Option<ThreadPool>> = OnceLock::new();

/// Number of shared workers that are busy.
static BUSY_WORKERS: AtomicUsize = AtomicUsize::new(0);

/// A reserved shared worker; dropping this releases it.
struct ReservedWorker;

impl ReservedWorker {
    /// Reserves all free workers among `count`. It never waits for a busy one, which may be occupied for hours by a whole training run.
    fn reserve_free(count: usize) -> Vec<Self> {
        let busy = BUSY_WORKERS.fetch_max(count, Ordering::Relaxed);
        (busy..count).map(|_| Self).collect()
    }
}

impl Drop for ReservedWorker {
    fn drop(&mut self) {
        BUSY_WORKERS.fetch_sub(1, Ordering::Relaxed);
    }
}

/// Applies `work` to every item on up to `count` threads, including the calling one; on the calling thread alone if no others can be
/// started.
pub fn map<T: Sync, R: Send>(count: usize, items: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let Ok(results) = try_map(count, items, |item| Ok::<_, Infallible>(work(item)));
    results
}

/// Like [`map`] for work that can fail: after a failure, no further item is started.
///
/// The calling thread works, too. If it only woke the others and slept, the operating system would have to find a free processor for each:
/// in every fourth search of 30 ms on two processors, one processor stayed idle to the end.
///
/// # Errors
/// Returns one of the failures.
pub fn try_map<T: Sync, R: Send, E: Send>(
    count: usize,
    items: &[T],
    work: impl Fn(&T) -> Result<R, E> + Sync,
) -> Result<Vec<R>, E> {
    let (next, all) = (AtomicUsize::new(0), Mutex::new(Ok(Vec::with_capacity(items.len()))));
    let take_over = &|| {
        let mut own = Vec::new();
        let result = loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            match items.get(index).map(&work) {
                None => break Ok(()),
                Some(Ok(result)) => own.push((index, result)),
                Some(Err(failure)) => {
                    next.store(items.len(), Ordering::Relaxed);
                    break Err(failure);
                }
            }
        };
        let mut all = all.lock().unwrap_or_else(PoisonError::into_inner);
        match (result, all.as_mut()) {
            (Ok(()), Ok(all)) => all.extend(own),
            (Err(failure), Ok(_)) => *all = Err(failure),
            (_, Err(_)) => {}
        }
    };
    let share_out = |others: &ThreadPool, helpers: Vec<Option<ReservedWorker>>| {
        others.in_place_scope(|scope| {
            for helper in helpers {
                scope.spawn(move |_| {
                    take_over();
                    drop(helper);
                });
            }
            take_over();
        });
    };
    match count.min(items.len()) {
        0 | 1 => take_over(),
        count if count == thread_count() => match SHARED_WORKERS.get_or_init(|| start(count - 1)) {
            Some(others) => share_out(others, ReservedWorker::reserve_free(count - 1).into_iter().map(Some).collect()),
            None => take_over(),
        },
        count => match start(count - 1) {
            Some(own) => share_out(&own, (1..count).map(|_| None).collect()),
            None => take_over(),
        },
    }
    let mut all = all.into_inner().unwrap_or_else(PoisonError::into_inner)?;
    all.sort_unstable_by_key(|(index, _)| *index);
    Ok(all.into_iter().map(|(_, result)| result).collect())
}

/// Runs `work` on one thread, including the parts that libraries would otherwise spread over several threads.
pub fn on_one_thread<R: Send>(work: impl FnOnce() -> R + Send) -> R {
    match start(1) {
        Some(pool) => pool.install(work),
        None => work(),
    }
}

fn start(count: usize) -> Option<ThreadPool> {
    ThreadPoolBuilder::new().num_threads(count).thread_name(|index| format!("worker {index}")).build().ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::{
        collections::HashSet,
        sync::{Barrier, atomic::AtomicU64, mpsc},
        thread,
        time::Duration,
    };

    #[test]
    fn results_keep_the_order_of_the_items() {
        let items: Vec<u64> = (0..1000).collect();
        // The first items are the slowest.
        let slow = |item: &u64| (0..(1000 - item) * 50).fold(*item, |sum, n| sum ^ n ^ (n + 1) ^ (n + 1) ^ n);
        for count in [0, 1, thread_count(), 4] {
            assert_eq!(map(count, &items, slow), items, "on {count} threads");
        }
    }

    #[test]
    fn all_threads_including_the_calling_one_work_at_once() {
        // More than the shared workers, which other tests may occupy.
        let count = thread_count() + 1;
        let together = Barrier::new(count);
        let who = map(count, &vec![(); count], |()| {
            together.wait();
            thread::current().id()
        });
        assert_eq!(who.iter().collect::<HashSet<_>>().len(), count);
        assert!(who.contains(&thread::current().id()));
    }

    #[test]
    fn busy_workers_are_not_waited_for() {
        let count = thread_count().max(2);
        let Some(others) = SHARED_WORKERS.get_or_init(|| start(count - 1)) else { return };
        let helpers = ReservedWorker::reserve_free(count - 1);
        let (done, ends) = mpsc::channel();
        let (told, outcome) = mpsc::channel();
        others.spawn(move || told.send(ends.recv_timeout(Duration::from_secs(20)).is_ok()).unwrap());
        assert_eq!(map(thread_count(), &[1, 2, 3], |n| n * n), [1, 4, 9]);
        done.send(()).unwrap();
        assert!(outcome.recv().unwrap(), "the other work was over before");
        drop(helpers);
    }

    #[test]
    fn no_item_is_started_after_a_failure() {
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
