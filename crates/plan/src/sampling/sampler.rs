//! [`Sampler`]: draws samples of [`Dispersions`] into scenes, in blocks of eight.
//!
//! Recorded values are read back from the scene after quaternions are renormalised. An unphysical draw is not repeated;
//! the scene refuses it later.

use super::design::{BLOCK, PointSource};
use super::dispersions::{Assigned, Dispersions, Transform};
use super::distribution::Joint;
use super::distribution::traits::MAX_DIMENSIONS;
use super::stream::SampleId;
use crate::scene::parameter::Shape;
use crate::scene::{Parameter, SceneInput};

/// The memory of one worker; a draw depends on the sample alone.
#[derive(Debug)]
pub struct Sampler<'a> {
    dispersions: &'a Dispersions,
    points: Box<dyn PointSource>,
    block: Option<u64>,
    u: Vec<[f64; BLOCK]>,
    /// Dimensions at nominal values, in one-at-a-time designs.
    nominal: Vec<[bool; BLOCK]>,
    /// Arbitrary for dimensions without a copula.
    scores: Vec<[f64; BLOCK]>,
    correlated: Vec<bool>,
    values: Vec<[f64; BLOCK]>,
    together: Vec<f64>,
    normalised: Vec<Parameter>,
    /// Quaternions that a file gives as a whole: recorded values keep their bits.
    recorded: Vec<Parameter>,
}

impl Dispersions {
    /// Allocates; drawing does not.
    pub fn sampler(&self) -> Sampler<'_> {
        let (dimensions, columns) = (self.dimensions.len(), self.columns());
        let normalised: Vec<Parameter> = columns
            .iter()
            .filter(|column| column.component == 0 && column.parameter.shape() == Shape::Quaternion)
            .map(|column| column.parameter)
            .collect();
        let is_row = |column| matches!(self.distribution_of(column), Some(Transform::Joint(Joint::Bootstrap(_))));
        let of_files = |parameter: &Parameter| {
            let of_file = |index: &usize| self.is_tabled(*index) || is_row(*index);
            (0..columns.len()).filter(|index| columns[*index].parameter == *parameter).filter(of_file).count()
        };
        let mut correlated = vec![false; dimensions];
        self.copulas.iter().flat_map(|copula| &copula.dimensions).for_each(|dimension| correlated[*dimension] = true);
        Sampler {
            dispersions: self,
            points: self.points(),
            block: None,
            u: vec![[0.5; BLOCK]; dimensions],
            nominal: vec![[false; BLOCK]; dimensions],
            scores: vec![[0.0; BLOCK]; dimensions],
            correlated,
            // columns without a distribution keep their nominal value
            values: columns.iter().map(|column| [column.nominal; BLOCK]).collect(),
            together: vec![0.0; self.assigned.iter().map(|assigned| assigned.columns.len()).max().unwrap_or(0)],
            recorded: normalised.iter().copied().filter(|one| of_files(one) == one.width()).collect(),
            normalised,
        }
    }
}

