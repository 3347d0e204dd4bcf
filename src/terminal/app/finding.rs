//! The command palette as the app has it: what it lists, and what each of its keys does.

use crate::terminal::{App, Command, CommandPalette, Effect, PaletteAction, app::palette::commands};

impl App {
    /// Does what an action of the command palette asks for.
    pub(super) fn find(&mut self, action: PaletteAction) -> Option<Effect> {
        let found = self
            .command_palette
            .as_ref()
            .map_or_else(Vec::new, |command_palette| command_palette.found(self.commands()));
        let Some(command_palette) = &mut self.command_palette else {
            self.command_palette = (action == PaletteAction::Open).then(CommandPalette::default);
            return None;
        };
        match action {
            PaletteAction::Open | PaletteAction::Close => self.command_palette = None,
            PaletteAction::Line(lines) => command_palette.move_mark(lines, found.len()),
            PaletteAction::Choose => {
                let command = found.get(command_palette.mark(found.len()))?;
                if let Some(reason) = self.disabled_reason(command.when) {
                    self.toasts.push(reason.to_owned(), true);
                    return None;
                }
                self.command_palette = None;
                return self.update(command.action);
            }
        }
        None
    }

    /// What can be done at the place below the command palette, what may be used now first. What one action does in several
    /// states of the page is listed once, with the words of its present state.
    pub fn commands(&self) -> Vec<Command> {
        let mut all = commands(self.place_below(), self.keys(), self.caps);
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
