//! `carom simulate`: plays one shot as a list of events, or a file of shots.

use std::io::{self, Write};

use clap::builder::NonEmptyStringValueParser;
use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

use super::{
    Failure, bounded,
    input::{PositionArgs, TableCache, answer_lines},
    lookup::skill_by_name,
    output::{chance_words, impulse_words, print_note, shot_text, units},
    request::{Key, Keys, RuleName},
    typed_stroke::TypedStroke,
};
use crate::{
    coach::{Doubt, Shooter, Skill, Verdict, jump_words, make_probability, words::LengthUnit},
    game::Rule,
    physics::{CueInputs, Impulse, LeastElevation, NoRoom, SpatialState, has_room, least_elevation},
    printing::{self, fixed, number},
    simulation::{Event, Rail, Recording, Start},
    study::{SteppedShot, Steps},
    table::{BALL_NAMES, BALLS, CueBall, Layout, Table},
};

/// Number of attempts that are simulated to estimate how often a player makes the shot.
const ATTEMPTS: usize = 4000;

/// Default time step, s: about a hundred frames per second.
const DEFAULT_STEP: f64 = 0.01;

/// Simulate one shot or a file of shots.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    position: PositionArgs,
    /// What counts as a point: straight, one-cushion or three-cushion. In a batch, for lines without `rule`.
    #[arg(long, default_value_t = Rule::StraightRail)]
    rule: Rule,
    /// The shot: "a,b,theta,phi,V" in ball radii, degrees and m/s, or words like "red 1/2 right, 1.5 left, 3 lengths".
    #[arg(long, allow_hyphen_values = true, required_unless_present = "batch")]
    shot: Option<String>,
    /// Report how often this player makes the shot: perfect, expert, world-class, national, club, beginner, own, an average at
    /// three-cushion like 0.6, or standard errors.
    #[arg(long, conflicts_with = "batch", value_parser = skill_by_name)]
    skill: Option<Skill>,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
    /// Also list when balls begin to roll, stop, or rest against something, and hops and bounces too small to see; --json always does.
    #[arg(long)]
    rolls: bool,
    /// Report the positions and motions of the balls at these times after the stroke, s: "0.5,1,2".
    #[arg(long, value_name = "SECONDS", value_delimiter = ',', value_parser = moment)]
    at: Vec<f64>,
    /// JSON Lines of shots with `preset`, `layout` and `cue`, or instead of `cue` an `impulse` (velocity and spin of the cue ball); "-"
    /// reads the standard input.
    #[arg(long, value_name = "FILE", conflicts_with = "shot", value_parser = NonEmptyStringValueParser::new())]
    batch: Option<String>,
    /// How time advances: from event to event, or in the fixed steps of thesis 3.1, to see what they miss.
    #[arg(long, value_enum, default_value_t = Method::Events)]
    method: Method,
    /// With --method steps: the time step, s. Default: 0.01
    #[arg(long, value_name = "SECONDS")]
    dt: Option<f64>,
    /// With --method steps: locate events within the step at whose end they are detected.
    #[arg(long)]
    locate: bool,
}

/// Parses one of the times of `--at`, s.
fn moment(text: &str) -> Result<f64, String> {
    let seconds = text.trim().parse().ok().filter(|seconds: &f64| seconds.is_finite() && *seconds >= 0.0);
    seconds.ok_or_else(|| "accepted are seconds after the stroke, 0 or more, like \"0.5,1,2\"".to_owned())
}

/// How time advances.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Method {
    /// From one event to the next.
    Events,
    /// In fixed time steps.
    Steps,
}

/// One line of a batch.
#[derive(Deserialize)]
struct BatchLine {
    preset: String,
    layout: Layout,
    cue: Option<CueInputs>,
    impulse: Option<GivenImpulse>,
    rule: Option<RuleName>,
}

