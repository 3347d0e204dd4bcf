//! Tasks of the drill screens: strokes are played and judged and files written, in order, on one thread.

use std::{
    collections::HashMap,
    panic::{AssertUnwindSafe, catch_unwind},
    sync::{Arc, atomic::Ordering, mpsc::Sender},
    time::Duration,
};

use crate::{
    coach::{Coach, Request, Skill},
    drills::{
        Advice, Attempt, Session, advise, chance,
        estimate::{Estimate, estimate},
        store::{Store, StoreError},
    },
    table::Table,
    terminal::{
        AdviceTask, AttemptOutcome, DrillReport, DrillTask, FilmReplay, LoadedRecords, ModelShot, PlayTask,
        RateStrokeTask, Shot, tasks::event::Event,
    },
};

/// Thinking time of the coach if the exercise has no stroke of its own: less than a player looks at a position before a stroke.
const BUDGET: Duration = Duration::from_millis(300);

/// Worker for the tasks of the drill screens.
#[derive(Debug, Default)]
pub struct PracticeWorker {
    store: Option<Store>,
    coach: Option<Coach>,
    /// The latest model shot, with the identifier of its request.
    model_shot: Option<(u64, Advice)>,
    /// The session played last, with the success rates that were computed since.
    last: Option<Session>,
    /// Number of attempts of each session known to be on the disk.
    saved_attempts: HashMap<String, usize>,
    /// The latest state of the sessions that the disk has refused, each with its attempts before the first refused change.
    unsaved: Vec<(Session, Vec<Attempt>)>,
}

impl PracticeWorker {
    /// Runs `task` on this thread and passes its reports to `reply`. A panic in a simulation becomes an error message.
    pub fn run(&mut self, task: DrillTask, reply: &mut dyn FnMut(DrillReport)) {
        let failed = "the program failed on this position; move a ball a little and try again";
        let retried = if task.writes() { self.retry(reply) } else { Ok(()) };
        match task {
            DrillTask::Load(places) => {
                let store = self.store.insert(Store::new(&places));
                let mut loaded = load(store);
                for (session, _) in &self.unsaved {
                    loaded.sessions.retain(|stored| stored.id != session.id);
                    loaded.sessions.push(session.clone());
                }
                reply(DrillReport::Loaded(Box::new(loaded)));
            }
            DrillTask::SaveUnsaved => {
                if retried.is_err() {
                    reply(DrillReport::Retried(retried));
                }
            }
            DrillTask::Advise(task) => {
                if !task.cancel.load(Ordering::Relaxed) {
                    let found = catch_unwind(AssertUnwindSafe(|| self.find_model_shot(&task)));
                    reply(DrillReport::ModelShot(task.id, found.unwrap_or_else(|_| Err(failed.to_owned()))));
                }
            }
            DrillTask::Play(task) => {
                let id = task.session.id.clone();
                if catch_unwind(AssertUnwindSafe(|| self.play(*task, reply))).is_err() {
                    reply(DrillReport::Played(id, Err(failed.to_owned()), Ok(())));
                }
            }
            DrillTask::RateStroke(stroke) => {
                let RateStrokeTask { id, table, layout, rule, shooter, cue, cancel } = &*stroke;
                let judge = || chance(*shooter, *rule, table, layout, cue);
                if !cancel.load(Ordering::Relaxed)
                    && let Ok(made) = catch_unwind(AssertUnwindSafe(judge))
                {
                    reply(DrillReport::StrokeRated(*id, made));
                }
            }
            DrillTask::Save(session, before) => match self.save(&session, &before) {
                Ok(saved) => reply(DrillReport::Saved(session, saved)),
                Err(stored) => reply(DrillReport::Changed(stored)),
            },
            DrillTask::SavePosition(exercise, replaces) => {
                let saved = match self.store.as_ref().map(|store| store.save_position(&exercise, replaces)) {
                    Some(Err(StoreError::NameTaken(_))) => Ok(false),
                    Some(Err(error)) => Err(error.to_string()),
                    Some(Ok(())) => Ok(true),
                    None => Err(NO_STORE.to_owned()),
                };
                reply(DrillReport::PositionSaved(exercise, saved));
            }
            DrillTask::RemovePosition(name) => {
                let removed = self.with_store(|store| store.remove_position(&name));
                reply(DrillReport::PositionRemoved(name, removed));
            }
            DrillTask::SaveSkill(skill) => {
                let kept = self.with_store(|store| store.save_skill(skill));
                reply(DrillReport::SkillSaved(skill, kept));
            }
            DrillTask::Film(filmed) => {
                let played = catch_unwind(AssertUnwindSafe(|| FilmReplay::new(&filmed)));
                let failed =
                    || Err(format!("the program failed on shot {} of the film; choose another", filmed.number));
                let played = played.unwrap_or_else(|_| failed()).map(Box::new);
                reply(DrillReport::Filmed(filmed.number, played));
            }
            DrillTask::Estimate(number, sessions) => {
                let found = catch_unwind(AssertUnwindSafe(|| estimated(&sessions)));
                reply(DrillReport::Estimated(number, found.unwrap_or_else(|_| Err(failed.to_owned()))));
            }
        }
    }

