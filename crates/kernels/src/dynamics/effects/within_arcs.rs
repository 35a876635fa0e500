//! Effects that change within an arc: their arguments ([`Motion`], [`MotionSeries`]) and their interface to the
//! equations of motion.

use super::ChangingEffects;
use super::ChangingSeries;
use super::along_orbit::Along;
use crate::dynamics::environment::air::SWITCH_UNIT;
use crate::dynamics::environment::sun::Sun;
use crate::dynamics::gravity::Gravity;
use crate::dynamics::gyrostat::{ATTITUDE, Gyrostat, IMPULSE, IMPULSE_INTEGRAL, OMEGA, WITH_THRUST};
use crate::dynamics::offset_series::OffsetSeries;
use crate::dynamics::orbit::KeplerOrbit;
use crate::dynamics::orbit_path::PathsInLanes;
use crate::dynamics::orbit_series::OrbitSeries;
use crate::dynamics::orbit_state::OrbitState;
use crate::math::prelude::*;

/// Actions on a body other than its actuators', one run per lane.
#[derive(Clone, Copy, Debug)]
pub struct Beside<R> {
    /// Torque on the body, B, N m.
    pub torque: [R; 3],
    /// Force on the body, B, N, if any.
    pub force: Option<[R; 3]>,
    /// Motion of the point on an orbit to which the state is relative.
    pub carrier: Option<Carrier<R>>,
}

/// Motion of the point on an orbit to which a state is relative.
#[derive(Clone, Copy, Debug)]
pub struct Carrier<R> {
    /// Velocity of the point, F_e, m/s.
    pub velocity: [R; 3],
    /// Gravity at the spacecraft minus gravity at the point, F_e, m/s^2.
    pub tide: [R; 3],
}

/// Arguments of an effect's torque, one run per lane.
#[derive(Clone, Copy, Debug)]
pub struct Motion<R> {
    /// Time, s.
    pub time: R,
    /// Attitude, B -> F_e.
    pub attitude: [R; 4],
    /// Angular velocity relative to F_e, B, rad/s.
    pub rate: [R; 3],
    /// Position on the orbit if an effect acts, otherwise NaN.
    pub place: OrbitState<R>,
    /// Magnetic field at that position, F_e, T, for torques.
    pub field: [R; 3],
    /// The Sun, if an effect needs it.
    pub sun: Sun<R>,
}

impl<R: Real> Motion<R> {
    /// The motion with the integrated components `state` at `time` (s) and `place`, for `effects`: for their torques
    /// or for their switches only.
    #[inline(always)]
    pub fn of<const N: usize>(
        time: R,
        state: &[R; N],
        place: OrbitState<R>,
        effects: &ChangingEffects<R>,
        for_torques: bool,
    ) -> Self {
        let field = if for_torques { effects.field(time, &place) } else { [time.zero(); 3] };
        Motion {
            time,
            attitude: four(state, ATTITUDE),
            rate: three(state, OMEGA),
            place,
            field,
            sun: effects.sun(time),
        }
    }

    /// Keeps the surroundings in the lanes `kept` and copies those of `other` in all others.
    #[inline(always)]
    fn choose(&mut self, kept: R::Mask, other: &Self) {
        let choose = [
            (&mut self.place.position, &other.place.position),
            (&mut self.place.velocity, &other.place.velocity),
            (&mut self.field, &other.field),
            (&mut self.sun.direction, &other.sun.direction),
        ];
        for (own, other) in choose {
            for i in 0..3 {
                own[i] = R::select(kept, own[i], other[i]);
            }
        }
        self.place.distance = R::select(kept, self.place.distance, other.place.distance);
        self.sun.distance = R::select(kept, self.sun.distance, other.sun.distance);
    }
}