impl Keys for BatchLine {
    const KEYS: &'static [Key] = &[
        Key::PRESET,
        Key::LAYOUT,
        Key::of::<Option<CueInputs>>(
            "cue",
            r#"an object with the numbers "a", "b", "theta_deg", "phi_deg" and "speed""#,
        ),
        Key::of::<Option<GivenImpulse>>(
            "impulse",
            r#"an object with "velocity" [x, y] or [x, y, z] and "spin" [x, y, z], all numbers"#,
        ),
        Key::RULE,
    ];
    const FORM: &'static str = "preset (the table, like \"match\"), layout (like [[-0.71, 0.18], [-0.71, 0], [0.71, 0]]), and cue or \
                                impulse; rule may be left out";
}

/// An initial motion of the cue ball, in place of a stroke; for filmed shots.
#[derive(Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
struct GivenImpulse {
    /// Velocity along x, y and, if there is a third number, upwards, m/s.
    velocity: Vec<f64>,
    /// Spin about x, y and the vertical, rad/s.
    spin: [f64; 3],
}

impl GivenImpulse {
    fn of(Impulse { velocity, spin, lift }: &Impulse) -> Self {
        let mut along = velocity.to_array().to_vec();
        along.extend((*lift > 0.0).then_some(*lift));
        Self { velocity: along, spin: spin.to_array() }
    }

    fn impulse(&self, table: &Table) -> Result<Impulse, Failure> {
        let spin = DVec3::from_array(self.spin);
        match self.velocity[..] {
            [x, y] | [x, y, 0.0] => Ok(Impulse::on_cloth(DVec2::new(x, y), spin)),
            [x, y, lift] if table.flight.is_some() => Ok(Impulse { velocity: DVec2::new(x, y), spin, lift }),
            [_, _, up] => Err(Failure::wrong_input(format_args!(
                "impulse.velocity has {} m/s upwards; accepted is 0, because balls stay on the cloth of \"{}\": a section \
                 [flight] in a table's file lets them leave it",
                number(up),
                table.name
            ))),
            _ => Err(Failure::wrong_input(format_args!(
                "impulse.velocity has {} numbers; accepted are [x, y] and [x, y, z]",
                self.velocity.len()
            ))),
        }
    }
}

impl BatchLine {
    fn answer(&self, table: &Table, args: &Args, steps: Option<Steps>) -> Result<SimulateAnswer, Failure> {
        let rule = self.rule.map_or(args.rule, |RuleName(rule)| rule);
        let outcome = |(recording, _): &Played| Verdict::of(rule, table, &self.layout, recording);
        match (&self.cue, &self.impulse) {
            (Some(cue), None) => {
                let played = play(table, &self.layout, cue, steps)?;
                let cue_room = CueRoom::of(table, &self.layout, cue);
                Ok(SimulateAnswer::of(&played, &outcome(&played), cue.is_miscue(table), cue_room, &args.at))
            }
            (None, Some(_)) if steps.is_some() => {
                Err(Failure::wrong_input("--method steps needs a cue, not an impulse"))
            }
            (None, Some(given)) => {
                let played = (bounded::play(table, &self.layout, Start::Motion(&given.impulse(table)?))?, None);
                Ok(SimulateAnswer::of(&played, &outcome(&played), false, None, &args.at))
            }
            (Some(_), Some(_)) => Err(Failure::wrong_input("a line has cue and impulse; accepted is one of them")),
            (None, None) => Err(Failure::wrong_input("a line has neither cue nor impulse; it needs one of them")),
        }
    }
}

/// An event with positions that the event itself does not contain: of a ball at a cushion, and heights.
#[derive(Serialize)]
struct PlacedEvent {
    #[serde(flatten)]
    event: Event,
    #[serde(skip_serializing_if = "Option::is_none")]
    at: Option<DVec2>,
    /// Heights of the event's balls over the cloth, in their order, m; absent if all of them are on it.
    #[serde(skip_serializing_if = "Option::is_none")]
    z: Option<Vec<f64>>,
    /// Greatest height of a jump, m, and the distance to its first landing.
    #[serde(skip_serializing_if = "Option::is_none")]
    height: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    distance: Option<f64>,
}

