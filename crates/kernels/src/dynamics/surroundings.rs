//! [`Surroundings`]: what depends on an orbit and the time alone (position, velocity, magnetic field, direction to the
//! Sun), as series in time.
//!
//! The k-th [`Segment`] covers two strides from k strides on and interpolates direct evaluations at Chebyshev points,
//! so that any interval of up to one stride lies in the segment of its start. The stride is a power of two and at most
//! `HALF_TURN` at the fastest rate of orbit and Earth: position and field are those of direct evaluation to a few
//! 1e-15. A segment depends on orbit and time alone, by the same operations on every instruction set.

use std::cell::RefCell;
use std::sync::LazyLock;

use fearless_simd::Simd;

use super::environment::EARTH_RATE;
use super::environment::sun::{Sun, sun_at};
use super::magnetic_field::MagneticField;
use super::orbit_path::OrbitPath;
use super::orbit_state::OrbitState;
use crate::math::isa::{Isa, LaneWork, Work};
use crate::math::prelude::*;
use crate::scene::{Arc, Epoch, Scene};

/// Coefficients of the series of position, velocity and field; of the Sun.
const TERMS: usize = 10;
const TERMS_OF_SUN: usize = 4;

/// Largest turn of orbit or Earth in a stride, rad.
const HALF_TURN: f64 = 0.0375;

/// Series on a segment in the fraction of its half from its middle, one run per lane.
#[derive(Clone, Copy, Debug)]
pub struct Segment<R> {
    /// Middle, s, and 1/half length, 1/s.
    middle: R,
    scale: R,
    /// Position and velocity, F_e, m and m/s.
    place: [[R; 6]; TERMS],
    /// Magnetic field, F_e, T.
    field: [[R; 3]; TERMS],
    /// Unit vector to the Sun, F_e, and distance, au.
    sun: [[R; 4]; TERMS_OF_SUN],
}

impl<R: Real> Segment<R> {
    /// Arbitrary constants for empty lanes.
    pub fn blank(zero: R) -> Self {
        let mut blank = Segment {
            middle: zero,
            scale: zero,
            place: [[zero; 6]; TERMS],
            field: [[zero; 3]; TERMS],
            sun: [[zero; 4]; TERMS_OF_SUN],
        };
        (blank.place[0], blank.sun[0]) = ([zero.splat(1.0); 6], [zero.splat(1.0); 4]);
        blank
    }

    /// Copies `own` into lane `lane`.
    pub fn set_lane(&mut self, lane: usize, own: &Segment<f64>) {
        self.middle.set_lane(lane, own.middle);
        self.scale.set_lane(lane, own.scale);
        for (place, own) in self.place.iter_mut().zip(&own.place) {
            set_lanes(place, lane, own);
        }
        for (field, own) in self.field.iter_mut().zip(&own.field) {
            set_lanes(field, lane, own);
        }
        for (sun, own) in self.sun.iter_mut().zip(&own.sun) {
            set_lanes(sun, lane, own);
        }
    }

    /// Position and velocity at `time`, s.
    #[inline(always)]
    pub fn place(&self, time: R) -> OrbitState<R> {
        let [x, y, z, u, v, w] = value(&self.place, self.fraction(time));
        let position = [x, y, z];
        OrbitState { position, velocity: [u, v, w], distance: norm(position) }
    }

    /// Magnetic field at `time` (s), F_e, T.
    #[inline(always)]
    pub fn field(&self, time: R) -> [R; 3] {
        value(&self.field, self.fraction(time))
    }

    /// The Sun at `time`, s.
    #[inline(always)]
    pub fn sun(&self, time: R) -> Sun<R> {
        let [x, y, z, distance] = value(&self.sun, self.fraction(time));
        Sun { direction: [x, y, z], distance }
    }

    #[inline(always)]
    fn fraction(&self, time: R) -> R {
        (time - self.middle) * self.scale
    }
}

impl Segment<f64> {
    /// Its number: strides before its start.
    pub fn number(&self) -> f64 {
        self.middle.mul_add(self.scale, -1.0)
    }

    /// True if it covers `time`, s.
    pub fn covers(&self, time: f64) -> bool {
        self.fraction(time).abs() <= 1.0
    }
}

