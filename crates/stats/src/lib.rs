//! kelir-stats
