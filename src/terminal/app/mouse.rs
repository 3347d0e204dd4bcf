//! The mouse: each thing that it does is something that keys do as well, but for dragging balls.

use crossterm::event::{MouseButton::Left, MouseEvent, MouseEventKind as Kind};

use super::{App, Effect};
use crate::terminal::{
    geometry::Mapping,
    keymap::{
        Action, CoachAction, CoachWhen, DrillAction, DrillWhen, FinderAction, Place, SettingsAction, SettingsWhen,
        TrainingAction, TrainingWhen, When,
    },
    screens::{Target, table_mapping, target},
    widgets::ball_at,
};

/// Lines of the help that a notch of the wheel scrolls.
const HELP_LINES: i16 = 3;

impl App {
    /// Whether the mouse is wanted; otherwise the terminal keeps it for its own selection.
    pub const fn wants_mouse(&self) -> bool {
        self.mouse
    }

    /// The mouse was used somewhere on the screen that was drawn last.
    pub fn mouse(&mut self, event: MouseEvent) -> Option<Effect> {
        let effect = self.point(event);
        self.gather(true);
        effect
    }

    fn point(&mut self, event: MouseEvent) -> Option<Effect> {
        if self.is_blind() {
            return None;
        }
        match event.kind {
            Kind::Down(Left) => self.click(event),
            Kind::ScrollUp => self.wheel(event, -1),
            Kind::ScrollDown => self.wheel(event, 1),
            Kind::Drag(Left) if self.place() == Place::Coach && self.help.is_none() => {
                let pointer = table_mapping(self, self.area.get()).nearest_metres(event.column, event.row)?;
                self.coach.drag_ball(pointer)
            }
            Kind::Up(Left) => {
                self.coach.drop_ball();
                None
            }
            _ => None,
        }
    }

    fn click(&mut self, event: MouseEvent) -> Option<Effect> {
        match self.target(event)? {
            Target::Tab(screen) => self.attempt(When::Tabs, Action::Open(screen)),
            Target::Table(mapping) => self.take_ball(&mapping, event),
            Target::Shot(shot) => self.attempt(When::Coach(CoachWhen::Choice), Action::Coach(CoachAction::Show(shot))),
            Target::List(lines) => self.move_mark(lines?),
        }
    }

    /// The wheel was turned by a notch, down where positive.
    fn wheel(&mut self, event: MouseEvent, notch: i8) -> Option<Effect> {
        if self.finder.is_some() {
            return self.update(Action::Finder(FinderAction::Line(isize::from(notch))));
        }
        if self.help.is_some() {
            return self.update(Action::ScrollHelp(i16::from(notch) * HELP_LINES));
        }
        match self.target(event)? {
            Target::Table(_) => {
                let action = if notch < 0 { CoachAction::Faster } else { CoachAction::Slower };
                self.attempt(When::Coach(CoachWhen::Watching), Action::Coach(action))
            }
            Target::Shot(_) | Target::Tab(_) => None,
            Target::List(_) => self.move_mark(isize::from(notch)),
        }
    }

    fn target(&self, event: MouseEvent) -> Option<Target> {
        let is_covered = self.help.is_some() || self.finder.is_some();
        if is_covered { None } else { target(self, self.area.get(), (event.column, event.row).into()) }
    }

    /// Selects the ball that is drawn where the mouse is, and holds it.
    fn take_ball(&mut self, mapping: &Mapping, event: MouseEvent) -> Option<Effect> {
        let time = self.playback().time;
        let balls = self.watched().map_or(self.layout().balls, |shot| shot.recording.positions(time));
        let ball = ball_at(balls, mapping, self.look.glyphs, (event.column, event.row))?;
        let colour = self.coach.cue_ball().ordered([0, 1, 2])[ball];
        // As long as a shot has not begun the balls lie where they can be taken.
        let is_moving = self.watched().is_some() && time > 0.0;
        let when = if is_moving { CoachWhen::Placing } else { CoachWhen::Idle };
        let effect = self.attempt(When::Coach(when), Action::Coach(CoachAction::Select(colour)));
        if self.refusal(When::Coach(CoachWhen::Placing)).is_none() {
            self.coach.take_ball(mapping.nearest_metres(event.column, event.row)?);
        }
        effect
    }

    /// Moves the mark of the list that is shown, by lines.
    fn move_mark(&mut self, lines: isize) -> Option<Effect> {
        let (when, action) = match self.place() {
            Place::Drill(_) => (When::Drill(DrillWhen::Marked), Action::Drill(DrillAction::Line(lines))),
            Place::Settings(_) => (When::Settings(SettingsWhen::Here), Action::Settings(SettingsAction::Line(lines))),
            _ => (When::Training(TrainingWhen::Marked), Action::Training(TrainingAction::Line(lines))),
        };
        self.attempt(when, action)
    }

    /// Does what a key would do that may be used at such a time, or says why not.
    fn attempt(&mut self, when: When, action: Action) -> Option<Effect> {
        *self.message_mut() = None;
        self.toasts.go_on();
        if let Some(reason) = self.refusal(when) {
            self.toasts.push(reason.to_owned(), true);
            return None;
        }
        self.update(action)
    }
}
