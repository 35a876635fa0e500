//! [`Manifest`]: what a dataset consists of, as lines of JSON that are only ever appended to.
//!
//! ```text
//! {"spindrift":"dataset","format":5,...,"crc":"9f3c0a71"}  the rows: hash of the row plan, seed, columns, arithmetic
//! {"plan":"[campaign]\n...","crc":...}                            the text of plan.toml; the last such line holds
//! {"part":0,"first_sample":0,"rows":256,"files":[...],"crc":...} a part whose files are whole and on the disk
//! {"dropped":3,"crc":...}                                         a part that is to be made again
//! {"finished":true,"parts":16,"rows":4096,"files":[...],"crc":...} all is there, with every file that follows from it
//! ```
//! Only what is listed exists. Every line ends with the CRC-32 (ISO 3309) of what stands before it: a line that a crash
//! cut off, or in which a bit has changed, is recognised and left out, and the part that it listed is made again.

use serde::{Deserialize, Serialize};

use crate::ensemble::{Part, PartId};
use crate::sampling::SampleId;
use crate::storage::names::{PART_BANDS, RUNS, is_derived, is_ours};
use std::path::PathBuf;

/// Version of these lines, and of the files that they list: counts are Int64 since 2, parts have other sizes and bands
/// coarser buckets since 3; since 4 the manifest has the plan and lists the files that follow from the rows, and every
/// file of rows has the whole [`Identity`]; since 5 bands of large campaigns count the first runs only.
pub const FORMAT: u32 = 5;

/// Version of the arithmetic of rows: it changes where the same row plan would give other bits. The instruction set is
/// no part of it. Since 2 Taylor steps have more orders and integrals of thrust are those of the direction cosine
/// matrix. Since 3 the Taylor series of the gravity gradient follow the orbit in the frame of the body; since 4
/// estimates count steps in part shadow in full. Since 5 what Taylor steps leave out under effects that change within
/// an arc is added up as vectors, and their growth of errors is averaged. Since 6 estimates follow errors through
/// repeated periods, past separatrices, and from perigee to perigee.
pub const ARITHMETIC: u32 = 6;

/// What the rows of a dataset are. Rows of two datasets with the same identity can be mixed.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Identity {
    /// Always `dataset`: the mark by which a folder is recognised.
    pub spindrift: String,
    /// [`FORMAT`].
    pub format: u32,
    /// [`ARITHMETIC`].
    pub arithmetic: u32,
    /// SHA-256 of the row plan, in hexadecimal.
    pub row_hash: String,
    pub seed: u64,
    /// SHA-256 of names and types of the columns, in hexadecimal.
    pub columns: String,
}

/// A file with its checksum: of a part, or one that follows from the rows.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct FileRecord {
    /// Its name below the folder of the dataset, with `/`.
    pub name: String,
    /// Its size, bytes.
    pub bytes: u64,
    /// SHA-256 of its content, in hexadecimal.
    pub sha256: String,
}

impl FileRecord {
    /// Whether its name is one that parts have: a manifest names no file elsewhere.
    fn is_of_a_part(&self) -> bool {
        self.name
            .split_once('/')
            .is_some_and(|(folder, name)| [RUNS, PART_BANDS].contains(&folder) && is_ours(folder, name))
    }
}

/// A part that is whole.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct PartRecord {
    pub part: u64,
    pub first_sample: u64,
    pub rows: u64,
    pub files: Vec<FileRecord>,
}

impl PartRecord {
    /// The samples of the part.
    pub fn samples(&self) -> Part {
        Part { id: PartId(self.part), first: SampleId(self.first_sample), count: self.rows as usize }
    }
}

#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Record {
    Identity(Identity),
    /// A part that is whole.
    Part(PartRecord),
    /// What `plan.toml` has.
    Plan {
        plan: String,
    },
    /// A part that is no longer to be used.
    Dropped {
        dropped: u64,
    },
    Finished {
        finished: bool,
        parts: u64,
        rows: u64,
        /// The files that follow from plan and rows, ascending by name.
        files: Vec<FileRecord>,
    },
}

/// Separates a line from its checksum.
const CHECKSUM: &str = ",\"crc\":\"";

impl Record {
    /// The line, with its checksum and the end of the line.
    pub fn line(&self) -> String {
        let text = serde_json::to_string(self).unwrap_or_default();
        let body = text.strip_suffix('}').unwrap_or(&text);
        format!("{body}{CHECKSUM}{:08x}\"}}\n", crc32fast::hash(body.as_bytes()))
    }

