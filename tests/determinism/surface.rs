//! Runs that reach the surface of the central body, at the time of Kepler's equation.

use crate::prelude::*;

use super::whole_rows::event;

const RADIUS: f64 = 6_378_137.0;
const MU: f64 = 3.986004418e14;

/// A spacecraft on a circle at 6800 km that brakes at 1.25 m/s^2 for `burn` s.
fn braking(burn: f64, integrator: &str, points: usize, duration: f64) -> String {
    format!(
        "[campaign]\nname = \"d\"\nsamples = 2\nseed = 1\nduration_s = {duration:?}\n[integrator]\n{integrator}\n\
         [observe]\npoints = {points}\ngroups = [\"energy_conservation\", \"motion\"]\n\
         [body]\nmass_kg = 80.0\nprincipal_moments_kg_m2 = [5, 5, 4]\n\
         [[thrusters]]\nname = \"p1\"\nposition_m = [0, 0, 0]\ndirection = [0, -1, 0]\n\
         [[actuation]]\nstart_s = 0.0\nend_s = {burn:?}\nthrust_n = {{ p1 = 100.0 }}\n\
         [orbit]\nsemi_major_axis_m = \"6800 km\"\n"
    )
}

const TAYLOR: &str = "method = \"taylor\"";

fn flown(text: &str) -> SingleRun {
    single(&planned(text), 0)
}

fn last(run: &SingleRun) -> [[f64; 3]; 2] {
    let last = run.grid.points() - 1;
    [StateField::ComPosition, StateField::ComVelocity].map(|field| run.table.at(field, last))
}

/// The time of a two-body orbit down to `distance`, s.
fn time_down([position, velocity]: [[f64; 3]; 2], distance: f64) -> f64 {
    let start = norm(position);
    let axis = 1.0 / (2.0 / start - dot(velocity, velocity) / MU);
    let (along, across) = (1.0 - start / axis, dot(position, velocity) / (MU * axis).sqrt());
    let eccentricity = along.hypot(across);
    let before = across.atan2(along);
    let after = -((1.0 - distance / axis) / eccentricity).acos();
    let mean = |anomaly: f64| anomaly - eccentricity * anomaly.sin();
    (mean(after) - mean(before)).rem_euclid(std::f64::consts::TAU) * (axis / MU).sqrt() * axis
}

/// Truth: after a burn, the time at which a two-body orbit reaches the radius. Measured: 1e-8 s, 4e-6 s of RK4.
#[test]
fn a_burn_ends_at_the_surface() {
    let burn = 200.0;
    let state = last(&flown(&braking(burn, TAYLOR, 3, burn)));
    let expected = burn + time_down(state, RADIUS);
    for (integrator, points, bound) in [
        (TAYLOR, 2, 1e-7),
        (TAYLOR, 40, 1e-7),
        ("method = \"dop853\"", 40, 1e-6),
        ("method = \"dormand_prince\"", 2, 1e-6),
        ("method = \"runge_kutta_4\"\nstep_s = 20.0", 40, 4e-5),
        ("method = \"gauss_legendre_6\"\nstep_s = 20.0", 2, 1e-6),
    ] {
        let run = flown(&braking(burn, integrator, points, 3000.0));
        let found = run.outcome;
        assert_eq!(found.status, Status::Surface, "{integrator} {points}: {}", run.reason);
        assert!((found.time - expected).abs() < bound, "{integrator} {points}: {} for {expected}", found.time);
        assert!(run.reason.contains("reached the surface"), "{}", run.reason);
        assert!(run.grid.times()[found.points - 1] <= found.time);
        let energy = run.request.columns().iter().position(|column| column.quantity.name().contains("energy"));
        assert!(run.row[energy.unwrap()].is_nan());
    }
}

/// Law: a pass 300 m below the surface between two points is seen, and none 300 m above.
#[test]
fn a_pass_between_points_is_seen() {
    let periapsis = |burn: f64| {
        let [position, velocity] = last(&flown(&braking(burn, TAYLOR, 2, burn)));
        let axis = 1.0 / (2.0 / norm(position) - dot(velocity, velocity) / MU);
        let momentum = cross(position, velocity);
        let parameter = dot(momentum, momentum) / MU;
        parameter / (1.0 + (1.0 - parameter / axis).sqrt())
    };
    for (above, status) in [(-300.0, Status::Surface), (300.0, Status::Done)] {
        let (mut before, mut burn) = (90.0, 100.0);
        let mut height = periapsis(before) - RADIUS - above;
        for _ in 0..5 {
            let next = periapsis(burn) - RADIUS - above;
            (before, burn, height) = (burn, burn - next * (burn - before) / (next - height), next);
        }
        let run = flown(&braking(burn, TAYLOR, 3, 10_000.0));
        assert_eq!(run.outcome.status, status, "{above}: {}", run.reason);
    }
}

/// Law: coupled drag brings a run down at one time whatever the points; a hundredth of a second before, the body is
/// above the surface. An event on the way ends the run as `ok`.
#[test]
fn drag_brings_a_run_down() {
    let text = |points: usize, duration: f64| {
        let plate = |name: &str, side: i32| {
            format!("[[plates]]\nname = \"{name}\"\ncenter_m = [0, 0, 0]\nnormal = [0, {side}, 0]\narea_m2 = 20.0\n")
        };
        format!(
            "[campaign]\nname = \"d\"\nsamples = 2\nseed = 1\nduration_s = {duration:?}\n[observe]\npoints = {points}\n\
             groups = [\"energy_conservation\", \"orbit\"]\n\
             [body]\nmass_kg = 20.0\nprincipal_moments_kg_m2 = [5, 5, 4]\n\
             {}{}[orbit]\nsemi_major_axis_m = \"6488 km\"\n[environment]\ndrag = true\ncoupled = true\n",
            plate("front", 1),
            plate("back", -1),
        )
    };
    let [few, many] = [4, 41].map(|points| {
        let run = flown(&text(points, 4000.0));
        assert_eq!(run.outcome.status, Status::Surface, "{}", run.reason);
        run.outcome.time
    });
    assert!((few - many).abs() < 1e-3, "{few} {many}");
    let run = flown(&text(4, few - 0.01));
    assert_eq!(run.outcome.status, Status::Done, "{}", run.reason);
    let [position, velocity] = last(&run);
    let height = norm(position) - RADIUS;
    assert!(height > 0.0 && height <= 0.011 * norm(velocity), "{height} m at {} m/s", norm(velocity));
    let low = event("low", "orbit_distance_m", 6.41e6, "direction = \"falling\"\nends_run = true\n");
    let run = flown(&(text(4, 4000.0) + &low));
    assert_eq!(run.outcome.status, Status::Done, "{}", run.reason);
    assert!((norm(last(&run)[0]) - 6.41e6).abs() < 1.0);
}
