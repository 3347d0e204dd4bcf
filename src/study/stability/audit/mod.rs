//! The energy audit: every loss of energy must be explained by a friction or an impact, which dissipate no more and no less.
//!
//! The energy of a shot decreases between changes and at the changes themselves. For each of both, the laws give the dissipated
//! energy or its bounds. The difference between the recorded loss and these values is unexplained, whether it is positive or
//! negative. In addition, no energy may be gained.

mod aloft;
mod course;
mod laws;
mod least_squares;
mod moment;
mod motion;
mod on_cushion;
mod pressed;
mod uncertainty;

use crate::{
    physics::{Motion, SpatialState},
    simulation::{Event, EventKind},
    study::reference_engine::{Contact, Numbers},
    table::{BALLS, Table},
};

use super::{
    figures::{Figures, Limits},
    trace::{Piece, Trace},
};
use aloft::Assumptions;
use course::Course;
use laws::free_loss;
use moment::{Moment, Residual};
use motion::{closed_contacts, reference_balls};
use uncertainty::Uncertainty;

/// Balls and cushions are in contact if their gap is less than this share of the table's length: 1e-9 m on the shortest bundled
/// table.
const CLOSED: f64 = 1e-9 / 2.54;

/// The energy balance of one shot.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Account {
    /// Energy after the stroke, m²/s².
    pub start: f64,
    /// Energy lost in the whole shot beyond the laws, m²/s²; negative if too little is lost.
    pub unexplained: f64,
}

/// Relative uncertainty of an event time: four roundings of its sum with the start of a course.
const TIME_ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Maximum number of simultaneous impacts for which all partitions into joint and successive impacts are tried.
const MAX_JOINING: usize = 8;

struct Audit<'a> {
    table: &'a Table,
    trace: &'a Trace,
    numbers: &'a Numbers<f64>,
    courses: [Course<'a>; BALLS],
    account: Account,
    /// Gap below which a contact is closed, m.
    gap: f64,
    /// Greatest displacement of a ball onto the body that it hits, m.
    max_displacement: f64,
}

/// Returns the energy balance of a shot recorded on `table`.
pub fn account(table: &Table, trace: &Trace) -> Account {
    audit(table, trace, &mut Figures::default())
}

/// Audits a shot, and records the largest gain and the largest unexplained loss of its parts, and the unexplained loss of the whole.
pub(super) fn audit(table: &Table, trace: &Trace, figures: &mut Figures) -> Account {
    let courses = std::array::from_fn(|ball| Course::new(table, trace, ball));
    let start = courses.iter().map(|course: &Course| course.energy).sum();
    let account = Account { start, ..Account::default() };
    let max_displacement = Limits::STRICT.on(table).distance;
    let numbers = &Numbers::of(table);
    let mut audit = Audit { table, trace, numbers, courses, account, gap: CLOSED * table.length, max_displacement };
    let mut events = trace.events.as_slice();
    loop {
        let now = audit.courses.iter().map(Course::changes).fold(f64::INFINITY, f64::min);
        if now == f64::INFINITY || now >= trace.kept_until {
            break;
        }
        let reported;
        (reported, events) = events.split_at(events.partition_point(|event| event.time <= now));
        audit.moment(now, reported, figures);
        audit.pieces(now, figures);
    }
    // Relative to the tolerances, the whole is never worse than the worst of its parts.
    figures.unexplained_energy.record(audit.account.unexplained.abs(), trace.end.time);
    audit.account
}

