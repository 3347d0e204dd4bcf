//! A player's skill from results at a real table.
//!
//! The model: the player's errors are those of the named levels times a common scale s in all five inputs. The player
//! plays the shot that the exercise teaches or that a hint has shown, on a table to which the shot has been adjusted;
//! the estimate therefore concerns execution only.
//!
//! How often the shot of exercise e is made at scale s, `p_e(s)`, is simulated. The estimate is the scale with the
//! maximum likelihood of all results, and the interval contains the scales whose likelihood is not much lower
//! (likelihood ratio, Wilks 1938).

use super::{Session, Venue};
use crate::{
    coach::{Skill, layout_number, make_probability},
    game::Rule,
    physics::CueInputs,
    table::{Layout, Table},
};

/// Minimum number of attempts for an estimate.
pub const MIN_ATTEMPTS: usize = 20;

/// Minimum number of different shots among them. The interval covers chance alone: how often one shot is made depends
/// as much on the input that it is most sensitive to and on the real table as on the player. Only other shots can show
/// that.
pub const MIN_SHOTS: usize = 3;

/// Range of scales, as powers of two.
const POWERS: (f64, f64) = (-2.0, 4.0);

/// Simulated scales per power of two. Between them the logarithm of p / (1 - p) is almost linear.
const STEPS: usize = 4;

/// Number of simulated scales.
const SCALES: usize = (POWERS.1 - POWERS.0) as usize * STEPS + 1;

/// Interpolation steps between two simulated scales, for the estimate and its interval: 0.5 % each. With a thousand
/// attempts the interval is 40 of them wide.
const SUBSTEPS: usize = 32;

/// Simulated strokes per scale and shot, with the same errors for all scales. The curve `p_e(s)` is therefore smooth,
/// and its error is typically at most 1.6 %. [`fit`] takes this error into account.
const STROKES: usize = 1000;

/// Maximum drop of the log-likelihood below its maximum within the 95 % interval: half of the 95 % quantile of the
/// chi-squared distribution with one degree of freedom.
const MAX_LOG_LIKELIHOOD_DROP: f64 = 1.920_729;

/// The estimate of a player's skill.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The skill at this scale; `None` if the interval is open at one end, so that there is only a bound.
    pub skill: Option<Skill>,
    /// Multiple of the errors of [`Skill::level`] at 1.
    pub scale: f64,
    /// Lower end of the 95 % interval; at 1/4 it may be lower.
    pub low: f64,
    /// Upper end; at 16 it may be higher.
    pub high: f64,
    /// Attempts used.
    pub attempts: usize,
    /// Points among the attempts.
    pub made: usize,
    /// Number of different shots.
    pub shots: usize,
    /// Attempts at a real table that cannot be used, because the intended shot, the table or the layout is unknown.
    pub left_out: usize,
}

impl Estimate {
    /// Returns the three-cushion averages of such a player: the lower end of the 95 % interval, the estimate, and the
    /// upper end.
    pub fn averages(&self) -> [f64; 3] {
        [self.high, self.scale, self.low].map(Skill::average)
    }

    /// Formats the average with its 95 % interval. If the interval reaches an end of the scale range, only the other end is
    /// displayed.
    pub fn words(&self) -> String {
        let [least, average, most] = self.averages();
        match self.bound() {
            Some((bound, end)) => format!("{bound} {end:.2}"),
            None => format!("{average:.2} ({least:.2} to {most:.2})"),
        }
    }

    /// Returns "at least" or "at most" with the known end of the average's interval, if the other end is unknown.
    pub fn bound(&self) -> Option<(&'static str, f64)> {
        let [least, _, most] = self.averages();
        match open_ends(self.low, self.high) {
            [true, _] => Some(("at least", least)),
            [_, true] => Some(("at most", most)),
            _ => None,
        }
    }
}

/// Whether an interval reaches the lower and the upper end of the scale range.
fn open_ends(low: f64, high: f64) -> [bool; 2] {
    [low <= scale(0.0), high >= scale(POWERS.1 - POWERS.0)]
}

