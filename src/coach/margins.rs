//! How far off a stroke may be: the nearest miss on either side of each input, and maps of the outcome over two of them.

use serde::Serialize;

use crate::{
    game::{Point, Referee, Rule, Tally},
    physics::{CueInputs, has_room, strike},
    simulation::{Event, Observer, StepBudget, watch},
    table::{Layout, Table},
};

/// One of the five cue inputs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Input {
    /// The tip's place to the side, mm.
    #[serde(rename = "a")]
    Side,
    /// The tip's height, mm.
    #[serde(rename = "b")]
    Height,
    /// The cue's elevation, degrees.
    #[serde(rename = "theta")]
    Elevation,
    /// The direction, degrees.
    #[serde(rename = "phi")]
    Direction,
    /// The speed, m/s.
    #[serde(rename = "V")]
    Speed,
}

impl Input {
    /// All five.
    pub const ALL: [Self; 5] = [Self::Side, Self::Height, Self::Elevation, Self::Direction, Self::Speed];

    /// The thesis' letter.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Side => "a",
            Self::Height => "b",
            Self::Elevation => "theta",
            Self::Direction => "phi",
            Self::Speed => "V",
        }
    }

    /// The unit in which people speak of it.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Side | Self::Height => "mm",
            Self::Elevation | Self::Direction => "degrees",
            Self::Speed => "m/s",
        }
    }

    /// How far the nearest miss is looked for, and in what steps, in that unit. The steps are a fifth of an expert's
    /// standard error or less.
    const fn scan(self) -> (f64, f64) {
        match self {
            Self::Side | Self::Height => (15.0, 0.1),
            Self::Elevation => (15.0, 0.02),
            Self::Direction => (5.0, 0.02),
            Self::Speed => (3.0, 0.015),
        }
    }

    /// The stroke with this input changed by so many of its units.
    #[must_use]
    pub fn shifted(self, table: &Table, cue: &CueInputs, by: f64) -> CueInputs {
        let mut cue = *cue;
        match self {
            Self::Side => cue.a += 1e-3 * by / table.radius,
            Self::Height => cue.b += 1e-3 * by / table.radius,
            Self::Elevation => cue.theta += by.to_radians(),
            Self::Direction => cue.phi += by.to_radians(),
            Self::Speed => cue.speed += by,
        }
        cue
    }
}

/// How far one input may be off while the others are as meant.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Margin {
    /// The input.
    pub input: Input,
    /// Its unit.
    pub unit: &'static str,
    /// How much less it may be, in that unit; `None` where no miss was found: within 15 mm, 15° of elevation, 5° of
    /// direction or 3 m/s, or before the input comes to its own end.
    pub less: Option<f64>,
    /// How much more it may be.
    pub more: Option<f64>,
}

/// What comes of a stroke.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Outcome {
    /// No stroke: the tip slips off, the cue has no room, is below the cloth or stands still.
    NoStroke,
    /// No object ball is met.
    NoBall,
    /// One is.
    OneBall,
    /// Both are, with too few cushions before the second, as a game opens with the wrong ball first, or a ball leaves the table.
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
    /// Changes of the first, one a column, in its unit.
    pub columns: Vec<f64>,
    /// Changes of the second, one a row, the lowest first, in its unit.
    pub rows: Vec<f64>,
    /// The outcomes, row by row.
    pub outcomes: Vec<Vec<Outcome>>,
}

/// The margins of a shot that makes the point, in the order of [`Input::ALL`]. Between two steps of the scan a miss can
/// hide; the end of the margin is then found to a thousandth of a step. `None` where the shot makes no point.
pub fn margins(rule: Rule, table: &Table, layout: &Layout, cue: &CueInputs) -> Option<[Margin; 5]> {
    let makes = outcome(rule, table, layout, cue) == Outcome::Point;
    makes.then(|| Input::ALL.map(|input| around(input, rule, table, layout, cue)))
}

/// The margin of one input alone.
pub fn margin(input: Input, rule: Rule, table: &Table, layout: &Layout, cue: &CueInputs) -> Option<Margin> {
    let makes = outcome(rule, table, layout, cue) == Outcome::Point;
    makes.then(|| around(input, rule, table, layout, cue))
}

fn around(input: Input, rule: Rule, table: &Table, layout: &Layout, cue: &CueInputs) -> Margin {
    let side = |sign: f64| {
        let shifted = |by: f64| input.shifted(table, cue, sign * by);
        nearest_miss(
            input,
            |by| outcome(rule, table, layout, &shifted(by)) == Outcome::Point,
            |by| is_stroke(table, layout, &shifted(by)) || input.is_tip(),
        )
    };
    Margin { input, unit: input.unit(), less: side(-1.0), more: side(1.0) }
}

impl Input {
    /// Whether it is one whose end is the tip slipping off, which is a miss like any other.
    const fn is_tip(self) -> bool {
        matches!(self, Self::Side | Self::Height)
    }
}

/// How far an input may go until `makes` fails; `None` where it does not before the scan's end or `is_possible` does.
fn nearest_miss(input: Input, makes: impl Fn(f64) -> bool, is_possible: impl Fn(f64) -> bool) -> Option<f64> {
    const HALVINGS: u32 = 10;
    let (reach, step) = input.scan();
    let steps = (reach / step).ceil() as u32;
    for number in 1..=steps {
        let far = f64::from(number) * step;
        if !is_possible(far) {
            return None;
        }
        if !makes(far) {
            let (mut inside, mut outside) = (far - step, far);
            for _ in 0..HALVINGS {
                let middle = 0.5 * (inside + outside);
                if makes(middle) {
                    inside = middle;
                } else {
                    outside = middle;
                }
            }
            return Some(inside);
        }
    }
    None
}

