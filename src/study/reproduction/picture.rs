//! Draws a figure as SVG: curves over the number of shots.

use std::io;

use super::{curves::Curve, figures::Figure};
use crate::study::chart::{Axis, Chart, GREY, Mark, Panel, RUST, Series, Spot};

/// Width and height in pixels, without the legend.
const SIZE: [u32; 2] = [1280, 640];

/// Draws the figure with a curve for every variant and seed, next to the reward of random play and the thesis' value.
///
/// # Errors
/// Fails if the figure cannot be drawn.
pub fn picture(figure: &Figure, curves: &[&Curve], random: Option<f64>) -> io::Result<String> {
    // The values of a training that broke down grow without bound, so they do not set the range of the axis.
    let sound = curves.iter().filter(|curve| curve.breakdown.is_none());
    let values: Vec<f64> = sound.flat_map(|curve| &curve.points).map(|point| point.of(figure.measure)).collect();
    let most_shots = curves.iter().flat_map(|curve| &curve.points).map(|point| point.shots).max().unwrap_or(1);
    let most = most_shots as f64 / 1000.0;
    let highest = values.iter().copied().chain(figure.thesis).chain(random).fold(1e-9, f64::max);
    let lowest = values.into_iter().fold(0.0, f64::min);

    let mut series = Vec::new();
    for ((variant, seed), curve) in figure.curves().zip(curves) {
        let of_variant = || figure.curves().zip(curves).filter(|((other, _), _)| other.name == variant.name);
        let ending = match of_variant().filter(|(_, curve)| curve.breakdown.is_some()).count() {
            0 => String::new(),
            broken => format!(" ({broken} of {} broke down)", of_variant().count()),
        };
        let spot = |x, y| Spot { x, y, ..Spot::default() };
        let points = curve.points.iter().map(|point| spot(point.shots as f64 / 1000.0, point.of(figure.measure)));
        let name = if seed == figure.seeds[0] { format!("{}{ending}", variant.name) } else { String::new() };
        series.push(Series { name, color: variant.color, mark: Mark::Line, points: points.collect() });
    }
    for (value, color, name) in [(random, GREY, "random play"), (figure.thesis, RUST, "the thesis")] {
        let Some(y) = value else { continue };
        let points = [0.0, most].map(|x| Spot { x, y, ..Spot::default() }).into();
        series.push(Series {
            name: format!("{name}: {}", (y * 1000.0).round() / 1000.0),
            color,
            mark: Mark::Dashes,
            points,
        });
    }
    let axis = |label: &str, range| Axis { label: label.to_owned(), range, is_logarithmic: false };
    Chart {
        x: axis("thousand shots", 0.0..most),
        y: axis(figure.measure.label(), lowest..1.05 * highest),
        panels: vec![Panel { title: figure.title.to_owned(), series }],
    }
    .svg(SIZE)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::reproduction::curves::Point;

    #[test]
    fn every_curve_is_drawn_and_named() {
        let figure = Figure::named("23").unwrap();
        let point = |shots, mean_reward| Point { shots, mean_reward, ..Point::default() };
        let curve = Curve { points: vec![point(10_000, 0.2), point(20_000, 0.79)], ..Curve::default() };
        let svg = picture(&figure, &[&curve, &curve], Some(0.18)).unwrap();
        for text in ["one shot", "20 shots", "random play: 0.18", "the thesis: 0.8", "thousand shots"] {
            assert!(svg.contains(text), "{text} in {svg}");
        }
    }
}
