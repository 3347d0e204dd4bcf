//! The lesson on diamond systems over the coach's table: one system after the other, with the shot's own numbers where one
//! applies to it, else with an example's.

use std::sync::Arc;

use glam::DVec2;

use crate::{
    coach::systems::{Applied, Guide, System},
    table::Table,
    terminal::{AdviceState, pages::coach::CoachPage},
};

/// A system, or a parallel shift, as it is shown.
#[derive(Clone, Debug)]
pub struct Lesson {
    /// What is counted.
    pub guide: Guide,
    /// Whether they are those of the shot that is shown.
    pub is_of_shot: bool,
    /// The way of a ball that is played so, m.
    pub path: Vec<DVec2>,
    /// The table on which it is.
    pub table: Arc<Table>,
}

/// The system of which a guide is; `None` for a parallel shift.
const fn system_of(guide: &Guide) -> Option<System> {
    match guide {
        Guide::System(applied) => Some(applied.system),
        Guide::Shift(_) => None,
    }
}

impl CoachPage {
    /// What a player counts for the shot that is shown, once that is known.
    pub fn guide(&self) -> Option<&Guide> {
        self.shown().map(AdviceState::choice)?.study.as_ref()?.system.as_ref()
    }

    /// Whether it is known that nothing is counted for the shot that is shown.
    pub fn has_no_system(&self) -> bool {
        let study = self.shown().and_then(|advised| advised.choice().study.as_ref());
        study.is_some_and(|study| study.system.is_none())
    }

    /// Opens the lesson at what is counted for the shot, goes on to the next system, and closes it after the last.
    pub(super) fn next_lesson(&mut self) {
        let mut order: Vec<Option<System>> = System::ALL.map(Some).to_vec();
        if let Some(own) = self.guide().map(system_of) {
            order.retain(|system| *system != own);
            order.insert(0, own);
        }
        let next = match &self.lesson {
            None => order.first(),
            Some(lesson) => {
                let shown = order.iter().position(|system| *system == system_of(&lesson.guide));
                order.get(shown.map_or(order.len(), |place| place + 1))
            }
        };
        self.lesson = next.and_then(|system| self.lesson_on(*system));
    }

    /// Closes the lesson on an example, beside which the shot is not drawn.
    pub(super) fn leave_example(&mut self) {
        self.lesson.take_if(|lesson| !lesson.is_of_shot);
    }

    /// Keeps the lesson's numbers those of the shot that is shown, on the table that is played on.
    pub(super) fn renew_lesson(&mut self) {
        let Some(lesson) = &self.lesson else { return };
        let current = self.of_shot(system_of(&lesson.guide));
        let is_other = !Arc::ptr_eq(&lesson.table, &self.history.present().table)
            || lesson.is_of_shot != current.is_some()
            || current.is_some_and(|guide| *guide != lesson.guide);
        if is_other {
            // Beside an example no balls are drawn, so that one does not come unasked.
            let was_of_shot = lesson.is_of_shot;
            self.lesson = self.lesson_on(system_of(&lesson.guide)).filter(|lesson| lesson.is_of_shot || !was_of_shot);
        }
    }

    fn of_shot(&self, system: Option<System>) -> Option<&Guide> {
        self.guide().filter(|guide| system_of(guide) == system)
    }

    /// A shift is always the shot's; a system has an example besides.
    fn lesson_on(&self, system: Option<System>) -> Option<Lesson> {
        let own = self.of_shot(system).cloned();
        let is_of_shot = own.is_some();
        let guide = own.or_else(|| Applied::example(system?, self.table()).map(Guide::System))?;
        let table = Arc::clone(&self.history.present().table);
        Some(Lesson { path: guide.path(&table), guide, is_of_shot, table })
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
        let before = page.lesson.as_ref().unwrap().path.clone();
        page.take_query(&second, CoachQuery::default());
        assert_ne!(page.lesson.as_ref().unwrap().path, before);
        assert_eq!(*page.lesson.as_ref().unwrap().table, second);
    }
}
