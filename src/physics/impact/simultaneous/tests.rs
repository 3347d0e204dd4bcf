//! Tests of simultaneous impacts.

use proptest::prelude::*;

use super::*;

const RADIUS: f64 = 0.03;

fn law(ball_restitution: f64) -> ImpactLaw {
    with_friction(ball_restitution, 0.0)
}

fn with_friction(ball_restitution: f64, friction: f64) -> ImpactLaw {
    let table = Table {
        ball_restitution,
        ball_friction: Some(friction),
        rail_restitution: 0.85,
        rail_friction: 0.2,
        ..Table::preset("textbook").unwrap()
    };
    ImpactLaw::of(&table)
}

/// Plays rounds until no contact closes, as the engine does. Returns their number.
fn collide(law: &ImpactLaw, balls: &mut [BallState; BALLS], contacts: &[Contact]) -> usize {
    for round in 0.. {
        let closing: Vec<Contact> =
            contacts.iter().copied().filter(|contact| contact.opening_speed(balls) < -1e-12).collect();
        if closing.is_empty() {
            return round;
        }
        collide_together(RADIUS, law, balls, &closing);
    }
    unreachable!("rounds end")
}

fn in_line(speed: f64) -> [BallState; BALLS] {
    let mut balls = [0.0, 2.0, 4.0].map(|x| BallState::at_rest(DVec2::new(x * RADIUS, 0.0)));
    balls[0].velocity.x = speed;
    balls
}

const LINE: [Contact; 2] = [Contact::of_balls(0, 1), Contact::of_balls(1, 2)];

#[test]
fn newtons_cradle_passes_the_impulse_to_its_last_ball() {
    let mut balls = in_line(1.0);
    assert_eq!(collide(&law(1.0), &mut balls, &LINE), 2);
    assert_eq!(balls.map(|ball| ball.velocity.x), [0.0, 0.0, 1.0]);
}

#[test]
fn a_frozen_pair_struck_from_behind_sends_its_front_ball_off() {
    let mut balls = in_line(2.0);
    collide(&law(0.95), &mut balls, &LINE);
    let [first, middle, last] = balls.map(|ball| ball.velocity.x);
    assert!((last - 2.0 * 0.975 * 0.975).abs() < 1e-15, "{last}");
    assert!((first + middle + last - 2.0).abs() < 1e-15 && first <= middle && middle < last);
}

#[test]
fn symmetric_break_stays_symmetric_in_any_ball_order() {
    let height = 3.0_f64.sqrt() * RADIUS;
    let mut balls = [
        BallState::at_rest(DVec2::new(-height, 0.0)),
        BallState::at_rest(DVec2::new(0.0, RADIUS)),
        BallState::at_rest(DVec2::new(0.0, -RADIUS)),
    ];
    balls[0].velocity.x = 3.0;
    let mut swapped = [balls[0], balls[2], balls[1]];
    let contacts = [Contact::of_balls(0, 1), Contact::of_balls(0, 2), Contact::of_balls(1, 2)];
    collide(&law(0.9), &mut balls, &contacts);
    collide(&law(0.9), &mut swapped, &contacts);
    let (one, other) = (balls[1].velocity, balls[2].velocity);
    assert!((one * DVec2::new(1.0, -1.0)).distance(other) < 1e-15 && balls[0].velocity.y.abs() < 1e-15);
    assert_eq!([swapped[2].velocity, swapped[1].velocity], [one, other]);
    // Moreau's law: both contacts separate at e times their closing speed.
    let parting = contacts[0].opening_speed(&balls);
    assert!((parting - 0.9 * 3.0 * 0.75_f64.sqrt()).abs() < 1e-14, "{parting}");
}

#[test]
fn friction_by_slip_replaces_the_constant_coefficient() {
    let height = 3.0_f64.sqrt() * RADIUS;
    let contacts = [Contact::of_balls(0, 1), Contact::of_balls(0, 2)];
    let after = |ball_friction: Option<f64>| {
        let table = Table { ball_friction, ..Table::preset("match").unwrap() };
        let mut balls =
            [(-height, 0.0), (0.0, RADIUS), (0.0, -RADIUS)].map(|(x, y)| BallState::at_rest(DVec2::new(x, y)));
        (balls[0].velocity.x, balls[0].spin.z) = (3.0, 80.0);
        collide(&ImpactLaw::of(&table), &mut balls, &contacts);
        balls
    };
    assert_eq!(after(Some(0.118)), after(None));
}

