//! The tables of keys: dispatch, the hint line and the help all read them, so that they cannot disagree.

mod coach;
mod document;
mod drills;
mod film;
mod finder;
mod section;
mod settings;
mod training;
mod words;

use crossterm::event::{
    KeyCode::{self, Char, Down, End, Enter, Esc, F, Home, PageDown, PageUp, Up},
    KeyEvent,
};

use super::{app::Screen, chord::Chord};

pub use coach::{CoachAction, CoachWhen};
pub use document::document;
pub use drills::{DrillAction, DrillPlace, DrillWhen};
pub use finder::FinderAction;
pub use section::Section;
pub use settings::{SettingsAction, SettingsPlace, SettingsWhen};
pub use training::{TrainingAction, TrainingWhen};

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
    /// Something in the command palette, or opening it.
    Finder(FinderAction),
    /// Draws the table with the next simpler set of characters.
    NextGlyphs,
    /// Shows the next of the themes.
    NextPalette,
    /// Opens a screen, where it was left.
    Open(Screen),
    /// Shows what was refused or has failed so far.
    OpenMessages,
    /// Asks under which name the balls are to be saved.
    SavePosition,
    /// Opens the list of filmed shots.
    OpenFilms,
    /// Something on the coach's screen.
    Coach(CoachAction),
    /// Something on the training screen.
    Training(TrainingAction),
    /// Something on the drill screens.
    Drill(DrillAction),
    /// Something on the settings' screen.
    Settings(SettingsAction),
}

/// When a binding may be used; the app knows whether it holds, and why not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum When {
    /// Whatever is on the screen.
    Always,
    /// While the help is open.
    Help,
    /// Where there are other screens to go to.
    Tabs,
    /// As the coach's screen says.
    Coach(CoachWhen),
    /// As the training screen says.
    Training(TrainingWhen),
    /// As the drill screens say.
    Drill(DrillWhen),
    /// As the settings' screen says.
    Settings(SettingsWhen),
}

/// What is on the screen: each has its own keys.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// The coach.
    Coach,
    /// The list of runs.
    Runs,
    /// The same, to choose one to compare with.
    Compare,
    /// The form for a new run.
    Form,
    /// A run that is watched.
    Watch,
    /// A question about a run.
    Question,
    /// A name that is typed.
    Name,
    /// One of the drill screens.
    Drill(DrillPlace),
    /// One of the settings' pages, or what is asked there.
    Settings(SettingsPlace),
    /// The command palette, over any of them.
    Finder,
}

