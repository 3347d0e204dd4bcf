//! The result of a stroke in a player's words: the point, or what was missing.

use glam::DVec2;

use super::words::{LengthUnit, number_word};
use crate::{
    game::{Point, Rule, Tally},
    simulation::{CushionContacts, EventKind, OffTable, Recording},
    table::{BALLS, CueBall, Layout, Table},
};

/// Sampling interval for the distance between balls, s: a fast ball moves 2 cm in it.
const SAMPLING_INTERVAL: f64 = 0.005;

/// Largest number of intervals: a shot of more than 500 s is sampled at longer intervals.
const MAX_SAMPLES: f64 = 1e5;

/// A cue ball that comes to rest within this distance of its closest point to a ball stopped short of it, m: distances
/// are reported to a centimetre.
const MAX_STOP_DISTANCE: f64 = 0.02;

/// A gap below this is reported as "a hair", m: a smaller one would be rounded to zero.
const HAIR: f64 = 0.001;

/// Minimum speed of a moving ball, m/s.
const MIN_MOVING_SPEED: f64 = 0.05;

/// Cosine of the smallest angle between the relative motion and the line between two balls at which one passes the
/// other. The condition must hold [`PASSING_WINDOW`] s before and after the moment of closest approach.
const PASSING_COSINE: f64 = 0.5;
const PASSING_WINDOW: f64 = 0.002;

/// How the cue ball missed an object ball.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MissKind {
    /// On the ball's left, seen along the cue ball's path.
    Left,
    /// On the ball's right.
    Right,
    /// Above the ball, in the air.
    Over,
    /// Stopped before the ball.
    Short,
    /// Did not pass the ball: the cue ball hit something and turned away, or the ball moved off.
    Off,
}

/// The closest approach of the cue ball to the ball that it missed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Miss {
    /// The ball, 1 or 2.
    pub ball: usize,
    /// The gap between the two balls at that moment, m.
    pub gap: f64,
    /// How the ball was missed.
    pub kind: MissKind,
}

/// The result of a stroke.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Verdict {
    /// The conditions of the point.
    pub point: Point,
    /// The contacts of the cue ball.
    pub tally: Tally,
    /// How a ball was missed, if the cue ball came near it after enough cushions.
    pub miss: Option<Miss>,
    /// How balls left the table, which is a foul; `None` for balls that stayed on it.
    pub off: [Option<OffTable>; BALLS],
}

impl Verdict {
    /// Evaluates a recorded shot.
    pub fn of(rule: Rule, table: &Table, layout: &Layout, recording: &Recording) -> Self {
        let mut tally = Tally::from_stroke(table, layout, recording.impulse());
        recording.events().iter().for_each(|event| tally.count(event));
        let miss = match tally.hit {
            [true, true] => None,
            [true, false] => miss(table, recording, rule.cushions(), &[2]),
            [false, true] => miss(table, recording, rule.cushions(), &[1]),
            [false, false] => miss(table, recording, 0, &[1, 2]),
        };
        Self { point: Point::of(rule, table, layout), tally, miss, off: recording.left_table(table) }
    }

    /// Whether it made the point.
    pub fn is_made(&self) -> bool {
        self.point.is_made(&self.tally)
    }

    /// Describes the result for a player with `cue_ball`: "Point: red, three cushions, yellow", or what was missing.
    pub fn words(&self, cue_ball: CueBall, unit: LengthUnit) -> String {
        if let Some(foul) = self.foul(cue_ball) {
            return format!("Foul: {foul}");
        }
        match self.missing_words(cue_ball, unit) {
            Some(missing) => format!("No point: {missing}"),
            None => format!("Point: {}", self.path_words(cue_ball)),
        }
    }

    /// Returns the balls that left the table, and how.
    pub fn off_table(&self) -> impl Iterator<Item = (usize, OffTable)> {
        self.off.into_iter().enumerate().filter_map(|(ball, off)| Some((ball, off?)))
    }

