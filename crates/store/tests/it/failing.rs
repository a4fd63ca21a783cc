//! A disk that fails: nothing that was acknowledged is lost, and the store is back once the cause is gone.

use crate::setting::{IDLE, answer, append, begin, open, stranger};
use kelir_store::{Appended, NextTrials, SentAnswer, Session, Store, StoreError, Trouble};
use kelir_study::trials::Checked;

async fn try_append(store: &Store, session: &Session, trial: u32) -> Result<Appended, StoreError> {
    let nothing = |_| -> Result<NextTrials, StoreError> { panic!("a whole plan was asked to go on") };
    store.append_answer(session, &answer(trial, true, 500.0), nothing).await
}

#[tokio::test(flavor = "multi_thread")]
async fn a_lock_that_another_holds_for_too_long_is_said_and_waited_out() {
    let (folder, store, served) = open().await;
    let session = begin(&store, &served, IDLE).await;
    let mut stranger = stranger(folder.path()).await;
    sqlx::query("BEGIN IMMEDIATE").execute(&mut stranger).await.unwrap();
    let error = try_append(&store, &session, 0).await.unwrap_err();
    assert_eq!(error.as_trouble(), Some(Trouble::Locked), "{error}");
    assert_eq!(store.check().await.unwrap_err().as_trouble(), Some(Trouble::Locked));
    assert_eq!(store.answered(&session.session_id).await.unwrap(), [0; 0], "reading goes on");
    sqlx::query("ROLLBACK").execute(&mut stranger).await.unwrap();
    assert_eq!(append(&store, &session, answer(0, true, 500.0)).await, Appended::Stored);
    store.check().await.unwrap();
}

/// A sync tool, a restored backup or a tidy hand: what is written to a file without a name ends with the process.
#[cfg(unix)]
#[tokio::test(flavor = "multi_thread")]
async fn nothing_is_acknowledged_into_a_file_that_is_no_longer_there() {
    let (folder, store, served) = open().await;
    let session = begin(&store, &served, IDLE).await;
    let [database, aside] = ["kelir.sqlite", "aside"].map(|name| folder.path().join(name));
    let refused = async |trial: u32| {
        let error = try_append(&store, &session, trial).await.unwrap_err();
        assert_eq!(error.as_trouble(), Some(Trouble::Gone), "{error}");
        assert_eq!(store.check().await.unwrap_err().as_trouble(), Some(Trouble::Gone));
    };
    std::fs::rename(&database, &aside).unwrap();
    refused(0).await;
    std::fs::copy(&aside, &database).unwrap();
    refused(1).await;
    std::fs::rename(&aside, &database).unwrap();
    store.check().await.unwrap();
    assert_eq!(append(&store, &session, answer(2, true, 500.0)).await, Appended::Stored);
    // What was committed last lies beside the database until it is brought into it.
    std::fs::remove_file(folder.path().join("kelir.sqlite-wal")).unwrap();
    refused(3).await;
    std::fs::remove_dir_all(folder.path()).unwrap();
    refused(4).await;
}

