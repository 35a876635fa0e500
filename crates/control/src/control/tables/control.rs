//! `[control]`: the control loop; [`super::sensors`] and [`super::phases`] read its sensors and phases.

use super::module::{self as module_key, ModuleKey};
use super::phases::{connected, read_phase};
use super::sensors::{check_sensors, read_sensor};
use crate::campaign::failure_tables::turning;
use crate::campaign::numbers::POSITIVE;
use crate::campaign::section::Section;
use crate::campaign::size::MOST_TABLES;
use crate::campaign::tables::{ignore_others, read_keys};
use crate::control::actuators::modulation;
use crate::control::loop_maker::closed_loop;
use crate::control::{estimators, parameters};
use crate::loops::attitude_law::LawKind;
use crate::loops::observes::Observes;
use crate::loops::rod_law::RodLaw;
use crate::loops::sensor_spec::SensorSpec;
use crate::loops::spec::{LoopSpec, PhaseSpec};
use crate::loops::{ControlLaw, launch_numbers};
use crate::math::symmetric::is_positive_definite;
use crate::sampling::keys::{ANY_TEXT, Condition, Kind, Row, Rule, Value, Written};
use crate::scene::schema::control::kept;
use crate::scene::table::Table;
use crate::scene::{BodyInput, DeclaredTable, Name, Scene, SceneError, SceneInput, WheelMode};

pub const MOST_PHASES: usize = 64;

/// The keys of `[control]` that are not parameters.
#[rustfmt::skip]
pub const ROWS: [Row; 9] = [
    Row::new("period_s", Kind::Number, "Control period").limited(POSITIVE).required_as(POSITIVE.allowed, "0.1"),
    Row::new("estimator", Kind::Word(&estimators::NAMES), "What estimates the state from measurements"),
    Row::new("wheels", Kind::Names, "The wheels that the loop drives"),
    Row::new("thrusters", Kind::Names, "The thrusters that the loop fires"),
    Row::new("modulation", Kind::Word(&modulation::NAMES), "How thrusters are fired"),
    Row::new("hold_force", Kind::Flag, "Whether thrusters keep a force of zero where no maneuver wants one; default: \
        false"),
    Row::new("torque_rods", Kind::Names, "The torque rods that the loop drives"),
    Row::new("module", Kind::Text(ANY_TEXT), "File of a WebAssembly module, which phases name as their law"),
    Row::new("module_sha256", Kind::Text(ANY_TEXT), "SHA-256 of that file"),
];

pub const RULES: [Rule; 2] = [
    Rule::Only {
        keys: &["modulation", "hold_force"],
        with: &[Condition::Has("thrusters")],
        allowed: "left out in a loop without thrusters",
        remedy: "add thrusters = [...], or delete this line",
    },
    module_key::RULE,
];

/// The keys of `[control.model]`.
pub const MODEL: [Row; 3] = [
    Row::new("mass_kg", Kind::Number, "Believed mass; default: the nominal one").limited(POSITIVE),
    Row::new("center_of_mass_m", Kind::Vector, "Believed centre of mass from p, in F_s; default: the nominal one"),
    Row::new(
        "inertia_kg_m2",
        Kind::Matrix,
        "Believed inertia about that centre with wheels locked, in F_s; default: the nominal one",
    ),
];

