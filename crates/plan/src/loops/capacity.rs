//! [`Capacity`]: the axes about which a loop has torque in both directions, and the nominal momentum that its wheels
//! can store and its thrusters unload.

use super::observes::Observes;
use super::sensor_spec::SensorSpec;
use super::spec::LoopSpec;
use super::vector::{difference, norm};

/// Threshold of a net force as a share of the thrust, and of a torque in the sum of two projections: above rounding,
/// 1e-16, and below the square of any real alignment, 1e-12.
pub const NOTHING: f64 = 1e-13;

/// Torque of a loop, and the nominal angular momentum about the centre of mass that it can take. Axes are unit vectors
/// in F_s.
#[derive(Clone, Debug, PartialEq)]
pub struct Capacity {
    /// Momentum within the span of the wheels' axes, N m s.
    pub within_reach: f64,
    /// Most momentum in its direction that the wheels can store within their speed limits, shared by least norm, N m s.
    pub wheels: f64,
    /// Momentum about axes without torque in both directions, N m s.
    pub out_of_reach: f64,
    /// Axes that span the torques of the wheels.
    pub wheel_axes: Vec<[f64; 3]>,
    /// Axes that span the two-sided torques of the thrusters, with the total thrust and the net force for 1 N m, N.
    pub thruster_axes: Vec<([f64; 3], [f64; 2])>,
    /// Number of axes about which they can unload the wheels; without a net force if the force is held.
    pub unloaded_axes: usize,
    /// Axes without two-sided torque of wheels or thrusters.
    pub free_axes: Vec<[f64; 3]>,
}

impl Capacity {
    pub fn lines(&self, spec: &LoopSpec) -> Vec<String> {
        let mut lines = Vec::new();
        if !spec.wheels.is_empty() {
            lines.push(format!("wheels: torque about {}", names(&self.wheel_axes)));
        }
        for (axis, [total, force]) in &self.thruster_axes {
            let with = if *force > NOTHING * total {
                format!("and a net force of {force:.4} N")
            } else {
                "without a net force".to_owned()
            };
            let name = names(&[*axis]);
            lines.push(format!(
                "thrusters: torque in both directions about {name}; 1 N m takes {total:.4} N of thrust, {with}"
            ));
        }
        if !spec.thrusters.is_empty() && self.thruster_axes.is_empty() {
            lines.push("thrusters: torque in both directions about no axis".to_owned());
        }
        if !spec.rods.is_empty() {
            lines.push("torque rods: torque across the magnetic field".to_owned());
        } else if !self.free_axes.is_empty() {
            let free = names(&self.free_axes);
            lines.push(format!("neither wheels nor thrusters have torque in both directions about {free}"));
        }
        lines
    }

    /// Warnings; none if the momentum fits and can be unloaded.
    pub fn notes(&self, spec: &LoopSpec) -> Vec<String> {
        let mut notes = Vec::new();
        if self.within_reach > self.wheels {
            notes.push(format!(
                "the wheels of the loop can take {:.3} N m s of the nominal momentum of {:.3} N m s along their axes: \
                they saturate when the body is stopped",
                self.wheels, self.within_reach
            ));
        }
        if !self.free_axes.is_empty() && spec.phases.iter().any(|phase| phase.law.is_some()) {
            notes.push(format!(
                "neither wheels nor thrusters of the loop have torque in both directions about {}: the loop cannot \
                control the attitude about it; add wheels or thrusters",
                names(&self.free_axes)
            ));
        }
        // rounding of the projections
        if spec.rods.is_empty() && self.out_of_reach > 1e-9 * (self.within_reach + self.out_of_reach) {
            notes.push(format!(
                "{:.3} N m s of the nominal momentum are about {}: the loop cannot stop it",
                self.out_of_reach,
                names(&self.free_axes)
            ));
        }
        if !spec.wheels.is_empty() && !spec.thrusters.is_empty() && self.unloaded_axes < 3 {
            let axes = ["no axis", "one axis", "two axes"][self.unloaded_axes];
            let held = if spec.holds_force { " without a net force" } else { "" };
            notes.push(format!(
                "the thrusters of the loop have torque in both directions{held} about {axes} alone: momentum of the \
                wheels about the others cannot be unloaded without a turn"
            ));
        }
        let is_read = |sensor: &SensorSpec| matches!(sensor.kind.observes, Observes::Field(_)) && !spec.rods.is_empty();
        if spec.knows_the_truth() && !spec.sensors.iter().all(is_read) {
            notes.push("estimator = \"perfect\" reads no sensor: [[sensors]] has no effect on the runs".to_owned());
        }
        notes
    }
}

/// Names of `axes` in F_s, or their components.
fn names(axes: &[[f64; 3]]) -> String {
    let name = |axis: &[f64; 3]| {
        let place = (0..3).find(|i| {
            let unit: [f64; 3] = std::array::from_fn(|j| if *i == j { axis[j].signum() } else { 0.0 });
            norm(difference(*axis, unit)) < 1e-6
        });
        let [x, y, z] = axis;
        place.map_or_else(|| format!("({x:.4}, {y:.4}, {z:.4})"), |i| format!("s{}", i + 1))
    };
    if axes.is_empty() { "no axis".to_owned() } else { axes.iter().map(name).collect::<Vec<_>>().join(", ") }
}
