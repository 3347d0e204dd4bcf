//! Rollouts: exploratory shots, ranked proposals without noise and strokes found by search; also the shots that calibrate a finished
//! run's critic.

use candle_core::Result;
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{
    action::Action,
    agent::Transition,
    expert::{Expert, SearchResult},
    hyperparameters::{Hyperparameters, RANKED, part},
    networks::Networks,
    observation::Observation,
    observation_batch::ObservationBatch,
    paths::playable,
    policy::calibration::{Calibration, Trial},
    randomized_tables::{Context, RandomizedTables},
    trainer::Trainer,
};
use crate::{platform, table::Layout};

/// Attempts at each choice of a player with errors in the calibration.
const CALIBRATION_ATTEMPTS: usize = 16;

/// Layouts per network pass in the calibration: their numbers stay in the processor's cache.
const LAYOUTS_PER_PASS: usize = 64;

/// Makes the layouts of the calibration independent of all other random numbers drawn from a run's seed.
const STREAM: u64 = 0x0070_6c61_7474;

/// A layout, and the context under which it is played.
pub(super) type ContextualLayout = (Layout, Context);

impl Trainer {
    /// Plays the shots of one iteration and returns their mean reward. Each shot has a fresh layout, except the ranked ones.
    pub(super) fn play(&mut self) -> Result<f64> {
        let Hyperparameters { shots_per_update, critic_chooses, .. } = self.task.hyperparameters;
        let ranked = self.task.hyperparameters.ranked_layouts();
        // A layout with ranked proposals takes `RANKED` shots; every other takes one.
        let count = ranked + (shots_per_update - ranked * RANKED);
        let layouts: Vec<ContextualLayout> = (0..count).map(|_| self.draw_layout()).collect();
        let (ranked, layouts) = layouts.split_at(ranked);
        let (chosen, any) = layouts.split_at(part(critic_chooses, layouts.len()));
        self.search()?;
        let total = self.play_ranked(ranked)? + self.play_near_best(chosen)? + self.play_near_random(any)?;
        self.shots += shots_per_update as u64;
        Ok(total / shots_per_update as f64)
    }

    /// Share of the shots that are uniformly random.
    pub(super) fn uniform_share(&self) -> f64 {
        let Hyperparameters { shots_per_update, exploration, .. } = &self.task.hyperparameters;
        exploration.uniform
            * (1.0 - (self.task.hyperparameters.ranked_layouts() * RANKED) as f64 / *shots_per_update as f64)
    }

    /// Draws a fresh layout and its context.
    fn draw_layout(&mut self) -> ContextualLayout {
        let context = self.tables.draw(self.task.hyperparameters.perfect, &mut self.rng);
        (Layout::random(self.tables.table(context), &mut self.rng), context)
    }

    /// Searches some layouts for the best strokes of a player with errors. All strokes of the result enter the replay buffer; the best
    /// also enter the buffer that the actor imitates.
    fn search(&mut self) -> Result<()> {
        let layouts: Vec<ContextualLayout> = (0..self.task.hyperparameters.searched)
            .map(|_| {
                let (layout, context) = self.draw_layout();
                (layout, Context { errors: RandomizedTables::errors(&mut self.rng), ..context })
            })
            .collect();
        let proposals = self.proposals_on(&self.agent.target, &layouts)?;
        let tasks: Vec<_> = layouts.into_iter().zip(proposals).map(|task| (task, self.rng.random())).collect();
        let (reward, inputs) = (self.task.plan.reward, self.task.hyperparameters.inputs());
        let (tables, networks) = (&self.tables, &self.agent.target);
        let found =
            platform::parallel::try_map(platform::thread_count(), &tasks, |(((layout, context), proposals), seed)| {
                let proposals: Vec<_> =
                    proposals.iter().map(|&(observation, action, _)| (observation, action)).collect();
                let expert = Expert { tables, reward, inputs, networks, layout, context: *context };
                expert.search(&proposals, &mut Xoshiro256PlusPlus::seed_from_u64(*seed))
            })?;
        for SearchResult { best, others } in found {
            for stroke in &best {
                self.searched.push(*stroke);
            }
            for stroke in best.into_iter().chain(others) {
                self.replay.push(stroke);
            }
        }
        Ok(())
    }

    /// Returns the networks' proposals on each of the layouts in all observations.
    pub(super) fn proposals_on(
        &self,
        networks: &Networks,
        layouts: &[ContextualLayout],
    ) -> Result<Vec<Vec<(Observation, Action, f32)>>> {
        if layouts.is_empty() {
            return Ok(Vec::new());
        }
        let inputs = self.task.hyperparameters.inputs();
        let observations = layouts.iter().flat_map(|(layout, context)| {
            let all = Observation::all(self.tables.table(*context), layout, inputs.rails_first).into_iter();
            all.map(|observation| self.tables.contextual(observation, *context))
        });
        let all = networks.proposals(inputs, observations.collect())?;
        Ok(all.chunks(all.len() / layouts.len()).map(<[_]>::to_vec).collect())
    }