impl Place {
    /// The pages with their names, in the order of the screens.
    pub const PAGES: [(Self, &'static str); 13] = [
        (Self::Coach, "Coach"),
        (Self::Drill(DrillPlace::Library), "Drills: library"),
        (Self::Drill(DrillPlace::Exercise), "Drills: exercise"),
        (Self::Drill(DrillPlace::Result), "Drills: result of an exam"),
        (Self::Drill(DrillPlace::Record), "Drills: record"),
        (Self::Drill(DrillPlace::Films), "Drills: filmed shots"),
        (Self::Drill(DrillPlace::Film), "Drills: a filmed shot"),
        (Self::Runs, "Training: runs"),
        (Self::Form, "Training: new run"),
        (Self::Watch, "Training: a run"),
        (Self::Compare, "Training: compare"),
        (Self::Settings(SettingsPlace::Values), "Settings"),
        (Self::Settings(SettingsPlace::Keys), "Settings: keys"),
    ];

    /// Whether `pressed` is typed there, whatever work of another key it was given.
    pub fn types(self, pressed: Chord) -> bool {
        let event = pressed.event();
        let Char(letter) = event.code else { return false };
        event.modifiers.is_empty()
            && match self {
                Self::Name
                | Self::Finder
                | Self::Drill(DrillPlace::Search | DrillPlace::Text)
                | Self::Settings(SettingsPlace::Typing) => true,
                Self::Form => letter.is_ascii_digit(),
                _ => false,
            }
    }
}

/// One line of a table.
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

const fn entry(
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

const fn ctrl(letter: char, action: Action) -> (Chord, Action) {
    (Chord::ctrl(KeyCode::Char(letter)), action)
}

use Action as A;
use Section::Program;

/// The keys of the help while it is open.
#[rustfmt::skip]
const HELP: &[Binding] = &[
    entry(Program, When::Help, &[key(Esc, A::CloseHelp), letter('?', A::CloseHelp), letter('q', A::CloseHelp),
        key(Enter, A::CloseHelp), key(F(1), A::CloseHelp)], Some(("close", 1)), "close the help"),
    entry(Program, When::Help, &[key(Down, A::ScrollHelp(1)), key(Up, A::ScrollHelp(-1)), letter('j', A::ScrollHelp(1)),
        letter('k', A::ScrollHelp(-1)), key(PageDown, A::ScrollHelp(10)), key(PageUp, A::ScrollHelp(-10)),
        key(End, A::ScrollHelp(i16::MAX)), key(Home, A::ScrollHelp(i16::MIN))], Some(("scroll", 2)), "scroll the help"),
];

/// The keys that all screens have, where letters are typed too.
#[rustfmt::skip]
const TABS: &[Binding] = &[
    entry(Program, When::Tabs, &[key(F(2), A::Open(Screen::Coach))], None, "the coach's table, as it was left"),
    entry(Program, When::Tabs, &[key(F(3), A::Open(Screen::Drills))], None, "the drills, as they were left"),
    entry(Program, When::Tabs, &[key(F(4), A::Open(Screen::Training))], None, "the training, as it was left"),
    entry(Program, When::Tabs, &[key(F(5), A::Open(Screen::Settings))], None, "the settings, and keys of your own"),
];

/// The keys that all screens have.
#[rustfmt::skip]
const PROGRAM: &[Binding] = &[
    entry(Program, When::Always, &[letter('?', A::OpenHelp), key(F(1), A::OpenHelp)], Some(("help", 1)), "open this help"),
    entry(Program, When::Always, &[key(F(6), A::OpenMessages)], None, "messages: what was refused or has failed so far"),
    finder::OPEN,
    entry(Program, When::Always, &[letter('g', A::NextGlyphs)], None, "draw with sextants, half blocks or letters"),
    entry(Program, When::Always, &[letter('T', A::NextPalette)], None, "the next theme: dark, light, high contrast, colour-blind, mono"),
    entry(Program, When::Always, &[ctrl('z', A::Suspend)], None, "back to the shell; fg continues"),
    entry(Program, When::Always, &[letter('q', A::Quit), ctrl('c', A::Quit)], Some(("quit", 1)), "quit"),
];

/// Those of them that mean nothing else where letters are answers.
#[rustfmt::skip]
const LEAVE: &[Binding] = &[
    entry(Program, When::Always, &[key(F(1), A::OpenHelp)], None, "open this help"),
    entry(Program, When::Always, &[key(F(6), A::OpenMessages)], None, "messages: what was refused or has failed so far"),
    entry(Program, When::Always, &[ctrl('z', A::Suspend)], None, "back to the shell; fg continues"),
    entry(Program, When::Always, &[ctrl('c', A::Quit)], None, "quit"),
];

/// All keys at `place`. The first enabled binding with a key wins; the hint line shows as many as fit, in this order.
pub fn bindings(place: Place) -> impl Iterator<Item = &'static Binding> {
    let own = match place {
        Place::Coach => coach::COACH,
        Place::Runs => training::RUNS,
        Place::Compare => training::COMPARE,
        Place::Form => training::FORM,
        Place::Watch => training::WATCH,
        Place::Question => training::QUESTION,
        Place::Name => training::NAME,
        Place::Drill(place) => place.bindings(),
        Place::Settings(place) => place.bindings(),
        Place::Finder => finder::FINDER,
    };
    let (help, program) = match place {
        Place::Question | Place::Name | Place::Finder => (&[][..], LEAVE),
        Place::Drill(place) if place.takes_letters() => (&[][..], LEAVE),
        Place::Settings(place) if place.takes_letters() => (&[][..], LEAVE),
        _ => (HELP, PROGRAM),
    };
    help.iter().chain(own).chain(TABS).chain(program)
}

/// The key that asks for `action` at `place`, if one does.
pub fn chord_of(place: Place, action: Action) -> Option<Chord> {
    let all = bindings(place).flat_map(|binding| binding.keys);
    all.into_iter().find(|(_, known)| *known == action).map(|(chord, _)| *chord)
}

/// The key that opens `screen` from everywhere.
pub fn chord_of_tab(screen: Screen) -> Option<Chord> {
    let all = TABS.iter().flat_map(|binding| binding.keys);
    all.into_iter().find(|(_, known)| *known == Action::Open(screen)).map(|(chord, _)| *chord)
}

/// Everything that a key does anywhere: the page's name and what it does there, in the order of the pages.
pub fn works_of(chord: Chord) -> Vec<(&'static str, &'static str)> {
    let mut works = Vec::new();
    for (place, page) in Place::PAGES {
        for binding in bindings(place).filter(|binding| binding.when != When::Help) {
            let Some((_, action)) = binding.keys.iter().find(|(known, _)| *known == chord) else { continue };
            let words = binding.words(*action);
            // What all pages have is told once.
            if works.iter().all(|(_, known)| *known != words) {
                works.push((page, words));
            }
        }
    }
    works
}

/// What `event` asks for at `place`: the first binding that may be used now, or else the reason why the last one may
/// not, since the more particular ones come first.
/// `None` where no binding has the key. `refusal` says why a binding may not be used.
pub fn find<'a>(
    event: &KeyEvent,
    place: Place,
    refusal: impl Fn(When) -> Option<&'a str>,
) -> Option<Result<Action, &'a str>> {
    let mut refused = None;
    for binding in bindings(place) {
        let Some((_, action)) = binding.keys.iter().find(|(chord, _)| chord.matches(event)) else { continue };
        match refusal(binding.when) {
            None => return Some(Ok(*action)),
            // Who has not opened the help does not press its keys.
            Some(_) if binding.when == When::Help => {}
            Some(reason) => refused = Some(Err(reason)),
        }
    }
    refused
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLACES: [Place; 8] = [
        Place::Coach,
        Place::Runs,
        Place::Compare,
        Place::Form,
        Place::Watch,
        Place::Question,
        Place::Name,
        Place::Finder,
    ];

    pub(super) fn places() -> impl Iterator<Item = Place> {
        PLACES.into_iter().chain(DrillPlace::ALL.map(Place::Drill)).chain(SettingsPlace::ALL.map(Place::Settings))
    }

    #[test]
    fn no_two_bindings_with_the_same_condition_share_a_key() {
        for place in places() {
            let all: Vec<_> = bindings(place).collect();
            for (n, one) in all.iter().enumerate() {
                for other in all[n + 1..].iter().filter(|other| other.when == one.when) {
                    for (chord, _) in one.keys {
                        let free = other.keys.iter().all(|(theirs, _)| theirs != chord);
                        assert!(free, "{place:?} {chord:?}: {}", other.description);
                    }
                }
            }
        }
    }

    #[test]
    fn a_refused_key_says_why_and_an_unknown_one_nothing() {
        let refuse_all = |_| Some("not now");
        let press = |letter| KeyEvent::from(KeyCode::Char(letter));
        assert_eq!(find(&press('u'), Place::Coach, refuse_all), Some(Err("not now")));
        assert_eq!(find(&press('u'), Place::Coach, |_| None), Some(Ok(Action::Coach(CoachAction::Undo))));
        assert_eq!(find(&press('%'), Place::Coach, refuse_all), None);
    }

    #[test]
    fn the_program_and_each_screen_can_be_left_from_everywhere() {
        let event = KeyEvent::new(KeyCode::Char('c'), crossterm::event::KeyModifiers::CONTROL);
        for place in places() {
            assert_eq!(find(&event, place, |_| None), Some(Ok(Action::Quit)), "{place:?}");
            for (number, screen) in (2..).zip(Screen::ALL) {
                let event = KeyEvent::from(KeyCode::F(number));
                assert_eq!(find(&event, place, |_| None), Some(Ok(Action::Open(screen))), "{place:?}");
            }
        }
    }

    #[test]
    fn keys_of_the_help_alone_say_nothing_while_it_is_closed() {
        let refuse_all = |_| Some("not now");
        assert_eq!(find(&KeyEvent::from(End), Place::Form, refuse_all), None);
        let end = Some(Ok(Action::ScrollHelp(i16::MAX)));
        for place in Place::PAGES.map(|(place, _)| place) {
            assert_eq!(find(&KeyEvent::from(End), place, |_| None), end, "{place:?}");
        }
    }

    #[test]
    fn letters_are_typed_where_words_are_and_digits_in_the_form() {
        let typed = |place: Place, text: &str| text.chars().filter(|letter| place.types(Chord::char(*letter))).count();
        for place in places() {
            let most = if place == Place::Form { 1 } else { 3 };
            assert!([0, most].contains(&typed(place, "z 1")), "{place:?}");
            assert!(!place.types(Chord::ctrl(Char('z'))) && !place.types(Chord::plain(Enter)), "{place:?}");
        }
        let words = [Place::Name, Place::Finder, Place::Drill(DrillPlace::Search), Place::Drill(DrillPlace::Text)];
        assert!(words.iter().all(|place| typed(*place, "z 1") == 3));
        assert_eq!(typed(Place::Settings(SettingsPlace::Typing), "z 1"), 3);
        assert_eq!((typed(Place::Form, "z 1"), typed(Place::Question, "z 1")), (1, 0));
    }

    #[test]
    fn what_a_key_does_is_told_for_every_page_and_what_all_have_once() {
        let pages = |letter| works_of(Chord::char(letter)).into_iter().map(|(page, _)| page).collect::<Vec<_>>();
        assert_eq!(pages('u'), ["Coach", "Drills: exercise"]);
        assert_eq!(works_of(Chord::char('q')).len(), 1, "quitting");
        assert!(pages('%').is_empty());
    }
}
