//! Screens as one animated SVG: CSS shows layer after layer, without a script. Each layer paints the cells that changed since the one below
//! it.

use std::fmt::Write;

use ratatui::buffer::{Buffer, Cell};

use super::svg;

/// A screen, and how long it is shown, s.
pub struct Frame {
    pub screen: Buffer,
    pub seconds: f64,
}

/// Returns the animation of `frames`, which repeats forever. All frames must have the size of the first one and 24-bit colours.
///
/// Frame `still` is shown if the viewer cannot animate or the reader prefers reduced motion.
pub fn moving_picture(frames: &[Frame], still: usize, title: &str) -> String {
    let Some(first) = frames.first() else { return String::new() };
    let length: f64 = frames.iter().map(|frame| frame.seconds).sum();
    let page = svg::page(&first.screen);
    let (mut begins, mut styles, mut layers) = (first.seconds, String::new(), String::new());
    svg::push_cells(&mut layers, &first.screen, Some(page), |_| true);
    for (number, pair) in frames.windows(2).enumerate().map(|(before, pair)| (before + 1, pair)) {
        let changed = |index: usize| looks(&pair[0].screen.content[index]) != looks(&pair[1].screen.content[index]);
        // Letters may extend slightly into the neighbouring cells. These are painted, too, or traces of the old text would remain.
        let painted = |index: usize| {
            let column = index % usize::from(first.screen.area.width);
            changed(index)
                || column > 0 && changed(index - 1)
                || column + 1 < usize::from(first.screen.area.width) && changed(index + 1)
        };
        let hidden = if number > still { r#" visibility="hidden""# } else { "" };
        let _ = writeln!(layers, r#"<g id="f{number}"{hidden}>"#);
        svg::push_cells(&mut layers, &pair[1].screen, None, painted);
        layers.push_str("</g>\n");
        let percent = 100.0 * begins / length;
        let _ = writeln!(
            styles,
            "@keyframes f{number}{{0%{{visibility:hidden}}{percent:.3}%,to{{visibility:visible}}}}\n\
             #f{number}{{animation:f{number} {length:.3}s step-end infinite}}"
        );
        begins += pair[1].seconds;
    }
    let style = format!("<style>@media (prefers-reduced-motion:no-preference){{\n{styles}}}</style>\n");
    svg::document(&first.screen, title, &(style + &layers))
}

/// Returns everything about a cell that is visible.
fn looks(cell: &Cell) -> (&str, svg::Style) {
    (cell.symbol(), svg::style(cell))
}
