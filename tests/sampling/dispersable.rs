//! Every number that can be dispersed changes the motion, in both kernels alike, and is recorded as applied.

use crate::support::{prelude::*, scenes::misaligned};
use spindrift::{
    dynamics::effects::Effect,
    sampling::{Dispersion, DispersionError, Dispersions, Written, WrittenDistribution, dispersions::Draws},
    scene::{
        Name, PartInput, PartShape, PrincipalInertia, PrincipalMoments, parameter::Shape as ParameterShape,
        table::Table,
    },
};

const HORIZON: f64 = 1.0;
/// A step of Berdoz's form may add it a few hundred times.
const TOLERANCE: f64 = 1e-11;
/// Measured: 2e-11.
const AGREED: f64 = 2e-10;
const CHANGED: f64 = 10.0 * AGREED;
/// Relative to the nominal, or absolute where that is zero.
const SPREAD: f64 = 1e-3;

fn variants() -> Vec<SceneInput> {
    let kind = |debris| Kind { wheels: [true; 2], debris, products: true, offset: true, forced: true };
    let scene = |debris| misaligned(random(kind(debris), 11, HORIZON), 11);
    let axes = [0.5, 0.1, -0.7, 0.5];
    let principal = |moments| Some(PrincipalInertia { moments, axes });
    let mut by_moments = scene(1);
    by_moments.body.inertia_kg_m2 = None;
    by_moments.body.principal = principal(PrincipalMoments::Inertia([1000.0, 1500.0, 1200.0]));
    let mut by_second = by_moments.clone();
    by_second.body.principal = principal(PrincipalMoments::Second([300.0, 500.0, 900.0]));
    let plain = random(Kind { products: false, offset: false, ..kind(2) }, 12, HORIZON);
    let tensor = [[3.0, 0.2, -0.1], [0.2, 4.0, 0.3], [-0.1, 0.3, 5.0]];
    let irregular = [
        DebrisInput::Tensor { mass_kg: 20.0, inertia_kg_m2: tensor },
        DebrisInput::Principal {
            mass_kg: 20.0,
            principal: principal(PrincipalMoments::Inertia([3.0, 4.0, 5.0])).unwrap(),
        },
        DebrisInput::Principal {
            mass_kg: 20.0,
            principal: principal(PrincipalMoments::Second([3.0, 4.0, 5.0])).unwrap(),
        },
    ];
    let mut list = vec![plain, scene(1), scene(2), by_moments, by_second];
    list.extend(irregular.map(|debris| SceneInput { debris: Some(debris), ..scene(1) }));
    let mut parts = random(Kind { products: false, offset: false, ..kind(2) }, 13, HORIZON);
    let part = |name, shape, position_m| PartInput {
        name: Name::of(name),
        shape,
        position_m,
        attitude: axes,
        ..PartInput::DEFAULT
    };
    let (density_kg_m3, radius_m, length_m) = (Some(2000.0), Some(0.3), Some(1.2));
    parts.parts.extend([
        PartInput { radius_m, length_m, density_kg_m3, ..part("rod", PartShape::SolidCylinder, [0.3, -0.5, 1.0]) },
        PartInput { size_m: Some([2.0, 1.0, 0.4]), density_kg_m3, ..part("crate", PartShape::Box, [-0.3, 0.8, 0.2]) },
        PartInput { radius_m, density_kg_m3, ..part("ball", PartShape::Sphere, [0.7, 0.1, 2.0]) },
        PartInput { mass_kg: Some(90.0), ..part("tip", PartShape::PointMass, [0.2, -0.4, 3.0]) },
    ]);
    parts.parts[3].errors.shear = [0.1, 0.0, 0.0];
    let by_mass = WheelInput {
        mass_kg: Some(60.0),
        axial_inertia_kg_m2: Some(2.0),
        transverse_inertia_kg_m2: Some(1.2),
        ..WheelInput::DEFAULT
    };
    let WheelInput { name, axis, position_m, rate_rad_s, .. } = parts.wheels[0];
    parts.wheels[0] = WheelInput { name, axis, position_m, rate_rad_s, ..by_mass };
    list.push(parts);
    list.push(scene(1).with("environment.body_torque_n_m", &[30.0, -20.0, 10.0]));
    for input in &mut list {
        input.parts[0].attitude = axes;
        for wheel in &mut input.wheels {
            wheel.axis = wheel.axis.map(|x| 2.0 * x + 0.3);
        }
        for thruster in &mut input.thrusters {
            thruster.direction = thruster.direction.map(|x| 2.0 * x + 0.3);
        }
        for q in [&mut input.initial.attitude, &mut input.initial.debris_attitude] {
            let norm = q.iter().map(|x| x * x).sum::<f64>().sqrt();
            q.iter_mut().for_each(|x| *x /= norm);
        }
    }
    list
}

