//! The view of the coach page: the table, the coach's advice, and the playback of the shot.

mod balls;
mod card;
mod chances;
mod header;
mod lesson;
mod maps;
mod margins;
mod own_stroke;
mod panes;
mod plan;
mod query;
mod shot;
mod words;

use glam::DVec2;
use ratatui::layout::{Margin, Position, Rect};

use crate::{
    coach::{systems::Guide, words::TipUnit},
    table::{BALLS, Layout},
    terminal::{
        AdviceState, Capabilities, InfoPanel, Mapping, Mode, Shot,
        pages::{
            OpenQuestion, PageArea, PageView, Target,
            coach::{
                CoachPage, FollowedPlayer,
                view::{
                    balls::draw_balls,
                    card::draw_card,
                    chances::{choice_at, draw_chances, draw_why, why_line},
                    header::draw_header,
                    lesson::{draw_lesson, draw_numbers, lesson_spots},
                    maps::{draw_aim_map, draw_legend, draw_tip_map},
                    margins::draw_margins,
                    own_stroke::{COACH, draw_own_stroke},
                    panes::Panes,
                    plan::{FAILED, draw_plan, plan_spots},
                    query::draw_query,
                    shot::{draw_proposal, draw_shot},
                    words::draw_shot_words,
                },
            },
        },
        shot::playback::passed_count,
        ui::{
            Message, TableView, Ui, columns, draw_events, draw_profile, draw_spin_or_hit, draw_table, draw_tip,
            to_displayable, write_paragraphs,
        },
        words::{event_words, fixed, format_fine, percent},
    },
};

/// Positions of hidden balls, m: far enough from the table that nothing of them is drawn on it.
const OFF_TABLE: [DVec2; BALLS] = [DVec2::splat(1e3), DVec2::new(1e3, -1e3), DVec2::new(-1e3, 1e3)];

impl PageView for CoachPage {
    fn draw(&self, area: &PageArea, ui: &mut Ui) -> Message {
        draw_header(self, area.header, ui);
        if let Some(words) = self.followed().and_then(FollowedPlayer::empty_reason) {
            let [style, place] = [ui.theme.text(), ui.theme.faint()];
            let hint = "q ends it.".to_owned();
            write_paragraphs(&[(words, style), (hint, place)], area.body.inner(Margin::new(2, 2)), ui);
            return Message::plain("");
        }
        let profile = self.profile();
        let (panes, side) = panes(self, area.screen);
        let choice = self.displayed_advice().map(AdviceState::choice);
        let planned = choice.filter(|_| self.info == InfoPanel::Plan && self.what_if().is_none());
        let mut spots = planned.map_or_else(Vec::new, |choice| plan_spots(choice, ui.theme));
        let lesson = self.lesson.as_ref();
        if let Some(lesson) = lesson {
            spots = lesson_spots(lesson, ui.mark());
        }
        // The lesson's example is not about the balls on the table.
        let is_example = lesson.is_some_and(|lesson| !lesson.is_of_shot);
        let nowhere = Layout::new(OFF_TABLE);
        let kiss = kiss_note(self);
        let view = TableView {
            shot: self.shot().map(AsRef::as_ref).filter(|_| !is_example),
            time: self.playback.time,
            is_moving: self.mode == Mode::Watching || is_example,
            front: self.selected,
            other: self.what_if().and_then(|what_if| what_if.coach.as_deref()),
            other_name: COACH,
            // During a search each better shot would change the paths of all balls, which would flicker.
            cue_path_only: planned.is_some() || lesson.is_some() || self.spinner().is_some(),
            // A lesson writes the numbers of its system instead.
            is_numbered: lesson.is_none(),
            spots: &spots,
            note: kiss.as_ref().map(|(place, words)| (*place, words.as_str())),
            ..TableView::new(self.table(), if is_example { &nowhere } else { self.layout() })
        };
        draw_table(&view, panes.table, ui);
        if let Some(lesson) = lesson {
            draw_numbers(lesson, self.table(), &Mapping::fit(self.table(), panes.table), ui);
        }
        let says_why = draw_panels(self, &panes, ui);
        if let Some(profile) = profile {
            let time = self.watched().map(|_| self.playback.time);
            draw_profile(profile, time, self.units.length, side, ui);
        }
        let room = usize::from(area.status.width.saturating_sub(2));
        // A message with the success rate alone repeats the panel above, so the explanation of the ranking replaces it if no panel shows
        // that.
        let message = self.message.clone().filter(|message| {
            says_why || !self.is_only_success_rate(message) || ranking_line(self, room, ui).is_none()
        });
        let message = message.unwrap_or_else(|| status_line(self, says_why, room, ui));
        self.with_sharing_prefix(message)
    }

