//! Candidate shots: variations of a good shot, and samples of the whole space of strokes.

use std::f64::consts::{PI, TAU};

use glam::DVec2;
use rand::RngExt;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{
    FirstContact, Skill,
    elevated::{MAX_ELEVATED_ANGLE, clamp_tip},
};
use crate::{
    game::Rule,
    physics::{CueInputs, has_room, raise_to_clear, squirt},
    player::errors::{Errors, standard_normal},
    table::{Layout, Rail, Table},
};

/// Fastest recommended stroke, m/s: the thesis' limit (its 4.1.3).
pub const MAX_SPEED: f64 = 6.0;

/// Slowest stroke that the search tries, m/s.
pub const MIN_SPEED: f64 = 0.4;

/// Steepest ordinary cue that the search tries, rad: 30°. A stroke beyond it is a massé.
pub const MAX_ELEVATION: f64 = PI / 6.0;

/// Candidate tip positions stay within this share of the miscue limit's radius, so that rounding never exceeds the limit.
pub const TIP_SHARE: f64 = 0.98;

/// Distribution of usual strokes, as mean and standard deviation: the distance between the line of aim and the object
/// ball's centre, in diameters, and the logarithm of the speed in m/s.
/// Fitted to the shots that players make most often, as found by long searches on `match` for beginners, club players
/// and world-class players (1,100 layouts, 40,000 and 60,000 simulations each). The players differ little; the rules
/// differ in speed only.
const USUAL_OFFSET: [f64; 2] = [0.6, 0.2];
const USUAL_LOG_SPEED: [f64; 2] = [0.7, 0.6];
const USUAL_LOG_SPEED_AT_THREE_CUSHIONS: [f64; 2] = [0.95, 0.42];

/// Lowest tip position of a usual stroke, in R: one in thirty of those shots is struck lower.
const MIN_USUAL_HEIGHT: f64 = -0.1;

/// Draws a random variation of the policy's shot when that misses (thesis 5.1): the same direction and speed, another tip
/// position and elevation.
pub fn variation(table: &Table, cue: &CueInputs, rng: &mut Xoshiro256PlusPlus) -> CueInputs {
    let (a, b) = random_tip(table, rng);
    let phi = cue.phi + squirt(table, cue.a) - squirt(table, a);
    CueInputs { a, b, theta: rng.random_range(0.0..MAX_ELEVATION), phi, ..*cue }
}

/// Draws any shot: half of them aim at one of the object balls, thick or thin, the others in any direction.
pub fn random_stroke(table: &Table, layout: &Layout, rng: &mut Xoshiro256PlusPlus) -> CueInputs {
    let [cue_ball, first, second] = layout.balls;
    let phi = if rng.random() {
        random_direction_at(table, cue_ball, if rng.random() { first } else { second }, rng)
    } else {
        rng.random_range(-PI..PI)
    };
    let (a, b) = if rng.random() { random_tip(table, rng) } else { (0.0, 0.0) };
    let phi = phi - squirt(table, a);
    CueInputs { a, b, theta: rng.random_range(0.0..0.2), phi, speed: rng.random_range(MIN_SPEED..MAX_SPEED) }
}

