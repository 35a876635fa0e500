//! Devices that fail during a run: the motion before and after, and the columns of the failure.

use crate::prelude::*;

const HELD: &str = r#"[campaign]
name = "held"
samples = 20
seed = 1
duration_s = 80.0
[observe]
points = 161
groups = ["energy_conservation", "motion"]
[body]
mass_kg = 100.0
center_of_mass_m = [0, 0, 0]
inertia_kg_m2 = [[8, 0, 0], [0, 9, 0], [0, 0, 6]]
includes_wheels = true
[[wheels]]
name = "w1"
axis = [1.4142135623730951, 0, 1]
WHEEL
[[wheels]]
name = "w2"
axis = [0, 1.4142135623730951, 1]
WHEEL
[[wheels]]
name = "w3"
axis = [-1.4142135623730951, 0, 1]
WHEEL
[[wheels]]
name = "w4"
axis = [0, -1.4142135623730951, 1]
WHEEL
[[thrusters]]
name = "p1"
position_m = [0, 0.5, 0]
direction = [0, 0, 1]
max_thrust_n = 0.1
[initial]
angular_velocity_rad_s = [0.01, 0.02, -0.01]
[control]
period_s = 0.25
isp_s = 200.0
estimator = "perfect"
wheels = ["w1", "w2", "w3", "w4"]
thrusters = ["p1"]
[[guidance]]
phase = "hold"
law = "quaternion_feedback"
bandwidth_rad_s = 0.1
damping = 0.7
target = "attitude"
attitude = [1, 0, 0, 0]
"#;
const WHEEL: &str = "mass_kg = 1.0\naxial_inertia_kg_m2 = 1e-3\ntransverse_inertia_kg_m2 = 6e-4\ntorque_limit_n_m = \
    0.02\nviscous_friction_n_m_s = 1e-6";

fn held() -> String {
    HELD.replace("WHEEL", WHEEL)
}

fn plan(text: &str) -> Plan {
    planned(text)
}

fn run(text: &str, sample: u64) -> SingleRun {
    single(&plan(text), sample)
}

fn bits(table: &StateTable, point: usize) -> Vec<u64> {
    let fields = [StateField::Rate, StateField::Attitude, StateField::WheelRates, StateField::ComVelocity];
    fields.iter().flat_map(|field| (0..table.width(*field)).map(|i| table.column(*field, i)[point].to_bits())).collect()
}

fn same_points(a: &SingleRun, b: &SingleRun) -> usize {
    (0..a.table.points()).take_while(|point| bits(&a.table, *point) == bits(&b.table, *point)).count()
}

const DEAD: &str = "[[failure]]\nname = \"dead\"\nwheel = \"w1\"\n";

#[test]
fn a_run_is_the_same_until_the_failure() {
    let healthy = run(&held(), 3);
    for (failure, acts) in [
        (format!("{DEAD}torque_scale = 0.0\n"), true),
        (format!("{DEAD}coulomb_friction_n_m = 0.004\n"), true),
        (format!("{DEAD}viscous_friction_n_m_s = 1e-4\n"), true),
        ("[[failure]]\nname = \"on\"\nthruster = \"p1\"\nthrust_n = 0.05\n".to_owned(), true),
        ("[[failure]]\nname = \"off\"\nthruster = \"p1\"\nthrust_n = 0.0\n".to_owned(), false),
    ] {
        for at in [10.1, 20.0] {
            let failed = run(&format!("{}{failure}at_s = {at:?}\n", held()), 3);
            let same = same_points(&healthy, &failed);
            let until = (2.0 * at) as usize;
            assert!(same > until - usize::from(at == 20.0), "{failure} {at}: {same}");
            assert!(!acts || same <= until + 3, "{failure} {at}: {same}");
            assert!(failed.arcs.iter().any(|arc| (arc.end() - at).abs() < 1e-9), "an arc ends at {at}");
        }
        for at in [80.0, 81.0] {
            let late = run(&format!("{}{failure}at_s = {at:?}\n", held()), 3);
            assert_eq!(same_points(&healthy, &late), 161);
            assert!(late.arcs == healthy.arcs);
        }
    }
}

