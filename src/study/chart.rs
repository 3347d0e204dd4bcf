//! Charts with two logarithmic axes as SVG: dark on a white card, so that they can be read on any page.

use std::{fmt::Write, ops::RangeInclusive};

/// Fonts of every picture.
pub const FONTS: &str = "system-ui,'Segoe UI',Helvetica,Arial,'DejaVu Sans',sans-serif";
/// Room beside a panel for its labels: left, right, top, bottom.
const MARGINS: [f64; 4] = [66.0, 18.0, 34.0, 52.0];
/// Height of a row of the legend.
const LEGEND_ROW: f64 = 22.0;
/// Colour of text.
pub const INK: &str = "#24292f";
/// Colour of the lines behind the curves.
pub const GRID: &str = "#e3e6ea";

/// How a point is marked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// A filled circle.
    Circle,
    /// A filled square.
    Square,
    /// A square on its corner.
    Diamond,
    /// A triangle.
    Triangle,
    /// A large star: what it is all about.
    Star,
    /// Many small dots.
    Dots,
    /// A dashed line without marks.
    Dashes,
}

/// Points that belong together.
#[derive(Clone, Debug)]
pub struct Series {
    /// What the legend says.
    pub name: String,
    /// Its colour, as SVG writes it.
    pub color: &'static str,
    /// Its marks; all but dots are joined by a line.
    pub mark: Mark,
    /// Its points.
    pub points: Vec<Spot>,
}

/// One point of a series.
#[derive(Clone, Debug, Default)]
pub struct Spot {
    /// Along the x axis.
    pub x: f64,
    /// Along the y axis.
    pub y: f64,
    /// An upper value of y, to which a thin line is drawn.
    pub upper: Option<f64>,
    /// What stands below it.
    pub label: String,
}

/// One panel.
#[derive(Clone, Debug)]
pub struct Panel {
    /// What stands above it.
    pub title: String,
    /// Its series; those of the same name in other panels must look the same.
    pub series: Vec<Series>,
}

/// Panels side by side on the same axes.
#[derive(Clone, Debug)]
pub struct Chart {
    /// What the picture shows, for those who cannot see it.
    pub title: String,
    /// Below the x axis.
    pub x_label: String,
    /// Beside the y axis.
    pub y_label: String,
    /// Decades on the x axis, as exponents of ten.
    pub x: RangeInclusive<i32>,
    /// Decades on the y axis.
    pub y: RangeInclusive<i32>,
    /// The panels.
    pub panels: Vec<Panel>,
}

/// Exponents of ten around all of `values` that are positive and finite, at most from `least` to `most`.
pub fn decades(values: impl Iterator<Item = f64>, least: i32, most: i32) -> RangeInclusive<i32> {
    let (mut low, mut high) = (most, least);
    for value in values.filter(|value| *value > 0.0 && value.is_finite()) {
        low = low.min(value.log10().floor() as i32);
        high = high.max(value.log10().ceil() as i32);
    }
    let low = low.clamp(least, most - 1);
    low..=high.clamp(low + 1, most)
}

