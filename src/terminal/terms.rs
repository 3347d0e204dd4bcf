//! What the coach is asked for, as far as a key of the coach's page turns it.

use serde::{Deserialize, Serialize};

use crate::{coach::Skill, game::Rule, terminal::words::player_words};

/// What the player turns with a key: what counts, who plays, and whether the next point counts too.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Terms {
    /// What counts as a point.
    pub rule: Rule,
    /// Who is to play the shot.
    pub skill: Skill,
    /// Whether the next point counts too.
    pub plan: bool,
}

impl Terms {
    /// The same after a change from `before` to `now`; what is neither of it stays.
    #[must_use]
    pub fn after(self, [before, now]: [Self; 2]) -> Self {
        Self {
            rule: if self.rule == before.rule { now.rule } else { self.rule },
            skill: if self.skill == before.skill { now.skill } else { self.skill },
            plan: if self.plan == before.plan { now.plan } else { self.plan },
        }
    }

    /// What is otherwise than in `before`, in words; empty where nothing is.
    pub fn news_since(self, before: Self) -> String {
        let plan = if self.plan { "the next point counts too" } else { "only this point counts" };
        let news = [
            (self.rule != before.rule).then(|| format!("what counts: {}", self.rule)),
            (self.skill != before.skill).then(|| format!("the player: {}", player_words(self.skill))),
            (self.plan != before.plan).then(|| plan.to_owned()),
        ];
        news.into_iter().flatten().collect::<Vec<_>>().join("; ")
    }
}
