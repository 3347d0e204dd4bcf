//! A calibration sheet: the strokes entered for the tests, and the values that result. There is one sheet for the full calibration
//! and one for the daily check.

use std::path::PathBuf;

use crate::{
    calibration::{
        Calibration, DAILY_TESTS, Edit, Entries, Entry, EntryProblem, NextTest, PROTOCOL, Test, next_day_doubt, prior,
    },
    table::{Rails, Table, TableDoubt},
    terminal::{Evaluation, EvaluationTask, pages::moved_index},
};

/// Default name of a table that the user did not name.
pub const UNNAMED: &str = "own";

/// An undo step.
#[derive(Clone, Debug, PartialEq)]
pub enum UndoStep {
    /// A change of the entries in the file.
    Edit(Edit),
    /// Leaving this test out, or including it again.
    LeaveOut(&'static str),
}

/// A file of entries with its evaluation.
#[derive(Debug, Default)]
pub struct Sheet {
    /// The file.
    pub path: PathBuf,
    /// Whether this is the sheet of the daily check.
    pub is_daily: bool,
    /// The entries; `None` until the file has been read, or if it cannot be read.
    pub entries: Option<Entries>,
    /// The file of the table that was last saved from this sheet.
    pub saved: Option<PathBuf>,
    /// The reason why the file cannot be read.
    pub trouble: Option<String>,
    /// The latest evaluation of the entries; `None` until there is one.
    pub judged: Option<Box<Evaluation>>,
    /// The reason why the entries could not be evaluated.
    pub evaluation_error: Option<String>,
    /// Index of the marked test.
    pub mark: usize,
    /// Index of the marked stroke of that test; `None` for the last one.
    stroke: Option<usize>,
    /// The undo stack.
    pub undo_stack: Vec<UndoStep>,
    /// Undo steps that are being saved.
    pub unsaved_undo: Vec<Edit>,
    /// Tests that the player does not want to play.
    left_out: Vec<&'static str>,
    /// The numbers of the last requested and of the last received evaluation.
    asked: u64,
    answered: u64,
}

impl Sheet {
    /// Creates a sheet whose file has not been read yet.
    pub fn new(path: PathBuf, is_daily: bool) -> Self {
        Self { path, is_daily, ..Self::default() }
    }

    /// The tests of the sheet, in the recommended order.
    pub fn tests(&self) -> impl Iterator<Item = &'static Test> + use<> {
        let is_daily = self.is_daily;
        PROTOCOL.iter().filter(move |test| !is_daily || DAILY_TESTS.contains(&test.name))
    }

    /// Recommended number of strokes of a test.
    pub const fn recommended_strokes(&self, test: &Test) -> usize {
        if self.is_daily { 1 } else { test.repetitions }
    }

