//! [`growth`]: amplification of small errors of the rotational state by effects that change within an arc.
//! A rotation of the body by theta changes the torque by M theta. With K omega' = tau - omega x H, H = K omega +
//! wheels' momentum, small errors theta (body frame) and delta of omega obey theta' = delta - omega x theta, K delta' =
//! M theta + H x delta - omega x K delta. If the points of a run follow its rotation, these equations carry the
//! covariance of errors that arise evenly along the run and in every direction; its largest root is the amplification.
//! On an eccentric orbit growth is a product over orbits, although the torque is unstable for minutes only.
//!
//! If the body turns faster, the torque changes sign many times between points and hardly amplifies: growth is that of
//! the free motion ([`super::conditioning`]) times the exponential of [`exponent`].

use crate::dynamics::effects::within_arcs::Motion;
use crate::dynamics::effects::{ChangingEffects, ForceModel};
use crate::dynamics::orbit_path::OrbitPath;
use crate::dynamics::orbit_state::OrbitState;
use crate::math::prelude::*;
use crate::math::symmetric::principal_axes;
use crate::run::{StateField, StateTable, rate_scale};
use crate::scene::Scene;

/// ln 1e200.
pub const LARGEST_EXPONENT: f64 = 460.5;

/// Largest amplification; more counts as infinite.
pub const MOST: f64 = 1e200;

/// Most examined points: several in each half of a libration up to some orbits, a fair sample beyond.
const POINTS: usize = 128;

/// Rotation for finite differences of a torque, rad: its size is the error, rounding is 1e-12.
const ROTATION: f64 = 1e-4;

/// Largest change of an error over a step of the covariance: the classical Runge-Kutta method then errs by less than
/// 1%.
const STEP: f64 = 0.7;

/// Most steps between two points that follow the rotation; coefficients are linear in between.
const FOLLOWED: f64 = 4.0;

const MOST_STEPS: f64 = 128.0;

#[derive(Clone, Copy)]
struct Station {
    time: f64,
    /// omega, and omega relative to the orbit, rad/s.
    rate: [f64; 3],
    beside: [f64; 3],
    /// The wheels' momentum, N m s.
    held: [f64; 3],
    /// M by columns, N m/rad.
    slope: [[f64; 3]; 3],
}

pub struct Growth {
    /// Amplification of errors that arise evenly along the run (omega over its scale, attitude in rad), if the points
    /// follow the rotation.
    pub followed: Option<f64>,
    /// Otherwise: factor on the growth in the free motion.
    pub beside: f64,
    /// Change of omega by the torque along the run, over its scale.
    pub stirred: f64,
}

// inlined with all callees, so that fused operations are instructions: torques at a thousand states would otherwise
// cost as much as the steps of a run
/// Growth over the first `filled` points of `table` of a run of `scene`; `None` if no effect changes within an arc.
#[inline(always)]
pub fn growth(scene: &Scene, table: &StateTable, times: &[f64], filled: usize) -> Option<Growth> {
    if !ForceModel::of(scene).changes_within_arcs() {
        return None;
    }
    let last = filled - 1;
    let (moments, axes) = principal_axes(scene.mass.inertia);
    let q_sb = quaternion_from_dcm(axes);
    let mut effects = ChangingEffects::of(0.0, scene, Some(axes));
    if effects.is_empty() || times[last] <= 0.0 {
        return None;
    }
    let orbit = scene.orbit.as_ref().map(OrbitPath::new);
    let stride = last.div_ceil(POINTS).max(1);
    let mut stations =
        [Station { time: 0.0, rate: [0.0; 3], beside: [0.0; 3], held: [0.0; 3], slope: [[0.0; 3]; 3] }; POINTS + 1];
    let (mut count, mut stirred) = (0, 0.0);
    for point in (0..=last).step_by(stride) {
        let time = times[point];
        let place = orbit.as_ref().map_or(OrbitState::unknown(0.0), |orbit| orbit.state(time));
        let attitude = hamilton(table.at(StateField::Attitude, point), q_sb);
        let rate = transposed_product(axes, table.at::<3>(StateField::Rate, point));
        let (field, sun) = (effects.field(time, &place), effects.sun(time));
        let motion = Motion { time, attitude, rate, place, field, sun };
        let mut beside = rate;
        if orbit.is_some() {
            let turning = scaled(1.0 / dot(place.position, place.position), cross(place.position, place.velocity));
            let [w, x, y, z] = attitude;
            let [_, x, y, z] =
                hamilton(hamilton([w, -x, -y, -z], [0.0, turning[0], turning[1], turning[2]]), [w, x, y, z]);
            beside = difference(rate, [x, y, z]);
        }
        let mut held = [0.0; 3];
        for (wheel, spin) in scene.mass.wheels.iter().enumerate() {
            held = sum(held, scaled(spin.axial * table.column(StateField::WheelRates, wheel)[point], spin.axis));
        }
        // the layer of the air is sought once
        effects.choose_branches(true, &motion);
        // one loop, so that the long effects are inlined once
        let mut torques = [[0.0; 3]; 4];
        for (change, torque) in torques.iter_mut().enumerate() {
            *torque = effects.torque(&if change < 3 { turned(&motion, change) } else { motion });
        }
        let [_, _, _, torque] = torques;
        let slope = core::array::from_fn(|axis| scaled(1.0 / ROTATION, difference(torques[axis], torque)));
        stirred += [0, 1, 2].map(|i| torque[i].abs() / moments[i]).into_iter().sum::<f64>();
        stations[count] = Station { time, rate, beside, held: transposed_product(axes, held), slope };
        count += 1;
    }
    let stations = &stations[..count];
    let fastest = stations.iter().fold(0.0_f64, |most, station| most.max(dot(station.rate, station.rate))).sqrt();
    let scale = rate_scale(fastest, times[last]);
    let followed = covariance_growth(stations, moments, scale);
    let exponent = if followed.is_some() { 0.0 } else { exponent(stations, moments) };
    let beside = if exponent < LARGEST_EXPONENT { libm::exp(exponent) } else { MOST };
    Some(Growth { followed, beside, stirred: stirred / count as f64 * times[last] / scale })
}

