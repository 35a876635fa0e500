//! The true state at the launch of a net, and plumes that hit the debris before.

use crate::control::truth::Truth;
use crate::loops::launch_geometry::LaunchState;
use crate::loops::launch_numbers::DebrisNumbers;
use crate::loops::vector::{cross, dcm_from_quaternion, difference, dot, norm, product, scaled};
use crate::scene::{MAX_THRUSTERS, Scene};

/// By the meanings of its columns.
#[derive(Clone, Copy, Debug)]
pub struct AtLaunch {
    pub pointing_error: f64,
    pub axis_offset: f64,
    pub distance_error: f64,
    pub relative_speed: f64,
    pub body_rate: f64,
    /// NaN if the debris does not rotate.
    pub momentum_angle: f64,
    pub speed_margin: f64,
}

/// True if the plume of a thruster that fires at `thrust` hits the debris, within range and cone.
pub fn plume_hits(numbers: &DebrisNumbers, scene: &Scene, truth: &Truth, thrust: &[f64; MAX_THRUSTERS]) -> bool {
    let Some(debris) = &truth.debris else { return false };
    let to_debris = difference(debris.r_gdo_e, truth.body.r_co_e);
    let c_es = dcm_from_quaternion(truth.body.q_es);
    let mut firing = scene.thrusters.iter().zip(thrust).filter(|(_, thrust)| **thrust > 0.0);
    norm(to_debris) < numbers.plume_range
        && firing.any(|(thruster, _)| {
            let plume = scaled(-1.0, product(c_es, thruster.direction));
            angle_between(plume, to_debris) < numbers.plume_half_angle
        })
}

fn angle_between(a: [f64; 3], b: [f64; 3]) -> f64 {
    libm::atan2(norm(cross(a, b)), dot(a, b))
}

impl AtLaunch {
    /// The state `truth` relative to the launch state `launch`; `None` without debris.
    pub fn of(scene: &Scene, truth: &Truth, launch: &LaunchState) -> Option<AtLaunch> {
        let geometry = launch.geometry(truth.state().centers()?);
        let (body, debris) = (scene.mass.debris.as_ref()?, truth.debris.as_ref()?);
        let s3 = product(dcm_from_quaternion(truth.body.q_es), [0.0, 0.0, 1.0]);
        let momentum = product(dcm_from_quaternion(debris.q_ed), product(body.inertia, debris.omega_de_d));
        let margin = |(i, model): (usize, &crate::scene::WheelModel)| model.speed_limit - truth.wheel_rates[i].abs();
        let wheels = scene.actuators.wheels[..scene.mass.wheels.len()].iter().enumerate();
        Some(AtLaunch {
            pointing_error: angle_between(s3, geometry.to_debris),
            axis_offset: geometry.axis_offset(),
            distance_error: geometry.distance_error(),
            relative_speed: norm(geometry.relative_velocity),
            body_rate: norm(truth.body.omega_se_s),
            // a line has no sign: 0 to pi/2
            momentum_angle: {
                let angle = angle_between(momentum, geometry.axis);
                if momentum == [0.0; 3] { f64::NAN } else { angle.min(core::f64::consts::PI - angle) }
            },
            speed_margin: wheels.map(margin).fold(f64::INFINITY, f64::min),
        })
    }
}
