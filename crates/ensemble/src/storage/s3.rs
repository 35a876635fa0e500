//! [`connect`]: a dataset in an S3 object store, with the feature `cloud` and in the Python package.
//!
//! Each object is put only if absent. The crate `object_store` retries unanswered requests (5xx, 429, broken
//! connections). After a conditional put, a lost answer, 409 and 412 leave the state open, so the object is read: equal
//! content is success, absence a reason to retry, anything else is refused, since nothing in a store is replaced or
//! removed.

use std::collections::BTreeMap;
use std::error::Error as _;
use std::fs::{File, TryLockError};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use bytes::Bytes;
use object_store::aws::{AmazonS3, AmazonS3Builder, AmazonS3ConfigKey};
use object_store::path::Path as Key;
use object_store::{ClientConfigKey, Error, ObjectStore, ObjectStoreExt, PutMode, PutOptions, RetryConfig};
use tokio::runtime::{Builder, Runtime};

use super::address::Address;
use super::identity::sha256;
use super::store::{Entry, Store};

/// Retries of a request, with pauses up to 15 s, about a minute in all.
const RETRIES: usize = 10;
/// Retries of the first request, which finds wrong settings.
const FIRST_RETRIES: usize = 3;
/// Attempts to put an object that was not taken and is absent.
const ATTEMPTS: u32 = 8;
/// First pause between them, then doubled.
const PAUSE: Duration = Duration::from_millis(50);
/// Time limit of a request without `AWS_TIMEOUT`: a part of 50 MB at 0.2 MB/s.
const TIMEOUT: &str = "250 seconds";
/// Variables with secret values, never in messages.
const SECRETS: [&str; 4] =
    ["AWS_SECRET_ACCESS_KEY", "AWS_SESSION_TOKEN", "AWS_ACCESS_KEY_ID", "AWS_CONTAINER_AUTHORIZATION_TOKEN"];
/// Variables with credentials; without any, the machine needs a role of its own.
const CREDENTIALS: [&str; 6] = [
    "AWS_ACCESS_KEY_ID",
    "AWS_SECRET_ACCESS_KEY",
    "AWS_WEB_IDENTITY_TOKEN_FILE",
    "AWS_CONTAINER_CREDENTIALS_RELATIVE_URI",
    "AWS_CONTAINER_CREDENTIALS_FULL_URI",
    "AWS_SKIP_SIGNATURE",
];

/// Variables with the address of the store.
const ENDPOINTS: [&str; 3] = ["AWS_ENDPOINT_URL_S3", "AWS_ENDPOINT_URL", "AWS_ENDPOINT"];
/// A store's answer if the bucket is absent, not only the object.
const NO_BUCKET: &str = "NoSuchBucket";

/// The first requested object, which tests the client.
const FIRST: &str = "dataset.json";

#[derive(Debug)]
struct S3 {
    address: Address,
    root: PathBuf,
    runtime: Runtime,
    store: AmazonS3,
    /// Files that may be superseded.
    for_now: Mutex<BTreeMap<String, Bytes>>,
}

/// Connects to the store at `address`.
///
/// # Errors
/// Wrong settings in the environment, or a store that does not answer or refuses.
pub fn connect(address: &Address) -> io::Result<Arc<dyn Store>> {
    // encryption by ring; a second installation fails
    let _ = rustls::crypto::ring::default_provider().install_default();
    let runtime = Builder::new_current_thread().enable_all().build()?;
    let store = |retries| store(address, retries).map_err(|error| explained(address, &error));
    let root = PathBuf::from(address.to_string());
    let first = S3 { address: address.clone(), root, runtime, store: store(FIRST_RETRIES)?, for_now: Mutex::default() };
    first.object(FIRST)?;
    Ok(Arc::new(S3 { store: store(RETRIES)?, ..first }))
}

impl S3 {
    fn key(&self, name: &str) -> Key {
        Key::from(format!("{}/{name}", self.address.prefix))
    }

    fn object(&self, name: &str) -> io::Result<Option<Bytes>> {
        let key = self.key(name);
        match self.runtime.block_on(async { self.store.get(&key).await?.bytes().await }) {
            Ok(bytes) => Ok(Some(bytes)),
            Err(error @ Error::NotFound { .. }) if !error.to_string().contains(NO_BUCKET) => Ok(None),
            Err(error) => Err(explained(&self.address, &error)),
        }
    }

    /// Puts the object `name` if absent; returns a different existing content.
    fn create(&self, name: &str, bytes: &[u8]) -> io::Result<Option<Bytes>> {
        let (key, payload) = (self.key(name), Bytes::copy_from_slice(bytes));
        let mut last = None;
        for attempt in 0..ATTEMPTS {
            if attempt > 0 {
                std::thread::sleep(PAUSE * 2_u32.pow(attempt - 1));
            }
            let options = PutOptions { mode: PutMode::Create, ..PutOptions::default() };
            let put = self.store.put_opts(&key, payload.clone().into(), options);
            let error = match self.runtime.block_on(put) {
                Ok(_) => return Ok(None),
                Err(error @ (Error::AlreadyExists { .. } | Error::Generic { .. })) => error,
                Err(error) => return Err(explained(&self.address, &error)),
            };
            match self.object(name) {
                Ok(Some(there)) => return Ok(Some(there).filter(|there| there != bytes)),
                // refused in favour of another request that failed too
                Ok(None) if matches!(error, Error::AlreadyExists { .. }) => {
                    last = Some(explained(&self.address, &error));
                }
                // retried already, or permanent
                Ok(None) | Err(_) => return Err(explained(&self.address, &error)),
            }
        }
        Err(last.unwrap_or_else(|| io::Error::other("was not put")))
    }
}

