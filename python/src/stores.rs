//! Object stores for the Python package: the client of the library's feature `cloud`, compiled here, so that the
//! library is that of the program and is compiled once.

#[path = "../../src/storage/remote/client.rs"]
mod client;

pub use client::connect;
use spindrift::storage::remote::address;