impl PlacedEvent {
    fn of(recording: &Recording, event: Event) -> Self {
        let (first, second) = event.kind.balls();
        let heights: Vec<f64> =
            std::iter::once(first).chain(second).map(|ball| recording.height(ball, event.time)).collect();
        let jump = recording.jump_started_by(&event);
        Self {
            event,
            at: event.kind.rail().map(|_| recording.state(first, event.time).position),
            z: heights.iter().any(|&height| height > 0.0).then_some(heights),
            height: jump.map(|jump| jump.height),
            distance: jump.map(|jump| jump.distance),
        }
    }
}

/// The state of the balls at a requested time, as numbers or as text.
#[derive(Serialize)]
struct Moment {
    t: f64,
    balls: [SpatialState; BALLS],
}

impl Moment {
    fn of(recording: &Recording, t: f64) -> Self {
        Self { t, balls: std::array::from_fn(|ball| recording.spatial_state(ball, t)) }
    }

    fn describe(&self, out: &mut impl Write, unit: LengthUnit) -> io::Result<()> {
        let (in_a_metre, per_second) = unit.speed();
        writeln!(out, "after {} s:", number(self.t))?;
        for (name, SpatialState { position, velocity, spin }) in BALL_NAMES.iter().zip(&self.balls) {
            let words = |vector: DVec3| format!("({})", vector.to_array().map(|part| fixed(part, 6)).join(", "));
            let [place, speed, turn] = [*position, in_a_metre * *velocity, *spin].map(words);
            writeln!(out, "  {name} at {place} m, velocity {speed} {per_second}, spin {turn} rad/s")?;
        }
        Ok(())
    }
}

/// A ball that left the table.
#[derive(Serialize)]
struct OffTableBall {
    ball: &'static str,
    rail: Rail,
}

/// The answer in JSON.
#[derive(Serialize)]
struct SimulateAnswer {
    rule: Rule,
    /// Whether the shot makes the point.
    point: bool,
    /// The same in words, with what was missing.
    verdict: String,
    /// Description of the foul, if there was one.
    #[serde(skip_serializing_if = "Option::is_none")]
    foul: Option<String>,
    /// Number of cushion contacts of the cue ball before the second object ball; absent if it does not meet both balls.
    #[serde(skip_serializing_if = "Option::is_none")]
    cushions_before_second: Option<u32>,
    /// The inputs of a stroke that was given in words.
    #[serde(skip_serializing_if = "Option::is_none")]
    cue: Option<CueInputs>,
    /// How often the player of `--skill` makes the shot, with the 95 % interval.
    #[serde(skip_serializing_if = "Option::is_none")]
    make_probability: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    make_interval: Option<[f64; 2]>,
    /// The impulse that the stroke gave the cue ball.
    impulse: GivenImpulse,
    events: Vec<PlacedEvent>,
    /// The balls at the requested times.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    moments: Vec<Moment>,
    #[serde(rename = "final")]
    end: Layout,
    /// Balls that left the table; in `final` they are on their spots.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    off_table: Vec<OffTableBall>,
    duration: f64,
    /// Whether a real tip would slip off; the stroke is simulated nevertheless.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    miscue: bool,
    /// Present if the table defines how much room the cue needs.
    #[serde(skip_serializing_if = "Option::is_none")]
    cue_room: Option<CueRoom>,
    #[serde(flatten)]
    steps: Option<SteppedShot>,
}

/// The lowest possible elevation of the cue.
#[derive(Debug, Serialize)]
struct CueRoom {
    /// Whether the cue has room at the elevation of the stroke.
    has_room: bool,
    /// Least possible elevation, degrees; null if no elevation is possible.
    least_theta_deg: Option<f64>,
    /// The obstacle that the cue passes over, or that is in the way.
    over: Option<String>,
}

