//! The crate's one error.

/// What is wrong with the input of a statistical function.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StatsError {
    /// A number breaks the rule of its argument (NaN always does).
    #[error("{name} = {value}: {rule}")]
    Invalid {
        /// The argument's name.
        name: &'static str,
        /// What was given.
        value: f64,
        /// What is allowed.
        rule: &'static str,
    },
    /// One element of a list breaks a rule.
    #[error("{name}[{index}] = {value}: {rule}")]
    InvalidElement {
        /// The list's name.
        name: &'static str,
        /// Where in the list.
        index: usize,
        /// What was given.
        value: f64,
        /// What is allowed.
        rule: &'static str,
    },
    /// A list is too short.
    #[error("{name} has {len} values: at least {needed} are needed")]
    TooFew {
        /// The list's name.
        name: &'static str,
        /// How many there are.
        len: u64,
        /// How many there must be.
        needed: u64,
    },
    /// Two lists that belong together differ in length.
    #[error("{first} has {first_len} values and {second} {second_len}: they must be as many")]
    LengthMismatch {
        /// The first list's name.
        first: &'static str,
        /// Its length.
        first_len: usize,
        /// The second list's name.
        second: &'static str,
        /// Its length.
        second_len: usize,
    },
    /// All values are the same, so that what was asked is undefined.
    #[error("{name}: all {len} values are {value}, so {undefined} is undefined")]
    ZeroVariance {
        /// The list's name.
        name: &'static str,
        /// How many there are.
        len: u64,
        /// The one value.
        value: f64,
        /// What cannot be computed.
        undefined: &'static str,
    },
    /// No answer exists within the range that is searched.
    #[error("{what} has no solution: {reason}")]
    NoSolution {
        /// What was asked for.
        what: &'static str,
        /// Why there is none.
        reason: &'static str,
    },
    /// Conditions that no comparison links cannot be put on one scale.
    #[error("the comparisons fall apart into {} groups that nothing links: {}", components.len(), list(components))]
    Disconnected {
        /// The names of the conditions in each group.
        components: Vec<Vec<String>>,
    },
    /// The maximum of the likelihood is at infinity.
    #[error("{what} has no finite maximum-likelihood estimate: {reason}")]
    Separated {
        /// What was to be estimated.
        what: &'static str,
        /// Which answers separate the data.
        reason: String,
    },
    /// An iteration ended without an answer.
    #[error("{what} did not converge")]
    NotConverged {
        /// What was to be computed.
        what: &'static str,
    },
}

/// "{A, B} | {C}"
fn list(components: &[Vec<String>]) -> String {
    components.iter().map(|names| format!("{{{}}}", names.join(", "))).collect::<Vec<_>>().join(" | ")
}

/// A result with the crate's error.
pub type Result<T> = std::result::Result<T, StatsError>;

impl StatsError {
    /// `Ok(value)` when it is a number (infinities included).
    pub(crate) fn number(name: &'static str, value: f64) -> Result<f64> {
        if value.is_nan() { Err(Self::Invalid { name, value, rule: "must be a number" }) } else { Ok(value) }
    }

    /// `Ok(value)` when it is finite.
    pub(crate) fn finite(name: &'static str, value: f64) -> Result<f64> {
        Self::check(value.is_finite(), name, value, "must be finite")
    }

    /// `Ok(value)` when it is finite and above zero.
    pub(crate) fn positive(name: &'static str, value: f64) -> Result<f64> {
        Self::check(value.is_finite() && value > 0.0, name, value, "must be finite and above 0")
    }

    /// `Ok(value)` when it lies in [0, 1].
    pub(crate) fn probability(name: &'static str, value: f64) -> Result<f64> {
        Self::check((0.0..=1.0).contains(&value), name, value, "must lie in [0, 1]")
    }

    /// `Ok(value)` when it lies in (0, 1).
    pub(crate) fn open_probability(name: &'static str, value: f64) -> Result<f64> {
        Self::check(value > 0.0 && value < 1.0, name, value, "must lie in (0, 1)")
    }

    fn check(holds: bool, name: &'static str, value: f64, rule: &'static str) -> Result<f64> {
        if holds { Ok(value) } else { Err(Self::Invalid { name, value, rule }) }
    }
}