/// Arguments of an effect's Taylor series: coefficients up to the present order, in the lane's unit of time.
#[derive(Clone, Debug)]
pub struct MotionSeries<R> {
    /// Attitude, B -> F_e.
    pub attitude: Vec<[R; 4]>,
    /// Angular velocity, B.
    pub rate: Vec<[R; 3]>,
    /// Position, if an effect needs it or the spacecraft may leave its orbit.
    pub orbit: OrbitSeries<R>,
    /// Offset from the orbit.
    offset: OffsetSeries<R>,
    /// True if the spacecraft may leave its orbit.
    may_leave: bool,
    /// True if the orbit's coefficients beyond the first two are needed.
    keeps_orbit: bool,
    /// One in lanes whose two-body orbit is a circle, along which the pull is constant, else zero.
    pub circle: R,
    /// Gravity at the spacecraft minus gravity at the point on the orbit, F_e, m per unit squared.
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
            keeps_orbit: false,
            circle: zero,
            tide: vec![[zero; 3]; order + 1],
        }
    }

    /// Starts a step with the reference point at `position` with `velocity` (m per unit of time) in `gravity` (m^3 per
    /// unit squared). A two-body orbit has all coefficients with `keeps_orbit` only.
    #[inline(always)]
    pub fn begin_orbit(
        &mut self,
        gravity: Gravity<R>,
        [position, velocity]: [[R; 3]; 2],
        may_leave: bool,
        keeps_orbit: bool,
    ) {
        self.may_leave = may_leave;
        self.keeps_orbit = keeps_orbit || gravity.oblateness.is_some();
        if may_leave {
            self.offset.begin(gravity, position, velocity);
        } else {
            self.orbit.begin(gravity, position, velocity);
        }
    }

    /// Computes the coefficients n of the orbit from those of the offset, m.
    #[inline(always)]
    pub fn extend_orbit(&mut self, n: usize, offset: [R; 3]) {
        if self.may_leave {
            self.tide[n] = self.offset.extend(n, offset);
            self.orbit.place(n, self.offset.place()[n]);
        } else if self.keeps_orbit {
            self.orbit.extend(n);
        }
    }

    /// True if the spacecraft stays on a two-body orbit.
    #[inline(always)]
    pub fn is_on_two_body_orbit(&self) -> bool {
        !self.may_leave && self.orbit.gravity().oblateness.is_none()
    }

    /// True if only the first coefficient of the attitude is needed: the position in B follows from the rate.
    #[inline(always)]
    pub fn follows_rate(&self) -> bool {
        !self.may_leave && !self.keeps_orbit
    }

    /// True if the spacecraft may leave that orbit.
    #[inline(always)]
    pub fn may_leave(&self) -> bool {
        self.may_leave
    }

    /// The reference orbit.
    #[inline(always)]
    pub fn reference(&self) -> &OrbitSeries<R> {
        if self.may_leave { self.offset.orbit() } else { &self.orbit }
    }

    /// Coefficient n of the tide, m per unit squared, if the spacecraft may leave its orbit.
    #[inline(always)]
    pub fn tide(&self, n: usize) -> Option<[R; 3]> {
        self.may_leave.then(|| self.tide[n])
    }
}

/// Effects that change within an arc, one run per lane; by default none.
pub trait WithinArcs<R: Real> {
    /// True if there are any.
    const ACT: bool = false;

    /// Effects of empty lanes.
    fn none(zero: R) -> Self;

    /// Copies the effects of `run` into lane `lane`.
    fn set_lane(&mut self, _lane: usize, _run: &Gyrostat<f64>) {}

    /// Copies the arc-dependent constants of `run` into lane `lane`.
    fn set_arc(&mut self, _lane: usize, _run: &Gyrostat<f64>) {}

    /// Reads the surroundings of the last arc of `run` in lane `lane` from their series, if that arc is short.
    fn follow(&mut self, _lane: usize, _run: &mut Gyrostat<f64>) {}

    /// Actions at the integrated components `state` (SI) and `time` (s).
    #[inline(always)]
    fn act<const N: usize>(&self, time: R, _state: &[R; N]) -> Beside<R> {
        Beside { torque: [time.zero(); 3], force: None, carrier: None }
    }

    /// True if they have branches.
    #[inline(always)]
    fn has_switches(&self) -> bool {
        false
    }

    /// [`crate::ode::System::is_rough`].
    #[inline(always)]
    fn is_rough(&self, zero: R) -> R::Mask {
        zero.never()
    }

    /// Smallest switch function; arguments as in [`WithinArcs::act`].
    #[inline(always)]
    fn margin<const N: usize>(&self, time: R, _state: &[R; N]) -> R {
        time.splat(f64::INFINITY)
    }

    /// Upper bound of the change of a switch function over `length` s at rates up to `rate`, rad/s.
    #[inline(always)]
    fn sway(&self, length: R, _rate: R) -> R {
        length.splat(f64::INFINITY)
    }

    /// [`crate::ode::switches::dip`] of all switch functions, from times and states at four fractions of a step.
    #[inline(always)]
    fn dip<const N: usize>(&self, [time, ..]: [R; 4], _states: [&[R; N]; 4]) -> R {
        time.splat(f64::INFINITY)
    }

    /// Chooses the branches in the lanes `lanes`.
    #[inline(always)]
    fn choose_branches<const N: usize>(&mut self, _lanes: R::Mask, _time: R, _state: &[R; N]) {}

    /// Inverse time of changes of the offset from the orbit (1/s) and mass (kg), if the spacecraft may leave the orbit.
    #[inline(always)]
    fn scales_of_offset(&self) -> Option<[R; 2]> {
        None
    }

