//! The command palette as the app has it: what it lists, and what each of its keys does.

use super::{App, Effect};
use crate::terminal::{
    finder::{Command, Finder, commands},
    keymap::FinderAction,
};

impl App {
    /// Does what an action of the command palette asks for.
    pub(super) fn find(&mut self, action: FinderAction) -> Option<Effect> {
        let found = self.finder.as_ref().map_or_else(Vec::new, |finder| finder.found(self.commands()));
        let Some(finder) = &mut self.finder else {
            self.finder = (action == FinderAction::Open).then(Finder::default);
            return None;
        };
        match action {
            FinderAction::Open | FinderAction::Close => self.finder = None,
            FinderAction::Line(lines) => finder.move_mark(lines, found.len()),
            FinderAction::Erase => finder.erase(),
            FinderAction::Choose => {
                let command = found.get(finder.mark(found.len()))?;
                if let Some(reason) = self.refusal(command.when) {
                    self.toasts.push(reason.to_owned(), true);
                    return None;
                }
                self.finder = None;
                return self.update(command.action);
            }
        }
        None
    }

    /// What can be done at the place below the command palette, what may be used now first.
    pub fn commands(&self) -> Vec<Command> {
        let mut commands = commands(self.place_below(), self.keys(), self.look);
        commands.sort_by_key(|command| self.refusal(command.when).is_some());
        commands
    }
}
