//! Charts of the study as SVG, drawn by plotters: panels side by side with shared axes and a legend below. They are dark on a
//! white background, readable on any page.

use std::{f64::consts::TAU, io, ops::Range};

use plotters::{
    coord::Shift,
    prelude::*,
    style::text_anchor::{HPos, Pos, VPos},
};

/// A drawing area of the SVG backend.
pub type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Result of a drawing operation.
pub type DrawResult<T = ()> = Result<T, DrawingAreaErrorKind<io::Error>>;

/// Colour of text.
pub const INK: RGBColor = RGBColor(0x24, 0x29, 0x2f);
/// Colour of frames and baselines.
pub const GREY: RGBColor = RGBColor(0x8c, 0x95, 0x9f);
/// First colour for curves.
pub const CRIMSON: RGBColor = RGBColor(0xd1, 0x24, 0x2f);
/// Second colour for curves.
pub const AZURE: RGBColor = RGBColor(0x09, 0x69, 0xda);
/// Third colour for curves.
pub const FOREST: RGBColor = RGBColor(0x1a, 0x7f, 0x37);
/// Fourth colour for curves.
pub const VIOLET: RGBColor = RGBColor(0x82, 0x50, 0xdf);
/// Colour of published results.
pub const RUST: RGBColor = RGBColor(0xbc, 0x4c, 0x00);

const GRID: RGBColor = RGBColor(0xe3, 0xe6, 0xea);
const FONT: &str = "system-ui,'Segoe UI',Helvetica,Arial,'DejaVu Sans',sans-serif";
/// Size of ordinary text, pixels.
const TEXT: i32 = 30;
/// Series in a row of the legend, and the height of a row in pixels.
const PER_ROW: usize = 3;
const ROW: u32 = 46;

/// The marker of a series.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// A filled circle.
    Circle,
    /// A filled square.
    Square,
    /// A square standing on its corner.
    Diamond,
    /// A triangle.
    Triangle,
    /// A large star, for the main subject.
    Star,
    /// Small dots without a line.
    Dots,
    /// A line without markers.
    Line,
    /// A dashed line without markers.
    Dashes,
}

/// A named series of points.
#[derive(Clone, Debug)]
pub struct Series {
    /// Its name in the legend; empty to leave it out.
    pub name: String,
    /// Its colour.
    pub color: RGBColor,
    /// Its marker; all series except dots are joined by a line.
    pub mark: Mark,
    /// Its points.
    pub points: Vec<Spot>,
}

/// One data point of a series.
#[derive(Clone, Debug, Default)]
pub struct Spot {
    /// Value on the x axis.
    pub x: f64,
    /// Value on the y axis.
    pub y: f64,
    /// Upper end of a thin vertical line (error bar) from `y`.
    pub upper: Option<f64>,
    /// The text below the point.
    pub label: String,
}

/// One panel.
#[derive(Clone, Debug)]
pub struct Panel {
    /// The title above the panel.
    pub title: String,
    /// Its series. Series of the same name must look the same in all panels.
    pub series: Vec<Series>,
}

/// An axis.
#[derive(Clone, Debug)]
pub struct Axis {
    /// The text along the axis.
    pub label: String,
    /// The range of the axis: exponents of ten if it is logarithmic. Values outside are drawn at its end.
    pub range: Range<f64>,
    /// Whether the axis is logarithmic.
    pub is_logarithmic: bool,
}

impl Axis {
    /// Returns a logarithmic axis of whole decades around all positive and finite `values`, within 10^`least` to 10^`most`.
    pub fn decades(label: &str, values: impl Iterator<Item = f64>, least: i32, most: i32) -> Self {
        let (mut low, mut high) = (most, least);
        for value in values.filter(|value| *value > 0.0 && value.is_finite()) {
            low = low.min(value.log10().floor() as i32);
            high = high.max(value.log10().ceil() as i32);
        }
        let low = low.clamp(least, most - 1);
        let range = f64::from(low)..f64::from(high.clamp(low + 1, most));
        Self { label: label.to_owned(), range, is_logarithmic: true }
    }

    /// Whether a value is within the axis range.
    pub fn shows(&self, value: f64) -> bool {
        (self.range.start..=self.range.end).contains(&self.unbounded(value))
    }

    /// Returns the coordinate at which a value is drawn, clamped to the range.
    fn coordinate(&self, value: f64) -> f64 {
        self.unbounded(value).clamp(self.range.start, self.range.end)
    }

    fn unbounded(&self, value: f64) -> f64 {
        if self.is_logarithmic { value.max(f64::MIN_POSITIVE).log10() } else { value }
    }

