//! [`FlightCode`]: a WebAssembly module as the attitude law of phases with `law = "module"`.
//!
//! A core module without imports shares its memory with the loop, which writes the input at each control tick, calls
//! the step and reads the wanted torque. Interfaces are numbered ([`INTERFACES`]); later ones only append, so that
//! older modules keep flying. `docs/flight-code.md` describes them for authors of modules.

#[cfg(feature = "wasm")]
mod complexity;
#[cfg(feature = "wasm")]
mod declared;
#[cfg(feature = "wasm")]
mod input;
#[cfg(feature = "wasm")]
mod runtime;

pub use crate::loops::flight_code::{FlightCode, INTERFACES, MOST_BYTES, NAME, Refusal};

/// The module with these bytes, whose SHA-256 is `sha256`; compiled once per process and leaked.
///
/// # Errors
/// The reason why it is refused, or how to build with the feature `wasm`.
#[cfg_attr(not(feature = "wasm"), expect(unused_variables, reason = "nothing can be done with them"))]
pub fn kept(bytes: &[u8], sha256: &str) -> Result<&'static FlightCode, Refusal> {
    #[cfg(feature = "wasm")]
    return runtime::kept(bytes, sha256);
    #[cfg(not(feature = "wasm"))]
    Err((
        "left out: this build of spindrift has no WebAssembly".to_owned(),
        "build one that has it: cargo build --release --features wasm".to_owned(),
    ))
}
