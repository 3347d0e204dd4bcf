//! From trials to a table of the player's own, with its doubts, what speaks against which mark, and what to play next.

use serde::Serialize;

use super::{
    belief::Belief,
    estimate::{Estimate, Trial, estimate, off},
    forward::STROKE,
    information::information,
    protocol::{PROTOCOL, Quantity, Test},
    rails::told_apart,
    robust::misread,
};
use crate::{
    statistics::identity,
    table::{DoubtError, Table, TableDoubt, TableError},
};

/// Most trials: the time that the fit takes grows with their cube.
const MOST: usize = 60;

/// From so many deviations on, a stroke is far from what was asked for.
const FAR: f64 = 2.5;

/// What the numbers of a stroke are, in their order.
const STROKES: [&str; STROKE] =
    ["speed", "direction", "tip to the side", "height of the tip", "elevation", "line of the balls"];

/// A calibrated table.
#[derive(Clone, Debug, Serialize)]
pub struct Calibration {
    /// The table, with its doubt.
    pub table: Table,
    /// What the table was called that it was held to be before.
    #[serde(skip)]
    pub before: String,
    /// Its constants.
    pub constants: Vec<Change>,
    /// The marks, in the order of the trials.
    #[serde(rename = "marks")]
    pub verdicts: Vec<Verdict>,
    /// Trials, from 1 on, of which most marks look misread: nothing of them counts.
    pub left_out: Vec<usize>,
    /// Strokes that must have been far from what the tests ask for, if the marks are right.
    pub strange: Vec<Strange>,
    /// All tests, the one that tells most first.
    pub next: Vec<Next>,
}

/// A constant before and after.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Change {
    /// Its name in a table's file.
    pub name: String,
    /// What was held of it.
    pub before: f64,
    /// How far that could be off.
    pub before_deviation: f64,
    /// What the trials say.
    pub after: f64,
    /// How far that can be off.
    pub after_deviation: f64,
}

/// What the other marks say of one.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Verdict {
    /// Which trial, from 1 on.
    pub trial: usize,
    /// Its test.
    pub test: &'static str,
    /// The mark.
    pub mark: &'static str,
    /// What was marked, in the mark's unit.
    pub marked: f64,
    /// How far it is from what was expected, in its standard errors.
    pub off: f64,
    /// Whether it looks misread.
    pub misread: bool,
    /// What was expected of a mark that looks misread, and its deviation; none where no stroke comes there.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub expected: Option<(f64, f64)>,
    /// Short rails before the ball stopped as it was marked, and as it was expected; of places where balls stop.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rails: Option<(usize, usize)>,
}

/// A stroke that the marks only fit if it was far from what its test asks for.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Strange {
    /// Which trial, from 1 on.
    pub trial: usize,
    /// Its test.
    pub test: &'static str,
    /// What was different.
    pub what: &'static str,
    /// By how many of the deviations that are assumed of any player.
    pub off: f64,
}

/// A test that may be played next.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Next {
    /// Its name.
    pub test: &'static str,
    /// Bits that one more stroke of it is expected to tell of the table.
    pub bits: f64,
}

