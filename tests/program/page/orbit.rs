//! The orbit on the page: arrows of the replay, ground track and quantities over time, against states and closed forms.

use crate::prelude::*;
use spindrift::ensemble::single::SingleRuns;
use std::f64::consts::TAU;
use std::sync::LazyLock;

const AXIS: f64 = 6_828e3;
const INCLINATION: f64 = 51.6;
const DURATION: f64 = 12_000.0;
/// Days from J2000.0 to the epoch, 2026-11-24T00:00:00Z: Julian dates 2461368.5 and 2451545.
const DAYS: f64 = 9_823.5;

fn shipped(name: &str) -> String {
    fs::read_to_string(format!("{}/campaigns/{name}.toml", env!("CARGO_MANIFEST_DIR"))).unwrap()
}

fn text() -> String {
    let text = shipped("drag_tumble").replace("samples = 1000 ", "samples = 400 ");
    let text = text.replace("area_m2 = 0.25", "cell_efficiency = 0.3\narea_m2 = 0.25");
    text.replace("duration_s = 5600.0", &format!("duration_s = {DURATION:?}")).replace(
        "[environment]",
        "eccentricity = 0.01\n[environment]\ndensity_scale = 0.01\nmagnetic_field = \
            \"dipole\"\nmagnetic_dipole_a_m2 = [0.02, 0.0, 0.01]",
    )
}

static ORBIT: LazyLock<Found> = LazyLock::new(|| found("orbit", &text()));

