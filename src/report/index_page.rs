//! The table of all results below a folder, as a page that needs no network, and as text.

use std::path::PathBuf;

use crate::findings::names::sentence;
use crate::findings::number::counted;
use crate::report::escaped::escaped;
use crate::report::summary::SummaryEnd;
use crate::table::Table;
use crate::table::text::Align;

/// The style of every page.
const STYLE: &str = include_str!("../../assets/report/page.css");

#[derive(Clone, Debug)]
pub struct IndexEntry {
    /// Its folder, from the one that is indexed.
    pub folder: PathBuf,
    /// The name of its campaign.
    pub campaign: String,
    /// The question that it answers.
    pub question: Option<String>,
    pub end: SummaryEnd,
    /// The version of the program that made it.
    pub version: String,
    /// The day of its summary, UTC.
    pub day: String,
    /// Its page, from the folder that is indexed, where there is one.
    pub page: Option<PathBuf>,
    /// What changed since the last run of the same campaign, in words; `None` of the first one.
    pub changed: Option<String>,
}

/// A folder of a result that says nothing.
#[derive(Clone, Debug)]
pub struct Unreadable {
    /// The folder, from the one that is indexed.
    pub folder: PathBuf,
    pub reason: String,
}

/// The words of verdicts.
const WORDS: [&str; 3] = ["PASS", "FAIL", "UNDECIDED"];

impl IndexEntry {
    /// The verdicts, counted, each as `said` of its count and its word: `3 PASS, 1 FAIL`; of a campaign without
    /// requirements a dash.
    fn verdicts(&self, said: impl Fn(usize, &str) -> String) -> String {
        let counts = WORDS.iter().map(|word| (self.end.count(word), word)).filter(|(count, _)| *count > 0);
        let found: Vec<String> = counts.map(|(count, word)| said(count, word)).collect();
        if found.is_empty() { "-".to_owned() } else { found.join(", ") }
    }

    /// Whether its folder has the name of its campaign, and says it.
    fn is_named(&self) -> bool {
        self.folder.file_name().is_some_and(|name| name == self.campaign.as_str())
    }

    /// The runs that were computed, of all where some were not.
    fn runs(&self) -> String {
        let SummaryEnd { rows, failed, .. } = self.end;
        if failed > 0 { format!("{} of {rows}", rows - failed) } else { rows.to_string() }
    }
}

/// The table as text for lines of `width` characters.
pub fn text(entries: &[IndexEntry], unreadable: &[Unreadable], width: usize) -> String {
    let mut table = Table::with([
        ("result", Align::Title),
        ("verdicts", Align::Whole),
        ("runs", Align::Right),
        ("day", Align::Left),
        ("version", Align::Left),
        ("since the last run", Align::Sentence),
    ]);
    for one in entries {
        let campaign = if one.is_named() { String::new() } else { format!(" ({})", one.campaign) };
        let cells = [
            format!("{}{campaign}", one.folder.display()),
            one.verdicts(|count, word| format!("{count} {word}")),
            one.runs(),
            one.day.clone(),
            one.version.clone(),
        ];
        table.row(cells.into_iter().chain([one.changed.clone().unwrap_or_default()]));
    }
    let mut text = if entries.is_empty() { String::new() } else { table.text(width) };
    if !unreadable.is_empty() {
        text += "\n  not in the table\n";
        let mut table = Table::with([("", Align::Left), ("", Align::Sentence)]);
        unreadable.iter().for_each(|one| table.row([one.folder.display().to_string(), one.reason.clone()]));
        text += &table.text(width);
    }
    text
}

/// The page; `title` is the name of the folder.
pub fn html(title: &str, entries: &[IndexEntry], unreadable: &[Unreadable]) -> String {
    let row = |one: &IndexEntry| {
        // a long name is broken between its words
        let words = |name: &str| escaped(name).replace('/', "/<wbr>").replace('_', "_<wbr>");
        let folder = words(&one.folder.display().to_string());
        let name = match &one.page {
            Some(page) => format!("<a href=\"{}\">{folder}</a>", link(&page.display().to_string())),
            None => folder,
        };
        let question = one
            .question
            .as_deref()
            .map_or(String::new(), |text| format!("<br><span class=\"quiet\">{}</span>", escaped(&sentence(text))));
        let word = |count, word: &str| format!("<span class=\"{}\">{count} {word}</span>", word.to_lowercase());
        let cells = [
            name + &question,
            if one.is_named() { String::new() } else { words(&one.campaign) },
            one.verdicts(word),
            escaped(&one.runs()),
            escaped(&one.day),
            escaped(&one.version),
            escaped(one.changed.as_deref().unwrap_or("first run")),
        ];
        let cells = HEADS.iter().zip(cells).map(|(head, cell)| format!("<td data-head=\"{head}\">{cell}</td>"));
        format!("<tr>{}</tr>\n", cells.collect::<String>())
    };
    let heads: String = HEADS.iter().map(|head| format!("<th scope=\"col\">{head}</th>")).collect();
    let rows: String = entries.iter().map(row).collect();
    let left_out: String = unreadable
        .iter()
        .map(|one| format!("<li>{}: {}</li>", escaped(&one.folder.display().to_string()), escaped(&one.reason)))
        .collect();
    let left_out = if left_out.is_empty() {
        String::new()
    } else {
        format!("<section id=\"unreadable\"><h2>Not in the table</h2><ul>{left_out}</ul></section>\n")
    };
    let (name, count) = (escaped(title), counted(entries.len(), "result"));
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta \
        http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; img-src data:; \
        base-uri 'none'; form-action 'none'\">\n<meta name=\"viewport\" content=\"width=device-width, \
        initial-scale=1\">\n<title>{name} - spindrift</title>\n<link rel=\"icon\" \
        href=\"data:,\">\n<style>\n{STYLE}{OWN_STYLE}</style>\n</head>\n<body>\n<header><h1>{name}</h1><p \
        class=\"facts\">{count}, by campaign, the latest run first</p></header>\n<main>\n<section \
        id=\"results\"><table><thead><tr>{heads}</tr></thead><tbody>\n{rows}</tbody></table></section>\n\
         {left_out}</main>\n</body>\n</html>\n"
    )
}

