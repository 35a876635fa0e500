//! The campaign of the tests of object stores, and its machines.

use crate::prelude::*;

use super::store_proxy::{Proxy, asked, objects, server};

pub const HEAD: &str = r#"
[campaign]
name = "stored"
seed = 7
duration_s = 1.0
[integrator]
method = "auto"
tolerance = 1e-10
[observe]
points = 11
[design]
kind = "table"
file = "table.csv"
[retain]
trajectories = "worst:2 by energy_error_max"
"#;
pub const HEAD_OBJECT: &str = "dataset.json";
pub const SUCCESS: &str = "_SUCCESS";
/// Credentials that no message and no file may show.
pub const SECRET: &str = "a-secret-that-nobody-reads";
pub const KEY: &str = "AKIAKEYOFNOBODY";

pub type Objects = BTreeMap<String, Vec<u8>>;

pub struct Bench {
    pub scratch: ScratchFolder,
    pub bucket: String,
}

impl Bench {
    pub fn new(name: &str) -> Bench {
        let scratch = ScratchFolder::new(&format!("store-{name}"));
        let text = [HEAD, FUSELAGE, WHEEL1, WHEEL2, SPACECRAFT_STATE].concat();
        scratch.file("stored.toml", &text);
        let rows = (0..600).map(|row| format!("{:?}\n", 0.2 + f64::from(row) * 1e-3));
        scratch.file("table.csv", &("initial.angular_velocity_rad_s.z\n".to_owned() + &rows.collect::<String>()));
        let bucket = format!("{name}-{}", std::process::id());
        assert_eq!(asked("PUT", &format!("/{bucket}"), b"").0, 200);
        Bench { scratch, bucket }
    }

    pub fn command(&self, arguments: &str, port: u16) -> Command {
        let bucket = format!("s3://{}/", self.bucket);
        let arguments =
            if arguments.contains("://") { arguments.to_owned() } else { arguments.replace("s3:", &bucket) };
        let mut command = self.scratch.command(&arguments);
        for (name, _) in
            std::env::vars().filter(|(name, _)| name.starts_with("AWS_") || name.to_lowercase().ends_with("_proxy"))
        {
            command.env_remove(name);
        }
        command.env("AWS_ACCESS_KEY_ID", KEY).env("AWS_SECRET_ACCESS_KEY", SECRET).env("AWS_REGION", "us-east-1");
        command.env("AWS_ENDPOINT_URL", format!("http://127.0.0.1:{port}")).env("AWS_ALLOW_HTTP", "true");
        command.env("COLUMNS", "1000");
        command
    }

    pub fn prints(&self, arguments: &str, code: i32) -> String {
        let said = self.scratch.outputs(&mut self.command(arguments, direct()), code);
        assert!(!said.contains(SECRET) && !said.contains(KEY), "{said}");
        said
    }

    /// The exit code behind `proxy`, `None` if killed.
    pub fn behind(&self, proxy: &Proxy, arguments: &str) -> Option<i32> {
        let mut command = self.command(arguments, proxy.port);
        proxy.watch(command.stdout(Stdio::null()).stderr(Stdio::null()))
    }

    pub fn objects(&self, prefix: &str) -> Objects {
        objects(&self.bucket, prefix)
    }

    pub fn whole(&self, options: &str) -> Objects {
        self.prints(&format!("campaign stored.toml --out whole {options}"), 0);
        contents(&self.scratch.path("whole"))
    }

    pub fn put(&self, object: &str, bytes: &[u8]) {
        assert_eq!(asked("PUT", &format!("/{}/{object}", self.bucket), bytes).0, 200);
    }

    pub fn remove(&self, object: &str) {
        assert_eq!(asked("DELETE", &format!("/{}/{object}", self.bucket), b"").0, 204);
    }
}

pub fn direct() -> u16 {
    server().rsplit(':').next().and_then(|port| port.parse().ok()).unwrap()
}

pub fn assert_whole(found: &Objects, whole: &Objects, what: &str) {
    assert_eq!(found.keys().collect::<Vec<_>>(), whole.keys().collect::<Vec<_>>(), "{what}");
    for (name, bytes) in whole {
        assert!(found[name] == *bytes, "{what}: {name} differs");
    }
}
