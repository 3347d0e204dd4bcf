//! Determines which closed contacts press at one time, and which slips of the balls end or begin there.

use super::{
    Numbers, Real, Unjudged,
    complementarity::Law,
    contact::{Balls, Contact},
    laws::Laws,
    rounds::touching_contacts,
    rows::{Row, movement},
    system::System,
    tolerance::{self, settled, slack, touching},
};

/// Maximum number of slips that begin one after the other at one time, with a margin.
const MAX_CHANGES: usize = 32;

/// Initial speed of a slip, in units of the speed that counts as zero.
const BEGINNING: f64 = 4.0;

/// The balls with pressing contacts.
#[derive(Clone, Debug)]
pub struct Rest<R> {
    /// The laws in force.
    pub laws: Laws<R>,
    /// Sizes of the unknown forces.
    pub forces: Vec<R>,
    /// Whether something creeps: a slip that begins follows its driving force, and the forces must be solved again at every
    /// evaluation.
    pub creeps: bool,
}

impl<R: Real> Rest<R> {
    /// Whether a contact presses.
    pub fn presses(&self, contact: Contact) -> bool {
        self.laws.contacts.iter().any(|(pressing, _)| *pressing == contact)
    }
}

/// Finds the pressing contacts, `None` if there are none, and the energy per mass that friction dissipates instantly.
///
/// # Errors
/// [`Unjudged::Unsolved`] if no forces are found that obey all laws.
pub fn rest<R: Real>(numbers: &Numbers<R>, balls: &mut Balls<R>) -> Result<(Option<Rest<R>>, R), Unjudged> {
    let mut work = R::zero();
    for _ in 0..MAX_CHANGES {
        let closed = closed(numbers, balls);
        let pressing = match pressing(numbers, balls, &closed, settled()) {
            Ok(pressing) => pressing,
            Err(_) if bounce(numbers, balls, &closed) => continue,
            Err(error) => return Err(error),
        };
        if pressing.is_empty() {
            return Ok((None, work));
        }
        if let Some(lost) = stick(numbers, balls, &pressing) {
            work = work + lost;
            continue;
        }
        let laws = Laws::of(numbers, balls, &pressing);
        let system = System::new(numbers, balls, &laws);
        let forces = system.solve_forces(numbers).ok_or(Unjudged::Unsolved)?;
        let (speeds, begins) = wanted_speeds(numbers, &system, &forces);
        work = work + system.set_speeds(numbers, balls, &speeds);
        if !begins {
            close(numbers, balls, &pressing);
            for ((ball, motion), spin_sign) in balls.iter_mut().zip(laws.cloth).zip(laws.spin_signs) {
                let Some(motion) = motion else { continue };
                ball.motion = motion;
                if spin_sign == R::zero() {
                    ball.spin.z = R::zero();
                }
            }
            return Ok((Some(Rest { laws, forces, creeps: false }), work));
        }
    }
    // Slips that prevent each other from beginning begin together.
    creep(numbers, balls).map(|(rest, _)| (Some(rest), work)).ok_or(Unjudged::Unsolved)
}

/// Returns the pressing contacts if slips may creep, and whether one does; `None` if no forces are found.
///
/// A slip with almost no driving force grows so slowly that the equations are stiff: the direction of its friction settles many
/// thousand times faster. This direction is then the one in which the slip would begin from rest.
pub fn creep<R: Real>(numbers: &Numbers<R>, balls: &Balls<R>) -> Option<(Rest<R>, bool)> {
    let none = tolerance::creeping();
    let pressing = pressing(numbers, balls, &closed(numbers, balls), none).ok()?;
    let laws = Laws::if_none(numbers, balls, &pressing, none);
    let system = System::new(numbers, balls, &laws);
    let forces = system.solve_forces(numbers)?;
    let creeps = wanted_speeds(numbers, &system, &forces).1;
    Some((Rest { laws, forces, creeps: true }, creeps))
}

