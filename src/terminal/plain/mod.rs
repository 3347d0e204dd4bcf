//! Plain mode: the coach as a conversation, with commands as input lines and sentences as output. For screen readers, dumb terminals and
//! scripts.

mod command;
mod film;
pub mod follow;
mod speech;
#[cfg(test)]
mod tests;

use std::{
    io::{self, BufRead, Write},
    time::Duration,
};

use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::{
    coach::{
        Coach, FirstContact, Pattern, Request, Sensitivity, ShotWords, Skill, StrokeText, Technique, Units, Verdict,
        Why, aim, judge, systems::guide, why,
    },
    game::Point,
    physics::CueInputs,
    simulation::Recording,
    statistics::SuccessRate,
    storage::{MAX_LINE_BYTES, NextLine, next_line},
    table::{CueBall, Layout, Side, Table},
    terminal::{
        Settings,
        plain::command::Command,
        shot::{History, placing::slide},
    },
};

/// A shot found by the coach or tried by the player.
#[derive(Clone, Copy, Debug)]
struct ShotCandidate {
    cue: CueInputs,
    /// Whether it is the best attempt of a search that found no point.
    is_attempt: bool,
    rate: Option<SuccessRate>,
    /// Success rate of the next point, if known.
    next: Option<f64>,
}

/// State of a conversation.
struct Conversation {
    coach: Coach,
    request: Request,
    /// The player's own skill and its source, if there is one.
    own: Option<(Skill, &'static str)>,
    balls: History<(Layout, CueBall)>,
    /// The shots found for the present balls, and the index of the one being discussed.
    shots: Vec<ShotCandidate>,
    chosen: usize,
    /// Why the first shot is best.
    why: Option<Why>,
    units: Units,
    rng: Xoshiro256PlusPlus,
}

/// Initial state of a conversation.
#[derive(Clone, Copy, Debug)]
pub struct InitialState {
    /// Positions of the balls.
    pub layout: Layout,
    /// The player's own skill, if saved; otherwise an average in the settings is used.
    pub own: Option<Skill>,
    /// Seed for random layouts.
    pub seed: u64,
}

/// Number of attempts that measure the success rate of a player's own stroke.
const ATTEMPTS: usize = 1000;

/// Answer to a line: the text, or why the line is refused.
type Answer = Result<String, String>;

/// Runs the conversation until the input ends or the player quits, with a `prompt` before each line. Returns how many lines were refused.
///
/// # Errors
/// Any error of reading or writing.
pub fn converse(
    coach: Coach,
    InitialState { layout, own, seed }: InitialState,
    settings: &Settings,
    mut input: impl BufRead,
    mut output: impl Write,
    prompt: &str,
) -> io::Result<usize> {
    let request = Request {
        rule: settings.rule,
        skill: settings.skill,
        doubt: settings.doubt,
        plan: settings.plan,
        jumps: settings.jumps,
        budget: Duration::from_millis(settings.think_ms),
        ..Request::default()
    };
    let rng = Xoshiro256PlusPlus::seed_from_u64(seed);
    let mut talk = Conversation {
        coach,
        request,
        own: own
            .map(|skill| (skill, "by your notes"))
            .or_else(|| settings.skill.as_average().map(|_| (settings.skill, "as set"))),
        balls: History::new((layout, CueBall::White)),
        shots: Vec::new(),
        chosen: 0,
        why: None,
        units: settings.units,
        rng,
    };
    write!(output, "carom. Say help for a list of commands.\n{}\n{prompt}", talk.positions())?;
    output.flush()?;
    let mut refused = 0;
    // Lines that are not UTF-8 are answered like any other unknown command.
    let mut line = Vec::new();
    loop {
        let command = match next_line(&mut input, &mut line)? {
            NextLine::End => break,
            NextLine::TooLong => Err(format!("That line is too long; accepted are up to {MAX_LINE_BYTES} bytes.")),
            NextLine::Line => String::from_utf8_lossy(line.trim_ascii_end()).parse(),
        };
        let answer = match command {
            Ok(Command::Quit) => break,
            Ok(command) => talk.answer(command),
            Err(sentence) => Err(sentence),
        };
        refused += usize::from(answer.is_err());
        let (Ok(said) | Err(said)) = answer;
        write!(output, "{}\n{prompt}", speech::to_spoken(&said))?;
        output.flush()?;
    }
    Ok(refused)
}

impl Conversation {
    fn table(&self) -> &Table {
        self.coach.table()
    }

