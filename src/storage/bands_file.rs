//! Files of the bands of a part, `bands/part-000000.bands`: what [`crate::ensemble::bands::Bands`] of a part counted.
//!
//! All numbers are little-endian; `n` is an unsigned LEB128 number, a text its length `n` and UTF-8.
//!
//! | | |
//! | --- | --- |
//! | `SDBANDS` and the version, 2 | 8 bytes |
//! | number, first sample and number of samples of the part | 3 n |
//! | number of runs: dispersed and `ok` | n |
//! | number of series; of each name, unit, meaning, form (0 value, 1 tangent of half the angle) | n; 3 texts, 1 byte |
//! | number of points; their times, s; values of the nominal run, series by series, NaN where it has none | n, f64 |
//! | for each series and point: 2 x number of buckets + 1 where there are extremes; the extremes; the buckets | n; 2 f64; n |
//! | CRC-32 (IEEE) of all bytes before | 4 bytes |
//!
//! Buckets come in ascending order of their codes ([`crate::statistics::deviation`]): 2 x difference from the one before + 1 where the
//! count is above 1, then that count minus 2.

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use thiserror::Error;

use crate::ensemble::bands::{BandColumn, BandLayout, BandSums, Bands, ColumnView, CountedBands};
use crate::ensemble::{Part, PartId};
use crate::observables::band_series::Form;
use crate::run::Quantity;
use crate::sampling::SampleId;
use crate::statistics::deviation::{Code, DeviationCounts};
use crate::storage::disk::Storage;
use crate::storage::parallel::in_order;

/// The first bytes of a file.
const MARK: &[u8; 7] = b"SDBANDS";
/// The version that is written and read.
const VERSION: u8 = 2;
/// Most bytes of a file that is read: the bands of a part of 16,384 runs of `spin_sweep` have 350 kB.
const MOST_BYTES: u64 = 1 << 32;
/// Bytes of the checksum.
const CHECKSUM: usize = 4;

/// Why bytes are not the bands of a part.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum NotBands {
    /// They do not begin as a file of bands does.
    #[error("is no file of bands")]
    Foreign,
    /// Another version wrote them.
    #[error("is a file of bands of version {0}; this program reads version {VERSION}")]
    Version(u8),
    /// A byte is wrong or missing.
    #[error("is damaged: {0}")]
    Damaged(&'static str),
}

