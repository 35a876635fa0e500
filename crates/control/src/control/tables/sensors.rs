//! `[[sensors]]`: the sensors of a control loop.

use crate::campaign::numbers::{NOT_NEGATIVE, POSITIVE};
use crate::campaign::section::Section;
use crate::campaign::tables::{read_keys, read_name};
use crate::control::{estimators, sensors};
use crate::loops::kinds::SensorKind;
use crate::loops::observes::Observes;
use crate::loops::sensor_spec::SensorSpec;
use crate::loops::spec::{MOST_TICKS, ticks_per_period};
use crate::sampling::keys::{ANY_TEXT, Kind, Presence, Row};
use crate::scene::table::Table;
use crate::scene::{DeclaredTable, Name, SceneInput};

/// The keys of `[[sensors]]` that are not parameters.
pub const ROWS: [Row; 4] = [
    Row::new("name", Kind::Text(ANY_TEXT), "Its name").required_as(Name::ALLOWED, "\"a1\""),
    Row::new("kind", Kind::Word(&sensors::NAMES), "What it measures").required_as("a kind", "\"rate_gyro\""),
    Row::new("period_s", Kind::Number, "Time between measurements; default: the control period").limited(POSITIVE),
    Row::new("latency_s", Kind::Number, "Time from a measurement to its delivery")
        .limited(NOT_NEGATIVE)
        .or(Presence::Or(0.0))
        .sparse(),
];

const MOST_PERIODS: f64 = 1e9;

pub(super) fn read_sensor(
    section: &mut Section<'_, '_>,
    scene: &mut SceneInput,
    period: Option<f64>,
) -> Option<SensorSpec> {
    let mut taken = Table::Sensors.owners(scene).into_iter().collect();
    let name = read_name(section, Table::Sensors, &mut taken);
    section.require("kind", &format!("one of {}", sensors::NAMES.join(", ")), "\"rate_gyro\"");
    let is_seen = |kind: &&SensorKind| scene.debris.is_some() || !kind.observes.needs_debris();
    let seen: Vec<&str> =
        sensors::KINDS.iter().map(|maker| &maker.kind).filter(is_seen).map(|kind| kind.name).collect();
    let maker = section.name("kind", &seen, |name| sensors::NAMES.iter().position(|known| *known == name));
    let kind = maker.map(|maker| &sensors::KINDS[maker].kind);
    let mut written = section.right_rows(&ROWS[2..]);
    let own_period = written.number("period_s").or(period);
    let latency = written.number("latency_s").unwrap_or(0.0);
    let declared = kind.map_or(&[][..], |kind| kind.parameters_in(scene));
    scene.control.sensors.push(DeclaredTable::of(name, declared));
    let (maker, kind) = (maker?, kind?);
    let place = scene.control.sensors.len() - 1;
    read_keys(section, Table::Sensors, place, scene);
    if let Some(key) = kind.replaced(scene).filter(|key| section.has(key)) {
        section.know(key);
        let allowed = "left out where [orbit] has an epoch: the Sun of the date is measured";
        section.refuse(key, allowed, "delete this line, or orbit.epoch");
    }
    section.finish();
    if latency > 0.0 && !kind.observes.has_latency() {
        section.refuse("latency_s", "left out: this sensor delivers at once", "delete this line");
    }
    if let (Some(period), Some(own)) = (period, own_period) {
        check_times(section, period, own, latency);
    }
    if let Some(need) = kind.needs.as_ref().filter(|need| !(need.is_met)(scene)) {
        let [allowed, remedy] = need.refusal;
        section.refuse("kind", allowed, remedy);
    }
    // a wrong number is reported already and does not change the columns
    let period = own_period.unwrap_or(f64::NAN);
    written = written.with("name", name.as_str()).with("kind", kind.name).with("period_s", period);
    Some(SensorSpec { name, kind, maker, period, latency, written: written.completed(&ROWS, &[]) })
}

/// Notes a period `own` or a `latency`, s, that does not fit the control `period`.
fn check_times(section: &mut Section<'_, '_>, period: f64, own: f64, latency: f64) {
    let is_near = period / own <= MOST_TICKS && own / period <= MOST_PERIODS;
    if !is_near || !is_whole(own / period) && !is_whole(period / own) {
        let near = if own < period {
            period / (period / own).round().clamp(1.0, MOST_TICKS)
        } else {
            (own / period).round().clamp(1.0, MOST_PERIODS) * period
        };
        let allowed = format!("a whole multiple of control.period_s ({period:?}), or a whole fraction of it");
        section.refuse("period_s", allowed, format!("write {:?}", plain(near)));
    }
    if latency > 0.0 && !(is_whole(latency / period) && latency / period <= MOST_TICKS) {
        let allowed = format!("a whole multiple of control.period_s ({period:?}), at most {MOST_TICKS} of it");
        let near = (latency / period).round().clamp(1.0, MOST_TICKS) * period;
        section.refuse("latency_s", allowed, format!("write {:?}", plain(near)));
    }
}

