//! Altered results with every checksum made right again, and unfinished ones: output follows from the rows, and
//! whatever was not compared is named.

use crate::prelude::*;

use crate::reliability::{failing_store::contents, false_rows::alter};

/// A campaign with every kind of file, an incomplete last part, and a requirement that fails.
pub fn everything(scratch: &ScratchFolder, result: &str, seed: u64) {
    let numbers: String = (0..20).map(|row| format!("{}\n", 0.02 + 0.001 * f64::from(row))).collect();
    scratch.file("walls.csv", &format!("wall\n{numbers}"));
    let more = r#"
[retain]
trajectories = "sample:2"
[[observable]]
name = "twice"
expression = "2 * energy_error_max"
[[require]]
observable = "energy_error_max"
quantile = 0.5
at_most = 1e-30
[[disperse]]
parameter = "body.parts.fuselage.wall_thickness_m"
distribution = "empirical"
file = "walls.csv"
column = "wall"
"#;
    scratch.file("all.toml", &(sized(40) + more));
    scratch.prints(&format!("campaign all.toml --seed {seed} --out {result}"), 3);
}

/// Law: `verify` names each derived file of other rows under right checksums; a repair makes its bytes again.
#[test]
fn every_altered_file_is_found_under_right_checksums() {
    let scratch = folder("altered");
    everything(&scratch, "r", 7);
    everything(&scratch, "other", 8);
    let (whole, other) = (contents(&scratch.path("r")), contents(&scratch.path("other")));
    let is_derived = |name: &&String| {
        let is_own = ["manifest.json", "_SUCCESS"].contains(&name.as_str());
        !is_own && !["runs/", "bands/"].iter().any(|folder| name.starts_with(folder))
    };
    let names: Vec<&String> = whole.keys().filter(is_derived).collect();
    for kind in ["summary", "statistics", "sensitivity", "observables", "bands", "report", "trajectories/"] {
        assert!(names.iter().any(|name| name.starts_with(kind)), "{kind} in {names:?}");
    }
    for name in names {
        let altered = other.get(name).filter(|bytes| **bytes != whole[name]).cloned();
        let altered = altered.unwrap_or_else(|| [whole[name].as_slice(), b"\n"].concat());
        alter(&scratch, &[(name, &altered)]);
        let said = scratch.prints("verify r --fraction 1", 4);
        let shown = match name.split('/').next() {
            Some("data") => "must be the SHA-256 of the file",
            _ => name,
        };
        assert!(said.contains(shown), "{name}: {said}");
        if ["plan.toml", "dataset.json"].contains(&name.as_str()) || name.starts_with("data/") {
            fs::remove_dir_all(scratch.path("r")).unwrap();
            everything(&scratch, "r", 7);
        } else {
            scratch.prints("verify r --fraction 1 --repair", 0);
        }
        assert!(contents(&scratch.path("r")) == whole, "{name}");
    }
    scratch.prints("verify r --fraction 1", 0);
}

/// Law: no command shows a PASS of the summary where the rows fail, whatever the checksums.
#[test]
fn verdicts_are_those_of_the_rows() {
    let scratch = folder("altered-verdicts");
    everything(&scratch, "r", 7);
    let text = scratch.text("r/summary.json");
    assert!(text.contains("\"verdict\": \"FAIL\""));
    let commands = ["campaign all.toml --seed 7 --out r", "finish r", "verify r --fraction 0", "verify r"];
    let changes =
        [("\"verdict\": \"FAIL\"", "\"verdict\": \"PASS\""), ("\"ok\": 40", "\"ok\": 39"), ("<= 1e-30", "<= 1e-3")];
    for (from, to) in changes {
        assert!(text.contains(from), "{from} in {text}");
        alter(&scratch, &[("summary.json", text.replace(from, to).as_bytes())]);
        for command in commands {
            let said = scratch.prints(command, 4);
            assert!(said.contains("summary.json") && !said.contains("PASS"), "{command}: {said}");
        }
        alter(&scratch, &[("summary.json", text.as_bytes())]);
    }
    for command in &commands[..2] {
        assert!(scratch.prints(command, 3).contains("FAIL"), "{command}");
    }
}

