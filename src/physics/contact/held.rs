//! Forces where it is known which contacts push and which frictions hold: what is held has a rate of zero, which makes a
//! small linear system in the contacts' forces. What the cloth holds is taken out beforehand: a ball that rolls or stands
//! answers to a force with less motion than one that slides.

use glam::{DVec2, DVec3};

use super::{ActiveSet, Contact, Forces, Friction, MAX_CONTACTS, linear::{factorize, substitute}, problem::coefficient};
use crate::{
    physics::{BallState, slip},
    table::{BALLS, Table},
};

/// Most unknowns: a normal force and two frictions a contact.
const MOST: usize = 3 * MAX_CONTACTS;

/// Added to a diagonal whose entries are 1 to 10, where forces are not unique: a ball that is held by several things at once.
/// It picks the forces nearest to what they were; further steps take its effect out again.
const PROXIMITY: f64 = 1e-7;

/// A system with pivots below this share of the largest has no unique solution.
const SINGULAR: f64 = 1e-6;

/// Rounds of refinement that take the effect of [`PROXIMITY`] out again.
const MAX_REFINEMENTS: usize = 8;

/// Residuals below this share of the largest number are rounding.
const ROUNDING: f64 = 4096.0 * f64::EPSILON;

/// Accelerations, speeds or their changes: of the centre, and R times those of the spin.
#[derive(Clone, Copy, Debug)]
pub(super) struct Movement {
    pub linear: [DVec2; BALLS],
    pub angular: [DVec3; BALLS],
}

impl Movement {
    pub const NONE: Self = Self { linear: [DVec2::ZERO; BALLS], angular: [DVec3::ZERO; BALLS] };
}

/// How the cloth holds a ball.
#[derive(Clone, Copy, PartialEq)]
enum Cloth {
    Slides,
    Rolls,
    Stands,
}

/// The cloth's forces on a ball that it holds: against slip, against rolling, against spin.
type Holding = (DVec2, DVec2, f64);

/// What the cloth does to a ball that would move otherwise.
#[derive(Clone, Copy)]
struct Grip {
    cloth: Cloth,
    /// Whether the spin about the vertical is held.
    spin: bool,
}

impl Grip {
    fn of(set: &ActiveSet, ball: usize) -> Self {
        let cloth = match (set.cloth[ball], set.roll[ball]) {
            (Friction::Slips(_), _) => Cloth::Slides,
            (_, Friction::Slips(_)) => Cloth::Rolls,
            _ => Cloth::Stands,
        };
        Self { cloth, spin: !matches!(set.spin[ball], Friction::Slips(_)) }
    }

    /// The forces that hold a ball which would move like this without them.
    fn holding(self, linear: DVec2, angular: DVec3) -> Holding {
        let around = angular.truncate();
        let (cloth, roll) = match self.cloth {
            Cloth::Slides => (DVec2::ZERO, DVec2::ZERO),
            // The slip's rate is a + z×Rα, and a force at the lowest point adds 7/2 of itself.
            Cloth::Rolls => ((linear + around.perp()) / -3.5, DVec2::ZERO),
            Cloth::Stands => {
                let cloth = around.perp() / -2.5;
                (cloth, -(linear + cloth))
            }
        };
        (cloth, roll, if self.spin { angular.z / -2.5 } else { 0.0 })
    }

    /// The movement that is left.
    fn held(self, linear: DVec2, angular: DVec3) -> (DVec2, DVec3) {
        let around = angular.truncate();
        let spin = if self.spin { 0.0 } else { angular.z };
        match self.cloth {
            Cloth::Slides => (linear, around.extend(spin)),
            Cloth::Stands => (DVec2::ZERO, DVec3::new(0.0, 0.0, spin)),
            Cloth::Rolls => {
                let force = (linear + around.perp()) / -3.5;
                (linear + force, (around - 2.5 * force.perp()).extend(spin))
            }
        }
    }
}

