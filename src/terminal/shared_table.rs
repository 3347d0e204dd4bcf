//! The view of the coach's table that a player shares: a small file in its own folder, present while the player allows it.
//!
//! Viewers read only that file, and validate everything in it, since somebody else has written it.

use std::{
    fs, io,
    path::Path,
    time::{Duration, SystemTime},
};

use serde::{Deserialize, Serialize};

use crate::{
    coach::Skill,
    game::Rule,
    physics::CueInputs,
    storage::{self, DataPaths, Lock, Player},
    table::{BALLS, CueBall, Layout, Table, is_default},
    terminal::shot::playback::SPEEDS,
};

/// Name of the file.
pub const FILE: &str = "table.json";

/// Largest file that is read, bytes: sixty times the size of a usual one.
const MAX_FILE_BYTES: u64 = 1 << 16;

/// Version of the file format.
const VERSION: u32 = 1;

/// Accepted lengths and widths of a table, and radii of its balls, m: far beyond any table that is built.
const SIDES: std::ops::RangeInclusive<f64> = 0.3..=10.0;
const RADII: std::ops::RangeInclusive<f64> = 0.005..=0.2;

/// Longest name of a table, bytes.
const MAX_NAME_BYTES: usize = 64;

/// What the player is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Activity {
    /// The player is placing the balls.
    Placing,
    /// The coach is thinking.
    Thinking,
    /// A shot is displayed or playing.
    Watching,
    /// The player has another screen open.
    Elsewhere,
}

/// Who proposed a shot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Author {
    /// The coach recommends the shot.
    Coach,
    /// The coach is still searching, and this is its best shot so far.
    Search,
    /// The player's own stroke.
    Player,
}

/// The coach's table as other players see it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SharedTable {
    /// Version of the file format.
    pub version: u32,
    /// What the player is doing.
    pub doing: Activity,
    /// The table.
    pub table: Table,
    /// Positions of the balls before the shot.
    pub layout: Layout,
    /// Which ball is the cue ball.
    #[serde(default, skip_serializing_if = "is_default")]
    pub cue_ball: CueBall,
    /// What counts as a point.
    pub rule: Rule,
    /// Skill of the player.
    pub skill: Skill,
    /// Index of the selected ball in the layout.
    pub selected: usize,
    /// The shot on the table, or `None`.
    pub shot: Option<SharedShot>,
}

/// A shot on a shared table.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SharedShot {
    /// The stroke.
    pub cue: CueInputs,
    /// Who proposed it.
    pub author: Author,
    /// Whether it makes the point if played without errors.
    pub solved: bool,
    /// Number of simulated attempts that make the point and number of all attempts, or `None` if unknown.
    pub made: Option<(usize, usize)>,
    /// Playback position, s since the stroke.
    pub time: f64,
    /// Playback speed, seconds of the shot per second.
    pub speed: f64,
    /// Whether the playback is running.
    pub playing: bool,
    /// Whether the shot has played to its end. The file stores directions in degrees, which changes their last digit: for a viewer the
    /// same shot may end at a slightly different time.
    #[serde(default)]
    pub over: bool,
}

impl SharedShot {
    /// Playback position at the time `since` after the file was written, s since the stroke.
    pub fn time_after(&self, since: Duration) -> f64 {
        self.time + if self.playing { self.speed * since.as_secs_f64() } else { 0.0 }
    }
}

/// What a viewer finds in a player's folder.
#[derive(Clone, Debug)]
pub enum SharedTableState<T> {
    /// No table: the player shows none or is absent. Viewers do not learn which.
    Nothing,
    /// A file that cannot be read.
    Damaged,
    /// A table.
    Table(Box<T>),
}

impl SharedTable {
    /// Creates a view of a table with balls and nothing else. A name that is too long for readers is truncated.
    pub fn new(doing: Activity, mut table: Table, layout: Layout, rule: Rule, skill: Skill) -> Self {
        let is_too_much = |(at, letter): &(usize, char)| at + letter.len_utf8() > MAX_NAME_BYTES;
        if let Some((end, _)) = table.name.char_indices().find(is_too_much) {
            table.name.truncate(end);
        }
        let (cue_ball, selected, shot) = (CueBall::White, 0, None);
        Self { version: VERSION, doing, table, layout, cue_ball, rule, skill, selected, shot }
    }

