//! Files of the bands of a part, `bands/part-000000.parquet`: what [`PartBands`] counted, one row for each bucket that is not empty.
//!
//! The metadata have what the bands are of, so that a file says by itself what its buckets mean.

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;
use std::{iter, num::NonZeroUsize, path::Path};

use serde::{Deserialize, Serialize};

use crate::ensemble::{BandLayout, Bands, Part, PartBands};
use crate::observables::band_series::Form;
use crate::run::Quantity;
use crate::statistics::deviation::{Code, NOT_A_NUMBER};
use crate::storage::columnar::{Cells, Content, EncodingError, Heading, Layout, Packing};
use crate::storage::disk::Storage;
use crate::storage::identity::{PART_KEY, part_metadata};
use crate::storage::parallel::in_order;
use crate::storage::rows_reader::{PartReader, RowsError};

/// Key of the metadata: what the bands are of.
const LAYOUT_KEY: &str = "spindrift.bands";
/// Number of runs.
const RUNS_KEY: &str = "spindrift.bands.runs";

/// The columns, each with its meaning.
const PLACE: (&str, &str) =
    ("place", "Which series and point: number of the series times the number of points, and the number of the point.");
const BUCKET: (&str, &str) = (
    "bucket",
    "The bucket of the deviations from the nominal run: twice the leading bits of the magnitude (32 to an octave, 1 at 2^-512), and 1 where it is negative; 0: zero.",
);
const COUNT: (&str, &str) = ("count", "Number of runs in it.");
const MIN: (&str, &str) = ("min", "Smallest kept number of the place, in its first row.");
const MAX: (&str, &str) = ("max", "Largest kept number of the place, in its first row.");

/// What bands are of, as text; numbers are written so that they are read back bit for bit.
#[derive(Deserialize, Serialize)]
struct LayoutText {
    series: Vec<SeriesText>,
    times_s: Vec<String>,
    nominal: Vec<String>,
}

#[derive(Deserialize, Serialize)]
struct SeriesText {
    name: String,
    unit: String,
    meaning: String,
    /// Whether tangents of half the angle are kept.
    is_half_tangent: bool,
}

fn text_of(layout: &BandLayout) -> String {
    let series = |(quantity, form): &(Quantity, Form)| SeriesText {
        name: quantity.name().to_owned(),
        unit: quantity.unit().to_owned(),
        meaning: quantity.meaning().to_owned(),
        is_half_tangent: *form == Form::HalfTangent,
    };
    let numbers = |numbers: &[f64]| numbers.iter().map(|number| format!("{number:?}")).collect();
    let text = LayoutText {
        series: layout.series.iter().map(series).collect(),
        times_s: numbers(&layout.times),
        nominal: numbers(&layout.nominal),
    };
    serde_json::to_string(&text).expect("texts are JSON")
}

fn layout_of(text: &str) -> Option<BandLayout> {
    let text: LayoutText = serde_json::from_str(text).ok()?;
    let series = |one: SeriesText| {
        let form = if one.is_half_tangent { Form::HalfTangent } else { Form::Value };
        (Quantity::named(one.name, one.unit, one.meaning), form)
    };
    let numbers = |texts: &[String]| texts.iter().map(|text| text.parse().ok()).collect::<Option<Vec<f64>>>();
    let (times, nominal) = (numbers(&text.times_s)?, numbers(&text.nominal)?);
    let layout = BandLayout { series: text.series.into_iter().map(series).collect(), times, nominal };
    (layout.series.len().checked_mul(layout.times.len()) == Some(layout.nominal.len())).then_some(layout)
}

/// Layout of the files of bands of one campaign.
#[derive(Clone, Debug)]
pub struct BandsFile(Layout);

impl BandsFile {
    /// The files of bands of `layout`.
    ///
    /// # Errors
    /// None: its columns have different names.
    pub fn new(layout: &BandLayout) -> Result<Self, EncodingError> {
        let heading = |(name, meaning): (&'static str, &'static str), content| {
            Heading::new(Quantity::new(name, "", meaning), content)
        };
        let counts = [PLACE, BUCKET, COUNT].map(|column| heading(column, Content::Count));
        let headings: Vec<Heading> =
            counts.into_iter().chain([MIN, MAX].map(|column| heading(column, Content::Real))).collect();
        let metadata = HashMap::from([(LAYOUT_KEY.to_owned(), text_of(layout))]);
        Ok(BandsFile(Layout::new(&headings, metadata, Packing::Lz4)?))
    }

