//! Key bindings of the training page: one table for each of its screens.

use crossterm::event::KeyCode::{BackTab, Backspace, Down, End, Enter, Esc, Left, Right, Tab, Up};

use crate::terminal::keymap::{
    Binding,
    Section::{Charts, Form, List, Program, Replay, Run},
    bind, key, letter, lines, marks,
};

use TrainingAction as A;
use TrainingCondition as W;

/// Action of a key on the training page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TrainingAction {
    /// Returns to the previous screen.
    Back,
    /// Moves the mark in the list by lines, downwards if positive.
    MoveMark(isize),
    /// Chooses the marked run: to watch it, or to compare with it.
    ChooseRun,
    /// Opens the form for a new run.
    NewRun,
    /// Resumes a run that is not training.
    Resume,
    /// Moves the mark in the form by fields, downwards if positive.
    MoveField(isize),
    /// Chooses the next value of the marked field, or the one before if negative.
    ChangeValue(isize),
    /// Deletes the last digit.
    Erase,
    /// Starts the new run.
    Start,
    /// Shows or hides the chart of a quantity, by its index in [`Quantity::ALL`](crate::learning::run::quantity::Quantity).
    ToggleChart(usize),
    /// Selects another chart: the next one if positive, the one before if negative.
    SelectChart(isize),
    /// Enlarges the selected chart, or shows all again.
    ToggleEnlarged,
    /// Turns the logarithmic scale of the selected chart on or off.
    ToggleLogScale,
    /// Chooses the next width of the smoothing.
    NextSmoothing,
    /// Shows fewer shots, or more if negative.
    Zoom(isize),
    /// Shows later shots, or earlier ones if negative.
    Pan(isize),
    /// Shows all of the run.
    ShowAll,
    /// Follows the end of the run.
    FollowEnd,
    /// Opens the choice of a run to compare with, or ends the comparison.
    ToggleComparison,
    /// Pauses or continues the run.
    Pause,
    /// Asks whether to stop and save the run.
    Stop,
    /// Asks whether to abandon the run.
    Abandon,
    /// Uses the run's policy in the coach.
    UsePolicy,
    /// Asks for a name under which to save the policy.
    SavePolicy,
    /// Plays or pauses the replay.
    Play,
    /// Shows another shot: the next one if positive, the one before if negative.
    StepShot(isize),
    /// Answers the open question: `true` for yes or the typed text, `false` for no.
    Answer(bool),
}

/// The screens of the training page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TrainingContext {
    /// The list of runs.
    Runs,
    /// The list of runs, to choose one for a comparison.
    Compare,
    /// The form for a new run.
    Form,
    /// A watched run.
    Watch,
}

impl TrainingContext {
    /// The key bindings of the screen.
    pub const fn bindings(self) -> &'static [Binding<A, W>] {
        match self {
            Self::Runs => RUNS,
            Self::Compare => COMPARE,
            Self::Form => FORM,
            Self::Watch => WATCH,
        }
    }
}

/// Condition under which a key binding of the training page is enabled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TrainingCondition {
    /// Always, on the binding's screen.
    Always,
    /// If the user may start runs.
    CanTrain,
    /// If a run is marked.
    Marked,
    /// If the marked run can be resumed.
    MarkedResumable,
    /// If a chart is shown.
    HasChart,
    /// If only a part of the run is shown.
    Zoomed,
    /// While the run is training, paused or not.
    Active,
    /// While the run is paused.
    Paused,
    /// While the run is training and not paused.
    Running,
    /// If the run can be resumed.
    Resumable,
    /// If the run exists, whatever its state.
    RunExists,
    /// If the run has a policy that the coach can use.
    HasPolicy,
    /// If there are shots to replay.
    HasReplay,
}

const BACK: Binding<A, W> =
    bind(Program, W::Always, &[key(Esc, A::Back)], Some(("back", 1)), "back to the previous page");

#[rustfmt::skip]
const MARK: Binding<A, W> = bind(List, W::Marked, lines!(A::MoveMark), Some(("choose", 2)), "mark another run")
    .each(marks!("run"));

/// Key bindings of the list of runs.
#[rustfmt::skip]
pub const RUNS: &[Binding<A, W>] = &[
    bind(List, W::Marked, &[key(Enter, A::ChooseRun)], Some(("watch", 1)), "watch the marked run"),
    bind(List, W::CanTrain, &[letter('n', A::NewRun)], Some(("new run", 1)), "start a new run"),
    bind(List, W::MarkedResumable, &[letter('r', A::Resume)], Some(("go on with it", 1)), "go on with a run that was stopped or killed"),
    MARK,
    BACK,
];

/// Key bindings of the list of runs, for choosing one for a comparison.
#[rustfmt::skip]
pub const COMPARE: &[Binding<A, W>] = &[
    bind(List, W::Marked, &[key(Enter, A::ChooseRun)], Some(("compare", 1)), "compare with the marked run"),
    MARK,
    BACK,
];

