//! One stroke played by a referee who looks at the clock: a shot with a stiff contact can take seconds.

use std::{
    ops::ControlFlow,
    sync::atomic::AtomicBool,
    time::{Duration, Instant},
};

use super::{
    FirstMet, Shooter, Skill,
    candidates::{MAX_ELEVATION, playable},
    clock::Clock,
    draws::{Draw, World, Worlds},
    elevated::{is_jump_or_masse, makes_jump_or_masse},
};
use crate::{
    game::{Point, Referee, Rule, Tally, Touching, pushes_touching_ball},
    physics::{CueInputs, Impulse, strike},
    player::aimed,
    simulation::{All, Event, Observer, watch_with},
    table::{BALLS, Layout, Table},
};

/// The task that shots are tried at.
#[derive(Clone, Copy, Debug)]
pub struct Task<'a> {
    /// The table.
    pub table: &'a Table,
    /// Where the balls lie.
    pub layout: &'a Layout,
    /// What counts as a point.
    pub rule: Rule,
    /// Whose strokes they are.
    pub skill: Skill,
    /// Whether jumps and massés may be played.
    pub jumps: bool,
    /// What the shot is to meet first.
    pub first: FirstMet,
    /// What may really be there.
    pub worlds: &'a Worlds,
    /// Counts the shots, and knows whether anybody waits.
    pub clock: &'a Clock<'a>,
    /// When a shot is broken off.
    pub until: Instant,
    /// Steps of resting contacts after which a shot is given up as a miss. Balls that press each other for so long have
    /// lost their speed.
    pub patience: u32,
}

/// Steps of resting contacts after which a shot that is one of many is given up as a miss.
pub const CONTACT_STEPS: u32 = 100;

/// A patience that follows every contact to its end.
pub const ENDLESS: u32 = u32::MAX;

/// Hands over the task of trying strokes of `shooter` that neither time nor the number of simulations ends; `cancel`, set from
/// another thread, does.
pub fn unhurried<T>(
    table: &Table,
    layout: &Layout,
    rule: Rule,
    shooter: Shooter,
    patience: u32,
    cancel: &AtomicBool,
    play: impl FnOnce(&Task) -> T,
) -> T {
    let clock = Clock::start(Duration::MAX, u64::MAX, cancel);
    let (skill, worlds, until) = (shooter.skill, Worlds::new(table, layout, shooter.doubts()), clock.moment(1.0));
    let (jumps, first) = (true, FirstMet::Any);
    play(&Task { table, layout, rule, skill, jumps, first, worlds: &worlds, clock: &clock, until, patience })
}

impl Task<'_> {
    /// The stroke as a player can play it here: see [`playable`]. `None` too where the rules forbid it, for it pushes a ball that touches
    /// the cue ball.
    pub fn playable(&self, cue: &CueInputs) -> Option<CueInputs> {
        if pushes_touching_ball(self.table, self.layout, cue) {
            return None;
        }
        playable(self.table, self.layout, cue)
    }

    /// Whether strokes are looked for with the cue raised for a jump or a massé: on a table that keeps its balls on the cloth
    /// neither is what it would be.
    pub const fn seeks_jumps(&self) -> bool {
        self.jumps && self.table.flight.is_some()
    }

    /// Whether the stroke may be advised here: where jumps and massés are forbidden, it must be none; and a cue that is raised
    /// as high as for one must make one.
    pub fn allows(&self, cue: &CueInputs) -> bool {
        if cue.theta > MAX_ELEVATION {
            self.seeks_jumps() && makes_jump_or_masse(self.table, self.layout, cue)
        } else {
            self.jumps || !is_jump_or_masse(self.table, self.layout, cue)
        }
    }

    /// Whether a stroke with this tally is one of those looked for: it makes the point, begins as it should and may be advised.
    pub fn suits(&self, cue: &CueInputs, tally: &Tally) -> bool {
        self.point().is_made(tally) && self.first.allows(tally) && self.allows(cue)
    }

    /// What makes a shot from here a point.
    pub fn point(&self) -> Point {
        Point::of(self.rule, self.table, self.layout)
    }

    /// The tally of one stroke up to the decision; `None` where time ran out before.
    pub fn play(&self, cue: &CueInputs) -> Option<Tally> {
        self.play_on(self.table, self.layout, cue)
    }

    fn play_on(&self, table: &Table, layout: &Layout, cue: &CueInputs) -> Option<Tally> {
        let impulse = strike(table, cue);
        let referee = Referee::new(Some(2), self.patience).beginning(self.tally(layout, &impulse));
        let mut hurried = Hurried { referee, late: false, task: self };
        watch_with::<All, _>(table, layout, &impulse, &mut hurried);
        (!hurried.late).then_some(hurried.referee.tally)
    }

    /// What a stroke begins with where the balls really lie as in `layout`: those that touch by the task's own layout do so for whoever
    /// looks at them.
    #[inline]
    pub fn tally(&self, layout: &Layout, impulse: &Impulse) -> Tally {
        Tally { pushed: Touching::of(self.table, self.layout).pushed(layout, impulse), ..Tally::default() }
    }

    /// The stroke that comes of an attempt at `cue`, with the table and the layout on which it is played.
    #[inline]
    pub fn stroke<'w>(&'w self, cue: &CueInputs, draw: Draw<'w>) -> (CueInputs, &'w Table, &'w Layout) {
        match draw.world {
            None => (self.skill.stroke(self.table.radius, cue, draw.errors), self.table, self.layout),
            Some(World { table, layout }) => {
                let cue = aimed(self.table, self.layout, layout, cue);
                (self.skill.stroke(table.radius, &cue, draw.errors), table, layout)
            }
        }
    }

    /// Whether an attempt at `cue` makes the point; a tip beyond the table's miscue limit makes none. `None` where time ran
    /// out.
    pub fn makes(&self, cue: &CueInputs, draw: Draw) -> Option<bool> {
        let (stroke, table, layout) = self.stroke(cue, draw);
        if stroke.is_miscue(table) {
            return Some(false);
        }
        self.play_on(table, layout, &stroke).map(|tally| self.point().is_made(&tally))
    }

    /// Attempts at `cue`, one after the other until time runs out.
    pub fn attempts<'d>(&self, cue: &CueInputs, draws: impl Iterator<Item = Draw<'d>>) -> Attempts {
        let mut attempts = Attempts::default();
        for draw in draws {
            if self.clock.is_past(self.until) {
                break;
            }
            let Some(point) = self.makes(cue, draw) else { break };
            attempts.tried += 1;
            attempts.made += usize::from(point);
        }
        self.clock.count(attempts.tried as u64);
        attempts
    }
}

/// What came of attempts at a stroke.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Attempts {
    /// How many there were.
    pub tried: usize,
    /// How many made the point.
    pub made: usize,
}

/// A referee who gives a shot up when time is up.
struct Hurried<'a> {
    referee: Referee,
    late: bool,
    task: &'a Task<'a>,
}

impl Observer for Hurried<'_> {
    fn wants_ends(&self) -> bool {
        self.referee.wants_ends()
    }

    fn awaited(&self) -> Option<[bool; BALLS - 1]> {
        self.referee.awaited()
    }

    #[inline]
    fn event(&mut self, event: Event) -> ControlFlow<()> {
        self.referee.event(event)
    }

    fn contact_step(&mut self) -> ControlFlow<()> {
        if self.task.clock.is_past(self.task.until) {
            self.late = true;
            return ControlFlow::Break(());
        }
        self.referee.contact_step()
    }
}
