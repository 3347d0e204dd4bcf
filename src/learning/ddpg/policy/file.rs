//! Policy files: their metadata, the checks when one is loaded, and the bundled ones.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::{Policy, calibration::Calibration};
use crate::{
    game::{Reward, Rule},
    learning::{
        checksum::{CHECKSUM_PLACEHOLDER, POLICY_FIELD, checksum, is_intact, write_checksum},
        ddpg::{context::is_known_table, hyperparameters::Hyperparameters, networks::Networks},
        nn::weights::{Reader, WeightsError, Writer},
    },
    storage,
    table::Table,
};

/// The bundled policies by name (`models/README.md`). A name consists of the table, or `context` for policies with a context (for all
/// tables like `match`), and the reward. It is a static because a constant would be in the program once per codegen unit that reads it.
static BUNDLED: [(&str, &[u8]); 9] = [
    ("match-r3", include_bytes!("../../../../models/match-r3.safetensors")),
    ("match-one-cushion", include_bytes!("../../../../models/match-one-cushion.safetensors")),
    ("match-three-cushion", include_bytes!("../../../../models/match-three-cushion.safetensors")),
    ("thesis-r3", include_bytes!("../../../../models/thesis-r3.safetensors")),
    ("thesis-one-cushion", include_bytes!("../../../../models/thesis-one-cushion.safetensors")),
    ("thesis-three-cushion", include_bytes!("../../../../models/thesis-three-cushion.safetensors")),
    ("context-r3", include_bytes!("../../../../models/context-r3.safetensors")),
    ("context-one-cushion", include_bytes!("../../../../models/context-one-cushion.safetensors")),
    ("context-three-cushion", include_bytes!("../../../../models/context-three-cushion.safetensors")),
];

/// Returns the bundled policy file for a table's name, or `context`, and a rule.
fn bundled_file(table: &str, rule: Rule) -> Option<&'static [u8]> {
    bundled_bytes(&format!("{table}-{}", Reward::for_rule(rule)))
}

/// Returns the names of the bundled policies.
pub fn bundled_names() -> impl Iterator<Item = &'static str> {
    BUNDLED.iter().map(|(name, _)| *name)
}

/// Returns the bundled file called `name`.
pub(in crate::learning) fn bundled_bytes(name: &str) -> Option<&'static [u8]> {
    BUNDLED.iter().find(|(bundled, _)| *bundled == name).map(|(_, bytes)| *bytes)
}

/// Origin of a policy: the run that trained it, and its evaluation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Origin {
    /// Name of the table on which it was trained.
    pub table: String,
    /// The reward function.
    pub reward: Reward,
    /// Meaning of its actions (`ActionSpace::meaning`).
    pub actions: String,
    /// Version of the input features (`Inputs::version`).
    pub features: String,
    /// Seed of the run.
    pub seed: u64,
    /// Shots played in training.
    pub shots: u64,
    /// Day on which the file was written or its run was started, UTC, as 2026-11-20.
    pub date: String,
    /// Version of carom that trained it.
    pub version: String,
    /// Mean reward of its first choice on the run's held-out layouts.
    pub held_out_reward: f64,
    /// Platt scaling from the critic's logit to the reported probability.
    #[serde(default)]
    pub calibration: Calibration,
    /// Settings of the run.
    pub hyperparameters: Hyperparameters,
}

/// The JSON note of a policy file, next to the weights.
#[derive(Serialize)]
struct Note<'a> {
    /// Must be the first field, because [`write_checksum`] finds it by the opening brace.
    policy_checksum: &'static str,
    #[serde(flatten)]
    origin: &'a Origin,
}

/// A policy cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum PolicyError {
    /// The file at this path cannot be read.
    #[error("the policy file {0} cannot be read: {1}")]
    Read(String, std::io::Error),
    /// The content is not a whole policy of this version; a sentence says why.
    #[error("{0}")]
    Content(String),
}

impl Policy {
    /// Returns the bundled policy for `rule` on the preset `table`, if there is one. `None` for a user's table that only has the name of a
    /// preset: no policy was trained on it.
    ///
    /// # Errors
    /// Fails if the bundled file is damaged, which a test excludes.
    pub fn bundled(table: &Table, rule: Rule) -> Option<Result<Self, PolicyError>> {
        Table::preset(&table.name).ok().filter(|preset| preset == table)?;
        let bytes = bundled_file(&table.name, rule)?;
        Some(Self::from_bytes(bytes, &format!("the bundled policy for {rule} on \"{}\"", table.name)))
    }

