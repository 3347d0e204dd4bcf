//! Sentences about balls and shots, for ears.

use crate::{
    coach::{Aim, Kind, Margin, Skill},
    learning::evaluation::SuccessRate,
    physics::CueInputs,
    simulation::Recording,
    table::{Layout, Table},
    terminal::words::{BALL_NAMES, event_words, fixed, percent, rail_name},
};

/// Where the balls lie.
pub fn places(table: &Table, layout: &Layout) -> String {
    let place = |ball: usize| {
        let at = layout.balls[ball];
        let diamonds = (at + glam::DVec2::new(0.5 * table.length, 0.5 * table.width)) / table.diamond();
        format!(
            "{} at {} diamonds along and {} up, {} and {} millimetres from the middle.",
            BALL_NAMES[ball],
            fixed(diamonds.x, 2),
            fixed(diamonds.y, 2),
            fixed(1e3 * at.x, 0),
            fixed(1e3 * at.y, 0)
        )
    };
    (0..layout.balls.len()).map(place).collect::<Vec<_>>().join("\n")
}

/// How to strike.
pub fn stroke(table: &Table, cue: &CueInputs, aim: Option<&Aim>) -> String {
    let offset = |value: f64, plus: &str, minus: &str| match fixed(1e3 * table.radius * value.abs(), 1) {
        zero if zero == "0.0" => None,
        distance => Some(format!("{distance} millimetres {}", if value > 0.0 { plus } else { minus })),
    };
    let tip = [offset(cue.a, "left", "right"), offset(cue.b, "above", "below")];
    let tip = tip.into_iter().flatten().collect::<Vec<_>>().join(" and ");
    let tip = if tip.is_empty() { "Strike the centre.".to_owned() } else { format!("Strike {tip} the centre.") };
    let speed = format!(
        "Speed {} metres a second, cue raised {} degrees, direction {} degrees.",
        fixed(cue.speed, 2),
        fixed(cue.theta.to_degrees(), 1),
        fixed(cue.phi.to_degrees(), 2)
    );
    let mut lines = vec![tip, speed];
    if let Some(Aim { ahead, behind, hit }) = aim {
        lines.push(format!(
            "The line of aim comes from the {} at {} and goes to the {} at {} diamonds.",
            rail_name(behind.rail),
            fixed(behind.diamond, 2),
            rail_name(ahead.rail),
            fixed(ahead.diamond, 2)
        ));
        lines.extend(hit.map(|hit| {
            let side = if hit.left { "left" } else { "right" };
            let percent = fixed(100.0 * hit.fullness, 0);
            format!("The cue ball hits {} {percent} percent full on its {side} side.", BALL_NAMES[hit.ball])
        }));
    }
    lines.join("\n")
}

/// What sort of shot, and how often the player makes it.
pub fn chance(kind: Option<Kind>, rate: Option<SuccessRate>, skill: Skill) -> String {
    let kind = kind.map_or("No point was found; this is the best attempt".to_owned(), |kind| kind.to_string());
    match rate {
        Some(rate) => format!(
            "{kind}. Player {skill} makes it {} percent of the time, between {} and {}.",
            percent(rate.rate),
            percent(rate.low),
            percent(rate.high)
        ),
        None => format!("{kind}."),
    }
}

/// How far off each input may be.
pub fn margins(margins: &[Margin]) -> String {
    let end = |end: Option<f64>| end.map_or("any".to_owned(), |end| fixed(end, 2));
    let line = |margin: &Margin| {
        format!("{}: {} less to {} more, {}.", margin.input.name(), end(margin.less), end(margin.more), margin.unit)
    };
    margins.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// What happens in a shot.
pub fn events(recording: &Recording) -> String {
    let line = |event: &crate::simulation::Event| format!("{} s: {}.", fixed(event.time, 2), event_words(event.kind));
    let mut lines: Vec<String> = recording.events().iter().map(line).collect();
    lines.push(format!("{} s: all balls lie still.", fixed(recording.duration(), 2)));
    lines.join("\n")
}
