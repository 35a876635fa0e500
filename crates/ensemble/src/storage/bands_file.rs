//! Files of the bands of a part, `bands/part-000000.parquet`: the counts of [`PartBands`], a row per non-empty bucket.
//!
//! The metadata describe the bands, so that a file explains its own buckets.

use super::store::Store;
use crate::ensemble::threads::Threads;
use crate::ensemble::{BandLayout, Bands, Part, PartBands, RunsOfColumn};
use crate::observables::band_series::Form;
use crate::run::Quantity;
use crate::statistics::deviation::{Code, NOT_A_NUMBER};
use crate::storage::columnar::{EncodingError, Layout, Packing};
use crate::storage::identity::{PART_KEY, part_metadata};
use crate::storage::parallel::in_order;
use crate::storage::rows_reader::{PartReader, Result, RowsError};
use crate::table::{Column, Content, Values};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::Arc;

const LAYOUT_KEY: &str = "spindrift.bands";
const RUNS_KEY: &str = "spindrift.bands.runs";
const COUNTED_KEY: &str = "spindrift.bands.counted";
/// By place (series by series, then points): smallest and largest kept number, NaN for none.
const EXTREMES_KEYS: [&str; 2] = ["spindrift.bands.min", "spindrift.bands.max"];
/// Number of runs without a number there.
const WITHOUT_KEY: &str = "spindrift.bands.without";
const ROWS_KEY: &str = "spindrift.bands.rows";

const BUCKET: (&str, &str) = (
    "bucket",
    "The bucket of the deviations from the nominal run: twice the leading bits of the magnitude (32 to an octave, 1 at \
    2^-512), and 1 where it is negative; 0: zero.",
);
const COUNT: (&str, &str) = ("count", "Number of runs in it.");

/// [`BandLayout`] as text; numbers are read back bit for bit.
#[derive(Deserialize, Serialize)]
struct LayoutText {
    series: Vec<SeriesText>,
    times_s: String,
    nominal: String,
}

#[derive(Deserialize, Serialize)]
struct SeriesText {
    name: String,
    unit: String,
    meaning: String,
    is_half_tangent: bool,
}

fn text(numbers: &[f64]) -> String {
    numbers.iter().map(|number| format!("{number:?}")).collect::<Vec<_>>().join(" ")
}

fn numbers(text: &str) -> Option<Vec<f64>> {
    text.split_whitespace().map(|number| number.parse().ok()).collect()
}

fn text_of(layout: &BandLayout) -> String {
    let series = |(quantity, form): &(Quantity, Form)| SeriesText {
        name: quantity.name().to_owned(),
        unit: quantity.unit().to_owned(),
        meaning: quantity.meaning().to_owned(),
        is_half_tangent: *form == Form::HalfTangent,
    };
    let layout = LayoutText {
        series: layout.series.iter().map(series).collect(),
        times_s: text(&layout.times),
        nominal: text(&layout.nominal),
    };
    serde_json::to_string(&layout).expect("texts are JSON")
}

fn layout_of(text: &str) -> Option<BandLayout> {
    let layout: LayoutText = serde_json::from_str(text).ok()?;
    let series = |one: SeriesText| {
        let form = if one.is_half_tangent { Form::HalfTangent } else { Form::Value };
        (Quantity::named(one.name, one.unit, one.meaning), form)
    };
    let (times, nominal) = (numbers(&layout.times_s)?, numbers(&layout.nominal)?);
    let layout = BandLayout { series: layout.series.into_iter().map(series).collect(), times, nominal };
    (layout.series.len().checked_mul(layout.times.len()) == Some(layout.nominal.len())).then_some(layout)
}

#[derive(Clone, Debug)]
pub struct BandsFile(Layout);

impl BandsFile {
    /// # Errors
    /// Never, since its columns have different names.
    pub fn new(layout: &BandLayout) -> Result<Self, EncodingError> {
        let columns =
            [BUCKET, COUNT].map(|(name, meaning)| Column::new(Quantity::new(name, "", meaning), Content::Count));
        let metadata = BTreeMap::from([(LAYOUT_KEY.to_owned(), text_of(layout))]);
        Ok(BandsFile(Layout::new(&columns, metadata, Packing::Lz4)?.without_statistics()))
    }

