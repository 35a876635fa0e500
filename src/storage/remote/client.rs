//! [`connect`]: requests to the store of an address, and what their errors mean. A part of the library with the feature
//! `cloud`, and of the Python package.
//!
//! The crate `object_store` tries a request again that the store could not answer (5xx, 429, a connection that broke).
//! An object that is put on the condition that there is none of its name needs more: an answer that was lost, 409 and
//! 412 all leave open what is there. So it is looked at: the same content is success, whoever has put it; nothing is a
//! reason to try again; anything else is the caller's.

use std::error::Error as _;
use std::io;
use std::time::Duration;

use object_store::aws::{AmazonS3, AmazonS3Builder, AmazonS3ConfigKey};
use object_store::path::Path as Key;
use object_store::{ClientConfigKey, Error, ObjectStore, ObjectStoreExt, PutMode, PutOptions, RetryConfig};
use tokio::runtime::{Builder, Runtime};

use super::address::{Address, Connected, Objects};

/// How often a request is tried again: with pauses up to 15 s, some minute in all.
const RETRIES: usize = 10;
/// The same of the first request, which finds out that something is set wrong.
const FIRST_RETRIES: usize = 3;
/// How often an object is put that was not taken and is not there.
const ATTEMPTS: u32 = 8;
/// The pause before the second of these attempts; each later one is twice as long.
const PAUSE: Duration = Duration::from_millis(50);
/// How long a request may take, where `AWS_TIMEOUT` does not say: a part of 50 MB at 0.2 MB/s.
const TIMEOUT: &str = "250 seconds";
/// Variables whose values are in no message.
const SECRETS: [&str; 4] =
    ["AWS_SECRET_ACCESS_KEY", "AWS_SESSION_TOKEN", "AWS_ACCESS_KEY_ID", "AWS_CONTAINER_AUTHORIZATION_TOKEN"];
/// Variables by which credentials are found; without any, the machine has to have a role of its own.
const CREDENTIALS: [&str; 6] = [
    "AWS_ACCESS_KEY_ID",
    "AWS_SECRET_ACCESS_KEY",
    "AWS_WEB_IDENTITY_TOKEN_FILE",
    "AWS_CONTAINER_CREDENTIALS_RELATIVE_URI",
    "AWS_CONTAINER_CREDENTIALS_FULL_URI",
    "AWS_SKIP_SIGNATURE",
];

/// Variables that say where the store is.
const ENDPOINTS: [&str; 3] = ["AWS_ENDPOINT_URL_S3", "AWS_ENDPOINT_URL", "AWS_ENDPOINT"];
/// What a store says where the bucket is not there, and not only the object.
const NO_BUCKET: &str = "NoSuchBucket";

/// The objects below an address, each by its name below that.
struct Client {
    address: Address,
    runtime: Runtime,
    store: AmazonS3,
}

/// The client for `address`, and the content of the object `first`, if there is one: so it is known to work.
///
/// # Errors
/// Where the environment does not say how to get there, or the store does not answer, or refuses.
pub fn connect(address: &Address, first: &str) -> io::Result<Connected> {
    // connections are encrypted by ring; it is an error to say so twice
    let _ = rustls::crypto::ring::default_provider().install_default();
    let runtime = Builder::new_current_thread().enable_all().build()?;
    let store = |retries| store(address, retries).map_err(|error| said(address, &error));
    let client = Client { address: address.clone(), runtime, store: store(FIRST_RETRIES)? };
    let found = client.get(first)?;
    Ok((Box::new(Client { store: store(RETRIES)?, ..client }), found))
}

impl Client {
    fn key(&self, name: &str) -> Key {
        Key::from(format!("{}/{name}", self.address.prefix))
    }
}

impl Objects for Client {
    fn create(&self, name: &str, bytes: &[u8]) -> io::Result<Option<Vec<u8>>> {
        let key = self.key(name);
        let mut last = None;
        for attempt in 0..ATTEMPTS {
            if attempt > 0 {
                std::thread::sleep(PAUSE * 2_u32.pow(attempt - 1));
            }
            let options = PutOptions { mode: PutMode::Create, ..PutOptions::default() };
            let payload = bytes.to_vec().into();
            let error = match self.runtime.block_on(self.store.put_opts(&key, payload, options)) {
                Ok(_) => return Ok(None),
                Err(error @ (Error::AlreadyExists { .. } | Error::Generic { .. })) => error,
                Err(error) => return Err(said(&self.address, &error)),
            };
            match self.get(name) {
                Ok(Some(there)) if there == bytes => return Ok(None),
                Ok(Some(there)) => return Ok(Some(there)),
                // refused for another one's sake that did not put it either
                Ok(None) if matches!(error, Error::AlreadyExists { .. }) => last = Some(said(&self.address, &error)),
                // it was tried again already, or is an error that stays
                Ok(None) | Err(_) => return Err(said(&self.address, &error)),
            }
        }
        Err(last.unwrap_or_else(|| io::Error::other("was not put")))
    }

    fn get(&self, name: &str) -> io::Result<Option<Vec<u8>>> {
        let key = self.key(name);
        let got = self.runtime.block_on(async { self.store.get(&key).await?.bytes().await });
        match got {
            Ok(bytes) => Ok(Some(bytes.into())),
            Err(error @ Error::NotFound { .. }) if !error.to_string().contains(NO_BUCKET) => Ok(None),
            Err(error) => Err(said(&self.address, &error)),
        }
    }

    fn list(&self, folder: &str) -> io::Result<Vec<String>> {
        let listed = self.runtime.block_on(self.store.list_with_delimiter(Some(&self.key(folder))));
        let objects = listed.map_err(|error| said(&self.address, &error))?.objects;
        let name = |location: &Key| location.filename().map(|file| format!("{folder}/{file}"));
        Ok(objects.iter().filter_map(|object| name(&object.location)).collect())
    }
}

/// What `error` means, and what to do; without a word of the credentials.
fn said(address: &Address, error: &Error) -> io::Error {
    let (text, cause) = (error.to_string(), cause(error));
    let said = match error {
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
    io::Error::other(values.fold(said, |said, value| said.replace(&value, "***")))
}

/// The value of a variable of the environment that is set.
fn variable(name: &str) -> Option<String> {
    std::env::var(name).ok().filter(|value| !value.is_empty())
}

/// What the store answered, or else the innermost reason.
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

/// The store of `address`, as the environment says; each request is tried again so often.
fn store(address: &Address, max_retries: usize) -> Result<AmazonS3, Error> {
    let builder = AmazonS3Builder::from_env().with_bucket_name(&address.bucket);
    let timeout = AmazonS3ConfigKey::Client(ClientConfigKey::Timeout);
    let builder = if variable("AWS_TIMEOUT").is_some() { builder } else { builder.with_config(timeout, TIMEOUT) };
    let retry = RetryConfig { max_retries, retry_timeout: Duration::from_secs(120), ..RetryConfig::default() };
    builder.with_retry(retry).build()
}
