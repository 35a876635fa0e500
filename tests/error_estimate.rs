//! The error estimate of a row against the true error of its run.

mod support;

use spindrift::campaign::{Overrides, Plan};
use spindrift::dynamics::table::{Block, Blocks, Grid, StateTable};
use spindrift::integrators::taylor::truth::{TOLERANCE, Truth};
use spindrift::integrators::{Control, Method, Propagator, Status};
use spindrift::math::Isa;
use spindrift::math::vector::norm;
use spindrift::observables::{Group, Observer, Request};
use spindrift::sampling::SampleId;
use spindrift::scene::{Scene, SceneInput};
use support::runs::{adaptive, fixed};
use support::scenes::{Kind, Uniform, mixed, random};

struct Family {
    name: &'static str,
    grid: Grid,
    scenes: Vec<Scene>,
    truths: Vec<Truth>,
}

fn drawn(name: &str, samples: u64) -> (Grid, Vec<Scene>) {
    let path = format!("{}/campaigns/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("a shipped campaign");
    let plan = Plan::from_text(name, &text, Overrides { samples: Some(samples), seed: None }).expect("valid");
    let mut sampler = plan.dispersions.sampler();
    let mut applied = vec![0.0; plan.dispersions.columns().len()];
    let mut input = plan.nominal.clone();
    let scenes = (0..samples).map(|sample| {
        sampler.draw(SampleId(sample), &mut input, &mut applied);
        Scene::resolve(&input).expect("shipped campaigns draw physical scenes")
    });
    (plan.grid.clone(), scenes.collect())
}

/// Spin about the intermediate axis, 10^-1 ... 10^-14 off it; with wheels or without.
fn separatrix(count: u64, wheels: bool) -> Vec<Scene> {
    let mut u = Uniform::new(if wheels { 77 } else { 76 });
    let scene = |k: u64| {
        let kind = Kind { wheels: [wheels, wheels && k.is_multiple_of(2)], debris: 0, products: false, offset: false, forced: false };
        let mut input: SceneInput = random(kind, 500 + k, 10.0);
        input.fuselage.inertia_kg_m2 = Some([[900.0, 0.0, 0.0], [0.0, 1400.0, 0.0], [0.0, 0.0, 1800.0]]);
        input.fuselage.mass_kg = Some(1000.0);
        let off = libm::pow(10.0, u.between(-14.0, -1.0));
        let rate = u.between(0.5, 3.0);
        input.initial.angular_velocity_rad_s = [off * rate, rate, off * rate * u.between(-1.0, 1.0)];
        input.initial.wheel_rates_rad_s = if wheels { [u.between(-30.0, 30.0), 0.0] } else { [0.0; 2] };
        Scene::resolve(&input).expect("physical")
    };
    (0..count).map(scene).collect()
}

fn compared() -> Blocks {
    Blocks::NONE.with(Block::Rate).with(Block::Attitude)
}

fn family(name: &'static str, grid: Grid, scenes: Vec<Scene>) -> Family {
    let start = std::time::Instant::now();
    let solve = |scene: &Scene| Truth::new(Isa::best(), scene, &grid, compared(), TOLERANCE).expect("arrives");
    let truths: Vec<Truth> = scenes.iter().map(solve).collect();
    println!("{name}: {} truths, {:.4} s each", scenes.len(), start.elapsed().as_secs_f64() / scenes.len() as f64);
    Family { name, grid, scenes, truths }
}

fn off<const N: usize>(truth: &Truth, table: &StateTable, block: Block, point: usize, sign: f64) -> f64 {
    let (high, low) = (truth.high.at::<N>(block, point), truth.low.at::<N>(block, point));
    let state = table.at::<N>(block, point);
    (0..N).map(|i| ((sign * state[i] - high[i]) - low[i]).powi(2)).sum::<f64>().sqrt()
}

fn true_error(truth: &Truth, table: &StateTable) -> [f64; 2] {
    let points = 0..table.points();
    let size = points.clone().map(|p| norm(truth.high.at::<3>(Block::Rate, p))).fold(f64::MIN_POSITIVE, f64::max);
    let mut worst = [0.0_f64; 2];
    for p in points {
        worst[0] = worst[0].max(off::<3>(truth, table, Block::Rate, p, 1.0) / size);
        let turn = |sign| 2.0 * off::<4>(truth, table, Block::Attitude, p, sign);
        worst[1] = worst[1].max(turn(1.0).min(turn(-1.0)));
    }
    worst
}

/// Estimate, local error, amplification and true errors of every run.
fn judged(family: &Family, method: Method, control: Control) -> Vec<[f64; 5]> {
    let request = Request {
        groups: [Group::Numerics].into_iter().collect(),
        debris: false,
        actuated: !family.scenes[0].schedule.is_empty(),
        constrained: method == Method::Reference,
    };
    let blocks = request.blocks().union(compared());
    let plan = Propagator::new(method, control, family.grid.clone(), blocks, &family.scenes[0]);
    let mut observer = Observer::new(request, &family.grid);
    let names: Vec<&str> = request.columns().iter().map(|column| column.name).collect();
    let place = |name: &str| names.iter().position(|known| *known == name).expect("a column");
    let (estimate, amplification) = (place("state_error_estimate"), place("error_amplification"));
    let mut row = vec![0.0; names.len()];
    let mut found = vec![[f64::NAN; 5]; family.scenes.len()];
    plan.engine(Isa::best()).propagate(&family.scenes, &mut |index, table, outcome| {
        if outcome.status != Status::Done {
            return;
        }
        observer.observe(Isa::best(), &family.scenes[index], table, outcome, &mut row);
        let [rate, attitude] = true_error(&family.truths[index], table);
        let e = outcome.local_errors;
        if std::env::var_os("DETAIL").is_some() { println!("   {index} est {:.2e} true {rate:.2e} {attitude:.2e} even {:.2e} trunc {:.1e} round {:.1e} att {:.1e} steps {}", row[estimate], row[amplification], e.truncation, e.rounding, e.attitude, outcome.effort.steps); }
        found[index] = [row[estimate], e.truncation.max(e.attitude), row[amplification], rate, attitude];
    });
    found
}

fn quantile(values: &mut [f64], p: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    values[((p * values.len() as f64).ceil() as usize).clamp(1, values.len()) - 1]
}

#[test]
#[ignore = "prints"]
fn table() {
    let count: u64 = std::env::var("COUNT").map_or(40, |x| x.parse().unwrap());
    let only = std::env::var("ONLY").unwrap_or_default();
    let mut families = Vec::new();
    for name in ["spin_sweep", "burn"] {
        let (grid, scenes) = drawn(name, count);
        families.push(family(name, grid, scenes));
    }
    families.push(family("separatrix", Grid::uniform(60.0, 101), separatrix(count, false)));
    families.push(family("separatrix_wheels", Grid::uniform(60.0, 101), separatrix(count, true)));
    families.push(family("mixed", Grid::uniform(10.0, 101), mixed(count, false, 10.0)));
    families.push(family("mixed_forced", Grid::uniform(10.0, 101), mixed(count, true, 10.0)));
    families.push(family("long", Grid::uniform(300.0, 101), mixed(count.min(10), false, 10.0)));
    for method in Method::ALL {
        if !only.is_empty() && only != method.name() {
            continue;
        }
        for family in &families {
            let settings: Vec<(String, Control)> = if method.has_fixed_step() {
                [0.01, 0.003, 0.001].iter().map(|s| (format!("h {s:e}"), fixed(*s))).collect()
            } else if method == Method::Reference {
                [1e-4, 1e-6, 1e-8].iter().map(|t| (format!("{t:e}"), adaptive(*t))).collect()
            } else {
                [1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14, 1e-16].iter().map(|t| (format!("{t:e}"), adaptive(*t))).collect()
            };
            if family.name == "long" && (method.has_fixed_step() || method == Method::Reference) {
                continue;
            }
            for (label, control) in settings {
                let slow = matches!(method, Method::DormandPrince | Method::Dop853) && control.tolerance.relative < 1e-12;
                if slow || method == Method::Reference && family.scenes.len() > 12 && family.name.starts_with("mixed") {
                    continue;
                }
                let rows = judged(family, method, control);
                let rows: Vec<_> = rows.into_iter().filter(|row| row[0].is_finite()).collect();
                // a run whose error has reached its bound says nothing
                let meaningful: Vec<_> = rows.iter().filter(|r| r[3].max(r[4]) < 0.1).collect();
                let covered = meaningful.iter().filter(|r| r[0] >= r[3].max(r[4])).count();
                let mut ratios: Vec<f64> = meaningful.iter().map(|r| r[0] / r[3].max(r[4])).collect();
                if ratios.is_empty() {
                    continue;
                }
                let mut raw: Vec<f64> = meaningful.iter().map(|r| r[3].max(r[4]) / r[2]).collect();
                let mut amp: Vec<f64> = meaningful.iter().map(|r| r[2]).collect();
                let mut local: Vec<f64> = meaningful.iter().map(|r| r[1]).collect();
                let lost: Vec<_> = rows.iter().filter(|r| r[3].max(r[4]) >= 0.1).collect();
                println!(
                    "{:<16}{:<18}{:<8} n {:>4} cover {:>5.1}% ratio 5% {:>9.2e} 50% {:>9.2e} 95% {:>9.2e} | true/K 5% {:.1e} 50% {:.1e} 95% {:.1e} | local {:.1e} K 50% {:.1e} max {:.1e} | lost {} of which est>0.01 {}",
                    method.name(), family.name, label, ratios.len(),
                    100.0 * covered as f64 / ratios.len() as f64,
                    quantile(&mut ratios, 0.05), quantile(&mut ratios, 0.5), quantile(&mut ratios, 0.95),
                    quantile(&mut raw, 0.05), quantile(&mut raw, 0.5), quantile(&mut raw, 0.95),
                    quantile(&mut local, 0.5), quantile(&mut amp, 0.5), quantile(&mut amp, 1.0),
                    lost.len(), lost.iter().filter(|r| r[0] > 0.01).count(),
                );
            }
        }
    }
}

fn tilted(count: u64) -> Vec<Scene> {
    // near the separatrix of a body with products of inertia and an offset centre, wheels on
    let mut u = Uniform::new(78);
    (0..count).map(|k| {
        let kind = Kind { wheels: [k % 3 != 0, k % 3 == 2], debris: 0, products: true, offset: true, forced: false };
        let mut input = random(kind, 900 + k, 10.0);
        input.initial.wheel_rates_rad_s = [if k % 3 != 0 { u.between(-30.0, 30.0) } else { 0.0 }, 0.0];
        let scene = Scene::resolve(&input).expect("physical");
        // an equilibrium omega = mu H of the intermediate kind, by iteration from the intermediate axis
        let (moments, axes) = spindrift::math::symmetric::principal_axes(scene.mass.inertia_free);
        let mut order = [0, 1, 2];
        order.sort_by(|a, b| moments[*a].total_cmp(&moments[*b]));
        let middle = order[1];
        let rate = u.between(0.5, 3.0);
        let axis = [axes[0][middle], axes[1][middle], axes[2][middle]];
        let off = libm::pow(10.0, u.between(-14.0, -1.0));
        let noise: [f64; 3] = std::array::from_fn(|_| u.between(-1.0, 1.0));
        input.initial.angular_velocity_rad_s = std::array::from_fn(|i| rate * (axis[i] + off * noise[i]));
        Scene::resolve(&input).expect("physical")
    }).collect()
}

fn nutating(count: u64) -> Vec<Scene> {
    let mut u = Uniform::new(79);
    (0..count).map(|k| {
        let kind = Kind { wheels: [k % 3 != 0, k % 3 == 2], debris: 0, products: k % 2 == 0, offset: false, forced: false };
        let mut input = random(kind, 700 + k, 10.0);
        let off = libm::pow(10.0, u.between(-14.0, -1.0));
        let rate = u.between(0.5, 30.0);
        input.initial.angular_velocity_rad_s = [rate * off * u.between(-1.0, 1.0), rate * off, rate];
        input.initial.wheel_rates_rad_s = [if k % 3 != 0 && k % 4 == 0 { u.between(-300.0, 300.0) } else { 0.0 }, if k % 3 == 2 { u.between(-300.0, 300.0) } else { 0.0 }];
        Scene::resolve(&input).expect("physical")
    }).collect()
}

#[test]
#[ignore = "prints"]
fn dump() {
    use std::io::Write;
    let count: u64 = std::env::var("COUNT").map_or(40, |x| x.parse().unwrap());
    let mut families = Vec::new();
    for name in ["spin_sweep", "burn"] {
        let (grid, scenes) = drawn(name, count);
        families.push(family(name, grid, scenes));
    }
    families.push(family("separatrix", Grid::uniform(60.0, 101), separatrix(count, false)));
    families.push(family("separatrix_wheels", Grid::uniform(60.0, 101), separatrix(count, true)));
    families.push(family("tilted", Grid::uniform(60.0, 101), tilted(count)));
    families.push(family("nutating", Grid::uniform(10.0, 101), nutating(count)));
    families.push(family("mixed", Grid::uniform(10.0, 101), mixed(count, false, 10.0)));
    families.push(family("mixed_coarse", Grid::uniform(10.0, 11), mixed(count, false, 10.0)));
    families.push(family("mixed_forced", Grid::uniform(10.0, 101), mixed(count, true, 10.0)));
    families.push(family("long", Grid::uniform(300.0, 101), mixed(count.min(16), false, 10.0)));
    let mut file = std::io::BufWriter::new(std::fs::File::create("/tmp/audit_dump.jsonl").unwrap());
    for family in &families {
        for (k, scene) in family.scenes.iter().enumerate() {
            let plan = Propagator::new(Method::Taylor, adaptive(1e-14), family.grid.clone(), compared().with(Block::WheelRates), scene);
            let mut rates = Vec::new();
            plan.engine(Isa::best()).propagate(std::slice::from_ref(scene), &mut |_, table, _| {
                rates = (0..table.points()).map(|p| table.at::<2>(Block::WheelRates, p)).collect();
            });
            let omega: Vec<[f64; 3]> = (0..family.grid.points()).map(|p| family.truths[k].high.at::<3>(Block::Rate, p)).collect();
            writeln!(file, r#"{{"family":"{}","scene":{k},"K":{:?},"J":{:?},"axial":{:?},"axes":{:?},"times":{:?},"omega":{omega:?},"rates":{rates:?},"schedule":{:?}}}"#,
                family.name, scene.mass.inertia_free, scene.mass.inertia, scene.mass.wheels.map(|w| w.axial), scene.mass.wheels.map(|w| w.axis), family.grid.times(),
                scene.schedule.iter().map(|a| { let t = scene.thruster_torque_s(a.thrust); [a.start, a.end, norm(t) + a.torque[0].abs() + a.torque[1].abs()] }).collect::<Vec<_>>()).unwrap();
        }
    }
    for method in Method::ALL {
        for family in &families {
            let settings: Vec<Control> = if method.has_fixed_step() {
                [0.01, 0.003, 0.001].iter().map(|s| fixed(*s)).collect()
            } else if method == Method::Reference {
                [1e-4, 1e-6, 1e-8].iter().map(|t| adaptive(*t)).collect()
            } else {
                [1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14, 1e-16].iter().map(|t| adaptive(*t)).collect()
            };
            if family.name == "long" && (method.has_fixed_step() || method == Method::Reference) {
                continue;
            }
            for control in settings {
                let slow = matches!(method, Method::DormandPrince | Method::Dop853) && control.tolerance.relative < 1e-12;
                if slow || method == Method::Reference && (family.name.starts_with("mixed") || family.name == "nutating") && control.tolerance.relative < 1e-7 {
                    continue;
                }
                let plan = Propagator::new(method, control, family.grid.clone(), compared().with(Block::WheelRates), &family.scenes[0]);
                plan.engine(Isa::best()).propagate(&family.scenes, &mut |index, table, outcome| {
                    if outcome.status != Status::Done { return; }
                    let [rate, attitude] = true_error(&family.truths[index], table);
                    let e = outcome.local_errors;
                    writeln!(file, r#"{{"method":"{}","family":"{}","scene":{index},"setting":{:e},"steps":{},"e":[{:e},{:e},{:e},{:e}],"rate":{rate:e},"attitude":{attitude:e},"omega":{:?},"rates":{:?}}}"#,
                        method.name(), family.name, control.step.unwrap_or(control.tolerance.relative), outcome.effort.steps, e.truncation, e.rounding, e.feedback, e.attitude,
                        (0..table.points()).map(|p| table.at::<3>(Block::Rate, p)).collect::<Vec<_>>(), (0..table.points()).map(|p| table.at::<2>(Block::WheelRates, p)).collect::<Vec<_>>()).unwrap();
                });
            }
        }
    }
}