fn parameters(variants: &[SceneInput]) -> Vec<(Parameter, Vec<usize>)> {
    let mut found: Vec<(Parameter, Vec<usize>)> = Vec::new();
    for (place, scene) in variants.iter().enumerate() {
        for parameter in Parameter::all(scene).filter(|parameter| parameter.exists(scene)) {
            match found.iter_mut().find(|(other, _)| other.name() == parameter.name()) {
                Some((_, places)) => places.push(place),
                None => found.push((parameter, vec![place])),
            }
        }
    }
    found
}

/// The states of a run, and the energies in its row.
struct Motion {
    table: StateTable,
    energies: Vec<f64>,
}

fn motion(method: Method, input: &SceneInput) -> Motion {
    let scene = resolved(input);
    let grid = Grid::uniform(HORIZON, 5);
    let tolerance = if method == Method::Taylor { 1e-16 } else { TOLERANCE };
    let run = propagate_one(method, adaptive(tolerance), &grid, &scene);
    assert_eq!(run.outcome.status, Status::Done);
    let groups = [Group::Energies, Group::EnergiesCom].into_iter().collect();
    let request =
        Request { wheels: input.turning_wheels(), ..request(groups, 0, true, true, method == Method::NullSpace) };
    let (row, _) = observed(Isa::best(), request, &grid, &scene, (&run.table, &run.outcome), None);
    let mut energies: Vec<(String, f64)> =
        row.into_iter().filter(|(name, _)| name.ends_with("_initial_j") || name.ends_with("_final_j")).collect();
    energies.sort_by(|(a, _), (b, _)| a.cmp(b));
    let energies = energies.into_iter().map(|(_, energy)| energy).collect();
    Motion { table: run.table, energies }
}

fn distance(found: &Motion, expected: &Motion) -> f64 {
    assert!(found.energies.len() == expected.energies.len() && found.energies.len() >= 8);
    let pairs = found.energies.iter().zip(&expected.energies);
    let mut worst = pairs.map(|(a, b)| relative([*a], [*b])).fold(0.0, f64::max);
    let (found, expected) = (&found.table, &expected.table);
    for block in StateField::ALL.into_iter().filter(|block| everything(Method::Taylor).contains(*block)) {
        for point in 0..expected.points() {
            macro_rules! off {
                ($width:literal) => {
                    relative::<$width>(found.at(block, point), expected.at(block, point))
                };
            }
            worst = worst.max(match block {
                StateField::Attitude | StateField::DebrisAttitude => {
                    up_to_sign(found.at(block, point), expected.at(block, point))
                }
                _ if found.width(block) == 2 => off!(2),
                _ => off!(3),
            });
        }
    }
    worst
}

fn dispersions(nominal: &SceneInput, disperse: &[Dispersion]) -> Result<Dispersions, Vec<DispersionError>> {
    let design = &Design::DEFAULT;
    let draws = Draws { seed: 3, samples: Some(2), design, disperse, correlate: &[], derive: &[] };
    Dispersions::new(draws, nominal)
}

