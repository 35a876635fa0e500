//! `[control]`: a control loop as a campaign file says it, and as canonical text. Its sensors are read by
//! [`super::sensor_tables`], its phases by [`super::phase_tables`].

use super::lines::Lines;
use super::module_key::{self, ModuleKey};
use super::numbers::POSITIVE;
use super::phase_tables::{GYROSCOPIC, LAUNCH, connected, read_phase};
use super::section::Section;
use super::sensor_tables::{check_sensors, read_sensor};
use super::size::MOST_TABLES;
use super::tables::{ignore_others, read_keys};
use crate::control::actuators::modulation;
use crate::control::guidance::phase::{MANEUVERS, Next};
use crate::control::guidance::target::{TARGETS, Target};
use crate::control::laws::rod_law::{ROD_USES, RodUse};
use crate::control::observes::Observes;
use crate::control::sensor_spec::SensorSpec;
use crate::control::spec::{LoopSpec, ModelSpec, PhaseSpec};
use crate::control::{ControlLaw, estimators, net_launch, parameters, sensors};
use crate::math::symmetric::is_positive_definite;
use crate::scene::schema::Limit;
use crate::scene::schema::control::kept;
use crate::scene::table::Table;
use crate::scene::{BodyInput, DeclaredTable, Name, Scene, SceneError, SceneInput, WheelMode};

const MOST_PHASES: usize = 64;

/// Reads the control loop of a file that has `[control]`; its numbers become parameters of `scene`. `None` where
/// something is wrong.
///
/// Where a word that other keys depend on is wrong, these are read as if each were right, so that the file is told of
/// its own mistakes alone.
pub(super) fn read(root: &mut Section<'_, '_>, scene: &mut SceneInput) -> Option<ControlLaw> {
    let has_debris = scene.debris.is_some();
    let craft = Scene::resolve(scene).ok();
    let mut section = root.section("control");
    section.require("period_s", POSITIVE.allowed, "0.1");
    let period = section.number("period_s", POSITIVE);
    let estimator = choice(&mut section, "estimator", &estimators::KINDS.each_ref().map(|kind| kind.name));
    let modulation = choice(&mut section, "modulation", &modulation::NAMES);
    let wheels = actuators(&mut section, "wheels", &turning(scene), "free wheels");
    let thrusters: Vec<Option<Name>> = scene.thrusters.iter().map(|thruster| Some(thruster.name)).collect();
    let thrusters = actuators(&mut section, "thrusters", &thrusters, "thrusters");
    let rods: Vec<Option<Name>> = scene.torque_rods.iter().map(|rod| Some(rod.name)).collect();
    let rods = actuators(&mut section, "torque_rods", &rods, "torque rods");
    let has_actuators = section.has("wheels") || section.has("thrusters") || section.has("torque_rods");
    if !has_actuators {
        let remedy = "add wheels = [\"w1\"], thrusters = [\"p1\"] or torque_rods = [\"m1\"] to [control]";
        let path = section.path("wheels");
        let content = "the names of the wheels that the loop drives, or thrusters, or torque rods";
        section.document.add(&path, None, content, remedy);
    }
    let may_fire = !has_actuators || thrusters.as_ref().is_none_or(|places| !places.is_empty());
    let holds_force = section.flag("hold_force").unwrap_or(false);
    if !may_fire {
        for key in ["modulation", "hold_force"] {
            if section.has(key) {
                section.refuse(
                    key,
                    "left out in a loop without thrusters",
                    "add thrusters = [...], or delete this line",
                );
            }
        }
    }
    let module = module_key::read(&mut section);
    if let (Some(thrusters), Some(modulation)) = (&thrusters, modulation) {
        check_valves(&mut section, scene, (thrusters, modulation), period);
    }
    let mut lists = vec![&parameters::LOOP[..]];
    lists.extend(kinds(estimator, &estimators::KINDS).map(|kind| kind.parameters));
    if may_fire {
        lists.push(&parameters::THRUSTERS);
        lists.extend(
            (0..modulation::NAMES.len())
                .filter(|place| modulation.is_none_or(|one| one == *place))
                .map(modulation::parameters),
        );
    }
    if has_debris {
        lists.push(&net_launch::parameters::DEBRIS);
    }
    scene.control.law = DeclaredTable::of(Name::NONE, kept(&lists));
    read_keys(&mut section, Table::Control, 0, scene);
    let model = read_model(&mut section, craft.as_ref());
    ignore_others(
        &mut section,
        "estimator",
        estimator,
        estimators::KINDS.each_ref().map(|kind| (kind.name, kind.parameters)),
    );
    if may_fire {
        let names = modulation::NAMES;
        let of_others = [0, 1, 2].map(|place| (names[place], modulation::parameters(place)));
        ignore_others(&mut section, "modulation", modulation, of_others);
    }
    section.finish();

    let has_rods = rods.as_ref().is_none_or(|places| !places.is_empty());
    let sensors = root.sections("sensors", MOST_TABLES, |section| read_sensor(section, scene, period));
    if let Some(estimator) = estimator {
        let has_wheels = wheels.as_ref().is_none_or(|places| !places.is_empty());
        check_sensors(root, &sensors, (estimator, period), [has_debris, has_wheels, has_rods]);
    }
    let mut taken = Vec::new();
    let phases = root.sections("guidance", MOST_PHASES, |section| {
        read_phase(section, scene, ([may_fire, has_rods], &module), &mut taken)
    });
    if phases.is_empty() && !root.has("guidance") {
        let content = "the phases of the mission, at least one";
        let remedy =
            "add a [[guidance]] table with phase = \"hold\", law = \"quaternion_feedback\", target = \"attitude\"";
        root.document.add("guidance", None, content, remedy);
    }
    let phases = connected(root, phases, &taken);
    if let (Some(rods), true, Some(phases)) = (&rods, sensors.iter().all(Option::is_some), &phases) {
        check_rods(root, scene, rods, (&sensors, phases));
    }
    let module = match (module, &phases) {
        (ModuleKey::Absent, _) => None,
        (ModuleKey::Wrong, _) => return None,
        (ModuleKey::Read(module), phases) => {
            let kind = module.code.kind();
            if phases.as_ref().is_some_and(|phases| phases.iter().all(|phase| phase.law != Some(kind))) {
                let allowed = "left out where no phase has law = \"module\"";
                let remedy = "write law = \"module\" in a [[guidance]] table, or delete this line";
                root.document.add("control.module", Some(format!("{:?}", module.file)), allowed, remedy);
            }
            if sensors.iter().all(Option::is_some) {
                module_key::check_sensors(root, &module, &sensors);
            }
            Some(module)
        }
    };
    let spec = LoopSpec {
        // a wrong period is told, and the columns do not depend on it
        period: period.unwrap_or(f64::NAN),
        estimator: estimator?,
        wheels: wheels?,
        thrusters: thrusters?,
        rods: rods?,
        modulation: modulation?,
        holds_force,
        sensors: sensors.into_iter().collect::<Option<_>>()?,
        module,
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
        rod_names: scene.torque_rods.iter().map(|rod| rod.name).collect(),
    };
    (has_actuators && !spec.phases.is_empty()).then(|| ControlLaw::closed_loop(spec))
}

