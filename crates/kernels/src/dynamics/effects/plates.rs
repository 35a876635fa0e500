//! [`PlatesInLanes`]: the plates of a spacecraft, one run per lane, in the frame B of the equations.
//!
//! The switch function of a plate is the cosine of its normal to the incoming direction. If steps end at switches, the
//! chosen side is frozen.

use crate::math::prelude::*;
use crate::math::symmetric::principal_axes;
use crate::scene::{MAX_PLATES, Plate, Scene};

/// Plates with `K` numbers each; lanes with fewer plates are padded with zero areas.
#[derive(Clone, Copy, Debug)]
pub struct PlatesInLanes<R, const K: usize> {
    plates: [PlateInLanes<R, K>; MAX_PLATES],
    count: usize,
}

#[derive(Clone, Copy, Debug)]
pub struct PlateInLanes<R, const K: usize> {
    /// Outward unit normal, B.
    pub normal: [R; 3],
    /// Centre from the centre of mass, B, m.
    pub arm: [R; 3],
    /// Normal x arm, m.
    pub twist: [R; 3],
    /// Numbers of the effect, times the plate's area.
    pub numbers: [R; K],
    /// Lower and upper limit of the effective cosine: [0, inf] until a side is chosen, then [-inf, inf] or [0, 0].
    limits: [R; 2],
}

impl<R: Real, const K: usize> PlatesInLanes<R, K> {
    pub fn none(zero: R) -> Self {
        let limits = [zero, zero.splat(f64::INFINITY)];
        let none = [zero; 3];
        let plate = PlateInLanes { normal: none, arm: none, twist: none, numbers: [zero; K], limits };
        PlatesInLanes { plates: [plate; MAX_PLATES], count: 0 }
    }

    /// The plates of `scene` in the frame B, which `c_sb` maps to F_s.
    pub fn of(zero: R, scene: &Scene, c_sb: Option<[[R; 3]; 3]>, numbers: impl Fn(&Plate) -> [f64; K]) -> Self {
        let mut plates = Self::none(zero);
        let into_b = |v: [f64; 3]| c_sb.map_or(constant(zero, v), |c_sb| transposed_product(c_sb, constant(zero, v)));
        for (own, plate) in plates.plates.iter_mut().zip(&scene.plates) {
            own.normal = into_b(plate.normal);
            own.arm = into_b(difference(plate.center, scene.mass.center));
            own.twist = cross(own.normal, own.arm);
            own.numbers = numbers(plate).map(|number| zero.splat(number) * zero.splat(plate.area));
        }
        plates.count = scene.plates.len().min(MAX_PLATES);
        plates
    }

    pub fn set_lane(&mut self, lane: usize, own: &PlatesInLanes<f64, K>) {
        self.count = self.count.max(own.count);
        for (plate, own) in self.plates[..self.count].iter_mut().zip(&own.plates) {
            set_lanes(&mut plate.normal, lane, &own.normal);
            set_lanes(&mut plate.arm, lane, &own.arm);
            set_lanes(&mut plate.twist, lane, &own.twist);
            set_lanes(&mut plate.numbers, lane, &own.numbers);
            set_lanes(&mut plate.limits, lane, &own.limits);
        }
    }

    /// Chooses the side of each plate in the lanes `lanes` for a flow from `direction`.
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

    /// Calls `visit` with the switch function of each plate at `M` unit vectors.
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

    #[inline(always)]
    pub fn iter(&self) -> impl Iterator<Item = &PlateInLanes<R, K>> {
        self.plates[..self.count].iter()
    }
}

impl<R: Real, const K: usize> PlateInLanes<R, K> {
    /// Effective cosine between the normal and the unit vector `direction`: zero if the plate faces away; the cosine
    /// itself, or zero, on a chosen side.
    #[inline(always)]
    pub fn facing(&self, direction: [R; 3]) -> R {
        dot(self.normal, direction).larger(self.limits[0]).smaller(self.limits[1])
    }
}

/// sum + weight v.
#[inline(always)]
pub fn sum_of<R: Real>(mut sum: [R; 3], weight: R, v: [R; 3]) -> [R; 3] {
    for i in 0..3 {
        sum[i] = weight.mul_add(v[i], sum[i]);
    }
    sum
}

/// Sum over the plates of `weight` times area times distance from the centre of mass, m^3.
pub fn largest_lever(scene: &Scene, weight: impl Fn(&Plate) -> f64) -> f64 {
    let of = |plate: &Plate| weight(plate) * plate.area * norm(difference(plate.center, scene.mass.center));
    scene.plates.iter().map(of).sum()
}

/// Rate of oscillation of `scene` under a torque of `largest` N m that changes over one radian, rad/s: sqrt(torque/J)
/// for the smallest moment.
pub(super) fn largest_rate(scene: &Scene, largest: f64) -> f64 {
    if largest == 0.0 {
        return 0.0;
    }
    let (moments, _) = principal_axes(scene.mass.inertia);
    (largest / moments[0].min(moments[1]).min(moments[2])).sqrt()
}
