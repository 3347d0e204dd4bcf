//! Documentation page of all keys, in Markdown.

use std::fmt::Write;

use crate::terminal::{
    Capabilities, KeyContext,
    app::bindings::{AppBinding, listed},
    keymap::keys_text,
};

/// The keys of [`TextField`](crate::terminal::ui::input::TextField).
const TYPING: &str = "
## Where text is typed

| keys | what they do |
|---|---|
| `← →` | move the cursor |
| `Ctrl-← →`, `Alt-← →` | move the cursor by a word |
| `Home`, `End` | move the cursor to the beginning, to the end |
| `Backspace`, `Delete` | delete the character before the cursor, at the cursor |
| `Ctrl-w`, `Ctrl-u` | delete the word before the cursor, everything before it |
";

/// Returns a Markdown table of all keys, page by page; the keys common to all pages come last, once.
pub fn document() -> String {
    let mut text = String::from(
        "# Keys\n\nThis page is for users of the screens: it lists all keys, page by page. To assign your own keys, press F5, then Tab, or \
         edit `[keys]` in the file that `carom config` prints.\n\nThe page is generated from the program's key bindings by \
         `cargo run --release --example picture -- docs/`.\n",
    );
    let pages: Vec<Vec<AppBinding>> = KeyContext::PAGES.iter().map(|(place, _)| listed(*place).collect()).collect();
    let is_everywhere = |binding: &AppBinding| {
        pages.iter().all(|page| page.iter().any(|other| other.description == binding.description))
    };
    for ((_, name), page) in KeyContext::PAGES.iter().zip(&pages) {
        write_page(&mut text, name, page.iter().filter(|binding| !is_everywhere(binding)));
    }
    let common = pages.first().into_iter().flatten().filter(|binding| is_everywhere(binding));
    write_page(&mut text, "On every page", common);
    text.push_str("\n`carom follow` and `carom watch` have one page: there `F2` to `F5`, `F7` and `F9` do nothing.\n");
    text.push_str(TYPING);
    text
}

fn write_page<'a>(text: &mut String, name: &str, bindings: impl Iterator<Item = &'a AppBinding>) {
    // Writing into a string never fails.
    let _ = write!(text, "\n## {name}\n\n| keys | what they do |\n|---|---|\n");
    for binding in bindings {
        let keys =
            keys_text(binding.keys.iter().map(|(chord, ..)| *chord), Capabilities::TRUE_COLOUR).replace('|', "\\|");
        let _ = writeln!(text, "| `{keys}` | {} |", binding.description);
    }
}