/// The polynomials with `coefficients` at `x`.
#[inline(always)]
fn value<R: Real, const C: usize, const T: usize>(coefficients: &[[R; C]; T], x: R) -> [R; C] {
    let mut value = coefficients[T - 1];
    for n in (0..T - 1).rev() {
        for i in 0..C {
            value[i] = value[i].mul_add(x, coefficients[n][i]);
        }
    }
    value
}

/// cos(j (2 k + 1) pi/(2 T)) by j and k.
static COSINES: LazyLock<[[f64; TERMS]; TERMS]> = LazyLock::new(|| {
    let step = core::f64::consts::PI / (2 * TERMS) as f64;
    core::array::from_fn(|j| core::array::from_fn(|k| libm::cos((j * (2 * k + 1) % (4 * TERMS)) as f64 * step)))
});

/// Coefficients, in powers, of the first `T` Chebyshev terms of polynomials, for values at the Chebyshev points.
fn powers<const T: usize>() -> [[f64; TERMS]; T] {
    let mut coefficients = [[0.0; TERMS]; T];
    let (mut before, mut powers) = ([0.0; T], [0.0; T]);
    powers[0] = 1.0;
    for (j, cosines) in COSINES.iter().enumerate().take(T) {
        let share = if j == 0 { 1.0 } else { 2.0 } / TERMS as f64;
        for (coefficients, power) in coefficients.iter_mut().zip(powers) {
            for (coefficient, cosine) in coefficients.iter_mut().zip(cosines) {
                *coefficient = (share * cosine).mul_add(power, *coefficient);
            }
        }
        let mut next = [0.0; T];
        for (n, next) in next.iter_mut().enumerate() {
            let raised = n.checked_sub(1).map_or(0.0, |n| powers[n]);
            *next = if j == 0 { raised } else { 2.0 * raised - before[n] };
        }
        (before, powers) = (powers, next);
    }
    coefficients
}

static POWERS: LazyLock<[[f64; TERMS]; TERMS]> = LazyLock::new(powers);
static POWERS_OF_SUN: LazyLock<[[f64; TERMS]; TERMS_OF_SUN]> = LazyLock::new(powers);

/// Coefficients in powers of the polynomials with `values` at the Chebyshev points.
#[inline(always)]
fn fitted<const C: usize, const T: usize>(values: &[[f64; C]; TERMS], powers: &[[f64; TERMS]; T]) -> [[f64; C]; T] {
    // differences from a value near the middle have smaller rounding errors
    let near = values[TERMS / 2];
    let mut fitted = [[0.0; C]; T];
    fitted[0] = near;
    for (coefficients, powers) in fitted.iter_mut().zip(powers) {
        for (values, power) in values.iter().zip(powers) {
            for i in 0..C {
                coefficients[i] = (values[i] - near[i]).mul_add(*power, coefficients[i]);
            }
        }
    }
    fitted
}

/// Surroundings along an orbit.
#[derive(Clone, Debug)]
pub struct Surroundings {
    path: OrbitPath,
    field: Option<MagneticField<f64>>,
    /// Days from J2000.0 to time zero, if the Sun is needed.
    epoch: Option<f64>,
    /// Stride, s.
    stride: f64,
}

impl Surroundings {
    /// Those along `path`; field, and Sun with the days from J2000.0 to time zero, if needed, else zero.
    pub fn new(path: &OrbitPath, field: Option<MagneticField<f64>>, epoch: Option<f64>) -> Self {
        let longest = HALF_TURN / path.at_start().fastest().max(EARTH_RATE);
        Surroundings { path: path.clone(), field, epoch, stride: longest.exponent().power_of_two() }
    }

    /// Number of the segment that covers `start` to `end`, s, if one does.
    #[inline(always)]
    pub fn covering(&self, start: f64, end: f64) -> Option<f64> {
        let index = (start / self.stride).floor();
        (end <= (index + 2.0) * self.stride).then_some(index)
    }

