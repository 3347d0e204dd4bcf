//! Rules of the source tree: which module may import which under `src`, which functions the engine may use, and the maximum length of a
//! file.

mod import_cycles;
mod imports;

use std::{collections::BTreeMap, fs, path::Path};

use import_cycles::import_cycles;
use imports::{Module, imports};

/// The top-level modules, from the lowest layer up: each may use those before it, and none after it.
const ORDER: [&str; 16] = [
    "platform",
    "printing",
    "storage",
    "statistics",
    "table",
    "physics",
    "simulation",
    "game",
    "player",
    "learning",
    "coach",
    "calibration",
    "drills",
    "study",
    "terminal",
    "commands",
];

/// Known cycles: a folder, and those of its children that import each other. A cycle that is removed is deleted here; none is ever added.
const KNOWN_CYCLES: &[&str] = &[];

/// Maximum number of lines of a file.
const MAX_LINES: usize = 500;

/// Modules whose results must be bit-for-bit equal on every machine.
const BIT_EXACT_MODULES: [&str; 3] = ["table", "physics", "simulation"];

/// Functions whose last bits depend on the system. `libm` has replacements for all of them.
const PLATFORM_DEPENDENT: [&str; 18] = [
    ".sin()",
    ".cos()",
    ".tan()",
    ".sin_cos()",
    ".asin()",
    ".acos()",
    ".atan()",
    ".atan2(",
    ".exp()",
    ".exp_m1()",
    ".ln()",
    ".ln_1p()",
    ".powf(",
    ".cbrt()",
    ".hypot(",
    "from_angle(",
    ".to_angle()",
    ".angle_to(",
];

/// Returns the text of every file under `src`, by the name of its module.
fn sources() -> BTreeMap<Module, String> {
    let mut sources = BTreeMap::new();
    let mut folders = vec![(Module::new(), Path::new(env!("CARGO_MANIFEST_DIR")).join("src"))];
    while let Some((module, folder)) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_stem().unwrap().to_str().unwrap().to_owned();
            let inside = [&module[..], std::slice::from_ref(&name)].concat();
            if path.is_dir() {
                folders.push((inside, path));
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let is_whole = matches!(name.as_str(), "mod" | "lib");
                sources.insert(if is_whole { module.clone() } else { inside }, fs::read_to_string(&path).unwrap());
            }
        }
    }
    sources
}

#[test]
fn top_level_modules_import_only_lower_layers() {
    let place = |name: &str| {
        let place = ORDER.iter().position(|one| *one == name);
        place.unwrap_or_else(|| panic!("{name} has no place in ORDER"))
    };
    let (sources, mut wrong) = (sources(), Vec::new());
    for (from, to) in imports(&sources) {
        if let ([one, ..], [other, ..]) = (&from[..], &to[..])
            && one != other
            && place(one) < place(other)
        {
            wrong.push(format!("{} imports {}", from.join("/"), to.join("/")));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let folders: Vec<&String> = sources.keys().filter(|module| module.len() == 1).map(|module| &module[0]).collect();
    assert!(ORDER.iter().all(|name| folders.iter().any(|folder| folder == name)), "{folders:?}");
}

#[test]
fn the_contributing_guide_lists_the_modules_in_order() {
    let guide = include_str!("../../../CONTRIBUTING.md");
    let (_, table) = guide.split_once("| folder | what is in it |\n|---|---|\n").unwrap();
    let (table, _) = table.split_once("\n\n").unwrap();
    let folders = table
        .lines()
        .flat_map(|row| row.split('|').nth(1).unwrap().split(','))
        .map(|name| name.trim_matches([' ', '`']));
    assert_eq!(folders.collect::<Vec<_>>(), ORDER);
}

#[test]
fn no_folders_import_each_other_in_a_cycle() {
    let (mut new, mut known) = (Vec::new(), KNOWN_CYCLES.to_vec());
    for cycle in import_cycles(&imports(&sources())) {
        match known.iter().position(|one| *one == cycle.name) {
            Some(place) => drop(known.remove(place)),
            None => new.push(format!("{}\n    {}", cycle.name, cycle.imports.join("\n    "))),
        }
    }
    assert!(new.is_empty(), "these cycles are new:\n{}", new.join("\n"));
    assert!(known.is_empty(), "these cycles no longer exist; remove them from KNOWN_CYCLES: {known:#?}");
}

#[test]
fn the_engine_uses_no_platform_dependent_functions() {
    for (module, text) in sources() {
        let is_test = module.last().is_some_and(|name| name == "tests");
        if is_test || !module.first().is_some_and(|name| BIT_EXACT_MODULES.contains(&name.as_str())) {
            continue;
        }
        let code = text.split("#[cfg(test)]").next().unwrap();
        for (number, line) in code.lines().enumerate() {
            let found = PLATFORM_DEPENDENT.iter().find(|name| line.contains(**name));
            assert!(found.is_none(), "{}, line {}: {line}", module.join("/"), number + 1);
        }
    }
}

#[test]
fn files_start_with_a_doc_line_and_are_short() {
    for (module, text) in sources() {
        assert!(text.starts_with("//! "), "{} does not begin with what it is for", module.join("/"));
        let lines = text.lines().count();
        assert!(lines <= MAX_LINES, "{} has {lines} lines", module.join("/"));
    }
}
