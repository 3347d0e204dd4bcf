//! The panel that shows the player skill and the rule of the query, and the ways to other screens, as long as there is no shot.

use crossterm::event::KeyCode::F;
use ratatui::layout::Rect;

use crate::{
    coach::Skill,
    game::Rule,
    terminal::{
        CoachAction,
        keymap::{Chord, keys_text},
        pages::coach::{CoachPage, keys::COACH},
        ui::{Ui, draw_title, write_paragraphs},
        words::{named_skill, player_words},
    },
};

/// Draws the panel.
pub fn draw_query(coach: &CoachPage, area: Rect, ui: &mut Ui) {
    let inner = draw_title("The coach", area, ui);
    let [skill_key, rule_key] = [CoachAction::NextSkill, CoachAction::NextRule].map(|action| ui.key_of(COACH, &action));
    let [drills_key, match_key] = [3, 9].map(|n| keys_text(ui.keys.keys_for(Chord::plain(F(n))).take(1), ui.caps));
    let mut paragraphs = vec![
        (format!("Shots for {} at {}.", player_noun(coach.query.skill), game(coach.query.rule)), ui.theme.text()),
        (format!("{skill_key}: how well you play; {rule_key}: the rule."), ui.theme.faint()),
    ];
    if coach.followed().is_none() {
        paragraphs.push((format!("{drills_key}: drills; {match_key}: a match."), ui.theme.faint()));
    }
    let text = Rect { x: inner.x + 1, width: inner.width.saturating_sub(2), ..inner };
    write_paragraphs(&paragraphs, text, ui);
}

/// Describes the player of this skill as a person, with an article.
fn player_noun(skill: Skill) -> String {
    match named_skill(skill) {
        None => player_words(skill).replacen("me", "you", 1).replacen("my", "your", 1),
        Some("expert") => "an expert".to_owned(),
        Some("beginner") => "a beginner".to_owned(),
        Some(name) => format!("a {name} player"),
    }
}

/// The game with this rule, as players call it.
const fn game(rule: Rule) -> &'static str {
    match rule {
        Rule::StraightRail => "straight rail",
        Rule::OneCushion => "one-cushion",
        Rule::ThreeCushion => "three-cushion",
    }
}
