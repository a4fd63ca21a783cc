//! kelir-store