/// Law: without its mark a result is compared and ends with 5; the campaign's command finishes it.
#[test]
fn a_result_without_its_mark_is_not_sound() {
    let scratch = folder("altered-mark");
    everything(&scratch, "r", 7);
    let whole = contents(&scratch.path("r"));
    let text = scratch.text("r/summary.json");
    let marks: [&dyn Fn(); 2] =
        [&|| fs::remove_file(scratch.path("r/_SUCCESS")).unwrap(), &|| scratch.file("r/_SUCCESS", "x")];
    for unmark in marks {
        unmark();
        scratch.shows("verify r --fraction 1", 5, "not finished: _SUCCESS is missing, or not empty");
        fs::write(scratch.path("r/statistics.parquet"), "altered").unwrap();
        assert!(scratch.prints("verify r", 4).contains("statistics.parquet"));
        fs::write(scratch.path("r/statistics.parquet"), &whole["statistics.parquet"]).unwrap();
        alter(&scratch, &[("summary.json", text.replace("\"verdict\": \"FAIL\"", "\"verdict\": \"PASS\"").as_bytes())]);
        assert!(scratch.prints("verify r", 4).contains("summary.json"));
        scratch.prints("campaign all.toml --seed 7 --out r", 3);
        assert!(contents(&scratch.path("r")) == whole);
    }
}

/// Law: without a manifest `verify` names every derived file as not compared, and ends with 5.
#[test]
fn what_is_not_compared_is_named() {
    let scratch = folder("altered-unlisted");
    everything(&scratch, "r", 7);
    let whole = contents(&scratch.path("r"));
    ["r/manifest.json", "r/_SUCCESS"].into_iter().for_each(|name| fs::remove_file(scratch.path(name)).unwrap());
    let said = scratch.prints_wide("verify r --fraction 1", 5);
    let (_, named) = said.split_once("not compared, since nothing says what should be in them: ").unwrap();
    let top = ["dataset.json", "plan.toml", "manifest.json", "_SUCCESS"];
    for name in whole.keys() {
        let is_compared =
            top.contains(&name.as_str()) || ["runs/", "bands/", "data/"].iter().any(|folder| name.starts_with(folder));
        assert_eq!(named.contains(name.as_str()), !is_compared, "{name}: {said}");
    }
    scratch.prints("verify r --repair", 0);
    assert!(contents(&scratch.path("r")) == whole);
}

/// Law: an unfinished campaign is sound and ends with 5; a part without its bands is damage.
#[test]
fn what_is_not_made_yet_is_no_damage() {
    let scratch = folder("altered-early");
    everything(&scratch, "short", 7);
    let command = "campaign all.toml --seed 7 --samples 300 --out r";
    scratch.prints(command, 3);
    let whole = contents(&scratch.path("r"));
    let parts = whole.keys().filter(|name| name.starts_with("runs/part-")).count();
    for made in [0, 1] {
        for name in whole.keys().filter(|name| !["plan.toml", "dataset.json"].contains(&name.as_str())) {
            if !name.starts_with("data/") && (made == 0 || !name.ends_with("part-000000.parquet")) {
                fs::remove_file(scratch.path("r").join(name)).unwrap();
            }
        }
        let said = scratch.prints_wide("verify r --fraction 1", 5);
        let left = parts - made;
        let left = if left == 1 { "1 part".to_owned() } else { format!("{left} parts") };
        assert_says(&said, [&format!("{left} not made yet; the campaign's command makes the rest")]);
        if made == 1 {
            fs::remove_file(scratch.path("r/bands/part-000000.parquet")).unwrap();
            assert!(scratch.prints("verify r", 4).contains("bands/part-000000.parquet: missing"));
        }
        scratch.prints(command, 3);
        assert!(contents(&scratch.path("r")) == whole, "{made}");
    }
}
