//! A [`Figure`] as JSON for `assets/report/chart.js`; its numbers go to the payload.

use serde_json::{Value, json};

use crate::report::figure::{Axis, Figure, Hue, Mark, PointShape, Scale};
use crate::report::page::payload::Payload;

const BAR: f64 = 0.55;

/// Bars of violating runs stand in front of all runs and are opaque.
fn bar_opacity(hue: Hue) -> f64 {
    if hue == Hue::Failed { 1.0 } else { BAR }
}

pub(in crate::report) fn json_of(figure: &Figure, payload: &mut Payload) -> Value {
    let marks: Vec<Value> = figure.marks.iter().map(|one| mark(one, payload)).collect();
    json!({
        "name": figure.name, "section": figure.section.anchor(), "title": figure.title, "caption": figure.caption,
        "columns": figure.columns, "time": figure.is_over_time, "x": axis(&figure.x), "y": axis(&figure.y),
            "marks": marks
    })
}

fn axis(axis: &Axis) -> Value {
    let names = if let Scale::Names(names) = &axis.scale { Some(names) } else { None };
    let log = axis.scale == Scale::Log;
    let mut drawn =
        json!({ "quantity": axis.quantity, "unit": axis.unit, "log": log, "names": names, "range": axis.range });
    if let Some(step) = axis.step {
        drawn["step"] = json!(step);
    }
    drawn
}

fn mark(mark: &Mark, payload: &mut Payload) -> Value {
    let mut array = |values: &[f64]| payload.array(values);
    match mark {
        Mark::Line { label, hue, dash, x, y } => json!({
            "kind": "line", "label": label, "hue": hue.place(), "dash": dash.lengths(), "x": array(x), "y": array(y)
        }),
        Mark::Band { label, hue, opacity, x, low, high, stacked } => json!({
            "kind": "band", "label": label, "hue": hue.place(), "opacity": opacity, "stacked": stacked,
            "x": array(x), "low": array(low), "high": array(high)
        }),
        Mark::Points { label, hue, shape, x, y, samples } => json!({
            "kind": "points", "label": label, "hue": hue.place(), "crosses": *shape == PointShape::Cross,
            "stems": *shape == PointShape::Stem,
            "x": array(x), "y": array(y), "samples": array(samples)
        }),
        Mark::Bars { label, hue, edges, heights } => json!({
            "kind": "bars", "label": label, "hue": hue.place(), "opacity": bar_opacity(*hue), "edges": array(edges),
                "heights": array(heights)
        }),
        Mark::Whiskers { label, hue, x, low, high } => json!({
            "kind": "whiskers", "label": label, "hue": hue.place(), "x": array(x), "low": array(low),
                "high": array(high)
        }),
        Mark::Limit { label, at, vertical } => {
            json!({ "kind": "limit", "label": label, "at": at, "vertical": vertical })
        }
        Mark::Flight { label, x, counts, runs } => json!({
            "kind": "flight", "label": label, "hue": Hue::Reference.place(), "opacity": 0.55, "runs": runs,
            "x": array(x), "counts": array(counts)
        }),
        Mark::Matrix { values } => {
            json!({ "kind": "matrix", "label": "correlation", "hue": 0, "values": array(values) })
        }
    }
}
