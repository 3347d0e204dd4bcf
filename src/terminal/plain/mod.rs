//! The coach as a conversation: lines in, sentences out. For screen readers, dumb terminals and scripts.

mod command;
mod film;
pub mod follow;
mod speech;

use std::{
    io::{self, BufRead, Write},
    time::Duration,
};

use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::{
    coach::{
        Coach, FirstMet, Kind, Pattern, Request, Sensitivity, ShotWords, Skill, Technique, Units, Verdict, Why, aim,
        systems::guide, why,
    },
    game::Point,
    physics::CueInputs,
    simulation::Recording,
    statistics::SuccessRate,
    table::{CueBall, Layout, Side, Table},
    terminal::{
        Settings,
        plain::command::Command,
        shot::{History, placing::slide},
    },
};

/// A shot that was found.
#[derive(Clone, Copy, Debug)]
struct Found {
    cue: CueInputs,
    kind: Option<Kind>,
    rate: Option<SuccessRate>,
    /// How often the point after it is made, where that is known.
    next: Option<f64>,
}

/// A conversation on its way.
struct Conversation {
    coach: Coach,
    request: Request,
    /// The player's own skill, where one is kept.
    own: Option<Skill>,
    balls: History<(Layout, CueBall)>,
    /// The shots that were found for the balls as they lie, and which of them is spoken of.
    shots: Vec<Found>,
    chosen: usize,
    /// Why the first of them leads.
    why: Option<Why>,
    units: Units,
    rng: Xoshiro256PlusPlus,
}

/// What a conversation begins with.
#[derive(Clone, Copy, Debug)]
pub struct Beginning {
    /// Where the balls lie.
    pub layout: Layout,
    /// The player's own skill, where one is kept; else an average in the settings is it.
    pub own: Option<Skill>,
    /// What decides about random layouts.
    pub seed: u64,
}

/// What is said to a line: what it asked for, or why it is refused.
type Answer = Result<String, String>;

