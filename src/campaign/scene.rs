//! The tables that describe the scene: which keys, with which defaults, says [`crate::scene::schema`].
//!
//! Here is what no single row can say: names, which ways to describe a body exclude each other, what belongs to a body
//! that is not there, and keys that are no numbers.

use super::control;
use super::failure_tables;
use super::section::Section;
use super::tables::{read_keys, read_name};
use crate::scene::body::MAX_PARTS;
use crate::scene::schema::Limit;
use crate::scene::schema::numbers::kept;
use crate::scene::table::Table;
use crate::scene::{
    ActuationInput, ControlInput, DebrisInput, Epoch, FieldModel, MAX_THRUSTERS, MAX_TORQUE_RODS, MAX_WHEELS, Name,
    OrbitInput, PartInput, PartShape, SceneInput, ThrusterInput, TorqueRodInput, WheelInput, WheelMode,
};
use crate::scene::{MAX_PLATES, PlateInput, Shadow};
use std::collections::HashSet;

/// Reads every table of the scene. A number that is missing or wrong is NaN, and noted in the document.
pub(super) fn read(root: &mut Section<'_, '_>) -> SceneInput {
    let mut scene = SceneInput::blank();
    if !root.has("body") {
        let content = "a table with the mass properties of the body, or its parts";
        root.document.add("body", None, content, "add a [body] table, or [[body.parts]] tables");
    }
    read_wheels(root, &mut scene);
    read_thrusters(root, &mut scene);
    read_torque_rods(root, &mut scene);
    if root.has("body") {
        read_body(root, &mut scene);
    }
    let mut names = HashSet::new();
    // each arc is read in the same time, and there are as many as a file may have keys
    root.sections("actuation", usize::MAX, |section| {
        scene.actuation.push(ActuationInput::DEFAULT);
        let arc = scene.actuation.len() - 1;
        read_keys(section, Table::Actuation, arc, &mut scene);
        scene.actuation[arc].name = read_arc_name(section, &mut names);
        read_commands(section, &mut scene, arc);
        read_keys(section, Table::ArcErrors, arc, &mut scene);
        section.finish();
    });
    let mut section = root.section("debris");
    if section.is_present() {
        scene.debris = Some(DebrisInput::BLANK);
        exclude_shapes(&mut section);
        read_keys(&mut section, Table::Debris, 0, &mut scene);
        section.finish();
    }
    let mut section = root.section("initial");
    read_keys(&mut section, Table::Initial, 0, &mut scene);
    refuse_states_of_absent_debris(&mut section, &scene);
    section.finish();
    let mut section = root.section("environment");
    read_keys(&mut section, Table::Environment, 0, &mut scene);
    scene.environment.gravity_gradient = section.flag("gravity_gradient").unwrap_or(false);
    scene.environment.magnetic_field =
        section.name("magnetic_field", &FieldModel::ALL.map(FieldModel::name), FieldModel::from_name);
    scene.environment.drag = section.flag("drag").unwrap_or(false);
    scene.environment.solar_pressure = section.flag("solar_pressure").unwrap_or(false);
    scene.environment.coupled = section.flag("coupled").unwrap_or(false);
    scene.environment.air_heights_m = read_list(&mut section, "air_heights_m");
    scene.environment.air_densities_kg_m3 = read_list(&mut section, "air_densities_kg_m3");
    let shadow = section.name("shadow", &Shadow::ALL.map(Shadow::name), Shadow::from_name);
    scene.environment.shadow = shadow.unwrap_or_default();
    section.finish();
    let mut section = root.section("orbit");
    if section.is_present() {
        scene.orbit = Some(OrbitInput { epoch: read_epoch(&mut section), ..OrbitInput::DEFAULT });
        read_keys(&mut section, Table::Orbit, 0, &mut scene);
        section.finish();
    }
    read_plates(root, &mut scene);
    if root.has("actuators") && !root.has("actuation") {
        let remedy = "delete this table, or add [[actuation]] tables";
        root.refuse("actuators", "left out where there is no [[actuation]]", remedy);
    }
    let mut section = root.section("actuators");
    read_keys(&mut section, Table::Actuators, 0, &mut scene);
    section.finish();
    read_law(root, &mut scene);
    failure_tables::read(root, &mut scene);
    scene
}

