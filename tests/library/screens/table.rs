//! Display of a shot: the table, the hit and the spin.

use carom::terminal::{Capabilities, CoachEvent, Glyphs, Proposal};
use ratatui::{buffer::Buffer, style::Color};

use super::player::{ASCII, NO_COLOUR, Player, SIZES, TRUE_COLOUR, advice_of, check, check_at, proposal};

const OCTANTS: Capabilities = Capabilities { glyphs: Glyphs::Octant, ..TRUE_COLOUR };

/// Returns a player to whom the coach has shown this shot.
fn advised(caps: Capabilities, cue: &str) -> Player {
    let mut player = Player::with(caps).press("Enter");
    let job = player.advice_job.take().unwrap();
    let shot = Proposal { made: None, next: None, ..proposal(&job.table, &job.layout, cue, 0) };
    player.tell(job.id, CoachEvent::Advice(advice_of(vec![shot])))
}

/// Counts the cells of the table with this foreground colour.
fn count(picture: &Buffer, color: Color) -> usize {
    picture.content()[..30 * 120].iter().filter(|cell| cell.fg == color && cell.symbol() != " ").count()
}

#[test]
fn octants_are_drawn_only_on_request() {
    let is_octant = |text: &str| text.chars().any(|one| ('\u{1CD00}'..='\u{1CDE5}').contains(&one));
    let asked = Player::with(OCTANTS).press("Enter").answer();
    check_at(&[(120, 40)], "octants", &asked);
    assert!(is_octant(&asked.text(80, 24)));
    let round = asked.press("g g g");
    assert!(!is_octant(&round.text(120, 40)));
    assert!(is_octant(&round.press("g").text(120, 40)));
    let mut player = Player::new().press("Enter").answer();
    for _ in 0..4 {
        player = player.press("g");
        assert!(!is_octant(&player.text(120, 40)));
    }
}

#[test]
fn the_travelled_path_fades_behind_the_trail() {
    // The yellow ball's path, the same path blended into the cloth, and the ball itself.
    let (path, past, ball) = (Color::Rgb(0xd8, 0xc0, 0x5a), Color::Rgb(0x79, 0x96, 0x6e), Color::Rgb(0xf6, 0xc3, 0x24));
    let start = Player::new().press("Enter").answer();
    let before = start.picture(120, 40);
    assert_eq!(count(&before, past), 0);
    let later = start.press("Space").wait(7.0).picture(120, 40);
    assert!(count(&later, path) < count(&before, path));
    assert!(count(&later, past) > 5, "{}", count(&later, past));
    assert!(count(&later, ball) > count(&before, ball), "the trail has the ball's colour");
}

#[test]
fn the_spin_replaces_the_hit_during_playback() {
    for caps in [TRUE_COLOUR, NO_COLOUR, ASCII] {
        let player = advised(caps, "0.3,-0.3,0,90,3").press("Space").wait(0.15);
        if caps == TRUE_COLOUR {
            check("spin", &player);
        } else {
            player.is_plain();
        }
        for size in SIZES {
            player.shows_at(size, &["Spin", "left"]).hides_at(size, &["Hit"]);
        }
        player.press("End").shows_at((80, 24), &["Hit"]).hides_at((80, 24), &["Spin"]);
    }
}

#[test]
fn draw_follow_sliding_and_rolling_are_labelled() {
    for (cue, wait, word) in [
        ("0,-0.4,0,0,3", 0.11, "draw"),
        ("0,0.49,0,0,8", 0.11, "follow"),
        ("0,0,0,0,3", 0.11, "slides"),
        ("0,0.4,0,0,1", 0.25, "rolls"),
    ] {
        let text = advised(TRUE_COLOUR, cue).press("Space").wait(wait).text(120, 40);
        let ball = text.lines().find(|line| line.contains("● white")).unwrap();
        assert!(ball.contains(word) && text.matches(word).count() >= 2, "{cue}: {word}\n{text}");
    }
}

#[test]
fn a_first_cushion_is_named_instead_of_the_fullness() {
    let bank = advised(TRUE_COLOUR, "0,0,3,-173,4");
    let contact = bank.app.coach.shot().unwrap().words.first;
    assert_eq!(contact.map(|hit| hit.ball), Some(1), "back from the short rail to the yellow ball");
    bank.shows(&["left rail", "first, then", "yellow "]);
    advised(TRUE_COLOUR, "0,0,0,-45,0.2").shows_at((120, 40), &["nothing"]);
}
