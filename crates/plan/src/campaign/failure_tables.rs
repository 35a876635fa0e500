//! `[[failure]]`: devices that fail during a run.

use super::scene_table::{Field, SceneTable};
use super::section::Section;
use crate::sampling::keys::{Kind, Row};
use crate::scene::table::Table;
use crate::scene::{Device, FailureInput, Name, SceneInput, SensorOutput, WheelMode};

const MOST_FAILURES: usize = 16;
/// The keys of devices, of which a failure has one.
const DEVICES: [&str; 4] = ["wheel", "thruster", "torque_rod", "sensor"];

/// The further keys of a failure, in the order of [`DEVICES`].
const KEYS: [&[&str]; 4] =
    [&FailureInput::OF_WHEELS, &FailureInput::OF_THRUSTERS, &FailureInput::OF_RODS, &FailureInput::OF_SENSORS];
const SENSOR: usize = 3;

macro_rules! device {
    ($kind:literal, $meaning:literal) => {
        Field {
            row: Row::new(DEVICES[$kind], Kind::Name, $meaning),
            get: |scene, place| {
                let (key, device) = named(scene, scene.failures[place].device)?;
                (key == DEVICES[$kind]).then(|| device.as_str().into())
            },
            // set by `check`
            set: |_, _, _| {},
        }
    };
}

/// Read after the devices of the scene.
#[rustfmt::skip]
pub static TABLE: SceneTable = SceneTable::list(&[Table::Failure], MOST_FAILURES, |scene, name| {
    scene.failures.push(FailureInput { name, ..FailureInput::DEFAULT });
})
.checked(check)
.with(&[
    device!(0, "The wheel that fails"),
    device!(1, "The thruster that fails"),
    device!(2, "The torque rod that fails"),
    device!(3, "The sensor that fails"),
    Field {
        row: Row::new("output", Kind::OneOf(|| SensorOutput::ALL.map(SensorOutput::name).to_vec()),
            "What a sensor delivers from then on"),
        get: |scene, place| scene.failures[place].output.map(|output| output.name().into()),
        set: |scene, place, value| scene.failures[place].output = value.text().and_then(SensorOutput::from_name),
    },
], &[]);

fn check(section: &mut Section<'_, '_>, scene: &mut SceneInput, place: usize) {
    let has_loop = section.document.law.is_some() || section.document.is_loop_unknown;
    if let Some((kind, device)) = read_device(section, scene, has_loop) {
        check_keys(section, kind);
        check_device(section, scene, (kind, device), has_loop);
        scene.failures[place].device = device;
    } else {
        scene.failures[place].output = None;
    }
}

/// The failing device and the index of its kind; `None` after a problem.
fn read_device(section: &mut Section<'_, '_>, scene: &SceneInput, has_loop: bool) -> Option<(usize, Device)> {
    let written: Vec<usize> = (0..DEVICES.len()).filter(|kind| section.has(DEVICES[*kind])).collect();
    let kind = match written[..] {
        [kind] => kind,
        [] => {
            section.require(
                "wheel",
                "the name of the wheel that fails (or thruster, torque_rod or sensor instead)",
                "\"w1\"",
            );
            return None;
        }
        [_, second, ..] => {
            return section.refused(
                DEVICES[second],
                "left out where another device is named",
                "write a [[failure]] table for each",
            );
        }
    };
    let known: Vec<Option<Name>> = match kind {
        0 => turning(scene),
        1 => scene.thrusters.iter().map(|thruster| Some(thruster.name)).collect(),
        2 => scene.torque_rods.iter().map(|rod| Some(rod.name)).collect(),
        _ => scene.control.sensors.iter().map(|sensor| Some(sensor.name)).collect(),
    };
    let names: Vec<&str> = known.iter().flatten().map(Name::as_str).collect();
    if names.is_empty() {
        let what = ["free wheels", "thrusters", "torque rods", "sensors"][kind];
        let remedy =
            if kind == SENSOR && !has_loop { "add a [control] loop with [[sensors]]" } else { "name another device" };
        return section.refused(DEVICES[kind], format!("left out where the scene has no {what}"), remedy);
    }
    let place = |text: &str| known.iter().position(|name| name.is_some_and(|name| name.as_str() == text));
    let place = section.name(DEVICES[kind], &names, place)?;
    Some((kind, [Device::Wheel, Device::Thruster, Device::Rod, Device::Sensor][kind](place)))
}

