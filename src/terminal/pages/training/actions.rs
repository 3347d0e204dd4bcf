//! Implementation of the training page's key actions, and their conditions.

use std::time::Instant;

use crate::{
    learning::{
        policy::library::SavePolicyError,
        run::{POLICY, follow::Condition as RunCondition, request::Request},
    },
    storage::is_name,
    terminal::{
        Effect, Launch, SavePolicyTask, TrainingAction as Action, TrainingCondition as Condition, TrainingContext,
        pages::{
            Page,
            training::{Form, NamedRun, Question, TrainingPage, Watch, name_in},
        },
        tasks::training::NO_POLICY,
        ui::Message,
    },
};

/// Whether a condition belongs to an action that starts or controls a run. Guests must not use these.
const fn controls_run(when: Condition) -> bool {
    matches!(
        when,
        Condition::CanTrain
            | Condition::MarkedResumable
            | Condition::Resumable
            | Condition::Active
            | Condition::Running
            | Condition::Paused
    )
}

impl TrainingPage {
    /// Returns the reason why a key binding is disabled now; `None` if it is enabled.
    pub fn disabled_reason(&self, when: Condition) -> Option<&'static str> {
        let refuse = |refused: bool, reason| refused.then_some(reason);
        if self.is_guest && controls_run(when) {
            return Some("guests can watch runs; only the owner of this machine starts or controls them");
        }
        let Some(watch) = &self.watch else {
            return match when {
                Condition::Always | Condition::CanTrain => None,
                Condition::Marked => refuse(self.list.marked().is_none(), "there is no run yet; n starts one"),
                Condition::MarkedResumable => self.refusal_of_marked(),
                _ => Some("no run is watched"),
            };
        };
        match when {
            Condition::Always | Condition::CanTrain => None,
            Condition::Marked => refuse(self.list.marked().is_none(), "there is no run yet"),
            Condition::MarkedResumable => self.refusal_of_marked(),
            Condition::HasChart => refuse(!watch.charts.any(), "no chart is shown; 1 to 9 show some"),
            Condition::Zoomed => refuse(!watch.charts.is_zoomed(), "all of the run is shown; + shows a part"),
            Condition::Paused => refuse(!watch.is_paused(), "the run is not paused"),
            Condition::Active | Condition::Running => {
                refuse(!watch.is_active(), "the run is not training; r resumes one that is unfinished")
                    .or(refuse(when == Condition::Running && watch.is_paused(), "the run is paused"))
            }
            Condition::Resumable => {
                refuse(self.is_launched(watch.folder()), "the run is being started").or(watch.resume_refusal())
            }
            Condition::RunExists => refuse(!watch.is_known(), "there is no run yet")
                .or(refuse(watch.condition() == RunCondition::Removed, "the run has been removed")),
            Condition::HasPolicy => self
                .disabled_reason(Condition::RunExists)
                .or(refuse(watch.lacks_config(), "config.json of the run cannot be read: its table is not known"))
                .or(refuse(!watch.has_policy, NO_POLICY)),
            Condition::HasReplay => {
                refuse(watch.replay.reel.is_none(), "no shots yet: they come with the first measurement")
            }
        }
    }

    /// The reason why the marked run cannot be resumed; `None` if it can.
    fn refusal_of_marked(&self) -> Option<&'static str> {
        let is_launched = self.list.marked().is_some_and(|run| self.is_launched(&run.folder));
        is_launched.then_some("the run is being started").or(self.list.resume_refusal())
    }

    /// Performs the action of an enabled key binding.
    pub fn update(&mut self, action: Action) -> Option<Effect> {
        match action {
            Action::Back => self.back(),
            Action::MoveMark(lines) => self.list.move_mark(lines),
            Action::ChooseRun => self.choose(),
            Action::NewRun => {
                self.form = Form::new();
                self.pages.push(TrainingContext::Form);
            }
            Action::Resume => return self.resume(),
            Action::MoveField(fields) => self.form.move_mark(fields),
            Action::ChangeValue(step) => self.form.choose(step, self.list.runs()),
            Action::Erase => self.form.erase(),
            Action::Start => return self.start(),
            Action::Answer(true) => return self.accept_answer(),
            Action::Answer(false) => self.question = None,
            other => return self.steer(other),
        }
        None
    }

    fn back(&mut self) {
        let is_watched = self.page() == TrainingContext::Watch;
        if is_watched && self.watch.as_mut().is_some_and(|watch| std::mem::take(&mut watch.charts.enlarged)) {
            return;
        }
        if self.pages.pop() == Some(TrainingContext::Watch) {
            self.watch = None;
        }
    }

    fn choose(&mut self) {
        let Some(folder) = self.list.marked().map(|run| run.folder.clone()) else { return };
        if self.page() != TrainingContext::Compare {
            self.show(&folder);
            return;
        }
        let Some(watch) = &mut self.watch else { return };
        if watch.folder() == folder {
            self.message = Some(Message::warning("a run cannot be compared with itself; choose another one"));
        } else {
            self.openings += 1;
            watch.other = Some(NamedRun::new(&folder, &self.places.runs, self.openings));
            self.pages.pop();
        }
    }

    /// Starts the run that the form describes. Asks for confirmation if the run is a long one.
    fn start(&mut self) -> Option<Effect> {
        if let Some((shots, seconds)) = self.form.long_run() {
            self.question = Some(Question::Long { shots, seconds });
            return None;
        }
        self.launch()
    }

    fn launch(&mut self) -> Option<Effect> {
        match self.form.launch(&self.folder) {
            Ok(launch) => {
                self.show(&launch.folder);
                self.launched = Some((launch.folder.clone(), Instant::now()));
                Some(Effect::Train(Box::new(launch)))
            }
            Err(sentence) => self.refuse(sentence),
        }
    }

    fn resume(&mut self) -> Option<Effect> {
        if self.page() == TrainingContext::Runs {
            let folder = self.list.marked()?.folder.clone();
            self.show(&folder);
        }
        let folder = self.watch.as_ref()?.folder().to_owned();
        self.message = Some(Message::plain("going on from the last checkpoint"));
        self.launched = Some((folder.clone(), Instant::now()));
        Some(Effect::Train(Box::new(Launch::resume(&folder))))
    }

    /// Performs an action on the watched run or on its display.
    fn steer(&mut self, action: Action) -> Option<Effect> {
        let Self { watch: Some(watch), question, message, .. } = self else { return None };
        let progress = watch.progress();
        let Watch { charts, replay, .. } = watch;
        match action {
            Action::ToggleChart(n) => charts.toggle(n),
            Action::SelectChart(steps) => charts.select(steps),
            Action::ToggleEnlarged => charts.enlarged = !charts.enlarged,
            Action::ToggleLogScale => charts.toggle_log(),
            Action::NextSmoothing => charts.smooth(),
            Action::Zoom(steps) => *message = charts.zoom(steps, progress).err().map(Message::warning),
            Action::Pan(steps) => charts.pan(steps, progress),
            Action::ShowAll => charts.show_all(),
            Action::FollowEnd => charts.follow_end(),
            Action::ToggleComparison if watch.other.is_some() => watch.other = None,
            Action::ToggleComparison => {
                self.list.mark_neighbour(&name_in(&self.folder, watch.folder()));
                self.pages.push(TrainingContext::Compare);
            }
            Action::Pause => {
                let request = if watch.is_paused() { Request::Resume } else { Request::Pause };
                return Some(Effect::Send(request, watch.folder().to_owned()));
            }
            Action::Stop => *question = Some(Question::Stop),
            Action::Abandon => *question = Some(Question::Abandon),
            Action::UsePolicy => return Some(Effect::LoadPolicy(watch.folder().to_owned())),
            Action::SavePolicy => *question = Some(Question::name(&watch.own.name)),
            Action::Play => replay.toggle(),
            Action::StepShot(shots) => replay.step(shots),
            _ => {}
        }
        None
    }

    fn accept_answer(&mut self) -> Option<Effect> {
        let question = self.question.take()?;
        // The run may have ended between the question and its answer.
        if let Some(reason) = self.disabled_reason(question.when()) {
            return self.refuse(reason);
        }
        let folder = self.watch.as_ref().map(|watch| watch.folder().to_owned());
        match question {
            Question::Long { .. } => self.launch(),
            Question::Stop => Some(Effect::Send(Request::Stop, folder?)),
            Question::Abandon => Some(Effect::Send(Request::Abandon, folder?)),
            Question::Replace(name) => Some(self.save_policy(name, true)),
            Question::Name(typed) => {
                let name = typed.text().trim().to_owned();
                if is_name(&name) {
                    return Some(self.save_policy(name, false));
                }
                self.question = Some(Question::Name(typed));
                self.refuse(SavePolicyError::Name(name))
            }
        }
    }

    fn save_policy(&self, name: String, replace: bool) -> Effect {
        let from = self.watch.as_ref().map(|watch| watch.folder().join(POLICY)).unwrap_or_default();
        let folder = self.places.policies.clone();
        Effect::SavePolicy(Box::new(SavePolicyTask { from, folder, name, replace }))
    }
}