    /// Runs `task` and sends its reports to the screen.
    pub(super) fn work(&mut self, task: DrillTask, to_screen: &Sender<Event>) {
        self.run(task, &mut |report| {
            // A closed screen needs no answer; what has to be saved is on the disk.
            let _ = to_screen.send(Event::Drill(report));
        });
    }

    fn with_store(&self, work: impl FnOnce(&Store) -> Result<(), StoreError>) -> Result<(), String> {
        let store = self.store.as_ref().ok_or(NO_STORE)?;
        work(store).map_err(|error| error.to_string())
    }

    /// Saves a session whose attempts before the change were `before`. Returns the error if it cannot be saved, or its present state if
    /// another program has changed it.
    fn save(&mut self, session: &Session, before: &[Attempt]) -> Result<Result<(), String>, Box<Session>> {
        let Some(store) = &self.store else { return Ok(Err(NO_STORE.to_owned())) };
        // If a session of an earlier program is continued, the disk may have refused some of it.
        let saved_attempts = self.saved_attempts.entry(session.id.clone()).or_default();
        // The file is as it was before the first change that the disk has refused.
        let place = self.unsaved.iter().position(|(unsaved, _)| unsaved.id == session.id);
        let refused = place.map(|place| self.unsaved.remove(place).1);
        match store.save(session, refused.as_deref().unwrap_or(before), *saved_attempts) {
            Err(StoreError::Changed(stored)) => {
                *saved_attempts = stored.attempts.len();
                Err(stored)
            }
            Err(error) => {
                self.unsaved.push((session.clone(), refused.unwrap_or_else(|| before.to_vec())));
                Ok(Err(error.to_string()))
            }
            Ok(()) => {
                *saved_attempts = session.attempts.len();
                Ok(Ok(()))
            }
        }
    }

    /// Saves what the disk has refused so far, and reports it if that succeeds.
    ///
    /// # Errors
    /// What is still not saved, and why.
    fn retry(&mut self, reply: &mut dyn FnMut(DrillReport)) -> Result<(), String> {
        if self.unsaved.is_empty() {
            return Ok(());
        }
        let (mut refusal, mut changed) = (String::new(), Vec::new());
        for (session, before) in self.unsaved.clone() {
            match self.save(&session, &before) {
                Ok(Ok(())) => {}
                Ok(Err(error)) => refusal = error,
                Err(stored) => changed.push(DrillReport::Changed(stored)),
            }
        }
        let is_saved = self.unsaved.is_empty();
        if is_saved && changed.is_empty() {
            reply(DrillReport::Retried(Ok(())));
        }
        changed.into_iter().for_each(reply);
        if is_saved {
            return Ok(());
        }
        let what = self.unsaved.iter().map(|(session, _)| self.unsaved_words(session)).collect::<Vec<_>>().join(", ");
        Err(format!("not saved: {what}; {refusal}"))
    }

    /// What of the session is not on the disk.
    fn unsaved_words(&self, session: &Session) -> String {
        let saved = self.saved_attempts.get(&session.id).copied().unwrap_or_default();
        let attempts = match session.attempts.len().saturating_sub(saved) {
            0 => "the last change".to_owned(),
            1 => "1 attempt".to_owned(),
            many => format!("{many} attempts"),
        };
        let exercise = session.exercises.first().filter(|_| !session.is_exam());
        format!("{attempts} at {}", exercise.map_or("the exam", |exercise| exercise.title.as_str()))
    }

