//! [`text`]: verdicts as JUnit XML for build servers, reproducible byte for byte.

use std::fmt::Write;

use crate::analysis::analysed::Analysed;
use crate::campaign::Plan;
use crate::findings::{Finding, Findings, Kind, Verdict};
use crate::table::html::escaped;

/// One test case per requirement (undecided: an error), and one each for: all runs `ok`, estimates cover their errors
/// as promised (if audited), `[stop]` reached its goal.
pub fn text(plan: &Plan, analysed: &Analysed, findings: &Findings) -> String {
    let name = escaped(&plan.name);
    let statuses = &analysed.tally.statuses;
    let lost = statuses.runs() - statuses.ok();
    // title; element, type and message of a problem
    let mut cases: Vec<(String, Option<[String; 3]>)> = Vec::new();
    let problem = |element: &str, kind: &str, message: &str| Some([element, kind, message].map(str::to_owned));
    let computed = findings.of(Kind::Loss).next().map_or("", |one| one.sentence.as_str());
    cases.push(("every run is ok".to_owned(), problem("failure", "failed runs", computed).filter(|_| lost > 0)));
    if analysed.tally.audits.is_some() {
        let broken: Vec<&str> =
            findings.of(Kind::Warning).filter(|one| one.id == "audit").map(|one| one.sentence.as_str()).collect();
        let broken = problem("failure", "audit", &broken.join("; ")).filter(|_| !broken.is_empty());
        cases.push(("audited errors are within their estimates".to_owned(), broken));
    }
    let of = |one: &Finding| {
        let message = core::iter::once(&one.sentence).chain(&one.notes).cloned().collect::<Vec<_>>().join("; ");
        let found = match one.verdict {
            Some(Verdict::Fail) => problem("failure", "requirement", &message),
            Some(Verdict::Undecided) => problem("error", "undecided", &message),
            _ => None,
        };
        (one.title.clone(), found)
    };
    cases.extend(findings.of(Kind::Requirement).map(of));
    for stop in findings.of(Kind::Stop) {
        let is_reached = analysed.stopping.as_ref().is_none_or(|stopping| stopping.is_reached());
        let missed = problem("error", "stop", &stop.sentence).filter(|_| !is_reached);
        cases.push(("[stop] reaches its goal".to_owned(), missed));
    }
    let count =
        |element: &str| cases.iter().filter(|(_, found)| found.as_ref().is_some_and(|one| one[0] == element)).count();
    let counts = format!("tests=\"{}\" failures=\"{}\" errors=\"{}\"", cases.len(), count("failure"), count("error"));
    let mut xml = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    xml += &format!("<testsuites name=\"spindrift\" {counts}>\n  <testsuite name=\"{name}\" {counts}>\n");
    let asked = findings.verdict.map(|_| ("test cases".to_owned(), findings.asked.clone()));
    let brackets = findings.brackets().map(|said| ("in brackets".to_owned(), said));
    let properties: String = asked
        .into_iter()
        .chain(brackets)
        .map(|(name, value)| format!("      <property name=\"{name}\" value=\"{}\"/>\n", escaped(&value)))
        .collect();
    if !properties.is_empty() {
        xml += &format!("    <properties>\n{properties}    </properties>\n");
    }
    for (title, found) in cases {
        let title = escaped(&title);
        let _ = match found {
            None => writeln!(xml, "    <testcase classname=\"{name}\" name=\"{title}\"/>"),
            Some([element, kind, message]) => writeln!(
                xml,
                "    <testcase classname=\"{name}\" name=\"{title}\">\n      <{element} type=\"{kind}\" \
                 message=\"{}\"/>\n    \
                 </testcase>",
                escaped(&message)
            ),
        };
    }
    xml + "  </testsuite>\n</testsuites>\n"
}