    /// Taylor series, in `memory`, from `time` (a sum of two numbers, s) on in a unit of time of `unit` seconds.
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

/// No effects.
#[derive(Clone, Copy, Debug)]
pub struct NoEffects;

impl<R: Real> WithinArcs<R> for NoEffects {
    fn none(_zero: R) -> Self {
        NoEffects
    }
}

/// The effects of the list, with the orbit if one of them needs it.
#[derive(Clone, Debug)]
pub struct Acting<R> {
    zero: R,
    orbit: Option<PathsInLanes<R>>,
    effects: ChangingEffects<R>,
    leaving: Option<Leaving<R>>,
    along: Option<Along<R>>,
    /// Upper bounds of the rates at which switch functions change with the motion along the orbit, 1/s.
    drift: R,
}

/// Margin of bounds on the changes of switch functions: rates within steps, wind, J2.
const SWAY: f64 = 1.25;

/// Radial speed by J2 over the speed, at most.
const OBLATE: f64 = 0.01;

/// Masses (kg) and orbital rates (rad/s) of runs that may leave their orbits.
#[derive(Clone, Copy, Debug)]
struct Leaving<R> {
    mass: R,
    inverse_mass: R,
    rate: R,
}

impl<R: Real> Acting<R> {
    /// Arguments of the effects, and the motion of the reference point if the spacecraft may leave its orbit.
    #[inline(always)]
    fn motion<const N: usize>(&self, time: R, state: &[R; N], for_torques: bool) -> (Motion<R>, Option<Carrier<R>>) {
        let along = match &self.along {
            Some(along) if along.is_anywhere => along,
            _ => {
                let (place, carrier) = self.place(time, state);
                return (Motion::of(time, state, place, &self.effects, for_torques), carrier);
            }
        };
        let segment = &along.segment;
        let has_field = for_torques && self.effects.magnetic_torque.is_some();
        let mut motion = Motion {
            time,
            attitude: four(state, ATTITUDE),
            rate: three(state, OMEGA),
            place: segment.place(time),
            field: if has_field { segment.field(time) } else { [time.zero(); 3] },
            sun: segment.sun(time),
        };
        if !along.is_everywhere {
            let direct = Motion::of(time, state, self.place(time, state).0, &self.effects, for_torques);
            let mut covered = time.never();
            for lane in 0..R::LANES {
                covered.set(lane, along.is_covered[lane]);
            }
            motion.choose(covered, &direct);
        }
        (motion, None)
    }

    /// Position, and the motion of the reference point if the spacecraft may leave its orbit.
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

/// Upper bound of the rates at which switch functions change along `orbit`, 1/s: cosines to the flow turn with the
/// velocity, edges of shadows pass at the speed per Earth radius, heights change by the radial speed.
fn drift(orbit: &KeplerOrbit<f64>, effects: &ChangingEffects<f64>) -> f64 {
    let [speed, radial] = orbit.speeds();
    let radius = effects.solar_pressure.as_ref().map_or(f64::INFINITY, |pressure| pressure.light.radius);
    let heights = (radial + OBLATE * speed) / (1e3 * SWITCH_UNIT);
    SWAY * orbit.fastest().max(speed / radius).max(heights)
}

/// Position of a spacecraft near the point `place` on its orbit, and the point's motion.
#[inline(always)]
pub fn beside_orbit<R: Real, const N: usize>(
    gravity: &Gravity<R>,
    place: &OrbitState<R>,
    inverse_mass: R,
    state: &[R; N],
) -> (OrbitState<R>, Option<Carrier<R>>) {
    let offset = [scaled(inverse_mass, three(state, IMPULSE_INTEGRAL)), scaled(inverse_mass, three(state, IMPULSE))];
    let carrier = Carrier { velocity: place.velocity, tide: gravity.tide(place, offset[0]) };
    (place.displaced(offset), Some(carrier))
}

impl<R: Real> WithinArcs<R> for Acting<R> {
    const ACT: bool = true;

    fn none(zero: R) -> Self {
        Acting { zero, orbit: None, effects: ChangingEffects::none(), leaving: None, along: None, drift: zero }
    }

