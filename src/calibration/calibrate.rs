//! Calibrates the player's own table from trials: its constants with their doubts, a verdict on each mark, and the best next tests.

use serde::Serialize;

use super::{
    belief::Belief,
    estimate::{Estimate, Trial, estimate, standardized_residuals},
    forward::STROKE_PARAMETERS,
    information::information,
    protocol::{PROTOCOL, Quantity, Test},
    rails::distinct_rails,
    robust::misread_probability,
};
use crate::{
    statistics::identity,
    table::{DoubtError, Table, TableDoubt, TableError},
};

/// Limit on the number of trials: the time of the fit grows with its cube.
const MAX_TRIALS: usize = 60;

/// Standard deviations from the requested stroke above which a stroke counts as strange.
const OUTLIER_THRESHOLD: f64 = 2.5;

/// Names of the numbers of a stroke, in their order.
const STROKE_PARAMETER_NAMES: [&str; STROKE_PARAMETERS] =
    ["speed", "direction", "tip to the side", "height of the tip", "elevation", "line of the balls"];

/// A calibrated table.
#[derive(Clone, Debug, Serialize)]
pub struct Calibration {
    /// The table, with its doubt.
    pub table: Table,
    /// Name of the prior table.
    #[serde(skip)]
    pub prior_name: String,
    /// The constants before and after.
    pub constants: Vec<Change>,
    /// The marks, in the order of the trials.
    #[serde(rename = "marks")]
    pub mark_checks: Vec<MarkCheck>,
    /// Numbers, from 1 on, of trials with mostly misread marks: none of their marks counts.
    pub left_out: Vec<usize>,
    /// Strokes that must have been far from the requested ones, if the marks are right.
    #[serde(rename = "strange")]
    pub outlier_strokes: Vec<OutlierStroke>,
    /// All tests, the most informative first.
    pub next: Vec<NextTest>,
}

/// A constant before and after.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Change {
    /// Name of the constant in a table's file.
    pub name: String,
    /// Prior mean.
    pub before: f64,
    /// Prior standard deviation.
    pub before_deviation: f64,
    /// Posterior mean.
    pub after: f64,
    /// Posterior standard deviation.
    pub after_deviation: f64,
}

/// Agreement of a mark with the other marks.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MarkCheck {
    /// Number of the trial, from 1 on.
    pub trial: usize,
    /// Name of its test.
    pub test: &'static str,
    /// Name of the mark.
    pub mark: &'static str,
    /// The marked value, in the mark's unit.
    pub marked: f64,
    /// Difference from the expected value, in standard errors of the mark.
    pub off: f64,
    /// Whether the mark looks misread.
    pub misread: bool,
    /// Expected value of a mark that looks misread, and its standard deviation; `None` if no stroke leads there.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub expected: Option<(f64, f64)>,
    /// Short rails hit before the ball stopped, according to the mark and to the expectation; only for marks of stopped balls.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rails: Option<(usize, usize)>,
}

/// A stroke that fits its marks only if it was far from the requested one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct OutlierStroke {
    /// Number of the trial, from 1 on.
    pub trial: usize,
    /// Name of its test.
    pub test: &'static str,
    /// The quantity that differed.
    pub what: &'static str,
    /// The difference, in the standard deviations that are assumed for every player.
    pub off: f64,
}

/// A test that may be played next.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct NextTest {
    /// Name of the test.
    pub test: &'static str,
    /// Expected information of one more stroke about the table, bits.
    pub bits: f64,
}

