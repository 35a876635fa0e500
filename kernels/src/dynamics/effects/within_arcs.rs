//! The effects that change within an arc: what they depend on ([`Motion`], [`MotionSeries`]), and as the equations of motion have them: none
//! ([`NoEffects`]), or those of the list ([`ChangingEffects`], [`ChangingSeries`]).
//!
//! The file of such an effect has its constants for one run per lane, with the torque, and the series of the torque; the list in the parent module names
//! both. `changing_effects` says what they must have.

use super::ChangingEffects;
use super::ChangingSeries;
use crate::dynamics::gyrostat::Gyrostat;
use crate::dynamics::orbit::{KeplerOrbit, OrbitState};
use crate::dynamics::orbit_series::OrbitSeries;
use crate::math::Real;

/// What the torque of an effect may depend on, one run per lane.
#[derive(Clone, Copy, Debug)]
pub struct Motion<R> {
    /// Time, s.
    pub time: R,
    /// Attitude, B -> F_e.
    pub attitude: [R; 4],
    /// Angular velocity relative to F_e, B, rad/s.
    pub rate: [R; 3],
    /// Where the spacecraft is on its orbit; known where an effect needs the orbit ([`ChangingEffects::needs_orbit`]), not a number elsewhere.
    pub place: OrbitState<R>,
}

/// What the Taylor series of an effect may depend on: coefficients up to the order that is being computed, in the lanes' units of time.
#[derive(Clone, Debug)]
pub struct MotionSeries<R> {
    /// Of the attitude, B -> F_e.
    pub attitude: Vec<[R; 4]>,
    /// Of the angular velocity, B.
    pub rate: Vec<[R; 3]>,
    /// Of the orbit, where an effect needs it.
    pub orbit: OrbitSeries<R>,
}

impl<R: Real> MotionSeries<R> {
    /// Memory for series of order `order`.
    pub fn new(zero: R, order: usize) -> Self {
        MotionSeries {
            attitude: vec![[zero; 4]; order + 1],
            rate: vec![[zero; 3]; order + 1],
            orbit: OrbitSeries::new(zero, order),
        }
    }
}

/// The effects that change within an arc, of one run per lane.
pub trait WithinArcs<R: Real>: Copy {
    /// Whether there are any.
    const ACT: bool;

    /// Those of empty lanes; `zero` says how many.
    fn none(zero: R) -> Self;

    /// Puts those of `run` into lane `lane`.
    fn set_lane(&mut self, lane: usize, run: &Gyrostat<f64>);

    /// Their torque at `time` (s) on a body of the attitude `q_eb` and the angular velocity `omega_b`, in B, N m.
    fn torque(&self, time: R, q_eb: [R; 4], omega_b: [R; 3]) -> [R; 3];

    /// Their Taylor series from the time on that is the sum of `time` (s), begun in `memory`, in a unit of time of `unit` seconds; `None` where there are
    /// none.
    fn series<'m>(&self, time: [R; 2], unit: R, memory: &'m mut ChangingSeries<R>)
    -> Option<&'m mut ChangingSeries<R>>;
}

/// No effect changes within an arc.
#[derive(Clone, Copy, Debug)]
pub struct NoEffects;

impl<R: Real> WithinArcs<R> for NoEffects {
    const ACT: bool = false;

    fn none(_zero: R) -> Self {
        NoEffects
    }

    fn set_lane(&mut self, _lane: usize, _run: &Gyrostat<f64>) {}

    #[inline(always)]
    fn torque(&self, time: R, _q_eb: [R; 4], _omega_b: [R; 3]) -> [R; 3] {
        [time.zero(); 3]
    }

    #[inline(always)]
    fn series<'m>(
        &self,
        _time: [R; 2],
        _unit: R,
        _memory: &'m mut ChangingSeries<R>,
    ) -> Option<&'m mut ChangingSeries<R>> {
        None
    }
}

/// The effects of the list, with the orbit where one of them needs it.
#[derive(Clone, Copy, Debug)]
pub struct Acting<R> {
    zero: R,
    orbit: Option<KeplerOrbit<R>>,
    effects: ChangingEffects<R>,
}

impl<R: Real> WithinArcs<R> for Acting<R> {
    const ACT: bool = true;

    fn none(zero: R) -> Self {
        Acting { zero, orbit: None, effects: ChangingEffects::none() }
    }

