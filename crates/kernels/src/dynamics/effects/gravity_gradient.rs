//! Gravity gradient torque: tau = 3 mu/|r|^5 r x (J r).
//!
//! J is the inertia about the centre of mass with locked wheels, r the position from the central body (P. Hughes,
//! *Spacecraft Attitude Dynamics*, 1986, section 8.1: first order in size over |r|).

use super::within_arcs::{Motion, MotionSeries};
use crate::dynamics::orbit_in_body::OrbitInBody;
use crate::dynamics::orbit_state::OrbitState;
use crate::math::prelude::*;
use crate::math::symmetric::principal_axes;
use crate::scene::Scene;

#[derive(Clone, Copy, Debug)]
pub struct GravityGradient<R> {
    /// 3 mu, m^3/s^2; zero if inactive.
    pub strength: R,
    /// J by rows, in the frame of the attitude, kg m^2.
    pub inertia: [[R; 3]; 3],
}

impl<R: Real> GravityGradient<R> {
    pub fn none(zero: R) -> Self {
        GravityGradient { strength: zero, inertia: [[zero; 3]; 3] }
    }

    pub fn set_lane(&mut self, lane: usize, gradient: &GravityGradient<f64>) {
        self.strength.set_lane(lane, gradient.strength);
        for (row, own) in self.inertia.iter_mut().zip(&gradient.inertia) {
            set_lanes(row, lane, own);
        }
    }

    #[inline(always)]
    pub fn torque(&self, motion: &Motion<R>) -> [R; 3] {
        let OrbitState { position, distance, .. } = motion.place;
        let inverse = distance.splat(1.0) / distance;
        let up = transposed_product(dcm_from_quaternion(motion.attitude), scaled(inverse, position));
        self.torque_at(up, inverse)
    }

    /// Torque for the local vertical `up` (unit vector, B) and the inverse distance `inverse`, 1/m.
    #[inline(always)]
    pub fn torque_at(&self, up: [R; 3], inverse: R) -> [R; 3] {
        let strength = self.strength * (inverse * (inverse * inverse));
        scaled(strength, cross(up, product(self.inertia, up)))
    }
}

pub fn of<R: Real>(zero: R, scene: &Scene, c_sb: Option<[[R; 3]; 3]>) -> Option<GravityGradient<R>> {
    let orbit = scene.orbit.as_ref().filter(|_| scene.environment.gravity_gradient)?;
    let inertia_s = constant_matrix(zero, scene.mass.inertia);
    let inertia = match c_sb {
        None => inertia_s,
        // column by column: C_bs J C_sb
        Some(c_sb) => {
            let columns: [[R; 3]; 3] = core::array::from_fn(|j| {
                transposed_product(c_sb, product(inertia_s, [c_sb[0][j], c_sb[1][j], c_sb[2][j]]))
            });
            core::array::from_fn(|i| core::array::from_fn(|j| columns[j][i]))
        }
    };
    Some(GravityGradient { strength: zero.splat(3.0) * zero.splat(orbit.mu), inertia })
}

/// Taylor coefficients of the torque 3 s/rho r x (J r) with s = mu rho^(-3/2), rho = r . r ([`OrbitInBody`]).
#[derive(Clone, Debug)]
pub struct GradientSeries<R> {
    /// J in B, kg m^2.
    inertia: [[R; 3]; 3],
    orbit: OrbitInBody<R>,
    /// 3 r x (J r).
    lever: Vec<[R; 3]>,
    /// s/rho.
    strength: Vec<R>,
}

impl<R: Real> GradientSeries<R> {
    pub fn new(zero: R, order: usize) -> Self {
        GradientSeries {
            inertia: [[zero; 3]; 3],
            orbit: OrbitInBody::new(zero, order),
            lever: vec![[zero; 3]; order + 1],
            strength: vec![zero; order + 1],
        }
    }

    pub const NEEDS_POSITION: bool = false;

    #[inline(always)]
    pub fn begin(&mut self, gradient: &GravityGradient<R>, _time: R, _unit: R) {
        self.inertia = gradient.inertia;
    }

    #[inline(always)]
    pub fn extend(&mut self, n: usize, motion: &MotionSeries<R>) -> [R; 3] {
        let GradientSeries { inertia, orbit, lever, strength } = self;
        if n == 0 {
            orbit.begin(inertia, motion);
        }
        orbit.extend(n, motion);
        let three = inertia[0][0].splat(3.0);
        // on a circle the strength is a number, and few coefficients are kept in the first cache
        let last = if orbit.is_round() { 0 } else { n };
        lever[last] = scaled(three, orbit.lever(inertia));
        if last == n {
            strength[n] = orbit.pull_over_square(n, strength);
        }
        let mut own = [three.zero(); 3];
        for (g, lever) in strength[..=last].iter().zip(lever[..=last].iter().rev()) {
            for i in 0..3 {
                own[i] = g.mul_add(lever[i], own[i]);
            }
        }
        own
    }
}

/// Upper bound of the torque on `scene`, N m: at periapsis, largest and smallest axis at 45 degrees to the vertical.
pub fn largest_torque(scene: &Scene) -> f64 {
    let Some(orbit) = scene.orbit.as_ref().filter(|_| scene.environment.gravity_gradient) else { return 0.0 };
    let lowest = orbit.lowest();
    let (moments, _) = principal_axes(scene.mass.inertia);
    let [least, most] = [moments[0].min(moments[1]).min(moments[2]), moments[0].max(moments[1]).max(moments[2])];
    1.5 * orbit.mu / (lowest * lowest * lowest) * (most - least)
}

/// Largest rate of libration, rad/s: sqrt(3 mu/r^3) at periapsis, the rate of a dumbbell.
pub fn largest_rate(scene: &Scene, _torque: f64) -> f64 {
    let Some(orbit) = scene.orbit.as_ref().filter(|_| scene.environment.gravity_gradient) else { return 0.0 };
    let lowest = orbit.lowest();
    (3.0 * orbit.mu / lowest).sqrt() / lowest
}
