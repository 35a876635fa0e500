//! A stored campaign under a control law of one's own: a spacecraft is held at an attitude by three wheels, with a rate
//! sensor that is noisy.
//!
//! Gains and noise are parameters that the law declares: keys of `[control]`, dispersed as every other key is. The
//! campaign is stored, so that it can be interrupted and continued, and read again.
//!
//! `cargo run --release --example control_campaign`

use spindrift::control::{ControlLaw, LawContext};
use spindrift::dynamics::actuation::{Actuation, ActuationLaw, BodyState, WheelState, ZeroOrderHold};
use spindrift::loops::OwnLaw;
use spindrift::sampling::{Noise, SampleId};
use spindrift::scene::schema::Limit;
use spindrift::scene::{Actuated, LawParameter};
use spindrift::workflow::{Campaign, Quiet, Results, Session, WorkflowError};

/// The file of the campaign.
const CAMPAIGN: &str = r#"
[campaign]
name = "control_campaign"
samples = 2000
seed = 11
duration_s = 120.0

[observe]
points = 121
groups = ["final_state", "motion", "energy_conservation", "momentum_conservation", "numerics"]

[integrator]
method = "auto"
tolerance = 1e-12

[body]
mass_kg = 180.0
center_of_mass_m = [0.0, 0.0, 0.0]
inertia_kg_m2 = [[30.0, 0.4, -0.2], [0.4, 36.0, 0.3], [-0.2, 0.3, 24.0]]
includes_wheels = true

[[wheels]]
name = "w1"
axis = [1, 0, 0]
mass_kg = 5.0
axial_inertia_kg_m2 = 0.02
transverse_inertia_kg_m2 = 0.012

[[wheels]]
name = "w2"
axis = [0, 1, 0]
mass_kg = 5.0
axial_inertia_kg_m2 = 0.02
transverse_inertia_kg_m2 = 0.012

[[wheels]]
name = "w3"
axis = [0, 0, 1]
mass_kg = 5.0
axial_inertia_kg_m2 = 0.02
transverse_inertia_kg_m2 = 0.012

[control]
stiffness_n_m = 0.6
damping_n_m_s = 6.0
noise_rad_s = 2e-5

# ten degrees about each axis, some tenths of a degree per second
[[disperse]]
parameter = "initial.attitude"
distribution = "attitude_error"
std_rad = "10 deg"

[[disperse]]
parameter = "initial.angular_velocity_rad_s"
distribution = "normal"
std = ["0.3 deg/s", "0.3 deg/s", "0.3 deg/s"]

[[disperse]]
parameter = "control.stiffness_n_m"
distribution = "normal"
std = 0.06

[[disperse]]
parameter = "control.noise_rad_s"
distribution = "uniform"
min = 1e-5
max = 5e-5

[initial]
angular_velocity_rad_s = [0.0, 0.0, 0.0]

[[observable]]
name = "attitude_error_rad"
expression = "2 * sqrt(q_es_x_final * q_es_x_final + q_es_y_final * q_es_y_final + q_es_z_final * q_es_z_final)"
unit = "rad"

[[require]]
observable = "attitude_error_rad"
at_most = "0.1 deg"
fraction = 0.95
"#;

/// Parameters and columns that the law declares.
pub static PARAMETERS: [LawParameter; 4] = [
    LawParameter::number(
        "stiffness_n_m",
        "N m",
        "Torque per unit of the vector part of the attitude error",
        Limit::Positive,
    ),
    LawParameter::number("damping_n_m_s", "N m s", "Torque per unit of measured rate", Limit::NotNegative),
    LawParameter::number(
        "noise_rad_s",
        "rad/s",
        "Standard deviation of a rate measurement, about each axis",
        Limit::NotNegative,
    )
    .or(&[0.0]),
    LawParameter::number("period_s", "s", "Control period", Limit::Positive).or(&[0.5]),
];

/// Turns F_s to F_e by motor torques, from the true attitude and a noisy rate.
struct Hold {
    stiffness: f64,
    damping: f64,
    noise: f64,
    axes: [Noise; 3],
    tick: u64,
}

impl ActuationLaw for Hold {
    fn arc(&mut self, _time: f64, body: &BodyState, _wheels: &WheelState) -> Actuation {
        let sign = if body.q_es[0] < 0.0 { -1.0 } else { 1.0 };
        let mut actuation = Actuation::none(f64::INFINITY);
        for (i, axis) in self.axes.iter_mut().enumerate() {
            let rate = body.omega_se_s[i] + self.noise * axis.normal(self.tick);
            // the torque on the wheel is that on the body, the other way
            actuation.motor_torque[i] = self.stiffness * sign * body.q_es[i + 1] + self.damping * rate;
        }
        self.tick += 1;
        actuation
    }
}

/// The law of a run.
fn hold(context: &LawContext<'_>) -> ZeroOrderHold<Hold> {
    let law = Hold {
        stiffness: context.number("stiffness_n_m"),
        damping: context.number("damping_n_m_s"),
        // the nominal run has no noise
        noise: if context.sample == SampleId(0) { 0.0 } else { context.number("noise_rad_s") },
        axes: ["gyro.x", "gyro.y", "gyro.z"].map(|name| context.noise(name)),
        tick: 0,
    };
    ZeroOrderHold::new(context.number("period_s"), law)
}

/// The law, as a campaign flies it.
pub fn law() -> OwnLaw {
    let commands = Actuated { motors: true, ..Actuated::NONE };
    OwnLaw::Loop(ControlLaw::new("wheel_hold", commands, &PARAMETERS, hold))
}

/// The campaign.
pub fn campaign<'a>(session: Session<'a>) -> Campaign<'a> {
    Campaign::from_text("control_campaign.toml", CAMPAIGN, session)
}

/// Runs and stores the campaign, opens it again, and replays its fastest run.
///
/// # Errors
/// A result that cannot be written or read.
pub fn run(folder: &std::path::Path) -> Result<(), WorkflowError> {
    let (watch, law) = (Quiet::default(), law());
    let session = Session::new(&watch)?.under(&law);
    campaign(session).store(folder).results()?;

    // another day: the same campaign finds everything there
    let results: Results<'_> = campaign(session).store(folder).results()?;
    for one in &results.verdicts()?.list {
        println!("{}: {}", one.word(), one.requirement.name());
    }
    let rates = results.column("omega_se_s_z_final_rad_s")?;
    let fastest = (0..rates.len()).max_by(|a, b| rates[*a].abs().total_cmp(&rates[*b].abs())).unwrap_or(0);
    let run = results.replay(SampleId(fastest as u64))?;
    println!(
        "sample {fastest} ends at {:.1e} rad/s about s3, after {} arcs of constant torque",
        rates[fastest],
        run.arcs.len()
    );
    Ok(())
}

/// Runs the example in a folder of its own.
pub fn main() {
    let folder = std::env::temp_dir().join(format!("spindrift-control-campaign-{}", std::process::id()));
    let done = run(&folder);
    let removed = std::fs::remove_dir_all(&folder);
    done.unwrap_or_else(|error| panic!("{error}"));
    removed.unwrap_or_else(|error| panic!("{error}"));
}
