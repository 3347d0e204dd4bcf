//! Which charts are shown of a run, how, and which part of it.

use crate::{learning::run::quantity::Quantity, terminal::chart::whole};

/// Degrees of smoothing, as shares of the shots that are shown, and the one at the start: what is raw shows behind it.
const SMOOTHING: [f64; 4] = [0.0, 0.01, 0.03, 0.1];
const FIRST_SMOOTHING: usize = 1;
/// Fewest shots that are shown.
const LEAST_SHOTS: f64 = 100.0;
/// A part that follows the end moves by this share of itself at a time: a chart that moves with every line would send
/// kilobytes with each.
const FOLLOW_STEP: f64 = 0.25;
/// Share of the part by which it is moved by hand.
const PAN_STEP: f64 = 0.25;

/// Part of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Part {
    /// Shots from its beginning to its end.
    width: f64,
    /// Its end, unless it follows the end of the run.
    end: Option<f64>,
}

/// Which charts are shown, how, and which part of the run.
#[derive(Debug)]
pub struct Charts {
    shown: [bool; Quantity::COUNT],
    log: [bool; Quantity::COUNT],
    selected: usize,
    enlarged: bool,
    smoothing: usize,
    part: Option<Part>,
}

impl Default for Charts {
    fn default() -> Self {
        let first = |n| n < 4;
        Self {
            shown: std::array::from_fn(first),
            log: [false; Quantity::COUNT],
            selected: 0,
            enlarged: false,
            smoothing: FIRST_SMOOTHING,
            part: None,
        }
    }
}

impl Charts {
    /// The quantities whose charts are drawn, by their places in [`Quantity::ALL`].
    pub fn drawn(&self) -> Vec<usize> {
        if self.enlarged {
            return vec![self.selected];
        }
        (0..Quantity::COUNT).filter(|&n| self.shown[n]).collect()
    }

    /// Whether any chart is shown.
    pub fn any(&self) -> bool {
        self.shown.contains(&true)
    }

    /// Whether this chart is the selected one and there are others.
    pub fn is_selected(&self, n: usize) -> bool {
        n == self.selected && !self.enlarged && self.shown.iter().filter(|shown| **shown).count() > 1
    }

    /// Whether this chart has a logarithmic scale.
    pub const fn is_log(&self, n: usize) -> bool {
        self.log[n]
    }

    /// Over which share of the shots that are shown the curves are smoothed.
    pub const fn smoothing(&self) -> f64 {
        SMOOTHING[self.smoothing]
    }

    /// Whether only a part of the run is shown.
    pub const fn is_part(&self) -> bool {
        self.part.is_some()
    }

    /// Shows the chart of a quantity and selects it, or hides it.
    pub fn toggle(&mut self, n: usize) {
        self.shown[n] = !self.shown[n];
        self.enlarged = false;
        if self.shown[n] {
            self.selected = n;
        } else if n == self.selected {
            self.select(1);
        }
    }

    /// Selects another of the charts, the next where positive.
    pub fn select(&mut self, steps: isize) {
        let all: Vec<usize> = (0..Quantity::COUNT).filter(|&n| self.shown[n]).collect();
        // The first one beyond where the selected one has just been hidden.
        let place = match all.iter().position(|&n| n == self.selected) {
            Some(place) => around(place, steps, all.len()),
            None => all.iter().position(|&n| n > self.selected).unwrap_or(0),
        };
        if let Some(&n) = all.get(place) {
            self.selected = n;
        }
    }

    /// Enlarges the selected chart, or shows all again.
    pub const fn enlarge(&mut self) {
        self.enlarged = !self.enlarged;
    }

    /// Draws the selected chart on a logarithmic scale, or not.
    pub const fn toggle_log(&mut self) {
        self.log[self.selected] = !self.log[self.selected];
    }

    /// Takes the next degree of smoothing.
    pub const fn smooth(&mut self) {
        self.smoothing = (self.smoothing + 1) % SMOOTHING.len();
    }

    /// The shots that are shown of a run that has played `shots` of `planned`.
    pub fn range(&self, shots: u64, planned: Option<u64>) -> (f64, f64) {
        let all = whole(shots, planned);
        let Some(Part { width, end }) = self.part else { return all };
        let step = FOLLOW_STEP * width;
        let end = end.unwrap_or_else(|| (shots as f64 / step).ceil() * step).max(all.0 + width);
        (end - width, end)
    }

