//! Mouse input. Except for dragging balls, the mouse does nothing that keys cannot do.

use crossterm::event::{KeyCode, KeyEvent, MouseButton::Left, MouseEvent, MouseEventKind as Kind};

use crate::terminal::{
    Action, App, CoachAction, CoachCondition, Condition, Effect, KeyContext, Mapping,
    app::{
        bindings,
        view::{Pointed, pointed_at},
    },
    pages::{Target, coach::view::table_mapping},
    shot::PlaybackKey,
    ui::ball_at,
};

/// Lines that one notch of the wheel scrolls an overlay.
const OVERLAY_LINES: isize = 3;

impl App {
    /// Handles a mouse event on the screen that was drawn last.
    pub fn mouse(&mut self, event: MouseEvent) -> Option<Effect> {
        let effect = self.point(event);
        self.collect_toasts(true);
        effect.or_else(|| self.study())
    }

    fn point(&mut self, event: MouseEvent) -> Option<Effect> {
        if self.is_too_small() {
            return None;
        }
        match event.kind {
            Kind::Down(Left) => self.click(event),
            Kind::ScrollUp => self.wheel(event, -1),
            Kind::ScrollDown => self.wheel(event, 1),
            Kind::Drag(Left) if self.key_context() == KeyContext::Coach && self.overlay.is_none() => {
                let pointer = table_mapping(&self.coach, self.area).extended_metres(event.column, event.row)?;
                self.coach.drag_to(pointer)
            }
            Kind::Up(Left) => {
                self.coach.end_drag();
                None
            }
            _ => None,
        }
    }

    fn click(&mut self, event: MouseEvent) -> Option<Effect> {
        match self.target(event)? {
            Pointed::Tab(screen) => self.attempt(Condition::Tabs, Action::Open(screen)),
            Pointed::Page(Target::Table(mapping)) => self.take_ball(&mapping, event),
            Pointed::Page(Target::Shot(shot)) => {
                self.attempt(Condition::Coach(CoachCondition::SeveralShots), Action::Coach(CoachAction::ShowShot(shot)))
            }
            Pointed::Page(Target::List(lines)) => self.move_mark(lines?),
        }
    }

    /// Handles one notch of the wheel, positive if turned down.
    fn wheel(&mut self, event: MouseEvent, notch: i8) -> Option<Effect> {
        if self.command_palette.is_some() {
            return self.update(Action::PaletteLine(isize::from(notch)));
        }
        if self.overlay.is_some() {
            return self.update(Action::ScrollOverlay(isize::from(notch) * OVERLAY_LINES));
        }
        match self.target(event)? {
            Pointed::Page(Target::Table(_)) => {
                let faster = Action::Coach(CoachAction::Playback(PlaybackKey::Pace(-isize::from(notch))));
                // The user may turn the wheel by accident: if no shot plays, nothing is reported.
                let is_watched = self.disabled_reason(Condition::Coach(CoachCondition::Watching)).is_none();
                if is_watched { self.perform(Ok(faster)) } else { None }
            }
            Pointed::Page(Target::Shot(_)) | Pointed::Tab(_) => None,
            Pointed::Page(Target::List(_)) => self.move_mark(isize::from(notch)),
        }
    }

    fn target(&self, event: MouseEvent) -> Option<Pointed> {
        if self.is_covered() { None } else { pointed_at(self, self.area, (event.column, event.row).into()) }
    }

    /// Selects the ball under the pointer and starts dragging it.
    fn take_ball(&mut self, mapping: &Mapping, event: MouseEvent) -> Option<Effect> {
        let time = self.coach.playback.time;
        let balls = self.coach.watched().map_or(self.coach.layout().balls, |shot| shot.recording.positions(time));
        let ball = ball_at(balls, mapping, self.caps.glyphs, (event.column, event.row))?;
        let colour = self.coach.cue_ball().to_ball_order([0, 1, 2])[ball];
        // A click leaves the shot. Once the shot has started, the ball is drawn away from its position in the layout.
        let has_moved = self.coach.watched().is_some() && time > 0.0;
        let select = Action::Coach(CoachAction::SelectBall(colour));
        let effect = self.attempt(Condition::Coach(CoachCondition::Idle), select);
        if !has_moved && self.disabled_reason(Condition::Coach(CoachCondition::Placing)).is_none() {
            self.coach.start_drag(mapping.extended_metres(event.column, event.row)?);
        }
        effect
    }

    /// Moves the selection of the visible list by `lines`, exactly as the arrow keys would.
    fn move_mark(&mut self, lines: isize) -> Option<Effect> {
        let arrow = KeyEvent::from(if lines < 0 { KeyCode::Up } else { KeyCode::Down });
        let found = bindings::find(&arrow, self.key_context(), |when| self.disabled_reason(when))?;
        // A refusal is reported once; of several steps, only the last effect counts.
        let times = if found.is_ok() { lines.unsigned_abs() } else { 1 };
        (0..times).fold(None, |effect, _| self.perform(found).or(effect))
    }

    /// Performs `action` if its condition holds, otherwise reports why it does not.
    fn attempt(&mut self, when: Condition, action: Action) -> Option<Effect> {
        self.perform(self.disabled_reason(when).map_or(Ok(action), Err))
    }
}
