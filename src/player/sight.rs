//! How a player plays a layout that was reported inaccurately: the player sees the real balls and aims at them.

use crate::{
    physics::{CueInputs, squirt},
    table::{Layout, Table},
};

/// Draws a possible real layout behind the reported `layout`, whose coordinates each have a standard error of `placing` m. A
/// ball that would overlap another one or a cushion is moved less far.
pub fn perturbed_layout(table: &Table, layout: &Layout, placing: f64, mut normal: impl FnMut() -> f64) -> Layout {
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

/// Returns the stroke of a player who is given `cue` for the `assumed` layout but sees the `real` one. It is turned so that it
/// hits its first ball with the same fullness, or aims at the same point of a cushion if it hits no ball.
pub fn re_aimed(table: &Table, assumed: &Layout, real: &Layout, cue: &CueInputs) -> CueInputs {
    let [start, real_start] = [assumed.balls[0], real.balls[0]];
    let along = glam::DVec2::from_angle(cue.phi + squirt(table, cue.a));
    let ahead = |ball: &usize| {
        let to_ball = assumed.balls[*ball] - start;
        let distance = to_ball.dot(along);
        (distance > 0.0 && along.perp_dot(to_ball).abs() < 2.0 * table.radius).then_some(distance)
    };
    let first = [1, 2].into_iter().filter_map(|ball| Some((ball, ahead(&ball)?))).min_by(|a, b| a.1.total_cmp(&b.1));
    let (target, real_target) = if let Some((ball, _)) = first {
        (assumed.balls[ball], real.balls[ball])
    } else {
        let reach = table.reach();
        let until = |place: f64, speed: f64, most: f64| {
            if speed == 0.0 { f64::MAX } else { (most.copysign(speed) - place) / speed }
        };
        let point = start + along * until(start.x, along.x, reach.x).min(until(start.y, along.y, reach.y));
        (point, point)
    };
    let [was, is] = [target - start, real_target - real_start];
    // If the ball lies exactly at the aiming point, there is no direction to it.
    if was.length_squared() < 1e-12 || is.length_squared() < 1e-12 {
        return *cue;
    }
    CueInputs { phi: cue.phi + was.angle_to(is), ..*cue }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    #[test]
    fn re_aiming_keeps_the_target_ball_or_rail_point() {
        let (table, assumed) =
            (Table::default(), Layout::new([DVec2::new(-0.8, 0.1), DVec2::new(0.4, 0.3), DVec2::new(0.9, -0.5)]));
        let mut real = assumed;
        real.balls[0] += DVec2::new(0.003, -0.004);
        real.balls[1] += DVec2::new(-0.002, 0.005);
        let towards = |layout: &Layout, ball: usize| (layout.balls[ball] - layout.balls[0]).to_angle();
        let cue = |phi| CueInputs { a: 0.2, b: 0.1, theta: 0.0, phi: phi - squirt(&table, 0.2), speed: 2.0 };
        let half = cue(towards(&assumed, 1) + 0.03);
        let turned = re_aimed(&table, &assumed, &real, &half);
        assert!((turned.phi - half.phi - (towards(&real, 1) - towards(&assumed, 1))).abs() < 1e-12);
        // Straight up: from another position the same point needs another direction.
        let up = cue(std::f64::consts::FRAC_PI_2);
        let turned = re_aimed(&table, &assumed, &real, &up);
        let point = DVec2::new(-0.8, table.half_width());
        assert!((turned.phi - up.phi - (point - assumed.balls[0]).angle_to(point - real.balls[0])).abs() < 1e-12);
        assert_eq!(re_aimed(&table, &assumed, &assumed, &up), up);
    }
}
