//! Key bindings of the coach page.

use crossterm::event::KeyCode::{BackTab, Down, End, Enter, Esc, Home, Left, Right, Tab, Up};

use crate::terminal::{
    keymap::{
        Binding, Chord,
        Section::{Balls, Program, Shot},
        bind, ctrl, key, letter,
    },
    shot::{
        PlaybackKey::{self, Event, Pace, ToEnd, ToStart, Toggle},
        StrokeChange,
        stroke::stroke_keys,
    },
};

use CoachAction::{self as A, Playback as P};
use CoachCondition as W;

/// Action of a key on the coach page.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CoachAction {
    /// Selects a ball by its colour: white, yellow or red.
    SelectBall(usize),
    /// Selects another ball: the next one if positive, the one before if negative.
    CycleBall(isize),
    /// Moves the selected ball: steps to the right, steps up, and the factor on the chosen step size.
    MoveBall(i8, i8, f64),
    /// Chooses a larger step if positive, else a smaller one.
    ChangeStepSize(isize),
    /// Switches between steps of quarter diamonds and of millimetres.
    ToggleQuarters,
    /// Asks for ball positions, to be typed or pasted.
    TypePositions,
    /// Puts the balls in the opening position.
    OpeningPosition,
    /// Puts the balls in random positions.
    RandomPosition,
    /// Makes the opponent's ball the cue ball.
    SwapCueBall,
    /// Undoes the last change of the balls.
    Undo,
    /// Redoes the last undone change of the balls.
    Redo,
    /// Asks the coach for a shot.
    Recommend,
    /// Cancels the request to the coach.
    Cancel,
    /// Plays the shot or steps through it.
    Playback(PlaybackKey),
    /// Leaves the shot and returns to placing balls.
    PlaceBalls,
    /// Continues with the layout after the shot.
    Continue,
    /// Chooses the next rule: what counts as a point.
    NextRule,
    /// Chooses the next skill level of the player.
    NextSkill,
    /// Turns planning on or off: whether the next point counts too.
    TogglePlan,
    /// Chooses what the cue ball must hit first.
    NextFirstContact,
    /// Shows the lesson on the shot's diamond system, then on the other systems.
    NextSystem,
    /// Switches between the thesis' numbers and words for the shot.
    ToggleNumbers,
    /// Switches between listing all events and contacts only.
    ToggleAllEvents,
    /// Turns the side view of the shot's jump on or off.
    ToggleSideView,
    /// Shows the next panel.
    NextInfoPanel,
    /// Shows another of the proposed shots: the next one if positive, the one before if negative.
    CycleShot(isize),
    /// Shows one of the proposed shots by its index. Only the mouse triggers this action, no key.
    ShowShot(usize),
    /// Starts the player's own stroke, from the displayed shot if there is one.
    WhatIf,
    /// Changes the player's own stroke.
    ChangeStroke(StrokeChange),
    /// Asks for the player's own stroke in a player's words.
    TypeStroke,
    /// Undoes the last change of the stroke.
    UndoStroke,
    /// Redoes the last undone change of the stroke.
    RedoStroke,
    /// Leaves the player's own stroke and returns to the coach's shot.
    LeaveStroke,
    /// Returns to the bundled policies.
    UseBundledPolicies,
    /// Resumes the last session.
    Resume,
    /// Saves the balls as a practice position, after asking for its title.
    SavePosition,
    /// Answers the open question: `true` for yes or the typed text, `false` for no.
    Answer(bool),
    /// Starts or stops sharing the table with spectators.
    ToggleSharing,
    /// Opens the drills page.
    OpenDrills,
    /// Opens the list of filmed shots.
    OpenFilms,
    /// Opens the training page.
    OpenTraining,
}

/// Condition under which a key binding of the coach page is enabled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CoachCondition {
    /// In every state.
    Always,
    /// While the coach is not thinking.
    Idle,
    /// While balls are placed.
    Placing,
    /// While a shot is watched.
    Watching,
    /// If there is a shot.
    Shot,
    /// While the coach thinks.
    Thinking,
    /// If there are several shots to choose from.
    SeveralShots,
    /// If a change can be undone.
    Undoable,
    /// If an undone change can be redone.
    Redoable,
    /// If the player's own stroke was changed.
    StrokeUndoable,
    /// If an undone change of the player's own stroke can be redone.
    StrokeRedoable,
    /// If the player's own strokes have moved the balls.
    OwnStrokePlayed,
    /// If the coach uses a policy that the user has trained.
    CustomPolicy,
    /// If an unfinished exam or an earlier session can be resumed.
    Resumable,
    /// If the player has a name.
    HasPlayerName,
}

