//! State of a run's charts: the shown quantities, their scales and smoothing, and the shown range of the run.

use crate::{
    learning::run::quantity::Quantity,
    terminal::{pages::wrapping_index, ui::chart::whole},
};

/// Widths of the smoothing, as fractions of the shown range, and the index of the default. The raw values are visible behind the
/// smoothed curve.
const SMOOTHING: [f64; 4] = [0.0, 0.01, 0.03, 0.1];
const DEFAULT_SMOOTHING: usize = 1;
/// Minimum width of the shown range, shots.
const MIN_SHOTS: f64 = 100.0;
/// A range that follows the end moves in steps of this fraction of its width. If it moved with every new record of the run, each
/// would send kilobytes to the terminal.
const FOLLOW_STEP: f64 = 0.25;
/// Minimum width of a range that follows the end, as a fraction of the whole run. A narrower one would move with every new record.
const MIN_VIEW: f64 = 1.0 / 32.0;
/// The reason why a range that follows the end cannot become narrower.
const ZOOM_REFUSAL: &str = "no narrower view follows the run; Left holds it still, then + shows less";
/// Fraction of the shown range by which panning moves it.
const PAN_STEP: f64 = 0.25;

/// Progress of a run, for the range of the charts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Progress {
    /// Shots played.
    pub shots: u64,
    /// Planned shots, if known.
    pub planned: Option<u64>,
}

/// A part of a run as the shown range.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Part {
    /// Width, shots.
    width: f64,
    /// End, shots; `None` if the part follows the end of the run.
    end: Option<f64>,
}

/// State of a run's charts.
#[derive(Debug)]
pub struct Charts {
    shown: [bool; Quantity::COUNT],
    /// Whether each chart has a logarithmic scale.
    pub log: [bool; Quantity::COUNT],
    selected: usize,
    /// Whether only the selected chart is drawn, enlarged.
    pub enlarged: bool,
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
            smoothing: DEFAULT_SMOOTHING,
            part: None,
        }
    }
}

impl Charts {
    /// The indices in [`Quantity::ALL`] of the quantities whose charts are drawn.
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

    /// Whether chart `n` must be marked as selected: it is selected and not the only one.
    pub fn is_selected(&self, n: usize) -> bool {
        n == self.selected && !self.enlarged && self.shown.iter().filter(|shown| **shown).count() > 1
    }

    /// Width of the smoothing, as a fraction of the shown range.
    pub const fn smoothing(&self) -> f64 {
        SMOOTHING[self.smoothing]
    }

    /// Whether only a part of the run is shown.
    pub const fn is_zoomed(&self) -> bool {
        self.part.is_some()
    }

    /// Shows and selects the chart of a quantity, or hides it.
    pub fn toggle(&mut self, n: usize) {
        self.shown[n] = !self.shown[n];
        self.enlarged = false;
        if self.shown[n] {
            self.selected = n;
        } else if n == self.selected {
            self.select(1);
        }
    }

    /// Cycles the selection through the shown charts, forwards if positive.
    pub fn select(&mut self, steps: isize) {
        let all: Vec<usize> = (0..Quantity::COUNT).filter(|&n| self.shown[n]).collect();
        // If the selected chart has just been hidden, select the first one after it.
        let place = match all.iter().position(|&n| n == self.selected) {
            Some(place) => wrapping_index(place, steps, all.len()),
            None => all.iter().position(|&n| n > self.selected).unwrap_or(0),
        };
        if let Some(&n) = all.get(place) {
            self.selected = n;
        }
    }

    /// Turns the logarithmic scale of the selected chart on or off.
    pub const fn toggle_log(&mut self) {
        self.log[self.selected] = !self.log[self.selected];
    }

    /// Chooses the next width of the smoothing.
    pub const fn smooth(&mut self) {
        self.smoothing = (self.smoothing + 1) % SMOOTHING.len();
    }

    /// The shown range of a run, shots.
    pub fn range(&self, progress: Progress) -> (f64, f64) {
        let all = whole(progress.shots, progress.planned);
        let Some(Part { width, end }) = self.part else { return all };
        if let Some(end) = end {
            return (end - width, end);
        }
        let width = width.max(MIN_VIEW * (all.1 - all.0));
        if width >= all.1 - all.0 {
            return all;
        }
        let step = FOLLOW_STEP * width;
        let end = ((progress.shots as f64 / step).ceil() * step).clamp(all.0 + width, all.1);
        (end - width, end)
    }