    /// Whether `now` has to be written for viewers who have seen `self` the time `since` ago. A shot that only plays on does not count as
    /// a change.
    pub fn is_outdated_by(&self, since: Duration, now: &Self) -> bool {
        /// Largest accepted difference between two clocks, seconds of real time.
        const MAX_CLOCK_ERROR: f64 = 0.25;
        let (Some(before), Some(shot)) = (&self.shot, &now.shot) else { return self != now };
        if !(before.playing && shot.playing) {
            return self != now;
        }
        if (shot.time - before.time_after(since)).abs() > MAX_CLOCK_ERROR * shot.speed {
            return true;
        }
        let shot = Some(SharedShot { time: before.time, ..*shot });
        *self != Self { shot, ..now.clone() }
    }

    /// Writes the view into `folder`, where others can read it.
    ///
    /// # Errors
    /// Any error of the file system; the old file then stays.
    pub fn write(&self, folder: &Path) -> io::Result<()> {
        storage::write_atomic_unsynced(&folder.join(FILE), &serde_json::to_vec(self)?)
    }

    /// Reads the view in `folder`, with its age.
    pub fn read(folder: &Path) -> SharedTableState<(Self, Duration)> {
        // A killed process leaves its file behind, but its lock is released.
        if Lock::is_held(folder) == Some(false) {
            return SharedTableState::Nothing;
        }
        let path = folder.join(FILE);
        let written = fs::metadata(&path).and_then(|found| found.modified());
        let age = written.ok().and_then(|written| SystemTime::now().duration_since(written).ok()).unwrap_or_default();
        match storage::read(&path, MAX_FILE_BYTES) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => SharedTableState::Nothing,
            Err(_) => SharedTableState::Damaged,
            Ok(bytes) => match serde_json::from_slice::<Self>(&bytes) {
                Ok(shown) if shown.is_valid() => SharedTableState::Table(Box::new((shown, age))),
                _ => SharedTableState::Damaged,
            },
        }
    }

    /// Whether the view can be drawn. Every value is checked, since somebody else has written the file.
    fn is_valid(&self) -> bool {
        let Self { table, .. } = self;
        let can_be_drawn = SIDES.contains(&table.length)
            && SIDES.contains(&table.width)
            && RADII.contains(&table.radius)
            && table.name.len() <= MAX_NAME_BYTES;
        self.version == VERSION
            && can_be_drawn
            && self.layout.validate(table).is_ok()
            && self.selected < BALLS
            && self.shot.is_none_or(|shot| {
                shot.cue.validate().is_ok()
                    && (0.0..f64::MAX).contains(&shot.time)
                    && SPEEDS.contains(&shot.speed)
                    && shot.made.is_none_or(|(made, of)| made <= of)
            })
    }
}

