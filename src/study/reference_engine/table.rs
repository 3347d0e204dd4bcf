//! The parameters of a table in the precision of the engine.

use super::{
    Real, Unjudged, Vector,
    motion::Band,
    rails::{Cushion, RailLaw, RestitutionFade},
};
use crate::{physics::FIRST_BOUNCE, simulation::Rail, table::Table};

/// Slowest bounce in the air, and slowest speed at which a stroke lifts a ball, in units of `√(g R)`.
const SLOWEST_IN_AIR: f64 = 4e-3;

/// A rail lifts a ball if its upward speed would exceed this, in units of `√(g R)`.
const LIFTS: f64 = 2e-2;

/// Parameters of how balls leave the cloth and land on it.
#[derive(Clone, Copy, Debug)]
pub struct Flight<R> {
    /// Restitution `e_c` of the cloth.
    pub restitution: R,
    /// Friction `mu_c` of the cloth with a ball that is pressed into it.
    pub friction: R,
    /// Slowest bounce in the air, and the speed above which the cloth throws up a ball, m/s.
    pub slowest: R,
    /// Speed above which a rail throws up a ball, m/s.
    pub lifts: R,
}

/// The table parameters of the equations, in SI units.
#[derive(Clone, Copy, Debug)]
pub struct Numbers<R> {
    /// Ball radius `R`.
    pub radius: R,
    /// Mass over moment of inertia, `5/(2R²)`, 1/m².
    pub mass_over_inertia: R,
    /// Largest |x| of a ball's centre, `L/2 - R`.
    pub half_length: R,
    /// Largest |y| of a ball's centre, `l/2 - R`.
    pub half_width: R,
    /// `mu_s g`, m/s².
    pub slide: R,
    /// `mu_r g`, m/s².
    pub roll: R,
    /// Increase of a rolling ball's deceleration per speed, 1/s.
    pub roll_growth: R,
    /// Deceleration of `w_z`: `5 mu_sp g / 2R`, rad/s².
    pub spin_deceleration: R,
    /// Restitution between balls.
    pub ball_restitution: R,
    /// Decrease of this restitution with the speed of the impact, `None` if it is constant.
    pub ball_fade: Option<RestitutionFade<R>>,
    /// Friction between balls, `None` for contacts that never slip.
    pub ball_friction: Option<R>,
    /// Slip-dependent friction of ball-ball impacts: minimum, increase at slow slip, and decay rate of the increase, s/m.
    pub ball_slip_friction: Option<[R; 3]>,
    /// The cushions in the order of [`Rail::ALL`].
    pub cushions: [Cushion<R>; 4],
    /// Speed at which contacts of balls that never slip begin to bounce, m/s.
    pub first_bounce: R,
    /// Ball mass over cue mass.
    pub mass_ratio: R,
    /// Ball mass over the effective end mass of the cue, `None` for a cue without squirt.
    pub end_ratio: Option<R>,
    /// Whether the table is level.
    is_level: bool,
    /// Gravitational acceleration, m/s².
    pub gravity: R,
    /// How balls leave the cloth, `None` if they stay on it.
    pub flight: Option<Flight<R>>,
}

impl<R: Real> Numbers<R> {
    /// Returns the parameters of `table`, whose `f64` count as exact.
    pub fn of(table: &Table) -> Self {
        let (radius, gravity, half) = (R::of(table.radius), R::of(table.gravity), R::of(0.5));
        let mass = R::of(table.ball_mass);
        Self {
            radius,
            mass_over_inertia: R::of(2.5) / (radius * radius),
            half_length: half * R::of(table.length) - radius,
            half_width: half * R::of(table.width) - radius,
            slide: R::of(table.sliding_friction) * gravity,
            roll: R::of(table.rolling_friction) * gravity,
            roll_growth: R::of(table.rolling_growth),
            spin_deceleration: R::of(2.5) * R::of(table.spinning_friction) * gravity / radius,
            ball_restitution: R::of(table.ball_restitution),
            ball_fade: table.ball_fade.map(RestitutionFade::of),
            ball_friction: table.ball_friction.map(R::of),
            ball_slip_friction: table.ball_slip_friction.map(|law| [law.least, law.rise, law.fade].map(R::of)),
            cushions: Rail::ALL.map(|rail| Cushion::of(table, rail)),
            first_bounce: R::of(FIRST_BOUNCE) * (gravity * radius).sqrt(),
            mass_ratio: mass / R::of(table.cue_mass),
            end_ratio: table.cue_end_mass.map(|end| mass / R::of(end)),
            is_level: table.tilt == glam::DVec2::ZERO,
            gravity,
            flight: table.flight.map(|flight| Flight {
                restitution: R::of(flight.restitution),
                friction: R::of(flight.friction.unwrap_or(table.sliding_friction)),
                slowest: R::of(SLOWEST_IN_AIR) * (gravity * radius).sqrt(),
                lifts: R::of(LIFTS) * (gravity * radius).sqrt(),
            }),
        }
    }