/// Why bands could not be read.
#[derive(Debug, Error)]
pub enum BandsError {
    /// A file could not be read.
    #[error("{path}: {source}")]
    Io {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// A file has something else.
    #[error("{path} {source}")]
    Content {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        source: NotBands,
    },
    /// A file is of another campaign than those before it, or of a part that was there already.
    #[error("{path}: {reason}")]
    Unfit {
        /// The file.
        path: PathBuf,
        /// Why.
        reason: String,
    },
}

/// Appends to `out` the file of the bands of `part`: a function of the part alone.
pub fn write(part: Part, bands: &impl CountedBands, out: &mut Vec<u8>) {
    let (layout, start) = (bands.layout(), out.len());
    out.extend_from_slice(MARK);
    out.push(VERSION);
    for number in [part.id.0, part.first.0, part.count as u64, bands.runs(), layout.series.len() as u64] {
        put(out, number);
    }
    for (quantity, form) in &layout.series {
        for text in [quantity.name(), quantity.unit(), quantity.meaning()] {
            put(out, text.len() as u64);
            out.extend_from_slice(text.as_bytes());
        }
        out.push(form_byte(*form));
    }
    put(out, layout.times.len() as u64);
    layout.times.iter().chain(&layout.nominal).for_each(|number| out.extend_from_slice(&number.to_le_bytes()));
    for index in 0..layout.columns() {
        let ColumnView { extremes, buckets } = bands.column(index);
        put(out, 2 * buckets.len() as u64 + u64::from(extremes.is_some()));
        extremes.iter().flatten().for_each(|number| out.extend_from_slice(&number.to_le_bytes()));
        put_buckets(out, buckets);
    }
    let checksum = crc32fast::hash(&out[start..]);
    out.extend_from_slice(&checksum.to_le_bytes());
}

/// Most bytes of a bucket: of the difference of two codes, and of a count.
const LONGEST: usize = 3 + 10;

/// Writes the buckets of a column. Nearly all take one byte or two: these are written without a branch on which.
fn put_buckets(out: &mut Vec<u8>, buckets: impl ExactSizeIterator<Item = (Code, u64)>) {
    let (mut before, mut at) = (0, out.len());
    out.resize(at + LONGEST * buckets.len(), 0);
    for (code, count) in buckets {
        let (head, more) = (2 * u64::from(code - before) + u64::from(count > 1), count.saturating_sub(2));
        before = code;
        if head < 0x80 && more < 0x80 {
            out[at..at + 2].copy_from_slice(&[head as u8, more as u8]);
            at += 1 + usize::from(count > 1);
            continue;
        }
        let numbers = [head, more];
        for number in &numbers[..1 + usize::from(count > 1)] {
            at += put_at(&mut out[at..], *number);
        }
    }
    out.truncate(at);
}

/// The part and its bands.
///
/// # Errors
/// Where the bytes are not those of [`write()`].
pub fn from_bytes(bytes: &[u8]) -> Result<(Part, Bands), NotBands> {
    if !bytes.starts_with(MARK) || bytes.len() <= MARK.len() {
        return Err(NotBands::Foreign);
    }
    let version = bytes[MARK.len()];
    if version != VERSION {
        return Err(NotBands::Version(version));
    }
    let Some((content, checksum)) = bytes.split_last_chunk::<CHECKSUM>() else {
        return Err(NotBands::Damaged("it is too short"));
    };
    if crc32fast::hash(content).to_le_bytes() != *checksum {
        return Err(NotBands::Damaged("its checksum is wrong"));
    }
    let mut reader = Reader(content.get(MARK.len() + 1..).unwrap_or_default());
    let read = reader.part().filter(|_| reader.0.is_empty());
    read.ok_or(NotBands::Damaged("its checksum is right, and its content makes no sense"))
}

/// The bands of several parts together; memory does not grow with their number.
///
/// # Errors
/// The first file that cannot be read, is damaged or of another campaign, or whose part does not follow those before it.
pub fn read(
    storage: &dyn Storage,
    files: &[PathBuf],
    threads: Option<NonZeroUsize>,
) -> Result<Option<Bands>, BandsError> {
    let mut merged: Option<(PartId, BandSums)> = None;
    in_order(
        files.len(),
        threads,
        |index| read_one(storage, &files[index]).map(|(part, bands)| (index, part, bands)),
        |(index, part, bands)| {
            let unfit = |reason: String| BandsError::Unfit { path: files[index].clone(), reason };
            let (last, sums) = match merged.take() {
                None => (None, BandSums::new(bands.layout().clone())),
                Some((last, sums)) => (Some(last), sums),
            };
            if let Some(last) = last.filter(|last| part.id <= *last) {
                return Err(unfit(format!("part {} does not follow part {}", part.id.0, last.0)));
            }
            let (_, sums) = merged.insert((part.id, sums));
            sums.add(&bands).map_err(|error| unfit(error.to_string()))?;
            Ok(())
        },
    )?;
    Ok(merged.map(|(_, sums)| sums.bands()))
}

fn read_one(storage: &dyn Storage, path: &Path) -> Result<(Part, Bands), BandsError> {
    let bytes = storage.read(path, MOST_BYTES).map_err(|source| BandsError::Io { path: path.to_owned(), source })?;
    from_bytes(&bytes).map_err(|source| BandsError::Content { path: path.to_owned(), source })
}

fn form_byte(form: Form) -> u8 {
    match form {
        Form::Value => 0,
        Form::HalfTangent => 1,
    }
}

/// Writes an unsigned LEB128 number.
fn put(out: &mut Vec<u8>, number: u64) {
    let mut bytes = [0; 10];
    let length = put_at(&mut bytes, number);
    out.extend_from_slice(&bytes[..length]);
}

/// Writes an unsigned LEB128 number to the start of `out`; its length.
fn put_at(out: &mut [u8], mut number: u64) -> usize {
    let mut length = 1;
    while number >= 0x80 {
        out[length - 1] = number as u8 | 0x80;
        number >>= 7;
        length += 1;
    }
    out[length - 1] = number as u8;
    length
}

/// The bytes that are not read yet. Every read is `None` where they do not suffice; nothing is allocated for more than they can hold.
struct Reader<'a>(&'a [u8]);

