//! `spindrift compare`: equal results, results of other methods, seeds and plans; what is beyond the tolerance.

use super::small_campaign::{NEGATIVE_WALLS, campaign, campaign_without_debris, folder};
use crate::support::scratch_folder::ended;

/// Law: the same campaign has no shift, also from other files; another method on the same samples is compared pair by pair and differs
/// by rounding only; another seed is compared as independent samples.
#[test]
fn results_are_compared() {
    let scratch = folder("compare");
    scratch.prints("campaign small.toml --out a", 0);
    scratch.prints("campaign small.toml --out b --threads 1", 0);
    let said = scratch.prints("compare a b --tolerance 0", 0);
    for words in
        ["the plans are the same", "599 samples were drawn alike", "have the same statistics", "PASS: no shift"]
    {
        assert!(said.contains(words), "{words}: {said}");
    }

    let other = campaign().replace("method = \"auto\"", "method = \"dop853\"");
    scratch.file("other.toml", &other);
    scratch.prints("campaign other.toml --out c", 0);
    let said = scratch.prints("compare a c --tolerance 0", 3);
    assert!(said.contains("1 keys differ\n    integrator.method: \"auto\" | \"dop853\""), "{said}");
    assert!(said.contains("599 samples were drawn alike") && said.contains("FAIL: a shift is beyond 0.0"), "{said}");
    assert!(said.contains("steps "), "other methods take other steps: {said}");

    scratch.prints("campaign small.toml --seed 8 --out d", 0);
    let said = scratch.prints("compare a d", 0);
    assert!(said.contains("campaign.seed: 7 | 8") && said.contains("compared as independent samples"), "{said}");
    // a hundredth of the spread is less than chance makes of 599 runs
    scratch.prints("compare a d --tolerance 0.01", 3);

    // fewer samples of the same draws are pairs too
    scratch.prints("campaign small.toml --samples 300 --out e", 0);
    let said = scratch.prints("compare a e", 0);
    assert!(said.contains("299 samples were drawn alike") && said.contains("campaign.samples: 600 | 300"), "{said}");

    // chosen samples are paired with the samples of the same numbers, whichever rows these are
    scratch.file("chosen.toml", &campaign().replace("[campaign]", "[campaign]\nonly = [7, 8, 11, 250]"));
    scratch.prints("campaign chosen.toml --out f", 0);
    for (results, pairs) in [("a f", 4), ("f a", 4), ("f e", 4), ("f f", 4)] {
        let said = scratch.prints(&format!("compare {results}"), 0);
        assert!(said.contains(&format!("{pairs} samples were drawn alike")), "{results}: {said}");
    }

    scratch.prints("compare a nothing", 2);
    scratch.prints("compare a b --tolerance -1", 2);
    std::fs::write(scratch.path("b/runs/part-000001.parquet"), "damaged").expect("written");
    let said = scratch.prints("compare a b", 4);
    assert!(said.contains("part-000001.parquet"), "{said}");
}

/// Law: a share of ok runs that is shifted by more than the tolerance is beyond it, also where the runs that are ok are the same.
#[test]
fn failures_alone_are_a_shift() {
    let scratch = folder("compare-failures");
    let thin = campaign_without_debris() + NEGATIVE_WALLS;
    scratch.file("thin.toml", &thin);
    scratch.prints("campaign thin.toml --out all --no-report", 1);
    let dispersed = ended(&scratch.rows("all")).into_iter().skip(1);
    let ok: Vec<u64> = dispersed.filter(|(_, status)| status == "ok").map(|(sample, _)| sample).collect();
    scratch.file("ok.toml", &thin.replace("[campaign]", &format!("[campaign]\nonly = {ok:?}")));
    scratch.prints("campaign ok.toml --out ok --no-report", 0);
    let failed = 1.0 - ok.len() as f64 / 599.0;
    assert!((0.2..0.5).contains(&failed), "{failed}");
    for (share, code) in [(0.99, 3), (1.01, 0)] {
        scratch.prints(&format!("compare all ok --tolerance {}", share * failed), code);
    }
}
