//! Solar radiation pressure on flat plates.
//!
//! f = -P A cos(theta) ((1 - c_s) s + 2 (c_s cos(theta) + c_d/3) n) at the plate's centre, cos(theta) = n . s > 0, with
//! the unit vector s to the Sun and the shares c_s and c_d of specular and diffuse reflection (J. Wertz, *Spacecraft
//! Attitude Determination and Control*, 1978, (17-27)..(17-30)). P falls with the square of the distance to the Sun and
//! with the visible share of its disc ([`crate::dynamics::environment::shadow`]). Neglected: mutual shadowing, light
//! from the Earth.

pub(super) use super::plates::largest_rate;
use super::plates::{PlateInLanes, PlatesInLanes, largest_lever, sum_of};
use super::within_arcs::Motion;
use crate::dynamics::environment::light::Light;
use crate::dynamics::environment::shadow::Zone;
use crate::math::prelude::*;
use crate::scene::{Scene, Shadow};

/// Lower bound of the Sun's distance in the series, au.
const NEAREST: f64 = 0.983;

#[derive(Clone, Copy, Debug)]
pub struct SolarPressure<R> {
    /// 1 - c_s, 2 c_s and 2 c_d/3, each times the pressure at 1 au, N/m^2.
    plates: PlatesInLanes<R, 3>,
    /// Sun and shadow.
    pub light: Light<R>,
    zone: Zone<R>,
}

impl<R: Real> SolarPressure<R> {
    pub fn none(zero: R) -> Self {
        let light = Light { epoch: zero, radius: zero, shadow: Shadow::Cone };
        SolarPressure { plates: PlatesInLanes::none(zero), light, zone: Zone::none(zero) }
    }

    pub fn set_lane(&mut self, lane: usize, own: &SolarPressure<f64>) {
        self.plates.set_lane(lane, &own.plates);
        self.zone.set_lane(lane, &own.zone);
        self.light.epoch.set_lane(lane, own.light.epoch);
        self.light.radius.set_lane(lane, own.light.radius);
        // equal in all runs of a plan
        self.light.shadow = own.light.shadow;
    }

    #[inline(always)]
    pub fn torque(&self, motion: &Motion<R>) -> [R; 3] {
        let (share, direction) = self.light_on(motion);
        self.torque_at(share, direction)
    }

    #[inline(always)]
    pub fn force(&self, motion: &Motion<R>) -> [R; 3] {
        let (share, direction) = self.light_on(motion);
        let mut all = [share.zero(); 3];
        for plate in self.plates.iter() {
            let (facing, push) = push(plate, direction);
            all = sum(all, scaled(facing, push));
        }
        scaled(-share, all)
    }

    /// Share of the pressure at 1 au, and unit vector to the Sun, B.
    #[inline(always)]
    fn light_on(&self, motion: &Motion<R>) -> (R, [R; 3]) {
        let sun = &motion.sun;
        let lit = self.zone.lit(self.light.shadow, motion.place.position, sun, self.light.radius);
        (lit / (sun.distance * sun.distance), seen(motion))
    }

    #[inline(always)]
    pub fn choose_branches(&mut self, lanes: R::Mask, motion: &Motion<R>) {
        let Light { radius, shadow, .. } = self.light;
        self.zone.choose_branches(lanes, shadow, motion.place.position, &motion.sun, radius);
        self.plates.choose_branches(lanes, seen(motion));
    }

    /// The lanes in penumbra.
    #[inline(always)]
    pub fn is_rough(&self, zero: R) -> R::Mask {
        self.zone.is_part(zero)
    }

    #[inline(always)]
    pub fn switches<const M: usize>(&self, motions: &[Motion<R>; M], visit: &mut impl FnMut([R; M])) {
        let mut edges = [[motions[0].time; M]; 2];
        let mut directions = [[motions[0].time; 3]; M];
        for (m, motion) in motions.iter().enumerate() {
            let own = self.zone.switches(self.light.shadow, motion.place.position, &motion.sun, self.light.radius);
            (edges[0][m], edges[1][m]) = (own[0], own[1]);
            directions[m] = seen(motion);
        }
        visit(edges[0]);
        visit(edges[1]);
        self.plates.switches(&directions, visit);
    }

