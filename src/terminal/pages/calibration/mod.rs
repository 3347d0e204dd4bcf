//! The state of the calibration's page: the tests, what was entered of them, and the table that follows.
//!
//! Files are read and written, and entries judged, elsewhere ([`CalibrationTask`]); what comes of it is a
//! [`CalibrationReport`]. [`actions`] is what each key does.

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
        CalibrationContext, CalibrationReport, CalibrationTask, Effect, KeptEntries, StrokeDraft,
        pages::Page,
        ui::{Message, TextField},
        words::taken_words,
    },
};

/// What is typed or asked.
#[derive(Clone, Debug, PartialEq)]
pub enum Question {
    /// The marks of a stroke.
    Marks(Form),
    /// The table's name.
    Name(TextField),
    /// Whether the table of this name may be replaced.
    Replace(String),
    /// Whether to begin anew.
    Anew,
}

/// What is shown beside the list of tests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The marked test on the table.
    Test,
    /// The table's values.
    Values,
}

/// The state of the page.
#[derive(Debug)]
pub struct CalibrationPage {
    /// Where entries and tables are.
    places: DataPaths,
    /// The table that is played on.
    pub table: Table,
    /// In which the tip's place and the speed of a stroke are told.
    pub units: Units,
    /// What is typed or asked.
    pub question: Option<Question>,
    /// Strokes whose forms were left when they were typed in part; the last one is the latest.
    aside: Vec<StrokeDraft>,
    /// What is shown beside the list of tests.
    pub side: Side,
    /// The page of the table's values, from 0 on, where they have several; further ones are the first again.
    pub values_page: isize,
    /// What the status line says.
    pub message: Option<Message>,
    all: Sheet,
    daily: Sheet,
    is_daily: bool,
    /// The file of the table that was saved last.
    pub saved: Option<PathBuf>,
    /// The file of a table that is to be played on, until it is taken.
    pub for_use: Option<PathBuf>,
    /// Whether one has gone back.
    pub is_left: bool,
}

impl CalibrationPage {
    /// The page before it is opened.
    pub fn new(places: DataPaths) -> Self {
        let all = Sheet::new(places.calibration.clone(), false);
        let daily = Sheet::new(places.daily_check.clone(), true);
        Self {
            places,
            table: Table::default(),
            units: Units::default(),
            question: None,
            aside: Vec::new(),
            side: Side::Test,
            values_page: 0,
            message: None,
            all,
            daily,
            is_daily: false,
            saved: None,
            for_use: None,
            is_left: false,
        }
    }

    /// Opens it as it was left, for who plays on `table`; the entries are read again.
    pub fn open(&mut self, table: &Table) -> Effect {
        self.message = None;
        self.is_left = false;
        self.play_on(table);
        Effect::Calibrate(vec![CalibrationTask::Read(self.sheet().path.clone())])
    }

    /// The table that is played on from now on.
    pub fn play_on(&mut self, table: &Table) {
        self.table.clone_from(table);
        if self.is_daily && table.doubt.is_none() {
            // A check of the day is of a table that was calibrated; what is typed of a stroke in it waits.
            self.put_aside();
            self.is_daily = false;
        }
    }

    /// Leaves what is typed or asked; a stroke that was typed in part waits.
    fn put_aside(&mut self) {
        self.aside.extend(self.typed_in_part());
        self.question = None;
    }

    /// The open form of a stroke, where that is typed in part.
    fn typed_in_part(&self) -> Option<StrokeDraft> {
        match &self.question {
            Some(Question::Marks(form)) if form.is_begun() && !form.is_sent => Some(form.draft(self.is_daily)),
            _ => None,
        }
    }

    /// What is entered now.
    pub const fn sheet(&self) -> &Sheet {
        if self.is_daily { &self.daily } else { &self.all }
    }

    const fn sheet_mut(&mut self) -> &mut Sheet {
        if self.is_daily { &mut self.daily } else { &mut self.all }
    }

    /// The key context.
    pub const fn place(&self) -> CalibrationContext {
        if let Some(Question::Marks(_)) = self.question { CalibrationContext::Marks } else { CalibrationContext::Tests }
    }

    /// The stroke whose marks are typed in part, which the next session is to go on with.
    pub fn draft(&self) -> Option<StrokeDraft> {
        self.typed_in_part().or_else(|| self.aside.last().cloned())
    }

