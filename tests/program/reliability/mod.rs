//! Whatever happens to processes, disks and files, the bytes are the same or an error names the reason.

pub mod altered_results;
pub mod cluster_recipes;
pub mod derived_files;
pub mod extremes;
pub mod failing_store;
pub mod false_rows;
pub mod faults;
pub mod hostile_files;
pub mod interrupted;
#[cfg(target_os = "linux")]
pub mod power_loss;
pub mod read_faults;
pub mod replaced;
pub mod shared_folders;
pub mod sizes;
pub mod strays;
pub mod threads_and_shards;
