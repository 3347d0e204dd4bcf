//! Policies as files: what they say about themselves, and the checks before one is trusted.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::{Policy, calibration::Calibration};
use crate::{
    game::{Reward, Rule},
    learning::{
        checksum::{NO_CHECKSUM, OF_POLICY, checksum, is_whole, write_checksum},
        ddpg::{context::knows, hyperparameters::Hyperparameters, networks::Networks},
        nn::weights::{Reader, WeightsError, Writer},
    },
    storage,
    table::Table,
};

/// The bundled policies by their names (`models/README.md`): the table, or `context` for those that are told table and player, for all
/// tables like `match`; and what was rewarded. A constant would stand in the program once for every codegen unit that reads it.
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

/// The bundled policy's file for a table, or `context`, and a rule.
fn bundled_file(whose: &str, rule: Rule) -> Option<&'static [u8]> {
    bundled_bytes(&format!("{whose}-{}", Reward::for_rule(rule)))
}

/// The names of the bundled policies.
pub fn bundled_names() -> impl Iterator<Item = &'static str> {
    BUNDLED.iter().map(|(name, _)| *name)
}

/// The bundled file of this name.
pub(in crate::learning) fn bundled_bytes(name: &str) -> Option<&'static [u8]> {
    BUNDLED.iter().find(|(bundled, _)| *bundled == name).map(|(_, bytes)| *bytes)
}

/// Where a policy comes from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Origin {
    /// Name of the table that it was trained on.
    pub table: String,
    /// What it was rewarded for.
    pub reward: Reward,
    /// What its actions mean (`ActionSpace::meaning`).
    pub actions: String,
    /// Version of the input features (`Inputs::version`).
    pub features: String,
    /// Seed of the run.
    pub seed: u64,
    /// Shots that it practised.
    pub shots: u64,
    /// Day on which it was written, or on which its run was started, UTC, as 2026-11-20.
    pub date: String,
    /// Version of carom that trained it.
    pub version: String,
    /// Mean reward of its first choice on the run's held-out layouts.
    pub held_out_reward: f64,
    /// Platt scaling from the critic's logit to the probability that is reported.
    #[serde(default)]
    pub calibration: Calibration,
    /// Settings of the run.
    pub hyperparameters: Hyperparameters,
}

/// What a policy's file says beside the weights.
#[derive(Serialize)]
struct Note<'a> {
    /// First, so that it is found ([`write_checksum`]).
    policy_checksum: &'static str,
    #[serde(flatten)]
    origin: &'a Origin,
}

/// Why a policy cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum PolicyError {
    /// The file cannot be read.
    #[error("the policy file {path} cannot be read: {reason}")]
    Read {
        /// Its path.
        path: String,
        /// What the system says.
        reason: std::io::Error,
    },
    /// The file's content is not a policy.
    #[error("{origin} is not a policy that carom can use: {reason}; train one with `carom train`")]
    Content {
        /// Path, or which bundled policy.
        origin: String,
        /// What is wrong.
        reason: WeightsError,
    },
    /// Some of the file's bytes have changed since it was written.
    #[error(
        "{origin} is damaged: its content does not fit its checksum; copy it anew, or train one with `carom train`"
    )]
    Damaged {
        /// Its path.
        origin: String,
    },
    /// The policy speaks of other features or actions.
    #[error("{origin} has {what} \"{found}\", this version of carom needs \"{expected}\"; train it again")]
    Version {
        /// Path, or which bundled policy.
        origin: String,
        /// What differs.
        what: &'static str,
        /// What the file has.
        found: String,
        /// What is needed.
        expected: String,
    },
}

impl Policy {
    /// The policy that comes with the program for `rule` on `table`, if there is one. A user's table of the same name is
    /// another table: no policy has ever played on it.
    ///
    /// # Errors
    /// Where the bundled file is damaged, which a test rules out.
    pub fn bundled(table: &Table, rule: Rule) -> Option<Result<Self, PolicyError>> {
        Table::preset(&table.name).ok().filter(|preset| preset == table)?;
        let bytes = bundled_file(&table.name, rule)?;
        Some(Self::from_bytes(bytes, &format!("the bundled policy for {rule} on \"{}\"", table.name)))
    }

    /// The policy that comes with the program for `rule` on this table: for a player who `errs` rather one that is told who plays, and
    /// for one who does not, rather this table's own, or that of `match` if it is told the table.
    ///
    /// # Errors
    /// As [`Policy::bundled`].
    pub fn bundled_for(table: &Table, rule: Rule, errs: bool) -> Option<Result<Self, PolicyError>> {
        let own = || Self::bundled(table, rule);
        let told = |bytes| Self::from_bytes(bytes, &format!("the bundled policy for {rule} on tables like \"match\""));
        let of_player = || bundled_file("context", rule).filter(|_| knows(table)).map(told);
        if errs {
            return of_player().or_else(own);
        }
        let of_match = || {
            let policy = Self::bundled(&Table::default(), rule).filter(|_| knows(table))?;
            policy.as_ref().map_or(true, Self::has_context).then_some(policy)
        };
        own().or_else(of_match).or_else(of_player)
    }

    /// The bundled policy in the file of this name.
    ///
    /// # Errors
    /// As [`Policy::bundled`].
    pub fn bundled_called(name: &str) -> Option<Result<Self, PolicyError>> {
        bundled_bytes(name).map(|bytes| Self::from_bytes(bytes, name))
    }

