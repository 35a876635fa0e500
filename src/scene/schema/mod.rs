//! The schema of scene parameters: one row for each numeric key of a campaign file that describes the scene.
//!
//! A row states key, type, unit, meaning, default, limit, whether the key must be written, and when a change of it has an
//! effect. From it follow the field of the input structure, reading a campaign file, its canonical text, the checks, the
//! dispersable [`super::Parameter`]s and the table of keys in the documents. To add a parameter, add a row here and use the
//! field where it acts.
//!
//! - [`fuselage`], [`wheel`], [`debris`], [`initial`], [`environment`], [`actuators`], [`actuation`]: the rows, table by table.
//! - [`limit`]: what a value must satisfy. [`numbers`]: values seen as plain numbers.
//!
//! A table may have several instances: wheel `i` is instance `i` of [`Table::Wheel`], arc `i` of the schedule is instance `i`
//! of [`Table::Actuation`]. Accessors take the instance, so that a list of any length needs no further rows.
//!
//! Not here: conditions on several keys together ([`super::check`]), keys that are not numbers (`wheel_mode`).

pub mod actuation;
pub mod actuators;
pub mod debris;
pub mod environment;
pub mod fuselage;
pub mod initial;
pub mod limit;
pub mod numbers;
mod rows;
pub mod wheel;

use super::error::Problems;
use super::input::SceneInput;
pub use actuation::ActuationInput;
pub use actuators::ActuatorsInput;
pub use debris::DebrisInput;
pub use environment::EnvironmentInput;
pub use fuselage::{FuselageInput, MassErrors, PrincipalInertia, PrincipalMoments};
pub use initial::InitialInput;
pub use limit::Limit;
pub use wheel::{WheelInput, WheelMode};

/// A table of a campaign file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Table {
    /// `[fuselage]`.
    Fuselage,
    /// `[wheel1]`, `[wheel2]`.
    Wheel,
    /// `[debris]`.
    Debris,
    /// `[actuators]`.
    Actuators,
    /// `[initial]`.
    Initial,
    /// `[environment]`.
    Environment,
    /// `[[actuation]]`: commands, which cannot be dispersed; `[actuators]` distorts them.
    Actuation,
}

impl Table {
    /// All tables, in the order of the dispersable parameters.
    pub const ALL: [Table; 7] = [
        Table::Fuselage,
        Table::Wheel,
        Table::Debris,
        Table::Actuators,
        Table::Initial,
        Table::Environment,
        Table::Actuation,
    ];

    /// The names of the table in a campaign file, one for each instance; one name for a list of tables.
    pub const fn headers(self) -> &'static [&'static str] {
        match self {
            Table::Fuselage => &["fuselage"],
            Table::Wheel => &["wheel1", "wheel2"],
            Table::Debris => &["debris"],
            Table::Actuators => &["actuators"],
            Table::Initial => &["initial"],
            Table::Environment => &["environment"],
            Table::Actuation => &["actuation"],
        }
    }

    /// The rows of the table, in parts.
    pub(in crate::scene) const fn rows(self) -> &'static [&'static [Key]] {
        match self {
            Table::Fuselage => fuselage::KEYS,
            Table::Wheel => wheel::KEYS,
            Table::Debris => debris::KEYS,
            Table::Actuators => actuators::KEYS,
            Table::Initial => initial::KEYS,
            Table::Environment => environment::KEYS,
            Table::Actuation => actuation::KEYS,
        }
    }

    /// The keys of the table, in the order in which they are written.
    pub fn keys(self) -> impl Iterator<Item = &'static Key> {
        self.rows().iter().copied().flatten()
    }

    /// Whether its keys can be dispersed.
    pub const fn is_dispersable(self) -> bool {
        !matches!(self, Table::Actuation)
    }
}

/// How the components of a value belong together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// Independent numbers.
    Plain,
    /// A unit quaternion, scalar first: normalised after its components were changed.
    Quaternion,
    /// A symmetric 3x3 tensor by rows; the six entries on and above the diagonal are the components; a change of
    /// one off the diagonal changes its mirror image too.
    Symmetric,
}

/// Whether a key must be written.
#[derive(Clone, Copy, Debug)]
pub enum Presence {
    /// Always; a message shows this example.
    Required(&'static str),
    /// Only where the scene says so.
    RequiredIf(fn(&SceneInput) -> bool, &'static str),
    /// Never: where it is left out, the default of the input structure applies.
    Optional,
}

/// A row of the schema: one numeric key of one table.
#[derive(Debug)]
pub struct Key {
    /// The table.
    pub table: Table,
    /// The key within its table.
    pub key: &'static str,
    /// The dotted name, one for each header of the table.
    pub names: &'static [&'static str],
    /// The unit, as people write it; `1` for a pure number.
    pub unit: &'static str,
    /// What it is, without the unit.
    pub meaning: &'static str,
    /// The names of the components for each header, or one list for all; one empty name for a scalar.
    pub components: &'static [&'static [&'static str]],
    /// How the components belong together.
    pub shape: Shape,
    /// Whether it must be written.
    pub presence: Presence,
    /// What its value must satisfy.
    pub limit: Limit,
    /// What to write so that a change of the key has an effect, where it has none.
    pub remedy: &'static str,
    /// The numbers; `None` where the scene has no such key. A symmetric tensor has nine.
    pub read: fn(&SceneInput, usize) -> Option<&[f64]>,
    /// The same, to be changed.
    pub write: fn(&mut SceneInput, usize) -> Option<&mut [f64]>,
    /// Makes the scene have the key, if its table is there: an optional value, a way to describe a body.
    pub open: fn(&mut SceneInput, usize),
    /// Whether a change of a component has an effect, where the scene has the key.
    pub acts: fn(&SceneInput, usize, usize) -> bool,
}

impl Key {
    /// The dotted name in table `instance`.
    pub const fn name(&self, instance: usize) -> &'static str {
        self.names[if instance < self.names.len() { instance } else { 0 }]
    }

    /// The names of the components in table `instance`.
    pub const fn components(&self, instance: usize) -> &'static [&'static str] {
        self.components[if instance < self.components.len() { instance } else { 0 }]
    }

    /// The key called `name` in `table`, written as in a campaign file.
    pub fn find(table: Table, name: &str) -> Option<&'static Key> {
        table.keys().find(|key| key.key == name)
    }

    /// The numbers where the key is not written, as in a campaign file; `None` where it must be written, or where another
    /// key takes its place.
    pub fn default_text(&self) -> Option<String> {
        match self.presence {
            Presence::Required(_) => None,
            _ => (self.read)(&SceneInput::with_every_table(), 0).map(limit::shown),
        }
    }
}

/// The key exists in every scene that has its table.
pub(super) fn in_every_scene(_: &SceneInput) -> bool {
    true
}

/// Every change has an effect.
pub(super) fn always(_: &SceneInput, _: usize, _: usize) -> bool {
    true
}

/// Notes which values of the rows that a scene has violate their limits.
fn check_rows(rows: &'static [Key], scene: &SceneInput, problems: &mut Problems) {
    for key in rows {
        if let Some(numbers) = (key.read)(scene, 0) {
            key.limit.check(|| key.names[0].into(), numbers, problems);
        }
    }
}
