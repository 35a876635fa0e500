//! [`Client`] in a build without the feature `cloud`: there is none.

use std::convert::Infallible;
use std::io;

use super::Address;

pub struct Client(Infallible);

impl Client {
    pub fn open(address: &Address, _first: &str) -> io::Result<(Client, Option<Vec<u8>>)> {
        Err(io::Error::other(format!("{address}: this build of spindrift has no object stores")))
    }

    pub fn create(&self, _name: &str, _bytes: &[u8]) -> io::Result<Option<Vec<u8>>> {
        match self.0 {}
    }

    pub fn get(&self, _name: &str) -> io::Result<Option<Vec<u8>>> {
        match self.0 {}
    }

    pub fn list(&self, _folder: &str) -> io::Result<Vec<String>> {
        match self.0 {}
    }
}
