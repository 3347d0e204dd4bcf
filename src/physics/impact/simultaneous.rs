//! Several impacts at the same moment: balls that touch, a ball that meets another and a cushion at once.
//!
//! The impacts run through touching balls in rounds, as in Smith, Kaufman, Vouga, Tamstorf and Grinspun, "Reflections on
//! simultaneous impact" (2012). A round takes all contacts that close at that moment. One that shares no ball with another is
//! a single impact. For each group that shares balls Moreau's law gives the normal impulses: `0 ≤ v⁺ + e v⁻ ⊥ P ≥ 0`. Since each of them
//! closes, `v⁻ < 0`, the round takes the energy `½ Σ (1 - e) P |v⁻|` and never adds any; where all have the same `e`, that is the share
//! `1 - e²` of the energy of their approach. Each contact's friction then follows from its slip before the round and its `P` by the law of
//! a single impact; should they together add energy, they are scaled down until they do not. A contact whose impulse is zero, since the
//! others relieve it, takes no part: what it leaves alone is a single impact. What closes behind a round belongs to the next one.
//!
//! So the outcome is the limit of vanishing gaps where that limit is one: Newton's cradle passes a blow on to its last ball,
//! as does a frozen pair that is struck from behind. Where it is not, as in a symmetric break, no order of numbering
//! decides. Moreau's law over all contacts that touch, closing or not, would send a cradle's first ball back with a third
//! of its speed. What speaks against the rounds: real balls share a blow for some 0.2 ms, so that frozen balls part a
//! little otherwise.

use glam::DVec2;

use super::{BallImpact, BallState, Cushion, Cushions, ImpactImpulse, contact_twist};
use crate::{
    physics::{Contact, MAX_CONTACTS},
    table::{BALLS, Rail, Table},
};

/// Sweeps over the normal impulses: they converge like a power of at most 3/4 for three balls, in some hundred.
const MAX_SWEEPS: usize = 200;

/// The laws of the impacts on a table. Where several contacts that share balls close at once, cushions are met at the height of the
/// balls' centres, with the friction and restitution of slow impacts.
#[derive(Clone, Debug)]
pub struct ImpactLaw {
    /// That of two balls.
    pub balls: BallImpact,
    /// Those of the four cushions.
    pub cushions: Cushions,
}

impl ImpactLaw {
    /// Those of a table.
    pub fn of(table: &Table) -> Self {
        Self { balls: BallImpact::of(table), cushions: Cushions::of(table) }
    }

    /// The same with one restitution for all impacts, however fast, and cushions at the height of the balls' centres: without any it is the
    /// end of endless bounces, and with all of it the law of micro-collisions.
    #[must_use]
    pub fn with_restitution(&self, restitution: f64) -> Self {
        Self { balls: self.balls.with_restitution(restitution), cushions: self.cushions.with_restitution(restitution) }
    }

    fn cushion(&self, contact: &Contact) -> &Cushion {
        self.cushions.at(Rail::with_normal(contact.cushion_normal))
    }

    /// Restitution of a slow impact.
    pub fn restitution(&self, contact: &Contact) -> f64 {
        if contact.second.is_some() { self.balls.restitution } else { self.cushion(contact).restitution }
    }
}

/// One round: all `contacts` collide, those that share balls together, any other as a single impact. Returns the impulse of each; the
/// normal one is zero where the others relieve a contact of its own.
pub fn collide_together(
    radius: f64,
    law: &ImpactLaw,
    balls: &mut [BallState; BALLS],
    contacts: &[Contact],
) -> [ImpactImpulse; MAX_CONTACTS] {
    let mut impulses = [ImpactImpulse::default(); MAX_CONTACTS];
    let mut left = vec![(0..contacts.len()).collect()];
    while let Some(mut rest) = left.pop() {
        let group = take_joined(contacts, &mut rest);
        if !rest.is_empty() {
            left.push(rest);
        }
        if let [alone] = group[..] {
            impulses[alone] = collide_alone(radius, law, balls, &contacts[alone]);
            continue;
        }
        let joined: Vec<Contact> = group.iter().map(|&index| contacts[index]).collect();
        let normal = normal_impulses(law, balls, &joined);
        let pushing: Vec<usize> = group.iter().zip(normal).filter(|(_, push)| *push > 0.0).map(|(&i, _)| i).collect();
        if pushing.len() < group.len() {
            // What the others relieve takes no part: one that is left alone by that has a single impact's law.
            left.extend((!pushing.is_empty()).then_some(pushing));
            continue;
        }
        push_and_rub(radius, law, balls, &joined, &normal);
        for (index, normal) in group.into_iter().zip(normal) {
            impulses[index].normal = normal;
        }
    }
    impulses
}

