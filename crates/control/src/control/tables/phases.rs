//! `[[guidance]]`: the phases of a control loop and their order.

use super::module::ModuleKey;
use crate::campaign::section::Section;
use crate::campaign::tables::{ignore_others, read_keys};
use crate::control::laws::{self, LawKind};
use crate::control::{flight_code, parameters};
use crate::loops::callback;
use crate::loops::condition::Condition;
use crate::loops::phase::{MANEUVERS, Maneuver, Next};
use crate::loops::rod_law::{ROD_LAWS, RodLaw};
use crate::loops::spec::PhaseSpec;
use crate::loops::target::{TARGETS, Target};
use crate::sampling::keys::{ANY_TEXT, Condition as When, Kind, Row, Rule, words};
use crate::scene::schema::control::kept;
use crate::scene::table::Table;
use crate::scene::{DeclaredTable, LawParameter, Name, SceneInput, WheelMode};

/// A phase name that stands for the launch of the net.
const LAUNCH: &str = "launch";
/// The law with an optional term omega x H.
const GYROSCOPIC: &str = "mrp_feedback";
const TARGET_NAMES: [&str; TARGETS.len()] = words(&TARGETS);
const MANEUVER_NAMES: [&str; MANEUVERS.len()] = words(&MANEUVERS);
const ROD_USE_NAMES: [&str; ROD_LAWS.len()] = words(&ROD_LAWS);

/// The keys of `[[guidance]]` that are not parameters.
#[rustfmt::skip]
pub const ROWS: [Row; 9] = [
    Row::new("phase", Kind::Text(ANY_TEXT), "Its name").required_as(Name::ALLOWED, "\"hold\""),
    Row::new("law", Kind::OneOf(|| laws::KINDS.iter().map(|kind| kind.name).collect()),
        "The law of attitude, or `module`; default: no torque"),
    Row::new("gyroscopic", Kind::Flag, "Whether mrp_feedback has the term omega x H; default: false"),
    Row::new("target", Kind::Word(&TARGET_NAMES), "The attitude that it wants"),
    Row::new("thrust", Kind::Word(&MANEUVER_NAMES), "What thrust is for"),
    Row::new("rods", Kind::Word(&ROD_USE_NAMES), "What torque rods are for").sparse(),
    Row::new("until", Kind::Text(ANY_TEXT), "The condition that ends it; default: it lasts to the end of the run"),
    Row::new("next", Kind::Text(ANY_TEXT), "The phase that follows, or `launch`; default: the next one of the file"),
    Row::new("otherwise", Kind::Text(ANY_TEXT), "The phase that follows at once where the condition is not met"),
];

pub const RULES: [Rule; 2] = [
    Rule::Only {
        keys: &["gyroscopic"],
        with: &[When::Is("law", GYROSCOPIC)],
        allowed: "left out where the law is not \"mrp_feedback\"",
        remedy: "delete this line",
    },
    Rule::Only {
        keys: &["hold_s", "next", "otherwise"],
        with: &[When::Has("until")],
        allowed: "left out without `until`",
        remedy: "add until = \"...\", or delete this line",
    },
];

/// The law of a phase; a wrong module, reported already, counts as none.
fn law<'k>(section: &mut Section<'_, '_>, kinds: &[&'k LawKind], module: &ModuleKey) -> Option<&'k LawKind> {
    let is_module = section.value("law").and_then(|value| value.get_ref().as_str()) == Some(flight_code::NAME);
    match module {
        ModuleKey::Wrong if is_module => {
            section.know("law");
            None
        }
        ModuleKey::Absent if is_module => {
            let allowed = "another law where [control] has no `module`";
            section.refuse("law", allowed, "add module = \"law.wasm\" to [control], or name another law");
            None
        }
        _ => {
            let names: Vec<&str> = kinds.iter().map(|kind| kind.name).collect();
            section.name("law", &names, |name| kinds.iter().find(|kind| kind.name == name).copied())
        }
    }
}

