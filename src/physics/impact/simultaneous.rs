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
//! The outcome is therefore the limit of vanishing gaps, if that limit is unique: Newton's cradle passes a blow on to its last ball, and so
//! does a frozen pair that is struck from behind. If it is not unique, as in a symmetric break, the result does not depend on the numbering
//! of the balls. Moreau's law over all touching contacts, closing or not, would instead send a cradle's first ball back with a third of its
//! speed. A limitation of the rounds: real balls share a blow for about 0.2 ms, so that frozen balls separate slightly differently.

use glam::DVec2;

use super::{BallImpact, BallState, Cushion, ImpactImpulse, contact_twist};
use crate::{
    physics::{Contact, MAX_CONTACTS, Partner, involve},
    table::{BALLS, Rail, Rails, Table},
};

/// Largest number of Gauss-Seidel sweeps for the normal impulses: for three balls they converge linearly with a factor of at most 3/4, in
/// about a hundred.
const MAX_SWEEPS: usize = 200;

/// Impact laws of a table. If several contacts that share balls close at once, cushion contacts are at the height of the balls' centres,
/// with Coulomb friction, and restitution is that of slow impacts.
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

/// Plays one round: all `contacts` collide, those that share balls together and all others as single impacts. Returns the impulse of each
/// contact; the normal impulse is zero if other contacts relieve it.
pub fn collide_together(
    radius: f64,
    law: &ImpactLaw,
    balls: &mut [BallState; BALLS],
    contacts: &[Contact],
) -> [ImpactImpulse; MAX_CONTACTS] {
    let mut impulses = [ImpactImpulse::default(); MAX_CONTACTS];
    let mut left = vec![(0..contacts.len()).collect()];
    while let Some(mut rest) = left.pop() {
        let group = take_group(contacts, &mut rest);
        if !rest.is_empty() {
            left.push(rest);
        }
        if let [alone] = group[..] {
            impulses[alone] = collide_single(radius, law, balls, &contacts[alone]);
            continue;
        }
        let joined: Vec<Contact> = group.iter().map(|&index| contacts[index]).collect();
        let normal = normal_impulses(law, balls, &joined);
        let pushing: Vec<usize> = group.iter().zip(normal).filter(|(_, push)| *push > 0.0).map(|(&i, _)| i).collect();
        if pushing.len() < group.len() {
            // Relieved contacts take no part. If that leaves a single contact, it follows the law of a single impact.
            left.extend((!pushing.is_empty()).then_some(pushing));
            continue;
        }
        apply_impulses(radius, law, balls, &joined, &normal);
        for (index, normal) in group.into_iter().zip(normal) {
            impulses[index].normal = normal;
        }
    }
    impulses
}

/// Removes the first contact from `rest`, and all contacts that share balls with it, directly or through others. Returns them.
fn take_group(contacts: &[Contact], rest: &mut Vec<usize>) -> Vec<usize> {
    let mut group: Vec<usize> = rest.drain(..rest.len().min(1)).collect();
    loop {
        let is_joined = |index: &usize| group.iter().any(|&other| contacts[other].shares_a_ball(&contacts[*index]));
        let (joined, others): (Vec<_>, Vec<_>) = rest.iter().partition(|index| is_joined(index));
        if joined.is_empty() {
            return group;
        }
        group.extend(joined);
        *rest = others;
    }
}