/// Returns the `n`th stroke of a stratified sample.
///
/// Of every ten strokes, eight aim at an object ball (four at each), one at an object ball's mirror image in a cushion (a
/// one-cushion bank), and one in any direction. If the player wants a certain ball first, the eight aim at it; if a cushion
/// first, they are banks too.
///
/// Of every fifty strokes, the first twenty are of any kind: uniform in thickness, in tip position over the disc, and
/// in the logarithm of the speed from `softest` up, as speed errors are relative. The others follow the distribution of
/// usual strokes. The cue is level, because a player raises it only with a reason.
///
/// Usual strokes, and fewer shots in later stages when time was short, raised a club player's make rate at
/// three-cushion shots found in 30 ms from 25.3 to 27.8 % (200 layouts, with the search of that time).
pub fn stratified(
    table: &Table,
    layout: &Layout,
    rule: Rule,
    wanted: FirstContact,
    n: u64,
    softest: f64,
    rng: &mut Xoshiro256PlusPlus,
) -> CueInputs {
    let [cue_ball, first, second] = layout.balls;
    let target = match wanted {
        FirstContact::OtherCueBall => first,
        FirstContact::Any | FirstContact::Cushion if n.is_multiple_of(2) => first,
        FirstContact::Red | FirstContact::Any | FirstContact::Cushion => second,
    };
    let is_usual = n / 10 % 5 >= 2;
    let sort = if wanted == FirstContact::Cushion { (n % 10).max(8) } else { n % 10 };
    let phi = match sort {
        0..8 if is_usual => direction_past(table, cue_ball, target, usual_offset(rng)),
        0..8 => random_direction_at(table, cue_ball, target, rng),
        8 => {
            let target = if rng.random() { first } else { second };
            let rail = [Rail::Right, Rail::Left, Rail::Top, Rail::Bottom][rng.random_range(0..4)];
            let image = rail.image(table.reach(), target);
            // Side spin and cushion friction turn the rebound, so the window is wider than for the ball itself.
            (image - cue_ball).to_angle() + rng.random_range(-0.15..=0.15)
        }
        _ => rng.random_range(-PI..PI),
    };
    let ((a, b), speed) = if is_usual {
        (usual_tip(table, rng), usual_speed(rule, rng).clamp(softest, MAX_SPEED))
    } else {
        (random_tip(table, rng), rng.random_range(softest.ln()..MAX_SPEED.ln()).exp())
    };
    CueInputs { a, b, theta: 0.0, phi: phi - squirt(table, a), speed }
}

/// Draws the offset of a usual stroke's line of aim from the object ball's centre, in diameters, positive to the left.
fn usual_offset(rng: &mut Xoshiro256PlusPlus) -> f64 {
    let offset = gaussian(USUAL_OFFSET, rng);
    if rng.random() { offset } else { -offset }
}

/// Draws the tip position of a usual stroke. A position that is too low is mirrored to above the centre.
fn usual_tip(table: &Table, rng: &mut Xoshiro256PlusPlus) -> (f64, f64) {
    let (a, b) = random_tip(table, rng);
    (a, if b < MIN_USUAL_HEIGHT { -b } else { b })
}

/// Draws the speed of a usual stroke, m/s.
fn usual_speed(rule: Rule, rng: &mut Xoshiro256PlusPlus) -> f64 {
    let log_speed = match rule {
        Rule::ThreeCushion => USUAL_LOG_SPEED_AT_THREE_CUSHIONS,
        Rule::StraightRail | Rule::OneCushion => USUAL_LOG_SPEED,
    };
    gaussian(log_speed, rng).exp()
}

/// Draws a normally distributed number with this mean and standard deviation.
fn gaussian([mean, deviation]: [f64; 2], rng: &mut Xoshiro256PlusPlus) -> f64 {
    mean + deviation * standard_normal(rng)
}

/// Returns the stroke that results from `cue` played by this skill with these errors, kept within the limits of
/// recommended strokes.
pub fn with_errors(table: &Table, skill: Skill, cue: &CueInputs, errors: &Errors) -> CueInputs {
    let stroke = skill.stroke(table.radius, cue, errors);
    let theta = stroke.theta.clamp(0.0, max_elevation_for(cue));
    let (a, b) = clamp_tip(table, theta, stroke.a, stroke.b);
    CueInputs {
        a,
        b,
        theta,
        phi: stroke.phi + squirt(table, stroke.a) - squirt(table, a),
        speed: stroke.speed.clamp(MIN_SPEED, MAX_SPEED),
    }
}

