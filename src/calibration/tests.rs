//! Tests of the calibration: known tables are found again, and problematic marks are reported.

use glam::DVec2;
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{
    belief::Belief,
    forward::{STROKE_PARAMETERS, StrokeSpread},
    protocol::Quantity,
    simulated::simulate_protocol,
    *,
};
use crate::table::{Rail, RailOverrides, Table, TableDoubt};

/// `match` as an unknown table, with the doubt of any table.
fn base() -> (Table, TableDoubt) {
    let table = Table { name: "own".into(), ..Table::default() };
    let doubt = TableDoubt::of(&table);
    (table, doubt)
}

/// A table that differs from `match` by about a standard deviation in the constants that a lag and slow rolls measure.
fn other(table: &Table) -> Table {
    let change = |table: Table, (name, value)| TableDoubt::with_value(&table, name, value);
    [("mu_r", 0.0064), ("e_rail", 0.825), ("tilt.y", 1.2e-3), ("mu_rail", 0.27)].into_iter().fold(table.clone(), change)
}

/// Every test as often as requested, with exactly the requested strokes and exact marks.
fn exact(table: &Table) -> Vec<(usize, Trial)> {
    exact_from(table, false)
}

/// The same from one end of the table or the other.
fn exact_from(table: &Table, is_turned: bool) -> Vec<(usize, Trial)> {
    let tests = PROTOCOL.iter().flat_map(|test| std::iter::repeat_n(test, test.repetitions));
    let trial = |test: &'static Test| {
        let seen = StrokeSpread::ASSUMED.simulate_marks(table, test, is_turned, &[0.0; STROKE_PARAMETERS]);
        let readings = seen.iter().zip(test.marks).enumerate().map(|(mark, (seen, kind))| Reading {
            mark,
            value: seen.unwrap_or_else(|| panic!("{} {} is never reached", test.name, kind.name)),
            standard_error: kind.standard_error,
        });
        Trial { test, is_turned, readings: readings.collect() }
    };
    tests.map(trial).enumerate().collect()
}

#[test]
fn a_certain_zero_tilt_stays_zero() {
    let (mut table, mut doubt) = base();
    table.tilt = DVec2::ZERO;
    let tilt = |doubt: &TableDoubt| {
        let belief = Belief::new(&table, doubt).unwrap();
        belief.table(&vec![0.0; belief.count()]).tilt
    };
    assert!(tilt(&doubt).length() > 0.0, "an uncertain tilt must be measurable");
    doubt.deviations.retain(|name, _| !name.starts_with("tilt"));
    doubt.correlations.clear();
    assert_eq!(tilt(&doubt), DVec2::ZERO);
}

#[test]
fn exact_marks_recover_the_true_table() {
    let (table, doubt) = base();
    let truth = other(&table);
    let found = calibrate("club", &table, &doubt, &exact(&truth)).unwrap();
    assert!(found.mark_checks.iter().all(|check| check.off.abs() < 1.0), "{:?}", found.mark_checks);
    assert!(found.misread().is_empty() && !found.is_contradictory());
    for change in &found.constants {
        let expected = TableDoubt::value(&truth, &change.name).unwrap();
        let off = (change.after - expected).abs() / change.after_deviation;
        assert!(off < 1.5, "{}: {} for {expected}, {off} deviations", change.name, change.after);
        assert!(change.after_deviation <= 1.01 * change.before_deviation, "{change:?}");
    }
    let change = |name: &str| found.constants.iter().find(|change| change.name == name).unwrap();
    let roll = change("mu_r");
    assert!(roll.after_deviation < 0.2 * roll.before_deviation && (roll.after - 0.0064).abs() < 1e-4, "{roll:?}");
    // No test measures how a ball slides, so the prior remains.
    let slide = change("mu_s");
    assert!(slide.after_deviation > 0.9 * slide.before_deviation, "{slide:?}");
    // The table survives a round trip through its file.
    assert_eq!(found.table.name, "club");
    assert_eq!(Table::from_toml(&toml::to_string(&found.table).unwrap()).unwrap(), found.table);
    assert!(!found.table.doubt.as_ref().unwrap().correlations.is_empty());
}