/// Takes the first of some contacts out of `rest`, and all that share balls with it, directly or by way of others.
fn take_joined(contacts: &[Contact], rest: &mut Vec<usize>) -> Vec<usize> {
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

/// Gives the normal impulses at the height of the balls' centres, per mass, m/s, and the frictions that follow from them.
fn push_and_rub(
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
        if let Some(second) = contact.second {
            balls[second].velocity -= *impulse * *n;
        }
    }
    let rubbed = |share: f64| {
        let mut balls = *balls;
        for (index, contact) in contacts.iter().enumerate() {
            let (friction, holds) = if contact.second.is_some() {
                (law.balls.friction, 1.0 / 7.0)
            } else {
                (Some(law.cushion(contact).friction), 2.0 / 7.0)
            };
            let size = slips[index].length();
            let factor = match friction {
                _ if impulses[index] <= 0.0 => 0.0,
                Some(mu) if mu * impulses[index] < holds * size => mu * impulses[index] / size,
                _ => holds,
            };
            let (tangential, t) = (-share * factor * slips[index], normals[index].perp());
            let twist = contact_twist(radius, -tangential.x, -tangential.y, t);
            balls[contact.first].velocity += tangential.x * t;
            balls[contact.first].spin += twist;
            if let Some(second) = contact.second {
                balls[second].velocity -= tangential.x * t;
                balls[second].spin += twist;
            }
        }
        balls
    };
    // Not of those that take no part: beside the energy of a fast one, rounding would hide what slow ones gain.
    let energy = |balls: &[BallState; BALLS]| {
        let members = (0..BALLS).filter(|&ball| contacts.iter().any(|contact| contact.has(ball)));
        members.map(|ball| balls[ball].specific_energy(radius)).sum::<f64>()
    };
    let (before, half, whole) = (energy(balls), energy(&rubbed(0.5)), energy(&rubbed(1.0)));
    // The energy is a square function of the share: it falls first, and comes back to what it was at this share.
    let bend = 2.0 * (whole + before - 2.0 * half);
    let fall = whole - before - bend;
    *balls = rubbed(if whole <= before { 1.0 } else { (-fall / bend).clamp(0.0, 1.0) });
}

/// A single impact.
fn collide_alone(radius: f64, law: &ImpactLaw, balls: &mut [BallState; BALLS], contact: &Contact) -> ImpactImpulse {
    match contact.second {
        None => law.cushion(contact).resolve(radius, contact.cushion_normal, &mut balls[contact.first]),
        Some(second) => {
            let (mut one, mut other) = (balls[contact.first], balls[second]);
            let normal = law.balls.resolve(radius, &mut one, &mut other);
            (balls[contact.first], balls[second]) = (one, other);
            ImpactImpulse { normal, climb: 0.0 }
        }
    }
}

