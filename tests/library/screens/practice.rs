//! Exercises to practise, and sessions that were played.

use carom::{
    coach::Skill,
    drills::{Attempt, Category, Exercise, Goal, Session, Venue},
    game::Rule,
    table::{Layout, Table},
};

use super::player::{SHOT, cue};

/// Returns an exercise at the opening position, with the shot that makes the point.
pub fn exercise(name: &str, title: &str) -> Exercise {
    Exercise {
        name: name.to_owned(),
        title: title.to_owned(),
        category: Category::Own,
        grade: 0,
        rule: Rule::StraightRail,
        table: "match".to_owned(),
        layout: Layout::opening(&Table::default()),
        point: "The first shot of every match. Hit half of red with left side and let the cushions do the rest."
            .to_owned(),
        tags: vec!["opening".to_owned()],
        shot: Some(cue(SHOT)),
        par: None,
    }
}

/// Returns a session at a real table on a day of November 2026, one attempt per letter: `x` is made, any other missed.
pub fn session(number: u64, name: &str, goal: Goal, results: &str) -> Session {
    let mut session = Session::new(goal, Venue::Table, vec![exercise(name, "From the opening")], Skill::CLUB, 1);
    session.id = format!("202611{number:02}-120000-0000000{number}");
    session.started = 1_793_534_400 + number * 86_400;
    session.attempts =
        results.chars().map(|result| Attempt { at: session.started, ..Attempt::new(name, result == 'x') }).collect();
    session
}

/// Returns more positions than fit on a screen.
pub fn many_positions() -> Vec<Exercise> {
    (1..=60).map(|n| exercise(&format!("position-{n:02}"), &format!("Position number {n} of a long list"))).collect()
}

/// Returns three sessions at one position.
pub fn three_sessions() -> Vec<Session> {
    vec![
        session(1, "opening", Goal::Free, "x-x--x-x--"),
        session(2, "opening", Goal::Run(5), "xx-xxx-xxxxx"),
        session(5, "opening", Goal::Free, "xxxx-xxxxxxx-xx"),
    ]
}