impl Chart {
    /// The picture, with panels of the given size.
    pub fn svg(&self, width: f64, height: f64) -> String {
        let [left, right, top, bottom] = MARGINS;
        let legend = self.legend();
        let per_row = 3;
        let rows = legend.len().div_ceil(per_row) as f64;
        let full_width = self.panels.len() as f64 * (left + width + right);
        let full_height = top + height + bottom + rows * LEGEND_ROW + 12.0;
        let mut svg = format!(
            r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {full_width} {full_height}" width="{full_width}" height="{full_height}" role="img" font-family="{FONTS}" font-size="13" fill="{INK}">
<title>{}</title>
<rect width="{full_width}" height="{full_height}" rx="10" fill="#ffffff"/>
"##,
            escaped(&self.title)
        );
        for (index, panel) in self.panels.iter().enumerate() {
            let x = index as f64 * (left + width + right) + left;
            let frame = Frame { chart: self, x, y: top, width, height };
            frame.draw(&mut svg, panel);
        }
        let column = full_width / per_row as f64;
        for (index, series) in legend.iter().enumerate() {
            let x = (index % per_row) as f64 * column + 34.0;
            let y = top + height + bottom + (index / per_row) as f64 * LEGEND_ROW + 8.0;
            let (from, to) = (x - 12.0, x + 12.0);
            if series.mark == Mark::Dashes {
                let _ =
                    writeln!(svg, r#"<path d="M{from} {y}H{to}" stroke="{}" stroke-dasharray="5 3"/>"#, series.color);
            } else {
                let _ = writeln!(svg, r#"<path d="{}" fill="{}"/>"#, shape(series.mark, x, y), series.color);
            }
            let _ = writeln!(svg, r#"<text x="{}" y="{}">{}</text>"#, x + 20.0, y + 4.5, escaped(&series.name));
        }
        svg.push_str("</svg>\n");
        svg
    }

    /// One series of every name.
    fn legend(&self) -> Vec<&Series> {
        let mut legend: Vec<&Series> = Vec::new();
        for series in self.panels.iter().flat_map(|panel| &panel.series) {
            if legend.iter().all(|known| known.name != series.name) {
                legend.push(series);
            }
        }
        legend
    }
}

/// A panel's place in the picture.
struct Frame<'a> {
    chart: &'a Chart,
    x: f64,
    y: f64,
    width: f64,
    height: f64,
}

impl Frame<'_> {
    fn at_x(&self, value: f64) -> f64 {
        self.x + self.width * share(value, &self.chart.x)
    }

    fn at_y(&self, value: f64) -> f64 {
        self.y + self.height * (1.0 - share(value, &self.chart.y))
    }

    fn draw(&self, svg: &mut String, panel: &Panel) {
        let Self { x, y, width, height, .. } = *self;
        let (middle, bottom) = (x + 0.5 * width, y + height);
        let _ = writeln!(
            svg,
            r#"<text x="{middle}" y="{}" text-anchor="middle" font-weight="600">{}</text>"#,
            y - 12.0,
            escaped(&panel.title)
        );
        self.grid(svg);
        let _ = writeln!(
            svg,
            r#"<text x="{middle}" y="{}" text-anchor="middle">{}</text>"#,
            bottom + 40.0,
            escaped(&self.chart.x_label)
        );
        let (label_x, label_y) = (x - 48.0, y + 0.5 * height);
        let _ = writeln!(
            svg,
            r#"<text x="{label_x}" y="{label_y}" text-anchor="middle" transform="rotate(-90 {label_x} {label_y})">{}</text>"#,
            escaped(&self.chart.y_label)
        );
        for series in &panel.series {
            self.series(svg, series);
        }
        let _ = writeln!(
            svg,
            r##"<rect x="{x}" y="{y}" width="{width}" height="{height}" fill="none" stroke="#8c959f"/>"##
        );
    }

    fn grid(&self, svg: &mut String) {
        let mut lines = String::new();
        let bottom = self.y + self.height;
        for (axis, range) in [&self.chart.x, &self.chart.y].into_iter().enumerate() {
            let count = range.end() - range.start();
            // At most nine labels, or they would touch.
            let every = (count + 8) / 9;
            for exponent in range.clone() {
                let value = 10_f64.powi(exponent);
                let labelled = exponent.rem_euclid(every.max(1)) == 0;
                let (x, y, anchor) = if axis == 0 {
                    let x = self.at_x(value);
                    let _ = write!(lines, "M{x:.1} {}V{bottom}", self.y);
                    (x, bottom + 19.0, "middle")
                } else {
                    let y = self.at_y(value);
                    let _ = write!(lines, "M{} {y:.1}h{}", self.x, self.width);
                    (self.x - 8.0, y + 4.5, "end")
                };
                if labelled {
                    let _ = writeln!(
                        svg,
                        r#"<text x="{x:.1}" y="{y:.1}" text-anchor="{anchor}">10<tspan dy="-5" font-size="9">{exponent}</tspan></text>"#
                    );
                }
            }
        }
        let _ = writeln!(svg, r#"<path d="{lines}" stroke="{GRID}" fill="none"/>"#);
    }

    fn series(&self, svg: &mut String, series: &Series) {
        let Series { color, mark, points, .. } = series;
        let places: Vec<(f64, f64)> = points.iter().map(|spot| (self.at_x(spot.x), self.at_y(spot.y))).collect();
        if *mark == Mark::Dots {
            let dots: String = places.iter().fold(String::new(), |mut path, (x, y)| {
                let _ = write!(path, "M{x:.1} {y:.1}h0");
                path
            });
            let style = r#"stroke-width="3.4" stroke-linecap="round" stroke-opacity="0.55" fill="none""#;
            let _ = writeln!(svg, r#"<path d="{dots}" stroke="{color}" {style}/>"#);
            return;
        }
        let line: String = places.iter().enumerate().fold(String::new(), |mut path, (index, (x, y))| {
            let _ = write!(path, "{}{x:.1} {y:.1}", if index == 0 { 'M' } else { 'L' });
            path
        });
        let dashes = if *mark == Mark::Dashes { r#" stroke-dasharray="5 3""# } else { "" };
        let _ = writeln!(svg, r#"<path d="{line}" stroke="{color}" stroke-width="1.6" fill="none"{dashes}/>"#);
        if *mark == Mark::Dashes {
            return;
        }
        for ((x, y), Spot { upper, label, .. }) in places.iter().zip(points) {
            if let Some(upper) = upper {
                let top = self.at_y(*upper);
                let _ = writeln!(svg, r#"<path d="M{x:.1} {y:.1}V{top:.1}m-3 0h6" stroke="{color}" fill="none"/>"#);
            }
            let _ = writeln!(svg, r##"<path d="{}" fill="{color}" stroke="#ffffff"/>"##, shape(*mark, *x, *y));
            if !label.is_empty() {
                let below = y + 19.0;
                let _ = writeln!(
                    svg,
                    r#"<text x="{x:.1}" y="{below:.1}" text-anchor="middle" font-size="10" fill="{color}">{}</text>"#,
                    escaped(label)
                );
            }
        }
    }
}

/// Where a value lies on a logarithmic axis, 0 to 1; what lies beyond is put at its end.
fn share(value: f64, range: &RangeInclusive<i32>) -> f64 {
    let (low, high) = (f64::from(*range.start()), f64::from(*range.end()));
    ((value.max(f64::MIN_POSITIVE).log10() - low) / (high - low)).clamp(0.0, 1.0)
}

fn shape(mark: Mark, x: f64, y: f64) -> String {
    let corners = |corners: &[(f64, f64)]| {
        let mut path = String::new();
        for (index, (dx, dy)) in corners.iter().enumerate() {
            let _ = write!(path, "{}{:.1} {:.1}", if index == 0 { 'M' } else { 'L' }, x + dx, y + dy);
        }
        path + "z"
    };
    match mark {
        Mark::Circle | Mark::Dots => format!("M{:.1} {y:.1}a4.5 4.5 0 1 0 9 0a4.5 4.5 0 1 0 -9 0z", x - 4.5),
        Mark::Square | Mark::Dashes => corners(&[(-4.2, -4.2), (4.2, -4.2), (4.2, 4.2), (-4.2, 4.2)]),
        Mark::Diamond => corners(&[(0.0, -6.0), (6.0, 0.0), (0.0, 6.0), (-6.0, 0.0)]),
        Mark::Triangle => corners(&[(0.0, -5.8), (5.4, 4.2), (-5.4, 4.2)]),
        Mark::Star => {
            let tip = |index: i32| {
                let radius = if index % 2 == 0 { 10.0 } else { 4.2 };
                let angle = std::f64::consts::PI * (f64::from(index) / 5.0 - 0.5);
                (radius * angle.cos(), radius * angle.sin())
            };
            corners(&(0..10).map(tip).collect::<Vec<_>>())
        }
    }
}

/// `text` as it stands in SVG.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_span_whole_decades_around_the_values() {
        assert_eq!(decades([3e-5, 2.0].into_iter(), -20, 6), -5..=1);
        assert_eq!(decades([0.0, f64::INFINITY].into_iter(), -20, 6), 5..=6);
        assert_eq!(decades([1e-30].into_iter(), -20, 6), -20..=-19);
    }

    #[test]
    fn a_name_that_svg_would_misread_is_escaped_and_every_series_is_in_the_legend_once() {
        let series = |mark| Series {
            name: "a < b".to_owned(),
            color: "#000000",
            mark,
            points: vec![Spot { x: 1.0, y: 1.0, upper: Some(5.0), label: "1 < 2".to_owned() }],
        };
        let panel = |title: &str| Panel { title: title.to_owned(), series: vec![series(Mark::Star)] };
        let labels = || "label".to_owned();
        let panels = vec![panel("one"), panel("two")];
        let chart = Chart { title: labels(), x_label: labels(), y_label: labels(), x: -1..=1, y: -1..=1, panels };
        let svg = chart.svg(200.0, 200.0);
        assert_eq!(svg.matches("a &lt; b").count(), 1);
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
    }
}
