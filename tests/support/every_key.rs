//! A campaign file with every table, and with tables of every distribution and design.

pub const EVERY_TABLE: &str = include_str!("every_table.toml");

pub fn distributions() -> Vec<(&'static str, String)> {
    let scalar = [
        "normal",
        "truncated_normal",
        "uniform",
        "log_normal",
        "log_uniform",
        "triangular",
        "pert",
        "beta",
        "gamma",
        "weibull",
        "exponential",
        "rayleigh",
        "student_t",
        "bernoulli",
        "choice",
        "empirical",
        "offset",
    ];
    let table = |parameter: &str, name: &str| {
        format!("\n[[disperse]]\nparameter = \"{parameter}\"\ndistribution = \"{name}\"\n")
    };
    let scalar = scalar.map(|name| (name, table("body.parts.tank.mass_kg", name)));
    let directions =
        ["uniform_direction", "cone", "von_mises_fisher"].map(|name| (name, table("thrusters.p1.direction", name)));
    let attitudes =
        ["uniform_attitude", "attitude_error", "about_axis"].map(|name| (name, table("initial.attitude", name)));
    let rows = ("bootstrap", "\n[[disperse]]\ndistribution = \"bootstrap\"\n".to_owned());
    scalar.into_iter().chain(directions).chain(attitudes).chain([rows]).collect()
}

pub fn without_draws() -> String {
    let at = |header: &str| EVERY_TABLE.find(header).unwrap();
    [&EVERY_TABLE[..at("[design]")], &EVERY_TABLE[at("[bands]")..]].concat()
}

/// The name of each distribution with a table, in each way to write its numbers, and a table `data.csv` of columns a
/// and b.
pub fn distribution_tables() -> Vec<(&'static str, String)> {
    let tables = include_str!("every_distribution.toml").split("\n\n").skip(1);
    let name = |table: &'static str| table.split_once("distribution = \"").unwrap().1.split('"').next().unwrap();
    tables.map(|table| (name(table), format!("{}\n", table.trim_end()))).collect()
}

pub fn every_scene() -> Vec<String> {
    const RELATIVE_DEBRIS: &str =
        "debris_attitude = [1, 0, 0, 0]\ndebris_relative_angular_velocity_rad_s = [100, 0, 0]\n";
    const INERTIAL_DEBRIS: &str =
        "debris_attitude_inertial = [1, 0, 0, 0]\ndebris_angular_velocity_rad_s = [0.01, 0.02, 0.03]\n";
    let plain = without_draws();
    let (debris, initial) = (plain.find("[debris]").unwrap(), plain.find("[initial]").unwrap());
    let arc = "[[actuation]]\nname = \"later\"\nstart_s = 4.0\nend_s = 6.0\nthrust_n = { p1 = 3.0 }\n";
    let with = |body: &str, part: &str, debris_keys: &str| {
        let text = format!("{}[debris]\n{debris_keys}\n{}{arc}", &plain[..debris], &plain[initial..]);
        text.replace("mass_scale = 1.0\n", &format!("mass_scale = 1.0\n{body}\n"))
            .replace("[[wheels]]\nname = \"w1\"", &format!("{part}[[wheels]]\nname = \"w1\""))
    };
    let tensor = "inertia_kg_m2 = [[3.0, 0.1, 0.2], [0.1, 4.0, 0.3], [0.2, 0.3, 5.0]]";
    let axes = "principal_axes = [0.5, 0.5, -0.5, 0.5]";
    let principal = |key: &str| format!("{key} = [3.0, 4.0, 5.0]\n{axes}");
    let moments = ["principal_moments_kg_m2", "principal_second_moments_kg_m2"].map(principal);
    let part = "[[body.parts]]\nname = \"panel\"\nshape = \"box\"\nsize_m = [1.0, 2.0, 0.1]\nmass_kg = 7.0\n\
        [[body.parts]]\nname = \"rod\"\nshape = \"solid_cylinder\"\nradius_m = 0.1\nlength_m = 2.0\nmass_kg = 7.0\n";
    let body = format!(
        "mass_kg = 2000.0\ncenter_of_mass_m = [0.1, 0.2, 1.5]\n{}",
        tensor.replace(".0,", "000.0,").replace(".0]", "000.0]")
    );
    vec![
        with("", part, "side_m = 0.2\ndensity_kg_m3 = 2700.0"),
        with(&body, "", "size_m = [0.1, 0.2, 0.3]\ndensity_kg_m3 = 2700.0"),
        with(&moments[0].replace(".0", "00.0"), "", &format!("mass_kg = 3.0\n{tensor}")),
        with(&moments[1].replace(".0", "00.0"), "", &format!("mass_kg = 3.0\n{}", moments[0])),
        with("", "", &format!("mass_kg = 3.0\n{}", moments[1])).replace(RELATIVE_DEBRIS, INERTIAL_DEBRIS),
        on_orbit("j2 = 1e-3\nposition_m = [7e6, 1e5, 2e5]\nvelocity_m_s = [10, 7.4e3, -3e2]")
            .replace("body_radius_m = 0", "body_radius_m = 5.9e6"),
        on_orbit(
            "semi_major_axis_m = 9e6\neccentricity = 0.0\ninclination_rad = 0.9\nascending_node_rad = 2.0\n\
             argument_of_periapsis_rad = -0.7\ntrue_anomaly_rad = 1.1",
        )
        .replace(
            "angular_velocity_rad_s = [0, 0, 0.001]",
            "attitude_orbital = [1, 0, 0, 0]\nangular_velocity_orbital_rad_s = [0, 0, 0.001]",
        ),
        on_plates(),
        in_own_air(),
    ]
}

