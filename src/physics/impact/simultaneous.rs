//! Simultaneous impacts: balls that touch, and a ball that hits another ball and a cushion at once.
//!
//! Impacts propagate through touching balls in rounds, as in Smith, Kaufman, Vouga, Tamstorf and Grinspun, "Reflections on simultaneous
//! impact" (2012). A round treats all contacts that close at that moment:
//! - A contact that shares no ball with another is a single impact.
//! - For each group of contacts that share balls, Moreau's law gives the normal impulses: `0 ≤ v⁺ + e v⁻ ⊥ P ≥ 0`. Since every contact
//!   closes, `v⁻ < 0`, the round removes the energy `½ Σ (1 - e) P |v⁻|` and never adds any. If all contacts have the same `e`, that is the
//!   share `1 - e²` of the energy of approach.
//! - The friction of each contact follows from its slip before the round and its `P` by the law of a single impact at the height of the
//!   balls' centres. If the frictions together would add energy, they are scaled down until they do not.
//! - A contact with zero impulse, because others relieve it, takes no part. A contact that remains alone is a single impact.
//!
//! Contacts that close after a round belong to the next round.
//!
//! All this takes place in space. On the cloth all normals are horizontal, and the cloth takes up what friction would lift or press down:
//! the vertical velocities of a group of balls on the cloth stay zero. If a ball of a group is in the air, impulses have any direction, no
//! contact separates more slowly than in a single impact in the air, and after the round the cloth responds to balls on it that were
//! struck downwards.
//!
//! The outcome is therefore the limit of vanishing gaps, if that limit is unique: Newton's cradle passes a blow on to its last ball, and so
//! does a frozen pair that is struck from behind. If it is not unique, as in a symmetric break, the result does not depend on the numbering
//! of the balls. Moreau's law over all touching contacts, closing or not, would instead send a cradle's first ball back with a third of its
//! speed. A limitation of the rounds: real balls share a blow for about 0.2 ms, so that frozen balls separate slightly differently.

use glam::{DVec2, DVec3};

use super::{BallImpact, BallState, Cushion, ImpactImpulse, direction, separation_speed};
use crate::{
    physics::{Cloth, Contact, MAX_CONTACTS, Partner, SpatialState, factorize, substitute},
    table::{BALLS, Rail, Rails, Table},
};

/// Largest number of Gauss-Seidel sweeps for the normal impulses: for three balls on the cloth they converge linearly with a factor of at
/// most 3/4, in about a hundred.
const MAX_SWEEPS: usize = 200;

/// Pivots up to this count as zero when the normal impulses are solved for directly: thousands of roundings.
const LEAST_PIVOT: f64 = 1e-12;

/// Impact laws of a table. If several contacts that share balls close at once, cushion contacts of balls on the cloth are at the height
/// of the balls' centres, with Coulomb friction, and restitution is that of slow impacts.
#[derive(Clone, Debug)]
pub struct ImpactLaw {
    /// Law of two balls.
    pub balls: BallImpact,
    /// Laws of the cushions, in the order of [`Rail::ALL`].
    cushions: [Cushion; 4],
}

impl ImpactLaw {
    /// Returns the laws of a table.
    pub fn of(table: &Table) -> Self {
        let Rails { left, right, bottom, top, .. } = table.rail;
        let cushions = if [left, right, bottom, top].iter().any(Option::is_some) {
            Rail::ALL.map(|rail| Cushion::of(table, rail))
        } else {
            [Cushion::of(table, Rail::Left); 4]
        };
        Self { balls: BallImpact::of(table), cushions }
    }

    /// Returns the law of a cushion.
    #[inline(always)]
    pub fn cushion(&self, rail: Rail) -> &Cushion {
        &self.cushions[rail as usize]
    }

    /// Returns the laws with one restitution for all impacts at any speed, and cushion contacts at the height of the balls' centres. Zero
    /// is the limit of infinitely many bounces; one is the law of micro-collisions.
    #[must_use]
    pub fn with_restitution(&self, restitution: f64) -> Self {
        Self {
            balls: self.balls.with_restitution(restitution),
            cushions: self.cushions.map(|cushion| cushion.with_restitution(restitution)),
        }
    }

    /// Returns the restitution of a slow impact.
    pub fn restitution(&self, contact: &Contact) -> f64 {
        match contact.partner {
            Partner::Ball(_) => self.balls.restitution,
            Partner::Cushion(rail) => self.cushion(rail).restitution,
        }
    }
}

/// A closed contact with its unit normal towards the first ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// The contact.
    pub contact: Contact,
    /// The normal: horizontal unless a ball of the contact is in the air.
    pub normal: DVec3,
}

