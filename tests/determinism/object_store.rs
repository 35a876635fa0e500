//! Results in an object store: the bytes of a folder, whatever stops a process; nothing is replaced, and nothing that
//! is not whole looks whole. `.ci/cloud` starts the server ([`super::store_proxy`]).

use crate::prelude::*;

use super::store_bench::{Bench, HEAD, HEAD_OBJECT, KEY, SECRET, SUCCESS, assert_whole, direct};
use super::store_proxy::{Fate, Message, Proxy};

/// Law: a store has the files of a folder, each put if absent; another machine finds them and puts nothing again.
#[test]
fn a_store_has_the_files_of_a_folder() {
    let bench = Bench::new("same");
    let whole = bench.whole("");
    let proxy = Proxy::new(|_, request: &Message| {
        let is_conditional = request.method() != "PUT" || request.header("if-none-match").as_deref() == Some("*");
        if is_conditional { Fate::Passed } else { Fate::Answered(400, "no condition") }
    });
    assert_eq!(bench.behind(&proxy, "campaign stored.toml --out s3:x"), Some(0));
    let found = bench.objects("x");
    assert_whole(&found, &whole, "x");
    for kind in ["trajectories/", "data/", "report.html", "runs/part-000002"] {
        assert!(found.keys().any(|name| name.starts_with(kind)), "{kind}");
    }
    // first the identity of the rows, then the plan with its data; last the mark
    let puts: Vec<String> = proxy.requests().into_iter().filter(|request| request.starts_with("PUT")).collect();
    let at = |object: &str| puts.iter().position(|put| put.contains(object)).unwrap();
    assert_eq!([HEAD_OBJECT, "/data/", "plan.toml"].map(at), [0, 1, 2], "{puts:?}");
    assert_eq!(["manifest.json", SUCCESS].map(at), [puts.len() - 2, puts.len() - 1], "{puts:?}");
    assert_eq!(puts.len(), found.len());
    for part in 0..3 {
        let [bands, rows] = ["bands", "runs"].map(|folder| at(&format!("/{folder}/part-{part:06}.parquet")));
        assert!(bands < rows, "{puts:?}");
    }
    assert!(bench.prints("verify s3:x --fraction 1", 0).contains("sound"));
    assert!(bench.prints("compare s3:x whole --tolerance 0", 0).contains("PASS"));
    bench.prints("report s3:x", 0);
    bench.prints("finish s3:x", 0);
    bench.prints("campaign stored.toml --only-failed-of s3:x --out again", 0);
    let before = proxy.requests().len();
    assert_eq!(bench.behind(&proxy, "campaign stored.toml --out s3:x"), Some(0));
    assert!(proxy.requests()[before..].iter().all(|request| request.starts_with("GET")));
    assert!(bench.prints("campaign stored.toml --out s3:x", 0).contains("already complete in s3://"));
    assert!(bench.objects("x") == found);
    assert!(!contents(&bench.scratch.0).values().any(|bytes| {
        [SECRET, KEY].iter().any(|secret| bytes.windows(secret.len()).any(|some| some == secret.as_bytes()))
    }));
}

/// Law: shards on machines of their own and a finish on another give the same objects.
#[test]
fn shards_meet_in_a_store() {
    let bench = Bench::new("shards");
    let whole = bench.whole("");
    assert_says(
        bench.prints("campaign stored.toml --shard 1/2 --out s3:x", 0),
        [&format!("spindrift finish s3://{}/x", bench.bucket)],
    );
    assert!(bench.prints("finish s3:x", 4).contains("1 part missing"));
    assert!(bench.prints("verify s3:x", 5).contains("1 part not made yet"));
    assert!(bench.prints("report s3:x", 2).contains("is not finished"));
    bench.prints("campaign stored.toml --shard 2/2 --out s3:x", 0);
    assert!(!bench.objects("x").contains_key(SUCCESS));
    assert!(bench.prints("verify s3:x", 5).contains("not finished"));
    bench.prints("finish s3:x", 0);
    assert_whole(&bench.objects("x"), &whole, "shards");
    let proxy = Proxy::new(|_, _: &Message| Fate::Passed);
    assert_eq!(bench.behind(&proxy, "campaign stored.toml --shard 1/2 --out s3:x"), Some(0));
    assert!(proxy.requests().iter().all(|request| request.starts_with("GET")));
}

