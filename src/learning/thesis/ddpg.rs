//! The thesis' deep deterministic policy gradient (DDPG; Algorithm 4, Table 4) with the networks of its reference 20, the
//! example of keras-rl.

use candle_core::{Device, Error, Tensor};
use rand::RngExt;
use rand_xoshiro::Xoshiro256PlusPlus;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::{
    actor_critic::{ActorCritic, ActorLoss, Rates, sizes},
    agent::{Agent, Choice, Settings, Transition},
    carom::Episode,
    environment::{Action, Environment, Observation, STATES, State},
    exploration::OrnsteinUhlenbeck,
    lessons::{Lessons, LessonsState},
    replay::{self, Batch, REPLAY_BUFFER},
    symmetry::{SYMMETRIES, View},
};
use crate::learning::{
    learner::{Progress, UpdateStats, note_of},
    nn::{
        adam::AdamConfig,
        weights::{Reader, WeightsError, Writer},
    },
    replay::ReplayBuffer,
    settings::{SettingError, check, check_batch, check_count, check_layers, check_positive, check_share},
};

/// Settings of [`PlainDdpg`]. The defaults are those of Table 4 or, if the thesis gives none, of keras-rl's example.
#[expect(clippy::struct_excessive_bools, reason = "each is a setting by its own name, also in older files")]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PlainDdpgSettings {
    /// When an episode ends.
    pub episode: Episode,
    /// Units of the actor's hidden layers. Its output is linear.
    pub actor_layers: Vec<usize>,
    /// Units of the critic's hidden layers. Its input is the state and the action.
    pub critic_layers: Vec<usize>,
    /// Adam's learning rate.
    pub learning_rate: f64,
    /// Soft update: `target = polyak * target + (1 - polyak) * online` (equation 59, with k in place of polyak).
    #[serde(alias = "keep")]
    pub polyak: f64,
    /// Norm at which gradients are clipped.
    #[serde(alias = "gradient_clip")]
    pub max_grad_norm: f64,
    /// Capacity of the replay buffer, in transitions.
    #[serde(alias = "memory")]
    pub buffer_size: usize,
    /// Discount factor.
    #[serde(alias = "discount")]
    pub gamma: f64,
    /// Minibatch size, in transitions.
    #[serde(alias = "batch")]
    pub batch_size: usize,
    /// Shots before the first update.
    #[serde(alias = "warm_up")]
    pub learning_starts: usize,
    /// Exploration noise.
    pub noise: OrnsteinUhlenbeck,
    /// Whether the noise restarts at zero with every episode, as in keras-rl. With one shot an episode the result is
    /// white noise with a standard deviation of `sigma sqrt(dt)`.
    pub noise_restarts: bool,
    /// Final noise as a share of the first.
    #[serde(alias = "noise_falls_to")]
    pub noise_end_factor: f64,
    /// Final learning rate as a share of the first.
    #[serde(alias = "learning_rate_falls_to")]
    pub learning_rate_end_factor: f64,
    /// Shots over which these two and `cloning_width` decay exponentially.
    #[serde(alias = "falls_over")]
    pub decay_steps: u64,
    /// Share of hindsight transitions in a minibatch (thesis 6.1.1). For rewards of points only, as the next setting.
    pub hindsight: f64,
    /// Share of demonstrations in a minibatch (thesis 6.1.2): shots that make the point, found by random search.
    pub demonstrations: f64,
    /// Number of layouts, from the first, on which demonstrations are searched.
    pub demonstration_layouts: u64,
    /// Random shots on each of them, in addition to the agent's shots.
    pub demonstration_tries: u32,
    /// Weight of behaviour cloning in the actor's loss.
    pub cloning: f64,
    /// Width of the Gaussian around a lesson that the actor ascends, at first and in the end: a standard deviation of the direction,
    /// in half turns.
    pub cloning_width: [f64; 2],
    /// Weight of the critic's value (the deterministic policy gradient) in the actor's loss.
    #[serde(alias = "climbing")]
    pub policy_gradient: f64,
    /// Weight of the penalty on actions out of range.
    #[serde(alias = "range_pull")]
    pub bounds_penalty: f64,
    /// Whether each transition of a minibatch is transformed by a random one of the table's symmetries (data augmentation).
    #[serde(alias = "symmetric")]
    pub symmetry_augmentation: bool,
    /// Whether the agent acts and learns in the canonical view instead: the symmetric view that all eight share.
    pub canonical: bool,
    /// Whether the agent acts and learns in coordinates relative to the nearer object ball, instead of both.
    pub relative: bool,
}

