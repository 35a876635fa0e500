//! Hostile input and output files: no endless reads or waits, and no input or foreign file is overwritten.

use crate::prelude::*;

fn table_campaign(scratch: &ScratchFolder) {
    let table = "\n[design]\nkind = \"table\"\nfile = \"table.csv\"\n";
    let text = campaign().replace("samples = 600\n", "");
    let at = text.find("[[disperse]]").unwrap();
    scratch.file("table.toml", &format!("{}{table}", &text[..at]));
    scratch.file("table.csv", "wheels.w1.radius_m\n0.25\n0.26\n0.24\n");
}

/// Law: a file that is no campaign is refused with code 2, its kind and a remedy.
#[cfg(unix)]
#[test]
fn what_is_no_campaign_file_is_refused_by_what_it_is() {
    let scratch = folder("kinds");
    assert!(Command::new("mkfifo").arg(scratch.path("pipe.toml")).status().unwrap().success());
    scratch.file("rows.csv", &"0.5,0.25,7\n".repeat(50_000));
    fs::write(scratch.path("image.png"), [0x89, b'P', b'N', b'G', 0xff, 0xfe]).unwrap();
    fs::File::create(scratch.path("huge.toml")).unwrap().set_len(1 << 40).unwrap();
    for (file, said) in [
        ("pipe.toml", "a named pipe (FIFO): must be a regular file; write the campaign to a file, and name that"),
        ("/dev/zero", "a device: must be a regular file"),
        (".", "`.` is a folder; name the campaign file in it"),
        ("rows.csv", "rows.csv:1: line = 0.5,0.25,7: must be valid TOML"),
        ("rows.csv", "there is no [campaign] table: is this a campaign file?"),
        ("image.png", "invalid UTF-8 at byte 0: must be a readable text file (UTF-8)"),
        ("huge.toml", "1099511627776 bytes: must be a campaign file of at most 8388608 bytes; name tables of numbers"),
    ] {
        let found = scratch.prints(&format!("check {file}"), 2);
        assert!(found.contains(said), "{file}: {found}");
        assert!(found.lines().count() < 100, "{file}: {} lines", found.lines().count());
    }
}

/// Law: so is a file that has no numbers.
#[cfg(unix)]
#[test]
fn what_is_no_file_of_numbers_is_refused_by_what_it_is() {
    let scratch = folder("numbers");
    table_campaign(&scratch);
    scratch.prints("check table.toml", 0);
    let text = scratch.text("table.toml");
    assert!(Command::new("mkfifo").arg(scratch.path("pipe.csv")).status().unwrap().success());
    fs::create_dir(scratch.path("folder.csv")).unwrap();
    std::os::unix::fs::symlink("/dev/zero", scratch.path("zero.csv")).unwrap();
    fs::File::create(scratch.path("huge.csv")).unwrap().set_len(1 << 40).unwrap();
    for (file, said) in [
        ("pipe.csv", "(a named pipe (FIFO)); name a regular file"),
        ("folder.csv", "(a folder); name a regular file"),
        ("zero.csv", "(a device); name a regular file"),
        ("huge.csv", "a file of at most 20000000 numbers (this one has 1099511627776 bytes)"),
    ] {
        scratch.file("bad.toml", &text.replace("table.csv", file));
        let found = scratch.prints("check bad.toml", 2);
        assert!(found.contains(said), "{file}: {found}");
    }
}