    /// Plays the target networks' best proposals on every layout without noise. Returns the sum of the rewards.
    fn play_ranked(&mut self, layouts: &[ContextualLayout]) -> Result<f64> {
        let mut total = 0.0;
        for (layout, mut proposals) in layouts.iter().zip(self.proposals_on(&self.agent.target, layouts)?) {
            proposals.sort_by(|(.., a), (.., b)| b.total_cmp(a));
            for (observation, action, _) in proposals.into_iter().cycle().take(RANKED) {
                total += self.rollout(layout, observation, action);
            }
        }
        Ok(total)
    }

    /// Plays near the critic's favourite on every layout, where its errors matter most. Returns the sum of the rewards.
    fn play_near_best(&mut self, layouts: &[ContextualLayout]) -> Result<f64> {
        let mut total = 0.0;
        for (layout, proposals) in layouts.iter().zip(self.proposals_on(&self.agent.online, layouts)?) {
            if let Some((observation, choice, _)) = proposals.into_iter().max_by(|(.., a), (.., b)| a.total_cmp(b)) {
                total += self.explore(layout, observation, choice);
            }
        }
        Ok(total)
    }

    /// Plays near a random head's choice in a random observation of every layout. Returns the sum of the rewards.
    fn play_near_random(&mut self, layouts: &[ContextualLayout]) -> Result<f64> {
        if layouts.is_empty() {
            return Ok(0.0);
        }
        let observations = layouts.iter().map(|(layout, context)| {
            let (table, rails_first) = (self.tables.table(*context), self.task.hyperparameters.rails_first);
            self.tables.contextual(Observation::random(table, layout, rails_first, &mut self.rng), *context)
        });
        let observed = ObservationBatch::new(self.task.hyperparameters.inputs(), observations.collect())?;
        let actions = self.agent.online.actions(&observed)?;
        let heads = actions.len() / layouts.len();
        let mut total = 0.0;
        for (index, layout) in layouts.iter().enumerate() {
            let choice = actions[index * heads + self.rng.random_range(0..heads)];
            total += self.explore(layout, observed.observations[index].observation, choice);
        }
        Ok(total)
    }

    /// Plays and stores one shot with exploration noise around `choice`; returns its reward.
    fn explore(&mut self, layout: &ContextualLayout, observation: Observation, choice: Action) -> f64 {
        let hyper = &self.task.hyperparameters;
        let action = hyper.exploration.perturb(hyper.actions, choice, &mut self.rng);
        self.rollout(layout, observation, action)
    }

    /// Plays and stores one shot; returns its reward, the mean over the attempts.
    fn rollout(&mut self, (layout, context): &ContextualLayout, observation: Observation, action: Action) -> f64 {
        let (reward, context) = (self.task.plan.reward, *context);
        let attempts = if context.errors == 0.0 { 1 } else { self.task.hyperparameters.attempts };
        let attempt = |_| self.tables.attempt(reward, layout, (&observation, action), context, &mut self.rng);
        let earned = (0..attempts).map(attempt).sum::<f64>() / attempts as f64;
        let success = (earned / reward.max_value()) as f32;
        self.replay.push(Transition { observation, context, action, success });
        earned
    }

    /// Fits the calibration by playing the target networks' choice on fresh layouts, at least half of them on the run's own table, with
    /// errors drawn as in training. Returns `None` once `go_on` returns `false`.
    pub(super) fn calibration(&self, go_on: &mut dyn FnMut() -> bool) -> Result<Option<Calibration>> {
        let Hyperparameters { perfect, calibrated, .. } = self.task.hyperparameters;
        let reward = self.task.plan.reward;
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(self.task.plan.seed ^ STREAM);
        let layouts: Vec<ContextualLayout> = (0..calibrated)
            .map(|number| {
                let context = self.tables.draw(perfect, &mut rng);
                let context = if number % 2 == 0 { context.on_own_table() } else { context };
                (Layout::random(self.tables.table(context), &mut rng), context)
            })
            .collect();
        let mut trials = Vec::with_capacity(calibrated);
        for layouts in layouts.chunks(LAYOUTS_PER_PASS) {
            if !go_on() {
                return Ok(None);
            }
            for ((layout, context), mut proposals) in
                layouts.iter().zip(self.proposals_on(&self.agent.target, layouts)?)
            {
                let table = self.tables.table(*context);
                let has_room = |(observation, action, _): &(Observation, Action, f32)| {
                    playable(table, layout, observation, *action).is_ok()
                };
                proposals.sort_by(|(.., a), (.., b)| a.total_cmp(b));
                let Some((observation, action, logit)) = proposals.into_iter().rfind(has_room) else { continue };
                let attempts = if context.errors == 0.0 { 1 } else { CALIBRATION_ATTEMPTS };
                let attempt = |_| self.tables.attempt(reward, layout, (&observation, action), *context, &mut rng);
                trials.push(Trial {
                    logit: f64::from(logit),
                    errors: f64::from(context.errors),
                    attempts: attempts as f64,
                    successes: (0..attempts).map(attempt).sum::<f64>() / reward.max_value(),
                });
            }
        }
        Ok(Some(Calibration::of(&trials)))
    }
}
