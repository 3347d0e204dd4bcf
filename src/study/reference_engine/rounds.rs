//! Simultaneous impacts, in rounds: contacts that close at the same time are solved together.
//!
//! The normal impulses of a round are complementary to the speeds after it (Moreau 1988), `0 <= v+ + e v- ⊥ P >= 0`; the
//! frictions follow from the slips before it. Contacts that close as a result form the next round. An impact thus passes
//! through a row of balls as a chain, and the result does not depend on the numbering. A group of contacts with a ball in the air
//! is solved in space in the same way, and the cloth then reacts.

use super::{
    Motion, Numbers, Real, Unjudged, Vector,
    complementarity::{Block, Law, Problem},
    contact::{Balls, Contact},
    flight::{self, ImpactAloft, from_nose, jumps_and_landings, opening_aloft, settle},
    impact::{balls_collide, coulomb, rail_collides},
    rows::{Movement, Row, movement},
    tolerance::{closed, touching},
};
use crate::{simulation::EventKind, table::BALLS};

/// Number of rounds after which all touching contacts get one inelastic impact.
const MAX_ROUNDS: usize = 32;

/// Returns all contacts on the cloth with closed gaps.
pub fn touching_contacts<R: Real>(numbers: &Numbers<R>, balls: &Balls<R>) -> Vec<Contact> {
    let closed = |contact: &Contact| !contact.is_aloft(balls) && contact.gap(numbers, balls) <= touching();
    Contact::all().filter(closed).collect()
}

/// Collides all touching contacts that close; the contacts in `inelastic` have no restitution. Returns the contacts with an
/// impact, and the dissipated energy per mass.
///
/// # Errors
/// [`Unjudged::Unsolved`] if no impulses are found.
pub fn collide<R: Real>(
    numbers: &Numbers<R>,
    balls: &mut Balls<R>,
    inelastic: &[Contact],
) -> Result<(Vec<Contact>, R), Unjudged> {
    let contacts = touching_contacts(numbers, balls);
    let (mut met, mut work) = (Vec::new(), R::zero());
    for round in 0..=MAX_ROUNDS {
        let is_last = round == MAX_ROUNDS;
        let fastest = if is_last { closed() } else { -closed::<R>() };
        let closes = |contact: &&Contact| contact.opening_speed(balls) < fastest;
        let closing: Vec<Contact> = contacts.iter().filter(closes).copied().collect();
        if closing.is_empty() {
            break;
        }
        work = work
            + if is_last {
                let pushes = normal_impulses(numbers, balls, &closing, |_| R::zero())?;
                one_round(numbers, balls, &closing, &pushes, &mut met)
            } else {
                collide_simultaneously(numbers, balls, &closing, inelastic, &mut met)?
            };
    }
    Ok((met, work))
}

/// Collides `contacts` that close at the same time. Contacts that share balls are solved together; any other contact, also one
/// that remains alone after others are relieved, follows the table's own law. The contacts in `inelastic` have no restitution.
/// Adds the contacts with an impulse to `met`, and returns the dissipated energy per mass.
///
/// # Errors
/// [`Unjudged::Unsolved`] if no impulses are found.
pub fn collide_simultaneously<R: Real>(
    numbers: &Numbers<R>,
    balls: &mut Balls<R>,
    contacts: &[Contact],
    inelastic: &[Contact],
    met: &mut Vec<Contact>,
) -> Result<R, Unjudged> {
    let restitution =
        |contact: &Contact| if inelastic.contains(contact) { R::zero() } else { contact.restitution(numbers) };
    let mut work = R::zero();
    let mut left = contacts.to_vec();
    while !left.is_empty() {
        let mut joined = vec![left.remove(0)];
        // Two passes connect all three balls.
        for _ in 1..BALLS {
            let (sharing, others): (Vec<_>, Vec<_>) =
                left.into_iter().partition(|contact| joined.iter().any(|other| contact.shares_a_ball(*other)));
            joined.extend(sharing);
            left = others;
        }
        let taken = if let [contact] = joined[..] {
            met.push(contact);
            let dead = inelastic.contains(&contact).then(|| numbers.with_restitution(R::zero()));
            if contact.is_aloft(balls) {
                flight::collide(numbers, contact, balls).work
            } else {
                collide_single(dead.as_ref().unwrap_or(numbers), balls, contact)
            }
        } else {
            let pushes = normal_impulses(numbers, balls, &joined, restitution)?;
            let is_pushed = |(contact, push): (&Contact, &R)| (*push > R::zero()).then_some(*contact);
            let pushing: Vec<Contact> = joined.iter().zip(&pushes).filter_map(is_pushed).collect();
            if pushing.len() < joined.len() {
                collide_simultaneously(numbers, balls, &pushing, inelastic, met)?
            } else {
                one_round(numbers, balls, &joined, &pushes, met)
            }
        };
        work = work + taken;
    }
    Ok(work)
}

