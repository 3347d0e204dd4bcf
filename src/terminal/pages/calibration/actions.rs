//! Implementation of the calibration page's key actions, and their conditions.

use crate::{
    calibration::{Calibration, Edit, Entries},
    table::PRESETS,
    terminal::{
        CalibrationAction as Action, CalibrationCondition as Condition, CalibrationTask, Effect,
        pages::{
            Page,
            calibration::{CalibrationPage, Question, SidePanel, form::Form, sheet::UndoStep},
        },
        ui::{Message, TextField},
    },
};

/// End of the suggested name for a table of a daily check.
const TODAY: &str = " today";

/// Maximum length of a table's name, bytes.
const MAX_TEXT_LENGTH: usize = 60;

impl CalibrationPage {
    /// Returns the reason why a key binding is disabled now; `None` if it is enabled.
    pub fn disabled_reason(&self, when: Condition) -> Option<&'static str> {
        let sheet = self.sheet();
        let (can, reason) = match when {
            Condition::Always => (true, ""),
            Condition::Readable => (
                sheet.trouble.is_none(),
                "the file of entries cannot be read: repair it, or N moves it aside and starts again",
            ),
            Condition::HasStroke => (sheet.marked_stroke().is_some(), "no stroke of this test is entered yet"),
            Condition::HasEntries => {
                let is_entered = sheet.entries.as_ref().is_some_and(|entries| !entries.trials.is_empty());
                (is_entered || sheet.trouble.is_some(), "nothing is entered yet")
            }
            Condition::Undoable => {
                (!sheet.undo_stack.is_empty(), "nothing to undo yet; Delete removes the marked stroke")
            }
            Condition::HasResult if sheet.is_evaluating() => (false, "the values are being computed; one moment"),
            Condition::HasResult if sheet.evaluation_error.is_some() => {
                (false, "no table follows from these entries (see values): edit or delete one first")
            }
            Condition::HasResult if !sheet.implausible_entries(&self.table).is_empty() => {
                (false, "an entry looks wrong (see values): edit or delete it first")
            }
            Condition::HasResult if sheet.calibration().is_some_and(Calibration::is_contradictory) => {
                (false, "strokes contradict each other (see values): play them again, edit or delete them first")
            }
            Condition::HasResult => {
                (sheet.calibration().is_some(), "nothing is entered yet that a table could follow from")
            }
            Condition::HasSavedTable => {
                (sheet.saved.is_some(), "save the table first (s), or choose a saved one by name in F5")
            }
            Condition::CalibratedTable => {
                (self.table.doubt.is_some(), "a daily check needs a calibrated table: save one and play on it")
            }
        };
        (!can).then_some(reason)
    }

    /// Performs the action of an enabled key binding.
    pub fn update(&mut self, action: Action) -> Option<Effect> {
        match action {
            Action::Back => self.is_closed = true,
            Action::MoveMark(lines) => self.sheet_mut().move_mark(lines),
            Action::Page(pages) if self.side == SidePanel::Values => self.values_page += pages,
            Action::Page(pages) => self.sheet_mut().move_mark(10 * pages),
            Action::MarkBest => self.mark_best(),
            Action::ToggleLeftOut => {
                let is_out = self.sheet_mut().toggle_left_out();
                return Some(self.report_left_out(self.sheet().test().name, is_out));
            }
            Action::MarkStroke(by) => self.sheet_mut().move_stroke(by),
            Action::EnterStroke => self.open_form(Form::new(self.sheet().test())),
            Action::EditStroke => {
                let sheet = self.sheet();
                let (place, entry) = sheet.marked_stroke()?;
                self.open_form(Form::of(sheet.test(), place, entry));
            }
            Action::DeleteStroke => {
                let (place, entry) = self.sheet().marked_stroke()?;
                let edit = Edit::Remove(place, entry.clone());
                self.message = Some(Message::plain(format!("a stroke of {} is deleted; u undoes it", entry.test)));
                return Some(self.edit(edit, false));
            }
            Action::Undo => {
                let edit = match self.sheet_mut().undo_stack.pop()? {
                    UndoStep::Edit(edit) => edit,
                    UndoStep::LeaveOut(test) => {
                        let is_out = self.sheet_mut().toggle_test(test);
                        return Some(self.report_left_out(test, is_out));
                    }
                };
                let text = match &edit {
                    Edit::Remove(_, entry) => format!("the stroke of {} is deleted again", entry.test),
                    Edit::Add(entry) | Edit::Insert(_, entry) => format!("the stroke of {} is back", entry.test),
                    Edit::Replace(.., entry) => format!("the stroke of {} is as it was before", entry.test),
                    Edit::ReplaceAll(_) => "what was entered before is back".to_owned(),
                };
                self.message = Some(Message::plain(text));
                self.sheet_mut().unsaved_undo.push(edit.clone());
                return Some(self.edit(edit, true));
            }
            Action::ToggleValues => {
                self.side = if self.side == SidePanel::Test { SidePanel::Values } else { SidePanel::Test };
                self.values_page = 0;
            }
            Action::ToggleDaily => {
                self.is_daily = !self.is_daily;
                return Some(Effect::Calibrate(vec![CalibrationTask::Read(self.sheet().path.clone())]));
            }
            Action::SaveTable => {
                // A table that was saved before keeps its name.
                let saved = self.sheet().saved.as_ref().and_then(|path| path.file_stem());
                let name = saved.map_or_else(
                    || {
                        let name = self.sheet().name(&self.table);
                        if self.is_daily { name.trim_end_matches(TODAY).to_owned() + TODAY } else { name }
                    },
                    |name| name.to_string_lossy().into_owned(),
                );
                self.question = Some(Question::Name(TextField::new(MAX_TEXT_LENGTH).with_suggestion(&name)));
            }
            Action::UseTable => self.table_to_use = self.sheet().saved.clone(),
            Action::StartOver => self.question = Some(Question::StartOver),
            Action::MoveField(_) | Action::ToggleTape | Action::ToggleFarEnd => self.change_form(action),
            Action::Answer(false) => self.close_question(),
            Action::Answer(true) => return self.accept_answer(),
        }
        None
    }

    fn change_form(&mut self, action: Action) {
        let Some(Question::Marks(form)) = &mut self.question else { return };
        match action {
            Action::MoveField(by) => form.step(by),
            Action::ToggleFarEnd => form.far_end = !form.far_end,
            _ => {
                if let Err(sentence) = form.toggle_tape() {
                    self.message = Some(Message::warning(sentence));
                }
            }
        }
    }

    /// Reports that a test is left out or included again, and requests a new evaluation of the entries.
    fn report_left_out(&mut self, test: &str, is_out: bool) -> Effect {
        let text = if is_out {
            format!("{test} is left out, with what is entered of it, until the program ends")
        } else {
            format!("{test} counts again")
        };
        self.message = Some(Message::plain(text));
        Effect::Calibrate(self.request_evaluation())
    }

    fn mark_best(&mut self) {
        self.message = Some(if self.sheet_mut().mark_best() {
            let test = self.sheet().test().name;
            Message::plain(format!("next: {test} helps most"))
        } else {
            Message::plain("nothing more is asked for")
        });
    }

    fn accept_answer(&mut self) -> Option<Effect> {
        match self.question.take()? {
            Question::Marks(form) => self.keep(form),
            Question::Name(typed) => self.save(typed.text().trim(), false),
            Question::Replace(name) => self.save(&name, true),
            Question::StartOver if self.sheet().trouble.is_some() => {
                let text = format!("the file that cannot be read is kept as {}", self.backup_file().display());
                self.message = Some(Message::plain(text));
                Some(Effect::Calibrate(vec![CalibrationTask::BackUpUnreadable(self.sheet().path.clone())]))
            }
            Question::StartOver => {
                let count = self.sheet().entries.as_ref().map_or(0, |entries| entries.trials.len());
                let strokes = if count == 1 { "1 stroke is".to_owned() } else { format!("{count} strokes are") };
                let text = format!("{strokes} kept as {}; u undoes this", self.backup_file().display());
                self.message = Some(Message::plain(text));
                Some(self.edit(Edit::ReplaceAll(Entries::default()), false))
            }
        }
    }

    /// Moves to the next mark of the form, or saves the stroke after the last one. An implausible value stays for a correction.
    fn keep(&mut self, mut form: Form) -> Option<Effect> {
        let mut edit = None;
        let odd = form.field_problem(&self.table).filter(|_| !form.is_sent);
        if let Some(what) = odd {
            self.message = Some(Message::warning(format!("{}: {what}", form.test.name)));
        } else if !form.is_sent && !form.is_at_the_end() {
            form.step(1);
        } else if !form.is_sent {
            match form.entry(&self.table) {
                Ok(entry) => {
                    form.is_sent = true;
                    edit = Some(match &form.amends {
                        Some((place, before)) => Edit::Replace(*place, before.clone(), entry),
                        None => Edit::Add(entry),
                    });
                }
                Err(what) => {
                    let text = format!("{}: {what}; nothing is saved yet", form.test.name);
                    self.message = Some(Message::warning(text));
                }
            }
        }
        self.question = Some(Question::Marks(form));
        edit.map(|edit| self.edit(edit, false))
    }

    /// Saves the calibrated table under a name.
    fn save(&mut self, name: &str, replaces: bool) -> Option<Effect> {
        let found = self.sheet().calibration()?;
        let is_plain = |letter: char| letter.is_alphanumeric() || matches!(letter, ' ' | '-' | '_');
        let refused = if PRESETS.contains(&name) {
            Some("is the name of a bundled table; take another")
        } else if name.is_empty() || !name.chars().all(is_plain) {
            Some("is not a table name; use letters, digits, blanks, - and _")
        } else {
            None
        };
        if let Some(reason) = refused {
            self.question = Some(Question::Name(TextField::new(MAX_TEXT_LENGTH).with(name)));
            return self.refuse(format!("\"{name}\" {reason}"));
        }
        let mut table = found.table.clone();
        name.clone_into(&mut table.name);
        let path = self.places.tables.join(format!("{name}.toml"));
        Some(Effect::Calibrate(vec![CalibrationTask::Save(path, Box::new(table), replaces)]))
    }

    fn edit(&self, edit: Edit, is_back: bool) -> Effect {
        Effect::Calibrate(vec![CalibrationTask::Edit(self.sheet().path.clone(), edit, is_back)])
    }
}
