//! Forces and accelerations of balls in resting contact.

use glam::{DVec2, DVec3};

use super::{
    ActiveSet, Contact, Contacts, Friction, MAX_CONTACTS,
    linear::Factorized,
    problem::{GYRATION, Limit, Place, Problem, Row, Unknown, coefficient},
    solve::{PROXIMITY, ROUNDING, Side, solve},
};
use crate::{
    physics::{BallState, slip},
    table::{BALLS, Table},
};

/// Most scalar unknowns: a normal and two frictions a contact, five frictions of the cloth a ball.
const MAX_UNKNOWNS: usize = 3 * MAX_CONTACTS + 5 * BALLS;

/// Rounds of refinement that take the effect of [`PROXIMITY`] out again.
const MAX_REFINEMENTS: usize = 8;

/// What begins to slip more slowly than this share of g holds: in a second it would come to 1e-9 m/s.
const DEPARTING: f64 = 1e-10;

/// The speed that gives a direction to what begins to slip, m/s: far below every slip that counts.
const STARTING: f64 = 1e-8;

/// A slip that begins with less than this share of its friction's acceleration begins slowly: its direction would follow the
/// friction's so fast that no step could be long.
const SLOW_START: f64 = 0.3;

/// Accelerations of all balls, and the forces of contacts and of frictions that hold.
#[derive(Clone, Copy, Debug)]
pub struct Forces {
    /// Acceleration, m/s².
    pub linear: [DVec2; BALLS],
    /// Angular acceleration, rad/s².
    pub angular: [DVec3; BALLS],
    /// Normal force per ball mass of each contact, m/s².
    pub normal: [f64; MAX_CONTACTS],
    /// By how much all laws hold, m/s²: negative where the regime that was asked for has ended.
    pub slack: f64,
    /// Sizes of the problem's unknowns, to start from in a similar state.
    sizes: [f64; MAX_UNKNOWNS],
}

/// The regime that holds in a state.
#[derive(Clone, Debug)]
pub struct Resolved {
    /// The contacts that push.
    pub contacts: Contacts,
    /// What their frictions do.
    pub set: ActiveSet,
    /// The forces.
    pub forces: Forces,
    /// Whether frictions hold together more than is needed, so that [`Forces::slack`] does not tell for how long.
    pub shared: bool,
    /// Whether all laws hold to rounding.
    pub converged: bool,
}

/// Finds which of the `contacts` push and which frictions hold, and the forces; `set` tells what slips already. `None`
/// where nothing pushes by more than `slack`, m/s². Where forces are not unique they are near to the `similar` ones.
pub fn resolve(
    table: &Table,
    balls: &[BallState; BALLS],
    contacts: &Contacts,
    set: &ActiveSet,
    slack: f64,
    similar: Option<&Forces>,
) -> Option<Resolved> {
    let problem = Problem::new(table, balls, contacts.as_slice(), set);
    let none = [0.0; MAX_UNKNOWNS];
    let guess = similar.map_or(&none, |similar| &similar.sizes);
    let solution = solve(&problem, &guess[..problem.rates.len()]);
    let accelerations = problem.accelerations(&solution.sizes);
    let mut resolved = Resolved {
        contacts: *contacts,
        set: *set,
        forces: Forces::of(table.radius, &problem, &solution.sizes, &accelerations),
        shared: false,
        converged: solution.converged,
    };
    let never_slips = |place: Place| {
        let of_balls = |index: usize| contacts.as_slice()[index].second.is_some();
        table.ball_friction.is_none() && matches!(place, Place::Contact(index) if of_balls(index))
    };
    let pushes = |index: usize| resolved.forces.normal[index] > slack;
    let mut kept = [Friction::Sticks; MAX_CONTACTS];
    let mut count = 0;
    for (unknown, side) in problem.unknowns.iter().zip(&solution.sides) {
        let Side::Limited(force) = *side else { continue };
        let rates: [f64; 2] = std::array::from_fn(|axis| {
            if axis < unknown.count { problem.rates[unknown.first + axis].dot(&accelerations) } else { 0.0 }
        });
        let rate = DVec2::from_array(rates).length();
        let holds = rate <= DEPARTING * table.gravity;
        resolved.shared |= holds;
        let size = solution.sizes[unknown.first..][..unknown.count].iter().fold(0.0_f64, |size, x| size.hypot(*x));
        let starts = match unknown.count {
            1 => Friction::Slips(-force),
            _ if rate < SLOW_START * size || never_slips(unknown.place) => Friction::Yields,
            _ => Friction::Slips(-STARTING * force),
        };
        match unknown.place {
            _ if holds => {}
            Place::Normal(_) => {}
            Place::Cloth(ball) => resolved.set.cloth[ball] = starts,
            Place::Roll(ball) => resolved.set.roll[ball] = starts,
            Place::Spin(ball) => resolved.set.spin[ball] = starts,
            Place::Contact(index) => resolved.set.contact[index] = starts,
        }
    }
    for index in 0..contacts.as_slice().len() {
        if pushes(index) {
            kept[count] = resolved.set.contact[index];
            count += 1;
        }
    }
    resolved.contacts.retain(|index, _| pushes(index));
    if count == 0 {
        return None;
    }
    resolved.set.contact = kept;
    resolved.forces.slack = spin_slack(table.radius, balls, &resolved.set).min(slack_of(&problem, &solution.sizes));
    Some(resolved)
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
    if let [contact] = contacts
        && let Some(forces) = slipping(table, balls, contact, set)
    {
        return Some(forces);
    }
    let problem = Problem::new(table, balls, contacts, set);
    let mut sizes = [0.0; MAX_UNKNOWNS];
    if let Some(similar) = similar {
        sizes = similar.sizes;
    }
    let sizes = &mut sizes[..problem.rates.len()];
    let accelerations = balance(&problem, problem.known, &problem.bias, sizes)?;
    let mut forces = Forces::of(table.radius, &problem, sizes, &accelerations);
    forces.slack = spin_slack(table.radius, balls, set).min(slack_of(&problem, sizes));
    Some(forces)
}

