//! `control.module`: a WebAssembly module with a law for phases.

use crate::campaign::data_keys::found;
use crate::campaign::input_file::{self, InputError};
use crate::campaign::section::Section;
use crate::campaign::units;
use crate::control::flight_code::{self, FlightCode, MOST_BYTES};
use crate::control::laws::LawKind;
use crate::loops::sensor_spec::SensorSpec;
use crate::loops::spec::ModuleSpec;
use crate::sampling::Written;
use crate::sampling::keys::{Condition, Rule};
use sha2::{Digest, Sha256};

pub(super) const RULE: Rule = Rule::Only {
    keys: &["module_sha256"],
    with: &[Condition::Has("module")],
    allowed: "left out without `module`",
    remedy: "delete it, or add module = \"law.wasm\"",
};

pub(super) enum ModuleKey {
    /// Nothing.
    Absent,
    /// Wrong, and reported.
    Wrong,
    Read(ModuleSpec),
}

impl ModuleKey {
    pub fn kind(&self) -> Option<&LawKind> {
        match self {
            ModuleKey::Read(module) => Some(&module.code.kind),
            _ => None,
        }
    }
}

/// Reads `module` and `module_sha256` of `[control]`; completes the checksum in `written`.
pub(super) fn read(section: &mut Section<'_, '_>, written: &mut Written) -> ModuleKey {
    let [file, sha256] = ["module", "module_sha256"].map(|key| written.text(key).map(str::to_owned));
    if !section.has("module") {
        return if section.obeys(&RULE, true) { ModuleKey::Absent } else { ModuleKey::Wrong };
    }
    let Some(file) = file else { return ModuleKey::Wrong };
    match module(section, &file, sha256.as_deref()) {
        Ok(code) => {
            written.set("module_sha256", &*code.sha256);
            ModuleKey::Read(ModuleSpec { file, code })
        }
        Err((key, allowed, remedy)) => {
            section.refuse(key, allowed, remedy);
            ModuleKey::Wrong
        }
    }
}

/// Refuses a module whose sensors the file does not have.
pub(super) fn check_sensors(root: &mut Section<'_, '_>, module: &ModuleSpec, sensors: &[Option<SensorSpec>]) {
    let has = |sensor: &SensorSpec| (sensor.name.to_string(), sensor.kind.name);
    let there: Vec<(String, &str)> = sensors.iter().flatten().map(has).collect();
    for wanted in module.code.sensors {
        if there.iter().any(|(name, kind)| name == wanted.name && *kind == wanted.kind) {
            continue;
        }
        let listed: Vec<String> = there.iter().map(|(name, kind)| format!("{name:?}, a {kind}")).collect();
        let listed = if listed.is_empty() { "none".to_owned() } else { listed.join("; ") };
        let allowed = format!(
            "a module whose sensors are in the file: it wants {:?}, a {}; there is {listed}",
            wanted.name, wanted.kind
        );
        let remedy = format!(
            "add a [[sensors]] table with name = {:?} and kind = {:?}, or rename one",
            wanted.name, wanted.kind
        );
        root.document.add("control.module", Some(format!("{:?}", module.file)), allowed, &remedy);
    }
}

/// The module in the file `name` with the checksum `sha256`; or the wrong key, its allowed values and the remedy.
fn module(
    section: &mut Section<'_, '_>,
    name: &str,
    sha256: Option<&str>,
) -> Result<&'static FlightCode, (&'static str, String, String)> {
    let of_file = |allowed: String, remedy: &str| ("module", allowed, remedy.to_owned());
    if !name.ends_with(".wasm") {
        return Err(of_file("a file whose name ends in .wasm".to_owned(), "name the module as it was built"));
    }
    let written_at = section.value("module").map_or(0, |value| value.span().start);
    let path = found(section.document.folder_of(written_at), name, sha256);
    let bytes = input_file::read(&path, MOST_BYTES).map_err(|error| match error {
        InputError::Kind(kind) => of_file(format!("a readable file ({kind})"), "name a regular file"),
        InputError::Size(bytes) => of_file(
            format!("a file of at most {MOST_BYTES} bytes (this one has {bytes})"),
            "build it without debug information and with -O2, or leave out what it does not use",
        ),
        InputError::Io(error) => {
            section.document.unreadable += usize::from(input_file::is_unreadable(&error));
            let remedy = "its path counts from the folder of the campaign file";
            of_file(format!("a readable file ({error})"), remedy)
        }
    })?;
    let found: String = Sha256::digest(&bytes).iter().map(|byte| format!("{byte:02x}")).collect();
    if sha256.is_some_and(|sha256| sha256 != found) {
        let remedy = "bring back the module that was meant, or delete this line";
        return Err(("module_sha256", format!("the SHA-256 of the module, {found}"), remedy.to_owned()));
    }
    let code = flight_code::kept(&bytes, &found).map_err(|(allowed, remedy)| ("module", allowed, remedy))?;
    let parameters = code.kind.parameters.iter().map(|parameter| (parameter.facts.key, parameter.facts.unit));
    for (key, written) in parameters.chain(code.telemetry.iter().map(|declared| (declared.key, declared.unit))) {
        let unit = units::in_name(key);
        if written != unit {
            let allowed = format!(
                "a module whose parameters and telemetry have the unit that their key ends in ({key:?} ends in \
                {unit:?}, and says {written:?})"
            );
            return Err(of_file(allowed, "rename the key: stiffness_n_m in N m, ratio in 1"));
        }
    }
    section.document.files.push((path, found));
    Ok(code)
}
