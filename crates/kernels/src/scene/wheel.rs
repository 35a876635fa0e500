//! A turning wheel: mass properties, and its axial and transverse inertia.

use super::alignment::aligned;
use super::schema::{WheelInput, WheelMode};
use super::solids::{Body, Cylinder, solid_cylinder};
use super::tensor::{matrix_sum, point_inertia};
use crate::math::prelude::*;

/// A balanced axisymmetric turning wheel, with centre and axis fixed in the body.
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
    /// Moment of inertia about any transverse axis through the centre, kg m^2.
    pub transverse: R,
    /// Free or of constant speed.
    pub mode: WheelMode,
}

impl<R: Real> Wheel<R> {
    pub(super) fn blank(one: R) -> Self {
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

    /// Inertia about the wheel's centre, kg m^2, by rows, in F_s and in the wheel's frame.
    pub fn inertia(&self) -> [[R; 3]; 3] {
        matrix_sum(self.axial_inertia(), self.transverse_inertia())
    }

    /// J_i a a^T.
    pub(super) fn axial_inertia(&self) -> [[R; 3]; 3] {
        std::array::from_fn(|i| scaled(self.axial * self.axis[i], self.axis))
    }

    pub(super) fn transverse_inertia(&self) -> [[R; 3]; 3] {
        point_inertia(self.transverse, self.axis)
    }
}
