//! NASA's JEOD: free rotation, pulses of torque and force on the inertia of the space station, and the gravity gradient
//! on a circle and on an ellipse, for eight hours on a two-body orbit.
//!
//! Numbers of `verif/SIM_dyncomp` in NASA's repository `nasa/jeod`: the first and the last line of
//! `<folder>/<name>/log_state_ASCII.csv` (16 digits), with the set-up of `SET_test/<name>/input.py` and
//! `Modified_data/mass.py`. The folder is `SET_test_val`, for 8B `SET_test_val_rh8`.

use crate::support::orbits::{body, near_rounding};
use crate::support::runs::{adaptive, everything, propagate};
use spindrift::dynamics::effects::ForceModel;
use spindrift::math::Isa;
use spindrift::math::vector::{dcm_from_quaternion, difference, norm, sum};
use spindrift::propagation::Method;
use spindrift::propagation::taylor::reference_solution::{ReferenceSolution, TOLERANCE};
use spindrift::run::{Grid, StateField, StateTable};
use spindrift::scene::{ActuationInput, Name, OrbitInput, Scene, SceneInput, ThrusterInput};

/// A run of JEOD.
pub struct JeodRun {
    name: &'static str,
    craft: Craft,
    /// Position (m) and velocity (m/s) at time zero.
    start: [[f64; 3]; 2],
    /// Attitude at time zero, F_s -> F_e: JEOD's left quaternion, with minus its vector.
    attitude: [f64; 4],
    /// Angular velocity at time zero and after 28,800 s, F_s, rad/s.
    rates: [[f64; 3]; 2],
    /// Position after 28,800 s, m.
    position: [f64; 3],
    /// From F_e to F_s, by rows, after 28,800 s: `T_parent_this`.
    dcm: [[f64; 3]; 3],
    /// How far JEOD is from the reference solution at most: m, rad/s, and in its matrix.
    own: [f64; 3],
}

/// The spacecraft, and what acts on it.
#[derive(Clone, Copy, PartialEq)]
enum Craft {
    /// A cylinder of 1000 kg in the gravity gradient.
    Cylinder,
    /// A sphere of 1 kg and nothing.
    Sphere,
    /// The space station and 10 N m about s1 from 1000 s to 2000 s, with this force along s1 through the centre of
    /// mass, N.
    Station(f64),
}

const CIRCLE: [[f64; 3]; 2] = [[-4292653.41, 955168.47, 5139356.57], [109.649663, -7527.72649, 1484.521489]];
const ELLIPSE: [[f64; 3]; 2] = [[-4315967.74, 960356.2, 5167269.53], [129.091037, -7491.513855, 1452.515654]];
/// After 28,800 s on the circle.
const ON_CIRCLE: [f64; 3] = [-1024262.411095882, -6151093.565368023, 2599975.06217899];
/// The attitude in which the station docks.
const DOCKING: [f64; 4] = [0.2368106365237557, -0.7173117043670278, 0.6140880728910785, -0.2286492509067215];
/// The rate of the orbit about s2 in that attitude.
const WITH_ORBIT: [f64; 3] = [0.0, -0.001134454274550824, 0.0];
/// The matrices of 9A and 9C, and of 9B and 9D: the force turns nothing.
const FROM_REST: [[f64; 3]; 3] = [
    [0.1690520479948245, -0.9727191068763098, -0.1588676939673716],
    [0.9656730014585525, 0.1312128771193781, 0.2241848235989362],
    [-0.1972233741796006, -0.191313146427029, 0.9615103851136525],
];
const FROM_RATE: [[f64; 3]; 3] = [
    [-0.110781359605145, -0.0346505107912517, -0.9932405712947602],
    [-0.8498349541130382, -0.5148480361227724, 0.1127477293262038],
    [-0.5152747239402747, 0.8565809020766398, 0.02758835018344352],
];
const RATES_FROM_REST: [[f64; 3]; 2] = [[0.0; 3], [9.751635347691358e-05, 8.882593782196596e-06, 1.53007486831241e-05]];
const RATES_FROM_RATE: [[f64; 3]; 2] =
    [WITH_ORBIT, [-0.0007282187220568775, -0.0008332384627087039, -0.0002424925044840342]];