/// The same where a friction yields: what holds is sought anew in every state.
pub fn yielding(
    table: &Table,
    balls: &[BallState; BALLS],
    contacts: &[Contact],
    set: &ActiveSet,
    similar: &Forces,
) -> Forces {
    let problem = Problem::new(table, balls, contacts, set);
    let solution = solve(&problem, &similar.sizes[..problem.rates.len()]);
    let accelerations = problem.accelerations(&solution.sizes);
    let mut forces = Forces::of(table.radius, &problem, &solution.sizes, &accelerations);
    forces.slack = spin_slack(table.radius, balls, set);
    for (unknown, side) in problem.unknowns.iter().zip(&solution.sides) {
        let friction = match unknown.place {
            Place::Normal(_) | Place::Spin(_) => Friction::Sticks,
            Place::Cloth(ball) => set.cloth[ball],
            Place::Roll(ball) => set.roll[ball],
            Place::Contact(index) => set.contact[index],
        };
        // Any law that changes sides ends the regime: as fast as its rate grows, or its force falls below the limit.
        let rows = &problem.rates[unknown.first..][..unknown.count];
        let slack = match side {
            Side::Holds if friction == Friction::Yields => -slack_of_one(unknown, &solution.sizes),
            Side::Holds => slack_of_one(unknown, &solution.sizes),
            Side::Limited(_) if friction == Friction::Yields => f64::INFINITY,
            _ => -rows.iter().fold(0.0_f64, |rate, row| rate.hypot(row.dot(&accelerations))),
        };
        forces.slack = forces.slack.min(slack);
    }
    forces.slack = forces.slack.min(table.gravity);
    forces
}

/// By how much the laws hold of forces that were found by supposing which do.
fn slack_of(problem: &Problem, sizes: &[f64]) -> f64 {
    problem.unknowns.iter().fold(f64::INFINITY, |slack, unknown| slack.min(slack_of_one(unknown, sizes)))
}

fn slack_of_one(unknown: &Unknown, sizes: &[f64]) -> f64 {
    let own = &sizes[unknown.first..][..unknown.count];
    let size = own.iter().fold(0.0_f64, |length, x| length.hypot(*x));
    match (unknown.place, unknown.limit) {
        (Place::Normal(_), _) => own[0],
        (_, Limit::Fixed(limit)) => limit - size,
        (_, Limit::Coulomb(mu, contact)) => mu * sizes[contact] - size,
    }
}

/// A spin that has turned round has ended before.
fn spin_slack(radius: f64, balls: &[BallState; BALLS], set: &ActiveSet) -> f64 {
    set.spin.iter().zip(balls).fold(f64::INFINITY, |slack, (spin, ball)| match spin {
        Friction::Slips(sign) if sign.x != 0.0 && ball.spin.z * sign.x < 0.0 => {
            slack.min(radius * ball.spin.z * sign.x)
        }
        _ => slack,
    })
}

