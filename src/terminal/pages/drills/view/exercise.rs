//! The screen of an exercise: the table with the aim line or the shot, the stroke, and the score.

use glam::DVec2;
use ratatui::layout::Rect;

use crate::{
    coach::words::{LengthUnit, TipUnit},
    terminal::{
        Capabilities, Shot,
        pages::drills::{
            AimLine, DrillsPage, ModelShotState, Turn,
            view::{draw_header, panels, panes::Panes, score},
        },
        ui::{
            Message, Spot, TableView, Theme, Ui, cue_sign, draw_hit_panel, draw_profile, draw_spin_or_hit, draw_table,
            draw_tip, draw_titled_tip, draw_what_if, separator,
        },
        words::others_skill_word,
    },
};

/// Distance between the dots of the aim line, m. It is half that of a path's dots, so that the dots look like a line.
const AIM_DOT_SPACING: f64 = 0.04;
/// The cue behind the ball, m: distances of its start and end from the ball's centre, and the distance between its dots.
const CUE: (f64, f64) = (0.09, 0.5);
const CUE_DOT: f64 = 0.008;

/// Draws the screen. Returns the default text of the status line.
pub fn draw(drills: &DrillsPage, turn: &Turn, header: Rect, area: Rect, ui: &mut Ui) -> Message {
    draw_header(drills, &turn.exercise.title, &subtitle(turn, ui.caps), header, ui);
    let profile = turn.profile();
    let panes = Panes::new(&turn.table, area);
    let (panes, side) = if profile.is_some() { panes.with_side_view() } else { (panes, Rect::ZERO) };
    let what_if = turn.what_if();
    let aim_line = turn.aim_line();
    let spots = match (what_if, turn.shown_model(), &aim_line) {
        // A comparison draws the whole path of the stroke, and a displayed model shot its own path.
        (Some(_), ..) | (None, None, None) => Vec::new(),
        (None, Some(model_shot), _) => cue_spots(turn, model_shot.advice.cue.phi, ui.theme, ui.caps),
        (None, None, Some(aim_line)) => {
            let cue = cue_spots(turn, turn.stroke().phi, ui.theme, ui.caps);
            cue.into_iter().chain(aim_line_spots(turn, aim_line, ui.theme, ui.caps)).collect()
        }
    };
    let time = turn.watched().filter(|_| !turn.shows_hint).map_or(0.0, |watched| watched.playback.time);
    let view = TableView {
        shot: turn.shot(),
        other: what_if.and_then(|what_if| what_if.coach.as_deref()),
        other_name: turn.model_shot().map_or("", panels::advisor),
        time,
        spots: &spots,
        ..TableView::new(&turn.table, &turn.layout)
    };
    draw_table(&view, panes.table, ui);
    if let Some(profile) = profile {
        let playing = turn.watched().filter(|_| !turn.shows_hint).map(|watched| watched.playback.time);
        draw_profile(profile, playing, drills.units.length, side, ui);
    }
    if side.intersection(panes.stroke).is_empty() {
        draw_precision(drills, turn, aim_line.as_ref(), &panes, ui);
    }
    let free_row = score::draw(drills, turn, panes.score, ui);
    match what_if.zip(turn.model_shot()) {
        Some((what_if, model_shot)) => {
            let (advisor, made) = (panels::advisor(model_shot), Some(model_shot.advice.chance.rate));
            draw_what_if(what_if, advisor, made, drills.units, panes.aim, ui);
        }
        None => panels::draw_task(drills, turn, aim_line.as_ref(), panes.aim, (free_row, panes.score.right()), ui),
    }
    status_line(turn, drills.units.length)
}

/// Draws the stroke's numbers, the tip on the cue ball, and the hit or the spin. While the model shot is shown, tip and hit are those
/// of the model shot.
fn draw_precision(drills: &DrillsPage, turn: &Turn, aim_line: Option<&AimLine>, panes: &Panes, ui: &mut Ui) {
    panels::draw_stroke(turn, drills.units, drills.is_in_numbers, panes.stroke, ui);
    if let Some(model_shot) = turn.shown_model() {
        let whose = if model_shot.is_own { "Model" } else { "Coach" };
        let cue = Some(&model_shot.advice.cue);
        draw_titled_tip(format!("{whose} tip"), cue, &turn.table, panes.tip, ui);
        draw_hit_panel(Some(whose), Some(model_shot.shot.first_impact()), panes.hit, ui);
        return;
    }
    let meant = turn.watched().map_or(turn.stroke(), |watched| &watched.intended);
    draw_tip(
        Some(meant).filter(|_| !turn.is_coach_thinking()),
        drills.units.tip == TipUnit::Tips,
        &turn.table,
        panes.tip,
        ui,
    );
    let watched = turn.watched().filter(|_| !turn.shows_hint);
    let spin = watched.and_then(|watched| turn.shot()?.spin(watched.playback.readout, turn.table.radius));
    let meeting = aim_line.map(|line| line.meeting).or_else(|| turn.shot().map(Shot::first_impact));
    draw_spin_or_hit(spin, meeting, panes.hit, ui);
}