#[test]
fn after_its_failure_a_wheel_is_another_wheel() {
    for (failure, device) in [
        ("torque_scale = 0.0\n", "torque_scale = 0.0\n"),
        (
            "torque_scale = 0.3\ncoulomb_friction_n_m = 0.001\nviscous_friction_n_m_s = 1e-5\n",
            "torque_scale = 0.3\ncoulomb_friction_n_m = 0.001\n",
        ),
    ] {
        let text = held();
        let whole = run(&format!("{text}{DEAD}{failure}at_s = 20.0\n"), 0);
        let point = 40;
        let list = |field: StateField, width: usize| -> String {
            let numbers: Vec<String> =
                (0..width).map(|i| format!("{:?}", whole.table.column(field, i)[point])).collect();
            numbers.join(", ")
        };
        let mut started = text
            .replace("duration_s = 80.0", "duration_s = 60.0")
            .replace("points = 161", "points = 121")
            .replace("angular_velocity_rad_s = [0.01, 0.02, -0.01]", "");
        for (wheel, name) in ["w1", "w2", "w3", "w4"].into_iter().enumerate() {
            let rate = whole.table.column(StateField::WheelRates, wheel)[point];
            let own = if wheel == 0 { device } else { "" };
            started = started
                .replace(&format!("name = \"{name}\"\n"), &format!("name = \"{name}\"\nrate_rad_s = {rate:?}\n{own}"));
        }
        if device.contains("coulomb") {
            started = started.replacen("viscous_friction_n_m_s = 1e-6", "viscous_friction_n_m_s = 1e-5", 1);
        }
        let state = format!(
            "[initial]\nattitude = [{}]\nangular_velocity_rad_s = [{}]\n",
            list(StateField::Attitude, 4),
            list(StateField::Rate, 3)
        );
        let rest = run(&started.replace("[initial]\n", &state), 0);
        for k in [1, 20, 60, 120] {
            for (field, width, size) in
                [(StateField::Rate, 3, 0.02), (StateField::Attitude, 4, 1.0), (StateField::WheelRates, 4, 100.0)]
            {
                for i in 0..width {
                    let [a, b] = [whole.table.column(field, i)[point + k], rest.table.column(field, i)[k]];
                    assert!((a - b).abs() < 1e-11 * size, "{failure} {field:?} {i} {k}: {a} {b}");
                }
            }
        }
    }
}

#[test]
fn a_schedule_has_what_the_failed_devices_apply() {
    let text = held();
    let open = text[..text.find("[control]").unwrap()]
        .replace("torque_limit_n_m = 0.02\nviscous_friction_n_m_s = 1e-6", "")
        .replace("max_thrust_n = 0.1\n", "");
    let arc = |start: f64, end: f64, thrust: f64, torque: f64| {
        format!(
            "[[actuation]]\nstart_s = {start:?}\nend_s = {end:?}\nthrust_n = {{ p1 = {thrust:?} }}\ntorque_n_m = {{ w1 \
            = {torque:?}, w2 = 0.001 }}\n"
        )
    };
    let idle = |start: f64, end: f64, thrust: f64| {
        format!("[[actuation]]\nstart_s = {start:?}\nend_s = {end:?}\nthrust_n = {{ p1 = {thrust:?} }}\n")
    };
    let commanded = arc(5.0, 30.0, 2.0, 0.004) + &arc(40.0, 50.0, 1.0, -0.002);
    let cases = [
        (
            "wheel = \"w1\"\ntorque_scale = 0.5\n",
            arc(5.0, 20.0, 2.0, 0.004) + &arc(20.0, 30.0, 2.0, 0.002) + &arc(40.0, 50.0, 1.0, -0.001),
        ),
        (
            "thruster = \"p1\"\nthrust_n = 0.0\n",
            arc(5.0, 20.0, 2.0, 0.004) + &arc(20.0, 30.0, 0.0, 0.004) + &arc(40.0, 50.0, 0.0, -0.002),
        ),
        (
            "thruster = \"p1\"\nthrust_n = 0.5\n",
            arc(5.0, 20.0, 2.0, 0.004)
                + &arc(20.0, 30.0, 0.5, 0.004)
                + &idle(30.0, 40.0, 0.5)
                + &arc(40.0, 50.0, 0.5, -0.002)
                + &idle(50.0, 80.0, 0.5),
        ),
    ];
    for (failure, schedule) in cases {
        let failed = run(&format!("{open}{commanded}[[failure]]\nname = \"f\"\nat_s = 20.0\n{failure}"), 0);
        let written = run(&format!("{open}{schedule}"), 0);
        assert_eq!(same_points(&failed, &written), 161, "{failure}");
        assert!(same_points(&failed, &run(&format!("{open}{commanded}"), 0)) <= 42, "{failure}");
    }
}

#[test]
fn a_thruster_that_is_stuck_on_burns_propellant() {
    let failed =
        run(&format!("{}[[failure]]\nname = \"on\"\nthruster = \"p1\"\nthrust_n = 0.05\nat_s = 30.1\n", held()), 0);
    let healthy = run(&held(), 0);
    let fired = value(&failed, "propellant_kg");
    let before = value(&healthy, "propellant_kg");
    let stuck = 0.05 * 49.9 / (200.0 * 9.80665);
    let range = stuck * (1.0 - 1e-12)..=before + stuck * (1.0 + 1e-12);
    assert!(range.contains(&fired), "{fired} for {stuck} and {before}");
}