fn check_keys(section: &mut Section<'_, '_>, kind: usize) {
    let (device, keys) = (DEVICES[kind].replace('_', " "), KEYS[kind].join(", "));
    let others = (0..KEYS.len()).filter(|other| *other != kind).flat_map(|other| KEYS[other]).copied();
    section.refuse_written(others, &format!("left out: a failure of a {device} has {keys}"), "delete this line");
    let own: Vec<&str> = KEYS[kind].iter().copied().filter(|key| section.has(key)).collect();
    if own.is_empty() {
        let allowed = format!("what becomes of the {device}: one of {keys}");
        section.require(KEYS[kind][0], &allowed, ["0.0", "0.0", "0.0", "\"silent\""][kind]);
    } else if let (SENSOR, [_, second, ..]) = (kind, &own[..]) {
        section.refuse(second, format!("the only one of {keys}"), "delete it: a sensor fails in one way");
    }
}

/// Notes failures that this device cannot have, and a second table about it.
fn check_device(section: &mut Section<'_, '_>, scene: &SceneInput, (kind, device): (usize, Device), has_loop: bool) {
    if let Some(first) = scene.failures.iter().find(|failure| failure.device == device) {
        let allowed = format!("a device that does not fail in another table: it does in {}", first.name);
        section.refuse(DEVICES[kind], allowed, "delete one of the two tables");
    }
    if let (Device::Wheel(_), false) = (device, has_loop) {
        let keys = FailureInput::OF_WHEELS.into_iter().filter(|key| key.contains("friction"));
        let allowed = "left out without [control]: a schedule commands what is applied";
        section.refuse_written(keys, allowed, "delete it, or add a [control] table");
    }
    if let Device::Sensor(place) = device {
        let sensor = &scene.control.sensors[place];
        if sensor.declared.0.is_empty() {
            // a wrong kind is reported already
            return;
        }
        for key in FailureInput::OF_SENSORS.into_iter().filter(|key| key.starts_with("bias")) {
            if section.has(key) && sensor.named(key).is_none_or(|bias| bias.len() != 3) {
                let able = FailureInput::OF_SENSORS.into_iter().skip(1);
                let able = able.filter(|key| sensor.named(key).is_some_and(|bias| bias.len() == 3));
                let remedy = able.map(|key| format!("write {key}")).next();
                let allowed = format!("left out: a sensor of the kind of {} has no such bias", sensor.name);
                section.refuse(
                    key,
                    allowed,
                    remedy.unwrap_or_else(|| "write output = \"silent\" or \"frozen\"".to_owned()),
                );
            }
        }
    }
}

/// The turning wheels in order: the names of free ones, which a loop may drive.
pub fn turning(scene: &SceneInput) -> Vec<Option<Name>> {
    let turning = scene.wheels.iter().filter(|wheel| wheel.mode != WheelMode::Locked);
    turning.map(|wheel| (wheel.mode == WheelMode::Free).then_some(wheel.name)).collect()
}

fn named(scene: &SceneInput, device: Device) -> Option<(&'static str, Name)> {
    let mut turning = scene.wheels.iter().filter(|wheel| wheel.mode != WheelMode::Locked);
    Some(match device {
        Device::Wheel(place) => (DEVICES[0], turning.nth(place)?.name),
        Device::Thruster(place) => (DEVICES[1], scene.thrusters.get(place)?.name),
        Device::Rod(place) => (DEVICES[2], scene.torque_rods.get(place)?.name),
        Device::Sensor(place) => (DEVICES[SENSOR], scene.control.sensors.get(place)?.name),
        Device::Unknown => return None,
    })
}

/// The device in words: `wheel w1`.
pub fn failed_device(scene: &SceneInput, device: Device) -> String {
    named(scene, device).map_or_else(String::new, |(kind, name)| format!("{} {name}", kind.replace('_', " ")))
}
