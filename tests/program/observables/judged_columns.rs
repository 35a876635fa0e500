//! Columns that judge a run by a limit, on both sides of it.

use crate::prelude::*;

use crate::support::plans::Table;

fn table(text: &str) -> Table {
    rows(&planned(text))
}

fn coaxial(second: f64) -> Table {
    let wheel = |name: &str, position: f64| {
        format!(
            "[[wheels]]\nname = {name:?}\naxis = [0, 0, 1]\nposition_m = [0, 0, {position:?}]\nmass_kg = 10\n\
            axial_inertia_kg_m2 = 0.5\ntransverse_inertia_kg_m2 = 0.3\nrate_rad_s = 20\n"
        )
    };
    table(&format!(
        "[campaign]\nname = \"coaxial\"\nsamples = 1\nseed = 1\nduration_s = 10.0\n[observe]\ngroups = [\"exchange\"]\n\
        [body]\nincludes_wheels = false\nmass_kg = 100\ninertia_kg_m2 = [[30, 0, 0], [0, 30, 0], [0, 0, 20]]\n{}{}{}\
        [initial]\nangular_velocity_rad_s = [0, 0, 1]\n\
        [[actuation]]\nstart_s = 2\nend_s = 6\ntorque_n_m = {{ w1 = 0.7, w2 = {second:?} }}\n",
        wheel("w1", -0.5),
        wheel("w2", 0.25),
        wheel("w3", 1.0)
    ))
}

#[test]
fn a_constant_energy_has_no_correlation() {
    let correlation = |table: &Table, wheel: &str| table.column(&format!("exchange_{wheel}_correlation"))[0];
    let one = coaxial(0.25);
    let [w1, w2, w3] = ["w1", "w2", "w3"].map(|wheel| correlation(&one, wheel));
    assert!(w1 < -0.9 && w2 < -0.9, "{w1} {w2}");
    assert_eq!(w3, 0.0);
    let opposite = coaxial(-0.7);
    assert_eq!(["w1", "w2", "w3"].map(|wheel| correlation(&opposite, wheel)), [0.0; 3]);
}

/// Law: a run is marked as ill conditioned exactly where the rounding of its input, 2^-52, amplified, is above 1e-3.
#[test]
fn the_limit_of_conditioning_has_two_sides() {
    let table = table(
        "[campaign]\nname = \"separatrix\"\nsamples = 129\nseed = 1\nduration_s = 120.0\n\
        [observe]\npoints = 241\ngroups = [\"numerics\"]\n[body]\nmass_kg = 100\n\
        inertia_kg_m2 = [[10, 0, 0], [0, 15, 0], [0, 0, 20]]\n\
        [initial]\nangular_velocity_rad_s = [0, 3, 3e-7]\n[design]\nkind = \"sobol\"\n\
        [[disperse]]\nparameter = \"initial.angular_velocity_rad_s.z\"\ndistribution = \"log_uniform\"\nmin = \
        3e-9\nmax = 3e-5\n",
    );
    let (mut below, mut above) = (0.0_f64, f64::INFINITY);
    for (amplification, marked) in table.column("error_amplification").iter().zip(table.column("ill_conditioned")) {
        assert_eq!(*marked == 1.0, amplification * f64::EPSILON > 1e-3, "{amplification:e}: {marked}");
        if *marked == 1.0 {
            above = above.min(amplification * f64::EPSILON);
        } else {
            below = below.max(amplification * f64::EPSILON);
        }
    }
    // measured: 8.5e-4 and 1.1e-3
    assert!(below > 0.5e-3 && above < 2e-3, "{below:e} {above:e}");
}