/// Key bindings, with the more specific conditions first.
#[rustfmt::skip]
pub const COACH: &[Binding<A, W>] = &[
    bind(Shot, W::Thinking, &[key(Esc, A::Cancel)], Some(("cancel", 1)), "stop the coach's thinking"),
    bind(Shot, W::Idle, &[key(Enter, A::Recommend)], Some(("ask", 1)), "ask the coach for a shot"),
    bind(Shot, W::CustomPolicy, &[letter('b', A::UseBundledPolicies)], Some(("bundled", 1)),
        "ask the bundled networks again, with the earlier table and rule"),
    bind(Shot, W::Shot, &[letter(' ', P(Toggle))], Some(("play", 1)), "play and pause the shot"),
    bind(Shot, W::SeveralShots, &[letter('[', A::CycleShot(-1)), letter(']', A::CycleShot(1))], Some(("shots", 2)),
        "step through the shots that the coach lists")
        .each(&["show the one before of the coach's shots", "show the next of the coach's shots"]),
    bind(Shot, W::Watching, &[
        key(Tab, A::CycleBall(1)), key(BackTab, A::CycleBall(-1)), letter('1', A::SelectBall(0)), letter('2', A::SelectBall(1)),
        letter('3', A::SelectBall(2)), key(Esc, A::PlaceBalls), letter('e', A::PlaceBalls),
        ], Some(("place", 1)), "back to placing the balls, with one of them selected; a click on a ball does it too").each(&[
        "leave the shot and select the next ball", "leave the shot and select the previous ball",
        "leave the shot and select the white ball", "leave the shot and select the yellow ball",
        "leave the shot and select the red ball", "leave the shot, back to placing the balls",
        ]),
    bind(Shot, W::Always, &[letter('v', A::NextInfoPanel)], Some(("view", 1)),
        "turn the panels: shot and balls, chances, margins and maps, plan").known_as("diamonds words"),
    bind(Shot, W::Idle, &[letter('w', A::WhatIf)], Some(("try", 1)),
        "a stroke of your own, which begins as the shot that is shown, to change it and see what comes of it").known_as("adopt compare try own"),
    bind(Shot, W::Always, &[letter('y', A::NextSystem)], None,
        "diamond systems on the table: the shot's own, then the others, then none")
        .known_as("corner-5 corner five and a half plus seven count numbers learn teach"),
    bind(Shot, W::Shot, &[letter('N', A::ToggleNumbers)], Some(("numbers", 1)),
        "the shot in the thesis' numbers, or in words again").known_as("a b theta phi V impulse angle millimetres"),
    bind(Shot, W::Shot, &[letter('E', A::ToggleAllEvents)], None,
        "list all events, with rolls and stops, or contacts only").known_as("rolls slides filter"),
    bind(Shot, W::Shot, &[letter('i', A::ToggleSideView)], None, "the jump from the side: height along the path, or only the table")
        .known_as("jump hop height flight profile"),
    bind(Balls, W::Placing, &[
        key(Left, A::MoveBall(-1, 0, 1.0)), key(Down, A::MoveBall(0, -1, 1.0)),
        key(Up, A::MoveBall(0, 1, 1.0)), key(Right, A::MoveBall(1, 0, 1.0)),
        letter('h', A::MoveBall(-1, 0, 1.0)), letter('j', A::MoveBall(0, -1, 1.0)),
        letter('k', A::MoveBall(0, 1, 1.0)), letter('l', A::MoveBall(1, 0, 1.0)),
        ], Some(("move", 4)), "move the selected ball by one step").each(&[
        "move the ball left by one step", "move the ball down by one step",
        "move the ball up by one step", "move the ball right by one step",
        ]),
    bind(Balls, W::Placing, &[
        (Chord::shift(Left), A::MoveBall(-1, 0, 10.0)), (Chord::shift(Down), A::MoveBall(0, -1, 10.0)),
        (Chord::shift(Up), A::MoveBall(0, 1, 10.0)), (Chord::shift(Right), A::MoveBall(1, 0, 10.0)),
        letter('H', A::MoveBall(-1, 0, 10.0)), letter('J', A::MoveBall(0, -1, 10.0)),
        letter('K', A::MoveBall(0, 1, 10.0)), letter('L', A::MoveBall(1, 0, 10.0)),
        ], None, "move the selected ball by ten steps").each(&[
        "move the ball left by ten steps", "move the ball down by ten steps",
        "move the ball up by ten steps", "move the ball right by ten steps",
        ]),
    bind(Balls, W::Placing, &[
        (Chord::ctrl(Left), A::MoveBall(-1, 0, 0.1)), (Chord::ctrl(Down), A::MoveBall(0, -1, 0.1)),
        (Chord::ctrl(Up), A::MoveBall(0, 1, 0.1)), (Chord::ctrl(Right), A::MoveBall(1, 0, 0.1)),
        ], None, "move the selected ball by a tenth of a step").each(&[
        "move the ball left by a tenth of a step", "move the ball down by a tenth of a step",
        "move the ball up by a tenth of a step", "move the ball right by a tenth of a step",
        ]),
    bind(Balls, W::Placing, &[letter('-', A::ChangeStepSize(-1)), letter('+', A::ChangeStepSize(1)), letter('=', A::ChangeStepSize(1))],
        Some(("step", 2)), "choose a smaller or larger step").each(&["choose a smaller step", "choose a larger step"]),
    bind(Balls, W::Placing, &[letter('D', A::ToggleQuarters)], None,
        "steps of quarter diamonds, or of millimetres again").known_as("snap grid"),
    bind(Shot, W::Shot, &[letter(',', P(Event(-1))), letter('.', P(Event(1)))],
        Some(("event", 2)), "step from event to event")
        .each(&["step to the previous event", "step to the next event"]),
    bind(Shot, W::Watching, &[key(Left, P(Event(-1))), key(Right, P(Event(1)))], None,
        "step from event to event while a shot is watched")
        .each(&["step to the previous event", "step to the next event"]),
    bind(Shot, W::Watching, &[letter('-', P(Pace(-1))), letter('+', P(Pace(1))), letter('=', P(Pace(1))),
        key(Down, P(Pace(-1))), key(Up, P(Pace(1)))], Some(("speed", 2)), "play slower or faster")
        .each(&["play slower", "play faster"]),
    bind(Shot, W::Shot, &[key(Home, P(ToStart)), key(End, P(ToEnd)), letter('0', P(ToStart)), letter('$', P(ToEnd))],
        None, "to the stroke, to the end").each(&["to the stroke", "to the end of the shot"]),
    bind(Shot, W::Shot, &[letter('n', A::Continue)], Some(("go on from the end", 1)),
        "go on with the balls as the shot leaves them, with the next shot of the plan"),
    bind(Balls, W::Idle, &[letter('p', A::TypePositions)], Some(("type", 1)),
        "type where the balls lie, in diamonds or a unit of length, or a share code; pasting does it too")
        .known_as("position coordinates enter paste load import code diamonds"),
    bind(Shot, W::Idle, &[letter('R', A::NextRule), letter('S', A::NextSkill), letter('P', A::TogglePlan)],
        Some(("rule, player, plan", 3)), "choose what counts, who plays, and whether the next point counts too").each(&[
        "choose the rule: straight rail, one or three cushions", "choose the player: a level of skill",
        "plan on or off: whether the next point counts too",
        ]),
    bind(Shot, W::Idle, &[letter('B', A::NextFirstContact)], None,
        "what the cue ball must hit first: anything, the other cue ball, red, a cushion").known_as("bank rail pattern wish"),
    bind(Balls, W::Idle, &[key(Tab, A::CycleBall(1)), key(BackTab, A::CycleBall(-1)), letter('1', A::SelectBall(0)),
        letter('2', A::SelectBall(1)), letter('3', A::SelectBall(2))], Some(("ball", 1)), "select a ball: white, yellow, red").each(&[
        "select the next ball", "select the previous ball", "select the white ball", "select the yellow ball",
        "select the red ball",
        ]),
    bind(Balls, W::Undoable, &[letter('u', A::Undo)], Some(("undo", 1)), "undo the last change"),
    bind(Balls, W::Redoable, &[letter('U', A::Redo), ctrl('r', A::Redo)], Some(("redo", 1)),
        "redo the last change"),
    bind(Balls, W::Resumable, &[letter('c', A::Resume)], Some(("go on", 1)),
        "go on with the exam that was left, or from where the last session ended"),
    bind(Balls, W::Idle, &[letter('o', A::OpeningPosition)], None, "put the balls on their spots; again for the other side")
        .known_as("clear reset opening break start"),
    bind(Balls, W::Idle, &[letter('r', A::RandomPosition)], None, "random position").known_as("shuffle"),
    bind(Balls, W::Idle, &[letter('x', A::SwapCueBall)], None, "the opponent's turn: play with the other ball"),
    bind(Program, W::Always, &[letter('d', A::OpenDrills)], Some(("drills", 1)),
        "practise: exercises, exams, games, matches, and my positions").known_as("play run"),
    bind(Program, W::Always, &[letter('f', A::OpenFilms)], None, "filmed shots: watch real balls beside simulated ones"),
    bind(Balls, W::Always, &[letter('s', A::SavePosition)], None, "save the balls as a position to practise")
        .known_as("export share keep store"),
    bind(Program, W::HasPlayerName, &[letter('F', A::ToggleSharing)], None,
        "let others follow your table (carom follow NAME), or no longer").known_as("show share watch spectators live public"),
    bind(Program, W::Always, &[letter('t', A::OpenTraining)], Some(("train", 1)),
        "train agents and watch them learn"),
];

