//! The ground track, in sunlight and in shadow.

use crate::ensemble::surroundings::{self, Surroundings};
use crate::report::figure::{Axis, Figure, FigureSection, Hue, Mark, PointShape};
use crate::report::over_time::curves::Curves;
use crate::report::over_time::figure_list::ListedFigure;
use crate::run::StateField;

/// Rounding of coordinates, deg, to save space on the page.
const UNIT: f64 = 1.0 / 1024.0;

impl Curves<'_> {
    /// A dot for each point of the run; `None` without a dated orbit.
    pub(super) fn ground_track(&self, listed: &ListedFigure) -> Option<Figure> {
        let (run, times) = (self.run?, self.times());
        let (around, hidden) = (Surroundings::of(&run.scene)?, surroundings::hidden(run, times.len())?);
        let below = |point: usize| around.below(times[point], run.table.at(StateField::ComPosition, point));
        let places: Vec<[f64; 2]> = (0..times.len()).map(below).collect::<Option<_>>()?;
        let dots = |label: &str, hue, shown: Vec<usize>| {
            let along =
                |axis: usize| shown.iter().map(|point| UNIT * libm::round(places[*point][axis] / UNIT)).collect();
            Mark::points(label, (hue, PointShape::Disc), along(0), along(1))
        };
        let part = |is_dark: bool| (0..times.len()).filter(|point| (hidden[*point] > 0.0) == is_dark).collect();
        let marks = vec![
            dots("in sunlight", listed.hue, part(false)),
            dots("in shadow", Hue::Reference, part(true)),
            dots("start", Hue::Nominal, vec![0]),
        ];
        let caption = "Nominal run: the place below each of its points, by geocentric latitude; in shadow, the Earth \
             hides a part of the Sun.";
        let axes = [Axis::of_globe("longitude", 180.0), Axis::of_globe(listed.quantity, 90.0)];
        Some(Figure::of(FigureSection::Time, ["ground_track", listed.title, caption], axes, marks))
    }
}
