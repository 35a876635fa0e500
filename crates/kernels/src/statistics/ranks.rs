//! [`Ranks`]: order statistics from the buckets of a sketch.

/// A nonempty bucket.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bucket {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// Cumulative count up to and including this bucket.
    pub up_to: u64,
}

/// Order statistics, each between two bounds.
#[derive(Clone, Debug, PartialEq)]
pub struct Ranks {
    /// Nonempty buckets, ascending.
    pub buckets: Vec<Bucket>,
    count: u64,
}

impl Ranks {
    /// Order statistics from the ends and counts of nonempty buckets, ascending.
    pub fn of(buckets: impl IntoIterator<Item = ([f64; 2], u64)>) -> Self {
        let mut count = 0;
        let bucket = |([low, high], numbers): ([f64; 2], u64)| {
            count += numbers;
            Bucket { low, high, up_to: count }
        };
        let buckets = buckets.into_iter().map(bucket).collect();
        Ranks { buckets, count }
    }

    /// Narrows the buckets to whole numbers; those below 2048 become exact.
    #[must_use]
    pub fn of_whole_numbers(mut self) -> Self {
        for bucket in &mut self.buckets {
            (bucket.low, bucket.high) = (libm::ceil(bucket.low), libm::floor(bucket.high));
        }
        self
    }

    /// Bounds of the order statistic `rank`, from 1, if any.
    pub fn bounds(&self, rank: u64) -> Option<[f64; 2]> {
        let bucket = self.buckets.get(self.buckets.partition_point(|bucket| bucket.up_to < rank))?;
        Some([bucket.low, bucket.high])
    }

    /// Middles of the buckets of the two order statistics around the `p`-quantile of type 7, and the weight of the
    /// second, if any.
    pub fn neighbours(&self, p: f64) -> Option<([f64; 2], f64)> {
        let last = self.count.checked_sub(1)?;
        let place = last as f64 * p;
        let below = (place.floor() as u64).min(last);
        let near = |rank: u64| self.bounds(rank.min(self.count)).map(middle);
        Some(([near(below + 1)?, near(below + 2)?], place - below as f64))
    }

    /// The `p`-quantile of type 7, 0 <= p <= 1, within [`super::sketch::RELATIVE_ERROR`] of the larger neighbour's
    /// magnitude and deviation from the reference.
    pub fn quantile(&self, p: f64) -> Option<f64> {
        let (neighbours, part) = self.neighbours(p)?;
        super::quantile::quantile(&neighbours, part)
    }

    /// Bounds of the count of numbers at most `limit`.
    pub fn at_most(&self, limit: f64) -> [u64; 2] {
        let whole = self.buckets.partition_point(|bucket| bucket.high <= limit);
        let touched = self.buckets.partition_point(|bucket| bucket.low <= limit);
        [whole, touched].map(|buckets| buckets.checked_sub(1).map_or(0, |last| self.buckets[last].up_to))
    }
}

/// Middle of a bucket.
pub fn middle([low, high]: [f64; 2]) -> f64 {
    // halves are added: a difference may overflow, and zero's bucket must give zero
    let middle = 0.5 * low + 0.5 * high;
    if !middle.is_nan() {
        middle
    } else if low.is_nan() {
        high
    } else {
        low
    }
}
