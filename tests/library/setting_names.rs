//! Settings in checkpoints and configurations of earlier versions, in which some had other names.

use carom::{
    game::Reward,
    learning::{
        learner::{AgentKind, TrainingPlan},
        weights::{Reader, Writer},
    },
    table::Table,
};
use serde_json::{Value, json};

/// For each agent, the earlier and the current names of settings.
const NAMES: [(&str, &[[&str; 2]]); 4] = [
    (
        "ddpg",
        &[
            ["target_rate", "tau"],
            ["replay", "buffer_size"],
            ["batch", "batch_size"],
            ["actor_batch", "actor_batch_size"],
            ["gradient_clip", "max_grad_norm"],
        ],
    ),
    ("q-learning", &[["discount", "gamma"]]),
    (
        "dqn",
        &[
            ["target_every", "target_update_interval"],
            ["memory", "buffer_size"],
            ["discount", "gamma"],
            ["batch", "batch_size"],
            ["warm_up", "learning_starts"],
        ],
    ),
    (
        "thesis-ddpg",
        &[
            ["keep", "polyak"],
            ["memory", "buffer_size"],
            ["discount", "gamma"],
            ["batch", "batch_size"],
            ["warm_up", "learning_starts"],
            ["gradient_clip", "max_grad_norm"],
            ["noise_falls_to", "noise_end_factor"],
            ["learning_rate_falls_to", "learning_rate_end_factor"],
            ["falls_over", "decay_steps"],
            ["climbing", "policy_gradient"],
            ["range_pull", "bounds_penalty"],
            ["symmetric", "symmetry_augmentation"],
        ],
    ),
];

/// Returns another value of the same type.
fn other(value: &Value) -> Value {
    match value {
        Value::Bool(value) => json!(!value),
        Value::Number(number) => {
            number.as_u64().map_or_else(|| json!(0.5 * (number.as_f64().unwrap() + 0.1)), |number| json!(number + 1))
        }
        value => panic!("{value}"),
    }
}

#[test]
fn earlier_names_give_the_same_settings() {
    for (agent, names) in NAMES {
        let kind = AgentKind::named(agent).unwrap();
        let defaults = (kind.settings)(&json!({})).unwrap();
        for &[earlier, current] in names {
            let value = other(&defaults[current]);
            let settings = (kind.settings)(&json!({ earlier: value })).unwrap();
            assert_eq!(settings, (kind.settings)(&json!({ current: value })).unwrap(), "{agent} {earlier}");
            assert_eq!(settings[current], value, "{agent} {earlier}");
            let both = (kind.settings)(&json!({ earlier: value, current: value })).unwrap_err().to_string();
            assert!(both.contains(&format!("{earlier} is the earlier name of {current}")), "{agent}: {both}");
        }
    }
}

#[test]
fn checkpoints_with_earlier_names_are_restored() {
    for (agent, names) in NAMES {
        let kind = AgentKind::named(agent).unwrap();
        let plan = TrainingPlan { reward: Reward::R1, seed: 4, shots: 650 };
        let defaults = (kind.settings)(&json!({})).unwrap();
        let changes: Value =
            names.iter().map(|&[_, current]| (current.to_owned(), other(&defaults[current]))).collect();
        let learner = (kind.start)(plan, Table::preset("thesis").unwrap(), &changes).unwrap();
        let mut writer = Writer::default();
        let mut note = learner.save(&mut writer).unwrap();
        let settings = if agent == "ddpg" { &mut note["task"]["hyperparameters"] } else { &mut note["settings"] };
        let settings = settings.as_object_mut().unwrap();
        for &[earlier, current] in names {
            let value = settings.remove(current).unwrap();
            settings.insert(earlier.to_owned(), value);
        }
        let bytes = writer.finish(&note).unwrap();
        let restored = (kind.restore)(&Reader::new(&bytes).unwrap(), note).unwrap();
        assert_eq!(restored.settings(), learner.settings(), "{agent}");
    }
}