    /// Torque at `share` of the pressure at 1 au and the unit vector `sun` to the Sun, B.
    #[inline(always)]
    pub fn torque_at(&self, share: R, sun: [R; 3]) -> [R; 3] {
        let (mut along, mut across) = ([share.zero(); 3], [share.zero(); 3]);
        for plate in self.plates.iter() {
            let ([absorbed, mirrored, scattered], facing) = (plate.numbers, plate.facing(sun));
            along = sum_of(along, absorbed * facing, plate.arm);
            across = sum_of(across, mirrored.mul_add(facing, scattered) * facing, plate.twist);
        }
        scaled(share, sum(cross(sun, along), across))
    }
}

/// Cosine of `plate` to the direction `sun` (B), and the force against that direction per cosine and unit pressure.
#[inline(always)]
fn push<R: Real>(plate: &PlateInLanes<R, 3>, sun: [R; 3]) -> (R, [R; 3]) {
    let [along, mirrored, scattered] = plate.numbers;
    let facing = plate.facing(sun);
    (facing, sum(scaled(along, sun), scaled(mirrored.mul_add(facing, scattered), plate.normal)))
}

#[inline(always)]
fn seen<R: Real>(motion: &Motion<R>) -> [R; 3] {
    transposed_product(dcm_from_quaternion(motion.attitude), motion.sun.direction)
}

pub fn of<R: Real>(zero: R, scene: &Scene, c_sb: Option<[[R; 3]; 3]>) -> Option<SolarPressure<R>> {
    let light = Light::of(zero, scene).filter(|_| scene.environment.solar_pressure)?;
    let pressure = scene.environment.solar_pressure_n_m2;
    let plates = PlatesInLanes::of(zero, scene, c_sb, |plate| {
        [1.0 - plate.specular, 2.0 * plate.specular, 2.0 / 3.0 * plate.diffuse].map(|share| pressure * share)
    });
    Some(SolarPressure { plates, light, zone: Zone::none(zero) })
}

/// Upper bound of the torque on `scene`, N m: at the smallest distance, all plates facing the Sun.
pub fn largest_torque(scene: &Scene) -> f64 {
    if !scene.environment.solar_pressure || scene.orbit.is_none() {
        return 0.0;
    }
    let pressure = scene.environment.solar_pressure_n_m2 / (NEAREST * NEAREST);
    pressure * largest_lever(scene, |plate| 1.0 + plate.specular + 2.0 / 3.0 * plate.diffuse)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{EnvironmentInput, Epoch, Name, OrbitInput, PlateInput, SceneInput};

    const PRESSURE: f64 = 5e-6;

    fn light(plate: PlateInput) -> SolarPressure<f64> {
        let environment =
            EnvironmentInput { solar_pressure: true, solar_pressure_n_m2: PRESSURE, ..EnvironmentInput::DEFAULT };
        let orbit = Some(OrbitInput {
            semi_major_axis_m: Some(7e6),
            epoch: Epoch::parse("2026-11-24T00:00:00Z"),
            ..OrbitInput::DEFAULT
        });
        let plates = vec![PlateInput { name: Name::of("a"), area_m2: 4.0, ..plate }];
        let input = SceneInput { orbit, environment, plates, ..SceneInput::default() };
        of(0.0, &Scene::resolve(&input).expect("a legal scene"), None).expect("light")
    }

    /// Law: absorbed light pushes along the rays with P A cos, mirrored light along the normal with 2 P A cos^2,
    /// scattered light along the rays plus 2/3 of it along the normal; none from behind.
    #[test]
    fn light_pushes_by_its_momentum() {
        let arm = [1.0, -2.0, 0.5];
        let normal = [0.0, 0.0, 1.0];
        let (s, c) = libm::sincos(0.7_f64);
        let sun = [s, 0.0, c];
        let full = PRESSURE * 4.0 * c;
        for (specular, diffuse, force) in [
            (0.0, 0.0, scaled(-full, sun)),
            (1.0, 0.0, scaled(-2.0 * full * c, normal)),
            (0.0, 1.0, sum(scaled(-full, sun), scaled(-2.0 / 3.0 * full, normal))),
        ] {
            let light = light(PlateInput { specular, diffuse, center_m: arm, ..PlateInput::DEFAULT });
            let off = norm(difference(light.torque_at(1.0, sun), cross(arm, force)));
            assert!(off < 1e-15 * full, "{specular} {diffuse}: {off:e}");
            assert_eq!(light.torque_at(1.0, [s, 0.0, -c]), [0.0; 3]);
            let half = norm(difference(light.torque_at(0.5, sun), scaled(0.5, cross(arm, force))));
            assert!(half < 1e-15 * full);
        }
    }
}
