//! The calibration page: the tests, the strokes that were entered for them, and the table parameters that result.
//!
//! Background tasks ([`CalibrationTask`]) read and write files and evaluate the entries. Each reports its result as a
//! [`CalibrationReport`]. [`actions`] implements the key actions.

mod actions;
pub mod form;
pub mod keys;
pub mod sheet;
mod view;

use std::path::PathBuf;

use self::{form::Form, sheet::Sheet};
use crate::{
    calibration::latest_backup_path,
    coach::words::Units,
    storage::DataPaths,
    table::Table,
    terminal::{
        CalibrationContext, CalibrationReport, CalibrationTask, Effect, SavedEntries, StrokeDraft,
        pages::Page,
        ui::{Message, TextField},
        words::name_taken_message,
    },
};

/// An open form or question.
#[derive(Clone, Debug, PartialEq)]
pub enum Question {
    /// The marks of a stroke.
    Marks(Form),
    /// The table's name.
    Name(TextField),
    /// Whether to replace the table with this name.
    Replace(String),
    /// Whether to start again without entries.
    StartOver,
}

/// The panel next to the list of tests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SidePanel {
    /// The marked test on the table.
    Test,
    /// The table's values.
    Values,
}

/// The state of the calibration page.
#[derive(Debug)]
pub struct CalibrationPage {
    /// The folders of entries and tables.
    places: DataPaths,
    /// The current table.
    pub table: Table,
    /// The units for displayed values.
    pub units: Units,
    /// The open form or question.
    pub question: Option<Question>,
    /// Drafts of forms that were left incomplete, the latest last.
    drafts: Vec<StrokeDraft>,
    /// The panel next to the list of tests.
    pub side: SidePanel,
    /// Page number in the table's values, from 0; taken modulo the number of pages.
    pub values_page: isize,
    /// The message of the status line.
    pub message: Option<Message>,
    all: Sheet,
    daily: Sheet,
    is_daily: bool,
    /// The file of a table that must become the current one, until the app takes it.
    pub table_to_use: Option<PathBuf>,
    /// Whether the user has left the page.
    pub is_closed: bool,
}

impl CalibrationPage {
    /// Creates the page, closed.
    pub fn new(places: DataPaths) -> Self {
        let all = Sheet::new(places.calibration.clone(), false);
        let daily = Sheet::new(places.daily_check.clone(), true);
        Self {
            places,
            table: Table::default(),
            units: Units::default(),
            question: None,
            drafts: Vec::new(),
            side: SidePanel::Test,
            values_page: 0,
            message: None,
            all,
            daily,
            is_daily: false,
            table_to_use: None,
            is_closed: false,
        }
    }

    /// Opens the page as it was left, for the current `table`. The entries are read again.
    pub fn open(&mut self, table: &Table) -> Effect {
        self.message = None;
        self.is_closed = false;
        self.set_table(table);
        Effect::Calibrate(vec![CalibrationTask::Read(self.sheet().path.clone())])
    }

    /// Sets the current table.
    pub fn set_table(&mut self, table: &Table) {
        self.table.clone_from(table);
        if self.is_daily && table.doubt.is_none() {
            // A daily check needs a calibrated table. An incomplete form is kept.
            self.close_question();
            self.is_daily = false;
        }
    }

    /// Closes the open form or question. An incomplete form is kept as a draft.
    fn close_question(&mut self) {
        self.drafts.extend(self.incomplete_form());
        self.question = None;
    }

    /// The draft of the open form, if that is incomplete.
    fn incomplete_form(&self) -> Option<StrokeDraft> {
        match &self.question {
            Some(Question::Marks(form)) if form.is_begun() && !form.is_sent => Some(form.draft(self.is_daily)),
            _ => None,
        }
    }

    /// The current sheet: that of the full calibration or of the daily check.
    pub const fn sheet(&self) -> &Sheet {
        if self.is_daily { &self.daily } else { &self.all }
    }

    const fn sheet_mut(&mut self) -> &mut Sheet {
        if self.is_daily { &mut self.daily } else { &mut self.all }
    }

    /// The key context.
    pub const fn key_context(&self) -> CalibrationContext {
        if let Some(Question::Marks(_)) = self.question { CalibrationContext::Marks } else { CalibrationContext::Tests }
    }

    /// The latest incomplete form, for the next session.
    pub fn draft(&self) -> Option<StrokeDraft> {
        self.incomplete_form().or_else(|| self.drafts.last().cloned())
    }

