//! kelir's server: participants take studies, researchers read what came of them.
//!
//! [`Server::open`] opens a data folder, [`Server::start`] also makes the stimuli and listens. Studies come from the
//! folder that is built in and from `DATA/studies/`; a `DATA` laid out like `stimuli/` adds to what is built in or replaces it.

mod address;
pub mod api;
mod app;
mod audit;
mod check;
mod connections;
mod content;
mod drawing;
mod error;
mod events;
mod export;
mod extract;
mod headers;
mod integrity;
mod library;
mod limiter;
pub mod links;
mod making;
mod participants;
mod password;
mod picture;
mod presenting;
mod previews;
mod proxies;
mod rarely;
mod remembered;
mod render;
pub mod results;
mod routes;
mod selection;
mod server;
pub mod shipped;
mod starting;
mod table;
mod viewer;
mod web;
mod weight;
mod workbook;

pub use check::library_of;
pub use error::{StartError, StudyFileError};
pub use events::events_table;
pub use export::{codebook_csv, responses_csv, responses_table, spreadsheet};
pub use library::Library;
pub use making::{Made, Maker, Making, Task};
pub use participants::participants_table;
pub use password::PasswordSource;
pub use proxies::TrustedProxies;
pub use render::RenderMaker;
pub use routes::openapi_json;
pub use selection::{Include, Selection, SelectionError, VersionRef, With};
pub use server::{Handle, Server, ServerConfig};
pub use table::{Table, codebook_of};
pub use weight::{Download, HEAVY_BYTES, SLOW_BITS_PER_S, Weight};
pub use workbook::workbook;

/// Re-exported for callers that read a data folder without a server.
pub use kelir_store::{Store, StoreError};
