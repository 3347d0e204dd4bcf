//! Impulses that stop what moves no longer: what is left, by rounding or by the end of a slip, of speeds that are to be zero.

use glam::DVec2;

use super::{ActiveSet, Contact, Held, MAX_CONTACTS, Movement, Scene};
use crate::{
    physics::BallState,
    table::{BALLS, Table},
};

/// Impulses that stop some speeds change others by a few times as much. Where it is far more, the contacts are about to open,
/// and what is stopped is rounding.
const MOST_AMPLIFICATION: f64 = 100.0;

/// Takes out of velocities and spins what is left of speeds that are to be zero: the opening of `contacts` and the slips that
/// do not last by `set`, by impulses in those contacts, as the ends of slips do: a push that stops something has friction where its
/// contact slips. An impulse that would have to pull takes back part of what an impact has just `given` a contact, per mass in
/// m/s, and its friction with it; beyond that it is rounding, and has nothing to rub with: energy would be gained. Where the
/// speeds cannot all vanish, or not without changing others by far more, all stay.
pub fn stop_by_impulses(
    table: &Table,
    balls: &mut [BallState; BALLS],
    contacts: &[Contact],
    set: &ActiveSet,
    given: &[f64; MAX_CONTACTS],
) {
    let scene = Scene { table, balls, contacts, set: &set.slipping_where(set) };
    if let Some(stopped) = in_room!(contacts, ROOM => stopped_in::<ROOM>(scene, given)) {
        for (ball, state) in balls.iter_mut().enumerate() {
            if contacts.iter().any(|contact| contact.has(ball)) {
                (state.velocity, state.spin) = (stopped.linear[ball], stopped.angular[ball] / table.radius);
            }
        }
    }
}

/// The movement that is left; `None` where all speeds stay.
fn stopped_in<const ROOM: usize>(scene: Scene<'_>, given: &[f64; MAX_CONTACTS]) -> Option<Movement> {
    let Scene { table, balls, .. } = scene;
    // Balls without a coefficient of friction have no rubbing of their own: what stops them does not slip.
    let mut system = Held::<ROOM>::new(scene, |contact| !contact.never_slips(table));
    let speeds =
        Movement { linear: balls.map(|ball| ball.velocity), angular: balls.map(|ball| table.radius * ball.spin) };
    let before = system.to_stop(&speeds);
    let mut stopped = system.solve(&speeds, false)?;
    while system.smooth_what_pulls(given) {
        stopped = system.solve(&speeds, false)?;
    }
    (stopped.distance(&speeds, system.members) <= MOST_AMPLIFICATION * before).then_some(stopped)
}

impl<const ROOM: usize> Held<ROOM> {
    /// The largest of the speeds that are to be zero.
    fn to_stop(&self, speeds: &Movement) -> f64 {
        let moved = self.held(speeds);
        let largest = moved.distance(speeds, self.members);
        self.joints().iter().fold(largest, |largest, joint| {
            let rates = joint.rates(&moved);
            rates[..joint.unknowns].iter().fold(largest, |largest, rate| largest.max(rate.abs()))
        })
    }

    /// Takes the friction of contacts that slip away where they pull back more than has been `given`; tells whether there are
    /// any.
    fn smooth_what_pulls(&mut self, given: &[f64; MAX_CONTACTS]) -> bool {
        let mut any = false;
        for ((joint, sizes), given) in self.joints[..self.contacts].iter_mut().zip(&self.sizes).zip(given) {
            if sizes[0] < -given && joint.slip_friction != DVec2::ZERO {
                (joint.slip_friction, any) = (DVec2::ZERO, true);
            }
        }
        any
    }
}
