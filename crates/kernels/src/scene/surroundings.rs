//! Needs of air and light beyond single keys: orbit, date, plates.

use super::error::Problems;
use super::input::SceneInput;
use super::orbit::Orbit;
use super::plate;
use super::schema::limit::shown;
use super::schema::{EnvironmentInput, MAX_PLATES, PlateInput};
use super::table::Table;

/// Remedy for what needs an orbit.
pub(super) const ADD_ORBIT: &str = "add an [orbit] table, or delete this line";

/// Height of free molecular flow, m; below it the drag is that of a flow around the body.
const FREE_MOLECULAR: f64 = 100e3;

/// Thinnest layer of an air table, m: steps end at layers, and an orbit moves by kilometres per second.
const LEAST_LAYER: f64 = 1.0;

pub(super) fn check(input: &SceneInput, problems: &mut Problems) {
    let environment = &input.environment;
    let acting = [("environment.drag", environment.drag), ("environment.solar_pressure", environment.solar_pressure)];
    for (key, _) in acting.into_iter().filter(|(_, acts)| *acts) {
        if input.orbit.is_none() {
            problems.add(key, "true", "false, or left out, without an [orbit]", ADD_ORBIT);
        }
        if input.plates.is_empty() && plate::of_parts(input) == 0 {
            let allowed = "false, or left out, without [[plates]] and without a part that is a box or a cylinder";
            problems.add(key, "true", allowed, "add [[plates]]");
        }
    }
    let count = plate::of_parts(input);
    if input.plates.is_empty() && count > MAX_PLATES {
        let allowed = format!("with at most {MAX_PLATES} sides of boxes and plates of cylinders, not {count}");
        let remedy = "write [[plates]] with those that count";
        problems.add("body.parts", format!("{} parts", input.parts.len()), allowed, remedy);
    }
    let Some(orbit) = &input.orbit else { return };
    if environment.solar_pressure && orbit.epoch.is_none() {
        let allowed = "given where environment.solar_pressure acts: the date says where the Sun is";
        problems.add("orbit.epoch", "missing", allowed, "add a date such as epoch = \"2026-11-24T00:00:00Z\"");
    }
    let height = Orbit::of(orbit).lowest() - orbit.body_radius_m;
    // an orbit below the surface has its own message
    if environment.drag && height > 0.0 && height < FREE_MOLECULAR {
        let allowed = format!(
            "false, or left out, on an orbit whose periapsis is less than 100 km above body_radius_m, here {:.1} km: \
            the air there flows around a body",
            1e-3 * height
        );
        problems.add("environment.drag", "true", allowed, "raise the orbit");
    }
}

/// Remedy for keys of the air without drag.
const DRAG: &str = "add drag = true, or delete this line";

pub(super) fn check_keys(environment: &EnvironmentInput, problems: &mut Problems) {
    if environment.coupled && !environment.acts_on_plates() {
        let allowed =
            "false, or left out, without drag and without solar_pressure: they are the forces that it couples";
        problems.add("environment.coupled", "true", allowed, DRAG);
    }
    let exponential = environment.exponential();
    let keys = ["base_density_kg_m3", "base_height_m", "scale_height_m"];
    for (key, number) in keys.into_iter().zip(exponential) {
        let key = || format!("environment.{key}");
        match number {
            Some(number) if !environment.drag => problems.add(key(), shown(&[number]), "left out without drag", DRAG),
            None if environment.drag && exponential.iter().any(Option::is_some) => {
                let allowed = "given, with the two others of base_density_kg_m3, base_height_m and scale_height_m";
                problems.add(key(), "missing", allowed, "write all three, or none for the table");
            }
            _ => {}
        }
    }
    check_air_table(environment, problems);
}

fn check_air_table(environment: &EnvironmentInput, problems: &mut Problems) {
    const KEYS: [&str; 2] = ["environment.air_heights_m", "environment.air_densities_kg_m3"];
    let lists = [environment.air_heights_m, environment.air_densities_kg_m3];
    let mut refuse = |index: usize, allowed: &str, remedy: &'static str| {
        let value = lists[index].map_or("missing".to_owned(), |list| format!("{list:?}"));
        problems.add(KEYS[index], value, allowed, remedy);
    };
    let [heights, densities] = match lists {
        [None, None] => return,
        [first, _] if !environment.drag => {
            let key = usize::from(first.is_none());
            return refuse(key, "left out without drag", "add drag = true, or delete the table");
        }
        [first, _] if environment.exponential().iter().any(Option::is_some) => {
            let allowed = "left out where base_density_kg_m3, base_height_m and scale_height_m are given";
            return refuse(usize::from(first.is_none()), allowed, "delete these three, or the table");
        }
        [None, _] => return refuse(0, "given together with air_densities_kg_m3", "write a height for each density"),
        [_, None] => return refuse(1, "given together with air_heights_m", "write the density at each height"),
        [Some(heights), Some(densities)] => [heights, densities],
    };
    if heights.len() < 2 {
        return refuse(0, "two heights or more", "write at least two heights with their densities");
    }
    if heights.len() != densities.len() {
        let allowed = format!("as many numbers as air_heights_m has, {}, not {}", heights.len(), densities.len());
        return refuse(1, &allowed, "write the density at each height");
    }
    if let Some([low, high]) = heights.array_windows().find(|[low, high]| high - low < LEAST_LAYER) {
        let allowed = format!("ascending by {LEAST_LAYER} m or more, where {high:?} follows {low:?}");
        return refuse(0, &allowed, "put the heights in ascending order, each once");
    }
    if let Some(density) = densities.iter().find(|density| **density < f64::MIN_POSITIVE) {
        let allowed = format!("above zero, each, not {density:?}: between two heights the density is exponential");
        return refuse(1, &allowed, "write positive numbers");
    }
    if let Some([below, above]) = densities.array_windows().find(|[below, above]| above > below) {
        let allowed = format!("never above the density before, where {above:?} follows {below:?}");
        refuse(1, &allowed, "write the densities in the order of their heights");
    }
}

pub(super) fn check_plate(plate: &PlateInput, problems: &mut Problems) {
    if plate.specular + plate.diffuse > 1.0 {
        let allowed = format!("at most 1 with specular, which is {:?}: the rest is absorbed", plate.specular);
        problems.add(
            Table::Plate.name(plate.name, "diffuse"),
            shown(&[plate.diffuse]),
            allowed,
            "write smaller shares",
        );
    }
    if plate.cell_efficiency > 1.0 {
        let name = Table::Plate.name(plate.name, "cell_efficiency");
        problems.add(name, shown(&[plate.cell_efficiency]), "at most 1".to_owned(), "write 0.28 for 28%");
    }
}