    /// The marked test.
    pub fn test(&self) -> &'static Test {
        self.tests().nth(self.mark).unwrap_or(&PROTOCOL[0])
    }

    /// Moves the mark by `by` tests, downwards if positive.
    pub fn move_mark(&mut self, by: isize) {
        self.mark = moved_index(self.mark, by, self.tests().count());
        self.stroke = None;
    }

    /// Marks the test with this name, if the sheet contains it.
    pub(super) fn mark_test(&mut self, name: &str) {
        if let Some(mark) = self.tests().position(|test| test.name == name) {
            (self.mark, self.stroke) = (mark, None);
        }
    }

    /// The strokes of a test, each with its index among all entries.
    pub fn strokes(&self, test: &Test) -> Vec<(usize, &Entry)> {
        let all = self.entries.iter().flat_map(|entries| entries.trials.iter().enumerate());
        all.filter(|(_, entry)| entry.test == test.name).collect()
    }

    /// Number of entered and of recommended strokes, without the tests that are left out.
    pub fn count(&self) -> (usize, usize) {
        let asked = self.tests().filter(|test| !self.is_left_out(test));
        asked.fold((0, 0), |(entered, wanted), test| {
            let times = self.recommended_strokes(test);
            // Extra strokes of one test do not replace strokes of another.
            (entered + self.strokes(test).len().min(times), wanted + times)
        })
    }

    /// Index of the marked stroke among those of the marked test.
    pub fn stroke(&self) -> usize {
        let last = self.strokes(self.test()).len().saturating_sub(1);
        self.stroke.map_or(last, |stroke| stroke.min(last))
    }

    /// The marked stroke, with its index among all entries.
    pub fn marked_stroke(&self) -> Option<(usize, &Entry)> {
        self.strokes(self.test()).into_iter().nth(self.stroke())
    }

    /// Moves the mark among the strokes of the test.
    pub fn move_stroke(&mut self, by: isize) {
        self.stroke = Some(moved_index(self.stroke(), by, self.strokes(self.test()).len()));
    }

    /// Whether the player has left a test out.
    pub fn is_left_out(&self, test: &Test) -> bool {
        self.left_out.contains(&test.name)
    }

    /// Leaves the marked test and its entries out, or includes them again. Returns whether the test is left out now.
    pub fn toggle_left_out(&mut self) -> bool {
        let name = self.test().name;
        self.undo_stack.push(UndoStep::LeaveOut(name));
        self.toggle_test(name)
    }

    /// Leaves a test out or includes it again, without an undo step. Returns whether the test is left out now.
    pub fn toggle_test(&mut self, name: &'static str) -> bool {
        let count = self.left_out.len();
        self.left_out.retain(|one| *one != name);
        let is_out = self.left_out.len() == count;
        if is_out {
            self.left_out.push(name);
        }
        is_out
    }

    /// The calibration that results from the marks, if there are any.
    pub fn calibration(&self) -> Option<&Calibration> {
        self.judged.as_ref()?.found.as_ref()
    }

    /// Expected information gain of one more stroke of a test, bits.
    pub fn expected_information(&self, test: &Test) -> Option<f64> {
        let next = &self.judged.as_ref()?.next;
        next.iter().find(|next| next.test == test.name).map(|next| next.bits)
    }

    /// The test whose next stroke gives the most information, among those that are not left out.
    pub fn best_next_test(&self) -> Option<&NextTest> {
        let is_wanted = |next: &&NextTest| {
            self.tests().any(|test| test.name == next.test && !self.is_left_out(test))
                && (!self.is_daily || self.missing(next.test) > 0)
        };
        self.judged.as_ref()?.next.iter().find(is_wanted)
    }

    /// Number of strokes of a test that are still missing.
    fn missing(&self, name: &str) -> usize {
        Test::named(name).map_or(0, |test| self.recommended_strokes(test).saturating_sub(self.strokes(test).len()))
    }

    /// Marks the test whose next stroke gives the most information. Returns `false` if none is known.
    pub fn mark_best(&mut self) -> bool {
        let Some(best) = self.best_next_test().map(|next| next.test) else { return false };
        self.mark_test(best);
        true
    }

    /// Replaces the entries, and adds the undo step of the change if there was one. If a stroke was added and its test is complete,
    /// marks the next incomplete test.
    pub fn set_entries(&mut self, entries: Entries, back: Option<(Edit, bool)>) {
        let is_added = matches!(&back, Some((Edit::Remove(..), false)));
        self.entries = Some(entries);
        self.trouble = None;
        self.stroke = None;
        match back {
            Some((back, false)) => self.undo_stack.push(UndoStep::Edit(back)),
            // The disk has the undo steps in their order.
            Some((_, true)) if !self.unsaved_undo.is_empty() => drop(self.unsaved_undo.remove(0)),
            _ => {}
        }
        if is_added && self.missing(self.test().name) == 0 {
            let later = self.tests().skip(self.mark + 1).chain(self.tests());
            let open = later.into_iter().find(|test| self.missing(test.name) > 0 && !self.is_left_out(test));
            if let Some(test) = open {
                self.mark_test(test.name);
            }
        }
    }

    /// Takes back the undo steps that could not be saved.
    pub fn on_undo_refused(&mut self) {
        let refused = std::mem::take(&mut self.unsaved_undo);
        self.undo_stack.extend(refused.into_iter().rev().map(UndoStep::Edit));
    }

    /// The implausible values among the entries, without the tests that are left out. They can occur in a file that was edited by hand.
    pub fn implausible_entries(&self, table: &Table) -> Vec<EntryProblem> {
        let mut odd = self.entries.as_ref().map_or_else(Vec::new, |entries| entries.trials(table).1);
        odd.retain(|odd| !self.left_out.contains(&odd.test.as_str()));
        odd
    }

    /// The prior for the evaluation: the assumed table and its uncertainty before the tests.
    pub fn prior_table(&self, table: &Table) -> (Table, TableDoubt) {
        if self.is_daily {
            let doubt = table.doubt.clone().unwrap_or_default();
            return (table.clone(), next_day_doubt(table, &doubt));
        }
        // What these strokes have told of the table would count twice.
        let base = table.doubt.as_ref().map_or_else(|| table.clone(), |doubt| before_calibration(table, doubt));
        let base = Table { doubt: None, ..base };
        let doubt = prior(&base);
        (base, doubt)
    }

    /// Creates a request to evaluate the entries for `table`; `None` if no entries have been read.
    pub fn request_evaluation(&mut self, table: &Table) -> Option<EvaluationTask> {
        let (base, doubt) = self.prior_table(table);
        let (mut trials, _) = self.entries.as_ref()?.trials(&base);
        trials.retain(|(_, trial)| !self.is_left_out(trial.test));
        self.asked += 1;
        let (name, is_daily) = (self.name(table), self.is_daily);
        Some(EvaluationTask { number: self.asked, name, table: base, doubt, trials, is_daily })
    }

    /// The name of the table: that in the entries, that of a calibrated table, or the default name.
    pub fn name(&self, table: &Table) -> String {
        let own = table.doubt.is_some().then_some(&table.name);
        let named = self.entries.as_ref().and_then(|entries| entries.name.as_ref());
        named.or(own).map_or(UNNAMED, String::as_str).to_owned()
    }

    /// Handles the answer to request `number`. Late answers to earlier requests are dropped.
    pub fn on_evaluated(&mut self, number: u64, judged: Result<Box<Evaluation>, String>) {
        if number != self.asked {
            return;
        }
        self.answered = number;
        (self.judged, self.evaluation_error) = match judged {
            Ok(judged) => (Some(judged), None),
            Err(sentence) => (self.judged.take(), Some(sentence)),
        };
    }

    /// Names the stroke with the number `trial` among all entries, by its number among those of its test.
    pub fn stroke_name(&self, trial: usize, test: &str) -> String {
        let strokes = Test::named(test).map_or_else(Vec::new, |test| self.strokes(test));
        let number = strokes.iter().position(|(place, _)| place + 1 == trial).map_or(trial, |place| place + 1);
        format!("stroke {number} of {test}")
    }

    /// Explains why the stroke that was entered last looks wrong; `None` if it does not.
    pub fn doubt_about_last_stroke(&self) -> Option<String> {
        let (found, last) = (self.calibration()?, self.entries.as_ref()?.trials.len());
        let misread = found.mark_checks.iter().find(|check| check.misread && check.trial == last);
        let misread = misread.map(|check| check.misread_text(&self.stroke_name(last, check.test)));
        let outlier = found.outlier_strokes.iter().find(|stroke| stroke.trial == last);
        misread.or_else(|| outlier.map(|stroke| stroke.words(&self.stroke_name(last, stroke.test))))
    }

    /// Whether an evaluation is pending.
    pub const fn is_evaluating(&self) -> bool {
        self.asked != self.answered
    }
}