/// An unknown force in a contact: its direction, and the direction whose rate it keeps at zero.
#[derive(Clone, Copy)]
struct Unknown {
    contact: usize,
    /// What a unit of it does to the first ball; the second gets the opposite push and the same twist.
    push: DVec2,
    twist: DVec3,
    /// The row of the rate.
    along: DVec2,
    around: DVec3,
    /// What the rate has besides, m/s²: two balls' courses around each other bend.
    bias: f64,
}

/// The linear system of one regime in one state.
pub(super) struct Held<'a> {
    contacts: &'a [Contact],
    grips: [Grip; BALLS],
    unknowns: [Unknown; MOST],
    count: usize,
    /// Friction against each contact's normal force, per unit of it, along t and z; none where it holds.
    rubbing: [Option<DVec2>; MAX_CONTACTS],
    /// Sizes of the unknowns.
    pub sizes: [f64; MOST],
}

impl<'a> Held<'a> {
    /// The system of the `contacts`; `rubs` says whether normal forces bring the friction of contacts that slip with them.
    pub fn new(
        table: &Table,
        balls: &[BallState; BALLS],
        contacts: &'a [Contact],
        set: &ActiveSet,
        rubs: impl Fn(&Contact) -> bool,
    ) -> Self {
        let none = Unknown {
            contact: 0,
            push: DVec2::ZERO,
            twist: DVec3::ZERO,
            along: DVec2::ZERO,
            around: DVec3::ZERO,
            bias: 0.0,
        };
        let mut system = Self {
            contacts,
            grips: std::array::from_fn(|ball| Grip::of(set, ball)),
            unknowns: [none; MOST],
            count: 0,
            rubbing: [None; MAX_CONTACTS],
            sizes: [0.0; MOST],
        };
        for (index, contact) in contacts.iter().enumerate() {
            let (n, slip) = contact.normal_and_slip(table.radius, balls);
            let t = n.perp();
            let (mut centripetal, mut turning) = (0.0, 0.0);
            if let Some(second) = contact.second {
                let diameter = 2.0 * table.radius;
                let across = contact.relative_velocity(balls).dot(t);
                centripetal = across * across / diameter;
                // The slip's z part changes because t turns, its t part because n does (to which v·n = 0 adds nothing).
                let spin = balls[contact.first].spin + balls[second].spin;
                turning = -table.radius * (across / diameter) * spin.truncate().dot(n);
            }
            let twist = |along: f64, up: f64| 2.5 * (up * t).extend(-along);
            let row = |push, twist, along, around, bias| Unknown { contact: index, push, twist, along, around, bias };
            if let Some(against) = set.contact[index].direction(slip) {
                let mu = if rubs(contact) { coefficient(table, contact) } else { 0.0 };
                let rub = -mu * against;
                system.rubbing[index] = Some(rub);
                system.push(row(n + rub.x * t, twist(rub.x, rub.y), n, DVec3::ZERO, centripetal));
            } else {
                system.push(row(n, DVec3::ZERO, n, DVec3::ZERO, centripetal));
                system.push(row(t, twist(1.0, 0.0), t, DVec3::NEG_Z, 0.0));
                system.push(row(DVec2::ZERO, twist(0.0, 1.0), DVec2::ZERO, t.extend(0.0), turning));
            }
        }
        system
    }

    fn push(&mut self, unknown: Unknown) {
        self.unknowns[self.count] = unknown;
        self.count += 1;
    }

    fn members(&self, unknown: &Unknown) -> [Option<(usize, f64)>; 2] {
        let contact = &self.contacts[unknown.contact];
        [Some((contact.first, 1.0)), contact.second.map(|second| (second, -1.0))]
    }

    /// The rate of an unknown's direction in a movement.
    fn rate(&self, unknown: &Unknown, movement: &Movement) -> f64 {
        self.members(unknown).into_iter().flatten().fold(0.0, |rate, (ball, sense)| {
            rate + sense * unknown.along.dot(movement.linear[ball]) + unknown.around.dot(movement.angular[ball])
        })
    }

