//! Margins of error of a stroke: the nearest miss on either side of each input, and maps of the outcome over two inputs.

use serde::Serialize;

use super::{
    Doubt, Input,
    candidates::playable,
    draws::{ErrorSize, QuasiRandomDraws, World, Worlds},
    words::LengthUnit,
};
use crate::{
    game::{Point, Referee, Rule, Tally, Touching},
    physics::{CueInputs, has_room, strike},
    platform::{self, parallel},
    player::re_aimed,
    simulation::{AllSavings, watch_with},
    table::{Layout, Table},
};

/// How far one input may be off if the others are exact.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Margin {
    /// The input.
    pub input: Input,
    /// Its unit.
    pub unit: &'static str,
    /// How much less it may be, in that unit. `None` if no miss was found within 15 mm, 15° of elevation, 5° of
    /// direction or 3 m/s, or before the input reaches its own limit.
    pub less: Option<f64>,
    /// How much more it may be.
    pub more: Option<f64>,
}

impl Input {
    /// Returns the conversion to the unit in which this input is displayed if distances are in `unit`: the factor from
    /// the input's own unit, and the symbol.
    pub const fn display_unit(self, unit: LengthUnit) -> (f64, &'static str) {
        match self {
            Self::Side | Self::Height => {
                let (in_a_metre, symbol, _) = unit.fine();
                (1e-3 * in_a_metre, symbol)
            }
            Self::Speed => unit.speed(),
            Self::Elevation | Self::Direction => (1.0, self.unit()),
        }
    }

    /// Returns the range and step of the scan for the nearest miss, in the input's unit. A step is at most a fifth of
    /// an expert's standard error.
    const fn scan(self) -> (f64, f64) {
        match self {
            Self::Side | Self::Height => (15.0, 0.1),
            Self::Elevation => (15.0, 0.02),
            Self::Direction => (5.0, 0.02),
            Self::Speed => (3.0, 0.015),
        }
    }

    /// Whether its range ends where the tip slips off, which counts as a miss.
    const fn is_tip(self) -> bool {
        matches!(self, Self::Side | Self::Height)
    }
}

/// The outcome of a stroke.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Outcome {
    /// No valid stroke: the tip slips off, the cue has no room, is below the cloth or has no speed, or the stroke
    /// pushes a ball that touches the cue ball.
    NoStroke,
    /// No object ball is hit.
    NoBall,
    /// One object ball is hit.
    OneBall,
    /// Both are hit, but with too few cushions before the second, the wrong ball first at the opening of a game, or a
    /// ball off the table.
    TooFewCushions,
    /// A point.
    Point,
}

/// The outcomes over two inputs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Map {
    /// The input that grows to the right.
    pub across: Input,
    /// The input that grows upwards.
    pub up: Input,
    /// Changes of `across`, one per column, in its unit.
    pub columns: Vec<f64>,
    /// Changes of `up`, one per row, the lowest first, in its unit.
    pub rows: Vec<f64>,
    /// The outcomes, row by row.
    pub outcomes: Vec<Vec<Outcome>>,
}

/// Number of worlds in which a stroke is tried if something is in doubt.
const WORLDS: usize = 12;

/// Seed of those worlds: the same for every stroke, so that the comparison is fair.
const SEED: u64 = 0x6d61_7267_696e_7321;

/// Evaluates variations of a stroke under a rule, a table and a layout, with their uncertainty.
#[derive(Clone, Debug)]
pub struct Sensitivity<'a> {
    point: Point,
    table: &'a Table,
    layout: &'a Layout,
    /// Empty if nothing is in doubt.
    worlds: Vec<World>,
}

impl<'a> Sensitivity<'a> {
    /// Prepares the evaluation of strokes from this layout. With a doubt, strokes are tried in worlds that are drawn
    /// from it; as in the search, tilted tables are not among them.
    pub fn new(rule: Rule, table: &'a Table, layout: &'a Layout, doubt: Doubt) -> Self {
        let mut draws = QuasiRandomDraws::new(ErrorSize::Own, SEED);
        draws.extend_to(&Worlds::level(table, layout, doubt), WORLDS);
        let worlds = draws.drawn().iter().filter_map(|draw| draw.world.cloned()).collect();
        Self { point: Point::of(rule, table, layout), table, layout, worlds }
    }