    fn open_question(&self, _: Capabilities) -> Option<OpenQuestion<'_>> {
        let question = self.question.as_ref()?;
        let words = question.text(self.cue_ball().names(), self.selected);
        Some(OpenQuestion::new(self.message.as_ref(), &words, question.field()))
    }

    fn target(&self, area: &PageArea, at: Position) -> Option<Target> {
        if self.followed().is_some() {
            return None;
        }
        let area = area.screen;
        let mapping = table_mapping(self, area);
        if mapping.bed.contains(at) {
            return Some(Target::Table(mapping));
        }
        let (panes, side) = panes(self, area);
        if side.contains(at) {
            return None;
        }
        let (_, chances) = info_panels(self.info, &panes).find(|(panel, _)| *panel == InfoPanel::Chances)?;
        let advised = self.displayed_advice().filter(|_| chances.contains(at) && self.what_if().is_none())?;
        choice_at(advised, chances, at.y).map(Target::Shot)
    }
}

/// Position and label of the kiss that spoils the most strokes, with its share of them. Shown before the first proposed shot is played.
fn kiss_note(coach: &CoachPage) -> Option<(DVec2, String)> {
    let advised = coach.displayed_advice().filter(|advised| advised.chosen == 0 && coach.what_if().is_none());
    let kiss =
        advised.filter(|_| coach.described_shot().is_some() && coach.info == InfoPanel::Shot)?.why.as_ref()?.kiss?;
    let names = coach.cue_ball().names();
    let balls = match kiss.balls {
        [0, other] | [other, 0] => format!("kiss with {}", names[other]),
        [one, other] => format!("{} and {} kiss", names[one], names[other]),
    };
    Some((kiss.place, format!("{balls} {} %", percent(kiss.share))))
}

/// The areas of the screen, and the area of the jump's side view, which is empty if there is none.
fn panes(coach: &CoachPage, area: Rect) -> (Panes, Rect) {
    let panes = Panes::new(coach.table(), area);
    if coach.profile().is_some() { panes.with_side_view() } else { (panes, Rect::ZERO) }
}

/// Draws the panels: the chosen info panel, then others if there is room. With the margins, the maps replace shot, tip and events.
/// Returns whether one of the panels explains why the first shot ranks first.
fn draw_panels(coach: &CoachPage, panes: &Panes, ui: &mut Ui) -> bool {
    let (table, shot) = (coach.table(), coach.shot().map(AsRef::as_ref));
    let chosen = coach.panel();
    if let Some(what_if) = coach.what_if() {
        draw_own_stroke(coach, what_if, panes, ui);
        return false;
    }
    let described = coach.described_shot().filter(|_| chosen == InfoPanel::Shot);
    let is_beside = panes.is_beside();
    // Before the stroke, the description also uses the room of panels that matter only later or repeat it.
    let is_wide = !is_beside && !coach.is_in_numbers;
    let shot_explains_why = described.is_some_and(|described| {
        let area = match () {
            () if is_beside => panes.info.union(panes.events),
            () if is_wide => panes.info.union(panes.shot),
            () => panes.info,
        };
        draw_shot_words(coach, described, area, ui)
    });
    let explained = coach
        .displayed_advice()
        .filter(|_| is_beside && chosen == InfoPanel::Chances && coach.described_shot().is_some());
    let is_explained = explained.is_some_and(|advised| draw_why(advised, panes.events, ui));
    // If all panels are below the table, the panel "Chances" is among them and shows the explanation.
    let says_why = shot_explains_why || is_explained || !is_beside;
    for (panel, area) in info_panels(chosen, panes) {
        match coach.lesson.as_ref().filter(|_| panel == chosen) {
            Some(lesson) => draw_lesson(lesson, coach.has_no_system(), area, ui),
            None if described.is_some() && panel == chosen => {}
            None => draw_info(coach, panel, !shot_explains_why && !is_explained, area, ui),
        }
    }
    if let (InfoPanel::Margins, Some(advised), Some(shot)) = (chosen, coach.displayed_advice(), shot)
        && let Some(study) = &advised.choice().study
    {
        let unit = coach.units.length;
        draw_aim_map(&study.aim, study.hand, (unit, coach.is_in_numbers), panes.shot, ui);
        draw_tip_map(&study.tip, &shot.cue, table, unit, panes.tip.union(panes.hit), ui);
        draw_legend([&study.aim, &study.tip], advised.query.rule, panes.events, ui);
        return says_why;
    }
    let told_in = (table, coach.units.length);
    match coach.proposal() {
        Some(_) if described.is_some() && is_wide => {}
        Some(proposal) if coach.is_in_numbers => draw_proposal(proposal, told_in, coach.layout(), panes.shot, ui),
        Some(proposal) => draw_card(proposal, coach, panes.shot, ui),
        None if coach.followed().is_some() => draw_shot(None, &["no shot yet"], told_in, panes.shot, ui),
        None => draw_shot(None, &["no shot yet", "Enter asks", "the coach"], told_in, panes.shot, ui),
    }
    let how_long = shot.is_some() && !coach.is_in_numbers && coach.units.tip == TipUnit::Tips;
    draw_tip(shot.map(|shot| &shot.cue), how_long, table, panes.tip, ui);
    let time = coach.watched().map(|_| coach.playback.readout);
    let spin = shot.zip(time).and_then(|(shot, time)| shot.spin(time, table.radius));
    draw_spin_or_hit(spin, shot.map(Shot::first_impact), panes.hit, ui);
    match () {
        () if described.is_some() && is_beside || is_explained => {}
        () if shot.is_none() && coach.followed().is_none() => draw_query(coach, panes.events, ui),
        () => draw_listed(coach, shot, time, panes.events, ui),
    }
    says_why
}