#[test]
fn a_shifted_start_moves_correlated_constants() {
    let (table, mut doubt) = base();
    doubt.correlations = vec![("mu_rail".to_owned(), "rail.kappa".to_owned(), -0.6)];
    let belief = Belief::new(&table, &doubt).unwrap();
    let values = belief.values(&belief.unknowns_at("rail.kappa", 1.5).unwrap());
    for ((name, mean, deviation), value) in belief.constants().zip(values) {
        let expected = match name {
            "rail.kappa" => 1.5,
            "mu_rail" => -0.9,
            _ => 0.0,
        };
        assert!((value - mean - expected * deviation).abs() < 1e-9 * deviation, "{name}: {value}");
    }
    assert!(belief.unknowns_at("rail.left.e", 1.0).is_none());
}

#[test]
fn intervals_cover_the_truth_for_a_club_player() {
    let (table, doubt) = base();
    let coverage = coverage(&table, &doubt, 6, 8).unwrap();
    let held: usize = coverage.iter().map(|one| one.held).sum();
    // Of 84 intervals about four may miss the truth, more if one table is unusual.
    assert!(held >= 74, "{coverage:?}");
    assert!(coverage.iter().all(|one| one.after < 1.01 * one.before), "{coverage:?}");
}

#[test]
fn a_misread_mark_is_reported_and_hardly_counts() {
    let (table, doubt) = base();
    let truth = other(&table);
    let mut trials = exact(&truth);
    // In the second slow roll the watch was stopped three seconds late.
    trials[1].1.readings[0].value += 3.0;
    let found = calibrate("club", &table, &doubt, &trials).unwrap();
    assert_eq!(found.misread(), [2]);
    let check = found.mark_checks.iter().find(|check| check.misread).unwrap();
    let (expected, deviation) = check.expected.unwrap();
    assert_eq!((check.test, check.mark), ("slow-roll", "time"));
    assert!((check.marked - 3.0 - expected).abs() < 0.3 && deviation < 0.3, "{check:?}");
    for change in &found.constants {
        let expected = TableDoubt::value(&truth, &change.name).unwrap();
        assert!((change.after - expected).abs() < 2.0 * change.after_deviation, "{change:?} for {expected}");
    }
}

/// Earlier, marks of a wrong stroke counted if they did not contradict the others, so that the constants seemed more certain.
#[test]
fn strokes_with_mostly_misread_marks_are_left_out() {
    let (table, doubt) = base();
    let mut strokes = exact(&other(&table));
    let mut wrong = strokes.iter().find(|(_, trial)| trial.test.name == "lag").unwrap().clone();
    strokes.truncate(3);
    let alone = calibrate("club", &table, &doubt, &strokes).unwrap();
    assert!(alone.left_out.is_empty());
    wrong.0 = strokes.len();
    (wrong.1.readings[0].value, wrong.1.readings[1].value) = (0.5, 60.0);
    strokes.push(wrong.clone());
    let both = calibrate("club", &table, &doubt, &strokes).unwrap();
    assert_eq!(both.left_out, [wrong.0 + 1]);
    assert!(!both.is_contradictory());
    assert_eq!((&both.constants, &both.next), (&alone.constants, &alone.next));
    let text = both.agreement(|trial, test| format!("stroke {trial} of {test}"));
    let other = format!(
        "most marks of stroke {} of lag look misread: it was another stroke, and nothing of it counts",
        wrong.0 + 1
    );
    assert_eq!(text, format!("the other marks agree with each other; {other}"));
    // Its marks do not count either if there is no other stroke.
    let nothing = calibrate("club", &table, &doubt, &[wrong]).unwrap();
    for change in &nothing.constants {
        assert!((change.after_deviation / change.before_deviation - 1.0).abs() < 1e-6, "{change:?}");
    }
}