    const fn layout(&self) -> &Layout {
        &self.balls.present().0
    }

    const fn cue_ball(&self) -> CueBall {
        self.balls.present().1
    }

    fn positions(&self) -> String {
        speech::positions(self.table(), self.layout(), self.cue_ball(), self.units.length)
    }

    fn answer(&mut self, command: Command) -> Answer {
        Ok(match command {
            Command::Where => self.positions(),
            Command::Balls(text) => {
                let layout = Layout::parse(&text, self.table()).map_err(|error| error.to_string())?;
                layout.validate(self.table()).map_err(|error| error.for_player(self.cue_ball()).to_string())?;
                self.place(layout)
            }
            Command::CueBall(cue_ball) if cue_ball == self.cue_ball() => format!("The cue ball is {cue_ball} already."),
            Command::CueBall(cue_ball) => {
                self.balls.push((self.layout().for_the_opponent(), cue_ball));
                self.drop_shots(format!("The cue ball is {cue_ball}."))
            }
            Command::Move(colour, step) => {
                let ball = self.cue_ball().to_ball_order([0, 1, 2])[colour];
                let moved = slide(self.table(), self.layout(), ball, step);
                let stopped = moved.stop_message(ball, self.cue_ball().names());
                let stopped = stopped.map_or(String::new(), |place| format!("\nIt stops there, {place}."));
                self.place(moved.layout) + &stopped
            }
            Command::Opening(side) => self.open(side),
            Command::Random => {
                let layout = Layout::random(self.coach.table(), &mut self.rng);
                self.place(layout)
            }
            Command::Rule(rule) => {
                self.request.rule = rule;
                self.drop_shots(format!("The rule is {rule}."))
            }
            Command::Skill(skill) => {
                self.request.skill = skill;
                self.drop_shots(speech::now_plays(skill))
            }
            Command::OwnSkill => {
                let (skill, from) = self
                    .own
                    .ok_or("No skill of your own is saved yet; carom drill skill --keep estimates and saves it.")?;
                self.request.skill = skill;
                self.drop_shots(format!("You average {}, {from}.", speech::average(skill)))
            }
            Command::Plan(plan) => {
                self.request.plan = plan;
                self.drop_shots(format!("The next point {}.", if plan { "counts too" } else { "does not count" }))
            }
            Command::First(word) => {
                let names = self.cue_ball().names();
                self.request.first = FirstContact::parse(&word, names).map_err(|error| error.to_string())?;
                self.drop_shots(format!("Met first: {word}."))
            }
            Command::PlanNow => self.plan_words(),
            Command::Chances => self.with_chosen_shot(|talk, _| {
                let of = |shot: &ShotCandidate| {
                    speech::chance(talk.attempt_words(shot), shot.rate, talk.request.skill).join(" ")
                };
                let line = |(number, shot): (usize, &ShotCandidate)| format!("Shot {number}. {}", of(shot));
                Ok((1..).zip(&talk.shots).map(line).collect::<Vec<_>>().join("\n"))
            })?,
            Command::Why => self.with_chosen_shot(|talk, _| talk.reasons())?,
            Command::Shot => self.ask()?,
            Command::Try(words) => self.try_stroke(&words)?,
            Command::Other if self.shots.len() > 1 => {
                self.chosen = (self.chosen + 1) % self.shots.len();
                self.describe()?
            }
            Command::Other => return Err("There is no other shot; say shot to ask for one.".to_owned()),
            Command::Margins => self.with_chosen_shot(|talk, shot| {
                let Request { rule, .. } = talk.request;
                let doubt = talk.request.shooter().effective_doubt();
                Ok(match Sensitivity::new(rule, talk.table(), talk.layout(), doubt).margins(&shot.cue) {
                    Some(found) => speech::margins(&found, talk.units.length),
                    None => "This shot makes no point.".to_owned(),
                })
            })?,
            Command::Numbers => self.with_chosen_shot(|talk, shot| {
                let aim = aim(talk.table(), talk.layout(), &shot.cue).ok();
                Ok(speech::stroke(talk.table(), &shot.cue, aim.as_ref(), talk.cue_ball(), talk.units))
            })?,
            Command::System => self.with_chosen_shot(|talk, shot| {
                Ok(speech::system(guide(talk.table(), &talk.recorded(shot)?).as_ref()))
            })?,
            Command::Words => speech::words(self.table(), self.units.length),
            Command::Describe(all) => self.with_chosen_shot(|talk, shot| {
                let recording = talk.recorded(shot)?;
                let verdict = Verdict::of(talk.request.rule, talk.table(), talk.layout(), &recording);
                let outcome = verdict.words(talk.cue_ball(), talk.units.length);
                Ok(format!("{}\n{outcome}.", speech::events(&recording, all, talk.cue_ball(), talk.units.length)))
            })?,
            Command::NextPosition => self.place_end()?,
            Command::Films => film::list(),
            Command::Film(number) => film::describe(number, self.units.length)?,
            Command::Undo if self.balls.undo() => self.drop_shots(self.positions()),
            Command::Undo => return Err("There is nothing to undo.".to_owned()),
            Command::Help => command::help(),
            Command::Quit => String::new(),
        })
    }

