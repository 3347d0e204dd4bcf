//! Stiffness: slips whose directions follow the forces much faster than anything else moves. Steps of a resting contact are implicit in
//! them.
//!
//! Friction of magnitude `f` on a ball turns a slip `u` against the forces within `|u|/f`. If it nearly holds the ball, the slip stays
//! small for long, and explicit steps would have to be shorter than `|u|/f`.

use glam::DVec2;

use super::{Phase, Resting, STIFF, SlipLocation, Trial};
use crate::{
    physics::{Forces, Friction, Scene},
    simulation::extrapolation::Mode,
    table::Table,
};

/// If one direction is stiff, steps are implicit in all directions whose time constant fits into the step more often than this.
const SOFT: f64 = 0.25;

/// Angle by which a friction is turned for a difference quotient, rad.
const TURN: f64 = 1e-4;

/// Change of a slip on the cloth by a force, in units of the change of the ball's speed; twice as much for the slip of two balls, both of
/// which the force acts on.
const RESPONSE: f64 = 3.5;

impl Resting {
    /// Returns the stiff slips of a step of `length` in rescaled time; none if an explicit step is sufficient.
    pub(super) fn stiff(&self, table: &Table, from: &Trial, length: f64) -> Vec<Mode> {
        let balls = &from.step.end.balls;
        let length = length * self.time_rate(balls);
        let mut slips = Vec::new();
        let mut stiffest = 0.0_f64;
        self.slips(balls, &from.forces, |place, slip, _| {
            let (friction, does) = match place {
                SlipLocation::Contact(index) => {
                    let limit = from.forces.friction_limit(table, &self.contacts, index);
                    (2.0 * RESPONSE * limit, self.set.contact[index])
                }
                SlipLocation::Roll(ball) => (table.rolling_friction * table.gravity, self.set.roll[ball]),
                SlipLocation::Cloth(ball) => (RESPONSE * self.constants.sliding, self.set.cloth[ball]),
            };
            let slip = if let Friction::Slips(start) = does { slip + start } else { slip };
            let turns = friction * length / slip.length();
            if turns > SOFT && slip != DVec2::ZERO {
                stiffest = stiffest.max(turns);
                slips.push((place, slip));
            }
        });
        if stiffest <= STIFF {
            return Vec::new();
        }
        slips.into_iter().map(|(place, slip)| self.mode(table, from, place, slip)).collect()
    }

    /// Returns the deviation of one slip's direction, and the effect of turning its friction.
    fn mode(&self, table: &Table, from: &Trial, place: SlipLocation, slip: DVec2) -> Mode {
        let balls = &from.step.end.balls;
        let across = slip.perp().normalize();
        let turned = |friction: &mut Friction| {
            if let Friction::Slips(start) = friction {
                *start += TURN * slip.perp();
            }
        };
        let (mut set, mut row) = (self.set, Phase::ZERO);
        match place {
            SlipLocation::Cloth(ball) => {
                turned(&mut set.cloth[ball]);
                row.balls[ball].velocity = across;
                row.balls[ball].spin = -table.radius * across.perp().extend(0.0);
            }
            SlipLocation::Roll(ball) => {
                turned(&mut set.roll[ball]);
                row.balls[ball].velocity = across;
            }
            SlipLocation::Contact(index) => {
                turned(&mut set.contact[index]);
                let contact = &self.contacts[index];
                let t = contact.normal(balls).perp();
                let spin = table.radius * (across.y * t).extend(-across.x);
                (row.balls[contact.first].velocity, row.balls[contact.first].spin) = (across.x * t, spin);
                if let Some(second) = contact.second() {
                    (row.balls[second].velocity, row.balls[second].spin) = (-across.x * t, spin);
                }
            }
        }
        let slope = |forces: &Forces| self.slope(balls, &forces.linear, &forces.angular);
        let turned = self.forces(Scene { set: &set, ..self.scene(table, balls) }, &from.forces);
        let mut column = Phase::ZERO;
        if !turned.converged {
            return Mode { row, column };
        }
        let (before, after) = (slope(&from.forces), slope(&turned));
        for ((column, before), after) in column.balls.iter_mut().zip(before.balls).zip(after.balls) {
            column.velocity = (after.velocity - before.velocity) / (TURN * slip.length());
            column.spin = (after.spin - before.spin) / (TURN * slip.length());
        }
        Mode { row, column }
    }
}
