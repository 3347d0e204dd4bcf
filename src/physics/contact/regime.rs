//! Which contacts push and which frictions hold, and whether that agrees with every law.

use glam::DVec2;

use super::{
    MAX_TOUCHES,
    problem::{Accelerations, Limit, MAX_GRIPS, Problem},
};

/// Forces per mass and accelerations below this are none, m/s²: rounding of sums of a few g is 1e-14.
pub const NEGLIGIBLE: f64 = 1e-12;

/// What begins to slip more slowly than this holds, m/s²: in a second it would come to 1e-9 m/s.
const DEPARTING: f64 = 1e-9;

/// The part that every contact and grip takes at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Regime {
    /// Whether each contact pushes.
    pub pushing: [bool; MAX_TOUCHES],
    /// The direction in which each grip acts at its limit; `None` where it holds.
    pub limited: [Option<DVec2>; MAX_GRIPS],
    /// Whether each grip holds together with others more than is needed: its own share is then anything up to its limit.
    pub shared: [bool; MAX_GRIPS],
}

/// How hard every contact pushes and every grip holds, and what follows.
#[derive(Clone, Copy, Debug)]
pub struct Solution {
    /// Per mass, m/s².
    pub normal: [f64; MAX_TOUCHES],
    /// Per mass along each grip's directions, m/s².
    pub grip: [DVec2; MAX_GRIPS],
    pub accelerations: Accelerations,
}

/// A law that a solution breaks, and how the regime is to change.
#[derive(Clone, Copy, Debug)]
enum Change {
    Release(usize),
    Push(usize),
    Limit(usize, DVec2),
    Hold(usize),
}

impl Regime {
    /// All contacts push, all grips hold.
    pub const HOLDING: Self =
        Self { pushing: [true; MAX_TOUCHES], limited: [None; MAX_GRIPS], shared: [false; MAX_GRIPS] };

    /// Whether a grip acts at all: that of a contact needs the contact's push.
    pub fn grips(&self, limit: Limit) -> bool {
        match limit {
            Limit::Fixed(_) => true,
            Limit::Coulomb(_, contact) => self.pushing[contact],
        }
    }

    /// Changes what breaks its law most; tells whether anything did.
    pub fn mend(&mut self, problem: &Problem, solution: &Solution) -> bool {
        let mut worst = (NEGLIGIBLE, None);
        self.each_break(problem, solution, |size, change| {
            if size > worst.0 {
                worst = (size, Some(change));
            }
        });
        match worst.1 {
            None => return false,
            Some(Change::Release(contact)) => self.pushing[contact] = false,
            Some(Change::Push(contact)) => self.pushing[contact] = true,
            Some(Change::Limit(grip, direction)) => self.limited[grip] = Some(direction),
            Some(Change::Hold(grip)) => self.limited[grip] = None,
        }
        true
    }

    /// Lets grips that act at their limit without anything beginning to slip hold again. Returns how fast the others begin
    /// to slip, m/s².
    pub fn share(&mut self, problem: &Problem, solution: &Solution) -> f64 {
        let mut departure = 0.0_f64;
        for (index, grip) in problem.grips.iter().enumerate() {
            if self.limited[index].is_some() && self.grips(grip.limit) {
                let rate = grip.rate(&solution.accelerations).length();
                if rate < DEPARTING {
                    self.limited[index] = None;
                    self.shared[index] = true;
                } else {
                    departure = departure.max(rate);
                }
            }
        }
        departure
    }

    /// By how much all laws hold at least, m/s²; negative where one is broken.
    pub fn slack(&self, problem: &Problem, solution: &Solution) -> f64 {
        let mut slack = f64::INFINITY;
        self.each_break(problem, solution, |size, _| slack = slack.min(-size));
        slack
    }

    /// Calls `report` with the size of every possible break of a law, negative where the law holds.
    fn each_break(&self, problem: &Problem, solution: &Solution, mut report: impl FnMut(f64, Change)) {
        for (index, contact) in problem.contacts.iter().enumerate() {
            if self.pushing[index] {
                report(-solution.normal[index], Change::Release(index));
            } else {
                let opening = contact.normal.rate(&solution.accelerations) + contact.centripetal;
                report(-opening, Change::Push(index));
            }
        }
        for (index, grip) in problem.grips.iter().enumerate() {
            if !self.grips(grip.limit) || self.shared[index] {
                continue;
            }
            let Some(limit) = limit_of(grip.limit, solution) else { continue };
            let force = solution.grip[index];
            match self.limited[index] {
                None => report(force.length() - limit, Change::Limit(index, force.normalize_or_zero())),
                Some(direction) => {
                    let rate = grip.rate(&solution.accelerations);
                    report(rate.dot(direction), Change::Hold(index));
                    // The force at the limit is to oppose the slip that begins: one projected step towards it. Without
                    // other contacts, which is the common case, the first step hits.
                    let own = grip.directions[0].response(&grip.directions[0], problem.twist);
                    let wanted = (limit * direction - rate / own).normalize_or_zero();
                    report(limit * wanted.distance(direction), Change::Limit(index, wanted));
                }
            }
        }
    }
}

/// The largest force per mass of a grip, m/s², if it has one.
pub fn limit_of(limit: Limit, solution: &Solution) -> Option<f64> {
    match limit {
        Limit::Fixed(limit) => Some(limit),
        Limit::Coulomb(mu, contact) => mu.map(|mu| mu * solution.normal[contact]),
    }
}