impl Touch {
    /// Returns a contact of two balls in space, or of a ball on the cloth with a cushion.
    pub fn of(contact: Contact, balls: &[SpatialState; BALLS]) -> Self {
        let normal = match contact.partner {
            Partner::Cushion(rail) => rail.normal().extend(0.0),
            Partner::Ball(second) => direction(balls[second].position, balls[contact.first].position),
        };
        Self { contact, normal }
    }

    fn relative_velocity(&self, balls: &[SpatialState; BALLS]) -> DVec3 {
        let second = self.contact.second().map_or(DVec3::ZERO, |second| balls[second].velocity);
        balls[self.contact.first].velocity - second
    }

    /// Returns the speed at which the contact opens, m/s.
    pub fn opening_speed(&self, balls: &[SpatialState; BALLS]) -> f64 {
        self.relative_velocity(balls).dot(self.normal)
    }

    /// Returns the horizontal tangent `t`, which is `z×n` for a horizontal normal, and the other one, `n×t`.
    fn tangents(&self) -> [DVec3; 2] {
        let n = self.normal;
        if n.z == 0.0 {
            return [n.truncate().perp().extend(0.0), DVec3::Z];
        }
        let t = n.truncate().perp().normalize().extend(0.0);
        [t, n.cross(t)]
    }

    /// Returns the velocity of the first ball's surface relative to the other surface along the two tangents, m/s (thesis equation 21).
    fn slip(&self, radius: f64, balls: &[SpatialState; BALLS]) -> DVec2 {
        let [t, up] = self.tangents();
        let second = self.contact.second().map_or(DVec3::ZERO, |second| balls[second].spin);
        let (relative, spin) = (self.relative_velocity(balls), balls[self.contact.first].spin + second);
        DVec2::new(relative.dot(t) - radius * spin.dot(up), relative.dot(up) + radius * spin.dot(t))
    }

    /// Applies a friction impulse per mass along the two tangents, m/s, which also turns the balls. The velocities change only along the
    /// axes that are `free`.
    fn apply_friction(&self, radius: f64, impulse: DVec2, balls: &mut [SpatialState; BALLS], free: DVec3) {
        let [t, up] = self.tangents();
        self.apply_impulse(free * (impulse.x * t + impulse.y * up), balls);
        let twist = 2.5 / radius * (impulse.x * up - impulse.y * t);
        balls[self.contact.first].spin -= twist;
        if let Some(second) = self.contact.second() {
            balls[second].spin -= twist;
        }
    }

    /// Applies an impulse per mass, m/s, to the balls' centres.
    fn apply_impulse(&self, impulse: DVec3, balls: &mut [SpatialState; BALLS]) {
        balls[self.contact.first].velocity += impulse;
        if let Some(second) = self.contact.second() {
            balls[second].velocity -= impulse;
        }
    }
}

/// Balls in the air, and what their impacts need besides the laws of the table.
#[derive(Clone, Copy, Debug)]
pub struct Aloft {
    /// The balls in the air.
    pub flies: [bool; BALLS],
    /// The cloth, which responds to balls on it that are struck downwards.
    pub cloth: Cloth,
    /// Smallest separation speed in the air, m/s; slower impacts lose no speed.
    pub slowest: f64,
}

/// Plays one round of balls on the cloth: all `contacts` collide, those that share balls together and all others as single impacts. Returns
/// the impulse of each contact; the normal impulse is zero if other contacts relieve it.
pub fn collide_together(
    radius: f64,
    law: &ImpactLaw,
    balls: &mut [BallState; BALLS],
    contacts: &[Contact],
) -> [ImpactImpulse; MAX_CONTACTS] {
    let mut in_space = balls.map(SpatialState::from);
    let touches: Vec<Touch> = contacts.iter().map(|contact| Touch::of(*contact, &in_space)).collect();
    let impulses = collide_together_in_space(radius, law, None, &mut in_space, &touches);
    *balls = in_space.map(|ball| ball.horizontal_state());
    impulses
}

