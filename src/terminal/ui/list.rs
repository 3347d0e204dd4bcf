//! Lists with a mark that has to be seen.

use std::ops::Range;

/// The lines that are shown of a list of `count`, where there are `rows`: the marked one is in the middle, as far as the
/// list's ends let it.
pub fn in_view(mark: usize, count: usize, rows: usize) -> Range<usize> {
    let first = mark.saturating_sub(rows / 2).min(count.saturating_sub(rows));
    first..count.min(first + rows)
}

#[cfg(test)]
mod tests {
    use super::in_view;

    #[test]
    fn the_mark_is_always_seen_and_no_row_is_left_free() {
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
