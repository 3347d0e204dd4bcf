//! The true course of a shot, from the reference engine with 32 digits, and the shot's condition: how much it amplifies a
//! change.

use super::{
    reference_engine::{DoubleDouble, Motion, Numbers, Real, Shot, Stroke, Unjudged, Vector, by_extrema, play, strike},
    shots::{ReferenceShot, StudyShot},
};
use crate::{
    simulation::EventKind,
    table::{BALLS, Layout, Table},
};

/// Relative perturbation from which the condition is computed. It is far above the rounding of the truth, and so small that a
/// shot which amplifies by a factor of 1e9 still responds linearly.
const PERTURBATION: f64 = 1e-15;

/// Two collisions of the same partners within this time count as chatter, s.
const CHATTER: f64 = 1e-6;

/// The true course of a shot, rounded to `f64` where that is precise enough.
#[derive(Clone, Debug)]
pub struct Truth {
    /// All events.
    pub events: Vec<(f64, EventKind)>,
    /// Final positions of the balls, m; a ball that left the table is on its spot.
    pub end: [Vector<DoubleDouble>; BALLS],
    /// Displacement of the final positions per relative change in speed or angle, m: the larger of the two.
    pub condition: f64,
    /// Whether balls chatter or slide off one another in bounces. How many of these events a method reports depends on where it
    /// truncates the series.
    pub chatters: bool,
    /// Energy that the audit does not explain at the end, as a share of the initial energy.
    pub unaccounted: f64,
}

impl Truth {
    /// Plays a shot three times: unchanged, slightly faster, and slightly rotated.
    ///
    /// # Errors
    /// [`Unjudged`] if the truth cannot be computed.
    pub fn of(table: &Table, shot: &StudyShot) -> Result<Self, Unjudged> {
        let numbers = Numbers::of(table);
        let of = DoubleDouble::of;
        let (velocity, spin) = motion(shot);
        let true_shot = play(&numbers, positions(&shot.layout), velocity, spin, by_extrema)?;
        let faster = of(1.0) + of(PERTURBATION);
        // The impulse is linear in the cue's speed, and rotates with the cue's direction.
        let faster = play(&numbers, positions(&shot.layout), velocity * faster, spin * faster, by_extrema)?;
        let angle = of(shot.cue.phi) * of(PERTURBATION);
        let turn = |v: Vector<DoubleDouble>| v + Vector::up().cross(v) * angle;
        let turned = play(&numbers, positions(&shot.layout), turn(velocity), turn(spin), by_extrema)?;
        let moved = |other: &Shot<DoubleDouble>| {
            let ends = ends(table, &true_shot).into_iter().zip(ends(table, other));
            ends.map(|(a, b)| (a - b).length().to_f64()).fold(0.0, f64::max) / PERTURBATION
        };
        Ok(Self::from_shot(table, &true_shot, moved(&faster).max(moved(&turned))))
    }

    /// Computes the truth of a reference shot, starting from its angles in degrees.
    ///
    /// # Errors
    /// [`Unjudged`] if the truth cannot be computed.
    pub fn of_reference(table: &Table, reference: &ReferenceShot) -> Result<Self, Unjudged> {
        let numbers = Numbers::of(table);
        let of = DoubleDouble::of;
        let turn = |degrees: f64| (of(degrees) * DoubleDouble::PI / of(180.0)).sin_cos();
        let cue = &reference.cue;
        let (theta, phi) = (turn(cue.theta_deg), turn(cue.phi_deg));
        let (velocity, spin) =
            strike(&numbers, &Stroke { a: of(cue.a), b: of(cue.b), theta, phi, speed: of(cue.speed) });
        let shot = play(&numbers, positions(&reference.layout), velocity, spin, by_extrema)?;
        Ok(Self::from_shot(table, &shot, reference.condition.unwrap_or(0.0)))
    }

    fn from_shot(table: &Table, shot: &Shot<DoubleDouble>, condition: f64) -> Self {
        let events: Vec<_> = shot.events.iter().map(|(time, kind)| (time.to_f64(), *kind)).collect();
        let chatters = shot.pressed || shot.slides || chatters(&events);
        let unaccounted = (shot.energy[1] / shot.energy[0]).to_f64();
        Self { events, end: ends(table, shot), condition, chatters, unaccounted }
    }

    /// Whether any ball leaves the cloth.
    pub fn flies(&self) -> bool {
        self.events.iter().any(|(_, kind)| matches!(kind, EventKind::Jumps(_)))
    }

    /// Greatest distance between the final positions in `end` and the true ones, m.
    pub fn distance(&self, end: &Layout) -> f64 {
        let distances = self.end.iter().zip(positions(end)).map(|(truth, ball)| (*truth - ball).length().to_f64());
        distances.fold(0.0, f64::max)
    }

    /// The error unit, m: the error from rounding the input, which no double-precision program can avoid.
    pub fn unit(&self) -> f64 {
        (1.0 + self.condition) * f64::ROUNDING
    }
}

/// Positions of balls on the cloth.
pub fn positions<R: Real>(layout: &Layout) -> [Vector<R>; BALLS] {
    layout.balls.map(|ball| Vector::of(ball.extend(0.0)))
}

/// Initial velocity and spin of a shot's cue ball.
pub fn motion<R: Real>(shot: &StudyShot) -> (Vector<R>, Vector<R>) {
    (Vector::of(shot.impulse.velocity.extend(shot.impulse.lift)), Vector::of(shot.impulse.spin))
}

/// Final positions of a shot's balls; a ball that left the table is on its spot.
fn ends(table: &Table, shot: &Shot<DoubleDouble>) -> [Vector<DoubleDouble>; BALLS] {
    let spotted = positions(&shot.layout(table));
    std::array::from_fn(
        |ball| {
            if shot.end[ball].motion == Motion::OffTable { spotted[ball] } else { shot.end[ball].position }
        },
    )
}

fn chatters(events: &[(f64, EventKind)]) -> bool {
    let meetings: Vec<_> = events.iter().filter(|(_, kind)| kind.is_contact()).collect();
    meetings.iter().enumerate().any(|(index, (time, kind))| {
        meetings[index + 1..].iter().take_while(|(later, _)| later - time < CHATTER).any(|(_, other)| other == kind)
    })
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_xoshiro::Xoshiro256PlusPlus;

    use super::*;
    use crate::study::{
        shots::{MaxElevation, random_shots},
        stability::adversarial,
    };

    fn judges_all(random: usize, adversarial_shots: usize) {
        let judge = |table: &Table, shot: &StudyShot| {
            let (velocity, spin) = motion::<DoubleDouble>(shot);
            play(&Numbers::of(table), positions(&shot.layout), velocity, spin, by_extrema).unwrap();
        };
        for table in ["thesis", "textbook"].map(|name| Table::preset(name).unwrap()) {
            for shot in random_shots(&table, random, 1, MaxElevation::USUAL) {
                judge(&table, &shot);
            }
            let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
            for _ in 0..adversarial_shots {
                let shot = adversarial::shot(&table, &mut rng);
                judge(&table, &StudyShot::new(&table, shot.layout, shot.cue.into()));
            }
        }
    }

    #[test]
    fn every_shot_is_judged() {
        judges_all(50, 50);
    }

    #[test]
    #[ignore = "takes some minutes"]
    fn every_shot_of_a_long_run_is_judged() {
        judges_all(1000, 300);
    }
}
