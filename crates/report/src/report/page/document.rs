//! The page as one file: static HTML, then numbers, libraries and scripts. Nothing is loaded from elsewhere; a content
//! security policy enforces this.

use serde_json::Value;

use crate::report::page::payload::{encoded, packed};
use crate::table::html::escaped;

const STYLE: &str = include_str!("../../../../../assets/report/page.css");
const LICENCES: &str = include_str!("../../../../../assets/report/vendor/licences.txt");
pub(in crate::report) static ECHARTS: &[u8] = include_bytes!("../../../../../assets/report/vendor/echarts.js.gz");
static THREE: &[u8] = include_bytes!("../../../../../assets/report/vendor/three.js.gz");

macro_rules! modules {
    ($($name:literal),*) => { [$(($name, include_str!(concat!("../../../../../assets/report/", $name)))),*] };
}

/// The modules of the page in import order, to be joined into one script without imports and exports.
const MODULES: [(&str, &str); 18] = modules![
    "numbers.js",
    "theme.js",
    "payload.js",
    "hover.js",
    "select.js",
    "axes.js",
    "chart.js",
    "save.js",
    "figure.js",
    "pairs.js",
    "tables.js",
    "motion.js",
    "bodies.js",
    "approach.js",
    "sky.js",
    "live.js",
    "replay.js",
    "main.js"
];

/// Restricts scripts to the contents of the page.
const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:; \
    base-uri 'none'; form-action 'none'";

pub struct PageSection {
    pub anchor: &'static str,
    pub title: &'static str,
    pub lead: String,
    pub html: String,
    pub has_figures: bool,
    /// True if the content is folded, and initially open.
    pub fold: Option<bool>,
}

impl PageSection {
    /// Without figures, and not folded.
    pub fn new(anchor: &'static str, title: &'static str, lead: impl Into<String>, html: String) -> Self {
        PageSection { anchor, title, lead: lead.into(), html, has_figures: false, fold: None }
    }
}

fn script() -> String {
    script_of(&MODULES.map(|(name, _)| name))
}

/// The named modules as one script, without imports and exports.
pub(in crate::report) fn script_of(names: &[&str]) -> String {
    let line = |line: &str| {
        let line = line.strip_prefix("export ").unwrap_or(line);
        if line.starts_with("import ") { String::new() } else { format!("{line}\n") }
    };
    let module = |(name, text): &(&str, &str)| format!("// {name}\n{}", text.lines().map(line).collect::<String>());
    let text: String = MODULES.iter().filter(|(name, _)| names.contains(name)).map(module).collect();
    format!("\"use strict\";\n{text}")
}

/// The beginning of a page up to its body; `style` follows that of every page.
pub(in crate::report) fn head(title: &str, policy: &str, style: &str) -> String {
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta \
        http-equiv=\"Content-Security-Policy\" content=\"{policy}\">\n<meta name=\"viewport\" \
        content=\"width=device-width, initial-scale=1\">\n<title>{} - spindrift</title>\n<link rel=\"icon\" \
        href=\"data:,\">\n<style>\n{STYLE}{style}</style>\n</head>\n",
        escaped(title)
    )
}

/// The whole page. `answers` names the table of its first screen, if any; `data` locates the numbers in the compressed
/// payload `numbers`; `title` is that of the tab.
pub fn document(
    title: &str,
    (first_screen, answers): (&str, Option<&'static str>),
    sections: &[PageSection],
    data: &Value,
    numbers: &str,
) -> String {
    let links: String = answers
        .map(|name| ("verdicts", name))
        .into_iter()
        .chain(sections.iter().map(|section| (section.anchor, section.title)))
        .map(|(anchor, title)| format!("<a href=\"#{anchor}\">{}</a>", escaped(title)))
        .collect();
    let body: String = sections
        .iter()
        .map(|section| {
            let lead =
                if section.lead.is_empty() { String::new() } else { format!("<p class=\"lead\">{}</p>", section.lead) };
            let figures = if section.has_figures { "<div class=\"figures\"></div>" } else { "" };
            let content = format!("{figures}{}", section.html);
            let content = match section.fold {
                None => content,
                Some(is_open) => format!(
                    "<details class=\"fold\"{}><summary>Show</summary>{content}</details>",
                    if is_open { " open" } else { "" }
                ),
            };
            format!(
                "<section id=\"{}\"><h2><a href=\"#{}\">{}</a></h2>{lead}{content}</section>\n",
                section.anchor,
                section.anchor,
                escaped(section.title),
            )
        })
        .collect();
    let block =
        |id: &str, text: &str| format!("<script type=\"application/octet-stream\" id=\"{id}\">{text}</script>\n");
    format!(
        "{}<body>\n<nav aria-label=\"Sections\"><div class=\"links\">{links}</div><button type=\"button\" id=\"theme\" \
        hidden>dark</button></nav>\n<header>{first_screen}</header>\n<main>\n<noscript><p class=\"lead\">Figures need \
        JavaScript; the tables below do not.</p></noscript>\n{body}</main>\n\
         {}{}{}{}{}<script>\n{}</script>\n</body>\n</html>\n",
        head(title, POLICY, ""),
        block("data", &packed(data.to_string().as_bytes())),
        block("numbers", numbers),
        block("licence-texts", &packed(LICENCES.as_bytes())),
        block("echarts", &encoded(ECHARTS)),
        if data["replay"].is_null() { String::new() } else { block("three", &encoded(THREE)) },
        script(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: the modules do not end their script element, stand in import order, and share no name.
    #[test]
    fn the_modules_make_one_script() {
        let text = script();
        assert!(!text.contains("</") && !text.contains("<!--"), "the end of a script element within it");
        let mut names: Vec<&str> = Vec::new();
        for (place, (file, module)) in MODULES.iter().enumerate() {
            for line in module.lines() {
                if let Some((_, from)) = line.strip_prefix("import ").and_then(|rest| rest.split_once(" from \"./")) {
                    let from = from.trim_end_matches("\";");
                    assert!(
                        MODULES[..place].iter().any(|(name, _)| *name == from),
                        "{file} imports {from}, which is not before it"
                    );
                }
                let declared = line.strip_prefix("export ").unwrap_or(line);
                let declared = ["async function ", "function ", "const ", "let ", "class "]
                    .into_iter()
                    .find_map(|word| declared.strip_prefix(word));
                let name = declared.map(|rest| {
                    rest.split(|letter: char| !letter.is_alphanumeric() && letter != '_').next().unwrap_or_default()
                });
                if let Some(name) = name.filter(|name| !name.is_empty()) {
                    assert!(!names.contains(&name), "{file}: {name} is declared twice");
                    names.push(name);
                }
            }
        }
        assert!(names.len() > 30, "{names:?}");
    }
}
