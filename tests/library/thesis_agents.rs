//! The thesis' agents on a game with a known optimum, and saved and resumed on the real game.

use carom::{
    game::Reward,
    learning::{
        learner::{AgentKind, Learner, TrainingPlan},
        thesis::{
            agent::{Agent, EpisodeState},
            ddpg::{PlainDdpg, PlainDdpgSettings},
            dqn::{Dqn, DqnSettings},
            environment::{Action, Environment, Observation, Outcome},
            exploration::{Epsilon, OrnsteinUhlenbeck},
            q_learning::{QLearning, QLearningSettings},
        },
        weights::{Reader, Writer},
    },
    table::{Layout, Table},
};
use glam::DVec2;
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use serde_json::{Value, json};

/// A game of two steps. The first action is better the closer its direction is to a target given by the state; only the second step is
/// rewarded for it, whatever the second action is. The maximum reward is one, at a known action, and an agent finds it only by propagating
/// values from one step back to the previous one.
#[derive(Default)]
struct Detour {
    goal: f32,
    closeness: Option<f32>,
}

impl Environment for Detour {
    fn reset(&mut self, rng: &mut Xoshiro256PlusPlus) {
        *self = Self { goal: if rng.random_bool(0.5) { 0.5 } else { -0.5 }, closeness: None };
    }

    fn observe(&self) -> Observation {
        let first = u32::from(self.goal > 0.0);
        match self.closeness {
            None => Observation { state: [2.0 * self.goal, 0.0, -1.0, 0.0, 0.0, 0.0], cell: 40 + first },
            Some(near) => {
                Observation { state: [2.0 * self.goal, near, 1.0, 0.0, 0.0, 0.0], cell: (20.0 * near) as u32 }
            }
        }
    }

    fn step(&mut self, action: Action) -> Outcome {
        match self.closeness {
            None => {
                self.closeness = Some(1.0 / (1.0 + 4.0 * (action[0] - self.goal).powi(2)));
                Outcome { reward: 0.0, terminated: false }
            }
            Some(near) => Outcome { reward: f64::from(near), terminated: true },
        }
    }
}

/// Returns the mean reward of the agent's best first actions over both states, after this number of shots.
fn trained_reward<A: Agent>(settings: A::Settings, shots: u32, seed: u64) -> f64 {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
    let mut agent = A::new(settings, &mut rng).unwrap();
    let (mut episode, mut game) = (EpisodeState::default(), Detour::default());
    for _ in 0..shots {
        episode.shoot(&mut agent, &mut game, &mut rng).unwrap();
    }
    let earned = [-0.5, 0.5].map(|goal| {
        let mut game = Detour { goal, closeness: None };
        game.step(agent.best(&game.observe()).unwrap().action);
        game.step([0.0; 2]).reward
    });
    0.5 * (earned[0] + earned[1])
}

#[test]
fn q_learning_finds_the_optimum() {
    let epsilon = Epsilon { first: 1.0, last: 0.1, over: 20_000 };
    let settings = QLearningSettings { learning_rate: 0.5, epsilon, ..QLearningSettings::default() };
    assert!(trained_reward::<QLearning>(settings.clone(), 0, 1) < 0.9, "chance alone must not pass");
    let earned = trained_reward::<QLearning>(settings, 30_000, 1);
    assert!(earned > 0.95, "{earned}");
}

#[test]
fn deep_q_learning_finds_the_optimum() {
    let epsilon = Epsilon { first: 1.0, last: 0.1, over: 3_000 };
    let settings = DqnSettings { target_update_interval: 200, buffer_size: 5_000, epsilon, ..DqnSettings::default() };
    assert!(trained_reward::<Dqn>(settings.clone(), 0, 1) < 0.9, "chance alone must not pass");
    let earned = trained_reward::<Dqn>(settings, 5_000, 1);
    assert!(earned > 0.9, "{earned}");
}

