//! Which versions of a study an analysis is of: one that gives the design, and others whose answers are pooled with it by name.

use crate::versions::stored;
use kelir_report::{DifferentStimulus, PooledVersion};
use kelir_store::{Store, StoreError, StudyStimulus, StudyVersion};
use kelir_study::StudyDefinition;
use kelir_study::visits::{SessionKind, Visit};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::time::Duration;

/// A version as somebody names it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum VersionRef {
    /// `current`: the one that is served now, or was served last.
    Current,
    /// Its hash, or the beginning of it: 8 to 64 hex digits in small letters.
    Hash(String),
}

/// Whose answers count beside the named version's.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum With {
    /// Those of every other version.
    All,
    /// Those of these versions; none: the named version's alone.
    These(Vec<VersionRef>),
}

impl Default for With {
    fn default() -> With {
        With::These(Vec::new())
    }
}

/// Kinds of sessions that are judged like participants'.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Include(pub Vec<SessionKind>);

/// Why versions cannot be chosen.
#[derive(Debug, thiserror::Error)]
pub enum SelectionError {
    /// The name is none.
    #[error("version = {0:?}: {RULE}")]
    Malformed(String),
    /// A kind of session is none, or named twice.
    #[error("include = {0:?}: {INCLUDE_RULE}")]
    MalformedKinds(String),
    /// No version of the study begins like that.
    #[error("version = {0:?}: this study has no such version; it has {known}", known = list(.1))]
    Unknown(String, Vec<String>),
    /// More than one does.
    #[error("version = {0:?}: more than one version begins like that, give more digits: {known}", known = list(.1))]
    Ambiguous(String, Vec<String>),
    /// The study was never served: it has no version yet.
    #[error("the study has no version yet: its stimuli were never all made")]
    NoVersion,
    /// The data cannot be read.
    #[error(transparent)]
    Store(#[from] StoreError),
}

/// The rule of a version's name.
pub const RULE: &str = "must be current, or 8 to 64 digits of a version's hash (0-9, a-f)";
/// The rule of kinds of sessions that are judged too.
pub const INCLUDE_RULE: &str = "must be pilot, simulated or both, separated by a comma";
/// Fewest digits that may stand for a whole hash.
const FEWEST: usize = 8;

fn list(versions: &[String]) -> String {
    if versions.is_empty() { "none".to_owned() } else { versions.join(", ") }
}

impl std::str::FromStr for VersionRef {
    type Err = SelectionError;

    fn from_str(text: &str) -> Result<VersionRef, SelectionError> {
        let digits = text.bytes().all(|b| b.is_ascii_digit() || (b'a'..=b'f').contains(&b));
        match text {
            "current" => Ok(VersionRef::Current),
            _ if digits && (FEWEST..=64).contains(&text.len()) => Ok(VersionRef::Hash(text.to_owned())),
            _ => Err(SelectionError::Malformed(text.to_owned())),
        }
    }
}

impl std::str::FromStr for With {
    type Err = SelectionError;

    /// `all`, or versions separated by commas; empty: none.
    fn from_str(text: &str) -> Result<With, SelectionError> {
        match text {
            "" => Ok(With::default()),
            "all" => Ok(With::All),
            text => text.split(',').map(str::parse).collect::<Result<_, _>>().map(With::These),
        }
    }
}

impl std::str::FromStr for Include {
    type Err = SelectionError;

    /// Kinds separated by commas; empty: none.
    fn from_str(text: &str) -> Result<Include, SelectionError> {
        let malformed = || SelectionError::MalformedKinds(text.to_owned());
        let mut kinds = Vec::new();
        for name in text.split(',').filter(|_| !text.is_empty()) {
            let others = [SessionKind::Pilot, SessionKind::Simulated];
            let kind = others.into_iter().find(|kind| kind.as_str() == name && !kinds.contains(kind));
            kinds.push(kind.ok_or_else(malformed)?);
        }
        Ok(Include(kinds))
    }
}

impl VersionRef {
    /// The one of `known` (the current one first) that is meant.
    fn among<'a>(&self, known: &'a [StudyVersion]) -> Result<&'a StudyVersion, SelectionError> {
        let VersionRef::Hash(beginning) = self else { return known.first().ok_or(SelectionError::NoVersion) };
        let fitting: Vec<&StudyVersion> =
            known.iter().filter(|version| version.version.starts_with(beginning.as_str())).collect();
        let names = |versions: &[&StudyVersion]| versions.iter().map(|v| v.version.clone()).collect();
        match fitting.as_slice() {
            [only] => Ok(only),
            [] => {
                let known: Vec<&StudyVersion> = known.iter().collect();
                Err(SelectionError::Unknown(beginning.clone(), names(&known)))
            }
            several => Err(SelectionError::Ambiguous(beginning.clone(), names(several))),
        }
    }
}

/// The versions chosen.
#[derive(Clone, Debug)]
pub struct Selection {
    /// The design that answers are judged by: that of the first version.
    pub study: StudyDefinition,
    /// Versions whose answers count, the named one first.
    pub versions: Vec<String>,
    /// Whose answers are judged besides participants'.
    pub include: Include,
}

