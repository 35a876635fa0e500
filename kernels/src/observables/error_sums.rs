//! [`Sums`]: errors of the rotational state along a motion, in the axes H, w and v of [`super::conditioning`].

use crate::math::Real;

/// Sum of the errors of one kind up to a point.
#[derive(Clone, Copy, Default)]
pub(super) struct Sums {
    /// Along H.
    along: f64,
    /// |w| Y.
    across: f64,
    /// |mu - mu_0| |H| X: errors along H that become errors across it.
    tilted: f64,
    /// Shift in time.
    shift: f64,
    /// Rotation about L, without the shift.
    about: f64,
    /// The largest error so far.
    pub(super) most: f64,
}

/// Operands of the sums at a point.
#[derive(Clone, Copy)]
pub(super) struct Here {
    /// Time since the previous point and since the start, s.
    pub(super) step: f64,
    pub(super) since: f64,
    pub(super) h: f64,
    pub(super) w: f64,
    /// |mu - mu_0| |H|.
    pub(super) tilt: f64,
    pub(super) axial: f64,
    pub(super) twist: f64,
    pub(super) shear: f64,
    /// The largest difference of mu |H| so far.
    pub(super) range: f64,
    /// Momentum of a unit error, and reference rate of errors of omega.
    pub(super) unit: f64,
    pub(super) largest: f64,
}

impl Sums {
    /// Advances to a point with known error along H and change of the balance.
    #[inline(always)]
    pub(super) fn set(&mut self, at: &Here, along: f64, balance: f64) {
        let per_w = 1.0 / at.w;
        let sideways = at.tilt.mul_add(along, balance) * per_w;
        self.shift += at.step * per_w * along.mul_add(at.twist, sideways * at.shear);
        self.about += at.step * along.mul_add(at.axial, sideways * at.twist);
        self.record(at, along + sideways + self.shift * at.h * at.w);
    }

    /// Records an error of magnitude `total`.
    #[inline(always)]
    fn record(&mut self, at: &Here, total: f64) {
        // across L: bounded by the constancy of L, and by the integral of the error of the rate
        let across = (at.unit / at.h * total).smaller((at.largest * at.since).mul_add(self.most, total));
        let turned = at.unit * 2.0_f64.mul_add(self.shift * at.range, self.about);
        self.most = self.most.larger(total.larger(across + turned));
    }

    /// Advances to a point with new errors of magnitude `made` along H, w and v.
    #[inline(always)]
    pub(super) fn advance(&mut self, at: &Here, made: [f64; 3]) {
        let per_w = 1.0 / at.w;
        let crossing = at.tilt.mul_add(self.along, self.across + self.tilted) * per_w;
        self.shift += at.step * per_w * self.along.mul_add(at.twist, crossing * at.shear);
        self.along += made[0];
        self.tilted += made[0] * at.tilt;
        self.across += made[1] * at.w;
        self.shift += made[2] * per_w / at.h;
        let sideways = at.tilt.mul_add(self.along, self.across + self.tilted) * per_w;
        self.about += at.step * self.along.mul_add(at.axial, sideways * at.twist);
        self.record(at, self.along + sideways + self.shift * at.h * at.w);
    }
}

/// Points more e-foldings of |w| apart do not follow the motion and show no dip between them: a body at 1e4 rad/s,
/// sampled once a second, would have dips of thousands.
const FOLLOWED: f64 = 16.0;

