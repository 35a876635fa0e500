//! The effects that change within an arc: what they depend on ([`Motion`], [`MotionSeries`]), and as the equations of motion have them: none
//! ([`NoEffects`]), or those of the list ([`ChangingEffects`], [`ChangingSeries`]).
//!
//! The file of such an effect has its constants for one run per lane, with the torque, and the series of the torque; the list in the parent module names
//! both. `changing_effects` says what they must have.

use super::ChangingEffects;
use super::ChangingSeries;
use crate::dynamics::gravity::Gravity;
use crate::dynamics::gyrostat::{ATTITUDE, Gyrostat, IMPULSE, IMPULSE_INTEGRAL, OMEGA, WITH_THRUST};
use crate::dynamics::offset_series::OffsetSeries;
use crate::dynamics::orbit_path::PathsInLanes;
use crate::dynamics::orbit_series::OrbitSeries;
use crate::dynamics::orbit_state::OrbitState;
use crate::math::Real;
use crate::math::vector::scaled;

/// What acts beside the actuators, one run per lane.
#[derive(Clone, Copy, Debug)]
pub struct Beside<R> {
    /// Torque on the body, B, N m.
    pub torque: [R; 3],
    /// Force on it, B, N, where there is one.
    pub force: Option<[R; 3]>,
    /// Where the motion of the centre of mass is relative to a point on an orbit: what that point does.
    pub carrier: Option<Carrier<R>>,
}

/// What a motion relative to a point on an orbit takes from it.
#[derive(Clone, Copy, Debug)]
pub struct Carrier<R> {
    /// Velocity of the point, F_e, m/s.
    pub velocity: [R; 3],
    /// What gravity accelerates the spacecraft more than the point, F_e, m/s^2.
    pub tide: [R; 3],
}

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

impl<R: Real> Motion<R> {
    /// That of a body whose integrated components are `state`, at `time`, s, where it is at `place`.
    #[inline(always)]
    pub fn of<const N: usize>(time: R, state: &[R; N], place: OrbitState<R>) -> Self {
        let attitude = [state[ATTITUDE], state[ATTITUDE + 1], state[ATTITUDE + 2], state[ATTITUDE + 3]];
        let rate = [state[OMEGA], state[OMEGA + 1], state[OMEGA + 2]];
        Motion { time, attitude, rate, place }
    }
}

/// What the Taylor series of an effect may depend on: coefficients up to the order that is being computed, in the lanes' units of time.
#[derive(Clone, Debug)]
pub struct MotionSeries<R> {
    /// Of the attitude, B -> F_e.
    pub attitude: Vec<[R; 4]>,
    /// Of the angular velocity, B.
    pub rate: Vec<[R; 3]>,
    /// Of where the spacecraft is on its orbit or beside it, where an effect needs it or it may leave its orbit.
    pub orbit: OrbitSeries<R>,
    /// Of the offset from the orbit.
    offset: OffsetSeries<R>,
    /// Whether the spacecraft may leave its orbit.
    may_leave: bool,
    /// What gravity accelerates the spacecraft more than the point on the orbit, F_e, m per unit squared.
    tide: Vec<[R; 3]>,
}

impl<R: Real> MotionSeries<R> {
    /// Memory for series of order `order`.
    pub fn new(zero: R, order: usize) -> Self {
        MotionSeries {
            attitude: vec![[zero; 4]; order + 1],
            rate: vec![[zero; 3]; order + 1],
            orbit: OrbitSeries::new(zero, order),
            offset: OffsetSeries::new(zero, order),
            may_leave: false,
            tide: vec![[zero; 3]; order + 1],
        }
    }

    /// Starts a step where the point on the orbit is at `position` with `velocity` (m per unit of time) in `gravity` (m^3 per unit squared).
    #[inline(always)]
    pub fn begin_orbit(&mut self, gravity: Gravity<R>, position: [R; 3], velocity: [R; 3], may_leave: bool) {
        self.may_leave = may_leave;
        if may_leave {
            self.offset.begin(gravity, position, velocity);
        } else {
            self.orbit.begin(gravity, position, velocity);
        }
    }

