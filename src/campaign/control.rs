//! `[control]`, `[[sensors]]`, `[[guidance]]`: a control loop as a campaign file says it, and as canonical text.

use super::lines::Lines;
use super::numbers::{NumberLimit, POSITIVE};
use super::section::Section;
use super::size::MOST_TABLES;
use super::tables::{read_keys, read_name};
use crate::control::actuators::modulation;
use crate::control::guidance::phase::{MANEUVERS, Maneuver, Next};
use crate::control::guidance::situation::Condition;
use crate::control::guidance::target::{TARGETS, Target};
use crate::control::spec::{LoopSpec, ModelSpec, PhaseSpec, SensorSpec};
use crate::control::{ControlLaw, estimators, laws, parameters, sensors};
use crate::scene::schema::control::kept;
use crate::scene::table::Table;
use crate::scene::{DeclaredTable, Name, SceneInput, WheelMode};

/// Zero or above.
const NOT_NEGATIVE: NumberLimit = NumberLimit {
    allowed: "a number of at least 0",
    remedy: "write zero or a positive number",
    test: |x| x.is_finite() && x >= 0.0,
};

/// Most ticks of a sensor in a control period, and of a latency.
const MOST_TICKS: f64 = 1000.0;
/// Most phases.
const MOST_PHASES: usize = 64;

/// The law that may have the term omega x H or not.
const GYROSCOPIC: &str = "mrp_feedback";

/// The word that stands for the launch of the net where a phase stands else.
const LAUNCH: &str = "launch";

/// Reads the control loop of a file that has `[control]`; its numbers become parameters of `scene`. `None` where something is wrong.
pub(super) fn read(root: &mut Section<'_, '_>, scene: &mut SceneInput) -> Option<ControlLaw> {
    let has_debris = scene.debris.is_some();
    let mut section = root.section("control");
    section.require("period_s", POSITIVE.allowed, "0.1");
    let period = section.number("period_s", POSITIVE);
    let names = estimators::KINDS.iter().map(|kind| kind.name).collect::<Vec<_>>();
    let estimator =
        section.name("estimator", &names, |name| names.iter().position(|known| *known == name)).unwrap_or(0);
    let modulation = section
        .name("modulation", &modulation::NAMES, |name| modulation::NAMES.iter().position(|known| *known == name))
        .unwrap_or(0);
    let wheels = actuators(&mut section, "wheels", &turning(scene), "free wheels");
    let thrusters: Vec<Option<Name>> = scene.thrusters.iter().map(|thruster| Some(thruster.name)).collect();
    let thrusters = actuators(&mut section, "thrusters", &thrusters, "thrusters");
    if wheels.is_empty() && thrusters.is_empty() && !section.has("wheels") && !section.has("thrusters") {
        let remedy = "add wheels = [\"w1\"] or thrusters = [\"p1\"] to [control]";
        let path = section.path("wheels");
        section.document.add(&path, None, "the names of the wheels that the loop drives, or thrusters", remedy);
    }
    let holds_force = section.flag("hold_force").unwrap_or(false);
    for key in ["modulation", "hold_force"] {
        if thrusters.is_empty() && section.has(key) {
            section.refuse(key, "left out in a loop without thrusters", "add thrusters = [...], or delete this line");
        }
    }
    check_valves(&mut section, scene, (&thrusters, modulation), period);
    let mut lists = vec![&parameters::LOOP[..], estimators::KINDS[estimator].parameters];
    if !thrusters.is_empty() {
        lists.extend([&parameters::THRUSTERS[..], modulation::parameters(modulation)]);
    }
    if has_debris {
        lists.push(&parameters::DEBRIS);
    }
    scene.control.law = DeclaredTable::of(Name::NONE, kept(&lists));
    read_keys(&mut section, Table::Control, 0, scene);
    let model = read_model(&mut section);
    section.finish();

    let sensors = root.sections("sensors", MOST_TABLES, |section| read_sensor(section, scene, period));
    check_sensors(root, &sensors, estimator, [has_debris, !wheels.is_empty()]);
    let mut taken = Vec::new();
    let phases =
        root.sections("guidance", MOST_PHASES, |section| read_phase(section, scene, !thrusters.is_empty(), &mut taken));
    if phases.is_empty() && !root.has("guidance") {
        let content = "the phases of the mission, at least one";
        let remedy =
            "add a [[guidance]] table with phase = \"hold\", law = \"quaternion_feedback\", target = \"attitude\"";
        root.document.add("guidance", None, content, remedy);
    }
    let phases = connected(root, phases, &taken);
    let spec = LoopSpec {
        period: period?,
        estimator,
        wheels,
        thrusters,
        modulation,
        holds_force,
        sensors: sensors.into_iter().collect::<Option<_>>()?,
        phases: phases?,
        model,
        has_debris,
        wheel_names: scene
            .wheels
            .iter()
            .filter(|wheel| wheel.mode != WheelMode::Locked)
            .map(|wheel| wheel.name)
            .collect(),
        thruster_names: scene.thrusters.iter().map(|thruster| thruster.name).collect(),
    };
    (!spec.phases.is_empty()).then(|| ControlLaw::closed_loop(spec))
}

