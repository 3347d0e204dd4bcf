//! Attempts: plays a stroke with the player's errors, or records a result from a real table.

use super::{Attempt, ExerciseError, Session, session::now, shifted};
use crate::{
    coach::Verdict,
    game::{Point, Referee, Rule, Tally},
    physics::{CueError, CueInputs, NoRoom, raise_to_clear, strike},
    player::errors,
    simulation::{Recording, simulate},
    table::{BALLS, Layout, Table},
};

/// Separates the stroke errors from the other random numbers of a session's seed, so that the coach's search cannot
/// exploit them.
const ERROR_STREAM: u64 = 0x7374_726f_6b65_733f;

/// Why an attempt cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum PlayError {
    /// The goal of the session is reached.
    #[error("the session is over")]
    Over,
    /// The exercise cannot be played.
    #[error(transparent)]
    Exercise(#[from] ExerciseError),
    /// The stroke cannot be played.
    #[error(transparent)]
    Cue(#[from] CueError),
    /// The cue has no room for the stroke.
    #[error(transparent)]
    Room(#[from] NoRoom),
}

/// The result of a stroke.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlayedStroke {
    /// The stroke with the player's errors.
    pub stroke: CueInputs,
    /// Whether the tip slipped off the ball; then no ball moves, and there is no point.
    pub miscue: bool,
    /// The verdict on the shot.
    pub verdict: Verdict,
    /// Whether it made the point.
    pub made: bool,
    /// The ball positions at rest, m; balls that left the table are on their spots.
    pub end: Layout,
}

impl PlayedStroke {
    /// Plays a stroke without further errors.
    pub fn of(rule: Rule, table: &Table, layout: &Layout, stroke: CueInputs) -> Self {
        let impulse = strike(table, &stroke);
        let mut referee = Referee::until_end().with_tally(Tally::from_stroke(table, layout, &impulse));
        let miscue = stroke.is_miscue(table);
        let ended = (!miscue).then(|| simulate(table, layout, &impulse, &mut referee));
        let end = ended.map_or(*layout, |end| end.layout(table));
        let off = ended.map_or([None; BALLS], |end| end.left_table(table));
        let verdict = Verdict { point: Point::of(rule, table, layout), tally: referee.tally, miss: None, off };
        Self { stroke, miscue, verdict, made: verdict.is_made(), end }
    }

    /// Like [`of`](Self::of), and determines how a ball was missed, for which the shot is recorded.
    fn recorded(rule: Rule, table: &Table, layout: &Layout, stroke: CueInputs) -> Self {
        match Recording::new(table, layout, &stroke) {
            Ok(recording) if !stroke.is_miscue(table) => {
                let verdict = Verdict::of(rule, table, layout, &recording);
                Self { stroke, miscue: false, verdict, made: verdict.is_made(), end: recording.final_layout() }
            }
            _ => Self::of(rule, table, layout, stroke),
        }
    }
}

/// Checks a stroke that a player intends on `table`: its inputs must be in range and the tip within the miscue limit.
///
/// # Errors
/// Fails with the first problem found.
pub fn check(table: &Table, cue: &CueInputs) -> Result<(), CueError> {
    cue.validate()?;
    cue.validate_tip(table.miscue_limit)
}

/// Returns the intended stroke with the cue raised over the rails and balls behind it.
fn with_raised_cue(table: &Table, layout: &Layout, intended: &CueInputs) -> Result<CueInputs, PlayError> {
    check(table, intended)?;
    Ok(raise_to_clear(table, layout, intended)?)
}

impl Session {
    /// Returns the table and the layout of the next attempt; `None` if the session is over.
    ///
    /// # Errors
    /// Fails if the exercise is impossible.
    pub fn position(&self) -> Result<Option<(Table, Layout)>, ExerciseError> {
        let Some(exercise) = self.exercise() else { return Ok(None) };
        let table = self.table_of(exercise)?;
        let layout = match self.attempts.last() {
            Some(_) if self.restarts() => exercise.layout,
            Some(last) if self.is_game() => {
                let layout = last.layout.unwrap_or(exercise.layout);
                // The simulation is deterministic. A stroke from a file, which has degrees, may differ in its last bit.
                let end =
                    last.played.map_or(layout, |stroke| PlayedStroke::of(exercise.rule, &table, &layout, stroke).end);
                let is_same_side = self.next_cue_ball() == self.cue_ball_of(self.attempts.len() - 1);
                if is_same_side { end } else { end.for_the_opponent() }
            }
            _ if self.shifted => shifted(&exercise.layout, &table, self.seed, self.attempts.len() as u32),
            _ => exercise.layout,
        };
        Ok(Some((table, layout)))
    }

    /// Plays the next attempt: the intended stroke with the player's errors, which the session's seed determines. A cue
    /// that is too low for a rail or a ball behind it is raised, as it would be at a real table.
    ///
    /// # Errors
    /// Fails if the session is over, the stroke is impossible, or the cue has no room for it. In these cases nothing is
    /// recorded.
    pub fn play(&mut self, intended: CueInputs, helped: bool) -> Result<PlayedStroke, PlayError> {
        let (table, layout) = self.position()?.ok_or(PlayError::Over)?;
        let intended = with_raised_cue(&table, &layout, &intended)?;
        let exercise = self.exercise().ok_or(PlayError::Over)?;
        let number = self.attempts.len();
        let errors = errors::independent(number + 1, self.seed ^ ERROR_STREAM)[number];
        let stroke = self.skill_of(number).stroke(table.radius, &intended, &errors);
        let played = PlayedStroke::recorded(exercise.rule, &table, &layout, stroke);
        let attempt = Attempt {
            layout: (layout != exercise.layout).then_some(layout),
            intended: Some(intended),
            played: Some(stroke),
            helped: helped && !self.is_coachs_turn(),
            by_coach: self.is_coachs_turn(),
            ..Attempt::new(&exercise.name, played.made)
        };
        self.attempts.push(attempt);
        Ok(played)
    }

    /// Records an attempt at a real table.
    ///
    /// # Errors
    /// Fails if the session is over, or the exercise is impossible.
    pub fn log(&mut self, made: bool) -> Result<(), PlayError> {
        let (_, layout) = self.position()?.ok_or(PlayError::Over)?;
        let exercise = self.exercise().ok_or(PlayError::Over)?;
        let layout = (layout != exercise.layout).then_some(layout);
        self.attempts.push(Attempt { layout, ..Attempt::new(&exercise.name, made) });
        Ok(())
    }

    /// Removes the last attempt and returns it.
    pub fn undo(&mut self) -> Option<Attempt> {
        self.attempts.pop()
    }
}

impl Attempt {
    /// Creates an attempt made now, with its result only.
    pub fn new(exercise: &str, made: bool) -> Self {
        Self { exercise: exercise.to_owned(), at: now(), made, ..Self::default() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        coach::{Doubt, Shooter, Skill, words::LengthUnit},
        drills::{Exercise, Goal, Library, Venue, chance},
        table::{CueBall, Room},
    };
    use glam::DVec2;

    #[test]
    fn miss_reports_the_gap_and_the_side() {
        // Yellow lies 10 cm to the left of the path, red far behind.
        let layout = Layout::parse("-1,0 0,0.1 -1.3,-0.6", &Table::default()).unwrap();
        let exercise = Exercise::new_own("passed", Rule::StraightRail, "match", layout);
        let mut session = Session::new(Goal::Free, Venue::Program, vec![exercise], Skill::PERFECT, 1);
        let played = session.play(CueInputs { a: 0.0, b: 0.0, theta: 0.0, phi: 0.0, speed: 2.0 }, false).unwrap();
        let words = |unit| played.words(CueBall::White, unit);
        assert_eq!(words(LengthUnit::Metres), "No point: no ball was hit, passed yellow by 3.9 cm on the right");
        assert!(words(LengthUnit::Feet).ends_with("passed yellow by 1.5 in on the right"));
    }

    #[test]
    fn own_table_of_equal_size_is_used_and_saved() {
        let own = Table { name: "cellar".to_owned(), sliding_friction: 0.1, ..Table::default() };
        let exercise = |table: &str| {
            let layout = Layout::opening(&Table::preset(table).unwrap());
            Exercise::new_own("mine", Rule::StraightRail, table, layout)
        };
        let session = |table: &str| {
            let mut session = Session::new(Goal::Free, Venue::Program, vec![exercise(table)], Skill::PERFECT, 1);
            session.table = Some(Box::new(own.clone()));
            session
        };
        let played_on = |session: &Session| session.position().unwrap().unwrap().0.name;
        assert_eq!(
            ["match", "textbook", "thesis"].map(|table| played_on(&session(table))),
            ["cellar", "cellar", "thesis"]
        );
        let played = session("match");
        let kept: Session = serde_json::from_str(&serde_json::to_string(&played).unwrap()).unwrap();
        assert_eq!((kept.table, kept.exercises.len()), (played.table, 1));
        // A model shot that makes the point on the table that it was designed for, and stops short on a slower one.
        let half_ball = Library::bundled().get("half-ball").unwrap().clone();
        let slow = Table { rolling_friction: 0.19, ..Table::default() };
        let model_shot = |table: Option<&Table>| {
            let mut session = session("match");
            session.table = table.map(|table| Box::new(table.clone()));
            session.model_shot_of(&half_ball)
        };
        let model = half_ball.shot;
        assert_eq!(
            [model_shot(None), model_shot(Some(&Table::default())), model_shot(Some(&slow))],
            [model, model, None]
        );
    }

    #[test]
    fn pushing_a_touching_ball_counts_as_a_miss() {
        let table = Table::default();
        let layout = Layout::parse(&format!("0,0 {},0 -0.3,0.02", 2.0 * table.radius), &table).unwrap();
        let exercise = Exercise::new_own("frozen", Rule::StraightRail, "match", layout);
        let mut session = Session::new(Goal::Free, Venue::Program, vec![exercise], Skill::PERFECT, 1);
        let stroke = |degrees: f64| CueInputs {
            a: 0.0,
            b: -0.4,
            theta: 5.0_f64.to_radians(),
            phi: degrees.to_radians(),
            speed: 3.0,
        };
        let played = session.play(stroke(0.0), false).unwrap();
        let said = played.words(CueBall::White, LengthUnit::Metres);
        assert!(!played.made && said.starts_with("Foul: the stroke pushes yellow"), "{said}");
        assert!(played.verdict.tally.has_hit_both() && !session.attempts[0].made);
        // The same for a shot that is not recorded, and for the make probability.
        let one = PlayedStroke::of(Rule::StraightRail, &table, &layout, stroke(0.0));
        assert!(!one.made && one.verdict.tally.pushed == Some(1));
        for doubt in [Doubt::NONE, Doubt::FULL] {
            let shooter = Shooter { skill: Skill::CLUB, doubt };
            let chance = |cue: &CueInputs| chance(shooter, Rule::StraightRail, &table, &layout, cue).rate;
            assert_eq!(chance(&stroke(0.0)), 0.0, "{doubt}");
            // Off the left rail to red and on to yellow.
            let away = chance(&CueInputs::parse("-0.0948,0.3252,1,-128.0745,1.738").unwrap());
            assert!(away > 0.1, "{doubt}: {away}");
        }
    }

    #[test]
    fn rail_raises_the_cue_or_refuses_it_without_room() {
        let table = Table { room: Some(Room::default()), ..Table::default() };
        let layout = Layout::new([DVec2::new(0.0, -table.half_width()), DVec2::new(-0.5, 0.3), DVec2::new(0.6, 0.1)]);
        let intended = |b| CueInputs { a: 0.0, b, theta: 0.0, phi: std::f64::consts::FRAC_PI_2, speed: 2.0 };
        let raised = |table: &Table, b| super::with_raised_cue(table, &layout, &intended(b));
        let up = raised(&table, 0.395).unwrap();
        assert!(up.theta > 0.1_f64.to_radians() && CueInputs { theta: 0.0, ..up } == intended(0.395), "{up:?}");
        let said = raised(&table, 0.1).unwrap_err().to_string();
        assert!(said.contains("no room") && said.contains("the bottom rail"), "{said}");
        assert_eq!(raised(&Table { room: None, ..table.clone() }, 0.1).unwrap(), intended(0.1));
        assert!(matches!(raised(&table, 0.9), Err(PlayError::Cue(_))));
    }
}