/// See [`crate::campaign::LoopTables::read`].
///
/// If a word on which other keys depend is wrong, these keys are read for all its values, so that no consequential
/// errors are reported.
pub(super) fn read(root: &mut Section<'_, '_>, scene: &mut SceneInput, own: Option<&LawKind>) -> Option<ControlLaw> {
    let has_debris = scene.debris.is_some();
    let craft = Scene::resolve(scene).ok();
    let mut section = root.section("control");
    let mut written = section.right_rows(&ROWS);
    let period = written.number("period_s");
    let place = |key: &str, names: &[&str]| names.iter().position(|name| written.text(key) == Some(name));
    let (estimator, modulation) = (place("estimator", &estimators::NAMES), place("modulation", &modulation::NAMES));
    let [thrusters, rods] =
        [Table::Thruster, Table::TorqueRod].map(|table| table.owners(scene).into_iter().map(Some).collect());
    let mut driven = |key, known: Vec<Option<Name>>, what| actuators(&mut section, &mut written, (key, what), &known);
    let wheels = driven("wheels", turning(scene), "free wheels");
    let thrusters = driven("thrusters", thrusters, "thrusters");
    let rods = driven("torque_rods", rods, "torque rods");
    let has_actuators = section.has("wheels") || section.has("thrusters") || section.has("torque_rods");
    if has_actuators {
        section.obeys(&RULES[0], true);
    } else {
        let remedy = "add wheels = [\"w1\"], thrusters = [\"p1\"] or torque_rods = [\"m1\"] to [control]";
        let path = section.path("wheels");
        let content = "the names of the wheels that the loop drives, or thrusters, or torque rods";
        section.document.add(&path, None, content, remedy);
    }
    let may_fire = !has_actuators || section.has("thrusters");
    let module = module_key::read(&mut section, &mut written);
    if let (Some(thrusters), Some(modulation)) = (&thrusters, modulation) {
        check_valves(&mut section, scene, (thrusters, modulation), period);
    }
    let of_estimators = estimators::KINDS.each_ref().map(|maker| (maker.kind.name, maker.kind.parameters));
    let of_modulations = [0, 1, 2].map(|place| (modulation::NAMES[place], modulation::parameters(place)));
    let mut lists = vec![&parameters::LOOP[..]];
    lists.extend(meant(estimator, of_estimators));
    if may_fire {
        lists.push(&parameters::THRUSTERS);
        lists.extend(meant(modulation, of_modulations));
    }
    if has_debris {
        lists.push(&launch_numbers::DEBRIS);
    }
    scene.control.law = DeclaredTable::of(Name::NONE, kept(&lists));
    read_keys(&mut section, Table::Control, 0, scene);
    let model = read_model(&mut section, craft.as_ref());
    ignore_others(&mut section, "estimator", estimator, of_estimators);
    if may_fire {
        ignore_others(&mut section, "modulation", modulation, of_modulations);
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
        read_phase(section, scene, ([may_fire, has_rods], &module, own), &mut taken)
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
            let kind = &module.code.kind;
            if phases.as_ref().is_some_and(|phases| phases.iter().all(|phase| phase.law.as_ref() != Some(kind))) {
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
        // a wrong period is reported already and does not change the columns
        period: period.unwrap_or(f64::NAN),
        estimator: &estimators::KINDS[estimator?].kind,
        estimator_maker: estimator?,
        wheels: wheels?,
        thrusters: thrusters?,
        rods: rods?,
        modulation: modulation?,
        holds_force: written.flag("hold_force"),
        sensors: sensors.into_iter().collect::<Option<_>>()?,
        module,
        phases: phases?,
        model,
        written: written.completed(&ROWS, &RULES),
        has_debris,
        wheel_names: scene
            .wheels
            .iter()
            .filter(|wheel| wheel.mode != WheelMode::Locked)
            .map(|wheel| wheel.name)
            .collect(),
        thruster_names: Table::Thruster.owners(scene),
        rod_names: Table::TorqueRod.owners(scene),
    };
    (has_actuators && !spec.phases.is_empty()).then(|| closed_loop(spec))
}

/// The second of the pair at `place`, or of all pairs if it is unknown.
fn meant<T, const N: usize>(place: Option<usize>, list: [(&str, T); N]) -> impl Iterator<Item = T> {
    list.into_iter().enumerate().filter(move |(kind, _)| place.is_none_or(|one| one == *kind)).map(|(_, (_, one))| one)
}

/// The indices, ascending, of the actuators that `key` names, whose names are set in `written`; `None` if they are
/// wrong. `known` has `None` for actuators that cannot be driven.
fn actuators(
    section: &mut Section<'_, '_>,
    written: &mut Written,
    (key, what): (&'static str, &str),
    known: &[Option<Name>],
) -> Option<Vec<usize>> {
    if !section.has(key) {
        return Some(Vec::new());
    }
    let names: Vec<&str> = known.iter().flatten().map(Name::as_str).collect();
    if names.is_empty() {
        return section.refused(key, format!("left out where the scene has no {what}"), "delete it");
    }
    let place = |text: &str| known.iter().position(|name| name.is_some_and(|name| name.as_str() == text));
    let mut places = section.names(key, &names, place, "none")?;
    places.sort_unstable();
    let name = |place: &usize| known[*place].map(|name| name.to_string());
    written.set(key, Value::Texts(places.iter().filter_map(name).collect()));
    Some(places)
}

/// Notes torque rods that the loop cannot drive, or leaves idle; it drives those at `driven`.
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
    if !sensors.iter().flatten().any(|sensor| matches!(sensor.kind.observes, Observes::Field(_))) {
        refuse(
            "left out in a loop without a sensor of kind \"magnetometer\", by which torque rods are driven",
            "add a [[sensors]] table with kind = \"magnetometer\"",
        );
    }
    if phases.iter().all(|phase| phase.rods == RodLaw::None) {
        refuse("left out in a loop without a phase that uses them", "add rods = \"b_dot\" to a [[guidance]] table");
    }
}

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

/// `[control.model]`; `craft` is the nominal scene if it is physical.
fn read_model(section: &mut Section<'_, '_>, craft: Option<&Scene>) -> Written {
    const KEY: &str = "inertia_kg_m2";
    let mut model = section.section("model");
    let written = model.right_rows(&MODEL);
    let inertia = written.matrix(KEY);
    if let Some(wrong) = inertia.and_then(impossible) {
        model.refuse(KEY, wrong.allowed, wrong.remedy);
    } else if let (Some(craft), Some(inertia)) = (craft, inertia)
        && !is_positive_definite(craft.mass.with_inertia(inertia).inertia_rotating())
    {
        let allowed = "the inertia with the wheels locked: more than the axial inertias of the wheels about their axes";
        model.refuse(KEY, allowed, "add the inertia of the wheels, or check units");
    }
    model.finish();
    written
}

/// Why `inertia`, about the centre of mass, is not physical.
fn impossible(inertia: [[f64; 3]; 3]) -> Option<SceneError> {
    let (mass_kg, center_of_mass_m, inertia_kg_m2) = (Some(1.0), Some([0.0; 3]), Some(inertia));
    let body = BodyInput { mass_kg, center_of_mass_m, inertia_kg_m2, ..BodyInput::DEFAULT };
    Scene::resolve(&SceneInput { body, ..SceneInput::blank() })
        .err()?
        .into_iter()
        .find(|error| error.key.ends_with("inertia_kg_m2"))
}