/// With zero rate (8A, 9A, 9C) and that of the orbit (8B, 9B, 9D); then on a circle (10A) and on an ellipse (10C),
/// there with an additional rate in pitch too (10D).
pub const JEOD_RUNS: [JeodRun; 9] = [
    JeodRun {
        name: "RUN_10A",
        craft: Craft::Cylinder,
        start: CIRCLE,
        attitude: [0.2949554834573935, 0.3013397571377723, -0.5879739300516263, 0.6902769524808205],
        rates: [
            [-1.97989570839746e-05, -0.001134281491669957, 0.0],
            [-1.97989570839746e-05, -0.001080027400090759, -0.0007098670173048437],
        ],
        position: ON_CIRCLE,
        dcm: [
            [-0.1303977224153033, -0.9235551691194414, 0.3606137595567613],
            [-0.9835635249313684, 0.0746803593168579, -0.1643947576928366],
            [0.1248968631050554, -0.3761232424685627, -0.9181133263717784],
        ],
        own: [1e-5, 1e-15, 1e-12],
    },
    JeodRun {
        name: "RUN_10C",
        craft: Craft::Cylinder,
        start: ELLIPSE,
        attitude: [0.2949554836647295, 0.3013397570548775, -0.5879739299692612, 0.6902769524985716],
        rates: [
            [-1.958561461497211e-05, -0.001122059109806593, 0.0],
            [-1.958561461497211e-05, -0.001102150420357001, -0.0007137081527530395],
        ],
        position: [-1051395.223245429, -6116653.272961161, 2626343.274205685],
        dcm: [
            [-0.1416223422259105, -0.9171375917053928, 0.372561068904521],
            [-0.9814677649343182, 0.08101112610984618, -0.1736612329832083],
            [0.1290896532541655, -0.3902509901681823, -0.9116139676943704],
        ],
        own: [2e-5, 1e-15, 4e-12],
    },
    JeodRun {
        name: "RUN_10D",
        craft: Craft::Cylinder,
        start: ELLIPSE,
        attitude: [0.2949554836647295, 0.3013397570548775, -0.5879739299692612, 0.6902769524985716],
        rates: [
            [-1.958561461497211e-05, -0.00094752618460716, 0.0],
            [-1.958561461497211e-05, -0.001062058853745821, -0.0006901638686869954],
        ],
        position: [-1051395.223245429, -6116653.272961161, 2626343.274205685],
        dcm: [
            [-0.09270989340746383, -0.9435593558564048, 0.3179632331578974],
            [-0.9864361111063251, 0.04359502545335181, -0.1582506633829749],
            [0.1354572787627401, -0.3283218173249661, -0.9348027117518567],
        ],
        own: [2e-5, 1e-15, 4e-12],
    },
    JeodRun {
        name: "RUN_8A",
        craft: Craft::Sphere,
        start: CIRCLE,
        attitude: DOCKING,
        rates: [[0.0; 3]; 2],
        position: ON_CIRCLE,
        dcm: [
            [0.1412307175854335, -0.9892782736897275, 0.03718039289432368],
            [-0.772691975098125, -0.1336331223242703, -0.6205556383087864],
            [0.6188707425862547, 0.05891252687959725, -0.7832804849780175],
        ],
        own: [1e-5, 1e-15, 1e-12],
    },
    JeodRun {
        name: "RUN_8B",
        craft: Craft::Sphere,
        start: CIRCLE,
        attitude: DOCKING,
        rates: [WITH_ORBIT; 2],
        position: ON_CIRCLE,
        dcm: [
            [0.6322077530740586, -0.2499436545972102, -0.7333767970693106],
            [-0.7726919750981422, -0.1336331223243263, -0.6205556383087529],
            [0.05710051288720835, 0.9589944515712499, -0.2776133521348992],
        ],
        own: [1e-5, 1e-15, 1e-12],
    },
    JeodRun {
        name: "RUN_9A",
        craft: Craft::Station(0.0),
        start: CIRCLE,
        attitude: DOCKING,
        rates: RATES_FROM_REST,
        position: ON_CIRCLE,
        dcm: FROM_REST,
        own: [1e-5, 1e-15, 1e-12],
    },
    JeodRun {
        name: "RUN_9B",
        craft: Craft::Station(0.0),
        start: CIRCLE,
        attitude: DOCKING,
        rates: RATES_FROM_RATE,
        position: ON_CIRCLE,
        dcm: FROM_RATE,
        own: [1e-5, 1e-15, 4e-12],
    },
    JeodRun {
        name: "RUN_9C",
        craft: Craft::Station(10.0),
        start: CIRCLE,
        attitude: DOCKING,
        rates: RATES_FROM_REST,
        position: [-1024344.851005548, -6151032.154589829, 2600064.501242927],
        dcm: FROM_REST,
        own: [5e-5, 1e-15, 1e-12],
    },
    JeodRun {
        name: "RUN_9D",
        craft: Craft::Station(10.0),
        start: CIRCLE,
        attitude: DOCKING,
        rates: RATES_FROM_RATE,
        position: [-1025520.528823931, -6150303.502198037, 2601370.944587371],
        dcm: FROM_RATE,
        own: [5e-5, 1e-15, 4e-12],
    },
];

