//! The shipped campaign `dual_spin` finds the classical boundary of a stable spin with a rotor about the spin axis.
//!
//! With the moment K3 about the spin axis, the spin rate omega and the rotor's momentum h, K = K3 + h/omega has to be
//! above or below both transverse moments A and B (P. C. Hughes, *Spacecraft Attitude Dynamics*, 1986, 6.2).

use crate::prelude::*;

/// K of the campaign, kg m^2: K3 = 100, h = 5 N m s, omega = 0.5 rad/s.
const BOUNDARY: f64 = 110.0;
const SPIN_MOMENTUM: f64 = 55.0;
const SPIN: f64 = 0.5;
const TRANSVERSE: f64 = 1e-3;
const DURATION: f64 = 400.0;
const LEFT: f64 = 0.1745;

/// Relative distance of the largest angle from the reach of the ellipse. Measured: 9.1e-4.
const ELLIPSE: f64 = 2e-3;
/// Tolerance of the boundary, kg m^2. Measured: 0.05.
const FOUND: f64 = 0.5;

/// From this distance on, kg m^2, a stable spin stays within the first angle and an unstable one exceeds the second,
/// degrees. Measured: 0.395 and 65.8.
const CLEAR: f64 = 5.0;
const STABLE_DEG: f64 = 0.4;
const UNSTABLE_DEG: f64 = 65.0;

struct Spin {
    moments: [f64; 2],
    nutation: f64,
}

fn spins() -> Vec<Spin> {
    let plan = shipped("dual_spin", None);
    let table = rows(&plan);
    let mut draws = SceneDraws::new(&plan);
    assert!(table.statuses.iter().all(|status| *status == Status::Done), "every run is complete: {:?}", table.statuses);
    let nutation = table.column("nutation_angle_max_rad");
    (0..plan.samples)
        .map(|sample| {
            let inertia = draws.scene(SampleId(sample)).unwrap().mass.inertia;
            Spin { moments: [inertia[0][0], inertia[1][1]], nutation: nutation[sample as usize] }
        })
        .collect()
}

fn conic([a, b]: [f64; 2]) -> (f64, [f64; 2]) {
    let weights = [(BOUNDARY - a) / a, (BOUNDARY - b) / b];
    (weights[0] * (a * TRANSVERSE).powi(2) + weights[1] * (b * TRANSVERSE).powi(2), weights)
}

#[test]
fn the_campaign_finds_the_classical_boundary() {
    let spins = spins();
    let (mut ellipses, mut hyperbolas) = (0, 0);
    let mut worst = 0.0_f64;
    for Spin { moments: [a, b], nutation } in &spins {
        let (square, weights) = conic([*a, *b]);
        if weights[0] * weights[1] > 0.0 {
            let reach = (square / weights[0].abs().min(weights[1].abs()) * weights[0].signum()).sqrt() / SPIN_MOMENTUM;
            let rate = SPIN * (weights[0] * weights[1]).sqrt();
            if reach < 0.0175 && rate * DURATION > 2.0 * std::f64::consts::PI {
                worst = worst.max((nutation / reach - 1.0).abs());
                ellipses += 1;
            }
        } else {
            let growth = SPIN * (-weights[0] * weights[1]).sqrt() * DURATION;
            if growth > 12.0 {
                assert!(*nutation > LEFT, "A = {a}, B = {b}: left by {nutation} rad only");
                hyperbolas += 1;
            }
        }
    }
    assert!(ellipses > 1000 && hyperbolas > 1000, "{ellipses}, {hyperbolas}");
    assert!(worst < ELLIPSE, "{worst:e}");

    let clear = spins.iter().filter(|spin| spin.moments.iter().all(|moment| (moment - BOUNDARY).abs() > CLEAR));
    let (stable, unstable): (Vec<&Spin>, Vec<&Spin>) =
        clear.partition(|spin| (spin.moments[0] - BOUNDARY) * (spin.moments[1] - BOUNDARY) > 0.0);
    assert!(stable.len() > 1000 && unstable.len() > 1000, "{} {}", stable.len(), unstable.len());
    let degrees = |spins: &[&Spin]| spins.iter().map(|spin| spin.nutation.to_degrees()).collect::<Vec<f64>>();
    assert!(degrees(&stable).iter().all(|angle| *angle < STABLE_DEG), "a stable spin was left");
    assert!(degrees(&unstable).iter().all(|angle| *angle > UNSTABLE_DEG), "an unstable spin stayed");

    let wrong = |k: f64| {
        let is_wrong = |spin: &&Spin| {
            let is_stable = (spin.moments[0] - k) * (spin.moments[1] - k) > 0.0;
            is_stable == (spin.nutation > LEFT)
        };
        spins.iter().filter(is_wrong).count()
    };
    let candidates = (0..=800).map(|step| 90.0 + 0.05 * f64::from(step));
    let best = candidates.clone().map(wrong).min().unwrap();
    let found: Vec<f64> = candidates.filter(|k| wrong(*k) == best).collect();
    let middle = 0.5 * (found[0] + found[found.len() - 1]);
    assert!((middle - BOUNDARY).abs() <= FOUND, "{middle}");
    assert!(wrong(BOUNDARY - 5.0) > 2 * best && wrong(BOUNDARY + 5.0) > 2 * best, "the minimum is sharp");
}
