//! Printing. Characters of files and names that a terminal would obey are shown as escapes. The standard macros panic where the reader has closed the pipe (`spindrift check x | head`); these do not.

use std::io::{self, Write};

use crate::campaign::excerpt::printable;

/// Prints a result on standard output.
///
/// # Errors
/// Where writing fails; a closed pipe is not an error.
pub fn print(text: &str) -> io::Result<()> {
    let mut out = io::stdout().lock();
    match out.write_all(printable(text).as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        result => result.map_err(|error| io::Error::new(error.kind(), format!("standard output: {error}"))),
    }
}

/// Prints a message on standard error; failure to write it is ignored.
pub fn note(text: &str) {
    let _ = writeln!(io::stderr().lock(), "{}", printable(text));
}
