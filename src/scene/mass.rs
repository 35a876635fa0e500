//! Mass properties of the bodies and of the spacecraft as a whole.
//!
//! Source: Berdoz, *Final Report - ADR Spacecraft*, (60)-(67) for the bodies ([`super::solids`]). Sums over bodies use the
//! distances between pairs, sum over i < j of m_i m_j / m times (r^2 1 - r r^T): no difference with the common centre, no cancellation.
//!
//! Generic over the number type, so that a reference solution in more digits starts from a J of as many digits.

use super::alignment::aligned;
use super::input::SceneInput;
use super::schema::{DebrisInput, MAX_WHEELS, PartInput, PartShape, WheelInput, WheelMode};
pub use super::solids::Body;
use super::solids::{Cylinder, hollow_cylinder, solid_box, solid_cylinder, sphere};
use super::unit_quaternion::unit_quaternion;
use crate::math::Real;
use crate::math::list::List;
use crate::math::vector::{constant, constant_quaternion, dcm_from_quaternion, difference, dot, product, scaled, sum};

/// Largest number of parts of a body.
pub const MAX_PARTS: usize = 32;

/// A balanced axisymmetric wheel, fixed with its centre and axis in the body, that turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wheel<R = f64> {
    /// Mass, kg.
    pub mass: R,
    /// Centre from p in F_s, m.
    pub center: [R; 3],
    /// Unit spin axis in F_s.
    pub axis: [R; 3],
    /// Moment of inertia about the spin axis, kg m^2.
    pub axial: R,
    /// Moment of inertia about any axis through the centre across the spin axis, kg m^2.
    pub transverse: R,
    /// Whether it turns freely or its motor holds its speed.
    pub mode: WheelMode,
}

/// Mass properties of all bodies and of the spacecraft, its body and wheels, as a whole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassProperties<R = f64> {
    /// The body: everything but the wheels that turn.
    pub fuselage: Body<R>,
    /// The wheels that turn, in their order; a locked wheel is a part of the body.
    pub wheels: List<Wheel<R>, MAX_WHEELS>,
    /// The debris D, if present.
    pub debris: Option<Body<R>>,
    /// Mass m of the spacecraft, kg.
    pub total: R,
    /// Centre of mass c of the spacecraft from p in F_s, m.
    pub center: [R; 3],
    /// Inertia J of the spacecraft about c with wheels locked, F_s, kg m^2, by rows.
    pub inertia: [[R; 3]; 3],
    /// J* = J - sum J_i a_i a_i^T, kg m^2, by rows: what resists a change of omega when the wheels turn freely.
    pub inertia_free: [[R; 3]; 3],
}

