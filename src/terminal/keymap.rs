//! The one table of keys: dispatch, the hint line and the help all read it, so that they cannot disagree.

use crossterm::event::{KeyCode, KeyEvent};

use super::chord::Chord;

/// What a key does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Action {
    /// Ends the program.
    Quit,
    /// Stops the program until the shell continues it.
    Suspend,
    /// Opens the help.
    OpenHelp,
    /// Closes the help.
    CloseHelp,
    /// Scrolls the help by lines, down where positive.
    ScrollHelp(i16),
    /// Draws the table with the next simpler set of characters.
    NextGlyphs,
    /// Selects a ball.
    Select(usize),
    /// Selects the next ball.
    SelectNext,
    /// Selects the ball before.
    SelectPrevious,
    /// Moves the selected ball: steps to the right and up, and how large a step is against the chosen one.
    Move(i8, i8, f64),
    /// Chooses a larger step.
    LargerStep,
    /// Chooses a smaller step.
    SmallerStep,
    /// Puts the balls on their spots.
    Opening,
    /// Puts the balls anywhere.
    Random,
    /// Takes the last change of the balls back.
    Undo,
    /// Makes it again.
    Redo,
    /// Asks the coach.
    Recommend,
    /// Stops asking.
    Cancel,
    /// Plays or pauses the shot.
    PlayPause,
    /// Steps to the next event.
    NextEvent,
    /// Steps to the event before.
    PreviousEvent,
    /// Goes to the stroke.
    ToStart,
    /// Goes to where the balls lie still.
    ToEnd,
    /// Plays faster.
    Faster,
    /// Plays slower.
    Slower,
    /// Leaves the shot, to move balls again.
    PlaceBalls,
    /// Takes the balls as the shot leaves them.
    Continue,
}

/// When a binding may be used; the app knows whether it holds, and why not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum When {
    /// Whatever is on the screen.
    Always,
    /// While the help is open.
    Help,
    /// On the table, while the coach is not thinking.
    Idle,
    /// While balls are placed.
    Placing,
    /// While a shot is watched.
    Watching,
    /// Where a shot is there.
    Shot,
    /// While the coach thinks.
    Thinking,
    /// Where a change can be taken back.
    Undoable,
    /// Where a change was taken back.
    Redoable,
}

/// Headings of the help, in its order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Section {
    /// Keys that move balls.
    Balls,
    /// Keys that ask the coach and play the shot.
    Shot,
    /// All others.
    Program,
}

/// One line of the table.
#[derive(Debug)]
pub struct Binding {
    /// The keys, each with what it does.
    pub keys: &'static [(Chord, Action)],
    /// Its word in the hint line, and how many of the keys stand before it there.
    pub hint: Option<(&'static str, usize)>,
    /// What the help says.
    pub description: &'static str,
    /// When it may be used.
    pub when: When,
    /// Its heading in the help.
    pub section: Section,
}

impl Section {
    /// All headings, in the help's order.
    pub const ALL: [Self; 3] = [Self::Balls, Self::Shot, Self::Program];

    /// The heading.
    pub const fn title(self) -> &'static str {
        match self {
            Self::Balls => "Placing the balls",
            Self::Shot => "The shot",
            Self::Program => "The program",
        }
    }
}

