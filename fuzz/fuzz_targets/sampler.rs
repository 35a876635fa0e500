//! Any parameters of distributions, designs and correlations: errors, or samples that do not depend on the order in
//! which they are drawn.

#![no_main]

use libfuzzer_sys::fuzz_target;
use spindrift::campaign::{Overrides, Plan, SceneDraws};
use spindrift::sampling::SampleId;
use spindrift_fuzz::campaign;

/// What a campaign needs beside the tables of draws.
const SAMPLED: &str = "name = \"draws\"\nsamples = 25";

fuzz_target!(|data: &[u8]| {
    let Ok(text) = std::str::from_utf8(data) else { return };
    // other tables are those of the target for campaign files
    if ["[campaign", "[body", "[initial", "[observe", "[stop", "file"].iter().any(|word| text.contains(word)) {
        return;
    }
    let Ok(plan) = Plan::from_text("fuzz.toml", &format!("{}{text}", campaign(SAMPLED)), Overrides::default()) else {
        return;
    };
    let samples: Vec<u64> = [0, 1, 7, 8, 15, 24].into_iter().filter(|sample| *sample < plan.samples).collect();
    let draw = |draws: &mut SceneDraws<'_>, sample: u64| {
        let is_physical = draws.scene(SampleId(sample)).is_ok();
        (is_physical, draws.applied().iter().map(|value| value.to_bits()).collect::<Vec<u64>>())
    };
    let mut draws = SceneDraws::new(&plan);
    let forward: Vec<_> = samples.iter().map(|sample| draw(&mut draws, *sample)).collect();
    let mut backward: Vec<_> = samples.iter().rev().map(|sample| draw(&mut draws, *sample)).collect();
    backward.reverse();
    assert_eq!(forward, backward, "a draw depends on the draws before it");
});