/// The place of the name that `key` has among `names`, the first where it was not written; `None` where it is wrong.
fn choice(section: &mut Section<'_, '_>, key: &str, names: &[&str]) -> Option<usize> {
    let found = section.name(key, names, |name| names.iter().position(|known| *known == name));
    if section.has(key) { found } else { Some(0) }
}

/// The kind of this place, or all of them where it is not known which is meant.
fn kinds<T>(place: Option<usize>, list: &[T]) -> impl Iterator<Item = &T> {
    list.iter().enumerate().filter(move |(kind, _)| place.is_none_or(|one| one == *kind)).map(|(_, kind)| kind)
}

/// The wheels that turn, in their order: the name of those that a loop may drive.
pub(super) fn turning(scene: &SceneInput) -> Vec<Option<Name>> {
    let turning = scene.wheels.iter().filter(|wheel| wheel.mode != WheelMode::Locked);
    turning.map(|wheel| (wheel.mode == WheelMode::Free).then_some(wheel.name)).collect()
}

/// The places of the actuators that `key` names, ascending; `known` are those that are there, `None` where one cannot
/// be driven. `None` where the names are wrong.
fn actuators(section: &mut Section<'_, '_>, key: &str, known: &[Option<Name>], what: &str) -> Option<Vec<usize>> {
    if !section.has(key) {
        section.know(key);
        return Some(Vec::new());
    }
    let names: Vec<&str> = known.iter().flatten().map(Name::as_str).collect();
    if names.is_empty() {
        section.know(key);
        section.refuse(key, format!("left out where the scene has no {what}"), "delete it");
        return None;
    }
    let place = |text: &str| known.iter().position(|name| name.is_some_and(|name| name.as_str() == text));
    let mut places = section.names(key, &names, place, "none")?;
    places.sort_unstable();
    Some(places)
}