/// True if a ratio of two times is whole, up to rounding.
fn is_whole(ratio: f64) -> bool {
    (ratio - ratio.round()).abs() < 1e-9 * ratio.max(1.0) && ratio.round() >= 1.0
}

/// `number` without rounding of products: 0.3, not 0.30000000000000004.
fn plain(number: f64) -> f64 {
    format!("{number:.11e}").parse().unwrap_or(number)
}

/// Notes sensors that the estimator lacks, duplicates, and periods that do not fit together.
pub(super) fn check_sensors(
    root: &mut Section<'_, '_>,
    sensors: &[Option<SensorSpec>],
    (estimator, period): (usize, Option<f64>),
    [has_debris, has_wheels, has_rods]: [bool; 3],
) {
    if sensors.iter().any(Option::is_none) {
        return;
    }
    let kind = &estimators::KINDS[estimator].kind;
    let sensors: Vec<&SensorSpec> = sensors.iter().flatten().collect();
    for (place, sensor) in sensors.iter().enumerate() {
        let kind = sensor.kind;
        if let Some(first) =
            sensors[..place].iter().find(|first| kind.observes.at_most_one() && first.kind == sensor.kind)
        {
            let allowed = format!(
                "another kind: a loop has at most one sensor of kind {:?}, and that is {}",
                kind.name, first.name
            );
            let path = format!("sensors.{}.kind", sensor.name);
            root.document.add(&path, Some(format!("{:?}", kind.name)), allowed, "delete one of the two tables");
        }
    }
    if let Some(period) = period
        && !root.document.is_reported("sensors")
        && ticks_per_period(period, sensors.iter().map(|sensor| sensor.period)).is_none()
    {
        let fastest = sensors.iter().min_by(|a, b| a.period.total_cmp(&b.period));
        if let Some(fastest) = fastest {
            let allowed = format!(
                "such that all sensors measure at whole multiples of a tick, at most {MOST_TICKS} of which make \
                control.period_s ({period:?})"
            );
            let path = format!("sensors.{}.period_s", fastest.name);
            let remedy = "write periods of which the shorter one divides the longer one";
            root.document.add(&path, Some(format!("{:?}", fastest.period)), allowed, remedy);
        }
    }
    if kind.knows_the_truth {
        return;
    }
    let is_of_rods = |sensor: &SensorSpec| has_rods && matches!(sensor.kind.observes, Observes::Field(_));
    for sensor in sensors.iter().filter(|sensor| !is_of_rods(sensor) && !(kind.uses)(&sensor.kind.observes)) {
        let what = sensor.kind.observes.text();
        let allowed = format!("a kind that the estimator {:?} uses: it has no use for {what}", kind.name);
        let path = format!("sensors.{}.kind", sensor.name);
        let value = format!("{:?}", sensor.kind.name);
        root.document.add(&path, Some(value), allowed, "delete the table, or write another estimator");
    }
    type Meets = fn(&Observes) -> bool;
    let attitude: Meets =
        |observes| matches!(observes, Observes::Attitude(_) | Observes::Direction(_) | Observes::Field(_));
    let motion: Meets = |observes| matches!(observes, Observes::Motion(_));
    let wheel_rates: Meets = |observes| matches!(observes, Observes::WheelRates);
    for (is_needed, meets) in [(true, attitude), (has_debris, motion), (has_wheels && !kind.has_filter, wheel_rates)] {
        let meets = |observes: Observes| meets(&observes) && (kind.uses)(&observes);
        if !is_needed || sensors.iter().any(|sensor| meets(sensor.kind.observes)) {
            continue;
        }
        let able = sensors::KINDS.iter().filter(|maker| meets(maker.kind.observes));
        let able: Vec<String> = able.map(|maker| format!("{:?}", maker.kind.name)).collect();
        let able = able.join(" or ");
        let allowed = format!("\"perfect\" without a sensor of kind {able}, which this estimator needs");
        let remedy = format!("add a [[sensors]] table with kind = {able}, or write estimator = \"perfect\"");
        root.document.add("control.estimator", Some(format!("{:?}", kind.name)), allowed, remedy);
    }
}
