//! A ball's spin as a player describes it: draw or follow, and side.

use glam::{DVec2, DVec3};

use crate::physics::{BallState, Motion};

/// Spin per tip offset of a level stroke, `w R / v`, with the offset in ball radii: that of a solid ball (thesis equations 15 and 16 at
/// theta = 0).
const SPIN_OF_TIP: f64 = 2.5;
/// Tolerance for a sliding ball's spin, as a fraction of that of a rolling ball: below the negative of it the ball draws, above one plus it
/// the ball follows.
const ROLLING_TOLERANCE: f64 = 0.1;
/// Side spin below which a stationary ball counts as still, rad/s.
const STILL: f64 = 0.5;
/// Largest distance of the mark from the centre, in ball radii: slightly beyond the miscue limit. At low speeds no tip contact gives the
/// spin.
const MAX_MARK_DISTANCE: f64 = 0.65;

/// A ball's spin, seen from behind along its direction of motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spin {
    /// What the ball does: rolls, slides, or slides with draw or follow.
    pub word: &'static str,
    /// Where a level cue would have to hit the ball to give it this spin at this speed, in ball radii to the right and up.
    pub mark: DVec2,
    /// Side spin, rad/s, positive to the left like the tip's offset `a`.
    pub side: f64,
}

impl Spin {
    /// The spin of a ball of `radius`, m, in the state of motion `motion`.
    pub fn of(state: &BallState, motion: Motion, radius: f64) -> Self {
        let speed = state.velocity.length();
        let ahead = state.velocity.normalize_or_zero();
        let across = DVec3::new(-ahead.y, ahead.x, 0.0);
        let rolling = radius * state.spin.dot(across);
        let side = -state.spin.z;
        let turning = DVec2::new(-radius * side, rolling) / SPIN_OF_TIP;
        let mark = if turning.length() <= MAX_MARK_DISTANCE * speed && speed > 0.0 {
            turning / speed
        } else {
            MAX_MARK_DISTANCE * turning.normalize_or_zero()
        };
        let word = match motion {
            Motion::Sliding if rolling < -ROLLING_TOLERANCE * speed => "draw",
            Motion::Sliding if rolling > (1.0 + ROLLING_TOLERANCE) * speed => "follow",
            Motion::Sliding => "slides",
            Motion::Rolling => "rolls",
            Motion::Resting => "touches",
            Motion::Flying => "flies",
            Motion::OffTable => "off",
            Motion::Stationary if speed == 0.0 && side.abs() > STILL => "spins",
            Motion::Stationary => "",
        };
        Self { word, mark, side }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        physics::CueInputs,
        simulation::Recording,
        table::{Layout, Table},
    };

    fn spin(cue: &str, time: f64) -> Spin {
        let table = Table::default();
        let layout = Layout::parse("-1,0 1,0.6 1,-0.6", &table).unwrap();
        let recording = Recording::new(&table, &layout, &CueInputs::parse(cue).unwrap()).unwrap();
        Spin::of(&recording.state(0, time), recording.motion(0, time), table.radius)
    }

    #[test]
    fn the_spin_mark_starts_at_the_tip_contact_in_any_direction() {
        for (cue, a, b, word) in [
            ("0.3,-0.2,0,0,2", 0.3, -0.2, "draw"),
            ("-0.2,0.1,0,140,3", -0.2, 0.1, "slides"),
            ("0.1,0.47,0,-80,1.5", 0.1, 0.47, "follow"),
        ] {
            let spin = spin(cue, 0.0);
            assert!(spin.mark.abs_diff_eq(DVec2::new(-a, b), 1e-9), "{cue}: {spin:?}");
            assert_eq!((spin.word, spin.side > 0.0), (word, a > 0.0), "{cue}");
        }
    }

    #[test]
    fn a_rolling_ball_is_marked_two_fifths_above_the_centre() {
        let rolling = spin("0,-0.3,0,0,1.5", 0.9);
        assert_eq!(rolling.word, "rolls");
        assert!(rolling.mark.abs_diff_eq(DVec2::new(0.0, 0.4), 1e-6), "{rolling:?}");
    }

    #[test]
    fn a_ball_that_spins_on_the_spot_is_marked_at_its_side() {
        let state = BallState { position: DVec2::ZERO, velocity: DVec2::ZERO, spin: DVec3::new(0.0, 0.0, 20.0) };
        let spin = Spin::of(&state, Motion::Stationary, 0.03);
        assert_eq!((spin.word, spin.mark), ("spins", DVec2::new(MAX_MARK_DISTANCE, 0.0)));
        let still = Spin::of(&BallState { spin: DVec3::ZERO, ..state }, Motion::Stationary, 0.03);
        assert_eq!((still.word, still.mark), ("", DVec2::ZERO));
    }
}
