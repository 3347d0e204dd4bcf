//! Moving a ball by hand: it slides until it touches a ball or a cushion.

use glam::DVec2;

use crate::table::{BALLS, Layout, LayoutError, TOUCHING_TOLERANCE, Table};

/// Step sizes of the arrow keys, mm; Shift multiplies them by ten, Ctrl divides them by ten.
pub const STEPS: [f64; 5] = [1.0, 5.0, 10.0, 50.0, 100.0];

/// Result of moving a ball.
#[derive(Debug, PartialEq)]
pub struct Slide {
    /// The layout after the move.
    pub layout: Layout,
    /// What the ball would have hit at its destination or on the way; `None` if it went all the way.
    pub stopped: Option<LayoutError>,
}

impl Slide {
    /// Where `ball` stopped before the end of its way, like "at the rail"; `names` are the names of the balls.
    pub fn stop_message(&self, ball: usize, names: [&str; BALLS]) -> Option<String> {
        Some(match self.stopped.as_ref()? {
            LayoutError::Overlap { first, second, .. } => format!("in contact with {}", names[first + second - ball]),
            _ => "at the rail".to_owned(),
        })
    }
}

/// Moves `ball` by `step`, m, as far as the table and the other balls allow.
pub fn slide(table: &Table, layout: &Layout, ball: usize, step: DVec2) -> Slide {
    let start = layout.balls[ball];
    let way = step.length();
    let Some(direction) = step.try_normalize() else { return Slide { layout: *layout, stopped: None } };
    let mut free = way;
    let mut stopped = None;
    let reach = table.reach();
    for (from, along, limit) in [(start.x, direction.x, reach.x), (start.y, direction.y, reach.y)] {
        let room = if along == 0.0 { f64::INFINITY } else { ((limit.copysign(along) - from) / along).max(0.0) };
        // Tolerance for the last bit of a computed limit.
        if room + TOUCHING_TOLERANCE < free {
            free = room;
            let wanted = start + step;
            let (max_x, max_y) = (reach.x, reach.y);
            stopped = Some(LayoutError::Outside { ball, x: wanted.x, y: wanted.y, max_x, max_y });
        }
    }
    let least = 2.0 * table.radius;
    for other in (0..BALLS).filter(|&other| other != ball) {
        let from_other = start - layout.balls[other];
        // The ball's path is |from_other + s direction|; it touches where that is two radii.
        let along = from_other.dot(direction);
        let discriminant = along * along - (from_other.length_squared() - least * least);
        if along >= 0.0 || discriminant <= 0.0 {
            continue;
        }
        let room = (-along - discriminant.sqrt()).max(0.0);
        if room + TOUCHING_TOLERANCE < free {
            free = room;
            let distance = (from_other + direction * (-along).min(way)).length();
            stopped = Some(LayoutError::Overlap { first: ball.min(other), second: ball.max(other), distance, least });
        }
    }
    let mut layout = *layout;
    let end = if stopped.is_none() { start + step } else { start + direction * free };
    layout.balls[ball] = end.clamp(-reach, reach);
    Slide { layout, stopped }
}

/// The displacement from `place`, m, by `count` quarters of a diamond along each axis. A ball between two quarters goes to the next one
/// first. Counts below one quarter are not rounded.
pub fn quarter_diamonds(table: &Table, place: DVec2, count: DVec2) -> DVec2 {
    // Tolerance for a ball that lies on a quarter.
    const ROUNDING: f64 = 1e-6;
    let quarter = 0.25 * table.diamond();
    let step = |from: f64, half: f64, count: f64| {
        let at = (from + half) / quarter;
        let to = match count {
            _ if count.abs() < 1.0 => at + count,
            _ if count > 0.0 => (at + ROUNDING).floor() + count,
            _ => (at - ROUNDING).ceil() + count,
        };
        if count == 0.0 { 0.0 } else { (to - at) * quarter }
    };
    DVec2::new(step(place.x, 0.5 * table.length, count.x), step(place.y, 0.5 * table.width, count.y))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::BALL_NAMES;
    use proptest::prelude::*;
    use rand::SeedableRng;
    use rand_xoshiro::Xoshiro256PlusPlus;

    #[test]
    fn a_ball_stops_in_contact_with_another_even_if_the_step_would_jump_over_it() {
        let table = Table::preset("textbook").unwrap();
        let moved = slide(&table, &Layout::opening(&table), 0, DVec2::new(0.0, 0.5));
        assert!(matches!(moved.stopped, Some(LayoutError::Overlap { first: 0, second: 1, .. })));
        let gap = moved.layout.balls[0].distance(moved.layout.balls[1]) - 2.0 * table.radius;
        assert!(gap.abs() < 1e-12, "{gap}");
        let again = slide(&table, &moved.layout, 0, DVec2::new(0.0, 0.001));
        assert!(again.stopped.is_some() && again.layout == moved.layout);
        assert_eq!(again.stop_message(0, BALL_NAMES).unwrap(), "in contact with yellow");
        let away = slide(&table, &moved.layout, 0, DVec2::new(0.0, -0.001));
        assert_eq!(away.stopped, None);
    }

    #[test]
    fn a_ball_stops_at_the_cushion_and_slides_along_it() {
        let table = Table::default();
        let moved = slide(&table, &Layout::opening(&table), 0, DVec2::new(-5.0, 0.0));
        assert_eq!(moved.stop_message(0, BALL_NAMES).unwrap(), "at the rail");
        assert!(moved.stopped.unwrap().to_string().contains("outside the table"));
        assert_eq!(moved.layout.balls[0].x, -table.half_length());
        assert_eq!(slide(&table, &moved.layout, 0, DVec2::new(0.0, -0.01)).stopped, None);
    }

    #[test]
    fn steps_go_to_successive_quarter_diamonds_from_any_position() {
        let table = Table::default();
        let place = Layout::parse("2.1d,2d 6d,2d 4d,3d", &table).unwrap().balls[0];
        let at = |count: [f64; 2]| table.to_diamonds(place + quarter_diamonds(&table, place, DVec2::from(count)));
        for (count, wanted) in [
            ([1.0, 0.0], [2.25, 2.0]),
            ([-1.0, 0.0], [2.0, 2.0]),
            ([10.0, 0.0], [4.5, 2.0]),
            ([0.0, -1.0], [2.1, 1.75]),
            ([0.1, 0.0], [2.125, 2.0]),
        ] {
            assert!(at(count).distance(DVec2::from(wanted)) < 1e-9, "{count:?}: {}", at(count));
        }
    }

    proptest! {
        #[test]
        fn any_series_of_moves_gives_a_valid_layout(
            seed in any::<u64>(),
            moves in prop::collection::vec((0..3_usize, -1.0..1.0_f64, -1.0..1.0_f64), 1..40),
        ) {
            let table = Table::default();
            let mut layout = Layout::random(&table, &mut Xoshiro256PlusPlus::seed_from_u64(seed));
            for (ball, x, y) in moves {
                layout = slide(&table, &layout, ball, DVec2::new(x, y)).layout;
                prop_assert_eq!(layout.validate(&table), Ok(()));
            }
        }
    }
}