type Matrix = [[f64; 3]; 3];

/// Covariances of rotations, of rotations (rows) and changes of omega (columns), of changes of omega; or their slopes.
type Covariance = [Matrix; 3];

/// Linear equations at a point: theta' = u delta - omega x theta, delta' = `pulled` theta + `carried` delta, delta in
/// units u.
#[derive(Clone, Copy)]
struct Flow {
    turning: Matrix,
    pulled: Matrix,
    carried: Matrix,
}

/// Amplification along `stations`; `None` if that takes too many steps.
#[inline(always)]
fn covariance_growth(stations: &[Station], moments: [f64; 3], scale: f64) -> Option<f64> {
    let duration = stations[stations.len() - 1].time;
    let mut strongest = 1.0 / (duration * duration);
    for station in stations {
        for column in station.slope {
            for i in 0..3 {
                strongest = (column[i].abs() / moments[i]).max(strongest);
            }
        }
    }
    // both kinds of errors grow at the same pace
    let unit = strongest.sqrt();
    let made = [1.0, (scale / unit) * (scale / unit)].map(|square| square / (3.0 * duration));
    let (mut covariance, mut most) = ([[[0.0; 3]; 3]; 3], 0.0_f64);
    let parts = |pair: &[Station]| {
        let pace = |station: &Station| Flow::at(station, moments, unit).pace(unit);
        (pair[1].time - pair[0].time) * pace(&pair[0]).max(pace(&pair[1])) / STEP
    };
    let mut steps = 0.0;
    for pair in stations.windows(2) {
        let parts = parts(pair).ceil();
        steps += parts;
        if !(parts <= FOLLOWED && steps <= MOST_STEPS) {
            return None;
        }
    }
    let mut before = Flow::at(&stations[0], moments, unit);
    for pair in stations.windows(2) {
        let after = Flow::at(&pair[1], moments, unit);
        let step = pair[1].time - pair[0].time;
        let parts = parts(pair).ceil().max(1.0);
        let length = step / parts;
        for part in 0..parts as usize {
            let at = |share: f64| before.mixed(&after, (part as f64 + share) / parts);
            let (begin, middle, end) = (at(0.0), at(0.5), at(1.0));
            let first = begin.slope(&covariance, unit, made);
            let second = middle.slope(&moved(&covariance, 0.5 * length, &first), unit, made);
            let third = middle.slope(&moved(&covariance, 0.5 * length, &second), unit, made);
            let fourth = end.slope(&moved(&covariance, length, &third), unit, made);
            for (slope, weight) in [(first, 1.0), (second, 2.0), (third, 2.0), (fourth, 1.0)] {
                covariance = moved(&covariance, weight * length / 6.0, &slope);
            }
        }
        before = after;
        let root = |m: &Matrix| (m[0][0] + m[1][1] + m[2][2]).max(0.0).sqrt();
        most = most.max(root(&covariance[0])).max(root(&covariance[2]) * unit / scale);
        if most.is_nan() || most >= MOST {
            return Some(MOST);
        }
    }
    Some(most.max(1.0))
}

impl Flow {
    #[inline(always)]
    fn at(station: &Station, moments: [f64; 3], unit: f64) -> Self {
        let momentum = core::array::from_fn(|i| moments[i].mul_add(station.rate[i], station.held[i]));
        let (turning, pulling) = (skew(station.rate), skew(momentum));
        let each =
            |entry: &dyn Fn(usize, usize) -> f64| core::array::from_fn(|i| core::array::from_fn(|j| entry(i, j)));
        Flow {
            turning,
            pulled: each(&|i, j| station.slope[j][i] / (moments[i] * unit)),
            carried: each(&|i, j| (pulling[i][j] - turning[i][j] * moments[j]) / moments[i]),
        }
    }

    #[inline(always)]
    fn pace(&self, unit: f64) -> f64 {
        let most =
            |matrix: &Matrix| matrix.iter().fold(0.0_f64, |most, [x, y, z]| most.max(x.abs() + y.abs() + z.abs()));
        most(&self.turning).max(most(&self.carried)) + (unit * most(&self.pulled)).sqrt()
    }

