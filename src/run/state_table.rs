//! [`StateTable`]: the physical states of one run at its observation points, component by component.
//!
//! The one thing that stands between integrators and observables. A worker owns and reuses it; a component that nobody asked
//! for is not a row of it. The stride is a multiple of eight, so that eight points are one vector; the padding behind the last
//! point repeats that point.

/// A group of components that is present or absent as a whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(usize)]
pub enum StateField {
    /// omega^se in F_s, rad/s (3).
    Rate,
    /// Attitude quaternion q_es (4).
    Attitude,
    /// Wheel rates alpha-dot, beta-dot, rad/s (2).
    WheelRates,
    /// Wheel angles alpha, beta, rad, unbounded (2).
    WheelAngles,
    /// Position of the spacecraft's centre of mass c in F_e, m (3).
    ComPosition,
    /// Velocity of c in F_e, m/s (3).
    ComVelocity,
    /// Work done since time zero: by the thrusters, by the wheel motors (relative to the fuselage, tau_i Omega_i), J (2).
    Work,
    /// Impulse of the thrusters since time zero in F_e, N s (3).
    Impulse,
    /// Angular impulse of the thrusters about c since time zero in F_e, N m s (3).
    AngularImpulse,
    /// Position of the debris's centre in F_e, m (3).
    DebrisPosition,
    /// Velocity of the debris's centre in F_e, m/s (3).
    DebrisVelocity,
    /// Attitude quaternion q_ed of the debris (4).
    DebrisAttitude,
    /// omega^de of the debris in F_d, rad/s (3).
    DebrisRate,
    /// C_es by columns as the kernel integrates it, where it integrates the DCM itself (9).
    Dcm,
    /// Residuals of the constraints: kinematic, collocation, attitude (27)-(34) (3).
    Residuals,
    /// Kinetic energies of S, W1, W2, D in F_e as a kernel with redundant states has them, 1/2 nu^T M nu (36), J (4).
    KineticEnergies,
}

impl StateField {
    /// All blocks in the order of the table.
    pub const ALL: [StateField; 16] = [
        StateField::Rate,
        StateField::Attitude,
        StateField::WheelRates,
        StateField::WheelAngles,
        StateField::ComPosition,
        StateField::ComVelocity,
        StateField::Work,
        StateField::Impulse,
        StateField::AngularImpulse,
        StateField::DebrisPosition,
        StateField::DebrisVelocity,
        StateField::DebrisAttitude,
        StateField::DebrisRate,
        StateField::Dcm,
        StateField::Residuals,
        StateField::KineticEnergies,
    ];

    /// Number of components.
    pub const fn width(self) -> usize {
        match self {
            StateField::Rate
            | StateField::ComPosition
            | StateField::ComVelocity
            | StateField::Impulse
            | StateField::AngularImpulse
            | StateField::DebrisPosition
            | StateField::DebrisVelocity
            | StateField::DebrisRate
            | StateField::Residuals => 3,
            StateField::Attitude | StateField::DebrisAttitude | StateField::KineticEnergies => 4,
            StateField::WheelRates | StateField::WheelAngles | StateField::Work => 2,
            StateField::Dcm => 9,
        }
    }
}

/// A set of blocks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct StateFields(u32);

impl StateFields {
    /// No block.
    pub const NONE: StateFields = StateFields(0);

    /// This set and one more block.
    #[must_use]
    pub const fn with(self, block: StateField) -> Self {
        StateFields(self.0 | 1 << block as usize)
    }

    /// The union of two sets.
    #[must_use]
    pub const fn union(self, other: Self) -> Self {
        StateFields(self.0 | other.0)
    }

    /// Whether the set holds `block`.
    pub const fn contains(self, block: StateField) -> bool {
        self.0 & (1 << block as usize) != 0
    }
}

/// States at the observation points: component by component, eight points to a vector.
#[derive(Clone, Debug)]
pub struct StateTable {
    blocks: StateFields,
    points: usize,
    stride: usize,
    offsets: [usize; StateField::ALL.len()],
    values: Vec<f64>,
}

impl StateTable {
    /// A table of `points` >= 1 observation points that holds `blocks`; all zero.
    pub fn new(blocks: StateFields, points: usize) -> Self {
        let stride = points.next_multiple_of(8);
        let mut offsets = [usize::MAX; StateField::ALL.len()];
        let mut components = 0;
        for block in StateField::ALL {
            if blocks.contains(block) {
                offsets[block as usize] = components;
                components += block.width();
            }
        }
        StateTable { blocks, points, stride, offsets, values: vec![0.0; components * stride] }
    }

    /// What the table holds.
    pub fn blocks(&self) -> StateFields {
        self.blocks
    }

    /// Number of observation points.
    pub fn points(&self) -> usize {
        self.points
    }

    /// Number of points with padding, a multiple of eight.
    pub fn stride(&self) -> usize {
        self.stride
    }

    /// Whether the table holds `block`.
    pub fn has(&self, block: StateField) -> bool {
        self.blocks.contains(block)
    }

