//! The replay of the page against `simulate` and the rows.

use crate::prelude::*;
use std::sync::LazyLock;

static MISSIONS: LazyLock<Found> = LazyLock::new(|| {
    let text = campaign_text("net_launch");
    let scratch = ScratchFolder::new("page-missions");
    scratch.file("c.toml", &text.replace("samples = 1024 ", "samples = 40 "));
    scratch.command("campaign c.toml --out r").output().unwrap();
    Found::read(scratch, String::new())
});

fn near(found: f64, expected: f64, scale: f64, what: &str) {
    assert!((found - expected).abs() <= 1e-6 * scale.max(expected.abs()), "{what}: {found} for {expected}");
}

/// Law: the live numbers are those of `simulate` for that sample and time; propellant never falls and ends as in the
/// row.
#[test]
fn live_numbers_are_those_of_simulate() {
    let found = &*MISSIONS;
    let runs = found.shown_runs();
    let [propellants, ends] = ["propellant_kg", "end_time_s"].map(|name| found.all(&[name]).remove(0));
    for run in runs.iter().take(3) {
        let sample = run["sample"].as_u64().unwrap();
        let times = found.array(&run["times"]);
        let places = [0, times.len() / 3, times.len() / 2, times.len() - 1];
        let list: Vec<String> = places.iter().map(|place| format!("{}", times[*place])).collect();
        found
            .scratch
            .prints(&format!("simulate c.toml --sample {sample} --times {} --out s.parquet", list.join(",")), 0);
        let table = found.scratch.table("s.parquet");
        let live = run["live"].as_array().unwrap();
        let shown = |name: &str, component: usize, place: usize| {
            let number =
                live.iter().find(|number| number["name"] == name).unwrap_or_else(|| panic!("{name}: {live:?}"));
            let width = number["components"].as_array().unwrap().len().max(1);
            found.array(&number["values"])[width * place + component]
        };
        let watch = Quiet::default();
        let results = Results::open(found.scratch.path("r"), Session::new(&watch).unwrap()).unwrap();
        let center = results.replay(SampleId(sample)).unwrap().scene.mass.center;
        for (row, place) in places.into_iter().enumerate() {
            let of = |name: &str| floats(&table, name)[row];
            for (component, axis) in ["x", "y", "z"].into_iter().enumerate() {
                near(
                    shown("Angular velocity", component, place),
                    of(&format!("omega_se_s_{axis}_rad_s")),
                    1e-3,
                    "rate",
                );
            }
            for (wheel, name) in ["w1", "w2"].into_iter().enumerate() {
                near(shown("Wheel speed", wheel, place), of(&format!("rate_{name}_rad_s")), 1.0, "wheel");
            }
            let [w, x, y, z] = ["w", "x", "y", "z"].map(|part| of(&format!("q_es_{part}")));
            let dcm = [
                [w * w + x * x - y * y - z * z, 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
                [2.0 * (x * y + w * z), w * w - x * x + y * y - z * z, 2.0 * (y * z - w * x)],
                [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), w * w - x * x - y * y + z * z],
            ];
            let axes = ["x", "y", "z"].into_iter().zip(dcm);
            let apart = axes.map(|(axis, row)| {
                let offset: f64 = row.iter().zip(center).map(|(c, r)| c * r).sum();
                of(&format!("r_gdo_e_{axis}_m")) - of(&format!("r_po_e_{axis}_m")) - offset
            });
            let distance = apart.map(|value| value * value).sum::<f64>().sqrt();
            near(shown("Distance to the debris", 0, place), distance, 1.0, "distance");
            let pointing = found.array(&live[0]["values"])[place];
            assert!(live[0]["name"] != "Pointing error" || pointing.is_nan() || (0.0..=3.15).contains(&pointing));
        }
        let used: Vec<f64> = (0..times.len()).map(|place| shown("Propellant used", 0, place)).collect();
        assert!(used.windows(2).all(|pair| pair[0] <= pair[1]) && used[0] == 0.0, "{used:?}");
        let (sample, last) = (sample as usize, used[used.len() - 1]);
        assert!(last <= propellants[sample] * (1.0 + 1e-6) && last > 0.97 * propellants[sample], "{last}");
        assert!(times[times.len() - 1] <= if ends[sample].is_finite() { ends[sample] } else { 2400.0 });
    }
}

