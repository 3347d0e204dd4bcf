//! All key bindings of the program: the tables of all pages, converted to one action type, plus the keys that all pages share.

use crossterm::event::{
    KeyCode::{Down, Enter, Esc, F, PageDown, PageUp, Up},
    KeyEvent,
};

use crate::terminal::{
    CalibrationAction, CalibrationCondition, CoachAction, CoachCondition, DrillAction, DrillCondition, KeyContext,
    PageId, SettingsAction, SettingsCondition, TrainingAction, TrainingCondition,
    keymap::{
        Binding, Chord, KeyEntry, KeyPage,
        Section::{self, Program},
        bind, chord_of, ctrl, key, letter, lines,
    },
    pages::coach::keys as coach,
};

use Action as A;

/// Action of a key.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Action {
    /// Ends the program.
    Quit,
    /// Suspends the program until the shell continues it.
    Suspend,
    /// Opens the help.
    OpenHelp,
    /// Closes the overlay.
    CloseOverlay,
    /// Scrolls the overlay by lines, down if positive.
    ScrollOverlay(isize),
    /// Opens the command palette.
    OpenPalette,
    /// Closes the command palette.
    ClosePalette,
    /// Runs the selected command of the palette.
    ChooseCommand,
    /// Moves the palette's selection by lines, down if positive.
    PaletteLine(isize),
    /// Draws the table with the next simpler set of characters.
    NextGlyphs,
    /// Switches to the next theme.
    NextTheme,
    /// Opens a screen in the state in which it was left.
    Open(PageId),
    /// Answers the page's question: yes, or the typed text; or no.
    Answer(bool),
    /// Shows all refusals and failures so far.
    OpenMessages,
    /// Opens the glossary of players' terms.
    OpenGlossary,
    /// Continues an open match against the coach, or lets the user choose another.
    OpenMatch,
    /// An action of the coach's screen.
    Coach(CoachAction),
    /// An action of the training screen.
    Training(TrainingAction),
    /// An action of the drill screens.
    Drill(DrillAction),
    /// An action of the settings screen.
    Settings(SettingsAction),
    /// An action of the calibration screen.
    Calibration(CalibrationAction),
}

/// Condition under which a binding is enabled. The app evaluates it and gives the reason if it does not hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Condition {
    /// Always enabled.
    Always,
    /// A shell can take the terminal back and continue the program later.
    Shell,
    /// An overlay is open.
    Overlay,
    /// There are other screens to open.
    Tabs,
    /// A condition of the coach's screen.
    Coach(CoachCondition),
    /// A condition of the training screen.
    Training(TrainingCondition),
    /// A condition of the drill screens.
    Drill(DrillCondition),
    /// A condition of the settings screen.
    Settings(SettingsCondition),
    /// A condition of the calibration screen.
    Calibration(CalibrationCondition),
}