/// The wheels that turn, in their order: the name of those that a loop may drive.
fn turning(scene: &SceneInput) -> Vec<Option<Name>> {
    let turning = scene.wheels.iter().filter(|wheel| wheel.mode != WheelMode::Locked);
    turning.map(|wheel| (wheel.mode == WheelMode::Free).then_some(wheel.name)).collect()
}

/// The places of the actuators that `key` names, ascending; `known` are those that are there, `None` where one cannot be driven.
fn actuators(section: &mut Section<'_, '_>, key: &str, known: &[Option<Name>], what: &str) -> Vec<usize> {
    if !section.has(key) {
        section.know(key);
        return Vec::new();
    }
    let names: Vec<&str> = known.iter().flatten().map(Name::as_str).collect();
    if names.is_empty() {
        section.know(key);
        section.refuse(key, format!("left out where the scene has no {what}"), "delete it");
        return Vec::new();
    }
    let place = |text: &str| known.iter().position(|name| name.is_some_and(|name| name.as_str() == text));
    let mut places = section.names(key, &names, place, "none").unwrap_or_default();
    places.sort_unstable();
    places
}

/// Notes which thrusters cannot be driven as `modulation` says.
fn check_valves(
    section: &mut Section<'_, '_>,
    scene: &SceneInput,
    (thrusters, modulation): (&[usize], usize),
    period: Option<f64>,
) {
    if !modulation::is_on_off(modulation) {
        return;
    }
    for thruster in thrusters.iter().map(|place| &scene.thrusters[*place]) {
        let path = |key: &str| format!("thrusters.{}.{key}", thruster.name);
        if thruster.max_thrust_n.is_none() {
            let allowed =
                format!("the thrust while it is on, where control.modulation is {:?}", modulation::NAMES[modulation]);
            section.document.add(&path("max_thrust_n"), None, allowed, "add max_thrust_n = 10.0 to this thruster");
        }
        if let (Some(least), Some(period)) = (thruster.min_on_time_s, period)
            && least > period
        {
            let allowed = format!("at most control.period_s ({period:?})");
            section.document.add(
                &path("min_on_time_s"),
                Some(format!("{least:?}")),
                allowed,
                "write a shorter time, or a longer period",
            );
        }
    }
}

/// `[control.model]`.
fn read_model(section: &mut Section<'_, '_>) -> ModelSpec {
    let mut model = section.section("model");
    let mass = model.number("mass_kg", POSITIVE);
    let mut center = [0.0; 3];
    let center = model.fill("center_of_mass_m", &mut center, crate::scene::schema::Limit::Finite).then_some(center);
    let mut inertia = [0.0; 9];
    let has_inertia = model.fill("inertia_kg_m2", &mut inertia, crate::scene::schema::Limit::Inertia);
    let inertia = has_inertia.then(|| std::array::from_fn(|i| std::array::from_fn(|j| inertia[3 * i + j])));
    model.finish();
    ModelSpec { mass, center, inertia }
}