/// The same in closed form for a single contact whose balls slip on the cloth: its three directions do not feel each other.
fn slipping(table: &Table, balls: &[BallState; BALLS], contact: &Contact, set: &ActiveSet) -> Option<Forces> {
    let radius = table.radius;
    let lever = 2.5 / radius;
    let boring = table.spinning_friction * table.gravity;
    let mut forces = Forces::NONE;
    // What a force along the contact's tangent accelerates: a ball whose spin is held, or one that turns, too.
    let mut response = 0.0;
    let members = [Some(contact.first), contact.second];
    for ball in members.into_iter().flatten() {
        let against = set.cloth[ball].direction(slip(radius, balls[ball].velocity, balls[ball].spin))?;
        let push = -table.sliding_friction * table.gravity * against;
        let sign = if let Friction::Slips(sign) = set.spin[ball] { sign.x } else { 0.0 };
        forces.linear[ball] = push;
        // Friction at the lowest point: w' = -5/2R z×push.
        forces.angular[ball] = (-lever * push.perp()).extend(-lever * boring * sign);
        response += if set.spin[ball] == Friction::Sticks { 1.0 } else { 3.5 };
    }
    let (n, slip_at) = contact.normal_and_slip(radius, balls);
    let t = n.perp();
    let (first, second) = (contact.first, contact.second);
    let (mut rates, mut spins) = (forces.linear[first], forces.angular[first]);
    let (mut centripetal, mut turning, mut bodies) = (0.0, 0.0, 1.0);
    let mu = coefficient(table, contact);
    if let Some(second) = second {
        let across = contact.relative_velocity(balls).dot(t);
        let spin = balls[first].spin + balls[second].spin;
        centripetal = across * across / (2.0 * radius);
        turning = -0.5 * across * spin.truncate().dot(n);
        rates -= forces.linear[second];
        spins += forces.angular[second];
        bodies = 2.0;
    }
    let normal = -(rates.dot(n) + centripetal) / bodies;
    (forces.normal[0], forces.sizes[0]) = (normal, normal);
    forces.slack = normal.min(spin_slack(radius, balls, set));
    let friction = if let Some(against) = set.contact[0].direction(slip_at) {
        -mu * normal * against
    } else {
        let along = rates.dot(t) - radius * spins.z;
        let up = radius * spins.truncate().dot(t) + turning;
        let holds = DVec2::new(-along / response, -up / (2.5 * bodies));
        forces.slack = forces.slack.min(mu * normal - holds.length());
        holds
    };
    let force = normal * n + friction.x * t;
    let twist = (lever * friction.y * t).extend(-lever * friction.x);
    for (ball, sense) in [(Some(first), 1.0), (second, -1.0)] {
        let Some(ball) = ball else { continue };
        forces.linear[ball] += sense * force;
        forces.angular[ball] += twist;
        if set.spin[ball] == Friction::Sticks {
            forces.angular[ball].z = 0.0;
            forces.slack = forces.slack.min(boring - friction.x.abs());
        }
    }
    Some(forces)
}

/// Takes out of velocities and spins what is left of speeds that are to be zero: the opening of `contacts` and the slips that
/// do not last by `set`, by impulses in those contacts, as the ends of slips do: a push that stops something rubs where its
/// contact slips. Where they cannot all vanish, all stay.
pub fn stop_by_impulses(table: &Table, balls: &mut [BallState; BALLS], contacts: &[Contact], set: &ActiveSet) {
    let mut problem = Problem::new(table, balls, contacts, &set.slipping_where(set));
    for (index, contact) in contacts.iter().enumerate() {
        // Balls without a coefficient of friction have no rubbing of their own: what stops them does not slip.
        if table.ball_friction.is_none() && contact.second.is_some() {
            problem.forces[index] = problem.rates[index];
        }
    }
    let speeds = Row::of_speeds(table.radius, balls);
    let bias = vec![0.0; problem.rates.len()];
    let mut sizes = bias.clone();
    if let Some(stopped) = balance(&problem, speeds, &bias, &mut sizes) {
        for (ball, state) in balls.iter_mut().enumerate() {
            let (velocity, spin) = stopped.of_ball(ball);
            (state.velocity, state.spin) = (velocity, spin / (GYRATION * table.radius));
        }
    }
}

/// Changes the sizes of the unknown forces, as little as possible, until all their rates vanish; returns what `base` becomes
/// under them. `None` where they cannot vanish together.
fn balance(problem: &Problem, base: Row, bias: &[f64], sizes: &mut [f64]) -> Option<Row> {
    let count = sizes.len();
    let mut matrix = problem.matrix();
    for index in 0..count {
        matrix[index * count + index] += PROXIMITY;
    }
    let factors = Factorized::new(count, matrix)?;
    let mut side = vec![0.0; count];
    let mut smallest = f64::INFINITY;
    for _ in 0..MAX_REFINEMENTS {
        let mut moved = base;
        for (size, row) in sizes.iter().zip(&problem.forces) {
            moved.add(*size, row);
        }
        let (mut residual, mut scale) = (0.0_f64, f64::MIN_POSITIVE);
        for (index, side) in side.iter_mut().enumerate() {
            *side = -(problem.rates[index].dot(&moved) + bias[index]);
            residual = residual.max(side.abs());
            scale = scale.max(sizes[index].abs()).max(bias[index].abs());
        }
        scale = base.0.iter().fold(scale, |scale, x| scale.max(x.abs()));
        // Once rounding is reached, more rounds would only stir it.
        if residual <= 16.0 * f64::EPSILON * scale
            || (residual <= 16.0 * ROUNDING * scale && residual >= 0.5 * smallest)
        {
            return Some(moved);
        }
        smallest = smallest.min(residual);
        factors.solve(&mut side);
        for (size, change) in sizes.iter_mut().zip(&side) {
            *size += change;
        }
    }
    None
}

