//! `spindrift simulate`: one run as table, file and plot.

use crate::prelude::*;

#[test]
fn simulate_shows_the_run_behind_the_row() {
    let scratch = folder("sample");
    scratch.small("", 0);
    for sample in [0, 1, 255, 256, 599] {
        scratch.prints(&format!("simulate small.toml --sample {sample} --out s.parquet"), 0);
        let run = &scratch.table("s.parquet");
        let part = &scratch.table(&format!("results/small/runs/part-{:06}.parquet", sample / 256));
        let row = sample % 256;
        assert_eq!(run.num_rows(), 11);
        for (of_run, of_row) in [
            ("omega_se_s_x_rad_s", "omega_se_s_x_final_rad_s"),
            ("omega_se_s_z_rad_s", "omega_se_s_z_final_rad_s"),
            ("q_es_w", "q_es_w_final"),
            ("rate_w1_rad_s", "rate_w1_final_rad_s"),
            ("energy_w1_j", "energy_w1_final_j"),
        ] {
            let (last, value) = (floats(run, of_run)[10], floats(part, of_row)[row]);
            assert_eq!(last.to_bits(), value.to_bits(), "sample {sample}, {of_run}: {last:?} and {value:?}");
        }
        let largest = floats(run, "energy_error").iter().fold(0.0, |largest: f64, error| largest.max(error.abs()));
        assert_eq!(largest, floats(part, "energy_error_max")[row]);
    }
    scratch.prints("simulate small.toml --sample 600", 2);
}

#[test]
fn simulate_writes_the_promised_columns() {
    let scratch = folder("columns");
    scratch.prints("simulate small.toml --out s.csv", 0);
    let text = scratch.text("s.csv");
    let expected = "time_s,r_po_e_x_m,r_po_e_y_m,r_po_e_z_m,v_po_e_x_m_s,v_po_e_y_m_s,v_po_e_z_m_s,\
        q_es_w,q_es_x,q_es_y,q_es_z,\
        omega_se_s_x_rad_s,omega_se_s_y_rad_s,omega_se_s_z_rad_s,angle_w1_rad,rate_w1_rad_s,angle_w2_rad,rate_w2_rad_s,\
        r_gdo_e_x_m,r_gdo_e_y_m,r_gdo_e_z_m,v_gdo_e_x_m_s,v_gdo_e_y_m_s,v_gdo_e_z_m_s,q_ed_w,q_ed_x,q_ed_y,q_ed_z,\
        omega_de_d_x_rad_s,omega_de_d_y_rad_s,omega_de_d_z_rad_s,\
        energy_body_j,energy_w1_j,energy_w2_j,energy_debris_j,\
        energy_com_body_j,energy_com_w1_j,energy_com_w2_j,energy_com_wheels_j,energy_com_total_j,energy_error,";
    assert!(text.starts_with(expected), "{}", text.lines().next().unwrap());
    assert_eq!(text.lines().count(), 12);

    scratch.prints("simulate small.toml --out s.parquet", 0);
    let batch = &scratch.table("s.parquet");
    let names: Vec<&str> = text.lines().next().unwrap().split(',').collect();
    let mut long = 0;
    for (point, line) in text.lines().skip(1).enumerate() {
        for (name, cell) in names.iter().zip(line.split(',')) {
            let (written, value) = (cell.parse::<f64>().unwrap(), floats(batch, name)[point]);
            assert_eq!(written.to_bits(), value.to_bits(), "{name}");
            long += usize::from(format!("{value:.15e}").parse() != Ok(value));
        }
    }
    assert!(long > 100, "some numbers need all seventeen digits: {long}");
    let start = |name: &str| floats(batch, name)[0];
    assert_eq!([start("r_po_e_x_m"), start("r_po_e_y_m"), start("r_po_e_z_m")], [0.0; 3]);
    assert_eq!([start("v_po_e_x_m_s"), start("v_po_e_y_m_s"), start("v_po_e_z_m_s")], [10.0, 0.0, 0.0]);
}