    /// The record of a line without its end; `None` where the checksum is not that of the line.
    pub fn of(line: &str) -> Option<Record> {
        let (body, checksum) = line.rsplit_once(CHECKSUM)?;
        let is_whole = checksum == format!("{:08x}\"}}", crc32fast::hash(body.as_bytes()));
        is_whole.then(|| serde_json::from_str(&format!("{body}}}")).ok()).flatten()
    }
}

/// The records of a manifest as read.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Manifest {
    /// What the rows are; `None` where the first line is not whole.
    pub identity: Option<Identity>,
    /// The text of `plan.toml`; `None` where no line has it.
    pub plan: Option<String>,
    /// The parts that are listed, ascending by number.
    pub parts: std::collections::BTreeMap<u64, PartRecord>,
    /// Whether the last line says that everything is there.
    pub is_finished: bool,
    /// The files that follow from plan and rows, where the last line says that everything is there.
    pub derived: Vec<FileRecord>,
    /// Lines that are not whole, counted from 1.
    pub damaged: Vec<usize>,
}

impl Manifest {
    /// Reads the lines that are whole.
    pub fn of(bytes: &[u8]) -> Manifest {
        let mut manifest = Manifest::default();
        let mut lines = bytes.split(|byte| *byte == b'\n').collect::<Vec<_>>();
        let rest = lines.pop().unwrap_or_default();
        let mut records: Vec<Option<Record>> =
            lines.iter().map(|line| std::str::from_utf8(line).ok().and_then(Record::of)).collect();
        if !rest.is_empty() {
            records.push(None); // a line without an end may be a part of a longer one
        }
        for (index, record) in records.into_iter().enumerate() {
            manifest.is_finished = false;
            manifest.derived.clear();
            match record {
                Some(Record::Identity(identity)) if index == 0 => manifest.identity = Some(identity),
                Some(Record::Part(part)) if part.files.iter().all(FileRecord::is_of_a_part) => {
                    manifest.parts.insert(part.part, part);
                }
                Some(Record::Plan { plan }) => manifest.plan = Some(plan),
                Some(Record::Dropped { dropped }) => {
                    manifest.parts.remove(&dropped);
                }
                Some(Record::Finished { finished, parts, rows, files })
                    if files.iter().all(|file| is_derived(&file.name)) =>
                {
                    let counted = manifest.parts.values().map(|part| part.rows).sum::<u64>();
                    manifest.is_finished = finished && parts == manifest.parts.len() as u64 && rows == counted;
                    manifest.derived = files;
                }
                Some(Record::Identity(_) | Record::Part(_) | Record::Finished { .. }) | None => {
                    manifest.damaged.push(index + 1);
                }
            }
        }
        if manifest.identity.is_some() && manifest.plan.is_none() && manifest.damaged.is_empty() {
            manifest.damaged.push(2);
        }
        manifest
    }

