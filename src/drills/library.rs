//! The library of exercises: the bundled ones and the user's own.

use std::sync::LazyLock;

use super::{Category, Exercise, LibraryFile, exercise::bare_tag};
use crate::printing;

/// The bundled files, one per category.
const BUNDLED: [&str; 9] = [
    include_str!("../../saves/first-caroms.json"),
    include_str!("../../saves/draw.json"),
    include_str!("../../saves/follow.json"),
    include_str!("../../saves/side.json"),
    include_str!("../../saves/one-cushion.json"),
    include_str!("../../saves/gather.json"),
    include_str!("../../saves/three-cushion.json"),
    include_str!("../../saves/systems.json"),
    include_str!("../../saves/jump-and-masse.json"),
];

/// Why an exercise is not in the library, or cannot be added.
#[derive(Debug, thiserror::Error, PartialEq)]
pub enum LibraryError {
    /// No exercise has this name.
    #[error("there is no exercise \"{0}\"; carom drill list shows all names")]
    Unknown(String),
    /// Several exercises match.
    #[error("\"{text}\" may be {}; give more of the name or the title", listed(names))]
    Ambiguous {
        /// The search text.
        text: String,
        /// The names of the matches, with their titles.
        names: Vec<String>,
    },
    /// Another exercise has this name.
    #[error("there is an exercise \"{0}\" already; give this one another name")]
    NameTaken(String),
}

/// Maximum number of exercises listed in a sentence.
const MAX_LISTED: usize = 8;

/// Names in a sentence: a, b and c.
fn listed(names: &[String]) -> String {
    let (shown, rest) = names.split_at(names.len().min(MAX_LISTED));
    let more = (!rest.is_empty()).then(|| format!("{} others", rest.len()));
    let mut shown: Vec<String> = shown.iter().cloned().chain(more).collect();
    let last = shown.pop().unwrap_or_default();
    if shown.is_empty() { last } else { format!("{} and {last}", shown.join(", ")) }
}

/// Exercises with unique names, the bundled ones first, by category.
#[derive(Clone, Debug, Default)]
pub struct Library {
    exercises: Vec<Exercise>,
    bundled: usize,
}