    /// Shows half as many shots, or twice as many where negative: around the end while that is followed, else around
    /// the middle.
    pub fn zoom(&mut self, steps: isize, shots: u64, planned: Option<u64>) {
        let (all, (from, to)) = (whole(shots, planned), self.range(shots, planned));
        let width = if steps > 0 { 0.5 * (to - from) } else { 2.0 * (to - from) }.max(LEAST_SHOTS);
        if width >= all.1 - all.0 {
            self.part = None;
            return;
        }
        let is_moved = self.part.is_some_and(|part| part.end.is_some());
        let end = is_moved.then(|| (0.5 * (from + to + width)).clamp(all.0 + width, all.1));
        self.part = Some(Part { width, end });
    }

    /// Shows later shots, or earlier ones where negative.
    pub fn pan(&mut self, steps: isize, shots: u64, planned: Option<u64>) {
        let (all, (_, to)) = (whole(shots, planned), self.range(shots, planned));
        if let Some(part) = &mut self.part {
            let end = to + steps as f64 * PAN_STEP * part.width;
            part.end = Some(end.min(all.1).max(all.0 + part.width));
        }
    }

    /// Shows all of the run.
    pub const fn show_all(&mut self) {
        self.part = None;
    }

    /// Follows the end of the run.
    pub const fn follow_end(&mut self) {
        if let Some(part) = &mut self.part {
            part.end = None;
        }
    }
}

/// The place `steps` after `from` among `count`, around the end.
pub fn around(from: usize, steps: isize, count: usize) -> usize {
    (from.cast_signed() + steps).rem_euclid(count.cast_signed()).cast_unsigned()
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLANNED: Option<u64> = Some(1_000_000);

    #[test]
    fn zooming_follows_the_end_until_somebody_moves_the_part() {
        let mut charts = Charts::default();
        let all = charts.range(700_000, PLANNED);
        charts.zoom(1, 700_000, PLANNED);
        charts.zoom(1, 700_000, PLANNED);
        let (from, to) = charts.range(700_000, PLANNED);
        assert!((4.0 * (to - from) - (all.1 - all.0)).abs() < 1e-6);
        assert!(from < 700_000.0 && to >= 700_000.0, "{from} {to}");
        let later = charts.range(to as u64 + 1, PLANNED);
        assert!(later.1 > to && later.0 > from, "it moves on with the run");
        charts.pan(-1, 700_000, PLANNED);
        let moved = charts.range(700_000, PLANNED);
        assert_eq!(moved, charts.range(900_000, PLANNED), "it stays where it was put");
        let middle = 0.5 * (moved.0 + moved.1);
        charts.zoom(1, 900_000, PLANNED);
        let (from, to) = charts.range(900_000, PLANNED);
        assert!((0.5 * (from + to) - middle).abs() < 1e-6);
        charts.follow_end();
        assert!(charts.range(900_000, PLANNED).1 >= 900_000.0);
        for _ in 0..9 {
            charts.zoom(-1, 900_000, PLANNED);
        }
        assert!(!charts.is_part());
    }

    #[test]
    fn a_part_that_follows_the_end_moves_in_steps() {
        let mut charts = Charts::default();
        for _ in 0..4 {
            charts.zoom(1, 700_000, PLANNED);
        }
        let ranges: Vec<_> = (700_000..800_000).step_by(500).map(|shots| charts.range(shots, PLANNED)).collect();
        let moves = ranges.windows(2).filter(|pair| pair[0] != pair[1]).count();
        assert!((1..=10).contains(&moves), "{moves}");
    }

    #[test]
    fn the_part_never_leaves_the_run() {
        let mut charts = Charts::default();
        charts.zoom(1, 10, PLANNED);
        for steps in [-1, -1, -1, -1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1] {
            charts.pan(steps, 500_000, PLANNED);
            let (from, to) = charts.range(500_000, PLANNED);
            assert!(from >= 0.0 && to <= whole(500_000, PLANNED).1 && from < to, "{from} {to}");
        }
    }

    #[test]
    fn a_hidden_chart_is_not_selected() {
        let mut charts = Charts::default();
        charts.toggle(0);
        assert!(charts.is_selected(1) && !charts.is_selected(0));
        for n in [1, 2, 3] {
            charts.toggle(n);
        }
        assert!(!charts.any() && charts.drawn().is_empty());
        charts.toggle(7);
        charts.enlarge();
        assert_eq!(charts.drawn(), [7]);
    }
}
