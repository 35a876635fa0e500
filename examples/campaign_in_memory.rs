//! A campaign without files: rows are collected in memory by a sink of one's own.
//!
//! `cargo run --release --example campaign_in_memory`

#![allow(clippy::disallowed_methods)] // digits of no row: the elementary functions of the platform will do

use std::convert::Infallible;
use std::sync::Mutex;

use spindrift::campaign::{Overrides, Plan};
use spindrift::ensemble::{Ensemble, Parts, Rows, Supervision, run};
use spindrift::math::Isa;
use spindrift::run::Status;

/// A spacecraft whose spin is uncertain.
const CAMPAIGN: &str = concat!(
    r#"[campaign]
name = "campaign_in_memory"
samples = 500
seed = 7
duration_s = 20.0

[observe]
points = 101
groups = ["exchange", "energy_conservation"]

[integrator]
method = "auto"
tolerance = 1e-10

"#,
    include_str!("spacecraft.toml"),
    r#"
[[disperse]]
parameter = "initial.angular_velocity_rad_s.y"
distribution = "normal"
std = 0.05
"#
);

/// The column of the energy transfer between body and wheel w1.
const COLUMN: &str = "exchange_w1_peak_to_peak_j";

/// Runs 500 samples on all cores and prints the correlation of a rate and the energy transfer.
pub fn main() {
    let plan = Plan::from_text("campaign_in_memory.toml", CAMPAIGN, Overrides::default())
        .unwrap_or_else(|error| panic!("{error}"));
    let ensemble = Ensemble::new(&plan, Isa::best());
    let columns = ensemble.request().columns();
    let column = columns.iter().position(|column| column.quantity.name() == COLUMN);
    let column = column.expect("the group `exchange` is observed");
    let collected = Mutex::new(Vec::new());
    // keeps the column with the value of the first dispersed parameter; called from several threads, in any order
    let sink = |rows: &Rows| {
        let values = rows.parameter(0).iter().zip(rows.observable(column));
        let done = rows.statuses().iter().zip(values).filter(|(status, _)| **status == Status::Done);
        let pairs = done.map(|(_, (parameter, observable))| [*parameter, *observable]);
        collected.lock().expect("no thread panicked").extend(pairs);
        Ok::<(), Infallible>(())
    };
    run(&ensemble, Parts::of(plan.samples), None, &sink, Supervision::progress(&|_| ()))
        .unwrap_or_else(|error| panic!("{error}"));

    let pairs = collected.into_inner().expect("no thread panicked");
    assert_eq!(pairs.len(), 500, "every run is ok");
    let correlation = correlation(&pairs);
    println!("{} runs; correlation of the rate about s2 and {COLUMN}: {correlation:.3}", pairs.len());
    assert!(correlation.abs() <= 1.0);
}

/// The correlation coefficient of pairs of numbers.
fn correlation(pairs: &[[f64; 2]]) -> f64 {
    let count = pairs.len() as f64;
    let mean = [0, 1].map(|i| pairs.iter().map(|pair| pair[i]).sum::<f64>() / count);
    let moment = |i: usize, j: usize| pairs.iter().map(|pair| (pair[i] - mean[i]) * (pair[j] - mean[j])).sum::<f64>();
    moment(0, 1) / (moment(0, 0) * moment(1, 1)).sqrt()
}