/// As [`collide_together`], if balls may be in the air. For a single impact in the air, the approach speed, m/s, stands for the normal
/// impulse.
pub fn collide_together_in_space(
    radius: f64,
    law: &ImpactLaw,
    aloft: Option<&Aloft>,
    balls: &mut [SpatialState; BALLS],
    touches: &[Touch],
) -> [ImpactImpulse; MAX_CONTACTS] {
    let mut impulses = [ImpactImpulse::default(); MAX_CONTACTS];
    let mut left: Vec<Vec<usize>> = vec![(0..touches.len()).collect()];
    while let Some(mut rest) = left.pop() {
        let Some(&first) = rest.first() else { continue };
        let group = take_linked(touches, &touches[first].contact, &mut rest);
        if !rest.is_empty() {
            left.push(rest);
        }
        let joined: Vec<Touch> = group.iter().map(|&index| touches[index]).collect();
        let flies = |aloft: &&Aloft| (0..BALLS).any(|ball| aloft.flies[ball] && involve(&joined, ball));
        let aloft = aloft.filter(flies);
        if let [alone] = joined[..] {
            impulses[group[0]] = collide_single(radius, law, aloft, balls, &alone);
            continue;
        }
        let normal = normal_impulses(law, aloft, balls, &joined);
        let pushing: Vec<usize> = group.iter().zip(normal).filter(|(_, push)| *push > 0.0).map(|(&i, _)| i).collect();
        if pushing.len() < group.len() {
            // Relieved contacts take no part. If that leaves a single contact, it follows the law of a single impact.
            left.extend((!pushing.is_empty()).then_some(pushing));
            continue;
        }
        // The cloth takes up the vertical part of all impulses on balls that lie on it.
        let free = if aloft.is_some() { DVec3::ONE } else { DVec3::new(1.0, 1.0, 0.0) };
        apply_impulses(radius, law, balls, &joined, &normal, free);
        for (index, normal) in group.into_iter().zip(normal) {
            impulses[index].normal = normal;
        }
        if let Some(aloft) = aloft {
            let members = balls.iter_mut().enumerate().filter(|(ball, _)| involve(&joined, *ball));
            for (_, ball) in members.filter(|(_, ball)| ball.position.z <= 0.0) {
                aloft.cloth.resolve(radius, ball);
            }
        }
    }
    impulses
}

/// Whether `ball` takes part in any of the contacts.
fn involve(touches: &[Touch], ball: usize) -> bool {
    touches.iter().any(|touch| touch.contact.involves(ball))
}

/// Removes from `rest`, a list of indices, all contacts that share balls with the contact `to`, directly or through others. Returns them.
pub fn take_linked(touches: &[Touch], to: &Contact, rest: &mut Vec<usize>) -> Vec<usize> {
    let mut linked: Vec<usize> = Vec::new();
    loop {
        let is_linked = |index: &usize| {
            let contact = &touches[*index].contact;
            contact.shares_a_ball(to) || linked.iter().any(|&other| touches[other].contact.shares_a_ball(contact))
        };
        let (joined, others): (Vec<_>, Vec<_>) = rest.iter().partition(|index| is_linked(index));
        if joined.is_empty() {
            return linked;
        }
        linked.extend(joined);
        *rest = others;
    }
}

/// Applies the normal impulses per mass, m/s, and the resulting friction impulses. The velocities change only along the axes that are
/// `free`: one, or zero for the vertical if the balls stay on the cloth.
fn apply_impulses(
    radius: f64,
    law: &ImpactLaw,
    balls: &mut [SpatialState; BALLS],
    touches: &[Touch],
    impulses: &[f64; MAX_CONTACTS],
    free: DVec3,
) {
    let slips: Vec<DVec2> = touches.iter().map(|touch| touch.slip(radius, balls)).collect();
    for (touch, impulse) in touches.iter().zip(impulses) {
        touch.apply_impulse(*impulse * touch.normal, balls);
    }
    let with_friction = |share: f64| {
        let mut balls = *balls;
        for (index, touch) in touches.iter().enumerate() {
            let (impulse, slip) = (impulses[index], slips[index].length());
            let factor = match touch.contact.partner {
                Partner::Ball(_) => law.balls.friction_factor(impulse, slip),
                Partner::Cushion(rail) => law.cushion(rail).friction_factor(impulse, slip),
            };
            touch.apply_friction(radius, -share * factor * slips[index], &mut balls, free);
        }
        balls
    };
    // Only of the balls that take part: next to the energy of another fast ball, rounding would hide a gain by slow ones.
    let energy = |balls: &[SpatialState; BALLS]| {
        let members = (0..BALLS).filter(|&ball| involve(touches, ball));
        members.map(|ball| balls[ball].specific_energy(radius, 0.0)).sum::<f64>()
    };
    let (before, half, whole) = (energy(balls), energy(&with_friction(0.5)), energy(&with_friction(1.0)));
    // The energy is a quadratic function of the share: it decreases first, and returns to its initial value at the share computed here.
    let bend = 2.0 * (whole + before - 2.0 * half);
    let fall = whole - before - bend;
    *balls = with_friction(if whole <= before { 1.0 } else { (-fall / bend).clamp(0.0, 1.0) });
}

