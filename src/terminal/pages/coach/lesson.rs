//! The lesson on diamond systems over the coach's table: one system after the other, with the shot's own numbers where one
//! applies to it, else with an example's.

use std::sync::Arc;

use glam::DVec2;

use crate::{
    coach::systems::{Applied, Guide, System},
    table::Table,
    terminal::{AdviceState, pages::coach::CoachPage},
};

/// A system as it is shown.
#[derive(Clone, Debug)]
pub struct Lesson {
    /// The numbers and the line.
    pub applied: Applied,
    /// Whether they are those of the shot that is shown.
    pub is_of_shot: bool,
    /// The way of a ball that is played so, m.
    pub path: Vec<DVec2>,
    /// The table on which it is.
    pub table: Arc<Table>,
}

impl CoachPage {
    /// The lesson, while it is open.
    pub const fn lesson(&self) -> Option<&Lesson> {
        self.lesson.as_ref()
    }

    /// What a player counts for the shot that is shown, once that is known.
    pub fn guide(&self) -> Option<&Guide> {
        self.shown().map(AdviceState::choice)?.study.as_ref()?.system.as_ref()
    }

    /// Opens the lesson at the system of the shot, goes on to the next one, and closes it after the last.
    pub(super) fn next_lesson(&mut self) {
        let mut order: Vec<System> = System::ALL.to_vec();
        if let Some(Guide::System(applied)) = self.guide() {
            order.retain(|system| *system != applied.system);
            order.insert(0, applied.system);
        }
        let next = match &self.lesson {
            None => order.first(),
            Some(lesson) => {
                let shown = order.iter().position(|system| *system == lesson.applied.system);
                order.get(shown.map_or(order.len(), |place| place + 1))
            }
        };
        self.lesson = next.and_then(|system| self.lesson_on(*system));
    }

    /// Keeps the lesson's numbers those of the shot that is shown, on the table that is played on.
    pub(super) fn renew_lesson(&mut self) {
        let Some(lesson) = &self.lesson else { return };
        let current = self.of_shot(lesson.applied.system);
        let is_other = !Arc::ptr_eq(&lesson.table, &self.balls.present().table)
            || lesson.is_of_shot != current.is_some()
            || current.is_some_and(|applied| *applied != lesson.applied);
        if is_other {
            self.lesson = self.lesson_on(lesson.applied.system);
        }
    }

    fn of_shot(&self, system: System) -> Option<&Applied> {
        match self.guide()? {
            Guide::System(applied) if applied.system == system => Some(applied),
            _ => None,
        }
    }

    fn lesson_on(&self, system: System) -> Option<Lesson> {
        let own = self.of_shot(system).cloned();
        let is_of_shot = own.is_some();
        let applied = own.or_else(|| Applied::example(system, self.table()))?;
        let table = Arc::clone(&self.balls.present().table);
        Some(Lesson { path: applied.path(&table), applied, is_of_shot, table })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        table::Layout,
        terminal::{CoachAction, CoachQuery},
    };

    #[test]
    fn an_example_is_of_the_table_that_is_played_on() {
        let [first, second] = ["match", "textbook"].map(|name| Table::preset(name).unwrap());
        let mut page = CoachPage::new(first.clone(), Layout::opening(&first), 1).unwrap();
        page.update(CoachAction::NextSystem);
        let before = page.lesson().unwrap().path.clone();
        page.take_query(&second, CoachQuery::default());
        assert_ne!(page.lesson().unwrap().path, before);
        assert_eq!(*page.lesson().unwrap().table, second);
    }
}