impl Default for PlainDdpgSettings {
    fn default() -> Self {
        Self {
            episode: Episode::default(),
            actor_layers: vec![16; 3],
            critic_layers: vec![32; 3],
            learning_rate: 1e-3,
            polyak: 0.999,
            max_grad_norm: 1.0,
            buffer_size: 50_000,
            gamma: 0.99,
            batch_size: 32,
            learning_starts: 100,
            noise: OrnsteinUhlenbeck { theta: 0.15, sigma: 0.3, dt: 0.01 },
            noise_restarts: true,
            noise_end_factor: 1.0,
            learning_rate_end_factor: 1.0,
            decay_steps: 400_000,
            hindsight: 0.0,
            demonstrations: 0.0,
            demonstration_layouts: 10_000,
            demonstration_tries: 300,
            cloning: 1.0,
            cloning_width: [0.2, 0.015],
            policy_gradient: 1.0,
            bounds_penalty: 0.0,
            symmetry_augmentation: false,
            canonical: false,
            relative: false,
        }
    }
}

impl Settings for PlainDdpgSettings {
    fn episode(&self) -> Episode {
        self.episode
    }

    fn needs_point_rewards(&self) -> bool {
        self.hindsight > 0.0 || self.demonstrations > 0.0
    }

    fn validate(&self) -> Result<(), SettingError> {
        self.episode.validate()?;
        check_layers("actor_layers", &self.actor_layers)?;
        check_layers("critic_layers", &self.critic_layers)?;
        check_positive("learning_rate", self.learning_rate)?;
        check_share("polyak", self.polyak)?;
        check_positive("max_grad_norm", self.max_grad_norm)?;
        check_count("buffer_size", self.buffer_size)?;
        check_share("gamma", self.gamma)?;
        check_batch("batch_size", self.batch_size)?;
        check_share("noise.dt", self.noise.dt)?;
        let kept = self.noise.theta * self.noise.dt;
        check("noise.theta", self.noise.theta, (0.0..2.0).contains(&kept), "0 to 2 / dt")?;
        check("noise.sigma", self.noise.sigma, (0.0..=1e3).contains(&self.noise.sigma), "0 to 1000")?;
        for (name, share) in
            [("noise_end_factor", self.noise_end_factor), ("learning_rate_end_factor", self.learning_rate_end_factor)]
        {
            check_positive(name, share)?;
            check_share(name, share)?;
        }
        check("decay_steps", self.decay_steps as f64, self.decay_steps > 0, "at least 1")?;
        check_share("hindsight", self.hindsight)?;
        check_share("demonstrations", self.demonstrations)?;
        check_share("hindsight + demonstrations", self.hindsight + self.demonstrations)?;
        check_count("demonstration_tries", self.demonstration_tries as usize)?;
        for width in self.cloning_width {
            check_positive("cloning_width", width)?;
        }
        for (name, weight) in [
            ("policy_gradient", self.policy_gradient),
            ("cloning", self.cloning),
            ("bounds_penalty", self.bounds_penalty),
        ] {
            check(name, weight, (0.0..=1e3).contains(&weight), "0 to 1000")?;
        }
        Ok(())
    }
}

impl PlainDdpgSettings {
    fn sizes(&self) -> [Vec<usize>; 2] {
        sizes(&self.actor_layers, &self.critic_layers)
    }

