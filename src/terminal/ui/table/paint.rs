//! Painting of the cloth: in sub-pixels, or in letters on terminals without them.

use glam::DVec2;
use ratatui::style::{Color, Modifier, Style};

use crate::{
    table::BALLS,
    terminal::{
        Glyphs,
        ui::{
            Canvas, Ink, Theme, Ui,
            table::picture::{Age, TablePicture},
        },
    },
};

/// Ball width in columns from which its letter gets brackets.
const BRACKET_COLUMNS: f64 = 2.0;
/// Characters of the balls' paths (white, yellow, red) and of their trails.
const DOTS: [char; BALLS] = ['·', '+', '×'];
const PLAIN_DOTS: [char; BALLS] = ['.', '+', 'x'];
const TRAIL: [char; 2] = ['•', '*'];
/// Characters of the second shot's path.
const OTHER: [char; 2] = ['=', '='];

/// Characters of a path in the air, and of the shadow of a ball in the air.
const ALOFT: char = '\'';
const SHADOW: [char; 2] = ['○', 'o'];

/// Weights of what shares a cell (see [`Ink`]).
const DOT_WEIGHT: u8 = 3;
const RING_WEIGHT: u8 = 4;
/// More than all other sub-pixels of a cell together: a ball stays whole, whatever shares its cells.
const BALL_WEIGHT: u8 = 32;

/// Draws the cloth with everything on it.
pub fn paint(picture: &TablePicture, ui: &mut Ui) {
    match ui.caps.glyphs {
        Glyphs::Letters => in_letters(picture, ui),
        _ => in_blocks(picture, ui),
    }
}

/// Colour of a path: a trail has its ball's colour, and the past path fades into the cloth.
fn path_color(theme: &Theme, ball: usize, age: Age) -> Color {
    match age {
        Age::Ahead => theme.paths[ball],
        Age::Trail => theme.balls[ball],
        Age::Past => theme.past_path(ball),
    }
}

fn in_blocks(picture: &TablePicture, ui: &mut Ui) {
    let (theme, glyphs, mapping) = (ui.theme, ui.caps.glyphs, &picture.mapping);
    let mut canvas = Canvas::new(mapping.bed, glyphs, theme.cloth);
    let (width, height) = canvas.size();
    let grid = DVec2::new(f64::from(width), f64::from(height))
        / DVec2::new(f64::from(mapping.bed.width), f64::from(mapping.bed.height));
    let dot = |canvas: &mut Canvas, place: DVec2, color: Color| {
        let at = (mapping.to_cells(place) * grid).floor();
        canvas.set(at.x as i32, at.y as i32, Ink { color, weight: DOT_WEIGHT });
    };
    let ring = |canvas: &mut Canvas, place: DVec2, color: Color| {
        picture.sprite.stamp_ring(canvas, mapping, place, Ink { color, weight: RING_WEIGHT });
    };
    for spot in picture.spots() {
        if spot.is_ball {
            ring(&mut canvas, spot.position, spot.color);
        } else {
            dot(&mut canvas, spot.position, spot.color);
        }
    }
    picture.each_other_dot(|place| dot(&mut canvas, place, theme.next_path));
    picture.each_dot(|ball, at, age| dot(&mut canvas, at.position, path_color(theme, ball, age)));
    picture.each_cue_dot(|place, _| dot(&mut canvas, place, theme.cue));
    for ghost in picture.ghosts() {
        ring(&mut canvas, ghost.position, path_color(theme, ghost.ball, ghost.age));
    }
    for (ball, place) in picture.view.film.into_iter().flatten().enumerate() {
        // A sprite too small for an outline is drawn in a paler colour instead.
        if picture.sprite.has_hole() {
            ring(&mut canvas, place, theme.balls[ball]);
        } else {
            let ink = Ink { color: theme.paths[ball], weight: RING_WEIGHT };
            picture.sprite.stamp(&mut canvas, mapping, place, ink);
        }
    }
    for ball in picture.order().filter(|ball| picture.heights[*ball] > 0.0) {
        let ink = Ink { color: theme.shadow(), weight: RING_WEIGHT };
        picture.sprite.stamp(&mut canvas, mapping, picture.balls[ball], ink);
    }
    let ink_of = |ball: usize| Ink { color: theme.balls[ball], weight: BALL_WEIGHT };
    if !picture.view.is_moving && picture.heights == [0.0; BALLS] {
        let balls: Vec<_> =
            picture.upwards().into_iter().rev().map(|ball| (picture.balls[ball], ink_of(ball))).collect();
        picture.sprite.stamp_at_rest(&mut canvas, mapping, &balls);
        return canvas.paint(ui.buffer);
    }
    for ball in picture.upwards() {
        let ink = ink_of(ball);
        let height = picture.heights[ball];
        let sprite = if height > 0.0 { picture.sprite.raised(height, mapping.radius, glyphs) } else { picture.sprite };
        sprite.stamp(&mut canvas, mapping, picture.lifted(ball), ink);
    }
    canvas.paint(ui.buffer);
}