    /// Computes the coefficients n of the orbit, given those of the offset, m.
    #[inline(always)]
    pub fn extend_orbit(&mut self, n: usize, offset: [R; 3]) {
        if self.may_leave {
            self.tide[n] = self.offset.extend(n, offset);
            self.orbit.place(n, self.offset.place()[n]);
        } else {
            self.orbit.extend(n);
        }
    }

    /// Whether the spacecraft may leave its orbit.
    #[inline(always)]
    pub fn may_leave(&self) -> bool {
        self.may_leave
    }

    /// The orbit itself, from which the spacecraft may have an offset.
    #[inline(always)]
    pub fn reference(&self) -> &OrbitSeries<R> {
        if self.may_leave { self.offset.orbit() } else { &self.orbit }
    }

    /// Coefficient n of the tide, m per unit squared, where the spacecraft may leave its orbit.
    #[inline(always)]
    pub fn tide(&self, n: usize) -> Option<[R; 3]> {
        self.may_leave.then(|| self.tide[n])
    }
}

/// The effects that change within an arc, of one run per lane.
pub trait WithinArcs<R: Real> {
    /// Whether there are any.
    const ACT: bool;

    /// Those of empty lanes; `zero` says how many.
    fn none(zero: R) -> Self;

    /// Puts those of `run` into lane `lane`.
    fn set_lane(&mut self, lane: usize, run: &Gyrostat<f64>);

    /// Puts what changes in those of `run` from arc to arc into lane `lane`.
    fn set_arc(&mut self, lane: usize, run: &Gyrostat<f64>);

    /// What they do at `time` (s) to a body whose integrated components are `state`, SI.
    fn act<const N: usize>(&self, time: R, state: &[R; N]) -> Beside<R>;

    /// Whether they have branches.
    fn has_switches(&self) -> bool;

    /// The smallest of their switch functions, where they act as in [`WithinArcs::act`].
    fn margin<const N: usize>(&self, time: R, state: &[R; N]) -> R;

    /// The fraction of a step at which one of them may be below zero that is above at both ends ([`crate::ode::switches::dip`]), from the times and states at four fractions.
    fn dip<const N: usize>(&self, times: [R; 4], states: [&[R; N]; 4]) -> R;

    /// Chooses the branches in the lanes `lanes`.
    fn choose_branches<const N: usize>(&mut self, lanes: R::Mask, time: R, state: &[R; N]);

    /// Where a spacecraft may leave its orbit: one over the time in which its offset changes, 1/s, and its mass, kg.
    fn scales_of_offset(&self) -> Option<[R; 2]>;

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

    fn set_arc(&mut self, _lane: usize, _run: &Gyrostat<f64>) {}

    #[inline(always)]
    fn act<const N: usize>(&self, time: R, _state: &[R; N]) -> Beside<R> {
        Beside { torque: [time.zero(); 3], force: None, carrier: None }
    }

    #[inline(always)]
    fn has_switches(&self) -> bool {
        false
    }

    #[inline(always)]
    fn margin<const N: usize>(&self, time: R, _state: &[R; N]) -> R {
        time.splat(f64::INFINITY)
    }

    #[inline(always)]
    fn dip<const N: usize>(&self, [time, ..]: [R; 4], _states: [&[R; N]; 4]) -> R {
        time.splat(f64::INFINITY)
    }

    #[inline(always)]
    fn choose_branches<const N: usize>(&mut self, _lanes: R::Mask, _time: R, _state: &[R; N]) {}

