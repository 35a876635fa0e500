//! [`Table`] and [`Key`]: the schema's tables in a scene, and their keys. A new table needs rows ([`super::schema`]), a
//! field ([`SceneInput`]) and a line in `tables!`.

use std::cmp::Ordering;

use super::input::SceneInput;
use super::name::Name;
use super::schema::limit::shown;
use super::schema::{
    ActuationInput, ActuatorsInput, ArcErrors, BodyInput, DebrisInput, DeclaredTable, EnvironmentInput, Facts,
    FailureInput, InitialInput, LawParameter, MassErrors, OrbitInput, PartInput, PlateInput, Row, ThrusterInput,
    TorqueRodInput, WheelInput,
};

/// A key of a table of the schema.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// The table.
    pub table: Table,
    /// Row, counted through the parts of the table.
    row: u8,
    /// Its facts, which every sample needs several times per number.
    facts: &'static Facts,
}

impl PartialEq for Key {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Key {}

impl PartialOrd for Key {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Key {
    fn cmp(&self, other: &Self) -> Ordering {
        (self.table, self.row).cmp(&(other.table, other.row))
    }
}

const fn row_of<T>(parts: &'static [&'static [Row<T>]], index: usize) -> &'static Row<T> {
    let (mut part, mut index) = (0, index);
    while index >= parts[part].len() {
        index -= parts[part].len();
        part += 1;
    }
    &parts[part][index]
}

const fn count_of<T>(parts: &[&[Row<T>]]) -> usize {
    let (mut part, mut count) = (0, 0);
    while part < parts.len() {
        count += parts[part].len();
        part += 1;
    }
    count
}

/// For each table, in order of the dispersable parameters: variant, header, rows in parts, and the table in `scene`,
/// shared and mutable.
macro_rules! tables {
    (|$scene:ident, $instance:ident| $($Table:ident, $header:literal, $parts:expr,
        $get:expr, $get_mut:expr;)+) => {
        /// A table of a campaign file.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum Table {
            $(#[doc = concat!("The table with the rows `", stringify!($parts), "`.")] $Table,)+
            /// Parameters declared by the scene's control law.
            Control,
            /// Parameters declared by its sensors.
            Sensors,
            /// Parameters declared by the phases of its guidance.
            Guidance,
        }

        impl Table {
            /// Tables with the same keys in every scene, in order of the dispersable parameters.
            pub const ALL: &'static [Table] = &[$(Table::$Table),+];

            /// Name of the table in a campaign file.
            pub const fn header(self) -> &'static str {
                match self {
                    $(Table::$Table => $header,)+
                    Table::Control => "control",
                    Table::Sensors => "sensors",
                    Table::Guidance => "guidance",
                }
            }

            /// True if its keys can be dispersed.
            pub const fn is_dispersable(self) -> bool {
                !matches!(self, Table::Actuation)
            }

            /// Number of its keys common to all scenes.
            pub const fn count(self) -> usize {
                match self {
                    $(Table::$Table => const { count_of($parts) },)+
                    Table::Control | Table::Sensors | Table::Guidance => 0,
                }
            }
        }

        impl Table {
            fn facts_at(self, row: usize) -> &'static Facts {
                match self {
                    $(Table::$Table => &row_of($parts, row).facts,)+
                    Table::Control | Table::Sensors | Table::Guidance => unreachable!("its keys are those of a scene"),
                }
            }
        }

        impl Key {
            /// The numbers of the key in the table, regardless of other needs.
            #[inline]
            fn in_table(self, $scene: &SceneInput, $instance: usize) -> Option<&[f64]> {
                match self.table {
                    $(Table::$Table => (row_of($parts, self.row as usize).read)($get?),)+
                    declared => declared.declared($scene, $instance)?.numbers(self.row as usize),
                }
            }

            #[inline]
            fn in_table_mut(self, $scene: &mut SceneInput, $instance: usize) -> Option<&mut [f64]> {
                match self.table {
                    $(Table::$Table => (row_of($parts, self.row as usize).write)($get_mut?),)+
                    declared => declared.declared_mut($scene, $instance)?.numbers_mut(self.row as usize),
                }
            }

            /// Adds the key to the scene, if its table exists.
            pub fn open(self, $scene: &mut SceneInput, $instance: usize) {
                match self.table {
                    $(Table::$Table => if let Some(table) = $get_mut { (row_of($parts,
                        self.row as usize).open)(table) },)+
                    Table::Control | Table::Sensors | Table::Guidance => {}
                }
            }
        }
    };
}

