//! Key bindings of the drill page: one table for each of its screens, and one for the search.

use crossterm::event::KeyCode::{BackTab, Delete, Down, Enter, Esc, Left, PageDown, PageUp, Right, Tab, Up};

use crate::terminal::{
    keymap::{
        Binding,
        Section::{Film, Library, Position, Program, Record, Score},
        bind, ctrl, key, letter, lines, marks,
    },
    shot::{
        PlaybackKey::{self, Event, Pace, Toggle},
        StrokeChange,
        stroke::stroke_keys,
    },
};

use DrillAction::{self as A, Playback as P};
use DrillCondition as W;

/// Action of a key on the drill page.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DrillAction {
    /// Returns to the previous screen.
    Back,
    /// Moves the mark in a list by lines, downwards if positive.
    MoveMark(isize),
    /// Lists another category: the next one if positive, the one before if negative.
    CycleCategory(isize),
    /// Lists one grade only, or all grades again.
    ToggleGrade(u8),
    /// Starts a search.
    Search,
    /// Lists everything again. If a search has no match in the list, lists its matches elsewhere.
    ShowAll,
    /// Ends the search.
    ClearSearch,
    /// Opens the marked exercise.
    Open,
    /// Chooses another player, whose execution errors are simulated.
    NextPlayer,
    /// Draws an exam of this level and describes it.
    DrawExam(u8),
    /// Begins the exam.
    BeginExam,
    /// Asks whether to discard the exam.
    DiscardExam,
    /// Opens the page on which a match against the coach is chosen.
    SetUpMatch,
    /// Chooses another value in the marked line of that page: the next one if positive, the one before if negative.
    ChooseValue(isize),
    /// Begins the match against the coach.
    BeginMatch,
    /// Opens the record, of the open exercise if there is one.
    OpenRecord,
    /// Shows the exercise's share code, and copies it if the terminal supports that.
    Share,
    /// Asks for a share code and adds it as an own position.
    AddByCode,
    /// Asks whether to remove an own position.
    Remove,
    /// Puts the exercise's balls on the coach's table.
    SendToCoach,
    /// Changes the stroke.
    ChangeStroke(StrokeChange),
    /// Asks for the stroke in a player's words.
    TypeStroke,
    /// Copies the model shot into the stroke; the model shot stays on the table for comparison.
    WhatIf,
    /// Takes the model shot off the table.
    HideModelShot,
    /// Plays the stroke.
    Play,
    /// Goes on to the next repetition, or the next exercise of an exam.
    Next,
    /// Plays the shot or steps through it.
    Playback(PlaybackKey),
    /// Opens the list of filmed shots.
    OpenFilms,
    /// Opens another filmed shot, a later one if positive.
    CycleFilm(isize),
    /// Shows the model shot, or hides it.
    ToggleHint,
    /// Turns the side view of the jump on or off.
    ToggleSideView,
    /// Switches between numbers (degrees and speed) and the form of the advice for the stroke.
    ToggleNumbers,
    /// Turns the pages of a text that does not fit, forwards if positive.
    TurnTextPage(isize),
    /// Turns the shift of the balls by half a ball at each repetition on or off.
    ToggleShift,
    /// Chooses the next goal.
    NextGoal,
    /// Makes the goal longer if positive, else shorter.
    ChangeGoalLength(isize),
    /// Records a point (`true`) or a miss at a real table.
    LogAttempt(bool),
    /// Undoes the last record from a real table.
    Undo,
    /// Undoes the last change of the stroke.
    UndoStroke,
    /// Redoes the last undone change of the stroke.
    RedoStroke,
    /// Switches the record between all exercises and the open one.
    ToggleRecordScope,
    /// Saves the estimated skill as the player's own.
    SaveSkill,
    /// Answers the open question: `true` for yes or the typed text, `false` for no.
    Answer(bool),
}