    #[inline(always)]
    fn scales_of_offset(&self) -> Option<[R; 2]> {
        None
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
#[derive(Clone, Debug)]
pub struct Acting<R> {
    zero: R,
    orbit: Option<PathsInLanes<R>>,
    effects: ChangingEffects<R>,
    /// Where runs may leave their orbits: their masses, kg, and rates of their orbits, rad/s.
    leaving: Option<Leaving<R>>,
}

/// What the motion relative to an orbit needs, one run per lane.
#[derive(Clone, Copy, Debug)]
struct Leaving<R> {
    mass: R,
    inverse_mass: R,
    rate: R,
}

impl<R: Real> Acting<R> {
    /// Where the spacecraft is, and what the point on its orbit does where it may leave that.
    #[inline(always)]
    fn place<const N: usize>(&self, time: R, state: &[R; N]) -> (OrbitState<R>, Option<Carrier<R>>) {
        let place = match &self.orbit {
            Some(orbit) => orbit.state_at([time, time.zero()]),
            None => OrbitState::unknown(time),
        };
        match (&self.orbit, &self.leaving) {
            (Some(orbit), Some(leaving)) if N >= WITH_THRUST => {
                beside_orbit(&orbit.gravity(), &place, leaving.inverse_mass, state)
            }
            _ => (place, None),
        }
    }
}

/// Where a spacecraft is whose integrated components are `state`, beside the point `place` on its orbit, and what that point does.
#[inline(always)]
pub fn beside_orbit<R: Real, const N: usize>(
    gravity: &Gravity<R>,
    place: &OrbitState<R>,
    inverse_mass: R,
    state: &[R; N],
) -> (OrbitState<R>, Option<Carrier<R>>) {
    let three = |first: usize| scaled(inverse_mass, [state[first], state[first + 1], state[first + 2]]);
    let offset = [three(IMPULSE_INTEGRAL), three(IMPULSE)];
    let carrier = Carrier { velocity: place.velocity, tide: gravity.tide(place, offset[0]) };
    (place.displaced(offset), Some(carrier))
}

impl<R: Real> WithinArcs<R> for Acting<R> {
    const ACT: bool = true;

    fn none(zero: R) -> Self {
        Acting { zero, orbit: None, effects: ChangingEffects::none(), leaving: None }
    }

    fn set_lane(&mut self, lane: usize, run: &Gyrostat<f64>) {
        let zero = self.zero;
        self.effects.set_lane(zero, lane, &run.effects);
        if let Some(orbit) = run.orbit.as_ref().filter(|_| run.effects.needs_orbit() || run.offset.is_some()) {
            self.orbit.get_or_insert_with(|| PathsInLanes::blank(zero)).set_lane(lane, orbit);
        }
        if let (Some(orbit), Some(_)) = (&run.orbit, &run.offset) {
            let one = zero.splat(1.0);
            let leaving = self.leaving.get_or_insert(Leaving { mass: one, inverse_mass: one, rate: one });
            leaving.mass.set_lane(lane, run.mass);
            leaving.inverse_mass.set_lane(lane, 1.0 / run.mass);
            leaving.rate.set_lane(lane, orbit.at_start().rate());
        }
    }

    #[inline(always)]
    fn set_arc(&mut self, lane: usize, run: &Gyrostat<f64>) {
        if let (Some(torque), Some(own)) = (&mut self.effects.magnetic_torque, &run.effects.magnetic_torque) {
            torque.set_arc(lane, own);
        }
    }

    #[inline(always)]
    fn act<const N: usize>(&self, time: R, state: &[R; N]) -> Beside<R> {
        time.apart(
            #[inline(always)]
            || {
                let (place, carrier) = self.place(time, state);
                if self.effects.is_empty() {
                    return Beside { torque: [self.zero; 3], force: None, carrier };
                }
                let motion = Motion::of(time, state, place);
                Beside { torque: self.effects.torque(&motion), force: self.effects.force(&motion), carrier }
            },
        )
    }

    #[inline(always)]
    fn has_switches(&self) -> bool {
        self.effects.has_switches()
    }

    #[inline(always)]
    fn margin<const N: usize>(&self, time: R, state: &[R; N]) -> R {
        time.apart(
            #[inline(always)]
            || self.effects.margin(&Motion::of(time, state, self.place(time, state).0)),
        )
    }

    #[inline(always)]
    fn dip<const N: usize>(&self, times: [R; 4], states: [&[R; N]; 4]) -> R {
        self.zero.apart(
            #[inline(always)]
            || {
                let mut motions = [Motion::of(times[0], states[0], OrbitState::unknown(self.zero)); 4];
                for m in 0..4 {
                    motions[m] = Motion::of(times[m], states[m], self.place(times[m], states[m]).0);
                }
                self.effects.dip(&motions)
            },
        )
    }

    #[inline(always)]
    fn choose_branches<const N: usize>(&mut self, lanes: R::Mask, time: R, state: &[R; N]) {
        time.apart(
            #[inline(always)]
            || {
                let place = self.place(time, state).0;
                self.effects.choose_branches(lanes, &Motion::of(time, state, place));
            },
        );
    }

    #[inline(always)]
    fn scales_of_offset(&self) -> Option<[R; 2]> {
        self.leaving.as_ref().map(|leaving| [leaving.rate, leaving.mass])
    }

    #[inline(always)]
    fn series<'m>(
        &self,
        time: [R; 2],
        unit: R,
        memory: &'m mut ChangingSeries<R>,
    ) -> Option<&'m mut ChangingSeries<R>> {
        let place = self.orbit.as_ref().map(|orbit| (orbit.gravity(), orbit.state_at(time)));
        memory.begin(&self.effects, place.as_ref(), self.leaving.is_some(), time[0], unit);
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
/// `Constants<R>` has `NEEDS_ORBIT`, `none(zero)`, `set_lane(lane, &Constants<f64>)` and `torque(&Motion<R>)`, in B, N m; those of the form `Evaluated` have
/// a force too, `force(&Motion<R>)`, in B, N, and branches ([`crate::ode::switches`]): `switches(&[Motion<R>; M], visit)` and `choose_branches(lanes, &Motion<R>)`. `Series<R>` has `new(zero,
/// order)`, `begin(&Constants<R>, time, unit)` and `extend(n, &MotionSeries<R>)`, coefficient n of the torque in the unit of time. The file has `of(zero, scene, c_sb)`, the constants in the frame B that `c_sb` maps to F_s, `None` where the
/// effect does not act; `largest_torque(scene)`, an upper bound, N m; and `largest_rate(scene)`, the fastest motion that it makes, rad/s.
macro_rules! changing_effects {
    (series { $($series:ident: $Of:ident, $Series:ident;)* } evaluated { $($evaluated:ident: $Evaluated:ident;)* }) => {
        within_arcs::changing_effects! { all { $($series: $Of;)* $($evaluated: $Evaluated;)* } }

        impl<R: $crate::math::Real> ChangingEffects<R> {
            /// Whether one acts that has branches.
            #[inline(always)]
            pub fn has_switches(&self) -> bool {
                false $(|| self.$evaluated.is_some())*
            }

            /// The sum of their forces, B, N, where they move the centre of mass.
            #[inline(always)]
            pub fn force(&self, motion: &within_arcs::Motion<R>) -> Option<[R; 3]> {
                if !self.is_coupled {
                    return None;
                }
                let mut total = [motion.time.zero(); 3];
                $(
                    if let Some(effect) = &self.$evaluated {
                        total = $crate::math::vector::sum(total, effect.force(motion));
                    }
                )*
                Some(total)
            }

            /// Chooses the branches in the lanes `lanes`.
            #[inline(always)]
            pub fn choose_branches(&mut self, lanes: R::Mask, motion: &within_arcs::Motion<R>) {
                $(
                    if let Some(effect) = &mut self.$evaluated {
                        effect.choose_branches(lanes, motion);
                    }
                )*
            }

            /// The smallest of the switch functions in their branches.
            #[inline(always)]
            pub fn margin(&self, motion: &within_arcs::Motion<R>) -> R {
                let mut least = motion.time.splat(f64::INFINITY);
                self.switches(
                    &[*motion],
                    #[inline(always)]
                    |[margin]: [R; 1]| least = margin.smaller(least),
                );
                least
            }

            /// The fraction of a step at which one of them may be below zero that is above at both ends ([`crate::ode::switches::dip`]).
            #[inline(always)]
            pub fn dip(&self, motions: &[within_arcs::Motion<R>; 4]) -> R {
                let mut first = motions[0].time.splat(f64::INFINITY);
                self.switches(
                    motions,
                    #[inline(always)]
                    |margins: [R; 4]| first = $crate::ode::switches::dip(margins).smaller(first),
                );
                first
            }

            /// Gives `visit` each switch function in its branch, in `M` states.
            #[inline(always)]
            fn switches<const M: usize>(&self, motions: &[within_arcs::Motion<R>; M], mut visit: impl FnMut([R; M])) {
                $(
                    if let Some(effect) = &self.$evaluated {
                        effect.switches(motions, &mut visit);
                    }
                )*
            }
        }

        /// The Taylor series of the effects along a step.
        #[derive(Clone, Debug)]
        pub struct ChangingSeries<R> {
            /// What they depend on.
            pub motion: within_arcs::MotionSeries<R>,
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
                    has_orbit: false,
                    $($series: (false, $series::$Series::new(zero, order)),)*
                    torque: vec![[zero; 3]; order + 1],
                }
            }

            /// Starts a step of `acting` at `time` (s) in a unit of time of `unit` seconds. `place` is the gravity of the central body and
            /// where the orbit is then (m, m/s), where it is needed; the spacecraft may leave it where `may_leave`.
            #[inline(always)]
            pub fn begin(
                &mut self,
                acting: &ChangingEffects<R>,
                place: Option<&($crate::dynamics::gravity::Gravity<R>, $crate::dynamics::orbit_state::OrbitState<R>)>,
                may_leave: bool,
                time: R,
                unit: R,
            ) {
                self.has_orbit = place.is_some();
                if let Some((gravity, place)) = place {
                    let velocity = $crate::math::vector::scaled(unit, place.velocity);
                    self.motion.begin_orbit(gravity.in_unit(unit), place.position, velocity, may_leave);
                }
                $(
                    self.$series.0 = acting.$series.is_some();
                    if let Some(effect) = &acting.$series {
                        self.$series.1.begin(effect, time, unit);
                    }
                )*
            }

            /// Coefficient n of the sum of the torques, given those of the motion: attitude, rate and offset from the orbit (m); call in ascending
            /// order of `n`. `constant` is what acts beside them, for [`ChangingSeries::torque`].
            #[inline(always)]
            pub fn extend(
                &mut self,
                n: usize,
                (attitude, rate, offset): ([R; 4], [R; 3], [R; 3]),
                constant: [R; 3],
            ) -> [R; 3] {
                let mut own = [attitude[0].zero(); 3];
                self.motion.attitude[n] = attitude;
                self.motion.rate[n] = rate;
                if self.has_orbit {
                    self.motion.extend_orbit(n, offset);
                }
                $(
                    if self.$series.0 {
                        own = $crate::math::vector::sum(own, self.$series.1.extend(n, &self.motion));
                    }
                )*
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
            /// Whether their forces move the centre of mass.
            pub is_coupled: bool,
        }

        impl<R: $crate::math::Real> ChangingEffects<R> {
            /// None.
            pub const fn none() -> Self {
                ChangingEffects { $($file: None,)* is_coupled: false }
            }

            /// Those on `scene` in the frame B, which `c_sb` maps to F_s; `zero` says in which arithmetic.
            pub fn of(zero: R, scene: &Scene, c_sb: Option<[[R; 3]; 3]>) -> Self {
                ChangingEffects { $($file: $file::of(zero, scene, c_sb),)* is_coupled: scene.environment.moves() }
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
                // the same in all runs of a plan
                self.is_coupled |= own.is_coupled;
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
