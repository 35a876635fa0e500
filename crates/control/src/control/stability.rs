//! Small-error stability of a law whose torque is held over control periods and acts after a delay.
//!
//! About one axis the body is a double integrator, theta'' = a. At tick k, a period T apart, the law gives a_k = -(k
//! theta_k + c theta'_k + i sum theta + j sum theta'), which acts from t_k + d to t_(k+1) + d, with d = (m + f) T. With
//! angles, rates times T, and accelerations times T^2 the z-transform is
//!
//! (z-1)^3 z^(m+1) + (c T (z-1) + j T z) (z-1) D + (k T^2 (z-1) + i T^2 z) (D + (z-1) B) = 0, D = f + (1-f) z, B = f -
//! f^2/2 + z (1-f)^2/2,
//!
//! with one factor z-1 less without an angle integral, and another one less with neither stiffness nor rate integral,
//! which acts as a stiffness: free integrators are not the law's. A law is stable if all roots are within the unit
//! circle, by the Schur-Cohn test (E. I. Jury, *Theory and Application of the z-Transform Method*, 1964); without delay
//! and integrals that is k T < 2 c and c T < 2.
//!
//! Exact for small angles and a believed nominal inertia; limits, friction and estimator lag are not modelled.

use super::actuators::modulation;
use super::allocation::{ThrustAllocation, WheelTorque};
use super::laws::AttitudeLaw;
use super::tick_times::SAME_TIME;
use crate::loops::attitude_law::{KnownBody, LawInput, digits};
use crate::loops::spec::{LoopSpec, PhaseSpec};
use crate::loops::target::Target;
use crate::loops::vector::{added, dot, inverse, multiplied, product, quaternion_of, scaled};
use crate::math::symmetric::principal_axes;
use crate::scene::Scene;

/// Most delay periods judged: the test's cost grows with their square.
const MOST_DELAY: f64 = 200.0;
/// Error, rad and rad/s, at which gains are measured: the sine of half of it is linear to 4e-14.
const SMALL: f64 = 1e-6;
/// Share of the largest acceleration below which an axis is not controlled.
const NOT_CONTROLLED: f64 = 1e-12;
/// Share of the largest gain below which a gain is rounding.
const NO_GAIN: f64 = 1e-12;
/// Bisections to find a limit.
const HALVINGS: usize = 40;
/// Smallest share of its torque at which a law is tried.
const LEAST_SHARE: f64 = 1e-3;

/// Gains of a law about one axis: stiffness k, 1/s^2; damping c, 1/s; and per tick the integrals i of the angle, 1/s^2,
/// and j of the rate, 1/s.
type AxisGains = [f64; 4];

/// True if small errors decay at a period of `period` and a delay of `delay` seconds.
fn is_stable([k, c, i, j]: AxisGains, period: f64, delay: f64) -> bool {
    let (k, c, i, j) = (k * period * period, c * period, i * period * period, j * period);
    let whole = (delay / period + SAME_TIME).floor();
    let f = (delay / period - whole).max(0.0);
    let (d, b) = (vec![1.0 - f, f], vec![0.5 * (1.0 - f) * (1.0 - f), f - 0.5 * f * f]);
    let step = vec![1.0, -1.0];
    let times = |a: &[f64], b: &[f64]| {
        let mut product = vec![0.0; a.len() + b.len() - 1];
        for (p, x) in a.iter().enumerate() {
            b.iter().enumerate().for_each(|(q, y)| product[p + q] += x * y);
        }
        product
    };
    // coefficients of falling powers
    let late = |a: Vec<f64>| [a, vec![0.0; whole as usize + 1]].concat();
    let plus = |mut a: Vec<f64>, factor: f64, b: &[f64]| {
        let first = a.len() - b.len();
        a[first..].iter_mut().zip(b).for_each(|(a, b)| *a += factor * b);
        a
    };
    let square = times(&step, &step);
    let angle = plus(times(&step, &b), 1.0, &d);
    // c (z-1) + j z
    let of_rate = times(&[c + j, -c], &d);
    let polynomial = if i != 0.0 {
        let free = plus(late(times(&square, &step)), 1.0, &times(&of_rate, &step));
        plus(free, 1.0, &times(&[k + i, -k], &angle))
    } else if k != 0.0 || j != 0.0 {
        plus(plus(late(square), 1.0, &of_rate), k, &angle)
    } else if c != 0.0 {
        plus(late(step), c, &d)
    } else {
        return true;
    };
    is_within_unit_circle(polynomial)
}