/// The players of this account who are sharing their table now, sorted by name.
pub fn sharing_players() -> Vec<Player> {
    let Some(folder) = DataPaths::players() else { return Vec::new() };
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let players = entries.filter_map(|entry| entry.file_name().to_str()?.parse::<Player>().ok());
    let is_shown = |player: &Player| {
        DataPaths::of_player(player)
            .is_ok_and(|paths| !matches!(SharedTable::read(&paths.spectator_folder), SharedTableState::Nothing))
    };
    let mut shown: Vec<Player> = players.filter(is_shown).collect();
    shown.sort_by_key(Player::folder);
    shown
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;

    fn shown() -> SharedTable {
        let table = Table::default();
        let layout = Layout::opening(&table);
        let cue = CueInputs::parse("0.2,0.3,6,-72,2.5").unwrap();
        let shot = SharedShot {
            cue,
            author: Author::Coach,
            solved: true,
            made: Some((9, 10)),
            time: 1.0,
            speed: 2.0,
            playing: true,
            over: false,
        };
        let shown = SharedTable::new(Activity::Watching, table, layout, Rule::ThreeCushion, Skill::CLUB);
        SharedTable { shot: Some(shot), selected: 2, ..shown }
    }

    #[test]
    fn a_shared_table_is_visible_while_its_writer_lives() {
        let folder = tempfile::tempdir().unwrap();
        let lock = Lock::try_acquire(folder.path()).unwrap();
        assert!(matches!(SharedTable::read(folder.path()), SharedTableState::Nothing));
        shown().write(folder.path()).unwrap();
        let SharedTableState::Table(found) = SharedTable::read(folder.path()) else { panic!("nothing is seen") };
        let (seen, age) = *found;
        let cue = |shown: &SharedTable| shown.shot.unwrap().cue;
        // Directions are stored in degrees.
        assert!((cue(&seen).phi - cue(&shown()).phi).abs() < 1e-14 && age < Duration::from_secs(60));
        let shot = seen.shot.map(|shot| SharedShot { cue: cue(&shown()), ..shot });
        assert_eq!(SharedTable { shot, ..seen }, shown());
        let size = fs::metadata(folder.path().join(FILE)).unwrap().len();
        assert!((100..MAX_FILE_BYTES / 32).contains(&size), "{size}");
        drop(lock);
        assert!(
            matches!(SharedTable::read(folder.path()), SharedTableState::Nothing),
            "a process that was killed has left it"
        );
    }

    #[test]
    fn only_changes_other_than_playback_progress_are_written() {
        let before = shown();
        let at = |time: f64| {
            let shot = before.shot.map(|shot| SharedShot { time, ..shot });
            SharedTable { shot, ..before.clone() }
        };
        let second = Duration::from_secs(1);
        assert!(!before.is_outdated_by(second, &at(3.0)));
        assert!(before.is_outdated_by(second, &at(1.0)), "it has stood still meanwhile");
        assert!(before.is_outdated_by(second, &SharedTable { selected: 0, ..at(3.0) }));
        let paused = before.shot.map(|shot| SharedShot { time: 3.0, playing: false, ..shot });
        let paused = SharedTable { shot: paused, ..before.clone() };
        assert!(before.is_outdated_by(second, &paused) && !paused.is_outdated_by(second, &paused));
        assert!(before.is_outdated_by(second, &SharedTable { shot: None, ..before.clone() }));
    }

    #[test]
    fn a_long_table_name_is_truncated() {
        let SharedTable { doing, table, layout, rule, skill, .. } = shown();
        let long = Table { name: "당구".repeat(30), ..table };
        let shown = SharedTable::new(doing, long, layout, rule, skill);
        assert!(shown.is_valid() && shown.table.name.len() == 63, "{}", shown.table.name);
    }

    #[test]
    fn values_written_by_others_are_validated() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(FILE);
        let sound = serde_json::to_value(shown()).unwrap();
        let is_seen = |text: &str| {
            fs::write(&path, text).unwrap();
            matches!(SharedTable::read(folder.path()), SharedTableState::Table(..))
        };
        assert!(is_seen(&sound.to_string()));
        let bad: &[(&str, Value)] = &[
            ("/version", json!(2)),
            ("/doing", json!("\u{1b}[2J")),
            ("/table/L", json!(1e9)),
            ("/table/R", json!(1e-6)),
            ("/table/name", json!("a".repeat(65))),
            ("/table/mu_s", json!(0)),
            ("/layout/0/0", json!(99)),
            ("/layout/0/0", Value::Null),
            ("/skill", json!("a=1e999")),
            ("/skill", json!("nobody")),
            ("/selected", json!(3)),
            ("/selected", json!(-1)),
            ("/shot/cue/speed", json!(1e300)),
            ("/shot/cue/a", json!(2)),
            ("/shot/time", json!(-1)),
            ("/shot/speed", json!(1e9)),
            ("/shot/made", json!([11, 10])),
            ("/rule", json!("snooker")),
        ];
        for (place, value) in bad {
            let mut damaged = sound.clone();
            *damaged.pointer_mut(place).unwrap_or_else(|| panic!("{place}")) = value.clone();
            assert!(!is_seen(&damaged.to_string()), "{place} = {value}");
        }
        let text = sound.to_string();
        for text in ["", "{", "null", &"[".repeat(9999), &text.replace("2.5", "1e999"), &text.replace("2.5", "NaN")] {
            assert!(!is_seen(text), "{text:.40}");
        }
        assert!(!is_seen(&format!("{text}{}", " ".repeat(1 << 16))), "a file without an end");
        fs::write(&path, [0xff, 0xfe]).unwrap();
        assert!(matches!(SharedTable::read(folder.path()), SharedTableState::Damaged));
        fs::remove_file(&path).unwrap();
        fs::create_dir(&path).unwrap();
        assert!(matches!(SharedTable::read(folder.path()), SharedTableState::Damaged));
    }
}