/// One table of `[[sensors]]`.
fn read_sensor(section: &mut Section<'_, '_>, scene: &mut SceneInput, period: Option<f64>) -> Option<SensorSpec> {
    let taken: Vec<Name> = scene.control.sensors.iter().map(|sensor| sensor.name).collect();
    let name = read_name(section, Table::Sensors, &taken);
    let names: Vec<&str> = sensors::KINDS.iter().map(|kind| kind.name).collect();
    section.require("kind", &format!("one of {}", names.join(", ")), "\"rate_gyro\"");
    let seen: Vec<&str> =
        names.iter().copied().filter(|name| scene.debris.is_some() || *name != "relative_camera").collect();
    let kind = section.name("kind", &seen, |name| names.iter().position(|known| *known == name));
    let own_period = section.number("period_s", POSITIVE).or(period);
    let latency = section.number("latency_s", NOT_NEGATIVE).unwrap_or(0.0);
    scene.control.sensors.push(DeclaredTable::of(name, kind.map_or(&[], |kind| sensors::KINDS[kind].parameters)));
    let Some(kind) = kind else {
        // its keys are not known
        return None;
    };
    let place = scene.control.sensors.len() - 1;
    read_keys(section, Table::Sensors, place, scene);
    section.finish();
    let (period, own) = (period?, own_period?);
    let is_whole = |ratio: f64| (ratio - ratio.round()).abs() < 1e-9 * ratio.max(1.0) && ratio.round() >= 1.0;
    let is_near = period / own <= MOST_TICKS && own / period <= 1e9;
    if !is_near || !is_whole(own / period) && !is_whole(period / own) {
        let allowed = format!("a whole multiple of control.period_s ({period:?}), or a whole fraction of it");
        section.refuse("period_s", allowed, format!("write {:?}", (own / period).round().max(1.0) * period));
        return None;
    }
    if latency > 0.0 && !sensors::KINDS[kind].has_latency {
        section.refuse("latency_s", "left out: this sensor delivers at once", "delete this line");
        return None;
    }
    if latency > 0.0 && !(is_whole(latency / period) && latency / period <= MOST_TICKS) {
        let allowed = format!("a whole multiple of control.period_s ({period:?}), at most {MOST_TICKS} of it");
        section.refuse("latency_s", allowed, format!("write {:?}", (latency / period).round().max(1.0) * period));
        return None;
    }
    Some(SensorSpec { name, kind, period: own, latency })
}

/// Notes what the estimator lacks.
fn check_sensors(
    root: &mut Section<'_, '_>,
    sensors: &[Option<SensorSpec>],
    estimator: usize,
    [has_debris, has_wheels]: [bool; 2],
) {
    let kinds: Vec<&str> = sensors.iter().flatten().map(|sensor| sensors::KINDS[sensor.kind].name).collect();
    if sensors.iter().any(Option::is_none) {
        return;
    }
    let name = estimators::KINDS[estimator].name;
    let mut needed = if name == "perfect" { Vec::new() } else { vec!["star_tracker"] };
    needed.extend((name != "perfect" && has_debris).then_some("ground_radar"));
    needed.extend((name == "raw" && has_wheels).then_some("tachometers"));
    // ticks of all sensors are those of the fastest
    let fastest = sensors.iter().flatten().map(|sensor| sensor.period).fold(f64::INFINITY, f64::min);
    for sensor in sensors.iter().flatten() {
        let ratio = sensor.period / fastest;
        if (ratio - ratio.round()).abs() > 1e-9 * ratio {
            let allowed = format!("a whole multiple of the shortest period of a sensor ({fastest:?} s)");
            let path = format!("sensors.{}.period_s", sensor.name);
            root.document.add(&path, Some(format!("{:?}", sensor.period)), allowed, "write another period");
        }
    }
    for kind in needed.iter().filter(|kind| !kinds.contains(kind)) {
        let allowed = format!("\"perfect\" without a sensor of kind {kind:?}, which this estimator needs");
        let remedy = format!("add a [[sensors]] table with kind = {kind:?}, or write estimator = \"perfect\"");
        root.document.add("control.estimator", Some(format!("{name:?}")), allowed, remedy);
    }
}

/// A phase as read: what follows it is a word until all phases are known.
struct ReadPhase {
    spec: PhaseSpec,
    next: Option<String>,
    otherwise: Option<String>,
}

