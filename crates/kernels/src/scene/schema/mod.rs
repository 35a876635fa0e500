//! The schema of scene parameters: one row for each numeric key of a campaign file that describes the scene.
//!
//! From a row (key, type, unit, meaning, default, limit, required or not) follow the field of the input structure, its
//! reading, canonical text and checks, the dispersable [`super::Parameter`]s and the table of keys in the documents. A
//! new parameter is a new row here, and its field used where it acts.
//!
//! [`super::table`] places the tables, and their instances, in a scene. Conditions on several keys are in
//! [`super::check`]; keys that are not numbers (`mode`, `shape`, names) have no rows.

pub mod actuation;
pub mod actuators;
pub mod body;
mod components;
pub mod control;
pub mod debris;
pub mod environment;
pub mod failure;
pub(crate) mod initial;
pub mod limit;
pub(crate) mod mass_errors;
pub mod numbers;
pub mod orbit;
pub mod part;
pub(crate) mod plate;
pub(crate) mod principal;
pub(crate) mod row;
mod rows;
pub(crate) mod sizes;
pub mod thruster;
pub(crate) mod torque_rod;
pub(crate) mod wheel;

pub use actuation::{ActuationInput, ArcErrors};
pub use actuators::ActuatorsInput;
pub use body::BodyInput;
pub use control::{ControlInput, DeclaredTable, LawParameter};
pub use debris::DebrisInput;
pub use environment::{EnvironmentInput, FieldModel, Shadow};
pub use failure::{Device, FailureInput, SensorOutput};
pub use initial::InitialInput;
pub use limit::Limit;
pub use mass_errors::MassErrors;
pub use orbit::OrbitInput;
pub use part::{PartInput, PartShape};
pub use plate::{MAX_PLATES, PlateInput};
pub use principal::{PrincipalInertia, PrincipalMoments};
pub use row::{Facts, Row, Shape};
pub use sizes::{MAX_THRUSTERS, MAX_TORQUE_RODS, MAX_WHEELS};
pub use thruster::ThrusterInput;
pub use torque_rod::TorqueRodInput;
pub use wheel::{WheelInput, WheelMode};
