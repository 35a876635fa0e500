//! [`Reduction`]: how a series becomes a number.
//!
//! The reductions that one pass over a series yields together are one variant of [`Reduction`]. Each pass gives a value
//! for every statistic of its list by an exhaustive `match`: a reduction that nothing computes does not compile.
//!
//! Not here: the passes (`reduce`).

/// An enum with the list and the number of its variants.
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
    /// A statistic that is one of the values: cheap, and the same function of the values may be applied to it
    /// afterwards.
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

/// How a series becomes a number.
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

    /// Number of values that [`reduce`] writes for a series.
    pub(super) const COUNT: usize = Self::FRACTION + 1;

    /// The index of the value among those that [`reduce`] writes.
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

/// A set of order statistics: what is shown of them may need an elementary function each.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct OrderStatistics(u8);

impl OrderStatistics {
    const fn with(self, statistic: OrderStatistic) -> Self {
        OrderStatistics(self.0 | 1 << statistic as u8)
    }

    /// Whether the set contains `statistic`.
    pub(super) const fn has(self, statistic: OrderStatistic) -> bool {
        self.0 & (1 << statistic as u8) != 0
    }

    /// Whether the set contains any statistic.
    pub(super) const fn has_any(self) -> bool {
        self.0 != 0
    }
}

/// The passes over a series that its reductions need.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Passes {
    pub(super) order: OrderStatistics,
    pub(super) value: bool,
    pub(super) error: bool,
    pub(super) change: bool,
}

impl Passes {
    /// These passes and the one that `reduction` needs.
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

/// What a series stores of the quantity that is shown: a monotone function that is cheap to compute at every point.
///
/// Its inverse is applied to the order statistics and to the time series. Means, changes and errors of such a series
/// would be those of the stored numbers: the table has none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stored {
    /// The quantity itself.
    Quantity,
    /// Its square.
    Square,
    /// The square of the tangent of half the angle that is shown.
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