/// One row of a page's key table, converted to the app's types.
#[derive(Debug)]
pub struct AppBinding {
    /// The keys, each with its action and the words for it.
    pub keys: Vec<(Chord, Action, &'static str)>,
    /// The word in the hint line, and the number of keys shown before it there.
    pub hint: Option<(&'static str, usize)>,
    /// Description in the help.
    pub description: &'static str,
    /// Condition under which it is enabled.
    pub when: Condition,
    /// Section of the help.
    pub section: Section,
    /// Further search words for the command palette.
    pub search_words: &'static str,
}

impl AppBinding {
    /// The distinct actions of the binding, in order, each with its words and keys.
    pub fn commands(&self) -> Vec<(Action, &'static str, Vec<Chord>)> {
        let mut commands: Vec<(Action, &'static str, Vec<Chord>)> = Vec::new();
        for (chord, action, words) in &self.keys {
            match commands.iter_mut().find(|(known, ..)| known == action) {
                Some((.., chords)) => chords.push(*chord),
                None => commands.push((*action, words, vec![*chord])),
            }
        }
        commands
    }
}

/// Appends the rows of a page's table.
fn append<B: Copy + PartialEq, W: Copy>(
    all: &mut Vec<AppBinding>,
    table: &[Binding<B, W>],
    action: fn(B) -> Action,
    when: fn(W) -> Condition,
) {
    all.extend(table.iter().map(|binding| {
        let mut actions: Vec<B> = Vec::new();
        let mut words = |of: B| {
            let index = actions.iter().position(|known| *known == of).unwrap_or_else(|| {
                actions.push(of);
                actions.len() - 1
            });
            binding.each.get(index).copied().unwrap_or(binding.description)
        };
        AppBinding {
            keys: binding.keys.iter().map(|(chord, of)| (*chord, action(*of), words(*of))).collect(),
            hint: binding.hint,
            description: binding.description,
            when: when(binding.when),
            section: binding.section,
            search_words: binding.search_words,
        }
    }));
}

/// The keys of an overlay, enabled while one is open.
#[rustfmt::skip]
const OVERLAY: &[Binding<Action, Condition>] = &[
    bind(Program, Condition::Overlay, &[key(Esc, A::CloseOverlay), letter('?', A::CloseOverlay), letter('q', A::CloseOverlay),
        key(Enter, A::CloseOverlay)], Some(("close", 1)), "close this page"),
    bind(Program, Condition::Overlay, &[key(F(1), A::OpenHelp), key(F(6), A::OpenMessages), key(F(8), A::OpenGlossary)], None,
        "open the help, the messages or the glossary instead; the same key closes it"),
    bind(Program, Condition::Overlay, lines!(A::ScrollOverlay), Some(("scroll", 2)), "scroll this page"),
];

/// The keys of the command palette.
#[rustfmt::skip]
const PALETTE: &[Binding<Action, Condition>] = &[
    bind(Program, Condition::Always, &[key(Enter, A::ChooseCommand)], Some(("do it", 1)), "run the selected command"),
    bind(Program, Condition::Always, &[key(Down, A::PaletteLine(1)), key(Up, A::PaletteLine(-1)), key(PageDown, A::PaletteLine(10)),
        key(PageUp, A::PaletteLine(-10))], Some(("choose", 2)), "select another command")
        .each(&["select the next command", "select the previous command", "go down by ten commands", "go up by ten commands"]),
    bind(Program, Condition::Always, &[key(Esc, A::ClosePalette), ctrl('p', A::ClosePalette)], Some(("close", 1)), "close the list"),
];

/// The keys of a yes-or-no question.
#[rustfmt::skip]
const QUESTION: &[Binding<Action, Condition>] = &[
    bind(Program, Condition::Always, &[letter('y', A::Answer(true))], Some(("yes", 1)), "yes"),
    bind(Program, Condition::Always, &[letter('n', A::Answer(false)), key(Esc, A::Answer(false)), letter('q', A::Answer(false))], Some(("no", 1)), "no"),
];

/// The keys of a question with a typed answer.
#[rustfmt::skip]
const TYPED: &[Binding<Action, Condition>] = &[
    bind(Program, Condition::Always, &[key(Enter, A::Answer(true))], Some(("take it", 1)), "accept the typed text"),
    bind(Program, Condition::Always, &[key(Esc, A::Answer(false))], Some(("cancel", 1)), "cancel"),
];

/// The keys that all screens share, even where letters are typed.
#[rustfmt::skip]
const TABS: &[Binding<Action, Condition>] = &[
    bind(Program, Condition::Tabs, &[key(F(2), A::Open(PageId::Coach))], None, "the coach's table, as it was left"),
    bind(Program, Condition::Tabs, &[key(F(3), A::Open(PageId::Drills))], None, "the drills, as they were left"),
    bind(Program, Condition::Tabs, &[key(F(4), A::Open(PageId::Training))], None, "the training, as it was left"),
    bind(Program, Condition::Tabs, &[key(F(5), A::Open(PageId::Settings))], None, "the settings, and keys of your own"),
    bind(Program, Condition::Tabs, &[key(F(7), A::Open(PageId::Calibration))], None, "measure the table that you play on")
        .known_as("calibration calibrate tests"),
    bind(Program, Condition::Tabs, &[key(F(9), A::OpenMatch)], None, "a match against the coach: go on with it, or choose another")
        .known_as("game opponent play"),
];

/// The key of the glossary.
const GLOSSARY: Binding<Action, Condition> = bind(
    Program,
    Condition::Always,
    &[key(F(8), A::OpenGlossary)],
    None,
    "the glossary: what the words of players mean",
)
.known_as("words terms average tip clock fullness ticky plus natural running reverse lag");

/// The keys that all screens share.
#[rustfmt::skip]
const PROGRAM: &[Binding<Action, Condition>] = &[
    bind(Program, Condition::Always, &[letter('?', A::OpenHelp), key(F(1), A::OpenHelp)], Some(("help", 1)), "open this help"),
    bind(Program, Condition::Always, &[key(F(6), A::OpenMessages)], None, "messages: refusals and failures so far"),
    GLOSSARY,
    bind(Program, Condition::Always, &[letter(':', A::OpenPalette), ctrl('p', A::OpenPalette)], Some(("commands", 1)),
        "open the command palette: find and run a command"),
    bind(Program, Condition::Always, &[letter('g', A::NextGlyphs)], None, "draw with sextants, half blocks or letters"),
    bind(Program, Condition::Always, &[letter('T', A::NextTheme)], None, "the next theme: dark, light, high contrast, colour-blind, mono"),
    bind(Program, Condition::Shell, &[ctrl('z', A::Suspend)], None, "back to the shell; fg continues"),
    bind(Program, Condition::Always, &[letter('q', A::Quit), ctrl('c', A::Quit)], Some(("quit", 1)), "quit"),
];

/// The program keys that remain where letters are typed or are answers.
#[rustfmt::skip]
const LEAVE: &[Binding<Action, Condition>] = &[
    bind(Program, Condition::Always, &[key(F(1), A::OpenHelp)], None, "open this help"),
    bind(Program, Condition::Always, &[key(F(6), A::OpenMessages)], None, "messages: refusals and failures so far"),
    GLOSSARY,
    bind(Program, Condition::Shell, &[ctrl('z', A::Suspend)], None, "back to the shell; fg continues"),
    bind(Program, Condition::Always, &[ctrl('c', A::Quit)], None, "quit"),
];

/// All bindings in `context`. The first enabled binding of a key wins; the hint line shows as many as fit, in this order.
pub fn bindings(context: KeyContext) -> Vec<AppBinding> {
    let mut all = Vec::new();
    let program = |all: &mut Vec<AppBinding>, table| append(all, table, |action| action, |when| when);
    let (overlay, leave) = match context {
        _ if context.takes_letters() => (&[][..], LEAVE),
        _ => (OVERLAY, PROGRAM),
    };
    program(&mut all, overlay);
    match context {
        KeyContext::Coach => append(&mut all, coach::COACH, A::Coach, Condition::Coach),
        KeyContext::OwnStroke => append(&mut all, coach::OWN_STROKE, A::Coach, Condition::Coach),
        KeyContext::Follow => append(&mut all, coach::FOLLOW, A::Coach, Condition::Coach),
        KeyContext::Question { is_typed } => program(&mut all, if is_typed { TYPED } else { QUESTION }),
        KeyContext::Training(context) => append(&mut all, context.bindings(), A::Training, Condition::Training),
        KeyContext::Drill(context) => append(&mut all, context.bindings(), A::Drill, Condition::Drill),
        KeyContext::Settings(context) => append(&mut all, context.bindings(), A::Settings, Condition::Settings),
        KeyContext::Calibration(context) => {
            append(&mut all, context.bindings(), A::Calibration, Condition::Calibration);
        }
        KeyContext::CommandPalette => program(&mut all, PALETTE),
    }
    program(&mut all, TABS);
    program(&mut all, leave);
    all
}

/// All bindings in `context` except those of overlays, for lists of keys.
pub fn listed(context: KeyContext) -> impl Iterator<Item = AppBinding> {
    bindings(context).into_iter().filter(|binding| binding.when != Condition::Overlay)
}

/// The bindings of each page, for lists of keys.
pub fn key_pages() -> Vec<KeyPage> {
    KeyContext::PAGES.iter().map(|(context, name)| KeyPage { name, entries: entries(*context) }).collect()
}

fn entries(context: KeyContext) -> Vec<KeyEntry> {
    let entries = |binding: AppBinding| {
        binding.commands().into_iter().map(move |(_, words, chords)| KeyEntry {
            chords,
            words,
            section: binding.section,
        })
    };
    listed(context).flat_map(entries).collect()
}

/// The key that opens `screen` from any page.
pub fn chord_of_tab(screen: PageId) -> Option<Chord> {
    chord_of(TABS, &Action::Open(screen))
}

/// Finds the action of `event` in `context`: that of the first enabled binding. If none is enabled, returns the reason of the
/// last one, because the more specific bindings come first. `None` if no binding has the key. `disabled_reason` returns why a condition
/// does not hold.
pub fn find<'a>(
    event: &KeyEvent,
    context: KeyContext,
    disabled_reason: impl Fn(Condition) -> Option<&'a str>,
) -> Option<Result<Action, &'a str>> {
    let mut refused = None;
    for binding in bindings(context) {
        let Some((_, action, _)) = binding.keys.iter().find(|(chord, ..)| chord.matches(event)) else { continue };
        match disabled_reason(binding.when) {
            None => return Some(Ok(*action)),
            // While no overlay is open, its keys are ignored.
            Some(_) if binding.when == Condition::Overlay => {}
            Some(reason) => refused = Some(Err(reason)),
        }
    }
    refused
}

#[cfg(test)]
mod tests {
    use crossterm::event::KeyCode::{Char, End};

