//! How often a player makes the shots that were chosen, on errors that the chooser never saw.

use std::fmt;

use serde::Serialize;

use super::order::Order;
use crate::{
    coach::{Doubt, Shooter, Skill, make_probability},
    game::Rule,
    physics::CueInputs,
    table::Layout,
};

/// Independent attempts at each shot.
const ATTEMPTS: usize = 1000;

/// Two-sided 95 % of the normal distribution.
const Z: f64 = 1.96;

/// The make probability over all layouts.
#[derive(Debug, Serialize)]
pub struct Robustness {
    skill: Skill,
    doubt: Doubt,
    /// Mean make probability.
    make_probability: f64,
    /// Its 95 % interval, from the spread between layouts.
    make_interval: [f64; 2],
    /// Mean of what the recommender itself said, where it said anything.
    #[serde(skip_serializing_if = "Option::is_none")]
    claimed: Option<f64>,
    /// Make probability that a tenth of the layouts stay below.
    worst_tenth: f64,
    /// What was said and what was made, by tenths of what was said; only those with a layout.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    tenths: Vec<Tenth>,
    /// On each layout.
    #[serde(skip)]
    chances: Vec<f64>,
}

/// The layouts of which the recommender said about the same.
#[derive(Debug, Serialize)]
struct Tenth {
    layouts: usize,
    claimed: f64,
    made: f64,
}

/// The make probability of a shot.
pub fn chance(order: &Order, rule: Rule, layout: &Layout, skill: Skill, cue: &CueInputs) -> f64 {
    // Another stream than the recommender's, which has this seed too.
    let shooter = Shooter { skill, doubt: order.doubt };
    make_probability(shooter, rule, &order.table, layout, cue, ATTEMPTS, !order.seed).rate
}

impl Robustness {
    /// From the make probability on every layout; there is at least one.
    pub fn new(skill: Skill, doubt: Doubt, chances: Vec<f64>) -> Self {
        let count = chances.len().max(1) as f64;
        let mean = chances.iter().sum::<f64>() / count;
        let variance = chances.iter().map(|chance| (chance - mean).powi(2)).sum::<f64>() / (count - 1.0).max(1.0);
        let spread = Z * (variance / count).sqrt();
        let mut sorted = chances.clone();
        sorted.sort_by(f64::total_cmp);
        Self {
            skill,
            doubt,
            make_probability: mean,
            make_interval: [(mean - spread).max(0.0), (mean + spread).min(1.0)],
            claimed: None,
            worst_tenth: sorted.get(sorted.len() / 10).copied().unwrap_or(0.0),
            tenths: Vec::new(),
            chances,
        }
    }

    /// Takes note of what the recommender said of its shots; where it found none, that is a miss.
    pub fn claim(&mut self, claimed: &[Option<f64>]) {
        let said: f64 = claimed.iter().flatten().sum();
        self.claimed = Some(said / claimed.len().max(1) as f64);
        let tenth = |said: f64| ((10.0 * said) as usize).min(9);
        self.tenths = (0..10)
            .filter_map(|which| {
                let said = claimed.iter().map(|said| said.unwrap_or(0.0)).zip(&self.chances);
                let among: Vec<_> = said.filter(|(said, _)| tenth(*said) == which).collect();
                let mean = |sum: f64| sum / among.len() as f64;
                (!among.is_empty()).then(|| Tenth {
                    layouts: among.len(),
                    claimed: mean(among.iter().map(|(said, _)| said).sum()),
                    made: mean(among.iter().map(|(_, made)| **made).sum()),
                })
            })
            .collect();
    }
}

impl fmt::Display for Robustness {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [low, high] = self.make_interval.map(|end| 100.0 * end);
        write!(
            formatter,
            "a player of skill \"{}\" (doubt \"{}\") makes them {:.2} % of the time (95 % interval {low:.2} to {high:.2} %), on a tenth of \
             the layouts less than {:.1} %",
            self.skill,
            self.doubt,
            100.0 * self.make_probability,
            100.0 * self.worst_tenth
        )?;
        match self.claimed {
            Some(claimed) => write!(formatter, "; the recommender says {:.2} %", 100.0 * claimed)?,
            None => return Ok(()),
        }
        for Tenth { layouts, claimed, made } in &self.tenths {
            write!(formatter, "\nsaid {:.1} %, made {:.1} % ({layouts} layouts)", 100.0 * claimed, 100.0 * made)?;
        }
        Ok(())
    }
}
