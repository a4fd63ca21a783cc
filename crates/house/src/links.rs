//! Signed links to a study: whoever has one may try it, as a preview or as a pilot, until it ends. A link that is not signed does nothing.

use crate::secret::random_token;
use hmac::{Hmac, KeyInit, Mac};
use kelir_store::{private_file, sha256_hex};
use kelir_study::schema::worded;
use sha2::Sha256;
use std::io::{self, ErrorKind, Write};
use std::path::Path;
use std::time::{SystemTime, UNIX_EPOCH};

worded! {
    /// What a visit to a study is.
    pub enum Visit {
        /// Somebody takes part.
        Participant = "participant",
        /// Somebody tries the study: stored, counted apart, left out of every analysis.
        Pilot = "pilot",
        /// Somebody looks at the study: nothing is stored.
        Preview = "preview",
    }
}

/// Parameters that a link to a study may have beside the one that says what it is for.
const EXPIRES: &str = "exp";
const KEY_ID: &str = "key";
const SIGNATURE: &str = "sig";

/// Parameters of a link, decoded.
pub type Pairs = [(String, String)];

/// Makes and knows links with the key of a data folder.
#[derive(Clone)]
pub struct Links {
    key: String,
}

impl Links {
    /// The key of a data folder; it is made, for the owner's eyes alone, where there is none.
    ///
    /// # Errors
    /// It can be neither read nor made.
    pub fn open(data: &Path) -> io::Result<Links> {
        let path = data.join("link-key");
        match std::fs::read_to_string(&path) {
            Ok(text) if text.trim().len() >= 32 => return Ok(Links { key: text.trim().to_owned() }),
            Ok(_) => {
                return Err(io::Error::new(ErrorKind::InvalidData, "link-key: is too short to be a key"));
            }
            Err(error) if error.kind() != ErrorKind::NotFound => return Err(error),
            Err(_) => {}
        }
        let key = random_token();
        let made = private_file().create_new(true).open(&path);
        match made.and_then(|mut file| writeln!(file, "{key}").and_then(|()| file.sync_all())) {
            Ok(()) => Ok(Links { key }),
            // Another process was faster: its key is the folder's.
            Err(error) if error.kind() == ErrorKind::AlreadyExists => {
                Ok(Links { key: std::fs::read_to_string(&path)?.trim().to_owned() })
            }
            Err(error) => Err(error),
        }
    }

    /// Path and query of a link to a study, good until `expires` (seconds since 1970).
    pub fn link(&self, study: &str, visit: Visit, expires: u64) -> String {
        let path = path(study);
        let pairs = [
            (visit.as_str().to_owned(), "1".to_owned()),
            (EXPIRES.to_owned(), expires.to_string()),
            (KEY_ID.to_owned(), self.id()),
        ];
        let signature = hex::encode(self.mac(&path, &pairs).finalize().into_bytes());
        let query: Vec<String> = pairs.iter().map(|(name, value)| format!("{name}={value}")).collect();
        format!("{path}?{}&{SIGNATURE}={signature}", query.join("&"))
    }

    /// What the parameters of a link make of a visit to a study. Without a signature it is a participant's, unless a researcher asks.
    ///
    /// # Errors
    /// The link is signed and not good: why, as a sentence.
    pub fn visit(
        &self,
        study: &str,
        pairs: &Pairs,
        is_researcher: bool,
        now: u64,
    ) -> Result<Visit, &'static str> {
        let get = |name: &str| pairs.iter().find(|(known, _)| known == name).map(|(_, value)| value.as_str());
        let asked = [Visit::Pilot, Visit::Preview].into_iter().find(|visit| get(visit.as_str()).is_some());
        let Some(visit) = asked else { return Ok(Visit::Participant) };
        let Some(signature) = get(SIGNATURE) else {
            // Participants could rehearse otherwise.
            return Ok(if is_researcher { visit } else { Visit::Participant });
        };
        let known = [visit.as_str(), EXPIRES, KEY_ID, SIGNATURE];
        let once = |name: &str| pairs.iter().filter(|(other, _)| other == name).count() == 1;
        if !pairs.iter().all(|(name, _)| known.contains(&name.as_str()) && once(name)) {
            return Err("This link has been changed. Please ask for a new one.");
        }
        if get(KEY_ID) != Some(&self.id()) {
            return Err(
                "This link is of another server, or its key has been changed. Please ask for a new one.",
            );
        }
        let signed: Vec<_> = pairs.iter().filter(|(name, _)| name != SIGNATURE).cloned().collect();
        // Compared in constant time.
        if self.mac(&path(study), &signed).verify_slice(&hex::decode(signature).unwrap_or_default()).is_err()
        {
            return Err("This link has been changed. Please ask for a new one.");
        }
        match get(EXPIRES).and_then(|text| text.parse::<u64>().ok()) {
            Some(expires) if now < expires => Ok(visit),
            _ => Err("This link has ended. Please ask for a new one."),
        }
    }

    /// Names the key without telling it.
    fn id(&self) -> String {
        sha256_hex(format!("kelir-link-key\n{}", self.key).as_bytes())[..8].to_owned()
    }

    /// Over method, path and the sorted, decoded parameters, as one JSON text: no two links have the same.
    fn mac(&self, path: &str, pairs: &Pairs) -> Hmac<Sha256> {
        let mut sorted: Vec<&(String, String)> = pairs.iter().collect();
        sorted.sort();
        let text = serde_json::json!(["GET", path, sorted]).to_string();
        // HMAC takes keys of any length.
        let mut mac = Hmac::<Sha256>::new_from_slice(self.key.as_bytes())
            .unwrap_or_else(|_| Hmac::new(&Default::default()));
        mac.update(text.as_bytes());
        mac
    }
}

