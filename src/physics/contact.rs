//! Resting contact: the forces on balls that are pressed against cushions or each other, the limit of infinitely many
//! ever smaller bounces.
//!
//! Every force obeys a law of one of two kinds: a contact pushes just as hard as is needed to stay closed and never
//! pulls; friction holds up to its limit and then slips. All of them together form a complementarity problem in at most
//! a few dozen unknowns, which sweeps of projected Gauss-Seidel solve: each law in turn is satisfied with the others
//! held, until none changes. Conjugate directions between the sweeps (Silcowitz, Niebe and Erleben 2010) speed it up
//! where a ball sticks to several things at once.

use glam::{DVec2, DVec3};

use super::{BallState, ball_ball::contact_twist, slip};
use crate::table::{BALLS, Table};

/// Most contacts that three balls can have: with each other and with two cushions each.
pub const MAX_TOUCHES: usize = 9;

/// Speeds below this are none for the question whether something slips, m/s. It is well above the errors of the
/// integration, so that what sticks is seen to stick; the slip that is cut off would have moved a ball by less than
/// 1e-10 m.
pub const SLIP_TOLERANCE: f64 = 1e-10;

/// Sweeps end when no force per mass changes by more than this, m/s²: over a step of 0.01 s that is 1e-14 m/s.
const CONVERGED: f64 = 1e-12;

/// A bound on the sweeps. Convergence is geometric; a ball that sticks to cloth, cushion and another ball at once needs
/// some hundreds of them, all others a few.
const MAX_SWEEPS: usize = 1000;

/// The conjugate directions start afresh after so many sweeps, which keeps them from going in circles.
const RESTART: usize = 200;

/// A ball's contact with a cushion or with another ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// The ball on which the normal force acts along `n`.
    pub first: usize,
    /// The other ball, or `None` for a cushion.
    pub second: Option<usize>,
    /// The cushion's normal into the table; for two balls the normal follows from their positions.
    pub rail_normal: DVec2,
}

impl Touch {
    /// Unit normal towards the first ball.
    pub fn normal(&self, balls: &[BallState; BALLS]) -> DVec2 {
        match self.second {
            None => self.rail_normal,
            Some(second) => (balls[self.first].position - balls[second].position).normalize(),
        }
    }

    /// Speed at which the contact opens, m/s.
    pub fn opening_speed(&self, balls: &[BallState; BALLS]) -> f64 {
        self.relative_velocity(balls).dot(self.normal(balls))
    }

    /// Takes what is left of a slip out of the balls' spins.
    pub fn stop_slip(&self, radius: f64, balls: &mut [BallState; BALLS]) {
        let (n, along, up) = contact_slip(radius, balls, self);
        let share = if self.second.is_some() { 0.5 } else { 1.0 };
        let change = (share / radius) * (-up * n.perp()).extend(along);
        balls[self.first].spin += change;
        if let Some(second) = self.second {
            balls[second].spin += change;
        }
    }

    fn relative_velocity(&self, balls: &[BallState; BALLS]) -> DVec2 {
        balls[self.first].velocity - self.second.map_or(DVec2::ZERO, |second| balls[second].velocity)
    }
}

/// Which of the laws hold for the duration of one integration step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Laws {
    /// Whether each ball slips on the cloth.
    pub slips: [bool; BALLS],
    /// Whether each ball moves at all.
    pub moves: [bool; BALLS],
    /// Whether each ball spins about the vertical.
    pub spins: [bool; BALLS],
    /// Whether each contact slips.
    pub rubs: [bool; MAX_TOUCHES],
}

