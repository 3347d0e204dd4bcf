//! A screen as SVG: what is made of rectangles becomes paths, since few fonts have it, and the rest text.

use std::{collections::BTreeMap, fmt::Write};

use ratatui::{
    buffer::{Buffer, Cell},
    layout::Rect,
    style::{Color, Modifier},
    symbols::pixel::SEXTANTS,
};

/// A cell's width and height; both halves and thirds of them are whole numbers.
const CELL: (u16, u16) = (12, 24);
/// From a cell's top to the line that its text stands on.
const BASELINE: u16 = 18;
/// At this size the usual monospace fonts are a cell wide or a little less; `textLength` does the rest.
const FONT_SIZE: u16 = 20;
const FONTS: &str = "ui-monospace,'SF Mono',Menlo,Consolas,'DejaVu Sans Mono','Liberation Mono',monospace";
/// Around the screen.
const MARGIN: u16 = 14;

/// Rectangles by their colour, 0xRRGGBB.
type Shapes = BTreeMap<u32, Vec<Rect>>;

/// Text in one style without a gap of more than a blank.
struct Words {
    column: u16,
    row: u16,
    color: u32,
    bold: bool,
    text: String,
}

/// The picture of `screen`, which must be in 24-bit colours; `title` is what it shows.
pub fn picture(screen: &Buffer, title: &str) -> String {
    let mut cells = String::new();
    push_cells(&mut cells, screen, Some(page(screen)), |_| true);
    document(screen, title, &cells)
}

/// An SVG document around what is drawn of a screen of this size and page colour.
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

/// The colour behind everything: the last cell is below all panels.
pub fn page(screen: &Buffer) -> u32 {
    screen.content.last().map_or(0, |cell| style(cell).back)
}

/// Draws those cells of `screen` whose index is `drawn`. What is behind them is left out where it has the colour `page`.
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

/// How a cell's symbol is drawn: its colour, the one behind it, both 0xRRGGBB, and its weight.
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

/// The rectangles that `symbol` consists of, if it does.
fn parts(symbol: char) -> Option<Vec<Rect>> {
    let (width, height) = CELL;
    let line = |thickness| vec![Rect::new(0, (height - thickness) / 2, width, thickness)];
    match symbol {
        '▀' => Some(vec![Rect::new(0, 0, width, height / 2)]),
        '▄' => Some(vec![Rect::new(0, height / 2, width, height / 2)]),
        '─' => Some(line(2)),
        '━' => Some(line(4)),
        // The blank, the full block and the halves beside each other are among them.
        _ => SEXTANTS.iter().position(|&sextant| sextant == symbol).map(|bits| {
            let part = |n: u16| Rect::new(n % 2 * width / 2, n / 2 * height / 3, width / 2, height / 3);
            (0..6).filter(|n| bits >> n & 1 == 1).map(part).collect()
        }),
    }
}

/// Adds a symbol to the words that it belongs to. Signs that many fonts take from another, wider one stand alone.
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

/// Makes as few rectangles of them as joining rows, and then equal rows, can.
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

/// One path a colour, with crisp edges: smooth ones would leave seams between neighbours at most scales.
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