/// Whether a parameter is the link's own, and none of the person who follows it.
pub fn is_of_link(name: &str) -> bool {
    [Visit::Pilot.as_str(), Visit::Preview.as_str(), EXPIRES, KEY_ID, SIGNATURE].contains(&name)
}

/// Seconds since 1970.
pub fn now() -> u64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs())
}

fn path(study: &str) -> String {
    format!("/study/{study}")
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

    use super::*;
    use std::os::unix::fs::PermissionsExt;

    fn pairs(link: &str) -> Vec<(String, String)> {
        let query = link.split_once('?').unwrap().1;
        query
            .split('&')
            .map(|pair| pair.split_once('=').unwrap())
            .map(|(a, b)| (a.to_owned(), b.to_owned()))
            .collect()
    }

    #[test]
    fn a_link_opens_what_it_was_made_for_until_it_ends_and_nothing_else() {
        let dir = tempfile::tempdir().unwrap();
        let links = Links::open(dir.path()).unwrap();
        let mode = std::fs::metadata(dir.path().join("link-key")).unwrap().permissions().mode();
        assert_eq!(mode & 0o777, 0o600);
        let good = pairs(&links.link("small", Visit::Pilot, 1000));
        let visit = |study: &str, pairs: &Pairs, now| links.visit(study, pairs, false, now);
        assert_eq!(visit("small", &good, 999), Ok(Visit::Pilot));
        assert!(visit("small", &good, 1000).unwrap_err().contains("has ended"));
        assert!(visit("other", &good, 999).is_err());
        // The order of parameters does not count; the same folder knows its links later.
        let turned: Vec<_> = good.iter().rev().cloned().collect();
        assert_eq!(Links::open(dir.path()).unwrap().visit("small", &turned, false, 999), Ok(Visit::Pilot));
        for (at, name, value) in [
            (0, "preview", "1"),
            (0, "pilot", "2"),
            (1, "exp", "2000"),
            (2, "key", "00000000"),
            (3, "sig", "00"),
            (3, "sig", "é"),
        ] {
            let mut changed = good.clone();
            changed[at] = (name.to_owned(), value.to_owned());
            assert!(visit("small", &changed, 999).is_err(), "{name}={value}");
        }
        for more in [("lang", "de"), ("pilot", "1"), ("exp", "1000")] {
            let mut added = good.clone();
            added.push((more.0.to_owned(), more.1.to_owned()));
            assert!(visit("small", &added, 999).is_err(), "{more:?}");
        }
        let elsewhere = tempfile::tempdir().unwrap();
        assert!(Links::open(elsewhere.path()).unwrap().visit("small", &good, false, 999).is_err());
    }

    #[test]
    fn without_a_signature_only_a_researcher_tries_a_study() {
        let dir = tempfile::tempdir().unwrap();
        let links = Links::open(dir.path()).unwrap();
        let plain = [("preview".to_owned(), String::new())];
        assert_eq!(links.visit("small", &plain, false, 0), Ok(Visit::Participant));
        assert_eq!(links.visit("small", &plain, true, 0), Ok(Visit::Preview));
        assert_eq!(links.visit("small", &[], true, 0), Ok(Visit::Participant));
    }
}
