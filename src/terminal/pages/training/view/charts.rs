//! The charts of a watched run and of the run to compare with.

use ratatui::{layout::Rect, text::Line};

use crate::{
    learning::run::{follow::Followed, quantity::Quantity},
    terminal::{
        pages::training::{Watch, view::panes::grid},
        ui::{
            Ui,
            chart::{Chart, Curve, CurveRole, draw_chart},
        },
    },
};

/// Draws the chosen charts.
pub fn draw(watch: &Watch, area: Rect, ui: &mut Ui) {
    let charts = &watch.charts;
    let shots = charts.range(watch.progress());
    let range = shots.0..=shots.1;
    let drawn = charts.drawn();
    if drawn.is_empty() {
        let words = "No chart is shown; 1 to 9 show some, ? lists them.";
        let line = Line::styled(words, ui.theme.faint());
        ui.buffer.set_line(area.x + 3, area.y + 1, &line, area.width.saturating_sub(4));
        return;
    }
    for (&n, (place, is_last)) in drawn.iter().zip(grid(drawn.len(), area)) {
        let quantity = Quantity::ALL[n];
        let title = title(n, watch);
        let points = |run: &Followed| run.history.points(quantity, range.clone());
        let own = points(&watch.own.run);
        let other = watch.other.as_ref().map(|other| points(&other.run));
        let mut curves = Vec::new();
        if let (Some(other), Some(points)) = (&watch.other, &other) {
            curves.push(Curve {
                points,
                non_finite: other.run.history.non_finite(quantity),
                role: CurveRole::Compared,
            });
        }
        curves.push(Curve {
            points: &own,
            non_finite: watch.own.run.history.non_finite(quantity),
            role: CurveRole::Main,
        });
        let chart = Chart {
            title: &title,
            curves: &curves,
            shots,
            values: None,
            log: charts.log[n],
            smoothing: charts.smoothing(),
            selected: charts.is_selected(n),
            with_shots: is_last,
            unit: "shots",
            note: missing(&watch.own.run, quantity),
        };
        draw_chart(&chart, place, ui);
    }
}

/// The reason why a run that has reported something has no values of a quantity; `None` if there is no such reason.
fn missing(run: &Followed, quantity: Quantity) -> Option<&'static str> {
    let last = run.history.last()?;
    match quantity {
        Quantity::HeldOut | Quantity::BestOfK if run.history.best().is_none() => {
            Some("comes with the next measurement")
        }
        Quantity::ActorLoss if last.actor_loss.is_none() => Some("this agent reports none"),
        Quantity::Exploration if last.exploration.is_none() => Some("the run does not report it"),
        _ => None,
    }
}

/// The title of chart `n`: its key and quantity. The held-out measurement is called a reward if the run's reward is not success or failure.
fn title(n: usize, watch: &Watch) -> String {
    let quantity = Quantity::ALL[n];
    let name =
        if quantity == Quantity::HeldOut && !watch.own.is_success_rate() { "held-out reward" } else { quantity.name() };
    format!("{} {name}", n + 1)
}
