//! The calibration page through the real app: strokes are entered, saved, edited and judged, and the table is played on.

use std::fs;

use carom::{
    calibration::{Edit, Entries, Entry, PROTOCOL, edit_entries},
    terminal::{CalibrationContext, KeyContext, PageId},
};

use super::keys::key;
use super::player::{ASCII, NO_COLOUR, Player, TRUE_COLOUR, check_at};

/// The marks of a slow roll and of a lag on `match`, in the order of their forms.
const ROLL: [&str; 4] = ["9.6", "5.4", "725 mm", ""];
const LAG: [&str; 4] = ["4.4", "8", "3.5", ""];

fn new() -> Player {
    Player::with(TRUE_COLOUR).press("F7")
}

/// Types marks into the form of the selected test, field by field.
fn enter(player: Player, marks: &[&str]) -> Player {
    let player = player.press("Enter");
    marks.iter().fold(player, |player, mark| player.type_in(mark).press("Enter"))
}

/// Returns the content of the file of entries.
fn saved_entries(player: &Player) -> Entries {
    Entries::parse(&fs::read_to_string(player.path("calibration.toml")).unwrap_or_default()).unwrap()
}

/// Returns a player with a slow roll and a lag entered.
fn measured() -> Player {
    let player = enter(new(), &ROLL).press("Down Down");
    enter(player, &LAG)
}

#[test]
fn the_title_of_every_test_fits_80_columns() {
    PROTOCOL.iter().fold(new(), |player, test| {
        let text = player.text(80, 24);
        assert!(text.contains(test.title), "{}: {text}", test.title);
        player.press("Down")
    });
}

#[test]
fn mark_descriptions_in_the_form_fit_80_columns() {
    let text = new().press("Down Down Down Down Down Enter").text(80, 24);
    let row = text.lines().find(|row| row.contains("c fourth")).unwrap();
    assert!(row.contains("meets your own short rail") && !row.contains('…'), "{row}");
}

#[test]
fn each_test_shows_ball_positions_stroke_and_information() {
    let player = new();
    assert_eq!(player.app.screen, PageId::Calibration);
    player.shows(&["slow-roll", "0/2", "put: any ball in the middle of your end", "strike: straight", "time", "bits"]);
    player.says("0 of 20 strokes");
    let corner = player.press("Down Down Down Down");
    corner.shows(&["Corner-5, 50 to 20", "3 tips right", "first", "third", "fourth"]);
    let best = corner.press("n");
    best.says("helps most");
    let out = best.press("Home x");
    out.says("slow-roll is left out").says("0 of 18 strokes");
    assert!(out.press("x").text(120, 40).contains("0 of 20 strokes"));
    for keys in ["", "Tab", "Enter", "? "] {
        Player::with(NO_COLOUR).press("F7").press(keys).is_plain();
        Player::with(ASCII).press("F7").press(keys).is_plain();
    }
}

#[test]
fn every_mark_of_a_form_has_a_row_at_80_columns() {
    for (n, test) in PROTOCOL.iter().enumerate() {
        let rows: Vec<String> =
            test.field_names().zip('a'..).map(|(name, letter)| format!("{letter} {name:<7} -")).collect();
        let mut form = new().press(&"Down ".repeat(n)).press("Enter");
        for name in test.field_names() {
            let text = form.text(80, 24);
            assert!(text.contains(&format!(" {name}: ")), "{name} of {}: {text}", test.name);
            assert!(rows.iter().all(|row| text.contains(row)), "{}: {text}", test.name);
            form = form.press("Down");
        }
    }
}

#[test]
fn constants_have_short_names_where_long_ones_do_not_fit() {
    let player = measured();
    player.says("rolling mu_r");
    let values = player.press("Tab");
    values.says("rolling mu_r").says("rail grip mu_rail").says("fast bounce ").says("lean across tilt.y");
    values.shows_at((120, 40), &[" mu_r ", "friction of rolling balls"]);
}

