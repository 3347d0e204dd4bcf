//! What was entered of all tests, or of a check of the day, and what is found out of it.

use std::path::PathBuf;

use crate::{
    calibration::{
        Calibration, DAILY_TESTS, Edit, Entries, Entry, EntryProblem, NextTest, PROTOCOL, Test, next_day_doubt, prior,
    },
    table::{Table, TableDoubt},
    terminal::{Judged, Judging},
};

/// The name of a table that was given none.
pub const UNNAMED: &str = "own";

/// What takes a change back.
#[derive(Clone, Debug, PartialEq)]
pub enum Back {
    /// A change of the file.
    Edit(Edit),
    /// This test is left out, or taken in again.
    Turn(&'static str),
}

/// A file of entries, and what is known of it.
#[derive(Debug, Default)]
pub struct Sheet {
    /// The file.
    pub path: PathBuf,
    /// Whether it is the check of a day.
    pub is_daily: bool,
    /// What the file holds; `None` before it was read, and where it cannot be.
    pub entries: Option<Entries>,
    /// Why it cannot be read.
    pub trouble: Option<String>,
    /// What follows from the entries, as far as it is known.
    pub judged: Option<Box<Judged>>,
    /// Why nothing follows.
    pub unjudged: Option<String>,
    /// Place of the marked test.
    pub mark: usize,
    /// The marked stroke of that test; the last one where it is none.
    stroke: Option<usize>,
    /// Changes that take those back that were made here.
    pub back: Vec<Back>,
    /// Tests that the player does not want to play.
    left_out: Vec<&'static str>,
    /// The number of the last question about the entries, and of the last that was answered.
    asked: u64,
    answered: u64,
}

impl Sheet {
    /// One of which nothing is known yet.
    pub fn new(path: PathBuf, is_daily: bool) -> Self {
        Self { path, is_daily, ..Self::default() }
    }

    /// Its tests, in the order in which they are played.
    pub fn tests(&self) -> impl Iterator<Item = &'static Test> + use<> {
        let is_daily = self.is_daily;
        PROTOCOL.iter().filter(move |test| !is_daily || DAILY_TESTS.contains(&test.name))
    }

    /// How often a test is asked for.
    pub const fn times(&self, test: &Test) -> usize {
        if self.is_daily { 1 } else { test.repetitions }
    }

