//! Command palette: all commands available in a context, filtered by typed words, and the handling of its own keys.

use crate::terminal::{
    Action, App, Capabilities, Condition, Effect, KeyContext, Keys,
    app::bindings::{AppBinding, listed},
    keymap::keys_text,
    pages::moved_index,
    ui::{TextField, Typed},
};

/// Longest input, bytes.
const MAX_QUERY_LENGTH: usize = 200;

/// One command of the palette.
#[derive(Clone, Debug, PartialEq)]
pub struct Command {
    /// Its keys as displayed.
    pub keys: String,
    /// What it does.
    pub description: &'static str,
    /// Description of the whole binding in the help, which may cover other commands too.
    pub group: &'static str,
    /// Its word in the hint line, or an empty text.
    pub hint: &'static str,
    /// Its section heading in the help.
    pub title: &'static str,
    /// Further search words.
    pub search_words: &'static str,
    /// The action that it runs.
    pub action: Action,
    /// Condition under which it is enabled.
    pub when: Condition,
}

impl Command {
    /// Whether all `words`, in lower case, occur in the text of this command alone.
    fn matches_name(&self, words: &[String]) -> bool {
        let Self { keys, description, title, search_words, .. } = self;
        has(&format!("{description} {title} {search_words} {keys}"), words)
    }

    /// Whether all `words` occur in the text of this command or of its whole binding.
    fn matches_text(&self, words: &[String]) -> bool {
        let Self { keys, description, group, hint, title, search_words, .. } = self;
        has(&format!("{description} {group} {hint} {title} {search_words} {keys}"), words)
    }
}

fn has(text: &str, words: &[String]) -> bool {
    let text = text.to_lowercase();
    words.iter().all(|word| text.contains(word))
}

/// The commands in `context`, one for each action of a binding.
pub fn commands(context: KeyContext, keys: &Keys, caps: Capabilities) -> Vec<Command> {
    let commands = |binding: AppBinding| {
        let all = binding.commands().into_iter().filter(|(action, ..)| *action != Action::OpenPalette);
        all.map(move |(action, description, chords)| Command {
            keys: keys_text(chords.iter().flat_map(|chord| keys.keys_for(*chord)), caps),
            description,
            group: binding.description,
            hint: binding.hint.map_or("", |(word, _)| word),
            title: binding.section.title(),
            search_words: binding.search_words,
            action,
            when: binding.when,
        })
    };
    listed(context).flat_map(commands).collect()
}

/// State of the open palette: the input and the selected row.
#[derive(Clone, Debug)]
pub struct CommandPalette {
    /// The typed text.
    pub words: TextField,
    mark: usize,
}

impl Default for CommandPalette {
    fn default() -> Self {
        Self { words: TextField::new(MAX_QUERY_LENGTH), mark: 0 }
    }
}

impl CommandPalette {
    /// Returns the commands that match all typed words, in their order. A match of the whole binding's text finds all its commands, unless
    /// some of them match on their own.
    pub fn matching(&self, mut commands: Vec<Command>) -> Vec<Command> {
        let words: Vec<String> = self.words.text().split_whitespace().map(str::to_lowercase).collect();
        let called: Vec<_> = commands.iter().filter(|one| one.matches_name(&words)).map(|one| one.group).collect();
        commands.retain(|one| one.matches_name(&words) || !called.contains(&one.group) && one.matches_text(&words));
        commands
    }

    /// Index of the selected row among `count` results; clamped, since the screen below may have changed since it was set.
    pub fn mark(&self, count: usize) -> usize {
        self.mark.min(count.saturating_sub(1))
    }

    /// Moves the selection among `count` commands by lines, down if positive.
    pub fn move_mark(&mut self, lines: isize, count: usize) {
        self.mark = moved_index(self.mark(count), lines, count);
    }

    /// Handles typed or pasted input; returns `false` if the palette does not use the key. The selection resets when the text changes.
    pub fn input(&mut self, typed: Typed) -> bool {
        let before = self.words.text().len();
        let taken = self.words.handle(typed);
        if self.words.text().len() != before {
            self.mark = 0;
        }
        taken
    }
}

impl App {
    /// The commands that match the typed words; empty while the palette is closed.
    pub(super) fn found_commands(&self) -> Vec<Command> {
        self.command_palette.as_ref().map_or_else(Vec::new, |palette| palette.matching(self.commands()))
    }

