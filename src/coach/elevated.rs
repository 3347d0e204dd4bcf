//! Elevated-cue shots: jumps over a ball that is in the way, and massés. Most clubs forbid both.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::DVec2;
use rand::RngExt;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{
    Technique,
    candidates::{MAX_ELEVATION, MAX_SPEED, TIP_SHARE, random_tip},
};
use crate::{
    physics::{CueInputs, slip, strike},
    table::{Layout, Table},
};

/// Steepest cue that the search tries, rad: 80°.
pub const MAX_ELEVATED_ANGLE: f64 = 80.0_f64.to_radians();

/// Ranges of elevation and speed of the jumps that are tried, rad and m/s: a flatter or softer stroke clears no ball.
const JUMP_ELEVATIONS: [f64; 2] = [12.0_f64.to_radians(), 60.0_f64.to_radians()];
const JUMP_SPEEDS: [f64; 2] = [2.0, MAX_SPEED];

/// Range of massé speeds, m/s, and maximum distance of the target, m.
const MASSE_SPEEDS: [f64; 2] = [0.8, 5.0];
const MAX_MASSE_DISTANCE: f64 = 1.2;

/// Minimum clearance of a jump over the edge of a ball, m.
const MIN_CLEARANCE: f64 = 0.002;

/// Number of moments at which a massé's curve is sampled.
const CURVE_SAMPLES: u32 = 24;

/// Elevation up to which no stroke bends a ball's path as a massé does, rad, and the upward speed, m/s, below which no
/// ball clears another or its edge: it rises by 10 mm.
const MAX_FLAT_ELEVATION: f64 = 10.0_f64.to_radians();
const MIN_LIFT: f64 = 0.44;

/// Whether a club that forbids jumps and massés forbids this stroke: the cue ball flies over a ball, its path bends as
/// a massé's does, or the cue is raised by more than 30°.
pub fn is_jump_or_masse(table: &Table, layout: &Layout, cue: &CueInputs) -> bool {
    if cue.theta > MAX_ELEVATION {
        return true;
    }
    if cue.theta <= MAX_FLAT_ELEVATION && strike(table, cue).lift < MIN_LIFT {
        return false;
    }
    makes_jump_or_masse(table, layout, cue)
}

/// Whether the cue ball flies over a ball, or its path bends as a massé's does; false for a stroke that cannot be played.
pub fn makes_jump_or_masse(table: &Table, layout: &Layout, cue: &CueInputs) -> bool {
    Technique::of(table, layout, cue).is_ok_and(|technique| technique.is_jump_or_masse())
}

/// Draws a jump over a ball that is in the way, or a massé; `None` if the drawn direction or tip position does not allow one.
pub fn random_elevated_stroke(table: &Table, layout: &Layout, rng: &mut Xoshiro256PlusPlus) -> Option<CueInputs> {
    let cue = if rng.random() { jump(table, layout, rng) } else { masse(table, layout, rng) };
    cue.filter(|cue| cue.validate_tip(table.miscue_limit).is_ok())
}

/// Draws a jump over one object ball, aimed at the other one (7 in 10) or in any direction across the ball that it clears.
fn jump(table: &Table, layout: &Layout, rng: &mut Xoshiro256PlusPlus) -> Option<CueInputs> {
    let [cue_ball, first, second] = layout.balls;
    let (over, other) = if rng.random() { (first, second) } else { (second, first) };
    let (to_ball, diameter) = (over - cue_ball, 2.0 * table.radius);
    let target = match rng.random_range(0..10) {
        0..7 => other - cue_ball,
        _ => to_ball,
    };
    let widest = (diameter / target.length()).min(1.0).asin();
    let direction = DVec2::from_angle(target.to_angle() + rng.random_range(-widest..=widest));
    // Distance to the ball along the direction and beside it, and the height that the centre needs there.
    let (along, aside) = (direction.dot(to_ball), direction.perp_dot(to_ball));
    let needed = (diameter * diameter - aside * aside).max(0.0).sqrt();
    if along <= 0.0 || needed == 0.0 || target != to_ball && along >= target.length() {
        return None;
    }
    (0..8).find_map(|_| {
        let theta = rng.random_range(JUMP_ELEVATIONS[0]..JUMP_ELEVATIONS[1]);
        let speed = rng.random_range(JUMP_SPEEDS[0]..JUMP_SPEEDS[1]);
        let (a, b) = random_raised_tip(table, theta, 0.5, rng);
        let cue = CueInputs { a, b, theta, phi: direction.to_angle(), speed };
        let impulse = strike(table, &cue);
        let time = along / impulse.velocity.length();
        let height = impulse.lift * time - 0.5 * table.gravity * time * time;
        // The tip offset deflects the ball: the direction is corrected so that it flies as intended.
        let turned = direction.angle_to(impulse.velocity);
        (height >= needed + MIN_CLEARANCE).then_some(CueInputs { phi: cue.phi - turned, ..cue })
    })
}

/// Draws a massé whose curve reaches one of the object balls, thick or thin.
fn masse(table: &Table, layout: &Layout, rng: &mut Xoshiro256PlusPlus) -> Option<CueInputs> {
    let [cue_ball, first, second] = layout.balls;
    let target = if rng.random() { first } else { second } - cue_ball;
    let distance = target.length();
    if distance > MAX_MASSE_DISTANCE {
        return None;
    }
    let theta = rng.random_range(MAX_ELEVATION..MAX_ELEVATED_ANGLE);
    let speed = rng.random_range(MASSE_SPEEDS[0]..MASSE_SPEEDS[1]);
    let (a, b) = random_raised_tip(table, theta, 1.0, rng);
    let cue = CueInputs { a, b, theta, phi: 0.0, speed };
    let direction = direction_at(table, &cue, distance)?;
    let widest = (2.0 * table.radius / distance).min(1.0).asin();
    let phi = target.to_angle() + rng.random_range(-widest..=widest) - direction;
    Some(CueInputs { phi: (phi + PI).rem_euclid(TAU) - PI, ..cue })
}