impl Forces {
    const NONE: Self = Self {
        linear: [DVec2::ZERO; BALLS],
        angular: [DVec3::ZERO; BALLS],
        normal: [0.0; MAX_CONTACTS],
        slack: f64::INFINITY,
        sizes: [0.0; MAX_UNKNOWNS],
    };

    fn of(radius: f64, problem: &Problem, sizes: &[f64], accelerations: &Row) -> Self {
        let mut forces = Self::NONE;
        for ball in 0..BALLS {
            let (linear, angular) = accelerations.of_ball(ball);
            forces.linear[ball] = linear;
            forces.angular[ball] = angular / (GYRATION * radius);
        }
        for unknown in &problem.unknowns {
            if let Place::Normal(index) = unknown.place {
                forces.normal[index] = sizes[unknown.first];
            }
        }
        forces.sizes[..sizes.len()].copy_from_slice(sizes);
        forces
    }

    /// The largest difference of accelerations, m/s²; `radius` in metres turns angular into linear ones.
    pub fn distance(&self, other: &Self, radius: f64) -> f64 {
        (0..BALLS).fold(0.0, |largest, ball| {
            let linear = self.linear[ball].distance(other.linear[ball]);
            let angular = radius * self.angular[ball].distance(other.angular[ball]);
            linear.max(angular).max(largest)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn resolved(ball: BallState, contacts: &[Contact]) -> Option<Resolved> {
        let table = Table::preset("thesis").unwrap();
        let balls = [ball, BallState::at_rest(DVec2::new(0.5, 0.0)), BallState::at_rest(DVec2::new(-0.5, 0.0))];
        let mut list = Contacts::NONE;
        for contact in contacts {
            list.push(*contact);
        }
        let set = ActiveSet::of(&table, &balls, contacts, 1e-10);
        resolve(&table, &balls, &list, &set, 1e-11, None)
    }

    fn right_cushion() -> (Table, Contact, DVec2) {
        let table = Table::preset("thesis").unwrap();
        let position = DVec2::new(table.half_length(), 0.0);
        (table, Contact::with_cushion(0, DVec2::NEG_X), position)
    }

    #[test]
    fn a_cushion_pushes_back_just_what_the_cloth_presses() {
        let (table, contact, position) = right_cushion();
        // Topspin towards the right cushion, and some speed along it.
        let ball = BallState { position, velocity: DVec2::new(0.0, 0.7), spin: DVec3::new(3.0, 80.0, -5.0) };
        let forces = resolved(ball, &[contact]).unwrap().forces;
        let u = slip(table.radius, ball.velocity, ball.spin).normalize();
        let pressed = table.sliding_friction * table.gravity * -u.x;
        assert!((forces.normal[0] - pressed).abs() < 1e-13);
        assert!(forces.linear[0].x.abs() < 1e-13);
        // The ball slips along +y on the cushion: the friction opposes it and has at most Coulomb's size.
        let friction = forces.linear[0].y + table.sliding_friction * table.gravity * u.y;
        assert!(friction.abs() <= table.rail_friction * pressed + 1e-13 && friction < 0.0);
    }

    #[test]
    fn the_closed_form_agrees_with_the_solver() {
        let (table, contact, position) = right_cushion();
        let ball = BallState { position, velocity: DVec2::new(0.0, 0.7), spin: DVec3::new(3.0, 80.0, -5.0) };
        let resolved = resolved(ball, &[contact]).unwrap();
        let balls = [ball, BallState::at_rest(DVec2::new(0.5, 0.0)), BallState::at_rest(DVec2::new(-0.5, 0.0))];
        let closed = slipping(&table, &balls, &contact, &resolved.set).unwrap();
        assert!(resolved.converged && closed.distance(&resolved.forces, table.radius) < 1e-12);
    }

    #[test]
    fn a_cushion_never_pulls() {
        let (_, contact, position) = right_cushion();
        let ball = BallState { position, velocity: DVec2::ZERO, spin: DVec3::new(0.0, -80.0, 0.0) };
        assert!(resolved(ball, &[contact]).is_none());
    }
}