    #[inline(always)]
    fn mixed(&self, other: &Flow, share: f64) -> Flow {
        let mix = |a: &Matrix, b: &Matrix| {
            core::array::from_fn(|i| core::array::from_fn(|j| share.mul_add(b[i][j] - a[i][j], a[i][j])))
        };
        Flow {
            turning: mix(&self.turning, &other.turning),
            pulled: mix(&self.pulled, &other.pulled),
            carried: mix(&self.carried, &other.carried),
        }
    }

    /// P' = F P + (F P)^T + Q, block by block.
    #[inline(always)]
    fn slope(&self, [x, y, z]: &Covariance, unit: f64, made: [f64; 2]) -> Covariance {
        let mut slope = [[[0.0; 3]; 3]; 3];
        for i in 0..3 {
            for j in 0..3 {
                let (mut turned, mut crossed, mut changed) = (unit * y[j][i], unit * z[i][j], 0.0_f64);
                for k in 0..3 {
                    turned = (-self.turning[i][k]).mul_add(x[k][j], turned);
                    crossed = (-self.turning[i][k]).mul_add(y[k][j], crossed);
                    crossed = x[i][k].mul_add(self.pulled[j][k], crossed);
                    crossed = y[i][k].mul_add(self.carried[j][k], crossed);
                    changed = self.pulled[i][k].mul_add(y[k][j], changed);
                    changed = self.carried[i][k].mul_add(z[k][j], changed);
                }
                slope[0][i][j] += turned;
                slope[0][j][i] += turned;
                slope[1][i][j] = crossed;
                slope[2][i][j] += changed;
                slope[2][j][i] += changed;
            }
            slope[0][i][i] += made[0];
            slope[2][i][i] += made[1];
        }
        slope
    }
}

fn skew([x, y, z]: [f64; 3]) -> Matrix {
    [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]]
}

#[inline(always)]
fn moved(a: &Covariance, by: f64, slope: &Covariance) -> Covariance {
    core::array::from_fn(|b| core::array::from_fn(|i| core::array::from_fn(|j| by.mul_add(slope[b][i][j], a[b][i][j]))))
}

/// Logarithm of the growth by the torque beyond the free motion.
///
/// If the body does not turn relative to the reference direction of the torque, which turns with the orbit, an error
/// grows as exp(lambda t) with lambda^2 the largest positive eigenvalue of the symmetric part of J^(-1/2) M J^(-1/2)
/// (negative: libration). If it turns at a relative rate w, or is held by a momentum J w, M changes sign within 1/w,
/// and growth is of second order, lambda^3/w^2. The exponent is the integral of lambda^3/(lambda^2 + w^2). M and w^2
/// are first averaged over half periods pi/lambda_0 of an oscillation, lambda_0^2 being the largest magnitude of an
/// eigenvalue.
fn exponent(stations: &[Station], moments: [f64; 3]) -> f64 {
    let duration = stations[stations.len() - 1].time;
    let size = (moments[0] + moments[1] + moments[2]) / 3.0;
    let mut slopes = [[[0.0; 3]; 3]; POINTS + 1];
    let mut squares = [0.0; POINTS + 1];
    let (mut largest, count) = (0.0_f64, stations.len());
    for (k, station) in stations.iter().enumerate() {
        slopes[k] = symmetric(moments, &station.slope);
        squares[k] = dot(station.beside, station.beside) + dot(station.held, station.held) / (size * size);
        largest = principal_axes(slopes[k]).0.into_iter().fold(largest, |most, x| most.max(x.abs()));
    }
    let spans = (duration * largest.sqrt() / core::f64::consts::PI).round().clamp(1.0, count as f64);
    let span = (count as f64 / spans).ceil() as usize;
    let turning = slopes[..count].chunks(span).zip(squares[..count].chunks(span)).map(|(slopes, squares)| {
        let points = squares.len() as f64;
        let mean = core::array::from_fn(|i| {
            core::array::from_fn(|j| slopes.iter().map(|slope| slope[i][j]).sum::<f64>() / points)
        });
        let (unstable, rate2) = (largest_eigenvalue(mean), squares.iter().sum::<f64>() / points);
        if unstable > 0.0 { points * unstable * unstable.sqrt() / (unstable + rate2) } else { 0.0 }
    });
    turning.sum::<f64>() / count as f64 * duration
}

#[inline(always)]
fn turned(motion: &Motion<f64>, axis: usize) -> Motion<f64> {
    let mut turn = [1.0, 0.0, 0.0, 0.0];
    turn[1 + axis] = 0.5 * ROTATION;
    Motion { attitude: hamilton(motion.attitude, turn), ..*motion }
}

fn symmetric(moments: [f64; 3], columns: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    core::array::from_fn(|i| {
        core::array::from_fn(|j| 0.5 * (columns[j][i] + columns[i][j]) / (moments[i] * moments[j]).sqrt())
    })
}

#[inline(always)]
fn largest_eigenvalue(symmetric: [[f64; 3]; 3]) -> f64 {
    let (values, _) = principal_axes(symmetric);
    values[0].max(values[1]).max(values[2])
}
