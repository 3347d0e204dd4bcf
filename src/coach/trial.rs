//! Simulation of one stroke with a time limit: a shot with a stiff contact can take seconds.

use std::{
    iter::Sum,
    ops::ControlFlow,
    sync::atomic::AtomicBool,
    time::{Duration, Instant},
};

use super::{
    FirstContact, Shooter, Skill,
    candidates::{MAX_ELEVATION, playable},
    clock::Clock,
    draws::{Draw, Draws, World, Worlds},
    elevated::{is_jump_or_masse, makes_jump_or_masse},
};
use crate::{
    game::{Point, Referee, Rule, Tally, Touching, pushes_touching_ball},
    physics::{CueInputs, Impulse, strike},
    player::re_aimed,
    simulation::{AllSavings, Event, Observer, watch_with},
    statistics::SuccessRate,
    table::{BALLS, Layout, Table},
};

/// The problem for which shots are tried, and the limits of the simulation.
#[derive(Clone, Copy, Debug)]
pub struct Task<'a> {
    /// The table.
    pub table: &'a Table,
    /// The ball positions.
    pub layout: &'a Layout,
    /// What counts as a point.
    pub rule: Rule,
    /// The player's execution errors.
    pub skill: Skill,
    /// Whether jumps and massés may be played.
    pub jumps: bool,
    /// What the shot must hit first.
    pub first: FirstContact,
    /// The tables and layouts that may be the real ones.
    pub worlds: &'a Worlds,
    /// Counts the simulations and detects cancellation.
    pub clock: &'a Clock<'a>,
    /// Time at which a simulation is aborted.
    pub deadline: Instant,
    /// Steps of resting contacts after which a shot is given up as a miss. Balls that press each other for so long have
    /// lost their speed.
    pub max_contact_steps: u32,
}

/// Steps of resting contacts after which a shot that is one of many is given up as a miss.
pub const CONTACT_STEPS: u32 = 100;

/// Value of `max_contact_steps` that follows every contact to its end.
pub const UNLIMITED_STEPS: u32 = u32::MAX;

/// Runs `play` with a task for strokes of `shooter` without limits on time and simulations. It ends early only if
/// another thread sets `cancel`.
pub fn with_unlimited_task<T>(
    table: &Table,
    layout: &Layout,
    rule: Rule,
    shooter: Shooter,
    max_contact_steps: u32,
    cancel: &AtomicBool,
    play: impl FnOnce(&Task) -> T,
) -> T {
    let clock = Clock::start(Duration::MAX, u64::MAX, cancel);
    let worlds = Worlds::new(table, layout, shooter.effective_doubt());
    play(&Task { max_contact_steps, ..Task::new(table, layout, rule, shooter.skill, &worlds, &clock) })
}

impl<'a> Task<'a> {
    /// Creates a task for strokes of any kind, until the clock's time is used up.
    pub fn new(
        table: &'a Table,
        layout: &'a Layout,
        rule: Rule,
        skill: Skill,
        worlds: &'a Worlds,
        clock: &'a Clock<'a>,
    ) -> Self {
        let (jumps, first, max_contact_steps) = (true, FirstContact::Any, CONTACT_STEPS);
        let deadline = clock.deadline(1.0);
        Self { table, layout, rule, skill, jumps, first, worlds, clock, deadline, max_contact_steps }
    }

    /// Returns the stroke as a player can play it here: see [`playable`]. Also `None` if the rules forbid it because it
    /// pushes a ball that touches the cue ball.
    pub fn playable(&self, cue: &CueInputs) -> Option<CueInputs> {
        if pushes_touching_ball(self.table, self.layout, cue) {
            return None;
        }
        playable(self.table, self.layout, cue)
    }

    /// Whether the search includes jumps and massés. On a table whose balls never leave the cloth, neither is realistic.
    pub const fn seeks_jumps(&self) -> bool {
        self.jumps && self.table.flight.is_some()
    }