/// Why there is no estimate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoEstimate {
    /// Too few attempts, or shots.
    #[error("the skill is not known yet: {}. {COUNTED}", so_far(*attempts, *shots))]
    TooFew {
        /// Attempts so far.
        attempts: usize,
        /// Different shots so far.
        shots: usize,
    },
    /// The results are equally likely for players of any skill.
    #[error("{attempts} attempts show nothing yet: their shots are too easy or too hard to distinguish players")]
    Uninformative {
        /// Attempts so far.
        attempts: usize,
    },
}

/// The attempts that can be used.
const COUNTED: &str = "Only strokes noted at a real table count: model shots with no ball shifted, and shots that a hint showed; no games";

/// Describes the progress towards the required attempts and shots.
fn so_far(attempts: usize, shots: usize) -> String {
    match (attempts < MIN_ATTEMPTS, shots < MIN_SHOTS) {
        (true, true) => format!("{attempts} of {MIN_ATTEMPTS} attempts, at {shots} of {MIN_SHOTS} different shots"),
        (true, false) => format!("{attempts} of {MIN_ATTEMPTS} attempts"),
        (false, _) => format!("{attempts} attempts are enough, but at {shots} of {MIN_SHOTS} different shots"),
    }
}

/// A shot, and how often it was attempted and made.
struct Shot {
    rule: Rule,
    table: Table,
    layout: Layout,
    cue: CueInputs,
    tried: usize,
    made: usize,
}

/// Estimates a player's skill from attempts at a real table. It takes about 0.05 s per shot.
///
/// # Errors
/// Fails if there are too few attempts, or they carry no information.
pub fn estimate(sessions: &[Session]) -> Result<Estimate, NoEstimate> {
    let (shots, left_out) = shots(sessions);
    let attempts = shots.iter().map(|shot| shot.tried).sum();
    if attempts < MIN_ATTEMPTS || shots.len() < MIN_SHOTS {
        return Err(NoEstimate::TooFew { attempts, shots: shots.len() });
    }
    let curves: Vec<_> = shots.iter().map(Shot::curve).collect();
    let counts: Vec<_> = shots.iter().map(|shot| (shot.made, shot.tried)).collect();
    let [low, scale, high] = fit(&curves, &counts).ok_or(NoEstimate::Uninformative { attempts })?;
    Ok(Estimate {
        // More digits would have no meaning.
        skill: (open_ends(low, high) == [false; 2]).then(|| Skill::level((100.0 * scale).round() / 100.0)),
        scale,
        low,
        high,
        attempts,
        made: shots.iter().map(|shot| shot.made).sum(),
        shots: shots.len(),
        left_out,
    })
}

/// Returns the shots that were attempted at a real table, and the number of attempts whose shot is unknown.
fn shots(sessions: &[Session]) -> (Vec<Shot>, usize) {
    let (mut shots, mut left_out) = (Vec::<Shot>::new(), 0);
    for session in sessions.iter().filter(|session| session.venue == Venue::Table) {
        // In a game at a real table the ball positions are unknown.
        let exercises = session.exercises.iter().filter(|_| !session.is_game());
        let exercises: Vec<_> =
            exercises.filter_map(|one| Some((one, session.table_of(one).ok()?, session.model_shot_of(one)))).collect();
        for attempt in session.attempts.iter().filter(|attempt| !attempt.by_coach) {
            let known = exercises.iter().find(|(exercise, ..)| exercise.name == attempt.exercise);
            let Some((exercise, table, model_shot)) = known else {
                left_out += 1;
                continue;
            };
            // The exercise's own shot is valid for its own layout only; the coach's shot counts only if the player saw it.
            let own = model_shot.filter(|_| attempt.layout.is_none());
            let shown = attempt.advised.filter(|_| attempt.helped);
            let layout = attempt.layout.unwrap_or(exercise.layout);
            let Some(cue) = shown.or(own).filter(|_| layout.validate(table).is_ok()) else {
                left_out += 1;
                continue;
            };
            let rule = exercise.rule;
            let same =
                |shot: &&mut Shot| (shot.cue, shot.layout, shot.rule) == (cue, layout, rule) && shot.table == *table;
            let (tried, made) = (1, usize::from(attempt.made));
            match shots.iter_mut().find(same) {
                Some(shot) => {
                    shot.tried += tried;
                    shot.made += made;
                }
                None => shots.push(Shot { rule, table: table.clone(), layout, cue, tried, made }),
            }
        }
    }
    (shots, left_out)
}

