//! The keys of the training screen, a table for each of its pages and questions.

use crossterm::event::KeyCode::{BackTab, Backspace, Down, End, Enter, Esc, Left, Right, Tab, Up};

use crate::terminal::keymap::{
    Binding,
    Section::{Charts, Form, List, Program, Replay, Run},
    bind, key, letter, lines, marks,
};

use TrainingAction as A;
use TrainingCondition as W;

/// What a key does on the training screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TrainingAction {
    /// Goes back to the page before.
    Back,
    /// Moves the mark in the list by lines, down where positive.
    Line(isize),
    /// Takes the marked run: watches it, or compares with it.
    Choose,
    /// Opens the form for a new run.
    New,
    /// Goes on with a run that is not training.
    Resume,
    /// Moves the mark in the form by fields, down where positive.
    Field(isize),
    /// Takes the next value of the marked field, or the one before.
    Value(isize),
    /// Takes the last digit back.
    Erase,
    /// Starts the new run.
    Start,
    /// Shows or hides the chart of a quantity, by its place in [`Quantity::ALL`](crate::learning::run::quantity::Quantity).
    Show(usize),
    /// Selects another of the charts, the next where positive.
    Chart(isize),
    /// Enlarges the selected chart, or shows all again.
    Enlarge,
    /// Draws the selected chart on a logarithmic scale, or not.
    Log,
    /// Takes the next degree of smoothing.
    Smooth,
    /// Shows fewer shots, or more where negative.
    Zoom(isize),
    /// Shows later shots, or earlier ones where negative.
    Pan(isize),
    /// Shows all of the run.
    All,
    /// Follows the end of the run.
    Follow,
    /// Chooses a run to compare with, or ends that.
    Compare,
    /// Pauses the run, or lets it go on.
    Pause,
    /// Asks whether to stop and save the run.
    Stop,
    /// Asks whether to abandon the run.
    Abandon,
    /// Uses the run's policy in the coach.
    Use,
    /// Asks for a name under which the policy is kept.
    Keep,
    /// Plays or pauses the replay.
    Play,
    /// Shows another shot, the next where positive.
    Shot(isize),
    /// Answers what is asked: yes, or what was typed; or no.
    Answer(bool),
}

/// What is on the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TrainingContext {
    /// The list of runs.
    Runs,
    /// The same, to choose one to compare with.
    Compare,
    /// The form for a new run.
    Form,
    /// A run that is watched.
    Watch,
}

impl TrainingContext {
    /// Its keys.
    pub const fn bindings(self) -> &'static [Binding<A, W>] {
        match self {
            Self::Runs => RUNS,
            Self::Compare => COMPARE,
            Self::Form => FORM,
            Self::Watch => WATCH,
        }
    }
}

/// When a binding of the training screen may be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TrainingCondition {
    /// On its page.
    Always,
    /// Where runs may be started.
    MayTrain,
    /// Where a run is marked.
    Marked,
    /// Where the marked run can go on.
    MarkedCanGoOn,
    /// Where a chart is shown.
    Charts,
    /// Where not all of the run is shown.
    Zoomed,
    /// While the run is training.
    AtWork,
    /// While the run is training, but paused.
    Paused,
    /// While the run is training and not paused.
    Working,
    /// Where the run can go on.
    CanGoOn,
    /// Where the run is known, whatever it does.
    Known,
    /// Where the run has a policy that the coach can use.
    HasPolicy,
    /// Where there are shots to replay.
    Shots,
}

const BACK: Binding<A, W> =
    bind(Program, W::Always, &[key(Esc, A::Back)], Some(("back", 1)), "back to the page before");

#[rustfmt::skip]
const MARK: Binding<A, W> = bind(List, W::Marked, lines!(A::Line), Some(("choose", 2)), "mark another run")
    .each(marks!("run"));

/// The list of runs.
#[rustfmt::skip]
pub const RUNS: &[Binding<A, W>] = &[
    bind(List, W::Marked, &[key(Enter, A::Choose)], Some(("watch", 1)), "watch the marked run"),
    bind(List, W::MayTrain, &[letter('n', A::New)], Some(("new run", 1)), "start a new run"),
    bind(List, W::MarkedCanGoOn, &[letter('r', A::Resume)], Some(("go on with it", 1)), "go on with a run that was stopped or killed"),
    MARK,
    BACK,
];

/// The list, when a run is chosen to compare with.
#[rustfmt::skip]
pub const COMPARE: &[Binding<A, W>] = &[
    bind(List, W::Marked, &[key(Enter, A::Choose)], Some(("compare", 1)), "compare with the marked run"),
    MARK,
    BACK,
];