/// Applies the normal impulses at the height of the balls' centres, per mass, m/s, and the resulting friction impulses.
fn apply_impulses(
    radius: f64,
    law: &ImpactLaw,
    balls: &mut [BallState; BALLS],
    contacts: &[Contact],
    impulses: &[f64; MAX_CONTACTS],
) {
    let normals: Vec<DVec2> = contacts.iter().map(|contact| contact.normal(balls)).collect();
    let slips: Vec<DVec2> = contacts.iter().map(|contact| contact.slip(radius, balls)).collect();
    for (contact, (n, impulse)) in contacts.iter().zip(normals.iter().zip(impulses)) {
        balls[contact.first].velocity += *impulse * *n;
        if let Some(second) = contact.second() {
            balls[second].velocity -= *impulse * *n;
        }
    }
    let with_friction = |share: f64| {
        let mut balls = *balls;
        for (index, contact) in contacts.iter().enumerate() {
            let (impulse, slip) = (impulses[index], slips[index].length());
            let factor = match contact.partner {
                Partner::Ball(_) => law.balls.friction_factor(impulse, slip),
                Partner::Cushion(rail) => law.cushion(rail).friction_factor(impulse, slip),
            };
            let (tangential, t) = (-share * factor * slips[index], normals[index].perp());
            let twist = contact_twist(radius, -tangential.x, -tangential.y, t);
            balls[contact.first].velocity += tangential.x * t;
            balls[contact.first].spin += twist;
            if let Some(second) = contact.second() {
                balls[second].velocity -= tangential.x * t;
                balls[second].spin += twist;
            }
        }
        balls
    };
    // Only of the balls that take part: next to the energy of another fast ball, rounding would hide a gain by slow ones.
    let energy = |balls: &[BallState; BALLS]| {
        let members = (0..BALLS).filter(|&ball| involve(contacts, ball));
        members.map(|ball| balls[ball].specific_energy(radius)).sum::<f64>()
    };
    let (before, half, whole) = (energy(balls), energy(&with_friction(0.5)), energy(&with_friction(1.0)));
    // The energy is a quadratic function of the share: it decreases first, and returns to its initial value at the share computed here.
    let bend = 2.0 * (whole + before - 2.0 * half);
    let fall = whole - before - bend;
    *balls = with_friction(if whole <= before { 1.0 } else { (-fall / bend).clamp(0.0, 1.0) });
}

/// Applies a single impact.
fn collide_single(radius: f64, law: &ImpactLaw, balls: &mut [BallState; BALLS], contact: &Contact) -> ImpactImpulse {
    match contact.partner {
        Partner::Cushion(rail) => law.cushion(rail).resolve(radius, rail.normal(), &mut balls[contact.first]),
        Partner::Ball(second) => {
            let (mut one, mut other) = (balls[contact.first], balls[second]);
            let normal = law.balls.resolve(radius, &mut one, &mut other);
            (balls[contact.first], balls[second]) = (one, other);
            ImpactImpulse { normal, climb: 0.0 }
        }
    }
}

/// Solves Moreau's law for the normal impulses per mass, m/s, by projected Gauss-Seidel sweeps. The matrix is symmetric and positive
/// semidefinite, so that they converge from any start.
fn normal_impulses(law: &ImpactLaw, balls: &[BallState; BALLS], contacts: &[Contact]) -> [f64; MAX_CONTACTS] {
    let mut impulses = [0.0; MAX_CONTACTS];
    let normals: Vec<DVec2> = contacts.iter().map(|contact| contact.normal(balls)).collect();
    let sense = |contact: &Contact, ball: usize| {
        f64::from(u8::from(contact.first == ball)) - f64::from(u8::from(contact.partner == Partner::Ball(ball)))
    };
    let response = |i: usize, j: usize| {
        let shared: f64 = (0..BALLS).map(|ball| sense(&contacts[i], ball) * sense(&contacts[j], ball)).sum();
        shared * normals[i].dot(normals[j])
    };
    let entry = |i: usize, j: usize| if i.max(j) < contacts.len() { response(i, j) } else { 0.0 };
    let responses: [[f64; MAX_CONTACTS]; MAX_CONTACTS] = std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)));
    let wanted: Vec<f64> =
        contacts.iter().map(|contact| -(1.0 + law.restitution(contact)) * contact.opening_speed(balls)).collect();
    let scale = wanted.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
    for _ in 0..MAX_SWEEPS {
        let mut change = 0.0_f64;
        for i in 0..contacts.len() {
            let given: f64 = responses[i].iter().zip(&impulses).map(|(response, impulse)| response * impulse).sum();
            let impulse = (impulses[i] + (wanted[i] - given) / responses[i][i]).max(0.0);
            change = change.max((impulse - impulses[i]).abs());
            impulses[i] = impulse;
        }
        if change <= f64::EPSILON * scale {
            break;
        }
    }
    impulses
}

#[cfg(test)]
mod tests {
    use super::*;

    const RADIUS: f64 = 0.03;

    fn law(ball_restitution: f64) -> ImpactLaw {
        with_friction(ball_restitution, 0.0)
    }

    fn with_friction(ball_restitution: f64, friction: f64) -> ImpactLaw {
        let table = Table {
            ball_restitution,
            ball_friction: Some(friction),
            rail_restitution: 0.85,
            rail_friction: 0.2,
            ..Table::preset("textbook").unwrap()
        };
        ImpactLaw::of(&table)
    }

