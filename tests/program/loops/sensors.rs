//! Every sensor in a loop delivers its measurement of the true state `latency_s` before, with its fixed errors.

use crate::prelude::*;
use spindrift::control::sensors::KINDS;

use crate::loops::flown_loop::State;

/// Rounding of tens of metres and rad/s (an ulp of 40 is 7e-15) of states between steps.
const AGREED: f64 = 1e-12;

const PERIOD: f64 = 0.5;
const GYRO_BIAS: [f64; 3] = [1e-3, -2e-3, 5e-4];
const GYRO_SCALE: [f64; 3] = [1.02, 0.97, 1.01];
const MISALIGNMENT: [f64; 3] = [0.02, -0.01, 0.03];
const TRACKER_BIAS: [f64; 3] = [4e-3, -3e-3, 2e-3];
const TACHOMETER_SCALE: f64 = 1.05;
/// Deviations: tracker by axis, radar and camera, tachometers, and the angle of the gyro after a second.
const TRACKER_NOISE: [f64; 3] = [1e-4, 2e-4, 3e-4];
const RADAR_NOISE: [f64; 2] = [0.3, 0.005];
const CAMERA_NOISE: [f64; 2] = [0.02, 0.003];
const TACHOMETER_NOISE: f64 = 0.01;
const GYRO_WALK: f64 = 1e-4;

const TRACKER: [f64; 2] = [1.0, 0.5];
const RADAR: [f64; 2] = [2.0, 1.0];
const CAMERA: [f64; 2] = [1.5, 1.0];
const SUN: [f64; 2] = [2.5, 1.5];
/// The Sun, the boresight of its sensor, and the error of both angles.
const SUN_E: [f64; 3] = [-0.48, 0.6, 0.64];
const BORESIGHT: [f64; 3] = [0.0, 1.0, 0.0];
const SUN_BIAS: f64 = 2e-3;
const SUN_NOISE: f64 = 1e-3;
const TRACKER_RATE: f64 = 0.015;
const CAMERA_RANGE: f64 = 38.0;

fn sun_sensor() -> String {
    format!(
        "[[sensors]]\nname = \"sun\"\nkind = \"sun_sensor\"\nperiod_s = {:?}\nlatency_s = {:?}\nnoise_rad = \
        {SUN_NOISE:?}\nbias_rad = {SUN_BIAS:?}\n\
         boresight = {BORESIGHT:?}\nsun_direction = {SUN_E:?}\n",
        SUN[0], SUN[1]
    )
}

fn file() -> String {
    let (start, end) = (NET_LAUNCH.find("[[sensors]]").unwrap(), NET_LAUNCH.find("[[guidance]]").unwrap());
    let draws = NET_LAUNCH.find("# the first state").unwrap();
    let sensors = format!(
        "[[sensors]]\nname = \"gyro\"\nkind = \"rate_gyro\"\nbias_rad_s = {GYRO_BIAS:?}\nscale = \
        {GYRO_SCALE:?}\nmisalignment_rad = {MISALIGNMENT:?}\n\
         angular_random_walk_rad_sqrt_s = {GYRO_WALK:?}\n\
         [[sensors]]\nname = \"tracker\"\nkind = \"star_tracker\"\nperiod_s = {:?}\nlatency_s = {:?}\nnoise_rad = \
         {TRACKER_NOISE:?}\n\
         bias_rad = {TRACKER_BIAS:?}\nmax_rate_rad_s = {TRACKER_RATE:?}\n\
         [[sensors]]\nname = \"radar\"\nkind = \"ground_radar\"\nperiod_s = {:?}\nlatency_s = {:?}\nposition_noise_m = \
         {:?}\nvelocity_noise_m_s = {:?}\n\
         [[sensors]]\nname = \"camera\"\nkind = \"relative_camera\"\nperiod_s = {:?}\nlatency_s = \
         {:?}\nattitude_noise_rad = {:?}\n\
         rate_noise_rad_s = {:?}\nmax_range_m = {CAMERA_RANGE:?}\n\
         [[sensors]]\nname = \"tachometers\"\nkind = \"tachometers\"\nnoise_rad_s = {TACHOMETER_NOISE:?}\nscale = \
         {TACHOMETER_SCALE:?}\n\n",
        TRACKER[0],
        TRACKER[1],
        RADAR[0],
        RADAR[1],
        RADAR_NOISE[0],
        RADAR_NOISE[1],
        CAMERA[0],
        CAMERA[1],
        CAMERA_NOISE[0],
        CAMERA_NOISE[1]
    );
    let sensors = sun_sensor() + &sensors;
    let text = format!("{}{sensors}{}", &NET_LAUNCH[..start], &NET_LAUNCH[end..draws]);
    let text = changed(
        &text,
        &[
            ("duration_s = 2400.0", "duration_s = 300.2"),
            ("position_m = [-28.0, -14.0, 18.0]", "position_m = [-30.0, -14.0, 18.0]"),
            ("velocity_m_s = [0.05, 0.02, 0.0]", "velocity_m_s = [0.08, 0.02, 0.0]"),
            ("side_m = 0.2", "size_m = [0.2, 0.5, 0.9]"),
        ],
    );
    text + "[[disperse]]\nparameter = \"initial.velocity_m_s\"\ndistribution = \"offset\"\noffset = 0.0\n"
}

