//! Sections of the key tables, the headings of the help.

/// A section of the help, in display order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Section {
    /// Keys that move balls.
    Balls,
    /// Keys that query the coach and play the shot.
    Shot,
    /// Keys of the list of runs.
    List,
    /// Keys of the form for a new run.
    Form,
    /// Keys that choose what the charts of a run show.
    Charts,
    /// Keys that control a run and use its policy.
    Run,
    /// Keys of the replay.
    Replay,
    /// Keys of the list of exercises.
    Library,
    /// Keys that adjust and play a stroke.
    Stroke,
    /// Keys that change the score.
    Score,
    /// Keys that change the positions of the balls.
    Position,
    /// Keys of the page of records.
    Record,
    /// Keys of the filmed shots.
    Film,
    /// Keys of the settings.
    Settings,
    /// Keys of the page of key bindings.
    OwnKeys,
    /// Keys of the tests that measure a table.
    Calibration,
    /// Keys of the form for the marks of a stroke.
    Marks,
    /// All others.
    Program,
}

impl Section {
    /// All sections with their titles, in the order of the help.
    pub const ALL: [(Self, &'static str); 18] = [
        (Self::Balls, "Placing the balls"),
        (Self::Shot, "The shot"),
        (Self::List, "The list of runs"),
        (Self::Form, "A new run"),
        (Self::Charts, "The charts"),
        (Self::Run, "The run"),
        (Self::Replay, "The replay"),
        (Self::Library, "The library"),
        (Self::Stroke, "Your stroke"),
        (Self::Score, "The score"),
        (Self::Position, "The position"),
        (Self::Record, "The record"),
        (Self::Film, "Filmed shots"),
        (Self::Settings, "The settings"),
        (Self::OwnKeys, "The keys"),
        (Self::Calibration, "Measuring a table"),
        (Self::Marks, "What was marked"),
        (Self::Program, "The program"),
    ];

    /// The heading.
    pub const fn title(self) -> &'static str {
        Self::ALL[self as usize].1
    }
}