    fn find_model_shot(&mut self, task: &AdviceTask) -> Result<Option<ModelShot>, String> {
        self.model_shot = None;
        let AdviceTask { table, layout, rule, shooter, .. } = task;
        let advice = if let Some(cue) = task.own {
            Some(Advice { cue, solved: true, chance: chance(*shooter, *rule, table, layout, &cue) })
        } else {
            let cancel = Arc::clone(&task.cancel);
            let request = Request {
                rule: *rule,
                skill: shooter.skill,
                doubt: shooter.doubt,
                plan: task.plan,
                jumps: task.jumps,
                budget: BUDGET,
                cancel,
                ..Request::default()
            };
            let coach = self.coach(table);
            advise(coach, layout, &request, task.is_for_coach).map_err(|error| error.to_string())?
        };
        self.model_shot = advice.map(|advice| (task.id, advice));
        let model_shot = advice.map(|advice| {
            let source = if task.own.is_some() { "exercise" } else { "coach" };
            let shot =
                Shot::new(table, layout, advice.cue, advice.solved, source).map_err(|error| error.to_string())?;
            Ok(ModelShot { advice, is_own: task.own.is_some(), shot: Arc::new(shot) })
        });
        model_shot.transpose()
    }

    /// The coach for this table, created at first use.
    fn coach(&mut self, table: &Table) -> &Coach {
        let known = self.coach.take().filter(|coach| coach.table() == table);
        self.coach.insert(known.unwrap_or_else(|| Coach::new(table.clone())))
    }

    /// Plays a stroke. The attempt is on the disk before its result is reported; its success rate is computed afterwards.
    fn play(&mut self, task: PlayTask, reply: &mut dyn FnMut(DrillReport)) {
        let PlayTask { mut session, intended, with_hint, advice_id } = task;
        self.add_known_rates(&mut session);
        let place = session.position().ok().flatten();
        let rule = session.exercise().map(|exercise| exercise.rule);
        let (played, (table, layout), rule) = match (session.play(intended, with_hint), place, rule) {
            (Ok(played), Some(place), Some(rule)) => (played, place, rule),
            (Err(error), ..) => return reply(DrillReport::Played(session.id, Err(error.to_string()), Ok(()))),
            _ => return,
        };
        let number = session.attempts.len() - 1;
        // With the cue raised if it had to be.
        let intended = session.attempts[number].intended.unwrap_or(intended);
        if let Some((_, advice)) = self.model_shot.as_ref().filter(|(id, _)| *id == advice_id) {
            session.attempts[number].advised = Some(advice.cue);
            session.attempts[number].advised_chance = Some(advice.chance.rate);
        }
        let saved = match self.save(&session, &session.attempts[..number]) {
            Ok(saved) => saved,
            // The balls may have other positions by now, so the stroke is not reported.
            Err(stored) => return reply(DrillReport::Changed(stored)),
        };
        let shot = (!played.miscue).then(|| Shot::new(&table, &layout, played.stroke, played.made, "player"));
        let shot = shot.and_then(Result::ok).map(Arc::new);
        let next = session.position().ok().flatten();
        let outcome = Box::new(AttemptOutcome { session: session.clone(), played, shot, next });
        reply(DrillReport::Played(session.id.clone(), Ok(outcome), saved));
        let share = chance(session.shooter_of(number), rule, &table, &layout, &intended).rate;
        session.attempts[number].chance = Some(share);
        let was_refused = !self.unsaved.is_empty();
        // A disk error was just reported, and a user who has continued the session may do so without the rate.
        let _ = self.save(&session, &session.attempts);
        if was_refused && self.unsaved.is_empty() {
            reply(DrillReport::Retried(Ok(())));
        }
        reply(DrillReport::AttemptRated(session.id.clone(), number, share));
        self.last = Some(session);
    }

    /// Adds the success rates that were computed after the screen had sent the session.
    fn add_known_rates(&self, session: &mut Session) {
        let Some(last) = self.last.as_ref().filter(|last| last.id == session.id) else { return };
        for (attempt, known) in session.attempts.iter_mut().zip(&last.attempts) {
            attempt.chance = attempt.chance.or(known.chance);
        }
    }
}

/// Message before the first load; never shown, because loading is the first task.
const NO_STORE: &str = "it is not known where to write";

/// Estimates the player's skill and describes how certain it is.
fn estimated(sessions: &[Session]) -> Result<(Option<Skill>, String), String> {
    let found = estimate(sessions).map_err(|error| error.to_string())?;
    let Estimate { skill, attempts, shots, .. } = found;
    let sentence = format!(
        "you play like an average of {} at three-cushion (95 % interval), from {attempts} attempts at {shots} shots",
        found.words()
    );
    Ok((skill, sentence))
}

fn load(store: &Store) -> LoadedRecords {
    let (sessions, positions, own) = (store.sessions(), store.positions(), store.own_skill());
    let mut troubles = sessions.notes;
    troubles.extend(positions.notes);
    let skill = own.unwrap_or_else(|error| {
        troubles.push(error.to_string());
        None
    });
    LoadedRecords { sessions: sessions.items, positions: positions.items, skill, troubles }
}
