//! Parallel work on several threads. The results have the order of the items, whichever thread computes them.

use std::{
    convert::Infallible,
    num::NonZero,
    sync::{
        Mutex, OnceLock, PoisonError,
        atomic::{AtomicBool, AtomicUsize, Ordering},
    },
    thread,
    time::{Duration, Instant},
};

use rayon::{ThreadPool, ThreadPoolBuilder, Yield};

/// The limit set by [`limit_threads`], if any.
static LIMIT: OnceLock<usize> = OnceLock::new();

/// Sleeping workers of earlier teams, for the next one.
static IDLE: Mutex<Vec<ThreadPool>> = Mutex::new(Vec::new());

/// Number of busy workers in teams that may use every thread of this process.
static BUSY: AtomicUsize = AtomicUsize::new(0);

/// Time without work after which a worker that is kept awake naps, and the length of a nap. The operating system takes up to 0.2 ms to wake
/// a sleeping thread: workers that slept between the steps of a search of 30 ms missed a third of the time of the short ones.
const STAYS_AWAKE: Duration = Duration::from_millis(1);
const NAP: Duration = Duration::from_micros(100);

/// Returns the number of threads for parallel work: the hardware parallelism, or the limit if that is smaller.
pub fn thread_count() -> usize {
    let runs = thread::available_parallelism().map_or(1, NonZero::get);
    LIMIT.get().map_or(runs, |limit| runs.min(*limit))
}

/// Limits the process to at most `most` threads from now on. A second call has no effect.
pub fn limit_threads(most: usize) {
    LIMIT.get_or_init(|| most.max(1));
}

/// The calling thread and the workers that help it.
pub struct Team {
    pool: Option<ThreadPool>,
    helpers: usize,
    /// The helpers that count as [`BUSY`].
    counted: usize,
}

impl Drop for Team {
    fn drop(&mut self) {
        BUSY.fetch_sub(self.counted, Ordering::Relaxed);
        if let Some(pool) = self.pool.take() {
            IDLE.lock().unwrap_or_else(PoisonError::into_inner).push(pool);
        }
    }
}

impl Team {
    /// The calling thread alone.
    pub const ALONE: Self = Self { pool: None, helpers: 0, counted: 0 };

    /// Returns a team of up to `count` threads, including the calling one, which is alone if no others can be started. If `count` is
    /// [`thread_count`], the workers of other such teams are missing. It never waits for them: they may be occupied for hours by a whole
    /// training run.
    pub fn of(count: usize) -> Self {
        if count <= 1 {
            return Self::ALONE;
        }
        let all = thread_count();
        let counted =
            if count == all { (count - 1).saturating_sub(BUSY.fetch_max(count - 1, Ordering::Relaxed)) } else { 0 };
        let helpers = if count == all { counted } else { count - 1 };
        let mut team = Self { pool: None, helpers, counted };
        if helpers > 0 {
            let mut idle = IDLE.lock().unwrap_or_else(PoisonError::into_inner);
            let suits = idle.iter().position(|pool| pool.current_num_threads() >= helpers);
            team.pool = suits.map(|index| idle.swap_remove(index));
            drop(idle);
            team.pool = team.pool.take().or_else(|| start(helpers.max(all - 1)));
        }
        if team.pool.is_some() { team } else { Self::ALONE }
    }

    /// Runs `lead` on the calling thread with a team of up to `count` threads, which stay awake while it lasts.
    pub fn awake<R>(count: usize, lead: impl FnOnce(&Self) -> R) -> R {
        let team = Self::of(count);
        let Some(pool) = &team.pool else { return lead(&team) };
        let is_over = AtomicBool::new(false);
        pool.in_place_scope(|scope| {
            // One job in each worker's own queue: from a common queue, one worker would take several and leave the others asleep.
            scope.spawn_broadcast(|_, worker| {
                if worker.index() < team.helpers {
                    wait_awake(&is_over);
                }
            });
            // Also if `lead` panics: the scope waits for its workers.
            let _end = SetOnDrop(&is_over);
            lead(&team)
        })
    }

