//! The view of the training page: the list of runs, the form for a new run, and a watched run.

mod charts;
mod form;
mod header;
mod numbers;
mod panes;
mod replay;
mod runs;

use ratatui::{layout::Position, text::Span};

use crate::{
    table::Table,
    terminal::{
        Capabilities, TrainingContext,
        pages::{
            OpenQuestion, PageArea, PageView, Target,
            training::{TrainingPage, view::panes::Panes},
        },
        ui::{Message, Ui, draw_header},
    },
};

impl PageView for TrainingPage {
    fn draw(&self, area: &PageArea, ui: &mut Ui) -> Message {
        let (head, body) = (area.header, area.body);
        let status_line = match (self.page(), &self.watch) {
            (TrainingContext::Watch, Some(watch)) => {
                header::draw(watch, head, ui);
                // All tables have the same shape, so the layout does not change when the run's own table becomes known.
                let panes = Panes::new(watch.table().unwrap_or(&Table::default()), body);
                charts::draw(watch, panes.charts, ui);
                numbers::draw(self, watch, panes.numbers, ui);
                replay::draw(watch, panes.replay, ui);
                let (sentence, is_bad) = watch.advice();
                if is_bad { Message::warning(sentence) } else { Message::plain(sentence) }
            }
            (TrainingContext::Form, _) => {
                draw_header("a new run", "", &Span::default(), head, ui);
                form::draw(self, body, ui);
                Message::plain(form::status_line(self))
            }
            (open, _) => {
                let words = if open == TrainingContext::Compare { "compare with" } else { "training runs" };
                draw_header(words, "", &Span::default(), head, ui);
                runs::draw(self, body, ui);
                runs::status_line(self)
            }
        };
        self.message.clone().unwrap_or(status_line)
    }

    fn open_question(&self, _: Capabilities) -> Option<OpenQuestion<'_>> {
        let question = self.question.as_ref()?;
        let asked = OpenQuestion::new(self.message.as_ref(), &question.text(self.watch.as_ref()), question.field());
        Some(OpenQuestion { prompt: Message::warning(asked.prompt.text), ..asked })
    }

    fn target(&self, area: &PageArea, at: Position) -> Option<Target> {
        match self.page() {
            TrainingContext::Runs | TrainingContext::Compare => runs::target(self, area.body, at),
            _ => None,
        }
    }
}
