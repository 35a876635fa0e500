//! [`Sums`]: errors of the rotational state along a motion, in the axes of [`super::conditioning`].

use crate::math::Real;

/// Accumulated errors of one kind.
#[derive(Clone, Copy, Default)]
pub struct Sums {
    along: f64,
    /// |w| Y.
    across: f64,
    /// |mu - mu_0| |H| X: errors along H that turn into errors across it.
    tilted: f64,
    /// Shift in time.
    shift: f64,
    /// Rotation about L, without the shift.
    about: f64,
    pub most: f64,
}

#[derive(Clone, Copy)]
pub struct Here {
    /// Time since the previous point and since the start, s.
    pub step: f64,
    pub since: f64,
    pub h: f64,
    pub w: f64,
    /// |mu - mu_0| |H|.
    pub tilt: f64,
    pub axial: f64,
    pub twist: f64,
    pub shear: f64,
    /// Largest difference of mu |H| so far.
    pub range: f64,
    /// Momentum of a unit error, and reference rate of omega.
    pub unit: f64,
    pub largest: f64,
}

impl Sums {
    /// Advances to a point with a known error along H and a known change of the balance.
    #[inline(always)]
    pub fn set(&mut self, at: &Here, along: f64, balance: f64) {
        let per_w = 1.0 / at.w;
        let sideways = at.tilt.mul_add(along, balance) * per_w;
        self.shift += at.step * per_w * along.mul_add(at.twist, sideways * at.shear);
        self.about += at.step * along.mul_add(at.axial, sideways * at.twist);
        self.record(at, along + sideways + self.shift * at.h * at.w);
    }

    #[inline(always)]
    fn record(&mut self, at: &Here, total: f64) {
        // across L: bounded since L is constant, and by the integral of the error of the rate
        let across = (at.unit / at.h * total).smaller((at.largest * at.since).mul_add(self.most, total));
        let turned = at.unit * 2.0_f64.mul_add(self.shift * at.range, self.about);
        self.most = self.most.larger(total.larger(across + turned));
    }

    /// Advances to a point with new errors of magnitude `made` along H, w and v.
    #[inline(always)]
    pub fn advance(&mut self, at: &Here, made: [f64; 3]) {
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

/// Most e-foldings of |w| between two points with a dip in between.
const FOLLOWED: f64 = 16.0;

/// Dip of |w| between two points `step` seconds apart, if it falls after the first and rises before the second:
/// duration of its bottom, s, and |w| there. `across` is |w| at both points, `widening` its relative slope, 1/s. Near
/// an unstable equilibrium |w| = c cosh(lambda t), and 1/|w|^2 integrates to 2/(lambda c^2).
pub fn dip(across: [f64; 2], widening: [f64; 2], step: f64) -> Option<[f64; 2]> {
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
