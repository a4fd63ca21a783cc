//! What a server is started with.

use crate::proxies::TrustedProxies;
use kelir_house::Maker;
use kelir_house::making::Making;
use std::net::SocketAddr;
use std::path::PathBuf;
use std::sync::Arc;

/// What a server is started with.
pub struct ServerConfig {
    /// Folder of the database, the stimuli and own studies; made if need be.
    pub data: PathBuf,
    /// Address to listen on; port 0 takes a free one.
    pub listen: SocketAddr,
    /// The researcher's password in place of the generated one.
    pub password: Option<String>,
    /// Whether cookies are sent over HTTPS alone; for a server behind TLS.
    pub secure_cookies: bool,
    /// Proxies whose `X-Forwarded-For` is believed.
    pub trusted_proxies: TrustedProxies,
    /// Who draws the stimuli.
    pub maker: Arc<dyn Maker>,
    /// Told how far the stimuli are; called from a worker thread.
    pub progress: Arc<dyn Fn(Making) + Send + Sync>,
}