#[test]
fn the_row_says_what_has_failed() {
    let draw = "[[disperse]]\nparameter = \"failure.dead.at_s\"\ndistribution = \"uniform\"\nmin = 0.0\nmax = 160.0\n";
    let text = format!("{}{DEAD}torque_scale = 0.0\nat_s = 10.0\n{draw}", held());
    let plan = plan(&text);
    let ensemble = Ensemble::new(&plan, Isa::best());
    let mut rows = ensemble.rows(20);
    let part = Part { id: PartId(0), first: SampleId(0), count: 20 };
    ensemble.worker().run(part, &mut rows, Supervision::progress(&|_| {}));
    let columns = ensemble.request().columns();
    let place = |name: &str| columns.iter().position(|column| column.quantity.name() == name).expect(name);
    let mut columns_of_draws = plan.dispersions.columns().iter();
    let drawn = columns_of_draws.position(|column| column.parameter.name() == "failure.dead.at_s").unwrap();
    let mut happened = 0;
    for sample in 0..20_usize {
        let at = rows.parameter(drawn)[sample];
        let [time, said] =
            ["failure_dead_time_s", "failure_dead_happened"].map(|name| rows.observable(place(name))[sample]);
        assert_eq!(said, f64::from(u8::from(at < 80.0)));
        assert!(if at < 80.0 { time == at } else { time.is_nan() }, "{at} {time}");
        happened += u32::from(said == 1.0);
        let single = run(&text, sample as u64);
        for (index, value) in single.row.iter().enumerate() {
            assert_eq!(value.to_bits(), rows.observable(index)[sample].to_bits(), "{}", columns[index].quantity.name());
        }
    }
    assert!((4..=16).contains(&happened), "{happened}");
}

#[test]
fn loops_fly_on_without_a_sensor() {
    let shipped = SLEW_CLOSED;
    let healthy = value(&run(shipped, 2), "pointing_error_final_rad");
    let of = |failure: &str| {
        let text = format!("{shipped}\n[[failure]]\nname = \"sensor\"\nat_s = 100.0\n{failure}\n");
        value(&run(&text, 2), "pointing_error_final_rad")
    };
    for failure in [
        "sensor = \"tracker\"\noutput = \"silent\"",
        "sensor = \"gyro\"\noutput = \"silent\"",
        "sensor = \"gyro\"\noutput = \"frozen\"",
        "sensor = \"tachometers\"\noutput = \"silent\"",
    ] {
        assert!(of(failure).is_finite(), "{failure}");
    }
    let biased = of("sensor = \"tracker\"\nbias_rad = [0.0, 0.0, 0.01]");
    assert!(healthy < 1e-3 && (2e-3..2e-2).contains(&biased), "{healthy} {biased}");
    let frozen = of("sensor = \"tracker\"\noutput = \"frozen\"");
    assert!(frozen.is_finite());
}

/// Law: a dead torque rod has the scale zero, and a stuck one is a part of the residual dipole.
#[test]
fn a_torque_rod_fails() {
    let shipped = DETUMBLE_MAGNETIC.replace("110 min", "30 min");
    let healthy = run(&shipped, 0);
    let failed = |at: f64, dipole: f64| {
        let keys = format!("name = \"rod\"\ntorque_rod = \"mx\"\nat_s = {at:?}\ndipole_a_m2 = {dipole:?}\n");
        run(&format!("{shipped}\n[[failure]]\n{keys}"), 0)
    };
    let without =
        shipped.replace("name = \"mx\"\naxis = [1, 0, 0]\n", "name = \"mx\"\naxis = [1, 0, 0]\ndipole_scale = 0\n");
    let points = healthy.table.points();
    assert_eq!(same_points(&failed(0.0, 0.0), &run(&without, 0)), points);
    let residual = without.replace("[0.01, -0.01, 0.02]", "[0.21, -0.01, 0.02]");
    let (stuck, residual) = (failed(0.0, 0.2), run(&residual, 0));
    let rate = |run: &SingleRun| run.table.at::<3>(StateField::Rate, points - 1);
    let apart = |a: [f64; 3], b: [f64; 3]| (0..3).fold(0.0_f64, |most, i| most.max((a[i] - b[i]).abs()));
    // ticks of b-dot multiply the rounding of the sum of two dipoles
    assert!(apart(rate(&stuck), rate(&residual)) < 1e-9, "{:?} {:?}", rate(&stuck), rate(&residual));
    assert!(apart(rate(&stuck), rate(&healthy)) > 1e-3);
    let spacing = 1800.0 / (points - 1) as f64;
    for at in [601.0, 900.0] {
        let same = same_points(&healthy, &failed(at, 0.2));
        let until = (at / spacing) as usize;
        assert!((until..=until + 2).contains(&same), "{at}: {same} of {until}");
    }
    assert_eq!(same_points(&healthy, &failed(1800.0, 0.2)), points);
}