/// Reads the parameters of the control law that the program brings, or the control loop of the file.
fn read_law(root: &mut Section<'_, '_>, scene: &mut SceneInput) {
    let Some(law) = root.document.law.clone() else {
        return read_loop(root, scene);
    };
    scene.control = ControlInput::of(law.parameters());
    let mut section = root.section("control");
    let name = section.text("law");
    if name.is_some_and(|name| name != law.name()) {
        let remedy = "open it with the program whose control law it names";
        section.refuse("law", format!("{:?}, the control law of this program", law.name()), remedy);
    }
    read_keys(&mut section, Table::Control, 0, scene);
    section.finish();
}

/// Reads the control loop, where the file has one; refuses what only a loop has where it has none.
fn read_loop(root: &mut Section<'_, '_>, scene: &mut SceneInput) {
    if root.has("control") {
        root.document.law = control::read(root, scene);
        root.document.is_loop_unknown = root.document.law.is_none();
        return;
    }
    for key in ["sensors", "guidance"] {
        root.know(key);
        if root.has(key) {
            root.refuse(key, "left out without [control]", "add a [control] table, or delete this one");
        }
    }
    if root.has("torque_rods") {
        let allowed = "left out without [control]: a schedule does not command torque rods";
        root.refuse("torque_rods", allowed, "add a [control] table, or delete this one");
    }
    let wheels = scene.wheels.iter().map(|wheel| {
        let values =
            [wheel.torque_limit_n_m, wheel.speed_limit_rad_s, wheel.coulomb_friction_n_m, wheel.viscous_friction_n_m_s];
        ("wheels", wheel.name, WheelInput::DRIVE.into_iter().zip(values).collect::<Vec<_>>())
    });
    let thrusters = scene.thrusters.iter().map(|thruster| {
        let values = [thruster.max_thrust_n, thruster.min_on_time_s];
        ("thrusters", thruster.name, ThrusterInput::DRIVE.into_iter().zip(values).collect::<Vec<_>>())
    });
    for (header, name, keys) in wheels.chain(thrusters) {
        for (key, value) in keys {
            if let Some(value) = value {
                let remedy = "delete it, or add a [control] table";
                let path = format!("{header}.{name}.{key}");
                root.document.add(
                    &path,
                    Some(format!("{value:?}")),
                    "left out without [control]: a schedule commands what is applied",
                    remedy,
                );
            }
        }
    }
}