/// The heads of the table. What changed may have names of any length, and alone is broken within a word.
const HEADS: [&str; 7] =
    ["Result", "Campaign", "Verdicts", "Runs computed", "Day", "Version", "Changed since the last run"];

/// Of the table of results alone: campaigns have a column where one is not named by its folder; where the table is
/// narrow each row is a card.
const OWN_STYLE: &str = "\
.pass { color: var(--pass); } .fail { color: var(--fail); font-weight: 600; } .undecided { color: var(--undecided); }
#results th, #results td { text-align: left; white-space: normal; } @media (min-width: 700px) { #results \
th:nth-child(4), #results td:nth-child(4) { text-align: right; } } #results td span:not(.quiet), #results \
td:nth-child(5) { white-space: nowrap; }
#results table:not(:has(td:nth-child(2):not(:empty))) :is(th, td):nth-child(2) { display: none; }
#results td:last-child { overflow-wrap: anywhere; min-width: 9rem; }
@media screen and (max-width: 699px) {
  #results thead { display: none; } #results table, #results tbody, #results tr, #results td { display: block; }
  #results tr { margin: 0.8rem 0; padding: 0.4rem 0.7rem; border: 1px solid var(--line); border-radius: 5px; \
  background: var(--panel); }
  #results td:empty { display: none; }
  #results td { border: 0; padding: 0.1rem 0; overflow-wrap: anywhere; } #results td + td::before { content: \
  attr(data-head) \": \"; color: var(--quiet); }
}
";

/// A relative path as a link: what has a meaning in one is written by its number (RFC 3986, section 2.1).
fn link(path: &str) -> String {
    let is_plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-._~/".contains(&byte);
    let separator = |byte: u8| if byte == b'\\' && cfg!(windows) { b'/' } else { byte };
    // a first part with a colon would be a scheme
    path.bytes().map(separator).fold("./".to_owned(), |link, byte| {
        if is_plain(byte) { link + &char::from(byte).to_string() } else { link + &format!("%{byte:02X}") }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::summary::EndVerdict;

    /// Law: the screen and the page say how many runs were computed, of all where some were not.
    #[test]
    fn computed_runs_are_counted() {
        for (rows, failed, said) in [(20, 0, "20"), (20, 3, "17 of 20"), (20, 20, "0 of 20")] {
            let (warnings, verdicts) = (Vec::new(), Vec::new());
            let end = SummaryEnd { rows, failed, not_covered: 0, warnings, verdicts, is_reached: true };
            let (folder, campaign) = (PathBuf::from("r"), "c".to_owned());
            let (version, day) = ("v".to_owned(), "today".to_owned());
            let entry = IndexEntry { folder, campaign, question: None, end, version, day, page: None, changed: None };
            let page = html("all", std::slice::from_ref(&entry), &[]);
            assert!(page.contains(&format!("<td data-head=\"Runs computed\">{said}</td>")), "{page}");
            let words = text(&[entry], &[], 100).split_whitespace().collect::<Vec<_>>().join(" ");
            assert!(words.contains(&format!("- {said} today")), "{words}");
        }
    }

    /// Law: each count of verdicts has the colour of its own word on the page, and on the screen stands whole in one
    /// line, however narrow that is; at 80 characters no line is longer, and the name of the folder is there in full.
    #[test]
    fn verdicts_are_whole() {
        let verdict = |word: &&str| EndVerdict { word: (*word).to_owned(), ..EndVerdict::default() };
        let verdicts = WORDS.iter().map(verdict).collect();
        let end = SummaryEnd { rows: 20, failed: 0, not_covered: 0, warnings: Vec::new(), verdicts, is_reached: true };
        let long = "a_campaign_with_a_long_name/of_a_day_in_november";
        let (folder, campaign) = (PathBuf::from(long), "another_name".to_owned());
        let (version, day) = ("0.1.0".to_owned(), "2026-11-27".to_owned());
        let changed = Some("campaign.duration_s: 10 -> 30".to_owned());
        let entry = IndexEntry { folder, campaign, question: None, end, version, day, page: None, changed };
        let page = html("all", std::slice::from_ref(&entry), &[]);
        for word in WORDS {
            assert!(page.contains(&format!("<span class=\"{}\">1 {word}</span>", word.to_lowercase())), "{page}");
        }
        for width in 30..200 {
            let text = text(std::slice::from_ref(&entry), &[], width);
            assert!(text.lines().any(|line| line.contains("1 PASS, 1 FAIL, 1 UNDECIDED")), "{width}:\n{text}");
            let is_fit = text.lines().all(|line| line.chars().count() <= width) && text.contains(long);
            assert!(is_fit || width < 80, "{width}:\n{text}");
        }
    }

    /// Law: whatever a folder is called, its link leads to it and to nothing else.
    #[test]
    fn links_lead_to_their_folders() {
        assert_eq!(link("a/report.html"), "./a/report.html");
        assert_eq!(link("javascript:x/\"q\"?#%/é"), "./javascript%3Ax/%22q%22%3F%23%25/%C3%A9");
    }
}
