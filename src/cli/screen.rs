//! Printing, with control characters escaped and broken pipes tolerated (`spindrift check x | head`), unlike with the
//! standard macros.

use std::io::{self, IsTerminal, Write};

use crate::campaign::excerpt::printable;
use crate::cli::colour::{self, Kind, coloured};
use crate::cli::terminal_width::{Stream, terminal_width};
use crate::table::wrapped::message;

/// Prints a result on standard output.
///
/// # Errors If writing fails, other than to a closed pipe.
pub fn print(text: &str) -> io::Result<()> {
    let mut out = io::stdout().lock();
    let text = printable(text);
    let text = if colour::is_on(&out) { coloured(&text, Kind::Result).into() } else { text };
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        result => result.map_err(|error| io::Error::new(error.kind(), format!("standard output: {error}"))),
    }
}

const UNKNOWN_WIDTH: usize = 100;

/// Line width of standard output: COLUMNS (POSIX.1-2017, section 8.3), else the terminal's, else 100.
pub fn width() -> usize {
    width_of(&io::stdout()).unwrap_or(UNKNOWN_WIDTH)
}

/// As [`width`], for any stream; `None` if unknown.
fn width_of(stream: &impl Stream) -> Option<usize> {
    let asked = std::env::var("COLUMNS").ok().and_then(|text| text.trim().parse().ok());
    asked.filter(|width| *width > 0).or_else(|| terminal_width(stream))
}

/// Prints a message on standard error; ignores failures.
pub fn note(text: &str) {
    let mut out = io::stderr().lock();
    let text = printable(text);
    // pipes of unknown width get unwrapped lines
    let text = match width_of(&out).or(out.is_terminal().then_some(UNKNOWN_WIDTH)) {
        Some(width) => message(&text, width).into(),
        None => text,
    };
    let text = if colour::is_on(&out) { coloured(&text, Kind::Note).into() } else { text };
    let _ = writeln!(out, "{text}");
}