/// Earlier, a watch left running for a minute pulled the constants towards it, and made them less certain than without the stroke.
#[test]
fn one_absurd_mark_does_not_distort_the_estimate() {
    let (table, doubt) = base();
    let found = |rests: &[f64]| {
        let lag = |rest: &f64| {
            let marks = [("lap", 4.5), ("rest", *rest), ("stop", 3.4)];
            let marks = marks.map(|(name, value)| (name.to_owned(), MarkValue::Number(value))).into();
            Entry { test: "lag".into(), marks, ..Entry::default() }
        };
        let entries = Entries { name: None, trials: rests.iter().map(lag).collect() };
        calibrate("club", &table, &doubt, &entries.trials(&table).0).unwrap()
    };
    let (alone, late) = (found(&[8.2]), found(&[8.2, 60.0]));
    assert_eq!((late.misread(), &late.left_out), (vec![2], &Vec::new()));
    for (one, other) in late.constants.iter().zip(&alone.constants) {
        assert!((one.after - other.after).abs() < 0.3 * other.after_deviation, "{one:?} {other:?}");
        assert!(one.after_deviation < 1.05 * other.after_deviation, "{one:?} {other:?}");
    }
}

#[test]
fn marks_that_need_another_stroke_are_reported() {
    let (table, doubt) = base();
    let mut trials = exact(&table);
    let corner = trials.iter().rposition(|(_, trial)| trial.test.name == "corner-five").unwrap();
    // The mark at the first rail determines the direction, so only another tip position explains the rest.
    trials[corner].1.readings[1].value -= 1.5;
    let found = calibrate("club", &table, &doubt, &trials).unwrap();
    let is_reported =
        found.outlier_strokes.iter().any(|stroke| stroke.trial == corner + 1) || found.misread() == [corner + 1];
    assert!(is_reported, "{:?} {:?}", found.outlier_strokes, found.mark_checks);
    assert!(calibrate("club", &table, &doubt, &exact(&table)).unwrap().outlier_strokes.is_empty());
}

#[test]
fn marks_that_contradict_each_other_are_reported() {
    let (table, doubt) = base();
    let trial = |time: f64| Entry {
        test: "slow-roll".into(),
        marks: [("time".to_owned(), MarkValue::Number(time)), ("stop".to_owned(), MarkValue::Number(5.0))].into(),
        ..Entry::default()
    };
    let entries = Entries { name: None, trials: [5.0, 9.0, 16.0].map(trial).into() };
    let (trials, odd) = entries.trials(&table);
    assert_eq!(odd, []);
    let found = calibrate("club", &table, &doubt, &trials).unwrap();
    assert!(found.is_contradictory(), "{:?}", found.mark_checks);
    let text = found.agreement(|trial, test| format!("stroke {trial} of {test}"));
    for trial in found.misread() {
        assert!(text.contains(&format!("stroke {trial} of slow-roll")), "{text}");
    }
    assert!(found.constants.iter().all(|change| found.certainty(change) == "unsure"));
}