/// Moreau's law for the normal impulses per mass, m/s, by projected Gauss-Seidel sweeps: the matrix is symmetric and not negative, for
/// which they converge from anywhere.
fn normal_impulses(law: &ImpactLaw, balls: &[BallState; BALLS], contacts: &[Contact]) -> [f64; MAX_CONTACTS] {
    let mut impulses = [0.0; MAX_CONTACTS];
    let normals: Vec<DVec2> = contacts.iter().map(|contact| contact.normal(balls)).collect();
    let sense = |contact: &Contact, ball: usize| {
        f64::from(u8::from(contact.first == ball)) - f64::from(u8::from(contact.second == Some(ball)))
    };
    let response = |i: usize, j: usize| {
        let shared: f64 = (0..BALLS).map(|ball| sense(&contacts[i], ball) * sense(&contacts[j], ball)).sum();
        shared * normals[i].dot(normals[j])
    };
    let mut responses = [[0.0; MAX_CONTACTS]; MAX_CONTACTS];
    for (i, row) in responses[..contacts.len()].iter_mut().enumerate() {
        row[..contacts.len()].iter_mut().enumerate().for_each(|(j, place)| *place = response(i, j));
    }
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

    /// Rounds until nothing closes, as the engine plays them.
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
    fn newtons_cradle_passes_a_blow_on_to_its_last_ball() {
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
    fn a_symmetric_break_stays_symmetric_whatever_the_balls_are_called() {
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
        // Moreau's law: both part at e times the speed at which they met.
        let parting = contacts[0].opening_speed(&balls);
        assert!((parting - 0.9 * 3.0 * 0.75_f64.sqrt()).abs() < 1e-14, "{parting}");
    }

    #[test]
    fn what_shares_no_ball_collides_by_its_own_law_in_the_same_round() {
        let law = ImpactLaw::of(&Table::preset("match").unwrap());
        let mut balls = in_line(2.0);
        balls[2].velocity = DVec2::new(3.0, 1.0);
        let (mut pair, mut alone) = (balls, balls);
        let contacts = [LINE[0], Contact::with_cushion(2, DVec2::NEG_X)];
        let together = collide_together(RADIUS, &law, &mut balls, &contacts);
        let one = collide_together(RADIUS, &law, &mut pair, &contacts[..1]);
        let other = collide_together(RADIUS, &law, &mut alone, &contacts[1..]);
        assert_eq!((together[0], together[1]), (one[0], other[0]));
        assert_eq!(balls, [pair[0], pair[1], alone[2]]);
        assert!(balls[2].velocity.x < 0.0 && balls[1].velocity.x > 1.8);
    }

    /// A ball that spins in a corner, and one that loses energy elsewhere at the same moment: its friction could gain as much.
    #[test]
    fn what_shares_no_ball_lends_no_energy() {
        let law = with_friction(0.95, 0.2);
        let mut balls = in_line(0.0);
        balls[2].velocity = DVec2::new(1.51, -2.64);
        balls[2].spin = glam::DVec3::new(36.5, 20.9, 0.0);
        balls[0].velocity = DVec2::new(-40.0, -3.0);
        let contacts = [
            Contact::with_cushion(0, DVec2::Y),
            Contact::with_cushion(2, DVec2::NEG_X),
            Contact::with_cushion(2, DVec2::Y),
        ];
        let before = balls[2].specific_energy(RADIUS);
        let mut corner = balls;
        collide_together(RADIUS, &law, &mut balls, &contacts);
        collide_together(RADIUS, &law, &mut corner, &contacts[1..]);
        assert_eq!(balls[2], corner[2]);
        assert!(balls[2].specific_energy(RADIUS) <= before);
    }

    /// One that creeps in a corner, whose friction would drive it on, while another is fast: so small an energy is lost in the rounding of
    /// the sum.
    #[test]
    fn what_takes_no_part_hides_no_gain() {
        let law = with_friction(1.0, 0.2).with_restitution(1.0);
        let mut balls = in_line(0.0);
        balls[2].velocity = DVec2::new(-4.1e-7, 2.8e-8);
        balls[2].spin = glam::DVec3::new(-2.3e-7, -5.2e-6, 0.0);
        let (mut alone, before) = (balls, balls[2].specific_energy(RADIUS));
        balls[0].velocity = DVec2::new(2.0, 1.0);
        let corner = [Contact::with_cushion(2, DVec2::X), Contact::with_cushion(2, DVec2::NEG_Y)];
        collide_together(RADIUS, &law, &mut balls, &corner);
        collide_together(RADIUS, &law, &mut alone, &corner);
        assert_eq!(balls[2], alone[2]);
        assert!(balls[2].specific_energy(RADIUS) <= before * (1.0 + 8.0 * f64::EPSILON));
    }

    /// A ball that a blow drives away from another one, which comes up to it slowly: only two of the three meet.
    #[test]
    fn what_is_relieved_leaves_the_others_their_own_law() {
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
    fn a_ball_between_a_ball_and_a_cushion_loses_energy_and_leaves_nothing_closing() {
        let mut balls = in_line(0.0);
        balls[0] = BallState { velocity: DVec2::new(2.0, 0.7), spin: glam::DVec3::new(30.0, 50.0, -20.0), ..balls[0] };
        balls[1].velocity = DVec2::new(0.5, -0.3);
        let contacts = [Contact::of_balls(0, 1), Contact::with_cushion(1, DVec2::NEG_X)];
        let law = with_friction(0.95, 0.3);
        let energy = |balls: &[BallState; BALLS]| balls.iter().map(|ball| ball.specific_energy(RADIUS)).sum::<f64>();
        let before = energy(&balls);
        collide(&law, &mut balls, &contacts);
        assert!(energy(&balls) <= before);
        assert!(contacts.iter().all(|contact| contact.opening_speed(&balls) >= -1e-12));
    }
}
