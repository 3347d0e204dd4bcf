//! A ball that touches the cue ball from the start must not be played at.

use crate::{
    physics::{CueInputs, squirt},
    table::{Layout, Table},
};

/// Balls that are nearer than this touch, m: no referee sees a gap of a hundredth of a millimetre.
const NO_GAP: f64 = 1e-5;

/// Whether this stroke pushes a ball that touches the cue ball. By the UMB's rules of carom such a ball must not be moved: the cue ball is
/// played away from it, or the balls are put on their spots.
pub fn pushes_touching_ball(table: &Table, layout: &Layout, cue: &CueInputs) -> bool {
    let way = || glam::DVec2::from_angle(cue.phi + squirt(table, cue.a));
    layout.balls[1..].iter().any(|ball| {
        let apart = ball - layout.balls[0];
        apart.length() <= 2.0 * table.radius + NO_GAP && apart.dot(way()) > 0.0
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    #[test]
    fn a_touching_ball_is_played_away_from() {
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
