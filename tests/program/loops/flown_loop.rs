//! A run of a control loop with its true states at every control tick and at the start of every arc.

use crate::prelude::*;
use spindrift::loops::spec::LoopSpec;
use spindrift::scene::Arc;

use crate::loops::closed_loops::without;

pub const SAME_TIME: f64 = 1e-9;

#[derive(Clone, Debug)]
pub struct State {
    pub time: f64,
    pub q_es: [f64; 4],
    pub omega_se_s: [f64; 3],
    pub r_co_e: [f64; 3],
    pub v_co_e: [f64; 3],
    pub wheel_rates: Vec<f64>,
    pub debris: Option<Debris>,
}

#[derive(Clone, Copy, Debug)]
pub struct Debris {
    pub r_gdo_e: [f64; 3],
    pub v_gdo_e: [f64; 3],
    pub q_ed: [f64; 4],
    pub omega_de_d: [f64; 3],
}

impl State {
    pub fn s3_e(&self) -> [f64; 3] {
        self.to_e([0.0, 0.0, 1.0])
    }

    pub fn to_e(&self, v: [f64; 3]) -> [f64; 3] {
        dcm_from_quaternion(self.q_es).map(|row| dot(row, v))
    }

    pub fn to_s(&self, v: [f64; 3]) -> [f64; 3] {
        dcm_from_quaternion(conjugate(self.q_es)).map(|row| dot(row, v))
    }

    pub fn debris(&self) -> Debris {
        self.debris.unwrap()
    }
}

pub struct FlownLoop {
    pub plan: Plan,
    pub run: SingleRun,
    pub ticks: Vec<State>,
    pub arcs: Vec<(Arc, State)>,
    pub end: Option<f64>,
}

impl FlownLoop {
    pub fn new(text: &str, sample: u64) -> Self {
        let plan = plan(&without(text, &["[[require]]"]));
        let first = single(&plan, sample);
        let period = plan.law.as_ref().and_then(|law| law.spec()).unwrap().period;
        let duration = plan.grid.duration();
        let end = first.arcs.last().filter(|arc| arc.applied.ends_run).map(|arc| arc.start);
        let ticks: Vec<f64> = (0..)
            .map(|tick| f64::from(tick) * period)
            .take_while(|time| *time < duration - SAME_TIME && end.is_none_or(|end| *time < end + SAME_TIME))
            .collect();
        let mut times: Vec<f64> = ticks.iter().copied().chain(first.arcs.iter().map(|arc| arc.start)).collect();
        times.push(duration);
        times.sort_by(f64::total_cmp);
        times.dedup_by(|later, earlier| *later - *earlier < SAME_TIME);
        *times.last_mut().unwrap() = duration;
        let run = single_on(&plan, sample, Grid::at(times));
        assert!(run.arcs == first.arcs, "the arcs do not depend on what is observed");
        let state = |time: f64| state_at(&run, time);
        let arcs = run.arcs.iter().filter(|arc| !arc.applied.ends_run).map(|arc| (*arc, state(arc.start))).collect();
        FlownLoop { ticks: ticks.into_iter().map(state).collect(), arcs, end, plan, run }
    }

    pub fn spec(&self) -> &LoopSpec {
        self.plan.law.as_ref().and_then(|law| law.spec()).unwrap()
    }

    pub fn control(&self, key: &str) -> f64 {
        self.plan.nominal.control.named(key).map_or(0.0, |numbers| numbers[0])
    }

    pub fn guidance(&self, place: usize, key: &str) -> Option<&[f64]> {
        self.plan.nominal.control.guidance[place].named(key)
    }

    fn place(&self, name: &str) -> usize {
        let quantities = &self.run.telemetry.quantities;
        quantities.iter().position(|one| one.name() == name).unwrap_or_else(|| panic!("no {name} in the telemetry"))
    }

    pub fn told(&self, name: &str) -> Vec<f64> {
        let place = self.place(name);
        let rows = self.run.telemetry.rows.iter().zip(&self.run.telemetry.times);
        rows.filter(|(_, time)| **time < self.plan.grid.duration() - SAME_TIME).map(|(row, _)| row[place]).collect()
    }

    pub fn told_vector<const N: usize>(&self, name: &str) -> Vec<[f64; N]> {
        let letters = if N == 4 { ["w", "x", "y", "z"] } else { ["x", "y", "z", ""] };
        let columns: [Vec<f64>; N] = from_fn(|i| self.told(&name.replace('#', letters[i])));
        (0..columns[0].len()).map(|tick| columns.each_ref().map(|column| column[tick])).collect()
    }
}

fn state_at(run: &SingleRun, time: f64) -> State {
    let times = run.grid.times();
    let point = times.partition_point(|other| *other < time - SAME_TIME);
    assert!((times[point] - time).abs() < SAME_TIME, "{time} is observed");
    let at = |field| run.table.at::<3>(field, point);
    let debris = run.scene.mass.debris.is_some().then(|| Debris {
        r_gdo_e: at(StateField::DebrisPosition),
        v_gdo_e: at(StateField::DebrisVelocity),
        q_ed: run.table.at(StateField::DebrisAttitude, point),
        omega_de_d: at(StateField::DebrisRate),
    });
    let wheels = 0..run.scene.mass.wheels.len();
    State {
        time,
        q_es: run.table.at(StateField::Attitude, point),
        omega_se_s: at(StateField::Rate),
        r_co_e: at(StateField::ComPosition),
        v_co_e: at(StateField::ComVelocity),
        wheel_rates: wheels.map(|wheel| run.table.column(StateField::WheelRates, wheel)[point]).collect(),
        debris,
    }
}

pub fn changed(text: &str, changes: &[(&str, &str)]) -> String {
    changes.iter().fold(text.to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replace(from, to)
    })
}

pub fn without_filters(text: &str, estimator: &str) -> String {
    let text = changed(text, &[("estimator = \"mekf\"", &format!("estimator = \"{estimator}\""))]);
    let of_filters = ["initial_", "debris_position_sigma", "debris_velocity_sigma"];
    let is_kept = |line: &&str| !of_filters.iter().any(|start| line.starts_with(start) && line.contains("_sigma_"));
    text.lines().filter(is_kept).collect::<Vec<_>>().join("\n") + "\n"
}

pub fn angle_between(a: [f64; 3], b: [f64; 3]) -> f64 {
    let size = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let [a, b] = [a, b].map(|v| v.map(|x| x / size(v)));
    // W. Kahan: accurate at any angle
    let [apart, together] = [-1.0, 1.0].map(|sign| size(from_fn(|i| a[i] + sign * b[i])));
    2.0 * apart.atan2(together)
}

pub fn rotation_vector(q: [f64; 4]) -> [f64; 3] {
    let [w, x, y, z] = if q[0] < 0.0 { q.map(|x| -x) } else { q };
    let sine = (x * x + y * y + z * z).sqrt();
    let factor = if sine > 0.0 { 2.0 * sine.atan2(w) / sine } else { 2.0 };
    [factor * x, factor * y, factor * z]
}