    fn set_lane(&mut self, lane: usize, run: &Gyrostat<f64>) {
        let zero = self.zero;
        self.effects.set_lane(zero, lane, &run.effects);
        if let Some(along) = &mut self.along {
            along.clear(lane);
        }
        if let Some(orbit) = run.orbit.as_ref().filter(|_| !run.effects.is_empty() || run.offset.is_some()) {
            self.orbit.get_or_insert_with(|| PathsInLanes::blank(zero)).set_lane(lane, orbit);
            self.drift.set_lane(lane, drift(orbit.at_start(), &run.effects));
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
        self.effects.set_arc(lane, &run.effects);
    }

    fn follow(&mut self, lane: usize, run: &mut Gyrostat<f64>) {
        if run.orbit.is_some() && run.offset.is_none() && !run.effects.is_empty() {
            let zero = self.zero;
            self.along.get_or_insert_with(|| Along::blank(zero)).follow(lane, run);
        }
    }

    #[inline(always)]
    fn act<const N: usize>(&self, time: R, state: &[R; N]) -> Beside<R> {
        time.apart(
            #[inline(always)]
            || {
                if self.effects.is_empty() {
                    let carrier = self.place(time, state).1;
                    return Beside { torque: [self.zero; 3], force: None, carrier };
                }
                let (motion, carrier) = self.motion(time, state, true);
                Beside { torque: self.effects.torque(&motion), force: self.effects.force(&motion), carrier }
            },
        )
    }

    #[inline(always)]
    fn has_switches(&self) -> bool {
        self.effects.has_switches()
    }

    #[inline(always)]
    fn is_rough(&self, zero: R) -> R::Mask {
        self.effects.is_rough(zero)
    }

    #[inline(always)]
    fn margin<const N: usize>(&self, time: R, state: &[R; N]) -> R {
        time.apart(
            #[inline(always)]
            || self.effects.margin(&self.motion(time, state, false).0),
        )
    }

    #[inline(always)]
    fn sway(&self, length: R, rate: R) -> R {
        length * rate.mul_add(rate.splat(SWAY), self.drift)
    }

    #[inline(always)]
    fn dip<const N: usize>(&self, times: [R; 4], states: [&[R; N]; 4]) -> R {
        self.zero.apart(
            #[inline(always)]
            || {
                let mut motions = [self.motion(times[0], states[0], false).0; 4];
                for m in 1..4 {
                    motions[m] = self.motion(times[m], states[m], false).0;
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
                let motion = self.motion(time, state, false).0;
                self.effects.choose_branches(lanes, &motion);
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
        memory.motion.circle = self.orbit.as_ref().map_or(self.zero, PathsInLanes::circle);
        memory.begin(&self.effects, place.as_ref(), self.leaving.is_some(), time[0], unit);
        Some(memory)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{EnvironmentInput, Epoch, Name, OrbitInput, PlateInput, Scene, SceneInput};

    /// Law: no switch function changes by more than its sway, on low, eccentric and geostationary orbits, at rest and
    /// tumbling.
    #[test]
    fn switch_functions_change_within_their_sway() {
        let plate = |name, normal| PlateInput { name: Name::of(name), normal, area_m2: 1.0, ..PlateInput::DEFAULT };
        for (axis, eccentricity, rate) in
            [(6.7e6, 1e-3, 0.0), (6.9e6, 0.0, 0.05), (2.4e7, 0.72, 1e-3), (4.2e7, 0.0, 0.0)]
        {
            let orbit = OrbitInput {
                semi_major_axis_m: Some(axis),
                eccentricity: Some(eccentricity),
                inclination_rad: Some(0.9),
                epoch: Epoch::parse("2026-11-24T00:00:00Z"),
                j2: Some(1.08262668e-3),
                ..OrbitInput::DEFAULT
            };
            let scene = SceneInput {
                orbit: Some(orbit),
                environment: EnvironmentInput { drag: true, solar_pressure: true, ..EnvironmentInput::DEFAULT },
                plates: vec![plate("a", [1.0, 0.2, 0.0]), plate("b", [0.0, -1.0, 0.3]), plate("c", [0.1, 0.0, 1.0])],
                ..SceneInput::default()
            };
            let mut acting = Acting::none(0.0);
            acting.set_lane(0, &Gyrostat::new(0.0, &Scene::resolve(&scene).expect("a legal scene"), 1e5));
            let state = |time: f64| {
                let (s, c) = libm::sincos(0.5 * rate * time);
                [0.0, 0.6 * rate, 0.8 * rate, c, 0.0, 0.6 * s, 0.8 * s]
            };
            for k in 0..400 {
                let (start, length) = (2e2 * f64::from(k), [0.1, 10.0][k as usize % 2]);
                let end = start + length;
                acting.choose_branches(true, start, &state(start));
                let change = acting.margin(end, &state(end)) - acting.margin(start, &state(start));
                let most = acting.sway(length, rate);
                assert!(change.abs() < most, "{axis:e} m, {rate} rad/s, {start} s: {change:e} of {most:e}");
            }
        }
    }
}