/// Law: a result moved, without the file of numbers of its plan, is complete.
#[test]
fn a_result_has_its_data() {
    let scratch = folder("data");
    table_campaign(&scratch);
    scratch.prints("campaign table.toml --out whole", 0);
    for shard in ["1/2", "2/2"] {
        scratch.prints(&format!("campaign table.toml --out r --shard {shard}"), 0);
    }
    fs::remove_file(scratch.path("table.csv")).unwrap();
    fs::rename(scratch.path("r"), scratch.path("campaigns/moved")).unwrap();
    scratch.prints("finish campaigns/moved", 0);
    scratch.prints("verify campaigns/moved --fraction 1", 0);
    scratch.prints("report campaigns/moved", 0);
    scratch.prints("simulate campaigns/moved/plan.toml --sample 1", 0);
    for file in ["manifest.json", "dataset.json", "plan.toml", "statistics.parquet", "summary.json", "report.html"] {
        let [whole, moved] = ["whole", "campaigns/moved"].map(|root| fs::read(scratch.path(root).join(file)).unwrap());
        assert!(whole == moved, "{file}");
    }
    let copies: Vec<_> = fs::read_dir(scratch.path("whole/data")).unwrap().collect();
    assert_eq!(copies.len(), 1);
    let copy = fs::read_dir(scratch.path("campaigns/moved/data")).unwrap().next().unwrap().unwrap().path();
    fs::write(copy, "wheels.w1.radius_m\n0.25\n0.26\n0.25\n").unwrap();
    scratch.shows("simulate campaigns/moved/plan.toml --sample 1", 2, "must be the SHA-256 of the file");
}

/// Law: a command never writes to a file that it reads, whatever name leads to it.
#[cfg(unix)]
#[test]
fn inputs_are_never_outputs() {
    let scratch = folder("inputs");
    table_campaign(&scratch);
    let table = fs::read(scratch.path("table.csv")).unwrap();
    std::os::unix::fs::symlink("table.csv", scratch.path("link.csv")).unwrap();
    fs::hard_link(scratch.path("table.csv"), scratch.path("hard.csv")).unwrap();
    fs::hard_link(scratch.path("table.csv"), scratch.path("hard.svg")).unwrap();
    fs::hard_link(scratch.path("table.toml"), scratch.path("hard.xml")).unwrap();
    fs::create_dir(scratch.path("p")).unwrap();
    fs::hard_link(scratch.path("table.csv"), scratch.path("p/precision.parquet")).unwrap();
    for command in [
        "sample table.toml --out table.csv",
        "sample table.toml --out ./campaigns/../table.csv",
        "sample table.toml --out link.csv",
        "sample table.toml --out hard.csv",
        "sample table.toml --plot hard.svg",
        "simulate table.toml --out table.csv",
        "simulate table.toml --plot hard.svg",
        "campaign table.toml --junit table.toml",
        "campaign table.toml --junit hard.xml",
        "campaign table.toml --out table.toml",
        "precision table.toml --out p",
    ] {
        assert_says(scratch.prints(command, 2), ["must be a file that this command does not read", "another"]);
        assert_eq!(fs::read(scratch.path("table.csv")).unwrap(), table, "{command}");
    }
    assert!(!scratch.path("results").exists());
    scratch.prints("sample table.toml --out other.csv", 0);
    assert!(scratch.path("other.csv").exists());
}

/// Law: reports and figures are not written into a result.
#[test]
fn a_result_takes_no_other_files() {
    let scratch = folder("within");
    for (option, path) in
        [("--junit", "r/verdicts.xml"), ("--figures", "r/figures"), ("--figures", "campaigns/../r/a/b")]
    {
        scratch.small_shows(&format!("--out r {option} {path}"), 2, "must be outside of the result in `r`");
    }
    assert!(!scratch.path("r").exists());
    scratch.small("--samples 3 --out r --junit verdicts.xml --figures figures", 0);
    scratch.shows("report r --figures r/figures", 2, "must be outside of the result in `r`");
}