tables! {
    |scene, instance|
    Body, "body", BodyInput::PARTS, Some(&scene.body), Some(&mut scene.body);
    BodyErrors, "body", &[MassErrors::ROWS], Some(&scene.body.errors), Some(&mut scene.body.errors);
    Part, "body.parts", &[PartInput::ROWS], scene.parts.get(instance), scene.parts.get_mut(instance);
    PartErrors, "body.parts", &[MassErrors::ROWS],
        scene.parts.get(instance).map(|part| &part.errors), scene.parts.get_mut(instance).map(|part| &mut part.errors);
    Wheel, "wheels", &[WheelInput::ROWS], scene.wheels.get(instance), scene.wheels.get_mut(instance);
    Thruster, "thrusters", &[ThrusterInput::ROWS], scene.thrusters.get(instance),
    scene.thrusters.get_mut(instance);
    TorqueRod, "torque_rods", &[TorqueRodInput::ROWS],
        scene.torque_rods.get(instance), scene.torque_rods.get_mut(instance);
    Debris, "debris", &[DebrisInput::ROWS], scene.debris.as_ref(), scene.debris.as_mut();
    Actuators, "actuators", &[ActuatorsInput::ROWS], Some(&scene.actuators), Some(&mut scene.actuators);
    Initial, "initial", &[InitialInput::ROWS], Some(&scene.initial), Some(&mut scene.initial);
    Orbit, "orbit", &[OrbitInput::ROWS], scene.orbit.as_ref(), scene.orbit.as_mut();
    Plate, "plates", &[PlateInput::ROWS], scene.plates.get(instance), scene.plates.get_mut(instance);
    Environment, "environment", &[EnvironmentInput::ROWS], Some(&scene.environment), Some(&mut scene.environment);
    Actuation, "actuation", &[ActuationInput::ROWS],
        scene.actuation.get(instance), scene.actuation.get_mut(instance);
    ArcErrors, "actuation", &[ArcErrors::ROWS], scene.actuation.get(instance), scene.actuation.get_mut(instance);
    Failure, "failure", &[FailureInput::ROWS], scene.failures.get(instance), scene.failures.get_mut(instance);
}

macro_rules! declared {
    ($name:ident, $get:ident $(, $mut:tt)?) => {
        #[inline]
        fn $name(self, scene: &$($mut)? SceneInput, instance: usize) -> Option<&$($mut)? DeclaredTable> {
            match self {
                Table::Control => Some(&$($mut)? scene.control.law),
                Table::Sensors => scene.control.sensors.$get(instance),
                Table::Guidance => scene.control.guidance.$get(instance),
                _ => None,
            }
        }
    };
}

impl Table {
    /// Tables whose keys are declared by a control law and its parts.
    pub const DECLARED: [Table; 3] = [Table::Control, Table::Sensors, Table::Guidance];

    declared!(declared, get);
    declared!(declared_mut, get_mut, mut);

    /// Dotted name of `key`, in the instance `owner` for a list.
    pub fn name(self, owner: Name, key: &str) -> String {
        let header = self.header();
        if owner == Name::NONE { format!("{header}.{key}") } else { format!("{header}.{owner}.{key}") }
    }