impl Store for S3 {
    fn root(&self) -> &Path {
        &self.root
    }

    fn put(&self, name: &str, bytes: &[u8]) -> io::Result<()> {
        self.for_now.lock().unwrap_or_else(PoisonError::into_inner).remove(name);
        let Some(there) = self.create(name, bytes)? else { return Ok(()) };
        Err(io::Error::other(format!(
            "has another content (SHA-256 {}) than this process has for it (SHA-256 {}), and what is in a store is not \
            replaced: choose another --out; or, if that object is damaged, remove it, and the same command puts it \
            again",
            sha256(&there),
            sha256(bytes)
        )))
    }

    fn put_for_now(&self, name: &str, bytes: &[u8]) -> io::Result<()> {
        let mut for_now = self.for_now.lock().unwrap_or_else(PoisonError::into_inner);
        for_now.insert(name.to_owned(), Bytes::copy_from_slice(bytes));
        Ok(())
    }

    fn put_if_absent(&self, name: &str, bytes: &[u8]) -> io::Result<()> {
        self.create(name, bytes).map(|_| ())
    }

    fn get(&self, name: &str) -> io::Result<Vec<u8>> {
        let for_now = self.for_now.lock().unwrap_or_else(PoisonError::into_inner).get(name).cloned();
        let found = for_now.map_or_else(|| self.object(name), |bytes| Ok(Some(bytes)))?;
        Ok(found.ok_or(ErrorKind::NotFound)?.into())
    }

    fn list(&self, folder: &str) -> io::Result<Vec<Entry>> {
        let listed = self.runtime.block_on(self.store.list_with_delimiter(Some(&self.key(folder))));
        let listed = listed.map_err(|error| explained(&self.address, &error))?;
        let folders = listed.common_prefixes.iter().map(|key| (key, true, 0));
        let all = listed.objects.iter().map(|object| (&object.location, false, object.size)).chain(folders);
        let entry = |(key, is_folder, size): (&Key, bool, u64)| {
            Some(Entry { name: key.filename()?.to_owned(), is_folder, is_file: !is_folder, size })
        };
        let mut entries: Vec<Entry> = all.filter_map(entry).collect();
        entries.sort();
        Ok(entries)
    }

    fn remove(&self, _: &str) -> io::Result<()> {
        Ok(())
    }

    fn lock(&self, _: bool) -> Result<Option<File>, TryLockError> {
        Ok(None)
    }

    fn rename(&self, _: &Path) -> io::Result<()> {
        Err(ErrorKind::Unsupported.into())
    }

    fn replaces(&self) -> bool {
        false
    }
}

/// Meaning of `error` and remedy, without credentials.
fn explained(address: &Address, error: &Error) -> io::Error {
    let (text, cause) = (error.to_string(), cause(error));
    let text_of = match error {
        Error::NotFound { .. } if text.contains(NO_BUCKET) => {
            format!("there is no bucket `{}`: create it, or correct the address or AWS_ENDPOINT_URL", address.bucket)
        }
        Error::PermissionDenied { .. } | Error::Unauthenticated { .. } => format!(
            "refused ({cause}): check AWS_ACCESS_KEY_ID, AWS_SECRET_ACCESS_KEY and AWS_SESSION_TOKEN, and that they \
            may get, put and list objects below this address"
        ),
        Error::AlreadyExists { .. } => {
            format!("another process puts it again and again ({cause}); run the command again")
        }
        _ if CREDENTIALS.iter().all(|name| variable(name).is_none()) => format!(
            "no credentials: set AWS_ACCESS_KEY_ID and AWS_SECRET_ACCESS_KEY, or run the command where the machine has \
            a role of its own ({cause})"
        ),
        _ if ENDPOINTS.iter().filter_map(|name| variable(name)).any(|url| url.starts_with("http://"))
            && variable("AWS_ALLOW_HTTP").is_none() =>
        {
            format!("AWS_ENDPOINT_URL is not encrypted: AWS_ALLOW_HTTP=true allows that ({cause})")
        }
        _ => format!(
            "{cause}: check AWS_ENDPOINT_URL, AWS_REGION and the network; once the store answers, the same command \
            continues"
        ),
    };
    let values = SECRETS.iter().filter_map(|name| variable(name));
    io::Error::other(values.fold(text_of, |text, value| text.replace(&value, "***")))
}

fn variable(name: &str) -> Option<String> {
    std::env::var(name).ok().filter(|value| !value.is_empty())
}

/// The store's answer, or else the innermost reason.
fn cause(error: &Error) -> String {
    let text = error.to_string();
    let between = |start: &str, end: &str| Some(text.split_once(start)?.1.split_once(end)?.0.to_owned());
    if let Some(code) = between("<Code>", "</Code>") {
        return between("<Message>", "</Message>").map_or(code.clone(), |message| format!("{code}: {message}"));
    }
    if let Some(status) = between("non-2xx status code: ", ": ") {
        return status;
    }
    let mut innermost = error.source();
    while let Some(inner) = innermost.and_then(std::error::Error::source) {
        innermost = Some(inner);
    }
    innermost.map_or(text, ToString::to_string)
}

/// The store of `address` by the environment, with this number of retries.
fn store(address: &Address, max_retries: usize) -> Result<AmazonS3, Error> {
    let builder = AmazonS3Builder::from_env().with_bucket_name(&address.bucket);
    let timeout = AmazonS3ConfigKey::Client(ClientConfigKey::Timeout);
    let builder = if variable("AWS_TIMEOUT").is_some() { builder } else { builder.with_config(timeout, TIMEOUT) };
    let retry = RetryConfig { max_retries, retry_timeout: Duration::from_secs(120), ..RetryConfig::default() };
    builder.with_retry(retry).build()
}
