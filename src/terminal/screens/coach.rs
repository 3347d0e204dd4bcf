//! The coach's screen: the table, what the coach recommends, and the shot as it plays.

use ratatui::{
    buffer::Buffer,
    layout::{Position, Rect},
};

use super::{panes::Panes, target::Target};
use crate::{
    coach::{Mark, line_of_aim},
    table::BALLS,
    terminal::{
        app::{App, Mode},
        coach::{Advised, View},
        geometry::Mapping,
        playback::passed,
        shot::Shot,
        status::Message,
        widgets::{
            TableView, choice_at, draw_aim_map, draw_balls, draw_chances, draw_events, draw_header, draw_hints,
            draw_legend, draw_margins, draw_plan, draw_proposal, draw_shot, draw_sight, draw_spin, draw_status,
            draw_table, draw_tip, draw_tip_map, plan_spots,
        },
        words::{event_words, fixed, millimetres, percent, rail_word, step_words},
    },
};

/// Draws the screen; gives the first row of what stands below the picture.
pub fn draw(app: &App, area: Rect, buffer: &mut Buffer) -> u16 {
    let panes = Panes::new(app.table(), area);
    let (theme, look) = (app.theme(), app.look());
    draw_header(app, panes.header, buffer);
    let choice = app.coach().shown().map(Advised::choice);
    let planned = choice.filter(|_| app.coach().view == View::Plan);
    let spots = planned.map_or_else(Vec::new, |choice| plan_spots(choice, theme));
    let view = TableView {
        table: app.table(),
        layout: app.layout(),
        shot: app.shot().map(AsRef::as_ref),
        time: app.playback().time,
        is_moving: app.mode() == Mode::Watching,
        front: app.selected(),
        // While the coach thinks each better shot would move them all.
        is_lean: planned.is_some() || app.spinner().is_some(),
        spots: &spots,
        theme,
        look,
    };
    draw_table(&view, panes.table, buffer);
    draw_panels(app, &panes, buffer);
    let standing = || Message::plain(standing(app));
    draw_hints(app, panes.hints, buffer);
    draw_status(&app.message().cloned().unwrap_or_else(standing), panes.status, theme, look, buffer)
}

/// Draws the panels: the chosen view's, with the maps in place of shot, tip and events beside the margins; then others as
/// far as there is room.
fn draw_panels(app: &App, panes: &Panes, buffer: &mut Buffer) {
    let (theme, look, table, shot) = (app.theme(), app.look(), app.table(), app.shot().map(AsRef::as_ref));
    let chosen = app.coach().view;
    for (view, area) in views(chosen, panes) {
        draw_info(app, view, area, buffer);
    }
    let study = app.coach().shown().and_then(|advised| advised.choice().study.as_ref());
    if let (View::Margins, Some(study), Some(shot)) = (chosen, study, shot) {
        draw_aim_map(&study.aim, app.coach().tutor.skill, panes.shot, theme, look, buffer);
        draw_tip_map(&study.tip, &shot.cue, table, panes.tip.union(panes.sight), theme, look, buffer);
        return draw_legend(panes.events, theme, look, buffer);
    }
    match app.coach().proposal() {
        Some(proposal) => draw_proposal(proposal, table, app.layout(), panes.shot, theme, look, buffer),
        None => draw_shot(None, &["no shot yet", "Enter asks", "the coach"], table, panes.shot, theme, look, buffer),
    }
    draw_tip(shot.map(|shot| &shot.cue), table, panes.tip, theme, look, buffer);
    let time = app.watched().map(|_| app.playback().readout);
    match shot.zip(time).and_then(|(shot, time)| shot.spin(time, table.radius)) {
        Some(spin) => draw_spin(&spin, panes.sight, theme, look, buffer),
        None => draw_sight(shot.map(Shot::meeting), panes.sight, theme, look, buffer),
    }
    draw_events(shot, time, panes.events, theme, look, buffer);
}

/// The chosen view and the others that there is room for, each with its panel.
fn views(chosen: View, panes: &Panes) -> impl Iterator<Item = (View, Rect)> {
    let others = [View::Chances, View::Margins, View::Plan].into_iter().filter(move |view| *view != chosen);
    std::iter::once((chosen, panes.info)).chain(others.zip(panes.more).filter(|(_, area)| !area.is_empty()))
}

