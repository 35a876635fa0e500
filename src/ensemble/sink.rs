//! [`Sink`]: takes finished rows. The ensemble knows no file format; `storage` implements this.

use crate::ensemble::rows::Rows;

/// Takes the rows of finished parts.
///
/// Called from several threads, with parts in any order. Each part is offered once; what the sink does with it must not depend
/// on the parts before it.
pub trait Sink: Sync {
    /// Why rows were refused.
    type Error: Send;

    /// Takes the rows of one part. After an error the campaign starts no further part.
    ///
    /// # Errors
    /// Where the rows could not be stored.
    fn take(&self, rows: &Rows) -> Result<(), Self::Error>;
}