#[test]
fn an_incomplete_file_lists_its_missing_strokes() {
    let (table, doubt) = base();
    let text = "name = \"club\"\n[[trial]]\ntest = \"slow-roll\"\ntime = 9.0\nstop = \"1900 mm\"\nsure = { time = 0.3 }\n\
                [[trial]]\ntest = \"lag\"\n[[trial]]\ntest = \"hard-lag\"\nstop = 3.2\n[[trial]]\ntest = \"masse\"\nx = 1\n";
    let entries = Entries::parse(text).unwrap();
    let (trials, odd) = entries.trials(&table);
    assert_eq!((trials.len(), trials[0].0), (1, 0));
    let stop = trials[0].1.readings[1];
    assert!((stop.value - 1.9 / table.diamond()).abs() < 1e-12 && stop.standard_error < 0.02, "by tape: {stop:?}");
    let problems: Vec<String> = odd.iter().map(ToString::to_string).collect();
    assert!(problems[0].starts_with("trial 2 (lag): nothing is marked yet"), "{problems:?}");
    assert!(problems[1].contains("hard-lag") && problems[1].contains("rails = 5"), "{problems:?}");
    assert!(problems[2].contains("masse") && problems[2].contains("corner-five"), "{problems:?}");
    let found = calibrate("club", &table, &doubt, &trials).unwrap();
    let known = |name: &str| {
        let change = found.constants.iter().find(|change| change.name == name).unwrap();
        change.after_deviation / change.before_deviation
    };
    assert!(known("mu_r") < 0.5 && (known("mu_b") - 1.0).abs() < 1e-6, "{:?}", found.constants);
    assert!(entries.missing().iter().any(|(test, strokes)| test.name == "slow-roll" && *strokes == 1));
    assert!(matches!(calibrate("club", &table, &doubt, &[]), Err(CalibrationError::Nothing)));
    let many = calibrate("club", &table, &doubt, &vec![trials[0].clone(); 61]);
    assert!(many.unwrap_err().to_string().contains("61 trials; accepted are at most 60"));
    let certain = calibrate("club", &table, &TableDoubt::default(), &trials);
    assert!(matches!(certain, Err(CalibrationError::Certain(_))));
}

#[test]
fn problematic_marks_are_reported_with_the_accepted_values() {
    let table = Table::default();
    let problems = |marks: &str| {
        let entries = Entries::parse(&format!("[[trial]]\ntest = \"lag\"\n{marks}\n")).unwrap();
        let (_, odd) = entries.trials(&table);
        odd.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
    };
    for (marks, expected) in [
        ("stop = 9.2", "trial 1 (lag): stop = 9.2: no ball can be there; accepted is 0 to 8 diamonds"),
        ("rest = 240", "no ball rolls that long, so the stopwatch was left running; accepted is"),
        ("lap = 0.05", "nobody stops a watch that fast"),
        ("lap = -3", "lap = -3"),
        ("lap = nan", "lap = NaN"),
        ("lap = \"3 mm\"", "is no time; accepted is a number of seconds"),
        ("stop = \"far\"", "\"412 mm\""),
        ("stopp = 3", "no mark \"stopp\"; its marks are lap, rest, stop"),
        ("stop = 3\nrails = 40", "rails = 40: nobody strikes that hard"),
        ("stop = 3\nsure = { stop = 0 }", "stop ~ 0: how sure a mark is must be above 0"),
    ] {
        assert!(problems(marks).contains(expected), "{marks}: {}", problems(marks));
    }
    assert_eq!(problems("lap = 4.4\nstop = 3"), "");
    let hit = Entries::parse("[[trial]]\ntest = \"full-hit\"\nobject = 6.5\nrails = 1\n").unwrap();
    assert!(hit.trials(&table).1[0].to_string().contains("(full-hit): rails = 1: no ball may meet a rail"));
    let wrong = Entries::parse("[[trial]]\ntest = 3").unwrap_err();
    assert!(wrong.contains("line") && wrong.contains("string"), "{wrong}");
    for list in ["[[trial]]\ntest = \"lag\"\nstop = [3]", r#"{"trial": [{"test": "lag", "stop": [3]}]}"#] {
        let wrong = Entries::parse(list).unwrap_err();
        assert!(wrong.contains("expected a number, or a text like \"412 mm\""), "{wrong}");
    }
}

