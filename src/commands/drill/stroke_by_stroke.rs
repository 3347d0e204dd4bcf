//! A session that is played stroke by stroke: each stroke is judged, saved, and then printed.

use serde::Serialize;

use super::{
    options::{PlayOptions, StrokeInput},
    score::{Score, positions_text, words},
};
use crate::{
    coach::{
        Coach, Request, Shooter, ShotWords, Skill,
        words::{TipUnit, Units},
    },
    commands::{
        Failure,
        output::{json_line, plural, print_line, print_note, shot_text, units},
        recommend::coach_for,
    },
    drills::{
        Advice, Exercise, Goal, Par, Session, Store, advise, chance, changes, check, difference,
        exam::{ExamScore, score},
    },
    physics::{CueInputs, least_elevation},
    statistics::SuccessRate,
    table::{CueBall, Layout, Table},
};

/// A session in progress.
pub struct StrokeByStroke<'a> {
    store: &'a Store,
    session: Session,
    options: &'a PlayOptions,
    /// Whether every stroke is compared with the model shot, or otherwise with the coach's shot, which takes time to find.
    compares: bool,
    /// The coach for the most recent table.
    coach: Option<Coach>,
    /// The coach's shot for a layout and a cue ball: for the same ones it is searched only once.
    advice: Option<((Layout, CueBall), Advice)>,
    /// What was printed last: the exercise, the layout, the cue ball and, in JSON, the number of the stroke.
    shown: Option<(String, Layout, CueBall, Option<usize>)>,
}

/// The position of the balls before a stroke.
#[derive(Serialize)]
#[serde(tag = "kind", rename = "position")]
struct Position<'a> {
    number: usize,
    exercise: &'a str,
    title: &'a str,
    rule: &'static str,
    /// Whose errors are played.
    skill: Skill,
    table: &'a str,
    /// The colour of the cue ball, which comes first in the layout.
    cue_ball: CueBall,
    layout: &'a Layout,
}

/// The result of a stroke.
#[derive(Serialize)]
#[serde(tag = "kind", rename = "attempt")]
struct AttemptLine<'a> {
    number: usize,
    exercise: &'a str,
    cue_ball: CueBall,
    made: bool,
    verdict: String,
    helped: bool,
    by_coach: bool,
    run: u32,
    meant: CueInputs,
    played: CueInputs,
    /// How often the player makes the intended shot, with its interval.
    chance: f64,
    chance_interval: [f64; 2],
    #[serde(flatten)]
    advised: Option<Advised>,
    /// Final positions of the balls.
    end: Layout,
}

/// The model shot or the coach's shot, for comparison with the player's.
#[derive(Serialize)]
struct Advised {
    #[serde(rename = "advised")]
    cue: CueInputs,
    #[serde(rename = "advised_chance")]
    chance: f64,
    #[serde(rename = "advised_interval")]
    interval: [f64; 2],
    /// Author of the shot: the model shot if the balls are in its position, otherwise the coach's.
    #[serde(rename = "advised_by")]
    by: &'static str,
    /// The intended inputs minus the advised ones.
    difference: CueInputs,
    /// What to change, in words.
    changes: Vec<String>,
}

#[derive(Serialize)]
#[serde(tag = "kind", rename = "refused")]
struct Refused {
    line: usize,
    error: String,
}

#[derive(Serialize)]
#[serde(tag = "kind", rename = "result")]
struct Outcome {
    /// Absent before the first attempt, with which the session is saved.
    #[serde(skip_serializing_if = "Option::is_none")]
    session: Option<String>,
    over: bool,
    #[serde(flatten)]
    score: Score,
    /// For a match that is over: the ball that has won, or a draw.
    #[serde(skip_serializing_if = "Option::is_none")]
    winner: Option<&'static str>,
    /// For an exam: expected scores.
    #[serde(skip_serializing_if = "Option::is_none")]
    expected: Option<Par>,
    /// For a match: white and yellow, each with its own score.
    #[serde(skip_serializing_if = "Option::is_none")]
    sides: Option<Sides>,
    /// For an exam: standard deviations of the expected scores.
    #[serde(skip_serializing_if = "Option::is_none")]
    spread: Option<Par>,
    #[serde(skip_serializing_if = "Option::is_none")]
    nearest: Option<&'static str>,
}

