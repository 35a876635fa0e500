//! `report.html`: small, self-contained, safe against the text of the file, and complete without runs that are ok.

use crate::prelude::*;

/// Largest page in bytes, whatever the number of runs: `../docs/results.md`.
const LARGEST: usize = 2_000_000;

fn page(scratch: &ScratchFolder, result: &str) -> String {
    scratch.text(&format!("{result}/report.html"))
}

fn visible(page: &str) -> &str {
    page.split_once("<script").unwrap().0
}

/// Law: `--no-report` leaves the page out, and `--figures` writes its figures as a page of their own.
#[test]
fn figures_are_files_too() {
    let scratch = folder("page-figures");
    scratch.small("--samples 40 --out plain --no-report", 0);
    assert!(!scratch.path("plain/report.html").exists());
    assert_says(scratch.prints("report plain --figures figures", 0), ["figures.html", "spindrift-figures"]);
    let data = |page: &str| Found::data_of(&scratch.text(page))["figures"].clone();
    let name = |one: &Value| one["name"].as_str().unwrap_or_default().to_owned();
    let names = |figures: &Value| figures.as_array().unwrap().iter().map(name).collect::<Vec<_>>();
    let written = names(&data("figures/figures.html"));
    assert_eq!(written, names(&data("plain/report.html")));
    for expected in ["drift_energy", "energy_transfer", "tail_energy_error_max", "correlation_achieved"] {
        assert!(written.iter().any(|name| name == expected), "{expected} is not among {written:?}");
    }
    scratch.shows("report campaigns", 2, "has no result of spindrift");
}

/// Law: no element of the page refers to an address, and its policy forbids it.
#[test]
fn the_page_needs_no_network() {
    let scratch = folder("page-offline");
    scratch.small("--samples 40 --out small", 0);
    let page = page(&scratch, "small");
    assert!(page.len() < LARGEST, "{} bytes", page.len());
    for reference in ["src=\"http", "href=\"http", "url(http", "@import", "src=\"//", "<link rel=\"stylesheet\""] {
        assert!(!page.contains(reference), "{reference}");
    }
    assert!(page.contains("default-src 'none'"), "the policy");
}

/// Law: text of the campaign file is text in the page, never markup.
#[test]
fn text_of_the_file_is_escaped() {
    const ATTACK: &str = "</script><img src=x onerror=alert(1)><!-- & \\\"quoted\\\"";
    let scratch = folder("page-escaped");
    let text = campaign().replace("name = \"small\"", &format!("name = \"small\"\ndescription = \"{ATTACK}\""));
    let compared = "[[observable]]\nname = \"is_seen\"\nunit = \"<i>u\"\nexpression = \"1e-16<energy_error_max\"\n";
    scratch.file("attack.toml", &(text + compared));
    scratch.prints("campaign attack.toml --samples 20 --out attack", 0);
    let attacked = page(&scratch, "attack");
    assert!(!attacked.contains("<img src=x") && !attacked.contains("<!-- &"), "markup of the description");
    assert!(
        visible(&attacked)
            .contains("&lt;/script&gt;&lt;img src=x onerror=alert(1)&gt;&lt;!-- &amp; &quot;quoted&quot;")
    );
    assert!(!attacked.contains("<i>u") && visible(&attacked).matches("&lt;i&gt;u").count() >= 3);
    assert!(!attacked.contains("<energy_error_max") && visible(&attacked).matches("&lt;energy_error_max").count() >= 3);
    scratch.small("--samples 20 --out plain", 0);
    let scripts = |page: &str| (page.matches("<script").count(), page.matches("</script>").count());
    assert_eq!(scripts(&attacked), scripts(&page(&scratch, "plain")));
}

