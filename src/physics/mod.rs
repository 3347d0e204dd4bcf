//! Formulas of motion, impact and contact, one file per topic, and the clearance of the cue. They know nothing about time: the simulation
//! decides when events occur.

mod contact;
mod cue;
mod cue_room;
mod flight;
mod impact;
mod motion;
mod rolling;
mod slope;

pub use contact::{
    ActiveSet, Contact, Contacts, Effort, FIRST_BOUNCE, Forces, Friction, MAX_CONTACTS, Partner, Resolved, Scene,
    factorize, involve, stop_by_impulses, substitute,
};
pub use cue::{CueDegrees, CueError, CueInputs, Impulse, ImpulseError, level_stroke, signed_angle, squirt, strike};
#[cfg(test)]
pub use cue_room::tests::collides;
pub use cue_room::{LeastElevation, NoRoom, Obstacle, has_room, least_elevation, raise_to_clear};
pub use flight::{Cloth, SpatialState, spin_change_by_cloth};
pub use impact::{
    Aloft, BallImpact, Cushion, ImpactImpulse, ImpactLaw, Touch, collide_together, collide_together_in_space,
    take_linked,
};
pub use motion::{BallState, Motion, decayed_spin, rolling_spin, slip};
pub use rolling::Rolling;
pub use slope::{Stretch, roll_on_slope, slide_on_slope};