    use super::*;
    use crate::terminal::{CalibrationContext, DrillContext, SettingsContext, TrainingContext, keymap::commands_of};

    fn contexts() -> impl Iterator<Item = KeyContext> {
        let over = [
            KeyContext::CommandPalette,
            KeyContext::Question { is_typed: true },
            KeyContext::Question { is_typed: false },
            KeyContext::Drill(DrillContext::Search),
            KeyContext::Settings(SettingsContext::Pressing),
            KeyContext::Calibration(CalibrationContext::Marks),
        ];
        KeyContext::PAGES.into_iter().map(|(page, _)| page).chain(over)
    }

    #[test]
    fn no_two_bindings_with_the_same_condition_share_a_key() {
        for context in contexts() {
            let all = bindings(context);
            for (n, one) in all.iter().enumerate() {
                for other in all[n + 1..].iter().filter(|other| other.when == one.when) {
                    for (chord, ..) in &one.keys {
                        let free = other.keys.iter().all(|(theirs, ..)| theirs != chord);
                        assert!(free, "{context:?} {chord:?}: {}", other.description);
                    }
                }
            }
        }
    }

    #[test]
    fn a_refused_key_has_a_reason_and_an_unknown_one_none() {
        let refuse_all = |_| Some("not now");
        let press = |letter| KeyEvent::from(Char(letter));
        assert_eq!(find(&press('u'), KeyContext::Coach, refuse_all), Some(Err("not now")));
        assert_eq!(find(&press('u'), KeyContext::Coach, |_| None), Some(Ok(Action::Coach(CoachAction::Undo))));
        assert_eq!(find(&press('%'), KeyContext::Coach, refuse_all), None);
    }

