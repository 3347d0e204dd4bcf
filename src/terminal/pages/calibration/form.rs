//! The form of a stroke: a field for each mark, and what is understood of it.

use crate::{
    calibration::{Entry, MarkValue, RAILS, TAPE_ERROR_TEXT, Test, Unit},
    table::Table,
    terminal::{StrokeDraft, pages::around, ui::TextField},
};

/// Longest mark, bytes.
const LONGEST: usize = 40;

/// A stroke that is entered.
#[derive(Clone, Debug, PartialEq)]
pub struct Form {
    /// Its test.
    pub test: &'static Test,
    /// The marks' names, each with what is typed.
    pub fields: Vec<(&'static str, TextField)>,
    /// The field that is typed into.
    pub field: usize,
    /// The stroke that is changed, with its place among all entries.
    pub amends: Option<(usize, Entry)>,
    /// Whether it was played from the far end.
    pub far_end: bool,
    /// Whether it is on its way to the disk.
    pub is_sent: bool,
}

impl Form {
    /// An empty one.
    pub fn new(test: &'static Test) -> Self {
        let fields = test.field_names().map(|name| (name, TextField::new(LONGEST))).collect();
        Self { test, fields, field: 0, amends: None, far_end: false, is_sent: false }
    }

    /// That of a stroke that was entered.
    pub fn of(test: &'static Test, place: usize, entry: &Entry) -> Self {
        let mut form = Self::new(test);
        for (name, field) in &mut form.fields {
            *field = TextField::new(LONGEST).with(&entry.field_text(name));
        }
        Self { amends: Some((place, entry.clone())), far_end: entry.far_end, ..form }
    }

    /// What the next session is to go on with.
    pub fn draft(&self, is_daily: bool) -> StrokeDraft {
        StrokeDraft {
            test: self.test.name.to_owned(),
            typed: self.fields.iter().map(|(_, field)| field.text().to_owned()).collect(),
            field: self.field,
            far_end: self.far_end,
            amends: self.amends.clone(),
            is_daily,
            is_told: false,
        }
    }

    /// The form as it was; `None` where its test is not known here.
    pub fn from_draft(draft: StrokeDraft) -> Option<Self> {
        let StrokeDraft { test, typed, field, far_end, amends, .. } = draft;
        let mut form = Self { amends, far_end, ..Self::new(Test::named(&test)?) };
        for ((_, field), typed) in form.fields.iter_mut().zip(&typed) {
            *field = TextField::new(LONGEST).with(typed);
        }
        form.field = field.min(form.fields.len().saturating_sub(1));
        Some(form)
    }

    /// Goes to another field, around the ends.
    pub fn step(&mut self, by: isize) {
        self.field = around(self.field, by, self.fields.len());
    }

    /// Whether something is typed that is not kept yet.
    pub fn is_begun(&self) -> bool {
        let before = self
            .amends
            .as_ref()
            .map_or_else(|| Self::new(self.test), |(place, entry)| Self::of(self.test, *place, entry));
        self.far_end != before.far_end
            || self.fields.iter().zip(&before.fields).any(|((_, typed), (_, known))| typed.text() != known.text())
    }

    /// Whether the last field is typed into.
    pub fn is_at_the_end(&self) -> bool {
        self.field + 1 == self.fields.len()
    }

    /// The field that is typed into.
    pub fn typed(&self) -> &TextField {
        &self.fields[self.field].1
    }

    /// The stroke as it is typed.
    ///
    /// # Errors
    /// What is odd about it, each with what would be accepted.
    pub fn entry(&self, table: &Table) -> Result<Entry, String> {
        let mut entry = Entry { test: self.test.name.to_owned(), far_end: self.far_end, ..Entry::default() };
        for (name, field) in &self.fields {
            entry.set_field(name, field.text())?;
        }
        let (_, odd) = entry.readings(table);
        if odd.is_empty() { Ok(entry) } else { Err(odd.join("; ")) }
    }

    /// What is odd about the field that is typed into, whatever the others say.
    pub fn oddity(&self, table: &Table) -> Option<String> {
        let (name, field) = &self.fields[self.field];
        let mut entry = Entry { test: self.test.name.to_owned(), ..Entry::default() };
        if let Err(sentence) = entry.set_field(name, field.text()) {
            return Some(sentence);
        }
        if entry.marks.is_empty() {
            return None;
        }
        // How many rails it were is asked for later.
        entry.rails = Some(self.test.rails.unwrap_or(1));
        let (_, odd) = entry.readings(table);
        odd.into_iter().next()
    }

