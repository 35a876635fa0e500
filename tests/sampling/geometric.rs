//! Distributions of directions, attitudes and inertias in campaign files; alpha = 1e-3.

use crate::prelude::*;
use std::f64::consts::TAU;

use crate::support::draws::distance;

const HEAD: &str = "[campaign]\nname = \"test\"\nsamples = 10\nseed = 11\nduration_s = 1.0\n";

const DEBRIS_AND_STATE: &str = "[debris]\nmass_kg = 20.0\nprincipal_second_moments_kg_m2 = [1.0, 2.0, 3.0]\n\
    [initial]\nangular_velocity_rad_s = [1.0, -2.0, 2.0]\nattitude = [0.5, 0.5, -0.5, 0.5]\n";

pub fn campaign(text: &str) -> String {
    [HEAD, FUSELAGE, DEBRIS_AND_STATE, text].concat()
}

const N: usize = 100_000;
/// sqrt(n) D of Kolmogorov and Smirnov: sqrt(-ln(alpha/2)/2); a deviation by 0.01 is 3.2 of these.
const KS: f64 = 1.949;
/// Quantiles 1 - alpha of chi-square with 3, 5, 9 degrees of freedom (Abramowitz & Stegun, 26.8).
const CHI_3: f64 = 16.266;
const CHI_5: f64 = 20.515;
const CHI_9: f64 = 27.877;

pub fn plan(disperse: &str) -> Plan {
    let text = campaign(&format!("[[disperse]]\n{disperse}"));
    planned(&text)
}

fn draws<T>(disperse: &str, seen: impl Fn(&SceneInput) -> T) -> Vec<T> {
    draws::seen(&plan(disperse), 1..=N as u64, |scene, _| seen(scene))
}

fn rate(scene: &SceneInput) -> [f64; 3] {
    scene.initial.angular_velocity_rad_s
}

/// Rayleigh's statistic of isotropy, chi-square with 3 degrees of freedom (K. V. Mardia & P. E. Jupp, *Directional
/// Statistics*, 2000, 10.4.1): sees a preferred direction.
fn rayleigh(directions: &[[f64; 3]]) -> f64 {
    let n = directions.len() as f64;
    let mean: [f64; 3] = from_fn(|i| directions.iter().map(|d| d[i]).sum::<f64>() / n);
    3.0 * n * dot(mean, mean)
}

/// Bingham's statistic of uniformity on the sphere in `P` dimensions, chi-square with (p - 1)(p + 2)/2 degrees of
/// freedom (ibid., 10.7.1): sees a preferred axis, whatever its sign.
fn bingham<const P: usize>(points: &[[f64; P]]) -> f64 {
    let (n, p) = (points.len() as f64, P as f64);
    let mut square = 0.0;
    for i in 0..P {
        for j in 0..P {
            let mean = points.iter().map(|x| x[i] * x[j]).sum::<f64>() / n;
            square += mean * mean;
        }
    }
    n * p * (p + 2.0) / 2.0 * (square - 1.0 / p)
}

/// Angles about an axis: the cosine to it, and the azimuth from 0 to 1.
fn about(axis: [f64; 3], v: [f64; 3]) -> [f64; 2] {
    let z = scaled(1.0 / norm(axis), axis);
    let v = scaled(1.0 / norm(v), v);
    let x = cross([0.3, 0.4, -0.8], z);
    let x = scaled(1.0 / norm(x), x);
    let azimuth = libm::atan2(dot(v, cross(z, x)), dot(v, x)) / TAU;
    [dot(v, z), azimuth.rem_euclid(1.0)]
}

pub const RATE: &str = "parameter = \"initial.angular_velocity_rad_s\"\n";

/// Power: a concentration of 0.03, or E[z^2] off by 0.005, is missed with a probability below 1e-2.
#[test]
fn directions_are_uniform_on_the_sphere() {
    let rates = draws(&format!("{RATE}distribution = \"uniform_direction\"\n"), rate);
    for (row, v) in rates.iter().enumerate() {
        // measured: two ulps
        assert!((norm(*v) / 3.0 - 1.0).abs() < 1e-15 * 8.0, "row {row}: {v:?}");
    }
    let directions: Vec<[f64; 3]> = rates.iter().map(|v| scaled(1.0 / 3.0, *v)).collect();
    let (first, second) = (rayleigh(&directions), bingham(&directions));
    assert!(first < CHI_3 && second < CHI_5, "{first} {second}");
    for i in 0..3 {
        let far = distance(directions.iter().map(|d| d[i]), |x| (1.0 + x) / 2.0);
        assert!(far < KS, "component {i} is uniform (Archimedes): {far}");
    }
}

