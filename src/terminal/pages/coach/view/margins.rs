//! The panel "Margins": the error margin of each input of the stroke, next to the player's usual error.

use ratatui::{
    layout::Rect,
    style::Style,
    text::{Line, Span},
};

use crate::{
    coach::{
        Input, Margin, Skill,
        words::{LengthUnit, format_trimmed, lengths_words},
    },
    terminal::{
        Capabilities, Shot, ShotAnalysis,
        ui::{Theme, Ui, columns, draw_placeholder, draw_title, list, write_right},
        words::fixed,
    },
};

/// Panel height above which every input has its own row, rows.
const TALL: u16 = 6;

/// Right ends of names and numbers in the tall table, from the panel's left edge, columns. The direction of the error follows each number.
const NAME_END: u16 = 7;
const LESS_END: u16 = 13;
const MORE_END: u16 = 25;
const YOURS_END: u16 = 38;

/// Widths of an input if two share a row, columns: without and with the player's error, which the maps next to it show too.
const HALF: (u16, u16) = (20, 24);

/// Draws the panel of an analysed shot, with distances in `unit`. The tightest input, whose margin the player's errors exceed first, is
/// marked. If `in_letters`, the inputs have the thesis' letters. Without an analysis the panel shows the text `empty`.
pub fn draw_margins(
    studied: Option<(&ShotAnalysis, &Shot)>,
    (unit, in_letters): (LengthUnit, bool),
    empty: &str,
    area: Rect,
    ui: &mut Ui,
) {
    let tall = area.height > TALL;
    let half = (area.width / 2).clamp(HALF.0, HALF.1);
    let has_yours = half == HALF.1;
    let [small, speed] = [Input::Side, Input::Speed].map(|input| input.display_unit(unit).1);
    let units = format!("{small} {} {speed}", ui.caps.pick("°", "deg"));
    let mut title = vec![Span::styled("Margins", ui.theme.text())];
    if studied.is_some() && !tall {
        let yours = if has_yours { ui.caps.pick(", ± yours", ", yours") } else { "" };
        title.push(Span::styled(format!(" R right, L left{yours}: {units}"), ui.theme.faint()));
    }
    let inner = draw_title(title, area, ui);
    let (margins, skill, shot) = match studied {
        None => return draw_placeholder(&[empty], inner, ui),
        Some((ShotAnalysis { margins: None, .. }, shot)) => {
            let why = if shot.solved {
                "none: played exactly, it misses on likely tables"
            } else {
                "none: this shot makes no point"
            };
            return draw_placeholder(&[why], inner, ui);
        }
        Some((ShotAnalysis { margins: Some(margins), hand, .. }, shot)) => (margins, *hand, shot),
    };
    let tightest = tightest(margins, skill);
    let rows: Vec<Row> = margins
        .iter()
        .enumerate()
        .map(|(n, margin)| {
            let is_tightest = Some(n) == tightest;
            let (factor, unit) = margin.input.display_unit(unit);
            let yours = yours(factor * skill.error(margin.input));
            Row { margin, factor, unit, yours, is_tightest, in_letters }
        })
        .collect();
    if tall {
        ui.buffer.set_string(inner.x + 1, inner.y, &units, ui.theme.faint());
        let yours = ui.caps.pick("yours ±", "yours");
        write_right(ui.buffer, inner.x, inner.x + YOURS_END, inner.y, yours, ui.theme.faint());
        for (row, y) in rows.iter().zip(inner.y + 1..inner.bottom()) {
            row.draw_whole(inner.x, y, ui);
        }
        let note = inner.y + 1 + rows.len() as u16;
        if tightest.is_some() && note < inner.bottom() {
            let words = format!("{} tightest: errors leave it first", ui.caps.pick("▸", ">"));
            let words = Line::styled(words, ui.theme.faint());
            ui.buffer.set_line(inner.x + 1, note, &words, inner.width.saturating_sub(1));
        }
    } else {
        let places = (0..2).flat_map(|column| (inner.y..inner.bottom()).map(move |y| (column, y)));
        for (row, (column, y)) in rows.iter().zip(places) {
            row.draw_half(has_yours, inner.x + half * column, y, ui);
        }
        // The other panels show the speed in table lengths only.
        if 2 * usize::from(inner.height) > rows.len() {
            let speed_value = fixed(unit.speed().0 * shot.cue.speed, 1);
            let x = inner.x + half + 1;
            let room = usize::from(inner.right().saturating_sub(x));
            let mut words = format!("{speed_value} {speed}, {}", lengths_words(shot.words.table_lengths));
            if columns(&words) > room {
                words = format!("{speed_value} {speed}");
            }
            ui.buffer.set_stringn(x, inner.bottom() - 1, words, room, ui.theme.faint());
        }
    }
}

/// Formats a standard error without trailing zeros and as short as the room demands: 0.5, 0.125, 2.2.
fn yours(error: f64) -> String {
    format_trimmed(error, if error < 0.2 { 3 } else { 2 })
}

/// Index of the input whose smaller margin is the smallest multiple of the player's standard error; `None` if none is finite.
fn tightest(margins: &[Margin; 5], skill: Skill) -> Option<usize> {
    let errors = |margin: &Margin| {
        let nearer = margin.less.unwrap_or(f64::INFINITY).min(margin.more.unwrap_or(f64::INFINITY));
        nearer / skill.error(margin.input)
    };
    let all = margins.iter().map(errors).enumerate().filter(|(_, errors)| errors.is_finite());
    all.min_by(|one, other| one.1.total_cmp(&other.1)).map(|(n, _)| n)
}

