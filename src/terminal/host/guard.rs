//! Terminal guard: takes over the terminal and restores it, however the program ends.

#![allow(
    clippy::disallowed_methods,
    reason = "what takes the terminal over are control characters; text goes through the ANSI backend"
)]

use std::{
    fs::File,
    io::{self, IsTerminal, Write},
    panic,
    sync::atomic::{AtomicBool, Ordering},
    thread,
};

use crossterm::{
    clipboard::CopyToClipboard,
    cursor::{Hide, MoveTo, Show},
    event::{DisableBracketedPaste, EnableBracketedPaste},
    execute, queue,
    style::{Print, ResetColor},
    terminal::{
        EndSynchronizedUpdate, EnterAlternateScreen, LeaveAlternateScreen, disable_raw_mode, enable_raw_mode, size,
    },
};
use ratatui::{
    Frame, Terminal,
    layout::{Position, Rect},
};

use crate::{platform, printing::OneLine, terminal::host::backend::AnsiBackend};

/// Whether the program has taken over the terminal. It is global because a process has one terminal, and a panic must not restore it twice:
/// that would move the cursor onto the report.
static IS_ACTIVE: AtomicBool = AtomicBool::new(false);

/// Enables reports of mouse buttons, wheel and drags, but not of motion (xterm modes 1002 and 1006). Crossterm's own command adds mode
/// 1003, whose reports of every motion flood a slow link.
const ENABLE_MOUSE: &str = "\x1b[?1002h\x1b[?1006h";
/// Disables these reports; terminals without them ignore it.
const DISABLE_MOUSE: &str = "\x1b[?1006l\x1b[?1002l";

/// The terminal in raw mode with its alternate screen; dropping the guard restores it.
pub struct TerminalGuard {
    terminal: Terminal<AnsiBackend>,
    output: File,
    /// Whether the mouse is captured.
    mouse: bool,
}

impl TerminalGuard {
    /// Takes over the terminal, and the mouse if `mouse`.
    ///
    /// # Errors
    /// Any error of the terminal.
    pub fn start(mouse: bool) -> io::Result<Self> {
        let output = platform::terminal_output()?;
        restore_on_panic();
        let terminal = Terminal::new(AnsiBackend::new(size))?;
        let mut session = Self { terminal, output, mouse };
        session.enter()?;
        Ok(session)
    }

    /// Takes over the terminal again after [`TerminalGuard::leave`], or after another program has changed it.
    ///
    /// # Errors
    /// Any error of the terminal.
    pub fn enter(&mut self) -> io::Result<()> {
        IS_ACTIVE.store(true, Ordering::SeqCst);
        enable_raw_mode()?;
        let mouse = if self.mouse { ENABLE_MOUSE } else { "" };
        execute!(self.output, EnterAlternateScreen, Hide, EnableBracketedPaste, Print(mouse))?;
        self.terminal.backend_mut().invalidate();
        // The next frame has to be painted in full. `Terminal::clear` would query the cursor position, and the thread that reads keys would
        // take the answer.
        let size = self.terminal.size()?;
        self.terminal.resize(Rect::from((Position::ORIGIN, size)))
    }

    /// Captures or releases the mouse, if that changes anything.
    ///
    /// # Errors
    /// Any error of the terminal.
    pub fn capture_mouse(&mut self, mouse: bool) -> io::Result<()> {
        if std::mem::replace(&mut self.mouse, mouse) == mouse {
            return Ok(());
        }
        execute!(self.output, Print(if mouse { ENABLE_MOUSE } else { DISABLE_MOUSE }))
    }

    /// Restores the terminal.
    ///
    /// # Errors
    /// Any error of the terminal.
    pub fn leave(&mut self) -> io::Result<()> {
        if !IS_ACTIVE.swap(false, Ordering::SeqCst) {
            return Ok(());
        }
        let shown = write_restore(&mut self.output);
        disable_raw_mode().and(shown)
    }

    /// Copies `text` to the terminal's clipboard with OSC 52; terminals that do not allow it ignore the sequence.
    ///
    /// # Errors
    /// Any error of the terminal.
    pub fn copy(&mut self, text: &str) -> io::Result<()> {
        execute!(self.output, CopyToClipboard::to_clipboard_from(text))
    }

