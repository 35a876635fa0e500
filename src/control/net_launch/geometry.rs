//! [`LaunchGeometry`]: the spacecraft relative to the state from which a net is launched.
//!
//! Let e be the unit vector of the debris's velocity v_d in F_e and A_d the line along it through the debris's centre
//! of mass. At launch the spacecraft's centre of mass is on A_d, at the distance L behind the debris, at rest relative
//! to it, and s3, the launcher's axis, points at it: position r_d - L e, velocity v_d, s3 = e.
//!
//! On an orbit e turns at omega = v_d x v_d'/|v_d|^2, and the relative velocity is that in the turning frame, v - v_d -
//! omega x (r - r_d), zero for a spacecraft that stays on A_d. Relative motion is that near a circular orbit of this
//! rate (W. H. Clohessy & R. S. Wiltshire, Journal of the Aerospace Sciences 27, 1960); on an ellipse its error is of
//! the order of the eccentricity and left to the loop.

use crate::control::vector::{cross, difference, dot, norm, product, scaled, sum, transposed_product};

/// True or estimated motion of both centres of mass, in F_e.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Centers {
    pub r_co_e: [f64; 3],
    pub v_co_e: [f64; 3],
    pub r_gdo_e: [f64; 3],
    pub v_gdo_e: [f64; 3],
}

/// Definition of the launch state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LaunchState {
    /// Distance L of the spacecraft behind the debris.
    pub distance: f64,
    /// Speed of the debris below which its velocity defines no axis.
    pub least_speed: f64,
    /// Unit vector of the axis in that case, in F_e; zero for none.
    pub approach_axis: [f64; 3],
    /// Gravitational parameter of the central body at the origin, if there is an orbit.
    pub mu: Option<f64>,
}

/// The frame that turns with the debris's velocity along its orbit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TurningFrame {
    /// Unit vectors up, ahead and normal to the orbit, by rows, in F_e.
    pub axes: [[f64; 3]; 3],
    /// Rate about the normal.
    pub rate: f64,
}

/// The spacecraft relative to the launch state, in F_e.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LaunchGeometry {
    /// Unit vector e of the axis A_d; zero if there is neither axis nor station.
    pub axis: [f64; 3],
    /// From the spacecraft to the debris.
    pub to_debris: [f64; 3],
    /// From the station r_d - L e to the spacecraft.
    pub from_station: [f64; 3],
    /// Velocity relative to debris and station; on an orbit, in the turning frame.
    pub relative_velocity: [f64; 3],
    /// The turning frame on an orbit.
    pub frame: Option<TurningFrame>,
}

impl TurningFrame {
    /// The frame of debris at `r_e` with the velocity `v_e`, F_e.
    fn of(mu: f64, r_e: [f64; 3], v_e: [f64; 3]) -> Self {
        let distance = norm(r_e);
        let pull = scaled(-mu / (distance * distance * distance), r_e);
        let turn = scaled(1.0 / dot(v_e, v_e), cross(v_e, pull));
        let rate = norm(turn);
        let (up, normal) = (scaled(1.0 / distance, r_e), scaled(1.0 / rate, turn));
        TurningFrame { axes: [up, cross(normal, up), normal], rate }
    }

    /// Its angular velocity, F_e.
    pub fn turn(&self) -> [f64; 3] {
        scaled(self.rate, self.axes[2])
    }

    /// Derivative in F_e of a vector with the derivative `change` in this frame.
    fn inertial_change(&self, vector: [f64; 3], change: [f64; 3]) -> [f64; 3] {
        sum(change, cross(self.turn(), vector))
    }

    /// Free acceleration at `position` and `velocity` relative to the debris in this frame, components in F_e: Clohessy
    /// & Wiltshire's x'' = 3 n^2 x + 2 n y', y'' = -2 n x', z'' = -n^2 z.
    fn acceleration(&self, position: [f64; 3], velocity: [f64; 3]) -> [f64; 3] {
        let ([x, _, z], [u, v, _]) = (product(self.axes, position), product(self.axes, velocity));
        let n = self.rate;
        transposed_product(self.axes, [n * (3.0 * n * x + 2.0 * v), -2.0 * n * u, -n * n * z])
    }

