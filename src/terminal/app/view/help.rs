//! Overlays over a screen: the help, generated from the key tables, with notes on what is drawn; the list of all refusals and failures so
//! far; and the glossary.

use ratatui::{
    layout::Rect,
    text::{Line, Span},
};

use crate::{
    learning::run::quantity::Quantity,
    terminal::{
        App, DrillContext, KeyContext, Overlay,
        app::{bindings::listed, view::glossary},
        keymap::{Section, keys_text},
        pages::PageArea,
        ui::{Ui, wrap},
    },
};

/// Columns of the keys.
const KEYS: usize = 22;

/// Notes of each page; each entry is a paragraph.
const COACH_NOTES: [&str; 6] = [
    "Positions are measured from the centre of the table, x to the right, y up; diamonds from the lower left corner, 0 to 8 along \
     the long rails and 0 to 4 up the short ones, as the corners say. 1, 2, 3 on the rails are the cue ball's cushions. A kiss is \
     an unwanted collision; its percentage says in how many strokes it spoils the point. The dots are the predicted paths; rings are \
     where the cue ball first meets each ball and where the balls stop. While a shot plays, a ball trails bright dots for 0.4 s; \
     older dots are pale. On a small screen the balls are drawn larger than they are; they roll and touch at their true size.",
    "Chances are those of the player in the first row, from attempts that took no part in the choice, with their 95 % \
     interval. Shots that are made less than half as often as the best are not listed.",
    "Margins: how far one input may be off while the others are exact, next to the player's standard errors. The maps show \
     the outcome of the stroke over two inputs, left and right as the shooter sees them; the ring is twice the standard \
     errors.",
    "The plan: dots show where the balls stop in those of 100 attempts that make the point, and the cue ball's path in the \
     next shot, if both are played exactly.",
    "Tip: the cue ball from behind the cue; in its grey part the tip would slip off. Side and height are counted in tips, a tenth \
     of the ball's radius each, 3 mm: three tips of left at 10 o'clock is 9 mm left of the centre and somewhat above it. Running side \
     makes the path off the first cushion longer, reverse side shorter. Table lengths: how far a ball would run if struck at this \
     speed in the centre; once up the table and back is two. Hit: the first object ball as seen from the cue ball, and how much of it \
     the cue ball covers. Spin, while a shot plays: the cue ball from behind along its path, with the point where a level cue would \
     have to hit it to give it its present spin and speed; for a rolling ball that is two fifths above the centre.",
    "a, b are in ball radii, V0 and w0 what the stroke gives the ball: (x, y) and (x, y, z).",
];

const SETTINGS_NOTES: [&str; 3] = [
    "Changes take effect at once and are saved in the file named above; its comments, order and unknown keys stay. What another \
     program changes there is read and never overwritten.",
    "A setting without a mark has its default. carom config prints all settings, with their meanings and accepted values.",
    "A key of your own works like the key that you choose for it, on every page. Questions are always answered by y and n.",
];

const TRAINING_NOTES: [&str; 4] = [
    "Training runs in its own process: it needs neither this screen nor this terminal.",
    "Held-out figures are for the agent's own choice on layouts that it has not trained on, with Wilson's 95 % interval. \
     Shots of a running training are replayed once, as they were measured.",
    "A chart shows the smallest and largest value where many lines share a column, so that no peak is lost; non-finite \
     values are gaps. Smoothing is over shots, and never looks ahead.",
    "The quantities and their keys:",
];

const DRILL_NOTES: [&str; 5] = [
    "The line is the cue ball's way, with what side and a raised cue do to it, to the first ball or cushion, at the ring. \
     It tells nothing of what comes after. A ball is hit 100 % full head-on, 0 % where it is only grazed.",
    "Strokes are played with the errors of the player who is named above. How often a stroke makes the point is from 1000 \
     simulated strokes of that player.",
    "An attempt for which the hint was shown counts like any other; the score tells how many there were.",
    "Grades go from 1, the easiest, to 5. Typical is how often a beginner, a club player and a world-class player make the model shot. \
     An average is points an inning, and each miss ends an inning.",
    "Notes from a real table measure your skill if you play the model shot. Every attempt is saved before it is shown.",
];

const FILM_NOTES: [&str; 3] = [
    "Every second shot of a match, filmed at 50 pictures a second; the places are those of github.com/erdo100/3cushiontool \
     (Apache-2.0). The full balls and the paths are the simulation's, the outlines, or small letters, the film's: where they \
     agree, the ball hides its outline.",
    "The stroke is fitted to the cue ball's first 2 s. All that comes later is predicted, and all that the object balls do.",
    "The cue ball is drawn white, the other player's yellow. Whether a shot is a point, and how fast it is, is what the film \
     shows. The tip is where a level cue would have met the ball to give it what was fitted.",
];

const CALIBRATION_NOTES: [&str; 5] = [
    "You stand on the left. Places are in diamonds: along the table from your own short rail (0) to the far one (8), across it \
     from the long rail on your right, below (0), to that on your left (4). The rubber's edge counts, not the wood.",
    "The dots are the way that the stroke would take on the table as it is known so far, the numbered rings where the marks are \
     expected. Yours may be elsewhere: how hard you really struck is worked out from them.",
    "A number is a place by eye, right to 0.1 diamonds; 725 mm is one by tape, right to 5 mm; 5.3 ~ 0.2 says how sure you are. \
     Nothing, or -, stands for what you do not know.",
    "Bits say how much one more stroke of a test should teach: each bit halves an uncertainty. The second number of a value is one standard deviation.",
    "Every entry is on the disk at once, in the file that carom calibrate goes on with as well. Both may be open at the same time.",
];

