//! Asking the coach on a thread of its own, so that the screen never waits.

use std::{
    panic::{AssertUnwindSafe, catch_unwind},
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
        mpsc::{Receiver, Sender, channel},
    },
    thread,
    time::Duration,
};

use super::shot::Shot;
use crate::{
    coach::{Coach, Request},
    game::Rule,
    learning::Policy,
    table::{Layout, Table},
};

/// Longest time that the coach may think, s. Its goal is well under 100 ms; only layouts that are very hard use it up.
const BUDGET: Duration = Duration::from_secs(2);

/// Whose advice is asked, and what counts as a point.
#[derive(Clone, Debug, Default)]
pub struct Tutor {
    /// A policy that somebody has trained, with its name; without one those that are bundled are asked.
    pub policy: Option<(String, Arc<Policy>)>,
    /// What counts as a point.
    pub rule: Rule,
}

impl Tutor {
    /// The policy's name.
    pub fn name(&self) -> &str {
        self.policy.as_ref().map_or("the bundled policy", |(name, _)| name)
    }

    /// Whether `other` is asked the same policy; a policy is never changed, only replaced.
    fn has_policy_of(&self, other: &Self) -> bool {
        match (&self.policy, &other.policy) {
            (None, None) => true,
            (Some((_, one)), Some((_, other))) => Arc::ptr_eq(one, other),
            _ => false,
        }
    }
}

/// A question to the coach.
#[derive(Clone, Debug)]
pub struct Job {
    /// Tells this question's answer from those to earlier questions.
    pub id: u64,
    /// The table.
    pub table: Table,
    /// Where the balls lie.
    pub layout: Layout,
    /// Whose advice is asked.
    pub tutor: Tutor,
    /// Seed of the coach's random numbers.
    pub seed: u64,
    /// Set when nobody waits for the answer any more.
    pub cancel: Arc<AtomicBool>,
}

/// What an answer has cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// Shots that were simulated.
    pub simulations: u64,
    /// How long the coach thought.
    pub elapsed: Duration,
}

/// The coach's answer.
#[derive(Clone, Debug)]
pub struct Answer {
    /// The question's number.
    pub id: u64,
    /// The shot, or a sentence that says why there is none.
    pub shot: Result<Arc<Shot>, String>,
    /// What it has cost, where that is to be told.
    pub effort: Option<Effort>,
}

/// The coach, made when it is first asked: reading its networks must not delay the first picture.
#[derive(Debug, Default)]
pub struct Office {
    coach: Option<(Tutor, Coach)>,
}

impl Office {
    /// Answers a question on this thread. A panic becomes a sentence.
    pub fn answer(&mut self, job: &Job) -> Answer {
        let found = catch_unwind(AssertUnwindSafe(|| self.shot(job)))
            .unwrap_or_else(|_| Err("the coach failed on this layout; move a ball a little and ask again".to_owned()));
        match found {
            Ok((shot, effort)) => Answer { id: job.id, shot: Ok(Arc::new(shot)), effort: Some(effort) },
            Err(sentence) => Answer { id: job.id, shot: Err(sentence), effort: None },
        }
    }

    fn shot(&mut self, job: &Job) -> Result<(Shot, Effort), String> {
        let request = Request {
            rule: job.tutor.rule,
            budget: BUDGET,
            seed: job.seed,
            cancel: Arc::clone(&job.cancel),
            ..Request::default()
        };
        let found = self.coach(job)?.recommend(&job.layout, &request).map_err(|error| error.to_string())?;
        let effort = Effort { simulations: found.simulations, elapsed: found.elapsed };
        Shot::new(&job.table, &job.layout, found.cue, found.solved, found.source.to_string())
            .map(|shot| (shot, effort))
            .map_err(|error| error.to_string())
    }

    /// The coach for the question's table, with its policy.
    fn coach(&mut self, job: &Job) -> Result<&Coach, String> {
        let fits = |(tutor, coach): &(Tutor, Coach)| *coach.table() == job.table && tutor.has_policy_of(&job.tutor);
        let known = self.coach.take().filter(fits);
        let known = match (known, &job.tutor.policy) {
            (Some(known), _) => known,
            (None, policy) => {
                let bundled = Coach::new(job.table.clone()).map_err(|error| error.to_string())?;
                let coach = match policy {
                    Some((_, policy)) => bundled.with_policy(Policy::clone(policy)),
                    None => bundled,
                };
                (job.tutor.clone(), coach)
            }
        };
        Ok(&self.coach.insert(known).1)
    }
}

/// Starts the thread that answers questions through `reply`; it ends with the sender that is returned.
pub fn spawn(reply: impl Fn(Answer) + Send + 'static) -> std::io::Result<Sender<Box<Job>>> {
    let (sender, questions): (Sender<Box<Job>>, Receiver<Box<Job>>) = channel();
    thread::Builder::new().name("coach".into()).spawn(move || {
        let mut office = Office::default();
        for job in questions {
            if !job.cancel.load(Ordering::Relaxed) {
                reply(office.answer(&job));
            }
        }
    })?;
    Ok(sender)
}
