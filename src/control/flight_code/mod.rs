//! [`FlightCode`]: a WebAssembly module as the law of attitude of the phases that name it (`law = "module"`).
//!
//! A module is a core module without imports. It shares its linear memory with the loop: at every control tick the loop writes what is known into the input of
//! the module, calls its step, and reads the wanted torque from its output. The interface has a number ([`INTERFACE`]). A later interface appends to input
//! and output, so that modules of an earlier one go on to fly. `docs/flight-code.md` describes all of it for those who write modules.
//!
//! - `complexity`: what is too much to compile. `input`: what a module is given. `parameter_table`: the parameters that it declares. `runtime`: modules as compiled, and their instances; these are in
//!   builds with the feature `wasm` alone.

#[cfg(feature = "wasm")]
mod complexity;
#[cfg(feature = "wasm")]
mod input;
#[cfg(feature = "wasm")]
mod parameter_table;
#[cfg(feature = "wasm")]
mod runtime;

use std::fmt;

use super::laws::LawKind;

/// The number of the interface: what `spindrift_interface` of a module returns.
pub const INTERFACE: i32 = 1;
/// What phases call the law that a module is.
pub const NAME: &str = "module";
/// Largest file of a module, bytes.
pub const MOST_BYTES: u64 = 4 << 20;
/// Most linear memory of an instance, bytes. Each run that a worker integrates has instances of its own.
pub const MOST_MEMORY: usize = 16 << 20;
/// Fuel of a step, which is about its number of instructions: a law needs some hundreds.
pub const STEP_FUEL: u64 = 10_000_000;
/// Fuel of what precedes the first step: start function, static constructors and `spindrift_init`.
pub const START_FUEL: u64 = 100_000_000;
/// Most stack of the processor that the calls of a module take, bytes: a small part of what a thread has.
pub const MOST_STACK: usize = 256 << 10;

/// What is wrong with a module, as the campaign file is told: what is allowed, and the remedy.
pub type Refusal = (String, String);

/// A module that has been checked and compiled.
pub struct FlightCode {
    sha256: String,
    kind: LawKind,
    #[cfg(feature = "wasm")]
    compiled: runtime::Compiled,
}

impl FlightCode {
    /// The module with these bytes, whose SHA-256 is `sha256`. A process compiles each once, and keeps it for good: it has as many as its campaign files name.
    ///
    /// # Errors
    /// What is wrong with it; in a build without the feature `wasm`, how to get one with it.
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

    /// SHA-256 of its bytes, in hexadecimal.
    pub fn sha256(&self) -> &str {
        &self.sha256
    }

    /// The law that it is, with the parameters that it declares.
    pub fn kind(&'static self) -> &'static LawKind {
        &self.kind
    }
}

impl fmt::Debug for FlightCode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("FlightCode").field(&self.sha256).finish()
    }
}

/// Modules of the same bytes are one.
impl PartialEq for FlightCode {
    fn eq(&self, other: &Self) -> bool {
        self.sha256 == other.sha256
    }
}
