//! What a campaign costs against what it has: CPU time and memory against rows, columns, points, dispersions, wheels,
//! ticks of a loop and threads. Tables with slopes, and a figure.
//!
//! `cargo bench -p spindrift-benches --bench curves -- ../docs/figures/curves.svg rows=1000000 rows=10000000`; without
//! `rows=` the curve of rows ends at 400,000. Each campaign is whole, without the page, and runs in a process of its
//! own, with its start-up: CPU time and largest memory are those of the process. Medians of three rounds; a campaign of
//! more than a million rows runs once. The slope is d ln(time)/d ln(x) from the line before: 0 where x costs nothing, 1
//! where the time is proportional to it. A slope above 1 is a defect with its reason beside it.

#![allow(clippy::disallowed_methods)] // digits of no row: the elementary functions of the platform will do

use std::num::NonZeroUsize;
use std::process::Command;

use spindrift::observables::Group;
use spindrift::report::figure::{Axis, Dash, Figure, Hue, Mark};
use spindrift::report::figure_files::FigureSheet;
use spindrift::workflow::{Campaign, Quiet, Session};

const FREE: &str = include_str!("../campaigns/no_debris.toml");
const LOOP: &str = include_str!("peers/basilisk_attitude.toml");
const ROUNDS: usize = 3;
/// Campaigns with more rows run once.
const ROWS_OF_ROUNDS: f64 = 1e6;
/// The argument with which this program measures one campaign.
const ONE: &str = "--one";
const ROWS: [f64; 7] = [1e3, 3e3, 1e4, 3e4, 1e5, 2e5, 4e5];

/// What a campaign is measured against, and how it is written.
#[derive(Clone, Copy, PartialEq)]
enum Against {
    Rows,
    Groups,
    Points,
    Dispersions,
    Wheels,
    Ticks,
    Threads,
}

/// Each with its name and the numbers of it.
const CURVES: [(Against, &str, &[f64]); 7] = [
    (Against::Rows, "rows", &ROWS),
    (Against::Groups, "groups of columns", &[1.0, 2.0, 4.0, 8.0, 11.0]),
    (Against::Points, "points", &[2.0, 11.0, 33.0, 101.0, 401.0]),
    (Against::Dispersions, "dispersions", &[1.0, 2.0, 4.0, 9.0]),
    (Against::Wheels, "wheels", &[1.0, 2.0, 4.0, 8.0]),
    (Against::Ticks, "ticks of a loop", &[750.0, 1500.0, 3000.0, 6000.0]),
    (Against::Threads, "threads", &[1.0, 2.0]),
];

/// Rows of a campaign that is measured against something else.
const FIXED_ROWS: u64 = 20_000;
/// Runs of a loop.
const LOOP_RUNS: u64 = 128;

/// `FREE` with its first `count` dispersions.
fn with_dispersions(count: usize) -> String {
    let mut parts = FREE.split("[[disperse]]");
    let head = parts.next().unwrap_or_default().to_owned();
    // the last has the derived parameter after it
    let kept: Vec<&str> = parts.take(count).map(|part| part.split("[[derive]]").next().unwrap_or_default()).collect();
    kept.iter().fold(head, |text, part| text + "[[disperse]]" + part)
}

/// `FREE` with `count` wheels beside each other in place of two, and the dispersions that are not of wheels.
fn with_wheels(count: usize) -> String {
    let wheel = |k: usize| {
        format!(
            "[[wheels]]\nname = \"w{k}\"\naxis = [{}, {}, 1]\nposition_m = [0, 0, {}]\nradius_m = 0.25\nlength_m = \
            0.1\ndensity_kg_m3 = 2700.0\nrate_rad_s = {}\n\n",
            k % 3,
            k % 2,
            0.5 + 0.2 * k as f64,
            150.0 + 10.0 * k as f64
        )
    };
    let (before, after) = FREE.split_once("[[wheels]]").expect("wheels");
    let (_, after) = after.split_once("[initial]").expect("an initial state");
    let text = (0..count).fold(before.to_owned(), |text, k| text + &wheel(k)) + "[initial]" + after;
    let mut parts = text.split("[[disperse]]");
    let head = parts.next().unwrap_or_default().to_owned();
    let kept = parts.filter(|part| !part.contains("wheels."));
    kept.fold(head, |text, part| text + "[[disperse]]" + part)
}

/// CPU time of this process, s, and its largest memory, MB.
fn used() -> [f64; 2] {
    let now = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let peak =
        status.lines().find_map(|line| line.strip_prefix("VmHWM:")?.split_whitespace().next()?.parse::<f64>().ok());
    [now.tv_sec as f64 + 1e-9 * now.tv_nsec as f64, peak.map_or(f64::NAN, |kilobytes| kilobytes / 1024.0)]
}