/// Law: a process killed at any request leaves nothing that only looks whole; the same command completes it.
#[test]
fn a_kill_at_every_request_changes_no_byte() {
    let bench = Bench::new("kills");
    let whole = bench.whole("--no-report");
    let mut killed = 0;
    for (variant, fate) in [Fate::KilledBefore, Fate::KilledAfter].into_iter().enumerate() {
        for at in 0.. {
            let prefix = format!("{at}-{variant}");
            let command = format!("campaign stored.toml --no-report --out s3:{prefix}");
            let fate = fate.clone();
            let proxy = Proxy::new(move |count, _: &Message| if count == at { fate.clone() } else { Fate::Passed });
            let ended = bench.behind(&proxy, &command);
            let found = bench.objects(&prefix);
            if found.contains_key(SUCCESS) {
                assert_whole(&found, &whole, &prefix);
            } else {
                assert!(ended.is_none(), "{prefix}");
                let code = match (found.contains_key("plan.toml"), found.contains_key(HEAD_OBJECT)) {
                    (true, _) => 5,
                    (false, true) => 4,
                    (false, false) => 2,
                };
                bench.prints(&format!("verify s3:{prefix}"), code);
            }
            if ended.is_some() {
                assert_eq!(ended, Some(0));
                break;
            }
            killed += 1;
            bench.prints(&command, 0);
            assert_whole(&bench.objects(&prefix), &whole, &prefix);
        }
    }
    assert!(killed > 50, "{killed}");
}

/// Law: a shard that ends with 0 has put all its parts, whatever killed it before; a campaign with `[stop]` puts no
/// part that is not final.
#[test]
fn parts_are_put_once_they_are_final() {
    let bench = Bench::new("final");
    let whole = bench.whole("--no-report");
    let of_rows = |names: &std::collections::BTreeMap<String, Vec<u8>>| {
        names.keys().filter(|name| name.starts_with("runs/")).count()
    };
    let killed_at =
        |at: usize| Proxy::new(move |count, _: &Message| if count == at { Fate::KilledBefore } else { Fate::Passed });
    for at in 0.. {
        let prefix = format!("shard-{at}");
        let command = format!("campaign stored.toml --shard 1/1 --out s3:{prefix}");
        let ended = bench.behind(&killed_at(at), &command);
        bench.prints(&command, 0);
        let found = bench.objects(&prefix);
        assert_eq!(of_rows(&found), of_rows(&whole), "{at}");
        assert!(!found.contains_key(SUCCESS));
        if ended.is_some() {
            bench.prints(&format!("finish s3:{prefix} --no-report"), 0);
            assert_whole(&bench.objects(&prefix), &whole, &prefix);
            assert!(at > 10, "{at}");
            break;
        }
    }

    let design = HEAD.split("[design]").next().unwrap().replace("seed = 7", "seed = 7\nsamples = 300");
    let stop = "[stop]\nobservable = \"energy_error_max\"\nquantile = 0.5\nhalf_width = 1e-30\nmax_samples = 1200\n";
    let text = [&design, FUSELAGE, WHEEL1, WHEEL2, SPACECRAFT_STATE, SPIN_DISPERSION, stop].concat();
    bench.scratch.file("stop.toml", &text);
    bench.prints("campaign stop.toml --no-report --out stopped", 5);
    let whole = contents(&bench.scratch.path("stopped"));
    for at in (0..).step_by(4) {
        let prefix = format!("stop-{at}");
        let command = format!("campaign stop.toml --no-report --out s3:{prefix}");
        let ended = bench.behind(&killed_at(at), &command);
        bench.prints(&command, 5);
        assert_whole(&bench.objects(&prefix), &whole, &prefix);
        if ended.is_some() {
            break;
        }
    }
}

