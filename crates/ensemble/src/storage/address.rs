//! [`Address`]: where a result is in an object store.

use std::fmt;
use std::path::Path;

/// Address of a result in an object store: `s3://bucket/prefix`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Address {
    pub bucket: String,
    /// Prefix of the names of its objects, without a final slash.
    pub prefix: String,
}

impl Address {
    /// The address `path`, or `None` for a folder. `has_client`: this process can connect to a store.
    ///
    /// # Errors
    /// An invalid address, or a build without object stores.
    pub fn of(path: &Path, has_client: bool) -> Result<Option<Address>, String> {
        let Some((scheme, rest)) = path.to_str().and_then(|text| text.split_once(':')) else { return Ok(None) };
        // a letter is a disk of Windows
        let is_scheme = scheme.len() > 1 && scheme.bytes().all(|byte| byte.is_ascii_alphanumeric());
        if !is_scheme || !(rest.starts_with('/') || scheme.eq_ignore_ascii_case("s3")) {
            return Ok(None);
        }
        let shown = path.display();
        let Some(rest) = rest.strip_prefix("//").filter(|_| scheme == "s3") else {
            return Err(format!(
                "{shown}: must be a folder, or an address in a store that has S3's interface: s3://bucket/name; \
                a folder with this name is ./{shown}"
            ));
        };
        if !has_client {
            return Err(format!(
                "{shown}: this build of spindrift has no object stores; build one that has them: cargo build --release \
                --features cloud"
            ));
        }
        let (bucket, prefix) = rest.split_once('/').unwrap_or((rest, ""));
        let prefix = prefix.trim_end_matches('/');
        let is_name = |name: &str| {
            let is_allowed = |byte: u8| byte.is_ascii_alphanumeric() || b"-_.=+@".contains(&byte);
            !name.is_empty() && ![".", ".."].contains(&name) && name.bytes().all(is_allowed)
        };
        if !is_name(bucket) || !prefix.split('/').all(is_name) {
            return Err(format!(
                "{shown}: must be s3://bucket/name, with further names between slashes where you like; names have \
                letters, digits and -_.=+@"
            ));
        }
        Ok(Some(Address { bucket: bucket.to_owned(), prefix: prefix.to_owned() }))
    }
}

impl fmt::Display for Address {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "s3://{}/{}", self.bucket, self.prefix)
    }
}