/// Notes of the help in the context `place`.
fn notes(place: KeyContext) -> Vec<String> {
    let notes: &[&str] = match place {
        KeyContext::Coach | KeyContext::OwnStroke | KeyContext::Follow => &COACH_NOTES,
        KeyContext::Drill(DrillContext::Films | DrillContext::Film) => &FILM_NOTES,
        KeyContext::Drill(_) => &DRILL_NOTES,
        KeyContext::Calibration(_) => &CALIBRATION_NOTES,
        KeyContext::Settings(_) => &SETTINGS_NOTES,
        _ => {
            let quantities: Vec<_> =
                Quantity::ALL.iter().enumerate().map(|(n, one)| format!("{} {}", n + 1, one.name())).collect();
            let rows = quantities.chunks(4).map(|row| row.join(", "));
            return TRAINING_NOTES.map(str::to_owned).into_iter().chain(rows).collect();
        }
    };
    notes.iter().map(ToString::to_string).collect()
}

/// Draws the overlay `what`, scrolled to line `top`. Returns the first row below its text.
pub fn draw(app: &App, what: Overlay, top: usize, parts: &PageArea, ui: &mut Ui) -> u16 {
    let (page, lines) = (page(parts.screen), lines(app, what, parts.screen));
    let last = lines.len().saturating_sub(usize::from(page.height));
    let first = top.min(last);
    for (line, row) in lines[first..].iter().zip(page.y..page.bottom()) {
        ui.buffer.set_line(page.x, row, line, page.width);
    }
    let hidden = last - first;
    if hidden > 0 {
        let more = format!("{hidden} more lines below");
        ui.buffer.set_string(page.x, page.bottom(), more, ui.theme.faint());
    }
    page.bottom()
}

/// The topmost line when the overlay is scrolled to its end.
pub fn end(app: &App, what: Overlay, area: Rect) -> usize {
    lines(app, what, area).len().saturating_sub(usize::from(page(area).height))
}

/// The part of the screen that shows the lines.
const fn page(area: Rect) -> Rect {
    Rect::new(area.x + 2, area.y + 2, area.width.saturating_sub(4), area.height.saturating_sub(4))
}

fn lines(app: &App, what: Overlay, area: Rect) -> Vec<Line<'static>> {
    let width = usize::from(page(area).width);
    match what {
        Overlay::Help => help(app, width),
        Overlay::Messages => messages(app, width),
        Overlay::Glossary => glossary::lines(app, width),
    }
}

/// All refusals and failures so far, the newest first.
fn messages(app: &App, width: usize) -> Vec<Line<'static>> {
    let (theme, caps) = (app.theme(), app.caps);
    let mut lines = vec![Line::styled("Messages, the newest first", theme.good()), Line::default()];
    if app.toasts.messages().len() == 0 {
        lines.push(Line::styled("No messages so far.", theme.text()));
    }
    for text in app.toasts.messages() {
        for (n, line) in wrap(text, width.saturating_sub(2)).into_iter().enumerate() {
            let mark = if n == 0 { caps.pick("•", "-") } else { " " };
            lines.push(Line::from(vec![
                Span::styled(format!("{mark} "), theme.warning()),
                Span::styled(line, theme.text()),
            ]));
        }
    }
    lines.push(Line::default());
    let log = format!("With their times, and from earlier sessions too: {}", app.training.places.log.display());
    lines.extend(wrap(&log, width).into_iter().map(|line| Line::styled(line, theme.faint())));
    lines
}

fn help(app: &App, width: usize) -> Vec<Line<'static>> {
    let (theme, caps) = (app.theme(), app.caps);
    let (mut lines, all) = (Vec::new(), listed(app.key_context()).collect::<Vec<_>>());
    for (section, title) in Section::ALL {
        let own: Vec<_> = all.iter().filter(|binding| binding.section == section).collect();
        if own.is_empty() {
            continue;
        }
        lines.push(Line::styled(title, theme.good()));
        for binding in own {
            let keys = keys_text(binding.keys.iter().flat_map(|(chord, ..)| app.keys().keys_for(*chord)), caps);
            let keys = wrap(&keys, KEYS - 1);
            let words = wrap(binding.description, width.saturating_sub(KEYS + 2));
            for n in 0..keys.len().max(words.len()) {
                let line = |column: &[String]| column.get(n).cloned().unwrap_or_default();
                lines.push(Line::from(vec![
                    Span::styled(format!("  {:<KEYS$}", line(&keys)), theme.accent()),
                    Span::styled(line(&words), theme.text()),
                ]));
            }
        }
        lines.push(Line::default());
    }
    lines.push(Line::styled("What is drawn", theme.good()));
    let notes = notes(app.key_context()).into_iter().flat_map(|note| wrap(&note, width.saturating_sub(2)));
    lines.extend(notes.map(|note| Line::styled(format!("  {note}"), theme.text())));
    lines
}
