//! What the coach is asked for, as far as a key of the coach's page turns it.

use serde::{Deserialize, Serialize};

use crate::{
    coach::{FirstMet, Skill},
    game::Rule,
    table::BALLS,
    terminal::words::player_words,
};

/// What the player turns with a key: what counts, who plays, whether the next point counts too, and how the shot begins.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Terms {
    /// What counts as a point.
    pub rule: Rule,
    /// Who is to play the shot.
    pub skill: Skill,
    /// Whether the next point counts too.
    pub plan: bool,
    /// What the cue ball is to meet first: a wish of the moment, which no file keeps.
    #[serde(skip)]
    pub first: FirstMet,
}

impl Terms {
    /// The same after a change from `before` to `now`; what is neither of it stays.
    #[must_use]
    pub fn with_change(self, [before, now]: [Self; 2]) -> Self {
        Self {
            rule: if self.rule == before.rule { now.rule } else { self.rule },
            skill: if self.skill == before.skill { now.skill } else { self.skill },
            plan: if self.plan == before.plan { now.plan } else { self.plan },
            first: if self.first == before.first { now.first } else { self.first },
        }
    }

    /// What is otherwise than in `before`, in words, where the balls are called so, the cue ball first; empty where nothing is.
    pub fn news_since(self, before: Self, names: [&'static str; BALLS]) -> String {
        let plan = if self.plan { "the next point counts too" } else { "only this point counts" };
        let news = [
            (self.rule != before.rule).then(|| format!("what counts: {}", self.rule)),
            (self.skill != before.skill).then(|| format!("the player: {}", player_words(self.skill))),
            (self.plan != before.plan).then(|| plan.to_owned()),
            (self.first != before.first).then(|| format!("met first: {}", self.first.word(names))),
        ];
        news.into_iter().flatten().collect::<Vec<_>>().join("; ")
    }
}