fn drawn(parameter: Parameter, component: usize, nominal: &SceneInput) -> (SceneInput, Vec<(Parameter, usize, f64)>) {
    let value = parameter.value(nominal, component).unwrap();
    let std = SPREAD * if value == 0.0 { 1.0 } else { value.abs() };
    let distribution =
        WrittenDistribution { kind: DistributionKind::Normal, written: Written::default().with("std", std) };
    let list = [Dispersion { table: 0, parameter, component: Some(component), distribution }];
    let drawn = dispersions(nominal, &list).unwrap_or_else(|errors| panic!("{}", errors[0]));
    let (mut scene, mut applied) = (nominal.clone(), vec![f64::NAN; drawn.columns().len()]);
    drawn.sampler().draw(SampleId(1), &mut scene, &mut applied);
    let recorded = drawn.columns().iter().zip(applied).map(|(c, x)| (c.parameter, c.component, x)).collect();
    (scene, recorded)
}

#[test]
fn every_key_moves_the_motion_and_both_kernels_agree_where_to() {
    let variants = variants();
    let nominal_motions: Vec<Motion> = variants.iter().map(|input| motion(Method::Taylor, input)).collect();
    let (mut least, mut most, mut count) = (f64::INFINITY, 0.0_f64, 0);
    let mut unmoved: Vec<String> = Vec::new();
    for (parameter, places) in parameters(&variants) {
        for component in 0..parameter.width() {
            let name = parameter.component_name(component);
            // other keys may hide this one
            let found = places.iter().find_map(|place| {
                let (scene, recorded) = drawn(parameter, component, &variants[*place]);
                let taylor = motion(Method::Taylor, &scene);
                let moved = distance(&taylor, &nominal_motions[*place]);
                (moved > CHANGED).then_some((scene, recorded, taylor, moved))
            });
            let Some((scene, recorded, taylor, moved)) = found else {
                unmoved.push(name);
                continue;
            };
            let whole = parameter.shape() == ParameterShape::Quaternion;
            assert_eq!(recorded.len(), if whole { 4 } else { 1 }, "{name}");
            for (parameter, component, value) in recorded {
                assert_eq!(
                    parameter.value(&scene, component),
                    Some(value),
                    "{name}: what is recorded is what is there"
                );
            }
            let agreed = distance(&motion(Method::NullSpace, &scene), &taylor);
            assert!(agreed < AGREED, "{name}: {agreed:e}");
            (least, most, count) = (least.min(moved), most.max(agreed), count + 1);
        }
    }
    // a point has no attitude and no inertia; where arcs meet there is one switch
    unmoved.retain(|name| !name.starts_with("body.parts.tip."));
    // the null-space kernel refuses orbits: tests/accuracy/orbits.rs has their truth
    unmoved.retain(|name| !name.starts_with("environment."));
    assert_eq!(unmoved, ["actuation.0.switch_off_delay_s"]);
    assert!(count > 100, "{count}");
}

/// Numbers of effects that other keys of `[environment]` switch on.
const OF_EFFECTS: [&str; 6] = [
    "environment.density_scale",
    "environment.base_density_kg_m3",
    "environment.base_height_m",
    "environment.scale_height_m",
    "environment.solar_pressure_n_m2",
    "environment.area_scale",
];

/// Law: a numeric key of `[environment]` makes an effect of the list act, or is a number of one.
#[test]
fn every_key_of_the_environment_has_an_effect() {
    let keys: Vec<String> = Table::Environment.keys().map(|key| key.name(Name::NONE)).collect();
    assert!(OF_EFFECTS.iter().all(|name| keys.iter().any(|key| key == name)));
    for key in keys {
        let acts = Effect::ALL.into_iter().any(|effect| effect.key() == key);
        assert!(acts != OF_EFFECTS.contains(&key.as_str()), "{key} is in the schema, but has no effect");
    }
}
