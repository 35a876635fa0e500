//! Object stores for the Python package: the client of the library's feature `cloud`, compiled here, so that the
//! library is that of the program and is compiled once.

#[path = "../../ensemble/src/storage/s3.rs"]
mod s3;

pub use s3::connect;
use spindrift::storage::{address, identity, store};