/// True if all roots of the polynomial, coefficients in falling powers, are within the unit circle.
fn is_within_unit_circle(mut a: Vec<f64>) -> bool {
    while a.len() > 1 {
        let last = a.len() - 1;
        let ratio = a[last] / a[0];
        if ratio.is_nan() || ratio.abs() >= 1.0 {
            return false;
        }
        a = (0..last).map(|i| a[i] - ratio * a[last - i]).collect();
    }
    true
}

/// The gains of `law` about each axis that torques within the projection `reach` control, for a body of inertia
/// `inertia` (K, kg m^2), all in F_s; without a target the attitude is free.
fn axis_gains(
    law: &AttitudeLaw,
    known: &KnownBody,
    has_target: bool,
    (inertia, reach): ([[f64; 3]; 3], [[f64; 3]; 3]),
    period: f64,
) -> Vec<AxisGains> {
    let unit = |axis: usize| std::array::from_fn(|i| if i == axis { 1.0 } else { 0.0 });
    // columns: torque against an error about each axis
    let columns =
        |torque: &dyn Fn([f64; 3]) -> [f64; 3]| [0, 1, 2].map(|axis| scaled(-1.0 / SMALL, torque(unit(axis))));
    let turned = |axis: [f64; 3]| LawInput { q_ts: quaternion_of(scaled(SMALL, axis)), ..LawInput::AT_TARGET };
    let torque = |input: &LawInput| law.clone().torque(known, input, 0.0);
    let stiffness = columns(&|axis| if has_target { torque(&turned(axis)) } else { [0.0; 3] });
    // without momentum: omega x H is of second order
    let turning = |axis: [f64; 3]| LawInput { omega_se_s: scaled(SMALL, axis), ..LawInput::AT_TARGET };
    let damping = columns(&|axis| torque(&turning(axis)));
    // increment of one tick
    let added = |input: LawInput| -> [f64; 3] {
        let mut law = law.clone();
        let [first, second] = [0.0, period].map(|since| law.torque(known, &input, since));
        std::array::from_fn(|i| second[i] - first[i])
    };
    let integral = columns(&|axis| added(if has_target { turned(axis) } else { LawInput::AT_TARGET }));
    let rate_integral = columns(&|axis| added(turning(axis)));
    let inverse = inverse(inertia);
    let (accelerations, axes) = principal_axes::<f64>(multiplied(&multiplied(&reach, &inverse), &reach));
    let most = accelerations.iter().copied().fold(0.0, f64::max);
    let controlled = (0..3).filter(|mode| accelerations[*mode] > NOT_CONTROLLED * most);
    let gains = controlled.map(|mode| {
        let direction = axes.map(|row| row[mode]);
        // the axis about which a torque along the direction turns the body
        let turn = product(inverse, direction);
        let along = |columns: &[[f64; 3]; 3]| (0..3).map(|i| dot(columns[i], direction) * turn[i]).sum::<f64>();
        let found = [&stiffness, &damping, &integral, &rate_integral].map(along);
        let least = NO_GAIN * found.iter().fold(0.0_f64, |most, gain| most.max(gain.abs()));
        found.map(|gain| if gain.abs() > least { gain } else { 0.0 })
    });
    gains.collect()
}

/// The largest share of the gains, given as `gains(share)`, at which small errors decay about every axis: `None` if
/// they do at full gain, zero if no share suffices.
fn stable_share(gains: impl Fn(f64) -> Vec<AxisGains>, period: f64, delay: f64) -> Option<f64> {
    let is_stable = |share: f64| gains(share).iter().all(|gains| is_stable(*gains, period, delay));
    if delay / period > MOST_DELAY || is_stable(1.0) {
        return None;
    }
    if !is_stable(LEAST_SHARE) {
        return Some(0.0);
    }
    let (mut low, mut high) = (LEAST_SHARE, 1.0);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if is_stable(middle) { low = middle } else { high = middle }
    }
    Some(low)
}

/// Projection onto the torques that the loop can hold over a period with the actuators of `believed`; pulses cannot.
fn reach(spec: &LoopSpec, believed: &Scene) -> [[f64; 3]; 3] {
    let by_wheels = WheelTorque::of_loop(believed, &spec.wheels).reachable;
    if spec.thrusters.is_empty() || modulation::is_on_off(spec.modulation) {
        return by_wheels;
    }
    let thrusters = ThrustAllocation::of_loop(believed, &spec.thrusters, by_wheels);
    WheelTorque::new(&added(&by_wheels, &thrusters.two_sided_torques(spec.holds_force))).reachable
}