#[test]
fn the_tip_offset_uses_the_unit_of_the_settings() {
    let mm = Player::with_settings(TRUE_COLOUR, "tip_unit = \"mm\"\n").press("F7").press("Down Down Down Down");
    mm.shows(&["9.2 mm right"]);
}

#[test]
fn the_stroke_speed_uses_the_unit_of_the_settings() {
    new().shows(&["at 0.3 m/s"]);
    let feet = Player::with_settings(TRUE_COLOUR, "length_unit = \"feet\"\n").press("F7");
    feet.shows(&["at 1.0 ft/s"]).does_not_show("m/s");
}

#[test]
fn names_are_separated_from_their_values() {
    let form = enter(new().press("Down Down Down"), &["1.3"]);
    let values = enter(Player::with(ASCII).press("F7"), &ROLL);
    for (width, height) in [(80, 24), (120, 40), (200, 60)] {
        let text = form.text(width, height);
        assert!(text.contains("a lengths 1.3 s"), "{text}");
        let text = values.text(width, height);
        let names: Vec<&str> = text.lines().filter_map(|row| Some(row.split_once(" +-")?.0)).collect();
        let is_apart =
            |before: &&str| before.split_whitespace().last().is_some_and(|value| value.parse::<f64>().is_ok());
        assert!(names.len() > 1 && names.iter().all(is_apart), "{text}");
    }
    assert!(values.text(80, 24).contains("rolling mu_r 0.00"), "{}", values.text(80, 24));
}

#[test]
fn an_entered_stroke_is_saved_and_updates_the_estimates() {
    let player = enter(new(), &ROLL);
    assert_eq!(saved_entries(&player).trials.len(), 1);
    player.shows(&["1/2", "9.6, 5.4, 725 mm", "mu_r"]);
    let values = player.press("Tab");
    values.shows(&["mu_r", "well", "no better", "all marks agree with each other", "helps most"]);
    let again = enter(values, &["9.3", "5.1 ~ 0.2", "2", ""]);
    assert_eq!(saved_entries(&again).trials[1].field_text("stop"), "5.1 ~ 0.2");
    // Both strokes are entered: the next test is selected.
    again.shows(&["2/2", "Strokes of slow-back"]);
    let rolled = again.press("Home");
    check_at(&[(80, 24)], "entered", &rolled);
    rolled.press("Enter").shows(&["time: seconds from the stroke until the ball stops"]);
}

#[test]
fn invalid_marks_are_named_and_remain_editable() {
    let player = new().press("Enter").type_in("9.6").press("Enter").type_in("99").press("Enter");
    player.warns("slow-roll: stop = 99: no ball can be there; accepted is 0 to 8 diamonds");
    assert_eq!(player.app.key_context(), KeyContext::Calibration(CalibrationContext::Marks));
    assert!(saved_entries(&player).trials.is_empty());
    let player = player.press("Backspace Backspace").type_in("5.4").press("Enter Enter Enter");
    assert_eq!(saved_entries(&player).trials[0].field_text("stop"), "5.4");
    for (marks, says) in [
        (["240", "", "", ""], "the stopwatch was left running; accepted is 0.2 to"),
        (["abc", "", "", ""], "time = \"abc\" is no time; accepted is a number of"),
        (["", "", "", ""], "nothing is marked yet"),
        (["9", "5", "", "two"], "rails two is no number of rails"),
    ] {
        enter(new(), &marks).warns(says);
    }
    let taped = new().press("Enter Down").type_in("5.4").press("C-t");
    taped.says("by tape, right to 5 mm");
    let taped = taped.press("Enter Enter Enter");
    assert_eq!(saved_entries(&taped).trials[0].field_text("stop"), "5.4 ~ 5 mm");
    let left = new().press("Enter").type_in("9").press("Esc");
    assert_eq!(left.app.key_context(), KeyContext::Calibration(CalibrationContext::Tests));
    assert_eq!(saved_entries(&left), Entries::default());
}

