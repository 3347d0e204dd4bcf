//! Runs to watch, and reports about them.

use std::path::Path;

use carom::{
    learning::run::{
        Config,
        examples::{Example, Examples},
        follow::{Condition, Update},
        list::{Listing, Summary},
        metrics::Record,
        status::{Phase, RunStatus},
    },
    table::{Layout, Table},
    terminal::{TrainerFailure, TrainingReport},
};
use serde_json::json;

use super::player::{SHOT, cue};

pub const RUNS: &str = "/runs";
pub const RUN: &str = "20261120-091500-ddpg-match-r3-1";
pub const OTHER_RUN: &str = "20261119-180102-ddpg-match-r3-2";

pub fn summary(name: &str, shots: u64, best: Option<f64>, state: Condition) -> Summary {
    Summary {
        name: name.into(),
        agent: "ddpg".into(),
        reward: carom::game::Reward::R3,
        table: "match".into(),
        seed: 1,
        shots,
        planned_shots: 5_000_000,
        best_reward: best,
        last_reward: best.map(|best| best - 0.004),
        started: format!("2026-11-{}T09:15:00Z", &name[6..8]),
        changed: "2026-11-20T10:01:12Z".into(),
        state,
        folder: Path::new(RUNS).join(name),
    }
}

pub fn listing() -> Listing {
    let runs = vec![
        summary(OTHER_RUN, 5_000_000, Some(0.931), Condition::InPhase(Phase::Finished)),
        summary(RUN, 1_200_000, Some(0.874), Condition::InPhase(Phase::Training)),
        summary("20261118-three-cushions/seed-1", 40_000, None, Condition::InPhase(Phase::Stopped)),
    ];
    Listing { runs, ..Listing::default() }
}

pub fn config(reward: &str) -> Config {
    serde_json::from_value(json!({
        "agent": "ddpg", "reward": reward, "seed": 1, "shots": 5_000_000, "started": "2026-11-20T09:15:00Z",
        "version": "0.1.0", "source": null, "from": null,
        "schedule": { "log_every": 20_000, "evaluate_every": 100_000, "evaluation_layouts": 2000 },
        "settings": {}, "table": Table::default(),
    }))
    .unwrap()
}

pub fn status() -> RunStatus {
    RunStatus {
        phase: Phase::Training,
        shots: 1_200_000,
        logged: 1_200_000,
        updates: 93_750,
        seconds: 2772.0,
        shots_per_second: 433.0,
        updates_per_second: 34.0,
        exploration: 0.153,
        replay_fill: Some(0.6),
        held_out_reward: None,
        process: 1,
        warning: None,
        reason: None,
    }
}

pub fn record(n: u64) -> Record {
    let share = (n as f64 / 60.0).min(1.0);
    Record {
        shots: 20_000 * n,
        seconds: 46.2 * n as f64,
        shots_per_second: 433.0,
        updates: 1562 * n,
        learning_rate: 3e-4 * (1.0 - 0.5 * share),
        critic_loss: 0.6 * (-3.0 * share).exp() + 0.02 * (n as f64).sin().abs(),
        actor_loss: Some(-share),
        q_value: 0.7 * share,
        rollout_reward: 0.6 * share + 0.03 * (1.7 * n as f64).sin(),
        exploration: Some(0.3 - 0.147 * share),
        replay_fill: Some(share),
        held_out_reward: n.is_multiple_of(5).then(|| 0.874 * share.sqrt()),
        best_of_k: n.is_multiple_of(5).then(|| 0.96 * share.sqrt()),
    }
}

pub fn examples(after: u64) -> Examples {
    let table = Table::default();
    let shot = |reward| Example { layout: Layout::opening(&table), cue: cue(SHOT), reward };
    Examples { after, shots: vec![shot(0.0), shot(1.0), shot(1.0)] }
}

/// Returns the report that the trainer of [`RUN`] has failed.
pub fn trainer_failed(process: Option<u32>, sentence: &str) -> TrainingReport {
    let failure = TrainerFailure { process, sentence: sentence.to_owned() };
    TrainingReport::TrainerFailed(Path::new(RUNS).join(RUN), failure)
}

/// Returns a full update of a run in progress.
pub fn full_update() -> Update {
    Update {
        config: Some(Box::new(config("r3"))),
        records: (1..=60).map(record).collect(),
        status: Some(status()),
        condition: Some(Condition::InPhase(Phase::Training)),
        examples: Some(examples(1_200_000)),
        ..Update::default()
    }
}
