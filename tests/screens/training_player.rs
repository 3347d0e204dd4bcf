//! Somebody at the training screen, and a run to watch.

use std::path::Path;

use carom::{
    learning::run::{
        Config,
        examples::{Example, Examples},
        follow::{Condition, Update},
        list::{Stage, Summary},
        metrics::Record,
        status::{Phase, RunStatus},
    },
    physics::CueInputs,
    storage::Places,
    table::{Layout, Table},
    terminal::{App, Depth, Effect, Glyphs, Look, Reel, Report, Slot},
};
use ratatui::{Terminal, backend::TestBackend};
use serde_json::json;

use crate::{coach_player::is_toast, keys::key};

pub const TRUE_COLOUR: Look = Look { depth: Depth::True, glyphs: Glyphs::Sextant, unicode: true };
pub const NO_COLOUR: Look = Look { depth: Depth::Mono, glyphs: Glyphs::Letters, unicode: true };
pub const ASCII: Look = Look { depth: Depth::Mono, glyphs: Glyphs::Letters, unicode: false };

pub const RUNS: &str = "/runs";
pub const NAME: &str = "20261120-091500-ddpg-match-r3-1";
pub const OTHER: &str = "20261119-180102-ddpg-match-r3-2";

pub struct Player {
    pub app: App,
    pub effects: Vec<Effect>,
}

impl Player {
    pub fn with(look: Look) -> Self {
        let table = Table::default();
        let places = Places { runs: RUNS.into(), policies: "/policies".into(), ..Places::of_this_user() };
        let app = App::new(table.clone(), Layout::opening(&table), look, 7).unwrap().with_places(places);
        Self { app, effects: Vec::new() }.press("t")
    }

    /// At the list of runs.
    pub fn new() -> Self {
        Self::with(TRUE_COLOUR)
    }

    /// At a run that has played 1.2 of 5 million shots.
    pub fn watching(look: Look) -> Self {
        let player = Self::with(look).report(Report::Runs(Ok(summaries().into()))).press("Enter").has_policy(true);
        player.update(Slot::Main, NAME, known()).quiet()
    }

    /// Presses keys: letters as they are, names like `Left`, `Enter` between blanks.
    pub fn press(mut self, keys: &str) -> Self {
        for word in keys.split_whitespace() {
            self.effects.extend(self.app.handle(&key(word)));
        }
        self
    }

    pub fn report(mut self, report: Report) -> Self {
        self.app.receive_report(report);
        self
    }

    /// News of a run, its shots recorded as the program does it.
    pub fn update(self, slot: Slot, name: &str, mut update: Update) -> Self {
        let folder = Path::new(RUNS).join(name);
        let reel = update.examples.take().map(|examples| Reel::record(&examples, &Table::default()));
        let player = self.report(Report::Followed(slot, folder.clone(), Box::new(update)));
        match reel.filter(|_| slot == Slot::Main) {
            Some(reel) => player.report(Report::Recorded(folder, reel)),
            None => player,
        }
    }

    pub fn condition(self, condition: Condition, reason: Option<&str>) -> Self {
        let phase = if let Condition::Is(phase) = condition { phase } else { Phase::Training };
        let standing = RunStatus { phase, reason: reason.map(str::to_owned), ..standing() };
        self.update(
            Slot::Main,
            NAME,
            Update { condition: Some(condition), standing: Some(standing), ..Update::default() },
        )
    }

    pub fn has_policy(self, has_policy: bool) -> Self {
        self.report(Report::HasPolicy(Path::new(RUNS).join(NAME), has_policy))
    }

    /// The replay has come to its end.
    pub fn quiet(mut self) -> Self {
        for _ in 0..2000 {
            if self.app.frame_interval().is_none() {
                break;
            }
            self.app.tick(0.1);
        }
        assert_eq!(self.app.frame_interval(), None, "it rests");
        self
    }

