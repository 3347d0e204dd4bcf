//! Measurements with one shot per layout: the players, the record of each layout, and the report over all of them.

use std::{f64::consts::PI, io::Write, time::Instant};

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use serde::{Deserialize, Serialize};

use super::{
    drawn_tables::DrawnTables,
    robustness::{self, Reliability, Robustness},
    spec::{Shard, Spec},
};
use crate::{
    coach::{Coach, Request, Skill, layout_seed},
    commands::output::{json_line, plural},
    game::{Reward, Rule, scores},
    learning::{Policy, Proposal, evaluation::held_out_layouts, policy::any_scores, weights::WeightsError},
    physics::{CueInputs, has_room},
    printing,
    statistics::SuccessRate,
    table::{Layout, Table},
};

/// Speed of the cue above which a stroke counts as hard, m/s. In filmed matches the balls leave the cue at 3.5 m/s, after a stroke at 2.5
/// m/s.
const HARD_SPEED: f64 = 5.0;

/// The shot if the recommender refuses a layout. Held-out layouts are valid, so it refuses none.
const NO_SHOT: CueInputs = CueInputs { a: 0.0, b: 0.0, theta: 0.0, phi: 0.0, speed: 1e-3 };

/// The player that decides on a shot.
pub enum Player {
    /// Networks and search together.
    Recommender(Box<Coach>, Request),
    /// The networks alone.
    Policy(Box<Policy>),
    /// The first of this many random shots that makes the point.
    RandomSearch(u32),
}

impl Player {
    /// Returns the name of the player in reports.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Recommender(..) => "recommender",
            Self::Policy(_) => "policy",
            Self::RandomSearch(_) => "random search",
        }
    }

    /// Returns the checksum of its networks, if it has any.
    ///
    /// # Errors
    /// As [`Policy::checksum`].
    pub fn checksum(&self) -> Result<Option<String>, WeightsError> {
        let policy = match self {
            Self::Recommender(coach, request) => coach.policy(request.rule, &request.skill),
            Self::Policy(policy) => Some(&**policy),
            Self::RandomSearch(_) => None,
        };
        policy.map(Policy::checksum).transpose()
    }

    /// Returns the name of the bundled networks, if they play alone.
    pub fn networks(&self) -> Option<&'static str> {
        match self {
            Self::Policy(policy) => policy.bundled_name(),
            Self::Recommender(..) | Self::RandomSearch(_) => None,
        }
    }
}

/// A decision.
struct Decision {
    cue: CueInputs,
    simulations: Option<u64>,
    predicted: Option<f64>,
    /// Other proposals of the networks, if they play alone and the reward is just 0 or 1.
    others: Option<Vec<Proposal>>,
}

/// The record of one layout.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ShotRecord {
    /// Number of the layout, from 0.
    pub layout: u32,
    /// The reward of the shot without errors.
    pub earned: f64,
    /// Speed of the stroke, m/s.
    pub speed: f64,
    /// Time of the decision, s.
    pub seconds: f64,
    /// For players that search.
    pub simulations: Option<u64>,
    /// Make probability of the shot, as the player predicted it.
    #[serde(rename = "claimed")]
    pub predicted: Option<f64>,
    /// How often the player of the given skill makes the shot.
    pub chance: Option<f64>,
    /// For networks that play alone: whether any of their proposals makes the point without errors.
    pub best_of_k: Option<bool>,
}

/// Lets `player` decide on every layout of the part, and plays the decisions.
pub fn measure(spec: &Spec, shard: Shard, player: &Player, rule: Rule, reward: Reward) -> Vec<ShotRecord> {
    let layouts = held_out_layouts(&spec.table, spec.layouts as usize, spec.seed);
    let mine = (0..).zip(&layouts).filter(|(index, _)| shard.contains(*index));
    let drawn = spec.drawn_tables.then(|| DrawnTables::around(&spec.table, spec.seed));
    mine.map(|(index, layout)| {
        let own = drawn.as_ref().map(|tables| tables.of(index));
        let table = own.as_ref().unwrap_or(&spec.table);
        let start = Instant::now();
        let decision = decide(spec, player, rule, reward, table, layout, index);
        let seconds = start.elapsed().as_secs_f64();
        let cue = decision.cue;
        let earned = reward.of_playable(table, layout, &cue, u32::MAX);
        ShotRecord {
            layout: index,
            earned,
            speed: cue.speed,
            seconds,
            simulations: decision.simulations,
            predicted: decision.predicted,
            best_of_k: decision.others.map(|others| any_scores(table, reward, layout, earned, &others)),
            chance: spec.skill.map(|skill| robustness::chance(spec, rule, table, (index, layout), skill, &cue)),
        }
    })
    .collect()
}

