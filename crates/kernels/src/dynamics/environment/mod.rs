//! Surroundings of a spacecraft on an Earth orbit: [`air`], direction of the [`sun`], the Earth's [`shadow`], and
//! [`light`].
//!
//! In F_e the third axis is the Earth's axis of rotation, the first points to the mean equinox of date. Functions
//! beyond [`Real`] operations are evaluated lane by lane, so that a lane has the bits of a scalar.

pub mod air;
pub mod light;
pub mod shadow;
pub mod sun;

use crate::math::Real;

/// Rotation rate of the Earth, rad/s (IERS Conventions 2010, table 1.2: nominal mean).
pub const EARTH_RATE: f64 = 7.292115e-5;

#[inline(always)]
fn each_lane<R: Real, const K: usize>(numbers: [R; K], f: impl Fn(usize, [f64; K]) -> f64) -> R {
    let mut results = numbers[0];
    for lane in 0..R::LANES {
        results.set_lane(lane, f(lane, numbers.map(|number| number.lane(lane))));
    }
    results
}
