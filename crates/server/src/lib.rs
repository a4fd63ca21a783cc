//! kelir-server
