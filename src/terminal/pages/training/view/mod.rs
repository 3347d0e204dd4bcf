//! The training screen: the list of runs, the form for a new one, and a run as it learns.

mod charts;
mod form;
mod header;
mod numbers;
mod panes;
mod replay;
mod runs;

use ratatui::layout::{Position, Rect};

use crate::{
    table::Table,
    terminal::{
        Capabilities, TrainingContext,
        pages::{
            Asked, PageArea, PageView, Target,
            training::{TrainingPage, view::panes::Panes},
        },
        ui::{Message, Ui},
    },
};

impl PageView for TrainingPage {
    fn draw(&self, area: &PageArea, ui: &mut Ui) -> Message {
        let (head, body) = (area.header, area.body);
        let status_line = match (self.page(), &self.watch) {
            (TrainingContext::Watch, Some(watch)) => {
                header::draw(watch, head, ui);
                // A table has the same shape everywhere, so that nothing jumps when the run's own is known.
                let panes = Panes::new(watch.table().unwrap_or(&Table::default()), body);
                charts::draw(watch, panes.charts, ui);
                numbers::draw(self, watch, panes.numbers, ui);
                replay::draw(watch, panes.replay, ui);
                let (sentence, is_bad) = watch.advice();
                if is_bad { Message::warning(sentence) } else { Message::plain(sentence) }
            }
            (TrainingContext::Form, _) => {
                title("a new run", head, ui);
                form::draw(self, body, ui);
                Message::plain(form::status_line(self))
            }
            (open, _) => {
                let words = if open == TrainingContext::Compare { "compare with" } else { "training runs" };
                title(words, head, ui);
                runs::draw(self, body, ui);
                runs::status_line(self)
            }
        };
        self.message.clone().unwrap_or(status_line)
    }

    fn asked(&self, _: Capabilities) -> Option<Asked<'_>> {
        let question = self.question.as_ref()?;
        let asked = Asked::new(self.message.as_ref(), &question.text(self.watch.as_ref()), question.field());
        Some(Asked { words: Message::warning(asked.words.text), ..asked })
    }

    fn target(&self, area: &PageArea, at: Position) -> Option<Target> {
        match self.page() {
            TrainingContext::Runs | TrainingContext::Compare => runs::target(self, area.body, at),
            _ => None,
        }
    }
}

/// The first row of the pages that show no run.
fn title(words: &str, area: Rect, ui: &mut Ui) {
    ui.buffer.set_stringn(area.x + 1, area.y, words, usize::from(area.width.saturating_sub(1)), ui.theme.text());
}