/// Law: processes that make the same at the same time all succeed; another plan or content is refused by name.
#[test]
fn the_first_content_stays() {
    let bench = Bench::new("writers");
    let whole = bench.whole("");
    let start = |_| {
        let mut command = bench.command("campaign stored.toml --out s3:x", direct());
        command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
    };
    let writers = [(); 3].map(start);
    for mut writer in writers {
        assert!(writer.wait().unwrap().success());
    }
    let found = bench.objects("x");
    assert_whole(&found, &whole, "writers");

    let said = bench.prints("campaign stored.toml --seed 8 --set campaign.duration_s=2 --out s3:x", 4);
    let named = ["another plan", "campaign.seed: 7 there, 8 here", "campaign.duration_s", "choose another --out"];
    assert!(named.iter().all(|part| said.contains(part)), "{said}");
    assert_says(
        bench.prints("campaign stored.toml --set campaign.description=why --out s3:x", 4),
        ["campaign.description"],
    );
    assert!(bench.objects("x") == found);

    for object in ["runs/part-000001.parquet", "summary.json", "manifest.json"] {
        let prefix = format!("y-{}", object.replace('/', "-"));
        bench.put(&format!("{prefix}/{object}"), b"of somebody else");
        let said = bench.prints(&format!("campaign stored.toml --out s3:{prefix}"), 4);
        let there = bench.objects(&prefix);
        assert_says(&said, [object]);
        assert!(there[object] == b"of somebody else" && !there.contains_key(SUCCESS), "{object}");
        bench.remove(&format!("{prefix}/{object}"));
        bench.prints(&format!("campaign stored.toml --out s3:{prefix}"), 0);
        assert_whole(&bench.objects(&prefix), &whole, object);
    }
}

/// Law: `verify` and readers name any changed or missing object; the campaign's command puts it again.
#[test]
fn every_damaged_object_is_found() {
    let bench = Bench::new("damage");
    let whole = bench.whole("");
    let campaign = "campaign stored.toml --out s3:x";
    bench.prints(campaign, 0);
    for (name, bytes) in whole.iter().filter(|(name, _)| *name != SUCCESS) {
        let mut changed = bytes.clone();
        changed[bytes.len() / 2] ^= 1;
        bench.put(&format!("x/{name}"), &changed);
        for command in ["verify s3:x", "report s3:x", campaign] {
            let said = bench.prints(command, 4);
            assert!(said.contains(name), "{name}, {command}: {said}");
        }
        assert!(bench.objects("x")[name] == changed, "{name}");
        bench.remove(&format!("x/{name}"));
        let said = bench.prints("verify s3:x", 4);
        assert!(said.contains(name) && said.contains("missing"), "{name}: {said}");
        bench.prints(campaign, 0);
        assert_whole(&bench.objects("x"), &whole, name);
    }
    for name in [SUCCESS, "manifest.json", "runs/part-000001.parquet"] {
        bench.remove(&format!("x/{name}"));
    }
    assert!(bench.prints("verify s3:x", 5).contains("1 part not made yet"));
    bench.prints(campaign, 0);
    assert_whole(&bench.objects("x"), &whole, "unfinished");
    bench.remove(&format!("x/{SUCCESS}"));
    assert!(bench.prints("verify s3:x", 5).contains("not finished"));
    bench.prints("finish s3:x", 0);
    assert_whole(&bench.objects("x"), &whole, SUCCESS);
}