#[test]
fn a_mark_at_a_rail_counts_no_rail_hit() {
    let (table, doubt) = base();
    let text = "[[trial]]\ntest = \"full-hit\"\nobject = 8\n[[trial]]\ntest = \"slow-back\"\nstop = 0\ndrift = 4\n";
    let trials = Entries::parse(text).unwrap().trials(&table).0;
    let radius = table.radius / table.diamond();
    let positions = trials.iter().map(|(_, trial)| trial.test.position(&table, trial.readings[0].value));
    let [(rails, far), (turned, near)] = positions.collect::<Vec<_>>()[..] else { panic!("{trials:?}") };
    assert_eq!((rails, turned), (0, 0));
    assert!((far - (8.0 - radius)).abs() < 1e-12 && (near - radius).abs() < 1e-12, "{far} {near}");
    assert!((trials[1].1.readings[1].value - (4.0 - radius)).abs() < 1e-12);
    let found = calibrate("club", &table, &doubt, &trials[..1]).unwrap();
    assert_eq!(found.mark_checks[0].rails.unwrap().0, 0, "{:?}", found.mark_checks);
}

#[test]
fn certain_constants_have_no_correlations() {
    let (table, doubt) = base();
    let belief = Belief::new(&table, &doubt).unwrap();
    let mut covariance = vec![vec![0.0; belief.count()]; belief.count()];
    covariance[1][1] = 1e-4;
    (covariance[0][1], covariance[1][0]) = (1e-9, 1e-9);
    let result = belief.doubt(&covariance);
    assert_eq!(result.correlations, []);
    result.validate().unwrap();
    // Correlations that contradict each other are shrunk until they are valid.
    for (row, line) in covariance.iter_mut().enumerate() {
        line.fill(-1e-4);
        line[row] = 1e-4;
    }
    belief.doubt(&covariance).validate().unwrap();
}

#[test]
fn entries_survive_a_round_trip_in_toml_and_json() {
    let text =
        "[[trial]]\ntest = \"hard-lag\"\nrails = 5\nlengths = 2.6\nstop = \"1100 mm\"\nsure = { lengths = 0.2 }\n";
    let entries = Entries::parse(text).unwrap();
    assert_eq!(Entries::parse(&toml::to_string(&entries).unwrap()).unwrap(), entries);
    assert_eq!(Entries::parse(&serde_json::to_string(&entries).unwrap()).unwrap(), entries);
}

#[test]
fn travel_and_position_are_inverse_over_several_rails() {
    let table = Table::default();
    for test in ["lag", "slow-back"].map(|name| Test::named(name).unwrap()) {
        for travel in [0.5, 3.0, 7.8, 8.3, 15.0, 17.2, 30.0] {
            let (rails, position) = test.position(&table, travel);
            let again = test.travel(&table, rails, position);
            assert!((again - travel).abs() < 1e-12 && (0.0..=8.0).contains(&position), "{travel}");
        }
    }
    let lag = Test::named("lag").unwrap();
    assert_eq!(lag.position(&table, 3.0), (0, 3.0));
    assert_eq!(Test::named("slow-back").unwrap().position(&table, 3.0), (0, 5.0));
    let drawn = simulate_protocol(&table, &mut Xoshiro256PlusPlus::seed_from_u64(3));
    let stops =
        drawn.iter().flat_map(|trial| trial.readings.iter().map(|reading| trial.test.marks[reading.mark].quantity));
    assert!(stops.filter(|quantity| matches!(quantity, Quantity::StopAlong(_))).count() >= 9);
}

#[test]
fn every_test_can_be_played() {
    let table = Table::default();
    for test in PROTOCOL {
        let (cue, layout) = StrokeSpread::ASSUMED.stroke(&table, test, &[0.0; STROKE_PARAMETERS]);
        cue.validate().unwrap();
        assert!(!cue.is_miscue(&table), "{}", test.name);
        for (index, ball) in layout.balls.iter().enumerate().filter(|(_, ball)| ball.x.abs() < 10.0) {
            assert!(ball.abs().cmple(table.reach()).all(), "{} ball {index}", test.name);
        }
    }
}

