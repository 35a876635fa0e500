//! Mass properties of the bodies and of the spacecraft as a whole.
//!
//! Source: Berdoz, *Final Report - ADR Spacecraft*, (60)-(67) for the bodies ([`super::solids`]). Sums over bodies use the
//! distances between pairs, sum over i < j of m_i m_j / m times (r^2 1 - r r^T): no difference with the common centre, no cancellation.
//!
//! Generic over the number type, so that a reference solution in more digits starts from a J of as many digits.

use super::input::SceneInput;
use super::schema::{DebrisInput, FuselageInput, WheelInput, WheelMode};
pub use super::solids::Body;
use super::solids::{Cylinder, hollow_cylinder, solid_box, solid_cylinder};
use crate::math::Real;
use crate::math::list::List;
use crate::math::vector::{constant, cross, difference, dot, norm, scaled, sum};

/// A balanced axisymmetric wheel, fixed with its centre and axis in the fuselage. A missing wheel has mass and inertia zero.
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
    /// The fuselage S.
    pub fuselage: Body<R>,
    /// The wheels.
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

/// Largest number of wheels of a spacecraft.
pub const MAX_WHEELS: usize = 8;

/// The nominal spin axes of W1 and W2 in F_s: s2 and s3.
pub const WHEEL_AXES: [[f64; 3]; 2] = [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

impl<R: Real> Body<R> {
    /// The first moment of mass c = m r about the frame's origin, kg m.
    pub fn first_moment(&self) -> [R; 3] {
        scaled(self.mass, self.center)
    }

    /// The inertia about the frame's origin, kg m^2, by rows.
    pub fn inertia_about_origin(&self) -> [[R; 3]; 3] {
        matrix_sum(self.inertia, point_inertia(self.mass, self.center))
    }

    /// The fuselage (60)-(67), with the overrides of its input.
    ///
    /// Where only the mass is overridden, the inertia that geometry gives scales with it (same shape, another density); an
    /// overridden centre of mass moves the centre and leaves the inertia about it as it was. Errors come last.
    pub fn fuselage(input: &FuselageInput, one: R) -> Self {
        let k = |value: f64| one.splat(value);
        let mut body = hollow_cylinder(
            k(input.wall_thickness_m),
            k(input.outer_radius_m),
            k(input.length_m),
            k(input.density_kg_m3),
        );
        if let Some(mass) = input.mass_kg {
            let ratio = k(mass) / body.mass;
            body.inertia = body.inertia.map(|row| scaled(ratio, row));
            body.mass = k(mass);
        }
        if let Some(center) = input.center_of_mass_m {
            body.center = center.map(k);
        }
        if let Some(inertia) = input.inertia_kg_m2 {
            body.inertia = symmetric(inertia, one);
        }
        if let Some(principal) = input.principal {
            body.inertia = principal.tensor(one);
        }
        input.errors.applied(body)
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
    /// Wheel `index` (0, 1) (60)-(67); a missing one has mass and inertia zero.
    pub fn new(input: Option<&WheelInput>, index: usize, one: R) -> Self {
        let k = |value: f64| one.splat(value);
        let zero = one.zero();
        match input {
            None => Wheel {
                mass: zero,
                center: [zero; 3],
                axis: constant(one, WHEEL_AXES[index]),
                axial: zero,
                transverse: zero,
                mode: WheelMode::Free,
            },
            Some(input) => {
                let Cylinder { mass, axial, transverse } =
                    solid_cylinder(k(input.radius_m), k(input.length_m), k(input.density_kg_m3));
                let [x, y] = input.offset_m;
                let center = [k(x), k(y), k(input.station_m)];
                Wheel {
                    mass,
                    center,
                    axis: wheel_axis(index, input.tilt_rad, one),
                    axial,
                    transverse,
                    mode: input.mode,
                }
            }
        }
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

/// The spin axis of wheel `index` whose alignment error is `tilt` ([`WheelInput::tilt_rad`]), a unit vector in F_s.
///
/// With theta across the nominal axis a_0: a = cos|theta| a_0 + sin|theta|/|theta| theta x a_0 (O. Rodrigues, *Des lois
/// geometriques qui regissent les deplacements d'un systeme solide*, 1840). The angle is good to `f64`, the length to all digits
/// of the type; without a tilt the axis is exactly the nominal one.
pub fn wheel_axis<R: Real>(index: usize, tilt: [f64; 2], one: R) -> [R; 3] {
    let nominal = WHEEL_AXES[index];
    let across = [[0, 2], [0, 1]][index];
    let mut theta = [0.0; 3];
    for (component, angle) in across.into_iter().zip(tilt) {
        theta[component] = angle;
    }
    turned(nominal, theta, one)
}

/// The unit vector `axis` turned by the rotation vector `theta`, which is across it, rad.
pub(super) fn turned<R: Real>(axis: [f64; 3], theta: [f64; 3], one: R) -> [R; 3] {
    let angle = dot(theta, theta).sqrt();
    if angle == 0.0 {
        return constant(one, axis);
    }
    let (sine, cosine) = libm::sincos(angle);
    let turned = constant(one, sum(scaled(cosine, axis), scaled(sine / angle, cross(theta, axis))));
    scaled(one / norm(turned), turned)
}

impl Wheel {
    /// Whether the spacecraft has this wheel.
    pub fn is_present(&self) -> bool {
        self.mass > 0.0
    }
}

impl<R: Real> MassProperties<R> {
    /// The mass properties of `input`, in the number type of `one`; meaningful where [`super::Scene::resolve`] accepts the input.
    pub fn of(input: &SceneInput, one: R) -> Self {
        let fuselage = Body::fuselage(&input.fuselage, one);
        let mut wheels = List::empty(Wheel::new(None, 0, one));
        for (index, wheel) in input.wheels.iter().enumerate() {
            wheels.push(Wheel::new(wheel.as_ref(), index, one));
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
        input.fuselage.center_of_mass_m = Some([0.05, -0.02, 1.4]);
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
    fn a_tilt_turns_the_axis_by_its_angle_about_its_vector() {
        assert_eq!(wheel_axis(0, [0.0; 2], 1.0), WHEEL_AXES[0]);
        for (index, tilt, expected) in [
            // about s1: s2 towards s3, s3 towards -s2; about s3: s2 towards -s1; about s2: s3 towards s1
            (0, [0.3, 0.0], [0.0, 0.3f64.cos(), 0.3f64.sin()]),
            (0, [0.0, 0.3], [-0.3f64.sin(), 0.3f64.cos(), 0.0]),
            (1, [0.3, 0.0], [0.0, -0.3f64.sin(), 0.3f64.cos()]),
            (1, [0.0, 0.3], [0.3f64.sin(), 0.0, 0.3f64.cos()]),
        ] {
            let axis = wheel_axis(index, tilt, 1.0);
            assert!(norm(difference(axis, expected)) < 4e-16, "{axis:?} {expected:?}");
        }
        let axis = wheel_axis(1, [0.3, -0.4], 1.0);
        assert!((axis[2] - 0.5f64.cos()).abs() < 4e-16, "the angle is the length of the vector");
        assert!((axis[1] / axis[0] - 0.75).abs() < 4e-16, "{axis:?}");
    }

    #[test]
    fn held_wheels_turn_with_the_rest() {
        let mut input = samples::table_two();
        assert_eq!(MassProperties::of(&input, 1.0).inertia_rotating(), MassProperties::of(&input, 1.0).inertia_free);
        input.wheels[0].as_mut().expect("Table II has it").mode = WheelMode::SpeedHeld;
        let mass = MassProperties::of(&input, 1.0);
        assert_eq!(mass.inertia_rotating()[1][1], mass.inertia[1][1]);
        assert_eq!(mass.inertia_rotating()[2][2], mass.inertia_free[2][2]);
        input.wheels[1].as_mut().expect("Table II has it").mode = WheelMode::SpeedHeld;
        let mass = MassProperties::of(&input, 1.0);
        assert_eq!(mass.inertia_rotating(), mass.inertia);
    }

    #[test]
    fn a_mass_alone_scales_the_inertia_and_a_missing_wheel_weighs_nothing() {
        let mut input = samples::table_two();
        let nominal = MassProperties::of(&input, 1.0);
        input.fuselage.mass_kg = Some(2.0 * nominal.fuselage.mass);
        input.wheels = [None, None];
        let mass = MassProperties::of(&input, 1.0);
        assert_eq!(mass.fuselage.inertia[0][0], 2.0 * nominal.fuselage.inertia[0][0]);
        assert_eq!(mass.inertia, mass.fuselage.inertia);
        assert_eq!(mass.inertia_free, mass.fuselage.inertia);
        assert_eq!(mass.total, mass.fuselage.mass);
        assert_eq!(mass.center, mass.fuselage.center);
    }
}
