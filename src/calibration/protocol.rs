//! The tests that a player plays to calibrate a table: positions of the balls, the stroke, and the marks.

use glam::DVec2;
use serde::Serialize;

use Moment::{Rail, Stop, Stroke};
use Quantity::{RailAcross, RailAlong, StopAcross, StopAlong, Time};

use crate::table::{Layout, Table};

/// The unit of a mark.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Unit {
    /// Diamonds: from 0 to 8 along the table, from 0 to 4 across it.
    Diamonds,
    /// Seconds.
    Seconds,
}

impl Unit {
    /// Returns the unit's name after a number.
    pub const fn sign(self) -> &'static str {
        match self {
            Self::Diamonds => "diamonds",
            Self::Seconds => "s",
        }
    }
}

/// Tolerance for the rounding of a travel, in table lengths: far above any rounding error, and far below anything visible.
const ROUNDING: f64 = 1e-9;

/// A moment at which a stopwatch is pressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Moment {
    /// The tip hits the cue ball.
    Stroke,
    /// A ball hits its first, second, … rail.
    Rail(usize, usize),
    /// A ball stops.
    Stop(usize),
}

/// The measured quantity of a mark. Balls are numbered as in a layout, rails in the order in which a ball hits them, from 1 on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Final position of a ball along the table, as its travel over the short rails that it has hit ([`Test::travel`]).
    StopAlong(usize),
    /// Final position of a ball across the table.
    StopAcross(usize),
    /// Position along the table at which a ball hits a long rail.
    RailAlong(usize, usize),
    /// Position across the table at which a ball hits a short rail.
    RailAcross(usize, usize),
    /// Time between two moments.
    Time(Moment, Moment),
}

/// One number that a player marks in a test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mark {
    /// Its name in a file of entries.
    pub name: &'static str,
    /// Description for the player.
    pub words: &'static str,
    /// The measured quantity, for the simulation.
    pub quantity: Quantity,
    /// Usual standard error of the mark, in its unit.
    pub standard_error: f64,
}

impl Mark {
    /// The unit of the mark.
    pub const fn unit(&self) -> Unit {
        match self.quantity {
            Quantity::Time(..) => Unit::Seconds,
            _ => Unit::Diamonds,
        }
    }

    /// The largest accepted value, in its unit: the table's sides, and one minute.
    pub const fn max_value(&self) -> f64 {
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
    /// What the test measures, for the player.
    pub title: &'static str,
    /// Positions of the balls, for the player.
    pub placement: &'static str,
    /// Description of the stroke, for the player.
    pub strike: &'static str,
    /// Positions of the balls in use, the cue ball first, in diamonds from the right-hand corner at the player's end.
    pub balls: &'static [[f64; 2]],
    /// For touching balls 1 and 2, the direction from ball 1 to ball 2, degrees.
    pub frozen: Option<f64>,
    /// The requested stroke: a, b in radii, elevation and direction in degrees, speed of the cue in m/s.
    pub cue: [f64; 5],
    /// The marks.
    pub marks: &'static [Mark],
    /// Usual number of short rails hit by a ball whose final position along the table is marked; `None` if the player must enter it.
    pub rails: Option<usize>,
    /// Requested number of strokes.
    pub repetitions: usize,
}

impl Test {
    /// Returns the test called `name`.
    pub fn named(name: &str) -> Option<&'static Self> {
        PROTOCOL.iter().find(|test| test.name == name)
    }

    /// Whether balls run towards the player's end first.
    fn is_back(&self) -> bool {
        self.cue[3].to_radians().cos() < 0.0
    }

    /// Returns the travel of a ball along the table, diamonds, if it has hit `rails` short rails and stopped at `position`. The travel
    /// continues from rail to rail, so it is a continuous function of the ball's motion.
    pub fn travel(&self, table: &Table, rails: usize, position: f64) -> f64 {
        let lengths = rails as f64 * (8.0 - 2.0 * table.radius / table.diamond());
        lengths + if (rails % 2 == 1) == self.is_back() { position } else { 8.0 - position }
    }

    /// Returns the number of short rails hit and the position after a travel, both in diamonds. A rail that the ball touches at the end
    /// does not count. This is the inverse of [`Test::travel`].
    pub fn position(&self, table: &Table, travel: f64) -> (usize, f64) {
        let radius = table.radius / table.diamond();
        let rails = ((travel - radius) / (8.0 - 2.0 * radius) - ROUNDING).floor().max(0.0) as usize;
        let beyond = travel - rails as f64 * (8.0 - 2.0 * radius);
        (rails, if (rails % 2 == 1) == self.is_back() { beyond } else { 8.0 - beyond })
    }

    /// Returns the layout with the line of balls 1 and 2 turned by `turned`, rad. Balls that are not in use are far away.
    pub fn layout(&self, table: &Table, turned: f64) -> Layout {
        let metres = |position: [f64; 2]| (DVec2::from_array(position) - DVec2::new(4.0, 2.0)) * table.diamond();
        let mut balls = [DVec2::ZERO, DVec2::new(1e3, 1e3), DVec2::new(-1e3, 1e3)];
        for (ball, position) in balls.iter_mut().zip(self.balls) {
            *ball = metres(*position);
        }
        if let Some(direction) = self.frozen {
            balls[2] = balls[1] + 2.0 * table.radius * DVec2::from_angle(direction.to_radians() + turned);
        } else if self.balls.len() > 1 {
            balls[1] = balls[0] + DVec2::from_angle(turned).rotate(balls[1] - balls[0]);
        }
        Layout::new(balls)
    }
}

/// Creates a mark with the usual standard error: a tenth of a diamond, or of a second.
const fn mark(name: &'static str, words: &'static str, quantity: Quantity) -> Mark {
    Mark { name, words, quantity, standard_error: 0.1 }
}

