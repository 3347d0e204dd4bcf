//! Strokes, one after the other: from the standard input or by the coach, each played, judged, saved and answered at once.

use std::{
    io::{self, BufRead, IsTerminal},
    time::Duration,
};

use serde::Serialize;

use super::{
    desk::player,
    score::{Score, layout_text, plural, shot_text, words},
};
use crate::{
    coach::{Coach, Skill},
    commands::{
        Failure,
        input::ByTable,
        named::skill_called,
        output::{json_line, tell},
        recommend::coach_for,
    },
    drills::{
        Advice, Exercise, Goal, Session, Store, Venue, advise, chance, changes, difference,
        exam::{Mark, mark},
    },
    learning::evaluation::SuccessRate,
    physics::CueInputs,
    table::{Layout, Table},
};

/// The word for the coach's shot in the place of one's own.
const COACH: &str = "coach";

/// Who plays, and how it is told.
#[derive(Debug, clap::Args)]
pub struct Means {
    /// Who plays: perfect, expert, club, beginner, own, or standard errors in mm, degrees and m/s like
    /// "a=0.7,b=0.7,theta=0.2,phi=0.2,V=0.1". Default: own where `carom drill skill --keep` has kept one, else expert.
    #[arg(long, value_parser = skill_called)]
    skill: Option<Skill>,
    /// Seed of the errors; without it they are others every time.
    #[arg(long)]
    seed: Option<u64>,
    /// Time that the coach has for a shot, ms.
    #[arg(long, default_value_t = 300, value_parser = clap::value_parser!(u64).range(0..=3_600_000))]
    budget_ms: u64,
    /// Print JSON: an object a line, of the kinds "position", "attempt", "refused" and "result".
    #[arg(long)]
    json: bool,
}

impl Means {
    /// A session that is played here.
    pub fn session(&self, goal: Goal, exercises: Vec<Exercise>) -> Session {
        let seed = self.seed.unwrap_or_else(rand::random);
        Session::new(goal, Venue::Program, exercises, player(self.skill), seed)
    }
}

/// Where the strokes come from.
#[derive(Clone, Copy, Debug)]
pub enum Strokes {
    /// The standard input, a stroke a line.
    Input,
    /// The coach.
    Coach,
    /// One that is repeated.
    Same(Stroke),
}

/// A stroke that is wanted.
#[derive(Clone, Copy, Debug)]
pub enum Stroke {
    /// The player's.
    Own(CueInputs),
    /// The coach's.
    Coach,
}

impl std::str::FromStr for Stroke {
    type Err = Failure;

    fn from_str(text: &str) -> Result<Self, Failure> {
        if text == COACH {
            return Ok(Self::Coach);
        }
        let cue = CueInputs::parse(text)
            .map_err(|error| Failure::wrong_input(format_args!("{error}, or \"{COACH}\" for the coach's shot")))?;
        Ok(Self::Own(cue))
    }
}

/// Plays a session until it is over, its input has ended, or it has `most` attempts.
pub fn play(store: &Store, session: Session, means: &Means, strokes: Strokes, most: usize) -> Result<(), Failure> {
    let coaches = ByTable::new((|table| coach_for(table, "bundled")) as fn(Table) -> Result<Coach, Failure>);
    let mut bout = Bout { store, session, means, strokes, coaches, advice: None, shown: None };
    let mut input = io::stdin().lock().split(b'\n');
    let (mut lines, mut refused) = (0_usize, 0_usize);
    while bout.session.attempts.len() < most {
        let Some((table, layout)) = bout.session.position().map_err(Failure::failed)? else { break };
        bout.show(&layout)?;
        let stroke = match strokes {
            Strokes::Coach => Ok(Stroke::Coach),
            Strokes::Same(stroke) => Ok(stroke),
            Strokes::Input => {
                prompt("shot a,b,theta,phi,V or coach: ");
                let Some(line) = input.next() else { break };
                let line = line.map_err(|error| Failure::failed(format_args!("the input cannot be read: {error}")))?;
                lines += 1;
                let text = String::from_utf8_lossy(line.trim_ascii()).into_owned();
                if text.is_empty() {
                    continue;
                }
                text.parse()
            }
        };
        match stroke.and_then(|stroke| bout.stroke(&table, &layout, stroke)) {
            // A line that is wrong does not end the session.
            Err(failure) if failure.code() == 2 && matches!(strokes, Strokes::Input) => {
                refused += 1;
                bout.refuse(lines, &failure)?;
            }
            Err(failure) => {
                // What was played counts all the same.
                bout.finish()?;
                return Err(failure);
            }
            Ok(()) => {}
        }
    }
    bout.finish()?;
    if refused > 0 && !io::stdin().is_terminal() {
        return Err(Failure::wrong_input(format_args!("{} refused; each was told why", plural(refused, "line"))));
    }
    Ok(())
}

