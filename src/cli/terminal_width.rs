//! Width of the terminal; affects only layout.

/// A stream that may be a terminal.
#[cfg(unix)]
pub use std::os::fd::AsFd as Stream;

#[cfg(not(unix))]
pub use std::io::IsTerminal as Stream;

/// Line width of the terminal behind `stream`; `None` if there is none or it is unknown.
#[cfg(unix)]
pub fn terminal_width(stream: &impl Stream) -> Option<usize> {
    let size = rustix::termios::tcgetwinsize(stream).ok()?;
    Some(usize::from(size.ws_col)).filter(|width| *width > 0)
}

/// Unknown here.
#[cfg(not(unix))]
pub fn terminal_width(_stream: &impl Stream) -> Option<usize> {
    None
}
