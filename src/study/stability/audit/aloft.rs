//! Energy losses at landings, by formulas independent of the engine, and at impacts, by those of the reference engine.

use super::{
    moment::{Bounces, fastest_micro_collision},
    uncertainty::{RESTING_SPEED, STOPPED_SPEED},
};
use crate::{
    physics::{SpatialState, slip},
    simulation::{Event, EventKind},
    study::reference_engine::{
        Ball, Contact, Motion, Numbers, Vector, collide_aloft, collide_simultaneously, opening_aloft, settle,
    },
    table::{BALLS, Table},
};

/// Landings slower than this dissipate less than rounding, m/s: the loss from a slip is proportional to their speed.
const LAST_LANDING: f64 = 1e-18;

/// Share of a speed that may be a closing speed by rounding alone.
const GRAZING: f64 = 16.0 * f64::EPSILON;

/// Returns the energy per mass of a ball, m²/s². For a ball on the cloth it is exactly that of its horizontal motion and of its
/// spin.
pub fn energy(table: &Table, ball: &SpatialState) -> f64 {
    let climb = ball.velocity.z;
    ball.horizontal_state().specific_energy(table.radius) + (0.5 * climb * climb + table.gravity * ball.position.z)
}

/// Returns the energy that the cloth dissipates in the first `landings` landings of a flight from the state `start`, m²/s².
/// Each landing dissipates the vertical energy except for the square of the restitution, and by friction `J u - 7/4 J²` of a
/// slip `u`.
pub fn landings_loss(table: &Table, start: &SpatialState, landings: u32) -> f64 {
    let Some(flight) = table.flight else { return 0.0 };
    let (e, friction) = (flight.restitution, flight.friction.unwrap_or(table.sliding_friction));
    let climb = start.velocity.z;
    let mut speed = (climb * climb + 2.0 * table.gravity * start.position.z.max(0.0)).sqrt();
    let mut slips = slip(table.radius, start.velocity.truncate(), start.spin).length();
    let mut lost = 0.0;
    for _ in 0..landings {
        if speed < LAST_LANDING {
            break;
        }
        let rub = (friction * (1.0 + e) * speed).min(2.0 / 7.0 * slips);
        lost += 0.5 * speed * speed * (1.0 - e * e) + rub * (slips - 1.75 * rub);
        speed *= e;
        slips -= 3.5 * rub;
    }
    lost
}

/// The result of simultaneous impacts.
pub struct Impacts {
    /// The dissipated energy, m²/s².
    pub lost: f64,
    /// Overlap of balls with the bodies that they hit, or their displacement out of it, m: the accuracy of the normals.
    pub moved: f64,
    /// The fastest of the omitted bounces.
    pub bounces: Option<Bounces>,
}

/// Assumptions about simultaneous impacts that the recorded course leaves open, because rounding may have decided them.
#[derive(Clone, Copy, Debug)]
pub struct Assumptions {
    /// Whether a closing speed of the size of rounding counts as closing.
    pub grazes: bool,
    /// Closing speeds up to this count as rounding, m/s.
    pub none: f64,
    /// Bit mask of the impacts that close at the same time as those before them.
    pub joins: u32,
    /// Whether balls that rebound too slowly to hop are on the cloth already.
    pub lies: bool,
    /// Whether slow impacts on the cloth lose nothing, because the shot is past the work limit after which no contact may rest.
    pub is_micro: bool,
}

impl Assumptions {
    /// Rounding decides nothing, and all impacts join those before them.
    pub const NOTHING: Self = Self { grazes: false, none: 0.0, joins: u32::MAX, lies: false, is_micro: false };
}

/// Whether an impact of a ball is reported before its landing.
fn meets_before_it_lands(reported: &[Event], ball: usize) -> bool {
    let meets = |event: &Event| match event.kind {
        EventKind::Lands(other) if other == ball => Some(false),
        EventKind::BallBall(first, second) if [first, second].contains(&ball) => Some(true),
        EventKind::BallRail(other, _) if other == ball => Some(true),
        _ => None,
    };
    reported.iter().find_map(meets).unwrap_or(false)
}

