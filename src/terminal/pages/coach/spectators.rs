//! Others who look on: what the player lets them see of this table, and the same table as they see it.

use std::{path::PathBuf, sync::Arc};

use crate::{
    statistics::SuccessRate,
    terminal::{
        Advice, AdviceState, CoachQuery, Mode, Proposal,
        pages::coach::{CoachPage, Snapshot},
        shot::History,
        shown::{Author, Doing, ShownShot, ShownTable},
        tasks::onlooker::{Seen, SeenTable, damage_words},
        ui::Message,
    },
};

/// What stands before all that the status line says while others may look on.
const SHOWN: &str = "shown to others";

/// Who else is at the table.
#[derive(Debug)]
pub enum Company {
    /// Nobody.
    Alone,
    /// Others may look on.
    Others,
    /// Somebody whose table it is: it is looked at, and nothing else.
    Host(Followed),
}

/// Somebody else whose table this page shows.
#[derive(Debug)]
pub struct Followed {
    /// Their name.
    pub name: String,
    /// The folder in which they show their table.
    pub folder: PathBuf,
    /// What is seen of it.
    seen: Seen,
}

impl Followed {
    /// Nothing is seen yet.
    pub const fn new(name: String, folder: PathBuf) -> Self {
        Self { name, folder, seen: Seen::Nothing }
    }

    /// Why there is nothing to see; `None` where there is.
    pub fn emptiness(&self) -> Option<String> {
        let name = &self.name;
        match &self.seen {
            Seen::Nothing => {
                Some(format!("{name} shows no table at the moment. It comes back here as soon as they show it again."))
            }
            Seen::Damaged => Some(damage_words(name)),
            Seen::Table(_) => None,
        }
    }

    /// What they do, where a shot does not say it.
    pub fn doing(&self) -> Option<String> {
        let Seen::Table(seen) = &self.seen else { return None };
        let name = &self.name;
        match seen.shown.doing {
            Doing::Placing => Some(format!("{name} places the balls")),
            Doing::Thinking => Some(format!("the coach thinks for {name}")),
            Doing::Elsewhere => Some(format!("{name} is at another screen; this is the table as they have left it")),
            Doing::Watching => seen.shot.is_none().then(|| format!("the shot of {name} cannot be shown here")),
        }
    }
}

impl CoachPage {
    /// Somebody else whose table this is.
    pub const fn followed(&self) -> Option<&Followed> {
        match &self.company {
            Company::Host(followed) => Some(followed),
            _ => None,
        }
    }

    /// Whether others may look on.
    const fn is_shown(&self) -> bool {
        matches!(self.company, Company::Others)
    }

    /// Lets others see the table, or no longer.
    pub(super) fn turn_shown(&mut self) {
        self.company = if self.is_shown() { Company::Alone } else { Company::Others };
        self.message = Some(match (&self.player, self.is_shown()) {
            (Some(player), true) => Message::plain(format!("carom follow {player} shows this table")),
            _ => Message::plain("others can no longer see this table"),
        });
    }

    /// Others see nothing of it from now on.
    pub fn hide(&mut self) {
        self.company = Company::Alone;
        // It said the contrary.
        self.message = None;
    }

    /// What others may see, while they may; where another screen is open, the table as it was left.
    pub fn shown_table(&self, is_open: bool) -> Option<ShownTable> {
        if !self.is_shown() {
            return None;
        }
        let doing = match self.mode {
            _ if !is_open => Doing::Elsewhere,
            _ if self.pending.is_some() => Doing::Thinking,
            Mode::Placing => Doing::Placing,
            Mode::Watching => Doing::Watching,
        };
        let CoachQuery { rule, skill, .. } = self.query;
        let shown = ShownTable::new(doing, self.table().clone(), *self.layout(), rule, skill);
        Some(ShownTable { cue_ball: self.cue_ball(), selected: self.selected, shot: self.shown_shot(), ..shown })
    }

    fn shown_shot(&self) -> Option<ShownShot> {
        let (shot, made, author) = if let Some(own) = self.what_if() {
            (&own.shot, own.made, Author::Player)
        } else {
            let Proposal { shot, made, is_early, .. } = self.proposal()?;
            (shot, *made, if *is_early { Author::Search } else { Author::Coach })
        };
        Some(ShownShot {
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

    /// What the status line says, with a word that others may look on where they may.
    pub(super) fn marked(&self, message: Message) -> Message {
        if self.is_shown() { message.prefixed(SHOWN) } else { message }
    }

    /// Shows the table of somebody else from now on.
    pub fn follow(&mut self, name: String, folder: PathBuf) {
        self.company = Company::Host(Followed::new(name, folder));
    }

    /// Something else is seen of the table that is followed.
    pub fn see(&mut self, seen: Seen) {
        let Company::Host(followed) = &mut self.company else { return };
        followed.seen = seen.clone();
        self.playback.pause();
        if let Seen::Table(seen) = seen {
            self.see_table(*seen);
        }
    }

    fn see_table(&mut self, seen: SeenTable) {
        let SeenTable { shown, age, shot } = seen;
        self.query = CoachQuery { rule: shown.rule, skill: shown.skill, ..self.query.clone() };
        self.selected = shown.selected;
        let table = Arc::new(shown.table);
        let mut snapshot = Snapshot { cue_ball: shown.cue_ball, ..Snapshot::new(table, shown.layout) };
        self.mode = Mode::Placing;
        self.playback.jump(0.0);
        if let Some((shot, told)) = shot.zip(shown.shot) {
            if shown.doing != Doing::Placing {
                self.mode = Mode::Watching;
            }
            self.playback.set_speed(told.speed);
            let duration = shot.recording.duration();
            let time = if told.over { duration } else { told.time_after(age) };
            self.playback.follow(time, duration, told.playing);
            let made = told.made.map(|(made, of)| SuccessRate::new(made, of));
            let is_early = told.author == Author::Search;
            let proposal = Proposal { shot, made, risk: None, next: None, is_early };
            let advice = Advice { proposals: vec![proposal], seed: 1, effort: None, found: None };
            snapshot.advised.extend(AdviceState::new(self.query.clone(), advice));
            // The closer look is the player's own.
            if let Some(advised) = snapshot.advised.first_mut() {
                advised.choices[advised.chosen].is_studied = true;
            }
        }
        self.history = History::new(snapshot);
    }
}