fn in_own_air() -> String {
    let exponential = "base_density_kg_m3 = 1e-11\nbase_height_m = 5e5\nscale_height_m = 6e4\n";
    on_plates()
        .replace(exponential, "air_heights_m = [3e5, \"400 km\", 6e5]\nair_densities_kg_m3 = [2e-11, 3e-12, 1e-13]\n")
}

fn on_plates() -> String {
    let plates = "semi_major_axis_m = 9e6\n\
        [[plates]]\nname = \"panel\"\narea_m2 = 2.5\nnormal = [0, 0.5, 1]\ntilt_rad = [0.01, 0.0]\ncenter_m = [0.1, \
        0.8, 0]\n\
        drag_coefficient = 2.5\nspecular = 0.4\ndiffuse = 0.3\ncell_efficiency = 0.2\n";
    let effects = "gravity_gradient = true\ndrag = true\nsolar_pressure = true\nshadow = \"cylinder\"\ndensity_scale = \
        1.5\n\
        base_density_kg_m3 = 1e-11\nbase_height_m = 5e5\nscale_height_m = 6e4\nsolar_pressure_n_m2 = \
        4.6e-6\narea_scale = 1.1\ncoupled = true\n";
    on_orbit(plates).replace("gravity_gradient = true\n", effects)
}

fn on_orbit(keys: &str) -> String {
    format!("{}{keys}\n", include_str!("orbit.toml"))
}