fn decide(
    spec: &Spec,
    player: &Player,
    rule: Rule,
    reward: Reward,
    table: &Table,
    layout: &Layout,
    index: u32,
) -> Decision {
    let shot = |cue| Decision { cue, simulations: None, predicted: None, others: None };
    match player {
        Player::Recommender(coach, request) => {
            // Each layout has its own search and its own judging errors, so that the predictions are independent.
            let request = Request { seed: layout_seed(spec.seed, index), ..request.clone() };
            coach.recommend(layout, &request).map_or(shot(NO_SHOT), |advice| Decision {
                simulations: Some(advice.simulations),
                predicted: advice.make_probability.map(|chance| chance.rate),
                ..shot(advice.cue)
            })
        }
        Player::Policy(policy) => {
            let skill = spec.skill.unwrap_or(Skill::PERFECT);
            let mut proposals = policy.proposals(table, layout, &skill);
            let Proposal { cue, success } = proposals.remove(0);
            // A prediction for another reward, or for a skill that is not an input of the networks, is not the measured probability.
            let is_of_this = policy.origin().reward == reward && (skill.is_perfect() || policy.is_valid_for(&skill));
            let others = spec.is_yes_or_no.then_some(proposals);
            Decision { predicted: is_of_this.then_some(success), others, ..shot(cue) }
        }
        Player::RandomSearch(shots) => {
            let mut rng = Xoshiro256PlusPlus::seed_from_u64(layout_seed(spec.seed, index));
            shot(random_search(table, layout, rule, *shots, &mut rng))
        }
    }
}

/// Returns the first of `shots` shots with random direction and speed that makes the point and for which the cue has room; the last one if
/// there is none.
fn random_search(table: &Table, layout: &Layout, rule: Rule, shots: u32, rng: &mut Xoshiro256PlusPlus) -> CueInputs {
    let mut cue = NO_SHOT;
    for _ in 0..shots {
        let (phi, speed) = (rng.random_range(-PI..PI), rng.random_range(0.5..6.0));
        cue = CueInputs { a: 0.0, b: 0.0, theta: 10_f64.to_radians(), phi, speed };
        if has_room(table, layout, &cue) && scores(rule, table, layout, &cue) {
            break;
        }
    }
    cue
}

/// The report.
#[derive(Debug, Serialize)]
struct EvaluationReport<'a> {
    player: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    policy: Option<&'a str>,
    /// For bundled networks that play alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    networks: Option<&'a str>,
    table: String,
    /// Name of the reward or the rule.
    measure: &'a str,
    seed: u64,
    mean_reward: f64,
    /// For rewards that are 0 or 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    success: Option<SuccessRate>,
    /// For networks that play alone: the share of layouts on which any of their proposals makes the point without errors.
    #[serde(skip_serializing_if = "Option::is_none")]
    best_of_k: Option<f64>,
    /// Decisions per second; the time to judge the shots is not included.
    layouts_per_second: f64,
    slowest_ms: f64,
    /// Share of strokes that are harder than [`HARD_SPEED`].
    hard_share: f64,
    /// For players that search.
    #[serde(skip_serializing_if = "Option::is_none")]
    simulations_per_layout: Option<f64>,
    /// Predictions of the networks, if no skill is given.
    #[serde(flatten)]
    reliability: Option<Reliability>,
    /// How often the player of the given skill makes the shots.
    #[serde(skip_serializing_if = "Option::is_none")]
    robustness: Option<Robustness>,
}

/// Prints the report over all layouts.
pub fn print(spec: &Spec, records: &[ShotRecord], json: bool) -> std::io::Result<()> {
    let report = report(spec, records);
    if json { json_line(&report) } else { print_text(&mut printing::stdout(), &report, records.len()) }
}

