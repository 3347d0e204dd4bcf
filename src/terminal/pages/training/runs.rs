//! The list of training runs and its marked (selected) run.

use crate::{
    learning::run::{
        follow::Condition,
        list::{Listing, Summary},
        status::Phase,
    },
    terminal::pages::moved_index,
};

/// The list of runs.
#[derive(Debug, Default)]
pub struct RunList {
    /// The runs, newest first; `None` until the folder has been read.
    pub known: Option<Vec<Summary>>,
    /// The reason why the runs cannot be listed.
    pub trouble: Option<String>,
    /// Messages on runs that cannot be read.
    pub unreadable: Vec<String>,
    /// Name of the marked run. A name keeps the mark on the run if new runs are listed before it.
    marked: Option<String>,
}

impl RunList {
    /// Replaces the list with what was found in the folder.
    pub fn set_runs(&mut self, found: Result<Listing, String>) {
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

    /// Index of the marked run in the list; 0 if none was marked or the run is gone.
    pub fn mark(&self) -> usize {
        let is_marked = |run: &Summary| Some(&run.name) == self.marked.as_ref();
        self.runs().iter().position(is_marked).unwrap_or(0)
    }

    /// The marked run; `None` if there are no runs.
    pub fn marked(&self) -> Option<&Summary> {
        self.runs().get(self.mark())
    }

    /// Moves the mark by `lines`, downwards if positive, within the list.
    pub fn move_mark(&mut self, lines: isize) {
        let mark = moved_index(self.mark(), lines, self.runs().len());
        self.marked = self.runs().get(mark).map(|run| run.name.clone());
    }

    /// Marks the run `name`.
    pub fn mark_named(&mut self, name: &str) {
        self.marked = Some(name.to_owned());
    }

    /// Marks the run below the run `name`, or the one above it if there is none below.
    pub fn mark_neighbour(&mut self, name: &str) {
        self.mark_named(name);
        let own = self.mark();
        self.move_mark(1);
        if self.mark() == own {
            self.move_mark(-1);
        }
    }

    /// The reason why the marked run cannot be resumed; `None` if it can.
    pub fn resume_refusal(&self) -> Option<&'static str> {
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
