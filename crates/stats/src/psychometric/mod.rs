//! psychometric
