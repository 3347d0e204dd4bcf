//! What can be tuned in the agent, with the reason for every choice.

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

/// What can be tuned. The defaults trained the bundled policies, but for what the model card says.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[expect(clippy::struct_excessive_bools, reason = "each is a setting of its own")]
pub struct Hyperparameters {
    /// What the agent chooses: the thesis' phi and V, or all five cue inputs.
    pub actions: ActionSpace,
    /// Whether it is told the table's constants and the player's errors, and practises on drawn tables with drawn errors. Its
    /// critic then tells how often this player makes a stroke on this table.
    pub context: bool,
    /// Share of the shots by players without errors, where it is told who plays: a third, so that the same networks serve them too.
    pub perfect: f64,
    /// Whether the critic is told what follows from an action in closed form, up to the first ball; without it, only the action.
    pub closed_form: bool,
    /// Whether it also looks at ways to the first ball by a cushion.
    pub rails_first: bool,
    /// Actions that the actor proposes for an observation. One alone averages between success windows and misses all; several,
    /// started apart, each climb their own window, and the critic chooses.
    pub heads: usize,
    /// Between which cue speeds the strokes of the heads lie, m/s, one after the other and again from the first; empty: every
    /// head may use 0.3 to 6 m/s.
    /// Left to themselves all climb to where they strike with all force: there a bad aim makes most points by luck.
    pub head_speeds: Vec<[f64; 2]>,
    /// Units of the actor's hidden layers.
    pub actor_layers: Vec<usize>,
    /// Units of the critic's hidden layers.
    pub critic_layers: Vec<usize>,
    /// Adam's step for the critic at the start; it falls to nothing over the run along half a cosine.
    pub critic_learning_rate: f64,
    /// The same for the actor: slower, so that it follows a critic that has settled.
    pub actor_learning_rate: f64,
    /// Largest norm of a gradient.
    pub gradient_clip: f64,
    /// Part of the way that the target networks go at every update. The thesis' 0.001.
    pub target_rate: f64,
    /// Experiences in a critic update.
    pub batch: usize,
    /// Observations of the batch on which the actor is updated; each costs one row of the critic per head.
    pub actor_batch: usize,
    /// New shots before every update.
    pub shots_per_update: usize,
    /// Share of those that are not ranked (`ranking`) that are played near the critic's favourite among all heads in all observations
    /// of a layout; the others near any head's action in any observation.
    pub critic_chooses: f64,
    /// Share of shots that are the eight best proposals, played without noise, so that the critic learns to rank them.
    pub ranking: f64,
    /// Attempts of whose success a remembered shot is the mean, where the player errs: one attempt tells little of a stroke that is
    /// made one time in six.
    pub attempts: usize,
    /// Shots that are remembered. A shot's outcome never changes, but old shots are about actions that the actor has
    /// left behind.
    pub replay: usize,
    /// Layouts before every update on which a search finds strokes that a player who errs makes often (expert iteration). Each takes
    /// about as long as an update and its shots (1.2 times on one core).
    pub searched: usize,
    /// Weight of behaviour cloning with a Q-filter (Nair et al. 2018): of the squared distance from a searched stroke to the nearest
    /// head's, as long as the critic does not think the head's to be better. Heads that climb from where they began reach few of the
    /// strokes that a search finds.
    pub imitation: f64,
    /// Weight of the logit beside the probability in what the actor climbs: without it there is no slope where the
    /// critic is certain of a miss.
    pub logit_weight: f64,
    /// Weight of the mean square by which the actor's outputs lie beyond 2, where the squashing is flat: an actor that has always
    /// struck as hard as it could never learns that another player must not.
    pub saturation_penalty: f64,
    /// Whether a run that starts from other weights takes the critic alone, and its actor begins anew: one whose outputs lie where
    /// the squashing is flat can no longer be turned.
    pub new_actor: bool,
    /// Layouts on which a finished run plays its own choice, to calibrate what its critic says of it; none to take it at its word.
    pub calibrated: usize,
    /// How far the behaviour strays from the actor's proposals.
    pub exploration: Exploration,
    /// A setting of earlier versions that their files name: accepted where it is 0, and written no more.
    #[serde(skip_serializing)]
    pub hindsight: f64,
    /// Another one.
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
            gradient_clip: 1.0,
            target_rate: 1e-3,
            batch: 512,
            actor_batch: 96,
            shots_per_update: 192,
            critic_chooses: 0.3,
            ranking: 0.0,
            attempts: 1,
            replay: 1 << 17,
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

    /// Layer sizes of the actor and of the critic, inputs first.
    pub fn sizes(&self) -> [Vec<usize>; 2] {
        // A file may say anything.
        let outputs = self.heads.saturating_mul(self.actions.actions());
        [
            [&[self.inputs().actor()], self.actor_layers.as_slice(), &[outputs]].concat(),
            [&[self.inputs().critic()], self.critic_layers.as_slice(), &[1]].concat(),
        ]
    }

    /// The optimisers of the actor and of the critic at the start of a run.
    pub fn adam(&self) -> [AdamConfig; 2] {
        [self.actor_learning_rate, self.critic_learning_rate]
            .map(|learning_rate| AdamConfig { learning_rate, gradient_clip: self.gradient_clip })
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
        check_batch("batch", self.batch)?;
        check_batch("actor_batch", self.actor_batch)?;
        check_batch("shots_per_update", self.shots_per_update)?;
        check_batch("attempts", self.attempts)?;
        check_count("replay", self.replay)?;
        check_positive("critic_learning_rate", self.critic_learning_rate)?;
        check_positive("actor_learning_rate", self.actor_learning_rate)?;
        check_positive("gradient_clip", self.gradient_clip)?;
        check(
            "target_rate",
            self.target_rate,
            0.0 < self.target_rate && self.target_rate <= 1.0,
            "more than 0, up to 1",
        )?;
        check_share("critic_chooses", self.critic_chooses)?;
        check_share("perfect", self.perfect)?;
        check_share("ranking", self.ranking)?;
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
    fn what_is_no_number_is_outside_every_range() {
        let good = Hyperparameters::default();
        for (hyper, named) in [
            (Hyperparameters { critic_learning_rate: f64::NAN, ..good.clone() }, "critic_learning_rate = NaN is"),
            (Hyperparameters { head_speeds: vec![[1.0, 2.0], [f64::NAN, 2.0]], ..good }, "head_speeds = [NaN, 2] is"),
        ] {
            assert!(hyper.validate().unwrap_err().to_string().starts_with(named));
        }
    }
}