    /// The marked test.
    pub fn test(&self) -> &'static Test {
        self.tests().nth(self.mark).unwrap_or(&PROTOCOL[0])
    }

    /// Moves the mark by tests.
    pub fn move_mark(&mut self, by: isize) {
        self.mark = self.mark.saturating_add_signed(by).min(self.tests().count() - 1);
        self.stroke = None;
    }

    /// Marks the test of this name, if it is one of them.
    pub(super) fn mark_test(&mut self, name: &str) {
        if let Some(mark) = self.tests().position(|test| test.name == name) {
            (self.mark, self.stroke) = (mark, None);
        }
    }

    /// The strokes of a test, each with its place among all entries.
    pub fn strokes(&self, test: &Test) -> Vec<(usize, &Entry)> {
        let all = self.entries.iter().flat_map(|entries| entries.trials.iter().enumerate());
        all.filter(|(_, entry)| entry.test == test.name).collect()
    }

    /// How many strokes are entered, and how many are asked for, of those tests that are not left out.
    pub fn count(&self) -> (usize, usize) {
        let asked = self.tests().filter(|test| !self.is_left_out(test));
        asked.fold((0, 0), |(entered, wanted), test| {
            let times = self.times(test);
            // More strokes of one do not stand for another.
            (entered + self.strokes(test).len().min(times), wanted + times)
        })
    }

    /// Place of the marked stroke among those of the marked test.
    pub fn stroke(&self) -> usize {
        let last = self.strokes(self.test()).len().saturating_sub(1);
        self.stroke.map_or(last, |stroke| stroke.min(last))
    }

    /// The marked stroke, with its place among all entries.
    pub fn marked_stroke(&self) -> Option<(usize, &Entry)> {
        self.strokes(self.test()).into_iter().nth(self.stroke())
    }

    /// Marks another stroke of the test.
    pub fn move_stroke(&mut self, by: isize) {
        let last = self.strokes(self.test()).len().saturating_sub(1);
        self.stroke = Some(self.stroke().saturating_add_signed(by).min(last));
    }

    /// Whether the player does not want to play a test.
    pub fn is_left_out(&self, test: &Test) -> bool {
        self.left_out.contains(&test.name)
    }

    /// Leaves the marked test out, with what is entered of it, or takes it in again; gives whether it is out.
    pub fn turn_left_out(&mut self) -> bool {
        let name = self.test().name;
        self.back.push(Back::Turn(name));
        self.turn(name)
    }

    /// The same of any test, as a change that is taken back.
    pub fn turn(&mut self, name: &'static str) -> bool {
        let count = self.left_out.len();
        self.left_out.retain(|one| *one != name);
        let is_out = self.left_out.len() == count;
        if is_out {
            self.left_out.push(name);
        }
        is_out
    }

    /// What the marks say, where there are any.
    pub fn found(&self) -> Option<&Calibration> {
        self.judged.as_ref()?.found.as_ref()
    }

    /// What one more stroke of a test is expected to tell, bits.
    pub fn bits(&self, test: &Test) -> Option<f64> {
        let next = &self.judged.as_ref()?.next;
        next.iter().find(|next| next.test == test.name).map(|next| next.bits)
    }

    /// The test that tells most, of those that are not left out.
    pub fn best(&self) -> Option<&NextTest> {
        let is_wanted = |next: &&NextTest| {
            self.tests().any(|test| test.name == next.test && !self.is_left_out(test))
                && (!self.is_daily || self.missing(next.test) > 0)
        };
        self.judged.as_ref()?.next.iter().find(is_wanted)
    }

    /// Strokes of a test that are not entered yet.
    fn missing(&self, name: &str) -> usize {
        Test::named(name).map_or(0, |test| self.times(test).saturating_sub(self.strokes(test).len()))
    }

    /// Marks the test that tells most; `false` where none is known.
    pub fn mark_best(&mut self) -> bool {
        let Some(best) = self.best().map(|next| next.test) else { return false };
        self.mark_test(best);
        true
    }

    /// Takes what the file holds, and where it was changed the change back. After a stroke of a test that needs no more the
    /// next that misses one is marked.
    pub fn take(&mut self, entries: Entries, back: Option<(Edit, bool)>) {
        let is_added = matches!(&back, Some((Edit::Remove(..), false)));
        self.entries = Some(entries);
        self.trouble = None;
        self.stroke = None;
        if let Some((back, false)) = back {
            self.back.push(Back::Edit(back));
        }
        if is_added && self.missing(self.test().name) == 0 {
            let later = self.tests().skip(self.mark + 1).chain(self.tests());
            let open = later.into_iter().find(|test| self.missing(test.name) > 0 && !self.is_left_out(test));
            if let Some(test) = open {
                self.mark_test(test.name);
            }
        }
    }

    /// What is odd about entries that count, as a file may hold them that was written by hand.
    pub fn odd(&self, table: &Table) -> Vec<EntryProblem> {
        let mut odd = self.entries.as_ref().map_or_else(Vec::new, |entries| entries.trials(table).1);
        odd.retain(|odd| !self.left_out.contains(&odd.test.as_str()));
        odd
    }

    /// What is held of the table that is played on before the tests.
    pub fn base(&self, table: &Table) -> (Table, TableDoubt) {
        if self.is_daily {
            let doubt = table.doubt.clone().unwrap_or_default();
            return (table.clone(), next_day_doubt(table, &doubt));
        }
        let usual = Table::default();
        let is_as_large = |one: &Table, other: &Table| {
            [one.length, one.width, one.radius] == [other.length, other.width, other.radius]
        };
        // The strokes that a table was calibrated by would count twice.
        let base = if table.doubt.is_some() && is_as_large(table, &usual) { usual } else { table.clone() };
        let base = Table { doubt: None, ..base };
        let doubt = prior(&base);
        (base, doubt)
    }

    /// Asks what the entries say of the table.
    pub fn judge(&mut self, table: &Table) -> Option<Judging> {
        let (base, doubt) = self.base(table);
        let (mut trials, _) = self.entries.as_ref()?.trials(&base);
        trials.retain(|(_, trial)| !self.is_left_out(trial.test));
        self.asked += 1;
        let (name, is_daily) = (self.name(table), self.is_daily);
        Some(Judging { number: self.asked, name, table: base, doubt, trials, is_daily })
    }

    /// What the table is called: as the entries say, or as it was, or as the player's own.
    pub fn name(&self, table: &Table) -> String {
        let own = table.doubt.is_some().then_some(&table.name);
        let named = self.entries.as_ref().and_then(|entries| entries.name.as_ref());
        named.or(own).map_or(UNNAMED, String::as_str).to_owned()
    }

    /// Takes the answer to the question `number`; late ones to earlier questions are dropped.
    pub fn answer(&mut self, number: u64, judged: Result<Box<Judged>, String>) {
        if number != self.asked {
            return;
        }
        self.answered = number;
        (self.judged, self.unjudged) = match judged {
            Ok(judged) => (Some(judged), None),
            Err(sentence) => (self.judged.take(), Some(sentence)),
        };
    }

    /// Whether an answer is on its way.
    pub const fn is_asking(&self) -> bool {
        self.asked != self.answered
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sheet(is_daily: bool) -> Sheet {
        Sheet::new("calibration.toml".into(), is_daily)
    }

    fn calibrated() -> Table {
        let table = Table { name: "ours".into(), rolling_friction: 0.007, ..Table::default() };
        Table { doubt: Some(prior(&table)), ..table }
    }

    #[test]
    fn strokes_that_a_table_was_calibrated_by_do_not_count_twice() {
        let (base, doubt) = sheet(false).base(&calibrated());
        assert_eq!(base.name, "match");
        assert!(!doubt.is_certain() && doubt == prior(&base));
        let textbook = Table::preset("textbook").unwrap();
        assert_eq!(sheet(false).base(&textbook).0, textbook);
        let small = Table { length: 2.54, width: 1.27, ..calibrated() };
        assert_eq!(sheet(false).base(&small).0.length, 2.54, "match is larger");
        let (today, doubt) = sheet(true).base(&calibrated());
        assert_eq!(today, calibrated());
        assert!(doubt.deviations["mu_r"] > calibrated().doubt.unwrap().deviations["mu_r"], "a day later");
    }

    #[test]
    fn after_the_last_stroke_of_a_test_the_next_that_misses_one_is_marked() {
        let mut sheet = sheet(false);
        let entry = Entry { test: "slow-roll".into(), ..Entry::default() };
        let add = |sheet: &mut Sheet, count: usize| {
            let entries = Entries { name: None, trials: vec![entry.clone(); count] };
            sheet.take(entries, Some((Edit::Remove(count - 1, entry.clone()), false)));
        };
        sheet.take(Entries::default(), None);
        assert!(sheet.back.is_empty());
        add(&mut sheet, 1);
        assert_eq!((sheet.test().name, sheet.stroke()), ("slow-roll", 0));
        sheet.move_mark(1);
        assert!(sheet.turn_left_out());
        sheet.move_mark(-1);
        add(&mut sheet, 2);
        assert_eq!(sheet.test().name, "lag", "slow-back is left out");
        assert_eq!(sheet.count(), (2, 19));
        assert_eq!(sheet.back.pop(), Some(Back::Edit(Edit::Remove(1, entry.clone()))));
        assert_eq!(sheet.back.pop(), Some(Back::Turn("slow-back")));
    }

    #[test]
    fn a_late_answer_to_an_earlier_question_is_dropped() {
        let mut sheet = sheet(false);
        sheet.take(Entries::default(), None);
        let first = sheet.judge(&Table::default()).unwrap().number;
        let second = sheet.judge(&Table::default()).unwrap().number;
        sheet.answer(first, Err("late".into()));
        assert!(sheet.is_asking() && sheet.unjudged.is_none());
        sheet.answer(second, Err("now".into()));
        assert_eq!((sheet.is_asking(), sheet.unjudged.as_deref()), (false, Some("now")));
    }
}