#[test]
fn contacts_without_shared_balls_collide_independently() {
    let law = ImpactLaw::of(&Table::preset("match").unwrap());
    let mut balls = in_line(2.0);
    balls[2].velocity = DVec2::new(3.0, 1.0);
    let (mut pair, mut alone) = (balls, balls);
    let contacts = [LINE[0], Contact::with_cushion(2, Rail::Right)];
    let together = collide_together(RADIUS, &law, &mut balls, &contacts);
    let one = collide_together(RADIUS, &law, &mut pair, &contacts[..1]);
    let other = collide_together(RADIUS, &law, &mut alone, &contacts[1..]);
    assert_eq!((together[0], together[1]), (one[0], other[0]));
    assert_eq!(balls, [pair[0], pair[1], alone[2]]);
    assert!(balls[2].velocity.x < 0.0 && balls[1].velocity.x > 1.8);
}

/// A ball that spins in a corner while another ball loses energy elsewhere: its friction must not use that energy.
#[test]
fn contacts_without_shared_balls_exchange_no_energy() {
    let law = with_friction(0.95, 0.2);
    let mut balls = in_line(0.0);
    balls[2].velocity = DVec2::new(1.51, -2.64);
    balls[2].spin = glam::DVec3::new(36.5, 20.9, 0.0);
    balls[0].velocity = DVec2::new(-40.0, -3.0);
    let contacts = [
        Contact::with_cushion(0, Rail::Bottom),
        Contact::with_cushion(2, Rail::Right),
        Contact::with_cushion(2, Rail::Bottom),
    ];
    let before = balls[2].specific_energy(RADIUS);
    let mut corner = balls;
    collide_together(RADIUS, &law, &mut balls, &contacts);
    collide_together(RADIUS, &law, &mut corner, &contacts[1..]);
    assert_eq!(balls[2], corner[2]);
    assert!(balls[2].specific_energy(RADIUS) <= before);
}

/// A slow ball in a corner, whose friction would accelerate it, while another ball is fast: its tiny energy gain is lost in the
/// rounding of the sum.
#[test]
fn uninvolved_balls_hide_no_energy_gain() {
    let law = with_friction(1.0, 0.2).with_restitution(1.0);
    let mut balls = in_line(0.0);
    balls[2].velocity = DVec2::new(-4.1e-7, 2.8e-8);
    balls[2].spin = glam::DVec3::new(-2.3e-7, -5.2e-6, 0.0);
    let (mut alone, before) = (balls, balls[2].specific_energy(RADIUS));
    balls[0].velocity = DVec2::new(2.0, 1.0);
    let corner = [Contact::with_cushion(2, Rail::Left), Contact::with_cushion(2, Rail::Top)];
    collide_together(RADIUS, &law, &mut balls, &corner);
    collide_together(RADIUS, &law, &mut alone, &corner);
    assert_eq!(balls[2], alone[2]);
    assert!(balls[2].specific_energy(RADIUS) <= before * (1.0 + 8.0 * f64::EPSILON));
}

/// A blow drives a ball away from another one that approaches it slowly: only two of the three balls collide.
#[test]
fn relieved_contact_does_not_change_the_law_of_others() {
    let law = ImpactLaw::of(&Table::preset("match").unwrap());
    let mut balls = in_line(0.0);
    balls[2].velocity = DVec2::new(-3.0, 0.4);
    let behind = DVec2::new(0.6, 0.8);
    balls[0] = BallState { velocity: -0.1 * behind, ..BallState::at_rest(balls[1].position + 2.0 * RADIUS * behind) };
    let mut alone = balls;
    let contacts = [Contact::of_balls(0, 1), LINE[1]];
    let together = collide_together(RADIUS, &law, &mut balls, &contacts);
    let single = collide_together(RADIUS, &law, &mut alone, &contacts[1..]);
    assert_eq!((together[0].normal, together[1]), (0.0, single[0]));
    assert_eq!(balls, alone);
}

#[test]
fn ball_between_ball_and_cushion_loses_energy_and_separates() {
    let mut balls = in_line(0.0);
    balls[0] = BallState { velocity: DVec2::new(2.0, 0.7), spin: glam::DVec3::new(30.0, 50.0, -20.0), ..balls[0] };
    balls[1].velocity = DVec2::new(0.5, -0.3);
    let contacts = [Contact::of_balls(0, 1), Contact::with_cushion(1, Rail::Right)];
    let law = with_friction(0.95, 0.3);
    let energy = |balls: &[BallState; BALLS]| balls.iter().map(|ball| ball.specific_energy(RADIUS)).sum::<f64>();
    let before = energy(&balls);
    collide(&law, &mut balls, &contacts);
    assert!(energy(&balls) <= before);
    assert!(contacts.iter().all(|contact| contact.opening_speed(&balls) >= -1e-12));
}

/// Balls in the air that fly over a cloth.
fn all_aloft() -> Aloft {
    Aloft { flies: [true; BALLS], cloth: Cloth { restitution: 0.5, friction: 0.2, gravity: 9.81 }, slowest: 2e-3 }
}

