//! Pages of `docs/` that the library writes.

#[test]
fn the_keys_page_matches_the_program() {
    let written = include_str!("../../docs/keys.md");
    // Without the pages, which are long.
    let is_current = written == carom::terminal::keys_document();
    assert!(is_current, "cargo run --release --example picture -- docs/ writes it again");
    for part in ["## Coach", "## Drills: exercise", "| `F2` |", "| `←↓↑→ hjkl` | move the selected ball"] {
        assert!(written.contains(part), "{part}");
    }
}

#[test]
fn the_glossary_contains_every_pattern_with_its_course() {
    let rows: Vec<String> =
        carom::coach::PATTERNS.iter().map(|pattern| format!("| {} | {} |", pattern.name, pattern.course)).collect();
    let table = rows.join("\n") + "\n";
    assert!(include_str!("../../docs/glossary.md").contains(&table), "docs/glossary.md needs this table:\n{table}");
}