    /// Plays rounds until no contact closes, as the engine does. Returns their number.
    fn collide(law: &ImpactLaw, balls: &mut [BallState; BALLS], contacts: &[Contact]) -> usize {
        for round in 0.. {
            let closing: Vec<Contact> =
                contacts.iter().copied().filter(|contact| contact.opening_speed(balls) < -1e-12).collect();
            if closing.is_empty() {
                return round;
            }
            collide_together(RADIUS, law, balls, &closing);
        }
        unreachable!("rounds end")
    }

    fn in_line(speed: f64) -> [BallState; BALLS] {
        let mut balls = [0.0, 2.0, 4.0].map(|x| BallState::at_rest(DVec2::new(x * RADIUS, 0.0)));
        balls[0].velocity.x = speed;
        balls
    }

    const LINE: [Contact; 2] = [Contact::of_balls(0, 1), Contact::of_balls(1, 2)];

    #[test]
    fn newtons_cradle_passes_the_impulse_to_its_last_ball() {
        let mut balls = in_line(1.0);
        assert_eq!(collide(&law(1.0), &mut balls, &LINE), 2);
        assert_eq!(balls.map(|ball| ball.velocity.x), [0.0, 0.0, 1.0]);
    }

    #[test]
    fn a_frozen_pair_struck_from_behind_sends_its_front_ball_off() {
        let mut balls = in_line(2.0);
        collide(&law(0.95), &mut balls, &LINE);
        let [first, middle, last] = balls.map(|ball| ball.velocity.x);
        assert!((last - 2.0 * 0.975 * 0.975).abs() < 1e-15, "{last}");
        assert!((first + middle + last - 2.0).abs() < 1e-15 && first <= middle && middle < last);
    }

    #[test]
    fn symmetric_break_stays_symmetric_in_any_ball_order() {
        let height = 3.0_f64.sqrt() * RADIUS;
        let mut balls = [
            BallState::at_rest(DVec2::new(-height, 0.0)),
            BallState::at_rest(DVec2::new(0.0, RADIUS)),
            BallState::at_rest(DVec2::new(0.0, -RADIUS)),
        ];
        balls[0].velocity.x = 3.0;
        let mut swapped = [balls[0], balls[2], balls[1]];
        let contacts = [Contact::of_balls(0, 1), Contact::of_balls(0, 2), Contact::of_balls(1, 2)];
        collide(&law(0.9), &mut balls, &contacts);
        collide(&law(0.9), &mut swapped, &contacts);
        let (one, other) = (balls[1].velocity, balls[2].velocity);
        assert!((one * DVec2::new(1.0, -1.0)).distance(other) < 1e-15 && balls[0].velocity.y.abs() < 1e-15);
        assert_eq!([swapped[2].velocity, swapped[1].velocity], [one, other]);
        // Moreau's law: both contacts separate at e times their closing speed.
        let parting = contacts[0].opening_speed(&balls);
        assert!((parting - 0.9 * 3.0 * 0.75_f64.sqrt()).abs() < 1e-14, "{parting}");
    }

    #[test]
    fn friction_by_slip_replaces_the_constant_coefficient() {
        let height = 3.0_f64.sqrt() * RADIUS;
        let contacts = [Contact::of_balls(0, 1), Contact::of_balls(0, 2)];
        let after = |ball_friction: Option<f64>| {
            let table = Table { ball_friction, ..Table::preset("match").unwrap() };
            let mut balls =
                [(-height, 0.0), (0.0, RADIUS), (0.0, -RADIUS)].map(|(x, y)| BallState::at_rest(DVec2::new(x, y)));
            (balls[0].velocity.x, balls[0].spin.z) = (3.0, 80.0);
            collide(&ImpactLaw::of(&table), &mut balls, &contacts);
            balls
        };
        assert_eq!(after(Some(0.118)), after(None));
    }

    #[test]
    fn contacts_without_shared_balls_collide_independently() {
        let law = ImpactLaw::of(&Table::preset("match").unwrap());
        let mut balls = in_line(2.0);
        balls[2].velocity = DVec2::new(3.0, 1.0);
        let (mut pair, mut alone) = (balls, balls);
        let contacts = [LINE[0], Contact::with_cushion(2, Rail::Right)];
        let together = collide_together(RADIUS, &law, &mut balls, &contacts);
        let one = collide_together(RADIUS, &law, &mut pair, &contacts[..1]);
        let other = collide_together(RADIUS, &law, &mut alone, &contacts[1..]);
        assert_eq!((together[0], together[1]), (one[0], other[0]));
        assert_eq!(balls, [pair[0], pair[1], alone[2]]);
        assert!(balls[2].velocity.x < 0.0 && balls[1].velocity.x > 1.8);
    }

