//! kelir-study