fn report<'a>(spec: &'a Spec, records: &[ShotRecord]) -> EvaluationReport<'a> {
    let count = records.len();
    let mean = |of: &dyn Fn(&ShotRecord) -> f64| records.iter().map(of).sum::<f64>() / count as f64;
    let seconds: f64 = records.iter().map(|record| record.seconds).sum();
    let chances: Option<Vec<f64>> = records.iter().map(|record| record.chance).collect();
    let best_of_k: Option<Vec<bool>> = records.iter().map(|record| record.best_of_k).collect();
    let is_searching = records.iter().any(|record| record.simulations.is_some());
    let has_predicted = is_searching || records.iter().any(|record| record.predicted.is_some());
    let predicted: Vec<_> = records.iter().map(|record| record.predicted).collect();
    let earned: Vec<_> = records.iter().map(|record| record.earned).collect();
    // Predictions are compared with the player's attempts, or otherwise with the shot itself if the reward is 0 or 1.
    let compares_shots = spec.player == "policy" && spec.skill.is_none() && spec.is_yes_or_no && has_predicted;
    let robustness = spec.skill.zip(chances).map(|(skill, chances)| {
        Robustness::new(skill, spec.doubt, &chances, has_predicted.then_some(predicted.as_slice()))
    });
    let successes = records.iter().filter(|record| record.earned >= 1.0).count();
    EvaluationReport {
        player: &spec.player,
        policy: spec.policy.as_deref(),
        networks: spec.networks.as_deref(),
        table: if spec.drawn_tables { format!("tables like {}", spec.table.name) } else { spec.table.name.clone() },
        measure: &spec.measure,
        seed: spec.seed,
        mean_reward: mean(&|record| record.earned),
        success: spec.is_yes_or_no.then(|| SuccessRate::new(successes, count)),
        best_of_k: best_of_k.map(|made| made.iter().filter(|made| **made).count() as f64 / count as f64),
        layouts_per_second: count as f64 / seconds.max(f64::MIN_POSITIVE),
        slowest_ms: 1e3 * records.iter().map(|record| record.seconds).fold(0.0, f64::max),
        hard_share: mean(&|record| f64::from(record.speed > HARD_SPEED)),
        simulations_per_layout: is_searching.then(|| mean(&|record| record.simulations.unwrap_or(0) as f64)),
        reliability: compares_shots.then(|| Reliability::new(&predicted, &earned)),
        robustness,
    }
}

fn print_text(out: &mut impl Write, report: &EvaluationReport<'_>, layouts: usize) -> std::io::Result<()> {
    let EvaluationReport { player, policy, networks, table, measure, .. } = report;
    let networks = networks.map_or_else(String::new, |networks| format!(" ({networks})"));
    let policy = policy.map_or_else(String::new, |policy| format!(" {policy}{networks}"));
    let layouts = plural(layouts, "layout");
    match report.success {
        Some(SuccessRate { rate, low, high, .. }) => writeln!(
            out,
            "{player}{policy} on \"{table}\": {measure} on {:.2} % of {layouts} (95 % interval {:.2} to {:.2} %)",
            100.0 * rate,
            100.0 * low,
            100.0 * high
        )?,
        None => {
            writeln!(out, "{player}{policy} on \"{table}\": mean {measure} {:.4} over {layouts}", report.mean_reward)?;
        }
    }
    if let Some(share) = report.best_of_k {
        writeln!(out, "best-of-k success {:.2} %: some proposal of the networks makes the point", 100.0 * share)?;
    }
    write!(out, "{:.0} layouts a second, the slowest took {:.2} ms", report.layouts_per_second, report.slowest_ms)?;
    match report.simulations_per_layout {
        Some(simulations) => writeln!(out, ", {simulations:.1} simulations a layout")?,
        None => writeln!(out)?,
    }
    writeln!(out, "{:.1} % of the strokes are harder than {HARD_SPEED} m/s", 100.0 * report.hard_share)?;
    report.reliability.as_ref().map_or(Ok(()), |reliability| writeln!(out, "{reliability}"))?;
    report.robustness.as_ref().map_or(Ok(()), |robustness| writeln!(out, "{robustness}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_report_counts_the_records() {
        let spec = Spec::of_random_search(4);
        let record = |layout, earned, speed| {
            let best_of_k = Some(speed < 6.0);
            ShotRecord { layout, earned, speed, seconds: 0.5, best_of_k, ..ShotRecord::default() }
        };
        let records = [record(0, 1.0, 2.0), record(1, 0.0, 6.0), record(2, 1.0, 5.5), record(3, 1.0, 1.0)];
        let report = report(&spec, &records);
        let success = report.success.unwrap();
        assert_eq!((report.mean_reward, success.successes, success.trials), (0.75, 3, 4));
        assert_eq!((report.hard_share, report.layouts_per_second, report.slowest_ms), (0.5, 2.0, 500.0));
        assert_eq!(report.best_of_k, Some(0.75));
        assert!(report.simulations_per_layout.is_none() && report.robustness.is_none());
    }
}