    /// A ball that spins in a corner while another ball loses energy elsewhere: its friction must not use that energy.
    #[test]
    fn contacts_without_shared_balls_exchange_no_energy() {
        let law = with_friction(0.95, 0.2);
        let mut balls = in_line(0.0);
        balls[2].velocity = DVec2::new(1.51, -2.64);
        balls[2].spin = glam::DVec3::new(36.5, 20.9, 0.0);
        balls[0].velocity = DVec2::new(-40.0, -3.0);
        let contacts = [
            Contact::with_cushion(0, Rail::Bottom),
            Contact::with_cushion(2, Rail::Right),
            Contact::with_cushion(2, Rail::Bottom),
        ];
        let before = balls[2].specific_energy(RADIUS);
        let mut corner = balls;
        collide_together(RADIUS, &law, &mut balls, &contacts);
        collide_together(RADIUS, &law, &mut corner, &contacts[1..]);
        assert_eq!(balls[2], corner[2]);
        assert!(balls[2].specific_energy(RADIUS) <= before);
    }

    /// A slow ball in a corner, whose friction would accelerate it, while another ball is fast: its tiny energy gain is lost in the
    /// rounding of the sum.
    #[test]
    fn uninvolved_balls_hide_no_energy_gain() {
        let law = with_friction(1.0, 0.2).with_restitution(1.0);
        let mut balls = in_line(0.0);
        balls[2].velocity = DVec2::new(-4.1e-7, 2.8e-8);
        balls[2].spin = glam::DVec3::new(-2.3e-7, -5.2e-6, 0.0);
        let (mut alone, before) = (balls, balls[2].specific_energy(RADIUS));
        balls[0].velocity = DVec2::new(2.0, 1.0);
        let corner = [Contact::with_cushion(2, Rail::Left), Contact::with_cushion(2, Rail::Top)];
        collide_together(RADIUS, &law, &mut balls, &corner);
        collide_together(RADIUS, &law, &mut alone, &corner);
        assert_eq!(balls[2], alone[2]);
        assert!(balls[2].specific_energy(RADIUS) <= before * (1.0 + 8.0 * f64::EPSILON));
    }

    /// A blow drives a ball away from another one that approaches it slowly: only two of the three balls collide.
    #[test]
    fn relieved_contact_does_not_change_the_law_of_others() {
        let law = ImpactLaw::of(&Table::preset("match").unwrap());
        let mut balls = in_line(0.0);
        balls[2].velocity = DVec2::new(-3.0, 0.4);
        let behind = DVec2::new(0.6, 0.8);
        balls[0] =
            BallState { velocity: -0.1 * behind, ..BallState::at_rest(balls[1].position + 2.0 * RADIUS * behind) };
        let mut alone = balls;
        let contacts = [Contact::of_balls(0, 1), LINE[1]];
        let together = collide_together(RADIUS, &law, &mut balls, &contacts);
        let single = collide_together(RADIUS, &law, &mut alone, &contacts[1..]);
        assert_eq!((together[0].normal, together[1]), (0.0, single[0]));
        assert_eq!(balls, alone);
    }

    #[test]
    fn ball_between_ball_and_cushion_loses_energy_and_separates() {
        let mut balls = in_line(0.0);
        balls[0] = BallState { velocity: DVec2::new(2.0, 0.7), spin: glam::DVec3::new(30.0, 50.0, -20.0), ..balls[0] };
        balls[1].velocity = DVec2::new(0.5, -0.3);
        let contacts = [Contact::of_balls(0, 1), Contact::with_cushion(1, Rail::Right)];
        let law = with_friction(0.95, 0.3);
        let energy = |balls: &[BallState; BALLS]| balls.iter().map(|ball| ball.specific_energy(RADIUS)).sum::<f64>();
        let before = energy(&balls);
        collide(&law, &mut balls, &contacts);
        assert!(energy(&balls) <= before);
        assert!(contacts.iter().all(|contact| contact.opening_speed(&balls) >= -1e-12));
    }
}
