//! Applying changed settings at once, and showing what keys have changed for this session only on the settings screen.

use std::path::PathBuf;

use crate::{
    table::{PRESETS, Table},
    terminal::{
        App, Capabilities, CoachQuery, Depth, Effect, Glyphs, Settings, SettingsReport, ThemeName,
        pages::neighbour,
        ui::{Message, Theme},
    },
};

impl App {
    /// Handles the report of a task on the settings file.
    pub fn receive_settings(&mut self, report: SettingsReport) -> Option<Effect> {
        let troubles = self.settings.receive(report);
        self.toasts.push_first(&troubles);
        self.apply_changed_settings();
        let path = self.pending_table.take()?;
        let effect = self.settings.choose("table", &path.to_string_lossy());
        self.apply_changed_settings();
        if effect.is_some()
            && let Ok(table) = self.in_force.table()
        {
            // The table may be another one of the same name, in which case no setting has changed.
            self.coach.set_table(&table);
            self.calibration.set_table(&table);
            let how_long = if self.settings.is_writable { ", at every start too" } else { " until the program ends" };
            let said = format!("you now play on {}{how_long}", table.name);
            self.calibration.message = Some(Message::good(said));
        }
        self.collect_toasts(false);
        effect
    }

    /// Plays on the table in this file from now on, once the settings file has been read again.
    pub(super) fn use_table(&mut self, path: PathBuf) -> Effect {
        self.pending_table = Some(path);
        self.show_session();
        self.settings.open()
    }

    /// Applies the changes made on the settings screen.
    pub(super) fn apply_changed_settings(&mut self) {
        if self.settings.settings == self.in_force {
            return;
        }
        let settings = self.settings.settings.clone();
        let before = std::mem::replace(&mut self.in_force, settings.clone());
        if let Err(sentence) = self.coach.apply_changed_settings(&before, &settings) {
            self.toasts.push(sentence, false);
        }
        self.drills.apply_settings(&settings);
        self.calibration.units = settings.units;
        self.mouse = settings.mouse;
        let display = |settings: &Settings| (settings.depth, settings.glyphs);
        if display(&before) != display(&settings) {
            self.full_caps = self.detect.map_or(self.full_caps, |detect| detect(&settings));
            self.finest = self.full_caps.finest();
        }
        self.choose_theme(settings.theme);
    }

    /// Copies what keys of other screens have changed into the settings screen, without applying anything.
    pub(super) fn show_session(&mut self) {
        let CoachQuery { rule, skill, plan, .. } = self.coach.query;
        let (step_mm, speed) = (self.coach.step_mm(), self.coach.playback.speed());
        let settings = Settings { theme: self.theme_name, rule, skill, plan, step_mm, speed, ..self.in_force.clone() };
        let is_played = |table: Result<Table, _>| table.is_ok_and(|table| table == *self.coach.table());
        let table = if is_played(settings.table()) {
            None
        } else {
            PRESETS.into_iter().find(|name| is_played(Table::preset(name).map_err(|error| error.to_string())))
        };
        let table = table.map_or_else(|| settings.table.clone(), str::to_owned);
        self.in_force = Settings { table, ..settings };
        self.settings.settings = self.in_force.clone();
    }

    /// Switches to the next theme, for this session.
    pub(super) fn next_theme(&mut self) {
        let message = if self.in_force.depth == Some(Depth::Mono) {
            "no colours here: the setting colours is \"none\"; F5 changes it".to_owned()
        } else if self.full_caps.depth == Depth::Mono {
            "no colours here: NO_COLOR is set or the terminal has none".to_owned()
        } else {
            self.choose_theme(neighbour(&ThemeName::ALL, self.theme_name, 1));
            self.show_session();
            format!("theme: {}, for this session; F5 keeps it", self.theme_name)
        };
        *self.page_mut().message_mut() = Some(Message::plain(message));
    }

    /// Switches to the next character set that the terminal can show, for this session.
    pub(super) fn next_glyphs(&mut self) {
        let caps = self.caps.with_next_glyphs(self.finest);
        let refused = if self.theme_name == ThemeName::Mono {
            "the theme mono draws with letters: T chooses another"
        } else if caps == self.caps {
            "this terminal shows only letters, according to TERM or the locale"
        } else {
            (self.caps, self.full_caps) = (caps, caps);
            self.in_force.glyphs = Some(caps.glyphs);
            return self.show_session();
        };
        *self.page_mut().message_mut() = Some(Message::plain(refused));
    }

    /// Switches to this theme.
    pub(super) fn choose_theme(&mut self, name: ThemeName) {
        self.theme_name = name;
        let mono = Capabilities { depth: Depth::Mono, glyphs: Glyphs::Letters, ..self.full_caps };
        self.caps = if name == ThemeName::Mono { mono } else { self.full_caps };
        self.theme = Theme::of(name, self.caps.depth);
    }
}
