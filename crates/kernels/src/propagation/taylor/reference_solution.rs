//! [`ReferenceSolution`]: reference solution of any scene by the Taylor recurrences in double-double (106 bits).
//!
//! One run at a time, every arc restarted exactly at its switch, order and step from a tolerance near the rounding of
//! the arithmetic (A. Jorba & M. Zou, Experimental Mathematics 14, 2005), without periodic folding, which a solution
//! that shared it could not judge. Debris is a gyrostat without wheels. Effects without Taylor series are integrated by
//! extrapolation (`switched_reference`).
//!
//! The reference solution is the exact motion for the `f64` numbers of a [`Scene`]: rounding of mass properties is no
//! error of integration.

use fearless_simd::Simd;

use super::jet::{Reciprocals, Scratch, expand, turn_impulse};
use super::lane_vectors::si_factors;
pub use super::reference_run::MOST_STEPS;
use super::reference_run::{Integration, N, ReferenceOrbit};
use super::step::StepRule;
use super::switched_reference;
use crate::dynamics::actuation::ActuationLaw;
use crate::dynamics::applied::next_arc;
use crate::dynamics::debris;
use crate::dynamics::effects::{ChangingSeries, ForceModel};
use crate::dynamics::gravity::Gravity;
use crate::dynamics::gyrostat::equations::Constants;
use crate::dynamics::gyrostat::observed::observed_state;
use crate::dynamics::gyrostat::{
    ANGLE, ANGULAR_IMPULSE, ATTITUDE, Gyrostat, IMPULSE, IMPULSE_INTEGRAL, MOTOR_WORK, OMEGA, THRUST_WORK,
};
use crate::dynamics::orbit_series::OrbitSeries;
use crate::dynamics::orbit_state::OrbitState;
use crate::math::double_double::DoubleDouble;
use crate::math::isa::LaneWork;
use crate::math::prelude::*;
use crate::math::{Isa, Real};
use crate::propagation::integrated_effects::{by_evaluation, by_series};
use crate::propagation::settings::observes_debris_rotation;
use crate::run::Status;
use crate::run::{Grid, StateField, StateFields, StateTable};
use crate::scene::MAX_WHEELS;
use crate::scene::{Offsets, Scene};

/// Relative tolerance: five times the rounding of double-double (2^-105 = 2.5e-32).
pub const TOLERANCE: f64 = 1e-31;

/// States of a run at its observation points, as unevaluated sums of two tables.
#[derive(Clone, Debug)]
pub struct ReferenceSolution {
    /// The states rounded to `f64`.
    pub high: StateTable,
    /// The rounding errors of `high`.
    pub low: StateTable,
}

impl ReferenceSolution {
    /// Motion of `scene` by its own schedule at the times of `grid`, in the `fields` of a gyrostat ([`StateField::Dcm`]
    /// and [`StateField::Residuals`] stay zero).
    ///
    /// # Errors
    /// [`Status::NonFinite`] or [`Status::StepLimit`] if the run does not reach its end.
    pub fn new(isa: Isa, scene: &Scene, grid: &Grid, fields: StateFields, tolerance: f64) -> Result<Self, Status> {
        Self::solve(isa, scene, None, grid, fields, tolerance)
    }

    /// Motion under `law`, which observes the state rounded to `f64`.
    ///
    /// # Errors
    /// As [`ReferenceSolution::new`].
    ///
    /// # Panics
    /// If the law's arc ends before it starts.
    pub fn under(
        law: &mut dyn ActuationLaw,
        isa: Isa,
        scene: &Scene,
        grid: &Grid,
        fields: StateFields,
        tolerance: f64,
    ) -> Result<Self, Status> {
        Self::solve(isa, scene, Some(law), grid, fields, tolerance)
    }

    /// Tolerance under `model`: [`TOLERANCE`], or the limit set by torques without a series.
    pub fn tolerance(model: ForceModel) -> f64 {
        if model.is_integrated(by_series) { TOLERANCE } else { switched_reference::TOLERANCE }
    }