    /// Returns the same table with this restitution in every impact, at any speed, and cushions that balls meet at the height
    /// of their centres. No restitution is the limit of endless bounces.
    #[must_use]
    pub fn with_restitution(&self, restitution: R) -> Self {
        let with = |cushion: Cushion<R>| Cushion { restitution, fade: None, law: RailLaw::Equator, ..cushion };
        Self { ball_restitution: restitution, ball_fade: None, cushions: self.cushions.map(with), ..*self }
    }

    /// Checks that this engine has all laws of the table.
    ///
    /// # Errors
    /// [`Unjudged`], which names the missing law.
    pub fn check_supported(&self) -> Result<(), Unjudged> {
        if self.cushions.iter().any(|cushion| matches!(cushion.law, RailLaw::Integrated)) {
            Err(Unjudged::IntegratedRail)
        } else if self.is_level {
            Ok(())
        } else {
            Err(Unjudged::Slope)
        }
    }

    /// Returns the restitution of two balls at a normal speed, m/s.
    pub fn ball_restitution_at(&self, speed: R) -> R {
        self.ball_fade.map_or(self.ball_restitution, |fade| fade.at(self.ball_restitution, speed))
    }

    /// Returns the friction of an impact of two balls at a slip, m/s; `None` for contacts that never slip.
    pub fn ball_friction_at(&self, slip: R) -> Option<R> {
        let by_slip = self.ball_slip_friction.map(|[least, rise, fade]| least + rise * (-fade * slip).exp());
        by_slip.or(self.ball_friction)
    }

    /// Returns the cushion of a rail.
    pub fn cushion(&self, rail: Rail) -> &Cushion<R> {
        &self.cushions[rail as usize]
    }

    /// Returns how far a ball's centre can move towards `rail` from the table's centre, m.
    pub fn reach(&self, rail: Rail) -> R {
        match rail {
            Rail::Left | Rail::Right => self.half_length,
            Rail::Bottom | Rail::Top => self.half_width,
        }
    }

    /// Returns the band of a ball that begins to roll with `speed`, m/s.
    ///
    /// The bands are those of `physics::rolling`: the last band starts where `c1 v` is 0.059 `c0`, any other covers the share
    /// `a / (a + 4.3 c1 v)` of its initial speed.
    pub fn band(&self, speed: R) -> Band<R> {
        let (least, growth) = (R::ratio(5.0, 7.0) * self.roll, self.roll_growth);
        if growth <= R::zero() {
            return Band { deceleration: least, end: R::zero() };
        }
        let pull = growth * speed;
        let end = if pull <= R::of(0.059) * least {
            R::zero()
        } else {
            let fast = least + pull;
            speed - speed * fast / (fast + R::of(4.3) * pull)
        };
        let (width, middle) = (speed - end, R::of(0.5) * (speed + end));
        let mean = least + growth * middle;
        let second = growth * width * width;
        let deceleration = mean + second * (R::of(1.0) / (R::of(24.0) * middle) - growth / (R::of(12.0) * mean));
        Band { deceleration, end }
    }
}

/// Returns the unit vector from a cushion into the table.
pub fn normal<R: Real>(rail: Rail) -> Vector<R> {
    let (zero, one) = (R::zero(), R::of(1.0));
    match rail {
        Rail::Left => Vector::new(one, zero, zero),
        Rail::Right => Vector::new(-one, zero, zero),
        Rail::Bottom => Vector::new(zero, one, zero),
        Rail::Top => Vector::new(zero, -one, zero),
    }
}