/// The form for a new run.
#[rustfmt::skip]
pub const FORM: &[Binding<A, W>] = &[
    bind(Form, W::Always, &[key(Enter, A::Start)], Some(("start", 1)), "start the run"),
    bind(Form, W::Always, &[key(Down, A::Field(1)), key(Up, A::Field(-1)), key(Tab, A::Field(1)), key(BackTab, A::Field(-1))],
        Some(("field", 2)), "go to another field").each(&["go to the next field", "go to the field before"]),
    bind(Form, W::Always, &[key(Left, A::Value(-1)), key(Right, A::Value(1))], Some(("value", 2)),
        "choose a value; numbers can be typed as well").each(&[
        "choose the value before; numbers can be typed as well", "choose the next value; numbers can be typed as well",
        ]),
    bind(Form, W::Always, &[key(Backspace, A::Erase)], None, "take a digit back"),
    BACK,
];

/// What the keys of the charts do, in the order of the quantities.
const SHOW: &[&str] = &[
    "show or hide the mean reward",
    "show or hide the mean Q-value",
    "show or hide the critic loss",
    "show or hide the held-out success",
    "show or hide the actor loss",
    "show or hide the best-of-k success",
    "show or hide the shots a second",
    "show or hide the updates a second",
    "show or hide the exploration",
];

/// A run that is watched.
#[rustfmt::skip]
pub const WATCH: &[Binding<A, W>] = &[
    bind(Run, W::CanGoOn, &[letter('r', A::Resume)], Some(("go on", 1)), "go on with a run that is not training"),
    bind(Run, W::Paused, &[letter('p', A::Pause)], Some(("go on", 1)), "let a paused run go on"),
    bind(Run, W::Working, &[letter('p', A::Pause)], Some(("pause", 1)), "pause the run and save it"),
    bind(Run, W::AtWork, &[letter('S', A::Stop)], Some(("stop", 1)), "stop the run and save it; asks first"),
    bind(Run, W::HasPolicy, &[letter('w', A::Use)], Some(("use", 1)), "use these networks in the coach"),
    bind(Charts, W::Known, &[letter('c', A::Compare)], Some(("compare", 1)), "compare with another run; once more ends it"),
    bind(Charts, W::Charts, &[key(Enter, A::Enlarge), letter('z', A::Enlarge)], Some(("enlarge", 1)),
        "enlarge the selected chart, and back"),
    bind(Charts, W::Charts, &[letter('+', A::Zoom(1)), letter('-', A::Zoom(-1)), letter('=', A::Zoom(1))],
        Some(("zoom", 2)), "show fewer shots, or more").each(&["show fewer shots", "show more shots"]),
    bind(Charts, W::Charts, &[key(Tab, A::Chart(1)), key(BackTab, A::Chart(-1))], Some(("chart", 1)), "select a chart")
        .each(&["select the next chart", "select the chart before"]),
    bind(Charts, W::Charts, &[letter('l', A::Log)], Some(("log", 1)), "logarithmic scale for the selected chart"),
    bind(Charts, W::Charts, &[letter('s', A::Smooth)], Some(("smooth", 1)), "smooth over 1, 3 or 10 % of what is shown, or not"),
    bind(Charts, W::Always, &[
        letter('1', A::Show(0)), letter('2', A::Show(1)), letter('3', A::Show(2)), letter('4', A::Show(3)),
        letter('5', A::Show(4)), letter('6', A::Show(5)), letter('7', A::Show(6)), letter('8', A::Show(7)),
        letter('9', A::Show(8)),
        ], None, "show or hide the chart of a quantity, see below").each(SHOW),
    bind(Charts, W::Zoomed, &[key(Left, A::Pan(-1)), key(Right, A::Pan(1))], Some(("pan", 2)), "show earlier shots, or later ones")
        .each(&["show earlier shots", "show later shots"]),
    bind(Charts, W::Zoomed, &[letter('0', A::All)], None, "show all of the run"),
    bind(Charts, W::Zoomed, &[key(End, A::Follow)], None, "follow the end of the run"),
    bind(Run, W::HasPolicy, &[letter('k', A::Keep)], Some(("keep", 1)), "keep these networks under a name"),
    bind(Run, W::AtWork, &[letter('A', A::Abandon)], None, "end a run that is training and delete it; asks first"),
    bind(Replay, W::Shots, &[letter(' ', A::Play)], Some(("replay", 1)), "play and pause the latest shots on held-out layouts"),
    bind(Replay, W::Shots, &[letter(',', A::Shot(-1)), letter('.', A::Shot(1))], None, "the shot before, the next shot")
        .each(&["the shot before", "the next shot"]),
    BACK,
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learning::run::quantity::Quantity;

    #[test]
    fn the_charts_have_the_names_of_what_they_show() {
        assert_eq!(SHOW.len(), Quantity::ALL.len());
        for (words, quantity) in SHOW.iter().zip(Quantity::ALL) {
            assert!(words.ends_with(quantity.name()), "{words}: {}", quantity.name());
        }
    }
}