#[test]
fn a_slower_day_changes_mostly_weather_constants() {
    let (table, doubt) = base();
    let known = calibrate("club", &table, &doubt, &exact(&table)).unwrap().table;
    let before = known.doubt.clone().unwrap();
    let after = next_day_doubt(&known, &before);
    after.validate().unwrap();
    assert!(after.deviations["mu_r"] > before.deviations["mu_r"]);
    assert_eq!(after.deviations["m_end"], before.deviations["m_end"]);
    let damp = TableDoubt::with_value(&known, "mu_r", 1.25 * TableDoubt::value(&known, "mu_r").unwrap());
    let today: Vec<_> = exact(&damp).into_iter().filter(|(_, trial)| DAILY_TESTS.contains(&trial.test.name)).collect();
    let found = calibrate("club", &known, &after, &today).unwrap();
    let text = TablePlay::of(&found.table).describe_change_from(&TablePlay::of(&known));
    assert!(text.contains("a lag rolls shorter"), "{text}");
    let roll = found.constants.iter().find(|change| change.name == "mu_r").unwrap();
    assert!(roll.after > 1.1 * roll.before, "{roll:?}");
}

#[test]
fn weather_changes_single_rails_like_all_rails() {
    let (mut table, mut doubt) = base();
    *table.rail.overrides_mut(Rail::Top) = Some(RailOverrides { e: Some(0.8), ..RailOverrides::default() });
    doubt.deviations.insert("rail.top.e".to_owned(), 0.008);
    let after = next_day_doubt(&table, &doubt);
    after.validate().unwrap();
    let [all, own] = ["e_rail", "rail.top.e"].map(|name| after.deviations[name]);
    assert!((own - 0.008_f64.hypot(0.01)).abs() < 1e-12, "{own}");
    let together =
        after.correlations.iter().find(|(one, other, _)| one == "e_rail" && other == "rail.top.e").unwrap().2;
    assert!((together - 1e-4 / (all * own)).abs() < 1e-12, "{together}");
}

#[test]
fn rails_with_certain_values_of_their_own_allow_a_daily_check() {
    let (mut table, doubt) = base();
    for rail in [Rail::Top, Rail::Bottom] {
        *table.rail.overrides_mut(rail) = Some(RailOverrides { e: Some(0.8), ..RailOverrides::default() });
    }
    let after = next_day_doubt(&table, &doubt);
    after.validate().unwrap();
    after.factor(&["e_rail", "rail.top.e", "rail.bottom.e"]).unwrap();
}

#[test]
fn a_single_misread_stroke_makes_no_table() {
    let (table, doubt) = base();
    let mut trial = exact(&table).into_iter().find(|(_, trial)| trial.test.name == "lag").unwrap();
    for reading in &mut trial.1.readings {
        reading.value *= 6.0;
    }
    let found = calibrate("club", &table, &doubt, &[trial]).unwrap();
    assert!(found.is_contradictory());
    assert_eq!(
        found.agreement(|_, test| test.to_owned()),
        "most marks of lag look misread, and no other stroke tells which: play it again, or delete it"
    );
}

/// Earlier such a calibration was saved, although a third or more of its strokes looked misread.
#[test]
fn one_misread_stroke_of_two_makes_no_table() {
    let (table, doubt) = base();
    let mut trials = exact(&other(&table));
    trials.truncate(2);
    trials[1].1.readings[0].value += 3.0;
    let found = calibrate("club", &table, &doubt, &trials).unwrap();
    assert_eq!(found.misread().len(), 1, "{:?}", found.mark_checks);
    assert!(found.is_contradictory());
    let text = found.agreement(|trial, test| format!("stroke {trial} of {test}"));
    assert!(text.ends_with("of slow-roll contradicts the others, and too few tell which is right: play more strokes, or delete the wrong one"), "{text}");
}

