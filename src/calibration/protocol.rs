//! The tests that a player plays to calibrate a table: where the balls lie, how to strike, what to mark.

use glam::DVec2;
use serde::Serialize;

use Moment::{Rail, Stop, Stroke};
use Quantity::{RailAcross, RailAlong, StopAcross, StopAlong, Time};

use crate::table::{Layout, Table};

/// What a mark is counted in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Unit {
    /// Diamonds: from 0 to 8 along the table, from 0 to 4 across it.
    Diamonds,
    /// Seconds.
    Seconds,
}

impl Unit {
    /// How numbers are written in it.
    pub const fn sign(self) -> &'static str {
        match self {
            Self::Diamonds => "diamonds",
            Self::Seconds => "s",
        }
    }
}

/// By how much a way of one length may come out too long by rounding, in lengths: far more than that, and far less than anybody sees.
const ROUNDING: f64 = 1e-9;

/// A moment at which a stopwatch is pressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Moment {
    /// The tip meets the cue ball.
    Stroke,
    /// A ball meets its first, second, … rail.
    Rail(usize, usize),
    /// A ball stops.
    Stop(usize),
}

/// What is marked. Balls are numbered as in a layout, rails by the order in which a ball meets them, from 1 on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Where a ball stops, along the table, beyond the short rails that it has met ([`Test::way`]).
    StopAlong(usize),
    /// Where a ball stops, across the table.
    StopAcross(usize),
    /// Where a ball meets a long rail.
    RailAlong(usize, usize),
    /// Where a ball meets a short rail.
    RailAcross(usize, usize),
    /// A time.
    Time(Moment, Moment),
}

/// One number that a test asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mark {
    /// Its name in a file of entries.
    pub name: &'static str,
    /// What it is, for a player.
    pub words: &'static str,
    /// The same for the simulation.
    pub quantity: Quantity,
    /// How sure such a mark is, in its unit, where nothing else is said.
    pub sure: f64,
}

impl Mark {
    /// What it is counted in.
    pub const fn unit(&self) -> Unit {
        match self.quantity {
            Quantity::Time(..) => Unit::Seconds,
            _ => Unit::Diamonds,
        }
    }

    /// The largest value that it can have, in its own unit: the table's sides, and one minute.
    pub const fn most(&self) -> f64 {
        match self.quantity {
            Quantity::StopAlong(_) | Quantity::RailAlong(..) => 8.0,
            Quantity::StopAcross(_) | Quantity::RailAcross(..) => 4.0,
            Quantity::Time(..) => 60.0,
        }
    }
}

/// A test of the protocol.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Test {
    /// Its name in files and on the command line.
    pub name: &'static str,
    /// What it is about.
    pub title: &'static str,
    /// Where the balls lie, for a player.
    pub place: &'static str,
    /// How to strike, for a player.
    pub strike: &'static str,
    /// The balls that take part, the cue ball first, in diamonds from the right-hand corner at the player's end.
    pub balls: &'static [[f64; 2]],
    /// Whether balls 1 and 2 touch: then ball 2 lies beyond ball 1 in the direction, degrees, that is named here.
    pub frozen: Option<f64>,
    /// The stroke that is asked for: a, b in radii, elevation and direction in degrees, speed of the cue in m/s.
    pub cue: [f64; 5],
    /// What is marked.
    pub marks: &'static [Mark],
    /// How many short rails a ball meets that is marked where it stops along the table, where nothing else is said; `None`
    /// where that has to be said.
    pub rails: Option<usize>,
    /// How often it is asked for.
    pub times: usize,
}

