//! Rigid bodies from their input: parts, the spacecraft's body, the debris. Solids (`solids`): Berdoz, *Final Report -
//! ADR Spacecraft*, (60)-(67).

use super::input::SceneInput;
use super::schema::{DebrisInput, MAX_WHEELS, PartInput, PartShape, WheelMode};
use super::solids::{Body, hollow_cylinder, solid_box, solid_cylinder, sphere};
use super::tensor::{matrix_sum, point_inertia, symmetric, symmetric_product};
use super::unit_quaternion::unit_quaternion;
use super::wheel::Wheel;
use crate::math::list::List;
use crate::math::prelude::*;

/// Largest number of parts of a body.
pub const MAX_PARTS: usize = 32;

impl<R: Real> Body<R> {
    /// First moment of mass c = m r about the frame's origin, kg m.
    pub fn first_moment(&self) -> [R; 3] {
        scaled(self.mass, self.center)
    }

    /// The inertia about the frame's origin, kg m^2, by rows.
    pub fn inertia_about_origin(&self) -> [[R; 3]; 3] {
        matrix_sum(self.inertia, point_inertia(self.mass, self.center))
    }

    /// A part of the body, in F_s (60)-(67).
    pub fn part(part: &PartInput, one: R) -> Self {
        let k = |value: Option<f64>| one.splat(value.unwrap_or(f64::NAN));
        // with a given mass any density gives the right shape
        let density = if part.mass_kg.is_some() { one } else { k(part.density_kg_m3) };
        let mut body = match part.shape {
            PartShape::HollowCylinder => {
                hollow_cylinder(k(part.wall_thickness_m), k(part.outer_radius_m), k(part.length_m), density)
            }
            PartShape::SolidCylinder => solid_cylinder(k(part.radius_m), k(part.length_m), density).body(),
            PartShape::Box => solid_box(part.size_m.unwrap_or([f64::NAN; 3]).map(|x| one.splat(x)), density),
            PartShape::Sphere => sphere(k(part.radius_m), density),
            PartShape::PointMass => Body::point(one),
        };
        if part.mass_kg.is_some() {
            body = body.of_mass(k(part.mass_kg));
        }
        body.center = [one.zero(); 3];
        let body = part.errors.applied(body);
        let position = constant(one, part.position_m);
        if part.attitude[1..] == [0.0; 3] {
            return Body { center: sum(position, body.center), ..body };
        }
        let c = dcm_from_quaternion(constant_quaternion(one, unit_quaternion(part.attitude)));
        Body {
            mass: body.mass,
            center: sum(position, product(c, body.center)),
            inertia: symmetric_product(one, c, body.inertia),
        }
    }

    fn point(one: R) -> Self {
        Body { mass: one, center: [one.zero(); 3], inertia: [[one.zero(); 3]; 3] }
    }

    /// This shape with the mass `mass`.
    fn of_mass(self, mass: R) -> Self {
        let ratio = mass / self.mass;
        Body { mass, inertia: self.inertia.map(|row| scaled(ratio, row)), ..self }
    }

    /// At least one rigid body, joined by sums over pairs.
    fn together(bodies: &[Self]) -> Self {
        let Some((first, others)) = bodies.split_first() else { unreachable!("there is at least one body") };
        let mass =
            others.iter().map(|body| body.mass).reduce(|a, b| a + b).map_or(first.mass, |mass| first.mass + mass);
        // from the first centre, so that equal masses on both sides move it by nothing, to the last bit
        let shift = |body: &Self| scaled(body.mass / mass, difference(body.center, first.center));
        let center = others.iter().map(shift).reduce(sum).map_or(first.center, |shift| sum(first.center, shift));
        let mut inertia = first.inertia;
        for body in others {
            inertia = matrix_sum(inertia, body.inertia);
        }
        for (i, a) in bodies.iter().enumerate() {
            for b in &bodies[i + 1..] {
                let pair = point_inertia(a.mass * b.mass / mass, difference(a.center, b.center));
                inertia = matrix_sum(inertia, pair);
            }
        }
        Body { mass, center, inertia }
    }

