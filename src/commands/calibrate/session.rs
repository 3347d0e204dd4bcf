//! A guided calibration session in plain lines: test by test, each entry is saved at once.

use std::path::PathBuf;

use super::{Args, failure, listing::words, report_result};
use crate::{
    calibration::{
        DAILY_TESTS, Edit, Entries, Entry, FAR_END, PROTOCOL, RAILS, Test, edit_entries, load_entries_or_empty,
        missing_daily_tests,
    },
    commands::{
        Failure,
        output::{print_note, prompt_line, refused_lines_result},
    },
    storage::DataPaths,
    table::{Table, TableDoubt},
};

/// The commands that can be typed instead of marks.
const HELP: &str = "type the marks of a stroke on one line, in their order or by name (stop 3.4 rails 5), - for one that is not \
                    known, far-end yes after a test that was played from the far end; or skip, again (the last test once \
                    more), undo (the last entry), quit";

/// Asks for tests until all are played, the input ends or the player types "quit"; then reports the result.
pub fn run(args: &Args, table: &Table, doubt: &TableDoubt) -> Result<(), Failure> {
    let places = DataPaths::of_this_user();
    let path = if args.daily { places.daily_check } else { places.calibration };
    let mut session = Session::open(path, args.daily)?;
    print_note(HELP);
    print_note(format_args!("entries are saved in {}", session.path.display()));
    let (mut shown, mut refused) = (None, 0);
    while let Some(test) = session.next() {
        if shown != Some((test.name, session.entries.trials.len())) {
            let place = if args.daily {
                DAILY_TESTS.iter().position(|name| *name == test.name)
            } else {
                PROTOCOL.iter().position(|one| one.name == test.name)
            };
            // The daily check has each of its tests once.
            let repetitions = if args.daily { 1 } else { test.repetitions };
            words(1 + place.unwrap_or_default(), &Test { repetitions, ..*test }).iter().for_each(print_note);
            shown = Some((test.name, session.entries.trials.len()));
        }
        let names: Vec<&str> = test.field_names().collect();
        let Some(text) = prompt_line(&format!("{}: ", names.join(" ")))? else { break };
        let text = match text {
            Ok(text) => text,
            Err(failure) => {
                refused += 1;
                print_note(failure);
                continue;
            }
        };
        match text.as_str() {
            "" => {}
            "skip" => session.skip(test),
            "again" => session.repeat_last(),
            "undo" => session.undo()?,
            "help" | "?" => print_note(HELP),
            marks => match entry(table, test, marks) {
                Ok(entry) => {
                    let kept = entry_summary(test, &entry);
                    session.add(entry)?;
                    print_note(format_args!("saved: {}, stroke {}: {kept}", test.name, session.count(test)));
                }
                Err(what) => {
                    refused += 1;
                    print_note(format_args!("{}: {what}; nothing was saved", test.name));
                }
            },
        }
    }
    if session.entries.trials.is_empty() && args.out.is_none() {
        print_note("nothing is entered yet");
    } else {
        report_result(args, table, doubt, &session.entries)?;
    }
    refused_lines_result(refused)
}

/// Parses a typed line as an entry.
fn entry(table: &Table, test: &Test, text: &str) -> Result<Entry, String> {
    let mut entry = Entry { test: test.name.to_owned(), ..Entry::default() };
    let mut marks = test.field_names();
    let is_a_name = |word: &str| [RAILS, FAR_END].contains(&word) || test.marks.iter().any(|mark| mark.name == word);
    let values = values(text, is_a_name);
    let mut words = values.iter().map(String::as_str);
    while let Some(word) = words.next() {
        let is_name = is_a_name(word);
        let name = if is_name {
            word
        } else {
            marks.next().ok_or_else(|| format!("\"{word}\" is one value too many; {HELP}"))?
        };
        let value = if is_name { words.next().ok_or_else(|| format!("{word} has no value"))? } else { word };
        entry.set_field(name, value)?;
    }
    let (_, odd) = entry.readings(table);
    if odd.is_empty() { Ok(entry) } else { Err(odd.join("; ")) }
}