    fn solve(
        isa: Isa,
        scene: &Scene,
        law: Option<&mut dyn ActuationLaw>,
        grid: &Grid,
        fields: StateFields,
        tolerance: f64,
    ) -> Result<Self, Status> {
        assert!(ForceModel::of(scene).is_integrated(by_evaluation), "the reference solution leaves out an effect");
        let rule = StepRule::new(tolerance);
        let (mut run, mut coarse) = (Gyrostat::blank(DoubleDouble::exact(0.0)), Gyrostat::blank(0.0));
        run.reset(DoubleDouble::exact(0.0), scene);
        coarse.reset(0.0, scene);
        // a body at rest has no time scale of its own
        coarse.note_orbit();
        if law.is_none() {
            coarse.expect_schedule(scene, grid.duration());
        }
        let mut solution = Self::blank(fields, scene.mass.wheels.len(), grid);
        let states =
            isa.run_narrow(Integration { run: &mut run, coarse: &mut coarse, scene: Some(scene), law, grid, rule })?;
        for (point, state) in states.iter().enumerate() {
            solution.complete(&run, grid.times()[point], point, state);
        }
        if scene.mass.debris.is_some() {
            solution.complete_debris(isa, scene, grid, rule)?;
        }
        solution.high.pad();
        solution.low.pad();
        Ok(solution)
    }

    fn blank(fields: StateFields, wheels: usize, grid: &Grid) -> Self {
        let table = StateTable::new(fields, wheels, grid.points());
        ReferenceSolution { high: table.clone(), low: table }
    }

    /// Components of `field` at point `point`, in all digits.
    pub fn at<const K: usize>(&self, field: StateField, point: usize) -> [DoubleDouble; K] {
        let (high, low) = (self.high.at::<K>(field, point), self.low.at::<K>(field, point));
        std::array::from_fn(|i| DoubleDouble { high: high[i], low: low[i] })
    }

    /// `sign` x - reference| for the components x of `field` at `point` of `table`, in all digits of the reference.
    pub fn distance<const K: usize>(&self, table: &StateTable, field: StateField, point: usize, sign: f64) -> f64 {
        let (high, low) = (self.high.at::<K>(field, point), self.low.at::<K>(field, point));
        let state = table.at::<K>(field, point);
        (0..K).map(|i| (sign * state[i] - high[i]) - low[i]).map(|off| off * off).sum::<f64>().sqrt()
    }

    fn put(&mut self, field: StateField, point: usize, values: &[DoubleDouble]) {
        if self.high.has(field) {
            for (component, value) in values.iter().enumerate() {
                self.high.column_mut(field, component)[point] = value.high;
                self.low.column_mut(field, component)[point] = value.low;
            }
        }
    }

    /// Fills the spacecraft's fields at `point` from the integrated components.
    fn complete(&mut self, run: &Gyrostat<DoubleDouble>, time: f64, point: usize, y: &[DoubleDouble; N]) {
        let zero = DoubleDouble::exact(0.0);
        let (omega_b, omega_s, q_es) = rotation(run, y);
        self.put(StateField::Rate, point, &omega_s);
        self.put(StateField::Attitude, point, &q_es);
        let arc = run.arc_at(time);
        let (mut rates, mut angles) = ([zero; MAX_WHEELS], [zero; MAX_WHEELS]);
        for (i, wheel) in run.wheels.iter().enumerate() {
            let motion = run.wheel_at(arc, i, time);
            rates[i] = wheel.rate(motion.momentum, omega_b);
            angles[i] = wheel.angle(DoubleDouble::exact(time), motion.turn, three(y, ANGLE));
        }
        self.put(StateField::WheelRates, point, &rates[..run.wheels.len()]);
        self.put(StateField::WheelAngles, point, &angles[..run.wheels.len()]);
        let inverse_mass = DoubleDouble::exact(1.0) / run.mass;
        let impulse = three(y, IMPULSE);
        let line = sum(run.r_co_e, scaled(DoubleDouble::exact(time), run.v_co_e));
        self.put(StateField::ComPosition, point, &sum(line, scaled(inverse_mass, three(y, IMPULSE_INTEGRAL))));
        self.put(StateField::ComVelocity, point, &sum(run.v_co_e, scaled(inverse_mass, impulse)));
        self.put(StateField::Impulse, point, &impulse);
        self.put(StateField::AngularImpulse, point, &three(y, ANGULAR_IMPULSE));
        let mut motors = y[MOTOR_WORK];
        if let Some(held) = run.held_momentum_b() {
            motors += dot(held, difference(omega_b, run.omega_b));
        }
        self.put(StateField::Work, point, &[y[THRUST_WORK], motors]);
    }