/// Draws the list of the shot's events or contacts.
fn draw_listed(coach: &CoachPage, shot: Option<&Shot>, time: Option<f64>, area: Rect, ui: &mut Ui) {
    let events = shot.map(|shot| coach.events(shot));
    let name = if coach.has_all_events { "Events" } else { "Contacts" };
    let listed = shot.map(|shot| &shot.recording).zip(events.as_deref());
    draw_events(name, listed, time, coach.units.length, area, ui);
}

/// The chosen info panel and the others that fit, each with its area.
fn info_panels(chosen: InfoPanel, panes: &Panes) -> impl Iterator<Item = (InfoPanel, Rect)> {
    let others =
        [InfoPanel::Chances, InfoPanel::Margins, InfoPanel::Plan].into_iter().filter(move |panel| *panel != chosen);
    std::iter::once((chosen, panes.info)).chain(others.zip(panes.more).filter(|(_, area)| !area.is_empty()))
}

/// The mapping between the table and the screen cells.
pub fn table_mapping(coach: &CoachPage, area: Rect) -> Mapping {
    Mapping::fit(coach.table(), panes(coach, area).0.table)
}

/// Draws one of the info panels. `says_why` lets the panel "Chances" explain why the first shot ranks first.
fn draw_info(coach: &CoachPage, panel: InfoPanel, says_why: bool, area: Rect, ui: &mut Ui) {
    let advised = coach.displayed_advice();
    let is_followed = coach.followed().is_some();
    let choice = advised.map(AdviceState::choice);
    let empty = match (coach.spinner(), choice) {
        (Some(_), _) => "the coach is thinking",
        (None, Some(_)) if is_followed => "only the player sees this",
        (None, None) if is_followed => "no shot yet",
        (None, Some(choice)) if choice.is_analysed => FAILED,
        (None, Some(_)) => "being computed",
        (None, None) => "no shot yet; Enter asks the coach",
    };
    match panel {
        InfoPanel::Shot => draw_balls(coach, area, ui),
        InfoPanel::Chances => draw_chances(advised, empty, says_why, area, ui),
        InfoPanel::Margins => {
            let study = choice.and_then(|choice| choice.study.as_deref());
            let shot = choice.map(|choice| &*choice.proposal.shot);
            draw_margins(study.zip(shot), (coach.units.length, coach.is_in_numbers), empty, area, ui);
        }
        InfoPanel::Plan => draw_plan(choice.filter(|_| !is_followed), coach.units.length, empty, area, ui),
    }
}

/// Explanation of the ranking of the shot that is about to be played, for a row of `room` columns. `None` if the shot's description is not
/// displayed or nothing fits.
fn ranking_line(coach: &CoachPage, room: usize, ui: &Ui) -> Option<String> {
    let is_described = coach.info == InfoPanel::Shot && coach.what_if().is_none() && coach.described_shot().is_some();
    why_line(coach.displayed_advice().filter(|_| is_described)?, room, ui)
}