/// Law: a shown pointing error is that of the run, within the error of the estimate that `simulate` records.
#[test]
fn pointing_errors_are_those_of_the_run() {
    let found = &*MISSIONS;
    let run = &found.data["replay"]["runs"][0];
    let live = run["live"].as_array().unwrap().iter().find(|number| number["name"] == "Pointing error").unwrap();
    let (times, shown) = (found.array(&run["times"]), found.array(&live["values"]));
    let known: Vec<usize> = (0..times.len()).filter(|place| shown[*place].is_finite()).step_by(3).collect();
    assert!(known.len() > 10 && live["held"] == true);
    let list: Vec<String> = known.iter().map(|place| times[*place].to_string()).collect();
    found.scratch.prints(&format!("simulate c.toml --times {} --out p.parquet", list.join(",")), 0);
    let table = found.scratch.table("p.parquet");
    let estimated = floats(&table, "estimated_pointing_error_rad");
    for (row, place) in known.into_iter().enumerate() {
        assert!(
            (shown[place] - estimated[row]).abs() < 3e-3,
            "{} for {} at {}",
            shown[place],
            estimated[row],
            times[place]
        );
    }
}

/// Law: phases and ends are marked at the times of the rows, and a run has failed where its row says so.
#[test]
fn phase_marks_are_at_the_times_of_the_rows() {
    let found = &*MISSIONS;
    let runs = found.shown_runs();
    let phases = runs[0]["loop"]["phases"].as_array().unwrap();
    let (mut failed, mut ended) = (0, 0);
    for run in runs {
        let row = run["sample"].as_u64().unwrap() as usize;
        let mut expected = Vec::new();
        for phase in phases {
            let name = phase.as_str().unwrap();
            expected.push((found.all(&[&format!("phase_{name}_begin_s")])[0][row], name.to_owned()));
        }
        let [launched, end, failure] = ["launched", "end_time_s", "failure"].map(|name| found.all(&[name])[0][row]);
        let marks = run["marks"].as_array().unwrap().iter();
        let marks: Vec<(f64, String)> =
            marks.map(|mark| (mark["time"].as_f64().unwrap(), mark["name"].as_str().unwrap().to_owned())).collect();
        assert!(marks.windows(2).all(|pair| pair[0].0 <= pair[1].0), "{marks:?}");
        let begun: Vec<_> = expected.into_iter().filter(|(time, _)| time.is_finite()).collect();
        assert!(begun.iter().all(|mark| marks.contains(mark)), "{begun:?} in {marks:?}");
        assert_eq!(marks.len(), begun.len() + usize::from(end.is_finite()), "{marks:?}");
        if end.is_finite() {
            let (time, name) = marks.last().unwrap();
            assert!(*time == end && (name == "launched") == (launched == 1.0), "{marks:?}");
            ended += 1;
        }
        assert_eq!(run["failed"], launched == 0.0 || failure >= 1.0, "sample {row}");
        failed += usize::from(run["failed"] == true);
    }
    assert!(failed > 0 && failed < runs.len() && ended > 5, "{failed} of {} failed", runs.len());
}

/// Law: the goal of an approach lies along the debris's velocity at the distance of the file.
#[test]
fn the_goal_of_an_approach_is_that_of_the_file() {
    let found = &*MISSIONS;
    let watch = Quiet::default();
    let results = Results::open(found.scratch.path("r"), Session::new(&watch).unwrap()).unwrap();
    assert_eq!(found.data["replay"]["scene"]["keep_out"], 5.0);
    for run in found.shown_runs() {
        let table = results.replay(SampleId(run["sample"].as_u64().unwrap())).unwrap().table;
        let velocity: [f64; 3] = table.at(StateField::DebrisVelocity, 0);
        let speed = velocity.map(|v| v * v).iter().sum::<f64>().sqrt();
        assert_eq!(run["goal"]["distance"], 10.0);
        for (axis, v) in velocity.into_iter().enumerate() {
            near(run["goal"]["axis"][axis].as_f64().unwrap(), v / speed, 1.0, "axis");
        }
    }
}

/// Law: the drawn path of the debris is the recorded one, relative to the centre of mass.
#[test]
fn the_drawn_path_is_the_recorded_one() {
    let found = found("debris", &campaign());
    let watch = Quiet::default();
    let results = Results::open(found.scratch.path("r"), Session::new(&watch).unwrap()).unwrap();
    for run in found.shown_runs() {
        let sample = SampleId(run["sample"].as_u64().unwrap());
        let recorded = results.replay(sample).unwrap();
        let (times, shown) = (found.array(&run["times"]), found.array(&run["debris"]["relative"]));
        assert_eq!(shown.len(), 3 * times.len());
        let mut seen = 0;
        for (point, time) in recorded.grid.times().iter().enumerate() {
            let place = times.iter().position(|other| (other - time).abs() < 1e-6).unwrap();
            let [debris, com]: [[f64; 3]; 2] =
                [StateField::DebrisPosition, StateField::ComPosition].map(|field| recorded.table.at(field, point));
            for axis in 0..3 {
                near(shown[3 * place + axis], debris[axis] - com[axis], 1.0, "relative position");
                seen += usize::from((debris[axis] - com[axis]).abs() > 1e-3);
            }
        }
        assert!(seen > 10, "they are apart");
    }
    assert!(found.data["replay"]["runs"][0]["goal"].is_null() && found.data["replay"]["scene"]["keep_out"] == 0.0);
}