/// Sensors on an orbit; the horizon sensor has the errors of the Sun sensor.
const FIELD: [f64; 2] = [1.5, 0.5];
const FIELD_NOISE: [f64; 3] = [3e-8, 5e-8, 4e-8];
const FIELD_BIAS: [f64; 3] = [1e-7, -2e-7, 3e-7];
const FIELD_SCALE: [f64; 3] = [1.02, 0.98, 1.01];
const HORIZON: [f64; 2] = [1.0, 1.5];
const HALF_VIEW: f64 = 0.9;

fn file_on_orbit() -> String {
    format!(
        "[campaign]\nname = \"orbit\"\nsamples = 4\nseed = 1\nduration_s = 300.2\n\
         [observe]\npoints = 3\n\
         [body]\nmass_kg = 12.0\ncenter_of_mass_m = [0.1, 0.2, -0.3]\nincludes_wheels = true\ninertia_kg_m2 = [[0.12, \
         0, 0], [0, 0.14, 0], [0, 0, 0.09]]\n\
         [[wheels]]\nname = \"w1\"\naxis = [1, 0, 0]\nmass_kg = 0.1\naxial_inertia_kg_m2 = \
         1e-4\ntransverse_inertia_kg_m2 = 6e-5\n\
         [initial]\nangular_velocity_rad_s = [\"3 deg/s\", \"-2 deg/s\", \"2 deg/s\"]\n\
         [orbit]\nepoch = \"2026-11-24T00:00:00Z\"\nsemi_major_axis_m = 6.928e6\ninclination_rad = 1.7\n\
         [environment]\nmagnetic_field = \"igrf\"\n\
         [control]\nperiod_s = {PERIOD:?}\nestimator = \"mekf\"\nwheels = [\"w1\"]\n\
         [[sensors]]\nname = \"field\"\nkind = \"magnetometer\"\nperiod_s = {:?}\nlatency_s = {:?}\nnoise_t = \
         {FIELD_NOISE:?}\nbias_t = {FIELD_BIAS:?}\n\
         scale = {FIELD_SCALE:?}\nmisalignment_rad = {MISALIGNMENT:?}\n\
         [[sensors]]\nname = \"horizon\"\nkind = \"horizon_sensor\"\nperiod_s = {:?}\nlatency_s = {:?}\nnoise_rad = \
         {SUN_NOISE:?}\nbias_rad = {SUN_BIAS:?}\n\
         boresight = {BORESIGHT:?}\nhalf_field_of_view_rad = {HALF_VIEW:?}\n\
         [[guidance]]\nphase = \"hold\"\nlaw = \"rate_damping\"\ngain_n_m_s = 1e-6\n\
         [[disperse]]\nparameter = \"body.inertia_scale\"\ndistribution = \"offset\"\noffset = 0.0\n",
        FIELD[0], FIELD[1], HORIZON[0], HORIZON[1]
    )
}

fn misaligned(v: [f64; 3]) -> [f64; 3] {
    let size = norm(MISALIGNMENT);
    let half = scaled((0.5 * size).sin() / size, MISALIGNMENT);
    transposed_product(dcm_from_quaternion([(0.5 * size).cos(), half[0], half[1], half[2]]), v)
}

fn angles(u_s: [f64; 3]) -> Vec<f64> {
    [u_s[0], -u_s[2]].map(|x| x.atan2(u_s[1]) + SUN_BIAS).to_vec()
}

fn delivered(flown: &FlownLoop, tick: usize, [period, latency]: [f64; 2]) -> Option<&State> {
    let taken = tick.checked_sub((latency / PERIOD).round() as usize)?;
    taken.is_multiple_of((period / PERIOD).round() as usize).then(|| &flown.ticks[taken])
}

