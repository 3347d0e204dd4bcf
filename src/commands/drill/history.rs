//! `carom drill history`: records and sessions of past practice.

use serde::Serialize;

use super::{
    Workspace,
    score::{Score, words},
};
use crate::{
    commands::{
        Failure,
        output::{json_line, print_line, print_note, print_table},
    },
    drills::{Goal, Record, Session, Venue},
    game::Rule,
    printing::{format_utc, local_time},
};

/// Show the records of all exercises and games, or the sessions of one of them.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Name or title of the exercise whose sessions are shown. An exercise that is no longer in the library keeps its history.
    name: Option<String>,
    /// Show the games under this rule instead: straight, one-cushion or three-cushion.
    #[arg(long, value_name = "RULE", conflicts_with = "name")]
    games: Option<Rule>,
    /// Print JSON: one object for each exercise or session.
    #[arg(long)]
    json: bool,
}

/// The subject of a row.
#[derive(Clone, PartialEq)]
enum Subject {
    Exercise(String),
    Game(Rule),
}

impl Subject {
    /// Returns its record in these sessions.
    fn record<'a>(&self, sessions: impl IntoIterator<Item = &'a Session>) -> Record {
        match self {
            Self::Exercise(name) => Record::of_exercise(sessions, name),
            Self::Game(rule) => Record::of(sessions, |session, attempt| {
                session.is_game() && session.exercise_of(attempt).is_some_and(|game| game.rule == *rule)
            }),
        }
    }

    fn of(session: &Session) -> Vec<Self> {
        if session.is_game() {
            return session.exercises.iter().map(|game| Self::Game(game.rule)).collect();
        }
        session.exercises.iter().map(|exercise| Self::Exercise(exercise.name.clone())).collect()
    }

    fn name(&self) -> String {
        match self {
            Self::Exercise(name) => name.clone(),
            Self::Game(rule) => format!("game, {rule}"),
        }
    }
}

#[derive(Serialize)]
struct ExerciseRow {
    name: String,
    #[serde(flatten)]
    score: Score,
}

#[derive(Serialize)]
struct SessionRow<'a> {
    session: &'a str,
    started: String,
    goal: Goal,
    venue: Venue,
    #[serde(flatten)]
    score: Score,
}

pub fn run(args: &Args) -> Result<(), Failure> {
    let workspace = Workspace::open();
    let sessions = workspace.sessions();
    match (&args.name, args.games) {
        (Some(name), _)
            if let Some(game) = Rule::ALL.map(Subject::Game).into_iter().find(|game| game.name() == *name) =>
        {
            one(&game, &sessions, args.json)
        }
        (Some(name), _) => {
            let mut subject = Subject::Exercise(name.clone());
            // An unknown name is an error; an exercise that was never tried is not.
            if subject.record(&sessions).tried == 0 {
                subject = Subject::Exercise(workspace.exercise(name)?.name.clone());
            }
            one(&subject, &sessions, args.json)
        }
        (None, Some(rule)) => one(&Subject::Game(rule), &sessions, args.json),
        (None, None) => all(&sessions, args.json),
    }
}

fn share(record: &Record) -> String {
    format!("{:.0} %", 100.0 * record.rate.rate)
}

fn average(record: &Record) -> String {
    record.average.map_or_else(|| "-".to_owned(), |average| format!("{average:.2}"))
}

/// Formats the high run, or "-" if the order of the attempts is unknown.
pub(super) fn high_run(record: &Record) -> String {
    if record.innings > 0 { record.high_run.to_string() } else { "-".to_owned() }
}

fn all(sessions: &[Session], json: bool) -> Result<(), Failure> {
    let mut subjects: Vec<Subject> = Vec::new();
    for subject in sessions.iter().flat_map(Subject::of) {
        if !subjects.contains(&subject) {
            subjects.push(subject);
        }
    }
    let mut rows = Vec::new();
    for subject in subjects {
        let record = subject.record(sessions);
        if record.tried == 0 {
            continue;
        }
        for (venue, record) in Record::by_venue(sessions, |sessions| subject.record(sessions)) {
            rows.push([
                subject.name(),
                venue.word().to_owned(),
                record.made.to_string(),
                record.tried.to_string(),
                share(&record),
                average(&record),
                high_run(&record),
                record.last.map_or_else(String::new, |last| local_time(&format_utc(last))),
            ]);
        }
        if json {
            json_line(&ExerciseRow { name: subject.name(), score: record.into() })?;
        }
    }
    if rows.is_empty() {
        print_note("nothing was practised yet; carom drill list shows the exercises");
    } else if !json {
        let heads = ["name", "where", "made", "tried", "rate", "average", "high run", "last"];
        print_table(heads, rows, &[2, 3, 4, 5, 6])?;
    }
    Ok(())
}

fn one(subject: &Subject, sessions: &[Session], json: bool) -> Result<(), Failure> {
    let tried = sessions.iter().map(|session| (session, subject.record([session])));
    let tried: Vec<(&Session, Record)> = tried.filter(|(_, record)| record.tried > 0).collect();
    let mut rows = Vec::new();
    for (session, record) in &tried {
        if json {
            json_line(&SessionRow {
                session: &session.id,
                started: format_utc(session.started),
                goal: session.goal,
                venue: session.venue,
                score: (*record).into(),
            })?;
        }
        rows.push([
            local_time(&format_utc(session.started)),
            session.venue.word().to_owned(),
            session.score_words().unwrap_or_else(|| session.goal.words()),
            record.made.to_string(),
            record.tried.to_string(),
            share(record),
            high_run(record),
        ]);
    }
    if json {
        return Ok(());
    }
    if tried.is_empty() {
        print_note(format_args!("{}: not tried yet", subject.name()));
        return Ok(());
    }
    print_table(["started", "where", "goal or score", "made", "tried", "rate", "high run"], rows, &[3, 4, 5, 6])?;
    print_line(format_args!("rate   {}", bars(&tried)))?;
    for (venue, record) in Record::by_venue(sessions, |sessions| subject.record(sessions)) {
        print_line(format_args!("{:<6} {}", venue.word(), words(&record)))?;
    }
    Ok(())
}

/// Maximum number of sessions in the chart: the most recent ones.
const BARS: usize = 60;

/// Returns the rate of each session as a bar, from 0 to 100 %.
fn bars(sessions: &[(&Session, Record)]) -> String {
    const HEIGHTS: [char; 8] = ['▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];
    let highest = (HEIGHTS.len() - 1) as f64;
    let bar = |(_, record): &(&Session, Record)| HEIGHTS[(record.rate.rate * highest).round() as usize];
    sessions[sessions.len().saturating_sub(BARS)..].iter().map(bar).collect()
}
