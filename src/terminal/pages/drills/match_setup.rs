//! What the user chooses before a match against the coach.

use crate::{
    coach::Skill,
    drills::{Exercise, Goal},
    game::Rule,
    terminal::pages::neighbour,
};

/// Numbers of points to choose from, 0 for none.
const DISTANCES: [u32; 12] = [0, 5, 10, 15, 20, 25, 30, 35, 40, 50, 75, 100];
/// Limits of innings to choose from, 0 for none.
const LIMITS: [u32; 10] = [0, 5, 10, 15, 20, 25, 30, 35, 40, 50];

/// A line of the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MatchField {
    /// What counts as a point.
    Rule,
    /// The points that win.
    Distance,
    /// The limit of innings.
    Innings,
    /// The coach's skill.
    Level,
}

impl MatchField {
    /// All lines, from top to bottom.
    pub const ALL: [Self; 4] = [Self::Rule, Self::Distance, Self::Innings, Self::Level];
}

/// The choices for the next match. They stay while the program runs.
#[derive(Clone, Copy, Debug)]
pub struct MatchSetup {
    /// The marked line.
    pub field: MatchField,
    /// What counts as a point.
    pub rule: Rule,
    /// The points that win, 0 for none.
    pub points: u32,
    /// The limit of innings, 0 for none.
    pub innings: u32,
    /// The coach's skill; `None` if it is the player's.
    pub level: Option<Skill>,
}

impl Default for MatchSetup {
    fn default() -> Self {
        Self { field: MatchField::Distance, rule: Rule::ThreeCushion, points: 15, innings: 0, level: None }
    }
}

impl MatchSetup {
    /// Moves the mark by `lines`, downwards if positive.
    pub(super) fn move_mark(&mut self, lines: isize) {
        self.field = neighbour(&MatchField::ALL, self.field, lines);
    }

    /// Chooses the value `step` further on in the marked line.
    pub(super) fn choose(&mut self, step: isize) {
        match self.field {
            MatchField::Rule => self.rule = neighbour(&Rule::ALL, self.rule, step),
            MatchField::Distance => self.points = neighbour(&DISTANCES, self.points, step),
            MatchField::Innings => self.innings = neighbour(&LIMITS, self.innings, step),
            MatchField::Level => {
                let named = Skill::NAMED.iter().rev().map(|(_, skill)| Some(*skill));
                let levels: Vec<Option<Skill>> = std::iter::once(None).chain(named).collect();
                self.level = neighbour(&levels, self.level, step);
            }
        }
    }

    /// The goal of the match.
    pub(super) const fn goal(&self) -> Goal {
        Goal::Match { innings: self.innings, points: self.points, against_coach: true }
    }

    /// The first position of the match, with its rule. `opening` is the exercise of the opening at three-cushion.
    pub(super) fn exercise(&self, opening: Exercise) -> Exercise {
        if self.rule == opening.rule {
            return opening;
        }
        // The lesson, the model shot and the grade are for three cushions.
        let Exercise { name, title, table, layout, .. } = opening;
        // Under its own name, so that nothing of it counts as the opening at three-cushion.
        let name = format!("{name}-{}", self.rule.name());
        Exercise { title, ..Exercise::new_own(&name, self.rule, &table, layout) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::{Layout, Table};

    #[test]
    fn every_distance_limit_and_level_can_be_chosen() {
        let mut setup = MatchSetup::default();
        let mut chosen = Vec::new();
        for _ in 0..=Skill::NAMED.len() {
            setup.field = MatchField::Level;
            setup.choose(1);
            chosen.push(setup.level);
        }
        assert_eq!((chosen[0], chosen.last()), (Some(Skill::BEGINNER), Some(&None)));
        assert!(Skill::NAMED.iter().all(|(_, skill)| chosen.contains(&Some(*skill))));
        setup.move_mark(-1);
        setup.choose(-1);
        assert_eq!((setup.field, setup.innings), (MatchField::Innings, 50), "the choices are a cycle");
        setup.move_mark(-1);
        setup.choose(3);
        assert_eq!(setup.goal(), Goal::Match { innings: 50, points: 30, against_coach: true });
    }

    /// Regression test: attempts under another rule counted for the exercise at three-cushion.
    #[test]
    fn the_opening_under_another_rule_is_another_exercise() {
        let opening = Exercise::new_own("opening", Rule::ThreeCushion, "match", Layout::opening(&Table::default()));
        let mut setup = MatchSetup::default();
        assert_eq!(setup.exercise(opening.clone()), opening);
        setup.rule = Rule::StraightRail;
        let other = setup.exercise(opening.clone());
        assert_eq!((other.name.as_str(), other.rule, other.layout), ("opening-straight", setup.rule, opening.layout));
    }
}