/// Key bindings while the page follows the table of another player.
#[rustfmt::skip]
pub const FOLLOW: &[Binding<A, W>] = &[
    bind(Shot, W::Shot, &[letter('N', A::ToggleNumbers)], Some(("numbers", 1)), "the shot in the thesis' numbers, or in words again")
        .known_as("a b theta phi V impulse angle millimetres"),
    bind(Shot, W::Shot, &[letter('E', A::ToggleAllEvents)], Some(("events", 1)),
        "list all events, with rolls and stops, or contacts only").known_as("rolls slides filter"),
    bind(Shot, W::Shot, &[letter('i', A::ToggleSideView)], Some(("from the side", 1)),
        "the jump from the side: height along the path, or only the table").known_as("jump hop height flight profile"),
];

/// Key bindings for the player's own stroke.
#[rustfmt::skip]
pub const OWN_STROKE: &[Binding<A, W>] = stroke_keys!(A::ChangeStroke, W::Always, [
    bind(Stroke, W::Always, &[letter(' ', P(Toggle)), key(Enter, P(Toggle))], Some(("play", 1)),
        "play and pause your stroke"),
    bind(Stroke, W::Always, &[key(Esc, A::LeaveStroke), letter('w', A::LeaveStroke)], Some(("leave", 1)),
        "leave your stroke; the coach's shot stays as it was"),
    bind(Stroke, W::Always, &[letter('n', A::Continue)], Some(("go on from the end", 1)),
        "take the balls as your stroke leaves them, for the next one"),
], [
    bind(Stroke, W::Always, &[letter('t', A::TypeStroke)], Some(("type", 1)),
        "type your stroke, or what changes of it, as players say it: red 1/2 right, 1.5 left, 2 up, 3 lengths")
        .known_as("words say fullness tips lengths aim"),
    bind(Stroke, W::StrokeUndoable, &[letter('u', A::UndoStroke), letter('z', A::UndoStroke)], Some(("undo", 1)),
        "undo the last change of the stroke"),
    bind(Stroke, W::OwnStrokePlayed, &[letter('u', A::Undo), letter('z', A::Undo)], Some(("undo", 1)), "put the balls back where your last stroke was played"),
    bind(Stroke, W::StrokeRedoable, &[letter('U', A::RedoStroke), letter('Z', A::RedoStroke), ctrl('r', A::RedoStroke)],
        Some(("redo", 1)), "redo the last change of the stroke"),
    bind(Stroke, W::Always, &[letter(',', P(Event(-1))), letter('.', P(Event(1)))], Some(("event", 2)),
        "step from event to event").each(&["step to the previous event", "step to the next event"]),
], [
    bind(Stroke, W::Always, &[key(Home, P(ToStart)), key(End, P(ToEnd)), letter('$', P(ToEnd))], None,
        "to the stroke, to the end").each(&["to the stroke", "to the end of the shot"]),
    bind(Stroke, W::Always, &[letter('<', P(Pace(-1))), letter('>', P(Pace(1)))], None, "play slower or faster")
        .each(&["play slower", "play faster"]),
    bind(Stroke, W::Always, &[letter('i', A::ToggleSideView)], None, "the jump from the side: height along the path, or only the table"),
    bind(Stroke, W::Always, &[letter('s', A::SavePosition)], None, "save the balls as a position to practise"),
    bind(Program, W::HasPlayerName, &[letter('F', A::ToggleSharing)], None, "let others follow your table (carom follow NAME), or no longer"),
]);