/// The numbers of `key`, of any count, if they were written.
fn read_list(section: &mut Section<'_, '_>, key: &'static str) -> Option<&'static [f64]> {
    let values = section.values(key, section.unit_of(key))?;
    Some(kept(values.numbers()))
}

/// The date of an orbit, if it has one.
fn read_epoch(section: &mut Section<'_, '_>) -> Option<Epoch> {
    let text = section.text("epoch")?;
    let epoch = Epoch::parse(text);
    if epoch.is_none() {
        section.refuse("epoch", Epoch::ALLOWED, "correct the date");
    }
    epoch
}

/// The name of an arc, if it has one, different from `taken`, to which it is added.
fn read_arc_name(section: &mut Section<'_, '_>, taken: &mut HashSet<Name>) -> Name {
    let Some(text) = section.text("name") else { return Name::NONE };
    let Some(name) = Name::new(text) else {
        section.refuse("name", Name::ALLOWED, "write a name such as \"burn1\", or leave it out");
        return Name::NONE;
    };
    if !taken.insert(name) {
        section.refuse("name", "another name than that of the other [[actuation]] tables", "give each its own name");
    }
    name
}

fn read_wheels(root: &mut Section<'_, '_>, scene: &mut SceneInput) {
    root.sections("wheels", MAX_WHEELS, |section| {
        let taken: Vec<Name> = scene.wheels.iter().map(|wheel| wheel.name).collect();
        let name = read_name(section, Table::Wheel, &taken);
        exclude_wheel_masses(section);
        scene.wheels.push(WheelInput { name, ..WheelInput::DEFAULT });
        let wheel = scene.wheels.len() - 1;
        read_keys(section, Table::Wheel, wheel, scene);
        let mode = section.name("mode", &WheelMode::ALL.map(WheelMode::name), WheelMode::from_name);
        scene.wheels[wheel].mode = mode.unwrap_or_default();
        if mode == Some(WheelMode::Locked) && scene.wheels[wheel].rate_rad_s != 0.0 {
            section.refuse(
                "rate_rad_s",
                "left out (or 0) where mode is \"locked\"",
                "delete it, or choose another mode",
            );
        }
        section.finish();
    });
}

/// A wheel is a solid cylinder, or given by mass and inertias.
fn exclude_wheel_masses(section: &mut Section<'_, '_>) {
    let by_mass = WheelInput::MASSES.iter().any(|key| section.has(key));
    let (asked, excluded) =
        if by_mass { (WheelInput::MASSES, WheelInput::SIZES) } else { (WheelInput::SIZES, WheelInput::MASSES) };
    for key in excluded {
        if section.has(key) {
            section.refuse(key, "left out where the wheel is given by mass and inertias", "delete this line");
        }
    }
    // a thin disc has a transverse moment of half its axial one
    let [_, axial, transverse] = WheelInput::MASSES.map(|key| section.written(key));
    let of_mass = [5.0, transverse.map_or(0.01, |moment| 1.6 * moment), axial.map_or(0.006, |moment| 0.6 * moment)];
    for (key, example) in asked.into_iter().zip(if by_mass { of_mass } else { [0.25, 0.1, 2700.0] }) {
        section.require(key, "a finite number", &format!("{example:?}"));
    }
}

fn read_thrusters(root: &mut Section<'_, '_>, scene: &mut SceneInput) {
    root.sections("thrusters", MAX_THRUSTERS, |section| {
        let taken: Vec<Name> = scene.thrusters.iter().map(|thruster| thruster.name).collect();
        let name = read_name(section, Table::Thruster, &taken);
        scene.thrusters.push(ThrusterInput { name, ..ThrusterInput::DEFAULT });
        let thruster = scene.thrusters.len() - 1;
        read_keys(section, Table::Thruster, thruster, scene);
        section.finish();
    });
}

fn read_plates(root: &mut Section<'_, '_>, scene: &mut SceneInput) {
    root.sections("plates", MAX_PLATES, |section| {
        let taken: Vec<Name> = scene.plates.iter().map(|plate| plate.name).collect();
        let name = read_name(section, Table::Plate, &taken);
        scene.plates.push(PlateInput { name, ..PlateInput::DEFAULT });
        let plate = scene.plates.len() - 1;
        read_keys(section, Table::Plate, plate, scene);
        section.finish();
    });
}

fn read_torque_rods(root: &mut Section<'_, '_>, scene: &mut SceneInput) {
    root.sections("torque_rods", MAX_TORQUE_RODS, |section| {
        let taken: Vec<Name> = scene.torque_rods.iter().map(|rod| rod.name).collect();
        let name = read_name(section, Table::TorqueRod, &taken);
        scene.torque_rods.push(TorqueRodInput { name, ..TorqueRodInput::DEFAULT });
        let rod = scene.torque_rods.len() - 1;
        read_keys(section, Table::TorqueRod, rod, scene);
        section.finish();
    });
}

fn read_body(root: &mut Section<'_, '_>, scene: &mut SceneInput) {
    let mut section = root.section("body");
    section.sections("parts", MAX_PARTS, |section| {
        let taken: Vec<Name> = scene.parts.iter().map(|part| part.name).collect();
        let name = read_name(section, Table::Part, &taken);
        section.require("shape", &format!("one of {}", PartShape::ALL.map(PartShape::name).join(", ")), "\"box\"");
        let shape = section.name("shape", &PartShape::ALL.map(PartShape::name), PartShape::from_name);
        if let Some(shape) = shape {
            exclude_sizes(section, shape);
        }
        scene.parts.push(PartInput { name, shape: shape.unwrap_or(PartShape::PointMass), ..PartInput::DEFAULT });
        let part = scene.parts.len() - 1;
        read_keys(section, Table::Part, part, scene);
        read_keys(section, Table::PartErrors, part, scene);
        section.finish();
    });
    let (has_parts, has_wheels) = (!scene.parts.is_empty(), !scene.wheels.is_empty());
    exclude_inertias(&mut section);
    if !has_parts {
        section.require("mass_kg", "a finite number (or describe the body by [[body.parts]])", "500.0");
        if ![MOMENTS, SECOND].iter().any(|key| section.has(key)) {
            let allowed = format!("given (or {MOMENTS}, {SECOND}, or [[body.parts]])");
            section.require(TENSOR, &allowed, "[[100, 0, 0], [0, 120, 0], [0, 0, 80]]");
        }
    }
    read_keys(&mut section, Table::Body, 0, scene);
    read_keys(&mut section, Table::BodyErrors, 0, scene);
    let is_direct = section.has("mass_kg") || section.has(TENSOR) || section.has(MOMENTS) || section.has(SECOND);
    if is_direct && !has_parts && has_wheels {
        let allowed = "true or false: whether mass, centre and inertia of the body are those with the wheels";
        section.require("includes_wheels", allowed, "false");
    }
    scene.body.includes_wheels = section.flag("includes_wheels").unwrap_or(false);
    if has_parts && scene.body.includes_wheels {
        let allowed = "false, or left out, where the body has parts: they do not include the wheels";
        section.refuse("includes_wheels", allowed, "delete this line");
    }
    section.finish();
}

/// A part has the sizes of its shape, and a density or a mass.
fn exclude_sizes(section: &mut Section<'_, '_>, shape: PartShape) {
    const SIZES: [(&str, &str); 5] = [
        ("outer_radius_m", "1.0"),
        ("wall_thickness_m", "0.03"),
        ("radius_m", "0.5"),
        ("length_m", "1.0"),
        ("size_m", "[1.0, 1.0, 1.0]"),
    ];
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
        if section.has("density_kg_m3") {
            section.refuse("density_kg_m3", "left out: a point has no volume", "write mass_kg");
        }
        section.require("mass_kg", "a finite number", "10.0");
    } else if !section.has("mass_kg") {
        section.require("density_kg_m3", "given (or mass_kg)", "2700.0");
    } else if section.has("density_kg_m3") {
        section.refuse("density_kg_m3", "left out where mass_kg is given", "delete one of the two");
    }
}

