//! Files of the format before 0.2, with `[fuselage]`, `[wheel1]`, `[wheel2]` and thrusts by number: refused, with their new text.

use super::document::Document;
use super::section::Section;
use std::fmt::Write;

/// The old tables, which have new text.
const TABLES: [&str; 3] = ["fuselage", "wheel1", "wheel2"];
/// Keys of `[initial]` that belong to the wheels now.
const INITIAL: [&str; 2] = ["wheel_angles_rad", "wheel_rates_rad_s"];
/// Keys of `[actuators]` that belong to thrusters and wheels now.
const ACTUATORS: [&str; 6] = [
    "thrust_scale",
    "thruster1_tilt_rad",
    "thruster2_tilt_rad",
    "thruster3_tilt_rad",
    "torque_scale",
    "torque_bias_n_m",
];
/// Keys of `[fuselage]` that are of the hollow cylinder.
const SHELL: [&str; 4] = ["wall_thickness_m", "outer_radius_m", "length_m", "density_kg_m3"];
/// Keys of `[fuselage]` that are of the body as a whole.
const WHOLE: [&str; 11] = [
    "mass_kg",
    "center_of_mass_m",
    "inertia_kg_m2",
    "principal_moments_kg_m2",
    "principal_second_moments_kg_m2",
    "principal_axes",
    "mass_scale",
    "inertia_scale",
    "stretch_log",
    "shear",
    "center_offset_m",
];

/// Refuses the tables of the old format, each with its new text; `None` where there are none.
pub(super) fn refuse(root: &mut Section<'_, '_>) -> Option<Old> {
    if !TABLES.iter().any(|table| root.has(table)) {
        return None;
    }
    let old = Old::read(root);
    for table in TABLES.into_iter().filter(|table| root.has(table)).collect::<Vec<_>>() {
        root.know(table);
        let text = if table == "fuselage" { old.body() } else { old.wheel(usize::from(table == "wheel2")) };
        root.refuse_value(table, "a table of the old format".to_owned(), "left out", format!("write instead\n{text}"));
    }
    Some(old)
}

/// Whether tables of the old format were refused.
pub(super) fn is_refused(document: &Document<'_>) -> bool {
    TABLES.iter().any(|table| document.is_reported(table))
}

/// Refuses the keys of `[initial]` that belong to wheels now.
pub(super) fn refuse_initial(section: &mut Section<'_, '_>) {
    for (key, new) in INITIAL.into_iter().zip(["angle_rad", "rate_rad_s"]) {
        section.know(key);
        if section.has(key) {
            let allowed = format!("left out: {new} of each wheel says it");
            section.refuse(key, allowed, "delete this line; the text for [[wheels]] has it");
        }
    }
}

/// Refuses the keys of `[actuators]` that belong to thrusters and wheels now.
pub(super) fn refuse_actuators(section: &mut Section<'_, '_>) {
    for key in ACTUATORS {
        section.know(key);
        if section.has(key) {
            let allowed = "left out: thrusters and wheels say it";
            section.refuse(key, allowed, "delete this line; the text for the tables has it");
        }
    }
}

