//! Flights for reports to the player: height and length of each, and how balls left the table.

use glam::DVec2;

use super::{CushionContacts, End, Event, EventKind, Rail, Recording, cushions::rail_of};
use crate::table::{BALLS, Layout, Table};

/// Height from which a hop is reported, m. Every stroke over a rail and every rail impact causes lower hops, which are invisible.
pub const REPORTED_HEIGHT: f64 = 0.002;

/// A ball's flight, from leaving the cloth until it stays on it or leaves the table, including hops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jump {
    /// The ball.
    pub ball: usize,
    /// Time at which it leaves the cloth, s.
    pub start: f64,
    /// Time at which it stays on the cloth or leaves the table, or at which the shot ends, s.
    pub end: f64,
    /// Greatest height above its position on the cloth, m.
    pub height: f64,
    /// Distance from leaving the cloth to the first landing or collision, m.
    pub distance: f64,
}

impl Jump {
    /// Whether the flight is high enough to be reported.
    pub fn is_reported(&self) -> bool {
        self.height >= REPORTED_HEIGHT
    }

    /// Whether the ball is in the air at `time`.
    pub fn is_airborne_at(&self, time: f64) -> bool {
        (self.start..=self.end).contains(&time)
    }
}

/// How a ball left the table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OffTable {
    /// The rail over which it left.
    pub over: Rail,
    /// Its position after it has been spotted, m.
    pub spot: DVec2,
}

impl OffTable {
    /// Returns how each ball in `off_table` left the table: `places` are the final positions of the balls, m, and `layout` has those balls
    /// on their spots.
    fn all(reach: DVec2, places: [DVec2; BALLS], off_table: [bool; BALLS], layout: &Layout) -> [Option<Self>; BALLS] {
        std::array::from_fn(|ball| {
            let place = places[ball];
            let beyond = place.abs() - reach;
            let over = rail_of(place.x > 0.0, place.y > 0.0, beyond.x <= beyond.y);
            off_table[ball].then_some(Self { over, spot: layout.balls[ball] })
        })
    }
}

impl End {
    /// Returns how balls left the table.
    pub fn left_table(&self, table: &Table) -> [Option<OffTable>; BALLS] {
        OffTable::all(table.reach(), self.balls.map(|ball| ball.position), self.off_table, &self.layout(table))
    }
}

impl Recording {
    /// Returns how balls left the table.
    pub fn left_table(&self, table: &Table) -> [Option<OffTable>; BALLS] {
        OffTable::all(table.reach(), self.positions(self.duration()), self.off_table(), &self.final_layout())
    }

    /// Returns all flights in order of time, including the lowest hops.
    pub fn jumps(&self) -> Vec<Jump> {
        let starts = self.events().iter().enumerate().filter_map(|(n, event)| match event.kind {
            EventKind::Jumps(ball) => Some((n, event.time, ball)),
            _ => None,
        });
        starts.map(|(n, start, ball)| self.jump(ball, start, &self.events()[n..])).collect()
    }

    /// Returns the flight that starts at `start`, given the events from then on.
    fn jump(&self, ball: usize, start: f64, events: &[Event]) -> Jump {
        let is_end = |event: &&Event| [EventKind::Lands(ball), EventKind::LeavesTable(ball)].contains(&event.kind);
        let end = events.iter().find(is_end).map_or(self.duration(), |event| event.time);
        let pieces = self.segments(ball);
        let (mut height, mut distance) = (0.0_f64, None);
        let inside = (0..pieces.len()).filter(|&n| pieces[n].start >= start && pieces[n].start < end);
        for n in inside {
            let Some(hops) = pieces[n].hops() else { continue };
            let duration = pieces.get(n + 1).map_or(end, |next| next.start) - pieces[n].start;
            let first = hops.arc(0);
            // A later arc is not higher than the height from which it falls.
            let top = (first.velocity.z / hops.cloth.gravity).clamp(0.0, duration);
            height = height.max(hops.state_after(top).position.z);
            distance.get_or_insert_with(|| first.velocity.truncate().length() * first.end.min(duration));
        }
        Jump { ball, start, end, height, distance: distance.unwrap_or_default() }
    }

    /// Returns the flight that starts with an event; `None` for other events.
    pub fn jump_started_by(&self, event: &Event) -> Option<Jump> {
        matches!(event.kind, EventKind::Jumps(_)).then(|| self.jump_of(event))?
    }

