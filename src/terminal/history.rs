//! Undo and redo without limit.

/// A value with its past and the future that was undone.
#[derive(Clone, Debug)]
pub struct History<T> {
    past: Vec<T>,
    present: T,
    future: Vec<T>,
}

impl<T> History<T> {
    /// A history that begins with `present`.
    pub const fn new(present: T) -> Self {
        Self { past: Vec::new(), present, future: Vec::new() }
    }

    /// What holds now.
    pub const fn present(&self) -> &T {
        &self.present
    }

    /// What holds now, to be completed without a step of its own.
    pub const fn present_mut(&mut self) -> &mut T {
        &mut self.present
    }

    /// Makes `next` the present; what was undone is gone.
    pub fn push(&mut self, next: T) {
        self.past.push(std::mem::replace(&mut self.present, next));
        self.future.clear();
    }

    /// One step back; `false` at the beginning.
    pub fn undo(&mut self) -> bool {
        let Some(before) = self.past.pop() else { return false };
        self.future.push(std::mem::replace(&mut self.present, before));
        true
    }

    /// One step forward again; `false` where nothing is undone.
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
    fn undo_and_redo_walk_the_same_way() {
        let mut history = History::new(1);
        history.push(2);
        history.push(3);
        assert!(history.undo() && history.undo() && !history.undo());
        assert_eq!(*history.present(), 1);
        assert!(history.redo());
        assert_eq!(*history.present(), 2);
        history.push(9);
        assert!(!history.redo());
        assert!(history.undo());
        assert_eq!(*history.present(), 2);
    }
}
