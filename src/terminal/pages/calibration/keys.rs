//! Key bindings of the calibration page and of the form for a stroke.

use crossterm::event::KeyCode::{
    BackTab, Backspace, Delete, Down, End, Enter, Esc, Home, Left, PageDown, PageUp, Right, Tab, Up,
};

use crate::terminal::keymap::{
    Binding,
    Section::{Calibration, Marks, Program},
    bind, ctrl, key, letter,
};

use CalibrationAction as A;
use CalibrationCondition as W;

/// Action of a key on the calibration page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CalibrationAction {
    /// Returns to the coach page.
    Back,
    /// Moves the mark by tests, downwards if positive.
    MoveMark(isize),
    /// Moves the mark by ten tests, downwards if positive, or turns the pages of the values.
    Page(isize),
    /// Marks the test whose next stroke gives the most information.
    MarkBest,
    /// Leaves a test out or includes it again.
    ToggleLeftOut,
    /// Marks another stroke of the test, a later one if positive.
    MarkStroke(isize),
    /// Opens the form for a new stroke of the test.
    EnterStroke,
    /// Opens the form for editing the marked stroke.
    EditStroke,
    /// Deletes the marked stroke.
    DeleteStroke,
    /// Undoes the last change.
    Undo,
    /// Switches between the test and the calibrated values.
    ToggleValues,
    /// Switches between the daily check and the full calibration.
    ToggleDaily,
    /// Asks for the table's name, to save it.
    SaveTable,
    /// Makes the saved table the current one.
    UseTable,
    /// Asks whether to start again without entries.
    StartOver,
    /// Moves to another field of the form, downwards if positive.
    MoveField(isize),
    /// Turns the note on or off that a position was measured with a tape.
    ToggleTape,
    /// Turns the note on or off that the stroke was played from the far end.
    ToggleFarEnd,
    /// Answers the open question: `true` for yes or the typed text, `false` for no.
    Answer(bool),
}

/// Condition under which a key binding of the calibration page is enabled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CalibrationCondition {
    /// In every state.
    Always,
    /// If the file of entries could be read.
    Readable,
    /// If a stroke of the test has been entered.
    HasStroke,
    /// If anything has been entered.
    HasEntries,
    /// If a change can be undone.
    Undoable,
    /// If the table's values have been found and no entry is implausible.
    HasResult,
    /// If a table has been saved.
    HasSavedTable,
    /// If the current table is a calibrated one.
    CalibratedTable,
}

/// The key contexts of the calibration page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CalibrationContext {
    /// The list of tests.
    Tests,
    /// The form with the marks of a stroke.
    Marks,
}

impl CalibrationContext {
    /// The key bindings of the context.
    pub const fn bindings(self) -> &'static [Binding<A, W>] {
        match self {
            Self::Tests => TESTS,
            Self::Marks => FORM,
        }
    }
}

/// Key bindings of the list of tests.
#[rustfmt::skip]
pub const TESTS: &[Binding<A, W>] = &[
    bind(Calibration, W::Readable, &[key(Enter, A::EnterStroke)], Some(("enter a stroke", 1)), "enter what was marked of a stroke of the test"),
    bind(Calibration, W::Always, &[
        key(Down, A::MoveMark(1)), key(Up, A::MoveMark(-1)), letter('j', A::MoveMark(1)), letter('k', A::MoveMark(-1)),
        key(End, A::MoveMark(isize::MAX)), key(Home, A::MoveMark(isize::MIN)),
        ], Some(("test", 2)), "mark another test")
        .each(&["mark the next test", "mark the previous test", "mark the last test", "mark the first test"]),
    bind(Calibration, W::Always, &[key(PageDown, A::Page(1)), key(PageUp, A::Page(-1))], None, "mark a test ten on or back; of the values, turn the page")
        .each(&["mark a test ten on; of the values, the next page", "mark a test ten back; of the values, the previous page"]),
    bind(Calibration, W::Always, &[key(Tab, A::ToggleValues)], Some(("values", 1)), "the table's values so far, and which marks look misread; again for the test"),
    bind(Calibration, W::HasResult, &[letter('s', A::SaveTable)], Some(("save", 1)), "save the table under a name"),
    bind(Calibration, W::HasSavedTable, &[letter('p', A::UseTable)], Some(("play on it", 1)), "play on the saved table, here and at every start"),
    bind(Calibration, W::Always, &[letter('n', A::MarkBest)], Some(("best next", 1)), "mark the test whose next stroke tells most"),
    bind(Calibration, W::Undoable, &[letter('u', A::Undo)], Some(("undo", 1)), "undo the last change"),
    bind(Calibration, W::HasStroke, &[letter('e', A::EditStroke)], Some(("edit", 1)), "change what was entered of the marked stroke"),
    bind(Calibration, W::HasStroke, &[key(Left, A::MarkStroke(-1)), key(Right, A::MarkStroke(1)), letter('h', A::MarkStroke(-1)), letter('l', A::MarkStroke(1))],
        Some(("stroke", 2)), "mark another stroke of the test")
        .each(&["mark the previous stroke of the test", "mark the next stroke of the test"]),
    bind(Calibration, W::HasStroke, &[key(Delete, A::DeleteStroke), key(Backspace, A::DeleteStroke)], Some(("delete", 1)), "delete the marked stroke"),
    bind(Calibration, W::Always, &[letter('x', A::ToggleLeftOut)], Some(("leave out", 1)), "leave the test out with its strokes, take it in again"),
    bind(Calibration, W::CalibratedTable, &[letter('d', A::ToggleDaily)], Some(("daily check", 1)), "two strokes that show how the table plays today; back to all tests"),
    bind(Calibration, W::HasEntries, &[letter('N', A::StartOver)], None, "start again; the entries are kept next to the file"),
    bind(Program, W::Always, &[key(Esc, A::Back)], Some(("back", 1)), "back to the coach"),
];

/// Key bindings of the form for a stroke.
#[rustfmt::skip]
pub const FORM: &[Binding<A, W>] = &[
    bind(Marks, W::Always, &[key(Enter, A::Answer(true))], Some(("next, save", 1)), "go to the next mark; after the last one save the stroke"),
    bind(Marks, W::Always, &[key(Down, A::MoveField(1)), key(Up, A::MoveField(-1)), key(Tab, A::MoveField(1)), key(BackTab, A::MoveField(-1))],
        Some(("mark", 2)), "type another mark").each(&["type the next mark", "type the previous mark"]),
    bind(Marks, W::Always, &[ctrl('t', A::ToggleTape)], Some(("by tape", 1)), "this place was measured with a tape, to 5 mm; again for by eye"),
    bind(Marks, W::Always, &[ctrl('e', A::ToggleFarEnd)], Some(("far end", 1)), "this stroke was played from the far end, where the balls meet the other rails; again for your own"),
    bind(Marks, W::Always, &[key(Esc, A::Answer(false))], Some(("back", 1)), "leave the form; it is there again when the same stroke is entered"),
];
