//! What belongs together among the keys.

/// Headings of the help, in its order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Section {
    /// Keys that move balls.
    Balls,
    /// Keys that ask the coach and play the shot.
    Shot,
    /// Keys of the list of runs.
    List,
    /// Keys of the form.
    Form,
    /// Keys that choose what is drawn of a run.
    Charts,
    /// Keys that steer a run and use what it has learnt.
    Run,
    /// Keys of the replay.
    Replay,
    /// Keys of the list of exercises.
    Library,
    /// Keys that set and play a stroke.
    Stroke,
    /// Keys of what is counted.
    Score,
    /// Keys of where the balls lie.
    Position,
    /// Keys of the page of records.
    Record,
    /// Keys of the filmed shots.
    Film,
    /// Keys of the settings.
    Settings,
    /// Keys of the page of keys.
    OwnKeys,
    /// Keys of the tests at a table.
    Calibration,
    /// Keys of the form for a stroke.
    Marks,
    /// All others.
    Program,
}

impl Section {
    /// All headings with their words, in the order above, which is the help's.
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
