//! Dragging a ball with the mouse. The ball follows the pointer as far as it can; the whole drag is one undo step.

use glam::DVec2;

use crate::terminal::{Effect, pages::coach::CoachPage, shot::placing};

/// A drag in progress. The dragged ball is the selected one.
#[derive(Clone, Copy, Debug)]
pub struct Drag {
    /// Vector from the pointer to the ball's centre, m. It keeps a ball that is grabbed at its edge from jumping.
    grab_offset: DVec2,
    /// Whether the ball has moved.
    is_begun: bool,
}

impl CoachPage {
    /// Starts to drag the selected ball with the mouse at `pointer`, m.
    pub fn start_drag(&mut self, pointer: DVec2) {
        let grab_offset = self.layout().balls[self.selected] - pointer;
        self.drag = Some(Drag { grab_offset, is_begun: false });
    }

    /// Moves the dragged ball, if any, to the mouse at `pointer`, m.
    pub fn drag_to(&mut self, pointer: DVec2) -> Option<Effect> {
        let drag = self.drag?;
        let reach = self.table().reach();
        let mut layout = *self.layout();
        let ball = layout.balls[self.selected];
        // The ball may pass over the others. If there is no room at the goal, it stops at the obstacle.
        let goal = (pointer + drag.grab_offset).clamp(-reach, reach);
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
        self.reset_playback();
        self.study()
    }

    /// Ends the drag.
    pub const fn end_drag(&mut self) {
        self.drag = None;
    }
}
