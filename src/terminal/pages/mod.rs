//! The pages (tabs) of the program. Each folder contains one page: its state, its key actions and its view.
//!
//! A page has access to its own state and a drawing context, never to the app. It requests work outside the page by
//! returning an [`Effect`](super::effect::Effect).

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

/// Drawing and mouse hit-testing of a page. Each page implements it in its `view` module.
pub trait PageView {
    /// Draws the page. Returns the text of the status line, which is shown while no question is open.
    fn draw(&self, area: &PageArea, ui: &mut Ui) -> Message;

    /// The open question that the user must answer before the page continues; `None` if there is none.
    fn open_question(&self, caps: Capabilities) -> Option<OpenQuestion<'_>>;

    /// Returns the mouse target at a screen cell; `None` if that cell does not react to the mouse.
    fn target(&self, area: &PageArea, at: Position) -> Option<Target>;
}

/// A question that waits for an answer.
#[derive(Debug)]
pub struct OpenQuestion<'a> {
    /// The question, without the typed answer.
    pub prompt: Message,
    /// The text field of the answer; `None` if the answer is a single key.
    pub field: Option<&'a TextField>,
    /// Whether the page has its own keys for the answer. Otherwise the answer is yes or no, or the typed text.
    pub has_own_keys: bool,
}

impl<'a> OpenQuestion<'a> {
    /// Creates a question. The page's current message, if any, is put before it.
    pub fn new(message: Option<&Message>, text: &str, field: Option<&'a TextField>) -> Self {
        let prefix = message.map_or(String::new(), |message| format!("{}. ", message.text));
        Self { prompt: Message::plain(prefix + text), field, has_own_keys: false }
    }
}

/// Interface between the app and every page. Key actions are not part of it: each page has its own action type.
pub trait Page: PageView {
    /// The message of the status line, for changing it.
    fn message_mut(&mut self) -> &mut Option<Message>;

    /// Shows the reason of a refusal or failure as a warning. Returns `None`, so that a caller can return it as its result.
    fn refuse<T>(&mut self, why: impl ToString) -> Option<T>
    where
        Self: Sized,
    {
        *self.message_mut() = Some(Message::warning(why.to_string()));
        None
    }

    /// The text field that has the keyboard focus; `None` if there is none.
    fn field_mut(&mut self) -> Option<&mut TextField>;

    /// Passes typed or pasted input to the focused text field. Returns `false` if there is no such field or the key is not for it.
    fn input(&mut self, typed: Typed) -> bool {
        let taken = self.field_mut().is_some_and(|field| field.handle(typed));
        if taken {
            *self.message_mut() = None;
            self.on_typed();
        }
        taken
    }

    /// Handles a change of the typed text.
    fn on_typed(&mut self) {}

    /// Advances the animations of the page by `seconds`.
    fn tick(&mut self, _: f64) {}

    /// Seconds until the next frame; `None` if nothing is animated.
    fn frame_interval(&self) -> Option<f64> {
        None
    }

    /// The player's cue ball.
    fn cue_ball(&self) -> CueBall {
        CueBall::White
    }
}

/// The screen areas of a page: everything except the tabs and the row of keys.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PageArea {
    /// The whole screen.
    pub screen: Rect,
    /// The part of the first row that the tabs leave free.
    pub header: Rect,
    /// The rows between the header and the status line.
    pub body: Rect,
    /// The row above the keys. Longer messages grow upwards from here.
    pub status: Rect,
}

impl PageArea {
    /// Divides `screen`; `header` is the part of its first row that the tabs leave free.
    pub fn new(screen: Rect, header: Rect) -> Self {
        let body = Rect::new(screen.x, screen.y + 1, screen.width, screen.height.saturating_sub(3));
        Self { screen, header, body, status: Rect { y: body.bottom(), height: 1, ..screen } }
    }
}

/// An element of a page that reacts to the mouse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// The cloth of the coach's table.
    Table(Mapping),
    /// A shot that can be chosen, by its index in the list.
    Shot(usize),
    /// A list with a selected line. The value is the offset from the selected line to the mouse, in lines and positive
    /// downwards; `None` if there is no line under the mouse.
    List(Option<isize>),
}

impl Target {
    /// Creates the target of a list from the line under the mouse and the index of the selected line.
    pub fn list(line: Option<usize>, mark: usize) -> Self {
        Self::List(line.map(|line| line.cast_signed() - mark.cast_signed()))
    }
}

/// Returns the index `steps` after `from` in a list of `count` elements, stopping at its ends.
pub(super) fn moved_index(from: usize, steps: isize, count: usize) -> usize {
    from.saturating_add_signed(steps).min(count.saturating_sub(1))
}

/// Returns the index `steps` after `from` in a list of `count` elements, with wrap-around.
const fn wrapping_index(from: usize, steps: isize, count: usize) -> usize {
    (from.cast_signed() + steps).rem_euclid(count.cast_signed()).cast_unsigned()
}

/// Returns the element `steps` after `from`, with wrap-around; the first element if `all` does not contain `from`.
pub(super) fn neighbour<T: Clone + PartialEq>(all: &[T], from: T, steps: isize) -> T {
    let Some(place) = all.iter().position(|one| *one == from) else { return all.first().cloned().unwrap_or(from) };
    all[wrapping_index(place, steps, all.len())].clone()
}

/// Returns the skill after `now` in this order: the named skills, the user's saved `own` skill if there is one, and the skill of
/// the settings.
fn next_skill(now: Skill, own: Option<Skill>, set: Skill) -> Skill {
    let mut all: Vec<Skill> = Skill::NAMED.iter().map(|(_, skill)| *skill).collect();
    for skill in own.into_iter().chain([set]) {
        if !all.contains(&skill) {
            all.push(skill);
        }
    }
    neighbour(&all, now, 1)
}
