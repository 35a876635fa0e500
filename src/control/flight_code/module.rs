//! [`FlightCode`]: a module that has been checked and compiled, and what it declares.

use std::fmt;

use crate::control::laws::LawKind;

/// The numbers of the interfaces, of which `spindrift_interface` of a module returns one. 2 has measurements and
/// telemetry in addition to 1.
pub const INTERFACES: [i32; 2] = [1, 2];
/// The name of modules as laws of phases.
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

/// The error of a module in messages about campaign files: the allowed values, and the remedy.
pub type Refusal = (String, String);

/// A sensor whose last measurement a module is given at each step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WantedSensor {
    /// Its name in the campaign file.
    pub name: &'static str,
    /// Its kind there, which defines its numbers.
    pub kind: &'static str,
}

/// A number that a module reports at each step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DeclaredTelemetry {
    /// Its key, which ends in its unit.
    pub key: &'static str,
    /// The key without its unit.
    pub stem: &'static str,
    /// Its unit; `1` of a pure number.
    pub unit: &'static str,
    /// Its meaning.
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
    pub(super) sha256: String,
    pub(super) kind: LawKind,
    pub(super) sensors: &'static [WantedSensor],
    pub(super) telemetry: &'static [DeclaredTelemetry],
}

impl FlightCode {
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