    /// Returns the maximum number of tick labels: more would overlap.
    fn max_labels(&self) -> usize {
        let most = 9;
        if self.is_logarithmic { most.min((self.range.end - self.range.start) as usize + 1) } else { most }
    }

    fn tick_label(&self, coordinate: f64) -> String {
        if self.is_logarithmic {
            let digit = |c: char| {
                c.to_digit(10).map_or('⁻', |digit| ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][digit as usize])
            };
            format!("10{}", format!("{coordinate:.0}").chars().map(digit).collect::<String>())
        } else {
            // Rounded to drop the noise of the last digits.
            format!("{}", (coordinate * 1e9).round() / 1e9)
        }
    }
}

/// Panels side by side on the same axes.
#[derive(Clone, Debug)]
pub struct Chart {
    /// The x axis.
    pub x: Axis,
    /// The y axis.
    pub y: Axis,
    /// The panels.
    pub panels: Vec<Panel>,
}

impl Chart {
    /// Draws the chart with panels of the given size in pixels, titles and labels included.
    ///
    /// # Errors
    /// Fails if the chart cannot be drawn.
    pub fn svg(&self, [width, height]: [u32; 2]) -> io::Result<String> {
        let legend = self.legend();
        let rows = legend.len().div_ceil(PER_ROW) as u32;
        let size = [width * self.panels.len() as u32, height + rows * ROW + ROW / 2];
        svg(size, |area| {
            let (above, below) = area.split_vertically(height);
            for (area, panel) in above.split_evenly((1, self.panels.len())).iter().zip(&self.panels) {
                self.panel(area, panel)?;
            }
            let column = (size[0] - ROW) / PER_ROW as u32;
            for (index, series) in legend.into_iter().enumerate() {
                let (x, y) = (ROW + (index % PER_ROW) as u32 * column, ROW * (index / PER_ROW) as u32 + ROW / 2);
                series.in_legend(&below, (x.cast_signed(), y.cast_signed()))?;
            }
            Ok(())
        })
    }

    /// Returns one series of every name.
    fn legend(&self) -> Vec<&Series> {
        let mut legend: Vec<&Series> = Vec::new();
        for series in self.panels.iter().flat_map(|panel| &panel.series) {
            if !series.name.is_empty() && legend.iter().all(|known| known.name != series.name) {
                legend.push(series);
            }
        }
        legend
    }

    fn panel(&self, area: &Area<'_>, panel: &Panel) -> DrawResult {
        let mut chart = ChartBuilder::on(area)
            .margin(TEXT / 2)
            .margin_right(TEXT)
            .caption(&panel.title, text(INK).font.style(FontStyle::Bold))
            .x_label_area_size(3 * TEXT)
            .y_label_area_size(4 * TEXT)
            .build_cartesian_2d(self.x.range.clone(), self.y.range.clone())?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(GRID.stroke_width(2))
            .axis_style(GREY.stroke_width(2))
            .label_style(text(INK))
            .x_desc(&self.x.label)
            .y_desc(&self.y.label)
            .x_labels(self.x.max_labels())
            .y_labels(self.y.max_labels())
            .x_label_formatter(&|coordinate| self.x.tick_label(*coordinate))
            .y_label_formatter(&|coordinate| self.y.tick_label(*coordinate))
            .draw()?;
        for series in &panel.series {
            let place = |x, y| (self.x.coordinate(x), self.y.coordinate(y));
            let points = || series.points.iter().map(|spot| place(spot.x, spot.y));
            let line = series.color.stroke_width(3);
            match series.mark {
                Mark::Dots => {
                    chart.draw_series(points().map(|at| Circle::new(at, 4, series.color.mix(0.5).filled())))?;
                }
                Mark::Dashes => {
                    chart.draw_series(DashedLineSeries::new(points(), 12, 8, line))?;
                }
                _ => {
                    chart.draw_series(LineSeries::new(points(), line))?;
                }
            }
            let uppers = series.points.iter().filter_map(|spot| Some((spot, spot.upper?)));
            chart.draw_series(
                uppers.map(|(spot, upper)| PathElement::new([place(spot.x, spot.y), place(spot.x, upper)], line)),
            )?;
            let Some(corners) = series.mark.corners() else { continue };
            chart.draw_series(series.points.iter().map(|spot| {
                EmptyElement::at(place(spot.x, spot.y))
                    + Polygon::new(corners.clone(), series.color)
                    + Text::new(
                        spot.label.clone(),
                        (0, TEXT / 2),
                        text(series.color).pos(Pos::new(HPos::Center, VPos::Top)),
                    )
            }))?;
        }
        Ok(())
    }
}

