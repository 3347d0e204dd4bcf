//! Cost of the terminal program over a slow link: bytes, frames, writes, processor time, and the time from a key press to the resulting
//! picture. The tables are published in `docs/performance.md`.
//!
//! `cargo bench --bench terminal` takes four minutes, on Linux: processor times, writes and memory come from `/proc`. The machine should be
//! idle; the rows "beside two busy processes" create their own load.

mod pty;

use std::{
    process::{Child, Command},
    thread,
    time::{Duration, Instant},
};

use pty::{CAROM, Terminal, frames, part};

const SIZES: [(u16, u16); 3] = [(80, 24), (120, 40), (200, 60)];
/// The size for measurements at a single size.
const USUAL: (u16, u16) = (120, 40);
/// Number of starts with a timed first picture.
const STARTS: usize = 40;
/// Number of timed key presses.
const KEYS: usize = 150;
/// Time without output after which a task counts as complete.
const SILENCE: Duration = Duration::from_millis(1200);
const IDLE: Duration = Duration::from_secs(10);
/// Text on the first picture.
const OPENING: &str = "white at x -710.0 mm";

fn main() {
    println!("Binary: {:.1} MB.", std::fs::metadata(CAROM).map_or(0.0, |file| file.len() as f64 / 1e6));
    first_pictures();
    idle();
    playback();
    moments();
    answers();
}

fn size_words((columns, rows): (u16, u16)) -> String {
    format!("{columns}×{rows}")
}

fn heading(names: &[&str]) {
    println!("\n| {} |\n|{}", names.join(" | "), "---|".repeat(names.len()));
}

fn coach(size: (u16, u16)) -> Terminal {
    let mut terminal = Terminal::start(&[], size, "");
    terminal.wait_for(OPENING);
    terminal
}

fn milliseconds(time: Duration) -> f64 {
    time.as_secs_f64() * 1e3
}

/// Measures the bytes of the first picture, and the time from before the start of the process to its end.
fn first_pictures() {
    heading(&["first picture", "bytes", "ms, median", "worst", "memory, MB"]);
    for size in SIZES {
        let (mut times, mut bytes, mut memory) = (Vec::new(), 0, 0.0);
        for _ in 0..STARTS {
            let start = Instant::now();
            let mut terminal = Terminal::start(&[], size, "");
            let mut all = Vec::new();
            let shown = loop {
                let (at, some) = terminal.next(IDLE).expect("a picture");
                all.extend(some);
                if all.ends_with(b"\x1b[?2026l") {
                    break at;
                }
            };
            times.push(milliseconds(shown - start));
            bytes = all.len();
            memory = terminal.writes_and_memory().map_or(0.0, |(_, memory)| memory);
        }
        times.sort_by(f64::total_cmp);
        let (median, worst) = (part(&times, 0.5), part(&times, 1.0));
        println!("| {} | {bytes} | {median:.1} | {worst:.1} | {memory:.0} |", size_words(size));
    }
}

/// Measures bytes and processor time of static screens, all at the same time.
fn idle() {
    heading(&["idle for 10 s", "bytes", "% of a processor"]);
    let screens = [
        ("coach", "", OPENING),
        ("library", "d", "The half ball"),
        ("your turn", "d\r", "set the stroke"),
        ("runs", "t", "No agent has been trained here yet"),
    ];
    let open = |(name, keys, text): (&'static str, &str, &'static str)| {
        SIZES.map(|size| {
            let mut terminal = coach(size);
            for key in keys.chars() {
                terminal.send(&key.to_string());
                terminal.take(SILENCE / 2);
            }
            assert!(terminal.screen().contents().contains(text), "{}", terminal.screen().contents());
            (name, size, terminal)
        })
    };
    let mut opened: Vec<_> = screens.into_iter().flat_map(open).collect();
    for (.., terminal) in &mut opened {
        // The end of the last picture does not count as idle output.
        terminal.take(SILENCE / 2);
    }
    let before: Vec<_> = opened.iter().map(|(.., terminal)| terminal.seconds()).collect();
    thread::sleep(IDLE);
    for ((name, size, terminal), before) in opened.iter_mut().zip(before) {
        let share = before.zip(terminal.seconds()).map_or(f64::NAN, |(before, after)| after - before);
        let bytes = terminal.take(Duration::ZERO).len();
        println!("| {name}, {} | {bytes} | {:.1} |", size_words(*size), 100.0 * share / IDLE.as_secs_f64());
    }
}

