//! The stroke that a player adjusts with keys, with undo and redo.

use std::mem::{Discriminant, discriminant};

use crate::{
    coach::{StrokeText, StrokeTextError},
    physics::{CueInputs, raise_to_clear},
    table::{CueBall, Layout, Table},
    terminal::shot::{History, aiming},
};

/// A change of the stroke.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StrokeChange {
    /// Turns the aim by degrees, to the left if positive.
    Turn(f64),
    /// Aims full at an object ball, with the next press at the other.
    AimAtBall,
    /// Moves the tip by mm to the left and up.
    Tip(f64, f64),
    /// Moves the tip to the centre.
    Centre,
    /// Raises the cue by degrees.
    Raise(f64),
    /// Increases the speed by m/s.
    Faster(f64),
}

/// Prompt for a stroke in words.
pub const STROKE_PROMPT: &str = "your stroke, or what changes of it (red 1/2 right, 1.5 left, 2 up, 3 lengths): ";

/// Longest text of a stroke in words, bytes: the coach's own texts have up to 400.
pub const MAX_TEXT_LENGTH: usize = 600;

/// Why a key does not change the stroke further.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum StrokeLimit {
    /// The tip would slip off.
    #[error("further out the tip would slip off the ball")]
    TipSlips,
    /// The tip would slip off if the cue pointed less towards the centre.
    #[error("with the cue at that angle the tip would slip off the ball: move the tip inwards first")]
    AngleSlips,
    /// The stroke has the highest speed of the keys.
    #[error("this is the hardest stroke that the keys set")]
    Hardest,
    /// The stroke has the lowest speed of the keys.
    #[error("this is the softest stroke that the keys set")]
    Softest,
}

/// The player's stroke and its earlier versions.
#[derive(Clone, Debug)]
pub struct OwnStroke {
    strokes: History<CueInputs>,
    /// Kind of the last change: successive changes of one input count as one undo step.
    changed_by: Option<Discriminant<StrokeChange>>,
}

impl OwnStroke {
    /// Creates a history that starts with this stroke.
    pub const fn new(cue: CueInputs) -> Self {
        Self { strokes: History::new(cue), changed_by: None }
    }

    /// The present stroke.
    pub const fn cue(&self) -> &CueInputs {
        self.strokes.present()
    }

    /// The stroke as it will be played: the cue is raised if rails or balls behind it need that.
    pub fn raised(&self, table: &Table, layout: &Layout) -> CueInputs {
        raise_to_clear(table, layout, self.cue()).unwrap_or(*self.cue())
    }

    /// Changes the stroke.
    ///
    /// # Errors
    /// The change leads beyond a limit; the stroke stays as it is.
    pub fn change(&mut self, change: StrokeChange, table: &Table, layout: &Layout) -> Result<(), StrokeLimit> {
        let cue = *self.cue();
        let next = match change {
            StrokeChange::Turn(degrees) => aiming::turned(&cue, degrees),
            StrokeChange::AimAtBall => aiming::aimed_at_ball(&cue, layout, aiming::next_ball(&cue, layout)),
            StrokeChange::Tip(left, up) => aiming::tip_moved(table, &cue, left, up).ok_or(StrokeLimit::TipSlips)?,
            StrokeChange::Centre => CueInputs { a: 0.0, b: 0.0, ..cue },
            StrokeChange::Raise(degrees) => {
                let now = self.raised(table, layout);
                let next = aiming::raised(&now, degrees);
                if next.is_miscue(table) && !now.is_miscue(table) {
                    return Err(StrokeLimit::AngleSlips);
                }
                next
            }
            StrokeChange::Faster(by) => {
                let limit = if by > 0.0 { StrokeLimit::Hardest } else { StrokeLimit::Softest };
                aiming::faster(&cue, by).ok_or(limit)?
            }
        };
        if next == cue {
            return Ok(());
        }
        let changed_by = Some(discriminant(&change));
        if self.changed_by == changed_by {
            *self.strokes.present_mut() = next;
        } else {
            self.strokes.push(next);
        }
        self.changed_by = changed_by;
        Ok(())
    }