/// The text of the status line, `room` columns wide, if there is no message.
fn status_line(coach: &CoachPage, says_why: bool, room: usize, ui: &Ui) -> Message {
    if let Some(picture) = coach.spinner() {
        let pictures =
            ui.caps.pick(["⠋", "⠙", "⠹", "⠸", "⠼", "⠴", "⠦", "⠧"], ["|", "/", "-", "\\", "|", "/", "-", "\\"]);
        let so_far = coach.proposal().filter(|proposal| proposal.is_early).and_then(|proposal| proposal.made);
        let words = so_far.map_or("the coach is thinking; Esc stops it".to_owned(), |made| {
            format!("so far a shot of about {} %, not judged yet; Esc takes it", percent(made.rate))
        });
        return Message::plain(format!("{} {words}", pictures[picture % pictures.len()]));
    }
    if let Some(doing) = coach.followed().and_then(FollowedPlayer::activity_words) {
        return Message::plain(doing);
    }
    // For the player's own stroke its panel shows the result already.
    if let Some(verdict) = coach.verdict().filter(|_| coach.what_if().is_none()) {
        let words = verdict.words(coach.cue_ball(), coach.units.length);
        return if verdict.is_made() { Message::good(words) } else { Message::poor(words) };
    }
    Message::plain(match coach.watched() {
        Some(shot) if coach.playback.time == 0.0 => {
            let why = ranking_line(coach, room, ui).filter(|_| !says_why && coach.guide().is_none());
            why.unwrap_or_else(|| aim_words(coach, shot, room, ui))
        }
        Some(shot) => {
            let (events, time) = (coach.events(shot), coach.playback.readout);
            match events.get(passed_count(&events, time)) {
                Some(next) => {
                    format!("next: {} in {} s", event_words(next.kind, coach.cue_ball()), fixed(next.time - time, 1))
                }
                None if time >= shot.recording.duration() => "all balls lie still".to_owned(),
                None => "no more contacts: the balls roll out".to_owned(),
            }
        }
        None => selected_ball(coach),
    })
}

/// The line of aim and the numbers of the shot's diamond system, as much as fits into a row. The numbers have priority, since the panel
/// above shows the line of aim too. During the example of another system it is the line of aim alone.
fn aim_words(coach: &CoachPage, shot: &Shot, room: usize, ui: &Ui) -> String {
    let aim = to_displayable(&shot.words.aim(coach.units), ui.caps);
    // "nose to nose" is written because diamond systems count on the wood behind the noses.
    let at_noses = format!("{}, nose to nose.", aim.trim_end_matches('.'));
    let alone = if columns(&at_noses) <= room { at_noses.clone() } else { aim.clone() };
    let is_counted = coach.what_if().is_none() && coach.lesson.as_ref().is_none_or(|lesson| lesson.is_of_shot);
    let Some(guide) = coach.guide().filter(|_| is_counted) else { return alone };
    let named = guide.shot_words();
    // The result of the sum is the point of aim, so it need not be repeated.
    let brief = match guide {
        Guide::System(applied) => named.replacen(&format!(", aim at {}", applied.aim()), "", 1),
        Guide::Shift(_) => guide.to_string(),
    };
    let tries = [format!("{at_noses} {named}"), format!("{aim} {named}"), named, brief, guide.to_string()];
    let fits = tries.into_iter().find(|words| columns(words) <= room);
    fits.unwrap_or(alone)
}

/// The position of the selected ball, the gap to the nearest other ball, and the step size.
fn selected_ball(coach: &CoachPage) -> String {
    let (ball, balls, names) = (coach.selected, coach.layout().balls, coach.cue_ball().names());
    let others = (0..BALLS).filter(|&other| other != ball);
    let gap = |other: usize| (balls[ball].distance(balls[other]) - 2.0 * coach.table().radius).max(0.0);
    let nearest = others.min_by(|&one, &two| gap(one).total_cmp(&gap(two)));
    let unit = coach.units.length;
    let length = |metres: f64| format!("{} {}", format_fine(metres, unit), unit.fine().1);
    let near = nearest.map_or(String::new(), |other| format!(", {} from {}", length(gap(other)), names[other]));
    let place = if coach.quarters {
        let place = coach.table().to_diamonds(balls[ball]);
        format!("{}d,{}d", fixed(place.x, 2), fixed(place.y, 2))
    } else {
        format!("x {}, y {}", length(balls[ball].x), length(balls[ball].y))
    };
    format!("{} at {place}{near}; step {}", names[ball], coach.step_words())
}