    /// Returns the bundled policy that suits `rule`, `table` and the player best. For a player who `errs` this is the policy with a
    /// context, else the table's own. For a player without errors it is the table's own, else that of `match` if it has a context, else
    /// the policy with a context.
    pub(crate) fn bundled_for(table: &Table, rule: Rule, errs: bool) -> Option<Result<Self, PolicyError>> {
        let own = || Self::bundled(table, rule);
        let read = |bytes| Self::from_bytes(bytes, &format!("the bundled policy for {rule} on tables like \"match\""));
        let with_context = || bundled_file("context", rule).filter(|_| is_known_table(table)).map(read);
        if errs {
            return with_context().or_else(own);
        }
        let of_match = || {
            let policy = Self::bundled(&Table::default(), rule).filter(|_| is_known_table(table))?;
            policy.as_ref().map_or(true, Self::has_context).then_some(policy)
        };
        own().or_else(of_match).or_else(with_context)
    }

    /// Returns the bundled policy called `name`.
    pub(crate) fn bundled_by_name(name: &str) -> Option<Result<Self, PolicyError>> {
        bundled_bytes(name).map(|bytes| Self::from_bytes(bytes, name))
    }

    /// Returns the name of this policy among the bundled ones; `None` if it is not one of them.
    pub(crate) fn bundled_name(&self) -> Option<&'static str> {
        // Seed, shots and settings identify a policy.
        let is_this =
            |bytes| Reader::new(bytes).is_ok_and(|file| file.note().is_ok_and(|note: Origin| note == self.origin));
        BUNDLED.iter().find(|(_, bytes)| is_this(bytes)).map(|(name, _)| *name)
    }

    /// Returns a checksum of the networks and their metadata: policies with equal checksums play equally.
    pub(crate) fn checksum(&self) -> Result<String, WeightsError> {
        Ok(checksum(&self.to_bytes()?))
    }

    /// Loads a policy from a file.
    ///
    /// # Errors
    /// Fails if the file is missing, damaged, from another program, or for other features or actions.
    pub fn load(path: &Path) -> Result<Self, PolicyError> {
        Self::load_with_bytes(path).map(|(policy, _)| policy)
    }

    /// Loads a policy and returns the file's bytes, too: a run may replace the file before the caller could read it again.
    pub(super) fn load_with_bytes(path: &Path) -> Result<(Self, Vec<u8>), PolicyError> {
        let origin = path.display().to_string();
        let bytes =
            storage::read(path, storage::MAX_LARGE_FILE).map_err(|reason| PolicyError::Read(origin.clone(), reason))?;
        Ok((Self::of_file(&bytes, &origin)?, bytes))
    }

    /// Parses a policy file after checking its checksum: nothing else would reveal a changed weight. Files of earlier versions have no
    /// checksum.
    pub(in crate::learning) fn of_file(bytes: &[u8], name: &str) -> Result<Self, PolicyError> {
        if is_intact(POLICY_FIELD, bytes) == Some(false) {
            return Err(PolicyError::Content(format!(
                "{name} is damaged: its content does not fit its checksum; copy it again, or train one with `carom train`"
            )));
        }
        Self::from_bytes(bytes, name)
    }

    /// Parses a policy file without checking its checksum; error messages call the file `name`.
    fn from_bytes(bytes: &[u8], name: &str) -> Result<Self, PolicyError> {
        let content = |reason: WeightsError| {
            let advice = "train one with `carom train`";
            PolicyError::Content(format!("{name} is not a policy that carom can use: {reason}; {advice}"))
        };
        let reader = Reader::new(bytes).map_err(content)?;
        let origin: Origin = reader.note().map_err(content)?;
        let version = |what, found: &str, expected: &str| {
            let other =
                || format!("{name} has {what} \"{found}\", this version of carom needs \"{expected}\"; train it again");
            if found == expected { Ok(()) } else { Err(PolicyError::Content(other())) }
        };
        let inputs = origin.hyperparameters.inputs();
        version("features", &origin.features, &inputs.version())?;
        version("actions", &origin.actions, inputs.space.meaning())?;
        let networks = Networks::read(&reader, "", &origin.hyperparameters).map_err(content)?;
        Ok(Self { networks, origin })
    }

    /// Returns the bytes of a policy file, with weights in half precision: full precision does not improve the success.
    pub(in crate::learning) fn to_bytes(&self) -> Result<Vec<u8>, WeightsError> {
        let mut writer = Writer::default();
        for (name, network) in [("actor", &self.networks.actor), ("critic", &self.networks.critic)] {
            writer.add_network_half(name, network)?;
        }
        let mut bytes = writer.finish(&Note { policy_checksum: CHECKSUM_PLACEHOLDER, origin: &self.origin })?;
        if write_checksum(POLICY_FIELD, &mut bytes) { Ok(bytes) } else { Err(WeightsError::Metadata) }
    }
}

#[cfg(test)]
mod tests {
    use super::{super::tests::bundled, *};
    use candle_core::{Device, Tensor};

    fn is_shared<T: Send + Sync>(_: &T) {}

