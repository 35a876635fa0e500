//! Results in an object store: [`Address`], where; [`Remote`], what is put and got there.
//!
//! - [`address`]: addresses, and what a client does there.
//! - [`connection`]: the client of this process.
//! - `client`: requests, in a build with the feature `cloud` and in the Python package; where there is none, an address
//!   is refused.
//! - `objects`: the files of a result as objects, and the order in which they are put.

pub mod address;
#[cfg(feature = "cloud")]
mod client;
pub mod connection;
mod objects;

pub use address::{Address, Connected, Objects};
pub use connection::connect_by;
pub use objects::{Fault, Remote, head_of};
