//! Undo and redo with a limited number of steps.

/// Most steps kept. A shot takes a tenth of a megabyte, and players do not go back further.
const MAX_STEPS: usize = 200;

/// A value with its earlier versions and the undone ones.
#[derive(Clone, Debug)]
pub struct History<T> {
    past: Vec<T>,
    present: T,
    future: Vec<T>,
}

impl<T> History<T> {
    /// Creates a history that starts with `present`.
    pub const fn new(present: T) -> Self {
        Self { past: Vec::new(), present, future: Vec::new() }
    }

    /// The present value.
    pub const fn present(&self) -> &T {
        &self.present
    }

    /// The present value, to be completed without adding a step.
    pub const fn present_mut(&mut self) -> &mut T {
        &mut self.present
    }

    /// Makes `next` the present value; undone versions are dropped.
    pub fn push(&mut self, next: T) {
        if self.past.len() == MAX_STEPS {
            self.past.remove(0);
        }
        self.past.push(std::mem::replace(&mut self.present, next));
        self.future.clear();
    }

    /// Goes back one step; `false` at the beginning.
    pub fn undo(&mut self) -> bool {
        let Some(before) = self.past.pop() else { return false };
        self.future.push(std::mem::replace(&mut self.present, before));
        true
    }

    /// Goes forward one step; `false` if nothing is undone.
    pub fn redo(&mut self) -> bool {
        let Some(after) = self.future.pop() else { return false };
        self.past.push(std::mem::replace(&mut self.present, after));
        true
    }

    /// Whether a step back is possible.
    pub const fn can_undo(&self) -> bool {
        !self.past.is_empty()
    }

    /// Whether a step forward is possible.
    pub const fn can_redo(&self) -> bool {
        !self.future.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_oldest_undo_steps_are_dropped() {
        let mut history = History::new(0);
        (1..=MAX_STEPS + 5).for_each(|step| history.push(step));
        while history.undo() {}
        assert_eq!((*history.present(), history.future.len()), (5, MAX_STEPS));
    }
}
