//! The keys of `[campaign]`, `[integrator]`, `[observe]`, `[audit]`, `[bands]` and `[output]`, from which reading,
//! messages, canonical text and documents follow; [`super::plan`] checks them together.

use super::bands::{FEWEST_RUNS as FEWEST_BAND_RUNS, MOST_POINTS as MOST_BAND_POINTS};
use super::chosen::MOST_CHOSEN;
use super::numbers::{FRACTION, LARGEST_SEED, MAX_POINTS, MAX_SAMPLES, POSITIVE, TOLERANCE};
use super::{analysis, derived_observable, description, display, event, extreme, requirement, retention, stop};
use crate::observables::Group;
use crate::propagation::Method;
use crate::sampling::keys::{Kind, Row, Rule, TextLimit};

macro_rules! names {
    ($Type:ty) => {{
        let mut names = [""; <$Type>::ALL.len()];
        let mut place = 0;
        while place < names.len() {
            names[place] = <$Type>::ALL[place].name();
            place += 1;
        }
        names
    }};
}
const METHODS: [&str; Method::ALL.len()] = names!(Method);
const GROUPS: [&str; Group::ALL.len()] = names!(Group);
const COMPRESSIONS: [&str; Compression::ALL.len()] = names!(Compression);

fn default_groups() -> String {
    let others = Group::ALL.into_iter().filter(|group| !Group::DEFAULT.contains(group));
    format!("all of them but {}", others.map(Group::name).collect::<Vec<_>>().join(" and "))
}

/// A folder name on every system.
const NAME: TextLimit = TextLimit {
    allowed: "1 to 100 letters, digits, _, - or . (the first one a letter, a digit or _)",
    remedy: "it names the folder of results, and is a word of commands: write it without spaces and slashes",
    test: |name| {
        let is_plain = name.chars().all(|c| c.is_ascii_alphanumeric() || "_-.".contains(c));
        is_plain && !name.starts_with(['.', '-']) && (1..=100).contains(&name.len())
    },
};

/// Tables above the scene.
#[rustfmt::skip]
pub const HEAD: [(&str, &[Row]); 3] = [
    ("campaign", &[
        Row::new("name", Kind::Text(NAME), "Name of the campaign and of its results folder")
            .required_as(NAME.allowed, "\"my_campaign\""),
        Row::new("description", Kind::Text(description::LIMIT),
            "The question that the campaign answers; default: the first sentence of the comments at the top of the \
            file"),
        Row::new("samples", Kind::Count([1, MAX_SAMPLES]),
            "Number of samples, including the nominal one; may be omitted if the design has a size of its own"),
        Row::new("only", Kind::Samples(MOST_CHOSEN), "The numbers of the samples to run; default: all"),
        Row::new("seed", Kind::Count([0, LARGEST_SEED]),
            "Seed of every draw").required_as("a whole number of at least 0", "1"),
        Row::new("duration_s", Kind::Number, "Duration of each run").limited(POSITIVE).required_as(POSITIVE.allowed,
            "10.0"),
    ]),
    ("integrator", &[
        Row::new("method", Kind::Word(&METHODS), "Equations and integrator"),
        Row::new("tolerance", Kind::Number, "Sets both of the following; default: 1e-14 for auto and taylor (1e-12 for \
            auto with drag or sunlight), 1e-10 for other methods")
            .limited(TOLERANCE),
        Row::new("relative_tolerance", Kind::Number, "Relative tolerance for local errors").limited(TOLERANCE),
        Row::new("absolute_tolerance", Kind::Number, "Absolute tolerance for local errors").limited(TOLERANCE),
        Row::new("step_s", Kind::Number, "Step size, required by the methods with a fixed step").limited(POSITIVE),
        Row::new("max_steps", Kind::Count([1, LARGEST_SEED]), "Largest number of steps of a run; default: 10 million"),
    ]),
    ("observe", &[
        Row::new("points", Kind::Count([2, MAX_POINTS]),
            "Number of points of the uniform grid of times from 0 to the duration; default: 101"),
        Row::new("groups", Kind::Words(&GROUPS, default_groups),
            "Groups of columns to observe; default: all but motion, mass_properties and orbit"),
        Row::new("nutation_axis", Kind::WordOrDirection(&["s3", "principal"]),
            "The axis whose angle from the angular momentum is the nutation angle; or a direction in F_s"),
    ]),
];

/// Tables below the draws.
#[rustfmt::skip]
pub const TAIL: [(&str, &[Row]); 3] = [
    ("audit", &[
        Row::new("fraction", Kind::Number, "Fraction of the samples that are compared with a reference solution; \
            default: 0")
            .limited(FRACTION),
    ]),
    ("bands", &[
        Row::new("points", Kind::Count([0, MOST_BAND_POINTS]),
            "Number of points in time at which quantiles are counted, 0 for none; default: all points of a grid of up \
            to 65, else 33; under a control loop, all points of a grid of up to 257, else 201"),
        Row::new("runs", Kind::Count([FEWEST_BAND_RUNS, MAX_SAMPLES]),
            "How many of the dispersed runs, counted from the first, enter these quantiles; default: 131,072, or all \
            runs of a grid and of other lists of samples"),
    ]),
    ("output", &[Row::new("compression", Kind::Word(&COMPRESSIONS), "Compression of the row files")]),
];

/// Tables of events, extremes, analysis and retention, with their rules.
pub const ANALYSIS: [(&str, &[Row], &[Rule]); 9] = [
    ("[[event]]", &event::ROWS, &[]),
    ("[[extreme]]", &extreme::ROWS, &[]),
    ("[[observable]]", &derived_observable::ROWS, &[]),
    ("[statistics]", &analysis::STATISTICS, &[]),
    ("[summary]", &analysis::SUMMARY, &[]),
    ("[[require]]", &requirement::ROWS, &requirement::RULES),
    ("[stop]", &stop::ROWS, &stop::RULES),
    ("[display]", &display::ROWS, &[]),
    ("[retain]", &retention::ROWS, &[]),
];

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Compression {
    /// Nearly as small as Zstandard, twice as fast to write.
    Lz4,
    /// Level 1: the smallest.
    Zstd,
    None,
}

impl Compression {
    pub const ALL: [Compression; 3] = [Compression::Lz4, Compression::Zstd, Compression::None];

    pub const fn name(self) -> &'static str {
        match self {
            Compression::Lz4 => "lz4",
            Compression::Zstd => "zstd",
            Compression::None => "none",
        }
    }

    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|compression| compression.name() == name)
    }
}