impl Sampler<'_> {
    /// Writes the dispersed numbers of `sample` into `scene`, a copy of the nominal scene or of an earlier draw, and
    /// the applied values, one a column. Sample 0 is nominal.
    ///
    /// # Panics
    /// If `applied` is not as long as [`Dispersions::columns`].
    pub fn draw(&mut self, sample: SampleId, scene: &mut SceneInput, applied: &mut [f64]) {
        let columns = self.dispersions.columns();
        assert_eq!(applied.len(), columns.len(), "one applied value a column");
        if sample == SampleId(0) {
            for (column, applied) in columns.iter().zip(&mut *applied) {
                column.parameter.set(scene, column.component, column.nominal);
                *applied = column.nominal;
            }
            self.normalised.iter().for_each(|parameter| parameter.normalise_written(scene));
            self.read_back(scene, applied);
            return;
        }
        let (block, lane) = (sample.0 / BLOCK as u64, (sample.0 % BLOCK as u64) as usize);
        if self.block != Some(block) {
            self.fill(block);
        }
        for ((column, values), applied) in columns.iter().zip(&self.values).zip(&mut *applied) {
            column.parameter.set(scene, column.component, values[lane]);
            *applied = values[lane];
        }
        for parameter in &self.normalised {
            if !(self.recorded.contains(parameter) && parameter.is_unit(scene)) {
                parameter.normalise(scene);
            }
        }
        self.read_back(scene, applied);
    }

    fn read_back(&self, scene: &SceneInput, applied: &mut [f64]) {
        for parameter in &self.normalised {
            let columns = self.dispersions.columns().iter();
            for (applied, column) in applied.iter_mut().zip(columns).filter(|(_, c)| c.parameter == *parameter) {
                *applied = parameter.value(scene, column.component).unwrap_or(f64::NAN);
            }
        }
    }

    fn fill(&mut self, block: u64) {
        self.points.fill(block, &mut self.u);
        let some_stay = self.dispersions.design().facts().leaves_nominal;
        if some_stay {
            self.note_nominals();
        }
        for copula in &self.dispersions.copulas {
            copula.apply(&mut self.u, &mut self.scores);
        }
        for assigned in &self.dispersions.assigned {
            let first = assigned.first;
            match &assigned.map {
                Transform::Scalar(distribution) if distribution.dimensions() == 0 => {
                    self.values[assigned.columns[0]] = [distribution.quantile(0.5); BLOCK];
                }
                Transform::Scalar(distribution) => {
                    let values = &mut self.values[assigned.columns[0]];
                    match self.correlated[first].then(|| distribution.of_scores(&self.scores[first], values)) {
                        Some(true) => {}
                        _ => distribution.quantiles(&self.u[first], values),
                    }
                }
                Transform::Joint(joint) => self.draw_joint(assigned, joint),
            }
        }
        if some_stay {
            self.keep_nominals();
        }
        for (column, rows) in &self.dispersions.tabled {
            for (lane, value) in self.values[*column].iter_mut().enumerate() {
                let row = (block * BLOCK as u64 + lane as u64).checked_sub(1).and_then(|row| usize::try_from(row).ok());
                // no sample exists beyond the last row: the scene refuses NaN
                *value = row.and_then(|row| rows.get(row).copied()).unwrap_or(f64::NAN);
            }
        }
        for derived in &self.dispersions.derived {
            for lane in 0..BLOCK {
                let value = derived.value(|column| self.values[column][lane]);
                self.values[derived.column][lane] = value;
            }
        }
        self.block = Some(block);
    }

    fn draw_joint(&mut self, assigned: &Assigned, joint: &Joint) {
        let dimensions = joint.dimensions();
        let mut u = [0.0; MAX_DIMENSIONS];
        for lane in 0..BLOCK {
            for (u, block) in u.iter_mut().zip(&self.u[assigned.first..assigned.first + dimensions]) {
                *u = block[lane];
            }
            joint.values(&u[..dimensions], &mut self.together);
            for (column, value) in assigned.columns.iter().zip(&self.together) {
                self.values[*column][lane] = *value;
            }
        }
    }

    /// Marks dimensions at their nominal value and sets them to the median, which the other dimensions of a joint
    /// distribution keep.
    fn note_nominals(&mut self) {
        for (u, nominal) in self.u.iter_mut().zip(&mut self.nominal) {
            for (u, nominal) in u.iter_mut().zip(nominal) {
                *nominal = u.is_nan();
                if *nominal {
                    *u = 0.5;
                }
            }
        }
    }

    /// Restores nominal values if no dimension of a distribution varies.
    fn keep_nominals(&mut self) {
        for assigned in self.dispersions.assigned.iter().filter(|assigned| assigned.map.dimensions() > 0) {
            let dimensions = assigned.first..assigned.first + assigned.map.dimensions();
            for lane in 0..BLOCK {
                if self.nominal[dimensions.clone()].iter().all(|nominal| nominal[lane]) {
                    for column in &assigned.columns {
                        self.values[*column][lane] = self.dispersions.columns()[*column].nominal;
                    }
                }
            }
        }
    }
}
