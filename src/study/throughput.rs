//! Benchmark of this machine: shots, recommendations, network decisions and network updates per second.

use std::{
    f64::consts::PI,
    sync::Arc,
    time::{Duration, Instant},
};

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use serde::Serialize;

use super::clock::timed;
use crate::{
    coach::{Coach, Request},
    game::Reward,
    learning::{
        ddpg::{
            action::Action,
            agent::{Ddpg, ShotBatch},
            hyperparameters::Hyperparameters,
            networks::Networks,
            observation::Observation,
            observation_batch::ObservationBatch,
        },
        nn::{adam::AdamConfig, mlp::Operations},
        thesis::{
            actor_critic::{ActorCritic, ActorLoss, Rates, sizes},
            replay::Batch,
        },
    },
    physics::CueInputs,
    platform::{parallel, thread_count},
    simulation::Recording,
    table::{Layout, PRESETS, Table},
};

/// Number of shots or layouts drawn beforehand; the benchmark cycles through them.
const SAMPLES: usize = 4096;

/// Seed of all random draws: every run measures the same work.
const SEED: u64 = 7;

/// One benchmark result.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Figure {
    /// The counted operation.
    #[serde(rename = "what")]
    pub operation: &'static str,
    /// Layers, batch size and operations, for network updates.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sizes: Option<String>,
    /// The table.
    pub table: String,
    /// Number of threads used.
    pub threads: usize,
    /// Operations per second.
    pub per_second: f64,
}

/// The machine that ran the benchmark.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Machine {
    /// Name of the processor, or its architecture if the name is not available.
    pub cpu: String,
    /// Number of hardware threads.
    pub threads: usize,
    /// Operating system.
    pub os: &'static str,
}

impl Machine {
    /// Returns this machine.
    pub fn this() -> Self {
        let listed = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
        let name = listed.lines().filter_map(|line| line.split_once(':')).find(|(key, _)| key.trim() == "model name");
        Self {
            cpu: name.map_or_else(|| std::env::consts::ARCH.to_owned(), |(_, name)| name.trim().to_owned()),
            threads: thread_count(),
            os: std::env::consts::OS,
        }
    }
}

/// Runs all benchmarks, each for `time`, and reports each result as soon as it is known.
///
/// # Errors
/// Fails if the networks cannot be used.
pub fn measure(time: Duration, mut report: impl FnMut(&Figure)) -> candle_core::Result<Vec<Figure>> {
    let mut figures = Vec::new();
    let mut note = |operation, sizes: Option<String>, table: &Table, threads, per_second| {
        let figure = Figure { operation, sizes, table: table.name.clone(), threads, per_second };
        report(&figure);
        figures.push(figure);
    };
    let cores = thread_count();
    for table in PRESETS.iter().filter_map(|name| Table::preset(name).ok()) {
        let shots = shots(&table);
        let score = |(layout, cue): &(Layout, CueInputs)| Reward::R3.of(&table, layout, cue);
        note("scored shots", None, &table, 1, rate(time, &shots, score));
        note("scored shots", None, &table, cores, rate_on(cores, time, &shots, score));
        let record =
            |(layout, cue): &(Layout, CueInputs)| Recording::new(&table, layout, cue).map(|r| r.duration()).ok();
        note("recorded shots", None, &table, 1, rate(time, &shots, record));
    }
    let coach = Coach::new(Table::default());
    let layouts: Vec<Layout> = shots(coach.table()).into_iter().map(|(layout, _)| layout).collect();
    let request = Request::default();
    let advise = |layout: &Layout| coach.recommend(layout, &request).is_ok();
    note("recommendations", None, coach.table(), 1, rate(time, &layouts, advise));
    let decide = |layout: &Layout| coach.policy_shot(layout, request.rule, &request.skill);
    note("network decisions", None, coach.table(), 1, rate(time, &layouts, decide));
    for (operations, how) in OPERATIONS {
        for update in THESIS_UPDATES {
            let size = format!("{}: {how}", update.0);
            note("network updates", Some(size), coach.table(), 1, thesis_updates(time, update, operations)?);
        }
        let per_second = coach_updates(time, coach.table(), operations)?;
        note("network updates", Some(format!("the networks that coach: {how}")), coach.table(), 1, per_second);
    }
    Ok(figures)
}

/// Draws random layouts and centre-ball strokes in any direction with 0.5 to 6 m/s, as in training.
fn shots(table: &Table) -> Vec<(Layout, CueInputs)> {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(SEED);
    let mut shot = || {
        let layout = Layout::random(table, &mut rng);
        let (phi, speed) = (rng.random_range(-PI..PI), rng.random_range(0.5..6.0));
        (layout, CueInputs { a: 0.0, b: 0.0, theta: 10_f64.to_radians(), phi, speed })
    };
    (0..SAMPLES).map(|_| shot()).collect()
}