const fn bind(
    section: Section,
    when: When,
    keys: &'static [(Chord, Action)],
    hint: Option<(&'static str, usize)>,
    description: &'static str,
) -> Binding {
    Binding { keys, hint, description, when, section }
}

const fn key(code: KeyCode, action: Action) -> (Chord, Action) {
    (Chord::plain(code), action)
}

const fn letter(letter: char, action: Action) -> (Chord, Action) {
    (Chord::char(letter), action)
}

use Action as A;
use KeyCode::{BackTab, Down, End, Enter, Esc, F, Home, Left, PageDown, PageUp, Right, Tab, Up};
use Section::{Balls, Program, Shot};

/// All keys. The first enabled binding with a key wins; the hint line shows as many as fit, in this order.
#[rustfmt::skip]
pub const BINDINGS: &[Binding] = &[
    bind(Program, When::Help, &[key(Esc, A::CloseHelp), letter('?', A::CloseHelp), letter('q', A::CloseHelp),
        key(Enter, A::CloseHelp), key(F(1), A::CloseHelp)], Some(("close", 1)), "close the help"),
    bind(Program, When::Help, &[key(Down, A::ScrollHelp(1)), key(Up, A::ScrollHelp(-1)), letter('j', A::ScrollHelp(1)),
        letter('k', A::ScrollHelp(-1)), key(PageDown, A::ScrollHelp(10)), key(PageUp, A::ScrollHelp(-10))],
        Some(("scroll", 2)), "scroll the help"),

    bind(Shot, When::Thinking, &[key(Esc, A::Cancel)], Some(("cancel", 1)), "stop the coach's thinking"),
    bind(Shot, When::Idle, &[key(Enter, A::Recommend)], Some(("recommend", 1)), "ask the coach for a shot"),
    bind(Shot, When::Shot, &[letter(' ', A::PlayPause)], Some(("play", 1)), "play and pause the shot"),
    bind(Balls, When::Placing, &[
        key(Left, A::Move(-1, 0, 1.0)), key(Down, A::Move(0, -1, 1.0)),
        key(Up, A::Move(0, 1, 1.0)), key(Right, A::Move(1, 0, 1.0)),
        letter('h', A::Move(-1, 0, 1.0)), letter('j', A::Move(0, -1, 1.0)),
        letter('k', A::Move(0, 1, 1.0)), letter('l', A::Move(1, 0, 1.0)),
        ], Some(("move", 4)), "move the selected ball by one step"),
    bind(Balls, When::Placing, &[
        (Chord::shift(Left), A::Move(-1, 0, 10.0)), (Chord::shift(Down), A::Move(0, -1, 10.0)),
        (Chord::shift(Up), A::Move(0, 1, 10.0)), (Chord::shift(Right), A::Move(1, 0, 10.0)),
        letter('H', A::Move(-1, 0, 10.0)), letter('J', A::Move(0, -1, 10.0)),
        letter('K', A::Move(0, 1, 10.0)), letter('L', A::Move(1, 0, 10.0)),
        ], None, "the same by ten steps"),
    bind(Balls, When::Placing, &[
        (Chord::ctrl(Left), A::Move(-1, 0, 0.1)), (Chord::ctrl(Down), A::Move(0, -1, 0.1)),
        (Chord::ctrl(Up), A::Move(0, 1, 0.1)), (Chord::ctrl(Right), A::Move(1, 0, 0.1)),
        ], None, "the same by a tenth of a step"),
    bind(Balls, When::Placing, &[letter('-', A::SmallerStep), letter('+', A::LargerStep), letter('=', A::LargerStep)],
        Some(("step", 2)), "choose a smaller or larger step"),
    bind(Shot, When::Watching, &[key(Esc, A::PlaceBalls), letter('e', A::PlaceBalls)], Some(("place balls", 1)),
        "back to the balls as they were"),
    bind(Shot, When::Shot, &[letter(',', A::PreviousEvent), letter('.', A::NextEvent)],
        Some(("event", 2)), "step from event to event"),
    bind(Shot, When::Watching, &[key(Left, A::PreviousEvent), key(Right, A::NextEvent)], None,
        "the same while a shot is watched"),
    bind(Shot, When::Watching, &[letter('-', A::Slower), letter('+', A::Faster), letter('=', A::Faster),
        key(Down, A::Slower), key(Up, A::Faster)], Some(("speed", 2)), "play slower or faster"),
    bind(Shot, When::Shot, &[key(Home, A::ToStart), key(End, A::ToEnd), letter('0', A::ToStart), letter('$', A::ToEnd)],
        None, "to the stroke, to the end"),
    bind(Shot, When::Shot, &[letter('n', A::Continue)], Some(("go on from the end", 1)),
        "go on with the balls as the shot leaves them"),
    bind(Balls, When::Idle, &[key(Tab, A::SelectNext), key(BackTab, A::SelectPrevious), letter('1', A::Select(0)),
        letter('2', A::Select(1)), letter('3', A::Select(2))], Some(("ball", 1)), "select a ball: white, yellow, red"),
    bind(Balls, When::Undoable, &[letter('u', A::Undo)], Some(("undo", 1)), "take the last change back"),
    bind(Balls, When::Redoable, &[letter('U', A::Redo), (Chord::ctrl(KeyCode::Char('r')), A::Redo)], Some(("redo", 1)),
        "make it again"),
    bind(Balls, When::Idle, &[letter('o', A::Opening)], None, "put the balls on their spots"),
    bind(Balls, When::Idle, &[letter('r', A::Random)], None, "put the balls anywhere"),

    bind(Program, When::Always, &[letter('?', A::OpenHelp), key(F(1), A::OpenHelp)], Some(("help", 1)), "open this help"),
    bind(Program, When::Always, &[letter('g', A::NextGlyphs)], None,
        "draw with sextants, half blocks or letters"),
    bind(Program, When::Always, &[(Chord::ctrl(KeyCode::Char('z')), A::Suspend)], None, "back to the shell; fg continues"),
    bind(Program, When::Always, &[letter('q', A::Quit), (Chord::ctrl(KeyCode::Char('c')), A::Quit)], Some(("quit", 1)),
        "quit"),
];

/// What `event` asks for: the first binding that may be used now, or else the reason why the last one may not, since the
/// more particular ones come first.
/// `None` where no binding has the key. `refusal` says why a binding may not be used.
pub fn find<'a>(event: &KeyEvent, refusal: impl Fn(When) -> Option<&'a str>) -> Option<Result<Action, &'a str>> {
    let mut refused = None;
    for binding in BINDINGS {
        let Some((_, action)) = binding.keys.iter().find(|(chord, _)| chord.matches(event)) else { continue };
        match refusal(binding.when) {
            None => return Some(Ok(*action)),
            Some(reason) => refused = Some(Err(reason)),
        }
    }
    refused
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_bindings_with_the_same_condition_share_a_key() {
        for (n, one) in BINDINGS.iter().enumerate() {
            for other in BINDINGS[n + 1..].iter().filter(|other| other.when == one.when) {
                for (chord, _) in one.keys {
                    assert!(other.keys.iter().all(|(theirs, _)| theirs != chord), "{chord:?}: {}", other.description);
                }
            }
        }
    }

    #[test]
    fn a_refused_key_says_why_and_an_unknown_one_nothing() {
        let refuse_all = |_| Some("not now");
        let press = |letter| KeyEvent::from(KeyCode::Char(letter));
        assert_eq!(find(&press('u'), refuse_all), Some(Err("not now")));
        assert_eq!(find(&press('u'), |_| None), Some(Ok(Action::Undo)));
        assert_eq!(find(&press('%'), refuse_all), None);
    }
}
