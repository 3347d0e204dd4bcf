//! Recording shots on a thread: one set at a time, and always the newest. That may take seconds where balls press each
//! other for long, and meanwhile a run may measure itself again and again.

use std::{
    io,
    sync::mpsc::{Sender, channel},
    thread,
};

/// A thread that works on the newest of what it is given; dropping it ends the thread after its work.
#[derive(Debug)]
pub struct Recorder<T>(Sender<T>);

impl<T: Send + 'static> Recorder<T> {
    /// Starts the thread, which does `work`.
    ///
    /// # Errors
    /// A thread that could not be started.
    pub fn start(mut work: impl FnMut(T) + Send + 'static) -> io::Result<Self> {
        let (to_recorder, tasks) = channel();
        thread::Builder::new().name("recorder".into()).spawn(move || {
            while let Ok(task) = tasks.recv() {
                work(tasks.try_iter().last().unwrap_or(task));
            }
        })?;
        Ok(Self(to_recorder))
    }

    /// Hands it something newer.
    pub fn take(&self, task: T) {
        // Without its thread there is no replay, and all else goes on.
        let _ = self.0.send(task);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn of_all_that_comes_during_its_work_only_the_newest_is_worked_on() {
        let ((begun, begins), (go_on, may_go_on)) = (channel(), channel());
        let recorder = Recorder::start(move |task: u32| {
            begun.send(task).unwrap();
            may_go_on.recv().unwrap();
        })
        .unwrap();
        let next = || begins.recv_timeout(Duration::from_secs(20)).unwrap();
        recorder.take(1);
        assert_eq!(next(), 1);
        for task in 2..=50 {
            recorder.take(task);
        }
        go_on.send(()).unwrap();
        assert_eq!(next(), 50);
        drop(recorder);
        go_on.send(()).unwrap();
        assert!(begins.recv_timeout(Duration::from_secs(20)).is_err(), "the thread has ended");
    }
}
