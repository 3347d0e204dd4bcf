//! The screen of a filmed shot: the simulated balls, the filmed balls as outlines, and the distances between them.

use ratatui::{layout::Rect, text::Span};

use crate::{
    coach::{
        Units,
        words::{LengthUnit, TipUnit},
    },
    study::filmed::FITTED_SECONDS,
    table::{BALL_NAMES, BALLS},
    terminal::{
        FilmReplay, Glyphs,
        pages::drills::{
            DrillsPage,
            view::{films::outcome, panes::Panes},
        },
        shot::film::{ListedShot, table},
        ui::{
            Message, TableView, Ui, draw_events, draw_header, draw_lines, draw_spin_or_hit, draw_table, draw_tip,
            draw_title, pair, separator, tip_rows, write_paragraphs,
        },
        words::{fixed, speed_words},
    },
};

/// Draws the screen. Returns the default text of the status line.
pub fn draw(drills: &DrillsPage, header: Rect, area: Rect, ui: &mut Ui) -> Message {
    let (film, unit) = (&drills.film, drills.units.length);
    let Some(listed) = film.marked() else { return Message::plain("the film has no shots") };
    let more = subtitle(listed, unit, separator(ui.caps));
    draw_header(&format!("filmed shot {}", listed.filmed.number), &more, &Span::default(), header, ui);
    let panes = Panes::new(table(), area);
    let played = film.played();
    let view = TableView {
        shot: played.map(|played| played.shot.as_ref()),
        time: film.playback.time,
        film: played.map(|played| played.replay.filmed_positions(film.playback.time)),
        ..TableView::new(table(), &listed.layout)
    };
    draw_table(&view, panes.table, ui);
    let time = film.playback.readout;
    draw_stroke(played, listed, drills.units, panes.stroke, ui);
    let stroke = played.and_then(|played| played.stroke.as_ref());
    draw_tip(stroke, drills.units.tip == TipUnit::Tips, table(), panes.tip, ui);
    let spin = played.and_then(|played| played.shot.spin(time, table().radius));
    draw_spin_or_hit(spin, played.map(|played| played.shot.first_impact()), panes.hit, ui);
    draw_distances(played, time, unit, panes.aim, ui);
    let recording = played.map(|played| &played.shot.recording);
    let events = recording.map(|recording| (recording, recording.events()));
    draw_events("Events", events, Some(time), unit, panes.score, ui);
    match (played, film.failure()) {
        (Some(played), _) => status_line(played, listed, time, unit),
        (None, Some(sentence)) => Message::warning(sentence),
        (None, None) => Message::plain("the stroke is being fitted to the film's first 2 seconds"),
    }
}

/// Result, speed and duration of a filmed shot.
fn subtitle(listed: &ListedShot, unit: LengthUnit, dot: &str) -> String {
    let filmed = &listed.filmed;
    let speed = speed_words(filmed.speed(), unit, 1);
    [outcome(listed).to_owned(), speed, format!("{} s", fixed(filmed.duration(), 1))].join(dot)
}

/// Formats a distance in the smaller unit.
fn distance(metres: f64, unit: LengthUnit) -> String {
    let (in_a_metre, symbol) = unit.small();
    format!("{} {symbol}", fixed(in_a_metre * metres, 1))
}

/// The distance between the simulated and the filmed cue ball, and whether the film at this time was used for the fit.
fn status_line(played: &FilmReplay, listed: &ListedShot, time: f64, unit: LengthUnit) -> Message {
    let white = distance(played.replay.distances(time)[0], unit);
    if time >= played.replay.duration() {
        let simulated = if played.shot.solved { "a point" } else { "no point" };
        let filmed = if listed.is_point { "a point" } else { "no point" };
        return Message::plain(format!("at rest, white {white} from the film; simulated {simulated}, filmed {filmed}"));
    }
    let basis = if time <= FITTED_SECONDS { "within the fitted 2 s" } else { "predicted from the first 2 s" };
    Message::plain(format!("white is {white} from the film at {} s, {basis}", fixed(time, 1)))
}

/// Draws the fitted stroke, and the speeds of the cue ball from the fit and in the film.
fn draw_stroke(played: Option<&FilmReplay>, listed: &ListedShot, units: Units, area: Rect, ui: &mut Ui) {
    let inner = draw_title("The fitted stroke", area, ui);
    let Some(played) = played else { return };
    let [side, height] = match &played.stroke {
        Some(cue) => tip_rows(cue, units.tip, table().radius),
        None => [("cue", "not level".to_owned()), ("", String::new())],
    };
    let rows = [
        ("ball", speed_words(played.replay.recording.impulse().velocity.length(), units.length, 2)),
        ("filmed", speed_words(listed.filmed.speed(), units.length, 1)),
        side,
        height,
        ("fitted", format!("2 s, {} mm", fixed(1e3 * played.replay.fitted.rms, 1))),
    ];
    let text = Rect { x: inner.x + 1, width: inner.width.saturating_sub(1), ..inner };
    draw_lines(rows.map(|(name, value)| pair(name, 7, value, ui.theme)), text, ui);
}

/// Draws the distance between each simulated ball and the filmed one, and a legend.
fn draw_distances(played: Option<&FilmReplay>, time: f64, unit: LengthUnit, area: Rect, ui: &mut Ui) {
    let title = played.map_or("Film".to_owned(), |_| format!("From the film at {} s", fixed(time, 2)));
    let inner = draw_title(title, area, ui);
    let Some(played) = played else { return };
    let text = Rect { x: inner.x + 1, width: inner.width.saturating_sub(2), ..inner };
    let apart = played.replay.distances(time);
    let distances: Vec<String> =
        (0..BALLS).map(|n| format!("{} {}", BALL_NAMES[n], distance(apart[n], unit))).collect();
    let legend = if ui.caps.glyphs == Glyphs::Letters {
        "Capitals and paths are the simulation's, small letters the film's."
    } else {
        "Full balls and paths are the simulation's, outlines the film's."
    };
    let paragraphs = [
        (distances.join(", "), ui.theme.accent()),
        (legend.to_owned(), ui.theme.faint()),
        ("The stroke was fitted on the first 2 s.".to_owned(), ui.theme.faint()),
    ];
    write_paragraphs(&paragraphs, text, ui);
}
