//! An exam: twenty exercises with one attempt each, and the meaning of its score.

use rand::{SeedableRng, seq::SliceRandom};
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{Category, Exercise, Par, Session, par};
use crate::coach::{Doubt, layout_number, layout_seed};

/// Number of exercises in an exam; an exam of a single category has fewer if the category has.
pub const LENGTH: usize = 20;

/// Fewest exercises in an exam of a single category.
const MIN_OF_CATEGORY: usize = 3;

/// Attempts for each expected share of an exercise. Every exercise has errors of its own, so that over an exam the standard error is at most
/// 0.1 points.
const PAR_ATTEMPTS: usize = 1000;

/// The grades of the exercises in each level.
const GRADES: [std::ops::RangeInclusive<u8>; 3] = [1..=3, 2..=4, 3..=5];

/// The highest level.
pub const HIGHEST_LEVEL: u8 = GRADES.len() as u8;

/// Why an exam cannot be drawn.
#[derive(Debug, thiserror::Error, PartialEq)]
pub enum ExamError {
    /// The level does not exist.
    #[error("there is no exam of level {0}; accepted is 1 to {HIGHEST_LEVEL}")]
    Level(u8),
    /// The player's own positions.
    #[error("nobody has measured how difficult your own positions are, so there is no exam of them")]
    OwnPositions,
    /// There are too few exercises.
    #[error(
        "an exam of level {level}{} needs {needed} exercises of grade {} to {}; there are {found}",
        category.map_or(String::new(), |category| format!(" in \"{}\"", category.title())), grades.start(), grades.end()
    )]
    TooFew {
        /// The level.
        level: u8,
        /// The category; `None` for all.
        category: Option<Category>,
        /// Minimum number of exercises.
        needed: usize,
        /// The grades of the level.
        grades: std::ops::RangeInclusive<u8>,
        /// Number of suitable exercises.
        found: usize,
    },
}

/// Returns the grades of the exercises in an exam of `level`; `None` if there is no such level.
pub fn grades(level: u8) -> Option<std::ops::RangeInclusive<u8>> {
    GRADES.get(usize::from(level).wrapping_sub(1)).cloned()
}

/// Returns the category of an exam's exercises; `None` if there are several.
pub fn category(exercises: &[Exercise]) -> Option<Category> {
    let first = exercises.first()?.category;
    exercises.iter().all(|exercise| exercise.category == first).then_some(first)
}

/// Draws the exercises of an exam of `level` 1 to [`HIGHEST_LEVEL`] from `library`, easy ones first: of one `category`,
/// or of all. They are spread over the categories and grades as evenly as the library allows.
/// The player's own positions are excluded because they have no measured par, and jumps and massés, which most clubs
/// forbid, unless they are the category. The same seed draws the same exam. The pars of the result are those of strokes in the
/// program, which are made more often than at a real table: table and positions are exact.
///
/// # Errors
/// [`ExamError`].
pub fn draw(
    library: &[Exercise],
    level: u8,
    category: Option<Category>,
    seed: u64,
) -> Result<Vec<Exercise>, ExamError> {
    let grades = grades(level).ok_or(ExamError::Level(level))?;
    if category == Some(Category::Own) {
        return Err(ExamError::OwnPositions);
    }
    let fits = |exercise: &&Exercise| {
        let is_wanted = category.map_or(exercise.category != Category::JumpAndMasse, |only| exercise.category == only);
        is_wanted && exercise.category != Category::Own && exercise.par.is_some() && grades.contains(&exercise.grade)
    };
    let mut left: Vec<&Exercise> = library.iter().filter(fits).collect();
    let needed = category.map_or(LENGTH, |_| MIN_OF_CATEGORY);
    if left.len() < needed {
        return Err(ExamError::TooFew { level, category, needed, grades, found: left.len() });
    }
    let length = left.len().min(LENGTH);
    left.shuffle(&mut Xoshiro256PlusPlus::seed_from_u64(seed));
    let mut drawn: Vec<&Exercise> = Vec::with_capacity(length);
    while drawn.len() < length {
        // Take the category with the fewest exercises so far, then the grade; ties are resolved by the shuffled order.
        let taken = |same: &dyn Fn(&&&Exercise) -> bool| drawn.iter().filter(same).count();
        let counts = |exercise: &&Exercise| {
            (taken(&|other| other.category == exercise.category), taken(&|other| other.grade == exercise.grade))
        };
        let next = (0..left.len()).min_by_key(|index| counts(&left[*index])).unwrap_or(0);
        drawn.push(left.remove(next));
    }
    drawn.sort_by_key(|exercise| exercise.grade);
    let with_par = |exercise: &Exercise| {
        let seed = layout_seed(par::SEED, layout_number(&exercise.layout));
        let par = Par::with_doubt(exercise, Doubt::NONE, PAR_ATTEMPTS, seed).ok().flatten();
        Exercise { par: par.or(exercise.par), ..exercise.clone() }
    };
    Ok(drawn.into_iter().map(with_par).collect())
}

/// The score of an exam and its meaning.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExamScore {
    /// Exercises attempted so far.
    pub tried: usize,
    /// Points.
    pub made: usize,
    /// Expected points of each of the named players in the same attempts, with the exercises' own shots.
    pub expected: Par,
    /// Standard deviations of their points: an exam is short, so luck matters.
    pub spread: Par,
    /// The player with the nearest expected score: "beginner", "club" or "world-class".
    pub nearest: &'static str,
}