/// The outcomes around a stroke: `cells` columns and rows, an odd number so that the stroke itself is in the middle, up to
/// so many units of each input to either side.
pub fn map(
    rule: Rule,
    table: &Table,
    layout: &Layout,
    cue: &CueInputs,
    (across, width): (Input, f64),
    (up, height): (Input, f64),
    cells: usize,
) -> Map {
    let half = (cells / 2).max(1);
    let line = |span: f64| -> Vec<f64> {
        (0..=2 * half).map(|index| span * (index as f64 - half as f64) / half as f64).collect()
    };
    let (columns, rows) = (line(width), line(height));
    let outcomes = super::parallel::map(super::parallel::cores(), &rows, |&y| {
        let row = up.shifted(table, cue, y);
        columns.iter().map(|&x| outcome(rule, table, layout, &across.shifted(table, &row, x))).collect()
    });
    Map { across, up, columns, rows, outcomes }
}

/// What comes of a stroke. A shot whose resting contacts take more than 200 steps counts as decided by then.
pub fn outcome(rule: Rule, table: &Table, layout: &Layout, cue: &CueInputs) -> Outcome {
    if !is_stroke(table, layout, cue) {
        return Outcome::NoStroke;
    }
    let mut patient = Patient { referee: Referee::default(), patience: StepBudget(CONTACT_STEPS) };
    watch(table, layout, &strike(table, cue), &mut patient);
    let Tally { met: [one, other], .. } = patient.referee.tally;
    match (one, other) {
        (false, false) => Outcome::NoBall,
        (true, true) if Point::of(rule, table, layout).is_made(&patient.referee.tally) => Outcome::Point,
        (true, true) => Outcome::TooFewCushions,
        _ => Outcome::OneBall,
    }
}

/// Steps of resting contacts that are followed: a map has a thousand shots, and one of them can take seconds.
const CONTACT_STEPS: u32 = 200;

fn is_stroke(table: &Table, layout: &Layout, cue: &CueInputs) -> bool {
    cue.validate().is_ok() && cue.validate_tip(table.miscue_limit).is_ok() && has_room(table, layout, cue)
}

/// A referee who gives up in the end.
struct Patient {
    referee: Referee,
    patience: StepBudget,
}

impl Observer for Patient {
    const ENDS: bool = Referee::ENDS;

    fn event(&mut self, event: Event) -> std::ops::ControlFlow<()> {
        self.referee.event(event)
    }

    fn contact_step(&mut self) -> std::ops::ControlFlow<()> {
        self.patience.step()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    /// Two balls near each other straight ahead: a plain shot with a wide margin of speed.
    fn shot() -> (Table, Layout, CueInputs) {
        let table = Table::default();
        let layout = Layout::new([DVec2::new(-0.5, 0.0), DVec2::new(0.0, 0.0), DVec2::new(0.3, 0.1)]);
        let cue = (0..4000)
            .map(|step| CueInputs { a: 0.0, b: 0.2, theta: 0.02, phi: -0.1 + 5e-5 * f64::from(step), speed: 2.5 })
            .find(|cue| outcome(Rule::StraightRail, &table, &layout, cue) == Outcome::Point)
            .unwrap();
        (table, layout, cue)
    }

    #[test]
    fn just_inside_a_margin_the_point_is_made_and_just_outside_it_is_not() {
        let (table, layout, cue) = shot();
        let makes = |cue: &CueInputs| outcome(Rule::StraightRail, &table, &layout, cue) == Outcome::Point;
        let margins = margins(Rule::StraightRail, &table, &layout, &cue).unwrap();
        let mut ends = 0;
        for Margin { input, less, more, .. } in margins {
            for (sign, end) in [(-1.0, less), (1.0, more)].into_iter().filter_map(|(sign, end)| Some((sign, end?))) {
                ends += 1;
                let hair = 1e-3 * input.scan().1;
                assert!(makes(&input.shifted(&table, &cue, sign * end)), "{input:?} {sign} {end}");
                assert!(!makes(&input.shifted(&table, &cue, sign * (end + 2.0 * hair))), "{input:?} {sign} {end}");
            }
        }
        // The first direction of the scan that makes the point: a hair less misses, and no cue is below the cloth.
        assert!(margins[3].less.is_some_and(|less| less < 0.01) && margins[3].more.is_some());
        assert!(ends >= 4, "{margins:?}");
        assert!(super::margins(Rule::ThreeCushion, &table, &layout, &cue).is_none());
    }

    #[test]
    fn a_map_holds_the_stroke_in_its_middle_and_the_margins_on_its_axes() {
        let (table, layout, cue) = shot();
        let rule = Rule::StraightRail;
        let more = margins(rule, &table, &layout, &cue).unwrap()[3].more.unwrap();
        let map = map(rule, &table, &layout, &cue, (Input::Direction, 2.0 * more), (Input::Speed, 3.0), 41);
        assert_eq!((map.columns.len(), map.rows.len(), map.columns[20], map.rows[20]), (41, 41, 0.0, 0.0));
        assert_eq!(map.outcomes[20][20], Outcome::Point);
        for (column, by) in map.columns.iter().enumerate().skip(20) {
            let inside = *by <= more;
            assert!(!inside || map.outcomes[20][column] == Outcome::Point, "{by} of {more}");
        }
        // 2.5 m/s less is no stroke.
        assert_eq!(map.outcomes[0][20], Outcome::NoStroke);
    }
}