/// Key bindings of the form for a new run.
#[rustfmt::skip]
pub const FORM: &[Binding<A, W>] = &[
    bind(Form, W::Always, &[key(Enter, A::Start)], Some(("start", 1)), "start the run"),
    bind(Form, W::Always, &[key(Down, A::MoveField(1)), key(Up, A::MoveField(-1)), key(Tab, A::MoveField(1)), key(BackTab, A::MoveField(-1))],
        Some(("field", 2)), "go to another field").each(&["go to the next field", "go to the previous field"]),
    bind(Form, W::Always, &[key(Left, A::ChangeValue(-1)), key(Right, A::ChangeValue(1))], Some(("value", 2)),
        "choose a value; numbers can be typed as well").each(&[
        "choose the previous value; numbers can be typed as well", "choose the next value; numbers can be typed as well",
        ]),
    bind(Form, W::Always, &[key(Backspace, A::Erase)], None, "take a digit back"),
    BACK,
];

/// Descriptions of the keys that show and hide charts, in the order of the quantities.
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

/// Key bindings of a watched run.
#[rustfmt::skip]
pub const WATCH: &[Binding<A, W>] = &[
    bind(Run, W::Resumable, &[letter('r', A::Resume)], Some(("go on", 1)), "go on with a run that is not training"),
    bind(Run, W::Paused, &[letter('p', A::Pause)], Some(("go on", 1)), "let a paused run go on"),
    bind(Run, W::Running, &[letter('p', A::Pause)], Some(("pause", 1)), "pause the run and save it"),
    bind(Run, W::Active, &[letter('S', A::Stop)], Some(("stop", 1)), "stop the run and save it; asks first"),
    bind(Run, W::HasPolicy, &[letter('w', A::UsePolicy)], Some(("use", 1)), "use these networks in the coach"),
    bind(Charts, W::RunExists, &[letter('c', A::ToggleComparison)], Some(("compare", 1)), "compare with another run; once more ends it"),
    bind(Charts, W::HasChart, &[key(Enter, A::ToggleEnlarged), letter('z', A::ToggleEnlarged)], Some(("enlarge", 1)),
        "enlarge the selected chart, and back"),
    bind(Charts, W::HasChart, &[letter('+', A::Zoom(1)), letter('-', A::Zoom(-1)), letter('=', A::Zoom(1))],
        Some(("zoom", 2)), "show fewer shots, or more").each(&["show fewer shots", "show more shots"]),
    bind(Charts, W::HasChart, &[key(Tab, A::SelectChart(1)), key(BackTab, A::SelectChart(-1))], Some(("chart", 1)), "select a chart")
        .each(&["select the next chart", "select the previous chart"]),
    bind(Charts, W::HasChart, &[letter('l', A::ToggleLogScale)], Some(("log", 1)), "logarithmic scale for the selected chart"),
    bind(Charts, W::HasChart, &[letter('s', A::NextSmoothing)], Some(("smooth", 1)), "smooth over 1, 3 or 10 % of what is shown, or not"),
    bind(Charts, W::Always, &[
        letter('1', A::ToggleChart(0)), letter('2', A::ToggleChart(1)), letter('3', A::ToggleChart(2)), letter('4', A::ToggleChart(3)),
        letter('5', A::ToggleChart(4)), letter('6', A::ToggleChart(5)), letter('7', A::ToggleChart(6)), letter('8', A::ToggleChart(7)),
        letter('9', A::ToggleChart(8)),
        ], None, "show or hide the chart of a quantity, see below").each(SHOW),
    bind(Charts, W::Zoomed, &[key(Left, A::Pan(-1)), key(Right, A::Pan(1))], Some(("pan", 2)), "show earlier shots, or later ones")
        .each(&["show earlier shots", "show later shots"]),
    bind(Charts, W::Zoomed, &[letter('0', A::ShowAll)], None, "show all of the run"),
    bind(Charts, W::Zoomed, &[key(End, A::FollowEnd)], None, "follow the end of the run"),
    bind(Run, W::HasPolicy, &[letter('k', A::SavePolicy)], Some(("keep", 1)), "keep these networks under a name"),
    bind(Run, W::Active, &[letter('A', A::Abandon)], None, "end a run that is training and delete it; asks first"),
    bind(Replay, W::HasReplay, &[letter(' ', A::Play)], Some(("replay", 1)), "play and pause the latest shots on held-out layouts"),
    bind(Replay, W::HasReplay, &[letter(',', A::StepShot(-1)), letter('.', A::StepShot(1))], None, "the previous shot, the next shot")
        .each(&["the previous shot", "the next shot"]),
    BACK,
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learning::run::quantity::Quantity;

    #[test]
    fn chart_commands_match_the_quantities_shown() {
        assert_eq!(SHOW.len(), Quantity::ALL.len());
        for (words, quantity) in SHOW.iter().zip(Quantity::ALL) {
            assert!(words.ends_with(quantity.name()), "{words}: {}", quantity.name());
        }
    }
}
