//! Words for each thing that a binding does, where its keys do several: the help tells them in one line, lists of single
//! things cannot.

use super::{Action, Binding, CoachAction, DrillAction, FinderAction, Section, SettingsAction, TrainingAction};

/// Words for marking another line of a list of `$what`.
macro_rules! mark {
    ($lines:expr, $what:literal) => {
        match $lines {
            1 => Some(concat!("mark the next ", $what)),
            -1 => Some(concat!("mark the ", $what, " before")),
            10 => Some(concat!("go down by ten ", $what, "s")),
            -10 => Some(concat!("go up by ten ", $what, "s")),
            isize::MAX => Some(concat!("mark the last ", $what)),
            isize::MIN => Some(concat!("mark the first ", $what)),
            _ => None,
        }
    };
}

impl Binding {
    /// What its keys for `action` do: its description, unless others of its keys do something else.
    pub fn words(&self, action: Action) -> &'static str {
        let is_all = self.keys.iter().all(|(_, other)| *other == action);
        let own = if is_all { None } else { words(action, self.section) };
        own.unwrap_or(self.description)
    }
}

/// The words of `action` by itself among the keys of `section`, if it has any.
const fn words(action: Action, section: Section) -> Option<&'static str> {
    match action {
        Action::Coach(action) => coach(action),
        Action::Drill(action) => drills(action, section),
        Action::Training(action) => training(action),
        Action::Settings(action) => settings(action, section),
        Action::Finder(FinderAction::Line(lines)) => mark!(lines, "command"),
        _ => None,
    }
}

const fn coach(action: CoachAction) -> Option<&'static str> {
    use CoachAction as A;
    Some(match action {
        A::Select(0) => "select the white ball",
        A::Select(1) => "select the yellow ball",
        A::Select(2) => "select the red ball",
        A::SelectNext => "select the next ball",
        A::SelectPrevious => "select the ball before",
        A::Move(-1, 0, 1.0) => "move the ball left by one step",
        A::Move(1, 0, 1.0) => "move the ball right by one step",
        A::Move(0, -1, 1.0) => "move the ball down by one step",
        A::Move(0, 1, 1.0) => "move the ball up by one step",
        A::Move(-1, 0, 10.0) => "move the ball left by ten steps",
        A::Move(1, 0, 10.0) => "move the ball right by ten steps",
        A::Move(0, -1, 10.0) => "move the ball down by ten steps",
        A::Move(0, 1, 10.0) => "move the ball up by ten steps",
        A::Move(-1, 0, 0.1) => "move the ball left by a tenth of a step",
        A::Move(1, 0, 0.1) => "move the ball right by a tenth of a step",
        A::Move(0, -1, 0.1) => "move the ball down by a tenth of a step",
        A::Move(0, 1, 0.1) => "move the ball up by a tenth of a step",
        A::LargerStep => "choose a larger step",
        A::SmallerStep => "choose a smaller step",
        A::NextEvent => "step to the next event",
        A::PreviousEvent => "step to the event before",
        A::ToStart => "to the stroke",
        A::ToEnd => "to the end of the shot",
        A::Faster => "play faster",
        A::Slower => "play slower",
        A::NextRule => "choose the rule: what counts as a point",
        A::NextSkill => "choose the player",
        A::TurnPlan => "choose the plan: whether the next point counts too",
        A::NextShot => "show the next of the coach's shots",
        A::PreviousShot => "show the one before of the coach's shots",
        _ => return None,
    })
}