/// Reads one table of `[[guidance]]` and adds its name to `taken`. `None` if its name, or a word on which other keys
/// depend, is wrong.
pub(super) fn read_phase(
    section: &mut Section<'_, '_>,
    scene: &mut SceneInput,
    ([has_thrusters, has_rods], module, own): ([bool; 2], &ModuleKey, Option<&LawKind>),
    taken: &mut Vec<Name>,
) -> Option<PhaseSpec> {
    section.require("phase", Name::ALLOWED, "\"hold\"");
    let name = section.text("phase").map(|text| (text, Name::new(text)));
    let name = match name {
        Some((text, Some(name))) if text != LAUNCH && !taken.contains(&name) => Some(name),
        Some((_, None)) => {
            section.refuse("phase", Name::ALLOWED, "write a name such as \"aim\"");
            None
        }
        Some(_) => {
            section.refuse(
                "phase",
                "another name than that of the other phases, and than \"launch\"",
                "give each its own name",
            );
            None
        }
        None => None,
    };
    let own_name = name.unwrap_or_else(|| Name::number(taken.len()));
    taken.push(own_name);
    if name.is_some() {
        section.rename("guidance", own_name.as_str());
    }
    let has_debris = scene.debris.is_some();
    let python = own.filter(|own| **own == callback::MISSING).unwrap_or(&callback::MISSING);
    let brought = [python].into_iter().chain(own.filter(|own| *own != python)).chain(module.kind());
    let kinds: Vec<&LawKind> = laws::KINDS.iter().chain(brought).collect();
    let law = law(section, &kinds, module);
    let mut written = section.right_rows(&ROWS[4..]);
    written.extend(section.right_rows(&ROWS[2..3]));
    if !section.has("law") || law.is_some() {
        section.obeys(&RULES[0], true);
    }
    let (has_orbit, has_date) = (scene.orbit.is_some(), scene.orbit.is_some_and(|orbit| orbit.epoch.is_some()));
    let is_there = |target: &Target| {
        (has_debris || !target.needs_debris())
            && (has_orbit || !target.needs_orbit())
            && (has_date || *target != Target::Sun)
    };
    let targets: Vec<(&str, Target)> = TARGETS.into_iter().filter(|(_, target)| is_there(target)).collect();
    let names: Vec<&str> = targets.iter().map(|(name, _)| *name).collect();
    let target = section.name("target", &names, |name| targets.iter().find(|(known, _)| *known == name).copied());
    let mut is_known = !(section.has("law") && law.is_none() || section.has("target") && target.is_none());
    let (target_name, target) = target.unwrap_or(TARGETS[0]);
    let thrust = written.meaning("thrust", &MANEUVERS);
    let rods = written.meaning("rods", &ROD_LAWS);
    is_known &= thrust.is_some() && rods.is_some();
    let (thrust, rods) = (thrust.unwrap_or(Maneuver::None), rods.unwrap_or(RodLaw::None));
    if thrust != Maneuver::None && !(has_thrusters && has_debris) {
        let allowed = "\"none\" in a loop without thrusters, or without debris";
        section.refuse(
            "thrust",
            allowed,
            "add thrusters = [...] to [control] and a [debris] table, or delete this line",
        );
    }
    if rods != RodLaw::None && !has_rods {
        let remedy = "add torque_rods = [...] to [control], or delete this line";
        section.refuse("rods", "\"none\" in a loop without torque rods", remedy);
    }
    if rods.unloads() && scene.wheels.iter().all(|wheel| wheel.mode == WheelMode::Locked) {
        section.refuse("rods", "another use where no wheel turns", "add a [[wheels]] table, or write rods = \"b_dot\"");
    }
    if matches!((target, thrust), (Target::Transfer, Maneuver::Stop) | (Target::Stop, Maneuver::Transfer)) {
        section.refuse(
            "thrust",
            "\"none\", or what the target is for",
            "write the same word, or target = \"velocity\"",
        );
    }
    section.obeys(&RULES[1], true);
    let until = written.text("until").and_then(|text| match Condition::parse(text, has_debris) {
        Ok(condition) => Some(condition),
        Err(allowed) => {
            section.refuse("until", allowed, "write it like \"body_rate_rad_s < 0.002\"");
            None
        }
    });
    let mut lists = parameters::of_phase(target, thrust, [section.has("until"), has_thrusters]);
    lists.push(rods.parameters());
    if let Some(law) = law {
        let is_taken = |parameter: &LawParameter| {
            let key = parameter.facts.key;
            ROWS.iter().any(|row| row.key == key)
                || lists.iter().any(|list| list.iter().any(|other| other.facts.key == key))
        };
        if let Some(taken) = law.parameters.iter().find(|parameter| is_taken(parameter)) {
            let allowed = format!("a law whose parameters are not also keys of the phase ({:?} is)", taken.facts.key);
            return section.refused("law", allowed, "rename the parameter");
        }
        lists.push(law.parameters);
    }
    scene.control.guidance.push(DeclaredTable::of(own_name, kept(&lists)));
    let place = scene.control.guidance.len() - 1;
    read_keys(section, Table::Guidance, place, scene);
    if !is_known {
        return None;
    }
    let place = law.and_then(|law| kinds.iter().position(|kind| *kind == law));
    ignore_others(section, "law", place, kinds.iter().map(|kind| (kind.name, kind.parameters)));
    section.finish();
    let gyroscopic = written.flag("gyroscopic");
    written = written.with("phase", own_name.as_str()).with("target", target_name);
    law.into_iter().for_each(|law| written.set("law", law.name));
    let (next, otherwise) = (Next::Stay, None);
    let law = law.cloned();
    name.map(|_| PhaseSpec { name: own_name, law, gyroscopic, target, thrust, rods, until, next, otherwise, written })
}

