//! Every method against golden truth (25 digits, from a 40-digit Taylor solution), through [`PropagationSettings`] as campaigns run.
//!
//! Law: at every listed time the states and energies are those of the truth, to the accuracy that the method's tolerance or
//! step promises. Bounds are those asked of the program where the constant says so; `cargo test --release --test accuracy golden_truth --
//! --nocapture` prints the largest error of each kind beside them.

use crate::support::golden::Golden;
use crate::support::runs::{Run, adaptive, base_point, fixed, propagate, relative, up_to_sign};
use spindrift::math::Isa;
use spindrift::observables::{Groups, Observer, Request, Series};
use spindrift::ode::Control;
use spindrift::ode::Integrator;
use spindrift::propagation::Method;
use spindrift::run::Status;
use spindrift::run::{Grid, StateField};
use spindrift::scene::{Actuated, Scene};

/// The largest error at any golden time, relative to the truth (at least to one in its unit).
#[derive(Clone, Copy, Debug, Default)]
struct Errors {
    omega: f64,
    attitude: f64,
    wheel_rates: f64,
    wheel_angles: f64,
    position: f64,
    velocity: f64,
    /// Each body's energy relative to itself.
    energies: f64,
    /// Each body's energy relative to the total.
    energies_of_total: f64,
    /// Energy balance: total minus work minus the total at time zero, over the largest total.
    balance: f64,
    debris_position: f64,
    debris_velocity: f64,
    debris_attitude: f64,
    debris_rate: f64,
}

