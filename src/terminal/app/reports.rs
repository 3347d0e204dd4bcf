//! Reports from the background, and their messages: sentences on the status line, refusals and failures as toasts.

use crate::terminal::{App, CalibrationReport, CoachAnswer, DrillReport, DrillTask, Effect, PageId, TrainingReport};

impl App {
    /// The coach has something to say. Late answers to cancelled questions are dropped.
    pub fn receive(&mut self, answer: CoachAnswer) -> Option<Effect> {
        let was_thinking = self.coach.spinner().is_some();
        let effect = self.coach.receive(answer);
        if was_thinking && self.coach.spinner().is_none() {
            // What was refused because the coach was thinking is not so any more.
            self.toasts.go_on();
        }
        self.collect_toasts(false);
        effect
    }

    /// The thread that thinks is gone, and with it the answer.
    pub fn coach_lost(&mut self) {
        self.coach.lost();
        self.collect_toasts(false);
    }

    /// A report from the training page's background tasks.
    pub fn receive_training(&mut self, report: TrainingReport) {
        if let Some((table, query)) = self.training.receive(report) {
            self.coach.take_query(&table, query);
            self.training.alone = false;
            // Who has gone elsewhere meanwhile stays there.
            if self.screen == PageId::Training {
                self.turn_to(PageId::Coach);
            }
        }
        self.collect_toasts(false);
    }

    /// Something has come of a task of the drill screens, or the coach's position is saved; gives what is to be done next.
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
        self.coach.own = self.drills.player.own.or(self.coach.own);
        self.collect_toasts(false);
        tasks
    }

    /// Something has come of a task of the calibration's page.
    pub fn receive_calibration(&mut self, report: CalibrationReport) -> Option<Effect> {
        let tasks = self.calibration.receive(report);
        self.collect_toasts(false);
        (!tasks.is_empty()).then_some(Effect::Calibrate(tasks))
    }

    /// Makes toasts of what is refused or has failed since: the answer to a key, or something that came by itself.
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

    /// Something around the screen has failed.
    pub fn failed(&mut self, sentence: String) {
        self.toasts.push(sentence, false);
    }
}
