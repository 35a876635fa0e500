//! [`precision_figure`]: work-precision diagrams, CPU time against maximum error on logarithmic axes, one panel per
//! error; lower left is better.

use crate::ensemble::precision::{Deviation, Measurement};
use crate::propagation::Method;
use crate::report::figure::{Axis, Dash, Figure, Hue, Mark, PointShape};
use crate::report::figure_files::FigureSheet;

/// Clamps smaller errors: rounding of the observation.
const LEAST_ERROR: f64 = 1e-17;
/// Clamps larger errors: the solution is entirely wrong.
const MOST_ERROR: f64 = 1e1;

type Pick = fn(&Measurement) -> Option<Deviation>;

const PANELS: [(&str, Pick); 4] = [
    ("Angular velocity: maximum relative error", |m| m.rate),
    ("Attitude: maximum error, rad", |m| m.attitude),
    ("Energy balance: maximum relative error", |m| m.energy),
    ("Angular momentum: maximum relative error", |m| m.momentum),
];

/// Run time against error; omits errors that no method has.
pub fn precision_figure(title: String, measured: &[Measurement]) -> FigureSheet {
    let panel = |(title, pick): (&str, Pick)| {
        let marks: Vec<Mark> = Method::ALL
            .into_iter()
            .enumerate()
            .flat_map(|(index, method)| curve(measured, pick, index, method))
            .collect();
        let x = Axis::log("error", "");
        (!marks.is_empty()).then(|| Figure::new(title, x, Axis::log("CPU time of a run", "s"), marks))
    };
    let panels = PANELS.into_iter().filter_map(panel).collect();
    FigureSheet { title, figures: panels }
}

/// The settings of a method as a curve with points, in the same style in all panels.
fn curve(measured: &[Measurement], pick: Pick, index: usize, method: Method) -> Vec<Mark> {
    let of = measured.iter().filter(|measurement| measurement.method == method);
    let found =
        of.filter_map(|m| Some((pick(m)?.max, m.cpu[0]))).filter(|(error, cpu)| error.is_finite() && *cpu > 0.0);
    let (x, y): (Vec<f64>, Vec<f64>) = found.map(|(error, cpu)| (error.clamp(LEAST_ERROR, MOST_ERROR), cpu)).unzip();
    if x.is_empty() {
        return Vec::new();
    }
    let (hue, samples) = (Hue::Curve(index), Vec::new());
    let points =
        Mark::Points { label: String::new(), hue, shape: PointShape::Disc, x: x.clone(), y: y.clone(), samples };
    vec![Mark::line(method.name(), hue, Dash::of_curve(index), x, y), points]
}
