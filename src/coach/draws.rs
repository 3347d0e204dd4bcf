//! The attempts at which shots are compared and judged: the errors of a hand, each on a table that may be the real one.

use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{
    Doubt,
    errors::{self, Errors, Streams},
};
use crate::{
    physics::{CueInputs, squirt},
    table::{Layout, Table, TableDoubt, TableSampler},
};

/// Tells the numbers of worlds from those of errors.
const WORLDS: u64 = 0x776f_726c_6473;

/// What is really there: a table and where the balls lie, either not quite as the coach believes.
#[derive(Clone, Debug, PartialEq)]
pub struct World {
    /// The table.
    pub table: Table,
    /// Where the balls lie.
    pub layout: Layout,
}

/// One attempt.
#[derive(Clone, Copy, Debug)]
pub struct Draw<'a> {
    /// The hand's errors.
    pub errors: &'a Errors,
    /// What is really there; `None` where it is just what the coach believes.
    pub world: Option<&'a World>,
}

/// Many attempts.
#[derive(Clone, Debug)]
pub struct Draws {
    errors: Vec<Errors>,
    /// One an attempt, or none at all where nothing is in doubt.
    worlds: Vec<World>,
}

impl Draws {
    /// Independent attempts, for judging a shot.
    pub fn independent(count: usize, worlds: &Worlds, seed: u64) -> Self {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed ^ WORLDS);
        let real = |_| worlds.draw(|| errors::normal(&mut rng));
        let worlds = if worlds.is_certain() { Vec::new() } else { (0..count).map(real).collect() };
        Self { errors: errors::independent(count, seed), worlds }
    }

    /// Attempts that cover what may happen more evenly than chance, for comparing shots on the same attempts; the hand's
    /// errors are `wide` times as large.
    pub fn spread(count: usize, wide: f64, worlds: &Worlds, seed: u64) -> Self {
        let mut streams = Streams::new(seed ^ WORLDS);
        let real = |n| {
            let mut stream = 0..;
            worlds.draw(|| streams.number(stream.next().unwrap_or_default(), n))
        };
        let worlds = if worlds.is_certain() { Vec::new() } else { (0..count).map(real).collect() };
        let wider = |errors: Errors| errors.map(|error| wide * error);
        Self { errors: errors::spread(count, seed).into_iter().map(wider).collect(), worlds }
    }

    /// Those in this range, fewer where there are not so many.
    pub fn range(&self, from: usize, to: usize) -> impl Iterator<Item = Draw<'_>> + Clone {
        let to = to.min(self.errors.len());
        (from.min(to)..to).map(|index| Draw { errors: &self.errors[index], world: self.worlds.get(index) })
    }

    /// All of them.
    pub fn iter(&self) -> impl Iterator<Item = Draw<'_>> + Clone {
        self.range(0, self.len())
    }

    /// How many there are.
    pub const fn len(&self) -> usize {
        self.errors.len()
    }
}

/// Where worlds are drawn from: what the coach believes, and how much of it is in doubt.
#[derive(Debug)]
pub struct Worlds {
    table: Table,
    layout: Layout,
    sampler: Option<TableSampler>,
    placing: f64,
}

impl Worlds {
    /// Around `table` and `layout`.
    pub fn new(table: &Table, layout: &Layout, doubt: Doubt) -> Self {
        Self::known_as(&|| TableDoubt::of(table), table, layout, doubt)
    }

    /// The same on tables that lean no other way than this one, for choosing between shots: a table that leans costs
    /// twice the time, and as nobody knows which way it leans, which shot is the best hardly depends on it.
    pub fn level(table: &Table, layout: &Layout, doubt: Doubt) -> Self {
        let known = || TableDoubt::of(table).without(|name| name.starts_with("tilt"));
        Self::known_as(&known, table, layout, doubt)
    }

    fn known_as(known: &dyn Fn() -> TableDoubt, table: &Table, layout: &Layout, doubt: Doubt) -> Self {
        let sampler = if doubt.table > 0.0 { TableSampler::new(table, &known(), doubt.table) } else { None };
        Self { table: table.clone(), layout: *layout, sampler, placing: doubt.placing }
    }

    /// Whether the only world is the one that the coach believes in.
    pub fn is_certain(&self) -> bool {
        self.sampler.is_none() && self.placing == 0.0
    }

    /// One world, from standard normal numbers.
    pub fn draw(&self, mut normal: impl FnMut() -> f64) -> World {
        let layout = misplaced(&self.table, &self.layout, self.placing, &mut normal);
        let table = self.sampler.as_ref().map_or_else(|| self.table.clone(), |sampler| sampler.draw(normal));
        World { table, layout }
    }
}