    /// The text of a manifest with these parts in order; finished where `derived` are the files that follow from the
    /// rows.
    pub fn text<'p>(
        identity: &Identity,
        plan: &str,
        parts: impl Iterator<Item = &'p PartRecord>,
        derived: Option<Vec<FileRecord>>,
    ) -> String {
        let mut text = Record::Identity(identity.clone()).line() + &Record::Plan { plan: plan.to_owned() }.line();
        let (mut count, mut rows) = (0, 0);
        for part in parts {
            text += &Record::Part(part.clone()).line();
            (count, rows) = (count + 1, rows + part.rows);
        }
        if let Some(files) = derived {
            text += &Record::Finished { finished: true, parts: count, rows, files }.line();
        }
        text
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    pub fn identity() -> Identity {
        Identity {
            spindrift: "dataset".to_owned(),
            format: FORMAT,
            arithmetic: ARITHMETIC,
            row_hash: "ab".repeat(32),
            seed: 7,
            columns: "cd".repeat(32),
        }
    }

    fn part(number: u64) -> PartRecord {
        let file = FileRecord {
            name: format!("runs/part-{number:06}.parquet"),
            bytes: 1000 + number,
            sha256: "ef".repeat(32),
        };
        PartRecord { part: number, first_sample: 256 * number, rows: 256, files: vec![file] }
    }

    const PLAN: &str = "[campaign]\nname = \"x\"\n";

    fn derived() -> FileRecord {
        FileRecord { name: "summary.json".to_owned(), bytes: 77, sha256: "12".repeat(32) }
    }

    fn text() -> String {
        Manifest::text(&identity(), PLAN, [part(0), part(1), part(2)].iter(), Some(vec![derived()]))
    }

    /// Law: what is written is read back.
    #[test]
    fn lines_come_back() {
        let read = Manifest::of(text().as_bytes());
        assert_eq!(read.identity, Some(identity()));
        assert_eq!(read.parts.into_values().collect::<Vec<_>>(), [part(0), part(1), part(2)]);
        assert!(read.is_finished && read.damaged.is_empty());
        assert_eq!((read.plan.as_deref(), read.derived), (Some(PLAN), vec![derived()]));
    }

    /// Law: a manifest cut off at any byte has exactly the parts whose lines are whole, and is finished only when it is
    /// whole.
    #[test]
    fn every_cut_is_recognised() {
        let text = text();
        for length in 0..text.len() {
            let cut = &text[..length];
            let read = Manifest::of(cut.as_bytes());
            let whole = cut.matches('\n').count();
            assert_eq!(read.identity.is_some(), whole > 0, "{length} bytes");
            assert_eq!(read.plan.is_some(), whole > 1, "{length} bytes");
            assert_eq!(read.parts.len(), whole.saturating_sub(2).min(3), "{length} bytes");
            assert!(!read.is_finished && read.derived.is_empty(), "{length} bytes");
            let is_whole = cut.is_empty() || cut.ends_with('\n') && whole > 1;
            assert_eq!(read.damaged.is_empty(), is_whole, "{length} bytes");
        }
    }

    /// Law: a bit that changes anywhere costs at most the lines that it is in, and never lists a part that was not
    /// written.
    #[test]
    fn every_changed_bit_is_recognised() {
        let text = text();
        for byte in 0..text.len() {
            for bit in 0..8 {
                let mut changed = text.clone().into_bytes();
                changed[byte] ^= 1 << bit;
                let read = Manifest::of(&changed);
                assert!(!read.damaged.is_empty(), "byte {byte}, bit {bit}");
                // a line end that is no longer one joins two lines
                let lost = if text.as_bytes()[byte] == b'\n' { 2 } else { 1 };
                assert!(read.parts.len() + lost >= 3, "byte {byte}, bit {bit}");
                for (number, found) in read.parts {
                    assert_eq!(found, part(number), "byte {byte}, bit {bit}");
                }
                assert!(read.identity.is_none_or(|found| found == identity()), "byte {byte}, bit {bit}");
                assert!(read.plan.is_none_or(|found| found == PLAN), "byte {byte}, bit {bit}");
                assert!(read.derived.is_empty() || read.derived == [derived()], "byte {byte}, bit {bit}");
            }
        }
    }

    /// Law: a part that was dropped is listed again only where a later line lists it; what follows the last line takes
    /// it back.
    #[test]
    fn dropped_parts_are_gone() {
        let dropped = Record::Dropped { dropped: 1 }.line();
        let read = Manifest::of(format!("{}{dropped}", text()).as_bytes());
        assert_eq!(read.parts.keys().copied().collect::<Vec<_>>(), [0, 2]);
        assert!(!read.is_finished && read.damaged.is_empty());
        let again = Record::Part(part(1)).line();
        assert_eq!(Manifest::of(format!("{}{dropped}{again}", text()).as_bytes()).parts.len(), 3);
    }

    /// Law: a line that names a file outside of the folders of parts lists nothing, however right its checksum is.
    #[test]
    fn files_elsewhere_are_not_listed() {
        for name in [
            "../precious.parquet",
            "runs/../plan.toml",
            "/etc/passwd",
            "plan.toml",
            "trajectories/sample-000001.parquet",
            "runs/a/b",
        ] {
            let mut foreign = part(1);
            foreign.files[0].name = name.to_owned();
            let read = Manifest::of(format!("{}{}", text(), Record::Part(foreign).line()).as_bytes());
            assert_eq!((read.parts.len(), read.damaged), (3, vec![7]), "{name}");
        }
        for name in ["../precious", "/etc/passwd", "runs/part-000001.parquet", "manifest.jsonl", "data/../plan.toml"] {
            let files = vec![FileRecord { name: name.to_owned(), ..derived() }];
            let line = Record::Finished { finished: true, parts: 3, rows: 768, files }.line();
            let read = Manifest::of(format!("{}{line}", text()).as_bytes());
            assert!(!read.is_finished && read.derived.is_empty() && read.damaged == [7], "{name}");
        }
    }
}

/// The files of parts, in the order of the parts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PartsRead {
    pub rows: Vec<PathBuf>,
    pub bands: Vec<PathBuf>,
}

impl PartsRead {
    /// Those of `parts`; `path` finds a file by its name.
    pub fn of(parts: &[PartRecord], path: impl Fn(&str) -> PathBuf) -> Self {
        let names = || parts.iter().flat_map(|part| &part.files).map(|file| file.name.as_str());
        let of = |folder: &str| names().filter(|name| name.starts_with(folder)).map(&path).collect();
        PartsRead { rows: of(RUNS), bands: of(PART_BANDS) }
    }
}