impl<'a> Reader<'a> {
    fn take(&mut self, count: usize) -> Option<&'a [u8]> {
        let (taken, rest) = self.0.split_at_checked(count)?;
        self.0 = rest;
        Some(taken)
    }

    fn byte(&mut self) -> Option<u8> {
        self.take(1).map(|bytes| bytes[0])
    }

    fn number(&mut self) -> Option<u64> {
        let mut number = 0_u64;
        for shift in (0..64).step_by(7) {
            let byte = self.byte()?;
            let bits = u64::from(byte & 0x7f);
            // the last of ten bytes has one bit
            if bits << shift >> shift != bits {
                return None;
            }
            number |= bits << shift;
            if byte < 0x80 {
                return Some(number);
            }
        }
        None
    }

    /// A number of things of at least `size` bytes each.
    fn length(&mut self, size: usize) -> Option<usize> {
        let length = usize::try_from(self.number()?).ok()?;
        (length.checked_mul(size)? <= self.0.len()).then_some(length)
    }

    fn real(&mut self) -> Option<f64> {
        self.take(8)?.try_into().ok().map(f64::from_le_bytes)
    }

    fn reals(&mut self, count: usize) -> Option<Vec<f64>> {
        (count.checked_mul(8)? <= self.0.len()).then(|| (0..count).map_while(|_| self.real()).collect())
    }

    fn text(&mut self) -> Option<String> {
        let length = self.length(1)?;
        String::from_utf8(self.take(length)?.to_vec()).ok()
    }

    fn part(&mut self) -> Option<(Part, Bands)> {
        let (id, first) = (PartId(self.number()?), SampleId(self.number()?));
        let part = Part { id, first, count: usize::try_from(self.number()?).ok()? };
        let runs = self.number().filter(|runs| *runs <= part.count as u64)?;
        let series = (0..self.length(4)?).map(|_| self.series()).collect::<Option<Vec<_>>>()?;
        let points = self.length(8)?;
        let layout =
            BandLayout { times: self.reals(points)?, nominal: self.reals(points.checked_mul(series.len())?)?, series };
        let columns = (0..layout.columns()).map(|_| self.column(runs)).collect::<Option<Vec<_>>>()?;
        Some((part, Bands::new(Arc::new(layout), runs, columns)?))
    }

    fn series(&mut self) -> Option<(Quantity, Form)> {
        let quantity = Quantity::named(self.text()?, self.text()?, self.text()?);
        let form = self.byte()?;
        let form = [Form::Value, Form::HalfTangent].into_iter().find(|known| form_byte(*known) == form)?;
        Some((quantity, form))
    }

    fn column(&mut self, runs: u64) -> Option<BandColumn> {
        let head = self.number()?;
        let buckets = usize::try_from(head / 2).ok().filter(|buckets| *buckets <= self.0.len())?;
        let extremes = if head % 2 == 1 { Some([self.real()?, self.real()?]) } else { None };
        let mut code = 0_u64;
        let bucket = |_| {
            let gap = self.number()?;
            code = code.checked_add(gap / 2)?;
            let count = if gap % 2 == 1 { self.number()?.checked_add(2)? } else { 1 };
            Some((Code::try_from(code).ok()?, count))
        };
        let counts = DeviationCounts::of((0..buckets).map(bucket).collect::<Option<Vec<_>>>()?)?;
        let is_possible = counts.count() <= runs && (extremes.is_some() || counts.count() == 0);
        let is_range = extremes.is_none_or(|[min, max]| min <= max);
        (is_possible && is_range).then_some(BandColumn { extremes, counts })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::deviation::code;
    use crate::storage::disk::Disk;

    const PART: Part = Part { id: PartId(3), first: SampleId(768), count: 256 };

    fn layout(nominal: f64) -> Arc<BandLayout> {
        let quantity = Quantity::new("angle_rad", "rad", "An angle; with letters beyond ASCII: \u{3b1}.");
        let series = vec![(Quantity::new("x_j", "J", "An energy."), Form::Value), (quantity, Form::HalfTangent)];
        Arc::new(BandLayout { series, times: vec![0.0, 1.5], nominal: vec![nominal, -2.0, f64::NAN, 1e300] })
    }

    fn bands(nominal: f64, deviations: &[f64]) -> Bands {
        let mut codes: Vec<Code> = deviations.iter().map(|deviation| code(*deviation)).collect();
        codes.sort_unstable();
        let buckets = codes.chunk_by(|a, b| a == b).map(|run| (run[0], run.len() as u64)).collect();
        let full = BandColumn { extremes: Some([-1e-9, 7.0]), counts: DeviationCounts::of(buckets).unwrap() };
        let columns = vec![full.clone(), BandColumn::default(), full, BandColumn::default()];
        Bands::new(layout(nominal), deviations.len() as u64, columns).unwrap()
    }

    fn to_bytes(part: Part, bands: &Bands) -> Vec<u8> {
        let mut bytes = Vec::new();
        write(part, bands, &mut bytes);
        bytes
    }

    fn some() -> Bands {
        bands(1.0, &[0.0, 0.0, 1e-9, -1e-9, 7.0, 7.0, 7.0, 6e30, -6e-30])
    }

    /// Law: what is written is read back, bit for bit.
    #[test]
    fn bands_come_back() {
        let bytes = to_bytes(PART, &some());
        let (part, found) = from_bytes(&bytes).unwrap();
        assert_eq!((part, &found), (PART, &some()));
        assert_eq!(to_bytes(part, &found), bytes);
        assert!(bytes.len() < 260, "{} bytes", bytes.len());
        let none = bands(1.0, &[]);
        assert_eq!(from_bytes(&to_bytes(PART, &none)).unwrap().1.runs(), 0);
    }

    /// Law: no byte can be changed, left out at the end or added without being noticed; nothing panics.
    #[test]
    fn damage_is_noticed() {
        let bytes = to_bytes(PART, &some());
        for at in 0..bytes.len() {
            for flip in [1, 0x80, 0xff] {
                let mut damaged = bytes.clone();
                damaged[at] ^= flip;
                assert!(from_bytes(&damaged).is_err(), "byte {at}");
            }
            assert!(from_bytes(&bytes[..at]).is_err(), "the first {at} bytes");
        }
        assert!(from_bytes(&[&bytes[..], &[0]].concat()).is_err());
        let mut newer = bytes.clone();
        newer[7] = 3;
        assert_eq!(from_bytes(&newer).unwrap_err(), NotBands::Version(3));
        assert_eq!(from_bytes(b"PAR1").unwrap_err(), NotBands::Foreign);
    }

    /// Law: content that makes no sense is refused although its checksum is right, and takes no memory.
    #[test]
    fn nonsense_with_a_checksum_is_refused() {
        let signed = |content: &[u8]| [content, &crc32fast::hash(content).to_le_bytes()].concat();
        let bytes = to_bytes(PART, &some());
        let content = &bytes[..bytes.len() - CHECKSUM];
        assert!(from_bytes(&signed(content)).is_ok());
        assert!(from_bytes(&signed(&content[..content.len() - 1])).is_err());
        assert!(from_bytes(&signed(&[content, &[0]].concat())).is_err());
        let huge = [&bytes[..8], &[0, 0, 1, 1], &[0xff; 9], &[1]].concat();
        assert!(from_bytes(&signed(&huge)).is_err());
        // more runs than samples
        let few = Part { count: 3, ..PART };
        assert!(from_bytes(&to_bytes(few, &some())).is_err());
    }

    /// Law: files are merged in their order; one that is damaged, of another campaign or there twice is refused by its name.
    #[test]
    fn files_are_merged_or_refused_by_name() {
        let folder = std::env::temp_dir().join(format!("spindrift-bands-file-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let file = |id: u64, bytes: &[u8]| {
            let path = folder.join(format!("part-{id:06}.bands"));
            std::fs::write(&path, bytes).unwrap();
            path
        };
        let of = |id: u64, bands: &Bands| to_bytes(Part { id: PartId(id), ..PART }, bands);
        let (first, second) = (file(0, &of(0, &some())), file(1, &of(1, &bands(1.0, &[2.0, 3.0]))));
        let both = [first.clone(), second.clone()];
        let mut expected = BandSums::new(some().layout().clone());
        [some(), bands(1.0, &[2.0, 3.0])].iter().for_each(|bands| expected.add(bands).unwrap());
        assert_eq!(read(&Disk, &both, None).unwrap(), Some(expected.bands()));
        assert_eq!(read(&Disk, &[], None).unwrap(), None);
        let refused = |files: &[PathBuf]| read(&Disk, files, None).unwrap_err().to_string();
        assert!(refused(&[second.clone(), first.clone()]).contains("part 0 does not follow part 1"));
        assert!(refused(&[first.clone(), first.clone()]).contains("part 0 does not follow part 0"));
        let other = file(2, &of(2, &bands(1.5, &[2.0])));
        assert!(refused(&[first.clone(), other]).contains("part-000002.bands: these are bands of another campaign"));
        let mut damaged = of(3, &some());
        damaged[40] ^= 4;
        let damaged = file(3, &damaged);
        assert!(refused(&[first.clone(), damaged]).contains("part-000003.bands is damaged: its checksum is wrong"));
        assert!(refused(&[first, folder.join("part-000004.bands")]).contains("part-000004.bands: "));
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
