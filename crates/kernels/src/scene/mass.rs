//! Mass properties of the spacecraft: its body ([`super::body`]) and turning wheels (`wheel`). Sums over bodies use
//! distances between pairs, sum over i < j of m_i m_j / m (r^2 1 - r r^T), without cancellation.

use super::input::SceneInput;
use super::schema::{MAX_WHEELS, WheelMode};
pub use super::solids::Body;
use super::tensor::{matrix_sum, point_inertia};
pub use super::wheel::Wheel;
use crate::math::list::List;
use crate::math::prelude::*;

/// Mass properties of all bodies, and of the spacecraft (body and wheels).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassProperties<R = f64> {
    /// The body without turning wheels.
    pub body: Body<R>,
    /// Turning wheels, in order; a locked wheel is part of the body.
    pub wheels: List<Wheel<R>, MAX_WHEELS>,
    /// The debris D, if present.
    pub debris: Option<Body<R>>,
    /// Mass m of the spacecraft, kg.
    pub total: R,
    /// Centre of mass c of the spacecraft from p in F_s, m.
    pub center: [R; 3],
    /// Inertia J of the spacecraft about c with wheels locked, F_s, kg m^2, by rows.
    pub inertia: [[R; 3]; 3],
    /// J* = J - sum J_i a_i a_i^T, kg m^2, by rows: resists a change of omega with freely turning wheels.
    pub inertia_free: [[R; 3]; 3],
}

impl<R: Real> MassProperties<R> {
    /// Mass properties of `input` in the type of `one`.
    pub fn of(input: &SceneInput, one: R) -> Self {
        let body = Body::of_input(input, one);
        let mut wheels = List::empty(Wheel::blank(one));
        for wheel in input.turning() {
            wheels.push(Wheel::new(wheel, one));
        }
        let debris = input.debris.as_ref().map(|debris| Body::debris(debris, one));

        let wheel_mass = wheels.iter().map(|wheel| wheel.mass).reduce(|a, b| a + b);
        let total = wheel_mass.map_or(body.mass, |mass| body.mass + mass);
        // from the body's centre, so that equal wheels on both sides move it by nothing, to the last bit
        let shift = |wheel: &Wheel<R>| scaled(wheel.mass / total, difference(wheel.center, body.center));
        let center = wheels.iter().map(shift).reduce(sum).map_or(body.center, |shift| sum(body.center, shift));

        let mut inertia_free = body.inertia;
        for wheel in &wheels {
            inertia_free = matrix_sum(inertia_free, wheel.transverse_inertia());
        }
        let point = |index: usize| match index {
            0 => (body.mass, body.center),
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
        MassProperties { body, wheels, debris, total, center, inertia, inertia_free }
    }

    /// Replaces the inertia about c, wheels locked, F_s, kg m^2; keeps the axial inertias of the wheels.
    #[must_use]
    pub fn with_inertia(self, inertia: [[R; 3]; 3]) -> Self {
        let less = |sum: [[R; 3]; 3], part: [[R; 3]; 3]| std::array::from_fn(|i| difference(sum[i], part[i]));
        let inertia_free = self.wheels.iter().fold(inertia, |sum, wheel| less(sum, wheel.axial_inertia()));
        MassProperties { inertia, inertia_free, ..self }
    }

    /// The inertia that resists a change of omega, kg m^2, by rows: J* plus axial inertias of wheels of constant speed.
    pub fn inertia_rotating(&self) -> [[R; 3]; 3] {
        let held = self.wheels.iter().filter(|wheel| wheel.mode == WheelMode::SpeedHeld);
        held.fold(self.inertia_free, |sum, wheel| matrix_sum(sum, wheel.axial_inertia()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::samples;

    /// Check values have 16 digits; measured: 6.7e-16.
    const CHECK_TOLERANCE: f64 = 1e-15;

    fn assert_close(name: &str, value: f64, expected: f64) {
        assert!((value / expected - 1.0).abs() <= CHECK_TOLERANCE, "{name}: {value:?}, expected {expected:?}");
    }

    #[test]
    fn table_two_gives_the_check_values() {
        let mass = MassProperties::of(&samples::table_two(), 1.0);
        assert_close("m_s", mass.body.mass, 1982.7715926975181);
        assert_close("J_s transverse", mass.body.inertia[0][0], 3026.338725586386);
        assert_close("J_s axial", mass.body.inertia[2][2], 1684.750805384533);
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
        for (i, row) in mass.inertia.iter().enumerate() {
            let others = [row[(i + 1) % 3], row[(i + 2) % 3]];
            assert_eq!(others, [0.0; 2], "exactly diagonal, so that nothing spends time on products");
        }
    }
}