/// A calibration is not possible.
#[derive(Debug, thiserror::Error)]
pub enum CalibrationError {
    /// There is nothing to calibrate with.
    #[error("there is no mark that can be used; carom calibrate --tests shows what to play and what to mark")]
    Nothing,
    /// There are more strokes than can be fitted in a reasonable time.
    #[error("there are {0} trials; accepted are at most {MAX_TRIALS}, three times as many as the tests ask for")]
    TooMany(usize),
    /// The table has no uncertain constant.
    #[error(
        "the table \"{0}\" has no constant in doubt that a calibration could find; use match or a table file of your own"
    )]
    Certain(String),
    /// The doubt is not valid.
    #[error(transparent)]
    Doubt(#[from] DoubtError),
    /// The result is not a valid table.
    #[error("the marks lead to an impossible table: {0}")]
    Table(#[from] TableError),
}

/// Calibrates the table from these trials, each with its number in the file, with `table` and `doubt` as the prior. The result is called
/// `name`.
///
/// # Errors
/// [`CalibrationError`] if the trials or the doubt do not allow a calibration.
pub fn calibrate(
    name: &str,
    table: &Table,
    doubt: &TableDoubt,
    trials: &[(usize, Trial)],
) -> Result<Calibration, CalibrationError> {
    if Belief::new(table, doubt)?.count() == 0 {
        return Err(CalibrationError::Certain(table.name.clone()));
    }
    if trials.is_empty() {
        return Err(CalibrationError::Nothing);
    }
    if trials.len() > MAX_TRIALS {
        return Err(CalibrationError::TooMany(trials.len()));
    }
    let (numbers, trials): (Vec<usize>, Vec<Trial>) = trials.iter().cloned().unzip();
    let (belief, found) = fit(table, doubt, &trials)?;
    let fitted = belief.table(&found.most_probable);
    let (mut mark_checks, mut kept, mut left_out) = (Vec::new(), Vec::new(), Vec::new());
    for (index, trial) in trials.iter().enumerate() {
        let all = standardized_residuals(&fitted, trial, &found.strokes[index]);
        // If most marks of a stroke are wrong, it was another stroke, and its other marks contain no information.
        if 2 * all.iter().filter(|off| misread_probability(**off) > 0.5).count() > all.len() {
            left_out.push(numbers[index] + 1);
        } else {
            kept.push(trial.clone());
        }
        for (reading, off) in trial.readings.iter().zip(all) {
            let mark = &trial.test.marks[reading.mark];
            let is_misread = misread_probability(off) > 0.5;
            let expected = is_misread.then(|| found.expected(&belief, &trials, index, reading.mark)).flatten();
            let is_stop = matches!(mark.quantity, Quantity::StopAlong(_));
            let position = |value: f64| if is_stop { trial.test.position(table, value) } else { (0, value) };
            let (rails, marked) = position(reading.value);
            mark_checks.push(MarkCheck {
                trial: numbers[index] + 1,
                test: trial.test.name,
                mark: mark.name,
                marked,
                off: -off,
                misread: is_misread,
                expected: expected.map(|(value, deviation)| (position(value).1, deviation)),
                rails: is_stop.then(|| (rails, expected.map_or(rails, |(value, _)| position(value).0))),
            });
        }
    }
    let mut outlier_strokes = Vec::new();
    for ((number, trial), stroke) in numbers.iter().zip(&trials).zip(&found.strokes) {
        let far = stroke.iter().zip(STROKE_PARAMETER_NAMES).filter(|(off, _)| off.abs() > OUTLIER_THRESHOLD);
        outlier_strokes.extend(far.map(|(off, what)| OutlierStroke {
            trial: number + 1,
            test: trial.test.name,
            what,
            off: *off,
        }));
    }
    let (belief, found) = if left_out.is_empty() { (belief, found) } else { fit(table, doubt, &kept)? };
    let covariance = belief.covariance(&found.covariance);
    let doubt = belief.doubt(&covariance);
    let after = belief.without_level(belief.table(&found.unknowns), &doubt);
    let after = Table { name: name.to_owned(), doubt: Some(doubt), ..after };
    let after = Table::from_toml(&toml::to_string(&after).map_err(|error| TableError::Syntax(error.to_string()))?)?;
    let change = |(index, (name, before, before_deviation)): (usize, (&str, f64, f64))| Change {
        name: name.to_owned(),
        before: belief.mean_before(name, before),
        before_deviation,
        after: TableDoubt::value(&after, name).unwrap_or(before),
        after_deviation: covariance[index][index].max(0.0).sqrt(),
    };
    let constants = belief.constants().enumerate().map(change).collect();
    let next = rank_tests(&belief, &found.unknowns, &found.covariance);
    Ok(Calibration {
        table: after,
        prior_name: table.name.clone(),
        constants,
        mark_checks,
        left_out,
        outlier_strokes,
        next,
    })
}

/// Estimates the table from the trials and returns its belief, too; a rail that differs from the others gets its own constants.
fn fit(table: &Table, doubt: &TableDoubt, trials: &[Trial]) -> Result<(Belief, Estimate), CalibrationError> {
    if let Some(with_distinct_rails) = distinct_rails(table, doubt, trials)? {
        return Ok(with_distinct_rails);
    }
    let belief = Belief::new(table, doubt)?;
    let found = estimate(&belief, trials);
    Ok((belief, found))
}

/// Returns the doubt about a table before its calibration: that of its file, or the spread between tables. The precise constants of
/// `match` apply to the filmed table only, so the table loses its name here.
pub fn prior(table: &Table) -> TableDoubt {
    TableDoubt::of(&Table { name: String::new(), ..table.clone() })
}

/// Returns all tests before any trial, the most informative first.
///
/// # Errors
/// Fails if the doubt is not valid, or if the table has no uncertain constant.
pub fn rank_tests_before_trials(table: &Table, doubt: &TableDoubt) -> Result<Vec<NextTest>, CalibrationError> {
    let belief = Belief::new(table, doubt)?;
    let count = belief.count();
    if count == 0 {
        return Err(CalibrationError::Certain(table.name.clone()));
    }
    Ok(rank_tests(&belief, &vec![0.0; count], &identity(count)))
}

fn rank_tests(belief: &Belief, unknowns: &[f64], covariance: &[Vec<f64>]) -> Vec<NextTest> {
    let bits =
        |test: &'static Test| NextTest { test: test.name, bits: information(belief, unknowns, covariance, test) };
    let mut next: Vec<NextTest> = PROTOCOL.iter().map(bits).collect();
    next.sort_by(|one, other| other.bits.total_cmp(&one.bits));
    next
}

impl Calibration {
    /// Returns the numbers of the trials with a mark that looks misread, in order.
    pub fn misread(&self) -> Vec<usize> {
        let mut trials: Vec<usize> = self.mark_checks.iter().filter(|one| one.misread).map(|one| one.trial).collect();
        trials.dedup();
        trials
    }

    /// Whether all trials are left out, or a third or more of several trials look misread: they contradict each other.
    pub fn is_contradictory(&self) -> bool {
        let mut trials: Vec<usize> = self.mark_checks.iter().map(|one| one.trial).collect();
        trials.dedup();
        let misread = self.misread().len();
        self.left_out.len() == trials.len() || trials.len() > 1 && 3 * misread >= trials.len()
    }
}