const fn drills(action: DrillAction, section: Section) -> Option<&'static str> {
    use DrillAction as A;
    Some(match action {
        A::Line(lines) => {
            return match (section, lines) {
                (Section::Record, 1) => Some("earlier sessions, by one line"),
                (Section::Record, -1) => Some("later sessions, by one line"),
                (Section::Record, 10) => Some("earlier sessions, by ten lines"),
                (Section::Record, -10) => Some("later sessions, by ten lines"),
                (Section::Film, _) => mark!(lines, "shot"),
                _ => mark!(lines, "exercise"),
            };
        }
        A::Category(1) => "list the next category",
        A::Category(-1) => "list the category before",
        A::Grade(1) => "list grade 1 alone, the easiest; once more lists all",
        A::Grade(2) => "list grade 2 alone; once more lists all",
        A::Grade(3) => "list grade 3 alone; once more lists all",
        A::Grade(4) => "list grade 4 alone; once more lists all",
        A::Grade(5) => "list grade 5 alone, the hardest; once more lists all",
        A::Exam(1) => "an exam of grade 1 to 3: 20 exercises, one attempt each",
        A::Exam(2) => "an exam of grade 2 to 4: 20 exercises, one attempt each",
        A::Exam(3) => "an exam of grade 3 to 5: 20 exercises, one attempt each",
        A::Turn(0.2) => "aim left by 0.2 degrees",
        A::Turn(-0.2) => "aim right by 0.2 degrees",
        A::Turn(5.0) => "aim left by 5 degrees",
        A::Turn(-5.0) => "aim right by 5 degrees",
        A::Turn(0.01) => "aim left by 0.01 degrees",
        A::Turn(-0.01) => "aim right by 0.01 degrees",
        A::Tip(0.5, 0.0) => "move the tip left by 0.5 mm",
        A::Tip(-0.5, 0.0) => "move the tip right by 0.5 mm",
        A::Tip(0.0, -0.5) => "move the tip down by 0.5 mm",
        A::Tip(0.0, 0.5) => "move the tip up by 0.5 mm",
        A::Tip(3.0, 0.0) => "move the tip left by 3 mm",
        A::Tip(-3.0, 0.0) => "move the tip right by 3 mm",
        A::Tip(0.0, -3.0) => "move the tip down by 3 mm",
        A::Tip(0.0, 3.0) => "move the tip up by 3 mm",
        A::Faster(0.1) => "strike harder by 0.1 m/s",
        A::Faster(-0.1) => "strike softer by 0.1 m/s",
        A::Faster(0.5) => "strike harder by 0.5 m/s",
        A::Faster(-0.5) => "strike softer by 0.5 m/s",
        A::Raise(1.0) => "raise the cue by 1 degree",
        A::Raise(-1.0) => "lower the cue by 1 degree",
        A::Event(1) => "step to the next event",
        A::Event(-1) => "step to the event before",
        A::Pace(1) => "play faster",
        A::Pace(-1) => "play slower",
        A::Filmed(1) => "watch the next shot",
        A::Filmed(-1) => "watch the shot before",
        A::Log(true) => "note a point at a real table; nothing is played here",
        A::Log(false) => "note a miss at a real table; nothing is played here",
        A::Count(1) => "a longer goal",
        A::Count(-1) => "a shorter goal",
        _ => return None,
    })
}

const fn training(action: TrainingAction) -> Option<&'static str> {
    use TrainingAction as A;
    Some(match action {
        A::Line(lines) => return mark!(lines, "run"),
        A::Field(1) => "go to the next field",
        A::Field(-1) => "go to the field before",
        A::Value(1) => "choose the next value; numbers can be typed as well",
        A::Value(-1) => "choose the value before; numbers can be typed as well",
        A::Zoom(1) => "show fewer shots",
        A::Zoom(-1) => "show more shots",
        A::Chart(1) => "select the next chart",
        A::Chart(-1) => "select the chart before",
        A::Show(0) => "show or hide the mean reward",
        A::Show(1) => "show or hide the mean Q-value",
        A::Show(2) => "show or hide the critic loss",
        A::Show(3) => "show or hide the held-out success",
        A::Show(4) => "show or hide the actor loss",
        A::Show(5) => "show or hide whether any proposal scores",
        A::Show(6) => "show or hide the shots a second",
        A::Show(7) => "show or hide the updates a second",
        A::Show(8) => "show or hide the exploration",
        A::Pan(1) => "show later shots",
        A::Pan(-1) => "show earlier shots",
        A::Shot(1) => "the next shot",
        A::Shot(-1) => "the shot before",
        _ => return None,
    })
}

const fn settings(action: SettingsAction, section: Section) -> Option<&'static str> {
    use SettingsAction as A;
    Some(match action {
        A::Line(lines) if matches!(section, Section::Settings) => return mark!(lines, "setting"),
        A::Line(lines) => return mark!(lines, "line"),
        A::Value(1) => "take the next value",
        A::Value(-1) => "take the value before",
        A::Place(1) => "list the keys of the next page",
        A::Place(-1) => "list the keys of the page before",
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        learning::run::quantity::Quantity,
        terminal::{
            finder::{Command, commands},
            keymap::tests::places,
            look::{Depth, Glyphs, Look},
            settings::Keys,
        },
    };

    #[test]
    fn no_two_things_that_can_be_done_at_a_place_have_the_same_words() {
        let look = Look { depth: Depth::Mono, glyphs: Glyphs::Letters, unicode: true };
        for place in places() {
            let all = commands(place, &Keys::default(), look);
            for (n, one) in all.iter().enumerate() {
                let is_same = |other: &&Command| other.description == one.description && other.action != one.action;
                let same = all[n + 1..].iter().find(is_same);
                assert!(same.is_none(), "{place:?}: {one:?} and {same:?}");
            }
        }
    }

    #[test]
    fn the_charts_have_the_names_of_what_they_show() {
        for (n, quantity) in Quantity::ALL.iter().enumerate() {
            let words = training(TrainingAction::Show(n)).unwrap();
            assert!(words.ends_with(quantity.name()), "{words}: {}", quantity.name());
        }
    }
}
