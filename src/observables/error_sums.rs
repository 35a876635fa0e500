//! [`Sums`]: errors of the rotational state that are carried along a motion, in the axes H, w and v of [`super::conditioning`],
//! where the equations stand.

use crate::math::Real;

/// Errors of one kind until some point, added up.
#[derive(Clone, Copy, Default)]
pub(super) struct Sums {
    /// Along H.
    along: f64,
    /// |w| Y.
    across: f64,
    /// |mu - mu_0| |H| X, where errors along H come to be errors across it.
    tilted: f64,
    /// Shift in time.
    shift: f64,
    /// Turn about L but for what the shift makes of it.
    about: f64,
    /// The largest error until now.
    pub(super) most: f64,
}

/// A point as the sums see it.
pub(super) struct Here {
    /// Time since the point before, and since the start, s.
    pub(super) step: f64,
    pub(super) since: f64,
    pub(super) h: f64,
    pub(super) w: f64,
    /// |mu - mu_0| |H|.
    pub(super) tilt: f64,
    pub(super) axial: f64,
    pub(super) twist: f64,
    pub(super) shear: f64,
    /// The largest difference of mu |H| until now.
    pub(super) range: f64,
    /// Momentum that counts as an error of one, and the largest |omega|.
    pub(super) unit: f64,
    pub(super) largest: f64,
}

impl Sums {
    /// Goes on to a point where the sizes of the error along H, and of the change of the balance, are known.
    #[inline(always)]
    pub(super) fn hold(&mut self, at: &Here, along: f64, balance: f64) {
        let per_w = 1.0 / at.w;
        let sideways = at.tilt.mul_add(along, balance) * per_w;
        self.shift += at.step * per_w * along.mul_add(at.twist, sideways * at.shear);
        self.about += at.step * along.mul_add(at.axial, sideways * at.twist);
        self.note(at, along + sideways + self.shift * at.h * at.w);
    }

    /// Takes note of an error of size `total` at a point.
    #[inline(always)]
    fn note(&mut self, at: &Here, total: f64) {
        // across L: what the constant L allows, and at most what the error of the rate can have swept
        let across = (at.unit / at.h * total).smaller((at.largest * at.since).mul_add(self.most, total));
        let turned = at.unit * 2.0_f64.mul_add(self.shift * at.range, self.about);
        self.most = self.most.larger(total.larger(across + turned));
    }

    /// Goes on to a point, at which errors of size `made` along H, w and v are made.
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
        self.note(at, self.along + sideways + self.shift * at.h * at.w);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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

    /// Law: an error along H alone turns the attitude about L at the rate A_HH, and stays what it is; one across H is
    /// sheared along the curve, by shear t in units of itself where |w| does not change.
    #[test]
    fn errors_grow_in_proportion_to_time() {
        let (mut along, mut across) = (Sums::default(), Sums::default());
        for k in 0..=100 {
            let here = at(if k == 0 { 0.0 } else { 0.1 }, 0.1 * f64::from(k), 0.5);
            along.hold(&here, 1e-6, 0.0);
            across.hold(&here, 0.0, 0.5e-6);
        }
        // 1e-6/2 across L, and 0.5 1e-6 10 about it
        assert!((along.most / 5.5e-6 - 1.0).abs() < 1e-12, "{:e}", along.most);
        // Y = 1e-6; Z = 0.25 10 1e-6 2 0.5/0.5 = 5e-6; as an error of omega their sum
        assert!((across.most / 6e-6 - 1.0).abs() < 1e-12, "{:e}", across.most);
    }
}
