//! The list of exercises, with its filter and its marked (selected) exercise.

use crate::{
    drills::{Category, Exercise, Filter, Library},
    game::Rule,
    terminal::pages::{moved_index, neighbour},
};

/// The exercise library with the state of its list.
#[derive(Debug)]
pub struct Catalogue {
    /// All exercises, shown or not.
    pub library: Library,
    /// Which exercises are shown.
    pub filter: Filter,
    /// Index of the marked exercise among the shown ones.
    pub mark: usize,
}

impl Catalogue {
    /// Creates a list of the whole `library`.
    pub fn new(library: Library) -> Self {
        Self { library, filter: Filter::default(), mark: 0 }
    }

    /// Marks the first exercise of a rule.
    pub fn mark_first_of(&mut self, rule: Rule) {
        self.mark = self.filtered().iter().position(|exercise| exercise.rule == rule).unwrap_or(0);
    }

    /// Replaces the library. The mark stays on its exercise if the new library contains it.
    pub fn set_library(&mut self, library: Library) {
        self.keeping_mark(|list| list.library = library);
    }

    /// The exercises that are shown.
    pub fn filtered(&self) -> Vec<&Exercise> {
        self.library.find(&self.filter).collect()
    }

    /// The marked exercise.
    pub fn marked(&self) -> Option<&Exercise> {
        self.library.find(&self.filter).nth(self.mark)
    }

    /// Whether the marked exercise is a position that the player has saved.
    pub fn is_own_marked(&self) -> bool {
        self.marked().is_some_and(|exercise| !self.library.is_bundled(&exercise.name))
    }

    /// Marks the exercise `name`, or the first one if that is not shown.
    pub fn mark_named(&mut self, name: &str) {
        self.mark = self.library.find(&self.filter).position(|exercise| exercise.name == name).unwrap_or(0);
    }

    /// Moves the mark by `lines`, downwards if positive.
    pub fn move_mark(&mut self, lines: isize) {
        self.mark = moved_index(self.mark, lines, self.filtered().len());
    }

    /// Whether a filter is active.
    pub fn is_filtered(&self) -> bool {
        self.filter != Filter::default()
    }

    /// Changes what is listed. The mark stays on its exercise if that is still shown.
    fn keeping_mark(&mut self, change: impl FnOnce(&mut Self)) {
        let marked = self.marked().map(|exercise| exercise.name.clone());
        change(self);
        self.mark_named(&marked.unwrap_or_default());
    }

    /// Shows all exercises.
    pub fn show_all(&mut self) {
        self.keeping_mark(|list| list.filter = Filter::default());
    }

    /// Shows the category `step` further on. The cycle contains "all categories" between the last and the first.
    pub fn choose_category(&mut self, step: isize) {
        self.keeping_mark(|list| {
            let all: Vec<_> = std::iter::once(None).chain(Category::ALL.map(Some)).collect();
            list.filter.category = neighbour(&all, list.filter.category, step);
        });
    }

    /// Shows only the user's own positions and marks the position `name`.
    pub fn show_own(&mut self, name: &str) {
        self.filter = Filter { category: Some(Category::Own), ..Filter::default() };
        self.mark_named(name);
    }

    /// Shows one grade only; the same grade again shows all grades.
    pub fn choose_grade(&mut self, grade: u8) {
        self.keeping_mark(|list| list.filter.grade = (list.filter.grade != Some(grade)).then_some(grade));
    }

    /// Number of matches of the search in other categories and grades, if it has no match in the current list; otherwise 0.
    pub fn matches_elsewhere(&self) -> usize {
        let wider = Filter { text: self.filter.text.clone(), ..Filter::default() };
        if self.is_searching() && self.marked().is_none() { self.library.find(&wider).count() } else { 0 }
    }

    /// Shows the matches of the search in all categories and grades.
    pub fn search_everywhere(&mut self) {
        let sought = self.search_text();
        self.filter = Filter::default();
        self.search(&sought);
    }

    /// Whether a search is active.
    pub const fn is_searching(&self) -> bool {
        self.filter.text.is_some()
    }

    /// The search text; empty if no search is active.
    pub fn search_text(&self) -> String {
        self.filter.text.clone().unwrap_or_default()
    }

    /// Shows the exercises that contain `text`. Unless the marked one has it in its title, marks the first exercise that does.
    pub fn search(&mut self, text: &str) {
        self.keeping_mark(|list| list.filter.text = (!text.is_empty()).then(|| text.to_owned()));
        let sought = text.to_lowercase();
        let is_titled = |exercise: &Exercise| exercise.title.to_lowercase().contains(&sought);
        if !self.marked().is_some_and(is_titled)
            && let Some(titled) = self.filtered().into_iter().position(is_titled)
        {
            self.mark = titled;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn category_cycle_includes_all_categories() {
        let mut catalogue = Catalogue::new(Library::bundled().clone());
        let all = catalogue.filtered().len();
        catalogue.choose_category(-1);
        assert_eq!(catalogue.filter.category, Some(Category::Own));
        assert!(catalogue.marked().is_none(), "nobody has saved anything");
        catalogue.move_mark(5);
        catalogue.choose_category(1);
        assert_eq!((catalogue.filtered().len(), catalogue.mark), (all, 0));
        for category in Category::ALL {
            catalogue.choose_category(1);
            assert!(catalogue.filtered().iter().all(|exercise| exercise.category == category));
        }
    }

    #[test]
    fn search_marks_first_exercise_with_matching_title() {
        let mut catalogue = Catalogue::new(Library::bundled().clone());
        catalogue.search("natural");
        assert!(catalogue.marked().unwrap().title.to_lowercase().contains("natural"), "{:?}", catalogue.marked());
    }

    #[test]
    fn mark_stays_on_its_exercise_while_list_changes() {
        let mut catalogue = Catalogue::new(Library::bundled().clone());
        catalogue.move_mark(isize::MAX);
        let last = catalogue.marked().unwrap().clone();
        assert_eq!(catalogue.mark + 1, catalogue.filtered().len());
        catalogue.search(&last.title.to_uppercase());
        assert_eq!(catalogue.marked(), Some(&last));
        catalogue.search("no such exercise");
        assert!(catalogue.marked().is_none() && catalogue.is_filtered() && !catalogue.is_own_marked());
        catalogue.show_all();
        catalogue.choose_grade(last.grade);
        catalogue.choose_grade(last.grade);
        assert!(!catalogue.is_filtered());
    }
}
