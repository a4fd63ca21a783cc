//! `kelir serve`: the platform on one address.

use std::net::SocketAddr;
use std::path::PathBuf;
use std::sync::Arc;

use anyhow::Result;
use kelir_server::{Handle, Making, RenderMaker, Server, ServerConfig, StartError};
use kelir_store::FolderLock;

use crate::output::print;
use crate::{bad_input, progress};

/// Arguments of `kelir serve`.
#[derive(clap::Args)]
pub struct Args {
    /// Folder of the database, the stimuli, own studies and the researcher's password; made if it does not exist.
    #[arg(long)]
    data: PathBuf,
    /// Address and port to listen on; port 0 takes a free one.
    #[arg(long, default_value = "127.0.0.1:8080")]
    listen: SocketAddr,
    /// Send the researcher's cookie over HTTPS alone: for a server behind TLS.
    #[arg(long)]
    secure_cookies: bool,
}

/// Runs the command until it is interrupted.
pub fn run(args: Args) -> Result<()> {
    let level = tracing_subscriber::EnvFilter::try_from_env("KELIR_LOG").unwrap_or_else(|_| "info".into());
    tracing_subscriber::fmt().with_env_filter(level).with_writer(std::io::stderr).init();
    tokio::runtime::Runtime::new()?.block_on(serve(args))
}

async fn serve(args: Args) -> Result<()> {
    // Held until this returns.
    let _lock = FolderLock::take(&args.data, &format!("http://{}", args.listen))?;
    let bar = progress::bar(0, "stimuli");
    let config = ServerConfig {
        data: args.data,
        listen: args.listen,
        password: std::env::var("KELIR_RESEARCHER_PASSWORD").ok().filter(|password| !password.is_empty()),
        secure_cookies: args.secure_cookies,
        maker: Arc::new(RenderMaker::default()),
        progress: {
            let bar = bar.clone();
            Arc::new(move |making| show(&bar, &making))
        },
    };
    let handle = Server::start(config).await.map_err(start_error)?;
    greet(&handle)?;
    let asked_to_stop = stop_signal();
    tokio::pin!(asked_to_stop);
    tokio::select! {
        made = handle.ready() => {
            bar.finish_and_clear();
            match made {
                Ok(()) => print("The stimuli are ready.")?,
                // The other studies are served all the same, and the pages say what is wrong with this one.
                Err(problems) => eprintln!("kelir: {problems}"),
            }
            asked_to_stop.await;
        }
        () = &mut asked_to_stop => bar.finish_and_clear(),
    }
    handle.shutdown().await;
    Ok(())
}

/// Where to go and how to sign in.
fn greet(handle: &Handle) -> Result<()> {
    let base = format!("http://{}", handle.address());
    let server = handle.server();
    for study in server.studies() {
        print(&format!("participants   {base}/study/{study}"))?;
    }
    print(&format!("researchers    {base}/console"))?;
    match server.password_file() {
        Some(file) => print(&format!("sign in with the password in {}", file.display())),
        None => print("sign in with the password of KELIR_RESEARCHER_PASSWORD"),
    }
}

fn show(bar: &indicatif::ProgressBar, making: &Making) {
    bar.set_length(making.total as u64 * 100);
    bar.set_position(making.done as u64 * 100 + (making.fraction * 100.0) as u64);
    bar.set_message(making.stimulus.clone());
}

fn start_error(error: StartError) -> anyhow::Error {
    match error {
        StartError::Study(_) => bad_input(error),
        other => other.into(),
    }
}

/// Returns when the process is asked to end: Ctrl-C, or SIGTERM from a service manager.
async fn stop_signal() {
    let interrupt = tokio::signal::ctrl_c();
    #[cfg(unix)]
    {
        use tokio::signal::unix::{SignalKind, signal};
        match signal(SignalKind::terminate()) {
            Ok(mut terminate) => {
                tokio::select! {
                    _ = interrupt => {}
                    _ = terminate.recv() => {}
                }
            }
            Err(_) => drop(interrupt.await),
        }
    }
    #[cfg(not(unix))]
    drop(interrupt.await);
}