/// Applies a single impact; `aloft` is given if a ball of it is in the air.
fn collide_single(
    radius: f64,
    law: &ImpactLaw,
    aloft: Option<&Aloft>,
    balls: &mut [SpatialState; BALLS],
    Touch { contact, normal }: &Touch,
) -> ImpactImpulse {
    let first = contact.first;
    match (contact.partner, aloft) {
        (Partner::Cushion(rail), None) => {
            let mut ball = balls[first].horizontal_state();
            let impulse = law.cushion(rail).resolve(radius, rail.normal(), &mut ball);
            balls[first] = ball.into();
            impulse
        }
        (Partner::Ball(second), None) => {
            let [mut one, mut other] = [first, second].map(|ball| balls[ball].horizontal_state());
            let normal = law.balls.resolve(radius, &mut one, &mut other);
            (balls[first], balls[second]) = (one.into(), other.into());
            ImpactImpulse { normal, climb: 0.0 }
        }
        (Partner::Cushion(rail), Some(Aloft { cloth, slowest, .. })) => {
            let ball = &mut balls[first];
            let approach = law.cushion(rail).resolve_in_space(radius, *slowest, -*normal, ball);
            if ball.position.z <= 0.0 {
                cloth.resolve(radius, ball);
            }
            ImpactImpulse { normal: approach, climb: 0.0 }
        }
        (Partner::Ball(second), Some(Aloft { cloth, slowest, .. })) => {
            let (mut one, mut other) = (balls[first], balls[second]);
            let approach = law.balls.resolve_over_cloth(radius, *slowest, cloth, &mut one, &mut other);
            (balls[first], balls[second]) = (one, other);
            ImpactImpulse { normal: approach, climb: 0.0 }
        }
    }
}

/// Solves Moreau's law for the normal impulses per mass, m/s, by projected Gauss-Seidel sweeps. The matrix is symmetric and positive
/// semidefinite, so that they converge from any start. `aloft` is given if a ball is in the air.
fn normal_impulses(
    law: &ImpactLaw,
    aloft: Option<&Aloft>,
    balls: &[SpatialState; BALLS],
    touches: &[Touch],
) -> [f64; MAX_CONTACTS] {
    let mut impulses = [0.0; MAX_CONTACTS];
    let sense = |Touch { contact, .. }: &Touch, ball: usize| {
        f64::from(u8::from(contact.first == ball)) - f64::from(u8::from(contact.partner == Partner::Ball(ball)))
    };
    let response = |i: usize, j: usize| {
        let shared: f64 = (0..BALLS).map(|ball| sense(&touches[i], ball) * sense(&touches[j], ball)).sum();
        shared * touches[i].normal.dot(touches[j].normal)
    };
    let entry = |i: usize, j: usize| if i.max(j) < touches.len() { response(i, j) } else { 0.0 };
    let responses: [[f64; MAX_CONTACTS]; MAX_CONTACTS] = std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)));
    let wanted = |touch: &Touch| {
        let (opening, restitution) = (touch.opening_speed(balls), law.restitution(&touch.contact));
        aloft.map_or(-(1.0 + restitution) * opening, |aloft| {
            separation_speed(-opening, restitution, aloft.slowest) - opening
        })
    };
    let wanted: Vec<f64> = touches.iter().map(wanted).collect();
    let scale = wanted.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
    for _ in 0..MAX_SWEEPS {
        let mut change = 0.0_f64;
        for i in 0..touches.len() {
            let given: f64 = responses[i].iter().zip(&impulses).map(|(response, impulse)| response * impulse).sum();
            let impulse = (impulses[i] + (wanted[i] - given) / responses[i][i]).max(0.0);
            change = change.max((impulse - impulses[i]).abs());
            impulses[i] = impulse;
        }
        if change <= f64::EPSILON * scale {
            return impulses;
        }
    }
    if aloft.is_some() {
        let pushing: Vec<usize> = (0..touches.len()).filter(|&i| impulses[i] > 0.0).collect();
        let solved = solve(&responses, &wanted, &pushing);
        for (i, impulse) in pushing.into_iter().zip(solved.into_iter().flatten()) {
            impulses[i] = impulse;
        }
    }
    impulses
}

/// Solves the law directly for the `pushing` contacts: the sweeps take too long for almost parallel normals, such as those of a ball that
/// lands on both noses of a corner. Returns their impulses, or `None` if one of them pulls or the contacts are not independent.
fn solve(responses: &[[f64; MAX_CONTACTS]; MAX_CONTACTS], wanted: &[f64], pushing: &[usize]) -> Option<Vec<f64>> {
    let mut matrix: Vec<f64> = pushing.iter().flat_map(|&i| pushing.iter().map(move |&j| responses[i][j])).collect();
    let mut impulses: Vec<f64> = pushing.iter().map(|&i| wanted[i]).collect();
    let mut pivots = vec![0; pushing.len()];
    if factorize(&mut matrix, &mut pivots) <= LEAST_PIVOT {
        return None;
    }
    substitute(&matrix, &pivots, &mut impulses);
    impulses.iter().all(|impulse| *impulse >= 0.0).then_some(impulses)
}

#[cfg(test)]
mod tests;