struct Row<'a> {
    margin: &'a Margin,
    /// Factor from the input's own unit to the displayed unit, and that unit.
    factor: f64,
    unit: &'static str,
    /// The player's standard error, in the displayed unit.
    yours: String,
    is_tightest: bool,
    in_letters: bool,
}

impl Row<'_> {
    fn style(&self, theme: &Theme) -> Style {
        if self.is_tightest { theme.accent() } else { theme.text() }
    }

    /// The input's name as in other views, or the thesis' letter; then a short form for narrow tables.
    fn names(&self, caps: Capabilities) -> [&'static str; 2] {
        match self.margin.input {
            Input::Elevation if self.in_letters => [caps.pick("θ", "th"); 2],
            Input::Direction if self.in_letters => [caps.pick("φ", "ph"); 2],
            input if self.in_letters => [input.name(); 2],
            Input::Side => ["side"; 2],
            Input::Height => ["height", "hght"],
            Input::Elevation => ["cue"; 2],
            Input::Direction => ["aim"; 2],
            Input::Speed => ["speed", "spd"],
        }
    }

    /// The directions of less and more of the input, each with its sign. Side and direction are positive to the shooter's left.
    const fn directions(&self) -> [(&'static str, &'static str); 2] {
        match self.margin.input {
            Input::Side | Input::Direction => [("right", "R"), ("left", "L")],
            Input::Height | Input::Elevation => [("lower", "-"), ("higher", "+")],
            Input::Speed => [("softer", "-"), ("harder", "+")],
        }
    }

    /// The margins downwards and upwards, in the displayed unit; `None` if there is no limit in reach.
    fn sizes(&self) -> [Option<f64>; 2] {
        [self.margin.less, self.margin.more].map(|margin| margin.map(|margin| self.factor * margin))
    }

    fn draw_whole(&self, x: u16, y: u16, ui: &mut Ui) {
        let [name, _] = self.names(ui.caps);
        list::draw_mark(self.is_tightest, x, y, ui);
        ui.buffer.set_string(x + 1, y, name, ui.theme.faint());
        // Inches need a third decimal: a hundredth of an inch is a quarter of a millimetre.
        let decimals = if self.unit == LengthUnit::Feet.fine().1 { 3 } else { 2 };
        for ((margin, (way, _)), end) in self.sizes().into_iter().zip(self.directions()).zip([LESS_END, MORE_END]) {
            write_right(ui.buffer, x + NAME_END, x + end, y, &size(margin, "", decimals), self.style(ui.theme));
            ui.buffer.set_string(x + end + 1, y, way, ui.theme.faint());
        }
        write_right(ui.buffer, x + MORE_END, x + YOURS_END, y, &self.yours, ui.theme.text());
    }

    fn draw_half(&self, has_yours: bool, x: u16, y: u16, ui: &mut Ui) {
        let [_, name] = self.names(ui.caps);
        list::draw_mark(self.is_tightest, x, y, ui);
        ui.buffer.set_string(x + 1, y, name, ui.theme.faint());
        for ((margin, (_, sign)), end) in self.sizes().into_iter().zip(self.directions()).zip([12, 19]) {
            write_right(ui.buffer, x + 5, x + end, y, &size(margin, sign, 2), self.style(ui.theme));
        }
        if has_yours {
            ui.buffer.set_stringn(x + 20, y, &self.yours, 4, ui.theme.faint());
        }
    }
}

/// Formats a margin with `decimals` decimals, or one if it is large. With two decimals it takes at most five columns.
fn size(margin: Option<f64>, sign: &str, decimals: usize) -> String {
    let decimals = if margin.is_some_and(|margin| margin >= 9.995) { 1 } else { decimals };
    margin.map_or("wide".to_owned(), |margin| format!("{sign}{}", fixed(margin, decimals)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tightest_margin_is_relative_to_the_players_errors() {
        let margin = |input: Input, less, more| Margin { input, unit: input.unit(), less, more };
        let margins = [
            margin(Input::Side, Some(3.0), Some(0.6)),
            margin(Input::Height, None, None),
            margin(Input::Elevation, None, Some(5.0)),
            margin(Input::Direction, Some(0.14), None),
            margin(Input::Speed, Some(0.3), Some(0.2)),
        ];
        // 0.6 mm are 1.2 errors of 0.5 mm, 0.14° are 1.12 of 0.125°.
        assert_eq!(tightest(&margins, Skill::EXPERT), Some(3));
        assert_eq!(tightest(&margins, Skill::PERFECT), None, "who never errs finds nothing tight");
        let sizes = [(Some(9.994), "-"), (Some(9.996), "+"), (None, "-")].map(|(margin, sign)| size(margin, sign, 2));
        assert_eq!(sizes, ["-9.99", "+10.0", "wide"]);
        let ways = margins.each_ref().map(|margin| {
            let row =
                Row { margin, factor: 1.0, unit: "", yours: String::new(), is_tightest: false, in_letters: false };
            row.directions().map(|(way, _)| way).join(" ")
        });
        assert_eq!(ways, ["right left", "lower higher", "lower higher", "right left", "softer harder"]);
        assert_eq!([0.5, 0.125, 0.934, 2.1994].map(yours), ["0.5", "0.125", "0.93", "2.2"]);
    }
}
