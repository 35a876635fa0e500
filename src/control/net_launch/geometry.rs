//! [`LaunchGeometry`]: where the spacecraft is relative to the state from which a net is launched.
//!
//! Let v_d be the velocity of the debris in F_e and A_d the line through its centre of mass along v_d. At the launch state the spacecraft's centre of mass
//! is on A_d behind the debris (on the side of -v_d) at a constant distance L, at rest relative to the debris, and s3, the axis of the net launcher, points
//! at it: with e the unit vector of v_d, position r_d - L e, velocity v_d, s3 = e.

use crate::control::vector::{difference, dot, norm, scaled, sum};

/// The centres of mass of spacecraft and debris, as they are or as they are estimated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Centers {
    /// Position of the spacecraft's centre of mass in F_e, m.
    pub r_co_e: [f64; 3],
    /// Its velocity relative to F_e, in F_e, m/s.
    pub v_co_e: [f64; 3],
    /// Position of the debris in F_e, m.
    pub r_gdo_e: [f64; 3],
    /// Its velocity relative to F_e, in F_e, m/s.
    pub v_gdo_e: [f64; 3],
}

/// How the launch state is defined.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LaunchState {
    /// Distance L of the spacecraft behind the debris, m.
    pub distance: f64,
    /// Speed of the debris below which its velocity has no direction, m/s.
    pub least_speed: f64,
    /// The unit vector that is the axis then, in F_e; zero where there is none.
    pub approach_axis: [f64; 3],
}

/// The spacecraft relative to the launch state, in F_e.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LaunchGeometry {
    /// The unit vector e of the axis A_d; zero where there is none, and then no station either.
    pub axis: [f64; 3],
    /// From the spacecraft to the debris, m.
    pub to_debris: [f64; 3],
    /// From the station r_d - L e to the spacecraft, m.
    pub from_station: [f64; 3],
    /// Velocity relative to the debris, and so to the station, m/s.
    pub relative_velocity: [f64; 3],
}

impl LaunchState {
    /// The axis A_d of debris with the velocity `v_gdo_e` (m/s, F_e); `None` where it is too slow and the file names no other.
    pub fn axis(&self, v_gdo_e: [f64; 3]) -> Option<[f64; 3]> {
        let speed = norm(v_gdo_e);
        if speed >= self.least_speed && speed > 0.0 {
            return Some(scaled(1.0 / speed, v_gdo_e));
        }
        (self.approach_axis != [0.0; 3]).then_some(self.approach_axis)
    }

    /// Where `centers` are relative to the launch state.
    pub fn geometry(&self, centers: &Centers) -> LaunchGeometry {
        let axis = self.axis(centers.v_gdo_e).unwrap_or([0.0; 3]);
        let to_debris = difference(centers.r_gdo_e, centers.r_co_e);
        LaunchGeometry {
            axis,
            to_debris,
            from_station: difference(scaled(self.distance, axis), to_debris),
            relative_velocity: difference(centers.v_co_e, centers.v_gdo_e),
        }
    }
}

impl LaunchGeometry {
    /// Whether there is an axis.
    pub fn has_axis(&self) -> bool {
        self.axis != [0.0; 3]
    }

    /// Distance of the spacecraft from the line A_d, m; NaN without one, as the errors below.
    pub fn axis_offset(&self) -> f64 {
        if !self.has_axis() {
            return f64::NAN;
        }
        let along = scaled(dot(self.to_debris, self.axis), self.axis);
        norm(difference(self.to_debris, along))
    }

    /// Distance behind the debris along A_d, less the wanted one, m.
    pub fn distance_error(&self) -> f64 {
        if self.has_axis() { -dot(self.from_station, self.axis) } else { f64::NAN }
    }

    /// Distance from the station, m.
    pub fn position_error(&self) -> f64 {
        if self.has_axis() { norm(self.from_station) } else { f64::NAN }
    }
}

/// The relative acceleration of spacecraft and debris without thrust at the relative position and velocity, m/s^2: none, without gravity. An orbit replaces
/// this function, and what follows from it below.
pub fn relative_acceleration(_relative_position: [f64; 3], _relative_velocity: [f64; 3]) -> [f64; 3] {
    [0.0; 3]
}

/// The change of velocity at which a spacecraft at `from_station` with `relative_velocity` reaches the station in `time` > 0 seconds, under
/// [`relative_acceleration`]: the first of two impulses (the second stops it there), m/s.
pub fn transfer(from_station: [f64; 3], relative_velocity: [f64; 3], time: f64) -> [f64; 3] {
    let drift = scaled(0.5 * time, relative_acceleration(from_station, relative_velocity));
    difference(scaled(-1.0 / time, from_station), sum(relative_velocity, drift))
}

#[cfg(test)]
mod tests {
    use super::*;

    const STATE: LaunchState = LaunchState { distance: 10.0, least_speed: 0.01, approach_axis: [0.0; 3] };

    /// Law: at the launch state every error is zero; each error measures what its name says.
    #[test]
    fn errors_are_zero_at_the_launch_state() {
        let (velocity, debris) = ([3.0, 0.0, 4.0], [100.0, 20.0, -5.0]);
        let e = [0.6, 0.0, 0.8];
        let station = difference(debris, scaled(10.0, e));
        let at = |r_co_e, v_co_e| STATE.geometry(&Centers { r_co_e, v_co_e, r_gdo_e: debris, v_gdo_e: velocity });
        let there = at(station, velocity);
        assert!(norm(difference(there.axis, e)) < 1e-15);
        assert!(there.position_error() < 1e-13 && there.axis_offset() < 1e-13 && there.distance_error().abs() < 1e-13);
        // two metres to the side, half a metre too far behind
        let off = at(sum(station, sum([0.0, 2.0, 0.0], scaled(-0.5, e))), [3.0, 0.1, 4.0]);
        assert!((off.axis_offset() - 2.0).abs() < 1e-13 && (off.distance_error() - 0.5).abs() < 1e-13);
        assert!((norm(off.relative_velocity) - 0.1).abs() < 1e-15);
        // the first impulse leads to the station
        let time = 50.0;
        let after = sum(off.relative_velocity, transfer(off.from_station, off.relative_velocity, time));
        assert!(norm(sum(off.from_station, scaled(time, after))) < 1e-13);
    }

    /// Law: slow debris has no axis of its own; then it is that of the file, or none.
    #[test]
    fn slow_debris_has_the_axis_of_the_file() {
        assert_eq!(STATE.axis([0.0, 0.009, 0.0]), None);
        let named = LaunchState { approach_axis: [0.0, 0.0, 1.0], ..STATE };
        assert_eq!(named.axis([0.0, 0.009, 0.0]), Some([0.0, 0.0, 1.0]));
        assert_eq!(named.axis([0.0, -0.02, 0.0]), Some([0.0, -1.0, 0.0]));
        let still = LaunchState { least_speed: 0.0, ..STATE };
        assert_eq!(still.axis([0.0; 3]), None);
    }
}