impl Test {
    /// The test of this name.
    pub fn named(name: &str) -> Option<&'static Self> {
        PROTOCOL.iter().find(|test| test.name == name)
    }

    /// Whether balls run towards the player's end first.
    fn is_back(&self) -> bool {
        self.cue[3].to_radians().cos() < 0.0
    }

    /// How far along the table a ball has come that has met so many short rails and stands at `place`, diamonds: counted on
    /// from rail to rail, so that what is a little further is a little more.
    pub fn way(&self, table: &Table, rails: usize, place: f64) -> f64 {
        let lengths = rails as f64 * (8.0 - 2.0 * table.radius / table.diamond());
        lengths + if (rails % 2 == 1) == self.is_back() { place } else { 8.0 - place }
    }

    /// How many short rails a ball has met on its way, and where it stands. The rail at which it stands is not counted.
    pub fn place(&self, table: &Table, way: f64) -> (usize, f64) {
        let radius = table.radius / table.diamond();
        let rails = ((way - radius) / (8.0 - 2.0 * radius) - ROUNDING).floor().max(0.0) as usize;
        let beyond = way - rails as f64 * (8.0 - 2.0 * radius);
        (rails, if (rails % 2 == 1) == self.is_back() { beyond } else { 8.0 - beyond })
    }

    /// Where the balls lie, with the line of balls 1 and 2 turned by `turned`, rad. Balls that take no part are far away.
    pub fn layout(&self, table: &Table, turned: f64) -> Layout {
        let metres = |place: [f64; 2]| (DVec2::from_array(place) - DVec2::new(4.0, 2.0)) * table.diamond();
        let mut balls = [DVec2::ZERO, DVec2::new(1e3, 1e3), DVec2::new(-1e3, 1e3)];
        for (ball, place) in balls.iter_mut().zip(self.balls) {
            *ball = metres(*place);
        }
        if let Some(direction) = self.frozen {
            balls[2] = balls[1] + 2.0 * table.radius * DVec2::from_angle(direction.to_radians() + turned);
        } else if self.balls.len() > 1 {
            balls[1] = balls[0] + DVec2::from_angle(turned).rotate(balls[1] - balls[0]);
        }
        Layout::new(balls)
    }
}

/// A mark that is as sure as most are: to a tenth of a diamond, or of a second.
const fn mark(name: &'static str, words: &'static str, quantity: Quantity) -> Mark {
    Mark { name, words, quantity, sure: 0.1 }
}

/// What several tests ask for.
const TIME: Mark =
    Mark { sure: 0.2, ..mark("time", "seconds from the stroke until the ball stops", Time(Stroke, Stop(0))) };
const STOP: Mark = mark("stop", "where it stops along the table", StopAlong(0));
const ACROSS: Mark = mark("across", "where it stops across the table", StopAcross(0));
const DRIFT: Mark = mark("drift", "where it stops across the table (2 is the middle)", StopAcross(0));
const FIRST: Mark = mark("first", "where it meets the left long rail", RailAlong(0, 1));
const THIRD: Mark = mark("third", "where it meets the right long rail", RailAlong(0, 3));
const FOURTH: Mark = mark("fourth", "where it meets your own short rail after that", RailAcross(0, 4));

/// What the tests have in common in which a ball goes from near a corner through diamond 6.
const FROM_CORNER: Test = Test {
    name: "",
    title: "",
    place: "the cue ball near the right-hand corner of your end: 0.6 along, 0.4 across",
    strike: "",
    balls: &[[0.6, 0.4]],
    frozen: None,
    cue: [0.0, 0.2, 3.0, 35.3, 2.5],
    marks: &[FIRST, THIRD, FOURTH, STOP, ACROSS],
    rails: None,
    times: 4,
};