#[test]
fn the_deterministic_policy_gradient_finds_the_optimum() {
    // Strong noise that continues from game to game, and fast target updates: the defaults are for far more shots. With some seeds the
    // plain algorithm fails even so: of 16 seeds two do, and rounding decides which ones and may cost a third.
    let noise = OrnsteinUhlenbeck { theta: 0.15, sigma: 0.3, dt: 1.0 };
    let settings = PlainDdpgSettings { polyak: 0.99, noise, noise_restarts: false, ..PlainDdpgSettings::default() };
    let all = |shots: u32| {
        (1..=16).map(|seed| trained_reward::<PlainDdpg>(settings.clone(), shots, seed)).collect::<Vec<_>>()
    };
    let found = |earned: &[f64]| earned.iter().filter(|earned| **earned > 0.95).count();
    let (chance, earned) = (all(0), all(10_000));
    assert!(found(&chance) == 0 && found(&earned) >= 13, "{chance:?} {earned:?}");
}

fn start(agent: &str, settings: &Value) -> Box<dyn Learner> {
    let plan = TrainingPlan { reward: Reward::R1, seed: 4, shots: 650 };
    (AgentKind::named(agent).unwrap().start)(plan, Table::preset("thesis").unwrap(), settings).unwrap()
}

fn save(learner: &dyn Learner) -> Vec<u8> {
    let mut writer = Writer::default();
    let note = learner.save(&mut writer).unwrap();
    writer.finish(&note).unwrap()
}

fn restore(agent: &str, bytes: &[u8]) -> Box<dyn Learner> {
    let reader = Reader::new(bytes).unwrap();
    (AgentKind::named(agent).unwrap().restore)(&reader, reader.note().unwrap()).unwrap()
}

const AGENTS: [&str; 3] = ["q-learning", "dqn", "thesis-ddpg"];

#[test]
fn a_resumed_agent_with_lessons_equals_an_uninterrupted_one() {
    // When the agent is saved, layouts are left to search, and more lessons were found than fit into memory.
    let settings = json!({
        "hindsight": 0.4, "demonstrations": 0.3, "demonstration_layouts": 330, "demonstration_tries": 60, "buffer_size": 50,
        "noise_end_factor": 0.5, "learning_rate_end_factor": 0.5, "decay_steps": 400, "symmetry_augmentation": true,
        "bounds_penalty": 0.3,
    });
    let plan = TrainingPlan { reward: Reward::R3, seed: 5, shots: 650 };
    let start =
        || (AgentKind::named("thesis-ddpg").unwrap().start)(plan, Table::preset("thesis").unwrap(), &settings).unwrap();
    let (mut whole, mut parts) = (start(), start());
    let first_rate = whole.progress().learning_rate;
    while !whole.is_finished() {
        parts = restore("thesis-ddpg", &save(parts.as_ref()));
        assert_eq!(whole.iterate().unwrap(), parts.iterate().unwrap());
    }
    assert!(
        (whole.progress().learning_rate / first_rate - 0.5).abs() < 1e-12,
        "{} of {first_rate}",
        whole.progress().learning_rate
    );
    let bytes = save(whole.as_ref());
    assert!(bytes == save(parts.as_ref()));
    for name in ["hindsight", "demonstrations"] {
        let (shape, _) = Reader::new(&bytes).unwrap().array(name).unwrap();
        assert_eq!(shape[0], 50, "{name}");
    }
}

#[test]
fn canonical_and_relative_views_are_symmetric() {
    for view in ["canonical", "relative"] {
        assert_symmetric_play(start("thesis-ddpg", &json!({ view: true })).as_ref());
    }
}