    /// Opens `form`, as it was left where that was when it was typed in part.
    fn open_form(&mut self, form: Form) {
        let is_same = |draft: &StrokeDraft| {
            draft.is_daily == self.is_daily && draft.test == form.test.name && draft.amends == form.amends
        };
        let left = self.aside.iter().position(is_same).map(|place| self.aside.remove(place));
        let left = left.and_then(Form::from_draft);
        self.side = Side::Test;
        self.question = Some(Question::Marks(left.unwrap_or(form)));
    }

    /// Goes on with a stroke that was typed in part when the last session ended; gives its test, where that is known.
    pub fn go_on_with(&mut self, draft: StrokeDraft) -> Option<&'static str> {
        let is_daily = draft.is_daily;
        let form = Form::from_draft(draft)?;
        let test = form.test.name;
        self.is_daily = is_daily;
        self.sheet_mut().mark_test(test);
        self.question = Some(Question::Marks(form));
        Some(test)
    }

    /// Asks what the entries say.
    fn judge(&mut self) -> Vec<CalibrationTask> {
        let table = self.table.clone();
        self.sheet_mut().judge(&table).map(|judging| CalibrationTask::Judge(Box::new(judging))).into_iter().collect()
    }

    /// Takes what has come of a task; gives what is to be done next.
    pub fn receive(&mut self, report: CalibrationReport) -> Vec<CalibrationTask> {
        match report {
            CalibrationReport::Entries(path, outcome) if path == self.sheet().path => match outcome {
                Ok(kept) => {
                    let KeptEntries { entries, back } = *kept;
                    if back.is_some() && matches!(self.question, Some(Question::Marks(_))) {
                        self.question = None;
                    }
                    self.sheet_mut().take(entries, back);
                    return self.judge();
                }
                Err(sentence) => {
                    let sentence = format!("{sentence}; N keeps the file aside and begins anew");
                    let sheet = self.sheet_mut();
                    (sheet.entries, sheet.trouble) = (None, Some(sentence.clone()));
                    self.message = Some(Message::warning(sentence));
                }
            },
            CalibrationReport::Unkept(path, sentence) => {
                if let Some(Question::Marks(form)) = &mut self.question {
                    // What could not be kept stays in the form.
                    form.is_sent = false;
                }
                self.message = Some(Message::warning(sentence));
                // What another program has changed is seen.
                return vec![CalibrationTask::Read(path)];
            }
            CalibrationReport::Entries(..) => {}
            CalibrationReport::Judged(is_daily, number, outcome) => {
                let sheet = if is_daily { &mut self.daily } else { &mut self.all };
                sheet.answer(number, outcome);
            }
            CalibrationReport::Saved(path, Ok(true)) => {
                let name = path.file_stem().unwrap_or_default().to_string_lossy();
                let (played, _) = self.sheet().count();
                let misread = self.sheet().found().map_or(0, |found| found.misread().len());
                let misread = if misread == 0 { String::new() } else { format!(", {misread} of them misread") };
                let strokes = if played == 1 { "one stroke".to_owned() } else { format!("{played} strokes{misread}") };
                let said = format!("saved as {name}, from {strokes}; p plays on it from now on");
                self.message = Some(Message::good(said));
                self.saved = Some(path);
            }
            CalibrationReport::Saved(path, Ok(false)) => {
                let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
                if self.question.is_some() {
                    self.message = Some(Message::warning(taken_words(&name)));
                } else {
                    self.question = Some(Question::Replace(name));
                }
            }
            CalibrationReport::Saved(_, Err(sentence)) => self.message = Some(Message::warning(sentence)),
        }
        Vec::new()
    }

    /// Where entries are kept that are put aside.
    fn beside(&self) -> PathBuf {
        latest_backup_path(&self.sheet().path)
    }
}

impl Page for CalibrationPage {
    fn message_mut(&mut self) -> &mut Option<Message> {
        &mut self.message
    }

    fn field_mut(&mut self) -> Option<&mut TextField> {
        match self.question.as_mut()? {
            // What is on its way to the disk stays as it is.
            Question::Marks(form) if form.is_sent => None,
            Question::Marks(form) => Some(&mut form.fields[form.field].1),
            Question::Name(field) => Some(field),
            _ => None,
        }
    }
}