/// A sentence with the limit of the gains of `law`, if small errors grow under it; `law` is that of phase number
/// `phase` in a run of `scene`, believed to be `believed`.
pub fn beyond_limit(
    (spec, phase): (&LoopSpec, usize),
    (believed, scene): (&Scene, &Scene),
    law: &AttitudeLaw,
    delay: f64,
) -> Option<String> {
    let PhaseSpec { law: kind, target, .. } = &spec.phases[phase];
    // such laws need a loop that measures and estimates
    if kind.as_ref().is_some_and(|kind| kind.reads_sensors) {
        return None;
    }
    let has_target = *target != Target::None;
    let known = KnownBody::of(&believed.mass);
    let body = (scene.mass.inertia_rotating(), reach(spec, believed));
    let period = spec.period;
    let gains = |law: &AttitudeLaw| axis_gains(law, &known, has_target, body, period);
    let scaled = |share: f64| match law.weaker(share) {
        Some((weaker, _)) => gains(&weaker),
        None => gains(law).into_iter().map(|gains| gains.map(|gain| share * gain)).collect(),
    };
    let share = stable_share(scaled, period, delay)?;
    let written = law.weaker(1.0).map_or_else(|| "its gains".to_owned(), |(_, gains)| gains);
    let limit = match law.weaker(share) {
        _ if share == 0.0 => "there is too little damping, whatever the gain".to_owned(),
        Some((_, gains)) => format!("the limit is {gains}; write lower gains, or a shorter period or delay"),
        None => {
            format!("the limit is {} of its torque; write lower gains, or a shorter period or delay", digits(share))
        }
    };
    let name = kind.as_ref().map_or("", |kind| kind.name);
    Some(format!(
        "small errors grow under {name} with {written}, control.period_s = {period:?} and delay_s = {delay:?}: {limit}"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Largest angle and rate, early and late, of a double integrator under held torque, flown from instant to instant.
    fn flown([k, c, i, j]: AxisGains, period: f64, delay: f64) -> [f64; 2] {
        const TICKS: usize = 6000;
        let (mut angle, mut rate, mut summed, mut summed_rate) = (1.0, 0.3 / period, 0.0, 0.0);
        let mut commands: Vec<(f64, f64)> = Vec::new();
        let (mut acting, mut next) = (0.0, 0);
        let mut sizes = [0.0_f64; 2];
        for tick in 0..TICKS {
            let (time, end) = (tick as f64 * period, (tick + 1) as f64 * period);
            (summed, summed_rate) = (summed + angle, summed_rate + rate);
            let wanted = -k * angle - c * rate - i * summed - j * summed_rate;
            commands.push((time + delay, wanted));
            let mut now = time;
            while now < end {
                while next < commands.len() && commands[next].0 <= now + 1e-9 * period {
                    (acting, next) = (commands[next].1, next + 1);
                }
                let until = commands.get(next).map_or(end, |(begin, _)| begin.min(end));
                let h = until - now;
                (angle, rate, now) = (angle + h * rate + 0.5 * h * h * acting, rate + h * acting, until);
            }
            let size = if k == 0.0 { rate.abs() * period } else { angle.abs() + rate.abs() * period };
            match tick {
                1000..2000 => sizes[0] = sizes[0].max(size),
                5000.. => sizes[1] = sizes[1].max(size),
                _ => {}
            }
            if size > 1e100 {
                return [0.0, f64::INFINITY];
            }
        }
        sizes
    }

    /// Law: flown in time, errors decay 2% below the limit of the gains and grow 2% above it, at any delay, with and
    /// without stiffness and integrals.
    #[test]
    fn the_limit_is_where_errors_begin_to_grow() {
        let mut tried = 0;
        for period in [0.25, 2.0] {
            for delay in [0.0, 0.1, 0.5, 1.0, 1.3, 4.0] {
                for (k, i, j) in [
                    (0.0, 0.0, 0.0),
                    (0.05, 0.0, 0.0),
                    (0.6, 0.0, 0.0),
                    (0.05, 0.0005, 0.0),
                    (0.0, 0.0, 0.05),
                    (0.0, 0.0, 0.6),
                    (0.05, 0.0, 0.05),
                    (0.05, 0.0005, 0.05),
                ] {
                    let shape = [k / (period * period), 0.4 / period, i / (period * period), j / period];
                    let times = |factor: f64| shape.map(|gain| factor * (1e3 * gain));
                    let share = match stable_share(|share| vec![times(share)], period, delay * period) {
                        Some(share) if share > 0.0 => share,
                        // too little damping at any gain
                        _ => continue,
                    };
                    for (factor, grows) in [(0.98, false), (1.02, true)] {
                        let [early, late] = flown(times(factor * share), period, delay * period);
                        assert_eq!(late > early, grows, "{shape:?} {delay} {factor}: {early:e} {late:e}");
                    }
                    tried += 1;
                }
            }
        }
        assert!(tried >= 60, "{tried} limits");
    }
}