impl JeodRun {
    /// The scene as written; a run without its torques where `acts` is false.
    pub fn input(&self, acts: bool) -> SceneInput {
        let [position, velocity] = self.start;
        let orbit = OrbitInput {
            mu_m3_s2: 3.986004415e14,
            position_m: Some(position),
            velocity_m_s: Some(velocity),
            ..OrbitInput::DEFAULT
        };
        let moments = if self.craft == Craft::Sphere { [0.4; 3] } else { [500.0, 12250.0, 12250.0] };
        let mut input = body(moments, orbit);
        input.environment.gravity_gradient = acts && self.craft == Craft::Cylinder;
        input.initial.angular_velocity_rad_s = self.rates[0];
        input.initial.attitude = self.attitude;
        match self.craft {
            Craft::Cylinder => input,
            Craft::Sphere => {
                input.body.mass_kg = Some(1.0);
                input
            }
            Craft::Station(force) => station(input, acts, force),
        }
    }
}

/// `input` with the mass properties of the space station, and its pulse where `acts`: the torque is that of two
/// thrusters on both sides of the centre of mass.
fn station(mut input: SceneInput, acts: bool, force: f64) -> SceneInput {
    let center = [-3.0, -1.5, 4.0];
    input.body.mass_kg = Some(4e5);
    input.body.center_of_mass_m = Some(center);
    input.body.inertia_kg_m2 = Some([[1.02e8, -6.96e6, -5.48e6], [-6.96e6, 0.91e8, 5.9e5], [-5.48e6, 5.9e5, 1.64e8]]);
    let thruster = |name: &str, arm: [f64; 3], direction| ThrusterInput {
        name: Name::of(name),
        ..ThrusterInput::named("p", sum(center, arm), direction)
    };
    input.thrusters = vec![
        thruster("up", [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]),
        thruster("down", [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]),
        thruster("ahead", [0.0; 3], [1.0, 0.0, 0.0]),
    ];
    if acts {
        input.with_actuation(ActuationInput::idle(1000.0, 2000.0).with_thrust(&[5.0, 5.0, force]))
    } else {
        input
    }
}

/// Truth: NASA JEOD after eight hours. What differs is JEOD's own error: every method is nearer to the reference
/// solution than JEOD.
#[test]
fn nasa_jeod_runs() {
    let grid = Grid::uniform(28_800.0, 481);
    for jeod in &JEOD_RUNS {
        let scene = Scene::resolve(&jeod.input(true)).expect("a legal scene");
        let fields = everything(Method::Auto);
        let exact = ReferenceSolution::new(Isa::best(), &scene, &grid, fields, TOLERANCE).expect("a solution").high;
        let from = |table: &StateTable, position: [f64; 3], rate: [f64; 3], dcm: [[f64; 3]; 3]| {
            let c_es = dcm_from_quaternion(table.at(StateField::Attitude, 480));
            let entries = (0..9).map(|k| (c_es[k % 3][k / 3] - dcm[k / 3][k % 3]).abs());
            [
                norm(difference(table.at(StateField::ComPosition, 480), position)),
                norm(difference(table.at(StateField::Rate, 480), rate)),
                entries.fold(0.0, f64::max),
            ]
        };
        let shown = |[m, rate, angle]: [f64; 3]| format!("{m:.1e} m, {rate:.1e} rad/s, {angle:.1e} rad");
        let theirs = from(&exact, jeod.position, jeod.rates[1], jeod.dcm);
        println!("{} itself: {}", jeod.name, shown(theirs));
        let c_es = dcm_from_quaternion(exact.at(StateField::Attitude, 480));
        let transposed = core::array::from_fn(|i| core::array::from_fn(|j| c_es[j][i]));
        for (method, control) in near_rounding(ForceModel::of(&scene)) {
            let run = propagate(method, control, &grid, std::slice::from_ref(&scene)).remove(0);
            let off = from(&run.table, jeod.position, jeod.rates[1], jeod.dcm);
            let ours =
                from(&run.table, exact.at(StateField::ComPosition, 480), exact.at(StateField::Rate, 480), transposed);
            println!("{} {}: {}, from the reference solution {}", jeod.name, method.name(), shown(off), shown(ours));
            for (off, bound) in off.into_iter().zip(jeod.own) {
                assert!(off < bound, "{} {}", jeod.name, method.name());
            }
            assert!(ours[0] < 1e-6 && ours[1] < 1e-15 && ours[2] < 2e-13, "{} {}", jeod.name, method.name());
        }
        // the counter-test: without its torques the body points elsewhere
        if jeod.craft != Craft::Sphere {
            let scene = Scene::resolve(&jeod.input(false)).expect("a legal scene");
            let run = propagate(Method::Auto, adaptive(1e-16), &grid, &[scene]).remove(0);
            assert!(norm(difference(run.table.at(StateField::Rate, 480), jeod.rates[1])) > 1e-5, "{}", jeod.name);
        }
    }
}
