//! The scene's tables: [`crate::scene::schema`] declares their numbers, this file their other keys and the rules
//! between several keys.

use super::lines::Lines;
use super::loop_tables::LoopTables;
use super::parameter::lacking;
use super::scene_table::{Field, SceneTable, flag, list, word};
use super::section::Section;
use super::tables::read_keys;
use super::{failure_tables, units};
use crate::loops::OwnLaw;
use crate::loops::attitude_law::LawKind;
use crate::sampling::keys::{Kind, Row, TextLimit, Value};
use crate::scene::body::MAX_PARTS;
use crate::scene::schema::Limit;
use crate::scene::schema::numbers::kept;
use crate::scene::table::Table;
use crate::scene::{
    ActuationInput, ControlInput, DebrisInput, EnvironmentInput, Epoch, FieldModel, MAX_PLATES, MAX_THRUSTERS,
    MAX_TORQUE_RODS, MAX_WHEELS, Name, OrbitInput, PartInput, PartShape, PlateInput, SceneInput, Shadow, ThrusterInput,
    TorqueRodInput, WheelInput, WheelMode,
};

const MODES: [&str; WheelMode::ALL.len()] = ["free", "speed_held", "locked"];
const SHADOWS: [&str; Shadow::ALL.len()] = ["cone", "cylinder"];
const EPOCH: TextLimit =
    TextLimit { allowed: Epoch::ALLOWED, remedy: "correct the date", test: |text| Epoch::parse(text).is_some() };

/// Commands of an arc by the names of actuators, which [`read_commands`] reads.
macro_rules! by_name {
    ($key:ident, $list:ident, $meaning:literal) => {
        Field {
            row: Row::new(stringify!($key), Kind::ByName, $meaning),
            get: |scene, arc| {
                let names = scene.$list.iter().map(|one| one.name);
                Some(Value::ByName(names.zip(scene.actuation[arc].$key).collect()))
            },
            set: |_, _, _| {},
        }
    };
}

/// All tables of the scene except control loop and failures, in the order of canonical text.
#[rustfmt::skip]
pub static TABLES: [SceneTable; 12] = [
    SceneTable::new(&[Table::Body, Table::BodyErrors], |_| true).checked(check_body).with(&[], &[Field {
        row: Row::new("includes_wheels", Kind::Flag, "Whether mass, centre and inertia are those with the wheels"),
        get: |scene, _| scene.parts.is_empty().then(|| scene.body.includes_wheels.into()),
        set: |scene, _, value| scene.body.includes_wheels = *value == Value::Flag(true),
    }]),
    SceneTable::list(&[Table::Part, Table::PartErrors], MAX_PARTS, |scene, name| {
        scene.parts.push(PartInput { name, shape: PartShape::PointMass, ..PartInput::DEFAULT });
    })
    .checked(check_part)
    .with(&[word!(
        Row::new("shape", Kind::OneOf(|| PartShape::ALL.map(PartShape::name).to_vec()), "Its shape")
            .required_as("one of hollow_cylinder, solid_cylinder, box, sphere, point_mass", "\"box\""),
        PartShape, scene, part => scene.parts[part].shape
    )], &[]),
    SceneTable::list(&[Table::Wheel], MAX_WHEELS, |scene, name| {
        scene.wheels.push(WheelInput { name, ..WheelInput::DEFAULT });
    })
    .checked(check_wheel)
    .with(&[word!(
        Row::new("mode", Kind::Word(&MODES), "What it does where no torque is commanded"),
        WheelMode, scene, wheel => scene.wheels[wheel].mode
    )], &[]),
    SceneTable::list(&[Table::Thruster], MAX_THRUSTERS, |scene, name| {
        scene.thrusters.push(ThrusterInput { name, ..ThrusterInput::DEFAULT });
    }),
    SceneTable::list(&[Table::TorqueRod], MAX_TORQUE_RODS, |scene, name| {
        scene.torque_rods.push(TorqueRodInput { name, ..TorqueRodInput::DEFAULT });
    }),
    SceneTable::new(&[Table::Debris], |scene| scene.debris.is_some())
        .optional(|scene, _| scene.debris = Some(DebrisInput::BLANK))
        .checked(exclude_shapes),
    SceneTable::new(&[Table::Initial], |_| true).checked(refuse_states_of_absent_debris),
    SceneTable::new(&[Table::Environment], |scene| scene.environment != EnvironmentInput::DEFAULT)
        .checked(ignore_idle)
        .with(&[], &[
            flag!(gravity_gradient, "Whether the torque of the gravity gradient acts; default: false"),
            flag!(drag, "Whether the torque of the air on the plates acts; default: false"),
            flag!(solar_pressure, "Whether the torque of sunlight on the plates acts; default: false"),
            flag!(coupled, "Whether the forces of air and light move the spacecraft; default: false"),
            list!(air_heights_m, "Heights at which the density of the air is given"),
            list!(air_densities_kg_m3, "The density at each of them"),
            word!(Row::new("shadow", Kind::Word(&SHADOWS), "The shape of the Earth's shadow").sparse(),
                Shadow, scene, _place => scene.environment.shadow),
            Field {
                row: Row::new("magnetic_field", Kind::OneOf(|| FieldModel::ALL.map(FieldModel::name).to_vec()),
                    "The model of the Earth's magnetic field; default: none"),
                get: |scene, _| scene.environment.magnetic_field.map(|model| model.name().into()),
                set: |scene, _, value| {
                    scene.environment.magnetic_field = value.text().and_then(FieldModel::from_name);
                },
            },
        ]),
    SceneTable::new(&[Table::Orbit], |scene| scene.orbit.is_some())
        .optional(|scene, _| scene.orbit = Some(OrbitInput::DEFAULT))
        .with(&[], &[Field {
            row: Row::new("epoch", Kind::Text(EPOCH), "Date and time of the start of the run, UTC"),
            get: |scene, _| Some(scene.orbit?.epoch?.to_string().as_str().into()),
            set: |scene, _, value| {
                let epoch = value.text().and_then(Epoch::parse);
                scene.orbit.iter_mut().for_each(|orbit| orbit.epoch = epoch);
            },
        }]),
    SceneTable::list(&[Table::Plate], MAX_PLATES, |scene, name| {
        scene.plates.push(PlateInput { name, ..PlateInput::DEFAULT });
    }),
    // the number of arcs is limited by the file's number of keys alone
    SceneTable::list(&[Table::Actuation, Table::ArcErrors], usize::MAX, |scene, name| {
        scene.actuation.push(ActuationInput { name, ..ActuationInput::DEFAULT });
    })
    .checked(read_commands)
    .with(&[], &[
        by_name!(thrust_n, thrusters, "Commanded thrusts, by the names of thrusters"),
        by_name!(torque_n_m, wheels, "Commanded motor torques, by the names of wheels"),
    ]),
    SceneTable::new(&[Table::Actuators], |scene| !scene.actuation.is_empty()).checked(|section, scene, _| {
        if section.is_present() && scene.actuation.is_empty() {
            let remedy = "delete this table, or add [[actuation]] tables";
            section.refuse_table("left out where there is no [[actuation]]", remedy);
        }
    }),
];

