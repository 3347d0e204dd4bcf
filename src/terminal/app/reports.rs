//! Reports from background tasks. Their messages appear on the status line; refusals and failures appear as toasts.

use crate::terminal::{App, CalibrationReport, CoachAnswer, DrillReport, DrillTask, Effect, PageId, TrainingReport};

impl App {
    /// Handles an answer of the coach. Late answers to cancelled questions are dropped.
    pub fn receive(&mut self, answer: CoachAnswer) -> Option<Effect> {
        let was_thinking = self.coach.spinner().is_some();
        let effect = self.coach.receive(answer);
        if was_thinking && self.coach.spinner().is_none() {
            // Refusals because the coach was thinking no longer apply.
            self.toasts.dismiss_answers();
        }
        self.collect_toasts(false);
        effect
    }

    /// Handles the loss of the coach's worker thread, and with it the answer.
    pub fn coach_failed(&mut self) {
        self.coach.handle_worker_loss();
        self.collect_toasts(false);
    }

    /// Handles a report from the training page's background tasks.
    pub fn receive_training(&mut self, report: TrainingReport) {
        if let Some((table, query)) = self.training.receive(report) {
            self.coach.set_query(&table, query);
            self.training.is_only_page = false;
            // If the user has opened another screen meanwhile, it stays open.
            if self.screen == PageId::Training {
                self.switch_to(PageId::Coach);
            }
        }
        self.collect_toasts(false);
    }

    /// Handles the report of a drill task, or of saving the coach's position. Returns the tasks to run next.
    pub fn receive_drill(&mut self, report: DrillReport) -> Vec<DrillTask> {
        let report = match report {
            DrillReport::PositionSaved(exercise, outcome) if self.coach.has_saved(&exercise.name) => {
                self.coach.saved(exercise, outcome);
                self.collect_toasts(false);
                return Vec::new();
            }
            other => other,
        };
        let known = self.drills.book.troubles.clone();
        let tasks = self.drills.receive(report);
        let troubles = self.drills.book.troubles.iter().filter(|trouble| !known.contains(trouble));
        self.toasts.push_first(&troubles.cloned().collect::<Vec<_>>());
        self.coach.own_skill = self.drills.player.own_skill.or(self.coach.own_skill);
        self.collect_toasts(false);
        tasks
    }

    /// Handles the report of a calibration task.
    pub fn receive_calibration(&mut self, report: CalibrationReport) -> Option<Effect> {
        let tasks = self.calibration.receive(report);
        self.collect_toasts(false);
        (!tasks.is_empty()).then_some(Effect::Calibrate(tasks))
    }

    /// Turns the pages' warnings into toasts. `is_answer`: whether they answer a key press, or came on their own.
    pub(super) fn collect_toasts(&mut self, is_answer: bool) {
        let Self { coach, training, drills, settings, calibration, toasts, .. } = self;
        let messages = [
            &mut coach.message,
            &mut training.message,
            &mut drills.message,
            &mut settings.message,
            &mut calibration.message,
        ];
        for message in messages {
            if let Some(message) = message.take_if(|message| message.is_warning()) {
                toasts.push(message.text, is_answer);
            }
        }
    }

    /// Reports a failure outside the screens.
    pub fn report_failure(&mut self, sentence: String) {
        self.toasts.push(sentence, false);
    }
}