    /// Finds the margins of a shot that makes the point, in the order of [`Input::ALL`]. The scan can overlook a miss between
    /// two of its steps; the end of a margin is found to a thousandth of a step.
    /// With a doubt, a margin ends where the point is made in less than half of the worlds in which the intended stroke
    /// makes it. `None` if the intended stroke makes it in none.
    pub fn margins(&self, cue: &CueInputs) -> Option<[Margin; 5]> {
        let made = self.where_made(cue)?;
        parallel::map(platform::thread_count(), &Input::ALL, |input| made.margin_here(*input, cue)).try_into().ok()
    }

    /// Returns the margin of a single input.
    pub fn margin(&self, input: Input, cue: &CueInputs) -> Option<Margin> {
        Some(self.where_made(cue)?.margin_here(input, cue))
    }

    fn margin_here(&self, input: Input, cue: &CueInputs) -> Margin {
        let side = |sign: f64| {
            let shifted = |by: f64| self.raised(&input.shifted(self.table, cue, sign * by), &[input]);
            nearest_miss(
                input,
                |by| self.makes(&shifted(by)),
                |by| is_stroke(self.table, self.layout, &shifted(by)) || input.is_tip(),
            )
        };
        Margin { input, unit: input.unit(), less: side(-1.0), more: side(1.0) }
    }

    /// Raises the cue if the shifted stroke is too low for the rail or the balls, as a player would do, unless the
    /// elevation itself is the shifted input.
    fn raised(&self, cue: &CueInputs, off: &[Input]) -> CueInputs {
        let raised = if off.contains(&Input::Elevation) { None } else { playable(self.table, self.layout, cue) };
        raised.unwrap_or(*cue)
    }

    /// Returns the evaluation in those worlds alone in which `cue` makes the point; `None` if it makes none. In the others, a variation
    /// that happens to correct the world's difference would count as a margin of the stroke.
    fn where_made(&self, cue: &CueInputs) -> Option<Self> {
        let made: Vec<bool> = self.outcomes(cue).map(|outcome| outcome == Outcome::Point).collect();
        let worlds = self.worlds.iter().zip(&made).filter(|(_, made)| **made).map(|(world, _)| world.clone()).collect();
        made.contains(&true).then(|| Self { worlds, ..self.clone() })
    }

    /// Returns half of the number of worlds, in which a stroke must make the point to count as made.
    fn required(&self) -> usize {
        self.worlds.len().div_ceil(2).max(1)
    }

    /// Whether a stroke makes the point in at least half of the worlds.
    fn makes(&self, cue: &CueInputs) -> bool {
        let required = self.required();
        self.outcomes(cue).filter(|outcome| *outcome == Outcome::Point).take(required).count() == required
    }

    /// Returns the outcome of a stroke in each world, or in the assumed one if nothing is in doubt.
    fn outcomes(&self, cue: &CueInputs) -> impl Iterator<Item = Outcome> {
        let Self { point, table, layout, worlds } = self;
        let is_stroke = is_stroke(table, layout, cue);
        let touching = Touching::of(table, layout);
        let known = worlds.is_empty().then_some((*cue, *table, *layout));
        let drawn =
            worlds.iter().map(|world| (re_aimed(table, layout, &world.layout, cue), &world.table, &world.layout));
        let come_of = move |(cue, table, layout): (CueInputs, &Table, &Layout)| {
            if is_stroke { outcome(*point, touching, table, layout, &cue) } else { Outcome::NoStroke }
        };
        known.into_iter().chain(drawn).map(come_of)
    }

