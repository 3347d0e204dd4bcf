//! Simultaneous impacts with balls in the air: a ball that hits two balls, two noses, or a ball and a cushion at the same moment.
//!
//! Contacts that close faster than the slowest bounce in the air are solved together by the law of [`collide_together_in_space`]. Slower
//! ones follow one by one: by such bounces a ball slides off others, and [`BallImpact::resolve_over_cloth`] keeps them going.
//!
//! [`BallImpact::resolve_over_cloth`]: crate::physics::BallImpact::resolve_over_cloth

use std::ops::ControlFlow;

use glam::DVec2;

use super::{
    Constants, Observer, Rail,
    aloft::Nose,
    contacts::{PAIRS_OF, move_to_cushion},
    engine::Engine,
    guards::AIR_IMPACT_COST,
    impacts::{MAX_ROUNDS, kind},
    savings::Savings,
};
use crate::{
    physics::{Aloft, Contact, Motion, Partner, SpatialState, Touch, collide_together_in_space, take_linked},
    table::{BALLS, PAIRS},
};

impl<S: Savings, O: Observer + ?Sized> Engine<'_, S, O> {
    /// Whether a ball in the air that meets a nose at `place` may touch a second nose or another ball too.
    #[inline(always)]
    pub(super) fn nose_may_be_one_of_several(&self, ball: usize, place: DVec2, now: f64) -> bool {
        let Constants { reach, radius, .. } = self.constants;
        // A ball touches noses at other distances than on the cloth, but less than a radius away from there.
        (reach - place.abs()).max_element() <= radius
            || PAIRS_OF[ball].iter().any(|&(_, other)| self.may_touch(place, other, now))
    }

    /// Whether one of two balls that collide in the air may touch the third ball or a cushion too.
    #[inline(always)]
    pub(super) fn pair_may_be_one_of_several(&self, first: usize, second: usize, now: f64) -> bool {
        let Constants { reach, radius, .. } = self.constants;
        [first, second].into_iter().any(|ball| {
            let place = self.place(ball, now);
            (reach - place.abs()).min_element() <= radius || self.may_touch(place, BALLS - first - second, now)
        })
    }

    /// Whether a ball at `place` touches another one, seen from above: in the air, its height may still separate them.
    #[inline(always)]
    pub(super) fn may_touch(&self, place: DVec2, other: usize, now: f64) -> bool {
        let near = self.constants.diameter + self.constants.tolerance.touching;
        place.distance_squared(self.place(other, now)) <= near * near
    }

    /// Resolves all contacts together that close at this moment and are linked to the `predicted` one by shared balls, if there are others
    /// than this one and a ball of them is in the air. Returns whether they have collided.
    #[cold]
    pub(super) fn collide_together_aloft(&mut self, now: f64, predicted: &Contact) -> ControlFlow<(), bool> {
        let Some(cloth) = self.cloth else { return ControlFlow::Continue(false) };
        let flies = std::array::from_fn(|ball| self.balls[ball].segment.motion == Motion::Flying);
        let aloft = Aloft { flies, cloth, slowest: self.constants.tolerance.slowest_in_air };
        let mut states = self.states_in_space(now);
        let closing = self.closing_in_space(&states, &aloft);
        let linked = take_linked(&closing, predicted, &mut (0..closing.len()).collect());
        let group: Vec<Touch> = linked.into_iter().map(|index| closing[index]).collect();
        let involved: [bool; BALLS] =
            std::array::from_fn(|ball| group.iter().any(|touch| touch.contact.involves(ball)));
        let is_alone = group.iter().all(|touch| touch.contact == *predicted);
        if is_alone || !(0..BALLS).any(|ball| flies[ball] && involved[ball]) {
            return ControlFlow::Continue(false);
        }
        self.effort_in_air.add(AIR_IMPACT_COST * group.len() as u64);
        let c = self.constants;
        for Touch { contact, .. } in &group {
            if let Partner::Cushion(rail) = contact.partner
                && !flies[contact.first]
            {
                // Exactly at the cushion, as in a single impact.
                let mut place = states[contact.first].position.truncate();
                move_to_cushion(&c, rail.normal(), &mut place);
                if self.micro_collisions.is_some() {
                    place += c.tolerance.micro_gap * rail.normal();
                }
                states[contact.first].position = place.extend(0.0);
            }
        }
        let approaches: Vec<f64> = group.iter().map(|touch| -touch.opening_speed(&states)).collect();
        // As on the cloth, rounds without end are cut short.
        let law = if self.rounds > MAX_ROUNDS { self.law.with_restitution(0.0) } else { self.law.clone() };
        let impulses = collide_together_in_space(c.radius, &law, Some(&aloft), &mut states, &group);
        let freed = if self.resting.is_some() { self.release(now, involved) } else { None };
        let members = || (0..BALLS).filter(|&ball| involved[ball]);
        for ball in members() {
            self.end_segment(ball, now);
        }
        let mut bounces = [false; BALLS];
        for ((Touch { contact, .. }, impulse), approach) in group.iter().zip(&impulses).zip(approaches) {
            if impulse.normal <= 0.0 {
                continue;
            }
            let reported = self.is_reported(now, contact, approach);
            self.report_impact(now, kind(contact), reported)?;
            members().filter(|&ball| contact.involves(ball)).for_each(|ball| bounces[ball] |= !reported);
            if impulse.climb > c.least_climb {
                states[contact.first].velocity.z = impulse.climb;
            }
        }
        for ball in members() {
            self.launch_in_space(ball, now, &states[ball])?;
            if bounces[ball] && self.is_on_cloth(ball) {
                self.begin_contact(ball, now)?;
            }
        }
        self.predict_changed(now, self.with_freed(freed.is_some(), involved))?;
        ControlFlow::Continue(true)
    }

    /// Returns the states of all balls now; a ball that reaches the cloth at this moment has landed.
    fn states_in_space(&self, now: f64) -> [SpatialState; BALLS] {
        let held = self.resting.as_ref().map(|resting| resting.after(self.table, now - resting.start));
        std::array::from_fn(|ball| {
            let segment = &self.balls[ball].segment;
            match &held {
                Some(states) if self.resting_members()[ball] => states[ball].into(),
                _ if segment.motion == Motion::Flying => {
                    let mut state = segment.spatial_after(&self.constants, now - segment.start);
                    self.land_before_impact(now, &mut state);
                    state
                }
                _ => self.state(ball, now).into(),
            }
        })
    }

    /// Returns all touching contacts of balls on the table that close: at the height of the balls' centres on the cloth, with a ball in the
    /// air faster than the slowest bounce there. Pairs of balls come first, so that each reported impact of a group shares a ball with one
    /// before.
    fn closing_in_space(&self, states: &[SpatialState; BALLS], aloft: &Aloft) -> Vec<Touch> {
        let c = &self.constants;
        let is_here = |ball: usize| self.balls[ball].segment.motion != Motion::OffTable;
        let mut closing = Vec::new();
        let mut add = |gap: f64, touch: Touch| {
            let flies = (0..BALLS).any(|ball| aloft.flies[ball] && touch.contact.involves(ball));
            let least = if flies { aloft.slowest } else { c.tolerance.opening };
            if gap <= c.tolerance.touching && touch.opening_speed(states) < -least {
                closing.push(touch);
            }
        };
        for (first, second) in PAIRS.into_iter().filter(|&(first, second)| is_here(first) && is_here(second)) {
            let distance = states[first].position.distance(states[second].position);
            add(distance - c.diameter, Touch::of(Contact::of_balls(first, second), states));
        }
        for (ball, rail) in (0..BALLS).flat_map(|ball| Rail::ALL.map(|rail| (ball, rail))) {
            let (contact, place) = (Contact::with_cushion(ball, rail), states[ball].position);
            if aloft.flies[ball] {
                let to_nose = Nose::of(self.law.cushion(rail), c.radius).vector_from(c, rail, place);
                // Otherwise the ball has passed over the nose.
                if to_nose.truncate().dot(rail.normal()) < 0.0 {
                    add(to_nose.length() - c.radius, Touch { contact, normal: -to_nose.normalize() });
                }
            } else if is_here(ball) {
                add(rail.gap(c.reach, place.truncate()), Touch::of(contact, states));
            }
        }
        closing
    }
}

#[cfg(test)]
mod tests;
