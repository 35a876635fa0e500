//! `spindrift index`: all results below a folder.

use crate::prelude::*;

const LIMITED: &str = "[[require]]\nobservable = \"rate_w1_final_rad_s\"\nfraction = 0.5\nat_most = ";

fn run(scratch: &ScratchFolder, name: &str, limit: &str, out: &str, code: i32) {
    let text = crate::small_campaign::campaign().replace("name = \"small\"", &format!("name = \"{name}\""));
    scratch.file("c.toml", &format!("# Question: is <{name}> slow enough?\n{text}{LIMITED}{limit}\n"));
    scratch.outputs(scratch.command("campaign c.toml --samples 20 --out").arg(out), code);
    std::thread::sleep(std::time::Duration::from_millis(1100));
}

#[test]
fn every_result_has_a_row() {
    let scratch = folder("index");
    run(&scratch, "first", "1e9", "all/z old", 0);
    run(&scratch, "other", "1e9", "all/deep/er/other", 0);
    run(&scratch, "first", "0.0", "all/a new", 3);
    scratch.prints("campaign c.toml --samples 600 --shard 1/2 --out all/half", 0);
    scratch.prints("campaign c.toml --samples 20 --out all/broken", 3);
    scratch.file("all/broken/summary.json", "{}");
    let before = scratch.parts("all/a new");
    let said = scratch.prints_at("index all", 0, 80);
    assert_fits(&said, usize::MAX, 80);
    assert_eq!(said.lines().last(), Some("3 results -> all/index.html"), "{said}");
    let at = |text: &str| said.find(text).unwrap_or_else(|| panic!("no {text} in\n{said}"));
    assert!(at("a new") < at("z old") && at("z old") < at("deep/er/other"), "{said}");
    let flat = said.split_whitespace().collect::<Vec<_>>().join(" ");
    for words in [
        "1 FAIL 20",
        "require[0].at_most: 1000000000 rad/s -> 0 rad/s",
        "half not finished",
        "broken summary.json is none of spindrift",
    ] {
        assert!(flat.contains(words), "{words}: {said}");
    }
    assert!(flat.contains("z old (first)") && !flat.contains("other (other)"), "{said}");

    let page = scratch.text("all/index.html");
    assert_eq!(page.matches("first run").count(), 2, "{page}");
    for place in ["a%20new", "z%20old", "deep/er/other"] {
        let link = format!("href=\"./{place}/report.html\"");
        assert_eq!(page.matches(&link).count(), 1, "{link}");
        assert!(scratch.path("all").join(place.replace("%20", " ")).join("report.html").is_file());
    }
    assert!(page.contains("Is &lt;other&gt; slow enough?") && !page.contains("<other>"), "markup of a question");
    assert!(page.contains("default-src 'none'") && !page.contains("http://") && !page.contains("https://"));
    assert_says(
        &page,
        ["<span class=\"fail\">1 FAIL</span></td><td data-head=\"Runs computed\">20</td>", "<li>half: not finished"],
    );
    assert_eq!(scratch.parts("all/a new"), before);

    scratch.prints("campaign c.toml --samples 20 --set display.units=[\"deg\"] --out all/shown", 3);
    let said = scratch.prints_wide("index all", 0);
    assert!(said.contains("the same campaign, version and verdicts") && !said.contains("display"), "{said}");

    assert!(scratch.prints("index all/half", 2).contains("is itself a result"));
    fs::create_dir(scratch.path("empty")).unwrap();
    assert!(scratch.prints("index empty", 2).contains("there is no result"));
    scratch.prints("index absent", 2);
}