    /// Finds the sizes for which all rates vanish if the balls would move like `free` without the contacts; `bends` says
    /// whether the courses' bends count. Returns the movement; none where they cannot vanish together.
    pub fn solve(&mut self, free: &Movement, bends: bool) -> Option<Movement> {
        let count = self.count;
        let mut matrix = [0.0; MOST * MOST];
        for (column, unknown) in self.unknowns[..count].iter().enumerate() {
            let mut response = Movement::NONE;
            for (ball, sense) in self.members(unknown).into_iter().flatten() {
                (response.linear[ball], response.angular[ball]) =
                    self.grips[ball].held(sense * unknown.push, unknown.twist);
            }
            for (row, other) in self.unknowns[..count].iter().enumerate() {
                matrix[row * count + column] = self.rate(other, &response);
            }
        }
        let mut pivots = [0; MOST];
        let (pivots, entries) = (&mut pivots[..count], count * count);
        let mut factors = [0.0; MOST * MOST];
        let factors = &mut factors[..entries];
        factors.copy_from_slice(&matrix[..entries]);
        let unique = factorize(factors, pivots) > SINGULAR;
        if unique {
            self.sizes = [0.0; MOST];
        } else {
            factors.copy_from_slice(&matrix[..entries]);
            for index in 0..count {
                factors[index * (count + 1)] += PROXIMITY;
            }
            factorize(factors, pivots);
        }
        let scale = (0..BALLS).fold(f64::MIN_POSITIVE, |scale, ball| {
            scale.max(free.linear[ball].abs().max_element()).max(free.angular[ball].abs().max_element())
        });
        let mut smallest = f64::INFINITY;
        for _ in 0..MAX_REFINEMENTS {
            let moved = self.moved(&self.under_forces(free));
            let mut side = [0.0; MOST];
            let (mut residual, mut scale) = (0.0_f64, scale);
            for (side, (unknown, size)) in side.iter_mut().zip(self.unknowns[..count].iter().zip(&self.sizes)) {
                let bias = if bends { unknown.bias } else { 0.0 };
                *side = -(self.rate(unknown, &moved) + bias);
                residual = residual.max(side.abs());
                scale = scale.max(size.abs()).max(bias.abs());
            }
            // Once rounding is reached, more rounds would only stir it.
            if residual <= 16.0 * f64::EPSILON * scale
                || (residual <= ROUNDING * scale && (unique || residual >= 0.5 * smallest))
            {
                return Some(moved);
            }
            smallest = smallest.min(residual);
            substitute(factors, pivots, &mut side[..count]);
            for (size, change) in self.sizes.iter_mut().zip(&side[..count]) {
                *size += change;
            }
        }
        None
    }

    /// The movement under the contacts' forces, before the cloth holds it.
    fn under_forces(&self, free: &Movement) -> Movement {
        let mut sum = *free;
        for (unknown, size) in self.unknowns[..self.count].iter().zip(self.sizes) {
            for (ball, sense) in self.members(unknown).into_iter().flatten() {
                sum.linear[ball] += sense * size * unknown.push;
                sum.angular[ball] += size * unknown.twist;
            }
        }
        sum
    }

    /// What the cloth leaves of a movement.
    fn moved(&self, free: &Movement) -> Movement {
        let mut moved = *free;
        for ball in 0..BALLS {
            if self.contacts.iter().any(|contact| contact.has(ball)) {
                (moved.linear[ball], moved.angular[ball]) =
                    self.grips[ball].held(free.linear[ball], free.angular[ball]);
            }
        }
        moved
    }
}