fn expected(kind: &str, flown: &FlownLoop, tick: usize) -> Option<Vec<f64>> {
    match kind {
        "rate_gyro" => {
            let [before, now] = [&flown.ticks[tick.checked_sub(1)?], &flown.ticks[tick]];
            let turn = rotation_vector(hamilton(conjugate(before.q_es), now.q_es));
            let along = misaligned(turn);
            Some((0..3).map(|i| GYRO_SCALE[i] * along[i] / PERIOD + GYRO_BIAS[i]).collect())
        }
        "star_tracker" => {
            let state = delivered(flown, tick, TRACKER).filter(|state| norm(state.omega_se_s) <= TRACKER_RATE)?;
            let size = norm(TRACKER_BIAS);
            let half = scaled((0.5 * size).sin() / size, TRACKER_BIAS);
            Some(hamilton(state.q_es, [(0.5 * size).cos(), half[0], half[1], half[2]]).to_vec())
        }
        "sun_sensor" => {
            let sun_s = delivered(flown, tick, SUN)?.to_s(SUN_E);
            (sun_s[1] > 0.0).then(|| angles(sun_s))
        }
        "horizon_sensor" => {
            let state = delivered(flown, tick, HORIZON)?;
            let down_s = state.to_s(scaled(-1.0 / norm(state.r_co_e), state.r_co_e));
            (down_s[1] > HALF_VIEW.cos()).then(|| angles(down_s))
        }
        "magnetometer" => {
            let state = delivered(flown, tick, FIELD)?;
            let field = MagneticField::of(&flown.run.scene).unwrap().at(state.time, state.r_co_e);
            let along = misaligned(state.to_s(field));
            Some((0..3).map(|i| FIELD_SCALE[i] * along[i] + FIELD_BIAS[i]).collect())
        }
        "ground_radar" => {
            let state = delivered(flown, tick, RADAR)?;
            let arm = flown.run.scene.mass.center;
            let position = difference(state.r_co_e, state.to_e(arm));
            let velocity = difference(state.v_co_e, state.to_e(cross(state.omega_se_s, arm)));
            let debris = state.debris();
            Some([position, velocity, debris.r_gdo_e, debris.v_gdo_e].concat())
        }
        "relative_camera" => {
            let in_range = |state: &&State| norm(difference(state.debris().r_gdo_e, state.r_co_e)) <= CAMERA_RANGE;
            let state = delivered(flown, tick, CAMERA).filter(in_range)?;
            let q_sd = hamilton(conjugate(state.q_es), state.debris().q_ed);
            let of_spacecraft = transposed_product(dcm_from_quaternion(q_sd), state.omega_se_s);
            Some([&q_sd[..], &difference(state.debris().omega_de_d, of_spacecraft)].concat())
        }
        "tachometers" => Some(flown.ticks[tick].wheel_rates.iter().map(|rate| TACHOMETER_SCALE * rate).collect()),
        other => panic!("{other} is not measured again: add it above"),
    }
}

fn names(kind: &str) -> Vec<String> {
    let of = |name: &str, letters: &str, unit: &str| {
        letters.chars().map(|letter| format!("{name}_{letter}{unit}")).collect::<Vec<_>>()
    };
    match kind {
        "rate_gyro" => of("measured_rate_s", "xyz", "_rad_s"),
        "star_tracker" => of("measured_q_es", "wxyz", ""),
        "sun_sensor" => of("measured_sun_angle", "xy", "_rad"),
        "horizon_sensor" => of("measured_nadir_angle", "xy", "_rad"),
        "magnetometer" => of("measured_field_s", "xyz", "_t"),
        "ground_radar" => [("r_po", "_m"), ("v_po", "_m_s"), ("r_gdo", "_m"), ("v_gdo", "_m_s")]
            .map(|(name, unit)| of(&format!("measured_{name}_e"), "xyz", unit))
            .concat(),
        "relative_camera" => [of("measured_q_sd", "wxyz", ""), of("measured_omega_ds_d", "xyz", "_rad_s")].concat(),
        "tachometers" => vec!["measured_rate_w1_rad_s".to_owned(), "measured_rate_w2_rad_s".to_owned()],
        other => panic!("{other} has no columns here"),
    }
}

