//! The form for entering a stroke: one field for each mark, and the interpretation of the typed values.

use crate::{
    calibration::{Entry, MarkValue, RAILS, TAPE_ERROR_TEXT, Test, Unit},
    table::Table,
    terminal::{StrokeDraft, pages::wrapping_index, ui::TextField},
};

/// Maximum length of a typed mark, bytes.
const MAX_TEXT_LENGTH: usize = 40;

/// The form for entering or editing a stroke.
#[derive(Clone, Debug, PartialEq)]
pub struct Form {
    /// The test of the stroke.
    pub test: &'static Test,
    /// The names of the marks, each with its text field.
    pub fields: Vec<(&'static str, TextField)>,
    /// Index of the active field.
    pub field: usize,
    /// The stroke that is being edited, with its index among all entries; `None` for a new stroke.
    pub amends: Option<(usize, Entry)>,
    /// Whether the stroke was played from the far end.
    pub far_end: bool,
    /// Whether the stroke is being written to disk.
    pub is_sent: bool,
}

impl Form {
    /// Creates an empty form.
    pub fn new(test: &'static Test) -> Self {
        let fields = test.field_names().map(|name| (name, TextField::new(MAX_TEXT_LENGTH))).collect();
        Self { test, fields, field: 0, amends: None, far_end: false, is_sent: false }
    }

    /// Creates the form for editing a stroke that has been entered; `place` is its index among all entries.
    pub fn of(test: &'static Test, place: usize, entry: &Entry) -> Self {
        let mut form = Self::new(test);
        for (name, field) in &mut form.fields {
            *field = TextField::new(MAX_TEXT_LENGTH).with(&entry.field_text(name));
        }
        Self { amends: Some((place, entry.clone())), far_end: entry.far_end, ..form }
    }

    /// Converts the form to a draft, which a later session can continue.
    pub fn draft(&self, is_daily: bool) -> StrokeDraft {
        StrokeDraft {
            test: self.test.name.to_owned(),
            typed: self.fields.iter().map(|(_, field)| field.text().to_owned()).collect(),
            field: self.field,
            far_end: self.far_end,
            amends: self.amends.clone(),
            is_daily,
            is_announced: false,
        }
    }

    /// Restores the form from a draft; `None` if its test does not exist in this version.
    pub fn from_draft(draft: StrokeDraft) -> Option<Self> {
        let StrokeDraft { test, typed, field, far_end, amends, .. } = draft;
        let mut form = Self { amends, far_end, ..Self::new(Test::named(&test)?) };
        for ((_, field), typed) in form.fields.iter_mut().zip(&typed) {
            *field = TextField::new(MAX_TEXT_LENGTH).with(typed);
        }
        form.field = field.min(form.fields.len().saturating_sub(1));
        Some(form)
    }

    /// Moves to another field, with wrap-around.
    pub fn step(&mut self, by: isize) {
        self.field = wrapping_index(self.field, by, self.fields.len());
    }

    /// Whether the form contains unsaved changes.
    pub fn is_begun(&self) -> bool {
        let before = self
            .amends
            .as_ref()
            .map_or_else(|| Self::new(self.test), |(place, entry)| Self::of(self.test, *place, entry));
        self.far_end != before.far_end
            || self.fields.iter().zip(&before.fields).any(|((_, typed), (_, known))| typed.text() != known.text())
    }

    /// Whether the last field is active.
    pub fn is_at_the_end(&self) -> bool {
        self.field + 1 == self.fields.len()
    }

    /// The active field.
    pub fn typed(&self) -> &TextField {
        &self.fields[self.field].1
    }

    /// Parses the typed stroke.
    ///
    /// # Errors
    /// Returns a message with all implausible values and what would be accepted.
    pub fn entry(&self, table: &Table) -> Result<Entry, String> {
        let mut entry = Entry { test: self.test.name.to_owned(), far_end: self.far_end, ..Entry::default() };
        for (name, field) in &self.fields {
            entry.set_field(name, field.text())?;
        }
        let (_, odd) = entry.readings(table);
        if odd.is_empty() { Ok(entry) } else { Err(odd.join("; ")) }
    }

    /// The problem with the value in the active field alone; `None` if it is plausible or empty.
    pub fn field_problem(&self, table: &Table) -> Option<String> {
        let (name, field) = &self.fields[self.field];
        let mut entry = Entry { test: self.test.name.to_owned(), ..Entry::default() };
        if let Err(sentence) = entry.set_field(name, field.text()) {
            return Some(sentence);
        }
        if entry.marks.is_empty() {
            return None;
        }
        // The number of rails has its own field later, so assume one here.
        entry.rails = Some(self.test.rails.unwrap_or(1));
        let (_, odd) = entry.readings(table);
        odd.into_iter().next()
    }