/// Collides two bodies, at least one of which is a ball in the air, together with all others that meet at the same time.
///
/// # Errors
/// [`Unjudged::Unsolved`] if no impulses are found.
pub fn collide_all_aloft<R: Real>(
    numbers: &Numbers<R>,
    contact: Contact,
    balls: &mut Balls<R>,
) -> Result<ImpactAloft<R>, Unjudged> {
    let closing = closing_aloft(numbers, contact, balls);
    if closing.iter().all(|other| *other == contact) {
        return Ok(flight::collide(numbers, contact, balls));
    }
    let (before, mut met) = (*balls, Vec::new());
    let work = collide_simultaneously(numbers, balls, &closing, &[], &mut met)?;
    let mut events: Vec<EventKind> = met.iter().map(|contact| contact.event()).collect();
    events.extend(jumps_and_landings(&before, balls));
    Ok(ImpactAloft { events, work, is_slow: false })
}

/// Returns the contacts that close together with `contact`, at which a ball in the air meets another body, and share balls with
/// it, directly or through others. In the air, only contacts that close faster than the slowest bounce there count.
fn closing_aloft<R: Real>(numbers: &Numbers<R>, contact: Contact, balls: &Balls<R>) -> Vec<Contact> {
    let slowest = numbers.flight.map_or(R::zero(), |flight| flight.slowest);
    let closes = |other: &Contact| match *other {
        _ if (0..BALLS).any(|ball| other.involves(ball) && balls[ball].motion == Motion::OffTable) => false,
        Contact::Rail(ball, rail) if other.is_aloft(balls) => {
            from_nose(numbers, &balls[ball], rail).length() - numbers.radius <= touching()
                && opening_aloft(numbers, *other, balls) < -slowest
        }
        _ => {
            let least = if other.is_aloft(balls) { slowest } else { closed() };
            other.gap(numbers, balls) <= touching() && other.opening_speed(balls) < -least
        }
    };
    let (mut linked, mut left): (Vec<Contact>, Vec<Contact>) = (Vec::new(), Contact::all().filter(closes).collect());
    for _ in 0..BALLS {
        let is_linked = |other: &Contact| {
            other.shares_a_ball(contact) || linked.iter().any(|member: &Contact| other.shares_a_ball(*member))
        };
        let (joined, others): (Vec<_>, Vec<_>) = left.into_iter().partition(is_linked);
        linked.extend(joined);
        left = others;
    }
    linked
}

/// Returns the unit normal of an impact, towards the first ball: a ball in the air meets the nose of a cushion.
fn impact_normal<R: Real>(numbers: &Numbers<R>, contact: Contact, balls: &Balls<R>) -> Vector<R> {
    match contact {
        Contact::Rail(ball, rail) if contact.is_aloft(balls) => from_nose(numbers, &balls[ball], rail).direction(),
        _ => contact.normal(balls),
    }
}

/// Computes a single impact by the table's own law. Returns the dissipated energy per mass.
pub fn collide_single<R: Real>(numbers: &Numbers<R>, balls: &mut Balls<R>, contact: Contact) -> R {
    match contact {
        Contact::Rail(ball, rail) => {
            rail_collides(numbers, numbers.cushion(rail), contact.normal(balls), &mut balls[ball])
        }
        Contact::Balls(first, second) => {
            let (mut one, mut other) = (balls[first], balls[second]);
            let work = balls_collide(numbers, &mut one, &mut other);
            (balls[first], balls[second]) = (one, other);
            work
        }
    }
}

