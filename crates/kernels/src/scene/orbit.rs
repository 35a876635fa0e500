//! [`Orbit`]: the orbit at time zero, from position and velocity or Keplerian elements (D. Vallado, *Fundamentals of
//! Astrodynamics and Applications*, 4th ed., 2013, sections 2.4 to 2.6).

use super::epoch::Epoch;
use super::error::Problems;
use super::input::SceneInput;
use super::schema::limit::shown;
use super::schema::{InitialInput, OrbitInput};
use crate::math::prelude::*;

/// Largest accepted J2.
const LARGEST_J2: f64 = 0.1;

/// An orbit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orbit {
    /// Gravitational parameter, m^3/s^2.
    pub mu: f64,
    /// Position of c from the central body at time zero, in F_e, m.
    pub position: [f64; 3],
    /// Velocity of c at time zero, in F_e, m/s.
    pub velocity: [f64; 3],
    /// Radius of the central body, m.
    pub body_radius: f64,
    /// Second zonal harmonic for that radius; `None` for a point mass.
    pub j2: Option<f64>,
    /// Date at time zero, if anything depends on it.
    pub epoch: Option<Epoch>,
}

/// Position and velocity relative to the point on an orbit at the same time, F_e.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Offset {
    /// m.
    pub position: [f64; 3],
    /// m/s.
    pub velocity: [f64; 3],
}

/// Offsets of spacecraft and debris from the orbit at time zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Offsets {
    /// The spacecraft's centre of mass c.
    pub spacecraft: Offset,
    /// The debris' centre; zero without debris.
    pub debris: Offset,
}

impl Offsets {
    /// Offsets of `input` if its bodies may leave the orbit: with thrusters, debris, or forces of air and light.
    pub fn of(input: &SceneInput) -> Option<Self> {
        let InitialInput { position_m, velocity_m_s, debris_position_m, debris_velocity_m_s, .. } = input.initial;
        let moves = !input.thrusters.is_empty() || input.debris.is_some() || input.environment.moves();
        let leaves = input.orbit.is_some() && moves;
        let debris = match input.debris {
            Some(_) => Offset { position: debris_position_m, velocity: debris_velocity_m_s },
            None => Offset::default(),
        };
        leaves.then_some(Offsets { spacecraft: Offset { position: position_m, velocity: velocity_m_s }, debris })
    }
}

/// Local orbital frame F_o: o3 towards the central body, o2 against the orbit normal, o1 ahead on a circular orbit:
/// roll, pitch and yaw axes of J. R. Wertz, *Spacecraft Attitude Determination and Control*, 1978, section 2.2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalFrame {
    /// Attitude, F_o -> F_e, scalar first.
    pub q_eo: [f64; 4],
    /// Angular velocity r x v/(r . r) in F_e, rad/s.
    pub omega_oe_e: [f64; 3],
}

impl LocalFrame {
    /// The frame of a body at `r_e` with velocity `v_e`, F_e, m and m/s.
    pub fn at(r_e: [f64; 3], v_e: [f64; 3]) -> Self {
        let normal = cross(r_e, v_e);
        let o3 = scaled(-1.0 / norm(r_e), r_e);
        let o2 = scaled(-1.0 / norm(normal), normal);
        let o1 = cross(o2, o3);
        let c_eo = core::array::from_fn(|i| [o1[i], o2[i], o3[i]]);
        LocalFrame { q_eo: quaternion_from_dcm(c_eo), omega_oe_e: scaled(1.0 / dot(r_e, r_e), normal) }
    }
}

/// Shape and size of an orbit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrbitShape {
    /// Semi-major axis, m; negative for a hyperbola.
    pub semi_major_axis: f64,
    /// Eccentricity.
    pub eccentricity: f64,
    /// Smallest distance from the centre, m.
    pub periapsis: f64,
}