/// Returns how many `items` per second `work` processes.
fn rate<T, R>(time: Duration, items: &[T], work: impl Fn(&T) -> R) -> f64 {
    let start = Instant::now();
    let mut done = 0_u64;
    for item in items.iter().cycle() {
        std::hint::black_box(work(item));
        done += 1;
        // Reading the clock is cheap compared with any of this work.
        if start.elapsed() >= time {
            break;
        }
    }
    done as f64 / start.elapsed().as_secs_f64()
}

/// Returns the total rate of several threads, each of which starts at a different index of the list.
fn rate_on<T: Sync, R>(threads: usize, time: Duration, items: &[T], work: impl Fn(&T) -> R + Sync) -> f64 {
    let starts: Vec<usize> = (0..threads).map(|thread| thread * items.len() / threads).collect();
    parallel::map(threads, &starts, |start| rate(time, &items[*start..], &work)).into_iter().sum()
}

/// Implementations of the network passes, and their names in the results.
const OPERATIONS: [(Operations, &str); 2] =
    [(Operations::Fused, "a network as one operation"), (Operations::Plain, "candle's own layers")];

/// The networks of thesis Table 4 and of the example that it cites (its reference 20): hidden layers of actor and critic, batch
/// size, and whether the batch's transitions are non-terminal, so that the target networks are evaluated too.
type ThesisUpdate = (&'static str, [&'static [usize]; 2], usize, bool);
const THESIS_UPDATES: [ThesisUpdate; 3] = [
    ("actor 16-16-16, critic 32-32-32, batch 32", [&[16; 3], &[32; 3]], 32, true),
    ("the same, one shot an episode", [&[16; 3], &[32; 3]], 32, false),
    ("actor and critic 256-256, batch 256", [&[256; 2], &[256; 2]], 256, true),
];

/// Runs `update` repeatedly and returns the updates per second of the thread's CPU time (wall time on systems other than
/// Linux). All work stays on this one thread: candle's layers would otherwise move a part to other threads.
fn updates_a_second<T>(
    time: Duration,
    mut update: impl FnMut() -> candle_core::Result<T> + Send,
) -> candle_core::Result<f64> {
    parallel::on_one_thread(|| {
        let start = Instant::now();
        let mut done = 0_u64;
        let (worked, seconds) = timed(|| {
            while done == 0 || start.elapsed() < time {
                update()?;
                done += 1;
            }
            Ok(())
        });
        worked.map(|()| done as f64 / seconds)
    })
}

/// Measures updates of the thesis' actor, critic and their target networks on a fixed batch.
fn thesis_updates(
    time: Duration,
    (_, [actor, critic], rows, goes_on): ThesisUpdate,
    operations: Operations,
) -> candle_core::Result<f64> {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(SEED);
    // A small learning rate keeps the networks finite: training on one batch over and over cannot converge to anything useful.
    let rates = Rates { adam: AdamConfig { learning_rate: 1e-6, max_grad_norm: 1.0 }, polyak: 0.999 };
    let mut agent = ActorCritic::random(&sizes(actor, critic), rates, &mut rng)?.with_operations(operations);
    let batch = Batch::random(rows, goes_on, &mut rng)?;
    updates_a_second(time, || agent.update(&batch, &ActorLoss::POLICY_GRADIENT))
}

/// Measures updates of the coach's networks on a fixed batch, with the default settings except for the learning rates.
fn coach_updates(time: Duration, table: &Table, operations: Operations) -> candle_core::Result<f64> {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(SEED);
    let settings =
        Hyperparameters { critic_learning_rate: 1e-6, actor_learning_rate: 1e-6, ..Hyperparameters::default() };
    let (rows, space) = (settings.batch_size, settings.actions);
    let observations = (0..rows).map(|row| Observation::new(&Layout::random(table, &mut rng), row % 4)).collect();
    let observed = ObservationBatch::on(&Arc::new(table.clone()), space, observations)?;
    let actions: Vec<Action> = (0..rows).map(|_| std::array::from_fn(|_| rng.random_range(-1.0..1.0))).collect();
    let successes: Vec<f32> = (0..rows).map(|_| f32::from(u8::from(rng.random_bool(0.1)))).collect();
    let mut agent = Ddpg::starting_from(Networks::random(&settings, &mut rng)?.with_operations(operations), settings)?;
    let played = ShotBatch { observed, actions, successes };
    updates_a_second(time, || agent.update(&played, None, 1.0))
}
