//! Terms of a question to the coach that keys of the coach's page change.

use serde::{Deserialize, Serialize};

use crate::{
    coach::{FirstContact, Skill},
    game::Rule,
    table::BALLS,
    terminal::words::player_words,
};

/// What the player changes with a key: the rule, the skill, whether the next point counts too, and what the cue ball meets first.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Terms {
    /// What counts as a point.
    pub rule: Rule,
    /// Skill of the player of the shot.
    pub skill: Skill,
    /// Whether the next point counts too.
    pub plan: bool,
    /// What the cue ball has to meet first. It applies to the present question only and is never saved.
    #[serde(skip)]
    pub first: FirstContact,
}

impl Terms {
    /// Keys of the settings whose present values the next session keeps, unless the settings file changes.
    pub const KEPT: [&str; 3] = ["rule", "skill", "plan"];

    /// Applies the changes from `before` to `now` to `self`. A term of `self` that differs from `before` stays.
    #[must_use]
    pub fn with_change(self, [before, now]: [Self; 2]) -> Self {
        Self {
            rule: if self.rule == before.rule { now.rule } else { self.rule },
            skill: if self.skill == before.skill { now.skill } else { self.skill },
            plan: if self.plan == before.plan { now.plan } else { self.plan },
            first: if self.first == before.first { now.first } else { self.first },
        }
    }

    /// Describes in words what differs from `before`; empty if nothing does. `names` are the names of the balls, the cue ball first.
    pub fn changes_since(self, before: Self, names: [&'static str; BALLS]) -> String {
        let plan = if self.plan { "the next point counts too" } else { "only this point counts" };
        let news = [
            (self.rule != before.rule).then(|| format!("what counts: {}", self.rule)),
            (self.skill != before.skill).then(|| format!("the player: {}", player_words(self.skill))),
            (self.plan != before.plan).then(|| plan.to_owned()),
            (self.first != before.first).then(|| format!("hit first: {}", self.first.word(names))),
        ];
        news.into_iter().flatten().collect::<Vec<_>>().join("; ")
    }
}