/// Law: 409 and 503 are tried again, and a lost answer is looked up; a store that never takes an object is given up
/// with its name.
#[test]
fn what_a_store_refuses_for_a_moment_is_tried_again() {
    let bench = Bench::new("again");
    let whole = bench.whole("--no-report");
    let mut turns = 0;
    let conflicts = Proxy::new(move |_, request: &Message| {
        turns += usize::from(request.method() == "PUT");
        if request.method() == "PUT" && turns % 3 != 0 {
            Fate::Answered(409, "<Code>ConditionalRequestConflict</Code>")
        } else {
            Fate::Passed
        }
    });
    let busy = Proxy::new(
        |count, _: &Message| if count % 3 == 0 { Fate::Answered(503, "<Code>SlowDown</Code>") } else { Fate::Passed },
    );
    let lost = Proxy::new(|count, _: &Message| if count % 3 == 2 { Fate::Lost } else { Fate::Passed });
    for (name, proxy) in [("conflicts", conflicts), ("busy", busy), ("lost", lost)] {
        let ended = bench.behind(&proxy, &format!("campaign stored.toml --no-report --out s3:{name}"));
        assert_eq!(ended, Some(0), "{name}");
        assert_whole(&bench.objects(name), &whole, name);
    }
    let never = Proxy::new(|_, request: &Message| {
        let is_refused = request.method() == "PUT" && request.head.contains("/runs/");
        if is_refused { Fate::Answered(409, "<Code>ConditionalRequestConflict</Code>") } else { Fate::Passed }
    });
    let mut command = bench.command("campaign stored.toml --no-report --out s3:never", never.port);
    assert_says(bench.scratch.outputs(&mut command, 4), ["/runs/part-00000", "ConditionalRequestConflict"]);
    assert!(!bench.objects("never").keys().any(|name| name.starts_with("runs/") || name == SUCCESS));
    bench.prints("campaign stored.toml --no-report --out s3:never", 0);
    assert_whole(&bench.objects("never"), &whole, "never");
}

/// Law: a missing setting is named with its remedy, and no message has a credential.
#[test]
fn what_is_missing_is_said() {
    let bench = Bench::new("missing");
    let refusing = Proxy::new(|_, _: &Message| {
        Fate::Answered(
            403,
            "<Error><Code>InvalidAccessKeyId</Code><Message>AKIAKEYOFNOBODY does not exist \
            a-secret-that-nobody-reads</Message></Error>",
        )
    });
    let unavailable = Proxy::new(|_, _: &Message| Fate::Answered(503, "<Code>SlowDown</Code>"));
    let closed = std::net::TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
    let says = |mut command: Command, code: i32, parts: &[&str]| {
        let said = bench.scratch.outputs(&mut command, code);
        assert!(parts.iter().all(|part| said.contains(part)), "{said}");
        assert!(!said.contains(SECRET) && !said.contains(KEY), "{said}");
    };
    let run = |address: &str, port: u16| bench.command(&format!("campaign stored.toml --out {address}"), port);
    says(run("s3:x", refusing.port), 4, &["refused (InvalidAccessKeyId", "AWS_ACCESS_KEY_ID", "/x"]);
    says(run("s3:x", unavailable.port), 4, &["SlowDown", "the same command continues"]);
    says(run("s3:x", closed), 4, &["Connection refused", "AWS_ENDPOINT_URL"]);
    says(run("s3://no-such-bucket/x", direct()), 4, &["there is no bucket `no-such-bucket`", "create it"]);
    let mut command = run("s3:x", direct());
    command.env_remove("AWS_ALLOW_HTTP");
    says(command, 4, &["AWS_ALLOW_HTTP=true"]);
    let mut command = run("s3:x", direct());
    command.env_remove("AWS_ACCESS_KEY_ID").env_remove("AWS_SECRET_ACCESS_KEY");
    command.env("AWS_METADATA_ENDPOINT", format!("http://127.0.0.1:{closed}"));
    says(command, 4, &["no credentials: set AWS_ACCESS_KEY_ID and AWS_SECRET_ACCESS_KEY"]);
    let mut command = run("s3:x", direct());
    command.env_remove("AWS_SECRET_ACCESS_KEY");
    says(command, 4, &["SecretAccessKey"]);

    for (arguments, parts) in [
        ("campaign stored.toml --out gs://b/x", ["gs://b/x", "s3://bucket/name"]),
        ("campaign stored.toml --out s3://b", ["s3://b:", "s3://bucket/name"]),
        ("campaign stored.toml --out s3://b/../x", ["s3://b/../x", "names have letters"]),
        ("campaign stored.toml --overwrite --out s3:x", ["--overwrite", "is not replaced"]),
        ("verify --repair s3:x", ["--repair", "is not replaced"]),
    ] {
        says(bench.command(arguments, direct()), 2, &parts);
    }
    says(bench.command("report s3:x", direct()), 2, &["/x` has no result of spindrift"]);
    assert!(bench.objects("x").is_empty());
}