impl CueRoom {
    fn of(table: &Table, layout: &Layout, cue: &CueInputs) -> Option<Self> {
        table.room?;
        let (least, over) = match least_elevation(table, layout, cue) {
            Ok(LeastElevation { theta, over }) => (Some(theta), over),
            Err(NoRoom { obstacle }) => (None, Some(obstacle)),
        };
        Some(Self {
            has_room: has_room(table, layout, cue),
            least_theta_deg: least.map(f64::to_degrees),
            over: over.map(|obstacle| obstacle.to_string()),
        })
    }

    /// Returns a warning about an obstacle; `None` if the cue has room.
    fn note(&self) -> Option<String> {
        let over = self.over.as_deref().filter(|_| !self.has_room)?;
        Some(match self.least_theta_deg {
            Some(least) => format!("the cue cannot be held so low: below {least:.2} degrees {over} is in the way"),
            None => format!("the cue has no room at any elevation: {over} is in the way"),
        })
    }
}

impl SimulateAnswer {
    fn of(
        (recording, stepped): &Played,
        verdict: &Verdict,
        miscue: bool,
        cue_room: Option<CueRoom>,
        moments: &[f64],
    ) -> Self {
        Self {
            rule: verdict.point.rule,
            point: verdict.is_made(),
            verdict: verdict.words(CueBall::White, LengthUnit::default()),
            foul: verdict.foul(CueBall::White),
            cushions_before_second: verdict.tally.has_hit_both().then_some(verdict.tally.cushions_before_second),
            cue: None,
            make_probability: None,
            make_interval: None,
            miscue,
            cue_room,
            impulse: GivenImpulse::of(recording.impulse()),
            moments: moments.iter().map(|&t| Moment::of(recording, t)).collect(),
            events: recording.events().iter().map(|&event| PlacedEvent::of(recording, event)).collect(),
            end: recording.final_layout(),
            off_table: verdict
                .off_table()
                .map(|(ball, off)| OffTableBall { ball: BALL_NAMES[ball], rail: off.over })
                .collect(),
            duration: recording.duration(),
            steps: *stepped,
        }
    }
}

/// A simulated shot, with step statistics if it was played in time steps.
type Played = (Recording, Option<SteppedShot>);

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let steps = steps_of(args)?;
    if let Some(file) = &args.batch {
        let mut tables = TableCache::new(Ok);
        return answer_lines(file, |line: BatchLine| {
            let table = tables.get(&line.preset)?;
            line.answer(table, args, steps)
        });
    }
    let (table, layout) = args.position.read()?;
    // clap requires a shot if there is no batch.
    let typed = TypedStroke::parse(args.shot.as_deref().unwrap_or_default())?;
    let cue = typed.resolve(&table, &layout, CueBall::White)?;
    if matches!(typed, TypedStroke::Words(_)) {
        print_note(format_args!("note: the shot is \"{}\"", shot_text(&cue)));
    }
    let played = play(&table, &layout, &cue, steps)?;
    let miscue = cue.is_miscue(&table);
    if miscue {
        print_note(format_args!(
            "note: a real tip would slip off (miscue): a² + b² is {:.3}; the limit on \"{}\" is {}",
            cue.tip_offset_squared(),
            table.name,
            number(table.miscue_limit)
        ));
    }
    let cue_room = CueRoom::of(&table, &layout, &cue);
    if let Some(note) = cue_room.as_ref().and_then(CueRoom::note) {
        print_note(format_args!("note: {note}"));
    }
    let verdict = Verdict::of(args.rule, &table, &layout, &played.0);
    let chance = args.skill.map(|skill| {
        let shooter = Shooter { skill, doubt: Doubt::FULL };
        let rate = make_probability(shooter, args.rule, &table, &layout, &cue, ATTEMPTS, 0);
        (skill, rate.rate, [rate.low, rate.high])
    });
    let mut out = printing::stdout().exact(args.json);
    if args.json {
        printing::json_line(
            &mut out,
            &SimulateAnswer {
                cue: matches!(typed, TypedStroke::Words(_)).then_some(cue),
                make_probability: chance.map(|(_, rate, _)| rate),
                make_interval: chance.map(|(.., interval)| interval),
                ..SimulateAnswer::of(&played, &verdict, miscue, cue_room, &args.at)
            },
        )?;
        return Ok(());
    }
    describe(&mut out, args, &played, &verdict)?;
    if let Some((skill, rate, interval)) = chance {
        writeln!(out, "{}", chance_words(skill, rate, interval))?;
    }
    Ok(())
}

