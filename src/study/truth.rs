//! What really becomes of a shot: the reference engine with 32 digits, and how much the shot amplifies a change.

use super::{
    reference_engine::{DoubleDouble, Motion, Numbers, Real, Shot, Stroke, Unjudged, Vector, by_extrema, play, strike},
    shots::{Reference, StudyShot},
};
use crate::{
    simulation::EventKind,
    table::{BALLS, Layout, Table},
};

/// Relative change from which the amplification is taken: far above the truth's rounding, and so far below all else that
/// a shot which amplifies a billionfold is still linear in it.
const CHANGE: f64 = 1e-15;

/// Two meetings of the same partners within this time are a chatter, s.
const CHATTER: f64 = 1e-6;

/// A shot's true course, rounded to `f64` where nothing more is needed.
#[derive(Clone, Debug)]
pub struct Truth {
    /// All events.
    pub events: Vec<(f64, EventKind)>,
    /// Where the balls come to rest, m; those that left the table are on their spots.
    pub end: [Vector<DoubleDouble>; BALLS],
    /// How far the end moves per unit of relative change in speed or angle, m: the worse of the two.
    pub condition: f64,
    /// Whether balls chatter or slide off one another in bounces, so that what is told of these depends on where a method stops
    /// telling.
    pub chatters: bool,
    /// Energy at the start for which nothing accounts at the end, as a share.
    pub unaccounted: f64,
}

impl Truth {
    /// Plays a shot three times: as it is, a little faster, and a little turned.
    ///
    /// # Errors
    /// [`Unjudged`], where the truth is not known.
    pub fn of(table: &Table, shot: &StudyShot) -> Result<Self, Unjudged> {
        let numbers = Numbers::of(table);
        let of = DoubleDouble::of;
        let (velocity, spin) = motion(shot);
        let true_shot = play(&numbers, places(&shot.layout), velocity, spin, by_extrema)?;
        let faster = of(1.0) + of(CHANGE);
        // The impulse is linear in the cue's speed, and turns with its direction.
        let faster = play(&numbers, places(&shot.layout), velocity * faster, spin * faster, by_extrema)?;
        let angle = of(shot.cue.phi) * of(CHANGE);
        let turn = |v: Vector<DoubleDouble>| v + Vector::up().cross(v) * angle;
        let turned = play(&numbers, places(&shot.layout), turn(velocity), turn(spin), by_extrema)?;
        let moved = |other: &Shot<DoubleDouble>| {
            let ends = ends(table, &true_shot).into_iter().zip(ends(table, other));
            ends.map(|(a, b)| (a - b).length().to_f64()).fold(0.0, f64::max) / CHANGE
        };
        Ok(Self::from_shot(table, &true_shot, moved(&faster).max(moved(&turned))))
    }

    /// The truth of a reference shot, from the angles in degrees on.
    ///
    /// # Errors
    /// [`Unjudged`], where the truth is not known.
    pub fn of_reference(table: &Table, reference: &Reference) -> Result<Self, Unjudged> {
        let numbers = Numbers::of(table);
        let of = DoubleDouble::of;
        let turn = |degrees: f64| (of(degrees) * DoubleDouble::PI / of(180.0)).sin_cos();
        let cue = &reference.cue;
        let (theta, phi) = (turn(cue.theta_deg), turn(cue.phi_deg));
        let (velocity, spin) =
            strike(&numbers, &Stroke { a: of(cue.a), b: of(cue.b), theta, phi, speed: of(cue.speed) });
        let shot = play(&numbers, places(&reference.layout), velocity, spin, by_extrema)?;
        Ok(Self::from_shot(table, &shot, reference.condition.unwrap_or(0.0)))
    }

    fn from_shot(table: &Table, shot: &Shot<DoubleDouble>, condition: f64) -> Self {
        let events: Vec<_> = shot.events.iter().map(|(time, kind)| (time.to_f64(), *kind)).collect();
        let chatters = shot.pressed || shot.slides || chatters(&events);
        let unaccounted = (shot.energy[1] / shot.energy[0]).to_f64();
        Self { events, end: ends(table, shot), condition, chatters, unaccounted }
    }

    /// Whether a ball leaves the cloth.
    pub fn flies(&self) -> bool {
        self.events.iter().any(|(_, kind)| matches!(kind, EventKind::Jumps(_)))
    }

    /// Greatest distance of a ball at rest from where it should be, m.
    pub fn distance(&self, end: &Layout) -> f64 {
        let apart = self.end.iter().zip(places(end)).map(|(truth, ball)| (*truth - ball).length().to_f64());
        apart.fold(0.0, f64::max)
    }

    /// The error that no double-precision program can be blamed for, m: that of a rounded input.
    pub fn unit(&self) -> f64 {
        (1.0 + self.condition) * f64::ROUNDING
    }
}

fn places(layout: &Layout) -> [Vector<DoubleDouble>; BALLS] {
    layout.balls.map(|ball| Vector::new(DoubleDouble::of(ball.x), DoubleDouble::of(ball.y), DoubleDouble::of(0.0)))
}

/// Velocity and spin of a shot's cue ball.
pub fn motion<R: Real>(shot: &StudyShot) -> (Vector<R>, Vector<R>) {
    let (v, w) = (shot.impulse.velocity.extend(shot.impulse.lift), shot.impulse.spin);
    let vector = |v: glam::DVec3| Vector::new(R::of(v.x), R::of(v.y), R::of(v.z));
    (vector(v), vector(w))
}

/// Where a shot's balls are at rest; those that left the table are on their spots.
fn ends(table: &Table, shot: &Shot<DoubleDouble>) -> [Vector<DoubleDouble>; BALLS] {
    let spotted = places(&shot.layout(table));
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
    use crate::{
        physics,
        study::{
            shots::{Steepest, random_shots},
            stability::adversarial,
        },
    };

    fn judges_all(random: usize, adversarial_shots: usize) {
        let judge = |table: &Table, shot: &StudyShot| {
            let (velocity, spin) = motion(shot);
            play(&Numbers::of(table), places(&shot.layout), velocity, spin, by_extrema).unwrap();
        };
        for table in ["thesis", "textbook"].map(|name| Table::preset(name).unwrap()) {
            for shot in random_shots(&table, random, 1, Steepest::USUAL) {
                judge(&table, &shot);
            }
            let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
            for _ in 0..adversarial_shots {
                let shot = adversarial::shot(&table, &mut rng);
                let cue = physics::CueInputs::from(shot.cue);
                judge(&table, &StudyShot { layout: shot.layout, cue, impulse: physics::strike(&table, &cue) });
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