    /// Puts the balls on their spots.
    fn open(&mut self, side: Side) -> String {
        let layout = Layout::opening_on(self.table(), side);
        let asks = Point::of(self.request.rule, self.table(), &layout).red_first;
        self.place(layout) + if asks { "\nThe first shot of a game has to meet red first." } else { "" }
    }

    /// Moves the balls to `layout`.
    fn place(&mut self, layout: Layout) -> String {
        // If no ball moves, there is no step to undo.
        if layout == *self.layout() {
            return self.positions();
        }
        self.balls.push((layout, self.cue_ball()));
        self.drop_shots(self.positions())
    }

    /// Drops the shots, because they were for another situation.
    fn drop_shots(&mut self, sentence: String) -> String {
        self.shots.clear();
        sentence
    }

    /// Places the balls as the chosen shot leaves them.
    fn place_end(&mut self) -> Answer {
        let shot = self.shots.get(self.chosen).ok_or(NO_SHOT)?;
        let end = self.recorded(shot)?.final_layout();
        end.validate(self.table()).map_err(|error| error.for_player(self.cue_ball()).to_string())?;
        Ok(self.place(end))
    }

    fn ask(&mut self) -> Answer {
        // Another question has its own errors, so that the former shots are judged anew.
        self.request.seed = self.request.seed.wrapping_add(1);
        let request = Request { former: self.shots.iter().map(|shot| shot.cue).collect(), ..self.request.clone() };
        let advice = self.coach.recommend(self.layout(), &request).map_err(|error| error.to_string())?;
        let shooter = self.request.shooter();
        self.why =
            why(shooter, self.request.rule, self.table(), self.layout(), &advice, 0).ok().filter(|_| advice.solved);
        let best = ShotCandidate {
            cue: advice.cue,
            is_attempt: advice.kind.is_none(),
            rate: advice.make_probability,
            next: advice.next_probability,
        };
        let others = advice.alternatives.iter().map(|shot| ShotCandidate {
            cue: shot.cue,
            is_attempt: false,
            rate: shot.make_probability,
            next: shot.next_probability,
        });
        self.shots = std::iter::once(best).chain(others).collect();
        self.chosen = 0;
        let next = best.next.map_or(String::new(), |next| format!("\n{}", speech::next_point(next)));
        let others = match self.shots.len() - 1 {
            0 => "There is no other shot.".to_owned(),
            1 => "There is 1 other shot.".to_owned(),
            others => format!("There are {others} other shots."),
        };
        Ok(format!("{}{next}\n{others}", self.describe()?))
    }