    /// Changes the stroke as described in words by a player with `cue_ball`; what the text does not mention stays.
    ///
    /// # Errors
    /// The text is not understood, or the stroke cannot be played; the stroke stays as it is.
    pub fn apply_text(
        &mut self,
        words: &str,
        table: &Table,
        layout: &Layout,
        cue_ball: CueBall,
    ) -> Result<(), StrokeTextError> {
        let cue = StrokeText::parse(words)?.stroke(table, layout, cue_ball, Some(self.cue()))?;
        self.set(cue);
        Ok(())
    }

    /// Replaces the stroke, as a separate undo step.
    pub fn set(&mut self, cue: CueInputs) {
        if cue != *self.cue() {
            self.strokes.push(cue);
        }
        self.end_undo_step();
    }

    /// Makes the next change a separate undo step.
    pub const fn end_undo_step(&mut self) {
        self.changed_by = None;
    }

    /// Undoes the last change; `false` if there is none.
    pub fn undo(&mut self) -> bool {
        self.end_undo_step();
        self.strokes.undo()
    }

    /// Redoes a change; `false` if none was undone.
    pub fn redo(&mut self) -> bool {
        self.end_undo_step();
        self.strokes.redo()
    }

    /// Whether undo and redo are possible.
    pub const fn can_undo_redo(&self) -> (bool, bool) {
        (self.strokes.can_undo(), self.strokes.can_redo())
    }
}

