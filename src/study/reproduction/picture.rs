//! A figure as SVG: curves over the shots, dark on a white card, so that they can be read on any page.

use std::fmt::Write;

use super::{curves::Curve, figures::Figure};
use crate::study::chart::{FONTS, GRID, INK, escaped};

/// Size of the picture and the frame within: left, top, right, bottom.
const SIZE: [f64; 2] = [640.0, 400.0];
const FRAME: [f64; 4] = [64.0, 40.0, 620.0, 300.0];

/// The figure with its curves, one for every reading, beside the reward of random play and what the thesis says.
pub fn picture(figure: &Figure, curves: &[&Curve], random: Option<f64>) -> String {
    let [left, top, right, bottom] = FRAME;
    // A training that broke down leaves values without bounds: its curve may leave the frame.
    let sound = || curves.iter().filter(|curve| curve.broke_down.is_none());
    let values = || sound().flat_map(|curve| &curve.points).map(|point| point.of(figure.measure));
    let most_shots = curves.iter().flat_map(|curve| &curve.points).map(|point| point.shots).max().unwrap_or(1) as f64;
    let highest = values().chain(figure.thesis).chain(random).fold(0.0, f64::max);
    let lowest = values().fold(0.0, f64::min);
    let (y_step, x_step) = (round_step((highest - lowest) / 5.0), round_step(most_shots / 5.0));
    let (low, high) = ((lowest / y_step).floor() * y_step, ((highest / y_step).ceil() * y_step).max(y_step));
    let x = |shots: f64| left + (right - left) * shots / most_shots;
    let y = |value: f64| bottom - (bottom - top) * (value - low) / (high - low);

    let [width, height] = SIZE;
    let mut svg = format!(
        r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}" role="img" font-family="{FONTS}" font-size="13" fill="{INK}">
<title>{title}: {label} over the shots played</title>
<clipPath id="frame"><rect x="{left}" y="{top}" width="{frame_width}" height="{frame_height}"/></clipPath>
<rect width="{width}" height="{height}" rx="10" fill="#ffffff"/>
<text x="{middle}" y="26" text-anchor="middle" font-weight="600">{title}</text>
"##,
        title = escaped(figure.title),
        label = figure.measure.label(),
        frame_width = right - left,
        frame_height = bottom - top,
        middle = 0.5 * (left + right),
    );
    // Writing to a string cannot fail.
    for index in 0..=((high - low) / y_step).round() as u32 {
        let value = low + f64::from(index) * y_step;
        let at = y(value);
        let _ = writeln!(svg, r#"<path d="M{left} {at:.1}H{right}" stroke="{GRID}"/>"#);
        let (text, at) = (short(value, y_step), at + 4.5);
        let _ = writeln!(svg, r#"<text x="{}" y="{at:.1}" text-anchor="end">{text}</text>"#, left - 8.0);
    }
    for index in 0..=(most_shots / x_step).floor() as u32 {
        let value = f64::from(index) * x_step;
        let (at, text) = (x(value), short(value / 1000.0, x_step / 1000.0));
        let _ = writeln!(svg, r#"<path d="M{at:.1} {top}V{bottom}" stroke="{GRID}"/>"#);
        let _ = writeln!(svg, r#"<text x="{at:.1}" y="{}" text-anchor="middle">{text}</text>"#, bottom + 18.0);
    }
    let (middle, down) = (0.5 * (top + bottom), bottom + 38.0);
    let _ =
        writeln!(svg, r#"<text x="{}" y="{down}" text-anchor="middle">thousand shots</text>"#, 0.5 * (left + right));
    let _ = writeln!(
        svg,
        r#"<text x="18" y="{middle}" text-anchor="middle" transform="rotate(-90 18 {middle})">{}</text>"#,
        figure.measure.label()
    );
    let mut legend = Vec::new();
    for (value, color, name) in [(random, "#8c959f", "random play"), (figure.thesis, "#bc4c00", "the thesis")] {
        if let Some(value) = value {
            let at = y(value);
            let _ = writeln!(svg, r#"<path d="M{left} {at:.1}H{right}" stroke="{color}" stroke-dasharray="6 4"/>"#);
            legend.push((color, " stroke-dasharray=\"6 4\"", format!("{name}: {}", short(value, y_step / 10.0))));
        }
    }
    for (index, ((reading, seed), curve)) in figure.curves().zip(curves).enumerate() {
        let mut path = String::new();
        for point in &curve.points {
            let letter = if path.is_empty() { 'M' } else { 'L' };
            // Far outside the frame it does not matter where; some viewers choke on large numbers.
            let at = y(point.of(figure.measure)).clamp(-9_999.0, 9_999.0);
            let _ = write!(path, "{letter}{:.1} {at:.1}", x(point.shots as f64));
        }
        let (color, width) = (reading.color, if figure.seeds == 1 { "2" } else { "1.2" });
        let _ = writeln!(
            svg,
            r#"<path d="{path}" fill="none" stroke="{color}" stroke-width="{width}" clip-path="url(#frame)"/>"#
        );
        let ending = if curve.broke_down.is_some() { " (broke down)" } else { "" };
        if seed == 0 {
            let place = index / figure.seeds.max(1) as usize;
            legend.insert(place, (color, " stroke-width=\"2\"", format!("{}{ending}", reading.name)));
        }
    }
    let _ = writeln!(
        svg,
        r##"<rect x="{left}" y="{top}" width="{}" height="{}" fill="none" stroke="#8c959f"/>"##,
        right - left,
        bottom - top
    );
    for (index, (color, style, text)) in legend.iter().enumerate() {
        let (at_x, at_y) = (left + 190.0 * (index % 3) as f64, bottom + 62.0 + 22.0 * (index / 3) as f64);
        let to = at_x + 24.0;
        let _ = writeln!(svg, r#"<path d="M{at_x} {at_y}H{to}" stroke="{color}"{style}/>"#);
        let _ = writeln!(svg, r#"<text x="{}" y="{}">{}</text>"#, to + 6.0, at_y + 4.5, escaped(text));
    }
    svg.push_str("</svg>\n");
    svg
}

/// 1, 2 or 5 times a power of ten, at least `step`.
fn round_step(step: f64) -> f64 {
    // A curve of nought everywhere still has an axis.
    let step = step.max(1e-9);
    let power = 10_f64.powf(step.log10().floor());
    [1.0, 2.0, 5.0, 10.0].into_iter().map(|factor| factor * power).find(|round| *round >= step * 0.999).unwrap_or(step)
}

/// A number with the digits that a step of `step` needs.
fn short(value: f64, step: f64) -> String {
    let digits = (-step.log10().floor()).clamp(0.0, 9.0) as usize;
    format!("{value:.digits$}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::reproduction::curves::Point;

    #[test]
    fn steps_are_round_numbers() {
        let close = |step, round: f64| assert!((round_step(step) - round).abs() < 1e-9 * round, "{step}");
        for (step, round) in [(0.16, 0.2), (0.2, 0.2), (0.21, 0.5), (60_000.0, 100_000.0)] {
            close(step, round);
        }
        assert_eq!(short(0.1 + 0.2, 0.1), "0.3");
        assert_eq!(short(200.0, 50.0), "200");
    }

    #[test]
    fn every_curve_lies_within_the_frame_and_is_named() {
        let figure = Figure::named("23").unwrap();
        let point = |shots, mean_reward| Point { shots, mean_reward, ..Point::default() };
        let curve = Curve { points: vec![point(10_000, 0.2), point(20_000, 0.79)], ..Curve::default() };
        let svg = picture(&figure, &[&curve, &curve], Some(0.18));
        for text in ["one shot", "20 shots", "random play: 0.18", "the thesis: 0.80", "M342.0 235.0L620.0 43.2"] {
            assert!(svg.contains(text), "{text} in {svg}");
        }
    }
}
