//! Mass, centre of mass and principal moments of every sample, as dispersed.

use crate::prelude::*;
use spindrift::campaign::draw;
use spindrift::scene::MassProperties;

/// A third of the walls of [`plan`] is not physical.
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

/// Law: the columns are the mass properties of the drawn scene, with ascending principal moments.
#[test]
fn columns_are_those_of_the_scene() {
    let plan = plan();
    let table = rows(&plan);
    let columns: Vec<_> = table.columns().collect();
    assert_eq!(columns.len(), 7);
    let nominal = columns[4..].iter().map(|(_, column)| column[0]);
    for (value, expected) in nominal.zip([1687.2800329075988, 3054.590970145349, 3055.375141124116]) {
        assert!((value / expected - 1.0).abs() < 1e-15, "{value} {expected}");
    }
    assert!(!Group::DEFAULT.contains(&Group::MassProperties), "only where a file names it");
    let (mut valid, mut masses) = (0, Vec::new());
    for row in 0..SAMPLES {
        let value = |name: &str| table.column(name)[row];
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

fn nominal(tables: &str) -> MassProperties {
    let head = "[campaign]\nname = \"mass\"\nsamples = 1\nseed = 1\nduration_s = 1.0\n\
        [initial]\nangular_velocity_rad_s = [0.1, 0.2, 0.3]\n";
    let text = format!("{head}{tables}");
    let plan = planned(&text);
    draw(&plan, SampleId(0)).unwrap().mass
}

fn assert_same(found: &MassProperties, mass: f64, center: [f64; 3], inertia: [[f64; 3]; 3], what: &str) {
    let largest = inertia[0][0] + inertia[1][1] + inertia[2][2];
    assert!((found.total / mass - 1.0).abs() < 1e-14, "{what}: {} kg for {mass}", found.total);
    for i in 0..3 {
        // measured: 2e-16 and 1e-15
        assert!((found.center[i] - center[i]).abs() < 1e-14, "{what}: {:?} for {center:?}", found.center);
        for j in 0..3 {
            let off = (found.inertia[i][j] - inertia[i][j]).abs();
            assert!(off < 1e-14 * largest, "{what}: {:?} for {inertia:?}", found.inertia);
        }
    }
}

type Matrix = nalgebra::Matrix3<f64>;

/// Errors of a distribution of mass, one alone and all together: logarithms of scales along the axes, and shears.
const ERRORS: [([f64; 3], [f64; 3]); 8] = [
    ([0.2, 0.0, 0.0], [0.0; 3]),
    ([0.0, -0.1, 0.0], [0.0; 3]),
    ([0.0, 0.0, 0.3], [0.0; 3]),
    ([0.0; 3], [0.25, 0.0, 0.0]),
    ([0.0; 3], [0.0, -0.5, 0.0]),
    ([0.0; 3], [0.0, 0.0, 0.125]),
    ([0.0; 3], [0.0; 3]),
    ([0.2, -0.1, 0.3], [0.25, -0.5, 0.125]),
];

fn moved(([sx, sy, sz], [xy, xz, yz]): ([f64; 3], [f64; 3]), [x, y, z]: [f64; 3]) -> [f64; 3] {
    [sx.exp() * x, sy.exp() * y + xy * x, sz.exp() * z + xz * x + yz * y]
}

#[test]
fn mass_errors_move_point_masses() {
    const POINTS: [(f64, [f64; 3]); 3] = [(2.0, [1.0, 0.3, -0.2]), (3.0, [-0.4, 0.9, 0.5]), (1.5, [0.2, -0.6, 1.1])];
    const CENTER: [f64; 3] = [0.5, -0.25, 1.0];
    let points = |errors: ([f64; 3], [f64; 3])| -> String {
        let mut text = String::new();
        for (number, (mass, offset)) in POINTS.into_iter().enumerate() {
            for (side, sign) in [("a", 1.0), ("b", -1.0)] {
                let r = moved(errors, offset);
                let position: [f64; 3] = from_fn(|i| CENTER[i] + sign * r[i]);
                text += &format!(
                    "[[body.parts]]\nname = \"p{side}{number}\"\nshape = \"point_mass\"\nmass_kg = \
                    {mass:?}\nposition_m = {position:?}\n"
                );
            }
        }
        text
    };
    let none = ([0.0; 3], [0.0; 3]);
    for errors in ERRORS {
        let (scale_log, shear) = errors;
        let found = nominal(&format!("[body]\nstretch_log = {scale_log:?}\nshear = {shear:?}\n{}", points(none)));
        let expected = nominal(&points(errors));
        assert_same(&found, expected.total, CENTER, expected.inertia, &format!("{errors:?}"));
    }
}

/// Law: a body that includes its wheels has mass, centre and inertia as written, whatever the wheels do.
#[test]
fn what_includes_the_wheels_is_the_whole() {
    const MASS: f64 = 500.0;
    const CENTER: [f64; 3] = [0.1, -0.05, 0.3];
    const INERTIA: [[f64; 3]; 3] = [[120.0, -3.0, 1.0], [-3.0, 150.0, 2.0], [1.0, 2.0, 90.0]];
    const SCALE: [f64; 2] = [1.02, 0.97];
    const OFFSET: [f64; 3] = [0.01, -0.02, 0.03];
    let modes = ["free", "speed_held", "locked"];
    for errors in ERRORS {
        let (scale_log, shear) = errors;
        let inertia = Matrix::from_fn(|i, j| INERTIA[i][j]);
        let second = Matrix::identity() * (0.5 * inertia.trace()) - inertia;
        let columns = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|axis| moved(errors, axis));
        let map = Matrix::from_fn(|i, j| columns[j][i]);
        let second = SCALE[0] * SCALE[1] * map * second * map.transpose();
        let expected = Matrix::identity() * second.trace() - second;
        for combination in 0..27 {
            let mut text = format!(
                "[body]\nmass_kg = {MASS:?}\ncenter_of_mass_m = {CENTER:?}\ninertia_kg_m2 = \
                {INERTIA:?}\nincludes_wheels = true\n\
                mass_scale = {:?}\ninertia_scale = {:?}\nstretch_log = {scale_log:?}\nshear = \
                {shear:?}\ncenter_offset_m = {OFFSET:?}\n",
                SCALE[0], SCALE[1]
            );
            for wheel in 0..3usize {
                let mode = modes[combination / 3usize.pow(wheel as u32) % 3];
                let axis: [f64; 3] = from_fn(|i| if i == wheel { 1.0 } else { 0.25 });
                let position: [f64; 3] = from_fn(|i| if i == wheel { 0.2 } else { -0.1 });
                text += &format!(
                    "[[wheels]]\nname = \"w{wheel}\"\naxis = {axis:?}\nposition_m = {position:?}\nmass_kg = {}.0\n\
                    axial_inertia_kg_m2 = 0.5\ntransverse_inertia_kg_m2 = 0.3\nmode = {mode:?}\n",
                    10 + 5 * wheel
                );
            }
            let center = from_fn(|i| CENTER[i] + OFFSET[i]);
            let entries = from_fn(|i| from_fn(|j| expected[(i, j)]));
            assert_same(&nominal(&text), SCALE[0] * MASS, center, entries, &text);
        }
    }
}