    fn complete_debris(&mut self, isa: Isa, scene: &Scene, grid: &Grid, rule: StepRule) -> Result<(), Status> {
        let exact = |vector: [f64; 3]| vector.map(DoubleDouble::exact);
        if let (Some(orbit), Some(Offsets { debris, .. })) = (&scene.orbit, &scene.offsets) {
            let start = [
                sum(exact(orbit.position), exact(debris.position)),
                sum(exact(orbit.velocity), exact(debris.velocity)),
            ];
            let gravity = Gravity::of(orbit).in_lanes(DoubleDouble::exact(0.0));
            let mut free = FreeOrbit::new(gravity, start, rule);
            let start = OrbitState::at_rest(start[0]);
            for (point, time) in grid.times().iter().enumerate() {
                let place = free.at(DoubleDouble::exact(*time));
                self.put(StateField::DebrisPosition, point, &place.position);
                self.put(StateField::DebrisVelocity, point, &place.velocity);
                if let (Some(body), true) = (&scene.mass.debris, self.high.has(StateField::Work)) {
                    let [thrusters, motors] = self.at::<2>(StateField::Work, point);
                    let own = gravity.work_on(DoubleDouble::exact(body.mass), &start, &place);
                    self.put(StateField::Work, point, &[thrusters + own, motors]);
                }
            }
        } else {
            let (start, velocity) = (exact(scene.initial.r_gdo_e), exact(scene.initial.v_gdo_e));
            for (point, time) in grid.times().iter().enumerate() {
                let position = sum(start, scaled(DoubleDouble::exact(*time), velocity));
                self.put(StateField::DebrisPosition, point, &position);
                self.put(StateField::DebrisVelocity, point, &velocity);
            }
        }
        if !observes_debris_rotation(self.high.fields()) {
            return Ok(());
        }
        let mut coarse = Gyrostat::blank(0.0);
        debris::set_rotation(&mut coarse, scene);
        let mut run = Gyrostat::blank(DoubleDouble::exact(0.0));
        debris::set_rotation(&mut run, scene);
        let states =
            isa.run_narrow(Integration { run: &mut run, coarse: &mut coarse, scene: None, law: None, grid, rule })?;
        for (point, state) in states.iter().enumerate() {
            let (_, omega_d, q_ed) = rotation(&run, state);
            self.put(StateField::DebrisRate, point, &omega_d);
            self.put(StateField::DebrisAttitude, point, &q_ed);
        }
        Ok(())
    }
}

/// Angular velocity in B and in the body frame, and attitude of the body frame.
fn rotation(
    run: &Gyrostat<DoubleDouble>,
    y: &[DoubleDouble; N],
) -> ([DoubleDouble; 3], [DoubleDouble; 3], [DoubleDouble; 4]) {
    let omega_b = three(y, OMEGA);
    let q_eb = four(y, ATTITUDE);
    match run.c_sb {
        Some(c_sb) => (omega_b, product(c_sb, omega_b), hamilton(q_eb, conjugate(run.q_sb))),
        None => (omega_b, omega_b, q_eb),
    }
}

impl LaneWork for Integration<'_, '_> {
    type Output = Result<Vec<[DoubleDouble; N]>, Status>;

    fn run<S: Simd, R: Real + Send + 'static>(self, simd: S, _: R) -> Self::Output {
        simd.vectorize(
            #[inline(always)]
            || if self.run.effects.has_switches() { self.switched_states(simd) } else { self.states() },
        )
    }
}

