//! The list of runs and the mark in it.

use crate::learning::run::{
    follow::Condition,
    list::{Listing, Summary},
    status::Phase,
};

/// The list of runs.
#[derive(Debug, Default)]
pub struct RunList {
    /// The runs, newest first; nothing before they were looked for.
    pub known: Option<Vec<Summary>>,
    /// Why they cannot be listed.
    pub trouble: Option<String>,
    /// Sentences on those that cannot be read.
    pub unreadable: Vec<String>,
    /// Name of the marked run: it keeps its mark where others come before it.
    marked: Option<String>,
}

impl RunList {
    /// Takes what was found.
    pub fn take(&mut self, found: Result<Listing, String>) {
        match found {
            Ok(Listing { mut runs, unreadable }) => {
                self.unreadable = unreadable;
                runs.sort_by(|one, other| (&other.started, &other.name).cmp(&(&one.started, &one.name)));
                self.known = Some(runs);
                self.trouble = None;
            }
            Err(sentence) => self.trouble = Some(sentence),
        }
    }

    /// The runs, newest first.
    pub fn runs(&self) -> &[Summary] {
        self.known.as_deref().unwrap_or_default()
    }

    /// Place of the marked run in the list; the first where none was marked or it is gone.
    pub fn mark(&self) -> usize {
        let is_marked = |run: &Summary| Some(&run.name) == self.marked.as_ref();
        self.runs().iter().position(is_marked).unwrap_or(0)
    }

    /// The marked run; none where there are no runs.
    pub fn marked(&self) -> Option<&Summary> {
        self.runs().get(self.mark())
    }

    /// Moves the mark by lines, down where positive, as far as there are any.
    pub fn move_mark(&mut self, lines: isize) {
        let last = self.runs().len().saturating_sub(1);
        let mark = self.mark().saturating_add_signed(lines).min(last);
        self.marked = self.runs().get(mark).map(|run| run.name.clone());
    }

    /// Marks the run called `name`.
    pub fn mark_named(&mut self, name: &str) {
        self.marked = Some(name.to_owned());
    }

    /// Marks the run below the one called `name`, or else the one above it.
    pub fn mark_beside(&mut self, name: &str) {
        self.mark_named(name);
        let own = self.mark();
        self.move_mark(1);
        if self.mark() == own {
            self.move_mark(-1);
        }
    }

    /// Why the marked run cannot go on; `None` where it can.
    pub fn refusal_to_go_on(&self) -> Option<&'static str> {
        match self.marked().map(|run| run.state) {
            None => Some("there is no run yet; n starts one"),
            Some(state) if state.is_at_work() => Some("this run is training; Enter watches it"),
            Some(Condition::InPhase(Phase::Finished)) => {
                Some("this run is finished; n starts a new one, with its networks if you like")
            }
            Some(_) => None,
        }
    }
}