    /// Draws a frame and writes the changes in one piece; writes nothing if there are none.
    ///
    /// # Errors
    /// Any error of the terminal.
    pub fn draw(&mut self, draw: impl FnOnce(&mut Frame)) -> io::Result<()> {
        self.terminal.draw(draw)?;
        self.terminal.backend_mut().write_frame(&mut self.output)
    }
}

impl Drop for TerminalGuard {
    fn drop(&mut self) {
        // On an error there is no terminal left to write to.
        let _ = self.leave();
    }
}

/// Whether input and output are a terminal that can draw pictures.
pub fn has_terminal() -> bool {
    let dumb = std::env::var("TERM").map_or(platform::NEEDS_TERM, |term| term.is_empty() || term == "dumb");
    io::stdin().is_terminal() && io::stdout().is_terminal() && !dumb
}

/// Writes the sequences that restore the terminal in one piece, so that no intermediate state is visible. A terminal without an alternate
/// screen keeps the picture; the shell then continues below it, in its own colours.
fn write_restore(output: &mut impl Write) -> io::Result<()> {
    let mut bytes = Vec::new();
    queue!(bytes, ResetColor, MoveTo(0, u16::MAX - 1), Print("\r\n"))?;
    queue!(bytes, EndSynchronizedUpdate, Print(DISABLE_MOUSE), DisableBracketedPaste, Show, LeaveAlternateScreen)?;
    output.write_all(&bytes)?;
    output.flush()
}

/// Makes a panic of this thread restore the terminal before it is reported. Panics of other threads are caught where they happen and appear
/// on the status line, not in the middle of the picture.
fn restore_on_panic() {
    let screen = thread::current().id();
    let report = panic::take_hook();
    panic::set_hook(Box::new(move |info| {
        tracing::error!("{}", OneLine(&info));
        if thread::current().id() == screen && IS_ACTIVE.swap(false, Ordering::SeqCst) {
            let _ = disable_raw_mode();
            let _ = write_restore(&mut io::stdout());
        }
        if thread::current().id() == screen {
            report(info);
        }
    }));
}

#[cfg(test)]
mod tests {
    use std::io::Read;

    use portable_pty::{CommandBuilder, PtySize, native_pty_system};
    use ratatui::style::Style;

    use crate::terminal::host::guard::TerminalGuard;

    #[test]
    #[ignore = "the next test runs it, in a terminal of its own"]
    fn draws_and_panics() {
        let mut session = TerminalGuard::start(true).unwrap();
        session.draw(|frame| frame.buffer_mut().set_string(0, 0, "picture", Style::new())).unwrap();
        panic!("something is wrong");
    }

    #[test]
    fn a_panic_restores_the_terminal_and_is_then_reported() {
        let pair = native_pty_system().openpty(PtySize::default()).unwrap();
        let mut command = CommandBuilder::new(std::env::current_exe().unwrap());
        command.args(["--exact", "--ignored", "--nocapture", "terminal::host::guard::tests::draws_and_panics"]);
        let mut child = pair.slave.spawn_command(command).unwrap();
        drop(pair.slave);
        let (mut reader, mut bytes) = (pair.master.try_clone_reader().unwrap(), Vec::new());
        // Reading beyond the end of a pseudo-terminal is an error.
        let _ = reader.read_to_end(&mut bytes);
        assert_eq!(child.wait().unwrap().exit_code(), 101);
        let text = String::from_utf8_lossy(&bytes);
        let [picture, back, report] =
            ["picture", "\x1b[?1049l", "something is wrong"].map(|part| text.find(part).expect(part));
        assert!(picture < back && back < report, "{text:?}");
        assert!(text[report..].contains("\r\n"), "raw mode was left on: {text:?}");
        let mut terminal = vt100::Parser::default();
        terminal.process(&bytes);
        let screen = terminal.screen();
        assert!(!screen.alternate_screen() && !screen.hide_cursor() && !screen.bracketed_paste());
        assert_eq!(screen.mouse_protocol_mode(), vt100::MouseProtocolMode::None);
    }
}
