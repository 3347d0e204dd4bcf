//! Worker threads with a task queue.

use std::{
    io,
    sync::mpsc::{Sender, channel},
    thread::{self, JoinHandle},
};

/// Handle of a worker thread. Dropping it ends the thread after its queued tasks.
#[derive(Debug)]
pub struct Worker<T> {
    queue: Sender<T>,
    thread: JoinHandle<()>,
}

impl<T: Send + 'static> Worker<T> {
    /// Starts a thread that runs `work` on each task in order.
    ///
    /// # Errors
    /// Fails if the thread cannot be started.
    pub fn start(name: &str, mut work: impl FnMut(T) + Send + 'static) -> io::Result<Self> {
        let (queue, tasks) = channel();
        let thread = thread::Builder::new().name(name.into()).spawn(move || tasks.into_iter().for_each(&mut work))?;
        Ok(Self { queue, thread })
    }

    /// Starts a thread that runs `work` on the newest queued task and drops the older ones.
    ///
    /// # Errors
    /// Fails if the thread cannot be started.
    pub fn newest_only(name: &str, mut work: impl FnMut(T) + Send + 'static) -> io::Result<Self> {
        let (queue, tasks) = channel();
        let thread = thread::Builder::new().name(name.into()).spawn(move || {
            while let Ok(task) = tasks.recv() {
                work(tasks.try_iter().last().unwrap_or(task));
            }
        })?;
        Ok(Self { queue, thread })
    }

    /// Queues a task; returns `false` if the thread has ended.
    pub fn submit(&self, task: T) -> bool {
        self.queue.send(task).is_ok()
    }

    /// Waits until all queued tasks are done.
    pub fn finish(self) {
        drop(self.queue);
        // A panic of the thread was reported when it happened.
        let _ = self.thread.join();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn only_the_newest_task_submitted_during_work_is_done() {
        let ((begun, begins), (go_on, may_go_on)) = (channel(), channel());
        let worker = Worker::newest_only("newest", move |task: u32| {
            begun.send(task).unwrap();
            may_go_on.recv().unwrap();
        })
        .unwrap();
        let next = || begins.recv_timeout(Duration::from_secs(20)).unwrap();
        worker.submit(1);
        assert_eq!(next(), 1);
        for task in 2..=50 {
            worker.submit(task);
        }
        go_on.send(()).unwrap();
        assert_eq!(next(), 50);
        drop(worker);
        go_on.send(()).unwrap();
        assert!(begins.recv_timeout(Duration::from_secs(20)).is_err(), "the thread has ended");
    }

    #[test]
    fn all_tasks_are_done_before_the_worker_finishes() {
        let (done, results) = channel();
        let worker = Worker::start("all", move |task: u32| done.send(task).unwrap()).unwrap();
        assert!((0..50).all(|task| worker.submit(task)));
        worker.finish();
        assert!(results.into_iter().eq(0..50));
    }
}