/// Returns the energy per mass of the slip between two balls on the cloth, m²/s². If they never slip at their contact, the slip
/// ends once they rest against each other. Its horizontal part comes from their motion and spin, its vertical part from their
/// spin alone.
fn slip_energy(table: &Table, contact: Contact, balls: &[Ball<f64>; BALLS]) -> f64 {
    let Contact::Balls(first, second) = contact else { return 0.0 };
    let [one, other] = [&balls[first], &balls[second]];
    let seen = |v: Vector<f64>| v.to_f64().truncate();
    let tangent = seen(one.position - other.position).normalize().perp();
    let spin = one.spin + other.spin;
    let along = seen(one.velocity - other.velocity).dot(tangent) - table.radius * spin.z;
    let upright = table.radius * seen(spin).dot(tangent);
    along * along / 14.0 + upright * upright / 10.0
}

/// Returns the balls before their impacts, those that have come down after the cloth's response, and the energy per mass that it takes.
fn arriving(
    numbers: &Numbers<f64>,
    before: &[SpatialState; BALLS],
    flew: [bool; BALLS],
    has_come_down: impl Fn(usize) -> bool,
) -> ([Ball<f64>; BALLS], f64) {
    let mut lost = 0.0;
    let balls = std::array::from_fn(|ball| {
        let SpatialState { position, velocity, spin } = before[ball];
        let mut state =
            Ball { velocity: Vector::of(velocity), spin: Vector::of(spin), ..Ball::at_rest(Vector::of(position)) };
        state.motion = if flew[ball] { Motion::Flying } else { state.on_cloth(numbers, 0.0) };
        if has_come_down(ball) {
            lost += settle(numbers, &mut state);
        }
        state
    });
    (balls, lost)
}

/// The first impacts of a round.
struct Taken {
    count: usize,
    /// The dissipated energy, m²/s².
    lost: f64,
    /// The fastest of the omitted bounces.
    bounces: Option<Bounces>,
}

/// Computes a `round` of contacts that close at the same time, given with whether they stay closed. If a later one of them gets no impulse,
/// only those before it are taken: impacts without an impulse are not reported, so this one belongs to a later round. `lossless` is the law
/// of slow impacts, if that is another one.
fn collide_round(
    table: &Table,
    numbers: &Numbers<f64>,
    lossless: Option<&Numbers<f64>>,
    balls: &mut [Ball<f64>; BALLS],
    round: &[(Contact, bool)],
) -> Taken {
    let before = *balls;
    let (mut joined, mut staying): (Vec<Contact>, Vec<Contact>) = Default::default();
    for (contact, stays) in round {
        joined.push(*contact);
        staying.extend(stays.then_some(*contact));
    }
    let is_slow = |contact: &Contact| -contact.opening_speed(&before) < fastest_micro_collision(table);
    let law = lossless.filter(|_| joined.iter().all(is_slow)).unwrap_or(numbers);
    let mut met = Vec::new();
    let work = collide_simultaneously(law, balls, &joined, &staying, &mut met);
    if let (Some(unmet @ 1..), true) = (joined.iter().position(|contact| !met.contains(contact)), work.is_ok()) {
        *balls = before;
        return collide_round(table, numbers, lossless, balls, &round[..unmet]);
    }
    let bounces_of = |contact: &Contact| {
        let closing_speed = -contact.opening_speed(&before);
        Bounces::of(table, contact.balls().0, closing_speed, contact.restitution(numbers))
    };
    Taken {
        count: round.len(),
        // If no impulses are found, nothing is explained.
        lost: work.unwrap_or(0.0),
        bounces: staying.iter().map(bounces_of).max_by(|one, other| one.energy.total_cmp(&other.energy)),
    }
}

