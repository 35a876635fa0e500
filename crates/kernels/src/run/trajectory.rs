//! [`Trajectory`]: integrated components of a run, which a kernel completes to a [`super::StateTable`].

/// Integrated components at the observation points, padded as in a [`super::StateTable`].
#[derive(Clone, Debug)]
pub struct Trajectory {
    components: usize,
    points: usize,
    stride: usize,
    values: Vec<f64>,
}

impl Trajectory {
    /// Zeros.
    pub fn new(components: usize, points: usize) -> Self {
        let stride = points.next_multiple_of(8);
        Trajectory { components, points, stride, values: vec![0.0; components * stride] }
    }

    /// Number of components.
    #[inline]
    pub fn components(&self) -> usize {
        self.components
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

    /// [`Trajectory::column`], writable.
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

    /// Copies the first components of `other`, which has as many points.
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
