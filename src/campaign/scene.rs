//! The tables that describe the scene: which keys, with which defaults, says [`crate::scene::schema`].
//!
//! Here is what no single row can say: which ways to describe a body exclude each other, what belongs to a body that is not
//! there, and `wheel_mode`, which is no number.

use super::section::Section;
use crate::scene::table::Table;
use crate::scene::{ActuationInput, DebrisInput, SceneInput, WheelInput, WheelMode};

/// Reads every table of the scene. A number that is missing or wrong is NaN, and noted in the document.
pub(super) fn read(root: &mut Section<'_, '_>) -> SceneInput {
    let mut scene = SceneInput::default();
    // whether there is a schedule decides which keys of the fuselage are required
    root.sections("actuation", |section| {
        scene.actuation.push(ActuationInput::DEFAULT);
        let arc = scene.actuation.len() - 1;
        read_keys(section, Table::Actuation, arc, &mut scene);
        section.finish();
    });
    {
        let mut section = root.section("fuselage");
        exclude_inertias(&mut section);
        read_keys(&mut section, Table::Fuselage, 0, &mut scene);
        section.finish();
    }
    for (instance, header) in Table::Wheel.headers().iter().enumerate() {
        let mut section = root.section(header);
        if section.is_present() {
            scene.wheels[instance] = Some(WheelInput::DEFAULT);
            read_keys(&mut section, Table::Wheel, instance, &mut scene);
            let mode = section.name("wheel_mode", &WheelMode::ALL.map(WheelMode::name), WheelMode::from_name);
            if let (Some(wheel), Some(mode)) = (&mut scene.wheels[instance], mode) {
                wheel.mode = mode;
            }
            section.finish();
        }
    }
    let mut section = root.section("debris");
    if section.is_present() {
        scene.debris = Some(DebrisInput::default());
        exclude_shapes(&mut section);
        read_keys(&mut section, Table::Debris, 0, &mut scene);
        section.finish();
    }
    let mut section = root.section("initial");
    read_keys(&mut section, Table::Initial, 0, &mut scene);
    refuse_states_of_absent_bodies(&mut section, &scene);
    section.finish();
    let mut section = root.section("environment");
    read_keys(&mut section, Table::Environment, 0, &mut scene);
    section.finish();
    if root.has("actuators") && !root.has("actuation") {
        let remedy = "delete this table, or add [[actuation]] tables";
        root.refuse("actuators", "left out where there is no [[actuation]]", remedy);
    }
    let mut section = root.section("actuators");
    read_keys(&mut section, Table::Actuators, 0, &mut scene);
    section.finish();
    scene
}

/// Reads the keys of one table into the scene.
fn read_keys(section: &mut Section<'_, '_>, table: Table, instance: usize, scene: &mut SceneInput) {
    // a key that is written may be another way to describe a body
    for key in table.keys().filter(|key| section.has(key.facts().key)) {
        if key.read(scene, instance).is_none() {
            key.open(scene, instance);
        }
    }
    for key in table.keys() {
        let (name, example) = (key.facts().key, key.required(scene));
        let Some(numbers) = key.write(scene, instance) else {
            section.know(name);
            continue;
        };
        if let Some(example) = example {
            section.require_numbers(name, numbers.len(), example);
        }
        if !section.fill(name, numbers) && example.is_some() {
            numbers.fill(f64::NAN);
        }
    }
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

/// What belongs to a wheel or to debris that the scene does not have.
fn refuse_states_of_absent_bodies(section: &mut Section<'_, '_>, scene: &SceneInput) {
    for (key, values) in
        [("wheel_angles_rad", scene.initial.wheel_angles_rad), ("wheel_rates_rad_s", scene.initial.wheel_rates_rad_s)]
    {
        let moves =
            |wheel: &usize| scene.wheels[*wheel].is_none() && values[*wheel] != 0.0 && values[*wheel].is_finite();
        if let Some(wheel) = (0..values.len()).find(moves) {
            let allowed = format!("0 for wheel {}, which this spacecraft does not have", wheel + 1);
            section.refuse(key, allowed, format!("write 0 there, or add a [{}] table", Table::Wheel.headers()[wheel]));
        }
    }
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
