//! The programs in `examples/` run to their end.

#[path = "../../examples/campaign_in_memory.rs"]
mod campaign_in_memory;
#[path = "../../examples/control_campaign.rs"]
mod control_campaign;
#[path = "../../examples/control_law.rs"]
mod control_law;
#[path = "../../examples/one_run.rs"]
mod one_run;

#[test]
fn one_run_ends() {
    one_run::main();
}

#[test]
fn a_campaign_under_a_law_ends() {
    control_campaign::main();
}

#[test]
fn a_closed_loop_ends() {
    control_law::main();
}

#[test]
fn a_campaign_in_memory_ends() {
    campaign_in_memory::main();
}