/// The new name of a parameter of the old format, if `name` is one.
pub(super) fn new_name(name: &str) -> Option<String> {
    let (table, key) = name.split_once('.')?;
    let wheel = |index: &str| match index {
        "[0]" | ".1" => Some("w1"),
        "[1]" | ".2" => Some("w2"),
        _ => None,
    };
    match table {
        "fuselage" if key.starts_with("thruster_offset_m") => {
            Some("thrusters.p3.position_m.y (and -thrusters.p3.position_m.y for p2, by [[derive]])".to_owned())
        }
        "fuselage" if SHELL.contains(&key) => Some(format!("body.parts.fuselage.{key}")),
        "fuselage" => Some(format!("body.{key}")),
        "wheel1" => Some(wheel_key("wheels.w1", key)),
        "wheel2" => Some(wheel_key("wheels.w2", key)),
        "initial" => {
            let rest = key.strip_prefix("wheel_rates_rad_s").map(|rest| (rest, "rate_rad_s"));
            let (rest, new) = rest.or_else(|| key.strip_prefix("wheel_angles_rad").map(|rest| (rest, "angle_rad")))?;
            match wheel(rest) {
                Some(wheel) => Some(format!("wheels.{wheel}.{new}")),
                None => Some(format!("wheels.w1.{new} and wheels.w2.{new}, one table each")),
            }
        }
        "actuators" if key.starts_with("thruster") => {
            let (number, component) = key.strip_prefix("thruster")?.split_once("_tilt_rad")?;
            Some(format!("thrusters.p{number}.tilt_rad{}", across(component)))
        }
        "actuators" if key.starts_with("thrust_scale") => Some(match &key["thrust_scale".len()..] {
            "[0]" | ".1" => "thrusters.p1.thrust_scale".to_owned(),
            "[1]" | ".2" => "thrusters.p2.thrust_scale".to_owned(),
            "[2]" | ".3" => "thrusters.p3.thrust_scale".to_owned(),
            _ => "thrusters.p1.thrust_scale, and so on".to_owned(),
        }),
        "actuators" if key.starts_with("torque_") => {
            let (new, index) = key.split_at(key.find(['.', '[']).unwrap_or(key.len()));
            Some(match wheel(index) {
                Some(wheel) => format!("wheels.{wheel}.{new}"),
                None => format!("wheels.w1.{new} and wheels.w2.{new}, one table each"),
            })
        }
        _ => None,
    }
}

/// The new name of an old key of a wheel, which is `wheel` now.
fn wheel_key(wheel: &str, key: &str) -> String {
    match key {
        "station_m" => format!("{wheel}.position_m.z"),
        "offset_m" => format!("{wheel}.position_m.x and {wheel}.position_m.y, one table each"),
        _ => match key.strip_prefix("tilt_rad") {
            Some(component) => format!("{wheel}.tilt_rad{}", across(component)),
            None => format!("{wheel}.{}", key.replace("offset_m", "position_m")),
        },
    }
}

/// The component of an alignment error, which was named by an axis of F_s: the first is about s1 in each case.
fn across(component: &str) -> &str {
    match component {
        ".x" => ".1",
        ".y" | ".z" => ".2",
        other => other,
    }
}

/// One old table as text: keys and their values as written.
#[derive(Debug, Default)]
struct OldTable(Vec<(String, String)>);

impl OldTable {
    fn get(&self, key: &str) -> Option<&str> {
        self.0.iter().find(|(known, _)| known == key).map(|(_, value)| value.as_str())
    }

    fn has(&self, key: &str) -> bool {
        self.get(key).is_some()
    }

    /// Element `index` of a list.
    fn element(&self, key: &str, index: usize) -> Option<&str> {
        let list = self.get(key)?.trim().strip_prefix('[')?.strip_suffix(']')?;
        Some(list.split(',').nth(index)?.trim()).filter(|text| !text.is_empty())
    }

    /// The lines of `keys` that were written.
    fn lines(&self, keys: &[&str]) -> String {
        let written = keys.iter().filter_map(|key| Some(format!("{key} = {}\n", self.get(key)?)));
        written.collect()
    }
}

/// The old tables of a file.
#[derive(Debug)]
pub(super) struct Old {
    fuselage: OldTable,
    wheels: [OldTable; 2],
    initial: OldTable,
    actuators: OldTable,
    actuation: Vec<OldTable>,
}

impl Old {
    fn read(root: &Section<'_, '_>) -> Self {
        let table = |key: &str| OldTable(root.entries(key));
        Old {
            fuselage: table("fuselage"),
            wheels: [table("wheel1"), table("wheel2")],
            initial: table("initial"),
            actuators: table("actuators"),
            actuation: root.lists_of_entries("actuation").into_iter().map(OldTable).collect(),
        }
    }

    /// Refuses the commands of arc `index`, with the new text of its table; that of the first arc has the thrusters too.
    pub(super) fn refuse_arc(&self, section: &mut Section<'_, '_>, index: usize) {
        const COMMANDS: [&str; 2] = ["thrust_n", "torque_n_m"];
        COMMANDS.into_iter().for_each(|key| section.know(key));
        let Some(key) = COMMANDS.into_iter().find(|key| section.has(key)) else { return };
        let thrusters = if index == 0 { self.thrusters() } else { String::new() };
        let text = self.arcs().into_iter().nth(index).unwrap_or_default();
        let allowed = "by the names of [[thrusters]] and [[wheels]]";
        section.refuse(key, allowed, format!("write instead\n{text}{thrusters}"));
    }

