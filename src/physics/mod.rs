//! The formulas of motion and impact, one file a chapter: they know no time and no table edge.

mod ball_ball;
mod ball_rail;
mod contact;
mod cue;
mod motion;

pub use ball_ball::collide_balls;
pub use ball_rail::collide_rail;
pub use contact::{
    ENDING_SLIP, Forces, Laws, MAX_TOUCHES, SLIP_TOLERANCE, Touch, contact_forces, forces_in_regime, stop_by_impulses,
};
pub use cue::{CueError, CueInputs, Impulse, strike};
pub use motion::{
    BallState, Motion, decayed_spin, rolling_deceleration, rolling_spin, sliding_deceleration, slip, spin_deceleration,
};
