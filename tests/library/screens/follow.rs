//! Spectators: the shown table, and the same table on the screen of another player.

use carom::{
    storage::{Lock, Player as Name},
    table::{Layout, Table},
    terminal::{Activity, App, Effect, FollowedTableState, KeyContext, Seat, SharedTable, TableWatcher},
};

use super::{
    keys::key,
    player::{ASCII, NO_COLOUR, Player, SIZES, TRUE_COLOUR, drawn, places},
};

/// Returns a player with a name.
fn anna() -> Player {
    let mut player = Player::new();
    let app = App::new(Table::default(), Layout::opening(&Table::default()), TRUE_COLOUR, 7).unwrap();
    let name: Name = "anna".parse().unwrap();
    player.app = app.with_seat(&Seat { player: Some(name), paths: places("/anna".as_ref()), is_guest: false });
    player
}

/// Returns what a spectator sees.
fn seen(shown: &SharedTable) -> FollowedTableState {
    let folder = tempfile::tempdir().unwrap();
    let _lock = Lock::try_acquire(folder.path()).unwrap();
    shown.write(folder.path()).unwrap();
    TableWatcher::new(folder.path().to_owned()).poll().unwrap()
}

fn following(caps: carom::terminal::Capabilities) -> App {
    let table = Table::default();
    let layout = Layout::opening(&table);
    App::new(table, layout, caps, 7).unwrap().following("anna".to_owned(), "/anna".into())
}

fn picture(app: &mut App, (width, height): (u16, u16)) -> String {
    app.resize((width, height).into());
    drawn(app, width, height).backend().to_string()
}

#[test]
fn a_table_is_shown_only_on_request_with_a_notice() {
    let player = anna().press("Right Enter").answer();
    assert!(player.app.shared_table().is_none());
    let player = player.press("F");
    player.says("shown to others: carom follow anna shows this table");
    let player = player.press("Esc Right");
    player.says("shown to others: white at x");
    assert_eq!(player.app.shared_table().unwrap().doing, Activity::Placing);
    let player = player.press("Enter");
    assert_eq!(player.app.shared_table().unwrap().doing, Activity::Thinking);
    let player = player.answer().press("w l");
    assert!(player.app.shared_table().unwrap().shot.is_some());
    let player = player.press("F3");
    assert_eq!(player.app.shared_table().unwrap().doing, Activity::Elsewhere);
    let player = player.press("F2 F");
    assert!(player.app.shared_table().is_none());
    let nameless = Player::new().press("F");
    assert!(nameless.app.shared_table().is_none());
    assert!(nameless.app.toasts.shown[0].text.contains("carom --player NAME"));
}

#[test]
fn a_spectator_sees_the_same_table_and_cannot_change_it() {
    let mut player = anna().press("F Enter").answer();
    for caps in [TRUE_COLOUR, NO_COLOUR, ASCII] {
        let mut app = following(caps);
        let before = picture(&mut app, (80, 24));
        assert!(before.contains("anna shows no table at the moment") && before.contains("q ends it"), "{before}");
        let shown = player.app.shared_table().unwrap();
        app.coach.receive_shared(seen(&shown));
        assert_eq!(
            (app.key_context(), app.coach.layout(), app.saved_session()),
            (KeyContext::Follow, player.app.coach.layout(), None)
        );
        for size in SIZES {
            let there = picture(&mut app, size);
            assert!(there.contains("following anna: match, straight, expert") && !there.contains("Enter"), "{there}");
            if caps == TRUE_COLOUR {
                let own = picture(&mut player.app, size);
                let rows = |text: &str| text.lines().skip(2).take(10).map(str::to_owned).collect::<Vec<_>>();
                assert_eq!(rows(&there), rows(&own), "the table");
            }
        }
        for pressed in ["Right", "Enter", "Space", "F", "r", "o", "u", "w", "Tab", "p", "s", "F2", "F4", "F5", "n"] {
            let effect: Option<Effect> = app.handle(&key(pressed));
            assert!(effect.is_none(), "{pressed}: {effect:?}");
        }
        app.paste("-0.5,0 0,0 0.5,0.03");
        assert_eq!((app.key_context(), app.coach.layout()), (KeyContext::Follow, player.app.coach.layout()));
        assert!(!app.coach.playback.playing && app.shared_table().is_none());
    }
    insta::assert_snapshot!(picture(
        &mut {
            let mut app = following(TRUE_COLOUR);
            app.coach.receive_shared(seen(&player.app.shared_table().unwrap()));
            app
        },
        (80, 24)
    ));
}

#[test]
fn a_followed_shot_plays_and_disappears_with_the_table() {
    let player = anna().press("F Enter").answer().press("Space");
    let mut app = following(TRUE_COLOUR);
    app.coach.receive_shared(seen(&player.app.shared_table().unwrap()));
    assert!(app.coach.playback.playing && app.frame_interval().is_some());
    app.tick(0.5);
    assert!(app.coach.playback.time >= 0.5);
    let player = player.press("End");
    app.coach.receive_shared(seen(&player.app.shared_table().unwrap()));
    let there = picture(&mut app, (80, 24));
    assert!(!app.coach.playback.playing && there.contains("oint"), "{there}");
    app.coach.receive_shared(FollowedTableState::Nothing);
    assert!(picture(&mut app, (80, 24)).contains("anna shows no table at the moment"));
    app.coach.receive_shared(FollowedTableState::Damaged);
    let there = picture(&mut app, (80, 24));
    assert!(there.contains("cannot be read") && app.frame_interval().is_none(), "{there}");
    assert!(app.handle(&key("q")).is_some_and(|effect| matches!(effect, Effect::Quit)));
}
