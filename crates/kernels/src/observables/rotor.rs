//! [`Body`]: constants of a run's rotation for [`super::conditioning`].

use super::acting::Acting;
use crate::math::prelude::*;
use crate::run::{StateField, StateTable};
use crate::scene::mass::MassProperties;

pub struct Body<'a> {
    /// `None` for the debris.
    pub mass: Option<&'a MassProperties>,
    pub rates: StateField,
    /// K, kg m^2, its inverse A, and a third of the trace of K.
    pub inertia: [[f64; 3]; 3],
    pub inverse: [[f64; 3]; 3],
    pub size: f64,
    /// Upper bounds of |A| and of the distance of A from a multiple of one, 1/(kg m^2).
    pub stiffness: f64,
    pub spread: f64,
    pub is_principal: bool,
    /// The wheels' momentum H - K omega if constant, without actuation.
    pub offset: Option<[f64; 3]>,
    /// sum |J_i Omega_i| at the first point, N m s.
    pub wheels: f64,
}

impl<'a> Body<'a> {
    pub fn of(acting: Acting<'a>, table: &StateTable, duration: f64) -> Self {
        let mass = &acting.scene().mass;
        let inertia = mass.inertia_rotating();
        let offset = acting.is_free(duration).then(|| {
            let omega = table.at::<3>(StateField::Rate, 0);
            let mut momentum = difference(product(mass.inertia, omega), product(inertia, omega));
            for (index, wheel) in mass.wheels.iter().enumerate() {
                let rate = table.column(StateField::WheelRates, index)[0];
                momentum = sum(momentum, scaled(wheel.axial * rate, wheel.axis));
            }
            momentum
        });
        let speed = |index: usize| table.column(StateField::WheelRates, index)[0].abs();
        let wheels = mass.wheels.iter().enumerate().map(|(index, wheel)| wheel.axial * speed(index)).sum();
        Body { mass: Some(mass), rates: StateField::Rate, wheels, ..Body::alone(inertia, offset) }
    }

    /// The debris, without wheels and torque.
    pub fn debris(inertia: [[f64; 3]; 3]) -> Self {
        Body::alone(inertia, Some([0.0; 3]))
    }

    fn alone(inertia: [[f64; 3]; 3], offset: Option<[f64; 3]>) -> Self {
        let [[x, xy, xz], [_, y, yz], [.., z]] = inertia;
        let adjugate = adjugate(inertia);
        let per_determinant = 1.0 / dot(inertia[0], adjugate[0]);
        let inverse = adjugate.map(|row| scaled(per_determinant, row));
        let mean = (inverse[0][0] + inverse[1][1] + inverse[2][2]) / 3.0;
        let mut square = 0.0;
        for (i, row) in inverse.iter().enumerate() {
            let mut row = *row;
            row[i] -= mean;
            square += dot(row, row);
        }
        // largest eigenvalue of a traceless symmetric matrix with this sum of squares: (2, -1, -1)/sqrt(6)
        let spread = (2.0 / 3.0 * square).sqrt();
        Body {
            mass: None,
            rates: StateField::DebrisRate,
            inertia,
            inverse,
            stiffness: mean + spread,
            spread,
            size: (x + y + z) / 3.0,
            is_principal: xy == 0.0 && xz == 0.0 && yz == 0.0,
            offset,
            wheels: 0.0,
        }
    }
}

/// Adjugate of a symmetric matrix, by rows.
pub fn adjugate(m: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    [cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1])]
}