/// Returns the direction of the cue ball from its start when it reaches `distance`, rad; `None` if it does not reach
/// it. Hops are neglected: their friction impulses add up to the same, only less evenly.
fn direction_at(table: &Table, cue: &CueInputs, distance: f64) -> Option<f64> {
    let impulse = strike(table, cue);
    let friction = table.sliding_friction * table.gravity;
    let slips = slip(table.radius, impulse.velocity, impulse.spin);
    let (against, sliding) = (-friction * slips.normalize_or_zero(), 2.0 * slips.length() / (7.0 * friction));
    let position = |time: f64| time * impulse.velocity + 0.5 * time * time * against;
    let samples = (1..=CURVE_SAMPLES).map(|n| position(sliding * f64::from(n) / f64::from(CURVE_SAMPLES)));
    if let Some(position) = samples.into_iter().find(|position| position.length() >= distance) {
        return Some(position.to_angle());
    }
    // From here it rolls on straight: find where the line meets the circle.
    let (from, ahead) = (position(sliding), (impulse.velocity + sliding * against).try_normalize()?);
    let along = from.dot(ahead);
    let rolled = (along * along + distance * distance - from.length_squared()).sqrt() - along;
    Some((from + rolled * ahead).to_angle())
}

/// Draws a tip position for a raised cue, uniform in area within this share of the miscue limit around the point where
/// the cue's line passes through the centre.
fn random_raised_tip(table: &Table, theta: f64, share: f64, rng: &mut Xoshiro256PlusPlus) -> (f64, f64) {
    let (a, lever) = random_tip(table, rng);
    tip_position(theta, share * a, share * lever)
}

/// Returns the tip position of a cue raised by `theta` whose line passes the ball's centre by `a` to the left and `lever`
/// above, in units of R.
fn tip_position(theta: f64, a: f64, lever: f64) -> (f64, f64) {
    let ring = (1.0 - a * a).sqrt();
    // A cue from behind cannot hit the ball beyond its top.
    let up = (theta + (lever / ring).clamp(-1.0, 1.0).asin()).min(MAX_ELEVATED_ANGLE);
    (a, ring * up.sin())
}

/// Moves a tip position back within the limit: towards the centre of the ball for an ordinary cue, and towards the
/// point where the line passes through the centre for a steep one.
pub fn clamp_tip(table: &Table, theta: f64, a: f64, b: f64) -> (f64, f64) {
    let most = TIP_SHARE * table.miscue_limit.sqrt();
    if theta <= MAX_ELEVATION {
        let share = (most / a.hypot(b)).min(1.0);
        return (a * share, b * share);
    }
    let a = a.clamp(-most, most);
    let ring = (1.0 - a * a).sqrt();
    let turned = (b / ring).clamp(-1.0, 1.0).asin() - theta;
    let lever = ring * turned.max(-FRAC_PI_2).sin();
    let share = (most / a.hypot(lever)).min(1.0);
    tip_position(theta, a * share, lever * share)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    #[test]
    fn jumps_are_playable_and_clear_the_ball() {
        let table = Table::default();
        let layout = Layout::parse("-0.5,0 -0.2,0.01 0.5,0.02", &table).unwrap();
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(5);
        let mut over = 0;
        for _ in 0..400 {
            let Some(cue) = jump(&table, &layout, &mut rng) else { continue };
            cue.validate().unwrap();
            let technique = Technique::of(&table, &layout, &cue).unwrap();
            over += usize::from(technique.over == Some(1));
            assert!(is_jump_or_masse(&table, &layout, &cue) || technique.over.is_none());
        }
        assert!(over > 100, "{over}");
    }

    #[test]
    fn masse_candidates_reach_their_target_ball() {
        let table = Table::default();
        let layout = Layout::parse("-0.5,0 0.1,0 1.2,0.6", &table).unwrap();
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(6);
        let (mut tried, mut met, mut bent) = (0, 0, 0);
        while tried < 300 {
            let Some(cue) = masse(&table, &layout, &mut rng) else { continue };
            cue.validate().unwrap();
            cue.validate_tip(table.miscue_limit).unwrap();
            tried += 1;
            let technique = Technique::of(&table, &layout, &cue).unwrap();
            met += usize::from(technique.first.is_some_and(|hit| hit.ball == 1 && technique.before.is_empty()));
            bent += usize::from(technique.is_jump_or_masse());
        }
        assert!(met > 150 && bent > 50, "{met} met, {bent} bent of {tried}");
    }

    #[test]
    fn clamped_tip_is_within_miscue_limit() {
        let table = Table::default();
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(7);
        for _ in 0..2000 {
            let theta = rng.random_range(0.0..MAX_ELEVATED_ANGLE);
            let (a, b) = clamp_tip(&table, theta, rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0));
            let cue = CueInputs { a, b, theta, phi: 0.0, speed: 2.0 };
            cue.validate_tip(table.miscue_limit).unwrap();
        }
    }

    #[test]
    fn only_steep_strokes_count_as_jump_or_masse() {
        let table = Table::default();
        let layout = Layout::opening(&table);
        let counts = |text: &str| is_jump_or_masse(&table, &layout, &CueInputs::parse(text).unwrap());
        assert!(!counts("0.3,-0.3,0,10,6") && !counts("0.3,-0.3,5,10,3") && counts("0.1,0.6,40,10,1"));
        // An elevation of 25° alone is neither.
        assert!(!counts("0,0.4,25,100,1"));
    }
}