#[test]
fn the_end_of_a_mission_is_said() {
    let scratch = folder("mission-end");
    for (options, code, said) in [
        ("--set guidance.detumble.timeout_s=5", 1.0, "mission failed at # s: a phase took too long"),
        ("--sample 1", 0.0, "mission launched at # s"),
    ] {
        let found = scratch.says("simulate", "net_launch.toml", options, 0);
        assert!(!found.contains("NaN"), "{found}");
        let campaign = if code > 0.0 { options } else { "" };
        scratch.says("campaign", "net_launch.toml", &format!("{campaign} --samples 2 --out r{code} --no-report"), 5);
        let rows = &scratch.table(&format!("r{code}/runs/part-000000.parquet"));
        let row = usize::from(code == 0.0);
        let end = floats(rows, "end_time_s")[row];
        let line = said.replace('#', &format!("{end}"));
        assert!(found.contains(&line), "{line}: {found}");
    }
}

/// Law: the velocity of p is the derivative of its position: central differences, whose error is h^2/6 r'''.
#[test]
fn the_velocity_of_p_is_the_derivative_of_its_position() {
    let scratch = folder("derivative");
    const STEP: f64 = 1e-4;
    scratch.prints("simulate small.toml --times 0.4999,0.5,0.5001 --out s.parquet", 0);
    let batch = &scratch.table("s.parquet");
    for axis in ["x", "y", "z"] {
        let r = floats(batch, &format!("r_po_e_{axis}_m"));
        let v = floats(batch, &format!("v_po_e_{axis}_m_s"))[1];
        let bound = STEP * STEP / 6.0 * 5e4 + 1e-11;
        assert!(((r[2] - r[0]) / (2.0 * STEP) - v).abs() < bound, "{axis}: {r:?} {v}");
    }
}

#[test]
fn times_may_come_in_any_order_and_lie_beyond_the_duration() {
    let scratch = folder("times");
    scratch.shows(
        "simulate small.toml --times 2.5,0.5,0.5,1 --out a.csv",
        0,
        "--times: 2.5 s is after the end of the runs of small (1.0 s)",
    );
    scratch.prints("simulate small.toml --times 0.5,1,2.5 --out b.csv", 0);
    let said = scratch.prints("simulate small.toml --times 0.5,1", 0);
    assert!(!said.contains("after the end"), "{said}");
    let text = scratch.text("a.csv");
    assert_eq!(text, scratch.text("b.csv"));
    let times: Vec<&str> = text.lines().skip(1).map(|line| line.split(',').next().unwrap()).collect();
    assert_eq!(times, ["0.5", "1.0", "2.5"]);
    scratch.prints("simulate small.toml --times 0 --out zero.csv", 0);
    assert_eq!(scratch.text("zero.csv").lines().count(), 2);
    scratch.prints("simulate small.toml --times=-1", 2);
    scratch.prints("simulate small.toml --times 1,x", 2);
}

#[test]
fn plots_and_tables_are_made() {
    let scratch = folder("plots");
    scratch.prints("simulate small.toml --plot p.html", 0);
    let page = scratch.text("p.html");
    assert!(page.contains("<h1>small, nominal</h1>"));
    let titles = |page: &str| Found::shown_on(page).into_iter().map(|(title, _)| title).collect::<Vec<_>>().join("; ");
    let shown = titles(&page);
    for title in ["wheel w1", "debris", "Angular velocity", "quaternion", "Drift of energy"] {
        assert_says(&shown, [title]);
    }
    assert!(shown.contains("Energy transfer"), "its wheels turn");
    let rigid = scratch.text("small.toml");
    let wheels = rigid.find("[[wheels]]").unwrap();
    let after = wheels + rigid[wheels..].find("\n[debris]").unwrap();
    scratch.file("rigid.toml", &[&rigid[..wheels], &rigid[after..]].concat());
    scratch.prints("simulate rigid.toml --plot rigid.html", 0);
    let shown = titles(&scratch.text("rigid.html"));
    assert!(shown.contains("Kinetic energy of the debris") && !shown.contains("Energy transfer"), "{shown}");
    let said = scratch.prints("simulate small.toml --plot q.svg --times 0,0.1,0.2", 0);
    assert!(said.contains("q.html") && scratch.path("q.html").exists() && !scratch.path("q.svg").exists(), "{said}");
    scratch.prints("simulate small.toml --plot p.pdf", 2);
    scratch.prints("simulate small.toml --out s.xlsx", 2);
    scratch.prints("simulate small.toml --out no/such/folder/s.csv", 4);
    let said = scratch.prints("simulate small.toml", 0);
    for line in said.lines() {
        assert!(line.len() <= 132, "the table fits a terminal, {} bytes: {line}", line.len());
    }
    assert!(said.contains("omega_x") && said.contains("q_es_w") && said.lines().count() >= 12, "{said}");
}

