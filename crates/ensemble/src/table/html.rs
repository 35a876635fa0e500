//! Tables as HTML, and [`escaped`] text within HTML, SVG or XML.

use crate::table::text::Align;
use crate::table::{Cell, Table};

/// The element `<table>` of class `class`, with a row of heads unless all are empty. `show` gives the attributes and
/// the content of the cell in a row and column as markup; an [`Align::Title`] column is the head of its rows.
pub fn html(table: &Table<'_>, class: &str, show: impl Fn([usize; 2], Cell<'_>) -> [String; 2]) -> String {
    let cell = |[row, column]: [usize; 2]| {
        let [attributes, content] = show([row, column], table.values[column].cell(row));
        match table.columns[column].align {
            Align::Title => format!("<th scope=\"row\"{attributes}>{content}</th>"),
            _ => format!("<td{attributes}>{content}</td>"),
        }
    };
    let row = |row: usize| {
        let cells: String = (0..table.columns.len()).map(|column| cell([row, column])).collect();
        format!("<tr>{cells}</tr>\n")
    };
    let names = || table.columns.iter().map(|column| column.quantity.name());
    let heads: String = names().map(|name| format!("<th scope=\"col\">{}</th>", escaped(name))).collect();
    let head = match names().all(str::is_empty) {
        true => String::new(),
        false => format!("<thead><tr>{heads}</tr></thead>"),
    };
    let rows: String = (0..table.rows()).map(row).collect();
    format!("<table class=\"{class}\">{head}<tbody>\n{rows}</tbody></table>")
}

/// A text or count as content without attributes; absent values are a dash.
pub fn plain(cell: Cell<'_>) -> [String; 2] {
    let content = match cell {
        Cell::Null => "-".to_owned(),
        Cell::Real(number) => format!("{number:?}"),
        Cell::Count(count) => count.to_string(),
        Cell::Text(text) => escaped(text),
    };
    [String::new(), content]
}

pub fn markup(cell: Cell<'_>) -> String {
    if let Cell::Text(markup) = cell { markup.to_owned() } else { String::new() }
}

/// `text` as content or as a quoted attribute, without markup; characters that XML 1.0 forbids are replaced.
pub fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => escaped += "&amp;",
            '<' => escaped += "&lt;",
            '>' => escaped += "&gt;",
            '"' => escaped += "&quot;",
            '\'' => escaped += "&#39;",
            '\t' | '\n' | '\r' => escaped += &format!("&#{};", u32::from(letter)),
            '\0'..='\u{1f}' | '\u{fffe}' | '\u{ffff}' => escaped.push('\u{fffd}'),
            letter => escaped.push(letter),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_is_escaped() {
        assert_eq!(escaped("a<b> & \"c\"\n'\u{1}"), "a&lt;b&gt; &amp; &quot;c&quot;&#10;&#39;\u{fffd}");
    }
}