impl Laws {
    /// The laws that hold in the state `balls` with the given contacts.
    pub fn of(radius: f64, balls: &[BallState; BALLS], touches: &[Touch]) -> Self {
        let mut rubs = [false; MAX_TOUCHES];
        for (rub, touch) in rubs.iter_mut().zip(touches) {
            let (_, along, up) = contact_slip(radius, balls, touch);
            *rub = along.hypot(up) > SLIP_TOLERANCE;
        }
        Self {
            slips: balls.map(|ball| slip(radius, ball.velocity, ball.spin).length() > SLIP_TOLERANCE),
            moves: balls.map(|ball| ball.velocity.length() > SLIP_TOLERANCE),
            spins: balls.map(|ball| radius * ball.spin.z.abs() > SLIP_TOLERANCE),
            rubs,
        }
    }
}

/// Accelerations of all balls, and how hard each contact pushes.
#[derive(Clone, Copy, Debug)]
pub struct Forces {
    /// Acceleration, m/s².
    pub linear: [DVec2; BALLS],
    /// Angular acceleration, rad/s².
    pub angular: [DVec3; BALLS],
    /// Normal force per ball mass of each contact, m/s².
    pub normal: [f64; MAX_TOUCHES],
    /// Friction per mass of each contact along `t = z×n` and z, m/s².
    friction: [DVec2; MAX_TOUCHES],
    /// Friction per mass of the cloth on balls that do not slip, m/s².
    cloth: [DVec2; BALLS],
    /// Rolling resistance per mass on balls that do not move, m/s².
    resistance: [DVec2; BALLS],
    /// Angular acceleration by the cloth on balls that do not spin, rad/s².
    twist: [f64; BALLS],
}

/// The normal and the slip of a contact along `t = z×n` and along z, m/s (thesis equation 21).
fn contact_slip(radius: f64, balls: &[BallState; BALLS], touch: &Touch) -> (DVec2, f64, f64) {
    let n = touch.normal(balls);
    let t = n.perp();
    let spin = balls[touch.first].spin + touch.second.map_or(DVec3::ZERO, |second| balls[second].spin);
    let along = touch.relative_velocity(balls).dot(t) - radius * spin.z;
    (n, along, radius * spin.truncate().dot(t))
}

/// Accelerations of balls in resting contact. `laws` say what slips; balls without a contact follow their free motion.
/// The sweeps start from the forces of a `similar` state with the same contacts and laws, if there is one.
pub fn contact_forces(
    table: &Table,
    balls: &[BallState; BALLS],
    touches: &[Touch],
    laws: &Laws,
    similar: Option<&Forces>,
) -> Forces {
    let mut sweep = Sweep::new(table, balls, touches, laws);
    if let Some(similar) = similar {
        sweep.start_from(similar);
    }
    let mut direction = Forces::NONE;
    let mut last_size = f64::INFINITY;
    for count in 0..MAX_SWEEPS {
        let before = sweep.forces;
        sweep.change = 0.0;
        for ball in 0..BALLS {
            sweep.hold_on_cloth(ball);
        }
        for index in 0..touches.len() {
            sweep.push_apart(index);
        }
        if sweep.change < CONVERGED {
            break;
        }
        // Conjugate directions; the next sweep mends what the extrapolation breaks.
        let step = sweep.forces.plus(-1.0, &before);
        let size = step.size_squared(table.radius);
        let memory = size / last_size;
        last_size = size;
        if memory > 1.0 || count % RESTART == 0 {
            direction = Forces::NONE;
        } else {
            sweep.forces = sweep.forces.plus(memory, &direction);
            direction = step.plus(memory, &direction);
        }
    }
    sweep.forces
}

impl Forces {
    const NONE: Self = Self {
        linear: [DVec2::ZERO; BALLS],
        angular: [DVec3::ZERO; BALLS],
        normal: [0.0; MAX_TOUCHES],
        friction: [DVec2::ZERO; MAX_TOUCHES],
        cloth: [DVec2::ZERO; BALLS],
        resistance: [DVec2::ZERO; BALLS],
        twist: [0.0; BALLS],
    };

