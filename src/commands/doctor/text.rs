//! The report as text: a line for each item, and the problems at the end.

use std::io::{self, Write};

use super::{Report, screen::Screen, stored_data::FolderReport};
use crate::{
    commands::output::{columns, plural},
    printing::{FULL_VERSION, OneLine},
};

/// Writes the whole report.
pub fn write(out: &mut impl Write, report: &Report) -> io::Result<()> {
    for row in columns(&rows(report), &[]) {
        writeln!(out, "{row}")?;
    }
    for problem in &report.problems {
        writeln!(out, "wrong: {}", OneLine(problem))?;
    }
    if report.problems.is_empty() {
        writeln!(out, "Nothing is wrong.")?;
    }
    Ok(())
}

fn rows(report: &Report) -> Vec<[String; 2]> {
    let Report { program, places, screen, kept, self_test, .. } = report;
    let machine = &program.machine;
    let mut rows = vec![
        ("program", format!("carom {FULL_VERSION}")),
        ("machine", format!("{}, {} threads, {}", machine.cpu, machine.threads, machine.os)),
    ];
    rows.extend(places.iter().map(|place| ("folder", folder_words(place))));
    rows.push(("terminal", screen_words(screen)));
    let environment = screen.environment.iter().map(|(name, value)| format!("{name}={value}"));
    rows.push(("environment", environment.collect::<Vec<_>>().join(" ")));
    let file = if kept.settings.count == 0 { "no file, all defaults" } else { "as in the file" };
    rows.push(("settings", format!("{file}, {}", plural(kept.settings.wrong.len(), "mistake"))));
    let kinds = [
        ("tables", &kept.tables),
        ("runs", &kept.runs),
        ("sessions", &kept.sessions),
        ("positions", &kept.positions),
        ("skills", &kept.player),
    ];
    for (name, found) in kinds {
        rows.push((name, format!("{} of your own, {} cannot be read", found.count, found.wrong.len())));
    }
    for (name, what, found) in [
        ("calibration", plural(kept.calibration.count, "stroke"), &kept.calibration),
        ("daily check", plural(kept.daily_check.count, "stroke"), &kept.daily_check),
        ("last session", format!("{} to resume", kept.last.count), &kept.last),
    ] {
        let unread = if found.wrong.is_empty() { "" } else { "; the file cannot be read" };
        rows.push((name, what + unread));
    }
    if let Some(engine) = &self_test.engine {
        let word = if engine.is_right { "as on other machines" } else { "WRONG" };
        rows.push(("engine", format!("{} shots, hash {:016x}: {word}", engine.shots, engine.hash)));
    }
    for test in &self_test.networks {
        let word = if test.is_right { "sound" } else { "WRONG" };
        let words = format!("{}, {}: {} of {} points, {word}", test.table, test.rule, test.points, test.layouts);
        rows.push(("network", words));
    }
    rows.push(("tested in", format!("{:.1} s", self_test.seconds)));
    rows.into_iter().map(|(name, words)| [name.to_owned(), words]).collect()
}

fn folder_words(place: &FolderReport) -> String {
    let FolderReport { what, path, exists, refusal, free_bytes } = place;
    let state = match (refusal, exists) {
        (Some(refusal), _) => format!("cannot be written: {refusal}"),
        (None, true) => "can be written".to_owned(),
        (None, false) => "does not exist yet, can be created".to_owned(),
    };
    let free = free_bytes.map_or_else(String::new, |bytes| format!(", {:.1} GB free", bytes as f64 / 1e9));
    format!("{}: {state}{free} ({what})", path.display())
}

fn screen_words(screen: &Screen) -> String {
    let Screen { can_draw, size, colours, glyphs, unicode, over, .. } = screen;
    let size = size.map_or_else(|| "no terminal".to_owned(), |(columns, rows)| format!("{columns}x{rows}"));
    let drawn = if *can_draw { "the screens can open" } else { "the screens cannot open here" };
    let unicode = if *unicode { "UTF-8" } else { "no UTF-8" };
    let over = if over.is_empty() { String::new() } else { format!(", over {}", over.join(" and ")) };
    format!("{size}{over}: {drawn}, colours: {colours}, table in {glyphs}, {unicode}")
}
