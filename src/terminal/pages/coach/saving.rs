//! Saving the balls as a practice position. The page asks for a title, and for a confirmation if a position with the same name
//! exists already.

use crate::{
    drills::{Category, Exercise, Library, MAX_TITLE_BYTES, bare_tag},
    storage::is_name,
    terminal::{
        DrillTask, Effect,
        pages::coach::{CoachPage, question::Question},
        ui::{Message, TextField},
        words::name_taken_message,
    },
};

/// The bundled table for which positions on custom tables are saved.
const FALLBACK_TABLE: &str = "match";

/// Maximum length of a name that is derived from a title, characters.
const MAX_NAME_LENGTH: usize = 40;

impl CoachPage {
    /// Asks for the title of the current position. The position includes the displayed shot if that makes the point. Positions can be
    /// shared, so one on a custom table is saved for [`FALLBACK_TABLE`], without the shot, which is different there.
    pub(super) fn ask_title(&mut self) {
        self.playback.pause();
        let shot = self.shot().filter(|shot| shot.solved).map(|shot| shot.cue);
        let on = |table: &str| Exercise::new_own("", self.query.rule, table, *self.layout());
        let here = Exercise { shot, ..on(&self.table().name) };
        let is_bundled = here.table().is_ok_and(|known| known == *self.table());
        let position = if is_bundled { here } else { on(FALLBACK_TABLE) };
        if position.table().is_ok() {
            self.question = Some(Question::Title(TextField::new(MAX_TITLE_BYTES), Box::new(position)));
        } else {
            let name = &self.table().name;
            let words = format!(
                "a position of your own table \"{name}\" is saved for \"{FALLBACK_TABLE}\", where these balls cannot lie"
            );
            self.message = Some(Message::warning(words));
        }
    }

    /// Saves a position; `replace` allows overwriting one with the same name.
    pub(super) fn save(&mut self, exercise: Box<Exercise>, replace: bool) -> Effect {
        self.saving_name = Some(exercise.name.clone());
        Effect::Drill(vec![DrillTask::SavePosition(exercise, replace)])
    }

    /// Whether this page has saved the position `name`. Returns `true` only once per save.
    pub fn has_saved(&mut self, name: &str) -> bool {
        self.saving_name.take_if(|saving_name| saving_name == name).is_some()
    }

    /// Handles the result of saving a position: `Ok(true)` if it is on the disk, `Ok(false)` if one with the same name exists, or the
    /// message of an error.
    pub fn saved(&mut self, exercise: Box<Exercise>, outcome: Result<bool, String>) {
        let name = &exercise.name;
        match outcome {
            Ok(true) => {
                let list = Category::Own.title();
                let other = exercise.table != self.table().name;
                let table = if other { format!(" for the table {}", exercise.table) } else { String::new() };
                self.message = Some(Message::good(format!("saved as {name}{table}; the drills list it under {list}")));
            }
            Ok(false) if self.question.is_some() => self.message = Some(Message::warning(name_taken_message(name))),
            Ok(false) => self.question = Some(Question::Replace(exercise)),
            Err(sentence) => self.message = Some(Message::warning(format!("{name} is not saved: {sentence}"))),
        }
    }
}

/// Returns the position with title, name and tags from the typed text.
///
/// # Errors
/// Returns a message if the text gives no valid name, or the name of a bundled exercise.
pub(super) fn named(typed: &str, position: &Exercise) -> Result<Box<Exercise>, String> {
    let (title, name, tags) = title_name_tags(typed)?;
    if Library::bundled().is_bundled(&name) {
        return Err(format!("{name} is the name of a bundled exercise; take another"));
    }
    Ok(Box::new(Exercise { name, title, tags, ..position.clone() }))
}

/// Parses the typed text into the title of a position, the name derived from it, and the tags.
///
/// # Errors
/// Returns a message if the title gives no valid name.
fn title_name_tags(typed: &str) -> Result<(String, String, Vec<String>), String> {
    let (tags, words): (Vec<&str>, Vec<&str>) = typed.split_whitespace().partition(|word| word.starts_with('#'));
    let title = words.join(" ");
    let mut name = String::new();
    for letter in title.to_lowercase().chars() {
        match letter {
            _ if letter.is_alphanumeric() => name.push(letter),
            // Any run of other characters between two words becomes one hyphen.
            _ if !name.is_empty() && !name.ends_with('-') => name.push('-'),
            _ => {}
        }
    }
    let name: String = name.chars().take(MAX_NAME_LENGTH).collect();
    let name = name.trim_end_matches('-').to_owned();
    if !is_name(&name) {
        return Err(format!("\"{title}\" gives no name; use letters or digits"));
    }
    let tags = tags.iter().map(|tag| bare_tag(tag).to_owned()).filter(|tag| !tag.is_empty()).collect();
    Ok((title, name, tags))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn title_gives_valid_name_and_tags_are_split_off() {
        let (title, name, tags) = title_name_tags("  Draw to the #draw  corner, (hard!)  #club #").unwrap();
        assert_eq!((title.as_str(), name.as_str()), ("Draw to the corner, (hard!)", "draw-to-the-corner-hard"));
        assert_eq!(tags, ["draw", "club"]);
        assert!(is_name(&title_name_tags(&"a very long title ".repeat(20)).unwrap().1));
        for bad in ["", " #tag ", "(?)", "---"] {
            assert!(title_name_tags(bad).is_err(), "{bad}");
        }
    }
}
