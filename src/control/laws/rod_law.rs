//! [`RodLaw`]: the dipole that torque rods are to have, from the measured magnetic field.
//!
//! A dipole m has the torque m x B: never along B, so that what is along it waits until the field has turned.

use crate::control::declared::declared;
use crate::control::vector::{cross, difference, dot, scaled};
use crate::scene::schema::Limit;
use crate::scene::{DeclaredTable, LawParameter};

/// What torque rods are for in a phase.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RodUse {
    /// Nothing.
    None,
    /// Against the rotation.
    BDot,
    /// Against the momentum of the wheels.
    Unloading,
}

/// The names of the uses in campaign files.
pub const ROD_USES: [(&str, RodUse); 3] =
    [("none", RodUse::None), ("b_dot", RodUse::BDot), ("unloading", RodUse::Unloading)];

declared! {
    /// Of a phase with B-dot.
    BDotNumbers = B_DOT {
        gain: f64 = LawParameter::number("b_dot_gain_a_m2_s_t", "A m^2 s/T",
            "Dipole opposing a change in the field of 1 T/s", Limit::Positive);
    }
}

declared! {
    /// Of a phase in which rods unload wheels.
    RodUnloadingNumbers = ROD_UNLOADING {
        time: f64 = LawParameter::number(
            "rod_unloading_time_s",
            "s",
            "Time constant with which torque rods unload the wheels of momentum perpendicular to the field",
            Limit::Positive,
        );
    }
}

impl RodUse {
    /// Its numbers in a campaign file.
    pub fn parameters(self) -> &'static [LawParameter] {
        match self {
            RodUse::None => &[],
            RodUse::BDot => &B_DOT,
            RodUse::Unloading => &ROD_UNLOADING,
        }
    }
}

/// What torque rods do in a phase of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RodLaw {
    /// Nothing.
    None,
    /// m = -k dB/dt with B in F_s (A. C. Stickler & K. T. Alfriend, Journal of Spacecraft and Rockets 13, 282, 1976): a
    /// body that turns much faster than the field along its orbit sees dB/dt = B x omega, and loses energy at k |B x
    /// omega|^2.
    BDot {
        /// k, A m^2 s/T.
        gain: f64,
    },
    /// m = (h x B)/(T |B|^2) (P. J. Camillo & F. L. Markley, Journal of Guidance and Control 3, 563, 1980): the torque
    /// is -1/T times the part of the momentum h of the wheels that is across B.
    Unloading {
        /// T, s.
        time_constant: f64,
    },
}

impl RodLaw {
    /// That of `of` with the numbers of `table`.
    pub fn new(of: RodUse, table: &DeclaredTable) -> Self {
        match of {
            RodUse::None => RodLaw::None,
            RodUse::BDot => RodLaw::BDot { gain: BDotNumbers::of(table).gain },
            RodUse::Unloading => RodLaw::Unloading { time_constant: RodUnloadingNumbers::of(table).time },
        }
    }

    /// Whether wheels take up its torque: that on the body is to be what its law wants.
    pub fn unloads(&self) -> bool {
        matches!(self, RodLaw::Unloading { .. })
    }

    /// The wanted dipole, F_s, A m^2, where the field is measured as `field` and the wheels have the momentum
    /// `stored_s` relative to the body, N m s.
    pub fn dipole(&self, field: &MeasuredField, stored_s: [f64; 3]) -> [f64; 3] {
        match self {
            RodLaw::None => [0.0; 3],
            RodLaw::BDot { gain } => scaled(-gain, field.rate_s()),
            RodLaw::Unloading { time_constant } => {
                let size2 = dot(field.field_s, field.field_s);
                if size2 > 0.0 {
                    scaled(1.0 / (time_constant * size2), cross(stored_s, field.field_s))
                } else {
                    [0.0; 3]
                }
            }
        }
    }
}

/// The magnetic field as measured last and before that.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasuredField {
    /// The last one, F_s, T; zero where there is none yet.
    pub field_s: [f64; 3],
    /// When it was measured, s.
    time: f64,
    /// The change since the one before, T, and the time between, s; zero where there is none.
    change: ([f64; 3], f64),
}

impl MeasuredField {
    /// Nothing was measured.
    pub const NONE: MeasuredField = MeasuredField { field_s: [0.0; 3], time: f64::NAN, change: ([0.0; 3], 0.0) };