    /// Appends the file of the `bands` of `part` to `out`; it depends on the part alone.
    pub fn write(&self, part: Part, bands: &PartBands, out: &mut Vec<u8>) -> Result<(), EncodingError> {
        let (mut buckets, mut counts) = (Vec::new(), Vec::new());
        let (mut lengths, mut without, mut ends) = (Vec::new(), Vec::new(), [const { Vec::new() }; 2]);
        for place in 0..bands.layout().columns() {
            let (all, of_place) = bands.column(place);
            ends.iter_mut().zip(all.extremes.unwrap_or([f64::NAN; 2])).for_each(|(ends, end)| ends.push(end));
            without.push(all.without.to_string());
            let before = counts.len();
            of_place.for_each(|(bucket, count)| {
                buckets.push(u64::from(bucket));
                counts.push(count);
            });
            lengths.push((counts.len() - before).to_string());
        }
        let [runs, counted] = bands.runs().map(|runs| runs.to_string());
        let mut own = vec![(RUNS_KEY, runs), (COUNTED_KEY, counted)];
        own.extend([(ROWS_KEY, lengths.join(" ")), (WITHOUT_KEY, without.join(" "))]);
        own.extend(EXTREMES_KEYS.into_iter().zip(ends.map(|ends| text(&ends))));
        own.extend(part_metadata(part, part.first));
        self.0.write(out, &own, [buckets, counts].map(Values::Count).into_iter())
    }
}

struct StoredBands {
    part: u64,
    layout: BandLayout,
    /// All runs, and counted ones.
    runs: [u64; 2],
    /// Bucket and count by row.
    rows: Vec<(Code, u64)>,
    lengths: Vec<usize>,
    all: Vec<RunsOfColumn>,
}

impl StoredBands {
    fn open(store: &dyn Store, name: &str) -> Result<Self> {
        let file = PartReader::open(store, name)?;
        let (buckets, numbers_in) = (file.numbers(BUCKET.0)?, file.numbers(COUNT.0)?);
        let found = || -> Option<StoredBands> {
            let number = |key: &str| file.metadata(key)?.parse().ok();
            let whole = |value: f64| (value >= 0.0 && value.fract() == 0.0).then_some(value as u64);
            let row = |(bucket, count): (&f64, &f64)| Some((Code::try_from(whole(*bucket)?).ok()?, whole(*count)?));
            let [min, max] = EXTREMES_KEYS.map(|key| file.metadata(key).and_then(numbers));
            let counts = |key: &str| -> Option<Vec<u64>> {
                file.metadata(key)?.split_whitespace().map(|count| count.parse().ok()).collect()
            };
            let (min, max, without) = (min?, max?, counts(WITHOUT_KEY)?);
            let is_whole = [min.len(), max.len()] == [without.len(); 2];
            let all = min
                .into_iter()
                .zip(max)
                .zip(without)
                .map(|((min, max), without)| RunsOfColumn { extremes: (min <= max).then_some([min, max]), without });
            let found = StoredBands {
                part: number(PART_KEY)?,
                layout: layout_of(file.metadata(LAYOUT_KEY)?)?,
                runs: [number(RUNS_KEY)?, number(COUNTED_KEY)?],
                rows: buckets.iter().zip(&numbers_in).map(row).collect::<Option<_>>()?,
                lengths: counts(ROWS_KEY)?
                    .into_iter()
                    .map(|length| usize::try_from(length).ok())
                    .collect::<Option<_>>()?,
                all: all.collect(),
            };
            (is_whole && found.makes_sense()).then_some(found)
        };
        found().ok_or_else(|| RowsError { path: file.path().to_owned(), what: "is not a file of bands".to_owned() })
    }

    fn makes_sense(&self) -> bool {
        let places = self.layout.columns();
        let [runs, counted] = self.runs;
        let are_whole = self.lengths.len() == places && self.all.len() == places && counted <= runs;
        let rows = self.lengths.iter().try_fold(0_usize, |sum, length| sum.checked_add(*length));
        let is_row = |(bucket, count): &(Code, u64)| *bucket != NOT_A_NUMBER && *count > 0 && *count <= counted;
        let are_runs = self.all.iter().all(|all| all.without <= runs);
        are_whole && are_runs && rows == Some(self.rows.len()) && self.rows.iter().all(is_row)
    }

    fn add_to(&self, bands: &mut Bands) {
        bands.add_runs(self.runs);
        let mut first = 0;
        for (place, (length, all)) in self.lengths.iter().zip(&self.all).enumerate() {
            bands.add_column(place, *all, self.rows[first..first + length].iter().copied());
            first += length;
        }
    }
}