#[cfg(unix)]
#[test]
fn planted_links_are_not_followed() {
    use std::os::unix::fs::symlink;
    let scratch = folder("planted");
    fs::create_dir(scratch.path("precious")).unwrap();
    scratch.file("precious/file", "precious");
    symlink("precious/file", scratch.path("s.csv.tmp")).unwrap();
    symlink("precious/file", scratch.path("s.csv")).unwrap();
    scratch.prints("sample small.toml --samples 3 --out s.csv", 0);
    assert!(fs::symlink_metadata(scratch.path("s.csv")).unwrap().is_file());
    scratch.small("--samples 3 --out r", 0);
    fs::remove_file(scratch.path("r/summary.json")).unwrap();
    symlink("../precious/file", scratch.path("r/summary.json")).unwrap();
    scratch.small_shows("--samples 3 --out r", 4, "`r` contains `summary.json`, which is not part of a result");
    fs::remove_file(scratch.path("r/summary.json")).unwrap();
    fs::rename(scratch.path("r/runs"), scratch.path("runs")).unwrap();
    symlink("../precious", scratch.path("r/runs")).unwrap();
    scratch.small_shows("--samples 3 --out r --overwrite", 4, "`r` contains `runs`, which is not part of a result");
    fs::create_dir_all(scratch.path("new/runs")).unwrap();
    for name in ["dataset.json.tmp", "plan.toml.tmp", "runs/part-000000.parquet.tmp"] {
        symlink(scratch.path("precious/file"), scratch.path("new").join(name)).unwrap();
    }
    scratch.small_shows("--samples 3 --out new", 4, "not part of a result");
    fs::create_dir(scratch.path("l")).unwrap();
    symlink("../runs", scratch.path("l/runs")).unwrap();
    let before = contents(&scratch.path("runs"));
    scratch.small("--samples 3 --seed 5 --out l", 4);
    assert!(contents(&scratch.path("runs")) == before);
    assert_eq!(scratch.text("precious/file"), "precious");
    assert_eq!(fs::read_dir(scratch.path("precious")).unwrap().count(), 1);
}

fn is_obeyed(letter: char) -> bool {
    letter != '\n' && (letter.is_control() || letter == '\u{202e}')
}

#[test]
fn escapes_are_shown_as_text() {
    let scratch = folder("escapes");
    let bad =
        campaign().replace("name = \"small\"", "name = \"\\u001b]0;title\\u0007\"\nx\u{1b}[31m = \"\u{9b}1m\u{202e}\"");
    scratch.file("bad.toml", &bad);
    let mut said = scratch.prints("check bad.toml", 2);
    scratch.file("bad.toml", &campaign().replace("points = 11", "\"\\u001b[2J\" = \"\\u001b[2J\""));
    said += &scratch.prints("check bad.toml", 2);
    assert!(!said.contains(is_obeyed), "{said:?}");
    assert_says(&said, ["\\u{1b}[2J"]);
    let description = "a\u{202e}b";
    scratch.file(
        "\u{1b}[1m.toml",
        &campaign().replace("name = \"small\"", &format!("name = \"small\"\ndescription = \"{description}\"")),
    );
    let said = scratch.prints("check \u{1b}[1m.toml", 0) + &scratch.prints("check \u{1b}[2m.toml", 2);
    assert!(!said.contains(is_obeyed) && said.contains("A\\u{202e}b") && said.contains("`\\u{1b}[2m.toml`"), "{said}");
}

/// Law: too many tables with files of numbers are refused with the limit.
#[test]
fn too_many_files_of_numbers_are_refused() {
    let scratch = folder("many-files");
    let text = campaign();
    let at = text.find("[[disperse]]").unwrap();
    let part = |number: usize| FUSELAGE.replace("\"fuselage\"", &format!("\"p{number}\""));
    let scene = text[..at].replace(FUSELAGE, &(0..32).map(part).collect::<String>());
    let keys = ["outer_radius_m", "length_m", "density_kg_m3", "inertia_scale"];
    let draws = (0..32).flat_map(|number| keys.map(|key| (number, key)));
    let table = |(number, key): (usize, &str)| {
        format!(
            "[[disperse]]\nparameter = \"body.parts.p{number}.{key}\"\ndistribution = \"empirical\"\nfile = \
            \"x.csv\"\ncolumn = \"x\"\n"
        )
    };
    scratch.file("x.csv", "x\n1\n2\n");
    for (count, code) in [(100, 0), (101, 2)] {
        scratch.file("many.toml", &format!("{scene}{}", draws.clone().take(count).map(table).collect::<String>()));
        let said = scratch.prints("sample many.toml --samples 3", code);
        assert_eq!(said.contains("must be in at most 100 tables of a campaign file"), code == 2, "{count}: {said}");
    }
}