impl Shot {
    /// Estimates `p_e(s)` at every scale: never 0 or 1, which a finite number of strokes cannot establish. Every layout has its own
    /// errors, so that the errors of the curves cancel out among many shots.
    fn curve(&self) -> [f64; SCALES] {
        let seed = u64::from(layout_number(&self.layout));
        std::array::from_fn(|index| {
            let skill = Skill::level(scale(index as f64 / STEPS as f64));
            let made = make_probability(skill, self.rule, &self.table, &self.layout, &self.cue, STROKES, seed);
            (made.successes as f64 + 0.5) / (made.trials as f64 + 1.0)
        })
    }
}

/// Returns the scale this number of powers of two above the smallest.
fn scale(powers: f64) -> f64 {
    (POWERS.0 + powers).exp2()
}

/// Finds the maximum-likelihood scale for the counts (made, tried), between the ends of its interval. `None` if the interval
/// contains all scales.
///
/// The likelihood compares the share of n attempts that made the point with a share of N = [`STROKES`] simulated ones. The former has
/// the variance p (1 - p) / n, the latter p (1 - p) / N, and their difference the sum: 1 + n / N times that of the attempts alone. The
/// logarithm of the shot's likelihood is therefore divided by this factor. However often a shot is attempted, it tells no more than N
/// attempts would with an exact curve.
fn fit(curves: &[[f64; SCALES]], counts: &[(usize, usize)]) -> Option<[f64; 3]> {
    let likelihood = |step: usize| -> f64 {
        let (index, share) = (step / SUBSTEPS, (step % SUBSTEPS) as f64 / SUBSTEPS as f64);
        let term = |(curve, (made, tried)): (&[f64; SCALES], &(usize, usize))| {
            let logit = |index: usize| (curve[index] / (1.0 - curve[index])).ln();
            let logit = logit(index) + share * (logit((index + 1).min(SCALES - 1)) - logit(index));
            // Terms with the logarithms of p and of 1 - p.
            let log = -(*made as f64) * (-logit).exp().ln_1p() - (tried - made) as f64 * logit.exp().ln_1p();
            log / (1.0 + *tried as f64 / STROKES as f64)
        };
        curves.iter().zip(counts).map(term).sum()
    };
    let last = (SCALES - 1) * SUBSTEPS;
    let likelihood: Vec<f64> = (0..=last).map(likelihood).collect();
    // The smallest scale among equals: the errors of a player who has missed nothing may be arbitrarily small.
    let best = (0..=last).rev().max_by(|x, y| likelihood[*x].total_cmp(&likelihood[*y]))?;
    let is_inside = |step: &usize| likelihood[*step] >= likelihood[best] - MAX_LOG_LIKELIHOOD_DROP;
    let (low, high) = ((0..best).find(is_inside).unwrap_or(best), (best..=last).rfind(is_inside).unwrap_or(best));
    // The ends lie halfway between the last step inside and the first one outside.
    let ends = [(low as f64 - 0.5).max(0.0), best as f64, (high as f64 + 0.5).min(last as f64)];
    ((low, high) != (0, last)).then(|| ends.map(|step| scale(step / (STEPS * SUBSTEPS) as f64)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        coach::{Coach, Request},
        drills::{Attempt, Exercise, Goal, session::tests::exercise},
        learning::evaluation::held_out_layouts,
    };
    use rand::{RngExt, SeedableRng};
    use rand_xoshiro::Xoshiro256PlusPlus;
    use std::time::Duration;

    /// Eight exercises with a shot that a search finds, the same on every machine.
    fn exercises() -> Vec<Exercise> {
        let table = Table::default();
        let coach = Coach::without_policy(table.clone());
        let rules = [Rule::StraightRail, Rule::ThreeCushion].into_iter().cycle();
        let pair = |(number, (layout, rule)): (usize, (Layout, Rule))| {
            let request = Request {
                rule,
                skill: Skill::EXPERT,
                simulations: 20_000,
                budget: Duration::from_secs(60),
                ..Request::default()
            };
            let shot = Some(coach.recommend(&layout, &request).unwrap().cue);
            Exercise { rule, layout, shot, ..exercise(&format!("number-{number}")) }
        };
        held_out_layouts(&table, 8, 4).into_iter().zip(rules).enumerate().map(pair).collect()
    }

    /// The log of a player of `scale`: 50 attempts at each exercise.
    fn logged(exercises: &[Exercise], scale: f64, seed: u64) -> Vec<Session> {
        let skill = Skill::level(scale);
        let session = |(number, exercise): (u64, &Exercise)| {
            let one = vec![exercise.clone()];
            let mut session = Session::new(Goal::Free, Venue::Table, one, Skill::CLUB, 0);
            let (table, shot) = (exercise.table().unwrap(), exercise.shot.unwrap());
            let seed = 1000 * (seed + 1) + number;
            let made = make_probability(skill, exercise.rule, &table, &exercise.layout, &shot, 50, seed).successes;
            session.attempts = (0..50).map(|attempt| Attempt::new(&exercise.name, attempt < made)).collect();
            session
        };
        (0..).zip(exercises).map(session).collect()
    }

    #[test]
    fn estimate_recovers_known_skills_within_the_interval() {
        let exercises = exercises();
        // A 95 % interval may miss the true scale; two of six hardly ever do.
        let six = [1, 3, 4, 5, 6, 7].map(|seed| estimate(&logged(&exercises, 2.0, seed)).unwrap());
        assert!(six.iter().filter(|found| found.low <= 2.0 && 2.0 <= found.high).count() >= 5, "{six:?}");
        assert!(six.iter().all(|found| found.high / found.low < 2.0), "{six:?}");
        let found = &six[0];
        assert_eq!((found.attempts, found.shots, found.left_out), (400, 8, 0));
        let mut of_coach = logged(&exercises, 2.0, 1);
        of_coach[0].attempts.iter_mut().for_each(|attempt| attempt.by_coach = true);
        assert_eq!(
            shots(&of_coach).0.iter().map(|shot| shot.tried).sum::<usize>(),
            350,
            "the coach's are not the player's"
        );
        assert_eq!(found.skill, Some(Skill::level((100.0 * found.scale).round() / 100.0)));
        let mut faultless = logged(&exercises, 1.0, 2);
        faultless.iter_mut().flat_map(|session| &mut session.attempts).for_each(|attempt| attempt.made = true);
        let bound = estimate(&faultless).unwrap();
        assert_eq!(bound.skill, None, "who never misses is no better than the exercises can tell: {bound:?}");
        // All use the same curves, because computing these takes most of the time. The scales lie between the simulated ones.
        let curves: Vec<_> = shots(&logged(&exercises, 1.0, 0)).0.iter().map(Shot::curve).collect();
        for scale in [1.1, 3.0, 5.0] {
            let within = |seed: &u64| {
                let counts: Vec<_> = shots(&logged(&exercises, scale, 100 + seed))
                    .0
                    .iter()
                    .map(|shot| (shot.made, shot.tried))
                    .collect();
                let [low, _, high] = fit(&curves, &counts).unwrap();
                (low..=high).contains(&scale)
            };
            let covered = (0..100).filter(within).count();
            // Of 100 intervals of 95 %, fewer than 88 contain the true scale once in 700 times.
            assert!(covered >= 88, "{covered} of 100 at scale {scale}");
        }
    }

    /// Players whose rate falls from 1 to 0 around three different scales. The simulated curves have errors of their own, which a
    /// thousand attempts at each shot do not hide: without them in the likelihood, 84 % of the intervals contained the true scale.
    #[test]
    fn interval_covers_the_error_of_the_simulated_curves() {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(3);
        let truth = 2.0_f64;
        let middles = [1.0_f64, 2.0, 4.0];
        // A stroke makes the point at all scales below its own threshold, which is log-logistic.
        let threshold = |middle: f64, rng: &mut Xoshiro256PlusPlus| {
            let share: f64 = rng.random();
            middle * (share / (1.0 - share)).powf(2.0 / 3.0)
        };
        let covered = |tried: usize, rng: &mut Xoshiro256PlusPlus| {
            let curves = middles.map(|middle| {
                let thresholds: Vec<f64> = (0..STROKES).map(|_| threshold(middle, rng)).collect();
                std::array::from_fn(|index| {
                    let scale = scale(index as f64 / STEPS as f64);
                    let made = thresholds.iter().filter(|threshold| **threshold > scale).count();
                    (made as f64 + 0.5) / (STROKES as f64 + 1.0)
                })
            });
            let made = middles.map(|middle| (0..tried).filter(|_| threshold(middle, rng) > truth).count());
            let [low, _, high] = fit(&curves, &made.map(|made| (made, tried))).unwrap();
            (low..=high).contains(&truth)
        };
        for tried in [50, 1000] {
            let share = (0..500).filter(|_| covered(tried, &mut rng)).count() as f64 / 500.0;
            // Three standard errors around 95 %.
            assert!((share - 0.95).abs() < 0.03, "{share} with {tried} attempts at each shot");
        }
    }

    #[test]
    fn all_points_or_all_misses_give_one_sided_bounds() {
        // Everybody makes it with small errors, and nobody with large ones.
        let curve = std::array::from_fn(|index| (1.15 - 0.05 * index as f64).clamp(0.01, 0.999));
        let words = |made| {
            let [low, scale, high] = fit(&[curve], &[(made, 100)]).unwrap();
            let (skill, attempts, shots, left_out) = (None, 100, 1, 0);
            Estimate { skill, scale, low, high, attempts, made, shots, left_out }
        };
        let (all, none, some) = (words(100), words(0), words(70));
        assert_eq!(all.scale, 0.25, "{all:?}");
        assert!(all.words().starts_with("at least ") && all.high < 1.0, "{all:?}");
        assert!(none.words().starts_with("at most ") && none.scale > 4.0, "{none:?}");
        assert!(some.words().contains('(') && some.low < some.scale && some.scale < some.high, "{some:?}");
    }

    #[test]
    fn too_few_attempts_give_no_estimate() {
        let away = CueInputs { a: 0.0, b: 0.0, theta: 0.5, phi: 2.0, speed: 0.1 };
        // Sessions with this number of different shots, each attempted equally often and never made.
        let sessions = |shots: u32, attempts: usize| -> Vec<Session> {
            let session = |number: u32| {
                let name = format!("number-{number}");
                let shot = Some(CueInputs { phi: away.phi + f64::from(number), ..away });
                let one = Exercise { shot, ..exercise(&name) };
                let mut session = Session::new(Goal::Free, Venue::Table, vec![one], Skill::EXPERT, 0);
                session.attempts = vec![Attempt::new(&name, false); attempts];
                session
            };
            (0..shots).map(session).collect()
        };
        let too_few = |attempts, shots| Err(NoEstimate::TooFew { attempts, shots });
        assert_eq!(estimate(&sessions(3, 6)), too_few(18, 3));
        assert_eq!(estimate(&sessions(2, 50)), too_few(100, 2), "two shots tell how these are made");
        assert_eq!(estimate(&sessions(3, 7)), Err(NoEstimate::Uninformative { attempts: 21 }));
        let mut shots = sessions(3, 50);
        let each = |shots: &mut [Session], change: fn(&mut Session)| shots.iter_mut().for_each(change);
        each(&mut shots, |session| {
            let shot = session.exercises[0].shot.take();
            session.attempts.iter_mut().for_each(|attempt| attempt.advised = shot);
        });
        assert_eq!(estimate(&shots), too_few(0, 0), "nobody saw the coach's shot");
        each(&mut shots, |session| session.attempts.iter_mut().for_each(|attempt| attempt.helped = true));
        assert_eq!(estimate(&shots), Err(NoEstimate::Uninformative { attempts: 150 }), "a hint showed it");
        each(&mut shots, |session| session.goal = Goal::Game { innings: 0 });
        assert_eq!(estimate(&shots), too_few(0, 0), "the balls have moved");
        let mut played = sessions(3, 50);
        each(&mut played, |session| session.venue = Venue::Program);
        assert_eq!(estimate(&played), too_few(0, 0), "the program's errors are known");
        let mut unknown = sessions(3, 50);
        each(&mut unknown, |session| session.exercises[0].shot = None);
        assert_eq!(estimate(&unknown), too_few(0, 0), "no shot is known");
    }
}
