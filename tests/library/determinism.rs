//! The same shot gives the same bits: with every optimisation switched off, on every run, and on every machine.

use std::{fmt::Debug, ops::ControlFlow};

use carom::{
    game::{Referee, Tally},
    physics::{CueInputs, strike},
    simulation::{AllSavings, CushionContacts, Event, EventKind, Observer, Savings, Segment, watch, watch_with},
    study::{
        fingerprint::{TEXTBOOK, Trace, hash, shots, trace},
        stability::{Shot, adversarial, random},
    },
    table::Table,
};
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

/// Number of shots per table: shots on the thesis' table are slower, because they end in resting contacts, which are integrated.
const SHOT_COUNTS: [(&str, usize); 3] = [("textbook", 2000), ("match", 1000), ("thesis", 300)];

fn assert_same_bits<S: Savings>() {
    for (name, count) in SHOT_COUNTS {
        let table = Table::preset(name).unwrap();
        for (number, (layout, impulse)) in shots(&table, 1, count).iter().enumerate() {
            let with = trace::<AllSavings>(&table, layout, impulse);
            assert_eq!(trace::<S>(&table, layout, impulse), with, "shot {number} on {name}");
        }
    }
}

/// As [`assert_same_bits`], for what an observer records.
fn assert_same_records<S: Savings, O: Observer + Default + Debug + PartialEq>() {
    for (name, count) in SHOT_COUNTS {
        let table = Table::preset(name).unwrap();
        for (layout, impulse) in &shots(&table, 1, count) {
            let (mut with, mut without) = (O::default(), O::default());
            watch(&table, layout, impulse, &mut with);
            watch_with::<S, _>(&table, layout, impulse, &mut without);
            assert_eq!(with, without);
        }
    }
}

/// A set of optimisations with one of them off, and the test that plays with it.
macro_rules! without {
    ($test:ident, $saving:ident, $assert:ident $(, $observer:ty)?) => {
        #[test]
        fn $test() {
            struct Without;
            impl Savings for Without {
                const $saving: bool = false;
            }
            $assert::<Without $(, $observer)?>();
        }
    };
}

without!(predicting_for_balls_at_rest_changes_no_bit, BALLS_AT_REST, assert_same_bits);
without!(recomputing_every_prediction_changes_no_bit, KEPT_PREDICTIONS, assert_same_bits);
without!(solving_for_every_cushion_changes_no_bit, CUSHIONS_IN_REACH, assert_same_bits);
without!(solving_for_separated_trajectories_changes_no_bit, SEPARATED_COURSES, assert_same_bits);
without!(simulating_a_lone_ball_normally_changes_no_bit, LONE_BALL, assert_same_bits);
without!(simulating_past_a_decided_outcome_changes_no_bit, EARLY_END, assert_same_bits);

#[test]
fn disabling_all_optimisations_changes_no_bit() {
    struct Nothing;
    impl Savings for Nothing {
        const BALLS_AT_REST: bool = false;
        const KEPT_PREDICTIONS: bool = false;
        const CUSHIONS_IN_REACH: bool = false;
        const SEPARATED_COURSES: bool = false;
        const LONE_BALL: bool = false;
        const LAST_ROLLS: bool = false;
        const EARLY_END: bool = false;
        const OUT_OF_REACH: bool = false;
    }
    assert_same_bits::<Nothing>();
}

/// A trace of all trajectories, with the events between them.
#[derive(Default, Debug, PartialEq)]
struct Trajectories(Trace);

impl Observer for Trajectories {
    fn wants_segments(&self) -> bool {
        true
    }

    fn event(&mut self, event: Event) -> ControlFlow<()> {
        self.0.event(event)
    }

    fn segment(&mut self, ball: usize, segment: &Segment, end: f64) {
        let Segment { start, position, velocity, half_acceleration, spin, .. } = segment;
        let numbers = [*start, end, position.x, position.y, velocity.x, velocity.y, spin.x, spin.y, spin.z];
        let bends = half_acceleration.to_array();
        self.0.bits.push(ball as u64);
        self.0.bits.extend(numbers.into_iter().chain(bends).map(f64::to_bits));
    }
}

