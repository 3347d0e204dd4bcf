//! Toasts for refusals and failures: each is shown for as long as it takes to read, and kept in the list of messages.

use std::collections::VecDeque;

use crate::storage::without_error_numbers;

/// Most toasts shown at once; a further one replaces the oldest.
const MAX_SHOWN: usize = 3;
/// Most messages kept.
const MAX_MESSAGES: usize = 200;
/// Reading speed, characters per second, of slow readers.
const READING_SPEED: f64 = 15.0;
/// Seconds until the user notices the answer to a key, and a toast that appears on its own.
const NOTICE_TIMES: (f64, f64) = (3.0, 8.0);

/// A message shown for a limited time.
#[derive(Clone, Debug, PartialEq)]
pub struct Toast {
    /// The message.
    pub text: String,
    /// Whether it answers a key: such a toast disappears with the next key that does something.
    is_answer: bool,
    /// Whether it is in the list of messages.
    pub is_listed: bool,
    /// Seconds until it disappears.
    time_left: f64,
}

/// The toasts on the screen, and all earlier messages.
#[derive(Debug, Default)]
pub struct Toasts {
    /// Toasts on the screen, the oldest first.
    pub shown: Vec<Toast>,
    messages: VecDeque<String>,
    unlogged: Vec<String>,
}

impl Toasts {
    /// Shows the first of several messages that arrived together, and keeps the others in the list.
    pub fn push_first(&mut self, sentences: &[String]) {
        let Some((first, more)) = sentences.split_first() else { return };
        // The list shows the newest first; adding them in reverse keeps their order.
        for text in more.iter().rev() {
            let text = without_error_numbers(text.clone());
            if !self.messages.contains(&text) {
                self.keep(text);
            }
        }
        let end = if more.is_empty() { String::new() } else { format!("; and {} more: F6", more.len()) };
        self.push_with(first.clone(), &end, false);
    }

    /// Shows `text`; if it is already visible, restarts its time.
    pub fn push(&mut self, text: String, is_answer: bool) {
        self.push_with(text, "", is_answer);
    }

    /// Shows `text` followed by `end`, and keeps `text` in the list.
    fn push_with(&mut self, text: String, end: &str, is_answer: bool) {
        let listed = without_error_numbers(text);
        let text = format!("{listed}{end}");
        let (answer, unprompted) = NOTICE_TIMES;
        let time_left = text.chars().count() as f64 / READING_SPEED + if is_answer { answer } else { unprompted };
        if let Some(known) = self.shown.iter_mut().find(|toast| toast.text == text) {
            known.time_left = time_left;
            return;
        }
        if self.shown.len() == MAX_SHOWN {
            self.shown.remove(0);
        }
        self.keep(listed);
        self.shown.push(Toast { text, is_answer, is_listed: true, time_left });
    }

    /// Shows an answer to a key without keeping it in the list.
    pub fn push_unlisted(&mut self, text: String) {
        let time_left = text.chars().count() as f64 / READING_SPEED + NOTICE_TIMES.0;
        self.shown.push(Toast { text, is_answer: true, is_listed: false, time_left });
    }

    /// Adds a message to the list. Repetitions, as from a key that is held down, are added once.
    fn keep(&mut self, text: String) {
        if self.messages.front() == Some(&text) {
            return;
        }
        self.messages.push_front(text.clone());
        self.messages.truncate(MAX_MESSAGES);
        self.unlogged.push(text);
    }

    /// All kept messages, the newest first.
    pub fn messages(&self) -> impl ExactSizeIterator<Item = &str> {
        self.messages.iter().map(String::as_str)
    }

    /// Takes the messages since the last call, for the log.
    pub fn take_unlogged(&mut self) -> Vec<String> {
        std::mem::take(&mut self.unlogged)
    }

    /// Removes the answers to keys: the user has gone on, so they have been read.
    pub fn dismiss_answers(&mut self) {
        self.shown.retain(|toast| !toast.is_answer);
    }

    /// Removes all toasts from the screen.
    pub fn clear(&mut self) {
        self.shown.clear();
    }

    /// Advances the time by `seconds`.
    pub fn tick(&mut self, seconds: f64) {
        self.shown.retain_mut(|toast| {
            toast.time_left -= seconds;
            toast.time_left > 0.0
        });
    }

    /// Seconds until the next toast disappears; `None` if none is shown.
    pub fn time_left(&self) -> Option<f64> {
        self.shown.iter().map(|toast| toast.time_left).min_by(f64::total_cmp)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(toasts: &Toasts) -> Vec<&str> {
        toasts.shown.iter().map(|toast| toast.text.as_str()).collect()
    }

    #[test]
    fn repeated_messages_are_listed_once() {
        let mut toasts = Toasts::default();
        for _ in 0..5 {
            toasts.push("white stops at the rail".to_owned(), true);
            toasts.dismiss_answers();
        }
        toasts.push("white stops at the rail".to_owned(), true);
        assert_eq!(texts(&toasts), ["white stops at the rail"], "it is shown all the same");
        assert_eq!(toasts.messages().len(), 1);
        assert_eq!(toasts.take_unlogged().len(), 1);
    }

    #[test]
    fn long_and_unprompted_toasts_stay_longer() {
        let time = |text: &str, is_answer| {
            let mut toasts = Toasts::default();
            toasts.push(text.to_owned(), is_answer);
            toasts.time_left().unwrap()
        };
        assert!(time("no", true) > 3.0 && time("no", true) < time("no", false));
        assert!(time(&"word ".repeat(60), true) > 20.0, "300 letters");
    }

    #[test]
    fn toasts_expire_and_answers_disappear_with_the_next_key() {
        let mut toasts = Toasts::default();
        toasts.push("there is nothing to undo".to_owned(), true);
        toasts.push("the disk is full".to_owned(), false);
        toasts.tick(toasts.time_left().unwrap());
        assert_eq!(texts(&toasts), ["the disk is full"]);
        toasts.push("there is no shot yet".to_owned(), true);
        toasts.dismiss_answers();
        assert_eq!(texts(&toasts), ["the disk is full"]);
        toasts.tick(60.0);
        assert_eq!((texts(&toasts), toasts.time_left()), (Vec::new(), None));
        assert_eq!(toasts.messages().next(), Some("there is no shot yet"), "they can be read again");
    }

    #[test]
    fn of_several_messages_the_first_is_shown_and_all_are_listed() {
        let mut toasts = Toasts::default();
        let sentences = ["line 1", "line 2", "line 3"].map(str::to_owned);
        for _ in 0..2 {
            toasts.push_first(&sentences);
        }
        assert_eq!(texts(&toasts), ["line 1; and 2 more: F6"]);
        assert_eq!(toasts.messages().collect::<Vec<_>>(), ["line 1", "line 2", "line 3"]);
        assert_eq!(toasts.take_unlogged().len(), 3);
        toasts.push_first(&sentences[2..]);
        assert_eq!(texts(&toasts)[1], "line 3", "alone there is nothing more");
    }

    #[test]
    fn at_most_three_distinct_toasts_are_shown_and_all_are_logged() {
        let mut toasts = Toasts::default();
        for text in ["one", "one", "two", "three", "four"] {
            toasts.push(text.to_owned(), false);
        }
        assert_eq!(texts(&toasts), ["two", "three", "four"]);
        assert_eq!(toasts.take_unlogged(), ["one", "two", "three", "four"]);
        assert!(toasts.take_unlogged().is_empty());
        for n in 0..300 {
            toasts.push(n.to_string(), false);
        }
        assert_eq!(toasts.messages().len(), MAX_MESSAGES);
    }
}