fn errors(kind: &str, found: &[f64], expected: &[f64]) -> Vec<f64> {
    let q = |all: &[f64]| [all[0], all[1], all[2], all[3]];
    let over = |deviation: f64| move |(a, b): (&f64, &f64)| (a - b) / deviation;
    match kind {
        "rate_gyro" => found.iter().zip(expected).map(over(GYRO_WALK / PERIOD.sqrt())).collect(),
        "star_tracker" => {
            let turn = rotation_vector(hamilton(conjugate(q(expected)), q(found)));
            turn.iter().zip(TRACKER_NOISE).map(|(error, deviation)| error / deviation).collect()
        }
        "sun_sensor" | "horizon_sensor" => found.iter().zip(expected).map(over(SUN_NOISE)).collect(),
        "magnetometer" => {
            found.iter().zip(expected).zip(FIELD_NOISE).map(|(pair, deviation)| over(deviation)(pair)).collect()
        }
        "ground_radar" => {
            let both = found.iter().zip(expected).enumerate();
            both.map(|(place, pair)| over(RADAR_NOISE[place / 3 % 2])(pair)).collect()
        }
        "relative_camera" => {
            let turn = rotation_vector(hamilton(q(found), conjugate(q(expected))));
            let rates = found[4..].iter().zip(&expected[4..]).map(over(CAMERA_NOISE[1]));
            turn.iter().map(|error| error / CAMERA_NOISE[0]).chain(rates).collect()
        }
        "tachometers" => found.iter().zip(expected).map(over(TACHOMETER_NOISE)).collect(),
        other => panic!("{other} has no errors here"),
    }
}

/// Law: every kind of sensor delivers, at the ticks at which it is due and no other, its measurement `latency_s`
/// before.
#[test]
fn every_sensor_measures_the_true_state() {
    let (nominal, noisy) = (FlownLoop::new(&file(), 0), FlownLoop::new(&file(), 1));
    let on_orbit = [0, 1].map(|sample| FlownLoop::new(&file_on_orbit(), sample));
    for kind in KINDS.iter().map(|maker| &maker.kind) {
        let [quiet, other] = if kind.needs.is_some() { on_orbit.each_ref() } else { [&nominal, &noisy] };
        for (flown, has_noise) in [(quiet, false), (other, true)] {
            let told: Vec<Vec<f64>> = names(kind.name).iter().map(|name| flown.told(name)).collect();
            let (mut delivered, mut lost) = (0, 0);
            let mut all: Vec<f64> = Vec::new();
            for tick in 0..told[0].len() {
                let found: Vec<f64> = told.iter().map(|column| column[tick]).collect();
                let Some(expected) = expected(kind.name, flown, tick) else {
                    assert!(found.iter().all(|value| value.is_nan()), "{}: tick {tick} delivers {found:?}", kind.name);
                    lost += 1;
                    continue;
                };
                delivered += 1;
                if has_noise {
                    all.extend(errors(kind.name, &found, &expected));
                } else {
                    let off = found.iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                    assert!(off < AGREED, "{}, tick {tick}: {found:?} for {expected:?}", kind.name);
                }
            }
            let has_both = delivered > 50 && (lost > 0 || kind.name == "tachometers");
            assert!(has_both, "{}: {delivered} and {lost}", kind.name);
            if has_noise {
                let n = all.len() as f64;
                let (mean, square) = (all.iter().sum::<f64>() / n, all.iter().map(|x| x * x).sum::<f64>() / n);
                let is_right = mean.abs() < 5.0 / n.sqrt() && (square - 1.0).abs() < 5.0 * (2.0 / n).sqrt();
                assert!(is_right, "{}: {mean} and {square} of {n}", kind.name);
            }
        }
    }
    assert!(norm(nominal.run.scene.mass.center) > 0.1);
}

