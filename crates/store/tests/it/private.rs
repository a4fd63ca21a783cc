//! A data folder is its owner's alone, and one server's.
#![cfg(unix)]

use crate::setting::{fixture, open};
use kelir_store::{FolderLock, Store, StoreError};
use std::os::unix::fs::PermissionsExt;
use std::path::Path;

/// Paths that others have rights to.
fn open_to_others(path: &Path, found: &mut Vec<String>) {
    let known = path.symlink_metadata().unwrap();
    if known.permissions().mode() & 0o077 != 0 {
        found.push(format!("{} {:o}", path.display(), known.permissions().mode()));
    }
    if known.is_dir() {
        std::fs::read_dir(path).unwrap().for_each(|entry| open_to_others(&entry.unwrap().path(), found));
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn nobody_else_has_rights_to_a_data_folder_new_or_old() {
    let (new, _store, _) = open().await;
    let old = fixture("answered");
    std::fs::set_permissions(old.path(), PermissionsExt::from_mode(0o755)).unwrap();
    std::fs::set_permissions(old.path().join("kelir.sqlite"), PermissionsExt::from_mode(0o644)).unwrap();
    let _brought_over = Store::open(old.path()).await.unwrap();
    for folder in [new.path(), old.path()] {
        let mut found = Vec::new();
        open_to_others(folder, &mut found);
        assert_eq!(found, [""; 0]);
    }
    assert!(new.path().join("kelir.sqlite-wal").exists(), "the files beside the database are looked at too");
}

#[test]
fn a_second_server_is_told_who_holds_the_folder() {
    let folder = tempfile::tempdir().unwrap();
    let first = FolderLock::take(folder.path(), "http://127.0.0.1:1").unwrap();
    let refused = FolderLock::take(folder.path(), "http://127.0.0.1:2").unwrap_err();
    let StoreError::Held { holder, .. } = &refused else { panic!("{refused}") };
    let process = format!("process {}, http://127.0.0.1:1, since ", std::process::id());
    assert!(holder.starts_with(&process), "{holder}");
    drop(first);
    FolderLock::take(folder.path(), "http://127.0.0.1:2").unwrap();
}