/// One table of `[[guidance]]`; its name joins `taken`.
fn read_phase(
    section: &mut Section<'_, '_>,
    scene: &mut SceneInput,
    has_thrusters: bool,
    taken: &mut Vec<Name>,
) -> Option<ReadPhase> {
    section.require("phase", Name::ALLOWED, "\"hold\"");
    let name = section.text("phase").map(|text| (text, Name::new(text)));
    let name = match name {
        Some((text, Some(name))) if text != LAUNCH && !taken.contains(&name) => Some(name),
        Some((_, None)) => {
            section.refuse("phase", Name::ALLOWED, "write a name such as \"aim\"");
            None
        }
        Some(_) => {
            section.refuse(
                "phase",
                "another name than that of the other phases, and than \"launch\"",
                "give each its own name",
            );
            None
        }
        None => None,
    };
    // a table without a name of its own keeps its place in the list
    let own = name.unwrap_or_else(|| Name::number(taken.len()));
    taken.push(own);
    if name.is_some() {
        section.rename("guidance", own.as_str());
    }
    let has_debris = scene.debris.is_some();
    let law_names: Vec<&str> = laws::KINDS.iter().map(|kind| kind.name).collect();
    let law = section.name("law", &law_names, |name| law_names.iter().position(|known| *known == name));
    let gyroscopic = section.flag("gyroscopic").unwrap_or(false);
    let has_gyroscopic = law.is_some_and(|law| laws::KINDS[law].name == GYROSCOPIC);
    if section.has("gyroscopic") && !has_gyroscopic {
        section.refuse("gyroscopic", format!("left out where the law is not {GYROSCOPIC:?}"), "delete this line");
    }
    let targets: Vec<(&str, Target)> =
        TARGETS.into_iter().filter(|(_, target)| has_debris || !target.needs_debris()).collect();
    let names: Vec<&str> = targets.iter().map(|(name, _)| *name).collect();
    let target =
        section.name("target", &names, |name| targets.iter().find(|(known, _)| *known == name).map(|one| one.1));
    let target = target.unwrap_or(Target::None);
    let thrust = section.name("thrust", &MANEUVERS.map(|(name, _)| name), |name| {
        MANEUVERS.iter().find(|(known, _)| *known == name).map(|one| one.1)
    });
    let thrust = thrust.unwrap_or(Maneuver::None);
    if thrust != Maneuver::None && !(has_thrusters && has_debris) {
        let allowed = "\"none\" in a loop without thrusters, or without debris";
        section.refuse(
            "thrust",
            allowed,
            "add thrusters = [...] to [control] and a [debris] table, or delete this line",
        );
    }
    if matches!((target, thrust), (Target::Transfer, Maneuver::Stop) | (Target::Stop, Maneuver::Transfer)) {
        section.refuse(
            "thrust",
            "\"none\", or what the target is for",
            "write the same word, or target = \"velocity\"",
        );
    }
    if section.has("hold_s") && !section.has("until") {
        section.know("hold_s");
        section.refuse("hold_s", "left out without `until`", "add until = \"...\", or delete this line");
    }
    let until = section.text("until");
    let until = until.and_then(|text| match Condition::parse(text, has_debris) {
        Ok(condition) => Some(condition),
        Err(allowed) => {
            section.refuse("until", allowed, "write it like \"body_rate_rad_s < 0.002\"");
            None
        }
    });
    let next = section.text("next").map(str::to_owned);
    let otherwise = section.text("otherwise").map(str::to_owned);
    for key in ["next", "otherwise"] {
        if section.has(key) && !section.has("until") {
            section.refuse(key, "left out without `until`", "add until = \"...\", or delete this line");
        }
    }
    let mut lists = parameters::of_phase(target, thrust, [section.has("until"), has_thrusters]);
    lists.extend(law.map(|law| laws::KINDS[law].parameters));
    scene.control.guidance.push(DeclaredTable::of(own, kept(&lists)));
    let place = scene.control.guidance.len() - 1;
    read_keys(section, Table::Guidance, place, scene);
    section.finish();
    let spec = PhaseSpec { name: own, law, gyroscopic, target, thrust, until, next: Next::Stay, otherwise: None };
    name.map(|_| ReadPhase { spec, next, otherwise })
}

