//! Text in memory: tables, layouts, strokes, share codes, libraries.

use carom::{
    drills::{Exercise, LibraryFile, decode, encode, store::Practice},
    game::Rule,
    physics::CueInputs,
    table::{Layout, Table},
};
use proptest::prelude::*;

use super::mutation::mutated_text;

fn table() -> String {
    toml::to_string(&Table::preset("thesis").unwrap()).unwrap()
}

fn exercise() -> Exercise {
    let table = Table::preset("match").unwrap();
    Exercise::new_own("mine", Rule::ThreeCushion, &table.name, Layout::opening(&table))
}

fn library() -> String {
    LibraryFile::new(vec![exercise()]).to_text().unwrap()
}

proptest! {
    #[test]
    fn tables(text in mutated_text(&table())) {
        if let Ok(table) = Table::from_toml(&text) {
            let again = toml::to_string(&table).unwrap();
            prop_assert_eq!(Table::from_toml(&again).unwrap(), table);
        }
    }

    #[test]
    fn layouts_and_strokes(layout in mutated_text("-0.5,0 0,0 0.5,0.03"), diamonds in mutated_text("2d,2d 6d,2d 2d,2.5d"),
                           stroke in mutated_text("0,0.3,0,1,4")) {
        let table = Table::default();
        for text in [&layout, &diamonds] {
            if let Ok(layout) = Layout::parse(text, &table) {
                let _ = layout.validate(&table);
            }
        }
        if let Ok(cue) = CueInputs::parse(&stroke) {
            let _ = cue.validate();
        }
    }

    #[test]
    fn share_codes(text in mutated_text(&encode(&exercise()).unwrap())) {
        if let Ok(exercise) = decode(&text) {
            prop_assert!(exercise.validate().is_ok());
        }
    }

    #[test]
    fn libraries(text in mutated_text(&library())) {
        if let Ok(practice) = Practice::parse(&text) {
            for exercise in &practice.library.exercises {
                let _ = exercise.validate();
            }
        }
    }
}