/// Where the table is drawn.
pub fn table_mapping(app: &App, area: Rect) -> Mapping {
    Mapping::fit(app.table(), Panes::new(app.table(), area).table)
}

/// What the mouse points at.
pub fn target(app: &App, area: Rect, at: Position) -> Option<Target> {
    let mapping = table_mapping(app, area);
    if mapping.bed.contains(at) {
        return Some(Target::Table(mapping));
    }
    let panes = Panes::new(app.table(), area);
    let (_, panel) = views(app.coach().view, &panes).find(|(view, _)| *view == View::Chances)?;
    let advised = app.coach().shown().filter(|_| panel.contains(at))?;
    choice_at(advised, panel, at.y).map(Target::Shot)
}

/// Draws what one of the views tells.
fn draw_info(app: &App, view: View, area: Rect, buffer: &mut Buffer) {
    let (theme, look, coach) = (app.theme(), app.look(), app.coach());
    let advised = coach.shown();
    let choice = advised.map(Advised::choice);
    let empty = match (app.spinner(), choice) {
        (Some(_), _) => "the coach is thinking",
        (None, Some(_)) => "being worked out",
        (None, None) => "no shot yet; Enter asks the coach",
    };
    match view {
        View::Balls => draw_balls(app, area, buffer),
        View::Chances => draw_chances(advised, empty, area, theme, look, buffer),
        View::Margins => {
            let study = choice.and_then(|choice| choice.study.as_deref());
            draw_margins(study, coach.tutor.skill, empty, area, theme, look, buffer);
        }
        View::Plan => draw_plan(choice, empty, area, theme, look, buffer),
    }
}

/// What the status line says while there is no news.
fn standing(app: &App) -> String {
    if let Some(picture) = app.spinner() {
        let pictures =
            app.look().pick(["⠋", "⠙", "⠹", "⠸", "⠼", "⠴", "⠦", "⠧"], ["|", "/", "-", "\\", "|", "/", "-", "\\"]);
        let so_far = app.coach().proposal().filter(|proposal| proposal.is_early).and_then(|proposal| proposal.made);
        let words = so_far.map_or("the coach is thinking; Esc stops it".to_owned(), |made| {
            format!("so far a shot that makes the point {} % of the time; Esc takes it", percent(made.rate))
        });
        return format!("{} {words}", pictures[picture % pictures.len()]);
    }
    match app.watched() {
        Some(shot) if app.playback().time == 0.0 => aim_words(app, shot),
        Some(shot) => {
            let (events, time) = (shot.recording.events(), app.playback().readout);
            events.get(passed(events, time)).map_or("all balls lie still".to_owned(), |next| {
                format!("next: {} in {} s", event_words(next.kind, app.cue_ball()), fixed(next.time - time, 1))
            })
        }
        None => selected_ball(app),
    }
}

/// How the first ball is hit, and the line of aim in diamonds, as a player reads it off the rails.
fn aim_words(app: &App, shot: &Shot) -> String {
    let hit = shot.contact_words(app.cue_ball()).unwrap_or_else(|| "hits no ball".to_owned());
    let mark = |mark: Mark| format!("{} {}", rail_word(mark.rail), fixed(mark.diamond, 2));
    let [ahead, behind] = line_of_aim(app.table(), app.layout(), shot.cue.phi).map(mark);
    format!("{hit}; aim from {behind} to {ahead} diamonds")
}

/// Where the selected ball lies, how far the nearest other one is, and how far a key moves it.
fn selected_ball(app: &App) -> String {
    let (ball, balls, names) = (app.selected(), app.layout().balls, app.cue_ball().names());
    let others = (0..BALLS).filter(|&other| other != ball);
    let gap = |other: usize| (balls[ball].distance(balls[other]) - 2.0 * app.table().radius).max(0.0);
    let nearest = others.min_by(|&one, &two| gap(one).total_cmp(&gap(two)));
    let near = nearest.map_or(String::new(), |other| format!(", {} mm from {}", millimetres(gap(other)), names[other]));
    let (x, y) = (millimetres(balls[ball].x), millimetres(balls[ball].y));
    format!("{} at x {x} mm, y {y} mm{near}; step {}", names[ball], step_words(app.step_mm()))
}
