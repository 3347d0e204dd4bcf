//! The trainer's part of a checkpoint: everything on which the next iteration depends, so that a resumed run equals an uninterrupted
//! one.

use std::sync::Arc;

use glam::DVec2;
use rand_xoshiro::Xoshiro256PlusPlus;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::{
    action::ACTIONS,
    agent::{Ddpg, Transition},
    context::Inputs,
    networks::Networks,
    observation::Observation,
    randomized_tables::{Context, RandomizedTables},
    trainer::{Task, Trainer},
};
use crate::{
    learning::{
        learner::note_of,
        nn::weights::{Reader, WeightsError, Writer},
        replay::ReplayBuffer,
    },
    table::{Rail, Table},
};

/// The JSON note of a snapshot, next to its arrays.
#[derive(Debug, Serialize, Deserialize)]
struct TrainerState {
    task: Task,
    table: Table,
    features: String,
    actions: String,
    shots: u64,
    updates: u64,
    rng: Xoshiro256PlusPlus,
    actor_steps: u32,
    critic_steps: u32,
    replay_next: usize,
    #[serde(default)]
    searched_next: usize,
}

/// Numbers per observation in a snapshot.
const OBSERVATION_NUMBERS: usize = 8;

/// Number that encodes a straight path, instead of a cushion, in a snapshot.
const STRAIGHT: f32 = -1.0;

/// Adds the arrays of the trainer's state to a file and returns the rest of the state as the note.
pub fn write(trainer: &Trainer, writer: &mut Writer) -> Result<Value, WeightsError> {
    let agent = &trainer.agent;
    for (name, networks) in [("online", &agent.online), ("target", &agent.target)] {
        writer.add_network(&format!("{name}.actor"), &networks.actor)?;
        writer.add_network(&format!("{name}.critic"), &networks.critic)?;
    }
    writer.add_optimiser("actor", &agent.actor_optimiser)?;
    writer.add_optimiser("critic", &agent.critic_optimiser)?;
    let inputs = trainer.task.hyperparameters.inputs();
    add_shots(writer, "replay", &trainer.replay, inputs);
    if trainer.task.hyperparameters.searched > 0 {
        add_shots(writer, "searched", &trainer.searched, inputs);
    }
    note_of(&TrainerState {
        task: trainer.task.clone(),
        table: Table::clone(&trainer.table),
        features: inputs.version(),
        actions: trainer.task.hyperparameters.actions.meaning().to_owned(),
        shots: trainer.shots,
        updates: trainer.updates,
        rng: trainer.rng.clone(),
        actor_steps: agent.actor_optimiser.steps(),
        critic_steps: agent.critic_optimiser.steps(),
        replay_next: trainer.replay.next(),
        searched_next: trainer.searched.next(),
    })
}

/// Restores the trainer that [`write()`] wrote, from the file's arrays and the note.
///
/// # Errors
/// Fails if they do not fit together or are from a version with other features or actions.
pub fn read(reader: &Reader<'_>, note: Value) -> Result<Trainer, WeightsError> {
    let note: TrainerState = serde_json::from_value(note).map_err(|_| WeightsError::Metadata)?;
    let hyper = &note.task.hyperparameters;
    hyper.validate()?;
    let inputs = hyper.inputs();
    if note.features != inputs.version() || note.actions != hyper.actions.meaning() {
        return Err(WeightsError::Metadata);
    }
    let (online, target) = (Networks::read(reader, "online.", hyper)?, Networks::read(reader, "target.", hyper)?);
    let [actor, critic] = hyper.adam();
    let agent = Ddpg {
        actor_optimiser: reader.optimiser("actor", &online.actor, actor, note.actor_steps)?,
        critic_optimiser: reader.optimiser("critic", &online.critic, critic, note.critic_steps)?,
        hyper: hyper.clone(),
        online,
        target,
    };
    let replay = ReplayBuffer::restore(hyper.buffer_size, transitions(reader, "replay", inputs)?, note.replay_next);
    let searched = if hyper.searched > 0 { transitions(reader, "searched", inputs)? } else { Vec::new() };
    let searched = ReplayBuffer::restore(hyper.buffer_size, searched, note.searched_next);
    let TrainerState { task, table, rng, shots, updates, .. } = note;
    let table = Arc::new(table);
    let tables = RandomizedTables::new(&table, inputs, task.plan.seed);
    Ok(Trainer { task, table, tables, agent, replay, searched, rng, shots, updates })
}

/// Returns the number that encodes a cushion, or a straight path, in a snapshot.
fn number_of(rail: Option<Rail>) -> f32 {
    rail.and_then(|rail| Rail::ALL.iter().position(|own| *own == rail)).map_or(STRAIGHT, |index| index as f32)
}

fn add_shots(writer: &mut Writer, name: &str, shots: &ReplayBuffer<Transition>, inputs: Inputs) {
    let shots = shots.stored();
    let views =
        shots.iter().flat_map(|Transition { observation: Observation { cue, first, second, mirror, .. }, .. }| {
            [cue.x, cue.y, first.x, first.y, second.x, second.y, mirror.x, mirror.y]
        });
    let actions: Vec<f32> = shots.iter().flat_map(|shot| shot.action).collect();
    let successes: Vec<f32> = shots.iter().map(|shot| shot.success).collect();
    writer.add_f64(format!("{name}.views"), &[shots.len(), OBSERVATION_NUMBERS], &views.collect::<Vec<_>>());
    writer.add(format!("{name}.actions"), &[shots.len(), ACTIONS], &actions);
    writer.add(format!("{name}.successes"), &[shots.len()], &successes);
    if inputs.rails_first {
        let rails: Vec<f32> = shots.iter().map(|shot| number_of(shot.observation.rail)).collect();
        writer.add(format!("{name}.rails"), &[shots.len()], &rails);
    }
    if inputs.context {
        let context: Vec<f32> =
            shots.iter().flat_map(|shot| [shot.context.table as f32, shot.context.errors]).collect();
        writer.add(format!("{name}.conditions"), &[shots.len(), 2], &context);
    }
}