/// Returns the score of the attempts so far; `None` before the first.
pub fn score(session: &Session) -> Option<ExamScore> {
    let attempts = &session.attempts;
    let pars: Vec<Par> = attempts.iter().filter_map(|attempt| session.exercise_of(attempt)?.par).collect();
    let sum = |of: fn(&Par) -> f64, term: fn(f64) -> f64| pars.iter().map(|par| term(of(par))).sum::<f64>();
    let each = |term| Par {
        beginner: sum(|par| par.beginner, term),
        club: sum(|par| par.club, term),
        world_class: sum(|par| par.world_class, term),
    };
    let expected = each(|share| share);
    let Par { beginner, club, world_class } = each(|share| share * (1.0 - share));
    let spread = Par { beginner: beginner.sqrt(), club: club.sqrt(), world_class: world_class.sqrt() };
    let made = attempts.iter().filter(|attempt| attempt.made).count();
    let distance = |average: f64| (made as f64 - average).abs();
    let players = [("beginner", expected.beginner), ("club", expected.club), ("world-class", expected.world_class)];
    let (nearest, _) = players.into_iter().min_by(|x, y| distance(x.1).total_cmp(&distance(y.1)))?;
    (!attempts.is_empty()).then_some(ExamScore { tried: attempts.len(), made, expected, spread, nearest })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        coach::Skill,
        drills::{Goal, Library, Venue, session::tests::exercise},
    };

    /// Ten exercises of each category, two of each grade.
    fn library() -> Vec<Exercise> {
        let each = |category: Category| {
            (0..10_u8).map(move |number| Exercise {
                category,
                grade: 1 + number % 5,
                par: Some(Par { beginner: 0.2, club: 0.5, world_class: 0.9 }),
                ..exercise(&format!("{category}-{number}"))
            })
        };
        Category::ALL.into_iter().flat_map(each).collect()
    }

    #[test]
    fn exam_covers_categories_and_grades_and_is_reproducible() {
        let library = library();
        for level in 1..=3 {
            let exam = draw(&library, level, None, 5).unwrap();
            assert_eq!(exam.len(), LENGTH);
            assert_eq!(exam, draw(&library, level, None, 5).unwrap());
            assert_ne!(exam, draw(&library, level, None, 6).unwrap());
            assert!(exam.iter().all(|exercise| exercise.category != Category::Own));
            for category in &Category::ALL[..8] {
                let count = exam.iter().filter(|exercise| exercise.category == *category).count();
                assert!((2..=3).contains(&count), "{count} of {category}");
            }
            for grade in GRADES[usize::from(level) - 1].clone() {
                let count = exam.iter().filter(|exercise| exercise.grade == grade).count();
                assert!((5..=8).contains(&count), "{count} of grade {grade}");
            }
        }
    }

    #[test]
    fn expected_scores_are_those_of_strokes_in_the_program() {
        let library = Library::bundled();
        let drawn = draw(library.exercises(), 2, None, 1).unwrap();
        let sum = |pars: &mut dyn Iterator<Item = Par>| pars.map(|par| par.club).sum::<f64>();
        let here = sum(&mut drawn.iter().filter_map(|exercise| exercise.par));
        let at_a_table = sum(&mut drawn.iter().filter_map(|exercise| library.get(&exercise.name).unwrap().par));
        assert!(here > at_a_table + 0.3, "an exact table is easier: {here} and {at_a_table} of {LENGTH}");
    }

    #[test]
    fn exam_of_one_category_has_all_its_exercises_of_the_level() {
        let library = library();
        for only in [Category::Draw, Category::JumpAndMasse] {
            let exam = draw(&library, 2, Some(only), 5).unwrap();
            assert_eq!((exam.len(), category(&exam)), (6, Some(only)), "two of each grade");
            assert!(
                exam.is_sorted_by_key(|exercise| exercise.grade)
                    && exam.iter().all(|each| (2..=4).contains(&each.grade))
            );
        }
        assert_eq!(category(&draw(&library, 2, None, 5).unwrap()), None);
        let many: Vec<Exercise> = (0..9).flat_map(|_| library.clone()).collect();
        assert_eq!(draw(&many, 2, Some(Category::Draw), 5).unwrap().len(), LENGTH);
        let said = draw(&library, 1, Some(Category::Own), 5).unwrap_err().to_string();
        assert_eq!(said, ExamError::OwnPositions.to_string());
    }

    #[test]
    fn impossible_exams_are_refused_with_a_reason() {
        assert!(draw(&library(), 0, None, 1).unwrap_err().to_string().contains("level 0"));
        assert_eq!(draw(&library(), 4, None, 1), Err(ExamError::Level(4)));
        let said = draw(&library()[..10], 2, None, 1).unwrap_err().to_string();
        assert!(said.contains("grade 2 to 4") && said.contains("there are 6"), "{said}");
    }

    #[test]
    fn exam_score_names_the_nearest_skill() {
        let exam = draw(&library(), 2, None, 1).unwrap();
        // The expected points in 20 exercises are 4, 10 and 18.
        for (made, nearest) in
            [(0, "beginner"), (6, "beginner"), (8, "club"), (13, "club"), (15, "world-class"), (20, "world-class")]
        {
            let mut session = Session::new(Goal::Exam, Venue::Table, exam.clone(), Skill::CLUB, 1);
            assert_eq!(score(&session), None);
            for number in 0..LENGTH {
                session.log(number < made).unwrap();
            }
            let score = score(&session).unwrap();
            assert!((score.expected.world_class - 18.0).abs() < 1e-9);
            assert!((score.spread.club - 5.0_f64.sqrt()).abs() < 1e-9, "of 20 even chances");
            assert_eq!((score.made, score.nearest), (made, nearest));
        }
    }
}
