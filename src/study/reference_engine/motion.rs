//! Motion of one ball between two events (thesis 2.1).

use super::{Numbers, Real, Vector};

/// The equation of motion in force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Motion {
    /// At rest, perhaps spinning on the spot.
    Stationary,
    /// Rolling without slip.
    Rolling,
    /// Slipping on the cloth.
    Sliding,
    /// In the air, or hopping.
    Flying,
    /// Has left the table.
    OffTable,
}

/// A speed band of constant deceleration of a rolling ball, which keeps its direction.
#[derive(Clone, Copy, Debug)]
pub struct Band<R> {
    /// Deceleration, m/s².
    pub deceleration: R,
    /// Speed at which the band ends, m/s; zero for rest.
    pub end: R,
}

/// The state of a ball.
#[derive(Clone, Copy, Debug)]
pub struct Ball<R> {
    /// Centre, m; `z` is its height above that of a ball on the cloth.
    pub position: Vector<R>,
    /// Velocity, m/s.
    pub velocity: Vector<R>,
    /// Angular velocity, rad/s.
    pub spin: Vector<R>,
    /// The equation of motion in force.
    pub motion: Motion,
    /// The deceleration band of a free rolling ball, once it is chosen.
    pub band: Option<Band<R>>,
}

impl<R: Real> Ball<R> {
    /// Returns a ball at rest.
    pub fn at_rest(position: Vector<R>) -> Self {
        let zero = Vector::zero();
        Self { position, velocity: zero, spin: zero, motion: Motion::Stationary, band: None }
    }

    /// Chooses the band of a free ball that begins to roll; a ball that is `pressed` has none.
    pub fn choose_band(&mut self, numbers: &Numbers<R>, pressed: bool) {
        if pressed || self.motion != Motion::Rolling {
            self.band = None;
        } else if self.band.is_none() {
            self.band = Some(numbers.band(self.velocity.length()));
        }
    }

    /// Returns the band of a rolling ball.
    fn rolls(&self, numbers: &Numbers<R>) -> Band<R> {
        self.band.unwrap_or_else(|| numbers.band(self.velocity.length()))
    }

    /// Whether the ball continues to roll in another band after this one.
    pub fn rolls_on(&self) -> bool {
        self.motion == Motion::Rolling && self.band.is_some_and(|band| band.end > R::zero())
    }

    /// Returns the slip velocity at the cloth: `v + R z×w` (thesis equation 1).
    pub fn slip(&self, numbers: &Numbers<R>) -> Vector<R> {
        (self.velocity + Vector::up().cross(self.spin) * numbers.radius).flat()
    }

    /// Returns kinetic and potential energy per mass: `v²/2 + R²w²/5 + gz`.
    pub fn energy(&self, numbers: &Numbers<R>) -> R {
        let around = numbers.radius * numbers.radius * self.spin.dot(self.spin);
        R::of(0.5) * self.velocity.dot(self.velocity) + around / R::of(5.0) + numbers.gravity * self.position.z
    }

    /// Returns the acceleration of a free ball.
    pub fn acceleration(&self, numbers: &Numbers<R>) -> Vector<R> {
        match self.motion {
            Motion::Sliding => self.slip(numbers).direction() * -numbers.slide,
            Motion::Rolling => self.velocity.direction() * -self.rolls(numbers).deceleration,
            Motion::Flying => Vector::up() * -numbers.gravity,
            Motion::Stationary | Motion::OffTable => Vector::zero(),
        }
    }

    /// Returns the duration of a free ball's motion (thesis equations 25 and 26); for a flying ball, the time until it lands.
    pub fn motion_duration(&self, numbers: &Numbers<R>) -> Option<R> {
        match self.motion {
            Motion::Sliding => Some(R::ratio(2.0, 7.0) * self.slip(numbers).length() / numbers.slide),
            Motion::Rolling => {
                let Band { deceleration, end } = self.rolls(numbers);
                Some((self.velocity.length() - end) / deceleration)
            }
            Motion::Flying => {
                let (height, climb) = (self.position.z.max(R::zero()), self.velocity.z);
                let landing = (climb * climb + R::of(2.0) * numbers.gravity * height).sqrt();
                // Uses the form of the root that does not cancel.
                Some(if climb > R::zero() {
                    (climb + landing) / numbers.gravity
                } else if landing > R::zero() {
                    R::of(2.0) * height / (landing - climb)
                } else {
                    R::zero()
                })
            }
            Motion::Stationary | Motion::OffTable => None,
        }
    }

