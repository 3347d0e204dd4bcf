//! The two plots of the study: the error against the run time, and against the condition of the shot.

use std::io;

use plotters::style::RGBColor;

use super::{
    chart::{AZURE, Axis, CRIMSON, Chart, FOREST, GREY, INK, Mark, Panel, RUST, Series, Spot, VIOLET},
    precision::{Row, Study},
    reference_engine::Real,
};

/// Width and height of a panel in pixels.
const SIZE: [u32; 2] = [900, 820];

/// Smaller errors are drawn at this value, m: the last digit of a coordinate.
const SMALLEST_ERROR: f64 = 1e-17;

/// Maximum number of dots in a series; more would only overlap.
const MAX_DOTS: usize = 300;

/// Colour and marker of each family, in the legend's order.
const STYLES: [(&str, RGBColor, Mark); 7] = [
    ("engine", CRIMSON, Mark::Star),
    ("plain, roots between extrema", AZURE, Mark::Square),
    ("plain, Ferrari's formula", RGBColor(0xbf, 0x39, 0x89), Mark::Triangle),
    ("plain, Algorithm 1010", FOREST, Mark::Diamond),
    ("plain, f32", RGBColor(0x57, 0x60, 0x6a), Mark::Square),
    ("steps", RUST, Mark::Circle),
    ("steps, events located", VIOLET, Mark::Circle),
];

/// Plots the error at rest against the run time: the median of each method with a thin line up to the 99th percentile. Methods
/// with fixed steps form a curve over the time step.
///
/// # Errors
/// Fails if the plot cannot be drawn.
pub fn error_against_time(studies: &[Study]) -> io::Result<String> {
    let panels = studies.iter().map(|study| {
        let series = STYLES.iter().filter_map(|&(family, color, mark)| {
            let rows = || study.rows.iter().filter(|row| row.method == family);
            let points: Vec<_> = rows().filter_map(point_of).collect();
            let name = rows().next()?.description.to_owned();
            (!points.is_empty()).then_some(Series { name, color, mark, points })
        });
        Panel { title: title(study), series: series.collect() }
    });
    let panels: Vec<Panel> = panels.collect();
    let points = || panels.iter().flat_map(|panel| &panel.series).flat_map(|series| &series.points);
    let errors = points().flat_map(|spot| [spot.y, spot.upper.unwrap_or(spot.y)]);
    let x = Axis::decades("run time of a shot, µs", points().map(|spot| spot.x), -2, 9);
    let y = Axis::decades("error at rest, m: median and p99", errors, -17, 1);
    Chart { x, y, panels }.svg(SIZE)
}

/// Returns the panel title: the table and the greatest elevation.
fn title(study: &Study) -> String {
    format!("\"{}\" table, cue up to {:.0}°", study.summary.table, study.summary.steepest_deg)
}

fn point_of(row: &Row) -> Option<Spot> {
    let rest = row.rest_m?;
    let label = row.dt.map_or_else(String::new, |dt| format!("{dt:e} s"));
    Some(Spot { x: row.cost_us, y: rest.median.max(SMALLEST_ERROR), upper: Some(rest.p99.max(SMALLEST_ERROR)), label })
}

/// Plots the error at rest against the condition, one dot a shot, with lines at 1 and 64 units; a unit is (1 + condition) 2^-53
/// m.
///
/// # Errors
/// Fails if the plot cannot be drawn.
pub fn error_against_condition(studies: &[Study]) -> io::Result<String> {
    let shown = [("plain, f32", None), ("steps", Some(1e-3)), ("steps, events located", Some(1e-3)), ("engine", None)];
    let panels = studies.iter().map(|study| {
        let series = shown.iter().filter_map(|&(family, dt)| dots(study, family, dt)).collect();
        Panel { title: title(study), series }
    });
    let mut panels: Vec<Panel> = panels.collect();
    let dots = || panels.iter().flat_map(|panel| &panel.series).flat_map(|series| &series.points);
    let x = Axis::decades("condition of the shot, m", dots().map(|spot| spot.x), -1, 9);
    let y = Axis::decades("error at rest, m", dots().map(|spot| spot.y), -17, 1);
    for (name, color, factor) in [("1 unit", INK, 1.0), ("64 units", GREY, 64.0)] {
        let conditions = (-20..120).map(|tenth| 10_f64.powf(f64::from(tenth) / 10.0));
        let line = conditions.map(|x| Spot { x, y: factor * (1.0 + x) * f64::ROUNDING, ..Spot::default() });
        let points: Vec<Spot> = line.filter(|spot| x.shows(spot.x) && y.shows(spot.y)).collect();
        let series = Series { name: name.to_owned(), color, mark: Mark::Dashes, points };
        for panel in &mut panels {
            panel.series.push(series.clone());
        }
    }
    Chart { x, y, panels }.svg(SIZE)
}

fn dots(study: &Study, family: &str, dt: Option<f64>) -> Option<Series> {
    let index = study.rows.iter().position(|row| row.method == family && row.dt == dt)?;
    let color = STYLES.iter().find(|look| look.0 == family)?.1;
    let points = study.points[index].iter().take(MAX_DOTS);
    let points =
        points.map(|point| Spot { x: point.condition, y: point.rest.max(SMALLEST_ERROR), ..Spot::default() }).collect();
    let description = study.rows[index].description;
    let name = dt.map_or_else(|| description.to_owned(), |dt| format!("{description}, dt {dt:e} s"));
    Some(Series { name, color, mark: Mark::Dots, points })
}