#[test]
fn one_misread_mark_leaves_the_stroke_usable() {
    let (table, doubt) = base();
    let mut trial = exact(&table).into_iter().find(|(_, trial)| trial.test.name == "slow-roll").unwrap();
    let drift = trial.1.test.marks.iter().position(|mark| mark.name == "drift").unwrap();
    trial.1.readings.iter_mut().find(|reading| reading.mark == drift).unwrap().value += 1.0;
    let found = calibrate("club", &table, &doubt, &[trial]).unwrap();
    assert_eq!((found.misread().len(), found.left_out.len()), (1, 0), "{:?}", found.mark_checks);
    assert!(!found.is_contradictory());
}

/// Every test from both ends.
fn both(truth: &Table) -> Vec<(usize, Trial)> {
    let trials = [false, true].into_iter().flat_map(|is_turned| exact_from(truth, is_turned));
    trials.enumerate().map(|(number, (_, trial))| (number, trial)).collect()
}

#[test]
fn tests_from_both_ends_reveal_a_differing_rail() {
    let (table, doubt) = base();
    let mut truth = table.clone();
    *truth.rail.overrides_mut(Rail::Top) =
        Some(RailOverrides { e: Some(table.rail_restitution - 0.08), ..RailOverrides::default() });
    let found = calibrate("club", &table, &doubt, &both(&truth)).unwrap();
    let texts = found.differing_rails();
    assert_eq!(texts.len(), 1, "{texts:?}");
    assert!(texts[0].starts_with("the left long rail (top) is unlike the others: it gives back less (0."), "{texts:?}");
    let own = found.table.rail.top.unwrap().e.unwrap();
    let deviation = found.table.doubt.as_ref().unwrap().deviations["rail.top.e"];
    assert!((own - truth.rail.top.unwrap().e.unwrap()).abs() < 2.0 * deviation, "{own} ± {deviation}");
    assert!(deviation < 0.035 && found.table.rail.bottom.is_none(), "{deviation}");
    assert_eq!(Table::from_toml(&toml::to_string(&found.table).unwrap()).unwrap(), found.table);
    // Equal rails keep common constants, and tests from one end alone do not distinguish rails.
    assert_eq!(calibrate("club", &table, &doubt, &both(&table)).unwrap().differing_rails(), [""; 0]);
    assert_eq!(calibrate("club", &table, &doubt, &exact(&truth)).unwrap().table.rail.top, None);
}

#[test]
fn tests_from_the_far_end_hit_the_opposite_rails() {
    let text = "[[trial]]\ntest = \"lag\"\nfar-end = true\nlap = 2.6\n";
    let entries = Entries::parse(text).unwrap();
    assert_eq!(toml::to_string(&entries).unwrap(), text);
    let (table, _) = base();
    assert!(entries.trials(&table).0[0].1.is_turned);
    let mut entry = Entry { test: "lag".into(), ..Entry::default() };
    entry.set_field(FAR_END, "yes").unwrap();
    assert!(entry.far_end && entry.field_text(FAR_END) == "yes");
    assert!(entry.set_field(FAR_END, "maybe").unwrap_err().contains("accepted are yes and no"));
    let table = Table { tilt: glam::DVec2::new(1e-3, -5e-4), ..table };
    let mut leaning = table.clone();
    leaning.rail.left = Some(RailOverrides { e: Some(0.7), ..RailOverrides::default() });
    let [near, far] = [false, true].map(|is_turned| exact_from(&leaning, is_turned)[4].1.readings[0].value);
    assert_ne!(near, far);
    assert_eq!(leaning.seen_from_other_end().seen_from_other_end(), leaning);
    assert_eq!(leaning.seen_from_other_end().rail.right, leaning.rail.left);
}

#[test]
fn stroke_descriptions_match_the_tip_position() {
    for test in PROTOCOL {
        let [_, height, ..] = test.cue;
        let expected = match height {
            0.0 => "",
            0.4 => "four tips",
            _ => "two ",
        };
        let is_said = test.strike.contains(expected) && test.strike.contains(" above centre") != expected.is_empty();
        assert!(is_said && !test.strike.contains("a little"), "{}: {}", test.name, test.strike);
    }
}