/// The scores of the two sides of a match.
#[derive(Serialize)]
struct Sides {
    white: Score,
    yellow: Score,
}

fn percent(rate: &SuccessRate) -> String {
    format!("{:.1} %", 100.0 * rate.rate)
}

impl<'a> StrokeByStroke<'a> {
    pub fn new(store: &'a Store, session: Session, options: &'a PlayOptions, compares: bool) -> Self {
        Self { store, session, options, compares, coach: None, advice: None, shown: None }
    }

    /// Returns the session so far.
    pub const fn session(&self) -> &Session {
        &self.session
    }

    /// Prints the position to be played: for people if it has changed, in JSON once before every stroke.
    pub fn show(&mut self, table: &Table, layout: &Layout) -> Result<(), Failure> {
        let Some(Exercise { name, title, rule, .. }) = self.session.exercise() else { return Ok(()) };
        let number = self.session.attempts.len() + 1;
        let cue_ball = self.session.next_cue_ball();
        let shown = Some((name.clone(), *layout, cue_ball, self.options.json.then_some(number)));
        if shown == self.shown {
            return Ok(());
        }
        if self.options.json {
            let rule = rule.name();
            json_line(&Position {
                number,
                exercise: name,
                title,
                rule,
                skill: self.session.shooter().skill,
                table: &table.name,
                cue_ball,
                layout,
            })?;
        } else {
            let title = if title == name { String::new() } else { format!("{title}; ") };
            // A cue ball that is always white is not mentioned.
            let is_mentioned = self.session.is_match() || cue_ball != CueBall::White;
            let mut turn = if is_mentioned { format!("; the cue ball is {cue_ball}") } else { String::new() };
            if self.session.is_equalising() {
                turn += "; the equalising inning";
            }
            print_line(format_args!("{name} ({rule}): {title}{}{turn}", positions_text(table, layout, cue_ball)))?;
        }
        self.shown = shown;
        Ok(())
    }

