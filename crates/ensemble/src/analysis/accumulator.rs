//! [`Accumulator`]: one pass over the parts of a campaign, counted on any thread and merged in order, so that results
//! depend neither on threads nor on the source of the rows.

use crate::analysis::part_columns::PartColumns;
use crate::ensemble::threads::Threads;
use crate::storage::rows_reader::{Result, RowsError, RowsReader};

pub trait Accumulator: Sync {
    type Whole: Send;
    type OfPart: Send;

    fn nothing(&self) -> Self::Whole;

    /// Counts a part, on any thread, once.
    fn count(&self, part: &impl PartColumns) -> Result<Self::OfPart>;

    /// Adds the next part, in the order of the parts.
    fn merge(&self, whole: &mut Self::Whole, part: Self::OfPart);
}

/// Two accumulators in one pass.
impl<A: Accumulator, B: Accumulator> Accumulator for (A, B) {
    type Whole = (A::Whole, B::Whole);
    type OfPart = (A::OfPart, B::OfPart);

    fn nothing(&self) -> Self::Whole {
        (self.0.nothing(), self.1.nothing())
    }

    fn count(&self, part: &impl PartColumns) -> Result<Self::OfPart> {
        Ok((self.0.count(part)?, self.1.count(part)?))
    }

    fn merge(&self, whole: &mut Self::Whole, part: Self::OfPart) {
        self.0.merge(&mut whole.0, part.0);
        self.1.merge(&mut whole.1, part.1);
    }
}

/// Runs `accumulator` over the files of `reader`, on `threads` threads.
pub fn of_files<A: Accumulator>(accumulator: &A, reader: &RowsReader, threads: Threads) -> Result<A::Whole> {
    let mut whole = accumulator.nothing();
    reader.visit(
        threads,
        |part| accumulator.count(part),
        |part| {
            accumulator.merge(&mut whole, part);
            Ok::<(), RowsError>(())
        },
    )?;
    Ok(whole)
}