impl Library {
    /// Returns the bundled exercises, whose files are read once.
    pub fn bundled() -> &'static Self {
        static LIBRARY: LazyLock<Library> = LazyLock::new(|| {
            let read =
                |text| LibraryFile::parse(text).expect("a bundled file is one of exercises: a test reads them all");
            let exercises: Vec<Exercise> = BUNDLED.into_iter().flat_map(|text| read(text).exercises).collect();
            Library { bundled: exercises.len(), exercises }
        });
        &LIBRARY
    }

    /// Returns the bundled exercises together with these, and the errors of those that could not be added.
    pub fn with_own(own: Vec<Exercise>) -> (Self, Vec<LibraryError>) {
        let mut library = Self::bundled().clone();
        let refused = own.into_iter().filter_map(|exercise| library.add(exercise).err()).collect();
        (library, refused)
    }

    /// Adds an exercise.
    ///
    /// # Errors
    /// [`LibraryError::NameTaken`] if another exercise has its name.
    pub fn add(&mut self, exercise: Exercise) -> Result<(), LibraryError> {
        if self.get(&exercise.name).is_ok() {
            return Err(LibraryError::NameTaken(exercise.name));
        }
        self.exercises.push(exercise);
        Ok(())
    }

    /// Finds the exercise with this name.
    ///
    /// # Errors
    /// [`LibraryError::Unknown`].
    pub fn get(&self, name: &str) -> Result<&Exercise, LibraryError> {
        let named = self.exercises.iter().find(|exercise| exercise.name == name);
        named.ok_or_else(|| LibraryError::Unknown(name.to_owned()))
    }

    /// Finds the exercise that `text` refers to: its name; or its name or title, ignoring case; or an unambiguous
    /// prefix of either.
    ///
    /// # Errors
    /// [`LibraryError::Unknown`] or [`LibraryError::Ambiguous`].
    pub fn resolve(&self, text: &str) -> Result<&Exercise, LibraryError> {
        self.find_exact(text)
            .or_else(|_| self.find_unique(text, |words, wanted| !wanted.is_empty() && words.starts_with(wanted)))
    }

    /// Finds the exercise with this name, or with this name or title, ignoring case.
    ///
    /// # Errors
    /// [`LibraryError::Unknown`] or [`LibraryError::Ambiguous`].
    pub fn find_exact(&self, text: &str) -> Result<&Exercise, LibraryError> {
        self.get(text).or_else(|_| self.find_unique(text, |words, wanted| words == wanted))
    }

    /// Finds the only exercise for which `matches` holds for its name or title and `text`, both in lower case and with spaces
    /// for hyphens.
    fn find_unique(&self, text: &str, matches: impl Fn(&str, &str) -> bool) -> Result<&Exercise, LibraryError> {
        let wanted = plain(text);
        let is_wanted = |words: &&String| matches(&plain(words), &wanted);
        let either = |exercise: &&Exercise| [&exercise.name, &exercise.title].iter().any(is_wanted);
        match self.exercises.iter().filter(either).collect::<Vec<_>>()[..] {
            [] => Err(LibraryError::Unknown(text.to_owned())),
            [exercise] => Ok(exercise),
            ref several => {
                let names = several.iter().map(|exercise| format!("{} ({})", exercise.name, exercise.title)).collect();
                Err(LibraryError::Ambiguous { text: text.to_owned(), names })
            }
        }
    }

    /// Finds the name of the exercise whose name or title is most similar to `text`, if one is similar enough.
    pub fn most_similar(&self, text: &str) -> Option<&str> {
        let names = self.exercises.iter().map(|exercise| (exercise.name.as_str(), exercise.title.as_str()));
        printing::most_similar(text, names.flat_map(|(name, title)| [[name, name], [title, name]]))
    }

    /// Returns all exercises.
    pub fn exercises(&self) -> &[Exercise] {
        &self.exercises
    }

    /// Whether the exercise with this name comes with the program.
    pub fn is_bundled(&self, name: &str) -> bool {
        self.exercises[..self.bundled].iter().any(|exercise| exercise.name == name)
    }

    /// Returns the exercises that the filter accepts, in the order of the library.
    pub fn find(&self, filter: &Filter) -> impl Iterator<Item = &Exercise> {
        self.exercises.iter().filter(|exercise| filter.accepts(exercise))
    }
}

/// Returns the words in lower case, with spaces for hyphens.
fn plain(words: &str) -> String {
    words.to_lowercase().replace('-', " ")
}

/// Search criteria for exercises; a criterion that is `None` accepts all.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Filter {
    /// The category.
    pub category: Option<Category>,
    /// The grade.
    pub grade: Option<u8>,
    /// A tag.
    pub tag: Option<String>,
    /// Words that all occur in the name, title, point or tags, in any order, ignoring case; a hyphen separates words.
    pub text: Option<String>,
}