/// Talks until the input ends or the player quits; with a `prompt` before every answer that is awaited. Returns how many lines were
/// refused.
///
/// # Errors
/// What reading or writing reports.
pub fn converse(
    coach: Coach,
    Beginning { layout, own, seed }: Beginning,
    settings: &Settings,
    input: impl BufRead,
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
        own: own.or_else(|| settings.skill.as_average().map(|_| settings.skill)),
        balls: History::new((layout, CueBall::White)),
        shots: Vec::new(),
        chosen: 0,
        why: None,
        units: settings.units,
        rng,
    };
    write!(output, "carom. Say help for what may be said.\n{}\n{prompt}", talk.places())?;
    output.flush()?;
    let mut refused = 0;
    // What is no UTF-8 is no command either, and is answered so.
    for line in input.split(b'\n') {
        let answer = match String::from_utf8_lossy(&line?).parse() {
            Ok(Command::Quit) => break,
            Ok(command) => talk.answer(command),
            Err(sentence) => Err(sentence),
        };
        refused += usize::from(answer.is_err());
        let (Ok(said) | Err(said)) = answer;
        write!(output, "{}\n{prompt}", speech::for_ears(&said))?;
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

    fn places(&self) -> String {
        speech::places(self.table(), self.layout(), self.cue_ball(), self.units.length)
    }

    fn answer(&mut self, command: Command) -> Answer {
        Ok(match command {
            Command::Where => self.places(),
            Command::Balls(text) => {
                let layout = Layout::parse(&text, self.table()).map_err(|error| error.to_string())?;
                layout.validate(self.table()).map_err(|error| error.told_to(self.cue_ball()).to_string())?;
                self.place(layout)
            }
            Command::CueBall(cue_ball) if cue_ball == self.cue_ball() => format!("The cue ball is {cue_ball} already."),
            Command::CueBall(cue_ball) => {
                self.balls.push((self.layout().for_the_opponent(), cue_ball));
                self.forget(format!("The cue ball is {cue_ball}."))
            }
            Command::Move(colour, step) => {
                let ball = self.cue_ball().ordered([0, 1, 2])[colour];
                let moved = slide(self.table(), self.layout(), ball, step);
                let stopped = moved.stop_words(ball, self.cue_ball().names());
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
                self.forget(format!("The rule is {rule}."))
            }
            Command::Skill(skill) => {
                self.request.skill = skill;
                self.forget(speech::now_plays(skill))
            }
            Command::OwnSkill => {
                let skill = self
                    .own
                    .ok_or("No skill of your own is kept yet; carom drill skill --keep estimates and keeps it.")?;
                self.request.skill = skill;
                self.forget(format!("The player is you: {skill}."))
            }
            Command::Plan(plan) => {
                self.request.plan = plan;
                self.forget(format!("The next point {}.", if plan { "counts too" } else { "does not count" }))
            }
            Command::First(word) => {
                let names = self.cue_ball().names();
                self.request.first = FirstMet::said(&word, names).map_err(|error| error.to_string())?;
                self.forget(format!("Met first: {word}."))
            }
            Command::PlanNow => speech::plan(self.request.plan, self.shots.get(self.chosen).and_then(|shot| shot.next)),
            Command::Chances => self.about_the_shot(|talk, _| {
                let of = |shot: &Found| speech::chance(shot.kind, shot.rate, talk.request.skill).join(" ");
                let line = |(number, shot): (usize, &Found)| format!("Shot {number}. {}", of(shot));
                Ok((1..).zip(&talk.shots).map(line).collect::<Vec<_>>().join("\n"))
            })?,
            Command::Why => self.about_the_shot(|talk, _| {
                let why = talk.why.as_ref().ok_or("No reason is known why the first shot leads.")?;
                Ok(format!("The first shot. {}", why.words(talk.cue_ball(), talk.units)))
            })?,
            Command::Shot => self.ask()?,
            Command::Other if self.shots.len() > 1 => {
                self.chosen = (self.chosen + 1) % self.shots.len();
                self.describe()?
            }
            Command::Other => return Err("There is no other shot; say shot to ask for one.".to_owned()),
            Command::Margins => self.about_the_shot(|talk, shot| {
                let Request { rule, .. } = talk.request;
                let doubt = talk.request.shooter().doubts();
                Ok(match Sensitivity::new(rule, talk.table(), talk.layout(), doubt).margins(&shot.cue) {
                    Some(found) => speech::margins(&found, talk.units.length),
                    None => "This shot makes no point.".to_owned(),
                })
            })?,
            Command::Numbers => self.about_the_shot(|talk, shot| {
                let aim = aim(talk.table(), talk.layout(), &shot.cue).ok();
                Ok(speech::stroke(talk.table(), &shot.cue, aim.as_ref(), talk.cue_ball(), talk.units))
            })?,
            Command::System => self
                .about_the_shot(|talk, shot| Ok(speech::system(guide(talk.table(), &talk.recorded(shot)?).as_ref())))?,
            Command::Words => speech::words(self.table(), self.units.length),
            Command::Tell(all) => self.about_the_shot(|talk, shot| {
                let recording = talk.recorded(shot)?;
                let verdict = Verdict::of(talk.request.rule, talk.table(), talk.layout(), &recording);
                let outcome = verdict.words(talk.cue_ball(), talk.units.length);
                Ok(format!("{}\n{outcome}.", speech::events(&recording, all, talk.cue_ball(), talk.units.length)))
            })?,
            Command::GoOn => {
                let shot = self.shots.get(self.chosen).ok_or(NO_SHOT)?;
                let end = self.recorded(shot)?.final_layout();
                self.place(end)
            }
            Command::Films => film::list(),
            Command::Film(number) => film::tell(number, self.units.length)?,
            Command::Undo if self.balls.undo() => self.forget(self.places()),
            Command::Undo => return Err("There is nothing to take back.".to_owned()),
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

    /// Puts the balls elsewhere.
    fn place(&mut self, layout: Layout) -> String {
        // What moves nothing is no step that could be taken back.
        if layout == *self.layout() {
            return self.places();
        }
        self.balls.push((layout, self.cue_ball()));
        self.forget(self.places())
    }

    /// The shots were for something else.
    fn forget(&mut self, sentence: String) -> String {
        self.shots.clear();
        sentence
    }

    fn ask(&mut self) -> Answer {
        let request = Request { former: self.shots.iter().map(|shot| shot.cue).collect(), ..self.request.clone() };
        let advice = self.coach.recommend(self.layout(), &request).map_err(|error| error.to_string())?;
        let shooter = self.request.shooter();
        self.why =
            why(shooter, self.request.rule, self.table(), self.layout(), &advice, 0).ok().filter(|_| advice.solved);
        let best =
            Found { cue: advice.cue, kind: advice.kind, rate: advice.make_probability, next: advice.next_probability };
        let others = advice.alternatives.iter().map(|shot| Found {
            cue: shot.cue,
            kind: Some(shot.kind),
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

    /// The shot that is spoken of.
    fn describe(&self) -> Answer {
        self.about_the_shot(|talk, shot| {
            let mut lines = Vec::new();
            let (cue_ball, units) = (talk.cue_ball(), talk.units);
            let recording = Recording::new(talk.table(), talk.layout(), &shot.cue).ok();
            if let Some(recording) = &recording {
                let technique = Technique::of_recorded(talk.table(), recording);
                let words = ShotWords::of_technique(talk.table(), talk.layout(), &shot.cue, &technique);
                lines.extend([words.sentence(cue_ball, units), words.course(cue_ball, units), words.aim(units)]);
                let pattern = Pattern::of(&technique);
                lines.extend(
                    pattern.map(|pattern| format!("Pattern: {}: {}.", pattern.name, pattern.course_of(&technique))),
                );
            }
            lines.extend(speech::chance(shot.kind, shot.rate, talk.request.skill));
            let why = talk.why.as_ref().filter(|_| talk.chosen == 0);
            lines.extend(why.map(|why| why.words(cue_ball, units)));
            let system = recording.filter(|_| shot.kind.is_some()).and_then(|shot| guide(talk.table(), &shot));
            lines.extend(system.map(|system| format!("{system}.")));
            Ok(lines.join("\n"))
        })
    }

    fn about_the_shot(&self, say: impl Fn(&Self, &Found) -> Answer) -> Answer {
        say(self, self.shots.get(self.chosen).ok_or(NO_SHOT)?)
    }

    fn recorded(&self, shot: &Found) -> Result<Recording, String> {
        Recording::new(self.table(), self.layout(), &shot.cue).map_err(|error| error.to_string())
    }
}

const NO_SHOT: &str = "There is no shot yet; say shot to ask for one.";

#[cfg(test)]
mod tests {
    use super::*;
    use crate::coach::words::LengthUnit;
    use std::time::Instant;

    fn talk(lines: &str) -> String {
        talk_of(None, lines)
    }

    /// With a player whose own skill this is.
    fn talk_of(own: Option<Skill>, lines: &str) -> String {
        let table = Table::default();
        let layout = Layout::parse("-0.5,0 0,0 0.5,0.03", &table).unwrap();
        let mut output = Vec::new();
        let settings = Settings { think_ms: 1_000, ..Settings::default() };
        let beginning = Beginning { layout, own, seed: 1 };
        converse(Coach::new(table), beginning, &settings, lines.as_bytes(), &mut output, "").unwrap();
        String::from_utf8(output).unwrap()
    }

    #[test]
    fn a_shot_is_told_its_margins_its_course_and_its_end() {
        let said = talk("shot\nnumbers\nmargins\ntell\ngo on\nundo\nquit\nwhere");
        for words in [
            "percent of the time, between",
            "hits yellow",
            "table lengths), ",
            "Pattern: ",
            "\nPoint: ",
            "Direction: up to",
            "white meets yellow.",
            "all balls lie still",
        ] {
            assert!(said.contains(words), "{words}: {said}");
        }
        assert!(!said.contains(['%', '\u{b0}']), "signs are words: {said}");
        let first = "White lies at 2.59 diamonds along and 2.00 up, -500 and 0 millimetres from the middle.";
        assert_eq!(said.matches(first).count(), 2, "at the start and after undo, but not after quit: {said}");
    }

    #[test]
    fn distances_and_speeds_are_told_in_the_unit_of_the_settings() {
        let table = Table::default();
        let layout = Layout::parse("-0.5,0 0,0 0.5,0.03", &table).unwrap();
        let units = Units { length: LengthUnit::Feet, ..Units::default() };
        let settings = Settings { think_ms: 1_000, units, ..Settings::default() };
        let (mut output, beginning) = (Vec::new(), Beginning { layout, own: None, seed: 1 });
        let lines = b"words\nshot\nnumbers\nmargins\ntell\n";
        converse(Coach::new(table), beginning, &settings, &lines[..], &mut output, "").unwrap();
        let said = String::from_utf8(output).unwrap();
        for words in
            ["-19.69 and 0.00 inches from the middle", "0.121 inches each", "feet a second, ", "feet a second softer"]
        {
            assert!(said.contains(words), "{words}: {said}");
        }
        assert!(!said.contains("m/s") && !said.contains("metres a second"), "{said}");
        assert!(!said.contains("millimetres"), "{said}");
    }

    #[test]
    fn the_system_of_a_shot_is_told_and_what_the_words_mean() {
        let said = talk("system\nwords\nrule three-cushion\nballs 2d,2.6d 2d,2d 6d,2d\nshot\nsystem");
        assert!(said.contains("There is no shot yet") && said.contains("3.1 millimetres each"), "{said}");
        let told = said.lines().last().unwrap();
        let is_told = told.contains("Aim through the diamond") || told.starts_with("Parallel shift");
        assert!(is_told || told == "No diamond system describes this shot.", "{said}");
    }

    /// Why a shot leads, and which system describes it, is worked out after the search: in less time than 2000 shots take on the
    /// same machine, half of a short search's.
    #[test]
    #[ignore = "compares times: cargo test --profile quick --lib the_reasons -- --ignored"]
    fn the_reasons_take_no_longer_than_a_short_search() {
        let table = Table::default();
        let layout = Layout::opening(&table);
        let coach = Coach::new(table.clone());
        let request = Request { simulations: 4000, budget: Duration::from_secs(60), ..Request::default() };
        let advice = coach.recommend(&layout, &request).unwrap();
        let timed = |work: &dyn Fn()| {
            let start = Instant::now();
            work();
            start.elapsed()
        };
        // The least of three: what else runs on the machine only adds to a time.
        let least = |work: &dyn Fn()| (0..3).map(|_| timed(work)).min().unwrap();
        let record = || Recording::new(&table, &layout, &advice.cue).unwrap();
        let shots = least(&|| (0..500).for_each(|_| drop(record())));
        let reasons = least(&|| {
            why(request.shooter(), request.rule, &table, &layout, &advice, 0).unwrap();
            guide(&table, &record()).inspect(|guide| assert!(!guide.to_string().is_empty()));
        });
        assert!(reasons < 4 * shots, "{reasons:?} for the reasons, {shots:?} for 500 shots");
    }

    #[test]
    fn a_filmed_shot_is_told_beside_its_simulation() {
        let said = talk("film\nfilm 90\nfilm 91\nwhere");
        for words in [
            "There are 91 filmed shots",
            "Shot 90 of the film: a point, ",
            "fitted on the first 2 seconds",
            "\n1 second: from the film",
            "5 seconds: from the film, in centimetres: white ",
            "all balls lie still: white ",
            "There is no filmed shot 91",
            "White lies at 2.59 diamonds along and 2.00 up, -500 and 0",
        ] {
            assert!(said.contains(words), "{words}: {said}");
        }
    }

    #[test]
    fn the_other_player_has_the_other_ball_and_every_colour_is_told_right() {
        let said = talk(
            "cue ball yellow\nfirst white\nwhere\nmove yellow up 10\nshot\nnumbers\ntell\nundo\nundo\nwhere\ncue ball white\n",
        );
        let told = "Yellow lies at 4.00 diamonds along and 2.03 up, 0 and 10 millimetres from the middle.";
        assert!(said.contains("The cue ball is yellow.") && said.contains(told), "{said}");
        assert!(said.contains("Met first: white.") && said.contains("hits white"), "{said}");
        assert!(said.contains("yellow meets") && !said.contains("white meets yellow"), "{said}");
        assert!(said.trim_end().ends_with("The cue ball is white already."), "{said}");
    }

    #[test]
    fn the_skill_that_is_kept_plays_and_where_none_is_that_is_said() {
        assert!(talk("skill own").contains("No skill of your own is kept yet"));
        let own = "a=0.7,b=0.7,theta=0.2,phi=0.2,V=0.1";
        let said = talk_of(own.parse().ok(), "skill own\nskill 0.6\nshot\nskill 7\n");
        for words in [
            &format!("The player is you: {own}."),
            "The player averages 0.6 points an inning at three-cushion.",
            "\nA player who averages 0.6 makes it ",
            "accepted are 0.1 to 2.5 points an inning at three-cushion, or world-class",
        ] {
            assert!(said.contains(words), "{words}: {said}");
        }
    }

    #[test]
    fn why_chances_and_plan_are_answered_in_sentences_without_the_course_again() {
        assert!(talk("why").contains("There is no shot yet") && talk("chances").contains("There is no shot yet"));
        let said = talk("skill club\nshot\nwhy\nchances\nplan\nplan off\nplan");
        for words in [
            "The first shot. It is made ",
            "Shot 1. A club player makes it ",
            "\nThe next point ",
            "Say plan on to change",
        ] {
            assert!(said.contains(words), "{words}: {said}");
        }
        let reasons = said.lines().find(|line| line.starts_with("It is made ")).unwrap();
        assert!(!reasons.contains(';') && !said.contains("cushions in all") && !said.contains(" and more."), "{said}");
    }

    #[test]
    fn what_cannot_be_done_is_said_and_the_conversation_goes_on() {
        let said = talk(
            "tell\nother\ngo on\nmove white left 0\nundo\nfly\nballs 0,0 0,0 1,0\nmove white right 9000\nmove red right 9000\nfirst white\nrule one-cushion\n",
        );
        for words in [
            "no shot yet",
            "no other shot",
            "nothing to take back",
            "fly",
            "0.0000 m apart",
            "It stops there, in contact with yellow.",
            "It stops there, at the rail.",
            "\"white\" cannot be met first; use any, yellow, red, cushion",
            "The rule is one-cushion",
        ] {
            assert!(said.contains(words), "{words}: {said}");
        }
    }
}