fn in_letters(picture: &TablePicture, ui: &mut Ui) {
    let (theme, caps, mapping) = (ui.theme, ui.caps, &picture.mapping);
    ui.buffer.set_style(mapping.bed, Style::new().bg(theme.cloth));
    let mut put = |place: DVec2, symbol: char, color: Color| {
        let cell = &mut ui.buffer[mapping.to_cell(place)];
        cell.set_char(symbol).set_fg(color);
    };
    for spot in picture.spots() {
        put(spot.position, spot.letter, spot.color);
    }
    picture.each_other_dot(|place| put(place, caps.pick(OTHER[0], OTHER[1]), theme.next_path));
    let dots = theme.cue_ball.to_ball_order(caps.pick(DOTS, PLAIN_DOTS));
    let (letters, trail) = (theme.letters(), caps.pick(TRAIL[0], TRAIL[1]));
    picture.each_dot(|ball, dot, age| {
        let sign = match age {
            _ if dot.is_aloft() => ALOFT,
            Age::Trail => trail,
            _ => dots[ball],
        };
        put(dot.position, sign, path_color(theme, ball, age));
    });
    picture.each_cue_dot(|place, sign| put(place, sign, theme.cue));
    for ghost in picture.ghosts() {
        put(ghost.position, letters[ghost.ball].to_ascii_lowercase(), path_color(theme, ghost.ball, ghost.age));
    }
    for (ball, place) in picture.view.film.into_iter().flatten().enumerate() {
        put(place, letters[ball].to_ascii_lowercase(), theme.paths[ball]);
    }
    for ball in picture.order().filter(|ball| picture.heights[*ball] > 0.0) {
        put(picture.balls[ball], caps.pick(SHADOW[0], SHADOW[1]), theme.balls[ball]);
    }
    for ball in picture.upwards() {
        let (x, y) = mapping.to_cell(picture.lifted(ball));
        let wide = mapping.ball_columns() >= BRACKET_COLUMNS && x > mapping.bed.x && x + 1 < mapping.bed.right();
        let text = if wide { format!("({})", letters[ball]) } else { letters[ball].to_string() };
        let mut style = theme.ball_letter(ball).add_modifier(Modifier::BOLD);
        if !picture.view.is_moving && ball == picture.view.front {
            style = style.add_modifier(Modifier::REVERSED);
        }
        ui.buffer.set_stringn(x - u16::from(wide), y, &text, 3, style);
    }
}

#[cfg(test)]
mod tests {
    use ratatui::{buffer::Buffer, layout::Rect};

    use super::*;
    use crate::{
        physics::CueInputs,
        table::{Layout, Table},
        terminal::{
            Capabilities, Depth, Mapping, Shot, ThemeName,
            ui::{TableView, draw_table, drawn},
        },
    };

    const AREA: Rect = Rect::new(0, 0, 64, 17);