#[tokio::test(flavor = "multi_thread")]
async fn a_job_that_fails_or_panics_takes_no_other_with_it() {
    let (_folder, store, served) = open().await;
    let session = begin(&store, &served, IDLE).await;
    let jobs = (0..30u32).map(|n| {
        let (store, session) = (store.clone(), session.clone());
        tokio::spawn(async move {
            // Trials 0 to 2 are there; the rest of what is asked for is not, is refused or falls over.
            let check = move |_: &kelir_study::Trial| match n {
                0..3 => {
                    Ok(Checked { answer: r#"{"choice":"left","rt_ms":1}"#.to_owned(), stimulus_size: None })
                }
                _ if n % 2 == 0 => Err(StoreError::Undecodable("no answer".to_owned())),
                _ => panic!("on purpose"),
            };
            let session_id = session.session_id.clone();
            let sent = SentAnswer {
                session_id,
                trial_index: n % 3,
                payload: format!("{n}"),
                known: None,
                plan: None,
            };
            let (admit, next) = (|_| Ok(session), |_: &Session, _| Ok(NextTrials::default()));
            store.take_answer(sent, admit, check, next).await.is_ok()
        })
    });
    let mut stored = Vec::new();
    for (n, job) in (0..30u32).zip(jobs.collect::<Vec<_>>()) {
        if job.await.unwrap() {
            stored.push(n);
        }
    }
    assert_eq!(stored, [0, 1, 2]);
    let report = store.verify_chain(&session.study_id).await.unwrap();
    assert_eq!((report.rows, report.faults), (3, vec![]));
}

#[tokio::test(flavor = "multi_thread")]
async fn looking_whether_it_can_write_leaves_nothing() {
    let (folder, store, _) = open().await;
    let before = crate::setting::dump(folder.path()).await;
    store.check().await.unwrap();
    assert!(crate::setting::dump(folder.path()).await == before);
}

#[cfg(target_os = "linux")]
mod injected {
    use super::*;
    use crate::setting::{serve, study};
    use rusqlite::ffi;
    use std::ffi::{c_int, c_void};
    use std::path::Path;
    use std::process::Command;
    use std::sync::atomic::{AtomicI64, AtomicU64, Ordering::SeqCst};

    const FOLDER: &str = "KELIR_TEST_FAILING_FOLDER";
    /// Calls of this process until one fails; none does while it is negative.
    static LEFT: AtomicI64 = AtomicI64::new(-1);
    /// How it fails.
    static ERRNO: AtomicI64 = AtomicI64::new(0);
    /// Whether every later one fails too.
    static FOR_GOOD: AtomicI64 = AtomicI64::new(0);
    static FAILED_WRITES: AtomicU64 = AtomicU64::new(0);
    static FAILED_SYNCS: AtomicU64 = AtomicU64::new(0);

    fn fails(failed: &AtomicU64) -> bool {
        let left = LEFT.load(SeqCst);
        if left < 0 {
            return false;
        }
        if left > 0 {
            LEFT.store(left - 1, SeqCst);
            return false;
        }
        LEFT.store(FOR_GOOD.load(SeqCst) - 1, SeqCst);
        failed.fetch_add(1, SeqCst);
        // SAFETY: it is this thread's own errno.
        unsafe { *libc::__errno_location() = ERRNO.load(SeqCst) as c_int };
        true
    }

    /// What SQLite calls in place of write(2).
    unsafe extern "C" fn write(fd: c_int, bytes: *const c_void, n: usize) -> isize {
        // SAFETY: SQLite's own arguments are passed on.
        if fails(&FAILED_WRITES) { -1 } else { unsafe { libc::write(fd, bytes, n) } }
    }

    /// What it calls in place of pwrite(2), as it does where it is built so.
    unsafe extern "C" fn pwrite(fd: c_int, bytes: *const c_void, n: usize, at: libc::off64_t) -> isize {
        // SAFETY: SQLite's own arguments are passed on.
        if fails(&FAILED_WRITES) { -1 } else { unsafe { libc::pwrite64(fd, bytes, n, at) } }
    }

    /// Stands before libc's in this test program, where SQLite is linked into.
    #[unsafe(no_mangle)]
    extern "C" fn fdatasync(fd: c_int) -> c_int {
        // SAFETY: a system call on a file's number; a bad one is refused.
        if fails(&FAILED_SYNCS) { -1 } else { unsafe { libc::syscall(libc::SYS_fdatasync, fd) as c_int } }
    }

    /// The same of fsync(2), which SQLite uses where it is built so.
    #[unsafe(no_mangle)]
    extern "C" fn fsync(fd: c_int) -> c_int {
        // SAFETY: as above.
        if fails(&FAILED_SYNCS) { -1 } else { unsafe { libc::syscall(libc::SYS_fsync, fd) as c_int } }
    }

    fn intercept_writes() {
        let calls = [
            (c"write", write as *const c_void),
            (c"pwrite", pwrite as *const c_void),
            (c"pwrite64", pwrite as *const c_void),
        ];
        for (name, call) in calls {
            // SAFETY: SQLite's documented way to stand before its system calls, done before any database is open; each function has the type
            // that SQLite calls.
            unsafe {
                let vfs = ffi::sqlite3_vfs_find(std::ptr::null());
                let set = (*vfs).xSetSystemCall.unwrap();
                let call = std::mem::transmute::<*const c_void, unsafe extern "C" fn()>(call);
                assert_eq!(set(vfs, name.as_ptr(), Some(call)), ffi::SQLITE_OK);
            }
        }
    }

    /// Not a test by itself: the program that [`after_each_failing_write_and_sync_the_store_is_back`] starts, for faults are the process's.
    #[tokio::test(flavor = "multi_thread")]
    async fn store_on_a_failing_disk() {
        let Ok(folder) = std::env::var(FOLDER) else { return };
        intercept_writes();
        let store = Store::open(Path::new(&folder)).await.unwrap();
        let served = serve(&store, study(), 1).await;
        let mut acknowledged = Vec::new();
        for (errno, trouble) in [(libc::EIO, Trouble::Failing), (libc::ENOSPC, Trouble::Full)] {
            ERRNO.store(i64::from(errno), SeqCst);
            for nth in 0.. {
                let session = begin(&store, &served, IDLE).await;
                LEFT.store(nth, SeqCst);
                let mut refused = 0;
                for trial in [0, 1] {
                    match try_append(&store, &session, trial).await {
                        Ok(_) => acknowledged.push((session.session_id.clone(), trial)),
                        Err(error) => {
                            assert!(error.as_trouble().is_some(), "{nth}: {error}");
                            refused += 1;
                        }
                    }
                }
                let left = LEFT.swap(-1, SeqCst);
                assert!(refused <= 1, "one failure refuses one group: {nth}");
                // Back at once, and what was refused can be sent again.
                for trial in [0, 1, 2] {
                    append(&store, &session, answer(trial, true, 500.0)).await;
                    acknowledged.push((session.session_id.clone(), trial));
                }
                if left >= 0 {
                    break;
                }
            }
            // A disk that stays full is said; once it is not, so is that.
            FOR_GOOD.store(1, SeqCst);
            LEFT.store(0, SeqCst);
            assert_eq!(store.check().await.unwrap_err().as_trouble(), Some(trouble));
            // What opening anew runs into is some trouble or other.
            assert!(store.check().await.unwrap_err().as_trouble().is_some());
            LEFT.store(-1, SeqCst);
            FOR_GOOD.store(0, SeqCst);
            store.check().await.unwrap();
        }
        let failed = [&FAILED_WRITES, &FAILED_SYNCS].map(|n| n.load(SeqCst));
        assert!(failed.iter().all(|n| *n > 0), "no writes or no syncs were made to fail: {failed:?}");
        store.close().await;
        let store = Store::open(Path::new(&folder)).await.unwrap();
        for (session, trial) in acknowledged {
            assert!(store.answered(&session).await.unwrap().contains(&trial), "{session} {trial} is lost");
        }
        assert_eq!(store.verify_chain(&served.study.id).await.unwrap().faults, []);
        std::fs::write(Path::new(&folder).join("done"), "").unwrap();
    }

    #[test]
    fn after_each_failing_write_and_sync_the_store_is_back() {
        let folder = tempfile::tempdir().unwrap();
        let child = Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "failing::injected::store_on_a_failing_disk", "--nocapture"])
            .env(FOLDER, folder.path())
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&child.stderr);
        assert!(child.status.success() && folder.path().join("done").exists(), "{said}");
    }
}
