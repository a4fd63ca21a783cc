//! Which version of a study is meant, and which others count with it.

use super::{Problem, ProblemCode};
use serde::Deserialize;
use utoipa::IntoParams;

/// A version as an address names it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum VersionRef {
    /// `current`: the one that is served now.
    Current,
    /// Its hash, or the beginning of it: 8 to 64 hex digits in small letters.
    Hash(String),
}

/// Fewest digits that may stand for a whole hash.
const FEWEST: usize = 8;
const RULE: &str = "must be current, or 8 to 64 digits of a version's hash (0-9, a-f)";

impl VersionRef {
    /// Reads the version in an address or a parameter; `name` is what the parameter is called.
    ///
    /// # Errors
    /// It is neither `current` nor 8 to 64 hex digits.
    pub fn read(name: &str, text: &str) -> Result<VersionRef, Box<Problem>> {
        let digits = text.bytes().all(|b| b.is_ascii_digit() || (b'a'..=b'f').contains(&b));
        match text {
            "current" => Ok(VersionRef::Current),
            _ if digits && (FEWEST..=64).contains(&text.len()) => Ok(VersionRef::Hash(text.to_owned())),
            _ => Err(Problem::parameter(name, text, RULE)),
        }
    }

    /// The one of `known` (hashes of 64 digits) that is meant; `current` is the one that is served.
    ///
    /// # Errors
    /// There is none, or more than one.
    pub fn among<'a>(
        &self,
        known: impl IntoIterator<Item = &'a str>,
        current: &'a str,
    ) -> Result<&'a str, Box<Problem>> {
        let VersionRef::Hash(beginning) = self else { return Ok(current) };
        let mut fitting = known.into_iter().filter(|hash| hash.starts_with(beginning.as_str()));
        match (fitting.next(), fitting.next()) {
            (Some(only), None) => Ok(only),
            (None, _) => Err(Problem::not_found("version of this study")),
            (Some(_), Some(_)) => {
                let detail = format!("More than one version begins with {beginning}: give more digits.");
                Err(Problem::new(ProblemCode::AmbiguousVersion, detail))
            }
        }
    }
}

/// Whose answers count beside the named version's.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum With {
    /// Those of every other version.
    All,
    /// Those of these versions; none: the named version's alone.
    These(Vec<VersionRef>),
}

/// Which other versions' answers are pooled.
#[derive(Clone, Debug, Default, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub struct Pooling {
    /// Versions whose answers count with the named one's, separated by commas, each as in the address; `all`: every other version's.
    pub with: Option<String>,
}

impl Pooling {
    /// The versions asked for.
    ///
    /// # Errors
    /// One of them is neither `current` nor 8 to 64 hex digits, or `all` is not alone.
    pub fn with(&self) -> Result<With, Box<Problem>> {
        match self.with.as_deref() {
            None | Some("") => Ok(With::These(Vec::new())),
            Some("all") => Ok(With::All),
            Some(text) => {
                let versions = text.split(',').map(|one| VersionRef::read("with", one));
                Ok(With::These(versions.collect::<Result<_, _>>()?))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    fn hash(beginning: &str) -> String {
        format!("{beginning:0<64}")
    }

    #[test]
    fn a_version_is_current_a_hash_or_an_unambiguous_beginning() {
        let known = [hash("0123456789"), hash("01234567ff"), hash("fedcba98")];
        let among = |text: &str| {
            let version = VersionRef::read("version", text)?;
            version.among(known.iter().map(String::as_str), &known[2]).map(str::to_owned)
        };
        assert_eq!(among("current").unwrap(), known[2]);
        assert_eq!(among("fedcba98").unwrap(), known[2]);
        assert_eq!(among("012345678").unwrap(), known[0]);
        assert_eq!(among(&known[1]).unwrap(), known[1]);
        assert_eq!(among("01234567").unwrap_err().code, ProblemCode::AmbiguousVersion);
        assert_eq!(among("abcdef01").unwrap_err().code, ProblemCode::NotFound);
        for wrong in ["", "fedcba9", "FEDCBA98", "fedcba9g", "Current", "../..", &"0".repeat(65)] {
            let problem = among(wrong).unwrap_err();
            assert_eq!(
                (problem.code, problem.errors[0].pointer.as_str()),
                (ProblemCode::InvalidParameter, "/version")
            );
        }
    }

    #[test]
    fn pooled_versions_are_named_one_by_one_or_all_at_once() {
        let with = |text: Option<&str>| Pooling { with: text.map(str::to_owned) }.with();
        assert_eq!(with(None).unwrap(), With::These(vec![]));
        assert_eq!(with(Some("")).unwrap(), With::These(vec![]));
        assert_eq!(with(Some("all")).unwrap(), With::All);
        let two = vec![VersionRef::Hash("01234567".to_owned()), VersionRef::Current];
        assert_eq!(with(Some("01234567,current")).unwrap(), With::These(two));
        for wrong in ["all,01234567", "01234567,", "x", ",", "01234567 ,fedcba98"] {
            assert_eq!(with(Some(wrong)).unwrap_err().errors[0].pointer, "/with", "{wrong}");
        }
    }
}
