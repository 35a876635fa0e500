//! [`connect`]: the client of this process.

use std::io;
use std::sync::OnceLock;

use super::address::{Address, Connected};

/// The client for an address, and the content of the object of that name.
///
/// # Errors
/// Where the environment does not say how to get there, or the store does not answer, or refuses.
pub type Connect = fn(&Address, &str) -> io::Result<Connected>;

static CONNECT: OnceLock<Connect> = OnceLock::new();

/// Makes `connect` the client of this process, where the build has none of its own: so the Python package has object
/// stores and the library of the program, compiled once.
pub fn connect_by(connect: Connect) {
    let _ = CONNECT.set(connect);
}

/// How this process connects to a store, where it can.
pub fn connect() -> Option<Connect> {
    #[cfg(feature = "cloud")]
    return Some(super::client::connect);
    #[cfg(not(feature = "cloud"))]
    CONNECT.get().copied()
}
