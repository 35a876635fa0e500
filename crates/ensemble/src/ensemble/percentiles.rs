//! [`Percentiles`]: quantiles of drawn columns, from sketches beyond [`CHUNK`] samples.

use crate::campaign::Plan;
use crate::ensemble::drawn::{CHUNK, DrawnScenes, magnitudes};
use crate::sampling::SampleId;
use crate::statistics::quantile::quantile;
use crate::statistics::sketch::Sketch;

/// Quantiles of columns, then of [`magnitudes`], without the nominal sample.
#[derive(Clone, Debug)]
pub struct Percentiles {
    count: u64,
    invalid: u64,
    nominal: Vec<f64>,
    columns: HeldColumns,
}

#[derive(Clone, Debug)]
enum HeldColumns {
    Values(Vec<Vec<f64>>),
    /// About the nominal values.
    Sketches(Vec<Sketch>),
}

impl Percentiles {
    pub fn new(plan: &Plan) -> Self {
        let columns = plan.dispersions.columns().iter().map(|column| column.nominal);
        let magnitudes = magnitudes(plan).into_iter().map(|magnitude| magnitude.value(&plan.nominal, &plan.nominal));
        let nominal: Vec<f64> = columns.chain(magnitudes).collect();
        let columns = if plan.samples <= CHUNK {
            HeldColumns::Values(vec![Vec::new(); nominal.len()])
        } else {
            HeldColumns::Sketches(nominal.iter().map(|nominal| Sketch::about(*nominal)).collect())
        };
        Percentiles { count: 0, invalid: 0, nominal, columns }
    }

    pub fn add(&mut self, drawn: &DrawnScenes) {
        self.invalid += drawn.physical.iter().filter(|physical| !**physical).count() as u64;
        let from = usize::from(drawn.first == SampleId(0)).min(drawn.count());
        self.count += (drawn.count() - from) as u64;
        match &mut self.columns {
            HeldColumns::Values(columns) => {
                let new = drawn.columns.iter().chain(&drawn.magnitudes);
                columns.iter_mut().zip(new).for_each(|(held, new)| held.extend(&new[from..]));
            }
            HeldColumns::Sketches(columns) => {
                let new = drawn.columns.iter().chain(&drawn.magnitudes);
                columns.iter_mut().zip(new).for_each(|(sketch, new)| sketch.add_all(&new[from..]));
            }
        }
    }

    pub fn nominal(&self) -> &[f64] {
        &self.nominal
    }

    pub fn count(&self) -> u64 {
        self.count
    }

    /// Unphysical samples, the nominal one included.
    pub fn invalid(&self) -> u64 {
        self.invalid
    }

    /// True if quantiles are exact, or within 0.05% of their distance from nominal
    /// ([`crate::statistics::sketch::RELATIVE_ERROR`]).
    pub fn is_exact(&self) -> bool {
        matches!(self.columns, HeldColumns::Values(_))
    }

    /// Quantiles of each column and magnitude at `p`, of type 7 of R. J. Hyndman & Y. Fan (*Am. Stat.* 50 (1996) 361).
    pub fn quantiles(&self, p: &[f64]) -> Vec<Option<Vec<f64>>> {
        let all = |of: &dyn Fn(f64) -> Option<f64>| p.iter().map(|p| of(*p)).collect();
        match &self.columns {
            HeldColumns::Values(columns) => {
                let sorted = columns.iter().map(|column| {
                    let mut values = column.clone();
                    values.sort_by(f64::total_cmp);
                    values
                });
                sorted.map(|values| all(&|p| quantile(&values, p))).collect()
            }
            HeldColumns::Sketches(columns) => columns.iter().map(|sketch| all(&|p| sketch.quantile(p))).collect(),
        }
    }
}