fn transitions(reader: &Reader<'_>, name: &str, inputs: Inputs) -> Result<Vec<Transition>, WeightsError> {
    let [views, actions, successes, context, rails] =
        ["views", "actions", "successes", "conditions", "rails"].map(|what| format!("{name}.{what}"));
    let observations = reader.array_f64(&views)?;
    let ((_, actions), (_, successes)) = (reader.array(&actions)?, reader.array(&successes)?);
    let (observations, actions) = (observations.as_chunks::<OBSERVATION_NUMBERS>().0, actions.as_chunks::<ACTIONS>().0);
    // Without a context all shots have the same context.
    let context = if inputs.context { reader.array(&context)?.1 } else { vec![0.0; 2 * successes.len()] };
    let context = context.as_chunks::<2>().0;
    let rails = if inputs.rails_first { reader.array(&rails)?.1 } else { vec![STRAIGHT; successes.len()] };
    if [observations.len(), actions.len(), context.len(), rails.len()] != [successes.len(); 4] {
        let expected = format!("{} shots", successes.len());
        return Err(WeightsError::Array { name: views, expected });
    }
    let shots = observations.iter().zip(actions).zip(context).zip(rails).zip(successes);
    Ok(shots
        .map(|((((v, action), [table, errors]), rail), success)| {
            let pair = |index: usize| DVec2::new(v[index], v[index + 1]);
            let rail = Rail::ALL.into_iter().find(|own| number_of(Some(*own)) == rail);
            let observation = Observation { cue: pair(0), first: pair(2), second: pair(4), rail, mirror: pair(6) };
            let context = Context { table: *table as u32, errors: *errors };
            Transition { observation, context, action: *action, success }
        })
        .collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learning::{ddpg::trainer::tests::small_task, learner::Learner};

    fn bytes(trainer: &Trainer) -> Vec<u8> {
        let mut writer = Writer::default();
        let note = write(trainer, &mut writer).unwrap();
        writer.finish(&note).unwrap()
    }

    #[test]
    fn a_resumed_run_is_identical_to_an_uninterrupted_one() {
        let mut with_context = small_task();
        with_context.hyperparameters.context = true;
        with_context.hyperparameters.ranking = 0.5;
        with_context.hyperparameters.saturation_penalty = 0.01;
        with_context.hyperparameters.searched = 1;
        with_context.hyperparameters.imitation = 0.5;
        let mut by_rails = with_context.clone();
        by_rails.hyperparameters.rails_first = true;
        for task in [small_task(), with_context, by_rails] {
            let [mut whole, mut parts] = [0; 2].map(|_| Trainer::new(task.clone(), Table::default()).unwrap());
            for _ in 0..5 {
                whole.iterate().unwrap();
                parts.iterate().unwrap();
            }
            let bytes_of_parts = bytes(&parts);
            let reader = Reader::new(&bytes_of_parts).unwrap();
            let mut parts = read(&reader, reader.note().unwrap()).unwrap();
            for _ in 0..5 {
                assert_eq!(whole.iterate().unwrap(), parts.iterate().unwrap());
            }
            assert_eq!(bytes(&whole), bytes(&parts));
        }
    }

    #[test]
    fn wrong_notes_and_missing_arrays_are_refused() {
        let mut writer = Writer::default();
        let note = write(&Trainer::new(small_task(), Table::default()).unwrap(), &mut writer).unwrap();
        let empty = Writer::default().finish(&note).unwrap();
        let whole = writer.finish(&note).unwrap();
        let task: Vec<_> = note["task"].as_object().unwrap().keys().collect();
        assert_eq!(task, ["hyperparameters", "reward", "seed", "shots"], "the keys of all earlier checkpoints");
        assert!(read(&Reader::new(&empty).unwrap(), note.clone()).unwrap_err().to_string().contains("online.actor"));
        let reader = Reader::new(&whole).unwrap();
        let mut other = note;
        other["features"] = "raw-0".into();
        assert!(matches!(read(&reader, other), Err(WeightsError::Metadata)));
        assert!(matches!(read(&reader, Value::Null), Err(WeightsError::Metadata)));
    }

    #[test]
    fn ineffective_settings_of_earlier_versions_are_accepted() {
        let trainer = Trainer::new(small_task(), Table::default()).unwrap();
        let bytes = bytes(&trainer);
        let reader = Reader::new(&bytes).unwrap();
        for name in ["hindsight", "demonstrations"] {
            let with = |value: f64| {
                let mut old = reader.note::<Value>().unwrap();
                let settings = old["task"]["hyperparameters"].as_object_mut().unwrap();
                assert_eq!(settings.insert(name.to_owned(), value.into()), None, "it is no longer written");
                read(&reader, old)
            };
            assert_eq!(with(0.0).unwrap().task, trainer.task);
            assert!(with(0.5).unwrap_err().to_string().contains(&format!("{name} = 0.5")));
        }
    }
}