/// Asks whoever sits at the terminal.
pub fn prompt(words: &str) {
    if io::stdin().is_terminal() {
        // Nobody reads a prompt that cannot be written.
        let _ = io::Write::write_all(&mut io::stderr(), words.as_bytes());
    }
}

/// A session that is being played.
struct Bout<'a> {
    store: &'a Store,
    session: Session,
    means: &'a Means,
    strokes: Strokes,
    coaches: ByTable<Coach, fn(Table) -> Result<Coach, Failure>>,
    /// The coach's shot in a layout: while nothing moves, it is looked for once.
    advice: Option<(Layout, Advice)>,
    /// The exercise and the layout that were told last.
    shown: Option<(String, Layout)>,
}

/// Where the balls lie.
#[derive(Serialize)]
struct Position<'a> {
    kind: &'static str,
    number: usize,
    exercise: &'a str,
    title: &'a str,
    rule: &'static str,
    table: &'a str,
    layout: &'a Layout,
}

/// What came of a stroke.
#[derive(Serialize)]
struct Turn<'a> {
    kind: &'static str,
    number: usize,
    exercise: &'a str,
    made: bool,
    verdict: String,
    helped: bool,
    run: u32,
    meant: CueInputs,
    played: CueInputs,
    /// How often the player makes what was meant, with its interval.
    chance: f64,
    chance_interval: [f64; 2],
    #[serde(flatten)]
    advised: Option<Advised>,
    /// Where the balls came to rest.
    end: Layout,
}

/// The coach's shot beside the player's.
#[derive(Serialize)]
struct Advised {
    advised: CueInputs,
    advised_chance: f64,
    advised_interval: [f64; 2],
    /// What was meant less what is advised.
    difference: CueInputs,
    /// What to change, in words.
    changes: Vec<String>,
}

#[derive(Serialize)]
struct Refused {
    kind: &'static str,
    line: usize,
    error: String,
}

#[derive(Serialize)]
struct Outcome {
    kind: &'static str,
    session: String,
    over: bool,
    #[serde(flatten)]
    score: Score,
    /// Of an exam.
    #[serde(skip_serializing_if = "Option::is_none")]
    expected: Option<crate::drills::Par>,
    #[serde(skip_serializing_if = "Option::is_none")]
    nearest: Option<&'static str>,
}

fn percent(rate: &SuccessRate) -> String {
    format!("{:.1} %", 100.0 * rate.rate)
}