    /// Describes a stroke of the player's own, given in words.
    fn try_stroke(&mut self, words: &str) -> Answer {
        let before = self.shots.get(self.chosen).map(|shot| shot.cue);
        let read = StrokeText::parse(words);
        let said = read.and_then(|said| said.stroke(self.table(), self.layout(), self.cue_ball(), before.as_ref()));
        let cue = said.map_err(|error| error.to_string())?;
        let Request { rule, seed, .. } = self.request;
        let has_errors = !self.request.skill.is_perfect();
        let rate = has_errors
            .then(|| judge(self.request.shooter(), rule, self.table(), self.layout(), &cue, 0..ATTEMPTS, seed));
        let found = ShotCandidate { cue, is_attempt: false, rate, next: None };
        let verdict = Verdict::of(rule, self.table(), self.layout(), &self.recorded(&found)?);
        if self.shots.is_empty() {
            self.why = None;
        }
        self.shots.push(found);
        self.chosen = self.shots.len() - 1;
        Ok(format!("{}\n{}.", self.describe()?, verdict.words(self.cue_ball(), self.units.length)))
    }

    /// Says whether the next point counts too.
    fn plan_words(&self) -> String {
        if self.request.skill.is_perfect() {
            return "The next point does not count for a player without errors, who makes every shot.".to_owned();
        }
        speech::plan(self.request.plan, self.shots.get(self.chosen).and_then(|shot| shot.next))
    }

    /// Says why the first shot is recommended.
    fn reasons(&self) -> Answer {
        if let Some(attempt) = self.shots.first().and_then(|first| self.attempt_words(first)) {
            return Ok(attempt);
        }
        let why = self.why.as_ref().ok_or("No reason is known why the first shot is best.")?;
        Ok(format!("The first shot. {}", why.words(self.cue_ball(), self.units)))
    }

    /// Says of an attempt that it makes no point, and why none does.
    fn attempt_words(&self, shot: &ShotCandidate) -> Option<String> {
        let first = self.request.first;
        let rule = first.forbidden_by(Point::of(self.request.rule, self.table(), self.layout()));
        let none = || match rule {
            Some(rule) => {
                let opening = first.opening_words(self.cue_ball().names());
                format!("There is no point{opening}: {rule}; this is only an attempt.")
            }
            None => "No point was found; this is the best attempt.".to_owned(),
        };
        shot.is_attempt.then(none)
    }

    /// Describes the chosen shot.
    fn describe(&self) -> Answer {
        self.with_chosen_shot(|talk, shot| {
            let mut lines = Vec::new();
            let (cue_ball, units) = (talk.cue_ball(), talk.units);
            let recording = Recording::new(talk.table(), talk.layout(), &shot.cue).ok();
            if let Some(recording) = &recording {
                let technique = Technique::of_recorded(talk.table(), recording);
                let words = ShotWords::of_technique(talk.table(), talk.layout(), &shot.cue, &technique);
                lines.extend([words.sentence(cue_ball, units), words.course(cue_ball, units), words.aim(units)]);
                let first = talk.request.first;
                if shot.is_attempt && !first.allows_words(&words) {
                    lines.push(format!("No attempt was found{}.", first.opening_words(cue_ball.names())));
                }
                let pattern = Pattern::of(&technique);
                lines.extend(
                    pattern.map(|pattern| format!("Pattern: {}: {}.", pattern.name, pattern.course_of(&technique))),
                );
            }
            lines.extend(speech::chance(talk.attempt_words(shot), shot.rate, talk.request.skill));
            let why = talk.why.as_ref().filter(|_| talk.chosen == 0);
            lines.extend(why.map(|why| why.words(cue_ball, units)));
            let system = recording.filter(|_| !shot.is_attempt).and_then(|shot| guide(talk.table(), &shot));
            lines.extend(system.map(|system| format!("{}.", system.shot_words())));
            Ok(lines.join("\n"))
        })
    }

    fn with_chosen_shot(&self, say: impl Fn(&Self, &ShotCandidate) -> Answer) -> Answer {
        say(self, self.shots.get(self.chosen).ok_or(NO_SHOT)?)
    }

    fn recorded(&self, shot: &ShotCandidate) -> Result<Recording, String> {
        Recording::new(self.table(), self.layout(), &shot.cue).map_err(|error| error.to_string())
    }
}

const NO_SHOT: &str = "There is no shot yet; say shot to ask for one.";
