//! Both sides of the comparison, each a process of its own on a folder of its own.

use std::io::{BufRead, BufReader};
use std::net::SocketAddr;
use std::path::Path;
use std::process::{Child, Command, Stdio};

use anyhow::{Context, Result, ensure};
use tempfile::TempDir;

use super::client::{Connection, request};

/// Items of the study, and so answers of a session.
pub(super) const ITEMS: usize = 5;

/// Behind the small study, in the order in which their pictures are made.
const SLOW_FILE: &str = "studies/slow.toml";

/// A study of so many items, shown with `pa` and with `mc`, which has these settings besides.
fn study(items: usize, [width, height]: [u32; 2], mc: &str) -> String {
    let item = |i| format!("[[blocks.items]]\nid = \"still-{i}\"\nscene = \"../scenes/load.toml\"\n");
    let items: String = (0..items).map(item).collect();
    format!(
        r#"
title = "Load"
question = "Which?"
seed = 3
size = [{width}, {height}]
estimated_minutes = 1
texts = {{ welcome = "w", consent = "c", instructions = "i", debriefing = "d", thanks = "t" }}
conditions = {{ pa = {{ technique = "pa" }}, mc = {{ technique = "mc"{mc} }} }}
[[blocks]]
id = "stills"
title = "Stills"
kind = "still"
conditions = ["mc", "pa"]
target = "pa"
{items}"#
    )
}

const SCENE: &str = r#"
[screen]
width_m = 1.6
height_m = 0.9
albedo = 0.8
[lamp]
position_m = [0.0, 0.0, -1.5]
[[lamp.emitters]]
name = "bulb"
shape = "rectangle"
size_m = [0.1, 0.1]
radiance = 40.0
[ambient]
model = "none"
[[puppets]]
image = "../puppets/square.svg"
height_m = 0.4
position_m = [0.0, 0.0, -0.2]
texels = 64
[exposure]
white = "auto"
"#;

const SQUARE: &str = r#"<svg xmlns="http://www.w3.org/2000/svg" width="8" height="8"><rect x="2" y="2" width="4" height="4"/></svg>"#;
const RIVAL: &str = include_str!("../../../../../../tests/rivals/express/server.mjs");
const RIVAL_PACKAGE: &str = include_str!("../../../../../../tests/rivals/express/package.json");

/// A server that runs until this is dropped.
pub(super) struct Side {
    pub name: &'static str,
    pub address: SocketAddr,
    process: Child,
    _folder: TempDir,
}

impl Drop for Side {
    fn drop(&mut self) {
        // What has ended already needs no killing.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

fn write(folder: &Path, name: &str, text: &str) -> Result<()> {
    let path = folder.join(name);
    std::fs::create_dir_all(path.parent().unwrap_or(folder))?;
    Ok(std::fs::write(path, text)?)
}

/// kelir itself, with a small study in place of the built-in one.
pub(super) fn kelir() -> Result<Side> {
    served("kelir", tempfile::tempdir()?, "The stimuli are ready.")
}

/// The same while it draws the pictures of another study, which it does for longer than anybody measures.
pub(super) async fn kelir_drawing() -> Result<Side> {
    let folder = tempfile::tempdir()?;
    // Its first picture takes hours.
    write(folder.path(), SLOW_FILE, &study(1, [1920, 1080], ", spp = 1048576"))?;
    let side = served("kelir while it draws", folder, "http://")?;
    let start = request("POST", "/api/v1/studies/shadow-puppets/sessions", "", "{}");
    for _ in 0..300 {
        if Connection::open(side.address).await?.send(&start).await.is_ok() {
            return Ok(side);
        }
        tokio::time::sleep(std::time::Duration::from_millis(100)).await;
    }
    anyhow::bail!("the small study was not ready after 30 s")
}

impl Side {
    /// Whether the slow study's pictures are still being drawn.
    pub(super) async fn draws(&self) -> Result<bool> {
        let start = request("POST", "/api/v1/studies/slow/sessions", "", "{}");
        let refused = Connection::open(self.address).await?.send(&start).await.err();
        Ok(refused.is_some_and(|error| error.to_string().contains("503")))
    }
}

/// A small study in place of the built-in one, served from a folder that may hold others.
fn served(name: &'static str, folder: TempDir, ready: &str) -> Result<Side> {
    write(folder.path(), "studies/shadow-puppets.toml", &study(ITEMS, [32, 18], ""))?;
    write(folder.path(), "scenes/load.toml", SCENE)?;
    write(folder.path(), "puppets/square.svg", SQUARE)?;
    let mut command = Command::new(std::env::current_exe()?);
    command.arg("serve").arg("--data").arg(folder.path()).args(["--listen", "127.0.0.1:0"]);
    start(name, command, folder, ready)
}

/// Express and better-sqlite3, installed into a temporary folder.
pub(super) fn express() -> Result<Side> {
    let folder = tempfile::tempdir()?;
    write(folder.path(), "server.mjs", RIVAL)?;
    write(folder.path(), "package.json", RIVAL_PACKAGE)?;
    let mut npm = Command::new("npm");
    npm.args(["install", "--silent", "--no-audit", "--no-fund"])
        .current_dir(folder.path())
        .stdout(Stdio::null());
    ensure!(npm.status().context("npm cannot be run")?.success(), "npm install failed");
    let mut command = Command::new("node");
    command.arg(folder.path().join("server.mjs")).arg(folder.path().join("rival.sqlite"));
    command.env("NODE_ENV", "production");
    start("Express + better-sqlite3", command, folder, "http://")
}

/// What kelir says where its study is not served.
const NOT_SERVED: &str = "Not every study can be taken";

/// Starts a server and waits for the line that says it is ready; the first address that it prints is its own.
fn start(name: &'static str, mut command: Command, folder: TempDir, ready: &str) -> Result<Side> {
    let mut process = command.stdout(Stdio::piped()).stderr(Stdio::null()).spawn()?;
    let lines = BufReader::new(process.stdout.take().context("no output")?).lines();
    let mut address = None;
    for line in lines.map_while(Result::ok) {
        let found = line.split_once("http://").and_then(|(_, rest)| rest.split('/').next()?.parse().ok());
        address = address.or(found);
        if line.starts_with(NOT_SERVED) {
            break;
        }
        if line.contains(ready) {
            let address = address.context("it printed no address")?;
            return Ok(Side { name, address, process, _folder: folder });
        }
    }
    // Nothing is left of it: it may run on without being ready.
    process.kill()?;
    process.wait()?;
    anyhow::bail!("{name} did not start")
}
