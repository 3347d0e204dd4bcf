//! The agent with several actor heads, [`Trainer`], as a run drives it.

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
            AgentKind, Iteration, Learner, Progress, StartError, TrainingPlan, UpdateStats, settings_as_object,
            settings_from,
        },
        nn::weights::{Reader, WeightsError, Writer},
    },
    physics::CueInputs,
    player::Skill,
    table::{Layout, Rail, Table},
};

/// An actor with a lower learning rate stays as it is.
pub const STANDING_STILL: f64 = 1e-6;

/// Places of the networks among sizes.
const ACTOR: usize = 0;
const CRITIC: usize = 1;

/// The line in the list of agents.
pub const AGENT: AgentKind = AgentKind {
    name: "ddpg",
    title: "deep deterministic policy gradient with several actor heads",
    settings: |settings| hyperparameters(settings).map(|hyperparameters| settings_as_object(&hyperparameters)),
    start: |plan, table, settings| {
        Ok(Box::new(Trainer::new(Task { plan, hyperparameters: hyperparameters(settings)? }, table)?))
    },
    restore: |reader, note| Ok(Box::new(snapshot::read(reader, note)?)),
    not_inherited: &["new_actor"],
    must_match: &["actions", "closed_form"],
};

/// What a run is started with.
fn hyperparameters(settings: &Value) -> Result<Hyperparameters, StartError> {
    let hyperparameters: Hyperparameters = settings_from(settings, Hyperparameters::validate)?;
    if hyperparameters.searched > 0 && !hyperparameters.context {
        return Err(StartError::settings("searches are for players who err: use searched with context = true"));
    }
    let Hyperparameters { imitation, actor_learning_rate, .. } = hyperparameters;
    if imitation > 0.0 && actor_learning_rate < STANDING_STILL {
        let reason = format!(
            "an actor_learning_rate of {actor_learning_rate:e}, as --from may bring along, leaves nothing to imitation = {imitation}: \
             accepted is {STANDING_STILL:e} and more, or no imitation"
        );
        return Err(StartError::settings(reason));
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
            exploration: self.task.hyperparameters.exploration.uniform,
            replay_fill: Some(self.replay.fill()),
        }
    }

    /// Plays some shots, then learns from a batch of those that are remembered.
    fn iterate(&mut self) -> candle_core::Result<Iteration> {
        let lr_factor = self.lr_factor();
        let mean_reward = self.play()?;
        let hyper = &self.task.hyperparameters;
        let (batch, imitated) = (hyper.batch, if hyper.imitation > 0.0 { hyper.actor_batch } else { 0 });
        let played = self.replay.sample(batch, &mut self.rng);
        let searched = self.searched.sample(imitated, &mut self.rng);
        let (played, searched) =
            (self.batch(&played)?, if searched.is_empty() { None } else { Some(self.batch(&searched)?) });
        let UpdateStats { loss, value } = self.agent.update(&played, searched.as_ref(), lr_factor)?;
        self.updates += 1;
        // What the actor climbs has further terms.
        Ok(Iteration { mean_reward, q_value: value, critic_loss: loss, actor_loss: Some(-value) })
    }

    fn score(&self, layouts: &[Layout]) -> candle_core::Result<Score> {
        Ok(self.policy(0.0, "")?.score(&self.table, self.task.plan.reward, layouts))
    }

    fn shots_on(&self, layouts: &[Layout]) -> candle_core::Result<Vec<CueInputs>> {
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

    /// The networks that play, from a checkpoint or a policy, become both the learning and the averaged ones.
    fn load_weights(&mut self, weights: &Reader<'_>) -> Result<(), WeightsError> {
        let prefix = if weights.has("target.actor.0.weight") { "target." } else { "" };
        let hyper = self.agent.hyper.clone();
        let told = hyper.inputs();
        let network = |name: &str, which: usize| {
            let name = format!("{prefix}{name}");
            weights.network(&name, &hyper.sizes()[which]).or_else(|error| {
                // What it has learnt without being told so much holds, until it learns better.
                let less = [(told.context, false), (false, told.rails_first), (false, false)];
                let less = less.map(|(context, rails_first)| Hyperparameters { context, rails_first, ..hyper.clone() });
                let known = |less: &Hyperparameters| {
                    weights.network(&name, &less.sizes()[which]).ok().map(|network| (network, less.inputs()))
                };
                let Some((mut network, less)) = less.iter().find_map(known) else { return Err(error) };
                if told.context && !less.context {
                    network = network.with_more_inputs(STATE_FEATURES, CONTEXT_FEATURES)?;
                }
                if told.rails_first && !less.rails_first {
                    network = network.with_more_inputs(told.actor() - Rail::ALL.len(), Rail::ALL.len())?;
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
    fn weights_are_taken_from_checkpoints_and_policies() {
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
        // A policy has half the digits of a weight, a checkpoint has all.
        for (file, digits) in [(checkpoint.as_slice(), 0.0), (&policy, 5e-4)] {
            let mut task = small_task();
            task.plan.seed = 6;
            let mut pupil = Trainer::new(task, Table::default()).unwrap();
            assert_ne!(weights(&pupil), weights(&teacher));
            pupil.load_weights(&Reader::new(file).unwrap()).unwrap();
            let [own, given] = [&pupil, &teacher].map(|trainer| weights(trainer).concat());
            assert!(
                own.iter().zip(&given).all(|(own, given)| (own - given).abs() <= digits * given.abs() + digits * 1e-3)
            );
            assert_eq!(pupil.shots(), 0);
        }
    }

    #[test]
    fn with_a_context_an_agent_begins_with_what_was_learnt_without() {
        let table = Table::default();
        let old = Policy::bundled(&table, Rule::OneCushion).unwrap().unwrap();
        let file = Learner::policy(&old_trainer(&old), 0.5, "2026-11-22", &mut || true).unwrap().unwrap();
        let mut task = old_trainer(&old).task;
        task.hyperparameters.context = true;
        let mut pupil = taught(task, &file);
        let told = pupil.policy(0.0, "").unwrap();
        assert!(told.has_context() && !old.has_context());
        for layout in held_out_layouts(&table, 5, 1) {
            for skill in [Skill::PERFECT, Skill::CLUB] {
                let [old, told] = [&old, &told].map(|policy| policy.proposals(&table, &layout, &skill)[0]);
                assert!((old.cue.phi - told.cue.phi).abs() < 1e-4 && (old.success - told.success).abs() < 1e-4);
            }
        }
        // Asked to, it takes the critic alone.
        let mut task = pupil.task.clone();
        task.hyperparameters.new_actor = true;
        let fresh = taught(task.clone(), &file);
        let parameters = |network: &Mlp| network.parameters().to_vec1::<f32>().unwrap();
        let begun = Trainer::new(task, table.clone()).unwrap();
        assert_eq!(parameters(&fresh.agent.target.actor), parameters(&begun.agent.target.actor));
        assert_eq!(parameters(&fresh.agent.target.critic), parameters(&pupil.agent.target.critic));
        // Once it has learnt, it makes a difference who plays.
        for _ in 0..30 {
            pupil.iterate().unwrap();
        }
        let told = pupil.policy(0.0, "").unwrap();
        let layout = held_out_layouts(&table, 1, 1)[0];
        let [perfect, beginner] =
            [Skill::PERFECT, Skill::BEGINNER].map(|skill| told.proposals(&table, &layout, &skill));
        assert_ne!(perfect, beginner);
    }

    #[test]
    fn an_agent_that_sees_ways_by_cushions_begins_with_what_was_learnt_of_straight_ones() {
        let (table, skill) = (Table::default(), Skill::CLUB);
        let mut with_context = Policy::bundled_for(&table, Rule::StraightRail, true).unwrap().unwrap();
        // The runs below have not ended, and are not calibrated yet.
        with_context.origin.calibration = Calibration::default();
        let blind = Policy::bundled(&table, Rule::OneCushion).unwrap().unwrap();
        assert!(with_context.has_context() && !blind.has_context());
        for old in [with_context, blind] {
            let file = Learner::policy(&old_trainer(&old), 0.5, "2026-11-25", &mut || true).unwrap().unwrap();
            let mut task = old_trainer(&old).task;
            (task.hyperparameters.rails_first, task.hyperparameters.context) = (true, true);
            let seeing = taught(task, &file).policy(0.0, "").unwrap();
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
    fn what_a_finished_run_says_of_its_choice_is_what_it_makes_of_it() {
        let mut task = small_task();
        (task.plan.shots, task.hyperparameters.calibrated) = (16, 1_000);
        let mut trainer = Trainer::new(task, Table::default()).unwrap();
        trainer.iterate().unwrap();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("policy.safetensors");
        let policy = |go_on: bool| Learner::policy(&trainer, 0.0, "2026-11-26", &mut || go_on).unwrap();
        assert!(policy(false).is_none(), "calibration is broken off");
        std::fs::write(&path, policy(true).unwrap()).unwrap();
        let (calibrated, critic) = (Policy::load(&path).unwrap(), trainer.policy(0.0, "").unwrap());
        let layouts = held_out_layouts(&trainer.table, 500, 1);
        let [told, promised] = [&calibrated, &critic].map(|policy| {
            let best = |layout| policy.proposals(&trainer.table, layout, &Skill::PERFECT)[0].success;
            layouts.iter().map(best).sum::<f64>() / layouts.len() as f64
        });
        let made = trainer.score(&layouts).unwrap().mean_reward;
        // After one update the critic still says a half of everything.
        assert!((promised - made).abs() > 0.2 && (told - made).abs() < 0.05, "{promised} {told} {made}");
    }

    /// A trainer for `task` that begins with the weights in `file`.
    fn taught(task: Task, file: &[u8]) -> Trainer {
        let mut trainer = Trainer::new(task, Table::default()).unwrap();
        trainer.load_weights(&Reader::new(file).unwrap()).unwrap();
        trainer
    }

    /// A trainer that has the networks of `policy`.
    fn old_trainer(policy: &Policy) -> Trainer {
        let hyperparameters = policy.origin().hyperparameters.clone();
        let plan = TrainingPlan { reward: policy.origin().reward, seed: 1, shots: 1000 };
        let task = Task { plan, hyperparameters };
        let mut trainer = Trainer::new(task, Table::default()).unwrap();
        trainer.agent = Ddpg::starting_from(policy.networks.duplicate().unwrap(), trainer.agent.hyper.clone()).unwrap();
        trainer
    }
}
