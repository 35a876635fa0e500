//! Data of the 3D replay: shapes of the bodies, and the thinned motion of each shown run.

use serde_json::{Value, json};

use crate::analysis::observed::Observed;
use crate::analysis::outcomes::outcomes;
use crate::campaign::Plan;
use crate::ensemble::SingleRun;
use crate::findings::names;
use crate::findings::scene::momentum as momentum_in_body;
use crate::loops::launch_geometry::LaunchState;
use crate::loops::launch_numbers::DebrisNumbers;
use crate::math::vector::{dcm_from_quaternion, difference, product};
use crate::report::page::payload::Payload;
use crate::report::page::readable::with_unit;
use crate::report::page::runs::ShownRun;
use crate::report::page::{live, sky};
use crate::run::StateField;
use crate::scene::unit_quaternion::unit_quaternion;
use crate::scene::{DebrisInput, PartInput, PartShape, Plate, Scene, SceneInput, WheelMode};

#[derive(Clone, Debug)]
pub struct ShownPart {
    pub name: String,
    /// As named in campaign files.
    pub shape: &'static str,
    /// Radius and length, or sides, m.
    pub size: Vec<f64>,
    /// Its centre in F_s, m.
    pub position: [f64; 3],
    /// Rotation from its own frame to F_s.
    pub turn: [[f64; 3]; 3],
}

pub fn shown_parts(plan: &Plan) -> Vec<ShownPart> {
    let input = &plan.nominal;
    if input.parts.is_empty() {
        Scene::resolve(input).iter().map(equivalent_box).collect()
    } else {
        input.parts.iter().map(part).collect()
    }
}

pub fn scene(plan: &Plan) -> Value {
    let (input, resolved) = (&plan.nominal, Scene::resolve(&plan.nominal).ok());
    let center = resolved.as_ref().map_or([0.0; 3], |scene| scene.mass.center);
    let part = |part: ShownPart| {
        json!({ "name": part.name, "shape": part.shape, "size": part.size,
        "position": part.position, "turn": part.turn })
    };
    let of_file = resolved.iter().filter(|_| !input.plates.is_empty());
    let plates: Vec<Value> = of_file.flat_map(|scene| &scene.plates).map(plate).collect();
    json!({
        "center": center,
        "is_equivalent": input.parts.is_empty(),
        "parts": shown_parts(plan).into_iter().map(part).collect::<Vec<_>>(),
        "wheels": wheels(input),
        "thrusters": thrusters(input),
        "debris": input.debris.as_ref().map(debris),
        "plates": plates,
        "arcs": arcs(&resolved),
        "keep_out": keep_out(plan),
    })
}

fn plate(plate: &Plate) -> Value {
    json!({ "side": libm::sqrt(plate.area), "normal": plate.normal, "center": plate.center })
}

fn part(part: &PartInput) -> ShownPart {
    let size = match part.shape {
        PartShape::HollowCylinder => vec![part.outer_radius_m, part.length_m],
        PartShape::SolidCylinder => vec![part.radius_m, part.length_m],
        PartShape::Box => part.size_m.unwrap_or([0.1; 3]).map(Some).to_vec(),
        PartShape::Sphere => vec![part.radius_m],
        PartShape::PointMass => vec![],
    };
    ShownPart {
        name: part.name.as_str().to_owned(),
        shape: part.shape.name(),
        size: size.into_iter().map(|length| length.unwrap_or(0.1)).collect(),
        position: part.position_m,
        turn: dcm_from_quaternion(unit_quaternion(part.attitude)),
    }
}

/// Sides of the box with these mass and moments of inertia: l_x^2 = 6 (I_y + I_z - I_x)/m.
fn equivalent_sides(mass: f64, moments: [f64; 3]) -> [f64; 3] {
    let sum: f64 = moments.iter().sum();
    moments.map(|moment| libm::sqrt((6.0 * (sum - 2.0 * moment) / mass).max(1e-6)))
}

fn equivalent_box(scene: &Scene) -> ShownPart {
    let body = &scene.mass.body;
    let (moments, turn) = crate::math::symmetric::principal_axes(body.inertia);
    let size = equivalent_sides(body.mass, moments);
    ShownPart { name: "body".to_owned(), shape: "box", size: size.to_vec(), position: body.center, turn }
}