/// Measures the playback of whole shots: those that the coach finds from the opening position, and one hard shot.
fn playback() {
    heading(&[
        "playback, whole shot",
        "s",
        "bytes a frame",
        "99 %",
        "largest",
        "frames/s",
        "bytes/s",
        "writes a frame",
        "% of a processor",
    ]);
    // The exercise's first ball nearly full, at 6 m/s.
    let hard = "d\r\t\u{1b}[1;2C".to_owned() + &"\u{1b}[1;2A".repeat(10);
    let shots =
        [("straight rail", "\r"), ("one-cushion", "R\r"), ("three-cushion", "RR\r"), ("struck at 6 m/s", &hard)];
    for size in SIZES {
        for (name, keys) in shots {
            let mut terminal = coach(size);
            for key in keys_of(keys) {
                terminal.send(key);
                terminal.take(Duration::from_millis(100));
            }
            // The coach thinks, and then analyses the shot.
            terminal.take_until_silent(2 * SILENCE);
            let before = (terminal.seconds(), terminal.writes_and_memory());
            terminal.send(" ");
            let (bytes, time) = terminal.take_until_silent(SILENCE);
            let after = (terminal.seconds(), terminal.writes_and_memory());
            let (frames, time) = (frames(&bytes), time.as_secs_f64());
            let count = frames.len().max(1);
            let busy = before.0.zip(after.0).map_or(f64::NAN, |(before, after)| after - before);
            let writes = before.1.zip(after.1).map_or(f64::NAN, |(before, after)| (after.0 - before.0) as f64);
            println!(
                "| {name}, {} | {time:.1} | {:.0} | {} | {} | {:.1} | {:.0} | {:.2} | {:.1} |",
                size_words(size),
                bytes.len() as f64 / count as f64,
                part(&frames, 0.99),
                part(&frames, 1.0),
                count as f64 / time,
                bytes.len() as f64 / time,
                writes / count as f64,
                100.0 * busy / time
            );
        }
    }
}

/// Splits typed text into keys; an escape sequence is one key.
fn keys_of(text: &str) -> Vec<&str> {
    let mut rest = text;
    let mut keys = Vec::new();
    while !rest.is_empty() {
        let is_letter = |(n, letter): (usize, char)| (n > 1 && letter.is_ascii_alphabetic()).then_some(n + 1);
        let length = if rest.starts_with('\u{1b}') { rest.char_indices().find_map(is_letter) } else { None };
        let (key, others) = rest.split_at(length.unwrap_or(1));
        keys.push(key);
        rest = others;
    }
    keys
}

/// Measures other changes of the picture: a second of the coach's thinking, a dragged ball, a ball moved by a key.
fn moments() {
    heading(&["bytes of", "a second of thinking", "a picture of a drag", "of a ball that a key moves"]);
    for size in SIZES {
        let mut terminal = Terminal::start(&[], size, "think_ms = 10000\n");
        terminal.wait_for(OPENING);
        let moved = a_picture(&mut terminal, 40, |n| ["\u{1b}[C", "\u{1b}[A"][n % 2].to_owned());
        let (column, row) = white_ball(&terminal);
        terminal.send(&format!("\u{1b}[<0;{column};{row}M"));
        terminal.take(SILENCE);
        let dragged = a_picture(&mut terminal, usize::from(size.0) / 4, |n| {
            format!("\u{1b}[<32;{};{}M", usize::from(column) + n + 1, usize::from(row) - n % 3 / 2)
        });
        terminal.send("\u{1b}[<0;1;1m\r");
        let thinking = terminal.take(Duration::from_secs(5)).len() / 5;
        println!("| {} | {thinking} | {dragged} | {moved} |", size_words(size));
    }
}