/// Links the phases; one with a condition and without `next` leads to the next in the list.
pub(super) fn connected(
    root: &mut Section<'_, '_>,
    phases: Vec<Option<PhaseSpec>>,
    names: &[Name],
) -> Option<Vec<PhaseSpec>> {
    let place = |word: &str| names.iter().position(|name| name.as_str() == word);
    let mut list = Vec::with_capacity(phases.len());
    let count = phases.len();
    // a phase with a wrong name may be the one meant
    let is_known = phases.iter().all(Option::is_some);
    let mut is_whole = true;
    for (index, phase) in phases.into_iter().enumerate() {
        let Some(mut spec) = phase else {
            is_whole = false;
            continue;
        };
        let [next, otherwise] = ["next", "otherwise"].map(|key| spec.written.text(key).map(str::to_owned));
        let mut unknown = |key: &str, word: &str, also: &str| {
            is_whole = false;
            if !is_known {
                return;
            }
            let known: Vec<&str> = names.iter().map(Name::as_str).collect();
            let allowed = format!("the name of a phase ({}){also}", known.join(", "));
            let path = format!("guidance.{}.{key}", spec.name);
            root.document.add(&path, Some(format!("{word:?}")), allowed, "write the name of another phase");
        };
        match next.as_deref() {
            Some(LAUNCH) => spec.next = Next::Launch,
            Some(word) => match place(word) {
                Some(place) => spec.next = Next::Phase(place),
                None => unknown("next", word, " or \"launch\""),
            },
            None if spec.until.is_some() && index + 1 < count => {
                spec.next = Next::Phase(index + 1);
                spec.written.set("next", names[index + 1].as_str());
            }
            None => {}
        }
        if let Some(word) = otherwise.as_deref() {
            match place(word) {
                Some(place) => spec.otherwise = Some(place),
                None => unknown("otherwise", word, ""),
            }
        }
        spec.written = spec.written.completed(&ROWS, &RULES);
        list.push(spec);
    }
    is_whole.then_some(list)
}
