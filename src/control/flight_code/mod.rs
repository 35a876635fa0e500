//! [`FlightCode`]: a WebAssembly module as the law of attitude of the phases that name it (`law = "module"`).
//!
//! A module is a core module without imports. It shares its linear memory with the loop: at every control tick the loop
//! writes what is known into the input of the module, calls its step, and reads the wanted torque from its output. The
//! interface has a number ([`INTERFACES`]). A later interface appends to what modules are given and asked, so that
//! those of an earlier one go on to fly. `docs/flight-code.md` describes all of it for those who write modules.
//!
//! - `complexity`: what is too much to compile. `declared`: parameters, sensors and telemetry that a module declares.
//!   `input`: what it is given. `runtime`: modules as compiled, and their instances; these are in builds with the
//!   feature `wasm` alone.

#[cfg(feature = "wasm")]
mod complexity;
#[cfg(feature = "wasm")]
mod declared;
#[cfg(feature = "wasm")]
mod input;
pub mod module;
#[cfg(feature = "wasm")]
mod runtime;

pub use module::{
    DeclaredTelemetry, FlightCode, INTERFACES, MOST_BYTES, MOST_MEMORY, MOST_STACK, NAME, Refusal, START_FUEL,
    STEP_FUEL, WantedSensor,
};

/// The module with these bytes, whose SHA-256 is `sha256`. A process compiles each once, and keeps it for good: it has
/// as many as its campaign files name.
///
/// # Errors
/// The reason why it is refused; in a build without the feature `wasm`, how to get one with it.
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
