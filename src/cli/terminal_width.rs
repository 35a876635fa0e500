//! The width of the terminal: only the layout of text on the screen depends on it.

/// What may be a terminal.
#[cfg(unix)]
pub use std::os::fd::AsFd as Stream;

/// What may be a terminal.
#[cfg(not(unix))]
pub use std::io::IsTerminal as Stream;

/// Number of characters in a line of the terminal that shows `stream`; `None` where it is no terminal or does not say.
#[cfg(unix)]
pub fn terminal_width(stream: &impl Stream) -> Option<usize> {
    let size = rustix::termios::tcgetwinsize(stream).ok()?;
    Some(usize::from(size.ws_col)).filter(|width| *width > 0)
}

/// Width of a terminal; unknown here.
#[cfg(not(unix))]
pub fn terminal_width(_stream: &impl Stream) -> Option<usize> {
    None
}
