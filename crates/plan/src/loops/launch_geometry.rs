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

use super::launch_numbers::DebrisNumbers;
use super::measurement::PointMotion;
use super::vector::{cross, difference, dot, norm, product, scaled, sum, transposed_product};
use crate::scene::{DeclaredTable, Orbit};

/// Definition of the launch state.
#[derive(Clone, Copy)]
pub struct LaunchState {
    pub numbers: DebrisNumbers,
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

/// Vectors are in F_e.
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
    /// The launch state by the numbers of `[control]`, on `orbit`.
    pub fn of(table: &DeclaredTable, orbit: Option<&Orbit>) -> Self {
        LaunchState { numbers: DebrisNumbers::of(table), mu: orbit.map(|orbit| orbit.mu) }
    }

    /// The axis A_d for the debris velocity `v_gdo_e` (F_e), if it is defined.
    pub fn axis(&self, v_gdo_e: [f64; 3]) -> Option<[f64; 3]> {
        let DebrisNumbers { least_debris_speed, approach_axis, .. } = self.numbers;
        let speed = norm(v_gdo_e);
        if speed >= least_debris_speed && speed > 0.0 {
            return Some(scaled(1.0 / speed, v_gdo_e));
        }
        let length = norm(approach_axis);
        (length > 0.0).then(|| scaled(1.0 / length, approach_axis))
    }

    /// The geometry for the true or estimated motion of both centres of mass.
    pub fn geometry(&self, [own, debris]: [PointMotion; 2]) -> LaunchGeometry {
        let axis = self.axis(debris.v_e).unwrap_or([0.0; 3]);
        let to_debris = difference(debris.r_e, own.r_e);
        let frame = self.mu.map(|mu| TurningFrame::of(mu, debris.r_e, debris.v_e));
        let inertial = difference(own.v_e, debris.v_e);
        LaunchGeometry {
            axis,
            to_debris,
            from_station: difference(scaled(self.numbers.launch_distance, axis), to_debris),
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
        self.frame.map_or(change, |frame| sum(change, cross(frame.turn(), vector)))
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
        let straight = scaled(-1.0 / time, from_station);
        let wanted = self.frame.map_or(straight, |frame| frame.velocity_to_origin(from_station, time));
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

    const MU: f64 = 3.986004418e14;
    const NUMBERS: DebrisNumbers = DebrisNumbers {
        launch_distance: 10.0,
        least_debris_speed: 0.01,
        approach_axis: [0.0; 3],
        keep_out: 0.0,
        lost_target_timeout: 0.0,
        plume_range: 0.0,
        plume_half_angle: 0.0,
    };
    const STATE: LaunchState = LaunchState { numbers: NUMBERS, mu: Some(MU) };

    /// Spacecraft and debris on a circle of 7,000 km, with position (up, ahead, normal) and velocity relative to the
    /// debris in the turning frame.
    fn beside_a_circle(position: [f64; 3], velocity: [f64; 3]) -> ([PointMotion; 2], LaunchGeometry) {
        let (r, n) = (7e6_f64, (MU / 7e6_f64.powi(3)).sqrt());
        let debris = PointMotion { r_e: [r, 0.0, 0.0], v_e: [0.0, r * n, 0.0] };
        let inertial = sum(velocity, cross([0.0, 0.0, n], position));
        let own = PointMotion { r_e: sum(debris.r_e, position), v_e: sum(debris.v_e, inertial) };
        ([own, debris], STATE.geometry([own, debris]))
    }

    /// The geometry after `time` seconds on two-body orbits.
    fn later(centers: [PointMotion; 2], time: f64) -> LaunchGeometry {
        STATE.geometry(centers.map(|PointMotion { r_e: position, v_e: velocity }| {
            let orbit = Orbit { mu: MU, position, velocity, body_radius: 0.0, j2: None, epoch: None };
            let state = crate::dynamics::orbit::KeplerOrbit::new(&orbit).state(time);
            PointMotion { r_e: state.position, v_e: state.velocity }
        }))
    }

    /// The centres after a push of the spacecraft.
    fn pushed([own, debris]: [PointMotion; 2], by: [f64; 3]) -> [PointMotion; 2] {
        [PointMotion { v_e: sum(own.v_e, by), ..own }, debris]
    }

    /// Law: a spacecraft at rest behind the debris on its orbit is at the station and stays there.
    #[test]
    fn the_station_turns_with_the_orbit() {
        let (centers, there) = beside_a_circle([0.0, -10.0, 0.0], [0.0; 3]);
        assert!(there.position_error() < 1e-8 && norm(there.relative_velocity) < 1e-11, "{there:?}");
        let after = later(centers, 1500.0);
        // the line is tangent to the circle: ten metres back it is 7 micrometres above
        assert!(after.position_error() < 1e-3 && norm(after.relative_velocity) < 1e-6, "{after:?}");
        // not at rest without the turning frame
        let flat = LaunchState { mu: None, ..STATE }.geometry(centers);
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
                let end = later(pushed(centers, start.transfer(time)), time);
                assert!(end.position_error() < 3e-3, "{time}: {} m", end.position_error());
                let straight = LaunchGeometry { frame: None, ..start }.transfer(time);
                let missed = later(pushed(centers, straight), time).position_error();
                assert!(time < 300.0 || missed > 1.0, "{time}: {missed} m");
            }
        }
    }

    /// Law: acceleration and change of the transfer are the derivatives of velocity and transfer along two Kepler
    /// orbits.
    #[test]
    fn what_changes_without_thrust_is_known() {
        let (centers, start) = beside_a_circle([8.0, -45.0, 5.0], [0.03, 0.02, -0.01]);
        let slope = |of: &dyn Fn(&LaunchGeometry) -> [f64; 3]| {
            let [before, after] = [-2.0, 2.0].map(|time| of(&later(centers, time)));
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