    const fn rates(&self) -> Rates {
        let Self { learning_rate, polyak, max_grad_norm, .. } = *self;
        Rates { adam: AdamConfig { learning_rate, max_grad_norm }, polyak }
    }

    /// Reads the networks of an agent with these settings after `updates` updates.
    fn networks(&self, reader: &Reader<'_>, updates: u32) -> Result<ActorCritic, WeightsError> {
        ActorCritic::from_values(&self.sizes(), self.rates(), &reader.array("networks")?.1, updates)
    }

    /// Returns the factor of an exponential decay after `shots`; its final value is `last`.
    fn decayed(&self, last: f64, shots: u64) -> f64 {
        last.powf((shots as f64 / self.decay_steps as f64).min(1.0))
    }

    fn actor_loss(&self, lessons: usize, shots: u64) -> ActorLoss {
        let [first, last] = self.cloning_width;
        let width = first * self.decayed(last / first, shots);
        let speed = (SPEED_WIDTH * width).min(WIDEST);
        let Self { policy_gradient, cloning, bounds_penalty, .. } = *self;
        ActorLoss { policy_gradient, lessons, cloning, width: [width, speed], bounds_penalty }
    }

    /// Returns the view in which the agent sees states; `None` for table coordinates.
    fn fixed_view(&self) -> Option<fn(State) -> View> {
        if self.relative { Some(View::relative) } else { self.canonical.then_some(View::canonical) }
    }

    /// Returns the minibatch rows for hindsight and for demonstrations.
    fn lesson_rows(&self) -> [usize; 2] {
        // A positive share gets at least one row, so that the lessons that are searched for are also learnt from.
        [self.hindsight, self.demonstrations].map(|share| {
            let least = usize::from(share > 0.0);
            ((share * self.batch_size as f64) as usize).max(least)
        })
    }
}

/// Width of the Gaussian around a lesson in speed, relative to that in direction: points depend less on the speed.
const SPEED_WIDTH: f64 = 10.0;

/// Upper limit of that width. Actions range over 2.
const WIDEST: f64 = 0.5;

/// The thesis' DDPG agent.
#[derive(Debug)]
pub struct PlainDdpg {
    settings: PlainDdpgSettings,
    networks: ActorCritic,
    replay: ReplayBuffer<Transition>,
    lessons: Lessons,
    noise: Action,
    shots: u64,
}

#[derive(Serialize, Deserialize)]
struct PlainDdpgState {
    shots: u64,
    updates: u32,
    next: usize,
    noise: Action,
    /// Omitted for agents without lessons, so that their checkpoints equal those of older versions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    lessons: Option<LessonsState>,
}

impl PlainDdpg {
    fn update(&mut self, rng: &mut Xoshiro256PlusPlus) -> Result<UpdateStats, Error> {
        let settings = &self.settings;
        self.networks.scale_learning_rates(settings.decayed(settings.learning_rate_end_factor, self.shots));
        let mut drawn = self.lessons.sample(settings.lesson_rows(), rng);
        let lessons = drawn.len();
        drawn.extend(self.replay.sample(settings.batch_size.saturating_sub(lessons), rng));
        for shot in &mut drawn {
            let [view, next] = match settings.fixed_view() {
                Some(view) => [view(shot.before.state), view(shot.after.state)],
                None if settings.symmetry_augmentation => [View::symmetric(rng.random_range(0..SYMMETRIES)); 2],
                None => continue,
            };
            *shot = view.shot(shot, next);
        }
        let batch = Batch::new(&drawn, settings.gamma)?;
        self.networks.update(&batch, &settings.actor_loss(lessons, self.shots))
    }

    /// Returns the actor's action with this noise, which is added in the agent's own view: a direction beyond half a turn means the same
    /// there as on the table.
    fn act(&self, seen: &Observation, noise: Action) -> Result<Choice, Error> {
        let view = self.settings.fixed_view().map_or_else(View::default, |view| view(seen.state));
        let state = Tensor::from_slice(&view.state(seen.state), (1, STATES), &Device::Cpu)?;
        let action = self.networks.act(&state)?.flatten_all()?.to_vec1::<f32>()?;
        let action = std::array::from_fn(|index| action[index] + noise[index]);
        Ok(Choice { action: view.on_table(action), index: 0 })
    }
}