    /// Plays one stroke and saves it before its result is printed. Returns `false` if the coach was asked for a stroke and found no point.
    pub fn stroke(&mut self, table: &Table, layout: &Layout, stroke: StrokeInput) -> Result<bool, Failure> {
        let Some(rule) = self.session.exercise().map(|exercise| exercise.rule) else { return Ok(true) };
        let (cue_ball, shooter) = (self.session.next_cue_ball(), self.session.shooter());
        let typed = match stroke {
            StrokeInput::Own(typed) => Some(typed.resolve(table, layout, cue_ball)?),
            StrokeInput::Coach => None,
        };
        typed.as_ref().map_or(Ok(()), |cue| check(table, cue)).map_err(Failure::wrong_input)?;
        let by_coach = typed.is_none();
        let own = if by_coach { None } else { self.model_shot(layout) };
        let advice = match own {
            Some(cue) if self.compares => {
                Some(Advice { cue, solved: true, chance: chance(shooter, rule, table, layout, &cue) })
            }
            _ if by_coach || self.compares => self.advice(table, layout)?,
            _ => None,
        };
        let Some(meant) = typed.or(advice.map(|advice| advice.cue)) else { return Ok(false) };
        let played = self.session.play(meant, by_coach).map_err(Failure::wrong_input)?;
        let raised = self.session.attempts.last().and_then(|attempt| attempt.intended).unwrap_or(meant);
        let is_raised = raised != meant;
        let meant = raised;
        let share = chance(shooter, rule, table, layout, &meant);
        if let Some(attempt) = self.session.attempts.last_mut() {
            attempt.by_coach = by_coach;
            attempt.chance = Some(share.rate);
            attempt.advised = advice.map(|advice| advice.cue);
            attempt.advised_chance = advice.map(|advice| advice.chance.rate);
        }
        let attempts = &self.session.attempts;
        let before = &attempts[..attempts.len() - 1];
        if let Err(error) = self.store.save(&self.session, before, before.len()) {
            // The score must count only saved attempts.
            self.session.undo();
            return Err(Failure::failed(error));
        }

        let by = if own.is_some() { "exercise" } else { "coach" };
        let number = self.session.attempts.len();
        // JSON output does not depend on the settings.
        let units = if self.options.json { Units { tip: TipUnit::Mm, ..Units::default() } } else { units() };
        let (verdict, run) = (played.words(cue_ball, units.length), self.session.current_run());
        let changes = advice.map_or_else(Vec::new, |advice| changes(table, &meant, &advice.cue, units));
        let last = self.session.attempts.last();
        if self.options.json {
            let turn = AttemptLine {
                number,
                exercise: last.map_or("", |last| &last.exercise),
                cue_ball,
                made: played.made,
                verdict,
                helped: last.is_some_and(|last| last.helped),
                by_coach: last.is_some_and(|last| last.by_coach),
                run,
                meant,
                played: played.stroke,
                chance: share.rate,
                chance_interval: [share.low, share.high],
                advised: advice.map(|advice| Advised {
                    cue: advice.cue,
                    chance: advice.chance.rate,
                    interval: [advice.chance.low, advice.chance.high],
                    difference: difference(&meant, &advice.cue),
                    by,
                    changes,
                }),
                end: played.end,
            };
            json_line(&turn)?;
            return Ok(true);
        }
        if is_raised {
            let over = least_elevation(table, layout, &meant).ok().and_then(|least| least.over);
            let over = over.map_or(String::new(), |over| format!(": {over} is in the way of a lower one"));
            print_line(format_args!("   the cue is raised to {:.2} degrees{over}", meant.theta.to_degrees()))?;
        }
        let side =
            if self.session.is_match() { format!(", {}", self.session.side_words(cue_ball)) } else { String::new() };
        let standing = self.session.score_words().map_or_else(String::new, |standing| format!("; {standing}"));
        print_line(format_args!(
            "{number}{side}: {verdict}; run {run}{standing}; this shot is made {} of the time",
            percent(&share)
        ))?;
        if by_coach {
            return print_shot("the coach played", table, layout, &meant, cue_ball).map(|()| true);
        }
        if let Some(Advice { cue, chance, .. }) = &advice {
            let whose = if own.is_some() { "model shot" } else { "coach's shot" };
            let share = percent(chance);
            print_shot(&format!("the {whose}, made {share} of the time:"), table, layout, cue, cue_ball)?;
            if !changes.is_empty() {
                print_line(format_args!("   change: {}", changes.join(", ")))?;
            }
        }
        Ok(true)
    }

    /// Explains why the coach did not play.
    pub fn no_point(&self) -> Failure {
        let (budget, simulations) = self.options.limits();
        let (within, option) = match (self.options.simulations, self.options.budget_ms) {
            (None, _) => (format!("{} ms", budget.as_millis()), "--budget-ms"),
            (Some(_), None) => (format!("{simulations} simulations"), "--simulations"),
            (Some(_), Some(time)) => {
                (format!("{simulations} simulations or {time} ms"), "--simulations or --budget-ms")
            }
        };
        Failure::failed(format_args!("the coach found no point in {within}; a larger {option} may help"))
    }

    /// Returns the model shot, if the balls are in its position.
    fn model_shot(&self, layout: &Layout) -> Option<CueInputs> {
        let exercise = self.session.exercise().filter(|exercise| exercise.layout == *layout)?;
        self.session.model_shot_of(exercise).filter(|_| !self.session.is_game())
    }

