//! The simulator and the reference engine, compared with shots that independent programs computed with 50 significant digits.

use carom::study::{GOAL_MEDIAN, GOAL_P99, ReferenceRow, Spread, check_references};

fn worst(spread: Option<Spread>) -> f64 {
    spread.unwrap().worst
}

#[test]
fn the_engines_reproduce_the_reference_shots() {
    let rows = check_references();
    for ReferenceRow { file, engine_m, engine_units, engine_time_s, .. } in &rows {
        println!("{file}: {engine_m:?} m, {engine_units:?} units, {engine_time_s:?} s");
    }
    let counts: Vec<_> = rows.iter().map(|row| (row.file, row.shots, row.engine_wrong.total, row.unjudged)).collect();
    assert_eq!(counts, [("shots", 80, 80, 0), ("hard", 84, 84, 0), ("contact", 40, 0, 0), ("flights", 60, 60, 0)]);
    for row in &rows {
        assert_eq!((row.engine_wrong.count, row.truth_wrong.count), (0, 0), "{}", row.file);
    }
    let [shots, hard, contact, flights] = &rows[..] else { unreachable!("four files are counted above") };
    for row in [shots, hard, flights] {
        let units = row.engine_units.unwrap();
        assert!(units.median <= GOAL_MEDIAN && units.p99 <= GOAL_P99 && units.worst <= 1000.0, "{row:?}");
        assert!(worst(row.engine_time_s) < 1e-9 && worst(row.engine_duration_s) < 1e-9, "{row:?}");
    }
    // The layouts of almost touching balls are rounded in the file; `condition` does not include this.
    assert!(worst(shots.truth_units) <= 4.0 && worst(hard.truth_units) <= 4.0, "{shots:?} {hard:?}");
    // The digits in the file end at about 1e-16 m; even amplified by the shot, this error is invisible.
    assert!(worst(shots.truth_m) < 5e-16, "{shots:?}");
    // The files are accurate to about 1e-10 m where balls rest against cushions.
    assert!(worst(contact.engine_m) < 1e-9 && worst(contact.engine_duration_s) < 1e-8, "{contact:?}");
    assert!(worst(contact.truth_m) < 1e-10 && worst(contact.engine_to_truth_m) < 1e-9, "{contact:?}");
    // The table of the flights is written in decimals that doubles cannot represent exactly: only this error remains.
    let units = flights.truth_units.unwrap();
    assert!(units.median < 1.0 && units.worst < 16.0, "{flights:?}");
}
