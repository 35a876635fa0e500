//! The nominal scene: masses, inertias, momenta and thruster torques.

use crate::campaign::Display;
use crate::findings::finding::{Finding, Kind};
use crate::findings::number::trimmed;
use crate::math::symmetric::principal_axes;
use crate::math::vector::{cross, difference, norm, product, scaled, sum};
use crate::scene::mass::{Body, Wheel};
use crate::scene::schema::InitialInput;
use crate::scene::{MassProperties, Scene, SceneInput};
use crate::table::Table;
use crate::table::text::Align;

/// Entries of a matrix below this share of the largest are rounding errors.
const ROUNDING: f64 = 1e-14;

fn six(value: f64) -> String {
    trimmed(value, 6)
}

fn vector(v: [f64; 3]) -> String {
    format!("[{}]", v.map(six).join(", "))
}

pub fn in_short(scene: &Scene) -> String {
    let (moments, _) = principal_axes(scene.mass.inertia);
    format!("spacecraft: {} kg, principal moments {} kg m^2", six(scene.mass.total), vector(moments))
}

/// The initial attitude as axis and angle, 0 to 180 deg.
pub fn attitude(initial: &InitialInput) -> String {
    let (frame, [w, x, y, z]) = match initial.attitude_orbital {
        Some(q_os) => ("the local orbital frame F_o", q_os),
        None => ("F_e", initial.attitude),
    };
    let turned = if w < 0.0 { [-x, -y, -z] } else { [x, y, z] };
    let sine = norm(turned);
    if sine == 0.0 {
        return format!("initial attitude: that of {frame}");
    }
    let angle = (2.0 * libm::atan2(sine, w.abs())).to_degrees();
    let axis = vector(scaled(1.0 / sine, turned));
    format!("initial attitude: {} deg from {frame}, about {axis}", six(angle))
}

/// Angular momentum of the spacecraft about its centre of mass in F_s at this angular velocity and these wheel rates.
pub fn momentum(mass: &MassProperties, omega: [f64; 3], rates: impl IntoIterator<Item = f64>) -> [f64; 3] {
    let wheels = mass.wheels.iter().zip(rates);
    wheels.fold(product(mass.inertia, omega), |total, (wheel, rate)| sum(total, scaled(wheel.axial * rate, wheel.axis)))
}

/// Masses, centre of mass, inertia, principal axes and the largest part.
pub fn masses(input: &SceneInput, mass: &MassProperties) -> Vec<Finding> {
    let about = |sentence: String| Finding::new(Kind::Note, "masses", "Mass properties of the nominal scene", sentence);
    let matrix = |sentence: String, entries| Finding { table: Some(rows(entries)), ..about(sentence) };
    let names = input.turning_wheels();
    let wheels = names.iter().zip(&mass.wheels).map(|(name, wheel)| (format!("wheel {name}"), wheel.mass));
    let debris = mass.debris.as_ref().map(|debris| ("debris".to_owned(), debris.mass));
    let body = [("body".to_owned(), mass.body.mass)];
    let all = body.into_iter().chain(wheels).chain([("spacecraft".to_owned(), mass.total)]).chain(debris);
    let mut table = Table::with([("", Align::Left), ("", Align::Right)]);
    all.for_each(|(body, mass)| table.row([body, format!("{} kg", six(mass))]));
    let center = format!("centre of mass of the spacecraft, from p in F_s: {} m", vector(mass.center));
    let locked = if input.wheels.is_empty() { "" } else { ", wheels locked," };
    let inertia = format!("inertia of the spacecraft{locked} about its centre of mass, kg m^2:");
    let (moments, axes) = principal_axes(mass.inertia);
    let principal = format!("its principal moments {} kg m^2; principal axes in F_s, by columns:", vector(moments));
    let mut list = vec![Finding { table: Some(table), ..about(String::new()) }];
    list.extend([about(center), matrix(inertia, mass.inertia), matrix(principal, axes)]);
    if !mass.wheels.is_empty() {
        let free = "the same minus the wheels' axial inertias (J*, wheels free), kg m^2:".to_owned();
        let body = "inertia of the body about its own centre of mass, kg m^2:".to_owned();
        list.extend([matrix(free, mass.inertia_free), matrix(body, mass.body.inertia)]);
    }
    for (name, wheel) in names.iter().zip(&mass.wheels) {
        let (axial, transverse, mode) = (six(wheel.axial), six(wheel.transverse), wheel.mode.name());
        let axis = vector(wheel.axis);
        let said = format!("wheel {name}: axial {axial}, transverse {transverse} kg m^2, {mode}, axis {axis} in F_s");
        list.push(about(said));
    }
    let largest = largest_part(input, mass);
    list.extend(largest.map(|(name, share)| {
        about(format!("largest part: {name}, {:.1} % of the mass of the spacecraft", 100.0 * share))
    }));
    list.push(about(
        "Convention: tensors in F_s, whose origin is p; off-diagonal entries are those of the tensor, J_xy = \
         -integral of x y dm."
            .to_owned(),
    ));
    list
}