impl Orbit {
    /// The orbit of `input`; missing values count as zero.
    pub fn of(input: &OrbitInput) -> Self {
        let (mu, body_radius, j2, epoch) = (input.mu_m3_s2, input.body_radius_m, input.j2, input.epoch);
        let Some(semi_major_axis) = input.semi_major_axis_m else {
            let (position, velocity) = (input.position_m.unwrap_or_default(), input.velocity_m_s.unwrap_or_default());
            return Orbit { mu, position, velocity, body_radius, j2, epoch };
        };
        let angle = |value: Option<f64>| libm::sincos(value.unwrap_or(0.0));
        let eccentricity = input.eccentricity.unwrap_or(0.0);
        let (sin_i, cos_i) = angle(input.inclination_rad);
        let (sin_node, cos_node) = angle(input.ascending_node_rad);
        let (sin_w, cos_w) = angle(input.argument_of_periapsis_rad);
        let (sin_f, cos_f) = angle(input.true_anomaly_rad);
        // towards the node, and across it in the orbital plane
        let node = [cos_node, sin_node, 0.0];
        let across = [-sin_node * cos_i, cos_node * cos_i, sin_i];
        let periapsis = sum(scaled(cos_w, node), scaled(sin_w, across));
        let ahead = sum(scaled(-sin_w, node), scaled(cos_w, across));
        let parameter = semi_major_axis * (1.0 - eccentricity * eccentricity);
        let distance = parameter / (1.0 + eccentricity * cos_f);
        let speed = (mu / parameter).sqrt();
        Orbit {
            mu,
            position: scaled(distance, sum(scaled(cos_f, periapsis), scaled(sin_f, ahead))),
            velocity: scaled(speed, sum(scaled(-sin_f, periapsis), scaled(eccentricity + cos_f, ahead))),
            body_radius,
            j2,
            epoch,
        }
    }

    /// The orbit of a body at `offset`, to the digits of this one.
    #[must_use]
    pub fn displaced(&self, offset: &Offset) -> Self {
        let (position, velocity) = (sum(self.position, offset.position), sum(self.velocity, offset.velocity));
        Orbit { position, velocity, ..*self }
    }

    /// Oblateness term of gravity, (3/2) J2 R^2, m^2; `None` for a point mass.
    pub fn oblateness(&self) -> Option<f64> {
        self.j2.map(|j2| 1.5 * j2 * self.body_radius * self.body_radius)
    }

    /// Lower bound of the distance from the centre, m: the periapsis minus at most 2 k/p, twice the largest first-order
    /// term of oblateness (D. Brouwer, Astronomical Journal 64, 1959), some kilometres.
    pub fn lowest(&self) -> f64 {
        let periapsis = self.shape().periapsis;
        self.oblateness().map_or(periapsis, |k| periapsis - 2.0 * k / periapsis)
    }

    /// Shape at time zero.
    pub fn shape(&self) -> OrbitShape {
        let distance = norm(self.position);
        let speed2 = dot(self.velocity, self.velocity);
        let radial = dot(self.position, self.velocity);
        let semi_major_axis = 1.0 / (2.0 / distance - speed2 / self.mu);
        let towards = difference(scaled(speed2 - self.mu / distance, self.position), scaled(radial, self.velocity));
        let eccentricity = norm(towards) / self.mu;
        let momentum = cross(self.position, self.velocity);
        let periapsis = dot(momentum, momentum) / (self.mu * (1.0 + eccentricity));
        OrbitShape { semi_major_axis, eccentricity, periapsis }
    }
}

/// Checks the orbit beyond single keys.
pub(super) fn check(scene: &SceneInput, input: &OrbitInput, problems: &mut Problems) {
    let before = problems.0.len();
    of_keys(input, problems);
    let initial = &scene.initial;
    let Some(Offsets { spacecraft, debris }) = Offsets::of(scene) else {
        let default = InitialInput::DEFAULT;
        for (name, numbers, none) in [
            ("position_m", &initial.position_m, &default.position_m),
            ("velocity_m_s", &initial.velocity_m_s, &default.velocity_m_s),
        ] {
            if numbers != none {
                let allowed =
                    "left out on an [orbit] without thrusters, debris and environment.coupled: the spacecraft is on it";
                problems.add(format!("initial.{name}"), shown(numbers), allowed, "delete it, or delete [orbit]");
            }
        }
        return;
    };
    if problems.0.len() > before {
        return;
    }
    for (names, offset) in
        [(["position_m", "velocity_m_s"], spacecraft), (["debris_position_m", "debris_velocity_m_s"], debris)]
    {
        let shape = Orbit::of(input).displaced(&offset).shape();
        // NaN is refused by the limits of its key
        if shape.eccentricity >= 1.0 || shape.periapsis <= input.body_radius_m {
            let allowed = format!(
                "an offset from [orbit] to an ellipse or a circle above body_radius_m = {:?}, position and velocity \
                together (here the eccentricity {:.4}, the periapsis {:.0} m)",
                input.body_radius_m, shape.eccentricity, shape.periapsis
            );
            let remedy = "on an [orbit] positions and velocities of [initial] are relative to it: write them so";
            // the one that differs from the orbit
            let (name, written) =
                if offset.position == [0.0; 3] { (names[1], offset.velocity) } else { (names[0], offset.position) };
            problems.add(format!("initial.{name}"), shown(&written), allowed, remedy);
        }
    }
}