fn eight_wheels() -> String {
    let wheel = |k: usize| {
        format!(
            "[[wheels]]\nname = \"wheel_number_{k}\"\naxis = [1, 0, 0]\nposition_m = [0.2, 0, 0.3]\nmass_kg = 5\n\
            axial_inertia_kg_m2 = 0.03\ntransverse_inertia_kg_m2 = 0.02\nrate_rad_s = {}\n",
            100 + k
        )
    };
    let wheels: String = (0..8).map(wheel).collect();
    format!(
        "[campaign]\nname = \"eight\"\nsamples = 1\nseed = 1\nduration_s = 10.0\n[observe]\npoints = \
        11\n[body]\nmass_kg = 300\n\
        inertia_kg_m2 = [[60, 1, 0.5], [1, 75, 0.2], [0.5, 0.2, 90]]\nincludes_wheels = false\n{wheels}\
        [initial]\nangular_velocity_rad_s = [0.02, 0.1, 0.05]\n"
    )
}

#[test]
fn a_table_with_many_wheels_fits() {
    let scratch = folder("eight");
    scratch.file("eight.toml", &eight_wheels());
    let mut counts = Vec::new();
    for (columns, width) in [(None, 100), (Some("80"), 80), (Some("140"), 140), (Some("wide"), 100)] {
        let mut program = scratch.command("simulate eight.toml");
        let output = program.env_remove("COLUMNS").envs(columns.map(|width| ("COLUMNS", width))).output().unwrap();
        let [table, notes] = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
        assert_eq!(table.lines().count(), 13, "{table}"); // two lines of headers and the points
        assert_fits(&table, 13, width);
        assert_fits(&notes, 99, if ["80", "140"].map(Some).contains(&columns) { width } else { usize::MAX });
        let notes = notes.split_whitespace().collect::<Vec<_>>().join(" ");
        let headers = table.lines().next().unwrap();
        let shown = (0..8).filter(|k| headers.contains(&format!("rate...r_{k}"))).count();
        assert_eq!(headers.matches("rate").count(), shown, "{headers}");
        let left_out = format!("rates of wheels wheel_number_{shown} to wheel_number_7, {} of 8", 8 - shown);
        assert_says(&notes, [&format!("too wide for {width} columns"), &left_out]);
        counts.push(shown);
    }
    assert!(counts[0] >= 1 && counts[1] < counts[2] && counts[0] < counts[2] && counts[0] == counts[3], "{counts:?}");
}

#[test]
fn a_plot_of_many_wheels_names_them() {
    let scratch = folder("eight_plot");
    scratch.file("eight.toml", &eight_wheels());
    scratch.prints("simulate eight.toml --plot p.html", 0);
    let shown = Found::shown_on(&scratch.text("p.html"));
    let (_, names) = shown.iter().find(|(title, _)| title.starts_with("Wheel rates")).unwrap();
    for wheel in 0..8 {
        assert!(names.contains(&format!("wheel_number_{wheel}")), "{names:?}");
    }
}