/// Condition under which a key binding of the drill page is enabled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DrillCondition {
    /// Always, on the binding's screen.
    Always,
    /// If an exercise is marked.
    Marked,
    /// If the marked exercise is a position that the player has saved.
    MarkedOwn,
    /// If a filter is active.
    Filtered,
    /// If a search is active.
    Searching,
    /// If no search is active.
    NotSearching,
    /// While the player sets the stroke.
    Aiming,
    /// While a stroke can be played, the player's or the coach's.
    Playable,
    /// While no stroke is being played, and no exam is under way.
    Free,
    /// While an exam is under way that is not over, and no stroke is being played.
    InExam,
    /// As [`Self::Free`], and another session may begin: in free repetition this is after the end of the watched shot.
    Restartable,
    /// As [`Self::Restartable`], and the exercise is repeated. In a game each stroke is played from where the balls have stopped.
    Repeating,
    /// As [`Self::Restartable`], and a point at a real table can be recorded.
    Recordable,
    /// If another session may begin and the goal has a length.
    HasGoalLength,
    /// While a shot is watched.
    Watching,
    /// While a shot is watched whose end has not been shown yet.
    Running,
    /// While a shot is watched whose end has been shown, and the session goes on or is an exam.
    Ended,
    /// While a shot is watched whose end has been shown, and the run, game or match is over.
    GoalReached,
    /// If the model shot is known.
    HasModelShot,
    /// If the model shot is known, while the player sets the stroke and no comparison is shown.
    ModelShotCopyable,
    /// While the model shot is on the table, alone or next to the stroke.
    ModelShotShown,
    /// While it is not.
    ModelShotHidden,
    /// If a record from a real table can be undone.
    Undoable,
    /// If the stroke was changed.
    StrokeUndoable,
    /// If the player has set a stroke. Enter also continues after a shot, and one Enter too many must not play an unaimed stroke.
    StrokeSet,
    /// If an undone change of the stroke can be redone.
    StrokeRedoable,
    /// If the record was opened from the page of an exercise.
    OpenedFromExercise,
    /// If there is an estimate of the skill.
    HasEstimate,
    /// If a filmed shot is on the table.
    HasFilm,
}

/// The screens of the drill page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DrillContext {
    /// The list of exercises.
    Library,
    /// The search in that list.
    Search,
    /// The description of an exam before it begins.
    Exam,
    /// The choices for a match before it begins.
    Match,
    /// An exercise.
    Exercise,
    /// The result of an exam.
    Result,
    /// A record.
    Record,
    /// The list of filmed shots.
    Films,
    /// A filmed shot.
    Film,
}

impl DrillContext {
    /// The key bindings of the screen.
    pub const fn bindings(self) -> &'static [Binding<A, W>] {
        match self {
            Self::Library => LIBRARY,
            Self::Search => SEARCH,
            Self::Exam => EXAM,
            Self::Match => MATCH,
            Self::Exercise => EXERCISE,
            Self::Result => RESULT,
            Self::Record => RECORD,
            Self::Films => FILMS,
            Self::Film => FILM,
        }
    }
}

const BACK: Binding<A, W> =
    bind(Program, W::Always, &[key(Esc, A::Back)], Some(("back", 1)), "back to the previous page");

/// Sends the marked filmed shot to the coach.
const FILM_TO_COACH: Binding<A, W> =
    bind(Film, W::Always, &[letter('c', A::SendToCoach)], Some(("coach", 1)), "put the balls on the coach's table");

