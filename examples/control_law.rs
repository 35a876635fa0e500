//! A control law of one's own: a spinning spacecraft is turned to a target attitude by a sampled
//! proportional-derivative law.
//!
//! `cargo run --release --example control_law`

#![allow(clippy::disallowed_methods)] // digits of no row: the elementary functions of the platform will do

use spindrift::campaign::{Overrides, Plan};
use spindrift::dynamics::actuation::{Actuation, ActuationLaw, BodyState, Laws, WheelState, ZeroOrderHold};
use spindrift::math::Isa;
use spindrift::propagation::PropagationSettings;
use spindrift::run::{StateField, StateFields, Status};
use spindrift::scene::{Actuated, Scene};

/// A spacecraft without wheels that tumbles slowly. Keys that are not given have defaults.
const SCENE: &str = r#"
[campaign]
name = "control_law"
samples = 1
seed = 1
duration_s = 120.0

[observe]
points = 13

[integrator]
method = "auto"
tolerance = 1e-12

[[body.parts]]
name = "fuselage"
shape = "hollow_cylinder"
outer_radius_m = 0.8
length_m = 2.0
wall_thickness_m = 0.02
density_kg_m3 = 2700.0
position_m = [0, 0, 1]

[initial]
angular_velocity_rad_s = [0.02, -0.03, 0.1]
attitude = [0.7071067811865476, 0.7071067811865476, 0.0, 0.0]
"#;

/// Control period, s.
const PERIOD: f64 = 0.5;

/// Turns F_s to F_e: torque -k q_v - d omega, k in N m, d in N m s, with the sign of the shorter rotation.
struct ProportionalDerivative {
    stiffness: f64,
    damping: f64,
}

impl ActuationLaw for ProportionalDerivative {
    fn arc(&mut self, _time: f64, body: &BodyState, _wheels: &WheelState) -> Actuation {
        let shorter = body.q_es[0].signum();
        let mut actuation = Actuation::none(f64::INFINITY);
        for i in 0..3 {
            actuation.body_torque[i] = -self.stiffness * shorter * body.q_es[i + 1] - self.damping * body.omega_se_s[i];
        }
        actuation
    }
}

/// Flies the closed loop and prints the attitude error at the observation points.
pub fn main() {
    let plan =
        Plan::from_text("control_law.toml", SCENE, Overrides::default()).unwrap_or_else(|error| panic!("{error}"));
    let scene = Scene::resolve(&plan.nominal).expect("the plan's scene is physical");
    let inertia = scene.mass.inertia[0][0];
    let law = ProportionalDerivative { stiffness: 0.06 * inertia, damping: 0.3 * inertia };
    let mut laws = vec![ZeroOrderHold::new(PERIOD, law)];

    let fields = StateFields::NONE.with(StateField::Rate).with(StateField::Attitude);
    let control = spindrift::ode::Control { tolerance: plan.tolerance, step: None, max_steps: plan.max_steps };
    let settings =
        PropagationSettings::new(plan.method, control, plan.grid.clone(), fields, &scene).with_feedback(Actuated::ALL);
    let scenes = [scene];
    settings.engine(Isa::best()).propagate_under(Laws::Feedback(&mut laws), &scenes, &mut |run| {
        assert_eq!(run.outcome.status, Status::Done);
        for (point, time) in plan.grid.times().iter().enumerate() {
            let [w, ..] = run.table.at::<4>(StateField::Attitude, point);
            println!("{time:6.1} s: attitude error {:.2e} rad", 2.0 * w.abs().min(1.0).acos());
        }
        let [_, x, y, z] = run.table.at::<4>(StateField::Attitude, plan.grid.points() - 1);
        assert!((x * x + y * y + z * z).sqrt() < 1e-3, "the target attitude is reached");
        println!("{} arcs of constant torque", run.arcs.len());
    });
}