    /// The velocity that leads from `position` to the origin in `time` seconds, in closed form.
    fn velocity_to_origin(&self, position: [f64; 3], time: f64) -> [f64; 3] {
        let (n, [x, y, z]) = (self.rate, product(self.axes, position));
        let (sin, cos) = libm::sincos(n * time);
        let half = libm::sin(0.5 * n * time);
        // 1 - cos without cancellation
        let (s, d) = (sin / n, 4.0 * half * half / n);
        let along = 4.0 * s - 3.0 * time;
        let (a, b) = (-(4.0 - 3.0 * cos) * x, -y - 6.0 * (sin - n * time) * x);
        let determinant = s * along + d * d;
        transposed_product(self.axes, [(a * along - d * b) / determinant, (s * b + d * a) / determinant, -z * cos / s])
    }
}

impl LaunchState {
    /// The axis A_d for the debris velocity `v_gdo_e` (F_e), if it is defined.
    pub fn axis(&self, v_gdo_e: [f64; 3]) -> Option<[f64; 3]> {
        let speed = norm(v_gdo_e);
        if speed >= self.least_speed && speed > 0.0 {
            return Some(scaled(1.0 / speed, v_gdo_e));
        }
        (self.approach_axis != [0.0; 3]).then_some(self.approach_axis)
    }

    pub fn geometry(&self, centers: &Centers) -> LaunchGeometry {
        let axis = self.axis(centers.v_gdo_e).unwrap_or([0.0; 3]);
        let to_debris = difference(centers.r_gdo_e, centers.r_co_e);
        let frame = self.mu.map(|mu| TurningFrame::of(mu, centers.r_gdo_e, centers.v_gdo_e));
        let inertial = difference(centers.v_co_e, centers.v_gdo_e);
        LaunchGeometry {
            axis,
            to_debris,
            from_station: difference(scaled(self.distance, axis), to_debris),
            relative_velocity: frame.map_or(inertial, |frame| sum(inertial, cross(frame.turn(), to_debris))),
            frame,
        }
    }
}

impl LaunchGeometry {
    pub fn has_axis(&self) -> bool {
        self.axis != [0.0; 3]
    }

    /// Angular velocity of axis and station, F_e; zero without an orbit.
    pub fn turn(&self) -> [f64; 3] {
        self.frame.map_or([0.0; 3], |frame| frame.turn())
    }

    /// Derivative in F_e of a vector with the derivative `change` relative to axis and station.
    pub fn inertial_change(&self, vector: [f64; 3], change: [f64; 3]) -> [f64; 3] {
        self.frame.map_or(change, |frame| frame.inertial_change(vector, change))
    }

    /// Free relative acceleration in the frame of the relative velocity, F_e; zero without gravity.
    pub fn acceleration(&self) -> [f64; 3] {
        self.frame.map_or([0.0; 3], |frame| frame.acceleration(self.from_station, self.relative_velocity))
    }

    /// Velocity change that leads to the station in `time` > 0 seconds: the first of two impulses, of which the second
    /// stops there.
    pub fn transfer(&self, time: f64) -> [f64; 3] {
        self.transfer_of(self.from_station, self.relative_velocity, time)
    }

    /// Its derivative without thrust at a constant transfer time; it is linear in position and velocity.
    pub fn change_of_transfer(&self, time: f64) -> [f64; 3] {
        self.transfer_of(self.relative_velocity, self.acceleration(), time)
    }

    fn transfer_of(&self, from_station: [f64; 3], relative_velocity: [f64; 3], time: f64) -> [f64; 3] {
        let wanted = match &self.frame {
            None => scaled(-1.0 / time, from_station),
            Some(frame) => frame.velocity_to_origin(from_station, time),
        };
        difference(wanted, relative_velocity)
    }

    /// Distance of the spacecraft from the line A_d; NaN without one, like the errors below.
    pub fn axis_offset(&self) -> f64 {
        if !self.has_axis() {
            return f64::NAN;
        }
        let along = scaled(dot(self.to_debris, self.axis), self.axis);
        norm(difference(self.to_debris, along))
    }

    /// Distance behind the debris along A_d, less the wanted one.
    pub fn distance_error(&self) -> f64 {
        if self.has_axis() { -dot(self.from_station, self.axis) } else { f64::NAN }
    }