/// H0: azimuth and cosine are uniform in a cone about the nominal or an axis.
#[test]
fn cones_are_uniform_in_solid_angle() {
    let thruster = "[[thrusters]]\nname = \"a\"\nposition_m = [1, 0, 0]\ndirection = [0, 3, 4]\n\
        [[actuation]]\nname = \"burn\"\nstart_s = 0\nend_s = 1\nthrust_n = { a = 3 }\n";
    type Seen = fn(&SceneInput) -> [f64; 3];
    let cases: [(&str, Seen, f64, Option<[f64; 3]>); 6] = [
        ("initial.angular_velocity_rad_s", rate, 0.2, None),
        ("initial.angular_velocity_rad_s", rate, 1e-6, None),
        ("initial.angular_velocity_rad_s", rate, 2.5, Some([0.0, 3.0, 4.0])),
        ("initial.angular_velocity_rad_s", rate, PI, None),
        ("wheels.w1.axis", |scene| scene.wheels[0].axis, 0.2, None),
        ("thrusters.a.direction", |scene| scene.thrusters[scene.thrusters.len() - 1].direction, 0.2, None),
    ];
    for (parameter, seen, half_angle, axis) in cases {
        let written = axis.map_or(String::new(), |axis: [f64; 3]| format!("axis = {axis:?}\n"));
        let disperse = format!(
            "parameter = {parameter:?}\ndistribution = \"cone\"\nhalf_angle_rad = \
            {half_angle:?}\n{written}{WHEEL1}{thruster}"
        );
        let plan = plan(&disperse);
        let length = norm(seen(&plan.nominal));
        let axis = axis.unwrap_or(seen(&plan.nominal));
        let drawn = draws(&disperse, seen);
        let azimuth = distance(drawn.iter().map(|v| about(axis, *v)[1]), |x| x);
        // 1 - cos from the sine of half the angle: |v/|v| - axis|^2/2, which keeps its digits in a needle
        let versine = |v: &[f64; 3]| {
            let (v, z) = (scaled(1.0 / norm(*v), *v), scaled(1.0 / norm(axis), axis));
            0.5 * (0..3).map(|i| (v[i] - z[i]) * (v[i] - z[i])).sum::<f64>()
        };
        let whole = 2.0 * libm::sin(0.5 * half_angle) * libm::sin(0.5 * half_angle);
        let cosine = distance(drawn.iter().map(versine), |x| x / whole);
        assert!(azimuth < KS && cosine < KS, "{parameter}, {half_angle}: {azimuth} {cosine}");
        assert!(drawn.iter().all(|v| (norm(*v) / length - 1.0).abs() < 1e-14), "{parameter}: the length stays");
        for sample in 1..10 {
            assert!(spindrift::campaign::draw(&plan, SampleId(sample)).is_ok(), "{parameter} {sample}");
        }
    }
}

/// H0: P(1 - cos <= v) = (1 - exp(-kappa v))/(1 - exp(-2 kappa)), uniform azimuth, mean resultant coth(kappa) -
/// 1/kappa, whose estimate has a standard deviation below 1/(kappa sqrt(n)).
#[test]
fn von_mises_and_fisher() {
    for kappa in [0.5, 5.0, 400.0] {
        let rates = draws(&format!("{RATE}distribution = \"von_mises_fisher\"\nconcentration = {kappa:?}\n"), rate);
        let axis = [1.0, -2.0, 2.0];
        let angles: Vec<[f64; 2]> = rates.iter().map(|v| about(axis, *v)).collect();
        let azimuth = distance(angles.iter().map(|a| a[1]), |x| x);
        let law = |v: f64| libm::expm1(-kappa * v) / libm::expm1(-2.0 * kappa);
        let versine = distance(angles.iter().map(|a| 1.0 - a[0]), law);
        let mean = angles.iter().map(|a| a[0]).sum::<f64>() / N as f64;
        let off = mean - (1.0 / libm::tanh(kappa) - 1.0 / kappa);
        let sigma = (1.0 / (kappa * kappa)).min(1.0 / 3.0).sqrt() / (N as f64).sqrt();
        assert!(azimuth < KS && versine < KS && off.abs() < 3.29 * sigma, "{kappa}: {azimuth} {versine} {off}");
    }
}

