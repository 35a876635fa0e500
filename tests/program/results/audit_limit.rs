//! The limit of the work of an audit, and progress within a part.

use crate::prelude::*;

use spindrift::ensemble::{Auditor, NoAudit};
use spindrift::storage::rows_file::AUDIT_REASON;

fn with_debris_rate(rate: f64) -> String {
    let text = sized(6);
    let text = text.replace("= [100, 0, 0]", &format!("= [{rate:?}, 0, 0]"));
    format!("{text}[audit]\nfraction = 1.0\n")
}

#[test]
fn an_audit_has_a_limit() {
    let scratch = folder("audit-limit");
    // the limit is of the debris alone, and below it nothing is refused
    for (rate, is_within) in [(8000.0, true), (40_000.0, false)] {
        let plan = planned(&with_debris_rate(rate));
        let scene = resolved(&plan.nominal);
        let found = Auditor::new(&plan, Isa::best(), &plan.grid).audit(&scene);
        assert_eq!(found.is_ok(), is_within, "{rate}: {found:?}");
        assert!(is_within || matches!(found, Err(NoAudit::Limit { units, body: "debris", .. }) if units > 16_384.0));
    }
    for (rate, is_audited) in [(100.0, true), (1e7, false)] {
        scratch.file("fast.toml", &with_debris_rate(rate));
        scratch.prints("campaign fast.toml --out r --overwrite", 0);
        let rows = &scratch.table("r/runs/part-000000.parquet");
        let reasons = texts(rows, AUDIT_REASON);
        let errors = rows.column_by_name("audit_state_error").unwrap().as_primitive::<Float64Type>();
        for row in 0..6 {
            assert_eq!((errors.is_valid(row), reasons.is_null(row)), (is_audited, is_audited), "{rate}, row {row}");
        }
        if !is_audited {
            let expected = "units of time (powers of two near the inverse of its rate), more than the 16384";
            assert!(reasons.iter().flatten().all(|reason| reason.contains(expected)), "{}", reasons.value(0));
            scratch.shows("simulate fast.toml --audit", 0, "sample 0 has no audit: the debris turns for");
        }
    }
}

fn nowhere(_: &Rows) -> Result<(), String> {
    Ok(())
}

fn told(text: &str) -> Vec<u64> {
    let plan = planned(text);
    let told = Mutex::new(Vec::new());
    let progress = |samples| told.lock().unwrap().push(samples);
    let ensemble = Ensemble::new(&plan, Isa::best());
    run(&ensemble, Parts::of(plan.samples), NonZeroUsize::new(1), &nowhere, Supervision::progress(&progress)).unwrap();
    told.into_inner().unwrap()
}

/// Law: of long runs, and of audited ones, progress is told within a batch; of short ones once for a batch.
#[test]
fn progress_is_told_within_a_batch() {
    let short = sized(64).replace("duration_s = 1.0", "duration_s = 0.001");
    let long = short.replace("duration_s = 0.001", "duration_s = 10.0").replace("\"auto\"", "\"runge_kutta_4\"");
    let long = long.replace("tolerance = 1e-10", "step_s = 0.001");
    let audited = format!("{short}[audit]\nfraction = 1.0\n");
    for (text, expected) in [(&short, 1), (&long, 64), (&audited, 64)] {
        let told = told(text);
        assert_eq!((told.len(), told.iter().sum::<u64>()), (expected, 64), "{told:?}");
    }
}