    /// Returns the motion on the cloth, if slips and speeds up to `none`, m/s, count as zero.
    pub fn on_cloth(&self, numbers: &Numbers<R>, none: R) -> Motion {
        if self.slip(numbers).length() > none {
            Motion::Sliding
        } else if self.velocity.length() > none {
            Motion::Rolling
        } else {
            Motion::Stationary
        }
    }

    /// Chooses the motion after an impact; slips of the size of rounding count as zero.
    pub fn choose_motion_after_impact(&mut self, numbers: &Numbers<R>) {
        let speeds = self.velocity.length() + numbers.radius * self.spin.flat().length();
        self.choose_motion(numbers, R::of(16.0 * R::ROUNDING) * speeds);
    }

    /// Chooses the motion, and sets slips and speeds up to `none`, m/s, to exactly zero. A ball that is above the cloth or
    /// moves upwards flies.
    pub fn choose_motion(&mut self, numbers: &Numbers<R>, none: R) {
        self.band = None;
        if self.motion == Motion::OffTable {
            return;
        }
        if self.position.z > R::zero() || self.velocity.z > R::zero() {
            self.motion = Motion::Flying;
            return;
        }
        self.motion = self.on_cloth(numbers, none);
        match self.motion {
            Motion::Sliding | Motion::Flying | Motion::OffTable => {}
            Motion::Rolling => _ = Motion::Sliding.successor(self, numbers),
            Motion::Stationary => _ = Motion::Rolling.successor(self, numbers),
        }
    }

    /// Returns the free ball `time` later (thesis equations 2, 3, 6 and 8), and the work of friction per mass.
    pub fn after(&self, numbers: &Numbers<R>, time: R) -> (Self, R) {
        let acceleration = self.acceleration(numbers);
        let mut ball = *self;
        ball.velocity = self.velocity + acceleration * time;
        ball.position = self.position + self.velocity * time + acceleration * (R::of(0.5) * time * time);
        let half = R::of(0.5);
        let mut work = R::zero();
        match self.motion {
            Motion::Sliding => {
                let slip = self.slip(numbers);
                let turning = Vector::up().cross(slip.direction()) * (R::of(2.5) * numbers.slide / numbers.radius);
                ball.spin = self.spin + turning * time;
                work = numbers.slide * time * (slip.length() - R::of(1.75) * numbers.slide * time);
            }
            Motion::Rolling => {
                ball.spin = Vector::up().cross(ball.velocity) * (R::of(1.0) / numbers.radius);
                let resistance = R::ratio(7.0, 5.0) * self.rolls(numbers).deceleration;
                work = resistance * (ball.position - self.position).length();
            }
            Motion::Stationary => {}
            // The spin is constant in the air.
            Motion::Flying | Motion::OffTable => return (ball, work),
        }
        let size = self.spin.z.abs();
        let lost = (numbers.spin_deceleration * time).min(size);
        ball.spin.z = if self.spin.z < R::zero() { lost - size } else { size - lost };
        let turned = lost * (size - half * lost);
        work = work + R::ratio(2.0, 5.0) * numbers.radius * numbers.radius * turned;
        (ball, work)
    }
}

impl Motion {
    /// Returns the motion after the full duration of this one, and sets the speed or slip that has ended to exactly zero.
    #[must_use]
    pub fn successor<R: Real>(self, ball: &mut Ball<R>, numbers: &Numbers<R>) -> Self {
        if self == Self::Rolling {
            ball.velocity = Vector::zero();
        }
        let up_spin = Vector::up() * ball.spin.z;
        ball.spin = Vector::up().cross(ball.velocity) * (R::of(1.0) / numbers.radius) + up_spin;
        if ball.velocity == Vector::zero() { Self::Stationary } else { Self::Rolling }
    }
}
