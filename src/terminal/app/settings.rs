//! What is set holds at once.

use super::{App, Effect};
use crate::terminal::{
    look::{Depth, Glyphs, Look},
    settings::{Settings, SettingsReport},
    theme::{Palette, Theme},
};

impl App {
    /// Does what has been set otherwise on the settings' screen, and passes on what brings it into the file.
    pub(super) fn set(&mut self, effect: Option<Effect>) -> Option<Effect> {
        self.take_changes();
        effect
    }

    /// Something has come of what the settings' screen wanted of the file.
    pub fn receive_settings(&mut self, report: SettingsReport) {
        for trouble in self.settings.receive(report) {
            self.toasts.push(trouble, false);
        }
        self.take_changes();
    }

    fn take_changes(&mut self) {
        if self.settings.settings == self.in_force {
            return;
        }
        let settings = self.settings.settings.clone();
        let before = std::mem::replace(&mut self.in_force, settings.clone());
        if let Err(sentence) = self.coach.take_changes(&before, &settings) {
            self.toasts.push(sentence, false);
        }
        self.mouse = settings.mouse;
        let looks = |settings: &Settings| (settings.palette, settings.depth, settings.glyphs);
        if looks(&before) != looks(&settings) {
            self.full_look = self.detect.map_or(self.full_look, |detect| detect(&settings));
            self.finest = self.full_look.finest();
            self.choose_palette(settings.palette);
        }
    }

    /// Draws with these colours from now on.
    pub(super) fn choose_palette(&mut self, palette: Palette) {
        self.palette = palette;
        let mono = Look { depth: Depth::Mono, glyphs: Glyphs::Letters, ..self.full_look };
        self.look = if palette == Palette::Mono { mono } else { self.full_look };
        self.theme = Theme::of(palette, self.look.depth);
    }
}
