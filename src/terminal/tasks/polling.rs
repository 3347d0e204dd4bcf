//! Polling on a thread, until the poll is dropped.

use std::{
    io,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
        mpsc::Sender,
    },
    thread,
    time::Duration,
};

use crate::terminal::tasks::event::Event;

/// Number of polls without news after which polling slows down: a finished run seldom changes.
const IDLE_POLLS: u32 = 30;
/// Smallest interval after slowing down.
const IDLE_INTERVAL: Duration = Duration::from_millis(500);

/// A polling thread; dropping the value ends it.
#[derive(Debug)]
pub struct Poll {
    stop: Arc<AtomicBool>,
    /// Whether the screen has not yet handled the last event.
    waiting: Arc<AtomicBool>,
}

impl Poll {
    /// Calls `look` every `interval` and sends its events.
    ///
    /// # Errors
    /// Fails if the thread cannot be started.
    pub fn start(
        name: &str,
        interval: Duration,
        to_screen: Sender<Event>,
        mut look: impl FnMut() -> Option<Event> + Send + 'static,
    ) -> io::Result<Self> {
        let poll = Self { stop: Arc::default(), waiting: Arc::default() };
        let (stop, waiting) = (Arc::clone(&poll.stop), Arc::clone(&poll.waiting));
        thread::Builder::new().name(name.into()).spawn(move || {
            let mut idle_polls = 0;
            while !stop.load(Ordering::Relaxed) {
                if !waiting.load(Ordering::Acquire) {
                    idle_polls += 1;
                    if let Some(event) = look() {
                        idle_polls = 0;
                        waiting.store(true, Ordering::Release);
                        if to_screen.send(event).is_err() {
                            break;
                        }
                    }
                }
                thread::sleep(if idle_polls < IDLE_POLLS { interval } else { interval.max(IDLE_INTERVAL) });
            }
        })?;
        Ok(poll)
    }

    /// Confirms that the last event was handled.
    pub fn acknowledge(&self) {
        self.waiting.store(false, Ordering::Release);
    }
}

impl Drop for Poll {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terminal::TrainingReport;
    use std::sync::mpsc::channel;

    #[test]
    fn a_poll_waits_for_acknowledgement_and_ends_when_dropped() {
        let (sender, receiver) = channel();
        let look = || Some(Event::Training(TrainingReport::Runs(Err(String::new()))));
        let poll = Poll::start("test", Duration::from_millis(1), sender, look).unwrap();
        let patience = Duration::from_secs(20);
        assert!(receiver.recv_timeout(patience).is_ok());
        assert!(receiver.recv_timeout(Duration::from_millis(50)).is_err(), "not before they are taken");
        poll.acknowledge();
        assert!(receiver.recv_timeout(patience).is_ok());
        drop(poll);
        // The thread ends and closes the channel.
        assert!(
            receiver
                .recv_timeout(patience)
                .is_err_and(|error| error == std::sync::mpsc::RecvTimeoutError::Disconnected)
        );
    }
}