/// Describes the marks of an entry and those it lacks, except a count of rails whose usual number is known.
fn entry_summary(test: &Test, entry: &Entry) -> String {
    let has = |name: &&str| !entry.field_text(name).is_empty();
    let named =
        test.field_names().chain([FAR_END]).filter(has).map(|name| format!("{name} {}", entry.field_text(name)));
    let named = named.collect::<Vec<_>>().join(", ");
    let is_open = |name: &&str| !has(name) && (*name != RAILS || test.rails.is_none());
    match test.field_names().filter(is_open).collect::<Vec<_>>().join(", ") {
        open if open.is_empty() => named,
        open => format!("{named}; without {open} (undo removes it)"),
    }
}

/// Splits the typed text into values. A number stays together with its unit and its uncertainty: `725 mm ~ 5 mm` is one value.
fn values(text: &str, is_a_name: impl Fn(&str) -> bool) -> Vec<String> {
    let mut values: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match values.last_mut() {
            Some(last)
                if last.starts_with(|first: char| first.is_ascii_digit())
                    && (word.starts_with(['~', '±'])
                        || last.ends_with(['~', '±'])
                        || word.chars().all(char::is_alphabetic) && !is_a_name(word)) =>
            {
                last.extend([" ", word]);
            }
            _ => values.push(word.to_owned()),
        }
    }
    values
}

/// The entries and the file in which they are stored.
struct Session {
    path: PathBuf,
    entries: Entries,
    /// Tests that the player has skipped.
    skipped: Vec<&'static str>,
    /// A test that is repeated.
    repeated: Option<&'static Test>,
    is_daily: bool,
    /// Whether the file still contains the check of an earlier day. The first entry moves it to a backup next to the file.
    holds_earlier_check: bool,
}

impl Session {
    /// Continues with the entries in the file. A daily check that already has both tests is from an earlier day: a new one begins.
    fn open(path: PathBuf, is_daily: bool) -> Result<Self, Failure> {
        let entries = load_entries_or_empty(&path).map_err(failure)?;
        let mut session =
            Self { path, entries, skipped: Vec::new(), repeated: None, is_daily, holds_earlier_check: false };
        if is_daily && session.next().is_none() {
            session.holds_earlier_check = true;
            session.entries = Entries::default();
        }
        Ok(session)
    }

    /// Returns the number of saved strokes of a test.
    fn count(&self, test: &Test) -> usize {
        self.entries.trials.iter().filter(|entry| entry.test == test.name).count()
    }

    /// Returns the next test to ask for.
    fn next(&self) -> Option<&'static Test> {
        let is_wanted = |test: &Test| !self.skipped.contains(&test.name);
        let missing = if self.is_daily { missing_daily_tests(&self.entries) } else { self.entries.missing() };
        self.repeated.or_else(|| missing.into_iter().map(|(test, _)| test).find(|test| is_wanted(test)))
    }

    fn add(&mut self, entry: Entry) -> Result<(), Failure> {
        self.repeated = None;
        if std::mem::take(&mut self.holds_earlier_check) {
            self.edit(&Edit::ReplaceAll(Entries::default()))?;
        }
        self.edit(&Edit::Add(entry))
    }

    fn undo(&mut self) -> Result<(), Failure> {
        let Some(entry) = self.entries.trials.last().cloned() else {
            print_note("there is nothing to undo");
            return Ok(());
        };
        self.skipped.retain(|name| *name != entry.test);
        let said = format!("the last entry ({}) was removed", entry.test);
        self.edit(&Edit::Remove(self.entries.trials.len() - 1, entry))?;
        print_note(said);
        Ok(())
    }

    fn skip(&mut self, test: &'static Test) {
        self.repeated = None;
        self.skipped.push(test.name);
    }

    fn repeat_last(&mut self) {
        self.repeated = self.entries.trials.last().and_then(|entry| Test::named(&entry.test));
        if self.repeated.is_none() {
            print_note("there is no test yet to play again");
        }
    }

    /// Changes the file, and continues with its new content.
    fn edit(&mut self, edit: &Edit) -> Result<(), Failure> {
        (self.entries, _) = edit_entries(&self.path, edit).map_err(failure)?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_and_its_unit_are_one_value() {
        let is_a_name = |word: &str| ["drift", "rails"].contains(&word);
        let typed = "9.1 725 mm ~ 5 mm drift 3 cm rails 1";
        assert_eq!(values(typed, is_a_name), ["9.1", "725 mm ~ 5 mm", "drift", "3 cm", "rails", "1"]);
        assert_eq!(values("- 5.3 drift 1.2~0.1", is_a_name), ["-", "5.3", "drift", "1.2~0.1"]);
    }
}
