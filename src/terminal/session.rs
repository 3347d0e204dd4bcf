//! The terminal while the program has it: taken over, given back as it was found, whatever ends the program.

use std::{
    cell::RefCell,
    fs::File,
    io::{self, IsTerminal, Write},
    os::fd::AsFd,
    panic,
    rc::Rc,
    thread,
};

use crossterm::{
    cursor::{Hide, Show},
    execute, queue,
    terminal::{
        BeginSynchronizedUpdate, EndSynchronizedUpdate, EnterAlternateScreen, LeaveAlternateScreen, disable_raw_mode,
        enable_raw_mode,
    },
};
use ratatui::{
    Frame, Terminal,
    backend::CrosstermBackend,
    layout::{Position, Rect},
};

/// Bytes of a frame that fit without growing; a full picture of a large terminal is some 30 KB.
const FRAME_BYTES: usize = 64 * 1024;

/// Output that is kept until the frame is complete: ratatui flushes twice a frame, and bare stdout writes it in pieces.
#[derive(Clone, Debug)]
struct FrameBuffer(Rc<RefCell<Vec<u8>>>);

impl Write for FrameBuffer {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.borrow_mut().extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// The terminal in raw mode with its alternate screen; dropping it gives the terminal back.
pub struct Session {
    terminal: Terminal<CrosstermBackend<FrameBuffer>>,
    frame: FrameBuffer,
    output: File,
    entered: bool,
}

impl Session {
    /// Takes the terminal over.
    ///
    /// # Errors
    /// What the terminal answers.
    pub fn start() -> io::Result<Self> {
        let frame = FrameBuffer(Rc::new(RefCell::new(Vec::with_capacity(FRAME_BYTES))));
        let output = File::from(io::stdout().as_fd().try_clone_to_owned()?);
        restore_on_panic();
        let terminal = Terminal::new(CrosstermBackend::new(frame.clone()))?;
        let mut session = Self { terminal, frame, output, entered: false };
        session.enter()?;
        Ok(session)
    }

    /// Takes the terminal over again after [`Session::leave`], or after somebody else has changed it.
    ///
    /// # Errors
    /// What the terminal answers.
    pub fn enter(&mut self) -> io::Result<()> {
        self.entered = true;
        enable_raw_mode()?;
        queue!(self.frame, EnterAlternateScreen, Hide)?;
        // The next picture has to be painted in full. `Terminal::clear` would ask the terminal for the cursor's place, and
        // the answer would have to get past the thread that reads keys.
        let size = self.terminal.size()?;
        self.terminal.resize(Rect::from((Position::ORIGIN, size)))
    }

    /// Gives the terminal back.
    ///
    /// # Errors
    /// What the terminal answers.
    pub fn leave(&mut self) -> io::Result<()> {
        if !std::mem::take(&mut self.entered) {
            return Ok(());
        }
        self.frame.0.borrow_mut().clear();
        let shown = execute!(self.output, LeaveAlternateScreen, Show);
        disable_raw_mode().and(shown)
    }

    /// Draws one picture and writes what has changed, in one piece.
    ///
    /// # Errors
    /// What the terminal answers.
    pub fn draw(&mut self, draw: impl FnOnce(&mut Frame)) -> io::Result<()> {
        queue!(self.frame, BeginSynchronizedUpdate)?;
        self.terminal.draw(draw)?;
        queue!(self.frame, EndSynchronizedUpdate)?;
        let mut bytes = self.frame.0.borrow_mut();
        self.output.write_all(&bytes)?;
        bytes.clear();
        Ok(())
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        // There is nobody left to tell.
        let _ = self.leave();
    }
}

/// Whether there is a terminal on both sides that can show pictures.
pub fn has_terminal() -> bool {
    let dumb = std::env::var("TERM").map_or(true, |term| term.is_empty() || term == "dumb");
    io::stdin().is_terminal() && io::stdout().is_terminal() && !dumb
}

/// Lets a panic of this thread restore the terminal before it is reported. Panics of other threads are caught where
/// they happen and told on the status line; a report in the middle of the picture would help nobody.
fn restore_on_panic() {
    let screen = thread::current().id();
    let report = panic::take_hook();
    panic::set_hook(Box::new(move |info| {
        if thread::current().id() == screen {
            let _ = disable_raw_mode();
            let _ = execute!(io::stdout(), EndSynchronizedUpdate, LeaveAlternateScreen, Show);
            report(info);
        }
    }));
}