    /// Says of the place that is typed that it was measured with a tape, or takes that back.
    ///
    /// # Errors
    /// A sentence where that means nothing.
    pub fn turn_tape(&mut self) -> Result<(), String> {
        let (name, field) = &mut self.fields[self.field];
        let is_place = self.test.marks.iter().any(|mark| mark.name == *name && mark.unit() == Unit::Diamonds);
        if !is_place {
            return Err(format!("a tape measures places, and {name} is none"));
        }
        let value = field.text().split(['±', '~']).next().unwrap_or_default().trim().to_owned();
        if value.is_empty() {
            return Err(format!("type the place first: nothing is typed of {name} yet"));
        }
        let was_taped = field.text().ends_with(TAPE_ERROR_TEXT);
        let text = if was_taped { value } else { format!("{value} ~ {TAPE_ERROR_TEXT}") };
        *field = TextField::new(LONGEST).with(&text);
        Ok(())
    }

    /// What is asked for in the field: its words, and how sure it counts as now.
    pub fn question(&self, table: &Table) -> String {
        let (name, field) = &self.fields[self.field];
        if *name == RAILS {
            let usual = self.test.rails.map_or_else(String::new, |rails| format!(", if not {rails}"));
            return format!("{name}: how many short rails the ball has met{usual} = ");
        }
        let Some(mark) = self.test.marks.iter().find(|mark| mark.name == *name) else { return String::new() };
        let how = self.sure(table).unwrap_or_else(|| match mark.unit() {
            Unit::Diamonds => "diamonds by eye, 725 mm by tape".to_owned(),
            Unit::Seconds => "seconds".to_owned(),
        });
        let empty = if field.text().is_empty() { "; empty if not known" } else { "" };
        format!("{name}: {} ({how}{empty}) = ", mark.words)
    }

    /// How the mark that is typed is understood, with how sure it counts as; nothing where it is odd or not typed yet.
    fn sure(&self, table: &Table) -> Option<String> {
        let (name, field) = &self.fields[self.field];
        let mut entry = Entry { test: self.test.name.to_owned(), rails: Some(0), ..Entry::default() };
        entry.set_field(name, field.text()).ok()?;
        let (readings, _) = entry.readings(table);
        let reading = readings.first()?;
        let is_own =
            entry.standard_errors.get(*name).is_some_and(|sure| *sure != MarkValue::Text(TAPE_ERROR_TEXT.to_owned()));
        Some(match self.test.marks[reading.mark].unit() {
            Unit::Seconds => format!("right to {} s", rounded(reading.standard_error)),
            Unit::Diamonds if is_own => format!("right to {} diamonds", rounded(reading.standard_error)),
            Unit::Diamonds if reading.standard_error < 0.02 => "by tape, right to 5 mm".to_owned(),
            Unit::Diamonds => format!("by eye, right to {} diamonds", rounded(reading.standard_error)),
        })
    }
}

/// A standard error in few digits.
fn rounded(sure: f64) -> f64 {
    (1000.0 * sure).round() / 1000.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn form(test: &str, typed: &[&str]) -> Form {
        let mut form = Form::new(Test::named(test).unwrap());
        for ((_, field), typed) in form.fields.iter_mut().zip(typed) {
            *field = TextField::new(LONGEST).with(typed);
        }
        form
    }

    #[test]
    fn what_is_typed_becomes_a_stroke_and_the_form_of_it_is_the_same() {
        let table = Table::default();
        let typed = ["9.6", "5.4 ~ 0.2", "725 mm", ""];
        let entry = form("slow-roll", &typed).entry(&table).unwrap();
        let again = Form::of(Test::named("slow-roll").unwrap(), 3, &entry);
        assert!(again.fields.iter().map(|(_, field)| field.text()).eq(typed));
        assert_eq!(again.entry(&table).unwrap(), entry);
        let unsaid = form("hard-lag", &["2.6", "3"]).entry(&table).unwrap_err();
        assert!(unsaid.contains("add rails = 5"), "{unsaid}");
    }

    #[test]
    fn how_sure_a_mark_is_can_be_seen_and_a_tape_be_said() {
        let table = Table::default();
        let mut form = form("slow-roll", &["9.6", "5.4"]);
        assert!(form.question(&table).contains("right to 0.2 s"), "{}", form.question(&table));
        assert_eq!(form.turn_tape().unwrap_err(), "a tape measures places, and time is none");
        form.step(1);
        assert!(form.question(&table).contains("by eye, right to 0.1 diamonds"), "{}", form.question(&table));
        form.turn_tape().unwrap();
        assert!(form.question(&table).contains("by tape, right to 5 mm"), "{}", form.question(&table));
        assert!(form.entry(&table).unwrap().readings(&table).0[1].standard_error < 0.02);
        form.turn_tape().unwrap();
        assert_eq!(form.typed().text(), "5.4");
        form.step(-2);
        assert!(form.is_at_the_end() && form.question(&table).contains("short rails"));
    }
}