/// Returns the steepest cue allowed for a stroke derived from `cue`: a jump or massé may stay one, and no other stroke
/// may become one.
pub fn max_elevation_for(cue: &CueInputs) -> f64 {
    if cue.theta > MAX_ELEVATION { MAX_ELEVATED_ANGLE } else { MAX_ELEVATION }
}

/// Returns the stroke as a player can play it in this layout: the cue is raised if a rail or a ball is in its way. `None` if
/// that needs more than 30°, the limit of usual strokes, or no elevation helps. A jump or massé cue may be raised
/// further.
#[inline]
pub fn playable(table: &Table, layout: &Layout, cue: &CueInputs) -> Option<CueInputs> {
    if has_room(table, layout, cue) {
        return Some(*cue);
    }
    raise_to_clear(table, layout, cue).ok().filter(|raised| raised.theta <= max_elevation_for(cue))
}

/// Draws a random direction in which a straight-running ball hits `target`, uniform in thickness.
fn random_direction_at(table: &Table, cue_ball: DVec2, target: DVec2, rng: &mut Xoshiro256PlusPlus) -> f64 {
    let difference = target - cue_ball;
    let widest = (2.0 * table.radius / difference.length()).min(1.0).asin();
    difference.to_angle() + rng.random_range(-widest..=widest)
}

/// Returns the direction in which a straight-running ball passes the centre of `target` by `offset` diameters to the
/// left. It just touches the ball if that is more than one.
fn direction_past(table: &Table, cue_ball: DVec2, target: DVec2, offset: f64) -> f64 {
    let difference = target - cue_ball;
    let share = 2.0 * table.radius * offset.clamp(-1.0, 1.0) / difference.length();
    difference.to_angle() + share.clamp(-1.0, 1.0).asin()
}

/// Draws a random point of the tip's disc, uniform in area.
pub fn random_tip(table: &Table, rng: &mut Xoshiro256PlusPlus) -> (f64, f64) {
    let radius = TIP_SHARE * (table.miscue_limit * rng.random::<f64>()).sqrt();
    let (sin, cos) = rng.random_range(0.0..TAU).sin_cos();
    (radius * cos, radius * sin)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::player::errors;
    use rand::SeedableRng;

    #[test]
    fn two_in_five_stratified_strokes_are_of_any_kind() {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(6);
        let table = Table::default();
        let layout = Layout::opening(&table);
        let strokes: Vec<_> = (0..20_000)
            .map(|n| stratified(&table, &layout, Rule::ThreeCushion, FirstContact::Any, n, MIN_SPEED, &mut rng))
            .collect();
        let share = |is: fn(&CueInputs) -> bool| strokes.iter().filter(|cue| is(cue)).count() as f64 / 20_000.0;
        // The part of the disc below a third of R is 11 % of its area, and 30 % of the log-speed range lies below 0.9 m/s.
        let [low, soft] = [share(|cue| cue.b < -0.33), share(|cue| cue.speed < 0.9)];
        assert!((0.03..0.06).contains(&low) && (0.11..0.15).contains(&soft), "{low} {soft}");
        let follow = share(|cue| cue.b > 0.1);
        assert!((0.5..0.7).contains(&follow), "{follow}");
    }

    #[test]
    fn candidates_never_exceed_the_miscue_limit() {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(5);
        for name in crate::table::PRESETS {
            let table = Table::preset(name).unwrap();
            for n in 0..2000 {
                let layout = Layout::random(&table, &mut rng);
                let cue = random_stroke(&table, &layout, &mut rng);
                let rule = Rule::ALL[n as usize % Rule::ALL.len()];
                let wide = stratified(&table, &layout, rule, FirstContact::Any, n, MIN_SPEED, &mut rng);
                let moved = with_errors(&table, Skill::BEGINNER, &wide, &errors::random(&mut rng));
                for cue in [moved, variation(&table, &cue, &mut rng), cue, wide] {
                    cue.validate().unwrap();
                    cue.validate_tip(table.miscue_limit).unwrap();
                }
            }
        }
    }
}
