//! Rows a second of one core against the number of columns and of observation points: a table, and the figure of
//! `docs/performance.md`.
//!
//! `cargo bench -p spindrift-benches --bench rows -- ../docs/figures/rows.svg`. Each campaign is `no_debris.toml`,
//! whole: drawn, propagated, observed, into bands, statistics and Parquet, without the page. The number is the median
//! of three rounds, each of all campaigns in turn, of rows over CPU time of the process.

#![allow(clippy::disallowed_methods)] // digits of no row: the elementary functions of the platform will do

use std::num::NonZeroUsize;
use std::path::PathBuf;

use spindrift::observables::Group;
use spindrift::report::figure::{Axis, Dash, Figure, Hue, Mark};
use spindrift::report::figure_files::FigureSheet;
use spindrift::workflow::{Campaign, Quiet, Session};

const CAMPAIGN: &str = include_str!("../campaigns/no_debris.toml");
const SAMPLES: u64 = 100_000;
const ROUNDS: usize = 3;
const POINTS: [usize; 5] = [2, 11, 33, 101, 401];

/// Groups of columns, each list with those before it; the fourth makes the default columns, the last all.
const GROUPS: [&[Group]; 5] = [
    &[Group::Numerics, Group::FinalState, Group::StepStatistics],
    &[Group::EnergyConservation, Group::MomentumConservation],
    &[Group::Attitude, Group::Constraints, Group::Energies, Group::EnergiesCom],
    &[Group::Exchange],
    &[Group::Motion, Group::MassProperties],
];

/// CPU time of this process, s.
fn cpu_seconds() -> f64 {
    let now = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    now.tv_sec as f64 + 1e-9 * now.tv_nsec as f64
}

/// Columns of the rows of one campaign, and rows a second.
fn measured(folder: &PathBuf, groups: usize, points: usize) -> (usize, f64) {
    let names: Vec<String> = GROUPS[..=groups]
        .iter()
        .flat_map(|groups| groups.iter().map(|group| format!("\"{}\"", group.name())))
        .collect();
    let _ = std::fs::remove_dir_all(folder);
    let watch = Quiet::default();
    let session = Session::new(&watch).expect("a session").on_threads(NonZeroUsize::new(1));
    let start = cpu_seconds();
    let results = Campaign::from_text("no_debris.toml", CAMPAIGN, session)
        .set("observe.groups", &format!("[{}]", names.join(", ")))
        .set("observe.points", &points.to_string())
        .samples(SAMPLES)
        .store(folder)
        .results()
        .expect("a result");
    let seconds = cpu_seconds() - start;
    let plan = results.plan();
    (plan.request().columns().len() + plan.dispersions.columns().len(), SAMPLES as f64 / seconds)
}

fn main() {
    let figure = std::env::args().skip(1).find(|argument| argument.ends_with(".svg"));
    let folder = std::env::temp_dir().join(format!("spindrift_rows_{}", std::process::id()));
    let mut rates = vec![Vec::new(); GROUPS.len() * POINTS.len()];
    let mut columns = [0; GROUPS.len()];
    for _ in 0..ROUNDS {
        for (groups, count) in columns.iter_mut().enumerate() {
            for (place, points) in POINTS.into_iter().enumerate() {
                let (found, rate) = measured(&folder, groups, points);
                *count = found;
                rates[groups * POINTS.len() + place].push(rate);
            }
        }
    }
    let _ = std::fs::remove_dir_all(&folder);
    let medians: Vec<f64> = rates
        .into_iter()
        .map(|mut of| {
            of.sort_by(f64::total_cmp);
            of[ROUNDS / 2]
        })
        .collect();
    println!("| columns | {} |", POINTS.map(|points| format!("{points} points")).join(" | "));
    println!("| --- |{}", " --- |".repeat(POINTS.len()));
    for (groups, count) in columns.iter().enumerate() {
        let of = &medians[groups * POINTS.len()..][..POINTS.len()];
        println!("| {count} | {} |", of.iter().map(|rate| format!("{rate:.0}")).collect::<Vec<_>>().join(" | "));
    }
    let Some(path) = figure else { return };
    let x: Vec<f64> = columns.iter().map(|count| *count as f64).collect();
    let curve = |(place, points): (usize, usize)| {
        let y = (0..GROUPS.len()).map(|groups| medians[groups * POINTS.len() + place]).collect();
        Mark::line(format!("{points} points"), Hue::Curve(place), Dash::of_curve(place), x.clone(), y)
    };
    let marks = POINTS.into_iter().enumerate().map(curve).collect();
    let title = "Rows of no_debris.toml, one core: CPU time of a whole campaign";
    let mut drawn = Figure::new(title, Axis::linear("columns of a row", ""), Axis::log("rows a second", ""), marks);
    drawn.name = "rows".to_owned();
    spindrift_figures::register();
    FigureSheet { title: String::new(), figures: vec![drawn] }.save(path.as_ref()).expect("a figure");
}