/// A page's key table with the keys that adjust a stroke: `$before`, aim, tip and speed, `$between`, the other keys, `$after`. `$action`
/// converts a [`StrokeChange`] to the page's action; `$when` is the condition of the keys.
macro_rules! stroke_keys {
    ($action:path, $when:expr, [$($before:expr,)*], [$($between:expr,)*], [$($after:expr,)*]) => {{
        use crossterm::event::KeyCode::{Down, Left, Right, Tab, Up};
        use $crate::terminal::{
            keymap::{Chord, Section::Stroke, bind, key, letter},
            shot::StrokeChange::{AimAtBall, Centre, Faster, Raise, Tip, Turn},
        };
        &[
            $($before,)*
            bind(Stroke, $when, &[key(Left, $action(Turn(0.2))), key(Right, $action(Turn(-0.2)))], Some(("aim", 2)),
                "aim further to the left, to the right, by 0.2 degrees")
                .each(&["aim left by 0.2 degrees", "aim right by 0.2 degrees"]),
            bind(Stroke, $when, &[(Chord::shift(Left), $action(Turn(5.0))), (Chord::shift(Right), $action(Turn(-5.0)))],
                None, "aim further to the left, to the right, by 5 degrees")
                .each(&["aim left by 5 degrees", "aim right by 5 degrees"]),
            bind(Stroke, $when, &[(Chord::ctrl(Left), $action(Turn(0.01))), (Chord::ctrl(Right), $action(Turn(-0.01)))],
                None, "aim further to the left, to the right, by 0.01 degrees")
                .each(&["aim left by 0.01 degrees", "aim right by 0.01 degrees"]),
            bind(Stroke, $when, &[letter('h', $action(Tip(0.5, 0.0))), letter('j', $action(Tip(0.0, -0.5))),
                letter('k', $action(Tip(0.0, 0.5))), letter('l', $action(Tip(-0.5, 0.0)))], Some(("tip", 4)),
                "move the tip to the left, down, up, to the right by 0.5 mm").each(&[
                "move the tip left by 0.5 mm", "move the tip down by 0.5 mm",
                "move the tip up by 0.5 mm", "move the tip right by 0.5 mm",
                ]),
            bind(Stroke, $when, &[letter('H', $action(Tip(3.0, 0.0))), letter('J', $action(Tip(0.0, -3.0))),
                letter('K', $action(Tip(0.0, 3.0))), letter('L', $action(Tip(-3.0, 0.0)))], None,
                "move the tip to the left, down, up, to the right by 3 mm").each(&[
                "move the tip left by 3 mm", "move the tip down by 3 mm",
                "move the tip up by 3 mm", "move the tip right by 3 mm",
                ]),
            bind(Stroke, $when, &[key(Down, $action(Faster(-0.1))), key(Up, $action(Faster(0.1)))], Some(("speed", 2)),
                "strike softer, harder by 0.1 m/s").each(&["strike softer by 0.1 m/s", "strike harder by 0.1 m/s"]),
            bind(Stroke, $when, &[(Chord::shift(Down), $action(Faster(-0.5))), (Chord::shift(Up), $action(Faster(0.5)))],
                None, "strike softer, harder by 0.5 m/s")
                .each(&["strike softer by 0.5 m/s", "strike harder by 0.5 m/s"]),
            $($between,)*
            bind(Stroke, $when, &[key(Tab, $action(AimAtBall))], Some(("at a ball", 1)),
                "aim full at the first object ball, then at the other"),
            bind(Stroke, $when, &[letter('0', $action(Centre))], None, "put the tip in the middle"),
            bind(Stroke, $when, &[letter('-', $action(Raise(-1.0))), letter('+', $action(Raise(1.0))),
                letter('=', $action(Raise(1.0)))], None, "lower, raise the cue by 1 degree")
                .each(&["lower the cue by 1 degree", "raise the cue by 1 degree"]),
            $($after,)*
        ]
    }};
}
pub(in crate::terminal) use stroke_keys;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::game::Point;

    #[test]
    fn successive_changes_of_one_input_are_one_undo_step() {
        let table = Table::default();
        let layout = Layout::opening(&table);
        let first = aiming::first_stroke(Point::default(), &layout);
        let mut stroke = OwnStroke::new(first);
        for _ in 0..3 {
            stroke.change(StrokeChange::Turn(0.2), &table, &layout).unwrap();
        }
        let turned = *stroke.cue();
        stroke.change(StrokeChange::Faster(0.1), &table, &layout).unwrap();
        stroke.end_undo_step();
        stroke.change(StrokeChange::Faster(0.1), &table, &layout).unwrap();
        assert!(stroke.undo() && stroke.undo());
        assert_eq!(*stroke.cue(), turned);
        assert!(stroke.undo() && !stroke.undo());
        assert_eq!(*stroke.cue(), first);
        assert!(stroke.redo());
        assert_eq!((*stroke.cue(), stroke.can_undo_redo()), (turned, (true, true)));
        stroke.change(StrokeChange::Faster(0.2), &table, &layout).unwrap();
        assert!(!stroke.redo() && stroke.undo(), "a new change is followed by no other");
        assert_eq!(*stroke.cue(), turned);
    }

    #[test]
    fn limits_and_empty_changes_leave_the_stroke() {
        let table = Table::default();
        let layout = Layout::opening(&table);
        let mut stroke = OwnStroke::new(aiming::first_stroke(Point::default(), &layout));
        assert_eq!(stroke.change(StrokeChange::Tip(40.0, 0.0), &table, &layout), Err(StrokeLimit::TipSlips));
        stroke.change(StrokeChange::Centre, &table, &layout).unwrap();
        assert_eq!(stroke.can_undo_redo(), (false, false));
        stroke.change(StrokeChange::Faster(9.0), &table, &layout).unwrap();
        assert_eq!(stroke.change(StrokeChange::Faster(0.1), &table, &layout), Err(StrokeLimit::Hardest));
        stroke.change(StrokeChange::Faster(-9.0), &table, &layout).unwrap();
        assert_eq!(stroke.change(StrokeChange::Faster(-0.1), &table, &layout), Err(StrokeLimit::Softest));
    }

    /// A cue raised to 60 degrees may strike the ball far above its middle. With a level one the tip would slip there.
    #[test]
    fn the_cue_is_not_lowered_until_the_tip_slips_and_a_slipping_tip_can_move_inwards() {
        let table = Table::default();
        let layout = Layout::opening(&table);
        let masse =
            CueInputs { b: 0.87, theta: 60_f64.to_radians(), ..aiming::first_stroke(Point::default(), &layout) };
        assert!(!masse.is_miscue(&table));
        let mut stroke = OwnStroke::new(masse);
        let refused = (0..60).find_map(|_| stroke.change(StrokeChange::Raise(-1.0), &table, &layout).err());
        assert_eq!(refused, Some(StrokeLimit::AngleSlips));
        assert!(!stroke.cue().is_miscue(&table) && stroke.cue().theta < masse.theta);
        let mut slipping = OwnStroke::new(CueInputs { theta: 0.2, ..masse });
        assert_eq!(slipping.change(StrokeChange::Tip(0.0, 0.5), &table, &layout), Err(StrokeLimit::TipSlips));
        while slipping.cue().is_miscue(&table) {
            slipping.change(StrokeChange::Tip(0.0, -0.5), &table, &layout).unwrap();
        }
    }
}