/// Runs one campaign in this process and prints what it used.
fn run_one(against: Against, x: f64) {
    let folder = std::env::temp_dir().join(format!("spindrift_curves_{}", std::process::id()));
    let watch = Quiet::default();
    let threads = if against == Against::Threads { x as usize } else { 1 };
    let session = Session::new(&watch).expect("a session").on_threads(NonZeroUsize::new(threads));
    let text = match against {
        Against::Ticks => LOOP.to_owned(),
        Against::Dispersions => with_dispersions(x as usize),
        Against::Wheels => with_wheels(x as usize),
        _ => FREE.to_owned(),
    };
    let mut campaign = Campaign::from_text("measured.toml", &text, session).store(&folder);
    campaign = match against {
        Against::Rows => campaign.samples(x as u64),
        Against::Ticks => campaign.samples(LOOP_RUNS).set("campaign.duration_s", &format!("{:?}", 0.1 * x)),
        _ => campaign.samples(FIXED_ROWS),
    };
    campaign = match against {
        Against::Points => campaign.set("observe.points", &x.to_string()),
        Against::Groups => {
            let names: Vec<String> = Group::DEFAULT
                .iter()
                .chain(&[Group::Motion, Group::MassProperties])
                .take(x as usize)
                .map(|group| format!("\"{}\"", group.name()))
                .collect();
            campaign.set("observe.groups", &format!("[{}]", names.join(", ")))
        }
        _ => campaign,
    };
    campaign.results().expect("a result");
    let [seconds, megabytes] = used();
    let _ = std::fs::remove_dir_all(&folder);
    println!("{seconds} {megabytes}");
}

/// Medians of what the campaign used in processes of its own.
fn measured(place: usize, x: f64) -> [f64; 2] {
    let rounds = if x > ROWS_OF_ROUNDS { 1 } else { ROUNDS };
    let program = std::env::current_exe().expect("this program");
    let mut found: Vec<[f64; 2]> = (0..rounds)
        .map(|_| {
            let output =
                Command::new(&program).args([ONE, &place.to_string(), &x.to_string()]).output().expect("a process");
            let text = String::from_utf8_lossy(&output.stdout).into_owned();
            let mut numbers = text.split_whitespace().map(|number| number.parse().expect("a number"));
            std::array::from_fn(|_| {
                numbers.next().unwrap_or_else(|| panic!("{}", String::from_utf8_lossy(&output.stderr)))
            })
        })
        .collect();
    found.sort_by(|a, b| a[0].total_cmp(&b[0]));
    found[rounds / 2]
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let Some(at) = arguments.iter().position(|argument| argument == ONE) {
        let place: usize = arguments[at + 1].parse().expect("a curve");
        return run_one(CURVES[place].0, arguments[at + 2].parse().expect("a number"));
    }
    let more = arguments.iter().filter_map(|argument| argument.strip_prefix("rows=")?.parse::<f64>().ok());
    let more: Vec<f64> = more.collect();
    let mut of_rows = [Vec::new(), Vec::new()];
    for (place, (against, name, numbers)) in CURVES.into_iter().enumerate() {
        println!("\n| {name} | CPU, s | slope | us a row | memory, MB |\n| --- | --- | --- | --- | --- |");
        let mut before: Option<[f64; 2]> = None;
        let numbers = numbers.iter().chain(more.iter().filter(|_| against == Against::Rows));
        for x in numbers.copied() {
            let [seconds, megabytes] = measured(place, x);
            let slope = before.map(|[at, took]| (seconds / took).ln() / (x / at).ln());
            let rows = match against {
                Against::Rows => x,
                Against::Ticks => LOOP_RUNS as f64,
                _ => FIXED_ROWS as f64,
            };
            let slope = slope.map_or_else(String::new, |slope| format!("{slope:.2}"));
            println!("| {x} | {seconds:.3} | {slope} | {:.1} | {megabytes:.0} |", 1e6 * seconds / rows);
            before = Some([x, seconds]);
            if against == Against::Rows {
                of_rows.iter_mut().zip([x, seconds]).for_each(|(column, number)| column.push(number));
            }
        }
    }
    let Some(path) = arguments.iter().find(|argument| argument.ends_with(".svg")) else { return };
    let [x, y] = of_rows;
    let mark = Mark::line("CPU time".to_owned(), Hue::Curve(0), Dash::of_curve(0), x, y);
    let title = "Whole campaigns of no_debris.toml, one core";
    let mut drawn = Figure::new(title, Axis::log("rows", ""), Axis::log("CPU time", "s"), vec![mark]);
    drawn.name = "curves".to_owned();
    spindrift_figures::register();
    FigureSheet { title: String::new(), figures: vec![drawn] }.save(path.as_ref()).expect("a figure");
}
