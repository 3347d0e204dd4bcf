//! The hyperparameters of the agent, with the reason for every choice.

use serde::{Deserialize, Serialize};

use super::{
    action::{ActionSpace, SPEEDS},
    context::Inputs,
    exploration::Exploration,
};
use crate::learning::{
    nn::adam::AdamConfig,
    settings::{SettingError, check, check_batch, check_count, check_layers, check_positive, check_share},
};

/// Best proposals of a layout that are played so that the critic learns to rank them; it hardly ever ranks the others wrongly. (Six heads
/// make 24 proposals for straight paths.)
pub const RANKED: usize = 8;

/// Returns this share of a number, rounded.
pub(super) fn part(share: f64, of: usize) -> usize {
    ((of as f64 * share).round() as usize).min(of)
}

/// The hyperparameters. The bundled policies were trained with the defaults, except for the differences listed in the model card. A
/// serde `alias` is the name of a setting in earlier versions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[expect(clippy::struct_excessive_bools, reason = "each is an independent setting")]
pub struct Hyperparameters {
    /// The cue inputs that the agent chooses: the thesis' phi and V, or all five.
    pub actions: ActionSpace,
    /// Whether the networks have the table's constants and the player's errors as inputs, and train on random tables with random
    /// errors. The critic then predicts how often this player makes a stroke on this table.
    pub context: bool,
    /// Share of the shots by players without errors, used with `context`: a third, so that the same networks serve such players, too.
    pub perfect: f64,
    /// Whether the critic's inputs include the closed-form consequences of an action up to the first ball, and not only the action.
    pub closed_form: bool,
    /// Whether the observations include paths to the first ball by a cushion.
    pub rails_first: bool,
    /// Actions that the actor proposes for an observation. A single head averages between success windows and misses all of them.
    /// Several heads that start apart each climb into their own window, and the critic chooses among them.
    pub heads: usize,
    /// Ranges of the heads' cue speeds, m/s, assigned to the heads in turn and repeated from the first; if empty, every head may use 0.3
    /// to 6 m/s.
    /// Without ranges all heads move to the highest speed, because there a bad aim makes most points by luck.
    pub head_speeds: Vec<[f64; 2]>,
    /// Units of the actor's hidden layers.
    pub actor_layers: Vec<usize>,
    /// Units of the critic's hidden layers.
    pub critic_layers: Vec<usize>,
    /// Learning rate of the critic at the start; it falls to zero over the run along half a cosine.
    pub critic_learning_rate: f64,
    /// Learning rate of the actor at the start, with the same schedule: lower, so that the actor follows a critic that has settled.
    pub actor_learning_rate: f64,
    /// Largest norm of a gradient; longer ones are scaled down to it.
    #[serde(alias = "gradient_clip")]
    pub max_grad_norm: f64,
    /// Rate of the target networks' soft update: `target = tau * online + (1 - tau) * target`. The thesis' 0.001, and more in the first
    /// updates of a run.
    #[serde(alias = "target_rate")]
    pub tau: f64,
    /// Shots in the minibatch of a critic update.
    #[serde(alias = "batch")]
    pub batch_size: usize,
    /// Observations of the minibatch that update the actor; each costs one row of the critic per head.
    #[serde(alias = "actor_batch")]
    pub actor_batch_size: usize,
    /// New shots before every update.
    pub shots_per_update: usize,
    /// Share of the unranked shots (see `ranking`) that are played near the critic's favourite among all heads in all observations
    /// of a layout. The others are played near a random head's action in a random observation.
    pub critic_chooses: f64,
    /// Share of the shots that are the eight best proposals for a layout, played without noise, so that the critic learns to rank them.
    pub ranking: f64,
    /// Attempts over which the success of a stored shot is averaged if the player has errors: a single attempt contains little
    /// information about a stroke that succeeds one time in six.
    pub attempts: usize,
    /// Capacity of the replay buffer, in shots. A shot's outcome never changes, but old shots are about actions that the actor no longer
    /// proposes.
    #[serde(alias = "replay")]
    pub buffer_size: usize,
    /// Layouts before every update on which a search finds strokes that a player with errors makes often (expert iteration). Each takes
    /// about as long as an update and its shots (1.2 times on one core).
    pub searched: usize,
    /// Weight of behaviour cloning with a Q-filter (Nair et al. 2018): of the squared distance from a searched stroke to the nearest
    /// head's action, unless the critic predicts more success for that action. By gradient ascent from their starting points alone, heads
    /// reach few of the strokes that a search finds.
    pub imitation: f64,
    /// Weight of the logit, next to the probability, in the actor's objective: without it the slope vanishes where the critic is certain
    /// of a miss.
    pub logit_weight: f64,
    /// Weight of the mean squared excess of the actor's outputs beyond ±2, where the squashing is flat. An actor that has always struck
    /// at full speed could otherwise never learn that another player must not.
    pub saturation_penalty: f64,
    /// Whether a run that starts from other weights loads only the critic and starts with a new actor: an actor whose outputs lie where
    /// the squashing is flat can no longer learn.
    pub new_actor: bool,
    /// Layouts on which a finished run plays its own choice to calibrate its critic's probabilities; 0 for no calibration.
    pub calibrated: usize,
    /// Exploration noise around the actor's proposals.
    pub exploration: Exploration,
    /// A setting in files of earlier versions: accepted if it is 0, and no longer written.
    #[serde(skip_serializing)]
    pub hindsight: f64,
    /// Another setting in files of earlier versions, treated the same.
    #[serde(skip_serializing)]
    pub demonstrations: f64,
}

