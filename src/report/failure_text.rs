//! Why runs failed, as lines of text.

use crate::ensemble::FailureReason;

/// Most reasons that are listed.
const MOST: usize = 8;

/// A line for each of `groups`, as many as are listed: how many runs, how they ended, and the reason of the first.
pub fn text(groups: &[&FailureReason]) -> String {
    let line = |one: &&FailureReason| {
        let (status, which) = (one.status.name(), if one.count == 1 { "" } else { "first " });
        format!("  {:>10}  {status}: {} ({which}sample {})\n", one.count, one.text, one.first)
    };
    let mut text: String = groups.iter().take(MOST).map(line).collect();
    if groups.len() > MOST {
        let rest: u64 = groups[MOST..].iter().map(|one| one.count).sum();
        text += &format!("  {rest:>10}  for {} other reasons\n", groups.len() - MOST);
    }
    text
}