    #[test]
    fn the_program_and_each_screen_can_be_left_in_every_context() {
        let event = KeyEvent::new(Char('c'), crossterm::event::KeyModifiers::CONTROL);
        for context in contexts() {
            assert_eq!(find(&event, context, |_| None), Some(Ok(Action::Quit)), "{context:?}");
            for screen in PageId::ALL {
                let event = chord_of_tab(screen).unwrap().event();
                assert_eq!(find(&event, context, |_| None), Some(Ok(Action::Open(screen))), "{context:?}");
            }
        }
    }

    #[test]
    fn overlay_keys_are_silent_without_an_overlay() {
        let refuse_all = |_| Some("not now");
        assert_eq!(find(&KeyEvent::from(End), KeyContext::Training(TrainingContext::Form), refuse_all), None);
        let end = Some(Ok(Action::ScrollOverlay(isize::MAX)));
        for context in KeyContext::PAGES.map(|(context, _)| context) {
            assert_eq!(find(&KeyEvent::from(End), context, |_| None), end, "{context:?}");
        }
    }

    #[test]
    fn letters_are_typed_in_text_fields_and_digits_in_the_form() {
        let typed =
            |context: KeyContext, text: &str| text.chars().filter(|letter| context.types(Chord::char(*letter))).count();
        for context in contexts() {
            let most = if context == KeyContext::Training(TrainingContext::Form) { 1 } else { 3 };
            assert!([0, most].contains(&typed(context, "z 1")), "{context:?}");
            assert!(!context.types(Chord::ctrl(Char('z'))) && !context.types(Chord::plain(Enter)), "{context:?}");
        }
        let words = [
            KeyContext::Question { is_typed: true },
            KeyContext::CommandPalette,
            KeyContext::Drill(DrillContext::Search),
            KeyContext::Calibration(CalibrationContext::Marks),
        ];
        assert!(words.iter().all(|context| typed(*context, "z 1") == 3));
        assert_eq!(typed(KeyContext::Training(TrainingContext::Form), "z 1"), 1);
        assert_eq!(typed(KeyContext::Question { is_typed: false }, "z 1"), 0);
    }

    #[test]
    fn no_binding_uses_a_key_of_typed_text() {
        for context in contexts().filter(|context| context.types(Chord::char('z'))) {
            for (chord, ..) in bindings(context).into_iter().flat_map(|binding| binding.keys) {
                assert!(!context.types(chord), "{context:?}: {chord:?} is typed, and never comes to the binding");
            }
        }
    }

    #[test]
    fn help_lists_page_keys_per_page_and_common_keys_once() {
        let all = key_pages();
        let pages =
            |letter| commands_of(&all, Chord::char(letter)).into_iter().map(|(page, _)| page).collect::<Vec<_>>();
        // With the player's own stroke open, the key first undoes changes of the stroke, then those of the balls.
        assert_eq!(pages('u'), ["Coach", "Coach: your stroke", "Coach: your stroke", "Drills: exercise"]);
        assert_eq!(commands_of(&all, Chord::char('q')).len(), 1, "quitting");
        assert!(pages('%').is_empty());
    }

    #[test]
    fn no_two_commands_of_a_context_have_the_same_description() {
        for context in contexts() {
            for binding in listed(context) {
                for (_, action, words) in &binding.keys {
                    let same = listed(context)
                        .flat_map(|binding| binding.keys)
                        .find(|(_, other, its)| its == words && other != action);
                    assert!(same.is_none(), "{context:?}: {words}: {action:?} and {same:?}");
                }
            }
        }
    }
}