/// Whether the repetitions are shifted, the coach's level if it was chosen, and the grade of an exercise that is not played as a game.
fn subtitle(turn: &Turn, caps: Capabilities) -> String {
    let grade = turn.exercise.grade;
    // The last parts are left out where there is no room.
    let mut parts = if turn.session.shifted { vec!["shifted".to_owned()] } else { Vec::new() };
    parts.extend(turn.session.coach_skill.map(|level| format!("coach: {}", others_skill_word(level))));
    parts.extend((grade > 0 && !turn.session.is_game()).then(|| format!("grade {grade}")));
    parts.join(separator(caps))
}

/// Whether a spot is on the table's bed.
fn is_on_cloth(turn: &Turn, spot: &Spot) -> bool {
    spot.position.abs().cmple(turn.table.reach() + DVec2::splat(turn.table.radius)).all()
}

/// The part of the cue behind the ball that is above the table's bed.
fn cue_spots(turn: &Turn, phi: f64, theme: &Theme, caps: Capabilities) -> Vec<Spot> {
    let (start, ahead) = (turn.layout.balls[0], DVec2::from_angle(phi));
    let letter = cue_sign(ahead, caps);
    let back = (0..).map(|n| CUE.0 + CUE_DOT * f64::from(n)).take_while(|back| *back <= CUE.1);
    let spot = |back: f64| Spot { position: start - back * ahead, is_ball: false, color: theme.cue, letter };
    back.map(spot).filter(|spot| is_on_cloth(turn, spot)).collect()
}

/// The dots of the aim line, with the ball at its end.
fn aim_line_spots(turn: &Turn, aim_line: &AimLine, theme: &Theme, caps: Capabilities) -> Vec<Spot> {
    let (color, letter) = (theme.paths[0], caps.pick('·', '.'));
    // The ball at the end would cover the last dots.
    let dots = aim_line.dots(AIM_DOT_SPACING, 1.5 * turn.table.radius).into_iter();
    let ghost = theme.letters()[0].to_ascii_lowercase();
    let ghost = aim_line.points.last().map(|place| Spot { position: *place, is_ball: true, color, letter: ghost });
    let dots = dots.map(|place| Spot { position: place, is_ball: false, color, letter });
    dots.chain(ghost).filter(|spot| is_on_cloth(turn, spot)).collect()
}

fn status_line(turn: &Turn, unit: LengthUnit) -> Message {
    if turn.is_waiting() {
        return Message::plain("the stroke is being played");
    }
    if let Some(verdict) = turn.verdict(unit) {
        return verdict;
    }
    if let Some(level) = turn.session.coach_skill.filter(|_| turn.is_coachs_turn() && turn.model_shot().is_some()) {
        return Message::plain(format!(
            "the coach's stroke (it plays as {}); Space plays it",
            others_skill_word(level)
        ));
    }
    if let Some(watched) = turn.watched() {
        let speed = match watched.playback.speed() {
            1.0 => String::new(),
            speed => format!(" at {speed} times its speed"),
        };
        return Message::plain(if watched.playback.playing {
            format!("the shot is running{speed}; Enter skips to its end")
        } else {
            format!("the shot is paused{speed}; Space goes on, Enter skips to its end")
        });
    }
    Message::plain(match &turn.model_shot {
        ModelShotState::Pending if turn.is_coachs_turn() => "the coach is thinking about its stroke",
        ModelShotState::Missing if turn.is_coachs_turn() => {
            "the coach knows no stroke here; Space plays full at a ball"
        }
        _ if turn.is_coachs_turn() => "the coach's stroke, with errors as large as yours; Space plays it",
        ModelShotState::Pending => "set the stroke and play it; the coach is still thinking",
        ModelShotState::Missing => "set the stroke and play it; the coach has found no shot here",
        ModelShotState::Known(_) if turn.what_if().is_some() => {
            "what if: change your stroke; the attempt counts as one with a hint"
        }
        ModelShotState::Known(model_shot) if turn.shows_hint && model_shot.is_own => {
            "this is the model shot; the attempt counts as one with a hint"
        }
        ModelShotState::Known(_) if turn.shows_hint => {
            "this is the coach's shot; the attempt counts as one with a hint"
        }
        ModelShotState::Known(_) if turn.session.is_exam() || turn.session.is_match() => "set the stroke and play it",
        ModelShotState::Known(_) => "set the stroke and play it; at a real table: m made, n missed",
    })
}
