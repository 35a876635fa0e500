//! Several attitude sensors in one loop lower the error of the filter by the sum of their informations.

use crate::prelude::*;
use spindrift::dynamics::orbit::KeplerOrbit;

const AT_REST: &str = r#"
[campaign]
name = "at_rest"
samples = 801
seed = 5
duration_s = 100
[observe]
points = 3
[body]
mass_kg = 100
center_of_mass_m = [0, 0, 0]
inertia_kg_m2 = [[30, 0, 0], [0, 36, 0], [0, 0, 24]]
includes_wheels = true
[[wheels]]
name = "w1"
axis = [1, 0, 0]
mass_kg = 1
axial_inertia_kg_m2 = 0.01
transverse_inertia_kg_m2 = 0.006
[control]
period_s = 1
estimator = "mekf"
wheels = ["w1"]
initial_attitude_sigma_rad = 0.1
initial_bias_sigma_rad_s = 1e-12
[[guidance]]
phase = "damp"
law = "rate_damping"
gain_n_m_s = 1e-6
[[disperse]]
parameter = "body.inertia_scale"
distribution = "normal"
std = 0.001
[[sensors]]
name = "gyro"
kind = "rate_gyro"
[[sensors]]
name = "coarse"
kind = "star_tracker"
noise_rad = [1e-3, 2e-3, 2e-2]
"#;

const SUN: &str = "[[sensors]]\nname = \"sun\"\nkind = \"sun_sensor\"\nnoise_rad = 3e-3\nboresight = [1, 0, 0]\n";
const SECOND: &str = "[[sensors]]\nname = \"fine\"\nkind = \"star_tracker\"\nperiod_s = 2\nnoise_rad = [4e-4, 4e-4, \
    4e-3]\nboresight = [0, 1, 0]\n";

fn information(count: f64, sigma: f64) -> f64 {
    count / (sigma * sigma)
}

/// Compares 800 runs: the mean square of the attitude error, and of innovations (one).
fn assert_theory(plan: &Plan, mean: f64, squares: f64, what: &str) {
    let (n, table) = (800.0, rows(plan));
    let column = |name: &str| table.column(name)[1..].to_vec();
    let found = column("attitude_estimate_error_final_rad").iter().map(|error| error * error).sum::<f64>() / n;
    let deviation = (2.0 * squares / n).sqrt();
    assert!((found - mean).abs() < 4.5 * deviation, "{what}: {found:e} for {mean:e} +- {deviation:e}");
    let innovations = column("attitude_innovation_mean").iter().sum::<f64>() / n;
    assert!((innovations - 1.0).abs() < 4.5 * (2.0 / (2.0 * 100.0 * n)).sqrt(), "{what}: {innovations}");
}

/// Law: the mean square of the attitude error is the sum over the axes of 1/(information of all sensors).
#[test]
fn each_sensor_lowers_the_error_as_theory_says() {
    let coarse = [1e-3, 2e-3, 2e-2].map(|sigma| information(100.0, sigma) + information(1.0, 0.1));
    let sun = [0.0, information(100.0, 3e-3), information(100.0, 3e-3)];
    let second = [4e-4, 4e-3, 4e-4].map(|sigma| information(50.0, sigma));
    let none = [0.0; 3];
    let mut expected = Vec::new();
    for (sensors, added) in [
        (String::new(), [none, none]),
        (SUN.into(), [sun, none]),
        (SECOND.into(), [none, second]),
        (format!("{SUN}{SECOND}"), [sun, second]),
    ] {
        let variances: [f64; 3] = from_fn(|axis| 1.0 / (coarse[axis] + added[0][axis] + added[1][axis]));
        let mean = variances.iter().sum::<f64>();
        assert_theory(&plan(&format!("{AT_REST}{sensors}")), mean, variances.iter().map(|v| v * v).sum(), &sensors);
        expected.push(mean);
    }
    assert!(expected[0] > 8.0 * expected[1] && expected[0] > 18.0 * expected[2], "{expected:?}");
}

#[test]
fn the_mean_of_innovations_is_of_all_measurements() {
    let doubled = "[[disperse]]\nparameter = \"sensors.coarse.noise_rad\"\ndistribution = \"offset\"\noffset = [1e-3, \
        2e-3, 2e-2]\n";
    let table = rows(&plan(&format!("{AT_REST}{SECOND}{doubled}")));
    let all = &table.column("attitude_innovation_mean")[1..];
    let mean = all.iter().sum::<f64>() / all.len() as f64;
    assert!((mean - 3.0).abs() < 0.1, "{mean}");
}

fn on_orbit(sensors: &str) -> String {
    let orbit = "[orbit]\nepoch = \"2026-11-24T00:00:00Z\"\nsemi_major_axis_m = 7e6\ninclination_rad = \
        1.7\ntrue_anomaly_rad = 0.8\n[environment]\nmagnetic_field = \"igrf\"\n";
    format!("{AT_REST}{orbit}{sensors}")
}

/// Law: on an orbit a horizon sensor and a magnetometer lower the error by the information of their turning directions.
#[test]
fn directions_of_an_orbit_lower_the_error_as_theory_says() {
    const SIGMAS: [f64; 2] = [3e-3, 1e-7];
    let horizon = format!(
        "[[sensors]]\nname = \"horizon\"\nkind = \"horizon_sensor\"\nnoise_rad = {:?}\nboresight = [-0.7, 0.1, -0.7]\n",
        SIGMAS[0]
    );
    let field =
        format!("[[sensors]]\nname = \"field\"\nkind = \"magnetometer\"\nnoise_t = [{0:?}, {0:?}, {0:?}]\n", SIGMAS[1]);
    let tracker = [1e-3, 2e-3, 2e-2].map(|sigma| information(100.0, sigma) + information(1.0, 0.1));
    let mut means = Vec::new();
    for (sensors, has) in [
        (String::new(), [0.0; 2]),
        (horizon.clone(), [1.0, 0.0]),
        (field.clone(), [0.0, 1.0]),
        (format!("{horizon}{field}"), [1.0; 2]),
    ] {
        let plan = plan(&on_orbit(&sensors));
        let nominal = resolved(&plan.nominal);
        let orbit = KeplerOrbit::new(nominal.orbit.as_ref().unwrap());
        let magnetic = MagneticField::of(&nominal).unwrap();
        let mut all = [[0.0; 3]; 3];
        for (axis, row) in all.iter_mut().enumerate() {
            row[axis] = tracker[axis];
        }
        for tick in 0..100 {
            let r = orbit.state(f64::from(tick)).position;
            let nadir = scaled(-1.0 / norm(r), r);
            for ((u, sigma), is_there) in [nadir, magnetic.at(f64::from(tick), r)].into_iter().zip(SIGMAS).zip(has) {
                for i in 0..3 {
                    for j in 0..3 {
                        let unit = if i == j { dot(u, u) } else { 0.0 };
                        all[i][j] += is_there * (unit - u[i] * u[j]) / (sigma * sigma);
                    }
                }
            }
        }
        let covariance = nalgebra::Matrix3::from_fn(|i, j| all[i][j]).try_inverse().unwrap();
        let mean = covariance.trace();
        assert_theory(&plan, mean, (covariance * covariance).trace(), &sensors);
        means.push(mean);
    }
    assert!(means[0] > 8.0 * means[1] && means[0] > 8.0 * means[2] && means[1] > 1.1 * means[3], "{means:?}");
}
