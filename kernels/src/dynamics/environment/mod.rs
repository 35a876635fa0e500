//! What surrounds a spacecraft on an orbit about the Earth: [`air`] and its density, the direction of the [`sun`], and
//! the Earth's [`shadow`].
//!
//! In F_e the third axis is the Earth's axis of rotation, and the first points to the mean equinox of date. Each file
//! works on numbers of any kind; functions that are not made of [`Real`] operations alone are evaluated lane by lane,
//! so that a lane has the bits of a scalar, and more digits than those of `f64` are not to be had from them.
//!
//! Not here: the torques of air and light ([`super::effects`]).

pub mod air;
pub mod shadow;
pub mod sun;

use crate::math::Real;

/// Angular velocity of the Earth's rotation, rad/s (IERS Conventions 2010, table 1.2: nominal mean).
pub const EARTH_RATE: f64 = 7.292115e-5;

/// `f` of every lane and its numbers.
#[inline(always)]
fn each_lane<R: Real, const K: usize>(numbers: [R; K], f: impl Fn(usize, [f64; K]) -> f64) -> R {
    let mut results = numbers[0];
    for lane in 0..R::LANES {
        results.set_lane(lane, f(lane, numbers.map(|number| number.lane(lane))));
    }
    results
}
