//! Impulses that cancel residual speeds: velocities that should be zero but are not, because of rounding or the end of a slip.

use glam::DVec2;

use super::{ActiveSet, ConstraintSystem, Contact, MAX_CONTACTS, Movement, Scene, involve};
use crate::{
    physics::BallState,
    table::{BALLS, Table},
};

/// Impulses that cancel some speeds may change others by a few times as much. If it is far more, the contacts are about to open, and the
/// residual is rounding.
const MAX_AMPLIFICATION: f64 = 100.0;

/// Cancels residual speeds: the opening speed of `contacts` and, according to `set`, the slips that have ended. It uses impulses in these
/// contacts: an impulse that pushes has friction if its contact slips. An impulse that would have to pull takes back part of what an impact
/// has just `given` a contact, per mass in m/s, with its friction. Beyond that it is a rounding error and has no friction: energy would be
/// gained. If the speeds cannot all vanish, or only with far larger changes of others, all velocities stay.
pub fn stop_by_impulses(
    table: &Table,
    balls: &mut [BallState; BALLS],
    contacts: &[Contact],
    set: &ActiveSet,
    given: &[f64],
) {
    let scene = Scene { table, balls, contacts, set: &set.with_yielding_as_slipping(set) };
    if let Some(stopped) = in_room!(contacts, ROOM => stopped_in::<ROOM>(scene, given)) {
        for (ball, state) in balls.iter_mut().enumerate() {
            if involve(contacts, ball) {
                (state.velocity, state.spin) = (stopped.linear[ball], stopped.angular[ball] / table.radius);
            }
        }
    }
}

/// Returns the corrected motion; `None` if all speeds stay.
fn stopped_in<const ROOM: usize>(scene: Scene<'_>, given: &[f64]) -> Option<Movement> {
    let Scene { table, balls, .. } = scene;
    // Contacts without a coefficient of friction have no slip friction: the impulses that stop them do not slip.
    let mut system = ConstraintSystem::<ROOM>::new(scene, |contact| !contact.never_slips(table));
    let speeds =
        Movement { linear: balls.map(|ball| ball.velocity), angular: balls.map(|ball| table.radius * ball.spin) };
    let before = system.largest_residual_speed(&speeds);
    let mut stopped = system.solve(&speeds, false)?;
    while system.remove_friction_of_pulling(given) {
        stopped = system.solve(&speeds, false)?;
    }
    (stopped.distance(&speeds, system.members) <= MAX_AMPLIFICATION * before).then_some(stopped)
}

impl<const ROOM: usize> ConstraintSystem<ROOM> {
    /// Returns the largest of the speeds that should be zero.
    fn largest_residual_speed(&self, speeds: &Movement) -> f64 {
        let moved = self.with_cloth(speeds);
        let largest = moved.distance(speeds, self.members);
        self.joints().iter().fold(largest, |largest, joint| {
            let rates = joint.rates(&moved);
            rates[..joint.unknowns].iter().fold(largest, |largest, rate| largest.max(rate.abs()))
        })
    }

    /// Removes the friction of slipping contacts that pull more than they were `given`. Returns whether there are any.
    fn remove_friction_of_pulling(&mut self, given: &[f64]) -> bool {
        let mut any = false;
        for ((joint, values), given) in self.joints[..self.contacts].iter_mut().zip(&self.values).zip(given) {
            if values[0] < -given && joint.slip_friction != DVec2::ZERO {
                (joint.slip_friction, any) = (DVec2::ZERO, true);
            }
        }
        any
    }
}
