//! Effect of each optimisation of the engine: `cargo bench --bench savings`.
//!
//! Four kinds of scenes are scored under straight rail, with all optimisations and with each of them switched off in turn. The rounds are
//! interleaved, so that noise of the machine affects all alike, and the fastest round counts. In every row the cue ball must meet the same
//! balls at the same times, bit for bit.

use std::{f64::consts::PI, ops::ControlFlow, time::Instant};

use carom::{
    game::Tally,
    physics::{CueInputs, Impulse, strike},
    simulation::{AllSavings, Event, EventKind, Observer, Savings, Segment, simulate, watch_with},
    table::{Layout, Table},
};
use glam::DVec2;
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

const ROUNDS: usize = 15;

/// Shots of one kind on one table.
struct Scene {
    name: &'static str,
    table: Table,
    shots: Vec<(Layout, Impulse)>,
}

/// Watches for a point, and computes a fingerprint of the cue ball's contacts until then.
#[derive(Default)]
struct Watch {
    tally: Tally,
    fingerprint: u64,
}

impl Observer for Watch {
    fn wants_ends(&self) -> bool {
        false
    }

    fn awaited(&self) -> Option<[bool; 2]> {
        Some(self.tally.not_hit())
    }

    fn event(&mut self, event: Event) -> ControlFlow<()> {
        if self.tally.has_hit_both() {
            return ControlFlow::Break(());
        }
        self.tally.count(&event);
        if let EventKind::BallBall(0, ball) = event.kind {
            self.fingerprint = self.fingerprint.wrapping_mul(0x0100_0000_01b3) ^ event.time.to_bits() ^ ball as u64;
        }
        if self.tally.has_hit_both() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// Like [`Watch`], but records everything, needed or not.
#[derive(Default)]
struct Hoarder {
    watch: Watch,
    events: Vec<Event>,
    segments: [Vec<Segment>; 3],
}

impl Observer for Hoarder {
    fn wants_segments(&self) -> bool {
        true
    }

    fn wants_ends(&self) -> bool {
        false
    }

    fn awaited(&self) -> Option<[bool; 2]> {
        self.watch.awaited()
    }

    fn event(&mut self, event: Event) -> ControlFlow<()> {
        self.events.push(event);
        self.watch.event(event)
    }

    fn segment(&mut self, ball: usize, segment: &Segment, _end: f64) {
        self.segments[ball].push(segment.clone());
    }
}

fn watched<S: Savings>(scene: &Scene) -> u64 {
    let play = |(layout, impulse): &(Layout, Impulse)| {
        let mut watch = Watch::default();
        watch_with::<S, _>(&scene.table, layout, impulse, &mut watch);
        watch.fingerprint
    };
    scene.shots.iter().map(play).fold(0, u64::wrapping_add)
}

fn hoarded(scene: &Scene) -> u64 {
    let play = |(layout, impulse): &(Layout, Impulse)| {
        let mut hoarder = Hoarder::default();
        watch_with::<AllSavings, _>(&scene.table, layout, impulse, &mut hoarder);
        std::hint::black_box(&hoarder.segments);
        hoarder.watch.fingerprint
    };
    scene.shots.iter().map(play).fold(0, u64::wrapping_add)
}

/// Plays a scene and returns a fingerprint of its events.
type Play = fn(&Scene) -> u64;

/// The set of optimisations without the named ones.
macro_rules! without {
    ($($saving:ident),*) => {{
        struct Without;
        impl Savings for Without {
            $(const $saving: bool = false;)*
        }
        watched::<Without>
    }};
}

fn main() {
    let rows: [(&str, Play); 11] = [
        ("all savings", watched::<AllSavings>),
        ("balls at rest predict nothing", without!(BALLS_AT_REST)),
        ("predictions are kept", without!(KEPT_PREDICTIONS)),
        ("only cushions in reach", without!(CUSHIONS_IN_REACH)),
        ("no roots for courses apart", without!(SEPARATED_COURSES)),
        ("a loop of its own for a lone ball", without!(LONE_BALL)),
        ("the last ball is not rolled out", without!(LAST_ROLLS)),
        ("the end when it is decided", without!(EARLY_END)),
        ("the end when energy is spent", without!(OUT_OF_REACH)),
        ("nothing recorded unasked", hoarded),
        (
            "all of these but recording",
            without!(
                BALLS_AT_REST,
                KEPT_PREDICTIONS,
                CUSHIONS_IN_REACH,
                SEPARATED_COURSES,
                LONE_BALL,
                LAST_ROLLS,
                EARLY_END,
                OUT_OF_REACH
            ),
        ),
    ];
    let scenes = [far_apart(), gathered(), alone(), chatter()];
    let mut seconds = vec![[f64::INFINITY; 4]; rows.len()];
    for _ in 0..ROUNDS {
        for (column, scene) in scenes.iter().enumerate() {
            let expected = (rows[0].1)(scene);
            for (row, (name, play)) in rows.iter().enumerate() {
                let start = Instant::now();
                let fingerprint = play(scene);
                seconds[row][column] = seconds[row][column].min(start.elapsed().as_secs_f64());
                assert_eq!(fingerprint, expected, "without \"{name}\" the scene \"{}\" changes", scene.name);
            }
        }
    }
    print!("{:34}", "without …: × slower");
    for scene in &scenes {
        print!("{:>16}", scene.name);
    }
    println!();
    for ((name, _), row) in rows.iter().zip(&seconds) {
        print!("{name:34}");
        for ((time, base), scene) in row.iter().zip(seconds[0]).zip(&scenes) {
            if *name == rows[0].0 {
                print!("{:>11.0} ns/shot", 1e9 * time / scene.shots.len() as f64);
            } else {
                print!("{:>16.2}", time / base);
            }
        }
        println!();
    }
    println!("in all rows the cue ball met the same balls at the same times, bit for bit");
}

/// Creates a scene of random shots at the centre of the ball, from valid layouts that `place` draws.
fn scene(
    name: &'static str,
    preset: &str,
    count: usize,
    mut place: impl FnMut(&Table, &mut Xoshiro256PlusPlus) -> Layout,
) -> Scene {
    let table = Table::preset(preset).expect("presets are valid");
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(11);
    let shots = (0..count)
        .map(|_| {
            let layout = loop {
                let layout = place(&table, &mut rng);
                if layout.validate(&table).is_ok() {
                    break layout;
                }
            };
            let (phi, speed) = (rng.random_range(-PI..PI), rng.random_range(0.5..6.0));
            let cue = CueInputs { a: 0.0, b: 0.0, theta: 10_f64.to_radians(), phi, speed };
            (layout, strike(&table, &cue))
        })
        .collect();
    Scene { name, table, shots }
}

/// Every ball is more than a metre from the others.
fn far_apart() -> Scene {
    scene("far apart", "textbook", 4000, |table, rng| {
        loop {
            let layout = Layout::random(table, rng);
            let [a, b, c] = layout.balls;
            if a.distance(b).min(a.distance(c)).min(b.distance(c)) > 1.0 {
                return layout;
            }
        }
    })
}

/// All balls are in a square of four diameters.
fn gathered() -> Scene {
    scene("gathered", "textbook", 4000, |table, rng| {
        let middle = Layout::random(table, rng).balls[0];
        let size = 4.0 * table.radius;
        Layout::new(std::array::from_fn(|_| {
            middle + DVec2::new(rng.random_range(-size..size), rng.random_range(-size..size))
        }))
    })
}

/// The object balls are in two corners, where the cue ball hardly ever goes.
fn alone() -> Scene {
    scene("one ball alone", "textbook", 4000, |table, rng| {
        let corner = table.reach();
        Layout::new([Layout::random(table, rng).balls[0], corner, -corner])
    })
}

/// The thesis' table, on which bounces die out in resting contacts: only shots that have such contacts.
fn chatter() -> Scene {
    let mut scene = scene("thesis chatter", "thesis", 400, Layout::random);
    let Scene { table, shots, .. } = &mut scene;
    shots.retain(|(layout, impulse)| {
        let mut rests = Rests(false);
        simulate(table, layout, impulse, &mut rests);
        rests.0
    });
    shots.truncate(20);
    scene
}

/// Whether any ball came to rest against an object that presses it.
struct Rests(bool);

impl Observer for Rests {
    fn event(&mut self, event: Event) -> ControlFlow<()> {
        self.0 |= matches!(event.kind, EventKind::ContactBegins(_));
        ControlFlow::Continue(())
    }
}