    /// Moves the palette's selection by lines, down if positive.
    pub(super) fn move_palette_mark(&mut self, lines: isize) {
        let count = self.found_commands().len();
        if let Some(palette) = &mut self.command_palette {
            palette.move_mark(lines, count);
        }
    }

    /// Runs the selected command, or reports why it is disabled.
    pub(super) fn choose_command(&mut self) -> Option<Effect> {
        let matching = self.found_commands();
        let command = matching.get(self.command_palette.as_ref()?.mark(matching.len()))?;
        if let Some(reason) = self.disabled_reason(command.when) {
            self.toasts.push(reason.to_owned(), true);
            return None;
        }
        self.command_palette = None;
        self.update(command.action)
    }

    /// The commands available below the palette, enabled ones first. An action that several states of the page offer is listed once, with
    /// the words of the present state.
    pub fn commands(&self) -> Vec<Command> {
        let mut all = commands(self.page_key_context(), self.keys(), self.caps);
        all.sort_by_key(|command| self.disabled_reason(command.when).is_some());
        let mut commands: Vec<Command> = Vec::with_capacity(all.len());
        for command in all {
            if commands.iter().all(|known| known.action != command.action) {
                commands.push(command);
            }
        }
        commands
    }
}

#[cfg(test)]
mod tests {
    use crossterm::event::KeyCode;

    use super::*;
    use crate::terminal::CoachAction;

    fn matching(typed: &str) -> Vec<Command> {
        let mut command_palette = CommandPalette::default();
        command_palette.input(Typed::Paste(typed));
        command_palette.matching(commands(KeyContext::Coach, &Keys::default(), Capabilities::NO_COLOUR))
    }

    #[test]
    fn a_search_needs_all_words_in_any_order_and_case() {
        let undo = matching("CHANGE undo last");
        assert_eq!(undo.len(), 1, "{undo:?}");
        assert_eq!((undo[0].action, undo[0].keys.as_str()), (Action::Coach(CoachAction::Undo), "u"));
        assert_eq!(matching("undo"), undo, "the word of the hint line is known as well");
        assert!(matching("undo nonsense").is_empty());
        assert!(matching("ctrl-r").iter().all(|command| command.keys.contains("Ctrl-r")));
        let is_placing = |command: &Command| format!("{} {}", command.title, command.description).contains("lacing");
        assert!(matching("placing").iter().all(is_placing));
    }

    #[test]
    fn each_action_of_a_binding_is_listed_with_its_keys() {
        let keys: Vec<_> = matching("by one step").into_iter().map(|command| command.keys).collect();
        assert_eq!(keys, ["← h", "↓ j", "↑ k", "→ l"]);
    }

    #[test]
    fn an_action_of_a_binding_is_found_by_its_own_description() {
        let keys = |typed| matching(typed).into_iter().map(|command| command.keys).collect::<Vec<_>>();
        assert_eq!(keys("smaller step"), ["-"]);
        assert_eq!(keys("yellow"), ["2", "2"], "before a shot is watched, and from it");
        assert_eq!(keys("player"), ["S", "F8"], "the glossary has the player's words");
        assert_eq!(keys("white yellow"), ["Tab", "Shift-Tab", "1", "2", "3"], "by what they do together");
    }

    #[test]
    fn the_palette_does_not_list_itself() {
        assert!(matching("").iter().all(|command| command.action != Action::OpenPalette));
    }

    #[test]
    fn the_selection_stays_within_the_matches() {
        let mut command_palette = CommandPalette::default();
        command_palette.move_mark(isize::MAX, 4);
        assert_eq!(command_palette.mark(4), 3);
        assert_eq!(command_palette.mark(2), 1);
        command_palette.move_mark(-1, 2);
        assert_eq!(command_palette.mark(9), 0);
        command_palette.move_mark(5, 0);
        assert_eq!(command_palette.mark(0), 0);
        command_palette.move_mark(1, 3);
        command_palette.input(Typed::Key(&KeyCode::Left.into()));
        assert_eq!(command_palette.mark(3), 1, "moving the cursor finds nothing else");
        command_palette.input(Typed::Paste("x\n"));
        assert_eq!((command_palette.mark(3), command_palette.words.text()), (0, "x"));
    }
}
