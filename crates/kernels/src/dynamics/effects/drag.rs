//! Aerodynamic drag on flat plates.
//!
//! f = -rho/2 C_d A max(0, n . v) v at the plate's centre, with the outward normal n and the velocity v relative to air
//! that rotates with the Earth (J. Wertz, *Spacecraft Attitude Determination and Control*, 1978, section 17.2.3).
//! Neglected: velocity of a plate relative to the centre of mass (1e-5 of v), mutual shadowing.

pub(super) use super::plates::largest_rate;
use super::plates::{PlatesInLanes, largest_lever, sum_of};
use super::within_arcs::Motion;
use crate::dynamics::environment::EARTH_RATE;
use crate::dynamics::environment::air::{Air, AirTable};

use crate::math::prelude::*;
use crate::scene::Scene;

#[derive(Clone, Copy, Debug)]
pub struct Drag<R> {
    /// Drag coefficient.
    plates: PlatesInLanes<R, 1>,
    air: Air<R>,
}

impl<R: Real> Drag<R> {
    pub fn none(zero: R) -> Self {
        Drag { plates: PlatesInLanes::none(zero), air: Air::none(zero) }
    }

    pub fn set_lane(&mut self, lane: usize, own: &Drag<f64>) {
        self.plates.set_lane(lane, &own.plates);
        self.air.set_lane(lane, &own.air);
    }

    #[inline(always)]
    pub fn torque(&self, motion: &Motion<R>) -> [R; 3] {
        self.torque_at(self.air.density(motion.place.distance), flow(motion))
    }

    #[inline(always)]
    pub fn force(&self, motion: &Motion<R>) -> [R; 3] {
        let velocity = flow(motion);
        let density = self.air.density(motion.place.distance);
        let mut all = density.zero();
        for plate in self.plates.iter() {
            let [drag] = plate.numbers;
            all = drag.mul_add(plate.facing(velocity), all);
        }
        scaled(density * density.splat(-0.5) * all, velocity)
    }

    #[inline(always)]
    pub fn choose_branches(&mut self, lanes: R::Mask, motion: &Motion<R>) {
        self.air.choose_branches(lanes, motion.place.distance);
        self.plates.choose_branches(lanes, flow(motion));
    }

    /// Drag is smooth for given plates and layer.
    #[inline(always)]
    pub fn is_rough(&self, zero: R) -> R::Mask {
        zero.never()
    }

    #[inline(always)]
    pub fn switches<const M: usize>(&self, motions: &[Motion<R>; M], visit: &mut impl FnMut([R; M])) {
        let mut distances = [motions[0].time; M];
        let mut directions = [[motions[0].time; 3]; M];
        for m in 0..M {
            distances[m] = motions[m].place.distance;
            let velocity = flow(&motions[m]);
            directions[m] = scaled(distances[m].splat(1.0) / norm(velocity), velocity);
        }
        self.air.switches(&distances, visit);
        self.plates.switches(&directions, visit);
    }

    /// Density at `distance` m from the Earth's centre, kg/m^3, in whatever layer.
    #[inline(always)]
    pub fn density_anywhere(&mut self, distance: R) -> R {
        self.air.choose_branches(!distance.zero().never(), distance);
        self.air.density(distance)
    }

    /// Torque at `density` (kg/m^3) and the velocity relative to the air, B, m/s.
    #[inline(always)]
    pub fn torque_at(&self, density: R, velocity: [R; 3]) -> [R; 3] {
        let mut arm = [density.zero(); 3];
        for plate in self.plates.iter() {
            let [drag] = plate.numbers;
            arm = sum_of(arm, drag * plate.facing(velocity), plate.arm);
        }
        scaled(density * density.splat(-0.5), cross(arm, velocity))
    }
}

#[inline(always)]
fn flow<R: Real>(motion: &Motion<R>) -> [R; 3] {
    transposed_product(dcm_from_quaternion(motion.attitude), Air::relative_velocity(&motion.place))
}

/// The atmosphere of `scene`, if drag acts.
pub fn air_of(scene: &Scene) -> Option<Air<f64>> {
    let orbit = scene.orbit.as_ref().filter(|_| scene.environment.drag)?;
    let exponential = scene.environment.exponential().map(Option::unwrap_or_default);
    let table = AirTable::of(&scene.environment);
    Some(Air::new(scene.environment.density_scale, orbit.body_radius, exponential, table))
}

pub fn of<R: Real>(zero: R, scene: &Scene, c_sb: Option<[[R; 3]; 3]>) -> Option<Drag<R>> {
    let own = air_of(scene)?;
    let mut air = Air::none(zero);
    (0..R::LANES).for_each(|lane| air.set_lane(lane, &own));
    Some(Drag { plates: PlatesInLanes::of(zero, scene, c_sb, |plate| [plate.drag_coefficient]), air })
}

/// Upper bound of the torque on `scene`, N m: at periapsis, against the Earth's rotation, all plates facing the flow.
pub fn largest_torque(scene: &Scene) -> f64 {
    let Some((orbit, air)) = scene.orbit.as_ref().zip(air_of(scene)) else { return 0.0 };
    let lowest = orbit.lowest();
    let speed = (orbit.mu * (2.0 / lowest - 1.0 / orbit.shape().semi_major_axis)).sqrt() + EARTH_RATE * lowest;
    0.5 * air.density(lowest) * speed * speed * largest_lever(scene, |plate| plate.drag_coefficient)
}