/// The joint bands of several parts; memory does not grow with their number.
///
/// # Errors
/// The first file that is unreadable, damaged, of another campaign, or out of order.
pub fn read(store: &dyn Store, files: &[String], threads: Threads) -> Result<Option<Bands>> {
    let mut merged: Option<(u64, Bands)> = None;
    in_order(
        files.len(),
        threads,
        |index| StoredBands::open(store, &files[index]).map(|found| (index, found)),
        |(index, found)| {
            let unfit = |what: String| Err(RowsError { path: store.path(&files[index]).display().to_string(), what });
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ensemble::PartId;
    use crate::sampling::SampleId;
    use crate::storage::disk::folder as store;
    use crate::storage::names::unfinished;
    use crate::storage::scratch::Scratch;
    use std::path::Path;

    fn layout(nominal: f64) -> BandLayout {
        let angle = Quantity::new("angle_rad", "rad", "An angle; with letters beyond ASCII: \u{3b1}.");
        let series = vec![(Quantity::new("x_j", "J", "An energy."), Form::Value), (angle, Form::HalfTangent)];
        BandLayout { series, times: vec![0.0, 1.5], nominal: vec![nominal, -2.0, f64::NAN, 1e300] }
    }

    /// Law: a layout is read back bit for bit; other texts are refused.
    #[test]
    fn layouts_come_back() {
        let layout = layout(0.1 + 0.2);
        assert!(layout_of(&text_of(&layout)).is_some_and(|found| found.is(&layout)));
        for wrong in ["", "{}", &text_of(&layout).replace("0.0 1.5", "0.0"), &text_of(&layout).replace("1.5", "x")] {
            assert!(layout_of(wrong).is_none(), "{wrong}");
        }
    }

    fn file(folder: &Path, part: u64, nominal: f64, rows: &[[u64; 2]], lengths: &str, extremes: [&str; 2]) -> String {
        let column = |index: usize| Values::Count(rows.iter().map(|row| row[index]).collect());
        let part = Part { id: PartId(part), first: SampleId(0), count: 9 };
        let mut own = vec![(RUNS_KEY, "11".to_owned()), (COUNTED_KEY, "9".to_owned())];
        own.extend([(ROWS_KEY, lengths), (WITHOUT_KEY, "0 11 11 9")].map(|(key, text)| (key, text.to_owned())));
        own.extend(EXTREMES_KEYS.into_iter().zip(extremes.map(str::to_owned)));
        own.extend(part_metadata(part, part.first));
        let mut bytes = Vec::new();
        BandsFile::new(&layout(nominal)).unwrap().0.write(&mut bytes, &own, [0, 1].map(column).into_iter()).unwrap();
        let name = unfinished(Path::new("part")).display().to_string();
        std::fs::write(folder.join(&name), bytes).unwrap();
        name
    }

    /// Law: files are merged in their order; invalid, damaged, foreign and repeated ones are refused by name.
    #[test]
    fn files_are_merged_or_refused_by_name() {
        let folder = Scratch::new("bands-file");
        let ends = ["1.0 NaN NaN -3.0", "2.5 NaN NaN 4.0"];
        let (sound, lengths) = ([[0, 4], [700, 5], [9, 1]], "2 0 0 1");
        let [first, second] = [0, 1].map(|part| file(&folder, part, 1.0, &sound, lengths, ends));
        let of = |files: &[&String]| {
            read(&*store(&folder), &files.iter().map(|file| (*file).clone()).collect::<Vec<_>>(), None)
        };
        let both = of(&[&first, &second]).unwrap().unwrap();
        assert_eq!((both.runs(), both.count(0, 0), both.count(0, 1), both.count(1, 1)), (22, 22, 0, 4));
        assert_eq!((both.counted_runs(), both.counted(0, 0), both.counted(0, 1), both.counted(1, 1)), (18, 18, 0, 2));
        assert_eq!((both.extremes(0, 0), both.extremes(0, 1)), (Some([1.0, 2.5]), None));
        assert_eq!(of(&[]).unwrap(), None);
        let refused = |files: &[&String]| of(files).unwrap_err().to_string();
        assert!(refused(&[&second, &first]).contains("part 0 does not follow part 1"));
        assert!(refused(&[&first, &first]).contains("part 0 does not follow part 0"));
        let other = file(&folder, 2, 1.5, &sound, lengths, ends);
        assert!(
            refused(&[&first, &other])
                .ends_with("these are bands of another campaign: series, times or nominal run differ")
        );
        for (row, lengths) in
            [([7, 0], "1 0 0 0"), ([7, 10], "1 0 0 0"), ([1, 1], "1 0 0 0"), ([7, 1], "1 0 0"), ([7, 1], "1 0 0 1")]
        {
            let wrong = file(&folder, 0, 1.0, &[row], lengths, ends);
            assert!(refused(&[&wrong]).ends_with("is not a file of bands"), "{row:?} {lengths}");
        }
        assert!(
            refused(&[&file(&folder, 0, 1.0, &sound, lengths, ["1.0", "2.5"])]).ends_with("is not a file of bands")
        );
        std::fs::write(folder.join(&first), b"PAR1").unwrap();
        assert!(refused(&[&first]).starts_with(folder.join(&first).to_str().unwrap()));
    }
}