/// Why there is no calibration.
#[derive(Debug, thiserror::Error)]
pub enum CalibrationError {
    /// Nothing to calibrate with.
    #[error("there is no mark that can be used; carom calibrate --tests says what to play and what to mark")]
    Nothing,
    /// More strokes than are fitted in a reasonable time.
    #[error("there are {0} trials; accepted are at most {MOST}, three times as many as are asked for")]
    TooMany(usize),
    /// The table is certain.
    #[error(
        "the table \"{0}\" has no constant in doubt that a calibration could find; use match or a table file of your own"
    )]
    Certain(String),
    /// Its doubt cannot be.
    #[error(transparent)]
    Doubt(#[from] DoubtError),
    /// The result is no table.
    #[error("the marks lead to a table that cannot be: {0}")]
    Table(#[from] TableError),
}

/// Calibrates a table that is held to be `table`, with what `doubt` leaves open, by these trials, each with its number in
/// the file.
///
/// # Errors
/// Where nothing can be found.
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
    if trials.len() > MOST {
        return Err(CalibrationError::TooMany(trials.len()));
    }
    let (numbers, trials): (Vec<usize>, Vec<Trial>) = trials.iter().cloned().unzip();
    let (belief, found) = fit(table, doubt, &trials)?;
    let fitted = belief.table(&found.likely);
    let (mut verdicts, mut kept, mut left_out) = (Vec::new(), Vec::new(), Vec::new());
    for (index, trial) in trials.iter().enumerate() {
        let all = off(&fitted, trial, &found.strokes[index]);
        // Where most marks of a stroke are wrong, it was another stroke, and the others say nothing.
        if 2 * all.iter().filter(|off| misread(**off) > 0.5).count() > all.len() {
            left_out.push(numbers[index] + 1);
        } else {
            kept.push(trial.clone());
        }
        for (reading, off) in trial.readings.iter().zip(all) {
            let mark = &trial.test.marks[reading.mark];
            let is_misread = misread(off) > 0.5;
            let expected = is_misread.then(|| found.expected(&belief, &trials, index, reading.mark)).flatten();
            let is_stop = matches!(mark.quantity, Quantity::StopAlong(_));
            let place = |way: f64| if is_stop { trial.test.place(table, way) } else { (0, way) };
            let (rails, marked) = place(reading.value);
            verdicts.push(Verdict {
                trial: numbers[index] + 1,
                test: trial.test.name,
                mark: mark.name,
                marked,
                off: -off,
                misread: is_misread,
                expected: expected.map(|(value, deviation)| (place(value).1, deviation)),
                rails: is_stop.then(|| (rails, expected.map_or(rails, |(value, _)| place(value).0))),
            });
        }
    }
    let mut strange = Vec::new();
    for ((number, trial), stroke) in numbers.iter().zip(&trials).zip(&found.strokes) {
        let far = stroke.iter().zip(STROKES).filter(|(off, _)| off.abs() > FAR);
        strange.extend(far.map(|(off, what)| Strange { trial: number + 1, test: trial.test.name, what, off: *off }));
    }
    let (belief, found) = if left_out.is_empty() { (belief, found) } else { fit(table, doubt, &kept)? };
    let covariance = belief.covariance(&found.covariance);
    let doubt = Some(belief.doubt(&covariance));
    let after = Table { name: name.to_owned(), doubt, ..belief.table(&found.unknowns) };
    let after = Table::from_toml(&toml::to_string(&after).map_err(|error| TableError::Syntax(error.to_string()))?)?;
    let change = |(index, (name, before, before_deviation)): (usize, (&str, f64, f64))| Change {
        name: name.to_owned(),
        before,
        before_deviation,
        after: TableDoubt::value(&after, name).unwrap_or(before),
        after_deviation: covariance[index][index].max(0.0).sqrt(),
    };
    let constants = belief.told().enumerate().map(change).collect();
    let next = next(&belief, &found.unknowns, &found.covariance);
    Ok(Calibration { table: after, before: table.name.clone(), constants, verdicts, left_out, strange, next })
}

/// The belief about the table and its estimate from the trials; a rail that differs from the others gets constants of its own.
fn fit(table: &Table, doubt: &TableDoubt, trials: &[Trial]) -> Result<(Belief, Estimate), CalibrationError> {
    if let Some(apart) = told_apart(table, doubt, trials)? {
        return Ok(apart);
    }
    let belief = Belief::new(table, doubt)?;
    let found = estimate(&belief, trials);
    Ok((belief, found))
}

/// What is not known of a table before it is calibrated: what its file says, or as much as tables differ by. The constants of
/// `match` are sure of the filmed table alone.
pub fn prior(table: &Table) -> TableDoubt {
    TableDoubt::of(&Table { name: String::new(), ..table.clone() })
}

/// All tests, the one that tells most first, before anything was played.
///
/// # Errors
/// Where the table has no doubt that a test could lessen.
pub fn prospects(table: &Table, doubt: &TableDoubt) -> Result<Vec<Next>, CalibrationError> {
    let belief = Belief::new(table, doubt)?;
    let count = belief.count();
    if count == 0 {
        return Err(CalibrationError::Certain(table.name.clone()));
    }
    Ok(next(&belief, &vec![0.0; count], &identity(count)))
}

fn next(belief: &Belief, unknowns: &[f64], covariance: &[Vec<f64>]) -> Vec<Next> {
    let bits = |test: &'static Test| Next { test: test.name, bits: information(belief, unknowns, covariance, test) };
    let mut next: Vec<Next> = PROTOCOL.iter().map(bits).collect();
    next.sort_by(|one, other| other.bits.total_cmp(&one.bits));
    next
}

impl Calibration {
    /// Trials of which a mark looks misread, in order.
    pub fn misread(&self) -> Vec<usize> {
        let mut trials: Vec<usize> = self.verdicts.iter().filter(|one| one.misread).map(|one| one.trial).collect();
        trials.dedup();
        trials
    }

    /// Whether so many trials look misread that they contradict each other, or nothing of the only one counts.
    pub fn is_contradictory(&self) -> bool {
        let mut trials: Vec<usize> = self.verdicts.iter().map(|one| one.trial).collect();
        trials.dedup();
        let misread = self.misread().len();
        self.left_out.len() == trials.len() || misread > 1 && 3 * misread >= trials.len()
    }
}
