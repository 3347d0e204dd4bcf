//! Work on all cores, with results in the order of the work whoever does it.

use std::{
    panic::resume_unwind,
    sync::atomic::{AtomicUsize, Ordering},
    thread,
};

/// `work` on every item, by up to `threads` threads of which this is one. A thread that cannot be started is done without.
pub fn map<T: Sync, R: Send>(threads: usize, items: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    if threads <= 1 || items.len() <= 1 {
        return items.iter().map(work).collect();
    }
    let next = AtomicUsize::new(0);
    let labour = || {
        let mut done = Vec::new();
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(item) = items.get(index) else { return done };
            done.push((index, work(item)));
        }
    };
    let mut done = thread::scope(|scope| {
        let others: Vec<_> = (1..threads.min(items.len()))
            .filter_map(|_| thread::Builder::new().name("search".into()).spawn_scoped(scope, labour).ok())
            .collect();
        let mut done = labour();
        for other in others {
            done.extend(other.join().unwrap_or_else(|panic| resume_unwind(panic)));
        }
        done
    });
    done.sort_unstable_by_key(|(index, _)| *index);
    done.into_iter().map(|(_, result)| result).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_come_in_the_order_of_the_work() {
        let items: Vec<u64> = (0..1000).collect();
        // The first items take longest.
        let slow = |item: &u64| (0..(1000 - item) * 50).fold(*item, |sum, n| sum ^ n ^ (n + 1) ^ (n + 1) ^ n);
        assert_eq!(map(4, &items, slow), items);
        assert_eq!(map(1, &items, |n| n + 1), map(7, &items, |n| n + 1));
    }
}