    fn advice(&mut self, table: &Table, layout: &Layout) -> Result<Option<Advice>, Failure> {
        // The two sides of a match may differ in skill.
        let position = (*layout, self.session.next_cue_ball());
        if let Some((known, advice)) = &self.advice
            && *known == position
        {
            return Ok(Some(*advice));
        }
        let Some(rule) = self.session.exercise().map(|exercise| exercise.rule) else { return Ok(None) };
        let (Shooter { skill, doubt }, seed) = (self.session.shooter(), self.session.seed);
        // In a game, the next point counts, too.
        let plan = self.session.is_game();
        let (budget, simulations) = self.options.limits();
        let jumps = !self.options.no_jumps;
        let request = Request { rule, skill, doubt, plan, jumps, budget, simulations, seed, ..Request::default() };
        let known = self.coach.take().filter(|coach| coach.table() == table);
        let coach = self.coach.insert(known.map_or_else(|| coach_for(table.clone(), "bundled"), Ok)?);
        let advice = advise(coach, layout, &request, self.session.is_coachs_turn()).map_err(Failure::wrong_input)?;
        self.advice = advice.map(|advice| (position, advice));
        Ok(advice)
    }

    pub fn refuse(&self, number: usize, failure: &Failure) -> Result<(), Failure> {
        if self.options.json {
            return Ok(json_line(&Refused { line: number, error: failure.to_string() })?);
        }
        print_note(format_args!("line {number}: {failure}"));
        Ok(())
    }

    /// Prints the score.
    pub fn finish(&self) -> Result<(), Failure> {
        let session = &self.session;
        let record = session.record();
        let score = score(session).filter(|_| session.goal == Goal::Exam);
        if self.options.json {
            return Ok(json_line(&Outcome {
                session: (!session.attempts.is_empty()).then(|| session.id.clone()),
                over: session.is_over(),
                score: record.into(),
                sides: session.is_match().then(|| Sides {
                    white: session.side_record(CueBall::White).into(),
                    yellow: session.side_record(CueBall::Yellow).into(),
                }),
                winner: session.winner(),
                expected: score.map(|score| score.expected),
                spread: score.map(|score| score.spread),
                nearest: score.map(|score| score.nearest),
            })?);
        }
        if let Some(score) = session.score_words() {
            let winner = session.winner_words().unwrap_or_else(|| "not over".to_owned());
            print_line(format_args!("{score}: {winner}"))?;
            for cue_ball in [session.cue_ball, session.cue_ball.other()] {
                print_line(format_args!(
                    "{}: {}",
                    session.side_words(cue_ball),
                    words(&session.side_record(cue_ball))
                ))?;
            }
        } else {
            print_line(words(&record))?;
        }
        match (session.goal, score) {
            (Goal::Run(points), _) if session.is_over() => {
                print_line(format_args!("the run of {points} is made, after {}", plural(record.tried, "attempt")))
            }
            (Goal::Run(points), _) => print_line(format_args!("the run of {points} is not made yet")),
            (Goal::Exam, Some(score)) => print_line(exam_words(&score, session.exercises.len())),
            _ => Ok(()),
        }
    }
}

/// Prints a shot's inputs in the form that is typed, and the shot in words, if it has any.
fn print_shot(
    beginning: &str,
    table: &Table,
    layout: &Layout,
    cue: &CueInputs,
    cue_ball: CueBall,
) -> Result<(), Failure> {
    let words = ShotWords::of(table, layout, cue).ok();
    let words = words.map_or_else(String::new, |words| format!(" ({})", words.sentence(cue_ball, units())));
    print_line(format_args!("   {beginning} {}{words}", shot_text(cue)))
}

fn exam_words(ExamScore { tried, made, expected, spread, nearest }: &ExamScore, of: usize) -> String {
    let unfinished = if *tried < of { format!(" ({tried} of {of} played)") } else { String::new() };
    format!(
        "score {made} of {tried}{unfinished}; a beginner makes {:.1} ± {:.1}, a club player {:.1} ± {:.1}, a world-class player {:.1} ± {:.1} \
         (average and standard deviation): nearest is {nearest}",
        expected.beginner, spread.beginner, expected.club, spread.club, expected.world_class, spread.world_class
    )
}
