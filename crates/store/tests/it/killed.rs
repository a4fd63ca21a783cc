//! `kill -9` while answers come in: what was acknowledged is there, and nothing is half there.

use crate::setting::{IDLE, answer, append, begin, open, serve, stranger, study};
use kelir_store::Store;
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Command, Stdio};

const FOLDER: &str = "KELIR_TEST_WRITER_FOLDER";

/// Not a test of its own: the process that is killed. It acknowledges on stdout, as the server does over the network.
#[tokio::test(flavor = "multi_thread")]
async fn writer_that_is_killed() {
    let Ok(folder) = std::env::var(FOLDER) else { return };
    let store = Store::open(Path::new(&folder)).await.unwrap();
    let served = serve(&store, study(), 1).await;
    loop {
        let session = begin(&store, &served, IDLE).await;
        for trial in 0..3 {
            append(&store, &session, answer(trial, true, 1.0)).await;
            // Straight to the file descriptor: a test's own output is captured.
            writeln!(std::io::stderr(), "ack {} {trial}", session.session_id).unwrap();
        }
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn a_killed_writer_loses_nothing_that_it_acknowledged() {
    let (folder, store, served) = open().await;
    store.close().await;
    let mut acknowledged = Vec::new();
    for kill_after in [1, 4, 11] {
        let mut writer = Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "killed::writer_that_is_killed", "--nocapture"])
            .env(FOLDER, folder.path())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let lines = BufReader::new(writer.stderr.take().unwrap()).lines().map_while(Result::ok);
        let acks = lines.filter(|line| line.starts_with("ack ")).take(kill_after);
        acknowledged.extend(acks.map(|line| line[4..].to_owned()));
        writer.kill().unwrap();
        writer.wait().unwrap();
    }
    assert_eq!(acknowledged.len(), 16);
    let store = Store::open(folder.path()).await.unwrap();
    for ack in &acknowledged {
        let (session, trial) = ack.split_once(' ').unwrap();
        let answered = store.answered(session).await.unwrap();
        assert!(answered.contains(&trial.parse().unwrap()), "{ack} was acknowledged and is lost");
    }
    let report = store.verify_chain(&served.study.id).await.unwrap();
    assert_eq!(report.faults, []);
    assert!(report.rows >= acknowledged.len() as u64);
    // Neither a row without its answer nor a session without its plan.
    let halves = "SELECT (SELECT count(*) FROM answers) - (SELECT count(*) FROM answer_contents),
                  (SELECT count(*) FROM sessions s WHERE (SELECT count(*) FROM session_trials t WHERE t.session_id = s.session_id) <> 3)";
    let halves: (i64, i64) =
        sqlx::query_as(halves).fetch_one(&mut stranger(folder.path()).await).await.unwrap();
    assert_eq!(halves, (0, 0));
}