    /// Distance from the station.
    pub fn position_error(&self) -> f64 {
        if self.has_axis() { norm(self.from_station) } else { f64::NAN }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STATE: LaunchState = LaunchState { distance: 10.0, least_speed: 0.01, approach_axis: [0.0; 3], mu: None };

    const MU: f64 = 3.986004418e14;

    /// Spacecraft and debris on a circle of 7,000 km, with position (up, ahead, normal) and velocity relative to the
    /// debris in the turning frame.
    fn beside_a_circle(position: [f64; 3], velocity: [f64; 3]) -> (Centers, LaunchGeometry) {
        let (r, n) = (7e6_f64, (MU / 7e6_f64.powi(3)).sqrt());
        let (r_gdo_e, v_gdo_e) = ([r, 0.0, 0.0], [0.0, r * n, 0.0]);
        let inertial = sum(velocity, cross([0.0, 0.0, n], position));
        let centers = Centers { r_co_e: sum(r_gdo_e, position), v_co_e: sum(v_gdo_e, inertial), r_gdo_e, v_gdo_e };
        (centers, LaunchState { mu: Some(MU), ..STATE }.geometry(&centers))
    }

    /// The centres after `time` seconds on their two-body orbits.
    fn later(centers: &Centers, time: f64) -> Centers {
        let fall = |position, velocity| {
            let orbit = crate::scene::Orbit { mu: MU, position, velocity, body_radius: 0.0, j2: None, epoch: None };
            let state = crate::dynamics::orbit::KeplerOrbit::new(&orbit).state(time);
            (state.position, state.velocity)
        };
        let (r_co_e, v_co_e) = fall(centers.r_co_e, centers.v_co_e);
        let (r_gdo_e, v_gdo_e) = fall(centers.r_gdo_e, centers.v_gdo_e);
        Centers { r_co_e, v_co_e, r_gdo_e, v_gdo_e }
    }

    /// Law: a spacecraft at rest behind the debris on its orbit is at the station and stays there.
    #[test]
    fn the_station_turns_with_the_orbit() {
        let (centers, there) = beside_a_circle([0.0, -10.0, 0.0], [0.0; 3]);
        assert!(there.position_error() < 1e-8 && norm(there.relative_velocity) < 1e-11, "{there:?}");
        let state = LaunchState { mu: Some(MU), ..STATE };
        let after = state.geometry(&later(&centers, 1500.0));
        // the line is tangent to the circle: ten metres back it is 7 micrometres above
        assert!(after.position_error() < 1e-3 && norm(after.relative_velocity) < 1e-6, "{after:?}");
        // not at rest without the turning frame
        let flat = LaunchState { mu: None, ..state }.geometry(&centers);
        assert!(norm(flat.relative_velocity) > 0.01);
    }

    /// Law: the first impulse of a transfer leads to the station along two Kepler orbits, up to second-order terms that
    /// Clohessy & Wiltshire neglect (50^2 m/7000 km); without orbital terms it misses by metres.
    #[test]
    fn the_transfer_leads_to_the_station() {
        for (position, velocity) in
            [([8.0, -45.0, 5.0], [0.03, 0.02, -0.01]), ([-20.0, 10.0, -15.0], [-0.02, 0.01, 0.05])]
        {
            let (centers, start) = beside_a_circle(position, velocity);
            for time in [60.0, 300.0, 900.0] {
                let state = LaunchState { mu: Some(MU), ..STATE };
                let pushed = Centers { v_co_e: sum(centers.v_co_e, start.transfer(time)), ..centers };
                let end = state.geometry(&later(&pushed, time));
                assert!(end.position_error() < 3e-3, "{time}: {} m", end.position_error());
                let straight = LaunchGeometry { frame: None, ..start }.transfer(time);
                let pushed = Centers { v_co_e: sum(centers.v_co_e, straight), ..centers };
                let missed = state.geometry(&later(&pushed, time)).position_error();
                assert!(time < 300.0 || missed > 1.0, "{time}: {missed} m");
            }
        }
    }

    /// Law: acceleration and change of the transfer are the derivatives of velocity and transfer along two Kepler
    /// orbits.
    #[test]
    fn what_changes_without_thrust_is_known() {
        let (centers, start) = beside_a_circle([8.0, -45.0, 5.0], [0.03, 0.02, -0.01]);
        let state = LaunchState { mu: Some(MU), ..STATE };
        let slope = |of: &dyn Fn(&LaunchGeometry) -> [f64; 3]| {
            let [before, after] = [-2.0, 2.0].map(|time| of(&state.geometry(&later(&centers, time))));
            scaled(0.25, difference(after, before))
        };
        for (found, expected) in [
            (start.inertial_change(start.relative_velocity, start.acceleration()), slope(&|at| at.relative_velocity)),
            (
                start.inertial_change(start.transfer(300.0), start.change_of_transfer(300.0)),
                slope(&|at| at.transfer(300.0)),
            ),
        ] {
            // rounding of 7000 km in the slope
            assert!(norm(difference(found, expected)) < 1e-8, "{found:?} {expected:?}");
            assert!(norm(found) > 1e-5);
        }
    }
}