    /// Describes the foul for a player with `cue_ball`: the touching ball that was pushed, or the balls that left the
    /// table, over which rail, and the spots on which they are placed. `None` if there was no foul.
    pub fn foul(&self, cue_ball: CueBall) -> Option<String> {
        let pushed = self.tally.pushed.map(|ball| {
            let name = cue_ball.names()[ball];
            format!("the stroke pushes {name}, which touches the cue ball")
        });
        let one = |(ball, off): (usize, OffTable)| {
            let (name, rail, spot) = (cue_ball.names()[ball], off.over.name(), spot_words(off.spot));
            format!("{name} left the table over the {rail} rail and goes to the {spot}")
        };
        let mut all: Vec<String> = pushed.into_iter().chain(self.off_table().map(one)).collect();
        if all.is_empty() && self.tally.left_table {
            all.push("a ball left the table".to_owned());
        }
        (!all.is_empty()).then(|| all.join("; "))
    }

    /// Lists the balls and cushions up to the second ball.
    fn path_words(&self, cue_ball: CueBall) -> String {
        let (first, second) = self.order();
        let Tally { cushions_before_first: before, cushions_before_second: all, .. } = self.tally;
        let cushions = |count: u32| (count > 0).then(|| cushion_words(count));
        let names = cue_ball.names();
        let parts = [
            cushions(before),
            Some(names[first].to_owned()),
            cushions(all.saturating_sub(before)),
            Some(names[second].to_owned()),
        ];
        parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
    }

    /// Returns the object balls in the order of contact.
    const fn order(&self) -> (usize, usize) {
        if self.tally.red_first { (2, 1) } else { (1, 2) }
    }

    /// Describes what is missing for a point; `None` if the stroke makes the point.
    fn missing_words(&self, cue_ball: CueBall, unit: LengthUnit) -> Option<String> {
        let (tally, names, wanted) = (&self.tally, cue_ball.names(), self.point.rule.cushions());
        let passed = |miss: Miss| {
            let ball = names[miss.ball];
            let gap = if miss.gap < HAIR { "a hair".to_owned() } else { unit.words(miss.gap) };
            match miss.kind {
                MissKind::Left => format!("passed {ball} by {gap} on the left"),
                MissKind::Right => format!("passed {ball} by {gap} on the right"),
                MissKind::Over => format!("flew over {ball}"),
                MissKind::Short => format!("stopped {gap} short of {ball}"),
                MissKind::Off => format!("came within {gap} of {ball}"),
            }
        };
        let (first, second) = self.order();
        Some(match (tally.has_hit_any(), tally.has_hit_both()) {
            (false, _) => match self.miss {
                Some(miss) => format!("no ball was hit, {}", passed(miss)),
                None => "no ball was hit".to_owned(),
            },
            (true, false) => self.miss.map_or_else(|| self.second_missed(names), passed),
            _ if tally.cushions_before_second < wanted => {
                let made = cushion_words(tally.cushions_before_second);
                format!("{made} before {}, {} needed", names[second], number_word(wanted))
            }
            _ if !self.is_made() => format!("{} was hit first, a game opens with {}", names[first], names[second]),
            _ => return None,
        })
    }

    /// Names the ball that was not hit, and any lack of cushions.
    fn second_missed(&self, names: [&str; BALLS]) -> String {
        let (tally, wanted) = (&self.tally, self.point.rule.cushions());
        let [met, missed] = if tally.hit[0] { [1, 2] } else { [2, 1] }.map(|ball| names[ball]);
        let said = format!("{met} was hit, {missed} was not");
        if tally.cushions < wanted {
            format!("{said}; {}, {} needed", cushion_words(tally.cushions), number_word(wanted))
        } else {
            said
        }
    }
}

/// Names one of the three spots on the table's long axis: red's opening spot, the near one, or the middle one.
fn spot_words(spot: DVec2) -> &'static str {
    match spot.x {
        x if x > 0.0 => "far spot",
        x if x < 0.0 => "near spot",
        _ => "middle spot",
    }
}

/// Returns the number of cushions in words.
fn cushion_words(count: u32) -> String {
    let unit = if count == 1 { "cushion" } else { "cushions" };
    format!("{} {unit}", number_word(count))
}