fn assert_symmetric_play(agent: &dyn Learner) {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(9);
    for _ in 0..100 {
        let layout = Layout::random(agent.table(), &mut rng);
        let [cue, one, other] = layout.balls;
        let shot_on = |balls| agent.choose_shots(&[Layout::new(balls)]).unwrap()[0];
        let shot = shot_on(layout.balls);
        assert_eq!(shot_on([cue, other, one]), shot);
        for mirror in [DVec2::new(-1.0, 1.0), DVec2::new(1.0, -1.0)] {
            let mirrored = shot_on(layout.balls.map(|ball| mirror * ball));
            let directions = [shot.phi, mirrored.phi].map(DVec2::from_angle);
            assert!((mirror * directions[1]).distance(directions[0]) < 1e-5, "{shot:?} {mirrored:?}");
            assert!((mirrored.speed - shot.speed).abs() < 1e-5, "{shot:?} {mirrored:?}");
        }
    }
}

#[test]
fn checkpoints_older_than_lessons_resume_identically() {
    let mut new = start("thesis-ddpg", &json!({}));
    new.iterate().unwrap();
    new.iterate().unwrap();
    let mut writer = Writer::default();
    let mut note = new.save(&mut writer).unwrap();
    let before = [
        "episode",
        "actor_layers",
        "critic_layers",
        "learning_rate",
        "polyak",
        "max_grad_norm",
        "buffer_size",
        "gamma",
        "batch_size",
        "learning_starts",
        "noise",
        "noise_restarts",
    ];
    note["settings"].as_object_mut().unwrap().retain(|name, _| before.contains(&name.as_str()));
    assert!(note["agent"].get("lessons").is_none(), "{note}");
    let mut old = restore("thesis-ddpg", &writer.finish(&note).unwrap());
    assert_eq!(old.iterate().unwrap(), new.iterate().unwrap());
    assert!(save(old.as_ref()) == save(new.as_ref()));
}

#[test]
fn a_resumed_agent_equals_an_uninterrupted_one() {
    for agent in AGENTS {
        // Seven does not divide the hundred shots of an iteration, so agents are saved in the middle of a game.
        for episode in [json!("one-shot"), json!({ "shots": 7 })] {
            let mut settings = json!({ "episode": episode });
            if agent != "q-learning" {
                settings["buffer_size"] = json!(300);
            }
            let mut whole = start(agent, &settings);
            let mut parts = start(agent, &settings);
            while !whole.is_finished() {
                parts = restore(agent, &save(parts.as_ref()));
                assert_eq!(whole.iterate().unwrap(), parts.iterate().unwrap(), "{agent}");
            }
            assert_eq!(parts.shots(), 650);
            assert!(parts.progress().updates >= 500);
            assert!(save(whole.as_ref()) == save(parts.as_ref()), "{agent}");
        }
    }
}

#[test]
fn weights_of_other_agents_or_sizes_are_refused() {
    for agent in AGENTS {
        let mut teacher = start(agent, &json!({}));
        for _ in 0..6 {
            teacher.iterate().unwrap();
        }
        let bytes = save(teacher.as_ref());
        let mut pupil = start(agent, &json!({}));
        let layouts = carom::learning::evaluation::held_out_layouts(pupil.table(), 300, 1);
        pupil.load_weights(&Reader::new(&bytes).unwrap()).unwrap();
        assert_eq!(pupil.score(&layouts).unwrap(), teacher.score(&layouts).unwrap(), "{agent}");
        assert_eq!(pupil.shots(), 0);
        for other in AGENTS.into_iter().filter(|other| *other != agent) {
            assert!(
                start(other, &json!({})).load_weights(&Reader::new(&bytes).unwrap()).is_err(),
                "{agent} for {other}"
            );
        }
    }
    let bytes = save(start("thesis-ddpg", &json!({ "actor_layers": [8] })).as_ref());
    let refused = start("thesis-ddpg", &json!({})).load_weights(&Reader::new(&bytes).unwrap()).unwrap_err().to_string();
    assert!(["10028", "12492", "6-16-16-16-2"].iter().all(|part| refused.contains(part)), "{refused}");
}
