//! Another player's table in lines, as it changes, for screen readers, pipes and scripts.

use std::{
    io::{self, Write},
    path::Path,
    sync::atomic::{AtomicBool, Ordering},
    thread,
    time::{Duration, Instant},
};

use crate::{
    coach::Units,
    physics::CueInputs,
    printing,
    statistics::SuccessRate,
    table::Layout,
    terminal::{
        plain::speech,
        shared_table::{Activity, Author},
        tasks::table_watcher::{FollowedTable, FollowedTableState, TableWatcher, damage_message},
        words::percent,
    },
};

/// Polling interval.
const INTERVAL: Duration = Duration::from_millis(200);

/// How long a table must stay unchanged before it is described: moving balls need no sentence each.
const QUIET: Duration = Duration::from_millis(600);

/// Describes the table that the player `name` shares in `folder`, until they stop sharing it or `stop` is set. With `json`, writes every
/// change as an object.
///
/// # Errors
/// Any error of the output.
pub fn follow_in_lines(
    name: &str,
    folder: &Path,
    units: Units,
    json: bool,
    stop: &AtomicBool,
    out: &mut impl Write,
) -> io::Result<()> {
    let mut watcher = TableWatcher::new(folder.to_owned());
    let mut describer = Describer { name, units, last: Described::default() };
    let mut waiting: Option<(Box<FollowedTable>, Instant)> = None;
    let mut is_over = false;
    while !is_over {
        is_over = stop.load(Ordering::Relaxed);
        let mut is_damaged = false;
        match watcher.poll() {
            Some(FollowedTableState::Nothing) => is_over = true,
            Some(FollowedTableState::Damaged) => is_damaged = true,
            Some(FollowedTableState::Table(seen)) if json => printing::json_line(out, &seen.shown)?,
            Some(FollowedTableState::Table(seen)) => waiting = Some((seen, Instant::now())),
            None => {}
        }
        let is_due = |(seen, since): &mut (Box<FollowedTable>, Instant)| {
            is_over || is_damaged || since.elapsed() >= QUIET || seen.shown.shot.is_some_and(|shot| shot.playing)
        };
        if let Some((seen, _)) = waiting.take_if(is_due) {
            for line in describer.describe_changes(&seen) {
                writeln!(out, "{line}")?;
            }
        }
        // JSON output contains tables only.
        if is_damaged && !json {
            writeln!(out, "{}", damage_message(name))?;
        }
        out.flush()?;
        if !is_over {
            thread::sleep(INTERVAL);
        }
    }
    Ok(())
}

/// What was described last.
#[derive(Default)]
struct Described {
    scene: String,
    layout: Option<Layout>,
    cue: Option<CueInputs>,
    doing: Option<Activity>,
    plays: bool,
}

/// Describes what has changed.
struct Describer<'a> {
    name: &'a str,
    units: Units,
    last: Described,
}

impl Describer<'_> {
    fn describe_changes(&mut self, seen: &FollowedTable) -> Vec<String> {
        let (name, shown, last) = (self.name, &seen.shown, &mut self.last);
        let mut lines = Vec::new();
        let scene = format!("{name} plays {} on the table {}, as {}.", shown.rule, shown.table.name, shown.skill);
        if last.scene != scene {
            lines.push(scene.clone());
            last.scene = scene;
        }
        if last.doing.replace(shown.doing) != Some(shown.doing) && shown.doing == Activity::Elsewhere {
            lines.push(format!("{name} is at another screen."));
        }
        if last.layout.replace(shown.layout) != Some(shown.layout) {
            let positions = speech::positions(&shown.table, &shown.layout, shown.cue_ball, self.units.length);
            lines.extend(positions.lines().map(str::to_owned));
            last.cue = None;
        }
        let Some((stroke, shot)) = shown.shot.zip(seen.shot.as_ref()) else { return lines };
        let is_settled = shown.doing != Activity::Thinking && stroke.author != Author::Search;
        if is_settled && last.cue.replace(stroke.cue) != Some(stroke.cue) {
            let whose = if stroke.author == Author::Player { "Their own stroke" } else { "The coach recommends" };
            let made = stroke.made.map_or_else(String::new, |(made, of)| {
                format!(" It is made {} percent of the time.", percent(SuccessRate::new(made, of).rate))
            });
            lines.push(format!("{whose}: {}{made}", shot.words.sentence(shown.cue_ball, self.units)));
        }
        let plays = stroke.playing;
        if plays && !last.plays {
            lines.push(format!("{name} plays the shot."));
        }
        if last.plays && !plays && stroke.over {
            let verdict = shot.verdict(shown.rule, &shown.table);
            lines.push(verdict.words(shown.cue_ball, self.units.length));
        }
        last.plays = plays;
        lines
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::{
        coach::Skill,
        game::Rule,
        simulation::Recording,
        table::Table,
        terminal::{
            Shot,
            shared_table::{SharedShot, SharedTable},
        },
    };

    #[test]
    fn a_followed_shot_that_ends_earlier_is_described_to_its_end() {
        let table = Table::default();
        let layout = Layout::opening(&table);
        let cue = CueInputs::parse("0.2,0.3,6,-72,2.5").unwrap();
        let recording = Recording::new(&table, &layout, &cue).unwrap();
        let end = recording.duration().next_down();
        let shot = Arc::new(Shot::of(&table, recording, cue, true, "the coach"));
        let at = |time, playing| {
            let (author, solved, made, speed, over) = (Author::Coach, true, None, 1.0, time == end);
            let stroke = SharedShot { cue, author, solved, made, time, speed, playing, over };
            let shown = SharedTable::new(Activity::Watching, table.clone(), layout, Rule::StraightRail, Skill::CLUB);
            let shown = SharedTable { shot: Some(stroke), ..shown };
            FollowedTable { shown, age: Duration::ZERO, shot: Some(shot.clone()) }
        };
        let mut describer = Describer { name: "anna", units: Units::default(), last: Described::default() };
        assert_eq!(describer.describe_changes(&at(0.0, true)).last().unwrap(), "anna plays the shot.");
        assert!(describer.describe_changes(&at(0.5 * end, false)).is_empty(), "a pause is no end");
        describer.describe_changes(&at(0.5 * end, true));
        let said = describer.describe_changes(&at(end, false));
        assert!(said.len() == 1 && said[0].contains("oint"), "{said:?}");
    }
}