    /// `self + factor other`. Accelerations are linear in the forces, so they stay in step.
    fn plus(&self, factor: f64, other: &Self) -> Self {
        let mut sum = *self;
        for ball in 0..BALLS {
            sum.linear[ball] += factor * other.linear[ball];
            sum.angular[ball] += factor * other.angular[ball];
            sum.cloth[ball] += factor * other.cloth[ball];
            sum.resistance[ball] += factor * other.resistance[ball];
            sum.twist[ball] += factor * other.twist[ball];
        }
        for index in 0..MAX_TOUCHES {
            sum.normal[index] += factor * other.normal[index];
            sum.friction[index] += factor * other.friction[index];
        }
        sum
    }

    /// Squared size of all forces together, (m/s²)².
    fn size_squared(&self, radius: f64) -> f64 {
        let on_balls: f64 = (0..BALLS)
            .map(|ball| {
                self.cloth[ball].length_squared()
                    + self.resistance[ball].length_squared()
                    + (radius * self.twist[ball]).powi(2)
            })
            .sum();
        let between: f64 = self.normal.iter().zip(&self.friction).map(|(n, f)| n * n + f.length_squared()).sum();
        on_balls + between
    }
}

/// What a contact's law needs to know, worked out once a call.
#[derive(Clone, Copy, Default)]
struct Geometry {
    n: DVec2,
    t: DVec2,
    /// Acceleration along n that the curved course of two touching balls needs, m/s².
    centripetal: f64,
    /// Change of the slip's z part because t turns, m/s².
    turning: f64,
    /// Direction of the slip along t and z, or zero where it sticks.
    along: f64,
    up: f64,
}

struct Sweep<'a> {
    table: &'a Table,
    laws: &'a Laws,
    touches: &'a [Touch],
    geometry: [Geometry; MAX_TOUCHES],
    forces: Forces,
    change: f64,
}

impl<'a> Sweep<'a> {
    fn new(table: &'a Table, balls: &[BallState; BALLS], touches: &'a [Touch], laws: &'a Laws) -> Self {
        let radius = table.radius;
        let mut sweep = Self {
            table,
            laws,
            touches,
            geometry: [Geometry::default(); MAX_TOUCHES],
            forces: Forces::NONE,
            change: 0.0,
        };
        // What slips or rolls has a force of known size and direction: it is applied once.
        for (ball, state) in balls.iter().enumerate() {
            if laws.slips[ball] {
                let direction = slip(radius, state.velocity, state.spin).normalize();
                sweep.push_at_cloth(ball, direction * -(table.sliding_friction * table.gravity));
            } else if laws.moves[ball] {
                let resistance = state.velocity.normalize() * (table.rolling_friction * table.gravity);
                sweep.forces.linear[ball] -= resistance;
            }
            if laws.spins[ball] {
                sweep.forces.angular[ball].z -= sweep.spin_limit().copysign(state.spin.z);
            }
        }
        for (index, touch) in touches.iter().enumerate() {
            sweep.geometry[index] = sweep.geometry_of(balls, touch, laws.rubs[index]);
        }
        sweep
    }

    fn geometry_of(&self, balls: &[BallState; BALLS], touch: &Touch, rubs: bool) -> Geometry {
        let (n, along, up) = contact_slip(self.table.radius, balls, touch);
        let t = n.perp();
        let (mut centripetal, mut turning) = (0.0, 0.0);
        if let Some(second) = touch.second {
            let diameter = 2.0 * self.table.radius;
            let across = touch.relative_velocity(balls).dot(t);
            centripetal = across * across / diameter;
            let spin = balls[touch.first].spin + balls[second].spin;
            turning = -self.table.radius * (across / diameter) * spin.truncate().dot(n);
        }
        let slip = if rubs { along.hypot(up) } else { f64::INFINITY };
        Geometry { n, t, centripetal, turning, along: along / slip, up: up / slip }
    }

    fn spin_limit(&self) -> f64 {
        2.5 * self.table.spinning_friction * self.table.gravity / self.table.radius
    }