impl Selection {
    /// Chooses among a study's stored versions; `current` is the one served now, where the caller knows (absent: the one served last).
    ///
    /// # Errors
    /// What is wrong with a name, or the data cannot be read.
    pub async fn of(
        store: &Store,
        study_id: &str,
        current: Option<&str>,
        version: &VersionRef,
        with: &With,
    ) -> Result<Selection, SelectionError> {
        let known = stored(store, study_id, current).await?;
        let named = version.among(&known)?;
        let mut versions = vec![named.version.clone()];
        let others: Vec<String> = match with {
            With::All => known.iter().map(|version| version.version.clone()).collect(),
            With::These(names) => names
                .iter()
                .map(|name| name.among(&known).map(|version| version.version.clone()))
                .collect::<Result<_, _>>()?,
        };
        for other in others {
            if !versions.contains(&other) {
                versions.push(other);
            }
        }
        Ok(Selection { study: named.study.clone(), versions, include: Include::default() })
    }

    /// The same, with sessions of these kinds judged too.
    pub fn including(self, include: Include) -> Selection {
        Selection { include, ..self }
    }

    /// The sessions of the chosen versions, in the order they began.
    pub(crate) async fn visits(&self, store: &Store) -> Result<Vec<Visit>, StoreError> {
        store.visits(&self.study.id, &self.versions, self.idle()).await
    }

    /// The version that gives the design.
    pub fn version(&self) -> &str {
        self.versions.first().map_or("", String::as_str)
    }

    /// A session not heard of for this long is over.
    pub fn idle(&self) -> Duration {
        Duration::from_secs(60 * u64::from(self.study.idle_minutes))
    }

    /// What each version of the study has gathered: those chosen, and those that are not and have sessions.
    pub(crate) async fn gathered(
        &self,
        store: &Store,
    ) -> Result<(Vec<PooledVersion>, Vec<PooledVersion>), StoreError> {
        let counts = store.version_counts(&self.study.id, self.idle()).await?;
        let of = |version: &String| {
            let counts = counts.get(version).copied().unwrap_or_default();
            let (sessions, answers) = (counts.participants.started, counts.answers);
            PooledVersion { version: version.clone(), sessions, answers }
        };
        let known = store.study_versions(&self.study.id).await?;
        let others = known.iter().map(|version| &version.version).filter(|v| !self.versions.contains(v));
        Ok((
            self.versions.iter().map(of).collect(),
            others.map(of).filter(|version| version.sessions > 0).collect(),
        ))
    }

    /// What the chosen versions show, as the first of them shows it, and what the others show otherwise.
    pub(crate) async fn shown(
        &self,
        store: &Store,
    ) -> Result<(Vec<StudyStimulus>, Vec<DifferentStimulus>), StoreError> {
        let first = store.version_stimuli(&self.study.id, self.version()).await?;
        let mut different = BTreeMap::<(String, String), Vec<String>>::new();
        for version in self.versions.iter().skip(1) {
            let of_version = store.version_stimuli(&self.study.id, version).await?;
            let (own, other) = (by_item(&first), by_item(&of_version));
            for (key, pixels) in own {
                if other.get(&key) != Some(&pixels) {
                    let (item, condition) = key;
                    different
                        .entry((item.to_owned(), condition.to_owned()))
                        .or_default()
                        .push(version.clone());
                }
            }
        }
        let different = different.into_iter();
        let named =
            different.map(|((item, condition), versions)| DifferentStimulus { item, condition, versions });
        Ok((first, named.collect()))
    }
}

/// What is shown by item and condition: the pixels at each size.
fn by_item(stimuli: &[StudyStimulus]) -> HashMap<(&str, &str), BTreeSet<&str>> {
    let mut pixels = HashMap::<(&str, &str), BTreeSet<&str>>::new();
    for s in stimuli {
        pixels.entry((&s.item, &s.condition)).or_default().insert(&s.pixels_sha256);
    }
    pixels
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

    use super::*;

    #[test]
    fn names_of_versions_are_current_a_hash_or_its_beginning() {
        assert_eq!("current".parse::<VersionRef>().unwrap(), VersionRef::Current);
        for good in ["01234567", &"a".repeat(64)] {
            assert_eq!(good.parse::<VersionRef>().unwrap(), VersionRef::Hash(good.to_owned()));
        }
        for wrong in ["", "0123456", "0123456G", "ABCDEF01", &"a".repeat(65), "../../x", "Current"] {
            assert!(matches!(wrong.parse::<VersionRef>(), Err(SelectionError::Malformed(_))), "{wrong}");
        }
        let two = With::These(vec![VersionRef::Hash("01234567".to_owned()), VersionRef::Current]);
        assert_eq!("01234567,current".parse::<With>().unwrap(), two);
        assert_eq!("all".parse::<With>().unwrap(), With::All);
        assert_eq!("".parse::<With>().unwrap(), With::default());
        assert_eq!(
            "simulated,pilot".parse::<Include>().unwrap().0,
            [SessionKind::Simulated, SessionKind::Pilot]
        );
        assert_eq!("".parse::<Include>().unwrap(), Include::default());
        for wrong in ["participant", "pilot,pilot", "pilot,", "Pilot"] {
            assert!(wrong.parse::<Include>().is_err(), "{wrong}");
        }
        for wrong in ["all,01234567", "01234567,", ",", "01234567 ,current"] {
            assert!(wrong.parse::<With>().is_err(), "{wrong}");
        }
    }
}
