//! Requests to the coach, the handling of its answers, and the background analysis of the displayed shot.

use std::sync::{
    Arc,
    atomic::{AtomicBool, Ordering},
};

use crate::{
    coach::{Cause, NO_MATCHING_ATTEMPT, Why},
    game::Point,
    physics::CueInputs,
    table::BALLS,
    terminal::{
        Advice, AdviceState, CoachAnswer, CoachEvent, CoachJob, CoachQuery, Effect, Effort, Mode, Proposal, Shot,
        Terms,
        pages::{
            Page,
            coach::{Choice, CoachPage, Snapshot, own_stroke::DEFAULT_TRIALS},
        },
        ui::Message,
        words::{chance_words, named_skill, skill_word},
    },
};

/// A request that the coach has not answered yet.
#[derive(Debug)]
pub struct PendingRequest {
    id: u64,
    cancel: Arc<AtomicBool>,
    /// The query of this request. The page's query may have changed since then.
    pub query: CoachQuery,
    /// Time since the request, s.
    pub elapsed: f64,
    /// The best shot so far.
    pub best_so_far: Option<Proposal>,
}

/// A background analysis of a shot that is running.
#[derive(Debug)]
pub struct RunningAnalysis {
    id: u64,
    cancel: Arc<AtomicBool>,
    shot: Arc<Shot>,
}

impl CoachPage {
    pub(super) fn request_advice(&mut self) -> Effect {
        self.playback.pause();
        self.leave_example();
        let former = self.current_advice().into_iter().flat_map(|advised| &advised.choices);
        let former = former.map(|choice| choice.proposal.shot.cue).collect();
        let job = CoachJob { former, ..self.new_job(None) };
        let (cancel, query) = (Arc::clone(&job.cancel), job.query.clone());
        self.pending = Some(PendingRequest { id: job.id, cancel, query, elapsed: 0.0, best_so_far: None });
        Effect::AskCoach(Box::new(job))
    }

    pub(super) fn new_job(&mut self, shot: Option<CueInputs>) -> CoachJob {
        self.job_count += 1;
        CoachJob {
            id: self.job_count,
            table: self.table().clone(),
            layout: *self.layout(),
            query: self.query.clone(),
            former: Vec::new(),
            shot,
            found: None,
            stroke: None,
            budget: self.budget,
            seed: self.job_count,
            cancel: Arc::default(),
        }
    }

    /// Cancels the pending request; the best shot so far is kept, and its analysis begins with a success rate of its own.
    pub(super) fn cancel(&mut self) {
        let Some(pending) = self.pending.take() else { return };
        pending.cancel.store(true, Ordering::Relaxed);
        let mut words = "the coach has stopped thinking".to_owned();
        if let Some(so_far) = pending.best_so_far {
            if pending.query == self.query {
                words += "; this is the best shot so far";
            }
            self.store_advice(
                pending.query,
                Advice { proposals: vec![so_far], seed: pending.id, effort: None, found: None },
            );
        }
        self.message = Some(Message::plain(words));
    }

    /// Handles an answer from the coach's worker thread. Late answers to cancelled requests are dropped.
    pub fn receive(&mut self, answer: CoachAnswer) -> Option<Effect> {
        let (names, point) = (self.cue_ball().names(), self.point());
        let awaited = self.pending.as_mut().filter(|pending| pending.id == answer.id);
        let is_study = self.running_analysis.as_ref().is_some_and(|running_analysis| running_analysis.id == answer.id);
        match (answer.event, awaited) {
            (CoachEvent::Better(proposal), Some(pending)) => {
                pending.best_so_far = Some(proposal);
                if pending.query == self.query {
                    self.watch_from_start();
                }
            }
            (CoachEvent::Advice(advice), Some(pending)) => {
                let query = pending.query.clone();
                self.pending = None;
                self.message = if query == self.query {
                    advice.proposals.first().map(|best| proposal_message(best, advice.effort, &query, point, names))
                } else {
                    let [asked, now] = [query.skill, self.query.skill].map(skill_word);
                    Some(Message::plain(format!("this answer is for {asked}; Enter asks for {now}")))
                };
                self.store_advice(query, advice);
            }
            (CoachEvent::Refused(sentence), Some(_)) => {
                self.cancel();
                self.message = Some(Message::warning(sentence));
            }
            (CoachEvent::Why(why), _) if is_study => {
                if let Some((reason, _)) = self.analysed_shot() {
                    *reason = Some(*why);
                }
            }
            (CoachEvent::Analysis(study), _) if is_study => {
                if let Some((_, choice)) = self.analysed_shot() {
                    choice.study = Some(study);
                }
            }
            (CoachEvent::StrokeRated(made), _) if is_study => {
                if let Some((_, choice)) = self.analysed_shot() {
                    (choice.proposal.made, choice.proposal.is_early) = (Some(made), false);
                }
            }
            (CoachEvent::StrokeRated(made), _) => {
                if let Some(own) = &mut self.own_stroke {
                    own.what_if.set_rate(answer.id, made);
                }
            }
            (CoachEvent::Next(next), _) if is_study => {
                if let Some((_, choice)) = self.analysed_shot() {
                    (choice.next, choice.is_analysed) = (next, true);
                }
                self.running_analysis = None;
            }
            _ => {}
        }
        self.refresh_lesson();
        self.study()
    }