/// H0: each of 4 x 4 x 4 cells of the distribution functions of angle, azimuth and magnitude has a share of 1/64.
#[test]
fn magnitude_azimuth_and_angle_are_apart() {
    const CHI_63: f64 = 103.442;
    let magnitude = "magnitude = { distribution = \"uniform\", min = 1, max = 5 }\n";
    type Law = fn(f64) -> f64;
    let laws: [(&str, Law); 3] = [
        ("distribution = \"uniform_direction\"\n", |versine| versine / 2.0),
        ("distribution = \"cone\"\nhalf_angle_rad = 0.5\n", |versine| versine / (1.0 - libm::cos(0.5))),
        ("distribution = \"von_mises_fisher\"\nconcentration = 5.0\n", |v| libm::expm1(-5.0 * v) / libm::expm1(-10.0)),
    ];
    for (name, law) in laws {
        let mut counts = [0.0; 64];
        for v in draws(&format!("{RATE}{name}{magnitude}"), rate) {
            let [cosine, azimuth] = about([1.0, -2.0, 2.0], v);
            let cell = |u: f64| ((4.0 * u) as usize).min(3);
            counts[16 * cell(law(1.0 - cosine)) + 4 * cell(azimuth) + cell((norm(v) - 1.0) / 4.0)] += 1.0;
        }
        let expected = N as f64 / 64.0;
        let statistic = counts.iter().map(|count| (count - expected) * (count - expected) / expected).sum::<f64>();
        assert!(statistic < CHI_63, "{name}: {statistic}");
    }
    // a zero nominal has neither: both are given
    let zero = "parameter = \"initial.velocity_m_s\"\ndistribution = \"uniform_direction\"\n\
        magnitude = { distribution = \"uniform\", min = 0, max = 2 }\n";
    let speeds = draws(zero, |scene| norm(scene.initial.velocity_m_s));
    assert!(distance(speeds, |x| x / 2.0) < KS);
}

/// H0: quaternions are uniform on the 3-sphere, E[C33^2] = 1/3 with variance 4/45, and the angle has the distribution
/// (theta - sin theta)/pi.
#[test]
fn attitudes_are_uniform_on_so3() {
    let list = draws("parameter = \"initial.attitude\"\ndistribution = \"uniform_attitude\"\n", |s| s.initial.attitude);
    assert!(bingham(&list) < CHI_9, "{}", bingham(&list));
    let mean = list.iter().map(|q| dcm_from_quaternion(*q)[2][2].powi(2)).sum::<f64>() / N as f64;
    assert!((mean - 1.0 / 3.0).abs() < 3.29 * (4.0 / 45.0 / N as f64).sqrt(), "{mean}");
    let trace = |q: &[f64; 4]| (0..3).map(|i| dcm_from_quaternion(*q)[i][i]).sum::<f64>();
    let angle = |q: &[f64; 4]| libm::acos(((trace(q) - 1.0) / 2.0).clamp(-1.0, 1.0));
    let far = distance(list.iter().map(angle), |theta| (theta - libm::sin(theta)) / PI);
    assert!(far < KS, "{far}");
}

fn error(q: [f64; 4]) -> [f64; 3] {
    let off = hamilton(conjugate([0.5, 0.5, -0.5, 0.5]), q);
    let off = if off[0] < 0.0 { off.map(|x| -x) } else { off };
    let sine = norm([off[1], off[2], off[3]]);
    let angle = 2.0 * libm::atan2(sine, off[0]);
    let share = if sine > 0.0 { angle / sine } else { 2.0 };
    [share * off[1], share * off[2], share * off[3]]
}