    /// Turns the note on or off that the typed position was measured with a tape.
    ///
    /// # Errors
    /// Returns a message if the active field is not a position, or is empty.
    pub fn toggle_tape(&mut self) -> Result<(), String> {
        let (name, field) = &mut self.fields[self.field];
        let is_place = self.test.marks.iter().any(|mark| mark.name == *name && mark.unit() == Unit::Diamonds);
        if !is_place {
            return Err(format!("a tape measures positions, and {name} is not one"));
        }
        let value = field.text().split(['±', '~']).next().unwrap_or_default().trim().to_owned();
        if value.is_empty() {
            return Err(format!("type the position first: {name} is empty"));
        }
        let was_taped = field.text().ends_with(TAPE_ERROR_TEXT);
        let text = if was_taped { value } else { format!("{value} ~ {TAPE_ERROR_TEXT}") };
        *field = TextField::new(MAX_TEXT_LENGTH).with(&text);
        Ok(())
    }

    /// The question for the active field: its description, and the assumed accuracy of the value.
    pub fn question(&self, table: &Table) -> String {
        let (name, field) = &self.fields[self.field];
        if *name == RAILS {
            let usual = self.test.rails.map_or_else(String::new, |rails| format!(", if not {rails}"));
            return format!("{name}: how many short rails the ball has met{usual} = ");
        }
        let Some(mark) = self.test.marks.iter().find(|mark| mark.name == *name) else { return String::new() };
        let how = self.accuracy_words(table).unwrap_or_else(|| match mark.unit() {
            Unit::Diamonds => "diamonds by eye, 725 mm by tape".to_owned(),
            Unit::Seconds => "seconds".to_owned(),
        });
        let empty = if field.text().is_empty() { "; empty if not known" } else { "" };
        format!("{name}: {} ({how}{empty}) = ", mark.words)
    }

    /// The assumed accuracy of the typed mark in words; `None` if the value is implausible or not typed yet.
    fn accuracy_words(&self, table: &Table) -> Option<String> {
        let (name, field) = &self.fields[self.field];
        let mut entry = Entry { test: self.test.name.to_owned(), rails: Some(0), ..Entry::default() };
        entry.set_field(name, field.text()).ok()?;
        let (readings, _) = entry.readings(table);
        let reading = readings.first()?;
        let is_own = entry
            .standard_errors
            .get(*name)
            .is_some_and(|standard_error| *standard_error != MarkValue::Text(TAPE_ERROR_TEXT.to_owned()));
        Some(match self.test.marks[reading.mark].unit() {
            Unit::Seconds => format!("right to {} s", rounded(reading.standard_error)),
            Unit::Diamonds if is_own => format!("right to {} diamonds", rounded(reading.standard_error)),
            Unit::Diamonds if reading.standard_error < 0.02 => "by tape, right to 5 mm".to_owned(),
            Unit::Diamonds => format!("by eye, right to {} diamonds", rounded(reading.standard_error)),
        })
    }
}

/// Rounds a standard error to three decimals.
fn rounded(standard_error: f64) -> f64 {
    (1000.0 * standard_error).round() / 1000.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn form(test: &str, typed: &[&str]) -> Form {
        let mut form = Form::new(Test::named(test).unwrap());
        for ((_, field), typed) in form.fields.iter_mut().zip(typed) {
            *field = TextField::new(MAX_TEXT_LENGTH).with(typed);
        }
        form
    }

    #[test]
    fn typed_stroke_converts_to_entry_and_back() {
        let table = Table::default();
        let typed = ["9.6", "5.4 ~ 0.2", "725 mm", ""];
        let entry = form("slow-roll", &typed).entry(&table).unwrap();
        let again = Form::of(Test::named("slow-roll").unwrap(), 3, &entry);
        assert!(again.fields.iter().map(|(_, field)| field.text()).eq(typed));
        assert_eq!(again.entry(&table).unwrap(), entry);
        let unsaid = form("hard-lag", &["2.6", "3"]).entry(&table).unwrap_err();
        assert!(unsaid.contains("for example as rails = 5"), "{unsaid}");
    }

    #[test]
    fn question_shows_accuracy_and_tape_can_be_noted() {
        let table = Table::default();
        let mut form = form("slow-roll", &["9.6", "5.4"]);
        assert!(form.question(&table).contains("right to 0.2 s"), "{}", form.question(&table));
        assert_eq!(form.toggle_tape().unwrap_err(), "a tape measures positions, and time is not one");
        form.step(1);
        assert!(form.question(&table).contains("by eye, right to 0.1 diamonds"), "{}", form.question(&table));
        form.toggle_tape().unwrap();
        assert!(form.question(&table).contains("by tape, right to 5 mm"), "{}", form.question(&table));
        assert!(form.entry(&table).unwrap().readings(&table).0[1].standard_error < 0.02);
        form.toggle_tape().unwrap();
        assert_eq!(form.typed().text(), "5.4");
        form.step(-2);
        assert!(form.is_at_the_end() && form.question(&table).contains("short rails"));
    }
}
