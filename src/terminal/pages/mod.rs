//! The pages of the program. Each folder is one of them: its state, what its keys do, and its view.
//!
//! A page sees itself and a drawing context, never the app. What it wants done outside it says as an
//! [`Effect`](super::effect::Effect).

pub mod calibration;
pub mod coach;
pub mod drills;
pub mod settings;
pub mod training;

use ratatui::layout::{Position, Rect};

use super::{
    Capabilities,
    ui::{TextField, Typed, Ui, geometry::Mapping, message::Message},
};
use crate::{coach::Skill, table::CueBall};

/// How a page is drawn, and what of it answers to the mouse: what its `view` does.
pub trait PageView {
    /// Draws the page; gives what its status line says while nothing is asked.
    fn draw(&self, area: &PageArea, ui: &mut Ui) -> Message;

    /// What it asks before it does something.
    fn asked(&self, caps: Capabilities) -> Option<Asked<'_>>;

    /// What is drawn at a cell of the screen that answers to the mouse.
    fn target(&self, area: &PageArea, at: Position) -> Option<Target>;
}

/// A question that waits for an answer.
#[derive(Debug)]
pub struct Asked<'a> {
    /// The question, without what is typed.
    pub words: Message,
    /// The text that is typed, where some is.
    pub typed: Option<&'a TextField>,
    /// Whether the page has keys of its own for the answer; otherwise it is yes or no, or what is typed.
    pub has_own_keys: bool,
}

impl<'a> Asked<'a> {
    /// A question behind the news that the page has.
    pub fn new(news: Option<&Message>, words: &str, typed: Option<&'a TextField>) -> Self {
        let news = news.map_or(String::new(), |news| format!("{}. ", news.text));
        Self { words: Message::plain(news + words), typed, has_own_keys: false }
    }
}

/// What the app asks of every page. What its keys do is typed: each page has actions of its own.
pub trait Page: PageView {
    /// What the status line says, to be changed.
    fn message_mut(&mut self) -> &mut Option<Message>;

    /// Says why something is refused or has failed; nothing comes of it then.
    fn refuse<T>(&mut self, why: impl ToString) -> Option<T>
    where
        Self: Sized,
    {
        *self.message_mut() = Some(Message::warning(why.to_string()));
        None
    }

    /// The text that is typed, where some is.
    fn field_mut(&mut self) -> Option<&mut TextField>;

    /// Takes what was typed or pasted; `false` where nothing is typed, or the key means something else.
    fn input(&mut self, typed: Typed) -> bool {
        let taken = self.field_mut().is_some_and(|field| field.take(typed));
        if taken {
            *self.message_mut() = None;
        }
        taken
    }

    /// Lets `seconds` pass for whatever moves.
    fn tick(&mut self, _: f64) {}

    /// Seconds until the next picture; `None` while nothing moves by itself.
    fn frame_interval(&self) -> Option<f64> {
        None
    }

    /// The ball that the player plays with.
    fn cue_ball(&self) -> CueBall {
        CueBall::White
    }
}

/// The parts of the screen that are a page's own: all but the tabs and the keys.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PageArea {
    /// The whole screen.
    pub screen: Rect,
    /// What the tabs leave of the first row.
    pub header: Rect,
    /// The rows between.
    pub body: Rect,
    /// The row above the keys; longer sentences grow upwards.
    pub status: Rect,
}

impl PageArea {
    /// The parts of `screen`, with what the tabs leave of its first row.
    pub fn new(screen: Rect, header: Rect) -> Self {
        let body = Rect::new(screen.x, screen.y + 1, screen.width, screen.height.saturating_sub(3));
        Self { screen, header, body, status: Rect { y: body.bottom(), height: 1, ..screen } }
    }
}

/// Something on a page that answers to the mouse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// The cloth of the coach's table.
    Table(Mapping),
    /// A shot that may be chosen, by its place in the list.
    Shot(usize),
    /// A list with a mark, and how many lines the mark is away, down where positive; `None` where there is no line.
    List(Option<isize>),
}

impl Target {
    /// A list whose line `line` is where the mouse is, and whose mark is at the line `mark`.
    pub fn list(line: Option<usize>, mark: usize) -> Self {
        Self::List(line.map(|line| line.cast_signed() - mark.cast_signed()))
    }
}

/// The place `steps` after `from` among `count`, around the end.
const fn around(from: usize, steps: isize, count: usize) -> usize {
    (from.cast_signed() + steps).rem_euclid(count.cast_signed()).cast_unsigned()
}

/// The element `steps` after `from`, around the end; the first where `from` is not among them.
fn neighbour<T: Clone + PartialEq>(all: &[T], from: T, steps: isize) -> T {
    let Some(place) = all.iter().position(|one| *one == from) else { return all.first().cloned().unwrap_or(from) };
    all[around(place, steps, all.len())].clone()
}

/// The next of the players there are: the named ones, the user's `own` skill where one is kept, and that of the settings.
fn next_skill(now: Skill, own: Option<Skill>, set: Skill) -> Skill {
    let mut all: Vec<Skill> = Skill::NAMED.iter().map(|(_, skill)| *skill).collect();
    for skill in own.into_iter().chain([set]) {
        if !all.contains(&skill) {
            all.push(skill);
        }
    }
    neighbour(&all, now, 1)
}