pub(super) fn read(root: &mut Section<'_, '_>, loops: &dyn LoopTables) -> SceneInput {
    let mut scene = SceneInput::blank();
    if !root.has("body") {
        let content = "a table with the mass properties of the body, or its parts";
        root.document.add("body", None, content, "add a [body] table, or [[body.parts]] tables");
    }
    // the checks of the body depend on its parts and on the wheels
    TABLES[1..].iter().for_each(|table| table.read(root, &mut scene));
    if root.has("body") {
        TABLES[0].read(root, &mut scene);
    }
    read_law(root, &mut scene, loops);
    failure_tables::TABLE.read(root, &mut scene);
    scene
}

pub(super) fn write(scene: &SceneInput, lines: &mut Lines, write_law: impl FnOnce(&mut Lines)) {
    TABLES.iter().for_each(|table| table.write(scene, lines));
    write_law(lines);
    failure_tables::TABLE.write(scene, lines);
}

fn ignore_idle(section: &mut Section<'_, '_>, scene: &mut SceneInput, _place: usize) {
    let (written, blank) = (scene.environment, SceneInput::blank());
    let mut idle = Vec::new();
    for key in Table::Environment.keys_in(scene, 0) {
        let (Some(default), Some(numbers)) = (key.read(&blank, 0), key.write(scene, 0)) else { continue };
        // a wrong number is refused even without effect
        let is_valid = numbers.iter().all(|number| number.is_finite() && *number >= 0.0);
        if lacking(&written, "environment", key.facts().key).is_some() && is_valid && numbers != default {
            numbers.copy_from_slice(default);
            idle.push(key.facts().key);
        }
    }
    if !written.solar_pressure && std::mem::take(&mut scene.environment.shadow) != Shadow::default() {
        idle.push("shadow");
    }
    for key in idle {
        let setting = lacking(&written, "environment", key).unwrap_or_default();
        section.ignore([key], &format!("environment.{setting}"));
    }
}

