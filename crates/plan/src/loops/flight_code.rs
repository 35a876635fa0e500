//! [`FlightCode`]: a checked and compiled module with its declarations.

use std::fmt;

use super::attitude_law::LawKind;

/// The interfaces that `spindrift_interface` may return; 2 adds measurements and telemetry.
pub const INTERFACES: [i32; 2] = [1, 2];
/// Name of modules as laws of phases.
pub const NAME: &str = "module";
/// Largest file of a module, bytes.
pub const MOST_BYTES: u64 = 4 << 20;
/// Most linear memory of an instance, bytes; each run of a worker has its own instances.
pub const MOST_MEMORY: usize = 16 << 20;
/// Fuel of a step, about its number of instructions; a law needs some hundreds.
pub const STEP_FUEL: u64 = 10_000_000;
/// Fuel of start function, static constructors and `spindrift_init` together.
pub const START_FUEL: u64 = 100_000_000;
/// Most native stack for a module's calls, bytes: a small part of a thread's.
pub const MOST_STACK: usize = 256 << 10;

/// Why a module is refused in a campaign file: allowed values and remedy.
pub type Refusal = (String, String);

/// A sensor whose last measurement a module receives at each step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WantedSensor {
    /// Name in the campaign file.
    pub name: &'static str,
    /// Kind in the campaign file, which defines its numbers.
    pub kind: &'static str,
}

/// A number that a module reports at each step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DeclaredTelemetry {
    /// Key, with its unit as suffix.
    pub key: &'static str,
    /// Key without its unit.
    pub stem: &'static str,
    /// Unit, `1` for a pure number.
    pub unit: &'static str,
    pub meaning: &'static str,
}

impl DeclaredTelemetry {
    /// Name of its column in time series, or with `of` = `_final` or `_max` in rows.
    pub fn column(&self, of: &str) -> String {
        format!("module_{}{of}{}", self.stem, &self.key[self.stem.len()..])
    }

    /// Unit in columns.
    pub fn unit_of_column(&self) -> &'static str {
        if self.unit == "1" { "" } else { self.unit }
    }
}

pub struct FlightCode {
    /// SHA-256 of its bytes, in hexadecimal.
    pub sha256: String,
    /// The law, with the parameters that it declares.
    pub kind: LawKind,
    pub sensors: &'static [WantedSensor],
    pub telemetry: &'static [DeclaredTelemetry],
}

impl fmt::Debug for FlightCode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("FlightCode").field(&self.sha256).finish()
    }
}

/// Modules with equal bytes are equal.
impl PartialEq for FlightCode {
    fn eq(&self, other: &Self) -> bool {
        self.sha256 == other.sha256
    }
}