    #[test]
    fn every_bundled_policy_loads_and_states_its_table_and_reward() {
        for table in ["match", "thesis"] {
            let preset = Table::preset(table).unwrap();
            for rule in Rule::ALL {
                let policy = Policy::bundled(&preset, rule).unwrap().unwrap();
                is_shared(&policy);
                assert_eq!((policy.origin().table.as_str(), policy.origin().reward), (table, Reward::for_rule(rule)));
            }
        }
        assert!(Policy::bundled(&Table::preset("textbook").unwrap(), Rule::StraightRail).is_none());
        let own = Table { name: "mine".into(), sliding_friction: 0.21, ..Table::default() };
        assert!(Policy::bundled(&own, Rule::ThreeCushion).is_none());
        for (table, errs, has_context) in [
            (&own, true, true),
            (&own, false, true),
            (&Table::default(), true, true),
            (&Table::default(), false, false),
        ] {
            for rule in Rule::ALL {
                let policy = Policy::bundled_for(table, rule, errs).unwrap().unwrap();
                // The policy for three cushions on `match` has a context, too.
                assert_eq!(policy.has_context(), has_context || rule == Rule::ThreeCushion);
                assert!(policy.is_trained_for(table));
                assert_eq!(policy.origin().reward, Reward::for_rule(rule));
            }
        }
        for (table, errs, name) in [
            ("match", false, "match-three-cushion"),
            ("match", true, "context-three-cushion"),
            ("textbook", false, "match-three-cushion"),
            ("thesis", true, "thesis-three-cushion"),
        ] {
            let table = Table::preset(table).unwrap();
            let policy = Policy::bundled_for(&table, Rule::ThreeCushion, errs).unwrap().unwrap();
            assert_eq!(policy.bundled_name(), Some(name));
            assert!(Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("models/{name}.safetensors")).exists());
        }
        let mut another = bundled();
        another.origin.seed += 1;
        assert_eq!(another.bundled_name(), None);
        let [erring, flawless] =
            [true, false].map(|errs| Policy::bundled_for(&own, Rule::ThreeCushion, errs).unwrap().unwrap());
        assert_ne!(erring.origin().seed, flawless.origin().seed);
        let size: usize = BUNDLED.iter().map(|(.., bytes)| bytes.len()).sum();
        assert!(size <= 7_200_000, "{size} bytes of weights");
    }

    #[test]
    fn a_missing_policy_is_reported() {
        let missing = Policy::load(Path::new("none")).unwrap_err().to_string();
        assert!(missing.contains("none") && missing.contains("cannot be read"), "{missing}");
    }

    #[test]
    fn changed_bytes_are_detected_and_earlier_versions_are_read() {
        let policy = bundled();
        let bytes = policy.to_bytes().unwrap();
        let read = |bytes: &[u8]| Policy::of_file(bytes, "it");
        assert_eq!(read(&bytes).unwrap().origin, policy.origin);
        let header = 8 + usize::from(bytes[0]) + 256 * usize::from(bytes[1]);
        // Changes bytes of the header and some of the weights.
        for index in (0..header).step_by(5).chain((header..bytes.len()).step_by(bytes.len() / 50)) {
            let mut damaged = bytes.clone();
            damaged[index] ^= 1;
            // A change in the checksum's field name removes the checksum and leaves the rest intact.
            assert!(
                read(&damaged).is_err() || index < header && read(&damaged).unwrap().origin == policy.origin,
                "{index}"
            );
            assert!(read(&bytes[..index]).is_err(), "cut at {index}");
        }
        let mut damaged = bytes;
        *damaged.last_mut().unwrap() ^= 1;
        let message = read(&damaged).unwrap_err().to_string();
        assert!(message.starts_with("it is damaged"), "{message}");
        let earlier = bundled_file("match", Rule::StraightRail).unwrap();
        assert_eq!(is_intact(POLICY_FIELD, earlier), None);
        assert!(read(earlier).is_ok());
    }

    #[test]
    fn other_features_and_wrong_sizes_are_refused_by_name() {
        let refuse = |change: &dyn Fn(&mut Policy)| {
            let mut policy = bundled();
            change(&mut policy);
            Policy::from_bytes(&policy.to_bytes().unwrap(), "it").unwrap_err().to_string()
        };
        assert!(refuse(&|policy| policy.origin.features = "raw-0".into()).contains("raw-0"));
        assert!(refuse(&|policy| policy.origin.actions = "full".into()).contains("full"));
        assert!(refuse(&|policy| policy.networks.critic = policy.networks.actor.clone()).contains("critic"));
        let poisoned = refuse(&|policy| {
            let parameters = policy.networks.critic.parameters();
            let nan = Tensor::full(f32::NAN, parameters.shape(), &Device::Cpu).unwrap();
            parameters.set(&nan).unwrap();
        });
        assert!(poisoned.contains("finite"), "{poisoned}");
    }
}