/// Loops of every estimator, modulation, sensor, law, target and maneuver, with their keys.
pub fn every_loop() -> Vec<String> {
    let base = every_table_of_loops();
    let sensors_of = |estimator: &spindrift::loops::kinds::EstimatorKind| {
        // those that need an orbit: below
        let kinds =
            spindrift::control::sensors::KINDS.iter().map(|maker| &maker.kind).filter(|kind| kind.needs.is_none());
        let used = kinds.filter(|kind| estimator.knows_the_truth || (estimator.uses)(&kind.observes));
        used.fold(String::new(), |text, kind| {
            let name = kind.name;
            let latency = if kind.observes.has_latency() { "latency_s = 0.25\n" } else { "" };
            format!("{text}[[sensors]]\nname = \"a_{name}\"\nkind = \"{name}\"\nperiod_s = 0.5\n{latency}")
        })
    };
    let laws = spindrift::control::laws::KINDS.iter().map(|kind| (kind.name, numbers(kind.parameters)));
    let laws: Vec<_> = laws.collect();
    let mut phases = String::new();
    let targets = spindrift::loops::target::TARGETS;
    let of_orbit = targets.iter().filter(|(_, target)| target.needs_orbit()).map(|(name, _)| *name);
    let targets = targets.iter().filter(|(_, target)| !target.needs_orbit()).map(|(name, _)| *name);
    let maneuvers = spindrift::loops::phase::MANEUVERS.iter().map(|(name, _)| *name);
    let pairs: Vec<_> = targets.flat_map(|target| maneuvers.clone().map(move |thrust| (target, thrust))).collect();
    let opposed = [("transfer", "stop"), ("stop", "transfer")];
    for (place, (target, thrust)) in pairs.into_iter().filter(|pair| !opposed.contains(pair)).enumerate() {
        let (law, own) = &laws[place % laws.len()];
        phases += &format!(
            "[[guidance]]\nphase = \"p{place}\"\nlaw = \"{law}\"\n{own}target = \"{target}\"\nthrust = \"{thrust}\"\n\
             until = \"time_s > {place} and body_rate_rad_s < 1\"\nnext = \"launch\"\notherwise = \"p0\"\n"
        );
        phases += if *law == "mrp_feedback" { "gyroscopic = true\n" } else { "" };
        phases += if target == "attitude" { "attitude = [1, 0, 0, 0]\n" } else { "" };
        phases += if target == "transfer" || thrust == "transfer" { "transfer_time_s = 60\n" } else { "" };
    }
    let mut files = Vec::new();
    for estimator in spindrift::control::estimators::KINDS.iter().map(|maker| &maker.kind) {
        for modulation in spindrift::control::actuators::modulation::NAMES {
            let (sensors, estimator) = (sensors_of(estimator), estimator.name);
            let failures = failures_of(&sensors);
            files.push(format!(
                "{base}[control]\nperiod_s = 0.25\nestimator = \"{estimator}\"\nwheels = [\"w1\"]\nthrusters = \
                [\"p1\"]\n\
                 modulation = \"{modulation}\"\nhold_force = true\n[control.model]\nmass_kg = 2000.0\ncenter_of_mass_m \
                 = [0, 0, 1.5]\n\
                 inertia_kg_m2 = [[3000, 0, 0], [0, 3000, 0], [0, 0, 1700]]\n{sensors}{failures}{phases}"
            ));
        }
    }
    let orbit = on_orbit("semi_major_axis_m = 9e6");
    for target in of_orbit {
        let attitude = if target == "orbital_attitude" { "attitude = [1, 0, 0, 0]\n" } else { "" };
        files.push(format!(
            "{orbit}[control]\nperiod_s = 0.25\nwheels = [\"w1\"]\n[[guidance]]\nphase = \"turn\"\n\
             law = \"rate_damping\"\ngain_n_m_s = 1.0\ntarget = \"{target}\"\n{attitude}"
        ));
    }
    let of_orbit =
        spindrift::control::sensors::KINDS.iter().map(|maker| &maker.kind).filter(|kind| kind.needs.is_some());
    let sensors = of_orbit.fold(String::new(), |text, kind| {
        let name = kind.name;
        format!("{text}[[sensors]]\nname = \"a_{name}\"\nkind = \"{name}\"\nperiod_s = 0.5\nlatency_s = 0.25\n")
    });
    for (name, of) in spindrift::loops::rod_law::ROD_LAWS.iter().filter(|(name, _)| *name != "none") {
        let own = numbers(of.parameters());
        files.push(format!(
            "{orbit}[[torque_rods]]\nname = \"m1\"\naxis = [0, 0, 1]\nmax_dipole_a_m2 = 5.0\n[control]\nperiod_s = \
            0.25\n\
             estimator = \"mekf\"\nwheels = [\"w1\"]\ntorque_rods = [\"m1\"]\n{sensors}[[guidance]]\nphase = \
             \"turn\"\nrods = \"{name}\"\n{own}\
             [[failure]]\nname = \"rod\"\ntorque_rod = \"m1\"\nat_s = 3\ndipole_a_m2 = 0.5\n"
        ));
    }
    files
}

fn failures_of(sensors: &str) -> String {
    let of = |name: &str, keys: &str| {
        let is_there = sensors.contains(&format!("name = \"{name}\""));
        let text = format!("[[failure]]\nname = \"of_{name}\"\nsensor = \"{name}\"\nat_s = 3\n{keys}\n");
        if is_there { text } else { String::new() }
    };
    of("a_rate_gyro", "bias_rad_s = [0.1, 0, 0]")
        + &of("a_star_tracker", "bias_rad = [0, 0.1, 0]")
        + &of("a_sun_sensor", "output = \"silent\"")
        + &of("a_tachometers", "output = \"frozen\"")
}

fn numbers(parameters: &[spindrift::scene::LawParameter]) -> String {
    let required = parameters.iter().filter(|parameter| parameter.default.is_none());
    required.map(|parameter| format!("{} = 0.5\n", parameter.facts.key)).collect()
}

fn every_table_of_loops() -> String {
    let failing = "torque_scale = 0.5\n\n[[failure]]";
    let friction = "torque_scale = 0.5\ncoulomb_friction_n_m = 0.02\nviscous_friction_n_m_s = 0.002\n\n[[failure]]";
    let drive = "torque_limit_n_m = 2.0\nspeed_limit_rad_s = 400.0\ncoulomb_friction_n_m = \
        0.01\nviscous_friction_n_m_s = 0.001\n";
    let text = without_draws().replace("rate_rad_s = 314.0\n", &format!("rate_rad_s = 314.0\n{drive}"));
    text.replace(failing, friction).replace(
        "direction = [0, 0, 1]\n\n[debris]",
        "direction = [0, 0, 1]\nmax_thrust_n = 20.0\nmin_on_time_s = 0.02\n\n[debris]",
    )
}