impl Filter {
    /// Whether an exercise meets all criteria.
    pub fn accepts(&self, exercise: &Exercise) -> bool {
        self.category.is_none_or(|category| exercise.category == category)
            && self.grade.is_none_or(|grade| exercise.grade == grade)
            && self.tag.as_ref().is_none_or(|tag| {
                // Some older versions stored tags in files with the sign.
                exercise.tags.iter().any(|own| bare_tag(own) == bare_tag(tag))
            })
            && self.text.as_ref().is_none_or(|text| {
                let Exercise { name, title, point, tags, .. } = exercise;
                let tags = tags.iter().map(|tag| format!("#{}", bare_tag(tag)));
                let own: Vec<String> = [name, title, point].into_iter().cloned().chain(tags).collect();
                let all = plain(&own.join("\n"));
                plain(text).split_whitespace().all(|word| all.contains(word))
            })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn own_exercise_with_an_existing_name_is_refused() {
        let bundled = Library::bundled();
        let taken = bundled.exercises()[3].clone();
        let own = Exercise { name: "mine".to_owned(), category: Category::Own, ..taken.clone() };
        let (library, refused) = Library::with_own(vec![own.clone(), taken.clone(), own.clone()]);
        assert_eq!(refused, [taken.name.clone(), own.name.clone()].map(LibraryError::NameTaken));
        assert_eq!(library.exercises().len(), bundled.exercises().len() + 1);
        assert_eq!(library.get("mine"), Ok(&own));
        assert!(library.is_bundled(&taken.name) && !library.is_bundled("mine"));
        assert_eq!(library.get("yours"), Err(LibraryError::Unknown("yours".to_owned())));
    }

    #[test]
    fn only_similar_names_and_titles_are_suggested() {
        let like = |text| Library::bundled().most_similar(text);
        assert_eq!(["naturel", "The-opning"].map(like), [Some("natural"), Some("opening-break")]);
        assert_eq!(["xyzzy", ""].map(like), [None, None]);
    }

    #[test]
    fn exercise_is_found_by_name_title_or_prefix() {
        let exercise = |name: &str, title: &str| Exercise {
            title: title.to_owned(),
            ..crate::drills::session::tests::exercise(name)
        };
        let mut library = Library::default();
        for (name, title) in
            [("draw", "Back"), ("draw-long", "Back from afar"), ("one", "Ärger"), ("two", "twice"), ("twice", "Two")]
        {
            library.add(exercise(name, title)).unwrap();
        }
        let name =
            |text| library.resolve(text).map(|exercise| exercise.name.as_str()).map_err(|error| error.to_string());
        assert_eq!(
            ["draw", "DRAW", "back", "draw-", "back f", "ÄRG", "two"].map(name),
            ["draw", "draw", "draw", "draw-long", "draw-long", "one", "two"].map(Ok)
        );
        assert_eq!(
            name("bac"),
            Err("\"bac\" may be draw (Back) and draw-long (Back from afar); give more of the name or the title"
                .to_owned())
        );
        assert!(name("TWO").unwrap_err().contains("two (twice) and twice (Two)"));
        assert!(name("three").unwrap_err().contains("carom drill list") && name("").unwrap_err().contains("\"\""));
        assert_eq!(name("back-from-afar"), Ok("draw-long"), "a title with hyphens");
        assert!(library.find_exact("BACK").is_ok() && library.find_exact("bac").is_err(), "a beginning is no title");
    }

    #[test]
    fn filter_accepts_exercises_that_meet_all_criteria() {
        let library = Library::bundled();
        let all = library.find(&Filter::default()).count();
        assert_eq!(all, library.exercises().len());
        let draw = Filter { category: Some(Category::Draw), ..Filter::default() };
        let drawn: Vec<&Exercise> = library.find(&draw).collect();
        assert!(!drawn.is_empty() && drawn.iter().all(|exercise| exercise.category == Category::Draw));
        let wanted = drawn[0];
        let exact = Filter { text: Some(wanted.title.to_uppercase()), grade: Some(wanted.grade), ..draw.clone() };
        assert!(library.find(&exact).any(|exercise| exercise == wanted));
        assert_eq!(library.find(&Filter { grade: Some(wanted.grade + 1), ..exact }).count(), 0);
        let found = |text: &str| library.find(&Filter { text: Some(text.to_owned()), ..Filter::default() }).count();
        assert!(
            found("corner-5") > 0 && found("corner 5") == found("corner-5") && found("5 CORNER") == found("corner-5")
        );
        assert_eq!(found("corner nonsense"), 0);
        assert_eq!(library.find(&Filter { tag: Some("no such tag".to_owned()), ..draw }).count(), 0);
    }

    #[test]
    fn tag_filter_ignores_the_hash_sign() {
        let tagged = |name: &str, tag: &str| Exercise {
            tags: vec![tag.to_owned()],
            ..crate::drills::session::tests::exercise(name)
        };
        let mut library = Library::default();
        // An older version stored the sign.
        for exercise in [tagged("new", "corner"), tagged("old", "#corner"), tagged("other", "rail")] {
            library.add(exercise).unwrap();
        }
        for tag in ["corner", "#corner"] {
            let by_tag = Filter { tag: Some(tag.to_owned()), ..Filter::default() };
            let by_text = Filter { text: Some(tag.to_owned()), ..Filter::default() };
            assert_eq!((library.find(&by_tag).count(), library.find(&by_text).count()), (2, 2), "{tag}");
        }
    }
}