/// Returns the contacts that are closed and neither open nor close.
fn closed<R: Real>(numbers: &Numbers<R>, balls: &Balls<R>) -> Vec<Contact> {
    let mut contacts = touching_contacts(numbers, balls);
    contacts.retain(|contact| contact.opening_speed(balls).abs() <= tolerance::closed());
    contacts
}

/// Returns the contacts among `closed` that press, if slips and speeds up to `none`, m/s, count as zero.
fn pressing<R: Real>(
    numbers: &Numbers<R>,
    balls: &Balls<R>,
    closed: &[Contact],
    none: R,
) -> Result<Vec<Contact>, Unjudged> {
    if closed.is_empty() {
        return Ok(Vec::new());
    }
    let system = System::new(numbers, balls, &Laws::if_none(numbers, balls, closed, none));
    let forces = system.solve_forces(numbers).ok_or(Unjudged::Unsolved)?;
    let pushes = system.blocks.iter().filter(|block| matches!(block.law, Law::Push)).map(|block| forces[block.at]);
    let pressing = closed.iter().zip(pushes).filter(|(_, push)| *push > slack()).map(|(contact, _)| *contact);
    Ok(pressing.collect())
}

/// Makes the contacts that never slip open with the speed of a first bounce, and returns whether there are any.
///
/// With unlimited friction there are states in which no forces obey all laws (Painlevé's paradox): the force that would prevent
/// the slip makes the contact open, and the open contact, without forces, closes. The contact then begins to bounce, higher
/// each time.
fn bounce<R: Real>(numbers: &Numbers<R>, balls: &mut Balls<R>, closed: &[Contact]) -> bool {
    let mut bounces = false;
    for contact in closed.iter().filter(|contact| contact.friction(numbers).is_none()) {
        let row = Row::opening(*contact, contact.normal(balls));
        let mut moved = movement(balls);
        let missing = numbers.first_bounce - row.speed(&moved);
        row.push(numbers, missing / row.response(numbers, &row), &mut moved);
        for (ball, (velocity, _)) in balls.iter_mut().zip(moved) {
            ball.velocity = velocity;
        }
        bounces = true;
    }
    bounces
}

/// Stops the slip of contacts that never slip once they press, as in a collision: the cloth has no time to act.
fn stick<R: Real>(numbers: &Numbers<R>, balls: &mut Balls<R>, pressing: &[Contact]) -> Option<R> {
    let slips =
        |contact: &Contact| contact.friction(numbers).is_none() && contact.slip(numbers, balls).length() > settled();
    if !pressing.iter().any(slips) {
        return None;
    }
    let laws = Laws::of(numbers, balls, pressing).without_cloth();
    let system = System::new(numbers, balls, &laws);
    let work = system.set_speeds(numbers, balls, &vec![R::zero(); system.len()]);
    for (index, ball) in balls.iter_mut().enumerate() {
        if pressing.iter().any(|contact| contact.involves(index)) {
            ball.choose_motion(numbers, settled());
        }
    }
    Some(work)
}

/// Returns the wanted speeds: zero for what sticks, and a small initial speed for each slip that begins. Also returns whether
/// any slip begins.
fn wanted_speeds<R: Real>(numbers: &Numbers<R>, system: &System<R>, forces: &[R]) -> (Vec<R>, bool) {
    let rates = system.rates(numbers, forces);
    let mut wanted = vec![R::zero(); rates.len()];
    let mut begins = false;
    for block in system.blocks.iter().filter(|block| !matches!(block.law, Law::Push)) {
        let rows = block.at..block.at + block.axes;
        let size = rows.clone().fold(R::zero(), |sum, row| sum + rates[row] * rates[row]).sqrt();
        if size > slack() {
            begins = true;
            for row in rows {
                wanted[row] = rates[row] / size * (R::of(BEGINNING) * settled());
            }
        }
    }
    (wanted, begins)
}

/// Removes rounding from the gaps. An overlap present at the start of the shot is left unchanged.
fn close<R: Real>(numbers: &Numbers<R>, balls: &mut Balls<R>, pressing: &[Contact]) {
    for contact in pressing {
        if contact.gap(numbers, balls).abs() <= R::of(1e3) * touching() {
            contact.close(numbers, balls);
        }
    }
}