/// Applies simultaneous impacts that share balls, with these normal impulses and with Coulomb friction, and the reaction of the
/// cloth if a ball is in the air. Otherwise the impacts are at the height of the balls' centres, and no ball is lifted. Adds the
/// contacts with an impulse to `met`, and returns the dissipated energy per mass.
fn one_round<R: Real>(
    numbers: &Numbers<R>,
    balls: &mut Balls<R>,
    contacts: &[Contact],
    pushes: &[R],
    met: &mut Vec<Contact>,
) -> R {
    let half = R::of(0.5);
    let before = movement(balls);
    let aloft = contacts.iter().any(|contact| contact.is_aloft(balls));
    let normals: Vec<Row<R>> =
        contacts.iter().map(|contact| Row::opening(*contact, impact_normal(numbers, *contact, balls))).collect();
    let mut pushed = before;
    for (row, push) in normals.iter().zip(pushes) {
        row.push(numbers, *push, &mut pushed);
    }
    let mut work = normals
        .iter()
        .zip(pushes)
        .fold(R::zero(), |work, (row, push)| work - half * *push * (row.speed(&before) + row.speed(&pushed)));
    let mut frictions: Vec<(Row<R>, R)> = Vec::with_capacity(contacts.len());
    for (contact, push) in contacts.iter().zip(pushes).filter(|(_, push)| **push > R::zero()) {
        met.push(*contact);
        let n = impact_normal(numbers, *contact, balls);
        let slip = contact.slip_across(numbers, n, balls);
        let (friction, stops) = match contact {
            Contact::Balls(..) => (numbers.ball_friction_at(slip.length()), R::ratio(1.0, 7.0)),
            Contact::Rail(..) => (contact.friction(numbers), R::ratio(2.0, 7.0)),
        };
        let share = coulomb(friction, *push, slip.length(), stops);
        let row = if aloft { Row::slip_in_space } else { Row::slip };
        frictions.push((row(numbers, *contact, n, slip), -share));
    }
    let mut change = before.map(|_| (Vector::zero(), Vector::zero()));
    for (row, size) in &frictions {
        row.push(numbers, *size, &mut change);
    }
    let share = lossy_share(numbers, &pushed, &change);
    let mut after = pushed;
    for (row, size) in &frictions {
        row.push(numbers, *size * share, &mut after);
    }
    for (row, size) in &frictions {
        work = work - half * *size * share * (row.speed(&pushed) + row.speed(&after));
    }
    for (ball, (velocity, spin)) in balls.iter_mut().zip(after) {
        (ball.velocity, ball.spin) = (velocity, spin);
    }
    for (index, ball) in balls.iter_mut().enumerate() {
        if aloft && contacts.iter().any(|contact| contact.involves(index)) {
            work = work + settle(numbers, ball);
        }
    }
    work
}

/// Returns the normal impulses per mass of a round; zero for a contact that others relieve.
fn normal_impulses<R: Real>(
    numbers: &Numbers<R>,
    balls: &Balls<R>,
    contacts: &[Contact],
    restitution: impl Fn(&Contact) -> R,
) -> Result<Vec<R>, Unjudged> {
    let before = movement(balls);
    let aloft = contacts.iter().any(|contact| contact.is_aloft(balls));
    let normals: Vec<Row<R>> =
        contacts.iter().map(|contact| Row::opening(*contact, impact_normal(numbers, *contact, balls))).collect();
    let speeds = contacts.iter().zip(&normals).map(|(contact, row)| {
        let (speed, restitution) = (row.speed(&before), restitution(contact));
        if aloft { speed - flight::opening(numbers, restitution, -speed).0 } else { (R::of(1.0) + restitution) * speed }
    });
    let matrix: Vec<Vec<R>> =
        normals.iter().map(|of| normals.iter().map(|by| of.response(numbers, by)).collect()).collect();
    let blocks: Vec<Block<R>> = (0..contacts.len()).map(|at| Block { at, axes: 1, law: Law::Push }).collect();
    let rates: Vec<R> = speeds.collect();
    Problem { matrix: &matrix, rates: &rates, blocks: &blocks }.solve().ok_or(Unjudged::Unsolved)
}