    fn set_lane(&mut self, lane: usize, run: &Gyrostat<f64>) {
        let zero = self.zero;
        self.effects.set_lane(zero, lane, &run.effects);
        if let Some(orbit) = run.orbit.filter(|_| run.effects.needs_orbit()) {
            self.orbit.get_or_insert_with(|| KeplerOrbit::blank().in_lanes(zero)).set_lane(lane, &orbit);
        }
    }

    #[inline(always)]
    fn torque(&self, time: R, q_eb: [R; 4], omega_b: [R; 3]) -> [R; 3] {
        let place = match &self.orbit {
            Some(orbit) => orbit.state(time),
            None => OrbitState::unknown(time),
        };
        self.effects.torque(&Motion { time, attitude: q_eb, rate: omega_b, place })
    }

    #[inline(always)]
    fn series<'m>(
        &self,
        time: [R; 2],
        unit: R,
        memory: &'m mut ChangingSeries<R>,
    ) -> Option<&'m mut ChangingSeries<R>> {
        let place = self.orbit.as_ref().map(|orbit| (orbit.mu(), orbit.state_at(time)));
        memory.begin(&self.effects, place.as_ref(), time[0], unit);
        Some(memory)
    }
}

/// The effects that change within an arc, from the list of their files: those of the form `Series`, then those of the form `Evaluated`:
///
/// ```text
/// series { file: Constants, Series; }
/// evaluated { file: Constants; }
/// ```
///
/// `Constants<R>` has `NEEDS_ORBIT`, `none(zero)`, `set_lane(lane, &Constants<f64>)` and `torque(&Motion<R>)`, in B, N m. `Series<R>` has `new(zero,
/// order)`, `begin(&Constants<R>, time, unit)` and `extend(n, &MotionSeries<R>)`, coefficient n of the torque in the unit of time. The file has `of(zero, scene, c_sb)`, the constants in the frame B that `c_sb` maps to F_s, `None` where the
/// effect does not act; `largest_torque(scene)`, an upper bound, N m; and `largest_rate(scene)`, the fastest motion that it makes, rad/s.
macro_rules! changing_effects {
    (series { $($series:ident: $Of:ident, $Series:ident;)* } evaluated { $($evaluated:ident: $Evaluated:ident;)* }) => {
        within_arcs::changing_effects! { all { $($series: $Of;)* $($evaluated: $Evaluated;)* } }

        impl<R: $crate::math::Real> ChangingEffects<R> {
            /// Those alone that have no series.
            pub fn evaluated(self) -> Self {
                ChangingEffects { $($series: None,)* ..self }
            }
        }

        /// The Taylor series of the effects along a step.
        #[derive(Clone, Debug)]
        pub struct ChangingSeries<R> {
            /// What they depend on.
            pub motion: within_arcs::MotionSeries<R>,
            /// Whether effects without a series act, and a polynomial is fitted to their torque, B, N m in the unit of time.
            fitted: Option<Vec<[R; 3]>>,
            has_orbit: bool,
            $($series: (bool, $series::$Series<R>),)*
            /// Of all torques on the body, B, N m in the unit of time.
            torque: Vec<[R; 3]>,
        }

        impl<R: $crate::math::Real> ChangingSeries<R> {
            /// Memory for series of order `order`.
            pub fn new(zero: R, order: usize) -> Self {
                ChangingSeries {
                    motion: within_arcs::MotionSeries::new(zero, order),
                    fitted: None,
                    has_orbit: false,
                    $($series: (false, $series::$Series::new(zero, order)),)*
                    torque: vec![[zero; 3]; order + 1],
                }
            }

            /// Starts a step of `acting` at `time` (s) in a unit of time of `unit` seconds. `place` is the gravitational parameter (m^3/s^2) and
            /// where the spacecraft is then (m, m/s), where its orbit is needed.
            #[inline(always)]
            pub fn begin(
                &mut self,
                acting: &ChangingEffects<R>,
                place: Option<&(R, $crate::dynamics::orbit::OrbitState<R>)>,
                time: R,
                unit: R,
            ) {
                self.has_orbit = place.is_some();
                if let Some((mu, place)) = place {
                    let velocity = $crate::math::vector::scaled(unit, place.velocity);
                    self.motion.orbit.begin(*mu * (unit * unit), place.position, velocity);
                }
                $(
                    self.$series.0 = acting.$series.is_some();
                    if let Some(effect) = &acting.$series {
                        self.$series.1.begin(effect, time, unit);
                    }
                )*
            }

            /// Takes `torque` as the coefficients of the torque of the effects without a series, B, N m in the unit of time; zero beyond them.
            pub fn fit(&mut self, torque: &[[R; 3]]) {
                let length = self.torque.len();
                let zero = self.torque[0][0].zero();
                let fitted = self.fitted.get_or_insert_with(|| vec![[zero; 3]; length]);
                fitted.fill([zero; 3]);
                fitted[..torque.len()].copy_from_slice(torque);
            }

            /// Coefficient n of the sum of the torques, given those of the motion; call in ascending order of `n`. `constant` is what acts beside
            /// them, for [`ChangingSeries::torque`].
            #[inline(always)]
            pub fn extend(&mut self, n: usize, attitude: [R; 4], rate: [R; 3], constant: [R; 3]) -> [R; 3] {
                let mut own = [attitude[0].zero(); 3];
                self.motion.attitude[n] = attitude;
                self.motion.rate[n] = rate;
                if self.has_orbit {
                    self.motion.orbit.extend(n);
                }
                $(
                    if self.$series.0 {
                        own = $crate::math::vector::sum(own, self.$series.1.extend(n, &self.motion));
                    }
                )*
                if let Some(fitted) = &self.fitted {
                    own = $crate::math::vector::sum(own, fitted[n]);
                }
                self.torque[n] = if n == 0 { $crate::math::vector::sum(constant, own) } else { own };
                own
            }

            /// The coefficients of the torque, with what acts beside it, B, N m in the unit of time.
            #[inline(always)]
            pub fn torque(&self) -> &[[R; 3]] {
                &self.torque
            }
        }
    };
    (all { $($file:ident: $Constants:ident;)* }) => {
        /// The constants of the effects that change within an arc, one run per lane; `None` of those that do not act.
        #[derive(Clone, Copy, Debug)]
        pub struct ChangingEffects<R> {
            $(
                #[doc = concat!("That of `", stringify!($file), "`.")]
                pub $file: Option<$file::$Constants<R>>,
            )*
        }

        impl<R: $crate::math::Real> ChangingEffects<R> {
            /// None.
            pub const fn none() -> Self {
                ChangingEffects { $($file: None,)* }
            }

            /// Those on `scene` in the frame B, which `c_sb` maps to F_s; `zero` says in which arithmetic.
            pub fn of(zero: R, scene: &Scene, c_sb: Option<[[R; 3]; 3]>) -> Self {
                ChangingEffects { $($file: $file::of(zero, scene, c_sb),)* }
            }

            /// Whether none acts.
            pub fn is_empty(&self) -> bool {
                true $(&& self.$file.is_none())*
            }

            /// Whether one acts that depends on where the spacecraft is.
            pub fn needs_orbit(&self) -> bool {
                false $(|| $file::$Constants::<R>::NEEDS_ORBIT && self.$file.is_some())*
            }

            /// Puts `own` into lane `lane` of as many as `zero` has.
            pub fn set_lane(&mut self, zero: R, lane: usize, own: &ChangingEffects<f64>) {
                $(
                    if let Some(own) = &own.$file {
                        self.$file.get_or_insert_with(|| $file::$Constants::none(zero)).set_lane(lane, own);
                    }
                )*
            }

            /// The sum of their torques, B, N m.
            #[inline(always)]
            pub fn torque(&self, motion: &within_arcs::Motion<R>) -> [R; 3] {
                let mut total = [motion.time.zero(); 3];
                $(
                    if let Some(effect) = &self.$file {
                        total = $crate::math::vector::sum(total, effect.torque(motion));
                    }
                )*
                total
            }
        }

        /// Upper bound of the torque of the effects on `scene` that change within an arc, N m.
        pub fn largest_changing_torque(scene: &Scene) -> f64 {
            0.0 $(+ $file::largest_torque(scene))*
        }

        /// The fastest motion that the effects on `scene` make which change within an arc, rad/s.
        pub fn largest_changing_rate(scene: &Scene) -> f64 {
            let mut largest = 0.0_f64;
            $(largest = largest.max($file::largest_rate(scene));)*
            largest
        }
    };
}
pub(super) use changing_effects;