    /// Component `component` of `block` at all points (with padding).
    ///
    /// # Panics
    /// Where the table does not hold the block.
    #[inline]
    pub fn column(&self, block: StateField, component: usize) -> &[f64] {
        debug_assert!(self.has(block) && component < block.width());
        let start = (self.offsets[block as usize] + component) * self.stride;
        &self.values[start..start + self.stride]
    }

    /// The same, to write.
    ///
    /// # Panics
    /// Where the table does not hold the block.
    #[inline]
    pub fn column_mut(&mut self, block: StateField, component: usize) -> &mut [f64] {
        debug_assert!(self.has(block) && component < block.width());
        let start = (self.offsets[block as usize] + component) * self.stride;
        &mut self.values[start..start + self.stride]
    }

    /// The components of `block` at point `point`.
    pub fn at<const N: usize>(&self, block: StateField, point: usize) -> [f64; N] {
        std::array::from_fn(|component| self.column(block, component)[point])
    }

    /// Writes the components of `block` at point `point`.
    pub fn set<const N: usize>(&mut self, block: StateField, point: usize, values: [f64; N]) {
        for (component, value) in values.into_iter().enumerate() {
            self.column_mut(block, component)[point] = value;
        }
    }

    /// Fills the padding of every component with its last point.
    pub fn pad(&mut self) {
        let (points, stride) = (self.points, self.stride);
        for component in self.values.chunks_exact_mut(stride) {
            let last = component[points - 1];
            component[points..].fill(last);
        }
    }
}

/// The components that a method integrates, of one run at its observation points, component by component.
///
/// What a kernel completes to a [`StateTable`]; which component is what, the kernel says.
#[derive(Clone, Debug)]
pub struct Trajectory {
    points: usize,
    stride: usize,
    values: Vec<f64>,
}

impl Trajectory {
    /// `components` components at `points` points; all zero.
    pub fn new(components: usize, points: usize) -> Self {
        let stride = points.next_multiple_of(8);
        Trajectory { points, stride, values: vec![0.0; components * stride] }
    }

    /// Number of observation points.
    pub fn points(&self) -> usize {
        self.points
    }

    /// Number of points with padding, a multiple of eight.
    pub fn stride(&self) -> usize {
        self.stride
    }

    /// Component `component` at all points (with padding).
    #[inline]
    pub fn column(&self, component: usize) -> &[f64] {
        &self.values[component * self.stride..(component + 1) * self.stride]
    }

    /// The same, to write.
    #[inline]
    pub fn column_mut(&mut self, component: usize) -> &mut [f64] {
        &mut self.values[component * self.stride..(component + 1) * self.stride]
    }

    /// Writes all components at point `point`.
    #[inline]
    pub fn set<const N: usize>(&mut self, point: usize, state: &[f64; N]) {
        for (component, value) in state.iter().enumerate() {
            self.values[component * self.stride + point] = *value;
        }
    }

    /// Fills the padding of every component with its last point.
    pub fn pad(&mut self) {
        let (points, stride) = (self.points, self.stride);
        for component in self.values.chunks_exact_mut(stride) {
            let last = component[points - 1];
            component[points..].fill(last);
        }
    }

    /// Takes the values of the first components of `other`, which has as many points.
    pub fn copy_from(&mut self, other: &Trajectory) {
        let length = self.values.len();
        self.values.copy_from_slice(&other.values[..length]);
    }

    /// Fills every component from point `point` on with `value`.
    pub fn fill_after(&mut self, point: usize, value: f64) {
        for component in self.values.chunks_exact_mut(self.stride) {
            component[point..].fill(value);
        }
    }

    /// All components at point `point`.
    pub fn at<const N: usize>(&self, point: usize) -> [f64; N] {
        std::array::from_fn(|component| self.values[component * self.stride + point])
    }
}

/// The times at which a run is observed, s: ascending, the first is zero, the last the duration.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    times: Vec<f64>,
    padded: Vec<f64>,
}

impl Grid {
    /// `points` >= 2 times from zero to `duration` at equal distances.
    pub fn uniform(duration: f64, points: usize) -> Self {
        let last = (points - 1) as f64;
        Self::at((0..points).map(|k| if k + 1 == points { duration } else { duration * (k as f64 / last) }).collect())
    }

    /// The given times: ascending, the first zero.
    pub fn at(times: Vec<f64>) -> Self {
        let mut padded = times.clone();
        let last = *times.last().expect("a grid has at least one time");
        padded.resize(times.len().next_multiple_of(8), last);
        Grid { times, padded }
    }

    /// The times, s.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// The times with padding, as the columns of a [`StateTable`] have it.
    pub fn padded_times(&self) -> &[f64] {
        &self.padded
    }

    /// Number of times.
    pub fn points(&self) -> usize {
        self.times.len()
    }

    /// The last time, s.
    pub fn duration(&self) -> f64 {
        *self.times.last().expect("a grid has at least one time")
    }
}