    /// Whether the stroke may be recommended. If jumps and massés are forbidden, it must be neither; a cue raised
    /// beyond 30° must produce one of them.
    pub fn allows(&self, cue: &CueInputs) -> bool {
        if cue.theta > MAX_ELEVATION {
            self.seeks_jumps() && makes_jump_or_masse(self.table, self.layout, cue)
        } else {
            self.jumps || !is_jump_or_masse(self.table, self.layout, cue)
        }
    }

    /// Whether a stroke with this tally is a solution: it makes the point, begins as requested and may be recommended.
    pub fn is_solution(&self, cue: &CueInputs, tally: &Tally) -> bool {
        self.point().is_made(tally) && self.first.allows(tally) && self.allows(cue)
    }

    /// Returns the conditions of a point in this layout.
    pub fn point(&self) -> Point {
        Point::of(self.rule, self.table, self.layout)
    }

    /// Plays one stroke until the result is decided and returns its tally; `None` if time ran out before.
    pub fn play(&self, cue: &CueInputs) -> Option<Tally> {
        self.play_on(self.table, self.layout, cue)
    }

    fn play_on(&self, table: &Table, layout: &Layout, cue: &CueInputs) -> Option<Tally> {
        let impulse = strike(table, cue);
        let referee = Referee::new(Some(2), self.max_contact_steps).with_tally(self.tally(layout, &impulse));
        let mut observer = TimeLimited { referee, timed_out: false, task: self };
        watch_with::<AllSavings, _>(table, layout, &impulse, &mut observer);
        (!observer.timed_out).then_some(observer.referee.tally)
    }

    /// Returns the initial tally of a stroke if the balls really lie as in `layout`. Balls that touch in the task's own
    /// layout count as touching.
    #[inline]
    pub fn tally(&self, layout: &Layout, impulse: &Impulse) -> Tally {
        Tally { pushed: Touching::of(self.table, self.layout).pushed(layout, impulse), ..Tally::default() }
    }

    /// Returns the stroke that an attempt at `cue` results in, with the table and the layout on which it is played.
    #[inline]
    pub fn stroke<'w>(&'w self, cue: &CueInputs, draw: Draw<'w>) -> (CueInputs, &'w Table, &'w Layout) {
        match draw.world {
            None => (self.skill.stroke(self.table.radius, cue, draw.errors), self.table, self.layout),
            Some(World { table, layout }) => {
                let cue = re_aimed(self.table, self.layout, layout, cue);
                (self.skill.stroke(table.radius, &cue, draw.errors), table, layout)
            }
        }
    }

    /// Whether an attempt at `cue` makes the point; a tip beyond the table's miscue limit does not. `None` if time ran out.
    pub fn makes(&self, cue: &CueInputs, draw: Draw) -> Option<bool> {
        let (stroke, table, layout) = self.stroke(cue, draw);
        if stroke.is_miscue(table) {
            return Some(false);
        }
        self.play_on(table, layout, &stroke).map(|tally| self.point().is_made(&tally))
    }

    /// Plays attempts at `cue` one after the other until time runs out.
    pub fn attempts(&self, cue: &CueInputs, draws: &Draws) -> Attempts {
        let mut attempts = Attempts::default();
        for draw in draws.iter() {
            if self.clock.is_past(self.deadline) {
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

/// Results of attempts at a stroke.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Attempts {
    /// Number of attempts.
    pub tried: usize,
    /// Attempts that made the point.
    pub made: usize,
}

impl Attempts {
    /// Returns the share that made the point; `None` without attempts.
    pub fn rate(self) -> Option<SuccessRate> {
        (self.tried > 0).then(|| SuccessRate::new(self.made, self.tried))
    }
}

impl Sum for Attempts {
    fn sum<I: Iterator<Item = Self>>(parts: I) -> Self {
        parts.fold(Self::default(), |sum, part| Self { tried: sum.tried + part.tried, made: sum.made + part.made })
    }
}

/// A referee that aborts a shot when time is up.
struct TimeLimited<'a> {
    referee: Referee,
    timed_out: bool,
    task: &'a Task<'a>,
}

impl Observer for TimeLimited<'_> {
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
        if self.task.clock.is_past(self.task.deadline) {
            self.timed_out = true;
            return ControlFlow::Break(());
        }
        self.referee.contact_step()
    }
}
