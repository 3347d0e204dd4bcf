//! Charts as text: axes, gaps, bands, and behaviour in small areas.

use proptest::prelude::*;
use rand::{RngExt, SeedableRng as _};
use rand_xoshiro::Xoshiro256PlusPlus;
use ratatui::buffer::Buffer;

use super::*;
use crate::{
    learning::run::{
        history::{History, Span},
        metrics::Record,
        quantity::Quantity,
    },
    terminal::{Capabilities, Depth, Glyphs, Keys, host::backend::AnsiBackend, ui},
};

/// A point from one line of metrics.
pub fn line(shots: u64, value: f64) -> Point {
    stretch((shots, shots), &[value])
}

/// A point from several lines of metrics.
fn stretch(shots: (u64, u64), values: &[f64]) -> Point {
    let finite: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
    let count = |is: fn(&&f64) -> bool| values.iter().filter(is).count() as u64;
    let span = || Span {
        min: finite.iter().copied().fold(f64::INFINITY, f64::min),
        mean: finite.iter().sum::<f64>() / finite.len() as f64,
        max: finite.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        not_positive: finite.iter().filter(|value| **value <= 0.0).count() as u64,
    };
    let non_finite = NonFinite {
        nan: count(|value| value.is_nan()),
        above: count(|value| **value == f64::INFINITY),
        below: count(|value| **value == f64::NEG_INFINITY),
    };
    Point { shots, finite: (!finite.is_empty()).then(span), non_finite }
}

fn chart<'a>(title: &'a str, curves: &'a [Curve<'a>]) -> Chart<'a> {
    let shots = (0.0, 1000.0);
    Chart {
        title,
        curves,
        shots,
        values: None,
        log: false,
        smoothing: 0.0,
        selected: false,
        with_shots: true,
        unit: "shots",
        note: None,
    }
}

fn curve(points: &[Point], role: CurveRole) -> Curve<'_> {
    let add = |sum: NonFinite, next: NonFinite| NonFinite {
        nan: sum.nan + next.nan,
        above: sum.above + next.above,
        below: sum.below + next.below,
    };
    Curve { points, non_finite: points.iter().map(|point| point.non_finite).fold(NonFinite::default(), add), role }
}

fn draw(chart: &Chart, area: Rect, theme: &Theme, caps: Capabilities, buffer: &mut Buffer) {
    draw_chart(chart, area, &mut Ui { theme, caps, keys: &Keys::default(), buffer });
}

fn drawn(chart: &Chart, (width, height): (u16, u16), caps: Capabilities) -> Buffer {
    let area = Rect::new(0, 0, width, height);
    ui::drawn(area, caps, |ui| draw_chart(chart, area, ui))
}

fn text(buffer: &Buffer) -> String {
    let symbol = |x, y| buffer[(x, y)].symbol();
    let row = |y| (0..buffer.area.width).map(|x| symbol(x, y)).collect::<String>().trim_end().to_owned();
    (0..buffer.area.height).map(row).collect::<Vec<_>>().join("\n")
}

fn picture(chart: &Chart, size: (u16, u16), caps: Capabilities) -> String {
    text(&drawn(chart, size, caps))
}

