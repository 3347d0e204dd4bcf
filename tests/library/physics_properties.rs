//! Properties of every shot: energy, no overlap, mirror symmetry, the same bits on every run.

use carom::{
    physics::{CueInputs, Motion},
    simulation::{EventKind, Recording},
    table::{Layout, PRESETS, Table},
};
use glam::{DVec2, DVec3};
use proptest::{prelude::*, test_runner::RngSeed};
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

/// Rounding error of sums of squares of a few m/s.
const ROUNDING: f64 = 1e-12;

fn tables() -> impl Strategy<Value = Table> {
    prop::sample::select(PRESETS.to_vec()).prop_map(|name| Table::preset(name).unwrap())
}

/// Generates strokes over the whole accepted range, with a bias to the edge of the ball and to extreme speeds.
fn cues() -> impl Strategy<Value = CueInputs> {
    let share = prop_oneof![3 => 0.0..0.5, 1 => 0.5..0.999_f64];
    let speed = prop_oneof![5 => 0.3..7.0, 1 => 1e-4..0.3, 1 => 7.0..40.0_f64];
    let theta = prop_oneof![3 => 0.0..0.3, 1 => 0.3..1.5_f64];
    (share, -3.2..3.2_f64, theta, -3.2..3.2_f64, speed).prop_map(|(share, around, theta, phi, speed)| CueInputs {
        a: share * around.cos(),
        b: share * around.sin(),
        theta,
        phi,
        speed,
    })
}

fn shots() -> impl Strategy<Value = (Table, Layout, CueInputs)> {
    (tables(), any::<u64>(), cues()).prop_map(|(table, seed, cue)| {
        let layout = Layout::random(&table, &mut Xoshiro256PlusPlus::seed_from_u64(seed));
        (table, layout, cue)
    })
}

/// Whether no two impacts occur within a nanosecond, and nothing rests against anything: then the order in which balls are examined cannot
/// matter.
fn only_single_impacts(recording: &Recording) -> bool {
    let rests = |kind: EventKind| matches!(kind, EventKind::ContactBegins(_));
    recording.events().iter().all(|event| !rests(event.kind))
        && recording.events().windows(2).all(|pair| pair[1].time - pair[0].time > 1e-9)
}

/// Returns the event with balls 1 and 2 exchanged.
fn exchange_object_balls(kind: EventKind) -> EventKind {
    let name = |ball: usize| if ball == 0 { 0 } else { 3 - ball };
    match kind {
        EventKind::BallBall(first, second) => {
            EventKind::BallBall(name(first).min(name(second)), name(first).max(name(second)))
        }
        EventKind::BallRail(ball, rail) => EventKind::BallRail(name(ball), rail),
        EventKind::SlidingRolling(ball) => EventKind::SlidingRolling(name(ball)),
        EventKind::RollingStationary(ball) => EventKind::RollingStationary(name(ball)),
        EventKind::ContactBegins(ball) => EventKind::ContactBegins(name(ball)),
        EventKind::ContactEnds(ball) => EventKind::ContactEnds(name(ball)),
        EventKind::Jumps(ball) => EventKind::Jumps(name(ball)),
        EventKind::Lands(ball) => EventKind::Lands(name(ball)),
        EventKind::LeavesTable(ball) => EventKind::LeavesTable(name(ball)),
    }
}

fn energy(recording: &Recording, table: &Table, t: f64) -> f64 {
    (0..3).map(|ball| recording.spatial_state(ball, t).specific_energy(table.radius, table.gravity)).sum()
}

/// Checks at time `t` that no balls overlap and that all are on the table, within a billionth of a metre. A ball that has left the table
/// may be anywhere; a ball in the air may be over a nose.
fn check_positions(table: &Table, recording: &Recording, t: f64) -> Result<(), TestCaseError> {
    let is_on_table = |ball: &usize| recording.motion(*ball, t) != Motion::OffTable;
    let on_table = (0..3).filter(is_on_table).map(|ball| recording.spatial_state(ball, t).position);
    let places: Vec<DVec3> = on_table.collect();
    for (index, place) in places.iter().enumerate() {
        prop_assert!(place.is_finite() && place.z >= 0.0);
        let outside = (place.truncate().abs() - table.reach()).max_element();
        prop_assert!(outside < 1e-9 || place.z > 0.0, "ball {index} is outside at {t} s");
        for other in &places[..index] {
            prop_assert!(place.distance(*other) > 2.0 * table.radius - 1e-9, "balls overlap at {t} s");
        }
    }
    Ok(())
}

