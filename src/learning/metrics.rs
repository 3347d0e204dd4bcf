//! What a run reports, as JSON Lines with the names that users of Stable-Baselines3 know.

use std::{fs, io::Write as _, path::Path};

use serde::{Deserialize, Serialize};

use crate::storage::write_atomic;

/// One line of a run's metrics. Means are over the updates since the line before.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Shots played so far.
    #[serde(rename = "time/total_timesteps")]
    pub shots: u64,
    /// Seconds of training so far, evaluations included.
    #[serde(rename = "time/time_elapsed")]
    pub seconds: f64,
    /// Shots a second since the line before.
    #[serde(rename = "time/fps")]
    pub shots_per_second: f64,
    /// Updates made so far.
    #[serde(rename = "train/n_updates")]
    pub updates: u64,
    /// The critic's learning rate now.
    #[serde(rename = "train/learning_rate")]
    pub learning_rate: f64,
    /// Loss of whatever judges actions: the mean cross entropy of a critic of successes, nats, or a squared error.
    #[serde(rename = "train/critic_loss")]
    pub critic_loss: f64,
    /// Loss of the actor, for agents that have one.
    #[serde(rename = "train/actor_loss", default, skip_serializing_if = "Option::is_none")]
    pub actor_loss: Option<f64>,
    /// Mean value that the agent gives its own choices. `Stable-Baselines3` logs none; `CleanRL` logs it as
    /// `losses/qf1_values` beside its losses, whose group is called `train` here.
    #[serde(rename = "train/q_value")]
    pub q_value: f64,
    /// Mean reward of the shots played, exploration included.
    #[serde(rename = "rollout/ep_rew_mean")]
    pub practice_reward: f64,
    /// Mean reward of the averaged networks' first choice on held-out layouts, without exploration.
    #[serde(rename = "eval/mean_reward", default, skip_serializing_if = "Option::is_none")]
    pub held_out_reward: Option<f64>,
    /// Share of those layouts in which any head earns at least 1: what a perfect choice among them would reach.
    #[serde(rename = "eval/any_head", default, skip_serializing_if = "Option::is_none")]
    pub held_out_reach: Option<f64>,
}

/// Appends a line.
///
/// # Errors
/// Whatever the file system reports.
pub fn append(path: &Path, record: &Record) -> std::io::Result<()> {
    let mut line = serde_json::to_string(record)?;
    line.push('\n');
    // One write call a line: whoever follows the file sees whole lines.
    fs::OpenOptions::new().create(true).append(true).open(path)?.write_all(line.as_bytes())
}

/// Drops what was written after `shots` shots, and a last line that was cut off, so that a run that goes on from there
/// writes no line twice. Returns the last line that is left.
///
/// # Errors
/// Whatever the file system reports; a missing file is an empty one.
pub fn rewind(path: &Path, shots: u64) -> std::io::Result<Option<Record>> {
    let text = match fs::read_to_string(path) {
        Ok(text) => text,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(error),
    };
    let (mut kept, mut last) = (String::with_capacity(text.len()), None);
    for line in text.lines() {
        if let Ok(record) = serde_json::from_str::<Record>(line)
            && record.shots <= shots
        {
            kept.push_str(line);
            kept.push('\n');
            last = Some(record);
        }
    }
    write_atomic(path, kept.as_bytes())?;
    Ok(last)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(shots: u64) -> Record {
        Record {
            shots,
            seconds: 1.5,
            shots_per_second: 100.0,
            updates: 3,
            learning_rate: 1e-3,
            critic_loss: 0.5,
            actor_loss: Some(-0.5),
            q_value: 0.5,
            practice_reward: 0.25,
            held_out_reward: None,
            held_out_reach: None,
        }
    }

    #[test]
    fn lines_speak_the_names_of_stable_baselines() {
        let line = serde_json::to_string(&Record { held_out_reward: Some(0.5), ..record(7) }).unwrap();
        for name in ["time/total_timesteps\":7", "rollout/ep_rew_mean\":0.25", "eval/mean_reward\":0.5", "time/fps\":"]
        {
            assert!(line.contains(name), "{line}");
        }
        assert!(!line.contains("any_head"));
    }

    #[test]
    fn rewinding_drops_later_lines_and_a_torn_one() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("metrics.jsonl");
        assert_eq!(rewind(&path, 5).unwrap(), None);
        for shots in [1, 2, 3] {
            append(&path, &record(shots)).unwrap();
        }
        let torn = fs::read_to_string(&path).unwrap() + "{\"time/total";
        fs::write(&path, torn).unwrap();
        assert_eq!(rewind(&path, 2).unwrap(), Some(record(2)));
        append(&path, &record(4)).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap().lines().count(), 3);
    }
}
