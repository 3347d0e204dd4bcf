//! Commands of the plain mode, one per line.

use std::str::FromStr;

use glam::DVec2;

use crate::{
    coach::Skill,
    game::Rule,
    printing::parse_number,
    table::{BALL_NAMES, CueBall, Side},
};

/// A command.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// Describe the positions of the balls.
    Where,
    /// Place all three balls, as on the command line.
    Balls(String),
    /// Choose the cue ball.
    CueBall(CueBall),
    /// Move a ball, given by its index among white, yellow and red, by a displacement in metres to the right and up.
    Move(usize, DVec2),
    /// Put the balls on their spots, the cue ball on this side.
    Opening(Side),
    /// Random position.
    Random,
    /// Set the rule.
    Rule(Rule),
    /// Set the player's skill.
    Skill(Skill),
    /// Use the user's own skill.
    OwnSkill,
    /// Set whether the next point counts too.
    Plan(bool),
    /// Say whether the next point counts, and what the shot leaves.
    PlanNow,
    /// Set what the cue ball has to meet first, as a word.
    First(String),
    /// Ask the coach for a shot.
    Shot,
    /// Try a stroke of the player's own, described in words.
    Try(String),
    /// Describe the next of the other shots.
    Other,
    /// List the success rates of all shots.
    Chances,
    /// Explain why the first shot is best.
    Why,
    /// Describe how far off the shot may be.
    Margins,
    /// Describe the shot in numbers: tip contact, speed and direction.
    Numbers,
    /// Describe the diamond system for the shot.
    System,
    /// Explain the words used for shots.
    Words,
    /// Describe the shot's contacts (with `true`, all its events) and its outcome.
    Describe(bool),
    /// Continue with the balls as the shot leaves them.
    NextPosition,
    /// List the filmed shots.
    Films,
    /// Describe the filmed shot with this number and its simulation.
    Film(u32),
    /// Undo the last change of the balls.
    Undo,
    /// List the commands.
    Help,
    /// Quit.
    Quit,
}

/// The commands and what they do.
const HELP: &[(&str, &str)] = &[
    ("shot", "ask the coach for a shot; ask and an empty line do the same"),
    (
        "try red 1/2 right, 1.5 left, 2 up, 3 lengths",
        "a stroke of your own: the ball and how full, side, height and speed, or the line of the cue like to 3.2 bottom; what you leave out is taken from the present shot",
    ),
    ("other", "the next of the other shots; next does the same"),
    ("chances", "how often each shot is made"),
    ("why", "why the first shot is best"),
    ("numbers", "the shot in numbers: small distances, speed and degrees"),
    ("system", "the diamond system for the shot, and its numbers on this table"),
    ("words", "what the words for a shot mean: tips, o'clock, full, table lengths, diamonds"),
    ("tell", "what the balls meet in the shot, and its outcome; play does the same"),
    ("tell all", "the same, and when they begin to roll and stop"),
    ("margins", "how far off the shot may be, and where to aim"),
    ("go on", "take the balls as the shot leaves them"),
    ("where", "where the balls are; balls alone does the same"),
    ("move white left 20", "move a ball by a distance in millimetres: left, right, up or down"),
    ("balls -0.5,0 0,0 0.5,0.03", "place all three, in metres or in diamonds like 2d,2d 6d,2d 2d,2.5d"),
    (
        "opening",
        "put the balls on their spots; where the cue ball may stand on either side, opening right puts it there",
    ),
    ("cue ball yellow", "which ball is the cue ball: white or yellow"),
    ("random", "random position"),
    ("rule three-cushion", "what counts as a point: straight, one-cushion or three-cushion"),
    (
        "skill club",
        "who plays: perfect, expert, world-class, national, club, beginner, own (your own skill: from your notes if saved, otherwise the average in the settings), an average at three-cushion like 0.6, or errors like a=0.7,b=0.7,theta=0.2,phi=0.2,V=0.1",
    ),
    ("plan", "whether the coach plans for the next point, and how often that is made"),
    ("plan off", "the coach no longer plans for the next point; plan on: it does again"),
    ("first red", "what the cue ball must hit first from now on: a ball's colour, cushion or any"),
    ("film", "the list of filmed shots"),
    ("film 12", "that filmed shot, and how far the simulated balls are from the filmed ones"),
    ("undo", "undo the last change of the balls"),
    ("quit", "end the program; exit and the end of the input do the same"),
];

/// The list of commands, one per line.
pub fn help() -> String {
    HELP.iter().map(|(line, about)| format!("{line}: {about}.")).collect::<Vec<_>>().join("\n")
}

impl FromStr for Command {
    type Err = String;