/// H0: theta^T P^-1 theta is chi-square with 3 degrees of freedom, and mean products are P, within 3.29 standard
/// deviations ((p_ii p_jj + p_ij^2)/n).
#[test]
fn attitude_errors_have_their_covariance() {
    let p = [[4e-4, 1e-4, 0.0], [1e-4, 1e-4, -5e-5], [0.0, -5e-5, 2.5e-4]];
    let law = format!("parameter = \"initial.attitude\"\ndistribution = \"attitude_error\"\ncovariance_rad2 = {p:?}\n");
    let thetas: Vec<[f64; 3]> = draws(&law, |s| error(s.initial.attitude));
    for i in 0..3 {
        for j in 0..3 {
            let mean = thetas.iter().map(|t| t[i] * t[j]).sum::<f64>() / N as f64;
            let sigma = ((p[i][i] * p[j][j] + p[i][j] * p[i][j]) / N as f64).sqrt();
            assert!((mean - p[i][j]).abs() < 3.29 * sigma, "{i}{j}: {mean} {}", p[i][j]);
        }
    }
    let chi_3 = |x: f64| libm::erf((x / 2.0).sqrt()) - (2.0 * x / PI).sqrt() * libm::exp(-x / 2.0);
    let std = "parameter = \"initial.attitude\"\ndistribution = \"attitude_error\"\nstd_rad = [0.01, 0.02, 0.04]\n";
    let squares = draws(std, |s| {
        let [a, b, c] = error(s.initial.attitude);
        (a / 0.01).powi(2) + (b / 0.02).powi(2) + (c / 0.04).powi(2)
    });
    let far = distance(squares, chi_3);
    assert!(far < KS, "{far}");
}

#[test]
fn attitudes_turn_about_an_axis() {
    let law = "parameter = \"initial.attitude\"\ndistribution = \"about_axis\"\naxis = [0, 3, 4]\n\
        angle_rad = { distribution = \"uniform\", min = -1, max = 2 }\n";
    let thetas = draws(law, |s| error(s.initial.attitude));
    for (row, t) in thetas.iter().enumerate() {
        // measured: 6.7e-16
        assert!(t[0].abs() < 1e-14 && (t[1] * 0.8 - t[2] * 0.6).abs() < 1e-14, "row {row}: {t:?}");
    }
    let far = distance(thetas.iter().map(|t| 0.6 * t[1] + 0.8 * t[2]), |x| (x + 1.0) / 3.0);
    assert!(far < KS, "{far}");
}

#[test]
fn usual_mistakes_are_caught() {
    let uniform = draws(&format!("{RATE}distribution = \"uniform\"\nmin = -1\nmax = 1\n"), rate);
    // components of a cube: second moments are blind to its corners
    let cube: Vec<f64> = uniform.iter().map(|v| v[2] / norm(*v)).collect();
    // measured: 5.5 KS
    assert!(distance(cube, |x| (1.0 + x) / 2.0) > 3.0 * KS);
    // two quadrants only; measured: 4905 times the critical value
    let half: Vec<[f64; 3]> = uniform.iter().map(|v| scaled(1.0 / norm(*v), [v[0].abs(), v[1], v[2]])).collect();
    assert!(rayleigh(&half) > 100.0 * CHI_3);
    // uniform angles to the axis: towards the pole; measured: 1521 times the critical value
    let polar: Vec<[f64; 3]> = uniform
        .iter()
        .map(|v| {
            let ((s, c), (sp, cp)) = (libm::sincos(PI * (v[0] + 1.0) / 2.0), libm::sincos(PI * v[1]));
            [s * cp, s * sp, c]
        })
        .collect();
    assert!(bingham(&polar) > 100.0 * CHI_5);
    // uniform Euler angles: E[C33^2] = 1/2; measured: 178 standard errors off
    let mean = uniform.iter().map(|v| libm::cos(PI * v[0]).powi(2)).sum::<f64>() / N as f64;
    assert!((mean - 1.0 / 3.0).abs() > 100.0 * (4.0 / 45.0 / N as f64).sqrt());
    // a quaternion of uniform numbers, normalised; measured: 12.1 KS
    let uniform = draws("parameter = \"initial.attitude\"\ndistribution = \"uniform\"\nmin = -1\nmax = 1\n", |s| {
        s.initial.attitude
    });
    let quaternion = distance(uniform.iter().map(|q| libm::acos(q[0].abs().min(1.0)) * 2.0), |theta| {
        (theta - libm::sin(theta)) / PI
    });
    assert!(quaternion > 3.0 * KS, "{quaternion}");
}