/// The forces where what pushes and holds is known: a smooth function of the state, also a little beyond the regime's end,
/// which [`Forces::slack`] tells. Where they are not unique they are those nearest to the `similar` ones.
pub fn forces(
    table: &Table,
    balls: &[BallState; BALLS],
    contacts: &[Contact],
    set: &ActiveSet,
    similar: Option<&Forces>,
) -> Option<Forces> {
    let mut system = Held::new(table, balls, contacts, set, |_| true);
    if let Some(similar) = similar {
        let mut at = 0;
        for index in 0..contacts.len() {
            system.sizes[at] = similar.normal[index];
            at += 1;
            if system.rubbing[index].is_none() {
                (system.sizes[at], system.sizes[at + 1]) = (similar.friction[index].x, similar.friction[index].y);
                at += 2;
            }
        }
    }
    let [sliding, rolling, boring] =
        [table.sliding_friction, table.rolling_friction, table.spinning_friction].map(|mu| mu * table.gravity);
    let mut free = Movement::NONE;
    let members: [bool; BALLS] = std::array::from_fn(|ball| contacts.iter().any(|contact| contact.has(ball)));
    let mut forces = Forces::NONE;
    for ball in (0..BALLS).filter(|&ball| members[ball]) {
        let state = &balls[ball];
        let (linear, angular) = (&mut free.linear[ball], &mut free.angular[ball]);
        if let Some(against) = set.cloth[ball].direction(slip(table.radius, state.velocity, state.spin)) {
            *linear = -sliding * against;
            *angular = (2.5 * sliding * against.perp()).extend(0.0);
        } else if let Some(against) = set.roll[ball].direction(state.velocity) {
            *linear = -rolling * against;
        }
        if let Friction::Slips(sign) = set.spin[ball] {
            angular.z = -2.5 * boring * sign.x;
            if sign.x != 0.0 && state.spin.z * sign.x < 0.0 {
                // It has ended before.
                forces.slack = forces.slack.min(table.radius * state.spin.z * sign.x);
            }
        }
    }
    let moved = system.solve(&free, true)?;
    let unheld = system.under_forces(&free);
    let mut limit = |limit: f64, force: f64| forces.slack = forces.slack.min(limit - force);
    for ball in (0..BALLS).filter(|&ball| members[ball]) {
        let grip = system.grips[ball];
        let (cloth, roll, spin) = grip.holding(unheld.linear[ball], unheld.angular[ball]);
        (forces.cloth[ball], forces.roll[ball], forces.spin[ball]) = (cloth, roll, spin);
        if grip.cloth != Cloth::Slides {
            limit(sliding, cloth.length());
        }
        if grip.cloth == Cloth::Stands {
            limit(rolling, roll.length());
        }
        if grip.spin {
            limit(boring, spin.abs());
        }
        forces.linear[ball] = moved.linear[ball];
        forces.angular[ball] = moved.angular[ball] / table.radius;
    }
    let mut at = 0;
    for (index, contact) in contacts.iter().enumerate() {
        let normal = system.sizes[at];
        forces.normal[index] = normal;
        limit(normal, 0.0);
        at += 1;
        forces.friction[index] = if let Some(rub) = system.rubbing[index] {
            normal * rub
        } else {
            let friction = DVec2::new(system.sizes[at], system.sizes[at + 1]);
            limit(coefficient(table, contact) * normal, friction.length());
            at += 2;
            friction
        };
    }
    Some(forces)
}

/// Takes out of velocities and spins what is left of speeds that are to be zero: the opening of `contacts` and the slips that
/// do not last by `set`, by impulses in those contacts, as the ends of slips do: a push that stops something rubs where its
/// contact slips. Where they cannot all vanish, all stay.
pub fn stop_by_impulses(table: &Table, balls: &mut [BallState; BALLS], contacts: &[Contact], set: &ActiveSet) {
    // Balls without a coefficient of friction have no rubbing of their own: what stops them does not slip.
    let rubs = |contact: &Contact| table.ball_friction.is_some() || contact.second.is_none();
    let mut system = Held::new(table, balls, contacts, &set.slipping_where(set), rubs);
    let speeds = Movement {
        linear: balls.map(|ball| ball.velocity),
        angular: balls.map(|ball| table.radius * ball.spin),
    };
    if let Some(stopped) = system.solve(&speeds, false) {
        for (ball, state) in balls.iter_mut().enumerate().filter(|(ball, _)| contacts.iter().any(|c| c.has(*ball))) {
            (state.velocity, state.spin) = (stopped.linear[ball], stopped.angular[ball] / table.radius);
        }
    }
}
