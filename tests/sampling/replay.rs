//! The recorded values of a sample, written into a campaign file, give the same scene and columns, bit for bit.

use crate::prelude::*;
use spindrift::campaign::draw;

const SAMPLES: u64 = 24;
const RUN: u64 = 3;

fn written_again(plan: &Plan, sample: SampleId) -> Plan {
    let mut draws = SceneDraws::new(plan);
    draws.scene(sample).unwrap();
    let mut again = plan.clone();
    for (column, value) in plan.dispersions.columns().iter().zip(draws.applied()) {
        column.parameter.set(&mut again.nominal, column.component, *value);
    }
    again.samples = 1;
    again.design = Design::DEFAULT;
    again.dispersed.clear();
    again.correlated.clear();
    again.derived.clear();
    planned(&again.text())
}

#[test]
fn recorded_values_written_as_a_nominal_scene_give_the_same_columns() {
    let isa = Isa::best();
    let mut with_attitude = 0;
    for file in files() {
        let plan = Plan::load(&file, Overrides::default()).unwrap();
        with_attitude += u32::from(plan.dispersions.columns().iter().any(|column| column.parameter.width() == 4));
        for sample in (1..plan.samples.min(SAMPLES + 1)).map(SampleId) {
            let again = written_again(&plan, sample);
            let drawn = draw(&plan, sample).unwrap();
            assert_eq!(draw(&again, SampleId(0)).unwrap(), drawn, "{} {sample}", file.display());
            // the nominal scene is what flight software knows: another one is another loop
            if sample.0 <= RUN && plan.law.is_none() {
                let row = |plan, sample| {
                    let run = SingleRun::new(plan, sample, again.grid.clone(), isa).unwrap();
                    let columns = run.request.columns();
                    let compared =
                        columns.iter().map(|column| !column.quantity.name().starts_with("attitude_from_nominal"));
                    let values = run.row.iter().zip(compared).filter(|(_, compared)| *compared);
                    values.map(|(value, _)| value.to_bits()).collect::<Vec<_>>()
                };
                assert_eq!(row(&again, SampleId(0)), row(&plan, sample), "{} {sample}", file.display());
            }
        }
    }
    assert!(with_attitude >= 2, "campaigns that disperse an attitude");
}
