//! Pages of `docs/` that the library writes.

#[test]
fn the_table_of_keys_is_that_of_the_program() {
    let written = include_str!("../../docs/keys.md");
    assert_eq!(
        written,
        carom::terminal::keys_document(),
        "cargo run --release --example picture -- docs/ writes it anew"
    );
    for part in ["## Coach", "## Drills: exercise", "| `F2` |", "| `←↓↑→ hjkl` | move the selected ball"] {
        assert!(written.contains(part), "{part}");
    }
}
