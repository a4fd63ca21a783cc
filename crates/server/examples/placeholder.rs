//! Serves the studies with placeholder pictures in place of rendered ones, to work on the pages:
//! `cargo run -p kelir-server --example placeholder -- DATA PORT` (password: `wayang kulit`).
#![allow(clippy::print_stdout, reason = "it is run for what it prints")]

#[path = "../tests/it/placeholder.rs"]
mod placeholder;

use kelir_server::{Server, ServerConfig, TrustedProxies};
use std::sync::Arc;

#[tokio::main]
async fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut args = std::env::args().skip(1);
    let data = args.next().ok_or("DATA is missing")?.into();
    let port = args.next().unwrap_or("8090".to_owned()).parse()?;
    let handle = Server::start(ServerConfig {
        data,
        listen: ([127, 0, 0, 1], port).into(),
        password: Some("wayang kulit".to_owned()),
        secure_cookies: false,
        trusted_proxies: TrustedProxies::default(),
        maker: Arc::new(placeholder::Placeholder::default()),
        progress: Arc::new(|_| {}),
    })
    .await?;
    for study in handle.server().studies() {
        println!("http://{}/study/{study}", handle.address());
    }
    println!("http://{}/console", handle.address());
    tokio::signal::ctrl_c().await?;
    handle.shutdown().await;
    Ok(())
}
