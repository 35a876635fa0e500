//! Distance, nadir angle, gravity-gradient torque, magnetic field and torque.

use fearless_simd::Simd;

use super::attitude::Attitude;
use super::motion::angle;
use super::points::{Magnetism, MeasuredRun, SeriesTable, constant_matrix, needed, three};
use super::table::Series;
use crate::dynamics::effects::gravity_gradient::GravityGradient;
use crate::math::prelude::*;
use crate::math::{Lanes, Real};
use crate::run::StateField;

#[inline(always)]
pub fn orbit<S: Simd>(simd: S, run: &MeasuredRun<'_>, out: &mut SeriesTable) {
    let (table, vectors) = (run.table, run.vectors());
    let position: [_; 3] = needed(table, StateField::ComPosition, vectors);
    let attitude = Attitude::of(table, vectors);
    let mu = run.scene.orbit.as_ref().map_or(f64::NAN, |orbit| orbit.mu);
    let gradient = GravityGradient {
        strength: Lanes::broadcast(simd, 3.0 * mu),
        inertia: constant_matrix(simd, run.scene.mass.inertia),
    };
    let [distances, nadirs, torques] =
        out.write([Series::OrbitDistance, Series::NadirAngle, Series::GradientTorqueSquare], vectors);
    for at in 0..vectors {
        let r = three(simd, position, at);
        let distance = norm(r);
        let inverse = Lanes::broadcast(simd, 1.0) / distance;
        let up = transposed_product(attitude.c_es(simd, at), scaled(inverse, r));
        let [x, y, z] = up;
        angle(x.mul_add(x, y * y).sqrt(), -z, &mut nadirs[at]);
        let torque = gradient.torque_at(up, inverse);
        dot(torque, torque).store(&mut torques[at]);
        distance.store(&mut distances[at]);
    }
    let Some(Magnetism { field, dipole, acting }) = run.magnetism else { return };
    let (field, times) = (field.in_lanes(gradient.strength), run.times);
    let residual = constant(gradient.strength, dipole);
    let mut rods = acting.rods();
    let [strengths, torques] = out.write([Series::FieldStrength, Series::MagneticTorqueSquare], vectors);
    for at in 0..vectors {
        let time = std::array::from_fn(|lane| times[(WIDTH * at + lane).min(times.len() - 1)]);
        let field_e = field.at(Lanes::load(simd, &time), three(simd, position, at));
        norm(field_e).store(&mut strengths[at]);
        let mut dipole = residual;
        if let Some(rods) = &mut rods {
            let of_points = time.map(|time| rods.dipole(time));
            dipole = std::array::from_fn(|i| residual[i] + Lanes::load(simd, &of_points.map(|dipole| dipole[i])));
        }
        let torque = cross(dipole, transposed_product(attitude.c_es(simd, at), field_e));
        dot(torque, torque).store(&mut torques[at]);
    }
}
