//! One run of a scene: a campaign file in memory, its nominal scene, the states at the observation points.
//!
//! `cargo run --release --example one_run`

#![allow(clippy::disallowed_methods)] // digits of no row: the elementary functions of the platform will do

use spindrift::campaign::{Overrides, Plan};
use spindrift::ensemble::SingleRun;
use spindrift::math::Isa;
use spindrift::run::{StateField, Status};
use spindrift::sampling::SampleId;

/// A spacecraft with one wheel about s2. Keys that are not given have defaults.
const SCENE: &str = concat!(
    r#"[campaign]
name = "one_run"
samples = 1
seed = 1
duration_s = 60.0

[observe]
points = 7

[integrator]
method = "auto"
tolerance = 1e-12

"#,
    include_str!("spacecraft.toml"),
);

/// Runs the nominal scene and prints the angular velocity of F_s relative to F_e at the observation points.
pub fn main() {
    let plan = Plan::from_text("one_run.toml", SCENE, Overrides::default()).unwrap_or_else(|error| panic!("{error}"));
    let run = SingleRun::new(&plan, SampleId(0), plan.grid.clone(), Isa::best()).expect("the scene is physical");
    assert_eq!(run.outcome.status, Status::Done);

    println!("{:>6}  {:>10} {:>10} {:>10}   rad/s, components in F_s", "s", "omega_1", "omega_2", "omega_3");
    for (point, time) in run.grid.times().iter().enumerate() {
        let [x, y, z] = run.table.at::<3>(StateField::Rate, point);
        println!("{time:6.1}  {x:10.6} {y:10.6} {z:10.6}");
    }
    for (series, errors) in &run.series {
        let quantity = series.quantity(&run.request.wheels);
        let name = quantity.as_ref().map_or("", |quantity| quantity.name());
        if name.ends_with("_error") {
            let maximum = errors.iter().fold(0.0_f64, |maximum, error| maximum.max(error.abs()));
            println!("maximum of {name}: {maximum:.1e}");
            assert!(maximum < 1e-11, "the run conserves energy and momentum");
        }
    }
}
