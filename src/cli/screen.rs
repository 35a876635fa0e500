//! What is printed. The standard macros panic where the reader has gone (`spindrift check x | head`); these do not.

use std::io::{self, Write};

use crate::cli::command_outcome::Failure;

/// Prints a result on standard output.
///
/// # Errors
/// Where it cannot be written; that nobody reads on is no error.
pub fn print(text: &str) -> Result<(), Failure> {
    print_with(|out| out.write_all(text.as_bytes()))
}

/// The same, written piece by piece.
///
/// # Errors
/// As [`print()`].
pub fn print_with(write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), Failure> {
    let mut out = io::BufWriter::new(io::stdout().lock());
    match write(&mut out).and_then(|()| out.flush()) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => {
            // what is still buffered would be tried again when the writer is dropped
            let _ = out.into_parts();
            Ok(())
        }
        result => result.map_err(|error| Failure::Files(format!("standard output: {error}"))),
    }
}

/// Says something on standard error; whether anybody listens does not matter.
pub fn note(text: &str) {
    let _ = writeln!(io::stderr().lock(), "{text}");
}