    /// Segment `index`; a thread keeps the last ones, which runs on one orbit share.
    pub fn segment(&self, index: f64) -> Segment<f64> {
        KNOWN.with_borrow_mut(|known| {
            known.resize_with(MOST_KNOWN, || None);
            let [[x, y, _], _] = self.path.at_start().start();
            let known = &mut known[(x.to_bits() ^ y.to_bits().rotate_left(9) ^ index as u64) as usize % MOST_KNOWN];
            match known {
                Some((of, at, segment)) if *at == index && of.key() == self.key() => *segment,
                _ => {
                    #[cfg(test)]
                    tests::BUILT.set(tests::BUILT.get() + 1);
                    known.insert((self.clone(), index, Isa::best().run_narrow(Fit { of: self, index }))).2
                }
            }
        })
    }

    /// All on which it depends.
    fn key(&self) -> impl PartialEq {
        let start = self.path.at_start();
        (start.start(), start.gravity(), self.field.map(|field| field.numbers()), self.epoch)
    }

    #[inline(always)]
    fn fit<R: Real>(&self, zero: R, index: f64) -> Segment<f64> {
        let middle = (index + 1.0) * self.stride;
        // place and field side by side, filled up to whole vectors
        let mut values = ([[0.0; 12]; TERMS], [[0.0; 4]; TERMS]);
        for first in (0..TERMS).step_by(R::LANES) {
            let mut since = zero;
            for lane in 0..R::LANES {
                since.set_lane(lane, self.stride * COSINES[1][(first + lane).min(TERMS - 1)]);
            }
            let time = zero.splat(middle) + since;
            let place = self.path.states_at([zero.splat(middle), since]);
            // no closures: they may be compiled without vector instructions
            let field = match &self.field {
                Some(field) => field.in_lanes(zero).at(time, place.position),
                None => [zero; 3],
            };
            let Sun { direction, distance } = match self.epoch {
                Some(epoch) => sun_at(zero.splat(epoch), time),
                None => Sun::none(zero),
            };
            for lane in 0..R::LANES.min(TERMS - first) {
                let ([x, y, z], [u, v, w]) = (lane_of(&place.position, lane), lane_of(&place.velocity, lane));
                let [a, b, c] = lane_of(&field, lane);
                values.0[first + lane] = [x, y, z, u, v, w, a, b, c, 0.0, 0.0, 0.0];
                let [x, y, z] = lane_of(&direction, lane);
                values.1[first + lane] = [x, y, z, distance.lane(lane)];
            }
        }
        let (both, sun) = (fitted(&values.0, &POWERS), fitted(&values.1, &POWERS_OF_SUN));
        let mut segment = Segment { middle, scale: 1.0 / self.stride, sun, ..Segment::blank(0.0) };
        for (n, [x, y, z, u, v, w, a, b, c, ..]) in both.into_iter().enumerate() {
            (segment.place[n], segment.field[n]) = ([x, y, z, u, v, w], [a, b, c]);
        }
        segment
    }
}

/// Segments that a thread keeps: two for each lane, for truth and flight software.
const MOST_KNOWN: usize = 64;

type Known = Option<(Surroundings, f64, Segment<f64>)>;

thread_local! {
    static KNOWN: RefCell<Vec<Known>> = const { RefCell::new(Vec::new()) };
}

struct Fit<'a> {
    of: &'a Surroundings,
    index: f64,
}

impl LaneWork for Fit<'_> {
    type Output = Segment<f64>;

    fn run<S: Simd, R: Real + Send + 'static>(self, simd: S, zero: R) -> Segment<f64> {
        simd.vectorize(
            #[inline(always)]
            || self.of.fit(zero, self.index),
        )
    }
}

/// Surroundings of the arcs of a run.
#[derive(Clone, Debug)]
pub struct OfArcs {
    of: Surroundings,
    /// The last segment.
    pub segment: Segment<f64>,
}

impl OfArcs {
    /// Those of `of`.
    pub fn new(of: Surroundings) -> Self {
        OfArcs { of, segment: Segment { scale: f64::NAN, ..Segment::blank(0.0) } }
    }

    /// The segment that covers `arc`, if one does.
    pub fn covering(&mut self, arc: &Arc) -> Option<&Segment<f64>> {
        let number = self.of.covering(arc.start, arc.end())?;
        if self.segment.number() != number {
            self.segment = self.of.segment(number);
        }
        Some(&self.segment)
    }
}

