//! The report page against rows and summary.

pub mod answers;
pub mod document;
pub mod loops;
pub mod marks;
pub mod names;
pub mod numbers;
pub mod orbit;
pub mod replay;
pub mod runs;
pub mod series;