/// Reads the control law: the file's loop, or the parameters of the calling program's law in its place.
fn read_law(root: &mut Section<'_, '_>, scene: &mut SceneInput, loops: &dyn LoopTables) {
    let law = match root.document.own_law.take() {
        Some(OwnLaw::Loop(law)) => law,
        Some(OwnLaw::Phase(kind)) => return read_loop(root, scene, loops, Some(&kind)),
        None => return read_loop(root, scene, loops, None),
    };
    scene.control = ControlInput::of(law.parameters);
    let mut section = root.section("control");
    let name = section.text("law");
    if name.is_some_and(|name| name != law.name) {
        let remedy = "open it with the program whose control law it names";
        section.refuse("law", format!("{:?}, the control law of this program", law.name), remedy);
    }
    read_keys(&mut section, Table::Control, 0, scene);
    section.finish();
    root.document.law = Some(law);
}

fn read_loop(root: &mut Section<'_, '_>, scene: &mut SceneInput, loops: &dyn LoopTables, own: Option<&LawKind>) {
    if root.has("control") {
        root.document.law = loops.read(root, scene, own);
        root.document.is_loop_unknown = root.document.law.is_none();
        return;
    }
    let tables = ["sensors", "guidance"];
    tables.iter().for_each(|key| root.know(key));
    let remedy = "add a [control] table, or delete this one";
    root.refuse_written(tables, "left out without [control]", remedy);
    let allowed = "left out without [control]: a schedule does not command torque rods";
    root.refuse_written(["torque_rods"], allowed, remedy);
    let drives = [(Table::Wheel, &WheelInput::DRIVE[..]), (Table::Thruster, &ThrusterInput::DRIVE)];
    for (table, drive) in drives {
        for (place, name) in table.owners(scene).into_iter().enumerate() {
            for key in table.keys_in(scene, place).filter(|key| drive.contains(&key.facts().key)) {
                let Some([value]) = key.read(scene, place) else { continue };
                let path = format!("{}.{name}.{}", table.header(), key.facts().key);
                let allowed = "left out without [control]: a schedule commands what is applied";
                let remedy = "delete it, or add a [control] table";
                root.document.add(&path, Some(format!("{value:?}")), allowed, remedy);
            }
        }
    }
}

fn check_wheel(section: &mut Section<'_, '_>, scene: &mut SceneInput, place: usize) {
    let by_mass = WheelInput::MASSES.iter().any(|key| section.has(key));
    let (asked, excluded) =
        if by_mass { (WheelInput::MASSES, WheelInput::SIZES) } else { (WheelInput::SIZES, WheelInput::MASSES) };
    section.refuse_written(excluded, "left out where the wheel is given by mass and inertias", "delete this line");
    let [_, axial, transverse] = WheelInput::MASSES.map(|key| section.written(key));
    let of_mass = [5.0, transverse.map_or(0.01, |moment| 1.6 * moment), axial.map_or(0.006, |moment| 0.6 * moment)];
    for (key, example) in asked.into_iter().zip(if by_mass { of_mass } else { [0.25, 0.1, 2700.0] }) {
        section.require(key, "a finite number", &format!("{example:?}"));
    }
    if scene.wheels[place].mode == WheelMode::Locked && scene.wheels[place].rate_rad_s != 0.0 {
        let allowed = "left out (or 0) where mode is \"locked\"";
        section.refuse("rate_rad_s", allowed, "delete it, or choose another mode");
    }
}

fn check_body(section: &mut Section<'_, '_>, scene: &mut SceneInput, _place: usize) {
    section.know("parts");
    let (has_parts, has_wheels) = (!scene.parts.is_empty(), !scene.wheels.is_empty());
    exclude_inertias(section);
    if !has_parts {
        section.require("mass_kg", "a finite number (or describe the body by [[body.parts]])", "500.0");
        if ![MOMENTS, SECOND].iter().any(|key| section.has(key)) {
            let allowed = format!("given (or {MOMENTS}, {SECOND}, or [[body.parts]])");
            section.require(TENSOR, &allowed, "[[100, 0, 0], [0, 120, 0], [0, 0, 80]]");
        }
    }
    let is_direct = ["mass_kg", TENSOR, MOMENTS, SECOND].iter().any(|key| section.has(key));
    if is_direct && !has_parts && has_wheels {
        let allowed = "true or false: whether mass, centre and inertia of the body are those with the wheels";
        section.require("includes_wheels", allowed, "false");
    }
    if has_parts && scene.body.includes_wheels {
        let allowed = "false, or left out, where the body has parts: they do not include the wheels";
        section.refuse("includes_wheels", allowed, "delete this line");
    }
}

