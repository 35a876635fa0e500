//! [`Reduction`]: kinds of numbers from a series, by the pass over it (`reduce`). A statistic without a computation
//! does not compile.

listed! {
    /// A statistic that is one of the values: a function of the values may be applied to it afterwards.
    pub enum OrderStatistic {
        /// First value.
        Initial,
        /// Last value.
        Final,
        /// Maximum.
        Max,
    }
}

listed! {
    /// A statistic of values.
    pub enum ValueStatistic {
        /// First value.
        Initial,
        /// Last value.
        Final,
        /// Minimum.
        Min,
        /// Maximum.
        Max,
        /// Mean over the points.
        Mean,
        /// Maximum minus minimum.
        PeakToPeak,
        /// Last minus first value.
        Net,
    }
}

listed! {
    /// A statistic of an error.
    pub enum ErrorStatistic {
        /// Maximum magnitude.
        Max,
        /// Last value.
        Final,
        /// Root mean square over the points.
        Rms,
        /// Slope of the least-squares line through e(t), per second.
        Slope,
    }
}

listed! {
    /// A statistic of the changes from point to point.
    pub enum ChangeStatistic {
        /// Sum of |dx|.
        Gross,
        /// Maximum of |dx/dt|.
        Power,
    }
}

/// A number from a series.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reduction {
    /// Initial value, final value and maximum.
    Order(OrderStatistic),
    /// Values, extremes and mean.
    Value(ValueStatistic),
    /// Maximum minus minimum, relative to the largest total kinetic energy about the centre of mass.
    Fraction,
    /// Magnitude and slope of an error.
    Error(ErrorStatistic),
    /// Changes from point to point.
    Change(ChangeStatistic),
}

impl Reduction {
    pub(super) const VALUE: usize = OrderStatistic::ALL.len();
    pub(super) const ERROR: usize = Self::VALUE + ValueStatistic::ALL.len();
    pub(super) const CHANGE: usize = Self::ERROR + ErrorStatistic::ALL.len();
    pub(super) const FRACTION: usize = Self::CHANGE + ChangeStatistic::ALL.len();

    pub(super) const COUNT: usize = Self::FRACTION + 1;

    pub(super) const fn index(self) -> usize {
        match self {
            Reduction::Order(statistic) => statistic as usize,
            Reduction::Value(statistic) => Self::VALUE + statistic as usize,
            Reduction::Fraction => Self::FRACTION,
            Reduction::Error(statistic) => Self::ERROR + statistic as usize,
            Reduction::Change(statistic) => Self::CHANGE + statistic as usize,
        }
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Passes {
    /// By statistic, since each may need an elementary function.
    pub(super) order: [bool; OrderStatistic::ALL.len()],
    pub(super) value: bool,
    pub(super) error: bool,
    pub(super) change: bool,
}

impl Passes {
    #[must_use]
    pub(super) const fn with(mut self, reduction: Reduction) -> Self {
        match reduction {
            Reduction::Order(statistic) => self.order[statistic as usize] = true,
            Reduction::Value(_) | Reduction::Fraction => self.value = true,
            Reduction::Error(_) => self.error = true,
            Reduction::Change(_) => self.change = true,
        }
        self
    }
}

/// Stored form of a series: a monotone function of the quantity, cheap at every point, whose inverse is applied to
/// order statistics and time series.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stored {
    Quantity,
    Square,
    /// Square of the tangent of half the angle.
    HalfTangentSquare,
}

impl Stored {
    /// Quantity of a stored number.
    #[inline]
    pub(super) fn shown(self, stored: f64) -> f64 {
        match self {
            Stored::Quantity => stored,
            Stored::Square => stored.sqrt(),
            Stored::HalfTangentSquare => 2.0 * libm::atan(stored.sqrt()),
        }
    }
}
