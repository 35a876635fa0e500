//! [`KeplerOrbit`]: position and velocity on a two-body orbit in closed form.
//!
//! With the eccentric anomaly E and its change x = E - E0 since time zero (R. Battin, *An Introduction to the
//! Mathematics and Methods of Astrodynamics*, 1999, section 4.3):
//!
//! ```text
//! r = F r0 + G v0,  v = F' r0 + G' v0,   |r| = a + (|r0| - a) cos x + sigma sqrt(a) sin x,   sigma = r0 . v0/sqrt(mu)
//! F = 1 - a/|r0| (1 - cos x),   sqrt(mu) G = a sigma (1 - cos x) + |r0| sqrt(a) sin x
//! F' = -sqrt(mu a)/(|r| |r0|) sin x,   G' = 1 - a/|r| (1 - cos x)
//! ```
//!
//! Circles are no special case, since no direction of a periapsis appears. E solves E - e sin E = M, M = M0 + 2 pi t/P,
//! in turns reduced to half a turn. About a flattened body this is the osculating orbit at time zero.

use super::gravity::Gravity;
use super::orbit_state::OrbitState;
use crate::math::prelude::*;
use crate::math::sine::sin_cos_turns;
use crate::math::{Mask, Real};
use crate::scene::Orbit;

/// Convergence of Newton's method: the last correction of E, rad. The next one is e/(2 (1 - e)) times its square.
const CONVERGED: f64 = 1e-9;

/// Limit of corrections; up to e = 0.999 there are at most 9.
const MOST_CORRECTIONS: usize = 30;

/// Danby's initial guess, E = M + 0.85 e sign(sin M) (J. M. A. Danby, *Fundamentals of Celestial Mechanics*, 1988,
/// section 6.6).
const START: f64 = 0.85;

/// Eccentricities below this are those of circles, computed from their positions and velocities.
const CIRCLE: f64 = 4.0 * f64::EPSILON;