impl Agent for PlainDdpg {
    const NAME: &'static str = "thesis-ddpg";
    const TITLE: &'static str = "the thesis' deep deterministic policy gradient";
    type Settings = PlainDdpgSettings;

    fn new(settings: PlainDdpgSettings, rng: &mut Xoshiro256PlusPlus) -> Result<Self, Error> {
        let networks = ActorCritic::random(&settings.sizes(), settings.rates(), rng)?;
        let (replay, lessons) = (ReplayBuffer::new(settings.buffer_size), Lessons::new(settings.buffer_size));
        Ok(Self { settings, networks, replay, lessons, noise: Action::default(), shots: 0 })
    }

    fn settings(&self) -> &PlainDdpgSettings {
        &self.settings
    }

    fn progress(&self) -> Progress {
        let settings = &self.settings;
        let [rate, noise] = [settings.learning_rate_end_factor, settings.noise_end_factor]
            .map(|last| settings.decayed(last, self.shots));
        Progress {
            updates: u64::from(self.networks.updates()),
            learning_rate: rate * settings.learning_rate,
            exploration: noise * settings.noise.deviation(settings.noise_restarts),
            replay_fill: Some(self.replay.fill_fraction()),
        }
    }

    fn explore(&mut self, game: &impl Environment, rng: &mut Xoshiro256PlusPlus) -> Result<Choice, Error> {
        let seen = game.observe();
        self.noise = self.settings.noise.step(self.noise, rng);
        let left = self.settings.decayed(self.settings.noise_end_factor, self.shots) as f32;
        let choice = self.act(&seen, self.noise.map(|noise| left * noise))?;
        self.lessons.collect(&self.settings, game, &seen, choice.action, rng);
        Ok(choice)
    }

    fn best(&self, seen: &Observation) -> Result<Choice, Error> {
        self.act(seen, Action::default())
    }

    fn learn(&mut self, transition: &Transition, rng: &mut Xoshiro256PlusPlus) -> Result<Option<UpdateStats>, Error> {
        self.replay.push(*transition);
        if self.settings.noise_restarts && !transition.continues {
            self.noise = Action::default();
        }
        self.shots += 1;
        if self.shots <= self.settings.learning_starts as u64 { Ok(None) } else { self.update(rng).map(Some) }
    }

    fn save(&self, writer: &mut Writer) -> Result<Value, WeightsError> {
        let values = self.networks.values()?;
        writer.add("networks", &[values.len()], &values);
        let Self { shots, noise, .. } = *self;
        let lessons = self.settings.needs_point_rewards().then(|| self.lessons.save(writer));
        let (updates, next) = (self.networks.updates(), replay::save(&self.replay, REPLAY_BUFFER, writer));
        note_of(&PlainDdpgState { shots, updates, next, noise, lessons })
    }

    fn restore(settings: PlainDdpgSettings, reader: &Reader<'_>, note: Value) -> Result<Self, WeightsError> {
        let PlainDdpgState { shots, updates, next, noise, lessons } =
            serde_json::from_value(note).map_err(|_| WeightsError::Metadata)?;
        let networks = settings.networks(reader, updates)?;
        let capacity = settings.buffer_size;
        let replay = replay::restore(capacity, reader, REPLAY_BUFFER, next)?;
        let lessons =
            lessons.map_or_else(|| Ok(Lessons::new(capacity)), |state| Lessons::restore(capacity, reader, state))?;
        Ok(Self { settings, networks, replay, lessons, noise, shots })
    }

    /// The online networks of the file become the online and the target networks; the optimisers restart.
    fn load_weights(&mut self, reader: &Reader<'_>) -> Result<(), WeightsError> {
        self.networks = self.settings.networks(reader, 0)?.restarted()?;
        Ok(())
    }
}