fn wheels(input: &SceneInput) -> Vec<Value> {
    let turning = input.wheels.iter().filter(|wheel| wheel.mode != WheelMode::Locked);
    let shape = |wheel: &crate::scene::WheelInput| {
        // the solid cylinder with the given inertia
        let radius = wheel.radius_m.or_else(|| Some(libm::sqrt(2.0 * wheel.axial_inertia_kg_m2? / wheel.mass_kg?)));
        let radius = radius.unwrap_or(0.1);
        json!({
            "name": wheel.name.as_str(), "axis": wheel.axis, "position": wheel.position_m,
            "radius": radius, "length": wheel.length_m.unwrap_or(0.4 * radius)
        })
    };
    turning.map(shape).collect()
}

fn thrusters(input: &SceneInput) -> Vec<Value> {
    let shape = |thruster: &crate::scene::ThrusterInput| {
        json!({ "name": thruster.name.as_str(),
        "position": thruster.position_m, "direction": thruster.direction })
    };
    input.thrusters.iter().map(shape).collect()
}

fn debris(debris: &DebrisInput) -> Value {
    match debris {
        DebrisInput::Cube { side_m, .. } => json!([side_m, side_m, side_m]),
        DebrisInput::Box { size_m, .. } => json!(size_m),
        // of unknown size
        DebrisInput::Tensor { mass_kg, inertia_kg_m2 } => {
            json!(equivalent_sides(*mass_kg, [0, 1, 2].map(|axis| inertia_kg_m2[axis][axis])))
        }
        DebrisInput::Principal { .. } => json!([0.2, 0.2, 0.2]),
    }
}

/// Start, end and thrusts of the nominal arcs.
fn arcs(scene: &Option<Scene>) -> Vec<Value> {
    let schedule = scene.iter().flat_map(|scene| scene.schedule.iter());
    // JSON has no infinity
    let end = |arc: &crate::scene::Arc| arc.applied.until.min(f64::MAX);
    schedule.map(|arc| json!({ "start": arc.start, "end": end(arc), "thrust": arc.applied.thrust })).collect()
}

/// The motion of `shown`; `None` without two points.
pub fn motion(plan: &Plan, shown: &ShownRun, payload: &mut Payload) -> Option<Value> {
    let run = shown.run.as_ref()?;
    let points = run.outcome.points.min(run.grid.points());
    if points < 2 {
        return None;
    }
    let (table, wheels) = (&run.table, run.request.wheels.len());
    let each = |of: &dyn Fn(usize) -> Vec<f64>| (0..points).flat_map(of).collect::<Vec<f64>>();
    let attitude = each(&|point| table.at::<4>(StateField::Attitude, point).to_vec());
    let omega = each(&|point| table.at::<3>(StateField::Rate, point).to_vec());
    let momentum = each(&|point| momentum(run, point).to_vec());
    let angles = each(&|point| (0..wheels).map(|wheel| table.column(StateField::WheelAngles, wheel)[point]).collect());
    let debris = run.request.debris.then(|| {
        let relative = each(&|point| {
            difference(table.at(StateField::DebrisPosition, point), table.at(StateField::ComPosition, point)).to_vec()
        });
        let attitude = each(&|point| table.at::<4>(StateField::DebrisAttitude, point).to_vec());
        (relative, attitude)
    });
    let debris = debris.map(|(position, attitude)| {
        json!({ "relative": payload.singles(&position),
        "attitude": payload.singles(&attitude) })
    });
    let goal = approach_goal(plan, run).map(|goal| json!({ "axis": goal.axis, "distance": goal.distance }));
    let is_nominal = shown.sample.0 == 0;
    let name = if is_nominal { "nominal run".to_owned() } else { format!("sample {}", shown.sample) };
    let mut motion = json!({
        "sample": shown.sample.0, "name": name, "why": shown.why, "status": shown.status.name(), "reason": shown.reason,
        "numbers": numbers(plan, shown), "duration": plan.grid.duration(),
            "times": payload.singles(&run.grid.times()[..points]),
        "attitude": payload.singles(&attitude), "omega": payload.singles(&omega),
            "momentum": payload.singles(&momentum),
        "angles": payload.singles(&angles), "debris": debris, "goal": goal, "loop": control(plan, run, points, payload),
        "failed": shown.has_failed(), "live": live::numbers(plan, (run, &shown.row), points, payload),
            "marks": live::marks(plan, &shown.row)
    });
    if let Some(directions) = sky::directions(run, points, payload) {
        motion["orbit"] = directions;
    }
    Some(motion)
}