    /// The body of `input`: its parts, the overrides ([`super::BodyInput`]), its errors. Wheels that the mass
    /// properties include are removed; locked wheels are added.
    pub fn of_input(input: &SceneInput, one: R) -> Self {
        let (body, k) = (&input.body, |value: f64| one.splat(value));
        let mut whole = match &input.parts[..] {
            [] => Body::point(one),
            [part] => Body::part(part, one),
            parts => {
                // in place: every sample joins its parts without allocation
                let mut bodies = List::<Self, MAX_PARTS>::empty(Body::point(one));
                parts.iter().for_each(|part| bodies.push(Body::part(part, one)));
                Body::together(&bodies)
            }
        };
        if let Some(mass) = body.mass_kg {
            whole = whole.of_mass(k(mass));
        }
        if let Some(center) = body.center_of_mass_m {
            whole.center = center.map(k);
        }
        if let Some(inertia) = body.inertia_kg_m2 {
            whole.inertia = symmetric(inertia, one);
        }
        if let Some(principal) = body.principal {
            whole.inertia = principal.tensor(one);
        }
        whole = body.errors.applied(whole);
        if body.includes_wheels {
            for wheel in &input.wheels {
                whole = whole.without(&Wheel::new(wheel, one).body());
            }
        }
        let locked = || input.wheels.iter().filter(|wheel| wheel.mode == WheelMode::Locked);
        if locked().next().is_none() {
            return whole;
        }
        let mut bodies = List::<Self, { 1 + MAX_WHEELS }>::empty(Body::point(one));
        bodies.push(whole);
        locked().for_each(|wheel| bodies.push(Wheel::new(wheel, one).body()));
        Body::together(&bodies)
    }

    fn without(self, part: &Self) -> Self {
        let one = self.mass.splat(1.0);
        let mass = self.mass - part.mass;
        let center = sum(self.center, scaled(part.mass / mass, difference(self.center, part.center)));
        let pair = point_inertia(mass * part.mass / self.mass, difference(center, part.center));
        let minus = |m: [[R; 3]; 3]| m.map(|row| scaled(-one, row));
        Body { mass, center, inertia: matrix_sum(self.inertia, matrix_sum(minus(part.inertia), minus(pair))) }
    }

    /// The debris (60)-(67), or the irregular body of its input.
    pub fn debris(input: &DebrisInput, one: R) -> Self {
        let k = |value: f64| one.splat(value);
        let center = [one.zero(); 3];
        match *input {
            DebrisInput::Cube { side_m, density_kg_m3 } => solid_box([k(side_m); 3], k(density_kg_m3)),
            DebrisInput::Box { size_m, density_kg_m3 } => solid_box(size_m.map(k), k(density_kg_m3)),
            DebrisInput::Tensor { mass_kg, inertia_kg_m2 } => {
                Body { mass: k(mass_kg), center, inertia: symmetric(inertia_kg_m2, one) }
            }
            DebrisInput::Principal { mass_kg, principal } => {
                Body { mass: k(mass_kg), center, inertia: principal.tensor(one) }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ULPS: f64 = 1e-15;

    /// Law: joined parts have the inertia by parallel axes, at any attitude; halves of a box are the box.
    #[test]
    fn halves_of_a_box_are_the_box() {
        let part = |size: [f64; 3], position_m: [f64; 3], attitude: [f64; 4]| PartInput {
            shape: PartShape::Box,
            size_m: Some(size),
            density_kg_m3: Some(100.0),
            position_m,
            attitude,
            ..PartInput::DEFAULT
        };
        let unit = [1.0, 0.0, 0.0, 0.0];
        // a quarter turn about s3 exchanges the sides along s1 and s2
        let quarter = [0.5f64.sqrt(), 0.0, 0.0, 0.5f64.sqrt()];
        let mut input = SceneInput::blank();
        input.parts = vec![part([2.0, 1.0, 0.5], [0.3, 0.0, 0.0], unit)];
        let whole = Body::of_input(&input, 1.0);
        for attitude in [unit, quarter] {
            let size = [1.0, 1.0, 0.5];
            input.parts = vec![part(size, [-0.2, 0.0, 0.0], attitude), part(size, [0.8, 0.0, 0.0], attitude)];
            let halves = Body::of_input(&input, 1.0);
            assert!((halves.mass / whole.mass - 1.0).abs() <= ULPS);
            assert!(norm(difference(halves.center, whole.center)) < 1e-15);
            for i in 0..3 {
                // roundings of entries up to the largest; measured: 8.5e-17, and 3.4e-16 below
                assert!(norm(difference(halves.inertia[i], whole.inertia[i])) < 1e-15 * whole.inertia[2][2]);
            }
        }
        let sphere =
            PartInput { shape: PartShape::Sphere, radius_m: Some(0.5), mass_kg: Some(10.0), ..PartInput::DEFAULT };
        assert!((Body::part(&sphere, 1.0).inertia[1][1] - 1.0).abs() <= ULPS, "2/5 m r^2");
        input.parts = vec![part([1.0, 2.0, 0.5], [0.3, 0.0, 0.0], quarter)];
        let turned = Body::of_input(&input, 1.0);
        for i in 0..3 {
            assert!(norm(difference(turned.inertia[i], whole.inertia[i])) < 1e-15 * whole.inertia[2][2]);
        }
    }
}