    /// Names of the instances of the table in `scene`; [`Name::NONE`] for a table without a list.
    pub fn owners(self, scene: &SceneInput) -> Vec<Name> {
        macro_rules! names {
            ($list:expr) => {
                $list.iter().map(|one| one.name).collect()
            };
        }
        match self {
            Table::Part | Table::PartErrors => names!(scene.parts),
            Table::Wheel => names!(scene.wheels),
            Table::Thruster => names!(scene.thrusters),
            Table::Plate => names!(scene.plates),
            Table::TorqueRod => names!(scene.torque_rods),
            Table::Actuation => vec![Name::NONE; scene.actuation.len()],
            Table::Sensors => names!(scene.control.sensors),
            Table::Guidance => names!(scene.control.guidance),
            Table::Failure => names!(scene.failures),
            Table::ArcErrors => {
                let name = |(index, name): (usize, Name)| if name == Name::NONE { Name::number(index) } else { name };
                scene.actuation.iter().map(|arc| arc.name).enumerate().map(name).collect()
            }
            _ => vec![Name::NONE],
        }
    }

    /// Keys of the table, in order of writing.
    pub fn keys(self) -> impl Iterator<Item = Key> {
        (0..self.count()).map(move |row| Key { table: self, row: row as u8, facts: self.facts_at(row) })
    }

    /// [`Table::keys`] of an instance of the table in `scene`, or its declared ones.
    pub fn keys_in(self, scene: &SceneInput, instance: usize) -> impl Iterator<Item = Key> + use<> {
        let declared = self.declared(scene, instance).map_or(&[][..], |table| table.declared.0);
        let of_law = move |(row, parameter): (usize, &'static LawParameter)| Key {
            table: self,
            row: row as u8,
            facts: &parameter.facts,
        };
        self.keys().chain(declared.iter().enumerate().map(of_law))
    }

    /// The key `name`, as in a campaign file.
    pub fn key(self, name: &str) -> Option<Key> {
        self.keys().find(|key| key.facts().key == name)
    }
}

impl Key {
    /// Facts about the key.
    #[inline(always)]
    pub const fn facts(self) -> &'static Facts {
        self.facts
    }

    /// Dotted name, in the instance `owner` for a list.
    pub fn name(self, owner: Name) -> String {
        self.table.name(owner, self.facts().key)
    }

    /// The numbers of the key in `scene`, if any; nine for a symmetric tensor.
    #[inline]
    pub fn read(self, scene: &SceneInput, instance: usize) -> Option<&[f64]> {
        if self.exists_in(scene) { self.in_table(scene, instance) } else { None }
    }

    /// [`Key::read`], mutable.
    #[inline]
    pub fn write(self, scene: &mut SceneInput, instance: usize) -> Option<&mut [f64]> {
        if self.exists_in(scene) { self.in_table_mut(scene, instance) } else { None }
    }

    #[inline(always)]
    const fn exists_in(self, scene: &SceneInput) -> bool {
        !self.facts.needs_debris || scene.debris.is_some()
    }

    /// Default numbers as in a campaign file; `None` for a required key, or one replaced by another.
    pub fn default_text(self) -> Option<String> {
        if self.facts.required.is_some() { None } else { self.read(&with_every_table(), 0).map(shown) }
    }
}

/// A scene with an instance of every table.
fn with_every_table() -> SceneInput {
    SceneInput {
        parts: vec![PartInput::DEFAULT],
        plates: vec![PlateInput::DEFAULT],
        wheels: vec![WheelInput::DEFAULT],
        thrusters: vec![ThrusterInput::DEFAULT],
        torque_rods: vec![TorqueRodInput::DEFAULT],
        debris: Some(DebrisInput::BLANK),
        orbit: Some(OrbitInput::DEFAULT),
        actuation: vec![ActuationInput::DEFAULT],
        failures: vec![FailureInput::DEFAULT],
        ..SceneInput::blank()
    }
}