    /// Takes the field `field_s` measured at `time`, s, after the others.
    pub fn take(&mut self, time: f64, field_s: [f64; 3]) {
        if !self.time.is_nan() && time > self.time {
            self.change = (difference(field_s, self.field_s), time - self.time);
        }
        (self.field_s, self.time) = (field_s, time);
    }

    /// dB/dt in F_s, T/s, between the last two; zero before there are two.
    pub fn rate_s(&self) -> [f64; 3] {
        let (change, interval) = self.change;
        if interval > 0.0 { scaled(1.0 / interval, change) } else { [0.0; 3] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::vector::{norm, sum};

    /// Law: B-dot takes energy out of a turning body, omega . (m x B) = -k |B x omega|^2 to first order in the
    /// interval; a single measurement is no rate.
    #[test]
    fn b_dot_brakes() {
        let (omega, field) = ([0.02, -0.03, 0.01], [2e-5, -1e-5, 3e-5]);
        let law = RodLaw::BDot { gain: 4e4 };
        let mut measured = MeasuredField::NONE;
        measured.take(1.0, field);
        assert_eq!(law.dipole(&measured, [1.0; 3]), [0.0; 3]);
        // dB/dt = B x omega in the body
        measured.take(1.5, sum(field, scaled(0.5, cross(field, omega))));
        let torque = cross(law.dipole(&measured, [1.0; 3]), field);
        let across = cross(field, omega);
        let (power, expected) = (dot(omega, torque), -4e4 * dot(across, across));
        assert!((power / expected - 1.0).abs() < 1e-9, "{power} {expected}");
    }

    /// Law: the mean power of B-dot is that of its lag, -4 k |B|^2/(T_m T_h) sin(omega T_m/2) sin(omega T_h/2)
    /// cos(omega L): below zero at omega L < pi/2, above it up to 3 pi/2. The field is across the axis; a turn is a
    /// whole number of dipoles.
    #[test]
    fn a_late_dipole_speeds_the_body_up() {
        let (gain, size, period) = (4e4, 3e-5, 5.0);
        let field = |angle: f64| [size * angle.cos(), -size * angle.sin(), 0.0];
        // several measurements within a dipole, or the other way round; and a delay
        for (measured, held, late) in [(5.0, 5.0, 0.0), (1.0, 5.0, 0.0), (5.0, 5.0, 2.0), (10.0, 10.0, 0.0)] {
            let mut signs = [0, 0];
            for turns in 1..30 {
                let omega = std::f64::consts::TAU * f64::from(turns) / (60.0 * period);
                let lag = 0.5 * (measured + held) + late;
                let (mut power, mut count) = (0.0, 0.0);
                for dipole in 0..60 {
                    let begin = f64::from(dipole) * held;
                    let mut known = MeasuredField::NONE;
                    [begin - measured, begin].into_iter().for_each(|time| known.take(time, field(omega * time)));
                    let dipole = RodLaw::BDot { gain }.dipole(&known, [0.0; 3]);
                    for step in 0..50 {
                        let time = begin + late + (f64::from(step) + 0.5) / 50.0 * held;
                        power += omega * cross(dipole, field(omega * time))[2];
                        count += 1.0;
                    }
                }
                let sines = (0.5 * omega * measured).sin() * (0.5 * omega * held).sin();
                let expected = -4.0 * gain * size * size / (measured * held) * sines * (omega * lag).cos();
                assert!((power / count - expected).abs() < 1e-2 * gain * size * size * omega * omega, "{omega} {lag}");
                signs[usize::from(power > 0.0)] += 1;
            }
            assert!(signs[0] > 3 && signs[1] > 3, "{signs:?}");
        }
    }

    /// Law: the torque of unloading is -h/T for a momentum across the field, and nothing for one along it.
    #[test]
    fn unloading_is_against_the_momentum_across_the_field() {
        let (field, law) = ([2e-5, -1e-5, 3e-5], RodLaw::Unloading { time_constant: 500.0 });
        let mut measured = MeasuredField::NONE;
        measured.take(0.0, field);
        let across = cross(field, [1.0, 0.0, 0.0]);
        let stored = sum(scaled(0.3 / norm(across), across), scaled(0.2 / norm(field), field));
        let torque = cross(law.dipole(&measured, stored), field);
        let expected = scaled(-0.3 / (500.0 * norm(across)), across);
        assert!(norm(difference(torque, expected)) < 1e-15 * norm(expected) * 10.0, "{torque:?} {expected:?}");
        assert_eq!(law.dipole(&MeasuredField::NONE, stored), [0.0; 3]);
    }
}
