//! Common rules of all screens: space at the right edge, no remains of lower layers, symbols that are visible in every theme.

use carom::{
    table::Table,
    terminal::{Capabilities, Mapping},
};
use ratatui::{layout::Rect, style::Modifier};

use super::{
    player::{ASCII, NO_COLOUR, Player, SIZES, TRUE_COLOUR},
    practice::exercise,
};

/// Returns every page, filled with content.
fn pages(caps: Capabilities) -> Vec<(&'static str, Player)> {
    let coach = || Player::with(caps).press("Enter").answer();
    let drills = || Player::at_library(caps, &[], &[]);
    let mut all = vec![
        ("placing", Player::with(caps)),
        ("advice", coach()),
        ("playing", coach().press("Space").wait(1.0)),
        ("balls", coach().press("v v v")),
        ("commands", Player::with(caps).press(":")),
        ("help", Player::with(caps).press("?")),
        ("settings", Player::with(caps).press("F5")),
        ("keys", Player::with(caps).press("F5 Tab")),
        ("calibration", Player::with(caps).press("F7")),
        ("calibration's values", Player::with(caps).press("F7 Tab")),
        ("marks", Player::with(caps).press("F7 Enter")),
        ("calibration's long words", Player::with(caps).press(&format!("F7{}", " Down".repeat(7)))),
        ("library", drills()),
        ("exercise", Player::practising(caps)),
        ("stroke", Player::practising(caps).press("L L L H h k K")),
        ("played", Player::practising(caps).press("Space Space").wait(60.0)),
        ("record", drills().press("r")),
        ("form", Player::at_runs(caps).press("n")),
        ("watch", Player::watching(caps)),
    ];
    all.extend((1..4).map(|views| ("view", coach().press(&"v ".repeat(views)))));
    all
}

#[test]
fn no_text_touches_the_right_edge() {
    let mut found = Vec::new();
    for caps in [TRUE_COLOUR, NO_COLOUR, ASCII] {
        for (page, player) in pages(caps) {
            for (width, height) in [(80, 24), (90, 28), (100, 30), (120, 40), (160, 50)] {
                let picture = player.picture(width, height);
                for y in 0..height {
                    let end: String = (width - 8..width).map(|x| picture[(x, y)].symbol()).collect();
                    let last = end.chars().last().unwrap();
                    // An axis may end at the edge of its chart, with a number.
                    let is_axis = end.chars().all(|letter| letter.is_ascii_digit() || " .kM".contains(letter));
                    if last.is_alphanumeric() && !is_axis {
                        found.push(format!("{page} {width}×{height}, row {y}: {end}"));
                    }
                }
            }
        }
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn overlays_cover_the_page_completely() {
    for (width, height) in SIZES {
        let paper = Player::new().picture(width, height)[(width - 1, height - 1)].bg;
        for keys in [":", "?"] {
            let picture = Player::new().press(keys).picture(width, height);
            for y in 1..height - 2 {
                let is_table =
                    |x: u16| picture[(x, y)].bg != paper && !picture[(x, y)].modifier.contains(Modifier::REVERSED);
                assert_eq!((0..width).find(|x| is_table(*x)), None, "{keys} {width}×{height}, row {y}");
                if keys == ":" {
                    let beside: String = [0, 1, width - 2, width - 1].map(|x| picture[(x, y)].symbol()).concat();
                    assert_eq!(beside.trim(), "", "{width}×{height}, row {y}");
                }
            }
        }
    }
}

#[test]
fn the_light_theme_has_no_cloth_colour_among_text() {
    let player = Player::new().press("T");
    let light = player.picture(80, 24);
    let (paper, text) = (light[(79, 23)].bg, 18);
    for y in text..24 {
        for x in 0..40 {
            assert_eq!(light[(x, y)].bg, paper, "column {x}, row {y}");
        }
    }
    let signs: Vec<&str> = (19..22).map(|y| light[(1, y)].symbol()).collect();
    assert_eq!(signs, ["○", "●", "●"], "a white disc would not be seen on paper");
}

#[test]
fn without_colours_the_cue_is_drawn_until_the_stroke() {
    for (caps, signs) in [(NO_COLOUR, ["╱", "╲", "│", "─"]), (ASCII, ["/", "\\", "|", "-"])] {
        let bed = Mapping::fit(&Table::default(), Rect::new(4, 1, 112, 29)).bed;
        let cue = |player: &Player| {
            let picture = player.picture(120, 40);
            bed.positions().filter(|at| signs.contains(&picture[*at].symbol())).count()
        };
        let ready = Player::with(caps).press("Enter").answer();
        assert!(cue(&ready) >= 4, "{}", ready.text(120, 40));
        assert_eq!(cue(&ready.press("Space").wait(0.5)), 0);
    }
}

#[test]
fn wide_characters_stay_in_their_columns() {
    let own = exercise("own", &"당구 연습 ".repeat(8));
    let player = Player::at_library(TRUE_COLOUR, &[own], &[]).press("Left");
    let picture = player.picture(80, 24);
    let y = (0..24).find(|y| picture[(2, *y)].symbol() == "당").expect("the position is listed");
    assert_eq!(picture[(28, y)].symbol(), "-", "the grade has its place");
    assert!((26..32).any(|x| picture[(x, y)].symbol() == "…"), "the title is cut");
}

#[test]
fn text_fields_support_cursor_editing() {
    let player = Player::at_library(TRUE_COLOUR, &[], &[]).press("/").type_in("xhalf balls");
    let player = player.press("Home Delete End Backspace");
    assert_eq!(player.app.drills.catalogue.filter.text.as_deref(), Some("half ball"));
    let player = player.press("C-w C-w");
    assert_eq!(player.app.drills.catalogue.filter.text, None);
    let player = Player::new().press(": n d o Home u C-Right");
    assert_eq!(player.app.command_palette.as_ref().unwrap().words.text(), "undo");
    let picture = player.picture(80, 24);
    let reversed = (0..40).filter(|x| picture[(*x, 2)].modifier.contains(Modifier::REVERSED));
    assert_eq!(reversed.collect::<Vec<_>>(), [11], "the cursor is seen behind the words");
    let kept = Player::watching(TRUE_COLOUR).press("k C-u a c Left b");
    assert!(kept.text(80, 24).contains("under the name: abc"), "{}", kept.text(80, 24));
    let set = Player::new().press("F5 Enter l i g t Left h Enter");
    assert!(set.app.settings.settings.theme.name() == "light", "{}", set.text(80, 24));
}
