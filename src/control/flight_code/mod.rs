//! [`FlightCode`]: a WebAssembly module as the law of attitude of the phases that name it (`law = "module"`).
//!
//! A module is a core module without imports. It shares its linear memory with the loop: at every control tick the loop writes what is known into the input of
//! the module, calls its step, and reads the wanted torque from its output. The interface has a number ([`INTERFACES`]). A later interface appends to what
//! modules are given and asked, so that those of an earlier one go on to fly. `docs/flight-code.md` describes all of it for those who write modules.
//!
//! - `complexity`: what is too much to compile. `declared`: parameters, sensors and telemetry that a module declares. `input`: what it is given. `runtime`: modules as compiled, and their instances;
//!   these are in builds with the feature `wasm` alone.

#[cfg(feature = "wasm")]
mod complexity;
#[cfg(feature = "wasm")]
mod declared;
#[cfg(feature = "wasm")]
mod input;
#[cfg(feature = "wasm")]
mod runtime;

use std::fmt;

use super::laws::LawKind;

/// The numbers of the interfaces, of which `spindrift_interface` of a module returns one. 2 has measurements and telemetry beside what 1 has.
pub const INTERFACES: [i32; 2] = [1, 2];
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

/// A sensor whose last measurement a module is given at each step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WantedSensor {
    /// Its name in the campaign file.
    pub name: &'static str,
    /// Its kind there, which says what its numbers mean.
    pub kind: &'static str,
}

/// A number that a module reports at each step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DeclaredTelemetry {
    /// Its key, which ends in its unit.
    pub key: &'static str,
    /// The same without its unit.
    pub stem: &'static str,
    /// Its unit; `1` of a pure number.
    pub unit: &'static str,
    /// What it is.
    pub meaning: &'static str,
}

impl DeclaredTelemetry {
    /// The name of its column in time series, and with `of` = `_final` or `_max` of those in rows.
    pub fn column(&self, of: &str) -> String {
        format!("module_{}{of}{}", self.stem, &self.key[self.stem.len()..])
    }

    /// Its unit in columns.
    pub fn unit_of_column(&self) -> &'static str {
        if self.unit == "1" { "" } else { self.unit }
    }
}

/// A module that has been checked and compiled.
pub struct FlightCode {
    sha256: String,
    kind: LawKind,
    sensors: &'static [WantedSensor],
    telemetry: &'static [DeclaredTelemetry],
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

    /// The sensors whose measurements it is given.
    pub fn sensors(&self) -> &'static [WantedSensor] {
        self.sensors
    }

    /// The telemetry that it reports.
    pub fn telemetry(&self) -> &'static [DeclaredTelemetry] {
        self.telemetry
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