/// The protocol, in the order in which it is played, chosen from candidates by what it is worth to a club player's three-cushion
/// shots: what rails do to a ball without side or with reverse side, which slips and sticks at them, and where a ball stops
/// that has met several, tell more than anything else. A frozen pair tells of the throw between balls, which hardly matters
/// there: nobody is asked to play it.
pub const PROTOCOL: &[Test] = &[
    Test {
        name: "slow-roll",
        title: "slow roll: the cloth's speed, sideways lean",
        place: "any ball in the middle of your end: diamond 1 along, 2 across",
        strike: "straight along the middle, four tips (12 mm) above centre, so softly that it stops past the \
                 middle of the table",
        balls: &[[1.0, 2.0]],
        frozen: None,
        cue: [0.0, 0.4, 2.0, 0.0, 0.30],
        marks: &[TIME, STOP, DRIFT],
        rails: Some(0),
        times: 2,
    },
    Test {
        name: "slow-back",
        title: "slow roll back: how the table leans along",
        place: "any ball in the middle of the far end: diamond 7 along, 2 across",
        strike: "from the far end, straight back along the middle, four tips above centre, as softly as before",
        balls: &[[7.0, 2.0]],
        frozen: None,
        cue: [0.0, 0.4, 2.0, 180.0, 0.30],
        marks: &[TIME, mark("stop", "where it stops along the table, counted from your own end", StopAlong(0)), DRIFT],
        rails: Some(0),
        times: 1,
    },
    Test {
        name: "lag",
        title: "the lag: how alive the short rails are",
        place: "the cue ball in the middle of your end: diamond 1 along, 2 across",
        strike: "centre ball, straight along the middle: to the far rail, back to your own and off it",
        balls: &[[1.0, 2.0]],
        frozen: None,
        cue: [0.0, 0.0, 2.0, 0.0, 1.3],
        marks: &[
            mark("lap", "seconds from the far rail to your own", Time(Rail(0, 1), Rail(0, 2))),
            Mark { sure: 0.2, ..mark("rest", "seconds from your own rail until it stops", Time(Rail(0, 2), Stop(0))) },
            STOP,
        ],
        rails: Some(2),
        times: 1,
    },
    Test {
        name: "hard-lag",
        title: "a hard lag: what fast balls lose at a rail",
        place: "the cue ball in the middle of your end: diamond 1 along, 2 across",
        strike: "centre ball, straight along the middle, hard: five lengths or so",
        balls: &[[1.0, 2.0]],
        frozen: None,
        cue: [0.0, 0.0, 2.0, 0.0, 4.0],
        marks: &[
            mark("lengths", "seconds for two lengths, from the far rail to the far rail", Time(Rail(0, 1), Rail(0, 3))),
            STOP,
        ],
        rails: None,
        times: 1,
    },
    Test {
        name: "corner-five",
        title: "Corner-5, 50 to 20: how three rails play",
        strike: "through diamond 6 of the left long rail (that is 20), three tips of running side (right), two above \
                 centre, medium speed",
        cue: [-0.3, 0.2, 3.0, 35.3, 2.8],
        ..FROM_CORNER
    },
    Test {
        name: "five-plain",
        title: "the line without side: how the rails grip",
        strike: "through diamond 6 of the left long rail, without side, two tips above centre, at medium speed",
        ..FROM_CORNER
    },
    Test {
        name: "five-reverse",
        title: "reverse side: how soon the rails turn it",
        strike: "through diamond 6 of the left long rail, three tips of reverse side (left), two above centre, \
                 medium speed",
        cue: [0.3, 0.2, 3.0, 35.3, 2.5],
        marks: &[FIRST, mark("second", "where it meets the far short rail", RailAcross(0, 2)), THIRD, STOP, ACROSS],
        ..FROM_CORNER
    },
    Test {
        name: "side-along",
        title: "maximum side: squirt, how long side lasts",
        place: "the cue ball in the middle of your end: diamond 1 along, 2 across",
        strike: "maximum side on the left, straight along the middle, at medium speed: it shall reach a long rail",
        balls: &[[1.0, 2.0]],
        frozen: None,
        cue: [0.45, 0.0, 3.0, 0.0, 1.8],
        marks: &[
            mark("first", "where it meets the far short rail", RailAcross(0, 1)),
            mark("second", "where it meets the left long rail then", RailAlong(0, 2)),
            STOP,
            ACROSS,
        ],
        rails: None,
        times: 2,
    },
    Test {
        name: "full-hit",
        title: "a full hit: what is lost between the balls",
        place: "the cue ball at diamond 1 along, another ball at 2 along, both in the middle (2 across)",
        strike: "centre ball, full, soft: the other ball shall stop before the far rail",
        balls: &[[1.0, 2.0], [2.0, 2.0]],
        frozen: None,
        cue: [0.0, 0.0, 2.0, 0.0, 0.55],
        marks: &[
            mark("object", "where the other ball stops along the table", StopAlong(1)),
            mark("cue", "where the cue ball stops along the table", StopAlong(0)),
        ],
        rails: Some(0),
        times: 1,
    },
    Test {
        name: "frozen-pair",
        title: "a frozen pair: how balls throw each other",
        place: "a ball at 1.8 along, 2 across; another one behind it that touches it, both in line with the middle of the \
                far rail; the cue ball at 1 along, 1.2 across",
        strike: "centre ball, full on the nearer ball, medium speed",
        balls: &[[1.0, 1.2], [1.8, 2.0]],
        frozen: Some(0.0),
        cue: [0.0, 0.0, 2.0, 45.0, 1.0],
        marks: &[mark("object", "where the farther ball meets the far short rail", RailAcross(2, 1))],
        rails: Some(0),
        times: 0,
    },
];
