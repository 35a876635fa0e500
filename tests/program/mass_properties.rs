//! The group `mass_properties`: mass, centre of mass and principal moments of every sample, as dispersed.

use spindrift::campaign::{Overrides, Plan, draw};
use spindrift::ensemble::{Ensemble, Part, PartId, Rows, Supervision};
use spindrift::math::Isa;
use spindrift::observables::Group;
use spindrift::sampling::SampleId;

use super::small_campaign::{NEGATIVE_WALLS, campaign};

/// A density, a position of a wheel, and walls: a third of these is not physical.
const DISPERSED: &str = r#"
[[disperse]]
parameter = "body.parts.fuselage.density_kg_m3"
distribution = "uniform"
min = 2600.0
max = 2800.0
[[disperse]]
parameter = "wheels.w1.position_m"
distribution = "normal"
std = [0.01, 0.02, 0.03]
"#;

const SAMPLES: usize = 64;

fn plan() -> Plan {
    let text = [&campaign(), NEGATIVE_WALLS, DISPERSED].concat();
    let plan = Plan::from_text("mass", &text, Overrides { samples: Some(SAMPLES as u64), ..Overrides::default() });
    Plan { groups: vec![Group::MassProperties], ..plan.unwrap() }
}

/// Law: the columns are the mass properties of the scene of the sample, with principal moments in ascending order that keep trace and determinant
/// of the inertia; a sample that is not physical has none.
#[test]
fn columns_are_those_of_the_scene() {
    let plan = plan();
    let ensemble = Ensemble::new(&plan, Isa::best());
    let mut rows: Rows = ensemble.rows(SAMPLES);
    let part = Part { id: PartId(0), first: SampleId(0), count: SAMPLES };
    ensemble.worker().run(part, &mut rows, Supervision::progress(&|_| {}));
    let names: Vec<String> =
        ensemble.request().columns().iter().map(|column| column.quantity.name().to_owned()).collect();
    assert_eq!(names.len(), 7, "{names:?}");
    let (mut valid, mut masses) = (0, Vec::new());
    for row in 0..SAMPLES {
        let value = |name: &str| rows.observable(names.iter().position(|known| known == name).unwrap())[row];
        let moments = ["smallest", "middle", "largest"].map(|which| value(&format!("principal_moment_{which}_kg_m2")));
        let Ok(scene) = draw(&plan, SampleId(row as u64)) else {
            assert!(value("mass_kg").is_nan() && moments.iter().all(|moment| moment.is_nan()));
            continue;
        };
        valid += 1;
        let mass = &scene.mass;
        masses.push(value("mass_kg").to_bits());
        assert_eq!(value("mass_kg").to_bits(), mass.total.to_bits());
        assert_eq!(["x", "y", "z"].map(|axis| value(&format!("center_of_mass_{axis}_m"))), mass.center);
        let [[a, b, c], [_, d, e], [_, _, f]] = mass.inertia;
        let determinant = a * (d * f - e * e) - b * (b * f - c * e) + c * (b * e - c * d);
        assert!(moments.is_sorted() && moments[0] > 0.0, "{moments:?}");
        assert!((moments.iter().sum::<f64>() / (a + d + f) - 1.0).abs() < 1e-15);
        assert!((moments.iter().product::<f64>() / determinant - 1.0).abs() < 1e-14);
    }
    assert!((30..SAMPLES).contains(&valid), "{valid}");
    masses.sort_unstable();
    masses.dedup();
    assert_eq!(masses.len(), valid, "every sample has a mass of its own");
}

/// The spacecraft of the report (nominal, without dispersions): the check values of its model, and `motion` and `mass_properties` only where a
/// file names them.
#[test]
fn the_nominal_sample_has_the_check_values() {
    let plan = plan();
    let scene = draw(&plan, SampleId(0)).unwrap();
    let ensemble = Ensemble::new(&plan, Isa::best());
    let mut rows = ensemble.rows(1);
    let part = Part { id: PartId(0), first: SampleId(0), count: 1 };
    ensemble.worker().run(part, &mut rows, Supervision::progress(&|_| {}));
    let found: Vec<f64> = (0..7).map(|index| rows.observable(index)[0]).collect();
    assert_eq!(found[0], scene.mass.total);
    for (value, expected) in found[4..].iter().zip([1687.2800329075988, 3054.590970145349, 3055.375141124116]) {
        assert!((value / expected - 1.0).abs() < 1e-15, "{value} {expected}");
    }
    assert!(!Group::DEFAULT.contains(&Group::MassProperties));
}