    /// The shot under analysis, and the explanation of its advice's ranking, for storing results. Another shot may be displayed by now.
    /// `None` if the advice no longer exists.
    fn analysed_shot(&mut self) -> Option<(&mut Option<Why>, &mut Choice)> {
        let shot = &self.running_analysis.as_ref()?.shot;
        self.history.present_mut().advised.iter_mut().find_map(|AdviceState { why, choices, .. }| {
            Some((why, choices.iter_mut().find(|choice| Arc::ptr_eq(&choice.proposal.shot, shot))?))
        })
    }

    /// Whether the message contains nothing but the success rate of the first shot.
    pub(super) fn is_only_success_rate(&self, message: &Message) -> bool {
        let best = self.current_advice().and_then(|advised| advised.choices.first());
        let chance = best.and_then(|choice| chance(&choice.proposal, &self.query));
        chance.is_some_and(|chance| message.text == made_words(&self.query, &chance))
    }

    /// Stores the advice that answers `query`. If that is the current query, shows its best shot.
    fn store_advice(&mut self, query: CoachQuery, advice: Advice) {
        let is_asked = query == self.query;
        let advised = &mut self.history.present_mut().advised;
        advised.retain(|known| known.query != query);
        advised.extend(AdviceState::new(query, advice));
        if is_asked {
            self.watch_from_start();
        }
    }

    pub(super) fn watch_from_start(&mut self) {
        self.playback.seek(0.0);
        self.mode = Mode::Watching;
    }

    /// Starts the background analysis of the displayed shot, if it is incomplete, and cancels the analysis of any other shot. While the
    /// player has an own stroke, no analysis runs.
    pub fn study(&mut self) -> Option<Effect> {
        let advised = self.current_advice().filter(|_| self.pending.is_none() && self.own_stroke.is_none());
        let wanted = advised.map(AdviceState::choice).filter(|choice| !choice.is_analysed);
        let wanted = wanted.map(|choice| Arc::clone(&choice.proposal.shot));
        if let (Some(running_analysis), Some(shot)) = (&self.running_analysis, &wanted)
            && Arc::ptr_eq(&running_analysis.shot, shot)
        {
            return None;
        }
        if let Some(old) = self.running_analysis.take() {
            old.cancel.store(true, Ordering::Relaxed);
        }
        let shot = wanted?;
        let job = self.new_job(Some(shot.cue));
        let advised = self.current_advice()?;
        let found = advised.unexplained_search().cloned();
        // The rate of a search that was stopped flatters the shot, which was selected by it: other attempts judge the shot first.
        let job = if advised.choice().proposal.is_early {
            CoachJob { stroke: Some((shot.cue, 0..DEFAULT_TRIALS)), seed: advised.seed, ..job }
        } else {
            CoachJob { found, ..job }
        };
        self.running_analysis = Some(RunningAnalysis { id: job.id, cancel: Arc::clone(&job.cancel), shot });
        Some(Effect::AskCoach(Box::new(job)))
    }

    /// The conditions of a point under the rule of the present query.
    fn point(&self) -> Point {
        Point::of(self.query.rule, self.table(), self.layout())
    }

    pub(super) fn choose_shot(&mut self, choose: impl FnOnce(&mut AdviceState)) {
        let (names, point) = (self.cue_ball().names(), self.point());
        if let Some(advised) = self.current_advice_mut() {
            choose(advised);
            let words = format!("shot {} of {}", advised.chosen + 1, advised.choices.len());
            let proposal = &advised.choice().proposal;
            self.message = Some(match chance(proposal, &advised.query) {
                // The panel above the list names the player, and the status line has only one row.
                Some(chance) => Message::good(format!("{words}: {chance}")),
                None => proposal_message(proposal, None, &advised.query, point, names).prefixed(&words),
            });
        }
        self.leave_example();
        self.watch_from_start();
    }

