//! The study's two pictures: what exactness costs, and what limits it.

use std::ops::RangeInclusive;

use super::{
    chart::{Chart, Mark, Panel, Series, Spot, decades},
    precision::{Row, Study},
    reference_engine::Real,
};

/// Size of a panel.
const SIZE: (f64, f64) = (400.0, 360.0);

/// Errors below this are drawn there, m: the last digit of a coordinate.
const LEAST: f64 = 1e-17;

/// Most dots of a series; more would only hide each other.
const MOST_DOTS: usize = 500;

/// How each family is drawn, in the legend's order.
const LOOKS: [(&str, &str, Mark); 7] = [
    ("engine", "#d1242f", Mark::Star),
    ("plain, roots between extrema", "#0969da", Mark::Square),
    ("plain, Ferrari's formula", "#bf3989", Mark::Triangle),
    ("plain, Algorithm 1010", "#1a7f37", Mark::Diamond),
    ("plain, f32", "#57606a", Mark::Square),
    ("steps", "#bc4c00", Mark::Circle),
    ("steps, events located", "#8250df", Mark::Circle),
];

/// Error at rest against run time: the median of each method, a thin line up to 99 in a hundred shots, and for methods of
/// fixed steps a curve over the time step.
pub fn error_against_time(studies: &[Study]) -> String {
    let panels = studies.iter().map(|study| {
        let series = LOOKS.iter().filter_map(|&(family, color, mark)| {
            let rows = study.rows.iter().filter(|row| row.method == family);
            let points: Vec<_> = rows.filter_map(point_of).collect();
            (!points.is_empty()).then(|| Series { name: family.to_owned(), color, mark, points })
        });
        Panel { title: title(study), series: series.collect() }
    });
    let panels: Vec<Panel> = panels.collect();
    let points = || panels.iter().flat_map(|panel| &panel.series).flat_map(|series| &series.points);
    let (x, y) = (
        decades(points().map(|spot| spot.x), -2, 9),
        decades(points().flat_map(|spot| [spot.y, spot.upper.unwrap_or(spot.y)]), -17, 1),
    );
    Chart {
        title: "Error at rest against run time, by method and time step".to_owned(),
        x_label: "run time of a shot, µs".to_owned(),
        y_label: "error at rest, m: median and p99".to_owned(),
        x,
        y,
        panels,
    }
    .svg(SIZE.0, SIZE.1)
}

/// The table of a study, and how far the cue is raised on it.
fn title(study: &Study) -> String {
    format!("\"{}\" table, cue up to {:.0}°", study.summary.table, study.summary.steepest_deg)
}

fn point_of(row: &Row) -> Option<Spot> {
    let rest = row.rest_m?;
    let label = row.dt.map_or_else(String::new, |dt| format!("{dt:e} s"));
    Some(Spot { x: row.cost_us, y: rest.median.max(LEAST), upper: Some(rest.p99.max(LEAST)), label })
}

/// Error at rest against the shot's own amplification, shot by shot.
pub fn error_against_condition(studies: &[Study]) -> String {
    let shown = [("plain, f32", None), ("steps", Some(1e-3)), ("steps, events located", Some(1e-3)), ("engine", None)];
    let panels = studies.iter().map(|study| {
        let mut series: Vec<Series> = shown.iter().filter_map(|&(family, dt)| dots(study, family, dt)).collect();
        for (name, color, factor) in [("1 unit", "#24292f", 1.0), ("64 units", "#8c959f", 64.0)] {
            let conditions = (-20..120).map(|tenth| 10_f64.powf(f64::from(tenth) / 10.0));
            let line = |x: f64| Spot { x, y: factor * (1.0 + x) * f64::ROUNDING, ..Spot::default() };
            let points = conditions.map(line).collect();
            series.push(Series { name: name.to_owned(), color, mark: Mark::Dashes, points });
        }
        Panel { title: title(study), series }
    });
    let panels: Vec<Panel> = panels.collect();
    let dots = || {
        let series = panels.iter().flat_map(|panel| &panel.series);
        series.filter(|series| series.mark == Mark::Dots).flat_map(|series| &series.points)
    };
    let (x, y) = (decades(dots().map(|spot| spot.x), -1, 9), decades(dots().map(|spot| spot.y), -17, 1));
    let clipped = |panel: &Panel| {
        let within = |value: f64, range: &RangeInclusive<i32>| {
            value >= 10_f64.powi(*range.start()) && value <= 10_f64.powi(*range.end())
        };
        let inside = |spot: &&Spot| within(spot.x, &x) && within(spot.y, &y);
        let series = panel.series.iter().map(|series| {
            let points = if series.mark == Mark::Dashes {
                series.points.iter().filter(inside).cloned().collect()
            } else {
                series.points.clone()
            };
            Series { points, ..series.clone() }
        });
        Panel { title: panel.title.clone(), series: series.collect() }
    };
    Chart {
        title: "Error at rest against the shot's condition; a unit is (1 + condition) 2^-53 m".to_owned(),
        x_label: "condition of the shot, m".to_owned(),
        y_label: "error at rest, m".to_owned(),
        panels: panels.iter().map(clipped).collect(),
        x,
        y,
    }
    .svg(SIZE.0, SIZE.1)
}

fn dots(study: &Study, family: &str, dt: Option<f64>) -> Option<Series> {
    let index = study.rows.iter().position(|row| row.method == family && row.dt == dt)?;
    let color = LOOKS.iter().find(|look| look.0 == family)?.1;
    let points = study.points[index].iter().take(MOST_DOTS);
    let points = points.map(|point| Spot { x: point.condition, y: point.rest.max(LEAST), ..Spot::default() }).collect();
    let name = dt.map_or_else(|| family.to_owned(), |dt| format!("{family}, dt {dt:e} s"));
    Some(Series { name, color, mark: Mark::Dots, points })
}
