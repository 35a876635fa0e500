//! Layer 2: equations of motion and the forces and torques in them; generic over [`crate::math::Real`] for speed.

pub mod actuation;
pub(crate) mod applied;
pub(crate) mod arc_record;
pub mod debris;
pub mod earth_rotation;
pub mod effects;
pub mod environment;
pub mod gravity;
pub mod gyrostat;
pub mod magnetic_field;
pub mod null_space;
pub(crate) mod offset_series;
pub mod orbit;
pub(crate) mod orbit_in_body;
pub mod orbit_path;
pub(crate) mod orbit_series;
pub mod orbit_state;
pub mod relative_orbit;

use crate::math::Real;

#[inline(always)]
pub(crate) fn set_lanes<R: Real, const K: usize>(lanes: &mut [R; K], lane: usize, values: &[f64; K]) {
    for (own, value) in lanes.iter_mut().zip(values) {
        own.set_lane(lane, *value);
    }
}

#[inline(always)]
pub(crate) fn lane_of<R: Real, const K: usize>(lanes: &[R; K], lane: usize) -> [f64; K] {
    let mut values = [0.0; K];
    for (value, own) in values.iter_mut().zip(lanes) {
        *value = own.lane(lane);
    }
    values
}