    pub(super) fn continue_from_end(&mut self) -> Option<Effect> {
        let choice = self.current_advice()?.choice();
        let (end, next) = (choice.proposal.shot.recording.final_layout(), choice.next.clone());
        if let Err(error) = end.validate(self.table()) {
            return self.refuse(error);
        }
        self.set_layout(end);
        let Some(next) = next else { return Some(self.request_advice()) };
        self.message = next
            .proposals
            .first()
            .map(|best| proposal_message(best, None, &self.query, self.point(), self.cue_ball().names()));
        self.store_advice(self.query.clone(), next);
        None
    }

    /// Changes the query terms and reports the change. A shot for other terms is hidden until these terms are chosen again or the
    /// step is undone.
    pub(super) fn choose_terms(&mut self, terms: Terms) {
        let (before, had_shot) = (self.query.terms(), self.proposal().is_some());
        self.change_terms(terms);
        self.report_terms(before, had_shot);
    }

    /// Changes the query terms, as an undoable step.
    pub(super) fn change_terms(&mut self, terms: Terms) {
        let terms = [self.query.terms(), terms];
        self.history.push(Snapshot { terms: Some(terms), ..self.history.present().clone() });
        self.query = self.query.with(terms[1]);
        self.reset_playback();
    }

    /// Reports how the query terms differ from `before`, if they do. Shows the shot for the new terms if it is known; otherwise the
    /// message says how to get one.
    pub(super) fn report_terms(&mut self, before: Terms, had_shot: bool) {
        let words = self.query.terms().changes_since(before, self.cue_ball().names());
        if words.is_empty() {
            return;
        }
        let hint = if self.displayed_advice().is_some() {
            self.watch_from_start();
            "its shot is shown"
        } else if had_shot {
            "Enter asks the coach, u undoes it"
        } else {
            "Enter asks the coach"
        };
        self.message = Some(Message::plain(format!("{words}; {hint}")));
    }
}

/// A sentence with the success rate `chance` of the player.
fn made_words(query: &CoachQuery, chance: &str) -> String {
    match named_skill(query.skill) {
        Some(name) => format!("{name} makes it {chance}"),
        None => format!("you make it {chance}"),
    }
}

/// Describes a proposal in a sentence. `point` are the conditions of a point, `names` are the names of the balls, the cue ball first.
fn proposal_message(
    proposal: &Proposal,
    effort: Option<Effort>,
    query: &CoachQuery,
    point: Point,
    names: [&'static str; BALLS],
) -> Message {
    let shot = &proposal.shot;
    let took = effort.map_or(String::new(), |effort| match effort.elapsed.as_millis() {
        0 => ", under 1 ms".to_owned(),
        milliseconds => format!(", {milliseconds} ms"),
    });
    if !shot.solved {
        let tried = effort.map_or(String::new(), |effort| format!(" in {} simulations", effort.simulations));
        let source = &shot.source;
        let begins = query.first.opening_words(names);
        let without = if query.jumps { "" } else { " without jumps and massés" };
        if let Some(rule) = query.first.forbidden_by(point) {
            return Message::poor(format!("there is no point{begins}: {rule}"));
        }
        let keeps_wish = query.first.allows_words(&shot.words);
        let attempt = if keeps_wish { "this is the best attempt" } else { NO_MATCHING_ATTEMPT };
        return Message::poor(format!("no point found{begins}{without}{tried}; {attempt} ({source}{took})"));
    }
    let Some(chance) = chance(proposal, query) else {
        return Message::good(format!("makes the point ({}{took})", shot.source));
    };
    let cause = match proposal.risk.and_then(|risk| risk.main_cause(proposal.made.map(|made| 1.0 - made.rate))) {
        Some(Cause::Table) => "; the table is the main risk: F7 measures it",
        Some(Cause::Placing) => "; the ball positions are the main risk",
        Some(Cause::Hand) | None => "",
    };
    let forbidden = if query.jumps { "" } else { "; jumps are off" };
    Message::good(format!("{}{cause}{forbidden}", made_words(query, &chance)))
}

/// The success rate of a shot in words; `None` if it is not solved or the player makes no errors.
fn chance(proposal: &Proposal, query: &CoachQuery) -> Option<String> {
    proposal.made.filter(|_| proposal.shot.solved && !query.skill.is_perfect()).as_ref().map(chance_words)
}