/// A layout that may be meant by `layout` where every coordinate is off by a standard deviation of `placing` m. A ball that
/// would overlap another or a cushion is moved less far.
pub fn misplaced(table: &Table, layout: &Layout, placing: f64, mut normal: impl FnMut() -> f64) -> Layout {
    let mut moved = *layout;
    if placing == 0.0 {
        return moved;
    }
    for ball in 0..moved.balls.len() {
        let off = glam::DVec2::new(normal(), normal()) * placing;
        let start = moved.balls[ball];
        for share in [1.0, 0.5, 0.25, 0.0] {
            moved.balls[ball] = start + share * off;
            if share == 0.0 || moved.validate(table).is_ok() {
                break;
            }
        }
    }
    moved
}

/// The stroke that a player makes of `cue` who sees the balls where they really lie: turned so that its first ball is met
/// as full as it is meant, or the same point of a cushion is aimed at where the stroke meets no ball.
pub fn aimed(table: &Table, meant: &Layout, real: &Layout, cue: &CueInputs) -> CueInputs {
    let [start, real_start] = [meant.balls[0], real.balls[0]];
    let along = glam::DVec2::from_angle(cue.phi + squirt(table, cue.a));
    let ahead = |ball: &usize| {
        let apart = meant.balls[*ball] - start;
        let distance = apart.dot(along);
        (distance > 0.0 && along.perp_dot(apart).abs() < 2.0 * table.radius).then_some(distance)
    };
    let first = [1, 2].into_iter().filter_map(|ball| Some((ball, ahead(&ball)?))).min_by(|a, b| a.1.total_cmp(&b.1));
    let (target, real_target) = if let Some((ball, _)) = first {
        (meant.balls[ball], real.balls[ball])
    } else {
        let reach = table.reach();
        let until = |place: f64, speed: f64, most: f64| {
            if speed == 0.0 { f64::MAX } else { (most.copysign(speed) - place) / speed }
        };
        let point = start + along * until(start.x, along.x, reach.x).min(until(start.y, along.y, reach.y));
        (point, point)
    };
    let [was, is] = [target - start, real_target - real_start];
    // A ball that lies at the very point that is aimed at has no direction to it.
    if was.length_squared() < 1e-12 || is.length_squared() < 1e-12 {
        return *cue;
    }
    CueInputs { phi: cue.phi + was.angle_to(is), ..*cue }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    fn layout() -> Layout {
        Layout::new([DVec2::new(-0.8, 0.1), DVec2::new(0.4, 0.3), DVec2::new(0.9, -0.5)])
    }

    #[test]
    fn nothing_in_doubt_draws_nothing_and_doubts_draw_valid_worlds() {
        let table = Table::default();
        let none = Draws::independent(50, &Worlds::new(&table, &layout(), Doubt::NONE), 7);
        assert!(none.iter().all(|draw| draw.world.is_none()) && none.len() == 50);
        let close = Layout::new([
            DVec2::new(0.0, 0.0),
            DVec2::new(2.0 * table.radius, 0.0),
            DVec2::new(0.0, table.half_width()),
        ]);
        for layout in [layout(), close] {
            let worlds = Worlds::new(&table, &layout, Doubt::FULL);
            let draws = Draws::independent(50, &worlds, 7);
            let mut tables = Vec::new();
            for draw in draws.iter() {
                let world = draw.world.unwrap();
                world.layout.validate(&table).unwrap();
                tables.push(world.table.rail_restitution);
            }
            tables.dedup();
            assert_eq!(tables.len(), 50);
            let again = Draws::independent(50, &worlds, 7);
            assert!(draws.iter().zip(again.iter()).all(|(one, other)| one.world == other.world), "the same seed");
        }
    }

    #[test]
    fn a_player_aims_at_the_ball_where_it_lies_and_at_the_point_of_the_cushion_where_it_is() {
        let (table, meant) = (Table::default(), layout());
        let mut real = meant;
        real.balls[0] += DVec2::new(0.003, -0.004);
        real.balls[1] += DVec2::new(-0.002, 0.005);
        let towards = |layout: &Layout, ball: usize| (layout.balls[ball] - layout.balls[0]).to_angle();
        let cue = |phi| CueInputs { a: 0.2, b: 0.1, theta: 0.0, phi: phi - squirt(&table, 0.2), speed: 2.0 };
        let half = cue(towards(&meant, 1) + 0.03);
        let turned = aimed(&table, &meant, &real, &half);
        assert!((turned.phi - half.phi - (towards(&real, 1) - towards(&meant, 1))).abs() < 1e-12);
        // Straight up: from another place the same point needs another direction.
        let up = cue(std::f64::consts::FRAC_PI_2);
        let turned = aimed(&table, &meant, &real, &up);
        let point = DVec2::new(-0.8, table.half_width());
        assert!((turned.phi - up.phi - (point - meant.balls[0]).angle_to(point - real.balls[0])).abs() < 1e-12);
        assert_eq!(aimed(&table, &meant, &meant, &up), up);
    }
}