/// Returns the time steps that were requested, if any.
fn steps_of(args: &Args) -> Result<Option<Steps>, Failure> {
    match args.method {
        Method::Steps => {
            Steps::new(args.dt.unwrap_or(DEFAULT_STEP), args.locate).map(Some).map_err(Failure::wrong_input)
        }
        Method::Events if args.locate || args.dt.is_some() => {
            Err(Failure::wrong_input("--dt and --locate need --method steps; --method events has no steps"))
        }
        Method::Events => Ok(None),
    }
}

fn play(table: &Table, layout: &Layout, cue: &CueInputs, steps: Option<Steps>) -> Result<Played, Failure> {
    match steps {
        None => Ok((bounded::play(table, layout, Start::Stroke(cue))?, None)),
        Some(steps) => {
            let (recording, stepped) = bounded::play_in_steps(table, layout, cue, steps)?;
            Ok((recording, Some(stepped)))
        }
    }
}

/// Describes the shot as text.
fn describe(out: &mut impl Write, args: &Args, (recording, stepped): &Played, verdict: &Verdict) -> io::Result<()> {
    let length = units().length;
    let (in_a_metre, per_second) = length.speed();
    writeln!(out, "{}", impulse_words(recording.impulse(), length))?;
    writeln!(out, "{:>12}  {:<18}  {:<13}  {:<6}  white, the cue ball", "t, s", "event", "balls", "rail")?;
    for event in recording.listed_events(args.rolls) {
        let (first, second) = event.kind.balls();
        let first = BALL_NAMES[first];
        let balls = second.map_or_else(|| first.to_owned(), |second| format!("{first} {}", BALL_NAMES[second]));
        let rail = event.kind.rail().map_or("", Rail::name);
        let cue_ball = recording.state(0, event.time);
        write!(
            out,
            "{:>12.9}  {:<18}  {balls:<13}  {rail:<6}  ({:.4}, {:.4}) m at {:.3} {per_second}",
            event.time,
            event.kind.name(),
            cue_ball.position.x,
            cue_ball.position.y,
            in_a_metre * cue_ball.velocity.length(),
        )?;
        match recording.jump_started_by(event) {
            Some(jump) => writeln!(out, ", {}", jump_words(&jump, length))?,
            None => writeln!(out)?,
        }
    }
    if stepped.is_some_and(|stepped| !stepped.at_rest) {
        writeln!(out, "stopped while balls still jitter, the last event after {:.6} s:", recording.duration())?;
    } else {
        writeln!(out, "all still after {:.6} s:", recording.duration())?;
    }
    for (ball, position) in BALL_NAMES.iter().zip(recording.final_layout().balls) {
        writeln!(out, "  {ball} at ({:.6}, {:.6}) m", position.x, position.y)?;
    }
    for &t in &args.at {
        Moment::of(recording, t).describe(out, length)?;
    }
    if let Some(SteppedShot { steps, deepest_overlap, .. }) = stepped {
        writeln!(out, "{steps} steps, the deepest overlap {:.4} mm", 1e3 * deepest_overlap)?;
    }
    let said = verdict.words(CueBall::White, length);
    writeln!(out, "{said} ({})", verdict.point.rule)
}
