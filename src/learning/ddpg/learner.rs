//! The implementation of [`Learner`] by [`Trainer`], the agent with several actor heads.

use serde_json::Value;

use super::{
    agent::Ddpg,
    context::CONTEXT_FEATURES,
    features::STATE_FEATURES,
    first_contact::RAIL_FEATURES,
    hyperparameters::Hyperparameters,
    networks::Networks,
    snapshot,
    trainer::{Task, Trainer},
};
use crate::{
    learning::{
        evaluation::Score,
        learner::{
            AgentKind, Iteration, Learner, Progress, StartError, TrainingPlan, UpdateStats, current_names,
            settings_as_object, settings_from,
        },
        nn::weights::{Reader, WeightsError, Writer},
    },
    physics::CueInputs,
    player::Skill,
    table::{Layout, Rail, Table},
};

/// Learning rate of the actor below which it practically does not learn.
pub const MIN_ACTOR_LEARNING_RATE: f64 = 1e-6;

/// Indices of the networks in [`Hyperparameters::sizes`].
const ACTOR: usize = 0;
const CRITIC: usize = 1;

/// The entry in the list of agents.
pub const AGENT: AgentKind = AgentKind {
    name: "ddpg",
    title: "deep deterministic policy gradient with several actor heads",
    settings: |settings| hyperparameters(settings).map(|hyperparameters| settings_as_object(&hyperparameters)),
    current_names: current_names::<Hyperparameters>,
    start: |plan, table, settings| {
        Ok(Box::new(Trainer::new(Task { plan, hyperparameters: hyperparameters(settings)? }, table)?))
    },
    restore: |reader, note| Ok(Box::new(snapshot::read(reader, note)?)),
    not_inherited: &["new_actor"],
    must_match: &["actions", "closed_form"],
};

/// Parses the settings with which a run starts.
fn hyperparameters(settings: &Value) -> Result<Hyperparameters, StartError> {
    let hyperparameters: Hyperparameters = settings_from(settings, Hyperparameters::validate)?;
    if hyperparameters.searched > 0 && !hyperparameters.context {
        let reason = "searches need players with errors: use searched with context = true";
        return Err(StartError::Settings(reason.to_owned()));
    }
    let Hyperparameters { imitation, actor_learning_rate, .. } = hyperparameters;
    if imitation > 0.0 && actor_learning_rate < MIN_ACTOR_LEARNING_RATE {
        let reason = format!(
            "imitation = {imitation} has no effect with an actor_learning_rate of {actor_learning_rate:e} (perhaps set by --from): \
             accepted is {MIN_ACTOR_LEARNING_RATE:e} and more, or imitation = 0"
        );
        return Err(StartError::Settings(reason));
    }
    Ok(hyperparameters)
}

