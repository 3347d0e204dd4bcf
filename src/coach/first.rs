//! Finds the first shot that makes the point: the policy's own, the thesis' variation of it (its 5.1), or a wider search.

use std::{collections::BTreeSet, time::Duration};

use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{
    Alternative, Kind, Recommendation, Source, Suggestion,
    candidates::{TIP_SHARE, random_stroke, variation},
    elevated::random_elevated_stroke,
    trial::{CONTACT_STEPS, Task, UNLIMITED_STEPS},
};
use crate::{
    game::{Rule, Tally},
    physics::CueInputs,
    statistics::SuccessRate,
    table::Layout,
};

/// Variations tried of each of the policy's best proposals.
const VARIATIONS: u32 = 64;

/// Number of the policy's best proposals that are varied.
pub const VARIED_PROPOSALS: usize = 4;

/// Steps of resting contacts after which a shot of the search is given up: there are always more. A tenth of a second
/// then suffices for 2.2 times as many shots on `thesis` as without a limit, and finds three-cushion shots on 86
/// instead of 79 % of 300 layouts.
const SEARCH_CONTACT_STEPS: u32 = 5;

/// One in this number of those shots is followed further: if balls touch from the start, all others may be given up.
const FULL_SIMULATION_INTERVAL: u64 = 50;

/// Usual strokes that are tried before any jump or massé: if that many made no point, hardly any usual stroke does.
const USUAL_BEFORE_ELEVATED: u64 = 4000;

/// From then on, one stroke in this number is a jump or a massé.
const ELEVATED_INTERVAL: u64 = 4;

/// Maximum number of alternatives listed.
pub const MAX_ALTERNATIVES: usize = 5;

/// Quality of a shot that makes no point: object balls hit, then cushions before the second, up to the number that the
/// rule requires.
type Merit = (u32, u32);

/// The result: shots that make the point, the policy's first, and the best attempt if there are none.
pub struct FirstShots {
    /// Shots that make the point, with their tallies.
    pub solutions: Vec<(Suggestion, Tally)>,
    /// The best of the shots that make no point.
    pub attempt: Suggestion,
}

/// One search for a shot.
struct FirstShotSearch<'a> {
    task: Task<'a>,
    best: Option<(Merit, Suggestion)>,
    solutions: Vec<(Suggestion, Tally)>,
}

impl FirstShots {
    /// Tries the proposals and the shots of a former answer, whatever the time. Then searches until a shot is found or
    /// time is up.
    pub fn find(task: Task, proposals: &[CueInputs], former: &[CueInputs], seed: u64) -> Self {
        let mut search = FirstShotSearch { task, best: None, solutions: Vec::new() };
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
        let (table, layout) = (task.table, task.layout);
        for &cue in proposals {
            search.play(cue, Source::Policy);
        }
        for &cue in former {
            search.play(cue, Source::Former);
        }
        'variations: for cue in proposals.iter().take(VARIED_PROPOSALS) {
            for _ in 0..VARIATIONS {
                if search.is_over() {
                    break 'variations;
                }
                search.play(variation(table, cue, &mut rng), Source::Variation);
            }
        }
        let mut tried = 0_u64;
        while !search.is_over() {
            tried += 1;
            let is_raised =
                task.seeks_jumps() && tried > USUAL_BEFORE_ELEVATED && tried.is_multiple_of(ELEVATED_INTERVAL);
            let elevated = if is_raised { random_elevated_stroke(table, layout, &mut rng) } else { None };
            let cue = elevated.unwrap_or_else(|| random_stroke(table, layout, &mut rng));
            search.play(cue, Source::Search);
        }
        // Without any time and without a policy, nothing was tried.
        let attempt = search.best.map(|(_, shot)| shot);
        let attempt = attempt.unwrap_or_else(|| Suggestion { cue: search.plain_stroke(), source: Source::Search });
        Self { solutions: search.solutions, attempt }
    }

    /// Returns the answer for a perfect player, or for a search without a result.
    pub fn answer(&self) -> Recommendation {
        let mut seen = BTreeSet::new();
        let shots = self.solutions.iter().map(|(shot, tally)| (*shot, Kind::of(tally, &shot.cue)));
        let mut shots = shots.filter(|(_, kind)| seen.insert(*kind));
        let certain = SuccessRate { trials: 1, successes: 1, rate: 1.0, low: 1.0, high: 1.0 };
        let first = shots.next();
        let shot = first.map_or(self.attempt, |(shot, _)| shot);
        Recommendation {
            cue: shot.cue,
            solved: first.is_some(),
            source: shot.source,
            kind: first.map(|(_, kind)| kind),
            make_probability: first.map(|_| certain),
            judged_from: 0,
            effort_penalty: 0.0,
            risk: None,
            next_probability: None,
            alternatives: shots
                .take(MAX_ALTERNATIVES)
                .map(|(shot, kind)| Alternative {
                    cue: shot.cue,
                    source: shot.source,
                    kind,
                    make_probability: Some(certain),
                    judged_from: 0,
                    effort_penalty: 0.0,
                    next_probability: None,
                })
                .collect(),
            simulations: 0,
            elapsed: Duration::ZERO,
        }
    }
}

impl FirstShotSearch<'_> {
    /// Returns a plain stroke at the first ball. If the cue has no room for it, the nearest direction with the lowest tip
    /// position that has room.
    fn plain_stroke(&self) -> CueInputs {
        let Layout { balls: [cue_ball, first, _] } = self.task.layout;
        let plain = CueInputs { a: 0.0, b: 0.0, theta: 0.0, phi: (first - cue_ball).to_angle(), speed: 2.0 };
        let highest = TIP_SHARE * self.task.table.miscue_limit.sqrt();
        let turns = (0..=180).flat_map(|degrees| [degrees, -degrees]).map(|degrees| f64::from(degrees).to_radians());
        let others = turns.flat_map(|turn| {
            [0.0, 0.5, 1.0].map(|share| CueInputs { b: share * highest, phi: plain.phi + turn, ..plain })
        });
        others.into_iter().find_map(|cue| self.task.playable(&cue)).unwrap_or(plain)
    }

    /// Whether a shot has been found, or time is up.
    fn is_over(&self) -> bool {
        !self.solutions.is_empty() || self.task.clock.used_share() >= 1.0
    }

    fn play(&mut self, cue: CueInputs, source: Source) {
        self.task.clock.count(1);
        let Some(cue) = self.task.playable(&cue) else { return };
        let max_contact_steps = match source {
            Source::Policy | Source::Former => UNLIMITED_STEPS,
            _ if self.task.clock.simulations().is_multiple_of(FULL_SIMULATION_INTERVAL) => CONTACT_STEPS,
            _ => SEARCH_CONTACT_STEPS,
        };
        // A shot that took too long still counts as an attempt.
        let tally = Task { max_contact_steps, ..self.task }.play(&cue).unwrap_or_default();
        let suggestion = Suggestion { cue, source };
        if self.task.is_solution(&cue, &tally) {
            self.solutions.push((suggestion, tally));
        } else if !self.task.point().is_made(&tally) && self.task.first.allows(&tally) {
            let merit = merit(&tally, self.task.rule);
            if self.best.is_none_or(|(best, _)| merit > best) && self.task.allows(&cue) {
                self.best = Some((merit, suggestion));
            }
        }
    }
}

fn merit(tally: &Tally, rule: Rule) -> Merit {
    let met = tally.hit.iter().map(|&hit| u32::from(hit)).sum();
    let cushions = if tally.has_hit_both() { tally.cushions_before_second } else { tally.cushions };
    (met, cushions.min(rule.cushions()))
}
