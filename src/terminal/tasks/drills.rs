//! Background tasks of the drill screens, run in order, and their reports.

use std::sync::{Arc, atomic::AtomicBool};

use crate::{
    coach::{Shooter, Skill},
    drills::{Advice, Attempt, Exercise, PlayedStroke, Session, store::OwnSkill},
    game::Rule,
    physics::CueInputs,
    statistics::SuccessRate,
    storage::DataPaths,
    study::filmed::FilmedShot,
    table::{Layout, Table},
    terminal::{FilmReplay, Shot},
};

/// A task.
#[derive(Clone, Debug)]
pub enum DrillTask {
    /// Load the user's records from this location; all later tasks write there.
    Load(Box<DataPaths>),
    /// Find the model shot.
    Advise(Box<AdviceTask>),
    /// Play the next attempt of a session and save it.
    Play(Box<PlayTask>),
    /// Compute the player's success rate at a stroke that is not played.
    RateStroke(Box<RateStrokeTask>),
    /// Save a session in which something was noted or undone, together with its attempts before the change.
    Save(Box<Session>, Vec<Attempt>),
    /// Save what the disk has refused so far.
    SaveUnsaved,
    /// Save a position; the flag allows replacing one of the same name.
    SavePosition(Box<Exercise>, bool),
    /// Remove the position with this name.
    RemovePosition(String),
    /// Estimate the player's skill from these sessions; the number identifies the answer.
    Estimate(u64, Arc<[Session]>),
    /// Save the player's skill.
    SaveSkill(Skill),
    /// Fit the stroke of a filmed shot and simulate it.
    Film(Box<FilmedShot>),
}

impl DrillTask {
    /// Whether the task writes to the disk, or is needed for that.
    pub const fn writes(&self) -> bool {
        !matches!(self, Self::Advise(_) | Self::RateStroke(_) | Self::Estimate(..) | Self::Film(_))
    }
}

/// A request for the model shot.
#[derive(Clone, Debug)]
pub struct AdviceTask {
    /// Identifies the answer to this request.
    pub id: u64,
    /// The table.
    pub table: Table,
    /// Positions of the balls.
    pub layout: Layout,
    /// What counts as a point.
    pub rule: Rule,
    /// The player's skill, and how uncertain the table and the positions are.
    pub shooter: Shooter,
    /// Whether the next point counts too, as in a game.
    pub plan: bool,
    /// Whether jumps and massés may be advised.
    pub jumps: bool,
    /// Whether the coach itself will play the stroke.
    pub is_for_coach: bool,
    /// The exercise's own shot, if its layout is on the table; otherwise the coach searches for one.
    pub own: Option<CueInputs>,
    /// Set when the answer is no longer needed.
    pub cancel: Arc<AtomicBool>,
}

/// A stroke to be played.
#[derive(Clone, Debug)]
pub struct PlayTask {
    /// The session so far.
    pub session: Session,
    /// The stroke that the player intends.
    pub intended: CueInputs,
    /// Whether the player has seen a shot that makes the point.
    pub with_hint: bool,
    /// Identifier of the request for the model shot, see [`AdviceTask::id`].
    pub advice_id: u64,
}

/// A stroke to be judged without being played.
#[derive(Clone, Debug)]
pub struct RateStrokeTask {
    /// Identifies the answer to this request.
    pub id: u64,
    /// The table.
    pub table: Table,
    /// Positions of the balls.
    pub layout: Layout,
    /// What counts as a point.
    pub rule: Rule,
    /// The player's skill, and how uncertain the table and the positions are.
    pub shooter: Shooter,
    /// The stroke that the player intends.
    pub cue: CueInputs,
    /// Set when the answer is no longer needed.
    pub cancel: Arc<AtomicBool>,
}

/// A model shot, of the exercise or the coach, ready for display.
#[derive(Clone, Debug)]
pub struct ModelShot {
    /// The stroke and the player's success rate at it.
    pub advice: Advice,
    /// Whether it is the exercise's own; otherwise it is the coach's.
    pub is_own: bool,
    /// The shot if played without errors.
    pub shot: Arc<Shot>,
}

/// Result of a played stroke.
#[derive(Clone, Debug)]
pub struct AttemptOutcome {
    /// The session including this attempt.
    pub session: Session,
    /// The result of the attempt.
    pub played: PlayedStroke,
    /// The shot as it was played; `None` after a miscue.
    pub shot: Option<Arc<Shot>>,
    /// Table and layout of the next attempt; `None` when the session is over.
    pub next: Option<(Table, Layout)>,
}

/// The user's records, loaded from the disk.
#[derive(Clone, Debug)]
pub struct LoadedRecords {
    /// Sessions, the oldest first.
    pub sessions: Vec<Session>,
    /// The user's own positions.
    pub positions: Vec<Exercise>,
    /// The saved skill.
    pub skill: Option<OwnSkill>,
    /// Messages about what could not be read.
    pub troubles: Vec<String>,
}

/// Report of a task.
#[derive(Clone, Debug)]
pub enum DrillReport {
    /// Result of [`DrillTask::Load`].
    Loaded(Box<LoadedRecords>),
    /// Result of [`DrillTask::Advise`], with the identifier of the request; `None` if no point was found.
    ModelShot(u64, Result<Option<ModelShot>, String>),
    /// Result of [`DrillTask::Play`]: the session's identifier, the outcome, and whether it could be saved.
    Played(String, Result<Box<AttemptOutcome>, String>, Result<(), String>),
    /// The player's success rate at an intended stroke: the session's identifier, the number of the attempt, the rate.
    AttemptRated(String, usize, f64),
    /// Result of [`DrillTask::RateStroke`], with the identifier of the request.
    StrokeRated(u64, SuccessRate),
    /// Result of [`DrillTask::Save`].
    Saved(Box<Session>, Result<(), String>),
    /// Result of [`DrillTask::Play`] or [`DrillTask::Save`] if another program has changed the session: its present state, without the
    /// stroke or the change.
    Changed(Box<Session>),
    /// Whether everything that the disk had refused is saved now; if not, what is missing and why.
    Retried(Result<(), String>),
    /// Result of [`DrillTask::SavePosition`]: `true` if saved, `false` if the name is taken.
    PositionSaved(Box<Exercise>, Result<bool, String>),
    /// Result of [`DrillTask::RemovePosition`].
    PositionRemoved(String, Result<(), String>),
    /// Result of [`DrillTask::Estimate`], with its number: the skill, unless only a bound is known, and a sentence on how certain it is; or
    /// why nothing is known.
    Estimated(u64, Result<(Option<Skill>, String), String>),
    /// Result of [`DrillTask::SaveSkill`].
    SkillSaved(Skill, Result<(), String>),
    /// Result of [`DrillTask::Film`], with the shot's number in the match.
    Filmed(u32, Result<Box<FilmReplay>, String>),
}
