//! The lesson on diamond systems on the coach's table. It goes through the systems one by one. A system that applies to the shot is
//! shown with the shot's numbers, any other with an example.

use std::sync::Arc;

use glam::DVec2;

use crate::{
    coach::systems::{Applied, Guide, System},
    table::Table,
    terminal::{AdviceState, pages::coach::CoachPage},
};

/// A diamond system or a parallel shift, as displayed.
#[derive(Clone, Debug)]
pub struct Lesson {
    /// The system or shift with its numbers.
    pub guide: Guide,
    /// Whether the numbers belong to the displayed shot; otherwise they are an example.
    pub is_of_shot: bool,
    /// Path of a ball that is played according to the system, m.
    pub path: Vec<DVec2>,
    /// The table for which the path was computed.
    pub table: Arc<Table>,
}

/// Returns the system of a guide; `None` for a parallel shift.
const fn system_of(guide: &Guide) -> Option<System> {
    match guide {
        Guide::System(applied) => Some(applied.system),
        Guide::Shift(_) => None,
    }
}

impl CoachPage {
    /// The system or shift for the displayed shot; `None` until its analysis is there, or if none applies.
    pub fn guide(&self) -> Option<&Guide> {
        self.displayed_advice().map(AdviceState::choice)?.study.as_ref()?.system.as_ref()
    }

    /// Whether the analysis has found that no system applies to the displayed shot.
    pub fn has_no_system(&self) -> bool {
        let study = self.displayed_advice().and_then(|advised| advised.choice().study.as_ref());
        study.is_some_and(|study| study.system.is_none())
    }

    /// Opens the lesson with the shot's own system, steps to the next system, and closes the lesson after the last one.
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

    /// Closes the lesson if it shows an example, because an example hides the shot.
    pub(super) fn leave_example(&mut self) {
        self.lesson.take_if(|lesson| !lesson.is_of_shot);
    }

    /// Updates the lesson to the displayed shot and the current table.
    pub(super) fn refresh_lesson(&mut self) {
        let Some(lesson) = &self.lesson else { return };
        let current = self.guide_of_shot(system_of(&lesson.guide));
        let is_other = !Arc::ptr_eq(&lesson.table, &self.history.present().table)
            || lesson.is_of_shot != current.is_some()
            || current.is_some_and(|guide| *guide != lesson.guide);
        if is_other {
            // An example hides the balls, so it must not appear unless the user asked for it.
            let was_of_shot = lesson.is_of_shot;
            self.lesson = self.lesson_on(system_of(&lesson.guide)).filter(|lesson| lesson.is_of_shot || !was_of_shot);
        }
    }

    fn guide_of_shot(&self, system: Option<System>) -> Option<&Guide> {
        self.guide().filter(|guide| system_of(guide) == system)
    }

    /// Returns the lesson on a system, or on the parallel shift if `None`. A shift always belongs to the shot; a system can also be
    /// shown with an example.
    fn lesson_on(&self, system: Option<System>) -> Option<Lesson> {
        let own = self.guide_of_shot(system).cloned();
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
    fn example_is_recomputed_for_the_current_table() {
        let [first, second] = ["match", "textbook"].map(|name| Table::preset(name).unwrap());
        let mut page = CoachPage::new(first.clone(), Layout::opening(&first), 1).unwrap();
        page.update(CoachAction::NextSystem);
        let before = page.lesson.as_ref().unwrap().path.clone();
        page.set_query(&second, CoachQuery::default());
        assert_ne!(page.lesson.as_ref().unwrap().path, before);
        assert_eq!(*page.lesson.as_ref().unwrap().table, second);
    }
}