/// Law: a thread that the system does not start is done without, or an error with code 4.
#[cfg(target_os = "linux")]
#[test]
fn threads_that_do_not_start_are_no_input_error() {
    let scratch = folder("no-threads");
    scratch.small("--out r", 0);
    let command = |arguments: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_spindrift"));
        command.args(arguments.split(' ')).env("RUST_MIN_STACK", "100000000000000000");
        command
    };
    for arguments in ["campaign small.toml --out new", "precision small.toml --samples 2"] {
        let said = scratch.outputs(&mut command(arguments), 4);
        assert!(said.contains("error: cannot start ") && !said.contains("panicked"), "{arguments}: {said}");
    }
    assert!(!scratch.path("new").exists());
    for arguments in ["finish r", "report r", "compare r r"] {
        scratch.outputs(&mut command(arguments), 0);
    }
}

/// Law: no character of an argument that a terminal obeys reaches it, whichever part of the parser refuses it.
#[test]
fn escapes_in_arguments_are_shown_as_text() {
    let scratch = folder("argument-escapes");
    let hostile = "\u{1b}[2J\u{9b}1m\u{202e}x";
    for arguments in [
        vec![hostile],
        vec!["check", "small.toml", hostile],
        vec!["check", "--X", "small.toml"],
        vec!["campaign", "small.toml", "--threads", hostile],
        vec!["campaign", "small.toml", "--samples", hostile],
        vec!["campaign", "small.toml", "--seed", hostile],
        vec!["campaign", "small.toml", "--shard", hostile],
        vec!["check", "small.toml", "--set", hostile],
        vec!["precision", "small.toml", "--methods", hostile],
        vec!["verify", "r", "--fraction", hostile],
    ] {
        let arguments: Vec<String> =
            arguments.iter().map(|text| text.replace("--X", &format!("--{hostile}"))).collect();
        let said = scratch.outputs(Command::new(env!("CARGO_BIN_EXE_spindrift")).args(&arguments), 2);
        assert!(!said.contains(is_obeyed), "{arguments:?}: {said:?}");
        assert!(said.contains("\\u{1b}[2J\\u{9b}1m\\u{202e}x"), "{arguments:?}: {said}");
    }
    assert!(scratch.prints("--version", 0).starts_with("spindrift "));
}

/// Law: a file that may not grow is an error with code 4; without the limit the same command gives the same bytes.
#[cfg(target_os = "linux")]
#[test]
fn a_limit_of_file_sizes_is_an_error() {
    let scratch = folder("file-limit");
    scratch.small("--out whole", 0);
    let limited = |arguments: &str, code: i32| {
        let line = format!("ulimit -f 8; exec '{}' {arguments}", env!("CARGO_BIN_EXE_spindrift"));
        scratch.outputs(Command::new("sh").args(["-c", &line]), code)
    };
    for arguments in [
        "campaign small.toml --out r",
        "sample small.toml --out s.csv",
        "simulate small.toml --out s.parquet",
        "report whole",
    ] {
        let said = limited(arguments, 4);
        assert!(said.contains("File too large"), "{arguments}: {said}");
    }
    scratch.small("--out r", 0);
    assert!(contents(&scratch.path("r")) == contents(&scratch.path("whole")));
    limited("check small.toml", 0);
}

/// Law: a file of the campaign that cannot be read ends the command with code 4; a missing one, or any mistake, with 2.
#[cfg(target_os = "linux")]
#[test]
fn what_cannot_be_read_now_is_no_mistake() {
    let scratch = folder("unreadable");
    table_campaign(&scratch);
    fs::remove_file(scratch.path("table.csv")).unwrap();
    let unreadable = |name: &str| std::os::unix::fs::symlink("/proc/self/mem", scratch.path(name)).unwrap();
    let commands = ["check FILE", "campaign FILE --out r", "simulate FILE", "sample FILE"];
    let all = |file: &str, code: i32| {
        for command in commands {
            let said = scratch.prints(&command.replace("FILE", file), code);
            assert_eq!(said.contains("Input/output error"), code == 4, "{command}: {said}");
        }
    };
    unreadable("none.toml");
    all("none.toml", 4);
    scratch.file("over.toml", "extends = \"base.toml\"\n");
    all("over.toml", 2);
    unreadable("base.toml");
    all("over.toml", 4);
    all("table.toml", 2);
    unreadable("table.csv");
    all("table.toml", 4);
    scratch.file("table.toml", &scratch.text("table.toml").replace("seed = 7", "sead = 7"));
    scratch.prints("check table.toml", 2);
    assert!(!scratch.path("r").exists());
}