    /// Returns the flight that starts or ends with an event; `None` for other events.
    fn jump_of(&self, event: &Event) -> Option<Jump> {
        let (EventKind::Jumps(ball) | EventKind::Lands(ball)) = event.kind else { return None };
        let begun = |other: &Event| other.kind == EventKind::Jumps(ball) && other.time <= event.time;
        let from = self.events().iter().rposition(begun)?;
        Some(self.jump(ball, self.events()[from].time, &self.events()[from..]))
    }

    /// Returns `all` events, or those that are listed by default: contacts and flights that are large enough to be seen, and balls that leave
    /// the table.
    pub fn listed_events(&self, all: bool) -> impl Iterator<Item = &Event> {
        let mut cushion_contacts = [CushionContacts::default(); BALLS];
        self.events().iter().filter(move |event| {
            let contacts = cushion_contacts.iter_mut().enumerate();
            let is_new_cushion = contacts.fold(false, |new, (ball, own)| own.follow(ball, event).is_some() || new);
            all || match event.kind {
                EventKind::LeavesTable(_) => true,
                EventKind::Jumps(_) | EventKind::Lands(_) => self.jump_of(event).is_some_and(|jump| jump.is_reported()),
                EventKind::BallRail(..) => is_new_cushion,
                kind => kind.is_contact(),
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{physics::CueInputs, table::Flight};

    fn flying() -> Table {
        Table { flight: Some(Flight::default()), ..Table::preset("match").unwrap() }
    }

    fn play(layout: &str, cue: &str) -> Recording {
        let table = flying();
        let layout = Layout::parse(layout, &table).unwrap();
        Recording::new(&table, &layout, &CueInputs::parse(cue).unwrap()).unwrap()
    }

    #[test]
    fn jump_height_and_distance_match_the_trajectory() {
        let shot = play("-0.5,0 0.3,0.4 0.9,0.5", "0,0,45,0,5");
        let jump = shot.jumps()[0];
        let seen = (0..=1000).map(|n| shot.height(0, jump.start + (jump.end - jump.start) * f64::from(n) / 1000.0));
        let highest = seen.fold(0.0, f64::max);
        assert!(jump.is_reported() && (jump.height - highest).abs() < 1e-4 * highest, "{jump:?} {highest}");
        let down = shot.segments(0)[0].hops().unwrap().arc(0).end;
        assert!(shot.height(0, down) < 1e-9 && shot.height(0, 0.9 * down) > 0.01);
        let way = shot.state(0, down).position.distance(shot.state(0, 0.0).position);
        assert!((jump.distance - way).abs() < 1e-9 && way > 0.1, "{jump:?} {way}");
    }

    #[test]
    fn low_hops_are_not_reported_but_jumps_and_landings_are() {
        let low = play("-1,0 0.9,-0.5 0.9,0.5", "0,0,3,0,2");
        assert!(low.events().iter().any(|event| event.kind == EventKind::Jumps(0)));
        assert!(low.listed_events(false).all(|event| event.kind.is_contact()));
        let high = play("-0.5,0 0.3,0.4 0.9,0.5", "0,0,45,0,3");
        let reported: Vec<_> = high.listed_events(false).map(|event| event.kind).collect();
        assert_eq!(reported[0], EventKind::Jumps(0));
        assert!(reported.contains(&EventKind::Lands(0)), "{reported:?}");
    }

    #[test]
    fn ball_off_the_table_reports_its_rail_and_spot() {
        let table = flying();
        for (layout, cue, over) in [
            ("0.9,0 0,0.3 0,-0.3", "0,0,30,0,9", Rail::Right),
            ("-0.9,0 0,0.3 0.1,-0.3", "0,0,30,180,9", Rail::Left),
            ("0,0.2 0.6,-0.3 0.9,-0.3", "0,0,30,90,9", Rail::Top),
            ("0,-0.2 0.6,0.3 0.9,0.3", "0,0,30,270,9", Rail::Bottom),
        ] {
            let shot = play(layout, cue);
            assert!(shot.events().iter().any(|event| event.kind == EventKind::LeavesTable(0)), "{:?}", shot.events());
            let [white, yellow, red] = shot.left_table(&table);
            let white = white.unwrap();
            assert_eq!((white.over, yellow, red), (over, None, None));
            assert_eq!(white.spot, shot.final_layout().balls[0]);
            assert!(shot.final_layout().validate(&table).is_ok());
        }
    }
}