fn control(plan: &Plan, run: &SingleRun, points: usize, payload: &mut Payload) -> Option<Value> {
    let spec = plan.law.as_ref()?.spec()?;
    let held = run.telemetry.held_at(&run.grid.times()[..points]);
    let column = |name: &str| {
        let place = run.telemetry.quantities.iter().position(|quantity| quantity.name() == name)?;
        held.get(place)
    };
    let phase = column("phase")?;
    let thrusts: Vec<Option<&Vec<f64>>> =
        spec.thruster_names.iter().map(|name| column(&format!("commanded_thrust_{name}_n"))).collect();
    let thrust: Vec<f64> = (0..points)
        .flat_map(|point| thrusts.iter().map(move |thrust| thrust.map_or(0.0, |thrust| thrust[point])))
        .collect();
    let phases: Vec<&str> = spec.phases.iter().map(|phase| phase.name.as_str()).collect();
    Some(json!({ "phases": phases, "phase": payload.singles(phase), "firing": payload.singles(&thrust) }))
}

/// The goal of an approach, relative to the debris in F_e.
#[derive(Clone, Copy, Debug)]
pub struct ApproachGoal {
    /// Unit vector of the axis A_d at the start.
    pub axis: [f64; 3],
    /// Distance of the station behind the debris, m.
    pub distance: f64,
}

/// `None` without an approach, or if the debris has no axis.
pub fn approach_goal(plan: &Plan, run: &SingleRun) -> Option<ApproachGoal> {
    let spec = plan.law.as_ref()?.spec()?;
    if !spec.needs_axis() || !run.request.debris {
        return None;
    }
    let launch = LaunchState::of(&plan.nominal.control.law, None);
    let axis = launch.axis(run.table.at(StateField::DebrisVelocity, 0))?;
    Some(ApproachGoal { axis, distance: launch.numbers.launch_distance })
}

/// Radius within which a mission fails, m; zero without one.
pub fn keep_out(plan: &Plan) -> f64 {
    let spec = plan.law.as_ref().and_then(|law| law.spec());
    if spec.is_some() { DebrisNumbers::of(&plan.nominal.control.law).keep_out } else { 0.0 }
}

/// Names and shown values of the outcomes, and of the final rates.
fn numbers(plan: &Plan, shown: &ShownRun) -> Vec<[String; 2]> {
    const FINAL: [&str; 4] = [
        "angular_rate_final_rad_s",
        "omega_se_s_x_final_rad_s",
        "omega_se_s_y_final_rad_s",
        "omega_se_s_z_final_rad_s",
    ];
    let outcomes = outcomes(plan);
    // a loop shows its rates live, and they end near zero
    let is_free = plan.law.is_none();
    let others = FINAL.into_iter().filter(|name| is_free && !outcomes.iter().any(|outcome| outcome == name));
    let names: Vec<&str> = outcomes.iter().map(String::as_str).chain(others).collect();
    let observed = Observed::named(plan, names.iter().copied());
    let number = |column: &str| shown.row.iter().find(|(name, _)| name == column).map(|(_, value)| *value);
    let value = |name: &&str| {
        let one = observed.iter().find(|one| one.quantity.name() == *name)?;
        let unit = plan.analysis.display.of(name, one.quantity.unit());
        if *name == "launched" {
            let word = if one.value(number)? == 1.0 { "yes" } else { "no" };
            return Some([names::title(&one.quantity), word.to_owned()]);
        }
        Some([names::title(&one.quantity), with_unit(unit.value(one.value(number)?), &unit.unit)])
    };
    names.iter().filter_map(value).collect()
}

/// Angular momentum of the spacecraft about its centre of mass in F_e, N m s.
fn momentum(run: &SingleRun, point: usize) -> [f64; 3] {
    let table = &run.table;
    let rates = (0..run.scene.mass.wheels.len()).map(|wheel| table.column(StateField::WheelRates, wheel)[point]);
    let momentum = momentum_in_body(&run.scene.mass, table.at(StateField::Rate, point), rates);
    product(dcm_from_quaternion(table.at(StateField::Attitude, point)), momentum)
}
