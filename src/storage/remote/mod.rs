//! Results in an object store: [`Address`], where; [`Remote`], what is put and got there.
//!
//! - `client`: requests; in a build without the feature `cloud`, `no_client` in its place: an address is then refused. - `objects`: the files of a result as
//!   objects, and the order in which they are put.

#[cfg(feature = "cloud")]
mod client;
#[cfg(not(feature = "cloud"))]
#[path = "no_client.rs"]
mod client;
mod objects;

use std::fmt;
use std::path::Path;

pub use objects::{Fault, Remote, head_of};

/// Where a result is in an object store: `s3://bucket/prefix`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Address {
    pub bucket: String,
    /// What the names of its objects begin with, without a slash at the end.
    pub prefix: String,
}

impl Address {
    /// The address that `path` is; `None` of the path of a folder.
    ///
    /// # Errors
    /// What is wrong with it; in a build without the feature `cloud`, how to get one with it.
    pub fn of(path: &Path) -> Result<Option<Address>, String> {
        let Some((scheme, rest)) = path.to_str().and_then(|text| text.split_once("://")) else { return Ok(None) };
        if scheme.is_empty() || !scheme.bytes().all(|byte| byte.is_ascii_alphanumeric()) {
            return Ok(None);
        }
        let shown = path.display();
        if scheme != "s3" {
            return Err(format!(
                "{shown}: must be a folder, or an address in a store that has S3's interface: s3://bucket/name"
            ));
        }
        if cfg!(not(feature = "cloud")) {
            return Err(format!(
                "{shown}: this build of spindrift has no object stores; build one that has them: cargo build --release --features cloud"
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
                "{shown}: must be s3://bucket/name, with further names between slashes where you like; names have letters, digits and -_.=+@"
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
