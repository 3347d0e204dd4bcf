//! Detects the foul of playing at a ball that touches the cue ball.

use crate::{
    physics::{CueInputs, Impulse, strike},
    table::{Layout, Table},
};

/// Maximum gap between balls that count as touching, m: no referee sees a gap of a hundredth of a millimetre.
const MAX_TOUCHING_GAP: f64 = 1e-5;

/// The object balls that touch the cue ball. By the UMB's rules of carom the stroke must not move them: the cue ball is
/// played away from them, or the balls are placed on their spots.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Touching([bool; 2]);

impl Touching {
    /// Detects the touching balls of a layout.
    #[inline]
    pub fn of(table: &Table, layout: &Layout) -> Self {
        let [cue_ball, balls @ ..] = layout.balls;
        let reach = 2.0 * table.radius + MAX_TOUCHING_GAP;
        Self(balls.map(|ball| cue_ball.distance_squared(ball) <= reach * reach))
    }

    /// Returns the ball, 1 or 2, that the cue ball pushes as it starts with `impulse`, given the real ball positions in
    /// `layout`.
    #[inline]
    pub fn pushed(self, layout: &Layout, impulse: &Impulse) -> Option<usize> {
        let is_ahead = |ball: usize| (layout.balls[ball] - layout.balls[0]).dot(impulse.velocity) > 0.0;
        [1, 2].into_iter().find(|&ball| self.0[ball - 1] && is_ahead(ball))
    }
}

/// Whether this stroke pushes a ball that touches the cue ball, which is a foul.
pub fn pushes_touching_ball(table: &Table, layout: &Layout, cue: &CueInputs) -> bool {
    let touching = Touching::of(table, layout);
    touching != Touching([false; 2]) && touching.pushed(layout, &strike(table, cue)).is_some()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    #[test]
    fn only_strokes_away_from_touching_balls_are_legal() {
        let table = Table::default();
        let pushes = |gap: f64, degrees: f64| {
            let first = DVec2::new(2.0 * table.radius + gap, 0.0);
            let layout = Layout::new([DVec2::ZERO, first, DVec2::new(0.5, 0.3)]);
            let cue = CueInputs { a: 0.0, b: 0.0, theta: 0.0, phi: f64::to_radians(degrees), speed: 2.0 };
            pushes_touching_ball(&table, &layout, &cue)
        };
        assert_eq!(
            [0.0, 89.0, -89.0, 91.0, 180.0].map(|degrees| pushes(1e-9, degrees)),
            [true, true, true, false, false]
        );
        assert!(!pushes(1e-4, 0.0));
    }
}