    /// The table at `time` of a shot on a table where balls can fly, with the shot and the mapping.
    fn flown(layout: &str, cue: &str, time: f64, caps: Capabilities) -> (Buffer, Shot, Mapping) {
        let table = Table::default();
        let layout = Layout::parse(layout, &table).unwrap();
        let shot = Shot::new(&table, &layout, CueInputs::parse(cue).unwrap(), false, "test").unwrap();
        let buffer = drawn(AREA, caps, |ui| {
            let view = TableView { shot: Some(&shot), time, ..TableView::new(&table, &layout) };
            draw_table(&view, AREA, ui);
        });
        (buffer, shot, Mapping::fit(&table, AREA))
    }

    const JUMP: (&str, &str) = ("-0.5,-0.2 0.9,0.4 1.2,0.5", "0,0,45,0,5");

    #[test]
    fn a_ball_in_the_air_stands_above_its_shadow_in_letters() {
        let (buffer, shot, mapping) = flown(JUMP.0, JUMP.1, 0.05, Capabilities::ASCII);
        assert!(shot.recording.height(0, 0.05) > 0.02);
        let (x, y) = mapping.to_cell(shot.recording.positions(0.05)[0]);
        assert_eq!((buffer[(x, y)].symbol(), buffer[(x, y - 1)].symbol()), ("o", "W"), "{buffer:?}");
        let aloft = shot.paths[0].iter().filter(|dot| dot.is_aloft()).count();
        let drawn = |sign: &str| buffer.content().iter().filter(|cell| cell.symbol() == sign).count();
        assert!(aloft > 8 && drawn("'") > 2 && drawn(".") > 0, "{aloft} {buffer:?}");
        let (before, _, mapping) = flown(JUMP.0, JUMP.1, 0.0, Capabilities::ASCII);
        assert_eq!(before[mapping.to_cell(DVec2::new(-0.5, -0.2))].symbol(), "W", "on the cloth");
    }

    #[test]
    fn a_ball_in_the_air_has_a_shadow_in_colours_and_a_larger_picture() {
        let count = |buffer: &Buffer, color: Color| {
            buffer.content().iter().filter(|cell| cell.fg == color || cell.bg == color).count()
        };
        let theme = Theme::new(Depth::True);
        let (lying, ..) = flown(JUMP.0, JUMP.1, 0.0, Capabilities::TRUE_COLOUR);
        let (flying, ..) = flown(JUMP.0, JUMP.1, 0.05, Capabilities::TRUE_COLOUR);
        assert_eq!(count(&lying, theme.shadow()), 0);
        assert!(count(&flying, theme.shadow()) > 0);
        assert!(count(&flying, theme.balls[0]) >= count(&lying, theme.balls[0]));
    }

    #[test]
    fn a_ball_off_the_table_is_not_drawn() {
        let has_white = |time| {
            let (buffer, shot, _) = flown("0.9,0 0,0.3 0,-0.3", "0,0,30,0,9", time, Capabilities::ASCII);
            assert_eq!(shot.recording.off_table(), [true, false, false]);
            buffer.content().iter().any(|cell| cell.symbol() == "W")
        };
        assert!(has_white(0.0) && !has_white(60.0));
    }

    #[test]
    fn future_trail_and_past_of_a_path_differ_in_every_theme() {
        for name in ThemeName::ALL.into_iter().filter(|name| *name != ThemeName::Mono) {
            for depth in [Depth::True, Depth::Indexed, Depth::Ansi] {
                let theme = Theme::of(name, depth);
                for ball in 0..BALLS {
                    let [ahead, trail, past] =
                        [Age::Ahead, Age::Trail, Age::Past].map(|age| path_color(&theme, ball, age));
                    let all = [ahead, trail, past, theme.cloth];
                    for (n, one) in all.iter().enumerate() {
                        assert!(!all[n + 1..].contains(one), "{name} {depth:?} ball {ball}: {all:?}");
                    }
                }
            }
        }
    }
}
