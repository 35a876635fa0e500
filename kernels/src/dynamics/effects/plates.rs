//! [`PlatesInLanes`]: the plates of a spacecraft for one run per lane, in the frame B of the equations.
//!
//! The cosine between a plate's normal and what comes upon it is its switch function: below zero the plate faces away.
//! Where steps end at switches the side is chosen once and then frozen.

use crate::math::Real;
use crate::math::symmetric::principal_axes;
use crate::math::vector::{constant, difference, dot, norm, transposed_product};
use crate::scene::{MAX_PLATES, Plate, Scene};

/// Plates with `K` numbers each, which say what acts on them. A lane with fewer plates has the others without an area.
#[derive(Clone, Copy, Debug)]
pub struct PlatesInLanes<R, const K: usize> {
    plates: [PlateInLanes<R, K>; MAX_PLATES],
    count: usize,
}

/// A plate.
#[derive(Clone, Copy, Debug)]
pub struct PlateInLanes<R, const K: usize> {
    /// Outward unit normal, B.
    pub normal: [R; 3],
    /// Centre from the centre of mass, B, m.
    pub arm: [R; 3],
    /// What acts on it, times its area.
    pub numbers: [R; K],
    /// The least and the largest that it feels of the cosine: zero and infinity until its side is chosen, then minus
    /// infinity and infinity, or zero.
    limits: [R; 2],
}

impl<R: Real, const K: usize> PlatesInLanes<R, K> {
    /// None.
    pub fn none(zero: R) -> Self {
        let limits = [zero, zero.splat(f64::INFINITY)];
        let plate = PlateInLanes { normal: [zero; 3], arm: [zero; 3], numbers: [zero; K], limits };
        PlatesInLanes { plates: [plate; MAX_PLATES], count: 0 }
    }

    /// Those of `scene` in the frame B, which `c_sb` maps to F_s, with the numbers `numbers` of each.
    pub fn of(zero: R, scene: &Scene, c_sb: Option<[[R; 3]; 3]>, numbers: impl Fn(&Plate) -> [f64; K]) -> Self {
        let mut plates = Self::none(zero);
        let into_b = |v: [f64; 3]| c_sb.map_or(constant(zero, v), |c_sb| transposed_product(c_sb, constant(zero, v)));
        for (own, plate) in plates.plates.iter_mut().zip(&scene.plates) {
            own.normal = into_b(plate.normal);
            own.arm = into_b(difference(plate.center, scene.mass.center));
            own.numbers = numbers(plate).map(|number| zero.splat(number) * zero.splat(plate.area));
        }
        plates.count = scene.plates.len().min(MAX_PLATES);
        plates
    }

    /// Puts `own` into lane `lane`.
    pub fn set_lane(&mut self, lane: usize, own: &PlatesInLanes<f64, K>) {
        self.count = self.count.max(own.count);
        for (plate, own) in self.plates[..self.count].iter_mut().zip(&own.plates) {
            for i in 0..3 {
                plate.normal[i].set_lane(lane, own.normal[i]);
                plate.arm[i].set_lane(lane, own.arm[i]);
            }
            for (number, own) in plate.numbers.iter_mut().zip(own.numbers) {
                number.set_lane(lane, own);
            }
            for (limit, own) in plate.limits.iter_mut().zip(own.limits) {
                limit.set_lane(lane, own);
            }
        }
    }

    /// Chooses the side of each plate in the lanes `lanes`, where `direction` is that against which something comes.
    #[inline(always)]
    pub fn choose_branches(&mut self, lanes: R::Mask, direction: [R; 3]) {
        let zero = direction[0].zero();
        let infinite = zero.splat(f64::INFINITY);
        for plate in &mut self.plates[..self.count] {
            let faces = zero.lt(dot(plate.normal, direction));
            plate.limits[0] = R::select(lanes, R::select(faces, -infinite, zero), plate.limits[0]);
            plate.limits[1] = R::select(lanes, R::select(faces, infinite, zero), plate.limits[1]);
        }
    }

    /// Gives `visit` the switch function of each plate in its branch, at the same unit vector in `M` states.
    #[inline(always)]
    pub fn switches<const M: usize>(&self, directions: &[[R; 3]; M], visit: &mut impl FnMut([R; M])) {
        for plate in self.iter() {
            let mut cosines = [plate.limits[1]; M];
            for (cosine, direction) in cosines.iter_mut().zip(directions) {
                let own = dot(plate.normal, *direction);
                *cosine = R::select(own.zero().lt(plate.limits[1]), own, -own);
            }
            visit(cosines);
        }
    }

    /// The plates.
    #[inline(always)]
    pub fn iter(&self) -> impl Iterator<Item = &PlateInLanes<R, K>> {
        self.plates[..self.count].iter()
    }
}

impl<R: Real, const K: usize> PlateInLanes<R, K> {
    /// The cosine of the angle between the normal and the unit vector `direction`, zero where the plate faces away; on
    /// a side that was chosen the cosine itself, or zero.
    #[inline(always)]
    pub fn facing(&self, direction: [R; 3]) -> R {
        dot(self.normal, direction).larger(self.limits[0]).smaller(self.limits[1])
    }
}

/// Sum of the areas of the plates of `scene` times their distances from the centre of mass, m^3, with `weight` of each:
/// no torque of a pressure of one is larger.
pub fn largest_lever(scene: &Scene, weight: impl Fn(&Plate) -> f64) -> f64 {
    let of = |plate: &Plate| weight(plate) * plate.area * norm(difference(plate.center, scene.mass.center));
    scene.plates.iter().map(of).sum()
}

/// The rate of oscillations of `scene` under a torque of `largest` N m, rad/s: it changes over an angle of one at the
/// plates' distance.
pub(super) fn largest_rate(scene: &Scene, largest: f64) -> f64 {
    if largest == 0.0 {
        return 0.0;
    }
    let (moments, _) = principal_axes(scene.mass.inertia);
    (largest / moments[0].min(moments[1]).min(moments[2])).sqrt()
}
