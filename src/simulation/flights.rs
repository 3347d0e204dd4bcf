//! Flight in the engine: how balls leave the cloth, collide in the air, and return to the cloth.

use std::ops::ControlFlow;

use super::{
    EventKind, Observer, Segment,
    aloft::Nose,
    contacts::PAIRS_OF,
    engine::{Ball, ContactMode, Engine, PairPrediction, only_ball},
    guards::AIR_IMPACT_COST,
    hops::Hops,
    savings::Savings,
    segment::Course,
};
use crate::{
    physics::{BallState, Contact, Motion, SpatialState},
    table::{BALLS, PAIRS},
};

/// Uncertainty of an event time in units of its rounding: from its sum with the start of a trajectory, and from the landing time itself. If
/// it is too small, a ball that lands just before an impact, and whose reported trajectory has already landed, lands twice. If it is too
/// large, a ball lands before an impact that comes first.
const MOMENT: f64 = 4.0;

impl<S: Savings, O: Observer + ?Sized> Engine<'_, S, O> {
    /// Whether a ball can touch balls on the cloth or the cushions at its edge.
    #[inline(always)]
    pub(super) fn is_on_cloth(&self, index: usize) -> bool {
        !matches!(self.balls[index].segment.motion, Motion::Flying | Motion::OffTable)
    }

    pub(super) fn on_cloth(&self) -> [bool; BALLS] {
        std::array::from_fn(|index| self.is_on_cloth(index))
    }

    /// Starts the trajectory of a ball through the air, or along the cloth if the ball does not rise from it.
    #[cold]
    pub(super) fn launch_in_space(&mut self, index: usize, now: f64, state: &SpatialState) -> ControlFlow<()> {
        let low = state.position.z <= 0.0;
        let was_low = self.is_on_cloth(index);
        let given_up = self.is_exhausted() && !self.is_above_another(index, now, state);
        let cloth = match self.cloth.filter(|_| !given_up) {
            Some(cloth) if !low || state.velocity.z > self.constants.tolerance.slowest_in_air => cloth,
            _ => {
                self.launch(index, now, &state.horizontal_state());
                return if was_low { ControlFlow::Continue(()) } else { self.report_landing(index, now) };
            }
        };
        let hops = Hops::new(&self.constants, &cloth, state);
        let segment = Segment {
            start: now,
            velocity: state.velocity.truncate(),
            spin: state.spin,
            motion: Motion::Flying,
            course: Some(Box::new(Course::Hops(hops))),
            ..Segment::at_rest(state.position.truncate())
        };
        self.set(index, segment, hops.duration);
        if self.balls[index].mode != ContactMode::Free {
            // Another bounce at this moment may throw the ball down again.
            self.balls[index].mode = ContactMode::Bouncing;
            return ControlFlow::Continue(());
        }
        if was_low { self.report(now, EventKind::Jumps(index)) } else { ControlFlow::Continue(()) }
    }

    /// Reports that a ball stays on the cloth, and its motion there unless it slides. Reports nothing if its departure was not reported.
    fn report_landing(&mut self, index: usize, now: f64) -> ControlFlow<()> {
        if self.balls[index].mode != ContactMode::Free {
            return ControlFlow::Continue(());
        }
        self.report(now, EventKind::Lands(index))?;
        self.report_motion(index, now)
    }

    /// Whether a ball in the air would overlap another one if it were put on the cloth at its position.
    fn is_above_another(&self, index: usize, now: f64, state: &SpatialState) -> bool {
        let place = state.position.truncate();
        let overlaps = |other: usize| self.state(other, now).position.distance(place) < self.constants.diameter;
        state.position.z > 0.0 && PAIRS_OF[index].iter().any(|&(_, other)| overlaps(other))
    }

    /// Handles the end of a ball's hops at `time`, which becomes the time of the last event if the ball then moves alone.
    #[cold]
    pub(super) fn stay_on_cloth(&mut self, index: usize, time: &mut f64) -> ControlFlow<()> {
        let now = *time;
        let Some(end) = self.balls[index].segment.hops().map(Hops::end) else { return ControlFlow::Continue(()) };
        self.end_segment(index, now);
        self.launch(index, now, &end);
        self.report_landing(index, now)?;
        self.predict_ball(now, index)?;
        if S::LONE_BALL && S::KEPT_PREDICTIONS && self.is_only_moving_ball(index) {
            return self.play_lone_ball(index, time);
        }
        ControlFlow::Continue(())
    }

    /// Handles a ball that a cushion has lifted.
    #[cold]
    pub(super) fn climb_cushion(
        &mut self,
        index: usize,
        now: f64,
        state: BallState,
        climb: f64,
        freed: bool,
    ) -> ControlFlow<()> {
        self.end_segment(index, now);
        let rail = self.balls[index].rail;
        self.report(now, EventKind::BallRail(index, rail))?;
        self.lift(index, now, state, climb)?;
        self.predict_changed(now, self.with_freed(freed, only_ball(index)))
    }

    /// Starts a flight with the upward velocity `climb`, m/s.
    pub(super) fn lift(&mut self, index: usize, now: f64, state: BallState, climb: f64) -> ControlFlow<()> {
        let mut lifted = SpatialState::from(state);
        lifted.velocity.z = climb;
        self.launch_in_space(index, now, &lifted)
    }

    /// Handles a ball in the air that hits the nose of a cushion or lands behind it.
    #[cold]
    pub(super) fn rebound_in_space(&mut self, index: usize, now: f64) -> ControlFlow<()> {
        self.effort_in_air.add(AIR_IMPACT_COST);
        self.count_round(now);
        let Ball { rail_after, rail, .. } = self.balls[index];
        let c = self.constants;
        let mut state = self.balls[index].segment.spatial_after(&c, rail_after);
        self.land_before_impact(now, &mut state);
        let cushion = *self.law.cushion(rail);
        let to_nose = Nose::of(&cushion, c.radius).vector_from(&c, rail, state.position);
        if to_nose.truncate().dot(rail.normal()) >= 0.0 {
            self.end_segment(index, now);
            let segment =
                Segment { start: now, motion: Motion::OffTable, ..Segment::at_rest(state.horizontal_state().position) };
            self.set(index, segment, f64::INFINITY);
            self.report(now, EventKind::LeavesTable(index))?;
            return self.predict_ball(now, index);
        }
        let contact = Contact::with_cushion(index, rail);
        if self.nose_may_be_one_of_several(index, state.position.truncate(), now)
            && self.collide_together_aloft(now, &contact)?
        {
            return ControlFlow::Continue(());
        }
        self.end_segment(index, now);
        let slowest = c.tolerance.slowest_in_air;
        let approach = cushion.resolve_in_space(c.radius, slowest, to_nose.normalize(), &mut state);
        self.resolve_cloth_impact(&mut state);
        let reported = self.is_reported(now, &contact, approach);
        self.report_impact(now, EventKind::BallRail(index, rail), reported)?;
        self.launch_in_space(index, now, &state)?;
        self.predict_ball(now, index)
    }

    /// Handles a collision of two balls, at least one of which is in the air.
    #[cold]
    pub(super) fn collide_in_space(&mut self, pair: usize, now: f64) -> ControlFlow<()> {
        let (first, second) = PAIRS[pair];
        let contact = Contact::of_balls(first, second);
        if self.pair_may_be_one_of_several(first, second, now) && self.collide_together_aloft(now, &contact)? {
            return ControlFlow::Continue(());
        }
        self.effort_in_air.add(AIR_IMPACT_COST);
        let PairPrediction { since, after, .. } = self.pairs[pair];
        let changed = std::array::from_fn(|ball| ball == first || ball == second);
        let freed = if self.resting.is_some() { self.release(now, changed) } else { None };
        let c = self.constants;
        let [mut one, mut other] = [first, second].map(|index| match &freed {
            Some(states) if self.resting_members()[index] => SpatialState::from(states[index]),
            _ => {
                let segment = &self.balls[index].segment;
                segment.spatial_after(&c, (since - segment.start) + after)
            }
        });
        self.land_before_impact(now, &mut one);
        self.land_before_impact(now, &mut other);
        let slowest = c.tolerance.slowest_in_air;
        // If a ball is in the air, there is a cloth that it has left.
        let Some(cloth) = self.cloth else { return ControlFlow::Continue(()) };
        let approach = self.law.balls.resolve_over_cloth(c.radius, slowest, &cloth, &mut one, &mut other);
        for index in [first, second] {
            self.end_segment(index, now);
        }
        let reported = self.is_reported(now, &contact, approach);
        self.report_impact(now, EventKind::BallBall(first, second), reported)?;
        for (index, state) in [(first, &one), (second, &other)] {
            self.launch_in_space(index, now, state)?;
            if !reported && self.is_on_cloth(index) {
                self.begin_contact(index, now)?;
            }
        }
        self.predict_changed(now, self.with_freed(freed.is_some(), changed))
    }

    /// Whether an impact in the air is reported. It is not if it is one of many by which a ball slides off another one or off a nose.
    pub(super) fn is_reported(&mut self, now: f64, contact: &Contact, approach: f64) -> bool {
        approach > self.constants.tolerance.slow_bounce || !self.chatters.bounce(contact, now)
    }

    /// Makes a ball that reaches the cloth at the moment of an impact land before it: otherwise rounding would decide whether its state is
    /// from before or after the landing. If the ball would rise too slowly to fly, it stays on the cloth.
    pub(super) fn land_before_impact(&self, now: f64, state: &mut SpatialState) {
        let falls = -state.velocity.z;
        let rounding = if falls > 0.0 { f64::EPSILON * (self.constants.radius + MOMENT * now * falls) } else { 0.0 };
        if state.position.z <= rounding {
            state.position.z = 0.0;
            self.resolve_cloth_impact(state);
            if state.velocity.z <= self.constants.tolerance.slowest_in_air {
                state.velocity.z = 0.0;
            }
        }
    }

    /// Applies the response of the cloth to a ball on it that was struck downwards.
    fn resolve_cloth_impact(&self, state: &mut SpatialState) {
        if let Some(cloth) = self.cloth.filter(|_| state.position.z <= 0.0) {
            cloth.resolve(self.constants.radius, state);
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::{DVec2, DVec3};

    use super::*;
    use crate::{
        simulation::{AllSavings, Constants, End, Event, guards::AIR_BUDGET},
        table::{Flight, Layout, Table},
    };

    /// Kinds of all events and bounces.
    #[derive(Default)]
    struct Events(Vec<EventKind>);

    impl Observer for Events {
        fn event(&mut self, event: Event) -> ControlFlow<()> {
            self.0.push(event.kind);
            ControlFlow::Continue(())
        }

        fn bounce(&mut self, bounce: Event) {
            self.0.push(bounce.kind);
        }
    }

    /// Returns the events of a ball 5 cm above the cloth at `place` if the shot has exhausted its budget.
    fn given_up_at(place: DVec2) -> Vec<EventKind> {
        let table = Table { flight: Some(Flight::default()), ..Table::default() };
        let layout = Layout::new([DVec2::ZERO, DVec2::new(0.5, 0.1), DVec2::new(-0.5, 0.1)]);
        let mut reported = Events::default();
        let mut engine = Engine::<AllSavings, Events>::new(&table, &layout, &mut reported);
        let velocity = DVec3::new(0.3, 0.0, -0.2);
        let state = SpatialState { position: place.extend(0.05), velocity, spin: DVec3::ZERO };
        assert!(engine.launch_in_space(0, 0.0, &state).is_continue());
        engine.effort_in_air.add(AIR_BUDGET + 1);
        assert!(engine.launch_in_space(0, 0.0, &state).is_continue());
        reported.0
    }

    /// Releases a ball that leans on another's top, at `angle` from the vertical, rad, with a velocity, m/s. Returns the number of events
    /// and the end.
    fn let_go(table: &Table, angle: f64, velocity: impl Fn(DVec3) -> DVec3) -> (usize, End) {
        let other = DVec2::new(0.3, 0.2);
        let layout = Layout::new([DVec2::ZERO, other, DVec2::new(-0.5, 0.1)]);
        let mut reported = Events::default();
        let mut engine = Engine::<AllSavings, Events>::new(table, &layout, &mut reported);
        let n = DVec3::new(angle.sin(), 0.0, angle.cos());
        let position = other.extend(0.0) + 2.0 * table.radius * n;
        let flow = engine.launch_in_space(0, 0.0, &SpatialState { position, velocity: velocity(n), spin: DVec3::ZERO });
        assert!(flow.is_continue() && engine.predict_ball(0.0, 0).is_continue());
        let time = engine.run_events(flow);
        let end = engine.finish(time);
        (reported.0.len(), end)
    }

    /// If the cloth absorbed the speed that a soft blow gives the lower ball, and the upper ball's rising speed were taken from its
    /// tangential motion, it would stay there, in ever shorter bounces without end.
    #[test]
    fn ball_slides_off_another_after_any_soft_landing() {
        for (preset, restitution) in
            [("match", 0.5), ("textbook", 0.5), ("thesis", 0.5), ("match", 0.0), ("match", 0.99)]
        {
            let table =
                Table { flight: Some(Flight { restitution, friction: None }), ..Table::preset(preset).unwrap() };
            let slowest = Constants::of(&table).tolerance.slowest_in_air;
            for (angle, most) in [(1e-6, 6000), (1e-3, 4000), (0.03, 2000), (0.3, 1000), (0.8, 700)] {
                for (down, across) in [(slowest, 0.0), (0.6 * slowest, 1e-4), (3.0 * slowest, -1e-3), (0.0, 0.02)] {
                    let (count, end) = let_go(&table, angle, |n| across * DVec3::Y - down * n);
                    let what =
                        format!("{preset}, e_c = {restitution}, {angle} rad, {across}, {down} m/s: {count}, {end:?}");
                    assert!(count < most && end.time < 60.0, "{what}");
                    let [one, other, _] = end.balls.map(|ball| ball.position);
                    assert!(one.distance(other) > 2.0 * table.radius - 1e-9, "{what}");
                    assert!(end.balls.iter().all(|ball| ball.velocity == DVec2::ZERO), "{what}");
                }
            }
        }
    }

    /// Without any motion there is no energy for rising: the bounces fade until the resolution of time is reached.
    #[test]
    fn ball_placed_on_top_of_another_ends_the_shot() {
        let (count, end) = let_go(&Table::default(), 1e-9, |_| DVec3::ZERO);
        let [upper, lower, _] = end.balls;
        assert!(count < 100_000 && end.time < 1.0, "{count} {end:?}");
        assert!(upper.position.distance(lower.position) < 1e-10, "{end:?}");
        assert!(upper.velocity.length() < 1e-12 && lower.velocity.length() < 1e-12, "{end:?}");
    }

    #[test]
    fn aborted_shot_lowers_flying_balls_except_onto_others() {
        let jumps = EventKind::Jumps(0);
        let let_down = [jumps, EventKind::Lands(0), EventKind::RollingStationary(0)];
        assert_eq!(given_up_at(DVec2::new(0.2, 0.0)), let_down);
        assert_eq!(given_up_at(DVec2::new(0.49, 0.11)), [jumps]);
    }
}
