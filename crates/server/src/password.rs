//! The researcher's password: made at first start, kept as an argon2 hash, never logged.

use crate::error::StartError;
use argon2::Argon2;
use argon2::password_hash::phc::PasswordHash;
use argon2::password_hash::{PasswordHasher, PasswordVerifier};
use kelir_store::{Store, private_file};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

/// Where the password that is in force comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PasswordSource {
    /// It was given at the start, which the file in the data folder is not asked for.
    Given,
    /// This file.
    File(PathBuf),
    /// An earlier start: there is no file, and the database has its hash.
    Stored,
}

/// The one researcher there is so far.
pub(crate) const RESEARCHER: &str = "researcher";

/// Where the generated password lies.
pub(crate) fn file(data: &Path) -> PathBuf {
    data.join("researcher-password")
}

/// Sees to it that the database holds the hash of the password in force: `chosen`, else the file's, else, when there is no
/// hash yet, a new one that is written to the file. Answers which it is.
pub(crate) async fn set_up(store: &Store, chosen: Option<&str>) -> Result<PasswordSource, StartError> {
    let path = file(store.folder());
    let stored = store.password_hash(RESEARCHER).await?;
    let failed = |error: std::io::Error| StartError::Password(format!("{}: {error}", path.display()));
    let password = match chosen {
        Some(password) if password.chars().count() < 8 => {
            return Err(StartError::Password("must have at least 8 characters".to_owned()));
        }
        Some(password) => password.to_owned(),
        None => match std::fs::read_to_string(&path) {
            Ok(text) if !text.trim().is_empty() => text.trim().to_owned(),
            Ok(_) => return Err(StartError::Password(format!("{} is empty", path.display()))),
            Err(error) if error.kind() != ErrorKind::NotFound => return Err(failed(error)),
            // The file was taken away on purpose: the hash alone is enough.
            Err(_) if stored.is_some() => return Ok(PasswordSource::Stored),
            Err(_) => {
                let password = generate();
                private_file()
                    .create_new(true)
                    .open(&path)
                    .and_then(|mut file| writeln!(file, "{password}").and_then(|()| file.sync_all()))
                    .map_err(failed)?;
                password
            }
        },
    };
    let fresh = tokio::task::spawn_blocking(move || match stored {
        Some(hash) if verify(&password, &hash) => Ok(None),
        _ => hash(&password).map(Some),
    })
    .await
    .map_err(|e| StartError::Password(e.to_string()))??;
    if let Some(hash) = fresh {
        store.set_password_hash(RESEARCHER, &hash).await?;
    }
    Ok(if chosen.is_some() { PasswordSource::Given } else { PasswordSource::File(path) })
}

fn hash(password: &str) -> Result<String, StartError> {
    let hash = Argon2::default().hash_password(password.as_bytes());
    hash.map(|h| h.to_string()).map_err(|e| StartError::Password(e.to_string()))
}

/// Whether `password` has this hash; takes the same time for any wrong one.
pub(crate) fn verify(password: &str, hash: &str) -> bool {
    PasswordHash::new(hash)
        .is_ok_and(|hash| Argon2::default().verify_password(password.as_bytes(), &hash).is_ok())
}

/// Four groups of five of Crockford's letters: 100 bits, readable aloud.
fn generate() -> String {
    let code = random_code(20);
    let groups: Vec<&str> = (0..4).map(|i| &code[5 * i..5 * i + 5]).collect();
    groups.join("-").to_lowercase()
}

/// `n` random letters and digits that are not mistaken for one another (Crockford's base 32, 5 bits each).
pub(crate) fn random_code(n: usize) -> String {
    const LETTERS: &[u8; 32] = b"0123456789ABCDEFGHJKMNPQRSTVWXYZ";
    let mut code = String::with_capacity(n);
    while code.len() < n {
        // Bytes 6 and 8 of a version 4 UUID hold its fixed bits; the others are random.
        for (i, byte) in uuid::Uuid::new_v4().as_bytes().iter().enumerate() {
            if i != 6 && i != 8 && code.len() < n {
                code.push(LETTERS[usize::from(byte & 31)] as char);
            }
        }
    }
    code
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

    use super::*;
    use std::os::unix::fs::PermissionsExt;

    #[test]
    fn a_hash_knows_its_password_and_no_other() {
        let hash = hash("wayang kulit").unwrap();
        assert!(hash.starts_with("$argon2id$"));
        assert!(verify("wayang kulit", &hash));
        assert!(!verify("wayang kulis", &hash));
        assert!(!verify("wayang kulit", "no hash"));
    }

    #[tokio::test]
    async fn the_password_is_made_once_kept_private_and_can_be_overridden() {
        let dir = tempfile::tempdir().unwrap();
        let store = Store::open(dir.path()).await.unwrap();
        let holds = |password: String| {
            let store = store.clone();
            async move { verify(&password, &store.password_hash(RESEARCHER).await.unwrap().unwrap()) }
        };
        assert_eq!(set_up(&store, None).await.unwrap(), PasswordSource::File(file(dir.path())));
        let path = file(dir.path());
        let first = std::fs::read_to_string(&path).unwrap().trim().to_owned();
        assert_eq!(first.len(), 23);
        assert_eq!(std::fs::metadata(&path).unwrap().permissions().mode() & 0o777, 0o600);
        set_up(&store, None).await.unwrap();
        assert!(holds(first.clone()).await);
        assert_eq!(set_up(&store, Some("chosen by hand")).await.unwrap(), PasswordSource::Given);
        assert!(holds("chosen by hand".to_owned()).await && !holds(first.clone()).await);
        set_up(&store, None).await.unwrap();
        assert!(holds(first.clone()).await);
        std::fs::remove_file(&path).unwrap();
        assert_eq!(set_up(&store, None).await.unwrap(), PasswordSource::Stored);
        assert!(holds(first).await && !path.exists());
        assert!(set_up(&store, Some("short")).await.is_err());
    }

    #[test]
    fn codes_are_random_and_of_the_stated_letters() {
        let codes: std::collections::HashSet<String> = (0..1000).map(|_| random_code(8)).collect();
        assert_eq!(codes.len(), 1000);
        assert!(codes.iter().all(|c| c.len() == 8 && !c.contains(['I', 'L', 'O', 'U'])));
    }
}