/// Key bindings of the library.
#[rustfmt::skip]
pub const LIBRARY: &[Binding<A, W>] = &[
    bind(Library, W::Marked, &[key(Enter, A::Open)], Some(("practise", 1)), "open the marked exercise"),
    bind(Library, W::Marked, lines!(A::MoveMark), Some(("choose", 2)), "mark another exercise").each(marks!("exercise")),
    bind(Library, W::Always, &[key(Left, A::CycleCategory(-1)), key(Right, A::CycleCategory(1)), key(BackTab, A::CycleCategory(-1)),
        key(Tab, A::CycleCategory(1))], Some(("category", 2)), "list another category")
        .each(&["list the previous category", "list the next category"]),
    bind(Library, W::Always, &[letter('/', A::Search)], Some(("find", 1)), "find words in titles, points and tags")
        .known_as("diamonds systems banks"),
    bind(Library, W::Filtered, &[letter('0', A::ShowAll)], Some(("all", 1)),
        "list everything again; where a search has found nothing in a category, what it finds in the others"),
    bind(Library, W::Always, &[letter('e', A::DrawExam(1)), letter('E', A::DrawExam(2)), letter('X', A::DrawExam(3))], Some(("exam", 1)),
        "an exam of 20 exercises, one attempt each: of grade 1 to 3, 2 to 4, 3 to 5; of the listed category alone, if one is listed")
        .each(&[
        "an exam of grade 1 to 3: 20 exercises, or those of the listed category", "an exam of grade 2 to 4: 20 exercises, or those of the listed category",
        "an exam of grade 3 to 5: 20 exercises, or those of the listed category",
        ]),
    bind(Library, W::Always, &[letter('M', A::SetUpMatch)], Some(("match", 1)), "a match against the coach: choose the distance and the coach's level")
        .known_as("game opponent points innings"),
    bind(Library, W::Always, &[letter('p', A::NextPlayer)], Some(("player", 1)), "choose the player whose errors are played"),
    bind(Library, W::Always, &[letter('r', A::OpenRecord)], Some(("record", 1)), "the record of all exercises, and the skill that it shows"),
    bind(Library, W::Always, &[
        letter('1', A::ToggleGrade(1)), letter('2', A::ToggleGrade(2)), letter('3', A::ToggleGrade(3)), letter('4', A::ToggleGrade(4)),
        letter('5', A::ToggleGrade(5)),
        ], None, "list one grade alone, 1 the easiest; once more lists all").each(&[
        "list grade 1 alone, the easiest; once more lists all", "list grade 2 alone; once more lists all",
        "list grade 3 alone; once more lists all", "list grade 4 alone; once more lists all",
        "list grade 5 alone, the hardest; once more lists all",
        ]),
    bind(Library, W::Marked, &[letter('c', A::SendToCoach)], Some(("coach", 1)), "put the balls on the coach's table"),
    bind(Library, W::Marked, &[letter('y', A::Share)], Some(("share", 1)), "show the exercise as a code of one line, and copy it")
        .known_as("export clipboard"),
    bind(Film, W::Always, &[letter('f', A::OpenFilms)], Some(("film", 1)), "filmed shots: watch real balls beside simulated ones"),
    bind(Library, W::Always, &[letter('a', A::AddByCode)], Some(("add", 1)), "add a position from a code that is typed or pasted")
        .known_as("import"),
    bind(Library, W::MarkedOwn, &[letter('x', A::Remove), key(Delete, A::Remove)], None, "remove one of my positions; asks first"),
    bind(Program, W::Searching, &[key(Esc, A::ClearSearch)], Some(("end search", 1)), "list what the search has left out again"),
    bind(Program, W::NotSearching, &[key(Esc, A::Back)], Some(("back", 1)), "back to the previous page"),
];

/// Key bindings of the search.
#[rustfmt::skip]
pub const SEARCH: &[Binding<A, W>] = &[
    bind(Library, W::Always, &[key(Enter, A::Answer(true))], Some(("choose from these", 1)),
        "choose from what is found, in all categories where this one has nothing"),
    bind(Library, W::Always, &[key(Esc, A::Answer(false))], Some(("cancel", 1)), "list what was listed before"),
    bind(Library, W::Marked, &[key(Down, A::MoveMark(1)), key(Up, A::MoveMark(-1))], None, "mark another exercise")
        .each(&["mark the next exercise", "mark the previous exercise"]),
];

/// Key bindings of the description of an exam.
#[rustfmt::skip]
pub const EXAM: &[Binding<A, W>] = &[
    bind(Program, W::Always, &[key(Enter, A::BeginExam)], Some(("begin", 1)), "begin the exam"),
    BACK,
];

/// Key bindings of the choices for a match.
#[rustfmt::skip]
pub const MATCH: &[Binding<A, W>] = &[
    bind(Program, W::Always, &[key(Enter, A::BeginMatch)], Some(("begin", 1)), "begin the match"),
    bind(Program, W::Always, &[key(Down, A::MoveMark(1)), key(Up, A::MoveMark(-1)), letter('j', A::MoveMark(1)), letter('k', A::MoveMark(-1)),
        key(Tab, A::MoveMark(1)), key(BackTab, A::MoveMark(-1))], Some(("line", 2)), "mark another line")
        .each(&["mark the next line", "mark the previous line"]),
    bind(Program, W::Always, &[key(Left, A::ChooseValue(-1)), key(Right, A::ChooseValue(1)), letter('h', A::ChooseValue(-1)),
        letter('l', A::ChooseValue(1))], Some(("choose", 2)), "choose what counts, the distance, the limit of innings and the coach's level")
        .each(&["take the previous value", "take the next value"]),
    BACK,
];