/// Notes which torque rods the loop, which drives those at `driven`, cannot drive or does not.
fn check_rods(
    root: &mut Section<'_, '_>,
    scene: &SceneInput,
    driven: &[usize],
    (sensors, phases): (&[Option<SensorSpec>], &[PhaseSpec]),
) {
    let idle = (0..scene.torque_rods.len()).find(|place| !driven.contains(place));
    if let Some(name) = idle.map(|place| scene.torque_rods[place].name) {
        let allowed = "the name of one that the loop drives: nothing else does";
        let remedy = format!("add {:?} to control.torque_rods, or delete the table", name.as_str());
        root.document.add(&format!("torque_rods.{name}.name"), Some(format!("{:?}", name.as_str())), allowed, remedy);
    }
    if driven.is_empty() {
        return;
    }
    let mut refuse = |allowed: &str, remedy: &str| {
        let names: Vec<&str> = driven.iter().map(|place| scene.torque_rods[*place].name.as_str()).collect();
        root.document.add("control.torque_rods", Some(format!("{names:?}")), allowed, remedy);
    };
    if !sensors.iter().flatten().any(|sensor| matches!(sensor.observes(), Observes::Field(_))) {
        refuse(
            "left out in a loop without a sensor of kind \"magnetometer\", by which torque rods are driven",
            "add a [[sensors]] table with kind = \"magnetometer\"",
        );
    }
    if phases.iter().all(|phase| phase.rods == RodUse::None) {
        refuse("left out in a loop without a phase that uses them", "add rods = \"b_dot\" to a [[guidance]] table");
    }
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

/// `[control.model]`; `craft` is the nominal scene, where it is physical.
fn read_model(section: &mut Section<'_, '_>, craft: Option<&Scene>) -> ModelSpec {
    const KEY: &str = "inertia_kg_m2";
    let mut model = section.section("model");
    let mass = model.number("mass_kg", POSITIVE);
    let mut center = [0.0; 3];
    let center = model.fill("center_of_mass_m", &mut center, Limit::Finite).then_some(center);
    let mut inertia = [0.0; 9];
    let has_inertia = model.fill(KEY, &mut inertia, Limit::Inertia);
    let is_written = has_inertia && inertia.iter().all(|number| number.is_finite());
    let inertia = has_inertia.then(|| std::array::from_fn(|i| std::array::from_fn(|j| inertia[3 * i + j])));
    if let Some(wrong) = inertia.filter(|_| is_written).and_then(impossible) {
        model.refuse(KEY, wrong.allowed, wrong.remedy);
    } else if let (true, Some(craft), Some(inertia)) = (is_written, craft, inertia)
        && !is_positive_definite(craft.mass.with_inertia(inertia).inertia_rotating())
    {
        let allowed = "the inertia with the wheels locked: more than the axial inertias of the wheels about their axes";
        model.refuse(KEY, allowed, "add the inertia of the wheels, or check units");
    }
    model.finish();
    ModelSpec { mass, center, inertia }
}

/// Why no body has the inertia `inertia` about its centre of mass: what is said of that of the spacecraft.
fn impossible(inertia: [[f64; 3]; 3]) -> Option<SceneError> {
    let (mass_kg, center_of_mass_m, inertia_kg_m2) = (Some(1.0), Some([0.0; 3]), Some(inertia));
    let body = BodyInput { mass_kg, center_of_mass_m, inertia_kg_m2, ..BodyInput::DEFAULT };
    Scene::resolve(&SceneInput { body, ..SceneInput::blank() })
        .err()?
        .into_iter()
        .find(|error| error.key.ends_with("inertia_kg_m2"))
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
    if !spec.rods.is_empty() {
        lines.key("torque_rods", named(&spec.rods, &spec.rod_names));
    }
    if let Some(module) = &spec.module {
        lines.text_key("module", &module.file);
        lines.key("module_sha256", module.code.sha256());
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
            lines.key("law", law.name);
            if law.name == GYROSCOPIC {
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
        if let Some((name, _)) = ROD_USES.iter().find(|(_, used)| *used == phase.rods && phase.rods != RodUse::None) {
            lines.key("rods", name);
        }
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
