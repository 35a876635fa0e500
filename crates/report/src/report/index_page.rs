//! The table of all results below a folder, as an offline page.

use crate::findings::names::sentence;
use crate::findings::number::counted;
use crate::findings::results_index::{IndexEntry, Unreadable};
use crate::report::page::document::head;
use crate::table::Table;
use crate::table::html::{self, escaped};
use crate::table::text::Align;

/// The page; `title` is the name of the folder.
pub fn html(title: &str, entries: &[IndexEntry], unreadable: &[Unreadable]) -> String {
    // break long names between words
    let words = |name: &str| escaped(name).replace('/', "/<wbr>").replace('_', "_<wbr>");
    let mut table = Table::with(HEADS.map(|head| (head, Align::Left)));
    for one in entries {
        let folder = words(&one.folder.display().to_string());
        let name = match &one.page {
            Some(page) => format!("<a href=\"{}\">{folder}</a>", link(&page.display().to_string())),
            None => folder,
        };
        let question = one.question.as_deref();
        let question = question
            .map_or(String::new(), |text| format!("<br><span class=\"quiet\">{}</span>", escaped(&sentence(text))));
        let word = |count, word: &str| format!("<span class=\"{}\">{count} {word}</span>", word.to_lowercase());
        table.row([
            name + &question,
            if one.is_named() { String::new() } else { words(&one.campaign) },
            one.verdicts(word),
            escaped(&one.runs()),
            escaped(&one.day),
            escaped(&one.version),
            escaped(one.changed.as_deref().unwrap_or("first run")),
        ]);
    }
    let table = html::html(&table, "", |[_, column], cell| {
        // narrow screens show the heads beside the cells
        [format!(" data-head=\"{}\"", HEADS[column]), html::markup(cell)]
    });
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
        "{}<body>\n<header><h1>{name}</h1><p \
        class=\"facts\">{count}, by campaign, the latest run first</p></header>\n<main>\n<section \
        id=\"results\">{table}</section>\n\
         {left_out}</main>\n</body>\n</html>\n",
        head(title, POLICY, OWN_STYLE)
    )
}

const POLICY: &str =
    "default-src 'none'; style-src 'unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none'";

const HEADS: [&str; 7] =
    ["Result", "Campaign", "Verdicts", "Runs computed", "Day", "Version", "Changed since the last run"];

/// Style of the table: the campaign column appears only if some folder has another name; on narrow screens rows become
/// cards.
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

/// A relative path as a link, percent-encoded (RFC 3986, section 2.1).
fn link(path: &str) -> String {
    let is_plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-._~/".contains(&byte);
    let separator = |byte: u8| if byte == b'\\' && cfg!(windows) { b'/' } else { byte };
    // `./`: a colon in the first segment would make a scheme
    path.bytes().map(separator).fold("./".to_owned(), |link, byte| {
        if is_plain(byte) { link + &char::from(byte).to_string() } else { link + &format!("%{byte:02X}") }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: a link leads to its folder, whatever the folder's name.
    #[test]
    fn links_lead_to_their_folders() {
        assert_eq!(link("a/report.html"), "./a/report.html");
        assert_eq!(link("javascript:x/\"q\"?#%/é"), "./javascript%3Ax/%22q%22%3F%23%25/%C3%A9");
    }
}
