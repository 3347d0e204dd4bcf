//! Draws the pictures of the documentation and writes its table of keys: runs the real program without a terminal and writes its screens as
//! SVG.
//!
//! `cargo run --release --example picture -- docs/` writes the same bytes each time, except for the times of the training that it shows.
//! Another processor may round the networks' numbers differently and find another shot. File names after the folder restrict the output to
//! these files and those that are drawn together with them.

mod animation;
mod moving;
mod svg;
mod training;

use std::{env, error::Error, fs, path::Path};

use carom::{
    simulation::EventKind,
    table::{Layout, Table},
    terminal::{App, Capabilities, CoachEvent, CoachWorker, Depth, Effect, Glyphs, keys_document},
};
use crossterm::event::KeyCode::{self, Char, Enter};
use ratatui::{Terminal, backend::TestBackend};

const LOOK: Capabilities = Capabilities { depth: Depth::True, glyphs: Glyphs::Sextant, unicode: true };

/// The balls, in metres: from this layout the coach finds a shot with three cushions between the two hits.
const LAYOUT: &str = "-0.57,-0.43 -1.11,-0.3 0.39,0.66";
/// Number of simulations of the coach: a fixed number, so that it finds the same shot each time.
const SIMULATIONS: u64 = 300_000;
/// Seconds between the second hit and the picture: the balls have separated, and the hit is still displayed.
const AFTER_HIT: f64 = 0.06;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = env::args().skip(1);
    let directory = arguments.next().ok_or("say where to write the pictures: picture docs/ [coach-moving.svg ...]")?;
    let directory = Path::new(&directory);
    let names: Vec<String> = arguments.collect();
    let wanted = |all: &[&str]| names.is_empty() || names.iter().any(|name| all.contains(&name.as_str()));
    fs::create_dir_all(directory)?;
    let write = |name: &str, app: &App, width, height, title| -> Result<(), Box<dyn Error>> {
        let mut terminal = Terminal::new(TestBackend::new(width, height))?;
        terminal.draw(|frame| app.draw(frame))?;
        fs::write(directory.join(name), svg::picture(terminal.backend().buffer(), title))?;
        Ok(())
    };

    if wanted(&["keys.md"]) {
        fs::write(directory.join("keys.md"), keys_document())?;
    }
    if wanted(&["coach-moving.svg"]) {
        fs::write(directory.join("coach-moving.svg"), moving::picture(LOOK)?)?;
    }
    if wanted(&["coach-80x24.svg", "coach.svg", "help.svg"]) {
        let table = Table::default();
        let layout = Layout::parse(LAYOUT, &table)?;
        let mut app = App::new(table, layout, LOOK, 7)?;
        ask(&mut app)?;
        write("coach-80x24.svg", &app, 80, 24, "The coach recommends a shot, on a small terminal")?;
        play_to_the_point(&mut app)?;
        write("coach.svg", &app, 120, 40, "The coach plays the shot that it recommends")?;
        press(&mut app, Char('?'));
        write("help.svg", &app, 120, 40, "Every key of the coach")?;
    }
    if wanted(&["training-80x24.svg", "training.svg"]) {
        let app = training::screen(LOOK)?;
        write("training-80x24.svg", &app, 80, 24, "A run that trains, on a small terminal")?;
        write("training.svg", &app, 120, 40, "A run that trains: its charts, its numbers and its latest shots")?;
    }
    Ok(())
}

fn press(app: &mut App, key: KeyCode) -> Option<Effect> {
    app.handle(&key.into())
}

/// Asks the coach and shows the answer without its cost, which differs from run to run.
fn ask(app: &mut App) -> Result<(), Box<dyn Error>> {
    let question = press(app, Enter);
    answer(app, question, |_| {});
    if app.coach.shot().is_some_and(|shot| shot.solved) { Ok(()) } else { Err("the coach finds no point here".into()) }
}

/// Answers a request to the coach and all that follow from it; `heard` is called after every answer.
fn answer(app: &mut App, mut question: Option<Effect>, mut heard: impl FnMut(&mut App)) {
    let mut worker = CoachWorker::with_simulation_limit(SIMULATIONS);
    while let Some(Effect::AskCoach(job)) = question.take() {
        worker.answer(&job, |mut answer| {
            if let CoachEvent::Advice(advice) = &mut answer.event {
                advice.effort = None;
            }
            question = app.receive(answer).or(question.take());
            heard(app);
        });
    }
}

/// Plays until shortly after the cue ball has met both object balls.
fn play_to_the_point(app: &mut App) -> Result<(), Box<dyn Error>> {
    let shot = app.coach.shot().ok_or("there is no shot")?;
    let first_hit = |ball| {
        let hit = EventKind::BallBall(0, ball);
        shot.recording.events().iter().position(|event| event.kind == hit).ok_or("the shot misses a ball")
    };
    for _ in 0..=first_hit(1)?.max(first_hit(2)?) {
        press(app, Char('.'));
    }
    press(app, Char(' '));
    app.tick(AFTER_HIT);
    Ok(())
}