    /// Computes the outcomes around `middle`, up to `width` and `height` units of the two inputs to either side. There
    /// are `cells` columns and rows, an odd number so that the central cell is `middle` itself. With a doubt,
    /// a cell is a point if it meets the criterion of the margins of `cue`, otherwise the most frequent outcome. If `cue` makes no point,
    /// all worlds count.
    pub fn map(
        &self,
        cue: &CueInputs,
        middle: &CueInputs,
        (across, width): (Input, f64),
        (up, height): (Input, f64),
        cells: usize,
    ) -> Map {
        let half = (cells / 2).max(1);
        let line = |span: f64| -> Vec<f64> {
            (0..=2 * half).map(|index| span * (index as f64 - half as f64) / half as f64).collect()
        };
        let (columns, rows) = (line(width), line(height));
        let made = self.where_made(cue);
        let sensitivity = made.as_ref().unwrap_or(self);
        let outcomes = parallel::map(platform::thread_count(), &rows, |&y| {
            let row = up.shifted(self.table, middle, y);
            let cell = |x: f64| self.raised(&across.shifted(self.table, &row, x), &[across, up]);
            columns.iter().map(|&x| sensitivity.most_frequent_outcome(&cell(x))).collect()
        });
        Map { across, up, columns, rows, outcomes }
    }

    /// Returns [`Outcome::Point`] if at least half of the worlds make it, else the most frequent other outcome.
    fn most_frequent_outcome(&self, cue: &CueInputs) -> Outcome {
        let all: Vec<Outcome> = self.outcomes(cue).collect();
        let count = |outcome: Outcome| all.iter().filter(|one| **one == outcome).count();
        if count(Outcome::Point) >= self.required() {
            return Outcome::Point;
        }
        let others = [Outcome::NoStroke, Outcome::NoBall, Outcome::OneBall, Outcome::TooFewCushions];
        others.into_iter().max_by_key(|outcome| count(*outcome)).unwrap_or(Outcome::NoStroke)
    }
}

/// Finds how far an input may go until `makes` fails; `None` if `is_possible` fails first, or the scan ends.
fn nearest_miss(input: Input, makes: impl Fn(f64) -> bool, is_possible: impl Fn(f64) -> bool) -> Option<f64> {
    const HALVINGS: u32 = 10;
    let (reach, step) = input.scan();
    let steps = (reach / step).ceil() as u32;
    let mut scan = (1..=steps).map(|number| f64::from(number) * step).take_while(|far| is_possible(*far));
    let mut outside = scan.find(|far| !makes(*far))?;
    let mut inside = outside - step;
    for _ in 0..HALVINGS {
        let middle = 0.5 * (inside + outside);
        if makes(middle) { inside = middle } else { outside = middle }
    }
    Some(inside)
}

/// Returns the outcome of a valid stroke. A shot whose resting contacts take more than 200 steps counts as decided by then.
fn outcome(point: Point, touching: Touching, table: &Table, layout: &Layout, cue: &CueInputs) -> Outcome {
    let impulse = strike(table, cue);
    if touching.pushed(layout, &impulse).is_some() {
        return Outcome::NoStroke;
    }
    let mut referee = Referee::new(Some(2), CONTACT_STEPS);
    watch_with::<AllSavings, _>(table, layout, &impulse, &mut referee);
    let Tally { hit: [one, other], .. } = referee.tally;
    match (one, other) {
        (false, false) => Outcome::NoBall,
        (true, true) if point.is_made(&referee.tally) => Outcome::Point,
        (true, true) => Outcome::TooFewCushions,
        _ => Outcome::OneBall,
    }
}

/// Maximum steps of resting contacts: a map has a thousand shots, and a single one can take seconds.
const CONTACT_STEPS: u32 = 200;

