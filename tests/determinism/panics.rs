//! A panic of the program is the end of one run.

use crate::prelude::*;
use spindrift::propagation::{CompletionCallback, Engine};

/// An engine that panics at spins above [`TOO_FAST`], before the last run of a batch ends.
struct Fragile(Box<dyn Engine>);

const TOO_FAST: f64 = 34.5;

fn is_too_fast(scene: &Scene) -> bool {
    scene.initial.omega_se_s[2] > TOO_FAST
}

impl Engine for Fragile {
    fn propagate_under(&mut self, laws: Laws<'_>, scenes: &[Scene], finish: &mut CompletionCallback<'_>) {
        let sound = scenes.iter().position(is_too_fast).unwrap_or(scenes.len());
        self.0.propagate_under(laws, &scenes[..sound], finish);
        assert!(sound == scenes.len(), "a spin of more than {TOO_FAST} rad/s");
    }
}

#[test]
fn a_panic_ends_one_run() {
    const RUNS: usize = 400;
    let plan = shipped("spin_sweep", None);
    let part = Part { id: PartId(0), first: SampleId(0), count: RUNS };
    let rows_of = |ensemble: &Ensemble<'_>| {
        let mut rows = ensemble.rows(RUNS);
        ensemble.worker().run(part, &mut rows, Supervision::progress(&|_| {}));
        rows
    };
    let ensemble = Ensemble::new(&plan, Isa::best());
    let sound = rows_of(&ensemble);
    let fragile = rows_of(
        &Ensemble::new(&plan, Isa::best()).with_engines(|settings, isa| Box::new(Fragile(settings.engine(isa)))),
    );
    let mut draws = SceneDraws::new(&plan);
    let mut failed = 0;
    for row in 0..RUNS {
        let is_failed = is_too_fast(&draws.scene(SampleId(row as u64)).unwrap());
        let expected = if is_failed { Status::InternalError } else { sound.statuses()[row] };
        assert_eq!(fragile.statuses()[row], expected, "row {row}");
        for index in (0..ensemble.shape().observables).filter(|_| !is_failed) {
            let (found, expected) = (fragile.observable(index)[row], sound.observable(index)[row]);
            assert_eq!(found.to_bits(), expected.to_bits(), "row {row}, column {index}");
        }
        if is_failed {
            failed += 1;
            let (_, reason) = fragile.reasons().iter().find(|(at, _)| *at == row).unwrap();
            assert_says(reason, ["34.5 rad/s"]);
        }
    }
    assert!((2..40).contains(&failed), "{failed} of {RUNS}");
    let counted = |rows: &Rows| rows.bands().unwrap().runs()[0];
    assert_eq!(counted(&fragile) + failed, counted(&sound));
}
