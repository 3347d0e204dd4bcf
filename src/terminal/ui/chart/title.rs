//! The title row of a chart: its quantity and options, problems in the data, and the last value.

use ratatui::{
    layout::Rect,
    style::{Modifier, Style},
    text::Span,
};

use crate::{
    learning::run::history::{NonFinite, Point},
    terminal::{
        Capabilities,
        ui::{
            Theme, Ui,
            chart::{Chart, Curve, CurveRole, label::compact},
            separator,
        },
    },
};

/// Priority of a part; the lowest is dropped first if the row is too short.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Priority {
    Note,
    Smoothing,
    Log,
    NotPositive,
    Value,
    NonFinite,
    Title,
}

/// Gap between two parts at the right.
const GAP: &str = "  ";

/// A part of the row.
struct Part {
    priority: Priority,
    text: String,
    style: Style,
}

/// Draws the title row over a rule.
pub fn draw_chart_title(chart: &Chart, area: Rect, ui: &mut Ui) {
    let width = usize::from(area.width);
    let rule = ui.caps.pick("─", "-");
    ui.buffer.set_stringn(area.x, area.y, rule.repeat(width), width, ui.theme.rule());
    let (mut left, mut right) = (left(chart, ui.theme, ui.caps), right(chart, ui.theme, ui.caps));
    let width_of = |parts: &[Part], gap: usize| {
        let texts: usize = parts.iter().map(|part| Span::raw(&part.text).width()).sum();
        texts + gap * parts.len().saturating_sub(1)
    };
    // The start of the rule, and a blank at either side of both texts.
    while width_of(&left, 0) + 3 + width_of(&right, GAP.len()) + usize::from(!right.is_empty()) * 2 > width {
        let least = left.iter().chain(&right).map(|part| part.priority).min();
        let Some(priority) = least.filter(|priority| *priority < Priority::Title) else { break };
        left.retain(|part| part.priority != priority);
        right.retain(|part| part.priority != priority);
    }
    let mut x = ui.buffer.set_stringn(area.x + u16::from(width > 1), area.y, " ", width.min(1), ui.theme.text()).0;
    let mut write = |x: u16, text: &str, style: Style| {
        let room = usize::from(area.right().saturating_sub(x));
        ui.buffer.set_stringn(x, area.y, text, room, style).0
    };
    for part in &left {
        x = write(x, &part.text, part.style);
    }
    write(x, " ", ui.theme.text());
    if !right.is_empty() {
        let mut x = area.right().saturating_sub(width_of(&right, GAP.len()) as u16 + 2).max(x);
        for (n, part) in right.iter().enumerate() {
            x = write(x, if n == 0 { " " } else { GAP }, ui.theme.text());
            x = write(x, &part.text, part.style);
        }
        write(x, " ", ui.theme.text());
    }
}

fn left(chart: &Chart, theme: &Theme, caps: Capabilities) -> Vec<Part> {
    let dot = separator(caps);
    let style = match (chart.selected, theme.is_mono()) {
        (true, true) => theme.accent().add_modifier(Modifier::REVERSED),
        (true, false) => theme.accent(),
        (false, _) => theme.text(),
    };
    let mut parts = vec![Part { priority: Priority::Title, text: chart.title.to_owned(), style }];
    let mut add =
        |priority, text: &str| parts.push(Part { priority, text: format!("{dot}{text}"), style: theme.faint() });
    if chart.log {
        add(Priority::Log, "log");
    }
    if chart.length().is_some() {
        add(Priority::Smoothing, &format!("smooth {} %", (1000.0 * chart.smoothing).round() / 10.0));
    }
    if let Some(note) = chart.note.filter(|_| chart.has_points()) {
        add(Priority::Note, note);
    }
    parts
}

fn right(chart: &Chart, theme: &Theme, caps: Capabilities) -> Vec<Part> {
    let mut parts = Vec::new();
    for curve in chart.ordered().rev() {
        let style = match (curve.role, theme.is_mono()) {
            (CurveRole::Main, _) => theme.warning(),
            (CurveRole::Compared, false) => theme.text().fg(theme.curves[1]),
            (CurveRole::Compared, true) => theme.text().add_modifier(Modifier::DIM),
        };
        let mut add =
            |priority, text: String| parts.extend((!text.is_empty()).then_some(Part { priority, text, style }));
        add(Priority::NotPositive, not_positive_words(curve, chart, caps));
        add(Priority::NonFinite, non_finite_words(curve.non_finite, caps));
    }
    let own = chart.curves.iter().find(|curve| curve.role == CurveRole::Main);
    let last = own.and_then(|own| own.points.iter().rfind(|point| point.shots.0 as f64 <= chart.shots.1));
    if let Some((text, style)) = last.map(|last| value(last, theme, caps)) {
        parts.push(Part { priority: Priority::Value, text, style });
    }
    parts
}

/// The last value, or a symbol if it is not finite.
fn value(point: &Point, theme: &Theme, caps: Capabilities) -> (String, Style) {
    let infinity = caps.pick("∞", "inf");
    match (point.finite, point.non_finite) {
        (Some(span), _) => (compact(span.mean), theme.text().fg(theme.curves[0])),
        (None, NonFinite { above: 1.., .. }) => (infinity.to_owned(), theme.warning()),
        (None, NonFinite { below: 1.., .. }) => (format!("-{infinity}"), theme.warning()),
        (None, _) => ("NaN".to_owned(), theme.warning()),
    }
}

/// Counts of the non-finite values; empty if there are none.
fn non_finite_words(non_finite: NonFinite, caps: Capabilities) -> String {
    let (infinity, times) = (caps.pick("∞", "inf"), caps.pick("×", "x"));
    let counts = [("NaN", "", non_finite.nan), ("", infinity, non_finite.above), ("-", infinity, non_finite.below)];
    let named = counts.into_iter().filter(|(_, _, count)| *count > 0);
    named.map(|(sign, name, count)| format!("{sign}{name} {times}{count}")).collect::<Vec<_>>().join(" ")
}

/// Count of the visible values that a logarithmic scale cannot show; empty if there are none.
fn not_positive_words(curve: &Curve, chart: &Chart, caps: Capabilities) -> String {
    let visible = curve.points.iter().filter(|point| chart.log && chart.shows(point));
    let count: u64 = visible.filter_map(|point| point.finite).map(|span| span.not_positive).sum();
    let (name, times) = (caps.pick("≤0", "<=0"), caps.pick("×", "x"));
    if count > 0 { format!("{name} {times}{count}") } else { String::new() }
}
