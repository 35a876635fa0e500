//! What `spindrift check` says of the nominal scene: masses and inertias, momenta, and the torques of its thrusters.

use std::fmt::{Result, Write};

use crate::campaign::Display;
use crate::findings::number::trimmed;
use crate::math::symmetric::principal_axes;
use crate::math::vector::{cross, difference, norm, product, scaled, sum};
use crate::scene::mass::{Body, Wheel};
use crate::scene::schema::InitialInput;
use crate::scene::{MassProperties, Scene, SceneInput};
use crate::table::Table;
use crate::table::text::{Align, Text};

/// The share of the largest entry of a matrix below which another is rounding: some hundred roundings.
const ROUNDING: f64 = 1e-14;

/// A number with six significant digits.
fn six(value: f64) -> String {
    trimmed(value, 6)
}

/// A vector with six significant digits each.
fn vector(v: [f64; 3]) -> String {
    format!("[{}]", v.map(six).join(", "))
}

/// Mass and principal moments of the spacecraft in a line.
pub fn in_short(scene: &Scene) -> String {
    let (moments, _) = principal_axes(scene.mass.inertia);
    format!("spacecraft: {} kg, principal moments {} kg m^2", six(scene.mass.total), vector(moments))
}

/// The attitude at the start as a turn, as it is written: its angle, 0 to 180 deg, and its axis.
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

/// The angular momentum of the spacecraft about its centre of mass at the start, in F_s.
fn momentum(scene: &Scene) -> [f64; 3] {
    let (mass, initial) = (&scene.mass, &scene.initial);
    let body = product(mass.inertia, initial.omega_se_s);
    let wheels = mass.wheels.iter().zip(initial.wheel_rates);
    wheels.fold(body, |total, (wheel, rate)| sum(total, scaled(wheel.axial * rate, wheel.axis)))
}

/// Masses, centre of mass, inertia, principal axes, with the convention, and what contributes most.
pub fn masses(text: &mut String, input: &SceneInput, mass: &MassProperties) -> Result {
    let names = input.turning_wheels();
    let wheels = names.iter().zip(&mass.wheels).map(|(name, wheel)| (format!("wheel {name}"), wheel.mass));
    let debris = mass.debris.as_ref().map(|debris| ("debris".to_owned(), debris.mass));
    let body = [("body".to_owned(), mass.body.mass)];
    let all = body.into_iter().chain(wheels).chain([("spacecraft".to_owned(), mass.total)]).chain(debris);
    let mut table = Table::with([("", Align::Left), ("", Align::Right)]);
    all.for_each(|(body, mass)| table.row([body, format!("{} kg", six(mass))]));
    text.push_str(&Text::of(&table).spaced(0, 2).lines(usize::MAX));
    writeln!(text, "centre of mass of the spacecraft, from p in F_s: {} m", vector(mass.center))?;
    let locked = if input.wheels.is_empty() { "" } else { ", wheels locked," };
    tensor(text, &format!("inertia of the spacecraft{locked} about its centre of mass"), mass.inertia)?;
    let (moments, axes) = principal_axes(mass.inertia);
    writeln!(text, "its principal moments {} kg m^2; principal axes in F_s, by columns:", vector(moments))?;
    rows(text, axes);
    if !mass.wheels.is_empty() {
        tensor(text, "the same minus the wheels' axial inertias (J*, wheels free)", mass.inertia_free)?;
        tensor(text, "inertia of the body about its own centre of mass", mass.body.inertia)?;
    }
    for (name, wheel) in names.iter().zip(&mass.wheels) {
        let (axial, transverse, mode) = (six(wheel.axial), six(wheel.transverse), wheel.mode.name());
        let axis = vector(wheel.axis);
        writeln!(text, "wheel {name}: axial {axial}, transverse {transverse} kg m^2, {mode}, axis {axis} in F_s")?;
    }
    if let Some((name, share)) = largest_part(input, mass) {
        writeln!(text, "largest part: {name}, {:.1} % of the mass of the spacecraft", 100.0 * share)?;
    }
    writeln!(
        text,
        "Convention: tensors in F_s, whose origin is p; off-diagonal entries are those of the tensor, J_xy = -integral \
        of x y dm."
    )
}

/// Angular momenta at the start about the centre of mass, those of the wheels, and the torque of each thruster at one
/// newton.
pub fn momenta(text: &mut String, input: &SceneInput, scene: &Scene, display: &Display) -> Result {
    let (mass, initial) = (&scene.mass, &scene.initial);
    let total = momentum(scene);
    let wheels: Vec<f64> =
        mass.wheels.iter().zip(initial.wheel_rates).map(|(wheel, rate)| wheel.axial * rate).collect();
    writeln!(
        text,
        "angular momentum of the spacecraft about its centre of mass, in F_s: {} N m s, of magnitude {}",
        vector(total),
        six(norm(total))
    )?;
    for ((name, momentum), rate) in input.turning_wheels().iter().zip(&wheels).zip(initial.wheel_rates) {
        let shown = display.of(&format!("rate_{name}_rad_s"), "rad/s");
        let rate = format!("{} {}", six(shown.value(rate)), shown.unit);
        writeln!(text, "wheel {name}: {} N m s relative to the body, at {rate}", six(*momentum))?;
    }
    for (written, thruster) in input.thrusters.iter().zip(&scene.thrusters) {
        let torque = cross(difference(thruster.position, mass.center), thruster.direction);
        let (force, torque) = (vector(thruster.direction), vector(torque));
        writeln!(
            text,
            "thruster {}: at 1 N the force {force} N and the torque {torque} N m about the centre of mass",
            written.name
        )?;
    }
    Ok(())
}