/// Key bindings of an exercise.
#[rustfmt::skip]
pub const EXERCISE: &[Binding<A, W>] = stroke_keys!(A::ChangeStroke, W::Aiming, [
    bind(Stroke, W::Running, &[key(Enter, A::Next)], Some(("to the end", 1)), "to the end of the shot"),
    bind(Stroke, W::GoalReached, &[key(Enter, A::Next)], Some(("begin again", 1)), "begin another run, game or match like it"),
    bind(Stroke, W::Ended, &[key(Enter, A::Next)], Some(("next", 1)), "the next repetition, or the next exercise of an exam"),
    bind(Stroke, W::Watching, &[letter(' ', P(Toggle))], Some(("play/pause", 1)), "play and pause the shot"),
    bind(Stroke, W::Watching, &[letter('-', P(Pace(-1))), letter('+', P(Pace(1))), letter('=', P(Pace(1))),
        key(Down, P(Pace(-1))), key(Up, P(Pace(1)))], None, "play slower or faster")
        .each(&["play slower", "play faster"]),
    bind(Stroke, W::Playable, &[letter(' ', A::Play)], Some(("play", 1)), "play the stroke, with the player's errors"),
    bind(Stroke, W::StrokeSet, &[key(Enter, A::Play)], None, "play the stroke, once it was changed"),
], [
    bind(Stroke, W::HasModelShot, &[letter('v', A::ToggleHint)], Some(("hint", 1)),
        "show the model shot, and hide it; the attempt then counts as one with a hint"),
    bind(Stroke, W::ModelShotCopyable, &[letter('w', A::WhatIf)], Some(("what if", 1)),
        "take the model shot over into your stroke, to change it and see what comes of it; the attempt then counts as one \
         with a hint").known_as("adopt compare try hint"),
    bind(Stroke, W::Always, &[letter('i', A::ToggleSideView)], None, "the jump from the side: height along the path, or only the table"),
    bind(Stroke, W::Always, &[letter('N', A::ToggleNumbers)], None,
        "your stroke in degrees and by its speed, or by the diamond and in table lengths again")
        .known_as("angle speed diamonds lengths"),
    bind(Stroke, W::Always, &[key(PageDown, A::TurnTextPage(1)), key(PageUp, A::TurnTextPage(-1))], None,
        "turn the pages of a text that is longer than its room").each(&[
        "the next page of a text that is longer than its room", "the previous page of a text that is longer than its room",
        ]),
    bind(Score, W::Recordable, &[letter('m', A::LogAttempt(true)), letter('n', A::LogAttempt(false))], Some(("made/miss", 2)),
        "note a point, a miss at a real table; nothing is played here").each(&[
        "note a point at a real table; nothing is played here", "note a miss at a real table; nothing is played here",
        ]),
    bind(Score, W::Undoable, &[letter('u', A::Undo)], Some(("undo", 1)), "take the last note from a real table back"),
    bind(Score, W::Restartable, &[letter('o', A::NextGoal)], Some(("goal", 1)),
        "free repetition, a run of points, a game that plays on from where the balls stop, a match of two sides, or one against the coach"),
    bind(Score, W::InExam, &[letter('x', A::DiscardExam), key(Delete, A::DiscardExam)], Some(("discard", 1)),
        "discard the exam, so that it cannot be continued; asks first").known_as("abandon cancel end"),
    bind(Position, W::Repeating, &[letter('x', A::ToggleShift)], Some(("shift", 1)),
        "shift the balls by half a ball at each repetition, or not"),
    bind(Score, W::HasGoalLength, &[letter('<', A::ChangeGoalLength(-1)), letter('>', A::ChangeGoalLength(1))], Some(("length", 2)),
        "a shorter or longer goal").each(&["a shorter goal", "a longer goal"]),
    bind(Stroke, W::Aiming, &[letter('t', A::TypeStroke)], Some(("type", 1)),
        "type your stroke, or what changes of it, as players say it: red 1/2 right, 1.5 left, 2 up, 3 lengths")
        .known_as("words say fullness tips lengths aim"),
    bind(Stroke, W::Watching, &[letter(',', P(Event(-1))), letter('.', P(Event(1))), key(Left, P(Event(-1))),
        key(Right, P(Event(1)))], Some(("event", 2)), "step from event to event")
        .each(&["step to the previous event", "step to the next event"]),
], [
    bind(Stroke, W::StrokeUndoable, &[letter('z', A::UndoStroke)], None, "undo the last change of the stroke"),
    bind(Stroke, W::StrokeRedoable, &[letter('Z', A::RedoStroke), ctrl('r', A::RedoStroke)], None,
        "redo the last change of the stroke"),
    bind(Position, W::Free, &[letter('c', A::SendToCoach)], Some(("coach", 1)), "put the balls on the coach's table"),
    bind(Position, W::Restartable, &[letter('p', A::NextPlayer)], None, "choose the player whose errors are played"),
    bind(Score, W::Restartable, &[letter('M', A::SetUpMatch)], Some(("match", 1)), "another match against the coach: choose the distance and the coach's level")
        .known_as("game opponent points innings"),
    bind(Score, W::Always, &[letter('r', A::OpenRecord)], Some(("record", 1)), "the record of this exercise"),
    bind(Program, W::ModelShotShown, &[key(Esc, A::HideModelShot)], Some(("hide shot", 1)),
        "take the model shot off the table; your stroke stays as it is set"),
    bind(Program, W::ModelShotHidden, &[key(Esc, A::Back)], Some(("back", 1)), "back to the previous page"),
]);