    /// Number of threads.
    pub const fn size(&self) -> usize {
        1 + self.helpers
    }

    /// Applies `work` to every item.
    pub fn map<T: Sync, R: Send>(&self, items: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
        let Ok(results) = self.try_map(items, |item| Ok::<_, Infallible>(work(item)));
        results
    }

    /// Like [`map`](Self::map) for work that can fail: after a failure, no further item is started.
    ///
    /// The calling thread works, too. If it only woke the others and slept, the operating system would have to find a free processor for
    /// each: in every fourth search of 30 ms on two processors, one processor stayed idle to the end.
    fn try_map<T: Sync, R: Send, E: Send>(
        &self,
        items: &[T],
        work: impl Fn(&T) -> Result<R, E> + Sync,
    ) -> Result<Vec<R>, E> {
        let (next, all) = (AtomicUsize::new(0), Mutex::new(Ok(Vec::with_capacity(items.len()))));
        let take_over = || {
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
        match &self.pool {
            Some(pool) => pool.in_place_scope(|scope| {
                for _ in 1..self.size().min(items.len()) {
                    scope.spawn(|_| take_over());
                }
                take_over();
            }),
            None => take_over(),
        }
        let mut all = all.into_inner().unwrap_or_else(PoisonError::into_inner)?;
        all.sort_unstable_by_key(|(index, _)| *index);
        Ok(all.into_iter().map(|(_, result)| result).collect())
    }
}

/// Sets a flag when it is dropped.
struct SetOnDrop<'a>(&'a AtomicBool);

impl Drop for SetOnDrop<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// Does the work of the pool of this thread until there is no more.
fn wait_awake(is_over: &AtomicBool) {
    let mut worked = Instant::now();
    while !is_over.load(Ordering::Relaxed) {
        match rayon::yield_now() {
            Some(Yield::Executed) => worked = Instant::now(),
            _ if worked.elapsed() < STAYS_AWAKE => thread::yield_now(),
            _ => thread::sleep(NAP),
        }
    }
}

/// Applies `work` to every item on up to `count` threads, including the calling one.
pub fn map<T: Sync, R: Send>(count: usize, items: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    Team::of(count.min(items.len())).map(items, work)
}

/// Like [`map`] for work that can fail: after a failure, no further item is started.
///
/// # Errors
/// Returns one of the failures.
pub fn try_map<T: Sync, R: Send, E: Send>(
    count: usize,
    items: &[T],
    work: impl Fn(&T) -> Result<R, E> + Sync,
) -> Result<Vec<R>, E> {
    Team::of(count.min(items.len())).try_map(items, work)
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
        panic::catch_unwind,
        sync::{Barrier, atomic::AtomicU64, mpsc},
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
        let (done, ends) = mpsc::channel();
        let ends = Mutex::new(ends);
        let in_time = map(thread_count() + 1, &[true, false], |waits| {
            if *waits {
                ends.lock().unwrap().recv_timeout(Duration::from_secs(20)).is_ok()
            } else {
                let squares = map(thread_count(), &[1, 2, 3], |n| n * n);
                done.send(()).unwrap();
                squares == [1, 4, 9]
            }
        });
        assert_eq!(in_time, [true, true]);
    }

    #[test]
    fn workers_that_stay_awake_take_part_in_every_task() {
        let count = thread_count() + 1;
        let together = Barrier::new(count);
        let tasks = Team::awake(count, |team| {
            assert_eq!(team.size(), count);
            let task = || team.map(&vec![(); count], |()| together.wait().is_leader());
            (0..50).map(|_| task()).collect::<Vec<_>>()
        });
        assert!(tasks.iter().all(|led| led.iter().filter(|is_leader| **is_leader).count() == 1));
        assert!(catch_unwind(|| Team::awake(count, |_| panic!("as if the lead failed"))).is_err(), "and it ended");
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