/// The part of the body, or the wheel, with the largest mass, and its share of the total.
fn largest_part(input: &SceneInput, mass: &MassProperties) -> Option<(String, f64)> {
    let parts = input.parts.iter().map(|part| (format!("body.parts.{}", part.name), Body::part(part, 1.0).mass));
    let wheels = input.wheels.iter().map(|wheel| (format!("wheels.{}", wheel.name), Wheel::new(wheel, 1.0).mass));
    let largest = parts.chain(wheels).max_by(|(_, a), (_, b)| a.total_cmp(b))?;
    (!input.parts.is_empty()).then_some((largest.0, largest.1 / mass.total))
}

fn tensor(text: &mut String, name: &str, rows: [[f64; 3]; 3]) -> Result {
    writeln!(text, "{name}, kg m^2:")?;
    self::rows(text, rows);
    Ok(())
}

fn rows(text: &mut String, rows: [[f64; 3]; 3]) {
    // what is left of a turn and back is not shown as a number
    let largest = rows.iter().flatten().fold(0.0, |most: f64, entry| most.max(entry.abs()));
    let shown = |entry: f64| if entry.abs() < ROUNDING * largest { "0".to_owned() } else { six(entry) };
    let mut table = Table::with([("", Align::Right); 3]);
    rows.iter().for_each(|row| table.row(row.map(shown)));
    text.push_str(&table.text(usize::MAX));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{SceneInput, ThrusterInput};

    /// Law: the momentum is J omega + sum J_i rate_i a_i, and a thruster's torque is its arm from the centre of mass
    /// times its direction.
    #[test]
    fn momenta_and_torques_are_those_of_the_scene() {
        let mut input = SceneInput::report();
        input.initial.angular_velocity_rad_s = [0.0, 0.0, 2.0];
        input.wheels[0].rate_rad_s = 100.0 * core::f64::consts::PI;
        input.thrusters = vec![ThrusterInput::named("side", [1.0, 0.0, 0.0], [0.0, 1.0, 0.0])];
        let scene = Scene::resolve(&input).expect("a legal scene");
        let mut text = String::new();
        momenta(&mut text, &input, &scene, &Display::default()).expect("text");
        let axial = scene.mass.wheels[0].axial;
        let momentum = 100.0 * core::f64::consts::PI * axial;
        let spin = [0.0, momentum, 2.0 * scene.mass.inertia[2][2]];
        assert!(text.contains(&format!("in F_s: {} N m s, of magnitude {}", vector(spin), six(norm(spin)))), "{text}");
        assert!(
            text.contains(&format!("wheel w1: {} N m s relative to the body, at 3000 rpm", six(momentum))),
            "{text}"
        );
        // from the centre of mass at (0, 0, z) to (1, 0, 0), pushed along s2: the torque (z, 0, 1)
        let [.., z] = scene.mass.center;
        assert!(
            text.contains(&format!(
                "thruster side: at 1 N the force [0, 1, 0] N and the torque {} N m",
                vector([z, 0.0, 1.0])
            )),
            "{text}"
        );
    }

    /// Law: an attitude is shown as the turn that it is, by at most half a turn, whichever sign its quaternion has.
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

    /// Law: an entry that is rounding is 0, and a small one that is not stays.
    #[test]
    fn rounding_is_not_shown() {
        let mut text = String::new();
        rows(&mut text, [[4.0, 8.7e-19, 1e-9], [8.7e-19, 4.5, 0.0], [1e-9, 0.0, 3.0]]);
        let words: Vec<&str> = text.split_whitespace().collect();
        let small = "1e-9";
        assert_eq!(words, ["4", "0", small, "0", "4.5", "0", small, "0", "3"]);
    }

    /// Law: each column of the principal axes is an eigenvector of the inertia for its moment, to the six digits shown.
    #[test]
    fn principal_axes_are_columns() {
        let mut input = SceneInput::report();
        input.body.inertia_kg_m2 = Some([[3000.0, 400.0, -100.0], [400.0, 2500.0, 200.0], [-100.0, 200.0, 1500.0]]);
        let mass = Scene::resolve(&input).expect("a legal scene").mass;
        let mut text = String::new();
        masses(&mut text, &input, &mass).expect("text");
        let (_, after) = text.split_once("its principal moments [").expect("the moments");
        let numbers = |line: &str| -> Vec<f64> {
            line.split([' ', ',', ']']).filter_map(|word| word.trim().parse().ok()).collect()
        };
        let mut lines = after.lines();
        let moments = numbers(lines.next().expect("a line"));
        let shown: Vec<Vec<f64>> = lines.take(3).map(numbers).collect();
        for (axis, moment) in moments.iter().take(3).enumerate() {
            for row in 0..3 {
                let product: f64 = (0..3).map(|k| mass.inertia[row][k] * shown[k][axis]).sum();
                assert!((product - moment * shown[row][axis]).abs() < 1e-4 * moments[2], "axis {axis}: {text}");
            }
        }
    }
}