/// Key bindings of an exam's result.
#[rustfmt::skip]
pub const RESULT: &[Binding<A, W>] = &[
    bind(Library, W::Always, &[key(Enter, A::Open)], Some(("practise", 1)), "practise the marked exercise; Esc leads back here"),
    bind(Library, W::Always, lines!(A::MoveMark), Some(("choose", 2)), "mark another exercise").each(marks!("exercise")),
    bind(Program, W::Always, &[key(Esc, A::Back)], Some(("library", 1)), "back to the library"),
];

/// Key bindings of a record.
#[rustfmt::skip]
pub const RECORD: &[Binding<A, W>] = &[
    bind(Record, W::OpenedFromExercise, &[letter('a', A::ToggleRecordScope)], Some(("all or one", 1)), "the record of all exercises, or of this one"),
    bind(Record, W::HasEstimate, &[letter('w', A::SaveSkill)], Some(("use this skill", 1)), "take the estimated skill as yours, by your notes, and play with it"),
    bind(Record, W::Always, &[key(Down, A::MoveMark(1)), key(Up, A::MoveMark(-1)), key(PageDown, A::MoveMark(10)), key(PageUp, A::MoveMark(-10))], Some(("scroll", 2)), "earlier sessions").each(&[
        "earlier sessions, by one line", "later sessions, by one line", "earlier sessions, by ten lines", "later sessions, by ten lines",
        ]),
    BACK,
];

/// Key bindings of the list of filmed shots.
#[rustfmt::skip]
pub const FILMS: &[Binding<A, W>] = &[
    bind(Film, W::Always, &[key(Enter, A::Open)], Some(("watch", 1)), "watch the marked shot"),
    bind(Film, W::Always, lines!(A::MoveMark), Some(("choose", 2)), "mark another shot").each(marks!("shot")),
    FILM_TO_COACH,
    BACK,
];

/// Key bindings of a filmed shot.
#[rustfmt::skip]
pub const FILM: &[Binding<A, W>] = &[
    bind(Film, W::HasFilm, &[letter(' ', P(Toggle))], Some(("play", 1)), "play and pause the shot"),
    bind(Film, W::HasFilm, &[letter(',', P(Event(-1))), letter('.', P(Event(1))), key(Left, P(Event(-1))),
        key(Right, P(Event(1)))], Some(("event", 2)), "step from event to event")
        .each(&["step to the previous event", "step to the next event"]),
    bind(Film, W::HasFilm, &[letter('-', P(Pace(-1))), letter('+', P(Pace(1))), letter('=', P(Pace(1))),
        key(Down, P(Pace(-1))), key(Up, P(Pace(1)))], Some(("speed", 2)), "play slower or faster")
        .each(&["play slower", "play faster"]),
    bind(Film, W::Always, &[letter('[', A::CycleFilm(-1)), letter(']', A::CycleFilm(1))], Some(("other shot", 2)),
        "watch the previous shot, the next shot").each(&["watch the previous shot", "watch the next shot"]),
    FILM_TO_COACH,
    BACK,
];