#[test]
fn a_falling_loss_beside_another_run() {
    let own: Vec<_> = (1..=80).map(|n| line(10 * n, (-(n as f64) / 20.0).exp())).collect();
    let other: Vec<_> = (1..=40).map(|n| line(25 * n, 0.5 + 0.1 * (n as f64 / 3.0).sin())).collect();
    let curves = [curve(&own, CurveRole::Main), curve(&other, CurveRole::Compared)];
    insta::assert_snapshot!(picture(&chart("3 critic loss", &curves), (44, 9), Capabilities::ASCII), @r"
    - 3 critic loss -------------------- 0.0183
       1.0+**
          | **
          |  ***..             ....
       0.5+ ...***.....  .......  ......  ......
          |      *****....             ....
          |          *********
         0+                  ************
     shots 0     0.2k   0.4k    0.6k   0.8k 1.0k
    ");
    let log =
        Chart { log: true, smoothing: 0.03, note: Some("a note without room"), ..chart("3 critic loss", &curves) };
    insta::assert_snapshot!(picture(&log, (44, 9), Capabilities::TRUE_COLOUR), @r"
    ─ 3 critic loss · log · smooth 3 % ─ 0.0183
         1┤⠈⠓⠲⠤⣄⣀⣀⣀⠁ ⠁ ⠁ ⠁ ⠁ ⢀⢀⣀⣀⣀⣀⣀⡀⠁ ⠁ ⠁ ⠁ ⠁ ⣀
          │ ⠉  ⠈⠈⠙⠒⠦⣄⣀⠒⠒⠒⠒⠒⠒⠋⠉⠉    ⠈⠉⠉⠙⠒⠒⠒⠒⠒⠒⠋⠉⠉
          │         ⠈⠈⠙⠒⠦⣄⣀
       0.1┤⠄ ⠄ ⠄ ⠄ ⠄ ⠄ ⠄ ⠈⠈⠙⠒⠦⣄⣀ ⠄ ⠄ ⠄ ⠄ ⠄ ⠄ ⠄ ⠄
          │                   ⠈⠈⠙⠒⠦⣄⣀
          │                        ⠈⠈⠙⠒⠦⡄
      0.01┤⡀ ⡀ ⡀ ⡀ ⡀ ⡀ ⡀ ⡀ ⡀ ⡀ ⡀ ⡀ ⡀ ⡀ ⡀ ⡀ ⡀ ⡀ ⡀
     shots 0     0.2k   0.4k    0.6k   0.8k 1.0k
    ");
}

#[test]
fn gaps_are_named_and_interrupt_the_curve() {
    let mut points: Vec<_> = (0..100).map(|n| line(10 * n, (n as f64 / 9.0).sin())).collect();
    (30..40).for_each(|n| points[n] = line(10 * n as u64, f64::NAN));
    points[70] = stretch((700, 709), &[f64::INFINITY, 0.9]);
    points[99] = line(990, f64::NEG_INFINITY);
    let curves = [curve(&points, CurveRole::Main)];
    insta::assert_snapshot!(picture(&chart("1 mean reward", &curves), (50, 8), Capabilities::ASCII), @r"
    - 1 mean reward ---- NaN x10 inf x1 -inf x1  -inf
         1+    *****                  ******
          |  ***   ***              ***    ***
          |***       ***           **        ***
         0+*           *         ***           **
          |                    ***              ***
        -1+                 ****                  ***
     shots 0      0.2k     0.4k    0.6k     0.8k  1.0k
    ");
    let log = Chart { log: true, ..chart("1 mean reward", &curves) };
    insta::assert_snapshot!(picture(&log, (60, 7), Capabilities::TRUE_COLOUR), @r"
    ─ 1 mean reward · log ────── ≤0 ×33  NaN ×10 ∞ ×1 -∞ ×1  -∞
         1┤⠁ ⢀⡤⠖⠚⠉⠉⠉⠙⠒⠦⣄ ⠁ ⠁ ⠁ ⠁ ⠁ ⠁ ⠁ ⠁ ⠁ ⣠⠴⠒⠋⠙⠋⠉⠓⠲⢤⡀ ⠁ ⠁ ⠁ ⠁ ⠁
          │ ⣰⠋         ⠈⢳⡀               ⢀⡼⠁         ⠙⣆
          │⢰⠃            ⣇               ⣸            ⠘⡆
          │              ⢸               ⡇             ⠁
      0.02┤⡀ ⡀ ⡀ ⡀ ⡀ ⡀ ⡀ ⠘ ⡀ ⡀ ⡀ ⡀ ⡀ ⡀ ⡀ ⡀ ⡀ ⡀ ⡀ ⡀ ⡀ ⡀ ⡀ ⡀ ⡀ ⡀ ⡀
     shots 0        0.2k       0.4k      0.6k       0.8k    1.0k
    ");
    let title = drawn(&log, (60, 7), Capabilities::TRUE_COLOUR);
    let warning = Theme::new(Capabilities::TRUE_COLOUR.depth).warning;
    assert!((0..60).any(|x| title[(x, 0)].symbol() == "∞" && title[(x, 0)].fg == warning));
}

#[test]
fn a_run_without_data_and_one_with_a_single_point() {
    let point = [line(300, -0.4)];
    let mut one = chart("4 held-out success", &[]);
    one.note = Some("measured every 5k shots");
    insta::assert_snapshot!(picture(&one, (40, 5), Capabilities::TRUE_COLOUR), @r"
    ─ 4 held-out success ───────────────────
          │
          │     measured every 5k shots
          │
     shots 0              0.5k          1.0k
    ");
    let curves = [curve(&point, CurveRole::Main)];
    insta::assert_snapshot!(picture(&chart("4 held-out success", &curves), (26, 5), Capabilities::TRUE_COLOUR), @r"
    ─ 4 held-out success ─────
         0┤⠁ ⠁ ⠁ ⠁ ⠁ ⠁ ⠁ ⠁ ⠁ ⠁
          │     ⢠⡄
      -0.6┤⡀ ⡀ ⡀ ⡀ ⡀ ⡀ ⡀ ⡀ ⡀ ⡀
     shots 0       0.5k   1.0k
    ");
}

#[test]
fn the_whole_run_is_shown_by_a_range_that_grows_in_steps() {
    let ends = [(0, None), (1000, None), (1001, None), (210_000, None), (210_000, Some(300_000))];
    assert_eq!(ends.map(|(shots, planned)| whole(shots, planned).1), [1e3, 1e3, 2e3, 5e5, 3e5]);
    // Planned numbers that are far away, short, or already exceeded.
    let plans = [(210_000, Some(5_000_000)), (100, Some(400)), (700_000, Some(600_000)), (5, Some(0))];
    assert_eq!(plans.map(|(shots, planned)| whole(shots, planned).1), [5e5, 400.0, 1e6, 1e3]);
    assert!(whole(u64::MAX, Some(u64::MAX)).1 >= 1e19);
}

/// Rows in which a column of cells shows the run's own curve.
fn rows_in(buffer: &Buffer, column: u16) -> Vec<u16> {
    let own = Theme::new(Capabilities::TRUE_COLOUR.depth).curves[0];
    (1..buffer.area.height).filter(|row| buffer[(column, *row)].fg == own).collect()
}

#[test]
fn a_peak_of_one_record_in_millions_stays_visible() {
    let values = |n: u64| if n == 1234 { vec![0.0, 1.0] } else { vec![0.0, 0.01] };
    let points: Vec<_> = (0..2000).map(|n| stretch((n * 1000, n * 1000 + 900), &values(n))).collect();
    let curves = [curve(&points, CurveRole::Main)];
    let chart = Chart { shots: whole(2_000_000, None), ..chart("spike", &curves) };
    for glyphs in [Glyphs::Sextant, Glyphs::Half, Glyphs::Letters] {
        let buffer = drawn(&chart, (107, 12), Capabilities { glyphs, ..Capabilities::TRUE_COLOUR });
        let column = LEFT + (0.617 * 99.5) as u16;
        assert_eq!(rows_in(&buffer, column), (1..11).collect::<Vec<_>>(), "{}", text(&buffer));
        assert_eq!(rows_in(&buffer, column + 2), [10], "{}", text(&buffer));
    }
}

#[test]
fn neighbours_are_joined_however_far_apart() {
    let points = [line(0, 0.0), line(10, 1.0), line(500, 0.0), line(1000, 1.0)];
    let curves = [curve(&points, CurveRole::Main)];
    let buffer = drawn(
        &chart("zigzag", &curves),
        (67, 22),
        Capabilities { glyphs: Glyphs::Letters, ..Capabilities::TRUE_COLOUR },
    );
    let rows: Vec<_> = (LEFT..67).map(|column| rows_in(&buffer, column)).collect();
    for pair in rows.windows(2) {
        let below = |one: &[u16], other: &[u16]| one[0] > other[other.len() - 1] + 1;
        assert!(!below(&pair[0], &pair[1]) && !below(&pair[1], &pair[0]), "{}", text(&buffer));
    }
}

#[test]
fn a_range_of_a_curve_is_drawn_like_the_whole_curve() {
    let all: Vec<_> = (0..400).map(|n| line(25 * n, (n as f64 / 30.0).sin())).collect();
    let frame = |points: &[Point]| {
        let curves = [curve(points, CurveRole::Main)];
        picture(&Chart { shots: (3000.0, 5000.0), ..chart("", &curves) }, (60, 12), Capabilities::TRUE_COLOUR)
    };
    // One point beyond either end, as the history returns them.
    let plot = |text: &str| text.lines().skip(1).collect::<Vec<_>>().join("\n");
    assert_eq!(plot(&frame(&all)), plot(&frame(&all[119..202])));
}

fn any_value() -> impl Strategy<Value = f64> {
    prop_oneof![8 => -2.0..2.0, 1 => proptest::num::f64::ANY, 1 => Just(f64::NAN), 1 => Just(0.0), 1 => Just(1e30)]
}

proptest! {
    #[test]
    fn nothing_panics_or_is_drawn_outside(
        values in proptest::collection::vec((0_u64..50_000, any_value()), 0..40),
        (x, y, width, height) in (0_u16..30, 0_u16..10, 0_u16..90, 0_u16..20),
        shots in prop_oneof![Just((0.0, 50_000.0)), (any_value(), any_value()), (0.0..5e4, 0.0..5e4)],
        (log, smoothing) in (any::<bool>(), prop_oneof![Just(0.0), 0.0..0.2, any_value()]),
        (depth, glyphs, unicode) in (0_usize..4, 0_usize..3, any::<bool>()),
    ) {
        let mut end = 0;
        let step = |(shots, value): &(u64, f64)| {
            end += shots;
            stretch((end - shots / 2, end), &[*value, value / 2.0])
        };
        let points: Vec<_> = values.iter().map(step).collect();
        let curves = [curve(&points, CurveRole::Main), curve(&points[points.len() / 2..], CurveRole::Compared)];
        let depth = [Depth::True, Depth::Indexed, Depth::Ansi, Depth::Mono][depth];
        let caps = Capabilities { depth, glyphs: [Glyphs::Sextant, Glyphs::Half, Glyphs::Letters][glyphs], unicode };
        let mut buffer = Buffer::filled(Rect::new(0, 0, 70, 24), ratatui::buffer::Cell::new("~"));
        let area = Rect { x, y, width, height };
        let chart = Chart { shots, log, smoothing, selected: log, note: Some("note"), ..chart("1 reward", &curves) };
        draw(&chart, area, &Theme::new(depth), caps, &mut buffer);
        for (n, cell) in buffer.content.iter().enumerate() {
            let (column, row) = buffer.pos_of(n);
            let inside = area.contains(ratatui::layout::Position::new(column, row));
            prop_assert!(inside || cell == &ratatui::buffer::Cell::new("~"), "{column},{row} {area}");
            prop_assert!(unicode || cell.symbol().is_ascii(), "{}", cell.symbol());
        }
    }
}

/// Metrics line `n` of a run that improves, with noise.
fn record(n: u64, random: &mut Xoshiro256PlusPlus) -> Record {
    let learnt = 1.0 - (-(n as f64) / 1500.0).exp();
    let mut noise = |size: f64| size * (random.random::<f64>() + random.random::<f64>() - 1.0);
    Record {
        shots: 400 * (n + 1),
        critic_loss: 0.05 + 0.6 * (1.0 - learnt) + noise(0.03),
        q_value: 0.4 * learnt + noise(0.02),
        rollout_reward: 0.35 * learnt + noise(0.08),
        held_out_reward: (n % 50 == 49).then(|| 0.7 * learnt + noise(0.05)),
        ..Record::default()
    }
}

/// Bytes of each frame when a run of 5,000 lines is drawn line by line: 120×40 cells, four charts.
fn bytes_of_frames() -> Vec<usize> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
    let mut terminal = ratatui::Terminal::new(AnsiBackend::new(|| Ok((120, 40)))).unwrap();
    let (theme, mut history, mut bytes) = (Theme::new(Capabilities::TRUE_COLOUR.depth), History::default(), Vec::new());
    for n in 0..5000 {
        history.push(&record(n, &mut random));
        let shots = whole(400 * (n + 1), Some(3_000_000));
        let draw = |frame: &mut ratatui::Frame| {
            for (n, quantity) in Quantity::ALL.into_iter().take(4).enumerate() {
                let points = history.points(quantity, shots.0..=shots.1);
                let curves = [curve(&points, CurveRole::Main)];
                let area = Rect::new(60 * (n as u16 % 2), 11 * (n as u16 / 2), 60, 11);
                let smoothing = if n % 2 == 0 { 0.0 } else { 0.03 };
                let chart = Chart { shots, smoothing, with_shots: n > 1, ..chart(quantity.name(), &curves) };
                draw(&chart, area, &theme, Capabilities::TRUE_COLOUR, frame.buffer_mut());
            }
        };
        terminal.draw(draw).unwrap();
        let mut frame = Vec::new();
        terminal.backend_mut().write_frame(&mut frame).unwrap();
        bytes.push(frame.len());
    }
    bytes
}

#[test]
fn a_frame_of_four_charts_is_hundreds_of_bytes() {
    let mut bytes = bytes_of_frames();
    let mean = bytes.iter().sum::<usize>() / bytes.len();
    bytes.sort_unstable();
    let (most, largest) = (bytes[bytes.len() * 99 / 100], bytes[bytes.len() - 1]);
    println!("mean {mean}, 99 % at most {most}, largest {largest} bytes");
    assert!(mean < 200 && most < 2000 && largest < 10_000, "{mean} {most} {largest}");
}