#[test]
fn a_stroke_can_be_marked_as_played_from_the_far_end() {
    let form = new().press("Enter C-e");
    form.says("far end; time: seconds from the stroke until the ball stops");
    let form = form.type_in("9.6").press("Enter").type_in("5.4").press("Enter Enter Enter");
    assert!(saved_entries(&form).trials[0].far_end);
    form.shows(&["far end: 9.6, 5.4"]);
    let edited = form.press("Home e C-e Enter Enter Enter Enter");
    assert_eq!(saved_entries(&edited).trials.iter().map(|entry| entry.far_end).collect::<Vec<_>>(), [false]);
}

#[test]
fn strokes_can_be_edited_deleted_and_restored() {
    let player = measured().press("Home");
    let edited = player.press("e Down Backspace").type_in("5").press("Enter Enter Enter");
    assert_eq!(saved_entries(&edited).trials[0].field_text("stop"), "5.5");
    let out = edited.press("Home Delete");
    assert_eq!(saved_entries(&out).trials.len(), 1);
    let back = out.press("u");
    assert_eq!(saved_entries(&back).trials[0].field_text("stop"), "5.5");
    let back = back.press("u");
    assert_eq!(saved_entries(&back).trials[0].field_text("stop"), "5.4");
    let none = back.press("u u");
    assert!(saved_entries(&none).trials.is_empty());
    none.press("u").warns("nothing to undo yet");
    let anew = measured().press("N y");
    anew.says("u undoes this");
    assert!(saved_entries(&anew).trials.is_empty() && anew.path("calibration.before.toml").exists());
    assert_eq!(saved_entries(&anew.press("u")).trials.len(), 2);
}

#[test]
fn a_skipped_test_does_not_count_until_undo() {
    let out = measured().press("Home x");
    out.says("slow-roll is left out, with what is entered of it");
    out.shows(&["1 of 18 strokes"]);
    let back = out.press("u");
    back.says("slow-roll counts again");
    back.shows(&["2 of 20 strokes"]);
    assert_eq!(saved_entries(&back).trials.len(), 2);
}

#[test]
fn long_reports_on_the_marks_are_paged() {
    let odd = |player: Player, stop: &str| enter(player.press("Home"), &["9.6", stop, "2", ""]);
    let entered = ["1", "2", "7"].into_iter().fold(measured(), odd);
    entered.says("stroke 4 of slow-roll looks misread: you marked");
    // Earlier a wide screen said it in the status line too.
    for (width, height) in [(80, 24), (120, 40)] {
        let text = entered.text(width, height);
        assert_eq!(text.matches("stroke 4 of slow-roll looks misread").count(), 1, "{text}");
    }
    let values = entered.press("Tab");
    let first = values.text(80, 24);
    assert!(first.contains("values, 1 of 2: PgDn"), "{first}");
    let second = values.press("PageDown");
    assert!(second.text(80, 24).contains("values, 2 of 2: PgDn"), "{}", second.text(80, 24));
    assert_eq!(second.press("PageDown").text(80, 24), first);
}

#[test]
fn command_and_page_share_the_file_without_overwriting_damage() {
    let player = enter(new(), &ROLL);
    let path = player.path("calibration.toml");
    let mut other = Entry { test: "lag".into(), ..Entry::default() };
    other.set_field("lap", "4.4").unwrap();
    edit_entries(&path, &Edit::Add(other.clone())).unwrap();
    let player = enter(player, &ROLL);
    assert_eq!((saved_entries(&player).trials.len(), &saved_entries(&player).trials[1]), (3, &other));
    fs::write(&path, "[[trial]]\ntest = \"lag\"\nrest = 240\n").unwrap();
    let odd = player.press("F2 F7 Tab");
    odd.says("trial 1 (lag): rest = 240: no ball rolls that long");
    odd.press("s").warns("an entry looks wrong (see values)");
    let broken = Player::with(TRUE_COLOUR);
    fs::write(broken.path("calibration.toml"), "broken").unwrap();
    let broken = broken.press("F7");
    broken.warns("line 1");
    broken.press("Enter").warns("the file of entries cannot be read: repair it, or N moves it aside");
}

