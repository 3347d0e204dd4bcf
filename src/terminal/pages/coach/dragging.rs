//! Dragging a ball with the mouse: it goes where the mouse is, or as far as it can, and all of it is one step to take back.

use glam::DVec2;

use crate::terminal::{Effect, pages::coach::CoachPage, shot::placing};

/// A ball that is held; it is the selected one.
#[derive(Clone, Copy, Debug)]
pub struct Drag {
    /// From the mouse to the ball's centre, m: a ball that is taken at its edge does not jump.
    grip: DVec2,
    /// Whether it has moved.
    is_begun: bool,
}

impl CoachPage {
    /// Holds the selected ball; the mouse is at `pointer`, m.
    pub fn take_ball(&mut self, pointer: DVec2) {
        let grip = self.layout().balls[self.selected] - pointer;
        self.drag = Some(Drag { grip, is_begun: false });
    }

    /// Moves the ball that is held, if any, with the mouse.
    pub fn drag_ball(&mut self, pointer: DVec2) -> Option<Effect> {
        let drag = self.drag?;
        let reach = self.table().reach();
        let mut layout = *self.layout();
        let ball = layout.balls[self.selected];
        // The hand carries it over the others; where there is no room it stops at what is in the way.
        let goal = (pointer + drag.grip).clamp(-reach, reach);
        layout.balls[self.selected] = goal;
        if layout.validate(self.table()).is_err() {
            layout = placing::slide(self.table(), self.layout(), self.selected, goal - ball).layout;
        }
        if layout == *self.layout() {
            return None;
        }
        let snapshot = self.snapshot(layout);
        if drag.is_begun {
            *self.history.present_mut() = snapshot;
        } else {
            self.history.push(snapshot);
        }
        self.drag = Some(Drag { is_begun: true, ..drag });
        self.message = None;
        self.rest();
        self.study()
    }

    /// Lets go of the ball.
    pub const fn drop_ball(&mut self) {
        self.drag = None;
    }
}
