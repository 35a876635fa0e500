//! Plans of shipped campaigns, for tests.

use crate::campaign::Plan;
use spindrift_control::control::tables::Overrides;

pub(crate) fn text(name: &str) -> String {
    let path = format!("{}/../../campaigns/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"))
}

pub(crate) fn plan_of(text: &str, settings: &[(&str, &str)]) -> Plan {
    let settings = settings.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
    let overrides = Overrides { settings, ..Overrides::default() };
    Plan::from_text("test.toml", text, overrides).unwrap_or_else(|error| panic!("{error}"))
}

pub(crate) fn plan(name: &str) -> Plan {
    plan_of(&text(name), &[])
}