#[test]
fn a_table_is_saved_selected_and_checked_daily() {
    let player = measured();
    player.press("p").warns("save the table first");
    let player = measured().press("s");
    player.says("the table's name = ");
    let player = player.press("C-u").type_in("our club/2").press("Enter");
    player.warns("is not a table name; use letters");
    let player = player.press("C-u").type_in("match").press("Enter");
    player.warns("\"match\" is the name of a bundled table; take another");
    let player = player.press("C-u").type_in("our club 2").press("Enter");
    let file = player.path("tables/our club 2.toml");
    assert!(file.exists(), "{}", player.text(120, 40));
    let player = player.press("p");
    player.says("you now play on our club 2, at every start too");
    assert_eq!(player.app.coach.table().name, "our club 2");
    let player = player.press("F2");
    player.says("the table is now our club 2; Enter asks the coach");
    let player = player.press("F7");
    assert!(player.app.coach.table().doubt.is_some());
    assert!(player.settings_text().contains("our club 2.toml"), "{}", player.settings_text());
    // Another table of the same name is saved only after confirmation.
    let player = player.press("s C-u").type_in("our club 2").press("Enter");
    player.says("there is a table called our club 2 already; replace it?");
    let player = player.press("y");
    player.says("saved as");
    // It is another table even though no setting changes.
    let played = player.app.coach.table().clone();
    let other = fs::read_to_string(&file).unwrap().replace("mu_r =", "# another hand's\nmu_r =");
    assert!(other.contains("another hand's"), "{other}");
    fs::write(&file, other.replace(&format!("mu_r = {}", played.rolling_friction), "mu_r = 0.0123")).unwrap();
    let player = player.press("p");
    player.says("you now play on our club 2, at every start too");
    assert_eq!(player.app.coach.table().rolling_friction, 0.0123, "{}", fs::read_to_string(&file).unwrap());
    let player = player.press("d");
    player.shows(&["lag", "corner-five", "0/1"]).does_not_show("slow-roll");
    // A table without doubts has no daily check: typed marks of it wait, and are not used for another test.
    let player = player.press("Enter").type_in("4.6").press("F2");
    let mut elsewhere = Player::new();
    elsewhere.app = elsewhere.app.with_draft(player.app.calibration.draft());
    let elsewhere = elsewhere.press("F7");
    elsewhere.shows(&["slow-roll"]);
    assert!(elsewhere.app.calibration.draft().is_some_and(|draft| draft.is_daily));
    assert_eq!(elsewhere.app.key_context(), KeyContext::Calibration(CalibrationContext::Tests));
    let player = player.press("F7 C-u Esc");
    let checked = enter(player, &["4.6", "7.4", "3.2", ""]).press("Tab");
    checked.says("today a lag rolls");
    assert!(saved_entries(&checked).trials.len() == 2 && checked.path("calibration-daily.toml").exists());
    checked.press("d").shows(&["slow-roll"]);
    Player::new().press("F7 d").warns("a daily check needs a calibrated table");
}

#[test]
fn a_table_that_cannot_be_loaded_is_not_selected() {
    let player = measured().press("s C-u").type_in("gone").press("Enter");
    fs::remove_file(player.path("tables/gone.toml")).unwrap();
    let player = player.press("p");
    player.warns("gone.toml");
    player.does_not_show("you now play on");
    assert_ne!(player.app.coach.table().name, "gone");
    // If the settings cannot be changed, another table is used at the next start.
    let player = measured().press("s C-u").type_in("short").press("Enter");
    fs::write(player.path("config.toml"), "speed = = 2\n").unwrap();
    let player = player.press("p");
    player.says("you now play on short until the program ends").does_not_show("at every start");
    assert_eq!(player.app.coach.table().name, "short");
}