/// Dip of |w| between two points `step` seconds apart, if it falls after the first and rises before the second:
/// duration of its bottom, s, and |w| there. `across` is |w| at both, `widening` its relative slope, 1/s. Near an
/// unstable equilibrium |w| = c cosh(lambda t), and the integral of its inverse square is 2/(lambda c^2).
pub(super) fn dip(across: [f64; 2], widening: [f64; 2], step: f64) -> Option<[f64; 2]> {
    let (falls, rises) = (-widening[0], widening[1]);
    if !(falls > 0.0 && rises > 0.0) {
        return None;
    }
    let rate = falls.larger(rises);
    if rate * step > FOLLOWED {
        return None;
    }
    let fall = 0.5 * (step + libm::log(across[0] / across[1]) / rate);
    let angles = [fall, step - fall].map(|time| rate * time.larger(0.0).smaller(step));
    let least = (across[0] / libm::cosh(angles[0])).smaller(across[1] / libm::cosh(angles[1]));
    Some([(libm::tanh(angles[0]) + libm::tanh(angles[1])) / rate, least])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Truth: the minimum of |w| = c cosh(lambda t) is c, and the integral of its inverse square is that of the bottom;
    /// no dip if |w| is monotone. Pure exponentials at the ends are off by e^(-2 lambda t) at the nearer one, 6e-4.
    #[test]
    fn the_dip_of_a_hyperbolic_cosine_is_found() {
        let (c, lambda) = (1e-6, 1.5);
        let at = |time: f64| (c * libm::cosh(lambda * time), lambda * libm::tanh(lambda * time));
        for (begin, end) in [(-4.0, 3.0), (-2.5, 6.0)] {
            let ((first, falls), (second, rises)) = (at(begin), at(end));
            let [lasts, least] = dip([first, second], [falls, rises], end - begin).expect("a dip");
            let integral = (libm::tanh(lambda * end) - libm::tanh(lambda * begin)) / (lambda * c * c);
            println!("{:e} {:e}", least / c - 1.0, lasts / (least * least) / integral - 1.0);
            assert!((least / c - 1.0).abs() < 2e-3, "{least:e}");
            assert!((lasts / (least * least) / integral - 1.0).abs() < 4e-3, "{lasts} {least:e}");
        }
        assert!(dip([1.0, 2.0], [0.1, 0.5], 1.0).is_none() && dip([2.0, 1.0], [-0.5, -0.1], 1.0).is_none());
    }

    fn at(step: f64, since: f64, w: f64) -> Here {
        Here {
            step,
            since,
            h: 2.0,
            w,
            tilt: 0.0,
            axial: 0.5,
            twist: 0.0,
            shear: 0.25,
            range: 0.0,
            unit: 1.0,
            largest: 1.0,
        }
    }

    /// Law: errors made at the first point grow like errors known at every point: along H, and across it with the
    /// balance |w| Y.
    #[test]
    fn an_error_of_the_first_point_grows_as_a_known_one() {
        let (mut known, mut made) = (Sums::default(), Sums::default());
        for k in 0..=40 {
            let (time, w) = (0.25 * f64::from(k), 0.5 + 0.25 * libm::cos(f64::from(k)));
            // at the first point there is no step and mu = mu_0
            let is_first = k == 0;
            let here = Here {
                tilt: if is_first { 0.0 } else { 0.3 },
                twist: 0.7,
                range: 0.2,
                ..at(if is_first { 0.0 } else { 0.25 }, time, w)
            };
            known.set(&here, 1e-6, 2e-6 * 0.75);
            made.advance(&here, if is_first { [1e-6, 2e-6, 0.0] } else { [0.0; 3] });
            // equal sums in equal order
            assert!((made.most / known.most - 1.0).abs() < 1e-15, "{k}: {:e} {:e}", made.most, known.most);
        }
        assert!(known.most > 1e-5, "the counter-test: the error has grown: {:e}", known.most);
    }

    /// Law: an error along H rotates the attitude about L at the rate A_HH and is constant; an error across H is
    /// sheared along the curve, by shear t relative to itself at constant |w|.
    #[test]
    fn errors_grow_in_proportion_to_time() {
        let (mut along, mut across) = (Sums::default(), Sums::default());
        for k in 0..=100 {
            let here = at(if k == 0 { 0.0 } else { 0.1 }, 0.1 * f64::from(k), 0.5);
            along.set(&here, 1e-6, 0.0);
            across.set(&here, 0.0, 0.5e-6);
        }
        // 1e-6/2 across L, and 0.5 1e-6 10 about it
        // sums of steps; measured: 1.1e-15 and, below, 8.9e-16
        assert!((along.most / 5.5e-6 - 1.0).abs() < 1e-14, "{:e}", along.most);
        // Y = 1e-6; Z = 0.25 10 1e-6 2 0.5/0.5 = 5e-6; as an error of omega their sum
        assert!((across.most / 6e-6 - 1.0).abs() < 8e-15, "{:e}", across.most);
    }
}