/// Surroundings at one time after another: the last two segments are kept.
#[derive(Clone, Debug)]
pub struct Window {
    of: Surroundings,
    segments: [Option<(f64, Box<Segment<f64>>)>; 2],
}

impl Window {
    /// The surroundings of `scene`, if it has an orbit; the Sun if it shines on plates, as in the equations of motion.
    pub fn of(scene: &Scene) -> Option<Self> {
        let orbit = scene.orbit.as_ref()?;
        let epoch = orbit.epoch.filter(|_| scene.environment.solar_pressure).map(Epoch::days_since_j2000);
        let of = Surroundings::new(&OrbitPath::new(orbit), MagneticField::of(scene), epoch);
        Some(Window { of, segments: [None, None] })
    }

    fn at(&mut self, time: f64) -> &Segment<f64> {
        let index = (time / self.of.stride).floor();
        let kept = &mut self.segments[usize::from(index % 2.0 != 0.0)];
        if kept.as_ref().is_none_or(|(own, _)| *own != index) {
            *kept = None;
        }
        &kept.get_or_insert_with(|| (index, Box::new(self.of.segment(index)))).1
    }

    /// Magnetic field at `time` (s), F_e, T.
    pub fn field(&mut self, time: f64) -> [f64; 3] {
        Isa::best().run(FieldAt(self.at(time), time))
    }
}

struct FieldAt<'a>(&'a Segment<f64>, f64);