/// Law: failed runs are counted with reason and replay command, and no number of a page without good runs is NaN.
#[test]
fn pages_of_failures() {
    let scratch = folder("page-failures");
    scratch.file("thin.toml", &(campaign() + NEGATIVE_WALLS));
    scratch.prints("campaign thin.toml --samples 100 --out thin", 1);
    let found = page(&scratch, "thin");
    assert!(
        visible(&found).contains("invalid_sample") && visible(&found).contains("spindrift simulate plan.toml --sample")
    );
    scratch.file("short.toml", &campaign().replace("tolerance = 1e-10", "tolerance = 1e-10\nmax_steps = 1"));
    scratch.prints("campaign short.toml --samples 30 --out short", 1);
    scratch.small("--samples 1 --out one", 0);
    for (result, sentence) in [
        ("short", "0 of 30 runs were computed"),
        ("one", "The run was computed."),
        ("thin", "of 100 runs were computed"),
    ] {
        let page = page(&scratch, result);
        assert!(visible(&page).replace('\u{a0}', " ").contains(sentence), "{result}: {sentence}");
        let mut words = visible(&page).split(|letter: char| !letter.is_alphanumeric());
        assert!(words.all(|word| word != "NaN" && word != "inf"), "{result}");
    }
}

/// Law: a method whose steps add up to more than ten times its tolerance is named, and the file of `new` has none.
#[test]
fn the_campaign_of_new_holds_its_tolerance() {
    let scratch = ScratchFolder::new("page-new");
    scratch.prints("new start.toml", 0);
    let above = "allows about";
    for (folder, change) in [("a", ""), ("b", " --set campaign.seed=810"), ("c", " --set campaign.duration_s=600.0")] {
        let said = scratch.prints(&format!("campaign start.toml --verbose --out {folder}{change}"), 0);
        assert!(said.contains("largest numerical errors, relative") && !said.contains(above), "{said}");
        let page = page(&scratch, folder);
        assert!(visible(&page).contains("Largest numerical errors, relative") && !page.contains(above), "{change}");
    }
    let other =
        "--set integrator.method=dormand_prince --set integrator.tolerance=1e-6 --set campaign.duration_s=3000.0";
    let said = scratch.prints(&format!("campaign start.toml --out d {other}"), 0);
    let words = said.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains("tolerance 1e-6 allows about 1e-5"), "{said}");
    assert!(page(&scratch, "d").contains(above));
}

/// Law: verdict, answers, causes, runs, motion over time and distributions in this order; the rest is folded.
#[test]
fn the_page_answers_first() {
    let scratch = ScratchFolder::new("page-order");
    let required =
        |limit: &str| format!("[[require]]\nobservable = \"energy_error_max\"\nquantile = 0.5\nat_most = {limit}\n");
    for (limits, code, word, counts) in
        [(&["1.0"][..], 0, "PASS", "1 PASS"), (&["1.0", "1e-30"], 3, "FAIL", "1 PASS, 1 FAIL")]
    {
        let requirements: String = limits.iter().map(|limit| required(limit)).collect();
        scratch.file("c.toml", &(campaign() + &requirements));
        scratch.prints("campaign c.toml --samples 60 --out r --overwrite", code);
        let page = page(&scratch, "r");
        let visible = visible(&page);
        assert!(visible.contains(&format!("<title>{word}: small - spindrift</title>")), "{word}");
        let head = visible.split_once("<h1>").unwrap().1.split_once("</h1>").unwrap().0;
        assert!(
            head.starts_with("small") && head.contains(&format!(">{word}</span>")) && head.contains(counts),
            "{head}"
        );
        let ids = "verdicts status influence replay worst time outcome numerics inputs statistics provenance";
        let ids = ids.split(' ').map(|id| format!("id=\"{id}\""));
        let parts = ["<title>", "<nav", "<h1>"].map(str::to_owned).into_iter().chain(ids);
        let places: Vec<usize> = parts.map(|part| visible.find(&part).unwrap_or_else(|| panic!("{part}"))).collect();
        assert!(places.is_sorted(), "{places:?}");
        for folded in ["inputs", "statistics"] {
            let section = visible.split_once(&format!("<section id=\"{folded}\">")).expect(folded).1;
            let section = section.split_once("</section>").unwrap().0;
            let fold = section.find("<details class=\"fold\">").unwrap();
            let content = section.find("class=\"figures\"").unwrap();
            assert!(fold < content, "{folded}");
        }
    }
}
