//! Spectators: sharing this table with others, and showing the shared table of another player.

use std::{path::PathBuf, sync::Arc};

use crate::{
    statistics::SuccessRate,
    terminal::{
        Advice, AdviceState, CoachQuery, Mode, Proposal,
        pages::coach::{CoachPage, Snapshot},
        shared_table::{Activity, Author, SharedShot, SharedTable},
        shot::History,
        tasks::table_watcher::{FollowedTable, FollowedTableState, damage_message},
        ui::Message,
    },
};

/// Prefix of the status line while the table is shared.
const SHARED_PREFIX: &str = "shown to others";

/// Sharing state of the table.
#[derive(Debug)]
pub enum Sharing {
    /// The table is private.
    Private,
    /// The table is shared with spectators.
    Shared,
    /// The page shows the table of another player, read-only.
    Following(FollowedPlayer),
}

/// Another player whose table this page shows.
#[derive(Debug)]
pub struct FollowedPlayer {
    /// The other player's name.
    pub name: String,
    /// The folder in which the other player's program writes the shared table.
    pub folder: PathBuf,
    /// The latest state of the shared table.
    seen: FollowedTableState,
}

impl FollowedPlayer {
    /// The reason why there is no table to show; `None` if there is one.
    pub fn empty_reason(&self) -> Option<String> {
        let name = &self.name;
        match &self.seen {
            FollowedTableState::Nothing => {
                Some(format!("{name} shows no table at the moment. It appears here once they show it again."))
            }
            FollowedTableState::Damaged => Some(damage_message(name)),
            FollowedTableState::Table(_) => None,
        }
    }

    /// A sentence on what the other player is doing; `None` if the displayed shot makes that clear.
    pub fn activity_words(&self) -> Option<String> {
        let FollowedTableState::Table(seen) = &self.seen else { return None };
        let name = &self.name;
        match seen.shown.doing {
            Activity::Placing => Some(format!("{name} places the balls")),
            Activity::Thinking => Some(format!("the coach thinks for {name}")),
            Activity::Elsewhere => Some(format!("{name} is at another screen; this is the table as they have left it")),
            Activity::Watching if seen.shot.is_none() => Some(format!("the shot of {name} cannot be shown here")),
            Activity::Watching => {
                let is_own = seen.shown.shot.is_some_and(|shot| shot.author == Author::Player);
                is_own.then(|| format!("{name}'s own stroke, not the coach's shot"))
            }
        }
    }
}

impl CoachPage {
    /// The player whose table this page follows; `None` if the table is the user's own.
    pub const fn followed(&self) -> Option<&FollowedPlayer> {
        match &self.sharing {
            Sharing::Following(followed) => Some(followed),
            _ => None,
        }
    }

    /// Whether the table is shared with spectators.
    const fn is_shared(&self) -> bool {
        matches!(self.sharing, Sharing::Shared)
    }

    /// Starts or stops sharing the table with spectators.
    pub(super) fn toggle_sharing(&mut self) {
        self.sharing = if self.is_shared() { Sharing::Private } else { Sharing::Shared };
        self.message = Some(match (&self.player, self.is_shared()) {
            (Some(player), true) => Message::plain(format!("carom follow {player} shows this table")),
            _ => Message::plain("others can no longer see this table"),
        });
    }

    /// Stops sharing the table.
    pub fn stop_sharing(&mut self) {
        self.sharing = Sharing::Private;
        // The message may say that the table is shared.
        self.message = None;
    }

    /// The state that spectators see; `None` if the table is not shared. `is_open` tells whether this page is the open one; otherwise
    /// spectators see the table as the player has left it.
    pub fn shared_table(&self, is_open: bool) -> Option<SharedTable> {
        if !self.is_shared() {
            return None;
        }
        let doing = match self.mode {
            _ if !is_open => Activity::Elsewhere,
            _ if self.pending.is_some() => Activity::Thinking,
            Mode::Placing => Activity::Placing,
            Mode::Watching => Activity::Watching,
        };
        let CoachQuery { rule, skill, .. } = self.query;
        let shown = SharedTable::new(doing, self.table().clone(), *self.layout(), rule, skill);
        Some(SharedTable { cue_ball: self.cue_ball(), selected: self.selected, shot: self.shared_shot(), ..shown })
    }

    fn shared_shot(&self) -> Option<SharedShot> {
        let (shot, made, author) = if let Some(own) = self.what_if() {
            (&own.shot, own.made, Author::Player)
        } else {
            let Proposal { shot, made, is_early, .. } = self.proposal()?;
            (shot, *made, if *is_early { Author::Search } else { Author::Coach })
        };
        Some(SharedShot {
            cue: shot.cue,
            author,
            solved: shot.solved,
            made: made.map(|made| (made.successes, made.trials)),
            time: self.playback.time,
            speed: self.playback.speed(),
            playing: self.playback.playing,
            over: self.playback.time >= shot.recording.duration(),
        })
    }

    /// The message of the status line, with a prefix while the table is shared.
    pub(super) fn with_sharing_prefix(&self, message: Message) -> Message {
        if self.is_shared() { message.prefixed(SHARED_PREFIX) } else { message }
    }

    /// Switches the page to the shared table of another player.
    pub fn follow(&mut self, name: String, folder: PathBuf) {
        self.sharing = Sharing::Following(FollowedPlayer { name, folder, seen: FollowedTableState::Nothing });
    }

    /// Handles a new state of the followed table.
    pub fn receive_shared(&mut self, seen: FollowedTableState) {
        let Sharing::Following(followed) = &mut self.sharing else { return };
        followed.seen = seen.clone();
        self.playback.pause();
        if let FollowedTableState::Table(seen) = seen {
            self.show_shared_table(*seen);
        }
    }

    fn show_shared_table(&mut self, seen: FollowedTable) {
        let FollowedTable { shown, age, shot } = seen;
        self.query = CoachQuery { rule: shown.rule, skill: shown.skill, ..self.query.clone() };
        self.selected = shown.selected;
        let table = Arc::new(shown.table);
        let mut snapshot = Snapshot { cue_ball: shown.cue_ball, ..Snapshot::new(table, shown.layout) };
        self.mode = Mode::Placing;
        self.playback.seek(0.0);
        if let Some((shot, shared_shot)) = shot.zip(shown.shot) {
            if shown.doing != Activity::Placing {
                self.mode = Mode::Watching;
            }
            self.playback.set_speed(shared_shot.speed);
            let duration = shot.recording.duration();
            let time = if shared_shot.over { duration } else { shared_shot.time_after(age) };
            self.playback.follow(time, duration, shared_shot.playing);
            let made = shared_shot.made.map(|(made, of)| SuccessRate::new(made, of));
            let is_early = shared_shot.author == Author::Search;
            let proposal = Proposal { shot, made, risk: None, next: None, is_early };
            let advice = Advice { proposals: vec![proposal], seed: 1, effort: None, found: None };
            snapshot.advised.extend(AdviceState::new(self.query.clone(), advice));
            // Only the other player's own program analyses the shot.
            if let Some(advised) = snapshot.advised.first_mut() {
                advised.choices[advised.chosen].is_analysed = true;
            }
        }
        self.history = History::new(snapshot);
    }
}