/// Computes the reported impacts of a `group` of balls, together if they close at the same time. `flew` are the balls that were in the air
/// before. Those of them that have come down are first thrown up by the cloth, or are on it; others land last if a landing is reported. An
/// impact has no restitution if its bodies rest against each other from now on.
pub fn impacts(
    table: &Table,
    [before, after]: [&[SpatialState; BALLS]; 2],
    [flew, group, rested, rests]: [[bool; BALLS]; 4],
    reported: &[Event],
    assumed: Assumptions,
) -> Impacts {
    let numbers = Numbers::<f64>::of(table);
    let lossless = numbers.with_restitution(1.0);
    let slowest_bounce = numbers.flight.map_or(0.0, |flight| flight.slowest);
    let slowest = if assumed.lies { slowest_bounce } else { 0.0 };
    let has_come_down = |ball: usize| {
        let SpatialState { position, velocity, .. } = before[ball];
        group[ball] && flew[ball] && position.z <= 0.0 && velocity.z <= slowest
    };
    let (mut balls, mut lost) = arriving(&numbers, before, flew, has_come_down);
    for ball in (0..BALLS).filter(|&ball| has_come_down(ball) && assumed.lies && meets_before_it_lands(reported, ball))
    {
        balls[ball].motion = Motion::Flying;
    }
    let contacts: Vec<Contact> = reported
        .iter()
        .filter_map(|event| Contact::of_event(event.kind))
        .filter(|contact| group[contact.balls().0])
        .collect();
    let after = after.map(|SpatialState { position, velocity, .. }| Ball::<f64> {
        velocity: Vector::of(velocity),
        ..Ball::at_rest(Vector::of(position))
    });
    let rests = |contact: &Contact| contact.is_among(rests) && contact.opening_speed(&after) < STOPPED_SPEED;
    let overlap = contacts.iter().fold(0.0_f64, |most, contact| most.max(-contact.gap(&numbers, &balls)));
    let first_of_its_kind = |(index, contact): &(usize, &Contact)| !contacts[..*index].contains(contact);
    let gripping = contacts.iter().enumerate().filter(first_of_its_kind).map(|(_, contact)| *contact).filter(rests);
    let gripping: Vec<Contact> = gripping.collect();
    // The contact stays closed after the last of its impacts.
    let stays = |index: usize| rests(&contacts[index]) && !contacts[index + 1..].contains(&contacts[index]);
    let joins = |index: usize| assumed.joins.checked_shr(index as u32).is_none_or(|joins| joins & 1 == 1);
    let mut next = 0;
    let mut bounces: Option<Bounces> = None;
    let rounding = |contact: &Contact, balls: &[Ball<f64>; BALLS]| {
        let (first, second) = contact.balls();
        let speed = |ball: usize| balls[ball].velocity.length();
        let resting_speed = if contact.is_among(rested) { RESTING_SPEED } else { 0.0 };
        resting_speed.max(assumed.none).max(GRAZING * (speed(first) + second.map_or(0.0, speed)))
    };
    while let Some(&contact) = contacts.get(next) {
        let is_aloft = contact.is_aloft(&balls);
        let rounded = rounding(&contact, &balls);
        if is_aloft && opening_aloft(&numbers, contact, &balls) > if assumed.grazes { -rounded } else { rounded } {
            next += 1;
            continue;
        }
        let closes = |contact: &Contact| {
            if contact.is_aloft(&balls) {
                return opening_aloft(&numbers, *contact, &balls) < -slowest_bounce;
            }
            let least = if assumed.grazes { 0.0 } else { rounding(contact, &balls) };
            contact.opening_speed(&balls) < -least
        };
        let may_join = !is_aloft || closes(&contact);
        // With a ball in the air, only contacts that share balls are solved together.
        let is_linked = |other: &Contact, round: &[Contact]| {
            let all_lie = || !round.iter().chain([other]).any(|contact| contact.is_aloft(&balls));
            round.iter().any(|member| member.shares_a_ball(*other)) || all_lie()
        };
        let joins = |end: usize| {
            let (round, other) = (&contacts[next..end], &contacts[end]);
            joins(end) && closes(other) && !round.contains(other) && is_linked(other, round)
        };
        let mut end = next + 1;
        while may_join && end < contacts.len() && joins(end) {
            end += 1;
        }
        if is_aloft && end == next + 1 {
            lost += collide_aloft(&numbers, contact, &mut balls).work;
        } else {
            let round: Vec<_> = (next..end).map(|index| (contacts[index], stays(index))).collect();
            let lossless = assumed.is_micro.then_some(&lossless);
            let taken = collide_round(table, &numbers, lossless, &mut balls, &round);
            lost += taken.lost;
            bounces = bounces.into_iter().chain(taken.bounces).max_by(|one, other| one.energy.total_cmp(&other.energy));
            end = next + taken.count;
        }
        next = end;
        for ball in balls.iter_mut().filter(|ball| ball.velocity.z > 0.0) {
            ball.motion = Motion::Flying;
        }
    }
    for event in reported {
        if let EventKind::Lands(ball) = event.kind
            && group[ball]
            && balls[ball].motion == Motion::Flying
        {
            balls[ball].position.z = 0.0;
            lost += settle(&numbers, &mut balls[ball]);
        }
    }
    if table.ball_friction.is_none() && table.ball_slip_friction.is_none() {
        let slipping = gripping.into_iter().filter(|contact| !contact.is_aloft(&balls));
        lost += slipping.map(|contact| slip_energy(table, contact, &balls)).sum::<f64>();
    }
    let moved = balls.iter().zip(before).map(|(ball, before)| before.position.distance(ball.position.to_f64()));
    Impacts { lost, moved: moved.fold(overlap, f64::max), bounces }
}