    /// A horizontal force per mass at the ball's lowest point.
    fn push_at_cloth(&mut self, ball: usize, force: DVec2) {
        self.forces.linear[ball] += force;
        // 5/(2R²) (-R z)×f.
        self.forces.angular[ball] -= (2.5 / self.table.radius * force.perp()).extend(0.0);
    }

    /// The cloth's laws where the ball does not slip, move or spin: static friction up to its limit.
    fn hold_on_cloth(&mut self, ball: usize) {
        if !self.laws.slips[ball] {
            let linear = self.forces.linear[ball];
            let angular = self.forces.angular[ball];
            let slip_rate = linear + self.table.radius * angular.truncate().perp();
            let limit = self.table.sliding_friction * self.table.gravity;
            let wanted = (self.forces.cloth[ball] - slip_rate / 3.5).clamp_length_max(limit);
            let step = wanted - self.forces.cloth[ball];
            self.hold(ball, step, DVec2::ZERO, 0.0);
            if !self.laws.moves[ball] {
                let limit = self.table.rolling_friction * self.table.gravity;
                let wanted = (self.forces.resistance[ball] - self.forces.linear[ball]).clamp_length_max(limit);
                let step = wanted - self.forces.resistance[ball];
                self.hold(ball, DVec2::ZERO, step, 0.0);
            }
        }
        if !self.laws.spins[ball] {
            let limit = self.spin_limit();
            let wanted = (self.forces.twist[ball] - self.forces.angular[ball].z).clamp(-limit, limit);
            self.hold(ball, DVec2::ZERO, DVec2::ZERO, wanted - self.forces.twist[ball]);
        }
    }

    /// Adds to the forces that hold a ball on the cloth.
    fn hold(&mut self, ball: usize, cloth: DVec2, resistance: DVec2, twist: f64) {
        self.forces.cloth[ball] += cloth;
        self.push_at_cloth(ball, cloth);
        self.forces.resistance[ball] += resistance;
        self.forces.linear[ball] += resistance;
        self.forces.twist[ball] += twist;
        self.forces.angular[ball].z += twist;
        let largest = cloth.length().max(resistance.length()).max(self.table.radius * twist.abs());
        self.change = self.change.max(largest);
    }

    /// A contact's laws: it stays closed or does not push; its friction is Coulomb's.
    fn push_apart(&mut self, index: usize) {
        let Touch { first, second, .. } = self.touches[index];
        let geometry = self.geometry[index];
        let share = if second.is_some() { 2.0 } else { 1.0 };
        let linear = self.forces.linear[first] - second.map_or(DVec2::ZERO, |ball| self.forces.linear[ball]);
        let opening = linear.dot(geometry.n) + geometry.centripetal;
        let normal = (self.forces.normal[index] - opening / share).max(0.0);
        self.press(index, normal - self.forces.normal[index], DVec2::ZERO);

        let mu = if second.is_some() { self.table.ball_friction } else { Some(self.table.rail_friction) };
        // A contact that never slips holds even where it hardly pushes: letting go at zero would have no solution.
        let wanted = match mu {
            Some(mu) if self.laws.rubs[index] => DVec2::new(geometry.along, geometry.up) * -(mu * normal),
            _ => {
                let held = self.forces.friction[index] - self.slip_rate(index) / (3.5 * share);
                mu.map_or(held, |mu| held.clamp_length_max(mu * normal))
            }
        };
        self.press(index, 0.0, wanted - self.forces.friction[index]);
    }

    /// Adds to the forces of a contact.
    fn press(&mut self, index: usize, normal: f64, friction: DVec2) {
        let Touch { first, second, .. } = self.touches[index];
        let Geometry { n, t, .. } = self.geometry[index];
        self.forces.normal[index] += normal;
        self.forces.friction[index] += friction;
        let push = normal * n + friction.x * t;
        let twist = contact_twist(self.table.radius, friction.x, friction.y, t);
        self.forces.linear[first] += push;
        self.forces.angular[first] -= twist;
        if let Some(second) = second {
            self.forces.linear[second] -= push;
            self.forces.angular[second] -= twist;
        }
        self.change = self.change.max(normal.abs()).max(friction.length());
    }

