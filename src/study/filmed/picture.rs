//! Draws filmed and simulated courses.

use std::io;

use glam::DVec2;
use plotters::prelude::*;

use super::{film::FilmedShot, shot_fit};
use crate::{
    simulation::Follower,
    study::chart::{AZURE, Area, CRIMSON, DrawResult, GREY, INK, svg, text},
    table::Table,
};

/// Number of panels in a row, and pixels per metre.
const COLUMNS: usize = 3;
const SCALE: f64 = 260.0;
/// Pixels around a panel and above it.
const MARGIN: u32 = 16;
const ABOVE: u32 = 32;

/// Draws the cue ball of some shots up to five seconds after the stroke, filmed (dots) and simulated on `table` (line), with
/// the stroke fitted to the first two seconds.
///
/// # Errors
/// Fails if the picture cannot be drawn.
pub fn paths(table: &Table, film: &[FilmedShot]) -> io::Result<String> {
    let shown: Vec<&FilmedShot> = film.iter().filter(|shot| shot.is_long_enough()).step_by(8).take(12).collect();
    let pixels = |metres: f64, around: u32| (SCALE * metres) as u32 + around;
    let [width, height] = [pixels(table.length, 2 * MARGIN), pixels(table.width, 2 * MARGIN + ABOVE)];
    let rows = shown.len().div_ceil(COLUMNS);
    svg([width * COLUMNS as u32, height * rows as u32 + ABOVE], |area| {
        let title = format!(
            "Cue ball up to 5 s: filmed (dots) and simulated on \"{}\" (line), fitted to the first 2 s",
            table.name
        );
        let area = area.titled(&title, text(INK))?;
        area.split_evenly((rows, COLUMNS)).iter().zip(shown).try_for_each(|(area, shot)| panel(area, table, shot))
    })
}

fn panel(area: &Area<'_>, table: &Table, shot: &FilmedShot) -> DrawResult {
    let Some(played) = shot_fit::fit_shot(table, shot) else { return Ok(()) };
    let half = 0.5 * DVec2::new(table.length, table.width);
    let mut chart = ChartBuilder::on(area)
        .margin(MARGIN)
        .caption(format!("shot {}: {:.0} cm off at 5 s", shot.number, 100.0 * played.errors[2]), text(INK))
        .build_cartesian_2d(-half.x..half.x, -half.y..half.y)?;
    chart.plotting_area().fill(&RGBColor(0xe8, 0xf0, 0xf7))?;
    let times: Vec<f64> = (0..500).map(|step| 0.01 * f64::from(step)).collect();
    let layout = shot.layout(table);
    let simulated = Follower::new(&times, 0).follow(table, &layout, &played.motion.impulse(table.radius));
    chart.draw_series(LineSeries::new(
        simulated.positions.iter().map(|position| (position.x, position.y)),
        AZURE.stroke_width(2),
    ))?;
    let filmed = shot.balls[0].iter().filter(|sample| sample.time < played.start + 5.0);
    chart.draw_series(filmed.map(|sample| Circle::new((sample.position.x, sample.position.y), 3, CRIMSON.filled())))?;
    let radius = (SCALE * table.radius) as i32;
    chart.draw_series(
        layout.balls[1..].iter().map(|position| Circle::new((position.x, position.y), radius, GREY.stroke_width(2))),
    )?;
    Ok(())
}