impl Integration<'_, '_> {
    pub(super) fn begin_arc(&mut self, time: f64, unit: f64, state: &[DoubleDouble; N]) {
        let duration = self.grid.duration();
        let Some(scene) = self.scene else {
            self.run.begin_free_arc(duration);
            return;
        };
        let run = &self.run;
        let observed = || {
            let mut components = *state;
            scale(&mut components, si_factors(1.0 / unit));
            observed_state(run, time, &components, &run.wheels_at(time))
        };
        let law = self.law.as_mut().map(|law| &mut **law as &mut dyn ActuationLaw);
        let arc = next_arc(scene, law, time, observed, duration);
        self.run.begin_arc(scene, arc);
        if self.law.is_some() {
            self.coarse.begin_arc(scene, arc);
            self.coarse.note_rate();
        }
    }

    /// Integrated components at the observation points, SI.
    #[inline(always)]
    fn states(mut self) -> Result<Vec<[DoubleDouble; N]>, Status> {
        let (grid, rule) = (self.grid, self.rule);
        let zero = DoubleDouble::exact(0.0);
        let order = rule.order;
        let reciprocals = Reciprocals::new(zero, order);
        let mut scratch = Scratch::new(zero);
        let mut jet = vec![[zero; N]; order + 1];
        let mut unit = self.coarse.time_unit();
        let mut state = [zero; N];
        state[OMEGA..OMEGA + 3].copy_from_slice(&scaled(DoubleDouble::exact(unit), self.run.omega_b));
        state[ATTITUDE..ATTITUDE + 4].copy_from_slice(&self.run.q_eb);
        if let Some(offset) = self.run.start_of_offset() {
            state[IMPULSE..IMPULSE_INTEGRAL + 3].copy_from_slice(&offset);
            for component in &mut state[IMPULSE..IMPULSE + 3] {
                *component = *component * DoubleDouble::exact(unit);
            }
        }
        let times = grid.times();
        let mut states = Vec::with_capacity(times.len());
        let mut steps = 0;
        let (mut reached, mut is_last) = (0.0, false);
        let turns = !self.run.effects.is_empty();
        let mut orbit = self.run.orbit.as_ref().map(|orbit| ReferenceOrbit::new(self.run, orbit));
        let mut series = (turns || orbit.is_some()).then(|| ChangingSeries::new(zero, order).with_orbit());
        while !is_last {
            self.begin_arc(reached, unit, &state);
            let new_unit = self.coarse.time_unit();
            if new_unit != unit {
                // powers of two: exact
                scale(&mut state, si_factors(1.0 / unit));
                scale(&mut state, si_factors(new_unit));
                unit = new_unit;
            }
            let number = self.run.arcs.len() - 1;
            let constants = Constants::of(self.run, number, unit);
            let (per_second, factors) = (DoubleDouble::exact(1.0 / unit), si_factors::<f64, N>(1.0 / unit));
            let arc = &self.run.arcs[number];
            let bounds = arc.arc;
            reached = bounds.end();
            is_last = reached >= grid.duration();
            let start = DoubleDouble::exact(bounds.start);
            let length = (DoubleDouble::exact(bounds.end()) - start) * per_second;
            let is_forced = turns || arc.force_b.iter().chain(&arc.torque_b).any(|component| component.high != 0.0);
            // thrust turns with omega, the quaternion with omega/2: the series of its integrals need half the step
            let share = DoubleDouble::exact(if is_forced { 0.5 } else { 1.0 });
            let mut time = zero;
            let mut lands = false;
            while !lands {
                let mut now = constants;
                now.momentum = sum(constants.momentum, scaled(time, constants.momentum_rate));
                now.motor_power = constants.motor_power_rate.mul_add(time, constants.motor_power);
                jet[0] = state;
                let at = start + time * DoubleDouble::exact(unit);
                let may_leave = self.run.offset.is_some();
                if let Some(series) = &mut series {
                    let place = orbit.as_mut().map(|orbit| orbit.begin(unit));
                    series.begin(&self.run.effects, place.as_ref(), may_leave, at, DoubleDouble::exact(unit));
                }
                expand::<DoubleDouble, N, true>(&now, &reciprocals, order, &mut scratch, series.as_mut(), &mut jet);
                let mut proposed = share * rule.step(&jet, Some(constants.torque_acceleration()));
                if let Some(series) = series.as_ref().filter(|_| orbit.is_some()) {
                    proposed = proposed.smaller(step_of_orbit(series.motion.reference(), &rule));
                }
                if turns {
                    proposed = proposed.smaller(rule.step_of_impulse(&jet));
                }
                if may_leave {
                    proposed = proposed.smaller(rule.step_of_offset(&jet, constants.mass));
                }
                let along = series.as_ref().map(|series| series.motion.reference());
                let left = length - time;
                lands = !proposed.lt(left);
                let step = if lands { left } else { proposed };
                while let Some(at) = times.get(states.len()) {
                    let within = (DoubleDouble::exact(*at) - start) * per_second - time;
                    let covered = if lands { is_last || *at <= bounds.end() } else { !step.lt(within) };
                    if !covered {
                        break;
                    }
                    let mut values = value(&jet, within, &state, series.is_some());
                    scale(&mut values, factors);
                    if let Some((orbit, along)) = orbit.as_ref().zip(along) {
                        orbit.complete(*at, &orbit.at(along, within), &mut values);
                    }
                    states.push(values);
                }
                state = value(&jet, step, &state, series.is_some());
                if let Some((orbit, along)) = orbit.as_mut().zip(along) {
                    orbit.place = orbit.at(along, step);
                }
                if !(state[0].high + state[1].high + state[2].high).is_finite() {
                    return Err(Status::NonFinite);
                }
                time += step;
                steps += 1;
                if steps == MOST_STEPS {
                    return Err(Status::StepLimit);
                }
            }
        }
        Ok(states)
    }
}