/// Angular momenta at the start about the centre of mass, and the torque of each thruster at 1 N.
pub fn momenta(input: &SceneInput, scene: &Scene, display: &Display) -> Vec<Finding> {
    let title = "Momenta and torques of the nominal scene";
    let about = |sentence: String| Finding::new(Kind::Note, "momenta", title, sentence);
    let (mass, initial) = (&scene.mass, &scene.initial);
    let total = momentum(mass, initial.omega_se_s, initial.wheel_rates);
    let mut list = vec![about(format!(
        "angular momentum of the spacecraft about its centre of mass, in F_s: {} N m s, of magnitude {}",
        vector(total),
        six(norm(total))
    ))];
    for ((name, wheel), rate) in input.turning_wheels().iter().zip(&mass.wheels).zip(initial.wheel_rates) {
        let shown = display.of(&format!("rate_{name}_rad_s"), "rad/s");
        let (momentum, rate_shown) = (six(wheel.axial * rate), six(shown.value(rate)));
        let unit = shown.unit;
        list.push(about(format!("wheel {name}: {momentum} N m s relative to the body, at {rate_shown} {unit}")));
    }
    for (written, thruster) in input.thrusters.iter().zip(&scene.thrusters) {
        let torque = cross(difference(thruster.position, mass.center), thruster.direction);
        let (name, force, torque) = (&written.name, vector(thruster.direction), vector(torque));
        list.push(about(format!(
            "thruster {name}: at 1 N the force {force} N and the torque {torque} N m about the centre of mass"
        )));
    }
    list
}

fn largest_part(input: &SceneInput, mass: &MassProperties) -> Option<(String, f64)> {
    let parts = input.parts.iter().map(|part| (format!("body.parts.{}", part.name), Body::part(part, 1.0).mass));
    let wheels = input.wheels.iter().map(|wheel| (format!("wheels.{}", wheel.name), Wheel::new(wheel, 1.0).mass));
    let largest = parts.chain(wheels).max_by(|(_, a), (_, b)| a.total_cmp(b))?;
    (!input.parts.is_empty()).then_some((largest.0, largest.1 / mass.total))
}

fn rows(rows: [[f64; 3]; 3]) -> Table<'static> {
    let largest = rows.iter().flatten().fold(0.0, |most: f64, entry| most.max(entry.abs()));
    let shown = |entry: f64| if entry.abs() < ROUNDING * largest { "0".to_owned() } else { six(entry) };
    let mut table = Table::with([("", Align::Right); 3]);
    rows.iter().for_each(|row| table.row(row.map(shown)));
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::SceneInput;

    /// Law: an attitude is a turn of at most 180 deg, whatever the sign of its quaternion.
    #[test]
    fn an_attitude_is_an_axis_and_an_angle() {
        let shown = |attitude| super::attitude(&InitialInput { attitude, ..SceneInput::report().initial });
        let (s, c) = (15.0_f64.to_radians().sin(), 15.0_f64.to_radians().cos());
        for q_es in [[c, 0.0, 0.6 * s, 0.8 * s], [-c, 0.0, -0.6 * s, -0.8 * s]] {
            assert_eq!(shown(q_es), "initial attitude: 30 deg from F_e, about [0, 0.6, 0.8]");
        }
        assert!(shown([0.0, 0.0, 0.0, 1.0]).ends_with("180 deg from F_e, about [0, 0, 1]"));
        assert_eq!(shown([1.0, 0.0, 0.0, 0.0]), "initial attitude: that of F_e");
        let orbital = InitialInput { attitude_orbital: Some([0.0, 2.0, 0.0, 0.0]), ..SceneInput::report().initial };
        assert!(super::attitude(&orbital).contains("180 deg from the local orbital frame F_o, about [1, 0, 0]"));
    }
}
