//! Secrets that are drawn, not chosen.

/// A secret of 244 random bits for a browser to hold.
pub fn random_token() -> String {
    format!("{}{}", uuid::Uuid::new_v4().simple(), uuid::Uuid::new_v4().simple())
}