fn is_stroke(table: &Table, layout: &Layout, cue: &CueInputs) -> bool {
    cue.validate().is_ok() && cue.validate_tip(table.miscue_limit).is_ok() && has_room(table, layout, cue)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    /// Two balls near each other straight ahead: a simple shot with a wide speed margin.
    fn shot() -> (Table, Layout, CueInputs) {
        let table = Table::default();
        let layout = Layout::new([DVec2::new(-0.5, 0.0), DVec2::new(0.0, 0.0), DVec2::new(0.3, 0.1)]);
        // Made both on the nominal table and on a possible real one.
        let [certain, doubted] =
            [Doubt::NONE, Doubt::FULL].map(|doubt| Sensitivity::new(Rule::StraightRail, &table, &layout, doubt));
        let cue = (0..4000)
            .map(|step| CueInputs { a: 0.0, b: 0.2, theta: 0.02, phi: -0.1 + 5e-5 * f64::from(step), speed: 2.5 })
            .find(|cue| certain.where_made(cue).is_some() && doubted.where_made(cue).is_some())
            .unwrap();
        (table, layout, cue)
    }

    #[test]
    fn margin_separates_points_from_misses() {
        let (table, layout, cue) = shot();
        for doubt in [Doubt::NONE, Doubt::FULL] {
            let sensitivity = Sensitivity::new(Rule::StraightRail, &table, &layout, doubt);
            let made = sensitivity.where_made(&cue).unwrap();
            let margins = sensitivity.margins(&cue).unwrap();
            let mut ends = 0;
            for Margin { input, less, more, .. } in margins {
                for (sign, end) in [(-1.0, less), (1.0, more)].into_iter().filter_map(|(sign, end)| Some((sign, end?)))
                {
                    ends += 1;
                    let hair = 1e-3 * input.scan().1;
                    let makes = |by: f64| made.makes(&input.shifted(&table, &cue, sign * by));
                    assert!(makes(end), "{doubt}: {input:?} {sign} {end}");
                    assert!(!makes(end + 2.0 * hair), "{doubt}: {input:?} {sign} {end}");
                }
            }
            assert!(margins[3].less.is_some() && margins[3].more.is_some() && ends >= 4, "{doubt}: {margins:?}");
            assert!(Sensitivity::new(Rule::ThreeCushion, &table, &layout, doubt).margins(&cue).is_none());
        }
    }

    #[test]
    fn margins_exclude_pushing_a_touching_ball() {
        let (table, ..) = shot();
        let layout = Layout::parse(&format!("0,0 {},0 -0.4,0.02", 2.0 * table.radius), &table).unwrap();
        let stroke = |degrees: f64| CueInputs { a: 0.0, b: 0.0, theta: 0.1, phi: degrees.to_radians(), speed: 3.0 };
        for doubt in [Doubt::NONE, Doubt::FULL] {
            let sensitivity = Sensitivity::new(Rule::StraightRail, &table, &layout, doubt);
            assert_eq!(sensitivity.margins(&stroke(0.0)), None, "{doubt}");
            let outcomes = |degrees| sensitivity.outcomes(&stroke(degrees)).collect::<Vec<_>>();
            assert!(outcomes(80.0).iter().all(|outcome| *outcome == Outcome::NoStroke), "{doubt}");
            assert!(outcomes(100.0).iter().all(|outcome| *outcome != Outcome::NoStroke), "{doubt}");
        }
    }

    #[test]
    fn low_tip_at_a_rail_raises_the_cue() {
        let (table, _, _) = shot();
        let (reach, radius) = (table.reach(), table.radius);
        let layout = Layout::new([DVec2::new(-reach.x + 0.02, 0.0), DVec2::new(0.0, 0.0), DVec2::new(0.3, 0.1)]);
        let straight = CueInputs { a: 0.0, b: 0.3, theta: 0.0, phi: 0.0, speed: 2.5 };
        let lowest = playable(&table, &layout, &straight).unwrap();
        let sensitivity = Sensitivity::new(Rule::StraightRail, &table, &layout, Doubt::NONE);
        let cue = (-400..400)
            .map(|step| CueInputs { phi: 2e-4 * f64::from(step), ..lowest })
            .find(|cue| sensitivity.where_made(cue).is_some())
            .unwrap();
        let lower = Input::Height.shifted(&table, &cue, -1.0);
        assert!(!has_room(&table, &layout, &lower) && lower.b < cue.b - 0.5e-3 / radius);
        let [_, height, elevation, ..] = sensitivity.margins(&cue).unwrap();
        assert!(height.less.is_none_or(|less| less > 0.5), "{height:?}");
        assert!(elevation.less.is_none(), "the cue cannot come lower: {elevation:?}");
    }

    /// Finds a direction near `cue` in which the point is made in several worlds, but not in all.
    fn often_made(sensitivity: &Sensitivity, cue: &CueInputs) -> CueInputs {
        let mut turned = (0..4000).map(|step| CueInputs { phi: cue.phi + 2e-5 * f64::from(step), ..*cue });
        let made_in = |cue: &CueInputs| sensitivity.where_made(cue).map_or(0, |made| made.worlds.len());
        turned.find(|cue| (4..WORLDS).contains(&made_in(cue))).unwrap()
    }

    #[test]
    fn single_failing_world_does_not_end_a_margin() {
        let (table, layout, cue) = shot();
        let sensitivity = Sensitivity::new(Rule::StraightRail, &table, &layout, Doubt::FULL);
        let cue = often_made(&sensitivity, &cue);
        assert_eq!(sensitivity.worlds.len(), WORLDS);
        assert_eq!(Sensitivity::new(Rule::StraightRail, &table, &layout, Doubt::NONE).worlds.len(), 0);
        let less = |sensitivity: &Sensitivity| sensitivity.margin(Input::Direction, &cue)?.less;
        let all = less(&sensitivity).unwrap();
        let mut alone: Vec<f64> = sensitivity
            .worlds
            .iter()
            .filter_map(|world| less(&Sensitivity { worlds: vec![world.clone()], ..sensitivity.clone() }))
            .collect();
        alone.sort_by(f64::total_cmp);
        assert!(alone.len() > 2 && all > alone[0], "{all} of {alone:?}");
        assert_eq!(less(&sensitivity), Some(all), "the same worlds every time");
    }

    #[test]
    fn doubt_does_not_widen_a_margin_beyond_that_of_the_worlds_in_which_the_stroke_is_made() {
        let (table, layout, cue) = shot();
        let sensitivity = Sensitivity::new(Rule::StraightRail, &table, &layout, Doubt::FULL);
        let cue = often_made(&sensitivity, &cue);
        let width = |margin: Margin| margin.less.unwrap_or(1.0) + margin.more.unwrap_or(1.0);
        let own = width(sensitivity.margin(Input::Direction, &cue).unwrap());
        let alone = |world: &World| {
            let one = Sensitivity { worlds: vec![world.clone()], ..sensitivity.clone() };
            one.margin(Input::Direction, &cue).map(width)
        };
        let alone: Vec<f64> = sensitivity.worlds.iter().filter_map(alone).collect();
        assert!(!alone.is_empty() && alone.len() < WORLDS, "some worlds miss: {alone:?}");
        assert!(alone.iter().any(|width| 1.2 * width >= own), "{own} of {alone:?}");
    }

    #[test]
    fn map_centre_and_axes_agree_with_the_margins() {
        let (table, layout, cue) = shot();
        for doubt in [Doubt::NONE, Doubt::FULL] {
            let sensitivity = Sensitivity::new(Rule::StraightRail, &table, &layout, doubt);
            let more = sensitivity.margins(&cue).unwrap()[3].more.unwrap();
            // The columns coincide with the scan's steps: between two steps a miss can hide.
            let step = Input::Direction.scan().1;
            let width = 20.0 * step * (2.0 * more / (20.0 * step)).ceil();
            let map = sensitivity.map(&cue, &cue, (Input::Direction, width), (Input::Speed, 3.0), 41);
            assert_eq!((map.columns.len(), map.rows.len(), map.columns[20], map.rows[20]), (41, 41, 0.0, 0.0));
            assert_eq!(map.outcomes[20][20], Outcome::Point);
            for (by, outcome) in map.columns.iter().zip(&map.outcomes[20]).skip(20) {
                assert!(*by > more || *outcome == Outcome::Point, "{by} of {more}");
            }
            // 2.5 m/s less leaves no stroke.
            assert_eq!(map.outcomes[0][20], Outcome::NoStroke);
        }
    }
}