/// The phases with what follows them. One with a condition and without `next` is followed by the next in the list.
fn connected(root: &mut Section<'_, '_>, phases: Vec<Option<ReadPhase>>, names: &[Name]) -> Option<Vec<PhaseSpec>> {
    let place = |word: &str| names.iter().position(|name| name.as_str() == word);
    let mut list = Vec::with_capacity(phases.len());
    let count = phases.len();
    let mut is_whole = true;
    for (index, phase) in phases.into_iter().enumerate() {
        let Some(ReadPhase { mut spec, next, otherwise }) = phase else {
            is_whole = false;
            continue;
        };
        let mut unknown = |key: &str, word: &str, also: &str| {
            let known: Vec<&str> = names.iter().map(Name::as_str).collect();
            let allowed = format!("the name of a phase ({}){also}", known.join(", "));
            let path = format!("guidance.{}.{key}", spec.name);
            root.document.add(&path, Some(format!("{word:?}")), allowed, "write the name of another phase");
            is_whole = false;
        };
        match next.as_deref() {
            Some(LAUNCH) => spec.next = Next::Launch,
            Some(word) => match place(word) {
                Some(place) => spec.next = Next::Phase(place),
                None => unknown("next", word, " or \"launch\""),
            },
            None if spec.until.is_some() && index + 1 < count => spec.next = Next::Phase(index + 1),
            None => {}
        }
        if let Some(word) = otherwise.as_deref() {
            match place(word) {
                Some(place) => spec.otherwise = Some(place),
                None => unknown("otherwise", word, ""),
            }
        }
        list.push(spec);
    }
    is_whole.then_some(list)
}

/// The loop `spec` as canonical text; `scene` has its numbers.
pub(super) fn write(spec: &LoopSpec, scene: &SceneInput, lines: &mut Lines) {
    lines.table("[control]");
    lines.key("period_s", spec.period);
    lines.key("estimator", estimators::KINDS[spec.estimator].name);
    let named = |places: &[usize], names: &[Name]| places.iter().map(|place| names[*place]).collect::<Vec<_>>();
    if !spec.wheels.is_empty() {
        lines.key("wheels", named(&spec.wheels, &spec.wheel_names));
    }
    if !spec.thrusters.is_empty() {
        lines.key("thrusters", named(&spec.thrusters, &spec.thruster_names));
        lines.key("modulation", modulation::NAMES[spec.modulation]);
        lines.key("hold_force", spec.holds_force);
    }
    lines.keys(Table::Control, 0, scene);
    let ModelSpec { mass, center, inertia } = &spec.model;
    if mass.is_some() || center.is_some() || inertia.is_some() {
        lines.table("[control.model]");
        if let Some(mass) = mass {
            lines.key("mass_kg", mass);
        }
        if let Some(center) = center {
            lines.key("center_of_mass_m", center);
        }
        if let Some(inertia) = inertia {
            lines.key("inertia_kg_m2", inertia);
        }
    }
    for (place, sensor) in spec.sensors.iter().enumerate() {
        lines.table("[[sensors]]");
        lines.key("name", sensor.name);
        lines.key("kind", sensors::KINDS[sensor.kind].name);
        lines.key("period_s", sensor.period);
        if sensor.latency > 0.0 {
            lines.key("latency_s", sensor.latency);
        }
        lines.keys(Table::Sensors, place, scene);
    }
    for (place, phase) in spec.phases.iter().enumerate() {
        lines.table("[[guidance]]");
        lines.key("phase", phase.name);
        if let Some(law) = phase.law {
            lines.key("law", laws::KINDS[law].name);
            if laws::KINDS[law].name == GYROSCOPIC {
                lines.key("gyroscopic", phase.gyroscopic);
            }
        }
        lines.key(
            "target",
            TARGETS.iter().find(|(_, target)| same_kind(*target, phase.target)).map_or("none", |one| one.0),
        );
        lines.key(
            "thrust",
            MANEUVERS.iter().find(|(_, maneuver)| *maneuver == phase.thrust).map_or("none", |one| one.0),
        );
        if let Some(until) = &phase.until {
            lines.text_key("until", &until.text);
            match phase.next {
                Next::Launch => lines.key("next", LAUNCH),
                Next::Phase(next) => lines.key("next", spec.phases[next].name),
                Next::Stay => {}
            }
            if let Some(other) = phase.otherwise {
                lines.key("otherwise", spec.phases[other].name);
            }
        }
        lines.keys(Table::Guidance, place, scene);
    }
}

/// Whether both are the same target, whatever the attitude.
fn same_kind(a: Target, b: Target) -> bool {
    std::mem::discriminant(&a) == std::mem::discriminant(&b)
}
