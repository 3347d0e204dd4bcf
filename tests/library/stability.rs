//! The stability table, row by row: stiff and extreme cases, random and adversarial shots.

use std::path::Path;

use carom::{
    physics::CueDegrees,
    study::stability::{Case, Limits, Plan, Row, Shot, Trace, Violation, cases, examine},
    table::{Layout, Table, TableError},
};
use glam::DVec2;

/// Number of shots of each row on each of its tables, with the limits of the report.
const PLAN: Plan = Plan { random: 1_000, adversarial: 1_000, each_case: 100, seed: 1 };

/// Plays a row and fails with its first failing shot, as JSON that `carom simulate --batch` reads.
fn assert_row_holds(name: &str) {
    let case: Case = cases().into_iter().find(|case| case.name == name).expect("the row is in the table");
    let row = Row::of(&case, &PLAN, |_| {});
    if let Some(first) = &row.finding {
        panic!(
            "{} of {} fail: {}\n{}",
            row.failed,
            row.figures.shots,
            first.description,
            serde_json::to_string(first).unwrap()
        );
    }
    let tables = (case.tables)().len() as u64;
    assert_eq!(row.figures.shots, tables * PLAN.shots(&case), "all shots are played");
}

macro_rules! rows_as_tests {
    ($($test:ident => $name:literal,)*) => {
        $(#[test] fn $test() { assert_row_holds($name); })*
        const NAMES: &[&str] = &[$($name),*];
    };
}

rows_as_tests! {
    random_shots_on_the_match_table => "random shots, table \"match\"",
    random_shots_on_the_textbook_table => "random shots, table \"textbook\"",
    random_shots_on_the_thesis_table => "random shots, table \"thesis\"",
    adversarial_shots_on_the_match_table => "adversarial shots, table \"match\"",
    adversarial_shots_on_the_textbook_table => "adversarial shots, table \"textbook\"",
    adversarial_shots_on_the_thesis_table => "adversarial shots, table \"thesis\"",
    grazing_contact => "grazing contact, relative depth 1e-15 to 1e-3",
    object_ball_on_a_cushion => "object ball exactly on a cushion",
    cue_ball_on_a_cushion => "cue ball exactly on a cushion",
    object_ball_in_a_corner => "object ball exactly in a corner",
    exact_corner_shots => "a shot exactly into a corner at 45°",
    two_touching_balls => "two balls exactly touching",
    three_touching_balls => "three balls exactly touching",
    three_balls_in_line => "three balls in line, touching or 1e-16 to 1e-6 m apart",
    tiny_gaps => "two balls 1e-16 to 1e-6 m apart",
    two_balls_at_the_same_time => "two object balls hit at the same moment",
    ball_and_cushion_at_the_same_time => "ball and cushion hit at the same moment",
    resting_on_a_cushion => "a ball resting on a cushion",
    resting_on_two_cushions => "a ball resting on two cushions",
    resting_on_another_ball => "a ball resting on another",
    pressed_between_ball_and_cushion => "a ball pressed between ball and cushion",
    resting_on_a_smooth_cushion => "a ball resting on a smooth cushion",
    lively_cushion => "a ball spinning against a cushion, e = 0.95",
    livelier_cushion => "a ball spinning against a cushion, e = 0.99",
    lively_ball => "a ball spinning against another, e = 0.95",
    livelier_ball => "a ball spinning against another, e = 0.99",
    resting_on_a_smooth_ball => "a ball resting on another, smooth ball",
    pressed_between_smooth_ball_and_cushion => "a ball pressed between a smooth ball and cushion",
    next_to_no_slip => "next to no slip: relative 1e-16 to 1e-6",
    tiny_spins => "spins of 1e-16 to 1e-9",
    all_speeds => "speeds from 1e-6 to 60 m/s",
    steep_masse => "massé at 89° to 89.999°",
    tip_at_the_rim => "tip at the rim of the ball",
    next_to_no_friction => "next to no friction",
    large_friction => "friction of 10 and 1000 on the cloth, 0.99 in contacts",
    no_restitution => "no restitution, e = 0",
    little_restitution => "restitution e = 0.3",
    full_restitution => "full restitution, e = 1",
    lossless_contacts => "full restitution without friction in contacts",
    smallest_table => "the smallest table, 16 by 6 ball radii",
    longest_table => "the longest table, ten metres",
    tiny_and_huge_balls => "balls of one millimetre and of one metre",
    steepest_slope => "random shots on the steepest accepted slope",
    simple_rails => "random shots, rails at the height of the centre or of the nose",
    integrated_rails => "random shots, rails by Mathavan",
    grazing_from_above => "grazing a ball from above, relative depth 1e-12 to 1e-3",
    raised_cue => "random shots with the cue raised by up to 60°",
    raised_cue_at_touching => "balls that touch or almost touch, the cue raised by up to 60°",
    landing_on_the_nose => "landing on the nose of a cushion",
    landing_on_top => "landing exactly on a ball's top",
    endless_hops => "endless hops, e_c = 0.99",
    corner_from_the_air => "into the corner from the air",
    steep_masse_in_flight => "massé at 89° and 8 m/s where balls can fly",
}

#[test]
fn every_row_of_the_table_is_a_test() {
    assert_eq!(cases().iter().map(|case| case.name).collect::<Vec<_>>(), NAMES);
}

#[test]
fn every_row_is_documented_as_holding() {
    let page = include_str!("../../docs/stability.md");
    for name in NAMES {
        let line = page.lines().find(|line| line.starts_with(&format!("| {name} |"))).expect(name);
        assert!(line.contains("| holds |"), "{line}");
    }
}

/// Shots of the table that failed once, each with the cause that it names. Some took far too many steps of resting contacts and bounces of
/// chatter: these state how many are enough.
#[test]
fn shots_that_once_failed_now_pass() {
    // One table is longer than a file may state, others are shorter.
    let name = "thesis, 1 km".to_owned();
    let kilometre = Table { name, length: 1000.0, width: 500.0, ..Table::preset("thesis").unwrap() };
    let short = ["thesis", "textbook"].map(|preset| {
        let table = Table::preset(preset).unwrap();
        let side = 6.0 * table.radius;
        Table { name: format!("{preset}, 6 by 6 radii"), length: side, width: side, ..table }
    });
    let tables: Vec<Table> = cases().iter().flat_map(|case| (case.tables)()).chain([kilometre]).chain(short).collect();
    for line in include_str!("../data/mended.jsonl").lines() {
        let line: serde_json::Value = serde_json::from_str(line).unwrap();
        let table = tables.iter().find(|table| line["table"] == table.name).expect("a table of the cases");
        let shot = Shot {
            layout: serde_json::from_value(line["layout"].clone()).unwrap(),
            cue: serde_json::from_value(line["cue"].clone()).unwrap(),
        };
        let mut trace = Trace::new(table);
        let figures = examine(table, &shot, &mut trace);
        // The run time is judged by the stability table, not here.
        let violations = figures.violations(&Limits { seconds: f64::INFINITY, ..Limits::STRICT.on(table) });
        // On a table smaller than a file may state, a shot may be given up.
        let expected = if line["exhausted"] == true { vec![Violation::Exhausted] } else { Vec::new() };
        assert_eq!(violations, expected, "{}", line["cause"]);
        let enough = line["contact_steps"].as_u64().map_or(usize::MAX, |steps| steps as usize);
        assert!(trace.contact_steps < enough, "{}: {} steps", line["cause"], trace.contact_steps);
    }
}

/// The limits of the table cases are those of a table file.
#[test]
fn the_longest_table_equals_the_limit_of_table_files() {
    let case: Case = cases().into_iter().find(|case| case.name == "the longest table, ten metres").unwrap();
    for table in (case.tables)() {
        let file = |table: &Table| Table::from_file(Path::new("own.toml"), &toml::to_string(table).unwrap());
        assert_eq!(file(&table).as_ref(), Ok(&table));
        let longer = Table { length: table.length + 1e-9, ..table };
        assert!(file(&longer).unwrap_err().to_string().contains("at most 10 m"));
    }
}

#[test]
fn no_table_of_a_case_is_refused() {
    // A table that its own check refuses is left out of its case.
    let tables: usize = cases().iter().map(|case| (case.tables)().len()).sum();
    assert_eq!(tables, 118);
}

#[test]
fn a_cloth_without_friction_is_refused() {
    let text = include_str!("../../src/table/textbook.toml");
    for (key, line) in [("mu_r", "mu_r = 0.010"), ("mu_s", "mu_s = 0.2")] {
        let error = Table::from_toml(&text.replace(line, &format!("{key} = 0"))).unwrap_err();
        assert!(matches!(&error, TableError::Value { key: refused, .. } if *refused == key));
        assert!(error.to_string().contains("accepted is 0.0001"), "{error}");
    }
}

/// The checks themselves: on a table that is smaller than the checker assumes, a shot leaves the table; balls that are placed inside each
/// other overlap.
#[test]
fn the_checks_detect_violations() {
    let table = Table::default();
    let mut trace = Trace::new(&table);
    let layout = Layout::new([DVec2::ZERO, DVec2::new(0.06, 0.0), DVec2::new(1.0, 0.5)]);
    let shot = Shot { layout, cue: CueDegrees::centre(90.0, 1.0) };
    let overlap = examine(&table, &shot, &mut trace).overlap.value;
    assert!((overlap - (2.0 * table.radius - 0.06)).abs() < 1e-12, "{overlap:e}");
    let small = Table { width: 1.0, ..table.clone() };
    let layout = Layout::new([DVec2::ZERO, DVec2::new(1.0, 0.0), DVec2::new(1.0, 0.3)]);
    let mut trace = Trace::new(&small);
    let shot = Shot { layout, cue: CueDegrees::centre(90.0, 2.0) };
    let outside = examine(&table, &shot, &mut trace).outside.value;
    assert!((outside - (table.half_width() - small.half_width())).abs() < 1e-12, "{outside:e}");
}
