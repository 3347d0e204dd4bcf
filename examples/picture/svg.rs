//! A screen as SVG: block symbols become paths, because few fonts have them; everything else is text.

use std::{collections::BTreeMap, fmt::Write};

use ratatui::{
    buffer::{Buffer, Cell},
    layout::Rect,
    style::{Color, Modifier},
    symbols::pixel::SEXTANTS,
};

/// Width and height of a cell; halves and thirds of both are whole numbers.
const CELL: (u16, u16) = (12, 24);
/// Distance from the top of a cell to the baseline of its text.
const BASELINE: u16 = 18;
/// At this size, the usual monospace fonts are one cell wide or slightly narrower; `textLength` corrects the rest.
const FONT_SIZE: u16 = 20;
const FONTS: &str = "ui-monospace,'SF Mono',Menlo,Consolas,'DejaVu Sans Mono','Liberation Mono',monospace";
/// Margin around the screen.
const MARGIN: u16 = 14;

/// Rectangles by colour, 0xRRGGBB.
type Shapes = BTreeMap<u32, Vec<Rect>>;

/// Text in one style, with no gap of more than one space.
struct Words {
    column: u16,
    row: u16,
    color: u32,
    bold: bool,
    text: String,
}

/// Returns the picture of `screen`, which must have 24-bit colours; `title` describes it.
pub fn picture(screen: &Buffer, title: &str) -> String {
    let mut cells = String::new();
    push_cells(&mut cells, screen, Some(page(screen)), |_| true);
    document(screen, title, &cells)
}

/// Returns an SVG document around `content`, for a screen of this size and page colour.
pub fn document(screen: &Buffer, title: &str, content: &str) -> String {
    let (width, height) = (screen.area.width * CELL.0 + 2 * MARGIN, screen.area.height * CELL.1 + 2 * MARGIN);
    let (title, page) = (escaped(title), page(screen));
    format!(
        r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="-{MARGIN} -{MARGIN} {width} {height}" width="{width}" height="{height}" role="img">
<title>{title}</title>
<rect x="-{MARGIN}" y="-{MARGIN}" width="{width}" height="{height}" rx="{MARGIN}" fill="#{page:06x}"/>
{content}</svg>
"##
    )
}

/// Returns the background colour of the page: the last cell is below all panels.
pub fn page(screen: &Buffer) -> u32 {
    screen.content.last().map_or(0, |cell| style(cell).back)
}

/// Draws the cells of `screen` for which `drawn` is true. Backgrounds with the colour `page` are left out.
pub fn push_cells(svg: &mut String, screen: &Buffer, page: Option<u32>, drawn: impl Fn(usize) -> bool) {
    let (mut backs, mut blocks, mut words) = (Shapes::new(), Shapes::new(), Vec::<Words>::new());
    for (index, cell) in screen.content.iter().enumerate().filter(|&(index, _)| drawn(index)) {
        let (column, row) = screen.pos_of(index);
        let Style { front, back, bold } = style(cell);
        let place = Rect::new(column * CELL.0, row * CELL.1, CELL.0, CELL.1);
        if page != Some(back) {
            backs.entry(back).or_default().push(place);
        }
        let symbol = cell.symbol().chars().next().unwrap_or(' ');
        if let Some(parts) = parts(symbol) {
            let parts = parts.into_iter().map(|part| Rect { x: place.x + part.x, y: place.y + part.y, ..part });
            blocks.entry(front).or_default().extend(parts);
        } else {
            add_symbol(&mut words, Words { column, row, color: front, bold, text: symbol.to_string() });
        }
    }
    push_shapes(svg, backs);
    push_shapes(svg, blocks);
    push_words(svg, words);
}

/// Style of a cell: foreground and background colour, 0xRRGGBB, and weight.
#[derive(PartialEq)]
pub struct Style {
    front: u32,
    back: u32,
    bold: bool,
}

pub fn style(cell: &Cell) -> Style {
    let rgb = |color| match color {
        Color::Rgb(r, g, b) => u32::from_be_bytes([0, r, g, b]),
        other => unreachable!("{other} is no 24-bit colour"),
    };
    let (mut front, mut back) = (rgb(cell.fg), rgb(cell.bg));
    if cell.modifier.contains(Modifier::REVERSED) {
        (front, back) = (back, front);
    }
    Style { front, back, bold: cell.modifier.contains(Modifier::BOLD) }
}