/// Finds the closest approach of the cue ball to one of these balls after its first `cushions` cushions and its first hit, if there is one.
/// `None` if it only moves away from that ball, which then was not missed.
fn miss(table: &Table, recording: &Recording, cushions: u32, balls: &[usize]) -> Option<Miss> {
    let mut contacts = CushionContacts::default();
    let rails = recording.events().iter().filter(|event| contacts.follow(0, event).is_some());
    let start = match cushions.checked_sub(1) {
        None => 0.0,
        Some(before) => rails.map(|event| event.time).nth(before as usize)?,
    };
    let mut hits = recording.events().iter().filter(|event| matches!(event.kind, EventKind::BallBall(0, _)));
    let start = hits.next().map_or(start, |first| start.max(first.time));
    let all = balls.iter().filter_map(|ball| Some((*ball, nearest(table, recording, start, *ball)?)));
    let (ball, (time, gap)) = all.min_by(|(_, (_, one)), (_, (_, other))| one.total_cmp(other))?;
    (time - start >= SAMPLING_INTERVAL).then(|| Miss {
        ball,
        gap: gap.max(0.0),
        kind: miss_kind(table, recording, ball, time),
    })
}

/// Finds the moment from `start` on, s, at which the cue ball is nearest to `ball`, and the gap between them at that
/// moment, m.
fn nearest(table: &Table, recording: &Recording, start: f64, ball: usize) -> Option<(f64, f64)> {
    let gap = |time: f64| {
        let places = recording.positions(time);
        let higher = recording.height(0, time) - recording.height(ball, time);
        places[0].distance(places[ball]).hypot(higher) - 2.0 * table.radius
    };
    let interval = SAMPLING_INTERVAL.max((recording.duration() - start) / MAX_SAMPLES);
    let samples = ((recording.duration() - start) / interval).ceil() as usize;
    let times = (0..=samples).map(|sample| (start + interval * sample as f64).min(recording.duration()));
    let (_, near) = times.map(|time| (gap(time), time)).min_by(|one, other| one.0.total_cmp(&other.0))?;
    // Between two samples the gap has a single minimum.
    let (mut from, mut to) = ((near - interval).max(start), (near + interval).min(recording.duration()));
    for _ in 0..30 {
        let third = (to - from) / 3.0;
        if gap(from + third) < gap(to - third) { to -= third } else { from += third }
    }
    let time = 0.5 * (from + to);
    Some((time, gap(time)))
}

