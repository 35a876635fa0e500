//! Magnetic torque of the residual dipole and of the torque rods: tau = m x B (J. R. Wertz, *Spacecraft Attitude
//! Determination and Control*, 1978, section 17.2) with the dipole m constant in the body over an arc.

pub(super) use super::plates::largest_rate;
use super::within_arcs::{Motion, MotionSeries};
use crate::dynamics::magnetic_field::series::FieldSeries;
use crate::dynamics::magnetic_field::{MagneticField, largest};
use crate::math::prelude::*;
use crate::scene::Scene;

#[derive(Clone, Copy, Debug)]
pub struct MagneticTorque<R> {
    /// The Earth's field.
    pub field: MagneticField<R>,
    /// Residual dipole, B, A m^2.
    residual: [R; 3],
    /// Residual dipole plus torque rods in the present arc.
    dipole: [R; 3],
}

impl<R: Real> MagneticTorque<R> {
    pub fn none(zero: R) -> Self {
        MagneticTorque { field: MagneticField::none(zero), residual: [zero; 3], dipole: [zero; 3] }
    }

    pub fn set_lane(&mut self, lane: usize, own: &MagneticTorque<f64>) {
        self.field.set_lane(lane, &own.field);
        self.set_arc(lane, own);
    }

    pub fn set_arc(&mut self, lane: usize, own: &MagneticTorque<f64>) {
        set_lanes(&mut self.residual, lane, &own.residual);
        set_lanes(&mut self.dipole, lane, &own.dipole);
    }

    /// Starts an arc with the dipole of the torque rods, B, A m^2.
    pub fn begin_arc(&mut self, rods: [R; 3]) {
        self.dipole = sum(self.residual, rods);
    }

    #[inline(always)]
    pub fn torque(&self, motion: &Motion<R>) -> [R; 3] {
        cross(self.dipole, transposed_product(dcm_from_quaternion(motion.attitude), motion.field))
    }
}

/// Residual dipole of `scene`, F_s, A m^2; `None` without dipole and torque rods.
pub fn residual_dipole(scene: &Scene) -> Option<[f64; 3]> {
    scene.environment.magnetic_dipole_a_m2.or((!scene.torque_rods.is_empty()).then_some([0.0; 3]))
}

pub fn of<R: Real>(zero: R, scene: &Scene, c_sb: Option<[[R; 3]; 3]>) -> Option<MagneticTorque<R>> {
    let dipole = constant(zero, residual_dipole(scene)?);
    let field = MagneticField::of(scene)?.in_lanes(zero);
    let residual = c_sb.map_or(dipole, |c_sb| transposed_product(c_sb, dipole));
    Some(MagneticTorque { field, residual, dipole: residual })
}

/// Taylor coefficients of the torque m x (q* (x) B (x) q), by products of series.
#[derive(Clone, Debug)]
pub struct MagneticSeries<R> {
    /// m, A m^2 s^2 per unit of time squared.
    dipole: [R; 3],
    field: FieldSeries<R>,
    /// B (x) q.
    turned: Vec<[R; 4]>,
}

impl<R: Real> MagneticSeries<R> {
    pub fn new(zero: R, order: usize) -> Self {
        MagneticSeries { dipole: [zero; 3], field: FieldSeries::new(zero, order), turned: vec![[zero; 4]; order + 1] }
    }

    pub const NEEDS_POSITION: bool = true;

    #[inline(always)]
    pub fn begin(&mut self, torque: &MagneticTorque<R>, time: R, unit: R) {
        self.dipole = torque.dipole.map(|component| component * (unit * unit));
        self.field.begin(&torque.field, time, unit);
    }

    #[inline(always)]
    pub fn extend(&mut self, n: usize, motion: &MotionSeries<R>) -> [R; 3] {
        let MagneticSeries { dipole, field, turned, .. } = self;
        let MotionSeries { attitude, orbit, .. } = motion;
        let zero = dipole[0].zero();
        field.extend(n, orbit);
        let mut sums = [zero; 4];
        for m in 0..=n {
            let [x, y, z] = field.field()[m];
            let product = hamilton([zero, x, y, z], attitude[n - m]);
            for i in 0..4 {
                sums[i] += product[i];
            }
        }
        turned[n] = sums;
        let mut field_b = [zero; 3];
        for m in 0..=n {
            let [_, x, y, z] = hamilton(conjugate(attitude[m]), turned[n - m]);
            field_b = sum(field_b, [x, y, z]);
        }
        cross(*dipole, field_b)
    }
}

/// Upper bound of the torque on `scene`, N m: all rods at their limits, across the largest field at periapsis.
pub fn largest_torque(scene: &Scene) -> f64 {
    let (Some(orbit), Some(dipole)) = (&scene.orbit, residual_dipole(scene)) else { return 0.0 };
    let stuck = scene.failures.iter().filter_map(|failure| failure.dipole_a_m2);
    let driven = scene.torque_rods.iter().map(|rod| rod.scale * rod.limit);
    let all = driven.chain(stuck).fold(norm(dipole), |sum, dipole| sum + dipole.abs());
    all * largest(orbit.lowest())
}