/// Marks of several tests.
const TIME: Mark =
    Mark { standard_error: 0.2, ..mark("time", "seconds from the stroke until the ball stops", Time(Stroke, Stop(0))) };
const STOP: Mark = mark("stop", "where it stops along the table", StopAlong(0));
const ACROSS: Mark = mark("across", "where it stops across the table", StopAcross(0));
const DRIFT: Mark = mark("drift", "where it stops across the table (2 is the middle)", StopAcross(0));
const FIRST: Mark = mark("first", "where it meets the left long rail", RailAlong(0, 1));
const THIRD: Mark = mark("third", "where it meets the right long rail", RailAlong(0, 3));
const FOURTH: Mark = mark("fourth", "where it meets your own short rail after that", RailAcross(0, 4));

/// The common part of the tests in which a ball goes from near a corner through diamond 6.
const FROM_CORNER: Test = Test {
    name: "",
    title: "",
    placement: "the cue ball near the right-hand corner of your end: 0.6 along, 0.4 across",
    strike: "",
    balls: &[[0.6, 0.4]],
    frozen: None,
    cue: [0.0, 0.2, 3.0, 35.3, 2.5],
    marks: &[FIRST, THIRD, FOURTH, STOP, ACROSS],
    rails: None,
    repetitions: 4,
};

/// The protocol, in the order in which it is played. The tests were chosen from candidates by their value for a club player's
/// three-cushion shots. The most informative are the rebound of a ball without side or with reverse side, which slips and sticks at the
/// rails, and the final position of a ball after several rails. A frozen pair measures the throw between balls, which hardly matters for
/// these shots, so it is not requested (`repetitions` is 0).
pub const PROTOCOL: &[Test] = &[
    Test {
        name: "slow-roll",
        title: "slow roll: the cloth's speed, sideways lean",
        placement: "any ball in the middle of your end: diamond 1 along, 2 across",
        strike: "straight along the middle, four tips (12 mm) above centre, so softly that it stops past the \
                 middle of the table",
        balls: &[[1.0, 2.0]],
        frozen: None,
        cue: [0.0, 0.4, 2.0, 0.0, 0.30],
        marks: &[TIME, STOP, DRIFT],
        rails: Some(0),
        repetitions: 2,
    },
    Test {
        name: "slow-back",
        title: "slow roll back: lean along the table",
        placement: "any ball in the middle of the far end: diamond 7 along, 2 across",
        strike: "from the far end, straight back along the middle, four tips above centre, as softly as before",
        balls: &[[7.0, 2.0]],
        frozen: None,
        cue: [0.0, 0.4, 2.0, 180.0, 0.30],
        marks: &[TIME, mark("stop", "where it stops along the table, counted from your own end", StopAlong(0)), DRIFT],
        rails: Some(0),
        repetitions: 1,
    },
    Test {
        name: "lag",
        title: "the lag: how alive the short rails are",
        placement: "the cue ball in the middle of your end: diamond 1 along, 2 across",
        strike: "centre ball, straight along the middle: to the far rail, back to your own and off it",
        balls: &[[1.0, 2.0]],
        frozen: None,
        cue: [0.0, 0.0, 2.0, 0.0, 1.3],
        marks: &[
            mark("lap", "seconds from the far rail to your own", Time(Rail(0, 1), Rail(0, 2))),
            Mark {
                standard_error: 0.2,
                ..mark("rest", "seconds from your own rail until it stops", Time(Rail(0, 2), Stop(0)))
            },
            STOP,
        ],
        rails: Some(2),
        repetitions: 1,
    },
    Test {
        name: "hard-lag",
        title: "a hard lag: what fast balls lose at a rail",
        placement: "the cue ball in the middle of your end: diamond 1 along, 2 across",
        strike: "centre ball, straight along the middle, hard: five lengths or so",
        balls: &[[1.0, 2.0]],
        frozen: None,
        cue: [0.0, 0.0, 2.0, 0.0, 4.0],
        marks: &[
            mark("lengths", "seconds for two lengths, from the far rail to the far rail", Time(Rail(0, 1), Rail(0, 3))),
            STOP,
        ],
        rails: None,
        repetitions: 1,
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
        placement: "the cue ball in the middle of your end: diamond 1 along, 2 across",
        strike: "maximum side on the left, straight along the middle, at medium speed: it must reach a long rail",
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
        repetitions: 2,
    },
    Test {
        name: "full-hit",
        title: "a full hit: what is lost between the balls",
        placement: "the cue ball at diamond 1 along, another ball at 2 along, both in the middle (2 across)",
        strike: "centre ball, full, soft: the other ball must stop before the far rail",
        balls: &[[1.0, 2.0], [2.0, 2.0]],
        frozen: None,
        cue: [0.0, 0.0, 2.0, 0.0, 0.55],
        marks: &[
            mark("object", "where the other ball stops along the table", StopAlong(1)),
            mark("cue", "where the cue ball stops along the table", StopAlong(0)),
        ],
        rails: Some(0),
        repetitions: 1,
    },
    Test {
        name: "frozen-pair",
        title: "a frozen pair: how balls throw each other",
        placement: "a ball at 1.8 along, 2 across; another one behind it that touches it, both in line with the middle of the \
                far rail; the cue ball at 1 along, 1.2 across",
        strike: "centre ball, full on the nearer ball, medium speed",
        balls: &[[1.0, 1.2], [1.8, 2.0]],
        frozen: Some(0.0),
        cue: [0.0, 0.0, 2.0, 45.0, 1.0],
        marks: &[mark("object", "where the farther ball meets the far short rail", RailAcross(2, 1))],
        rails: Some(0),
        repetitions: 0,
    },
];