impl Work for FieldAt<'_> {
    type Output = [f64; 3];

    #[inline(always)]
    fn run<S: Simd>(self, _simd: S) -> [f64; 3] {
        self.0.field(self.1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Actuation, FieldModel, Orbit};
    use core::cell::Cell;

    thread_local! {
        /// Segments that this thread has built.
        pub static BUILT: Cell<u64> = const { Cell::new(0) };
    }

    const MU: f64 = 3.986004418e14;
    const J2: f64 = 1.08262668e-3;

    /// Low, eccentric (e = 0.74) and geostationary, inclined; the start is the periapsis.
    const ORBITS: [(f64, f64, Option<f64>); 6] = [
        (6.6e6, 0.0, Some(J2)),
        (6.6e6, 0.0, None),
        (6.7e6, 0.74, Some(J2)),
        (6.7e6, 0.74, None),
        (4.2164e7, 0.0, Some(J2)),
        (3e8, 0.3, None),
    ];

    fn surroundings((radius, eccentricity, j2): (f64, f64, Option<f64>)) -> (Surroundings, f64) {
        let speed = (MU * (1.0 + eccentricity) / radius).sqrt();
        let position = [0.6 * radius, 0.8 * radius, 0.0];
        let velocity = [-0.8 * 0.3 * speed, 0.6 * 0.3 * speed, 0.91_f64.sqrt() * speed];
        let epoch = Epoch::parse("2026-11-24T00:00:00Z");
        let orbit = Orbit { mu: MU, position, velocity, body_radius: 6_378_137.0, j2, epoch };
        let epoch = epoch.expect("a date");
        let field = MagneticField::new(FieldModel::Igrf, epoch);
        let axis = radius / (1.0 - eccentricity);
        let period = core::f64::consts::TAU * axis * (axis / MU).sqrt();
        let path = OrbitPath::new(&orbit);
        (Surroundings::new(&path, Some(field), Some(epoch.days_since_j2000())), period)
    }

    /// Law: a segment has position, velocity and field of direct evaluation to 1e-14, and the Sun to the rounding of
    /// its date (1e-12 days), over an orbit and at both ends of segments; any interval of a stride lies in a segment.
    #[test]
    fn series_are_direct_evaluations() {
        for orbit in ORBITS {
            let (around, period) = surroundings(orbit);
            let stride = around.stride;
            let strides = (period / stride).ceil();
            let mut worst = [0.0_f64; 4];
            for part in 0..40 {
                let number = (strides * f64::from(part) / 40.0).floor();
                let segment = around.segment(number);
                for share in [0.0, 1e-9, 0.1, 0.37, 0.5, 0.8, 0.999, 1.0, 1.3, 1.77, 2.0] {
                    let time = (number + share) * stride;
                    let place = around.path.state(time);
                    let field = around.field.map(|field| field.at_point(time, place.position)).expect("a field");
                    let sun = sun_at(around.epoch.expect("a date"), time);
                    let off = |found: [f64; 3], true_one: [f64; 3]| norm(difference(found, true_one)) / norm(true_one);
                    let offs = [
                        off(segment.place(time).position, place.position),
                        off(segment.place(time).velocity, place.velocity),
                        off(segment.field(time), field),
                        off(segment.sun(time).direction, sun.direction),
                    ];
                    for i in 0..4 {
                        worst[i] = worst[i].max(offs[i]);
                    }
                    if share <= 1.0 {
                        let found = around.covering(time, time + stride);
                        assert!(found == Some(number) || (share == 1.0 && found == Some(number + 1.0)), "{found:?}");
                    }
                }
            }
            assert!(worst.iter().zip([1e-14, 1e-14, 1e-14, 1e-13]).all(|(worst, most)| *worst < most), "{worst:?}");
            assert_eq!(around.covering(0.0, 2.01 * stride), None);
        }
    }

    /// The segment in lanes, at a time per lane.
    struct InLanes<'a>(&'a Segment<f64>, [f64; WIDTH]);

    impl LaneWork for InLanes<'_> {
        type Output = Vec<([f64; 3], [f64; 3], [f64; 3])>;

        fn run<S: Simd, R: Real + Send + 'static>(self, simd: S, zero: R) -> Self::Output {
            simd.vectorize(
                #[inline(always)]
                || {
                    let mut segment = Segment::blank(zero);
                    (0..R::LANES).for_each(|lane| segment.set_lane(lane, self.0));
                    let of = |first: usize| {
                        let mut time = zero;
                        (0..R::LANES).for_each(|lane| time.set_lane(lane, self.1[first + lane]));
                        let all = (segment.place(time).position, segment.field(time), segment.sun(time).direction);
                        (0..R::LANES)
                            .map(move |lane| (lane_of(&all.0, lane), lane_of(&all.1, lane), lane_of(&all.2, lane)))
                    };
                    (0..WIDTH).step_by(R::LANES).flat_map(of).collect()
                },
            )
        }
    }

    /// Law: segments and their values have the same bits on every instruction set, and after another window.
    #[test]
    fn the_bits_are_those_of_every_instruction_set() {
        for orbit in ORBITS {
            let (around, period) = surroundings(orbit);
            let number = (0.4 * period / around.stride).floor();
            let bits = |isa: Isa| {
                let segment = isa.run_narrow(Fit { of: &around, index: number });
                let times = core::array::from_fn(|k| (number + 0.25 * k as f64) * around.stride);
                format!("{segment:?} {:?}", isa.run_narrow(InLanes(&segment, times)))
            };
            let first = bits(Isa::best());
            assert!(Isa::available().into_iter().all(|isa| bits(isa) == first) && !first.contains("NaN"));
            let mut window = Window { of: around.clone(), segments: [None, None] };
            let times = [0.0, 1.5, 0.5, 7.0, 2.5, 0.0].map(|strides| strides * around.stride);
            let mut field = |time: f64| window.field(time);
            let found = times.map(&mut field);
            let alone = times.map(|time| around.segment((time / around.stride).floor()).field(time));
            assert!(found == alone && found[0] != found[1]);
        }
    }

    /// Law: runs on one orbit side by side build a segment per stride, however many runs and ticks there are.
    #[test]
    fn runs_on_one_orbit_build_a_segment_once() {
        const STRIDES: u32 = 20;
        let (around, _) = surroundings(ORBITS[0]);
        for (runs, ticks) in [(1, 4), (8, 64)] {
            KNOWN.take();
            let before = BUILT.get();
            let mut runs = vec![OfArcs::new(around.clone()); runs];
            for tick in 0..STRIDES * ticks {
                let at = |tick: u32| around.stride * f64::from(tick) / f64::from(ticks);
                let arc = Arc { start: at(tick), applied: Actuation::none(at(tick + 1)) };
                assert!(runs.iter_mut().all(|run| run.covering(&arc).is_some()));
            }
            assert_eq!(BUILT.get() - before, u64::from(STRIDES));
        }
    }
}
