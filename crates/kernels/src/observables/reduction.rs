//! [`Reduction`]: kinds of numbers from a series.
//!
//! One variant per pass over a series. A pass has a value for every statistic of its list by an exhaustive `match`, so
//! that an uncomputed statistic does not compile. The passes are in `reduce`.

macro_rules! statistics {
    ($(#[$doc:meta])* $name:ident { $($(#[$of:meta])* $variant:ident,)* }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[repr(usize)]
        pub enum $name {
            $($(#[$of])* $variant,)*
        }

        impl $name {
            /// Every statistic.
            pub(super) const ALL: &[$name] = &[$($name::$variant),*];
        }
    };
}

statistics! {
    /// A statistic that is one of the values: cheap, and a function of the values may be applied to it afterwards.
    OrderStatistic {
        /// The first value.
        Initial,
        /// The last value.
        Final,
        /// The maximum.
        Max,
    }
}

statistics! {
    /// A statistic of values.
    ValueStatistic {
        /// The first value.
        Initial,
        /// The last value.
        Final,
        /// The minimum.
        Min,
        /// The maximum.
        Max,
        /// The mean over the points.
        Mean,
        /// Maximum minus minimum.
        PeakToPeak,
        /// Last minus first value.
        Net,
    }
}

statistics! {
    /// A statistic of an error.
    ErrorStatistic {
        /// The maximum magnitude.
        Max,
        /// The last value.
        Final,
        /// The root mean square over the points.
        Rms,
        /// The slope of the least-squares line through e(t), per second.
        Slope,
    }
}

statistics! {
    /// A statistic of the changes from point to point.
    ChangeStatistic {
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
    const VALUE: usize = OrderStatistic::ALL.len();
    const ERROR: usize = Self::VALUE + ValueStatistic::ALL.len();
    const CHANGE: usize = Self::ERROR + ErrorStatistic::ALL.len();
    const FRACTION: usize = Self::CHANGE + ChangeStatistic::ALL.len();

    /// Number of values per series from [`reduce`].
    pub(super) const COUNT: usize = Self::FRACTION + 1;

    /// Index of the value in the output of [`reduce`].
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

/// A set of order statistics, each of which may need an elementary function.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct OrderStatistics(u8);

impl OrderStatistics {
    const fn with(self, statistic: OrderStatistic) -> Self {
        OrderStatistics(self.0 | 1 << statistic as u8)
    }

    pub(super) const fn has(self, statistic: OrderStatistic) -> bool {
        self.0 & (1 << statistic as u8) != 0
    }

    pub(super) const fn has_any(self) -> bool {
        self.0 != 0
    }
}

/// Passes over a series required by its reductions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Passes {
    pub(super) order: OrderStatistics,
    pub(super) value: bool,
    pub(super) error: bool,
    pub(super) change: bool,
}

impl Passes {
    #[must_use]
    pub(super) const fn with(mut self, reduction: Reduction) -> Self {
        match reduction {
            Reduction::Order(statistic) => self.order = self.order.with(statistic),
            Reduction::Value(_) | Reduction::Fraction => self.value = true,
            Reduction::Error(_) => self.error = true,
            Reduction::Change(_) => self.change = true,
        }
        self
    }
}

/// Stored form of a series: a monotone function of the quantity that is cheap at every point.
///
/// Its inverse is applied to order statistics and time series. Means, changes and errors would be those of the stored
/// numbers: the table has none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stored {
    /// The quantity itself.
    Quantity,
    /// Its square.
    Square,
    /// Square of the tangent of half the angle.
    HalfTangentSquare,
}

impl Stored {
    /// The quantity of a stored number.
    #[inline]
    pub(super) fn shown(self, stored: f64) -> f64 {
        match self {
            Stored::Quantity => stored,
            Stored::Square => stored.sqrt(),
            Stored::HalfTangentSquare => 2.0 * libm::atan(stored.sqrt()),
        }
    }
}
