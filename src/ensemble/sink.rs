//! [`Sink`]: where finished rows go. The ensemble knows no file format; the output floor implements this.

use crate::ensemble::rows::Rows;

/// Takes the rows of finished parts.
///
/// Called from several threads, with parts in no order. A part is offered once; what the sink makes of it must not depend on
/// which other parts came before.
pub trait Sink: Sync {
    /// Why rows could not be taken.
    type Error: Send;

    /// Takes the rows of one part. After an error the campaign starts no further part.
    ///
    /// # Errors
    /// Where the rows could not be kept.
    fn take(&self, rows: &Rows) -> Result<(), Self::Error>;
}