impl Series {
    /// Draws the legend entry, marker and name, at a position in pixels.
    fn in_legend(&self, area: &Area<'_>, (x, y): (i32, i32)) -> DrawResult {
        let reach = TEXT;
        let line = self.color.stroke_width(3);
        match (self.mark, self.mark.corners()) {
            (Mark::Dots, _) => area.draw(&Circle::new((x, y), 6, self.color.filled()))?,
            (Mark::Dashes, _) => {
                for from in [x - reach, x - reach / 4, x + reach / 2] {
                    area.draw(&PathElement::new([(from, y), (from + reach / 2, y)], line))?;
                }
            }
            (_, None) => area.draw(&PathElement::new([(x - reach, y), (x + reach, y)], line))?,
            (_, Some(corners)) => area.draw(&(EmptyElement::at((x, y)) + Polygon::new(corners, self.color)))?,
        }
        let left = text(INK).pos(Pos::new(HPos::Left, VPos::Center));
        area.draw(&Text::new(self.name.clone(), (x + reach + TEXT / 3, y), left))
    }
}

impl Mark {
    /// Returns the corners of the marker's shape around the point, in pixels; `None` if points are not marked individually.
    fn corners(self) -> Option<Vec<(i32, i32)>> {
        let (corners, radii, turned) = match self {
            Self::Circle => (24, [9.0, 9.0], 0.0),
            Self::Square => (4, [12.0, 12.0], 0.5),
            Self::Diamond => (4, [12.0, 12.0], 0.0),
            Self::Triangle => (3, [13.0, 13.0], 0.0),
            Self::Star => (10, [20.0, 8.4], 0.0),
            Self::Dots | Self::Line | Self::Dashes => return None,
        };
        let corner = |index: usize| {
            let (sin, cos) = (TAU * (index as f64 + turned) / corners as f64).sin_cos();
            let radius = radii[index % 2];
            ((radius * sin).round() as i32, (-radius * cos).round() as i32)
        };
        Some((0..corners).map(corner).collect())
    }
}

/// Draws an SVG of the given size in pixels on a white background.
///
/// # Errors
/// Fails if the picture cannot be drawn.
pub fn svg([width, height]: [u32; 2], draw: impl FnOnce(&Area<'_>) -> DrawResult) -> io::Result<String> {
    let mut svg = String::new();
    let area = SVGBackend::with_string(&mut svg, (width, height)).into_drawing_area();
    area.fill(&WHITE).and_then(|()| draw(&area)).and_then(|()| area.present()).map_err(io::Error::other)?;
    drop(area);
    Ok(svg)
}

/// Returns the style of ordinary text.
pub fn text(color: RGBColor) -> TextStyle<'static> {
    (FONT, TEXT).into_font().color(&color)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_span_whole_decades_around_the_values() {
        let decades = |values: &[f64]| Axis::decades("", values.iter().copied(), -20, 6).range;
        assert_eq!(decades(&[3e-5, 2.0]), -5.0..1.0);
        assert_eq!(decades(&[0.0, f64::INFINITY]), 5.0..6.0);
        assert_eq!(decades(&[1e-30]), -20.0..-19.0);
    }

    #[test]
    fn tick_labels_are_written_as_people_write_numbers() {
        let powers = Axis::decades("", [1e-12, 1.0].into_iter(), -20, 6);
        assert_eq!([powers.tick_label(-12.0), powers.tick_label(0.0)], ["10⁻¹²", "10⁰"]);
        let plain = Axis { is_logarithmic: false, ..powers };
        assert_eq!([plain.tick_label(0.1 + 0.2), plain.tick_label(250.0)], ["0.3", "250"]);
    }

    #[test]
    fn every_series_is_in_the_legend_once_and_points_stay_in_the_frame() {
        let panel = |title: &str| Panel {
            title: title.to_owned(),
            series: vec![Series {
                name: "a < b".to_owned(),
                color: CRIMSON,
                mark: Mark::Star,
                points: vec![Spot { x: 1.0, y: 1e300, upper: Some(f64::INFINITY), label: "1 < 2".to_owned() }],
            }],
        };
        let axis = Axis::decades("axis", [0.1, 10.0].into_iter(), -1, 1);
        let chart = Chart { x: axis.clone(), y: axis, panels: vec![panel("one"), panel("two")] };
        let svg = chart.svg([300, 300]).unwrap();
        assert_eq!([svg.matches("a &lt; b").count(), svg.matches("1 &lt; 2").count()], [1, 2]);
        let numbers = svg.split(['"', ' ', ',']).filter_map(|number| number.parse::<f64>().ok());
        assert!(numbers.into_iter().all(|number| number.abs() <= 700.0), "{svg}");
    }
}