    /// The body.
    fn body(&self) -> String {
        let mut text = format!("[body]\n{}", self.fuselage.lines(&WHOLE));
        let _ = write!(
            text,
            "\n[[body.parts]]\nname = \"fuselage\"\nshape = \"hollow_cylinder\"\n{}",
            self.fuselage.lines(&SHELL)
        );
        if let Some(length) = self.fuselage.get("length_m").and_then(|text| text.parse::<f64>().ok()) {
            let _ = writeln!(text, "position_m = [0, 0, {:?}]", 0.5 * length);
        }
        text
    }

    /// A wheel.
    fn wheel(&self, index: usize) -> String {
        let old = &self.wheels[index];
        let (number, axis) = [("1", "[0, 1, 0]"), ("2", "[0, 0, 1]")][index];
        let offset = |component| old.element("offset_m", component).unwrap_or("0");
        let station = old.get("station_m").unwrap_or("0");
        let mut text = format!(
            "[[wheels]]\nname = \"w{number}\"\naxis = {axis}\nposition_m = [{}, {}, {station}]\n{}",
            offset(0),
            offset(1),
            old.lines(&["radius_m", "length_m", "density_kg_m3", "tilt_rad"])
        );
        if let Some(mode) = old.get("wheel_mode") {
            let _ = writeln!(text, "mode = {mode}");
        }
        for (key, table, new) in [
            ("wheel_rates_rad_s", &self.initial, "rate_rad_s"),
            ("wheel_angles_rad", &self.initial, "angle_rad"),
            ("torque_scale", &self.actuators, "torque_scale"),
            ("torque_bias_n_m", &self.actuators, "torque_bias_n_m"),
        ] {
            if let Some(value) = table.element(key, index) {
                let _ = writeln!(text, "{new} = {value}");
            }
        }
        text
    }

    /// The arcs that have lists.
    fn arcs(&self) -> Vec<String> {
        let named = |arc: &OldTable, key: &str, names: &[&str]| {
            let number = |index| arc.element(key, index).unwrap_or("0");
            let entries: Vec<String> =
                names.iter().enumerate().map(|(index, name)| format!("{name} = {}", number(index))).collect();
            if arc.has(key) { format!("{key} = {{ {} }}\n", entries.join(", ")) } else { String::new() }
        };
        let present: Vec<&str> = ["w1", "w2"]
            .into_iter()
            .zip(&self.wheels)
            .filter(|(_, wheel)| !wheel.0.is_empty())
            .map(|(name, _)| name)
            .collect();
        let text = |arc: &OldTable| {
            let torques = if present.len() == 2 || arc.element("torque_n_m", 1).is_none() {
                named(arc, "torque_n_m", &present)
            } else {
                named(arc, "torque_n_m", &["w1", "w2"])
            };
            format!(
                "[[actuation]]\n{}{}{torques}",
                arc.lines(&["start_s", "end_s"]),
                named(arc, "thrust_n", &["p1", "p2", "p3"])
            )
        };
        self.actuation.iter().map(text).collect()
    }

    /// The thrusters.
    fn thrusters(&self) -> String {
        let length = self.fuselage.get("length_m").unwrap_or("0");
        let offset = self.fuselage.get("thruster_offset_m").unwrap_or("0");
        let positions =
            ["[0, 0, 0]".to_owned(), format!("[0, -{offset}, {length}]"), format!("[0, {offset}, {length}]")];
        let mut text = String::new();
        for (index, position) in positions.iter().enumerate() {
            let direction = if index == 0 { "[0, 0, 1]" } else { "[0, 0, -1]" };
            let number = index + 1;
            let _ = write!(
                text,
                "\n[[thrusters]]\nname = \"p{number}\"\nposition_m = {position}\ndirection = {direction}\n"
            );
            if let Some(tilt) = self.actuators.get(&format!("thruster{number}_tilt_rad")) {
                let _ = writeln!(text, "tilt_rad = {tilt}");
            }
            if let Some(scale) = self.actuators.element("thrust_scale", index) {
                let _ = writeln!(text, "thrust_scale = {scale}");
            }
        }
        text
    }
}
