//! Commands that print lines, at a terminal.

use crate::terminal::{Session, carom};

#[test]
fn play_states_skill_and_rule_with_words_wrapped() {
    let mut command = carom();
    command.args(["play", "--rule", "3c", "--skill", "0,6"]);
    let mut session = Session::start_command(command, 60, 24);
    session.wait_for("shot, coach, help or quit: ");
    let shown = session.screen().contents();
    let beginning = "For a player who averages 0.6 at three-cushion under the\n\
                     rule three-cushion; --skill and --rule choose others. The\n\
                     screen's skill and rule are not used.\n\
                     game (three-cushion): white 2d,2.51d  yellow 2d,2d  red\n\
                     6d,2d\n";
    assert!(shown.starts_with(beginning), "{shown}");
}
