//! The program as a user runs it: commands, files, audits, columns.

#![allow(clippy::disallowed_methods)] // digits of no row: the elementary functions of the platform will do

#[path = "../support/mod.rs"]
mod support;

mod absent_values;
mod altered_results;
mod audit;
mod audit_limit;
mod band_requirements;
mod campaign_command;
mod closed_loops;
mod columns_command;
mod commands;
mod compare_command;
mod control_laws;
mod derived_files;
mod drivers;
mod exit_codes;
mod extremes;
mod failed_again;
mod failed_runs;
mod false_manifests;
mod faults;
mod faulty_storage;
mod flown_loop;
mod hostile_files;
mod interrupted;
mod judged_columns;
mod loop_actuators;
mod loop_authority;
mod loop_cases;
mod loop_columns;
mod loop_filters;
mod loop_ignorance;
mod loop_laws;
mod loop_noise;
mod loop_phases;
mod loop_sensors;
mod loop_series;
mod loop_ticks;
mod lost_runs;
mod mass_properties;
mod memory;
mod missions;
mod motion;
mod observation;
mod observation_columns;
mod observation_golden;
mod observed_tables;
mod page_cards;
mod page_marks;
mod page_numbers;
mod page_runs;
mod page_series;
#[cfg(target_os = "linux")]
mod power_loss;
mod precision;
mod read_faults;
mod recipes;
mod replaced;
mod report_page;
mod requirements;
mod result_files;
mod retained;
mod screen_numbers;
mod shared_folders;
mod simulate_command;
mod sizes;
mod slurm;
mod small_campaign;
mod statistics;
mod stopping;
mod strays;
mod table_log;
mod threads_and_shards;