impl Bout<'_> {
    /// Tells what is to be played, where that is news.
    fn show(&mut self, layout: &Layout) -> Result<(), Failure> {
        let Some(Exercise { name, title, rule, table, .. }) = self.session.exercise() else { return Ok(()) };
        let shown = Some((name.clone(), *layout));
        if shown == self.shown {
            return Ok(());
        }
        let number = self.session.attempts.len() + 1;
        if self.means.json {
            let rule = rule.name();
            json_line(&Position { kind: "position", number, exercise: name, title, rule, table, layout })?;
        } else {
            let title = if title == name { String::new() } else { format!("{title}; ") };
            line(format_args!("{name} ({rule}): {title}balls {}", layout_text(layout)))?;
        }
        self.shown = shown;
        Ok(())
    }

    /// Plays one stroke; when its result is told, it is safe on the disk.
    fn stroke(&mut self, table: &Table, layout: &Layout, stroke: Stroke) -> Result<(), Failure> {
        let Some(rule) = self.session.exercise().map(|exercise| exercise.rule) else { return Ok(()) };
        // Somebody who repeats a stroke wants to know a better one; who plays on wants the answer at once.
        let compares = matches!(stroke, Stroke::Coach) || matches!(self.strokes, Strokes::Same(_));
        if let Stroke::Own(cue) = &stroke {
            crate::drills::check(table, cue).map_err(Failure::wrong_input)?;
        }
        let advice = if compares { self.advice(table, layout)? } else { None };
        let meant = match (stroke, advice) {
            (Stroke::Own(cue), _) => cue,
            (Stroke::Coach, Some(advice)) => advice.cue,
            (Stroke::Coach, None) => {
                return Err(Failure::failed(format_args!(
                    "the coach found no point in {} ms; a larger --budget-ms may do",
                    self.means.budget_ms
                )));
            }
        };
        let helped = matches!(stroke, Stroke::Coach);
        let played = self.session.play(meant, helped).map_err(Failure::wrong_input)?;
        let share = chance(self.session.skill, rule, table, layout, &meant);
        if let Some(attempt) = self.session.attempts.last_mut() {
            attempt.chance = Some(share.rate);
            attempt.advised = advice.map(|advice| advice.cue);
            attempt.advised_chance = advice.map(|advice| advice.chance.rate);
        }
        self.store.save(&self.session).map_err(Failure::failed)?;

        let number = self.session.attempts.len();
        let (verdict, run) = (played.verdict(rule), self.session.run());
        let changes = advice.map_or_else(Vec::new, |advice| changes(table, &meant, &advice.cue));
        if self.means.json {
            let turn = Turn {
                kind: "attempt",
                number,
                exercise: self.session.attempts.last().map_or("", |attempt| &attempt.exercise),
                made: played.made,
                verdict,
                helped,
                run,
                meant,
                played: played.stroke,
                chance: share.rate,
                chance_interval: [share.low, share.high],
                advised: advice.map(|advice| Advised {
                    advised: advice.cue,
                    advised_chance: advice.chance.rate,
                    advised_interval: [advice.chance.low, advice.chance.high],
                    difference: difference(&meant, &advice.cue),
                    changes,
                }),
                end: played.end,
            };
            return Ok(json_line(&turn)?);
        }
        line(format_args!("{number}: {verdict}; run {run}; this shot is made {} of the time", percent(&share)))?;
        if helped {
            line(format_args!("   the coach played {}", shot_text(&meant)))?;
        } else if let Some(advice) = advice {
            let changes = if changes.is_empty() { String::new() } else { format!(": {}", changes.join(", ")) };
            let (shot, share) = (shot_text(&advice.cue), percent(&advice.chance));
            line(format_args!("   the coach's shot {shot} is made {share} of the time{changes}"))?;
        }
        Ok(())
    }

    fn advice(&mut self, table: &Table, layout: &Layout) -> Result<Option<Advice>, Failure> {
        if let Some((known, advice)) = &self.advice
            && known == layout
        {
            return Ok(Some(*advice));
        }
        let Some(rule) = self.session.exercise().map(|exercise| exercise.rule) else { return Ok(None) };
        let budget = Duration::from_millis(self.means.budget_ms);
        let coach = self.coaches.get(&table.name)?;
        let Session { skill, seed, .. } = self.session;
        let advice = advise(coach, skill, rule, layout, budget, seed).map_err(Failure::wrong_input)?;
        self.advice = advice.map(|advice| (*layout, advice));
        Ok(advice)
    }

    fn refuse(&self, number: usize, failure: &Failure) -> Result<(), Failure> {
        if self.means.json {
            return Ok(json_line(&Refused { kind: "refused", line: number, error: failure.to_string() })?);
        }
        tell(format_args!("line {number}: {failure}"));
        Ok(())
    }

    /// Tells the score.
    fn finish(&self) -> Result<(), Failure> {
        let session = &self.session;
        let record = session.record();
        let mark = mark(session).filter(|_| session.goal == Goal::Exam);
        if self.means.json {
            return Ok(json_line(&Outcome {
                kind: "result",
                session: session.id.clone(),
                over: session.is_over(),
                score: record.into(),
                expected: mark.map(|mark| mark.expected),
                nearest: mark.map(|mark| mark.nearest),
            })?);
        }
        line(words(&record))?;
        match (session.goal, mark) {
            (Goal::Run(points), _) if session.is_over() => {
                line(format_args!("the run of {points} is made, after {}", plural(record.tried, "attempt")))
            }
            (Goal::Run(points), _) => line(format_args!("the run of {points} is not made yet")),
            (Goal::Exam, Some(mark)) => line(mark_words(&mark, session.exercises.len())),
            _ => Ok(()),
        }
    }
}

fn mark_words(Mark { tried, made, expected, nearest }: &Mark, of: usize) -> String {
    let unfinished = if *tried < of { format!(" ({tried} of {of} played)") } else { String::new() };
    format!(
        "score {made} of {tried}{unfinished}; on average a beginner makes {:.1}, a club player {:.1}, an expert {:.1}: \
         nearest is {nearest}",
        expected.beginner, expected.club, expected.expert
    )
}

/// A line on the standard output.
pub fn line(text: impl std::fmt::Display) -> Result<(), Failure> {
    use io::Write;
    Ok(writeln!(io::stdout(), "{text}")?)
}
