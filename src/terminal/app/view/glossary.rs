//! Overlay with the glossary of players' terms, rendered from the documentation.

use ratatui::text::{Line, Span};

use crate::terminal::{
    App,
    ui::{to_displayable, wrap},
};

/// The glossary in the documentation, the only place where the terms are explained.
const GLOSSARY: &str = include_str!("../../../../docs/glossary.md");

/// Kind of a paragraph.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Heading,
    Item,
    Text,
}

/// Lines of the page, at most `width` columns wide.
pub fn lines(app: &App, width: usize) -> Vec<Line<'static>> {
    let (theme, caps) = (app.theme(), app.caps);
    let mut lines = Vec::new();
    for (kind, text) in paragraphs(GLOSSARY) {
        let text = to_displayable(&text, caps);
        if kind == Kind::Heading {
            lines.extend([Line::default(), Line::styled(text, theme.good())]);
            continue;
        }
        for (n, line) in wrap(&text, width.saturating_sub(2)).into_iter().enumerate() {
            let mark = if n == 0 && kind == Kind::Item { caps.pick("• ", "- ") } else { "  " };
            lines.push(Line::from(vec![Span::styled(mark, theme.accent()), Span::styled(line, theme.text())]));
        }
    }
    lines
}

/// Splits a Markdown page, without its title, into paragraphs of plain text; each row of a table is one.
fn paragraphs(markdown: &str) -> Vec<(Kind, String)> {
    let mut all: Vec<(Kind, String)> = Vec::new();
    let mut goes_on = false;
    for line in markdown.lines().skip(1) {
        let line = line.replace(['*', '`'], "");
        let text = line.trim();
        let (kind, text) = if let Some(heading) = text.strip_prefix("## ") {
            (Kind::Heading, heading.to_owned())
        } else if let Some(item) = text.strip_prefix("- ") {
            (Kind::Item, item.to_owned())
        } else if text.starts_with("|-") {
            // The row above it holds the column names.
            all.pop();
            continue;
        } else if let Some(row) = text.strip_prefix("| ") {
            (Kind::Item, row.trim_end_matches(['|', ' ']).replace(" | ", ": "))
        } else if let (Some((_, open)), true) = (all.last_mut(), goes_on && !text.is_empty()) {
            *open = format!("{open} {text}");
            continue;
        } else {
            (Kind::Text, text.to_owned())
        };
        goes_on = !text.is_empty() && kind != Kind::Heading;
        if goes_on || kind == Kind::Heading {
            all.push((kind, text));
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn glossary_text_loses_markup_and_tables_are_read_by_rows() {
        let read = paragraphs("# T\n\nOne\ntwo.\n\n## H\n\n- **A**: `a`\n  b.\n\n| x | y |\n|---|---|\n| c | d |\n");
        let wanted = [(Kind::Text, "One two."), (Kind::Heading, "H"), (Kind::Item, "A: a b."), (Kind::Item, "c: d")];
        assert_eq!(read, wanted.map(|(kind, text)| (kind, text.to_owned())));
        let all = paragraphs(GLOSSARY);
        assert!(all.iter().all(|(_, text)| !text.contains(['*', '`', '|', '#'])), "{all:?}");
        for word in ["Tip: ", "Fullness: ", "ticky: ", "plus: "] {
            assert!(all.iter().any(|(_, text)| text.starts_with(word)), "{word}");
        }
    }
}
