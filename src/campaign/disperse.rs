//! The keys of a `[[disperse]]` table.
//!
//! Here is only how a law is written; whether it can be drawn for a scene, [`crate::sampling::Dispersions`] says.

use super::document::Section;
use super::problem::nearest;
use crate::sampling::{Cut, Dispersion, Law, Range, Spread, Values};
use crate::scene::Parameter;

/// The names of the laws.
pub const DISTRIBUTIONS: [&str; 4] = ["normal", "truncated_normal", "uniform", "uniform_attitude"];

/// Which law a table asks for.
#[derive(Clone, Copy)]
enum Family {
    Normal,
    TruncatedNormal,
    Uniform,
    UniformAttitude,
}

/// Reads one table; `None` where something is wrong, which is then noted.
pub fn read(table: &mut Section<'_, '_>) -> Option<Dispersion> {
    table.require("parameter", "a numeric key of scene or initial state", "\"fuselage.density_kg_m3\"");
    let target = table.text("parameter").and_then(|name| {
        let found = Parameter::find(name);
        if found.is_none() {
            let remedy = match nearest(name, Parameter::all().map(Parameter::name)) {
                Some(meant) => format!("did you mean {meant:?}?"),
                None => "write table and key as in this file, \"wheel1.radius_m\"".to_owned(),
            };
            let allowed = "a numeric key of scene or initial state, as a whole or with a component ([0] or .x)";
            table.refuse("parameter", allowed, remedy);
        }
        found
    });
    table.require("distribution", &format!("one of {}", DISTRIBUTIONS.join(", ")), "\"normal\"");
    let family = table.name("distribution", &DISTRIBUTIONS, |name| match name {
        "normal" => Some(Family::Normal),
        "truncated_normal" => Some(Family::TruncatedNormal),
        "uniform" => Some(Family::Uniform),
        "uniform_attitude" => Some(Family::UniformAttitude),
        _ => None,
    });
    let law = match family {
        Some(Family::Normal) => spread(table).map(Law::Normal),
        Some(Family::TruncatedNormal) => {
            let (spread, cut) = (spread(table), cut(table));
            spread.zip(cut).map(|(spread, cut)| Law::TruncatedNormal(spread, cut))
        }
        Some(Family::Uniform) => range(table).map(Law::Uniform),
        Some(Family::UniformAttitude) => Some(Law::UniformAttitude),
        // Which other keys belong here, nobody can say.
        None => return None,
    };
    table.finish();
    let ((parameter, component), law) = target.zip(law)?;
    Some(Dispersion { parameter, component, law })
}

/// Notes that of `keys` not exactly one was written, where that is so.
fn is_one_of(table: &mut Section<'_, '_>, keys: &[&'static str], example: &str) -> bool {
    let written: Vec<&'static str> = keys.iter().copied().filter(|key| table.has(key)).collect();
    match written[..] {
        [_] => true,
        [] => {
            table.require(keys[0], &format!("given ({})", keys.join(" or ")), example);
            false
        }
        [_, second, ..] => {
            table.refuse(second, format!("the only one of {}", keys.join(", ")), "delete all but one of them");
            false
        }
    }
}

fn spread(table: &mut Section<'_, '_>) -> Option<Spread> {
    let one = is_one_of(table, &["std", "relative_std"], "0.1");
    let (absolute, relative) = (table.values("std"), table.values("relative_std"));
    if one { absolute.map(Spread::Absolute).or(relative.map(Spread::Relative)) } else { None }
}

fn cut(table: &mut Section<'_, '_>) -> Option<Cut> {
    let bounds = if table.has("upper") && !table.has("lower") { "upper" } else { "lower" };
    let one = is_one_of(table, &["sigmas", bounds], "3");
    let wrong = |table: &Section<'_, '_>, key, values: &Option<Values>| table.has(key) && values.is_none();
    let (sigmas, lower, upper) = (table.values("sigmas"), table.values("lower"), table.values("upper"));
    if !one || wrong(table, "lower", &lower) || wrong(table, "upper", &upper) || wrong(table, "sigmas", &sigmas) {
        return None;
    }
    Some(match sigmas {
        Some(sigmas) => Cut::Sigmas(sigmas),
        None => Cut::Bounds { lower, upper },
    })
}

fn range(table: &mut Section<'_, '_>) -> Option<Range> {
    let first = if table.has("max") && !table.has("min") { "max" } else { "min" };
    let one = is_one_of(table, &["half_width", "relative_half_width", first], "0.1");
    let (half, relative) = (table.values("half_width"), table.values("relative_half_width"));
    if one && table.has(first) {
        table.require("min", "given together with max", "0.0");
        table.require("max", "given together with min", "1.0");
    }
    let ends = table.values("min").zip(table.values("max"));
    if !one {
        return None;
    }
    match (half, relative, ends) {
        (Some(half), ..) => Some(Range::Around(half)),
        (_, Some(relative), _) => Some(Range::AroundRelative(relative)),
        (.., Some((min, max))) => Some(Range::Between { min, max }),
        _ => None,
    }
}
