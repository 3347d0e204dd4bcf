//! Background tasks of the drill screens, done in order, and their reports.

use std::sync::{Arc, atomic::AtomicBool};

use crate::{
    coach::{Shooter, Skill},
    drills::{Advice, Attempt, Exercise, Played, Session},
    game::Rule,
    physics::CueInputs,
    statistics::SuccessRate,
    storage::Places,
    study::filmed::FilmedShot,
    table::{Layout, Table},
    terminal::{FilmReplay, Shot},
};

/// Something that is to be done.
#[derive(Clone, Debug)]
pub enum DrillTask {
    /// Read what the user has played and saved there; all that follows is written there.
    Load(Box<Places>),
    /// Find the model shot.
    Advise(Box<AdviceTask>),
    /// Play the next attempt of a session, and save it.
    Play(Box<PlayTask>),
    /// Find out how often the player makes a stroke that is not played.
    Judge(Box<JudgedStroke>),
    /// Save a session, in which something was noted or taken back; with the attempts that it had before.
    Save(Box<Session>, Vec<Attempt>),
    /// Save a position, over one of the same name only where that is wanted.
    SavePosition(Box<Exercise>, bool),
    /// Remove the position of this name.
    RemovePosition(String),
    /// Estimate the player's skill from these sessions; the number tells the answer from those to earlier questions.
    Estimate(u64, Arc<[Session]>),
    /// Keep the player's skill.
    KeepSkill(Skill),
    /// Fit the stroke of a filmed shot and play it.
    Film(Box<FilmedShot>),
}

impl DrillTask {
    /// Whether it changes what is on the disk, or is needed for that.
    pub const fn writes(&self) -> bool {
        !matches!(self, Self::Advise(_) | Self::Judge(_) | Self::Estimate(..) | Self::Film(_))
    }
}

/// A request for the model shot.
#[derive(Clone, Debug)]
pub struct AdviceTask {
    /// Tells this question's answer from those to earlier ones.
    pub id: u64,
    /// The table.
    pub table: Table,
    /// Where the balls lie.
    pub layout: Layout,
    /// What counts as a point.
    pub rule: Rule,
    /// Who plays, and what is in doubt.
    pub shooter: Shooter,
    /// Whether what comes next counts too, as in a game.
    pub plan: bool,
    /// Whether jumps and massés may be advised.
    pub jumps: bool,
    /// Whether the coach is to play the stroke itself.
    pub is_coachs: bool,
    /// The exercise's own shot, where the balls lie for it; otherwise the coach is asked.
    pub own: Option<CueInputs>,
    /// Set when the answer is no longer wanted.
    pub cancel: Arc<AtomicBool>,
}

/// A stroke that is to be played.
#[derive(Clone, Debug)]
pub struct PlayTask {
    /// The session so far.
    pub session: Session,
    /// What the player means.
    pub meant: CueInputs,
    /// Whether the player has seen a shot that makes the point.
    pub with_hint: bool,
    /// The number of the question for its model shot, see [`AdviceTask::id`].
    pub advice_id: u64,
}

/// A stroke that is not played, only judged.
#[derive(Clone, Debug)]
pub struct JudgedStroke {
    /// Tells this question's answer from those to earlier ones.
    pub id: u64,
    /// The table.
    pub table: Table,
    /// Where the balls lie.
    pub layout: Layout,
    /// What counts as a point.
    pub rule: Rule,
    /// Who plays, and what is in doubt.
    pub shooter: Shooter,
    /// What the player means.
    pub cue: CueInputs,
    /// Set when the answer is no longer wanted.
    pub cancel: Arc<AtomicBool>,
}

/// A model shot, the exercise's or the coach's, ready to be shown.
#[derive(Clone, Debug)]
pub struct ModelShot {
    /// The stroke, and how often the player makes it.
    pub advice: Advice,
    /// Whether it is the exercise's own; otherwise it is the coach's.
    pub is_own: bool,
    /// What happens if it is played as meant.
    pub shot: Arc<Shot>,
}

/// What came of a stroke.
#[derive(Clone, Debug)]
pub struct AttemptOutcome {
    /// The session with this attempt.
    pub session: Session,
    /// What came of it.
    pub played: Played,
    /// The shot as it was played; `None` where the tip slipped off.
    pub shot: Option<Arc<Shot>>,
    /// Where the balls lie for the next attempt; `None` when the session is over.
    pub next: Option<(Table, Layout)>,
}

/// What the user has, read from the disk.
#[derive(Clone, Debug)]
pub struct LoadedRecords {
    /// Sessions, the oldest first.
    pub sessions: Vec<Session>,
    /// Own positions.
    pub positions: Vec<Exercise>,
    /// The skill that was kept.
    pub skill: Option<Skill>,
    /// What could not be read, a sentence each.
    pub troubles: Vec<String>,
}

/// What has come of a task.
#[derive(Clone, Debug)]
pub enum DrillReport {
    /// Of [`DrillTask::Load`].
    Loaded(Box<LoadedRecords>),
    /// Of [`DrillTask::Advise`]: with the question's number; `None` where no point was found.
    ModelShot(u64, Result<Option<ModelShot>, String>),
    /// Of [`DrillTask::Play`]: the session's identity, what came of it, and whether it could be saved.
    Played(String, Result<Box<AttemptOutcome>, String>, Result<(), String>),
    /// How often the player makes what was meant: the session's identity, the number of the attempt, the share.
    Judged(String, usize, f64),
    /// Of [`DrillTask::Judge`], with the question's number.
    StrokeJudged(u64, SuccessRate),
    /// Of [`DrillTask::Save`].
    Saved(Box<Session>, Result<(), String>),
    /// Of [`DrillTask::Play`] and [`DrillTask::Save`] where another program has changed the session: how it stands now, without
    /// what was to be played or saved.
    Changed(Box<Session>),
    /// Of [`DrillTask::SavePosition`]: whether it is saved, or the name is taken.
    PositionSaved(Box<Exercise>, Result<bool, String>),
    /// Of [`DrillTask::RemovePosition`].
    PositionRemoved(String, Result<(), String>),
    /// Of [`DrillTask::Estimate`], with its number: the skill, where it is more than a bound, with a sentence on how sure that is,
    /// or why nothing is known.
    Estimated(u64, Result<(Option<Skill>, String), String>),
    /// Of [`DrillTask::KeepSkill`].
    SkillKept(Skill, Result<(), String>),
    /// Of [`DrillTask::Film`]: with the shot's number in the match.
    Filmed(u32, Result<Box<FilmReplay>, String>),
}