/// Defines the orbit with its scalars, which are treated alike.
macro_rules! kepler_orbit {
    ($($(#[$doc:meta])* $scalar:ident,)*) => {
        /// A two-body orbit, one run per lane.
        #[derive(Clone, Copy, Debug)]
        pub struct KeplerOrbit<R> {
            /// Position at time zero, F_e, m.
            position: [R; 3],
            /// Velocity at time zero, F_e, m/s.
            velocity: [R; 3],
            gravity: Gravity<R>,
            $($(#[$doc])* $scalar: R,)*
        }

        impl<R: Real> KeplerOrbit<R> {
            /// Copies `orbit` into lane `lane`.
            pub fn set_lane(&mut self, lane: usize, orbit: &KeplerOrbit<f64>) {
                set_lanes(&mut self.position, lane, &orbit.position);
                set_lanes(&mut self.velocity, lane, &orbit.velocity);
                self.gravity.set_lane(lane, &orbit.gravity);
                $(self.$scalar.set_lane(lane, orbit.$scalar);)*
            }
        }

        impl KeplerOrbit<f64> {
            /// Broadcasts to all lanes of `zero`.
            #[inline(always)]
            pub fn in_lanes<R: Real>(&self, zero: R) -> KeplerOrbit<R> {
                KeplerOrbit {
                    position: constant(zero, self.position),
                    velocity: constant(zero, self.velocity),
                    gravity: self.gravity.in_lanes(zero),
                    $($scalar: zero.splat(self.$scalar),)*
                }
            }
        }
    };
}

kepler_orbit! {
    eccentricity,
    /// E and M at time zero, turns.
    eccentric,
    mean,
    /// One over the period, 1/s.
    per_period,
    /// a and a/|r0|, m and 1.
    axis,
    ratio,
    /// |r0| - a and sigma sqrt(a), m.
    cosine,
    sine,
    /// a sigma/sqrt(mu) and |r0| sqrt(a/mu), s.
    level,
    rise,
    /// sqrt(mu a)/|r0|, m/s.
    fall,
    /// |r0|, m, and mu/|r0|, m^2/s^2.
    start,
    pull,
}

impl KeplerOrbit<f64> {
    /// The orbit of a scene.
    pub fn new(orbit: &Orbit) -> Self {
        let Orbit { mu, position, velocity, .. } = *orbit;
        let gravity = Gravity::of(orbit);
        let distance = norm(position);
        let axis = 1.0 / (2.0 / distance - dot(velocity, velocity) / mu);
        let sigma = dot(position, velocity) / mu.sqrt();
        let (cosine, sine) = (distance - axis, sigma * axis.sqrt());
        // e cos E0 and e sin E0
        let (along, across) = (-cosine / axis, sine / axis);
        let eccentric = libm::atan2(across, along);
        let turns = 1.0 / core::f64::consts::TAU;
        KeplerOrbit {
            position,
            velocity,
            eccentricity: libm::sqrt(along * along + across * across),
            eccentric: eccentric * turns,
            mean: (eccentric - across) * turns,
            per_period: (mu / axis).sqrt() / axis * turns,
            axis,
            ratio: axis / distance,
            cosine,
            sine,
            level: axis * sigma / mu.sqrt(),
            rise: distance * (axis / mu).sqrt(),
            gravity,
            fall: (mu * axis).sqrt() / distance,
            start: distance,
            pull: mu / distance,
        }
    }

    /// Upper bound of the angular rate, rad/s: that of a circle at periapsis.
    pub fn rate(&self) -> f64 {
        let lowest = self.axis * (1.0 - self.eccentricity);
        (self.gravity.mu / lowest).sqrt() / lowest
    }

    /// Angular speed at the periapsis, rad/s.
    pub fn fastest(&self) -> f64 {
        self.rate() * (1.0 + self.eccentricity).sqrt()
    }

    /// Upper bounds of speed and radial speed, m/s.
    pub fn speeds(&self) -> [f64; 2] {
        let speed = self.fastest() * self.axis * (1.0 - self.eccentricity);
        [speed, speed * self.eccentricity]
    }

    /// Any circle, for empty lanes.
    pub fn blank() -> Self {
        KeplerOrbit::new(&Orbit {
            mu: 1.0,
            position: [1.0, 0.0, 0.0],
            velocity: [0.0, 1.0, 0.0],
            body_radius: 0.0,
            j2: None,
            epoch: None,
        })
    }
}

impl<R: Real> KeplerOrbit<R> {
    /// The gravity of the central body.
    #[inline(always)]
    pub fn gravity(&self) -> Gravity<R> {
        self.gravity
    }

    /// Position (F_e, m) and velocity (m/s) at time zero.
    #[inline(always)]
    pub fn start(&self) -> [[R; 3]; 2] {
        [self.position, self.velocity]
    }

    /// One in lanes whose orbit is a circle, else zero.
    #[inline(always)]
    pub fn circle(&self) -> R {
        self.eccentricity.indicator(self.eccentricity.lt(self.eccentricity.splat(CIRCLE)))
    }

    /// The state at `time`, s.
    #[inline(always)]
    pub fn state(&self, time: R) -> OrbitState<R> {
        self.state_at([time, time.zero()])
    }

    /// The state at a sum of two times, s: a single one rounds the position to 1e-12 rad after 1,000 orbits.
    #[inline(always)]
    pub fn state_at(&self, [time, low]: [R; 2]) -> OrbitState<R> {
        let one = time.splat(1.0);
        let turns = self.eccentric_anomaly([time, low]) - self.eccentric;
        let (sin, cos) = sin_cos_turns(turns - turns.nearest_integer());
        let fallen = one - cos;
        let distance = self.sine.mul_add(sin, self.cosine.mul_add(cos, self.axis));
        let f = self.ratio.neg_mul_add(fallen, one);
        let g = self.level.mul_add(fallen, self.rise * sin);
        let f_rate = -(self.fall / distance * sin);
        let g_rate = (self.axis / distance).neg_mul_add(fallen, one);
        OrbitState {
            position: sum(scaled(f, self.position), scaled(g, self.velocity)),
            velocity: sum(scaled(f_rate, self.position), scaled(g_rate, self.velocity)),
            distance,
        }
    }

    /// Work of a point mass on 1 kg from time zero to the distance `distance`, mu/|r| - mu/|r0|, J.
    #[inline(always)]
    pub fn work(&self, distance: R) -> R {
        self.pull * ((self.start - distance) / distance)
    }

    /// E at `time + low`, turns, by Newton's method; each lane is frozen when it converges.
    #[inline(always)]
    fn eccentric_anomaly(&self, [time, low]: [R; 2]) -> R {
        let number = |value: f64| time.splat(value);
        let e = self.eccentricity;
        // whole turns go before the product is rounded: 7e-13 rad after 1,000 periods
        let whole = (time * self.per_period).nearest_integer();
        let mean = time.mul_add(self.per_period, -whole) + low.mul_add(self.per_period, self.mean);
        let mean = mean - mean.nearest_integer();
        let ahead = e * number(START / core::f64::consts::TAU);
        let mut found = mean + R::select(mean.lt(time.zero()), -ahead, ahead);
        let mut open = !time.never();
        for _ in 0..MOST_CORRECTIONS {
            let (sin, cos) = sin_cos_turns(found - found.nearest_integer());
            // in turns: E - e sin E/(2 pi) - M
            let off = (found - mean) - e * sin * number(1.0 / core::f64::consts::TAU);
            let correction = off / e.neg_mul_add(cos, number(1.0));
            found = R::select(open, found - correction, found);
            open = open & number(CONVERGED / core::f64::consts::TAU).lt(correction.abs());
            if !open.any() {
                break;
            }
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MU: f64 = 3.986004418e14;

    fn orbit(radius: f64, speed: f64, radial: f64) -> Orbit {
        let circular = (MU / radius).sqrt();
        let velocity = [radial * circular, speed * circular * 0.6, speed * circular * 0.8];
        Orbit { mu: MU, position: [radius, 0.0, 0.0], velocity, body_radius: 0.0, j2: None, epoch: None }
    }

    /// Law: energy and angular momentum are constant, and the state repeats after a period, up to an eccentricity of
    /// 0.98.
    #[test]
    fn the_constants_of_the_orbit_are_constant() {
        for (speed, radial) in
            [(1.0, 0.0), (1.0, 1e-9), (1.1, 0.0), (0.8, 0.3), (1.25, -0.2), (1.405, 0.0), (0.9, 1.05)]
        {
            let scene = orbit(7e6, speed, radial);
            let kepler = KeplerOrbit::new(&scene);
            let shape = scene.shape();
            assert!(shape.eccentricity < 0.99, "{shape:?}");
            let energy =
                |state: &OrbitState<f64>| 0.5 * dot(state.velocity, state.velocity) - MU / norm(state.position);
            let momentum = |state: &OrbitState<f64>| cross(state.position, state.velocity);
            let first = OrbitState { position: scene.position, velocity: scene.velocity, distance: 7e6 };
            let period = 1.0 / kepler.per_period;
            // a few roundings of F, G and their rates, which cancel near the periapsis of a long ellipse
            let rounding = 1e-15 * (1.0 + 1.0 / (1.0 - shape.eccentricity));
            for k in 0..=200 {
                let time = f64::from(k) * 0.017 * period;
                let state = kepler.state(time);
                let size = 0.5 * dot(state.velocity, state.velocity) + MU / state.distance;
                assert!((energy(&state) - energy(&first)).abs() < rounding * size, "{speed} {radial} at {time}");
                let off = norm(difference(momentum(&state), momentum(&first)));
                assert!(off < rounding * norm(state.position) * norm(state.velocity), "{speed} {radial} at {time}");
                assert!((norm(state.position) / state.distance - 1.0).abs() < 1e-14, "{speed} {radial} at {time}");
                let later = kepler.state(time + period);
                // the position after a period depends on the rounding of the time, at the speed of the orbit
                let moved = norm(difference(later.position, state.position)) / norm(state.velocity);
                assert!(moved < 1e-13 * period, "{speed} {radial} at {time}: {moved}");
            }
        }
    }
}