    pub fn draw(&self, width: u16, height: u16) -> Terminal<TestBackend> {
        let mut terminal = Terminal::new(TestBackend::new(width, height)).unwrap();
        terminal.draw(|frame| self.app.draw(frame)).unwrap();
        terminal
    }

    pub fn text(&self, width: u16, height: u16) -> String {
        self.draw(width, height).backend().to_string()
    }

    /// On the screen, in a toast perhaps, which breaks its lines as it needs.
    pub fn says(&self, part: &str) {
        let text = self.text(120, 40);
        assert!(text.contains(part) || is_toast(&self.app, part), "{part}\n{text}");
    }
}

pub fn summary(name: &str, shots: u64, best: Option<f64>, state: Stage) -> Summary {
    Summary {
        name: name.into(),
        agent: "ddpg".into(),
        reward: carom::game::Reward::R3,
        table: "match".into(),
        seed: 1,
        shots,
        planned_shots: 5_000_000,
        best_reward: best,
        last_reward: best.map(|best| best - 0.004),
        started: format!("2026-11-{}T09:15:00Z", &name[6..8]),
        changed: "2026-11-20T10:01:12Z".into(),
        state,
        folder: Path::new(RUNS).join(name),
    }
}

pub fn summaries() -> Vec<Summary> {
    vec![
        summary(OTHER, 5_000_000, Some(0.931), Stage::Finished),
        summary(NAME, 1_200_000, Some(0.874), Stage::Running),
        summary("20261118-three-cushions/seed-1", 40_000, None, Stage::Interrupted),
    ]
}

pub fn config(reward: &str) -> Config {
    serde_json::from_value(json!({
        "agent": "ddpg", "reward": reward, "seed": 1, "shots": 5_000_000, "started": "2026-11-20T09:15:00Z",
        "version": "0.1.0", "source": null, "from": null,
        "schedule": { "log_every": 20_000, "evaluate_every": 100_000, "evaluation_layouts": 2000 },
        "settings": {}, "table": Table::default(),
    }))
    .unwrap()
}

pub fn standing() -> RunStatus {
    RunStatus {
        phase: Phase::Training,
        shots: 1_200_000,
        updates: 93_750,
        seconds: 2772.0,
        shots_per_second: 433.0,
        updates_per_second: 34.0,
        exploration: 0.153,
        memory: Some(0.6),
        held_out_reward: None,
        process: 1,
        warning: None,
        reason: None,
    }
}

pub fn record(n: u64) -> Record {
    let share = (n as f64 / 60.0).min(1.0);
    Record {
        shots: 20_000 * n,
        seconds: 46.2 * n as f64,
        shots_per_second: 433.0,
        updates: 1562 * n,
        learning_rate: 3e-4 * (1.0 - 0.5 * share),
        critic_loss: 0.6 * (-3.0 * share).exp() + 0.02 * (n as f64).sin().abs(),
        actor_loss: Some(-share),
        q_value: 0.7 * share,
        practice_reward: 0.6 * share + 0.03 * (1.7 * n as f64).sin(),
        exploration: Some(0.3 - 0.147 * share),
        memory: Some(share),
        held_out_reward: n.is_multiple_of(5).then(|| 0.874 * share.sqrt()),
        held_out_reach: n.is_multiple_of(5).then(|| 0.96 * share.sqrt()),
    }
}

pub fn examples(after: u64) -> Examples {
    let table = Table::default();
    let cue = CueInputs::parse("0.2,0.3,6,-72,2.5").unwrap();
    let shot = |reward| Example { layout: Layout::opening(&table), cue, reward };
    Examples { after, shots: vec![shot(0.0), shot(1.0), shot(1.0)] }
}

/// All that there is to know of a run at work.
pub fn known() -> Update {
    Update {
        config: Some(Box::new(config("r3"))),
        records: (1..=60).map(record).collect(),
        standing: Some(standing()),
        condition: Some(Condition::Is(Phase::Training)),
        examples: Some(examples(1_200_000)),
        ..Update::default()
    }
}
