//! [`DeviationColumns`]: the buckets of all columns of the bands of a part that are not empty, one column after the other.
//!
//! They are written to the file of the part and added to the sums of the campaign: both read flat lists, which are reused from part to part.

use crate::statistics::deviation::{Code, ZERO};

/// Counts that are looked at together: where all are zero, as most are in the outer octaves, none is looked at alone.
const BLOCK: usize = 16;

/// Buckets that are not empty, column by column, in ascending order of their codes.
#[derive(Clone, Debug, Default)]
pub(super) struct DeviationColumns {
    codes: Vec<Code>,
    counts: Vec<u16>,
    /// Where each column ends.
    ends: Vec<usize>,
    scratch: (Vec<Code>, Vec<u16>),
}

impl DeviationColumns {
    /// Removes all columns; their memory remains.
    pub(super) fn clear(&mut self) {
        self.codes.clear();
        self.counts.clear();
        self.ends.clear();
    }

    /// The buckets of a column; none of one that is not there.
    pub(super) fn column(&self, index: usize) -> impl ExactSizeIterator<Item = (Code, u64)> + Clone {
        let end = |index: usize| self.ends.get(index).copied();
        let start = index.checked_sub(1).and_then(end).unwrap_or(0);
        let range = start..end(index).unwrap_or(start);
        let counts = self.counts[range.clone()].iter().map(|count| u64::from(*count));
        self.codes[range].iter().copied().zip(counts)
    }

    /// Appends the column with `zeros` deviations of zero and `counts` from the code `first` on.
    pub(super) fn append(&mut self, (zeros, first, counts): (u16, Code, &[u16])) {
        if zeros > 0 {
            self.codes.push(ZERO);
            self.counts.push(zeros);
        }
        // without a branch on each count: each is written, and the next one overwrites it where it is zero
        let (codes, found) = &mut self.scratch;
        codes.resize(counts.len() + 1, ZERO);
        found.resize(counts.len() + 1, 0);
        let mut length = 0;
        for (block, at) in counts.chunks(BLOCK).zip((usize::from(first)..).step_by(BLOCK)) {
            if block.iter().fold(0, |any, count| any | count) == 0 {
                continue;
            }
            for (count, code) in block.iter().zip(at..) {
                codes[length] = code as Code;
                found[length] = *count;
                length += usize::from(*count != 0);
            }
        }
        self.codes.extend_from_slice(&codes[..length]);
        self.counts.extend_from_slice(&found[..length]);
        self.ends.push(self.codes.len());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: a column has the buckets that are not empty, in their order, and nothing of its neighbours or of an earlier part.
    #[test]
    fn columns_have_what_was_counted() {
        let mut columns = DeviationColumns::default();
        let mut counts = vec![0_u16; 3 * BLOCK + 1];
        for _ in 0..2 {
            columns.clear();
            counts.fill(0);
            columns.append((0, 64, &counts));
            [(0, 1), (BLOCK - 1, 7), (3 * BLOCK, u16::MAX)].iter().for_each(|(at, count)| counts[*at] = *count);
            columns.append((5, 128, &counts));
            columns.append((2, 64, &[]));
            let found: Vec<Vec<(Code, u64)>> = (0..4).map(|at| columns.column(at).collect()).collect();
            let second = [(ZERO, 5), (128, 1), (127 + BLOCK as Code, 7), (128 + 3 * BLOCK as Code, 65_535)];
            assert_eq!(found, [vec![], second.to_vec(), vec![(ZERO, 2)], vec![]]);
        }
    }
}
