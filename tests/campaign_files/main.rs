//! Campaign files: what is read, what is refused, and the messages.

mod bad_campaigns;
mod bad_dispersions;
mod shipped;