/// Returns the rectangles of a block symbol; `None` for other symbols.
fn parts(symbol: char) -> Option<Vec<Rect>> {
    let (width, height) = CELL;
    let line = |thickness| vec![Rect::new(0, (height - thickness) / 2, width, thickness)];
    match symbol {
        '▀' => Some(vec![Rect::new(0, 0, width, height / 2)]),
        '▄' => Some(vec![Rect::new(0, height / 2, width, height / 2)]),
        '─' => Some(line(2)),
        '━' => Some(line(4)),
        // The table includes the space, the full block and the left and right halves.
        _ => SEXTANTS.iter().position(|&sextant| sextant == symbol).map(|bits| {
            let part = |n: u16| Rect::new(n % 2 * width / 2, n / 2 * height / 3, width / 2, height / 3);
            (0..6).filter(|n| bits >> n & 1 == 1).map(part).collect()
        }),
    }
}

/// Appends a symbol to the text that it continues. Symbols that many fonts take from another, wider font stay separate.
fn add_symbol(words: &mut Vec<Words>, symbol: Words) {
    let is_sign = |text: &str| text.chars().any(|letter| letter >= '\u{2000}');
    if let Some(last) = words.last_mut().filter(|last| {
        (last.row, last.color, last.bold) == (symbol.row, symbol.color, symbol.bold)
            && !is_sign(&last.text)
            && !is_sign(&symbol.text)
    }) {
        let gap = symbol.column - last.column - last.text.chars().count() as u16;
        if gap <= 1 {
            last.text.extend((0..gap).map(|_| ' '));
            last.text.push_str(&symbol.text);
            return;
        }
    }
    words.push(symbol);
}

/// Merges adjacent rectangles of a row, and then equal rows, to reduce their number.
fn merge(rects: &mut Vec<Rect>) {
    rects.sort_by_key(|rect| (rect.y, rect.height, rect.x));
    rects.dedup_by(|next, last| {
        let joins = (next.y, next.height, next.x) == (last.y, last.height, last.right());
        last.width += if joins { next.width } else { 0 };
        joins
    });
    rects.sort_by_key(|rect| (rect.x, rect.width, rect.y));
    rects.dedup_by(|next, last| {
        let joins = (next.x, next.width, next.y) == (last.x, last.width, last.bottom());
        last.height += if joins { next.height } else { 0 };
        joins
    });
}

/// Draws one path per colour, with crisp edges: antialiased ones would leave seams between neighbours at most scales.
fn push_shapes(svg: &mut String, shapes: Shapes) {
    let shapes: Vec<_> = shapes.into_iter().filter(|(_, rects)| !rects.is_empty()).collect();
    if shapes.is_empty() {
        return;
    }
    svg.push_str("<g shape-rendering=\"crispEdges\">\n");
    for (color, mut rects) in shapes {
        merge(&mut rects);
        let _ = write!(svg, r##"<path fill="#{color:06x}" d=""##);
        for Rect { x, y, width, height } in rects {
            let _ = write!(svg, "M{x} {y}h{width}v{height}h-{width}z");
        }
        svg.push_str("\"/>\n");
    }
    svg.push_str("</g>\n");
}

fn push_words(svg: &mut String, mut words: Vec<Words>) {
    if words.is_empty() {
        return;
    }
    let _ = writeln!(svg, r#"<g font-family="{FONTS}" font-size="{FONT_SIZE}">"#);
    words.sort_by_key(|words| (words.color, words.bold));
    for group in words.chunk_by(|one, other| (one.color, one.bold) == (other.color, other.bold)) {
        let weight = if group[0].bold { r#" font-weight="bold""# } else { "" };
        let _ = writeln!(svg, r##"<g fill="#{:06x}"{weight}>"##, group[0].color);
        for Words { column, row, text, .. } in group {
            let (x, y) = (column * CELL.0, row * CELL.1 + BASELINE);
            let length = text.chars().count() as u16 * CELL.0;
            let _ = writeln!(svg, r#"<text x="{x}" y="{y}" textLength="{length}">{}</text>"#, escaped(text));
        }
        svg.push_str("</g>\n");
    }
    svg.push_str("</g>\n");
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
