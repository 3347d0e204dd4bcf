//! Toasts for refusals and failures: each is shown for as long as it takes to read, and kept in the list of messages.

use std::collections::VecDeque;

use crate::storage::without_error_numbers;

/// Most toasts shown at once; a further one replaces the oldest.
const SHOWN: usize = 3;
/// Most messages kept.
const KEPT: usize = 200;
/// Reading speed, characters per second, of slow readers.
const READING: f64 = 15.0;
/// Seconds until the user notices the answer to a key, and a toast that appears on its own.
const LOOKING: (f64, f64) = (3.0, 8.0);

/// A message shown for a limited time.
#[derive(Clone, Debug, PartialEq)]
pub struct Toast {
    /// The message.
    pub text: String,
    /// Whether it answers a key: such a toast disappears with the next key that does something.
    is_answer: bool,
    /// Whether it is in the list of messages.
    pub is_kept: bool,
    /// Seconds until it disappears.
    left: f64,
}

/// The toasts on the screen, and all earlier messages.
#[derive(Debug, Default)]
pub struct Toasts {
    /// Toasts on the screen, the oldest first.
    pub shown: Vec<Toast>,
    past: VecDeque<String>,
    unwritten: Vec<String>,
}

impl Toasts {
    /// Shows the first of several messages that arrived together, and keeps the others in the list.
    pub fn push_first(&mut self, sentences: &[String]) {
        let Some((first, more)) = sentences.split_first() else { return };
        // The list shows the newest first; adding them in reverse keeps their order.
        for text in more.iter().rev() {
            let text = without_error_numbers(text.clone());
            if !self.past.contains(&text) {
                self.keep(text);
            }
        }
        let end = if more.is_empty() { String::new() } else { format!("; and {} more: F6", more.len()) };
        self.push(format!("{first}{end}"), false);
    }

    /// Shows `text`; if it is already visible, restarts its time.
    pub fn push(&mut self, text: String, is_answer: bool) {
        let text = without_error_numbers(text);
        let (answer, news) = LOOKING;
        let left = text.chars().count() as f64 / READING + if is_answer { answer } else { news };
        if let Some(known) = self.shown.iter_mut().find(|toast| toast.text == text) {
            known.left = left;
            return;
        }
        if self.shown.len() == SHOWN {
            self.shown.remove(0);
        }
        self.keep(text.clone());
        self.shown.push(Toast { text, is_answer, is_kept: true, left });
    }

    /// Shows an answer to a key without keeping it in the list.
    pub fn push_unlisted(&mut self, text: String) {
        let left = text.chars().count() as f64 / READING + LOOKING.0;
        self.shown.push(Toast { text, is_answer: true, is_kept: false, left });
    }

    /// Adds a message to the list. Repetitions, as from a key that is held down, are added once.
    fn keep(&mut self, text: String) {
        if self.past.front() == Some(&text) {
            return;
        }
        self.past.push_front(text.clone());
        self.past.truncate(KEPT);
        self.unwritten.push(text);
    }

    /// All kept messages, the newest first.
    pub fn past(&self) -> impl ExactSizeIterator<Item = &str> {
        self.past.iter().map(String::as_str)
    }

    /// Takes the messages since the last call, for the log.
    pub fn take_unwritten(&mut self) -> Vec<String> {
        std::mem::take(&mut self.unwritten)
    }

    /// Removes the answers to keys: the user has gone on, so they have been read.
    pub fn go_on(&mut self) {
        self.shown.retain(|toast| !toast.is_answer);
    }

    /// Removes all toasts from the screen.
    pub fn clear(&mut self) {
        self.shown.clear();
    }

    /// Advances the time by `seconds`.
    pub fn tick(&mut self, seconds: f64) {
        self.shown.retain_mut(|toast| {
            toast.left -= seconds;
            toast.left > 0.0
        });
    }

    /// Seconds until the next toast disappears; `None` if none is shown.
    pub fn left(&self) -> Option<f64> {
        self.shown.iter().map(|toast| toast.left).min_by(f64::total_cmp)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(toasts: &Toasts) -> Vec<&str> {
        toasts.shown.iter().map(|toast| toast.text.as_str()).collect()
    }

    #[test]
    fn what_is_said_again_and_again_is_kept_once() {
        let mut toasts = Toasts::default();
        for _ in 0..5 {
            toasts.push("white stops at the rail".to_owned(), true);
            toasts.go_on();
        }
        toasts.push("white stops at the rail".to_owned(), true);
        assert_eq!(texts(&toasts), ["white stops at the rail"], "it is shown all the same");
        assert_eq!(toasts.past().len(), 1);
        assert_eq!(toasts.take_unwritten().len(), 1);
    }

    #[test]
    fn long_sentences_stay_longer_and_what_comes_by_itself_longer_than_answers() {
        let time = |text: &str, is_answer| {
            let mut toasts = Toasts::default();
            toasts.push(text.to_owned(), is_answer);
            toasts.left().unwrap()
        };
        assert!(time("no", true) > 3.0 && time("no", true) < time("no", false));
        assert!(time(&"word ".repeat(60), true) > 20.0, "300 letters");
    }

    #[test]
    fn each_goes_in_its_time_and_answers_with_the_next_key() {
        let mut toasts = Toasts::default();
        toasts.push("there is nothing to take back".to_owned(), true);
        toasts.push("the disk is full".to_owned(), false);
        toasts.tick(toasts.left().unwrap());
        assert_eq!(texts(&toasts), ["the disk is full"]);
        toasts.push("there is no shot yet".to_owned(), true);
        toasts.go_on();
        assert_eq!(texts(&toasts), ["the disk is full"]);
        toasts.tick(60.0);
        assert_eq!((texts(&toasts), toasts.left()), (Vec::new(), None));
        assert_eq!(toasts.past().next(), Some("there is no shot yet"), "they can be read again");
    }

    #[test]
    fn of_several_the_first_is_shown_and_each_is_kept_once() {
        let mut toasts = Toasts::default();
        let sentences = ["line 1", "line 2", "line 3"].map(str::to_owned);
        for _ in 0..2 {
            toasts.push_first(&sentences);
        }
        assert_eq!(texts(&toasts), ["line 1; and 2 more: F6"]);
        assert_eq!(toasts.past().collect::<Vec<_>>(), ["line 1; and 2 more: F6", "line 2", "line 3"]);
        assert_eq!(toasts.take_unwritten().len(), 3);
        toasts.push_first(&sentences[2..]);
        assert_eq!(texts(&toasts)[1], "line 3", "alone there is nothing more");
    }

    #[test]
    fn three_are_shown_the_same_once_and_all_of_them_are_written_down_once() {
        let mut toasts = Toasts::default();
        for text in ["one", "one", "two", "three", "four"] {
            toasts.push(text.to_owned(), false);
        }
        assert_eq!(texts(&toasts), ["two", "three", "four"]);
        assert_eq!(toasts.take_unwritten(), ["one", "two", "three", "four"]);
        assert!(toasts.take_unwritten().is_empty());
        for n in 0..300 {
            toasts.push(n.to_string(), false);
        }
        assert_eq!(toasts.past().len(), KEPT);
    }
}
