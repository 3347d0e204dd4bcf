//! Lists that keep the selected row visible.

use std::ops::Range;

use ratatui::layout::Rect;

use super::Ui;

/// The visible rows of a list of `count` entries in `rows` rows: the selected one is in the middle unless the list ends before.
fn in_view(mark: usize, count: usize, rows: usize) -> Range<usize> {
    let first = mark.saturating_sub(rows / 2).min(count.saturating_sub(rows));
    first..count.min(first + rows)
}

/// The visible entries of a list of `count` in `area`, each with its screen row.
pub fn shown(mark: usize, count: usize, area: Rect) -> impl Iterator<Item = (usize, u16)> {
    in_view(mark, count, usize::from(area.height)).zip(area.y..)
}

/// The entry of such a list at the screen row `y`.
pub fn line_at(mark: usize, count: usize, area: Rect, y: u16) -> Option<usize> {
    shown(mark, count, area).find(|(_, row)| *row == y).map(|(line, _)| line)
}

/// Draws the selection mark at the start of a row if it `is_marked`.
pub fn draw_mark(is_marked: bool, x: u16, y: u16, ui: &mut Ui) {
    if is_marked {
        ui.buffer.set_string(x, y, ui.caps.pick("▸", ">"), ui.theme.accent());
    }
}

/// A row of a list with headings.
#[derive(Clone, Copy, Debug)]
enum Row<T> {
    /// A heading for the entries below it.
    Heading(&'static str),
    /// An entry, with its index among all entries.
    Entry(usize, T),
}

/// A list with headings and a selected entry.
#[derive(Clone, Debug)]
pub struct Grouped<T> {
    rows: Vec<Row<T>>,
    mark: usize,
}

impl<T> Grouped<T> {
    /// Creates the list of `entries`, grouped under the headings that `title` returns.
    pub fn new(entries: impl IntoIterator<Item = T>, mark: usize, title: impl Fn(&T) -> &'static str) -> Self {
        let (mut rows, mut last) = (Vec::new(), None);
        for (place, entry) in entries.into_iter().enumerate() {
            let title = title(&entry);
            if last.replace(title) != Some(title) {
                rows.push(Row::Heading(title));
            }
            rows.push(Row::Entry(place, entry));
        }
        Self { rows, mark }
    }

    /// The rows visible in `area`, the selected entry among them, each with its screen row.
    fn shown(&self, area: Rect) -> impl Iterator<Item = (&Row<T>, u16)> {
        let marked = self.rows.iter().position(|row| matches!(row, Row::Entry(place, _) if *place == self.mark));
        shown(marked.unwrap_or(0), self.rows.len(), area).map(|(line, y)| (&self.rows[line], y))
    }

    /// Index of the entry at the screen row `y`.
    pub fn entry_at(&self, area: Rect, y: u16) -> Option<usize> {
        match self.shown(area).find(|(_, row)| *row == y)?.0 {
            Row::Heading(_) => None,
            Row::Entry(place, _) => Some(*place),
        }
    }

    /// Draws the visible rows in `area`. `draw` draws an entry into its row, to the right of the selection mark; its second argument is
    /// whether the entry is selected.
    pub fn draw(&self, area: Rect, ui: &mut Ui, draw: impl Fn(&T, bool, Rect, &mut Ui)) {
        for (row, y) in self.shown(area) {
            match row {
                Row::Heading(title) => {
                    ui.buffer.set_stringn(area.x + 1, y, title, usize::from(area.width), ui.theme.good());
                }
                Row::Entry(place, entry) => {
                    let is_marked = *place == self.mark;
                    draw_mark(is_marked, area.x, y, ui);
                    let row = Rect { x: area.x + 2, y, width: area.width.saturating_sub(2), height: 1 };
                    draw(entry, is_marked, row, ui);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::in_view;

    #[test]
    fn the_selected_row_is_visible_and_the_list_fills_its_rows() {
        for count in 0..20 {
            for rows in 1..25 {
                for mark in 0..count {
                    let shown = in_view(mark, count, rows);
                    assert!(shown.contains(&mark), "{mark} of {count} in {rows}");
                    assert_eq!(shown.len(), rows.min(count));
                }
            }
        }
        assert_eq!(in_view(0, 0, 5), 0..0);
    }
}
