//! The program as a user runs it: commands, files, audits, columns.

#![allow(clippy::disallowed_methods)] // digits of no row: the elementary functions of the platform will do

#[path = "../support/mod.rs"]
mod support;

mod commands;
mod loops;
mod observables;
mod page;
mod reliability;
mod results;
mod small_campaign;
mod views;

mod prelude {
    pub(crate) use crate::{
        commands::screen_numbers::says,
        loops::{
            closed_loops::plan,
            flown_loop::{FlownLoop, changed, rotation_vector, without_filters},
        },
        page::numbers::{Found, degrees, found, motion},
        small_campaign::{NEGATIVE_WALLS, campaign, campaign_without_debris, folder, mixed_failures, sized},
        support::prelude::*,
    };
}