/// Law: raw estimates are the last measurements, those of the debris relative to the centre of mass.
#[test]
fn raw_estimates_are_the_last_measurements() {
    let text = without_filters(&file().replace(&sun_sensor(), ""), "raw");
    let flown = FlownLoop::new(&text, 2);
    let nominal = resolved(&flown.plan.nominal);
    let (attitudes, rates) =
        (flown.told_vector::<4>("measured_q_es_#"), flown.told_vector::<3>("measured_rate_s_#_rad_s"));
    let [own, own_velocity, debris, debris_velocity] =
        [("r_po", "m"), ("v_po", "m_s"), ("r_gdo", "m"), ("v_gdo", "m_s")]
            .map(|(name, unit)| flown.told_vector::<3>(&format!("measured_{name}_e_#_{unit}")));
    let (q_of_debris, rate_of_debris) =
        (flown.told_vector::<4>("measured_q_sd_#"), flown.told_vector::<3>("measured_omega_ds_d_#_rad_s"));
    let told_q = flown.told_vector::<4>("estimated_q_es_#");
    let told_rate = flown.told_vector::<3>("estimated_omega_se_s_#_rad_s");
    let told_line = flown.told_vector::<3>("estimated_to_debris_e_#_m");
    let told_velocity = flown.told_vector::<3>("estimated_relative_velocity_e_#_m_s");
    let (told_qed, told_omega) =
        (flown.told_vector::<4>("estimated_q_ed_#"), flown.told_vector::<3>("estimated_omega_de_d_#_rad_s"));
    let near = |found: &[f64], expected: &[f64], what: &str| {
        let off = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < AGREED, "{what}: {found:?} for {expected:?}");
    };
    let (mut q, mut omega) = (nominal.initial.q_es, nominal.initial.omega_se_s);
    let (mut relative, mut of_debris) = (None, None);
    for tick in 0..told_q.len() {
        if !attitudes[tick][0].is_nan() {
            q = attitudes[tick];
        }
        if !rates[tick][0].is_nan() {
            omega = rates[tick];
        }
        let c_es = dcm_from_quaternion(q);
        if !own[tick][0].is_nan() {
            let center = sum(own[tick], product(c_es, nominal.mass.center));
            let moving = sum(own_velocity[tick], product(c_es, cross(omega, nominal.mass.center)));
            relative = Some((difference(debris[tick], center), difference(moving, debris_velocity[tick])));
        }
        if !q_of_debris[tick][0].is_nan() {
            let turned = transposed_product(dcm_from_quaternion(q_of_debris[tick]), omega);
            of_debris = Some((hamilton(q, q_of_debris[tick]), sum(rate_of_debris[tick], turned)));
        }
        near(&told_q[tick], &q, "attitude");
        near(&told_rate[tick], &omega, "rate");
        if let Some((line, velocity)) = relative {
            near(&told_line[tick], &line, "position");
            near(&told_velocity[tick], &velocity, "velocity");
        }
        if let Some((attitude, rate)) = of_debris {
            near(&told_qed[tick], &attitude, "attitude of the debris");
            near(&told_omega[tick], &rate, "rate of the debris");
        }
    }
    assert!(relative.is_some() && of_debris.is_some());
}

/// Law: a Sun sensor of a body that points at the Sun measures nothing in the Earth's shadow.
#[test]
fn a_sun_sensor_sees_the_sun_of_the_date_and_no_sun_in_the_shadow() {
    let text = file_on_orbit();
    let (start, end) = (text.find("[initial]").unwrap(), text.find("[orbit]").unwrap());
    let tail = text.find("[control]").unwrap();
    let sun_e = spindrift::dynamics::environment::sun::sun(9823.5).direction;
    let (half, across) = (0.5 * sun_e[2].acos(), scaled(1.0 / sun_e[0].hypot(sun_e[1]), [-sun_e[1], sun_e[0], 0.0]));
    let attitude = [half.cos(), half.sin() * across[0], half.sin() * across[1], 0.0];
    let text = format!(
        "{}[initial]\nattitude = {attitude:?}\n{}[control]\nperiod_s = 10.0\nestimator = \"perfect\"\nwheels = \
        [\"w1\"]\n\
         [[sensors]]\nname = \"sun\"\nkind = \"sun_sensor\"\nbias_rad = -1e-3\n\
         [[guidance]]\nphase = \"a\"\ntarget = \"sun\"\n",
        changed(&text[..start], &[("duration_s = 300.2", "duration_s = 6000")]),
        &text[end..tail]
    );
    let flown = FlownLoop::new(&text, 0);
    let [a, b] = ["x", "y"].map(|axis| flown.told(&format!("measured_sun_angle_{axis}_rad")));
    let error = flown.told("estimated_pointing_error_rad");
    let radius = flown.run.scene.orbit.unwrap().body_radius;
    let (mut dark, mut edges) = (0, 0);
    for (tick, state) in flown.ticks.iter().enumerate() {
        let along = dot(state.r_co_e, sun_e);
        let beside = norm(cross(state.r_co_e, sun_e));
        // the penumbra is 30 km wide and the Sun moves by 7 km; the craft moves across by less than 80 km a period
        if along < 0.0 && (beside - radius).abs() < 40e3 {
            edges += 1;
            continue;
        }
        let is_dark = along < 0.0 && beside < radius;
        dark += usize::from(is_dark);
        let sun_s = state.to_s(sun_e);
        let is_seen = !is_dark && sun_s[2] > 0.0;
        assert_eq!(a[tick].is_nan(), !is_seen, "{} s: {along} {beside}", state.time);
        if is_seen {
            for (found, side) in [(a[tick], sun_s[0]), (b[tick], sun_s[1])] {
                // the Sun has turned since the start
                assert!((found + 1e-3 - side.atan2(sun_s[2])).abs() < 2e-3, "{} s: {found}", state.time);
            }
        }
        assert!((error[tick] - sun_s[2].min(1.0).acos()).abs() < 2e-3);
    }
    assert!(dark > 100 && edges < 20, "{dark} {edges}");
}
