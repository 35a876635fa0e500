//! [`Compression`]: compression of the files of rows.

/// Compression of the files of rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Compression {
    /// LZ4: nearly as small as Zstandard, twice as fast to write.
    Lz4,
    /// Zstandard, level 1: the smallest.
    Zstd,
    /// None.
    None,
}

impl Compression {
    /// All values.
    pub const ALL: [Compression; 3] = [Compression::Lz4, Compression::Zstd, Compression::None];

    /// The name in campaign files.
    pub const fn name(self) -> &'static str {
        match self {
            Compression::Lz4 => "lz4",
            Compression::Zstd => "zstd",
            Compression::None => "none",
        }
    }

    /// The compression called `name`.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|compression| compression.name() == name)
    }
}
