//! Live numbers of the replay, and the marks on its slider.

use serde_json::{Value, json};

use crate::campaign::Plan;
use crate::campaign::event::Event;
use crate::ensemble::{SingleRun, surroundings};
use crate::findings::{loss, names};
use crate::math::vector::{difference, norm};
use crate::observables::Series;
use crate::report::over_time::control::impulse;
use crate::report::page::payload::Payload;
use crate::run::StateField;

/// Values below this share of the maximum over the run are rounding errors.
const ROUND_OFF: f64 = 1e-12;

struct LiveNumber {
    name: String,
    /// Column that determines the unit.
    column: String,
    unit: &'static str,
    components: Vec<String>,
    /// Held until the next point, as values at the ticks of a loop are.
    is_held: bool,
    /// Words for zero, values between, and one, instead of numbers.
    words: Option<[&'static str; 3]>,
    /// SI, component by component at each point.
    values: Vec<f64>,
}

impl LiveNumber {
    fn new(name: impl Into<String>, column: impl Into<String>, unit: &'static str, values: Vec<f64>) -> Self {
        let (name, column) = (name.into(), column.into());
        LiveNumber { name, column, unit, components: Vec::new(), is_held: false, words: None, values }
    }
}

fn of_row(row: &[(String, f64)], name: &str) -> Option<f64> {
    row.iter().find(|(column, _)| column == name).map(|(_, value)| *value).filter(|value| value.is_finite())
}

/// The quantities over the first `points` points of `run`.
pub fn numbers(
    plan: &Plan,
    (run, row): (&SingleRun, &[(String, f64)]),
    points: usize,
    payload: &mut Payload,
) -> Vec<Value> {
    let shown = |mut number: LiveNumber| {
        let largest = number.values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        number.values.iter_mut().filter(|value| value.abs() < ROUND_OFF * largest).for_each(|value| *value = 0.0);
        let unit = plan.analysis.display.of(&number.column, number.unit);
        let mut shown = json!({
            "name": number.name, "unit": unit.unit, "factor": unit.value(1.0), "components": number.components,
            "held": number.is_held, "values": payload.singles(&number.values)
        });
        if let Some(words) = number.words {
            shown["words"] = json!(words);
        }
        shown
    };
    let list = [
        pointing_error(run, points),
        Some(rate(run, points)),
        wheel_speeds(run, points),
        propellant((run, row), points),
    ];
    list.into_iter().flatten().chain(approach(run, points)).chain(sunlight(run, points)).map(shown).collect()
}

fn pointing_error(run: &SingleRun, points: usize) -> Option<LiveNumber> {
    let (_, values) = run.series.iter().find(|(series, _)| *series == Series::PointingError)?;
    let quantity = Series::PointingError.quantity(&run.request.wheels)?;
    let values = values[..points.min(values.len())].to_vec();
    let number = LiveNumber::new(names::title(&quantity), quantity.name(), "rad", values);
    number.values.iter().any(|value| value.is_finite()).then_some(LiveNumber { is_held: true, ..number })
}

fn rate(run: &SingleRun, points: usize) -> LiveNumber {
    let values = (0..points).flat_map(|point| run.table.at::<3>(StateField::Rate, point)).collect();
    let number = LiveNumber::new("Angular velocity", "angular_rate_rad_s", "rad/s", values);
    LiveNumber { components: ["s1", "s2", "s3"].map(str::to_owned).to_vec(), ..number }
}

fn wheel_speeds(run: &SingleRun, points: usize) -> Option<LiveNumber> {
    let wheels = &run.request.wheels;
    let column = format!("rate_{}_rad_s", wheels.first()?);
    let at = |point: usize| (0..wheels.len()).map(move |wheel| run.table.column(StateField::WheelRates, wheel)[point]);
    let number = LiveNumber::new("Wheel speed", column, "rad/s", (0..points).flat_map(at).collect());
    Some(LiveNumber { components: wheels.iter().map(ToString::to_string).collect(), ..number })
}

/// Propellant used, scaled from the impulse by the totals of the row, or the impulse if the specific impulse is
/// unknown; `None` if no thruster fires.
fn propellant((run, row): (&SingleRun, &[(String, f64)]), points: usize) -> Option<LiveNumber> {
    let ratio = of_row(row, "propellant_kg").zip(of_row(row, "impulse_total_n_s"));
    let ratio = ratio.filter(|(_, impulse)| *impulse > 0.0).map(|(mass, impulse)| mass / impulse);
    let mut used = impulse(run, &run.grid.times()[..points], |arc| arc.applied.thrust.iter().sum());
    if used.iter().all(|used| *used <= 0.0) {
        return None;
    }
    used.iter_mut().for_each(|used| *used *= ratio.unwrap_or(1.0));
    let (name, column, unit) = match ratio {
        Some(_) => ("Propellant used", "propellant_kg", "kg"),
        None => ("Impulse of the thrusters", "impulse_total_n_s", "N s"),
    };
    Some(LiveNumber::new(name, column, unit, used))
}

fn approach(run: &SingleRun, points: usize) -> Vec<LiveNumber> {
    let apart = |[a, b]: [StateField; 2]| -> Vec<f64> {
        (0..points).map(|point| norm(difference(run.table.at::<3>(a, point), run.table.at::<3>(b, point)))).collect()
    };
    let number = |(name, column, unit, fields): (&str, &str, &'static str, [StateField; 2])| {
        LiveNumber::new(name, column, unit, apart(fields))
    };
    let list = [
        ("Distance to the debris", "debris_distance_m", "m", [StateField::DebrisPosition, StateField::ComPosition]),
        ("Relative speed", "relative_speed_launch_m_s", "m/s", [StateField::DebrisVelocity, StateField::ComVelocity]),
    ];
    list.into_iter().filter(|_| run.request.debris).map(number).collect()
}

fn sunlight(run: &SingleRun, points: usize) -> Option<LiveNumber> {
    let number = LiveNumber::new("Sunlight", "sun_hidden_fraction", "", surroundings::hidden(run, points)?);
    Some(LiveNumber { is_held: true, words: Some(["full", "part shadow", "in shadow"]), ..number })
}

/// Times and names of the beginnings of phases, and of the end by mission or event.
pub fn marks(plan: &Plan, row: &[(String, f64)]) -> Vec<Value> {
    let begins = |name: &str| Some((of_row(row, &format!("phase_{name}_begin_s"))?, name.to_owned()));
    let spec = plan.law.as_ref().and_then(|law| law.spec());
    let phases = spec.iter().flat_map(|spec| &spec.phases);
    let mut marks: Vec<(f64, String)> = phases.filter_map(|phase| begins(phase.name.as_str())).collect();
    let end = of_row(row, "end_time_s").zip(loss::of_row(row));
    marks.extend(end.map(|(time, text)| (time, text.trim_start_matches("mission ").to_owned())));
    let ended_by =
        |event: &Event| Some((of_row(row, &format!("{}_time_s", event.name))?, format!("ended by {}", event.name)));
    marks.extend(plan.events.iter().filter(|event| event.ends_run).filter_map(ended_by));
    marks.sort_by(|a, b| a.0.total_cmp(&b.0));
    marks.into_iter().map(|(time, name)| json!({ "time": time, "name": name })).collect()
}