fn energy_in_space(balls: &[SpatialState; BALLS]) -> f64 {
    balls.iter().map(|ball| ball.specific_energy(RADIUS, 0.0)).sum()
}

proptest! {
    /// Ball 0 hits both others at the same moment, in any direction.
    #[test]
    fn joint_impacts_in_space_conserve_momentum_gain_no_energy_and_ignore_numbering(
        directions in [[-1.0..1.0f64, -1.0..1.0, -1.0..1.0], [-1.0..1.0f64, -1.0..1.0, -1.0..1.0]],
        velocities in [[-2.0..2.0f64, -2.0..2.0, -2.0..2.0], [-2.0..2.0f64, -2.0..2.0, -2.0..2.0], [-2.0..2.0f64, -2.0..2.0, -2.0..2.0]],
        spins in [[-50.0..50.0f64, -50.0..50.0, -50.0..50.0], [-50.0..50.0f64, -50.0..50.0, -50.0..50.0], [-50.0..50.0f64, -50.0..50.0, -50.0..50.0]],
        restitution in 0.0..1.0f64,
        friction in 0.0..0.5f64,
    ) {
        let [one, other] = directions.map(|n| DVec3::from_array(n).normalize());
        // Far enough apart for both balls to have room.
        let normals = [one, if one.distance(other) < 1.0 { -other } else { other }];
        let place = DVec3::new(0.0, 0.0, 0.2);
        let places = [place, place + 2.0 * RADIUS * normals[0], place + 2.0 * RADIUS * normals[1]];
        let mut balls: [SpatialState; BALLS] = std::array::from_fn(|ball| SpatialState {
            position: places[ball],
            velocity: DVec3::from_array(velocities[ball]),
            spin: DVec3::from_array(spins[ball]),
        });
        for (ball, n) in [1, 2].into_iter().zip(normals) {
            let opening = (balls[ball].velocity - balls[0].velocity).dot(n);
            balls[ball].velocity -= (opening + opening.abs().max(0.01)) * n;
        }
        let touches = [1, 2].map(|ball| Touch::of(Contact::of_balls(0, ball), &balls));
        let (law, before) = (with_friction(restitution, friction), balls);
        let mut exchanged = [balls[0], balls[2], balls[1]];
        let again = [1, 2].map(|ball| Touch::of(Contact::of_balls(0, ball), &exchanged));
        let impulses = collide_together_in_space(RADIUS, &law, Some(&all_aloft()), &mut balls, &touches);
        collide_together_in_space(RADIUS, &law, Some(&all_aloft()), &mut exchanged, &again);
        for (ball, other) in [(0, 0), (1, 2), (2, 1)] {
            prop_assert!(balls[ball].velocity.distance(exchanged[other].velocity) < 1e-12);
            prop_assert!(balls[ball].spin.distance(exchanged[other].spin) < 1e-10);
        }
        let momentum = |balls: &[SpatialState; BALLS]| balls.iter().map(|ball| ball.velocity).sum::<DVec3>();
        prop_assert!(momentum(&balls).distance(momentum(&before)) < 1e-13);
        prop_assert!(energy_in_space(&balls) <= energy_in_space(&before) * (1.0 + 1e-14));
        // Friction across the normals changes no opening speed of a single contact, but those of coupled ones.
        if friction == 0.0 {
            prop_assert!(touches.iter().all(|touch| touch.opening_speed(&balls) >= -1e-12));
        }
        prop_assert!(impulses[..2].iter().any(|impulse| impulse.normal > 0.0));
    }
}

#[test]
fn joint_impact_in_space_separates_every_contact_at_its_restitution() {
    let (law, down) = (law(0.9), 1.0);
    let n = DVec3::new(0.6, 0.0, 0.8);
    let ball = |position, velocity| SpatialState { position, velocity, spin: DVec3::ZERO };
    let upper = DVec3::new(0.0, 0.0, 0.1);
    let mut balls = [
        ball(upper, DVec3::new(0.0, 0.0, -down)),
        ball(upper - 2.0 * RADIUS * n, DVec3::ZERO),
        ball(upper - 2.0 * RADIUS * DVec3::new(-n.x, n.y, n.z), DVec3::ZERO),
    ];
    let touches = [1, 2].map(|ball| Touch::of(Contact::of_balls(0, ball), &balls));
    collide_together_in_space(RADIUS, &law, Some(&all_aloft()), &mut balls, &touches);
    for touch in touches {
        assert!((touch.opening_speed(&balls) - 0.9 * 0.8 * down).abs() < 1e-14, "{balls:?}");
    }
    let [_, one, other] = balls.map(|ball| ball.velocity);
    assert!((one * DVec3::new(-1.0, 1.0, 1.0)).distance(other) < 1e-15 && one.y == 0.0, "{balls:?}");
}