fn check_part(section: &mut Section<'_, '_>, scene: &mut SceneInput, place: usize) {
    const SIZES: [(&str, &str); 5] = [
        ("outer_radius_m", "1.0"),
        ("wall_thickness_m", "0.03"),
        ("radius_m", "0.5"),
        ("length_m", "1.0"),
        ("size_m", "[1.0, 1.0, 1.0]"),
    ];
    let shape = scene.parts[place].shape;
    if section.plain_text("shape").and_then(PartShape::from_name).is_none() {
        return;
    }
    for (key, example) in SIZES {
        if shape.sizes().contains(&key) {
            section.require(key, "given", example);
        } else if section.has(key) {
            let sizes = shape.sizes().join(", ");
            let has = if sizes.is_empty() { "has no size".to_owned() } else { format!("has {sizes}") };
            section.refuse(key, format!("left out: a {} {has}", shape.name()), "delete this line, or change the shape");
        }
    }
    if shape == PartShape::PointMass {
        section.refuse_written(["density_kg_m3"], "left out: a point has no volume", "write mass_kg");
        section.require("mass_kg", "a finite number", "10.0");
    } else if !section.has("mass_kg") {
        section.require("density_kg_m3", "given (or mass_kg)", "2700.0");
    } else {
        section.refuse_written(["density_kg_m3"], "left out where mass_kg is given", "delete one of the two");
    }
}

fn read_commands(section: &mut Section<'_, '_>, scene: &mut SceneInput, arc: usize) {
    let [thrusters, wheels] = [Table::Thruster, Table::Wheel].map(|table| table.owners(scene));
    let command = &mut scene.actuation[arc];
    read_by_name(section, "thrust_n", &thrusters, "thrusters", &mut command.thrust_n);
    read_by_name(section, "torque_n_m", &wheels, "wheels", &mut command.torque_n_m);
}

fn read_by_name(section: &mut Section<'_, '_>, key: &'static str, names: &[Name], list: &str, numbers: &mut [f64]) {
    if names.is_empty() && section.has(key) && !(section.is_table(key) && section.entries(key).is_empty()) {
        section.know(key);
        let remedy = format!("delete this line, or add [[{list}]] tables");
        section.refuse(key, format!("left out where there are no [[{list}]]"), remedy);
        return;
    }
    if section.has(key) && !section.is_table(key) {
        section.know(key);
        let entries: Vec<String> = names.iter().map(|name| format!("{name} = 0.0")).collect();
        let allowed = format!("a table of numbers by the names of [[{list}]]");
        section.refuse(key, allowed, format!("write {key} = {{ {} }}", entries.join(", ")));
        return;
    }
    let mut table = section.section(key);
    for (name, number) in names.iter().zip(numbers) {
        if table.has(name.as_str()) {
            table.fill(name.as_str(), units::in_name(key), std::slice::from_mut(number), Limit::Finite);
        } else {
            table.know(name.as_str());
        }
    }
    table.finish();
}

const MOMENTS: &str = "principal_moments_kg_m2";
const SECOND: &str = "principal_second_moments_kg_m2";
const TENSOR: &str = "inertia_kg_m2";

/// At most one description of the inertia is allowed; axes need principal moments.
fn exclude_inertias(section: &mut Section<'_, '_>) {
    let written: Vec<&str> = [MOMENTS, SECOND].into_iter().filter(|key| section.has(key)).collect();
    if let [first, second] = written[..] {
        section.refuse(second, format!("left out where {first} is given"), "delete one of the two");
    }
    match written.first() {
        Some(first) if section.has(TENSOR) => {
            section.refuse(TENSOR, format!("left out where {first} is given"), "delete one of the two");
        }
        None if section.has("principal_axes") => {
            let allowed = "left out where there are no principal moments";
            section.refuse("principal_axes", allowed, format!("delete this line, or add {MOMENTS}"));
        }
        _ => {}
    }
}

fn exclude_shapes(section: &mut Section<'_, '_>, _scene: &mut SceneInput, _place: usize) {
    exclude_inertias(section);
    let inertias = [TENSOR, MOMENTS, SECOND];
    if !["mass_kg"].iter().chain(&inertias).any(|key| section.has(key)) {
        if section.has("side_m") && section.has("size_m") {
            section.refuse("size_m", "left out where side_m is given", "delete side_m or size_m");
        }
        return;
    }
    let allowed = "left out where the debris is given by mass and inertia";
    section.refuse_written(["side_m", "size_m", "density_kg_m3"], allowed, "delete this line");
    if !inertias.iter().any(|key| section.has(key)) {
        let allowed = format!("given with mass_kg (or {MOMENTS}, {SECOND})");
        section.require(TENSOR, &allowed, "[[3, 0, 0], [0, 3, 0], [0, 0, 2]]");
    }
}

fn refuse_states_of_absent_debris(section: &mut Section<'_, '_>, scene: &mut SceneInput, _place: usize) {
    let keys = Table::Initial.keys().filter(|key| key.read(scene, 0).is_none()).map(|key| key.facts().key);
    let remedy = "delete this line, or add a [debris] table";
    section.refuse_written(keys, "left out where there is no debris", remedy);
}
