//! Air and light on a spacecraft: density, hidden share of the Sun, torques.

use fearless_simd::Simd;

use super::attitude::Attitude;
use super::points::{MeasuredRun, SeriesTable, needed, three};
use super::table::Series;
use crate::dynamics::effects::drag::{self, Drag};
use crate::dynamics::effects::solar_pressure::{self, SolarPressure};
use crate::dynamics::environment::air::Air;
use crate::dynamics::environment::light::Light;
use crate::dynamics::orbit_state::OrbitState;
use crate::math::prelude::*;
use crate::run::StateField;

/// Power of sunlight at one astronomical unit, W/m^2 (G. Kopp, J. Lean, *Geophysical Research Letters* 38, 2011:
/// 1360.8).
const SOLAR_CONSTANT: f64 = 1361.0;

#[inline(always)]
pub fn surroundings<S: Simd>(simd: S, run: &MeasuredRun<'_>, out: &mut SeriesTable) {
    let has = |series: [Series; 2]| series.into_iter().any(|series| run.observed.has(series));
    let zero = Lanes::broadcast(simd, 0.0);
    if let Some(drag) = drag::of(zero, run.scene, None).filter(|_| has([Series::AirDensity, Series::DragTorqueSquare]))
    {
        air(simd, run, drag, out);
    }
    let light = Light::of(zero, run.scene)
        .filter(|_| has([Series::SunHidden, Series::SolarTorqueSquare]) || run.observed.has(Series::SolarPower));
    if let (Some(light), Some(pressure)) = (light, solar_pressure::of(zero, run.scene, None)) {
        sunlight(simd, run, &light, &pressure, out);
    }
}

#[inline(always)]
fn air<S: Simd>(simd: S, run: &MeasuredRun<'_>, mut drag: Drag<Lanes<S>>, out: &mut SeriesTable) {
    let (table, vectors) = (run.table, run.vectors());
    let positions: [_; 3] = needed(table, StateField::ComPosition, vectors);
    let velocities: [_; 3] = needed(table, StateField::ComVelocity, vectors);
    let attitude = Attitude::of(table, vectors);
    let [densities, torques] = out.write([Series::AirDensity, Series::DragTorqueSquare], vectors);
    for at in 0..vectors {
        let (position, velocity) = (three(simd, positions, at), three(simd, velocities, at));
        let place = OrbitState { position, velocity, distance: norm(position) };
        let density = drag.density_anywhere(place.distance);
        let wind = transposed_product(attitude.c_es(simd, at), Air::relative_velocity(&place));
        let torque = drag.torque_at(density, wind);
        dot(torque, torque).store(&mut torques[at]);
        density.store(&mut densities[at]);
    }
}

#[inline(always)]
fn sunlight<S: Simd>(
    simd: S,
    run: &MeasuredRun<'_>,
    light: &Light<Lanes<S>>,
    pressure: &SolarPressure<Lanes<S>>,
    out: &mut SeriesTable,
) {
    let (table, vectors) = (run.table, run.vectors());
    let positions: [_; 3] = needed(table, StateField::ComPosition, vectors);
    let attitude = Attitude::of(table, vectors);
    let one = Lanes::broadcast(simd, 1.0);
    let [hidden, torques, powers] =
        out.write([Series::SunHidden, Series::SolarTorqueSquare, Series::SolarPower], vectors);
    for at in 0..vectors {
        // beyond the last point its time is repeated
        let times: [f64; WIDTH] = core::array::from_fn(|lane| run.times[(WIDTH * at + lane).min(run.points - 1)]);
        let (sun, lit) = light.at(Lanes::load(simd, &times), three(simd, positions, at));
        let direction = transposed_product(attitude.c_es(simd, at), sun.direction);
        let share = lit / (sun.distance * sun.distance);
        let torque = pressure.torque_at(share, direction);
        let mut facing = one.zero();
        for plate in &run.scene.plates {
            let cosine = dot(constant(one, plate.normal), direction);
            facing = cosine.larger(one.zero()).mul_add(one.splat(plate.cells), facing);
        }
        (share * facing * one.splat(SOLAR_CONSTANT)).store(&mut powers[at]);
        dot(torque, torque).store(&mut torques[at]);
        (one - lit).store(&mut hidden[at]);
    }
}
