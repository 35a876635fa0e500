//! Campaign files: what is read, what is refused, and in which words.

mod bad_campaigns;
mod bad_dispersions;
mod shipped;