/// Returns the largest share, up to one, of a change that adds no energy.
fn lossy_share<R: Real>(numbers: &Numbers<R>, movement: &Movement<R>, change: &Movement<R>) -> R {
    let inertia = R::ratio(2.0, 5.0) * numbers.radius * numbers.radius;
    let product = |one: &Movement<R>, other: &Movement<R>| {
        one.iter().zip(other).fold(R::zero(), |sum, ((v, w), (v2, w2))| sum + v.dot(*v2) + inertia * w.dot(*w2))
    };
    let (gain, own) = (product(movement, change), product(change, change));
    // The energy increases by `share gain + share² own/2`.
    if gain + R::of(0.5) * own <= R::zero() { R::of(1.0) } else { (R::of(-2.0) * gain / own).max(R::zero()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        simulation::Rail,
        study::reference_engine::{Ball, DoubleDouble, rail_normal},
        table::Table,
    };

    type D = DoubleDouble;

    fn of(x: f64, y: f64, z: f64) -> Vector<D> {
        Vector::of(glam::DVec3::new(x, y, z))
    }

    fn agrees(one: &Ball<D>, other: &Ball<D>) {
        assert!((one.velocity - other.velocity).length().to_f64() < 1e-30);
        assert!((one.spin - other.spin).length().to_f64() < 1e-28);
    }

    #[test]
    fn a_round_of_one_contact_agrees_with_the_formulas_of_a_single_impact() {
        for table in ["thesis", "textbook"].map(|name| Table::preset(name).unwrap()) {
            let numbers = Numbers::<D>::of(&table);
            let ball = |position, velocity, spin| Ball { velocity, spin, ..Ball::at_rest(position) };
            let balls = [
                ball(of(0.0, 0.0, 0.0), of(0.3, 0.4, 0.0), of(9.0, -20.0, 30.0)),
                ball(of(2.0 * table.radius, 0.0, 0.0), of(-0.2, 0.1, 0.0), of(-5.0, 12.0, 7.0)),
                ball(of(-0.5, 0.0, 0.0), Vector::zero(), Vector::zero()),
            ];
            let round = |balls: &mut Balls<D>, contact: Contact| {
                let mut met = Vec::new();
                let pushes =
                    normal_impulses(&numbers, balls, &[contact], |contact| contact.restitution(&numbers)).unwrap();
                let work = one_round(&numbers, balls, &[contact], &pushes, &mut met);
                assert_eq!(met, [contact]);
                work
            };
            let mut both = balls;
            let work = round(&mut both, Contact::Balls(0, 1));
            let (mut first, mut second) = (balls[0], balls[1]);
            let known = balls_collide(&numbers, &mut first, &mut second);
            assert!((work - known).to_f64().abs() < 1e-30);
            agrees(&both[0], &first);
            agrees(&both[1], &second);

            let mut alone = balls;
            alone[0].position = Vector::new(numbers.half_length, D::zero(), D::zero());
            let mut single = alone[0];
            let work = round(&mut alone, Contact::Rail(0, Rail::Right));
            let known = rail_collides(&numbers, numbers.cushion(Rail::Right), rail_normal(Rail::Right), &mut single);
            assert!((work - known).to_f64().abs() < 1e-30);
            agrees(&alone[0], &single);
        }
    }

    #[test]
    fn frictions_of_a_round_add_no_energy() {
        let numbers = Numbers::<D>::of(&Table::preset("thesis").unwrap());
        let movement = [(of(1.0, 0.0, 0.0), Vector::zero()); 3];
        let change = |x: f64| [(of(x, 0.0, 0.0), Vector::zero()); 3];
        assert_eq!(lossy_share(&numbers, &movement, &change(-1.0)).to_f64(), 1.0);
        assert_eq!(lossy_share(&numbers, &movement, &change(-4.0)).to_f64(), 0.5);
        assert_eq!(lossy_share(&numbers, &movement, &change(1.0)).to_f64(), 0.0);
    }
}