/// Orbit of the debris by itself instead of by the offset that it judges. Times in s.
struct FreeOrbit {
    gravity: Gravity<DoubleDouble>,
    rule: StepRule,
    series: OrbitSeries<DoubleDouble>,
    /// Start and length of the step.
    start: DoubleDouble,
    length: DoubleDouble,
}

impl FreeOrbit {
    /// From position (m) and velocity (m/s) at time zero.
    fn new(gravity: Gravity<DoubleDouble>, [position, velocity]: [[DoubleDouble; 3]; 2], rule: StepRule) -> Self {
        let zero = DoubleDouble::exact(0.0);
        let series = OrbitSeries::new(zero, rule.order);
        let mut orbit = FreeOrbit { gravity, rule, series, start: zero, length: zero };
        orbit.step_from(position, velocity);
        orbit
    }

    fn step_from(&mut self, position: [DoubleDouble; 3], velocity: [DoubleDouble; 3]) {
        self.series.begin(self.gravity, position, velocity);
        (0..=self.rule.order).for_each(|n| self.series.extend(n));
        self.length = step_of_orbit(&self.series, &self.rule);
    }

    /// State at `time`; in ascending order.
    fn at(&mut self, time: DoubleDouble) -> OrbitState<DoubleDouble> {
        while self.length.lt(time - self.start) {
            let end = self.series.at(self.length);
            self.start += self.length;
            self.step_from(end.position, end.velocity);
        }
        self.series.at(time - self.start)
    }
}

/// Step allowed by the series of the position.
fn step_of_orbit(along: &OrbitSeries<DoubleDouble>, rule: &StepRule) -> DoubleDouble {
    let position = along.position();
    rule.step_of_series([0, rule.order - 1, rule.order].map(|n| dot(position[n], position[n])))
}

#[inline(always)]
fn scale(values: &mut [DoubleDouble; N], factors: [f64; N]) {
    for i in 0..N {
        values[i] = values[i] * DoubleDouble::exact(factors[i]);
    }
}

/// Components `x` after `start`; `has_effects`: the jet is one with effects.
#[inline(always)]
fn value(
    jet: &[[DoubleDouble; N]],
    x: DoubleDouble,
    start: &[DoubleDouble; N],
    has_effects: bool,
) -> [DoubleDouble; N] {
    let mut sums = jet[jet.len() - 1];
    for coefficients in jet[..jet.len() - 1].iter().rev() {
        for i in 0..N {
            sums[i] = sums[i].mul_add(x, coefficients[i]);
        }
    }
    if has_effects {
        turn_impulse(four(&sums, ATTITUDE), &mut sums);
        for i in ANGULAR_IMPULSE..ANGULAR_IMPULSE + 3 {
            sums[i] += start[i];
        }
    }
    sums
}