    /// Opens `form`, or the draft of the same form if there is one.
    fn open_form(&mut self, form: Form) {
        let is_same = |draft: &StrokeDraft| {
            draft.is_daily == self.is_daily && draft.test == form.test.name && draft.amends == form.amends
        };
        let left = self.drafts.iter().position(is_same).map(|place| self.drafts.remove(place));
        let left = left.and_then(Form::from_draft);
        self.side = SidePanel::Test;
        self.question = Some(Question::Marks(left.unwrap_or(form)));
    }

    /// Restores an incomplete form from the last session. Returns the name of its test, or `None` if that test does not exist.
    pub fn restore_draft(&mut self, draft: StrokeDraft) -> Option<&'static str> {
        let is_daily = draft.is_daily;
        let form = Form::from_draft(draft)?;
        let test = form.test.name;
        self.is_daily = is_daily;
        self.sheet_mut().mark_test(test);
        self.question = Some(Question::Marks(form));
        Some(test)
    }

    /// Requests an evaluation of the entries.
    fn request_evaluation(&mut self) -> Vec<CalibrationTask> {
        let table = self.table.clone();
        self.sheet_mut()
            .request_evaluation(&table)
            .map(|judging| CalibrationTask::Evaluate(Box::new(judging)))
            .into_iter()
            .collect()
    }

    /// Handles the result of a task. Returns follow-up tasks.
    pub fn receive(&mut self, report: CalibrationReport) -> Vec<CalibrationTask> {
        match report {
            CalibrationReport::Entries(path, outcome) if path == self.sheet().path => match outcome {
                Ok(kept) => {
                    let SavedEntries { entries, back } = *kept;
                    if back.is_some() && matches!(self.question, Some(Question::Marks(_))) {
                        self.question = None;
                    }
                    self.sheet_mut().set_entries(entries, back);
                    return self.request_evaluation();
                }
                Err(sentence) => {
                    let sentence = format!("{sentence}; N moves the file aside and starts again");
                    let sheet = self.sheet_mut();
                    (sheet.entries, sheet.trouble) = (None, Some(sentence.clone()));
                    self.message = Some(Message::warning(sentence));
                }
            },
            CalibrationReport::SaveFailed(path, sentence) => {
                if let Some(Question::Marks(form)) = &mut self.question {
                    // A stroke that could not be saved stays in the form.
                    form.is_sent = false;
                }
                let sheets = [&mut self.all, &mut self.daily];
                sheets.into_iter().filter(|sheet| sheet.path == path).for_each(Sheet::on_undo_refused);
                self.message = Some(Message::warning(sentence));
                // Read the file again, because another program may have changed it.
                return vec![CalibrationTask::Read(path)];
            }
            // The other sheet keeps its undo step; it is read and evaluated again when it is shown.
            CalibrationReport::Entries(path, outcome) => {
                let sheet = [&mut self.all, &mut self.daily].into_iter().find(|sheet| sheet.path == path);
                if let (Some(sheet), Ok(kept)) = (sheet, outcome) {
                    sheet.set_entries(kept.entries, kept.back);
                }
            }
            CalibrationReport::Evaluated(is_daily, number, outcome) => {
                let sheet = if is_daily { &mut self.daily } else { &mut self.all };
                sheet.on_evaluated(number, outcome);
            }
            CalibrationReport::Saved(path, Ok(true)) => {
                let name = path.file_stem().unwrap_or_default().to_string_lossy();
                let (played, _) = self.sheet().count();
                let misread = self.sheet().calibration().map_or(0, |found| found.misread().len());
                let misread = if misread == 0 { String::new() } else { format!(", {misread} of them misread") };
                let strokes = if played == 1 { "one stroke".to_owned() } else { format!("{played} strokes{misread}") };
                let text = format!("saved as {name}, from {strokes}; p plays on it from now on");
                self.message = Some(Message::good(text));
                self.sheet_mut().saved = Some(path);
            }
            CalibrationReport::Saved(path, Ok(false)) => {
                let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
                if self.question.is_some() {
                    self.message = Some(Message::warning(name_taken_message(&name)));
                } else {
                    self.question = Some(Question::Replace(name));
                }
            }
            CalibrationReport::Saved(_, Err(sentence)) => self.message = Some(Message::warning(sentence)),
        }
        Vec::new()
    }

    /// The file to which old entries are moved.
    fn backup_file(&self) -> PathBuf {
        latest_backup_path(&self.sheet().path)
    }
}

impl Page for CalibrationPage {
    fn message_mut(&mut self) -> &mut Option<Message> {
        &mut self.message
    }

    fn field_mut(&mut self) -> Option<&mut TextField> {
        match self.question.as_mut()? {
            // A form that is being saved must not change.
            Question::Marks(form) if form.is_sent => None,
            Question::Marks(form) => Some(&mut form.fields[form.field].1),
            Question::Name(field) => Some(field),
            _ => None,
        }
    }
}