fn unit(vector: [f64; 3]) -> [f64; 3] {
    let size = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
    vector.map(|x| x / size)
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Direction and distance, au, of the Sun by the series of `docs/environment.md`.
fn sun(time: f64) -> ([f64; 3], f64) {
    let n = DAYS + time / 86_400.0;
    let g = (357.528 + 0.985_600_3 * n).to_radians();
    let lambda = (280.460 + 0.985_647_4 * n + 1.915 * g.sin() + 0.020 * (2.0 * g).sin()).to_radians();
    let epsilon = (23.439 - 4e-7 * n).to_radians();
    let direction = [lambda.cos(), epsilon.cos() * lambda.sin(), epsilon.sin() * lambda.sin()];
    (direction, 1.00014 - 0.01671 * g.cos() - 0.00014 * (2.0 * g).cos())
}

/// Greenwich mean sidereal time, deg (J. Meeus, *Astronomical Algorithms*, 1998, eq. 12.4).
fn greenwich(time: f64) -> f64 {
    let n = DAYS + time / 86_400.0;
    280.460_618_37 + 360.985_647_366_29 * n
}

/// The direction of the field of IGRF-14's dipole, of 2025 with its change in 1.896 years, in F_e: 3 (m . u) u - m with
/// m = (g11, h11, g10).
fn field(time: f64, position: [f64; 3]) -> [f64; 3] {
    let years = 1.0 + 327.0 / 365.0;
    let m = [-1410.3 + 10.0 * years, 4545.5 - 21.5 * years, -29_350.0 + 12.6 * years];
    let (s, c) = greenwich(time).to_radians().sin_cos();
    let m = [c * m[0] - s * m[1], s * m[0] + c * m[1], m[2]];
    let u = unit(position);
    unit(from_fn(|i| 3.0 * dot(m, u) * u[i] - m[i]))
}

fn apart(a: f64, b: f64) -> f64 {
    (a - b + 180.0).rem_euclid(360.0) - 180.0
}

fn runs(found: &Found) -> &[Value] {
    found.shown_runs()
}

/// Law: the arrows are nadir, velocity, Sun and the field of a tilted dipole at the states of `simulate`, no farther
/// apart than 5 deg of the orbit.
#[test]
fn arrows_point_where_the_run_has_them() {
    let found = &*ORBIT;
    for run in runs(found).iter().take(3) {
        let orbit = &run["orbit"];
        let times = found.array(&orbit["times"]);
        assert!(times[0] == 0.0 && times.last() == Some(&DURATION) && times.len() < 200);
        assert!(times.windows(2).all(|pair| pair[1] - pair[0] < 5.0 / 360.0 * 5_500.0 + 86.0), "{times:?}");
        let list: Vec<String> = times.iter().map(ToString::to_string).collect();
        let simulate = format!("simulate c.toml --sample {} --times {} --out s.parquet", run["sample"], list.join(","));
        found.scratch.prints(&simulate, 0);
        let table = found.scratch.table("s.parquet");
        let vector = |name: &str| {
            let columns = ["x", "y", "z"].map(|axis| floats(&table, &name.replace('?', axis)));
            (0..times.len()).map(|row| columns.each_ref().map(|column| column[row])).collect::<Vec<[f64; 3]>>()
        };
        let (positions, velocities) = (vector("r_po_e_?_m"), vector("v_po_e_?_m_s"));
        for (name, row_of) in [
            ("nadir", &(|row: usize| unit(positions[row].map(|x| -x))) as &dyn Fn(usize) -> [f64; 3]),
            ("velocity", &|row| unit(velocities[row])),
            ("sun", &|row| sun(times[row]).0),
            ("field", &|row| field(times[row], positions[row])),
        ] {
            let shown = found.array(&orbit[name]);
            assert_eq!(shown.len(), 3 * times.len(), "{name}");
            for row in 0..times.len() {
                let expected = row_of(row);
                for axis in 0..3 {
                    let value = shown[3 * row + axis];
                    assert!(
                        (value - expected[axis]).abs() < 2e-4,
                        "{name} at {}: {value} for {expected:?}",
                        times[row]
                    );
                }
            }
        }
    }
}

fn observed(sample: u64, times: &[f64]) -> SingleRun {
    let plan = planned(&text());
    let grid = Grid::at(times.to_vec());
    SingleRuns::new(&plan, grid, Isa::best(), &[Group::Orbit, Group::Attitude], false).run(SampleId(sample)).unwrap()
}

fn series(run: &SingleRun, wanted: Series) -> &[f64] {
    &run.series.iter().find(|(series, _)| *series == wanted).unwrap_or_else(|| panic!("no {wanted:?}")).1
}

/// Law: the hidden share of the Sun in the replay is its column at each time; cells on the two ends of the bus have the
/// power 1361 W/m^2 eta A |s3 . s|/d^2 of what is not hidden.
#[test]
fn shadow_is_that_of_the_column() {
    let found = &*ORBIT;
    let mut seen = [0; 2];
    for run in runs(found).iter().take(3) {
        let times = found.array(&run["times"]);
        let columns = observed(run["sample"].as_u64().unwrap(), &times);
        let hidden = found.array(&run["orbit"]["hidden"]);
        let live = run["live"].as_array().unwrap().iter().find(|number| number["name"] == "Sunlight");
        let live = live.unwrap();
        assert_eq!(live["words"], serde_json::json!(["full", "part shadow", "in shadow"]));
        assert!(live["held"] == true && found.array(&live["values"]) == hidden);
        for (value, column) in hidden.iter().zip(series(&columns, Series::SunHidden)) {
            assert!((value - column).abs() < 1e-3, "{value} for {column}");
            seen[usize::from(*column > 0.5)] += 1;
        }
        let powers = series(&columns, Series::SolarPower).iter().zip(series(&columns, Series::SunHidden));
        for (point, (power, hidden)) in powers.enumerate() {
            let [w, x, y, z]: [f64; 4] = columns.table.at(StateField::Attitude, point);
            let s3 = [2.0 * (x * z + w * y), 2.0 * (y * z - w * x), w * w - x * x - y * y + z * z];
            let (s, distance) = sun(times[point]);
            let expected = 1361.0 * 0.3 * 0.25 * dot(s3, s).abs() / (distance * distance) * (1.0 - hidden);
            assert!((power - expected).abs() < 2e-3, "{power} W for {expected} W");
        }
    }
    assert!(seen.iter().all(|count| *count > 20), "{seen:?}");
}

fn track(found: &Found) -> Vec<(String, Vec<f64>, Vec<f64>)> {
    let figure = found.figure("ground_track");
    assert_eq!([&figure["x"]["range"], &figure["x"]["step"]], [&serde_json::json!([-180.0, 180.0]), &30.0.into()]);
    let part = |mark: &Value| {
        let [x, y] = ["x", "y"].map(|key| found.array(&mark[key]));
        (mark["label"].as_str().unwrap().to_owned(), x, y)
    };
    figure["marks"].as_array().unwrap().iter().map(part).filter(|(label, ..)| label != "start").collect()
}

/// Law: the track starts at the node, reaches the inclination in latitude, and every state of the run is on it.
#[test]
fn the_track_is_where_the_orbit_passes() {
    let found = &*ORBIT;
    let parts = track(found);
    let start = found.mark("ground_track", "start");
    let [longitude, latitude] = ["x", "y"].map(|key| found.array(&start[key])[0]);
    assert!(apart(longitude, -greenwich(0.0)).abs() < 0.01 && latitude.abs() < 1e-3, "{longitude}, {latitude}");
    let latitudes = parts.iter().flat_map(|(_, _, y)| y);
    let [low, high] = latitudes.fold([f64::MAX, f64::MIN], |[a, b], y| [a.min(*y), b.max(*y)]);
    for most in [high, -low] {
        assert!(most <= INCLINATION + 1e-3 && most > INCLINATION - 0.05, "{most}");
    }
    let times: Vec<f64> = (0..=140).map(|point| DURATION / 140.0 * f64::from(point)).collect();
    let run = observed(0, &times);
    for (point, time) in times.iter().enumerate() {
        let [x, y, z]: [f64; 3] = run.table.at(StateField::ComPosition, point);
        let (longitude, latitude) = (y.atan2(x).to_degrees() - greenwich(*time), z.atan2(x.hypot(y)).to_degrees());
        let is_here = |(x, y): (&f64, &f64)| apart(*x, longitude).abs() < 5e-3 && (y - latitude).abs() < 2e-3;
        assert!(parts.iter().any(|(_, x, y)| x.iter().zip(y).any(is_here)), "{longitude}, {latitude} at {time}");
    }
}

/// Law: the share in shadow on a circle is acos(sqrt(1 - R^2/r^2)/cos beta)/pi, with the Sun at beta to the plane.
#[test]
fn the_track_in_shadow_has_its_share() {
    let circle = text().replace("eccentricity = 0.01", "eccentricity = 0.0");
    let period = TAU * (AXIS.powi(3) / 3.986004418e14).sqrt();
    let found = found("orbit-circle", &circle.replace(&format!("{DURATION:?}"), &format!("{period:?}")));
    let parts = track(&found);
    let of = |wanted: &str| -> f64 {
        parts.iter().filter(|(label, ..)| label == wanted).map(|(_, x, _)| x.len() as f64).sum()
    };
    let (sin_i, cos_i) = INCLINATION.to_radians().sin_cos();
    let sin_beta = dot(sun(0.5 * period).0, [0.0, -sin_i, cos_i]);
    let share = (6_378_137.0_f64 / AXIS).powi(2);
    let expected = ((1.0 - share).sqrt() / (1.0 - sin_beta * sin_beta).sqrt()).acos() / PI;
    let shown = of("in shadow") / (of("in shadow") + of("in sunlight"));
    assert!((shown - expected).abs() < 0.012, "{shown} for {expected}");
}

/// Law: a quantity of the orbit over time is, in the nominal run, its column and follows from the states.
#[test]
fn quantities_of_the_orbit_are_their_columns() {
    let found = &*ORBIT;
    let list = [
        (Series::NadirAngle, "nadir_angle_rad"),
        (Series::OrbitDistance, "orbit_distance_m"),
        (Series::FieldStrength, "magnetic_field_t"),
        (Series::AirDensity, "air_density_kg_m3"),
        (Series::SunHidden, "sun_hidden_fraction"),
    ];
    for (wanted, name) in list {
        let figure = found.figure(name);
        crate::page::series::bands_are(found, figure);
        let line = found.mark(name, "nominal run");
        let [times, values] = ["x", "y"].map(|key| found.array(&line[key]));
        let run = observed(0, &times);
        let factor = if figure["y"]["unit"] == "deg" { degrees(1.0) } else { 1.0 };
        let known = series(&run, wanted);
        assert!(known.len() == times.len() && times.len() > 100, "{name}");
        for (point, (value, known)) in values.iter().zip(known).enumerate() {
            assert!((value - factor * known).abs() <= 1e-12 * value.abs(), "{name} at {}: {value}", times[point]);
            let position: [f64; 3] = run.table.at(StateField::ComPosition, point);
            let [w, x, y, z]: [f64; 4] = run.table.at(StateField::Attitude, point);
            let s3 = [2.0 * (x * z + w * y), 2.0 * (y * z - w * x), w * w - x * x - y * y + z * z];
            let of_state = match wanted {
                Series::NadirAngle => degrees(dot(s3, unit(position.map(|x| -x))).clamp(-1.0, 1.0).acos()),
                Series::OrbitDistance => dot(position, position).sqrt(),
                _ => continue,
            };
            assert!((value - of_state).abs() < 1e-5 * of_state.max(1.0), "{name}: {value} for {of_state}");
        }
    }
}

/// Law: without a date there is no Sun, shadow or ground track, and without an orbit nothing of it.
#[test]
fn a_page_shows_what_the_scene_has() {
    let keys = |run: &Value| -> Vec<String> {
        run["orbit"].as_object().map_or_else(Vec::new, |orbit| orbit.keys().cloned().collect())
    };
    let said = |found: &Found, word: &str| found.data.to_string().contains(word);
    let undated = found("orbit-undated", &shipped("nadir_pointing").replace("samples = 256 ", "samples = 4 "));
    for run in runs(&undated) {
        assert_eq!(keys(run), ["nadir", "times", "velocity"]);
    }
    let free = found("orbit-none", &motion());
    assert!(runs(&free).iter().all(|run| run.get("orbit").is_none()));
    for (found, is_on_orbit) in [(&undated, true), (&free, false)] {
        for word in ["ground_track", "\"words\"", "\"step\"", "Sunlight"] {
            assert!(!said(found, word), "{word}");
        }
        assert_eq!(said(found, "orbit_distance_m"), is_on_orbit);
    }
    for word in ["ground_track", "\"words\"", "\"step\"", "Sunlight", "orbit_distance_m"] {
        assert!(said(&ORBIT, word), "{word}");
    }
    assert_eq!(keys(&runs(&ORBIT)[0]), ["field", "hidden", "nadir", "sun", "times", "velocity"]);
    let page = ORBIT.scratch.text("r/report.html").len();
    assert!(page < 2_000_000, "{page} bytes");
}