/// Determines how the cue ball missed the ball that it is nearest to at `time`, s.
fn miss_kind(table: &Table, recording: &Recording, ball: usize, time: f64) -> MissKind {
    let [cue_ball, other] = [0, ball].map(|ball| recording.state(ball, time));
    let towards: DVec2 = other.position - cue_ball.position;
    let rest = recording.state(0, recording.duration()).position;
    // If a collision deflects one of the two at that moment, it is the closest approach, but they do not pass each other.
    let goes_past = [time - PASSING_WINDOW, time + PASSING_WINDOW].into_iter().all(|time| {
        let [cue_ball, other] = [0, ball].map(|ball| recording.state(ball, time.clamp(0.0, recording.duration())));
        let (towards, motion) = (other.position - cue_ball.position, cue_ball.velocity - other.velocity);
        cue_ball.velocity.length() > MIN_MOVING_SPEED
            && motion.dot(towards).abs() < PASSING_COSINE * motion.length() * towards.length()
    });
    match cue_ball.velocity.perp_dot(towards) {
        _ if towards.length() < 2.0 * table.radius => MissKind::Over,
        _ if cue_ball.position.distance(rest) < MAX_STOP_DISTANCE && other.velocity.length() < MIN_MOVING_SPEED => {
            MissKind::Short
        }
        _ if !goes_past => MissKind::Off,
        side if side > 0.0 => MissKind::Right,
        _ => MissKind::Left,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::CueInputs;

    fn told(point: Point, tally: Tally, cue_ball: CueBall) -> String {
        Verdict { point, tally, miss: None, off: [None; BALLS] }.words(cue_ball, LengthUnit::Metres)
    }

    #[test]
    fn point_lists_balls_and_cushions_in_order() {
        let tally = |before, all| Tally {
            hit: [true; 2],
            red_first: true,
            cushions: all,
            cushions_before_first: before,
            cushions_before_second: all,
            ..Tally::default()
        };
        let three = Point::from(Rule::ThreeCushion);
        assert_eq!(told(three, tally(0, 3), CueBall::White), "Point: red, three cushions, yellow");
        assert_eq!(told(three, tally(1, 5), CueBall::Yellow), "Point: one cushion, red, four cushions, white");
        assert_eq!(told(Rule::StraightRail.into(), tally(0, 0), CueBall::White), "Point: red, yellow");
    }

    #[test]
    fn miss_describes_what_was_missing() {
        let said = |hit, cushions_before_second, rule: Rule| {
            let tally = Tally { hit, cushions: 2, cushions_before_second, ..Tally::default() };
            told(rule.into(), tally, CueBall::White)
        };
        assert_eq!(said([false, false], 0, Rule::StraightRail), "No point: no ball was hit");
        assert_eq!(said([false, true], 0, Rule::OneCushion), "No point: red was hit, yellow was not");
        let few = said([true, false], 0, Rule::ThreeCushion);
        assert_eq!(few, "No point: yellow was hit, red was not; two cushions, three needed");
        let short = said([true, true], 2, Rule::ThreeCushion);
        assert_eq!(short, "No point: two cushions before red, three needed");
        let opening = Point { rule: Rule::ThreeCushion, red_first: true };
        let off_red = Tally { hit: [true; 2], red_first: true, cushions_before_second: 3, ..Tally::default() };
        assert_eq!(told(opening, off_red, CueBall::White), "Point: red, three cushions, yellow");
        let wrong = told(opening, Tally { red_first: false, ..off_red }, CueBall::White);
        assert_eq!(wrong, "No point: yellow was hit first, a game opens with red");
        let one = Tally { hit: [true, false], ..Tally::default() };
        assert_eq!(told(Rule::StraightRail.into(), one, CueBall::Yellow), "No point: white was hit, red was not");
    }

    fn verdict(layout: &str, cue: &str, rule: Rule) -> Verdict {
        let table = Table::default();
        let layout = Layout::parse(layout, &table).unwrap();
        let recording = Recording::new(&table, &layout, &CueInputs::parse(cue).unwrap()).unwrap();
        Verdict::of(rule, &table, &layout, &recording)
    }

    /// Earlier the words described yellow next to the cue ball before the stroke.
    #[test]
    fn only_what_follows_the_first_hit_counts_as_a_miss() {
        let Verdict { miss, tally, .. } = verdict("-1,0 -0.95,0.12 0,0", "0,0,0,0,0.6", Rule::StraightRail);
        assert_eq!(tally.hit, [false, true]);
        assert!(miss.is_none_or(|miss| miss.gap > 0.5), "{miss:?}");
    }

    #[test]
    fn miss_side_and_gap_are_seen_along_the_path() {
        // Straight along the middle to the right: yellow 10 cm to the left of the path, red far behind.
        let Verdict { miss, .. } = verdict("-1,0 0,0.1 -1.3,-0.6", "0,0,0,0,2", Rule::StraightRail);
        let Miss { ball, gap, kind } = miss.unwrap();
        assert_eq!((ball, kind), (1, MissKind::Right), "the cue ball goes by on the right of yellow");
        assert!((gap - (0.1 - 2.0 * Table::default().radius)).abs() < 1e-4, "{gap}");
        let mirrored = verdict("-1,0 0,-0.1 -1.3,0.6", "0,0,0,0,2", Rule::StraightRail);
        let said = mirrored.words(CueBall::White, LengthUnit::Metres);
        assert_eq!(said, "No point: no ball was hit, passed yellow by 3.9 cm on the left");
    }

    fn flown(layout: &str, cue: &str, cue_ball: CueBall) -> String {
        verdict(layout, cue, Rule::StraightRail).words(cue_ball, LengthUnit::Metres)
    }

    #[test]
    fn off_table_foul_names_the_rail_and_the_spot() {
        let said = |cue_ball| flown("0.9,0 0.1,0.3 0.1,-0.3", "0,0,30,0,9", cue_ball);
        assert_eq!(said(CueBall::White), "Foul: white left the table over the right rail and goes to the middle spot");
        assert!(said(CueBall::Yellow).starts_with("Foul: yellow left the table over the right rail"));
        // The middle spot is occupied: the ball is placed on the spot of the ball that is in the way.
        let taken = flown("0.9,0 0,0 0.1,-0.3", "0,0,30,0,9", CueBall::White);
        assert_eq!(taken, "Foul: white left the table over the right rail and goes to the near spot");
    }

    #[test]
    fn pushing_a_touching_ball_is_always_a_foul() {
        // Yellow touches the cue ball on one side; red lies on the other, where draw takes the cue ball.
        let touching = format!("0,0 {},0 -0.3,0.02", 2.0 * Table::default().radius);
        let said = |cue: &str, cue_ball| {
            let verdict = verdict(&touching, cue, Rule::StraightRail);
            (verdict.is_made(), verdict.words(cue_ball, LengthUnit::Metres))
        };
        let foul = |ball| format!("Foul: the stroke pushes {ball}, which touches the cue ball");
        assert_eq!(said("0,-0.4,5,0,3", CueBall::White), (false, foul("yellow")));
        assert_eq!(said("0,0,5,60,3", CueBall::Yellow), (false, foul("white")));
        // Away from yellow, and back to it.
        let (is_made, away) = said("0,0,5,180,3", CueBall::White);
        assert!(is_made && away.starts_with("Point: "), "{away}");
    }

    #[test]
    fn ball_flown_over_has_miss_kind_over() {
        let said = flown("-0.5,0 -0.2,0 -1.2,-0.5", "0,0,45,0,5", CueBall::White);
        assert_eq!(said, "No point: no ball was hit, flew over yellow");
    }

    #[test]
    fn cue_ball_at_rest_before_the_ball_stopped_short() {
        let Verdict { miss, .. } = verdict("-1,0 1.2,0 1.2,0.5", "0,0,0,0,0.4", Rule::StraightRail);
        assert_eq!(miss.map(|miss| miss.kind), Some(MissKind::Short));
    }

    #[test]
    fn near_miss_without_passing_is_not_a_pass() {
        let said = |layout: &str, cue: &str| {
            verdict(layout, cue, Rule::StraightRail).words(CueBall::White, LengthUnit::Metres)
        };
        // Yellow is hit full and takes all the speed; red lies behind it.
        let full = said("-0.1,0 0,0 0.2,0.12", "0,-0.1,0,0,0.3");
        assert_eq!(full, "No point: stopped 17 cm short of red");
        // Draw pulls the cue ball back from yellow, where it is closest to red.
        let drawn = said("-0.15,0 0,0.02 0.2,0.12", "0,-0.4,0,0,1");
        assert_eq!(drawn, "No point: yellow was hit, red was not");
        // The cue ball stops level with yellow, or beyond it.
        let short = |place: &str| said(&format!("-1,0 {place},0.15 -1.3,-0.6"), "0,0,0,0,0.17");
        assert_eq!(short("-0.595"), "No point: no ball was hit, stopped 8.8 cm short of yellow");
        assert_eq!(short("-0.8"), "No point: no ball was hit, passed yellow by 8.9 cm on the right");
        // A ball that is left behind was not missed, even if the other one is farther away.
        assert_eq!(said("-1,0 -1.1,0 1.3,0.6", "0,0,0,0,0.15"), "No point: no ball was hit");
        assert_eq!(said("-1,0 -1.1,0 -1.1,0.1", "0,0,0,0,0.15"), "No point: no ball was hit");
    }

    #[test]
    fn ball_behind_after_last_cushion_is_not_passed() {
        // Thin off red to the right cushion; yellow lies next to the cushion, farther up.
        let Verdict { miss, .. } = verdict("0.6,0 1.389,0.15 0.9,0.052", "0,0,0,0,0.5", Rule::OneCushion);
        assert_eq!(miss, None);
    }

    #[test]
    fn passing_before_required_cushions_is_not_a_near_miss() {
        // Yellow is hit full, and red lies 10 cm beside the path.
        let shot = |rule| verdict("-1,0 0,0 0.4,0.1", "0,0.3,0,0,1", rule);
        assert!(shot(Rule::StraightRail).miss.is_some_and(|miss| miss.ball == 2));
        assert_eq!(shot(Rule::ThreeCushion).miss, None);
    }
}
