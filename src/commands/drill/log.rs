//! `carom drill log`: records makes and misses at a real table.

use std::io::{self, IsTerminal};

use serde::Serialize;

use super::{
    Workspace,
    score::{Score, words},
    workspace::skill_or_default,
};
use crate::{
    commands::{
        Failure,
        input::whole_number,
        output::{json_line, print_line, print_note, prompt_line, refused_lines_result},
    },
    drills::{Attempt, Goal, Session, Venue},
    storage::Lock,
};

/// Log makes and misses at a real table.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The exercise: its name, its title, or the beginning of either.
    name: String,
    /// The results in order: make or miss; "undo" removes the last result, even one of an earlier call. Without results, they are read from
    /// the standard input, one word a line, and each is saved to disk before it is answered.
    #[arg(conflicts_with_all = ["made", "of"])]
    results: Vec<String>,
    /// Number of points made, if their order is not known: they do not count for runs.
    #[arg(long, requires = "of", value_parser = whole_number(0..=100_000_u32))]
    made: Option<u32>,
    /// Number of attempts, including the points.
    #[arg(long, requires = "made", value_parser = whole_number(1..=100_000_u32))]
    of: Option<u32>,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Logged<'a> {
    session: &'a str,
    #[serde(flatten)]
    score: Score,
}

/// A typed word: an attempt, and whether it made the point, or an undo.
#[derive(Clone, Copy)]
enum LogEntry {
    Attempt(bool),
    Undo,
}

impl LogEntry {
    fn read(text: &str) -> Result<Self, Failure> {
        match text {
            "make" => Ok(Self::Attempt(true)),
            "miss" => Ok(Self::Attempt(false)),
            "undo" => Ok(Self::Undo),
            _ => Err(Failure::wrong_input(format_args!(
                "\"{text}\" is not a result; accepted are make, miss and undo, or --made 7 --of 10"
            ))),
        }
    }
}

pub fn run(args: &Args) -> Result<(), Failure> {
    let workspace = Workspace::open();
    let exercise = workspace.exercise(&args.name)?.clone();
    let name = exercise.name.clone();
    let session = Session::new(Goal::Free, Venue::Table, vec![exercise], skill_or_default(None), 0);
    let mut log = Log { workspace, session, name, json: args.json, known: None, lock: None };
    if let (Some(made), Some(of)) = (args.made, args.of) {
        if made > of {
            return Err(Failure::wrong_input(format_args!(
                "{made} made of {of} is impossible; --made is at most --of"
            )));
        }
        log.session.unordered = true;
        for number in 0..of {
            log.apply(LogEntry::Attempt(number < made))?;
        }
        return log.save_and_report();
    }
    if args.results.is_empty() {
        return log.read();
    }
    let words: Vec<LogEntry> = args.results.iter().map(|text| LogEntry::read(text)).collect::<Result<_, _>>()?;
    for (applied, word) in words.into_iter().enumerate() {
        if !log.apply(word)? {
            if applied > 0 {
                log.save_and_report()?;
            }
            return Err(Failure::failed(log.nothing_to_undo()));
        }
    }
    log.save_and_report()
}

struct Log {
    workspace: Workspace,
    session: Session,
    /// Name of the exercise.
    name: String,
    json: bool,
    /// The attempts that the session's file is known to contain; `None` before it exists.
    known: Option<Vec<Attempt>>,
    /// Lock of the sessions, taken once something is on the disk. Without it, an attempt that another program adds could be lost, or one
    /// that it removes could reappear.
    lock: Option<Lock>,
}

impl Log {
    /// Applies a typed word; returns `false` if there is nothing to undo.
    fn apply(&mut self, word: LogEntry) -> Result<bool, Failure> {
        if self.known.is_some() {
            self.lock()?;
        }
        match word {
            LogEntry::Attempt(made) => self.session.log(made).map_err(Failure::failed).map(|()| true),
            LogEntry::Undo => self.undo(),
        }
    }

    fn nothing_to_undo(&self) -> String {
        format!("there is no attempt at {} to undo", self.name)
    }

    /// Removes the last attempt. If this session has none, it removes that of the last session at a real table, which is then continued.
    /// Returns `false` if there is no attempt at all.
    fn undo(&mut self) -> Result<bool, Failure> {
        self.lock()?;
        if self.session.attempts.is_empty() {
            let is_noted = |earlier: &Session| {
                (earlier.venue, earlier.goal) == (Venue::Table, Goal::Free)
                    && earlier.attempts.last().is_some_and(|last| last.exercise == self.name)
            };
            let mut earlier = self.workspace.sessions().into_iter().rev();
            let Some(noted) = earlier.find(is_noted) else { return Ok(false) };
            self.continue_with(noted);
        }
        if self.session.unordered {
            // They were entered together, so the last attempt is unknown.
            self.session.attempts.clear();
            self.session.unordered = false;
        } else {
            self.session.undo();
        }
        // Save now, because the next word may undo an attempt of another session.
        self.save().map(|()| true)
    }

    /// Prevents changes by other programs, and continues with their latest version of the session.
    fn lock(&mut self) -> Result<(), Failure> {
        if self.lock.is_none() {
            self.lock = Some(self.workspace.store.lock().map_err(Failure::failed)?);
            if let Some(known) = self.workspace.store.session(&self.session.id).map_err(Failure::failed)? {
                self.continue_with(known);
            }
        }
        Ok(())
    }

    /// Continues with a session that was read from the disk.
    fn continue_with(&mut self, session: Session) {
        self.known = Some(session.attempts.clone());
        self.session = session;
    }

    fn save(&mut self) -> Result<(), Failure> {
        let Self { workspace, session, known, lock, .. } = self;
        let before = known.as_deref().unwrap_or_default();
        let saved = match lock {
            Some(lock) => workspace.store.save_locked(lock, session, before, before.len()),
            None => workspace.store.save(session, before, before.len()),
        };
        saved.map_err(Failure::failed)?;
        *known = Some(session.attempts.clone());
        Ok(())
    }

    /// Saves the session and prints the score.
    fn save_and_report(&mut self) -> Result<(), Failure> {
        self.save()?;
        // Unlock, so that another program can add attempts while this one waits for the next word.
        self.lock = None;
        let record = self.session.record();
        if self.json {
            return Ok(json_line(&Logged { session: &self.session.id, score: record.into() })?);
        }
        if record.tried == 0 {
            return print_line("undone; this session has no other attempts");
        }
        print_line(words(&record))
    }

    /// Reads results from the standard input, and answers each.
    fn read(&mut self) -> Result<(), Failure> {
        let (mut refused, mut lacked_undo) = (0, false);
        while let Some(text) = prompt_line("make, miss, undo or quit: ")? {
            if text.as_ref().is_ok_and(String::is_empty) {
                continue;
            }
            match text.and_then(|text| LogEntry::read(&text)) {
                Err(failure) => {
                    refused += 1;
                    print_note(failure);
                }
                Ok(word) => {
                    if self.apply(word)? {
                        // Continue without a reader of the answers: every result must still be saved.
                        self.save_and_report()
                            .or_else(|failure| if failure.is_silent() { Ok(()) } else { Err(failure) })?;
                    } else {
                        self.lock = None;
                        lacked_undo = true;
                        print_note(self.nothing_to_undo());
                    }
                }
            }
        }
        refused_lines_result(refused)?;
        if lacked_undo && !io::stdin().is_terminal() {
            return Err(Failure::failed("an undo found nothing to undo, as reported above"));
        }
        Ok(())
    }
}