impl Learner for Trainer {
    fn agent(&self) -> &'static str {
        AGENT.name
    }

    fn plan(&self) -> TrainingPlan {
        self.task.plan
    }

    fn table(&self) -> &Table {
        &self.table
    }

    fn settings(&self) -> Value {
        settings_as_object(&self.task.hyperparameters)
    }

    fn shots(&self) -> u64 {
        self.shots
    }

    fn progress(&self) -> Progress {
        Progress {
            updates: self.updates,
            learning_rate: self.lr_factor() * self.task.hyperparameters.critic_learning_rate,
            exploration: self.uniform_share(),
            replay_fill: Some(self.replay.fill_fraction()),
        }
    }

    /// Plays some shots, then makes an update with minibatches from the replay buffers.
    fn iterate(&mut self) -> candle_core::Result<Iteration> {
        let lr_factor = self.lr_factor();
        let mean_reward = self.play()?;
        let hyper = &self.task.hyperparameters;
        let (batch, imitation_batch) =
            (hyper.batch_size, if hyper.imitation > 0.0 { hyper.actor_batch_size } else { 0 });
        let played = self.replay.sample(batch, &mut self.rng);
        let searched = self.searched.sample(imitation_batch, &mut self.rng);
        let (played, searched) =
            (self.batch(&played)?, if searched.is_empty() { None } else { Some(self.batch(&searched)?) });
        let UpdateStats { loss, value } = self.agent.update(&played, searched.as_ref(), lr_factor)?;
        self.updates += 1;
        // The reported actor loss omits the further terms of the objective.
        Ok(Iteration { mean_reward, q_value: value, critic_loss: loss, actor_loss: Some(-value) })
    }

    fn score(&self, layouts: &[Layout]) -> candle_core::Result<Score> {
        Ok(self.policy(0.0, "")?.score(&self.table, self.task.plan.reward, layouts))
    }

    fn choose_shots(&self, layouts: &[Layout]) -> candle_core::Result<Vec<CueInputs>> {
        let policy = self.policy(0.0, "")?;
        Ok(layouts.iter().map(|layout| policy.propose(&self.table, layout, &Skill::PERFECT)).collect())
    }

    fn policy(
        &self,
        held_out_reward: f64,
        date: &str,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<Option<Vec<u8>>, WeightsError> {
        let mut policy = self.policy(held_out_reward, date)?;
        if self.is_finished() {
            let Some(calibration) = self.calibration(go_on)? else { return Ok(None) };
            policy.origin.calibration = calibration;
        }
        policy.to_bytes().map(Some)
    }

    fn save(&self, writer: &mut Writer) -> Result<Value, WeightsError> {
        snapshot::write(self, writer)
    }

    /// Loads the networks that play, from a checkpoint or a policy, as both online and target networks.
    fn load_weights(&mut self, weights: &Reader<'_>) -> Result<(), WeightsError> {
        let prefix = if weights.has("target.actor.0.weight") { "target." } else { "" };
        let hyper = self.agent.hyper.clone();
        let inputs = hyper.inputs();
        let network = |name: &str, which: usize| {
            let name = format!("{prefix}{name}");
            let read = |hyper: &Hyperparameters| weights.network(&name, &hyper.sizes()[which]);
            read(&hyper).or_else(|error| {
                // Weights with fewer inputs are loaded, too: the new inputs have no effect until the network learns to use them.
                let fewer = [(inputs.context, false), (false, inputs.rails_first), (false, false)];
                let fewer =
                    fewer.map(|(context, rails_first)| Hyperparameters { context, rails_first, ..hyper.clone() });
                let load = |fewer: &Hyperparameters| Some((read(fewer).ok()?, fewer.inputs()));
                let Some((mut network, loaded)) = fewer.iter().find_map(load) else { return Err(error) };
                if inputs.context && !loaded.context {
                    network = network.with_more_inputs(STATE_FEATURES, CONTEXT_FEATURES)?;
                }
                if inputs.rails_first && !loaded.rails_first {
                    network = network.with_more_inputs(inputs.actor() - Rail::ALL.len(), Rail::ALL.len())?;
                    let end = network.sizes()[0];
                    network = network.with_more_inputs(end, if which == CRITIC { RAIL_FEATURES } else { 0 })?;
                }
                Ok(network)
            })
        };
        let own = &self.agent.online;
        let actor = if self.agent.hyper.new_actor { own.actor.duplicate()? } else { network("actor", ACTOR)? };
        let critic = network("critic", CRITIC)?;
        self.agent = Ddpg::starting_from(Networks::new(&hyper, actor, critic)?, hyper)?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        game::Rule,
        learning::{
            Policy, Proposal, ddpg::policy::calibration::Calibration, ddpg::trainer::tests::small_task,
            evaluation::held_out_layouts, nn::mlp::Mlp,
        },
    };

    #[test]
    fn weights_load_from_checkpoints_and_policies() {
        let mut teacher = Trainer::new(small_task(), Table::default()).unwrap();
        teacher.iterate().unwrap();
        let mut writer = Writer::default();
        let note = teacher.save(&mut writer).unwrap();
        let checkpoint = writer.finish(&note).unwrap();
        let policy = Learner::policy(&teacher, 0.5, "2026-11-20", &mut || true).unwrap().unwrap();
        let weights = |trainer: &Trainer| {
            let Networks { actor, critic, .. } = &trainer.agent.target;
            [actor, critic].map(|network| network.parameters().to_vec1::<f32>().unwrap())
        };
        // A policy stores weights in half precision, a checkpoint in full precision.
        for (file, tolerance) in [(checkpoint.as_slice(), 0.0), (&policy, 5e-4)] {
            let mut task = small_task();
            task.plan.seed = 6;
            let mut pupil = Trainer::new(task, Table::default()).unwrap();
            assert_ne!(weights(&pupil), weights(&teacher));
            pupil.load_weights(&Reader::new(file).unwrap()).unwrap();
            let [own, given] = [&pupil, &teacher].map(|trainer| weights(trainer).concat());
            assert!(
                own.iter()
                    .zip(&given)
                    .all(|(own, given)| (own - given).abs() <= tolerance * given.abs() + tolerance * 1e-3)
            );
            assert_eq!(pupil.shots(), 0);
        }
    }

    #[test]
    fn context_agents_start_from_weights_without_context() {
        let table = Table::default();
        let old = Policy::bundled(&table, Rule::OneCushion).unwrap().unwrap();
        let file = Learner::policy(&old_trainer(&old), 0.5, "2026-11-22", &mut || true).unwrap().unwrap();
        let mut task = old_trainer(&old).task;
        task.hyperparameters.context = true;
        let mut pupil = pretrained(task, &file);
        let new = pupil.policy(0.0, "").unwrap();
        assert!(new.has_context() && !old.has_context());
        for layout in held_out_layouts(&table, 5, 1) {
            for skill in [Skill::PERFECT, Skill::CLUB] {
                let [old, new] = [&old, &new].map(|policy| policy.proposals(&table, &layout, &skill)[0]);
                assert!((old.cue.phi - new.cue.phi).abs() < 1e-4 && (old.success - new.success).abs() < 1e-4);
            }
        }
        // With `new_actor` it loads the critic alone.
        let mut task = pupil.task.clone();
        task.hyperparameters.new_actor = true;
        let fresh = pretrained(task.clone(), &file);
        let parameters = |network: &Mlp| network.parameters().to_vec1::<f32>().unwrap();
        let begun = Trainer::new(task, table.clone()).unwrap();
        assert_eq!(parameters(&fresh.agent.target.actor), parameters(&begun.agent.target.actor));
        assert_eq!(parameters(&fresh.agent.target.critic), parameters(&pupil.agent.target.critic));
        // After some updates the proposals depend on the player.
        for _ in 0..30 {
            pupil.iterate().unwrap();
        }
        let trained = pupil.policy(0.0, "").unwrap();
        let layout = held_out_layouts(&table, 1, 1)[0];
        let [perfect, beginner] =
            [Skill::PERFECT, Skill::BEGINNER].map(|skill| trained.proposals(&table, &layout, &skill));
        assert_ne!(perfect, beginner);
    }

    #[test]
    fn cushion_path_agents_start_from_weights_without_them() {
        let (table, skill) = (Table::default(), Skill::CLUB);
        let mut with_context = Policy::bundled_for(&table, Rule::StraightRail, true).unwrap().unwrap();
        // The runs below are not finished, so they are not calibrated.
        with_context.origin.calibration = Calibration::default();
        let blind = Policy::bundled(&table, Rule::OneCushion).unwrap().unwrap();
        assert!(with_context.has_context() && !blind.has_context());
        for old in [with_context, blind] {
            let file = Learner::policy(&old_trainer(&old), 0.5, "2026-11-25", &mut || true).unwrap().unwrap();
            let mut task = old_trainer(&old).task;
            (task.hyperparameters.rails_first, task.hyperparameters.context) = (true, true);
            let seeing = pretrained(task, &file).policy(0.0, "").unwrap();
            for layout in held_out_layouts(&table, 5, 1) {
                let [old, seeing] = [&old, &seeing].map(|policy| policy.proposals(&table, &layout, &skill));
                let best = old[0];
                let same = |other: &Proposal| {
                    (best.cue.phi - other.cue.phi).abs() < 1e-4 && (best.success - other.success).abs() < 1e-4
                };
                assert!(seeing.len() >= old.len() && seeing.iter().any(same), "{best:?}");
                for Proposal { cue, .. } in &seeing {
                    cue.validate().unwrap();
                    cue.validate_tip(table.miscue_limit).unwrap();
                }
            }
        }
    }

    #[test]
    fn a_finished_run_is_calibrated_to_its_actual_success() {
        let mut task = small_task();
        (task.plan.shots, task.hyperparameters.calibrated) = (16, 1_000);
        let mut trainer = Trainer::new(task, Table::default()).unwrap();
        trainer.iterate().unwrap();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("policy.safetensors");
        let policy = |go_on: bool| Learner::policy(&trainer, 0.0, "2026-11-26", &mut || go_on).unwrap();
        assert!(policy(false).is_none(), "calibration must stop when go_on returns false");
        std::fs::write(&path, policy(true).unwrap()).unwrap();
        let (calibrated, critic) = (Policy::load(&path).unwrap(), trainer.policy(0.0, "").unwrap());
        let layouts = held_out_layouts(&trainer.table, 500, 1);
        let [calibrated, uncalibrated] = [&calibrated, &critic].map(|policy| {
            let best = |layout| policy.proposals(&trainer.table, layout, &Skill::PERFECT)[0].success;
            layouts.iter().map(best).sum::<f64>() / layouts.len() as f64
        });
        let actual = trainer.score(&layouts).unwrap().mean_reward;
        // After one update the critic still predicts one half for everything.
        assert!(
            (uncalibrated - actual).abs() > 0.2 && (calibrated - actual).abs() < 0.05,
            "{uncalibrated} {calibrated} {actual}"
        );
    }

    /// Creates a trainer for `task` that starts with the weights in `file`.
    fn pretrained(task: Task, file: &[u8]) -> Trainer {
        let mut trainer = Trainer::new(task, Table::default()).unwrap();
        trainer.load_weights(&Reader::new(file).unwrap()).unwrap();
        trainer
    }

    /// Creates a trainer with the networks of `policy`.
    fn old_trainer(policy: &Policy) -> Trainer {
        let hyperparameters = policy.origin().hyperparameters.clone();
        let plan = TrainingPlan { reward: policy.origin().reward, seed: 1, shots: 1000 };
        let task = Task { plan, hyperparameters };
        let mut trainer = Trainer::new(task, Table::default()).unwrap();
        trainer.agent = Ddpg::starting_from(policy.networks.duplicate().unwrap(), trainer.agent.hyper.clone()).unwrap();
        trainer
    }
}