fn of_keys(input: &OrbitInput, problems: &mut Problems) {
    const HITS: &str = "raise the orbit: it hits the central body";
    let key = |name: &str| format!("orbit.{name}");
    if let Some(j2) = input.j2 {
        if j2 > LARGEST_J2 {
            let allowed = format!("at most {LARGEST_J2}: Saturn has 0.0163, the Earth 1.08262668e-3");
            problems.add(key("j2"), shown(&[j2]), allowed, "write the harmonic without a factor");
        } else if j2 > 0.0 && input.body_radius_m == 0.0 {
            let allowed = "zero, or left out, where body_radius_m is zero: it belongs to that radius";
            problems.add(key("j2"), shown(&[j2]), allowed, "write the equatorial radius as body_radius_m");
        }
    }
    let of_elements = [
        input.eccentricity,
        input.inclination_rad,
        input.ascending_node_rad,
        input.argument_of_periapsis_rad,
        input.true_anomaly_rad,
    ];
    let vectors = [input.position_m, input.velocity_m_s];
    if let Some(axis) = input.semi_major_axis_m {
        for (name, vector) in OrbitInput::VECTORS.into_iter().zip(vectors) {
            if let Some(vector) = vector {
                let allowed = "left out where semi_major_axis_m is given";
                problems.add(key(name), shown(&vector), allowed, "write position and velocity, or elements");
            }
        }
        if let Some(eccentricity) = input.eccentricity.filter(|eccentricity| *eccentricity >= 1.0) {
            let allowed = "below 1: an ellipse or a circle";
            return problems.add(key("eccentricity"), shown(&[eccentricity]), allowed, "write 0 for a circle");
        }
        let lowest = axis * (1.0 - input.eccentricity.unwrap_or(0.0));
        if lowest <= input.body_radius_m {
            let radius = input.body_radius_m;
            let allowed =
                format!("so large that the periapsis, here {lowest:?} m, is above body_radius_m = {radius:?}");
            problems.add(key("semi_major_axis_m"), shown(&[axis]), allowed, HITS);
        }
        return;
    }
    for (name, element) in OrbitInput::ELEMENTS.into_iter().skip(1).zip(of_elements) {
        if let Some(element) = element {
            let allowed = "left out where semi_major_axis_m is not given";
            problems.add(key(name), shown(&[element]), allowed, "add semi_major_axis_m, or delete the elements");
        }
    }
    let (Some(position), Some(velocity)) = (input.position_m, input.velocity_m_s) else {
        let missing = if input.position_m.is_none() { "position_m" } else { "velocity_m_s" };
        let allowed = "given, with the other of position_m and velocity_m_s (or elements from semi_major_axis_m on)";
        return problems.add(key(missing), "missing", allowed, "write both, or Keplerian elements");
    };
    let shape = Orbit::of(input).shape();
    // NaN is refused by the limits of its key
    if shape.eccentricity >= 1.0 || shape.semi_major_axis < 0.0 {
        let escape = (2.0 * input.mu_m3_s2 / norm(position)).sqrt();
        let allowed = format!("below the speed of escape, {escape:?} m/s there: an ellipse or a circle");
        problems.add(key("velocity_m_s"), shown(&velocity), allowed, "write a smaller velocity");
    } else if shape.periapsis <= input.body_radius_m {
        let (periapsis, radius) = (shape.periapsis, input.body_radius_m);
        let allowed = format!("on an orbit whose periapsis, here {periapsis:?} m, is above body_radius_m = {radius:?}");
        problems.add(key("position_m"), shown(&position), allowed, HITS);
    }
}