fn impossible(text: &str, count: u64) -> usize {
    let plan = planned(text);
    let mut scene = resolved(&plan.nominal);
    let refused = draws::seen(&plan, 1..=count, |input, _| scene.resolve_into(input).is_err());
    refused.into_iter().filter(|is_refused| *is_refused).count()
}

/// Counter-test: principal moments that are drawn freely do not.
#[test]
fn a_million_bodies_and_none_impossible() {
    let normal = |key: &str, std: f64| {
        format!("[[disperse]]\nparameter = \"{key}\"\ndistribution = \"normal\"\nstd = {std:?}\n")
    };
    let second = "[[disperse]]\nparameter = \"debris.principal_second_moments_kg_m2\"\ndistribution = \
        \"log_normal\"\nlog_std = 2.0\n\
        [[disperse]]\nparameter = \"debris.principal_axes\"\ndistribution = \"uniform_attitude\"\n";
    let scale = "[[disperse]]\nparameter = \"body.mass_scale\"\ndistribution = \"log_normal\"\nlog_std = 0.5\n";
    let all = [
        normal("body.stretch_log", 1.0),
        normal("body.shear", 1.0),
        normal("body.center_offset_m", 1.0),
        scale.to_owned(),
        second.to_owned(),
    ]
    .concat();
    assert_eq!(impossible(&campaign(&all), 1_000_000), 0);

    let free =
        "[[disperse]]\nparameter = \"debris.principal_moments_kg_m2\"\ndistribution = \"normal\"\nrelative_std = 0.1\n";
    let moments = campaign(free)
        .replace("principal_second_moments_kg_m2 = [1.0, 2.0, 3.0]", "principal_moments_kg_m2 = [1.0, 1.5, 2.3]");
    let refused = impossible(&moments, 10_000);
    // measured: 2415
    assert!(refused > 500, "{refused}");
}

/// Law: the mean cosine of a cone of half-angle a is (1 + cos a)/2, of von Mises-Fisher coth(kappa) - 1/kappa.
#[test]
fn mean_directions_follow_the_axis_in_all_octants() {
    const DRAWS: u64 = 4000;
    let signs = [-1.0, 1.0];
    let mut axes: Vec<[f64; 3]> =
        signs.iter().flat_map(|x| signs.iter().flat_map(move |y| signs.map(|z| [*x, 2.0 * y, 3.0 * z]))).collect();
    axes.extend((0..6).map(|k| from_fn(|i| if i == k / 2 { signs[k % 2] } else { 0.0 })));
    let kappa: f64 = 20.0;
    let laws = [
        ("distribution = \"cone\"\nhalf_angle_rad = 0.8\n", 0.5 * (1.0 + libm::cos(0.8))),
        ("distribution = \"von_mises_fisher\"\nconcentration = 20.0\n", 1.0 / libm::tanh(kappa) - 1.0 / kappa),
    ];
    for axis in axes {
        for (law, cosine) in laws {
            let written = plan(&format!("{RATE}{law}axis = {axis:?}\n"));
            let along =
                campaign(&format!("[[disperse]]\n{RATE}{law}")).replace("[1.0, -2.0, 2.0]", &format!("{axis:?}"));
            let nominal = parsed(&along);
            for plan in [written, nominal.unwrap()] {
                let mut mean = [0.0; 3];
                for v in draws::seen(&plan, 1..=DRAWS, |scene, _| rate(scene)) {
                    (0..3).for_each(|i| mean[i] += v[i] / norm(v) / DRAWS as f64);
                }
                let expected = scaled(cosine / norm(axis), axis);
                let off: f64 = (0..3).map(|i| (mean[i] - expected[i]).powi(2)).sum::<f64>().sqrt();
                // the cone has 0.0058 in either direction across the axis: exceeded with a probability below 1e-10.
                // Measured: 0.006
                assert!(off < 0.04, "{law} about {axis:?}: mean {mean:?}, expected {expected:?}");
            }
        }
    }
}