    /// Halves the shown range, or doubles it if negative: around the end if the range follows it, else around the middle.
    ///
    /// # Errors
    /// Returns a message if the range cannot become narrower.
    pub fn zoom(&mut self, steps: isize, progress: Progress) -> Result<(), &'static str> {
        let (all, (from, to)) = (whole(progress.shots, progress.planned), self.range(progress));
        let is_moved = self.part.is_some_and(|part| part.end.is_some());
        let width = if steps > 0 {
            let least = if is_moved { MIN_SHOTS } else { MIN_SHOTS.max(MIN_VIEW * (all.1 - all.0)) };
            let width = (0.5 * (to - from)).max(least);
            if width >= to - from {
                return Err(if least > MIN_SHOTS { ZOOM_REFUSAL } else { "this is the closest zoom" });
            }
            width
        } else {
            2.0 * (to - from)
        };
        if width >= all.1 - all.0 {
            self.part = None;
            return Ok(());
        }
        let end = is_moved.then(|| (0.5 * (from + to + width)).clamp(all.0 + width, all.1));
        self.part = Some(Part { width, end });
        Ok(())
    }

    /// Moves the shown range to later shots, or to earlier ones if negative.
    pub fn pan(&mut self, steps: isize, progress: Progress) {
        let (all, (from, to)) = (whole(progress.shots, progress.planned), self.range(progress));
        if let Some(part) = &mut self.part {
            // Keep the visible width: a range that follows a growing run is wider than the chosen width.
            part.width = to - from;
            let end = to + steps as f64 * PAN_STEP * part.width;
            part.end = Some(end.min(all.1).max(all.0 + part.width));
        }
    }

    /// Shows all of the run.
    pub const fn show_all(&mut self) {
        self.part = None;
    }

    /// Makes the shown range follow the end of the run.
    pub const fn follow_end(&mut self) {
        if let Some(part) = &mut self.part {
            part.end = None;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(shots: u64) -> Progress {
        Progress { shots, planned: Some(1_000_000) }
    }

    #[test]
    fn zoomed_range_follows_the_end_until_panned() {
        let mut charts = Charts::default();
        let all = charts.range(at(700_000));
        charts.zoom(1, at(700_000)).unwrap();
        charts.zoom(1, at(700_000)).unwrap();
        let (from, to) = charts.range(at(700_000));
        assert!((4.0 * (to - from) - (all.1 - all.0)).abs() < 1e-6);
        assert!(from < 700_000.0 && to >= 700_000.0, "{from} {to}");
        let later = charts.range(at(to as u64 + 1));
        assert!(later.1 > to && later.0 > from, "it moves on with the run");
        charts.pan(-1, at(700_000));
        let moved = charts.range(at(700_000));
        assert_eq!(moved, charts.range(at(900_000)), "it stays where it was put");
        let middle = 0.5 * (moved.0 + moved.1);
        charts.zoom(1, at(900_000)).unwrap();
        let (from, to) = charts.range(at(900_000));
        assert!((0.5 * (from + to) - middle).abs() < 1e-6);
        charts.follow_end();
        assert!(charts.range(at(900_000)).1 >= 900_000.0);
        for _ in 0..9 {
            charts.zoom(-1, at(900_000)).unwrap();
        }
        assert!(!charts.is_zoomed());
    }

    #[test]
    fn following_range_moves_in_steps() {
        let mut charts = Charts::default();
        for _ in 0..4 {
            charts.zoom(1, at(700_000)).unwrap();
        }
        let ranges: Vec<_> = (700_000..800_000).step_by(500).map(|shots| charts.range(at(shots))).collect();
        let moves = ranges.windows(2).filter(|pair| pair[0] != pair[1]).count();
        assert!((1..=10).contains(&moves), "{moves}");
    }

    #[test]
    fn following_range_has_a_minimum_width() {
        let mut charts = Charts::default();
        let refused = (0..30).find_map(|_| charts.zoom(1, at(700_000)).err());
        assert_eq!(refused, Some(ZOOM_REFUSAL));
        let (from, to) = charts.range(at(700_000));
        assert!((to - from - 31_250.0).abs() < 1e-6, "{from} {to}");
        charts.pan(-1, at(700_000));
        charts.zoom(1, at(700_000)).unwrap();
        let held = charts.range(at(700_000));
        assert!(held.1 - held.0 < 0.6 * (to - from), "a part that does not move may be narrow");
        charts.follow_end();
        assert_eq!(charts.range(at(700_000)), (from, to));
    }

    #[test]
    fn range_stays_within_the_run() {
        let mut charts = Charts::default();
        charts.zoom(1, at(10)).unwrap();
        for steps in [-1, -1, -1, -1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1] {
            charts.pan(steps, at(500_000));
            let (from, to) = charts.range(at(500_000));
            assert!(from >= 0.0 && to <= whole(500_000, Some(1_000_000)).1 && from < to, "{from} {to}");
        }
    }

    #[test]
    fn hidden_chart_is_not_selected() {
        let mut charts = Charts::default();
        charts.toggle(0);
        assert!(charts.is_selected(1) && !charts.is_selected(0));
        for n in [1, 2, 3] {
            charts.toggle(n);
        }
        assert!(!charts.any() && charts.drawn().is_empty());
        charts.toggle(7);
        charts.enlarged = true;
        assert_eq!(charts.drawn(), [7]);
    }
}
