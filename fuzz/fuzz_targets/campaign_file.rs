//! Any text as a campaign file: errors, or a plan whose text is a campaign file of the same plan.

#![no_main]

use libfuzzer_sys::fuzz_target;
use spindrift::campaign::{Overrides, Plan};

fuzz_target!(|data: &[u8]| {
    let Ok(text) = std::str::from_utf8(data) else { return };
    match Plan::from_text("fuzz.toml", text, Overrides::default()) {
        Ok(plan) => {
            let again = Plan::from_text("again.toml", &plan.text(), Overrides::default());
            let again = again.unwrap_or_else(|error| panic!("its own text is refused: {error}\n{}", plan.text()));
            assert_eq!(again.text(), plan.text());
            assert_eq!(again.row_hash(), plan.row_hash());
        }
        Err(error) => {
            let said = error.to_string();
            assert!(!said.is_empty());
            // what a file contains must not reach the terminal as commands
            assert!(!said.contains('\u{1b}'), "an escape character in {said:?}");
        }
    }
});
