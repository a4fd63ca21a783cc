//! kelir's server: participants take studies, researchers read what came of them.
//!
//! [`Server::open`] opens a data folder, [`Server::start`] also makes the stimuli and listens. Studies come from the
//! folder that is built in and from `DATA/studies/`; a `DATA` laid out like `stimuli/` adds to what is built in or replaces it.

mod address;
pub mod api;
mod app;
mod audit;
mod config;
mod connections;
mod content;
mod error;
mod extract;
mod findings;
mod headers;
mod integrity;
mod limiter;
mod loaded;
mod password;
mod presenting;
mod previews;
mod proxies;
mod rarely;
mod routes;
mod server;
mod starting;
mod viewer;
mod web;

pub use config::ServerConfig;
pub use error::StartError;
pub use password::PasswordSource;
pub use proxies::TrustedProxies;
pub use routes::openapi_json;
pub use server::{Handle, Server};