impl Errors {
    fn named(self) -> [(&'static str, f64); 13] {
        [
            ("omega", self.omega),
            ("attitude", self.attitude),
            ("wheel rates", self.wheel_rates),
            ("wheel angles", self.wheel_angles),
            ("position", self.position),
            ("velocity", self.velocity),
            ("energies", self.energies),
            ("same, of total", self.energies_of_total),
            ("energy balance", self.balance),
            ("debris position", self.debris_position),
            ("debris velocity", self.debris_velocity),
            ("debris attitude", self.debris_attitude),
            ("debris rate", self.debris_rate),
        ]
    }

    fn assert_below(self, bounds: Errors, what: &str) {
        println!("{what}:");
        for ((name, error), (_, bound)) in self.named().into_iter().zip(bounds.named()) {
            println!("  {name:16} {error:9.2e} <= {bound:9.2e}");
        }
        for ((name, error), (_, bound)) in self.named().into_iter().zip(bounds.named()) {
            assert!(error <= bound, "{what}: {name} {error:e} > {bound:e}");
        }
    }

    /// The same bound for everything.
    fn all(bound: f64) -> Self {
        Errors {
            omega: bound,
            attitude: bound,
            wheel_rates: bound,
            wheel_angles: bound,
            position: bound,
            velocity: bound,
            energies: bound,
            energies_of_total: bound,
            balance: bound,
            debris_position: bound,
            debris_velocity: bound,
            debris_attitude: bound,
            debris_rate: bound,
        }
    }
}

fn errors_of(golden: &Golden, scene: &Scene, method: Method, grid: &Grid, run: &Run) -> Errors {
    let table = &run.table;
    assert_eq!(run.outcome.status, Status::Done);
    assert_eq!(table.points(), golden.truth.len());
    let mut worst = Errors::default();
    for (point, truth) in golden.truth.iter().enumerate() {
        let [position, velocity] = base_point(scene, table, point);
        for (error, found) in [
            (&mut worst.omega, relative::<3>(table.at(StateField::Rate, point), truth.omega_se_s)),
            (&mut worst.attitude, up_to_sign(table.at(StateField::Attitude, point), truth.q_es)),
            (&mut worst.wheel_rates, relative::<2>(table.at(StateField::WheelRates, point), truth.wheel_rates)),
            (&mut worst.wheel_angles, relative::<2>(table.at(StateField::WheelAngles, point), truth.wheel_angles)),
            (&mut worst.position, relative(position, truth.r_po_e)),
            (&mut worst.velocity, relative(velocity, truth.v_po_e)),
            (&mut worst.debris_position, relative::<3>(table.at(StateField::DebrisPosition, point), truth.r_gdo_e)),
            (&mut worst.debris_velocity, relative::<3>(table.at(StateField::DebrisVelocity, point), truth.v_gdo_e)),
            (&mut worst.debris_attitude, up_to_sign(table.at(StateField::DebrisAttitude, point), truth.q_ed)),
            (&mut worst.debris_rate, relative::<3>(table.at(StateField::DebrisRate, point), truth.omega_de_d)),
        ] {
            *error = error.max(found);
        }
    }
    let request = Request {
        groups: Groups::ALL,
        debris: true,
        actuated: if scene.schedule.is_empty() { Actuated::NONE } else { Actuated::ALL },
        constrained: method == Method::NullSpace,
        wheels: golden.scene.turning_wheels(),
        windows: spindrift::observables::window::NO_WINDOWS,
    };
    let mut observer = Observer::new(request, grid);
    let mut row = vec![0.0; request.columns().len()];
    observer.observe(Isa::best(), scene, table, &run.outcome, &mut row);
    let mut seen = 0;
    let wheel = |index| Series::EnergyWheel.of_wheel(index);
    let bodies = [Series::EnergyBody, wheel(0), wheel(1), Series::EnergyDebris];
    for (series, values) in observer.series() {
        let body = bodies.iter().position(|energy| *energy == series);
        for (truth, value) in golden.truth.iter().zip(values) {
            if let Some(body) = body {
                let (expected, total) = (truth.energies[body], truth.energies.iter().sum::<f64>());
                worst.energies = worst.energies.max((value / expected - 1.0).abs());
                worst.energies_of_total = worst.energies_of_total.max(((value - expected) / total).abs());
                seen += 1;
            }
            if series == Series::EnergyError {
                worst.balance = worst.balance.max(value.abs());
                seen += 1;
            }
        }
    }
    assert_eq!(seen, 5 * golden.truth.len(), "four energies and the balance are series");
    worst
}

fn errors(name: &str, method: Method, control: Control) -> Errors {
    let golden = Golden::load(name);
    let scene = Scene::resolve(&golden.scene).expect("a golden scene");
    let grid = Grid::at(golden.times());
    let run = propagate(method, control, &grid, std::slice::from_ref(&scene)).remove(0);
    errors_of(&golden, &scene, method, &grid, &run)
}

/// Asked of the program: Dormand-Prince at 1e-12, omega, attitude and energies.
const EMBEDDED: f64 = 1e-9;

/// Asked of the program: Taylor and periodic, omega and attitude.
const TAYLOR: f64 = 1e-13;

fn embedded(method: Method, bounds: Errors) {
    for name in ["table1", "forced"] {
        let errors = errors(name, method, adaptive(1e-12));
        errors.assert_below(bounds, &format!("{} at 1e-12, {name}", method.name()));
    }
}

#[test]
fn dormand_prince() {
    embedded(Method::Gyrostat(Integrator::DormandPrince), Errors::all(EMBEDDED));
}

#[test]
fn dop853() {
    embedded(Method::Gyrostat(Integrator::Dop853), Errors::all(EMBEDDED));
}

#[test]
fn reference() {
    // not asked: the velocity of p, in which the error of omega, relative to 31 rad/s about s3, meets a lever arm of 1.5 m;
    // measured 2.3e-9
    embedded(Method::NullSpace, Errors { velocity: 4e-9, ..Errors::all(EMBEDDED) });
}

#[test]
fn taylor() {
    for name in ["table1", "forced"] {
        errors(name, Method::Taylor, adaptive(1e-16))
            .assert_below(Errors::all(TAYLOR), &format!("taylor at 1e-16, {name}"));
    }
}

#[test]
fn auto() {
    for name in ["table1", "forced"] {
        errors(name, Method::Auto, adaptive(1e-16))
            .assert_below(Errors::all(TAYLOR), &format!("auto at 1e-16, {name}"));
    }
}

#[test]
fn methods_with_fixed_steps() {
    // measured: 8.4e-8 (attitude) and 2.3e-14 (velocity): the order 6 leaves rounding at this step
    for (method, step, bound) in [
        (Method::Gyrostat(Integrator::RungeKutta4), 1e-3, 2e-7),
        (Method::Gyrostat(Integrator::GaussLegendre), 1e-3, 2e-13),
    ] {
        for name in ["table1", "forced"] {
            let what = format!("{} in steps of {step} s, {name}", method.name());
            errors(name, method, fixed(step)).assert_below(Errors::all(bound), &what);
        }
    }
}

/// Counter-test: a loose tolerance, and a wheel a hundred-millionth too heavy, are seen by the same comparison.
#[test]
fn the_comparison_can_fail() {
    let loose = errors("table1", Method::Gyrostat(Integrator::DormandPrince), adaptive(1e-7));
    // measured: 1.1e-7 and 2.3e-6
    assert!(loose.omega > EMBEDDED && loose.attitude > EMBEDDED, "{loose:?}");
    let golden = Golden::load("table1");
    let mut input = golden.scene.clone();
    *input.wheels[0].density_kg_m3.as_mut().expect("it is given by its sizes") *= 1.0 + 1e-8;
    let scene = Scene::resolve(&input).expect("nearly a golden scene");
    let grid = Grid::at(golden.times());
    let run = propagate(Method::Auto, adaptive(1e-16), &grid, std::slice::from_ref(&scene)).remove(0);
    let wrong = errors_of(&golden, &scene, Method::Auto, &grid, &run);
    // measured: 4.6e-10 and 3.9e-10
    assert!(wrong.omega > 100.0 * TAYLOR && wrong.attitude > 100.0 * TAYLOR, "{wrong:?}");
}
