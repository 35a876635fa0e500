//! Components of states over time, in plots of one run.

use crate::report::figure::{Axis, Dash, Figure, Hue, Mark};
use crate::report::over_time::curves::{Curves, over_time};
use crate::report::over_time::figure_list::ListedFigure;
use crate::run::StateField;

impl Curves<'_> {
    /// The `components` of `field`, or all wheels. Components that are always zero, as of missing parts, get no curve.
    pub(super) fn state(&self, listed: &ListedFigure, field: StateField, components: &[&str]) -> Figure {
        let wheels = self.wheels.iter().enumerate().map(|(wheel, name)| (name.to_string(), Hue::Wheel(wheel)));
        let named = components.iter().enumerate().map(|(index, name)| ((*name).to_owned(), Hue::Curve(index)));
        let named: Vec<(String, Hue)> = if components.is_empty() { wheels.collect() } else { named.collect() };
        let times = self.times();
        let curve = |(index, (name, hue)): (usize, (String, Hue))| {
            let values = self.run?.table.column(field, index)[..times.len()].to_vec();
            let is_absent = !components.is_empty() && values.iter().all(|value| *value == 0.0);
            let dash = Dash::of_curve(index);
            (!is_absent).then(|| Mark::line(name, hue, dash, times.clone(), values))
        };
        let marks = named.into_iter().enumerate().filter_map(curve).collect();
        let unit = match field {
            StateField::Rate | StateField::DebrisRate | StateField::WheelRates => "rad/s",
            _ => "",
        };
        let wheel = self.wheels.first().filter(|_| field == StateField::WheelRates);
        let shows = wheel.map_or_else(String::new, |wheel| format!("rate_{wheel}_rad_s"));
        let axis = Axis::linear(listed.quantity, unit).showing(shows);
        over_time("", listed.title, String::new(), axis, marks)
    }
}