/// The thrusts and torques of an arc, by the names of thrusters and wheels.
fn read_commands(section: &mut Section<'_, '_>, scene: &mut SceneInput, arc: usize) {
    let thrusters: Vec<Name> = scene.thrusters.iter().map(|thruster| thruster.name).collect();
    let wheels: Vec<Name> = scene.wheels.iter().map(|wheel| wheel.name).collect();
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
    let unit = section.unit_of(key);
    let mut table = section.section(key);
    table.measures(unit);
    for (name, number) in names.iter().zip(numbers) {
        if table.has(name.as_str()) {
            table.fill(name.as_str(), std::slice::from_mut(number), Limit::Finite);
        } else {
            table.know(name.as_str());
        }
    }
    table.finish();
}

const MOMENTS: &str = "principal_moments_kg_m2";
const SECOND: &str = "principal_second_moments_kg_m2";
const TENSOR: &str = "inertia_kg_m2";

/// Of the ways to write an inertia at most one may be used; axes belong to principal moments.
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

/// Debris is a cube, a box, or an irregular body given by mass and inertia.
fn exclude_shapes(section: &mut Section<'_, '_>) {
    exclude_inertias(section);
    let inertias = [TENSOR, MOMENTS, SECOND];
    if !["mass_kg"].iter().chain(&inertias).any(|key| section.has(key)) {
        if section.has("side_m") && section.has("size_m") {
            section.refuse("size_m", "left out where side_m is given", "delete side_m or size_m");
        }
        return;
    }
    for key in ["side_m", "size_m", "density_kg_m3"].into_iter().filter(|key| section.has(key)).collect::<Vec<_>>() {
        section.refuse(key, "left out where the debris is given by mass and inertia", "delete this line");
    }
    if !inertias.iter().any(|key| section.has(key)) {
        let allowed = format!("given with mass_kg (or {MOMENTS}, {SECOND})");
        section.require(TENSOR, &allowed, "[[3, 0, 0], [0, 3, 0], [0, 0, 2]]");
    }
}

/// What belongs to debris that the scene does not have.
fn refuse_states_of_absent_debris(section: &mut Section<'_, '_>, scene: &SceneInput) {
    let absent = |key: &&str| section.has(key);
    let keys: Vec<&str> = Table::Initial
        .keys()
        .filter(|key| key.read(scene, 0).is_none())
        .map(|key| key.facts().key)
        .filter(absent)
        .collect();
    for key in keys {
        section.refuse(key, "left out where there is no debris", "delete this line, or add a [debris] table");
    }
}