impl<R: Real> Body<R> {
    /// The first moment of mass c = m r about the frame's origin, kg m.
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
        // where the mass is given, any density gives the right shape
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
        // C J C^T: row i of C J, with column j of C^T
        let turned =
            c.map(|row| [0, 1, 2].map(|j| dot(row, [body.inertia[0][j], body.inertia[1][j], body.inertia[2][j]])));
        let entry = |i: usize, j: usize| dot(turned[i], c[j]);
        let (xy, xz, yz) = (entry(0, 1), entry(0, 2), entry(1, 2));
        Body {
            mass: body.mass,
            center: sum(position, product(c, body.center)),
            inertia: [[entry(0, 0), xy, xz], [xy, entry(1, 1), yz], [xz, yz, entry(2, 2)]],
        }
    }

    /// A unit mass at the origin.
    fn point(one: R) -> Self {
        Body { mass: one, center: [one.zero(); 3], inertia: [[one.zero(); 3]; 3] }
    }

    /// The same shape with another mass.
    fn of_mass(self, mass: R) -> Self {
        let ratio = mass / self.mass;
        Body { mass, inertia: self.inertia.map(|row| scaled(ratio, row)), ..self }
    }

    /// Rigid bodies put together, at least one: sums over pairs, without a difference with the common centre.
    fn together(bodies: &[Self]) -> Self {
        let Some((first, others)) = bodies.split_first() else { unreachable!("there is at least one body") };
        let mass =
            others.iter().map(|body| body.mass).reduce(|a, b| a + b).map_or(first.mass, |mass| first.mass + mass);
        // from the first centre, so that equal masses on both sides of it move nothing, to the last bit
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

    /// The body of `input`: its parts together, what is given in their place, and its errors.
    ///
    /// Where only the mass is given, the inertia of the parts scales with it (same shape, another density); a centre of mass that is given
    /// moves the centre and leaves the inertia about it as it was. Errors come last. Where the mass properties include the wheels, these are
    /// taken out. The wheels that are locked are put in.
    pub fn of_input(input: &SceneInput, one: R) -> Self {
        let (body, k) = (&input.body, |value: f64| one.splat(value));
        let mut whole = match &input.parts[..] {
            [] => Body::point(one),
            [part] => Body::part(part, one),
            parts => {
                // in place: every sample puts its parts together, without allocating
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
        if input.wheels.iter().all(|wheel| wheel.mode != WheelMode::Locked) {
            return whole;
        }
        let mut bodies = List::<Self, { 1 + MAX_WHEELS }>::empty(Body::point(one));
        bodies.push(whole);
        for wheel in input.wheels.iter().filter(|wheel| wheel.mode == WheelMode::Locked) {
            bodies.push(Wheel::new(wheel, one).body());
        }
        Body::together(&bodies)
    }

    /// What is left without `part`.
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

impl<R: Real> Wheel<R> {
    /// No wheel.
    fn blank(one: R) -> Self {
        let zero = one.zero();
        Wheel { mass: zero, center: [zero; 3], axis: [zero; 3], axial: zero, transverse: zero, mode: WheelMode::Free }
    }

    /// The wheel of `input` (60)-(67).
    pub fn new(input: &WheelInput, one: R) -> Self {
        let k = |value: Option<f64>| one.splat(value.unwrap_or(f64::NAN));
        let Cylinder { mass, axial, transverse } = match input.mass_kg {
            Some(_) => Cylinder {
                mass: k(input.mass_kg),
                axial: k(input.axial_inertia_kg_m2),
                transverse: k(input.transverse_inertia_kg_m2),
            },
            None => solid_cylinder(k(input.radius_m), k(input.length_m), k(input.density_kg_m3)),
        };
        let axis = aligned(input.axis, input.tilt_rad, one);
        Wheel { mass, center: constant(one, input.position_m), axis, axial, transverse, mode: input.mode }
    }

    /// The wheel at rest, as a rigid body.
    pub fn body(&self) -> Body<R> {
        Body { mass: self.mass, center: self.center, inertia: self.inertia() }
    }

    /// The inertia about the wheel's centre, kg m^2, by rows; the same in F_s and in the wheel's own frame.
    pub fn inertia(&self) -> [[R; 3]; 3] {
        matrix_sum(self.axial_inertia(), self.transverse_inertia())
    }

    /// J_i a a^T.
    fn axial_inertia(&self) -> [[R; 3]; 3] {
        std::array::from_fn(|i| scaled(self.axial * self.axis[i], self.axis))
    }

    /// What is left of the wheel's inertia without its axial part.
    fn transverse_inertia(&self) -> [[R; 3]; 3] {
        point_inertia(self.transverse, self.axis)
    }
}

impl<R: Real> MassProperties<R> {
    /// The mass properties of `input`, in the number type of `one`; meaningful where [`super::Scene::resolve`] accepts the input.
    pub fn of(input: &SceneInput, one: R) -> Self {
        let fuselage = Body::of_input(input, one);
        let mut wheels = List::empty(Wheel::blank(one));
        for wheel in input.wheels.iter().filter(|wheel| wheel.mode != WheelMode::Locked) {
            wheels.push(Wheel::new(wheel, one));
        }
        let debris = input.debris.as_ref().map(|debris| Body::debris(debris, one));

        let wheel_mass = wheels.iter().map(|wheel| wheel.mass).reduce(|a, b| a + b);
        let total = wheel_mass.map_or(fuselage.mass, |mass| fuselage.mass + mass);
        // from the fuselage's centre, so that equal wheels on both sides of it move nothing, to the last bit
        let shift = |wheel: &Wheel<R>| scaled(wheel.mass / total, difference(wheel.center, fuselage.center));
        let center = wheels.iter().map(shift).reduce(sum).map_or(fuselage.center, |shift| sum(fuselage.center, shift));

        let mut inertia_free = fuselage.inertia;
        for wheel in &wheels {
            inertia_free = matrix_sum(inertia_free, wheel.transverse_inertia());
        }
        let point = |index: usize| match index {
            0 => (fuselage.mass, fuselage.center),
            _ => (wheels[index - 1].mass, wheels[index - 1].center),
        };
        for i in 0..wheels.len() {
            for j in i + 1..=wheels.len() {
                let ((mass_i, center_i), (mass_j, center_j)) = (point(i), point(j));
                let pair = point_inertia(mass_i * mass_j / total, difference(center_i, center_j));
                inertia_free = matrix_sum(inertia_free, pair);
            }
        }
        let inertia = wheels.iter().fold(inertia_free, |sum, wheel| matrix_sum(sum, wheel.axial_inertia()));
        MassProperties { fuselage, wheels, debris, total, center, inertia, inertia_free }
    }

    /// What resists a change of omega, kg m^2, by rows: J*, and the axial inertias of the wheels whose speed is held.
    pub fn inertia_rotating(&self) -> [[R; 3]; 3] {
        let held = self.wheels.iter().filter(|wheel| wheel.mode == WheelMode::SpeedHeld);
        held.fold(self.inertia_free, |sum, wheel| matrix_sum(sum, wheel.axial_inertia()))
    }
}

/// m (r^2 1 - r r^T): the inertia of a mass at `r`, without differences on the diagonal.
fn point_inertia<R: Real>(mass: R, r: [R; 3]) -> [[R; 3]; 3] {
    let square = [mass * (r[0] * r[0]), mass * (r[1] * r[1]), mass * (r[2] * r[2])];
    let off = |i: usize, j: usize| -(mass * (r[i] * r[j]));
    [
        [square[1] + square[2], off(0, 1), off(0, 2)],
        [off(0, 1), square[0] + square[2], off(1, 2)],
        [off(0, 2), off(1, 2), square[0] + square[1]],
    ]
}

/// A tensor that is symmetric to rounding when it comes here, exactly so afterwards.
fn symmetric<R: Real>(tensor: [[f64; 3]; 3], one: R) -> [[R; 3]; 3] {
    let k = |value: f64| one.splat(value);
    std::array::from_fn(|i| std::array::from_fn(|j| k(0.5) * (k(tensor[i][j]) + k(tensor[j][i]))))
}

fn matrix_sum<R: Real>(a: [[R; 3]; 3], b: [[R; 3]; 3]) -> [[R; 3]; 3] {
    std::array::from_fn(|i| sum(a[i], b[i]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vector::norm;
    use crate::scene::samples;

    /// The check values have 16 digits.
    const CHECK_TOLERANCE: f64 = 1e-15;

    fn assert_close(name: &str, value: f64, expected: f64) {
        assert!((value / expected - 1.0).abs() <= CHECK_TOLERANCE, "{name}: {value:?}, expected {expected:?}");
    }

    #[test]
    fn table_two_gives_the_check_values() {
        let mass = MassProperties::of(&samples::table_two(), 1.0);
        assert_close("m_s", mass.fuselage.mass, 1982.7715926975181);
        assert_close("J_s transverse", mass.fuselage.inertia[0][0], 3026.338725586386);
        assert_close("J_s axial", mass.fuselage.inertia[2][2], 1684.750805384533);
        for wheel in &mass.wheels {
            assert_close("m_i", wheel.mass, 53.014376029327764);
            assert_close("J_i axial", wheel.axial, 1.6566992509164926);
            assert_close("J_i transverse", wheel.transverse, 0.8725282721493528);
        }
        assert_close("m_d", mass.debris.expect("Table II has debris").mass, 21.6);
        assert_close("J_1", mass.inertia[0][0], 3054.590970145349);
        assert_close("J_2", mass.inertia[1][1], 3055.375141124116);
        assert_close("J_3", mass.inertia[2][2], 1687.2800329075988);
        assert_eq!(mass.center, [0.0, 0.0, 1.5]);
        for i in 0..3 {
            for j in 0..3 {
                if i != j {
                    assert_eq!(mass.inertia[i][j], 0.0, "exactly diagonal, so that nothing spends time on products");
                }
            }
        }
    }

    #[test]
    fn pairs_equal_parallel_axes() {
        let mut input = samples::table_two();
        input.body.center_of_mass_m = Some([0.05, -0.02, 1.4]);
        let mass = MassProperties::of(&input, 1.0);
        let about_c = |body_mass: f64, center: [f64; 3]| point_inertia(body_mass, difference(center, mass.center));
        let mut expected = matrix_sum(mass.fuselage.inertia, about_c(mass.fuselage.mass, mass.fuselage.center));
        for wheel in &mass.wheels {
            expected = matrix_sum(expected, matrix_sum(wheel.inertia(), about_c(wheel.mass, wheel.center)));
        }
        for i in 0..3 {
            for j in 0..3 {
                assert!((mass.inertia[i][j] - expected[i][j]).abs() < 1e-15 * expected[0][0]);
            }
        }
    }

    #[test]
    fn held_wheels_turn_with_the_rest() {
        let mut input = samples::table_two();
        assert_eq!(MassProperties::of(&input, 1.0).inertia_rotating(), MassProperties::of(&input, 1.0).inertia_free);
        input.wheels[0].mode = WheelMode::SpeedHeld;
        let mass = MassProperties::of(&input, 1.0);
        assert_eq!(mass.inertia_rotating()[1][1], mass.inertia[1][1]);
        assert_eq!(mass.inertia_rotating()[2][2], mass.inertia_free[2][2]);
        input.wheels[1].mode = WheelMode::SpeedHeld;
        let mass = MassProperties::of(&input, 1.0);
        assert_eq!(mass.inertia_rotating(), mass.inertia);
    }

    #[test]
    fn a_mass_alone_scales_the_inertia_and_a_missing_wheel_weighs_nothing() {
        let mut input = samples::table_two();
        let nominal = MassProperties::of(&input, 1.0);
        input.body.mass_kg = Some(2.0 * nominal.fuselage.mass);
        input.wheels.clear();
        let mass = MassProperties::of(&input, 1.0);
        assert_eq!(mass.fuselage.inertia[0][0], 2.0 * nominal.fuselage.inertia[0][0]);
        assert_eq!(mass.inertia, mass.fuselage.inertia);
        assert_eq!(mass.inertia_free, mass.fuselage.inertia);
        assert_eq!(mass.total, mass.fuselage.mass);
        assert_eq!(mass.center, mass.fuselage.center);
    }

    /// Law: a locked wheel is a part of the body; the whole is that with the wheel at rest.
    #[test]
    fn a_locked_wheel_belongs_to_the_body() {
        let free = MassProperties::of(&samples::table_two(), 1.0);
        let mut input = samples::table_two();
        input.wheels[0].mode = WheelMode::Locked;
        let locked = MassProperties::of(&input, 1.0);
        assert_eq!(locked.wheels.len(), 1);
        assert_close("total", locked.total, free.total);
        assert_close("body", locked.fuselage.mass, free.fuselage.mass + free.wheels[0].mass);
        for i in 0..3 {
            assert_close("inertia", locked.inertia[i][i], free.inertia[i][i]);
        }
        assert_eq!(locked.inertia_free[1][1], locked.inertia[1][1], "nothing turns about s2");
    }

    /// Law: mass properties that include the wheels give the same spacecraft as those without.
    #[test]
    fn wheels_are_taken_out_of_what_includes_them() {
        let parts = MassProperties::of(&samples::table_two(), 1.0);
        let mut input = samples::table_two();
        input.parts.clear();
        input.body.includes_wheels = true;
        input.body.mass_kg = Some(parts.total);
        input.body.center_of_mass_m = Some(parts.center);
        input.body.inertia_kg_m2 = Some(parts.inertia);
        let whole = MassProperties::of(&input, 1.0);
        assert_close("total", whole.total, parts.total);
        assert_close("body", whole.fuselage.mass, parts.fuselage.mass);
        for i in 0..3 {
            assert_close("inertia", whole.inertia[i][i], parts.inertia[i][i]);
            assert_close("J*", whole.inertia_free[i][i], parts.inertia_free[i][i]);
            assert!((whole.center[i] - parts.center[i]).abs() < 1e-15);
        }
    }

    /// Law: parts together have the inertia that the theorem of parallel axes gives, whatever their attitude; halves of a box are the box.
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
            assert_close("mass", halves.mass, whole.mass);
            assert!(norm(difference(halves.center, whole.center)) < 1e-15);
            for i in 0..3 {
                assert!(norm(difference(halves.inertia[i], whole.inertia[i])) < 4e-15 * whole.inertia[2][2]);
            }
        }
        input.parts = vec![part([1.0, 2.0, 0.5], [0.3, 0.0, 0.0], quarter)];
        let turned = Body::of_input(&input, 1.0);
        for i in 0..3 {
            assert!(norm(difference(turned.inertia[i], whole.inertia[i])) < 1e-15 * whole.inertia[2][2]);
        }
    }

    #[test]
    fn spheres_and_point_masses_have_their_moments() {
        let mut input = SceneInput::blank();
        let sphere =
            PartInput { shape: PartShape::Sphere, radius_m: Some(0.5), mass_kg: Some(10.0), ..PartInput::DEFAULT };
        input.parts = vec![sphere];
        assert_close("2/5 m r^2", Body::of_input(&input, 1.0).inertia[1][1], 1.0);
        let point = |x| PartInput {
            shape: PartShape::PointMass,
            mass_kg: Some(2.0),
            position_m: [x, 0.0, 0.0],
            ..PartInput::DEFAULT
        };
        input.parts = vec![point(-1.0), point(3.0)];
        let pair = Body::of_input(&input, 1.0);
        assert_eq!((pair.mass, pair.center), (4.0, [1.0, 0.0, 0.0]));
        assert_eq!(pair.inertia, [[0.0; 3], [0.0, 16.0, 0.0], [0.0, 0.0, 16.0]]);
    }
}