    /// Takes over the forces of a similar state as a first guess.
    fn start_from(&mut self, similar: &Forces) {
        for ball in 0..BALLS {
            self.hold(ball, similar.cloth[ball], similar.resistance[ball], similar.twist[ball]);
        }
        for index in 0..self.touches.len() {
            self.press(index, similar.normal[index], similar.friction[index]);
        }
    }

    /// Rate of change of a contact's slip along t and z, m/s².
    fn slip_rate(&self, index: usize) -> DVec2 {
        let Touch { first, second, .. } = self.touches[index];
        let Geometry { t, turning, .. } = self.geometry[index];
        let radius = self.table.radius;
        let linear = self.forces.linear[first] - second.map_or(DVec2::ZERO, |ball| self.forces.linear[ball]);
        let angular = self.forces.angular[first] + second.map_or(DVec3::ZERO, |ball| self.forces.angular[ball]);
        DVec2::new(linear.dot(t) - radius * angular.z, radius * angular.truncate().dot(t) + turning)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALONE: [BallState; 2] = [BallState::at_rest(DVec2::new(0.5, 0.0)), BallState::at_rest(DVec2::new(-0.5, 0.0))];

    fn forces(ball: BallState, touches: &[Touch]) -> Forces {
        let table = Table::preset("thesis").unwrap();
        let balls = [ball, ALONE[0], ALONE[1]];
        contact_forces(&table, &balls, touches, &Laws::of(table.radius, &balls, touches), None)
    }

    #[test]
    fn a_cushion_pushes_back_just_what_the_cloth_presses() {
        let table = Table::preset("thesis").unwrap();
        let position = DVec2::new(table.half_length(), 0.0);
        // Topspin towards the right cushion, and some speed along it.
        let ball = BallState { position, velocity: DVec2::new(0.0, 0.7), spin: DVec3::new(3.0, 80.0, -5.0) };
        let touch = Touch { first: 0, second: None, rail_normal: DVec2::NEG_X };
        let forces = forces(ball, &[touch]);
        let u = slip(table.radius, ball.velocity, ball.spin).normalize();
        let pressed = table.sliding_friction * table.gravity * -u.x;
        assert!((forces.normal[0] - pressed).abs() < 1e-14);
        assert!(forces.linear[0].x.abs() < 1e-14);
        // The ball slips along +y on the cushion: the friction opposes it and has at most Coulomb's size.
        let friction = forces.linear[0].y + table.sliding_friction * table.gravity * u.y;
        assert!(friction.abs() <= table.rail_friction * pressed + 1e-14 && friction < 0.0);
    }

    #[test]
    fn a_cushion_never_pulls() {
        let table = Table::preset("thesis").unwrap();
        let position = DVec2::new(table.half_length(), 0.0);
        let ball = BallState { position, velocity: DVec2::ZERO, spin: DVec3::new(0.0, -80.0, 0.0) };
        let touch = Touch { first: 0, second: None, rail_normal: DVec2::NEG_X };
        let forces = forces(ball, &[touch]);
        assert_eq!(forces.normal[0], 0.0);
        assert!(forces.linear[0].x < 0.0);
    }

    #[test]
    fn a_free_rolling_ball_decelerates_by_five_sevenths_of_the_resistance() {
        let table = Table::preset("thesis").unwrap();
        let velocity = DVec2::new(0.4, 0.3);
        let spin = crate::physics::rolling_spin(table.radius, velocity).extend(0.0);
        let forces = forces(BallState { position: DVec2::ZERO, velocity, spin }, &[]);
        let expected = velocity.normalize() * -crate::physics::rolling_deceleration(&table);
        assert!(forces.linear[0].distance(expected) < 1e-14, "{forces:?}");
    }
}
