//! [`Light`]: the Sun, and the share of its disc that a spacecraft sees on its orbit.

use super::shadow::lit;
use super::sun::{Sun, sun_at};
use crate::math::prelude::*;
use crate::scene::{Scene, Shadow};

/// Date, Earth radius and shadow model, one run per lane.
#[derive(Clone, Copy, Debug)]
pub struct Light<R> {
    /// Days from J2000.0 to time zero.
    pub(crate) epoch: R,
    /// Radius of the Earth, m.
    pub(crate) radius: R,
    pub(crate) shadow: Shadow,
}

impl<R: Real> Light<R> {
    /// The light on `scene`, if its orbit has an epoch.
    pub fn of(zero: R, scene: &Scene) -> Option<Self> {
        let orbit = scene.orbit.as_ref()?;
        let shadow = scene.environment.shadow;
        Some(Light {
            epoch: zero.splat(orbit.epoch?.days_since_j2000()),
            radius: zero.splat(orbit.body_radius),
            shadow,
        })
    }

    /// The Sun at `time` (s), and the share of its disc visible from `position`, F_e, m.
    #[inline(always)]
    pub fn at(&self, time: R, position: [R; 3]) -> (Sun<R>, R) {
        let sun = self.sun(time);
        (sun, lit(self.shadow, position, &sun, self.radius))
    }

    #[inline(always)]
    pub(crate) fn sun(&self, time: R) -> Sun<R> {
        sun_at(self.epoch, time)
    }
}