#[test]
fn contradictory_strokes_are_named_and_prevent_saving() {
    let player = ["5", "9", "16"].iter().fold(new(), |player, time| enter(player.press("Home"), &[time, "5", "", ""]));
    let values = player.press("Tab");
    values.shows(&["contradict", "unsure", "of slow-roll"]).does_not_show(" better").does_not_show(" well");
    values.press("s").warns("strokes contradict each other");
}

#[test]
fn a_stroke_can_be_entered_before_the_file_was_read() {
    let mut player = Player::with(TRUE_COLOUR);
    // The task requested by the key is not done yet.
    player.app.handle(&key("F7"));
    player.app.handle(&key("Enter"));
    player.warns_nothing();
    assert_eq!(player.app.key_context(), KeyContext::Calibration(CalibrationContext::Marks));
    let player = ROLL.iter().fold(player, |player, mark| player.type_in(mark).press("Enter"));
    assert_eq!(saved_entries(&player).trials.len(), 1);
}

#[test]
fn an_unreadable_file_is_moved_aside_on_request() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("calibration.toml"), "half").unwrap();
    let player = Player::in_folder(TRUE_COLOUR, folder).press("F7");
    player.warns("calibration.toml");
    let refused = player.press("Enter");
    refused.warns("N moves it aside and starts again");
    let anew = refused.press("N y");
    anew.says("the file that cannot be read is kept as");
    assert_eq!(fs::read_to_string(anew.path("calibration.before.toml")).unwrap(), "half");
    let entered = enter(anew, &ROLL);
    assert_eq!(saved_entries(&entered).trials.len(), 1);
}

#[test]
fn partly_typed_strokes_are_restored_at_the_next_start() {
    let player = new().press("Enter").type_in("9.6").press("Enter").type_in("5").press("F2");
    let draft = player.app.calibration.draft();
    let mut next = new();
    next.app = next.app.with_draft(draft.clone());
    next.warns("a stroke of slow-roll that was typed in part is kept: F7 goes on with it");
    // At the start after that, if nothing was typed meanwhile, the notice is not repeated.
    let mut later = new();
    later.app = later.app.with_draft(next.app.draft());
    later.warns_nothing();
    let next = next.press("F7");
    assert!(!next.text(80, 24).contains("typed in part"), "the notice would cover the form");
    assert_eq!(next.app.key_context(), KeyContext::Calibration(CalibrationContext::Marks));
    assert_eq!(next.app.calibration.draft(), draft);
    let next = next.type_in(".4").press("Enter").type_in("725 mm").press("Enter Enter");
    assert_eq!(saved_entries(&next), saved_entries(&enter(new(), &ROLL)), "as if it had been typed at once");
    assert_eq!(next.app.calibration.draft(), None);
    // A change of a stroke is restored as a change.
    let changed = enter(new(), &ROLL).press("Up e 9");
    let draft = changed.app.calibration.draft().unwrap();
    assert!(draft.amends.is_some() && draft.typed[0].ends_with('9'), "{draft:?}");
    // A saved or empty form does not count as partly typed.
    assert_eq!(new().press("Enter").app.calibration.draft(), None);
    // A form that was left is restored for the same stroke, also at the next start, and for no other stroke.
    let left = new().press("Enter 9 Esc");
    let draft = left.app.calibration.draft();
    assert_eq!(draft.as_ref().map(|draft| &draft.typed[0][..]), Some("9"));
    assert_eq!(left.press("Down Enter").app.calibration.draft(), draft);
    let again = new().press("Enter 9 Esc Enter");
    assert_eq!(again.press(". 6 Esc").app.calibration.draft().unwrap().typed[0], "9.6");
    // This holds for each stroke, even if another one was typed in part meanwhile.
    let other = new().press("Enter 9 Esc Down Enter 7 Esc Up Enter . 6 Esc");
    assert_eq!(other.app.calibration.draft().unwrap().typed[0], "9.6");
    let emptied = new().press("Enter 9 Esc Enter Backspace Esc");
    assert_eq!(emptied.app.calibration.draft(), None);
}