/// Returns the mean size of a picture in bytes, with 25 key presses per second.
fn a_picture(terminal: &mut Terminal, times: usize, keys: impl Fn(usize) -> String) -> usize {
    let mut sizes = Vec::new();
    for n in 0..times {
        terminal.send(&keys(n));
        sizes.extend(frames(&terminal.take(Duration::from_millis(40))));
    }
    sizes.iter().sum::<usize>() / sizes.len().max(1)
}

/// Returns a cell of the white ball, counted from 1: the leftmost one that is filled with its colour.
fn white_ball(terminal: &Terminal) -> (u16, u16) {
    let (rows, columns) = terminal.screen().size();
    let (rows, columns) = (rows.get(), columns.get());
    let is_white = |&(column, row): &(u16, u16)| {
        let cell = terminal.screen().cell(row, column);
        cell.is_some_and(|cell| {
            cell.contents() == "█" && matches!(cell.fgcolor(), vt100::Color::Rgb(240.., 240.., 220..))
        })
    };
    let cells = (0..columns).flat_map(|column| (0..rows).map(move |row| (column, row)));
    // The tip panel shows a white ball, too, to the right of the table or below it.
    let (column, row) =
        cells.into_iter().filter(|(_, row)| *row < rows / 2 + 2).find(is_white).expect("the white ball");
    (column + 1, row + 1)
}

/// Two processes that keep the processors busy.
struct Busy([Child; 2]);

impl Busy {
    fn start() -> Self {
        Self([(); 2].map(|()| Command::new("sh").args(["-c", "while :; do :; done"]).spawn().expect("a shell")))
    }
}

impl Drop for Busy {
    fn drop(&mut self) {
        for child in &mut self.0 {
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}

/// Measures the time from a key press to the end of the resulting frame.
fn answers() {
    heading(&["from a key to its picture, 120×40", "median, ms", "99 %", "longest"]);
    for is_busy in [false, true] {
        let beside = if is_busy { ", beside two busy processes" } else { "" };
        let _busy = is_busy.then(Busy::start);
        let mut terminal = coach(USUAL);
        print_times(&format!("idle{beside}"), |n| {
            let sent = terminal.send(["\u{1b}[C", "\u{1b}[D"][n % 2]);
            terminal.wait_until(|_| true) - sent
        });
        terminal.send("\r");
        terminal.take_until_silent(2 * SILENCE);
        // Play at a quarter of the speed, so that the shot lasts.
        terminal.send("-- ");
        print_times(&format!("in playback{beside}"), |_| next_view(&mut terminal));
        let mut terminal = Terminal::start(&[], USUAL, "think_ms = 60000\n");
        terminal.wait_for(OPENING);
        terminal.send("\r");
        terminal.wait_for("so far");
        print_times(&format!("as the coach thinks{beside}"), |_| next_view(&mut terminal));
    }
}

/// Switches the panels to another view and returns the time until the title of the first panel changes.
fn next_view(terminal: &mut Terminal) -> Duration {
    let title = |screen: &vt100::Screen| screen.contents_between(30, 0, 30, 20);
    let before = title(terminal.screen());
    let sent = terminal.send("v");
    terminal.wait_until(|screen| title(screen) != before) - sent
}

fn print_times(name: &str, mut answer: impl FnMut(usize) -> Duration) {
    let mut times: Vec<f64> = (0..KEYS)
        .map(|n| {
            // At a different phase between two frames each time.
            thread::sleep(Duration::from_millis(50 + 7 * n as u64 % 41));
            milliseconds(answer(n))
        })
        .collect();
    times.sort_by(f64::total_cmp);
    println!("| {name} | {:.1} | {:.1} | {:.1} |", part(&times, 0.5), part(&times, 0.99), part(&times, 1.0));
}
