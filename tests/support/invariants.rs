//! Energy and angular momentum of a run without actuators from its states, in double-double.

use super::prelude::*;
use spindrift::{
    math::vector::{self, constant, constant_matrix},
    scene::mass::Wheel,
};

#[derive(Clone, Copy, Debug)]
pub struct Invariants {
    /// Kinetic energy about c, J, minus the work of motors that hold a speed.
    pub energy: DoubleDouble,
    /// From the rates alone, N m s.
    pub momentum: DoubleDouble,
    /// About c in F_e, N m s, by the unit quaternion along the attitude.
    pub momentum_e: [DoubleDouble; 3],
    pub norm: DoubleDouble,
}

fn wheel_momenta(scene: &Scene) -> Vec<DoubleDouble> {
    let zero = DoubleDouble::exact(0.0);
    let omega = constant(zero, scene.initial.omega_se_s);
    let momentum = |(wheel, rate): (&Wheel, f64)| {
        let carried = match wheel.mode {
            WheelMode::Free => dot(constant(zero, wheel.axis), omega),
            WheelMode::SpeedHeld => zero,
            WheelMode::Locked => unreachable!("a locked wheel is a part of the body"),
        };
        zero.splat(wheel.axial) * (carried + zero.splat(rate))
    };
    scene.mass.wheels.iter().zip(scene.initial.wheel_rates).map(momentum).collect()
}

impl Invariants {
    pub fn of(scene: &Scene, table: &StateTable, point: usize) -> Self {
        let zero = DoubleDouble::exact(0.0);
        let half = zero.splat(0.5);
        let omega = constant(zero, table.at::<3>(StateField::Rate, point));
        let mut momentum = product(constant_matrix(zero, scene.mass.inertia_rotating()), omega);
        let mut energy = half * dot(momentum, omega);
        for (wheel, h) in scene.mass.wheels.iter().zip(wheel_momenta(scene)) {
            momentum = sum(momentum, scaled(h, constant(zero, wheel.axis)));
            energy += half * h * h / zero.splat(wheel.axial);
        }
        let q = table.at::<4>(StateField::Attitude, point).map(DoubleDouble::exact);
        let norm = (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]).sqrt();
        let unit = q.map(|component| component / norm);
        let momentum_e = product(dcm_from_quaternion(unit), momentum);
        Invariants { energy, momentum: vector::norm(momentum), momentum_e, norm }
    }

    pub fn errors(&self, start: &Self) -> [f64; 4] {
        let off = |now: DoubleDouble, then: DoubleDouble| {
            let size = if then.high == 0.0 { DoubleDouble::exact(1.0) } else { then };
            ((now - then) / size).high
        };
        let moved = vector::difference(self.momentum_e, start.momentum_e);
        let size = if start.momentum.high == 0.0 { 1.0 } else { start.momentum.high };
        [
            off(self.energy, start.energy),
            off(self.momentum, start.momentum),
            off(self.norm, start.norm),
            vector::norm(moved).high / size,
        ]
    }
}