    fn from_str(line: &str) -> Result<Self, String> {
        // Telephones, dictation and braille keyboards begin a line with a capital letter.
        let lower = line.to_ascii_lowercase();
        let words: Vec<&str> = lower.split_whitespace().collect();
        Ok(match words[..] {
            [] | ["shot" | "ask"] => Self::Shot,
            ["try", ..] => Self::Try(line.trim_start()["try".len()..].to_owned()),
            ["other" | "next"] => Self::Other,
            ["numbers"] => Self::Numbers,
            ["system"] => Self::System,
            ["words"] => Self::Words,
            ["tell" | "play"] => Self::Describe(false),
            ["tell", "all"] => Self::Describe(true),
            ["margins"] => Self::Margins,
            ["go", "on"] => Self::NextPosition,
            ["where" | "balls"] => Self::Where,
            ["opening"] => Self::Opening(Side::default()),
            ["opening", side] => Self::Opening(side.parse().map_err(|error| format!("{error}"))?),
            ["random"] => Self::Random,
            ["cue", "ball", name] => Self::CueBall(name.parse().map_err(|error| format!("{error}"))?),
            ["undo"] => Self::Undo,
            ["film"] => Self::Films,
            ["film", number] => Self::Film(
                number
                    .parse()
                    .map_err(|_| format!("\"{number}\" is not the number of a filmed shot; film lists them"))?,
            ),
            ["help" | "?"] => Self::Help,
            ["quit" | "exit"] => Self::Quit,
            ["chances"] => Self::Chances,
            ["why"] => Self::Why,
            ["plan"] => Self::PlanNow,
            ["plan", "on"] => Self::Plan(true),
            ["plan", "off"] => Self::Plan(false),
            ["first", word] => Self::First(word.to_owned()),
            ["rule", ref name @ ..] if !name.is_empty() => {
                Self::Rule(name.join("-").parse().map_err(|error| format!("{error}"))?)
            }
            ["skill", "own"] => Self::OwnSkill,
            ["skill", ref name @ ..] if !name.is_empty() => {
                let between = if line.contains('=') { " " } else { "-" };
                Self::Skill(name.join(between).parse().map_err(|error| format!("{error}"))?)
            }
            ["balls", ref places @ ..] => Self::Balls(places.join(" ")),
            ["move", ball, direction, distance] => Self::Move(ball_named(ball)?, step(direction, distance)?),
            _ => return Err(format!("\"{}\" is not a command; help lists the commands", line.trim())),
        })
    }
}

fn ball_named(name: &str) -> Result<usize, String> {
    BALL_NAMES
        .iter()
        .position(|ball| *ball == name)
        .ok_or_else(|| format!("there is no ball \"{name}\"; there are {}", BALL_NAMES.join(", ")))
}

/// Parses a displacement: a direction and a distance in millimetres; returns metres.
fn step(direction: &str, distance: &str) -> Result<DVec2, String> {
    let unit = match direction {
        "left" => DVec2::NEG_X,
        "right" => DVec2::X,
        "up" => DVec2::Y,
        "down" => DVec2::NEG_Y,
        _ => return Err(format!("\"{direction}\" is not a direction; use left, right, up or down")),
    };
    let millimetres = parse_number(distance).filter(|distance| (0.0..=10_000.0).contains(distance));
    let millimetres = millimetres.ok_or_else(|| format!("\"{distance}\" is not a distance; use 0 to 10000 mm"))?;
    Ok(unit * (1e-3 * millimetres))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_command_of_the_help_parses() {
        for (line, _) in HELP {
            assert!(line.parse::<Command>().is_ok(), "{line}");
        }
        assert_eq!(["", "ask"].map(str::parse), [Ok(Command::Shot), Ok(Command::Shot)]);
        assert_eq!(["other", "next"].map(str::parse), [Ok(Command::Other), Ok(Command::Other)]);
        assert_eq!("play".parse(), Ok(Command::Describe(false)));
        assert_eq!("balls".parse(), Ok(Command::Where));
        assert_eq!("?".parse(), Ok(Command::Help));
        assert_eq!("exit".parse(), Ok(Command::Quit));
        assert_eq!(["plan on", "plan off"].map(str::parse), [true, false].map(|plan| Ok(Command::Plan(plan))));
        for rule in ["rule one-cushion", "rule one cushion"] {
            assert_eq!(rule.parse(), Ok(Command::Rule(Rule::OneCushion)));
        }
        assert_eq!("skill world class".parse(), Ok(Command::Skill(Skill::WORLD_CLASS)));
        assert_eq!("Skill World Class".parse(), Ok(Command::Skill(Skill::WORLD_CLASS)));
        assert_eq!("Cue Ball Yellow".parse(), Ok(Command::CueBall(CueBall::Yellow)));
        assert!("Skill A=0.7,b=0.7,theta=0.2,phi=0.2,V=0.1".parse::<Command>().is_ok());
        for average in ["skill 0.6", "skill 0,6"] {
            assert_eq!(average.parse(), Ok(Command::Skill(Skill::of_average(0.6).unwrap())));
        }
        assert_eq!("move red left 2,5".parse(), Ok(Command::Move(2, DVec2::new(-0.0025, -0.0))));
        assert_eq!("rule 3".parse(), Ok(Command::Rule(Rule::ThreeCushion)));
    }

    #[test]
    fn unknown_commands_are_named() {
        for (line, named) in [
            ("dance", "dance"),
            ("move blue left 3", "blue"),
            ("move red along 3", "along"),
            ("move red left far", "far"),
            ("move red left -3", "-3"),
            ("rule snooker", "snooker"),
            ("skill god", "god"),
            ("film first", "first"),
            ("cue ball red", "red"),
            ("opening far", "far"),
        ] {
            let error = line.parse::<Command>().unwrap_err();
            assert!(error.contains(named), "{line}: {error}");
        }
    }
}