impl Default for Hyperparameters {
    fn default() -> Self {
        Self {
            actions: ActionSpace::Full,
            context: false,
            perfect: 0.35,
            closed_form: true,
            rails_first: false,
            heads: 6,
            head_speeds: Vec::new(),
            actor_layers: vec![256, 256, 256],
            critic_layers: vec![320, 320, 320],
            critic_learning_rate: 1.5e-3,
            actor_learning_rate: 4e-4,
            max_grad_norm: 1.0,
            tau: 1e-3,
            batch_size: 512,
            actor_batch_size: 96,
            shots_per_update: 192,
            critic_chooses: 0.3,
            ranking: 0.0,
            attempts: 1,
            buffer_size: 1 << 17,
            searched: 0,
            imitation: 0.0,
            logit_weight: 0.02,
            saturation_penalty: 0.0,
            new_actor: false,
            calibrated: 8192,
            exploration: Exploration::default(),
            hindsight: 0.0,
            demonstrations: 0.0,
        }
    }
}

impl Hyperparameters {
    pub const fn inputs(&self) -> Inputs {
        let Self { actions: space, context, closed_form, rails_first, .. } = *self;
        Inputs { space, context, closed_form, rails_first }
    }

    /// Returns the number of layouts before every update on which ranked proposals are played, without exploration.
    pub fn ranked_layouts(&self) -> usize {
        part(self.ranking, self.shots_per_update) / RANKED
    }

    /// Returns the layer sizes of the actor and of the critic, inputs first.
    pub fn sizes(&self) -> [Vec<usize>; 2] {
        // Saturates, because a file may contain any number of heads.
        let outputs = self.heads.saturating_mul(self.actions.actions());
        [
            [&[self.inputs().actor()], self.actor_layers.as_slice(), &[outputs]].concat(),
            [&[self.inputs().critic()], self.critic_layers.as_slice(), &[1]].concat(),
        ]
    }

    /// Returns the optimiser settings of the actor and of the critic at the start of a run.
    pub fn adam(&self) -> [AdamConfig; 2] {
        [self.actor_learning_rate, self.critic_learning_rate]
            .map(|learning_rate| AdamConfig { learning_rate, max_grad_norm: self.max_grad_norm })
    }

    pub fn validate(&self) -> Result<(), SettingError> {
        check_layers("actor_layers", &self.actor_layers)?;
        check_layers("critic_layers", &self.critic_layers)?;
        check("heads", self.heads as f64, (1..=256).contains(&self.heads), "1 to 256")?;
        for [low, high] in &self.head_speeds {
            let ([least, most], shown) = (SPEEDS, format_args!("[{low}, {high}]"));
            let accept = least <= *low && low < high && *high <= most;
            check("head_speeds", shown, accept, "[low, high] with 0.3 <= low < high <= 6 m/s")?;
        }
        check_batch("batch_size", self.batch_size)?;
        check_batch("actor_batch_size", self.actor_batch_size)?;
        check_batch("shots_per_update", self.shots_per_update)?;
        check_batch("attempts", self.attempts)?;
        check_count("buffer_size", self.buffer_size)?;
        check_positive("critic_learning_rate", self.critic_learning_rate)?;
        check_positive("actor_learning_rate", self.actor_learning_rate)?;
        check_positive("max_grad_norm", self.max_grad_norm)?;
        check("tau", self.tau, 0.0 < self.tau && self.tau <= 1.0, "more than 0, up to 1")?;
        check_share("critic_chooses", self.critic_chooses)?;
        check_share("perfect", self.perfect)?;
        check_share("ranking", self.ranking)?;
        let is_played = self.ranking == 0.0 || self.shots_per_update >= RANKED;
        check("ranking", self.ranking, is_played, "0 if shots_per_update is below 8")?;
        for (name, value) in [("hindsight", self.hindsight), ("demonstrations", self.demonstrations)] {
            check(name, value, value == 0.0, "0, as only the agent thesis-ddpg has this setting")?;
        }
        check("searched", self.searched as f64, self.searched <= 1 << 12, "0 to 4096")?;
        check("calibrated", self.calibrated as f64, self.calibrated <= 1 << 20, "0 to 1048576")?;
        check_share("imitation", self.imitation)?;
        check_share("logit_weight", self.logit_weight)?;
        check_share("saturation_penalty", self.saturation_penalty)?;
        check_share("exploration.uniform", self.exploration.uniform)?;
        let noise = &self.exploration.noise;
        check("exploration.noise", "[]", !noise.is_empty(), "a list of standard deviations, like [0.015, 0.05]")?;
        noise.iter().try_for_each(|scale| check_share("exploration.noise", f64::from(*scale)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nan_is_outside_every_range() {
        let good = Hyperparameters::default();
        for (hyper, named) in [
            (Hyperparameters { critic_learning_rate: f64::NAN, ..good.clone() }, "critic_learning_rate = NaN is"),
            (Hyperparameters { head_speeds: vec![[1.0, 2.0], [f64::NAN, 2.0]], ..good }, "head_speeds = [NaN, 2] is"),
        ] {
            assert!(hyper.validate().unwrap_err().to_string().starts_with(named));
        }
    }
}