impl Audit<'_> {
    /// Audits all changes at time `now`, s, group by group, and begins the next pieces of the changed balls.
    fn moment(&mut self, now: f64, reported: &[Event], figures: &mut Figures) {
        let changed: [bool; BALLS] = std::array::from_fn(|ball| self.courses[ball].changes() == now);
        let rested = self.courses.map(|course| course.resting().is_some());
        let flew = self.courses.map(|course| course.flies());
        let in_space = self.courses.map(|course| course.before);
        let before_energy = self.courses.map(|course| course.energy);
        let earlier = self.courses;
        let after_in_space: [SpatialState; BALLS] = std::array::from_fn(|ball| {
            if changed[ball] {
                self.courses[ball].begin(self.table, self.trace)
            } else {
                self.courses[ball].state(&self.trace.constants, now)
            }
        });
        let rests = self.courses.map(|course| course.resting().is_some());
        let flies = self.courses.map(|course| course.flies());
        let is_off = self.courses.map(|course| course.is_off(self.trace));
        let [before, after] = [&in_space, &after_in_space].map(|balls| balls.map(|ball| ball.horizontal_state()));
        let mut closed = closed_contacts(self.numbers, &reference_balls(&after), self.gap);
        let can_touch = std::array::from_fn(|ball| changed[ball] && !flies[ball] && !is_off[ball]);
        closed.retain(|contact| contact.is_among(can_touch));
        let impacts = reported.iter().filter_map(|event| Contact::of_event(event.kind)).collect();
        let (table, numbers) = (self.table, self.numbers);
        let moment = Moment { table, numbers, before, after, rested, rests, impacts, closed };
        let mut seen = [false; BALLS];
        for ball in 0..BALLS {
            if !changed[ball] || seen[ball] {
                continue;
            }
            let group = moment.group(ball, changed);
            let members = || (0..BALLS).filter(|&member| group[member]);
            members().for_each(|member| seen[member] = true);
            if reported.iter().any(|event| event.kind == EventKind::LeavesTable(ball)) {
                // The ball takes its energy along.
                continue;
            }
            let moved = || members().map(|member| before[member].position.distance(after[member].position));
            let mut uncertainty = Uncertainty {
                energy: members().map(|member| self.courses[member].largest).sum(),
                time: now,
                rests: members().any(|member| rested[member] || rests[member])
                    || moment.ends_a_chatter(group)
                    || moment.touches_without_impact(group),
                is_struck: !moment.impacts.is_empty() || members().any(|member| rests[member] && !rested[member]),
                impacts: moment.impacts.iter().filter(|contact| group[contact.balls().0]).count(),
                stops: moment.impacts.len() > 1 && members().any(|member| after[member].velocity == glam::DVec2::ZERO),
                moved: if moment.impacts.is_empty() {
                    0.0
                } else {
                    moved().fold(0.0, f64::max).min(self.max_displacement)
                },
            };
            let energy = |balls: &[SpatialState; BALLS]| -> f64 {
                members().map(|member| aloft::energy(self.table, &balls[member])).sum()
            };
            let lost = members().map(|member| before_energy[member]).sum::<f64>() - energy(&after_in_space);
            let flown = members().any(|member| flew[member] || flies[member]);
            let on_cloth = if flown { None } else { Some(moment.residual(group)) };
            let Residual { mut unexplained, bounces } = match on_cloth {
                _ if moment.follows_an_unknown_law(group) => Residual { unexplained: lost.min(0.0), bounces: None },
                Some(residual) if residual.unexplained.abs() <= uncertainty.at_a_change(self.table) => residual,
                _ => {
                    let states = [&in_space, &after_in_space];
                    let impacts = self.impacts((now, reported), &earlier, states, [flew, group, rested, rests], lost);
                    let residual = Residual { unexplained: lost - impacts.lost, bounces: impacts.bounces };
                    match on_cloth {
                        Some(other) if other.unexplained.abs() <= residual.unexplained.abs() => other,
                        _ => {
                            uncertainty.moved = uncertainty.moved.max(impacts.moved.min(self.max_displacement));
                            residual
                        }
                    }
                }
            };
            let mut returned = 0.0;
            for member in members().filter(|&member| rested[member] && !rests[member]) {
                if let Some((since, bounces)) = self.courses[member].bounces.take() {
                    let left = bounces.energy * (1.0 - (now - since) / bounces.duration).max(0.0).powi(2);
                    // At least the energy of the bounces that are not over by now comes back, at most all of it.
                    unexplained = (unexplained + left).max((unexplained + bounces.energy).min(0.0));
                    returned += bounces.energy;
                }
            }
            if let Some(bounces) = bounces {
                self.courses[bounces.ball].bounces = Some((now, bounces));
            }
            self.note(figures, lost + returned, unexplained, &uncertainty, uncertainty.at_a_change(self.table));
        }
    }

    /// Computes the reported impacts of a group one after another, by the laws of the reference engine, in the variant that is
    /// closest to `lost`. The variants cover everything that rounding may decide: the remaining height of a ball, which follows
    /// from the engine's result; the side of a landing on which an impact is; which contacts no longer bounce; and whether any
    /// contact may rest.
    fn impacts(
        &self,
        (now, reported): (f64, &[Event]),
        earlier: &[Course; BALLS],
        [before, after]: [&[SpatialState; BALLS]; 2],
        [flew, group, rested, rests]: [[bool; BALLS]; 4],
        lost: f64,
    ) -> aloft::Impacts {
        let here = |ball: usize, state: &SpatialState| SpatialState { position: after[ball].position, ..*state };
        let energy = |balls: &[SpatialState; BALLS]| -> f64 {
            (0..BALLS).filter(|&ball| group[ball]).map(|ball| aloft::energy(self.table, &balls[ball])).sum()
        };
        let at_impact: [SpatialState; BALLS] = std::array::from_fn(|ball| here(ball, &before[ball]));
        let explained = |balls: &[SpatialState; BALLS], rests: [bool; BALLS], assumed| {
            let mut impacts =
                aloft::impacts(self.table, [balls, after], [flew, group, rested, rests], reported, assumed);
            impacts.lost += energy(&at_impact) - energy(balls);
            impacts
        };
        let mut nearest = explained(&at_impact, [false; BALLS], Assumptions::NOTHING);
        // Moving a ball onto the body that it hits rotates the normals of its other contacts.
        let moved = |ball: usize| before[ball].position.distance(after[ball].position) / (2.0 * self.table.radius);
        let turned = (0..BALLS).filter(|&ball| group[ball]).map(|ball| moved(ball) * before[ball].velocity.length());
        let none = self.trace.constants.tolerance.opening + turned.fold(0.0, f64::max);
        let is_impact = |event: &&Event| Contact::of_event(event.kind).is_some_and(|contact| group[contact.balls().0]);
        let impacts = reported.iter().filter(is_impact).count();
        let several = if impacts > MAX_JOINING { 0 } else { impacts };
        // The first impact joins no other.
        let ways = (0..1_u32 << several).step_by(2).flat_map(|apart| {
            let joins = !apart;
            [(false, 0.0), (true, 0.0), (false, none)].into_iter().flat_map(move |(grazes, none)| {
                [(false, false), (true, false), (false, true)].map(|(lies, is_micro)| Assumptions {
                    grazes,
                    none,
                    joins,
                    lies,
                    is_micro,
                })
            })
        });
        for by in [0.0, -TIME_ROUNDING * now, TIME_ROUNDING * now] {
            let balls = std::array::from_fn(|ball| here(ball, &earlier[ball].beside(&self.trace.constants, by)));
            for rests in [[false; BALLS], rests] {
                for assumed in ways.clone() {
                    let other = explained(&balls, rests, assumed);
                    if (lost - other.lost).abs() < (lost - nearest.lost).abs() {
                        nearest = other;
                    }
                }
            }
        }
        nearest
    }

    /// Audits the pieces that begin at `now`, s: individually if a ball moves freely, together for balls that rest against
    /// something or each other.
    fn pieces(&mut self, now: f64, figures: &mut Figures) {
        let mut resting: [Option<&Piece>; BALLS] = [None; BALLS];
        for (ball, place) in resting.iter_mut().enumerate() {
            let course = &self.courses[ball];
            let Some(piece) = course.piece().filter(|piece| piece.segment.start == now) else { continue };
            if course.resting().is_some() {
                *place = Some(piece);
                continue;
            }
            let lost = course.first_energy - course.energy;
            let lasts = piece.end - now;
            let dissipated = if let Some(hops) = piece.segment.hops() {
                let start = piece.segment.spatial_after(&self.trace.constants, 0.0);
                aloft::landings_loss(self.table, &start, hops.landings(lasts))
            } else {
                let state = piece.segment.state_after(&self.trace.constants, 0.0);
                free_loss(self.numbers, self.table, &state, piece.segment.motion, lasts)
            };
            let uncertainty = Uncertainty { energy: course.first_energy, time: piece.end, ..Uncertainty::default() };
            self.note(figures, lost, lost - dissipated, &uncertainty, uncertainty.on_the_way(self.table, dissipated));
        }
        while let Some(first) = resting.iter().flatten().next() {
            let until = first.end;
            let together = resting.map(|piece| piece.filter(|piece| piece.end == until));
            let members = || (0..BALLS).filter(|&ball| together[ball].is_some()).map(|ball| &self.courses[ball]);
            let lost: f64 = members().map(|course| course.first_energy - course.energy).sum();
            let energy = members().map(|course| course.largest).sum();
            let courses = together.map(|piece| piece.map(|piece| &piece.segment));
            let work = pressed::work(self.table, self.numbers, &self.trace.constants, &courses, (now, until), self.gap);
            let uncertainty = Uncertainty { energy, time: until, rests: true, ..Uncertainty::default() };
            let unexplained = lost - lost.max(work.least).min(work.most);
            self.note(figures, lost, unexplained, &uncertainty, uncertainty.on_the_way(self.table, work.least));
            resting
                .iter_mut()
                .filter(|piece| piece.is_some_and(|piece| piece.end == until))
                .for_each(|piece| *piece = None);
        }
    }

    fn note(&mut self, figures: &mut Figures, lost: f64, unexplained: f64, uncertainty: &Uncertainty, allowed: f64) {
        figures.gained.record(-lost, uncertainty.time);
        figures
            .energy
            .record(if lost < 0.0 { -lost / uncertainty.of_a_gain(self.table) } else { 0.0 }, uncertainty.time);
        figures.unexplained_energy.record(unexplained.abs(), uncertainty.time);
        // Without energy there is no rounding.
        figures.unexplained.record(unexplained.abs() / allowed.max(f64::MIN_POSITIVE), uncertainty.time);
        self.account.unexplained += unexplained;
    }
}

#[cfg(test)]
mod tests;