    /// What the bundled file with these networks is called; `None` where they are no bundled ones.
    pub fn bundled_name(&self) -> Option<&'static str> {
        // Seed, shots and settings tell them apart.
        let is_this =
            |bytes| Reader::new(bytes).is_ok_and(|file| file.note().is_ok_and(|note: Origin| note == self.origin));
        BUNDLED.iter().find(|(_, bytes)| is_this(bytes)).map(|(name, _)| *name)
    }

    /// A checksum of the networks and of what their file says of them: equal ones play equally.
    ///
    /// # Errors
    /// As [`Writer::finish`].
    pub fn checksum(&self) -> Result<String, WeightsError> {
        Ok(checksum(&self.to_bytes()?))
    }

    /// Reads a policy from a file.
    ///
    /// # Errors
    /// Where the file is missing, damaged, from another program, or for other features or actions.
    pub fn load(path: &Path) -> Result<Self, PolicyError> {
        Self::load_with_bytes(path).map(|(policy, _)| policy)
    }

    /// The same, and the bytes that it was read from: a run may have replaced the file before it is read again.
    pub(super) fn load_with_bytes(path: &Path) -> Result<(Self, Vec<u8>), PolicyError> {
        let origin = path.display().to_string();
        let bytes =
            storage::read(path, storage::LARGE).map_err(|reason| PolicyError::Read { path: origin.clone(), reason })?;
        Ok((Self::of_file(&bytes, &origin)?, bytes))
    }

    /// The policy in the bytes of a file that somebody may have changed: of a changed weight nothing else would tell. Those that earlier
    /// versions wrote have no checksum.
    pub(in crate::learning) fn of_file(bytes: &[u8], name: &str) -> Result<Self, PolicyError> {
        if is_whole(OF_POLICY, bytes) == Some(false) {
            return Err(PolicyError::Damaged { origin: name.to_owned() });
        }
        Self::from_bytes(bytes, name)
    }

    /// The policy in a file's bytes; `name` is what errors call the file.
    fn from_bytes(bytes: &[u8], name: &str) -> Result<Self, PolicyError> {
        let content = |reason| PolicyError::Content { origin: name.to_owned(), reason };
        let reader = Reader::new(bytes).map_err(content)?;
        let origin: Origin = reader.note().map_err(content)?;
        let version = |what, found: &str, expected: &str| {
            let [origin, found, expected] = [name, found, expected].map(str::to_owned);
            if found == expected { Ok(()) } else { Err(PolicyError::Version { origin, what, found, expected }) }
        };
        let inputs = origin.hyperparameters.inputs();
        version("features", &origin.features, &inputs.version())?;
        version("actions", &origin.actions, inputs.space.meaning())?;
        let networks = Networks::read(&reader, "", &origin.hyperparameters).map_err(content)?;
        Ok(Self { networks, origin })
    }

    /// The bytes of a policy file, with half the digits of the weights: success does not depend on the others.
    pub(in crate::learning) fn to_bytes(&self) -> Result<Vec<u8>, WeightsError> {
        let mut writer = Writer::default();
        for (name, network) in [("actor", &self.networks.actor), ("critic", &self.networks.critic)] {
            writer.add_network_half(name, network)?;
        }
        let mut bytes = writer.finish(&Note { policy_checksum: NO_CHECKSUM, origin: &self.origin })?;
        if write_checksum(OF_POLICY, &mut bytes) { Ok(bytes) } else { Err(WeightsError::Foreign) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use candle_core::{Device, Tensor};

    fn bundled() -> Policy {
        Policy::bundled(&Table::default(), Rule::StraightRail).unwrap().unwrap()
    }

    fn is_shared<T: Send + Sync>(_: &T) {}

    #[test]
    fn every_bundled_policy_reads_and_says_what_it_is_for() {
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
                // That for three cushions on `match` is told the table, too.
                assert_eq!(policy.has_context(), has_context || rule == Rule::ThreeCushion);
                assert!(policy.knows(table));
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
    fn a_changed_byte_is_noticed_wherever_it_stands_and_files_of_earlier_versions_are_read() {
        let policy = bundled();
        let bytes = policy.to_bytes().unwrap();
        let read = |bytes: &[u8]| Policy::of_file(bytes, "it");
        assert_eq!(read(&bytes).unwrap().origin, policy.origin);
        let header = 8 + usize::from(bytes[0]) + 256 * usize::from(bytes[1]);
        // The header, and here and there a weight.
        for index in (0..header).step_by(5).chain((header..bytes.len()).step_by(bytes.len() / 50)) {
            let mut damaged = bytes.clone();
            damaged[index] ^= 1;
            // Where the checksum's own name is changed, there is none, and all else is as it was.
            assert!(
                read(&damaged).is_err() || index < header && read(&damaged).unwrap().origin == policy.origin,
                "{index}"
            );
            assert!(read(&bytes[..index]).is_err(), "cut at {index}");
        }
        let mut damaged = bytes;
        *damaged.last_mut().unwrap() ^= 1;
        let said = read(&damaged).unwrap_err().to_string();
        assert!(said.starts_with("it is damaged"), "{said}");
        let earlier = bundled_file("match", Rule::StraightRail).unwrap();
        assert_eq!(is_whole(OF_POLICY, earlier), None);
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