/// Returns a calibrated table with the constants of `match` in place of those that its calibration has estimated.
fn before_calibration(table: &Table, doubt: &TableDoubt) -> Table {
    let usual = Table::default();
    let mut base = Table { name: usual.name.clone(), ..table.clone() };
    for name in doubt.deviations.keys() {
        if let Some(value) = TableDoubt::value(&usual, name) {
            base = TableDoubt::with_value(&base, name, value);
        }
    }
    // The calibration finds rails that differ from the others; before it, none does.
    let Rails { left, right, bottom, top, .. } = usual.rail;
    Table { rail: Rails { left, right, bottom, top, ..base.rail }, ..base }
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
    fn strokes_of_a_calibrated_table_do_not_count_twice() {
        let (base, doubt) = sheet(false).prior_table(&calibrated());
        assert_eq!(base.name, "match");
        assert!(!doubt.is_certain() && doubt == prior(&base));
        let textbook = Table::preset("textbook").unwrap();
        assert_eq!(sheet(false).prior_table(&textbook).0, textbook);
        let small = Table { length: 2.54, width: 1.27, ..calibrated() };
        let (base, _) = sheet(false).prior_table(&small);
        assert_eq!((base.length, base.rolling_friction), (2.54, Table::default().rolling_friction));
        let own_balls = Table { ball_mass: 0.205, ..calibrated() };
        assert_eq!(sheet(false).prior_table(&own_balls).0, Table { ball_mass: 0.205, ..Table::default() });
        let (today, doubt) = sheet(true).prior_table(&calibrated());
        assert_eq!(today, calibrated());
        assert!(doubt.deviations["mu_r"] > calibrated().doubt.unwrap().deviations["mu_r"], "a day later");
    }

    #[test]
    fn completed_test_moves_the_mark_to_the_next_incomplete() {
        let mut sheet = sheet(false);
        let entry = Entry { test: "slow-roll".into(), ..Entry::default() };
        let add = |sheet: &mut Sheet, count: usize| {
            let entries = Entries { name: None, trials: vec![entry.clone(); count] };
            sheet.set_entries(entries, Some((Edit::Remove(count - 1, entry.clone()), false)));
        };
        sheet.set_entries(Entries::default(), None);
        assert!(sheet.undo_stack.is_empty());
        add(&mut sheet, 1);
        assert_eq!((sheet.test().name, sheet.stroke()), ("slow-roll", 0));
        sheet.move_mark(1);
        assert!(sheet.toggle_left_out());
        sheet.move_mark(-1);
        add(&mut sheet, 2);
        assert_eq!(sheet.test().name, "lag", "slow-back is left out");
        assert_eq!(sheet.count(), (2, 19));
        assert_eq!(sheet.undo_stack.pop(), Some(UndoStep::Edit(Edit::Remove(1, entry.clone()))));
        assert_eq!(sheet.undo_stack.pop(), Some(UndoStep::LeaveOut("slow-back")));
        // The disk refuses two undo steps, of which the latest was taken first.
        let step = |number: usize| Edit::Remove(number, entry.clone());
        sheet.undo_stack.clear();
        sheet.unsaved_undo = vec![step(2), step(1)];
        sheet.on_undo_refused();
        assert_eq!(sheet.undo_stack, [1, 2].map(|number| UndoStep::Edit(step(number))));
    }

    #[test]
    fn late_answer_to_earlier_request_is_dropped() {
        let mut sheet = sheet(false);
        sheet.set_entries(Entries::default(), None);
        let first = sheet.request_evaluation(&Table::default()).unwrap().number;
        let second = sheet.request_evaluation(&Table::default()).unwrap().number;
        sheet.on_evaluated(first, Err("late".into()));
        assert!(sheet.is_evaluating() && sheet.evaluation_error.is_none());
        sheet.on_evaluated(second, Err("now".into()));
        assert_eq!((sheet.is_evaluating(), sheet.evaluation_error.as_deref()), (false, Some("now")));
    }
}
