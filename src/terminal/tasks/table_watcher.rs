//! Following another player: reads the table that they share and simulates its shot.

use std::{path::PathBuf, sync::Arc, time::Duration};

use crate::{
    physics::CueInputs,
    simulation::{Recording, Start},
    table::{Layout, Table},
    terminal::{
        Shot,
        shared_table::{Author, SharedTable, SharedTableState},
    },
};

/// Bounds for simulating another player's shot: computing time, number of events and of contact steps, and duration, s. Their table may be
/// unusably stiff or slippery.
const MAX_TIME: Duration = Duration::from_secs(2);
const MAX_EVENTS: u32 = 20_000;
const MAX_DURATION: f64 = 120.0;

/// The result of reading another player's table.
pub type FollowedTableState = SharedTableState<FollowedTable>;

/// The message if the table of the player `name` is [`SharedTableState::Damaged`].
pub fn damage_message(name: &str) -> String {
    format!("The table of {name} cannot be read: it is damaged, or of another version of carom.")
}

/// Another player's table.
#[derive(Clone, Debug)]
pub struct FollowedTable {
    /// The shared view.
    pub shown: SharedTable,
    /// Its age when read.
    pub age: Duration,
    /// The simulated shot; `None` if there is none or it cannot be simulated.
    pub shot: Option<Arc<Shot>>,
}

/// The inputs of a simulated shot.
type ShotInputs = (Table, Layout, CueInputs, bool);

/// A reader of another player's table.
#[derive(Debug)]
pub struct TableWatcher {
    folder: PathBuf,
    before: Option<FollowedTableState>,
    /// The inputs and the result of the last simulation.
    shot: Option<(ShotInputs, Option<Arc<Shot>>)>,
}

impl TableWatcher {
    /// Creates a reader of the table shared in `folder`.
    pub const fn new(folder: PathBuf) -> Self {
        Self { folder, before: None, shot: None }
    }

    /// Reads the table; `None` if nothing has changed.
    pub fn poll(&mut self) -> Option<FollowedTableState> {
        let found = SharedTable::read(&self.folder);
        let is_known = match (&found, &self.before) {
            (SharedTableState::Nothing, Some(FollowedTableState::Nothing))
            | (SharedTableState::Damaged, Some(FollowedTableState::Damaged)) => true,
            (SharedTableState::Table(table), Some(FollowedTableState::Table(seen))) => table.0 == seen.shown,
            _ => false,
        };
        if is_known {
            return None;
        }
        let seen = match found {
            SharedTableState::Nothing => FollowedTableState::Nothing,
            SharedTableState::Damaged => FollowedTableState::Damaged,
            SharedTableState::Table(table) => {
                let (shown, age) = *table;
                let shot = self.record(&shown);
                FollowedTableState::Table(Box::new(FollowedTable { shown, age, shot }))
            }
        };
        self.before = Some(seen.clone());
        Some(seen)
    }

    /// Simulates the shot, unless it is the same as the last one.
    fn record(&mut self, shown: &SharedTable) -> Option<Arc<Shot>> {
        let shot = shown.shot?;
        let inputs = (shown.table.clone(), shown.layout, shot.cue, shot.solved);
        if let Some((known, shot)) = &self.shot
            && *known == inputs
        {
            return shot.clone();
        }
        let (table, layout, cue, solved) = &inputs;
        let source = if shot.author == Author::Player { "their own" } else { "the coach" };
        let recording = recorded(table, layout, cue);
        let shot = recording.map(|recording| Arc::new(Shot::of(table, recording, *cue, *solved, source)));
        self.shot = Some((inputs, shot.clone()));
        shot
    }
}

/// Simulates the shot; `None` if it exceeds a bound.
fn recorded(table: &Table, layout: &Layout, cue: &CueInputs) -> Option<Recording> {
    let (recording, is_over) =
        Recording::within_bounds(table, layout, Start::Stroke(cue), MAX_TIME, MAX_EVENTS).ok()?;
    (!is_over && recording.is_finite() && recording.duration() <= MAX_DURATION).then_some(recording)
}

#[cfg(test)]
mod tests {
    use std::time::Instant;

    use super::*;
    use crate::{
        coach::Skill,
        game::Rule,
        storage::Lock,
        terminal::shared_table::{Activity, SharedShot},
    };

    #[test]
    fn a_change_is_reported_once_with_a_bit_identical_shot() {
        let folder = tempfile::tempdir().unwrap();
        let mut watcher = TableWatcher::new(folder.path().to_owned());
        assert!(matches!(watcher.poll(), Some(FollowedTableState::Nothing)) && watcher.poll().is_none());
        let lock = Lock::try_acquire(folder.path()).unwrap();
        let table = Table::default();
        let layout = Layout::opening(&table);
        let cue = CueInputs::parse("0.2,0.3,6,-72,2.5").unwrap();
        let (author, solved, made, time, speed, playing, over) = (Author::Coach, true, None, 0.0, 1.0, false, false);
        let shot = SharedShot { cue, author, solved, made, time, speed, playing, over };
        let shown = SharedTable::new(Activity::Watching, table.clone(), layout, Rule::StraightRail, Skill::CLUB);
        let shown = SharedTable { shot: Some(shot), ..shown };
        shown.write(folder.path()).unwrap();
        let Some(FollowedTableState::Table(seen)) = watcher.poll() else { panic!("nothing is seen") };
        // The file states directions in degrees, which changes their last digit.
        let cue: CueInputs = serde_json::from_value(serde_json::to_value(cue).unwrap()).unwrap();
        let (there, here) = (Recording::new(&table, &layout, &cue).unwrap(), &seen.shot.as_ref().unwrap().recording);
        assert_eq!((there.duration(), there.events().len()), (here.duration(), here.events().len()));
        assert!(watcher.poll().is_none());
        let playing = SharedTable { shot: Some(SharedShot { playing: true, ..shot }), ..shown };
        playing.write(folder.path()).unwrap();
        let Some(FollowedTableState::Table(again)) = watcher.poll() else { panic!("nothing is seen") };
        assert!(Arc::ptr_eq(seen.shot.as_ref().unwrap(), again.shot.as_ref().unwrap()), "recorded once");
        drop(lock);
        assert!(matches!(watcher.poll(), Some(FollowedTableState::Nothing)));
    }

    #[test]
    fn a_shot_without_end_is_given_up_in_time() {
        let slippery = Table {
            sliding_friction: 1e-4,
            rolling_friction: 1e-4,
            rail_restitution: 1.0,
            ..Table::preset("textbook").unwrap()
        };
        let start = Instant::now();
        let cue = CueInputs::parse("0,0,0,40,100").unwrap();
        assert!(recorded(&slippery, &Layout::opening(&slippery), &cue).is_none());
        assert!(start.elapsed() < 5 * MAX_TIME, "{:?}", start.elapsed());
    }
}