    /// Appends to `out` the file of the `bands` of `part`: a function of the part alone.
    ///
    /// # Errors
    /// Where encoding fails.
    pub fn write(&self, part: Part, bands: &PartBands, out: &mut Vec<u8>) -> Result<(), EncodingError> {
        let (mut places, mut buckets, mut counts) = (Vec::new(), Vec::new(), Vec::new());
        let (mut min, mut max) = (Vec::new(), Vec::new());
        for place in 0..bands.layout().columns() {
            let (extremes, of_place) = bands.column(place);
            let start = counts.len();
            for (bucket, count) in of_place {
                buckets.push(u64::from(bucket));
                counts.push(count);
            }
            places.resize(counts.len(), place as u64);
            for (column, end) in [&mut min, &mut max].into_iter().zip(extremes.unwrap_or([f64::NAN; 2])) {
                column.extend(iter::once(end).take(counts.len() - start));
                column.resize(counts.len(), f64::NAN);
            }
        }
        let own: Vec<(&str, String)> =
            part_metadata(part, part.first).into_iter().chain([(RUNS_KEY, bands.runs().to_string())]).collect();
        let of_counts = [places, buckets, counts].map(|values| Cells::Count(values, None));
        self.0.write(out, &own, of_counts.into_iter().chain([&min, &max].map(|values| Cells::Real(values, None))))
    }
}

/// What the file of a part has.
struct StoredBands {
    part: u64,
    layout: BandLayout,
    runs: u64,
    /// Place, bucket and count, row by row.
    rows: Vec<(usize, Code, u64)>,
    extremes: [Vec<f64>; 2],
}

impl StoredBands {
    fn open(storage: &dyn Storage, path: &Path) -> Result<Self, RowsError> {
        let file = PartReader::open(storage, path)?;
        let numbers = |(name, _): (&str, &str)| file.numbers(name);
        let columns = [numbers(PLACE)?, numbers(BUCKET)?, numbers(COUNT)?];
        let extremes = [numbers(MIN)?, numbers(MAX)?];
        let found = || -> Option<StoredBands> {
            let number = |key: &str| file.metadata(key)?.parse().ok();
            let layout = layout_of(file.metadata(LAYOUT_KEY)?)?;
            let whole = |value: f64| (value >= 0.0 && value.fract() == 0.0).then_some(value as u64);
            let row = |row: usize| {
                let [place, bucket, count] = [0, 1, 2].map(|column| columns[column].get(row).copied().and_then(whole));
                Some((usize::try_from(place?).ok()?, Code::try_from(bucket?).ok()?, count?))
            };
            let rows = (0..file.rows()).map(row).collect::<Option<Vec<_>>>()?;
            let found = StoredBands { part: number(PART_KEY)?, layout, runs: number(RUNS_KEY)?, rows, extremes };
            found.makes_sense().then_some(found)
        };
        let damaged = || RowsError { path: path.display().to_string(), what: "is no file of bands".to_owned() };
        found().ok_or_else(damaged)
    }

    fn makes_sense(&self) -> bool {
        let is_row = |(place, bucket, count): &(usize, Code, u64)| {
            *place < self.layout.columns() && *bucket != NOT_A_NUMBER && *count > 0 && *count <= self.runs
        };
        let ascend = self.rows.windows(2).all(|pair| (pair[0].0, pair[0].1) < (pair[1].0, pair[1].1));
        self.rows.iter().all(is_row) && ascend
    }

    fn add_to(&self, bands: &mut Bands) {
        bands.add_runs(self.runs);
        let mut first = 0;
        for rows in self.rows.chunk_by(|a, b| a.0 == b.0) {
            let extremes = Some([&self.extremes[0], &self.extremes[1]].map(|column| column[first]));
            let extremes = extremes.filter(|[min, max]| min <= max);
            bands.add_column(rows[0].0, extremes, rows.iter().map(|(_, bucket, count)| (*bucket, *count)));
            first += rows.len();
        }
    }
}

/// The bands of several parts together; memory does not grow with their number.
///
/// # Errors
/// The first file that cannot be read, is damaged or of another campaign, or whose part does not follow those before it.
pub fn read(
    storage: &dyn Storage,
    files: &[PathBuf],
    threads: Option<NonZeroUsize>,
) -> Result<Option<Bands>, RowsError> {
    let mut merged: Option<(u64, Bands)> = None;
    in_order(
        files.len(),
        threads,
        |index| StoredBands::open(storage, &files[index]).map(|found| (index, found)),
        |(index, found)| {
            let unfit = |what: String| Err(RowsError { path: files[index].display().to_string(), what });
            if let Some((last, bands)) = &mut merged {
                if found.part <= *last {
                    return unfit(format!("part {} does not follow part {last}", found.part));
                }
                if !bands.layout().is(&found.layout) {
                    return unfit(
                        "these are bands of another campaign: series, times or nominal run differ".to_owned(),
                    );
                }
                *last = found.part;
            }
            let (_, bands) = merged.get_or_insert_with(|| (found.part, Bands::new(Arc::new(found.layout.clone()))));
            found.add_to(bands);
            Ok(())
        },
    )?;
    Ok(merged.map(|(_, bands)| bands))
}
