//! Where the simulation's balls are at the moments of a film, and the rails that they meet.

use std::ops::ControlFlow;

use glam::{DVec2, DVec3};

use crate::{
    physics::Impulse,
    simulation::{Event, EventKind, Observer, Rail, Segment, watch},
    table::{Layout, Table},
};

/// A layout whose object balls are out of the way.
pub fn alone(place: DVec2) -> Layout {
    Layout::new([place, DVec2::new(1e3, 1e3), DVec2::new(-1e3, 1e3)])
}

/// Angular velocity about horizontal axes of a ball that moves with `velocity` and slips with `slip`, rad/s.
pub fn spin_of_slip(radius: f64, velocity: DVec2, slip: DVec2) -> DVec2 {
    DVec2::new((slip.y - velocity.y) / radius, (velocity.x - slip.x) / radius)
}

/// The motion of a ball at one moment: what a filmed course is fitted with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// Centre, m.
    pub place: DVec2,
    /// Velocity, m/s.
    pub velocity: DVec2,
    /// Slip on the cloth, m/s.
    pub slip: DVec2,
    /// Speed of the side spin at the equator, `R w_z`, m/s.
    pub side: f64,
}

impl Motion {
    /// As seven numbers, in the order of the fields.
    pub fn numbers(&self) -> [f64; 7] {
        let Self { place, velocity, slip, side } = *self;
        [place.x, place.y, velocity.x, velocity.y, slip.x, slip.y, side]
    }

    /// From seven numbers.
    pub fn of([x, y, vx, vy, ux, uy, side]: [f64; 7]) -> Self {
        Self { place: DVec2::new(x, y), velocity: DVec2::new(vx, vy), slip: DVec2::new(ux, uy), side }
    }

    /// What a stroke would have to give a ball for this motion.
    pub fn impulse(&self, radius: f64) -> Impulse {
        let spin: DVec3 = spin_of_slip(radius, self.velocity, self.slip).extend(self.side / radius);
        Impulse::on_cloth(self.velocity, spin)
    }
}

/// Follows the cue ball: its places at some times, and the rails that it meets.
pub struct Follower<'a> {
    times: &'a [f64],
    end: DVec2,
    /// The place at each of the times that have passed, m.
    pub places: Vec<DVec2>,
    /// Time, rail and the ball's centre there.
    pub hits: Vec<(f64, Rail, DVec2)>,
    most_hits: usize,
}

impl<'a> Follower<'a> {
    /// Follows until all `times`, ascending, have passed and `most_hits` rails have been met.
    pub fn new(times: &'a [f64], most_hits: usize) -> Self {
        Self { times, end: DVec2::ZERO, places: Vec::with_capacity(times.len()), hits: Vec::new(), most_hits }
    }

    /// Plays a shot; a ball that lies still before the last time stays where it is.
    #[must_use]
    pub fn of(mut self, table: &Table, layout: &Layout, impulse: &Impulse) -> Self {
        self.end = layout.balls[0];
        watch(table, layout, impulse, &mut self);
        self.places.resize(self.times.len(), self.end);
        self
    }
}

impl Observer for Follower<'_> {
    fn wants_segments(&self) -> bool {
        true
    }

    fn event(&mut self, event: Event) -> ControlFlow<()> {
        if let EventKind::BallRail(0, rail) = event.kind {
            self.hits.push((event.time, rail, self.end));
        }
        if self.places.len() >= self.times.len() && self.hits.len() >= self.most_hits {
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    }

    fn segment(&mut self, ball: usize, segment: &Segment, end: f64) {
        if ball != 0 {
            return;
        }
        while let Some(&time) = self.times.get(self.places.len()).filter(|&&time| time < end) {
            self.places.push(segment.position_after(time - segment.start));
        }
        self.end = segment.position_after(end - segment.start);
    }
}