without!(simulating_a_lone_ball_normally_changes_no_trajectory, LONE_BALL, assert_same_records, Trajectories);

/// A trace without stops, which are not requested.
#[derive(Default, Debug, PartialEq)]
struct WithoutStops(Trace);

impl Observer for WithoutStops {
    fn wants_ends(&self) -> bool {
        false
    }

    fn event(&mut self, event: Event) -> ControlFlow<()> {
        if matches!(event.kind, EventKind::RollingStationary(_)) {
            ControlFlow::Continue(())
        } else {
            self.0.event(event)
        }
    }
}

without!(simulating_the_last_rolls_changes_no_earlier_bit, LAST_ROLLS, assert_same_records, WithoutStops);

/// Plays shots with and without the early end for lack of energy; returns how many have resting contacts that need not be followed.
fn compare_energy_early_end(count: usize) -> usize {
    struct Without;
    impl Savings for Without {
        const OUT_OF_REACH: bool = false;
    }
    /// A referee that counts the steps of resting contacts.
    struct Counting(Referee, usize);
    impl Observer for Counting {
        fn wants_ends(&self) -> bool {
            self.0.wants_ends()
        }
        fn awaited(&self) -> Option<[bool; 2]> {
            self.0.awaited()
        }
        fn event(&mut self, event: Event) -> ControlFlow<()> {
            self.0.event(event)
        }
        fn contact_step(&mut self) -> ControlFlow<()> {
            self.1 += 1;
            self.0.contact_step()
        }
    }
    fn play<S: Savings>(table: &Table, shot: &Shot, enough: u8) -> (Tally, usize) {
        let impulse = strike(table, &CueInputs::from(shot.cue));
        let mut watching = Counting(Referee::new(Some(enough), u32::MAX), 0);
        watch_with::<S, _>(table, &shot.layout, &impulse, &mut watching);
        // Cushions no longer count if no ball is met after them.
        let Counting(Referee { tally, .. }, steps) = watching;
        let hit_again = tally.hit_again && tally.has_hit_both();
        (Tally { cushions: 0, contacts: CushionContacts::default(), hit_again, ..tally }, steps)
    }
    let table = Table::preset("thesis").unwrap();
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(3);
    let mut spared = 0;
    for number in 0..count {
        let shot = if number % 2 == 0 { random::shot(&table, &mut rng) } else { adversarial::shot(&table, &mut rng) };
        for enough in [1, 2] {
            let (with, without) = (play::<AllSavings>(&table, &shot, enough), play::<Without>(&table, &shot, enough));
            assert_eq!(with.0, without.0, "{shot:?}");
            spared += usize::from(with.1 < without.1);
        }
    }
    spared
}

#[test]
fn ending_a_shot_for_lack_of_energy_changes_no_outcome() {
    let spared = compare_energy_early_end(4_000);
    assert!(spared > 200, "{spared} of 8,000");
}

/// `cargo test --release --test library ending_a_shot -- --ignored`
#[test]
#[ignore = "takes a minute"]
fn ending_a_shot_for_lack_of_energy_changes_none_of_many_outcomes() {
    compare_energy_early_end(500_000);
}

/// Plays the shots of the hash twice. The value `known` changes when results change on purpose: then copy the number from the message, and
/// give the reason in the commit message.
fn assert_hash(name: &str, lift: f64, known: u64) {
    let table = Table::preset(name).unwrap();
    let found = hash(&table, lift);
    assert_eq!(found, hash(&table, lift), "two runs differ");
    assert_eq!(found, known, "found {found:#018x}");
}

#[test]
fn the_textbook_table_plays_the_same_everywhere() {
    assert_hash("textbook", 0.0, TEXTBOOK);
}

#[test]
fn the_match_table_plays_the_same_everywhere() {
    assert_hash("match", 0.0, 0x7776_7e24_3aa8_bf43);
}

#[test]
fn balls_in_the_air_fly_the_same_everywhere() {
    assert_hash("match", 2.0, 0xcd41_18ac_e53d_2b69);
}

#[test]
fn resting_contacts_of_the_thesis_table_are_the_same_everywhere() {
    assert_hash("thesis", 0.0, 0xd016_afb1_283c_4910);
}