proptest! {
    // A failure is printed completely and becomes a separate test below; seed files would hide its cause. The shots are the same every
    // time, so that only a code change can make the test fail: PROPTEST_RNG_SEED tries others.
    #![proptest_config(ProptestConfig {
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(2026),
        ..ProptestConfig::with_cases(512)
    })]

    #[test]
    fn energy_never_grows((table, layout, cue) in shots()) {
        let recording = Recording::new(&table, &layout, &cue).unwrap();
        let mut last = energy(&recording, &table, 0.0);
        let slack = ROUNDING * (1.0 + last);
        for event in recording.events() {
            let now = energy(&recording, &table, event.time);
            prop_assert!(now <= last + slack, "{event:?}: {last} becomes {now}");
            last = now;
        }
        if recording.off_table() == [false; 3] {
            prop_assert_eq!(recording.final_layout().balls, recording.positions(f64::INFINITY));
        }
    }

    #[test]
    fn balls_never_overlap_or_leave_the_table_between_events((table, layout, cue) in shots()) {
        let recording = Recording::new(&table, &layout, &cue).unwrap();
        let mut last = 0.0;
        for event in recording.events() {
            for share in [0.25, 0.5, 0.75, 1.0] {
                check_positions(&table, &recording, last + share * (event.time - last))?;
            }
            last = event.time;
        }
    }

    #[test]
    fn a_mirrored_shot_has_a_mirrored_course((table, layout, cue) in shots()) {
        let recording = Recording::new(&table, &layout, &cue).unwrap();
        let flip = DVec2::new(1.0, -1.0);
        let mirrored_layout = Layout::new(layout.balls.map(|ball| ball * flip));
        // Mirroring exchanges left and right: the side of the tip, and the sense of phi.
        let mirrored_cue = CueInputs { a: -cue.a, phi: -cue.phi, ..cue };
        let mirrored = Recording::new(&table, &mirrored_layout, &mirrored_cue).unwrap();
        // Rounding errors grow with every collision, so only the beginning must agree exactly.
        let kinds = |recording: &Recording| -> Vec<&str> {
            recording.events().iter().take(4).map(|event| event.kind.name()).collect()
        };
        prop_assert_eq!(kinds(&recording), kinds(&mirrored));
        let t = recording.events().first().map_or(0.0, |event| event.time);
        for (one, other) in recording.positions(t).iter().zip(mirrored.positions(t)) {
            prop_assert!(one.distance(other * flip) < 1e-12);
        }
    }

    /// Exchanging the object balls exchanges their names in the course and changes nothing else, to the last bit.
    #[test]
    fn exchanging_the_object_balls_exchanges_their_courses((table, layout, cue) in shots()) {
        let [cue_ball, one, other] = layout.balls;
        let recording = Recording::new(&table, &layout, &cue).unwrap();
        prop_assume!(only_single_impacts(&recording));
        let exchanged = Recording::new(&table, &Layout::new([cue_ball, other, one]), &cue).unwrap();
        let named = recording.events().iter().map(|event| (event.time, exchange_object_balls(event.kind)));
        let found = exchanged.events().iter().map(|event| (event.time, event.kind));
        prop_assert_eq!(named.collect::<Vec<_>>(), found.collect::<Vec<_>>());
        let [end, first, second] = exchanged.final_layout().balls;
        prop_assert_eq!(recording.final_layout().balls, [end, second, first]);
    }

    #[test]
    fn the_same_shot_gives_the_same_bits((table, layout, cue) in shots()) {
        let run = || Recording::new(&table, &layout, &cue).unwrap();
        let (one, other) = (run(), run());
        prop_assert_eq!(one.events(), other.events());
        prop_assert_eq!(one.final_layout(), other.final_layout());
    }
}

/// Regression test: two balls roll against each other on the thesis' table, and the motion of each alone presses them together.
#[test]
fn rolling_balls_without_contact_collide_before_they_overlap() {
    let table = Table::preset("thesis").unwrap();
    let layout = Layout::new([
        DVec2::new(-1.226_677_999_408_687_8, -0.504_228_537_506_218_1),
        DVec2::new(0.057_712_878_660_900_246, 0.332_826_420_945_944_83),
        DVec2::new(1.090_688_508_114_460_4, -0.143_642_551_442_273_84),
    ]);
    let cue = CueInputs {
        a: 0.270_689_529_992_374_56,
        b: 0.096_127_730_610_505_5,
        theta: 0.265_997_891_528_637_06,
        phi: -3.128_723_771_139_473,
        speed: 7.0,
    };
    let recording = Recording::new(&table, &layout, &cue).unwrap();
    for event in recording.events() {
        check_positions(&table, &recording, event.time).unwrap();
    }
}

#[test]
fn playback_is_continuous_and_ends_where_the_shot_ends() {
    for name in PRESETS {
        let table = Table::preset(name).unwrap();
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(8);
        for _ in 0..200 {
            let layout = Layout::random(&table, &mut rng);
            let cue = CueInputs { a: 0.2, b: -0.3, theta: 0.1, phi: layout.balls[1].y * 4.0, speed: 4.0 };
            let recording = Recording::new(&table, &layout, &cue).unwrap();
            for ball in 0..3 {
                for pair in recording.segments(ball).windows(2) {
                    let end = pair[0].position_after(pair[1].start - pair[0].start);
                    assert!(
                        end.distance(pair[1].position) < 1e-11,
                        "a ball jumps by {}",
                        end.distance(pair[1].position)
                    );
                }
                assert_eq!(recording.state(ball, recording.duration()).velocity, DVec2::ZERO);
            }
            let stops = |kind: &EventKind| matches!(kind, EventKind::RollingStationary(_));
            // A ball that leaves the table does not stop on it.
            let has_stopped = recording.events().iter().any(|event| stops(&event.kind));
            assert!(has_stopped || recording.off_table()[0], "{:?}", recording.events());
        }
    }
}
